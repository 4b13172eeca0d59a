//! Words back to text that assembles to the same words.

use std::collections::BTreeMap;
use std::fmt::Write;

use isa::row::Kind;
use isa::{Instruction, Isa};

/// The text of words: labels `L0`, `L1`, ... where branches inside lead, `.word` for what is no instruction.
pub fn disassemble(words: &[u32], isa: &Isa) -> String {
    let decoded: Vec<Option<Instruction>> = words.iter().map(|&word| isa.decode(word)).collect();
    let mut labels: BTreeMap<i64, usize> = BTreeMap::new();
    for (pc, instruction) in decoded.iter().enumerate() {
        let target = instruction.and_then(|instruction| target(&instruction, isa, pc));
        if let Some(target) = target.filter(|target| (0..=words.len() as i64).contains(target)) {
            labels.insert(target, 0);
        }
    }
    for (number, label) in labels.values_mut().enumerate() {
        *label = number;
    }
    let mut text = String::new();
    for (pc, (instruction, word)) in decoded.iter().zip(words).enumerate() {
        if let Some(label) = labels.get(&(pc as i64)) {
            let _ = writeln!(text, "L{label}:");
        }
        let line = match instruction {
            Some(instruction) => {
                instruction.text(isa, |distance| match labels.get(&(pc as i64 + i64::from(distance))) {
                    Some(label) => format!("L{label}"),
                    None => format!(".{distance:+}"),
                })
            }
            None => format!(".word 0x{word:08x}"),
        };
        let _ = writeln!(text, "    {line}");
    }
    if let Some(label) = labels.get(&(words.len() as i64)) {
        let _ = writeln!(text, "L{label}:");
    }
    text
}

fn target(instruction: &Instruction, isa: &Isa, pc: usize) -> Option<i64> {
    let operand = isa.row(instruction.op).operands.iter().find(|operand| operand.kind == Kind::Rel)?;
    Some(pc as i64 + instruction.fields.get(operand.letter))
}
