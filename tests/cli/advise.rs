//! `lancer advise`: its figures against runs of the changed machine.

use emu::machine::{Config, RunOptions};
use lancer::advise::{self, Bottleneck};
use lancer::job::Job;
use lancer::load::Load;
use messages::Source;
use scenes::generate::{self, GenerateOptions};
use scenes::layout::Layout;
use serde_json::Value;

use super::session::Session;

/// Machines that are limited by different things.
const MACHINES: [(&str, &str); 6] = [
    ("report", ""),
    (
        "wide32",
        "bus = { octets_per_beat = 4, clocks_per_beat = 1, setup_clocks = 2, burst_octets = 64 }\n[units]\nadd = 3\nsub = 3\nmul = 3\n",
    ),
    ("double_buffer", "bus = { overlap = true }\n"),
    ("node_cache", "cache = { octets = 4096 }\n"),
    (
        "slow products on a fast bus",
        "cores = 2\nbus = { octets_per_beat = 64, clocks_per_beat = 1 }\n[clocks]\nmul = 8\ndiv = 20\n",
    ),
    ("slots", "cores = 6\nbus = { arbiter = \"tdma\", octets_per_beat = 4 }\n"),
];

fn job(size: (u32, u32), machine: &str) -> Job {
    let mut job = Job::new(generate::scene("cornell", &GenerateOptions::default()).unwrap());
    job.view.size = size;
    job.machine = Config::parse(&Source::new("m.toml", machine)).unwrap();
    job
}

/// The job that an advice asks for, from its words alone.
fn advised(job: &Job, machine: &str, toml: &[String], options: &[String]) -> Job {
    let mut table: toml::Table = machine.parse().unwrap();
    for line in toml {
        let (key, value) = line.split_once(" = ").unwrap();
        let value = format!("value = {value}").parse::<toml::Table>().unwrap()["value"].clone();
        match key.split_once('.') {
            None => drop(table.insert(key.to_owned(), value)),
            Some((section, key)) => {
                let section = table.entry(section).or_insert_with(|| toml::Value::Table(toml::Table::new()));
                section.as_table_mut().unwrap().insert(key.to_owned(), value);
            }
        }
    }
    let mut job = Job { machine: Config::parse(&Source::new("m.toml", table.to_string())).unwrap(), ..job.clone() };
    for option in options {
        match option.split_once(' ').unwrap() {
            ("--profile", set) => job.kernels.profile = set.parse().map_err(|_| set.to_owned()).unwrap(),
            ("--layout", layout) => job.layout = Layout::ALL.into_iter().find(|one| one.name() == layout),
            ("--kd-depth", levels) => job.kd_depth = Some(scenes::kdtree::Depth::Levels(levels.parse().unwrap())),
            (option, value) => panic!("{option} {value}"),
        }
    }
    job
}

#[test]
fn the_first_advice_and_the_best_pair_are_stepped_in_the_predicted_clocks() {
    for (name, machine) in MACHINES {
        let job = job((10, 8), machine);
        let advice = advise::advise(&job, None, &mut |_, _| {}).unwrap_or_else(|failure| panic!("{name}: {failure:?}"));
        let [first, pair] = [&advice.advice[0], &advice.pairs[0]];
        assert!(first.speed_up > 1.0 && pair.speed_up >= first.speed_up, "{name}: {first:?} {pair:?}");
        for one in [first, pair] {
            let changed = advised(&job, machine, &one.toml, &one.options);
            let (load, _) = Load::picture(&changed).unwrap();
            let setup = load.setup(&changed.machine, RunOptions::default());
            let frame = emu::step(&setup, load.memory.clone(), &mut |_| {}).unwrap();
            assert_eq!((frame.clocks.0, frame.method.name()), (one.predicted.clocks, "stepped"), "{name}: {one:?}");
        }
    }
}

#[test]
fn limits_are_those_that_the_machines_were_made_for() {
    let limit = |machine: &str| advise::advise(&job((24, 18), machine), None, &mut |_, _| {}).unwrap().now.limit;
    assert_eq!(limit(MACHINES[0].1), Bottleneck::Bus);
    assert_eq!(limit(MACHINES[4].1), Bottleneck::Computing);
}

#[test]
fn the_pair_found_by_hand_is_matched() {
    // 8 octets a beat and 4 KiB for triangles, in the tree of the report's depth: the bus was full, and 16 cores have work then.
    for cores in [4, 16] {
        let job = job((40, 30), &format!("cores = {cores}\n"));
        let advice = advise::advise(&job, None, &mut |_, _| {}).unwrap();
        let by_hand = "cache = { octets = 4096, kind = \"triangles\" }\nbus = { octets_per_beat = 8 }\n";
        let machine = Config::parse(&Source::new("m.toml", format!("cores = {cores}\n{by_hand}"))).unwrap();
        let (load, _) = Load::picture(&job).unwrap();
        let frame = emu::run(&load.setup(&machine, RunOptions::default()), load.memory.clone(), &mut |_| {}).unwrap();
        let best = &advice.pairs[0];
        assert!(best.predicted.clocks <= frame.clocks.0, "{cores} cores: {best:?} against {} clocks", frame.clocks.0);
    }
}

#[test]
fn keys_and_options_of_advice_can_be_pasted() {
    let session = Session::new();
    let scene = "cornell --size 16x12 --shift 0.137,0.071";
    let result = session.json(&format!("advise {scene}"));
    assert_eq!((&result["schema"], &result["now"]["method"]), (&"lancer-advise-1".into(), &"replayed".into()));
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let words = |value: &Value| value.as_array().unwrap().iter().map(text).collect::<Vec<_>>();
    let mut parts: Vec<String> = Vec::new();
    for advice in result["advice"].as_array().unwrap() {
        // One of each part is tried by itself.
        let part = text(&advice["parts"][0]);
        if parts.contains(&part) {
            continue;
        }
        session.write("m.toml", &(words(&advice["toml"]).join("\n") + "\n"));
        let options = words(&advice["options"]).join(" ");
        let run = session.json(&format!("render {scene} --no-error --machine m.toml {options}"));
        assert_eq!(run["clocks"], advice["predicted"]["clocks"], "{advice}");
        parts.push(part);
    }
    parts.sort();
    let expected = [
        "arbiter",
        "bursts",
        "bus-width",
        "cache",
        "cores",
        "kd-build",
        "kd-depth",
        "kernels",
        "layout",
        "overlap",
        "units",
    ];
    assert_eq!(parts, expected);
    // A table, a list of keys, and a file say the same.
    let shown = session.succeed(&format!("advise {scene} --csv a.csv"));
    assert!(shown.starts_with("The bus limits this machine: it is busy "), "{shown}");
    assert!(shown.contains("bus.octets_per_beat = 16"), "{shown}");
    let csv = String::from_utf8(session.read("a.csv")).unwrap();
    let count = |key: &str| result[key].as_array().unwrap().len();
    assert_eq!(csv.lines().count(), 1 + count("advice") + count("pairs"));
}

#[test]
fn what_is_wrong_is_said_before_the_machines_run() {
    let session = Session::new();
    session.fail("advise cornell --csv no/a.csv", 1, "there is no folder no");
    session.fail("advise annex", 1, "neither a file nor a generated scene");
    session.fail("advise cornell --machine raport", 1, "did you mean `report`?");
}
