//! The object file: a program with its line table, regions and sources in one file, versioned and checksummed.
//!
//! All numbers are little-endian. A *text* is its length in octets (u32) and UTF-8.
//!
//! | part | contents |
//! |---|---|
//! | head | magic `lancer\x1a\n`, version (u16), two octets of 0 |
//! | code | entry (u32), number of words (u32), words |
//! | buffer | octets (u32), contents |
//! | symbols | number (u32), each a text and a value (i64), in the order of the texts |
//! | sources | number (u32), each a name and its contents, both texts |
//! | lines | for each word a source (u16) and a line from 1 (u32) |
//! | regions | number (u32), each a text, 1 for a function or 0 (u8), and the region around it (u16) |
//! | places | for each word its innermost region (u16) |
//! | formats | number (u32), each a text and its fraction bits (u8), in the order of the texts |
//! | names | number (u32), each a text, a register's file (u8, ASCII) and number (u8), first word and word behind (u32 each) |
//! | holds | number (u32), each a register, a text (empty for no format), first word and word behind |
//! | records | number (u32), each a text, octets (u32), and its fields: number (u32), each a text, offset and octets (u32 each) |
//! | calls | number of words (u32), for each the line outside of macros that it came from: a source (u16) and a line from 1 (u32) |
//! | computed | number (u32), each an instruction's word, first word and word behind (u32 each), a source (u16) and a line (u32) |
//! | check | CRC-32 (IEEE) of all octets before |
//!
//! No region is 65535. Version 1 ends behind the places; such files are read as programs of which nothing is known of formats, names and
//! structures. Version 2 ends behind the records; there nothing is known of macro calls.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use isa::Program;
use isa::naming::{ComputedInstruction, FieldMap, HeldFormat, NamedRegister, RecordMap, RegisterId};
use isa::program::{Line, Region};
use messages::Source;
use nom::bytes::complete::take;
use nom::multi::length_data;
use nom::number::complete::{le_i64, le_u8, le_u16, le_u32};
use nom::{IResult, Parser};

use crate::limits::{BUFFER, FRACTION_BITS, REGIONS, SOURCES, WORDS};

/// The first octets of every object file.
pub const MAGIC: &[u8; 8] = b"lancer\x1a\n";

/// The version that is written; all from 1 on are read.
pub const VERSION: u16 = 3;

const NONE: u16 = u16::MAX;

/// The reason for which octets are no object file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ObjectError {
    /// The first octets are others.
    Magic,
    /// Written in another version of the format.
    Version(u16),
    /// The file ends in the middle.
    Truncated,
    /// The checksum is another: the file was damaged.
    Checksum,
    /// The parts contradict each other.
    Contents(&'static str),
}

impl fmt::Display for ObjectError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ObjectError::Magic => write!(f, "this is not an object file of lancer"),
            ObjectError::Version(version) => {
                write!(f, "the object file has version {version} of the format, but only 1 to {VERSION} are known here")
            }
            ObjectError::Truncated => write!(f, "the object file ends in the middle"),
            ObjectError::Checksum => write!(f, "the object file is damaged: its checksum does not hold"),
            ObjectError::Contents(what) => write!(f, "the object file contradicts itself: {what}"),
        }
    }
}

impl std::error::Error for ObjectError {}

