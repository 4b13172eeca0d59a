//! The structures of global memory as data: names, octets and offsets of all fields, in each layout. The image is written and read by these
//! tables, and the assembler's `.struct` definitions are generated from them, so that a field has one place. Little-endian throughout.

mod bits;
mod manual;
mod packed;

use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

use messages::{Diagnostic, did_you_mean};

pub use self::bits::{bits_at, put_bits, signed_bits, unsigned_bits};
pub use self::manual::manual;
pub use self::packed::{FieldWidths, NODE_NAMES, packed_link, unpacked_link};

/// A field: one or more integers of the same width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Name as kernels write it.
    pub name: &'static str,
    /// Number of integers, 3 for a point or a colour.
    pub elements: u32,
    /// Bits of one integer: 1 to 32.
    pub bits: u32,
    /// The integers are two's complement.
    pub is_signed: bool,
    /// The field begins with an octet, else with the bit behind the field before.
    pub begins_octet: bool,
    /// Description of the field, with its format.
    pub holds: &'static str,
}

impl Field {
    /// Octets of the whole field, the last one perhaps in part.
    pub const fn octets(&self) -> u32 {
        (self.elements * self.bits).div_ceil(8)
    }
}

const fn unsigned(name: &'static str, octets: u32, holds: &'static str) -> Field {
    Field { name, elements: 1, bits: 8 * octets, is_signed: false, begins_octet: true, holds }
}

const fn signed(name: &'static str, elements: u32, octets: u32, holds: &'static str) -> Field {
    Field { name, elements, bits: 8 * octets, is_signed: true, begins_octet: true, holds }
}

/// A structure in memory: its fields one after another without gaps, from the lowest bit of an octet to its highest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Structure {
    /// Name as kernels write it.
    pub name: &'static str,
    /// The fields in the order of their addresses.
    pub fields: Cow<'static, [Field]>,
}

impl Structure {
    /// Octets of the structure, the last one perhaps in part.
    pub fn octets(&self) -> u32 {
        let end = self.places().last().map_or(0, |(start, field)| start + field.elements * field.bits);
        end.div_ceil(8)
    }

    /// The fields, each with the bit at which it begins.
    pub fn places(&self) -> impl Iterator<Item = (u32, &Field)> {
        self.fields.iter().scan(0u32, |next, field| {
            let start = if field.begins_octet { next.next_multiple_of(8) } else { *next };
            *next = start + field.elements * field.bits;
            Some((start, field))
        })
    }

    /// Offset of the octet in which the field `name` begins.
    pub fn offset(&self, name: &str) -> Option<u32> {
        self.places().find(|(_, field)| field.name == name).map(|(start, _)| start / 8)
    }

    /// Structure of the same fields in words of 32 bits, as a core's buffer has them.
    pub fn in_words(&self) -> Structure {
        let word = |&field: &Field| Field { bits: 32, begins_octet: true, ..field };
        Structure { name: self.name, fields: self.fields.iter().map(word).collect() }
    }

    /// Writes one structure: the integers of all its fields in order.
    ///
    /// They have to be as many as the fields hold and to fit them; this is the caller's to see to, and checked in debug builds.
    pub fn write(&self, octets: &mut [u8], values: impl IntoIterator<Item = i64>) {
        let mut values = values.into_iter();
        for (start, field) in self.places() {
            for element in 0..field.elements {
                // Too few values leave zeros, for fields that a node does not use; too many are a mistake.
                let value = values.next().unwrap_or(0);
                debug_assert!(field.fits(value), "{} of {} does not hold {value}", field.name, self.name);
                put_bits(octets, (start + element * field.bits) as usize, field.bits, value);
            }
        }
        debug_assert!(values.next().is_none(), "too many values for {}", self.name);
    }

    /// The integers of all fields in order, `None` when `octets` is shorter than the structure.
    pub fn read(&self, octets: &[u8]) -> Option<Vec<i64>> {
        let octets = octets.get(..self.octets() as usize)?;
        let element = |start: u32, field: &Field| bits_at(octets, start as usize, field.bits, field.is_signed);
        let fields = self.places().flat_map(|(start, field)| {
            (0..field.elements).map(move |number| element(start + number * field.bits, field))
        });
        Some(fields.collect())
    }
}

