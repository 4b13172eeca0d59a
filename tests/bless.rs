//! Rows of the documents' tables: compared with what is measured, or written as it is, with `LANCER_BLESS=1`.

use std::fs;
use std::path::Path;
use std::sync::Mutex;

/// Tests of one table run at the same time, and each writes its row.
static WRITING: Mutex<()> = Mutex::new(());

/// The row of a document's table that begins with `| name |` is `row`.
pub fn row(document: &str, name: &str, row: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(document);
    let _guard = WRITING.lock().expect("no test panics while it writes");
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{document}: {error}"));
    let columns = row.matches('|').count();
    let is_it = |line: &&str| line.starts_with(&format!("| {name} |")) && line.matches('|').count() == columns;
    let shown = text.lines().find(is_it).unwrap_or_else(|| panic!("{document} has no row of {name}"));
    if std::env::var_os("LANCER_BLESS").is_some() {
        fs::write(&path, text.replace(shown, row)).expect("the documents can be written");
    } else if shown != row {
        drop(_guard);
        panic!("{document} should say\n{row}\nLANCER_BLESS=1 writes it");
    }
}
