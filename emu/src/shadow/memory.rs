//! Shadows of the numbers in a memory: the local buffer of a core, or global memory.

use std::collections::BTreeMap;

use super::number::ShadowNumber;

/// Octets of the longest number.
const LONGEST: u64 = 8;

/// Shadows by the first octet of their numbers. What else the memory holds are integers, or numbers that are exact.
#[derive(Clone, Debug, Default)]
pub struct ShadowMemory {
    numbers: BTreeMap<u64, Stored>,
}

#[derive(Clone, Debug)]
struct Stored {
    octets: u32,
    number: ShadowNumber,
}

impl ShadowMemory {
    /// Shadow of the number of so many octets that was written at an address; a part of a number has none.
    pub fn get(&self, address: u32, octets: u32) -> Option<&ShadowNumber> {
        let stored = self.numbers.get(&address.into())?;
        (stored.octets == octets).then_some(&stored.number)
    }

    /// Addresses, octets and shadows of the numbers, in the order of the addresses.
    pub fn iter(&self) -> impl Iterator<Item = (u32, u32, &ShadowNumber)> {
        self.numbers.iter().map(|(address, stored)| (*address as u32, stored.octets, &stored.number))
    }

    /// Octets from an address on become integers, and with them every number of which they are a part.
    pub fn forget(&mut self, address: u32, octets: u32) {
        if octets == 0 || self.numbers.is_empty() {
            return;
        }
        let (start, end) = (u64::from(address), u64::from(address) + u64::from(octets));
        let first = start.saturating_sub(LONGEST - 1);
        let touched = self.numbers.range(first..end).filter(|(at, stored)| **at + u64::from(stored.octets) > start);
        let touched: Vec<u64> = touched.map(|(at, _)| *at).collect();
        for at in touched {
            self.numbers.remove(&at);
        }
    }

    /// A number is written; one without a shadow is an integer.
    pub fn put(&mut self, address: u32, octets: u32, number: Option<ShadowNumber>) {
        self.forget(address, octets);
        if let Some(number) = number {
            self.numbers.insert(address.into(), Stored { octets, number });
        }
    }

    /// Octets are copied from another memory: `to`, `from`, how many.
    pub fn copy(&mut self, source: &ShadowMemory, to: u32, from: u32, octets: u32) {
        self.forget(to, octets);
        let (start, end) = (u64::from(from), u64::from(from) + u64::from(octets));
        for (at, stored) in source.numbers.range(start..end) {
            if at + u64::from(stored.octets) <= end {
                self.numbers.insert(at - start + u64::from(to), stored.clone());
            }
        }
    }

    /// All numbers become integers.
    pub fn clear(&mut self) {
        self.numbers.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scaled(scale: i32) -> Option<ShadowNumber> {
        Some(ShadowNumber { scale: Some(scale), ..ShadowNumber::default() })
    }

    #[test]
    fn a_write_forgets_the_numbers_that_it_touches_and_a_copy_takes_whole_ones() {
        let mut memory = ShadowMemory::default();
        memory.put(8, 8, scaled(1));
        memory.put(16, 4, scaled(2));
        memory.put(20, 4, scaled(3));
        let scales = |memory: &ShadowMemory| memory.iter().map(|(at, ..)| at).collect::<Vec<_>>();
        assert_eq!(scales(&memory), [8, 16, 20]);
        assert_eq!(memory.get(8, 8).and_then(|number| number.scale), Some(1));
        assert!(memory.get(8, 4).is_none(), "a part of a number is none");
        let mut other = memory.clone();
        other.copy(&memory, 100, 12, 10);
        assert_eq!(scales(&other), [8, 16, 20, 104], "half a number is left behind at both ends");
        memory.forget(15, 2);
        assert_eq!(scales(&memory), [20]);
        memory.put(18, 4, None);
        assert_eq!(scales(&memory), [0u32; 0]);
    }
}
