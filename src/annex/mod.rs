//! The rows of the report's annexes, measured: the kernels of the `report` profile under the assumptions of each row's
//! driver, and on scenes. Nothing here prints.

pub mod as_printed;
#[cfg(feature = "cli")]
pub mod erratum_text;
#[cfg(feature = "cli")]
pub mod figure;
pub mod figures;
pub mod parts;
pub mod paths;
pub mod rates;
pub mod result;
pub mod scene;
pub mod storage;
#[cfg(feature = "cli")]
mod tables;
#[cfg(feature = "cli")]
pub mod text;

use emu::machine::Config;
use emu::machine::one_core::{self, OneCore};
use emu::octets::Memory;
use emu::profile::{Profile, ProfileLevel, RegionProfile};
use isa::{Class, Counts, Isa, Program};
use kernels::Function;
use kernels::annex::{Row, rows};
use messages::{Diagnostic, Report};

use crate::failure::Failure;
use parts::CountedPart;
use paths::PathRange;
use result::Try;
use storage::Storage;

/// A row with what its region's calls took under its assumptions.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// The row.
    pub row: &'static Row,
    /// The program that was measured.
    pub program: Program,
    /// Global memory that it starts with.
    pub memory: Vec<u8>,
    /// Calls that were measured.
    pub calls: u64,
    /// Least of each class in a call.
    pub least: Counts,
    /// Most of each class in a call.
    pub most: Counts,
    /// Sum over all calls.
    pub inclusive: Counts,
    /// Searches for a hit in the driver's run.
    pub searches: u64,
    /// Tries of the row's search; the last one met the row's assumption.
    pub tried: Vec<Try>,
}

/// Lines of the rows, ways down the tree and structures in memory, beside the counts of the rows.
#[derive(Clone, Debug)]
pub struct AnnexDetail {
    /// Lines of each row, in the order of the rows.
    pub parts: Vec<Vec<CountedPart>>,
    /// Other ways of each row, in the order of the rows; `None` for a row without.
    pub paths: Vec<Option<PathRange>>,
    /// Structures in memory.
    pub storage: Storage,
}

impl AnnexDetail {
    /// Counts and measures all of it.
    ///
    /// # Errors
    /// As [`measure`].
    pub fn new(measured: &[Measurement]) -> Result<AnnexDetail, Failure> {
        let isa = Isa::base();
        let parts = measured.iter().map(|one| parts::count(one.row, &one.program, one.memory.clone(), &isa));
        let paths = measured.iter().map(|measurement| paths::range(measurement, &isa));
        Ok(AnnexDetail {
            parts: parts.collect::<Result<_, Failure>>()?,
            paths: paths.collect::<Result<_, Failure>>()?,
            storage: Storage::measure()?,
        })
    }
}

impl Measurement {
    /// True where every call took the same.
    pub fn is_certain(&self) -> bool {
        self.calls != 0 && self.row.classes().all(|class| self.least[class] == self.most[class])
    }

    /// True where every call took exactly what is printed.
    pub fn is_met(&self) -> bool {
        self.is_certain() && self.row.classes().all(|class| self.most[class] == self.row.printed[class])
    }

    /// True where the row's terms are the difference.
    pub fn is_explained(&self) -> bool {
        let is_sum = |&class: &Class| match self.row.classes().any(|printed| printed == class) {
            true => self.row.difference(&self.most, class) == self.row.explained(class),
            false => self.row.explained(class) == 0,
        };
        self.is_certain() && Class::ALL.iter().all(is_sum)
    }
}

/// Measures all rows on the report's machine.
///
/// # Errors
/// A row whose program does not assemble or traps; ours do neither.
pub fn measure() -> Result<Vec<Measurement>, Failure> {
    let isa = Isa::base();
    rows().iter().map(|row| measure_row(row, &isa)).collect()
}

fn measure_row(row: &'static Row, isa: &Isa) -> Result<Measurement, Failure> {
    let mut tried = Vec::new();
    for number in row.tries() {
        // Run the driver with this number, and look at its regions.
        let (program, memory) = row.program(number, isa)?;
        let regions = run(&program, memory.clone(), isa)?.regions;
        let calls = match &row.search {
            Some(search) => region(row, &regions, &search.region)?.calls,
            None => 0,
        };
        // A row without a search is met by its first run.
        tried.push(Try { number, calls });
        if row.search.as_ref().is_none_or(|search| search.calls == calls) {
            let RegionProfile { calls, extremes, inclusive, .. } = *region(row, &regions, &row.region)?;
            let (least, most) = extremes.map_or((Counts::ZERO, Counts::ZERO), |found| (found.least, found.most));
            let searches =
                regions.iter().find(|region| region.name == Function::Trace.name()).map_or(0, |trace| trace.calls);
            return Ok(Measurement { row, program, memory, calls, least, most, inclusive, searches, tried });
        }
    }
    let message = format!("the driver of the row `{}` does not meet its assumption with any number: {tried:?}", row.id);
    Err(Diagnostic::error(message).into())
}

