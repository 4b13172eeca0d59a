//! Registers as people read and write them: raw, in hexadecimal, and as the real number that they hold in a format of the program. What is
//! printed is accepted back.

mod list;
mod setting;
mod show;

use std::collections::BTreeMap;

use asm::real;
use emu::registers::Registers;
use isa::Program;
use isa::naming::{RegisterId, registers};
use schemars::JsonSchema;
use serde::{Serialize, Serializer};

pub use list::RegisterList;
pub use setting::{RegisterSetting, is_real, register_of};
pub use show::{ShowList, ShowRequest, format_of};

/// Registers by name.
#[derive(Clone, Debug, JsonSchema)]
pub struct RegisterValues(#[schemars(with = "BTreeMap<String, RegisterContents>")] pub Vec<(String, RegisterContents)>);

impl Serialize for RegisterValues {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, contents)| (name, contents)))
    }
}

/// Contents of a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum RegisterContents {
    /// A scalar or a wide accumulator.
    One(i64),
    /// A vector.
    Three([i32; 3]),
}

impl RegisterContents {
    /// Contents of a register.
    pub fn of(registers: &Registers, (file, number): RegisterId) -> RegisterContents {
        match file {
            's' => RegisterContents::One(registers.scalar(number).into()),
            'v' => RegisterContents::Three(registers.vector(number)),
            _ => RegisterContents::One(registers.wide(number)),
        }
    }

    /// True where all bits are 0.
    pub fn is_zero(&self) -> bool {
        matches!(self, RegisterContents::One(0) | RegisterContents::Three([0, 0, 0]))
    }

    /// The raw numbers: one, or three.
    pub fn numbers(&self) -> Vec<i64> {
        match self {
            RegisterContents::One(value) => vec![*value],
            RegisterContents::Three(components) => components.map(i64::from).to_vec(),
        }
    }

    /// The raw number of a component; `None` of what is no vector.
    pub fn component(&self, number: usize) -> Option<i64> {
        match self {
            RegisterContents::One(_) => None,
            RegisterContents::Three(components) => components.get(number).map(|&component| component.into()),
        }
    }

    /// The raw numbers as text, with `:` between components.
    pub fn raw_text(&self) -> String {
        joined(self.numbers().into_iter().map(|number| number.to_string()))
    }
}

fn joined(parts: impl Iterator<Item = String>) -> String {
    parts.collect::<Vec<_>>().join(":")
}

/// Real value of a register.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum RealContents {
    /// Of a scalar or a wide accumulator.
    One(f64),
    /// Of a vector, component by component.
    Three([f64; 3]),
}

/// Name of a register, such as `s2`.
pub fn name((file, number): RegisterId) -> String {
    format!("{file}{number}")
}

/// All registers by name.
pub fn all(registers: &Registers) -> impl Iterator<Item = (RegisterId, RegisterContents)> + '_ {
    self::registers().map(|register| (register, RegisterContents::of(registers, register)))
}

/// A register with all that is known of what it holds.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ShownRegister {
    /// The register, such as `s2`.
    pub register: String,
    /// Name that the program gives it there (`.reg`); `None` where it gives none.
    pub name: Option<String>,
    /// Raw number or numbers.
    pub raw: RegisterContents,
    /// Bits in hexadecimal, with `:` between components.
    pub hexadecimal: String,
    /// Name of the number's format, or its fraction bits; `None` where no format is known.
    pub format: Option<String>,
    /// Fraction bits of the format; fewer than 0 where a unit of the raw number is more than one.
    pub fraction_bits: Option<i32>,
    /// Real value in the format: the shortest decimal that is nearest to the raw number and no other.
    pub real: Option<RealContents>,
}

impl ShownRegister {
    /// A register's contents in a format.
    pub fn new(
        register: RegisterId,
        raw: RegisterContents,
        name: Option<&str>,
        format: Option<(&str, i32)>,
    ) -> ShownRegister {
        let is_wide = register.0 == 'w';
        let digits = |number: i64| if is_wide { format!("{number:#018x}") } else { format!("{:#010x}", number as i32) };
        let hexadecimal = joined(raw.numbers().into_iter().map(digits));
        let real = format.map(|(_, bits)| {
            let real = |number: i64| real::text(number, bits).parse().unwrap_or(f64::NAN);
            match raw {
                RegisterContents::One(number) => RealContents::One(real(number)),
                RegisterContents::Three(components) => {
                    RealContents::Three(components.map(|number| real(number.into())))
                }
            }
        });
        ShownRegister {
            register: self::name(register),
            name: name.map(str::to_owned),
            raw,
            hexadecimal,
            format: format.map(|(name, _)| name.to_owned()),
            fraction_bits: format.map(|(_, bits)| bits),
            real,
        }
    }

