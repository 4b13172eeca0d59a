//! `lancer inject`: faults on purpose, and what comes of them.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use emu::inject::{FaultKind, FlipPattern, FlipShape, Protection};
use emu::machine::config::ProtectionConfig;
use messages::Diagnostic;
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::JobArguments;
use crate::failure::{Exit, Failure};
use crate::files::picture::PictureFormat;
use crate::inject::result::InjectResult;
use crate::inject::row::{InjectionResult, InjectionRow, ROW_SCHEMA};
use crate::inject::{self, FaultCampaign, FaultFrame, FaultLoad, part};
use crate::job::Job;
use crate::numeral::{count, grouped};
use crate::result::WithSettings;
use crate::settings::Settings;
use crate::sweep::shard::Shard;
use crate::terminal::Terminal;
use crate::{files, result};

const EXAMPLES: &str = "\
Examples:
  lancer inject cornell --size 48x36
  lancer inject cornell --size 48x36 --kind registers --injections 100000 --json > registers.json
  lancer inject cornell --size 48x36 --kind registers --number 17     # one injection again
  lancer inject cornell --size 48x36 --protect memory=ecc --bits 2    # a second run, protected
  lancer inject cornell --size 48x36 --parts parts --shard 1/4        # one share of four, to be
  lancer inject cornell --size 48x36 --parts parts                    # brought together by this

docs/inject.md says how faults are drawn, run and classified.

Exit codes: 0 done, 1 errors in the input, 2 usage, 3 a kernel trapped without a fault.";

/// Puts faults into a frame on purpose, and says what comes of them: nothing, a wrong pixel, wrong counts, a trap or a hang.
///
/// An injection flips bits of one word at one moment of the frame, or makes one grant of the bus, the arbiter or a core go wrong. It depends on its
/// kind, its number, the seed and the settings alone. Shares have intervals of 95 % (Wilson).
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct InjectArguments {
    #[command(flatten)]
    job: JobArguments,
    /// Structure to inject into, or part of the machine that goes wrong; may be repeated [default: all].
    #[arg(long = "kind", value_name = "KIND,..", value_delimiter = ',', value_parser = kind(), help_heading = "Faults")]
    kinds: Vec<FaultKind>,
    /// Injections into each structure.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000_000), default_value = "1000", help_heading = "Faults")]
    injections: u64,
    /// Bits of a word that flip together.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=32), default_value = "1", help_heading = "Faults")]
    bits: u32,
    /// Places of several bits.
    #[arg(long, value_name = "PATTERN", value_parser = pattern(), default_value = FlipPattern::Adjacent.name(), help_heading = "Faults")]
    pattern: FlipPattern,
    /// Beginning of the series of random numbers.
    #[arg(long, value_name = "N", default_value = "1", help_heading = "Faults")]
    seed: u64,
    /// Protection of a structure, such as memory=ecc, in the place of the machine's own (key `protection`); may be repeated. Words have parity or
    /// ecc, results duplicated or residue, lost grants retry, they and other faults of the machine a watchdog.
    #[arg(long = "protect", value_name = "KIND=PROTECTION,..", value_delimiter = ',', value_parser = protection, help_heading = "Faults")]
    protections: Vec<(FaultKind, Protection)>,
    /// Runs the injection of this number alone, of the one kind that is named, and shows it.
    #[arg(long, value_name = "N", conflicts_with_all = ["parts", "shard", "heat", "rows"], help_heading = "Faults")]
    number: Option<u64>,
    /// Keeps what is done in a folder, and goes on from what is there.
    #[arg(long, value_name = "FOLDER", help_heading = "Results")]
    parts: Option<PathBuf>,
    /// Runs one of N shares and writes its parts: I/N, counted from 0 or 1.
    #[arg(long, value_name = "I/N", value_parser = Shard::parse, requires = "parts", conflicts_with_all = ["rows", "heat", "json"], help_heading = "Results")]
    shard: Option<Shard>,
    /// Brings the parts together that are there, and runs nothing; parts that are missing are named.
    #[arg(long, requires = "parts", conflicts_with = "shard", help_heading = "Results")]
    merge: bool,
    /// Writes a heat map: a row for each part of each structure, a column for each bit, bright where flips do harm (.png, .ppm or .pfm).
    #[arg(long, value_name = "FILE", value_parser = picture, help_heading = "Results")]
    heat: Option<PathBuf>,
    /// Writes every injection as a line of JSON.
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    rows: Option<PathBuf>,
    /// Prints the results as JSON instead of tables.
    #[arg(long, help_heading = "Results")]
    json: bool,
    /// Says beside the results how long the injections took, and how many a minute that is.
    #[arg(long, help_heading = "Results")]
    timing: bool,
}