/// A region of a driver's run by its name.
fn region<'r>(row: &Row, regions: &'r [RegionProfile], name: &str) -> Result<&'r RegionProfile, Failure> {
    let missing = || Report::from(Diagnostic::error(format!("the row `{}` has no region `{name}`", row.id)));
    Ok(regions.iter().find(|region| region.name == name).ok_or_else(missing)?)
}

/// Runs a driver.
fn run(program: &Program, memory: Vec<u8>, isa: &Isa) -> Result<Profile, Failure> {
    let config = Config::default();
    let one_core = OneCore { profile: ProfileLevel::Extremes, ..OneCore::new(&config, isa, program) };
    let run = one_core::run(&one_core, Memory::new(memory))?;
    match run.trap {
        Some(trap) => Err(emu::machine::RunFailure::from(trap).into()),
        None => Ok(run.profile.unwrap_or_default()),
    }
}

#[cfg(test)]
mod tests {
    use kernels::annex::PartKind;

    use super::*;

    #[test]
    fn three_rows_are_met_exactly() {
        // Square root 96/132/32/32 = 292; triangle 9/15/27/3/7 = 61; 40 triangles in 2,561 operations.
        let measured = measure().unwrap();
        let met = measured.iter().filter(|measurement| measurement.is_met());
        let sums: Vec<(&str, u64)> = met.map(|met| (met.row.id.as_str(), met.most.elementary())).collect();
        assert_eq!(sums, [("rt.sqrt", 292), ("rt.triangle", 61), ("rt.packet", 2561)]);
        #[cfg(feature = "cli")]
        assert_eq!(text::demo(&measured).matches("equal").count(), 3);
    }

    /// Lines add up to the rows: the stepper that tells lines apart and the profile that counts rows have nothing in common.
    #[test]
    fn lines_add_up_to_the_rows() {
        let measured = measure().unwrap();
        let detail = AnnexDetail::new(&measured).unwrap();
        for (measurement, parts) in measured.iter().zip(&detail.parts) {
            let elementary = parts.iter().filter(|part| part.kind != PartKind::Class(Class::Mem));
            let sum: u64 = elementary.map(|part| part.operations).sum();
            assert_eq!(sum, measurement.most.elementary(), "{}: {parts:?}", measurement.row.id);
            for part in parts {
                let each = match &part.kind {
                    PartKind::Vector(operation) => operation.operations(),
                    PartKind::Class(_) => 1,
                    PartKind::Row(_) => continue,
                };
                assert_eq!(part.times * each, part.operations, "{}: {part:?}", measurement.row.id);
            }
        }
    }

    /// A walk reads the root and at each level the left child, whose face divides the node; to go to the right it reads that one too.
    #[test]
    fn each_step_to_the_right_is_a_read_more() {
        let measured = measure().unwrap();
        let detail = AnnexDetail::new(&measured).unwrap();
        let reads: Vec<_> = measured
            .iter()
            .zip(&detail.paths)
            .filter_map(|(measurement, range)| {
                let range = range.as_ref()?;
                let is_cheapest = |class| range.least[class] == measurement.most[class];
                assert!(measurement.row.classes().all(is_cheapest), "{}: not on the cheapest way", measurement.row.id);
                Some((range.least[Class::Mem], range.mean_of(Class::Mem), range.most[Class::Mem]))
            })
            .collect();
        assert_eq!(reads, [(17, 25.0, 33); 3]);
    }

    #[test]
    fn terms_sum_to_the_differences() {
        let mut text = String::new();
        for measurement in measure().unwrap() {
            let Measurement { row, least, most, calls, .. } = &measurement;
            if !measurement.is_explained() {
                text += &format!("{}: {calls} calls\n", row.id);
                for class in Class::ALL.iter().filter(|class| class.is_elementary() || **class == Class::Mem) {
                    let (difference, explained) = (row.difference(most, *class), row.explained(*class));
                    let name = class.name();
                    text += &format!(
                        "  {name}: {}..{}, printed {}, difference {difference}, explained {explained}\n",
                        least[*class], most[*class], row.printed[*class]
                    );
                }
            }
        }
        assert_eq!(text, "");
    }
}
