//! The grid of a scene: where its origin lies, how fine its steps are, and how coordinates become raw integers. Which number of fraction
//! bits other quantities have is decided in [`crate::cadrage`].
//!
//! In words of 32 bits the middle of the scene's box, rounded to the grid, becomes 0, and the steps are the smallest power of two that keeps the triangles
//! within |x| <= 2^(word-2) - 4 raw. The eye takes no part: rays start where they enter the triangles' box. A light is near if its way to all points of the box is within
//! 2^(word-1) - 8 raw along each axis, since no ray starts at a light; steps are twice as long where that makes all lights near. Where it does not, the
//! far ones have longer steps of their own ([`Grid::light`]), so lights take one bit from the mesh at most. In shorter words, which have no part of a bit to give away,
//! lights take none, and steps are shorter than the power of two where the box leaves room (`fit.rs`). Everything is computed relative to the box and relative to its largest
//! coordinate's power of two, so a scene multiplied by 2^k, or moved by whole steps (as far as double precision holds the moved coordinates exactly),
//! gives the same raw integers.

mod fit;

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
    /// Raw units in a scene unit, as a power of two, but for the stretch: raw = (x - centre) 2^position stretch.
    pub position: i32,
    /// Factor by which steps are shorter than 2^-position: 1 in words of 32 bits, else 1 (31/32 where the position is given) up to about 2. In programs, whose positions and distances are
    /// multiples of 2^-position, a scene unit is this long.
    pub stretch: f64,
    /// Box of the triangles, raw: where rays start and end.
    pub reach: Bounds,
    /// Along each axis the longest way within that box, or from it to a light without longer steps, raw.
    pub span: [u32; 3],
    /// Box of the triangles in scene units; that of an empty scene is -1 to 1.
    corners: Corners,
    /// Coordinates are multiplied by 2^-unit before anything else, which makes the largest less than 1.
    unit: i32,
    /// The point that everything is computed from, after that multiplication.
    base: Vec3,
    /// Distance of `base` from raw 0, in raw units.
    offset: Vec3,
}

/// Position of a light, in steps of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GridLight {
    /// The position in steps of 2^exponent raw units.
    pub position: [i32; 3],
    /// Length of a step as a power of two, in raw units; 0 for a light near the scene.
    pub exponent: u32,
}

impl Grid {
    /// The grid of a scene for words of `word` bits; `position` replaces the finest possible steps by coarser ones.
    ///
    /// # Errors
    /// When a word is not 8 to 32 bits long, when scene or view are not usable ([`Scene::check`], [`View::check`]), when `position` does not leave room for all points, and when
    /// the longest side of the triangles' box keeps fewer than [`FEWEST_BITS`] bits, that is, is shorter than 2^8 raw. Words of less than 12
    /// bits, which hold no such box beside much else, need 2^(word-4). A box that is a single point has nothing to lose and passes.
    pub fn new(scene: &Scene, view: &View, word: u32, position: Option<i32>) -> Result<Grid, Report> {
        Grid::chosen(scene, view, (word, position), word < fit::LONGEST)
    }

    /// The grid with steps of a power of two in any word, for layouts that round coordinates once more and so move corners out of a box that fills the word.
    ///
    /// # Errors
    /// Those of [`Grid::new`].
    pub fn of_powers(scene: &Scene, view: &View, word: u32, position: Option<i32>) -> Result<Grid, Report> {
        Grid::chosen(scene, view, (word, position), false)
    }

