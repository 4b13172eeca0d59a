//! The binary form of OFF: after the line of the header, 32-bit integers and floating-point numbers, the most
//! significant octet first. Each face is followed by the number of its colour components.

use messages::Diagnostic;
use nom::number::complete::{be_f32, be_u32};
use nom::{IResult, Parser};

use super::super::colour::{Spec, Writing};
use super::super::faces::Faces;
use super::super::mesh::Mesh;
use super::super::words::{Words, counted};
use super::header::{BinaryPart, DIMENSIONS, Header};
use super::position;
use crate::model::Vec3;

/// Octets at the start of a file in which a binary file's header must end.
pub(super) const HEAD: usize = 4096;

/// The word `BINARY` is near the start of a file.
pub(super) fn is_likely(bytes: &[u8]) -> bool {
    bytes[..bytes.len().min(HEAD)].windows(6).any(|six| six == b"BINARY")
}

/// Reads the part that follows the header in `words`; `None` after a complaint.
pub(super) fn read(bytes: &[u8], header: &Header, binary: BinaryPart, words: &mut Words<'_>) -> Option<Mesh> {
    let source = words.place(0..0).source;
    // Comments before may hold octets that are not text, and have another length there: lines are the same.
    let lines = source.text[..binary.start].matches('\n').count();
    let start =
        bytes.iter().enumerate().filter(|&(_, &octet)| octet == b'\n').nth(lines - 1).map_or(0, |(at, _)| at + 1);
    let mut numbers = BinaryNumbers { rest: &bytes[start..], all: bytes };
    match body(&mut numbers, header, binary, &source.name) {
        Ok(mesh) => Some(mesh),
        Err(message) => {
            let place = words.place(binary.word.0..binary.word.1);
            words.complain(Diagnostic::error(message).at(place, "binary from the next line on"));
            None
        }
    }
}

/// The rest of the binary part.
struct BinaryNumbers<'a> {
    rest: &'a [u8],
    all: &'a [u8],
}

impl BinaryNumbers<'_> {
    /// Offset of the next number in the file.
    fn at(&self) -> usize {
        self.all.len() - self.rest.len()
    }

    /// Offset of the number that was read last.
    fn before(&self) -> usize {
        self.at() - 4
    }

    fn whole(&mut self, what: impl Fn() -> String) -> Result<u32, String> {
        let parsed: IResult<&[u8], u32> = be_u32.parse(self.rest);
        let (rest, value) =
            parsed.map_err(|_| format!("the file ends at octet {} before {}", self.all.len(), what()))?;
        if value > i32::MAX as u32 {
            let (least, other) = (value as i32, value.swap_bytes());
            let likely =
                if other < 1 << 24 { format!("; the least octet first it would be {other}") } else { String::new() };
            return Err(format!("{} cannot be {least} (octet {}){likely}", what(), self.at()));
        }
        self.rest = rest;
        Ok(value)
    }

    fn real(&mut self, what: impl Fn() -> String) -> Result<f64, String> {
        let parsed: IResult<&[u8], f32> = be_f32.parse(self.rest);
        let (rest, value) =
            parsed.map_err(|_| format!("the file ends at octet {} before {}", self.all.len(), what()))?;
        self.rest = rest;
        Ok(f64::from(value))
    }

    /// The next number, refused where it is not finite.
    fn finite(&mut self, what: impl Fn() -> String) -> Result<f64, String> {
        let value = self.real(&what)?;
        if !value.is_finite() {
            return Err(format!("{} must be a finite number, not {value} (octet {})", what(), self.before()));
        }
        Ok(value)
    }

    /// There is room for `count` things of at least `octets` each; somewhat too many pass, as in `Words::room`.
    fn room(&self, count: u32, octets: usize, what: &str) -> Result<usize, String> {
        let most = self.rest.len() / octets;
        if count as usize / 16 <= most {
            return Ok(most.min(count as usize));
        }
        let other = count.swap_bytes() as usize;
        let hint = if other <= most { format!("; the least octet first it would be {other}") } else { String::new() };
        let room = format!("the rest of the file, from octet {} on, has room for {most} at most", self.at());
        Err(format!("{count} {what} are announced, but {room}{hint}"))
    }
}

