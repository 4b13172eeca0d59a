//! Polygons as triangles: n corners always give n - 2, so that neighbours still share every edge. Concave outlines are
//! cut into ears in the plane of the two axes that the polygon faces most, after all are known.

use earcut::Earcut;

use crate::model::Vec3;

/// Work that the concave polygons of a file may take: a polygon takes its corners times their square root, as random outlines of 100 to
/// 20,000 corners do. About a second.
const WORK: u64 = 2_500_000;

/// Work beyond that for each corner of a concave polygon: a file of many is large in itself.
const WORK_PER_CORNER: u64 = 10;

/// Corners of the largest outline that is cut although it crosses itself, which may take the cube of the corners.
const MOST_CROSSED: usize = 1_000;

/// Turns polygons into fans one after another, then the fans of concave ones into ears.
#[derive(Default)]
pub(super) struct Cutter {
    concave: Vec<Concave>,
    /// Work that cutting takes, and what the corners allow.
    work: u64,
    allowance: u64,
    corners: Vec<u32>,
    flat: Vec<[f64; 2]>,
    ears: Vec<u32>,
    earcut: Option<Earcut<f64>>,
}

/// A polygon to be cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Concave {
    /// Number of the first triangle of its fan.
    pub(super) first: u32,
    pub(super) corners: u32,
}

impl Cutter {
    /// Puts the fan of a polygon with at least three corners, given by vertex number, behind the other triangles, in the
    /// polygon's sense of rotation: corners.len() - 2 of them. A concave one is noted.
    pub(super) fn fan(&mut self, vertices: &[Vec3], corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
        if corners.len() > 3 {
            self.project(vertices, corners);
            if !is_convex(&self.flat) && (corners.len() <= MOST_CROSSED || turns_once(&self.flat)) {
                // Each corner of a file buys some work, so files of many small polygons are never refused.
                let count = corners.len() as u64;
                self.work += count * count.isqrt();
                self.allowance += count * WORK_PER_CORNER;
                self.concave.push(Concave { first: triangles.len() as u32, corners: corners.len() as u32 });
            }
        }
        triangles.extend((1..corners.len() - 1).map(|n| [corners[0], corners[n], corners[n + 1]]));
    }

    /// The largest concave polygon, the first of several, where all of them take too much work.
    pub(super) fn excess(&self) -> Option<Concave> {
        let is_too_much = self.work > WORK + self.allowance;
        self.concave.iter().rev().max_by_key(|polygon| polygon.corners).filter(|_| is_too_much).copied()
    }

    /// Cuts the concave polygons in place of their fans, among all triangles so far.
    pub(super) fn cut(&mut self, vertices: &[Vec3], triangles: &mut [[u32; 3]]) {
        for polygon in std::mem::take(&mut self.concave) {
            let fan = &mut triangles[polygon.first as usize..][..polygon.corners as usize - 2];
            let mut corners = std::mem::take(&mut self.corners);
            corners.clear();
            corners.extend(&fan[0][..2]);
            corners.extend(fan.iter().map(|triangle| triangle[2]));
            self.project(vertices, &corners);
            // The fan keeps the edges of an outline that cannot be cut.
            if self.cut_ears() {
                let ears = self.ears.chunks_exact(3).map(|ear| [0, 1, 2].map(|k| corners[ear[k] as usize]));
                fan.iter_mut().zip(ears).for_each(|(triangle, ear)| *triangle = ear);
            }
            self.corners = corners;
        }
    }

    /// The corners along the two axes that the polygon faces most, turned counter-clockwise.
    fn project(&mut self, vertices: &[Vec3], corners: &[u32]) {
        let at = |n: usize| vertices[corners[n % corners.len()] as usize];
        let mut normal = [0.0_f64; 3];
        for n in 0..corners.len() {
            let (p, q) = (at(n), at(n + 1));
            for (k, sum) in normal.iter_mut().enumerate() {
                let (l, m) = ((k + 1) % 3, (k + 2) % 3);
                *sum += (p[l] - q[l]) * (p[m] + q[m]);
            }
        }
        // Look along the normal's longest component: the outline is largest there, and least likely to fold.
        let size = normal.map(f64::abs);
        let axis = if size[0] >= size[1] && size[0] >= size[2] {
            0
        } else if size[1] >= size[2] {
            1
        } else {
            2
        };
        let (mut x, mut y) = ((axis + 1) % 3, (axis + 2) % 3);
        // Seen from behind, the outline would turn to the right.
        if normal[axis] < 0.0 {
            (x, y) = (y, x);
        }
        self.flat.clear();
        self.flat.extend((0..corners.len()).map(|n| [at(n)[x], at(n)[y]]));
    }

