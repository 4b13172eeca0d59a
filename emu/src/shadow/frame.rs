//! A whole frame with shadows: the main processor and all cores, each of which runs until it has to wait. What they hand each other, in messages
//! and through global memory, keeps its shadow.
//!
//! Everything here is answered at once and nothing takes time, so a program whose results depend on time has one of its possible results; a
//! picture's pixels do not depend on it.

use std::collections::VecDeque;
use std::sync::Arc;

use super::{Shadow, ShadowLedger, ShadowMemory, ShadowProgram};
use crate::code::Code;
use crate::code::octets::{Buffer, Memory};
use crate::code::tally::Tally;
use crate::code::trap::{Fault, Stop, Trap};
use crate::engine::{CoreId, Pause, State, interpreter};
use crate::machine::{RunFailure, Setup, check};
use crate::semantics::{Link, Message, Watching, at_once};

/// Outcome of a frame with shadows.
#[derive(Clone, Debug)]
pub struct ShadowFrame {
    /// Global memory at the end.
    pub memory: Memory,
    /// Shadows of the numbers in it.
    pub numbers: ShadowMemory,
    /// The cores' program.
    pub core: Arc<ShadowProgram>,
    /// The main processor's program, whose sites follow those of the cores' program.
    pub main: Arc<ShadowProgram>,
    /// Errors of the cores' program, all cores together.
    pub ledger: ShadowLedger,
    /// Errors of the main processor's program.
    pub main_ledger: ShadowLedger,
}

/// Phase of a processor between its turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FrameState {
    /// A turn is due: the processor can run, or try again.
    Ready,
    /// Arrival at the barrier, where others are awaited.
    Barrier,
    /// Nothing is left to do: the program has halted.
    Rests,
}

struct FrameCore {
    state: State,
    shadow: Shadow,
    tally: Tally,
    phase: FrameState,
    /// The work item has done something with the machine.
    has_acted: bool,
}

/// Mailboxes and memory, as one processor reaches them.
struct FrameLink<'a> {
    memory: &'a mut Memory,
    inboxes: &'a mut [VecDeque<(Message, u32)>],
    core: u32,
    largest: u32,
    /// Receivers of what it has sent to others, in order.
    sent: Vec<u32>,
    has_acted: bool,
    /// The barrier is open for it once.
    is_released: bool,
    meets: bool,
}

impl FrameLink<'_> {
    /// Global memory, for something that the work item does with it.
    fn acting(&mut self) -> &mut Memory {
        self.has_acted = true;
        self.memory
    }
}

impl Link for FrameLink<'_> {
    at_once! { self => self.acting() }

    fn send(&mut self, to: i32, message: Message) -> Result<(), Stop> {
        let receiver = u32::try_from(to).ok().filter(|&to| to <= self.largest);
        let receiver = receiver.ok_or(Fault::NoSuchCore { number: to, largest: self.largest })?;
        let inbox = &mut self.inboxes[receiver as usize];
        // A mailbox holds one message of each sender.
        if inbox.iter().any(|(_, sender)| *sender == self.core) {
            return Err(Stop::Wait);
        }
        inbox.push_back((message, self.core));
        if receiver != self.core {
            self.sent.push(receiver);
        }
        self.has_acted = true;
        Ok(())
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        let letter = self.inboxes[self.core as usize].pop_front().ok_or(Stop::Wait)?;
        self.has_acted = true;
        Ok(letter)
    }

    fn barrier(&mut self) -> Result<(), Stop> {
        self.meets = !self.is_released;
        if !std::mem::take(&mut self.is_released) {
            return Err(Stop::Wait);
        }
        self.has_acted = true;
        Ok(())
    }
}

/// Runs a frame with shadows. `progress` is told the number of work items that are done.
///
/// # Errors
/// A machine out of its ranges, a program whose initial buffer does not fit, a trap, or processors that wait for each other for ever.
pub fn run(setup: &Setup, memory: Memory, progress: &mut dyn FnMut(u64)) -> Result<ShadowFrame, RunFailure> {
    check(setup)?;
    let config = setup.config;
    let arithmetic = Watching::new(config.arithmetic.modes(), config.arithmetic.trap_division_by_zero);
    let code = Code::new(setup.core, setup.isa, config.timing());
    let main_code = Code::new(setup.main, setup.isa, config.timing());
    let core = Arc::new(ShadowProgram::new(&code, config.arithmetic.modes(), 0));
    let sites = core.sites.sites.len() as u32;
    let main = Arc::new(ShadowProgram::new(&main_code, config.arithmetic.modes(), sites));
    let cores = config.cores;
    let (buffer, main_buffer) = (
        Buffer::new(&setup.core.buffer, config.buffer_octets),
        Buffer::new(&setup.main.buffer, config.main.buffer_octets),
    );
    let begin = |number: u32| {
        let (code, program, buffer) =
            if number == cores { (&main_code, &main, &main_buffer) } else { (&code, &core, &buffer) };
        FrameCore {
            state: State::new(code, buffer.clone()),
            shadow: Shadow::new(program.clone(), number),
            tally: Tally::new(code),
            phase: FrameState::Ready,
            has_acted: false,
        }
    };
    let mut frame = FrameRun {
        setup,
        arithmetic,
        processors: (0..=cores).map(begin).collect(),
        inboxes: vec![VecDeque::new(); cores as usize + 1],
        memory,
        numbers: ShadowMemory::default(),
        ledger: ShadowLedger::new(core.sites.sites.len()),
        released: vec![false; cores as usize + 1],
    };
    let mut items = 0;
    loop {
        let mut has_moved = false;
        // The main processor first: it hands out the work.
        for number in (0..=cores as usize).rev() {
            let code = if number == cores as usize { &main_code } else { &code };
            let initial = if number == cores as usize { &main_buffer } else { &buffer };
            match frame.advance(number, code)? {
                Advanced::Not => {}
                Advanced::Moved => has_moved = true,
                Advanced::Halted => {
                    has_moved = true;
                    if number < cores as usize {
                        items += 1;
                        progress(items);
                        frame.end_item(number, code, initial);
                    }
                }
            }
        }
        if !has_moved && !frame.open_barrier() {
            break;
        }
    }
    if let Some(number) = frame.stuck() {
        let code = if number == cores { &main_code } else { &code };
        let pc = frame.processors[number as usize].state.pc;
        return Err(Trap::new(Fault::Deadlock, number, pc, code).into());
    }
    let main_ledger = std::mem::take(&mut frame.processors[cores as usize].shadow.ledger);
    let FrameRun { memory, numbers, ledger, .. } = frame;
    Ok(ShadowFrame { memory, numbers, core, main, ledger, main_ledger })
}