impl Field {
    /// Each integer of the field can be `value`.
    pub fn fits(&self, value: i64) -> bool {
        let (low, high) =
            if self.is_signed { (-(1 << (self.bits - 1)), 1 << (self.bits - 1)) } else { (0, 1 << self.bits) };
        (low..high).contains(&value)
    }
}

/// All structures of an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StructureSet {
    /// A node of the kd tree.
    pub node: Structure,
    /// An element of a leaf's list of triangles.
    pub reference: Structure,
    /// A triangle.
    pub triangle: Structure,
    /// A material.
    pub material: Structure,
    /// A light.
    pub light: Structure,
    /// A pixel of the frame.
    pub pixel: Structure,
}

impl StructureSet {
    /// All of them.
    pub fn all(&self) -> [&Structure; 6] {
        [&self.node, &self.reference, &self.triangle, &self.material, &self.light, &self.pixel]
    }

    /// The structures with lights that have steps of their own.
    pub fn with_far_lights(self) -> StructureSet {
        // In the layout `packed` all numbers of a light have as many bits.
        let (bits, begins_octet) =
            self.light.fields.first().map_or((32, true), |field| (field.bits, field.begins_octet));
        let field = |&field: &Field| Field { bits, begins_octet, ..field };
        let light = Structure { name: FAR_LIGHT.name, fields: FAR_LIGHT.fields.iter().map(field).collect() };
        StructureSet { light, ..self }
    }
}

/// Layout of triangles and tree in memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Layout {
    /// The report's structures bit for bit (Annex I): coordinates of 16 bits, nodes with box and `next`, references as linked lists.
    Report,
    /// Coordinates of 32 bits, nodes of 8 octets, references as arrays.
    #[default]
    Wide,
    /// As `Wide`; behind the references of a leaf stand the vertices of its triangles, so that one transfer brings all that a ray meets there.
    Packet,
    /// As `Wide` in as few bits as scene and tree allow: fields begin and end within octets, and rows of the bus unpack them.
    Packed,
}

impl Layout {
    /// All of them, in the order of their declaration.
    pub const ALL: [Layout; 4] = [Layout::Report, Layout::Wide, Layout::Packet, Layout::Packed];

    /// Name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Layout::Report => "report",
            Layout::Wide => "wide",
            Layout::Packet => "packet",
            Layout::Packed => "packed",
        }
    }

    /// All structures of an image, in the layout `packed` with fields of these widths.
    pub fn structures(self, widths: &FieldWidths) -> StructureSet {
        let [node, reference, triangle] = match self {
            Layout::Report => [&REPORT_NODE, &REPORT_REFERENCE, &REPORT_TRIANGLE],
            Layout::Wide | Layout::Packet => [&WIDE_NODE, &WIDE_REFERENCE, &WIDE_TRIANGLE],
            Layout::Packed => return widths.structures(),
        }
        .map(Structure::clone);
        let [material, light, pixel] = [&MATERIAL, &LIGHT, &PIXEL].map(Structure::clone);
        StructureSet { node, reference, triangle, material, light, pixel }
    }

    /// All structures of an image whose widths no scene decides: those of each layout but `packed`.
    pub fn fixed_structures(self) -> StructureSet {
        self.structures(&FieldWidths::WORDS)
    }

    /// Octets that stand in a leaf for each of its triangles beside its reference: in packets the vertices.
    pub const fn octets_beside_reference(self) -> u32 {
        match self {
            Layout::Report | Layout::Wide | Layout::Packed => 0,
            Layout::Packet => 4 * PACKET_COMPONENTS,
        }
    }

    /// Bits by which a raw coordinate is shifted right (rounded to nearest, ties up) when it is stored, and left when it is loaded.
    pub const fn coordinate_shift(self, word: u32) -> u32 {
        match self {
            Layout::Report => word.saturating_sub(16),
            Layout::Wide | Layout::Packet | Layout::Packed => 0,
        }
    }
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Layout {
    type Err = Box<Diagnostic>;

    fn from_str(name: &str) -> Result<Layout, Box<Diagnostic>> {
        Layout::ALL.into_iter().find(|layout| layout.name() == name).ok_or_else(|| {
            let names = Layout::ALL.map(Layout::name);
            let hint = did_you_mean(name, names).unwrap_or_else(|| format!("the layouts are {}", names.join(", ")));
            Box::new(Diagnostic::error(format!("`{name}` is no memory layout")).hint(hint))
        })
    }
}

