//! Injections: a flip is drawn, what it could touch is run again, and the frame is compared with the one without a fault.

use std::collections::HashMap;
use std::ops::Range;

use isa::Program;
use random::SplitMix64;

use super::flip::{BitFlip, FlipShape, REGISTER_WORDS};
use super::frame::{FaultyStore, FrameFault, HangLimit, frame_end};
use super::golden::GoldenFrame;
use super::grants::draw_grant;
use super::item::{FlipHit, ItemRun, ItemRunner, ItemTask};
use super::protection::SeenFlip;
use super::{FaultKind, Protection};
use crate::code::Code;
use crate::code::octets::Memory;
use crate::code::tally::Tally;
use crate::code::trap::Fault;
use crate::engine::Task;
use crate::machine::on_arithmetic;
use crate::profile::Observer;
use crate::replay::Replays;
use crate::semantics::Watch;

/// Flip that is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlipRequest {
    /// Structure.
    pub target: FaultKind,
    /// Number and places of bits.
    pub shape: FlipShape,
    /// Beginning of the series of random numbers from which all else is drawn.
    pub seed: u64,
    /// Protection of the structure.
    pub protection: Protection,
}

/// End of a frame with a flip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum InjectedEnd {
    /// A protection put the bits right.
    Corrected,
    /// A protection found the bits.
    Detected,
    /// The frame came to its end.
    Frame {
        /// Something was counted otherwise.
        counts_differ: bool,
        /// Global memory, where it is another one.
        memory: Option<Memory>,
    },
    /// A program trapped.
    Trap {
        /// Fault that stopped it.
        fault: Fault,
        /// Number of the core; the main processor is the number of cores.
        core: u32,
        /// Word of the instruction.
        pc: u32,
    },
    /// A program hangs.
    Hang {
        /// Limit that found it.
        limit: HangLimit,
        /// Steps of the guest: those of the work item, or of the main processor, up to the limit; of a machine those of as many work items as
        /// it had finished.
        steps: u64,
    },
}

/// A flip and what came of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InjectedFlip {
    /// The flip as it was drawn.
    pub flip: BitFlip,
    /// Place at which it met its work item.
    pub hit: FlipHit,
    /// End of the frame.
    pub end: InjectedEnd,
    /// Work items that were run again.
    pub items: u64,
}

/// Draws of a result among instructions, at most; of those that compute nothing another one is drawn.
const MOST_DRAWS: usize = 1_000;

/// Puts flips into a frame, each into a frame of its own, in the order of the requests.
pub fn inject(golden: &GoldenFrame, requests: &[FlipRequest]) -> Vec<InjectedFlip> {
    on_arithmetic(golden.setup, InjectTask { golden, requests })
}

/// Puts flips at places and moments of one's own into a frame, each into a frame of its own, without protection.
pub fn inject_at(golden: &GoldenFrame, flips: &[BitFlip]) -> Vec<InjectedFlip> {
    on_arithmetic(golden.setup, InjectAtTask { golden, flips })
}

struct InjectTask<'g> {
    golden: &'g GoldenFrame<'g>,
    requests: &'g [FlipRequest],
}

struct InjectAtTask<'g> {
    golden: &'g GoldenFrame<'g>,
    flips: &'g [BitFlip],
}

impl Task for InjectAtTask<'_> {
    type Result = Vec<InjectedFlip>;

    fn run<T: Watch + Clone + Send, O: Observer + Send>(self, arithmetic: &T) -> Self::Result {
        let mut injector = Injector::new(self.golden, arithmetic);
        self.flips.iter().map(|&flip| injector.passed(flip, flip.mask, Protection::Unprotected)).collect()
    }
}

impl Task for InjectTask<'_> {
    type Result = Vec<InjectedFlip>;

    fn run<T: Watch + Clone + Send, O: Observer + Send>(self, arithmetic: &T) -> Self::Result {
        let mut injector = Injector::new(self.golden, arithmetic);
        self.requests.iter().map(|request| injector.inject(request)).collect()
    }
}

/// Runs again what faults could touch, one fault after the other.
pub(super) struct Injector<'g, T> {
    pub(super) golden: &'g GoldenFrame<'g>,
    pub(super) arithmetic: &'g T,
    pub(super) runner: ItemRunner<'g, T>,
    /// Passes of the program without a fault, which nobody looks at.
    pub(super) tally: Tally,
    /// Work items run for the flip of now.
    pub(super) items: u64,
    /// Replays of the whole machine, made where a fault of grants asks for them first: all share what is made of the programs.
    pub(super) replays: Option<Replays<'g>>,
}