/// Settings of a picture, and the faults that are put into it.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(super) struct InjectSettings {
    /// The picture.
    #[serde(flatten)]
    job: Settings,
    /// Kinds of faults.
    kind: Vec<&'static str>,
    /// Injections of each kind.
    injections: u64,
    /// Bits of a word that flip together.
    bits: u32,
    /// Places of several bits.
    pattern: &'static str,
    /// Beginning of the series of random numbers.
    seed: u64,
    /// Number of the one injection that was run; left out where all were.
    #[serde(skip_serializing_if = "Option::is_none")]
    number: Option<u64>,
}

impl InjectSettings {
    fn new(job: &Job, campaign: &FaultCampaign, number: Option<u64>) -> InjectSettings {
        InjectSettings {
            job: Settings::of(job),
            kind: campaign.kinds.iter().map(|kind| kind.name()).collect(),
            injections: campaign.injections,
            bits: campaign.shape.bits,
            pattern: campaign.shape.pattern.name(),
            seed: campaign.seed,
            number,
        }
    }
}

fn kind() -> impl TypedValueParser<Value = FaultKind> {
    let named = |name: &str| FaultKind::ALL.into_iter().find(|kind| kind.name() == name);
    PossibleValuesParser::new(FaultKind::ALL.map(FaultKind::name))
        .map(move |name| named(&name).expect("the parser lets only names pass"))
}

fn pattern() -> impl TypedValueParser<Value = FlipPattern> {
    let named = |name: &str| FlipPattern::ALL.into_iter().find(|pattern| pattern.name() == name);
    PossibleValuesParser::new(FlipPattern::ALL.map(FlipPattern::name))
        .map(move |name| named(&name).expect("the parser lets only names pass"))
}

fn protection(text: &str) -> Result<(FaultKind, Protection), String> {
    let kinds = || FaultKind::ALL.map(FaultKind::name).join(", ");
    let refusal = || format!("a protection is KIND=PROTECTION, such as memory=ecc; the kinds are {}", kinds());
    let (kind, name) = text.split_once('=').ok_or_else(refusal)?;
    let kind = FaultKind::ALL.into_iter().find(|one| one.name() == kind.trim()).ok_or_else(refusal)?;
    let found = kind.protection_names().find(|one| *one == name.trim()).and_then(Protection::from_name);
    let names = || kind.protection_names().collect::<Vec<_>>().join(", ");
    Ok((kind, found.ok_or_else(|| format!("the protections of {} are {}", kind.name(), names()))?))
}

fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    PictureFormat::of(&path).map(|_| path)
}

impl InjectArguments {
    /// The picture, on a machine whose protections are its own but for those that options say otherwise, before changes of single keys; of two for one
    /// structure the last one holds.
    fn protected_job(&self) -> Result<Job, Failure> {
        let mut machine = self.job.chosen_machine()?;
        self.protections.iter().for_each(|&(kind, protection)| machine.config.protection.set(kind, protection));
        self.job.job_of(&self.job.settings_on(machine)?)
    }

