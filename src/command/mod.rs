//! The commands, one a file. Each is a function from its arguments and the terminal to its exit code.

mod accuracy;
mod advise;
mod annex;
mod arithmetic;
mod assemble;
mod assemble_result;
mod bench;
mod completions;
mod cores;
mod debug;
mod demo;
mod diff;
mod disassemble;
mod expectation;
mod explain;
mod explain_pixel;
mod extension;
mod formats;
mod inject;
pub mod invocation;
mod machine;
mod manual;
mod profiles;
mod render;
mod report;
mod run;
mod run_arguments;
mod run_result;
mod scene;
mod schema;
mod servers;
mod skips;
mod stress;
mod sweep;
mod trace;

use std::ffi::OsString;

use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{FromArgMatches, Parser, Subcommand};
use invocation::{COMMAND_LINE, CommandSettings};
use messages::Diagnostic;

use crate::arguments::{self, Size};
use crate::failure::{Exit, Failure};
use crate::terminal::{self, StreamArguments, Terminal};

const EXAMPLES: &str = "\
Examples:
  lancer                                  the demo: a picture, maps, counts, clocks and errors
  lancer render cornell --size 160x120    a generated scene, a .dsc, or a mesh (.off, .obj, .ply, .stl)
  lancer run first.s --reg s1=5           a program of your own on one core

Exit codes: 0 done, 1 errors in the input, 2 usage, 3 trap in the guest, 4 a comparison out of
tolerance, 5 step limit. Results go to standard output, messages to standard error.";

/// Emulator of a fixed-point ray-tracing coprocessor: kernels in assembly, several cores, one shared bus.
///
/// Without a command, lancer runs the demo: it draws the Cornell box and writes pictures below out/.
#[derive(Parser, Debug)]
#[command(name = "lancer", version, after_help = EXAMPLES)]
pub struct Lancer {
    /// Size of the demo's picture, in pixels.
    #[arg(long, value_name = "WxH", value_parser = arguments::size, default_value = "320x240")]
    size: Size,
    #[command(flatten)]
    streams: StreamArguments,
    /// Host threads that compute; no result depends on them [default: all].
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256), help_heading = "Everywhere")]
    threads: Option<u32>,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand, Debug)]
enum Command {
    Render(Box<render::RenderArguments>),
    Report(Box<report::ReportArguments>),
    Run(run::RunArguments),
    Assemble(assemble::AssembleArguments),
    Disassemble(disassemble::DisassembleArguments),
    Annex(annex::AnnexArguments),
    Scene(scene::SceneArguments),
    Profiles(profiles::ProfilesArguments),
    Skips(Box<skips::SkipsArguments>),
    Machine(machine::PresetArguments),
    Cores(Box<cores::CoresArguments>),
    Servers(Box<servers::ServersArguments>),
    Sweep(sweep::SweepArguments),
    Advise(Box<advise::AdviseArguments>),
    Trace(Box<trace::TraceArguments>),
    Debug(Box<debug::DebugArguments>),
    ExplainPixel(Box<explain_pixel::ExplainPixelArguments>),
    Accuracy(Box<accuracy::AccuracyArguments>),
    Formats(formats::FormatsArguments),
    Inject(Box<inject::InjectArguments>),
    Stress(stress::StressArguments),
    Bench(bench::BenchArguments),
    Diff(diff::DiffArguments),
    Arithmetic(arithmetic::CheckedArithmeticArguments),
    Manual(manual::ManualArguments),
    Extension(extension::ExtensionsArguments),
    Explain(explain::ExplainArguments),
    Schema(schema::SchemaArguments),
    Completions(completions::CompletionsArguments),
}

/// Options that a picture's short help shows of those that decide it.
const FIRST_OPTIONS: [&str; 5] = ["size", "profile", "machine", "cores", "word"];

/// Headings of the options that decide a picture, and of those that all commands have.
const FOLDED: [&str; 6] = ["View", "Kernels", "Machine", "Numbers", "Effort", "Everywhere"];

/// A command with a short help (`-h`): what is first reached for, without examples; `--help` has all.
fn with_short_help(command: clap::Command, columns: usize) -> clap::Command {
    let command = match command.get_after_help().cloned() {
        Some(examples) => {
            // The parser would fold examples without indentation.
            let examples = terminal::folded(&examples.to_string(), columns);
            command.after_long_help(examples).after_help("--help says more, and has all options with examples.")
        }
        None => command,
    };
    let is_folded = |argument: &clap::Arg| {
        let heading = argument.get_help_heading().unwrap_or_default();
        FOLDED.contains(&heading) && !FIRST_OPTIONS.contains(&argument.get_id().as_str())
    };
    let command = command.mut_args(|argument| match is_folded(&argument) {
        true => argument.hide_short_help(true),
        false => argument,
    });
    command.mut_subcommands(|below| with_short_help(below, columns))
}

