//! Figures of energy and area by the bits of numbers or memories: exact decimal polynomials with a unit and a source.

use std::fmt;

/// Most decimals of a coefficient.
const MOST_DECIMALS: usize = 15;

/// Largest power of a variable.
const MOST_POWER: u32 = 3;

/// Bits behind the point of a logarithm.
const LOG_BITS: u32 = 16;

/// Kind of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Energy, counted in attojoules (10^-18 J).
    Energy,
    /// Area, counted in square nanometres (10^-6 um2).
    Area,
}

impl Dimension {
    /// Units in files, and the power of ten of the counted one that each is.
    pub const fn units(self) -> &'static [(&'static str, u32)] {
        match self {
            Dimension::Energy => &[("aJ", 0), ("fJ", 3), ("pJ", 6), ("nJ", 9)],
            Dimension::Area => &[("um2", 6), ("mm2", 12)],
        }
    }
}

/// Variable of a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Variable {
    /// None: a constant.
    None,
    /// Bits of the numbers, `b`.
    Bits,
    /// Binary logarithm of the bits of a memory, `L`.
    Log,
}

/// A coefficient and the power that it goes with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct FormulaTerm {
    /// Digits of the coefficient, the sign included.
    digits: i64,
    /// Digits behind the point.
    decimals: u32,
    /// Divisor, 1 to 10^6.
    divisor: u32,
    variable: Variable,
    power: u32,
}

/// One figure: a polynomial, its unit, and where it comes from.
///
/// In a file it is `0.003 b^2 + 0.001 b pJ; the source`: `b` are the bits of the numbers, `L` is the binary logarithm of the bits of a memory,
/// rounded down to 1/65536, and a coefficient may be a quotient such as `0.21/32`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FigureLine {
    text: String,
    terms: Vec<FormulaTerm>,
    /// Power of ten of the counted unit.
    exponent: u32,
    source_at: usize,
}

impl FigureLine {
    /// Reads a line.
    ///
    /// # Errors
    /// Reason for which it is none, as a sentence.
    pub fn parse(text: &str, dimension: Dimension) -> Result<FigureLine, String> {
        let text = text.trim();
        let (figure, source) = text.split_once(';').ok_or_else(|| {
            format!("`{text}` has no source: a line is a figure, a unit, `;` and where it comes from, such as `0.003 b pJ; my synthesis`")
        })?;
        if source.trim().is_empty() {
            return Err(format!("`{text}` has no source behind `;`: say where the figure comes from"));
        }
        let (formula, unit) = figure.trim().rsplit_once(char::is_whitespace).unwrap_or(("", figure.trim()));
        let known = dimension.units().iter().find(|(name, _)| *name == unit);
        let &(_, exponent) = known.ok_or_else(|| {
            let names: Vec<&str> = dimension.units().iter().map(|(name, _)| *name).collect();
            format!("`{unit}` is no unit of this figure: it is one of {}", names.join(", "))
        })?;
        let terms = terms(formula)?;
        let source_at = text.len() - source.trim_start().len();
        let line = FigureLine { text: text.to_owned(), terms, exponent, source_at };
        // Tried at the widest numbers and the largest memory, so that no run can find it too large.
        for (bits, memory) in [(8, 8), (64, 1), (64, 1 << 31)] {
            line.at(bits, memory).ok_or_else(|| format!("`{formula}` is below 0 or too large for some width"))?;
        }
        Ok(line)
    }

