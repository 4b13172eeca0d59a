//! Recorded transfers, one after the other, as long as nothing but the arbiter stands between them: the processor that goes through them
//! hands them over when it asks for a transfer, and takes them back when something else is next.

use std::hint::black_box;
use std::ops::Range;
use std::sync::Arc;

use super::recording::{Segment, Stretch, Track};
use crate::code::quantity::{Clocks, Octets};
use crate::machine::arbiter::NEVER;
use crate::machine::bus::{Alone, Burst, Lengths, NextTransfer};
use crate::machine::cache::Cache;
use crate::machine::worker::{HandOver, ItemMaster, Played};

/// Track that a master of the bus goes through by itself; none at first.
#[derive(Clone, Debug)]
pub struct BusCursor {
    /// The track; none while its processor goes through it.
    track: Option<Arc<Track>>,
    /// Number of the next segment in the track; the one before it is the transfer that the master asks for.
    next: usize,
    /// The stretch of the track that it goes through.
    stretch: Stretch,
    /// Clocks of computing before the next transfer; [`NEVER`] where something else comes next.
    computing: Clocks,
    /// Octets of the next transfer; of no meaning with a cache, which says so when the transfer is asked for.
    ahead: Octets,
    /// Clock at which it was handed over.
    start: Clocks,
    /// Clock at which the transfer that is on its way was asked for.
    asked: Clocks,
    /// Clocks of computing since then.
    busy: Clocks,
    /// Waits by site, where clocks of functions are measured; else none.
    waits: Vec<u64>,
    /// The longest wait of the master for a grant that its processor was not told of.
    longest_wait: Clocks,
    /// A core with a cache, or with loads that it does not wait for; none where every read is a transfer and is waited for.
    beside: Option<Box<BesideTransfers>>,
}

/// Reads that take no time and loads that are not waited for, on the way of a bus cursor.
#[derive(Clone, Debug, Default)]
struct BesideTransfers {
    cache: Option<Cache>,
    /// Loads are not waited for.
    overlaps: bool,
    /// The transfer that is on its way is a load that is not waited for.
    is_ahead: bool,
    /// Reads that the cache answers before the next transfer, by number of the segment.
    hits: Range<usize>,
    /// Octets of those.
    hit_octets: Octets,
    /// Clocks of computing from the first of them on.
    after_hit: Clocks,
    /// Reads that the cache answered before the transfer that is on its way.
    answered: Range<usize>,
    /// One of those reads what was written meanwhile.
    is_lost: bool,
}

/// Account of a track that a bus cursor hands back to its processor.
pub struct HandedBack {
    /// Number of the next segment in the track.
    pub next: usize,
    /// Clocks since the track was handed over.
    pub played: Played,
    /// Waits by site, where clocks of functions are measured.
    pub waits: Vec<u64>,
    /// Cache of the core.
    pub cache: Option<Cache>,
    /// The track has read what was written meanwhile, so that it is worth nothing.
    pub is_lost: bool,
}

/// Adds the wait for a segment's transfer to those of its site, where clocks of functions are measured. What was asked for is the same on
/// every machine, so only waits are added up here.
#[inline(always)]
fn add_wait(waits: &mut [u64], track: &Track, at: usize, waiting: Clocks) {
    if let Some(&site) = track.sites.get(at)
        && let Some(sum) = waits.get_mut(site as usize)
    {
        *sum += waiting.0;
    }
}

/// Clocks of computing before a transfer that reads, and its octets; [`NEVER`] before anything else.
#[inline(always)]
fn ahead_of(segments: &[Segment], next: usize) -> (Clocks, Octets) {
    match segments.get(next) {
        Some(segment) if segment.is_read() => (Clocks(segment.clocks.into()), segment.octets()),
        _ => (NEVER, Octets(0)),
    }
}

/// Reads a little of each line of the host's cache that the first segments take, 64 lines at most, so that it waits for many of them at once. The bus's
/// loop, which decides on each segment, would wait for one after the other.
fn warm(segments: &[Segment]) {
    const { assert!(size_of::<Segment>() <= 64, "a line has one at least") }
    const LINE: usize = 64 / size_of::<Segment>();
    const MOST: usize = 64 * LINE;
    let first = &segments[..segments.len().min(MOST)];
    black_box(first.iter().step_by(LINE).fold(0, |all, segment| all ^ segment.clocks));
}

/// True where two ranges have an octet in common.
pub fn overlap(one: &Range<u64>, other: &Range<u64>) -> bool {
    one.start.max(other.start) < one.end.min(other.end)
}

impl Default for BusCursor {
    fn default() -> BusCursor {
        let none = Clocks(0);
        let (computing, ahead) = (NEVER, Octets(0));
        BusCursor {
            track: None,
            next: 0,
            stretch: Stretch::default(),
            computing,
            ahead,
            start: none,
            asked: none,
            busy: none,
            waits: Vec::new(),
            longest_wait: none,
            beside: None,
        }
    }
}