    /// A register as the program knows it before the word at `pc`.
    pub fn at(program: &Program, registers: &Registers, register: RegisterId, pc: u32) -> ShownRegister {
        let raw = RegisterContents::of(registers, register);
        ShownRegister::new(register, raw, program.name_of(register, pc), program.format_of(register, pc))
    }

    /// The real value with its format, as `--reg` takes it: `0.6:0:0.8:dir`. Empty where no format is known.
    pub fn real_text(&self) -> String {
        let (Some(format), Some(bits)) = (&self.format, self.fraction_bits) else { return String::new() };
        let numbers = self.raw.numbers().into_iter().map(|number| real::text(number, bits));
        format!("{}:{format}", joined(numbers))
    }

    /// The register in a line: `s2=329314 (5.02493:pos)`.
    pub fn short(&self) -> String {
        let real = match self.real_text() {
            real if real.is_empty() => real,
            real => format!(" ({real})"),
        };
        let name = self.name.as_ref().map_or(String::new(), |name| format!("[{name}]"));
        format!("{}{name}={}{real}", self.register, self.raw.raw_text())
    }
}

/// Rows of a table of registers: names and real values have columns only where there are any.
pub fn rows(shown: &[ShownRegister]) -> Vec<Vec<String>> {
    let has_names = shown.iter().any(|register| register.name.is_some());
    let has_reals = shown.iter().any(|register| register.format.is_some());
    let row = |register: &str, name: &str, raw: String, digits: &str, real: String| {
        let mut cells = vec![register.to_owned()];
        cells.extend(has_names.then(|| name.to_owned()));
        cells.extend([raw, digits.to_owned()]);
        cells.extend(has_reals.then_some(real));
        cells
    };
    let mut rows = vec![row("register", "name", "value".into(), "hexadecimal", "real".into())];
    rows.extend(shown.iter().map(|shown| {
        let name = shown.name.as_deref().unwrap_or_default();
        row(&shown.register, name, shown.raw.raw_text(), &shown.hexadecimal, shown.real_text())
    }));
    rows
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use testing::check;

    use super::*;

    #[test]
    fn a_register_is_shown_raw_in_hexadecimal_and_real() {
        let shown = ShownRegister::new(('s', 2), RegisterContents::One(329_314), Some("edge"), Some(("pos", 16)));
        assert_eq!((shown.hexadecimal.as_str(), shown.real_text().as_str()), ("0x00050662", "5.02493:pos"));
        assert_eq!(
            (shown.real, shown.short().as_str()),
            (Some(RealContents::One(5.02493)), "s2[edge]=329314 (5.02493:pos)")
        );
        let vector = RegisterContents::Three([-1, 0, 1 << 30]);
        let shown = ShownRegister::new(('v', 1), vector, None, Some(("30", 30)));
        assert_eq!(shown.hexadecimal, "0xffffffff:0x00000000:0x40000000");
        assert_eq!(shown.real_text(), "-0.000000001:0:1:30");
        let shown = ShownRegister::new(('w', 1), RegisterContents::One(-7), None, None);
        assert_eq!((shown.hexadecimal.as_str(), shown.real_text().as_str()), ("0xfffffffffffffff9", ""));
    }

    #[test]
    fn everything_that_is_printed_is_accepted_back() {
        let program = Program { formats: [("pos".to_owned(), 16)].into(), ..Program::default() };
        let registers = (0usize..72).prop_map(|at| registers().nth(at).unwrap());
        let bits = (0i32..64).prop_map(|bits| Some((bits.to_string(), bits)));
        let formats = prop_oneof![Just(None), Just(Some(("pos".to_owned(), 16))), bits];
        check(2000, &(registers, any::<[i64; 3]>(), formats), |(register, numbers, format)| {
            let small = numbers.map(|number| number as i32);
            let contents = match register {
                ('s', 0) => return Ok(()),
                ('s', _) => RegisterContents::One(small[0].into()),
                ('v', _) => RegisterContents::Three(small),
                _ => RegisterContents::One(numbers[0]),
            };
            let format = format.as_ref().map(|(name, bits)| (name.as_str(), *bits));
            let shown = ShownRegister::new(register, contents, None, format);
            let mut texts = vec![contents.raw_text(), shown.hexadecimal.clone()];
            texts.extend(Some(shown.real_text()).filter(|text| !text.is_empty()));
            for text in texts {
                let mut registers = Registers::default();
                let list: RegisterList = format!("{}={text}", shown.register).parse().map_err(TestCaseError::fail)?;
                for setting in &list.0 {
                    setting.set(&program, &mut registers).map_err(TestCaseError::fail)?;
                }
                prop_assert_eq!(RegisterContents::of(&registers, register), contents, "{}", text);
            }
            Ok(())
        });
    }
}
