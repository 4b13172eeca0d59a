//! Sums of clocks while a machine runs, under the numbers that observers of programs gave to calling contexts and sites.

use super::clocks::{CallPath, ClockProfile, ProgramClocks, WorkClocks};
use super::contexts::Contexts;
use super::regions::RegionNesting;
use super::sites::{SiteTable, SiteUse, TransferSite};
use crate::code::Code;
use crate::code::quantity::{Clocks, Octets};

/// Meaning of the numbers under which a log has its sums.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ClockKeys {
    /// Paths of the calling contexts, by number.
    pub paths: Vec<CallPath>,
    /// Sites, by number.
    pub sites: Vec<TransferSite>,
}

/// Sums under the numbers of one observer of a program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LogPart {
    /// Clocks of computing by calling context and innermost region: see `Contexts::cell`.
    pub cells: Vec<u64>,
    /// By site.
    pub sites: Vec<SiteUse>,
}

/// Work of one core, by the observers that numbered it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ClockLog {
    /// By observer.
    pub parts: Vec<LogPart>,
    /// By region: inclusive work of calls that are too many to be told apart.
    pub crowded: Vec<WorkClocks>,
}

impl LogPart {
    /// The sums of a site.
    #[inline]
    pub fn site(&mut self, number: u32) -> &mut SiteUse {
        let number = number as usize;
        if self.sites.len() <= number {
            self.sites.resize(number + 1, SiteUse::default());
        }
        &mut self.sites[number]
    }

    /// Adds clocks of computing to cells.
    pub fn add_cells(&mut self, cells: &[(u32, u64)]) {
        for &(cell, clocks) in cells {
            let cell = cell as usize;
            if self.cells.len() <= cell {
                self.cells.resize(cell + 1, 0);
            }
            self.cells[cell] += clocks;
        }
    }
}

impl ClockLog {
    /// Work of the core's functions and regions. Waits and transfers are added to a profile, which has what was computed already.
    pub fn fold(&self, keys: &[ClockKeys], code: &Code, profile: &mut ClockProfile) -> ProgramClocks {
        let nesting = RegionNesting::new(code);
        let mut found = ProgramClocks::new(nesting.count());
        let stride = nesting.count() + 1;
        for (part, keys) in self.parts.iter().zip(keys) {
            for (cell, &busy) in part.cells.iter().enumerate().filter(|(_, busy)| **busy != 0) {
                let innermost = (cell % stride).checked_sub(1).map(|region| region as u16);
                let work = WorkClocks { busy: Clocks(busy), ..WorkClocks::default() };
                found.add(&keys.paths[cell / stride], nesting.chain(innermost), work);
            }
            for (site, used) in keys.sites.iter().zip(&part.sites).filter(|(_, used)| used.transfers != 0) {
                let path = &keys.paths[site.context as usize];
                found.add(path, nesting.around(site.slot), used.work());
                profile.add_site(path, code.word(site.slot), site.kind, used);
            }
        }
        found.add_crowded(&self.crowded);
        // What was computed in crowded contexts is in the profile already.
        let waits = self.crowded.iter().map(|work| WorkClocks { busy: Clocks(0), ..*work });
        profile.add_crowded(&waits.collect::<Vec<_>>());
        found
    }
}

/// Meter of the transfers of a program that is executed on a machine's clock.
#[derive(Clone, Debug, Default)]
pub struct TransferMeter {
    /// Sites of its transfers.
    pub table: SiteTable,
    /// Sums.
    pub part: LogPart,
    /// By region: waits and transfers in calls that are too many to be told apart.
    pub crowded: Vec<WorkClocks>,
    /// Site of the transfer that was asked for last.
    asked: u32,
    /// Regions that were open around it, where the calls are too many.
    open: Vec<u16>,
}

impl TransferMeter {
    /// Notes a request for octets at a site. `open` are all regions around it, where calls are too many to be told apart.
    pub fn ask(&mut self, site: u32, octets: Octets, open: Vec<u16>) {
        let asked = SiteUse { waiting: 0, transfers: 1, octets: octets.0 };
        (self.asked, self.open) = (site, open);
        self.add(asked);
    }

    /// Notes a wait for what was asked for last.
    pub fn wait(&mut self, clocks: Clocks) {
        self.add(SiteUse { waiting: clocks.0, ..SiteUse::default() });
    }

    /// The sums, with what was computed in calling contexts.
    pub fn into_log(self, contexts: &Contexts) -> ClockLog {
        let mut part = self.part;
        part.cells = contexts.cells.as_ref().map_or(Vec::new(), |cells| cells.all().to_vec());
        let mut crowded = contexts.crowded_work();
        crowded.resize(crowded.len().max(self.crowded.len()), WorkClocks::default());
        crowded.iter_mut().zip(self.crowded).for_each(|(sum, more)| *sum += more);
        ClockLog { parts: vec![part], crowded }
    }

    fn add(&mut self, more: SiteUse) {
        self.part.site(self.asked).add(more);
        for &region in &self.open {
            let region = usize::from(region);
            if self.crowded.len() <= region {
                self.crowded.resize(region + 1, WorkClocks::default());
            }
            self.crowded[region] += more.work();
        }
    }
}
