//! Closed meshes are watertight, tree and triangles together: rays that are aimed exactly at vertices, edges and the planes that divide the
//! tree cross the surface as often inwards as outwards, and find what a search through all triangles finds. Natively, with the decisions
//! of the ray unit's rows, which the kernels of the profile `ray` execute.

use std::cmp::Ordering;

use isa::number::Vector;
use isa::number::ray::{Meeting, Ray, TriangleEnd, triangle};
use kernels::twin::planes::Packets;
use kernels::twin::stage::{Node, tree};
use rayon::prelude::*;
use scenes::kdtree::{self, Bounds};

/// Half the length of a mesh: a fine grid, as for words of 32 bits. Coordinates are multiples of 4, so that middles of edges are exact.
const SIZE: f64 = (1 << 28) as f64;

/// Rays in all.
const RAYS: u32 = 1_000_000;

/// Of so many rays one is searched for in all triangles too.
const EVERY: u32 = 10;

/// Sign of the determinant where a ray leaves a body. Seen from outside, triangles run anticlockwise.
const OUTWARDS: i32 = -1;

type Triangle = [Vector; 3];

struct Mesh {
    name: &'static str,
    triangles: Vec<Triangle>,
    nodes: Vec<Node>,
    references: Vec<u32>,
    bounds: Bounds,
    /// Coordinates of the planes that divide the tree, by axis.
    splits: [Vec<i32>; 3],
}

impl Mesh {
    fn new(name: &'static str, triangles: Vec<Triangle>) -> Mesh {
        let boxes: Vec<Bounds> = triangles.iter().map(Bounds::of_triangle).collect();
        let bounds = boxes.iter().copied().reduce(|a, b| a.union(&b)).expect("a mesh has triangles").grown(1);
        let built = kdtree::build(&boxes, bounds, kdtree::DEPTH).expect("a small tree");
        let (nodes, references) = tree(&built);
        let mut splits = [vec![], vec![], vec![]];
        for node in &nodes {
            if let Node::Inner { axis, at, .. } = *node {
                splits[axis].push(at);
            }
        }
        Mesh { name, triangles, nodes, references, bounds, splits }
    }
}

fn on_grid(point: [f64; 3]) -> Vector {
    point.map(|x| 4 * (x * SIZE / 4.0).round() as i32)
}

/// An octahedron whose faces are divided and moved to a sphere.
fn sphere(divisions: i32) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    let corner = |sign: i32, axis: usize| std::array::from_fn(|k| if k == axis { f64::from(sign) } else { 0.0 });
    for octant in 0..8 {
        let signs = [0, 1, 2].map(|k| if octant >> k & 1 == 0 { 1 } else { -1 });
        let mut corners: [[f64; 3]; 3] = [0, 1, 2].map(|k| corner(signs[k], k));
        if signs[0] * signs[1] * signs[2] < 0 {
            corners.swap(1, 2);
        }
        let point = |i: i32, j: i32| {
            let k = divisions - i - j;
            let flat: [f64; 3] = std::array::from_fn(|axis| {
                f64::from(i) * corners[0][axis] + f64::from(j) * corners[1][axis] + f64::from(k) * corners[2][axis]
            });
            let length = flat.iter().map(|x| x * x).sum::<f64>().sqrt();
            on_grid(flat.map(|x| x / length))
        };
        for i in 0..divisions {
            for j in 0..divisions - i {
                triangles.push([point(i, j), point(i + 1, j), point(i, j + 1)]);
                if i + j + 1 < divisions {
                    triangles.push([point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]);
                }
            }
        }
    }
    triangles
}

/// A grid of quadrangles, closed both ways, as triangles.
fn closed_grid(rows: i32, columns: i32, point: impl Fn(i32, i32) -> Vector) -> Vec<Triangle> {
    let at = |row: i32, column: i32| point(row % rows, column % columns);
    let quadrangle = |row: i32, column: i32| {
        let [a, b, c, d] = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(down, right)| at(row + down, column + right));
        [[a, b, c], [a, c, d]]
    };
    (0..rows)
        .flat_map(|row| (0..columns).flat_map(move |column| [(row, column)]))
        .flat_map(|(r, c)| quadrangle(r, c))
        .collect()
}

