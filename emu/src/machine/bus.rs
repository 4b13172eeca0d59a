//! The shared bus: one burst at a time, to its end. Who comes next is the arbiter's choice.

mod ranked;
mod slots;

use super::arbiter::{Arbiter, BusRequests, NEVER, Tdma, Verdict};
use super::config::{BusConfig, protection::WORD_BITS};
use super::grant_fault::{FaultyArbiter, GrantFault};
use super::muted::MutedMasters;
use super::waits::Waits;
use crate::code::quantity::{Clocks, Octets};

pub use slots::BusMasters;

/// Use of the bus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BusUse {
    /// Clocks in which a burst held it.
    pub busy: Clocks,
    /// Octets that went over it.
    pub moved: Octets,
    /// Transfers, messages included.
    pub transfers: u64,
    /// Grants: a transfer takes one for each of its bursts.
    pub bursts: u64,
    /// Longest time from asking for a burst to its grant.
    pub longest_wait: Clocks,
}

impl BusUse {
    #[inline(always)]
    fn add(&mut self, grant: &Grant) {
        self.busy += grant.end - grant.start;
        self.moved += grant.octets;
        self.transfers += u64::from(grant.is_last);
        self.bursts += 1;
        self.longest_wait = self.longest_wait.max(grant.waited);
    }

    /// Adds a use that was noted apart.
    fn merge(&mut self, more: &BusUse) {
        self.busy += more.busy;
        self.moved += more.moved;
        self.transfers += more.transfers;
        self.bursts += more.bursts;
        self.longest_wait = self.longest_wait.max(more.longest_wait);
    }
}

/// A burst that was granted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grant {
    /// Master that got the bus.
    pub master: u32,
    /// Begin of its burst.
    pub start: Clocks,
    /// End of its burst, when the bus is free again.
    pub end: Clocks,
    /// Clocks that the master waited for it.
    pub waited: Clocks,
    /// Octets that it moves.
    pub octets: Octets,
    /// The transfer is over with it; otherwise the master asks for the next burst at its end.
    pub is_last: bool,
}

/// A burst of a transfer that has not ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Burst {
    /// Octets that it moves.
    pub octets: Octets,
    /// Octets after that.
    pub rest: Octets,
    /// Clocks for which it holds the bus.
    pub length: Clocks,
}

/// Lengths of bursts.
#[derive(Clone, Debug)]
pub struct Lengths {
    /// First bursts of the transfers of few octets, by the number of octets.
    short: Vec<Burst>,
    longest_burst: Octets,
    octets_per_beat: u64,
    /// Binary logarithm of the octets of a beat, where it is whole.
    beat_shift: Option<u32>,
    setup: Clocks,
    /// Clocks of as many beats as a word has bits, check bits among them.
    clocks_of_words: u64,
}

impl Lengths {
    /// Transfers of fewer octets are looked up.
    const SHORT: u64 = 256;

    fn new(config: &BusConfig, check_bits: u32) -> Lengths {
        let mut lengths = Lengths {
            short: Vec::new(),
            longest_burst: config.longest_burst(check_bits),
            octets_per_beat: config.octets_per_beat,
            beat_shift: config.octets_per_beat.is_power_of_two().then(|| config.octets_per_beat.trailing_zeros()),
            setup: Clocks(config.setup_clocks),
            clocks_of_words: config.clocks_of_words(check_bits),
        };
        lengths.short = (0..Lengths::SHORT).map(|octets| lengths.computed_burst(Octets(octets))).collect();
        lengths
    }

    /// The first burst of a transfer.
    #[inline(always)]
    pub fn burst(&self, transfer: Octets) -> Burst {
        match self.short.get(transfer.0 as usize) {
            Some(&burst) => burst,
            None => self.computed_burst(transfer),
        }
    }

    /// The first burst of a transfer, computed anew.
    fn computed_burst(&self, transfer: Octets) -> Burst {
        let octets = transfer.min(self.longest_burst);
        // Dividing takes longer than all the rest.
        let beats = match self.beat_shift {
            Some(shift) => (octets.0 + self.octets_per_beat - 1) >> shift,
            None => octets.0.div_ceil(self.octets_per_beat),
        };
        let clocks = Clocks((beats * self.clocks_of_words).div_ceil(WORD_BITS.into()));
        Burst { octets, rest: transfer - octets, length: self.setup + clocks }
    }
}

/// A master of the bus that may go from one transfer to the next by itself.
pub trait NextTransfer: Clone + Default {
    /// Goes on from a transfer that ended at a clock to the next one, and yields the clocks between them and its octets; `None` when something else
    /// is next.
    fn next_transfer(&mut self, end: Clocks) -> Option<(Clocks, Octets)>;

