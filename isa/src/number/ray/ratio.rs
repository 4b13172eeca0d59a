//! The quotient of two determinants, rounded once.

use crate::number::Arithmetic;

/// `dividend 2^shift / divisor` for numbers of the same sign below 2^126, quantized once to a word under the arithmetic's rounding. It saturates
/// in every overflow mode: a distance that wrapped would look near. `divisor` is not 0.
pub fn ratio(arithmetic: &impl Arithmetic, dividend: i128, divisor: i128, shift: u32) -> i32 {
    debug_assert!(divisor != 0 && dividend.signum() * divisor.signum() >= 0);
    let largest = i32::MAX >> (32 - arithmetic.word());
    let (floor, rest, divisor) = divide(dividend.unsigned_abs(), divisor.unsigned_abs(), shift);
    if floor >= largest as u128 {
        return largest;
    }
    // In quarters, what is above the floor is on the same side of one half: that is all that rounding asks.
    let above = match (2 * rest).cmp(&divisor) {
        _ if rest == 0 => 0,
        std::cmp::Ordering::Less => 1,
        std::cmp::Ordering::Equal => 2,
        std::cmp::Ordering::Greater => 3,
    };
    arithmetic.narrow64((4 * floor) as i64 + above, 2)
}

/// Quotient and rest of `dividend 2^shift / divisor`, and the divisor; the quotient stops growing once it is beyond every word.
fn divide(dividend: u128, divisor: u128, shift: u32) -> (u128, u128, u128) {
    debug_assert!(divisor < 1 << 126);
    if dividend.leading_zeros() > shift {
        let dividend = dividend << shift;
        let floor = dividend / divisor;
        return (floor, dividend - floor * divisor, divisor);
    }
    // Digit by digit of as many bits as there is room for above the divisor.
    let room = divisor.leading_zeros();
    let (mut floor, mut rest) = (dividend / divisor, dividend % divisor);
    let mut left = shift;
    while left > 0 && floor < 1 << 64 {
        let digit = left.min(room);
        let next = rest << digit;
        (floor, rest) = ((floor << digit) | (next / divisor), next % divisor);
        left -= digit;
    }
    (floor, rest, divisor)
}
