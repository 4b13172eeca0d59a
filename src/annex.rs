//! Rows of the report's Annex II, measured: the kernels of the `report` profile run on one core, each call's operations
//! beside the printed ones.

use emu::machine::Config;
use emu::machine::single::{self, Single};
use emu::octets::Memory;
use emu::registers::Registers;
use isa::diagnostic::Diagnostic;
use isa::{Class, Counts, Isa};
use kernels::annex::{MEMORY, ROWS, Row};

use crate::failure::Failure;
use crate::table::{grouped, row, table};

/// The classes that the annex prints.
const PRINTED: [Class; 5] = [Class::Add, Class::Sub, Class::Mul, Class::Div, Class::Cmp];

/// A row with what its function's calls took.
#[derive(Clone, Copy, Debug)]
pub struct Measurement {
    /// The row.
    pub row: &'static Row,
    /// Calls that were measured.
    pub calls: u64,
    /// Least of each class in a call.
    pub least: Counts,
    /// Most of each class in a call.
    pub most: Counts,
}

impl Measurement {
    /// Whether every call took exactly what is printed.
    pub fn is_met(&self) -> bool {
        let is_equal = |&class: &Class| [self.least[class], self.most[class]] == [self.row.printed[class]; 2];
        self.calls != 0 && PRINTED.iter().all(is_equal)
    }
}

/// Measures all rows on the report's machine.
///
/// # Errors
/// A row whose program does not assemble or traps; ours do neither.
pub fn measure() -> Result<Vec<Measurement>, Failure> {
    let isa = Isa::base();
    ROWS.iter().map(|row| measure_row(row, &isa)).collect()
}

fn measure_row(row: &'static Row, isa: &Isa) -> Result<Measurement, Failure> {
    let config = Config::default();
    let program = row.program(isa)?;
    let registers = Registers::default();
    let single =
        Single { config: &config, isa, program: &program, registers, step_limit: config.step_limit, has_profile: true };
    let run = single::run(&single, Memory::new(vec![0; MEMORY]))?;
    if let Some(trap) = run.trap {
        return Err(emu::machine::Failure::from(trap).into());
    }
    let regions = run.profile.into_iter().flat_map(|profile| profile.regions);
    let found = regions.into_iter().find(|region| region.is_function && region.name == row.function);
    let missing = || Diagnostic::error(format!("the row `{}` has no function `{}`", row.id, row.function));
    let region = found.ok_or_else(missing)?;
    Ok(Measurement { row, calls: region.calls, least: region.least, most: region.most })
}

/// The rows beside their printed values.
pub fn text(measurements: &[Measurement]) -> String {
    let mut rows = vec![row(["row of Annex II", "", "add", "sub", "mul", "div", "cmp", "sum", ""])];
    for measurement in measurements {
        let range = |least: u64, most: u64| match least == most {
            true => grouped(least),
            false => format!("{}..{}", grouped(least), grouped(most)),
        };
        let line = |label: &str, what: &str, least: &Counts, most: &Counts, verdict: &str| {
            let mut cells = vec![label.to_owned(), what.to_owned()];
            cells.extend(PRINTED.iter().map(|&class| range(least[class], most[class])));
            cells.push(range(least.elementary(), most.elementary()));
            cells.push(verdict.to_owned());
            cells
        };
        let printed = &measurement.row.printed;
        let verdict = if measurement.is_met() { "equal" } else { "differs" };
        rows.push(line(measurement.row.label, "printed", printed, printed, ""));
        rows.push(line("", "measured", &measurement.least, &measurement.most, verdict));
    }
    format!("The report's counts of operations and ours, for one call\n{}", table(rows))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_rows_are_met_exactly() {
        // Square root 96/132/32/32 = 292; triangle 9/15/27/3/7 = 61; 40 triangles in 2,561 operations.
        let measured = measure().unwrap();
        let sums: Vec<(&str, u64, bool)> =
            measured.iter().map(|row| (row.row.id, row.most.elementary(), row.is_met())).collect();
        assert_eq!(sums, [("sqrt", 292, true), ("triangle", 61, true), ("packet", 2561, true)]);
        assert_eq!(text(&measured).matches("equal").count(), 3);
    }
}
