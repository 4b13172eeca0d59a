//! Whitted's local term (report 4.3) with N . L of a unit vector to each light.

use isa::number::{Arithmetic, Vector};

use super::scalar::dot;
use super::surface::unit;
use super::walk::own_packet;
use crate::twin::Twin;
use crate::twin::lanes::Lanes;
use crate::twin::ray::{Ray, Search, Stuck};
use crate::twin::stage::Light;
use crate::twin::surface::Surface;

impl<A: Arithmetic> Twin<A> {
    /// colour (ambient + kd sum over visible lights of (N . L) light colour), in the colour format.
    pub(super) fn literal_shade(&self, surface: &Surface) -> Result<Vector, Stuck> {
        let (arithmetic, formats) = (&self.arithmetic, &self.constants.formats);
        let mut light = [0; 3];
        for lamp in &self.stage.lights {
            if let Some(cosine) = self.literal_cosine(surface, lamp)? {
                light = arithmetic.sum(light, arithmetic.scaled(lamp.colour, cosine, formats.direction));
            }
        }
        let diffuse = arithmetic.scaled(light, surface.material.intensity, formats.weight);
        let all = arithmetic.sum(diffuse, [self.ambient; 3]);
        Ok(arithmetic.products(surface.material.colour, all, formats.weight))
    }

    /// The cosine of the angle between the normal and a light that the surface sees.
    fn literal_cosine(&self, surface: &Surface, light: &Light) -> Result<Option<i32>, Stuck> {
        let (arithmetic, constants) = (&self.arithmetic, &self.constants);
        let bits = constants.formats.direction;
        let way = arithmetic.difference(light.position, surface.point);
        let direction = unit(arithmetic, bits, arithmetic.normalized(way.map(i64::from)));
        let cosine = dot(arithmetic, surface.facing, direction, bits);
        if cosine <= 0 {
            return Ok(None);
        }
        let ray = Ray::new(arithmetic, surface.point, direction);
        let distance = dot(arithmetic, direction, way, constants.across());
        let mut search = Search { t: distance, triangle: None, takes_any: true };
        self.trace(&ray, own_packet(&self.stage, &ray), &mut search)?;
        Ok(search.triangle.is_none().then_some(cosine))
    }
}
