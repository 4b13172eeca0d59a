//! The first words of an OFF file: `[ST][C][N][4][n]OFF`, a dimension, `BINARY`. What follows them is not read here.

use messages::{Diagnostic, did_you_mean};
use nom::branch::alt;
use nom::bytes::complete::tag;
use nom::combinator::value;
use nom::multi::many0;
use nom::{IResult, Parser};

use super::super::words::{Word, Words, shortened};

/// Promises of the header word for each vertex, and how the rest is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Header {
    /// Numbers of a position, the homogeneous one included.
    pub components: usize,
    /// The last number of a position divides the others.
    pub is_homogeneous: bool,
    /// A normal of three numbers follows the position.
    pub has_normals: bool,
    /// A colour of four numbers follows (in text three are read too).
    pub has_colours: bool,
    /// A texture position of two numbers follows.
    pub has_texture: bool,
    /// Everything after the header is binary, from this place on.
    pub binary: Option<BinaryPart>,
}

/// Start of the binary part, and its first number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct BinaryPart {
    /// First octet of the word `BINARY` and the one after its last.
    pub word: (usize, usize),
    /// Offset of the first octet behind that line, in the text that the header was read from.
    pub start: usize,
    /// The dimension of an nOFF is its first number.
    pub has_dimension: bool,
}

/// Largest dimension of an nOFF that is believed.
pub(super) const DIMENSIONS: u32 = 1000;

#[derive(Clone, Copy, PartialEq, Eq)]
enum OffPrefix {
    Texture,
    Colour,
    Normal,
    Homogeneous,
    Dimension,
    Smooth,
}

/// The letters before `OFF`, and what is glued behind it. Letters in another order than Geomview's are read too.
fn keyword(input: &str) -> IResult<&str, Vec<OffPrefix>> {
    let letter = alt((
        value(OffPrefix::Texture, tag("ST")),
        value(OffPrefix::Colour, tag("C")),
        value(OffPrefix::Normal, tag("N")),
        value(OffPrefix::Homogeneous, tag("4")),
        value(OffPrefix::Dimension, tag("n")),
        value(OffPrefix::Smooth, tag("S")),
    ));
    let (rest, letters) = many0(letter).parse(input)?;
    let (rest, _) = alt((tag("OFF"), tag("off"), tag("Off"))).parse(rest)?;
    Ok((rest, letters))
}

/// Reads the header; a file that starts with a number has none. `None` after a complaint.
pub(super) fn read(words: &mut Words<'_>) -> Option<Header> {
    let Some(word) = words.next() else {
        words.complain(Diagnostic::error("the file is empty").at(words.end(), "expected `OFF`"));
        return None;
    };
    let mut header = Header {
        components: 3,
        is_homogeneous: false,
        has_normals: false,
        has_colours: false,
        has_texture: false,
        binary: None,
    };
    let is_number = word.text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    // The keyword is tried before a number, since `4OFF` begins with a digit too.
    let Ok((glued, letters)) = keyword(word.text) else {
        if is_number {
            words.seek(word.start);
            return Some(header);
        }
        return refuse(words, word);
    };
    let has = |prefix| letters.contains(&prefix);
    // Each letter is there once, and what is glued behind `OFF` is `BINARY` or the first count, as in `OFF8 6 12`
    let is_repeated = (1..letters.len()).any(|n| letters[..n].contains(&letters[n]));
    if is_repeated || !(glued.is_empty() || glued == "BINARY" || glued.starts_with(|c: char| c.is_ascii_digit())) {
        return refuse(words, word);
    }
    header.is_homogeneous = has(OffPrefix::Homogeneous);
    header.has_normals = has(OffPrefix::Normal);
    header.has_colours = has(OffPrefix::Colour);
    header.has_texture = has(OffPrefix::Texture);
    // Go back to what is glued: `nOFF BINARY` has its dimension in the binary part, `nOFF 4 BINARY` in the text
    words.seek(word.span().end - glued.len());
    let mut mark = take_binary(words);
    let has_dimension = has(OffPrefix::Dimension) && mark.is_some();
    let mut dimension = 3;
    if has(OffPrefix::Dimension) && !has_dimension {
        dimension = read_dimension(words)?;
        mark = take_binary(words);
    }
    // Behind this line end every octet is data, so nothing else may stand before it.
    if let Some(word) = mark {
        let Some(start) = words.skip_line_end() else {
            let at = words.position();
            let place = words.place(at..at);
            words.complain(Diagnostic::error("a line end must follow `BINARY`").at(place, "expected a line end"));
            return None;
        };
        header.binary = Some(BinaryPart { word: (word.start, word.span().end), start, has_dimension });
    }
    header.components = dimension + usize::from(header.is_homogeneous);
    Some(header)
}

/// The dimension of an nOFF in text.
fn read_dimension(words: &mut Words<'_>) -> Option<usize> {
    let Some(word) = words.next() else {
        words.complain(Diagnostic::error("the file ends before its dimension").at(words.end(), "the end"));
        return None;
    };
    let number = words.whole(word, || "the dimension of an nOFF".to_string())?;
    if !(1..=DIMENSIONS).contains(&number) {
        words.refuse(word, format!("the dimension must be 1 to {DIMENSIONS}"), "out of range");
        return None;
    }
    Some(number as usize)
}

/// Takes the word `BINARY` if it is next on this line.
fn take_binary<'a>(words: &mut Words<'a>) -> Option<Word<'a>> {
    let at = words.position();
    let word = words.next_in_line().filter(|word| word.text == "BINARY");
    if word.is_none() {
        words.seek(at);
    }
    word
}

fn refuse<T>(words: &mut Words<'_>, word: Word<'_>) -> Option<T> {
    let mut known = Vec::new();
    for bits in 0..32 {
        let part = |bit: u32, text: &'static str| if bits >> bit & 1 == 1 { text } else { "" };
        known.push(format!("{}{}{}{}{}OFF", part(4, "ST"), part(3, "C"), part(2, "N"), part(1, "4"), part(0, "n")));
    }
    // The comparison takes time and memory in proportion to the word, which may be a whole file.
    let near = (word.text.len() <= 16).then(|| did_you_mean(word.text, known.iter().map(String::as_str))).flatten();
    let hint = match near {
        Some(near) => near,
        None if word.text == "DSC" => "this looks like a scene description: its name should end in .dsc".to_string(),
        None => "an OFF file starts with `OFF`, after letters of ST, C, N, 4, n for what its vertices have".to_string(),
    };
    let message = format!("`{}` does not start an OFF file", shortened(word.text));
    let place = words.place(word.span());
    words.complain(Diagnostic::error(message).at(place, "expected `OFF`").hint(hint));
    None
}
