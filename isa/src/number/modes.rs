//! The quantization and overflow modes of IEEE 1666 (SystemC fixed point), chosen at run time.

use std::fmt;

use super::Arithmetic;

/// Makes a mode enum with its standard names.
macro_rules! modes {
    ($(#[doc = $enum_doc:literal])* $type:ident { $($(#[doc = $doc:literal])* $variant:ident $name:literal,)* }) => {
        $(#[doc = $enum_doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $type { $($(#[doc = $doc])* $variant,)* }

        impl $type {
            /// Every mode.
            pub const ALL: &[$type] = &[$($type::$variant),*];

            /// The name in IEEE 1666, without its `SC_`.
            pub const fn name(self) -> &'static str {
                match self { $($type::$variant => $name,)* }
            }

            /// The mode of that name, in any case.
            pub fn from_name(name: &str) -> Option<$type> {
                $type::ALL.iter().copied().find(|mode| mode.name().eq_ignore_ascii_case(name))
            }
        }
    };
}

modes! {
    /// Rounding: the treatment of the bits below the last place.
    Quantization {
        /// To nearest, ties towards plus infinity.
        Rnd "RND",
        /// To nearest, ties towards zero.
        RndZero "RND_ZERO",
        /// To nearest, ties towards minus infinity.
        RndMinInf "RND_MIN_INF",
        /// To nearest, ties away from zero.
        RndInf "RND_INF",
        /// To nearest, ties to even.
        RndConv "RND_CONV",
        /// Towards minus infinity.
        Trn "TRN",
        /// Towards zero.
        TrnZero "TRN_ZERO",
    }
}

/// Overflow: the treatment of a number that does not fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Overflow {
    /// The nearest number that fits.
    Sat,
    /// Zero.
    SatZero,
    /// The nearest number of the symmetric range: the least one is minus the largest.
    SatSym,
    /// The low bits, below this number of *saturated bits*: the highest ones of the nearest number that fits.
    Wrap(u32),
    /// Sign-magnitude wrap: the same with all bits inverted first where the lowest saturated bit differs from the bit in its place; without
    /// saturated bits, where the lowest deleted bit differs from the sign that is left.
    WrapSm(u32),
}

impl Overflow {
    /// All modes, without saturated bits.
    pub const ALL: &[Overflow] =
        &[Overflow::Sat, Overflow::SatZero, Overflow::SatSym, Overflow::Wrap(0), Overflow::WrapSm(0)];

    /// Most saturated bits that a mode may name; from the word's length on they are all of its bits.
    pub const MOST_SATURATED: u32 = 64;

    /// The name in IEEE 1666, without its `SC_`.
    pub const fn name(self) -> &'static str {
        match self {
            Overflow::Sat => "SAT",
            Overflow::SatZero => "SAT_ZERO",
            Overflow::SatSym => "SAT_SYM",
            Overflow::Wrap(_) => "WRAP",
            Overflow::WrapSm(_) => "WRAP_SM",
        }
    }

    /// The mode with a number of saturated bits, where it has them.
    pub const fn with_saturated(self, bits: u32) -> Overflow {
        match self {
            Overflow::Wrap(_) => Overflow::Wrap(bits),
            Overflow::WrapSm(_) => Overflow::WrapSm(bits),
            other => other,
        }
    }

    /// The mode of that name, in any case; `WRAP:3` and `WRAP_SM:3` have three saturated bits.
    pub fn from_name(name: &str) -> Option<Overflow> {
        let (name, bits) = name.split_once(':').map_or((name, None), |(name, bits)| (name, Some(bits)));
        let mode = Overflow::ALL.iter().copied().find(|mode| mode.name().eq_ignore_ascii_case(name))?;
        let Some(bits) = bits else { return Some(mode) };
        let bits = bits.parse().ok().filter(|&bits| bits <= Overflow::MOST_SATURATED)?;
        matches!(mode, Overflow::Wrap(_) | Overflow::WrapSm(_)).then_some(mode.with_saturated(bits))
    }
}

impl fmt::Display for Overflow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Overflow::Wrap(bits @ 1..) | Overflow::WrapSm(bits @ 1..) => write!(f, "{}:{bits}", self.name()),
            _ => f.write_str(self.name()),
        }
    }
}

impl fmt::Display for Quantization {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Word length and modes of a machine, chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Modes {
    /// Bits of a word, 8 to 32.
    pub word: u32,
    /// Rounding.
    pub quantization: Quantization,
    /// Overflow.
    pub overflow: Overflow,
}

impl Default for Modes {
    fn default() -> Modes {
        Modes { word: 32, quantization: Quantization::Rnd, overflow: Overflow::Sat }
    }
}

impl Quantization {
    /// 1 when the number above its floor is to be rounded up, given how the rest compares with one half.
    fn increment(self, rest: i128, half: std::cmp::Ordering, is_negative: bool, is_odd: bool) -> i128 {
        use std::cmp::Ordering::{Equal, Greater};
        let up = match self {
            Quantization::Trn => false,
            Quantization::TrnZero => is_negative && rest != 0,
            _ if half != Equal => half == Greater,
            Quantization::Rnd => true,
            Quantization::RndMinInf => false,
            Quantization::RndZero => is_negative,
            Quantization::RndInf => !is_negative,
            Quantization::RndConv => is_odd,
        };
        i128::from(up)
    }

