//! Service of masters that have slots of time of their own: what one of them gets does not depend on the others, so each goes through all its
//! transfers at once. Which clocks are a master's is said by the arbiter.

use super::super::arbiter::{NEVER, Tdma};
use super::super::waits::Waits;
use super::{Burst, Bus, BusUse, Grant, NextTransfer};
use crate::code::quantity::{Clocks, Octets};

/// The masters of a bus, by number.
#[derive(Clone, Debug)]
pub struct BusMasters<M> {
    /// All of them. One that is ahead of the bus has done already what it will be granted.
    pub all: Vec<M>,
    /// Clock of the last grant of each that is ahead of the bus; [`NEVER`] for others.
    lasts: Vec<Clocks>,
    /// Way of each, of no meaning for those that are not ahead.
    walks: Vec<SlotWalk>,
    /// The masters as they were before they went ahead; none where none of them does.
    before: Vec<M>,
}

/// Way of a master through its slots, up to the grant after which something else than a transfer is next, or up to a clock.
#[derive(Clone, Debug, Default)]
struct SlotWalk {
    used: BusUse,
    waits: Waits,
    /// Grant after which something else than a transfer is next; none where the master asks for more.
    last: Option<Grant>,
    /// Clock at which it asks for that.
    arrival: Clocks,
    /// Burst that it asks for.
    burst: Burst,
}

impl<M: NextTransfer> BusMasters<M> {
    /// Masters that go on to nothing. `go_ahead` says that they may go ahead of a bus with slots of time, for which each is copied.
    pub fn new(masters: u32, go_ahead: bool) -> BusMasters<M> {
        let masters = masters as usize;
        let none = |masters: usize| (0..masters).map(|_| M::default()).collect();
        BusMasters {
            all: none(masters),
            lasts: vec![NEVER; masters],
            walks: vec![SlotWalk::default(); masters],
            before: none(if go_ahead { masters } else { 0 }),
        }
    }

    /// True where they may go ahead of the bus.
    pub fn go_ahead(&self) -> bool {
        !self.before.is_empty()
    }

    /// True where one of them is ahead of the bus.
    #[cfg(test)]
    pub fn are_ahead(&self) -> bool {
        self.lasts.iter().any(|&last| last != NEVER)
    }
}

impl Bus {
    /// Service in slots, as by [`Bus::serve`].
    ///
    /// Masters 0 and 1 with slots of 10 clocks, each of which asks from clock 0 on for transfers of 6 clocks without pauses, master 0 for two
    /// and master 1 for one: they end at 6, 26 and 16. Master 0 comes first and goes on to 26 by itself, then master 1 to 16; the grants that are
    /// reported are that of master 1 at 10, then that of master 0 at 20.
    pub(super) fn serve_slots<M: NextTransfer>(
        &mut self,
        slots: Tdma,
        masters: &mut BusMasters<M>,
        until: Clocks,
    ) -> Option<Grant> {
        // Let everybody who has begun to ask go as far as it can
        for number in 0..self.requests.masters() {
            let at = number as usize;
            if masters.lasts[at] == NEVER && self.requests.arrival(number) != NEVER {
                masters.before[at].clone_from(&masters.all[at]);
                self.walk(slots, masters, number, NEVER);
                masters.lasts[at] = masters.walks[at].last.map_or(NEVER, |last| last.start);
            }
        }
        // The first of their last grants is the next that concerns anybody else
        let (&start, at) = masters.lasts.iter().zip(0..).min()?;
        if start >= until {
            return None;
        }
        masters.lasts[at] = NEVER;
        let walk = &masters.walks[at];
        let last = walk.last?;
        self.add_walk(last.master, walk);
        self.requests.withdraw(last.master);
        self.free_at = self.free_at.max(last.end);
        Some(last)
    }

    /// Takes a master that is ahead of the bus back to what the bus has granted before a clock.
    pub fn go_back<M: NextTransfer>(&mut self, masters: &mut BusMasters<M>, number: u32, clock: Clocks) {
        let at = number as usize;
        if std::mem::replace(&mut masters.lasts[at], NEVER) == NEVER {
            return;
        }
        if let Some(slots) = self.arbiter.slots() {
            masters.all[at].clone_from(&masters.before[at]);
            self.walk(slots, masters, number, clock);
            let walk = &masters.walks[at];
            self.add_walk(number, walk);
            self.requests.ask(number, walk.arrival, walk.burst);
        }
    }

    fn add_walk(&mut self, master: u32, walk: &SlotWalk) {
        self.used.merge(&walk.used);
        self.waits[master as usize].merge(&walk.waits);
    }

    /// Goes through the bursts of a master that begin before a clock. The requests stay as they are.
    fn walk<M: NextTransfer>(&self, slots: Tdma, masters: &mut BusMasters<M>, master: u32, until: Clocks) {
        let (lengths, mut own) = (&self.lengths, slots.slots_of(master));
        let (walk, one) = (&mut masters.walks[master as usize], &mut masters.all[master as usize]);
        let (mut arrival, mut burst) = (self.requests.arrival(master), self.requests.bursts[master as usize]);
        let (mut used, mut last) = (BusUse::default(), None);
        walk.waits = Waits::default();
        loop {
            let Burst { octets, rest, length } = burst;
            let start = own.start(arrival, length);
            if start >= until {
                break;
            }
            let (waited, end, is_last) = (start - arrival, start + length, rest == Octets(0));
            let grant = Grant { master, start, end, waited, octets, is_last };
            used.add(&grant);
            walk.waits.add(waited);
            one.note_wait(waited);
            (arrival, burst) = if is_last {
                let Some((computing, octets)) = one.next_transfer(end) else {
                    last = Some(grant);
                    break;
                };
                (end + computing, lengths.burst(octets))
            } else {
                (end, lengths.burst(rest))
            };
        }
        (walk.used, walk.last, walk.arrival, walk.burst) = (used, last, arrival, burst);
    }
}
