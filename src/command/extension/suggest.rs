//! `lancer extension suggest`: which instructions would pay, from a run.

use std::path::PathBuf;

use asm::extension;
use clap::Args;
use isa::table::Op;
use messages::{Diagnostic, Source};
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::JobArguments;
use crate::command::render;
use crate::drawing::Comparison;
use crate::extension::{SuggestionResult, Suggestions, compare, suggest};
use crate::failure::{Exit, Failure};
use crate::files;
use crate::numeral::{grouped, percent};
use crate::result::{self, WithSettings};
use crate::settings::Settings;
use crate::table::{row, table};
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer extension suggest cornell --size 40x30
  lancer extension suggest house.dsc --most 4 -o out/house

Exit codes: 0 done, 1 errors in the input, 2 usage, 3 a kernel trapped, 4 a picture changed, 5 step limit.";

/// Finds the sequences of instructions that would pay most as one instruction, and tries them.
///
/// The instructions of a sequence stand in one basic block and belong together by their results; others may stand between them. Its operands are the registers that it reads from before and that are read after it; constants
/// become part of it. Written are PREFIX.isa with an instruction for each and PREFIX-FUNCTION.s, the function's code for this scene with
/// the instructions in their place; then the scene is drawn without and with them.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SuggestArguments {
    #[command(flatten)]
    job: JobArguments,
    /// Most instructions.
    #[arg(long, value_name = "N", default_value = "8", value_parser = clap::value_parser!(u64).range(1..=64), help_heading = "Results")]
    most: u64,
    /// Prints the result as JSON.
    #[arg(long, help_heading = "Results")]
    json: bool,
    /// Beginning of the names of the files.
    #[arg(short, long, value_name = "PREFIX", default_value = "fused", help_heading = "Results")]
    output: PathBuf,
}

/// Settings of suggestions: a picture's, and how many there may be.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SuggestSettings {
    /// The picture's.
    #[serde(flatten)]
    job: Settings,
    /// Most instructions.
    most: u64,
}

/// Draws, looks, writes and compares.
pub(super) fn execute(arguments: &SuggestArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let mut plain = arguments.job.job()?;
    terminal.show(&plain.warnings);
    let file = arguments.output.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    asm::check_outside_name(&file, &plain.isa).map_err(|why| Failure::usage(Diagnostic::error(why)))?;
    // Instructions are named by the prefix and a number: `s` would make registers of them.
    let made = (1..=arguments.most).map(|number| format!("{file}{number}"));
    if let Some(why) = made.filter_map(|name| asm::check_outside_name(&name, &plain.isa).err()).next() {
        let message = Diagnostic::error(format!("`{file}` cannot begin the names of instructions: {why}"));
        return Err(Failure::usage(message.hint("choose a longer one, such as `-o fused`")));
    }
    if file.chars().any(|c| c.is_ascii_uppercase()) {
        let message = format!("`{file}` names instructions: small letters, digits and `_`");
        return Err(Failure::usage(Diagnostic::error(message)));
    }
    let path = |end: &str| arguments.output.with_file_name(format!("{file}{end}"));
    files::check_target(&path(".isa"))?;
    let settings = SuggestSettings { job: Settings::of(&plain), most: arguments.most };
    let json = |result: SuggestionResult| result::json(&WithSettings::new(result, settings));
    let drawing = render::draw(&plain, Comparison::None, terminal)?;
    let suggestions = suggest(&plain, &drawing, &file, arguments.most as usize);
    if suggestions.found.is_empty() {
        match arguments.json {
            true => terminal.print(&json(SuggestionResult::new(&plain, &suggestions, Vec::new(), None)))?,
            false => terminal.tell("no sequence of instructions would save anything\n")?,
        }
        return Ok(Exit::Done);
    }
    let mut written: Vec<(PathBuf, &str)> = vec![(path(".isa"), &suggestions.extension)];
    written.extend(
        suggestions.kernels.iter().map(|(function, text)| (path(&format!("-{}.s", function.name())), text.as_str())),
    );
    files::write_all(&written)?;
    let mut extended = plain.clone();
    let source = Source::new(path(".isa").display().to_string(), suggestions.extension.as_str());
    let loaded = extension::load(&mut extended.isa, &source, &|_, _| Err("nothing is included".into()))?;
    let ops: Vec<Op> = loaded.iter().map(|loaded| loaded.op).collect();
    for (function, text) in &suggestions.kernels {
        let name = path(&format!("-{}.s", function.name())).display().to_string();
        extended.kernels.replaced.push((*function, Source::new(name, text.as_str())));
    }
    plain.warnings.0.clear();
    let comparison = compare(source.name.clone(), &ops, &plain, &extended, &mut || {})?;
    let exit = if comparison.is_identical { Exit::Done } else { Exit::Tolerance };
    let names: Vec<String> = written.iter().map(|(path, _)| path.display().to_string()).collect();
    match arguments.json {
        true => {
            let result = SuggestionResult::new(&plain, &suggestions, names, Some(comparison));
            terminal.print(&json(result))?;
        }
        false => {
            let all = format!("{}\n{}written: {}\n", text(&suggestions), comparison.text(false), names.join(", "));
            terminal.tell(&all)?;
        }
    }
    Ok(exit)
}

/// The sequences, the one that saves most time first.
fn text(suggestions: &Suggestions) -> String {
    let mut rows = vec![row([
        "instruction",
        "for",
        "operands",
        "places",
        "apart",
        "executed",
        "saves",
        "clocks",
        "chain",
        "saved clocks",
        "at most",
    ])];
    for found in &suggestions.found {
        // A row `fused1 (d: S, a: S, b: V) ...` has three operands.
        let operands = found.row.split(['(', ')']).nth(1).unwrap_or_default().split(", ").count();
        rows.push(vec![
            found.name.clone(),
            found.functions.join(" "),
            operands.to_string(),
            found.places.to_string(),
            found.apart.to_string(),
            grouped(found.executions),
            percent(found.saved(), suggestions.instructions),
            found.serial.to_string(),
            found.critical.to_string(),
            grouped(found.saved_clocks()),
            format!("{:.3} x", suggestions.speedup(found)),
        ]);
    }
    // Each was found with those before it in their places, so what they save adds up.
    let saved: u64 = suggestions.found.iter().map(|found| found.saved()).sum();
    format!(
        "{}apart: places where other instructions stood between those of the sequence; saves: share of all instructions; clocks: one after the other, and along the longest chain of results; saved clocks: of computing, on this machine;\nat most: how much \
         faster the cores compute when the instruction takes as long as its chain (Amdahl)\ntogether {} of {} instructions, {}\n",
        table(rows),
        grouped(saved),
        grouped(suggestions.instructions),
        percent(saved, suggestions.instructions)
    )
}
