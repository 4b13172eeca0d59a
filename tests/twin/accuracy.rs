//! Distance of the twins, and so the kernels, from exact integers: decisions and distances of the triangle test, and searches through the
//! tree. Errors count units in the last place (ulp) of the result's format.

use std::fmt::Write;

use isa::number::{Modes, Nearest32, Overflow, Quantization, Vector};
use kernels::KernelSet;
use kernels::constants::{Constants, side_fraction};
use kernels::twin::descend::own_packet;
use kernels::twin::first_packet::first_packet;
use kernels::twin::ray::{TwinRay, TwinSearch};
use kernels::twin::triangle::triangle;
use kernels::twin::{Twin, report};
use scenes::cadrage::{Formats, Overrides};
use scenes::generate;
use scenes::image;
use scenes::model::View;

use super::Subject;
use super::operands::Series;

/// Words that errors are quoted for.
pub const WORDS: [u32; 4] = [32, 24, 20, 16];

pub const fn modes(word: u32) -> Modes {
    Modes { word, quantization: Quantization::Rnd, overflow: Overflow::Sat }
}

/// Constants of a scene that fills the word: coordinates up to 2^(word-2), distances in steps of two.
pub fn full(word: u32) -> Constants {
    let (direction, largest) = (word - 2, i32::MAX >> (32 - word));
    let formats = Formats {
        word,
        position: 0,
        direction,
        barycentric: direction,
        t: -1,
        weight: direction,
        colour: word - 3,
        index: word - 4,
    };
    Constants {
        formats,
        edge_shift: 2 * (word - 1) + direction + 3 - 2 * word,
        t_shift: 3 * (word - 1) + 3 - 2 * word,
        side_shift: 4,
        side_fraction: side_fraction(word),
        offset: 3,
        literal_offset: 3,
        never: largest - 1,
        missed: largest,
        most_steps: 2,
    }
}

/// Constants of a scene with coordinates of 16 bits in a word of 32, and directions of 29 fraction bits: determinants are exact.
fn narrow() -> Constants {
    let formats = Formats { direction: 29, t: 0, ..full(32).formats };
    Constants { formats, edge_shift: 0, t_shift: 0, side_shift: 0, ..full(32) }
}

pub type Exact = [i128; 3];

