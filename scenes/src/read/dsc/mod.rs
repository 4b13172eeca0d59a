//! The `.dsc` reader (report 5.2): picture size, materials, lights and the material of each triangle. The mesh is in
//! another file; `join` brings both together.

mod colour;

use std::sync::Arc;

use messages::{Diagnostic, Place, Report, Source};

use self::colour::ColourScale;
use super::words::{Word, Words, counted};
use crate::model::{Light, Material};

/// Most pixels along one side of a picture.
const LARGEST: u32 = 65_535;

/// Contents of a `.dsc` file.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// Width and height of the picture in pixels.
    pub size: (u32, u32),
    /// The surfaces; colours in [0, 1].
    pub materials: Vec<Material>,
    /// The lights; colours in [0, 1].
    pub lights: Vec<Light>,
    /// The material of each triangle, by number.
    pub surfaces: Vec<u32>,
    /// Place of the number of triangles.
    pub count: Place,
    /// Warnings: what is likely a mistake.
    pub warnings: Report,
}

/// A count as the file announces it, and its word.
type WordedCount<'a> = (u32, Word<'a>);

/// The kind of a line of six numbers.
struct LineShape {
    name: &'static str,
    fields: [&'static str; 6],
}

const MATERIAL: LineShape =
    LineShape { name: "material", fields: ["red", "green", "blue", "reflection", "intensity", "index of refraction"] };
const LIGHT: LineShape = LineShape { name: "light", fields: ["x", "y", "z", "red", "green", "blue"] };

/// Reads a `.dsc` text. `#` starts a comment and words may be spread over lines, except that a material or light which
/// begins a line has that line for itself: a missing number would otherwise shift all that follow.
///
/// Errors: anything that is not as report 5.2 has it, several at once where it stays clear what follows.
pub fn parse(source: &Arc<Source>) -> Result<Description, Report> {
    let mut words = Words::new(source, if source.text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 });
    let description = read(&mut words);
    let has_errors = words.has_errors();
    let report = words.into_report();
    match description {
        Some(description) if !has_errors => Ok(Description { warnings: report, ..description }),
        _ => Err(report),
    }
}

/// Reads on as long as it is clear what must follow; `None` when it no longer is.
fn read(words: &mut Words<'_>) -> Option<Description> {
    keyword(words)?;
    let size = (side(words, "the picture's width")?, side(words, "the picture's height")?);
    let (materials, lights) = (count(words, "materials")?, count(words, "lights")?);
    // Six numbers take 12 octets at least, a digit and a gap each, so absurd counts are refused before anything is read.
    words.room(materials.0, materials.1, "materials", 12)?;
    words.room(lights.0, lights.1, "lights", 12)?;

    let mut colours = ColourScale::default();
    let mut surfaces = Vec::new();
    for n in 0..materials.0 {
        if let Some((values, at)) = six(words, &MATERIAL, n, materials)? {
            let [red, green, blue, reflection, intensity, index] = values;
            colours.note(words, [0, 1, 2].map(|k| (values[k], at[k])));
            let material = Material { colour: [red, green, blue], reflection, intensity, index };
            check_material(words, n, &material, at);
            surfaces.push(material);
        }
    }
    let mut lamps = Vec::new();
    for n in 0..lights.0 {
        if let Some((values, at)) = six(words, &LIGHT, n, lights)? {
            let [x, y, z, red, green, blue] = values;
            colours.note(words, [3, 4, 5].map(|k| (values[k], at[k])));
            lamps.push(Light { position: [x, y, z], colour: [red, green, blue] });
        }
    }
    // Scale all colours once the last light is read: one component above 1 makes the whole file 0..255
    let largest = colours.largest(words);
    surfaces.iter_mut().for_each(|material| material.colour = material.colour.map(|c| c / largest));
    lamps.iter_mut().for_each(|light| light.colour = light.colour.map(|c| c / largest));

    is_not_a_light(words, materials, lights)?;
    let triangles = count(words, "triangles")?;
    let room = words.room(triangles.0, triangles.1, "triangles", 2)?;
    let of_triangles = triangle_materials(words, triangles, materials, room)?;
    if let Some(word) = words.next() {
        let message = format!("the file goes on after the materials of its {} triangles", triangles.0);
        let error = Diagnostic::error(message).at(words.place(word.span()), "nothing more is expected");
        words.complain(error.also(words.place(triangles.1.span()), "the triangles are counted here"));
    }
    if lights.0 == 0 && triangles.0 > 0 {
        let place = words.place(lights.1.span());
        words.complain(Diagnostic::warning("without a light only ambient light is seen").at(place, "no lights"));
    }
    let count = words.place(triangles.1.span());
    Some(Description {
        size,
        materials: surfaces,
        lights: lamps,
        surfaces: of_triangles,
        count,
        warnings: Report::default(),
    })
}

