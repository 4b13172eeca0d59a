//! Exact formulas of the ray unit. Its decisions are exact on the machine's numbers; on shadows they may be others.

use isa::number::ray::{
    BoxEnd, Plane, Ray, SplitEnd, TriangleEnd, across_box, exit_face, is_surely_before, step, triangle,
};

use super::decisions::{RealCrossing, RealRay, meeting, raws, reals};
use super::{RayRoom, RealFormulas, RealResult, ShadowInput, cross, difference, dot, each, quotient, terms};
use RealResult::Integer;

/// The ray of the machine's numbers.
pub(super) fn machine_ray(ray: &[[ShadowInput; 3]; 2]) -> Ray {
    Ray::from([raws(&ray[0]), raws(&ray[1])])
}

/// t, scaled by 2^i, u and v of a ray and a triangle.
pub(super) fn hit(ray: &[[ShadowInput; 3]; 2], vertices: &[[ShadowInput; 3]; 3], i: i32, word: u32) -> [RealResult; 3] {
    let [origin, direction] = [terms(&ray[0]), terms(&ray[1])];
    let [corner, second, third] = [terms(&vertices[0]), terms(&vertices[1]), terms(&vertices[2])];
    let (edge1, edge2) = (difference(&second, &corner), difference(&third, &corner));
    let start = difference(&origin, &corner);
    let (p, q) = (cross(&direction, &edge2), cross(&start, &edge1));
    let determinant = dot(&p, &edge1);
    let weight = word as i32 - 2;
    [
        quotient(&dot(&q, &edge2), &determinant, i),
        quotient(&dot(&p, &start), &determinant, weight),
        quotient(&dot(&q, &direction), &determinant, weight),
    ]
}

/// Planes by which the ray enters and leaves a box, by the same steps as the machine's.
fn real_box(ray: &RealRay, low: [i32; 3], high: [i32; 3]) -> (Plane, Plane, BoxEnd) {
    let crossing = |plane: Plane| ray.crossing(plane);
    let faces: [(Plane, Plane); 3] = std::array::from_fn(|axis| {
        let [low, high] = [low, high].map(|corner| Plane { axis, at: corner[axis] });
        if ray.is_backwards(axis) { (high, low) } else { (low, high) }
    });
    if faces.iter().any(|(_, leave)| !crossing(*leave).is_ahead()) {
        return (Plane::NOWHERE, Plane::NOWHERE, BoxEnd::Beside);
    }
    let exit = first_to_leave(ray, &faces);
    let entries = faces.into_iter().map(|(enter, _)| enter).filter(|enter| crossing(*enter).is_ahead());
    let is_before = |a: Plane, b: Plane| crossing(a).is_before(&crossing(b));
    let entry = entries.fold(Plane::START, |last, next| if is_before(last, next) { next } else { last });
    match entry {
        Plane::START => (entry, exit, BoxEnd::Inside),
        entry if is_before(entry, exit) => (entry, exit, BoxEnd::Entered),
        _ => (Plane::NOWHERE, Plane::NOWHERE, BoxEnd::Missed),
    }
}

fn first_to_leave(ray: &RealRay, faces: &[(Plane, Plane); 3]) -> Plane {
    let is_before = |a: Plane, b: Plane| ray.crossing(a).is_before(&ray.crossing(b));
    let [x, y, z] = faces.map(|(_, leave)| leave);
    let first = if is_before(x, y) { x } else { y };
    if is_before(first, z) { first } else { z }
}

/// A step down a tree, by the same questions as the machine's.
pub(super) fn real_step(ray: &RealRay, split: Plane, entry: &RealCrossing, exit: &RealCrossing) -> (SplitEnd, bool) {
    let crossing = ray.crossing(split);
    let end = if !crossing.is_ahead() {
        SplitEnd::Behind
    } else if !entry.is_before(&crossing) {
        SplitEnd::Passed
    } else if !crossing.is_before(exit) {
        SplitEnd::Near
    } else {
        SplitEnd::Both
    };
    let is_backwards = ray.is_backwards(split.axis);
    (end, matches!(end, SplitEnd::Near | SplitEnd::Both) == is_backwards)
}

