//! Diagrams: boxes with words and lines between them, at places that are parts of the page's width.

use super::canvas::{Canvas, PagePlace, TextAnchor, TextLine};
use super::page::{EDGE, Page, TEXT};
use super::style::{ChartStyle, ChartTheme, dashes};
use super::{ChartLine, Look, font};

/// A diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct DiagramFigure {
    /// Title: what is shown.
    pub title: String,
    /// Words on how to read it; empty for none.
    pub note: String,
    /// Height as a part of the width.
    pub aspect: f64,
    /// Lines, which lie on boxes that are around others, and below all others.
    pub links: Vec<DiagramLink>,
    /// The boxes.
    pub boxes: Vec<DiagramBox>,
}

/// A box. Places are to the right and downwards, in widths of the diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct DiagramBox {
    /// Middle of the box.
    pub middle: (f64, f64),
    /// Width and height of the box.
    pub size: (f64, f64),
    /// Words in it, a line each, the first one heavy; lines that do not fit are left out.
    pub words: Vec<String>,
    /// Colour of its frame.
    pub look: Look,
    /// True where what is in it stands at its top, because other boxes lie in it.
    pub is_around: bool,
    /// Words that a viewer of SVG shows over it; empty for none.
    pub tip: String,
}

/// A line through places, in widths of the diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct DiagramLink {
    /// The places.
    pub points: Vec<(f64, f64)>,
    /// Colour of the line.
    pub look: Look,
    /// Whole or dashed.
    pub line: ChartLine,
    /// Width of the line in points.
    pub width: f64,
    /// True where the line ends in an arrow.
    pub is_arrow: bool,
}

/// Height of a line of words, and the gap at the sides of a box, in points.
const LINE: f64 = 9.4;
const GAP: f64 = 2.5;

/// Length of an arrow's head in points.
const HEAD: f64 = 5.0;

/// A diagram on its page.
pub(super) fn figure(figure: &DiagramFigure, style: ChartStyle) -> Canvas {
    let mut page = Page::new(&figure.title, &figure.note, style);
    let width = page.canvas.size.0 - 2.0 * EDGE;
    let top = page.y + EDGE;
    let mut drawing = DiagramPage { canvas: &mut page.canvas, theme: style.theme, width, top };
    let (around, others): (Vec<_>, Vec<_>) = figure.boxes.iter().partition(|one| one.is_around);
    around.into_iter().for_each(|one| drawing.one_box(one));
    figure.links.iter().for_each(|link| drawing.link(link));
    others.into_iter().for_each(|one| drawing.one_box(one));
    page.y = top + width * figure.aspect + EDGE;
    page.finish()
}

/// The page while a diagram is drawn on it.
struct DiagramPage<'a> {
    canvas: &'a mut Canvas,
    theme: ChartTheme,
    width: f64,
    top: f64,
}

impl DiagramPage<'_> {
    fn place(&self, (x, y): (f64, f64)) -> PagePlace {
        (EDGE + x * self.width, self.top + y * self.width)
    }

    fn link(&mut self, link: &DiagramLink) {
        let points: Vec<PagePlace> = link.points.iter().map(|&point| self.place(point)).collect();
        let colour = self.theme.of(link.look);
        if let [.., from, to] = points[..]
            && link.is_arrow
        {
            self.canvas.area(head(from, to), colour, "");
        }
        self.canvas.line(points, colour, link.width, dashes(link.line));
    }

    fn one_box(&mut self, one: &DiagramBox) {
        let (x, y) = self.place(one.middle);
        let (half, tall) = (one.size.0 * self.width / 2.0, one.size.1 * self.width / 2.0);
        let corners = |by: f64| {
            vec![
                (x - half + by, y - tall + by),
                (x + half - by, y - tall + by),
                (x + half - by, y + tall - by),
                (x - half + by, y + tall - by),
            ]
        };
        // A frame is an area with a smaller one on it, since an area has no edge of its own.
        self.canvas.area(corners(0.0), self.theme.of(one.look), &one.tip);
        self.canvas.area(corners(0.9), self.theme.ground(), &one.tip);
        let lines: Vec<&String> = one.words.iter().take(((2.0 * tall - GAP) / LINE).max(0.0) as usize).collect();
        let start = match one.is_around {
            true => y - tall + LINE,
            false => y - LINE * lines.len() as f64 / 2.0 + 0.78 * LINE,
        };
        for (number, words) in lines.into_iter().enumerate() {
            let is_bold = number == 0;
            if font::width(words, TEXT, is_bold) <= 2.0 * half - 2.0 * GAP {
                self.words(words, (x, start + LINE * number as f64), is_bold);
            }
        }
    }

    fn words(&mut self, words: &str, at: PagePlace, is_bold: bool) {
        let (anchor, colour) = (TextAnchor::Middle, self.theme.ink());
        self.canvas.text(TextLine {
            at,
            anchor,
            size: TEXT,
            is_bold,
            is_turned: false,
            colour,
            words: words.to_owned(),
        });
    }
}

/// Corners of an arrow's head at the end of a line.
fn head(from: PagePlace, to: PagePlace) -> Vec<PagePlace> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.hypot(dy).max(1e-9);
    let (ux, uy) = (dx / length * HEAD, dy / length * HEAD);
    let back = (to.0 - ux, to.1 - uy);
    vec![to, (back.0 - 0.45 * uy, back.1 + 0.45 * ux), (back.0 + 0.45 * uy, back.1 - 0.45 * ux)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::canvas::DrawnShape;

    fn one(words: &[&str], size: (f64, f64)) -> DiagramBox {
        let words = words.iter().map(|&words| words.to_owned()).collect();
        DiagramBox { middle: (0.5, 0.25), size, words, look: Look::Numbered(0), is_around: false, tip: String::new() }
    }

    fn texts(boxes: Vec<DiagramBox>) -> Vec<String> {
        let drawn = figure(
            &DiagramFigure { title: String::new(), note: String::new(), aspect: 0.5, links: Vec::new(), boxes },
            ChartStyle::default(),
        );
        let words = |shape: DrawnShape| match shape {
            DrawnShape::Text(line) => Some(line.words),
            _ => None,
        };
        drawn.shapes.into_iter().filter_map(words).collect()
    }

    #[test]
    fn words_that_do_not_fit_a_box_are_left_out() {
        assert_eq!(texts(vec![one(&["core", "18,525 octets"], (0.2, 0.1))]), ["core", "18,525 octets"]);
        assert_eq!(texts(vec![one(&["core", "18,525 octets"], (0.06, 0.1))]), ["core"]);
        assert_eq!(texts(vec![one(&["core", "18,525 octets"], (0.2, 0.025))]), ["core"]);
    }

    #[test]
    fn an_arrow_ends_where_its_line_does() {
        let corners = head((0.0, 0.0), (10.0, 0.0));
        assert_eq!(corners[0], (10.0, 0.0));
        assert!(corners[1..].iter().all(|corner| (corner.0 - 5.0).abs() < 1e-9));
    }
}
