//! Whitted's local term (report 4.3): the light that a surface sends out by itself.

use isa::number::{Arithmetic, Vector};

use super::Twin;
use super::ray::{Stuck, TwinRay, TwinSearch};
use super::report;
use super::stage::StageLight;
use super::surface::Surface;
use super::unit::unit;
use super::vector_arithmetic::VectorArithmetic;
use crate::constants::Constants;
use crate::set::Formulas;

impl<A: Arithmetic> Twin<A> {
    /// colour (ambient + kd sum over visible lights of (N . L) light colour), in the colour format.
    ///
    /// # Errors
    /// A shadow ray that visits more packets than there are.
    pub fn shade(&self, surface: &Surface) -> Result<Vector, Stuck> {
        let (arithmetic, formats) = (&self.arithmetic, &self.constants.formats);
        let mut light = [0; 3];
        for lamp in &self.stage.lights {
            if let Some(cosine) = self.visible(surface, lamp)? {
                light = arithmetic.sum(light, arithmetic.scaled(lamp.colour, cosine, formats.direction));
            }
        }
        let diffuse = arithmetic.scaled(light, surface.material.intensity, formats.weight);
        let all = arithmetic.sum(diffuse, [self.ambient; 3]);
        Ok(arithmetic.products(surface.material.colour, all, formats.weight))
    }

    /// The cosine of the angle between the normal and a light that the surface sees.
    fn visible(&self, surface: &Surface, light: &StageLight) -> Result<Option<i32>, Stuck> {
        let (arithmetic, constants) = (&self.arithmetic, &self.constants);
        let direction_bits = constants.formats.direction;
        let point = light.scale.map(|scale| arithmetic.scaled(surface.point, scale, direction_bits));
        let way = arithmetic.difference(light.position, point.unwrap_or(surface.point));
        let formulas = self.profile.formulas();
        let lit = match formulas {
            Formulas::Printed => report::lit,
            Formulas::Vector => lit,
        };
        let Some((direction, cosine)) = lit(arithmetic, constants, surface.facing, way) else { return Ok(None) };
        let dot = match formulas {
            Formulas::Printed => report::dot,
            Formulas::Vector => A::dot,
        };
        let ray = TwinRay::new(arithmetic, surface.point, direction);
        // Nothing in the box is beyond a light with longer steps.
        let is_far = light.scale.is_some_and(|scale| scale != 1 << direction_bits);
        let distance = if is_far { constants.never } else { dot(arithmetic, direction, way, constants.across()) };
        let mut search = TwinSearch { t: distance, triangle: None, takes_any: true };
        if let Some(packet) = self.own_packet(&ray) {
            self.trace(&ray, packet, &mut search)?;
        }
        Ok(search.triangle.is_none().then_some(cosine))
    }
}

/// Direction and cosine for a surface that faces a light `way` from it: the direction to the light and the cosine of its angle with the normal.
fn lit(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    facing: Vector,
    way: Vector,
) -> Option<(Vector, i32)> {
    if arithmetic.wide_dot(facing, way) <= 0 {
        return None;
    }
    let bits = constants.formats.direction;
    let direction = unit(arithmetic, bits, arithmetic.normalized(way.map(i64::from)));
    Some((direction, arithmetic.dot(facing, direction, bits)))
}
