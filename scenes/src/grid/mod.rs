//! The grid of a scene: where its origin lies, how fine its steps are, and how coordinates become raw integers. Which number of fraction
//! bits other quantities have is decided in [`crate::cadrage`].
//!
//! The middle of the scene's box, rounded to the grid, becomes 0, and the steps are the smallest power of two that keeps the triangles
//! within |x| <= 2^(word-2) - 4 raw, and the way from any of their points to a light within 2^(word-1) - 8 along each axis: no ray
//! starts at a light, so a light may stand twice as far away. The eye takes no part: rays start where they enter the triangles' box. Everything is computed relative to the box and relative to the largest coordinate's
//! power of two, so a scene multiplied by 2^k, or moved by whole steps (as far as double precision holds the moved coordinates exactly),
//! gives the same raw integers.

use messages::{Diagnostic, Report};

use crate::camera::{self, Corners};
use crate::kdtree::Bounds;
use crate::model::{Scene, Vec3, View};
use crate::vector::{AXES, exponent, largest, nearest, shifted, sub};

/// Fewest bits of a coordinate that the scene's box may keep, in words that can hold as many.
pub const FEWEST_BITS: u32 = 8;

/// Place and scale of a scene on the integers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Bits of a raw coordinate, with its sign.
    pub word: u32,
    /// Raw units in a scene unit, as a power of two: raw = (x - centre) 2^position.
    pub position: i32,
    /// Box of the triangles, raw: where rays start and end.
    pub reach: Bounds,
    /// Along each axis the longest way within that box, or from it to a light, raw.
    pub span: [u32; 3],
    /// Box of the triangles in scene units; that of an empty scene is -1 to 1.
    corners: Corners,
    /// Coordinates are multiplied by 2^-unit before anything else, which makes the largest less than 1.
    unit: i32,
    /// The point that becomes 0, after that multiplication.
    middle: Vec3,
}

/// A thing that a grid has to hold, with a name for messages.
struct GridPoint {
    name: &'static str,
    number: usize,
    at: Vec3,
}

impl GridPoint {
    fn is_light(&self) -> bool {
        self.name == "light"
    }
}

impl Grid {
    /// The grid of a scene for words of `word` bits; `position` replaces the finest possible steps by coarser ones.
    ///
    /// # Errors
    /// When a word is not 8 to 32 bits long, when scene or view are not usable ([`Scene::check`], [`View::check`]), when `position` does not leave room for all points, and when
    /// the longest side of the triangles' box keeps fewer than [`FEWEST_BITS`] bits, that is, is shorter than 2^8 raw. Words of less than 12
    /// bits, which hold no such box beside much else, need 2^(word-4). A box that is a single point has nothing to lose and passes.
    pub fn new(scene: &Scene, view: &View, word: u32, position: Option<i32>) -> Result<Grid, Report> {
        if !(8..=32).contains(&word) {
            return Err(Diagnostic::error(format!("a word of {word} bits is not supported"))
                .hint("--word takes 8 to 32")
                .into());
        }
        // Everything that is wrong with scene and view at once, before numbers are made of them.
        let mut report = scene.check();
        report.0.extend(view.check().0);
        if report.has_errors() {
            return Err(report);
        }
        let corners = scene.bounds().unwrap_or(([-1.0; 3], [1.0; 3]));
        let mut points = vec![
            GridPoint { name: "the scene's corner", number: 1, at: corners.0 },
            GridPoint { name: "the scene's corner", number: 2, at: corners.1 },
        ];
        points.extend(scene.lights.iter().enumerate().map(|(k, light)| GridPoint {
            name: "light",
            number: k + 1,
            at: light.position,
        }));
        let unit = points.iter().map(|p| p.at).map(largest).fold(0.0, f64::max);
        let unit = exponent(unit);
        let down = |p: Vec3| p.map(|x| shifted(x, -unit));
        for point in &mut points {
            point.at = down(point.at);
        }
        let box_down = (points[0].at, points[1].at);
        let grid = |power: i32| Grid::with(&points, corners, word, unit, power);
        let limit = (1i64 << (word - 2)) - 4;
        let middle = camera::centre(box_down);
        let far = points.iter().map(|p| largest(sub(p.at, middle))).fold(0.0, f64::max);
        // Begin a step or two finer than the extent says, and go down: rounding decides which is the finest that fits.
        let mut power = exponent(limit as f64) - if far > 0.0 { exponent(far) } else { 1 } + 2;
        let finest = loop {
            match grid(power) {
                Some(finest) => break finest,
                None => power -= 1,
            }
        };
        // A format that the user sets may be coarser than the finest, and is refused if it does not fit.
        let chosen = match position {
            Some(position) => grid(position.clamp(-5000, 5000) + unit).ok_or_else(|| {
                Diagnostic::error(format!("positions with {position} fraction bits do not fit a word of {word} bits"))
                    .hint(format!("this scene has room for pos={} or less", finest.position))
            })?,
            None => finest,
        };
        let bounds = chosen.bounds();
        let side = AXES.map(|axis| bounds.side(axis)).into_iter().max().unwrap_or(0);
        if corners.0 != corners.1 && side < 1 << FEWEST_BITS.min(word - 4) {
            return Err(too_coarse(&chosen, &points, side, position.is_some()).into());
        }
        Ok(chosen)
    }

