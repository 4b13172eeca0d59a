//! Inputs that the project has already: its files, listings of its pages, and texts in the sources of its tests. Nothing is stored twice.

use std::path::{Path, PathBuf};

/// The project's folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Files below a folder whose names end so, in the order of their paths.
pub fn files(folder: &str, ending: &str) -> Vec<Vec<u8>> {
    let mut paths = Vec::new();
    let mut folders = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        for path in entries.map(|entry| entry.expect("the folder can be read").path()) {
            match path.is_dir() {
                true => folders.push(path),
                false if path.to_string_lossy().ends_with(ending) => paths.push(path),
                false => {}
            }
        }
    }
    paths.sort();
    paths.iter().map(|path| octets(path)).collect()
}

fn octets(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn text(name: &str) -> String {
    String::from_utf8_lossy(&octets(&root().join(name))).into_owned()
}

/// Listings of all pages, whatever they are of.
pub fn listings() -> Vec<Vec<u8>> {
    let pages = files("docs", ".md").into_iter().chain([octets(&root().join("README.md"))]);
    let pages = pages.map(|page| String::from_utf8_lossy(&page).into_owned());
    let listings = pages.flat_map(|page| {
        let inside = page.split("```").skip(1).step_by(2).filter_map(|listing| listing.split_once('\n'));
        inside.map(|(_, listing)| listing.as_bytes().to_vec()).collect::<Vec<_>>()
    });
    listings.collect()
}

/// Texts in quotation marks of a source, where they have some length.
pub fn literals(source: &str) -> Vec<Vec<u8>> {
    let text = text(source);
    let mut found = Vec::new();
    let mut rest = text.as_str();
    while let Some(start) = rest.find('"') {
        let (literal, length) = literal(&rest[start + 1..]);
        if literal.len() > 3 {
            found.push(literal);
        }
        rest = &rest[start + 1 + length..];
    }
    found
}

/// The octets of a literal up to its closing mark, and its length in the source with that mark.
fn literal(text: &str) -> (Vec<u8>, usize) {
    let mut octets = Vec::new();
    let mut letters = text.char_indices();
    while let Some((at, letter)) = letters.next() {
        match letter {
            '"' => return (octets, at + 1),
            '\\' => match letters.next().map(|(_, escape)| escape) {
                Some('n') => octets.push(b'\n'),
                Some('r') => octets.push(b'\r'),
                Some('t') => octets.push(b'\t'),
                Some('0') => octets.push(0),
                Some('x') => {
                    let digits: String = letters.by_ref().take(2).map(|(_, digit)| digit).collect();
                    octets.extend(u8::from_str_radix(&digits, 16));
                }
                // A line that goes on begins where its text does.
                Some('\n') => {
                    let blanks = text[at + 2..].len() - text[at + 2..].trim_start().len();
                    letters.by_ref().take(blanks).for_each(drop);
                }
                Some(other) => octets.extend(other.to_string().bytes()),
                None => {}
            },
            other => octets.extend(other.to_string().bytes()),
        }
    }
    (octets, text.len())
}

/// Pieces of at most so many octets, cut between lines where there are some.
pub fn pieces(inputs: Vec<Vec<u8>>, longest: usize) -> Vec<Vec<u8>> {
    let mut pieces = Vec::new();
    for input in inputs {
        let mut rest = &input[..];
        while rest.len() > longest {
            let end = rest[..longest].iter().rposition(|octet| *octet == b'\n').map_or(longest, |end| end + 1);
            pieces.push(rest[..end].to_vec());
            rest = &rest[end..];
        }
        if !rest.is_empty() {
            pieces.push(rest.to_vec());
        }
    }
    pieces
}