/// Motion of a processor in its turn.
enum Advanced {
    Not,
    Moved,
    Halted,
}

struct FrameRun<'a> {
    setup: &'a Setup<'a>,
    arithmetic: Watching,
    processors: Vec<FrameCore>,
    inboxes: Vec<VecDeque<(Message, u32)>>,
    memory: Memory,
    numbers: ShadowMemory,
    /// The ledger of the cores' program, which goes from core to core.
    ledger: ShadowLedger,
    released: Vec<bool>,
}

impl FrameRun<'_> {
    /// Runs a processor until it waits or halts.
    fn advance(&mut self, number: usize, code: &Code) -> Result<Advanced, RunFailure> {
        let (config, main) = (self.setup.config, self.processors.len() - 1);
        let processor = &mut self.processors[number];
        let may_try = match processor.phase {
            FrameState::Ready => true,
            FrameState::Barrier => self.released[number],
            FrameState::Rests => false,
        };
        if !may_try {
            return Ok(Advanced::Not);
        }
        let limit = if number == main { config.main.step_limit } else { config.step_limit };
        let id = CoreId { core: number as u32, cores: config.cores, step_limit: limit };
        // Lend the processor what all share
        std::mem::swap(&mut processor.shadow.global, &mut self.numbers);
        if number != main {
            std::mem::swap(&mut processor.shadow.ledger, &mut self.ledger);
        }
        let before = processor.state.steps + processor.state.inner_steps;
        let mut link = FrameLink {
            memory: &mut self.memory,
            inboxes: &mut self.inboxes,
            core: number as u32,
            largest: main as u32,
            sent: Vec::new(),
            has_acted: false,
            is_released: std::mem::take(&mut self.released[number]),
            meets: false,
        };
        let FrameCore { state, shadow, tally, .. } = processor;
        let pause = interpreter::run(code, id, state, &self.arithmetic, &mut link, tally, shadow);
        let FrameLink { sent, has_acted, meets, .. } = link;
        std::mem::swap(&mut processor.shadow.global, &mut self.numbers);
        if number != main {
            std::mem::swap(&mut processor.shadow.ledger, &mut self.ledger);
        }
        processor.has_acted |= has_acted;
        let has_moved = processor.state.steps + processor.state.inner_steps != before;
        processor.phase = if meets { FrameState::Barrier } else { FrameState::Ready };
        if pause == Pause::Halt {
            processor.phase = FrameState::Rests;
        }
        let pc = processor.state.pc;
        // Deliver the shadows of its messages beside the messages
        let letters = std::mem::take(&mut processor.shadow.outbox);
        for (to, letter) in sent.into_iter().zip(letters) {
            self.processors[to as usize].shadow.inbox.push_back(letter);
        }
        match pause {
            Pause::Halt => Ok(Advanced::Halted),
            Pause::Wait if has_moved => Ok(Advanced::Moved),
            Pause::Wait => Ok(Advanced::Not),
            Pause::Fault(fault) => Err(Trap::new(fault, number as u32, pc, code).into()),
        }
    }

    /// A core has halted: it starts over where there may be more to do.
    fn end_item(&mut self, number: usize, code: &Code, initial: &Buffer) {
        let has_main_halted = self.processors.last().is_some_and(|main| main.phase == FrameState::Rests);
        let has_letter = !self.inboxes[number].is_empty();
        let processor = &mut self.processors[number];
        if has_letter || !has_main_halted && processor.has_acted {
            processor.state.begin(code, initial);
            processor.shadow.begin();
            (processor.phase, processor.has_acted) = (FrameState::Ready, false);
        }
    }

    /// Opens the barrier where all that go on wait at it.
    fn open_barrier(&mut self) -> bool {
        let mut waiting = self.processors.iter().filter(|core| core.phase != FrameState::Rests).peekable();
        if waiting.peek().is_none() || waiting.any(|core| core.phase != FrameState::Barrier) {
            return false;
        }
        for (core, released) in self.processors.iter().zip(&mut self.released) {
            *released = core.phase == FrameState::Barrier;
        }
        true
    }

    /// A processor that waits for ever. A core that waits for work when the main processor has halted does not.
    fn stuck(&self) -> Option<u32> {
        let main = self.processors.len() - 1;
        let has_main_halted = self.processors[main].phase == FrameState::Rests;
        let waits = |core: &FrameCore| core.phase != FrameState::Rests && (core.has_acted || !has_main_halted);
        (0..=main as u32).rev().find(|&number| waits(&self.processors[number as usize]))
    }
}
