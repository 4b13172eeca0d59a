//! Messages about wrong sources: every file of `errors/` with its messages as a snapshot.

use std::path::Path;
use std::sync::Arc;

use asm::{Options, assemble};
use isa::Isa;
use messages::{Report, Source};

fn report(name: &str, text: &str) -> Report {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/asm/errors");
    let load = |name: &str, _: &str| -> Result<Arc<Source>, String> {
        let text = std::fs::read_to_string(folder.join(name)).map_err(|_| "there is no such file".to_string())?;
        Ok(Source::new(name, text))
    };
    let options = Options { include: &load, ..Options::default() };
    assemble(&Source::new(name, text), &Isa::base(), &options).expect_err(name)
}

#[test]
fn every_wrong_file_says_what_is_wrong() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/asm/errors");
    let mut names: Vec<String> =
        std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert!(names.len() >= 30, "{} cases", names.len());
    for name in names {
        let text = std::fs::read_to_string(folder.join(&name)).unwrap();
        insta::assert_snapshot!(name.trim_end_matches(".s"), report(&name, &text).render(false));
    }
}

#[test]
fn five_mistakes_show_in_one_run() {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/asm/errors/five_mistakes.s"))
        .unwrap();
    let codes: Vec<_> = report("five_mistakes.s", &text).0.iter().map(|message| message.code.unwrap()).collect();
    assert_eq!(codes, ["E001", "E008", "E007", "E003", "E002"]);
}