fn body(numbers: &mut BinaryNumbers<'_>, header: &Header, binary: BinaryPart, name: &str) -> Result<Mesh, String> {
    let mut header = *header;
    if binary.has_dimension {
        let dimension = numbers.whole(|| "the dimension".to_string())?;
        if !(1..=DIMENSIONS).contains(&dimension) {
            let at = numbers.before();
            return Err(format!("the dimension must be 1 to {DIMENSIONS}, not {dimension} (octet {at})"));
        }
        header.components = dimension as usize + usize::from(header.is_homogeneous);
    }
    let points = numbers.whole(|| "the number of vertices".to_string())?;
    let polygons = numbers.whole(|| "the number of faces".to_string())?;
    numbers.whole(|| "the number of edges".to_string())?;
    let row_length = header.components
        + 3 * usize::from(header.has_normals)
        + 4 * usize::from(header.has_colours)
        + 2 * usize::from(header.has_texture);
    let mut vertices: Vec<Vec3> = Vec::with_capacity(numbers.room(points, 4 * row_length, "vertices")?);
    let mut row = vec![0.0; row_length];
    for n in 0..points {
        for (k, slot) in row.iter_mut().enumerate() {
            let what = || format!("a number of vertex {n} of {points}");
            // As in text, what is not used may be anything.
            let is_used = k < 3.min(header.components) || header.is_homogeneous && k + 1 == header.components;
            *slot = if is_used { numbers.finite(what)? } else { numbers.real(what)? };
        }
        let point = position(&header, &row[..header.components]);
        let at = numbers.before();
        vertices.push(point.ok_or_else(|| format!("vertex {n} lies at infinity: its last number is 0 (octet {at})"))?);
    }
    let mut faces = Faces::with_room(numbers.room(polygons, 8, "faces")?);
    let mut corners = Vec::new();
    for n in 0..polygons {
        let size = numbers.whole(|| format!("the number of corners of face {n} of {polygons}"))?;
        corners.clear();
        for k in 0..size {
            let number = numbers.whole(|| format!("corner {} of the {size} of face {n}", k + 1))?;
            if number >= points {
                let (at, all) = (numbers.before(), counted(points as usize, "vertex", "vertices"));
                return Err(format!("face {n} has vertex {number} of {all}, counted from 0 (octet {at})"));
            }
            corners.push(number);
        }
        let components = numbers.whole(|| format!("the number of colour components of face {n}"))?;
        let mut values = [0.0; 4];
        let Some(values) = values.get_mut(..components as usize).filter(|values| values.len() != 2) else {
            let at = numbers.before();
            return Err(format!("face {n} has {components} colour components; a colour has 0, 1, 3 or 4 (octet {at})"));
        };
        for value in values.iter_mut() {
            *value = numbers.real(|| format!("a colour component of face {n}"))?;
        }
        let colour = match *values {
            [index] => Spec::Index(index),
            [red, green, blue] | [red, green, blue, _] => Spec::Components([red, green, blue], Writing::Decimal),
            _ => Spec::Default,
        };
        faces.push(&vertices, &corners, colour);
    }
    if !numbers.rest.is_empty() {
        let rest = counted(numbers.rest.len(), "octet follows", "octets follow");
        return Err(format!("{rest} the last face, from octet {} on", numbers.at()));
    }
    Ok(faces.into_mesh(name, vertices, None))
}

#[cfg(test)]
mod tests {
    use crate::read::off;

    /// The message about a triangle whose face has these numbers behind its corners.
    fn refusal(behind: &[u32], last_corner: u32) -> String {
        let mut bytes = b"OFF BINARY\n".to_vec();
        [3, 1, 0].iter().for_each(|count: &u32| bytes.extend(count.to_be_bytes()));
        [0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().for_each(|x| bytes.extend(x.to_be_bytes()));
        [3, 0, 1, last_corner].iter().chain(behind).for_each(|number| bytes.extend(number.to_be_bytes()));
        off::parse(bytes, "a.off").map_or_else(|report| report.render(false), |_| String::new())
    }

    #[test]
    fn messages_say_the_octet() {
        let one = 1f32.to_bits();
        assert_eq!(refusal(&[0], 2), "");
        assert_eq!(refusal(&[3, one, one, one], 2), "");
        for (behind, last_corner, message) in [
            (&[2, one, one][..], 2, "2 colour components; a colour has 0, 1, 3 or 4 (octet 75)"),
            (&[5, 0, 0, 0, 0, 0], 2, "5 colour components; a colour has 0, 1, 3 or 4 (octet 75)"),
            (&[0], 3, "face 0 has vertex 3 of 3 vertices, counted from 0 (octet 71)"),
            (&[0, 0], 2, "4 octets follow the last face, from octet 79 on"),
        ] {
            let shown = refusal(behind, last_corner);
            assert!(shown.contains(message), "{message}\n{shown}");
        }
    }
}
