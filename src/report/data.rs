//! Contents of the page, in the form that its script reads.

use scenes::model::Picture;
use serde::Serialize;

use super::base64;
use crate::advise::AdviceResult;
use crate::annex::result::Annexes;
use crate::chart::{self, ChartStyle, ChartTheme, FlameFigure};
use crate::clocks::{self, LineClocks};
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
    lines: Vec<LineClocks>,
    /// The bus over time.
    course: Option<CourseData>,
    /// Advice on the machine.
    advice: Option<&'a AdviceResult>,
    /// The annexes' rows.
    annexes: Option<&'a Annexes>,
    /// Functions of the cores' program, and the regions in them.
    functions: Vec<&'a RegionCounts>,
    /// Flame graph of the cores' clocks, as SVG; light and dark.
    flames: [String; 2],
}

/// Pictures as PNG, as text.
#[derive(Clone, Debug, Serialize)]
struct PagePictures {
    machine: String,
    reference: Option<String>,
    heat: String,
    error: Option<String>,
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
        // Pictures and a number a pixel stand in the page as base64, so that it needs no other file.
        let pixels = |pixels| base64::text(&PictureFormat::Png.encode_pixels(&pixels));
        let picture = |picture: &Picture| base64::text(&PictureFormat::Png.encode(picture));
        let cut = |&number: &u64| u32::try_from(number).unwrap_or(u32::MAX).to_le_bytes();
        let figure = clocks::flame(result.title(), &clocks::stacks(&drawing.build.cores, &drawing.frame));
        PageData {
            title: result.title(),
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
            lines: clocks::lines(job, drawing),
            course: drawing
                .frame
                .course
                .as_ref()
                .map(|course| CourseData { part: course.part.0, busy: course.busy.clone() }),
            advice,
            annexes,
            functions: result.functions.iter().chain(&result.regions).collect(),
            // The page follows the reader's theme, also when that changes, so it has both.
            flames: [ChartTheme::Light, ChartTheme::Dark].map(|theme| flame(&figure, theme)),
        }
    }
}

/// The flame graph of the cores' clocks, for a page of HTML.
fn flame(figure: &FlameFigure, theme: ChartTheme) -> String {
    let svg = chart::flame_svg(figure, ChartStyle { theme, ..ChartStyle::default() });
    // HTML knows SVG without its name space, and the page names nothing outside of itself.
    svg.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1)
}
