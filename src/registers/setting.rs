//! A register and the value that it is set to, as it is typed: `s1=5`, `v1=0.6:0:0.8:dir`, `origin=1:2:3`. What names and formats mean is
//! known with the program.

use std::str::FromStr;

use asm::real;
use emu::registers::Registers;
use isa::Program;
use isa::naming::RegisterId;
use messages::did_you_mean;

use super::show::format_of;
use crate::arguments::numbered;

/// A register's value, before the program is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegisterSetting {
    /// The register or the program's name for it.
    pub register: String,
    /// The numbers as they were typed: one, or three of a vector.
    numbers: Vec<String>,
    /// The format that was typed.
    format: Option<String>,
}

/// The register of its own name or of a name of the program, at the program's start or wherever it is clear.
///
/// # Errors
/// Another name, with one that is near.
pub fn register_of(program: &Program, name: &str, pc: u32) -> Result<RegisterId, String> {
    if let Some(register) = isa::parse_register(name).or_else(|| program.register_named(name, pc)) {
        return Ok(register);
    }
    let known = program.register_names.iter().map(|named| named.name.as_str());
    let hint = did_you_mean(name, known).unwrap_or_else(|| "there are s0 to s31, v0 to v31 and w0 to w7".into());
    Err(format!("`{name}` is no register: {hint}"))
}

impl FromStr for RegisterSetting {
    type Err = String;

    fn from_str(text: &str) -> Result<RegisterSetting, String> {
        let (name, value) = text.split_once('=').ok_or("a register, `=` and a value are expected, such as s1=5")?;
        let name = name.trim();
        if name == "s0" {
            return Err("s0 is always zero".into());
        }
        let is_name = name.starts_with(|c: char| c.is_alphabetic() || c == '_');
        let is_numbered =
            name.len() > 1 && name.starts_with(['s', 'v', 'w']) && name[1..].bytes().all(|c| c.is_ascii_digit());
        let register = isa::parse_register(name);
        if register.is_none() && (is_numbered || !is_name) {
            return Err(format!("`{name}` is no register: there are s1 to s31, v0 to v31 and w0 to w7"));
        }
        let mut numbers: Vec<String> = value.split(':').map(|part| part.trim().to_owned()).collect();
        // What begins with a letter is a format; its fraction bits may stand there, too, where the number of parts says so.
        let expected = match register {
            Some(('v', _)) => Some(3),
            Some(_) => Some(1),
            None => None,
        };
        let last = numbers.last().map_or("", String::as_str);
        let is_named = last.starts_with(|c: char| c.is_alphabetic() || c == '_');
        let is_format =
            is_named || expected.map_or([2, 4].contains(&numbers.len()), |count| numbers.len() == count + 1);
        let format = if is_format { numbers.pop() } else { None };
        let setting = RegisterSetting { register: name.into(), numbers, format };
        if let Some(expected) = expected {
            setting.check_count(expected)?;
        }
        // Numbers without a format are read at once, so that mistakes show before anything else is looked at.
        if setting.format.is_none()
            && let Some((file, _)) = register
        {
            let wholes = setting.numbers.iter().filter(|number| !is_real(number));
            wholes.map(|number| whole(file, number)).collect::<Result<Vec<_>, _>>()?;
        }
        Ok(setting)
    }
}

/// True of a number with a point or an exponent, which a whole number has not.
pub fn is_real(text: &str) -> bool {
    !text.starts_with("0x")
        && !text.starts_with("-0x")
        && text.contains(['.', 'e', 'E'])
        && real::parse(text, 0).is_ok()
}

/// A raw number for a register of a file.
fn whole(file: char, text: &str) -> Result<i64, String> {
    if file == 'w' {
        return wide(text);
    }
    let value = numbered(text)?;
    match (i64::from(i32::MIN)..=i64::from(u32::MAX)).contains(&value) {
        true => Ok((value as i32).into()),
        false => Err(format!("{value} does not fit 32 bits")),
    }
}

/// A number of 64 bits; in hexadecimal and the other bases without a sign it may use all of them.
fn wide(text: &str) -> Result<i64, String> {
    let plain = text.trim().replace('_', "").to_ascii_lowercase();
    let bits = [("0x", 16), ("0o", 8), ("0b", 2)].into_iter().find_map(|(prefix, radix)| {
        let digits = plain.strip_prefix(prefix).filter(|digits| !digits.starts_with('+'))?;
        u64::from_str_radix(digits, radix).ok()
    });
    bits.map_or_else(|| numbered(text), |bits| Ok(bits as i64))
}

impl RegisterSetting {
    fn check_count(&self, expected: usize) -> Result<(), String> {
        let name = &self.register;
        match (expected, self.numbers.len()) {
            (expected, found) if expected == found => Ok(()),
            (3, _) => Err(format!("`{name}` has three components, such as {name}=1:2:3")),
            _ => Err(format!("`{name}` has one number, such as {name}=5")),
        }
    }