impl BesideTransfers {
    /// Looks for the next transfer behind reads that the cache answers, and gives the clocks of computing before the first of all of them. What it
    /// looks at does not change the cache; [`NEVER`] where something else than a transfer comes behind them.
    ///
    /// Reads after 3, 4 and 5 clocks, of which the cache answers the first two, are one transfer with 3 clocks before it and 9 after a hit.
    fn look(&mut self, segments: &[Segment], next: usize) -> Clocks {
        (self.hits, self.hit_octets, self.after_hit) = (next..next, Octets(0), Clocks(0));
        let mut first = None;
        for (at, segment) in segments.iter().enumerate().skip(next) {
            if !segment.is_read() {
                break;
            }
            let clocks = Clocks(segment.clocks.into());
            match first {
                None => first = Some(clocks),
                Some(_) => self.after_hit += clocks,
            }
            let octets = segment.octets();
            if !self.cache.as_ref().is_some_and(|cache| cache.holds(segment.address, octets)) {
                self.hits.end = at;
                return first.unwrap_or(NEVER);
            }
            self.hit_octets += octets;
        }
        NEVER
    }

    /// Goes on from a transfer that was asked for at a clock and has ended to the next one, which was found with so many clocks of computing
    /// before it and before what the cache answers; yields the clock at which it is asked for, the clocks that the last one was waited for,
    /// and the octets that go over the bus.
    ///
    /// A load asked for at 10 that ends at 18, with 3 clocks before a hit and 9 after that: computing from 10 to 13, waiting for 5, hitting at
    /// 18, asking at 27. Where loads are waited for: waiting for 8, hitting at 21, asking at 30.
    fn go_on(&mut self, [asked, end, computing]: [Clocks; 3], segment: &Segment) -> (Clocks, Clocks, Octets) {
        let begin = if self.is_ahead { asked } else { end };
        let waiting = if self.is_ahead { end.max(asked + computing) - (asked + computing) } else { end - asked };
        if let Some(cache) = &mut self.cache {
            cache.count_hits(self.hits.len() as u64, self.hit_octets);
        }
        let missed = self.cache.as_mut().and_then(|cache| cache.read(segment.address, segment.octets()));
        self.answered = self.hits.clone();
        self.is_ahead = self.overlaps && segment.is_load();
        (end.max(begin + computing) + self.after_hit, waiting, missed.unwrap_or(segment.octets()))
    }
}

impl BusCursor {
    /// Takes over a track, when its processor begins to ask for the last of the segments that are behind it, with waits by site where
    /// clocks of functions are measured.
    pub fn begin(&mut self, (track, stretch): (Arc<Track>, Stretch), next: usize, transfer: HandOver, waits: Vec<u64>) {
        let HandOver { clock, overlaps, cache, .. } = transfer;
        (self.next, self.start, self.asked, self.busy, self.waits) = (next, clock, clock, Clocks(0), waits);
        self.stretch = stretch;
        if next == self.stretch.segments.start + 1 {
            warm(&track.segments[self.stretch.segments.clone()]);
        }
        if overlaps || cache.is_some() {
            // The box stays from one work item to the next.
            let beside = self.beside.get_or_insert_default();
            beside.overlaps = overlaps;
            beside.is_ahead = overlaps && track.segments.get(next - 1).is_some_and(Segment::is_load);
            (beside.answered, beside.is_lost, beside.cache) = (0..0, false, cache.take());
        }
        self.track = Some(track);
        self.look();
    }

    #[inline(always)]
    fn look(&mut self) {
        let end = self.stretch.segments.end;
        let segments = self.track.as_ref().map_or(&[][..], |track| &track.segments[..end]);
        match &mut self.beside {
            None => (self.computing, self.ahead) = ahead_of(segments, self.next),
            Some(beside) => self.computing = beside.look(segments, self.next),
        }
    }

    /// Hands the track back when its transfer has ended at a clock; `None` where its processor goes through it.
    pub fn end(&mut self, clock: Clocks) -> Option<HandedBack> {
        let track = self.track.take()?;
        self.computing = NEVER;
        let (mut cache, mut is_ahead, mut is_lost) = (None, false, false);
        if let Some(beside) = &mut self.beside {
            (cache, is_ahead, is_lost) = (beside.cache.take(), beside.is_ahead, beside.is_lost);
        }
        // A core that has not waited for its load has computed since it asked for that, and will be told how long it waited.
        let clock = if is_ahead { self.asked } else { clock };
        let mut waits = std::mem::take(&mut self.waits);
        add_wait(&mut waits, &track, self.next - 1, clock - self.asked);
        let played = Played { busy: self.busy, waiting: clock - self.start - self.busy, clock, is_ahead };
        Some(HandedBack { next: self.next, played, waits, cache, is_lost })
    }

