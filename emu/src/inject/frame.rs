//! A frame with a fault: the main processor is run again, with work items as the fault leaves them.

use std::collections::HashMap;
use std::ops::Range;

use super::FaultKind;
use super::flip::BitFlip;
use super::golden::GoldenFrame;
use super::injector::{InjectedEnd, Injector, flip_memory};
use super::item::{ItemRun, ItemTask};
use super::main_link::{MainLink, run_main};
use crate::code::Code;
use crate::code::octets::Memory;
use crate::code::tally::Tally;
use crate::code::trap::Fault;
use crate::engine::Pause;
use crate::semantics::{Message, Watch};

/// Limit that found a hanging program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum HangLimit {
    /// Steps of a work item.
    ItemSteps,
    /// A work item waits for what nobody sends.
    ItemWait,
    /// Steps of the main processor.
    MainSteps,
    /// The main processor waits for an answer that nobody sends.
    MainWait,
    /// Work items that were handed out.
    Items,
    /// Neither a core nor the main processor can go on.
    MachineWait,
}

impl HangLimit {
    /// Name in results.
    pub const fn name(self) -> &'static str {
        match self {
            HangLimit::ItemSteps => "item_steps",
            HangLimit::ItemWait => "item_wait",
            HangLimit::MainSteps => "main_steps",
            HangLimit::MainWait => "main_wait",
            HangLimit::Items => "items",
            HangLimit::MachineWait => "machine_wait",
        }
    }
}

/// Work items that messages from core to core begin, at most.
const MOST_STRAYS: usize = 64;

/// A program with a flipped word, in the store of one core.
pub(super) struct FaultyStore<'p> {
    pub(super) code: Code<'p>,
    pub(super) core: u32,
    pub(super) word: u32,
}

/// Faults that a frame has from a work item on.
pub(super) struct FrameFault<'f> {
    /// The work item.
    pub(super) item: usize,
    /// The flip, which is at work in that item alone where it does not last.
    pub(super) flip: &'f BitFlip,
    /// The program with its flip, where that is in a program.
    pub(super) store: Option<FaultyStore<'f>>,
    /// Memory as cores see it: the image with what faults have changed.
    pub(super) image: Memory,
    /// Octets of that.
    pub(super) dirty: Vec<Range<u32>>,
    /// Items that have been run already, with their messages as they are without a fault.
    pub(super) known: HashMap<usize, ItemRun>,
    pub(super) counts_differ: bool,
}

impl<'f> FrameFault<'f> {
    /// A fault that is gone with work items that have been run.
    pub(super) fn gone(golden: &GoldenFrame, flip: &'f BitFlip, known: HashMap<usize, ItemRun>) -> FrameFault<'f> {
        let item = known.keys().copied().min().unwrap_or(0);
        let differs = |(&number, run): (&usize, &ItemRun)| !run.counts_like(&golden.items[number].run);
        let counts_differ = known.iter().any(differs);
        FrameFault { item, flip, store: None, image: golden.image.clone(), dirty: Vec::new(), known, counts_differ }
    }

    /// True where something of those items was counted otherwise.
    pub(super) fn counts_differ(&self) -> bool {
        self.counts_differ
    }
}

/// The end that a work item's end is for the frame; `None` where the frame goes on.
pub(super) fn frame_end(run: &ItemRun, core: u32) -> Option<InjectedEnd> {
    let hang = |limit| Some(InjectedEnd::Hang { limit, steps: run.ticks });
    match run.end {
        Pause::Halt => None,
        Pause::Wait => hang(HangLimit::ItemWait),
        Pause::Fault(Fault::StepLimit(_)) => hang(HangLimit::ItemSteps),
        Pause::Fault(fault) => Some(InjectedEnd::Trap { fault, core, pc: run.pc }),
    }
}

impl FrameFault<'_> {
    /// True where an item of the frame without a fault, from this one on, executes or reads what has changed.
    pub(super) fn touches(&self, golden: &GoldenFrame, number: usize) -> bool {
        let Some(item) = golden.items.get(number).filter(|_| number >= self.item) else { return false };
        let is_passing = number == self.item && !self.flip.target.is_lasting();
        let store = self.store.as_ref();
        is_passing
            || self.known.contains_key(&number)
            || store.is_some_and(|store| store.core == item.core && item.executes(store.word))
            || self.dirty.iter().any(|range| item.reads(range))
    }
}

