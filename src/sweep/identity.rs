//! Identity of points and of recordings: which settings a result depends on, and which of them decide what the work items do.

use emu::engine::EngineKind;
use emu::machine::Config;
use emu::machine::config::law::Law;
use isa::Class;
use sha2::{Digest, Sha256};

use crate::result::hexadecimal;
use crate::settings::{FileSettings, ResultSettings, Settings, VERSION};

/// SHA-256 of what a point's result depends on: the version of this program and the settings with the contents of their files.
pub fn point(settings: &Settings) -> [u8; 32] {
    digest(&of_point(settings))
}

/// SHA-256 of what a recording depends on.
pub fn recording(settings: &Settings) -> [u8; 32] {
    digest(&of_recording(settings))
}

/// A digest in hexadecimal.
pub fn shown(digest: &[u8; 32]) -> String {
    hexadecimal(digest)
}

/// The settings without what no result depends on: names, and how the host works.
fn of_point(settings: &Settings) -> Settings {
    let mut settings = settings.clone();
    settings.scene.name.clear();
    settings.scene.mesh = None;
    settings.machine.name.clear();
    settings.engine = EngineKind::default();
    // A file is its contents.
    let nameless = |file: &mut FileSettings| file.file.clear();
    settings.kernels.replaced.values_mut().for_each(nameless);
    settings.kernels.extensions.iter_mut().for_each(nameless);
    settings
}

/// The settings without that in which only replays differ: cores, clock rate, bus, caches, main processor and the prices
/// of energy and area, as [`Config::computes_like`] has it, and what is measured of the picture. Clocks and units count as what they come to for the word.
fn of_recording(settings: &Settings) -> Settings {
    let mut settings = of_point(settings);
    settings.results = ResultSettings::default();
    let config = &mut settings.machine.config;
    let timing = config.timing();
    for &class in Class::ALL {
        config.clocks.0[class] = Law::Constant(timing.clocks[class]);
        config.units.0[class] = Law::Constant(timing.units[class]);
    }
    let Config { cores, clock_hz, bus, cache, main, energy, area, .. } = Config::default();
    *config = Config { cores, clock_hz, bus, cache, main, energy, area, ..config.clone() };
    settings
}

fn digest(settings: &Settings) -> [u8; 32] {
    let mut text = serde_json::to_vec(settings).expect("settings have string keys");
    text.extend(VERSION.bytes());
    Sha256::digest(text).into()
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use crate::settings::key::KEYS;

    use super::*;

    /// Settings that differ from others in one key.
    fn with_other_value(settings: &Settings, key: &str) -> Value {
        let mut value = settings.value();
        let other = match (key, KEYS.get(key)) {
            ("view.camera", _) => "perspective".into(),
            ("view.eye" | "view.look", _) => serde_json::json!([1, 2, 3]),
            ("view.size", _) => serde_json::json!([5, 6]),
            ("view.crop", _) => serde_json::json!([0, 0, 1, 1]),
            ("kernels.profile", _) => "ray".into(),
            ("kernels.extensions", _) => serde_json::json!([{ "file": "a.isa", "hash": "1" }]),
            ("kernels.replaced", _) => serde_json::json!({ "triangle": { "file": "a.s", "hash": "1" } }),
            ("effort.skips", _) => serde_json::json!(["unlit"]),
            ("tree.build", _) => "exact".into(),
            ("tree.depth", _) => 3.into(),
            ("layout", _) => "report".into(),
            ("engine", _) => "checked".into(),
            ("machine.arithmetic.quantization", _) => "TRN".into(),
            ("machine.arithmetic.overflow", _) => "WRAP".into(),
            ("machine.bus.arbiter", _) => "tdma".into(),
            ("machine.energy.tables" | "machine.area.tables", _) => "horowitz".into(),
            _ if ["machine.energy.", "machine.area."].iter().any(|group| key.starts_with(group)) => "none".into(),
            ("machine.bus.weights", _) => serde_json::json!([3]),
            ("view.fov" | "effort.interpolate", _) => 0.5.into(),
            (_, Some(Value::Bool(is_set))) => (!is_set).into(),
            (_, Some(Value::Number(number))) if number.is_f64() => (number.as_f64().unwrap() + 0.25).into(),
            (_, Some(Value::Number(number))) => (number.as_u64().unwrap() + 1).into(),
            (_, Some(Value::Array(numbers))) => Value::Array(numbers.iter().map(|_| 0.5.into()).collect()),
            (_, Some(Value::Null)) if key.starts_with("formats.") => 3.into(),
            _ => "another".into(),
        };
        let place = key.split('.').fold(&mut value, |value, part| &mut value[part]);
        *place = other;
        value
    }

    /// Keys that name things, or choose how the host works.
    const NAMES: [&str; 4] = ["scene.name", "scene.mesh", "machine.name", "engine"];

    /// Groups of keys that only replays and what is measured of a picture depend on.
    const REPLAYED: [&str; 8] = [
        "machine.cores",
        "machine.clock_hz",
        "machine.bus.",
        "machine.cache.",
        "machine.main.",
        "machine.energy.",
        "machine.area.",
        "results.",
    ];

    #[test]
    fn each_key_changes_the_hashes_that_depend_on_it() {
        let settings = Settings::default();
        let machine = &settings.machine.config;
        for key in KEYS.keys() {
            let changed = Settings::of_value(&with_other_value(&settings, key));
            let changed = changed.unwrap_or_else(|report| panic!("{key}: {}", report.render(false)));
            assert_ne!(changed, settings, "{key}");
            let is_named = NAMES.contains(&key.as_str());
            assert_eq!(point(&changed) == point(&settings), is_named, "point, {key}");
            let is_replayed = REPLAYED.iter().any(|group| key.starts_with(group));
            let is_shared = recording(&changed) == recording(&settings);
            assert_eq!(is_shared, is_named || is_replayed, "recording, {key}");
            // The machine's own rule is the same.
            if key.starts_with("machine.") && !is_named {
                assert_eq!(is_shared, machine.computes_like(&changed.machine.config), "{key}");
            }
        }
    }

    #[test]
    fn laws_count_as_what_they_come_to() {
        let with = |law: &str| {
            let mut settings = Settings::default();
            settings.machine.config.clocks.0[Class::Mul] = law.parse().unwrap();
            settings
        };
        assert_eq!(recording(&with("linear")), recording(&with("32")));
        assert_ne!(recording(&with("linear")), recording(&with("31")));
        assert_ne!(point(&with("linear")), point(&with("32")));
    }

    #[test]
    fn files_count_by_their_contents() {
        let with = |name: &str, hash: &str| {
            let mut settings = Settings::default();
            settings.kernels.extensions = vec![FileSettings { file: name.to_owned(), hash: Some(hash.to_owned()) }];
            point(&settings)
        };
        assert_eq!(with("a.isa", "1"), with("b.isa", "1"));
        assert_ne!(with("a.isa", "1"), with("a.isa", "2"));
    }
}