    fn chosen(
        scene: &Scene,
        view: &View,
        (word, position): (u32, Option<i32>),
        is_fitted: bool,
    ) -> Result<Grid, Report> {
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
        let unit = exponent(largest(corners.0).max(largest(corners.1)));
        let down = |p: Vec3| p.map(|x| shifted(x, -unit));
        let box_down = (down(corners.0), down(corners.1));
        let grid = |power: i32| Grid::with(box_down, corners, word, unit, power);
        let limit = box_limit(word);
        let middle = camera::centre(box_down);
        let far = largest(sub(box_down.0, middle)).max(largest(sub(box_down.1, middle)));
        // Begin a step or two finer than the extent says, and go down: rounding decides which is the finest that fits.
        let mut power = exponent(limit as f64) - if far > 0.0 { exponent(far) } else { 1 } + 2;
        let finest = loop {
            match grid(power) {
                Some(finest) => break finest,
                None => power -= 1,
            }
        };
        let has_near_lights = |grid: &Grid| scene.lights.iter().all(|light| grid.light(light.position).exponent == 0);
        let powers = match position {
            None if is_fitted || has_near_lights(&finest) => finest,
            None => grid(power - 1).filter(has_near_lights).unwrap_or(finest),
            // A format that the user sets may be coarser than the finest, and is refused if it does not fit.
            Some(position) => grid(position.clamp(-5000, 5000) + unit).ok_or_else(|| {
                Diagnostic::error(format!("positions with {position} fraction bits do not fit a word of {word} bits"))
                    .hint(format!("this scene has room for pos={} or less", finest.position))
            })?,
        };
        // With a position that is given the box keeps its bits, so that steps are the same in any word that has these bits.
        let room = if position.is_some() { (powers.width(), fit::LEAST_GIVEN) } else { (word, 1.0) };
        let fitted = || fit::fitted(&powers, room, scene, view);
        let mut chosen = if is_fitted { fitted().unwrap_or(powers) } else { powers };
        let bounds = chosen.bounds();
        let side = AXES.map(|axis| bounds.side(axis)).into_iter().max().unwrap_or(0);
        if corners.0 != corners.1 && side < 1 << FEWEST_BITS.min(word - 4) {
            return Err(too_coarse(&chosen, side, position.is_some()).into());
        }
        for light in &scene.lights {
            if let GridLight { position, exponent: 0 } = chosen.light(light.position) {
                let way = |k: usize| position[k].abs_diff(bounds.low[k]).max(position[k].abs_diff(bounds.high[k]));
                chosen.span = AXES.map(|k| chosen.span[k].max(way(k)));
            }
        }
        Ok(chosen)
    }

    /// The grid with 2^power steps in a unit; `None` when the box does not fit.
    fn with(box_down: Corners, corners: Corners, word: u32, unit: i32, power: i32) -> Option<Grid> {
        let limit = box_limit(word) as f64;
        let base = AXES.map(|k| rounded_middle(box_down.0[k], box_down.1[k], power));
        let raw = |at: Vec3| AXES.map(|k| nearest(shifted(at[k] - base[k], power)));
        let (low, high) = (raw(box_down.0), raw(box_down.1));
        let is_inside = AXES.iter().all(|&k| low[k] >= -limit && high[k] <= limit);
        let reach = Bounds { low: low.map(|x| x as i32), high: high.map(|x| x as i32) };
        let span = AXES.map(|k| (high[k] - low[k]) as u32);
        let (position, stretch, offset) = (power - unit, 1.0, [0.0; 3]);
        is_inside.then_some(Grid { word, position, stretch, reach, span, corners, unit, base, offset })
    }

    /// Bits of the shortest word whose box holds that of the triangles, but for the four numbers that boxes leave free at each end.
    fn width(&self) -> u32 {
        let raw = self.reach.low.iter().chain(&self.reach.high).map(|x| i64::from(x.unsigned_abs())).max();
        (5..self.word).find(|&width| raw.is_none_or(|raw| raw <= 1 << (width - 2))).unwrap_or(self.word)
    }

