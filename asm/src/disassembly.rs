//! Words back to text that assembles to the same words.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use isa::definition::Kind;
use isa::{Instruction, Isa, Program};

/// The text of a program: its words as [`disassemble`] has them, with the names of its functions, its entry, and its
/// buffer as octets. It assembles to the same words, octets and entry.
pub fn disassemble_program(program: &Program, isa: &Isa) -> String {
    let words = program.words.len() as i64;
    let functions = program.regions.iter().filter(|region| region.is_function);
    let named = functions.filter_map(|function| {
        let address = *program.symbols.get(&function.name)?;
        (0..words).contains(&address).then(|| (address, function.name.clone()))
    });
    let mut names: BTreeMap<i64, String> = named.collect();
    let has_default = names.values().any(|name| ["start", "main"].contains(&name.as_str()));
    let is_entry_said = program.entry != 0 || has_default;
    if is_entry_said {
        names.entry(program.entry.into()).or_insert_with(|| "entry".to_owned());
    }
    let mut text = String::new();
    if is_entry_said && let Some(entry) = names.get(&program.entry.into()) {
        let _ = writeln!(text, "    .entry {entry}");
    }
    text += &code(&program.words, names, isa);
    if !program.buffer.is_empty() {
        let _ = writeln!(text, "    .buffer");
    }
    for (row, octets) in program.buffer.chunks(OCTETS_A_ROW).enumerate() {
        let numbers: Vec<String> = octets.iter().map(|octet| format!("0x{octet:02x}")).collect();
        let _ = writeln!(text, "    .byte {:79} ; {:#06x}", numbers.join(", "), row * OCTETS_A_ROW);
    }
    text
}

/// Octets of the buffer on a line.
const OCTETS_A_ROW: usize = 16;

/// The text of words: labels `L0`, `L1`, ... where branches inside lead, `.word` for what is no instruction.
pub fn disassemble(words: &[u32], isa: &Isa) -> String {
    code(words, BTreeMap::new(), isa)
}

fn code(words: &[u32], names: BTreeMap<i64, String>, isa: &Isa) -> String {
    // Decode everything and collect where branches lead.
    let decoded: Vec<Option<Instruction>> = words.iter().map(|&word| isa.decode(word)).collect();
    let mut targets: BTreeSet<i64> = BTreeSet::new();
    for (pc, instruction) in decoded.iter().enumerate() {
        let target = instruction.and_then(|instruction| target(&instruction, isa, pc));
        if let Some(target) = target.filter(|target| (0..=words.len() as i64).contains(target)) {
            targets.insert(target);
        }
    }
    // Names of the program first; `L0`, `L1`, ... for the other targets, past names that are taken.
    let taken: BTreeSet<String> = names.values().cloned().collect();
    let mut numbered = (0..).map(|number| format!("L{number}")).filter(|label| !taken.contains(label));
    let mut labels = names;
    for target in targets {
        labels.entry(target).or_insert_with(|| numbered.next().expect("there is no last number"));
    }
    // Write a line a word, so that the text assembles to the same words at the same places.
    let mut text = String::new();
    for (pc, (instruction, word)) in decoded.iter().zip(words).enumerate() {
        if let Some(label) = labels.get(&(pc as i64)) {
            let _ = writeln!(text, "{label}:");
        }
        let line = match instruction {
            Some(instruction) => {
                instruction.text(isa, |distance| match labels.get(&(pc as i64 + i64::from(distance))) {
                    Some(label) => label.clone(),
                    None => format!(".{distance:+}"),
                })
            }
            None => format!(".word 0x{word:08x}"),
        };
        let _ = writeln!(text, "    {line}");
    }
    // A branch may lead right behind the last word.
    if let Some(label) = labels.get(&(words.len() as i64)) {
        let _ = writeln!(text, "{label}:");
    }
    text
}

fn target(instruction: &Instruction, isa: &Isa, pc: usize) -> Option<i64> {
    let operand = isa.definition(instruction.op).operands.iter().find(|operand| operand.kind == Kind::Rel)?;
    Some(pc as i64 + instruction.fields.get(operand.letter))
}
