//! The canonical command line of settings: one option a key that differs from its default, in the order of the keys.

use serde_json::Value;

use super::key::{self, KEYS, OPTIONS};
use super::named::NamedChoice;
use super::{MachineSettings, Settings};
use kernels::Skip;

/// Options of a command line, each with its value; `None` for one that takes none.
pub type OptionList = Vec<(String, Option<String>)>;

/// Options whose values stand in the machine's.
const OF_MACHINE: [&str; 5] = ["cores", "arbiter", "word", "rounding", "overflow"];

impl Settings {
    /// Options that give these settings on top of the defaults, hashes of files included: what reading a settings file stands for.
    pub fn options(&self) -> OptionList {
        let mut options = self.plain(false);
        let machine = serde_json::to_string(&self.machine).expect("a machine has string keys");
        options.push(("machine".to_owned(), Some(machine)));
        let hashes = [("scene.hash", &self.scene.hash), ("kernels.hash", &self.kernels.hash)];
        // Files go with their hashes, which no option of the command line has.
        let files = self
            .kernels
            .replaced
            .iter()
            .map(|(function, file)| (format!("kernels.replaced.{function}"), serde_json::json!(file)));
        let extensions = (!self.kernels.extensions.is_empty())
            .then(|| ("kernels.extensions".to_owned(), serde_json::json!(self.kernels.extensions)));
        let hashes = hashes.into_iter().filter_map(|(key, hash)| Some((key.to_owned(), Value::from(hash.clone()?))));
        let sets = files.chain(extensions).chain(hashes);
        options.extend(sets.map(|(key, value)| ("set".to_owned(), Some(format!("{key}={}", written(&key, &value))))));
        options
    }

    /// The shortest command line that a person would type for `lancer COMMAND`.
    pub fn command_line(&self, command: &str) -> String {
        let mut line = format!("lancer {command}");
        for (option, value) in self.plain(true).into_iter().chain(self.machine_options()) {
            line += &match value {
                _ if option == "scene" => format!(" {}", quoted(&value.unwrap_or_default())),
                None => format!(" --{option}"),
                Some(value) if option == "interpolate" => format!(" --{option}={value}"),
                Some(value) => format!(" --{option} {}", quoted(&value)),
            };
        }
        line
    }

    /// Options of all keys but the machine's; `has_files` with files by their names alone.
    fn plain(&self, has_files: bool) -> OptionList {
        let (settings, mut options) = (self.value(), Vec::new());
        let is_plain = |option: &str| !OF_MACHINE.contains(&option) && !["machine", "pixel"].contains(&option);
        for (option, key) in OPTIONS.into_iter().filter(|(option, _)| is_plain(option)) {
            let value = key.split('.').fold(&settings, |value, name| &value[name]);
            let default = KEYS.get(key).unwrap_or(&Value::Null);
            match option {
                "kernel" | "ext" if !has_files => {}
                "kernel" => options.extend(
                    self.kernels
                        .replaced
                        .iter()
                        .map(|(function, file)| (option.into(), Some(format!("{function}={}", file.file)))),
                ),
                "ext" => {
                    options.extend(self.kernels.extensions.iter().map(|file| (option.into(), Some(file.file.clone()))))
                }
                "format" => options.extend(
                    key::leaves(value)
                        .into_iter()
                        .filter(|(_, bits)| !bits.is_null())
                        .map(|(name, bits)| (option.into(), Some(format!("{name}={bits}")))),
                ),
                "no-skip" => {
                    let without: Vec<String> =
                        Skip::ALL.iter().filter(|&&skip| !self.effort.skips.has(skip)).map(NamedChoice::name).collect();
                    options.extend((!without.is_empty()).then(|| (option.into(), Some(without.join(",")))));
                }
                "flags" | "energy" | "shadow" => {
                    options.extend((*value == Value::Bool(true)).then(|| (option.into(), None)));
                }
                _ if value == default => {}
                _ => options.push((option.into(), Some(written(key, value)))),
            }
        }
        options.extend((!self.results.error).then(|| ("no-error".to_owned(), None)));
        // A key without an option of its own.
        let bounces = self.results.reference_bounces.map(|bounces| format!("results.reference_bounces={bounces}"));
        options.extend(bounces.map(|set| ("set".to_owned(), Some(set))));
        options
    }

    /// Options that make the machine of a preset: its name, options that there are, and each other key that differs.
    fn machine_options(&self) -> OptionList {
        let mut options = Vec::new();
        let from =
            MachineSettings::find(&self.machine.name).ok().filter(|_| !self.machine.name.contains(['.', '/', '{']));
        if from.is_some() && self.machine.name != MachineSettings::default().name {
            options.push(("machine".to_owned(), Some(self.machine.name.clone())));
        }
        let value = |machine: &MachineSettings| serde_json::to_value(machine).expect("a machine has string keys");
        let (before, now) = (value(&from.unwrap_or_default()), value(&self.machine));
        let changed = key::leaves(&now).into_iter().zip(key::leaves(&before)).filter(|(now, before)| now != before);
        for ((key, value), _) in changed.filter(|((key, _), _)| key != super::NAME) {
            let key = format!("machine.{key}");
            let text = written(&key, value);
            options.push(match OPTIONS.iter().find(|(option, of)| *of == key && OF_MACHINE.contains(option)) {
                Some((option, _)) => ((*option).to_owned(), Some(text)),
                None => ("set".to_owned(), Some(format!("{key}={text}"))),
            });
        }
        options
    }
}

/// A value as `--set` and the options read it.
pub fn written(key: &str, value: &Value) -> String {
    let word = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    match value {
        Value::Array(parts) if parts.iter().any(Value::is_object) => value.to_string(),
        Value::Array(parts) => {
            parts.iter().map(word).collect::<Vec<_>>().join(if key == "view.size" { "x" } else { "," })
        }
        value => word(value),
    }
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "_-./,=:+@%".contains(letter);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}
