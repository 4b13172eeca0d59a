//! The reader of Wavefront's `.obj` meshes: vertices, faces and the names of their materials. The materials themselves
//! are read in `material`, what has no counterpart in a scene is told in `lost`.

mod library;
mod lost;
mod material;
mod statement;

use std::borrow::Cow;
use std::collections::HashMap;

use messages::{Diagnostic, Report};

use self::lost::LostStatements;
use super::colour::Spec;
use super::faces::Faces;
use super::format::{Likelihood, MeshReader};
use super::mesh::{GREY, Mesh};
use super::words::{self, Word, Words, counted, shortened};
use crate::model::Vec3;

/// Opens a material library by the name that a `.obj` gives it: the path to show in messages, and its octets.
pub type Libraries<'l> = dyn FnMut(&str) -> Result<(String, Vec<u8>), Report> + 'l;

/// First words of OBJ files.
const STATEMENTS: [&str; 9] = ["v", "vn", "vt", "f", "o", "g", "s", "usemtl", "mtllib"];

/// The reader's row.
pub(super) static READER: MeshReader = MeshReader {
    extensions: &["obj"],
    sniff: |_, word| Likelihood::likely_if(STATEMENTS.contains(&word)),
    parse: |bytes, name, libraries| parse(bytes, name, libraries),
};

/// Reads an OBJ file; `name` is shown in messages, `libraries` opens material libraries. Without it materials are not
/// wanted: a `.dsc` has its own.
///
/// - Faces refer to vertices from 1 on, or by negative numbers back from the last; polygons are cut into triangles.
/// - Statements end with the line, unless it ends in a backslash.
/// - Texture positions, normals, curved shapes, points and lines are read over, with a warning.
///
/// Errors: several at once; a library that is missing is none.
pub fn parse<'a>(
    bytes: impl Into<Cow<'a, [u8]>>,
    name: &str,
    libraries: Option<&mut Libraries<'_>>,
) -> Result<Mesh, Report> {
    let bytes = bytes.into();
    messages::refuse_utf16(&bytes, name)?;
    let start = words::start(&bytes);
    let source = words::source(name, bytes);
    let mut words = Words::new(&source, start);
    let mut others = Report::default();
    let mesh = read(&mut words, name).map(|contents| contents.into_mesh(&mut words, name, libraries, &mut others));
    match words.finish(mesh) {
        Ok(_) if others.has_errors() => Err(others),
        Ok(mut mesh) => {
            mesh.warnings.0.append(&mut others.0);
            Ok(mesh)
        }
        Err(mut report) => {
            report.0.append(&mut others.0);
            Err(report)
        }
    }
}

/// Contents of the file. Faces may come before their vertices, so they are cut at the end.
#[derive(Default)]
struct ObjContents<'a> {
    vertices: Vec<Vec3>,
    /// Vertices of all faces by number from 0.
    corners: Vec<u32>,
    /// End of each face in `corners`, and its material by number in `names`.
    faces: Vec<(usize, Option<u32>)>,
    /// References to vertices that were not there yet, each with the face's number.
    ahead: Vec<(usize, u32, Word<'a>)>,
    /// Names of materials in the order of their first use.
    names: Vec<Word<'a>>,
    /// Names of material libraries.
    libraries: Vec<Word<'a>>,
}

