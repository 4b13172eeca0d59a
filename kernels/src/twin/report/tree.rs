//! The tree of a pixel's rays as the report walks it (5.4, 5.5): a node is a ray that has met a surface.

use isa::number::{Arithmetic, Vector};

use super::surface::{Refraction, reflect, refract};
use super::walk::own_packet;
use crate::twin::Twin;
use crate::twin::lanes::Lanes;
use crate::twin::ray::{Packet, Ray, Search, Stuck};

/// A ray whose search is still to come.
struct Child {
    ray: Ray,
    packet: Option<Packet>,
    weight: i32,
    inside: bool,
    level: u32,
}

impl<A: Arithmetic> Twin<A> {
    /// The colour that a camera ray sees.
    ///
    /// # Errors
    /// A ray that visits more packets than there are.
    pub fn literal_ray_tree(&self, ray: Ray, first: Option<Packet>) -> Result<Vector, Stuck> {
        let (arithmetic, formats) = (&self.arithmetic, &self.constants.formats);
        let mut colour = [0; 3];
        let mut children = vec![Child { ray, packet: first, weight: 1 << formats.weight, inside: false, level: 0 }];
        while let Some(child) = children.pop() {
            let mut search = Search { t: self.constants.never, triangle: None, takes_any: false };
            if let Some(packet) = &child.packet {
                self.trace(&child.ray, packet.clone(), &mut search)?;
            }
            let seen = match search.triangle {
                Some(index) => self.literal_shade(&self.literal_surface(&child.ray, search.t, index))?,
                None => self.background,
            };
            colour = arithmetic.sum(colour, arithmetic.scaled(seen, child.weight, formats.weight));
            if let Some(index) = search.triangle
                && self.features.has_tree()
                && child.level < self.features.bounces
            {
                self.generate(&child, search.t, index, &mut children);
            }
        }
        Ok(colour)
    }

    /// Adds the children of a node; the reflected one, which is followed first, as the last.
    fn generate(&self, node: &Child, t: i32, index: u32, children: &mut Vec<Child>) {
        let (arithmetic, constants, bits) = (&self.arithmetic, &self.constants, self.constants.formats.weight);
        let surface = self.literal_surface(&node.ray, t, index);
        let mut add = |weight: i32, origin: Vector, inside: bool, direction: Vector| {
            let ray = Ray::new(arithmetic, origin, direction);
            let packet = Some(own_packet(&self.stage, &ray));
            children.push(Child { ray, packet, weight, inside, level: node.level + 1 });
        };
        let mut total = 0;
        if surface.material.transmission != 0 {
            let weight = arithmetic.times(node.weight, surface.material.transmission, bits);
            match refract(arithmetic, constants, &surface, node.inside) {
                Refraction::Total => total = weight,
                Refraction::Through(direction) if weight > self.features.cutoff => {
                    add(weight, surface.behind, !node.inside, direction);
                }
                Refraction::Through(_) => {}
            }
        }
        let weight = arithmetic.plus(total, arithmetic.times(surface.material.reflection, node.weight, bits));
        if weight > self.features.cutoff {
            add(weight, surface.point, node.inside, reflect(arithmetic, constants, &surface));
        }
    }
}
