//! Skips leave a picture as it is, and do less where a scene does not need more.

use std::collections::BTreeSet;

use kernels::{KernelSet, Skip};
use lancer::drawing::Comparison;
use lancer::job::Job;
use lancer::skips::{self, SkipResult, SkipsResult};
use scenes::generate::{self, SCENES};
use scenes::layout::Layout;
use scenes::model::Scene;

/// A generated scene, small enough for a dozen pictures.
fn job(name: &str, profile: KernelSet, layout: Layout, size: (u32, u32)) -> Job {
    let smaller = |name: &str| match name {
        "terrain" => (None, Some(300)),
        "cornell" => (Some(2), None),
        "sphereflake" => (Some(0), None),
        "slabs" => (Some(3), None),
        "mirrors" | "slivers" => (Some(1), None),
        _ => (None, None),
    };
    let (level, triangles) = smaller(name);
    let scene = generate::scene(name, &generate::GenerateOptions { level, triangles, size }).unwrap();
    set_up(scene, profile, layout)
}

fn set_up(scene: Scene, profile: KernelSet, layout: Layout) -> Job {
    let mut job = Job::new(scene);
    job.kernels.profile = profile;
    job.layout = Some(layout);
    job
}

fn measured(name: &str, profile: KernelSet, layout: Layout, size: (u32, u32)) -> SkipsResult {
    skips::measure(&job(name, profile, layout, size), &|| {}).unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

fn saving<'a>(savings: &'a SkipsResult, name: &str) -> &'a SkipResult {
    savings.rows.iter().find(|saving| saving.name == name).unwrap()
}

/// `slabs` has everything that a layout could get wrong: mirrors, glass, packets with many triangles. It is drawn by all kernels in all layouts; each of
/// the other scenes by two kernel sets in turn, so that each set draws three of them or more.
#[test]
fn no_skip_changes_a_picture() {
    let sets = KernelSet::ALL.len();
    for (at, scene) in SCENES.iter().enumerate() {
        let is_whole = scene.name == "slabs";
        let in_turn = |set: &usize| is_whole || [at % sets, (at + sets / 2) % sets].contains(set);
        for profile in (0..sets).filter(in_turn).map(|set| KernelSet::ALL[set]) {
            let is_tried = |layout: Layout| layout == profile.layout() || is_whole;
            let is_read = |layout: Layout| profile.refusal(layout).is_none();
            for layout in Layout::ALL.into_iter().filter(|&layout| is_tried(layout) && is_read(layout)) {
                let savings = measured(scene.name, profile, layout, (7, 5));
                for saving in savings.rows.iter().filter(|saving| saving.claims_identity) {
                    assert!(
                        saving.is_identical && saving.image_hash == savings.rows[0].image_hash,
                        "{} with {profile} kernels in the {layout} layout: {} changes the picture",
                        scene.name,
                        saving.name
                    );
                }
            }
        }
    }
}

#[test]
fn each_skip_saves_something_somewhere() {
    let scenes = ["cornell", "slabs", "terrain"];
    let all: Vec<SkipsResult> =
        scenes.iter().map(|name| measured(name, KernelSet::Vector, Layout::Wide, (12, 9))).collect();
    for skip in Skip::ALL {
        let saves = |savings: &SkipsResult| {
            let saving = saving(savings, skip.name());
            saving.operations_saved > 0.0
                || saving.octets_saved > 0.0
                || saving.program_words < savings.rows[0].program_words
        };
        assert!(all.iter().any(saves), "{skip} saves nothing on any of {scenes:?}");
    }
}

