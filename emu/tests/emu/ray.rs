//! Results of the ray unit: rounded quotients, planes as patterns, addresses of children.

use emu::semantics::RayRoom;
use isa::number::ray::Plane;
use isa::number::{Modes, Nearest32, Overflow, Quantization, Vector};
use isa::table::outcome::{rbox, rstep, rtri};
use isa::table::{AnyOutcome, Done};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn minus(a: Vector, b: Vector) -> [i128; 3] {
    std::array::from_fn(|k| i128::from(a[k]) - i128::from(b[k]))
}

/// The determinant of three vectors.
fn volume(a: [i128; 3], b: [i128; 3], c: [i128; 3]) -> i128 {
    (0..3).map(|k| a[k] * (b[(k + 1) % 3] * c[(k + 2) % 3] - b[(k + 2) % 3] * c[(k + 1) % 3])).sum()
}

/// To nearest, ties up; both numbers are positive.
fn nearest(dividend: i128, divisor: i128) -> i128 {
    (2 * dividend + divisor) / (2 * divisor)
}

fn vector(size: i32) -> impl Strategy<Value = Vector> {
    prop::array::uniform3(-size..size)
}

fn plane(axis: usize, at: i32) -> i64 {
    Plane { axis, at }.pattern()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 5000, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn hits_are_quotients_of_volumes(
        origin in vector(1 << 20),
        vertices in prop::array::uniform3(vector(1 << 20)),
        weights in prop::array::uniform3(1i32..64),
        shift in 0i32..31,
        word in 20u32..=32,
    ) {
        let total = weights.iter().sum::<i32>();
        let target = |k: usize| (0..3).map(|n| weights[n] * (vertices[n][k] / total)).sum::<i32>();
        let direction: Vector = std::array::from_fn(|k| target(k) - origin[k]);
        let [a, b, c] = vertices.map(|vertex| minus(vertex, origin));
        let d = direction.map(i128::from);
        // The pyramids of origin and edges along the direction add up to that of the whole triangle.
        let [first, second, third] = [volume(d, c, b), volume(d, a, c), volume(d, b, a)];
        let whole = first + second + third;
        let along = -volume(a, b, c);
        let is_hit = [first, second, third, along].iter().all(|part| part.signum() == whole.signum() && *part != 0);
        let (t, weights, exit) = Modes { word, ..Modes::default() }.rtri([origin, direction], vertices, shift);
        prop_assert_eq!(exit.way == rtri::Way::Hit, is_hit);
        prop_assert_eq!(exit.units(), 0);
        let largest = i128::from(i32::MAX >> (32 - word));
        if is_hit {
            let part = |part: i128| nearest(part.abs() << (word - 2), whole.abs());
            prop_assert_eq!(i128::from(t), nearest(along.abs() << shift, whole.abs()).min(largest));
            prop_assert_eq!(weights.map(i128::from), [part(second), part(third), 0]);
        } else {
            prop_assert_eq!((i128::from(t), weights), (largest, [0; 3]));
        }
    }
}

#[test]
fn distances_round_as_the_machine_says_and_never_wrap() {
    let ray = [[0, 0, 0], [0, 0, 2]];
    let triangle = |z| [[-9, -9, z], [9, -9, z], [0, 9, z]];
    let t = |quantization, overflow, z, i| {
        let (t, _, exit) = Modes { word: 16, quantization, overflow }.rtri(ray, triangle(z), i);
        assert_eq!(exit.index(), 5, "a hit");
        t
    };
    assert_eq!(t(Quantization::Rnd, Overflow::Sat, 7, 0), 4, "3.5 to nearest, ties up");
    assert_eq!(t(Quantization::RndMinInf, Overflow::Sat, 7, 0), 3);
    assert_eq!(t(Quantization::TrnZero, Overflow::Sat, 7, 0), 3);
    assert_eq!(t(Quantization::Trn, Overflow::Sat, 7, 1), 7);
    for overflow in Overflow::ALL.iter().copied() {
        assert_eq!(t(Quantization::Rnd, overflow, 7, 40), 32767, "{}", overflow.name());
        assert_eq!(t(Quantization::Rnd, overflow, 0x10000, 0), 32767, "{}", overflow.name());
    }
}

#[test]
fn edges_that_are_met_exactly_are_counted_as_units() {
    let ray = [[0, 0, 0], [0, 0, 1]];
    let (t, _, exit) = Nearest32.rtri(ray, [[0, 0, 5], [2, -1, 5], [2, 1, 5]], 0);
    assert_eq!((t, exit), (5, rtri::Outcome { way: rtri::Way::Hit, units: 2 }), "a vertex is on two edges");
    let (t, _, exit) = Nearest32.rtri(ray, [[0, 0, 5], [-2, -1, 5], [-2, 1, 5]], 0);
    assert_eq!((t, exit), (i32::MAX, rtri::Outcome { way: rtri::Way::OutsideU, units: 1 }));
}

