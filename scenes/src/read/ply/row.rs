//! One element of a PLY file: the properties that are used here, wherever they come from.

use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult, ScalarType};

/// Names of the list of a face's corners.
pub(super) const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Names of a position's coordinates.
pub(super) const POSITION: [&str; 3] = ["x", "y", "z"];

/// Names of a colour's components.
pub(super) const COLOUR: [[&str; 2]; 3] =
    [["red", "diffuse_red"], ["green", "diffuse_green"], ["blue", "diffuse_blue"]];

/// Place of a property in a [`ElementRow`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PropertySlot {
    /// Coordinate 0 to 2.
    Position(usize),
    /// Component 0 to 2 of a colour.
    Colour(usize),
    /// The list of vertices.
    Corners,
    /// None: the property is not used.
    Unused,
}

impl PropertySlot {
    /// The place of a property of this name.
    pub(super) fn of(name: &str) -> PropertySlot {
        if let Some(k) = POSITION.iter().position(|&axis| axis == name) {
            PropertySlot::Position(k)
        } else if let Some(k) = COLOUR.iter().position(|names| names.contains(&name)) {
            PropertySlot::Colour(k)
        } else if CORNERS.contains(&name) {
            PropertySlot::Corners
        } else {
            PropertySlot::Unused
        }
    }
}

/// Parts of an element that are used.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ElementRow {
    /// Coordinates of a vertex.
    pub position: [f64; 3],
    /// Components of a colour, 0..1 as whole-number types have them.
    pub colour: [Option<f64>; 3],
    /// Vertices of a face by number, or of a strip.
    pub corners: Vec<i64>,
}

impl ElementRow {
    /// Forgets the last element.
    pub(super) fn clear(&mut self) {
        self.position = [0.0; 3];
        self.colour = [None; 3];
        self.corners.clear();
    }

    /// Takes a number of a type.
    pub(super) fn set(&mut self, slot: PropertySlot, value: f64, kind: &ScalarType) {
        match slot {
            PropertySlot::Position(k) => self.position[k] = value,
            PropertySlot::Colour(k) => self.colour[k] = Some(value / full(kind)),
            PropertySlot::Corners | PropertySlot::Unused => {}
        }
    }
}

/// The value of a type that is full strength in a colour.
fn full(kind: &ScalarType) -> f64 {
    match kind {
        ScalarType::Char => 127.0,
        // Nobody's colours have 32 bits; programs that declare so mean octets.
        ScalarType::UChar | ScalarType::Int | ScalarType::UInt => 255.0,
        ScalarType::Short => 32_767.0,
        ScalarType::UShort => 65_535.0,
        ScalarType::Float | ScalarType::Double => 1.0,
    }
}

/// A number of any type.
fn scalar(property: &Property) -> Option<(f64, ScalarType)> {
    Some(match *property {
        Property::Char(value) => (value.into(), ScalarType::Char),
        Property::UChar(value) => (value.into(), ScalarType::UChar),
        Property::Short(value) => (value.into(), ScalarType::Short),
        Property::UShort(value) => (value.into(), ScalarType::UShort),
        Property::Int(value) => (value.into(), ScalarType::Int),
        Property::UInt(value) => (value.into(), ScalarType::UInt),
        Property::Float(value) => (value.into(), ScalarType::Float),
        Property::Double(value) => (value, ScalarType::Double),
        _ => return None,
    })
}

/// Whole numbers of any type; `None` for others.
fn list(property: &Property) -> Option<Vec<i64>> {
    fn wide<T: Copy + Into<i64>>(values: &[T]) -> Option<Vec<i64>> {
        Some(values.iter().map(|&value| value.into()).collect())
    }
    match property {
        Property::ListChar(values) => wide(values),
        Property::ListUChar(values) => wide(values),
        Property::ListShort(values) => wide(values),
        Property::ListUShort(values) => wide(values),
        Property::ListInt(values) => wide(values),
        Property::ListUInt(values) => wide(values),
        _ => None,
    }
}

/// The library `ply-rs-bw` hands over the properties of binary files.
impl PropertyAccess for ElementRow {
    fn new() -> ElementRow {
        ElementRow::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        match (scalar(&property), PropertySlot::of(name)) {
            (Some((value, kind)), slot) => self.set(slot, value, &kind),
            (None, PropertySlot::Corners) => self.corners = list(&property).unwrap_or_default(),
            (None, _) => {}
        }
        PropertyAccessResult::Set
    }
}
