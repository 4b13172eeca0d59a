//! The text form of OFF: counts, vertices, faces. Only the colour of a face depends on where a line ends.

use isa::diagnostic::Diagnostic;

use super::super::mesh::Mesh;
use super::super::words::{Word, Words, shortened};
use super::colour::{Spec, Writing};
use super::header::Header;
use super::{Faces, position};
use crate::model::Vec3;

/// A count and its word.
type Count<'a> = (u32, Word<'a>);

/// Reads what follows the header; `None` when it is no longer clear what must follow.
pub(super) fn read(words: &mut Words<'_>, header: &Header) -> Option<Mesh> {
    let (points, polygons) = counts(words)?;
    let numbers = numbers_of_vertex(words, header);
    has_room(words, points, polygons, numbers)?;
    let vertices = vertices(words, header, points, numbers)?;
    let faces = faces(words, &vertices, polygons, points)?;
    trailing(words, polygons);
    let count = words.place(polygons.1.span());
    let name = count.source.name.clone();
    if header.has_colours && polygons.0 > 0 {
        words.complain(Diagnostic::warning(format!("{name}: colours of vertices are not used")));
    }
    Some(faces.into_mesh(&name, vertices, Some(count)))
}

/// The numbers of vertices and faces. The number of edges is not used, and may be left out on a line of its own.
fn counts<'a>(words: &mut Words<'a>) -> Option<(Count<'a>, Count<'a>)> {
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
        Some(word) if words.count_in_line() == 0 => edges(words, word),
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
    let in_line = words.next().map_or(0, |_| 1 + words.count_in_line());
    words.seek(at);
    if in_line == others + 3 { others + 3 } else { others + 4 }
}

/// Whether the rest of the file can hold what is announced: two octets a number.
fn has_room(words: &mut Words<'_>, points: Count<'_>, polygons: Count<'_>, numbers: usize) -> Option<()> {
    let room = words.remaining() + 1;
    let most = room / (2 * numbers);
    let (count, word, what, most) = if points.0 as usize > most {
        (points.0, points.1, "vertices", most)
    } else if polygons.0 as usize > (room - points.0 as usize * 2 * numbers) / 2 {
        (polygons.0, polygons.1, "faces", (room - points.0 as usize * 2 * numbers) / 2)
    } else {
        return Some(());
    };
    let message = format!("{count} {what} are announced, but the rest of the file has room for {most} at most");
    words.refuse(word, message, "a wrong number, or the file is cut short");
    None
}

