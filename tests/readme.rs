//! The README and the tutorial show what happens: their commands run, and the README's table is measured again.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn document(name: &str) -> String {
    fs::read_to_string(repository().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A folder with what the documents' commands read.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder for what the commands write");
    for name in ["examples", "kernels/asm/report"] {
        let copy = folder.path().join(name);
        fs::create_dir_all(&copy).unwrap();
        let files = fs::read_dir(repository().join(name)).unwrap().map(|file| file.unwrap().path());
        for file in files.filter(|path: &PathBuf| path.is_file()) {
            fs::copy(&file, copy.join(file.file_name().unwrap())).unwrap();
        }
    }
    folder
}

fn lancer(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lancer")).args(arguments).current_dir(folder).output().expect("lancer starts")
}

fn succeed(folder: &Path, arguments: &[&str]) -> String {
    let output = lancer(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "lancer {}: {errors}", arguments.join(" "));
    String::from_utf8(output.stdout).expect("results are text")
}

#[test]
fn the_demo_writes_three_pictures_and_meets_the_annex() {
    let folder = folder();
    let text = succeed(folder.path(), &[]);
    for name in ["cornell.png", "cornell-heat.png", "cornell-error.png"] {
        assert!(folder.path().join("out").join(name).exists(), "{name}");
    }
    for expected in ["292", "61", "2,561", "run hash"] {
        assert!(text.contains(expected), "{expected} in\n{text}");
    }
}

/// Runs the commands of a document in its order, and returns how many there are.
fn run_commands(name: &str) -> usize {
    let folder = folder();
    let text = document(name);
    let commands = text.lines().filter_map(|line| line.strip_prefix("$ lancer "));
    let commands = commands.map(|line| line.split(" # ").next().unwrap_or_default().trim());
    let commands = commands.map(|line| line.split_whitespace().collect::<Vec<_>>());
    commands.inspect(|command| drop(succeed(folder.path(), command))).count()
}

#[test]
fn the_commands_of_the_readme_run() {
    assert_eq!(run_commands("README.md"), 11);
}

/// Width and height of a picture in the row of scenes.
const SHOWN: [u32; 2] = [128, 96];

#[test]
fn the_row_of_scenes_is_what_is_drawn() {
    let folder = folder();
    let scenes = ["cornell", "sphereflake", "slabs", "mirrors", "terrain"];
    let [width, height] = SHOWN;
    let mut row = image::RgbImage::new(width * scenes.len() as u32, height);
    for (number, scene) in (0..).zip(scenes) {
        let size = format!("{width}x{height}");
        succeed(folder.path(), &["render", scene, "--size", &size, "--no-error", "-q", "-o", "scene.png"]);
        let picture = image::open(folder.path().join("scene.png")).expect("it is a picture").into_rgb8();
        assert_eq!(picture.dimensions(), (width, height));
        image::imageops::replace(&mut row, &picture, i64::from(number * width), 0);
    }
    let path = repository().join("docs/scenes.png");
    if std::env::var_os("LANCER_BLESS").is_some() {
        row.save(&path).expect("the documents can be written");
    }
    let shown = image::open(&path).expect("docs/scenes.png is a picture").into_rgb8();
    assert!(shown == row, "docs/scenes.png is stale: LANCER_BLESS=1 writes it");
    assert!(fs::metadata(&path).unwrap().len() < 100_000, "pictures of the first screen are small");
}

#[test]
fn the_readme_shows_what_the_assembler_says() {
    let folder = folder();
    let text = document("examples/dot.s");
    fs::write(folder.path().join("dot.s"), text.replacen("vdot ", "vdto ", 1)).unwrap();
    let output = lancer(folder.path(), &["run", "dot.s"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(document("README.md").contains(&format!("```text\n{said}```")), "README.md should show\n{said}");
}

#[test]
fn the_commands_of_the_tutorial_run() {
    assert_eq!(run_commands("docs/tutorial.md"), 20);
}

/// 1234567 as 1,234,567.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let first = (digits.len() - 1) % 3 + 1;
    let mut text = digits[..first].to_owned();
    for group in digits.as_bytes()[first..].chunks(3) {
        text.push(',');
        text.push_str(std::str::from_utf8(group).unwrap());
    }
    text
}

/// Measures a scene as the table says and compares with its line.
fn measure(scene: &str) {
    let folder = folder();
    let text = succeed(folder.path(), &["render", scene, "--json"]);
    let result: Value = serde_json::from_str(&text).expect("--json prints JSON");
    let number = |value: &Value| value.as_u64().unwrap_or_else(|| panic!("{value} is a count"));
    let rays: u64 =
        ["camera", "reflected", "refracted", "shadow"].iter().map(|kind| number(&result["rays"][kind])).sum();
    let operations: u64 =
        ["add", "sub", "mul", "div", "cmp"].iter().map(|class| number(&result["counts"][class])).sum();
    let pixels = number(&result["width"]) * number(&result["height"]);
    let off = number(&result["error"]["off_pixels"]);
    let psnr = result["error"]["psnr_others_db"].as_f64().expect("the picture is not exact");
    assert!(off <= 20 && psnr >= 90.0, "{scene}: {off} pixels off, {psnr} dB");
    let line = format!(
        "| {scene} | {} | {} | {} | {off} | {psnr:.2} dB |",
        grouped(number(&result["triangles"])),
        grouped(rays),
        grouped((operations as f64 / pixels as f64).round() as u64),
    );
    crate::bless::row("README.md", scene, &line);
}

#[test]
fn the_table_is_measured_cornell() {
    measure("cornell");
}

#[test]
fn the_table_is_measured_sphereflake() {
    measure("sphereflake");
}

#[test]
fn the_table_is_measured_slabs() {
    measure("slabs");
}

#[test]
fn the_table_is_measured_mirrors() {
    measure("mirrors");
}

#[test]
fn the_table_is_measured_terrain() {
    measure("terrain");
}