    /// A light on the grid, in the finest steps in which the way from any point of the box to it fits: 2^(word-1) - 8 along each axis, since no ray starts
    /// at a light.
    ///
    /// In words of 32 bits a light 3 sizes away from a box of 2^31 raw units has a way of up to 2^33 raw, and steps of 2^2; at 3,000 sizes they are 2^12.
    /// Each keeps as many bits of its way as a near one.
    pub fn light(&self, position: Vec3) -> GridLight {
        let farthest = ((1i64 << (self.word - 1)) - 8) as f64;
        let bounds = self.bounds();
        let power = self.position + self.unit;
        // Both are scaled before they are subtracted, which gives the same: a light may be so far that it leaves double precision in raw units.
        let place = |exponent: i32| {
            let from_base =
                AXES.map(|k| shifted(position[k], self.position - exponent) - shifted(self.base[k], power - exponent));
            AXES.map(|k| from_base[k] * self.stretch + shifted(self.offset[k], -exponent))
        };
        let fits = |exponent: i32| {
            let at = place(exponent).map(nearest);
            let end = |x: i32| shifted(f64::from(x), -exponent);
            // Where steps are longer the point is rounded, too.
            let slack = if exponent == 0 { 0.0 } else { 1.0 };
            let is_near = |k: usize| at[k] - end(bounds.low[k]) <= farthest && end(bounds.high[k]) - at[k] <= farthest;
            let is_short = AXES.iter().all(|&k| is_near(k) && at[k].abs() <= farthest + slack);
            is_short.then(|| GridLight { position: at.map(|x| x as i32), exponent: exponent as u32 })
        };
        let raw = largest(place(0));
        let bits = if raw.is_finite() { exponent(raw) } else { exponent(largest(position)) + self.position };
        // A step of one more bit than that never fits, so the search begins below the answer and ends a few steps on.
        ((bits - self.word as i32).max(0)..).find_map(fits).expect("there are steps that are long enough")
    }

    /// A point relative to the grid's origin in raw units, not rounded.
    pub fn local(&self, point: Vec3) -> Vec3 {
        AXES.map(|k| {
            let from_base = shifted(shifted(point[k], -self.unit) - self.base[k], self.position + self.unit);
            from_base * self.stretch + self.offset[k]
        })
    }

    /// A point on the grid: the nearest raw coordinates, ties up, saturated to the word.
    pub fn raw(&self, point: Vec3) -> [i32; 3] {
        let most = (1i64 << (self.word - 1)) as f64;
        self.local(point).map(|x| nearest(x).clamp(-most, most - 1.0) as i32)
    }

    /// The point of the scene that raw coordinates stand for.
    pub fn scene(&self, raw: [i32; 3]) -> Vec3 {
        AXES.map(|k| {
            let from_base = (f64::from(raw[k]) - self.offset[k]) / self.stretch;
            shifted(shifted(from_base, -(self.position + self.unit)) + self.base[k], self.unit)
        })
    }

    /// Length of a step in scene units.
    pub fn step(&self) -> f64 {
        shifted(1.0 / self.stretch, -self.position)
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

/// Farthest raw coordinate of a triangle's corner from 0, in a word or in that part of it which the box is to take.
const fn box_limit(width: u32) -> i64 {
    (1 << (width - 2)) - 4
}

/// Middle of `low` and `high` on the grid of 2^power steps in a unit. It is counted in steps from `low`, so that it moves with the scene.
fn rounded_middle(low: f64, high: f64, power: i32) -> f64 {
    let steps = shifted(low, power);
    // From 2^52 steps on, double precision holds whole steps only.
    let floor = if steps.abs() < (1u64 << 52) as f64 { shifted(steps.floor(), -power) } else { low };
    let half = shifted((low - floor) + (high - low) / 2.0, power);
    if half.abs() < (1u64 << 52) as f64 { floor + shifted(nearest(half), -power) } else { low / 2.0 + high / 2.0 }
}

fn too_coarse(grid: &Grid, side: u32, is_chosen: bool) -> Diagnostic {
    let needed = FEWEST_BITS.min(grid.word - 4);
    let message = format!(
        "the scene's box is {side} grid steps long in words of {} bits, which is less than {needed} bits ({} steps)",
        grid.word,
        1 << needed
    );
    let hint = if is_chosen { "choose a larger pos, or leave it out" } else { "use a longer word with --word" };
    Diagnostic::error(message).hint(hint)
}

#[cfg(test)]
mod tests;