fn read<'a>(words: &mut Words<'a>, name: &str) -> Option<ObjContents<'a>> {
    if words.is_at_end() && words.line_from(0).text.is_empty() {
        words.complain(Diagnostic::error("the file is empty").at(words.end(), "expected vertices and faces"));
        return None;
    }
    let mut contents = ObjContents::default();
    let mut lost = LostStatements::default();
    let mut numbers = HashMap::new();
    let mut material = None;
    let mut arguments = Vec::new();
    while let Some(keyword) = statement::next(words, &mut arguments) {
        let rest = || words.line_from(keyword.span().end);
        match keyword.text {
            "v" => {
                let vertex = vertex(words, contents.vertices.len() + 1, keyword, &arguments, &mut lost);
                contents.vertices.push(vertex);
            }
            "f" | "fo" => contents.face(words, keyword, &arguments, material),
            "usemtl" => {
                let word = rest();
                let next = contents.names.len() as u32;
                // Names are numbered at their first use, which keeps the materials in the order of the file.
                let number = *numbers.entry(word.text).or_insert(next);
                if number == next {
                    contents.names.push(word);
                }
                material = Some(number);
            }
            "mtllib" => contents.libraries.push(rest()),
            _ => lost.statement(keyword, &arguments),
        }
        if words.is_lost() {
            return None;
        }
    }
    lost.complain(words, name, contents.vertices.is_empty() && contents.faces.is_empty());
    contents.check_ahead(words).then_some(contents)
}

/// The position of vertex `number`, counted from 1.
fn vertex<'a>(
    words: &mut Words<'a>,
    number: usize,
    keyword: Word<'a>,
    arguments: &[Word<'a>],
    lost: &mut LostStatements<'a>,
) -> Vec3 {
    let count = arguments.len();
    // A weight, the components of a colour or all four may follow x, y, z: `v 1 2 3 0.5`, `v 1 2 3 1 0 0`, `v 1 2 3 0.5 1 0 0`
    if !matches!(count, 3 | 4 | 6 | 7) {
        let message = format!("vertex {number} should have 3 coordinates");
        let place = words.place(statement::span(keyword, arguments));
        let error = Diagnostic::error(message).at(place, counted(count, "number", "numbers"));
        words.complain(error.hint(match arguments.iter().any(|word| word.text.contains(',')) {
            true => "numbers are separated by blanks, not commas",
            false => "a weight or the 3 components of a colour may follow x, y, z",
        }));
        return Vec3::default();
    }
    let mut values = [0.0; 7];
    for (k, (value, word)) in values.iter_mut().zip(arguments).enumerate() {
        *value = match k {
            0..3 => words.number(*word, || format!("{} of vertex {number}", ["x", "y", "z"][k])),
            // No picture depends on these, so they need not be finite.
            _ => words.unused_number(*word, || format!("number {} of vertex {number}", k + 1)),
        };
    }
    if count >= 6 {
        lost.note(lost::COLOURS);
    }
    // A weight of 1 changes nothing, so nothing is lost with it.
    if (count == 4 || count == 7) && values[3] != 1.0 {
        lost.note(lost::WEIGHTS);
    }
    [values[0], values[1], values[2]]
}

