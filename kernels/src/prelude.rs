//! Prelude of a program, which is all that the loader tells it about its scene, as assembly text: formats, features, structures, and the map of the local
//! buffer with its initial contents. The text stands before the kernels and can be printed and assembled by hand.

use std::fmt::Write;
use std::sync::Arc;

use isa::Isa;
use messages::{Report, Source};
use scenes::cadrage::Formats;
use scenes::camera::{EntryFace, PixelFunction, RawCamera, RayStart};
use scenes::image::{MemoryImage, MemoryKind};
use scenes::layout::{BLOCK_NODES, Layout, Structure, StructureSet, TOP_NODES};

use crate::build::{Crop, SceneFeatures};
use crate::constants::{Constants, SIDE_MARGIN};
use crate::skip::Skip;

/// Octets of the buffer's tables of materials and lights (report 6.2); what does not fit stays in global memory.
const TABLES: u32 = 768;

/// References that are fetched at once.
const REFERENCES_AT_ONCE: u32 = 128;

/// Triangles of a packet that the buffer holds at once.
const PACKET_AT_ONCE: u32 = 64;

/// Triangles of a ray that its core remembers, a power of two.
const TESTED_PLACES: u32 = 16;

/// Fraction bits that a format of the assembler has at most; it has none below 0.
const MOST_FRACTION_BITS: i32 = 63;

/// Trap number of a ray that visits more packets than there are.
const TRAP_STUCK: u32 = 1;

/// A structure as a `.struct` of the assembler.
pub(crate) fn structure(text: &mut String, structure: &Structure) {
    let _ = writeln!(text, ".struct {}", structure.name);
    for field in structure.fields.iter() {
        let _ = writeln!(text, "    .field {}, {}    ; {}", field.name, field.octets(), field.holds);
    }
    let _ = writeln!(text, ".endstruct");
}

/// Memory of a program for the far sides of its walks through the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WalkMemory {
    /// Not at all: each walk starts at the root.
    Restart,
    /// Nodes with boxes, the last one by axis.
    Boxes,
    /// Planes, the last one first.
    Planes,
    /// As `Planes`, in blocks of nodes that lie in the buffer.
    Blocks,
}

/// The prelude of a core's program, or of the main processor's.
pub fn text(image: &MemoryImage, features: &SceneFeatures, crop: &Crop, walk: WalkMemory, is_main: bool) -> String {
    let mut text = String::from("; Written by the loader for one scene and one machine.\n");
    for (name, bits) in written_formats(&image.formats).entries() {
        let _ = writeln!(text, ".format {name}, {bits}");
    }
    let _ = writeln!(text, ".format index, {}", image.formats.index);
    for (name, value) in constants(image, features, crop) {
        let _ = writeln!(text, ".equ {name}, {value}");
    }
    // No load of the main processor goes on beside its computing.
    let _ = writeln!(text, ".equ LOADS_AHEAD, {}", u32::from(features.loads_ahead && !is_main));
    text.push_str(".equ T_QUOTIENT, dir + t - pos + T_SHIFT - EDGE_SHIFT\n\n");
    for part in image.structures.all() {
        match image.layout {
            // In the buffer the same numbers are words.
            Layout::Packed => structure(&mut text, &part.in_words()),
            _ => structure(&mut text, part),
        }
    }
    for (name, value) in widths(&image.structures) {
        let _ = writeln!(text, ".equ {name}, {value}");
    }
    text.push_str(STRUCTURES);
    text.push_str(".buffer\n");
    text.push_str(match walk {
        WalkMemory::Restart => "NODE: .space 2 * sizeof(node)\n",
        WalkMemory::Boxes => BOXES,
        WalkMemory::Planes | WalkMemory::Blocks => PLANES,
    });
    if walk == WalkMemory::Blocks && image.layout != Layout::Report {
        blocks(&mut text, image);
    }
    let _ = writeln!(text, "ROOT_HIGH: .word {}", words(&image.bounds.high));
    let _ = writeln!(text, "ROOT_LOW: .word {}", words(&image.bounds.low));
    if is_main {
        camera(&mut text, image);
        if features.agreement.is_some() {
            text.push_str("CORNERS: .space 4 * sizeof(pixel)\n");
        }
    } else {
        core(&mut text, image, features, walk)
    }
    text.push_str(".text\n");
    text
}

