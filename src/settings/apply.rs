//! Changes to settings, key by key: values as people type them become what the key holds.

use std::sync::LazyLock;

use emu::machine::preset::{PRESETS, Preset};
use messages::{Diagnostic, Report, did_you_mean, plain};
use serde_json::{Map, Number, Value};

use super::key::{self, KEYS};
use super::{FROM, MachineSettings, Settings};

impl Settings {
    /// The settings as JSON.
    pub fn value(&self) -> Value {
        serde_json::to_value(self).expect("settings have string keys")
    }

    /// Settings from JSON with every key.
    ///
    /// # Errors
    /// A value of the wrong kind, without its place.
    pub fn of_value(value: &Value) -> Result<Settings, Report> {
        serde::Deserialize::deserialize(value).map_err(|error: serde_json::Error| explained(&error.to_string()).into())
    }

    /// The settings with keys changed as `--set KEY=VALUE` asks, the first change first.
    ///
    /// # Errors
    /// One message for each that is no key, or no value of its key.
    pub fn with(self, sets: &[String]) -> Result<Settings, Report> {
        let (mut settings, mut messages) = (self, Vec::new());
        for set in sets {
            match one(&settings, set) {
                Ok(changed) => settings = changed,
                Err(report) => messages.extend(report.0),
            }
        }
        if messages.is_empty() { Ok(settings) } else { Err(Report(messages)) }
    }
}

/// The settings with one change.
fn one(settings: &Settings, set: &str) -> Result<Settings, Report> {
    let Some((name, text)) = set.split_once('=') else {
        let message = Diagnostic::error(format!("`{set}` sets no key"));
        return Err(message.hint("write a key and its value, such as machine.bus.arbiter=tdma").into());
    };
    let key = key::resolve(name)?;
    let mut value = settings.value();
    change(&mut value, &key, Value::String(text.trim().to_owned()))?;
    let blamed = |message: Diagnostic| Diagnostic { message: format!("--set {set}: {}", message.message), ..message };
    let changed = Settings::of_value(&value).and_then(|changed| changed.check().map(|()| changed));
    changed.map_err(|report| Report(report.0.into_iter().map(blamed).collect()))
}

/// Changes a key, and forgets the hashes of what is then another thing.
///
/// # Errors
/// A machine that does not exist, or a text that is no value of the key.
pub fn change(settings: &mut Value, key: &str, value: Value) -> Result<(), Report> {
    let is_scene = key.starts_with("scene") && key != "scene.hash";
    let is_kernels = ["kernels", "layout"].iter().any(|group| key.starts_with(group)) && key != "kernels.hash";
    put(settings, key, value)?;
    for (group, is_other) in [("scene", is_scene), ("kernels", is_kernels)] {
        // A list in the place of the group is refused when the settings are read, and has no hash.
        if let Some(keys) = settings[group].as_object_mut().filter(|_| is_other) {
            keys.insert("hash".to_owned(), Value::Null);
        }
    }
    Ok(())
}

/// Keys of each preset; studies choose presets for each of many points.
static PRESET_KEYS: LazyLock<Vec<(&str, Value)>> = LazyLock::new(|| {
    let keys =
        |preset: &Preset| machine_keys(&MachineSettings { name: preset.name.to_owned(), config: preset.config() });
    PRESETS.iter().map(|preset| (preset.name, keys(preset))).collect()
});

fn machine_keys(machine: &MachineSettings) -> Value {
    serde_json::to_value(machine).expect("a machine has string keys")
}

/// Puts a value in the place of a key's; a group takes the keys of an object one by one.
///
/// # Errors
/// See [`change`].
pub fn put(settings: &mut Value, key: &str, value: Value) -> Result<(), Report> {
    match (key, value) {
        ("machine" | "machine.from", Value::String(name)) => {
            settings["machine"] = match PRESET_KEYS.iter().find(|(preset, _)| *preset == name) {
                Some((_, keys)) => keys.clone(),
                None => machine_keys(&MachineSettings::find(&name)?),
            };
        }
        ("scene", Value::String(name)) => {
            settings["scene"] = serde_json::json!({ "name": name, "mesh": null, "hash": null });
        }
        (key, Value::Object(mut keys)) if !KEYS.contains_key(key) && !key.starts_with("kernels.replaced") => {
            // What the other keys change comes first.
            if let Some(from) = keys.remove(FROM).filter(|_| key == "machine") {
                put(settings, "machine.from", from)?;
            }
            for (name, value) in keys {
                let below = format!("{key}.{name}");
                if !key::is_known(&below) {
                    key::resolve(&below)?;
                }
                put(settings, &below, value)?;
            }
        }
        (key, value) => {
            let value = read(key, value)?;
            *place(settings, key) = value;
        }
    }
    Ok(())
}

