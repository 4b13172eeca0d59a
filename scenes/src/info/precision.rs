//! Losses of a scene on the grid: how far its vertices move, and which triangles lose their area.

use schemars::JsonSchema;
use serde::Serialize;

use crate::image::MemoryImage;
use crate::model::{Scene, Vec3};
use crate::read::mesh::is_flat;
use crate::vector::shifted;

/// Distances by which vertices move when they are stored.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Precision {
    /// Distance of neighbouring stored coordinates, in scene units.
    pub step: f64,
    /// Factor by which steps are shorter than a power of two ([`crate::grid::Grid::stretch`]).
    pub stretch: f64,
    /// Longest side of the triangles' box in such steps.
    pub steps: u64,
    /// Largest distance between a triangle's corner and where it is stored, in scene units.
    pub largest_move: f64,
    /// Root of the mean square of these distances over all corners, in scene units.
    pub rms_move: f64,
    /// The largest distance as a share of the box's longest side; 0 for a box that is a point.
    pub largest_share: f64,
    /// The root of the mean square as a share of the box's longest side; 0 for a box that is a point.
    pub rms_share: f64,
    /// Triangles without area, before they are stored.
    pub degenerate: usize,
    /// Triangles that lose their area when they are stored; rays never hit them.
    pub collapsed: usize,
}

impl Precision {
    /// Compares the triangles of a scene with those of its image.
    pub fn new(scene: &Scene, image: &MemoryImage) -> Precision {
        // A stored coordinate is in steps of 2^shift raw ones: the layout `report` keeps 16 bits of a word of 24, so its step is 256.
        let shift = image.layout.coordinate_shift(image.formats.word);
        let inner = image.grid.bounds();
        let longest = [0, 1, 2].map(|axis| inner.side(axis)).into_iter().max().unwrap_or(0);
        let (mut largest, mut sum) = (0.0_f64, 0.0);
        let (mut degenerate, mut collapsed) = (0, 0);
        // Sum up how far corners move, and tell the triangles that never had an area from those that lose it
        for (number, triangle) in (0..).zip(&scene.triangles) {
            let corners = triangle.vertices.map(|vertex| scene.vertices[vertex as usize]);
            let Some(stored) = image.triangle(number) else { continue };
            for (corner, raw) in corners.iter().zip(stored.vertices) {
                let square = square_of_distance(image.grid.scene(raw), *corner);
                largest = largest.max(square);
                sum += square;
            }
            if is_flat(corners) {
                degenerate += 1;
            } else if is_flat_raw(stored.vertices) {
                collapsed += 1;
            }
        }
        // Take the mean over all corners, and shares of the longest side; a scene without triangles has zeros
        let corners = 3.0 * scene.triangles.len().max(1) as f64;
        let (largest_move, rms_move) = (largest.sqrt(), (sum / corners).sqrt());
        let share = |distance: f64| {
            let (low, high) = scene.bounds().unwrap_or_default();
            let side = [0, 1, 2].map(|k| high[k] - low[k]).into_iter().fold(0.0, f64::max);
            if side > 0.0 { distance / side } else { 0.0 }
        };
        Precision {
            step: shifted(image.grid.step(), shift as i32),
            stretch: image.grid.stretch,
            steps: u64::from(longest) >> shift,
            largest_move,
            rms_move,
            largest_share: share(largest_move),
            rms_share: share(rms_move),
            degenerate,
            collapsed,
        }
    }
}

fn square_of_distance(a: Vec3, b: Vec3) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// A stored triangle has no area, exactly.
fn is_flat_raw([a, b, c]: [[i32; 3]; 3]) -> bool {
    let edge = |p: [i32; 3]| [0, 1, 2].map(|k| i128::from(p[k]) - i128::from(a[k]));
    let (e, f) = (edge(b), edge(c));
    [(1, 2), (2, 0), (0, 1)].iter().all(|&(k, l)| e[k] * f[l] == e[l] * f[k])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate;
    use crate::image::{self, MemoryOptions};
    use crate::layout::Layout;
    use crate::model::View;

    fn precision(name: &str, options: MemoryOptions) -> Precision {
        let scene = generate::scene(name, &generate::GenerateOptions::default()).unwrap();
        Precision::new(&scene, &image::build(&scene, &View::new(scene.size), &options).unwrap())
    }

    #[test]
    fn shorter_words_move_corners_further() {
        let of = |word| precision("sphereflake", MemoryOptions { word, ..MemoryOptions::default() });
        let (long, short) = (of(32), of(16));
        // A bit is the near lights', which short words do not give away, and less than another one the stretch's.
        assert_eq!((short.step * short.stretch, long.stretch), (long.step * 32_768.0, 1.0));
        assert!((1.0..2.0).contains(&short.stretch), "{}", short.stretch);
        // Half a step along each of three axes is the worst.
        for precision in [long, short] {
            assert!(precision.largest_move <= 0.75_f64.sqrt() * precision.step * 1.000_001);
            assert!(precision.rms_move <= precision.largest_move && precision.rms_move > 0.1 * precision.step);
        }
        assert!(short.largest_move > 1000.0 * long.largest_move && short.steps < 1 << 15);
        assert!(short.largest_share < 1.0 / short.steps as f64 && short.rms_share < short.largest_share);
    }

    #[test]
    fn the_reports_layout_has_the_steps_of_16_bits() {
        let of = |layout, word| precision("terrain", MemoryOptions { layout, word, ..MemoryOptions::default() });
        let [long, middle, short] = [32, 24, 16].map(|word| of(Layout::Report, word));
        assert_eq!((long.step, middle.step, middle.stretch), (short.step * short.stretch, long.step, 1.0));
        assert!(of(Layout::Report, 32).rms_move > 1000.0 * of(Layout::Wide, 32).rms_move);
    }

    #[test]
    fn slivers_lose_their_area_in_short_words() {
        let of = |word| precision("slivers", MemoryOptions { word, ..MemoryOptions::default() });
        assert!(of(12).collapsed > of(32).collapsed, "{:?} {:?}", of(12), of(32));
        assert_eq!(of(12).degenerate, of(32).degenerate);
    }
}
