//! Facts about a body that are known without running it: which steps and outcomes are reached, whether it may go on for ever, and that no step
//! reads a register that nothing has written.

use super::body::{Body, BodyAct};
use super::registers;
use crate::definition::{InstructionDef, Kind, Operand};
use crate::isa::Isa;
use crate::table::Op;

/// A defect that makes a body unusable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// The step reads a register that is not written on every way to it.
    Unwritten {
        /// The step.
        step: usize,
        /// File of the register.
        file: char,
        /// The register's number in the body.
        number: u8,
    },
    /// An outcome is reached on a way on which a destination is not written.
    Missing {
        /// The outcome's step.
        step: usize,
        /// Letter of the destination.
        letter: u8,
        /// Number of the register in the destination, from 0.
        offset: u8,
    },
    /// No outcome is reached.
    Endless,
}

/// Summary of a body: everything that it may do.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Steps that can be reached, one flag a step.
    pub reached: Vec<bool>,
    /// The outcomes that can be reached, by number.
    pub outcomes: Vec<bool>,
    /// A step that can lead back to itself.
    pub repeats: Option<usize>,
    /// Steps that may stop the machine: accesses to memory, traps.
    pub faults: Vec<usize>,
    /// Steps that may divide by zero, which a machine can make a trap.
    pub divisions: Vec<usize>,
    /// Letters of operands that no step reads or writes.
    pub unused: Vec<u8>,
}

/// The registers of the three files that hold something, a bit each.
type KnownRegisters = [u128; 3];

fn place(file: char) -> usize {
    match file {
        's' => 0,
        'v' => 1,
        _ => 2,
    }
}

/// The bits of an operand's registers.
fn bits(kind: Kind, number: u8) -> u128 {
    ((1 << kind.registers()) - 1) << number
}

impl Body {
    /// The steps that may follow a step.
    pub fn successors(&self, step: usize, isa: &Isa) -> impl Iterator<Item = usize> + use<> {
        let (next, target) = match self.steps[step].act {
            BodyAct::End { .. } => (None, None),
            BodyAct::Execute { instruction, .. } => {
                let definition = isa.definition(instruction.op);
                let distance = definition.operands.iter().find(|operand| operand.kind == Kind::Rel);
                let target = distance.map(|operand| (step as i64 + instruction.fields.get(operand.letter)) as usize);
                let falls = instruction.op != Op::trap && (target.is_none() || definition.outcomes.len() > 1);
                (falls.then_some(step + 1), target)
            }
        };
        next.into_iter().chain(target)
    }

    /// Registers (file, number in the body, how many) that a step reads or writes.
    fn operands(&self, step: usize, isa: &Isa, is_written: bool) -> Vec<(char, u8, Kind)> {
        let BodyAct::Execute { instruction, .. } = self.steps[step].act else { return Vec::new() };
        let operands = isa.definition(instruction.op).operands.iter();
        let wanted = operands.filter(|operand| if is_written { operand.is_written() } else { operand.is_read() });
        let found = wanted.filter_map(|operand| {
            let number = instruction.fields.get(operand.letter) as u8;
            operand.kind.register_file().map(|file| (file, number, operand.kind))
        });
        found.collect()
    }

    /// Summary of the body of a row.
    ///
    /// # Errors
    /// Why it cannot be executed, by the lowest step.
    pub fn summary(&self, definition: &InstructionDef, isa: &Isa) -> Result<Summary, Defect> {
        // What is known to be written before each step, on every way that leads there; `None` for steps that no way reaches.
        let mut known: Vec<Option<KnownRegisters>> = vec![None; self.steps.len()];
        // At the start `s0` holds zero and sources hold what the program put there.
        let mut first: KnownRegisters = [1, 0, 0];
        for operand in definition.operands.iter().filter(|operand| operand.is_read()) {
            if let Some(file) = operand.kind.register_file() {
                first[place(file)] |= bits(operand.kind, registers::operand(operand.letter, 0));
            }
        }
        known[0] = Some(first);
        // Forward data flow to the greatest fixed point: sets only lose bits where ways meet, so each step is visited at most once a bit.
        let mut open = vec![0];
        while let Some(step) = open.pop() {
            let mut after = known[step].expect("what is open has been reached");
            for (file, number, kind) in self.operands(step, isa, true) {
                after[place(file)] |= bits(kind, number);
            }
            for next in self.successors(step, isa) {
                // Known on both ways, or on the only one so far.
                let merged = match known[next] {
                    None => after,
                    Some(before) => std::array::from_fn(|file| before[file] & after[file]),
                };
                if known[next] != Some(merged) {
                    known[next] = Some(merged);
                    open.push(next);
                }
            }
        }
        self.check(definition, isa, &known)?;
        Ok(self.summarize(definition, isa, &known))
    }

