//! Protections as keys of the machine: each command counts them, and `lancer inject` takes them from there.

use emu::inject::{FaultKind, Protection};
use emu::machine::config::ProtectionConfig;
use serde_json::Value;

use crate::cli::session::Session;

/// A machine with a code in memory, whose results are computed twice.
const SAFE: &str = "cores = 3\n[protection]\nmemory = \"ecc\"\nresults = \"duplicated\"\nlost_grant = \"retry\"\n";

#[test]
fn a_machine_says_what_it_protects_and_reads_back_as_itself() {
    let session = Session::new();
    session.write("safe.toml", SAFE);
    let text = session.succeed("machine safe.toml");
    for kind in ProtectionConfig::keys() {
        let next = if kind.protections().len() == 1 { " or " } else { ", " };
        let protected = kind.protected().expect("a key has something to protect");
        assert!(text.contains(&format!("# {protected}: none{next}{}", kind.protections()[0].name())), "{text}");
    }
    for line in [
        "[protection]\n",
        "memory = \"ecc\"\n",
        "results = \"duplicated\"\n",
        "bus = \"none\"\n",
        "none, parity (1 bit a word) or ecc (7 bits a word) (ours: none; the report has none)\n",
        // Clocks are those of one execution; the comment has those of two.
        "mul = 1 # 2, executed twice\n",
    ] {
        assert!(text.contains(line), "{line} is not in\n{text}");
    }
    session.write("again.toml", &text);
    let [one, other] = ["safe.toml", "again.toml"].map(|file| session.json(&format!("machine {file}")));
    assert_eq!(one["machine"]["protection"], other["machine"]["protection"]);
    assert_eq!(one["machine"]["clocks"]["mul"], 1);
    assert_eq!((&one["resolved"]["clocks"]["mul"], &one["resolved"]["clocks"]["move"]), (&2.into(), &0.into()));
    assert_eq!(one["machine"]["protection"]["doubled_grant"], Value::Null, "nothing protects from it");
}

#[test]
fn names_that_protect_nothing_are_refused() {
    let session = Session::new();
    // In the place of a key without a protection all that there are are named.
    let mut keys: Vec<String> =
        ProtectionConfig::keys().map(|kind| format!("machine.protection.{}", kind.name())).collect();
    keys.sort();
    let keys = format!(", {}, machine.step_limit", keys.join(", "));
    for (set, message) in [
        ("protection.memory=ec", "did you mean `ecc`?"),
        ("protection.memory=ec", "unknown protection `ec`, expected one of `none`, `parity`, `ecc`\n"),
        ("protection.stuck_arbiter=retri", "unknown protection `retri`, expected one of `none`, `watchdog`\n"),
        ("protection=ecc", "a table is expected, not text \"ecc\""),
        ("protection.memory=residue", "`protection.memory` is `residue`, but must be one of none, parity, ecc"),
        ("protection.memory=residue", "`residue` protects results"),
        ("protection.memry=ecc", "did you mean"),
        ("protection.doubled_grant=ecc", &keys),
        // A beat is out of its range before a slot has to hold it.
        ("bus.arbiter=tdma --set bus.clocks_per_beat=600000000000000000", "the nearest possible value is 1000000"),
    ] {
        session.fail(&format!("render triangle --size 2x2 --set {set}"), 1, message);
    }
    session.write("wrong.toml", "[protection]\nresults = \"parity\"\ngrant = \"retry\"\n");
    session.fail("render triangle --machine wrong.toml", 1, "wrong.toml:2:11");
    session.fail("render triangle --machine wrong.toml", 1, "unknown structure `grant`, expected one of `registers`");
}

/// Costs of all protections as `lancer inject` has them.
fn costs(session: &Session, picture: &str) -> Vec<(FaultKind, Protection, Value)> {
    let result = session.json(&format!("inject {picture} --injections 1"));
    let mut found = Vec::new();
    for kind in ProtectionConfig::keys() {
        let kinds = result["kinds"].as_array().unwrap();
        let effects = kinds.iter().find(|one| one["kind"] == kind.name()).unwrap()["protections"].as_array().unwrap();
        for &protection in kind.protections() {
            let effect = effects.iter().find(|one| one["protection"] == protection.name()).unwrap();
            found.push((kind, protection, effect["cost"].clone()));
        }
    }
    found
}

