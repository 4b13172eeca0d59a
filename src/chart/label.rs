//! Places of names beside points: no name covers a mark, another name or a line, and one that stands off its point has a line to it.

use super::canvas::PagePlace;

/// A rectangle, upright.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LabelBox {
    /// Left and upper corner.
    pub low: PagePlace,
    /// Right and lower corner.
    pub high: PagePlace,
}

impl LabelBox {
    /// The box around a place.
    pub fn around((x, y): PagePlace, half: f64) -> LabelBox {
        LabelBox { low: (x - half, y - half), high: (x + half, y + half) }
    }

    /// True where two boxes have an area in common.
    pub fn meets(&self, other: &LabelBox) -> bool {
        self.low.0 < other.high.0 && other.low.0 < self.high.0 && self.low.1 < other.high.1 && other.low.1 < self.high.1
    }

    fn holds(&self, other: &LabelBox) -> bool {
        other.low.0 >= self.low.0
            && other.high.0 <= self.high.0
            && other.low.1 >= self.low.1
            && other.high.1 <= self.high.1
    }

    /// True where a straight line goes through the box: the part of it between the box's sides, axis by axis, is not empty.
    fn is_crossed(&self, (from, to): (PagePlace, PagePlace)) -> bool {
        let (mut first, mut last) = (0.0f64, 1.0f64);
        for (from, to, low, high) in [(from.0, to.0, self.low.0, self.high.0), (from.1, to.1, self.low.1, self.high.1)]
        {
            let length = to - from;
            if length.abs() < 1e-12 {
                if from <= low || from >= high {
                    return false;
                }
                continue;
            }
            let (a, b) = ((low - from) / length, (high - from) / length);
            (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
        }
        first < last
    }

    /// The place in it that is nearest to another.
    fn nearest(&self, (x, y): PagePlace) -> PagePlace {
        (x.clamp(self.low.0, self.high.0), y.clamp(self.low.1, self.high.1))
    }
}

/// A name's place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedLabel {
    /// The room of the name.
    pub room: LabelBox,
    /// Line from the point to the name, where it stands off.
    pub leader: Option<(PagePlace, PagePlace)>,
}

/// Rooms and lines that names keep off.
#[derive(Clone, Debug)]
pub struct LabelPlacer {
    inside: LabelBox,
    /// Marks, then the names that have their places.
    boxes: Vec<LabelBox>,
    /// Number of marks.
    marks: usize,
    lines: Vec<(PagePlace, PagePlace)>,
}

/// Distances from the mark that are tried, in points.
const DISTANCES: [f64; 12] = [3.0, 6.0, 10.0, 15.0, 21.0, 28.0, 38.0, 50.0, 66.0, 86.0, 112.0, 146.0];

/// Directions that are tried, the first ones preferred: eighths of a turn, then those between them.
const DIRECTIONS: [f64; 16] = [0.0, 1.0, 7.0, 4.0, 3.0, 5.0, 2.0, 6.0, 0.5, 7.5, 3.5, 4.5, 1.5, 2.5, 5.5, 6.5];

/// Distance from which a name has a line to its point, in points.
const APART: f64 = 8.0;

impl LabelPlacer {
    /// Names stay `inside`, off `marks` and off `lines`.
    pub fn new(inside: LabelBox, marks: Vec<LabelBox>, lines: Vec<(PagePlace, PagePlace)>) -> LabelPlacer {
        LabelPlacer { inside, marks: marks.len(), boxes: marks, lines }
    }

