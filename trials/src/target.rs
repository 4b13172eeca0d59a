//! A mesh in its kd tree, with the searches of the kernels (by their native twin) and the same search without a tree.

use std::cmp::Ordering;

use isa::number::ray::{Meeting, Ray, TriangleEnd, triangle};
use isa::number::{Arithmetic, Nearest32, Vector};
use kernels::KernelSet;
use kernels::build::SceneFeatures;
use kernels::twin::packets::PackedLeaves;
use kernels::twin::planes::Packets;
use kernels::twin::stage::StageNode;
use kernels::twin::{Twin, ray};
use scenes::image::{self, MemoryOptions};
use scenes::model::{Material, Scene, Triangle, View};

use crate::mesh::{ClosedMesh, TriangleCorners};

/// Sign of the determinant where a ray leaves a body whose triangles run anticlockwise, seen from outside.
const OUTWARDS: i32 = -1;

/// A mesh on the grid of a word.
pub struct Target<T = Nearest32> {
    /// Name of the target.
    pub name: &'static str,
    /// The kernels' functions for it.
    pub twin: Twin<T>,
    /// Packets of the tree, as the rows of the packet unit take them.
    pub packets: PackedLeaves,
    /// Coordinates of the planes that divide the tree, by axis.
    pub splits: [Vec<i32>; 3],
}

/// A hit: t as a fraction with a positive denominator, the sign of the determinant, the triangle.
pub type Crossing = (i128, i128, i32, u32);

impl Target {
    /// The mesh as the loader puts it on the grid of 32 bits, with its tree.
    pub fn new(mesh: &ClosedMesh, profile: KernelSet) -> Target {
        Target::stored(mesh, profile, &MemoryOptions::default(), Nearest32)
    }
}

impl<T: Arithmetic> Target<T> {
    /// The mesh as the loader stores it, with its tree; the arithmetic is that of the options' word.
    pub fn stored(mesh: &ClosedMesh, profile: KernelSet, options: &MemoryOptions, arithmetic: T) -> Target<T> {
        let grey = Material { colour: [0.5; 3], reflection: 0.0, intensity: 1.0, index: 0.0 };
        let corner = |number: usize| 3 * number as u32;
        let scene = Scene {
            name: mesh.name.into(),
            size: (1, 1),
            materials: vec![grey],
            lights: Vec::new(),
            vertices: mesh.triangles.iter().flatten().map(|vertex| vertex.map(f64::from)).collect(),
            triangles: (0..mesh.triangles.len())
                .map(|number| Triangle { vertices: [0, 1, 2].map(|k| corner(number) + k), material: 0 })
                .collect(),
        };
        let view = View::new(scene.size);
        let image = image::build(&scene, &view, options).expect("the mesh fits the grid");
        let features = SceneFeatures::new(&scene, &view, &image.formats, &kernels::KernelOptions::default());
        let twin = Twin::new(&image, &features, profile, arithmetic).expect("an image that was built can be read");
        let mut splits = [vec![], vec![], vec![]];
        for node in &twin.stage.nodes {
            if let StageNode::Inner { axis, at, .. } = *node {
                splits[axis].push(at);
            }
        }
        let packets = PackedLeaves::new(&twin.stage);
        Target { name: mesh.name, twin, packets, splits }
    }

    /// The corners of a triangle, on the grid.
    pub fn corners(&self, index: u32) -> &TriangleCorners {
        &self.twin.stage.triangles[index as usize].vertices
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.twin.stage.triangles.len()
    }

    fn crossing(&self, ray: &Ray, index: u32) -> Option<Crossing> {
        let Meeting { end, determinant, t, .. } = triangle(ray, self.corners(index));
        let sign = determinant.signum();
        (end == TriangleEnd::Hit).then_some((t * sign, determinant * sign, sign as i32, index))
    }

    /// All crossings that the walk through the tree finds, each triangle once, nearest first.
    pub fn crossings(&self, ray: &Ray) -> Vec<Crossing> {
        let stage = &self.twin.stage;
        let packets = Packets::new(&stage.nodes, &stage.bounds, *ray);
        let indices = packets.flat_map(|packet| &stage.references[packet.start as usize..packet.end as usize]);
        let mut found: Vec<Crossing> = indices.filter_map(|&index| self.crossing(ray, index)).collect();
        found.sort_by_key(|crossing| crossing.3);
        found.dedup_by_key(|crossing| crossing.3);
        found.sort_by(by_distance);
        found
    }