    /// Cuts the flat outline into `ears`; false when the outline is not simple.
    fn cut_ears(&mut self) -> bool {
        let count = self.flat.len() as u32;
        let earcut = self.earcut.get_or_insert_with(Earcut::new);
        earcut.earcut(self.flat.iter().copied(), &[], &mut self.ears);
        // Ears come clockwise or counter-clockwise as the library likes; the outline's own edges tell.
        let mut next = vec![u32::MAX; count as usize];
        let is_edge = |a: u32, b: u32| b == (a + 1) % count;
        if self.ears.chunks_exact(3).any(|t| is_edge(t[1], t[0]) || is_edge(t[2], t[1]) || is_edge(t[0], t[2])) {
            self.ears.chunks_exact_mut(3).for_each(|t| t.swap(1, 2));
        }
        // Corners on a straight edge are left out by the library: the ear on that edge takes them back.
        let mut used: Vec<u32> = self.ears.clone();
        used.sort_unstable();
        used.dedup();
        if used.len() < 3 || self.ears.len() / 3 != used.len() - 2 {
            return false;
        }
        for (n, &from) in used.iter().enumerate() {
            next[from as usize] = used[(n + 1) % used.len()];
        }
        let mut whole = Vec::with_capacity(3 * (count as usize - 2));
        for ear in self.ears.chunks_exact(3) {
            let outer: Vec<usize> = (0..3).filter(|&k| next[ear[k] as usize] == ear[(k + 1) % 3]).collect();
            split(ear, &outer, count, &mut whole);
        }
        self.ears = whole;
        self.ears.len() == 3 * (count as usize - 2) && keeps_outline(&self.ears, count)
    }
}

/// Triangles have the edges of an outline of `count` corners, and otherwise edges that are theirs alone and
/// cancel: outlines that cross themselves are cut by the library at will.
fn keeps_outline(triangles: &[u32], count: u32) -> bool {
    let edges = triangles.chunks_exact(3).flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
    let mut inner: Vec<(u32, u32)> = edges.filter(|&(a, b)| b != (a + 1) % count).collect();
    let outer = triangles.len() - inner.len();
    inner.sort_unstable();
    // Each inner edge belongs to two triangles, which run along it in opposite directions.
    let cancels = |&(a, b): &(u32, u32)| inner.binary_search(&(b, a)).is_ok();
    outer == count as usize && inner.windows(2).all(|pair| pair[0] != pair[1]) && inner.iter().all(cancels)
}

/// Splits an ear at the corners that lie on its `outer` edges, each given by its first corner.
fn split(ear: &[u32], outer: &[usize], count: u32, out: &mut Vec<u32>) {
    let between = |from: u32, to: u32| (to + count - from - 1) % count;
    let Some((&k, rest)) = outer.split_first() else {
        out.extend(ear);
        return;
    };
    let [from, to, apex] = [0, 1, 2].map(|n| ear[(k + n) % 3]);
    // Corners between the ends of the edge become a fan around the third corner.
    let mut last = from;
    for step in 1..=between(from, to) {
        let middle = (from + step) % count;
        out.extend([last, middle, apex]);
        last = middle;
    }
    // What is left has its corner `from` moved; the other two edges are as they were.
    let mut left = [0; 3];
    left[k] = last;
    left[(k + 1) % 3] = to;
    left[(k + 2) % 3] = apex;
    split(&left, rest, count, out);
}

/// The outline turns once on its way round, as each does that does not cross itself.
fn turns_once(flat: &[[f64; 2]]) -> bool {
    let edge = |n: usize| {
        let (from, to) = (flat[n % flat.len()], flat[(n + 1) % flat.len()]);
        [to[0] - from[0], to[1] - from[1]]
    };
    let turn = |n: usize| {
        let ([ax, ay], [bx, by]) = (edge(n), edge(n + 1));
        (ax * by - ay * bx).atan2(ax * bx + ay * by)
    };
    let turns = (0..flat.len()).map(turn).sum::<f64>() / std::f64::consts::TAU;
    turns.round().abs() == 1.0
}

