//! `lancer annex`: the rows of the report's annexes, printed and measured.

use clap::Args;

use super::invocation::{CommandSettings, scene_hashes};
use super::render;
use crate::annex::AnnexDetail;
use crate::annex::result::Annexes;
use crate::annex::scene::{OnScene, job};
use crate::annex::text::{self, Style};
use crate::arguments::{self, SettingsArguments, Size, TreeArguments};
use crate::drawing::Comparison;
use crate::failure::{Exit, Failure};
use crate::result::WithSettings;
use crate::terminal::Terminal;
use crate::{annex, input, result};

const EXAMPLES: &str = "\
Examples:
  lancer annex                                    all rows, printed and counted, and why they differ
  lancer annex cornell sphereflake                and what a call takes on two scenes
  lancer annex terrain --size 320x240 --json > annex.json
  lancer annex --errata

Exit codes: 0 done, 1 errors in the input, 2 usage, 4 a difference that its terms do not explain.";

/// Counts the operations of the report's annexes again.
///
/// Each row has a driver, a program that sets the report's assumptions (a packet of 40 triangles, a tree of 16 levels,
/// a pixel of 22 nodes, which is searched), and a region of the kernels of the profile `report`. The difference from what is printed is
/// a sum of terms, each with its source line and a reason.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct AnnexArguments {
    /// Scenes to count on: a .dsc with its mesh beside it, a mesh, or the name of a generated scene such as cornell.
    #[arg(value_name = "SCENE")]
    scenes: Vec<String>,
    /// Size of the scenes' pictures, in pixels.
    #[arg(long, value_name = "WxH", value_parser = arguments::size, default_value = "80x60")]
    size: Size,
    #[command(flatten)]
    tree: TreeArguments,
    #[command(flatten)]
    settings: SettingsArguments,
    /// Prints everything as JSON.
    #[arg(long, conflicts_with_all = ["csv", "markdown"])]
    json: bool,
    /// Prints the rows as CSV.
    #[arg(long, conflicts_with = "markdown")]
    csv: bool,
    /// Prints tables in Markdown.
    #[arg(long)]
    markdown: bool,
    /// Prints what is odd in the report's figures, with what it changes, instead of the rows.
    #[arg(long, conflicts_with_all = ["json", "csv"])]
    errata: bool,
}

/// Measures and prints.
pub(super) fn execute(
    arguments: &AnnexArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    let measured = annex::measure()?;
    let (mut scenes, mut read) = (Vec::new(), Vec::new());
    for name in &arguments.scenes {
        let loaded = input::scene(name, None, Some(arguments.size))?;
        terminal.show(&loaded.warnings);
        read.push(loaded.scene.clone());
        let mut job = job(loaded.scene, arguments.size);
        arguments.tree.settings().choose(&mut job);
        let drawing = render::draw(&job, Comparison::None, terminal)?;
        scenes.push(OnScene::new(&job, &drawing));
    }
    let annexes = Annexes::new(&measured, &AnnexDetail::new(&measured)?, &scenes);
    let style = if arguments.markdown { Style::Markdown } else { Style::Text };
    match arguments {
        AnnexArguments { json: true, .. } => {
            let settings = given.clone().with_scenes(&scene_hashes(&arguments.scenes, &read));
            terminal.print(&result::json(&WithSettings::new(&annexes, settings)))?
        }
        AnnexArguments { csv: true, .. } => terminal.print(&text::csv(&annexes))?,
        AnnexArguments { errata: true, markdown: true, .. } => terminal.print(&text::errata(&annexes, style))?,
        AnnexArguments { markdown: true, .. } => terminal.print(&text::annexes(&annexes, style))?,
        AnnexArguments { errata: true, .. } => terminal.tell(&text::errata(&annexes, style))?,
        _ => terminal.tell(&text::annexes(&annexes, style))?,
    }
    match measured.iter().all(annex::Measurement::is_explained) {
        true => Ok(Exit::Done),
        false => Ok(Exit::Tolerance),
    }
}