fn torus(rows: i32, columns: i32) -> Vec<Triangle> {
    let turn = |k: i32, n: i32| (f64::from(k) / f64::from(n) * std::f64::consts::TAU).sin_cos();
    closed_grid(rows, columns, |row, column| {
        let ((s, c), (t, d)) = (turn(row, rows), turn(column, columns));
        let radius = 0.7 + 0.3 * c;
        on_grid([radius * d, radius * t, 0.3 * s])
    })
}

/// A box along the axes, each face a grid of squares: faces and edges lie in the planes that divide the tree.
fn cube(divisions: i32) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    let place = |k: i32| f64::from(2 * k - divisions) / f64::from(divisions);
    for (axis, side) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
        let point = |i: i32, j: i32| {
            let mut point = [0.0; 3];
            point[axis] = f64::from(side);
            (point[(axis + 1) % 3], point[(axis + 2) % 3]) = (place(i), place(j));
            on_grid(point)
        };
        for (i, j) in (0..divisions).flat_map(|i| (0..divisions).map(move |j| (i, j))) {
            let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            triangles.extend(if side > 0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
        }
    }
    triangles
}

/// A very flat double cone: slivers around two tips.
fn spindle(sides: i32) -> Vec<Triangle> {
    let rim = |k: i32| {
        let (s, c) = (f64::from(k % sides) / f64::from(sides) * std::f64::consts::TAU).sin_cos();
        on_grid([1e-5 * c, 1e-5 * s, 0.0])
    };
    let [top, bottom] = [on_grid([0.0, 0.0, 1.0]), on_grid([0.0, 0.0, -1.0])];
    (0..sides).flat_map(|k| [[rim(k), rim(k + 1), top], [rim(k + 1), rim(k), bottom]]).collect()
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    fn coordinate(&mut self, reach: i32) -> i32 {
        self.below(2 * reach as usize + 1) as i32 - reach
    }
}

/// A point on the mesh that a ray can be aimed at exactly.
fn target(mesh: &Mesh, random: &mut Random) -> Vector {
    let [a, b, c] = mesh.triangles[random.below(mesh.triangles.len())];
    match random.below(4) {
        0 => a,
        1 => std::array::from_fn(|k| (a[k] + b[k]) / 2),
        2 => std::array::from_fn(|k| (a[k] + b[k]) / 4 + c[k] / 2),
        _ => b,
    }
}

/// A ray through a target: from far away or near, often within planes of the tree, sometimes along an axis.
fn aim(mesh: &Mesh, random: &mut Random) -> Ray {
    let mut towards = target(mesh, random);
    let reach = [1 << 30, 1 << 28][random.below(2)];
    let mut origin: Vector = std::array::from_fn(|_| random.coordinate(reach));
    for k in 0..3 {
        match random.below(8) {
            // In a plane through the target: of a box, one of its faces.
            0 => origin[k] = towards[k],
            // In a plane that divides the tree.
            1 if !mesh.splits[k].is_empty() => {
                let at = mesh.splits[k][random.below(mesh.splits[k].len())];
                (origin[k], towards[k]) = (at, at);
            }
            // Across one.
            2 if !mesh.splits[k].is_empty() => towards[k] = mesh.splits[k][random.below(mesh.splits[k].len())],
            _ => {}
        }
    }
    let direction = std::array::from_fn(|k| towards[k] - origin[k]);
    Ray { origin, direction }
}

/// A crossing: t as a fraction with a positive denominator, the sign of the determinant, the triangle.
type Crossing = (i128, i128, i32, u32);

fn crossing(index: u32, met: &Meeting) -> Crossing {
    let sign = met.determinant.signum();
    (met.t * sign, met.determinant * sign, sign as i32, index)
}

