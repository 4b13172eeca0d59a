//! Energy and area of a run: counts of the rows and octets of the machine, each times a figure that has a source. Published tables disagree,
//! so results are a range. All sums are exact in attojoules (10^-18 J); a figure is rounded to them once.

mod activity;
mod area;
mod ledger;
mod map;
mod price;
#[cfg(feature = "cli")]
mod text;

use std::fmt;

use emu::machine::config::formula::Dimension;
use emu::machine::{Config, RunOutcome};
use isa::{Isa, Program};
use schemars::JsonSchema;
use serde::Serialize;

use crate::drawing::Drawing;
use crate::job::Job;
pub use activity::{Activity, Width};
pub use area::{AreaLine, TableArea};
pub use ledger::{FrameActivity, FunctionEnergy, LedgerLine, TableEnergy};
pub use map::pixels;
pub use price::{ItemPrice, Prices, Pricing};
#[cfg(feature = "cli")]
pub use text::{spread, text};

/// Least and most of a figure by the published tables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct FigureRange {
    /// By the table that says least.
    pub least: f64,
    /// By the table that says most.
    pub most: f64,
}

impl FigureRange {
    /// The range of some figures; 0 without any.
    pub fn of(figures: impl IntoIterator<Item = f64>) -> FigureRange {
        let range = figures.into_iter().fold(None, |range: Option<FigureRange>, figure| {
            let FigureRange { least, most } = range.unwrap_or(FigureRange { least: figure, most: figure });
            Some(FigureRange { least: least.min(figure), most: most.max(figure) })
        });
        range.unwrap_or_default()
    }
}

impl fmt::Display for FigureRange {
    /// `1.234 to 5.678`, or one number where the tables agree.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |figure: f64| match figure {
            0.0 => "0".to_owned(),
            figure if (0.001..1e7).contains(&figure) => format!("{figure:.3}"),
            figure => format!("{figure:.3e}"),
        };
        match (number(self.least), number(self.most)) {
            (least, most) if least == most => f.write_str(&least),
            (least, most) => write!(f, "{least} to {most}"),
        }
    }
}

/// The tables disagree on the larger part.
pub(crate) const UNDECIDED: &str = "undecided";

/// Energy and area in a few figures.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct EnergySummary {
    /// Nanojoules of the frame: cores, main processor, caches, bus and memory.
    pub frame_nj: FigureRange,
    /// Nanojoules a pixel.
    pub pixel_nj: FigureRange,
    /// Energy of the frame times its length, in joule seconds.
    pub energy_delay_js: FigureRange,
    /// Square micrometres of all cores: units, registers, buffers and caches.
    pub area_um2: FigureRange,
    /// Larger part: `octets` (global memory, bus and caches) or `arithmetic`; `undecided` where the tables disagree.
    pub decides: &'static str,
}

/// Energy and area of a frame.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct EnergyResult {
    /// The figures in short.
    #[serde(flatten)]
    pub summary: EnergySummary,
    /// Nanojoules a ray of any kind; null where rays are not known.
    pub ray_nj: Option<FigureRange>,
    /// By each published table, with every line and its source.
    pub tables: Vec<TableEnergy>,
    /// Area by each published table.
    pub areas: Vec<TableArea>,
}

/// Nanojoules of attojoules, the number that is nearest to the exact one.
pub fn nanojoules(attojoules: i128) -> f64 {
    let (whole, rest) = (attojoules.unsigned_abs() / 1_000_000_000, attojoules.unsigned_abs() % 1_000_000_000);
    let sign = if attojoules < 0 { "-" } else { "" };
    format!("{sign}{whole}.{rest:09}").parse().expect("it is a decimal number")
}

/// A program of a run, for its energy.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredPrograms<'a> {
    /// The rows of both.
    pub isa: &'a Isa,
    /// Program of the cores.
    pub cores: &'a Program,
    /// Program of the main processor.
    pub main: &'a Program,
}

impl EnergyResult {
    /// Energy and area of a drawing. `rays` are all that were traced, where that is known.
    pub fn of(job: &Job, drawing: &Drawing, rays: Option<u64>) -> EnergyResult {
        let programs = MeasuredPrograms { isa: &job.isa, cores: &drawing.build.cores, main: &drawing.build.main };
        EnergyResult::new(&job.machine, programs, &drawing.frame, drawing.words.len() as u64, rays)
    }

    /// Energy and area of a frame of a machine. `rays` are all that were traced, where that is known.
    pub fn new(
        config: &Config,
        programs: MeasuredPrograms,
        frame: &RunOutcome,
        pixels: u64,
        rays: Option<u64>,
    ) -> EnergyResult {
        let activity = FrameActivity::new(config, programs, frame);
        let seconds = frame.seconds(config.clock_hz);
        let pricings = Pricing::all(config, Dimension::Energy);
        let tables: Vec<TableEnergy> =
            pricings.iter().map(|pricing| TableEnergy::new(pricing, &activity, seconds, pixels, rays)).collect();
        let areas: Vec<TableArea> =
            Pricing::all(config, Dimension::Area).iter().map(|pricing| TableArea::new(pricing, config)).collect();
        let range = |figure: fn(&TableEnergy) -> f64| FigureRange::of(tables.iter().map(figure));
        let first = tables.first().map_or(UNDECIDED, |first| first.decides);
        let summary = EnergySummary {
            frame_nj: range(|table| table.frame_nj),
            pixel_nj: range(|table| table.pixel_nj),
            energy_delay_js: range(|table| table.energy_delay_js),
            area_um2: FigureRange::of(areas.iter().map(|area| area.cores_um2)),
            decides: if tables.iter().all(|table| table.decides == first) { first } else { UNDECIDED },
        };
        let ray_nj = rays.map(|_| FigureRange::of(tables.iter().filter_map(|table| table.ray_nj)));
        EnergyResult { summary, ray_nj, tables, areas }
    }
}
