//! From packet to packet along a ray, to its nearest hit or to any hit (report, pseudo codes 2 and 3).

use isa::number::{Arithmetic, Vector};

use super::Twin;
use super::descend::{descend, own_packet};
use super::exact_triangle::exact_triangle;
use super::exit_face::exit_face;
use super::first_packet::first_packet;
use super::ray::{Packet, Stuck, TwinRay, TwinSearch};
use super::report;
use super::triangle::triangle as wide_triangle;
use super::vector_arithmetic::VectorArithmetic;
use crate::constants::Constants;
use crate::set::Decisions;

/// The distance at which a ray hits a triangle, or [`Constants::missed`], by decisions of some exactness.
pub(super) fn triangle(
    arithmetic: &impl VectorArithmetic,
    decisions: Decisions,
    constants: &Constants,
    ray: &TwinRay,
    vertices: &[Vector; 3],
) -> i32 {
    match decisions {
        Decisions::Rounded => report::triangle(arithmetic, constants, ray, vertices),
        Decisions::Wide => wide_triangle(arithmetic, constants, ray, vertices),
        Decisions::Exact => exact_triangle(arithmetic, constants, ray, vertices),
    }
}

impl<A: Arithmetic> Twin<A> {
    /// Follows a ray from its first packet until the search is over.
    ///
    /// # Errors
    /// A ray that visits more packets than there are.
    pub fn trace(&self, ray: &TwinRay, first: Packet, search: &mut TwinSearch) -> Result<(), Stuck> {
        let mut packet = first;
        for _ in 0..self.constants.most_steps {
            self.packet(ray, &packet, search);
            match self.next_packet(ray, &packet, search) {
                Some(next) => packet = next,
                None => return Ok(()),
            }
        }
        Err(Stuck)
    }

    /// The packet in which a secondary ray starts. Its origin is moved off a surface, so it may lie outside the scene's box: only the
    /// profile `ray` looks.
    pub fn own_packet(&self, ray: &TwinRay) -> Option<Packet> {
        match self.profile.decisions() {
            Decisions::Rounded => Some(report::own_packet(&self.stage, ray)),
            Decisions::Wide => Some(own_packet(&self.arithmetic, &self.stage, ray)),
            Decisions::Exact => first_packet(&self.arithmetic, &self.stage, ray),
        }
    }

    /// The distance at which a ray hits a triangle, or [`crate::constants::Constants::missed`].
    pub fn triangle(&self, ray: &TwinRay, vertices: &[Vector; 3]) -> i32 {
        triangle(&self.arithmetic, self.profile.decisions(), &self.constants, ray, vertices)
    }

    /// Tests the triangles of a packet. The nearest hit has the smallest t, then the lowest index; the profile `report` tests all and
    /// keeps the first of equal hits.
    pub fn packet(&self, ray: &TwinRay, packet: &Packet, search: &mut TwinSearch) {
        let is_literal = self.profile.decisions() == Decisions::Rounded;
        for &index in &self.stage.references[packet.references.start as usize..packet.references.end as usize] {
            let vertices = &self.stage.triangles[index as usize].vertices;
            let t = self.triangle(ray, vertices);
            let has_lower_index = || !is_literal && search.triangle.is_some_and(|nearest| index < nearest);
            if t < search.t || t == search.t && has_lower_index() {
                (search.t, search.triangle) = (t, Some(index));
                // A shadow ray asks only for something in the way; the report's loop tests all triangles whatever it has found.
                if search.takes_any && !is_literal {
                    return;
                }
            }
        }
    }

    /// The packet after the current one; `None` when the search is over: the ray leaves the scene, any hit will do and there is one, or
    /// the nearest hit is surely nearer than the exit, (t + 1 ulp) |D_k| < run_k.
    pub fn next_packet(&self, ray: &TwinRay, packet: &Packet, search: &TwinSearch) -> Option<Packet> {
        if search.takes_any && search.triangle.is_some() {
            return None;
        }
        if self.profile.decisions() == Decisions::Rounded {
            return report::next_packet(&self.arithmetic, &self.constants, &self.stage, ray, packet, search);
        }
        let exit = exit_face(&self.arithmetic, ray, &packet.bounds);
        if search.takes_any || search.triangle.is_some() {
            // (t + 1) |D_k| < run_k: one unit more, since t may have been rounded down across the plane.
            let slope = i128::from(exit.slope);
            let reached = self.arithmetic.widen(slope + i128::from(search.t) * slope, 0);
            let end = self.arithmetic.widen(i128::from(exit.run) << self.constants.along(), 0);
            if reached < end {
                return None;
            }
        }
        // An exit plane on the scene's box is where the ray leaves the scene.
        let outer = if ray.is_backwards(exit.axis) { &self.stage.bounds.low } else { &self.stage.bounds.high };
        (outer[exit.axis] != exit.plane).then(|| descend(&self.arithmetic, &self.stage, ray, &exit))
    }
}
