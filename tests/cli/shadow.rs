//! `--shadow`: real numbers beside the machine's, and where precision died.

use serde_json::Value;

use super::session::Session;

/// A small Cornell box with mirrors and glass.
const PICTURE: &str = "render cornell --size 12x9 --shift 0.137,0.071 --no-error --shadow";

fn project(path: &str) -> String {
    let path = format!("{}/{path}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// A kernel of a set with a shift that is one too large, and the line where that is.
fn planted(set: &str, kernel: &str, line: &str, shift: &str) -> (String, usize) {
    let text = project(&format!("kernels/asm/{set}/{kernel}.s"));
    let at = text.lines().position(|text| text.trim().starts_with(line)).unwrap_or_else(|| panic!("{kernel}: {line}"));
    let changed = |(number, text): (usize, &str)| {
        let text = if number == at { text.replacen(shift, &format!("{shift} + 1"), 1) } else { text.to_owned() };
        text + "\n"
    };
    let changed: String = text.lines().enumerate().map(changed).collect();
    assert_ne!(changed, text, "{kernel}: {shift}");
    (changed, at + 1)
}

#[test]
fn a_planted_loss_is_named_first_at_its_line() {
    let session = Session::new();
    let cases = [
        ("vector", "vector", "shade", "vscale v25, v25, s13, weight", "s13, weight"),
        ("vector", "vector", "surface", "vscale v9, direction, near_t, t + dir - pos", "t + dir - pos"),
        ("ray", "vector", "normal", "vdot  cosine, v6, direction, dir", "direction, dir"),
        (
            "packet",
            "vector",
            "contribution",
            "vscale local_colour, local_colour, weight_now, weight",
            "weight_now, weight",
        ),
        ("report", "report", "shade", "mul   s13, s13, s14, weight", "s14, weight"),
    ];
    for (profile, set, kernel, line, shift) in cases {
        let (text, number) = planted(set, kernel, line, shift);
        session.write("planted.s", &text);
        for word in [32, 20] {
            let options = format!("{PICTURE} --profile {profile} --kernel {kernel}=planted.s --word {word}");
            let result = session.json(&options);
            let first = &result["shadow"]["where_precision_died"][0];
            assert_eq!(first["place"], format!("planted.s:{number}"), "{options}: {first}");
            assert_eq!(first["function"], kernel, "{options}");
            assert!(first["share"].as_f64().unwrap() > 0.5, "{options}: {first}");
            let lines = result["shadow"]["lines"].as_array().unwrap();
            let gap = lines.iter().find(|line| !line["format_gap"].is_null()).unwrap();
            assert_eq!(gap["place"], first["place"], "{options}: the shift contradicts the formats");
        }
    }
}

#[test]
fn no_kernel_has_a_shift_that_contradicts_its_formats() {
    let session = Session::new();
    for profile in ["report", "vector", "ray", "packet"] {
        for options in ["", "--word 16", "--camera perspective --eye 0,0,4 --word 24", "--interpolate=0.02"] {
            let result = session.json(&format!("{PICTURE} --profile {profile} {options}"));
            let lines = result["shadow"]["lines"].as_array().unwrap();
            let gaps: Vec<&Value> = lines.iter().filter(|line| !line["format_gap"].is_null()).collect();
            assert!(gaps.is_empty(), "{profile} {options}: {gaps:?}");
            assert_eq!(result["shadow"]["compared"], 12 * 9 * 3);
            let died = result["shadow"]["where_precision_died"].as_array().unwrap();
            let shares: f64 = died.iter().map(|line| line["share"].as_f64().unwrap()).sum();
            let shares = shares + result["shadow"]["other_share"].as_f64().unwrap();
            assert!((shares - 1.0).abs() < 1e-9, "{shares}");
        }
    }
}

#[test]
fn a_shadow_changes_nothing_else_and_a_pixel_is_that_of_the_picture() {
    let session = Session::new();
    let mut with = session.json(PICTURE);
    let mut without = session.json(PICTURE.strip_suffix(" --shadow").unwrap());
    let shadow = with.as_object_mut().unwrap().remove("shadow").unwrap();
    // The settings say that it was asked for.
    let asked = [&mut with, &mut without].map(|result| result["settings"]["results"]["shadow"].take());
    assert_eq!(asked, [Value::Bool(true), Value::Bool(false)]);
    assert_eq!(with, without);
    // The worst number of the picture is that of its pixel drawn alone.
    let worst = &shadow["outputs"][0];
    let name = worst["name"].as_str().unwrap();
    let pixel = name.strip_prefix("pixel ").and_then(|name| name.split_once(' ')).unwrap().0;
    let alone = session.json(&format!("{PICTURE} --pixel {pixel}"));
    assert_eq!(&alone["shadow"]["outputs"][0], worst);
    assert_eq!(alone["shadow"]["compared"], 3);
    // What the machine and exact arithmetic have is what the key says, and the parts are the error.
    let number = |key: &str| worst[key].as_f64().unwrap();
    assert!((number("raw") - number("exact") - number("error_ulps")).abs() < 1e-6, "{worst}");
}

#[test]
fn the_page_shows_what_the_commands_print() {
    let session = Session::new();
    session.write("unit.s", &project("examples/unit.s"));
    let page = project("docs/shadow.md");
    // Each listing of the page that begins with a command is the part of its output that is shown.
    let mut commands = 0;
    for listing in page.split("```").skip(1).step_by(2) {
        let Some(rest) = listing.strip_prefix("console\n$ lancer ") else { continue };
        let (command, shown) = rest.split_once('\n').unwrap();
        let out = session.succeed(&command.replace("examples/unit.s", "unit.s")).replace("unit.s:", "examples/unit.s:");
        let squeezed = |text: &str| -> Vec<String> {
            let lines = text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
            lines.filter(|line| !line.is_empty() && !line.starts_with("--")).collect()
        };
        let out = squeezed(&out);
        for line in squeezed(shown).iter().filter(|line| *line != "...") {
            assert!(out.contains(line), "`{command}` does not print `{line}`:\n{}", out.join("\n"));
        }
        commands += 1;
    }
    assert!(commands >= 3, "{commands} commands");
}

#[test]
fn a_debugger_shows_exact_numbers_beside_registers() {
    let session = Session::new();
    session.write("unit.s", &project("examples/unit.s"));
    session.write("script.txt", "shadow s1\ncontinue\nshadow s3,v2\ndied v2\nback 20\nshadow s3\n");
    let text = session.succeed("debug unit.s --shadow --commands script.txt");
    assert!(text.contains("s1=0: an integer, which has no shadow"), "{text}");
    assert!(text.contains("s3[") || text.contains("s3="), "{text}");
    assert!(text.contains("good bits (unit.s:15"), "{text}");
    assert!(text.contains("where precision died") && text.contains("vdot s2, v1, v1, pos"), "{text}");
    let run = session.run("debug unit.s --commands script.txt");
    assert!(run.code == 1 && run.messages.contains("start `lancer debug` with --shadow"), "{}", run.messages);
    // Of a pixel, errors of the ray that the main processor made are named as well.
    session.write("pixel.txt", "break triangle\ncontinue\nshadow direction,origin\n");
    let pixel = "debug cornell --size 12x9 --shift 0.137,0.071 --pixel 5,4 --shadow --commands pixel.txt";
    let text = session.succeed(pixel);
    assert!(text.contains("v1.x[origin]=") && text.contains("kernels/asm/vector/dispatch.s:"), "{text}");
}
