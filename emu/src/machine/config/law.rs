//! Laws of clocks and units: numbers that depend on the bits of a word, class by class.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::{Index, IndexMut};
use std::str::FromStr;

use isa::{Class, Counts};
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::MOST_CLOCKS;
use crate::code::timing::Timing;

/// Growth of a law with the bits of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Growth {
    /// With the bits themselves: an adder that takes a bit a clock, or the report's multiplication in a masked step a bit.
    Linear,
    /// With their square: a multiplier whose steps themselves take a bit a clock.
    Square,
    /// With their binary logarithm, rounded up to a whole number: levels of a tree.
    Log,
    /// Against them: operations that fit into as many bits at once, rounded down.
    Inverse,
}

impl Growth {
    /// Every growth.
    pub const ALL: [Growth; 4] = [Growth::Linear, Growth::Square, Growth::Log, Growth::Inverse];

    /// Name in machine files.
    pub const fn name(self) -> &'static str {
        match self {
            Growth::Linear => "linear",
            Growth::Square => "square",
            Growth::Log => "log",
            Growth::Inverse => "inverse",
        }
    }
}

/// Clocks of an operation or number of units, as a number or by the bits of a word.
///
/// In a file it is a number, or a text: `linear`, `log 2`, `linear 1/4 + 3`, `inverse 96`, `constant 7`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// Number for every word.
    Constant(u64),
    /// By the bits of a word.
    Grown {
        /// Growth with the bits.
        growth: Growth,
        /// Factor, 1 to 10^6.
        times: u32,
        /// Divisor, 1 to 10^6; what is left over counts as a whole, but for the inverse.
        by: u32,
        /// Summand, 0 to 10^6.
        plus: u32,
    },
}

impl Law {
    /// The growth alone, without factor and summand.
    pub const fn of(growth: Growth) -> Law {
        Law::Grown { growth, times: 1, by: 1, plus: 0 }
    }

    /// The growth with a factor.
    pub const fn times(growth: Growth, times: u32) -> Law {
        Law::Grown { growth, times, by: 1, plus: 0 }
    }

    /// The number for words of so many bits, 1 to 64.
    pub fn at(self, word: u32) -> u64 {
        match self {
            Law::Constant(number) => number,
            Law::Grown { growth, times, by, plus } => {
                let (bits, times, by) = (u64::from(word), u64::from(times), u64::from(by));
                let grown = match growth {
                    Growth::Linear => (times * bits).div_ceil(by),
                    Growth::Square => (times * bits * bits).div_ceil(by),
                    Growth::Log => (times * u64::from(word.next_power_of_two().trailing_zeros())).div_ceil(by),
                    Growth::Inverse => times / (by * bits),
                };
                grown + u64::from(plus)
            }
        }
    }

    /// The number depends on the word.
    pub fn is_grown(self) -> bool {
        matches!(self, Law::Grown { .. })
    }
}

impl From<u64> for Law {
    fn from(number: u64) -> Law {
        Law::Constant(number)
    }
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Law::Constant(number) => write!(f, "{number}"),
            Law::Grown { growth, times, by, plus } => {
                f.write_str(growth.name())?;
                match (times, by) {
                    (1, 1) => {}
                    (times, 1) => write!(f, " {times}")?,
                    (times, by) => write!(f, " {times}/{by}")?,
                }
                if plus == 0 { Ok(()) } else { write!(f, " + {plus}") }
            }
        }
    }
}

impl FromStr for Law {
    type Err = String;

    fn from_str(text: &str) -> Result<Law, String> {
        let text = text.trim();
        if let Ok(number) = text.parse() {
            return Ok(Law::Constant(number));
        }
        // Split off the name: `linear 1/4 + 3` is `linear` and `1/4 + 3`, and so is `linear1/4+3`
        let end = text.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(text.len());
        let (name, rest) = (&text[..end], text[end..].trim());
        if name == "constant" {
            let number =
                rest.parse().map_err(|_| format!("`{text}` needs a number after `constant`, such as `constant 3`"))?;
            return Ok(Law::Constant(number));
        }
        let Some(growth) = Growth::ALL.into_iter().find(|growth| growth.name() == name) else {
            let names = Growth::ALL.map(|growth| format!("`{}`", growth.name())).join(", ");
            return Err(format!("unknown law `{name}`, expected a number, `constant` or one of {names}"));
        };
        // Split the rest into factor, divisor and summand: 1, 4 and 3
        let (factor, plus) = match rest.split_once('+') {
            None => (rest, "0"),
            Some((factor, plus)) => (factor.trim(), plus.trim()),
        };
        let (times, by) = factor.split_once('/').map_or((factor, "1"), |(times, by)| (times.trim(), by.trim()));
        // Without a factor it is 1, as in `log + 2`; but `linear /4` would be a divisor without one, which is refused below.
        let times = if factor.is_empty() { "1" } else { times };
        let number = |part: &str, least: u32| {
            let most = MOST_CLOCKS as u32;
            let is_plain = part.bytes().all(|octet| octet.is_ascii_digit());
            let number = part.parse().ok().filter(|number| is_plain && (least..=most).contains(number));
            number.ok_or_else(|| {
                format!(
                    "`{part}` in the law `{text}` is no whole number from {least} to {most}; a law is a name, a factor and a summand, such as `{name} 1/4 + 3`"
                )
            })
        };
        Ok(Law::Grown { growth, times: number(times, 1)?, by: number(by, 1)?, plus: number(plus, 0)? })
    }
}

