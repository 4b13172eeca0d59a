//! Steps of a pixel in the form that its page reads: where the program jumps and what each instruction writes, so that the page can have any state by
//! replaying from the last of its own checkpoints. Numbers stand as words of 32 bits, least octet first, in base 64.

use std::collections::BTreeMap;
use std::ops::Range;

use emu::registers::Registers;
use emu::stepper::Stepper;
use isa::Program;
use isa::naming::{RegisterId, registers};
use serde::Serialize;

use crate::registers::{self as shown, RegisterContents};
use crate::report::base64;
use crate::shadow::register_errors;
use crate::trace::instruction;

/// Instructions that a page holds at most.
pub const MOST_STEPS: u64 = 400_000;

/// Words of written registers that a page holds at most.
const MOST_WORDS: usize = 3_000_000;

/// Steps of a pixel.
#[derive(Clone, Debug, Serialize)]
pub struct PixelReplay {
    /// Instructions before the first one that is here.
    first: u64,
    /// Instructions that are here.
    count: u64,
    /// Instructions that the pixel takes.
    total: u64,
    /// Files of the program of which a line was executed.
    sources: BTreeMap<u16, SourceText>,
    /// Words that were executed.
    words: BTreeMap<u32, WordText>,
    /// Names of the registers, in the order in which states have them.
    registers: Vec<String>,
    /// Fraction bits of formats.
    formats: BTreeMap<String, i32>,
    /// Names that the program gives registers: the register, the name, and the words where it counts.
    names: Vec<(usize, String, Range<u32>)>,
    /// Formats of what registers hold: the register, the format, and the words before which it counts.
    holds: Vec<(usize, Option<String>, Range<u32>)>,
    /// Registers before the first step.
    start: String,
    /// Steps whose word does not follow that of the step before, each with its word; the first step is one.
    jumps: String,
    /// Words of all registers that were written, step by step, in the order of `writes`.
    values: String,
    /// Errors of those, component by component, as numbers of 32 bits; not a number where nothing is known. Null without a shadow.
    errors: Option<String>,
    /// Transfers: the step, the kind, the address and the octets.
    transfers: Vec<(u64, &'static str, u32, u32)>,
    /// Steps with results that lost bits below the last place, or did not fit, and how many.
    losses: Vec<(u64, u64, u64)>,
}

/// A file of the program.
#[derive(Clone, Debug, Serialize)]
struct SourceText {
    name: String,
    lines: Vec<String>,
}

/// A word of the program.
#[derive(Clone, Debug, Serialize)]
struct WordText {
    text: String,
    function: Option<String>,
    source: u16,
    line: u32,
    /// Registers that it writes.
    writes: Vec<usize>,
}

/// Number of a register among all.
fn number((file, number): RegisterId) -> usize {
    registers().position(|register| register == (file, number)).expect("programs name registers that there are")
}

/// Words of a register's contents: one, three, or two of a wide accumulator, the lower one first.
fn words((file, _): RegisterId, contents: RegisterContents) -> Vec<i32> {
    match contents {
        RegisterContents::One(value) if file == 'w' => vec![value as i32, (value >> 32) as i32],
        RegisterContents::One(value) => vec![value as i32],
        RegisterContents::Three(components) => components.to_vec(),
    }
}

fn state(registers: &Registers) -> Vec<i32> {
    shown::all(registers).flat_map(|(register, contents)| words(register, contents)).collect()
}

fn text_of(words: &[i32]) -> String {
    base64::text(&words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>())
}

impl PixelReplay {
    /// Records the steps of a window, at most [`MOST_STEPS`], of a core before its first instruction. `total` are all that the pixel takes.
    pub fn record(stepper: &mut Stepper, window: Range<u64>, total: u64) -> PixelReplay {
        stepper.run_to(window.start);
        let first = stepper.steps();
        let end = window.end.min(first.saturating_add(MOST_STEPS));
        let start = state(&stepper.state().registers);
        let (mut seen, mut jumps, mut values): (BTreeMap<u32, WordText>, _, _) = (BTreeMap::new(), vec![], vec![]);
        let (mut errors, mut transfers, mut losses) = (Vec::new(), Vec::new(), Vec::new());
        let mut expected = None;
        // Step through the window; what is the same each time that a word runs is kept once
        while stepper.end().is_none() && stepper.steps() < end && values.len() < MOST_WORDS {
            let pc = stepper.code.word(stepper.state().pc);
            let written = instruction::registers(&stepper.code, pc, true);
            let at = stepper.steps() - first;
            let Some(executed) = stepper.step() else { break };
            seen.entry(pc).or_insert_with(|| word_text(stepper, pc, &written));
            // Words mostly follow each other, so jumps are enough: 7 8 9 4 5 from step 0 on are the pairs 0 7 and 3 4.
            if expected != Some(pc) {
                jumps.extend([at as i32, pc as i32]);
            }
            expected = Some(pc + 1);
            for register in written {
                let written = words(register, RegisterContents::of(&stepper.state().registers, register));
                // As many errors as words, so that a place in one list is a place in the other.
                if let Some(known) = register_errors(stepper, register) {
                    errors.extend(known.iter().take(written.len()).map(|&error| error as f32));
                }
                values.extend(written);
            }
            let transfer =
                executed.transfer.map(|transfer| (at, transfer.kind.name(), transfer.address, transfer.octets));
            transfers.extend(transfer);
            if executed.losses.quantized + executed.losses.overflowed > 0 {
                losses.push((at, executed.losses.quantized, executed.losses.overflowed));
            }
        }
        let program = stepper.code.program;
        PixelReplay {
            first,
            count: stepper.steps() - first,
            total,
            sources: sources(program, seen.values().map(|word| word.source)),
            words: seen,
            registers: registers().map(shown::name).collect(),
            formats: (program.formats.keys())
                .filter_map(|name| program.format(name))
                .map(|(name, bits)| (name.to_owned(), bits))
                .collect(),
            names: program
                .register_names
                .iter()
                .map(|named| (number(named.register), named.name.clone(), named.words.clone()))
                .collect(),
            holds: program
                .holds
                .iter()
                .map(|held| (number(held.register), held.format.clone(), held.words.clone()))
                .collect(),
            start: text_of(&start),
            jumps: text_of(&jumps),
            values: text_of(&values),
            errors: stepper
                .shadow()
                .is_some()
                .then(|| base64::text(&errors.iter().flat_map(|error: &f32| error.to_le_bytes()).collect::<Vec<u8>>())),
            transfers,
            losses,
        }
    }

    /// Instructions that are left out.
    pub fn left_out(&self) -> u64 {
        self.total.saturating_sub(self.count)
    }
}

fn word_text(stepper: &Stepper, pc: u32, written: &[RegisterId]) -> WordText {
    let program = stepper.code.program;
    let line = program.lines.get(pc as usize);
    WordText {
        text: instruction::text(&stepper.code, pc),
        function: program.function(pc).map(str::to_owned),
        source: line.map_or(0, |line| line.source),
        line: line.map_or(0, |line| line.line),
        writes: written.iter().map(|&register| number(register)).collect(),
    }
}

fn sources(program: &Program, used: impl Iterator<Item = u16>) -> BTreeMap<u16, SourceText> {
    let text = |number: u16| {
        let source = program.sources.get(usize::from(number))?;
        let lines = source.text.lines().map(str::to_owned).collect();
        Some((number, SourceText { name: source.name.clone(), lines }))
    };
    let numbers: std::collections::BTreeSet<u16> = used.collect();
    numbers.into_iter().filter_map(text).collect()
}
