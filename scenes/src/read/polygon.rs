//! Polygons as triangles: n corners always give n - 2, so that neighbours still share every edge. Concave outlines are
//! cut into ears in the plane of the two axes that the polygon faces most.

use earcut::Earcut;

use crate::model::Vec3;

/// Corners above which an outline is not cut into ears but fanned: no real polygon has as many.
const LARGEST: usize = 10_000;

/// Cuts polygons one after another and keeps its memory between them.
#[derive(Default)]
pub(super) struct Cutter {
    flat: Vec<[f64; 2]>,
    ears: Vec<u32>,
    earcut: Option<Earcut<f64>>,
}

impl Cutter {
    /// The triangles of a polygon with at least three corners, given by vertex number, in the polygon's sense of
    /// rotation: corners.len() - 2 of them.
    pub(super) fn cut(&mut self, vertices: &[Vec3], corners: &[u32], mut triangle: impl FnMut([u32; 3])) {
        let count = corners.len();
        if count > 3 && count <= LARGEST {
            self.project(vertices, corners);
            if !is_convex(&self.flat) && self.cut_ears() {
                self.ears.chunks_exact(3).for_each(|ear| triangle([0, 1, 2].map(|k| corners[ear[k] as usize])));
                return;
            }
        }
        (1..count - 1).for_each(|n| triangle([corners[0], corners[n], corners[n + 1]]));
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
        let size = normal.map(f64::abs);
        let axis = if size[0] >= size[1] && size[0] >= size[2] {
            0
        } else if size[1] >= size[2] {
            1
        } else {
            2
        };
        let (mut x, mut y) = ((axis + 1) % 3, (axis + 2) % 3);
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
        self.ears.len() == 3 * (count as usize - 2)
    }
}

/// Splits an ear at the corners that lie on its `outer` edges, each given by its first corner.
fn split(ear: &[u32], outer: &[usize], count: u32, out: &mut Vec<u32>) {
    let between = |from: u32, to: u32| (to + count - from - 1) % count;
    let Some((&k, rest)) = outer.split_first() else {
        out.extend(ear);
        return;
    };
    let [from, to, apex] = [0, 1, 2].map(|n| ear[(k + n) % 3]);
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

/// Whether every corner of a counter-clockwise outline turns strictly left, and the outline turns once.
fn is_convex(flat: &[[f64; 2]]) -> bool {
    let count = flat.len();
    let at = |n: usize| flat[n % count];
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
    let turns_left = (0..count).all(|n| turn(at(n), at(n + 1), at(n + 2)) > 0.0);
    // A star turns left everywhere but twice around; seen from corner 0 a convex outline never goes back.
    turns_left && (1..count - 1).all(|n| turn(at(0), at(n), at(n + 1)) > 0.0)
}