#[test]
fn boxes_give_planes() {
    let corners = [[-10, -20, -30], [10, 20, 30]];
    let across = |origin, direction| Nearest32.rbox([origin, direction], corners);
    assert_eq!(across([0, 0, 0], [1, 1, 1]), (plane(3, 0), plane(0, 10), rbox::Outcome::Inside));
    assert_eq!(across([0, 0, 0], [-1, -4, 1]), (plane(3, 0), plane(1, -20), rbox::Outcome::Inside));
    assert_eq!(across([0, 0, 50], [0, 1, -4]), (plane(2, 30), plane(1, 20), rbox::Outcome::Entered));
    assert_eq!(across([0, 0, 50], [0, 2, -1]), (-1, -1, rbox::Outcome::Missed));
    assert_eq!(across([0, 0, 50], [0, 0, 1]), (-1, -1, rbox::Outcome::Beside));
    assert_eq!(across([11, 0, 0], [0, 1, 0]), (-1, -1, rbox::Outcome::Beside));
    // On a face: a direction of 0 goes to larger coordinates.
    assert_eq!(across([10, 0, 0], [0, 1, 0]), (-1, -1, rbox::Outcome::Beside));
    assert_eq!(across([-10, 0, 0], [0, 1, 0]), (plane(3, 0), plane(1, 20), rbox::Outcome::Inside));
    assert_eq!(
        Nearest32.rexit([[0, 0, 0], [3, 6, 9]], corners),
        (plane(0, 10), Done),
        "all three at once: x is the first"
    );
    assert_eq!(Nearest32.rexit([[0, 0, 0], [-3, -6, -9]], corners), (plane(2, -30), Done));
    assert_eq!(Nearest32.rexit([[0, 0, 0], [0, 0, -9]], corners), (plane(2, -30), Done));
}

#[test]
fn steps_give_the_children_in_the_order_of_the_ray() {
    let node = |axis: i64, at: i32| (0x400 | axis) << 32 | i64::from(at as u32);
    let step =
        |direction, axis, at, entry, exit| Nearest32.rstep([[0, 0, 0], direction], [node(axis, at), entry, exit], 8);
    let (start, far) = (plane(3, 0), plane(0, 100));
    assert_eq!(step([1, 1, 0], 0, 50, start, far), (0x400, 0x408, rstep::Outcome::Both));
    assert_eq!(step([1, 1, 0], 0, -50, start, far), (0x408, 0, rstep::Outcome::Behind));
    assert_eq!(step([1, 1, 0], 0, 0, start, far), (0x408, 0, rstep::Outcome::Behind), "through the origin");
    assert_eq!(step([1, 1, 0], 1, 150, start, far), (0x400, 0, rstep::Outcome::Near));
    assert_eq!(step([1, 1, 0], 1, 40, plane(0, 50), far), (0x408, 0, rstep::Outcome::Passed));
    assert_eq!(
        step([1, 1, 0], 1, 50, plane(0, 50), far),
        (0x400, 0x408, rstep::Outcome::Both),
        "x = 50 comes before y = 50"
    );
    assert_eq!(step([1, -1, 0], 1, -50, start, far), (0x408, 0x400, rstep::Outcome::Both), "backwards");
    assert_eq!(step([1, -1, 0], 2, -5, start, far), (0x408, 0, rstep::Outcome::Behind), "0 goes to larger coordinates");
    assert_eq!(step([1, -1, 0], 2, 5, start, far), (0x400, 0, rstep::Outcome::Near));
    assert_eq!(step([1, 1, 0], 3, 12, start, far), (0x400, -1, rstep::Outcome::Leaf));
}

#[test]
fn a_hit_may_be_one_unit_further() {
    let before = |c, at, i| Nearest32.rbefore([[0, 0, 0], [0, -2, 0]], plane(1, at), c, i);
    assert_eq!(before(4, -10, 0), (0, Done), "5 * 2 = 10");
    assert_eq!(before(3, -10, 0), (1, Done));
    assert_eq!(before(7, -10, 1), (1, Done));
    assert_eq!(before(9, -10, 1), (0, Done));
    assert_eq!(before(0, 10, 0), (0, Done), "behind the origin");
    assert_eq!(before(i32::MAX, i32::MIN, 63), (1, Done));
}