/// The object file of a program.
///
/// # Panics
/// When a table of the program does not go with its words, which no assembled program does.
pub fn write(program: &Program) -> Vec<u8> {
    assert_eq!(program.lines.len(), program.words.len(), "a line for each word");
    assert_eq!(program.region_of.len(), program.words.len(), "a region for each word");
    let mut file = Vec::with_capacity(program.words.len() * 12 + program.buffer.len() + 256);
    let count = |file: &mut Vec<u8>, length: usize| {
        let length = u32::try_from(length).expect("the limits of the assembler are far below");
        file.extend(length.to_le_bytes());
    };
    let text = |file: &mut Vec<u8>, text: &str| {
        count(file, text.len());
        file.extend(text.as_bytes());
    };
    // Write the head: 8 octets that say what the file is, then the entry.
    file.extend(MAGIC);
    file.extend(VERSION.to_le_bytes());
    file.extend([0, 0]);
    file.extend(program.entry.to_le_bytes());
    // Write what runs.
    count(&mut file, program.words.len());
    program.words.iter().for_each(|word| file.extend(word.to_le_bytes()));
    count(&mut file, program.buffer.len());
    file.extend(&program.buffer);
    // Write what ties it to the source: names in order, sources with their text, a line a word, regions.
    count(&mut file, program.symbols.len());
    for (name, value) in &program.symbols {
        text(&mut file, name);
        file.extend(value.to_le_bytes());
    }
    count(&mut file, program.sources.len());
    for source in &program.sources {
        text(&mut file, &source.name);
        text(&mut file, &source.text);
    }
    for line in &program.lines {
        file.extend(line.source.to_le_bytes());
        file.extend(line.line.to_le_bytes());
    }
    count(&mut file, program.regions.len());
    for region in &program.regions {
        text(&mut file, &region.name);
        file.push(region.is_function.into());
        file.extend(region.parent.unwrap_or(NONE).to_le_bytes());
    }
    program.region_of.iter().for_each(|region| file.extend(region.unwrap_or(NONE).to_le_bytes()));
    // Write what readers are told of registers and records.
    count(&mut file, program.formats.len());
    for (name, bits) in &program.formats {
        text(&mut file, name);
        file.push(u8::try_from(*bits).expect("formats have at most 63 bits"));
    }
    let register = |file: &mut Vec<u8>, (letter, number): RegisterId| file.extend([letter as u8, number]);
    let words = |file: &mut Vec<u8>, words: &Range<u32>| {
        file.extend(words.start.to_le_bytes());
        file.extend(words.end.to_le_bytes());
    };
    count(&mut file, program.register_names.len());
    for named in &program.register_names {
        text(&mut file, &named.name);
        register(&mut file, named.register);
        words(&mut file, &named.words);
    }
    count(&mut file, program.holds.len());
    for held in &program.holds {
        register(&mut file, held.register);
        text(&mut file, held.format.as_deref().unwrap_or(""));
        words(&mut file, &held.words);
    }
    count(&mut file, program.records.len());
    for record in &program.records {
        text(&mut file, &record.name);
        file.extend(record.octets.to_le_bytes());
        count(&mut file, record.fields.len());
        for field in &record.fields {
            text(&mut file, &field.name);
            file.extend(field.offset.to_le_bytes());
            file.extend(field.octets.to_le_bytes());
        }
    }
    // Write where words come from and what functions compute.
    let line = |file: &mut Vec<u8>, line: &Line| {
        file.extend(line.source.to_le_bytes());
        file.extend(line.line.to_le_bytes());
    };
    count(&mut file, program.call_lines.len());
    program.call_lines.iter().for_each(|call| line(&mut file, call));
    count(&mut file, program.computed.len());
    for computed in &program.computed {
        file.extend(computed.word.to_le_bytes());
        words(&mut file, &computed.words);
        line(&mut file, &computed.line);
    }
    // The checksum covers everything before it.
    file.extend(crc32fast::hash(&file).to_le_bytes());
    file
}

/// Reads an object file.
///
/// # Errors
/// Any octets that [`write()`] does not make; nothing large is allocated for them.
pub fn read(file: &[u8]) -> Result<Program, ObjectError> {
    let Some((magic, rest)) = file.split_at_checked(MAGIC.len()) else { return Err(ObjectError::Magic) };
    if magic != MAGIC {
        return Err(ObjectError::Magic);
    }
    let (_, version) = le_u16::<_, nom::error::Error<&[u8]>>(rest).map_err(|_| ObjectError::Truncated)?;
    if !(1..=VERSION).contains(&version) {
        return Err(ObjectError::Version(version));
    }
    // The last four octets are the checksum of what stands before them.
    let body_end = file.len().checked_sub(4).filter(|&end| end >= MAGIC.len() + 4).ok_or(ObjectError::Truncated)?;
    let (body, check) = file.split_at(body_end);
    let (rest, program) =
        parts(&body[MAGIC.len() + 2..], version).map_err(|_| damaged_or(body, check, ObjectError::Truncated))?;
    if crc32fast::hash(body).to_le_bytes() != check {
        return Err(ObjectError::Checksum);
    }
    if !rest.is_empty() {
        return Err(ObjectError::Contents("there is more behind its end"));
    }
    let program = program.map_err(ObjectError::Contents)?;
    consistent(&program).map_err(ObjectError::Contents)?;
    Ok(program)
}

/// A file that cannot be read through: cut off, unless its checksum holds.
fn damaged_or(body: &[u8], check: &[u8], error: ObjectError) -> ObjectError {
    if crc32fast::hash(body).to_le_bytes() == check {
        ObjectError::Contents("a length goes beyond the end")
    } else {
        error
    }
}

type ObjectPiece<'a, T> = IResult<&'a [u8], T>;

