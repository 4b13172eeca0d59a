//! A command line as settings: what a settings file stands for is put before what the user types, and commands that draw no single picture
//! have their options as settings.

use std::borrow::Cow;
use std::ffi::OsString;
use std::path::Path;
use std::sync::LazyLock;

use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command, CommandFactory};
use messages::{Diagnostic, Report, did_you_mean};
use scenes::model::Scene;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Serialize;
use serde_json::{Map, Value};

use super::Lancer;
use crate::settings::command_line::{OptionList, written};
use crate::settings::read::{self, COMMAND, StoredSettings};
use crate::settings::{MachineSettings, Settings, hash};

/// Arguments on which no result depends but for its form, place and time, by their long names.
const NO_SETTINGS: [&str; 23] = [
    "settings",
    "json",
    "csv",
    "svg",
    "markdown",
    "errata",
    "list",
    "output",
    "recordings",
    "recordings-limit",
    "timing",
    "threads",
    "resume",
    "help",
    "version",
    "full",
    "sidecar",
    "message-format",
    "color",
    "against",
    "tolerance",
    "map",
    "study",
];

/// Arguments that say together which machine there is.
const MACHINE: [&str; 7] = ["machine", "cores", "arbiter", "word", "rounding", "overflow", "set"];

/// All commands with their arguments, as they are before anything is parsed.
pub(super) static COMMAND_LINE: LazyLock<Command> = LazyLock::new(Lancer::command);

/// Options of a command that draws no single picture, as its results carry them.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct CommandSettings(Map<String, Value>);

impl JsonSchema for CommandSettings {
    fn schema_name() -> Cow<'static, str> {
        "CommandSettings".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": "object",
            "description": "The command, by `command`, and its options by their names with their values, defaults among them; a scene is an object with its name and its hash, a machine one with all its keys.",
        })
    }
}

impl CommandSettings {
    /// The options of the innermost command of a command line.
    pub fn new(matches: &ArgMatches) -> CommandSettings {
        let (path, command, matches) = innermost(&COMMAND_LINE, matches);
        let mut keys = Map::from_iter([(COMMAND.to_owned(), Value::from(path))]);
        for argument in command.get_arguments() {
            let name = name(argument);
            if NO_SETTINGS.contains(&name.as_str()) || matches.try_contains_id(argument.get_id().as_str()).is_err() {
                continue;
            }
            let values = matches.get_raw(argument.get_id().as_str()).into_iter().flatten();
            let mut values: Vec<Value> = values.map(|value| plain(&value.to_string_lossy())).collect();
            let is_list = is_list(argument);
            if let Some(value) =
                if is_list { (!values.is_empty()).then_some(Value::Array(values)) } else { values.pop() }
            {
                keys.insert(name, value);
            }
        }
        CommandSettings(keys)
    }

    /// The settings with the machine key by key in the place of the options that make it.
    #[must_use]
    pub fn with_machine(mut self, machine: &MachineSettings) -> CommandSettings {
        self.0.retain(|name, _| !MACHINE.contains(&name.as_str()));
        self.0.insert("machine".to_owned(), serde_json::json!(machine));
        self
    }

    /// The settings with several machines key by key in the place of their names; what other options change of them is still to be changed.
    #[must_use]
    pub fn with_machines(mut self, machines: &[MachineSettings]) -> CommandSettings {
        self.0.insert("machine".to_owned(), serde_json::json!(machines));
        self
    }

    /// The settings with the hash of each scene beside its name.
    #[must_use]
    pub fn with_scenes(mut self, scenes: &[(String, String)]) -> CommandSettings {
        let scenes: Vec<Value> =
            scenes.iter().map(|(name, hash)| serde_json::json!({ "name": name, "hash": hash })).collect();
        if !scenes.is_empty() {
            self.0.insert("scene".to_owned(), Value::Array(scenes));
        }
        self
    }

    /// The settings with the hash of the file that an option names.
    #[must_use]
    pub fn with_hash(mut self, hash: String) -> CommandSettings {
        self.0.insert("hash".to_owned(), hash.into());
        self
    }
}

/// Scenes by the names that were given, with their hashes.
pub fn scene_hashes(names: &[String], scenes: &[Scene]) -> Vec<(String, String)> {
    names.iter().cloned().zip(scenes.iter().map(hash::scene)).collect()
}

