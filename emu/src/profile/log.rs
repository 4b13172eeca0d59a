//! Sums of clocks while a machine runs, under the numbers that observers of programs gave to calling contexts and sites.

use super::clocks::{CallPath, ClockProfile, ProgramClocks, WorkClocks};
use super::contexts::Contexts;
use super::regions::RegionNesting;
use super::sites::{SiteAsked, SiteTable, TransferSite};
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
    /// Transfers by site.
    pub asked: Vec<SiteAsked>,
    /// Clocks from requests to the ends of their transfers, by site.
    pub waits: Vec<u64>,
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
    /// Makes room for so many sites.
    pub fn reserve(&mut self, sites: usize) {
        if self.asked.len() < sites {
            self.asked.resize(sites, SiteAsked::default());
        }
        if self.waits.len() < sites {
            self.waits.resize(sites, 0);
        }
    }

    /// Adds transfers of a site.
    #[inline]
    pub fn add_asked(&mut self, site: u32, asked: SiteAsked) {
        self.reserve(site as usize + 1);
        self.asked[site as usize].add(asked);
    }

    /// Adds a wait at a site.
    #[inline]
    pub fn add_wait(&mut self, site: u32, Clocks(waiting): Clocks) {
        self.reserve(site as usize + 1);
        self.waits[site as usize] += waiting;
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
            let asked = part.asked.iter().zip(&part.waits);
            for (site, (asked, &waiting)) in keys.sites.iter().zip(asked).filter(|(_, (asked, _))| asked.transfers != 0)
            {
                let (path, work) = (&keys.paths[site.context as usize], asked.work(waiting));
                found.add(path, nesting.around(site.slot), work);
                profile.add_site(path, code.word(site.slot), site.kind, work);
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
        let asked = SiteAsked { transfers: 1, octets: octets.0 };
        (self.asked, self.open) = (site, open);
        self.part.add_asked(site, asked);
        self.add_crowded(asked.work(0));
    }

    /// Notes a wait for what was asked for last.
    pub fn wait(&mut self, clocks: Clocks) {
        self.part.add_wait(self.asked, clocks);
        self.add_crowded(SiteAsked::default().work(clocks.0));
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

    fn add_crowded(&mut self, more: WorkClocks) {
        for &region in &self.open {
            let region = usize::from(region);
            if self.crowded.len() <= region {
                self.crowded.resize(region + 1, WorkClocks::default());
            }
            self.crowded[region] += more;
        }
    }
}