/// Components of the three vertices of a triangle of a packet, each a word of 32 bits in an array of its own.
pub const PACKET_COMPONENTS: u32 = 9;

/// Nodes of the top of the tree that stand level by level in the layout `packet`: the root and whole pairs of children.
pub const TOP_NODES: u32 = 1023;

/// Nodes of a block below the top in the layout `packet`, at most.
pub const BLOCK_NODES: u32 = 8;

/// Tags in the low bits of `link` of a wide node: the axis of an inner node, or this for a leaf.
pub const WIDE_LEAF: u32 = 3;

static REPORT_TRIANGLE: Structure = Structure {
    name: "triangle",
    fields: Cow::Borrowed(&[
        signed("v1", 3, 2, "first vertex: position >> (word - 16), rounded"),
        signed("v2", 3, 2, "second vertex"),
        signed("v3", 3, 2, "third vertex"),
        signed("small", 3, 2, "smallest coordinates of the three"),
        signed("big", 3, 2, "largest coordinates of the three"),
        unsigned("material_id", 1, "number of the material"),
    ]),
};

static REPORT_NODE: Structure = Structure {
    name: "node",
    fields: Cow::Borrowed(&[
        unsigned("left", 4, "address of the left child, 0 for a leaf"),
        unsigned("right", 4, "address of the right child, 0 for a leaf"),
        unsigned("next", 4, "address of the next node of the level, 0 for the last"),
        unsigned("trig", 4, "address of a leaf's first reference, 0 when it has none"),
        unsigned("pnum", 2, "number of triangles of a leaf"),
        signed("x0", 3, 2, "the box's corner on the face of small x: position >> (word - 16)"),
        signed("x1", 3, 2, "the box's corner on the face of large x"),
        signed("y0", 3, 2, "the box's corner on the face of small y"),
        signed("y1", 3, 2, "the box's corner on the face of large y"),
        signed("z0", 3, 2, "the box's corner on the face of small z"),
        signed("z1", 3, 2, "the box's corner on the face of large z"),
        unsigned(
            "split",
            1,
            "axis that divides the children: 0, 1, 2 (0 in a leaf); the plane is the left child's face",
        ),
    ]),
};

static REPORT_REFERENCE: Structure = Structure {
    name: "reference",
    fields: Cow::Borrowed(&[
        unsigned("triangle", 4, "address of a triangle"),
        unsigned("next", 4, "address of the next reference, 0 for the last"),
    ]),
};

static WIDE_TRIANGLE: Structure = Structure {
    name: "triangle",
    fields: Cow::Borrowed(&[
        signed("v0", 3, 4, "first vertex: position"),
        signed("v1", 3, 4, "second vertex"),
        signed("v2", 3, 4, "third vertex"),
        unsigned("material_id", 2, "number of the material"),
    ]),
};

static WIDE_NODE: Structure = Structure {
    name: "node",
    fields: Cow::Borrowed(&[
        signed("plane", 1, 4, "inner: coordinate of the dividing plane, a position; leaf: number of triangles"),
        unsigned(
            "link",
            4,
            "inner: address of the left child, a multiple of 8, plus the axis 0, 1, 2; the right child is 8 octets on; \
                  leaf: address of the first reference, a multiple of 4, plus 3",
        ),
    ]),
};

static WIDE_REFERENCE: Structure =
    Structure { name: "reference", fields: Cow::Borrowed(&[unsigned("triangle", 4, "address of a triangle")]) };