    /// The nearest hit from a search through all triangles.
    pub fn all_crossings(&self, ray: &Ray) -> Vec<Crossing> {
        let mut all: Vec<Crossing> = (0..self.len() as u32).filter_map(|index| self.crossing(ray, index)).collect();
        all.sort_by(by_distance);
        all
    }

    /// Result of the kernels: the rounded t and the triangle.
    pub fn nearest(&self, ray: &Ray) -> Result<Option<(i32, u32)>, String> {
        let twin = &self.twin;
        let ray = ray::TwinRay::new(&twin.arithmetic, ray.origin, ray.direction);
        let mut search = ray::TwinSearch { t: twin.constants.never, triangle: None, takes_any: false };
        if let Some(first) = twin.own_packet(&ray) {
            twin.trace(&ray, first, &mut search).map_err(|_| "the walk is stuck".to_owned())?;
        }
        Ok(search.triangle.map(|index| (search.t, index)))
    }

    /// Result of the profile `packet`: the rounded t and the triangle.
    fn nearest_of_packets(&self, ray: &Ray) -> Option<(i32, u32)> {
        let Twin { arithmetic, constants, stage, .. } = &self.twin;
        let mut search = ray::TwinSearch { t: constants.never, triangle: None, takes_any: false };
        self.packets.search(stage, arithmetic, constants, ray, &mut search);
        search.triangle.map(|index| (search.t, index))
    }

    /// Checks that whole packets give the nearest of the crossings that the walk finds, and that any hit in front of a distance is found just
    /// where there is one.
    ///
    /// # Errors
    /// The mistake, in words.
    fn check_packets(&self, ray: &Ray, found: &[Crossing]) -> Result<(), String> {
        let (nearest, expected) = (self.nearest_of_packets(ray), self.expected(found));
        if nearest != expected {
            return Err(format!("{}, {ray:?}: packets give {nearest:?}, nearest is {expected:?}", self.name));
        }
        let Twin { arithmetic, constants, stage, .. } = &self.twin;
        for limit in expected.into_iter().flat_map(|(t, _)| [t, t + 1]) {
            let mut search = ray::TwinSearch { t: limit, triangle: None, takes_any: true };
            self.packets.search(stage, arithmetic, constants, ray, &mut search);
            let is_right = match search.triangle {
                Some(_) => expected.is_some_and(|(t, _)| t < limit && search.t == t),
                None => expected.is_some_and(|(t, _)| t >= limit),
            };
            if !is_right {
                return Err(format!("{}, {ray:?}: any hit before {limit} is {search:?}", self.name));
            }
        }
        Ok(())
    }

    /// Result that the kernels should find: of the smallest rounded t the lowest index.
    pub fn expected(&self, crossings: &[Crossing]) -> Option<(i32, u32)> {
        let shift = self.twin.constants.along();
        let rounded = |&(t, determinant, _, index): &Crossing| (nearest_integer(t, determinant, shift), index);
        crossings.iter().map(rounded).min().filter(|&(t, _)| t < self.twin.constants.never)
    }

    /// Checks that the ray crosses the closed surface evenly, and that a search finds what there is.
    ///
    /// # Errors
    /// The mistake, in words.
    pub fn check_closed(&self, ray: &Ray, is_searched: bool) -> Result<(), String> {
        let found = self.crossings(ray);
        self.check_packets(ray, &found)?;
        // The way ends outside: ahead of each point of it, inwards against outwards, is nothing or one surface outwards. Crossings at the
        // same t, where the ray grazes an edge, have no order, only a sum.
        let mut ahead: i32 = found.iter().map(|crossing| crossing.2).sum();
        let bounds = &self.twin.stage.bounds;
        let starts_outside = (0..3).any(|k| ray.origin[k] < bounds.low[k] || ray.origin[k] > bounds.high[k]);
        if starts_outside && ahead != 0 {
            return Err(format!("{}, {ray:?}: {ahead} surfaces without another side", self.name));
        }
        let mut met = found.chunk_by(|a, b| by_distance(a, b).is_eq());
        loop {
            if ahead != 0 && ahead != OUTWARDS {
                return Err(format!("{}, {ray:?}: {ahead} surfaces ahead of a point", self.name));
            }
            let Some(surfaces) = met.next() else { break };
            ahead -= surfaces.iter().map(|crossing| crossing.2).sum::<i32>();
        }
        if is_searched { self.check_nearest(ray) } else { Ok(()) }
    }