    /// Puts the value where it belongs.
    ///
    /// # Errors
    /// A name or a format that the program does not have, a number that does not fit.
    pub fn set(&self, program: &Program, registers: &mut Registers) -> Result<(), String> {
        self.set_at(program, registers, program.entry)
    }

    /// Puts the value where it belongs, with names and formats as they are before the word at `pc`.
    ///
    /// # Errors
    /// See [`RegisterSetting::set`].
    pub fn set_at(&self, program: &Program, registers: &mut Registers, pc: u32) -> Result<(), String> {
        let register = register_of(program, &self.register, pc)?;
        let (file, number) = register;
        self.check_count(if file == 'v' { 3 } else { 1 })?;
        let bits = match &self.format {
            Some(format) => Some(format_of(program, format)?.1),
            None => None,
        };
        // Read a number: a real one by the fraction bits that are typed or known here (0.5 of 16 is 32,768), another as it stands
        let raw = |text: &String| -> Result<i64, String> {
            let bits = match bits {
                Some(bits) => bits,
                None if is_real(text) => program.format_of(register, pc).map(|(_, bits)| bits).ok_or_else(|| {
                    format!("`{text}` is no whole number: say its format, such as {}={text}:pos", self.register)
                })?,
                None => return whole(file, text),
            };
            let value = real::parse(&text.replace('_', ""), bits)?;
            match file != 'w' && i32::try_from(value).is_err() {
                true => Err(format!("{text} with {bits} fraction bits does not fit 32 bits")),
                false => Ok(value),
            }
        };
        // All numbers are read before one is set, so that a mistake changes nothing.
        let values = self.numbers.iter().map(raw).collect::<Result<Vec<i64>, _>>()?;
        match (file, values.as_slice()) {
            ('v', &[x, y, z]) => registers.set_vector(number, [x as i32, y as i32, z as i32]),
            ('w', &[value]) => registers.set_wide(number, value),
            (_, values) => registers.set_scalar(number, values.first().copied().unwrap_or(0) as i32),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(text: &str) -> Result<Registers, String> {
        let named = isa::naming::NamedRegister { name: "origin".into(), register: ('v', 1), words: 0..1 };
        let held = isa::naming::HeldFormat { register: ('s', 9), format: Some("pos".into()), words: 0..1 };
        let program = Program {
            formats: [("pos".to_owned(), 16), ("dir".to_owned(), 30)].into(),
            register_names: vec![named],
            holds: vec![held],
            ..Program::default()
        };
        let mut registers = Registers::default();
        text.parse::<RegisterSetting>()?.set(&program, &mut registers)?;
        Ok(registers)
    }

    #[test]
    fn registers_take_raw_and_real_numbers() {
        for (text, register, raw) in [
            ("s1=5", ('s', 1), &[5][..]),
            ("s31=0xffffffff", ('s', 31), &[-1]),
            ("v0=-1:0x10:3", ('v', 0), &[-1, 16, 3]),
            ("w7=-9223372036854775808", ('w', 7), &[i64::MIN]),
            ("w0=0xffff_ffff_ffff_fff9", ('w', 0), &[-7]),
            ("w1=0x8000000000000000", ('w', 1), &[i64::MIN]),
            ("w2=-0x10", ('w', 2), &[-16]),
            ("s5=1.5:pos", ('s', 5), &[98_304]),
            ("s5=2:pos", ('s', 5), &[131_072]),
            ("s5=-0.5:4", ('s', 5), &[-8]),
            ("v1=0.5:0:-1:dir", ('v', 1), &[1 << 29, 0, -1 << 30]),
            ("origin=1:2:3", ('v', 1), &[1, 2, 3]),
            ("origin=1:2:0.5:pos", ('v', 1), &[65_536, 131_072, 32_768]),
            ("s9=0.25", ('s', 9), &[16_384]),
        ] {
            let registers = set(text).unwrap();
            assert_eq!(super::super::RegisterContents::of(&registers, register).numbers(), raw, "{text}");
        }
    }

    #[test]
    fn what_cannot_be_is_refused() {
        for (text, message) in [
            ("s1", "such as s1=5"),
            ("s0=1", "always zero"),
            ("s32=1", "no register"),
            ("x=1", "no register"),
            ("orign=1:2:3", "did you mean `origin`?"),
            ("v1=1:2", "three components"),
            ("v1=1:2:3:4:5", "three components"),
            ("s1=4294967296", "does not fit 32 bits"),
            ("s1=-2147483649", "does not fit 32 bits"),
            ("s1=1.5", "say its format, such as s1=1.5:pos"),
            ("s1=1.5:poss", "did you mean `pos`?"),
            ("s1=40000:pos", "does not fit 32 bits"),
            ("s1=x1:pos", "no decimal number"),
            ("s1=1:64", "0 to 63"),
        ] {
            let error = set(text).unwrap_err();
            assert!(error.contains(message), "{text}: {error}");
        }
    }
}
