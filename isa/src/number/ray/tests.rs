//! Rays against models that are written differently: a direction that is really moved, by a step far below all products, and signs of
//! determinants of the vertices as the origin sees them.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use random::SplitMix64;

use super::*;
use crate::number::{Arithmetic, Modes, Nearest32, Overflow, Quantization};

type Wide = [i128; 3];

fn cross(a: Wide, b: Wide) -> Wide {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Wide, b: Wide) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: Vector, b: Vector) -> Wide {
    std::array::from_fn(|k| i128::from(a[k]) - i128::from(b[k]))
}

/// 1 / e. For coordinates below 2^7 products of three of them are far below it, so e is as good as infinitely small.
const STEP: i128 = 1 << 28;

/// The direction moved by (e, e^2, e^3), times STEP^3.
fn moved(direction: Vector) -> Wide {
    let [x, y, z] = direction.map(|component| i128::from(component) * STEP.pow(3));
    [x + STEP.pow(2), y + STEP, z + 1]
}

/// The end of a triangle's test by signs alone: the first that is wrong of determinant, u, v, w, t. `sign` gives that of a plane's normal and
/// the direction.
fn end_by_signs(ray: &Ray, [a, b, c]: [Vector; 3], sign: impl Fn(Wide) -> i128) -> TriangleEnd {
    let normal = cross(minus(b, a), minus(c, a));
    let across = dot(normal, ray.direction.map(i128::from));
    if across == 0 {
        return TriangleEnd::Parallel;
    }
    let [a, b, c] = [a, b, c].map(|vertex| minus(vertex, ray.origin));
    let ends = [TriangleEnd::OutsideU, TriangleEnd::OutsideV, TriangleEnd::OutsideW];
    for (edge, end) in [cross(c, a), cross(a, b), cross(b, c)].into_iter().zip(ends) {
        if sign(edge) != across.signum() {
            return end;
        }
    }
    if dot(normal, a).signum() == across.signum() { TriangleEnd::Hit } else { TriangleEnd::Behind }
}

/// The end for a direction that is moved for good; coordinates below 2^7.
fn end_of_moved(ray: &Ray, vertices: [Vector; 3]) -> TriangleEnd {
    end_by_signs(ray, vertices, |edge| dot(edge, moved(ray.direction)).signum())
}

/// The end by the first sign that is not 0 of the product with the direction and of the three components; any coordinates.
fn end_in_order(ray: &Ray, vertices: [Vector; 3]) -> TriangleEnd {
    end_by_signs(ray, vertices, |edge| {
        let all = [dot(edge, ray.direction.map(i128::from)), edge[0], edge[1], edge[2]];
        all.into_iter().find(|&value| value != 0).unwrap_or(0).signum()
    })
}

fn vector(component: impl Strategy<Value = i32> + Clone) -> impl Strategy<Value = Vector> {
    prop::array::uniform3(component)
}

/// Coordinates so small that rays meet edges, vertices and planes exactly, again and again.
fn crowded() -> impl Strategy<Value = i32> + Clone {
    -4i32..=4
}

fn any_size() -> impl Strategy<Value = i32> + Clone {
    let numbers = (any::<i32>(), 0u32..32).prop_map(|(number, shift)| number >> shift);
    prop_oneof![6 => numbers, 1 => prop::sample::select(vec![i32::MIN, i32::MIN + 1, -1, 0, 1, i32::MAX])]
}

fn ray(component: impl Strategy<Value = i32> + Clone) -> impl Strategy<Value = Ray> {
    prop::array::uniform2(vector(component)).prop_map(Ray::from)
}

