//! From tree, triangles and tables to octets. Nothing here chooses a number; that is done before.

use messages::{Diagnostic, Report};

use super::arrange::{ImageParts, arrange, packed_octets};
use super::{Regions, blocks, out_of_range, stored, three};
use crate::cadrage::{self, Formats};
use crate::grid::{Grid, GridLight};
use crate::kdtree::{Bounds, Content, Node, NumberedNode, Triangles};
use crate::layout::{Layout, NODE_NAMES, Structure, StructureSet, WIDE_LEAF, packed_link, put_bits};
use crate::model::Scene;

/// Materials and lights as raw integers, in the order of their fields.
pub(super) struct Tables {
    pub materials: Vec<[i32; 8]>,
    /// With the scale at the end, which only far lights have.
    lights: Vec<[i32; 7]>,
    /// True where a light has steps of its own.
    pub has_far_lights: bool,
}

impl Tables {
    /// Rounds all coefficients to their formats (nearest, ties up).
    pub(super) fn new(scene: &Scene, grid: &Grid, formats: &Formats, layout: Layout) -> Result<Tables, Report> {
        // A triangle ends with the number of its material.
        let most = layout.fixed_structures().triangle.fields.last().map_or(0, |field| 1usize << field.bits);
        if scene.materials.len() > most {
            return Err(Diagnostic::error(format!(
                "{} materials are more than the {most} of layout `{layout}`",
                scene.materials.len()
            ))
            .hint(match layout {
                Layout::Report => "use --layout wide, which has room for 65536",
                Layout::Wide | Layout::Packet | Layout::Packed => "merge materials that are the same",
            })
            .into());
        }
        let fixed = |name: String, value: f64, format: &str, fraction: u32| {
            cadrage::raw(value, fraction, formats.word)
                .ok_or_else(|| out_of_range(&name, value, format, fraction, formats.word))
        };
        let materials = scene.materials.iter().enumerate().map(|(k, material)| {
            let weight = |name: &str, x| fixed(format!("the {name} of material {k}"), x, "weight", formats.weight);
            let index = |name: &str, x| fixed(format!("the {name} of material {k}"), x, "index", formats.index);
            let [r, g, b] = three(material.colour, |x| weight("colour", x))?;
            let (reflection, intensity) =
                (weight("reflection", material.reflection)?, weight("intensity", material.intensity)?);
            if material.index == 0.0 {
                return Ok([r, g, b, reflection, intensity, 0, 0, 0]);
            }
            let transmission = weight("transmission", material.transmission())?;
            let refraction = index("index of refraction", material.index)?;
            let inverse = index("reciprocal of the index of refraction", 1.0 / material.index)?;
            // An index of 0 would say that the material is opaque.
            Ok([r, g, b, reflection, intensity, transmission, refraction.max(1), inverse.max(1)])
        });
        let lights = scene.lights.iter().enumerate().map(|(k, light)| {
            let GridLight { position: [x, y, z], exponent } = grid.light(light.position);
            // From so far away that all points are the same it is multiplied by nothing.
            let scale = if exponent <= formats.direction { 1 << (formats.direction - exponent) } else { 0 };
            let [r, g, b] =
                three(light.colour, |c| fixed(format!("the colour of light {k}"), c, "colour", formats.colour))?;
            Ok([x, y, z, r, g, b, scale])
        });
        Ok(Tables {
            materials: materials.collect::<Result<_, Report>>()?,
            lights: lights.collect::<Result<_, Report>>()?,
            has_far_lights: scene.lights.iter().any(|light| grid.light(light.position).exponent != 0),
        })
    }

    /// The fields of the lights, as their structure has them.
    pub fn lights(&self) -> impl ExactSizeIterator<Item = &[i32]> {
        let fields = if self.has_far_lights { 7 } else { 6 };
        self.lights.iter().map(move |light| &light[..fields])
    }
}

