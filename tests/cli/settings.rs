//! Settings in results: what they hold, and that they give the same result again.

use std::collections::BTreeMap;

use clap::CommandFactory;
use emu::engine::EngineKind;
use emu::machine::arbiter::ArbiterKind;
use emu::machine::config::ProtectionConfig;
use emu::machine::preset::PRESETS;
use isa::number::{Overflow, Quantization};
use kernels::{KernelSet, Skip};
use lancer::command::Lancer;
use lancer::drawing::{self, Comparison};
use lancer::settings::{CameraKind, MachineSettings, Settings, key, read};
use lancer::{Failure, Render};
use messages::Source;
use random::SplitMix64;
use scenes::kdtree::{BuildMethod, Depth};
use scenes::layout::Layout;
use serde_json::Value;

use super::session::Session;

/// Options of `lancer render` on which no result depends but for its place, its form and the host's time.
const NO_SETTINGS: [&str; 19] = [
    "settings",
    "set",
    "json",
    "full",
    "quiet",
    "expect-hash",
    "min-psnr",
    "max-clocks",
    "output",
    "sidecar",
    "timing",
    "heat",
    "heat-of",
    "folded",
    "flame",
    "energy-map",
    "error",
    "help",
    "message-format",
];

/// A value of each option of a picture that is not its default.
pub(super) const SAMPLES: [(&str, &str); 34] = [
    ("scene", "cornell"),
    ("mesh", "one.off"),
    ("camera", "perspective"),
    ("eye", "0,0,5"),
    ("look", "0,0.1,0"),
    ("fov", "30"),
    ("size", "5x4"),
    ("shift", "0.25,-0.5"),
    ("crop", "1,1,2,2"),
    ("pixel", "2,1"),
    ("ambient", "0.2"),
    ("background", "0,0,1"),
    ("profile", "ray"),
    ("kernel", "triangle=my.s"),
    ("ext", "half.isa"),
    ("machine", "wide32"),
    ("cores", "3"),
    ("arbiter", "tdma"),
    ("word", "24"),
    ("rounding", "TRN"),
    ("overflow", "WRAP:2"),
    ("layout", "report"),
    ("engine", "checked"),
    ("format", "dir=20"),
    ("bounces", "1"),
    ("weight-cutoff", "0.125"),
    ("no-skip", "unlit"),
    ("interpolate", "0.01"),
    ("kd-depth", "3"),
    ("kd-build", "exact"),
    ("kd-visit", "50"),
    ("flags", ""),
    ("energy", ""),
    ("shadow", ""),
];

/// Options whose defaults differ between commands on purpose, each with the reason.
const OWN_DEFAULTS: [(&str, &str); 7] = [
    ("profile", "`lancer formats` draws hundreds of pictures, with the quickest of the exact sets"),
    ("layout", "`lancer formats` asks what bits cost, which only `packed` makes them"),
    ("size", "measurements of dozens of pictures draw small ones"),
    ("cores", "`lancer cores` varies them"),
    ("profiles", "`lancer bench` times the fastest set, `lancer accuracy` compares all"),
    ("most", "a number of other things in each command"),
    ("shifts", "`lancer formats` asks for an error at several places, `lancer accuracy` draws one picture a variant"),
];

