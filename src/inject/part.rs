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
    let text = serde_json::to_string(&head).expect("a head has string keys") + "\n" + &rest;
    files::write_through(&path(folder, campaign, kind, block), text.as_bytes())
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
    let text = files::text(files::read_up_to(LARGEST, &path)?);
    let Some((first, rest)) = text.split_once('\n') else { return Ok(None) };
    let Ok(head) = serde_json::from_str::<InjectPartHead>(first) else { return Ok(None) };
    let is_it = head.schema == PART
        && (head.campaign.as_str(), head.kind.as_str()) == (campaign, kind.name())
        && (head.from, head.to) == (block.start, block.end)
        && head.sha256 == hexadecimal(&Sha256::digest(rest));
    if !is_it {
        return Ok(None);
    }
    Ok(rest.lines().map(|line| serde_json::from_str(line).ok()).collect())
}

/// Makes a folder for parts.
///
/// # Errors
/// A folder that cannot be made.
pub fn make_folder(folder: &Path) -> Result<(), Report> {
    let refuse = |error| Diagnostic::error(format!("the folder {} cannot be made: {error}", folder.display()));
    std::fs::create_dir_all(folder).map_err(|error| refuse(error).into())
}
