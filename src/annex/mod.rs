//! The rows of the report's annexes, measured: the kernels of the `report` profile under the assumptions of each row's
//! driver, and on scenes. Nothing here prints.

pub mod figures;
pub mod result;
pub mod scene;
#[cfg(feature = "cli")]
pub mod text;

use emu::machine::Config;
use emu::machine::one_core::{self, OneCore};
use emu::octets::Memory;
use emu::profile::{Profile, ProfileLevel, RegionProfile};
use isa::{Class, Counts, Isa, Program};
use kernels::annex::{Row, rows};
use messages::{Diagnostic, Report};

use crate::failure::Failure;
use result::Try;

/// A row with what its region's calls took under its assumptions.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// The row.
    pub row: &'static Row,
    /// The program that was measured.
    pub program: Program,
    /// Calls that were measured.
    pub calls: u64,
    /// Least of each class in a call.
    pub least: Counts,
    /// Most of each class in a call.
    pub most: Counts,
    /// Tries of the row's search; the last one met the row's assumption.
    pub tried: Vec<Try>,
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
        let regions = run(&program, memory, isa)?.regions;
        let find = |name: &str| {
            let missing = || Report::from(Diagnostic::error(format!("the row `{}` has no region `{name}`", row.id)));
            regions.iter().find(|region| region.name == name).ok_or_else(missing)
        };
        let calls = match &row.search {
            Some(search) => find(&search.region)?.calls,
            None => 0,
        };
        // A row without a search is met by its first run.
        tried.push(Try { number, calls });
        if row.search.as_ref().is_none_or(|search| search.calls == calls) {
            let RegionProfile { calls, extremes, .. } = *find(&row.region)?;
            let (least, most) = extremes.map_or((Counts::ZERO, Counts::ZERO), |found| (found.least, found.most));
            return Ok(Measurement { row, calls, least, most, program, tried });
        }
    }
    let message = format!("the driver of the row `{}` does not meet its assumption with any number: {tried:?}", row.id);
    Err(Diagnostic::error(message).into())
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
