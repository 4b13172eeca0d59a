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
                    FaultPlace { format, bits_below: word.bits_below(), ..plain(structure, place) }
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
                let (structure, format) = datum(image, address);
                FaultPlace { format, ..plain(structure, format!("memory {address:#x}")) }
            }
            FaultKind::Bus => match hit.bus {
                Some(BusWord::Data(address)) => {
                    let (structure, format) = datum(image, address);
                    FaultPlace { format, ..plain(structure, format!("data of {address:#x}")) }
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

/// Kind of data at an address, and the field that is there where the kind is a row of structures.
fn datum(image: &MemoryImage, address: u32) -> (&'static str, Option<String>) {
    let found = image.regions.iter().find(|(_, range)| range.contains(&address));
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
    let field = structure.filter(|structure| structure.octets() != 0).and_then(|structure| {
        let bit = 8 * ((address - range.start) % structure.octets());
        let places = structure.places();
        let last = places.filter(|(start, _)| *start <= bit).last();
        last.map(|(_, field)| format!("{}.{}", structure.name, field.name))
    });
    (kind.name(), field)
}
