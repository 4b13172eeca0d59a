//! Values on the command line of `lancer run`: files in memory, dumps.

use std::path::PathBuf;
use std::str::FromStr;

use messages::Diagnostic;

use crate::arguments::numbered;
use crate::failure::Failure;
use crate::files;

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

/// Global memory at the start: files at their addresses, zeros elsewhere.
///
/// # Errors
/// A file that cannot be read, or that reaches beyond 1 GiB.
pub fn memory(files: &[(u32, PathBuf)], size: u32) -> Result<Vec<u8>, Failure> {
    let mut memory = vec![0; size as usize];
    for (address, path) in files {
        let octets = files::read(path)?;
        let start = *address as usize;
        let end = start + octets.len();
        if end > 1 << 30 {
            let message = format!("{} at {address:#x} reaches beyond a memory of 1 GiB", path.display());
            return Err(Diagnostic::error(message).into());
        }
        memory.resize(memory.len().max(end), 0);
        memory[start..end].copy_from_slice(&octets);
    }
    Ok(memory)
}

/// A part of the state that is shown at the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dump {
    /// Registers that are not zero, or all.
    Registers {
        /// Registers that are zero are shown as well.
        has_zeros: bool,
    },
    /// Octets of global memory.
    Memory(u32, u32),
    /// Octets of the local buffer.
    Buffer(u32, u32),
}

impl FromStr for Dump {
    type Err = String;

    fn from_str(text: &str) -> Result<Dump, String> {
        if text == "regs" || text == "regs:all" {
            return Ok(Dump::Registers { has_zeros: text != "regs" });
        }
        let range = |text: &str| {
            let refusal = "`regs`, `regs:all`, ADDRESS:OCTETS or buffer:ADDRESS:OCTETS is expected, such as 0x100:64";
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
    fn dumps_and_files_have_addresses() {
        assert_eq!("regs".parse(), Ok(Dump::Registers { has_zeros: false }));
        assert_eq!("regs:all".parse(), Ok(Dump::Registers { has_zeros: true }));
        assert_eq!("1,024:100_000".parse(), Ok(Dump::Memory(1024, 100_000)));
        assert_eq!("0x100:64".parse(), Ok(Dump::Memory(256, 64)));
        assert_eq!("buffer:0:4".parse(), Ok(Dump::Buffer(0, 4)));
        assert!(["", "1", "1:", "-1:4", "buffer:", "reg"].iter().all(|text| text.parse::<Dump>().is_err()));
        assert_eq!(memory_file("0x10=a=b"), Ok((16, "a=b".into())));
        assert!(["a", "1=", "-1=a", "4294967296=a"].iter().all(|text| memory_file(text).is_err()));
    }
}
