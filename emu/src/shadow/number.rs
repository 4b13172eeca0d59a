//! Numbers with a shadow: what the machine computes with, what exact arithmetic would have come to, and which lines made the difference.

use std::sync::Arc;

use super::long_real::{LongReal, power};
use super::parts::ErrorParts;

/// A real number that differs from the machine's, in units of the register, and the parts of the difference.
#[derive(Clone, Debug)]
pub struct Deviation {
    /// The real number.
    pub real: LongReal,
    /// Parts of the machine's number minus the real one.
    pub parts: ErrorParts,
}

/// A number of a register or a word of memory, beside the machine's raw one: the real number that the same inputs would have given.
#[derive(Clone, Debug, Default)]
pub struct ShadowNumber {
    /// The real number, where it is another one than the machine's.
    pub deviation: Option<Arc<Deviation>>,
    /// Fraction bits that the number has, where a declared format and exact formulas tell.
    pub scale: Option<i32>,
    /// Site of the line whose shift gave it these bits, as long as no declaration has said that they are right.
    pub fitted: Option<u32>,
}

/// A number in a formula: the formula's exact value on the machine's numbers, and on their shadows.
#[derive(Clone, Debug)]
pub struct ShadowTerm {
    /// Value on the machine's numbers, before anything is rounded.
    pub machine: LongReal,
    /// Value on the shadows, where it is another one.
    pub deviation: Option<Arc<Deviation>>,
    /// Fraction bits, where they are known.
    pub scale: Option<i32>,
    /// Exponent of the largest term that was added on the way in this formula; `None` where nothing was added.
    pub largest: Option<i32>,
    /// Site of the line whose shift gave it its fraction bits, as in [`ShadowNumber`].
    pub fitted: Option<u32>,
}

impl ShadowTerm {
    /// A number that is known exactly, such as one of the program's constants.
    pub fn whole(raw: i64) -> ShadowTerm {
        ShadowTerm { machine: LongReal::whole(raw.into()), deviation: None, scale: None, largest: None, fitted: None }
    }

    /// The machine's number with its shadow; a number without one begins anew at the machine's.
    pub fn new(raw: i64, shadow: Option<&ShadowNumber>) -> ShadowTerm {
        ShadowTerm {
            deviation: shadow.and_then(|shadow| shadow.deviation.clone()),
            scale: shadow.and_then(|shadow| shadow.scale),
            fitted: shadow.and_then(|shadow| shadow.fitted),
            ..ShadowTerm::whole(raw)
        }
    }

    /// The value on the shadows.
    pub fn real(&self) -> &LongReal {
        self.deviation.as_ref().map_or(&self.machine, |deviation| &deviation.real)
    }

    pub(super) fn parts(&self, factor: f64) -> ErrorParts {
        self.deviation.as_ref().map_or(ErrorParts::NONE, |deviation| deviation.parts.times(factor))
    }

    fn with(self, deviates: bool, compute: impl FnOnce() -> Deviation) -> ShadowTerm {
        ShadowTerm { deviation: deviates.then(|| Arc::new(compute())), ..self }
    }

    fn deviates(&self, other: &ShadowTerm) -> bool {
        self.deviation.is_some() || other.deviation.is_some()
    }

    fn summed(&self, other: &ShadowTerm, sign: f64) -> ShadowTerm {
        let add = |a: &LongReal, b: &LongReal| if sign < 0.0 { a.minus(b) } else { a.plus(b) };
        let exponent = |term: &ShadowTerm| {
            let own = (!term.real().is_zero()).then(|| term.real().exponent());
            own.max(term.largest)
        };
        let sum = ShadowTerm {
            machine: add(&self.machine, &other.machine),
            deviation: None,
            // Numbers of two formats have no sum that has one; a number without a known format takes that of the other one where it is 0.
            scale: if self.scale == other.scale { self.scale } else { self.scale_beside_zero(other) },
            largest: exponent(self).max(exponent(other)),
            // A sum has the format of its terms, by the same shift.
            fitted: self.fitted.or(other.fitted),
        };
        sum.with(self.deviates(other), || Deviation {
            real: add(self.real(), other.real()),
            parts: self.parts(1.0).plus(&other.parts(sign)),
        })
    }