#[test]
fn a_protected_picture_takes_what_inject_says_that_it_costs() {
    let session = Session::new();
    let picture = "mirrors --size 5x4";
    let plain = session.json(&format!("render {picture} --energy"));
    assert_eq!(plain["protection"], serde_json::json!({ "octets": 0, "storage_bits": 0 }));
    let whole = |value: &Value| value.as_i64().unwrap();
    let least = |result: &Value| result["energy"]["frame_nj"]["least"].as_f64().unwrap();
    let (mut clocks, mut octets, mut bits, mut energy) = (0, 0, 0, 0);
    for (kind, protection, cost) in costs(&session, picture) {
        let name = format!("protection.{}={}", kind.name(), protection.name());
        let protected = session.json(&format!("render {picture} --energy --set {name}"));
        // A frame without a fault is the same frame.
        for key in ["image_hash", "instructions", "counts", "octets"] {
            assert_eq!(protected[key], plain[key], "{name} {key}");
        }
        assert_eq!(protected["bus"]["moved"], plain["bus"]["moved"], "{name}");
        assert_eq!(whole(&protected["clocks"]) - whole(&plain["clocks"]), whole(&cost["clocks"]), "{name}");
        assert_eq!(protected["protection"]["octets"], cost["octets"], "{name}");
        assert_eq!(protected["protection"]["storage_bits"], cost["storage_bits"], "{name}");
        let more = least(&protected) - least(&plain);
        // No table has a figure for a bit on the bus, for a program store or for a counter.
        use FaultKind::{Buffer, Memory, Registers, Results};
        let has_figure = matches!(kind, Registers | Buffer | Memory | Results);
        assert_eq!(cost["energy_nj"].is_null(), !has_figure, "{name}");
        let wanted = cost["energy_nj"]["least"].as_f64().unwrap_or(0.0);
        assert!((more - wanted).abs() < 1e-6 * least(&plain), "{name}: {more} {wanted}");
        // Check bits in a core take place in it.
        let has_area = matches!(kind, Registers | Buffer);
        let area = |result: &Value| result["energy"]["area_um2"]["most"].as_f64().unwrap();
        assert_eq!(area(&protected) > area(&plain), has_area, "{name}");
        clocks += usize::from(whole(&cost["clocks"]) != 0);
        octets += usize::from(whole(&cost["octets"]) != 0);
        bits += usize::from(whole(&cost["storage_bits"]) != 0);
        energy += usize::from(wanted != 0.0);
    }
    // Two codes each of memory and bus, and results computed twice; two codes each of registers, buffer, program and memory; two each of what has
    // figures.
    assert_eq!((clocks, octets, bits, energy), (5, 4, 8, 8));
    session.write("safe.toml", SAFE);
    let text = session.run(&format!("render {picture} --machine safe.toml --full")).out;
    assert!(text.contains("protected: memory ecc, results duplicated, lost_grant retry; "), "{text}");
}

#[test]
fn several_protections_take_what_each_takes_by_itself() {
    let session = Session::new();
    // On one core nobody waits for another one's burst, so clocks of computing and of the bus add up.
    let one = "mirrors --size 5x4 --cores 1 --set main.traffic=false";
    let plain = session.json(&format!("render {one}"));
    let all = ["memory=ecc", "bus=parity", "registers=ecc", "buffer=parity", "results=duplicated", "lost_grant=retry"];
    let keys = |names: &[&str]| names.iter().map(|name| format!(" --set protection.{name}")).collect::<String>();
    let protected = |names: &[&str]| session.json(&format!("render {one}{}", keys(names)));
    let number = |result: &Value, path: &str| result.pointer(path).and_then(Value::as_i64).expect(path);
    let (together, alone) = (protected(&all), all.map(|name| protected(&[name])));
    for path in ["/clocks", "/cores/0/busy", "/bus/busy", "/protection/octets", "/protection/storage_bits"] {
        let more = |result: &Value| number(result, path) - number(&plain, path);
        let (sum, found) = (alone.iter().map(more).sum::<i64>(), more(&together));
        // Two codes on the bus are rounded once in a burst together, and once each by themselves, up to a clock each; octets once in a frame.
        let bursts = if ["/clocks", "/bus/busy"].contains(&path) { number(&plain, "/bus/bursts") } else { 0 };
        let least = sum - bursts;
        let most = sum + i64::from(path == "/protection/octets");
        assert!((least..=most).contains(&found) && found > 0, "{path}: {found}, {sum}");
    }
}