fn keyword(words: &mut Words<'_>) -> Option<()> {
    let Some(word) = words.next() else {
        return cut(words, "before its first word, `DSC`", None);
    };
    if word.text == "DSC" {
        return Some(());
    }
    let hint = match word.text {
        text if text.eq_ignore_ascii_case("dsc") => "write it in capitals",
        text if text.to_ascii_uppercase().contains("OFF") => "this looks like a mesh: its name should end in .off",
        _ => "the first line is `DSC`, the second the picture's width and height in pixels",
    };
    let place = words.place(word.span());
    words.complain(Diagnostic::error("a scene description starts with `DSC`").at(place, "not `DSC`").hint(hint));
    None
}

/// One side of the picture in pixels.
fn side(words: &mut Words<'_>, what: &str) -> Option<u32> {
    let Some(word) = words.next() else {
        return cut(words, &format!("before {what}"), None);
    };
    let pixels = words.whole(word, || format!("{what} in pixels"))?;
    if !(1..=LARGEST).contains(&pixels) {
        words.refuse(word, format!("{what} must be 1 to {LARGEST} pixels"), format!("{pixels} pixels"));
    }
    Some(pixels)
}

/// The number of `what`, with its word.
fn count<'a>(words: &mut Words<'a>, what: &str) -> Option<WordedCount<'a>> {
    let Some(word) = words.next() else {
        return cut(words, &format!("before the number of {what}"), None);
    };
    Some((words.whole(word, || format!("the number of {what}"))?, word))
}

/// Refuses another line of six numbers where the number of triangles is expected: a count before is too small.
fn is_not_a_light(words: &mut Words<'_>, materials: WordedCount<'_>, lights: WordedCount<'_>) -> Option<()> {
    let at = words.position();
    let first = words.next();
    let (in_line, end) = first.map_or((0, at), |first| words.rest_of_line(first));
    words.seek(at);
    // "5 0 0 0 0 0" is the number of triangles and all their materials.
    let Some(first) = first.filter(|&word| words.starts_line(word) && in_line == 6 && word.text != "5") else {
        return Some(());
    };
    let place = words.place(first.start..end);
    let error = Diagnostic::error("expected the number of triangles, found another line of six numbers")
        .at(place, "a light or material too many")
        .also(words.place(materials.1.start..lights.1.span().end), "the numbers of materials and lights");
    words.complain(error);
    None
}

