//! Machines by name: presets and files.

use std::path::Path;

use emu::inject::Protection;
use emu::machine::Config;
use emu::machine::arbiter::ArbiterKind;
use emu::machine::config::ProtectionConfig;
use emu::machine::config::formula::Dimension;
use emu::machine::config::ledger::{AREA_ITEMS, ENERGY_ITEMS};
use emu::machine::preset::PRESETS;
use isa::Class;
use messages::{Diagnostic, Report, did_you_mean};

use crate::energy::{Pricing, Width};
use crate::files;
use crate::numeral::count;
use crate::settings::MachineSettings;
use crate::settings::apply::explained;

/// Name of the machine that runs when the user names none.
pub const DEFAULT: &str = "report";

/// Octets of the largest machine file: a reader of TOML takes many times as much memory, and all keys are 10 KiB.
const LARGEST: u64 = 256 << 10;

/// A machine by the name of a preset, from a TOML file, or as it stands in settings (in braces), with the name that results show.
///
/// # Errors
/// A name that is neither, and what is wrong in the file.
pub fn find(name: &str) -> Result<(String, Config), Report> {
    // A machine in braces is one of a result's settings.
    if name.trim_start().starts_with('{') {
        let machine: MachineSettings = serde_json::from_str(name).map_err(|error| explained(&error.to_string()))?;
        machine.config.check()?;
        return Ok((machine.name, machine.config));
    }
    // A preset wins over a file of its name, so that the name means the same in every folder.
    if let Some(preset) = PRESETS.iter().find(|preset| preset.name == name) {
        return Ok((preset.name.to_owned(), preset.config()));
    }
    let path = Path::new(name);
    // A name that looks like a path is one: then the message is about a file that is missing, not about presets.
    let is_file = name == files::STANDARD
        || path.exists()
        || path.extension().is_some()
        || name.contains(std::path::is_separator);
    if !is_file {
        let names = || PRESETS.iter().map(|preset| preset.name);
        let hint = did_you_mean(name, names()).unwrap_or_else(|| {
            format!("presets: {}; a machine of your own is a .toml file", names().collect::<Vec<_>>().join(", "))
        });
        return Err(Diagnostic::error(format!("there is no machine `{name}`")).hint(hint).into());
    }
    let octets = files::read_up_to(LARGEST, path)?;
    let config = Config::parse(&files::source_of(path, octets)?)?;
    let stem = path.file_stem().filter(|_| name != files::STANDARD);
    let stem = stem.map_or_else(|| "stdin".to_owned(), |stem| stem.to_string_lossy().into_owned());
    Ok((stem, config))
}