    /// Checks that a ray from outside crosses the closed surface as often inwards as outwards, wherever rounding has moved its vertices to; and
    /// where it `is_searched`, that the tree finds what there is.
    ///
    /// # Errors
    /// The mistake, in words.
    pub fn check_leaks(&self, ray: &Ray, is_searched: bool) -> Result<(), String> {
        let bounds = &self.twin.stage.bounds;
        let starts_outside = (0..3).any(|k| ray.origin[k] < bounds.low[k] || ray.origin[k] > bounds.high[k]);
        let sum: i32 = self.crossings(ray).iter().map(|crossing| crossing.2).sum();
        if starts_outside && sum != 0 {
            return Err(format!("{}, {ray:?}: {sum} surfaces without another side", self.name));
        }
        if is_searched { self.check_nearest(ray) } else { Ok(()) }
    }

    /// Checks the nearest hit and all crossings against a search through all triangles.
    ///
    /// # Errors
    /// The mistake, in words.
    pub fn check_nearest(&self, ray: &Ray) -> Result<(), String> {
        let all = self.all_crossings(ray);
        let mut found = self.crossings(ray);
        let mut sorted = all.clone();
        found.sort_by_key(|crossing| crossing.3);
        sorted.sort_by_key(|crossing| crossing.3);
        if found != sorted {
            return Err(format!("{}, {ray:?}: the tree finds {found:?} of {sorted:?}", self.name));
        }
        self.check_packets(ray, &all)?;
        let (nearest, expected) = (self.nearest(ray)?, self.expected(&all));
        if nearest == expected {
            Ok(())
        } else {
            Err(format!("{}, {ray:?}: found {nearest:?}, nearest is {expected:?}", self.name))
        }
    }
}

/// `t 2^shift / determinant`, to nearest with ties up, saturated; both are positive.
pub fn nearest_integer(t: i128, determinant: i128, shift: u32) -> i32 {
    let (mut whole, mut rest) = (t / determinant, t % determinant);
    for _ in 0..shift {
        rest *= 2;
        whole = (2 * whole + i128::from(rest >= determinant)).min(1 << 40);
        rest -= if rest >= determinant { determinant } else { 0 };
    }
    (whole + i128::from(2 * rest >= determinant)).min(i32::MAX.into()) as i32
}

/// t of one against t of the other, by their continued fractions.
pub fn by_distance(&(a, b, ..): &Crossing, &(c, d, ..): &Crossing) -> Ordering {
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

/// A ray from one point through another.
pub fn through(origin: Vector, towards: Vector) -> Ray {
    Ray { origin, direction: std::array::from_fn(|k| towards[k] - origin[k]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::sphere;
    use crate::series::Random;

    /// Rays at vertices that are found to be wrong, of 500.
    fn wrong(triangles: Vec<TriangleCorners>) -> usize {
        wrong_of(&Target::new(&ClosedMesh { name: "sphere", triangles }, KernelSet::Ray))
    }

    fn wrong_of(target: &Target) -> usize {
        let ray = |trial| {
            let mut random = Random::new(1, trial);
            through(random.point(1 << 30), target.corners(random.below(target.len()) as u32)[0])
        };
        (0..500).filter(|&trial| target.check_closed(&ray(trial), true).is_err()).count()
    }

    #[test]
    fn holes_and_double_surfaces_are_found() {
        let closed = sphere(3, |_| 1.0);
        assert_eq!(wrong(closed.clone()), 0);
        assert!(wrong(closed[1..].to_vec()) > 5, "a hole");
        assert!(wrong([closed.clone(), closed[..4].to_vec()].concat()) > 5, "a surface that is there twice");
        let turned = closed.iter().map(|&[a, b, c]| [a, c, b]).collect();
        assert!(wrong(turned) > 100, "inside out");
    }

    #[test]
    fn packets_that_differ_are_found() {
        let mut target = Target::new(&ClosedMesh { name: "sphere", triangles: sphere(3, |_| 1.0) }, KernelSet::Ray);
        let mut moved = target.twin.stage.clone();
        moved.triangles[7].vertices[0][1] += 1 << 20;
        target.packets = PackedLeaves::new(&moved);
        assert!(wrong_of(&target) > 0, "a vertex that lies elsewhere");
        let mut named = target.twin.stage.clone();
        named.triangles.chunks_exact_mut(2).for_each(|pair| pair.swap(0, 1));
        target.packets = PackedLeaves::new(&named);
        assert!(wrong_of(&target) > 100, "triangles that have the names of others");
    }

    #[test]
    fn quotients_are_rounded_to_the_nearest() {
        assert_eq!(
            [(7, 2, 0), (5, 4, 0), (1, 3, 4), (1, 1, 31)].map(|(t, d, i)| nearest_integer(t, d, i)),
            [4, 1, 5, i32::MAX]
        );
    }
}
