//! Errata as people read them: one with its edits and its pictures, and the list of their names.

use kernels::annex::errata;

use super::as_printed::{ErratumPicture, ErratumResult, PicturePair};
use super::text::decimal;
use crate::numeral::grouped;
use crate::table::{row, table};

/// Names of all errata, with the place in the report and what shows them.
pub fn list() -> String {
    let mut cells = vec![row(["erratum", "place", "shown by"])];
    for erratum in errata() {
        let scene = erratum.scene.as_ref().map(|scene| format!(" on {scene}")).unwrap_or_default();
        let way = erratum.reproduction().name();
        cells.push(vec![erratum.name(), erratum.source.clone(), format!("{way}{scene}")]);
    }
    table(cells)
}

/// An erratum with everything that shows it.
pub fn text(result: &ErratumResult) -> String {
    let ErratumResult { name, source, printed, correct, effect, .. } = result;
    let mut text = format!("{name} ({source})\n  printed: {printed}\n  correct: {correct}\n  effect: {effect}\n");
    for edit in &result.edits {
        text += &format!("\n{}\n", edit.file);
        for (sign, part) in [("-", edit.text), ("+", edit.by)] {
            part.lines().for_each(|line| text += &format!("  {sign} {line}\n"));
        }
    }
    if let Some(figure) = &result.figure {
        let number = |number: f64| if number.fract() == 0.0 { grouped(number as u64) } else { decimal(number) };
        let head = row(["", "printed", "correct", "unit"]);
        let cells = vec![name.clone(), number(figure.printed), number(figure.correct), figure.unit.clone()];
        text += &format!("\n{}", table([head, cells]));
    }
    result.pictures.iter().for_each(|pair| text += &format!("\n{}", pictures(pair)));
    text
}

/// The two pictures of a scene.
fn pictures(pair: &PicturePair) -> String {
    let head = ["picture", "PSNR dB", "pixels off", "operations a pixel", "clocks", "octets", "nodes", "references"];
    let mut cells = vec![row(head)];
    for (name, of) in [("as printed", &pair.printed), ("corrected", &pair.correct)] {
        cells.push(match &of.trap {
            Some(_) => vec![name.to_owned(), "no picture".to_owned()],
            None => picture(name, of),
        });
    }
    let mut text = format!("{}, {} x {} pixels\n{}", pair.scene, pair.width, pair.height, table(cells));
    if let Some(trap) = &pair.printed.trap {
        text += &format!("as printed the kernels end in a trap: {trap}\n");
    } else {
        let between = decibels(pair.between_db);
        let differing = pair.differing_pixels.unwrap_or(0);
        text +=
            &format!("one against the other: {between} dB, {} pixels differ by 1/255 or more\n", grouped(differing));
    }
    text
}

fn picture(name: &str, of: &ErratumPicture) -> Vec<String> {
    let mut cells = vec![name.to_owned(), decibels(of.psnr_db), grouped(of.off_pixels), decimal(of.operations)];
    cells.extend([of.clocks, of.octets, of.nodes, of.references].map(grouped));
    cells
}

/// A ratio in dB; of equal pictures it is infinite.
pub fn decibels(ratio: Option<f64>) -> String {
    ratio.map_or_else(|| "equal".to_owned(), |ratio| format!("{ratio:.1}"))
}
