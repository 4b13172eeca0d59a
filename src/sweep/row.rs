//! Columns of a study: one row a point, names with units in their documentation.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::key_set::KeySet;

/// Contents of a cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Nothing, as for a figure of a point that was refused.
    Empty,
    /// A whole number.
    Whole(u64),
    /// A real number.
    Real(f64),
    /// A text.
    Text(String),
}

/// A type that a cell can hold.
trait Cellular {
    fn cell(self) -> Cell;
}

impl Cellular for u64 {
    fn cell(self) -> Cell {
        Cell::Whole(self)
    }
}

impl Cellular for f64 {
    fn cell(self) -> Cell {
        Cell::Real(self)
    }
}

impl Cellular for String {
    fn cell(self) -> Cell {
        Cell::Text(self)
    }
}

impl<T: Cellular> Cellular for Option<T> {
    fn cell(self) -> Cell {
        self.map_or(Cell::Empty, Cellular::cell)
    }
}

/// Kind of the cells of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellKind {
    /// Whole numbers.
    Whole,
    /// Real numbers.
    Real,
    /// Texts.
    Text,
}

/// Kind of a column by the type of its field.
fn kind(field: &str) -> CellKind {
    match field {
        "u64" | "Option<u64>" | "Option < u64 >" => CellKind::Whole,
        "f64" | "Option<f64>" | "Option < f64 >" => CellKind::Real,
        _ => CellKind::Text,
    }
}

macro_rules! columns {
    ($(#[doc = $about:literal])* $name:ident: $($(#[doc = $doc:literal])* $field:ident: $type:ty,)*) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $name { $($(#[doc = $doc])* pub $field: $type,)* }

        impl $name {
            /// Names, kinds and documentation of the columns, in their order.
            pub fn columns() -> Vec<(&'static str, CellKind, String)> {
                vec![$((stringify!($field), kind(stringify!($type)), concat!($($doc),*).trim().to_owned()),)*]
            }

            /// The cells in the order of the columns.
            pub fn cells(self) -> [Cell; [$(stringify!($field),)*].len()] {
                [$(self.$field.cell(),)*]
            }
        }
    };
}

columns! {
    /// Labels of a point: its scene, machine and numbers.
    PointLabels:
    /// Name of the scene.
    scene: String,
    /// Set of kernels.
    profile: String,
    /// Structures of global memory.
    layout: String,
    /// Name of the machine.
    machine: String,
    /// Cores.
    cores: u64,
    /// Arbiter of the bus.
    arbiter: String,
    /// Bits of a word.
    word: u64,
    /// Rounding mode.
    rounding: String,
    /// Overflow mode.
    overflow: String,
    /// Width of the picture in pixels.
    width: u64,
    /// Height of the picture in pixels.
    height: u64,
    /// Shift of the samples to the right, in pixels.
    shift_x: f64,
    /// Shift of the samples upwards, in pixels.
    shift_y: f64,
    /// Levels of secondary rays.
    bounces: u64,
}

columns! {
    /// Figures of a point.
    PointFigures:
    /// Pixels that were drawn.
    pixels: u64,
    /// Pixels that were interpolated.
    interpolated: u64,
    /// Triangles of the scene.
    triangles: u64,
    /// Length of the frame in clocks.
    clocks: u64,
    /// Length of the frame in seconds of the machine.
    seconds: f64,
    /// Clocks a pixel.
    pixel_clocks: f64,
    /// Instructions of all cores.
    instructions: u64,
    /// Operations of all cores, of all classes but moves.
    operations: u64,
    /// Elementary operations of all cores: add, sub, mul, div and cmp.
    elementary: u64,
    /// Octets that the cores moved over the bus.
    octets: u64,
    /// Clocks in which the bus was busy.
    bus_busy: u64,
    /// Share of the frame in which the bus was busy, 0 to 1.
    utilisation: f64,
    /// Share of the cores' clocks in which they waited for the bus, 0 to 1.
    waiting: f64,
    /// Share of the cores' clocks in which they had nothing to do, 0 to 1.
    idle: f64,
    /// Longest wait from a request to its grant, in clocks.
    longest_wait: u64,
    /// Share of the frame in which the main processor was not idle, 0 to 1.
    main_load: f64,
    /// Reads that a cache answered.
    cache_hits: u64,
    /// Reads for which lines came over the bus.
    cache_misses: u64,
    /// Words of the cores' program.
    program_words: u64,
    /// Fraction bits of positions.
    position_bits: f64,
    /// Pixels that differ from double precision by 1/255 or more; empty where it was not measured.
    off_pixels: Option<u64>,
    /// Root of the mean square difference from double precision.
    rmse: Option<f64>,
    /// Largest difference from double precision.
    max_error: Option<f64>,
    /// Peak signal-to-noise ratio in dB; empty for equal pictures.
    psnr_db: Option<f64>,
    /// Peak signal-to-noise ratio in dB without the pixels that are off.
    psnr_others_db: Option<f64>,
    /// Method of the run: replayed or stepped.
    method: String,
    /// SHA-256 of the picture.
    image_hash: String,
}

/// A point's row in a part: its labels, and its figures or the reason for which it has none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointRow {
    /// SHA-256 of all that the result depends on, in hexadecimal.
    pub point: String,
    /// Keys that the point sets.
    pub set: KeySet,
    /// Scene, machine and numbers.
    pub labels: PointLabels,
    /// Figures; none for a point that cannot be drawn.
    pub figures: Option<PointFigures>,
    /// Reason for which it cannot be drawn.
    pub refused: Option<String>,
}
