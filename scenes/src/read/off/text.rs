//! The text form of OFF: counts, vertices, faces. Only the colour of a face depends on where a line ends.

use std::ops::Range;

use messages::Diagnostic;

use super::super::colour::{Spec, Writing};
use super::super::faces::Faces;
use super::super::mesh::Mesh;
use super::super::words::{Word, Words, counted, shortened};
use super::header::Header;
use super::position;
use crate::model::Vec3;

/// A count and its word.
type SpannedCount<'a> = (u32, Word<'a>);

/// Reads what follows the header; `None` when it is no longer clear what must follow.
pub(super) fn read(words: &mut Words<'_>, header: &Header) -> Option<Mesh> {
    let (points, polygons) = counts(words)?;
    let numbers = numbers_of_vertex(words, header);
    let room = words.room(points.0, points.1, "vertices", 2 * numbers)?;
    let vertices = vertices(words, header, points, numbers, room)?;
    let room = words.room(polygons.0, polygons.1, "faces", 2)?;
    let faces = faces(words, &vertices, polygons, points, room.min(words.remaining() / 8 + 1))?;
    let count = words.place(polygons.1.span());
    let name = count.source.name.clone();
    if header.has_colours && polygons.0 > 0 {
        words.complain(Diagnostic::warning(format!("{name}: colours of vertices are not used")));
    }
    Some(faces.into_mesh(&name, vertices, Some(count)))
}

/// The numbers of vertices and faces. The number of edges is not used, and may be left out on a line of its own.
fn counts<'a>(words: &mut Words<'a>) -> Option<(SpannedCount<'a>, SpannedCount<'a>)> {
    let mut count = |what: &str| {
        let Some(word) = words.next() else {
            let error = Diagnostic::error(format!("the file ends before the number of {what}"));
            words.complain(error.at(words.end(), "the end"));
            return None;
        };
        Some((words.whole(word, || format!("the number of {what}"))?, word))
    };
    let (points, polygons) = (count("vertices")?, count("faces")?);
    if let Some(word) = words.next_in_line() {
        edges(words, word);
        return Some((points, polygons));
    }
    // The line ends after two numbers: the third alone on its line is the edges', several are the first vertex.
    let at = words.position();
    match words.next() {
        Some(word) if words.rest_of_line(word).0 == 1 => edges(words, word),
        Some(_) => {
            words.seek(at);
            let place = words.place(points.1.start..polygons.1.span().end);
            let warning = Diagnostic::warning("the number of edges is missing");
            words.complain(warning.at(place, "vertices and faces, but no edges"));
        }
        None if points.0 == 0 => {}
        None => {
            let error = Diagnostic::error("the file ends before the number of edges");
            words.complain(error.at(words.end(), "the end"));
            return None;
        }
    }
    Some((points, polygons))
}

/// The number of edges may be wrong, but must be a number.
fn edges(words: &mut Words<'_>, word: Word<'_>) {
    if word.text.parse::<f64>().is_err() {
        let message = format!("expected the number of edges, found `{}`", shortened(word.text));
        words.refuse(word, message, "not a number");
    }
}

/// Numbers that each vertex has in this file. Colours of vertices have four, but three are about as well: the line of
/// the first vertex tells.
fn numbers_of_vertex(words: &mut Words<'_>, header: &Header) -> usize {
    let others = header.components + 3 * usize::from(header.has_normals) + 2 * usize::from(header.has_texture);
    if !header.has_colours {
        return others;
    }
    let at = words.position();
    let in_line = words.next().map_or(0, |word| words.rest_of_line(word).0);
    words.seek(at);
    // The header says that there are colours, not of how many components: the first vertex shows it.
    if in_line == others + 3 { others + 3 } else { others + 4 }
}