fn vertices(words: &mut Words<'_>, header: &Header, points: Count<'_>, numbers: usize) -> Option<Vec<Vec3>> {
    let mut list = Vec::with_capacity(points.0 as usize);
    let mut row = vec![0.0; numbers];
    for n in 0..points.0 {
        let mut first = None;
        for (k, slot) in row.iter_mut().enumerate() {
            let Some(word) = words.next() else {
                let within = if k == 0 { "after" } else { "within the one after" };
                let error = Diagnostic::error(format!("the file ends {within} {n} of {} vertices", points.0));
                let error = error.at(words.end(), "the end");
                words.complain(error.also(words.place(points.1.span()), "the number of vertices"));
                return None;
            };
            first.get_or_insert(word);
            *slot = words.number(word, || part(header, n, k));
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

/// What number `k` of vertex `n` is.
fn part(header: &Header, n: u32, k: usize) -> String {
    match k {
        0..3 if k < header.components => format!("{} of vertex {n}", ["x", "y", "z"][k]),
        _ => format!("number {} of vertex {n}", k + 1),
    }
}

fn faces<'a>(words: &mut Words<'a>, vertices: &[Vec3], polygons: Count<'a>, points: Count<'a>) -> Option<Faces> {
    let mut faces = Faces::default();
    faces.triangles.reserve(polygons.0 as usize);
    faces.origins.reserve(polygons.0 as usize);
    let mut corners = Vec::new();
    let mut first_beyond: Option<(u32, u32, Word<'a>)> = None;
    let mut beyond = 0;
    for n in 0..polygons.0 {
        let Some(word) = words.next() else {
            return cut(words, format!("after {n} of {} faces", polygons.0), polygons);
        };
        let size = words.whole(word, || format!("the number of corners of face {n}"))?;
        let most = words.remaining().div_ceil(2);
        if size as usize > most {
            let message = format!("face {n} has {size} corners, but the rest of the file has room for {most} at most");
            words.refuse(word, message, "a wrong number, or the file is cut short");
            return None;
        }
        corners.clear();
        let mut is_good = true;
        for _ in 0..size {
            let Some(word) = words.next() else {
                return cut(words, format!("within face {n} of {}", polygons.0), polygons);
            };
            let number = words.whole(word, || format!("a vertex number of face {n}"));
            is_good &= number.is_some_and(|number| number < points.0);
            if let Some(number) = number {
                if number >= points.0 {
                    first_beyond.get_or_insert((n, number, word));
                    beyond += 1;
                }
                corners.push(number);
            }
        }
        let colour = colour(words, n);
        if is_good {
            faces.push(vertices, &corners, colour);
        }
    }
    if let Some((n, number, word)) = first_beyond {
        let known = match points.0 {
            0 => "there are none".to_string(),
            count => format!("they go from 0 to {}", count - 1),
        };
        let mut message = format!("face {n} has vertex {number}, but {known}");
        if beyond > 1 {
            message.push_str(&format!("; {} more are out of range too", beyond - 1));
        }
        let error = Diagnostic::error(message).at(words.place(word.span()), "no such vertex");
        let error = error.also(words.place(points.1.span()), "the number of vertices");
        let counts_from_one = beyond > 0 && number == points.0;
        words.complain(if counts_from_one { error.hint("vertices are counted from 0") } else { error });
    }
    Some(faces)
}

/// The colour of face `n`: whatever stands between its last corner and the end of the line.
fn colour(words: &mut Words<'_>, n: u32) -> Spec {
    let mut given: [Option<Word<'_>>; 4] = [None; 4];
    let mut count = 0;
    let mut last = None;
    while let Some(word) = words.next_in_line() {
        if let Some(slot) = given.get_mut(count) {
            *slot = Some(word);
        }
        last = Some(word);
        count += 1;
    }
    let (Some(first), Some(last)) = (given[0], last) else { return Spec::Default };
    let mut writing = Writing::Whole;
    let mut values = [0.0; 4];
    for (value, word) in values.iter_mut().zip(given.iter().flatten()) {
        *value = words.number(*word, || format!("a colour component of face {n}"));
        if word.text.contains(['.', 'e', 'E']) {
            writing = Writing::Decimal;
        }
    }
    match count {
        1 => return Spec::Index(values[0]),
        3 | 4 => return Spec::Components([values[0], values[1], values[2]], writing),
        _ => {}
    }
    let place = words.place(first.start..last.span().end);
    let message = format!("{count} numbers follow the corners of face {n}; a colour has 1, 3 or 4");
    let message = if count == 2 {
        Diagnostic::warning(message).at(place, "not used")
    } else {
        Diagnostic::error(message).at(place, "not a colour").hint("each face starts on a line of its own")
    };
    words.complain(message);
    Spec::Default
}

/// Whatever follows the last face: numbers mean that a count is wrong, other text belongs to someone else.
fn trailing(words: &mut Words<'_>, polygons: Count<'_>) {
    let Some(word) = words.next() else { return };
    let place = words.place(word.span());
    let announced = words.place(polygons.1.span());
    let message = format!("the file goes on after its {} faces", polygons.0);
    words.complain(if word.text.parse::<f64>().is_ok() {
        Diagnostic::error(message).at(place, "a number too many").also(announced, "the number of faces")
    } else {
        Diagnostic::warning(message).at(place, "not read").also(announced, "the number of faces")
    });
}

fn cut<T>(words: &mut Words<'_>, place: String, polygons: Count<'_>) -> Option<T> {
    let error = Diagnostic::error(format!("the file ends {place}")).at(words.end(), "the end");
    words.complain(error.also(words.place(polygons.1.span()), "the number of faces"));
    None
}
