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

/// Refuses UTF-16 text, which would otherwise look like words with gaps; `name` is the file's.
pub fn refuse_utf16(bytes: &[u8], name: &str) -> Result<(), Report> {
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        let error = Diagnostic::error(format!("{name} is UTF-16 text, which is not read"));
        return Err(error.hint("save it as UTF-8 or ASCII").into());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

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