    fn scale_beside_zero(&self, other: &ShadowTerm) -> Option<i32> {
        let is_nothing = |term: &ShadowTerm| term.scale.is_none() && term.machine.is_zero() && term.deviation.is_none();
        match (is_nothing(self), is_nothing(other)) {
            (true, _) => other.scale,
            (_, true) => self.scale,
            _ => None,
        }
    }

    /// The sum.
    pub fn plus(&self, other: &ShadowTerm) -> ShadowTerm {
        self.summed(other, 1.0)
    }

    /// The difference.
    pub fn minus(&self, other: &ShadowTerm) -> ShadowTerm {
        self.summed(other, -1.0)
    }

    /// The number with the other sign.
    pub fn negated(&self) -> ShadowTerm {
        let negated = ShadowTerm { machine: self.machine.negated(), ..self.clone() };
        negated.with(self.deviation.is_some(), || Deviation { real: self.real().negated(), parts: self.parts(-1.0) })
    }

    /// The number times 2^by: the raw number grows, and the number that it stands for in its format stays.
    pub fn scaled(&self, by: i32) -> ShadowTerm {
        let scaled = ShadowTerm {
            machine: self.machine.scaled(by),
            scale: self.scale.map(|scale| scale + by),
            largest: self.largest.map(|largest| largest + by),
            deviation: None,
            fitted: None,
        };
        scaled
            .with(self.deviation.is_some(), || Deviation { real: self.real().scaled(by), parts: self.parts(power(by)) })
    }

    /// The product. The parts come from `a b - a' b' = (a - a') b' + a (b - b')`.
    pub fn times(&self, other: &ShadowTerm) -> ShadowTerm {
        let product = ShadowTerm {
            machine: self.machine.times(&other.machine),
            deviation: None,
            scale: self.scale.zip(other.scale).map(|(a, b)| a + b),
            largest: None,
            fitted: None,
        };
        product.with(self.deviates(other), || Deviation {
            real: self.real().times(other.real()),
            parts: self.parts(other.real().to_f64()).plus(&other.parts(self.machine.to_f64())),
        })
    }

    /// The quotient; `None` where the machine or the shadow divides by 0. The parts come from
    /// `a / b - a' / b' = ((a - a') - (a' / b') (b - b')) / b`.
    pub fn over(&self, other: &ShadowTerm) -> Option<ShadowTerm> {
        let quotient = ShadowTerm {
            machine: self.machine.over(&other.machine)?,
            deviation: None,
            scale: self.scale.zip(other.scale).map(|(a, b)| a - b),
            largest: None,
            fitted: None,
        };
        if !self.deviates(other) {
            return Some(quotient);
        }
        let real = self.real().over(other.real())?;
        let by = 1.0 / other.machine.to_f64();
        let parts = self.parts(by).plus(&other.parts(-real.to_f64() * by));
        Some(ShadowTerm { deviation: Some(Arc::new(Deviation { real, parts })), ..quotient })
    }

    /// The square root; `None` where the machine's number or the shadow is negative. The parts come from
    /// `r - r' = (a - a') / (r + r')`.
    pub fn root(&self) -> Option<ShadowTerm> {
        let machine = self.machine.root()?;
        // Half of an odd number of fraction bits is no number of bits.
        let scale = self.scale.filter(|scale| scale % 2 == 0).map(|scale| scale / 2);
        let root = ShadowTerm { machine, deviation: None, scale, largest: None, fitted: None };
        if self.deviation.is_none() {
            return Some(root);
        }
        let real = self.real().root()?;
        let sum = root.machine.to_f64() + real.to_f64();
        let parts = if sum == 0.0 { ErrorParts::NONE } else { self.parts(1.0 / sum) };
        Some(ShadowTerm { deviation: Some(Arc::new(Deviation { real, parts })), ..root })
    }
}