    /// A place for a name of a size near a point; `None` where there is none.
    pub fn place(&mut self, at: PagePlace, size: (f64, f64)) -> Option<PlacedLabel> {
        // Near places come first, and among them those to the right, where names are read from.
        let places = DISTANCES.iter().flat_map(|&distance| DIRECTIONS.iter().map(move |&turn| (distance, turn)));
        let mut rooms = places.map(|(distance, turn)| placed(at, size, distance, turn));
        // In a cluster the line to a name may pass marks; names stay apart all the same.
        let is_free = |placed: &PlacedLabel| self.is_free(placed, &self.boxes);
        let is_free_of_names = |placed: &PlacedLabel| self.is_free(placed, &self.boxes[self.marks..]);
        let found = rooms.clone().find(is_free).or_else(|| rooms.find(is_free_of_names))?;
        self.boxes.push(found.room);
        self.lines.extend(found.leader);
        Some(found)
    }

    /// The room is free, and the line to it passes none of some boxes.
    fn is_free(&self, placed: &PlacedLabel, passed: &[LabelBox]) -> bool {
        let room = &placed.room;
        self.inside.holds(room)
            && !self.boxes.iter().any(|other| other.meets(room))
            && !self.lines.iter().any(|&line| room.is_crossed(line))
            // A line to a name may start in its own mark, and passes no other name.
            && placed.leader.is_none_or(|leader| {
                let is_own = |other: &LabelBox| other.nearest(leader.0) == leader.0;
                !passed.iter().any(|other| !is_own(other) && other.is_crossed(leader))
            })
    }
}

/// The room of a name whose nearest side is `distance` away from a point.
fn placed((x, y): PagePlace, (width, height): (f64, f64), distance: f64, turn: f64) -> PlacedLabel {
    let (sin, cos) = (turn * std::f64::consts::FRAC_PI_4).sin_cos();
    // The middle of the name lies in the direction, far enough for its half size.
    let (middle_x, middle_y) = (x + cos * (distance + width / 2.0), y - sin * (distance + height / 2.0));
    let room = LabelBox {
        low: (middle_x - width / 2.0, middle_y - height / 2.0),
        high: (middle_x + width / 2.0, middle_y + height / 2.0),
    };
    let leader = (distance > APART).then(|| ((x, y), room.nearest((x, y))));
    PlacedLabel { room, leader }
}

#[cfg(test)]
mod tests {
    use random::SplitMix64;

    use super::*;

    #[test]
    fn forty_names_in_a_cluster_do_not_meet() {
        let mut random = SplitMix64::new(7);
        for _ in 0..20 {
            let inside = LabelBox { low: (0.0, 0.0), high: (440.0, 300.0) };
            let mut place = |span: f64| 60.0 + span * random.unit();
            let points: Vec<PagePlace> = (0..40).map(|_| (place(250.0), place(120.0))).collect();
            let marks: Vec<LabelBox> = points.iter().map(|&point| LabelBox::around(point, 3.0)).collect();
            let mut placer = LabelPlacer::new(inside, marks.clone(), Vec::new());
            let rooms: Vec<LabelBox> =
                points.iter().filter_map(|&point| placer.place(point, (60.0, 7.0))).map(|placed| placed.room).collect();
            // Names for which there is no room are left out, which in a cluster as dense as this one is up to half of them.
            assert!(rooms.len() >= 20, "{} of 40 have a place", rooms.len());
            for (at, room) in rooms.iter().enumerate() {
                assert!(inside.holds(room));
                assert!(!rooms[..at].iter().chain(&marks).any(|other| other.meets(room)), "{room:?}");
            }
        }
    }

    #[test]
    fn lines_cross_boxes_or_pass_them() {
        let room = LabelBox { low: (0.0, 0.0), high: (10.0, 4.0) };
        for (line, expected) in [
            (((-5.0, 2.0), (15.0, 2.0)), true),
            (((-5.0, -2.0), (15.0, 6.0)), true),
            (((-5.0, 5.0), (15.0, 5.0)), false),
            (((-5.0, 2.0), (-1.0, 2.0)), false),
            (((12.0, -4.0), (12.0, 8.0)), false),
        ] {
            assert_eq!(room.is_crossed(line), expected, "{line:?}");
        }
    }
}
