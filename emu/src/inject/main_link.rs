//! The main processor with cores that answer at once: it hands out work item after work item, and gets what somebody else says comes of each.

use std::collections::VecDeque;
use std::ops::Range;

use crate::code::Code;
use crate::code::octets::{Buffer, Memory};
use crate::code::tally::Tally;
use crate::code::trap::{Fault, Stop};
use crate::engine::{CoreId, Pause, State, interpreter};
use crate::machine::Setup;
use crate::profile::Unobserved;
use crate::semantics::{Link, Message, Watch};

/// Course of the main processor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct MainRun {
    /// End of its program.
    pub end: Pause,
    /// Word of the instruction at which it ended.
    pub pc: u32,
    /// Instructions and steps of bodies.
    pub ticks: u64,
    /// Clocks of computing.
    pub clocks: u64,
    /// Blocks of global memory that it wrote, joined where they follow each other.
    pub writes: Vec<Range<u32>>,
}

/// Answers of a work item to the main processor, with the cores that send them; `None` where the frame ends with it.
type ItemAnswers = Option<Vec<(Message, u32)>>;

/// Gives the answers of a work item by its number, its core and its message; may change global memory.
type AnswerItem<'f> = &'f mut dyn FnMut(usize, u32, Message, &mut Memory) -> ItemAnswers;

/// The machine as the main processor sees it.
pub(super) struct MainLink<'f> {
    memory: &'f mut Memory,
    cores: u32,
    given: usize,
    answers: VecDeque<(Message, u32)>,
    item: AnswerItem<'f>,
    reads: Vec<(u32, u32)>,
    writes: Vec<Range<u32>>,
}

impl<'f> MainLink<'f> {
    /// A link to so many cores, of whose work `item` tells what comes of it.
    pub fn new(memory: &'f mut Memory, cores: u32, item: AnswerItem<'f>) -> MainLink<'f> {
        MainLink { memory, cores, given: 0, answers: VecDeque::new(), item, reads: Vec::new(), writes: Vec::new() }
    }

    fn note_written(&mut self, address: u32, octets: u32) {
        let end = address.saturating_add(octets);
        match self.writes.last_mut() {
            Some(last) if last.end == address => last.end = end,
            _ => self.writes.push(address..end),
        }
    }
}

impl Link for MainLink<'_> {
    fn load(&mut self, buffer: &mut Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        self.reads.push((from, octets));
        Ok(self.memory.read(from, buffer.slice_mut(to, octets)?)?)
    }

    fn store(&mut self, buffer: &Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        self.note_written(to, octets);
        Ok(self.memory.write(to, buffer.slice(from, octets)?)?)
    }

    fn read(&mut self, address: u32, words: &mut [i32]) -> Result<(), Stop> {
        self.reads.push((address, 4 * words.len() as u32));
        Ok(self.memory.read_words(address, words)?)
    }

    fn read_octets(&mut self, address: u32, octets: &mut [u8]) -> Result<(), Stop> {
        self.reads.push((address, octets.len() as u32));
        Ok(self.memory.read(address, octets)?)
    }

    fn write(&mut self, address: u32, words: &[i32]) -> Result<(), Stop> {
        self.note_written(address, 4 * words.len() as u32);
        Ok(self.memory.put_words(address, words)?)
    }

    fn fetch_add(&mut self, address: u32, more: i32) -> Result<i32, Stop> {
        self.reads.push((address, 4));
        self.note_written(address, 4);
        let before = self.memory.word(address)?;
        self.memory.put_words(address, &[before.wrapping_add(more)])?;
        Ok(before)
    }

    fn send(&mut self, to: i32, message: Message) -> Result<(), Stop> {
        let largest = self.cores;
        let core = u32::try_from(to).ok().filter(|&to| to <= largest);
        let core = core.ok_or(Fault::NoSuchCore { number: to, largest })?;
        if core == self.cores {
            // Its own mailbox: it comes next of all that it receives.
            self.answers.push_back((message, core));
            return Ok(());
        }
        let number = self.given;
        self.given += 1;
        let answers = (self.item)(number, core, message, self.memory).ok_or(Stop::Wait)?;
        self.answers.extend(answers);
        Ok(())
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        self.answers.pop_front().ok_or(Stop::Wait)
    }

    fn barrier(&mut self) -> Result<(), Stop> {
        Err(Stop::Wait)
    }
}

/// Runs the main processor's program, and yields its course and the blocks that it read.
pub(super) fn run_main<T: Watch>(
    setup: &Setup,
    code: &Code,
    arithmetic: &T,
    link: &mut MainLink,
    limit: u64,
) -> (MainRun, Vec<(u32, u32)>) {
    let mut state = State::new(code, Buffer::new(&setup.main.buffer, setup.config.main.buffer_octets));
    let id = CoreId { step_limit: limit, ..setup.main_id() };
    let mut tally = Tally::new(code);
    let end = interpreter::run(code, id, &mut state, arithmetic, link, &mut tally, &mut Unobserved);
    let run = MainRun {
        end,
        pc: code.word(state.pc),
        ticks: state.steps + state.inner_steps,
        clocks: state.clocks,
        writes: std::mem::take(&mut link.writes),
    };
    (run, std::mem::take(&mut link.reads))
}
