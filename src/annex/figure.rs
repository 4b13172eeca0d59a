//! The report's figures as pictures of what is here: the cost of a plane along an axis (figure 6), a walk through a ray tree (7), the machine (8) and one
//! of its coprocessors (9). Each is made of the data that a picture is drawn from; nothing here draws a line itself.

mod cost;
mod machine;
mod walk;

pub use cost::cost;
pub use machine::{coprocessor, machine};
pub use walk::walk;

use crate::chart::{self, ChartFigure, ChartStyle, DiagramFigure};

/// A figure that is ready to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum ReportFigure {
    /// Plots.
    Chart(ChartFigure),
    /// Boxes and lines.
    Diagram(DiagramFigure),
}

impl ReportFigure {
    /// The figure as a file, PDF where its name ends so, else SVG.
    pub fn file(&self, is_pdf: bool, style: ChartStyle) -> Vec<u8> {
        match (self, is_pdf) {
            (ReportFigure::Chart(figure), true) => chart::pdf(figure, style),
            (ReportFigure::Chart(figure), false) => chart::svg(figure, style).into_bytes(),
            (ReportFigure::Diagram(figure), true) => chart::diagram_pdf(figure, style),
            (ReportFigure::Diagram(figure), false) => chart::diagram_svg(figure, style).into_bytes(),
        }
    }
}
