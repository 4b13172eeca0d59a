//! Parts: the rows of points that share a recording, in a file of their own. Its first line has the hash of the rest, so that a part that was cut
//! short or changed is none.

use std::collections::{BTreeSet, HashSet};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use messages::{Diagnostic, Report};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::row::PointRow;
use super::{PART, identity};
use crate::files;
use crate::result::hexadecimal;
use crate::settings::{VERSION, hash};

/// Octets of the longest line.
const LONGEST: u64 = 16 << 20;

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

/// A row of a part where it stands. It is small: rows themselves are read again when a table is made of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IndexedRow {
    /// SHA-256 of all that the point's result depends on.
    pub point: [u8; 32],
    /// First octets of the SHA-256 of the result: its figures, or the reason of a refusal.
    pub result: [u8; 16],
    /// Place of its line in the file, in octets.
    pub start: u64,
    /// Octets of the line.
    pub length: u64,
}

/// A part that was read, as an index of its rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StudyPart {
    /// The file.
    pub path: PathBuf,
    /// The recording that its points share.
    pub recording: String,
    /// Keys that its points set.
    pub keys: BTreeSet<String>,
    /// The rows.
    pub rows: Vec<IndexedRow>,
}

impl StudyPart {
    /// A row, which is read again.
    ///
    /// # Errors
    /// A file that has gone or changed since.
    pub fn row(&self, row: &IndexedRow) -> Result<PointRow, Report> {
        let read = || -> io::Result<PointRow> {
            let mut file = files::open(&self.path)?;
            file.seek(SeekFrom::Start(row.start))?;
            let mut line = Vec::new();
            file.take(row.length).read_to_end(&mut line)?;
            Ok(serde_json::from_slice(&line)?)
        };
        read().map_err(|error| {
            Diagnostic::error(format!("{} has changed since it was read: {error}", self.path.display())).into()
        })
    }
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

/// The parts of a folder in the order of their names, and those that are none with the reason. Memory holds an index of the rows, and a row a host
/// thread.
///
/// # Errors
/// A folder that cannot be read.
pub fn read_all(folder: &Path) -> Result<(Vec<StudyPart>, Vec<DamagedPart>), Report> {
    let refuse =
        |error: io::Error| Diagnostic::error(format!("the folder {} cannot be read: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(refuse)? {
        let path = entry.map_err(refuse)?.path();
        // A name that begins with a point is of a file that is still being written.
        if path
            .file_name()
            .is_some_and(|name| name.to_string_lossy().ends_with(ENDING) && !name.to_string_lossy().starts_with('.'))
        {
            paths.push(path);
        }
    }
    // Systems list a folder in any order.
    paths.sort();
    let (mut parts, mut damaged) = (Vec::new(), Vec::new());
    // Threads end in any order, their results stay in that of the names.
    let read: Vec<(PathBuf, Result<StudyPart, String>)> = paths
        .into_par_iter()
        .map(|path| {
            let part = read(&path);
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

fn read(path: &Path) -> Result<StudyPart, String> {
    let file = files::open(path).map_err(|error| format!("it cannot be read: {error}"))?;
    index(BufReader::new(file), path)
}

/// Reads a part line by line.
///
/// # Errors
/// The reason for which it is no whole part.
pub fn index(mut part: impl BufRead, path: &Path) -> Result<StudyPart, String> {
    let mut line = Vec::new();
    let mut next = |line: &mut Vec<u8>| -> Result<usize, String> {
        line.clear();
        let read = part.by_ref().take(LONGEST).read_until(b'\n', line);
        read.map_err(|error| format!("it cannot be read: {error}"))
    };
    let mut start = next(&mut line)? as u64;
    if !line.ends_with(b"\n") {
        return Err("it has no line".to_owned());
    }
    let head: PartHead =
        serde_json::from_slice(&line).map_err(|error| format!("its first line is no part's: {error}"))?;
    if head.schema != PART || head.version != VERSION {
        return Err(format!("it is of `{}` and version {}, not of {PART} and {VERSION}", head.schema, head.version));
    }
    // A part that was cut short or changed is that before it is anything else, so a row that cannot be read is told at the end.
    let (mut hash, mut keys, mut rows, mut wrong) = (Sha256::new(), BTreeSet::new(), Vec::new(), None);
    while let length @ 1.. = next(&mut line)? as u64 {
        hash.update(&line);
        match row(&line, &mut keys) {
            Ok((point, result)) => rows.push(IndexedRow { point, result, start, length }),
            Err(reason) => wrong = wrong.or(Some(reason)),
        }
        start += length;
    }
    if hexadecimal(&hash.finalize()) != head.sha256 {
        return Err("it was cut short or changed".to_owned());
    }
    match wrong {
        Some(reason) => Err(format!("a row cannot be read: {reason}")),
        None => Ok(StudyPart { path: path.to_owned(), recording: head.recording, keys, rows }),
    }
}

/// Hash of a row's point and that of its result; takes note of the keys that it sets.
fn row(line: &[u8], keys: &mut BTreeSet<String>) -> Result<([u8; 32], [u8; 16]), String> {
    let row: PointRow = serde_json::from_slice(line).map_err(|error| error.to_string())?;
    for (key, _) in row.set.iter().filter(|(key, _)| !keys.contains(*key)).collect::<Vec<_>>() {
        keys.insert(key.to_owned());
    }
    let point = identity::read(&row.point).ok_or_else(|| format!("`{}` is no hash of a point", row.point))?;
    let result = serde_json::to_vec(&(&row.figures, &row.refused)).expect("rows have string keys");
    let digest = Sha256::digest(result);
    Ok((point, std::array::from_fn(|at| digest[at])))
}

/// The points that parts have.
pub fn points(parts: &[StudyPart]) -> HashSet<[u8; 32]> {
    parts.iter().flat_map(|part| &part.rows).map(|row| row.point).collect()
}
