//! The sphereflake: every sphere carries nine of a third of its size. Spheres are tessellated, finer where larger.

use super::Sizes;
use super::frame::{Frame, add, scale};
use super::mesh::{MaterialNumber, MeshBuilder};
use crate::model::{Scene, Vec3};

/// Half of the tangent of the slant at which the ground is seen.
const SLANT: f64 = 0.27;

/// The flake on a checkered ground that fills the picture; `level` is the number of generations after the first sphere.
pub(super) fn build(sizes: &Sizes) -> Scene {
    let mut mesh = MeshBuilder::new("sphereflake", sizes.size);
    let light_tile = mesh.matte([0.88, 0.86, 0.80], 0.85);
    let dark_tile = mesh.matte([0.20, 0.29, 0.43], 0.85);
    let silver = mesh.mirror([0.90, 0.92, 0.96], 0.55, 0.45);
    let red = mesh.mirror([0.92, 0.22, 0.14], 0.12, 0.80);
    let gold = mesh.mirror([1.0, 0.76, 0.26], 0.38, 0.55);
    let glass = mesh.glass([0.72, 0.92, 0.86], 0.14, 0.10, 1.4);
    let blue = mesh.matte([0.20, 0.42, 0.90], 0.85);

    let slant = Frame::rotation(0, SLANT);
    let tiles = (10, 14);
    let at = |i: u32, j: u32| [(f64::from(i) - 5.01) * 0.57, 0.0, (4.37 - f64::from(j)) * 0.57];
    mesh.patch(tiles, |i, j| slant.apply(at(i, j)), |i, j| if (i + j) % 2 == 0 { light_tile } else { dark_tile });

    let flake = Flake { generations: sizes.level, surfaces: [[silver; 3], [red, gold, glass], [blue, silver, gold]] };
    let turned = slant.then(Frame::rotation(1, 0.13));
    flake.grow(&mut mesh, slant.apply([0.05, 1.02, 0.0]), 1.0, turned, 0, 0);
    mesh.light([-3.7, 6.1, 5.3], 0.85);
    mesh.light([4.9, 3.3, 6.7], 0.45);
    mesh.scene
}

/// Settings of all spheres of a flake.
struct Flake {
    generations: u32,
    /// Surfaces by generation (later ones repeat the last) and by kind of place.
    surfaces: [[MaterialNumber; 3]; 3],
}

impl Flake {
    /// A sphere and its descendants; the frame's y axis points away from the parent.
    fn grow(&self, mesh: &mut MeshBuilder, centre: Vec3, radius: f64, frame: Frame, generation: u32, kind: usize) {
        let surface = self.surfaces[(generation as usize).min(2)][kind];
        mesh.sphere(centre, radius, frame, 2_u32.saturating_sub(generation), surface);
        if generation == self.generations {
            return;
        }
        let half = 3.0_f64.sqrt() / 2.0;
        // Six around the waist, three towards the pole, as cosines and sines of multiples of 30 degrees.
        let waist = [(1.0, 0.0), (0.5, half), (-0.5, half), (-1.0, 0.0), (-0.5, -half), (0.5, -half)];
        let crown = [(half, 0.5), (-half, 0.5), (0.0, -1.0)];
        let waist = waist.iter().enumerate().map(|(n, &(x, z))| ([x, 0.0, z], n % 2));
        let crown = crown.iter().map(|&(x, z)| ([x * 0.5, half, z * 0.5], 2));
        for (direction, kind) in waist.chain(crown) {
            let out = frame.apply(direction);
            // Further out than 4/3, where the spheres would touch.
            let child = add(centre, scale(out, radius * 1.36));
            self.grow(mesh, child, radius / 3.0, Frame::upright(out), generation + 1, kind);
        }
    }
}
