//! Files that commands write and others read: plans, parts and tables of studies, and results that are compared.

use std::ops::Range;
use std::path::Path;
use std::sync::LazyLock;

use emu::inject::{FaultKind, FlipShape};
use emu::machine::config::ProtectionConfig;
use lancer::difference::{self, DiffSide};
use lancer::inject::row::InjectionRow;
use lancer::inject::{self, FaultCampaign};
use lancer::settings::Settings;
use lancer::sweep::contents::Contents;
use lancer::sweep::dataset::{Dataset, DatasetForm};
use lancer::sweep::plan::StudyPlan;
use lancer::sweep::row::{CellKind, PointRow};
use lancer::sweep::study::Study;
use lancer::sweep::{front, group, merge, part, svg};
use messages::Source;
use serde_json::{Value, json};

use super::source;
use crate::project::{files, literals, pieces};
use crate::seen::{PlantedFault, Seen, is_sample};
use crate::surface::Surface;

const LONGEST: usize = 4000;
const MEMORY: usize = 16 << 20;

/// Plans of studies.
pub const PLAN: Surface = Surface::text((LONGEST, MEMORY), "plan", plans, read_plan, &["src/sweep/plan.rs"]);

/// Parts of studies.
pub const PART: Surface =
    Surface::text((LONGEST, MEMORY), "part", parts, read_part, &["src/sweep/part.rs", "src/sweep/merge.rs"]);

/// Parts of campaigns of faults.
pub const INJECTIONS: Surface =
    Surface::text((LONGEST, MEMORY), "injections", injections, read_injections, &["src/inject/part.rs"]);

/// Tables of studies: JSON lines where the first character says so, else CSV.
pub const TABLE: Surface = Surface::text(
    (LONGEST, MEMORY),
    "table",
    tables,
    read_table,
    &["src/sweep/dataset.rs", "src/sweep/front.rs", "src/sweep/chart.rs"],
);

/// Results and files of settings that are compared.
pub const RESULT: Surface = Surface::text((LONGEST, MEMORY), "result", results, read_result, &["src/difference.rs"]);

/// A study of two machines, of which one cannot be drawn.
const STUDY: &str = "name = \"small\"\n[settings]\nscene = \"triangle\"\nview.size = [4, 3]\n[product]\ncores = [1, 2]\nformats.pos = [8, 31]\n";

static PLANNED: LazyLock<(StudyPlan, Vec<PointRow>)> = LazyLock::new(|| {
    let study = Study::parse(&Source::new("a.toml", STUDY), "a");
    let study = study.unwrap_or_else(|report| panic!("{}", report.render(false)));
    let contents = Contents::default();
    let plan = StudyPlan::new(&study, &contents).expect("the study has points");
    let mut rows = Vec::new();
    for point in &plan.points {
        let settings = plan.settings(point, &contents).expect("points have settings");
        for (labels, result) in group::run(&[settings], &contents, None).expect("the scene is there") {
            let (figures, refused) = match result {
                Ok(figures) => (Some(figures), None),
                Err(reason) => (None, Some(reason)),
            };
            rows.push(PointRow { point: point.point.clone(), set: point.set.clone(), labels, figures, refused });
        }
    }
    (plan, rows)
});

fn whole_part(rows: &[PointRow]) -> String {
    part::text(&PLANNED.0.points[0].recording, rows)
}

fn plans() -> Vec<Vec<u8>> {
    [PLANNED.0.octets().collect::<Vec<_>>().concat()].into_iter().chain(literals("src/sweep/plan.rs")).collect()
}

fn parts() -> Vec<Vec<u8>> {
    let rows = &PLANNED.1;
    (1..=2).map(|count| whole_part(&rows[..count]).into_bytes()).collect()
}

/// The block of injections that a part is read for.
const BLOCK: Range<u64> = 0..2;

fn injection(number: u64) -> InjectionRow {
    let row = json!({
        "kind": FaultKind::Registers.name(), "number": number, "class": "trap", "item": 3, "pixel": 3, "moment": 40, "structure": "scalars",
        "place": "s7", "function": "trace", "format": "pos", "format_bits": [4, 9],
        "bits": [4, 9], "change": 0, "wrong_pixels": 0, "largest_difference": 0.0,
        "trap": "bounds", "trap_at": "core 0, word 17", "limit": null, "steps": null, "items": 1,
    });
    serde_json::from_value(row).expect("it has the keys of a row")
}

