//! Decisions of the walk unit on shadows, node by node along the machine's way.

use isa::number::ray::{Children, Descent, Plane, SplitEnd};

use super::decisions::RealRay;
use super::ray::{machine_ray, real_step};
use super::{RealFormulas, RealResult, ShadowEffect, ShadowInput, WalkRoom};
use RealResult::Integer;

/// Octets of a node.
const NODE: u32 = 8;

/// Octets of a note in front of which a walk writes.
const NOTE: u32 = 12;

impl RealFormulas<'_> {
    fn pattern(&self, address: u32) -> Option<i64> {
        self.buffer.get(address).ok().map(i64::from_le_bytes)
    }

    /// Goes the machine's way and asks the shadow at each node; `None` where the walk leaves the buffer, which is a trap.
    fn walk(&mut self, mut node: u32, note: u32, a: &[[ShadowInput; 3]; 2], entry: Plane, block: u32) -> Option<()> {
        let ray = RealRay::new(a);
        // A block is the address of its first node, its octets, and its nodes; the note holds the plane by which the ray leaves.
        let (first, octets) =
            (self.buffer.word(block).ok()? as u32, self.buffer.word(block.wrapping_add(4)).ok()? as u32);
        let mut exit = Plane::from_pattern(self.pattern(note)?);
        let exact = machine_ray(a);
        let mut descent = Descent::new(&exact, entry, exit);
        loop {
            let inside = node.wrapping_sub(first);
            if octets < NODE || inside > octets - NODE {
                return Some(());
            }
            let split = self.pattern(block.wrapping_add(8).wrapping_add(inside))?;
            // A node 0x00001012_00008000 divides axis 2 at 0x8000; its children are at 0x1010 and 0x1018.
            let (plane, left) = (Plane::from_pattern(split), (split >> 32) as u32 & !3);
            let taken = descent.step(plane);
            let is_right = match taken {
                Children::None => return Some(()),
                Children::One { is_right } => is_right,
                Children::Both { is_right_first } => is_right_first,
            };
            let is_both = matches!(taken, Children::Both { .. });
            // Which child comes first is a decision, and whether there are two; the walk goes on as the machine's does.
            self.decide_on(a.iter().flatten(), || {
                let (end, is_right_first) = real_step(&ray, plane, &ray.crossing(entry), &ray.crossing(exit));
                is_both == (end == SplitEnd::Both) && is_right == is_right_first
            });
            if is_both {
                exit = plane;
            }
            let child = if is_right { left.wrapping_add(NODE) } else { left };
            // The machine too follows only trees whose children stand behind their parents, so that the walk ends.
            if child <= node {
                return Some(());
            }
            node = child;
        }
    }
}

impl WalkRoom for RealFormulas<'_> {
    fn rwalk(
        &mut self,
        x: ShadowInput,
        y: ShadowInput,
        a: [[ShadowInput; 3]; 2],
        b: ShadowInput,
        c: u32,
    ) -> (RealResult, RealResult, RealResult) {
        // A walk that traps has decided nothing: then all of this is thrown away.
        let _ = self.walk(x.raw as u32, y.raw as u32, &a, Plane::from_pattern(b.raw), c);
        self.effect = ShadowEffect::Notes((y.raw as u32).wrapping_add(NOTE), self.note_register);
        (Integer, Integer, Integer)
    }
}
