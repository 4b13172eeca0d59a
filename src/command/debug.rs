//! `lancer debug`: a program or a pixel, instruction by instruction, forwards and back.

use std::io::{self, BufRead, BufReader, BufWriter, IsTerminal};
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};

use clap::{Args, Parser};
use emu::octets::Memory;
use messages::{Diagnostic, Report};
use serde_json::Value;

use super::assemble::{self, SourceArguments};
use super::run_arguments::{memory, memory_file, memory_size};
use crate::arguments::{self, JobArguments};
use crate::debug::{Answer, DebugTarget, Door, Session, dap};
use crate::failure::{Exit, Failure};
use crate::files;
use crate::files::program::LoadedFile;
use crate::load::Load;
use crate::registers::RegisterList;
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer debug first.s --reg s5=1.5:pos         # commands are read from the terminal; help lists them
  lancer debug first.s --commands script.txt
  lancer debug cornell --pixel 160,120 --profile ray
  lancer debug first.s --shadow                 # the command shadow shows the exact number beside each register
  lancer debug --dap                            # for an editor: the Debug Adapter Protocol on stdin and stdout
  lancer debug first.s --dap --port 4711        # the same for one client at 127.0.0.1:4711

docs/debugger.md has the commands, and the lines of configuration for editors.";

/// Runs a program, or a pixel of a scene, step by step, forwards and back.
///
/// A program is assembled, or was; of a scene the pixel is drawn by one core, whose transfers are answered from the memory
/// at the start. All options of render decide what a pixel's programs are.
#[derive(Args, Clone, Debug)]
#[command(
    after_help = EXAMPLES,
    mut_arg("scene", |scene| scene.required(false).default_value("").hide_default_value(true).help("Program (.s, .o, .bin, .hex), or with --pixel a scene as for `lancer render`").value_name("FILE|SCENE")),
    mut_arg("pixel", |pixel| pixel.help("Pixel of the scene that is debugged: its column and its row from the top")),
    mut_arg("formats", |formats| formats.value_parser(format).help("Fraction bits: of pos, dir, bary, t, weight or colour of a scene, of any format of a program; may be repeated").value_name("NAME=BITS")),
)]
pub struct DebugArguments {
    #[command(flatten)]
    target: TargetArguments,
    /// File with commands, a line each; - is standard input.
    #[arg(long, value_name = "FILE|-", help_heading = "Doors", conflicts_with = "dap")]
    commands: Option<PathBuf>,
    /// Shows source, instructions, calls and registers on the whole terminal; a build with the feature full has it.
    #[arg(long, help_heading = "Doors", conflicts_with_all = ["commands", "dap"])]
    screen: bool,
    /// Serves an editor by the Debug Adapter Protocol, on standard input and output.
    #[arg(long, help_heading = "Doors")]
    dap: bool,
    /// Port of 127.0.0.1 at which --dap waits for one client; 0: any that is free, which is told.
    #[arg(long, value_name = "PORT", help_heading = "Doors", requires = "dap")]
    port: Option<u16>,
}

/// Program or pixel to debug, and how it begins.
#[derive(Args, Clone, Debug)]
struct TargetArguments {
    #[command(flatten)]
    job: JobArguments,
    /// Constant of a program that is known before its first line; may be repeated.
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE", value_parser = assemble::definition, help_heading = "Programs")]
    defines: Vec<(String, i64)>,
    /// Folder in which files that a program includes are looked for; may be repeated.
    #[arg(short = 'I', long = "include", value_name = "FOLDER", help_heading = "Programs")]
    folders: Vec<PathBuf>,
    /// Registers at the start of a program, such as s1=5,v2=1:2:3 or s5=1.5:pos; may be repeated [default: 0].
    #[arg(long = "reg", value_name = "REGISTER=VALUE,..", allow_hyphen_values = true, help_heading = "Programs")]
    registers: Vec<RegisterList>,
    /// File whose octets lie in the global memory of a program from an address on; may be repeated.
    #[arg(long = "mem", value_name = "ADDRESS=FILE", value_parser = memory_file, help_heading = "Programs")]
    files: Vec<(u32, PathBuf)>,
    /// Octets of the global memory of a program; files that reach beyond make it longer.
    #[arg(long, value_name = "OCTETS", value_parser = memory_size, default_value = "65536", help_heading = "Programs")]
    memory_size: u32,
    /// Keeps beside each number the real one that exact arithmetic would have given: see the commands shadow and died.
    #[arg(long)]
    shadow: bool,
    /// Instructions that may be taken [default: the machine's, 100,000,000].
    #[arg(long, value_name = "N", value_parser = arguments::positive)]
    max_steps: Option<u64>,
}