/// The formats as the assembler can write them: kernels use those of positions and distances only as a difference, so where the scene is very
/// large or small (a position of 2^300 has -270 fraction bits) both are moved into the assembler's range.
pub(crate) fn written_formats(formats: &Formats) -> Formats {
    let finer = formats.t - formats.position;
    let least = (-finer).max(0);
    let most = MOST_FRACTION_BITS.min(MOST_FRACTION_BITS - finer);
    let position = formats.position.clamp(least, most.max(least));
    Formats { position, t: position + finer, ..*formats }
}

/// Sizes of structures in global memory: octets, and bits of the integers that rows unpack.
fn widths(structures: &StructureSet) -> Vec<(&'static str, u32)> {
    let StructureSet { node, reference, triangle, material, light, .. } = structures;
    let bits = |structure: &Structure, field: usize| structure.fields.get(field).map_or(0, |field| field.bits);
    vec![
        ("TRIANGLE_OCTETS", triangle.octets()),
        ("MATERIAL_OCTETS", material.octets()),
        ("LIGHT_OCTETS", light.octets()),
        ("PLANE_BITS", bits(node, 0)),
        ("LINK_BITS", bits(node, 1)),
        ("REFERENCE_BITS", bits(reference, 0)),
        ("VERTEX_BITS", bits(triangle, 0)),
        ("MATERIAL_AT_OCTET", triangle.offset("material_id").unwrap_or(0)),
        ("MATERIAL_ID_BITS", triangle.fields.last().map_or(0, |field| field.bits)),
        ("MATERIAL_BITS", bits(material, 0)),
        ("LIGHT_BITS", bits(light, 0)),
    ]
}

/// True for a table (materials, lights) that lies in the buffer from the start.
fn is_local(image: &MemoryImage, kind: MemoryKind) -> bool {
    let (structure, count) = match kind {
        MemoryKind::Materials => (&image.structures.material, image.counts.materials),
        _ => (&image.structures.light, image.counts.lights),
    };
    u64::from(count) * u64::from(structure.in_words().octets()) <= u64::from(TABLES / 2)
}

