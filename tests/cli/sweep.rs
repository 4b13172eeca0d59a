//! Sweeps as a user meets them: plans, shards, parts that are killed, lost or cut short, tables and what is looked at in them.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Stdio;

use lancer::sweep::row::{PointFigures, PointLabels};
use serde_json::Value;

use super::session::Session;

/// A small study: two recordings a scene and word, since `wide32` computes otherwise.
const STUDY: &str = "name = \"small\"\n[settings]\nview.size = [8, 6]\n[product]\nscene = [\"cornell\", \"slabs\"]\nword = [32, 24]\n\
                     machine = [\"report\", \"wide32\", { name = \"bus2\", from = \"report\", bus.octets_per_beat = 2 }]\narbiter = [\"round-robin\", \"tdma\"]\ncores = [1, 3]\n";

/// Points and recordings of it.
const POINTS: usize = 2 * 2 * 3 * 2 * 2;
const RECORDINGS: usize = 2 * 2 * 2;

fn session() -> Session {
    let session = Session::new();
    session.write("study.toml", STUDY);
    session
}

fn planned(session: &Session) -> Vec<Value> {
    let run = session.run("sweep plan study.toml -o plan.jsonl");
    assert_eq!(run.code, 0, "{}", run.messages);
    assert!(run.messages.contains("small: 48 points, 8 recordings, about "), "{}", run.messages);
    let text = String::from_utf8(session.read("plan.jsonl")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn table(session: &Session, name: &str) -> Vec<Vec<String>> {
    let text = String::from_utf8(session.read(name)).unwrap();
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn a_study_runs_as_a_whole_and_its_points_are_those_of_render() {
    let session = session();
    let run = session.run("sweep study.toml");
    assert_eq!(run.code, 0, "{}", run.messages);
    assert!(run.out.starts_with("48 points from 8 recordings; 0 were there\n"), "{}", run.out);
    assert_eq!(session.names(), ["small.csv", "small.parts", "study.toml"]);
    let table = table(&session, "small.csv");
    assert_eq!(table.len(), POINTS + 1);
    let column =
        |name: &str| table[0].iter().position(|known| known == name).unwrap_or_else(|| panic!("no column {name}"));
    let at = |row: &[String], name: &str| row[column(name)].clone();
    for number in [1, 6, 17, 30, 48] {
        let row = &table[number];
        let machine = match at(row, "machine").as_str() {
            "bus2" => "--set bus.octets_per_beat=2".to_owned(),
            name => format!("--machine {name}"),
        };
        let alone = session.json(&format!(
            "render {} --size 8x6 --word {} {machine} --arbiter {} --cores {}",
            at(row, "scene"),
            at(row, "word"),
            at(row, "arbiter"),
            at(row, "cores"),
        ));
        assert_eq!(at(row, "clocks"), alone["clocks"].to_string());
        assert_eq!(at(row, "octets"), alone["octets"].to_string());
        assert_eq!(at(row, "instructions"), alone["instructions"].to_string());
        assert_eq!(at(row, "image_hash"), alone["image_hash"].as_str().unwrap());
        assert_eq!(at(row, "rmse").parse::<f64>().ok(), alone["error"]["rmse"].as_f64());
        assert_eq!(at(row, "utilisation").parse::<f64>().ok(), alone["bus"]["utilisation"].as_f64());
    }
    // Again, nothing is left to do, and the table is the same.
    let before = session.read("small.csv");
    assert!(session.run("sweep study.toml").out.starts_with("0 points from 0 recordings; 48 were there\n"));
    assert_eq!(session.read("small.csv"), before);
}

#[test]
fn a_table_does_not_depend_on_shards_or_on_their_order() {
    let session = session();
    let plan = planned(&session);
    assert_eq!((plan.len(), &plan[0]["recordings"]), (POINTS + 1, &RECORDINGS.into()));
    for (shards, folder) in [(1, "one"), (7, "seven"), (24, "many")] {
        for shard in (1..=shards).rev() {
            session.succeed(&format!("sweep run plan.jsonl --out {folder} --shard {shard}/{shards}"));
        }
        session.succeed(&format!("sweep merge {folder} --expect plan.jsonl -o {folder}.csv"));
        session.succeed(&format!("sweep merge {folder} -o {folder}.jsonl"));
        assert_eq!(session.read(&format!("{folder}.csv")), session.read("one.csv"));
        assert_eq!(session.read(&format!("{folder}.jsonl")), session.read("one.jsonl"));
    }
    // A scheduler's variables say which shard a process is.
    for index in 0..3 {
        let mut command = session.command("sweep run plan.jsonl --out variables --shards 3");
        assert!(command.env("JOB_COMPLETION_INDEX", index.to_string()).output().unwrap().status.success());
    }
    session.succeed("sweep merge variables --expect plan.jsonl -o variables.csv");
    assert_eq!(session.read("variables.csv"), session.read("one.csv"));
}

/// Names of the parts in a folder.
fn parts(folder: &Path) -> Vec<std::path::PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.map(|entry| entry.unwrap().path());
    // Names of files that are being written begin with a point and end otherwise.
    let mut parts: Vec<_> = paths.filter(|path| path.to_string_lossy().ends_with(".part.jsonl")).collect();
    parts.sort();
    parts
}

#[test]
fn what_was_killed_lost_or_cut_short_is_named_and_made_again() {
    let session = session();
    planned(&session);
    session.succeed("sweep run plan.jsonl --out whole");
    session.succeed("sweep merge whole --expect plan.jsonl -o whole.csv");
    let whole = session.read("whole.csv");
    // Killed when some parts are there: merging names the rest, and another run makes them.
    let mut killed = session.command("sweep run plan.jsonl --out parts").stdout(Stdio::null()).spawn().unwrap();
    while parts(&session.path("parts")).len() < 2 && killed.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    let _ = killed.kill();
    killed.wait().unwrap();
    if parts(&session.path("parts")).len() < RECORDINGS {
        session.fail("sweep merge parts --expect plan.jsonl -o parts.csv", 1, "missing");
        assert!(!session.names().contains(&"parts.csv".to_owned()));
    }
    // Two processes on the same work, at once.
    let children: Vec<_> = (0..2)
        .map(|_| session.command("sweep run plan.jsonl --out parts").stdout(Stdio::null()).spawn().unwrap())
        .collect();
    for mut child in children {
        assert!(child.wait().unwrap().success());
    }
    let all = parts(&session.path("parts"));
    assert_eq!(all.len(), RECORDINGS);
    session.succeed("sweep merge parts --expect plan.jsonl -o parts.csv");
    assert_eq!(session.read("parts.csv"), whole);
    // One lost, one cut short, one changed.
    std::fs::remove_file(&all[0]).unwrap();
    let octets = std::fs::read(&all[1]).unwrap();
    std::fs::write(&all[1], &octets[..octets.len() - 7]).unwrap();
    let text = std::fs::read_to_string(&all[2]).unwrap();
    std::fs::write(&all[2], text.replacen("\"clocks\":", "\"clocks\":1", 1)).unwrap();
    let run = session.run("sweep merge parts --expect plan.jsonl -o parts.csv");
    assert_eq!(run.code, 1);
    assert_eq!(run.messages.matches("it was cut short or changed").count(), 2, "{}", run.messages);
    assert!(run.messages.contains("points are missing") && run.messages.contains("machine.cores="), "{}", run.messages);
    assert!(session.succeed("sweep run plan.jsonl --out parts").contains("from 3 recordings"));
    session.succeed("sweep merge parts --expect plan.jsonl -o parts.csv");
    assert_eq!(session.read("parts.csv"), whole);
    // A part twice, and one that contradicts another.
    let copy = session.path("parts/copy.part.jsonl");
    std::fs::copy(&all[3], &copy).unwrap();
    session.fail("sweep merge parts --expect plan.jsonl -o parts.csv", 1, "are in two parts:");
    let text = std::fs::read_to_string(&copy).unwrap();
    let (head, rest) = text.split_once('\n').unwrap();
    let rest = rest.replacen("\"clocks\":", "\"clocks\":1", 1);
    let mut head: Value = serde_json::from_str(head).unwrap();
    head["sha256"] = lancer::result::hexadecimal(&<sha2::Sha256 as sha2::Digest>::digest(&rest)).into();
    std::fs::write(&copy, format!("{head}\n{rest}")).unwrap();
    session.fail("sweep merge parts --expect plan.jsonl -o parts.csv", 1, "in two parts with different results");
    // The plan itself cut short.
    let plan = session.read("plan.jsonl");
    std::fs::write(session.path("plan.jsonl"), &plan[..plan.len() - 3]).unwrap();
    session.fail("sweep run plan.jsonl --out parts", 1, "is no plan");
}

#[test]
fn a_file_that_changes_after_planning_is_refused() {
    let session = Session::new();
    let mesh = |height: u32| format!("OFF\n3 1 0\n0 0 0\n1 0 0\n0 {height} 0\n3 0 1 2\n");
    session.write("one.off", &mesh(1));
    session.write("study.toml", "[settings]\nview.size = [4, 3]\nscene = \"one.off\"\n[product]\ncores = [1, 2]\n");
    assert_eq!(session.run("sweep plan study.toml -o plan.jsonl").code, 0);
    session.write("one.off", &mesh(2));
    session.fail("sweep run plan.jsonl --out parts", 1, "a file has changed since");
}

#[test]
fn points_that_cannot_be_drawn_are_rows_with_a_reason() {
    let session = Session::new();
    session.write("study.toml", "[settings]\nscene = \"cornell\"\nview.size = [4, 3]\nformats.dir = 20\n[product]\nword = [16, 32]\nprofile = [\"ray\", \"report\"]\n");
    assert_eq!(session.run("sweep study.toml -o a.csv").code, 0);
    let table = table(&session, "a.csv");
    let refused: Vec<&str> = table[1..].iter().map(|row| row.last().unwrap().as_str()).collect();
    let is_refused = |reason: &&str| reason.contains("cannot have 20 fraction bits in a word of 16");
    assert_eq!(refused.iter().map(is_refused).collect::<Vec<_>>(), [true, false, true, false]);
    assert_eq!(refused.iter().filter(|reason| reason.is_empty()).count(), 2, "{refused:?}");
}

#[test]
fn points_are_compared_with_the_levels_that_they_name() {
    let session = Session::new();
    session.write(
        "study.toml",
        "[settings]\nscene = \"mirrors\"\nview.size = [12, 9]\n[product]\nresults.reference_bounces = [0, 5]\n",
    );
    let run = session.run("sweep study.toml -o a.csv");
    assert!(run.out.starts_with("2 points from 1 recording;"), "{} {}", run.out, run.messages);
    let table = table(&session, "a.csv");
    let column = table[0].iter().position(|name| name == "rmse").unwrap();
    for (row, bounces) in table[1..].iter().zip([0, 5]) {
        let alone = session.json(&format!("render mirrors --size 12x9 --set results.reference_bounces={bounces}"));
        assert_eq!(row[column].parse::<f64>().ok(), alone["error"]["rmse"].as_f64());
    }
    assert_ne!(table[1][column], table[2][column]);
}

#[test]
fn a_study_is_looked_at() {
    let session = session();
    assert_eq!(session.run("sweep study.toml -o a.csv").code, 0);
    let front = session.succeed("sweep front a.csv -x clocks -y rmse --by scene");
    assert!(front.contains("clocks") && front.contains("cornell") && front.contains("slabs"), "{front}");
    assert!(front.lines().count() < POINTS / 2, "{front}");
    session.succeed("sweep plot a.csv -x cores -y clocks --by machine,scene -o a.svg");
    let svg = String::from_utf8(session.read("a.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("bus2, cornell"), "{svg}");
    let means = session.succeed("sweep table a.csv -x machine -y seconds --by cores");
    assert_eq!(means.lines().count(), 2 + 3, "{means}");
    session.fail("sweep front a.csv -x clock -y rmse", 1, "did you mean `clocks`?");
}

#[test]
fn mistakes_of_a_study_are_named_before_anything_runs() {
    let session = Session::new();
    session.write("study.toml", "[prodct]\n[product]\ncors = [1]\nprofile = [\"rai\"]\n");
    let run = session.run("sweep study.toml");
    assert_eq!(run.code, 1);
    for part in ["study.toml:1:", "did you mean `product`?", "did you mean `cores`?", "did you mean `ray`?"] {
        assert!(run.messages.contains(part), "{part}\n{}", run.messages);
    }
    session.fail("sweep run study.toml --out parts", 1, "is no plan");
    session.fail("sweep merge none --expect study.toml -o a.txt", 2, "ends in none of");
    session.fail("sweep", 2, "STUDY.toml");
    assert_eq!(session.names(), ["study.toml"]);
}

#[test]
fn columns_are_described_and_the_page_is_not_stale() {
    const BLESS: &str = "LANCER_BLESS";
    let columns = PointLabels::columns().into_iter().chain(PointFigures::columns());
    let lines: Vec<String> = columns.map(|(name, _, about)| format!("| `{name}` | {about} |\n")).collect();
    let wanted = format!(
        "<!-- columns -->\n\n| column | what it holds |\n|---|---|\n{}\n<!-- end of columns -->",
        lines.concat()
    );
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/sweep.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let (before, rest) = page.split_once("<!-- columns -->").unwrap();
    let (_, after) = rest.split_once("<!-- end of columns -->").unwrap();
    let now = format!("{before}{wanted}{after}");
    if std::env::var_os(BLESS).is_some_and(|value| value != "0") {
        std::fs::write(&path, &now).unwrap();
    }
    assert!(
        std::fs::read_to_string(&path).unwrap() == now,
        "docs/sweep.md is stale: {BLESS}=1 cargo test -p lancer sweep"
    );
}

#[test]
fn the_studies_of_the_examples_have_the_recordings_that_they_need() {
    let session = Session::new();
    for (name, points, recordings) in [("study", 864, 24), ("shifts", 64, 64)] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/{name}.toml"));
        let run = session.run(&format!("sweep plan {} -o {name}.jsonl", path.display()));
        assert_eq!(run.code, 0, "{}", run.messages);
        let text = String::from_utf8(session.read(&format!("{name}.jsonl"))).unwrap();
        let lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        assert_eq!((lines.len() - 1, &lines[0]["recordings"]), (points, &recordings.into()), "{name}");
        let distinct: BTreeSet<&str> = lines[1..].iter().filter_map(|line| line["recording"].as_str()).collect();
        assert_eq!(distinct.len(), recordings, "{name}");
    }
}
