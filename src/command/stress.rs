//! `lancer stress`: the catalogue of what fixed-point ray tracers get wrong, tried.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use messages::Diagnostic;
use schemars::JsonSchema;
use serde::Serialize;

use super::invocation::CommandSettings;
use crate::arguments::SettingsArguments;
use crate::failure::{Exit, Failure};
use crate::numeral::grouped;
use crate::result::WithSettings;
use crate::stress::progress::{CaseProgress, RunProgress};
use crate::stress::{self, CASES, Case, CatalogueSize, TrialTally};
use crate::table::{row, table};
use crate::terminal::Terminal;
use crate::{files, result};

/// Version of what `--json` prints.
pub(super) const SCHEMA: &str = "lancer-stress-1";

/// Parts of a case after which progress is shown and kept.
const PARTS: u64 = 200;

/// Least trials of a part: fewer would leave host threads without work.
const LEAST: u64 = 32;

const EXAMPLES: &str = "\
Examples:
  lancer stress                                    # every case, as many trials as the test suite makes
  lancer stress --case closed_meshes --case slivers --json
  lancer stress --size full --resume stress.json   # hours; stopped and called again it goes on
  lancer stress --list

Exit codes: 0 all values are allowed, 4 one is not.";

/// Tries what fixed-point ray tracers get wrong, and measures how wrong the kernels are.
///
/// Searches are those of the profile `ray`, by the native functions that have the kernels' bits; the case `kernels`
/// holds them against the emulated machine. Trials depend on their number and the seed alone.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct StressArguments {
    /// Case to try; may be repeated [default: all].
    #[arg(long = "case", value_name = "NAME", value_parser = case())]
    cases: Vec<&'static Case>,
    /// Number of trials: quick (seconds) or full (hours).
    #[arg(long, value_name = "SIZE", value_parser = size(), default_value = CatalogueSize::Quick.name(), conflicts_with = "full")]
    size: CatalogueSize,
    /// Every case at full size: short for --size full.
    #[arg(long)]
    full: bool,
    /// Keeps what is done in a file, and goes on from what is there.
    #[arg(long, value_name = "FILE")]
    resume: Option<PathBuf>,
    /// Lists the cases instead of trying them.
    #[arg(long, conflicts_with_all = ["json", "resume"])]
    list: bool,
    #[command(flatten)]
    settings: SettingsArguments,
    /// Prints the results as JSON.
    #[arg(long)]
    json: bool,
}

fn case() -> impl TypedValueParser<Value = &'static Case> {
    let names = PossibleValuesParser::new(CASES.iter().map(|case| case.name));
    names.map(|name| stress::find(&name).expect("the parser lets only names pass"))
}

fn size() -> impl TypedValueParser<Value = CatalogueSize> {
    let names = PossibleValuesParser::new(CatalogueSize::ALL.map(CatalogueSize::name));
    names.map(|name| {
        CatalogueSize::ALL.into_iter().find(|size| size.name() == name).expect("the parser lets only names pass")
    })
}

/// Outcome of a case.
#[derive(Clone, Debug, Serialize, JsonSchema)]
struct CaseVerdict {
    /// Name of the case.
    name: &'static str,
    /// Description of the trials.
    about: &'static str,
    /// Quantity that the value counts or measures.
    quantity: &'static str,
    /// Trials that were made.
    trials: u64,
    /// Beginning of the series of random numbers.
    seed: u64,
    /// Trials that went wrong, of which none is allowed.
    failures: u64,
    /// The value that was measured.
    value: f64,
    /// The largest value that is allowed.
    threshold: f64,
    /// True where the value is allowed.
    passes: bool,
    /// The first trial that went wrong; null when none did.
    example: Option<Example>,
}

/// A trial that went wrong.
#[derive(Clone, Debug, Serialize, JsonSchema)]
struct Example {
    /// Number of the trial, from 0.
    trial: u64,
    /// Description of what went wrong.
    text: String,
}

/// Outcome of the cases.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(super) struct Catalogue {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    schema: &'static str,
    /// Number of trials by name: quick or full.
    size: &'static str,
    /// True where all values are allowed.
    passes: bool,
    /// The cases in the order of the catalogue, or of the command line.
    cases: Vec<CaseVerdict>,
}

