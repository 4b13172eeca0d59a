//! A group of work items in lock-step: which lanes are where, block after block. It stops at anything unusual, and what it
//! did is then worth nothing; the rows themselves are executed in [`super::rows`].

use super::lanes::{LANES, Lanes, Mask, each};
use super::meter::{Meter, Total};
use super::origins::Origins;
use super::plan::Plan;
use crate::checked::Seat;
use crate::exec::Link;
use crate::octets::Buffer;

/// Depth of the calls at the beginning: there is room for returns without a call.
const MIDDLE: u32 = 1 << 31;

/// Something that lock-step leaves to the interpreter: a fault, the step limit, something that the machine does not give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unusual;

/// When and where a lane asks the machine for something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moment {
    /// Word of the instruction.
    pub pc: u32,
    /// Clocks that the lane has computed so far.
    pub clocks: u64,
}

/// The machine as a group sees it. What it cannot give at once, it refuses.
pub trait Wires {
    /// The link of a lane.
    fn link(&mut self, lane: usize, moment: Moment) -> impl Link;

    /// The link of some lanes that ask for the same, and read it.
    fn links(&mut self, mask: Mask, moments: impl Fn(usize) -> Moment) -> impl Link;
}

/// Some lanes at a word, in calls as deep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Party {
    /// Calls that have not returned, most first; then words, lowest first. Those that go first are met by the others.
    rank: u64,
    mask: Mask,
}

impl Party {
    #[inline(always)]
    fn new(depth: u32, pc: u32, mask: Mask) -> Party {
        Party { rank: u64::from(!depth) << 32 | u64::from(pc), mask }
    }
}

/// Lanes that wait for their turn, the next ones last.
#[derive(Clone, Debug, Default)]
struct Queue(Vec<Party>);

impl Queue {
    #[inline(always)]
    fn push(&mut self, party: Party) {
        match self.0.iter().rposition(|other| other.rank >= party.rank) {
            Some(at) if self.0[at].rank == party.rank => self.0[at].mask |= party.mask,
            Some(at) => self.0.insert(at + 1, party),
            None => self.0.insert(0, party),
        }
    }
}

/// Work items in lock-step, with all that they change.
#[derive(Clone, Debug)]
pub struct Group {
    /// Their registers.
    pub lanes: Lanes,
    /// Their local buffers.
    pub buffers: Vec<Buffer>,
    /// What they take.
    pub meter: Meter,
    /// Lanes that execute.
    pub mask: Mask,
    /// Word that they execute.
    pub pc: u32,
    /// End of the block.
    pub end: u32,
    /// Calls that have not returned, from [`MIDDLE`] on; it only decides who goes first.
    pub depth: u32,
    /// Who and where they are.
    pub seat: Seat,
    /// Where lanes go from here, set by a row that chooses.
    pub next: [u32; LANES],
    /// Where each lane halted.
    pub halted_at: [u32; LANES],
    /// What of them depends on the cores.
    pub origins: Origins,
    queue: Queue,
    /// Words that the group has executed, with however many lanes.
    pub steps: u64,
}

impl Group {
    /// A group on a program, its buffers as they are at first.
    pub fn new(plan: &Plan, seat: Seat, initial: &Buffer) -> Group {
        Group {
            lanes: Lanes::default(),
            buffers: vec![initial.clone(); LANES],
            meter: Meter::new(plan),
            mask: 0,
            pc: 0,
            end: 0,
            depth: 0,
            seat,
            next: [0; LANES],
            halted_at: [0; LANES],
            origins: Origins::default(),
            queue: Queue::default(),
            steps: 0,
        }
    }

    /// The lanes of a set after reset, at the program's first word.
    pub fn begin(&mut self, plan: &Plan, initial: &Buffer, mask: Mask) {
        self.lanes.reset();
        for buffer in &mut self.buffers {
            buffer.reset_to(initial);
        }
        self.meter.reset();
        self.origins.reset();
        self.steps = 0;
        self.queue.0.clear();
        self.queue.push(Party::new(MIDDLE, plan.code.program.entry, mask));
    }