impl<'a> ObjContents<'a> {
    /// Takes a face.
    fn face(&mut self, words: &mut Words<'a>, keyword: Word<'a>, arguments: &[Word<'a>], material: Option<u32>) {
        let face = self.faces.len() + 1;
        if arguments.is_empty() {
            words.refuse(keyword, format!("face {face} has no corners"), "nothing follows");
        }
        for &word in arguments {
            let Some(number) = reference(words, word, face, self.vertices.len()) else { continue };
            if number as usize >= self.vertices.len() {
                // A face may name a vertex that comes later; at the end it is known whether one did.
                self.ahead.push((face, number, word));
            }
            self.corners.push(number);
        }
        self.faces.push((self.corners.len(), material));
    }

    /// All vertices are there at the end; a complaint about the first that is not.
    fn check_ahead(&self, words: &mut Words<'a>) -> bool {
        let count = self.vertices.len();
        let mut beyond = self.ahead.iter().filter(|(_, number, _)| *number as usize >= count);
        let Some(&(face, number, word)) = beyond.next() else { return true };
        let known = match count {
            0 => "there are none".to_string(),
            _ => format!("vertices go from 1 to {count}"),
        };
        let mut message = format!("face {face} has vertex {}, but {known}", u64::from(number) + 1);
        let more = beyond.count();
        if more > 0 {
            message.push_str(&format!("; {} out of range too", counted(more, "other is", "others are")));
        }
        words.refuse(word, message, "no such vertex");
        false
    }

    /// Cuts the faces and looks up their materials; what is said about libraries goes to `others`.
    fn into_mesh(
        self,
        words: &mut Words<'a>,
        name: &str,
        libraries: Option<&mut Libraries<'_>>,
        others: &mut Report,
    ) -> Mesh {
        let mut faces = Faces::with_room(self.faces.len());
        let mut named = Vec::new();
        let mut start = 0;
        for &(end, material) in &self.faces {
            // Faces that are left out have no material, so that list and faces stay in step.
            if faces.push(&self.vertices, &self.corners[start..end], Spec::Default) {
                named.push(material);
            }
            start = end;
        }
        let mut is_used = vec![false; self.names.len()];
        named.iter().flatten().for_each(|&number| is_used[number as usize] = true);
        let (mut materials, mut surfaces) = (Vec::new(), Vec::new());
        let mut material_names = Vec::new();
        if let Some(libraries) = libraries.filter(|_| is_used.contains(&true)) {
            let (defined, found) = library::find(words, &self, &is_used, libraries, others);
            let found: Vec<Option<u32>> =
                named.iter().map(|name| name.and_then(|name| found[name as usize]).map(|n| n as u32)).collect();
            let (order, of_faces) = in_order_of_use(&found);
            let definition = |number: &Option<u32>| number.map(|number| &defined.list[number as usize]);
            materials = order.iter().map(|number| definition(number).map_or(GREY, |(_, material)| *material)).collect();
            let name = |number| definition(number).map_or_else(String::new, |(name, _)| name.clone());
            material_names = order.iter().map(name).collect();
            surfaces = faces.spread(&of_faces);
        }
        let mesh = faces.into_mesh(name, self.vertices, None);
        Mesh { materials, material_names, surfaces, ..mesh }
    }
}

/// The vertex that a corner refers to, by number from 0; `known` are there so far.
fn reference(words: &mut Words<'_>, word: Word<'_>, face: usize, known: usize) -> Option<u32> {
    let mut parts = word.text.split('/');
    let vertex = parts.next().unwrap_or_default();
    let is_whole = |text: &str| text.parse::<i64>().is_ok();
    let has_good_rest = parts.clone().count() <= 2 && parts.all(|part| part.is_empty() || is_whole(part));
    let message = match vertex.parse::<i64>() {
        Ok(0) => {
            let error = Diagnostic::error(format!("face {face} has vertex 0, but vertices are counted from 1"));
            words.complain(error.at(words.place(word.span()), "no such vertex"));
            return None;
        }
        Ok(number) if has_good_rest && number > 0 => match u32::try_from(number - 1) {
            Ok(number) => return Some(number),
            Err(_) => format!("face {face} has vertex {number}, which is too large a number"),
        },
        // Negative numbers count back from the vertices so far: with 8 of them, -1 is the vertex 8, which has number 7 here.
        Ok(number) if has_good_rest => match known.checked_sub(number.unsigned_abs() as usize) {
            Some(number) => return Some(number as u32),
            None => {
                format!("face {face} goes back {} vertices, but {known} are there so far", number.unsigned_abs())
            }
        },
        _ => {
            let message = format!("expected a corner of face {face}, found `{}`", shortened(word.text));
            let error = Diagnostic::error(message).at(words.place(word.span()), "not a corner");
            words.complain(error.hint("a corner is v, v/vt, v//vn or v/vt/vn, in whole numbers"));
            return None;
        }
    };
    words.refuse(word, message, "no such vertex");
    None
}

/// The numbers that faces have, each once, in the order of their first use; and the place in that of each face.
fn in_order_of_use(numbers: &[Option<u32>]) -> (Vec<Option<u32>>, Vec<u32>) {
    let mut order = Vec::new();
    let mut places = HashMap::new();
    let of_faces = numbers
        .iter()
        .map(|&number| {
            // All that are grey for want of a definition are one.
            *places.entry(number).or_insert_with(|| {
                order.push(number);
                order.len() as u32 - 1
            })
        })
        .collect();
    (order, of_faces)
}
