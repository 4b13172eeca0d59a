//! Options of a folder of recordings.

use std::path::PathBuf;

use clap::Args;
use messages::Report;

use crate::sweep::recordings::RecordingStore;
use crate::terminal::Terminal;

/// Folder of recordings that processes and studies share.
#[derive(Args, Clone, Debug)]
pub struct RecordingArguments {
    /// Folder in which recordings are kept, for other points, processes and studies to replay; of pictures up to 8,192 pixels.
    #[arg(long = "recordings", value_name = "FOLDER")]
    folder: Option<PathBuf>,
    /// GiB that this folder may have; what was not used for the longest time makes room.
    #[arg(long = "recordings-limit", value_name = "GIB", default_value = "4", value_parser = gibibytes, requires = "folder")]
    limit: u64,
}

/// Octets of a number of GiB.
fn gibibytes(text: &str) -> Result<u64, String> {
    let number = text.parse().ok().filter(|number: &f64| *number > 0.0 && *number <= 1e6);
    let octets = number.map(|number| (number * f64::from(1 << 30)) as u64);
    octets.ok_or_else(|| "a number of GiB above 0 and up to 1000000 is expected, such as 4 or 0.5".into())
}

impl RecordingArguments {
    /// The store, where one was asked for.
    ///
    /// # Errors
    /// A folder that cannot be made.
    pub fn store(&self) -> Result<Option<RecordingStore>, Report> {
        self.folder.as_deref().map(|folder| RecordingStore::open(folder, self.limit)).transpose()
    }
}

/// Tells what of a store could not be used or kept.
pub fn tell_notes(store: Option<&RecordingStore>, terminal: &Terminal) {
    for note in store.map(RecordingStore::take_notes).unwrap_or_default() {
        terminal.say(&note);
    }
}