/// Arguments of a launch request, as a command line.
#[derive(Parser, Debug)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct LaunchArguments {
    #[command(flatten)]
    arguments: DebugArguments,
}

/// Fraction bits of a format, kept as they were typed.
fn format(text: &str) -> Result<String, String> {
    arguments::setting::<i64>(text).map(|_| text.to_owned())
}

/// Debugs.
pub(super) fn execute(arguments: &DebugArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    if arguments.dap {
        return serve(arguments, terminal);
    }
    if arguments.target.job.scene.is_empty() {
        let message = Diagnostic::error("there is nothing to debug");
        return Err(Failure::usage(message.hint("name a program, or a scene with --pixel X,Y")));
    }
    let (target, warnings) = target(&arguments.target)?;
    terminal.show(&warnings);
    let mut door = Door::new(Session::new(&target)?);
    match &arguments.commands {
        None if arguments.screen => screen(&mut door),
        Some(path) => script(&mut door, path, terminal),
        None => interactive(&mut door, terminal),
    }
}

/// The program or the pixel.
fn target(arguments: &TargetArguments) -> Result<(DebugTarget, Report), Failure> {
    let mut target = match arguments.job.view.pixel {
        Some(_) => pixel(arguments)?,
        None => program(arguments)?,
    };
    target.0.has_shadow = arguments.shadow;
    if let Some(steps) = arguments.max_steps {
        target.0.step_limit = steps;
    }
    Ok(target)
}

fn pixel(arguments: &TargetArguments) -> Result<(DebugTarget, Report), Failure> {
    let job = &arguments.job;
    for text in &job.numbers.formats.formats {
        arguments::overrides::check(text).map_err(|message| Failure::usage(Diagnostic::error(message)))?;
    }
    if !arguments.defines.is_empty() || !arguments.registers.is_empty() || !arguments.files.is_empty() {
        let message = Diagnostic::error("a pixel begins with its ray: -D, --reg and --mem are for programs");
        return Err(Failure::usage(message));
    }
    let job = job.job()?;
    let mut warnings = job.warnings.clone();
    let (load, _) = Load::picture(&job)?;
    warnings.0.extend(load.build.warnings.0.iter().cloned());
    let name = format!("{} {},{}", crate::job::result_name(&job.scene), load.build.crop.column, load.build.crop.row);
    Ok((DebugTarget::pixel(name, load, job.machine)?, warnings))
}

fn program(arguments: &TargetArguments) -> Result<(DebugTarget, Report), Failure> {
    let job = &arguments.job;
    let path = Path::new(&job.scene);
    let config = job.machine.keys.machine(&job.numbers.arithmetic)?.config;
    let isa = job.kernels.files.extensions.isa()?;
    let formats = job.numbers.formats.formats.iter().map(|text| arguments::setting::<i64>(text));
    let formats = formats.collect::<Result<_, _>>().map_err(|message| Failure::usage(Diagnostic::error(message)))?;
    let source = SourceArguments { defines: arguments.defines.clone(), formats, folders: arguments.folders.clone() };
    // The name of a scene without a pixel is a likely slip.
    let is_scene = scenes::generate::SCENES.iter().any(|scene| scene.name == job.scene);
    let hint = |message: Diagnostic| message.hint("a scene is debugged pixel by pixel: add --pixel X,Y");
    let hinted = |report: Report| if is_scene { Report(report.0.into_iter().map(hint).collect()) } else { report };
    let loaded = files::program::load_any(path).map_err(hinted)?;
    let (program, warnings) = match loaded {
        LoadedFile::Program(program) => (*program, Report::default()),
        LoadedFile::Other(octets) => {
            let source_text = files::source_of(path, octets)?;
            let assembled = assemble::attempted(&source_text, &source, &isa).finish()?;
            (assembled.program, assembled.warnings)
        }
    };
    let mut target = DebugTarget::program(files::shown(path), config, isa, program);
    target.memory = Memory::new(memory(&arguments.files, arguments.memory_size)?);
    for setting in arguments.registers.iter().flat_map(|list| &list.0) {
        let set = setting.set(&target.program, &mut target.registers);
        set.map_err(|message| Failure::usage(Diagnostic::error(message)))?;
    }
    Ok((target, warnings))
}

/// Shows the session on the whole terminal until it ends.
#[cfg(feature = "full")]
fn screen(door: &mut Door) -> Result<Exit, Failure> {
    let shown = crate::debug::DebugScreen::new(door).run();
    shown.map_err(|error| Diagnostic::error(format!("the terminal cannot be drawn on: {error}")))?;
    Ok(Exit::Done)
}