impl<T: Watch> Injector<'_, T> {
    /// Runs a work item in a frame with a fault.
    pub(super) fn run_faulty(&mut self, fault: &FrameFault, number: usize, core: u32, message: Message) -> ItemRun {
        self.items += 1;
        let is_passing = number == fault.item && !fault.flip.target.is_lasting();
        let flip = is_passing.then_some(fault.flip);
        let memory = if number >= fault.item { &fault.image } else { &self.golden.image };
        let task = ItemTask { flip, limit: self.golden.limits.item, ..ItemTask::new(core, message, memory) };
        match &fault.store {
            Some(store) if store.core == core && number >= fault.item => {
                // Passes of another program are others.
                let mut tally = Tally::new(&store.code);
                self.runner.run(&store.code, &mut tally, task)
            }
            _ => self.runner.run(&self.golden.code, &mut self.tally, task),
        }
    }

    /// Runs the main processor, with work items as the fault leaves them.
    ///
    /// Of four items, item 1 has a flipped register, and because of it writes to octets 400 to 403:
    ///
    /// | item | reads | answers |
    /// | --- | --- | --- |
    /// | 0 | 400 to 403 | as without the fault: it comes before |
    /// | 1 | | it is run with the flip |
    /// | 2 | 400 to 403 | it is run again, with what item 1 has written |
    /// | 3 | 800 to 803 | as without the fault, if its message is the same |
    pub(super) fn frame(&mut self, mut fault: FrameFault) -> InjectedEnd {
        let golden = self.golden;
        let (setup, cores) = (golden.setup, golden.setup.config.cores);
        let mut memory = golden.image.clone();
        // Answer each item when it is handed out; the first that ends the frame leaves its end here
        let mut stopped = None;
        let arithmetic = self.arithmetic;
        let mut item = |number: usize, core: u32, message: Message, memory: &mut Memory| {
            if number >= golden.limits.items {
                stopped = Some(InjectedEnd::Hang { limit: HangLimit::Items, steps: number as u64 });
                return None;
            }
            // Flip memory before the item is answered, so that the main processor reads the flip from here on
            if number == fault.item && fault.flip.target == FaultKind::Memory {
                flip_memory(memory, fault.flip);
            }
            match self.answers(&mut fault, number, core, message, memory) {
                Ok(answers) => Some(answers),
                Err(end) => {
                    stopped = Some(end);
                    None
                }
            }
        };
        // Run the main processor; the end of an item comes before what that does to its end
        let mut link = MainLink::new(&mut memory, cores, &mut item);
        let (main, _) = run_main(setup, &golden.main_code, arithmetic, &mut link, golden.limits.main);
        if let Some(end) = stopped {
            return end;
        }
        // Turn the main processor's end into that of the frame; where it halts, compare with the frame without the fault
        let hang = |limit| InjectedEnd::Hang { limit, steps: main.ticks };
        match main.end {
            Pause::Halt => {
                let counts_differ =
                    fault.counts_differ || (main.ticks, main.clocks) != (golden.main.ticks, golden.main.clocks);
                InjectedEnd::Frame { counts_differ, memory: (memory != golden.memory).then_some(memory) }
            }
            Pause::Wait => hang(HangLimit::MainWait),
            Pause::Fault(Fault::StepLimit(_)) => hang(HangLimit::MainSteps),
            Pause::Fault(fault) => InjectedEnd::Trap { fault, core: cores, pc: main.pc },
        }
    }

    /// Answers of a work item in a frame with a fault, and of those that its messages to other cores begin.
    ///
    /// # Errors
    /// The end of the frame.
    fn answers(
        &mut self,
        fault: &mut FrameFault,
        number: usize,
        core: u32,
        message: Message,
        memory: &mut Memory,
    ) -> Result<Vec<(Message, u32)>, InjectedEnd> {
        let golden = self.golden;
        let item = golden.items.get(number);
        let same = item.filter(|item| (item.message, item.core) == (message, core));
        if let Some(item) = same.filter(|_| !fault.touches(golden, number)) {
            return Ok(item.run.sent.iter().map(|&(_, answer)| (answer, core)).collect());
        }
        let known = same.and_then(|_| fault.known.remove(&number));
        let mut run = known.unwrap_or_else(|| self.run_faulty(fault, number, core, message));
        fault.counts_differ |= item.is_none_or(|item| !run.counts_like(&item.run));
        let (mut answers, mut strays) = (Vec::new(), Vec::new());
        let mut sender = core;
        let mut begun = 0;
        loop {
            if let Some(end) = frame_end(&run, sender) {
                return Err(end);
            }
            for (address, octets) in &run.writes {
                // Later items see what this one has written, so those that were run before have to be run again.
                let written = fault.image.write(*address, octets).and_then(|()| memory.write(*address, octets));
                debug_assert!(written.is_ok(), "a memory of the same size has taken it");
                fault.dirty.push(*address..address.saturating_add(octets.len() as u32));
                fault.known.clear();
            }
            for &(receiver, message) in &run.sent {
                if receiver == golden.setup.config.cores {
                    answers.push((message, sender));
                } else {
                    strays.push((receiver, message));
                }
            }
            // A core takes what another core sends as a work item of its own.
            let Some((receiver, message)) = strays.pop() else { return Ok(answers) };
            begun += 1;
            if begun > MOST_STRAYS {
                return Err(InjectedEnd::Hang { limit: HangLimit::Items, steps: self.items });
            }
            // A flip that does not last has happened.
            run = self.run_faulty(fault, fault.item + 1, receiver, message);
            sender = receiver;
        }
    }
}
