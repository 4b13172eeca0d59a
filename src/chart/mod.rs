//! Charts, all in one way: a title that says what was measured, round ticks, a grid, a legend beside the plots, marks and colours that differ
//! without colour vision too, names that do not meet. A figure says what is shown; it is drawn for one or two columns of a paper, light or
//! dark, as SVG or PDF.

mod canvas;
mod diagram;
mod draw;
mod flame;
mod font;
mod label;
mod page;
mod pdf;
mod scale;
mod style;
mod svg;

pub use diagram::{DiagramBox, DiagramFigure, DiagramLink};
pub use flame::{FlameFigure, FlameKind, FlameNode};
pub use style::{ChartColumns, ChartStyle, ChartTheme};

use canvas::Canvas;

/// A chart: plots in rows, with one title and one legend.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartFigure {
    /// Scene, machine and size: what was measured.
    pub title: String,
    /// Words on how to read it; empty for none.
    pub note: String,
    /// Plots in rows; a figure of one column has one in each row.
    pub rows: Vec<Vec<Plot>>,
}

/// One plot: two axes with series between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Name above it; empty for none.
    pub title: String,
    /// The axis to the right.
    pub x: ChartAxis,
    /// The axis upwards.
    pub y: ChartAxis,
    /// Series, those below first.
    pub series: Vec<ChartSeries>,
    /// Height as a part of the width.
    pub aspect: f64,
}

/// An axis of a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartAxis {
    /// Name with its unit.
    pub name: String,
    /// Places of numbers on it.
    pub kind: AxisKind,
}

/// Places of numbers on an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum AxisKind {
    /// Equal differences are equally long; from 0 on.
    FromZero,
    /// Equal differences are equally long; around the numbers.
    Linear,
    /// Equal quotients are equally long.
    Logarithmic,
    /// Names side by side: number 0 stands for the first one.
    Names(Vec<String>),
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartSeries {
    /// Name in the legend; series of one name look alike and stand there once. Empty for none.
    pub name: String,
    /// Number of its colour and mark.
    pub look: Look,
    /// The line between its points.
    pub line: ChartLine,
    /// True where its points have marks.
    pub is_marked: bool,
    /// The points, in the order of the line.
    pub points: Vec<ChartPoint>,
}

/// Colour and mark of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// One of those that differ from each other, by number.
    Numbered(usize),
    /// Stays behind the others.
    Muted,
}

/// Line of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChartLine {
    /// None.
    None,
    /// Whole.
    Solid,
    /// Long dashes.
    Dashed,
    /// Short dashes.
    Dotted,
}

/// A point of a series.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartPoint {
    /// Place on the axis to the right.
    pub x: f64,
    /// Place on the axis upwards.
    pub y: f64,
    /// Name beside it, where there is room for it in the figure.
    pub label: Option<PointLabel>,
    /// Words that a viewer of SVG shows over it; empty for none.
    pub tip: String,
    /// Ends of an upright bar through it, on the axis upwards.
    pub bar: Option<[f64; 2]>,
}

/// Name of a point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PointLabel {
    /// The name.
    pub words: String,
    /// True where a figure of one column shows it too.
    pub is_important: bool,
}

impl ChartPoint {
    /// A point without a name.
    pub fn new(x: f64, y: f64) -> ChartPoint {
        ChartPoint { x, y, label: None, tip: String::new(), bar: None }
    }
}

/// The figure as an SVG file.
pub fn svg(figure: &ChartFigure, style: ChartStyle) -> String {
    svg::text(&drawn(figure, style), &figure.title)
}

/// The flame graph as an SVG file.
pub fn flame_svg(figure: &FlameFigure, style: ChartStyle) -> String {
    svg::text(&flame::figure(figure, style), &figure.title)
}

/// The flame graph as a PDF file of one page.
pub fn flame_pdf(figure: &FlameFigure, style: ChartStyle) -> Vec<u8> {
    pdf::octets(&flame::figure(figure, style))
}

/// The figure as a PDF file of one page.
pub fn pdf(figure: &ChartFigure, style: ChartStyle) -> Vec<u8> {
    pdf::octets(&drawn(figure, style))
}

/// The diagram as an SVG file.
pub fn diagram_svg(figure: &DiagramFigure, style: ChartStyle) -> String {
    svg::text(&diagram::figure(figure, style), &figure.title)
}

/// The diagram as a PDF file of one page.
pub fn diagram_pdf(figure: &DiagramFigure, style: ChartStyle) -> Vec<u8> {
    pdf::octets(&diagram::figure(figure, style))
}

fn drawn(figure: &ChartFigure, style: ChartStyle) -> Canvas {
    draw::figure(figure, style)
}
