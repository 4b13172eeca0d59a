//! The worked examples: their kernels are today's but for marked lines, and all ways to run them agree.

use std::fs;
use std::path::{Path, PathBuf};

use asm::extension::load;
use emu::engine::EngineKind;
use emu::machine::{RunOptions, RunOutcome};
use emu::profile::ProfileLevel;
use kernels::{Function, KernelSet};
use lancer::job::Job;
use lancer::load::Load;
use messages::Source;
use scenes::generate;

/// A kernel of an example: the function that it serves, and its text.
struct Kernel {
    function: Function,
    text: String,
}

/// The folders of the examples, with the files of their instructions and their kernels.
fn examples() -> Vec<(PathBuf, String, Vec<Kernel>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("extensions");
    let mut folders: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    folders.sort();
    let files = |folder: &Path, end: &str| -> Vec<PathBuf> {
        let all = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let mut found: Vec<PathBuf> = all.filter(|path| path.extension().is_some_and(|found| found == end)).collect();
        found.sort();
        found
    };
    let example = |folder: PathBuf| {
        let rows = files(&folder, "isa").iter().map(|path| fs::read_to_string(path).unwrap()).collect();
        let kernel = |path: PathBuf| Kernel {
            function: path.file_stem().unwrap().to_str().unwrap().parse().unwrap(),
            text: fs::read_to_string(path).unwrap(),
        };
        let kernels = files(&folder, "s").into_iter().map(kernel).collect();
        (folder, rows, kernels)
    };
    folders.into_iter().map(example).collect()
}

/// The kernel before: without the lines that end with `;+`, with those that begin with `;-`.
fn before(text: &str) -> String {
    let kept = text.lines().filter(|line| !line.ends_with(";+"));
    kept.map(|line| format!("{}\n", line.strip_prefix(";-").unwrap_or(line))).collect()
}

/// The profile whose kernels an example is made from.
fn profile(kernels: &[Kernel]) -> Option<KernelSet> {
    let is_own = |kernel: &Kernel, profile: KernelSet| {
        profile.file(kernel.function, &[]).is_some_and(|(_, text)| text == before(&kernel.text))
    };
    // The profile `ray` has files of `vector` for what is not about rays.
    let mut profiles = [KernelSet::Vector, KernelSet::Ray, KernelSet::Report].into_iter();
    profiles.find(|&profile| kernels.iter().all(|kernel| is_own(kernel, profile)))
}

#[test]
fn kernels_of_examples_are_those_of_a_profile_but_for_marked_lines() {
    for (folder, _, kernels) in examples() {
        assert!(!kernels.is_empty(), "{}", folder.display());
        assert!(
            profile(&kernels).is_some(),
            "{}: take the profile's kernel as it is now, with `;-` before lines left out and `;+` behind new ones",
            folder.display()
        );
    }
}

#[test]
fn all_ways_to_run_an_example_agree() {
    for (folder, rows, kernels) in examples() {
        // Load a small picture with the example's instructions and kernels
        let scene = generate::scene("cornell", &generate::GenerateOptions { size: (8, 6), ..Default::default() });
        let mut job = Job::new(scene.unwrap());
        job.kernels.profile = profile(&kernels).unwrap();
        load(&mut job.isa, &Source::new("t.isa", rows), &|_, _| Err("nothing is included".into())).unwrap();
        for Kernel { function, text } in kernels {
            job.kernels.replaced.push((function, Source::new(format!("{function:?}.s"), text)));
        }
        let (load, _) = Load::picture(&job).unwrap_or_else(|failure| panic!("{}: {failure:?}", folder.display()));
        let run = |engine, steps: bool| -> RunOutcome {
            let options = RunOptions {
                engine,
                is_eager: true,
                profile: ProfileLevel::Totals,
                has_items: true,
                ..RunOptions::default()
            };
            let setup = load.setup(&job.machine, options);
            let run = if steps { emu::step } else { emu::run };
            run(&setup, load.memory.clone(), &mut |_| {}).unwrap_or_else(|failure| panic!("{failure}"))
        };
        // Instructions of an example must not keep the cores from the fastest engine.
        assert_eq!(
            load.setup(&job.machine, RunOptions::default()).engine().kind,
            EngineKind::default(),
            "{}",
            folder.display()
        );
        // Compare all engines and a machine that is stepped, which differs in the name of its method alone
        let frame = run(EngineKind::Native, false);
        assert_eq!(frame.method.name(), "replayed");
        let stepped = run(EngineKind::Checked, true);
        for engine in EngineKind::ALL {
            assert!(run(engine, false) == frame, "{}: {}", folder.display(), engine.name());
        }
        assert!(RunOutcome { method: frame.method, ..stepped } == frame, "{}: stepped", folder.display());
    }
}
