//! Scenes with mirrors and glass on all engines and sets of kernels, with any number of cores and any arbiter.

use emu::engine::EngineKind;
use emu::machine::arbiter::ArbiterKind;
use emu::machine::{Config, RunOptions, RunOutcome};
use kernels::KernelSet;
use lancer::job::Job;
use lancer::load::Load;
use random::SplitMix64;
use scenes::model::{Light, Material, Scene, Triangle};

use crate::seen::Seen;
use crate::surface::{InputForm, Surface};

/// Pictures of generated scenes.
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
        size: (1 + random.below(7) as u32, 1 + random.below(5) as u32),
        materials,
        lights,
        vertices,
        triangles,
    }
}

fn draw(input: &[u8], seen: &mut Seen) {
    let mut octets = [0; 8];
    let length = input.len().min(8);
    octets[..length].copy_from_slice(&input[..length]);
    let random = &mut SplitMix64::new(u64::from_le_bytes(octets));
    let mut job = Job::new(scene(random));
    job.view.bounces = random.below(4) as u32;
    job.kernels.profile = KernelSet::ALL[random.below(KernelSet::ALL.len() as u64) as usize];
    let arbiter = ArbiterKind::ALL[random.below(ArbiterKind::ALL.len() as u64) as usize];
    let mut config = Config { cores: 1 + random.below(6) as u32, ..Config::default() };
    config.bus.arbiter = arbiter;
    config.bus.slot_clocks = 60 + random.below(100);
    job.machine = config;
    let (load, _) = match Load::picture(&job) {
        Ok(picture) => picture,
        Err(failure) => return seen.text(&format!("{failure:?}")),
    };
    // The picture and the counts of a frame, whatever the number of cores and the arbiter.
    let run = |config: &Config, engine, is_stepped: bool| -> Result<RunOutcome, String> {
        let options = RunOptions { engine, has_items: true, is_eager: true, ..RunOptions::default() };
        let setup = load.setup(config, options);
        let frame = match is_stepped {
            true => emu::step(&setup, load.memory.clone(), &mut |_| {}),
            false => emu::run(&setup, load.memory.clone(), &mut |_| {}),
        };
        frame.map_err(|failure| failure.to_string())
    };
    let stepped = run(&job.machine, EngineKind::Checked, true);
    for engine in EngineKind::ALL {
        let mut frame = run(&job.machine, engine, false);
        if let (Ok(frame), Ok(stepped)) = (&mut frame, &stepped) {
            seen.text(frame.method.reason().unwrap_or("replayed"));
            frame.method = stepped.method;
            if seen.has_planted() && frame.clocks.0 % 7 == 5 {
                frame.clocks.0 += 1;
            }
        }
        assert!(frame == stepped, "{} agrees with stepping", engine.name());
    }
    let alone = run(&Config { cores: 1, ..Config::default() }, EngineKind::default(), false);
    if let (Ok(alone), Ok(stepped)) = (&alone, &stepped) {
        assert!(alone.memory == stepped.memory, "the picture depends on no core and no arbiter");
        assert!(alone.item_count == stepped.item_count, "so do the work items");
        seen.count("clocks", alone.clocks.0 as usize);
    } else {
        assert_eq!(alone.is_err(), stepped.is_err(), "a trap depends on no core and no arbiter");
    }
    seen.text(job.kernels.profile.name());
    seen.text(arbiter.name());
}
