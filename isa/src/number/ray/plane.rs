//! Planes perpendicular to an axis and the order in which a ray meets them: the faces of boxes and the splits of a kd tree.

use std::cmp::Ordering;

use super::Ray;
use crate::number::Vector;

/// The number that stands for time among the axes: there the origin is 0 and the direction 1.
const TIME: usize = 3;

/// A plane perpendicular to an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plane {
    /// 0, 1, 2; 3 for the moment t = `at` (in raw coordinates over raw directions), which is no plane in space.
    pub axis: usize,
    /// The coordinate at which it cuts its axis, raw.
    pub at: i32,
}

impl Plane {
    /// The start of a ray, t = 0.
    pub const START: Plane = Plane { axis: TIME, at: 0 };

    /// A stand-in for no plane at all: the pattern with all bits set.
    pub const NOWHERE: Plane = Plane { axis: TIME, at: -1 };

    /// The plane in a pattern of 64 bits: the axis in the two lowest bits of the high half, the coordinate in the low half.
    #[inline]
    pub const fn from_pattern(pattern: i64) -> Plane {
        Plane { axis: (pattern >> 32 & 3) as usize, at: pattern as i32 }
    }

    /// The pattern with 0 in the other bits; all bits set for [`Plane::NOWHERE`].
    #[inline]
    pub const fn pattern(self) -> i64 {
        match self {
            Plane { axis: TIME, at: -1 } => -1,
            Plane { axis, at } => (axis as i64) << 32 | at as u32 as i64,
        }
    }

    /// The ray meets the plane after its start. A plane through the origin is met at t = 0: it has been crossed.
    #[inline]
    fn is_ahead(self, ray: &Ray) -> bool {
        PlaneCrossed::new(self, ray).is_ahead()
    }

    /// The ray, its direction moved by (e, e^2, e^3), meets this plane before the other one; both are ahead.
    #[inline]
    fn is_before(self, other: Plane, ray: &Ray) -> bool {
        PlaneCrossed::new(self, ray).is_before(PlaneCrossed::new(other, ray))
    }
}

/// A plane as a ray meets it, at t = run / slope.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PlaneCrossed {
    axis: usize,
    run: i64,
    slope: i64,
}

impl PlaneCrossed {
    #[inline]
    pub(super) fn new(plane: Plane, ray: &Ray) -> PlaneCrossed {
        let (run, slope) = match plane.axis {
            TIME => (plane.at.into(), 1),
            axis => (i64::from(plane.at) - i64::from(ray.origin[axis]), ray.direction[axis].into()),
        };
        PlaneCrossed { axis: plane.axis, run, slope }
    }

    /// The ray goes towards smaller coordinates of the plane's axis.
    #[inline]
    pub(super) fn is_backwards(self) -> bool {
        self.slope < 0
    }

    /// The plane lies ahead of the origin; one through the origin does not.
    #[inline]
    pub(super) fn is_ahead(self) -> bool {
        if self.slope < 0 { self.run < 0 } else { self.run > 0 }
    }

    /// The ray, its direction moved by (e, e^2, e^3), meets this plane before the other one; both are ahead.
    ///
    /// Of planes of axes j < k that the ray itself meets at the same t > 0, that of j comes first exactly when D_j >= 0: its t changes by
    /// the larger amount, t e^(j+1) / D_j. A plane is not before itself. Runs stay below 2^32, so products fit 64 bits.
    #[inline]
    pub(super) fn is_before(self, other: PlaneCrossed) -> bool {
        // run / slope < other_run / other_slope, multiplied by both slopes: the comparison turns round when one of them is negative.
        let (here, there) = (self.run * other.slope, other.run * self.slope);
        if here == there {
            return match self.axis.cmp(&other.axis) {
                Ordering::Less => self.slope >= 0,
                Ordering::Equal => false,
                Ordering::Greater => other.slope < 0,
            };
        }
        (here < there) == ((self.slope < 0) == (other.slope < 0))
    }
}

/// The ray goes towards smaller coordinates; a direction of 0 counts as positive.
#[inline]
fn is_backwards(ray: &Ray, axis: usize) -> bool {
    axis != TIME && ray.direction[axis] < 0
}

