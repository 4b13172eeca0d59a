//! Everything that a user types or a script reads by key, held to the list in `tests/contract.txt`: an entry that goes or changes is a
//! change of the interface, an entry that comes is written by `LANCER_BLESS=1 cargo test -p lancer contract`. The list is put together from
//! the tables that the product itself reads.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, Command, CommandFactory};
use emu::machine::Config;
use emu::machine::arbiter::ArbiterKind;
use emu::machine::preset::PRESETS;
use isa::number::{Overflow, Quantization};
use lancer::command::Lancer;
use lancer::job::Job;
use lancer::load::Load;
use serde_json::Value;

/// Set to write the list as it is now.
const BLESS: &str = "LANCER_BLESS";

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Texts between blanks.
fn joined<T: ToString>(parts: impl IntoIterator<Item = T>) -> String {
    parts.into_iter().map(|part| part.to_string()).collect::<Vec<_>>().join(" ")
}

/// One option or operand of a command, with the name of its value, the values that it may have and its default.
fn argument(argument: &Arg) -> String {
    // Name it as in `--output -o FILE`
    let mut text = match (argument.get_long(), argument.get_short()) {
        (Some(long), Some(short)) => format!("--{long} -{short}"),
        (Some(long), None) => format!("--{long}"),
        (None, Some(short)) => format!("-{short}"),
        (None, None) => "operand".to_owned(),
    };
    for alias in argument.get_visible_aliases().into_iter().flatten() {
        text += &format!(" --{alias}");
    }
    // Say what its value may be, as in `--profile NAME [report|vector] = vector`
    let takes_value = matches!(argument.get_action(), ArgAction::Set | ArgAction::Append);
    if takes_value {
        text += &format!(" {}", joined(argument.get_value_names().unwrap_or_default()));
        let values: Vec<String> =
            argument.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect();
        if !values.is_empty() {
            text += &format!(" [{}]", values.join("|"));
        }
        let defaults = argument.get_default_values().iter().map(|value| value.to_string_lossy().into_owned());
        let defaults: Vec<String> = defaults.collect();
        if !defaults.is_empty() {
            text += &format!(" = {}", defaults.join(","));
        }
        if argument.is_require_equals_set() {
            text += ", with `=`";
        }
        if argument.is_ignore_case_set() {
            text += ", any case";
        }
        if let Some(delimiter) = argument.get_value_delimiter() {
            text += &format!(", `{delimiter}` between values");
        }
    }
    // Say how often it may be there, as in `--ext FILE.isa, may be repeated`
    if argument.is_required_set() {
        text += ", required";
    }
    if matches!(argument.get_action(), ArgAction::Append) {
        text += ", may be repeated";
    }
    text
}

/// A command's options and operands and those of the commands below it.
fn commands(command: &Command, above: &str, list: &mut Vec<String>) {
    let path = format!("{above}{}", command.get_name());
    list.push(format!("command {path}"));
    list.extend(command.get_arguments().map(|one| format!("option {path}: {}", argument(one))));
    for below in command.get_subcommands() {
        commands(below, &format!("{path} "), list);
    }
}

/// The keys of a part of a schema, from the result's root on; `above` has the parts that it is in, so that none is followed into itself.
fn keys(schema: &Value, part: &Value, path: &str, above: &[&str], list: &mut Vec<String>) {
    let name = part["$ref"].as_str().map(|name| name.trim_start_matches("#/$defs/"));
    match name {
        Some(name) if above.contains(&name) => return,
        Some(name) => return keys(schema, &schema["$defs"][name], path, &[above, &[name]].concat(), list),
        None => {}
    }
    for one in part["anyOf"].as_array().into_iter().flatten() {
        keys(schema, one, path, above, list);
    }
    if let Some(items) = part.get("items") {
        keys(schema, items, &format!("{path}[]"), above, list);
    }
    if let Some(values) = part.get("additionalProperties").filter(|values| values.is_object()) {
        list.push(format!("json {path}.*: {}", plain_type(schema, values)));
        keys(schema, values, &format!("{path}.*"), above, list);
    }
    let required: BTreeSet<&str> =
        part["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    for (key, property) in part["properties"].as_object().into_iter().flatten() {
        let path = format!("{path}.{key}");
        let need = if required.contains(&**key) { "" } else { ", may be left out" };
        list.push(format!("json {path}: {}{need}", plain_type(schema, property)));
        keys(schema, property, &path, above, list);
    }
}

