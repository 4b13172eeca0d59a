//! Flame graphs: a row of boxes for each level of calls, the callers below, each box as wide as what it stands for is long.

use super::canvas::{Canvas, Colour, TextAnchor, TextLine};
use super::font;
use super::page::{EDGE, Page};
use super::style::{ChartStyle, ChartTheme};

/// A flame graph.
#[derive(Clone, Debug, PartialEq)]
pub struct FlameFigure {
    /// Scene, machine and size: what was measured.
    pub title: String,
    /// Words on how to read it; empty for none.
    pub note: String,
    /// The lowest box, as wide as the figure.
    pub root: FlameNode,
}

/// A box of a flame graph, with those on top of it.
#[derive(Clone, Debug, PartialEq)]
pub struct FlameNode {
    /// Name in the box, as far as there is room.
    pub name: String,
    /// Width of the box; those on top have at most as much together.
    pub weight: u64,
    /// Colour of the box.
    pub kind: FlameKind,
    /// Words that a viewer of SVG shows over it.
    pub tip: String,
    /// Boxes on top of it, from the left on.
    pub children: Vec<FlameNode>,
}

/// Kind of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlameKind {
    /// Work that is done.
    Work,
    /// Waiting.
    Wait,
}

impl FlameNode {
    /// A box of no width.
    pub fn new(name: &str, kind: FlameKind) -> FlameNode {
        FlameNode { name: name.to_owned(), weight: 0, kind, tip: String::new(), children: Vec::new() }
    }

    fn levels(&self) -> usize {
        1 + self.children.iter().map(FlameNode::levels).max().unwrap_or(0)
    }
}

/// Size of the letters in boxes, in points.
const NAME: f64 = 7.0;

/// Height of a box, and the gap around it.
const BOX: f64 = 12.0;
const GAP: f64 = 0.5;

/// Width below which a box is not drawn.
const LEAST: f64 = 0.15;

/// Tints of boxes, of which neighbours take different ones: dark letters are read on those of the light theme, light ones on the others.
const fn tints(theme: ChartTheme, kind: FlameKind) -> [Colour; 3] {
    match (theme, kind) {
        (ChartTheme::Light, FlameKind::Work) => {
            [Colour([0xF6, 0xC9, 0x8A]), Colour([0xF9, 0xD7, 0xA6]), Colour([0xF2, 0xBC, 0x74])]
        }
        (ChartTheme::Light, FlameKind::Wait) => {
            [Colour([0x9C, 0xCB, 0xEA]), Colour([0xB4, 0xD8, 0xF0]), Colour([0x86, 0xBF, 0xE4])]
        }
        (ChartTheme::Dark, FlameKind::Work) => {
            [Colour([0x8A, 0x52, 0x14]), Colour([0x7A, 0x47, 0x10]), Colour([0x99, 0x5D, 0x1A])]
        }
        (ChartTheme::Dark, FlameKind::Wait) => {
            [Colour([0x1B, 0x5A, 0x86]), Colour([0x16, 0x4C, 0x73]), Colour([0x22, 0x68, 0x99])]
        }
    }
}

/// A flame graph on its page.
pub(super) fn figure(figure: &FlameFigure, style: ChartStyle) -> Canvas {
    let mut page = Page::new(&figure.title, &figure.note, style);
    let bottom = page.y + EDGE + BOX * figure.root.levels() as f64;
    let scale = (page.canvas.size.0 - 2.0 * EDGE) / figure.root.weight.max(1) as f64;
    FlamePage { page: &mut page.canvas, style, scale }.draw(&figure.root, EDGE, bottom, 0);
    page.y = bottom + EDGE;
    page.finish()
}

/// The page while boxes are drawn on it.
struct FlamePage<'a> {
    page: &'a mut Canvas,
    style: ChartStyle,
    /// Points of a unit of weight.
    scale: f64,
}

impl FlamePage<'_> {
    /// A box with its left lower corner, and all on top of it.
    fn draw(&mut self, node: &FlameNode, left: f64, bottom: f64, number: usize) {
        let width = node.weight as f64 * self.scale;
        if width < LEAST {
            return;
        }
        let (right, top) = (left + (width - GAP).max(LEAST), bottom - BOX + GAP);
        let colour = tints(self.style.theme, node.kind)[number % 3];
        self.page.area(vec![(left, bottom), (right, bottom), (right, top), (left, top)], colour, &node.tip);
        let words = fitting(&node.name, right - left - 4.0);
        if !words.is_empty() {
            let (at, colour, anchor) = ((left + 2.0, bottom - 3.4), self.style.theme.ink(), TextAnchor::Start);
            self.page.text(TextLine { at, anchor, size: NAME, is_bold: false, is_turned: false, colour, words });
        }
        let mut x = left;
        for (at, child) in node.children.iter().enumerate() {
            self.draw(child, x, bottom - BOX, number + 1 + at);
            x += child.weight as f64 * self.scale;
        }
    }
}

/// As much of a name as fits some points, with dots where it goes on; nothing where not even three letters fit.
fn fitting(name: &str, room: f64) -> String {
    if font::width(name, NAME, false) <= room {
        return name.to_owned();
    }
    let letters: Vec<char> = name.chars().collect();
    let cut = |length: usize| letters[..length].iter().collect::<String>() + "..";
    (3..letters.len()).rev().map(cut).find(|cut| font::width(cut, NAME, false) <= room).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::canvas::DrawnShape;

    #[test]
    fn names_are_cut_where_there_is_no_room() {
        let whole = font::width("triangle", NAME, false);
        assert_eq!(fitting("triangle", whole), "triangle");
        assert!(fitting("triangle", whole - 0.1).ends_with(".."));
        assert_eq!(fitting("triangle", 8.0), "");
    }

    #[test]
    fn boxes_stand_on_those_of_their_callers() {
        let leaf = |name, weight| FlameNode { weight, ..FlameNode::new(name, FlameKind::Wait) };
        let children = vec![leaf("a", 60), leaf("b", 30)];
        let root = FlameNode { weight: 100, children, ..FlameNode::new("root", FlameKind::Work) };
        let canvas = figure(&FlameFigure { title: String::new(), note: String::new(), root }, ChartStyle::default());
        let areas: Vec<_> = canvas
            .shapes
            .iter()
            .filter_map(|shape| match shape {
                DrawnShape::Area { corners, .. } => Some(corners.clone()),
                _ => None,
            })
            .collect();
        let [_, root, a, b] = &areas[..] else { panic!("{areas:?}") };
        assert_eq!((root[0].1 - a[0].1, a[0].1), (BOX, b[0].1));
        assert!((b[0].0 - a[0].0 - 0.6 * (516.0 - 2.0 * EDGE)).abs() < 1e-9);
        assert!(b[1].0 < root[1].0);
    }
}
