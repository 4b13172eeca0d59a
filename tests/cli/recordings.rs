//! Recordings that are kept in a folder: they change no octet of a result, whoever reads, writes, damages or kills.

use std::path::PathBuf;
use std::process::{Child, Stdio};

use super::session::Session;

/// A small study of 8 recordings, and another one of other machines that needs the same.
const STUDY: &str = "name = \"small\"\n[settings]\nview.size = [8, 6]\n[product]\nscene = [\"cornell\", \"slabs\"]\nword = [32, 24]\n\
                     machine = [\"report\", \"wide32\"]\ncores = [1, 3]\n";
const OTHER: &str = "name = \"other\"\n[settings]\nview.size = [8, 6]\n[product]\nscene = [\"cornell\", \"slabs\"]\nword = [32, 24]\n\
                     machine = [\"report\", \"wide32\"]\narbiter = [\"tdma\"]\n";
const RECORDINGS: usize = 8;

/// A folder with both studies, and the table of the first one without recordings that are kept.
fn session() -> (Session, Vec<u8>) {
    let session = Session::new();
    session.write("study.toml", STUDY);
    session.write("other.toml", OTHER);
    assert_eq!(session.run("sweep study.toml -o plain.csv").code, 0);
    let plain = session.read("plain.csv");
    (session, plain)
}

/// Files of recordings in a folder, sorted.
fn kept(session: &Session, folder: &str) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(session.path(folder)) else { return Vec::new() };
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut kept: Vec<PathBuf> = paths.filter(|path| path.to_string_lossy().ends_with(".recording")).collect();
    kept.sort();
    kept
}

/// Runs the study with kept recordings to a table of this name, compares it with the one without, and gives what was said of recordings.
fn swept(session: &Session, plain: &[u8], name: &str) -> (String, String) {
    let run = session.run(&format!("sweep study.toml -o {name}.csv --recordings kept"));
    assert_eq!(run.code, 0, "{}", run.messages);
    assert!(session.read(&format!("{name}.csv")) == plain, "{name}");
    (run.out.lines().next().unwrap().to_owned(), run.messages)
}

#[test]
fn kept_recordings_change_no_octet_and_serve_other_studies() {
    let (session, plain) = session();
    let (first, _) = swept(&session, &plain, "first");
    assert_eq!(first, "16 points from 8 recordings (0 of them kept); 0 were there");
    assert_eq!(kept(&session, "kept").len(), RECORDINGS);
    let (second, messages) = swept(&session, &plain, "second");
    assert_eq!(second, "16 points from 8 recordings (8 of them kept); 0 were there");
    assert!(!messages.contains("anew"), "{messages}");
    // Another study's points replay the same recordings, also where a recording has but one of them.
    assert_eq!(session.run("sweep other.toml -o other.csv").code, 0);
    let run = session.run("sweep other.toml -o again.csv --recordings kept");
    assert!(run.out.starts_with("8 points from 8 recordings (8 of them kept); 0 were there"), "{}", run.out);
    assert_eq!(session.read("again.csv"), session.read("other.csv"));
    // A plan's processes share the folder too.
    assert_eq!(session.run("sweep plan study.toml -o plan.jsonl").code, 0);
    for shard in 1..=3 {
        let run = session.run(&format!("sweep run plan.jsonl --out parts --shard {shard}/3 --recordings kept"));
        assert_eq!((run.code, run.messages.as_str()), (0, ""));
    }
    session.succeed("sweep merge parts --expect plan.jsonl -o merged.csv");
    assert_eq!(session.read("merged.csv"), plain);
    session.fail("sweep run plan.jsonl --out parts --recordings plan.jsonl", 1, "for recordings cannot be made");
    session.fail("sweep run plan.jsonl --out parts --recordings-limit 3", 2, "--recordings");
}