/// Octets of an image, and where they hold what.
pub(super) struct EncodedMemory {
    pub bytes: Vec<u8>,
    pub regions: Regions,
    pub structures: StructureSet,
    /// Address, in the layout `packed` name, of the root.
    pub root: u32,
}

/// Writes all octets.
pub(super) fn memory(parts: &ImageParts<impl Triangles>) -> Result<EncodedMemory, Report> {
    let &ImageParts { tree, scene, triangles, tables, layout, shift, .. } = parts;
    let (structures, regions) = arrange(parts)?;
    let StructureSet { node: node_structure, reference, triangle: triangle_structure, material, light, .. } =
        &structures;
    let mut bytes = vec![0; regions.iter().map(|(_, range)| range.end).max().unwrap_or(0) as usize];
    let start = |kind: usize| regions[kind].1.start;
    let places = if layout == Layout::Packet { blocks::places(tree) } else { Vec::new() };
    let addresses = Addresses {
        nodes: start(1),
        places,
        references: start(2),
        triangles: start(3),
        layout,
        octets: [node_structure, reference, triangle_structure].map(Structure::octets),
    };
    // Octets of leaves that stand in the order in which they come here: see `leaf`.
    let mut filled = 0;
    for NumberedNode { number, first: before, node } in tree.nodes() {
        let packet = packet(node.content);
        let first = match layout {
            _ if packet.is_empty() => 0,
            Layout::Packed => start(2) + filled,
            _ => addresses.leaf(before),
        };
        let values = match layout {
            Layout::Report => {
                if packet.len() > usize::from(u16::MAX) {
                    return Err(Diagnostic::error(format!(
                        "a leaf of {} triangles is more than a node counts",
                        packet.len()
                    ))
                    .hint("use --layout wide, or a deeper tree with --kd-depth")
                    .into());
                }
                addresses.report_node(&node, first, shift)
            }
            Layout::Wide | Layout::Packet => addresses.wide_node(node.content, first),
            Layout::Packed => addresses.packed_node(node.content, first),
        };
        node_structure.write(&mut bytes[addresses.node(number) as usize..], values);
        if layout == Layout::Packed {
            let bits = reference.fields[0].bits;
            let divided = packet.iter().map(|&triangle| addresses.triangle(triangle) / triangle_structure.octets());
            for (at, name) in divided.enumerate() {
                put_bits(&mut bytes[first as usize..], at * bits as usize, bits, name.into());
            }
            filled += packed_octets(packet.len(), bits) as u32;
            continue;
        }
        let octets = reference.octets();
        for (here, &triangle) in (first..).step_by(octets as usize).zip(packet) {
            // A packet names no triangle twice, so the last one is known by its number.
            let is_last = packet.last() == Some(&triangle);
            let next = if is_last { 0 } else { here + octets };
            let values = [addresses.triangle(triangle), next].map(i64::from);
            reference.write(&mut bytes[here as usize..], values.into_iter().take(reference.fields.len()));
        }
    }
    for (number, triangle) in (0..).zip(&scene.triangles) {
        let vertices = triangles.vertices(number as usize);
        let Bounds { low, high } = Bounds::of_triangle(&vertices);
        // The report keeps each triangle's box beside it; the other layouts work boxes out where they are needed.
        let own: &[[i32; 3]] = match layout {
            Layout::Report => &[low, high],
            Layout::Wide | Layout::Packet | Layout::Packed => &[],
        };
        let values = vertices
            .iter()
            .chain(own)
            .flatten()
            .map(|&x| i64::from(stored(x, shift)))
            .chain([i64::from(triangle.material)]);
        triangle_structure.write(&mut bytes[addresses.triangle(number) as usize..], values);
    }
    for (number, values) in (0..).zip(&tables.materials) {
        material.write(&mut bytes[(start(4) + number * material.octets()) as usize..], values.map(i64::from));
    }
    for (number, values) in (0..).zip(tables.lights()) {
        let values = values.iter().map(|&value| value.into());
        light.write(&mut bytes[(start(5) + number * light.octets()) as usize..], values);
    }
    if layout == Layout::Packet {
        for NumberedNode { first: before, node, .. } in tree.nodes() {
            let packet = packet(node.content);
            let behind = addresses.leaf(before) + packet.len() as u32 * reference.octets();
            components(&mut bytes[behind as usize..], triangles, packet);
        }
    }
    // The root is the first node, whatever the layout.
    let root = addresses.name(0);
    Ok(EncodedMemory { bytes, regions, structures, root })
}

