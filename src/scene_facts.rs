//! What is known about a scene before it is drawn: its parts, its tree, its octets in memory, and what the grid costs.

use isa::diagnostic::Report;
use scenes::image::{self, Image, Options};
use scenes::kdtree::Statistics;
use scenes::model::{Scene, Vec3, View};
use serde::Serialize;

use crate::job::result_name;
use crate::result::{Formats, Kinds};

/// Version of [`SceneFacts`].
pub const SCHEMA: &str = "lancer-scene-1";

/// The facts of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct SceneFacts {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// Name of the scene.
    pub scene: String,
    /// Width of its picture in pixels.
    pub width: u32,
    /// Height of its picture in pixels.
    pub height: u32,
    /// Triangles.
    pub triangles: usize,
    /// Vertices.
    pub vertices: usize,
    /// Vertices that no triangle has.
    pub unused_vertices: usize,
    /// Smallest and largest corner of the triangles' box, in scene units; null without triangles.
    pub bounds: Option<[Vec3; 2]>,
    /// Materials in the order of their numbers.
    pub materials: Vec<MaterialFacts>,
    /// Lights.
    pub lights: usize,
    /// Whether a triangle's material reflects.
    pub has_mirror: bool,
    /// Whether a triangle's material is transparent.
    pub has_glass: bool,
    /// The kd tree.
    pub tree: Statistics,
    /// Structures of global memory.
    pub memory: Memory,
    /// Bits of a word and fraction bits of each quantity.
    pub formats: Formats,
    /// What the grid costs.
    pub precision: Precision,
}

/// A material and how many triangles have it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct MaterialFacts {
    /// Diffuse colour.
    pub colour: Vec3,
    /// Specular coefficient ks.
    pub reflection: f64,
    /// Diffuse coefficient kd.
    pub intensity: f64,
    /// Transmission coefficient kt.
    pub transmission: f64,
    /// Index of refraction, 0 for an opaque material.
    pub index: f64,
    /// Triangles that have it.
    pub triangles: usize,
}

/// Octets of global memory.
#[derive(Clone, Debug, Serialize)]
pub struct Memory {
    /// Name of the layout.
    pub layout: &'static str,
    /// Octets by structure.
    pub octets: Kinds,
    /// All octets, gaps between the structures included.
    pub total: usize,
}

/// How far vertices move when they are stored.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Precision {
    /// Distance of neighbouring stored coordinates, in scene units.
    pub step: f64,
    /// Longest side of the scene's box in such steps.
    pub steps: u64,
    /// Largest distance between a triangle's corner and where it is stored, in scene units.
    pub largest_move: f64,
    /// Root of the mean square of these distances, in scene units.
    pub rms_move: f64,
    /// Triangles without area, before they are stored.
    pub degenerate: usize,
    /// Triangles that lose their area when they are stored; rays never hit them.
    pub collapsed: usize,
}

impl SceneFacts {
    /// The facts of a scene in memory.
    ///
    /// # Errors
    /// What [`image::build`] refuses.
    pub fn new(scene: &Scene, options: &Options) -> Result<SceneFacts, Report> {
        let image = image::build(scene, &View::new(scene.size), options)?;
        let mut uses = vec![0; scene.materials.len()];
        let mut is_used = vec![false; scene.vertices.len()];
        for triangle in &scene.triangles {
            uses[triangle.material as usize] += 1;
            triangle.vertices.iter().for_each(|&vertex| is_used[vertex as usize] = true);
        }
        let materials: Vec<MaterialFacts> = (scene.materials.iter().zip(&uses))
            .map(|(material, &triangles)| MaterialFacts {
                colour: material.colour,
                reflection: material.reflection,
                intensity: material.intensity,
                transmission: material.transmission(),
                index: material.index,
                triangles,
            })
            .collect();
        let has = |test: &dyn Fn(&MaterialFacts) -> bool| materials.iter().any(|m| m.triangles != 0 && test(m));
        let octets = image.regions.iter().map(|(kind, range)| (kind.name().to_owned(), range.len() as u64));
        let formats = &image.formats;
        Ok(SceneFacts {
            schema: SCHEMA,
            scene: result_name(scene),
            width: scene.size.0,
            height: scene.size.1,
            triangles: scene.triangles.len(),
            vertices: scene.vertices.len(),
            unused_vertices: is_used.iter().filter(|is_used| !**is_used).count(),
            bounds: scene.bounds().map(|(low, high)| [low, high]),
            lights: scene.lights.len(),
            has_mirror: has(&|material| material.reflection > 0.0),
            has_glass: has(&|material| material.transmission > 0.0),
            materials,
            tree: image.tree.statistics(),
            memory: Memory { layout: image.layout.name(), octets: Kinds(octets.collect()), total: image.bytes.len() },
            formats: Formats(std::iter::once(("word", formats.word as i32)).chain(formats.entries()).collect()),
            precision: Precision::new(scene, &image),
        })
    }
}

