//! `docs/layouts.md` is what the tables of the layouts say.

use std::fs;
use std::path::Path;

use scenes::layout;

/// Set to 1, this environment variable makes the test write the manual instead of comparing it.
const BLESS: &str = "LANCER_BLESS";

#[test]
fn the_manual_of_the_layouts_is_not_stale() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/layouts.md");
    let manual = layout::manual();
    if std::env::var_os(BLESS).is_some_and(|value| value != "0") {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, &manual).unwrap();
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    let stale = written.lines().zip(manual.lines()).position(|(written, manual)| written != manual);
    let line = stale.unwrap_or_else(|| written.lines().count().min(manual.lines().count())) + 1;
    assert!(
        written == manual,
        "docs/layouts.md is stale from line {line} on. Write it anew: {BLESS}=1 cargo test -p lancer-scenes --test scenes manual_layouts"
    );
}

#[test]
fn every_field_is_in_the_manual() {
    let manual = layout::manual();
    let sets = layout::Layout::ALL.map(layout::Layout::fixed_structures);
    // The widths of `packed` are those of a scene; its names stand there all the same.
    let sets = layout::Layout::ALL.iter().zip(&sets).filter(|&(&layout, _)| layout != layout::Layout::Packed);
    for structure in sets.flat_map(|(_, set)| set.all()) {
        for (start, field) in structure.places() {
            let row = format!("| {} | {} | `{}` |", start / 8, field.octets(), field.name);
            assert!(manual.contains(&row), "{}: {row}", structure.name);
        }
    }
}