/// The six numbers of a material or light. `None`: it is no longer clear what follows. `Some(None)`: this one is not
/// usable, but the next may be.
fn six<'a>(
    words: &mut Words<'a>,
    shape: &LineShape,
    n: u32,
    announced: WordedCount<'a>,
) -> Option<Option<([f64; 6], [Word<'a>; 6])>> {
    let name = shape.name;
    let Some(first) = words.next() else {
        return cut(words, &format!("after {n} of {} {name}s", announced.0), Some((announced.1, name)));
    };
    let (in_line, end) = words.rest_of_line(first);
    if words.starts_line(first) && in_line != 6 {
        words.seek(end);
        if in_line < 6 && words.is_at_end() {
            return cut(words, &format!("within {name} {n}"), Some((announced.1, name)));
        }
        let message = format!("{name} {n} should have 6 numbers on its line");
        let place = words.place(first.start..end);
        let error = Diagnostic::error(message)
            .at(place, format!("{in_line} here"))
            .also(words.place(announced.1.span()), format!("the number of {name}s"))
            .hint(format!("a {name} is: {}", shape.fields.join(", ")));
        words.complain(error);
        // A line with one or two numbers is likely the count that follows, or a list of materials: not to be skipped.
        return if in_line > 2 { Some(None) } else { None };
    }
    let mut at = [first; 6];
    for slot in &mut at[1..] {
        match words.next() {
            Some(word) => *slot = word,
            None => return cut(words, &format!("within {name} {n}"), Some((announced.1, name))),
        }
    }
    let mut values = [0.0; 6];
    for (k, value) in values.iter_mut().enumerate() {
        *value = words.number(at[k], || format!("{} of {name} {n}", shape.fields[k]));
    }
    if words.is_lost() {
        return None;
    }
    Some(Some((values, at)))
}

/// Refuses coefficients that no surface has, and warns of unlikely ones.
fn check_material(words: &mut Words<'_>, n: u32, material: &Material, at: [Word<'_>; 6]) {
    for (value, word, name) in
        [(material.reflection, at[3], MATERIAL.fields[3]), (material.intensity, at[4], MATERIAL.fields[4])]
    {
        if !(0.0..=1.0).contains(&value) {
            words.refuse(word, format!("{name} of material {n} must be 0 to 1"), "out of range");
        }
    }
    let sum = material.reflection + material.intensity;
    // A sum such as 0.7 + 0.3 may be off by a rounding.
    if sum > 1.0 + 1e-9 && material.reflection <= 1.0 && material.intensity <= 1.0 {
        let place = words.place(at[3].start..at[4].span().end);
        let message = format!("material {n} gives back more light than it receives");
        words.complain(Diagnostic::warning(message).at(place, format!("reflection + intensity = {sum}")));
    }
    if material.index < 0.0 {
        words.refuse(at[5], format!("index of refraction of material {n} must not be negative"), "negative");
    } else if material.index > 0.0 && material.index < 1.0 {
        let place = words.place(at[5].span());
        let message = format!("material {n} bends light as if it were thinner than the void");
        words.complain(Diagnostic::warning(message).at(place, "between 0 (opaque) and 1 (the void)"));
    }
}

/// The material of each triangle.
fn triangle_materials(
    words: &mut Words<'_>,
    triangles: WordedCount<'_>,
    materials: WordedCount<'_>,
    room: usize,
) -> Option<Vec<u32>> {
    let mut list = Vec::with_capacity(room);
    let mut first_beyond = None;
    let mut beyond = 0;
    for n in 0..triangles.0 {
        let Some(word) = words.next() else {
            let place = format!("after the materials of {n} of {} triangles", triangles.0);
            return cut(words, &place, Some((triangles.1, "triangle")));
        };
        let number = words.whole(word, || format!("the material of triangle {n}"));
        // Collect what is out of range for one message: with a wrong count of materials that may be thousands of triangles
        if let Some(number) = number.filter(|&number| number >= materials.0) {
            first_beyond.get_or_insert((n, number, word));
            beyond += 1;
        }
        // 0 stands for a word that is no number: it has its complaint, so the list will not be used.
        list.push(number.unwrap_or(0));
        if words.is_lost() {
            return None;
        }
    }
    if let Some((n, number, word)) = first_beyond {
        let known = match materials.0 {
            0 => "there are none".to_string(),
            1 => "there is only material 0".to_string(),
            count => format!("there are only 0 to {}", count - 1),
        };
        let mut message = format!("triangle {n} has material {number}, but {known}");
        if beyond > 1 {
            message.push_str(&format!("; {} out of range too", counted(beyond - 1, "other is", "others are")));
        }
        let error = Diagnostic::error(message).at(words.place(word.span()), "no such material");
        words.complain(error.also(words.place(materials.1.span()), "the number of materials"));
    }
    Some(list)
}

/// Says that the file ends too early; `announced` is the count that promised more, and of what.
fn cut<T>(words: &mut Words<'_>, place: &str, announced: Option<(Word<'_>, &str)>) -> Option<T> {
    let mut error = Diagnostic::error(format!("the file ends {place}")).at(words.end(), "the end");
    if let Some((word, name)) = announced {
        error = error.also(words.place(word.span()), format!("the number of {name}s"));
    }
    words.complain(error);
    None
}