    fn check(&self, definition: &InstructionDef, isa: &Isa, known: &[Option<KnownRegisters>]) -> Result<(), Defect> {
        // In the order of the steps, so that the first defect of the text is told.
        let mut has_outcome = false;
        for (step, known) in known.iter().enumerate() {
            let Some(known) = known else { continue };
            // What the step reads.
            for (file, number, kind) in self.operands(step, isa, false) {
                let missing = (0..kind.registers()).find(|at| known[place(file)] >> (number + at) & 1 == 0);
                if let Some(at) = missing {
                    return Err(Defect::Unwritten { step, file, number: number + at });
                }
            }
            // At an outcome all destinations have to be there.
            if !matches!(self.steps[step].act, BodyAct::End { .. }) {
                continue;
            }
            has_outcome = true;
            for operand in definition.operands.iter().filter(|operand| operand.is_written()) {
                let Some(file) = operand.kind.register_file() else { continue };
                let number = registers::operand(operand.letter, 0);
                let missing = (0..operand.kind.registers()).find(|at| known[place(file)] >> (number + at) & 1 == 0);
                if let Some(offset) = missing {
                    return Err(Defect::Missing { step, letter: operand.letter, offset });
                }
            }
        }
        if has_outcome { Ok(()) } else { Err(Defect::Endless) }
    }

    fn summarize(&self, definition: &InstructionDef, isa: &Isa, known: &[Option<KnownRegisters>]) -> Summary {
        let mut summary = Summary {
            reached: known.iter().map(Option::is_some).collect(),
            outcomes: vec![false; definition.outcomes.len()],
            ..Summary::default()
        };
        // Letters of operands that some reached step names, as registers, in immediates or as the way out.
        let mut used = Vec::new();
        for step in (0..self.steps.len()).filter(|&step| known[step].is_some()) {
            match self.steps[step].act {
                BodyAct::End { outcome, jumps } => {
                    summary.outcomes[usize::from(outcome)] = true;
                    used.extend(
                        jumps
                            .then_some(definition.operands.iter().filter(|o| o.kind == Kind::Rel))
                            .into_iter()
                            .flatten()
                            .map(|o| o.letter),
                    );
                }
                BodyAct::Execute { instruction, immediates } => {
                    let inner = isa.definition(instruction.op);
                    // These may stop any machine; a division only one that makes it a trap.
                    if instruction.op == Op::trap || matches!(&*inner.room, "local" | "bus") {
                        summary.faults.push(step);
                    }
                    if inner.outcomes.iter().any(|outcome| outcome.cost[crate::Class::Div] != 0) {
                        summary.divisions.push(step);
                    }
                    let registers =
                        [false, true].into_iter().flat_map(|is_written| self.operands(step, isa, is_written));
                    used.extend(
                        registers.filter_map(|(_, number, _)| registers::letter(number)).map(|(letter, _)| letter),
                    );
                    used.extend(immediates.iter().filter_map(|immediate| match immediate {
                        super::Immediate::Letter { letter, .. } => Some(*letter),
                        super::Immediate::Number(_) => None,
                    }));
                    // The first step that can come after itself stands for its loop.
                    if summary.repeats.is_none() && self.leads_to(step, isa).contains(&step) {
                        summary.repeats = Some(step);
                    }
                }
            }
        }
        summary.unused = definition.operands.iter().map(|o| o.letter).filter(|letter| !used.contains(letter)).collect();
        summary
    }

    /// The steps that may come after a step, in their order.
    pub fn leads_to(&self, step: usize, isa: &Isa) -> Vec<usize> {
        let mut is_reached = vec![false; self.steps.len()];
        let mut open: Vec<usize> = self.successors(step, isa).collect();
        while let Some(at) = open.pop() {
            if !std::mem::replace(&mut is_reached[at], true) {
                open.extend(self.successors(at, isa));
            }
        }
        (0..self.steps.len()).filter(|&at| is_reached[at]).collect()
    }

    /// Letters of a destination and a source of a row that may be one register, where the body reads the source after writing the
    /// destination.
    pub fn overwritten(&self, definition: &InstructionDef, isa: &Isa) -> Vec<(u8, u8)> {
        let of_operand = |operand: &Operand| bits(operand.kind, registers::operand(operand.letter, 0));
        let written = definition.operands.iter().filter(|operand| operand.is_written());
        let pairs = written.flat_map(|written| definition.operands.iter().map(move |read| (written, read)));
        let alike = pairs.filter(|(written, read)| {
            let file = written.kind.register_file();
            written.letter != read.letter && read.is_read() && file.is_some() && file == read.kind.register_file()
        });
        let late = alike.filter(|(written, read)| {
            let file = written.kind.register_file().unwrap_or('s');
            self.reads_after_writing(isa, file, of_operand(written), of_operand(read))
        });
        late.map(|(written, read)| (written.letter, read.letter)).collect()
    }

    /// A step after one that writes some of these registers may read some of those; numbers are those of the body, a bit each.
    pub fn reads_after_writing(&self, isa: &Isa, file: char, written: u128, read: u128) -> bool {
        let touches = |step: usize, is_written: bool, wanted: u128| {
            self.operands(step, isa, is_written)
                .into_iter()
                .any(|(of, number, kind)| of == file && bits(kind, number) & wanted != 0)
        };
        let writes = (0..self.steps.len()).filter(|&step| touches(step, true, written));
        let mut is_reached = vec![false; self.steps.len()];
        let mut open: Vec<usize> = writes.flat_map(|step| self.successors(step, isa)).collect();
        while let Some(at) = open.pop() {
            if !std::mem::replace(&mut is_reached[at], true) {
                if touches(at, false, read) {
                    return true;
                }
                open.extend(self.successors(at, isa));
            }
        }
        false
    }
}