/// Writes the vertices of a packet: all x of first vertices, then all y, and so on up to all z of third ones.
fn components(octets: &mut [u8], triangles: &impl Triangles, packet: &[u32]) {
    // Of three triangles the z of the second vertex of the last one is word 5 x 3 + 2, since five arrays stand before its own.
    for (at, &triangle) in packet.iter().enumerate() {
        let vertices = triangles.vertices(triangle as usize);
        for (kind, component) in vertices.as_flattened().iter().enumerate() {
            let place = 4 * (kind * packet.len() + at);
            octets[place..place + 4].copy_from_slice(&component.to_le_bytes());
        }
    }
}

/// The triangles of a leaf, none for an inner node.
pub(super) fn packet(content: Content<'_>) -> &[u32] {
    match content {
        Content::Leaf { triangles } => triangles,
        Content::Inner { .. } => &[],
    }
}

/// Addresses of structures, by number.
struct Addresses {
    nodes: u32,
    /// Places of the nodes, where they do not stand in the order of their numbers.
    places: Vec<u32>,
    references: u32,
    triangles: u32,
    layout: Layout,
    /// Octets of a node, a reference and a triangle.
    octets: [u32; 3],
}

impl Addresses {
    fn node(&self, number: u32) -> u32 {
        let place = self.places.get(number as usize).copied().unwrap_or(number);
        self.nodes + place * self.octets[0]
    }

    /// A node as links name it: its address, in the layout `packed` its number times [`NODE_NAMES`].
    fn name(&self, number: u32) -> u32 {
        match self.layout {
            Layout::Packed => (self.nodes / self.octets[0] + number) * NODE_NAMES,
            _ => self.node(number),
        }
    }

    /// Address of a leaf's references, behind so many of other leaves.
    fn leaf(&self, references: u32) -> u32 {
        self.references + references * (self.octets[1] + self.layout.octets_beside_reference())
    }

    fn triangle(&self, number: u32) -> u32 {
        self.triangles + number * self.octets[2]
    }

    fn report_node(&self, node: &Node, first: u32, shift: u32) -> Vec<i64> {
        let (left, right, axis) = match node.content {
            Content::Inner { axis, left, .. } => (self.node(left), self.node(left + 1), axis),
            Content::Leaf { .. } => (0, 0, 0),
        };
        let next = node.next.map_or(0, |number| self.node(number));
        let corners = [node.bounds.low, node.bounds.high].map(|corner| corner.map(|x| i64::from(stored(x, shift))));
        // Low and high corner once an axis: the report stores two corners for each of the three pairs of faces.
        let faces = (0..3).flat_map(|_| corners).flatten();
        let head = [left, right, next, first].map(i64::from).into_iter();
        head.chain([packet(node.content).len() as i64]).chain(faces).chain([axis as i64]).collect()
    }

    fn wide_node(&self, content: Content, first: u32) -> Vec<i64> {
        match content {
            Content::Inner { axis, at, left } => vec![i64::from(at), i64::from(self.name(left) | axis as u32)],
            Content::Leaf { triangles } => vec![triangles.len() as i64, i64::from(first | WIDE_LEAF)],
        }
    }

    fn packed_node(&self, content: Content, first: u32) -> Vec<i64> {
        let mut values = self.wide_node(content, first);
        values[1] = i64::from(packed_link(values[1] as u32));
        values
    }
}
