//! One element of a PLY file: where the library `ply-rs-bw` puts the properties that are used here. It drops the others.

use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

/// Names of the list of a face's corners.
pub(super) const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Names of a position's coordinates.
pub(super) const POSITION: [&str; 3] = ["x", "y", "z"];

/// Names of a colour's components.
pub(super) const COLOUR: [[&str; 2]; 3] =
    [["red", "diffuse_red"], ["green", "diffuse_green"], ["blue", "diffuse_blue"]];

/// The used part of an element.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Row {
    /// Coordinates of a vertex.
    pub position: [f64; 3],
    /// Components of a colour, 0..1 as whole-number types have them.
    pub colour: [Option<f64>; 3],
    /// Vertices of a face by number, or of a strip.
    pub corners: Vec<i64>,
    /// Numbers that the element has, those of list lengths included.
    pub numbers: usize,
}

/// A number of any type, and the value of its type that is full strength in a colour.
fn scalar(property: &Property) -> Option<(f64, f64)> {
    Some(match *property {
        Property::Char(value) => (value.into(), 127.0),
        Property::UChar(value) => (value.into(), 255.0),
        Property::Short(value) => (value.into(), 32_767.0),
        Property::UShort(value) => (value.into(), 65_535.0),
        // Nobody's colours have 32 bits; programs that declare so mean octets.
        Property::Int(value) => (value.into(), 255.0),
        Property::UInt(value) => (value.into(), 255.0),
        Property::Float(value) => (value.into(), 1.0),
        Property::Double(value) => (value, 1.0),
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

/// Numbers of a list with its length.
fn length(property: &Property) -> usize {
    1 + match property {
        Property::ListFloat(values) => values.len(),
        Property::ListDouble(values) => values.len(),
        _ => list(property).map_or(0, |values| values.len()),
    }
}

impl PropertyAccess for Row {
    fn new() -> Row {
        Row::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some((value, full)) = scalar(&property) else {
            self.numbers += length(&property);
            if CORNERS.contains(&name) {
                self.corners = list(&property).unwrap_or_default();
            }
            return PropertyAccessResult::Set;
        };
        self.numbers += 1;
        if let Some(k) = POSITION.iter().position(|&axis| axis == name) {
            self.position[k] = value;
        } else if let Some(k) = COLOUR.iter().position(|names| names.contains(&name)) {
            self.colour[k] = Some(value / full);
        }
        PropertyAccessResult::Set
    }
}