/// Comments on the keys: meaning, unit, range and source of the default; `[section]` describes what follows, `{arbiters}` stands for all names
/// of arbiters.
const COMMENTS: &[(&str, &str)] = &[
    ("cores", "cores, 1 to 256, the main processor not counted (report 6.1: 4)"),
    ("clock_hz", "clock rate in hertz; it turns clocks into seconds and changes nothing else (report 6.1: 100 MHz)"),
    ("buffer_octets", "octets of each core's local buffer (report 6.2: the sum of the list is 18,525)"),
    ("step_limit", "instructions that a pixel may take (ours: thousands of times what one takes)"),
    (
        "packet_lanes",
        "triangles of a packet that `rnear` and `rany` test at once, in the time of one (ours; the report has no such unit)",
    ),
    ("[arithmetic]", "how results are rounded and what happens when they do not fit"),
    ("arithmetic.word", "bits of a word, 8 to 32 (ours: 32; the report multiplies in 32 masked steps)"),
    ("arithmetic.quantization", "rounding by its IEEE 1666 name (ours: RND, to nearest, ties up; the report has none)"),
    (
        "arithmetic.overflow",
        "overflow by its IEEE 1666 name (ours: SAT, the nearest number that fits; the report has none)",
    ),
    (
        "arithmetic.trap_division_by_zero",
        "whether a division by zero stops the machine instead of saturating (ours: no)",
    ),
    (
        "[clocks]",
        "clocks of an operation, by class, a number or a law of the word's bits: \"linear\", \"square\", \"log\" (of 2, rounded up), each with \
         a factor and a summand where there are some, such as \"linear 1/4 + 3\" (report 6.1: 1 for add, sub, mul, div and cmp; what it \
         does not count takes 0)",
    ),
    (
        "[units]",
        "operations of a class that run at once, a number or a law: \"inverse 96\" is as many as fit into 96 bits (report 6.1: one)",
    ),
    ("[bus]", "the shared bus; a burst takes setup_clocks + ceil(octets / octets_per_beat) * clocks_per_beat"),
    ("bus.octets_per_beat", "octets that go over it at once (report 6.1: 1)"),
    ("bus.clocks_per_beat", "clocks for that (report 6.1: 2)"),
    ("bus.setup_clocks", "clocks before the first beat of a burst (report 6.1: none)"),
    (
        "bus.burst_octets",
        "octets of the longest burst, 0 for no limit (report 6.1: no limit); a longer transfer asks again after each burst",
    ),
    (
        "bus.overlap",
        "whether a core goes on during its block load, up to its next transfer, message or end (report 6.1: it adds both up)",
    ),
    ("bus.arbiter", "who gets the bus next: {arbiters} (ours; the report has none)"),
    (
        "bus.weights",
        "weighted: bursts a turn of each master, the main processor after the last core (ours: 1 where the list ends)",
    ),
    ("bus.slot_clocks", "tdma: clocks of a master's slot, which no burst exceeds (ours: two triangles of 62)"),
    ("[cache]", "each core's private cache for one kind of data that is only read; hits take no time"),
    ("cache.octets", "octets of a cache, 0 for none (report 6.2: none)"),
    ("cache.line_octets", "octets of a line, which comes over the bus whole (ours)"),
    ("cache.kind", "kind of data that goes through it: nodes, references, triangles, materials, lights (ours)"),
    ("[main]", "the main processor, which makes the camera rays and feeds the cores"),
    ("main.traffic", "whether its transfers and messages use the bus; otherwise they take no time (ours: they do)"),
    ("main.buffer_octets", "octets of its local buffer (ours; the report has none)"),
    ("main.step_limit", "instructions that its whole program may take (ours)"),
    (
        "[protection]",
        "what structures are protected by, and by what; check bits of memory and bus go over the wires of the bus, and each burst takes that much longer (docs/inject.md)",
    ),
    (
        "[energy]",
        "figures of energy: \"tables\" (those of the published tables below), names of tables, \"none\", or a figure of your own with \
         its unit and its source, by the bits b of a number or the binary logarithm L of the bits of a memory: \
         \"0.0007 b^2 + 0.002 b pJ; my synthesis\" (docs/energy.md)",
    ),
    ("energy.tables", "published tables, between commas; several give a range (ours: all)"),
    ("[area]", "figures of area, in um2 or mm2, as those of energy"),
    ("area.tables", "published tables, between commas; several give a range (ours: all)"),
];

/// Sentence on an arbiter that does not do what its name says: weights of 1 make round-robin.
pub fn arbiter_note(config: &Config) -> Option<&'static str> {
    let is_even = config.bus.weights.iter().all(|&weight| weight == 1);
    (config.bus.arbiter == ArbiterKind::Weighted && is_even).then_some("all weights are 1, which is round-robin")
}

/// Warnings about a machine that is right and likely not what was meant.
pub fn notes(config: &Config) -> Report {
    let warned = |note| Diagnostic::warning(format!("the arbiter `{}`: {note}", config.bus.arbiter.name()));
    arbiter_note(config).map_or_else(Report::default, |note| {
        warned(note).hint("`bus.weights` in the machine's file has a number for each master").into()
    })
}