    /// Goes on with a cache, or with loads that are not waited for.
    #[inline(never)]
    fn next_beside(&mut self, end: Clocks) -> Option<(Clocks, Octets)> {
        let (track, beside) = (self.track.as_ref()?, self.beside.as_mut()?);
        let segment = track.segments.get(beside.hits.end)?;
        let (asked, waiting, octets) = beside.go_on([self.asked, end, self.computing], segment);
        // What the cache answered was not waited for.
        add_wait(&mut self.waits, track, self.next - 1, waiting);
        self.busy += self.computing + beside.after_hit;
        (self.next, self.asked) = (beside.hits.end + 1, asked);
        self.look();
        Some((asked - end, octets))
    }
}

impl ItemMaster for BusCursor {
    fn depends_on(&self, written: &Range<u64>) -> bool {
        self.track.is_some() && overlap(&self.stretch.reads, written)
    }

    fn stop_at(&mut self, written: &Range<u64>) {
        self.computing = NEVER;
        if let (Some(beside), Some(track)) = (&mut self.beside, &self.track) {
            // The cache may have answered that later than it was written.
            let answered = track.segments.get(beside.answered.clone()).unwrap_or_default();
            beside.is_lost |= answered.iter().any(|segment| overlap(&segment.range(), written));
        }
    }
}

impl NextTransfer for BusCursor {
    #[inline(always)]
    fn next_transfer(&mut self, end: Clocks) -> Option<(Clocks, Octets)> {
        // What comes next was worked out when the last transfer began, so that the bus's loop need not wait for it.
        let (computing, ahead) = (self.computing, self.ahead);
        if computing == NEVER {
            return None;
        }
        if self.beside.is_some() {
            return self.next_beside(end);
        }
        self.busy += computing;
        if let Some(track) = &self.track {
            add_wait(&mut self.waits, track, self.next - 1, end - self.asked);
        }
        self.asked = end + computing;
        self.next += 1;
        self.look();
        Some((computing, ahead))
    }

    #[inline(never)]
    fn go_alone(&mut self, lengths: &Lengths, first: Burst, arrival: Clocks, limit: Clocks) -> Alone {
        // Copy the state, so that it stays in registers
        let mut alone = Alone::none(first, arrival);
        if self.beside.is_some() {
            return alone;
        }
        let Some(track) = &self.track else { return alone };
        let segments = &track.segments[..self.stretch.segments.end];
        let (mut next, mut computing, mut ahead) = (self.next, self.computing, self.ahead);
        let before = (next, arrival);
        // Take burst after burst; each begins when it is asked for, because nobody else holds the bus
        while alone.arrival < limit {
            let Burst { octets, rest, length } = alone.burst;
            let is_last = rest == Octets(0);
            if is_last && computing == NEVER {
                break;
            }
            alone.free = alone.arrival + length;
            alone.held += length;
            alone.octets += octets;
            alone.bursts += 1;
            if !is_last {
                (alone.burst, alone.arrival) = (lengths.burst(rest), alone.free);
                continue;
            }
            (alone.burst, alone.arrival) = (lengths.burst(ahead), alone.free + computing);
            add_wait(&mut self.waits, track, next - 1, alone.free - self.asked);
            self.asked = alone.arrival;
            next += 1;
            (computing, ahead) = ahead_of(segments, next);
        }
        // Put back what has changed: all that was not holding the bus was computing
        alone.transfers = (next - before.0) as u64;
        self.busy += alone.arrival - before.1 - alone.held;
        (self.next, self.computing, self.ahead) = (next, computing, ahead);
        alone
    }

    #[inline(always)]
    fn note_wait(&mut self, waited: Clocks) {
        self.longest_wait = self.longest_wait.max(waited);
    }

    #[inline(always)]
    fn longest_wait(&self) -> Clocks {
        self.longest_wait
    }

