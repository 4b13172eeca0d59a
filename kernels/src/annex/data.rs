//! Reads `annex.toml`. A term names its source line by a piece of it, so that it is found again when lines move.

use std::collections::BTreeMap;

use isa::{Class, Counts};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::erratum::PrintedErratum;
use super::part::{PartKind, PrintedPart};
use super::{Row, Term, world};

/// A figure that the report derives.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// Short name.
    pub id: String,
    /// Description of the figure.
    pub label: String,
    /// Place in the report where it is printed.
    pub source: String,
    /// The value as printed; `None` where the report leaves it out.
    pub printed: Option<f64>,
    /// The unit; empty for a pure number.
    #[serde(default)]
    pub unit: String,
}

/// An assumption that is looked for: a driver is tried with 1, 2, ... for a constant.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PixelSearch {
    /// The constant.
    pub constant: String,
    /// The largest number that is tried.
    pub most: u32,
    /// The function whose calls tell whether the number is found.
    pub region: String,
    /// Number of calls that the row assumes.
    pub calls: u64,
}

/// Range of a constant in a driver's buffer, over which the path of its walk varies.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathSpread {
    /// Label of the constant: levels of the tree at which the walk goes to the right, the first ones. It is 0 where the row is counted.
    pub constant: String,
    /// Levels of the tree.
    pub most: u32,
}

/// A structure of Annex I, as it is printed.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrintedStructure {
    /// Name of the structure in the layouts.
    pub structure: String,
    /// The label as printed.
    pub label: String,
    /// Fields: the printed name, the printed bits, and the names in the layouts `report` and `wide`; empty where that does without.
    pub fields: Vec<(String, u32, String, String)>,
    /// Bits in all.
    pub bits: u32,
    /// Octets in all.
    pub octets: u32,
    /// Number of such structures.
    pub count: u64,
    /// Octets of all of them, in units of 2^20.
    pub megabytes: f64,
}

/// A core of another machine (6.3).
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrintedCore {
    /// The machine's name.
    pub name: String,
    /// Place in the report.
    pub source: String,
    /// Rays a second of one core, least and most.
    pub rays_per_second: [f64; 2],
    /// Octets of memory inside it.
    pub memory_octets: u64,
}

/// A machine of table 3.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
pub struct Peer {
    /// The machine's name.
    pub name: String,
    /// Servers that work in parallel.
    pub servers: u32,
    /// Width and height of a picture in pixels.
    pub resolution: [u32; 2],
    /// The primitive that rays are tested against.
    pub primitive: String,
    /// Time of a pixel in microseconds.
    pub pixel_us: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AnnexFile {
    row: Vec<RawRow>,
    figure: Vec<Figure>,
    erratum: Vec<PrintedErratum>,
    peer: Vec<Peer>,
    storage: Vec<PrintedStructure>,
    core: Vec<PrintedCore>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawRow {
    id: String,
    label: String,
    source: String,
    printed: BTreeMap<String, u64>,
    driver: String,
    region: String,
    path: String,
    search: Option<PixelSearch>,
    spread: Option<PathSpread>,
    #[serde(default)]
    parts: Vec<(String, u64, u64)>,
    #[serde(default)]
    term: Vec<RawTerm>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawTerm {
    /// File below the kernels' folder.
    at: String,
    /// A piece of the line, found in one line of the file.
    text: String,
    n: BTreeMap<String, i64>,
    reason: String,
}

/// All that the file says.
pub(super) struct Data {
    pub rows: Vec<Row>,
    pub figures: Vec<Figure>,
    pub errata: Vec<PrintedErratum>,
    pub peers: Vec<Peer>,
    pub structures: Vec<PrintedStructure>,
    pub cores: Vec<PrintedCore>,
}

impl Data {
    /// The file as it is part of the program.
    pub fn read() -> Data {
        // Part of the program's text, so a mistake in it is one of ours and not of a user.
        let file: AnnexFile = toml::from_str(include_str!("../../annex.toml")).expect("a test reads the file");
        Data {
            rows: file.row.into_iter().map(row).collect(),
            figures: file.figure,
            errata: file.erratum,
            peers: file.peer,
            structures: file.storage,
            cores: file.core,
        }
    }
}

fn class(name: &str) -> Class {
    Class::from_name(name).unwrap_or_else(|| panic!("annex.toml: `{name}` is no class"))
}

fn row(mut raw: RawRow) -> Row {
    let mut printed = Counts::ZERO;
    for (name, count) in &raw.printed {
        printed[class(name)] = *count;
    }
    // A term is looked up by the row's name in messages, so the terms are taken out before the row is.
    let terms = std::mem::take(&mut raw.term).into_iter().map(|term| self::term(&raw.id, term)).collect();
    let RawRow { id, label, source, driver, region, path, search, spread, parts, .. } = raw;
    let mut parts: Vec<PrintedPart> = parts.into_iter().map(|part| self::part(&id, part)).collect();
    if parts.is_empty() {
        let printed = printed.iter().filter(|(_, times)| *times != 0);
        parts.extend(printed.map(|(class, times)| PrintedPart { kind: PartKind::Class(class), each: 1, times }));
    }
    Row { id, label, source, printed, parts, driver, region, path, search, spread, terms }
}

fn part(row: &str, (name, each, times): (String, u64, u64)) -> PrintedPart {
    let kind = PartKind::named(&name).unwrap_or_else(|| panic!("annex.toml, {row}: `{name}` is no part of a row"));
    PrintedPart { kind, each, times }
}

fn term(row: &str, raw: RawTerm) -> Term {
    let RawTerm { at, text, n, reason } = raw;
    let (_, source) = world::file(&at).unwrap_or_else(|| panic!("annex.toml, {row}: there is no file `{at}`"));
    // One line exactly: a piece that stands in two could silently name the wrong one after a change.
    let mut lines = (1..).zip(source.lines()).filter(|(_, line)| line.contains(&text)).map(|(number, _)| number);
    let number: u32 = lines.next().unwrap_or_else(|| panic!("annex.toml, {row}: no line of {at} has `{text}`"));
    assert!(lines.next().is_none(), "annex.toml, {row}: several lines of {at} have `{text}`");
    let counts = n.iter().map(|(name, &n)| (class(name), n)).collect();
    Term { line: format!("kernels/asm/{at}:{number}"), counts, reason }
}