/// Text for help: the values that name a machine.
pub fn named() -> String {
    let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
    format!("Preset ({}) or TOML file", names.join(", "))
}

/// Text of a comment.
fn filled(comment: &str) -> String {
    let [first @ .., last] = ArbiterKind::ALL.map(ArbiterKind::name);
    comment.replace("{arbiters}", &format!("{} or {last}", first.join(", ")))
}

/// Comment on an item of `[energy]` or `[area]`.
fn item_comment(key: &str) -> Option<String> {
    let (table, name) = key.split_once('.')?;
    let items = match table {
        "energy" => &ENERGY_ITEMS[..],
        "area" => &AREA_ITEMS[..],
        _ => return None,
    };
    items.iter().find(|(item, _)| *item == name).map(|(_, text)| (*text).to_owned())
}

/// Comment on a structure of `[protection]`: what it is, and its protections with the check bits of a word.
fn protection_comment(key: &str) -> Option<String> {
    let name = key.strip_prefix("protection.")?;
    let kind = ProtectionConfig::keys().find(|kind| kind.name() == name)?;
    let shown = |protection: Protection| match protection.check_bits() {
        0 => protection.name().to_owned(),
        bits => format!("{} ({})", protection.name(), count(bits.into(), "bit a word", "bits a word")),
    };
    let [first @ .., last] = kind.protections() else { return None };
    let others: String = first.iter().map(|&one| format!(", {}", shown(one))).collect();
    Some(format!("{}: none{others} or {} (ours: none; the report has none)", kind.protected()?, shown(*last)))
}

/// Comment behind an item of `[energy]` or `[area]`: its figures by each table for words of the machine's length.
fn figures(config: &Config, dimension: Dimension, name: &str) -> String {
    let Some((item, _)) = ENERGY_ITEMS.iter().chain(&AREA_ITEMS).find(|(item, _)| *item == name) else {
        return String::new();
    };
    let pricings = Pricing::all(config, dimension);
    let (decimals, unit) = match dimension {
        Dimension::Energy => (1_000_000.0, "pJ"),
        Dimension::Area => (1_000_000.0, "um2"),
    };
    let shown: Vec<String> = pricings
        .iter()
        .filter_map(|pricing| Some((pricing.table.name, pricing.price(item)?)))
        .map(|(table, price)| {
            let derived = if price.is_derived { ", derived" } else { "" };
            format!("{} {unit} by {table}{derived}", price.figures[Width::Word as usize] as f64 / decimals)
        })
        .collect();
    if shown.is_empty() { " # no figure: nothing is counted".to_owned() } else { format!(" # {}", shown.join(", ")) }
}

/// A comment behind a law: the number that it comes to. Nothing behind other keys.
fn resolved(config: &Config, key: &str) -> String {
    let (timing, word) = (config.timing(), config.arithmetic.word);
    match key.split_once('.') {
        Some(("energy", name)) => return figures(config, Dimension::Energy, name),
        Some(("area", name)) => return figures(config, Dimension::Area, name),
        _ => {}
    }
    let class = |name| Class::from_name(name);
    let (law, number) = match key.split_once('.').and_then(|(table, name)| Some((table, class(name)?))) {
        Some(("clocks", class)) => (config.clocks.0[class], timing.clocks[class]),
        Some(("units", class)) => (config.units.0[class], timing.units[class]),
        _ => return String::new(),
    };
    // An operation that is executed twice takes more than its key says.
    let is_doubled = law.at(word) < number && config.protection.executions() != 1;
    match (law.is_grown(), is_doubled) {
        (true, false) => format!(" # {number} for words of {word} bits"),
        (true, true) => format!(" # {number} for words of {word} bits, executed twice"),
        (false, true) => format!(" # {number}, executed twice"),
        (false, false) => String::new(),
    }
}

