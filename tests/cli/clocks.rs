//! Clocks of functions, source lines and pixels as `lancer render` tells them.

use serde_json::Value;

use super::session::Session;

fn number(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{value} is a whole number"))
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// Own clocks of the rows of functions and regions.
fn own(part: &Value, key: &str) -> u64 {
    let rows = list(&part["functions"]).iter().chain(list(&part["regions"]));
    rows.map(|row| number(&row["exclusive"][key])).sum()
}

#[test]
fn own_clocks_are_those_of_the_processors_whatever_draws() {
    let session = Session::new();
    let own_rows = concat!(env!("CARGO_MANIFEST_DIR"), "/extensions/fma");
    let extended =
        format!("--ext {own_rows}/fma.isa --kernel shade={own_rows}/shade.s --kernel surface={own_rows}/surface.s");
    for options in [
        extended.as_str(),
        "",
        "--machine wide32 --cores 3 --arbiter tdma",
        "--machine node_cache --cores 7 --arbiter oldest-first",
        "--machine double_buffer --cores 16",
        "--profile packet --set machine.cores=2",
        "--profile report --interpolate=0.2",
        "--profile ray --word 24 --engine checked",
    ] {
        let result = session.json(&format!("render cornell --size 16x12 --no-error {options}"));
        let cores = list(&result["cores"]);
        for key in ["busy", "waiting"] {
            assert_eq!(own(&result, key), cores.iter().map(|core| number(&core[key])).sum::<u64>(), "{key} {options}");
            assert_eq!(own(&result["main"], key), number(&result["main"][key]), "{key} of main {options}");
            for core in cores {
                assert_eq!(own(core, key), number(&core[key]), "{key} {options}");
            }
        }
        // A wait is for some kind of data, and the outermost function has everything.
        for row in list(&result["functions"]).iter().chain(list(&result["regions"])) {
            let kinds: u64 = row["waiting_kinds"].as_object().unwrap().values().map(number).sum();
            assert_eq!(kinds, number(&row["exclusive"]["waiting"]), "{row}");
        }
        let outermost = &list(&result["functions"])[0];
        assert_eq!(number(&outermost["inclusive"]["busy"]), own(&result, "busy"), "{options}");
        assert_eq!(list(&result["functions"]).last().unwrap()["name"], "(outside)");
    }
}

#[test]
fn clocks_change_nothing_else() {
    let session = Session::new();
    let hash = |text: &str| text.lines().find(|line| line.starts_with("run hash")).map(str::to_owned).unwrap();
    let plain = session.succeed("render cornell --size 16x12 --no-error -o a.png");
    let full =
        session.succeed("render cornell --size 16x12 --no-error --full -o b.png --folded c.folded --flame d.svg");
    assert_eq!((hash(&plain), session.read("a.png")), (hash(&full), session.read("b.png")));
    assert!(full.contains("Clocks by function") && full.contains("Lines with the most clocks"), "{full}");
}

#[test]
fn stacks_are_text_and_a_flame_graph() {
    let session = Session::new();
    let result = session.json("render cornell --size 16x12 --no-error --folded a.folded --flame a.svg");
    let text = String::from_utf8(session.read("a.folded")).unwrap();
    let stack = |line: &str| {
        let (names, clocks) = line.rsplit_once(' ').unwrap();
        (names.split(';').map(str::to_owned).collect::<Vec<_>>(), clocks.parse::<u64>().unwrap())
    };
    let stacks: Vec<(Vec<String>, u64)> = text.lines().map(stack).collect();
    let all = own(&result, "busy") + own(&result, "waiting");
    assert_eq!(stacks.iter().map(|(_, clocks)| clocks).sum::<u64>(), all);
    assert!(stacks.iter().all(|(names, _)| names[0] == "pixel"), "{text}");
    let waits = |kind: &str| {
        let found = stacks.iter().filter(|(names, _)| names.last().is_some_and(|name| name == kind));
        found.map(|(_, clocks)| clocks).sum::<u64>()
    };
    let kinds = list(&result["functions"]).iter().map(|row| row["waiting_kinds"]["nodes"].as_u64().unwrap_or(0));
    assert_eq!(waits("(waits for nodes)"), kinds.sum::<u64>());
    let svg = String::from_utf8(session.read("a.svg")).unwrap();
    assert!(svg.contains("(waits for triangles)") && svg.contains("all cores: "), "{svg}");
    session.fail("render cornell --flame a.png", 2, "ends in .svg or .pdf");
    session.succeed("render cornell --size 4x3 --no-error -q --flame a.pdf");
    assert!(session.read("a.pdf").starts_with(b"%PDF-1.4"));
}

/// The kernel of the ray-triangle test, with a loop in front that loads what the buffer has already: first 36 octets, then 32, down to 4.
#[test]
fn a_planted_slow_spot_comes_first() {
    let session = Session::new();
    let kernel = std::fs::read_to_string("kernels/asm/vector/triangle.s").unwrap();
    let planted =
        "\n    .holds s12\nslow_spot:\n    load  slot, s15, s12\n    isubi s12, s12, 4\n    bgtz  s12, slow_spot\n";
    let (before, after) = kernel.split_once(".func triangle").unwrap();
    session.write("slow.s", &format!("{before}.func triangle{planted}{after}"));
    let line = 2 + before.lines().count() + 2;
    let options = "--size 16x12 --no-error --kernel triangle=slow.s";
    let text = session.succeed(&format!("render cornell {options} --full -o a.png --flame a.svg --folded a.folded"));
    let lines = text.split("Lines with the most clocks").nth(1).unwrap();
    let first = lines.lines().nth(3).unwrap();
    assert!(first.trim_start().starts_with(&format!("slow.s:{line} ")), "line {line} in\n{lines}");
    assert!(first.contains("load slot, s15"), "{first}");
    // Of the boxes at the top of the flame graph its wait is the widest.
    let stacks = String::from_utf8(session.read("a.folded")).unwrap();
    let longest = stacks.lines().max_by_key(|line| line.rsplit(' ').next().unwrap().parse::<u64>().unwrap()).unwrap();
    assert!(longest.contains("packet;triangle;(waits for triangles) "), "{longest}");
    let plain = session.json("render cornell --size 16x12 --no-error");
    let slow = session.json(&format!("render cornell {options}"));
    assert_eq!(plain["image_hash"], slow["image_hash"]);
}

#[test]
fn maps_show_what_is_asked_for() {
    let session = Session::new();
    let mut maps = Vec::new();
    for of in ["operations", "clocks", "waits", "octets", "instructions"] {
        session.succeed(&format!("render cornell --size 16x12 --no-error -q --heat {of}.ppm --heat-of {of}"));
        maps.push(session.read(&format!("{of}.ppm")));
    }
    session.succeed("render cornell --size 16x12 --no-error -q --heat plain.ppm");
    assert_eq!(session.read("plain.ppm"), maps[0]);
    for (at, map) in maps.iter().enumerate() {
        assert!(!maps[..at].contains(map), "{at}");
    }
    session.fail("render cornell --heat-of waits", 2, "--heat");
}

#[test]
fn the_documents_flame_graph_and_map_of_waits_are_what_is_measured() {
    let session = Session::new();
    session.succeed("render cornell --no-error -q --flame flame.svg --heat cornell-waits.png --heat-of waits");
    for name in ["flame.svg", "cornell-waits.png"] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(name);
        if std::env::var_os("LANCER_BLESS").is_some() {
            std::fs::write(&path, session.read(name)).unwrap();
        }
        assert!(session.read(name) == std::fs::read(&path).unwrap(), "docs/{name} is stale: LANCER_BLESS=1 writes it");
    }
}