/// `lancer skips SCENE --size 8x6 --profile PROFILE` for each line and column of the document's table.
#[test]
fn scenes_with_glass_or_mirrors_need_30_percent_fewer_operations() {
    for scene in &SCENES[..5] {
        let size = (8, 6);
        let scene =
            generate::scene(scene.name, &generate::GenerateOptions { size, ..generate::GenerateOptions::default() })
                .unwrap();
        if !scene.materials.iter().any(|material| material.reflection > 0.0 || material.transmission() > 0.0) {
            continue;
        }
        let saved = KernelSet::ALL.iter().map(|&profile| {
            let savings = skips::together(&set_up(scene.clone(), profile, profile.layout())).unwrap();
            saving(&savings, "all").operations_saved
        });
        let saved: Vec<f64> = saved.collect();
        let name = scene.name;
        assert!(saved.iter().all(|&saved| saved >= 0.3), "{name}: {saved:?}");
        let line = format!(
            "| {name} | {} |",
            saved.iter().map(|saved| format!("{:.1} %", 100.0 * saved)).collect::<Vec<_>>().join(" | ")
        );
        crate::bless::row("docs/skips.md", &name, &line);
    }
}

#[test]
fn a_diffuse_scene_has_no_word_of_secondary_rays() {
    for &profile in KernelSet::ALL {
        let job = job("terrain", profile, profile.layout(), (8, 6));
        let image = scenes::image::build(&job.scene, &job.view, &job.memory()).unwrap();
        let build = kernels::build(&job.scene, &job.view, &image, &isa::Isa::base(), &job.kernels).unwrap();
        let functions: BTreeSet<&str> = build.cores.regions.iter().map(|region| region.name.as_str()).collect();
        let absent = ["ray_tree", "reflects", "reflect", "refracts", "refract"];
        assert_eq!(absent.iter().filter(|name| functions.contains(*name)).count(), 0, "{profile}: {functions:?}");
        assert!(functions.contains("shade"));
        assert!(!build.cores.symbols.contains_key("NODES"), "{profile}: the ray tree has a place in the buffer");
    }
}

/// The colour of a pixel between corners that agree, from the picture that has all rays: report 6.4 without a kernel.
fn interpolated(words: &[[i32; 3]], size: (usize, usize), (x, y): (usize, usize), agreement: i32) -> Option<[i32; 3]> {
    let beside = |at: usize, last: usize| if at % 2 == 1 && at != last { [at - 1, at + 1] } else { [at; 2] };
    let (columns, rows) = (beside(x, size.0 - 1), beside(y, size.1 - 1));
    if columns[0] == x && rows[0] == y {
        return None;
    }
    let corners = rows.map(|row| columns.map(|column| words[row * size.0 + column])).concat();
    let component = |k: usize| corners.iter().map(move |corner| corner[k]);
    let agrees = |k: usize| component(k).max().unwrap() - component(k).min().unwrap() <= agreement;
    // A quarter of each, rounded to nearest, ties up.
    let mean = |k: usize| component(k).map(|x| (x + 2) >> 2).sum();
    (0..3).all(agrees).then(|| [0, 1, 2].map(mean))
}

#[test]
fn pixels_between_corners_that_agree_are_their_mean() {
    // The pixels of the triangle miss it: reading corners takes longer than what they would have taken.
    let cases = [("cornell", (17, 12), 0.02, true), ("terrain", (8, 9), 0.3, true), ("triangle", (1, 6), 0.0, false)];
    for (name, size, difference, is_faster) in cases {
        for &profile in KernelSet::ALL {
            let mut job = job(name, profile, profile.layout(), size);
            let drawn = |job: &Job| lancer::drawing::draw(job, Comparison::None, &mut |_| {}).unwrap();
            let whole = drawn(&job);
            job.kernels.interpolate = Some(difference);
            let drawing = drawn(&job);
            let agreement = (difference * f64::from(drawing.image.formats.colour).exp2()).floor() as i32;
            let (width, height) = (size.0 as usize, size.1 as usize);
            let mut count = 0;
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                let mean = interpolated(&whole.words, (width, height), (x, y), agreement);
                count += u64::from(mean.is_some());
                let expected = mean.unwrap_or(whole.words[y * width + x]);
                assert_eq!(drawing.words[y * width + x], expected, "{name} with {profile} kernels at {x}, {y}");
            }
            assert_eq!(drawing.interpolated(), count, "{name}");
            assert!(count > 0, "{name}: nothing agrees");
            assert!(drawing.frame.clocks < whole.frame.clocks || !is_faster, "{name} with {profile} kernels");
        }
    }
}
