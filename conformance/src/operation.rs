//! One operation on fixed-point numbers, exactly, with one quantization at the end.

use std::ops::Shl;

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{Signed, ToPrimitive};

use isa::number::{Overflow, Quantization};

/// A format: value = raw 2^(integer - word).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    /// Numbers are two's complement; else they have no sign.
    pub is_signed: bool,
    /// Bits, 1 to 64.
    pub word: u32,
    /// Bits before the point, the sign among them, -64 to 128; SystemC's `iwl`.
    pub integer: i32,
}

impl Format {
    /// Least and largest raw number.
    pub fn range(&self) -> (i128, i128) {
        let whole = 1i128 << self.word;
        if self.is_signed { (-whole / 2, whole / 2 - 1) } else { (0, whole - 1) }
    }

    /// Weight of the last place, as a power of two.
    fn last_place(&self) -> i32 {
        self.integer - self.word as i32
    }
}

/// A number in its format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Number {
    /// The format, which says where the point is.
    pub format: Format,
    /// In units of its last place, within the format's range.
    pub raw: i128,
}

/// An operation on one to three numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// a in another format.
    Cvt,
    /// -a.
    Neg,
    /// a + b.
    Add,
    /// a - b.
    Sub,
    /// a b.
    Mul,
    /// a / b.
    Div,
    /// a b + c.
    Mac,
}

impl Operation {
    /// Every operation.
    pub const ALL: [Operation; 7] = [
        Operation::Cvt,
        Operation::Neg,
        Operation::Add,
        Operation::Sub,
        Operation::Mul,
        Operation::Div,
        Operation::Mac,
    ];

    /// The operation's name in vectors.
    pub const fn name(self) -> &'static str {
        match self {
            Operation::Cvt => "cvt",
            Operation::Neg => "neg",
            Operation::Add => "add",
            Operation::Sub => "sub",
            Operation::Mul => "mul",
            Operation::Div => "div",
            Operation::Mac => "mac",
        }
    }

    /// Number of operands.
    pub const fn operands(self) -> usize {
        match self {
            Operation::Cvt | Operation::Neg => 1,
            Operation::Add | Operation::Sub | Operation::Mul | Operation::Div => 2,
            Operation::Mac => 3,
        }
    }
}

/// The result of an operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OperationOutcome {
    /// In units of the result's last place.
    pub raw: i128,
    /// Bits below the last place were lost.
    pub is_quantized: bool,
    /// The quantized number did not fit; a quotient by zero never does.
    pub has_overflowed: bool,
}

/// A quotient of integers; the divisor is positive.
struct Fraction<I> {
    numerator: I,
    denominator: I,
}

/// The exact result, quantized once, then brought into the format.
///
/// x / 0 saturates with the sign of x in every overflow mode, 0 / 0 is 0; both overflow. Numbers without a sign have no WRAP_SM: the low bits
/// are taken as they are.
pub fn operate(
    operation: Operation,
    operands: &[Number],
    format: Format,
    quantization: Quantization,
    overflow: Overflow,
) -> OperationOutcome {
    // A quotient by 0 has no value to quantize: the end of the range with the sign of a.
    let [a, b, c] = std::array::from_fn(|k| operands.get(k).copied());
    let a = a.expect("every operation has an operand");
    if operation == Operation::Div && b.is_some_and(|b| b.raw == 0) {
        let saturated = match overflow {
            Overflow::SatSym => Overflow::SatSym,
            _ => Overflow::Sat,
        };
        let raw = if a.raw == 0 { 0 } else { fit(&(a.raw.signum() << 65), format, saturated).0 };
        return OperationOutcome { raw, is_quantized: false, has_overflowed: true };
    }
    // Where every step fits 128 bits, they do; the formulas are the same.
    let places = [a.format.last_place(), format.last_place()];
    let others = [b, c].into_iter().flatten().map(|number| number.format.last_place());
    let reach: u32 = places.into_iter().chain(others).map(i32::unsigned_abs).sum();
    let words: u32 = [Some(a), b, c].into_iter().flatten().map(|number| number.format.word).sum();
    if 2 * reach + words < 120 {
        finish(&exact::<i128>(operation, a, b, c, format), format, quantization, overflow)
    } else {
        finish(&exact::<BigInt>(operation, a, b, c, format), format, quantization, overflow)
    }
}

/// Integers that the formulas are computed with: as long as need be, or 128 bits.
trait ExactInteger: Integer + Signed + Clone + From<i128> + Shl<u32, Output = Self> + ToPrimitive {}

impl<I: Integer + Signed + Clone + From<i128> + Shl<u32, Output = I> + ToPrimitive> ExactInteger for I {}