    /// The figure in counted units for numbers of `bits` bits or a memory of `memory` bits, rounded once, to the nearest, halves up; `None`
    /// below 0 or beyond 128 bits.
    ///
    /// For example `0.002994791667 b^2 + 0.001041666667 b pJ` at 8 bits is 0.191666666688 + 0.008333333336 pJ, 200,000 aJ.
    pub fn at(&self, bits: u32, memory: u64) -> Option<u64> {
        let log = log2(memory.max(1));
        let highest = self.terms.iter().filter(|term| term.variable == Variable::Log).map(|term| term.power).max();
        let log_bits = LOG_BITS * highest.unwrap_or(0);
        let decimals = self.terms.iter().map(|term| term.decimals).max().unwrap_or(0);
        let divisor = self.terms.iter().try_fold(1_i128, |all, term| lcm(all, term.divisor.into()))?;
        // Bring all terms over one denominator: 10^decimals, the common divisor, and the bits behind the points of logarithms
        let mut sum: i128 = 0;
        for term in &self.terms {
            let mut value = i128::from(term.digits);
            value = value.checked_mul(10_i128.checked_pow(decimals - term.decimals)?)?;
            value = value.checked_mul(divisor / i128::from(term.divisor))?;
            let (base, shift) = match term.variable {
                Variable::None => (1, log_bits),
                Variable::Bits => (i128::from(bits), log_bits),
                Variable::Log => (i128::from(log), log_bits - LOG_BITS * term.power),
            };
            value = value.checked_mul(base.checked_pow(term.power)?)?.checked_mul(1_i128.checked_shl(shift)?)?;
            sum = sum.checked_add(value)?;
        }
        let numerator = sum.checked_mul(10_i128.pow(self.exponent))?;
        let denominator =
            10_i128.checked_pow(decimals)?.checked_mul(divisor)?.checked_mul(1_i128.checked_shl(log_bits)?)?;
        let rounded = numerator.checked_mul(2)?.checked_add(denominator)?.div_euclid(denominator.checked_mul(2)?);
        u64::try_from(rounded).ok().filter(|_| numerator >= 0)
    }

    /// Formula and unit, as they are written.
    pub fn formula(&self) -> &str {
        self.text.split(';').next().unwrap_or_default().trim()
    }

    /// Source of the figure.
    pub fn source(&self) -> &str {
        &self.text[self.source_at..]
    }
}

impl fmt::Display for FigureLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

fn terms(formula: &str) -> Result<Vec<FormulaTerm>, String> {
    let example = "such as `0.003 b^2 + 0.001 b`";
    let mut found = Vec::new();
    // The sign of the next coefficient; none behind a coefficient and its variable.
    let mut sign = Some(1);
    // Signs become words: `0.1 b^2-2` is `0.1`, `b^2`, `-`, `2`, which are two terms, the second one below 0.
    for (at, word) in formula.replace('+', " + ").replace('-', " - ").split_whitespace().enumerate() {
        match word {
            "+" | "-" if at != 0 && sign.is_some() => {
                return Err(format!("`{word}` follows another sign; a formula is {example}"));
            }
            "+" if at != 0 => sign = Some(1),
            "-" => sign = Some(-1),
            word if word.starts_with(|c: char| c.is_ascii_digit()) => {
                let mut term = coefficient(word).ok_or_else(|| {
                    format!("`{word}` is no coefficient: a decimal number with at most {MOST_DECIMALS} digits, or one divided by a whole number")
                })?;
                term.digits *=
                    sign.take().ok_or_else(|| format!("`{word}` has no sign before it; a formula is {example}"))?;
                found.push(term);
            }
            word => {
                let (name, power) = word.split_once('^').unwrap_or((word, "1"));
                let power = power.parse().ok().filter(|power| (1..=MOST_POWER).contains(power));
                let variable = match name {
                    "b" => Some(Variable::Bits),
                    "L" => Some(Variable::Log),
                    _ => None,
                };
                let (Some(variable), Some(power)) = (variable, power) else {
                    return Err(format!("`{word}` is no power of b or L up to {MOST_POWER}; a formula is {example}"));
                };
                // A variable completes the coefficient before it, which has none yet.
                match found.last_mut() {
                    Some(term) if term.variable == Variable::None && sign.is_none() => {
                        (term.variable, term.power) = (variable, power)
                    }
                    _ => return Err(format!("`{word}` has no coefficient before it; a formula is {example}")),
                }
            }
        }
    }
    match sign {
        _ if found.is_empty() => Err(format!("there is no figure; a formula is {example}")),
        Some(_) => Err(format!("the last sign has no coefficient behind it; a formula is {example}")),
        None => Ok(found),
    }
}

/// A decimal number such as `0.21`, or one divided by a whole number such as `0.21/32`.
fn coefficient(word: &str) -> Option<FormulaTerm> {
    let (number, divisor) = word.split_once('/').unwrap_or((word, "1"));
    let divisor = divisor.parse().ok().filter(|divisor| (1..=1_000_000).contains(divisor))?;
    let (whole, behind) = number.split_once('.').unwrap_or((number, ""));
    let digits = format!("{whole}{behind}");
    if digits.len() > MOST_DECIMALS || !digits.bytes().all(|digit| digit.is_ascii_digit()) {
        return None;
    }
    Some(FormulaTerm {
        digits: digits.parse().ok()?,
        decimals: behind.len() as u32,
        divisor,
        variable: Variable::None,
        power: 0,
    })
}

