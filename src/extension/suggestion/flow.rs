//! Flow of control in a program, and the registers that may still be read.

use isa::{Instruction, Isa, Kind, Op, Program};

/// Registers, a bit each: 32 scalars, 32 vectors, 8 wide accumulators.
pub type RegisterSet = u128;

/// The registers that an instruction reads, or writes; `s0` is none.
pub fn registers(instruction: &Instruction, isa: &Isa, is_written: bool) -> RegisterSet {
    let mut found = 0;
    for operand in isa.definition(instruction.op).operands.iter() {
        if (is_written && operand.is_written()) || (!is_written && operand.is_read()) {
            found |= bits(operand.kind, instruction.fields.get(operand.letter) as u8);
        }
    }
    found & !1
}

/// The registers of an operand.
pub fn bits(kind: Kind, number: u8) -> RegisterSet {
    let first = match kind.register_file() {
        Some('s') => 0,
        Some('v') => 32,
        Some(_) => 64,
        None => return 0,
    };
    ((1 << kind.registers()) - 1) << (first + number)
}

/// A program, decoded, with what follows what.
pub struct ProgramFlow {
    /// Instructions of the program.
    pub instructions: Vec<Option<Instruction>>,
    /// Targets of each branch or call.
    pub targets: Vec<Option<usize>>,
    /// Words at which control may arrive from elsewhere than the word before.
    pub is_leader: Vec<bool>,
    /// Registers that may be read after each word.
    pub live: Vec<RegisterSet>,
}

impl ProgramFlow {
    /// Follows a program.
    pub fn new(program: &Program, isa: &Isa) -> ProgramFlow {
        let instructions: Vec<Option<Instruction>> = program.words.iter().map(|&word| isa.decode(word)).collect();
        let target = |(pc, instruction): (usize, &Option<Instruction>)| {
            let instruction = instruction.as_ref()?;
            let operand = isa.definition(instruction.op).operands.iter().find(|operand| operand.kind == Kind::Rel)?;
            usize::try_from(pc as i64 + instruction.fields.get(operand.letter)).ok()
        };
        let targets: Vec<Option<usize>> = instructions.iter().enumerate().map(target).collect();
        let mut is_leader = vec![false; instructions.len() + 1];
        is_leader[program.entry as usize] = true;
        for (pc, instruction) in instructions.iter().enumerate() {
            if let Some(target) = targets[pc].filter(|&target| target < is_leader.len()) {
                is_leader[target] = true;
            }
            if instruction.is_none_or(|instruction| *isa.definition(instruction.op).room == *"control") {
                is_leader[pc + 1] = true;
            }
        }
        let mut flow = ProgramFlow { live: vec![0; instructions.len()], instructions, targets, is_leader };
        flow.follow(isa);
        flow
    }

    /// The words behind calls whose link is in a register, or all where something else writes it.
    fn returns(&self, link: u8, isa: &Isa) -> Vec<usize> {
        let calls = self.instructions.iter().enumerate().filter_map(|(pc, found)| {
            let found = found.as_ref().filter(|found| matches!(found.op, Op::call | Op::callr))?;
            Some((pc + 1, found.fields.d))
        });
        let is_moved = self.instructions.iter().flatten().any(|found| {
            !matches!(found.op, Op::call | Op::callr) && registers(found, isa, true) & bits(Kind::S, link) != 0
        });
        calls.filter(|&(_, to)| is_moved || to == link).map(|(pc, _)| pc).collect()
    }

    /// Finds what may be read after each word, from the ends backwards.
    fn follow(&mut self, isa: &Isa) {
        let words = self.instructions.len();
        // A call through a register may lead anywhere, and each return then as well.
        let has_unknown = self.instructions.iter().flatten().any(|found| found.op == Op::callr);
        // List the words that may follow each word; `None` is any word.
        let next: Vec<Option<Vec<usize>>> = (0..words)
            .map(|pc| {
                let found = self.instructions[pc].as_ref()?;
                Some(match found.op {
                    Op::halt | Op::trap => Vec::new(),
                    Op::callr => return None,
                    Op::ret if has_unknown => return None,
                    Op::ret => self.returns(found.fields.a, isa),
                    Op::call | Op::jump => self.targets[pc].into_iter().collect(),
                    _ => self.targets[pc].into_iter().chain([pc + 1]).collect(),
                })
            })
            .collect();
        // Repeat from the last word to the first until nothing changes: what is read before a word is what is read after it, without what it
        // writes, with what it reads. Sets only grow, so this ends.
        let mut before: Vec<RegisterSet> = vec![0; words + 1];
        loop {
            let mut is_done = true;
            for pc in (0..words).rev() {
                let after = match &next[pc] {
                    None => RegisterSet::MAX,
                    Some(next) => next.iter().filter(|&&to| to <= words).map(|&to| before[to]).fold(0, |a, b| a | b),
                };
                let here = self.instructions[pc].as_ref().map_or(RegisterSet::MAX, |found| {
                    after & !registers(found, isa, true) | registers(found, isa, false)
                });
                is_done &= here == before[pc] && after == self.live[pc];
                (before[pc], self.live[pc]) = (here, after);
            }
            if is_done {
                return;
            }
        }
    }
}
