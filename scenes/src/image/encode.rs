//! From tree, triangles and tables to octets. Nothing here chooses a number; that is done before.

use messages::{Diagnostic, Report};

use super::{HEADER, MemoryKind, Regions, blocks, out_of_range, stored, three};
use crate::cadrage::{self, Formats};
use crate::grid::Grid;
use crate::kdtree::{Bounds, BuiltTree, Content, Node, NumberedNode, Triangles};
use crate::layout::{LIGHT, Layout, MATERIAL, PIXEL, Structure, WIDE_LEAF};
use crate::model::Scene;

/// Materials and lights as raw integers, in the order of their fields.
pub(super) struct Tables {
    materials: Vec<[i32; 8]>,
    lights: Vec<[i32; 6]>,
}

impl Tables {
    /// Rounds all coefficients to their formats (nearest, ties up).
    pub(super) fn new(scene: &Scene, grid: &Grid, formats: &Formats, layout: Layout) -> Result<Tables, Report> {
        let most = 1usize << (8 * layout.triangle().fields[layout.triangle().fields.len() - 1].width);
        if scene.materials.len() > most {
            return Err(Diagnostic::error(format!(
                "{} materials are more than the {most} of layout `{layout}`",
                scene.materials.len()
            ))
            .hint(match layout {
                Layout::Report => "use --layout wide, which has room for 65536",
                Layout::Wide | Layout::Packet => "merge materials that are the same",
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
            let [x, y, z] = grid.raw(light.position);
            let [r, g, b] =
                three(light.colour, |c| fixed(format!("the colour of light {k}"), c, "colour", formats.colour))?;
            Ok([x, y, z, r, g, b])
        });
        Ok(Tables {
            materials: materials.collect::<Result<_, Report>>()?,
            lights: lights.collect::<Result<_, Report>>()?,
        })
    }
}

/// All octets, and which addresses hold what.
pub(super) fn memory(
    tree: &BuiltTree,
    scene: &Scene,
    triangles: &impl Triangles,
    tables: &Tables,
    layout: Layout,
    shift: u32,
    size: (u32, u32),
) -> Result<(Vec<u8>, Regions), Report> {
    let octets = [
        u64::from(HEADER),
        u64::from(tree.count()) * u64::from(layout.node().octets()),
        u64::from(tree.references()) * u64::from(layout.octets_a_reference()),
        triangles.count() as u64 * u64::from(layout.triangle().octets()),
        tables.materials.len() as u64 * u64::from(MATERIAL.octets()),
        tables.lights.len() as u64 * u64::from(LIGHT.octets()),
        (u64::from(size.0) * u64::from(size.1)).saturating_mul(u64::from(PIXEL.octets())),
    ];
    let mut end = 0u64;
    let mut regions = MemoryKind::ALL.map(|kind| (kind, 0..0));
    for ((_, range), length) in regions.iter_mut().zip(octets) {
        // Each region begins at a multiple of 8, because a link of the wide layout keeps the axis in the lowest bits.
        let start = end.next_multiple_of(8);
        end = start.saturating_add(length);
        *range = u32::try_from(start).and_then(|start| Ok(start..u32::try_from(end)?)).map_err(|_| {
            let mebioctets = octets.iter().fold(0u64, |sum, &n| sum.saturating_add(n)) >> 20;
            Diagnostic::error(format!("the memory image needs {mebioctets} MiB, more than 32-bit addresses reach"))
                .hint("use a smaller picture, or a lower tree with --kd-depth")
        })?;
    }
    let mut bytes = vec![0; end as usize];
    let start = |kind: usize| regions[kind].1.start;
    let places = if layout == Layout::Packet { blocks::places(tree) } else { Vec::new() };
    let addresses = Addresses { nodes: start(1), places, references: start(2), triangles: start(3), layout };
    let mut put = |address: u32, structure: &Structure, values: &mut dyn Iterator<Item = i64>| {
        structure.write(&mut bytes[address as usize..], values);
    };
    for NumberedNode { number, first: reference, node } in tree.nodes() {
        let packet = packet(node.content);
        let first = if packet.is_empty() { 0 } else { addresses.leaf(reference) };
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
        };
        put(addresses.node(number), layout.node(), &mut values.into_iter());
        let octets = layout.reference().octets();
        for (here, &triangle) in (first..).step_by(octets as usize).zip(packet) {
            // A packet names no triangle twice, so the last one is known by its number.
            let is_last = packet.last() == Some(&triangle);
            let next = if is_last { 0 } else { here + octets };
            let values = [addresses.triangle(triangle), next].map(i64::from);
            put(here, layout.reference(), &mut values.into_iter().take(layout.reference().fields.len()));
        }
    }
    for (number, triangle) in (0..).zip(&scene.triangles) {
        let vertices = triangles.vertices(number as usize);
        let Bounds { low, high } = Bounds::of_triangle(&vertices);
        // The report keeps each triangle's box beside it; the wide layout works boxes out where they are needed.
        let own: &[[i32; 3]] = match layout {
            Layout::Report => &[low, high],
            Layout::Wide | Layout::Packet => &[],
        };
        let mut values = vertices
            .iter()
            .chain(own)
            .flatten()
            .map(|&x| i64::from(stored(x, shift)))
            .chain([i64::from(triangle.material)]);
        put(addresses.triangle(number), layout.triangle(), &mut values);
    }
    for (number, material) in (0..).zip(&tables.materials) {
        put(start(4) + number * MATERIAL.octets(), &MATERIAL, &mut material.iter().map(|&x| i64::from(x)));
    }
    for (number, light) in (0..).zip(&tables.lights) {
        put(start(5) + number * LIGHT.octets(), &LIGHT, &mut light.iter().map(|&x| i64::from(x)));
    }
    if layout == Layout::Packet {
        for NumberedNode { first: reference, node, .. } in tree.nodes() {
            let packet = packet(node.content);
            let behind = addresses.leaf(reference) + packet.len() as u32 * layout.reference().octets();
            components(&mut bytes[behind as usize..], triangles, packet);
        }
    }
    Ok((bytes, regions))
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
fn packet(content: Content<'_>) -> &[u32] {
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
}

impl Addresses {
    fn node(&self, number: u32) -> u32 {
        let place = self.places.get(number as usize).copied().unwrap_or(number);
        self.nodes + place * self.layout.node().octets()
    }

    /// Address of a leaf's references, behind so many of other leaves.
    fn leaf(&self, references: u32) -> u32 {
        self.references + references * self.layout.octets_a_reference()
    }

    fn triangle(&self, number: u32) -> u32 {
        self.triangles + number * self.layout.triangle().octets()
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
            Content::Inner { axis, at, left } => vec![i64::from(at), i64::from(self.node(left) | axis as u32)],
            Content::Leaf { triangles } => vec![triangles.len() as i64, i64::from(first | WIDE_LEAF)],
        }
    }
}