#[test]
fn a_cost_that_is_not_known_is_null() {
    let session = Session::new();
    let base = "inject triangle --size 4x3 --injections 1 --kind memory,registers,bus";
    let cost = |more: &str, kind: &str, protection: &str| {
        let result = session.json(&format!("{base}{more}"));
        let named = |list: &Value, key: &str, name: &str| -> Value {
            list.as_array().unwrap().iter().find(|one| one[key] == name).unwrap().clone()
        };
        named(&named(&result["kinds"], "kind", kind)["protections"], "protection", protection)["cost"].clone()
    };
    // A slot of 2 clocks has room for a beat, and none for its check bits.
    let narrow = " --arbiter tdma --set bus.slot_clocks=2";
    for (kind, protection) in [("memory", "ecc"), ("bus", "parity")] {
        for (key, value) in cost(narrow, kind, protection).as_object().unwrap() {
            assert_eq!(*value, Value::Null, "{kind} {key}");
        }
    }
    let registers = cost(narrow, "registers", "parity");
    assert_eq!((&registers["clocks"], &registers["storage_bits"]), (&0.into(), &(5 * 143).into()));
    // A figure of the machine's own, be it 0, is one.
    let own = |figure: &str| {
        session.write("own.toml", &format!("[energy]\nbus = \"{figure} aJ; mine\"\n"));
        cost(" --machine own.toml", "bus", "ecc")["energy_nj"].clone()
    };
    assert_eq!(own("0"), serde_json::json!({ "least": 0.0, "most": 0.0 }));
    let octets = cost("", "bus", "ecc")["octets"].as_f64().unwrap();
    let (found, wanted) = (own("32000")["least"].as_f64().unwrap(), 8.0 * octets * 32_000e-9);
    assert!((found - wanted).abs() <= 8.0 * 32_000e-9, "{found} {wanted}");
}

#[test]
fn a_core_by_hand() {
    let session = Session::new();
    // One core, whose elementary operations take a clock each.
    let one = "render cornell --size 2x1 --cores 1 --set main.traffic=false";
    let [plain, twice] = ["", " --set protection.results=duplicated"].map(|more| session.json(&format!("{one}{more}")));
    let busy = |result: &Value| result["cores"][0]["busy"].as_u64().unwrap();
    let classes = ["add", "sub", "mul", "div", "cmp"];
    let operations: u64 = classes.iter().map(|class| plain["counts"][class].as_u64().unwrap()).sum();
    assert_eq!((busy(&plain), busy(&twice)), (operations, 2 * operations));
    // The main processor's results are computed twice as well, and its registers have the same check bits: 9,000 * 33 / 32 = 9,281.25 aJ a bit.
    let main_busy = |result: &Value| result["main"]["busy"].as_u64().unwrap();
    assert!(main_busy(&plain) > 0 && main_busy(&twice) == 2 * main_busy(&plain), "{}", plain["main"]);
    let registers = "register = \"9000 aJ; mine\"\n";
    let others = ["add", "sub", "mul", "div", "cmp", "address", "buffer", "memory", "bus"];
    let others: String = others.iter().map(|item| format!("{item} = \"none\"\n")).collect();
    session.write("registers.toml", &format!("[energy]\n{registers}{others}"));
    let energies = ["", " --set protection.registers=parity"].map(|more| {
        session.json(&format!("{one} --machine registers.toml --energy{more}"))["energy"]["tables"][0].clone()
    });
    let [functions, parity] = energies.clone().map(|table| table["functions"].as_array().unwrap().clone());
    let mut programs = std::collections::BTreeSet::new();
    for (function, parity) in functions.iter().zip(&parity) {
        let attojoules = |function: &Value| function["attojoules"].as_u64().unwrap();
        assert_eq!(9_281 * attojoules(function), 9_000 * attojoules(parity), "{function}");
        assert_eq!(function["name"], parity["name"]);
        programs.insert(function["program"].as_str().unwrap());
    }
    assert_eq!(programs.into_iter().collect::<Vec<_>>(), ["cores", "main"]);
    assert_eq!(energies[1]["lines"][0]["formula"], "33/32 x (9000 aJ)");
    // Bursts of 4 octets take 8 clocks, with a code 8 * 39 / 32 = 9.75, which are 10; the few of 2 octets 4 clocks and 4.875, which are 5.
    let words = format!("{one} --set bus.burst_octets=4");
    let [plain, coded] = ["", " --set protection.memory=ecc"].map(|more| session.json(&format!("{words}{more}")));
    let bus = |result: &Value, key: &str| result["bus"][key].as_u64().unwrap();
    let (bursts, short) = (bus(&plain, "bursts"), (8 * bus(&plain, "bursts") - bus(&plain, "busy")) / 4);
    assert_eq!((bus(&coded, "busy"), bus(&coded, "bursts")), (10 * (bursts - short) + 5 * short, bursts));
    assert!(short < 10 && bursts > 500, "{plain}");
    assert_eq!(coded["protection"]["octets"], 7 * bus(&plain, "moved") / 32);
}

