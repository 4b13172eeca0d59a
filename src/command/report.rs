//! `lancer report`: one page of a run.

use std::path::PathBuf;

use clap::Args;

use super::render;
use crate::annex::AnnexDetail;
use crate::annex::result::Annexes;
use crate::annex::scene::OnScene;
use crate::arguments::JobArguments;
use crate::drawing::Comparison;
use crate::failure::{Exit, Failure};
use crate::job::{Detail, result_name};
use crate::result::Render;
use crate::terminal::Terminal;
use crate::{advise, annex, files, report};

const EXAMPLES: &str = "\
Examples:
  lancer report cornell --size 160x120 -o report.html
  lancer report terrain --size 320x240 --machine wide32 --no-advice
  lancer report cornell --size 160x120 --profile report -o annex.html";

/// Draws a picture and writes one page of the run, which needs no other file: .html.
///
/// The page has the settings, the picture beside double precision with a slider between them, maps of operations and of errors
/// that tell their values under the cursor, a flame graph, functions and source lines to sort, the bus over time, the advice of lancer advise,
/// and the annexes' rows beside what a call takes here.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ReportArguments {
    #[command(flatten)]
    job: JobArguments,
    /// Page [default: NAME.html in the current folder].
    #[arg(short, long, value_name = "FILE", help_heading = "Results")]
    output: Option<PathBuf>,
    /// Leaves out the advice, which runs some eighty machines.
    #[arg(long, help_heading = "Results")]
    no_advice: bool,
    /// Leaves out the annexes' rows.
    #[arg(long, help_heading = "Results")]
    no_annex: bool,
}

/// Draws, gathers and writes.
pub(super) fn execute(arguments: &ReportArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let mut job = arguments.job.job()?;
    // The page shows the bus over time, which is not recorded otherwise.
    job.detail = Detail::Course;
    let output = arguments.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.html", result_name(&job.scene))));
    files::check_target(&output)?;
    files::check_spared([output.as_path()], &job.files).map_err(Failure::usage)?;
    terminal.show(&job.warnings);
    let drawing = render::draw(&job, Comparison::Reference, terminal)?;
    terminal.show(&drawing.warnings);
    let result = Render::new(&job, &drawing);
    // Gather advice and annexes, unless they are left out
    let advice = match arguments.no_advice {
        true => None,
        false => {
            let bar = terminal.progress("machines", 1);
            let advice = advise::advise(&job, None, &mut |done, total| {
                bar.set_length(total);
                bar.set_position(done);
            });
            bar.finish_and_clear();
            Some(advice?)
        }
    };
    let annexes = match arguments.no_annex {
        true => None,
        false => {
            let measured = annex::measure()?;
            Some(Annexes::new(&measured, &AnnexDetail::new(&measured)?, &[OnScene::new(&job, &drawing)]))
        }
    };
    let page = report::page(&job, &drawing, &result, advice.as_ref(), annexes.as_ref());
    files::write_all(&[(output.as_path(), page)])?;
    // A name that nobody gave has to be told.
    if arguments.output.is_none() {
        terminal.say(&format!("page: {}", output.display()));
    }
    Ok(Exit::Done)
}
