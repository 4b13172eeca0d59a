//! Identity of points and of recordings: which settings a result depends on, and which of them decide what the work items do. Settings are digested
//! in parts, so that a plan digests a part once for all points that share its values.

use emu::machine::Config;
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::result::hexadecimal;
use crate::settings::{FileSettings, ResultSettings, Settings, VERSION};

/// Part of the settings that is digested by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettingsPart {
    /// Everything but the machine.
    Picture,
    /// Keys of the machine that stand in no group.
    Whole,
    /// Arithmetic, clocks and units, which depend on the word.
    Timing,
    /// The bus.
    Bus,
    /// The caches.
    Cache,
    /// The main processor.
    Main,
    /// Prices of energy.
    Energy,
    /// Prices of area.
    Area,
}

impl SettingsPart {
    /// Every part of the machine.
    pub const MACHINE: [SettingsPart; 7] = [
        SettingsPart::Whole,
        SettingsPart::Timing,
        SettingsPart::Bus,
        SettingsPart::Cache,
        SettingsPart::Main,
        SettingsPart::Energy,
        SettingsPart::Area,
    ];

    /// True where setting a key may change the part.
    pub fn has(self, key: &str) -> bool {
        let mut names = key.split('.');
        let (is_machine, group) = (names.next() == Some("machine"), names.next());
        match (is_machine, group) {
            (false, _) => self == SettingsPart::Picture,
            (true, None | Some("from")) => self != SettingsPart::Picture,
            (true, Some("arithmetic" | "clocks" | "units")) => self == SettingsPart::Timing,
            (true, Some("bus")) => self == SettingsPart::Bus,
            (true, Some("cache")) => self == SettingsPart::Cache,
            (true, Some("main")) => self == SettingsPart::Main,
            (true, Some("energy")) => self == SettingsPart::Energy,
            (true, Some("area")) => self == SettingsPart::Area,
            // Whether results are computed twice is part of the times of operations.
            (true, Some("protection")) => matches!(self, SettingsPart::Whole | SettingsPart::Timing),
            (true, Some(_)) => self == SettingsPart::Whole,
        }
    }
}

/// Digests of a part, or of several together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartDigest {
    /// SHA-256 of all that a point's result depends on.
    pub point: [u8; 32],
    /// SHA-256 of what a recording depends on; zeros where it depends on nothing of the part.
    pub recording: [u8; 32],
}

impl PartDigest {
    /// The digest of a part that decides what work items do, where two values may differ in what only a replay depends on.
    fn new(point: &impl Serialize, recording: &impl Serialize) -> PartDigest {
        PartDigest { point: digest(point), recording: digest(recording) }
    }

    /// The digest of a part that only replays depend on.
    fn replayed(point: &impl Serialize) -> PartDigest {
        PartDigest { point: digest(point), recording: [0; 32] }
    }

    /// The digest of all but the machine. A file is its contents, and what results depend on neither: names, and how the host works, are left out.
    pub fn of_picture(settings: &Settings) -> PartDigest {
        let mut settings = settings.clone();
        settings.scene.name.clear();
        settings.scene.mesh = None;
        let nameless = |file: &mut FileSettings| file.file.clear();
        settings.kernels.replaced.values_mut().for_each(nameless);
        settings.kernels.extensions.iter_mut().for_each(nameless);
        // Every key stands here, so that a new one does not compile before it is part of the digest.
        let Settings { scene, view, kernels, effort, tree, layout, formats, machine: _, engine: _, results } = settings;
        let layout = layout.map(scenes::layout::Layout::name);
        let point = (&scene, &view, &kernels, &effort, &tree, layout, &formats, &results);
        // A recording does not depend on what is measured of the picture.
        PartDigest::new(&point, &(&scene, &view, &kernels, &effort, &tree, layout, &formats, ResultSettings::default()))
    }

    /// The digest of a part of the machine.
    ///
    /// A recording does not depend on cores, clock rate, bus, caches, main processor, protections and the prices of energy and area, as
    /// [`Config::computes_like`] has it, but for the clocks of results that are computed twice. Clocks and units count as what they come to for the word.
    pub fn of_machine(part: SettingsPart, config: &Config) -> PartDigest {
        let Config {
            cores,
            clock_hz,
            buffer_octets,
            step_limit,
            packet_lanes,
            arithmetic,
            clocks,
            units,
            bus,
            cache,
            main,
            protection,
            energy,
            area,
        } = config;
        match part {
            SettingsPart::Picture => PartDigest { point: [0; 32], recording: [0; 32] },
            SettingsPart::Whole => {
                let computing = (buffer_octets, step_limit, packet_lanes);
                // The digest of a machine without protections is that of one that knew of none.
                match protection.is_none() {
                    true => PartDigest::new(&(cores, clock_hz, computing), &computing),
                    false => PartDigest::new(&(cores, clock_hz, computing, protection), &computing),
                }
            }
            SettingsPart::Timing => {
                let timing = config.timing();
                PartDigest::new(&(arithmetic, clocks, units), &(arithmetic, timing.clocks.0, timing.units.0))
            }
            SettingsPart::Bus => PartDigest::replayed(bus),
            SettingsPart::Cache => PartDigest::replayed(cache),
            SettingsPart::Main => PartDigest::replayed(main),
            SettingsPart::Energy => PartDigest::replayed(energy),
            SettingsPart::Area => PartDigest::replayed(area),
        }
    }

