//! Scenes with mirrors and glass on all engines and sets of kernels, with any number of cores and any arbiter.

use emu::machine::{Config, RunOptions};
use kernels::KernelSet;
use lancer::job::Job;
use lancer::load::Load;
use random::SplitMix64;
use scenes::model::{Light, Material, Scene, Triangle};

use super::machines::{self, one_of};
use crate::seen::Seen;
use crate::surface::{InputForm, Surface};

/// Machines that a picture is drawn on: its programs are assembled, and compiled, once for all of them.
const MACHINES: usize = 64;

/// Pictures of generated scenes: a run for each machine.
pub const SCENE: Surface = Surface {
    name: "scene",
    form: InputForm::Number,
    longest: 8,
    memory: 512 << 20,
    seeds: Vec::new,
    run: draw,
    reader: &["emu/src/replay", "kernels/src"],
};

/// A number in [0, 1] with two digits.
fn share(random: &mut SplitMix64) -> f64 {
    random.below(101) as f64 / 100.0
}

fn point(random: &mut SplitMix64) -> [f64; 3] {
    [0; 3].map(|_| random.below(201) as f64 / 100.0 - 1.0)
}

/// A handful of triangles, of which some are mirrors and some are glass.
fn scene(random: &mut SplitMix64) -> Scene {
    let materials = (0..1 + random.below(4)).map(|_| {
        let reflection = if random.below(2) == 0 { 0.0 } else { share(random) };
        let index = [0.0, 0.0, 1.0, 1.33, 1.5, 2.4][random.below(6) as usize];
        Material {
            colour: [0; 3].map(|_| share(random)),
            reflection,
            intensity: (1.0 - reflection) * share(random),
            index,
        }
    });
    let materials: Vec<Material> = materials.collect();
    let lights = (0..1 + random.below(3))
        .map(|_| Light { position: point(random).map(|x| 3.0 * x), colour: [0; 3].map(|_| share(random)) });
    let lights: Vec<Light> = lights.collect();
    let vertices: Vec<[f64; 3]> = (0..3 + random.below(12)).map(|_| point(random)).collect();
    let triangles = (0..1 + random.below(16)).map(|_| Triangle {
        vertices: [0; 3].map(|_| random.below(vertices.len() as u64) as u32),
        material: random.below(materials.len() as u64) as u32,
    });
    let triangles = triangles.collect();
    Scene {
        name: "generated".to_owned(),
        size: (1 + random.below(4) as u32, 1 + random.below(3) as u32),
        materials,
        lights,
        vertices,
        triangles,
    }
}

fn draw(input: &[u8], seen: &mut Seen) {
    let random = &mut machines::random_of(input);
    let mut job = Job::new(scene(random));
    job.view.bounces = random.below(4) as u32;
    job.kernels.profile = one_of(random, KernelSet::ALL);
    seen.name(job.kernels.profile.name());
    let (load, _) = match Load::picture(&job) {
        Ok(picture) => picture,
        Err(failure) => return seen.text(&format!("{failure:?}")),
    };
    // The first machine has one core and no rivals: the picture and its work items are those of all others.
    let mut all = vec![Config { cores: 1, ..job.machine.clone() }];
    all.resize_with(MACHINES, || machines::alike(random, &job.machine, 6));
    let options =
        RunOptions { profile: machines::profile(random), has_items: true, is_eager: true, ..RunOptions::default() };
    let frames = machines::compare(&load.setup(&job.machine, options), &all, &load.memory, random, seen);
    for frame in &frames {
        match (&frames[0], frame) {
            (Ok(alone), Ok(frame)) => {
                assert!(alone.memory == frame.memory, "the picture depends on no core and no arbiter");
                assert!(alone.item_count == frame.item_count, "so do the work items");
            }
            (alone, frame) => assert_eq!(alone.is_err(), frame.is_err(), "a trap depends on no core and no arbiter"),
        }
    }
}
