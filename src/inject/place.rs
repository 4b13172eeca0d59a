//! Names of the place at which bits flipped: structure, function and format.

use std::ops::Range;

use emu::inject::{BitFlip, BusWord, FaultKind, FlipHit, GoldenFrame, RegisterWord};
use isa::{Isa, Program};
use scenes::image::{MemoryImage, MemoryKind};
use scenes::layout::{Layout, Structure};

/// Place of a flip in words.
pub(super) struct FaultPlace {
    /// Part of the kind.
    pub structure: String,
    /// The place.
    pub place: String,
    /// Function around the instruction.
    pub function: Option<String>,
    /// Format of a number, or field of a structure.
    pub format: Option<String>,
    /// Flipped bits of that number or field, 0 its lowest; none where there is no format.
    pub format_bits: Vec<u32>,
    /// Bits of the register's number below the word.
    pub bits_below: u32,
}

impl FaultPlace {
    /// Names of the place of a flip that met its work item.
    pub fn new(flip: &BitFlip, hit: &FlipHit, golden: &GoldenFrame, image: &MemoryImage) -> FaultPlace {
        let program = golden.program();
        let function = |pc: Option<u32>| pc.and_then(|pc| program.function(pc)).map(str::to_owned);
        let plain = |structure: &str, place: String| FaultPlace {
            structure: structure.to_owned(),
            place,
            function: function(hit.pc),
            format: None,
            format_bits: Vec::new(),
            bits_below: 0,
        };
        match flip.target {
            FaultKind::Registers | FaultKind::Results => match hit.register {
                // A result has its format behind the instruction that computes it.
                Some(word) => {
                    let behind = u32::from(flip.target == FaultKind::Results);
                    let pc = hit.pc.unwrap_or(0) + behind;
                    let format = program.format_of((word.file, word.number), pc).map(|(name, _)| name.to_owned());
                    let (structure, place) = register(word);
                    let bits_below = word.bits_below();
                    let format_bits = match format {
                        Some(_) => bits_of(flip.mask).map(|bit| bit + bits_below).collect(),
                        None => Vec::new(),
                    };
                    FaultPlace { format, format_bits, bits_below, ..plain(structure, place) }
                }
                None => plain("none", "nothing that computes".to_owned()),
            },
            FaultKind::Buffer => {
                let address = 4 * flip.word;
                let is_constant = (address as usize) < program.buffer.len();
                plain(if is_constant { "constants" } else { "work_space" }, format!("buffer {address}"))
            }
            FaultKind::Program => FaultPlace {
                function: function(Some(flip.word)),
                ..plain(word_part(golden.isa(), program, flip), format!("word {}", flip.word))
            },
            FaultKind::Memory => {
                let address = 4 * flip.word;
                let (structure, field) = datum(image, address, flip.mask);
                let (format, format_bits) = field.unzip();
                let format_bits = format_bits.unwrap_or_default();
                FaultPlace { format, format_bits, ..plain(structure, format!("memory {address:#x}")) }
            }
            FaultKind::Bus => match hit.bus {
                Some(BusWord::Data(address)) => {
                    let (structure, field) = datum(image, address, flip.mask);
                    let (format, format_bits) = field.unzip();
                    let format_bits = format_bits.unwrap_or_default();
                    FaultPlace { format, format_bits, ..plain(structure, format!("data of {address:#x}")) }
                }
                Some(BusWord::Address) => plain("addresses", "address".to_owned()),
                Some(BusWord::Message) => plain("messages", "message".to_owned()),
                None => plain("none", "nothing that moves".to_owned()),
            },
            FaultKind::LostGrant => plain("grants", format!("the first grant from clock {} on", flip.moment)),
            FaultKind::DoubledGrant => plain("grants", format!("word {} on the bus", flip.moment)),
            FaultKind::StuckArbiter | FaultKind::StoppedCore => {
                let master = if flip.word < golden.cores() { "cores" } else { "main" };
                plain(master, format!("master {} from clock {} on", flip.word, flip.moment))
            }
        }
    }
}

/// File and name of a word of the registers.
fn register(word: RegisterWord) -> (&'static str, String) {
    let RegisterWord { file, number, part } = word;
    match file {
        's' => ("scalars", format!("s{number}")),
        'v' => ("vectors", format!("v{number}.{}", ["x", "y", "z"][usize::from(part.min(2))])),
        _ => ("accumulators", format!("w{number}")),
    }
}