fn injections() -> Vec<Vec<u8>> {
    let rows: Vec<InjectionRow> = BLOCK.map(injection).collect();
    vec![inject::part::text("c", FaultKind::Registers, &BLOCK, &rows).into_bytes()]
}

fn tables() -> Vec<Vec<u8>> {
    // A table is made of files.
    let folder = std::env::temp_dir().join(format!("lancer-fuzz-{}", std::process::id()));
    let name = folder.join(part::ENDING);
    std::fs::create_dir_all(&folder).expect("there is a folder for temporary files");
    std::fs::write(&name, whole_part(&PLANNED.1)).expect("a temporary file can be written");
    let whole = part::index(whole_part(&PLANNED.1).as_bytes(), &name).expect("a part is one");
    let whole = [whole];
    let table = merge::merge(&whole, &[], None).expect("a part can be merged").dataset().expect("the part is there");
    std::fs::remove_dir_all(&folder).expect("the folder is there");
    let written = [DatasetForm::Csv, DatasetForm::JsonLines].map(|form| table.encode(form).expect("it can be written"));
    let tests = literals("src/sweep/dataset.rs").into_iter().chain(literals("src/sweep/front.rs"));
    pieces(written.into_iter().chain(tests).collect(), LONGEST)
}

fn results() -> Vec<Vec<u8>> {
    let own = Settings::default();
    let written = [
        serde_json::to_vec(&own).expect("settings are JSON"),
        toml::to_string(&own).expect("settings are TOML").into_bytes(),
    ];
    let lists = br#"{"schema":"s","functions":[{"name":"f","calls":1},{"name":"g","calls":4}],"waits":[1,2,[3]]}"#;
    let kept = files("tests/cmd", ".trycmd").into_iter().chain(literals("src/difference.rs"));
    written.into_iter().chain([lists.to_vec()]).chain(pieces(kept.collect(), LONGEST)).collect()
}

fn read_plan(input: &[u8], seen: &mut Seen) {
    match StudyPlan::parse(&String::from_utf8_lossy(input), "a.jsonl") {
        Err(report) => seen.report(&report, input),
        Ok(plan) => {
            seen.count("points", plan.points.len());
            seen.count("groups", plan.groups().len());
            let contents = Contents::default();
            for point in plan.points.iter().take(2) {
                match plan.settings(point, &contents) {
                    Err(failure) => seen.text(&format!("{failure:?}")),
                    Ok(_) => seen.name("settings"),
                }
            }
            let octets = plan.octets().collect::<Vec<_>>().concat();
            let again = StudyPlan::parse(&String::from_utf8_lossy(&octets), "b.jsonl");
            assert!(again.is_ok_and(|again| again == plan), "a plan is read as it was written");
            seen.plant(PlantedFault::Abort, plan.points.iter().any(|point| point.recording.len() < 8));
        }
    }
}

fn read_part(input: &[u8], seen: &mut Seen) {
    let text = String::from_utf8_lossy(input);
    read_whole_part(&text, input, seen);
    // A change breaks the checksum of the head, behind which nothing more would be read: the same with the one that holds.
    let Some((head, rest)) = text.split_once('\n') else { return };
    let Ok(mut head) = serde_json::from_str::<Value>(head) else { return };
    if !head.is_object() {
        return;
    }
    head["sha256"] = part::checksum(rest).into();
    read_whole_part(&format!("{head}\n{rest}"), input, seen);
}

fn read_whole_part(text: &str, input: &[u8], seen: &mut Seen) {
    match part::index(text.as_bytes(), Path::new("a.part.jsonl")) {
        Err(why) => seen.text(&why),
        Ok(whole) => {
            seen.count("rows", whole.rows.len());
            let row = |row: &part::IndexedRow| {
                let line = &text.as_bytes()[row.start as usize..][..row.length as usize];
                serde_json::from_slice::<PointRow>(line).expect("a line of the index is a row")
            };
            let rows: Vec<PointRow> = whole.rows.iter().map(row).collect();
            let drawn = rows.iter().filter(|row| row.figures.is_some()).count();
            seen.count("drawn", drawn);
            let again = part::index(part::text(&whole.recording, &rows).as_bytes(), Path::new("b"));
            let results =
                |part: &part::StudyPart| -> Vec<_> { part.rows.iter().map(|row| (row.point, row.result)).collect() };
            assert!(again.is_ok_and(|again| results(&again) == results(&whole)), "a part is read as it was written");
            let plan = is_sample(input, 2).then_some(&PLANNED.0);
            match merge::merge(&[whole], &[], plan) {
                Err(report) => seen.report(&report, input),
                Ok(table) => seen.count("merged", table.rows()),
            }
            seen.plant(PlantedFault::Panic, drawn == 3);
        }
    }
}