/// The place of a key, which is made where it is not there.
fn place<'v>(settings: &'v mut Value, key: &str) -> &'v mut Value {
    key.split('.').fold(settings, |value, name| {
        if !value.is_object() {
            *value = Value::Object(Map::new());
        }
        &mut value[name]
    })
}

/// A value for a key; a text becomes what the key holds.
fn read(key: &str, value: Value) -> Result<Value, Report> {
    let Value::String(text) = &value else { return Ok(value) };
    let refuse = |expected: &str| {
        Err(Diagnostic::error(format!("`{text}` is no value of `{key}`: {expected} is expected")).into())
    };
    let Some(example) = KEYS.get(key) else { return Ok(structured(text).unwrap_or(value)) };
    match example {
        // Numbers that may also be words keep the word.
        Value::Number(_) if is_law(key) => Ok(number(text).unwrap_or(value)),
        Value::Number(_) => match number(text) {
            Some(number) => Ok(number),
            None => refuse("a number"),
        },
        Value::Bool(_) => match text.as_str() {
            "true" | "yes" | "1" => Ok(true.into()),
            "false" | "no" | "0" => Ok(false.into()),
            _ => refuse("true or false"),
        },
        Value::Null if key == "tree.depth" && text != "null" => Ok(number(text).unwrap_or(value)),
        Value::Null if ["", "null", "none", "auto"].contains(&text.as_str()) => Ok(Value::Null),
        // A key that may be null holds a number, a list of numbers or a word.
        Value::Null if key == "scene.mesh" || key.ends_with(".hash") => Ok(value),
        Value::Null if key == "view.size" => Ok(numbers(&text.replace(['x', 'X'], ",")).unwrap_or(value)),
        Value::Null => Ok(structured(text).or_else(|| number(text)).or_else(|| numbers(text)).unwrap_or(value)),
        Value::Array(_) => Ok(structured(text).or_else(|| numbers(text)).unwrap_or_else(|| words(text))),
        Value::Object(_) => structured(text).map_or_else(|| refuse("an object"), Ok),
        _ => Ok(value),
    }
}

/// True of a key that may hold a law of the word's bits in the place of its number.
fn is_law(key: &str) -> bool {
    ["machine.clocks.", "machine.units."].iter().any(|table| key.starts_with(table))
}

/// A list or an object as JSON.
fn structured(text: &str) -> Option<Value> {
    if text.starts_with(['[', '{']) { serde_json::from_str(text).ok() } else { None }
}

/// A number, decimal, with `_` between digits or commas between thousands.
fn number(text: &str) -> Option<Value> {
    let plain = text.trim().replace('_', "");
    let whole = plain.parse::<u64>().map(Number::from).or_else(|_| plain.parse::<i64>().map(Number::from)).ok();
    let real = || plain.parse::<f64>().ok().and_then(Number::from_f64);
    whole.or_else(real).or_else(|| grouped(&plain)).map(Value::Number)
}

/// `1,000,000`: groups of three digits.
fn grouped(text: &str) -> Option<Number> {
    let (first, rest) = text.split_once(',')?;
    let is_grouped = (1..=3).contains(&first.len()) && rest.split(',').all(|group| group.len() == 3);
    let digits = text.replace(',', "");
    (is_grouped && digits.bytes().all(|digit| digit.is_ascii_digit()))
        .then(|| digits.parse::<u64>().ok().map(Number::from))?
}

/// Numbers between commas.
fn numbers(text: &str) -> Option<Value> {
    let one = |part: &str| {
        let plain = part.trim();
        let whole = plain.parse::<u64>().map(Number::from).or_else(|_| plain.parse::<i64>().map(Number::from)).ok();
        whole.or_else(|| plain.parse::<f64>().ok().and_then(Number::from_f64)).map(Value::Number)
    };
    text.split(',').map(one).collect::<Option<Vec<Value>>>().map(Value::Array)
}