    /// Goes on while it asks before `limit`, where nobody else does, so that it never waits; with `first`, the burst that it asks for from
    /// `arrival` on. Where something else than a transfer comes next, the last burst before that is left. A master may leave all bursts.
    fn go_alone(&mut self, lengths: &Lengths, first: Burst, arrival: Clocks, limit: Clocks) -> Alone {
        let _ = (lengths, limit);
        Alone::none(first, arrival)
    }

    /// Is told how long it waited for a grant; the bus takes the longest from [`NextTransfer::longest_wait`] at the end of a serve.
    fn note_wait(&mut self, waited: Clocks);

    /// The longest wait that it was told of since [`NextTransfer::take_longest_wait`].
    fn longest_wait(&self) -> Clocks;

    /// Takes the longest wait, so that the next one begins from none.
    fn take_longest_wait(&mut self) -> Clocks;
}

/// Bursts of a master while nobody else asked.
#[derive(Clone, Copy, Debug)]
pub struct Alone {
    /// The burst that it asks for next.
    pub burst: Burst,
    /// Clock at which the master asks for that.
    pub arrival: Clocks,
    /// End of the last one.
    pub free: Clocks,
    /// Clocks for which all held the bus.
    pub held: Clocks,
    /// Octets that they moved.
    pub octets: Octets,
    /// Transfers that ended.
    pub transfers: u64,
    /// Bursts, each granted at once.
    pub bursts: u64,
}

impl Alone {
    /// No bursts before the one that is asked for.
    pub fn none(burst: Burst, arrival: Clocks) -> Alone {
        let none = Clocks(0);
        Alone { burst, arrival, free: none, held: none, octets: Octets(0), transfers: 0, bursts: 0 }
    }
}

/// A bus with its arbiter and the requests that wait for it. Nothing is known here of what is transferred, nor whether a master executes a
/// program or replays what one has done.
pub struct Bus {
    lengths: Lengths,
    arbiter: Box<dyn Arbiter>,
    pub(crate) free_at: Clocks,
    pub(super) not_before: Clocks,
    pub(crate) requests: BusRequests,
    used: BusUse,
    waits: Vec<Waits>,
    /// Fault of grants, where the bus serves its masters by itself.
    pub(super) muted: Option<MutedMasters>,
    /// The masters twice round the circle, and more: from each one on, the ranks of all.
    circle: Vec<u64>,
}

impl Bus {
    /// An idle bus for that many masters, over which each word goes with so many check bits.
    pub fn new(config: &BusConfig, check_bits: u32, masters: u32) -> Bus {
        Bus {
            lengths: Lengths::new(config, check_bits),
            arbiter: config.arbiter.build(config, masters),
            free_at: Clocks(0),
            not_before: Clocks(0),
            requests: BusRequests::new(masters),
            used: BusUse::default(),
            waits: vec![Waits::default(); masters as usize],
            muted: None,
            circle: (0..u64::from(masters)).cycle().take(4 * masters as usize).collect(),
        }
    }

    /// The bus with a fault of its grants, where there is one; it serves its masters by itself.
    #[must_use]
    pub fn with_muted(mut self, fault: Option<GrantFault>) -> Bus {
        self.muted = fault.map(MutedMasters::new);
        self
    }

    /// The bus with a fault of its grants, where there is one; it is asked burst by burst.
    #[must_use]
    pub fn with_fault(mut self, fault: Option<GrantFault>) -> Bus {
        if let Some(fault) = fault {
            self.arbiter = Box::new(FaultyArbiter::new(self.arbiter, fault));
        }
        self
    }

    /// A master begins to ask; each has at most one transfer at a time.
    #[inline]
    pub fn request(&mut self, master: u32, arrival: Clocks, octets: Octets) {
        debug_assert_eq!(self.requests.arrival(master), NEVER, "one transfer a master");
        if self.muted.is_some_and(|muted| muted.is_unheard(master)) {
            return;
        }
        self.not_before = self.not_before.min(arrival);
        self.requests.ask(master, arrival, self.lengths.burst(octets));
    }

    /// Clock at which the arbiter has something to decide, if nobody else begins to ask before.
    #[inline]
    pub fn next_decision(&self) -> Option<Clocks> {
        self.requests.first_at(self.free_at.max(self.not_before))
    }

    /// Asks the arbiter for a master at a clock that [`Bus::next_decision`] gave; `None` when it leaves the bus idle for now.
    #[inline]
    pub(super) fn ask(&mut self, clock: Clocks) -> Option<u32> {
        if self.muted.is_some_and(|muted| muted.is_stuck()) {
            return self.requests.asking(clock).next();
        }
        match self.arbiter.choose(clock, &self.requests) {
            Verdict::Grant(master) => Some(master),
            Verdict::Later(later) => {
                // Ask again when the arbiter says so, or as soon as a master comes that it has not seen.
                let others = (0..self.requests.masters()).map(|master| self.requests.arrival(master));
                let next = others.filter(|&arrival| arrival > clock).min().map_or(later, |arrival| arrival.min(later));
                // At least a clock on, so that an arbiter which errs cannot hold the machine at one clock.
                self.not_before = next.max(clock + Clocks(1));
                None
            }
        }
    }

