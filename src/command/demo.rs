//! `lancer` alone: the demo. It draws the Cornell box on the report's machine and shows everything that comes of it.

use std::fs;
use std::path::Path;

use messages::Diagnostic;
use scenes::generate;

use super::render::{draw, maps};
use crate::arguments::Size;
use crate::drawing::{Comparison, HeatOf};
use crate::failure::{Exit, Failure};
use crate::files::map::LEAST_ERROR;
use crate::files::picture::PictureFormat;
use crate::job::Job;
use crate::result::Render;
use crate::terminal::Terminal;
use crate::{annex, files, summary};

/// Folder for the demo's pictures.
const FOLDER: &str = "out";

const NEXT: &str = "\
Try next:
  lancer render sphereflake                        another scene; the list: lancer scene generate -h
  lancer render cornell --camera perspective       seen from an eye in front of the room
  lancer render cornell --pixel 160,120            one pixel: its colour and what it took
  lancer render cornell --json --cores 8           all figures, on a machine with more cores
  lancer scene info terrain                        tree, memory and precision of a scene
  lancer annex cornell                             the report's counts of operations, row by row
  lancer machine                                   the machine, as a file to change
  lancer --help
";

/// Measures, draws, writes and prints.
pub(super) fn execute(size: Size, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let folder = Path::new(FOLDER);
    fs::create_dir_all(folder).map_err(|error| {
        let message = Diagnostic::error(format!("the folder {FOLDER} for the demo's pictures cannot be made: {error}"));
        message.hint("the demo writes below the current folder; start it where it may")
    })?;
    // Count the annexes, then draw the picture.
    let measured = annex::measure()?;
    terminal.tell(&annex::text::demo(&measured))?;
    let job = Job::new(generate::scene(
        "cornell",
        &generate::GenerateOptions { size, ..generate::GenerateOptions::default() },
    )?);
    let drawing = draw(&job, Comparison::Reference, terminal)?;
    let result = Render::new(&job, &drawing);
    // Write the picture and its maps.
    let paths = ["cornell.png", "cornell-heat.png", "cornell-error.png"].map(|name| folder.join(name));
    let mut files = maps(&drawing, Some((&paths[1], HeatOf::default())), Some(&paths[2]));
    files.push((&paths[0], PictureFormat::Png.encode(&drawing.picture)));
    files::write_all(&files)?;
    let [picture, heat, error] = paths.map(|path| path.display().to_string());
    let pictures = format!(
        "{picture:<22}  the picture\n\
         {heat:<22}  elementary operations of each pixel, from dark to bright, logarithmic:\n\
         {:<22}  {}\n\
         {error:<22}  difference from double precision: black 0, dark {LEAST_ERROR:e}, bright 1, logarithmic\n",
        "",
        summary::spread(&drawing.operations()),
    );
    let parts = [
        String::new(),
        summary::title(&result) + &summary::rays(&result),
        summary::functions(&result),
        summary::classes(&result),
        summary::processors(&result),
        result.error.as_ref().map(summary::error).unwrap_or_default(),
        pictures,
        summary::hashes(&result),
        NEXT.to_owned(),
    ];
    terminal.tell(&parts.join("\n"))?;
    // A row whose difference is not explained is a mistake of this program.
    match measured.iter().all(annex::Measurement::is_explained) {
        true => Ok(Exit::Done),
        false => Ok(Exit::Tolerance),
    }
}