impl RayRoom for RealFormulas<'_> {
    fn rtri(&mut self, a: [[ShadowInput; 3]; 2], b: [[ShadowInput; 3]; 3], i: i32) -> (RealResult, [RealResult; 3]) {
        let is_hit = triangle(&machine_ray(&a), &[raws(&b[0]), raws(&b[1]), raws(&b[2])]).end == TriangleEnd::Hit;
        let is_real_hit = || {
            let vertices = [reals(&b[0]), reals(&b[1]), reals(&b[2])];
            match surely_missed(&a, &vertices) {
                true => false,
                false => meeting(&RealRay::new(&a), &vertices).is_some(),
            }
        };
        self.decide_on(a.iter().chain(&b).flatten(), || is_real_hit() == is_hit);
        if !is_hit {
            return (Integer, each(|_| Integer));
        }
        let [t, u, v] = hit(&a, &b, i, self.modes.word);
        (t, [u, v, Integer])
    }

    fn rbox(&mut self, a: [[ShadowInput; 3]; 2], b: [[ShadowInput; 3]; 2]) -> (RealResult, RealResult) {
        let (low, high) = (raws(&b[0]), raws(&b[1]));
        let machine = across_box(&machine_ray(&a), low, high);
        self.decide_on(a.iter().flatten(), || real_box(&RealRay::new(&a), low, high) == machine);
        (Integer, Integer)
    }

    fn rexit(&mut self, a: [[ShadowInput; 3]; 2], b: [[ShadowInput; 3]; 2]) -> (RealResult,) {
        let (low, high) = (raws(&b[0]), raws(&b[1]));
        let machine = exit_face(&machine_ray(&a), low, high);
        let real = || {
            let ray = RealRay::new(&a);
            let faces: [(Plane, Plane); 3] = std::array::from_fn(|axis| {
                let [low, high] = [low, high].map(|corner| Plane { axis, at: corner[axis] });
                if ray.is_backwards(axis) { (high, low) } else { (low, high) }
            });
            first_to_leave(&ray, &faces)
        };
        self.decide_on(a.iter().flatten(), || real() == machine);
        (Integer,)
    }

    fn rstep(&mut self, a: [[ShadowInput; 3]; 2], b: [ShadowInput; 3], _: i32) -> (RealResult, RealResult) {
        let ray = machine_ray(&a);
        let [split, entry, exit] = b.map(|plane| Plane::from_pattern(plane.raw));
        let machine = step(&ray, split, entry, exit);
        if machine != SplitEnd::Leaf {
            self.decide_on(a.iter().flatten(), || {
                let real = RealRay::new(&a);
                let (entry, exit) = (real.crossing(entry), real.crossing(exit));
                real_step(&real, split, &entry, &exit) == (machine, machine.is_right_first(&ray, split.axis))
            });
        }
        (Integer, Integer)
    }

    fn rbefore(&mut self, a: [[ShadowInput; 3]; 2], b: ShadowInput, c: ShadowInput, i: i32) -> (RealResult,) {
        let plane = Plane::from_pattern(b.raw);
        let machine = is_surely_before(&machine_ray(&a), plane, c.raw as i32, i as u32);
        self.decide_on(a.iter().flatten().chain([&c]), || {
            RealRay::new(&a).crossing(plane).is_surely_behind(c.term().real(), i) == machine
        });
        (Integer,)
    }
}

/// Doubles are sure that the ray misses a triangle.
fn surely_missed(ray: &[[ShadowInput; 3]; 2], vertices: &[[crate::shadow::long_real::LongReal; 3]; 3]) -> bool {
    let double = |vector: &[ShadowInput; 3]| reals(vector).map(|component| component.to_f64());
    let corner = |k: usize| vertices[k].map(|component| component.to_f64());
    super::decisions::surely_misses(&[double(&ray[0]), double(&ray[1])], &[corner(0), corner(1), corner(2)])
}
