//! Extensions from the command line: the guide as a newcomer types it, and the figures of the examples.

use std::fs;
use std::path::Path;

use crate::session::Session;

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