#[cfg(not(feature = "full"))]
fn screen(_: &mut Door) -> Result<Exit, Failure> {
    let message = Diagnostic::error("this program was built without the full-screen view");
    Err(Failure::usage(message.hint("cargo install --path . --features full has it")))
}

/// Carries out the commands of a file, each shown before its answer. The first one that is wrong ends it.
fn script(door: &mut Door, path: &Path, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let source = files::source(path)?;
    let mut start = 0;
    for line in source.text.split_inclusive('\n') {
        let text = line.trim();
        if !text.is_empty() && !text.starts_with('#') {
            terminal.print(&format!("> {text}\n"))?;
        }
        match door.execute(text) {
            Ok(Answer { text, ends }) => {
                terminal.print(&text)?;
                if ends {
                    break;
                }
            }
            Err(message) => {
                // Point at the command in its file: 2 blanks in a line that begins at octet 120 put it at 122.
                let at = start + (line.len() - line.trim_start().len());
                let place = messages::Place::new(&source, at..at + text.len());
                // Where a command is typed, the hint is in the same line; in a report it has a line of its own.
                let (message, hint) = match message.rsplit_once(": did you mean") {
                    Some((message, hint)) => (message.to_owned(), Some(format!("did you mean{hint}"))),
                    None => (message, None),
                };
                let message = Diagnostic::error(message).at(place, "this command");
                return Err(match hint {
                    Some(hint) => message.hint(hint).into(),
                    None => message.into(),
                });
            }
        }
        start += line.len();
    }
    Ok(Exit::Done)
}

/// Reads commands from standard input until it ends; mistakes are told, and the session goes on.
fn interactive(door: &mut Door, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let is_watched = io::stdin().is_terminal();
    terminal.print(&door.place())?;
    for line in io::stdin().lock().lines().chain([Ok("quit".to_owned())]) {
        let line = line.map_err(|error| Diagnostic::error(format!("standard input cannot be read: {error}")))?;
        match door.execute(&line) {
            Ok(Answer { ends: true, .. }) => break,
            Ok(Answer { text, .. }) => terminal.print(&text)?,
            Err(message) => terminal.print(&format!("{message}\n"))?,
        }
        if is_watched {
            terminal.print("> ")?;
        }
    }
    Ok(Exit::Done)
}

/// Target that a launch request asks for: `program`, `args` as on the command line, and `shadow`, which is the option of that name.
fn launched(arguments: &Value) -> Result<DebugTarget, String> {
    let program = arguments["program"].as_str().ok_or("`program` names the file or the scene")?;
    let more = arguments["args"].as_array().cloned().unwrap_or_default();
    let more = more.iter().map(|argument| argument.as_str().map_or_else(|| argument.to_string(), str::to_owned));
    let has_shadow = arguments["shadow"].as_bool().unwrap_or(false).then(|| "--shadow".to_owned());
    let mut line: Vec<String> = [program.to_owned()].into_iter().chain(more).collect();
    line.extend(has_shadow.filter(|option| !line.contains(option)));
    let parsed = LaunchArguments::try_parse_from(line).map_err(|error| error.to_string())?;
    match target(&parsed.arguments.target) {
        Ok((target, _)) => Ok(target),
        Err(Failure::Message { report, .. }) => Err(report.render(false)),
        Err(Failure::ClosedPipe) => Err("nobody reads any more".into()),
    }
}

fn serve(arguments: &DebugArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let given = match arguments.target.job.scene.is_empty() {
        true => None,
        false => {
            let (target, warnings) = target(&arguments.target)?;
            terminal.show(&warnings);
            Some(target)
        }
    };
    let failed = |what: &str, error: io::Error| Failure::from(Diagnostic::error(format!("{what}: {error}")));
    let Some(port) = arguments.port else {
        let served = dap::serve(&mut io::stdin().lock(), &mut io::stdout().lock(), given, &launched);
        return served.map(|()| Exit::Done).map_err(|error| failed("the client cannot be served", error));
    };
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port));
    let listener = listener.map_err(|error| failed(&format!("port {port} cannot be opened"), error))?;
    let address = listener.local_addr().map_err(|error| failed("the port has no address", error))?;
    terminal.say(&format!("listening at {address}"));
    let (stream, _) = listener.accept().map_err(|error| failed("no client came", error))?;
    // A message is short, and the next request waits for it.
    stream.set_nodelay(true).map_err(|error| failed("the client cannot be served", error))?;
    let input = stream.try_clone().map_err(|error| failed("the client cannot be served", error))?;
    let served = dap::serve(&mut BufReader::new(input), &mut BufWriter::new(stream), given, &launched);
    served.map(|()| Exit::Done).map_err(|error| failed("the client cannot be served", error))
}
