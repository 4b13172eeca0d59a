//! A work item by itself on the interpreter, with or without a flip, up to a limit of steps.

use super::FaultKind;
use super::flip::{BitFlip, RegisterWord};
use super::link::{BusWord, ItemLink, ItemTraffic};
use crate::code::Code;
use crate::code::octets::{Buffer, Memory};
use crate::code::registers::Registers;
use crate::code::tally::Tally;
use crate::code::trap::Fault;
use crate::engine::{CoreId, Pause, State, interpreter};
use crate::profile::Unobserved;
use crate::semantics::{Message, Watch};

/// Place at which a flip met a work item.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlipHit {
    /// Word of the instruction that was next, of a result the one that computed it; `None` on the bus, where the word says more, and of flips
    /// that last.
    pub pc: Option<u32>,
    /// Word of the registers that flipped.
    pub register: Option<RegisterWord>,
    /// Word on the bus that flipped.
    pub bus: Option<BusWord>,
    /// Change of the number by the bits of a result that flipped, of an accumulator as a whole.
    pub change: i128,
}

/// Course of a work item.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ItemRun {
    /// End of the item.
    pub end: Pause,
    /// Word of the instruction at which it ended.
    pub pc: u32,
    /// Instructions and steps of bodies.
    pub ticks: u64,
    /// Instructions.
    pub steps: u64,
    /// Clocks of computing.
    pub clocks: u64,
    /// Elementary operations.
    pub elementary: u64,
    /// Transfers.
    pub traffic: ItemTraffic,
    /// Messages, with their receivers.
    pub sent: Vec<(u32, Message)>,
    /// Blocks that it wrote to global memory.
    pub writes: Vec<(u32, Vec<u8>)>,
    /// Place of the flip, where there was one.
    pub hit: FlipHit,
    /// Data of the transfer that was to be kept, with the number of their first word in the traffic.
    pub kept: Option<(u64, Vec<u32>)>,
}

impl ItemRun {
    /// True where it counted the same.
    pub fn counts_like(&self, other: &ItemRun) -> bool {
        let counts = |run: &ItemRun| (run.steps, run.clocks, run.elementary, run.traffic);
        counts(self) == counts(other)
    }
}

/// A work item to run.
pub(super) struct ItemTask<'r> {
    /// The core that does it.
    pub core: u32,
    /// The message that begins it.
    pub message: Message,
    /// Global memory.
    pub memory: &'r Memory,
    /// Bits that flip in it, and by which it is known whether a result may be used.
    pub flip: Option<&'r BitFlip>,
    /// Words on the bus that flip beside that, by their numbers in the item's traffic, and the bits.
    pub bus_flips: Vec<(u64, u32)>,
    /// Word of the traffic whose transfer's data are kept.
    pub kept_at: Option<u64>,
    /// Instructions and steps of bodies that it may take.
    pub limit: u64,
    /// Blocks that it reads, where somebody wants to know.
    pub reads: Option<&'r mut Vec<(u32, u32)>>,
}

impl<'r> ItemTask<'r> {
    /// A work item without a fault, and without a limit.
    pub fn new(core: u32, message: Message, memory: &'r Memory) -> ItemTask<'r> {
        let (flip, bus_flips, kept_at, limit, reads) = (None, Vec::new(), None, u64::MAX, None);
        ItemTask { core, message, memory, flip, bus_flips, kept_at, limit, reads }
    }
}

/// A core that runs work items, one after the other, each from reset.
pub(super) struct ItemRunner<'a, T> {
    arithmetic: &'a T,
    initial: Buffer,
    state: State,
    cores: u32,
}

