//! Rotations for placing objects: exact at right angles, free of sine and cosine, so equal on every machine.
//! Meshes are built in `mesh`; nothing here knows of triangles.

use crate::model::Vec3;

/// Three axes of unit length at right angles, as the columns of a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame(pub [Vec3; 3]);

impl Frame {
    /// The axes x, y and z themselves.
    pub(super) const WORLD: Frame = Frame([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);

    /// Rotation about world axis `axis` (0, 1, 2) by the angle whose half has the tangent `half_tangent`, counter-clockwise
    /// when the axis points at the viewer.
    pub(super) fn rotation(axis: usize, half_tangent: f64) -> Frame {
        let square = half_tangent * half_tangent;
        let (cosine, sine) = ((1.0 - square) / (1.0 + square), 2.0 * half_tangent / (1.0 + square));
        let mut axes = Frame::WORLD.0;
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        axes[next][next] = cosine;
        axes[next][last] = sine;
        axes[last][last] = cosine;
        axes[last][next] = -sine;
        Frame(axes)
    }

    /// A frame whose second axis is `up` (any length but 0); the others are arbitrary but fixed.
    pub(super) fn upright(up: Vec3) -> Frame {
        let y = unit(up);
        let side = if y[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] };
        let z = unit(cross(side, y));
        Frame([cross(y, z), y, z])
    }

    /// The vector with components `v` along these axes, in world components.
    pub(super) fn apply(&self, v: Vec3) -> Vec3 {
        [0, 1, 2].map(|k| self.0[0][k] * v[0] + self.0[1][k] * v[1] + self.0[2][k] * v[2])
    }

    /// `inner` first, then `self`.
    pub(super) fn then(&self, inner: Frame) -> Frame {
        Frame(inner.0.map(|axis| self.apply(axis)))
    }
}

/// Sum.
pub(super) fn add(a: Vec3, b: Vec3) -> Vec3 {
    [0, 1, 2].map(|k| a[k] + b[k])
}

/// Multiple.
pub(super) fn scale(a: Vec3, by: f64) -> Vec3 {
    a.map(|x| x * by)
}

/// Point between `a` (at 0) and `b` (at 1).
pub(super) fn between(a: Vec3, b: Vec3, at: f64) -> Vec3 {
    [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * at)
}

/// Cross product.
pub(super) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The direction with length 1.
pub(super) fn unit(a: Vec3) -> Vec3 {
    let length = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt();
    a.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_is_exact() {
        // tan 45° = 1 is half of a right angle: x goes to y, y to -x.
        let turn = Frame::rotation(2, 1.0);
        assert_eq!(turn.apply([1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
        assert_eq!(turn.apply([0.0, 1.0, 0.0]), [-1.0, 0.0, 0.0]);
    }

    #[test]
    fn an_upright_frame_is_right_handed() {
        for up in [[0.0, 2.0, 0.0], [3.0, 0.0, 0.0], [1.0, -2.0, 0.5]] {
            let Frame([x, y, z]) = Frame::upright(up);
            let error = add(cross(x, y), scale(z, -1.0));
            assert!(error.iter().all(|e| e.abs() < 1e-15), "{up:?}");
        }
    }
}
