//! Extensions from the command line: the guide as a newcomer types it, and the figures of the examples.

use std::fs;
use std::path::Path;

use super::session::Session;

fn document(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap()
}

/// The commands of a document, in its order.
fn commands(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| line.strip_prefix("$ lancer "))
}

#[test]
fn the_guide_goes_from_an_empty_folder_to_figures() {
    let session = Session::new();
    let guide = document("docs/extension-guide.md");
    for block in guide.split("```asm\n").skip(1) {
        let text = block.split("```").next().unwrap();
        let name = text.lines().next().unwrap().strip_prefix("; file ").expect("a block is a file");
        session.write(name, text);
    }
    let outputs: Vec<String> = commands(&guide)
        .map(|command| {
            // Warnings are part of what is shown: the body divides.
            let run = session.run(command);
            assert!(run.code == 0 && !run.messages.contains("error"), "lancer {command}\n{}", run.messages);
            run.out
        })
        .collect();
    assert!(outputs.len() <= 10, "{} commands", outputs.len());
    assert!(outputs[1].contains("unit.isa: 1 instruction"), "{}", outputs[1]);
    // 0.6 and 0.8 with 16 fraction bits.
    assert!(outputs[2].contains("39322") && outputs[2].contains("52429"), "{}", outputs[2]);
    assert!(outputs[3..6].iter().all(|text| text.contains("The pictures are identical")), "{}", outputs[3]);
}

/// Copies the folder of the examples.
fn with_examples(session: &Session) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for folder in fs::read_dir(root.join("extensions")).unwrap() {
        let folder = folder.unwrap().path();
        fs::create_dir_all(session.path("extensions").join(folder.file_name().unwrap())).unwrap();
        for file in fs::read_dir(&folder).unwrap() {
            let file = file.unwrap().path();
            let name = file.strip_prefix(root).unwrap().to_str().unwrap().to_owned();
            session.write(&name, &fs::read_to_string(&file).unwrap());
        }
    }
}

#[test]
fn the_figures_of_the_examples_are_those_that_the_commands_print() {
    let session = Session::new();
    with_examples(&session);
    let text = document("docs/extensions.md");
    let mut compared = 0;
    for part in text.split("\n$ lancer ").skip(1) {
        let (command, shown) = part.split_once("\n\n").unwrap();
        let printed = session.succeed(command);
        let shown = shown.split("\n### ").next().unwrap();
        assert_eq!(shown.trim_end(), printed.trim_end(), "lancer {command}");
        assert!(printed.contains("The pictures are identical"), "{printed}");
        compared += 1;
    }
    assert_eq!(compared, fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("extensions")).unwrap().count());
}

#[test]
fn a_comparison_without_the_extension_is_a_plain_run() {
    let session = Session::new();
    with_examples(&session);
    let options = "--size 8x6 --shift 0.137,0.071";
    let kernel = "--kernel descend=extensions/kdstep/descend.s";
    let file = "extensions/kdstep/kdstep.isa";
    let compared = session.json(&format!("extension compare {file} --scene cornell {kernel} {options}"));
    let plain = session.json(&format!("render cornell {options}"));
    let with = session.json(&format!("render cornell {options} {kernel} --ext {file}"));
    assert_eq!(compared["without"]["run_hash"], plain["run_hash"]);
    assert_eq!(compared["with"]["run_hash"], with["run_hash"]);
    assert_eq!(with["image_hash"], plain["image_hash"]);
    assert_eq!(with["method"], "replayed");
}

#[test]
fn a_bad_file_is_refused_by_every_command_that_takes_one() {
    let session = Session::new();
    session.write(
        "bad.isa",
        ".extension bad\n.instr vadd (d: V) \"custom0 ddddd ---------------------\" [Done(add 3)]\n vmov d, d\n.end\n",
    );
    session.write("a.s", "    halt\n");
    for command in [
        "extension check bad.isa",
        "run a.s --ext bad.isa",
        "assemble a.s --ext bad.isa",
        "render triangle --ext bad.isa",
    ] {
        session.fail(command, 1, "`vadd` is an instruction already");
        session.fail(command, 1, "bad.isa:2:8");
    }
}

#[test]
fn an_instruction_with_a_meaning_in_rust_is_checked_but_not_run() {
    let session = Session::new();
    let file = ".extension r\n;; Noise.\n.instr noise (d: S) \"custom0 ddddd ---------------------\" [Done(logic 1)]\n    .meaning rust\n.end\n";
    session.write("r.isa", file);
    session.write("a.s", "    noise s1\n    halt\n");
    let checked = session.succeed("extension check r.isa");
    assert!(checked.contains("meaning in Rust") && checked.contains("0 warnings"), "{checked}");
    assert!(session.succeed("assemble a.s --ext r.isa --list").contains("noise s1"));
    let run = session.run("run a.s --ext r.isa");
    assert_eq!(run.code, 3);
    assert!(run.messages.contains("no meaning in Rust is attached"), "{}", run.messages);
    assert!(run.messages.contains("docs/extensions.md"), "{}", run.messages);
}

/// Draws with the kernels and the instructions that `suggest` wrote with a prefix.
fn drawn_with(session: &Session, prefix: &str, options: &str) -> serde_json::Value {
    let names = session.names();
    let start = format!("{prefix}-");
    let kernels = names.iter().filter_map(|name| name.strip_prefix(&start)?.strip_suffix(".s"));
    let kernels: Vec<String> = kernels.map(|name| format!("--kernel {name}={prefix}-{name}.s")).collect();
    session.json(&format!("render cornell {options} --ext {prefix}.isa {}", kernels.join(" ")))
}