#[test]
fn inject_takes_its_protections_from_the_machine() {
    let session = Session::new();
    let base = "inject cornell --size 4x3 --injections 120 --kind registers,memory,results,lost_grant";
    let options = format!("{base} --cores 3 --protect memory=ecc,results=duplicated --protect lost_grant=retry");
    let sets = "--set protection.memory=ecc --set protection.results=duplicated --set protection.lost_grant=retry";
    session.write("safe.toml", SAFE);
    let by_option = session.succeed(&format!("{options} --json --rows option.jsonl"));
    let by_key = session.succeed(&format!("{base} --cores 3 {sets} --json --rows key.jsonl"));
    assert_eq!(by_key, by_option);
    assert_eq!(session.read("key.jsonl"), session.read("option.jsonl"));
    // By a file all but the machine's name is the same.
    let without_name = |text: &str| {
        let mut value: Value = serde_json::from_str(text).unwrap();
        value["settings"]["machine"]["name"].take();
        value
    };
    let by_file = session.succeed(&format!("{base} --machine safe.toml --json"));
    assert_eq!(without_name(&by_file), without_name(&by_option));
    assert_eq!(session.succeed(&format!("{base} --machine safe.toml")), session.succeed(&options));
    // Results are settings: they give themselves again.
    session.write("result.json", &by_file);
    assert_eq!(session.succeed("inject --settings result.json --json"), by_file);
    // Options hold in the place of the machine's keys, the last one for each structure.
    let undone = "--protect memory=none,results=none --protect lost_grant=watchdog,lost_grant=none";
    let [undone, plain] = [format!("{base} --machine safe.toml {undone}"), format!("{base} --cores 3")]
        .map(|command| without_name(&session.succeed(&format!("{command} --json"))));
    assert_eq!(undone, plain);
    // On one line `--set` holds, as after every option.
    let both = format!("{base} --cores 3 --protect memory=ecc,results=duplicated --set protection.memory=none");
    let one = format!("{base} --cores 3 --protect results=duplicated");
    let [both, one] = [both, one].map(|command| session.succeed(&format!("{command} --json")));
    assert_eq!(both, one);
    assert!(one.matches("\"duplicated\"").count() >= 2 && !one.contains("\"protect\""), "{one}");
    // Where nothing does harm, nothing is the most vulnerable.
    let harmless = "inject triangle --size 4x3 --injections 30 --kind memory --protect memory=ecc";
    assert!(!session.succeed(harmless).contains("Most vulnerable"));
    // A code for which a slot has no room is refused as a key of the machine is.
    let narrow = "inject cornell --size 4x3 --arbiter tdma --set bus.slot_clocks=2 --protect memory=ecc";
    session.fail(narrow, 1, "`bus.slot_clocks` is 2");
}

