//! The Cornell box: a red wall on the left, a green one on the right, a mirror block and a glass block.
//! The room narrows towards its back as a stage set does, so that parallel rays see its walls.

use super::Sizes;
use super::frame::{Frame, add, scale};
use super::mesh::{MaterialNumber, MeshBuilder};
use crate::model::{Scene, Vec3};

/// Half of the opening's width and height.
const OPENING: [f64; 2] = [4.0, 3.0];
/// Size of the back wall against the opening.
const BACK: f64 = 0.58;
/// Distance from the opening to the back wall.
const DEPTH: f64 = 6.0;
/// The point at which the lines from the opening's corners would meet: a little above the middle.
const VANISHING: [f64; 2] = [0.03, 0.22];

/// The room, its blocks and two lights under the ceiling; `level` is the number of tiles along each edge of a wall.
pub(super) fn build(sizes: &Sizes) -> Scene {
    let mut mesh = MeshBuilder::new("cornell", sizes.size);
    let white = mesh.matte([0.95, 0.93, 0.88], 0.72);
    let grey = mesh.matte([0.55, 0.53, 0.50], 0.72);
    let red = mesh.matte([0.90, 0.13, 0.09], 0.80);
    let green = mesh.matte([0.14, 0.72, 0.18], 0.80);
    let mirror = mesh.mirror([0.85, 0.90, 1.0], 0.82, 0.10);
    let glass = mesh.glass([0.80, 0.95, 1.0], 0.10, 0.04, 1.5);
    let lamp = mesh.matte([1.0, 1.0, 1.0], 1.0);

    let tiles = sizes.level;
    let side = (tiles, tiles);
    let plain = |surface: MaterialNumber| move |_, _| surface;
    let across = |i: u32| 2.0 * f64::from(i) / f64::from(tiles) - 1.0;
    let depth = |j: u32| foreshortened(f64::from(j) / f64::from(tiles));
    // Tile floor, ceiling, left, right and back; on two of them depth runs towards the viewer, so that all tiles turn the same way round
    mesh.patch(side, |i, j| inside(across(i), -1.0, depth(j)), |i, j| if (i + j) % 2 == 0 { white } else { grey });
    mesh.patch(side, |i, j| inside(across(i), 1.0, depth(tiles - j)), plain(white));
    mesh.patch(side, |i, j| inside(-1.0, across(i), depth(tiles - j)), plain(red));
    mesh.patch(side, |i, j| inside(1.0, across(i), depth(j)), plain(green));
    mesh.patch(side, |i, j| inside(across(i), across(j), 1.0), plain(white));

    // Stand the blocks on the floor: the tall one's centre is 1.63 above it and half its height 1.6, so 0.03 keeps their planes apart
    let floor = slope_frame(-1.0);
    let stand = |x: f64, depth: f64, height: f64| add(inside(x, -1.0, depth), scale(floor.0[1], height));
    let tall = floor.then(Frame::rotation(1, 0.31));
    mesh.block(stand(-0.36, 0.62, 1.63), [0.87, 1.6, 0.83], tall, mirror);
    let short = floor.then(Frame::rotation(1, -0.16));
    mesh.block(stand(0.43, 0.36, 0.93), [0.89, 0.9, 0.85], short, glass);

    // The lamp only looks like one: light comes from two points below the ceiling.
    let ceiling = slope_frame(1.0);
    let under = inside(0.0, 1.0, 0.47);
    mesh.block(add(under, [0.0, -0.09, 0.0]), [0.71, 0.03, 0.47], ceiling, lamp);
    mesh.light(add(under, [-0.23, -0.93, 0.31]), 0.72);
    mesh.light(add(inside(0.0, 1.0, 0.05), [0.71, -0.97, 0.0]), 0.38);
    mesh.scene
}

/// Point of the room at `x`, `y` in [-1, 1] of its width and height, `depth` in [0, 1] of its way to the back.
fn inside(x: f64, y: f64, depth: f64) -> Vec3 {
    let size = 1.0 - (1.0 - BACK) * depth;
    let place = |k: usize, at: f64| VANISHING[k] + (at * OPENING[k] - VANISHING[k]) * size;
    [place(0, x), place(1, y), -DEPTH * depth]
}

/// The depth at which a row of equal tiles, drawn in perspective, has its line `at` in [0, 1].
fn foreshortened(at: f64) -> f64 {
    let size = 1.0 / (1.0 + at * (1.0 / BACK - 1.0));
    // Exactly 1 at the back, so that walls share their corners.
    if at == 1.0 { 1.0 } else { (1.0 - size) / (1.0 - BACK) }
}

/// Axes of the floor (`y` = -1) or the ceiling (1): across, into the room, and along the slope.
fn slope_frame(y: f64) -> Frame {
    let (front, back) = (inside(0.0, y, 0.0), inside(0.0, y, 1.0));
    Frame::upright([0.0, y * (back[2] - front[2]), y * (front[1] - back[1])])
}