impl<'g, T: Watch> Injector<'g, T> {
    fn new(golden: &'g GoldenFrame<'g>, arithmetic: &'g T) -> Injector<'g, T> {
        let config = golden.setup.config;
        let runner = ItemRunner::new(&golden.code, arithmetic, config.buffer_octets, config.cores);
        Injector { golden, arithmetic, runner, tally: Tally::new(&golden.code), items: 0, replays: None }
    }

    fn inject(&mut self, request: &FlipRequest) -> InjectedFlip {
        let flip = self.draw(request);
        if !flip.target.has_bits() {
            return self.fault(flip, request.protection);
        }
        // What a code of words sees does not depend on what becomes of the word; a check of results needs the number.
        let seen = match flip.target {
            FaultKind::Results => SeenFlip::Passed(flip.mask),
            _ => request.protection.sees(flip.mask, 0),
        };
        let end = match seen {
            SeenFlip::Passed(mask) => return self.passed(flip, mask, request.protection),
            SeenFlip::Corrected => InjectedEnd::Corrected,
            SeenFlip::Detected => InjectedEnd::Detected,
        };
        InjectedFlip { flip, hit: self.place(&flip), end, items: 0 }
    }

    /// A flip of which a protection leaves these bits wrong.
    fn passed(&mut self, flip: BitFlip, mask: u32, protection: Protection) -> InjectedFlip {
        self.items = 0;
        let wrong = BitFlip { mask, ..flip };
        if !flip.target.has_bits() {
            return self.fault(flip, protection);
        }
        let is_lasting = flip.target.is_lasting();
        let (hit, end) = if is_lasting { self.lasting(&wrong) } else { self.passing(&wrong, protection) };
        InjectedFlip { flip, hit, end, items: self.items }
    }

    /// Draws item, moment, word and bits.
    fn draw(&mut self, request: &FlipRequest) -> BitFlip {
        let FlipRequest { target, shape, seed, .. } = *request;
        let golden = self.golden;
        let mut series = SplitMix64::new(seed);
        let mask = shape.mask(&mut series);
        if target.is_of_clocks() {
            return draw_grant(golden, target, &mut series);
        }
        let mask = if target.has_bits() { mask } else { 0 };
        let is_on_bus = matches!(target, FaultKind::Bus | FaultKind::DoubledGrant);
        let moments = golden.moments(is_on_bus).max(1);
        let words = match target {
            FaultKind::Registers => u64::from(REGISTER_WORDS),
            FaultKind::Buffer => u64::from(golden.setup.config.buffer_octets).div_ceil(4),
            FaultKind::Program => golden.code.words().into(),
            FaultKind::Memory => golden.image.size().div_ceil(4) as u64,
            _ => 1 << 32,
        };
        let word = series.below(words.max(1)) as u32;
        for _ in 0..MOST_DRAWS {
            let (item, moment) = golden.moment(series.below(moments), is_on_bus);
            let flip = BitFlip { target, item, moment, word, mask };
            if target != FaultKind::Results || self.computes(&flip) {
                return flip;
            }
        }
        BitFlip { target, item: 0, moment: 0, word, mask }
    }

    /// True where the instruction of a moment computes a result.
    fn computes(&mut self, flip: &BitFlip) -> bool {
        let Some(item) = self.golden.items.get(flip.item as usize) else { return false };
        let (core, message, memory) = (item.core, item.message, &self.golden.image);
        let task = ItemTask { limit: flip.moment, ..ItemTask::new(core, message, memory) };
        self.runner.results_at(&self.golden.code, &mut self.tally, task) != 0
    }

    /// Place at which a flip meets its work item, which nothing comes of.
    fn place(&mut self, flip: &BitFlip) -> FlipHit {
        if flip.target.is_lasting() { FlipHit::default() } else { self.item(flip.item as usize, Some(flip)).hit }
    }

    /// Runs an item of the frame without a fault again, with a flip in it.
    fn item(&mut self, number: usize, flip: Option<&BitFlip>) -> ItemRun {
        let golden = self.golden;
        let item = &golden.items[number];
        let (core, message, memory, limit) = (item.core, item.message, &golden.image, golden.limits.item);
        self.items += 1;
        let task = ItemTask { flip, limit, ..ItemTask::new(core, message, memory) };
        self.runner.run(&golden.code, &mut self.tally, task)
    }

    /// Runs an item of the frame without a fault again, with flips on the bus, or to keep the data of one of its transfers.
    pub(super) fn item_on_bus(&mut self, number: usize, bus_flips: Vec<(u64, u32)>, kept_at: Option<u64>) -> ItemRun {
        let golden = self.golden;
        let item = &golden.items[number];
        self.items += 1;
        let task = ItemTask::new(item.core, item.message, &golden.image);
        let task = ItemTask { bus_flips, kept_at, limit: golden.limits.item, ..task };
        self.runner.run(&golden.code, &mut self.tally, task)
    }

    /// A flip that is gone with its work item.
    fn passing(&mut self, flip: &BitFlip, protection: Protection) -> (FlipHit, InjectedEnd) {
        let number = flip.item as usize;
        let Some(item) = self.golden.items.get(number) else {
            return (FlipHit::default(), InjectedEnd::Frame { counts_differ: false, memory: None });
        };
        let run = self.item(number, Some(flip));
        let hit = run.hit;
        if flip.target == FaultKind::Results && protection.sees(flip.mask, hit.change) == SeenFlip::Detected {
            return (hit, InjectedEnd::Detected);
        }
        if let Some(end) = frame_end(&run, item.core) {
            return (hit, end);
        }
        let counts_differ = !run.counts_like(&item.run);
        if run.sent == item.run.sent && run.writes.is_empty() {
            return (hit, InjectedEnd::Frame { counts_differ, memory: None });
        }
        let fault = FrameFault::gone(self.golden, flip, HashMap::from([(number, run)]));
        (hit, self.frame(fault))
    }

    /// A flip that stays from its work item on: items that execute or read its word are run again, and the whole frame only where one of them
    /// answers otherwise.
    fn lasting(&mut self, flip: &BitFlip) -> (FlipHit, InjectedEnd) {
        let golden = self.golden;
        let (first, hit) = (flip.item as usize, FlipHit::default());
        let mut image = golden.image.clone();
        let (mut dirty, mut program) = (Vec::new(), None);
        match flip.target {
            FaultKind::Program => program = Some(flipped_program(golden.program(), flip)),
            _ => dirty.extend(flip_memory(&mut image, flip)),
        }
        let core = golden.items.get(first).map_or(0, |item| item.core);
        let store = program.as_ref().map(|program| {
            let code = Code::new(program, golden.setup.isa, golden.setup.config.timing());
            FaultyStore { code, core, word: flip.word }
        });
        let concerns_main = dirty.iter().any(|range| golden.concerns_main(range));
        let known = HashMap::new();
        let mut fault = FrameFault { item: first, flip, store, image, dirty, known, counts_differ: false };
        let mut is_same = !concerns_main;
        // A frame that the main processor sees otherwise is run as a whole in any case, and its items with it.
        for number in (first..golden.items.len()).take_while(|_| !concerns_main) {
            let item = &golden.items[number];
            if !fault.touches(golden, number) {
                continue;
            }
            let run = self.run_faulty(&fault, number, item.core, item.message);
            if let Some(end) = frame_end(&run, item.core) {
                return (hit, end);
            }
            fault.counts_differ |= !run.counts_like(&item.run);
            let goes_on = run.sent == item.run.sent && run.writes.is_empty();
            is_same &= goes_on;
            fault.known.insert(number, run);
            if !goes_on {
                break;
            }
        }
        if is_same {
            return (hit, InjectedEnd::Frame { counts_differ: fault.counts_differ, memory: None });
        }
        (hit, self.frame(fault))
    }
}

/// The program with a flipped word; what only people read is left out.
fn flipped_program(program: &Program, flip: &BitFlip) -> Program {
    let (mut words, buffer, entry) = (program.words.clone(), program.buffer.clone(), program.entry);
    if let Some(word) = words.get_mut(flip.word as usize) {
        *word ^= flip.mask;
    }
    Program { words, buffer, entry, ..Program::default() }
}

/// Flips bits of a word of memory, and yields its octets; bits behind the end of memory are none.
pub(super) fn flip_memory(memory: &mut Memory, flip: &BitFlip) -> Option<Range<u32>> {
    let start = 4 * flip.word;
    let octets = (memory.size() as u64).saturating_sub(start.into()).min(4) as u32;
    let mut word = memory.slice(start, octets).ok()?.into_owned();
    word.iter_mut().zip(flip.mask.to_le_bytes()).for_each(|(octet, bits)| *octet ^= bits);
    memory.write(start, &word).ok()?;
    Some(start..start + octets)
}
