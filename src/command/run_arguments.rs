//! Values on the command line of `lancer run`: registers, files in memory, dumps.

use std::path::PathBuf;
use std::str::FromStr;

use emu::registers::Registers;

use crate::arguments::numbered;

/// A register and what it holds at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RegisterValue {
    /// A scalar.
    Scalar(u8, i32),
    /// A vector.
    Vector(u8, [i32; 3]),
    /// A wide accumulator.
    Wide(u8, i64),
}

impl RegisterValue {
    /// Puts the value where it belongs.
    pub fn set(self, registers: &mut Registers) {
        match self {
            RegisterValue::Scalar(number, value) => registers.set_scalar(number, value),
            RegisterValue::Vector(number, value) => registers.set_vector(number, value),
            RegisterValue::Wide(number, value) => registers.set_wide(number, value),
        }
    }
}

impl FromStr for RegisterValue {
    type Err = String;

    fn from_str(text: &str) -> Result<RegisterValue, String> {
        let (name, value) = text.split_once('=').ok_or("a register, `=` and a value are expected, such as s1=5")?;
        let name = name.trim();
        match isa::parse_register(name) {
            Some(('s', 0)) => Err("s0 is always zero".into()),
            Some(('s', number)) => Ok(RegisterValue::Scalar(number, word(value)?)),
            Some(('v', number)) => {
                let components: Vec<&str> = value.split(':').collect();
                let &[x, y, z] = components.as_slice() else {
                    return Err(format!("`{name}` has three components, such as {name}=1:2:3"));
                };
                Ok(RegisterValue::Vector(number, [word(x)?, word(y)?, word(z)?]))
            }
            Some((_, number)) => Ok(RegisterValue::Wide(number, wide(value)?)),
            None => Err(format!("`{name}` is no register: there are s1 to s31, v0 to v31 and w0 to w7")),
        }
    }
}

/// A number of 64 bits; in hexadecimal and the other bases without a sign it may use all of them, as `run` prints it.
fn wide(text: &str) -> Result<i64, String> {
    let plain = text.trim().replace('_', "").to_ascii_lowercase();
    let bits = [("0x", 16), ("0o", 8), ("0b", 2)].into_iter().find_map(|(prefix, radix)| {
        let digits = plain.strip_prefix(prefix).filter(|digits| !digits.starts_with('+'))?;
        u64::from_str_radix(digits, radix).ok()
    });
    bits.map_or_else(|| numbered(text), |bits| Ok(bits as i64))
}

/// A word of 32 bits, signed or not.
fn word(text: &str) -> Result<i32, String> {
    let value = numbered(text)?;
    match (i64::from(i32::MIN)..=i64::from(u32::MAX)).contains(&value) {
        true => Ok(value as i32),
        false => Err(format!("{value} does not fit 32 bits")),
    }
}

/// An address, in octets.
fn address(text: &str) -> Result<u32, String> {
    let value = numbered(text)?;
    u32::try_from(value).map_err(|_| format!("{value} is no address: 0 to 2^32 - 1"))
}

/// Octets of global memory.
///
/// # Errors
/// Anything but a whole number of 0 to 2^30.
pub fn memory_size(text: &str) -> Result<u32, String> {
    let value = numbered(text)?;
    let size = u32::try_from(value).ok().filter(|&size| size <= 1 << 30);
    size.ok_or_else(|| format!("{value} is not in 0..={}", 1 << 30))
}

/// `ADDRESS=FILE`.
///
/// # Errors
/// Anything else.
pub fn memory_file(text: &str) -> Result<(u32, PathBuf), String> {
    let (start, path) =
        text.split_once('=').ok_or("an address, `=` and a file are expected, such as 0x100=data.bin")?;
    if path.is_empty() {
        return Err("there is no file after `=`".into());
    }
    Ok((address(start)?, path.into()))
}

/// A part of the state that is shown at the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dump {
    /// All registers.
    Registers,
    /// Octets of global memory.
    Memory(u32, u32),
    /// Octets of the local buffer.
    Buffer(u32, u32),
}

impl FromStr for Dump {
    type Err = String;

    fn from_str(text: &str) -> Result<Dump, String> {
        if text == "regs" {
            return Ok(Dump::Registers);
        }
        let range = |text: &str| {
            let refusal = "`regs`, ADDRESS:OCTETS or buffer:ADDRESS:OCTETS is expected, such as 0x100:64";
            let (start, octets) = text.split_once(':').ok_or(refusal)?;
            Ok::<_, String>((address(start)?, address(octets)?))
        };
        Ok(match text.strip_prefix("buffer:") {
            Some(rest) => range(rest).map(|(start, octets)| Dump::Buffer(start, octets))?,
            None => range(text).map(|(start, octets)| Dump::Memory(start, octets))?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_take_what_they_hold() {
        for (text, value) in [
            ("s1=5", RegisterValue::Scalar(1, 5)),
            ("s31=0xffffffff", RegisterValue::Scalar(31, -1)),
            ("v0=-1:0x10:3", RegisterValue::Vector(0, [-1, 16, 3])),
            ("w7=-9223372036854775808", RegisterValue::Wide(7, i64::MIN)),
            ("w0=0xffff_ffff_ffff_fff9", RegisterValue::Wide(0, -7)),
            ("w1=0x8000000000000000", RegisterValue::Wide(1, i64::MIN)),
            ("w2=-0x10", RegisterValue::Wide(2, -16)),
        ] {
            assert_eq!(text.parse(), Ok(value));
        }
        for (text, message) in [
            ("s1", "such as s1=5"),
            ("s0=1", "always zero"),
            ("s32=1", "no register"),
            ("x=1", "no register"),
            ("v1=1:2", "three components"),
            ("v1=1:2:3:4", "three components"),
            ("s1=4294967296", "does not fit 32 bits"),
            ("s1=-2147483649", "does not fit 32 bits"),
            ("s1=1.5", "no whole number"),
        ] {
            assert!(text.parse::<RegisterValue>().unwrap_err().contains(message), "{text}");
        }
    }

    #[test]
    fn dumps_and_files_have_addresses() {
        assert_eq!("regs".parse(), Ok(Dump::Registers));
        assert_eq!("0x100:64".parse(), Ok(Dump::Memory(256, 64)));
        assert_eq!("buffer:0:4".parse(), Ok(Dump::Buffer(0, 4)));
        assert!(["", "1", "1:", "-1:4", "buffer:", "reg"].iter().all(|text| text.parse::<Dump>().is_err()));
        assert_eq!(memory_file("0x10=a=b"), Ok((16, "a=b".into())));
        assert!(["a", "1=", "-1=a", "4294967296=a"].iter().all(|text| memory_file(text).is_err()));
    }
}
