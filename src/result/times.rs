//! Clocks and units of operations as a run had them.

use emu::machine::Config;
use schemars::JsonSchema;
use serde::Serialize;

use super::ByClass;

/// Clocks and units of a machine's operations, with laws of the word resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct OperationTimes {
    /// Bits of a word.
    pub word: u32,
    /// True where some number is a law of the word.
    pub is_by_word: bool,
    /// Clocks of an operation of each class.
    pub clocks: ByClass,
    /// Operations of each class that run at once.
    pub units: ByClass,
}

impl OperationTimes {
    /// The times on a machine.
    pub fn new(machine: &Config) -> OperationTimes {
        let timing = machine.timing();
        OperationTimes {
            word: machine.arithmetic.word,
            is_by_word: machine.is_timed_by_word(),
            clocks: ByClass(timing.clocks),
            units: ByClass(timing.units),
        }
    }
}
