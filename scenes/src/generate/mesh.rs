//! A scene under construction: materials, lights and the solids that the generated scenes are made of.
//! All solids are closed, their faces counter-clockwise seen from outside.

use std::collections::HashMap;

use super::frame::{Frame, add, cross, scale, unit};
use crate::model::{Light, Material, Scene, Triangle, Vec3};

/// A scene that grows.
pub(super) struct MeshBuilder {
    /// The scene so far.
    pub scene: Scene,
}

/// A material by number, as [`MeshBuilder`] hands it out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MaterialNumber(pub u32);

impl MeshBuilder {
    /// An empty scene.
    pub(super) fn new(name: &str, size: (u32, u32)) -> MeshBuilder {
        MeshBuilder {
            scene: Scene {
                name: name.to_string(),
                size,
                materials: Vec::new(),
                lights: Vec::new(),
                vertices: Vec::new(),
                triangles: Vec::new(),
            },
        }
    }

    fn material(&mut self, material: Material) -> MaterialNumber {
        self.scene.materials.push(material);
        MaterialNumber(self.scene.materials.len() as u32 - 1)
    }

    /// A surface that scatters the share `intensity` of the light.
    pub(super) fn matte(&mut self, colour: Vec3, intensity: f64) -> MaterialNumber {
        self.material(Material { colour, reflection: 0.0, intensity, index: 0.0 })
    }

    /// A surface that reflects the share `reflection`, and scatters a little where `intensity` is not 0.
    pub(super) fn mirror(&mut self, colour: Vec3, reflection: f64, intensity: f64) -> MaterialNumber {
        self.material(Material { colour, reflection, intensity, index: 0.0 })
    }

    /// A transparent surface: what is neither reflected nor scattered passes.
    pub(super) fn glass(&mut self, colour: Vec3, reflection: f64, intensity: f64, index: f64) -> MaterialNumber {
        self.material(Material { colour, reflection, intensity, index })
    }

    /// A white light of strength `strength`.
    pub(super) fn light(&mut self, position: Vec3, strength: f64) {
        self.scene.lights.push(Light { position, colour: [strength; 3] });
    }

    /// A vertex.
    pub(super) fn vertex(&mut self, position: Vec3) -> u32 {
        self.scene.vertices.push(position);
        self.scene.vertices.len() as u32 - 1
    }

    /// A triangle of known vertices.
    pub(super) fn triangle(&mut self, vertices: [u32; 3], surface: MaterialNumber) {
        self.scene.triangles.push(Triangle { vertices, material: surface.0 });
    }

    /// A plane quadrilateral as two triangles; the corners go round.
    pub(super) fn quad(&mut self, [a, b, c, d]: [u32; 4], surface: MaterialNumber) {
        self.triangle([a, b, c], surface);
        self.triangle([a, c, d], surface);
    }

    /// A patch of `columns` x `rows` quadrilaterals with shared vertices: `point(i, j)` gives the corners,
    /// `surface(i, j)` the material of the quadrilateral between corners (i, j) and (i+1, j+1).
    pub(super) fn patch(
        &mut self,
        (columns, rows): (u32, u32),
        point: impl Fn(u32, u32) -> Vec3,
        surface: impl Fn(u32, u32) -> MaterialNumber,
    ) {
        let first = self.scene.vertices.len() as u32;
        for j in 0..=rows {
            for i in 0..=columns {
                self.vertex(point(i, j));
            }
        }
        let at = |i, j| first + j * (columns + 1) + i;
        for j in 0..rows {
            for i in 0..columns {
                self.quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], surface(i, j));
            }
        }
    }

    /// A box with half edges `half` along the axes of `frame`.
    pub(super) fn block(&mut self, centre: Vec3, half: Vec3, frame: Frame, surface: MaterialNumber) {
        let corners: Vec<u32> = (0..8)
            .map(|n| {
                let local = [0, 1, 2].map(|k| if n >> k & 1 == 1 { half[k] } else { -half[k] });
                self.vertex(add(centre, frame.apply(local)))
            })
            .collect();
        for face in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
            self.quad(face.map(|n| corners[n]), surface);
        }
    }

    /// A regular octahedron with the given distance from centre to corner.
    pub(super) fn octahedron(&mut self, centre: Vec3, radius: f64, frame: Frame, surface: MaterialNumber) {
        let corners: Vec<u32> = (0..6)
            .map(|n| {
                let mut local = [0.0; 3];
                local[n / 2] = if n % 2 == 0 { radius } else { -radius };
                self.vertex(add(centre, frame.apply(local)))
            })
            .collect();
        for (x, y, z) in [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)] {
            self.triangle([corners[x], corners[y], corners[z]], surface);
        }
    }

    /// A sphere as an icosahedron whose triangles are split in four `splits` times: 20 * 4^splits triangles, all
    /// vertices at distance `radius`.
    pub(super) fn sphere(&mut self, centre: Vec3, radius: f64, frame: Frame, splits: u32, surface: MaterialNumber) {
        let (mut directions, mut faces) = icosahedron();
        for _ in 0..splits {
            let mut middles = HashMap::new();
            let mut finer = Vec::with_capacity(faces.len() * 4);
            for [a, b, c] in faces {
                let mut middle = |a: usize, b: usize| {
                    *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                        directions.push(unit(add(directions[a], directions[b])));
                        directions.len() - 1
                    })
                };
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
            }
            faces = finer;
        }
        let first = self.scene.vertices.len() as u32;
        for direction in directions {
            self.vertex(add(centre, scale(frame.apply(direction), radius)));
        }
        for face in faces {
            self.triangle(face.map(|n| first + n as u32), surface);
        }
    }
}

/// Twelve directions of length 1 and twenty faces.
fn icosahedron() -> (Vec<Vec3>, Vec<[usize; 3]>) {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut corners = Vec::with_capacity(12);
    for axis in 0..3 {
        for (one, two) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
            let mut corner = [0.0; 3];
            corner[axis] = one;
            corner[(axis + 1) % 3] = two;
            corners.push(corner);
        }
    }
    // Neighbours are 2 apart: every three mutual neighbours are a face.
    let is_edge = |a: Vec3, b: Vec3| [0, 1, 2].map(|k| (a[k] - b[k]) * (a[k] - b[k])).iter().sum::<f64>() < 4.5;
    let mut faces = Vec::with_capacity(20);
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let (p, q, r) = (corners[a], corners[b], corners[c]);
                if is_edge(p, q) && is_edge(q, r) && is_edge(r, p) {
                    let outward = cross(add(q, scale(p, -1.0)), add(r, scale(p, -1.0)));
                    let is_out = outward[0] * p[0] + outward[1] * p[1] + outward[2] * p[2] > 0.0;
                    faces.push(if is_out { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    (corners.into_iter().map(unit).collect(), faces)
}
