//! Drawn shapes of a chart, in points from the top left corner, before they become a file.

use super::font;

/// A place: to the right and downwards.
pub type PagePlace = (f64, f64);

/// Red, green and blue as screens have them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub [u8; 3]);

/// Side of a text at which its place is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextAnchor {
    /// Left end.
    Start,
    /// Middle.
    Middle,
    /// Right end.
    End,
}

/// A text in one line.
#[derive(Clone, Debug, PartialEq)]
pub struct TextLine {
    /// Place of the base line.
    pub at: PagePlace,
    /// Side that is there.
    pub anchor: TextAnchor,
    /// Size of the letters in points.
    pub size: f64,
    /// Letters are heavy.
    pub is_bold: bool,
    /// The line goes upwards.
    pub is_turned: bool,
    /// Colour of the letters.
    pub colour: Colour,
    /// The words.
    pub words: String,
}

impl TextLine {
    /// Width in points.
    pub fn width(&self) -> f64 {
        font::width(&self.words, self.size, self.is_bold)
    }

    /// Place of the left end of a line that is not turned, or of the lower end of one that is.
    pub fn start(&self) -> PagePlace {
        let before = match self.anchor {
            TextAnchor::Start => 0.0,
            TextAnchor::Middle => self.width() / 2.0,
            TextAnchor::End => self.width(),
        };
        let (x, y) = self.at;
        if self.is_turned { (x, y + before) } else { (x - before, y) }
    }
}

/// A shape.
#[derive(Clone, Debug, PartialEq)]
pub enum DrawnShape {
    /// A line through places.
    Line {
        /// The places.
        points: Vec<PagePlace>,
        /// Colour of the line.
        colour: Colour,
        /// Width of the line in points.
        width: f64,
        /// Dashes and gaps in points; none for a whole line.
        dashes: &'static [f64],
    },
    /// An area between corners.
    Area {
        /// The corners.
        corners: Vec<PagePlace>,
        /// Colour of the area.
        colour: Colour,
        /// Words that a viewer of SVG shows over it; empty for none.
        tip: String,
    },
    /// A text.
    Text(TextLine),
}

/// A page of shapes, those below first.
#[derive(Clone, Debug, PartialEq)]
pub struct Canvas {
    /// Width and height in points.
    pub size: (f64, f64),
    /// The shapes.
    pub shapes: Vec<DrawnShape>,
}

impl Canvas {
    /// Adds a line.
    pub fn line(&mut self, points: Vec<PagePlace>, colour: Colour, width: f64, dashes: &'static [f64]) {
        self.shapes.push(DrawnShape::Line { points, colour, width, dashes });
    }

    /// Adds an area.
    pub fn area(&mut self, corners: Vec<PagePlace>, colour: Colour, tip: &str) {
        self.shapes.push(DrawnShape::Area { corners, colour, tip: tip.to_owned() });
    }

    /// Adds a text.
    pub fn text(&mut self, line: TextLine) {
        self.shapes.push(DrawnShape::Text(line));
    }
}