    /// The faults that are wanted, on a machine with these protections.
    fn campaign(&self, protections: ProtectionConfig) -> Result<FaultCampaign, Failure> {
        let mut kinds = Vec::new();
        let all = FaultKind::ALL;
        for &kind in if self.kinds.is_empty() { &all[..] } else { &self.kinds } {
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        if self.number.is_some() && kinds.len() != 1 {
            let message = Diagnostic::error("an injection has a number among those of its kind");
            return Err(Failure::usage(message.hint("name the kind: `--kind registers --number 17`")));
        }
        Ok(FaultCampaign {
            kinds,
            injections: self.injections,
            shape: FlipShape { bits: self.bits, pattern: self.pattern },
            seed: self.seed,
            protections,
        })
    }

    /// Check that results could be written; true where one of them goes to standard output, so that nothing else is printed there.
    fn check(&self, job: &Job) -> Result<bool, Failure> {
        let paths: Vec<&Path> = [&self.heat, &self.rows].into_iter().flatten().map(PathBuf::as_path).collect();
        for path in &paths {
            files::check_writable(path)?;
        }
        let is_taken = files::takes_output(paths.iter().copied(), self.json).map_err(Failure::usage)?;
        files::check_distinct(paths.iter().copied()).map_err(Failure::usage)?;
        files::check_spared(paths, &job.files).map_err(Failure::usage)?;
        Ok(is_taken)
    }
}

/// Runs the injections and prints what came of them.
pub(super) fn execute(arguments: &InjectArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let job = arguments.protected_job()?;
    let campaign = arguments.campaign(job.machine.protection)?;
    let is_taken = arguments.check(&job)?;
    terminal.show(&job.warnings);
    let load = FaultLoad::new(&job)?;
    let setup = load.setup(&job);
    let frame = FaultFrame::new(&load, &setup, &campaign.kinds)?;
    if !arguments.merge {
        frame.check(&campaign)?;
    }
    if let Some(number) = arguments.number {
        for injection in frame.run(&campaign, campaign.kinds[0], number..=number) {
            if !arguments.json {
                terminal.tell(&inject::one(&injection))?;
                continue;
            }
            let one = InjectionResult { schema: ROW_SCHEMA, seed: campaign.seed, injection };
            terminal
                .print(&result::json(&WithSettings::new(&one, InjectSettings::new(&job, &campaign, Some(number)))))?;
        }
        return Ok(Exit::Done);
    }
    // What could fail comes before the injections, so that none of them is in vain.
    let costs = inject::protection_costs(&job, &campaign.kinds)?;
    let Some(rows) = rows(arguments, &campaign, &job, &frame, terminal)? else { return Ok(Exit::Done) };
    let result = InjectResult::new(&job, &frame.golden, &campaign, &costs, &rows);
    let mut written: Vec<(&Path, Vec<u8>)> = Vec::new();
    if let Some(path) = &arguments.heat {
        let format = PictureFormat::of(path).expect("the parser lets only such names pass");
        written.push((path, format.encode_pixels(&inject::map(&campaign, &rows))));
    }
    if let Some(path) = &arguments.rows {
        let line = |row: &InjectionRow| serde_json::to_string(row).expect("rows have string keys") + "\n";
        written.push((path, rows.iter().map(line).collect::<String>().into_bytes()));
    }
    files::write_all(&written)?;
    match arguments.json {
        true => {
            terminal.print(&result::json(&WithSettings::new(&result, InjectSettings::new(&job, &campaign, None))))?
        }
        false if is_taken => {}
        false => terminal.tell(&inject::text(&result))?,
    }
    Ok(Exit::Done)
}

/// Rows of all injections: those of parts that are there, and those that are run now. `None` where this is a share, whose parts are all that is
/// wanted.
fn rows(
    arguments: &InjectArguments,
    campaign: &FaultCampaign,
    job: &Job,
    frame: &FaultFrame,
    terminal: &mut Terminal,
) -> Result<Option<Vec<InjectionRow>>, Failure> {
    let folder = arguments.parts.as_deref();
    if let Some(folder) = folder.filter(|_| !arguments.merge) {
        part::make_folder(folder)?;
    }
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    let identity = campaign.identity(job);
    let blocks = campaign.blocks();
    let (start, mut ran, mut there, mut missing) = (Instant::now(), 0, 0, Vec::new());
    let bar = terminal.progress("injections", blocks.iter().map(|(_, block)| block.end - block.start).sum());
    let mut rows = Vec::new();
    // The rows of a share are in its parts.
    let mut keep = |new: Vec<InjectionRow>| {
        if arguments.shard.is_none() {
            rows.extend(new)
        }
    };
    for (_, (kind, block)) in blocks.into_iter().enumerate().filter(|(number, _)| shard.has(*number)) {
        let known = folder.map(|folder| part::read(folder, &identity, kind, &block)).transpose()?.flatten();
        let length = block.end - block.start;
        match known {
            Some(known) => {
                there += length;
                keep(known);
            }
            None if arguments.merge => missing.push(format!("{} {} to {}", kind.name(), block.start, block.end - 1)),
            None => {
                let new = frame.run(campaign, kind, block.start..=block.end - 1);
                if let Some(folder) = folder {
                    part::write(folder, &identity, kind, &block, &new)?;
                }
                ran += length;
                keep(new);
            }
        }
        bar.inc(length);
    }
    bar.finish_and_clear();
    if let Some(first) = missing.first() {
        let message = format!("{} missing, the first is {first}", count(missing.len() as u64, "part is", "parts are"));
        let hint = "run the shares that have them, or the same command without --merge";
        return Err(Diagnostic::error(message).hint(hint).into());
    }
    let seconds = start.elapsed().as_secs_f64();
    if arguments.timing && ran != 0 && seconds > 0.0 {
        let rate = (60.0 * ran as f64 / seconds) as u64;
        terminal.say(&format!("{} injections in {seconds:.1} s, {} a minute\n", grouped(ran), grouped(rate)));
    }
    if arguments.shard.is_some() {
        terminal.print(&format!("{} injections run, {} were there\n", grouped(ran), grouped(there)))?;
        return Ok(None);
    }
    Ok(Some(rows))
}
