//! The places of an image's structures: which addresses hold what, and in the layout `packed` how many bits a field takes.

use messages::{Diagnostic, Report};

use super::encode::{Tables, packet};
use super::{HEADER, MemoryKind, Regions};
use crate::kdtree::{BuiltTree, Content, NumberedNode, Triangles};
use crate::layout::{
    FieldWidths, Layout, NODE_NAMES, StructureSet, WIDE_LEAF, packed_link, signed_bits, unsigned_bits,
};
use crate::model::Scene;

/// Parts that an image is made of.
pub(super) struct ImageParts<'a, T> {
    pub tree: &'a BuiltTree,
    pub scene: &'a Scene,
    pub triangles: &'a T,
    pub tables: &'a Tables,
    pub layout: Layout,
    /// Bits by which coordinates are shifted when they are stored.
    pub shift: u32,
    /// Width and height of the frame.
    pub size: (u32, u32),
}

/// Octets of the references of a leaf of the layout `packed`, up to those of the next one.
pub(super) fn packed_octets(references: usize, bits: u32) -> u64 {
    (references as u64 * u64::from(bits)).div_ceil(8).next_multiple_of(8)
}

/// Structures and the addresses of each kind.
///
/// # Errors
/// An image beyond 32-bit addresses, or beyond the links of the layout `packed`.
pub(super) fn arrange(parts: &ImageParts<impl Triangles>) -> Result<(StructureSet, Regions), Report> {
    let mut widths = match parts.layout {
        Layout::Packed => measured(parts),
        _ => FieldWidths::WORDS,
    };
    loop {
        let structures = parts.layout.structures(&widths);
        let structures = if parts.tables.has_far_lights { structures.with_far_lights() } else { structures };
        let regions = regions(parts, &structures)?;
        if parts.layout != Layout::Packed {
            return Ok((structures, regions));
        }
        // A wider link makes nodes larger, which moves references and triangles, which may take wider fields in turn: with 1,023 nodes
        // a link of 12 bits names them, until their octets push the last references beyond address 8,192. Widths only grow.
        let [nodes, references, triangles] = [1, 2, 3].map(|kind: usize| regions[kind].1.clone());
        let Some(last) = (nodes.end / structures.node.octets()).checked_mul(NODE_NAMES) else {
            return Err(Diagnostic::error("the kd tree is larger than the links of layout `packed` reach")
                .hint("use --layout wide, or a lower tree with --kd-depth")
                .into());
        };
        let link = unsigned_bits(u64::from(packed_link(last.max(references.end) | WIDE_LEAF)));
        let reference = unsigned_bits(u64::from(triangles.end / structures.triangle.octets()));
        if link <= widths.link && reference <= widths.reference {
            return Ok((structures, regions));
        }
        (widths.link, widths.reference) = (link.max(widths.link), reference.max(widths.reference));
    }
}

/// The widths that scene and tree ask for; those of links and references depend on where they lie, and begin at the least.
fn measured(parts: &ImageParts<impl Triangles>) -> FieldWidths {
    let &ImageParts { tree, scene, triangles, tables, .. } = parts;
    let planes = tree.nodes().map(|NumberedNode { node, .. }| match node.content {
        Content::Inner { at, .. } => at.into(),
        Content::Leaf { triangles } => triangles.len() as i64,
    });
    let coordinates =
        (0..triangles.count()).flat_map(|index| triangles.vertices(index).into_iter().flatten().map(i64::from));
    let numbers = |table: &[i32]| signed_bits(table.iter().map(|&x| x.into()));
    FieldWidths {
        plane: signed_bits(planes),
        link: 3,
        reference: 1,
        vertex: signed_bits(coordinates),
        material_id: unsigned_bits(scene.materials.len().saturating_sub(1) as u64),
        material: numbers(tables.materials.as_flattened()),
        light: signed_bits(tables.lights().flatten().map(|&x| x.into())),
    }
}

/// The addresses of each kind.
fn regions(parts: &ImageParts<impl Triangles>, structures: &StructureSet) -> Result<Regions, Report> {
    let &ImageParts { tree, triangles, tables, layout, size, .. } = parts;
    let [node, reference, triangle, material, light, pixel] =
        structures.all().map(|structure| u64::from(structure.octets()));
    let references = match layout {
        Layout::Packed => {
            let bits = structures.reference.fields[0].bits;
            tree.nodes().map(|NumberedNode { node, .. }| packed_octets(packet(node.content).len(), bits)).sum()
        }
        _ => u64::from(tree.references()) * (reference + u64::from(layout.octets_beside_reference())),
    };
    let octets = [
        u64::from(HEADER),
        u64::from(tree.count()) * node,
        references,
        triangles.count() as u64 * triangle,
        tables.materials.len() as u64 * material,
        tables.lights().len() as u64 * light,
        (u64::from(size.0) * u64::from(size.1)).saturating_mul(pixel),
    ];
    // Structures that are named by their numbers, counted from address 0, begin at a multiple of their octets.
    let named = |kind| match (layout, kind) {
        (Layout::Packed, MemoryKind::Nodes) => node,
        (Layout::Packed, MemoryKind::Triangles) => triangle,
        _ => 1,
    };
    let mut end = 0u64;
    let mut regions = MemoryKind::ALL.map(|kind| (kind, 0..0));
    for ((kind, range), length) in regions.iter_mut().zip(octets) {
        // Each region begins at a multiple of 8, because a link of the wide layout keeps the axis in the lowest bits.
        let unit = named(*kind);
        let odd = unit >> unit.trailing_zeros().min(3);
        let start = end.next_multiple_of(8 * odd);
        end = start.saturating_add(length);
        *range = u32::try_from(start).and_then(|start| Ok(start..u32::try_from(end)?)).map_err(|_| {
            let mebioctets = octets.iter().fold(0u64, |sum, &n| sum.saturating_add(n)) >> 20;
            Diagnostic::error(format!("the memory image needs {mebioctets} MiB, more than 32-bit addresses reach"))
                .hint("use a smaller picture, or a lower tree with --kd-depth")
        })?;
    }
    Ok(regions)
}
