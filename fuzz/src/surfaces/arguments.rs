//! Command lines, with a settings file before them where they name one.

use std::cell::RefCell;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::LazyLock;

use clap::{Command, CommandFactory};
use lancer::command::{Lancer, invocation};
use lancer::settings::Settings;
use lancer::terminal::StreamArguments;

use crate::project::{listings, root};
use crate::seen::{PlantedFault, Seen, is_sample};
use crate::surface::{InputForm, Surface};

/// Command lines, a word a line.
pub const ARGUMENTS: Surface = Surface {
    name: "arguments",
    form: InputForm::Text,
    longest: 400,
    memory: 64 << 20,
    seeds: command_lines,
    run: parse,
    reader: &["src/arguments", "src/command/invocation.rs", "src/settings/command_line.rs"],
};

/// Word that stands for a file of settings, wherever the project lies.
const SETTINGS: &str = "SETTINGS.toml";

/// File of the settings of a picture.
static STORED: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = root().join("target/fuzz");
    std::fs::create_dir_all(&folder).expect("it can be made");
    let path = folder.join(SETTINGS);
    std::fs::write(&path, toml::to_string(&Settings::default()).expect("settings are TOML"))
        .expect("it can be written");
    path
});

/// The lines of all pages, and each option of each command as the parser knows them.
fn command_lines() -> Vec<Vec<u8>> {
    let text = String::from_utf8_lossy(&listings().concat()).into_owned();
    let lines = text.lines().filter_map(|line| line.trim_start_matches("$ ").strip_prefix("lancer "));
    let lines =
        lines.map(|line| line.split('#').next().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join("\n"));
    let mut all: Vec<String> = lines.collect();
    options(&Lancer::command(), &mut Vec::new(), &mut all);
    all.sort();
    all.dedup();
    all.into_iter().map(String::into_bytes).collect()
}

/// Puts a line for each option of a command on a list, and for each of the commands below it.
fn options(command: &Command, path: &mut Vec<String>, all: &mut Vec<String>) {
    let positionals = command.get_positionals().filter(|argument| argument.is_required_set());
    let words = path.iter().cloned().chain(positionals.map(|_| "a".to_owned())).collect::<Vec<_>>().join("\n");
    for argument in command.get_opts() {
        let Some(name) = argument.get_long() else { continue };
        let value = match argument.get_possible_values().first() {
            Some(value) => value.get_name().to_owned(),
            None if name == "settings" => SETTINGS.to_owned(),
            None => "1".to_owned(),
        };
        let has_value = argument.get_action().takes_values();
        all.push(if has_value { format!("{words}\n--{name}={value}") } else { format!("{words}\n--{name}") });
    }
    for below in command.get_subcommands() {
        path.push(below.get_name().to_owned());
        options(below, path, all);
        path.pop();
    }
}

thread_local! {
    static PARSER: RefCell<Command> = RefCell::new(Lancer::parser(StreamArguments::default()));
}

fn parse(input: &[u8], seen: &mut Seen) {
    let text = String::from_utf8_lossy(input);
    let stored = || STORED.display().to_string();
    let words: Vec<OsString> = ["lancer".to_owned()]
        .into_iter()
        .chain(
            text.lines()
                .map(|word| if word.contains(SETTINGS) { word.replace(SETTINGS, &stored()) } else { word.to_owned() }),
        )
        .map(OsString::from)
        .collect();
    let streams = StreamArguments::sniffed(&words);
    let words = match invocation::expanded(words) {
        Err(report) => return seen.report(&report, input),
        Ok(words) => words,
    };
    // A parser is made for each command line, which takes much longer than to parse it: seldom here.
    let parsed = match is_sample(input, 64) {
        true => Lancer::parsed(words, streams),
        false => PARSER.with_borrow_mut(|parser| Lancer::parsed_by(parser, words)),
    };
    match parsed {
        Err(message) => {
            seen.name(&format!("{:?}", message.kind()));
            seen.text(message.to_string().lines().next().unwrap_or_default());
        }
        Ok((arguments, given)) => {
            seen.name(text.lines().next().unwrap_or_default().split('=').next().unwrap_or_default());
            seen.count("words", text.lines().count());
            assert!(serde_json::to_value(&given).is_ok(), "options are settings");
            let shown = format!("{arguments:?}");
            seen.plant(PlantedFault::Panic, shown.contains("Some(") && text.lines().count() == 4);
        }
    }
}
