//! Octets moved by kind of data, from the loader's names for ranges of global memory.

use std::ops::Range;

use super::frame::KindUse;
use super::station::Request;
use crate::quantity::Octets;

/// Totals by kind.
#[derive(Clone, Debug)]
pub struct Kinds {
    ranges: Vec<(Range<u32>, usize)>,
    totals: Vec<KindUse>,
    /// The range that was met last: mostly it is met again.
    last: (Range<u32>, usize),
    message: usize,
    other: usize,
}

impl Kinds {
    /// Nothing moved yet.
    pub fn new(named: &[(Range<u32>, String)]) -> Kinds {
        let mut kinds = Kinds { ranges: Vec::new(), totals: Vec::new(), last: (0..0, 0), message: 0, other: 0 };
        for (range, kind) in named {
            let number = kinds.number(kind);
            kinds.ranges.push((range.clone(), number));
        }
        kinds.ranges.sort_by_key(|(range, _)| range.start);
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

    /// Adds a transfer; one that runs over the end of a range belongs where it starts.
    pub fn add(&mut self, request: Option<Request>) {
        match request {
            Some(Request::Transfer { address, octets, .. }) => {
                let (range, kind) = self.last.clone();
                if range.contains(&address) {
                    self.totals[kind].octets += octets;
                    return;
                }
                let after = self.ranges.partition_point(|(range, _)| range.start <= address);
                let found = self.ranges[..after].last().filter(|(range, _)| range.contains(&address));
                self.totals[found.map_or(self.other, |&(_, kind)| kind)].octets += octets;
                if let Some(found) = found {
                    self.last = found.clone();
                }
            }
            Some(Request::Send { octets, .. }) => self.totals[self.message].octets += octets,
            _ => {}
        }
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
