//! Lines of a row as they are counted: operations on vectors, other operations by class, calls of other rows. A driver is executed instruction by
//! instruction for it; the profile that the rows themselves are counted with has no part in this, so that a test can compare the two.

use std::collections::BTreeMap;

use emu::code::registers::Registers;
use emu::machine::Config;
use emu::octets::Memory;
use emu::stepper::{Lone, LoneEnd, Stepper};
use isa::{Class, Counts, Isa, Program};
use kernels::annex::{PartKind, Row, VectorOperation, rows};
use messages::Diagnostic;

use crate::failure::Failure;

/// A line of a row, in one call of its region.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CountedPart {
    /// Kind of the line.
    pub kind: PartKind,
    /// Number of calls of a row, of operations on vectors, or of operations of the class.
    pub times: u64,
    /// Elementary operations of all of them; of accesses to memory their number.
    pub operations: u64,
}

/// Rows that are open while a driver runs, the outermost first: numbers among the rows, each with the number of open calls at which it began.
///
/// While `sqrt`, called by `unit`, called by `normal`, called by `surface`, called by `shade` executes, the open rows are `rt.shade`, `rt.normal`
/// and `rt.sqrt`: of the row `rt.shade` that is a call of `rt.normal`, whatever happens inside.
#[derive(Debug, Default)]
struct OpenRows(Vec<(usize, usize)>);

impl OpenRows {
    /// Control is at a word inside these rows, with so many open calls. Answers which rows begin there.
    fn go(&mut self, inside: &[usize], depth: usize) -> Vec<usize> {
        while self.0.last().is_some_and(|&(row, began)| began > depth || began == depth && !inside.contains(&row)) {
            self.0.pop();
        }
        let begin: Vec<usize> = inside.iter().copied().filter(|&row| !self.0.contains(&(row, depth))).collect();
        self.0.extend(begin.iter().map(|&row| (row, depth)));
        begin
    }

    /// The place of a row among those that are open.
    fn place(&self, row: usize) -> Option<usize> {
        self.0.iter().position(|&(open, _)| open == row)
    }
}

/// The lines of a row, counted in the run of its program. Calls take the same, so each line is divided by their number.
///
/// # Errors
/// A program that traps; ours do not.
pub fn count(row: &Row, program: &Program, memory: Vec<u8>, isa: &Isa) -> Result<Vec<CountedPart>, Failure> {
    let config = Config::default();
    let step_limit = config.step_limit;
    let (registers, memory) = (Registers::default(), Memory::new(memory));
    let mut stepper =
        Stepper::new(Lone { config: &config, isa, program, registers, memory, message: None, step_limit })?;
    let own = rows().iter().position(|other| other.id == row.id).expect("a row is one of the rows");
    let inside: Vec<Vec<usize>> = (0..program.words.len()).map(|pc| rows_around(program, pc)).collect();
    let (mut open, mut calls) = (OpenRows::default(), 0);
    let mut found: BTreeMap<PartKind, CountedPart> = BTreeMap::new();
    let mut add = |kind: PartKind, times: u64, operations: u64| {
        let part = found.entry(kind.clone()).or_insert(CountedPart { kind, times: 0, operations: 0 });
        part.times += times;
        part.operations += operations;
    };
    loop {
        let depth = stepper.calls().len();
        let Some(executed) = stepper.step() else { break };
        // Tell which rows begin here: this one, or those that it calls.
        for begun in open.go(&inside[executed.pc as usize], depth) {
            calls += u64::from(begun == own);
            if begun != own && open.place(own).is_some_and(|place| open.place(begun) == Some(place + 1)) {
                add(PartKind::Row(rows()[begun].id.clone()), 1, 0);
            }
        }
        // Count for the row that is called, or else for the line that the instruction belongs to.
        let Some(place) = open.place(own) else { continue };
        let cost = cost(&stepper, executed.pc, executed.exit, executed.units);
        match open.0.get(place + 1) {
            Some(&(callee, _)) => add(PartKind::Row(rows()[callee].id.clone()), 0, cost.elementary()),
            None => match vector_operation(program, executed.pc) {
                Some(operation) => add(PartKind::Vector(operation), 0, cost.elementary()),
                None => {
                    let classes = cost.iter().filter(|(class, count)| is_printed(*class) && *count != 0);
                    classes.for_each(|(class, count)| add(PartKind::Class(class), count, count));
                }
            },
        }
    }
    if let Some(LoneEnd::Fault(_)) = stepper.end() {
        let trap = stepper.trap().map(emu::machine::RunFailure::from).map(Failure::from);
        return Err(
            trap.unwrap_or_else(|| Diagnostic::error(format!("the driver of the row `{}` stops", row.id)).into())
        );
    }
    let calls = calls.max(1);
    let a_call = |part: CountedPart| {
        let times = match &part.kind {
            PartKind::Vector(operation) => part.operations / operation.operations(),
            _ => part.times,
        };
        CountedPart { times: times / calls, operations: part.operations / calls, kind: part.kind }
    };
    Ok(found.into_values().filter(|part| part.operations != 0).map(a_call).collect())
}

/// An annex prints operations of the class.
fn is_printed(class: Class) -> bool {
    class.is_elementary() || class == Class::Mem
}

/// The rows whose regions are around a word, the outermost first.
fn rows_around(program: &Program, pc: usize) -> Vec<usize> {
    let mut around = Vec::new();
    let mut region = program.region_of[pc];
    while let Some(number) = region {
        let here = &program.regions[usize::from(number)];
        around.extend(rows().iter().position(|row| row.region == here.name));
        region = here.parent;
    }
    around.reverse();
    around
}

/// The operation on vectors whose macro has made a word.
fn vector_operation(program: &Program, pc: u32) -> Option<VectorOperation> {
    let line = program.lines.get(pc as usize)?;
    VectorOperation::at(&program.sources.get(line.source as usize)?.name, line.line)
}

/// Operations of an instruction that ended by an exit with so many units.
fn cost(stepper: &Stepper, pc: u32, exit: u8, units: u32) -> Counts {
    let Some(row) = stepper.code.row(pc) else { return Counts::ZERO };
    let outcome = &row.outcomes[usize::from(exit)];
    outcome.cost + outcome.each.times(units.into())
}