/// The positions of all vertices; `numbers` for each, `room` as many as the file can hold.
fn vertices(
    words: &mut Words<'_>,
    header: &Header,
    points: SpannedCount<'_>,
    numbers: usize,
    room: usize,
) -> Option<Vec<Vec3>> {
    let mut list = Vec::with_capacity(room);
    let mut row = vec![0.0; numbers];
    for n in 0..points.0 {
        let mut first = None;
        for (k, slot) in row.iter_mut().enumerate() {
            let Some(word) = words.next() else {
                let message = match k {
                    0 => format!("the file ends after {n} of {} vertices", points.0),
                    _ => format!("the file ends within vertex {n}, of {} from 0 on", points.0),
                };
                let error = Diagnostic::error(message).at(words.end(), "the end");
                words.complain(error.also(words.place(points.1.span()), "the number of vertices"));
                return None;
            };
            first.get_or_insert(word);
            // Numbers behind the first three of a position, but for the last one of a 4OFF, are not used.
            let is_used = k < 3.min(header.components) || header.is_homogeneous && k + 1 == header.components;
            let what = || part(header, n, k);
            *slot = if is_used { words.number(word, what) } else { words.unused_number(word, what) };
            if words.is_lost() {
                return None;
            }
        }
        let point = position(header, &row[..header.components]);
        if let (None, Some(first)) = (point, first) {
            let end = words.position();
            let place = words.place(first.start..end);
            let error = Diagnostic::error(format!("vertex {n} lies at infinity"));
            words.complain(error.at(place, "its last number divides the others"));
        }
        list.push(point.unwrap_or_default());
    }
    Some(list)
}

/// Role of number `k` of vertex `n`.
fn part(header: &Header, n: u32, k: usize) -> String {
    match k {
        0..3 if k < header.components => format!("{} of vertex {n}", ["x", "y", "z"][k]),
        _ => format!("number {} of vertex {n}", k + 1),
    }
}

/// A finding that is told once though it is made more often: the first place, and how often.
struct Beyond<'a> {
    face: u32,
    number: u32,
    word: Word<'a>,
    more: usize,
}

/// All faces; `room` as many as the file can hold.
fn faces<'a>(
    words: &mut Words<'a>,
    vertices: &[Vec3],
    polygons: SpannedCount<'a>,
    points: SpannedCount<'a>,
    room: usize,
) -> Option<Faces> {
    let mut faces = Faces::with_room(room);
    let mut corners = Vec::new();
    let mut beyond: Option<Beyond<'a>> = None;
    let mut colours = ColourReader::default();
    let mut are_whole = true;
    for n in 0..polygons.0 {
        let Some(word) = words.next() else {
            let error = Diagnostic::error(format!(
                "the file ends after {n} of {}",
                counted(polygons.0 as usize, "face", "faces")
            ));
            let error = error.at(words.end(), "the end");
            words.complain(error.also(words.place(polygons.1.span()), "the number of faces"));
            return None;
        };
        let size = words.whole(word, || format!("the number of corners of face {n}"))?;
        are_whole &= size >= 3;
        corners.clear();
        let mut is_good = true;
        for k in 0..size {
            let Some(corner) = words.next() else {
                let message = format!("the file ends after {k} of the {size} corners of face {n}");
                let error = Diagnostic::error(message).at(words.end(), "the end");
                words.complain(error.also(words.place(word.span()), "the number of its corners"));
                return None;
            };
            let number = words.whole(corner, || format!("a vertex number of face {n}"));
            // Faces with a wrong corner are left out and read on from, so that the end of the file can tell which count is wrong.
            is_good &= number.is_some_and(|number| number < points.0);
            match (number, &mut beyond) {
                (Some(number), _) if number < points.0 => corners.push(number),
                (Some(_), Some(beyond)) => beyond.more += 1,
                (Some(number), None) => beyond = Some(Beyond { face: n, number, word: corner, more: 0 }),
                (None, _) => {}
            }
        }
        let colour = colours.read(words, n)?;
        if words.is_lost() {
            return None;
        }
        if is_good {
            faces.push(vertices, &corners, colour);
        }
    }
    colours.complain(words);
    // Numbers left over mean that a count is wrong; then vertex numbers out of range are its consequence.
    let has_right_vertices = are_whole && beyond.is_none();
    if !trailing(words, points, polygons, has_right_vertices)
        && let Some(Beyond { face, number, word, more }) = beyond
    {
        let known = match points.0 {
            0 => "there are none".to_string(),
            count => format!("vertices go from 0 to {}", count - 1),
        };
        let mut message = format!("face {face} has vertex {number}, but {known}");
        if more > 0 {
            message.push_str(&format!("; {} out of range too", counted(more, "other is", "others are")));
        }
        let error = Diagnostic::error(message).at(words.place(word.span()), "no such vertex");
        let error = error.also(words.place(points.1.span()), "the number of vertices");
        words.complain(if number == points.0 { error.hint("vertices are counted from 0") } else { error });
    }
    Some(faces)
}

/// Reads the colours of faces, and remembers the first that is none.
#[derive(Default)]
struct ColourReader {
    unused: Option<(u32, Range<usize>)>,
    more: usize,
}