/// The JSON type of a part. The names of parts are Rust's and no part of the interface.
fn plain_type(schema: &Value, part: &Value) -> String {
    if let Some(name) = part["$ref"].as_str() {
        return plain_type(schema, &schema["$defs"][name.trim_start_matches("#/$defs/")]);
    }
    if let Some(any) = part["anyOf"].as_array() {
        return any.iter().map(|one| plain_type(schema, one)).collect::<Vec<_>>().join("|");
    }
    let name = match &part["type"] {
        Value::Array(names) => names.iter().filter_map(Value::as_str).collect::<Vec<_>>().join("|"),
        name => name.as_str().unwrap_or("any").to_owned(),
    };
    match (part.get("items"), part["const"].as_str()) {
        (Some(items), _) => format!("{name} of {}", plain_type(schema, items)),
        (None, Some(value)) => format!("{name} {value}"),
        (None, None) => name,
    }
}

/// JSON schemas and their keys.
fn schemas(list: &mut Vec<String>) {
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(root().join("docs/schemas")).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    for path in paths {
        let schema: Value = serde_json::from_str(&read(&path)).unwrap();
        let name = schema["title"].as_str().unwrap();
        list.push(format!("schema {name}"));
        let mut found = Vec::new();
        keys(&schema, &schema, name, &[], &mut found);
        let mut seen = BTreeSet::new();
        list.extend(found.into_iter().filter(|line| seen.insert(line.clone())));
    }
}

/// Keys of a TOML document with the types of their values; those of all elements of a list are one.
fn toml_keys(value: &toml::Value, path: &str, list: &mut BTreeSet<String>) {
    match value {
        toml::Value::Table(table) => table.iter().for_each(|(key, value)| {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            toml_keys(value, &path, list);
        }),
        toml::Value::Array(values) if values.iter().any(toml::Value::is_table) => {
            values.iter().for_each(|value| toml_keys(value, &format!("{path}[]"), list));
        }
        value => {
            list.insert(format!("{path}: {}", value.type_str()));
        }
    }
}

/// Machine files, with the values of each preset that differ from the first's, and the annex's rows.
fn tables(list: &mut Vec<String>) {
    let mut defaults = BTreeSet::new();
    for preset in PRESETS {
        list.push(format!("machine {}", preset.name));
        let (mut section, mut lines) = (String::new(), Vec::new());
        for line in preset.config().text().lines().filter(|line| !line.is_empty()) {
            match line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
                Some(name) => section = format!("{name}."),
                None => lines.push(format!("{section}{line}")),
            }
        }
        let differing = lines.iter().filter(|line| !defaults.contains(*line));
        list.extend(differing.map(|line| format!("machine {}: {line}", preset.name)));
        defaults = if defaults.is_empty() { lines.into_iter().collect() } else { defaults };
    }
    assert_eq!(PRESETS[0].config(), Config::default());
    let annex = read(&root().join("kernels/annex.toml")).parse::<toml::Table>().unwrap();
    let mut found = BTreeSet::new();
    toml_keys(&toml::Value::Table(annex), "", &mut found);
    list.extend(found.into_iter().map(|key| format!("annex.toml {key}")));
}

/// Instructions, directives, functions and codes of messages.
fn language(list: &mut Vec<String>) {
    for row in isa::INSTRUCTIONS {
        let operands = row.operands.iter().map(|one| format!("{}:{}", char::from(one.letter), one.kind.name()));
        let exits = row.outcomes.iter().map(|outcome| &*outcome.name);
        list.push(format!("instruction {} ({}) \"{}\" [{}]", row.name, joined(operands), row.drawn, joined(exits)));
    }
    list.extend(asm::pseudo::PSEUDOS.iter().map(|pseudo| format!("pseudo-instruction {}", pseudo.usage())));
    for directive in asm::directive::DIRECTIVES {
        let names = std::iter::once(directive.name).chain(directive.also.iter().copied());
        list.push(format!("directive {} {}", joined(names), directive.operands).trim_end().to_owned());
    }
    list.extend(asm::function::FUNCTIONS.iter().map(|function| format!("function {}", function.usage)));
    list.extend(isa::definition::Kind::ALL.map(|kind| format!("kind of operand {}", kind.name())));
    list.extend(isa::Class::ALL.iter().map(|class| format!("class {}", class.name())));
    list.extend(asm::explain::CODES.iter().map(|code| format!("message {}", code.code)));
}

