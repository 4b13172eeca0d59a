//! Parts: the rows of points that share a recording, in a file of their own. Its first line has the hash of the rest, so that a part that was cut
//! short or changed is none.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use messages::{Diagnostic, Report};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::PART;
use super::key_set::KeySet;
use super::row::PointRow;
use crate::files;
use crate::result::hexadecimal;
use crate::settings::{VERSION, hash};

/// Octets of the largest part.
const LARGEST: u64 = 4 << 30;

/// Ending of parts' names.
pub const ENDING: &str = "part.jsonl";

/// The first line of a part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct PartHead {
    schema: String,
    version: String,
    recording: String,
    points: usize,
    sha256: String,
}

/// A part that was read.
#[derive(Clone, Debug)]
pub struct StudyPart {
    /// The file.
    pub path: PathBuf,
    /// The recording that its points share.
    pub recording: String,
    /// The rows.
    pub rows: Vec<PointRow>,
}

/// A file that should be a part and is none, and why.
pub type DamagedPart = (PathBuf, String);

/// Name of the part of a recording with these points: the same points give the same name, whoever runs them.
pub fn name(recording: &str, points: &[&str]) -> String {
    let short = |digest: &str| digest.chars().take(16).collect::<String>();
    format!("{}-{}.{ENDING}", short(recording), short(&hash::texts(points.iter().copied())))
}

/// SHA-256 of the rows of a part, in hexadecimal.
pub fn checksum(rows: &str) -> String {
    hexadecimal(&Sha256::digest(rows))
}

/// Text of a part: a head with the checksum of the rest, and a row a line.
pub fn text(recording: &str, rows: &[PointRow]) -> String {
    let mut rest = String::new();
    for row in rows {
        rest += &serde_json::to_string(row).expect("rows have string keys");
        rest.push('\n');
    }
    let head = PartHead {
        schema: PART.to_owned(),
        version: VERSION.to_owned(),
        recording: recording.to_owned(),
        points: rows.len(),
        sha256: checksum(&rest),
    };
    serde_json::to_string(&head).expect("a head has string keys") + "\n" + &rest
}

/// Writes a part as a whole, and through to the disk: hours may lie between the first part of a study and the last.
///
/// # Errors
/// A folder or a disk that cannot be written.
pub fn write(folder: &Path, recording: &str, rows: &[PointRow]) -> Result<(), Report> {
    let points: Vec<&str> = rows.iter().map(|row| row.point.as_str()).collect();
    files::write_through(&folder.join(name(recording, &points)), text(recording, rows).as_bytes())
}

/// The parts of a folder in the order of their names, and those that are none with the reason. Rows have the keys that their points set only
/// where they are asked for: a plan has them too.
///
/// # Errors
/// A folder that cannot be read.
pub fn read_all(folder: &Path, has_sets: bool) -> Result<(Vec<StudyPart>, Vec<DamagedPart>), Report> {
    let refuse =
        |error: std::io::Error| Diagnostic::error(format!("the folder {} cannot be read: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(refuse)? {
        let path = entry.map_err(refuse)?.path();
        if path
            .file_name()
            .is_some_and(|name| name.to_string_lossy().ends_with(ENDING) && !name.to_string_lossy().starts_with('.'))
        {
            paths.push(path);
        }
    }
    paths.sort();
    let (mut parts, mut damaged) = (Vec::new(), Vec::new());
    let read: Vec<(PathBuf, Result<StudyPart, String>)> = paths
        .into_par_iter()
        .map(|path| {
            let part = read(&path, has_sets);
            (path, part)
        })
        .collect();
    for (path, part) in read {
        match part {
            Ok(part) => parts.push(part),
            Err(reason) => damaged.push((path, reason)),
        }
    }
    Ok((parts, damaged))
}

fn read(path: &Path, has_sets: bool) -> Result<StudyPart, String> {
    let shown = |report: Report| report.0.first().map_or_else(String::new, |message| message.message.clone());
    let text = files::text(files::read_up_to(LARGEST, path).map_err(shown)?);
    parse(&text, path, has_sets)
}

/// Reads the text of a part. Rows have the keys that their points set only where they are asked for.
///
/// # Errors
/// The reason for which the text is no whole part.
pub fn parse(text: &str, path: &Path, has_sets: bool) -> Result<StudyPart, String> {
    let (first, rest) = text.split_once('\n').ok_or("it has no line")?;
    let head: PartHead =
        serde_json::from_str(first).map_err(|error| format!("its first line is no part's: {error}"))?;
    if head.schema != PART || head.version != VERSION {
        return Err(format!("it is of `{}` and version {}, not of {PART} and {VERSION}", head.schema, head.version));
    }
    if checksum(rest) != head.sha256 {
        return Err("it was cut short or changed".to_owned());
    }
    let row = |line: &str| {
        let row: PointRow = serde_json::from_str(line)?;
        Ok(if has_sets { row } else { PointRow { set: KeySet::default(), ..row } })
    };
    let rows = rest.lines().map(row).collect::<Result<Vec<PointRow>, serde_json::Error>>();
    let rows = rows.map_err(|error| format!("a row cannot be read: {error}"))?;
    Ok(StudyPart { path: path.to_owned(), recording: head.recording, rows })
}

/// The points that parts have, with the numbers of the parts.
pub fn points(parts: &[StudyPart]) -> HashMap<&str, usize> {
    let rows = parts.iter().enumerate().flat_map(|(number, part)| part.rows.iter().map(move |row| (row, number)));
    rows.map(|(row, number)| (row.point.as_str(), number)).collect()
}
