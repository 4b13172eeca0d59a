//! Octets moved by kind of data, from the loader's names for ranges of global memory.

use std::ops::Range;

use super::outcome::KindUse;
use super::request::Request;
use crate::code::quantity::Octets;
use crate::profile::{SiteTable, TransferSite};

/// Instructions whose ranges are remembered.
const RECENT: usize = 32;

/// Totals by kind.
#[derive(Clone, Debug)]
pub struct Kinds {
    ranges: Vec<(Range<u32>, usize)>,
    totals: Vec<KindUse>,
    /// The ranges, or gaps between them, that were met last, by the instruction that asked: mostly it meets the same again.
    last: [(u32, u32, u32); RECENT],
    message: usize,
    other: usize,
}

impl Kinds {
    /// Nothing moved yet.
    pub fn new(named: &[(Range<u32>, String)]) -> Kinds {
        let mut kinds =
            Kinds { ranges: Vec::new(), totals: Vec::new(), last: [(0, 0, 0); RECENT], message: 0, other: 0 };
        for (range, kind) in named {
            let number = kinds.number(kind);
            kinds.ranges.push((range.clone(), number));
        }
        kinds.ranges.sort_by_key(|(range, _)| range.start);
        // Behind the loader's kinds, so that tables begin with those.
        kinds.message = kinds.number("messages");
        kinds.other = kinds.number("other");
        kinds
    }

    /// The place of a kind in the totals; a new one when it has none.
    fn number(&mut self, kind: &str) -> usize {
        let known = self.totals.iter().position(|total| total.kind == kind);
        known.unwrap_or_else(|| {
            self.totals.push(KindUse { kind: kind.to_owned(), octets: Octets(0) });
            self.totals.len() - 1
        })
    }

    /// Adds what the instruction at `pc` asked for; a transfer that runs over the end of a range belongs where it starts.
    #[inline(always)]
    pub fn add(&mut self, pc: u32, request: Option<Request>) {
        match request {
            Some(Request::Transfer { address, octets, .. }) => {
                let (start, length, kind) = self.last[pc as usize % RECENT];
                let is_known = address.wrapping_sub(start) < length;
                let kind = if is_known { kind as usize } else { self.find(pc, address) };
                self.totals[kind].octets += octets;
            }
            Some(Request::Send { octets, .. }) => self.totals[self.message].octets += octets,
            _ => {}
        }
    }

    /// The range around an address whose octets are of one kind, or of none: its first address, its length, and the kind.
    pub fn range(&self, address: u32) -> (u32, u32, u32) {
        let after = self.ranges.partition_point(|(range, _)| range.start <= address);
        let (start, end, kind) = match self.ranges[..after].last() {
            Some(&(Range { start, end }, kind)) if address < end => (start, end, kind),
            last => {
                // The gap between two named ranges is remembered as a range too, or each access to it would search again.
                let next = self.ranges.get(after).map_or(u32::MAX, |(range, _)| range.start);
                (last.map_or(0, |(range, _)| range.end), next, self.other)
            }
        };
        (start, end - start, kind as u32)
    }

    /// Number of the site at which an instruction makes a request of octets.
    pub fn site(&self, sites: &mut SiteTable, context: u32, slot: u32, request: Request) -> u32 {
        match request {
            Request::Transfer { address, .. } => sites.at(context, slot, address, |address| self.range(address)),
            _ => sites.number(TransferSite { context, slot, kind: self.message as u32 }),
        }
    }

    /// The kind at an address.
    #[inline(never)]
    fn find(&mut self, pc: u32, address: u32) -> usize {
        let range = self.range(address);
        self.last[pc as usize % RECENT] = range;
        range.2 as usize
    }

    /// Adds octets of a kind, as [`Kinds::range`] says it.
    pub fn add_octets(&mut self, kind: usize, octets: Octets) {
        self.totals[kind].octets += octets;
    }

    /// Nothing moved again.
    pub fn clear(&mut self) {
        for total in &mut self.totals {
            total.octets = Octets(0);
        }
    }

    /// Adds totals of the same kinds.
    pub fn merge(&mut self, totals: &[KindUse]) {
        for (total, more) in self.totals.iter_mut().zip(totals) {
            total.octets += more.octets;
        }
    }

    /// The totals so far.
    pub fn totals(&self) -> &[KindUse] {
        &self.totals
    }

    /// The totals.
    pub fn into_totals(self) -> Vec<KindUse> {
        self.totals
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::super::request::Access;
    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 300, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

        #[test]
        fn each_octet_is_of_the_range_that_it_lies_in(
            borders in prop::collection::btree_set(0u32..60, 0..8), is_high: bool,
            accesses in prop::collection::vec((0u32..70, 0u32..64, 1u32..5), 1..80),
        ) {
            // The addresses lie at one end of all or at the other.
            let base = if is_high { u32::MAX - 69 } else { 0 };
            let borders: Vec<u32> = borders.into_iter().map(|border| base + border).collect();
            let named: Vec<_> = (0..).zip(borders.chunks_exact(2)).map(|(at, pair)| (pair[0]..pair[1], format!("kind {}", at % 2))).collect();
            let (mut kinds, mut wanted) = (Kinds::new(&named), std::collections::BTreeMap::new());
            for (address, pc, octets) in accesses {
                let address = base + address;
                let found = named.iter().find(|(range, _)| range.contains(&address));
                *wanted.entry(found.map_or("other", |(_, kind)| kind)).or_insert(0) += u64::from(octets);
                let octets = Octets(octets.into());
                kinds.add(pc, Some(Request::Transfer { address, octets, access: Access::Read }));
            }
            for KindUse { kind, octets } in kinds.totals() {
                prop_assert_eq!(octets.0, wanted.get(kind.as_str()).copied().unwrap_or(0), "{}", kind);
            }
        }
    }
}