/// A command line with what its settings file stands for put behind it, as far as it does not say otherwise.
///
/// # Errors
/// A settings file that cannot be read, or has settings that the command does not know.
pub fn expanded(mut line: Vec<OsString>) -> Result<Vec<OsString>, Report> {
    let is_option = |word: &OsString| word.as_encoded_bytes().starts_with(b"--settings");
    if !line.iter().any(is_option) {
        return Ok(line);
    }
    // Whatever else is wrong with the command line is said when it is read for good.
    let parser = COMMAND_LINE.clone().ignore_errors(true);
    let Ok(matches) = parser.try_get_matches_from(&line) else { return Ok(line) };
    let (path, command, matches) = innermost(&COMMAND_LINE, &matches);
    let Ok(Some(file)) = matches.try_get_one::<std::path::PathBuf>("settings") else { return Ok(line) };
    let stored = read::read(file)?;
    let options = match takes_pictures(command) {
        true => picture(&stored)?,
        false if is_varied(&stored, command) => varied(&stored)?,
        false => others(&stored, &path, command, file)?,
    };
    let is_given = |argument: &Arg| matches.value_source(argument.get_id().as_str()) == Some(ValueSource::CommandLine);
    let given: Vec<String> = command.get_arguments().filter(|argument| is_given(argument)).map(name).collect();
    let mut sets = Vec::new();
    for (option, value) in options {
        let Some(argument) = command.get_arguments().find(|argument| name(argument) == option) else { continue };
        let set = value.as_deref().filter(|_| option == "set");
        // Changes of keys come before the user's, which win; the hash of another scene is none of this one's.
        if let Some(set) = set {
            let is_replaced = |option: &str| given.iter().any(|given| given == option);
            let is_other = (set.starts_with("scene.") && (is_replaced("scene") || is_replaced("mesh")))
                || (set.starts_with("kernels.hash")
                    && ["profile", "kernel", "layout", "set"].iter().any(|option| is_replaced(option)))
                || (set.starts_with("kernels.replaced") && is_replaced("kernel"))
                || (set.starts_with("kernels.extensions") && is_replaced("ext"));
            if !is_other {
                sets.push(OsString::from(format!("--set={set}")));
            }
            continue;
        }
        let is_part = option == "crop" && given.iter().any(|given| given == "pixel");
        if !is_part && !given.contains(&option) {
            line.extend(words(argument, &option, value));
        }
    }
    let first = line.iter().position(|word| word.as_encoded_bytes().starts_with(b"--set=") || word == "--set");
    let at = first.unwrap_or(line.len());
    line.splice(at..at, sets);
    Ok(line)
}

/// An option of a command line as words.
fn words(argument: &Arg, option: &str, value: Option<String>) -> Vec<OsString> {
    match value {
        None => vec![format!("--{option}").into()],
        Some(value) if argument.is_positional() => vec![value.into()],
        Some(value) => vec![format!("--{option}={value}").into()],
    }
}

/// The innermost command of a command line, with its name and its arguments.
fn innermost<'c>(mut command: &'c Command, mut matches: &'c ArgMatches) -> (String, &'c Command, &'c ArgMatches) {
    let mut path = Vec::new();
    while let Some((name, inner)) = matches.subcommand() {
        let Some(found) = command.find_subcommand(name) else { break };
        path.push(name);
        (command, matches) = (found, inner);
    }
    (path.join(" "), command, matches)
}

/// The name of an argument in settings: of an option its long name, of an operand the name of its value.
fn name(argument: &Arg) -> String {
    let value = || argument.get_value_names().and_then(|names| names.first()).map(|name| name.to_lowercase());
    argument.get_long().map(str::to_owned).or_else(value).unwrap_or_else(|| argument.get_id().to_string())
}

fn is_list(argument: &Arg) -> bool {
    matches!(argument.get_action(), ArgAction::Append)
}

/// True of a command that takes the options of a picture.
fn takes_pictures(command: &Command) -> bool {
    command.get_arguments().any(|argument| argument.get_id() == "kd_depth")
        && command.get_arguments().any(|argument| argument.get_id() == "profile")
}

/// A text as a number where it is the shortest form of one.
fn plain(text: &str) -> Value {
    let number = text.parse::<Value>().ok().filter(|value| value.is_number() || value.is_boolean());
    let is_shortest = |value: &Value| serde_json::to_string(value).is_ok_and(|shortest| shortest == text);
    number.filter(is_shortest).unwrap_or_else(|| text.into())
}

