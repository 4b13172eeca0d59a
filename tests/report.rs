//! The page on the report names what is there: kernels, rows of the annexes with their printed labels, and commands that the command line
//! knows.

use std::path::{Path, PathBuf};

use clap::CommandFactory;
use kernels::annex::rows;
use lancer::command::Lancer;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The cells of the lines of the table below a heading, without its head.
fn table(text: &str, heading: &str) -> Vec<Vec<String>> {
    let part = text.split(heading).nth(1).unwrap_or_else(|| panic!("there is no {heading}"));
    let lines = part.lines().skip_while(|line| !line.starts_with('|')).take_while(|line| line.starts_with('|'));
    lines.skip(2).map(|line| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()).collect()
}

/// The words of a cell between back ticks.
fn quoted(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

fn has_kernel(name: &str) -> bool {
    Path::exists(&root().join(format!("kernels/asm/report/{name}.s")))
}

#[test]
fn the_page_names_rows_kernels_and_commands_that_are_there() {
    let text = std::fs::read_to_string(root().join("docs/report.md")).unwrap();
    let sections = table(&text, "## Sections");
    assert!(sections.len() > 10, "{sections:?}");
    for line in &sections {
        let [_, _, _, kernels, command] = &line[..] else { panic!("{line:?}") };
        for kernel in quoted(kernels) {
            assert!(has_kernel(kernel), "there is no kernel {kernel}");
        }
        let command = quoted(command)[0];
        let parsed = Lancer::command().try_get_matches_from(command.split_whitespace());
        assert!(parsed.is_ok(), "{command}: {}", parsed.unwrap_err());
    }
    let listed = table(&text, "## Rows of the annexes");
    assert_eq!(listed.len(), rows().len());
    for (line, row) in listed.iter().zip(rows()) {
        assert_eq!((line[0].trim_matches('`'), line[1].as_str()), (row.id.as_str(), row.label.as_str()));
        let kernel = quoted(&line[3])[0];
        assert!(has_kernel(kernel), "there is no kernel {kernel}");
    }
}