impl<'a, T: Watch> ItemRunner<'a, T> {
    /// A core with a buffer of so many octets, of so many cores.
    pub fn new(code: &Code, arithmetic: &'a T, buffer_octets: u32, cores: u32) -> ItemRunner<'a, T> {
        let initial = Buffer::new(&code.program.buffer, buffer_octets);
        ItemRunner { arithmetic, state: State::new(code, initial.clone()), initial, cores }
    }

    /// Runs a work item from reset to its end.
    ///
    /// A flip at moment 7 of registers happens before the eighth instruction; one of a result lets that instruction be executed, and flips what
    /// it has written before the ninth.
    pub fn run(&mut self, code: &Code, tally: &mut Tally, task: ItemTask) -> ItemRun {
        let ItemTask { core, message, memory, flip, bus_flips, kept_at, limit, reads } = task;
        self.state.begin(code, &self.initial);
        let mut link = ItemLink {
            memory: memory.clone(),
            writes: Vec::new(),
            message: Some(message),
            main: self.cores,
            sent: Vec::new(),
            traffic: ItemTraffic::default(),
            flips: bus_flips,
            kept_at,
            kept: None,
            met: None,
            reads,
        };
        let id = CoreId { core, cores: self.cores, step_limit: limit };
        let mut hit = FlipHit::default();
        let mut end = None;
        match flip.map(|flip| (flip, flip.target)) {
            Some((flip, FaultKind::Bus)) => link.flips.push((flip.moment, flip.mask)),
            Some((flip, FaultKind::Registers | FaultKind::Buffer)) => {
                end = self.advance(code, tally, &mut link, id, flip.moment);
                if end.is_none() {
                    hit = self.flip(code, flip);
                }
            }
            Some((flip, FaultKind::Results)) => {
                end = self.advance(code, tally, &mut link, id, flip.moment);
                if end.is_none() {
                    let slot = self.state.pc;
                    end = self.advance(code, tally, &mut link, id, flip.moment + 1);
                    if end.is_none() {
                        hit = self.flip_result(code, slot, flip);
                    }
                }
            }
            // Flips that last are in the program or in the memory that was handed over, and other faults are not in a work item.
            _ => {}
        }
        let end = end.or_else(|| self.advance(code, tally, &mut link, id, limit));
        let ItemLink { writes, sent, traffic, met, kept, .. } = link;
        hit.bus = met;
        ItemRun {
            end: end.unwrap_or(Pause::Fault(Fault::StepLimit(limit))),
            pc: code.word(self.state.pc),
            ticks: self.state.steps + self.state.inner_steps,
            steps: self.state.steps,
            clocks: self.state.clocks,
            elementary: self.state.elementary,
            traffic,
            sent,
            writes,
            hit,
            kept,
        }
    }

    /// Runs until so many instructions and steps have been taken; yields the end, if that comes first.
    fn advance(
        &mut self,
        code: &Code,
        tally: &mut Tally,
        link: &mut ItemLink,
        id: CoreId,
        ticks: u64,
    ) -> Option<Pause> {
        let limit = ticks.min(id.step_limit);
        let id = CoreId { step_limit: limit, ..id };
        let pause = interpreter::run(code, id, &mut self.state, self.arithmetic, link, tally, &mut Unobserved);
        (pause != Pause::Fault(Fault::StepLimit(limit))).then_some(pause)
    }

    /// Flips bits of a register or of the buffer.
    fn flip(&mut self, code: &Code, flip: &BitFlip) -> FlipHit {
        let pc = Some(code.word(self.state.pc));
        if flip.target == FaultKind::Registers {
            let word = RegisterWord::numbered(flip.word);
            flip_register(&mut self.state.registers, word, flip.mask);
            return FlipHit { pc, register: Some(word), ..FlipHit::default() };
        }
        let (start, size) = (4 * flip.word, self.state.buffer.octets().len() as u32);
        if let Ok(octets) = self.state.buffer.slice_mut(start, size.saturating_sub(start).min(4)) {
            octets.iter_mut().zip(flip.mask.to_le_bytes()).for_each(|(octet, bits)| *octet ^= bits);
        }
        FlipHit { pc, ..FlipHit::default() }
    }

    /// Flips bits of what the instruction in a slot has written.
    fn flip_result(&mut self, code: &Code, slot: u32, flip: &BitFlip) -> FlipHit {
        let pc = Some(code.word(slot));
        let words = result_words(code, slot);
        let Some(&word) = (flip.word as usize).checked_rem(words.len()).and_then(|at| words.get(at)) else {
            return FlipHit { pc, ..FlipHit::default() };
        };
        let change = flip_register(&mut self.state.registers, word, flip.mask);
        FlipHit { pc, register: Some(word), change, bus: None }
    }

    /// Words of the result of the instruction that a work item is at after so many; none where it computes nothing.
    pub fn results_at(&mut self, code: &Code, tally: &mut Tally, task: ItemTask) -> usize {
        let moment = task.limit;
        self.run(code, tally, ItemTask { flip: None, ..task });
        let is_there = self.state.steps + self.state.inner_steps == moment;
        if is_there { result_words(code, self.state.pc).len() } else { 0 }
    }
}

/// Words of the registers that an instruction computes: those that it writes, where one of its outcomes has elementary operations.
fn result_words(code: &Code, slot: u32) -> Vec<RegisterWord> {
    let Some((row, slot)) = code.slot_row(slot).zip(code.slots().get(slot as usize)) else { return Vec::new() };
    if row.outcomes.iter().all(|outcome| outcome.cost.elementary() == 0) {
        return Vec::new();
    }
    let mut words = Vec::new();
    for operand in row.operands.iter().filter(|operand| operand.is_written()) {
        let Some(file) = operand.kind.register_file() else { continue };
        let parts = match file {
            's' => 1,
            'v' => 3,
            _ => 2,
        };
        let first = slot.fields.get(operand.letter) as u8;
        for number in (0..operand.kind.registers()).map(|more| first.wrapping_add(more)) {
            // What is written to `s0` goes nowhere.
            let parts = if (file, number) == ('s', 0) { 0 } else { parts };
            words.extend((0..parts).map(|part| RegisterWord { file, number, part }));
        }
    }
    words
}

/// Flips bits of a word of the registers, and yields what that adds to the register's number.
fn flip_register(registers: &mut Registers, word: RegisterWord, mask: u32) -> i128 {
    let RegisterWord { file, number, part } = word;
    let flipped = |before: i32| (before ^ mask as i32, i128::from(before ^ mask as i32) - i128::from(before));
    match file {
        's' => {
            let (after, change) = flipped(registers.scalar(number));
            registers.set_scalar(number, after);
            change
        }
        'v' => {
            let mut vector = registers.vector(number);
            let (after, change) = flipped(vector[usize::from(part)]);
            vector[usize::from(part)] = after;
            registers.set_vector(number, vector);
            change
        }
        _ => {
            let before = registers.wide(number);
            let after = before ^ i64::from(mask) << word.bits_below();
            registers.set_wide(number, after);
            // Bit 31 of an accumulator is no sign, and its sign changes it by more than an `i64` holds.
            i128::from(after) - i128::from(before)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flip_changes_the_number_of_the_whole_register() {
        let mut registers = Registers::default();
        let [low, high] = [0, 1].map(|part| RegisterWord { file: 'w', number: 2, part });
        registers.set_wide(2, 1 << 31);
        assert_eq!(flip_register(&mut registers, low, 0b11 << 30), (1 << 30) - (1 << 31));
        assert_eq!(registers.wide(2), 1 << 30);
        assert_eq!(flip_register(&mut registers, low, 0b11 << 30), (1 << 31) - (1 << 30));
        assert_eq!(flip_register(&mut registers, high, 0b101), 5 << 32);
        // 2^62 - 2^63, and back by what an `i64` does not hold
        assert_eq!(flip_register(&mut registers, high, 0b11 << 30), (1 << 62) - (1 << 63));
        assert_eq!(flip_register(&mut registers, high, 0b1 << 31), 1 << 63);
        let scalar = RegisterWord { file: 's', number: 1, part: 0 };
        assert_eq!(flip_register(&mut registers, scalar, 1 << 31), -(1 << 31));
    }
}