fn constants(image: &MemoryImage, features: &SceneFeatures, crop: &Crop) -> Vec<(&'static str, i64)> {
    let constants = Constants::new(image);
    let Constants { formats, edge_shift, t_shift, offset, literal_offset, never, missed, most_steps, .. } = constants;
    let mut entries = vec![
        // The layout, the shifts between formats, and numbers that stand for no distance
        ("WORD", formats.word.into()),
        ("LAYOUT_REPORT", (image.layout == Layout::Report).into()),
        ("LAYOUT_PACKET", (image.layout == Layout::Packet).into()),
        ("LAYOUT_PACKED", (image.layout == Layout::Packed).into()),
        ("COORDINATE_SHIFT", image.layout.coordinate_shift(formats.word).into()),
        ("EDGE_SHIFT", edge_shift.into()),
        ("T_SHIFT", t_shift.into()),
        ("SIDE_SHIFT", constants.side_shift.into()),
        ("SIDE_FRACTION", constants.side_fraction.into()),
        ("SIDE_MARGIN", SIDE_MARGIN.into()),
        ("OFFSET", offset.into()),
        ("LITERAL_OFFSET", literal_offset.into()),
        ("NEVER", never.into()),
        ("MISSED", missed.into()),
        ("MOST_STEPS", most_steps.into()),
        // The tree, and the pieces in which it is fetched
        ("LARGEST_PACKET", image.tree.most_triangles as i64),
        ("PACKET_AT_ONCE", PACKET_AT_ONCE.into()),
        ("PACKET_OCTETS", packet_octets().into()),
        ("TREE_NODES", image.tree.nodes as i64),
        ("TOP_NODES", top_nodes(image).into()),
        ("BLOCK_NODES", BLOCK_NODES.into()),
        ("TRAP_STUCK", TRAP_STUCK.into()),
        ("DEPTH", image.tree.depth.into()),
        ("ROOT", image.root.into()),
        // The map of global memory, and what lies in the buffer from the start
        ("FRAME", image.region(MemoryKind::Frame).start.into()),
        ("MATERIALS_BUS", image.region(MemoryKind::Materials).start.into()),
        ("MATERIALS_LOCAL", is_local(image, MemoryKind::Materials).into()),
        ("LIGHTS_BUS", image.region(MemoryKind::Lights).start.into()),
        ("LIGHTS_LOCAL", is_local(image, MemoryKind::Lights).into()),
        ("LIGHTS", image.counts.lights.into()),
        ("HAS_FAR_LIGHTS", image.has_far_lights().into()),
        ("REFERENCES_AT_ONCE", REFERENCES_AT_ONCE.into()),
        ("AMBIENT", image.ambient.into()),
        // What the scene asks for, and the part of the picture that is drawn
        ("BOUNCES", features.bounces.into()),
        ("CUTOFF", features.least_weight().into()),
        ("HAS_TREE", features.has_tree().into()),
        ("HAS_GLASS", features.has_glass().into()),
        ("HAS_BACKGROUND", (image.background != [0; 3]).into()),
        ("PERSPECTIVE", matches!(image.camera, RawCamera::Perspective { .. }).into()),
        ("FIRST_COLUMN", crop.column.into()),
        ("FIRST_ROW", crop.row.into()),
        ("WIDTH", crop.width.into()),
        ("HEIGHT", crop.height.into()),
        ("TESTED_PLACES", TESTED_PLACES.into()),
        ("INTERPOLATES", features.agreement.is_some().into()),
        ("AGREEMENT", features.agreement.unwrap_or(0).into()),
    ];
    entries.extend(Skip::ALL.iter().map(|&skip| (skip.constant(), features.skips.has(skip).into())));
    entries
}

/// Octets of a packet's triangle in the buffer: its name and its vertices.
fn packet_octets() -> u32 {
    Layout::Packet.fixed_structures().reference.octets() + Layout::Packet.octets_beside_reference()
}

/// Map of what a walk with boxes needs in any buffer.
const BOXES: &str = "\
NODE: .space 2 * sizeof(node)
RUNS: .space 24                 ; run x direction, a wide number an axis
FARS: .space DEPTH * sizeof(far)
";

/// Map of what a walk with planes needs. The first note is the root's face by which the ray leaves the scene; it begins as no plane at all.
const PLANES: &str = "\
NOTES: .wide -1
    .space (DEPTH + 1) * sizeof(note) - 8
.if LAYOUT_REPORT
NODE: .space 2 * sizeof(node)
.endif
";

/// The nodes from the root on that a buffer has from the start.
fn top_nodes(image: &MemoryImage) -> u32 {
    TOP_NODES.min(image.tree.nodes as u32)
}

/// The blocks of nodes in a buffer: the top of the tree, and one for the nodes below, if there are any. The address of an empty block is no node's.
fn blocks(text: &mut String, image: &MemoryImage) {
    let _ = writeln!(text, "TOP: .word {}, TOP_NODES * sizeof(node)", image.root);
    table(text, image, MemoryKind::Nodes, top_nodes(image));
    if image.tree.nodes as u32 > TOP_NODES {
        text.push_str("BLOCK: .word 0, BLOCK_NODES * sizeof(node)\n    .space BLOCK_NODES * sizeof(node)\n");
    }
}

