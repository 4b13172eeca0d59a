//! Refusals in single precision against the test in double precision: never of a hit, and of nearly all misses.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::hierarchy::Box3;
use super::search::Search;
use super::short::{Boxes, LANES, ShortRay, TriangleBlock};
use super::triangle::{Encounter, PreparedTriangle, ShearedRay};
use super::*;
use crate::generate;
use crate::model::Camera;
use crate::vector::{add, scale, unit};

/// A triangle, and rays at it: each starts `away` from a point between its corners, or next to one of its edges.
#[derive(Clone, Debug)]
struct Shot {
    vertices: [Vec3; 3],
    rays: Vec<(Vec3, Vec3)>,
}

fn points() -> impl Strategy<Value = Vec3> {
    // Places on a coarse grid as well, so that faces and edges lie along axes.
    prop_oneof![
        prop::array::uniform3(-1.0..1.0f64),
        prop::array::uniform3(-4i8..5).prop_map(|p| p.map(|x| f64::from(x) / 4.0))
    ]
}

fn shots() -> impl Strategy<Value = Shot> {
    let near = prop_oneof![Just(0.0), -1e-3..1e-3f64, -1e-6..1e-6f64, -1e-9..1e-9f64, -1e-13..1e-13f64];
    let aim = (0.0..1.0f64, near, points().prop_filter_map("a direction", unit), -2.0..45.0f64);
    (points(), points(), points(), -20.0..0.0f64, prop::collection::vec(aim, 8)).prop_map(|(a, b, c, size, aims)| {
        // From the whole box down to a millionth of it.
        let near_a = |p: Vec3| add(a, scale(sub(p, a), size.exp2()));
        let vertices = [a, near_a(b), near_a(c)];
        let rays = aims.into_iter().map(|(along, aside, direction, away)| {
            let weights = [1.0 - along - aside, along, aside];
            let aim = (0..3).fold([0.0; 3], |sum, k| add(sum, scale(vertices[k], weights[k])));
            // Up to 10^13 times the box away.
            (sub(aim, scale(direction, away.exp2())), direction)
        });
        Shot { vertices, rays: rays.collect() }
    })
}

fn short(ray: &ShearedRay) -> Option<ShortRay> {
    ShortRay::entering(([-1.25; 3], [1.25; 3]), ray, f64::INFINITY)
}

/// The box in single precision, an ulp larger than it need be.
fn bounds(vertices: [Vec3; 3]) -> Box3 {
    let corner =
        |f: fn(f64, f64) -> f64| [0, 1, 2].map(|k| f(f(vertices[0][k], vertices[1][k]), vertices[2][k]) as f32);
    (corner(f64::min).map(f32::next_down), corner(f64::max).map(f32::next_up))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn no_hit_is_refused(shot in shots(), lane in 0..LANES) {
        let triangle = crate::model::Triangle { vertices: [0, 1, 2], material: 0 };
        let shapes = Shapes { vertices: shot.vertices.to_vec(), triangles: &[triangle] };
        let all = Exhaustive { indices: shapes.visible(), shapes };
        // The lanes before it hold a triangle without an area, which nothing meets and nothing need refuse.
        let point = PreparedTriangle { vertices: [[0.0; 3]; 3] };
        let numbers: Vec<u32> = (0..=lane as u32).rev().collect();
        let block = TriangleBlock::new(&numbers, |index| if index == 0 { PreparedTriangle { vertices: shot.vertices } } else { point });
        let boxes = Boxes::new(&[bounds(shot.vertices); LANES][..=lane]);
        for (origin, direction) in shot.rays {
            let ray = ShearedRay::new(origin, direction);
            let Some(hit) = all.nearest(&ray) else { continue };
            let ray = short(&ray).expect("what it hits lies in the box");
            prop_assert_eq!(block.candidates(&ray) >> lane & 1, 1, "{:?} {:?}", origin, direction);
            prop_assert_eq!(boxes.enter(&ray, ray.end(hit.t)).1 & ((2 << lane) - 1), (2 << lane) - 1, "{:?} {:?}", origin, direction);
        }
    }
}

/// Of the triangles of a landscape that rays miss, one in a thousand at most is left to double precision, and empty lanes never are.
#[test]
fn nearly_all_misses_are_refused() {
    let scene = generate::scene("terrain", &generate::GenerateOptions::default()).unwrap();
    let shapes = Shapes { vertices: scene.vertices.clone(), triangles: &scene.triangles };
    let size = largest(scene.vertices.iter().fold([0.0; 3], |most, v| [0, 1, 2].map(|k| most[k].max(v[k].abs()))));
    let place = |p: Vec3| p.map(|x| x / size);
    let triangle = |index: u32| PreparedTriangle { vertices: shapes.triangle(index).vertices.map(place) };
    let (mut misses, mut left) = (0, 0);
    for number in (0..scene.triangles.len() as u32 - 3).step_by(61) {
        let block = TriangleBlock::new(&[number, number + 1, number + 2], triangle);
        // From above at the first of them, at its middle and beside it.
        let aim = triangle(number).vertices.iter().fold([0.0; 3], |sum, &v| add(sum, scale(v, 1.0 / 3.0)));
        for aside in [0.0, 0.01, 0.1, 1.0] {
            let ray = ShearedRay::new([aim[0] + aside, aim[1] + aside / 3.0, 1.5], [0.0, 0.0, -1.0]);
            let Some(short) = short(&ray) else { continue };
            let candidates = block.candidates(&short);
            assert_eq!(candidates >> 3, 0, "the fourth lane is empty");
            for lane in 0..3 {
                let is_hit = matches!(triangle(number + lane).meet(&ray), Encounter::Hit(_));
                assert!(!is_hit || candidates >> lane & 1 == 1);
                misses += u32::from(!is_hit);
                left += u32::from(!is_hit && candidates >> lane & 1 == 1);
            }
        }
    }
    assert!(misses > 10_000 && left * 1000 < misses, "{left} of {misses}");
}

/// A landscape from straight above and from a corner, as far as coordinates go: the same picture as by trying all triangles.
#[test]
fn far_eyes_see_what_trying_all_triangles_shows() {
    let options = generate::GenerateOptions { triangles: Some(500), ..Default::default() };
    let scene = generate::scene("terrain", &options).unwrap();
    for (towards, farthest) in [([0.0, 0.0, 1.0], 150), ([0.5, 0.75, 1.0], 12)] {
        for power in [1, 3, 6, 9, 12, 40, 60, 150].into_iter().filter(|&power| power <= farthest) {
            let distance = 10f64.powi(power);
            let camera =
                Camera::Perspective { eye: Some(scale(towards, distance)), look: None, field: 400.0 / distance };
            let view = View { camera, ..View::new((12, 9)) };
            let (tree, all) = (render(&scene, &view).unwrap(), render_exhaustively(&scene, &view).unwrap());
            assert_eq!(tree, all, "10^{power}");
            assert!(tree.rays.shadow > 20, "10^{power}: {:?}", tree.rays);
        }
    }
}
