//! The machine's arithmetic as meanings in Rust see it: the default one without a detour, any other behind one.

use isa::number::{Arithmetic, Nearest32};

/// Word length and modes of the machine. The meanings of the table's rows are there too: [`crate::semantics::VectorRoom`] and its kind.
#[derive(Clone, Copy)]
pub enum Numbers<'a> {
    /// Words of 32 bits, to nearest, saturating: the default.
    Nearest32,
    /// Any other.
    Other(&'a dyn Arithmetic),
}

/// Keeps what other arithmetic takes out of loops over components, so that the default's are unrolled.
#[cold]
#[inline(never)]
fn seldom<R>(compute: impl FnOnce() -> R) -> R {
    compute()
}

macro_rules! forward {
    ($self:ident, $name:ident($($argument:ident),*)) => {
        match $self {
            Numbers::Nearest32 => Nearest32.$name($($argument),*),
            Numbers::Other(arithmetic) => seldom(|| arithmetic.$name($($argument),*)),
        }
    };
}

// Also what has a default in terms of the others: those of `Nearest32` are faster.
impl Arithmetic for Numbers<'_> {
    #[inline]
    fn word(&self) -> u32 {
        forward!(self, word())
    }

    #[inline]
    fn quantize(&self, value: i128, shift: u32, bits: u32) -> i64 {
        forward!(self, quantize(value, shift, bits))
    }

    #[inline]
    fn narrow64(&self, value: i64, shift: u32) -> i32 {
        forward!(self, narrow64(value, shift))
    }

    #[inline]
    fn widen64(&self, value: i64) -> i64 {
        forward!(self, widen64(value))
    }

    #[inline]
    fn widen_sum(&self, a: i64, b: i64) -> i64 {
        forward!(self, widen_sum(a, b))
    }

    #[inline]
    fn widen_difference(&self, a: i64, b: i64) -> i64 {
        forward!(self, widen_difference(a, b))
    }

    #[inline]
    fn widen_products(&self, products: [i64; 3]) -> i64 {
        forward!(self, widen_products(products))
    }

    #[inline]
    fn narrow_products(&self, products: [i64; 3], shift: u32) -> i32 {
        forward!(self, narrow_products(products, shift))
    }

    #[inline]
    fn quotient(&self, dividend: i128, divisor: i128) -> i32 {
        forward!(self, quotient(dividend, divisor))
    }

    #[inline]
    fn root(&self, value: u128) -> i32 {
        forward!(self, root(value))
    }
}