/// Tries the cases.
pub(super) fn execute(
    arguments: &StressArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    let size = if arguments.full { CatalogueSize::Full } else { arguments.size };
    let chosen: Vec<&Case> = match arguments.cases.is_empty() {
        true => CASES.iter().collect(),
        false => arguments.cases.clone(),
    };
    if arguments.list {
        terminal.tell(&list(&chosen))?;
        return Ok(Exit::Done);
    }
    // Take up what a former run has left.
    let file = arguments.resume.as_deref();
    if file == Some(Path::new(files::STANDARD)) {
        let message = Diagnostic::error("what is done is kept in a file, which standard output is not");
        return Err(Failure::usage(message.hint("choose a name: `--resume stress.json`")));
    }
    let mut state = match file.filter(|path| path.exists()) {
        Some(path) => RunProgress::parse(&files::source(path)?, size)?,
        None => RunProgress::new(size),
    };
    if let Some(path) = file {
        files::check_target(path)?;
    }
    // Try the cases, and say each as soon as it is done unless all of them are one JSON object.
    let mut verdicts = Vec::new();
    for case in chosen {
        let tally = try_case(case, size, &mut state, file, terminal)?;
        let verdict = verdict(case, tally);
        if !arguments.json {
            terminal.tell(&text(&verdict))?;
        }
        verdicts.push(verdict);
    }
    let passes = verdicts.iter().all(|verdict| verdict.passes);
    if arguments.json {
        let catalogue = Catalogue { schema: SCHEMA, size: size.name(), passes, cases: verdicts };
        terminal.print(&result::json(&WithSettings::new(catalogue, given.clone())))?;
    }
    Ok(if passes { Exit::Done } else { Exit::Tolerance })
}

/// Makes the trials of a case that are still to be made.
fn try_case(
    case: &Case,
    size: CatalogueSize,
    state: &mut RunProgress,
    file: Option<&Path>,
    terminal: &Terminal,
) -> Result<TrialTally, Failure> {
    let trials = case.trials(size);
    let done = CaseProgress { seed: case.seed, tally: TrialTally::default() };
    let mut done = state.cases.remove(case.name).unwrap_or(done);
    let bar = terminal.progress(case.name, trials);
    bar.set_position(done.tally.trials);
    while done.tally.trials < trials {
        // A part at a time, so that the state is written often and a run that is stopped loses little.
        let from = done.tally.trials;
        let to = (from + trials.div_ceil(PARTS).max(LEAST)).min(trials);
        done.tally = done.tally.plus(case.run(size, from..to));
        bar.set_position(to);
        if let Some(path) = file {
            state.cases.insert(case.name.to_owned(), done.clone());
            files::write_through(path, result::json(state).as_bytes())?;
        }
    }
    bar.finish_and_clear();
    state.cases.insert(case.name.to_owned(), done.clone());
    Ok(done.tally)
}

fn verdict(case: &'static Case, tally: TrialTally) -> CaseVerdict {
    CaseVerdict {
        name: case.name,
        about: case.about,
        quantity: case.quantity,
        trials: tally.trials,
        seed: case.seed,
        failures: tally.failures,
        value: case.value(&tally),
        threshold: case.threshold,
        passes: case.passes(&tally),
        example: tally.example.map(|(trial, text)| Example { trial, text }),
    }
}

fn number(value: f64) -> String {
    match value {
        whole if whole == whole.trunc() => grouped(whole as u64),
        small if small < 0.001 => format!("{small:.1e}"),
        _ => format!("{value:.3}"),
    }
}

fn text(verdict: &CaseVerdict) -> String {
    let CaseVerdict { name, quantity, trials, seed, failures, value, threshold, passes, example, .. } = verdict;
    let word = if *passes { "ok" } else { "FAIL" };
    let mut text = format!("{word:<4} {name:<17} {:>11} trials, seed {seed:>2}: {}", grouped(*trials), number(*value));
    text += &format!(" {quantity}, at most {} allowed\n", number(*threshold));
    if let Some(Example { trial, text: what }) = example {
        text += &format!("     {} wrong, first trial {trial}: {what}\n", grouped(*failures));
    }
    text
}

fn list(cases: &[&Case]) -> String {
    let mut rows = vec![row(["case", "what is tried", "quick", "full"])];
    rows.extend(cases.iter().map(|case| {
        let [quick, full] = CatalogueSize::ALL.map(|size| grouped(case.trials(size)));
        vec![case.name.to_owned(), case.about.to_owned(), quick, full]
    }));
    table(rows)
}