/// The map of a core's buffer (report 6.2): one node, references, two triangles, the ray tree, materials and lights.
fn core(text: &mut String, image: &MemoryImage, features: &SceneFeatures, walk: WalkMemory) {
    text.push_str(
        "REFERENCES: .space 4 * REFERENCES_AT_ONCE\nSLOT: .space sizeof(triangle)\nNEAR_SLOT: .space sizeof(triangle)\n\
         MATERIAL_AT: .space 4\nSHADE_LIGHT: .space 4\nSHADE_COSINE: .space 4\n",
    );
    if walk == WalkMemory::Blocks {
        text.push_str("PACKET: .space PACKET_OCTETS * min(PACKET_AT_ONCE, LARGEST_PACKET)\n");
    }
    if features.skips.has(Skip::Tested) {
        text.push_str("TESTED: .space 4 * TESTED_PLACES\n");
    }
    if !features.skips.has(Skip::Unlit) {
        text.push_str("SHADE_FACING: .space 8\n");
    }
    // The profile that walks from the root brings nodes of its own.
    if features.has_tree() && walk != WalkMemory::Restart {
        text.push_str("NODES: .space (BOUNCES + 1) * sizeof(raynode)\n");
    }
    let _ = writeln!(text, "BACKGROUND: .word {}", words(&image.background));
    if is_local(image, MemoryKind::Materials) {
        text.push_str("MATERIALS:\n");
        table(text, image, MemoryKind::Materials, u32::MAX);
    } else {
        text.push_str("MATERIAL_SLOT: .space sizeof(material)\n");
    }
    if is_local(image, MemoryKind::Lights) {
        text.push_str("LIGHTS_AT:\n");
        table(text, image, MemoryKind::Lights, u32::MAX);
    } else {
        text.push_str("LIGHT_SLOT: .space sizeof(light)\n.equ LIGHTS_AT, 0\n");
    }
}

/// Structures of the buffer alone: the far side of a split of the kd tree, and a node of the ray tree with what its refracted child
/// will need when the walk is back (report, table 2).
const STRUCTURES: &str = "\
.struct note
    .field plane, 8         ; a split of the kd tree, as a pattern
    .field far, 4           ; address of its far child
.endstruct
.struct linear              ; first + column x column - row x row
    .field first, 8
    .field column, 8
    .field row, 8
.endstruct
.struct across              ; an axis along a face by which rays enter the scene
    .field from_low, 24     ; numerators of the distances from both ends, as functions of column and row
    .field from_high, 24
    .field axis, 4
    .field low, 4           ; lower end
.endstruct
.struct face
    .field slope, 24
    .field first, 56
    .field second, 56
    .field axis, 4
    .field at, 4            ; where rays start
.endstruct
.struct far
    .field node, 4          ; address of the far child
    .field low, 12          ; box of its parent, where nodes have none
    .field high, 12
    .field fars, 12         ; the notes before this one
.endstruct
.struct raynode
    .field k, 4             ; 1 - eta^2 (1 - cosine^2), direction format
    .field eta, 4           ; ratio of the indices of refraction
    .field weight, 4        ; of the refracted child
    .field inside, 4        ; state of the node's ray
    .field cosine, 4
    .field normal, 12
    .field incident, 12
    .field behind, 12       ; origin of the refracted child
    .field visited, 1       ; 1 while the refracted child is still to come
.endstruct
";

fn words(values: &[i32]) -> String {
    values.iter().map(i32::to_string).collect::<Vec<_>>().join(", ")
}

/// The first structures of a region of the image, as words of the buffer.
fn table(text: &mut String, image: &MemoryImage, kind: MemoryKind, most: u32) {
    let structures = image.table(kind, most).expect("the image was just built");
    let numbers: Vec<i32> = structures.into_iter().flatten().map(|number| number as i32).collect();
    for row in numbers.chunks(4) {
        let _ = writeln!(text, "    .word {}", words(row));
    }
}

