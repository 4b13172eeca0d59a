//! Parallel slabs of glass, tilted, in front of a coloured checkerboard: refraction shifts the squares, and light
//! that meets a slab's narrow sides from within is totally reflected.

use super::Sizes;
use super::frame::Frame;
use super::mesh::MeshBuilder;
use crate::model::Scene;

/// The board fills the picture; `level` is the number of squares along its width.
pub(super) fn build(sizes: &Sizes) -> Scene {
    let mut mesh = MeshBuilder::new("slabs", sizes.size);
    let white = mesh.matte([0.96, 0.94, 0.90], 0.66);
    let squares = [[0.90, 0.32, 0.18], [0.15, 0.42, 0.82], [0.95, 0.74, 0.16], [0.18, 0.60, 0.34], [0.20, 0.20, 0.26]];
    let squares = squares.map(|colour| mesh.matte(colour, 0.66));
    let columns = sizes.level;
    let rows = (columns * 3).div_ceil(4);
    let edge = 8.0 / f64::from(columns);
    mesh.patch(
        (columns, rows),
        |i, j| [(f64::from(i) * edge) - 4.013, f64::from(j) * edge - 3.009, -3.0],
        |i, j| if (i + j) % 2 == 0 { white } else { squares[((i + 3 * j) / 2 % 5) as usize] },
    );
    let tilt = Frame::rotation(1, 0.31).then(Frame::rotation(0, 0.11));
    let slabs = [
        ([-2.53, 0.17, 0.0], [0.78, 2.3, 0.21], 1.3),
        ([-0.93, -0.31, 0.4], [0.72, 2.1, 0.33], 1.5),
        ([0.87, 0.23, 0.1], [0.81, 2.4, 0.27], 1.5),
        ([2.61, -0.19, -0.1], [0.69, 2.2, 0.47], 1.8),
    ];
    for (centre, half, index) in slabs {
        let glass = mesh.glass([0.75, 0.92, 0.88], 0.09, 0.05, index);
        mesh.block(centre, half, tilt, glass);
    }
    // A low bar before the others, so that some rays cross two slabs.
    let amber = mesh.glass([1.0, 0.72, 0.30], 0.08, 0.08, 1.4);
    mesh.block([0.11, -1.57, 2.4], [3.1, 0.37, 0.19], tilt.then(Frame::rotation(2, 0.04)), amber);
    // Between slabs and board, so that the slabs do not darken it.
    mesh.light([-2.9, 1.9, -1.3], 0.62);
    mesh.light([2.7, -2.1, -1.4], 0.55);
    mesh.light([-1.7, 3.9, 6.3], 0.50);
    mesh.scene
}