impl Lancer {
    /// The arguments of a command line, and its options as settings.
    ///
    /// # Errors
    /// Arguments that the parser refuses; help and version, which are asked for, come the same way.
    pub fn parsed(words: Vec<OsString>, streams: StreamArguments) -> Result<(Lancer, CommandSettings), clap::Error> {
        Lancer::parsed_by(&mut Lancer::parser(streams), words)
    }

    /// The parser of command lines, for a terminal and its colours.
    pub fn parser(streams: StreamArguments) -> clap::Command {
        let columns = terminal::width();
        let command = with_short_help(COMMAND_LINE.clone(), columns);
        command.color(streams.colour_choice()).term_width(columns)
    }

    /// As [`Lancer::parsed`], by a parser that may have parsed others.
    ///
    /// # Errors
    /// See [`Lancer::parsed`].
    pub fn parsed_by(
        command: &mut clap::Command,
        words: Vec<OsString>,
    ) -> Result<(Lancer, CommandSettings), clap::Error> {
        let matches = command.try_get_matches_from_mut(words)?;
        if let Some(name) = matches.subcommand_name()
            && matches.value_source("size") == Some(ValueSource::CommandLine)
        {
            let message = format!("a size before `{name}` is the demo's: write `--size` behind it");
            return Err(command.error(ErrorKind::ArgumentConflict, message));
        }
        let arguments = Lancer::from_arg_matches(&matches).map_err(|error| error.format(command))?;
        Ok((arguments, CommandSettings::new(&matches)))
    }
}

/// Lets the host compute on so many threads.
fn limit_threads(threads: Option<u32>) -> Result<(), Failure> {
    let Some(threads) = threads else { return Ok(()) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads as usize).build_global();
    pool.map_err(|error| Diagnostic::error(format!("there are no {threads} threads: {error}")).into())
}

/// Executes a command line, of which `given` are the settings.
///
/// # Errors
/// Whatever keeps the command from doing its work.
pub fn execute(arguments: &Lancer, given: &CommandSettings, terminal: &mut Terminal) -> Result<Exit, Failure> {
    // A measurement of time has a number of threads of its own.
    if !matches!(arguments.command, Some(Command::Bench(_))) {
        limit_threads(arguments.threads)?;
    }
    match &arguments.command {
        None => demo::execute(arguments.size, terminal),
        Some(Command::Render(arguments)) => render::execute(arguments, terminal),
        Some(Command::Report(arguments)) => report::execute(arguments, terminal),
        Some(Command::Run(arguments)) => run::execute(arguments, given, terminal),
        Some(Command::Assemble(arguments)) => assemble::execute(arguments, given, terminal),
        Some(Command::Disassemble(arguments)) => disassemble::execute(arguments, terminal),
        Some(Command::Annex(arguments)) => annex::execute(arguments, given, terminal),
        Some(Command::Scene(arguments)) => scene::execute(arguments, given, terminal),
        Some(Command::Profiles(arguments)) => profiles::execute(arguments, given, terminal),
        Some(Command::Skips(arguments)) => skips::execute(arguments, terminal),
        Some(Command::Machine(arguments)) => machine::execute(arguments, given, terminal),
        Some(Command::Cores(arguments)) => cores::execute(arguments, terminal),
        Some(Command::Servers(arguments)) => servers::execute(arguments, given, terminal),
        Some(Command::Sweep(arguments)) => sweep::execute(arguments, terminal),
        Some(Command::Advise(arguments)) => advise::execute(arguments, terminal),
        Some(Command::Trace(arguments)) => trace::execute(arguments, terminal),
        Some(Command::Debug(arguments)) => debug::execute(arguments, terminal),
        Some(Command::ExplainPixel(arguments)) => explain_pixel::execute(arguments, terminal),
        Some(Command::Accuracy(arguments)) => accuracy::execute(arguments, given, terminal),
        Some(Command::Formats(arguments)) => formats::execute(arguments, given, terminal),
        Some(Command::Bench(arguments)) => bench::execute(arguments, given, terminal),
        Some(Command::Diff(arguments)) => diff::execute(arguments, terminal),
        Some(Command::Inject(arguments)) => inject::execute(arguments, terminal),
        Some(Command::Stress(arguments)) => stress::execute(arguments, given, terminal),
        Some(Command::Arithmetic(arguments)) => arithmetic::execute(arguments, given, terminal),
        Some(Command::Manual(arguments)) => manual::execute(arguments, terminal),
        Some(Command::Extension(arguments)) => extension::execute(arguments, terminal),
        Some(Command::Explain(arguments)) => explain::execute(arguments, terminal),
        Some(Command::Schema(arguments)) => schema::execute(arguments, terminal),
        Some(Command::Completions(arguments)) => completions::execute(arguments, terminal),
    }
}