    /// Lets the arbiter decide at a clock that [`Bus::next_decision`] gave; `None` when it leaves the bus idle for now.
    #[inline]
    pub fn decide(&mut self, clock: Clocks) -> Option<Grant> {
        let master = self.ask(clock)?;
        let waited = clock - self.requests.arrival(master);
        let Burst { octets, rest, length } = self.requests.bursts[master as usize];
        let (end, is_last) = (clock + length, rest == Octets(0));
        self.free_at = end;
        self.not_before = Clocks(0);
        if is_last {
            self.requests.withdraw(master);
        } else {
            self.requests.ask(master, end, self.lengths.burst(rest));
        }
        let grant = Grant { master, start: clock, end, waited, octets, is_last };
        self.used.add(&grant);
        self.waits[master as usize].add(waited);
        Some(grant)
    }

    /// Decides as long as that is before a clock and concerns nobody but the bus and its masters, and yields the grant that ends a transfer of a master
    /// who has something else to do then.
    pub fn serve<M: NextTransfer>(&mut self, masters: &mut BusMasters<M>, until: Clocks) -> Option<Grant> {
        // A burst that no slot has room for waits for ever, turn by turn.
        let has_room = |slots: &Tdma| slots.holds(self.lengths.burst(self.lengths.longest_burst).length);
        let may_go_ahead = self.muted.is_none() && masters.go_ahead();
        if let Some(slots) = self.arbiter.slots().filter(has_room).filter(|_| may_go_ahead) {
            return self.serve_slots(slots, masters, until);
        }
        let masters = &mut masters.all;
        while let Some(change) = self.muted.map(|muted| muted.change()).filter(|&change| change < until) {
            if let Some(grant) = self.serve_heard(masters, change) {
                return Some(grant);
            }
            if !self.mute(until) {
                return None;
            }
        }
        self.serve_heard(masters, until)
    }

    /// Service of all masters that are heard, where nobody goes ahead of the bus.
    fn serve_heard(&mut self, masters: &mut [impl NextTransfer], until: Clocks) -> Option<Grant> {
        // Clocks share their number with six bits of rank, and half of what is left is room for what this adds.
        let is_ranked =
            self.arbiter.ranking().is_some() && self.free_at < Clocks(1 << 57) && self.requests.are_before(1 << 57);
        match (is_ranked, self.requests.masters()) {
            (true, 0..=2) => self.serve_ranked::<2, _>(masters, until),
            (true, 3) => self.serve_ranked::<3, _>(masters, until),
            (true, 4..=5) => self.serve_ranked::<5, _>(masters, until),
            (true, 6..=9) => self.serve_ranked::<9, _>(masters, until),
            (true, 10..=17) => self.serve_ranked::<17, _>(masters, until),
            _ => self.serve_by_choice(masters, until),
        }
    }

    /// Service with any arbiter, which is asked turn by turn.
    pub(crate) fn serve_by_choice(&mut self, masters: &mut [impl NextTransfer], until: Clocks) -> Option<Grant> {
        while let Some(clock) = self.next_decision().filter(|&clock| clock < until) {
            let Some(grant) = self.decide(clock) else { continue };
            let master = &mut masters[grant.master as usize];
            master.note_wait(grant.waited);
            if grant.is_last {
                let Some((computing, octets)) = master.next_transfer(grant.end) else {
                    return Some(grant);
                };
                self.requests.ask(grant.master, grant.end + computing, self.lengths.burst(octets));
            }
        }
        None
    }

    /// Use of the bus so far.
    pub fn used(&self) -> BusUse {
        self.used
    }

    /// Waits of each master, burst by burst.
    pub fn waits(&self) -> &[Waits] {
        &self.waits
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_burst_is_as_long_with_a_shift_as_with_a_division() {
        for (octets_per_beat, check) in (1..10).flat_map(|octets| [0, 1, 7, 14].map(|check| (octets, check))) {
            let config = BusConfig { octets_per_beat, setup_clocks: 3, ..BusConfig::default() };
            for octets in (0..70).chain([254, 255, 256, 257, 600]) {
                let mut bus = Bus::new(&config, check, 1);
                bus.request(0, Clocks(5), Octets(octets));
                let grant = bus.decide(Clocks(5)).expect("it is alone");
                assert_eq!(grant.end - grant.start, config.length(Octets(octets), check), "{octets_per_beat} {octets}");
            }
        }
    }
}
