//! `lancer extension compare`: a scene without an extension, with it, and with its bodies in its place.

use std::path::PathBuf;

use clap::Args;
use isa::table::Op;
use messages::Diagnostic;
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::{
    EffortArguments, JobArguments, KernelArguments, MachineArguments, NumberArguments, ViewArguments,
};
use crate::extension::{compare, extend};
use crate::failure::{Exit, Failure};
use crate::result::{self, WithSettings};
use crate::settings::{FileSettings, Settings, hash};
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer extension compare fma.isa --scene cornell --kernel unit=my_unit.s
  lancer extension compare slab.isa --scene house.dsc --kernel descend=my.s --machine wide32 --cores 8 --json

Exit codes: 0 compared, 1 errors in the input, 2 usage, 3 a kernel trapped, 5 step limit.";

/// Draws a scene without an extension, with it, and with the bodies of its instructions in their place, and compares.
///
/// Without: the profile's own kernels. With: those of --kernel, which may use the extension. Expanded: the same, each of its
/// instructions counted as if the instructions of its body stood there.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct CompareArguments {
    /// File of the extension.
    #[arg(value_name = "FILE.isa")]
    file: PathBuf,
    /// Scene: a .dsc with its mesh beside it, a mesh, or the name of a generated scene.
    #[arg(long, value_name = "SCENE")]
    scene: String,
    /// Mesh that belongs to the .dsc [default: the file of the same name beside it].
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Adds nanojoules a pixel by the published tables that give least and most.
    #[arg(long, help_heading = "Results")]
    energy: bool,
    /// Prints the result as JSON.
    #[arg(long, conflicts_with = "markdown", help_heading = "Results")]
    json: bool,
    /// Prints the table as Markdown.
    #[arg(long, help_heading = "Results")]
    markdown: bool,
    #[command(flatten)]
    view: ViewArguments,
    #[command(flatten)]
    kernels: KernelArguments,
    #[command(flatten)]
    machine: MachineArguments,
    #[command(flatten)]
    numbers: NumberArguments,
    #[command(flatten)]
    effort: EffortArguments,
}

/// Settings of a comparison: a picture's with the extension's kernels, and the extension.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CompareSettings {
    /// The picture's.
    #[serde(flatten)]
    job: Settings,
    /// File of the extension.
    extension: FileSettings,
}

/// Draws, compares and prints.
pub(super) fn execute(arguments: &CompareArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let job = JobArguments {
        scene: arguments.scene.clone(),
        mesh: arguments.mesh.clone(),
        view: arguments.view.clone(),
        kernels: arguments.kernels.clone(),
        machine: arguments.machine.clone(),
        numbers: arguments.numbers.clone(),
        effort: arguments.effort.clone(),
    };
    let mut extended = job.job()?;
    terminal.show(&extended.warnings);
    // Make two jobs: kernels that use the extension do not assemble without it, so one has the profile's own
    let mut plain = extended.clone();
    plain.kernels.replaced.clear();
    let (loaded, texts) = extend(&mut extended.isa, &arguments.file)?;
    let ops: Vec<Op> = loaded.iter().map(|loaded| loaded.op).collect();
    let file = arguments.file.display().to_string();
    let hash = Some(hash::texts(texts.iter().map(|text| text.text.as_str())));
    let settings =
        CompareSettings { job: Settings::of(&extended), extension: FileSettings { file: file.clone(), hash } };
    // Draw three pictures: without, with, and with the bodies in the place of the instructions
    let bar = terminal.progress("pictures", 3);
    let comparison = compare(file, &ops, &plain, &extended, &mut || bar.inc(1));
    bar.finish_and_clear();
    let comparison = comparison?;
    if comparison.executions.iter().all(|&count| count == 0) {
        let message = Diagnostic::warning("the kernels execute none of these instructions, so nothing changes");
        let hint = "`--kernel FUNCTION=FILE` names a function that has them";
        terminal.show(&message.hint(hint).into());
    }
    match (arguments.json, arguments.markdown) {
        (true, _) => terminal.print(&result::json(&WithSettings::new(&comparison, settings)))?,
        (_, true) => terminal.print(&comparison.markdown(arguments.energy))?,
        _ => terminal.tell(&comparison.text(arguments.energy))?,
    }
    Ok(Exit::Done)
}
