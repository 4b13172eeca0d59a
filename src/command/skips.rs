//! `lancer skips`: what is left out where a scene does not need it, and what that saves.

use clap::Args;
use messages::Diagnostic;

use crate::arguments::JobArguments;
use crate::failure::{Exit, Failure};
use crate::numeral::short;
use crate::result::{self, WithSettings};
use crate::settings::Settings;
use crate::skips::{self, SkipResult, SkipsResult};
use crate::table::{row, table};
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer skips cornell --size 80x60
  lancer skips sphereflake --profile report --size 80x60 --json > skips.json
  lancer render cornell --no-skip any-hit,unlit

The picture is drawn without any skip, with each alone, and with all: choose a size that leaves time for a
dozen pictures, of which those that follow rays of weight 0 are slow.

Exit codes: 0 done, 1 errors in the input, 2 usage, 3 a kernel trapped, 4 a skip changed the picture.";

/// Shows what each skip saves: code, rays, packets and octets that a scene does not need.
///
/// The operations are those of cores and main processor, of all classes but moves. A saving is a share of what the picture
/// takes without any skip; shares of single skips do not add up, since they save partly the same.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SkipsArguments {
    #[command(flatten)]
    job: JobArguments,
    /// Prints the results as JSON instead of a table.
    #[arg(long, help_heading = "Results")]
    json: bool,
}

/// Draws the pictures and prints.
pub(super) fn execute(arguments: &SkipsArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    if !arguments.job.effort.skips.no_skip.is_empty() {
        return Err(Failure::usage(
            Diagnostic::error("skips are switched one by one here").hint("leave out --no-skip"),
        ));
    }
    let job = arguments.job.job()?;
    terminal.show(&job.warnings);
    let bar = terminal.progress("pictures", skips::pictures(&job) as u64);
    let savings = skips::measure(&job, &|| bar.inc(1));
    bar.finish_and_clear();
    let savings = savings?;
    match arguments.json {
        true => terminal.print(&result::json(&WithSettings::new(&savings, Settings::of(&job))))?,
        false => terminal.tell(&text(&savings))?,
    }
    let is_kept = savings.rows.iter().all(|saving| saving.is_identical || !saving.claims_identity);
    Ok(if is_kept { Exit::Done } else { Exit::Tolerance })
}

fn text(savings: &SkipsResult) -> String {
    let mut rows = vec![row(["skip", "operations", "saved", "octets", "saved", "clocks", "saved", "words", "picture"])];
    rows.extend(savings.rows.iter().map(|saving| {
        let share = |share: f64| format!("{:.1} %", 100.0 * share);
        vec![
            saving.name.clone(),
            short(saving.operations),
            share(saving.operations_saved),
            short(saving.octets),
            share(saving.octets_saved),
            short(saving.clocks),
            share(saving.clocks_saved),
            short(saving.program_words as u64),
            picture(saving),
        ]
    }));
    let names: Vec<String> =
        savings.rows.iter().map(|saving| format!("{:<11} {}", saving.name, saving.description)).collect();
    format!(
        "{}: {} x {} pixels, profile {}, layout {}\n\n{}\n{}\n",
        savings.scene,
        savings.width,
        savings.height,
        savings.profile,
        savings.layout,
        table(rows),
        names.join("\n")
    )
}

fn picture(saving: &SkipResult) -> String {
    match saving.psnr_db {
        _ if saving.is_identical => "identical".to_owned(),
        Some(psnr) => format!("{} off, {psnr:.1} dB", saving.off_pixels),
        None => "differs in the last bits".to_owned(),
    }
}
