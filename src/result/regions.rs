//! Functions and regions of a profile as they stand in results.

use emu::profile::{ClockProfile, PlaceUse, Profile, ProgramClocks, RegionClocks, WorkClocks};
use isa::Program;
use schemars::JsonSchema;
use serde::Serialize;

use super::{ByClass, ByKind};

/// Name of the row for instructions that lie in no function.
pub const OUTSIDE: &str = "(outside)";

/// A function or region.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RegionCounts {
    /// Name of the region; `(outside)` for instructions in no function.
    pub name: String,
    /// Number of calls, or of entries.
    pub calls: u64,
    /// Instructions of its own.
    pub instructions: u64,
    /// Operations, and clocks, from entering to leaving it, with all that it calls.
    pub inclusive: RegionCost,
    /// Operations, and clocks, of its own instructions.
    pub exclusive: RegionCost,
    /// Own clocks of waiting by kind of data, where clocks of functions were measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub waiting_kinds: Option<ByKind>,
}

/// Operations by class, and where they were measured the clocks beside them.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct RegionCost {
    /// Operations.
    #[serde(flatten)]
    pub counts: ByClass,
    /// Clocks.
    #[serde(flatten)]
    pub clocks: Option<FunctionClocks>,
}

/// Clocks of a function or region. Own ones of all functions and regions are those of the processors together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct FunctionClocks {
    /// Clocks of computing.
    pub busy: u64,
    /// Clocks from its requests to the ends of their transfers.
    pub waiting: u64,
    /// Transfers and messages that it asked for.
    pub transfers: u64,
}

/// Clocks of a function or region on one core.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct CoreFunction {
    /// Name of the region; `(outside)` for instructions in no function.
    pub name: String,
    /// Clocks from entering to leaving it, with all that it calls.
    pub inclusive: FunctionClocks,
    /// Clocks of its own instructions.
    pub exclusive: FunctionClocks,
}

impl FunctionClocks {
    /// Clocks of computing and of waiting.
    pub fn all(self) -> u64 {
        self.busy + self.waiting
    }
}

impl From<WorkClocks> for FunctionClocks {
    fn from(work: WorkClocks) -> FunctionClocks {
        FunctionClocks { busy: work.busy.0, waiting: work.waiting.0, transfers: work.transfers }
    }
}

/// The functions of a profile, or the regions that are none, in the order of the program; where clocks were measured, functions end with the row
/// of what lies outside of them. `kinds` are the names of the kinds of data.
pub fn regions(profile: Option<&Profile>, kinds: &[&str], is_function: bool) -> Vec<RegionCounts> {
    let Some(profile) = profile else { return Vec::new() };
    let clocks = profile.clocks.as_ref();
    let (totals, own) = (clocks.map(ClockProfile::regions), clocks.map(ClockProfile::innermost));
    let waits = |region: Option<u16>| {
        let place = own.as_ref()?.get(&region).cloned().unwrap_or_default();
        Some(waiting_kinds(&place, kinds))
    };
    let cost = |counts, work: Option<WorkClocks>| RegionCost {
        counts: ByClass(counts),
        clocks: work.map(FunctionClocks::from),
    };
    let of = |number: usize| totals.as_ref().and_then(|totals: &ProgramClocks| totals.regions.get(number).copied());
    let chosen = profile.regions.iter().enumerate().filter(|(_, region)| region.is_function == is_function);
    let mut rows: Vec<RegionCounts> = chosen
        .map(|(number, region)| RegionCounts {
            name: region.name.clone(),
            calls: region.calls,
            instructions: region.instructions,
            inclusive: cost(region.inclusive, of(number).map(|clocks: RegionClocks| clocks.inclusive)),
            exclusive: cost(region.exclusive, of(number).map(|clocks: RegionClocks| clocks.exclusive)),
            waiting_kinds: waits(Some(number as u16)),
        })
        .collect();
    // A program without functions has no other rows to tell this one from.
    if let Some(totals) = totals.filter(|_| is_function && !profile.regions.is_empty()) {
        let work = cost(profile.outside, Some(totals.outside));
        rows.push(RegionCounts {
            name: OUTSIDE.to_owned(),
            calls: 0,
            instructions: profile.outside_instructions,
            inclusive: work,
            exclusive: work,
            waiting_kinds: waits(None),
        });
    }
    rows
}

/// Waits of a place by kind of data, those without any left out.
pub fn waiting_kinds(place: &PlaceUse, kinds: &[&str]) -> ByKind {
    let named = kinds.iter().zip(&place.waiting_kinds).filter(|(_, waiting)| **waiting != 0);
    ByKind(named.map(|(kind, &waiting)| ((*kind).to_owned(), waiting)).collect())
}

/// The functions, or the regions that are none, of one core.
pub fn core_functions(program: &Program, clocks: &ProgramClocks, is_function: bool) -> Vec<CoreFunction> {
    let regions = program.regions.iter().zip(&clocks.regions).filter(|(region, _)| region.is_function == is_function);
    let of = |name: &str, inclusive: WorkClocks, exclusive: WorkClocks| CoreFunction {
        name: name.to_owned(),
        inclusive: inclusive.into(),
        exclusive: exclusive.into(),
    };
    let mut rows: Vec<_> =
        regions.map(|(region, clocks)| of(&region.name, clocks.inclusive, clocks.exclusive)).collect();
    if is_function {
        rows.push(of(OUTSIDE, clocks.outside, clocks.outside));
    }
    rows
}

/// Rows without their clocks, and without the row that only those have: what there is however a frame was measured.
pub fn without_clocks(rows: &[RegionCounts]) -> Vec<RegionCounts> {
    let rows = rows.iter().filter(|row| row.name != OUTSIDE).cloned();
    rows.map(|row| RegionCounts {
        inclusive: RegionCost { clocks: None, ..row.inclusive },
        exclusive: RegionCost { clocks: None, ..row.exclusive },
        waiting_kinds: None,
        ..row
    })
    .collect()
}