    fn take_longest_wait(&mut self) -> Clocks {
        std::mem::take(&mut self.longest_wait)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;
    use crate::machine::GrantFault;
    use crate::machine::arbiter::ArbiterKind;
    use crate::machine::bus::{Bus, BusMasters};
    use crate::machine::config::{BusConfig, CacheConfig};
    use crate::machine::request::{Access, Request};

    /// A clock behind everything.
    const END: u64 = 1 << 32;

    /// A stretch that reads what these segments say, clocks of computing and octets, between segments of other items.
    fn track(segments: &[(u64, u64)]) -> (Arc<Track>, Stretch) {
        let segment = |&(clocks, octets): &(u64, u64)| {
            let access = if clocks % 3 == 0 { Access::Read } else { Access::Load };
            let request = Request::Transfer { address: clocks as u32 % 4 * 16, octets: Octets(octets), access };
            Segment::new(clocks, 0, request, 0).expect("it fits")
        };
        let all: Vec<Segment> = [(1, 1)].iter().chain(segments).chain(&[(1, 1)]).map(segment).collect();
        let (sites, stretch) = ((0..).take(all.len()).collect(), 1..all.len() - 1);
        (Arc::new(Track { segments: all, sites }), Stretch { segments: stretch, reads: 0..128 })
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 1_000, rng_seed: RngSeed::Fixed(3), ..ProptestConfig::default() })]

        /// All that a bus does by itself, it does as if the arbiter had been asked each time.
        #[test]
        fn ranks_and_masters_alone_are_short_cuts(
            kind in prop::sample::select(&ArbiterKind::ALL[..]),
            masters in 1u32..6, burst_octets in 0u64..30, setup_clocks in 0u64..4, check in prop::sample::select(vec![0u32, 0, 7]),
            overlaps: bool, octets in prop::sample::select(vec![0, 64]),
            mut items in prop::collection::vec(
                (0u32..6, 0u64..40, prop::collection::vec((0u64..30, 0u64..60), 1..8), 0u64..200, prop::option::of(0u32..6)), 1..20,
            ),
            fault in prop::option::of((0u8..3, 0u64..500, 0u32..6, 0u64..80)),
        ) {
            let config = BusConfig { arbiter: kind, burst_octets, setup_clocks, ..BusConfig::default() };
            let fault = fault.map(|(kind, at, master, retry)| GrantFault::numbered(kind, at, master % masters, retry));
            let new = || (Bus::new(&config, check, masters), BusMasters::<BusCursor>::new(masters, true));
            let ((quick, mut cursors), (plain, mut plain_cursors)) = (new(), new());
            let (mut quick, mut plain) = (quick.with_muted(fault), plain.with_fault(fault));
            let (mut now, mut ends) = (Clocks(0), vec![Clocks(0); masters as usize]);
            items.push((0, 0, vec![(0, 1)], END, None));
            for (master, pause, segments, time, stopped) in items {
                let master = master % masters;
                let arrival = (now + Clocks(pause)).max(ends[master as usize]);
                if plain.requests.arrival(master) == NEVER {
                    let item = track(&segments);
                    for (bus, cursors) in [(&mut quick, &mut cursors), (&mut plain, &mut plain_cursors)] {
                        let cursor = &mut cursors.all[master as usize];
                        let _ = cursor.end(arrival);
                        bus.request(master, arrival, item.0.segments[1].octets());
                        let (clock, written) = (arrival, &(0..0));
                        let kinds = [(0..128, "nodes".to_owned())];
                        let mut cache = Cache::new(&CacheConfig { octets, line_octets: 16, ..CacheConfig::default() }, &kinds);
                        let transfer = HandOver { clock, written, overlaps, cache: &mut cache };
                        cursor.begin(item.clone(), 2, transfer, vec![0; 9]);
                    }
                }
                // Anybody, who may be in the middle of an item.
                if let Some(stopped) = stopped {
                    let stopped = stopped % masters;
                    quick.go_back(&mut cursors, stopped, now);
                    for cursors in [&mut cursors, &mut plain_cursors] {
                        let cursor = &mut cursors.all[stopped as usize];
                        if cursor.depends_on(&(0..1)) {
                            cursor.stop_at(&(0..1));
                        }
                    }
                }
                now = arrival + Clocks(time);
                loop {
                    let grant = quick.serve(&mut cursors, now);
                    prop_assert_eq!(grant, plain.serve_by_choice(&mut plain_cursors.all, now));
                    if let Some(grant) = grant {
                        let cursor = &cursors.all[grant.master as usize];
                        prop_assert!(cursor.next <= cursor.stretch.segments.end);
                        ends[grant.master as usize] = grant.end;
                    }
                    // Who is ahead of the bus is compared when it has caught up, at the end at the latest.
                    if cursors.are_ahead() {
                        prop_assert!(grant.is_some() || time < END);
                        if grant.is_none() {
                            break;
                        }
                        continue;
                    }
                    prop_assert_eq!(quick.used(), plain.used());
                    prop_assert_eq!(quick.waits(), plain.waits());
                    prop_assert_eq!(format!("{:?}", cursors.all), format!("{:?}", plain_cursors.all));
                    prop_assert!(fault.is_some() || quick.free_at == plain.free_at);
                    for master in 0..masters {
                        // A request that the fault leaves unheard is withdrawn.
                        let (found, wanted) = (quick.requests.arrival(master), plain.requests.arrival(master));
                        prop_assert!(found == wanted || fault.is_some() && found == NEVER);
                    }
                    if grant.is_none() {
                        break;
                    }
                }
            }
        }
    }
}
