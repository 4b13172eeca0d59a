//! `lancer explain-pixel`: the ray tree of a pixel, and how its colour comes about.

use std::ops::Range;
use std::path::PathBuf;

use clap::Args;
use messages::Diagnostic;

use crate::arguments::{self, JobArguments, numbered};
use crate::debug::DebugTarget;
use crate::failure::{Exit, Failure};
use crate::files;
use crate::load::Load;
use crate::numeral::{count, grouped};
use crate::pixel::{self, MOST_STEPS, PixelReplay};
use crate::result::{self, WithSettings};
use crate::settings::Settings;
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer explain-pixel cornell 160,120
  lancer explain-pixel mirrors 80,60 --size 160x120 --profile ray --word 20
  lancer explain-pixel cornell 160,120 --json > pixel.json
  lancer explain-pixel cornell 160,120 --html pixel.html     # replays the pixel in a browser
  lancer explain-pixel slabs 180,140 --bounces 12 --html pixel.html --steps 400000..800000";

/// Explains a pixel: its rays as a tree, what they meet, and how its colour comes about, beside double precision.
///
/// The pixel's program runs on one core, as in lancer debug; rays, hits and colours are read from its registers. --html writes one
/// page that needs no other file and no server: it replays the pixel instruction by instruction, forwards and back, with the
/// source, the registers as real numbers and the ray tree.
#[derive(Args, Clone, Debug)]
#[command(
    after_help = EXAMPLES,
    mut_arg("pixel", |pixel| pixel.hide(true).conflicts_with("place")),
    mut_arg("crop", |crop| crop.hide(true)),
)]
pub struct ExplainPixelArguments {
    #[command(flatten)]
    job: JobArguments,
    /// Column and row of the pixel, from the top left.
    #[arg(value_name = "X,Y", value_parser = arguments::whole::<2>, allow_hyphen_values = true, required_unless_present_any = ["pixel", "crop"])]
    place: Option<[u32; 2]>,
    /// Prints the explanation as JSON instead of text.
    #[arg(long, help_heading = "Results")]
    json: bool,
    /// Page that replays the pixel: .html; of a long pixel the first 400,000 instructions.
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    html: Option<PathBuf>,
    /// Instructions that the page has: from A on, B no longer, at most 400,000.
    #[arg(long, value_name = "A..B", value_parser = steps, requires = "html", help_heading = "Results")]
    steps: Option<Range<u64>>,
}

/// A range of steps; without an end it goes as far as a page does.
fn steps(text: &str) -> Result<Range<u64>, String> {
    let (start, end) = text.split_once("..").ok_or("two steps are expected, such as 0..400000")?;
    let step = |text: &str| u64::try_from(numbered(text)?).map_err(|_| format!("`{}` is below 0", text.trim()));
    let start = step(start)?;
    let end = if end.trim().is_empty() { start.saturating_add(MOST_STEPS) } else { step(end)? };
    match end.checked_sub(start) {
        None | Some(0) => Err(format!("there is no step in {text}")),
        Some(length) if length > MOST_STEPS => Err(format!("a page has at most {} steps", grouped(MOST_STEPS))),
        Some(_) => Ok(start..end),
    }
}

/// Explains, writes and prints.
pub(super) fn execute(arguments: &ExplainPixelArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    // Find the one pixel, by its place, --pixel or --crop
    let mut settings = arguments.job.settings()?;
    if let Some([column, row]) = arguments.place {
        settings.view.crop = Some([column, row, 1, 1]);
    }
    if let Some([.., width, height]) = settings.view.crop.filter(|crop| crop[2..] != [1, 1]) {
        let message = format!("one pixel is explained, not {width} x {height}");
        return Err(Failure::usage(Diagnostic::error(message).hint("name its column and its row, such as 160,120")));
    }
    let job = arguments.job.job_of(&settings)?;
    let page = arguments.html.as_deref();
    let is_taken = files::takes_output(page, arguments.json).map_err(Failure::usage)?;
    files::check_spared(page, &job.files).map_err(Failure::usage)?;
    page.map(files::check_target).transpose()?;
    terminal.show(&job.warnings);
    // Run the pixel on one core, and explain it from the registers
    let (load, image) = Load::picture(&job)?;
    terminal.show(&load.build.warnings);
    let crop = load.build.crop;
    let place = [crop.column, crop.row];
    let mut target = DebugTarget::pixel(String::new(), load, job.machine.clone())?;
    let (explanation, trap) = {
        let mut stepper = target.stepper()?;
        (pixel::explain(&job, &image, place, &mut stepper)?, stepper.trap())
    };
    if let Some(path) = page {
        let window = arguments.steps.clone().unwrap_or(0..MOST_STEPS);
        if window.start > explanation.instructions {
            let message = format!("the pixel is over after {} instructions", grouped(explanation.instructions));
            return Err(Failure::usage(Diagnostic::error(message).hint("choose earlier steps")));
        }
        // Run it once more for the page: only the page shows errors, and shadows slow each step.
        target.has_shadow = true;
        let replay = PixelReplay::record(&mut target.stepper()?, window, explanation.instructions);
        files::write_all(&[(path, pixel::page(&explanation, &replay))])?;
        if replay.left_out() > 0 {
            let left_out = count(replay.left_out(), "instruction is", "instructions are");
            terminal.say(&format!("{left_out} not on the page; --steps A..B chooses others"));
        }
    }
    match (is_taken, arguments.json) {
        (true, _) => {}
        (false, true) => terminal.print(&result::json(&WithSettings::new(&explanation, Settings::of(&job))))?,
        (false, false) => terminal.tell(&explanation.text())?,
    }
    // A trap is explained as far as the pixel came, and is an error all the same.
    match trap {
        Some(trap) => Err(Failure::Message { exit: Exit::of_trap(&trap), report: trap.diagnostic().into() }),
        None => Ok(Exit::Done),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_as_many_as_a_page_holds() {
        assert_eq!(steps("10..20"), Ok(10..20));
        assert_eq!(steps("1,000.."), Ok(1000..401_000));
        for text in ["", "10", "20..10", "10..10", "a..b", "-1..3", "0..400001"] {
            assert!(steps(text).is_err(), "{text}");
        }
    }
}
