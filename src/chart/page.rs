//! A page that is filled from the top down, under a title and a note; the ground is laid under what stands on it when its height is known.

use super::canvas::{Canvas, TextAnchor, TextLine};
use super::font;
use super::style::ChartStyle;

/// Sizes of letters in points.
const TITLE: f64 = 9.5;
pub(super) const TEXT: f64 = 7.5;

/// Room at the edges, in points.
pub(super) const EDGE: f64 = 8.0;

/// A page on which shapes are drawn.
pub(super) struct Page {
    /// Shapes so far; the height is not known yet.
    pub canvas: Canvas,
    pub style: ChartStyle,
    /// Height of what is drawn.
    pub y: f64,
}

impl Page {
    /// The page with its title and what is said below it.
    pub fn new(title: &str, note: &str, style: ChartStyle) -> Page {
        let canvas = Canvas { size: (style.columns.points(), 0.0), shapes: Vec::new() };
        let mut page = Page { canvas, style, y: EDGE };
        page.paragraph(title, TITLE, true);
        page.paragraph(note, TEXT, false);
        page
    }

    /// Words in as many lines as they take.
    fn paragraph(&mut self, words: &str, size: f64, is_bold: bool) {
        let most = self.canvas.size.0 - 2.0 * EDGE;
        for words in font::wrapped(words, size, is_bold, most) {
            self.y += size * 1.1;
            let (at, colour) = ((EDGE, self.y), self.style.theme.ink());
            let anchor = TextAnchor::Start;
            self.canvas.text(TextLine { at, anchor, size, is_bold, is_turned: false, colour, words });
            self.y += size * 0.2;
        }
    }

    /// The shapes on their ground, which is as high as what stands on it.
    pub fn finish(self) -> Canvas {
        let (width, height) = (self.canvas.size.0, self.y.ceil());
        let mut canvas = Canvas { size: (width, height), shapes: Vec::new() };
        let ground = vec![(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
        canvas.area(ground, self.style.theme.ground(), "");
        canvas.shapes.extend(self.canvas.shapes);
        canvas
    }
}
