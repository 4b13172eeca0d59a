//! Reads `annex.toml`. A term names its source line by a piece of it, so that it is found again when lines move.

use std::collections::BTreeMap;

use isa::{Class, Counts};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

/// Something odd in the printed figures.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrintedErratum {
    /// Short name.
    pub id: String,
    /// Place in the report where it is printed.
    pub source: String,
    /// The printed text.
    pub printed: String,
    /// The correct text.
    pub correct: String,
    /// The consequence of the mistake.
    pub effect: String,
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
    search: Option<PixelSearch>,
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
    let RawRow { id, label, source, driver, region, search, .. } = raw;
    Row { id, label, source, printed, driver, region, search, terms }
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