fn text(input: &[u8]) -> ObjectPiece<'_, Result<String, &'static str>> {
    let (rest, octets) = length_data(le_u32).parse(input)?;
    Ok((rest, String::from_utf8(octets.to_vec()).map_err(|_| "a text is not UTF-8")))
}

/// A list of `count` items; memory grows with the file, not with the count.
fn list<'a, T>(
    mut input: &'a [u8],
    count: usize,
    item: impl Fn(&'a [u8]) -> ObjectPiece<'a, T>,
) -> ObjectPiece<'a, Vec<T>> {
    let mut items = Vec::with_capacity(count.min(input.len()));
    for _ in 0..count {
        let (rest, found) = item(input)?;
        items.push(found);
        input = rest;
    }
    Ok((input, items))
}

fn parts(input: &[u8], version: u16) -> ObjectPiece<'_, Result<Program, &'static str>> {
    let (input, (reserved, entry, word_count)) = (le_u16, le_u32, le_u32).parse(input)?;
    // Sizes come from the file, so octets are taken before anything is allocated for them.
    let count = word_count as usize;
    let (input, octets) = take(4 * u64::from(word_count) as usize)(input)?;
    let words = octets.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect();
    let (input, buffer) = length_data(le_u32).parse(input)?;
    let (input, symbol_count) = le_u32(input)?;
    let (input, symbols) = list(input, symbol_count as usize, |input| (text, le_i64).parse(input))?;
    let (input, source_count) = le_u32(input)?;
    let (input, sources) = list(input, source_count as usize, |input| (text, text).parse(input))?;
    let (input, lines) = list(input, count, |input| (le_u16, le_u32).parse(input))?;
    let (input, region_count) = le_u32(input)?;
    let (input, regions) = list(input, region_count as usize, |input| (text, le_u8, le_u16).parse(input))?;
    let (input, places) = list(input, count, le_u16)?;
    let (input, naming) = if version == 1 { (input, Ok(Program::default())) } else { naming(input)? };
    let (input, (call_lines, computed)) = if version < 3 { (input, Default::default()) } else { origins(input)? };
    let region = |number: u16| (number != NONE).then_some(number);
    // The shape was right; contents may still be wrong, which is another error.
    let build = || {
        if reserved != 0 {
            return Err("reserved octets are not 0");
        }
        let mut names = BTreeMap::new();
        for (name, value) in symbols {
            let name = name?;
            if names.last_key_value().is_some_and(|(last, _)| *last >= name) {
                return Err("symbols are out of order");
            }
            names.insert(name, value);
        }
        let sources =
            sources.into_iter().map(|(name, text)| Ok::<_, &str>(Arc::new(Source { name: name?, text: text? })));
        let regions = regions.into_iter().map(|(name, kind, parent)| match kind {
            0 | 1 => Ok(Region { name: name?, is_function: kind == 1, parent: region(parent) }),
            _ => Err("a region is of no known kind"),
        });
        Ok(Program {
            words,
            buffer: buffer.to_vec(),
            entry,
            symbols: names,
            sources: sources.collect::<Result<_, _>>()?,
            lines: lines.into_iter().map(|(source, line)| Line { source, line }).collect(),
            regions: regions.collect::<Result<_, _>>()?,
            region_of: places.into_iter().map(region).collect(),
            call_lines,
            computed,
            ..naming?
        })
    };
    Ok((input, build()))
}