/// Options of a picture's settings, with those that a command has beside them.
fn picture(stored: &StoredSettings) -> Result<OptionList, Report> {
    let mut stored = stored.clone();
    // `lancer cores` has lists of machines and of cores beside the settings of a picture.
    let mut more = OptionList::new();
    // `lancer inject` has what it injects, `lancer extension suggest` a file and a number.
    let lists = [("machines", "machine"), ("cores", "cores"), ("extension", "file.isa"), ("most", "most")];
    let faults = ["kind", "injections", "bits", "pattern", "seed", "protect", "number"].map(|name| (name, name));
    // Protections are keys of the machine; an older result has them beside it, or in both places.
    if stored.keys.get("machine").is_some_and(|machine| machine.get("protection").is_some()) {
        stored.keys.remove("protect");
    }
    for (key, option) in lists.into_iter().chain(faults) {
        let values = match stored.keys.remove(key) {
            Some(Value::Array(values)) => values,
            value => value.into_iter().collect(),
        };
        // A file is named with its hash, which is that of another file as soon as it has another name.
        let text = |value: &Value| value["file"].as_str().map_or_else(|| written(key, value), str::to_owned);
        more.extend(values.iter().map(|value| (option.to_owned(), Some(text(value)))));
    }
    let mut options = stored.settings()?.options();
    if more.iter().any(|(option, _)| option == "machine") {
        options.retain(|(option, _)| option != "machine");
    }
    options.extend(more);
    Ok(options)
}

/// True of the settings of a picture for a command that varies them.
fn is_varied(stored: &StoredSettings, command: &Command) -> bool {
    let groups = Settings::default().value();
    command.get_name() == "accuracy" && stored.keys.keys().all(|key| groups.get(key).is_some())
}

/// Options of a picture's settings for a command that varies them: one value of each.
fn varied(stored: &StoredSettings) -> Result<OptionList, Report> {
    let settings = stored.clone().settings()?;
    let (arithmetic, effort) = (&settings.machine.config.arithmetic, &settings.effort);
    let layout = settings.layout.unwrap_or(settings.kernels.profile.layout());
    let mut options = settings.options();
    options.retain(|(option, _)| {
        !["profile", "layout", "bounces", "weight-cutoff", "interpolate"].contains(&option.as_str())
    });
    let lists = [
        ("profiles", settings.kernels.profile.name().to_owned()),
        ("layouts", layout.name().to_owned()),
        ("words", arithmetic.word.to_string()),
        ("roundings", arithmetic.quantization.name().to_owned()),
        ("bounces", effort.bounces.to_string()),
        ("cutoffs", effort.weight_cutoff.to_string()),
        ("interpolate", effort.interpolate.map_or_else(|| "none".to_owned(), |difference| difference.to_string())),
    ];
    options.extend(lists.map(|(option, value)| (option.to_owned(), Some(value))));
    Ok(options)
}

/// Options of the settings of a command that draws no single picture.
fn others(stored: &StoredSettings, path: &str, command: &Command, file: &Path) -> Result<OptionList, Report> {
    let wanted = stored.keys.get(COMMAND).and_then(Value::as_str);
    if wanted.is_some_and(|wanted| wanted != path) {
        let message = format!("{} has the settings of `lancer {}`", file.display(), wanted.unwrap_or_default());
        return Err(Diagnostic::error(message).hint(format!("this is `lancer {path}`")).into());
    }
    let names: Vec<String> = command.get_arguments().map(name).collect();
    let (mut options, mut messages) = (OptionList::new(), Vec::new());
    for (key, value) in stored.keys.iter().filter(|(key, _)| ![COMMAND, "hash"].contains(&key.as_str())) {
        if !names.contains(key) {
            let message = Diagnostic::error(format!("`{key}` is no setting of `lancer {path}`"));
            messages.push(match did_you_mean(key, names.iter().map(String::as_str)) {
                Some(hint) => message.hint(hint),
                None => message,
            });
            continue;
        }
        let values = match value {
            Value::Array(values) => values.iter().collect(),
            value => vec![value],
        };
        for value in values {
            let text = match value {
                // A flag that is off is left out.
                Value::Bool(false) => continue,
                Value::Bool(true) => None,
                Value::Object(scene) if key == "scene" => scene.get("name").and_then(Value::as_str).map(str::to_owned),
                Value::String(text) => Some(text.clone()),
                value => Some(value.to_string()),
            };
            options.push((key.clone(), text));
        }
    }
    if messages.is_empty() { Ok(options) } else { Err(Report(messages)) }
}