impl Serialize for Law {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Law::Constant(number) => serializer.serialize_u64(*number),
            law => serializer.collect_str(law),
        }
    }
}

impl<'de> Deserialize<'de> for Law {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Law, D::Error> {
        struct LawVisitor;
        impl Visitor<'_> for LawVisitor {
            type Value = Law;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a whole number from 0 or a law such as \"linear\"")
            }

            fn visit_u64<E: Error>(self, number: u64) -> Result<Law, E> {
                Ok(Law::Constant(number))
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<Law, E> {
                let refused = |_| E::invalid_type(serde::de::Unexpected::Signed(number), &self);
                number.try_into().map(Law::Constant).map_err(refused)
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Law, E> {
                text.parse().map_err(E::custom)
            }
        }
        deserializer.deserialize_any(LawVisitor)
    }
}

/// A law for each class of operations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClassLaws([Law; Class::ALL.len()]);

impl ClassLaws {
    /// Numbers for every word.
    pub fn constant(counts: Counts) -> ClassLaws {
        ClassLaws(counts.0.map(Law::Constant))
    }

    /// The numbers for words of so many bits.
    pub fn at(&self, word: u32) -> Counts {
        Counts(self.0.map(|law| law.at(word)))
    }

    /// Some number depends on the word.
    pub fn is_grown(&self) -> bool {
        self.0.iter().any(|law| law.is_grown())
    }

    /// The laws with their classes, in order.
    pub fn iter(&self) -> impl Iterator<Item = (Class, Law)> + '_ {
        Class::ALL.iter().map(|&class| (class, self[class]))
    }
}

impl Index<Class> for ClassLaws {
    type Output = Law;
    fn index(&self, class: Class) -> &Law {
        &self.0[class as usize]
    }
}

impl IndexMut<Class> for ClassLaws {
    fn index_mut(&mut self, class: Class) -> &mut Law {
        &mut self.0[class as usize]
    }
}

/// Name of a class as a key, so that a message about an unknown one has the key's place.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct ClassKey(Class);

impl<'de> Deserialize<'de> for ClassKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<ClassKey, D::Error> {
        let name = String::deserialize(deserializer)?;
        let names = || Class::ALL.iter().map(|class| format!("`{}`", class.name())).collect::<Vec<_>>();
        let unknown = || D::Error::custom(format!("unknown class `{name}`, expected one of {}", names().join(", ")));
        Class::from_name(&name).map(ClassKey).ok_or_else(unknown)
    }
}

/// One law a class, written as a table; classes that it leaves out have the default.
macro_rules! class_table {
    ($(#[doc = $doc:literal])* $type:ident $field:ident) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
        #[serde(from = "BTreeMap<ClassKey, Law>", into = "BTreeMap<String, Law>")]
        pub struct $type(pub ClassLaws);

        impl Default for $type {
            fn default() -> $type {
                $type(ClassLaws::constant(Timing::default().$field))
            }
        }

        impl From<BTreeMap<ClassKey, Law>> for $type {
            fn from(table: BTreeMap<ClassKey, Law>) -> $type {
                let mut laws = $type::default();
                for (ClassKey(class), law) in table {
                    laws.0[class] = law;
                }
                laws
            }
        }

        impl From<$type> for BTreeMap<String, Law> {
            fn from(table: $type) -> BTreeMap<String, Law> {
                table.0.iter().map(|(class, law)| (class.name().to_owned(), law)).collect()
            }
        }
    };
}

class_table! {
    /// Clocks of an operation of each class.
    ClassClocks clocks
}

class_table! {
    /// Operations of each class that run at once; at least one.
    ClassUnits units
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laws_by_hand() {
        for (text, at_8, at_20, at_32) in [
            ("7", 7, 7, 7),
            ("constant 7", 7, 7, 7),
            ("linear", 8, 20, 32),
            ("linear 2 + 3", 19, 43, 67),
            // 8/3, 20/3 and 32/3, rounded up.
            ("linear 1/3", 3, 7, 11),
            ("square", 64, 400, 1024),
            // 2^3 = 8, 2^5 > 20, 2^5 = 32.
            ("log", 3, 5, 5),
            ("log 3 + 1", 10, 16, 16),
            // Twelve numbers of 8 bits, four of 20 and three of 32 fit into 96 bits.
            ("inverse 96", 12, 4, 3),
        ] {
            let law: Law = text.parse().expect(text);
            assert_eq!([8, 20, 32].map(|word| law.at(word)), [at_8, at_20, at_32], "{text}");
            assert_eq!(law.to_string().parse::<Law>(), Ok(law), "{text} reads back as itself");
        }
    }

    #[test]
    fn texts_that_are_no_laws_say_what_is_one() {
        for (text, message) in [
            ("", "unknown law ``, expected a number"),
            ("liner", "unknown law `liner`, expected a number, `constant` or one of `linear`"),
            ("linear x", "`x` in the law `linear x` is no whole number"),
            ("linear 0", "`0` in the law"),
            ("linear 1/0", "`0` in the law"),
            ("linear /4", "`` in the law"),
            ("linear /1", "`` in the law"),
            ("linear 1 ++3", "`+3` in the law"),
            ("log + -1", "`-1` in the law"),
            ("log 2000000", "from 1 to 1000000"),
            ("constant", "needs a number after `constant`"),
            ("-1", "unknown law"),
        ] {
            let error = text.parse::<Law>().expect_err(text);
            assert!(error.contains(message), "{text}: {error}");
        }
    }
}