fn session() -> Session {
    let session = Session::new();
    session.write("one.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    session.write("one.dsc", "");
    session.write("half.isa", ".extension half\n.instr half (d: S, a: S) \"custom0 ddddd aaaaa ----------------\" [Done(body)]\n    srai d, a, 1\n.end\n");
    session.write(
        "my.s",
        &std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/kernels/asm/vector/triangle.s")).unwrap(),
    );
    session
}

#[test]
fn every_option_that_changes_a_result_has_its_key() {
    let session = session();
    let command = Lancer::command();
    let render = command.find_subcommand("render").expect("there is a command that draws");
    let base = session.json("render triangle --size 8x6");
    for argument in render.get_arguments() {
        let name = argument.get_long().unwrap_or("scene");
        if NO_SETTINGS.contains(&name) || name == "no-error" {
            continue;
        }
        let sample = SAMPLES.iter().find(|(option, _)| *option == name);
        let (_, sample) = sample.unwrap_or_else(|| panic!("--{name} has no sample here"));
        let key = key::OPTIONS.iter().find(|(option, _)| *option == name);
        let (_, key) = key.unwrap_or_else(|| panic!("--{name} has no key of the settings"));
        // A mesh of its own belongs to a scene of its own.
        let line = match name {
            "scene" => format!("render {sample} --size 8x6"),
            "mesh" => continue,
            "size" => format!("render triangle --size {sample}"),
            _ if sample.is_empty() => format!("render triangle --size 8x6 --{name}"),
            _ => format!("render triangle --size 8x6 --{name}={sample}"),
        };
        let changed = session.json(&line);
        let of = |result: &Value| key.split('.').fold(result["settings"].clone(), |value, part| value[part].clone());
        assert_ne!(of(&base), of(&changed), "--{name} changes nothing at {key}");
    }
}

#[test]
fn an_option_has_one_default_in_all_commands() {
    fn collect(command: &clap::Command, path: &str, found: &mut BTreeMap<String, Vec<(String, String)>>) {
        for argument in command.get_arguments() {
            let defaults = argument.get_default_values().iter().map(|value| value.to_string_lossy().into_owned());
            let defaults = defaults.collect::<Vec<_>>().join(",");
            let Some(long) = argument.get_long().filter(|_| !defaults.is_empty()) else { continue };
            // The first value of a list is its base.
            let first = defaults.split(',').next().unwrap_or_default().to_owned();
            let value = if long == "shift" || long == "background" { defaults } else { first };
            found.entry(long.to_owned()).or_default().push((value, path.to_owned()));
        }
        for inner in command.get_subcommands() {
            collect(inner, &format!("{path} {}", inner.get_name()), found);
        }
    }
    let mut found = BTreeMap::new();
    collect(&Lancer::command(), "lancer", &mut found);
    let is_own = |option: &str| OWN_DEFAULTS.iter().any(|(own, _)| *own == option);
    for (option, defaults) in found.iter().filter(|(option, _)| !is_own(option)) {
        assert!(defaults.iter().all(|(value, _)| *value == defaults[0].0), "--{option}: {defaults:?}");
    }
}

#[test]
fn a_result_given_back_is_printed_again() {
    let session = session();
    session.write("sum.s", ".func f\n    imul s1, s2, s3\n.endfunc\n    halt\n");
    session.write("m.toml", "cores = 3\n[bus]\nweights = [2, 1]\n");
    let crop = "--crop 1,1,3,2 --no-error --flags --no-skip unlit,tested --word 24 --format dir=20,weight=18";
    for (line, again) in [
        ("render cornell --size 8x6 --shift 0.137,0.071 --machine m.toml --cores 2".to_owned(), "render"),
        (format!("render slabs --size 8x6 {crop} --set main.traffic=false --profile ray"), "render"),
        ("render one.off --size 6x4 --eye 0.4,0.4,4 --fov 15 --kernel triangle=my.s --ext half.isa".to_owned(), "render"),
        ("skips triangle --size 4x4 --machine wide32".to_owned(), "skips"),
        ("cores triangle --size 4x4 --cores 1-2,4 --machine node_cache,m.toml --arbiter tdma".to_owned(), "cores"),
        ("cores annex --cores 2 --set bus.octets_per_beat=4".to_owned(), "cores"),
        ("run sum.s --dump regs --reg v2=1:2:3,s2=-5 --machine wide32 --word 20".to_owned(), "run"),
        ("profiles triangle --size 4x4 --arbiter tdma".to_owned(), "profiles"),
        ("annex triangle --size 8x6".to_owned(), "annex"),
        ("scene info cornell --word 20 --format dir=12".to_owned(), "scene info"),
        ("accuracy triangle --size 4x4 --words 20-22 --profiles ray --roundings RND --layouts wide --bounces 1 --cutoffs 0 --interpolate none".to_owned(), "accuracy"),
        ("formats triangle --size 4x3 --shifts 1 --guard 0 --largest 1/255 --check triangle".to_owned(), "formats"),
        ("inject triangle --size 4x3 --kind bus --kind results --injections 30 --seed 7 --protect bus=parity".to_owned(), "inject"),
        ("inject triangle --size 4x3 --kind memory --number 5 --bits 2 --pattern scattered".to_owned(), "inject"),
        ("stress --case square_root".to_owned(), "stress"),
    ] {
        // Name only the command again: scene, machine and options come from the result, and each octet must be the same
        let first = session.succeed(&format!("{line} --json"));
        session.write("result.json", &first);
        assert_eq!(session.succeed(&format!("{again} --settings result.json --json")), first, "{line}");
        let result: Value = serde_json::from_str(&first).unwrap();
        assert_eq!(result["version"], env!("CARGO_PKG_VERSION"), "{line}");
    }
}

#[test]
fn options_on_the_command_line_win_over_a_settings_file() {
    let session = session();
    session.write(
        "s.toml",
        "scene = \"slabs\"\n[view]\nsize = [6, 4]\ncrop = [1, 1, 2, 2]\n[machine]\nfrom = \"wide32\"\ncores = 2\n",
    );
    let key = |line: &str, key: &str| {
        let result = session.json(line);
        key.split('.').fold(result["settings"].clone(), |value, part| value[part].clone())
    };
    assert_eq!(key("render --settings s.toml", "machine.name"), "wide32");
    assert_eq!(key("render --settings s.toml", "scene.name"), "slabs");
    assert_eq!(key("render triangle --settings s.toml", "scene.name"), "triangle");
    assert_eq!(key("render --settings s.toml --cores 5", "machine.cores"), 5);
    assert_eq!(key("render --settings s.toml --cores 5 --set cores=6", "machine.cores"), 6);
    assert_eq!(key("render --settings s.toml --machine report", "machine.cores"), 4);
    assert_eq!(key("render --settings s.toml --pixel 0,0", "view.crop"), serde_json::json!([0, 0, 1, 1]));
    session.fail("render --settings s.toml --set cors=6", 1, "did you mean `cores`?");
    session.fail("render --settings none.toml", 1, "there is no file none.toml");
    session.write("bad.toml", "[view]\nsiz = [6, 4]\n");
    session.fail("render --settings bad.toml", 1, "bad.toml:2:1");
    session.fail("profiles --settings s.toml", 1, "is no setting of `lancer profiles`");
}

#[test]
fn a_scene_that_has_changed_is_refused() {
    let session = session();
    session.write("result.json", &session.succeed("render one.off --size 4x3 --json"));
    session.succeed("render --settings result.json --json");
    session.write("one.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n");
    session.fail(
        "render --settings result.json --json",
        1,
        "the scene one.off is not what the settings were written for",
    );
    session.succeed("render one.off --settings result.json --json");
}

#[test]
fn results_lie_beside_a_picture_on_request() {
    let session = Session::new();
    let printed = session.succeed("render triangle --size 4x3 -o a.png --sidecar --json");
    assert_eq!(String::from_utf8(session.read("a.json")).unwrap(), printed);
    assert_eq!(session.names(), ["a.json", "a.png"]);
    session.fail("render triangle --size 4x3 --json --sidecar", 2, "no picture to write the results beside");
}

/// Settings of a small picture, each key drawn by lot.
fn random_settings(lot: &mut SplitMix64) -> Settings {
    fn one<T: Clone>(lot: &mut SplitMix64, of: &[T]) -> T {
        of[lot.below(of.len() as u64) as usize].clone()
    }
    let real = |lot: &mut SplitMix64| f64::from((lot.unit() * 1e6) as i32) / 1e6;
    let mut settings = Settings::default();
    // Draw scene and view: crops fit the smallest picture, 3 x 2, and only perspective has an eye
    settings.scene.name = one(lot, &["triangle", "cornell", "slabs", "mirrors", "empty"]).to_owned();
    let view = &mut settings.view;
    let size = [3 + lot.below(4) as u32, 2 + lot.below(3) as u32];
    view.size = Some(size);
    view.shift = [real(lot), real(lot)];
    view.ambient = real(lot).abs();
    view.background = [0; 3].map(|_| real(lot).abs());
    view.camera = one(lot, &[None, Some(CameraKind::Orthographic), Some(CameraKind::Perspective)]);
    if view.camera == Some(CameraKind::Perspective) {
        let eye = [real(lot), real(lot), 4.0 + real(lot)];
        view.eye = one(lot, &[None, Some(eye)]);
        let look = [real(lot), 0.0, 0.0];
        view.look = one(lot, &[None, Some(look)]);
        let fov = 20.0 + 90.0 * real(lot).abs();
        view.fov = one(lot, &[None, Some(fov)]);
    }
    view.crop = one(lot, &[None, Some([1, 0, 2, 2]), Some([2, 1, 1, 1])]);
    // Draw kernels and tree; what stands in a list twice is drawn twice as often
    settings.kernels.profile = one(lot, KernelSet::ALL);
    settings.layout = one(lot, &[None, None, Some(Layout::Wide), Some(Layout::Report)]);
    let effort = &mut settings.effort;
    effort.bounces = lot.below(4) as u32;
    effort.weight_cutoff = one(lot, &[0.0, 1.0 / 128.0, 0.1]);
    effort.interpolate = one(lot, &[None, None, Some(0.01), Some(0.3)]);
    for &skip in Skip::ALL {
        effort.skips = if lot.below(4) == 0 { effort.skips.without(skip) } else { effort.skips };
    }
    settings.tree.depth = Some(one(lot, &[Depth::Auto, Depth::Levels(0), Depth::Levels(7), Depth::default()]));
    settings.tree.build = Some(one(lot, &BuildMethod::ALL));
    settings.tree.visit = one(lot, &[100, 100, 25]);
    settings.formats.dir = one(lot, &[None, None, Some(14)]);
    settings.formats.colour = one(lot, &[None, None, None, Some(9)]);
    // Take a preset and draw most of its keys anew
    settings.machine = MachineSettings::find(one(lot, PRESETS).name).unwrap();
    let config = &mut settings.machine.config;
    config.cores = 1 + lot.below(9) as u32;
    config.clock_hz = 1 + lot.below(1_000_000_000);
    config.arithmetic.word = 18 + lot.below(15) as u32;
    config.arithmetic.quantization = one(lot, Quantization::ALL);
    config.arithmetic.overflow =
        one(lot, &[Overflow::ALL[0], Overflow::ALL[0], Overflow::from_name("WRAP:3").unwrap()]);
    config.bus.arbiter = one(lot, &ArbiterKind::ALL);
    config.bus.octets_per_beat = 1 + lot.below(8);
    config.bus.setup_clocks = lot.below(3);
    config.bus.burst_octets = one(lot, &[0, 16, 64]);
    config.bus.overlap = lot.below(2) == 0;
    config.bus.weights = (0..lot.below(4)).map(|_| 1 + lot.below(5) as u32).collect();
    config.cache.octets = one(lot, &[0, 0, 256]);
    config.main.traffic = lot.below(2) == 0;
    for kind in ProtectionConfig::keys().filter(|_| lot.below(3) == 0).collect::<Vec<_>>() {
        config.protection.set(kind, one(lot, kind.protections()));
    }
    config.clocks.0[isa::Class::Div] =
        if lot.below(4) == 0 { "linear 1/4 + 3".parse().unwrap() } else { lot.below(20).into() };
    // Draw the engine and what is compared with double precision
    settings.engine = one(lot, &[EngineKind::default(), EngineKind::Checked]);
    settings.results.error = lot.below(3) != 0;
    settings.results.flags = lot.below(3) == 0;
    settings.results.reference_bounces = [None, Some(0), Some(3)][lot.below(3) as usize];
    settings
}

/// Result of settings as JSON, or the messages that keep them from giving one.
fn drawn(settings: &Settings) -> Result<String, String> {
    let shown = |failure: Failure| match failure {
        Failure::Message { report, .. } => report.render(false),
        Failure::ClosedPipe => "a closed pipe".to_owned(),
    };
    let job = settings.job().map_err(shown)?;
    let comparison = if job.error { Comparison::Reference } else { Comparison::None };
    let drawing = drawing::draw(&job, comparison, &mut |_| {}).map_err(shown)?;
    Ok(Render::new(&job, &drawing).json())
}

#[test]
fn two_hundred_random_settings_give_the_same_octets_again() {
    const SEED: u64 = 22;
    let mut lot = SplitMix64::new(SEED);
    let (mut results, mut refusals) = (0, 0);
    while results < 200 {
        let settings = random_settings(&mut lot);
        let first = drawn(&settings);
        // Settings that cannot be drawn are refused in the same words when they come from a file.
        let text = first.clone().unwrap_or_else(|_| serde_json::to_string(&settings).unwrap());
        let read = read::parse(&Source::new("result.json", text)).and_then(|stored| stored.settings());
        let read = read.unwrap_or_else(|report| panic!("seed {SEED}: {}", report.render(false)));
        assert_eq!(drawn(&read), first, "seed {SEED}: {settings:?}");
        match first {
            Ok(_) => results += 1,
            Err(_) => refusals += 1,
        }
        assert!(refusals < 400, "seed {SEED}: hardly any settings give a picture");
    }
}

#[test]
fn the_canonical_command_line_gives_the_same_settings() {
    let session = Session::new();
    let mut lot = SplitMix64::new(23);
    for _ in 0..10 {
        let settings = random_settings(&mut lot);
        let Ok(text) = drawn(&settings) else { continue };
        let result: Value = serde_json::from_str(&text).unwrap();
        let line = Settings::of_value(&result["settings"]).unwrap().command_line("render");
        let words = line.strip_prefix("lancer ").unwrap();
        // Words in quotation marks hold blanks and no further marks here.
        let quoted = words.split('\'').enumerate();
        let words: Vec<&str> = quoted
            .flat_map(|(number, part)| match number % 2 {
                0 => part.split_whitespace().collect::<Vec<_>>(),
                _ => vec![part],
            })
            .collect();
        let output = session.command("").args(words).arg("--json").output().unwrap();
        assert!(output.status.success(), "{line}");
        let again: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(again["settings"], result["settings"], "{line}");
    }
}