impl Precision {
    fn new(scene: &Scene, image: &Image) -> Precision {
        let shift = image.layout.coordinate_shift(image.formats.word);
        let inner = image.grid.bounds();
        let longest = [0, 1, 2].map(|axis| inner.side(axis)).into_iter().max().unwrap_or(0);
        let (mut largest, mut sum) = (0.0f64, 0.0);
        let (mut degenerate, mut collapsed) = (0, 0);
        for (number, triangle) in scene.triangles.iter().enumerate() {
            let corners = triangle.vertices.map(|vertex| scene.vertices[vertex as usize]);
            let Some(stored) = image.triangle(number as u32) else { continue };
            for (corner, raw) in corners.iter().zip(stored.vertices) {
                let place = image.grid.scene(raw);
                let square: f64 = (0..3).map(|k| (place[k] - corner[k]).powi(2)).sum();
                largest = largest.max(square.sqrt());
                sum += square;
            }
            if has_no_area(corners) {
                degenerate += 1;
            } else if has_no_raw_area(stored.vertices) {
                collapsed += 1;
            }
        }
        let corners = 3.0 * scene.triangles.len().max(1) as f64;
        Precision {
            step: f64::from(shift as i32 - image.formats.position).exp2(),
            steps: u64::from(longest) >> shift,
            largest_move: largest,
            rms_move: (sum / corners).sqrt(),
            degenerate,
            collapsed,
        }
    }
}

fn has_no_area([a, b, c]: [Vec3; 3]) -> bool {
    let (e, f) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
    (0..3).all(|k| e[(k + 1) % 3] * f[(k + 2) % 3] == e[(k + 2) % 3] * f[(k + 1) % 3])
}

fn has_no_raw_area([a, b, c]: [[i32; 3]; 3]) -> bool {
    let difference = |p: [i32; 3]| [0, 1, 2].map(|k| i128::from(p[k]) - i128::from(a[k]));
    let (e, f) = (difference(b), difference(c));
    (0..3).all(|k| e[(k + 1) % 3] * f[(k + 2) % 3] == e[(k + 2) % 3] * f[(k + 1) % 3])
}

#[cfg(test)]
mod tests {
    use scenes::generate;

    use super::*;

    fn facts(name: &str, word: u32) -> SceneFacts {
        let scene = generate::scene(name, &generate::Options::default()).unwrap();
        SceneFacts::new(&scene, &Options { word, ..Options::default() }).unwrap()
    }

    #[test]
    fn shorter_words_move_corners_further() {
        let (long, short) = (facts("sphereflake", 32).precision, facts("sphereflake", 16).precision);
        assert_eq!(short.step, long.step * 65_536.0);
        assert!(long.largest_move <= long.step && short.largest_move > 1000.0 * long.largest_move);
        assert!(short.rms_move <= short.largest_move && short.steps < 1 << 15);
    }

    #[test]
    fn parts_add_up() {
        let facts = facts("cornell", 32);
        assert_eq!(facts.materials.iter().map(|material| material.triangles).sum::<usize>(), facts.triangles);
        let octets: u64 = facts.memory.octets.0.iter().map(|(_, octets)| octets).sum();
        assert!(octets <= facts.memory.total as u64 && octets + 64 > facts.memory.total as u64);
        assert!(facts.has_mirror && facts.has_glass && facts.unused_vertices == 0);
    }

    #[test]
    fn nothing_has_no_box() {
        let facts = facts("empty", 32);
        assert_eq!((facts.triangles, facts.bounds, facts.precision.largest_move), (0, None, 0.0));
    }
}