    /// `value / 2^shift`, quantized; `shift` at most 126.
    pub fn shift(self, value: i128, shift: u32) -> i128 {
        if shift == 0 {
            return value;
        }
        let floor = value >> shift;
        let rest = value & ((1 << shift) - 1);
        floor + self.increment(rest, rest.cmp(&(1 << (shift - 1))), value < 0, floor & 1 == 1)
    }

    /// The exact quotient, quantized; the divisor is not 0 and below 2^126.
    pub fn divide(self, dividend: i128, divisor: i128) -> i128 {
        let (dividend, divisor) = if divisor < 0 { (-dividend, -divisor) } else { (dividend, divisor) };
        // One division: a second one for the rest would take as long again.
        let mut floor = dividend / divisor;
        let mut rest = dividend - floor * divisor;
        if rest < 0 {
            (floor, rest) = (floor - 1, rest + divisor);
        }
        floor + self.increment(rest, (2 * rest).cmp(&divisor), dividend < 0, floor & 1 == 1)
    }
}

impl Overflow {
    /// Brings a number into `bits` bits, at most 64.
    pub fn fit(self, value: i128, bits: u32) -> i64 {
        let largest = (1i128 << (bits - 1)) - 1;
        let least = match self {
            Overflow::SatSym => -largest,
            _ => -largest - 1,
        };
        if (least..=largest).contains(&value) {
            return value as i64;
        }
        let end = value.clamp(least, largest) as i64;
        let low = |value: i128| ((value << (128 - bits)) >> (128 - bits)) as i64;
        let bit = |at: u32| (value >> at) & 1 == 1;
        let saturated = |value: i128, high: u32| {
            let rest = i64::MAX >> (63 - (bits - high));
            (end & !rest) | (value as i64 & rest)
        };
        match self {
            Overflow::Sat | Overflow::SatSym => end,
            Overflow::SatZero => 0,
            Overflow::Wrap(0) => low(value),
            Overflow::Wrap(high) | Overflow::WrapSm(high) if high >= bits => end,
            Overflow::Wrap(high) => saturated(value, high),
            Overflow::WrapSm(0) => low(if bit(bits) == bit(bits - 1) { value } else { !value }),
            Overflow::WrapSm(1) => low(if bit(bits - 1) == (value < 0) { value } else { !value }),
            Overflow::WrapSm(high) => saturated(if bit(bits - high) == (value < 0) { !value } else { value }, high),
        }
    }
}

/// Losses of an exact number on its way into a word: the flags of IEEE 1666.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flags {
    /// Bits were lost below the last place.
    pub is_quantized: bool,
    /// The quantized number did not fit.
    pub has_overflowed: bool,
}

impl Modes {
    fn flags(&self, is_quantized: bool, quantized: i128, bits: u32) -> Flags {
        let largest = (1i128 << (bits - 1)) - 1;
        let least = if self.overflow == Overflow::SatSym { -largest } else { -largest - 1 };
        Flags { is_quantized, has_overflowed: !(least..=largest).contains(&quantized) }
    }

    /// Flags of [`Arithmetic::quantize`] for a number.
    pub fn flags_of(&self, value: i128, shift: u32, bits: u32) -> Flags {
        let is_quantized = value & ((1 << shift) - 1) != 0;
        self.flags(is_quantized, self.quantization.shift(value, shift), bits)
    }

    /// Flags of [`Arithmetic::quotient`]; dividing by zero overflows.
    pub fn flags_of_quotient(&self, dividend: i128, divisor: i128) -> Flags {
        match divisor {
            0 => Flags { is_quantized: false, has_overflowed: true },
            _ => self.flags(dividend % divisor != 0, self.quantization.divide(dividend, divisor), self.word),
        }
    }
}

impl Arithmetic for Modes {
    fn word(&self) -> u32 {
        self.word
    }

    fn quantize(&self, value: i128, shift: u32, bits: u32) -> i64 {
        self.overflow.fit(self.quantization.shift(value, shift), bits)
    }

    fn quotient(&self, dividend: i128, divisor: i128) -> i32 {
        let exact = match divisor {
            0 => dividend.signum() << self.word,
            _ => self.quantization.divide(dividend, divisor),
        };
        // A quotient by zero has no low bits that could wrap: it saturates in every mode.
        let overflow = match self.overflow {
            Overflow::SatSym => Overflow::SatSym,
            _ if divisor == 0 => Overflow::Sat,
            other => other,
        };
        overflow.fit(exact, self.word) as i32
    }
}
