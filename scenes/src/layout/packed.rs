//! The structures of the layout `packed`: those of `wide`, in fields of the widths that scene and tree ask for.

use std::borrow::Cow;

use super::{Field, LIGHT, MATERIAL, PIXEL, Structure, StructureSet, WIDE_LEAF};

/// Distance between the names of two nodes of the layout `packed`, one behind the other: a node is named by this times its number.
pub const NODE_NAMES: u32 = 8;

/// Bits of the fields of the layout `packed`, as few as hold what a scene puts there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldWidths {
    /// Planes of inner nodes and numbers of triangles of leaves, with a sign.
    pub plane: u32,
    /// Links of nodes, as [`packed_link`] makes them, 3 to 31.
    pub link: u32,
    /// Addresses of triangles, divided by the octets of one.
    pub reference: u32,
    /// Coordinates of triangles, with a sign.
    pub vertex: u32,
    /// Numbers of materials.
    pub material_id: u32,
    /// All numbers of a material, with a sign.
    pub material: u32,
    /// All numbers of a light, with a sign.
    pub light: u32,
}

impl FieldWidths {
    /// The widest fields that there may be.
    pub const WORDS: FieldWidths =
        FieldWidths { plane: 32, link: 31, reference: 32, vertex: 32, material_id: 16, material: 32, light: 32 };

    /// The structures.
    pub(super) fn structures(&self) -> StructureSet {
        // Materials and lights have the fields of `wide`, all of one width and bit behind bit
        let packed = |structure: &Structure, bits: u32| {
            let field = |&field: &Field| Field { bits, begins_octet: false, ..field };
            Structure { name: structure.name, fields: structure.fields.iter().map(field).collect() }
        };
        let unsigned = |name: &'static str, bits: u32, begins_octet: bool, holds: &'static str| Field {
            name,
            elements: 1,
            bits,
            is_signed: false,
            begins_octet,
            holds,
        };
        let signed = |name: &'static str, elements: u32, bits: u32, holds: &'static str| Field {
            name,
            elements,
            bits,
            is_signed: true,
            begins_octet: false,
            holds,
        };
        let structure = |name: &'static str, fields: Vec<Field>| Structure { name, fields: Cow::Owned(fields) };
        StructureSet {
            node: structure(
                "node",
                vec![
                    signed(
                        "plane",
                        1,
                        self.plane,
                        "inner: coordinate of the dividing plane, a position; leaf: number of triangles",
                    ),
                    unsigned(
                        "link",
                        self.link,
                        false,
                        "inner: number of the left child times 4, plus the axis 0, 1, 2; the right child is the next node; \
                         leaf: address of the first reference, a multiple of 8, divided by 2, plus 3",
                    ),
                ],
            ),
            reference: structure(
                "reference",
                vec![unsigned(
                    "triangle",
                    self.reference,
                    false,
                    "address of a triangle, divided by the octets of one",
                )],
            ),
            triangle: structure(
                "triangle",
                vec![
                    signed("v0", 3, self.vertex, "first vertex: position"),
                    signed("v1", 3, self.vertex, "second vertex"),
                    signed("v2", 3, self.vertex, "third vertex"),
                    // The only field here that begins with an octet: nine coordinates of 15 bits, 135, leave one bit unused before it.
                    unsigned("material_id", self.material_id, true, "number of the material"),
                ],
            ),
            material: packed(&MATERIAL, self.material),
            light: packed(&LIGHT, self.light),
            pixel: PIXEL.clone(),
        }
    }
}

/// The link of a node in memory, from its pattern, a name or an address that is a multiple of 8, plus the tag in the two lowest bits.
///
/// Bit 2 is never set, and is left out: the leaf whose references begin at 24 = 11000 has the pattern 11011 and the link 1111.
pub const fn packed_link(pattern: u32) -> u32 {
    pattern >> 3 << 2 | pattern & WIDE_LEAF
}

/// The pattern of a node's link in memory: see [`packed_link`].
pub const fn unpacked_link(link: u32) -> u32 {
    link >> 2 << 3 | link & WIDE_LEAF
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_lie_bit_behind_bit() {
        let widths =
            FieldWidths { plane: 15, link: 12, reference: 11, vertex: 15, material_id: 3, material: 17, light: 16 };
        let StructureSet { node, reference, triangle, material, light, pixel } = widths.structures();
        // 15 + 12 = 27 bits; 9 x 15 = 135 bits, 17 octets, and one for the material; 8 x 17 = 136 bits.
        assert_eq!(
            [&node, &reference, &triangle, &material, &light, &pixel].map(Structure::octets),
            [4, 2, 18, 17, 12, 12]
        );
        let places: Vec<_> = triangle.places().map(|(start, field)| (field.name, start)).collect();
        assert_eq!(places, [("v0", 0), ("v1", 45), ("v2", 90), ("material_id", 136)]);
        let mut octets = [0; 18];
        let values = [-16384, 16383, -1, 0, 1, 2, 3, -3, 4, 5];
        triangle.write(&mut octets, values);
        assert_eq!(triangle.read(&octets), Some(values.to_vec()));
        assert_eq!(triangle.in_words().octets(), 40);
    }

    #[test]
    fn links_lose_nothing() {
        for pattern in [3, 8, 16 + 1, 24 + 2, (u32::MAX - 7) | WIDE_LEAF] {
            assert_eq!(unpacked_link(packed_link(pattern)), pattern);
        }
        assert_eq!(packed_link(0b11011), 0b1111);
    }
}
