//! Two mirrors that nearly face each other, with coloured solids between: each sees itself in the other, five deep.

use super::Sizes;
use super::frame::{Frame, between};
use super::mesh::MeshBuilder;
use crate::model::{Scene, Vec3};

/// Mirrors, floor and back wall open towards the viewer; `level` splits the sphere's triangles.
pub(super) fn build(sizes: &Sizes) -> Scene {
    let mut mesh = MeshBuilder::new("mirrors", sizes.size);
    let light_tile = mesh.matte([0.90, 0.88, 0.80], 0.66);
    let dark_tile = mesh.matte([0.30, 0.19, 0.15], 0.66);
    let wall = mesh.matte([0.42, 0.56, 0.72], 0.60);
    let silver = mesh.mirror([0.92, 0.95, 0.97], 0.92, 0.03);
    let red = mesh.mirror([0.93, 0.20, 0.16], 0.10, 0.80);
    let yellow = mesh.matte([0.98, 0.80, 0.20], 0.85);
    let blue = mesh.mirror([0.22, 0.40, 0.95], 0.15, 0.75);
    let green = mesh.matte([0.25, 0.75, 0.35], 0.85);

    // The floor rises to the back; the mirrors come together and lean a little, each its own way.
    let floor = [[-3.97, -3.0, 0.0], [4.03, -3.0, 0.0], [0.51, -0.8, -11.0], [-0.47, -0.8, -11.0]];
    let top = [[-4.11, 3.03, 0.0], [4.19, 3.01, 0.0], [0.63, 3.05, -11.0], [-0.55, 3.07, -11.0]];
    let tiles = (12, 12);
    mesh.patch(
        tiles,
        |i, j| bilinear(floor, f64::from(i) / 12.0, f64::from(j) / 12.0),
        |i, j| if (i + j) % 2 == 0 { light_tile } else { dark_tile },
    );
    // A finger's breadth of space keeps mirrors and wall clear of the floor's edge.
    let raise = |p: Vec3| [p[0], p[1] + 0.03, p[2]];
    for (corners, surface) in [
        ([raise(floor[0]), raise(floor[3]), top[3], top[0]], silver),
        ([raise(floor[2]), raise(floor[1]), top[1], top[2]], silver),
    ] {
        let corners = corners.map(|p| mesh.vertex(p));
        mesh.quad(corners, surface);
    }
    let back = [raise(floor[3]), raise(floor[2]), top[2], top[3]].map(|p| mesh.vertex([p[0], p[1], p[2] - 0.03]));
    mesh.quad(back, wall);

    let stand = |x: f64, depth: f64, height: f64| {
        let p = bilinear(floor, x, depth);
        [p[0], p[1] + height, p[2]]
    };
    mesh.sphere(stand(0.41, 0.27, 0.91), 0.85, Frame::rotation(2, 0.1), sizes.level, red);
    let turned = Frame::rotation(1, 0.27).then(Frame::rotation(0, 0.16));
    mesh.block(stand(0.75, 0.19, 0.79), [0.49, 0.53, 0.51], turned, yellow);
    mesh.octahedron(stand(0.19, 0.13, 0.83), 0.67, Frame::rotation(1, 0.37), blue);
    mesh.octahedron(stand(0.57, 0.51, 2.37), 0.77, Frame::rotation(0, 0.21), green);
    mesh.octahedron(stand(0.29, 0.37, 3.63), 0.83, Frame::rotation(2, 0.14), yellow);
    mesh.block(stand(0.70, 0.33, 3.47), [0.51, 0.47, 0.49], turned.then(Frame::rotation(2, 0.41)), red);
    mesh.octahedron(stand(0.49, 0.21, 4.51), 0.57, Frame::rotation(0, 0.17), blue);
    mesh.block(stand(0.41, 0.63, 1.07), [0.27, 0.97, 0.23], Frame::rotation(1, 0.11), blue);
    mesh.light([-0.7, 5.9, 3.1], 0.70);
    mesh.light([1.3, 2.3, 6.7], 0.45);
    mesh.scene
}

/// Point of a quadrilateral: `x` along its first edge, `y` towards the opposite one, both in [0, 1].
fn bilinear([a, b, c, d]: [Vec3; 4], x: f64, y: f64) -> Vec3 {
    between(between(a, b, x), between(d, c, x), y)
}
