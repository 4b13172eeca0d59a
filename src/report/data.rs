//! Contents of the page, in the form that its script reads.

use std::collections::BTreeMap;

use emu::code::Code;
use isa::Program;
use scenes::model::Picture;
use serde::Serialize;

use super::base64;
use crate::advise::AdviceResult;
use crate::annex::result::Annexes;
use crate::drawing::Drawing;
use crate::files::map;
use crate::files::picture::PictureFormat;
use crate::job::Job;
use crate::result::{RegionCounts, Render};

/// Contents of the page.
#[derive(Clone, Debug, Serialize)]
pub struct PageData<'a> {
    /// Scene, machine and size.
    title: String,
    /// All figures, as `lancer render --json` prints them.
    render: &'a Render,
    /// Width and height of the pictures.
    size: (u32, u32),
    /// First column and row of the drawn part.
    corner: (u32, u32),
    /// Pictures as PNG.
    pictures: PagePictures,
    /// Elementary operations of each pixel, as 32 bits each, least octet first; larger ones are cut.
    operations: String,
    /// Difference of each pixel from double precision, as numbers of 32 bits; null where it was not measured.
    differences: Option<String>,
    /// Source lines of the cores' program that were executed.
    lines: Vec<LineRow>,
    /// The bus over time.
    course: Option<CourseData>,
    /// Advice on the machine.
    advice: Option<&'a AdviceResult>,
    /// The annexes' rows.
    annexes: Option<&'a Annexes>,
    /// Functions of the cores' program.
    functions: &'a [RegionCounts],
}

/// Pictures as PNG, as text.
#[derive(Clone, Debug, Serialize)]
struct PagePictures {
    machine: String,
    reference: Option<String>,
    heat: String,
    error: Option<String>,
}

/// A source line with what it took.
#[derive(Clone, Debug, Serialize)]
struct LineRow {
    /// File and line.
    place: String,
    /// Innermost function.
    function: String,
    /// The line's text.
    text: String,
    /// Instructions executed.
    instructions: u64,
    /// Elementary operations.
    operations: u64,
    /// Octets asked for.
    octets: u64,
}

/// Clocks of the bus in equal parts of the frame.
#[derive(Clone, Debug, Serialize)]
struct CourseData {
    part: u64,
    busy: Vec<[u64; 2]>,
}

impl<'a> PageData<'a> {
    /// The contents for a drawing.
    pub fn new(
        job: &Job,
        drawing: &Drawing,
        result: &'a Render,
        advice: Option<&'a AdviceResult>,
        annexes: Option<&'a Annexes>,
    ) -> PageData<'a> {
        let size = drawing.picture.size;
        let operations = drawing.operations();
        let differences = drawing.differences();
        let pixels = |pixels| base64::text(&PictureFormat::Png.encode_pixels(&pixels));
        let picture = |picture: &Picture| base64::text(&PictureFormat::Png.encode(picture));
        let cut = |&number: &u64| u32::try_from(number).unwrap_or(u32::MAX).to_le_bytes();
        PageData {
            title: format!(
                "{}, {} x {} pixels, kernels {}, machine {}",
                result.scene, size.0, size.1, result.profile, result.machine
            ),
            render: result,
            size,
            corner: (drawing.crop.column, drawing.crop.row),
            pictures: PagePictures {
                machine: picture(&drawing.picture),
                reference: drawing.reference.as_ref().map(picture),
                heat: pixels(map::heat(size, &operations)),
                error: differences.as_ref().map(|differences| pixels(map::error(size, differences))),
            },
            operations: base64::text(&operations.iter().flat_map(cut).collect::<Vec<u8>>()),
            differences: differences.map(|differences| {
                let octets = differences.iter().flat_map(|&difference| (difference as f32).to_le_bytes());
                base64::text(&octets.collect::<Vec<u8>>())
            }),
            lines: lines(job, drawing),
            course: drawing
                .frame
                .course
                .as_ref()
                .map(|course| CourseData { part: course.part.0, busy: course.busy.clone() }),
            advice,
            annexes,
            functions: &result.functions,
        }
    }
}

/// The executed lines of the cores' program, with their costs.
fn lines(job: &Job, drawing: &Drawing) -> Vec<LineRow> {
    let (program, timing) = (&drawing.build.cores, job.machine.timing());
    let code = Code::new(program, &job.isa, timing);
    // Words of one line are added up: macros and pseudo-instructions make several of them.
    let mut found: BTreeMap<(u16, u32), LineRow> = BTreeMap::new();
    for (pc, line) in (0u32..).zip(&program.lines) {
        let word = drawing.frame.tally.word(&code, pc);
        if word.instructions == 0 {
            continue;
        }
        let row = found.entry((line.source, line.line)).or_insert_with(|| LineRow {
            place: program.place(pc).unwrap_or_default(),
            function: program.function(pc).unwrap_or("(outside)").to_owned(),
            text: text(program, line.source, line.line),
            instructions: 0,
            operations: 0,
            octets: 0,
        });
        row.instructions += word.instructions;
        row.operations += word.counts.elementary();
        row.octets += word.counts[isa::Class::Octet];
    }
    found.into_values().collect()
}

/// A line of a source, without its indentation.
fn text(program: &Program, source: u16, line: u32) -> String {
    let source = program.sources.get(usize::from(source));
    let line = source.and_then(|source| source.text.lines().nth(line.saturating_sub(1) as usize));
    line.unwrap_or_default().trim().to_owned()
}