/// Least common multiple.
fn lcm(a: i128, b: i128) -> Option<i128> {
    let (mut x, mut y) = (a, b);
    while y != 0 {
        (x, y) = (y, x % y);
    }
    (a / x).checked_mul(b)
}

/// Binary logarithm of a number from 1 on with [`LOG_BITS`] bits behind the point, rounded down, in whole numbers alone, so that no host has
/// another one.
fn log2(number: u64) -> u64 {
    let whole = number.ilog2();
    // The number as 1 to 2, with 63 bits behind the point: each squaring doubles the logarithm, and what comes to 2 is its next bit.
    let mut rest = u128::from(number << (63 - whole));
    let mut log = u64::from(whole);
    for _ in 0..LOG_BITS {
        rest = (rest * rest) >> 63;
        let is_two = rest >> 64 != 0;
        log = (log << 1) | u64::from(is_two);
        rest >>= u32::from(is_two);
    }
    log
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(formula: &str) -> FigureLine {
        FigureLine::parse(&format!("{formula}; a test"), Dimension::Energy).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn figures_by_hand() {
        for (formula, bits, attojoules) in [
            ("0.003125 b pJ", 32, 100_000),
            ("0.003125 b pJ", 8, 25_000),
            // 3.066666667008 + 0.033333333344 pJ
            ("0.002994791667 b^2 + 0.001041666667 b pJ", 32, 3_100_000),
            ("0.002994791667 b^2 + 0.001041666667 b pJ", 8, 200_000),
            // 12.68 (20/32)^2 = 4.953125 pJ
            ("12.68/1024 b^2 pJ", 20, 4_953_125),
            ("0.21/32 b pJ", 20, 131_250),
            // 1/3 aJ rounds down, 1/2 up.
            ("1/3 aJ", 32, 0),
            ("1/2 aJ", 32, 1),
            ("3 b - 8 fJ", 8, 16_000),
        ] {
            assert_eq!(line(formula).at(bits, 1), Some(attojoules), "{formula}");
        }
        // 2^16 bits: 9.02427321e-4 x 4096 - 2.68847858e-2 x 256 + 0.208900804 x 16 = 0.1561902728... pJ a bit, 10 pJ for 64 bits of 8 KiB.
        let memory = line("0.000902427321 L^3 - 0.0268847858 L^2 + 0.208900804 L pJ");
        assert_eq!(memory.at(32, 1 << 16), Some(156_250));
        // log2 3 = 103872.2... / 65536; 103872 / 65536 = 1.5849609375
        assert_eq!(line("1 L nJ").at(32, 3), Some(1_584_960_938));
    }

    #[test]
    fn logarithms_are_those_of_double_precision() {
        for number in (1..3000).chain([1 << 20, (1 << 40) + 12345, u64::MAX >> 1, u64::MAX]) {
            let exact = (number as f64).log2() * 65536.0;
            let off = exact - log2(number) as f64;
            assert!((-1e-6..1.000_001).contains(&off), "{number}: {off}");
        }
        assert_eq!(log2(1 << 18), 18 << LOG_BITS);
    }

    #[test]
    fn lines_that_are_none_say_why() {
        for (text, message) in [
            ("0.1 b pJ", "has no source"),
            ("0.1 b pJ; ", "has no source behind"),
            ("0.1 b um2; me", "`um2` is no unit of this figure: it is one of aJ, fJ, pJ, nJ"),
            ("pJ; me", "there is no figure"),
            ("b pJ; me", "has no coefficient"),
            ("1 + b pJ; me", "`b` has no coefficient"),
            ("0.1 b + pJ; me", "the last sign has no coefficient"),
            ("1 - + 2 pJ; me", "`+` follows another sign"),
            ("-- 2 pJ; me", "`-` follows another sign"),
            ("1 b - 2 L 3 pJ; me", "`3` has no sign"),
            ("1 2 pJ; me", "`2` has no sign"),
            ("1 b^4 pJ; me", "no power of b or L"),
            ("1 x pJ; me", "no power of b or L"),
            ("1e5 pJ; me", "is no coefficient"),
            ("1/0 pJ; me", "is no coefficient"),
            ("0.00000000000000001 pJ; me", "at most 15 digits"),
            ("1 b - 100 pJ; me", "below 0"),
            ("999999999999999 L^3 nJ; me", "too large"),
        ] {
            let error = FigureLine::parse(text, Dimension::Energy).expect_err(text);
            assert!(error.contains(message), "{text}: {error}");
        }
    }
}
