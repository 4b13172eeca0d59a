//! Sites of transfers: an instruction that asks, in a calling context, for data of a kind. Each has a number, by which a recording says what
//! a transfer was for, and under which a machine adds up waits.

use std::collections::HashMap;

use super::clocks::WorkClocks;
use crate::code::quantity::{Clocks, Octets};

/// Places in which the sites that were met last are remembered.
const RECENT: usize = 256;

/// A site.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TransferSite {
    /// Number of the calling context.
    pub context: u32,
    /// Slot of the instruction.
    pub slot: u32,
    /// Number of the kind of data.
    pub kind: u32,
}

/// Transfers that a site asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SiteAsked {
    /// Number of transfers.
    pub transfers: u64,
    /// Octets of those.
    pub octets: u64,
}

impl SiteAsked {
    /// Adds more of the same site.
    #[inline]
    pub fn add(&mut self, more: SiteAsked) {
        self.transfers += more.transfers;
        self.octets += more.octets;
    }

    /// All of it as work, with clocks from requests to the ends of their transfers.
    pub fn work(&self, waiting: u64) -> WorkClocks {
        let (waiting, octets) = (Clocks(waiting), Octets(self.octets));
        WorkClocks { busy: Clocks(0), waiting, transfers: self.transfers, octets }
    }
}

/// A site that was met, with the addresses of its kind of data.
#[derive(Clone, Copy, Debug, Default)]
struct RecentSite {
    context: u32,
    slot: u32,
    start: u32,
    /// Octets from the start on; 0 for nothing that is remembered.
    length: u32,
    number: u32,
}

/// The sites that a program was seen at.
#[derive(Clone, Debug)]
pub struct SiteTable {
    sites: Vec<TransferSite>,
    numbers: HashMap<TransferSite, u32>,
    recent: Box<[RecentSite; RECENT]>,
}

impl Default for SiteTable {
    fn default() -> SiteTable {
        SiteTable {
            sites: Vec::new(),
            numbers: HashMap::new(),
            recent: vec![RecentSite::default(); RECENT].try_into().expect("it has that length"),
        }
    }
}

impl SiteTable {
    /// Number of a site.
    pub fn number(&mut self, site: TransferSite) -> u32 {
        let sites = &mut self.sites;
        *self.numbers.entry(site).or_insert_with(|| {
            sites.push(site);
            sites.len() as u32 - 1
        })
    }

    /// Number of the site of a transfer at an address. `range` says which addresses around one have data of its kind: the first, their number,
    /// the kind.
    #[inline]
    pub fn at(&mut self, context: u32, slot: u32, address: u32, range: impl FnOnce(u32) -> (u32, u32, u32)) -> u32 {
        let place = slot.wrapping_add(context.wrapping_mul(37)) as usize % RECENT;
        let recent = &self.recent[place];
        if (recent.context, recent.slot) == (context, slot) && address.wrapping_sub(recent.start) < recent.length {
            return recent.number;
        }
        let (start, length, kind) = range(address);
        let number = self.number(TransferSite { context, slot, kind });
        self.recent[place] = RecentSite { context, slot, start, length, number };
        number
    }

    /// The sites, by number.
    pub fn all(&self) -> &[TransferSite] {
        &self.sites
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sites_differ_by_context_slot_and_kind() {
        let mut table = SiteTable::default();
        let range = |address: u32| if address < 100 { (0, 100, 0) } else { (100, 1000, 1) };
        let mut at = |context, slot, address| table.at(context, slot, address, range);
        let found = [at(1, 7, 4), at(1, 7, 8), at(2, 7, 8), at(1, 7, 104), at(1, 8, 4), at(1, 7, 4), at(2, 7, 0)];
        assert_eq!(found, [0, 0, 1, 2, 3, 0, 1]);
        assert_eq!(table.all()[2], TransferSite { context: 1, slot: 7, kind: 1 });
    }
}