/// Description of a key of a machine file, or of a group of keys: its meaning, unit and range.
pub fn comment(key: &str) -> Option<String> {
    let group = format!("[{key}]");
    let found = COMMENTS.iter().find(|(known, _)| *known == key || *known == group);
    // Classes of operations mean the same in each section.
    let class =
        || key.split_once('.').and_then(|(_, name)| Class::from_name(name)).map(|class| class.doc().trim().to_owned());
    let item = || item_comment(key).or_else(|| protection_comment(key));
    found.map(|(_, text)| filled(text)).or_else(item).or_else(class)
}

/// A machine as a TOML file with every key and a comment on what it means; reading it gives the same machine.
pub fn commented(name: &str, config: &Config) -> String {
    let comment = |key: &str| COMMENTS.iter().find(|(known, _)| *known == key).map(|(_, text)| filled(text));
    let comment = |key: &str| item_comment(key).or_else(|| protection_comment(key)).or_else(|| comment(key));
    let mut text = format!("# Machine `{name}`. Keys that a file leaves out have the values of `{DEFAULT}`.\n\n");
    // The keys come from the text itself, so that none of them can be missing here.
    let mut section = String::new();
    for line in config.text().lines() {
        let key = match line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            Some(name) => {
                section = format!("{name}.");
                line.to_owned()
            }
            None => format!("{section}{}", line.split('=').next().unwrap_or_default().trim()),
        };
        if let Some(comment) = comment(&key) {
            text += &format!("# {comment}\n");
        }
        text += &format!("{line}{}\n", resolved(config, &key));
    }
    text
}

#[cfg(test)]
mod tests {
    use messages::Source;

    use super::*;

    #[test]
    fn a_printed_machine_reads_back_as_itself() {
        for preset in PRESETS {
            let (name, config) = find(preset.name).unwrap();
            let text = commented(&name, &config);
            assert_eq!(Config::parse(&Source::new("m.toml", text)).unwrap(), config);
        }
    }

    #[test]
    fn every_key_has_a_comment_and_every_comment_a_key() {
        let text = commented(DEFAULT, &Config::default());
        let mut section = "";
        let lines: Vec<&str> = text.lines().skip(2).collect();
        for pair in lines.windows(2).filter(|pair| !pair[1].starts_with('#') && !pair[1].is_empty()) {
            if pair[1].starts_with('[') {
                section = pair[1];
            }
            // What a class means does not depend on the section.
            let is_class = ["[clocks]", "[units]"].contains(&section) && !pair[1].starts_with('[');
            assert!(pair[0].starts_with('#') || is_class, "{} has no comment", pair[1]);
        }
        for (key, comment) in COMMENTS {
            let has_source = key.starts_with('[') || comment.contains("(ours") || comment.contains("(report");
            assert!(has_source, "{key} does not say where its default comes from");
            assert!(text.contains(&format!("# {}\n", filled(comment))), "{key} is no key");
        }
    }

    #[test]
    fn weights_of_1_are_said_to_be_round_robin() {
        let mut config = Config::default();
        assert_eq!(arbiter_note(&config), None);
        config.bus.arbiter = ArbiterKind::Weighted;
        assert!(notes(&config).render(false).contains("all weights are 1, which is round-robin"));
        config.bus.weights = vec![1, 2];
        assert!(notes(&config).0.is_empty());
    }

    #[test]
    fn every_arbiter_is_explained() {
        let page = include_str!("../docs/machine.md");
        for kind in ArbiterKind::ALL {
            assert!(page.contains(&format!("| `{}` |", kind.name())), "docs/machine.md has no row for {}", kind.name());
        }
    }

    #[test]
    fn names_that_are_no_machine_are_refused_with_what_is() {
        for (name, message) in [
            ("raport", "did you mean `report`?"),
            ("xyzzy", "presets: report"),
            ("no/machine.toml", "there is no file no/machine.toml"),
        ] {
            let error = find(name).unwrap_err().render(false);
            assert!(error.contains(message), "{error}");
        }
    }
}