#[test]
fn a_result_with_protections_is_changed_by_options() {
    let session = Session::new();
    let protect = |text: &str| -> Value {
        let result: Value = serde_json::from_str(text).unwrap();
        let keys = result["settings"]["machine"]["protection"].as_object().unwrap().clone();
        Value::Object(keys.into_iter().filter(|(_, name)| name != "none").collect())
    };
    let base = "inject triangle --size 4x3 --injections 3 --kind memory,bus";
    let first = session.succeed(&format!("{base} --protect memory=ecc,bus=parity --json"));
    assert_eq!(protect(&first), serde_json::json!({ "memory": "ecc", "bus": "parity" }));
    session.write("result.json", &first);
    // Results of before had protections beside the machine, or in both places.
    let mut older: Value = serde_json::from_str(&first).unwrap();
    older["settings"]["protect"] = serde_json::json!(["memory=ecc", "bus=parity"]);
    session.write("both.json", &older.to_string());
    older["settings"]["machine"].as_object_mut().unwrap().remove("protection");
    session.write("beside.json", &older.to_string());
    for (more, wanted) in [
        ("", serde_json::json!({ "memory": "ecc", "bus": "parity" })),
        ("--set protection.memory=none", serde_json::json!({ "bus": "parity" })),
        ("--set protection.memory=parity", serde_json::json!({ "memory": "parity", "bus": "parity" })),
        (
            "--protect memory=ecc --set protection.memory=parity --set protection.bus=none",
            serde_json::json!({ "memory": "parity" }),
        ),
    ] {
        for file in ["result.json", "both.json", "beside.json"] {
            let found = session.succeed(&format!("inject --settings {file} --json {more}"));
            // Beside the machine they were an option, in whose place another one stands.
            if file != "beside.json" || !more.starts_with("--protect") {
                assert_eq!(protect(&found), wanted, "{file} {more}");
            }
            if more.is_empty() {
                assert_eq!(found, first, "{file}");
            }
        }
    }
    for file in ["result.json", "both.json"] {
        let other = session.succeed(&format!("inject --settings {file} --json --machine report"));
        assert_eq!(other, session.succeed(&format!("{base} --json")), "{file}");
        let less = session.succeed(&format!("inject --settings {file} --json --protect memory=none"));
        assert_eq!(less, session.succeed(&format!("{base} --json --protect bus=parity")), "{file}");
    }
}

#[test]
fn every_study_counts_protections() {
    let session = Session::new();
    let all = [["none", "parity", "ecc"], ["none", "residue", "duplicated"]];
    let render = |memory: &str, results: &str, cores: u32| {
        let sets = format!("--set protection.memory={memory} --set protection.results={results} --cores {cores}");
        session.json(&format!("render triangle --size 4x3 {sets}"))
    };
    session.write(
        "study.toml",
        &format!(
            "name = \"codes\"\n[settings]\nscene = \"triangle\"\nsize = \"4x3\"\n[product]\nprotection.memory = {:?}\nprotection.results = {:?}\n",
            all[0], all[1]
        ),
    );
    // Only results that are computed twice need a recording of their own.
    let run = session.run("sweep study.toml");
    assert!(run.out.starts_with("9 points from 2 recordings; 0 were there\n"), "{}{}", run.out, run.messages);
    let table = String::from_utf8(session.read("codes.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|known| known.ends_with(name)).expect(name);
    let mut clocks = std::collections::BTreeSet::new();
    for row in &rows[1..] {
        let alone = render(row[column("protection.memory")], row[column("protection.results")], 4);
        assert_eq!(row[column("clocks")], alone["clocks"].to_string(), "{row:?}");
        assert_eq!(row[column("image_hash")], alone["image_hash"].as_str().unwrap());
        clocks.insert(row[column("clocks")].to_owned());
    }
    assert_eq!(clocks.len(), 6, "three codes, with results computed once and twice");
    // The same clocks by each command
    let sets = "--set protection.memory=ecc --set protection.results=duplicated";
    let curve = session.json(&format!("cores triangle --size 4x3 --cores 1,4 {sets}"));
    for (point, cores) in curve["machines"][0]["points"].as_array().unwrap().iter().zip([1, 4]) {
        assert_eq!(point["clocks"], render("ecc", "duplicated", cores)["clocks"], "{cores} cores");
    }
    let advice = session.json(&format!("advise triangle --size 4x3 {sets}"));
    assert_eq!(advice["now"]["clocks"], render("ecc", "duplicated", 4)["clocks"]);
    let accuracy = session.json(&format!("accuracy triangle --size 4x3 --words 32 {sets}"));
    // A variant of the same kernels on the 12 pixels
    let frame = render("ecc", "duplicated", 4)["clocks"].as_f64().unwrap();
    let variants = accuracy["variants"].as_array().unwrap();
    assert!(variants.iter().any(|one| (12.0 * one["clocks"].as_f64().unwrap() - frame).abs() < 1e-6), "{accuracy}");
}