#[test]
fn damaged_recordings_are_made_anew() {
    let (session, plain) = session();
    swept(&session, &plain, "first");
    let files = kept(&session, "kept");
    let whole: Vec<Vec<u8>> = files.iter().map(|path| std::fs::read(path).unwrap()).collect();
    let flipped = |at: usize, octets: &[u8]| {
        let mut octets = octets.to_vec();
        octets[at] ^= 4;
        octets
    };
    // Octets 0 to 15 say that it is a recording, then come version, digest, length and sum.
    let damages: [(Vec<u8>, &str); RECORDINGS] = [
        (whole[0][..whole[0].len() - 5].to_vec(), "it is cut short, or longer than it says"),
        (flipped(whole[1].len() / 2, &whole[1]), "it was changed, or cut short"),
        (flipped(3, &whole[2]), "it is no recording"),
        (flipped(16, &whole[3]), "it has another version of the format"),
        (whole[0].clone(), "it is another recording under this name"),
        (flipped(55, &whole[5]), "it is cut short, or longer than it says"),
        (Vec::new(), "it is cut short"),
        (flipped(80, &whole[7]), "it was changed, or cut short"),
    ];
    for (path, (octets, _)) in files.iter().zip(&damages) {
        std::fs::write(path, octets).unwrap();
    }
    let (said, messages) = swept(&session, &plain, "second");
    assert_eq!(said, "16 points from 8 recordings (0 of them kept); 0 were there");
    for (path, (_, why)) in files.iter().zip(&damages) {
        let name = path.file_name().unwrap().to_string_lossy();
        let line = messages.lines().find(|line| line.contains(&*name)).unwrap_or_else(|| panic!("{name}\n{messages}"));
        assert!(line.ends_with(&format!("is recorded anew: {why}")), "{line}");
    }
    // They are as they were.
    for (path, whole) in files.iter().zip(&whole) {
        assert!(std::fs::read(path).unwrap() == *whole, "{}", path.display());
    }
}

#[test]
fn processes_that_make_the_same_recordings_do_no_harm() {
    let (session, plain) = session();
    let start = |name: &str| -> Child {
        let mut command = session.command(&format!("sweep study.toml -o {name}.csv --recordings kept"));
        command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    };
    // One is killed when it has kept something, while others make the same.
    let (mut killed, others) = (start("killed"), ["one", "two"].map(|name| (name, start(name))));
    while kept(&session, "kept").is_empty() && killed.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let _ = killed.kill();
    killed.wait().unwrap();
    for (name, mut child) in others {
        assert!(child.wait().unwrap().success());
        assert!(session.read(&format!("{name}.csv")) == plain, "{name}");
    }
    assert_eq!(kept(&session, "kept").len(), RECORDINGS);
    let (said, messages) = swept(&session, &plain, "last");
    assert!(said.contains("(8 of them kept)") && !messages.contains("anew"), "{said}\n{messages}");
}

#[test]
fn a_folder_of_recordings_stays_within_its_bound() {
    let (session, plain) = session();
    swept(&session, &plain, "first");
    let size = |folder: &str| -> Vec<u64> {
        kept(&session, folder).iter().map(|path| std::fs::metadata(path).unwrap().len()).collect()
    };
    let sizes = size("kept");
    // Room for all but the last one that comes, at least.
    let limit = sizes.iter().sum::<u64>() - 1;
    let run = |name: &str, limit: u64| {
        let gibibytes = limit as f64 / f64::from(1 << 30);
        let run =
            session.run(&format!("sweep study.toml -o {name}.csv --recordings {name} --recordings-limit {gibibytes}"));
        assert_eq!(run.code, 0, "{}", run.messages);
        assert!(session.read(&format!("{name}.csv")) == plain, "{name}");
        run.messages
    };
    assert!(!run("tight", limit).contains("not kept"));
    let found = size("tight");
    assert!(found.iter().sum::<u64>() <= limit && (1..RECORDINGS).contains(&found.len()), "{found:?} of {sizes:?}");
    // Nothing fits: it is said, and the results are the same.
    assert_eq!(run("none", 1_000).matches("is not kept").count(), RECORDINGS);
    assert!(size("none").is_empty());
}

#[test]
fn other_commands_use_what_a_study_has_kept() {
    let (session, plain) = session();
    swept(&session, &plain, "first");
    let before = kept(&session, "kept");
    for command in [
        "cores cornell --size 8x6 --cores 1-3 --machine report,wide32",
        "advise cornell --size 8x6",
        "accuracy cornell --size 8x6 --words 32,24 --profiles vector --roundings RND --layouts wide --bounces 5 --cutoffs 0 --interpolate none",
    ] {
        let alone = session.succeed(&format!("{command} --json"));
        assert_eq!(session.succeed(&format!("{command} --json --recordings kept")), alone, "{command}");
        // Again, with the recordings that it has kept itself.
        assert_eq!(session.succeed(&format!("{command} --json --recordings kept")), alone, "{command}");
    }
    // The recordings of the study are those of the commands: none was made twice under another name.
    session.succeed("cores cornell --size 8x6 --cores 1-3 --machine report,wide32 --json --recordings other");
    for path in kept(&session, "other") {
        let name = path.file_name().unwrap();
        assert!(before.iter().any(|known| known.file_name() == Some(name)), "{}", path.display());
    }
}
