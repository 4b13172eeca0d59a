//! The machine's arithmetic against the model of IEEE 1666.

use std::ops::Range;

use conformance::{Format, Number, Operation, operate};
use isa::number::{Arithmetic, Modes, Nearest32, Overflow, Quantization};

use crate::series::Random;
use crate::tally::{TrialTally, tally};

/// Bits of the operands of which all pairs are tried.
const WORD: u32 = 12;

/// Fraction bits of the operands: what products and quotients are shifted by.
const FRACTION: u32 = 8;

/// Modes of overflow that are tried.
pub const OVERFLOWS: [Overflow; 9] = [
    Overflow::Sat,
    Overflow::SatZero,
    Overflow::SatSym,
    Overflow::Wrap(0),
    Overflow::Wrap(1),
    Overflow::Wrap(3),
    Overflow::WrapSm(0),
    Overflow::WrapSm(1),
    Overflow::WrapSm(3),
];

/// Random pairs of operands, added, subtracted, multiplied and divided in every mode.
pub fn arithmetic(seed: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let mut random = Random::new(seed, trial);
        let any = |random: &mut Random| (random.bits() >> (64 - WORD)) as i32 - (1 << (WORD - 1));
        check_pair(any(&mut random), any(&mut random)).map(|()| 0.0)
    })
}

/// Trials of all pairs: a trial is a first operand.
pub fn all_pairs(_: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let ends = 1 << (WORD - 1);
        (-ends..ends).try_for_each(|b| check_pair(trial as i32 - ends, b)).map(|()| 0.0)
    })
}

fn check_pair(a: i32, b: i32) -> Result<(), String> {
    let format = Format { is_signed: true, word: WORD, integer: (WORD - FRACTION) as i32 };
    let operands = [a, b].map(|raw| Number { format, raw: raw.into() });
    let (wide_a, wide_b) = (i128::from(a), i128::from(b));
    for (&quantization, overflow) in Quantization::ALL.iter().flat_map(|q| OVERFLOWS.map(|o| (q, o))) {
        let modes = Modes { word: WORD, quantization, overflow };
        let found = [
            (Operation::Add, modes.narrow(wide_a + wide_b, 0)),
            (Operation::Sub, modes.narrow(wide_a - wide_b, 0)),
            (Operation::Mul, modes.narrow(wide_a * wide_b, FRACTION)),
            (Operation::Div, modes.quotient(wide_a << FRACTION, wide_b)),
        ];
        for (operation, raw) in found {
            let expected = operate(operation, &operands, format, quantization, overflow).raw;
            if i128::from(raw) != expected {
                let name = operation.name();
                return Err(format!(
                    "{name} {a}, {b} with {} and {overflow}: {raw}, not {expected}",
                    quantization.name()
                ));
            }
        }
    }
    Ok(())
}

/// Roots of operands of 32 bits, next to squares and anywhere.
pub fn roots(seed: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let mut random = Random::new(seed, trial);
        let root = random.bits() >> 48;
        let near = (root * root + random.below(5) as u64).saturating_sub(2);
        check_root([random.bits() >> 32, near.min(u32::MAX.into())][random.below(2)])
    })
}

/// The roots of all operands of 32 bits; a trial is 2^16 of them.
pub fn all_roots(_: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        (trial << 16..(trial + 1) << 16).try_for_each(|value| check_root(value).map(|_| ())).map(|()| 0.0)
    })
}

/// r is the nearest integer exactly when (2r - 1)^2 < 4x < (2r + 1)^2.
fn check_root(value: u64) -> Result<f64, String> {
    let root = Nearest32.root(value.into()) as u64;
    let four = 4 * value;
    let is_right = (root == 0 || (2 * root - 1).pow(2) < four) && four < (2 * root + 1).pow(2);
    if is_right { Ok(0.0) } else { Err(format!("the root of {value} is not {root}")) }
}
