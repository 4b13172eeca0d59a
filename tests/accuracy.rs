//! Bits that a picture asks for: docs/accuracy.md and README.md say it, and it is measured again.

use std::process::Command;

use serde_json::Value;

const SCENES: [&str; 5] = ["cornell", "sphereflake", "slabs", "mirrors", "terrain"];

/// For each word: its bits, the most pixels of 76,800 that may be off, and the least PSNR of the others in dB.
const LIMITS: [(u64, u64, f64); 3] = [(32, 0, 150.0), (24, 5, 95.0), (20, 60, 58.0)];

fn measured(scenes: &[&str], options: &str) -> Vec<Value> {
    let common = "--profiles ray --roundings RND --layouts wide --bounces 5 --cutoffs 0 --interpolate none --json";
    let mut command = Command::new(env!("CARGO_BIN_EXE_lancer"));
    command.arg("accuracy").args(scenes).args(common.split(' ')).args(options.split(' '));
    let output = command.output().expect("lancer starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let results: Value = serde_json::from_slice(&output.stdout).expect("--json prints JSON");
    results["variants"].as_array().expect("a list").clone()
}

#[test]
fn words_are_as_good_as_their_document_says() {
    let variants = measured(&SCENES, "--words 32,24,20");
    let mut table = String::new();
    for scene in SCENES {
        table += &format!("| {scene} |");
        for (word, most, least) in LIMITS {
            let is_it = |variant: &&Value| variant["scene"] == scene && variant["word"] == word;
            let error = &variants.iter().find(is_it).expect("it was asked for")["error"];
            let off = error["off_pixels"].as_u64().unwrap();
            let psnr = error["psnr_others_db"].as_f64().unwrap();
            assert!(off <= most && psnr >= least, "{scene}, {word} bits: {off} pixels off, {psnr} dB");
            table += &format!(" {off}, {psnr:.1} |");
        }
        table.push('\n');
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/accuracy.md");
    let document = std::fs::read_to_string(path).unwrap();
    let (before, after) = document.split_once("| 20 bits |\n|---|---|---|---|\n").expect("the table's head");
    let end = after.find("\n\n").expect("the table's end");
    let shown = after[..end].trim_start();
    if std::env::var_os("LANCER_BLESS").is_some() {
        let rest = &after[end..];
        let text = format!("{before}| 20 bits |\n|---|---|---|---|\n{}{rest}", table.trim_end());
        std::fs::write(path, text).unwrap();
    } else {
        assert_eq!(shown, table.trim_end(), "LANCER_BLESS=1 writes it as it is now");
    }
}

/// Columns of the README's table of flipped pixels: camera, bits, and the most that the mean over all shifts may be.
const COLUMNS: [(&str, u32, f64); 4] =
    [("orthographic", 24, 1.5), ("orthographic", 20, 30.0), ("perspective", 24, 1.5), ("perspective", 20, 30.0)];

/// The cell of a scene, camera and word: mean and worst over the shifts of `lancer accuracy`, each drawn by itself, which does without its other figures.
fn flipped(scene: &str, camera: &str, word: u32) -> String {
    let off = lancer::accuracy::PLACES.map(|[x, y]| {
        let options = format!("--profile ray --word {word} --camera {camera} --shift {x},{y} --size 320x240 --json");
        let mut command = Command::new(env!("CARGO_BIN_EXE_lancer"));
        let output = command.args(["render", scene]).args(options.split(' ')).output().expect("lancer starts");
        let result: Value = serde_json::from_slice(&output.stdout).expect("--json prints JSON");
        result["error"]["off_pixels"].as_u64().expect("a number of pixels")
    });
    let mean = off.iter().sum::<u64>() as f64 / off.len() as f64;
    format!("{mean:.2}, {}", off.into_iter().max().expect("there are shifts"))
}

/// The whole table takes minutes, so that it is drawn where it is written; else one of its cells is, and all are held to their bounds.
#[test]
fn flipped_pixels_are_as_the_readme_says() {
    if std::env::var_os("LANCER_BLESS").is_some() {
        for scene in SCENES {
            let cells = COLUMNS.map(|(camera, word, _)| flipped(scene, camera, word));
            crate::bless::row("README.md", scene, &format!("| {scene} | {} |", cells.join(" | ")));
        }
    }
    let readme = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    let is_row = |line: &&str| line.matches('|').count() == COLUMNS.len() + 2;
    for scene in SCENES {
        let row = readme.lines().filter(is_row).find(|line| line.starts_with(&format!("| {scene} |")));
        let cells: Vec<&str> = row.expect("the scene has a row").split('|').map(str::trim).skip(2).collect();
        for (cell, (camera, word, most)) in cells.iter().zip(COLUMNS) {
            let (mean, worst) = cell.split_once(", ").expect("mean and worst");
            let (mean, worst): (f64, f64) = (mean.parse().unwrap(), worst.parse().unwrap());
            assert!(mean <= worst && mean <= most, "{scene}, {camera}, {word} bits: {cell}");
        }
        if scene == "cornell" {
            assert_eq!(cells[1], flipped("cornell", "orthographic", 20), "LANCER_BLESS=1 writes it as it is now");
        }
    }
}
