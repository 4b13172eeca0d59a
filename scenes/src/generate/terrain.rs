//! A landscape over a grid: fractal value noise from an integer hash, coloured by height and slope, and tilted so that
//! parallel rays see near and far.

use super::Sizes;
use super::frame::{Frame, cross, unit};
use super::mesh::MeshBuilder;
use crate::model::{Scene, Vec3};

/// Width of the landscape in scene units.
const WIDTH: f64 = 8.0;
/// Half of the tangent of the angle between the ground and the line of sight's level: the rotation by 12/13, 5/13.
const SLANT: f64 = 0.2;
/// Height of the lake.
const LAKE: f64 = 0.20;

/// A landscape of exactly `triangles` triangles.
pub(super) fn build(sizes: &Sizes) -> Scene {
    let mut mesh = MeshBuilder::new("terrain", sizes.size);
    let water = mesh.matte([0.15, 0.34, 0.62], 0.80);
    let sand = mesh.matte([0.82, 0.72, 0.50], 0.80);
    let grass = mesh.matte([0.27, 0.52, 0.18], 0.80);
    let forest = mesh.matte([0.13, 0.35, 0.14], 0.80);
    let rock = mesh.matte([0.47, 0.42, 0.38], 0.80);
    let snow = mesh.matte([0.96, 0.97, 1.0], 0.85);

    let columns = columns(sizes.triangles);
    let quads = sizes.triangles.div_ceil(2);
    let rows = quads.div_ceil(columns);
    let edge = WIDTH / f64::from(columns);
    let slant = Frame::rotation(0, SLANT);
    let ground: Vec<Vec3> = (0..=rows)
        .flat_map(|j| (0..=columns).map(move |i| (i, j)))
        .map(|(i, j)| {
            let (x, z) = (f64::from(i) * edge - 0.503 * WIDTH, -f64::from(j) * edge);
            [x, height(x, z).max(LAKE), z]
        })
        .collect();
    mesh.scene.vertices = ground.iter().map(|&p| slant.apply(p)).collect();
    for quad in 0..quads {
        let corner = quad / columns * (columns + 1) + quad % columns;
        let [a, b, c, d] = [corner, corner + 1, corner + columns + 2, corner + columns + 1];
        // Alternating diagonals leave no preferred direction.
        let is_even = (quad / columns + quad % columns).is_multiple_of(2);
        let halves = if is_even { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        for (n, half) in (0..).zip(halves) {
            if quad * 2 + n < sizes.triangles {
                let [p, q, r] = half.map(|n| ground[n as usize]);
                let normal = unit(cross([0, 1, 2].map(|k| q[k] - p[k]), [0, 1, 2].map(|k| r[k] - p[k])));
                let middle = (p[1] + q[1] + r[1]) / 3.0;
                let surface = match middle {
                    _ if p[1] == LAKE && q[1] == LAKE && r[1] == LAKE => water,
                    _ if middle < LAKE + 0.02 => sand,
                    _ if normal[1] < 0.66 => rock,
                    _ if middle > 0.66 => snow,
                    _ if normal[1] < 0.80 || middle > 0.58 => rock,
                    _ if middle > 0.36 => forest,
                    _ => grass,
                };
                mesh.triangle(half, surface);
            }
        }
    }
    mesh.light([-9.0, 11.0, 3.0], 0.95);
    mesh.scene
}

/// Number of columns: near three quarters of the rows, and without a ragged last row where the number allows.
fn columns(triangles: u32) -> u32 {
    let quads = triangles.div_ceil(2);
    let wanted = (quads * 3 / 4).isqrt().max(1);
    (0..=wanted / 4)
        .flat_map(|off| [wanted - off, wanted + off])
        .find(|&columns| quads.is_multiple_of(columns))
        .unwrap_or(wanted)
}

/// Height of the ground over a point: sharp ridges over soft hills.
fn height(x: f64, z: f64) -> f64 {
    let hills = fractal(x * 0.55 + 3.7, z * 0.55 + 11.3, 6, 1);
    let ridge = 1.0 - (2.0 * fractal(x * 0.42 + 7.1, z * 0.42 - 2.9, 4, 2) - 1.0).abs();
    let rise = 0.30 + 0.70 * (-z / WIDTH).clamp(0.0, 1.0);
    rise * (0.45 * hills + 1.15 * ridge * ridge * ridge * hills)
}

/// Sum of octaves of noise, each twice as fine and half as high, in [0, 1].
fn fractal(x: f64, z: f64, octaves: u32, seed: u32) -> f64 {
    let (mut sum, mut weight, mut scale, mut total) = (0.0, 1.0, 1.0, 0.0);
    for octave in 0..octaves {
        sum += weight * noise(x * scale, z * scale, seed * 101 + octave);
        total += weight;
        weight *= 0.43;
        scale *= 2.0;
    }
    sum / total
}

/// Values at whole points, joined smoothly (fifth degree, so that slopes have no seams), in [0, 1).
fn noise(x: f64, z: f64, seed: u32) -> f64 {
    let (x0, z0) = (x.floor(), z.floor());
    let smooth = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (u, v) = (smooth(x - x0), smooth(z - z0));
    let value = |dx: i32, dz: i32| hash(x0 as i32 + dx, z0 as i32 + dz, seed);
    let near = value(0, 0) + (value(1, 0) - value(0, 0)) * u;
    let far = value(0, 1) + (value(1, 1) - value(0, 1)) * u;
    near + (far - near) * v
}

/// A fixed value in [0, 1) for each whole point.
fn hash(x: i32, z: i32, seed: u32) -> f64 {
    let mut bits =
        (x as u32).wrapping_mul(0x9E37_79B1) ^ (z as u32).wrapping_mul(0x85EB_CA77) ^ seed.wrapping_mul(0xC2B2_AE3D);
    for _ in 0..2 {
        bits = (bits ^ (bits >> 15)).wrapping_mul(0x2C1B_3C6D);
        bits = (bits ^ (bits >> 12)).wrapping_mul(0x297A_2D39);
        bits ^= bits >> 15;
    }
    f64::from(bits) / 4_294_967_296.0
}
