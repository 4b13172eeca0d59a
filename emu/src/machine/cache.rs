//! A core's private cache of tree nodes: which lines it holds, not what is in them, since nodes are only read.

use std::ops::{Range, RangeInclusive};

use super::config::CacheConfig;
use crate::code::quantity::Octets;

/// Use of a cache.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CacheUse {
    /// Reads that found all their lines; they take no time.
    pub hits: u64,
    /// Reads that had to get lines.
    pub misses: u64,
    /// Octets that reads through the cache asked for, hits and misses.
    pub asked: Octets,
    /// Octets of the lines that misses got over the bus.
    pub filled: Octets,
}

impl std::iter::Sum for CacheUse {
    fn sum<I: Iterator<Item = CacheUse>>(caches: I) -> CacheUse {
        caches.fold(CacheUse::default(), |total, cache| CacheUse {
            hits: total.hits + cache.hits,
            misses: total.misses + cache.misses,
            asked: total.asked + cache.asked,
            filled: total.filled + cache.filled,
        })
    }
}

/// A direct-mapped cache: the line at an address has one place, the address in lines modulo their number.
#[derive(Clone, Debug)]
pub struct Cache {
    cached: Vec<Range<u32>>,
    line: u32,
    /// Binary logarithm of the octets of a line, where it is whole.
    line_shift: Option<u32>,
    /// Number of places.
    places: usize,
    /// The line that each place holds, in pages that are there from their first line on: a cache that nobody reads costs nothing.
    pages: Vec<Option<Box<[Option<u32>; PAGE]>>>,
    used: CacheUse,
}

/// Places of a page.
const PAGE: usize = 512;

impl Cache {
    /// An empty cache for the ranges of the kind that the configuration names; `None` for a machine without caches.
    pub fn new(config: &CacheConfig, kinds: &[(Range<u32>, String)]) -> Option<Cache> {
        let count = config.octets / config.line_octets.max(1);
        let cached = kinds.iter().filter(|(_, kind)| *kind == config.kind).map(|(range, _)| range.clone()).collect();
        let places = count as usize;
        let line = config.line_octets;
        let line_shift = line.is_power_of_two().then(|| line.trailing_zeros());
        let pages = vec![None; places.div_ceil(PAGE)];
        (count != 0).then(|| Cache { cached, line, line_shift, places, pages, used: CacheUse::default() })
    }

    /// The lines that octets lie in; `None` where they are not cached. Lines of 16 octets: octets 120 to 135 lie in lines 7 and 8.
    #[inline]
    fn lines_of(&self, address: u32, octets: Octets) -> Option<RangeInclusive<u32>> {
        let end = u64::from(address) + octets.0;
        let is_in = |range: &Range<u32>| range.start <= address && end <= u64::from(range.end);
        if octets == Octets(0) || !self.cached.iter().any(is_in) {
            return None;
        }
        // Dividing takes longer than all the rest. A cached range ends within 32 bits.
        let line = |address: u32| match self.line_shift {
            Some(shift) => address >> shift,
            None => address / self.line,
        };
        Some(line(address)..=line((end - 1) as u32))
    }

    /// The place of a line.
    #[inline]
    fn place(&self, line: u32) -> usize {
        let places = self.places;
        if places.is_power_of_two() { line as usize & (places - 1) } else { line as usize % places }
    }

    /// True where a read takes no time, since the cache holds all its lines. Nothing is counted.
    #[inline]
    pub fn holds(&self, address: u32, octets: Octets) -> bool {
        let is_there = |line: u32| {
            let place = self.place(line);
            self.pages[place / PAGE].as_ref().is_some_and(|page| page[place % PAGE] == Some(line))
        };
        self.lines_of(address, octets).is_some_and(|mut lines| lines.all(is_there))
    }

    /// Counts reads that it holds, of so many octets together.
    pub fn count_hits(&mut self, hits: u64, asked: Octets) {
        self.used.hits += hits;
        self.used.asked += asked;
    }

    /// Reads octets: how many have to come over the bus, or `None` for what is not cached. Only a read that lies in a
    /// cached range altogether goes through the cache.
    pub fn read(&mut self, address: u32, octets: Octets) -> Option<Octets> {
        let lines = self.lines_of(address, octets)?;
        // Each line comes in or is there by itself.
        let mut missing = 0;
        for line in lines {
            let place = self.place(line);
            let page = self.pages[place / PAGE].get_or_insert_with(|| Box::new([None; PAGE]));
            if page[place % PAGE].replace(line) != Some(line) {
                missing += u64::from(self.line);
            }
        }
        let filled = Octets(missing);
        let used = &mut self.used;
        *if missing == 0 { &mut used.hits } else { &mut used.misses } += 1;
        used.asked += octets;
        used.filled += filled;
        Some(filled)
    }

    /// Use of the cache so far.
    pub fn used(&self) -> CacheUse {
        self.used
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_got_once_and_thrown_out_by_those_of_the_same_place() {
        let config = CacheConfig { octets: 64, line_octets: 16, ..CacheConfig::default() };
        let kinds = [(100..400, "nodes".to_owned()), (400..500, "triangles".to_owned())];
        let mut cache = Cache::new(&config, &kinds).expect("it has four lines");
        let mut read = |address, octets| cache.read(address, Octets(octets)).map(|filled| filled.0);
        // Octets, and what comes over the bus; four lines of 16, so 64 octets further on is the same place.
        assert_eq!(read(112, 4), Some(16));
        assert_eq!(read(112, 16), Some(0));
        assert_eq!(read(120, 16), Some(16), "the second of two lines");
        assert_eq!(read(176, 8), Some(16));
        assert_eq!(read(112, 1), Some(16), "it was thrown out");
        assert_eq!(read(120, 16), Some(0), "both are there again");
        assert_eq!(read(96, 8), None, "it begins before the nodes");
        assert_eq!(read(398, 8), None, "it ends after them");
        assert_eq!(read(450, 8), None, "no node");
    }

    #[test]
    fn a_machine_without_caches_has_none() {
        assert!(Cache::new(&CacheConfig::default(), &[]).is_none());
    }
}
