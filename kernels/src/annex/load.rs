//! The report's estimate of a pixel as a load for the machine: 203,000 clocks of computing and 49,600 of transfers, in 20 equal parts.
//! Report 6.1.

use isa::{Isa, Program};
use messages::{Report, Source};

use crate::prelude;

/// Octets of global memory that the load reads.
pub const MEMORY: usize = 1_240;

macro_rules! file {
    ($path:literal) => {
        Source::new(concat!("kernels/asm/", $path), include_str!(concat!("../../asm/", $path)))
    };
}

/// The programs of the cores and of the main processor, for that many pixels.
///
/// # Errors
/// What the assembler finds; our own programs have no errors.
pub fn programs(pixels: u32, isa: &Isa) -> Result<(Program, Program), Report> {
    let constant = Source::new("<pixels>", format!(".equ PIXELS, {pixels}\n"));
    // The core's program does not know how many pixels there are: it serves one and starts again.
    let core = prelude::assemble("<core>", &[file!("annex/load.s")], isa)?;
    let main = prelude::assemble("<main>", &[constant, file!("annex/feed.s")], isa)?;
    Ok((core.program, main.program))
}