/// The three planes by which a ray enters a box, and those by which it leaves.
fn faces(ray: &Ray, low: Vector, high: Vector) -> [(Plane, Plane); 3] {
    std::array::from_fn(|axis| {
        let [low, high] = [low, high].map(|corner| Plane { axis, at: corner[axis] });
        if is_backwards(ray, axis) { (high, low) } else { (low, high) }
    })
}

fn first_to_leave(ray: &Ray, faces: &[(Plane, Plane); 3]) -> Plane {
    let [x, y, z] = faces.map(|(_, leave)| leave);
    let first = if x.is_before(y, ray) { x } else { y };
    if first.is_before(z, ray) { first } else { z }
}

/// The plane through which a ray leaves a box that it is in.
pub fn exit_face(ray: &Ray, low: Vector, high: Vector) -> Plane {
    first_to_leave(ray, &faces(ray, low, high))
}

/// Position of a ray towards a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxEnd {
    /// The origin is beyond a plane by which the ray would leave.
    Beside,
    /// The ray starts in the box.
    Inside,
    /// The ray leaves the slab between two faces before it enters another one.
    Missed,
    /// The ray enters the box ahead.
    Entered,
}

/// Planes by which a ray enters and leaves a box: [`Plane::START`] for a ray that starts inside, [`Plane::NOWHERE`] twice for one that
/// misses the box.
pub fn across_box(ray: &Ray, low: Vector, high: Vector) -> (Plane, Plane, BoxEnd) {
    let faces = faces(ray, low, high);
    // A box beside the ray: one of its slabs lies behind the start.
    if faces.iter().any(|(_, leave)| !leave.is_ahead(ray)) {
        return (Plane::NOWHERE, Plane::NOWHERE, BoxEnd::Beside);
    }
    let exit = first_to_leave(ray, &faces);
    // The last slab to be entered decides where the ray comes in, the first to be left where it goes out.
    let entries = faces.into_iter().map(|(enter, _)| enter).filter(|enter| enter.is_ahead(ray));
    let entry = entries.fold(Plane::START, |last, next| if last.is_before(next, ray) { next } else { last });
    if entry == Plane::START {
        (entry, exit, BoxEnd::Inside)
    } else if entry.is_before(exit, ray) {
        (entry, exit, BoxEnd::Entered)
    } else {
        (Plane::NOWHERE, Plane::NOWHERE, BoxEnd::Missed)
    }
}

/// Sides of a split that a ray visits between two planes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SplitEnd {
    /// The node is a leaf: its plane has axis 3.
    Leaf,
    /// Only the far side, the one that the ray goes to: the split is met before the ray starts, or at its origin.
    Behind,
    /// Only the far side: the split is met before the ray enters, or where it does.
    Passed,
    /// Only the near side: the ray leaves before it meets the split, or where it does.
    Near,
    /// The near side, then the far one.
    Both,
}

/// Decides how a ray that is between `entry` and `exit` meets a split.
#[inline]
pub fn step(ray: &Ray, split: Plane, entry: Plane, exit: Plane) -> SplitEnd {
    if split.axis == TIME {
        SplitEnd::Leaf
    } else if !split.is_ahead(ray) {
        SplitEnd::Behind
    } else if !entry.is_before(split, ray) {
        SplitEnd::Passed
    } else if !split.is_before(exit, ray) {
        SplitEnd::Near
    } else {
        SplitEnd::Both
    }
}

impl SplitEnd {
    /// The first side to visit is the one of larger coordinates; of a leaf it is none.
    #[inline]
    pub fn is_right_first(self, ray: &Ray, axis: usize) -> bool {
        match self {
            SplitEnd::Leaf => false,
            SplitEnd::Behind | SplitEnd::Passed => !is_backwards(ray, axis),
            SplitEnd::Near | SplitEnd::Both => is_backwards(ray, axis),
        }
    }
}

/// The point at t is nearer than a plane even if t is one unit too small: (t + 1) slope < run 2^shift, with run and slope counted in
/// the ray's direction. Of a hit for which this holds no other one behind the plane can be nearer.
#[inline]
pub fn is_surely_before(ray: &Ray, plane: Plane, t: i32, shift: u32) -> bool {
    let PlaneCrossed { run, slope, .. } = PlaneCrossed::new(plane, ray);
    let run = if slope < 0 { -run } else { run };
    (i128::from(t) + 1) * i128::from(slope.abs()) < i128::from(run) << shift
}
