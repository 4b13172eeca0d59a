//! `lancer trace`: the files are read back by the readers of others.

use std::collections::BTreeMap;
use std::io::Cursor;

use fst_reader::{FstFilter, FstHierarchyEntry, FstReader, FstSignalValue};
use serde_json::Value;

use super::session::Session;

/// Values of signals of a wave at each clock of a window, by their names.
struct Wave {
    signals: BTreeMap<String, Vec<String>>,
}

/// Number of octets of the header block without its kind, of which the last 8 are what viewers add to all times.
const HEADER: usize = 329;

impl Wave {
    fn read(octets: Vec<u8>, start: u64, end: u64) -> Wave {
        // Octet 0 is the block's kind, so its 329 octets are 1 to 329: the first 8 are their number, the last 8 are added to all times.
        assert_eq!(octets[1..9], (HEADER as u64).to_be_bytes());
        assert_eq!(octets[HEADER - 7..=HEADER], [0; 8], "times are those of the run as they are");
        let mut reader = FstReader::open(Cursor::new(octets)).expect("it is an FST file");
        let header = reader.get_header();
        assert_eq!((header.timescale_exponent, header.end_time), (-8, end), "a clock of 100 MHz is 10 ns");
        // Name each signal by the scopes around it, such as `core0.state`
        let (mut names, mut scope) = (BTreeMap::new(), Vec::new());
        reader
            .read_hierarchy(|entry| match entry {
                FstHierarchyEntry::Scope { name, .. } => scope.push(name),
                FstHierarchyEntry::UpScope => drop(scope.pop()),
                FstHierarchyEntry::Var { name, handle, .. } => {
                    names.insert(handle.get_index(), format!("{}.{name}", scope.join(".")));
                }
                _ => {}
            })
            .expect("it has signals");
        // A wave holds changes only, so a signal's value at a clock is its last change up to then.
        let mut changes: BTreeMap<String, BTreeMap<u64, String>> = BTreeMap::new();
        let note = |time: u64, handle: fst_reader::FstSignalHandle, value: FstSignalValue| {
            let FstSignalValue::String(value) = value else { panic!("all signals have bits") };
            let value = String::from_utf8(value.to_vec()).unwrap();
            changes.entry(names[&handle.get_index()].clone()).or_default().insert(time, value);
            Ok::<(), ()>(())
        };
        reader.read_signals(&FstFilter::all(), note).expect("it has changes");
        let signals = changes.into_iter().map(|(name, changes)| {
            let at = |clock: u64| changes.range(..=clock).next_back().expect("it has a first value").1.clone();
            (name, (start..end).map(at).collect())
        });
        Wave { signals: signals.collect() }
    }

    fn count(&self, signal: &str, value: &str) -> usize {
        self.signals[signal].iter().filter(|now| *now == value).count()
    }
}

#[test]
fn a_wave_shows_the_bus_and_every_processor() {
    let session = Session::new();
    let scene = "trace cornell --size 12x9 --shift 0.137,0.071 --cores 3";
    let text = session.succeed(&format!("{scene} --clocks 20000..26000 --fst a.fst --perfetto a.json"));
    assert!(text.contains("clocks 20,000 to 26,000 of ") && text.contains("files: a.fst, a.json"), "{text}");
    let wave = Wave::read(session.read("a.fst"), 20_000, 26_000);
    assert_eq!(wave.signals.len(), 5 + 3 * 4 + 3);
    let number = |number: u32| format!("{number:032b}");
    let masters = ["core0", "core1", "core2", "main"];
    for clock in 0..6_000 {
        let at = |signal: &str| wave.signals[signal][clock].as_str();
        let granted: Vec<usize> = (0..4).filter(|&n| at(&format!("{}.grant", masters[n])) == "1").collect();
        // At most one has the bus, and it is who owns it; who waits for a grant or a transfer is waiting.
        assert!(granted.len() <= 1, "clock {clock}: {granted:?}");
        assert_eq!(at("bus.busy") == "1", granted.len() == 1, "clock {clock}");
        let owner = granted.first().map_or("z".repeat(32), |&master| number(master as u32));
        assert_eq!(at("bus.owner"), owner, "clock {clock}");
        for master in masters {
            let is_asking = at(&format!("{master}.request")) == "1" || at(&format!("{master}.grant")) == "1";
            assert_eq!(at(&format!("{master}.state")) == "10", is_asking, "clock {clock} {master}");
        }
    }
    // The trace has the same clocks.
    let trace: Value = serde_json::from_slice(&session.read("a.json")).unwrap();
    let events = trace["traceEvents"].as_array().unwrap();
    let named = |track: u64| {
        let is_name = |event: &&Value| event["name"] == "thread_name" && event["tid"] == track;
        events.iter().find(is_name).unwrap()["args"]["name"].as_str().unwrap().to_owned()
    };
    assert!(events.iter().all(|event| event["tid"].as_u64() > Some(0)), "thread 0 is the idle task of a system");
    assert_eq!((1..6).map(named).collect::<Vec<_>>(), ["core 0", "core 1", "core 2", "main", "bus"]);
    let clocks = |track: u64, name: &str| {
        let is_it = |event: &&Value| {
            event["tid"] == track && event["ph"] == "X" && event["name"].as_str().unwrap().starts_with(name)
        };
        let length = |event: &Value| (event["dur"].as_f64().unwrap() * 100.0).round() as usize;
        events.iter().filter(is_it).map(length).sum::<usize>()
    };
    assert_eq!(clocks(5, ""), wave.count("bus.busy", "1"));
    assert_eq!(clocks(5, "core 1 "), wave.count("core1.grant", "1"));
    for (track, core) in masters.iter().enumerate() {
        for (name, state) in [("idle", "00"), ("busy", "01"), ("waiting", "10")] {
            assert_eq!(clocks(track as u64 + 1, name), wave.count(&format!("{core}.state"), state), "{core} {name}");
        }
    }
    assert!(clocks(1, "pixel ") > 5_000 && clocks(5, "core 0 reads triangles") > 0);
}