/// A triangle of large coordinates and a ray that is aimed at a vertex, at a point of an edge or of the plane, all but exactly or exactly.
fn aimed() -> impl Strategy<Value = (Ray, [Vector; 3])> {
    let weights = prop::sample::select(vec![
        [4, 0, 0],
        [0, 4, 0],
        [0, 0, 4],
        [1, 3, 0],
        [0, 2, 2],
        [3, 0, 1],
        [1, 2, 1],
        [-1, 3, 2],
        [8, -4, 0],
    ]);
    let miss = prop_oneof![3 => Just([0; 3]), 1 => vector(-1i32..=1)];
    let corner = || vector(-(1i32 << 24)..1 << 24);
    (corner(), prop::array::uniform2(vector(-4000i32..4000)), corner(), weights, miss, -20i32..=20).prop_map(
        |(a, edges, origin, weights, miss, stretch)| {
            let at = |edge: Vector| std::array::from_fn(|k| a[k] + 4 * edge[k]);
            // The third vertex of a sliver lies almost on the line of the others.
            let far = if stretch < -10 { edges[0].map(|component| 17 * component + 1) } else { edges[1] };
            let vertices = [a, at(edges[0]), at(far)];
            let target = |k: usize| (0..3).map(|n| weights[n] * vertices[n][k]).sum::<i32>() / 4;
            let towards = |k: usize| target(k) - origin[k] + miss[k];
            let direction = if stretch > 10 {
                // Along the plane.
                std::array::from_fn(|k| weights[0] * edges[0][k] - weights[1] * edges[1][k] + miss[k])
            } else {
                std::array::from_fn(|k| towards(k) * if stretch < 0 { -1 } else { 1 })
            };
            (Ray { origin, direction }, vertices)
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, max_global_rejects: 200_000, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn crowded_triangles_end_as_for_a_moved_ray(ray in ray(crowded()), vertices in prop::array::uniform3(vector(crowded()))) {
        let meeting = exact_triangle(&ray, &vertices);
        prop_assert_eq!(meeting.end, end_of_moved(&ray, vertices));
        prop_assert_eq!(meeting.end, end_in_order(&ray, vertices));
        prop_assert_eq!(triangle(&ray, &vertices), meeting);
    }

    #[test]
    fn triangles_of_every_size_are_decided_exactly(ray in ray(any_size()), vertices in prop::array::uniform3(vector(any_size()))) {
        let meeting = exact_triangle(&ray, &vertices);
        prop_assert_eq!(meeting.end, end_in_order(&ray, vertices));
        prop_assert_eq!(triangle(&ray, &vertices), meeting);
    }

    #[test]
    fn aimed_and_grazing_rays_and_slivers_are_decided_exactly((ray, vertices) in aimed()) {
        let meeting = exact_triangle(&ray, &vertices);
        prop_assert_eq!(meeting.end, end_in_order(&ray, vertices));
        prop_assert_eq!(triangle(&ray, &vertices), meeting);
        if meeting.end == TriangleEnd::Hit {
            // t D = A + u (B - A) + v (C - A), seen from the origin, times the determinant.
            let [a, b, c] = vertices.map(|vertex| minus(vertex, ray.origin));
            for k in 0..3 {
                let point = meeting.determinant * a[k] + meeting.u * (b[k] - a[k]) + meeting.v * (c[k] - a[k]);
                prop_assert_eq!(meeting.t * i128::from(ray.direction[k]), point);
            }
        }
    }

    #[test]
    fn a_tetrahedron_is_entered_and_left(ray in ray(crowded()), corners in prop::array::uniform4(vector(crowded()))) {
        let [a, b, c, d] = corners;
        let faces = [[a, b, c], [a, c, d], [a, d, b], [b, d, c]];
        let side = |face: &[Vector; 3], point: Vector| {
            dot(cross(minus(face[1], face[0]), minus(face[2], face[0])), minus(point, face[0])).signum()
        };
        let volume = side(&faces[0], d);
        let sides = faces.map(|face| side(&face, ray.origin));
        // A flat body has no inside; an origin in the plane of a face may lie on the surface.
        prop_assume!(volume != 0 && sides.iter().all(|&side| side != 0));
        let is_inside = sides.iter().all(|&side| side == volume);
        let hits = faces.iter().filter(|face| exact_triangle(&ray, face).end == TriangleEnd::Hit).count();
        let is_going = ray.direction != [0; 3];
        prop_assert!(if is_inside && is_going { hits == 1 } else { hits == 0 || hits == 2 && is_going }, "{} hits", hits);
    }

    #[test]
    fn boxes_are_crossed_as_by_a_moved_ray(ray in ray(crowded()), low in vector(crowded()), size in vector(1i32..=4)) {
        let high = std::array::from_fn(|k| low[k] + size[k]);
        let direction = moved(ray.direction);
        // A moment as a fraction with a positive denominator; moments that are met are never equal, or both t = 0.
        let moment = |axis: usize, at: i32| {
            let run = i128::from(at) - i128::from(ray.origin[axis]);
            (run * direction[axis].signum(), direction[axis].abs())
        };
        let is_less = |a: (i128, i128), b: (i128, i128)| a.0 * b.1 < b.0 * a.1;
        let faces: [[(i128, i128); 2]; 3] = std::array::from_fn(|k| {
            let [a, b] = [moment(k, low[k]), moment(k, high[k])];
            if is_less(b, a) { [b, a] } else { [a, b] }
        });
        let last = (0..3).map(|k| faces[k][0]).reduce(|a, b| if is_less(a, b) { b } else { a }).unwrap();
        let first = (0..3).map(|k| faces[k][1]).reduce(|a, b| if is_less(b, a) { b } else { a }).unwrap();
        let expected = if first.0 <= 0 {
            BoxEnd::Beside
        } else if last.0 <= 0 {
            BoxEnd::Inside
        } else if is_less(last, first) {
            BoxEnd::Entered
        } else {
            BoxEnd::Missed
        };
        prop_assume!(ray.direction != [0; 3]);
        let (entry, exit, end) = across_box(&ray, low, high);
        prop_assert_eq!(end, expected);
        if matches!(end, BoxEnd::Inside | BoxEnd::Entered) {
            prop_assert_eq!(moment(exit.axis, exit.at), first);
            prop_assert_eq!(exit_face(&ray, low, high), exit);
        }
        match end {
            BoxEnd::Entered => prop_assert_eq!(moment(entry.axis, entry.at), last),
            BoxEnd::Inside => prop_assert_eq!(entry, Plane::START),
            _ => prop_assert_eq!((entry, exit), (Plane::NOWHERE, Plane::NOWHERE)),
        }
    }

    #[test]
    fn splits_are_met_as_by_a_moved_ray(
        ray in ray(crowded()),
        axes in prop::array::uniform3(0usize..3),
        places in prop::array::uniform3(crowded()),
        starts: bool,
    ) {
        let direction = moved(ray.direction);
        let moment = |plane: Plane| {
            let run = i128::from(plane.at) - i128::from(ray.origin[plane.axis]);
            (run * direction[plane.axis].signum(), direction[plane.axis].abs())
        };
        let is_less = |a: (i128, i128), b: (i128, i128)| a.0 * b.1 < b.0 * a.1;
        let [split, entry, exit]: [Plane; 3] = std::array::from_fn(|k| Plane { axis: axes[k], at: places[k] });
        let enters = if starts { (0, 1) } else { moment(entry) };
        // Planes that bound a packet are ahead, or the ray starts in it; a ray never gets to one of an axis along which it does not move.
        let is_met = |plane: Plane| moment(plane).0 > 0 && ray.direction[plane.axis] != 0;
        prop_assume!((starts || is_met(entry)) && is_met(exit));
        let entry = if starts { Plane::START } else { entry };
        let found = step(&ray, split, entry, exit);
        let expected = if moment(split).0 <= 0 {
            SplitEnd::Behind
        } else if !is_less(enters, moment(split)) {
            SplitEnd::Passed
        } else if is_less(moment(split), moment(exit)) {
            SplitEnd::Both
        } else {
            SplitEnd::Near
        };
        prop_assert_eq!(found, expected);
        // The side of the point between the planes that the ray visits first.
        let is_forwards = direction[split.axis] > 0;
        let is_far = matches!(expected, SplitEnd::Behind | SplitEnd::Passed);
        prop_assert_eq!(found.is_right_first(&ray, split.axis), is_forwards == is_far);
    }

    #[test]
    fn planes_survive_as_patterns(axis in 0usize..4, at: i32, above: u32) {
        let plane = Plane { axis, at };
        prop_assert_eq!(Plane::from_pattern(plane.pattern()), plane);
        prop_assert_eq!(Plane::from_pattern(plane.pattern() | i64::from(above & !3) << 32), plane);
    }

    #[test]
    fn a_hit_is_surely_nearer_when_its_neighbour_is(ray in ray(any_size()), axis in 0usize..3, at in any_size(), t in any_size(), shift in 0u32..64) {
        let found = is_surely_before(&ray, Plane { axis, at }, t, shift);
        let run = (i128::from(at) - i128::from(ray.origin[axis])) * if ray.direction[axis] < 0 { -1 } else { 1 };
        let slope = i128::from(ray.direction[axis]).abs();
        prop_assert_eq!(found, (i128::from(t) + 1) * slope - (run << shift) < 0);
    }

    #[test]
    fn ratios_are_rounded_once(dividend: i64, divisor: i64, scale in 0u32..36, left in 0u32..63, shift in 0u32..64, word in 8u32..=32) {
        let (dividend, divisor) = (i128::from(dividend.unsigned_abs() >> left) << scale, (i128::from(divisor.unsigned_abs()) << (scale / 2)).max(1));
        let largest = (1i128 << (word - 1)) - 1;
        for quantization in Quantization::ALL.iter().copied() {
            let modes = Modes { word, quantization, overflow: Overflow::Wrap(0) };
            let found = ratio(&modes, dividend, divisor, shift);
            prop_assert_eq!(found, ratio(&modes, -dividend, -divisor, shift));
            // In eighths of 126 bits at most, by another way than the digits of the division.
            let is_beyond = dividend.leading_zeros() <= shift + 1 || (dividend << shift) / divisor >= largest;
            if is_beyond && dividend.leading_zeros() > shift + 1 {
                prop_assert_eq!(i128::from(found), largest);
            } else if !is_beyond {
                prop_assert_eq!(found, modes.quotient(dividend << shift, divisor), "{:?}", quantization);
            }
        }
        let modes = Modes { word: 32, ..Modes::default() };
        prop_assert_eq!(ratio(&Nearest32, dividend, divisor, shift), ratio(&modes, dividend, divisor, shift));
    }
}

#[test]
fn quotients_of_the_largest_determinants_are_exact() {
    // 3 2^98 2^63 / (2^99 + 1) is beyond every word; 2^99 2^31 / 2^99 is just beyond, a little less is not.
    assert_eq!(ratio(&Nearest32, 3 << 98, (1 << 99) + 1, 63), i32::MAX);
    assert_eq!(ratio(&Nearest32, 1 << 99, 1 << 99, 31), i32::MAX);
    assert_eq!(ratio(&Nearest32, 1 << 99, 1 << 99, 30), 1 << 30);
    assert_eq!(ratio(&Nearest32, (1 << 99) - 1, 1 << 99, 30), 1 << 30);
    assert_eq!(ratio(&Nearest32, (1 << 99) - (1 << 69), 1 << 99, 30), (1 << 30) - 1);
    assert_eq!(ratio(&Nearest32, (1 << 99) - (1 << 68), 1 << 99, 30), 1 << 30, "a tie goes up");
    assert_eq!(ratio(&Nearest32, (1 << 99) - (1 << 68) - 1, 1 << 99, 30), (1 << 30) - 1);
    assert_eq!(ratio(&Nearest32, 0, 1 << 99, 63), 0);
    let modes = Modes { word: 16, quantization: Quantization::Rnd, overflow: Overflow::Wrap(0) };
    assert_eq!(ratio(&modes, 40000, 1, 0), 32767, "a distance never wraps");
    assert_eq!(ratio(&modes, 65535, 2, 0), 32767);
    assert_eq!(modes.narrow(32768, 0), -32768);
}

#[test]
fn ties_are_counted() {
    let ray = Ray { origin: [0, 0, 0], direction: [0, 0, 1] };
    let tests: [([Vector; 3], TriangleEnd, u32); 5] = [
        ([[-1, -1, 5], [3, -1, 5], [-1, 3, 5]], TriangleEnd::Hit, 0),
        // Moved towards x, then y: through the edge on the left, not through the one on the right.
        ([[0, -1, 5], [2, 0, 5], [0, 1, 5]], TriangleEnd::Hit, 1),
        ([[0, -1, 5], [-2, 0, 5], [0, 1, 5]], TriangleEnd::OutsideU, 1),
        // A vertex is on two edges.
        ([[0, 0, 5], [2, -1, 5], [2, 1, 5]], TriangleEnd::Hit, 2),
        ([[0, 0, -5], [-2, -1, -5], [-2, 1, -5]], TriangleEnd::Behind, 2),
    ];
    for (vertices, end, ties) in tests {
        let meeting = exact_triangle(&ray, &vertices);
        assert_eq!((meeting.end, meeting.ties), (end, ties), "{vertices:?}");
    }
    let through_edge_line = Ray { origin: [0, 0, 0], direction: [1, 0, 0] };
    let meeting = exact_triangle(&through_edge_line, &[[1, 0, 0], [2, 0, 0], [2, 1, 1]]);
    assert_eq!(meeting.end, TriangleEnd::Parallel);
}

/// 5 x 10^5 rays that no more than graze what they are aimed at; the filter decides as the integers do.
#[test]
fn the_filter_is_never_wrong() {
    let mut random = SplitMix64::new(1);
    let mut number = |bits: u32| random.below(1 << bits) as i32 - (1 << (bits - 1));
    let mut undecided = 0;
    for _ in 0..500_000 {
        let corner: Vector = std::array::from_fn(|_| number(30));
        let vertices = [corner, corner.map(|x| x + number(12)), corner.map(|x| x + number(12))];
        let origin: Vector = std::array::from_fn(|_| number(30));
        let target: Vector = std::array::from_fn(|k| {
            let [a, b] = [vertices[1][k] - corner[k], vertices[2][k] - corner[k]].map(i64::from);
            (i64::from(corner[k]) + (a * 5 + b * i64::from(number(3))) / 8) as i32
        });
        let direction = std::array::from_fn(|k| ((i64::from(target[k]) - i64::from(origin[k])) / 2) as i32);
        let ray = Ray { origin, direction };
        let exact = exact_triangle(&ray, &vertices);
        assert_eq!(triangle(&ray, &vertices), exact);
        undecided += usize::from(exact.ties > 0);
    }
    assert!(undecided < 500_000);
}
