//! Single triangles that are hard to decide, and many that lie on top of each other, against exact integers.

use std::ops::Range;
use std::sync::LazyLock;

use emu::semantics::RayRoom;
use isa::number::ray::{PacketHit, PacketWords, Ray};
use isa::number::{Nearest32, Vector};
use kernels::KernelSet;
use kernels::twin::packets::PackedLeaves;
use kernels::twin::stage::StageNode;

use crate::mesh::{ClosedMesh, TriangleCorners, cube, sphere};
use crate::series::Random;
use crate::tally::{TrialTally, tally};
use crate::target::{Target, nearest_integer, through};

/// Fraction bits of t when the machine is asked: 1 is where the ray was aimed.
const SHIFT: u32 = 28;

type Exact = [i128; 3];

fn cross(a: Exact, b: Exact) -> Exact {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Exact, b: Exact) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The model: the volumes of the pyramids that the direction and the edges span, as the origin sees them. t as a fraction.
fn model(ray: &Ray, corners: &TriangleCorners) -> Option<(i128, i128)> {
    // Move the origin to 0: coordinates then have 32 bits, products of three of them 96.
    let [a, b, c]: [Exact; 3] = corners.map(|v| std::array::from_fn(|k| i128::from(v[k]) - i128::from(ray.origin[k])));
    let direction = ray.direction.map(i128::from);
    let edges = [cross(a, b), cross(b, c), cross(c, a)];
    let whole: i128 = edges.iter().map(|&edge| dot(edge, direction)).sum();
    // A volume of 0 is decided as if the direction were moved by (e, e^2, e^3): by the first component of the edge's normal that is not 0.
    let side = |edge: &Exact| {
        let powers = [dot(*edge, direction), edge[0], edge[1], edge[2]];
        powers.into_iter().find(|&power| power != 0).map_or(0, i128::signum)
    };
    let along = dot(a, edges[1]);
    let is_hit =
        whole != 0 && along.signum() == whole.signum() && edges.iter().all(|edge| side(edge) == whole.signum());
    is_hit.then_some((along.abs(), whole.abs()))
}

/// True where the machine's rows decide as the model does and round t as they should.
fn check(ray: &Ray, corners: &TriangleCorners) -> Result<f64, String> {
    let (t, _, _) = Nearest32.rtri([ray.origin, ray.direction], *corners, SHIFT as i32);
    let expected = model(ray, corners).map_or(i32::MAX, |(along, whole)| nearest_integer(along, whole, SHIFT));
    // Twice in a packet: the first name is nearer than the second one.
    let words = corners.as_flattened().iter().flat_map(|&word| [word; 2]);
    let octets: Vec<u8> = [1, 2].into_iter().chain(words).flat_map(i32::to_le_bytes).collect();
    let farthest = PacketHit { t: i32::MAX, name: 0 };
    let found = PacketWords::new(&octets).nearest(&Nearest32, ray, SHIFT, farthest);
    let name = u32::from(expected != i32::MAX);
    if t == expected && found == (PacketHit { t: expected, name }) {
        Ok(0.0)
    } else {
        Err(format!("{ray:?}, {corners:?}: t = {t}, {found:?} in a packet, exactly {expected}"))
    }
}

fn between(a: Vector, b: Vector, share: f64) -> Vector {
    std::array::from_fn(|k| (f64::from(a[k]) + share * (f64::from(b[k]) - f64::from(a[k]))).round() as i32)
}

fn moved(point: Vector, by: Vector) -> Vector {
    std::array::from_fn(|k| point[k] + by[k])
}

/// Rays that run within a few units of a triangle's plane.
pub fn grazing(seed: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let mut random = Random::new(seed, trial);
        let size = 1 << (4 + random.below(21));
        let place = random.point(1 << 28);
        let corners: TriangleCorners = std::array::from_fn(|_| moved(place, random.point(size)));
        let [a, b, c] = corners;
        let towards = between(between(a, b, random.unit()), c, random.unit());
        // The plane's points are rounded to the grid: the ray is off by a unit or so, and by as much more as it is moved.
        let from = between(between(a, c, 2.0 + 2.0 * random.unit()), b, 1.5 * random.unit());
        let reach = random.below(3) as i32;
        let origin = moved(from, random.point(reach));
        check(&through(origin, moved(towards, random.point(reach))), &corners)
    })
}

/// Triangles up to a hundred million times as long as wide, met at their long sides.
pub fn slivers(seed: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let mut random = Random::new(seed, trial);
        let (a, b) = (random.point(1 << 28), random.point(1 << 28));
        let width = 1 << random.below(10);
        let c = moved(between(a, b, random.unit()), random.point(width));
        let corners = [a, b, c];
        let towards = moved(between(a, b, random.unit().abs()), random.point(width / 2));
        let origin = random.point(1 << 30);
        check(&through(origin, towards), &corners)
    })
}

