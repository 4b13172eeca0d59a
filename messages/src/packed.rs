//! Files that are no text and no format of ours, but a packed or differently coded form of one: how they are known, and
//! what to do with them.

use crate::{Diagnostic, Report};

/// First octets of packed files, and the name of the program that unpacks them.
const PACKED: [(&[u8], &str); 8] = [
    (b"\x1f\x8b\x08", "gzip"),
    (b"\x1f\x9d", "compress"),
    (b"PK\x03\x04", "zip"),
    (b"\xfd7zXZ\0", "xz"),
    (b"\x28\xb5\x2f\xfd", "zstd"),
    (b"BZh", "bzip2"),
    (b"7z\xbc\xaf\x27\x1c", "7z"),
    (b"\x04\x22\x4d\x18", "lz4"),
];

/// Octets behind `BZh` and a digit in every file of bzip2: text may start with these three letters.
const BZIP2_BLOCKS: [&[u8]; 2] = [b"\x31\x41\x59\x26\x53\x59", b"\x17\x72\x45\x38\x50\x90"];

/// Name of the program that packed a file, by its first octets.
pub fn packed_by(bytes: &[u8]) -> Option<&'static str> {
    let (start, name) = PACKED.into_iter().find(|(start, _)| bytes.starts_with(start))?;
    let is_sure = match start {
        b"BZh" => bytes.get(4..).is_some_and(|rest| BZIP2_BLOCKS.iter().any(|block| rest.starts_with(block))),
        _ => true,
    };
    is_sure.then_some(name)
}

/// Refuses a packed file, which would otherwise be shown as gibberish; `name` is the file's.
pub fn refuse_packed(bytes: &[u8], name: &str) -> Result<(), Report> {
    let Some(program) = packed_by(bytes) else { return Ok(()) };
    Err(Diagnostic::error(format!("{name} is compressed ({program})")).hint("unpack it first").into())
}

/// Refuses UTF-16 and UTF-32 text, which would otherwise look like words with gaps; `name` is the file's.
pub fn refuse_utf16(bytes: &[u8], name: &str) -> Result<(), Report> {
    // Without a mark, text shows by its zeros: four ASCII characters, each beside one.
    let (pairs, _) = bytes.get(..8).unwrap_or_default().as_chunks::<2>();
    let has_zeros = |at: usize| !pairs.is_empty() && pairs.iter().all(|pair| pair[at] == 0 && is_text(pair[1 - at]));
    let encoding = match bytes {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => "UTF-32",
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "UTF-16",
        _ if has_zeros(0) || has_zeros(1) => "UTF-16",
        _ => return Ok(()),
    };
    let error = Diagnostic::error(format!("{name} is {encoding} text, which is not read"));
    Err(error.hint("save it as UTF-8 or ASCII").into())
}

fn is_text(octet: u8) -> bool {
    octet.is_ascii_graphic() || octet.is_ascii_whitespace()
}

/// Text as new systems would have it: lines that end in a carriage return alone end in a line feed, and a Ctrl-Z at the end is dropped.
/// Places in the text stay where they are.
pub fn with_plain_ends(mut text: String) -> String {
    if text.contains('\r') && !text.contains('\n') {
        text = text.replace('\r', "\n");
    }
    let end = text.trim_end_matches(['\u{1a}', '\0']).len();
    if text[end..].contains('\u{1a}') {
        text.truncate(end);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_characters_are_known_with_and_without_a_mark() {
        for (bytes, encoding) in [
            (b"\xff\xfev\0 \0".as_slice(), Some("UTF-16")),
            (b"\xfe\xff\0v\0 ", Some("UTF-16")),
            (b"v\0 \x000\0 \0", Some("UTF-16")),
            (b"\0v\0 \x000\0 ", Some("UTF-16")),
            (b"\xff\xfe\0\0v\0\0\0", Some("UTF-32")),
            (b"\0\0\xfe\xff\0\0\0v", Some("UTF-32")),
            (b"v\0 \0", None),
            (b"v 0 0 0\n", None),
            (b"\0\0\0\0\0\0\0\0", None),
            (b"", None),
        ] {
            let message = refuse_utf16(bytes, "a.obj").err().map(|report| report.render(false));
            assert_eq!(message.is_some(), encoding.is_some(), "{bytes:?}");
            assert!(encoding.is_none_or(|name| message.unwrap_or_default().contains(&format!("a.obj is {name} text"))));
        }
    }

    #[test]
    fn text_of_old_systems_has_plain_ends() {
        for (text, plain) in [("a\rb\r", "a\nb\n"), ("a\r\nb\r", "a\r\nb\r"), ("a\n\u{1a}\0\0", "a\n"), ("a\0", "a\0")]
        {
            assert_eq!(with_plain_ends(text.to_owned()), plain, "{text:?}");
        }
    }

    #[test]
    fn packed_files_are_known_by_their_first_octets() {
        for (start, name) in PACKED {
            let mut bytes = start.to_vec();
            bytes.extend(if name == "bzip2" { b"91AY&SY".as_slice() } else { b"..." });
            let message = refuse_packed(&bytes, "a.obj").unwrap_err().render(false);
            assert!(message.contains(&format!("a.obj is compressed ({name})")), "{message}");
            assert!(message.contains("unpack it first"), "{message}");
        }
        for text in ["", "v 0 0 0", "BZh is no statement", "PK", "\u{1f}"] {
            assert!(refuse_packed(text.as_bytes(), "a").is_ok(), "{text}");
        }
    }
}