/// Part of the instruction word that the lowest flipped bit is in.
fn word_part(isa: &Isa, program: &Program, flip: &BitFlip) -> &'static str {
    let instruction = program.words.get(flip.word as usize).and_then(|&word| isa.decode(word));
    let Some(instruction) = instruction else { return "no_instruction" };
    let row = isa.definition(instruction.op);
    let bit = flip.mask.trailing_zeros();
    let field = row.pattern.fields().iter().find(|field| {
        let range: Range<u32> = field.shift.into()..u32::from(field.shift) + u32::from(field.width);
        range.contains(&bit)
    });
    match field.and_then(|field| row.operand(field.letter)) {
        None => "opcodes",
        Some(operand) if operand.kind.register_file().is_some() => "register_numbers",
        Some(_) => "immediates",
    }
}

/// Numbers of the flipped bits of a word.
pub(super) fn bits_of(mask: u32) -> impl Iterator<Item = u32> {
    (0..u32::BITS).filter(move |bit| mask >> bit & 1 == 1)
}

/// Kind of data at the lowest flipped bit of the word at an address, and the field and the flipped bits of its element that are there, where the
/// kind is a row of structures.
fn datum(image: &MemoryImage, address: u32, mask: u32) -> (&'static str, Option<(String, Vec<u32>)>) {
    let lowest = bits_of(mask).next().unwrap_or(0);
    // The word may go on into the next region.
    let octet = address.saturating_add(lowest / 8);
    let found = image.regions.iter().find(|(_, range)| range.contains(&octet));
    let Some((kind, range)) = found else { return ("outside", None) };
    let set = &image.structures;
    // Leaves of packets and packed nodes are no rows of one structure.
    let is_row = matches!(image.layout, Layout::Report | Layout::Wide);
    let structure: Option<&Structure> = match kind {
        MemoryKind::Nodes => Some(&set.node).filter(|_| is_row),
        MemoryKind::References => Some(&set.reference).filter(|_| is_row),
        MemoryKind::Triangles => Some(&set.triangle).filter(|_| is_row),
        MemoryKind::Materials => Some(&set.material),
        MemoryKind::Lights => Some(&set.light),
        MemoryKind::Frame => Some(&set.pixel),
        MemoryKind::Header => None,
    };
    let field = structure.and_then(|structure| element(structure, octet - range.start, lowest % 8, mask >> lowest));
    (kind.name(), field)
}

/// Field that a bit of an octet of a row of structures is in, and the flipped bits of its element, of which that bit is the lowest of a mask.
///
/// In triangles of 38 octets that begin with 9 numbers of 32 bits, bit 4 of octet 38 + 5 is bit 12 of the second number. What a mask has beyond
/// the element is in another one, and left out.
fn element(structure: &Structure, octet: u32, bit: u32, mask: u32) -> Option<(String, Vec<u32>)> {
    let at = 8 * octet.checked_rem(structure.octets())? + bit;
    let has = |start: u32, bits: u32| (start..start + bits).contains(&at);
    let (start, field) = structure.places().find(|(start, field)| has(*start, field.elements * field.bits))?;
    let first = (at - start) % field.bits;
    let bits = bits_of(mask).map(|more| first + more).filter(|&bit| bit < field.bits).collect();
    Some((format!("{}.{}", structure.name, field.name), bits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bit_is_in_the_field_that_has_it() {
        let triangle = Layout::Wide.fixed_structures().triangle;
        assert_eq!(triangle.octets(), 38, "no multiple of a word");
        let found = |word: u32, mask: u32| {
            let lowest = mask.trailing_zeros();
            element(&triangle, 4 * word + lowest / 8, lowest % 8, mask >> lowest)
        };
        let field = |name: &str, bits: &[u32]| Some((format!("triangle.{name}"), bits.to_vec()));
        assert_eq!(found(0, 1 << 31), field("v0", &[31]));
        // The tenth word of the first triangle has the first half of the second triangle's first number.
        assert_eq!(found(9, 1 << 15), field("material_id", &[15]));
        assert_eq!(found(9, 1 << 16), field("v0", &[0]));
        // Words of the second triangle lie across its numbers.
        assert_eq!(found(10, 1 << 3), field("v0", &[19]));
        assert_eq!(found(10, 1 << 20), field("v0", &[4]));
        assert_eq!(found(18, 1 << 20), field("material_id", &[4]));
        // Bits of another element are left out.
        assert_eq!(found(10, 0b11 << 15), field("v0", &[31]));
        assert_eq!(found(9, 0b101 << 15), field("material_id", &[15]));
    }
}
