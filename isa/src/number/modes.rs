//! The quantization and overflow modes of IEEE 1666 (SystemC fixed point), chosen at run time.

use super::Arithmetic;

/// Makes a mode enum with its standard names.
macro_rules! modes {
    ($(#[doc = $enum_doc:literal])* $type:ident { $($(#[doc = $doc:literal])* $variant:ident $name:literal,)* }) => {
        $(#[doc = $enum_doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $type { $($(#[doc = $doc])* $variant,)* }

        impl $type {
            /// All modes.
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
    /// What becomes of the bits below the last place.
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

modes! {
    /// What becomes of a number that does not fit.
    Overflow {
        /// The nearest number that fits.
        Sat "SAT",
        /// Zero.
        SatZero "SAT_ZERO",
        /// The nearest number of the symmetric range: the least one is minus the largest.
        SatSym "SAT_SYM",
        /// The low bits.
        Wrap "WRAP",
        /// Sign-magnitude wrap: the low bits, inverted where the lowest deleted bit differs from the sign left.
        WrapSm "WRAP_SM",
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
        let low = |value: i128| ((value << (128 - bits)) >> (128 - bits)) as i64;
        match self {
            Overflow::Sat | Overflow::SatSym => value.clamp(least, largest) as i64,
            Overflow::SatZero => 0,
            Overflow::Wrap => low(value),
            Overflow::WrapSm if (value >> bits) & 1 == (value >> (bits - 1)) & 1 => low(value),
            Overflow::WrapSm => low(!value),
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