/// Directives that files of extensions have beside those of programs: the words of this kind in the files and in their manual.
fn extensions(list: &mut Vec<String>) {
    let folders = std::fs::read_dir(root().join("extensions")).unwrap().map(|entry| entry.unwrap().path());
    let files = folders.flat_map(|folder| std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()));
    let texts = files.filter(|path| path.extension().is_some_and(|end| end == "isa")).map(|path| read(&path));
    let texts: Vec<String> = texts.chain([read(&root().join("docs/extensions.md"))]).collect();
    let words = texts.iter().flat_map(|text| text.lines()).filter_map(|line| line.split_whitespace().next());
    let is_directive =
        |word: &&str| word.len() > 2 && word.starts_with('.') && word[1..].bytes().all(|c| c.is_ascii_lowercase());
    let own: BTreeSet<&str> =
        words.filter(is_directive).filter(|word| asm::directive::find(word).is_none() || *word == ".end").collect();
    list.extend(own.into_iter().map(|word| format!("directive of extensions {word}")));
}

/// Names that are values of options, keys or statements.
fn names(list: &mut Vec<String>) {
    list.extend(ArbiterKind::ALL.map(|kind| format!("arbiter {}", kind.name())));
    list.extend(Quantization::ALL.iter().map(|mode| format!("rounding {}", mode.name())));
    list.extend(Overflow::ALL.iter().map(|mode| format!("overflow {}", mode.name())));
    list.extend(kernels::Function::ALL.iter().map(|function| format!("kernel {}", function.name())));
    list.extend(scenes::cadrage::Overrides::NAMES.map(|name| format!("format {name}")));
    let mut job = Job::new(scenes::generate::scene("cornell", &scenes::generate::GenerateOptions::default()).unwrap());
    job.view.size = (4, 4);
    let build = Load::picture(&job).map(|(load, _)| load.build);
    let build = build.unwrap_or_else(|failure| panic!("{failure:?}"));
    for (who, program) in [("core", &build.cores), ("main", &build.main)] {
        let of_prelude = program.symbols.keys().filter(|name| {
            let is_constant = name.bytes().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == b'_');
            is_constant || name.contains('.')
        });
        list.extend(of_prelude.map(|name| format!("symbol {who} {name}")));
    }
}

fn list() -> String {
    let mut list = Vec::new();
    let command = Lancer::command();
    commands(&command, "", &mut list);
    let help = command.get_after_help().expect("the help has an end").to_string();
    let codes = help.split("Exit codes:").nth(1).and_then(|text| text.split('.').next()).expect("it says exit codes");
    list.extend(codes.split(',').map(|code| format!("exit code {}", joined(code.split_whitespace()))));
    schemas(&mut list);
    tables(&mut list);
    language(&mut list);
    extensions(&mut list);
    names(&mut list);
    list.join("\n") + "\n"
}

/// Lines of required keys that are gone, or have another type, although their schema has kept its number.
fn broken_schemas<'a>(before: &'a str, after: &str) -> Vec<&'a str> {
    let schema = |line: &str| line.strip_prefix("json ")?.split(['.', ':']).next().map(str::to_owned);
    let kept: BTreeSet<String> = after.lines().filter_map(schema).collect();
    let is_there: BTreeSet<&str> = after.lines().collect();
    let is_broken = |line: &&str| {
        let is_required = !line.ends_with(", may be left out");
        is_required && schema(line).is_some_and(|name| kept.contains(&name)) && !is_there.contains(line)
    };
    before.lines().filter(is_broken).collect()
}

#[test]
fn a_required_key_that_goes_or_changes_raises_the_number_of_its_schema() {
    let before = "json a-1.x: number\njson a-1.y: string, may be left out\nclass add";
    for (after, broken) in [
        ("json a-1.x: number\njson a-1.z: string", vec![]),
        ("json a-1.x: string", vec!["json a-1.x: number"]),
        ("json a-1.y: string, may be left out", vec!["json a-1.x: number"]),
        ("json a-2.x: string", vec![]),
    ] {
        assert_eq!(broken_schemas(before, after), broken, "{after}");
    }
}

#[test]
fn what_users_type_and_scripts_read_is_what_it_was() {
    let (path, now) = (root().join("tests/contract.txt"), list());
    if std::env::var_os(BLESS).is_some_and(|value| value != "0") {
        let before = read(&path);
        let broken = broken_schemas(&before, &now);
        assert!(
            broken.is_empty(),
            "keys that scripts rely on go or change, so the schema's number has to rise:\n{}",
            broken.join("\n")
        );
        std::fs::write(&path, &now).unwrap();
    }
    let written = read(&path);
    let (before, after): (BTreeSet<&str>, BTreeSet<&str>) = (written.lines().collect(), now.lines().collect());
    let gone: Vec<&str> = before.difference(&after).copied().collect();
    let new: Vec<&str> = after.difference(&before).copied().collect();
    assert!(
        gone.is_empty() && new.is_empty(),
        "gone, which breaks who relies on it:\n{}\nnew, to be written by {BLESS}=1 cargo test -p lancer contract:\n{}",
        gone.join("\n"),
        new.join("\n")
    );
}
