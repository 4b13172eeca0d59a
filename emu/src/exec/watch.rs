//! Arithmetic as engines run on it: the machine's default, or modes chosen at run time with an eye on divisions by zero.

use std::cell::Cell;

use isa::number::{Arithmetic, Modes, Nearest32};

/// Arithmetic that an engine can run on: it says whether the last instruction is to trap for a division by zero.
pub trait Watch: Arithmetic {
    /// Whether the engine has to ask at all.
    const IS_WATCHING: bool = false;

    /// Whether something was divided by zero since the last call, where that is to trap.
    fn take_division_by_zero(&self) -> bool {
        false
    }
}

impl Watch for Nearest32 {}

/// Modes chosen at run time; the results are those of the modes.
#[derive(Clone, Debug)]
pub struct Watching {
    modes: Modes,
    traps_division_by_zero: bool,
    has_divided_by_zero: Cell<bool>,
}

impl Watching {
    /// The modes, and whether a division by zero is to trap.
    pub fn new(modes: Modes, traps_division_by_zero: bool) -> Watching {
        Watching { modes, traps_division_by_zero, has_divided_by_zero: Cell::new(false) }
    }
}

impl Arithmetic for Watching {
    fn word(&self) -> u32 {
        self.modes.word
    }

    fn quantize(&self, value: i128, shift: u32, bits: u32) -> i64 {
        self.modes.quantize(value, shift, bits)
    }

    fn quotient(&self, dividend: i128, divisor: i128) -> i32 {
        if divisor == 0 && self.traps_division_by_zero {
            self.has_divided_by_zero.set(true);
        }
        self.modes.quotient(dividend, divisor)
    }
}

impl Watch for Watching {
    const IS_WATCHING: bool = true;

    fn take_division_by_zero(&self) -> bool {
        self.has_divided_by_zero.take()
    }
}
