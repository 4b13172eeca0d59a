//! Triangles that are hard to hit: up to a million times longer than wide, without area, or twice in the same place.

use super::Sizes;
use super::frame::{Frame, add, scale};
use super::mesh::{MaterialNumber, MeshBuilder};
use crate::model::{Scene, Vec3};

/// Strips of slivers of six widths before a wall, with degenerate and duplicate triangles; `level` is the number of
/// slivers of each width.
pub(super) fn build(sizes: &Sizes) -> Scene {
    let mut mesh = MeshBuilder::new("slivers", sizes.size);
    let wall = mesh.matte([0.62, 0.66, 0.74], 0.70);
    let colours =
        [[0.9, 0.3, 0.2], [0.9, 0.6, 0.2], [0.9, 0.9, 0.3], [0.3, 0.8, 0.3], [0.3, 0.7, 0.9], [0.8, 0.4, 0.8]];
    let colours = colours.map(|colour| mesh.matte(colour, 0.85));
    let mirror = mesh.mirror([0.9, 0.9, 1.0], 0.6, 0.3);
    let corners =
        [[-4.03, -3.01, -2.0], [4.01, -3.03, -2.0], [4.02, 3.0, -2.3], [-4.0, 3.02, -2.3]].map(|p| mesh.vertex(p));
    mesh.quad(corners, wall);

    // Six bands; a sliver of band k is 5 long and 5 / 10^k wide and shares its edges with its neighbours. The first two
    // bands are full before they have as many as the others.
    let turn = Frame::rotation(2, 0.06).then(Frame::rotation(0, 0.13));
    let (mut aspect, mut full) = (10.0, 2);
    for (band, &surface) in colours.iter().enumerate() {
        let along = scale(turn.0[0], 5.0);
        let across = scale(turn.0[1], 5.0 / aspect);
        let start = turn.apply([-2.87, -2.59 + 0.83 * band as f64, 0.3]);
        strip(&mut mesh, start, along, across, sizes.level.min(full), surface);
        aspect *= 10.0;
        full = if band == 0 { 24 } else { u32::MAX };
    }

    // A needle: a closed box a thousand times longer than wide.
    let needle = Frame::rotation(2, 0.31).then(Frame::rotation(1, 0.17));
    mesh.block([0.13, 0.21, 1.1], [3.1, 0.0031, 0.0031], needle, mirror);

    // Without area: three corners on a line, two corners alike, all alike.
    let line: Vec<u32> = [-1.0, 0.25, 1.5].iter().map(|&x| mesh.vertex([x, 0.5 * x, 0.9])).collect();
    mesh.triangle([line[0], line[1], line[2]], colours[0]);
    mesh.triangle([line[0], line[2], line[2]], colours[1]);
    mesh.triangle([line[1], line[1], line[1]], colours[2]);

    // Twice in the same place, once turned over, with other colours: the lowest number is seen.
    let patch = [[2.1, -2.3, 0.5], [3.3, -2.1, 0.4], [2.7, -1.2, 0.6]].map(|p| mesh.vertex(p));
    mesh.triangle(patch, colours[4]);
    mesh.triangle(patch, colours[0]);
    mesh.triangle([patch[0], patch[2], patch[1]], colours[3]);
    mesh.light([-2.9, 4.7, 6.3], 0.8);
    mesh.light([4.1, 1.9, 5.9], 0.4);
    mesh.scene
}

/// A strip of `count` slivers, each as long as `along` and as wide as `across`, points alternating.
fn strip(mesh: &mut MeshBuilder, start: Vec3, along: Vec3, across: Vec3, count: u32, surface: MaterialNumber) {
    let corner = |n: u32| {
        let side = scale(across, f64::from(n / 2) + 0.5 * f64::from(n % 2));
        let p = add(start, side);
        if n.is_multiple_of(2) { p } else { add(p, along) }
    };
    let first = mesh.vertex(corner(0));
    mesh.vertex(corner(1));
    for n in 2..count + 2 {
        let last = mesh.vertex(corner(n));
        debug_assert_eq!(last, first + n, "corners are numbered in order");
        let turned = if n % 2 == 0 { [last - 2, last - 1, last] } else { [last - 1, last - 2, last] };
        mesh.triangle(turned, surface);
    }
}
