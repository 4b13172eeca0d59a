//! Losses of numeric results, instruction by instruction: the flags of IEEE 1666, counted.

use emu::code::Code;
use emu::tally::{Losses, Tally};
use schemars::JsonSchema;
use serde::Serialize;

/// An instruction of whose results some lost something.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Loss {
    /// Address of the instruction in words.
    pub pc: u32,
    /// `file:line`.
    pub place: Option<String>,
    /// Mnemonic of the instruction.
    pub instruction: String,
    /// Number of executions.
    pub executed: u64,
    /// Results that lost bits below the last place; a vector has three results.
    pub quantized: u64,
    /// Results that did not fit the word, or were quotients of a division by zero.
    pub overflowed: u64,
}

/// The instructions of whose results some lost something, in the order of the program.
pub fn losses(code: &Code, tally: &Tally) -> Vec<Loss> {
    let words = (0..).zip(tally.losses(code)).filter(|(_, losses)| *losses != Losses::default());
    let loss = |(pc, Losses { quantized, overflowed }): (u32, Losses)| Loss {
        pc,
        place: code.program.place(pc),
        instruction: code.row(pc).map_or(String::new(), |row| row.name.to_string()),
        executed: tally.word(code, pc).instructions,
        quantized,
        overflowed,
    };
    words.map(loss).collect()
}
