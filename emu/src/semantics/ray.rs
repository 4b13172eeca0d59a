//! Semantics of the instructions of the ray unit. The decisions are those of [`isa::number::ray`]; here they meet registers.

use isa::number::ray::{
    BoxEnd, Plane, Ray, SplitEnd, TriangleEnd, across_box, exit_face, is_surely_before, ratio, step, triangle,
};
use isa::number::{Arithmetic, Vector};
use isa::table::{Done, outcome};

use super::RayRoom;

impl<T: Arithmetic> RayRoom for T {
    #[inline]
    fn rtri(&self, a: [Vector; 2], b: [Vector; 3], i: i32) -> (i32, Vector, outcome::rtri::Outcome) {
        use outcome::rtri::{Outcome, Way};
        let met = triangle(&Ray::from(a), &b);
        let way = match met.end {
            TriangleEnd::Parallel => Way::Parallel,
            TriangleEnd::OutsideU => Way::OutsideU,
            TriangleEnd::OutsideV => Way::OutsideV,
            TriangleEnd::OutsideW => Way::OutsideW,
            TriangleEnd::Behind => Way::Behind,
            TriangleEnd::Hit => Way::Hit,
        };
        let exit = Outcome { way, units: met.ties };
        if way != Way::Hit {
            return (i32::MAX >> (32 - self.word()), [0; 3], exit);
        }
        let weight = |part: i128| ratio(self, part, met.determinant, self.word() - 2);
        (ratio(self, met.t, met.determinant, i as u32), [weight(met.u), weight(met.v), 0], exit)
    }

    #[inline]
    fn rbox(&self, a: [Vector; 2], b: [Vector; 2]) -> (i64, i64, outcome::rbox::Outcome) {
        use outcome::rbox::Outcome;
        let (enter, leave, end) = across_box(&Ray::from(a), b[0], b[1]);
        let exit = match end {
            BoxEnd::Beside => Outcome::Beside,
            BoxEnd::Inside => Outcome::Inside,
            BoxEnd::Missed => Outcome::Missed,
            BoxEnd::Entered => Outcome::Entered,
        };
        (enter.pattern(), leave.pattern(), exit)
    }

    #[inline]
    fn rexit(&self, a: [Vector; 2], b: [Vector; 2]) -> (i64, Done) {
        (exit_face(&Ray::from(a), b[0], b[1]).pattern(), Done)
    }

    #[inline]
    fn rstep(&self, a: [Vector; 2], b: [i64; 3], i: i32) -> (i32, i32, outcome::rstep::Outcome) {
        use outcome::rstep::Outcome;
        let ray = Ray::from(a);
        let [split, entry, leave] = b.map(Plane::from_pattern);
        let left = (b[0] >> 32) as i32 & !3;
        let right = left.wrapping_add(i);
        let found = step(&ray, split, entry, leave);
        let (first, second) = if found.is_right_first(&ray, split.axis) { (right, left) } else { (left, right) };
        match found {
            SplitEnd::Leaf => (left, -1, Outcome::Leaf),
            SplitEnd::Behind => (first, 0, Outcome::Behind),
            SplitEnd::Passed => (first, 0, Outcome::Passed),
            SplitEnd::Near => (first, 0, Outcome::Near),
            SplitEnd::Both => (first, second, Outcome::Both),
        }
    }

    #[inline]
    fn rbefore(&self, a: [Vector; 2], b: i64, c: i32, i: i32) -> (i32, Done) {
        (is_surely_before(&Ray::from(a), Plane::from_pattern(b), c, i as u32).into(), Done)
    }
}