    /// Goes to the next block: sets its lanes and its words, and counts it. False when all lanes have halted.
    #[inline(always)]
    pub(super) fn begin_block<C: Counting>(&mut self, plan: &Plan) -> Result<bool, Unusual> {
        let Some(Party { rank, mask }) = self.queue.0.pop() else { return Ok(false) };
        let pc = rank as u32;
        self.depth = !((rank >> 32) as u32);
        let place = plan.place(pc).ok_or(Unusual)?;
        (self.pc, self.mask, self.end) = (pc, mask, place.end);
        // The group's instructions are never fewer than those of one of its lanes.
        self.steps += u64::from(place.end - pc);
        if self.steps > self.seat.step_limit {
            return Err(Unusual);
        }
        if C::IS_ON {
            self.meter.begin(pc, mask, plan.toll(pc, place.end), place.most);
            self.origins.follow(plan, pc..place.end, mask);
        }
        Ok(true)
    }

    /// What a lane took.
    pub fn total(&self, lane: usize) -> Total {
        self.meter.total(lane)
    }

    /// The moment of a lane at the current word.
    #[inline(always)]
    pub fn moment(&self, plan: &Plan, lane: usize) -> Moment {
        let rest = plan.toll(self.pc, self.end);
        Moment { pc: self.pc, clocks: self.meter.clocks_before(lane, rest) }
    }

    /// The registers, the buffer of a lane, and the moments of all at the current word.
    #[inline(always)]
    pub(super) fn parts<C: Counting>(
        &mut self,
        plan: &Plan,
        lane: usize,
    ) -> (&mut Lanes, &mut Buffer, impl Fn(usize) -> Moment) {
        let Group { lanes, buffers, meter, mask, pc, end, .. } = self;
        let (pc, rest, meter, mask) = (*pc, plan.toll(*pc, *end), &*meter, *mask);
        let clocks = move |lane| if C::IS_ON { meter.clocks_before(lane, rest) } else { 0 };
        let moment = move |lane: usize| {
            debug_assert!(mask >> lane & 1 == 1, "only lanes that execute are at a word");
            Moment { pc, clocks: clocks(lane) }
        };
        (lanes, &mut buffers[lane], moment)
    }

    /// The lanes of the block go to one word.
    #[inline]
    pub(super) fn go(&mut self, pc: u32) {
        self.queue.push(Party::new(self.depth, pc, self.mask));
    }

    /// They go to two words: those of the set to the first.
    #[inline(never)]
    pub(super) fn fork(&mut self, first: Mask, pc: u32, other: u32) {
        let (here, there) = (self.mask & first, self.mask & !first);
        if here != 0 {
            self.queue.push(Party::new(self.depth, pc, here));
        }
        if there != 0 {
            self.queue.push(Party::new(self.depth, other, there));
        }
    }

    /// Each goes where [`Group::next`] says.
    #[inline(never)]
    pub(super) fn scatter(&mut self) {
        let mut rest = self.mask;
        while rest != 0 {
            let pc = self.next[rest.trailing_zeros() as usize];
            let here = super::lanes::where_true(|lane| self.next[lane] == pc) & rest;
            self.queue.push(Party::new(self.depth, pc, here));
            rest &= !here;
        }
    }

    /// They halt.
    #[inline(never)]
    pub(super) fn halt(&mut self) {
        for lane in each(self.mask) {
            self.halted_at[lane] = self.pc;
        }
    }
}

/// Whether passes, clocks and steps are counted.
pub trait Counting {
    /// Whether they are.
    const IS_ON: bool;
}

/// They are.
#[derive(Clone, Copy, Debug)]
pub struct Counted;

/// They are not: for measuring what counting costs.
#[derive(Clone, Copy, Debug)]
pub struct Uncounted;

impl Counting for Counted {
    const IS_ON: bool = true;
}

impl Counting for Uncounted {
    const IS_ON: bool = false;
}
