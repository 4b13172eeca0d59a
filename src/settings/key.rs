//! Keys of settings: all of them with their values in default settings, and the shorter names by which they may be called.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use kernels::Function;
use messages::{Diagnostic, Report, did_you_mean};
use serde_json::Value;

use super::{FROM, Settings};

/// Options of the command line with the keys that they set; an option of several values sets what is below its key.
pub const OPTIONS: [(&str, &str); 34] = [
    ("scene", "scene.name"),
    ("mesh", "scene.mesh"),
    ("camera", "view.camera"),
    ("eye", "view.eye"),
    ("look", "view.look"),
    ("fov", "view.fov"),
    ("size", "view.size"),
    ("shift", "view.shift"),
    ("crop", "view.crop"),
    ("pixel", "view.crop"),
    ("ambient", "view.ambient"),
    ("background", "view.background"),
    ("profile", "kernels.profile"),
    ("kernel", "kernels.replaced"),
    ("ext", "kernels.extensions"),
    ("machine", "machine"),
    ("cores", "machine.cores"),
    ("arbiter", "machine.bus.arbiter"),
    ("word", "machine.arithmetic.word"),
    ("rounding", "machine.arithmetic.quantization"),
    ("overflow", "machine.arithmetic.overflow"),
    ("layout", "layout"),
    ("engine", "engine"),
    ("format", "formats"),
    ("bounces", "effort.bounces"),
    ("weight-cutoff", "effort.weight_cutoff"),
    ("no-skip", "effort.skips"),
    ("interpolate", "effort.interpolate"),
    ("kd-depth", "tree.depth"),
    ("kd-build", "tree.build"),
    ("kd-visit", "tree.visit"),
    ("flags", "results.flags"),
    ("energy", "results.energy"),
    ("shadow", "results.shadow"),
];

/// Every key with its value in default settings, groups left out.
pub static KEYS: LazyLock<BTreeMap<String, Value>> = LazyLock::new(|| {
    let settings = serde_json::to_value(Settings::default()).expect("settings have string keys");
    leaves(&settings).into_iter().map(|(key, value)| (key, value.clone())).collect()
});

/// Parts of a value that are no groups, by their keys with points between. An empty group is a part.
pub fn leaves(value: &Value) -> Vec<(String, &Value)> {
    fn collect<'v>(value: &'v Value, path: &str, found: &mut Vec<(String, &'v Value)>) {
        match value {
            Value::Object(keys) if !keys.is_empty() && !is_whole(path) => keys.iter().for_each(|(key, value)| {
                let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                collect(value, &path, found);
            }),
            Value::Object(_) if path.is_empty() => {}
            value => found.push((path.to_owned(), value)),
        }
    }
    let mut found = Vec::new();
    collect(value, "", &mut found);
    found
}

/// True of a key whose value is an object and yet no group: a file with its hash.
fn is_whole(path: &str) -> bool {
    path.strip_prefix(REPLACED).is_some_and(|function| !function.is_empty())
}

/// Key of the files that serve functions, up to a function's name.
const REPLACED: &str = "kernels.replaced.";

/// True of a key, of a group of keys, and of a function's file.
pub fn is_known(key: &str) -> bool {
    let is_group = || KEYS.keys().any(|known| known.strip_prefix(key).is_some_and(|rest| rest.starts_with('.')));
    let is_file = || key.strip_prefix(REPLACED).is_some_and(|function| function.parse::<Function>().is_ok());
    KEYS.contains_key(key) || is_group() || is_file() || key == format!("machine.{FROM}")
}

/// The key that a name stands for: the key itself, an option of the command line, a key of the machine file, or the end of one key alone.
///
/// # Errors
/// A name of no key or of several, with what is near and with all keys.
pub fn resolve(name: &str) -> Result<String, Report> {
    let name = name.trim();
    let name = name.strip_prefix("job.").unwrap_or(name);
    if is_known(name) {
        return Ok(name.to_owned());
    }
    let option = name.trim_start_matches("--").replace('_', "-");
    if let Some((_, key)) = OPTIONS.iter().find(|(known, _)| *known == option) {
        return Ok((*key).to_owned());
    }
    let of_machine = format!("machine.{name}");
    if is_known(&of_machine) {
        return Ok(of_machine);
    }
    let ending = format!(".{name}");
    let ends: Vec<&str> = KEYS.keys().map(String::as_str).filter(|key| key.ends_with(&ending)).collect();
    if let [key] = ends[..] {
        return Ok(key.to_owned());
    }
    if !ends.is_empty() && !name.is_empty() {
        let message = format!("`{name}` is the end of several keys");
        return Err(Diagnostic::error(message).hint(format!("write one of them in full: {}", ends.join(", "))).into());
    }
    // Short names are near to what somebody types, so all forms are candidates.
    let keys = || KEYS.keys().map(String::as_str);
    let short = keys().filter_map(|key| key.split_once('.')).map(|(_, rest)| rest);
    let last = keys().filter_map(|key| key.rsplit_once('.')).map(|(_, last)| last);
    let options = OPTIONS.iter().map(|(option, _)| *option);
    let near = if name.is_empty() { None } else { did_you_mean(name, keys().chain(short).chain(last).chain(options)) };
    let all = format!("the keys are {}", keys().collect::<Vec<_>>().join(", "));
    let hint = near.map_or_else(|| all.clone(), |near| format!("{near} {all}"));
    Err(Diagnostic::error(format!("`{name}` is no key of the settings")).hint(hint).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_have_short_names() {
        for (name, key) in [
            ("machine.bus.arbiter", "machine.bus.arbiter"),
            ("bus.arbiter", "machine.bus.arbiter"),
            ("arbiter", "machine.bus.arbiter"),
            ("cores", "machine.cores"),
            ("step_limit", "machine.step_limit"),
            ("main.step_limit", "machine.main.step_limit"),
            ("word", "machine.arithmetic.word"),
            ("kd-depth", "tree.depth"),
            ("kd_build", "tree.build"),
            ("job.effort.bounces", "effort.bounces"),
            ("weight_cutoff", "effort.weight_cutoff"),
            ("pos", "formats.pos"),
            ("machine", "machine"),
            ("bus", "machine.bus"),
            ("kernels.replaced.triangle", "kernels.replaced.triangle"),
        ] {
            assert_eq!(resolve(name).as_deref(), Ok(key), "{name}");
        }
    }

    #[test]
    fn names_of_no_key_are_refused_with_what_is_near() {
        for (name, near) in [
            ("machine.bus.arbitr", "did you mean `machine.bus.arbiter`?"),
            ("arbitr", "did you mean `arbiter`?"),
            ("", "the keys are effort.bounces, "),
            ("hash", "`hash` is the end of several keys"),
            ("kernels.replaced.trangle", "is no key"),
        ] {
            let message = resolve(name).expect_err(name).render(false);
            assert!(message.contains(near), "{name}: {message}");
        }
    }

    #[test]
    fn options_lead_to_keys() {
        assert!(OPTIONS.iter().all(|(_, key)| is_known(key)));
    }
}
