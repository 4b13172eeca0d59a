//! Facts about a scene before it is drawn: its parts, its tree, its octets in memory, and what the grid costs.
//! How it is printed is not decided here; it serializes as the JSON of `lancer scene info`.

mod precision;

use std::borrow::Cow;

use messages::Report;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Serialize, Serializer};

pub use self::precision::Precision;
use crate::image::{self, MemoryImage, MemoryOptions};
use crate::kdtree::Statistics;
use crate::layout::Structure;
use crate::model::{Scene, Vec3, View};
use crate::read::mesh::repeated;

/// Version of [`SceneInfo`].
pub const SCHEMA: &str = "lancer-scene-1";

/// The facts of a scene.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SceneInfo {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
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
    /// Triangles with the same three vertices as an earlier one, in any order.
    pub repeated: usize,
    /// Smallest and largest corner of the triangles' box, in scene units; `None` without triangles.
    pub bounds: Option<[Vec3; 2]>,
    /// Materials in the order of their numbers.
    pub materials: Vec<MaterialInfo>,
    /// Lights.
    pub lights: usize,
    /// Some triangle's material reflects.
    pub has_mirror: bool,
    /// Some triangle's material is transparent.
    pub has_glass: bool,
    /// The kd tree.
    pub tree: Statistics,
    /// Structures of global memory.
    pub memory: ImageMemory,
    /// Bits of a word, and fraction bits of each quantity.
    pub formats: Named<i32>,
    /// The cost of the grid in precision.
    pub precision: Precision,
}

/// A material and how many triangles have it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MaterialInfo {
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
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ImageMemory {
    /// Name of the layout.
    pub layout: &'static str,
    /// Octets by structure, in the order of the addresses.
    pub octets: Named<u64>,
    /// The structures themselves.
    pub structures: Vec<StructureInfo>,
    /// All octets, gaps between the structures included.
    pub total: usize,
}

/// Size of a structure of global memory.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct StructureInfo {
    /// Name of the structure.
    pub name: &'static str,
    /// Octets of one; of a reference of the layout `packed` there may be several in an octet.
    pub octets: u32,
    /// Bits of an integer of each field.
    pub bits: Named<u32>,
}

/// Values by name in an order that is kept; a map where it is serialized.
#[derive(Clone, Debug, PartialEq)]
pub struct Named<T>(pub Vec<(&'static str, T)>);

impl<T: Serialize> Serialize for Named<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

impl<T: JsonSchema> JsonSchema for Named<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Named_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "object", "additionalProperties": generator.subschema_for::<T>() })
    }
}

impl SceneInfo {
    /// The facts of a scene in memory, as a picture with this view has it.
    ///
    /// # Errors
    /// What [`image::build`] refuses.
    pub fn new(scene: &Scene, view: &View, options: &MemoryOptions) -> Result<SceneInfo, Report> {
        let image = image::build(scene, view, options)?;
        Ok(SceneInfo::of_image(scene, &image))
    }

    /// The facts of a scene and its image.
    pub fn of_image(scene: &Scene, image: &MemoryImage) -> SceneInfo {
        // Find the vertices that triangles name: a file may hold more
        let mut is_used = vec![false; scene.vertices.len()];
        scene.triangles.iter().flat_map(|t| t.vertices).for_each(|vertex| is_used[vertex as usize] = true);
        let corners: Vec<[u32; 3]> = scene.triangles.iter().map(|triangle| triangle.vertices).collect();
        let materials = materials(scene);
        // A mirror that no triangle is made of is not in the picture.
        let has = |test: fn(&MaterialInfo) -> bool| materials.iter().any(|m| m.triangles > 0 && test(m));
        let formats = &image.formats;
        SceneInfo {
            schema: SCHEMA,
            scene: scene.name.clone(),
            width: scene.size.0,
            height: scene.size.1,
            triangles: scene.triangles.len(),
            vertices: scene.vertices.len(),
            unused_vertices: is_used.iter().filter(|is_used| !**is_used).count(),
            repeated: repeated(&corners).len(),
            bounds: scene.bounds().map(|(low, high)| [low, high]),
            lights: scene.lights.len(),
            has_mirror: has(|material| material.reflection > 0.0),
            has_glass: has(|material| material.transmission > 0.0),
            materials,
            tree: image.tree,
            memory: ImageMemory {
                layout: image.layout.name(),
                octets: Named(image.regions.iter().map(|(kind, range)| (kind.name(), range.len() as u64)).collect()),
                structures: image.structures.all().map(structure).to_vec(),
                total: image.bytes.len(),
            },
            formats: Named([("word", formats.word as i32)].into_iter().chain(formats.entries()).collect()),
            precision: Precision::new(scene, image),
        }
    }
}