#[test]
fn a_pixel_is_shown_from_its_message_to_its_end() {
    let session = Session::new();
    let text = session.succeed("trace cornell --size 12x9 --shift 0.137,0.071 --cores 2 --pixel 5,4");
    assert_eq!(session.names(), ["cornell.fst", "cornell.trace.json"]);
    assert!(text.contains("files: cornell.fst, cornell.trace.json"), "{text}");
    let trace: Value = serde_json::from_slice(&session.read("cornell.trace.json")).unwrap();
    let events = trace["traceEvents"].as_array().unwrap();
    let pixel = events.iter().find(|event| event["name"] == format!("pixel {}", 4 * 12 + 5)).expect("it is there");
    let (first, after) = (&pixel["args"]["first clock"], &pixel["args"]["clock after"]);
    let clocks = (pixel["dur"].as_f64().unwrap() * 100.0).round() as u64;
    assert_eq!(clocks, after.as_u64().unwrap() - first.as_u64().unwrap());
    let own = |event: &&Value| event["tid"] == pixel["tid"] && event["ph"] == "X" && event["name"] != pixel["name"];
    let parts: f64 = events.iter().filter(own).map(|event| event["dur"].as_f64().unwrap()).sum();
    assert!((parts - pixel["dur"].as_f64().unwrap()).abs() < 1e-6, "busy, waiting and idle make up the pixel");
}

/// Nanoseconds of a time in microseconds, as viewers count.
type Counted = fn(f64) -> u64;

#[test]
fn slices_lie_within_or_behind_each_other() {
    let session = Session::new();
    // In the profile `report` many instructions take no clock, and several transfers lie at one clock of computing.
    let rates = [48_000_000, 100_000_000, 2_000_000_000];
    for (clock_hz, profile) in rates.into_iter().flat_map(|rate| [(rate, "ray"), (rate, "report")]) {
        session.write("a.toml", &format!("clock_hz = {clock_hz}\n"));
        let scene = format!("trace cornell --size 8x6 --profile {profile} --machine a.toml");
        session.succeed(&format!("{scene} --clocks 1000..40000 --perfetto a.json"));
        let trace: Value = serde_json::from_slice(&session.read("a.json")).unwrap();
        let ways: [Counted; 2] = [|time| (time * 1e3) as u64, |time| (time * 1e3).round() as u64];
        for counted in ways {
            let mut tracks: BTreeMap<u64, Vec<(u64, u64)>> = BTreeMap::new();
            for event in trace["traceEvents"].as_array().unwrap().iter().filter(|event| event["ph"] == "X") {
                let [start, length] = ["ts", "dur"].map(|key| counted(event[key].as_f64().unwrap()));
                tracks.entry(event["tid"].as_u64().unwrap()).or_default().push((start, start + length));
            }
            assert!((6..=9).all(|track| tracks[&track].len() > 10), "four cores have functions");
            for (track, mut slices) in tracks {
                // The longer one of two that begin together holds the other one.
                slices.sort_by_key(|&(start, end)| (start, u64::MAX - end));
                let mut open: Vec<u64> = Vec::new();
                for (start, end) in slices {
                    open.retain(|&other| other > start);
                    let inner = open.last().copied().unwrap_or(u64::MAX);
                    assert!(end <= inner, "{clock_hz} Hz, track {track}: {start}..{end} reaches beyond {inner}");
                    open.push(end);
                }
            }
        }
    }
}