fn camera(text: &mut String, image: &MemoryImage) {
    let wides = |values: &[i64]| values.iter().map(i64::to_string).collect::<Vec<_>>().join(", ");
    let function = |&PixelFunction { first, column, row }: &PixelFunction| wides(&[first, column, row]);
    let _ = match &image.camera {
        RawCamera::Orthographic { direction, extra, first, pitch, z } => writeln!(
            text,
            "CAMERA_PITCH: .wide {pitch}\nCAMERA_FIRST: .wide {}\nCAMERA_DIRECTION: .word {}\n.equ CAMERA_Z, {z}\n.equ CAMERA_EXTRA, {extra}",
            wides(first),
            words(direction)
        ),
        RawCamera::Perspective { start, extra, base, column, row } => {
            // The way to a pixel, by axis: from pixel (0, 0), of a column, of a row
            for k in 0..3 {
                let label = if k == 0 { "CAMERA_TOWARDS: " } else { "    " };
                let _ = writeln!(text, "{label}.wide {}", wides(&[base[k], column[k], row[k]]));
            }
            let (eye, shift) = match *start {
                RayStart::Eye(eye) => (eye, 0),
                RayStart::Faces { shift, .. } => ([0; 3], shift),
            };
            // A ray that misses the box starts behind it, as in the twin.
            let beyond = [image.bounds.low.map(|x| x - 2), image.bounds.high.map(|x| x + 2)];
            let _ = writeln!(
                text,
                "CAMERA_WAY: .space 24\nCAMERA_EYE: .word {}\nCAMERA_BELOW: .word {}\nCAMERA_ABOVE: .word {}",
                words(&eye),
                words(&beyond[0]),
                words(&beyond[1])
            );
            text.push_str("CAMERA_FACES_AT:\n");
            // The order is that of the fields of `face` and `across` above.
            for EntryFace { axis, at, slope, across } in start.faces() {
                let _ = writeln!(text, "    .wide {}", function(slope));
                for part in across {
                    let _ = writeln!(text, "    .wide {}", function(&part.from_low));
                    let _ = writeln!(text, "    .wide {}", function(&part.from_high));
                    let _ = writeln!(text, "    .word {}, {}", part.axis, part.low);
                }
                let _ = writeln!(text, "    .word {axis}, {at}");
            }
            writeln!(
                text,
                ".equ CAMERA_FACES, {}\n.equ CAMERA_SHIFT, {shift}\n.equ CAMERA_EXTRA, {extra}",
                start.faces().count()
            )
        }
    };
}

/// Names of registers and macros that every program in a layout includes.
pub fn included(layout: Layout) -> [Arc<Source>; 9] {
    macro_rules! file {
        ($path:literal) => {
            Source::new(concat!("kernels/asm/", $path), include_str!(concat!("../asm/", $path)))
        };
    }
    let structures = match layout {
        Layout::Report => file!("report.inc"),
        Layout::Wide | Layout::Packet | Layout::Packed => file!("wide.inc"),
    };
    // Transfers: of structures as they are, or of packed ones.
    let transfers = match layout {
        Layout::Report | Layout::Wide | Layout::Packet => file!("words.inc"),
        Layout::Packed => file!("packed.inc"),
    };
    [
        file!("registers.inc"),
        file!("materials.inc"),
        file!("scalar.inc"),
        file!("surface.inc"),
        file!("search.inc"),
        transfers,
        structures,
        file!("tested.inc"),
        file!("pieces.inc"),
    ]
}

/// Assembles files one after the other as one program; `name` stands for the program in messages.
///
/// # Errors
/// What the assembler finds in the files.
pub fn assemble(name: &str, files: &[Arc<Source>], isa: &Isa) -> Result<asm::Assembled, Report> {
    let root: String = (0..files.len()).map(|n| format!(".include \"{n}\"\n")).collect();
    let include = |wanted: &str, _from: &str| -> Result<Arc<Source>, String> {
        wanted
            .parse()
            .ok()
            .and_then(|n: usize| files.get(n))
            .cloned()
            .ok_or_else(|| format!("there is no file `{wanted}`"))
    };
    let options = asm::Options { include: &include, ..asm::Options::default() };
    asm::assemble(&Source::new(name, root), isa, &options)
}
