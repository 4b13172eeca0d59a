//! Numbers of the machine beside double precision: raw, as real numbers in scene units, and their difference.

use scenes::cadrage::Formats;
use scenes::grid::Grid;
use scenes::image::MemoryImage;
use scenes::model::Vec3;
use scenes::vector::{shifted, sub};
use schemars::JsonSchema;
use serde::Serialize;

/// A number of the machine beside double precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct ComparedNumber {
    /// Raw number of the machine; null where it has none.
    pub raw: Option<i32>,
    /// Value of that; distances are in scene units.
    pub value: Option<f64>,
    /// The number in double precision; null where it has none.
    pub reference: Option<f64>,
    /// Value less reference.
    pub difference: Option<f64>,
}

/// A vector of the machine beside double precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct ComparedVector {
    /// Raw components of the machine; null where it has none.
    pub raw: Option<[i32; 3]>,
    /// Values of those; places are in scene units.
    pub value: Option<Vec3>,
    /// The vector in double precision; null where it has none.
    pub reference: Option<Vec3>,
    /// Value less reference, component by component.
    pub difference: Option<Vec3>,
}

impl ComparedNumber {
    /// A raw number of a value, and the number in double precision.
    pub fn new(raw: Option<i32>, value: Option<f64>, reference: Option<f64>) -> ComparedNumber {
        let difference = value.zip(reference).map(|(value, reference)| value - reference);
        ComparedNumber { raw, value, reference, difference }
    }
}

impl ComparedVector {
    /// Raw components of values, and the vector in double precision.
    pub fn new(raw: Option<[i32; 3]>, value: Option<Vec3>, reference: Option<Vec3>) -> ComparedVector {
        let difference = value.zip(reference).map(|(value, reference)| sub(value, reference));
        ComparedVector { raw, value, reference, difference }
    }
}

/// Meaning of the raw numbers of a picture.
#[derive(Clone, Copy, Debug)]
pub struct RawScales {
    /// Fraction bits of all quantities.
    pub formats: Formats,
    grid: Grid,
}

impl RawScales {
    /// The meanings in a memory image.
    pub fn new(image: &MemoryImage) -> RawScales {
        RawScales { formats: image.formats, grid: image.grid }
    }

    /// A place.
    pub fn place(&self, raw: Option<[i32; 3]>, reference: Option<Vec3>) -> ComparedVector {
        ComparedVector::new(raw, raw.map(|raw| self.grid.scene(raw)), reference)
    }

    /// A vector in a format of so many fraction bits.
    pub fn vector(&self, bits: u32, raw: Option<[i32; 3]>, reference: Option<Vec3>) -> ComparedVector {
        ComparedVector::new(raw, raw.map(|raw| raw.map(|raw| real(raw, bits as i32))), reference)
    }

    /// A number in a format of so many fraction bits.
    pub fn number(&self, bits: u32, raw: Option<i32>, reference: Option<f64>) -> ComparedNumber {
        ComparedNumber::new(raw, raw.map(|raw| real(raw, bits as i32)), reference)
    }

    /// A distance.
    pub fn distance(&self, raw: Option<i32>, reference: Option<f64>) -> ComparedNumber {
        ComparedNumber::new(raw, raw.map(|raw| self.distance_value(raw)), reference)
    }

    /// A distance in scene units.
    pub fn distance_value(&self, raw: i32) -> f64 {
        real(raw, self.formats.t) / self.grid.stretch
    }
}

/// Real value of a raw number; fraction bits may be fewer than 0 and more than a word has.
fn real(raw: i32, bits: i32) -> f64 {
    shifted(f64::from(raw), -bits)
}

/// Weights of the second and the third vertex where a ray meets the plane of a triangle, from whole numbers: exact but for the last division.
/// `None` where the ray runs along the plane.
///
/// With the edges e = q - p and f = s - p, the way w = origin - p and the direction d, both are ratios of determinants: u = (d x f) . w over
/// (d x f) . e, and v = (w x e) . d over the same. Components have 32 bits, edges 33, so determinants stay below 2^102.
pub fn weights(ray: [[i32; 3]; 2], vertices: [[i32; 3]; 3]) -> Option<[f64; 2]> {
    let wide = |a: [i32; 3]| a.map(i128::from);
    let [origin, direction] = ray.map(wide);
    let [p, q, s] = vertices.map(wide);
    let from = |a: [i128; 3], b: [i128; 3]| [0, 1, 2].map(|k| a[k] - b[k]);
    let cross = |a: [i128; 3], b: [i128; 3]| {
        [0usize, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
    };
    let dot = |a: [i128; 3], b: [i128; 3]| (0..3).map(|k| a[k] * b[k]).sum::<i128>();
    let (e, f, way) = (from(q, p), from(s, p), from(origin, p));
    let across = cross(direction, f);
    let determinant = dot(across, e);
    let ratio = |part: i128| part as f64 / determinant as f64;
    (determinant != 0).then(|| [ratio(dot(across, way)), ratio(dot(cross(way, e), direction))])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_those_of_the_point_that_is_met() {
        // A triangle of legs 8 and 4 in the plane z = 0, met from above at a quarter of one and a half of the other.
        let triangle = [[0, 0, 0], [8, 0, 0], [0, 4, 0]];
        assert_eq!(weights([[2, 2, 5], [0, 0, -1]], triangle), Some([0.25, 0.5]));
        assert_eq!(weights([[2, 2, 5], [0, 0, -1 << 30]], triangle), Some([0.25, 0.5]));
        assert_eq!(weights([[2, 2, 5], [1, 0, 0]], triangle), None);
        // The largest numbers there are do not overflow.
        let far = [[i32::MIN; 3], [i32::MAX, i32::MIN, i32::MAX], [i32::MAX, i32::MAX, i32::MIN]];
        assert!(weights([[i32::MAX; 3], [i32::MIN, i32::MAX, i32::MIN]], far).is_some());
    }

    #[test]
    fn differences_need_both() {
        assert_eq!(ComparedNumber::new(Some(3), Some(0.75), Some(0.5)).difference, Some(0.25));
        assert_eq!(ComparedNumber::new(None, None, Some(0.5)).difference, None);
        let both = ComparedVector::new(Some([1, 2, 3]), Some([0.5, 1.0, 1.5]), Some([0.5, 0.5, 2.0]));
        assert_eq!(both.difference, Some([0.0, 0.5, -0.5]));
        assert_eq!((real(3, -2), real(3, 300)), (12.0, 3.0 * 2f64.powi(-300)));
    }
}