#[test]
fn suggestions_save_what_they_say_and_draw_the_same_picture() {
    let session = Session::new();
    let options = "--size 16x12 --shift 0.137,0.071";
    let text = session.succeed(&format!("extension suggest cornell {options} -o fast"));
    assert!(text.contains("The pictures are identical"), "{text}");
    assert!(text.lines().filter(|line| line.starts_with(" fast")).count() >= 3, "{text}");
    assert_eq!(session.run("extension check fast.isa").code, 0);
    let plain = session.json(&format!("render cornell {options}"));
    let fused = drawn_with(&session, "fast", options);
    assert_eq!(fused["image_hash"], plain["image_hash"]);
    assert_eq!((&fused["counts"], &fused["clocks"]), (&plain["counts"], &plain["clocks"]));
    let instructions = |result: &serde_json::Value| result["instructions"].as_u64().unwrap();
    let (before, after) = (instructions(&plain), instructions(&fused));
    assert!(after * 100 <= before * 97, "{after} of {before}");
    let saved = format!("together {} of", grouped(before - after));
    assert!(text.contains(&saved), "{saved}\n{text}");
    session.fail("extension suggest cornell --size 4x3 -o Fast", 2, "small letters");
    // The loader would take `s1` for a register.
    for prefix in ["s", "v", "w", "folder/s"] {
        session.fail(&format!("extension suggest cornell --size 4x3 -o {prefix}"), 2, "is a register");
    }
    assert!(!session.names().iter().any(|name| name == "s.isa"));
}

#[test]
fn suggestions_for_each_profile_save_what_the_docs_say() {
    let session = Session::new();
    let docs = document("docs/extensions.md");
    let row = |name: &str| -> Vec<String> {
        let line = docs.lines().find(|line| line.starts_with(name)).expect("the docs have the table");
        line.trim_matches('|').split('|').skip(1).map(|cell| cell.trim().trim_matches('`').to_owned()).collect()
    };
    // Each profile is a column of the docs' table: its name, the instructions and the clocks that it saves
    for ((profile, percent), clocks) in row("| profile |").iter().zip(row("| saved |")).zip(row("| clocks |")) {
        let options = format!("--size 16x12 --shift 0.137,0.071 --profile {profile}");
        let result = session.json(&format!("extension suggest cornell {options} -o {profile}"));
        let suggestions = result["suggestions"].as_array().unwrap();
        let sum = |key: &str| suggestions.iter().map(|found| found[key].as_u64().unwrap()).sum::<u64>();
        let comparison = &result["comparison"];
        let instructions = |variant: &str| comparison[variant]["instructions"].as_u64().unwrap();
        assert_eq!(instructions("without"), result["instructions"]);
        assert_eq!(instructions("without") - instructions("with"), sum("saved"), "{profile}");
        let share = 100.0 * sum("saved") as f64 / instructions("without") as f64;
        assert_eq!(format!("{share:.1} %"), percent, "{profile}");
        // Clocks are what the suggestions save at most, which is also what they are ranked by.
        let busy = result["busy_clocks"].as_u64().unwrap();
        assert_eq!(format!("{:.1} %", 100.0 * sum("saved_clocks") as f64 / busy as f64), clocks, "{profile}");
        let order: Vec<u64> = suggestions.iter().map(|found| found["saved_clocks"].as_u64().unwrap()).collect();
        assert!(order.is_sorted_by(|a, b| a >= b), "{profile}: {order:?}");
        assert!(suggestions.len() >= 3, "{profile}");
        // A suggestion costs what its body does, so it changes neither the picture nor what is counted.
        for key in ["image_hash", "counts", "clocks"] {
            assert_eq!(comparison["with"][key], comparison["without"][key], "{profile} {key}");
        }
        assert_eq!(comparison["expanded"]["instructions"], comparison["without"]["instructions"], "{profile}");
        let drawn = drawn_with(&session, profile, &options);
        assert_eq!(drawn["run_hash"], comparison["with"]["run_hash"], "{profile}");
    }
}

#[test]
fn sequences_need_not_stand_side_by_side() {
    let session = Session::new();
    let result = session.json("extension suggest cornell --size 16x12 --shift 0.137,0.071 --most 24 -o wide");
    let suggestions = result["suggestions"].as_array().unwrap();
    assert!(suggestions.iter().any(|found| found["apart"].as_u64().unwrap() != 0), "{suggestions:?}");
    let comparison = &result["comparison"];
    for key in ["image_hash", "counts", "clocks"] {
        assert_eq!(comparison["with"][key], comparison["without"][key], "{key}");
    }
    // More instructions save more, and none of them costs a word.
    let saved: Vec<u64> = suggestions.iter().map(|found| found["saved_clocks"].as_u64().unwrap()).collect();
    assert!(saved.is_sorted_by(|a, b| a >= b), "{saved:?}");
    let words = |variant: &str| comparison[variant]["words"].as_u64().unwrap();
    assert!(words("with") < words("without"));
}

/// 1234567 as 1,234,567.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let parts: Vec<&str> = digits.as_bytes().rchunks(3).rev().map(|part| std::str::from_utf8(part).unwrap()).collect();
    parts.join(",")
}