/// Every corner of a counter-clockwise outline turns strictly left, and the outline turns once.
fn is_convex(flat: &[[f64; 2]]) -> bool {
    let count = flat.len();
    let at = |n: usize| flat[n % count];
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
    let turns_left = (0..count).all(|n| turn(at(n), at(n + 1), at(n + 2)) > 0.0);
    // A star turns left everywhere but twice around; seen from corner 0 a convex outline never goes back.
    turns_left && (1..count - 1).all(|n| turn(at(0), at(n), at(n + 1)) > 0.0)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;

    fn cut(vertices: &[Vec3], corners: &[u32]) -> Vec<[u32; 3]> {
        let (mut cutter, mut triangles) = (Cutter::default(), Vec::new());
        cutter.fan(vertices, corners, &mut triangles);
        assert_eq!(cutter.excess(), None);
        cutter.cut(vertices, &mut triangles);
        triangles
    }

    /// Directed edges that do not cancel, with how often they are there.
    fn outline(triangles: impl IntoIterator<Item = Vec<u32>>) -> BTreeMap<(u32, u32), i32> {
        let mut edges = BTreeMap::new();
        for polygon in triangles {
            for n in 0..polygon.len() {
                let (a, b) = (polygon[n], polygon[(n + 1) % polygon.len()]);
                *edges.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
            }
        }
        edges.retain(|&(a, b), count| a != b && *count != 0);
        edges
    }

    /// Twice the area, positive where it turns with the normal.
    fn area(vertices: &[Vec3], corners: &[u32], normal: Vec3) -> f64 {
        let at = |n: u32| vertices[n as usize];
        let dot = |a: Vec3, b: Vec3| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let cross =
            |a: Vec3, b: Vec3| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        (0..corners.len()).map(|n| dot(normal, cross(at(corners[n]), at(corners[(n + 1) % corners.len()])))).sum()
    }

    #[test]
    fn small_polygons_are_cut_as_expected() {
        let flat = |points: &[[f64; 2]]| points.iter().map(|p| [p[0], p[1], 0.0]).collect::<Vec<Vec3>>();
        let square = flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(cut(&square, &[0, 1, 2]), [[0, 1, 2]]);
        assert_eq!(cut(&square, &[0, 1, 2, 3]), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(cut(&square, &[3, 2, 1, 0]), [[3, 2, 1], [3, 1, 0]], "seen from behind");
        // An arrow head: the diagonal from 0 to 2 lies outside.
        let arrow = flat(&[[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [0.5, 1.0]]);
        let triangles = cut(&arrow, &[0, 1, 2, 3]);
        assert!(triangles.iter().all(|t| t.contains(&1) && t.contains(&3)), "{triangles:?}");
    }

    #[test]
    fn corners_on_edges_stay_corners() {
        // A square with a corner in the middle of each edge, and two in the last one.
        let points = [[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1], [0, 1]];
        let vertices: Vec<Vec3> = points.iter().map(|p| [f64::from(p[0]), f64::from(p[1]), 0.0]).collect();
        let corners: Vec<u32> = (0..9).collect();
        let triangles = cut(&vertices, &corners);
        assert_eq!(triangles.len(), 7);
        assert_eq!(outline(triangles.iter().map(|t| t.to_vec())), outline([corners]));
        assert!(triangles.iter().all(|t| area(&vertices, t, [0.0, 0.0, 1.0]) >= 0.0), "{triangles:?}");
    }

    fn zigzag(count: u32) -> Vec<Vec3> {
        (0..count).map(|n| [f64::from(n), if n == 0 { 2.0 } else { f64::from(n % 2) }, 0.0]).collect()
    }

    #[test]
    fn concave_polygons_of_too_many_corners_are_known_before_they_are_cut() {
        let vertices = zigzag(20_000);
        let corners: Vec<u32> = (0..20_000).collect();
        let excess = |sizes: &[(usize, usize)]| {
            let (mut cutter, mut triangles) = (Cutter::default(), Vec::new());
            for &(size, count) in sizes {
                (0..count).for_each(|_| cutter.fan(&vertices, &corners[..size], &mut triangles));
            }
            cutter.excess()
        };
        assert_eq!(excess(&[(19_000, 1)]), None);
        assert_eq!(excess(&[(20_000, 1)]), Some(Concave { first: 0, corners: 20_000 }));
        assert_eq!(excess(&[(1_000, 115)]), None);
        assert_eq!(excess(&[(1_000, 125)]), Some(Concave { first: 0, corners: 1_000 }));
        // Their order does not matter: the largest is told, and small ones allow for themselves only.
        let largest = Concave { first: 998 * 30, corners: 15_000 };
        assert_eq!(excess(&[(1_000, 30), (15_000, 2), (8, 20_000)]), Some(largest));
        // Many small ones are cut however many they are, and so is a convex one of any size.
        assert_eq!(excess(&[(100, 20_000)]), None);
        let circle = |n: u32| {
            let angle = f64::from(n) / 20_000.0 * std::f64::consts::TAU;
            [angle.cos(), angle.sin(), 0.0]
        };
        let circle: Vec<Vec3> = (0..20_000).map(circle).collect();
        assert_eq!(cut(&circle, &corners).len(), 19_998);
    }

    #[test]
    fn long_outlines_that_cross_themselves_become_fans() {
        // A star of one stroke goes round its middle once for each third corner.
        let star = |count: u32| {
            let place = |n: u32| f64::from(n * (count / 3 + 1) % count) / f64::from(count) * std::f64::consts::TAU;
            let vertices: Vec<Vec3> = (0..count).map(|n| [place(n).cos(), place(n).sin(), 0.0]).collect();
            let corners: Vec<u32> = (0..count).collect();
            cut(&vertices, &corners).iter().all(|triangle| triangle[0] == 0)
        };
        assert!(star(7_001));
        // A zigzag turns once, however long it is.
        let corners: Vec<u32> = (0..1_100).collect();
        assert!(cut(&zigzag(1_100), &corners).iter().any(|triangle| triangle[0] != 0));
    }

    #[test]
    fn polygons_are_cut_among_others() {
        // An arrow head between convex outlines, and one that crosses itself.
        let points = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [0.5, 1.0], [-1.0, 1.0]];
        let vertices: Vec<Vec3> = points.iter().map(|p| [p[0], p[1], 0.0]).collect();
        let polygons: [&[u32]; 4] = [&[0, 1, 2, 4], &[0, 1, 2, 3], &[0, 1, 2], &[0, 2, 1, 4, 3]];
        let (mut cutter, mut triangles) = (Cutter::default(), Vec::new());
        polygons.iter().for_each(|corners| cutter.fan(&vertices, corners, &mut triangles));
        cutter.cut(&vertices, &mut triangles);
        let alone: Vec<[u32; 3]> = polygons.iter().flat_map(|corners| cut(&vertices, corners)).collect();
        assert_eq!(triangles, alone);
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

        /// A star-shaped outline in any plane is covered exactly once.
        #[test]
        fn a_simple_polygon_is_covered_once(
            radii in prop::collection::vec(0.2..1.0_f64, 3..40),
            split in any::<prop::sample::Index>(),
            (a, b) in (-3.0..3.0_f64, -3.0..3.0_f64),
            axis in 0..3_usize,
            is_turned in any::<bool>(),
        ) {
            let count = radii.len();
            let mut points: Vec<[f64; 2]> = radii
                .iter()
                .enumerate()
                .map(|(n, radius)| {
                    let angle = n as f64 / count as f64 * std::f64::consts::TAU;
                    [radius * angle.cos(), radius * angle.sin()]
                })
                .collect();
            // One more corner in the middle of an edge.
            let at = split.index(count);
            let (p, q) = (points[at], points[(at + 1) % count]);
            points.insert(at + 1, [(p[0] + q[0]) / 2.0, (p[1] + q[1]) / 2.0]);
            let raise = |p: &[f64; 2]| {
                let mut point = [0.0; 3];
                point[axis] = a * p[0] + b * p[1];
                point[(axis + 1) % 3] = p[0];
                point[(axis + 2) % 3] = p[1];
                point
            };
            let vertices: Vec<Vec3> = points.iter().map(raise).collect();
            let mut corners: Vec<u32> = (0..vertices.len() as u32).collect();
            if is_turned {
                corners.reverse();
            }
            let triangles = cut(&vertices, &corners);
            prop_assert_eq!(triangles.len(), corners.len() - 2);
            prop_assert_eq!(outline(triangles.iter().map(|t| t.to_vec())), outline([corners.clone()]));
            let mut normal = [0.0; 3];
            normal[axis] = if is_turned { -1.0 } else { 1.0 };
            let whole = area(&vertices, &corners, normal);
            let parts: f64 = triangles.iter().map(|t| area(&vertices, t, normal).abs()).sum();
            prop_assert!((whole - parts).abs() < 1e-9, "{} {}", whole, parts);
        }

        /// Whatever the outline does, it stays the outline.
        #[test]
        fn any_polygon_keeps_its_edges(
            points in prop::collection::vec([0..4_i8, 0..4_i8, 0..2_i8], 3..12),
            repeated in prop::collection::vec(any::<prop::sample::Index>(), 0..4),
        ) {
            let vertices: Vec<Vec3> = points.iter().map(|p| p.map(f64::from)).collect();
            let mut corners: Vec<u32> = (0..vertices.len() as u32).collect();
            corners.extend(repeated.iter().map(|index| index.index(vertices.len()) as u32));
            let triangles = cut(&vertices, &corners);
            prop_assert_eq!(triangles.len(), corners.len() - 2);
            prop_assert_eq!(outline(triangles.iter().map(|t| t.to_vec())), outline([corners]));
        }
    }
}
