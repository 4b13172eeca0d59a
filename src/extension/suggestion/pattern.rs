//! Some instructions of a basic block as one instruction: its operands, its body, and how long it takes at least.

use emu::timing::Timing;
use isa::definition::Operand;
use isa::{Instruction, Isa, Kind};

use super::flow::{RegisterSet, bits, registers};

/// Most bits that the operands of an instruction take.
pub const MOST_BITS: u32 = 26;

/// One instruction in the place of several.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    /// Letters and kinds of its operands.
    pub operands: Vec<(char, Kind)>,
    /// The lines of its body.
    pub lines: Vec<String>,
    /// Clocks of the instructions one after the other.
    pub serial: u64,
    /// Clocks of the longest chain of instructions that need each other's results.
    pub critical: u64,
}

/// Registers that are used together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct RegisterUnit {
    file: char,
    first: u8,
    kind: Kind,
    is_read_first: bool,
    is_written: bool,
}

/// Rooms of instructions that need nothing but the core.
const ROOMS: [&str; 6] = ["scalar", "integer", "vector", "wide", "ray", "local"];

/// True where an instruction may be part of another.
pub fn is_plain(instruction: &Instruction, isa: &Isa) -> bool {
    let row = isa.definition(instruction.op);
    ROOMS.contains(&&*row.room)
}

fn kind_of(file: char, count: u8) -> Option<Kind> {
    Kind::ALL.into_iter().find(|kind| kind.register_file() == Some(file) && kind.registers() == count)
}

impl Pattern {
    /// The instruction for some others, and the registers that it takes there; `live` are those that may be read after it. `None` where no row
    /// can say it.
    pub fn new(
        instructions: &[Instruction],
        live: RegisterSet,
        isa: &Isa,
        timing: &Timing,
    ) -> Option<(Pattern, Vec<u8>)> {
        // Collect what the sequence reads and writes, register by register. Of `mul s3, s1, s2; add s4, s3, s5` with s3 dead behind it,
        // s4 becomes `d`, s1, s2 and s5 become `a`, `b` and `c`, and s3 the temporary `t0`.
        let units = units(instructions, isa)?;
        let (mut operands, mut fields, mut names) = (Vec::new(), Vec::new(), Vec::new());
        // Letters of written, changed and read operands, each list taken from its end.
        let mut letters = [vec!['e', 'd'], vec!['y', 'x'], vec!['c', 'b', 'a']];
        let mut temporaries = [0u8; 3];
        for unit in &units {
            let file = ['s', 'v', 'w'].iter().position(|file| *file == unit.file)?;
            // What is written and not read later needs no operand.
            let class = match (unit.is_written, unit.is_read_first) {
                (true, true) => Some(1),
                (true, false) if bits(unit.kind, unit.first) & live != 0 => Some(0),
                (true, false) => None,
                (false, _) => Some(2),
            };
            names.push(match class {
                Some(class) => {
                    let letter = letters[class].pop()?;
                    operands.push((letter, unit.kind));
                    fields.push(unit.first);
                    letter.to_string()
                }
                None => {
                    let number = temporaries[file];
                    temporaries[file] += unit.kind.registers();
                    format!("{}{number}", ["t", "tv", "tw"][file])
                }
            });
        }
        // Refuse what a word has no bits or fields for, and what the hidden wide registers cannot hold.
        let width: u32 = operands.iter().map(|(_, kind)| u32::from(kind.width().unwrap_or(0))).sum();
        let wides =
            operands.iter().filter(|(letter, kind)| "dexy".contains(*letter) && kind.register_file() == Some('w'));
        let hidden = temporaries[2] + wides.map(|(_, kind)| kind.registers()).sum::<u8>();
        if width > MOST_BITS || operands.len() > isa::pattern::MAX_FIELDS || hidden > 8 || operands.is_empty() {
            return None;
        }
        // Write the lines of the body with the letters in the places of registers.
        let name = |file: char, number: u8| -> String {
            let unit = units.iter().position(|unit| unit.file == file && unit.first == number);
            unit.map_or_else(|| "s0".to_owned(), |at| names[at].clone())
        };
        let lines = instructions.iter().map(|instruction| line(instruction, isa, &name)).collect();
        let (serial, critical) = latency(instructions, isa, timing);
        Some((Pattern { operands, lines, serial, critical }, fields))
    }