/// Sheets a few units apart, which cross each other.
static SHEETS: LazyLock<Target> = LazyLock::new(|| {
    let mut random = Random::new(5, 0);
    let far = 1 << 28;
    let corner = |x: i32, y: i32, random: &mut Random| [x, y, random.coordinate(24)];
    let triangles =
        (0..96).map(|_| [corner(-far, -far, &mut random), corner(far, -far, &mut random), corner(0, far, &mut random)]);
    Target::new(&ClosedMesh { name: "sheets", triangles: triangles.collect() }, KernelSet::Ray)
});

/// Nearest hits whose distances differ by a few units in the last place, or round to the same one.
pub fn near_equal(seed: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let mut random = Random::new(seed, trial);
        let towards = random.point(1 << 28);
        let mut origin = random.point(1 << 29);
        origin[2] = 1 << (6 + random.below(23));
        let ray = through(origin, [towards[0] / 2, towards[1] / 2, 0]);
        SHEETS.check_nearest(&ray).map(|()| 0.0)
    })
}

/// Meshes whose triangles come three times, in a disorder that differs from packet to packet.
static DUPLICATES: LazyLock<Vec<Target>> = LazyLock::new(|| {
    [("sphere", sphere(5, |_| 1.0)), ("box", cube(3))]
        .into_iter()
        .map(|(name, once)| {
            let mut random = Random::new(6, 0);
            let mut triangles = [once.clone(), once.clone(), once].concat();
            shuffle(&mut triangles, &mut random);
            let mut target = Target::new(&ClosedMesh { name, triangles }, KernelSet::Ray);
            let stage = &mut target.twin.stage;
            for node in &stage.nodes {
                if let StageNode::Leaf(references) = node {
                    shuffle(&mut stage.references[references.start as usize..references.end as usize], &mut random);
                }
            }
            target.packets = PackedLeaves::new(&target.twin.stage);
            target
        })
        .collect()
});

fn shuffle<T>(items: &mut [T], random: &mut Random) {
    for at in (1..items.len()).rev() {
        items.swap(at, random.below(at + 1));
    }
}

fn aim(target: &Target, random: &mut Random) -> Ray {
    let [a, b, c] = *target.corners(random.below(target.len()) as u32);
    let towards = between(between(a, b, random.unit().abs()), c, random.unit().abs());
    let vertex = [a, towards][random.below(2)];
    through(random.point(1 << 30), vertex)
}

/// The lowest index of coplanar duplicates, whatever the order in a packet.
pub fn duplicates(seed: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let target = &DUPLICATES[trial as usize % DUPLICATES.len()];
        target.check_nearest(&aim(target, &mut Random::new(seed, trial))).map(|()| 0.0)
    })
}

/// A sphere among triangles without area: points, and lines along its edges.
static DEGENERATE: LazyLock<Target> = LazyLock::new(|| {
    let whole = sphere(6, |_| 1.0);
    let mut triangles = Vec::new();
    for &[a, b, c] in &whole {
        let middle = std::array::from_fn(|k| (a[k] + b[k]) / 2);
        triangles.extend([[a, a, a], [a, b, middle], [a, b, c], [b, b, c]]);
    }
    Target::new(&ClosedMesh { name: "sphere", triangles }, KernelSet::Ray)
});

/// Triangles without area are never hit, and do not disturb the others.
pub fn degenerate(seed: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let ray = aim(&DEGENERATE, &mut Random::new(seed, trial));
        DEGENERATE.check_closed(&ray, true)?;
        match DEGENERATE.nearest(&ray)? {
            Some((_, index)) if index % 4 != 2 => Err(format!("{ray:?}: triangle {index} has no area")),
            _ => Ok(0.0),
        }
    })
}

/// A box that touches the ends of the grid, 2^30 - 4 from its centre.
static FULL: LazyLock<Target> = LazyLock::new(|| {
    let ends = |x: i32| x - x.signum() * i32::from(x.abs() == 1 << 28);
    let triangles = cube(3).into_iter().map(|corners| corners.map(|corner| corner.map(ends))).collect();
    Target::new(&ClosedMesh { name: "box at the ends of the grid", triangles }, KernelSet::Ray)
});

/// Rays from and to the ends of the grid: differences of the full word.
pub fn bounds(seed: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let mut random = Random::new(seed, trial);
        let end = (1 << 30) - 4;
        let any = |random: &mut Random| -> Vector {
            std::array::from_fn(|_| [end, -end, random.coordinate(end)][random.below(3)])
        };
        let (origin, towards) = (any(&mut random), any(&mut random));
        FULL.check_closed(&through(origin, towards), true).map(|()| 0.0)
    })
}
