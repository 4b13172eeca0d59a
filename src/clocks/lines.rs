//! Source lines of the cores' program with what they took.

use std::collections::BTreeMap;

use emu::code::Code;
use emu::profile::PlaceUse;
use isa::program::Line;
use isa::{Class, Program};
use serde::Serialize;

use crate::drawing::Drawing;
use crate::job::Job;
use crate::result::{ByKind, OUTSIDE, waiting_kinds};

/// A source line that was executed.
#[derive(Clone, Debug, Serialize)]
pub struct LineClocks {
    /// File and line.
    pub place: String,
    /// Innermost function.
    pub function: String,
    /// Text of the line.
    pub text: String,
    /// Instructions executed.
    pub instructions: u64,
    /// Elementary operations.
    pub operations: u64,
    /// Octets asked for.
    pub octets: u64,
    /// Clocks of computing.
    pub busy: u64,
    /// Clocks of waiting for its transfers; 0 where waits were not measured.
    pub waiting: u64,
    /// Transfers and messages that it asked for.
    pub transfers: u64,
    /// Waits by kind of data.
    pub waiting_kinds: ByKind,
}

/// The executed lines of the cores' program in their order. Words of one line are added up: macros and pseudo-instructions make several of them.
pub fn lines(job: &Job, drawing: &Drawing) -> Vec<LineClocks> {
    let (program, frame) = (&drawing.build.cores, &drawing.frame);
    let code = Code::new(program, &job.isa, job.machine.timing());
    let kinds: Vec<&str> = frame.kinds.iter().map(|kind| kind.kind.as_str()).collect();
    let clocks = frame.profile.as_ref().and_then(|profile| profile.clocks.as_ref());
    let words = clocks.map(|clocks| clocks.words()).unwrap_or_default();
    // Add up the words of each line, sorted by source and line
    let mut found: BTreeMap<(u16, u32), (LineClocks, PlaceUse)> = BTreeMap::new();
    for (pc, line) in (0u32..).zip(&program.lines) {
        let word = frame.tally.word(&code, pc);
        if word.instructions == 0 {
            continue;
        }
        let (row, place) = found.entry((line.source, line.line)).or_insert_with(|| {
            let row = LineClocks {
                place: program.place(pc).unwrap_or_default(),
                function: program.function(pc).unwrap_or(OUTSIDE).to_owned(),
                text: text(program, line.source, line.line),
                instructions: 0,
                operations: 0,
                octets: 0,
                busy: 0,
                waiting: 0,
                transfers: 0,
                waiting_kinds: ByKind(Vec::new()),
            };
            (row, PlaceUse::default())
        });
        row.instructions += word.instructions;
        row.operations += word.counts.elementary();
        row.octets += word.counts[Class::Octet];
        row.busy += word.busy;
        if let Some(more) = words.get(&pc) {
            place.add(more);
        }
    }
    // Share the waits out among the kinds of data, now that all words of each line are in
    let whole = |(row, place): (LineClocks, PlaceUse)| LineClocks {
        waiting: place.work.waiting.0,
        transfers: place.work.transfers,
        waiting_kinds: waiting_kinds(&place, &kinds),
        ..row
    };
    found.into_values().map(whole).collect()
}

/// A line of a source, without its indentation.
fn text(program: &Program, source: u16, line: u32) -> String {
    program.line_text(Line { source, line }).unwrap_or_default().trim().to_owned()
}
