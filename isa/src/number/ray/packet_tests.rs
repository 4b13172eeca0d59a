//! Packets against one triangle after the other, and walks against single steps.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::*;
use crate::number::{Arithmetic, Modes, Nearest32, Overflow, Quantization};

/// The octets of a packet of named triangles.
fn octets(triangles: &[(u32, [Vector; 3])]) -> Vec<u8> {
    let names = triangles.iter().map(|&(name, _)| name);
    let kinds = (0..3).flat_map(|vertex| (0..3).map(move |axis| (vertex, axis)));
    let words =
        kinds.flat_map(|(vertex, axis)| triangles.iter().map(move |(_, vertices)| vertices[vertex][axis] as u32));
    names.chain(words).flat_map(u32::to_le_bytes).collect()
}

/// The hits in the order of the packet, without a shortcut.
fn hits(
    arithmetic: &impl Arithmetic,
    ray: &Ray,
    triangles: &[(u32, [Vector; 3])],
    shift: u32,
) -> Vec<(usize, PacketHit)> {
    let hit = |(number, &(name, vertices)): (usize, &(u32, [Vector; 3]))| {
        let met = exact_triangle(ray, &vertices);
        let t = || ratio(arithmetic, met.t, met.determinant, shift);
        (met.end == TriangleEnd::Hit).then(|| (number, PacketHit { t: t(), name }))
    };
    triangles.iter().enumerate().filter_map(hit).collect()
}

fn check(arithmetic: &impl Arithmetic, ray: &Ray, triangles: &[(u32, [Vector; 3])], shift: u32, found: PacketHit) {
    let octets = octets(triangles);
    let packet = PacketWords::new(&octets);
    let hits = hits(arithmetic, ray, triangles, shift);
    let nearest = hits.iter().map(|&(_, hit)| (hit.t, hit.name)).fold((found.t, found.name), Ord::min);
    let best = packet.nearest(arithmetic, ray, shift, found);
    assert_eq!((best.t, best.name), nearest, "nearest of {ray:?}, {triangles:?}, shift {shift}, {found:?}");
    let first = hits.into_iter().find(|(_, hit)| hit.t < found.t);
    assert_eq!(packet.any(arithmetic, ray, shift, found.t), first, "any of {ray:?}, {triangles:?}, {shift}, {found:?}");
}

fn vector(component: impl Strategy<Value = i32> + Clone) -> impl Strategy<Value = Vector> {
    prop::array::uniform3(component)
}

fn any_size() -> impl Strategy<Value = i32> + Clone {
    let numbers = (any::<i32>(), 0u32..32).prop_map(|(number, shift)| number >> shift);
    prop_oneof![6 => numbers, 1 => prop::sample::select(vec![i32::MIN, i32::MIN + 1, -1, 0, 1, i32::MAX])]
}

fn modes() -> impl Strategy<Value = Modes> {
    let quantization = prop::sample::select(Quantization::ALL.to_vec());
    (8u32..=32, quantization).prop_map(|(word, quantization)| Modes { word, quantization, overflow: Overflow::Wrap(0) })
}

/// Triangles of few names, so that names are equal as often as not.
fn named(triangle: impl Strategy<Value = [Vector; 3]>) -> impl Strategy<Value = Vec<(u32, [Vector; 3])>> {
    prop::collection::vec((0u32..6, triangle), 0..11)
}

/// Slivers and fans around a point of the ray: hits close to edges and vertices, and close to each other, some the same but for their names.
fn fans() -> impl Strategy<Value = (Ray, Vec<(u32, [Vector; 3])>)> {
    let near = || vector(-3i32..=3);
    let far = |bits: u32| vector(-(1i32 << bits)..=1 << bits);
    (1u32..29, 1u32..29).prop_flat_map(move |(wide, narrow)| {
        let triangle = (far(narrow), far(narrow), near(), 0u32..6, 0usize..3);
        (far(wide), far(wide), 1i32..4, prop::collection::vec(triangle, 0..11)).prop_map(
            |(point, origin, times, parts)| {
                let direction = std::array::from_fn(|k| (point[k] - origin[k]).saturating_mul(times));
                let triangle = |(edge1, edge2, off, name, place): (Vector, Vector, Vector, u32, usize)| {
                    let moved = |edge: Vector, times: i32| {
                        std::array::from_fn(|k| point[k].saturating_add(off[k] + times * edge[k]))
                    };
                    // The point lies on a vertex, on an edge, or inside, all but for `off`.
                    let corners = match place {
                        0 => [moved([0; 3], 0), moved(edge1, 1), moved(edge2, 1)],
                        1 => [moved(edge1, -1), moved(edge1, 1), moved(edge2, 1)],
                        _ => [
                            moved(edge1, -1),
                            moved(edge2, -1),
                            moved(std::array::from_fn(|k| edge1[k] / 2 + edge2[k] / 2), 2),
                        ],
                    };
                    (name, corners)
                };
                (Ray { origin, direction }, parts.into_iter().map(triangle).collect())
            },
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4_000, rng_seed: RngSeed::Fixed(3), ..ProptestConfig::default() })]

    #[test]
    fn packets_of_any_size_are_searched_as_one_triangle_after_the_other(
        ray in prop::array::uniform2(vector(any_size())),
        triangles in named(prop::array::uniform3(vector(any_size()))),
        shift in 0u32..64,
        modes in modes(),
        t: i32,
        name in 0u32..6,
    ) {
        check(&modes, &Ray::from(ray), &triangles, shift, PacketHit { t, name });
        check(&Nearest32, &Ray::from(ray), &triangles, shift, PacketHit { t, name });
    }

    #[test]
    fn crowded_packets_are_searched_so(
        ray in prop::array::uniform2(vector(-4i32..=4)),
        triangles in named(prop::array::uniform3(vector(-4i32..=4))),
        shift in 0u32..6,
        modes in modes(),
        t in 0i32..9,
        name in 0u32..6,
    ) {
        check(&modes, &Ray::from(ray), &triangles, shift, PacketHit { t, name });
        check(&Nearest32, &Ray::from(ray), &triangles, shift, PacketHit { t: i32::MAX, name });
    }

    #[test]
    fn fans_around_a_point_of_the_ray_are_searched_so((ray, triangles) in fans(), shift in 0u32..40, modes in modes()) {
        let farthest = PacketHit { t: i32::MAX >> (32 - modes.word), name: 3 };
        check(&modes, &ray, &triangles, shift, farthest);
        check(&Nearest32, &ray, &triangles, shift, PacketHit { t: i32::MAX - 1, name: 0 });
    }

    #[test]
    fn descents_decide_as_single_steps(
        ray in prop::array::uniform2(vector(-4i32..=4)),
        axes in prop::array::uniform6(0usize..4),
        places in prop::array::uniform6(-4i32..=4),
    ) {
        let ray = Ray::from(ray);
        let [entry, mut exit, splits @ ..]: [Plane; 6] = std::array::from_fn(|k| Plane { axis: axes[k], at: places[k] });
        let mut descent = Descent::new(&ray, entry, exit);
        for split in splits {
            let end = step(&ray, split, entry, exit);
            let is_right_first = end.is_right_first(&ray, split.axis);
            let expected = match end {
                SplitEnd::Leaf => Children::None,
                SplitEnd::Behind | SplitEnd::Passed | SplitEnd::Near => Children::One { is_right: is_right_first },
                SplitEnd::Both => Children::Both { is_right_first },
            };
            prop_assert_eq!(descent.step(split), expected);
            if end == SplitEnd::Both {
                exit = split;
            }
        }
    }
}
