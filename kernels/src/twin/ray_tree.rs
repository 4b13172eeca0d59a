//! The tree of a pixel's rays, walked depth first: a ray, its reflected child, its refracted child (report 5.4, pseudo code 5).

use isa::number::{Arithmetic, Vector};

use super::Twin;
use super::ray::{Packet, Stuck, TwinRay, TwinSearch};
use super::reflect::{reflect, reflects};
use super::refract::{Refraction, refract, refracts};
use super::report;
use super::surface::Surface;
use super::vector_arithmetic::VectorArithmetic;
use crate::set::Formulas;

/// A node of the ray tree that is still to be visited.
#[derive(Clone, Debug)]
pub struct Branch {
    ray: TwinRay,
    packet: Option<Packet>,
    /// Weight of the path to the node.
    weight: i32,
    /// The ray is in a body.
    inside: bool,
    level: u32,
}

impl<A: Arithmetic> Twin<A> {
    /// The colour that a camera ray sees. `branches` is room for nodes, empty before and after, that calls may share.
    ///
    /// # Errors
    /// A ray that visits more packets than there are.
    pub fn ray_tree(&self, ray: TwinRay, first: Option<Packet>, branches: &mut Vec<Branch>) -> Result<Vector, Stuck> {
        let mut colour = [0; 3];
        branches.clear();
        let weight = 1 << self.constants.formats.weight;
        branches.push(Branch { ray, packet: first, weight, inside: false, level: 0 });
        // The last one pushed is visited first, so at most one sibling a level waits here.
        while let Some(branch) = branches.pop() {
            let Some(surface) = self.contribution(&branch, &mut colour)? else { continue };
            if self.features.has_tree() && branch.level < self.features.bounces {
                self.grow(&branch, &surface, branches);
            }
        }
        Ok(colour)
    }

    /// Follows the ray of a node and adds what it sees, times the weight of the path, to the pixel. The surface that it meets.
    fn contribution(&self, branch: &Branch, colour: &mut Vector) -> Result<Option<Surface>, Stuck> {
        let mut search = TwinSearch { t: self.constants.never, triangle: None, takes_any: false };
        if let Some(packet) = &branch.packet {
            self.trace(&branch.ray, packet.clone(), &mut search)?;
        }
        let surface = search.triangle.map(|index| self.surface(&branch.ray, search.t, index));
        let local = match &surface {
            Some(surface) => self.shade(surface)?,
            None => self.background,
        };
        // Two roundings, as in the kernel: the product, then the sum.
        let weighted = self.arithmetic.scaled(local, branch.weight, self.constants.formats.weight);
        *colour = self.arithmetic.sum(*colour, weighted);
        Ok(surface)
    }

    /// Adds the children of a node; the reflected one, which is visited first, as the last.
    fn grow(&self, branch: &Branch, surface: &Surface, branches: &mut Vec<Branch>) {
        let (arithmetic, constants) = (&self.arithmetic, &self.constants);
        let mut child = |weight: i32, origin: Vector, inside: bool, direction: Vector| {
            // A ray that cannot change a component of the pixel is not followed.
            if weight > self.features.cutoff {
                let ray = TwinRay::new(arithmetic, origin, direction);
                let packet = self.own_packet(&ray);
                branches.push(Branch { ray, packet, weight, inside, level: branch.level + 1 });
            }
        };
        // Total reflection adds its weight to the reflected ray, so the refracted one is decided first and visited last.
        let (total, refracted) = self.transmitted(surface, branch.weight, branch.inside);
        if let Some((weight, direction)) = refracted {
            child(weight, surface.behind, !branch.inside, direction);
        }
        let weight = reflects(arithmetic, constants, surface, branch.weight, total);
        child(weight, surface.point, branch.inside, self.reflected(surface));
    }

    /// Fate of the light that a surface lets through: the weight that total reflection adds to the reflected ray, and the weight and
    /// direction of the refracted one.
    fn transmitted(&self, surface: &Surface, weight: i32, inside: bool) -> (i32, Option<(i32, Vector)>) {
        let (arithmetic, constants) = (&self.arithmetic, &self.constants);
        match self.profile.formulas() {
            Formulas::Printed => report::transmitted(arithmetic, constants, surface, weight, inside),
            Formulas::Vector => match refracts(arithmetic, constants, surface, weight, inside) {
                Refraction::Opaque => (0, None),
                Refraction::Total(weight) => (weight, None),
                Refraction::Through { weight, k, eta } => {
                    (0, Some((weight, refract(arithmetic, constants, surface, k, eta))))
                }
            },
        }
    }

    /// The direction of the reflected ray.
    fn reflected(&self, surface: &Surface) -> Vector {
        let reflect = match self.profile.formulas() {
            Formulas::Printed => report::reflect,
            Formulas::Vector => reflect,
        };
        reflect(&self.arithmetic, &self.constants, surface)
    }
}