/// Parts that version 2 has behind the places, as a program that has nothing else.
fn naming(input: &[u8]) -> ObjectPiece<'_, Result<Program, &'static str>> {
    // Take all parts before looking into them: a file that is cut off has another message than one that contradicts itself.
    let many = |input| le_u32(input).map(|(rest, number): (_, u32)| (rest, number as usize));
    let (input, number) = many(input)?;
    let (input, formats) = list(input, number, |input| (text, le_u8).parse(input))?;
    let (input, number) = many(input)?;
    // A name `eye` of s5 for words 2 to 7 is, octet by octet, 3 0 0 0 `e` `y` `e`, `s` 5, 2 0 0 0, 8 0 0 0.
    let (input, names) = list(input, number, |input| (text, le_u8, le_u8, le_u32, le_u32).parse(input))?;
    let (input, number) = many(input)?;
    let (input, holds) = list(input, number, |input| (le_u8, le_u8, text, le_u32, le_u32).parse(input))?;
    let (input, number) = many(input)?;
    let (input, records) = list(input, number, |input| {
        let (input, (name, octets)) = (text, le_u32).parse(input)?;
        let (input, number) = many(input)?;
        let (input, fields) = list(input, number, |input| (text, le_u32, le_u32).parse(input))?;
        Ok((input, (name, octets, fields)))
    })?;
    let register = |file: u8, number: u8| {
        let name = format!("{}{number}", char::from(file));
        isa::parse_register(&name).ok_or("a register does not exist")
    };
    // Check what the parts say, and put them into a program
    let build = || {
        let mut program = Program::default();
        for (name, bits) in formats {
            let name = name?;
            if i64::from(bits) > FRACTION_BITS {
                return Err("a format has too many fraction bits");
            }
            // Names in order come once each, and one program has one file.
            if program.formats.last_key_value().is_some_and(|(last, _)| *last >= name) {
                return Err("formats are out of order");
            }
            program.formats.insert(name, bits.into());
        }
        for (name, file, number, start, end) in names {
            program.register_names.push(NamedRegister {
                name: name?,
                register: register(file, number)?,
                words: start..end,
            });
        }
        for (file, number, format, start, end) in holds {
            let format = Some(format?).filter(|format| !format.is_empty());
            program.holds.push(HeldFormat { register: register(file, number)?, format, words: start..end });
        }
        for (name, octets, fields) in records {
            let field = |(name, offset, octets): (Result<String, &'static str>, u32, u32)| {
                Ok(FieldMap { name: name?, offset, octets })
            };
            let fields = fields.into_iter().map(field).collect::<Result<_, &'static str>>()?;
            program.records.push(RecordMap { name: name?, octets, fields });
        }
        Ok(program)
    };
    Ok((input, build()))
}

/// Parts that version 3 has behind the records.
fn origins(input: &[u8]) -> ObjectPiece<'_, (Vec<Line>, Vec<ComputedInstruction>)> {
    let line = |(source, line): (u16, u32)| Line { source, line };
    let (input, number) = le_u32(input)?;
    let (input, calls) = list(input, number as usize, |input| (le_u16, le_u32).parse(input))?;
    let (input, number) = le_u32(input)?;
    let (input, computed) =
        list(input, number as usize, |input| (le_u32, le_u32, le_u32, le_u16, le_u32).parse(input))?;
    let computed = computed.into_iter().map(|(word, start, end, source, number)| ComputedInstruction {
        word,
        words: start..end,
        line: line((source, number)),
    });
    Ok((input, (calls.into_iter().map(line).collect(), computed.collect())))
}

fn consistent(program: &Program) -> Result<(), &'static str> {
    let words = program.words.len();
    let holds = [
        // Sizes, as the assembler limits them
        (words <= WORDS && program.buffer.len() <= BUFFER, "it is larger than any program"),
        (program.sources.len() <= SOURCES && program.regions.len() <= REGIONS, "it has too many files or regions"),
        // A program without words has its entry at 0.
        ((program.entry as usize) < words.max(1), "the entry is outside of the code"),
        (
            (program.lines.iter().chain(&program.call_lines))
                .chain(program.computed.iter().map(|computed| &computed.line))
                .all(|line| usize::from(line.source) < program.sources.len() && line.line > 0),
            "a line is of no source",
        ),
        (program.call_lines.is_empty() || program.call_lines.len() == words, "words come from no line"),
        (
            program.region_of.iter().flatten().all(|&region| usize::from(region) < program.regions.len()),
            "a word is of no region",
        ),
        // A region comes after the one around it, so that no chain of surroundings is a circle.
        (
            (program.regions.iter().enumerate())
                .all(|(index, region)| region.parent.is_none_or(|parent| usize::from(parent) < index)),
            "a region is around itself",
        ),
        // Stretches of words, formats and fields lie in what they belong to.
        (
            (program.register_names.iter().map(|named| &named.words))
                .chain(program.holds.iter().map(|held| &held.words))
                .chain(program.computed.iter().map(|computed| &computed.words))
                .all(|range| range.start < range.end && range.end as usize <= words),
            "a register's name or format, or what a function computes, stands for no words",
        ),
        (
            program.holds.iter().flat_map(|held| &held.format).all(|format| program.formats.contains_key(format)),
            "a register holds a number of no format",
        ),
        (
            (program.records.iter())
                .flat_map(|record| record.fields.iter().map(move |field| (record, field)))
                .all(|(record, field)| field.offset.checked_add(field.octets).is_some_and(|end| end <= record.octets)),
            "a field lies outside of its structure",
        ),
    ];
    holds.into_iter().try_for_each(|(holds, what)| if holds { Ok(()) } else { Err(what) })
}