fn read_injections(input: &[u8], seen: &mut Seen) {
    let text = String::from_utf8_lossy(input);
    read_whole_injections(&text, seen);
    // As of the parts of studies.
    let Some((head, rest)) = text.split_once('\n') else { return };
    let Ok(mut head) = serde_json::from_str::<Value>(head) else { return };
    if head.is_object() {
        head["sha256"] = part::checksum(rest).into();
        read_whole_injections(&format!("{head}\n{rest}"), seen);
    }
}

fn read_whole_injections(text: &str, seen: &mut Seen) {
    let Some(rows) = inject::part::parse(text, "c", FaultKind::Registers, &BLOCK) else { return };
    seen.count("bits", rows.iter().map(|row| row.bits.len()).sum());
    seen.count("harmful", rows.iter().filter(|row| row.class.is_harmful()).count());
    let again = inject::part::text("c", FaultKind::Registers, &BLOCK, &rows);
    assert!(
        inject::part::parse(&again, "c", FaultKind::Registers, &BLOCK) == Some(rows.clone()),
        "a part is read as it was written"
    );
    let campaign = FaultCampaign {
        kinds: vec![FaultKind::Registers],
        injections: BLOCK.end,
        shape: FlipShape::SINGLE,
        seed: 1,
        protections: ProtectionConfig::default(),
    };
    let map = inject::map(&campaign, &rows);
    assert_eq!(map.colours.len() as u32, map.size.0 * map.size.1, "a map has its pixels");
    seen.plant(PlantedFault::Panic, rows[1].item == 7);
}

fn read_table(input: &[u8], seen: &mut Seen) {
    let form = if input.first() == Some(&b'{') { DatasetForm::JsonLines } else { DatasetForm::Csv };
    let table = match Dataset::decode(form, input.to_vec(), "a") {
        Err(report) => return seen.report(&report, input),
        Ok(table) => table,
    };
    seen.count("columns", table.columns.len());
    seen.count("rows", table.rows.len());
    assert!(table.rows.iter().all(|row| row.len() == table.columns.len()), "a row has a cell a column");
    let again = table.encode(form).and_then(|octets| Dataset::decode(form, octets, "b"));
    assert!(again.is_ok_and(|again| again.rows.len() == table.rows.len()), "a table has its rows again");
    let of_kind = |is_text: bool| {
        let columns = table.columns.iter().filter(move |(_, kind)| (*kind == CellKind::Text) == is_text);
        columns.map(|(name, _)| name.clone())
    };
    let (numbers, by): (Vec<String>, Vec<String>) = (of_kind(false).collect(), of_kind(true).take(2).collect());
    if let [x, y, ..] = &numbers[..] {
        if let (Ok(points), Ok(means)) = (front::points(&table, x, y, &by), front::means(&table, x, y, &by)) {
            seen.count("front", points.iter().filter(|point| point.is_on_front).count());
            seen.count("means", means.0.len());
            if let Err(report) = svg(&points, x, y) {
                seen.report(&report, input);
            }
            seen.plant(PlantedFault::Large, points.len() == 5);
        }
    }
}

fn read_result(input: &[u8], seen: &mut Seen) {
    let Some(source) = source("a.json", input) else { return };
    let value = match difference::parse(&source) {
        Err(report) => return seen.report(&report, input),
        Ok(value) => value,
    };
    // A result, so that results are compared with it as results.
    static OWN: LazyLock<Value> = LazyLock::new(|| {
        let mut own = serde_json::to_value(Settings::default()).expect("settings are JSON");
        own["schema"] = "s".into();
        own
    });
    let side = |value| DiffSide { name: "a".to_owned(), value };
    let itself = difference::compare(&side(&value), &side(&value), 0.0);
    assert!(itself.is_within && itself.differences.is_empty(), "nothing differs from itself");
    let (there, back) =
        (difference::compare(&side(&value), &side(&OWN), 1.0), difference::compare(&side(&OWN), &side(&value), 1.0));
    assert_eq!(there.compared, back.compared, "both ways have the same keys");
    assert_eq!(there.differences.len(), back.differences.len(), "both ways differ in the same keys");
    seen.count("keys", there.compared);
    seen.count("differences", there.differences.len());
    seen.plant(PlantedFault::Endless, itself.compared % 4 == 1);
}
