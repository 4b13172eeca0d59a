//! Service of masters whom an arbiter ranks: round the circle, by number, or by when they began to ask.

use super::super::arbiter::{NEVER, Ranking};
use super::{Burst, Bus, BusUse, Grant, NextTransfer};
use crate::code::quantity::{Clocks, Octets};

impl Bus {
    /// Service with an arbiter that ranks its masters, of which there are at most `SIZE`. Where it is not simply the next in turn, the next one is
    /// found without branches, since nobody could foresee them: the smallest number of a clock and, in its last bits, a rank.
    ///
    /// A number has the clock at which a master could be served, and behind it in six bits its rank. Round the circle from master 1 on, with the bus
    /// free at clock 10, masters 0 and 2 waiting since 4 and 9, and master 1 asking from 12 on, the numbers are 10:2, 10:1 and 12:0, and
    /// the smallest, 10:1, says master 2 at clock 10. Oldest first leaves out the floor: 4:0, 12:1, 9:2 say master 0, at clock 10.
    pub(super) fn serve_ranked<const SIZE: usize, M: NextTransfer>(
        &mut self,
        all_masters: &mut [M],
        until: Clocks,
    ) -> Option<Grant> {
        // Take what the loop works on into variables of its own
        const RANK: u32 = 6;
        let masters = self.requests.masters() as usize;
        let (lengths, waits, all_masters) = (&self.lengths, &mut self.waits[..masters], &mut all_masters[..masters]);
        let (all, bursts) = (&mut self.requests.arrivals[..masters], &mut self.requests.bursts[..masters]);
        // Places behind the last master stay beyond every clock and never win.
        let mut arrivals = [NEVER.0; SIZE];
        for (arrival, Clocks(known)) in arrivals.iter_mut().zip(all.iter()) {
            *arrival = *known;
        }
        let ranking = self.arbiter.ranking();
        let mut first = match &ranking {
            Some(Ranking::Circle(turn)) => **turn as usize,
            _ => 0,
        };
        // What decides among those that wait, their rank or since when they do; and whether the rank depends on who came last.
        let by_rank = if ranking == Some(Ranking::Arrival) { 0 } else { u64::MAX };
        let is_circle = matches!(ranking, Some(Ranking::Circle(_)));
        // The longest wait is asked of the masters at the end; transfers are bursts less those (`rests`) behind which their transfer goes on.
        let mut free = self.free_at;
        let (mut busy, mut moved, mut bursts_granted, mut rests) = (Clocks(0), Octets(0), 0, 0);
        // Where nobody asks, the smallest number is beyond every clock.
        let until = until.min(Clocks(NEVER.0 >> RANK));
        let granted = loop {
            // On a full bus the next in turn mostly waits already, or the one behind it where that is the main processor, which seldom asks: it is
            // served without a comparison with the others.
            let second = if first + 1 == masters { 0 } else { first + 1 };
            let (master, start) = if is_circle && arrivals[first] <= free.0 {
                (first, free)
            } else if is_circle && arrivals[second] <= free.0 {
                (second, free)
            } else {
                // Find the smallest number by halving, without a branch
                let floor = free.0 & by_rank;
                let ranks = &self.circle[masters - first..][..SIZE];
                let mut keys: [u64; SIZE] = std::array::from_fn(|at| arrivals[at].max(floor) << RANK | ranks[at]);
                let mut left = SIZE;
                while left > 1 {
                    let half = left / 2;
                    for at in 0..half {
                        keys[at] = keys[at].min(keys[left - 1 - at]);
                    }
                    left -= half;
                }
                // Turn the rank back into a master
                let master = (keys[0] & ((1 << RANK) - 1)) as usize + first;
                (if master >= masters { master - masters } else { master }, Clocks((keys[0] >> RANK).max(free.0)))
            };
            if start >= until {
                break None;
            }
            first = if is_circle && master + 1 != masters { master + 1 } else { 0 };
            // Grant the burst
            let (burst, one) = (&mut bursts[master], &mut all_masters[master]);
            let (waited, end) = (start - Clocks(arrivals[master]), start + burst.length);
            let Burst { octets, rest, .. } = *burst;
            free = end;
            busy += burst.length;
            moved += octets;
            bursts_granted += 1;
            waits[master].add(waited);
            one.note_wait(waited);
            // Ask for what comes next: the rest of the transfer, or the next one after some computing
            let (computing, next) = if rest == Octets(0) {
                let Some(ahead) = one.next_transfer(end) else {
                    arrivals[master] = NEVER.0;
                    break Some(Grant { master: master as u32, start, end, waited, octets, is_last: true });
                };
                ahead
            } else {
                rests += 1;
                (Clocks(0), rest)
            };
            arrivals[master] = (end + computing).0;
            *burst = lengths.burst(next);
            if SIZE == 2 && masters == 2 {
                // With one rival it often asks again before that does.
                let limit = Clocks(arrivals[1 - master]).min(until);
                let alone = one.go_alone(lengths, *burst, Clocks(arrivals[master]), limit);
                if alone.bursts != 0 {
                    (free, *burst, arrivals[master]) = (alone.free, alone.burst, alone.arrival.0);
                    busy += alone.held;
                    moved += alone.octets;
                    bursts_granted += alone.bursts;
                    rests += alone.bursts - alone.transfers;
                    waits[master].add_none(alone.bursts);
                }
            }
        };
        // Put back what has changed
        for (arrival, known) in arrivals.iter().zip(all) {
            *known = Clocks(*arrival);
        }
        if let Some(Ranking::Circle(turn)) = ranking {
            *turn = first as u32;
        }
        let longest_wait = all_masters.iter().map(|one| one.longest_wait()).max().unwrap_or_default();
        let transfers = bursts_granted - rests;
        self.used.merge(&BusUse { busy, moved, transfers, bursts: bursts_granted, longest_wait });
        (self.free_at, self.not_before) = (free, Clocks(0));
        granted
    }
}