impl ColourReader {
    /// The colour of face `n`: whatever stands between its last corner and the end of the line. `None` when that
    /// cannot be a colour, but is likely more faces.
    fn read(&mut self, words: &mut Words<'_>, n: u32) -> Option<Spec> {
        let mut given: [Option<Word<'_>>; 4] = [None; 4];
        let (mut count, mut end) = (0, 0);
        while let Some(word) = words.next_in_line() {
            if let Some(slot) = given.get_mut(count) {
                *slot = Some(word);
            }
            end = word.span().end;
            count += 1;
        }
        let Some(first) = given[0] else { return Some(Spec::Default) };
        if count > 4 {
            let message = format!("{count} numbers follow the corners of face {n}; a colour has 1, 3 or 4");
            let error = Diagnostic::error(message).at(words.place(first.start..end), "not a colour");
            words.complain(error.hint("each face starts on a line of its own"));
            return None;
        }
        let mut writing = Writing::Whole;
        let mut values = [0.0; 4];
        for (value, word) in values.iter_mut().zip(given.iter().flatten()) {
            *value = words.unused_number(*word, || format!("a colour component of face {n}"));
            // One component with a point is enough: 1 0 0.5 is a colour from 0 to 1, 255 0 128 one from 0 to 255.
            if word.text.contains(['.', 'e', 'E']) {
                writing = Writing::Decimal;
            }
        }
        Some(match count {
            1 => Spec::Index(values[0]),
            2 => {
                if self.unused.is_none() {
                    self.unused = Some((n, first.start..end))
                } else {
                    self.more += 1
                }
                Spec::Default
            }
            _ => Spec::Components([values[0], values[1], values[2]], writing),
        })
    }

    /// Warns of what was no colour.
    fn complain(self, words: &mut Words<'_>) {
        let Some((n, span)) = self.unused else { return };
        let mut message = format!("2 numbers follow the corners of face {n}; a colour has 1, 3 or 4");
        if self.more > 0 {
            message.push_str(&format!("; {} like it", counted(self.more, "other face is", "other faces are")));
        }
        let place = words.place(span);
        words.complain(Diagnostic::warning(message).at(place, "not used"));
    }
}

/// Whatever follows the last face: more faces are left out with a warning, other numbers mean that the number of
/// vertices is wrong (then true), other text belongs to someone else.
fn trailing(
    words: &mut Words<'_>,
    points: SpannedCount<'_>,
    polygons: SpannedCount<'_>,
    has_right_vertices: bool,
) -> bool {
    let Some(word) = words.next() else { return false };
    let end = words.rest_of_line(word).1;
    let is_face = has_right_vertices && is_face(words, word, points.0);
    let place = words.place(word.span());
    let (vertices, faces) =
        (counted(points.0 as usize, "vertex", "vertices"), counted(polygons.0 as usize, "face", "faces"));
    let message = format!("the file goes on after {vertices} and {faces}");
    let announced = words.place(points.1.start..polygons.1.span().end);
    if is_face {
        let message = format!("there are more faces than the {} that are announced", polygons.0);
        let warning = Diagnostic::warning(message).at(words.place(word.start..end), "not read from here on");
        words.complain(warning.also(words.place(polygons.1.span()), "the number of faces"));
        return false;
    }
    let is_number = word.text.parse::<f64>().is_ok();
    words.complain(if is_number {
        let error = Diagnostic::error(message).at(place, "a number too many");
        error.also(announced, "these counts").hint("one of the counts is too small")
    } else {
        Diagnostic::warning(message).at(place, "not read").also(announced, "these counts")
    });
    is_number
}

/// True where the line that starts with `first` is a face of at least three of `vertices` vertices, and perhaps a colour.
fn is_face(words: &mut Words<'_>, first: Word<'_>, vertices: u32) -> bool {
    let Ok(size) = first.text.parse::<usize>() else { return false };
    let line = words.line_from(first.start);
    let text = line.text.split('#').next().unwrap_or_default();
    let numbers: Vec<&str> = text.split_ascii_whitespace().skip(1).collect();
    let is_vertex = |text: &&str| text.parse::<u32>().is_ok_and(|number| number < vertices);
    let Some((corners, colour)) = numbers.split_at_checked(size) else { return false };
    words.starts_line(first) && size >= 3 && corners.iter().all(is_vertex) && matches!(colour.len(), 0 | 1 | 3 | 4)
}
