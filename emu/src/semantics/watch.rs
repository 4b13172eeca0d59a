//! Arithmetic as engines run on it: the machine's default, or modes chosen at run time with an eye on divisions by zero and
//! on what results lose.

use std::cell::Cell;

use isa::number::{Arithmetic, Flags, Modes, Nearest32, square_root};

use super::Numbers;
use crate::code::tally::Losses;

/// Arithmetic that an engine can run on: it says whether the last instruction is to trap for a division by zero.
pub trait Watch: Arithmetic {
    /// True where the engine has to ask after instructions at all.
    const IS_WATCHING: bool = false;

    /// Arithmetic for meanings in Rust, which do not know its type.
    fn numbers(&self) -> Numbers<'_>;

    /// Description of the arithmetic, for engines that are made for it beforehand.
    fn computes(&self) -> Computes {
        Computes::default()
    }

    /// Takes note of a division by zero since the last call, where that is to trap.
    fn take_division_by_zero(&self) -> bool {
        false
    }

    /// Losses of results since the last call, where those are counted.
    fn take_losses(&self) -> Losses {
        Losses::default()
    }
}

/// Description of an arithmetic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Computes {
    /// Word length and modes.
    pub modes: Modes,
    /// A division by zero traps.
    pub traps_division_by_zero: bool,
    /// Losses of results are counted.
    pub counts_losses: bool,
}

impl Watch for Nearest32 {
    fn numbers(&self) -> Numbers<'_> {
        Numbers::Nearest32
    }
}

/// Modes chosen at run time; the results are those of the modes.
#[derive(Clone, Debug)]
pub struct Watching {
    modes: Modes,
    traps_division_by_zero: bool,
    has_divided_by_zero: Cell<bool>,
    counts_losses: bool,
    losses: Cell<Losses>,
}

impl Watching {
    /// The modes, and whether a division by zero is to trap.
    pub fn new(modes: Modes, traps_division_by_zero: bool) -> Watching {
        Watching {
            modes,
            traps_division_by_zero,
            has_divided_by_zero: Cell::new(false),
            counts_losses: false,
            losses: Cell::default(),
        }
    }

    /// Arithmetic in these modes that also counts what results lose.
    pub fn with_losses(self) -> Watching {
        Watching { counts_losses: true, ..self }
    }

    fn note(&self, flags: Flags) {
        let Losses { quantized, overflowed } = self.losses.get();
        self.losses.set(Losses {
            quantized: quantized + u64::from(flags.is_quantized),
            overflowed: overflowed + u64::from(flags.has_overflowed),
        });
    }
}

impl Arithmetic for Watching {
    fn word(&self) -> u32 {
        self.modes.word
    }

    fn quantize(&self, value: i128, shift: u32, bits: u32) -> i64 {
        if self.counts_losses {
            self.note(self.modes.flags_of(value, shift, bits));
        }
        self.modes.quantize(value, shift, bits)
    }

    fn quotient(&self, dividend: i128, divisor: i128) -> i32 {
        if divisor == 0 && self.traps_division_by_zero {
            self.has_divided_by_zero.set(true);
        }
        if self.counts_losses {
            self.note(self.modes.flags_of_quotient(dividend, divisor));
        }
        self.modes.quotient(dividend, divisor)
    }

    fn root(&self, value: u128) -> i32 {
        let root = square_root(value);
        if self.counts_losses {
            let flags = self.modes.flags_of(root.into(), 0, self.modes.word);
            let is_quantized = u128::from(root) * u128::from(root) != value;
            self.note(Flags { is_quantized, ..flags });
        }
        self.modes.quantize(root.into(), 0, self.modes.word) as i32
    }
}

impl Watch for Watching {
    const IS_WATCHING: bool = true;

    fn computes(&self) -> Computes {
        let Watching { modes, traps_division_by_zero, counts_losses, .. } = *self;
        Computes { modes, traps_division_by_zero, counts_losses }
    }

    fn numbers(&self) -> Numbers<'_> {
        Numbers::Other(self)
    }

    fn take_division_by_zero(&self) -> bool {
        self.has_divided_by_zero.take()
    }

    fn take_losses(&self) -> Losses {
        self.losses.take()
    }
}
