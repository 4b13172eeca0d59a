//! Memory as text: octets in rows, or a record field by field.

use std::fmt::Write;

use emu::octets::Memory;
use isa::Program;
use isa::naming::FieldMap;
use messages::did_you_mean;

use super::session::Session;
use crate::arguments::numbered;
use crate::result::{hexadecimal, octet_rows};

/// Memory that is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// Global memory.
    Global,
    /// The local buffer.
    Buffer,
}

/// Octets that are shown where nothing else is asked for.
const OCTETS: u32 = 64;

/// Octets that are shown at once at most.
const MOST_OCTETS: u32 = 1 << 16;

/// Octets of a memory from an address on.
///
/// # Errors
/// Octets beyond its end.
pub fn octets(session: &Session, space: Space, address: u32, octets: u32) -> Result<Vec<u8>, String> {
    let found = match space {
        Space::Buffer => session.stepper().state().buffer.slice(address, octets).map(<[u8]>::to_vec),
        Space::Global => session.stepper().memory().slice(address, octets).map(|slice| slice.into_owned()),
    };
    found.map_err(|fault| fault.to_string())
}

/// The address of a text: a number, a label of the buffer, or the contents of a register (`(near_slot)`).
///
/// # Errors
/// Anything else.
pub fn address(session: &Session, text: &str) -> Result<u32, String> {
    let text = text.trim();
    let program = &session.target.program;
    let inner = text.strip_prefix('(').and_then(|text| text.strip_suffix(')'));
    let value = if let Some(register) = inner {
        let register = crate::registers::register_of(program, register, session.pc())?;
        crate::registers::RegisterContents::of(&session.stepper().state().registers, register).numbers()[0]
            & 0xffff_ffff
    } else if text.starts_with(|c: char| c.is_ascii_digit()) {
        numbered(text)?
    } else {
        *program.symbols.get(text).ok_or_else(|| {
            let hint = did_you_mean(text, program.symbols.keys().map(String::as_str));
            format!(
                "`{text}` is no address: {}",
                hint.unwrap_or_else(|| "a number, a label or (register) is expected".into())
            )
        })?
    };
    u32::try_from(value).map_err(|_| format!("{value} is no address"))
}

/// A part of a memory as text: of a structure by its fields, else octets.
///
/// # Errors
/// A structure that there is not, octets beyond the end.
pub fn text(session: &Session, space: Space, start: u32, what: Option<&str>) -> Result<String, String> {
    let program = &session.target.program;
    let count = match what {
        None => {
            let size = match space {
                Space::Buffer => session.target.config.buffer_octets,
                Space::Global => u32::try_from(Memory::size(session.stepper().memory())).unwrap_or(u32::MAX),
            };
            OCTETS.min(size.saturating_sub(start)).max(1)
        }
        Some(text) if text.starts_with(|c: char| c.is_ascii_digit()) => u32::try_from(numbered(text)?)
            .ok()
            .filter(|count| *count <= MOST_OCTETS)
            .ok_or_else(|| format!("at most {MOST_OCTETS} octets are shown"))?,
        Some(name) => return record(session, space, start, program, name),
    };
    Ok(octet_rows(&octets(session, space, start, count)?, start))
}

fn record(session: &Session, space: Space, start: u32, program: &Program, name: &str) -> Result<String, String> {
    let record = program.record(name).ok_or_else(|| {
        let hint = did_you_mean(name, program.records.iter().map(|record| record.name.as_str()));
        format!("the program has no structure `{name}`{}", hint.map_or_else(String::new, |hint| format!(": {hint}")))
    })?;
    let all = octets(session, space, start, record.octets)?;
    let mut text = format!("{name} at {start:#x}, {} octets\n", record.octets);
    for field in &record.fields {
        let own = &all[field.offset as usize..(field.offset + field.octets) as usize];
        let _ = writeln!(text, "  {:<16} +{:<4} {}", field.name, field.offset, value(field, own));
    }
    Ok(text)
}

/// A field's value: a number of 1, 2, 4 or 8 octets, words of anything longer, with hexadecimal digits.
fn value(field: &FieldMap, octets: &[u8]) -> String {
    let word = |octets: &[u8]| i32::from_le_bytes([octets[0], octets[1], octets[2], octets[3]]);
    let number = match field.octets {
        1 => octets[0].to_string(),
        2 => i16::from_le_bytes([octets[0], octets[1]]).to_string(),
        8 => i64::from_le_bytes(std::array::from_fn(|at| octets[at])).to_string(),
        count if count % 4 == 0 => {
            octets.chunks(4).map(|octets| word(octets).to_string()).collect::<Vec<_>>().join(":")
        }
        _ => return hexadecimal(octets),
    };
    let digits: Vec<String> = octets
        .chunks(4)
        .map(|octets| {
            let reversed: Vec<u8> = octets.iter().rev().copied().collect();
            format!("0x{}", hexadecimal(&reversed))
        })
        .collect();
    format!("{number:<36} {}", digits.join(":"))
}