/// The result in units of the format's last place.
fn exact<I: ExactInteger>(
    operation: Operation,
    a: Number,
    b: Option<Number>,
    c: Option<Number>,
    format: Format,
) -> Fraction<I> {
    let place = |number: Number| number.format.last_place();
    let raw = |number: Number| I::from(number.raw);
    let none = Number { raw: 0, ..a };
    let (b, c) = (b.unwrap_or(none), c.unwrap_or(none));
    // Compute a fraction in units of 2^at: 3 2^-2 times 5 2^-1 is 15 2^-3.
    let (numerator, at, denominator) = match operation {
        Operation::Cvt => (raw(a), place(a), I::one()),
        Operation::Neg => (-raw(a), place(a), I::one()),
        Operation::Add => {
            let (sum, at) = sum((raw(a), place(a)), (raw(b), place(b)));
            (sum, at, I::one())
        }
        Operation::Sub => {
            let (sum, at) = sum((raw(a), place(a)), (-raw(b), place(b)));
            (sum, at, I::one())
        }
        Operation::Mul => (raw(a) * raw(b), place(a) + place(b), I::one()),
        Operation::Div => (raw(a) * raw(b).signum(), place(a) - place(b), raw(b).abs()),
        Operation::Mac => {
            let (sum, at) = sum((raw(a) * raw(b), place(a) + place(b)), (raw(c), place(c)));
            (sum, at, I::one())
        }
    };
    // Bring it into units of the last place: numerator or denominator takes the rest of the weight.
    let shift = at - format.last_place();
    match shift {
        0.. => Fraction { numerator: numerator << shift as u32, denominator },
        _ => Fraction { numerator, denominator: denominator << shift.unsigned_abs() },
    }
}

/// The sum of two numbers with the weights of their last places.
fn sum<I: ExactInteger>((a, at): (I, i32), (b, bt): (I, i32)) -> (I, i32) {
    let least = at.min(bt);
    ((a << (at - least) as u32) + (b << (bt - least) as u32), least)
}

fn finish<I: ExactInteger>(
    value: &Fraction<I>,
    format: Format,
    quantization: Quantization,
    overflow: Overflow,
) -> OperationOutcome {
    let is_quantized = !value.numerator.is_multiple_of(&value.denominator);
    let (raw, has_overflowed) = fit(&round(value, quantization), format, overflow);
    OperationOutcome { raw, is_quantized, has_overflowed }
}

/// The integer that a mode makes of a number.
fn round<I: ExactInteger>(value: &Fraction<I>, mode: Quantization) -> I {
    let two = I::one() + I::one();
    let floor = |numerator: &I| numerator.div_floor(&value.denominator);
    // The floor of x + 1/2, and the ceiling of x - 1/2.
    let up = |x: &I| {
        (x.clone() * two.clone() + value.denominator.clone()).div_floor(&(value.denominator.clone() * two.clone()))
    };
    let down = |x: &I| -up(&-x.clone());
    let x = &value.numerator;
    let size = x.abs();
    // Modes that treat both signs alike round the size.
    match mode {
        Quantization::Trn => floor(x),
        Quantization::TrnZero => floor(&size) * x.signum(),
        Quantization::Rnd => up(x),
        Quantization::RndMinInf => down(x),
        Quantization::RndInf => up(&size) * x.signum(),
        Quantization::RndZero => down(&size) * x.signum(),
        Quantization::RndConv => {
            let (above, below) = (up(x), down(x));
            if above.is_even() { above } else { below }
        }
    }
}

/// The number that a mode makes of one that may not fit, and whether it did not.
fn fit<I: ExactInteger>(value: &I, format: Format, mode: Overflow) -> (i128, bool) {
    let (lowest, largest) = format.range();
    let least = if mode == Overflow::SatSym && format.is_signed { -largest } else { lowest };
    let word = format.word;
    let small = |value: &I| value.to_i128().expect("it is between the ends of the range");
    if *value < I::from(least) {
        (overflowed(value, true, format, mode, least), true)
    } else if *value > I::from(largest) {
        (overflowed(value, false, format, mode, largest), true)
    } else {
        debug_assert!(word <= 64);
        (small(value), false)
    }
}

/// The result for a number below or above the range, whose nearest number is `end`.
fn overflowed<I: ExactInteger>(value: &I, is_below: bool, format: Format, mode: Overflow, end: i128) -> i128 {
    let word = format.word;
    // The low bits as a number without a sign, and a single bit.
    let low = |value: &I, bits: u32| value.mod_floor(&(I::one() << bits)).to_i128().expect("64 bits at most");
    let bit = |at: u32| low(value, at + 1) >> at == 1;
    // With a sign, the highest bit weighs the other way.
    let signed = |bits: i128| if format.is_signed && bits >> (word - 1) == 1 { bits - (1 << word) } else { bits };
    let inverted = || -value.clone() - I::one();
    // The highest bits are those of the end of the range, the others come from the number.
    let saturated = |value: &I, bits: u32| {
        let rest = word - bits;
        (end >> rest << rest) + low(value, rest)
    };
    match mode {
        Overflow::Sat | Overflow::SatSym => end,
        Overflow::SatZero => 0,
        Overflow::Wrap(0) => signed(low(value, word)),
        Overflow::Wrap(bits) | Overflow::WrapSm(bits) if bits >= word => end,
        Overflow::Wrap(bits) => saturated(value, bits),
        Overflow::WrapSm(0) if bit(word) != bit(word - 1) => signed(low(&inverted(), word)),
        Overflow::WrapSm(0) => signed(low(value, word)),
        Overflow::WrapSm(1) if is_below != bit(word - 1) => signed(low(&inverted(), word)),
        Overflow::WrapSm(1) => signed(low(value, word)),
        Overflow::WrapSm(bits) if is_below == bit(word - bits) => saturated(&inverted(), bits),
        Overflow::WrapSm(bits) => saturated(value, bits),
    }
}
