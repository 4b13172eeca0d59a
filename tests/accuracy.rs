//! Bits that a picture asks for: docs/accuracy.md says it, and it is measured again.

use std::process::Command;

use serde_json::Value;

const SCENES: [&str; 5] = ["cornell", "sphereflake", "slabs", "mirrors", "terrain"];

/// For each word: its bits, the most pixels of 76,800 that may be off, and the least PSNR of the others in dB.
const LIMITS: [(u64, u64, f64); 3] = [(32, 0, 150.0), (24, 5, 95.0), (20, 60, 58.0)];

fn measured() -> Vec<Value> {
    let options = "--words 32,24,20 --profiles ray --roundings RND --layouts wide --bounces 5 --cutoffs 0 --interpolate none --json";
    let mut command = Command::new(env!("CARGO_BIN_EXE_lancer"));
    let output = command.arg("accuracy").args(SCENES).args(options.split(' ')).output().expect("lancer starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let results: Value = serde_json::from_slice(&output.stdout).expect("--json prints JSON");
    results["variants"].as_array().expect("a list").clone()
}

#[test]
fn words_are_as_good_as_their_document_says() {
    let variants = measured();
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