fn hit(mesh: &Mesh, ray: &Ray, index: u32) -> Option<Crossing> {
    let met = triangle(ray, &mesh.triangles[index as usize]);
    (met.end == TriangleEnd::Hit).then(|| crossing(index, &met))
}

/// t of one against t of the other, by their continued fractions.
fn by_distance(&(a, b, ..): &Crossing, &(c, d, ..): &Crossing) -> Ordering {
    let (mut a, mut b, mut c, mut d) = (a, b, c, d);
    loop {
        let order = (a / b).cmp(&(c / d));
        match (a % b, c % d) {
            _ if order.is_ne() => return order,
            (rest, other) if rest == 0 || other == 0 => return rest.cmp(&other),
            // rest / b < other / d as d / other < b / rest.
            (rest, other) => (a, b, c, d) = (d, other, b, rest),
        }
    }
}

/// All crossings that the walk through the tree finds, each triangle once, nearest first.
fn crossings(mesh: &Mesh, ray: &Ray) -> Vec<Crossing> {
    let packets = Packets::new(&mesh.nodes, &mesh.bounds, *ray);
    let indices = packets.flat_map(|packet| &mesh.references[packet.start as usize..packet.end as usize]);
    let mut found: Vec<Crossing> = indices.filter_map(|&index| hit(mesh, ray, index)).collect();
    found.sort_by_key(|crossing| crossing.3);
    found.dedup_by_key(|crossing| crossing.3);
    found.sort_by(by_distance);
    found
}

/// What is wrong with the way of a ray, in words.
fn fault(mesh: &Mesh, ray: &Ray, is_searched: bool) -> Option<String> {
    let found = crossings(mesh, ray);
    // The way ends outside, so what is ahead of each point of it, inwards against outwards, is nothing or one surface outwards. Crossings at
    // the same t, where the ray grazes an edge, have no order, only a sum.
    let mut ahead: i32 = found.iter().map(|crossing| crossing.2).sum();
    let starts_outside = (0..3).any(|k| ray.origin[k] < mesh.bounds.low[k] || ray.origin[k] > mesh.bounds.high[k]);
    if starts_outside && ahead != 0 {
        return Some(format!("{ahead} surfaces without another side: {found:?}"));
    }
    let mut met = found.chunk_by(|a, b| by_distance(a, b).is_eq());
    loop {
        if ahead != 0 && ahead != OUTWARDS {
            return Some(format!("{ahead} ahead of a point of {found:?}"));
        }
        let Some(surfaces) = met.next() else { break };
        ahead -= surfaces.iter().map(|crossing| crossing.2).sum::<i32>();
    }
    if is_searched {
        let all: Vec<Crossing> = (0..mesh.triangles.len() as u32).filter_map(|index| hit(mesh, ray, index)).collect();
        let mut missing = all.iter().filter(|crossing| !found.contains(crossing));
        if all.len() != found.len() || missing.next().is_some() {
            return Some(format!("the tree finds {found:?}, all triangles are {all:?}"));
        }
    }
    None
}

#[test]
fn aimed_rays_cross_closed_meshes_as_often_inwards_as_outwards() {
    let meshes = [
        Mesh::new("sphere", sphere(6)),
        Mesh::new("torus", torus(16, 24)),
        Mesh::new("box", cube(4)),
        Mesh::new("spindle", spindle(40)),
    ];
    let count = RAYS / meshes.len() as u32;
    for mesh in &meshes {
        let crossed: usize = (0..count)
            .into_par_iter()
            .map(|number| {
                let mut random = Random(u64::from(number) << 20);
                let ray = aim(mesh, &mut random);
                if let Some(fault) = fault(mesh, &ray, number % EVERY == 0) {
                    panic!("{}, ray {number}, {ray:?}: {fault}", mesh.name);
                }
                usize::from(Packets::new(&mesh.nodes, &mesh.bounds, ray).next().is_some())
            })
            .sum();
        assert!(crossed > count as usize / 2, "only {crossed} of {count} rays meet the {}", mesh.name);
    }
}