    /// The grid with 2^power steps in a unit; `None` when a point does not fit.
    fn with(points: &[GridPoint], corners: Corners, word: u32, unit: i32, power: i32) -> Option<Grid> {
        let limit = ((1i64 << (word - 2)) - 4) as f64;
        let farthest = ((1i64 << (word - 1)) - 8) as f64;
        let middle = AXES.map(|k| rounded_middle(points[0].at[k], points[1].at[k], power));
        let raw = |point: &GridPoint| AXES.map(|k| nearest(shifted(point.at[k] - middle[k], power)));
        let (lights, others): (Vec<&GridPoint>, Vec<&GridPoint>) = points.iter().partition(|point| point.is_light());
        // The reach is that of all but the lights, since rays start and end there; a light counts by its way to them.
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for at in others.into_iter().map(raw) {
            low = AXES.map(|k| low[k].min(at[k]));
            high = AXES.map(|k| high[k].max(at[k]));
        }
        let mut span = AXES.map(|k| high[k] - low[k]);
        for at in lights.into_iter().map(raw) {
            span = AXES.map(|k| span[k].max(at[k] - low[k]).max(high[k] - at[k]));
        }
        let is_inside = AXES.iter().all(|&k| low[k] >= -limit && high[k] <= limit && span[k] <= farthest);
        let reach = Bounds { low: low.map(|x| x as i32), high: high.map(|x| x as i32) };
        let span = span.map(|x| x as u32);
        is_inside.then_some(Grid { word, position: power - unit, reach, span, corners, unit, middle })
    }

    /// A point relative to the grid's origin in raw units, not rounded.
    pub fn local(&self, point: Vec3) -> Vec3 {
        AXES.map(|k| shifted(shifted(point[k], -self.unit) - self.middle[k], self.position + self.unit))
    }

    /// A point on the grid: the nearest raw coordinates, ties up, saturated to the word.
    pub fn raw(&self, point: Vec3) -> [i32; 3] {
        let most = (1i64 << (self.word - 1)) as f64;
        self.local(point).map(|x| nearest(x).clamp(-most, most - 1.0) as i32)
    }

    /// The point of the scene that raw coordinates stand for.
    pub fn scene(&self, raw: [i32; 3]) -> Vec3 {
        AXES.map(|k| {
            let step = shifted(f64::from(raw[k]), -(self.position + self.unit));
            shifted(step + self.middle[k], self.unit)
        })
    }

    /// The point of the scene that lies at raw 0.
    pub fn centre(&self) -> Vec3 {
        self.scene([0; 3])
    }

    /// Box of the triangles, raw; of an empty scene that from -1 to 1.
    pub fn bounds(&self) -> Bounds {
        Bounds { low: self.raw(self.corners.0), high: self.raw(self.corners.1) }
    }

    /// Box of the triangles relative to the grid's origin in raw units, not rounded.
    pub fn local_corners(&self) -> Corners {
        (self.local(self.corners.0), self.local(self.corners.1))
    }
}

/// Middle of `low` and `high` on the grid of 2^power steps in a unit. It is counted in steps from `low`, so that it moves with the scene.
fn rounded_middle(low: f64, high: f64, power: i32) -> f64 {
    let steps = shifted(low, power);
    // From 2^52 steps on, double precision holds whole steps only.
    let floor = if steps.abs() < (1u64 << 52) as f64 { shifted(steps.floor(), -power) } else { low };
    let half = shifted((low - floor) + (high - low) / 2.0, power);
    if half.abs() < (1u64 << 52) as f64 { floor + shifted(nearest(half), -power) } else { low / 2.0 + high / 2.0 }
}

fn too_coarse(grid: &Grid, points: &[GridPoint], side: u32, is_chosen: bool) -> Diagnostic {
    let needed = FEWEST_BITS.min(grid.word - 4);
    let message = format!(
        "the scene's box is {side} grid steps long in words of {} bits, which is less than {needed} bits ({} steps)",
        grid.word,
        1 << needed
    );
    let distance = |p: &GridPoint| largest(sub(p.at, grid.middle)) * if p.is_light() { 0.5 } else { 1.0 };
    let farthest = points.iter().rev().max_by(|a, b| distance(a).total_cmp(&distance(b)));
    let hint = match farthest {
        _ if is_chosen => "choose a larger pos, or leave it out".to_string(),
        Some(p) if p.is_light() => {
            format!(
                "light {} stands far away and sets the scale: move it nearer, or use a longer word with --word",
                p.number
            )
        }
        _ => "use a longer word with --word".to_string(),
    };
    Diagnostic::error(message).hint(hint)
}

#[cfg(test)]
mod tests;
