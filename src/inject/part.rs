//! Parts of a campaign: the rows of a block of injections in a file of their own, so that runs can be stopped, shared out and brought together.
//! The first line has the hash of the rest, so that a part that was cut short or changed is none.

use std::ops::Range;
use std::path::{Path, PathBuf};

use emu::inject::FaultKind;
use messages::{Diagnostic, Report};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::row::InjectionRow;
use crate::files;
use crate::result::hexadecimal;

/// Version of a part's first line.
pub const PART: &str = "lancer-inject-part-1";

/// Octets of the largest part.
const LARGEST: u64 = 64 << 20;

/// The first line of a part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct InjectPartHead {
    schema: String,
    campaign: String,
    kind: String,
    from: u64,
    to: u64,
    sha256: String,
}

/// File of a block's part in a folder: the same block of the same campaign has the same name, whoever runs it.
pub fn path(folder: &Path, campaign: &str, kind: FaultKind, block: &Range<u64>) -> PathBuf {
    let short = &campaign[..campaign.len().min(16)];
    folder.join(format!("{short}-{}-{}-{}.part.jsonl", kind.name(), block.start, block.end))
}

/// Text of a block's part: a head with the checksum of the rest, and a row a line.
pub fn text(campaign: &str, kind: FaultKind, block: &Range<u64>, rows: &[InjectionRow]) -> String {
    let mut rest = String::new();
    for row in rows {
        rest += &serde_json::to_string(row).expect("rows have string keys");
        rest.push('\n');
    }
    let head = InjectPartHead {
        schema: PART.to_owned(),
        campaign: campaign.to_owned(),
        kind: kind.name().to_owned(),
        from: block.start,
        to: block.end,
        sha256: hexadecimal(&Sha256::digest(&rest)),
    };
    serde_json::to_string(&head).expect("a head has string keys") + "\n" + &rest
}

/// Rows of a block from the text of its part; `None` where it is that of another block, or was cut short or changed.
pub fn parse(text: &str, campaign: &str, kind: FaultKind, block: &Range<u64>) -> Option<Vec<InjectionRow>> {
    let (first, rest) = text.split_once('\n')?;
    let head: InjectPartHead = serde_json::from_str(first).ok()?;
    let is_it = head.schema == PART
        && (head.campaign.as_str(), head.kind.as_str()) == (campaign, kind.name())
        && (head.from, head.to) == (block.start, block.end)
        && head.sha256 == hexadecimal(&Sha256::digest(rest));
    let rows: Vec<InjectionRow> = rest.lines().map(|line| serde_json::from_str(line).ok()).collect::<Option<_>>()?;
    let is_right = |row: &InjectionRow| row.kind == kind.name() && row.bits.iter().all(|&bit| bit < u64::BITS);
    let is_numbered = rows.iter().map(|row| row.number).eq(block.clone());
    (is_it && is_numbered && rows.iter().all(is_right)).then_some(rows)
}

/// Writes a part as a whole, and through to the disk.
///
/// # Errors
/// A folder or a disk that cannot be written.
pub fn write(
    folder: &Path,
    campaign: &str,
    kind: FaultKind,
    block: &Range<u64>,
    rows: &[InjectionRow],
) -> Result<(), Report> {
    files::write_through(&path(folder, campaign, kind, block), text(campaign, kind, block, rows).as_bytes())
}

/// Rows of a block's part; `None` where there is no such file, or one that was cut short or changed.
///
/// # Errors
/// A file that cannot be read.
pub fn read(
    folder: &Path,
    campaign: &str,
    kind: FaultKind,
    block: &Range<u64>,
) -> Result<Option<Vec<InjectionRow>>, Report> {
    let path = path(folder, campaign, kind, block);
    if !path.exists() {
        return Ok(None);
    }
    Ok(parse(&files::text(files::read_up_to(LARGEST, &path)?), campaign, kind, block))
}

/// Makes a folder for parts.
///
/// # Errors
/// A folder that cannot be made.
pub fn make_folder(folder: &Path) -> Result<(), Report> {
    let refuse = |error| Diagnostic::error(format!("the folder {} cannot be made: {error}", folder.display()));
    std::fs::create_dir_all(folder).map_err(|error| refuse(error).into())
}
