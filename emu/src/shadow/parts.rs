//! Parts of an error, by the source line that brought them in.

/// Lines that an error remembers. What the others brought in is one sum without names.
const MOST: usize = 12;

/// Parts of the difference between a machine's number and its shadow. They add up to it, but for their rounding to 24 bits.
///
/// Sums add parts, and a product, a quotient or a root scales them by what stands beside the error in an exact formula, such as
/// `a b - a' b' = (a - a') b' + a (b - b')`. So nothing is left over that no line owns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErrorParts {
    /// Sites of the lines, in ascending order; of these the first `length`.
    sites: [u32; MOST],
    /// Amounts in raw units.
    amounts: [f32; MOST],
    length: u8,
    /// Sum of the amounts that have no place.
    rest: f32,
}

/// An amount that stays a number, however large.
fn finite(amount: f64) -> f32 {
    if amount.is_nan() { 0.0 } else { amount.clamp(f32::MIN.into(), f32::MAX.into()) as f32 }
}

impl ErrorParts {
    /// No error.
    pub const NONE: ErrorParts = ErrorParts { sites: [0; MOST], amounts: [0.0; MOST], length: 0, rest: 0.0 };

    /// The error that one line brought in.
    pub fn of(site: u32, amount: f64) -> ErrorParts {
        let mut parts = ErrorParts::NONE;
        parts.push(site, finite(amount));
        parts
    }

    /// Site and amount of each part, sites ascending.
    pub fn iter(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let length = usize::from(self.length);
        self.sites[..length].iter().copied().zip(self.amounts[..length].iter().map(|&amount| amount.into()))
    }

    /// Sum of the parts that have no name any more.
    pub fn rest(&self) -> f64 {
        self.rest.into()
    }

    /// Puts a part behind the others; of too many, the least goes to the rest.
    fn push(&mut self, site: u32, amount: f32) {
        if amount == 0.0 {
            return;
        }
        let mut length = usize::from(self.length);
        if length == MOST {
            let least = (0..MOST).min_by(|&a, &b| self.amounts[a].abs().total_cmp(&self.amounts[b].abs())).unwrap_or(0);
            if self.amounts[least].abs() >= amount.abs() {
                self.rest = finite(f64::from(self.rest) + f64::from(amount));
                return;
            }
            self.rest = finite(f64::from(self.rest) + f64::from(self.amounts[least]));
            self.sites.copy_within(least + 1.., least);
            self.amounts.copy_within(least + 1.., least);
            length = MOST - 1;
        }
        (self.sites[length], self.amounts[length], self.length) = (site, amount, length as u8 + 1);
    }

    /// The parts, each times a factor.
    pub fn times(&self, factor: f64) -> ErrorParts {
        let mut parts = *self;
        parts.amounts[..usize::from(self.length)]
            .iter_mut()
            .for_each(|amount| *amount = finite(f64::from(*amount) * factor));
        parts.rest = finite(f64::from(self.rest) * factor);
        parts
    }

    /// The parts of both, those of one line added.
    pub fn plus(&self, other: &ErrorParts) -> ErrorParts {
        // Most operands of an instruction are exact.
        if other.length == 0 && other.rest == 0.0 {
            return *self;
        }
        if self.length == 0 && self.rest == 0.0 {
            return *other;
        }
        let mut sum = ErrorParts { rest: finite(f64::from(self.rest) + f64::from(other.rest)), ..ErrorParts::NONE };
        let (ends, mut a, mut b) = ((usize::from(self.length), usize::from(other.length)), 0, 0);
        // Both lists ascend, so the next site is the lesser of the two in front.
        while a < ends.0 || b < ends.1 {
            let here = if a < ends.0 { self.sites[a] } else { u32::MAX };
            let there = if b < ends.1 { other.sites[b] } else { u32::MAX };
            let mut amount = 0.0;
            if a < ends.0 && here <= there {
                amount += f64::from(self.amounts[a]);
                a += 1;
            }
            if b < ends.1 && there <= here {
                amount += f64::from(other.amounts[b]);
                b += 1;
            }
            sum.push(here.min(there), finite(amount));
        }
        sum
    }

    /// The parts with what one more line brought in.
    pub fn with(&self, site: u32, amount: f64) -> ErrorParts {
        if amount == 0.0 { *self } else { self.plus(&ErrorParts::of(site, amount)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_one_line_are_added_and_the_least_lose_their_names() {
        let parts = ErrorParts::of(7, 2.0).plus(&ErrorParts::of(3, 1.0)).with(7, -0.5).times(2.0);
        assert_eq!(parts.iter().collect::<Vec<_>>(), [(3, 2.0), (7, 3.0)]);
        let many = (0..20).fold(ErrorParts::NONE, |parts, site| parts.with(site, f64::from(site + 1)));
        assert_eq!(many.iter().count(), MOST);
        assert_eq!(many.iter().next(), Some((8, 9.0)), "the twelve largest stay");
        assert_eq!(many.rest() + many.iter().map(|(_, amount)| amount).sum::<f64>(), 210.0);
        let endless = ErrorParts::of(1, f64::INFINITY).times(0.5);
        assert!(endless.iter().all(|(_, amount)| amount.is_finite() && amount > 0.0));
        assert_eq!(ErrorParts::of(1, 1.0).with(1, -1.0), ErrorParts::NONE, "what cancels is gone");
    }
}