    /// The digest of several parts, in their order.
    pub fn joined(parts: &[PartDigest]) -> PartDigest {
        let of = |part: fn(&PartDigest) -> &[u8; 32]| {
            let mut hash = Sha256::new();
            parts.iter().for_each(|digest| hash.update(part(digest)));
            hash.update(VERSION);
            hash.finalize().into()
        };
        PartDigest { point: of(|digest| &digest.point), recording: of(|digest| &digest.recording) }
    }
}

/// Digests of a point and of its recording, which cover the version of this program and the settings with the contents of their files.
pub fn digests(settings: &Settings) -> PartDigest {
    let machine = SettingsPart::MACHINE.map(|part| PartDigest::of_machine(part, &settings.machine.config));
    PartDigest::joined(&[PartDigest::of_picture(settings), PartDigest::joined(&machine)])
}

/// SHA-256 of what a point's result depends on.
pub fn point(settings: &Settings) -> [u8; 32] {
    digests(settings).point
}

/// SHA-256 of what a recording depends on.
pub fn recording(settings: &Settings) -> [u8; 32] {
    digests(settings).recording
}

/// A digest in hexadecimal.
pub fn shown(digest: &[u8; 32]) -> String {
    hexadecimal(digest)
}

/// The digest of hexadecimal digits as [`shown`] writes them.
pub fn read(digits: &str) -> Option<[u8; 32]> {
    let octet = |at: usize| u8::from_str_radix(digits.get(2 * at..2 * at + 2)?, 16).ok();
    let mut digest = [0; 32];
    for (at, place) in digest.iter_mut().enumerate() {
        *place = octet(at)?;
    }
    // Neither signs nor capitals are such digits.
    (shown(&digest) == digits).then_some(digest)
}

fn digest(part: &impl Serialize) -> [u8; 32] {
    Sha256::digest(serde_json::to_vec(part).expect("settings have string keys")).into()
}

#[cfg(test)]
mod tests {
    use emu::machine::config::ProtectionConfig;
    use isa::Class;
    use serde_json::Value;

    use crate::settings::key::KEYS;

    use super::*;

    /// Settings that differ from others in one key.
    fn with_other_value(settings: &Settings, key: &str) -> Value {
        let mut value = settings.value();
        // Keys of few values, or of a form of their own, are named; others change by their type: false to true, 0.5 to 0.75, 2 to 3.
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
            ("tree.visit", _) => 50.into(),
            ("layout", _) => "report".into(),
            ("engine", _) => "checked".into(),
            ("machine.arithmetic.quantization", _) => "TRN".into(),
            ("machine.arithmetic.overflow", _) => "WRAP".into(),
            ("machine.bus.arbiter", _) => "tdma".into(),
            ("machine.protection.results", _) => "duplicated".into(),
            // Each structure takes other protections.
            _ if key.starts_with("machine.protection.") => {
                let name = key.rsplit('.').next().unwrap();
                let kind = ProtectionConfig::keys().find(|kind| kind.name() == name).unwrap();
                kind.protections()[0].name().into()
            }
            ("machine.energy.tables" | "machine.area.tables", _) => "horowitz".into(),
            _ if ["machine.energy.", "machine.area."].iter().any(|group| key.starts_with(group)) => "none".into(),
            ("machine.bus.weights", _) => serde_json::json!([3]),
            ("view.fov" | "effort.interpolate", _) => 0.5.into(),
            ("results.reference_bounces", _) => 2.into(),
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
    const REPLAYED: [&str; 9] = [
        "machine.cores",
        "machine.clock_hz",
        "machine.bus.",
        "machine.cache.",
        "machine.main.",
        "machine.protection.",
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
            let is_computing = key == "machine.protection.results";
            let is_replayed = REPLAYED.iter().any(|group| key.starts_with(group)) && !is_computing;
            let is_shared = recording(&changed) == recording(&settings);
            assert_eq!(is_shared, is_named || is_replayed, "recording, {key}");
            // Just the parts that have the key may change, of which the plan makes use.
            for part in SettingsPart::MACHINE {
                let of = |settings: &Settings| PartDigest::of_machine(part, &settings.machine.config);
                let is_other = of(&changed) != of(&settings);
                assert!(part.has(key) || !is_other, "{part:?}, {key}");
            }
            assert!(
                SettingsPart::Picture.has(key) || PartDigest::of_picture(&changed) == PartDigest::of_picture(&settings)
            );
            // The machine's own rule is the same.
            if key.starts_with("machine.") && !is_named {
                assert_eq!(is_shared, machine.computes_like(&changed.machine.config), "{key}");
            }
        }
    }

    #[test]
    fn digests_read_back_as_themselves() {
        let digest = point(&Settings::default());
        let digits = shown(&digest);
        assert_eq!(read(&digits), Some(digest));
        for text in ["", &digits[1..], &digits.to_uppercase(), &format!("+{}", &digits[1..]), &"é".repeat(32)] {
            assert_eq!(read(text), None, "{text}");
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