/// A material, in all layouts but `packed`.
pub static MATERIAL: Structure = Structure {
    name: "material",
    fields: Cow::Borrowed(&[
        signed("colour", 3, 4, "red, green, blue: weight"),
        signed("reflection", 1, 4, "ks: weight"),
        signed("intensity", 1, 4, "kd: weight"),
        signed("transmission", 1, 4, "kt: weight, 0 for an opaque material"),
        signed("index", 1, 4, "index of refraction: index, 0 for an opaque material"),
        signed(
            "inverse_index",
            1,
            4,
            "1 / index of refraction, the ratio for a ray that enters: index, 0 for an opaque material",
        ),
    ]),
};

/// A light of a scene in which all are near, in all layouts but `packed`.
pub static LIGHT: Structure = Structure {
    name: "light",
    fields: Cow::Borrowed(&[
        signed("position", 3, 4, "where it stands: position"),
        signed("colour", 3, 4, "red, green, blue: colour"),
    ]),
};

/// A light of a scene in which one has steps of its own.
pub static FAR_LIGHT: Structure = Structure {
    name: "light",
    fields: Cow::Borrowed(&[
        signed("position", 3, 4, "where it stands, in steps of 2^n units: position"),
        signed("colour", 3, 4, "red, green, blue: colour"),
        signed("scale", 1, 4, "2^-n, by which a point is multiplied to have such steps: direction"),
    ]),
};

/// A pixel of the frame in all layouts: three words, row 0 first.
pub static PIXEL: Structure =
    Structure { name: "pixel", fields: Cow::Borrowed(&[signed("colour", 3, 4, "red, green, blue: colour")]) };

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn structures_have_the_sizes_of_annex_one() {
        let sizes = |layout: Layout| {
            let StructureSet { triangle, node, reference, .. } = layout.fixed_structures();
            [triangle, node, reference].map(|structure| structure.octets())
        };
        assert_eq!(sizes(Layout::Report), [31, 55, 8]);
        assert_eq!(sizes(Layout::Wide), [38, 8, 4]);
        assert_eq!(Layout::ALL.map(Layout::octets_beside_reference), [0, 0, 36, 0]);
        assert_eq!([&MATERIAL, &LIGHT, &FAR_LIGHT, &PIXEL].map(Structure::octets), [32, 24, 28, 12]);
    }

    #[test]
    fn fields_lie_where_the_annex_has_them() {
        let node = Layout::Report.fixed_structures().node;
        let offsets: Vec<_> = node.places().map(|(start, field)| (field.name, start / 8)).collect();
        let expected = [
            ("left", 0),
            ("right", 4),
            ("next", 8),
            ("trig", 12),
            ("pnum", 16),
            ("x0", 18),
            ("x1", 24),
            ("y0", 30),
            ("y1", 36),
            ("z0", 42),
            ("z1", 48),
            ("split", 54),
        ];
        assert_eq!(offsets, expected);
        assert_eq!(Layout::Report.fixed_structures().triangle.offset("material_id"), Some(30));
        assert_eq!(Layout::Wide.fixed_structures().triangle.offset("material_id"), Some(36));
        assert_eq!(node.offset("middle"), None);
    }

    #[test]
    fn names_are_different_within_a_structure() {
        let sets = Layout::ALL.map(Layout::fixed_structures);
        for structure in sets.iter().flat_map(StructureSet::all) {
            let mut names: Vec<_> = structure.fields.iter().map(|field| field.name).collect();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), structure.fields.len(), "{}", structure.name);
        }
    }

    #[test]
    fn what_is_written_is_read_again() {
        let triangle = Layout::Report.fixed_structures().triangle;
        let values: Vec<i64> = (0..15).map(|k| (k - 7) * 4681).chain([255]).collect();
        let mut octets = [0xaa; 33];
        triangle.write(&mut octets, values.iter().copied());
        assert_eq!(octets[..4], [0x01, 0x80, 0x4a, 0x92], "little-endian, two's complement");
        assert_eq!(octets[31..], [0xaa; 2]);
        assert_eq!(triangle.read(&octets), Some(values));
        assert_eq!(triangle.read(&octets[..30]), None);
    }

    #[test]
    fn layouts_have_names() {
        for layout in Layout::ALL {
            assert_eq!(layout.name().parse(), Ok(layout));
        }
        assert!("wde".parse::<Layout>().unwrap_err().to_string().contains("did you mean `wide`?"));
    }
}