fn structure(structure: &Structure) -> StructureInfo {
    let bits = structure.fields.iter().map(|field| (field.name, field.bits)).collect();
    StructureInfo { name: structure.name, octets: structure.octets(), bits: Named(bits) }
}

fn materials(scene: &Scene) -> Vec<MaterialInfo> {
    let mut uses = vec![0; scene.materials.len()];
    scene.triangles.iter().for_each(|triangle| uses[triangle.material as usize] += 1);
    let info = |(material, triangles): (&crate::model::Material, usize)| MaterialInfo {
        colour: material.colour,
        reflection: material.reflection,
        intensity: material.intensity,
        transmission: material.transmission(),
        index: material.index,
        triangles,
    };
    scene.materials.iter().zip(uses).map(info).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate;
    use crate::layout::Layout;

    fn info(name: &str, options: MemoryOptions) -> SceneInfo {
        let scene = generate::scene(name, &generate::GenerateOptions::default()).unwrap();
        SceneInfo::new(&scene, &View::new(scene.size), &options).unwrap()
    }

    #[test]
    fn parts_add_up() {
        for layout in Layout::ALL {
            let info = info("cornell", MemoryOptions { layout, ..MemoryOptions::default() });
            assert_eq!(info.materials.iter().map(|material| material.triangles).sum::<usize>(), info.triangles);
            let octets: u64 = info.memory.octets.0.iter().map(|(_, octets)| octets).sum();
            let gaps = info.memory.total as u64 - octets;
            let of = |name: &str| info.memory.octets.0.iter().find(|(kind, _)| *kind == name).unwrap().1;
            let structure = |name: &str| info.memory.structures.iter().find(|one| one.name == name).unwrap();
            let (triangle, node) = (structure("triangle").octets, structure("node").octets);
            // Nodes and triangles of `packed` begin at multiples of their octets, the others at multiples of 8.
            let most = if layout == Layout::Packed { 8 * u64::from(triangle + node) } else { 0 };
            assert!(gaps < 8 * info.memory.octets.0.len() as u64 + most, "{gaps}");
            assert_eq!(of("triangles"), info.triangles as u64 * u64::from(triangle));
            assert_eq!(of("nodes"), info.tree.nodes as u64 * u64::from(node));
            // In the layout of packets the nine coordinates of a triangle lie beside its reference.
            let beside = if layout == Layout::Packet { 9 * 4 } else { 0 };
            let references = info.tree.references as u64;
            match layout {
                Layout::Packed => assert!((references..3 * references).contains(&of("references"))),
                _ => assert_eq!(of("references"), references * u64::from(structure("reference").octets + beside)),
            }
            assert_eq!(of("frame"), 320 * 240 * 12);
            assert!(info.has_mirror && info.has_glass && info.lights > 0);
            assert_eq!((info.unused_vertices, info.repeated), (0, 0));
        }
    }

    #[test]
    fn what_is_odd_is_counted() {
        let mut scene = generate::scene("triangle", &generate::GenerateOptions::default()).unwrap();
        let first = scene.triangles[0];
        let [a, b, c] = first.vertices;
        for vertices in [[b, a, c], [c, a, b], [a, a, b]] {
            scene.triangles.push(crate::model::Triangle { vertices, ..first });
        }
        scene.vertices.push([0.25, 0.25, 0.0]);
        let info = SceneInfo::new(&scene, &View::new(scene.size), &MemoryOptions::default()).unwrap();
        assert_eq!((info.repeated, info.unused_vertices, info.precision.degenerate), (2, 1, 1));
        assert_eq!(info.materials[0].triangles, 4);
    }

    #[test]
    fn nothing_has_no_box() {
        let info = info("empty", MemoryOptions::default());
        assert_eq!((info.triangles, info.bounds, info.precision.largest_move), (0, None, 0.0));
        assert_eq!((info.precision.largest_share, info.precision.rms_share), (0.0, 0.0));
    }
}