pub fn exact_cross(a: Exact, b: Exact) -> Exact {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn exact_dot(a: Exact, b: Exact) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Point at which a ray hits a triangle, as a fraction in raw positions over raw directions: from the signs of the three edges seen from the
/// origin, in a direction that is moved by (e, e^2, e^3).
fn exact_hit(origin: Vector, direction: Vector, vertices: &[Vector; 3]) -> Option<(i128, i128)> {
    let direction = direction.map(i128::from);
    let [a, b, c] = vertices.map(|vertex| [0, 1, 2].map(|k| i128::from(vertex[k]) - i128::from(origin[k])));
    let edges = [exact_cross(a, b), exact_cross(b, c), exact_cross(c, a)];
    let sign = |normal: &Exact| {
        let powers = [exact_dot(direction, *normal), normal[0], normal[1], normal[2]];
        powers.into_iter().find(|&power| power != 0).map_or(0, i128::signum)
    };
    let determinant: i128 = edges.iter().map(|&normal| exact_dot(direction, normal)).sum();
    let reach = exact_dot(a, edges[1]);
    let is_hit = determinant != 0
        && edges.iter().all(|normal| sign(normal) == determinant.signum())
        && reach.signum() == determinant.signum();
    is_hit.then_some((reach, determinant))
}

/// The vector of length 1 in a direction, rounded to `bits` fraction bits.
fn rounded_unit(lanes: [f64; 3], bits: u32) -> Vector {
    let length = lanes.iter().map(|x| x * x).sum::<f64>().sqrt();
    lanes.map(|x| (x / length * f64::from(1u32 << bits)).round() as i32)
}

impl Series {
    /// Three corners of a triangle with coordinates below 2^bits: of all sizes from 1/2 of that to 1/2^`range` of it.
    pub fn triangle(&mut self, bits: u32, range: u32) -> [Vector; 3] {
        let (at, shift) = (self.point(1 << bits), self.bits() % u64::from(range));
        [0; 3].map(|_| {
            let corner = self.point(1 << bits);
            [0, 1, 2].map(|k| (at[k] - (at[k] >> 1)) + (corner[k] >> shift >> 1))
        })
    }

    /// A ray to a random place of a triangle and its surroundings, or to one of its edges.
    fn ray(&mut self, vertices: &[Vector; 3], bits: u32, direction_bits: u32, is_at_edge: bool) -> (Vector, Vector) {
        let origin = self.point(1 << bits);
        let (u, v) = match is_at_edge {
            true => (0.0, self.unit().abs()),
            false => (self.unit().abs(), self.unit().abs()),
        };
        let towards = [0, 1, 2].map(|k| {
            let [a, b, c, o] = [vertices[0][k], vertices[1][k], vertices[2][k], origin[k]].map(f64::from);
            a + u * (b - a) + v * (c - a) - o
        });
        (origin, rounded_unit(towards, direction_bits))
    }

    /// A direction of unit length, uniform enough.
    pub fn direction(&mut self, bits: u32) -> Vector {
        loop {
            let lanes = [self.unit(), self.unit(), self.unit()];
            if (0.01..1.0).contains(&lanes.iter().map(|x| x * x).sum::<f64>()) {
                return rounded_unit(lanes, bits);
            }
        }
    }
}

/// Errors of a series, sorted.
#[derive(Default)]
pub struct Errors(pub Vec<f64>);

impl Errors {
    /// Median, 99th percentile and largest, in three significant digits.
    pub fn figures(mut self) -> String {
        self.0.sort_by(f64::total_cmp);
        let at = |share: f64| self.0.get((share * (self.0.len() as f64 - 1.0)) as usize).copied().unwrap_or(0.0);
        format!("median {:.3}, p99 {:.3}, most {:.3}", at(0.5), at(0.99), at(1.0))
    }
}

/// Rays of a series.
const RAYS: usize = 50_000;

/// A triangle test: of the vector profile, or the report's.
type Test = fn(&Modes, &Constants, &TwinRay, &[Vector; 3]) -> i32;

/// Wrong decisions and errors of t over rays to places of triangles and to their edges.
fn decisions(text: &mut String, name: &str, test: Test, constants: &Constants, bits: u32) {
    let modes = modes(constants.formats.word);
    for is_at_edge in [false, true] {
        let mut series = Series::new(20);
        let (mut wrong, mut hits, mut errors) = (0, 0, Errors::default());
        for _ in 0..RAYS {
            let vertices = series.triangle(bits, 7);
            let (origin, direction) = series.ray(&vertices, bits, constants.formats.direction, is_at_edge);
            let t = test(&modes, constants, &TwinRay::new(&modes, origin, direction), &vertices);
            let exact = exact_hit(origin, direction, &vertices);
            hits += usize::from(exact.is_some());
            match exact {
                Some((reach, determinant)) if t != constants.missed => {
                    let exact = reach as f64 / determinant as f64 * f64::from(constants.along()).exp2();
                    errors.0.push((f64::from(t) - exact).abs());
                }
                _ => wrong += usize::from(exact.is_some() != (t != constants.missed)),
            }
        }
        let aim = if is_at_edge { "edges " } else { "places" };
        let _ = writeln!(text, "{name} at {aim}: {hits} hits, {wrong} wrong; ulp of t: {}", errors.figures());
    }
}

#[test]
fn triangles_against_exact_integers() {
    let mut text = format!("{RAYS} rays each\n");
    decisions(&mut text, "vector, 16-bit coordinates in 32 bits", triangle, &narrow(), 15);
    assert_eq!(text.matches(" 0 wrong").count(), 2, "decisions are exact where nothing is shifted away:\n{text}");
    for word in WORDS {
        decisions(&mut text, &format!("vector, {word} bits"), triangle, &full(word), word - 2);
    }
    for word in WORDS {
        decisions(&mut text, &format!("report, {word} bits"), report::triangle, &full(word), word - 2);
    }
    insta::assert_snapshot!(text);
}

/// A closed surface on a lattice of 5 x 5 x 5 points, bent by up to `bend`: two triangles a square, three shared edges a triangle.
fn body(series: &mut Series, step: i32, bend: i32) -> Vec<[Vector; 3]> {
    const CELLS: i32 = 4;
    let bent: Vec<i32> = (0..3 * 125).map(|_| 2 * series.within(bend / 2 + 1)).collect();
    let place = |at: Vector| {
        let number = (at[0] * 25 + at[1] * 5 + at[2]) as usize;
        [0, 1, 2].map(|k| step * (at[k] - CELLS / 2) + bent[3 * number + k])
    };
    let mut triangles = Vec::new();
    for (axis, n) in (0..3).flat_map(|axis| (0..2 * CELLS * CELLS).map(move |n| (axis, n))) {
        let corner = |i: i32, j: i32| {
            let mut at = [0; 3];
            at[axis] = if n < CELLS * CELLS { 0 } else { CELLS };
            (at[(axis + 1) % 3], at[(axis + 2) % 3]) = (n / CELLS % CELLS + i, n % CELLS + j);
            place(at)
        };
        let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
        // Each edge is the first, second or third one of some triangle.
        triangles.push([a, b, c]);
        triangles.push(if n % 2 == 0 { [a, c, d] } else { [c, d, a] });
    }
    triangles
}

/// Rays from outside that go exactly through vertices and edges leave a closed surface as often as they enter it, in every word.
#[test]
fn closed_surfaces_are_crossed_evenly() {
    let words = [(32, narrow(), 15)].into_iter().chain(WORDS.map(|word| (word, full(word), word - 2)));
    for (word, constants, bits) in words {
        let modes = modes(word);
        let mut series = Series::new(21);
        let step = 1 << (bits - 4);
        let mut crossings = [0; 5];
        for bend in [0, step / 3, step] {
            let body = body(&mut series, step, bend);
            for _ in 0..1500 {
                // Along one of 26 lattice directions, through a corner or the middle of an edge.
                let way = [0; 3].map(|_| (series.bits() % 3) as i32 - 1);
                let [a, b, c] = body[series.bits() as usize % body.len()];
                let [a, b] = [[a, a], [a, b], [b, c], [c, a]][series.bits() as usize % 4];
                let back = 8 * step + series.within(step);
                let origin = [0, 1, 2].map(|k| (a[k] + b[k]) / 2 - back * way[k]);
                if way == [0; 3] {
                    continue;
                }
                let direction = rounded_unit(way.map(f64::from), constants.formats.direction);
                let ray = TwinRay::new(&modes, origin, direction);
                let hits = body.iter().filter(|v| triangle(&modes, &constants, &ray, v) != constants.missed).count();
                assert_eq!(
                    hits % 2,
                    0,
                    "{hits} crossings from {origin:?} along {way:?} in {word} bits, bent by {bend}"
                );
                crossings[hits.min(8) / 2] += 1;
            }
        }
        assert!(crossings[0] > 100 && crossings[1] > 500, "rays that cross 0, 2, 4 .. times: {crossings:?}");
    }
}

/// The nearest hit by the tree, from a camera or from inside, is that of all triangles, in exact ties too.
#[test]
fn searches_through_the_tree_miss_nothing() {
    let mut series = Series::new(22);
    let mut hits = 0;
    for (name, level, triangles) in [
        ("slivers", Some(8), None),
        ("cornell", Some(2), None),
        ("sphereflake", Some(1), None),
        ("terrain", None, Some(400)),
    ] {
        let size = (8, 6);
        let scene =
            generate::scene(name, &generate::GenerateOptions { level, triangles, size }).expect("a generated scene");
        let fine =
            Subject::new(scene.clone(), View::new(size), modes(32), image::MemoryOptions::default()).expect("a scene");
        let position = Some(fine.image.formats.position - 15);
        let formats = Overrides { position, direction: Some(29), ..Overrides::default() };
        let options = image::MemoryOptions { formats, ..image::MemoryOptions::default() };
        let subject = Subject::new(scene, View::new(size), modes(32), options).expect("a scene on a coarse grid");
        let twin = Twin::new(&subject.image, &subject.features, KernelSet::Vector, Nearest32)
            .expect("the image holds the scene");
        assert_eq!(twin.constants.edge_shift, 0);
        for n in 0..2500 {
            let vertices = twin.stage.triangles[series.bits() as usize % twin.stage.triangles.len()].vertices;
            let step = [0; 3].map(|_| (series.bits() % 3) as i32 - 1);
            let (origin, direction) = if n % 2 == 0 && step != [0; 3] {
                // Through a vertex, and through many planes of the tree, along a lattice line.
                let back = (series.bits() % 40_000) as i32;
                (vertices[0].map(i64::from), (step, back))
            } else {
                (vertices[0].map(i64::from), ([0; 3], 0))
            };
            let ray = match direction {
                ([0, 0, 0], _) => {
                    let (origin, direction) = series.ray(&vertices, 14, 29, n % 4 == 1);
                    TwinRay::new(&Nearest32, origin, direction)
                }
                (step, back) => {
                    let origin = [0, 1, 2].map(|k| (origin[k] - i64::from(back * step[k])) as i32);
                    TwinRay::new(&Nearest32, origin, rounded_unit(step.map(f64::from), 29))
                }
            };
            let bounds = &twin.stage.bounds;
            let is_inside = (0..3).all(|k| (bounds.low[k]..=bounds.high[k]).contains(&ray.origin[k]));
            let first = if is_inside {
                Some(own_packet(&Nearest32, &twin.stage, &ray))
            } else {
                first_packet(&Nearest32, &twin.stage, &ray)
            };
            let mut search = TwinSearch { t: twin.constants.never, triangle: None, takes_any: false };
            if let Some(first) = first {
                twin.trace(&ray, first, &mut search).expect("a ray that is not stuck");
            }
            let all = (0..).zip(&twin.stage.triangles);
            let all = all.map(|(index, t)| (triangle(&Nearest32, &twin.constants, &ray, &t.vertices), index));
            let nearest = all.filter(|&(t, _)| t < twin.constants.never).min();
            assert_eq!(search.triangle.map(|index| (search.t, index)), nearest, "{name}, {ray:?}");
            hits += usize::from(nearest.is_some());
        }
    }
    assert!(hits > 5000, "{hits} hits");
}