#[test]
fn functions_are_open_as_long_as_the_accounts_say() {
    let session = Session::new();
    for options in [
        "--cores 2",
        "--cores 3 --profile report",
        "--cores 2 --profile packet --machine wide32",
        "--cores 2 --set machine.cache.octets=1024 --set machine.cache.kind=nodes",
    ] {
        let scene = format!("cornell --size 4x3 --shift 0.137,0.071 {options}");
        let drawn = session.json(&format!("render {scene} --no-error"));
        session.succeed(&format!("trace {scene} --clocks 0..{} --perfetto a.json", drawn["clocks"]));
        let trace: Value = serde_json::from_slice(&session.read("a.json")).unwrap();
        let events = trace["traceEvents"].as_array().unwrap();
        let cores = drawn["cores"].as_array().unwrap();
        for (core, accounts) in cores.iter().enumerate() {
            // Behind the tracks of the cores, the main processor and the bus.
            let track = cores.len() + 3 + core;
            let is_name = |event: &&Value| event["name"] == "thread_name" && event["tid"] == track;
            let name = &events.iter().find(is_name).unwrap()["args"]["name"];
            assert_eq!(name, &format!("core {core} functions"));
            let mut open: BTreeMap<&str, u64> = BTreeMap::new();
            for event in events.iter().filter(|event| event["tid"] == track && event["ph"] == "X") {
                *open.entry(event["name"].as_str().unwrap()).or_default() += event["args"]["clocks"].as_u64().unwrap();
            }
            // The outermost function begins before the message that a work item begins with.
            let rows = accounts["functions"].as_array().unwrap().iter().filter(|row| row["is_function"] != false);
            let mut compared = 0;
            for row in rows.skip(1).filter(|row| row["name"] != "(outside)") {
                let clocks = &row["inclusive"];
                let clocks = clocks["busy"].as_u64().unwrap() + clocks["waiting"].as_u64().unwrap();
                let shown = open.get(row["name"].as_str().unwrap()).copied().unwrap_or(0);
                assert_eq!(shown, clocks, "{options}: core {core}, {}", row["name"]);
                compared += u32::from(clocks != 0);
            }
            assert!(compared > 5, "{options}: {compared}");
        }
    }
}

/// The lines of a trace as JSON.
fn records(octets: &[u8]) -> Vec<Value> {
    let text = std::str::from_utf8(octets).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn the_instructions_of_a_pixel_are_those_that_it_costs() {
    let session = Session::new();
    let scene = "cornell --size 12x9 --shift 0.137,0.071 --pixel 5,4";
    let drawn = session.json(&format!("render {scene} --no-error"));
    let said = session.succeed(&format!("trace {scene} --instructions a.jsonl"));
    let all = records(&session.read("a.jsonl"));
    assert_eq!(drawn["instructions"].as_u64(), Some(all.len() as u64));
    assert!(said.ends_with("written to a.jsonl\n"), "{said}");
    let steps: Vec<u64> = all.iter().map(|record| record["step"].as_u64().unwrap()).collect();
    assert_eq!(steps, (0..all.len() as u64).collect::<Vec<_>>());
    // The answer that the pixel sends is the colour of the picture.
    let last = all.iter().rev().find(|record| record["transfer"]["kind"] == "send").unwrap();
    assert_eq!((&last["transfer"]["octets"], &last["clock"]), (&24.into(), &Value::Null));
    // Registers have names and real values without being told; a window has some of the same records.
    let triangle = session.succeed(&format!("trace {scene} --instructions - --json --window function=triangle"));
    let some = records(triangle.as_bytes());
    let same: Vec<&Value> = all.iter().filter(|record| record["function"] == "triangle").collect();
    assert!(!some.is_empty() && some.iter().eq(same));
    let first = &some.iter().find(|record| record["text"] == "vsub v9, v1, v6").unwrap()["reads"][0];
    assert_eq!((&first["register"], &first["name"], &first["format"]), (&"v1".into(), &"origin".into(), &"pos".into()));
    let bits = first["fraction_bits"].as_u64().unwrap() as i32;
    for (real, raw) in first["real"].as_array().unwrap().iter().zip(first["raw"].as_array().unwrap()) {
        let exact = raw.as_f64().unwrap() * f64::from(-bits).exp2();
        assert!((real.as_f64().unwrap() - exact).abs() <= f64::from(-bits - 1).exp2());
    }
    let text = session.succeed(&format!("trace {scene} --instructions - --window steps=10..12"));
    assert!(text.lines().count() == 3 && text.lines().nth(1).unwrap().trim_start().starts_with("10 "), "{text}");
    session.fail(&format!("trace {scene} --instructions - --window function=triangel"), 2, "did you mean `triangle`?");
    let run = session.run(&format!("trace {scene} --instructions - --window steps=90000000..90000001"));
    assert!(run.code == 0 && run.messages.contains("no instruction lies in the windows"), "{}", run.messages);
    session.fail("trace cornell --clocks 1..2 --instructions -", 2, "cannot be used with");
}

#[test]
fn equal_runs_write_equal_files_and_mistakes_are_told() {
    let session = Session::new();
    for name in ["a", "b"] {
        session.succeed(&format!("trace annex --clocks 100000..200000 --fst {name}.fst --perfetto {name}.json"));
    }
    assert_eq!(session.read("a.fst"), session.read("b.fst"));
    assert_eq!(session.read("a.json"), session.read("b.json"));
    session.fail("trace cornell", 2, "--clocks");
    session.fail("trace cornell --clocks 3..1", 2, "no clock in 3..1");
    session.fail("trace cornell --clocks 1..2 --pixel 1,1", 2, "cannot be used with");
    session.fail("trace cornell --size 4x4 --pixel 4,0", 2, "lies outside a picture of 4 x 4");
    session.fail("trace cornell --size 4x4 --clocks 40000000..40000001", 2, "the frame is over after");
}