/// Words between commas; none for an empty text.
fn words(text: &str) -> Value {
    let words = text.split(',').map(str::trim).filter(|word| !word.is_empty());
    Value::Array(words.map(|word| Value::String(word.to_owned())).collect())
}

/// A reader's message about a value in plain words, with what is near.
pub fn explained(message: &str) -> Diagnostic {
    let first = message.split(" at line ").next().unwrap_or(message);
    let diagnostic = Diagnostic::error(plain(first));
    // The reader quotes the wrong word first and then all that would be right.
    let mut quoted = first.split('`').skip(1).step_by(2);
    let near = quoted.next().filter(|_| first.contains("unknown")).and_then(|wrong| did_you_mean(wrong, quoted));
    match near {
        Some(hint) => diagnostic.hint(hint),
        None => diagnostic,
    }
}

#[cfg(test)]
mod tests {
    use kernels::{KernelSet, Skips};
    use scenes::kdtree::Depth;

    use super::*;

    fn with(sets: &[&str]) -> Settings {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        Settings::default().with(&sets).unwrap_or_else(|report| panic!("{}", report.render(false)))
    }

    #[test]
    fn texts_become_what_a_key_holds() {
        let settings = with(&[
            "scene=slabs",
            "size=160x120",
            "shift=0.5,-0.25",
            "crop=1,2,3,4",
            "fov=30",
            "camera=perspective",
            "eye=1,2,3",
            "profile=ray",
            "bounces=2",
            "skips=unlit,beyond",
            "interpolate=0.01",
            "kd-depth=auto",
            "formats.dir=-3",
            "layout=report",
            "machine=wide32",
            "cores=8",
            "bus.weights=3,1",
            "step_limit=1,000,000",
            "main.traffic=false",
            "kernels.replaced.triangle=my.s",
            "results.flags=true",
        ]);
        assert_eq!((settings.scene.name.as_str(), settings.view.size), ("slabs", Some([160, 120])));
        assert_eq!((settings.view.shift, settings.view.crop), ([0.5, -0.25], Some([1, 2, 3, 4])));
        assert_eq!((settings.view.fov, settings.view.eye), (Some(30.0), Some([1.0, 2.0, 3.0])));
        assert_eq!((settings.kernels.profile, settings.effort.bounces), (KernelSet::Ray, 2));
        assert_ne!(settings.effort.skips, Skips::ALL);
        assert_eq!((settings.effort.interpolate, settings.tree.depth), (Some(0.01), Some(Depth::Auto)));
        assert_eq!((settings.formats.dir, settings.machine.name.as_str()), (Some(-3), "wide32"));
        let machine = &settings.machine.config;
        assert_eq!((machine.cores, machine.step_limit, machine.main.traffic), (8, 1_000_000, false));
        assert_eq!(machine.bus.weights, [3, 1]);
        assert_eq!(settings.kernels.replaced["triangle"].file, "my.s");
        assert!(settings.results.flags);
        // A later change wins, and `null` takes one back.
        assert_eq!(with(&["crop=1,2,3,4", "crop=none", "cores=2", "machine=report"]).machine.config.cores, 4);
    }

    #[test]
    fn mistakes_are_named_with_what_is_near() {
        for (set, message) in [
            ("arbitr=tdma", "did you mean `arbiter`?"),
            ("bus.arbiter=tdmaa", "did you mean `tdma`?"),
            ("profile=rai", "did you mean `ray`?"),
            ("cores=many", "a number is expected"),
            ("cores=0", "must lie in 1..=256"),
            ("main.traffic=perhaps", "true or false"),
            ("machine=raport", "did you mean `report`?"),
            ("bounces=31", "`effort.bounces` is out of its range"),
            ("cores", "sets no key"),
            ("kernels=[1]", "--set kernels=[1]: "),
            ("protection=ecc", "--set protection=ecc: a table is expected, not text \"ecc\""),
            ("bus=3", "a table is expected, not text \"3\""),
        ] {
            let error = Settings::default().with(&[set.to_owned()]).expect_err(set).render(false);
            assert!(error.contains(message), "{set}: {error}");
        }
        let both = Settings::default().with(&["a=1".into(), "b=2".into()]).expect_err("two are wrong");
        assert_eq!(both.0.len(), 2);
    }
}