    /// The line that executes it on these registers.
    pub fn call(&self, name: &str, fields: &[u8]) -> String {
        let registers = self.operands.iter().zip(fields);
        let registers: Vec<String> = registers.map(|((_, kind), number)| isa::register_name(*kind, *number)).collect();
        format!("{name} {}", registers.join(", "))
    }

    /// The registers that it reads and those that it writes there.
    pub fn registers(&self, fields: &[u8]) -> (RegisterSet, RegisterSet) {
        let (mut reads, mut writes) = (0, 0);
        for (&(letter, kind), &number) in self.operands.iter().zip(fields) {
            let operand = Operand { letter: letter as u8, kind };
            reads |= if operand.is_read() { bits(kind, number) } else { 0 };
            writes |= if operand.is_written() { bits(kind, number) } else { 0 };
        }
        (reads, writes)
    }

    /// Bits of the operands.
    pub fn bits(&self) -> u32 {
        self.operands.iter().map(|(_, kind)| u32::from(kind.width().unwrap_or(0))).sum()
    }
}

/// The registers of the instructions by how they are used together; `None` where groups overlap.
fn units(instructions: &[Instruction], isa: &Isa) -> Option<Vec<RegisterUnit>> {
    let mut units: Vec<RegisterUnit> = Vec::new();
    for instruction in instructions {
        for is_written in [false, true] {
            for operand in isa.definition(instruction.op).operands.iter() {
                let wanted = if is_written { operand.is_written() } else { operand.is_read() };
                let (Some(file), true) = (operand.kind.register_file(), wanted) else { continue };
                let (first, count) = (instruction.fields.get(operand.letter) as u8, operand.kind.registers());
                if file == 's' && first == 0 {
                    continue;
                }
                let overlaps = |unit: &&mut RegisterUnit| {
                    unit.file == file && first < unit.first + unit.kind.registers() && unit.first < first + count
                };
                match units.iter_mut().find(overlaps) {
                    Some(unit) if (unit.first, unit.kind.registers()) == (first, count) => {
                        unit.is_written |= is_written
                    }
                    Some(_) => return None,
                    None => {
                        let kind = kind_of(file, count)?;
                        units.push(RegisterUnit { file, first, kind, is_read_first: !is_written, is_written });
                    }
                }
            }
        }
    }
    Some(units)
}

/// An instruction with other names for its registers.
pub fn line(instruction: &Instruction, isa: &Isa, name: &dyn Fn(char, u8) -> String) -> String {
    let row = isa.definition(instruction.op);
    let mut parts: Vec<String> = Vec::new();
    for (at, operand) in row.operands.iter().enumerate() {
        let value = instruction.fields.get(operand.letter);
        match operand.kind.register_file() {
            Some(file) => parts.push(name(file, value as u8)),
            None if operand.kind == Kind::Off && row.operands[at - 1].kind.register_file() == Some('s') => {
                let base = parts.pop().unwrap_or_default();
                parts.push(format!("{value}({base})"));
            }
            None => parts.push(value.to_string()),
        }
    }
    format!("{} {}", row.name, parts.join(", ")).trim_end().to_owned()
}

/// Clocks one after the other, and along the longest chain of results.
fn latency(instructions: &[Instruction], isa: &Isa, timing: &Timing) -> (u64, u64) {
    let mut ready: Vec<(RegisterSet, u64)> = Vec::new();
    let (mut serial, mut critical) = (0, 0);
    for instruction in instructions {
        let clocks = timing.clocks(&isa.definition(instruction.op).outcomes[0].cost).0;
        let reads = registers(instruction, isa, false);
        let start = ready.iter().filter(|(written, _)| written & reads != 0).map(|&(_, end)| end).max().unwrap_or(0);
        let writes = registers(instruction, isa, true);
        ready.iter_mut().for_each(|(written, _)| *written &= !writes);
        ready.push((writes, start + clocks));
        serial += clocks;
        critical = critical.max(start + clocks);
    }
    (serial, critical)
}
