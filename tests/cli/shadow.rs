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
        // Shifts of macros: the line is that of the call.
        ("report", "report", "shade", "scale_vector v25, v25, s13, weight", "s13, weight"),
        ("report", "report", "reflect", "scale_vector v6, facing, s12, dir", "s12, dir"),
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
            let is_macro = line.starts_with("scale_vector");
            assert_eq!(first["macro_place"].is_string(), is_macro, "{first}");
        }
    }
}

#[test]
fn a_planted_loss_that_only_turns_decisions_is_named_first() {
    let session = Session::new();
    // With a cosine that is half as large, nearly every refracted ray is taken for a total reflection.
    let (text, number) = planted("report", "refract", "mul   s12, cosine, cosine, dir", "cosine, dir");
    session.write("planted.s", &text);
    for word in [32, 20] {
        let options = format!("{PICTURE} --profile report --kernel refract=planted.s --word {word}");
        let result = session.json(&options);
        let first = &result["shadow"]["where_precision_died"][0];
        assert_eq!(first["place"], format!("planted.s:{number}"), "{options}: {first}");
        assert!(first["turned_by"].as_u64().unwrap() > 100, "{options}: {first}");
    }
}

#[test]
fn a_root_bit_by_bit_keeps_its_shadow() {
    let session = Session::new();
    // Three decimals of a length, whose root is taken by the kernel of `report`.
    let root = project("kernels/asm/report/sqrt.s").replace("link_leaf", "s25");
    let text = format!(
        ".equ WORD, 32\n.format pos, 16\n.entry start\n.func start\n.holds s1, pos\nwmul w0, s1, s1\n\
         call s25, sqrt\n.holds s12, pos\nhalt\n.endfunc\n{root}"
    );
    session.write("root.s", &text);
    let at = |text: &str| text.lines().position(|line| line.contains(".computes")).unwrap() + 1;
    // The root of 25 is exact; that of 50 is rounded.
    let exact = session.json("run root.s --shadow --reg s1=5:pos --show s12");
    assert_eq!((&exact["shadow"]["compared"], &exact["shadow"]["different"]), (&1.into(), &0.into()), "{exact}");
    let text = text.replace("wmul w0, s1, s1\n", "wmul w0, s1, s1\nwmac w0, s1, s1\n");
    session.write("root.s", &text);
    let rounded = session.json("run root.s --shadow --reg s1=5:pos --show s12");
    let first = &rounded["shadow"]["where_precision_died"][0];
    assert_eq!((&first["place"], &first["function"]), (&format!("root.s:{}", at(&text)).into(), &"sqrt".into()));
    let output = &rounded["shadow"]["outputs"][0];
    let exact = 50f64.sqrt();
    assert!((output["exact_real"].as_f64().unwrap() - exact).abs() < 1e-12, "{output}");
    assert!(output["error_ulps"].as_f64().unwrap().abs() <= 0.5, "{output}");
}

#[test]
fn registers_that_are_declared_and_not_written_are_exact_numbers() {
    let session = Session::new();
    let text = ".format pos, 16\n.func start\n.holds s5, pos\n.holds v1, pos\nmul s6, s5, s5, pos\nhalt\n.endfunc\n";
    session.write("held.s", text);
    session.write("script.txt", "shadow s5,v1\nstep\nshadow s6\n");
    let text = session.succeed("debug held.s --shadow --reg s5=1.5:pos --commands script.txt");
    assert!(text.contains("s5=98304: exact 1.5\n") && text.contains("v1.y=0: exact 0\n"), "{text}");
    assert!(text.contains("s6=147456: exact 2.25\n"), "{text}");
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
