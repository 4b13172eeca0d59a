//! The rows of the report's annexes, each with the driver that sets its assumptions, the region of the `report` kernels that it counts, and
//! the terms that the kernels differ by. What is printed and why it differs are data, in `annex.toml`; running the drivers is the caller's.

mod data;
mod erratum;
pub mod load;
mod part;
mod world;

use std::sync::LazyLock;

use isa::{Class, Counts};

pub use data::{Figure, PathSpread, Peer, PixelSearch, PrintedCore, PrintedStructure};
pub use erratum::{KernelEdit, PrintedErratum, PrintedFigure, PrintedReading, Reproduction};
pub use part::{PartKind, PrintedPart, VectorOperation};
pub use world::MEMORY;

use data::Data;

/// A row of the annexes.
#[derive(Clone, Debug)]
pub struct Row {
    /// Short name: `kd.` for Annex I, `rt.` for Annex II.
    pub id: String,
    /// The label as printed.
    pub label: String,
    /// Place in the report where it is printed.
    pub source: String,
    /// Operations as printed, those of called rows included.
    pub printed: Counts,
    /// Lines as printed; of a row that is printed without them a line for each class.
    pub parts: Vec<PrintedPart>,
    /// Name of the driver, a file of `kernels/asm/annex`.
    pub driver: String,
    /// The function or region of the kernels that is measured: its calls' inclusive counts.
    pub region: String,
    /// The path that the driver makes the region go.
    pub path: String,
    /// The search for the driver's assumptions, where they are not given.
    pub search: Option<PixelSearch>,
    /// Other paths that its walk may go, where these take more.
    pub spread: Option<PathSpread>,
    /// Differences of the kernels from what is printed; by class the terms sum to the difference.
    pub terms: Vec<Term>,
}

/// A reason for a part of a difference.
#[derive(Clone, Debug)]
pub struct Term {
    /// The source line that does more, or whose printed counterpart does what it does not: `file:line`.
    pub line: String,
    /// By how many operations of each class it exceeds what is printed.
    pub counts: Vec<(Class, i64)>,
    /// Reason for the difference.
    pub reason: String,
}

impl Row {
    /// The classes that the row's annex prints: Annex II leaves accesses to memory out.
    pub fn classes(&self) -> impl Iterator<Item = Class> {
        // A row that prints no access to memory belongs to the annex that counts none.
        let has_memory = self.printed[Class::Mem] != 0;
        Class::ALL.iter().copied().filter(move |class| class.is_elementary() || has_memory && *class == Class::Mem)
    }

    /// Number of operations of a class by which a count exceeds the printed ones.
    pub fn difference(&self, counted: &Counts, class: Class) -> i64 {
        counted[class] as i64 - self.printed[class] as i64
    }

    /// The difference that the terms explain.
    pub fn explained(&self, class: Class) -> i64 {
        self.terms.iter().flat_map(|term| &term.counts).filter(|(of, _)| *of == class).map(|(_, n)| n).sum()
    }
}

static DATA: LazyLock<Data> = LazyLock::new(Data::read);

/// The rows, in the order of the report.
pub fn rows() -> &'static [Row] {
    &DATA.rows
}

/// Figures that the report derives from the rows (6.1, 6.2, 6.4, Annex I).
pub fn figures() -> &'static [Figure] {
    &DATA.figures
}

/// A derived figure as it is printed, by its name; `None` where the report leaves it out.
pub fn printed(figure: &str) -> Option<f64> {
    figures().iter().find(|other| other.id == figure)?.printed
}

/// Structures in memory, as Annex I prints them.
pub fn structures() -> &'static [PrintedStructure] {
    &DATA.structures
}

/// Cores of other machines.
pub fn cores() -> &'static [PrintedCore] {
    &DATA.cores
}

/// Oddities in the printed figures.
pub fn errata() -> &'static [PrintedErratum] {
    &DATA.errata
}

/// The other machines of table 3.
pub fn peers() -> &'static [Peer] {
    &DATA.peers
}
