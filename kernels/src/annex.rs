//! Rows of the report's Annex II that the `report` kernels meet exactly, each with the driver that sets its assumptions.
//! Programs are made here; running and measuring them is the caller's.

use isa::diagnostic::{Report, Source};
use isa::{Counts, Isa, Program};
use scenes::layout::Layout;

use crate::prelude;

/// A row of Annex II.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Short name.
    pub id: &'static str,
    /// The function of the kernels that is measured: its calls' inclusive counts.
    pub function: &'static str,
    /// The label as printed.
    pub label: &'static str,
    /// Operations as printed, those of called rows included.
    pub printed: Counts,
    driver: (&'static str, &'static str),
    files: &'static [(&'static str, &'static str)],
}

macro_rules! file {
    ($path:literal) => {
        (concat!("kernels/asm/", $path), include_str!(concat!("../asm/", $path)))
    };
}

/// The rows.
pub const ROWS: &[Row] = &[
    Row {
        id: "sqrt",
        function: "sqrt",
        label: "Racine Carré",
        printed: Counts::from_pairs(&[("add", 96), ("sub", 132), ("mul", 32), ("cmp", 32)]),
        driver: file!("annex/sqrt.s"),
        files: &[file!("report/sqrt.s")],
    },
    Row {
        id: "triangle",
        function: "triangle",
        label: "Intersection avec un triangle",
        printed: Counts::from_pairs(&[("add", 9), ("sub", 15), ("mul", 27), ("div", 3), ("cmp", 7)]),
        driver: file!("annex/triangle.s"),
        files: &[file!("report/triangle.s")],
    },
    Row {
        id: "packet",
        function: "packet",
        label: "Intersection total",
        printed: Counts::from_pairs(&[
            ("add", 40 + 40 * 9),
            ("sub", 40 * 15),
            ("mul", 40 * 27),
            ("div", 40 * 3),
            ("cmp", 81 + 40 * 7),
        ]),
        driver: file!("annex/packet.s"),
        files: &[file!("report/packet.s"), file!("report/triangle.s")],
    },
];

impl Row {
    /// Sum of the printed operations.
    pub fn printed_total(&self) -> u64 {
        self.printed.elementary()
    }

    /// The program that measures the row: driver, then the kernels. It needs no other core and 128 KiB of global memory.
    ///
    /// # Errors
    /// What the assembler finds; our own kernels have no errors.
    pub fn program(&self, isa: &Isa) -> Result<Program, Report> {
        let mut files = vec![Source::new("<assumptions>", assumptions())];
        files.extend(prelude::included(Layout::Wide));
        files.extend(std::iter::once(&self.driver).chain(self.files).map(|(name, text)| Source::new(*name, *text)));
        Ok(prelude::assemble("<annex>", &files, isa)?.program)
    }
}

/// The report's estimate of a pixel as a load for the machine: 203,000 clocks of computing and 49,600 of transfers, in 20
/// equal parts. Report 6.1.
pub mod load {
    use super::*;

    /// Clocks of computing of a pixel on the report's machine.
    pub const COMPUTING: u64 = 203_000;

    /// Clocks of its transfers there.
    pub const TRANSFER: u64 = 49_600;

    /// Octets of global memory that the load reads.
    pub const MEMORY: usize = 1_240;

    /// The programs of the cores and of the main processor, for that many pixels.
    ///
    /// # Errors
    /// What the assembler finds; our own programs have no errors.
    pub fn programs(pixels: u32, isa: &Isa) -> Result<(Program, Program), Report> {
        let (core, feed) = (file!("annex/load.s"), file!("annex/feed.s"));
        let constant = Source::new("<pixels>", format!(".equ PIXELS, {pixels}\n"));
        let core = prelude::assemble("<core>", &[Source::new(core.0, core.1)], isa)?;
        let main = prelude::assemble("<main>", &[constant, Source::new(feed.0, feed.1)], isa)?;
        Ok((core.program, main.program))
    }
}

/// Octets of global memory that every driver is content with.
pub const MEMORY: usize = 128 << 10;

/// Formats, constants and structures of the drivers: a word of 32 bits, positions with 26 fraction bits.
fn assumptions() -> String {
    let mut text = String::from(
        ".format pos, 26\n.format dir, 30\n.format bary, 30\n.format t, 26\n.format weight, 30\n.format colour, 28\n.format index, 28\n\
         .equ WORD, 32\n.equ NEVER, 0x7ffffffe\n.equ MISSED, 0x7fffffff\n.equ MATERIALS_LOCAL, 0\n.equ LAYOUT_REPORT, 0\n",
    );
    for part in Layout::Wide.structures() {
        prelude::structure(&mut text, part);
    }
    text
}
