//! `lancer render`: results are a contract.

use serde_json::Value;
use sha2::{Digest, Sha256};

use super::session::Session;

const TINY: &str = "render cornell --size 12x9 --shift 0.137,0.071";

fn number(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{value} is a whole number"))
}

/// The operations of a function, without the clocks that stand beside them.
fn operations(cost: &Value) -> Value {
    let mut cost = cost.clone();
    for key in ["busy", "waiting", "transfers"] {
        assert!(cost.as_object_mut().unwrap().remove(key).is_some_and(|clocks| clocks.is_u64()), "{key}: {cost}");
    }
    cost
}

#[test]
fn the_keys_of_the_results_have_their_types() {
    let result = Session::new().json(TINY);
    let classes = ["add", "sub", "mul", "div", "cmp", "mem", "octet", "move", "logic", "jump", "local", "address"];
    for key in ["schema", "scene", "profile", "machine", "image_hash", "run_hash"] {
        assert!(result[key].is_string(), "{key}");
    }
    for key in ["width", "height", "triangles", "instructions", "octets", "clocks"] {
        assert!(result[key].is_u64(), "{key}");
    }
    for key in ["camera", "reflected", "refracted", "shadow"] {
        assert!(result["rays"][key].is_u64(), "{key}");
    }
    // Counts name every class, those that do not occur too
    let has_classes = |counts: &Value| {
        let keys: Vec<&String> = counts.as_object().unwrap().keys().collect();
        keys.len() == classes.len() && classes.iter().all(|class| counts[class].is_u64())
    };
    assert!(has_classes(&result["counts"]));
    for core in result["cores"].as_array().unwrap() {
        assert!(["busy", "waiting", "idle"].iter().all(|key| core[key].is_u64()), "{core}");
    }
    for function in result["functions"].as_array().unwrap() {
        assert!(function["name"].is_string() && function["calls"].is_u64(), "{function}");
        assert!(["inclusive", "exclusive"].iter().all(|key| has_classes(&operations(&function[key]))), "{function}");
    }
    for key in ["rmse", "psnr_db", "max", "off_per_million", "psnr_others_db"] {
        assert!(result["error"][key].is_f64(), "{key}");
    }
    assert!(result["error"]["off_pixels"].is_u64());
    // SHA-256 in hexadecimal digits
    assert_eq!(result["image_hash"].as_str().unwrap().len(), 64);
    assert!(result.get("host").is_none(), "host times only when asked for");
}

#[test]
fn figures_add_up() {
    let result = Session::new().json(TINY);
    assert_eq!((&result["scene"], &result["width"], &result["height"]), (&"cornell".into(), &12.into(), &9.into()));
    assert_eq!(result["cores"].as_array().unwrap().len(), 4);
    // Time: a processor is busy, waiting or idle at each clock
    let clocks = number(&result["clocks"]);
    let processors = result["cores"].as_array().unwrap().iter().chain([&result["main"]]);
    for used in processors {
        assert_eq!(["busy", "waiting", "idle"].map(|key| number(&used[key])).iter().sum::<u64>(), clocks, "{used}");
    }
    // Octets: the cores' are all that instructions count, those of all kinds are what the bus moves; 12 x 9 pixels are 108 items
    let sum = |key: &str| result["cores"].as_array().unwrap().iter().map(|core| number(&core[key])).sum::<u64>();
    assert_eq!((sum("items"), sum("octets")), (108, number(&result["octets"])));
    assert_eq!(result["octets"], result["counts"]["octet"]);
    assert_eq!(result["bus"]["asked"], result["bus"]["moved"]);
    let kinds = result["bus"]["kinds"].as_object().unwrap();
    for kind in ["triangles", "nodes", "references", "pixels", "messages"] {
        assert!(number(&kinds[kind]) > 0, "{kind}");
    }
    assert_eq!(kinds.values().map(number).sum::<u64>(), number(&result["bus"]["moved"]));
    assert_eq!((&result["method"], &result["stepped_because"]), (&"replayed".into(), &Value::Null));
    let waits = result["cores"].as_array().unwrap().iter().chain([&result["main"]]).map(|used| &used["waits"]);
    let waits = waits.flat_map(|columns| columns.as_array().unwrap()).map(number);
    assert_eq!(waits.sum::<u64>(), number(&result["bus"]["bursts"]), "each burst has waited for its time");
    let seconds = result["seconds"].as_f64().unwrap();
    assert_eq!(seconds, clocks as f64 / number(&result["clock_hz"]) as f64);
    assert!((result["pixel_seconds"].as_f64().unwrap() * 108.0 - seconds).abs() < 1e-12);
    // Operations: functions and the regions outside of them share all, and `pixel` with what it calls has all
    for (class, count) in result["counts"].as_object().unwrap() {
        let functions = result["functions"].as_array().unwrap().iter().chain(result["regions"].as_array().unwrap());
        assert_eq!(functions.map(|f| number(&f["exclusive"][class])).sum::<u64>(), number(count), "{class}");
    }
    let pixel = result["functions"].as_array().unwrap().iter().find(|f| f["name"] == "pixel").unwrap();
    assert_eq!((operations(&pixel["inclusive"]), number(&pixel["calls"])), (result["counts"].clone(), 108));
    let rays = &result["rays"];
    assert_eq!(number(&rays["camera"]), 108);
    assert!(["reflected", "refracted", "shadow"].iter().all(|kind| number(&rays[kind]) > 0), "{rays}");
    assert!(result["error"]["psnr_db"].as_f64().unwrap() > 90.0);
}

#[test]
fn equal_runs_print_equal_octets_in_any_folder() {
    let run = || {
        let session = Session::new();
        let text = session.succeed(&format!("{TINY} --json -o a.png --heat b.png --error c.ppm"));
        (text, session.read("a.png"), session.read("b.png"), session.read("c.ppm"), session.names())
    };
    let first = run();
    assert_eq!(first, run());
    assert_eq!(first.4, ["a.png", "b.png", "c.ppm"]);
    assert!(first.1.starts_with(b"\x89PNG"));
}

#[test]
fn the_number_of_cores_changes_clocks_and_nothing_else() {
    let session = Session::new();
    let results = [1, 2, 8].map(|cores| session.json(&format!("{TINY} --no-error --cores {cores}")));
    for result in &results {
        for key in ["image_hash", "counts", "rays", "instructions", "octets"] {
            assert_eq!(result[key], results[0][key], "{key}");
        }
        let functions = |result: &Value| -> Vec<Value> {
            let functions = result["functions"].as_array().unwrap().iter();
            let counted = |f: &Value| {
                let [inclusive, exclusive] = ["inclusive", "exclusive"].map(|key| operations(&f[key]));
                serde_json::json!([f["name"], f["calls"], f["instructions"], inclusive, exclusive])
            };
            functions.map(counted).collect()
        };
        assert_eq!(functions(result), functions(&results[0]));
        assert!(result["error"].is_null());
    }
    assert!(number(&results[2]["clocks"]) < number(&results[0]["clocks"]));
    assert_eq!(results[2]["cores"].as_array().unwrap().len(), 8);
}

#[test]
fn the_hash_is_that_of_the_colour_words() {
    // With 16 fraction bits a colour word is exact in the 24 bits of a PFM's numbers.
    let session = Session::new();
    let result = session.json(&format!("{TINY} --format colour=16 -o a.pfm"));
    let pfm = session.read("a.pfm");
    let rows = pfm.strip_prefix(b"PF\n12 9\n-1.0\n").expect("the header of a PFM");
    let mut hash = Sha256::new();
    hash.update([12, 0, 0, 0, 9, 0, 0, 0]);
    for row in rows.chunks(12 * 12).rev() {
        for component in row.chunks(4) {
            let value = f32::from_le_bytes(component.try_into().unwrap()) * 65_536.0;
            assert_eq!(value.fract(), 0.0);
            hash.update((value as i32).to_le_bytes());
        }
    }
    let digits: String = hash.finalize().iter().map(|octet| format!("{octet:02x}")).collect();
    assert_eq!(result["image_hash"], digits);
}

#[test]
fn a_part_is_that_part_of_the_whole() {
    let session = Session::new();
    let pixels = |name: &str, header: &str| session.read(name).strip_prefix(header.as_bytes()).unwrap().to_vec();
    session.succeed(&format!("{TINY} -o whole.ppm"));
    session.succeed(&format!("{TINY} -o part.ppm --crop 5,2,4,3"));
    let (whole, part) = (pixels("whole.ppm", "P6\n12 9\n255\n"), pixels("part.ppm", "P6\n4 3\n255\n"));
    for row in 0..3 {
        let start = 3 * (12 * (2 + row) + 5);
        assert_eq!(whole[start..start + 12], part[12 * row..12 * row + 12], "row {row}");
    }
    let pixel = session.json(&format!("{TINY} --pixel 11,8 -o pixel.ppm"));
    assert_eq!((number(&pixel["width"]), &pixel["crop"]), (1, &serde_json::json!([11, 8, 1, 1])));
    assert_eq!(pixels("pixel.ppm", "P6\n1 1\n255\n"), whole[3 * 107..]);
    let text = session.succeed(&format!("{TINY} --pixel 11,8 -o pixel.ppm"));
    assert!(text.contains("pixel 11,8: ") && text.contains("double precision: "), "{text}");
}

#[test]
fn a_picture_without_options_is_named_after_its_scene() {
    let session = Session::new();
    let run = session.run(TINY);
    assert_eq!((run.code, run.messages.as_str()), (0, "picture: cornell.png\n"));
    assert_eq!(session.names(), ["cornell.png"]);
    let widest = |text: &str| text.lines().map(|line| line.chars().count()).max().unwrap();
    for part in ["cornell: 676 triangles, 12 x 9 pixels", "a pixel", "4 cores: busy", "PSNR", "image hash"] {
        assert!(run.out.contains(part), "{part} is missing in\n{}", run.out);
    }
    assert_eq!((run.out.lines().count(), widest(&run.out) <= 80), (10, true), "{}", run.out);
    let full = session.run(&format!("{TINY} --full")).out;
    for part in ["cornell: 676 triangles, 12 x 9 pixels", "ray_tree", "core 3", "PSNR", "image hash"] {
        assert!(full.contains(part), "{part} is missing in\n{full}");
    }
    assert!(widest(&full) <= 100, "a line has {} columns", widest(&full));
    // Quiet says nothing, and neither changes what a script gets.
    let quiet = session.run(&format!("{TINY} -q"));
    assert_eq!((quiet.code, quiet.out.as_str(), quiet.messages.as_str()), (0, "", ""));
    session.fail(&format!("{TINY} --full --json"), 2, "cannot be used with");
}

#[test]
fn octets_by_kind_add_up_with_every_cache() {
    let session = Session::new();
    for (kind, octets) in [("nodes", 1024), ("triangles", 8192), ("triangles", 64), ("references", 256)] {
        session.write("m.toml", &format!("[cache]\noctets = {octets}\nkind = \"{kind}\"\n"));
        let result = session.json(&format!("{TINY} --machine m.toml --no-error"));
        let sum = |kinds: &Value| kinds.as_object().unwrap().values().map(number).sum::<u64>();
        let bus = &result["bus"];
        assert_eq!(sum(&result["moved_kinds"]), number(&bus["moved"]) + number(&bus["aside"]), "{kind} {octets}");
        assert_eq!(sum(&bus["kinds"]), number(&bus["asked"]), "{kind} {octets}");
        let text = session.succeed(&format!("{TINY} --machine m.toml --no-error --full -o x.png"));
        for start in ["octets asked for: ", "octets moved: "] {
            let line =
                text.lines().find_map(|line| line.strip_prefix(start)).unwrap_or_else(|| panic!("{start}\n{text}"));
            let shares = line.split(" %").filter_map(|part| part.split(' ').next_back()?.parse::<f64>().ok());
            let shares: f64 = shares.sum();
            assert!((99.5..100.5).contains(&shares), "{line}");
        }
    }
    // Without a cache both are the same, and told once.
    let plain = session.json(&format!("{TINY} --no-error"));
    assert_eq!(plain["moved_kinds"], plain["bus"]["kinds"]);
    assert!(session.succeed(&format!("{TINY} --no-error --full -o x.png")).contains("\noctets: nodes "));
}

#[test]
fn another_engine_and_an_even_weighted_arbiter_are_said() {
    let session = Session::new();
    let picture = format!("{TINY} --no-error -o x.png");
    // What keeps native code from running is said: here that a clock count does not fit its sums.
    session.write("m.toml", "[clocks]\nadd = 1000000\n");
    let why = "an instruction takes more clocks than the sums have room for";
    let slow = session.json(&format!("{TINY} --no-error --machine m.toml --engine native"));
    assert_eq!((&slow["engine"], &slow["engine_because"]), (&"checked".into(), &why.into()));
    let run = session.run(&format!("{picture} --machine m.toml --engine native"));
    assert!(run.out.contains(&format!("\nengine: checked ({why})\n")), "{}", run.out);
    assert_eq!(run.messages, "");
    session.write("add.s", "add s1, s2, s3\nhalt\n");
    let run = session.run("run add.s --machine m.toml --engine native");
    assert!(run.out.ends_with(&format!("\nengine: checked ({why})\n")), "{}", run.out);
    assert!(!session.succeed("run add.s --engine native").contains("engine"));
    session.write("m.toml", "[bus]\narbiter = \"weighted\"\n");
    let run = session.run(&format!("{picture} --machine m.toml"));
    assert!(run.messages.contains("all weights are 1, which is round-robin"), "{}", run.messages);
    session.write("m.toml", "[bus]\narbiter = \"weighted\"\nweights = [2]\n");
    assert_eq!(session.run(&format!("{picture} --machine m.toml")).messages, "");
    let table = session.succeed("cores triangle --size 4x3 --cores 1,2 --arbiter weighted --arbiter round-robin");
    assert_eq!(table.matches("weighted (all weights are 1, which is round-robin)").count(), 1, "{table}");
}

#[test]
fn numbers_may_be_negative_and_cameras_perspective() {
    let session = Session::new();
    let eye = "render triangle --size 6x4 --shift -0.1,0.2 --eye 0,-1,3 --look -0.1,0,-0.2 --fov 50";
    let given = session.json(eye);
    assert_eq!(given["image_hash"], session.json(&format!("{eye} --camera perspective"))["image_hash"]);
    assert_ne!(given["image_hash"], session.json("render triangle --size 6x4")["image_hash"]);
    let blue = session.json("render empty --size 2x2 --background 0,0,1 --ambient 0");
    assert_eq!(blue["error"]["off_pixels"], 0);
    assert!(blue["error"]["psnr_db"].is_null(), "an equal picture has no ratio");
}

#[test]
fn arithmetic_layout_and_effort_reach_the_machine() {
    let session = Session::new();
    let plain = session.json(TINY);
    for options in [
        "--word 20",
        "--rounding TRN",
        "--rounding trn_zero",
        "--format dir=16",
        "--bounces 1",
        "--weight-cutoff 0.5",
        "--ambient 0.3",
    ] {
        let other = session.json(&format!("{TINY} {options}"));
        assert_ne!(other["image_hash"], plain["image_hash"], "{options}");
    }
    assert_eq!(session.json(&format!("{TINY} --word 20"))["formats"]["word"], 20);
    let shallow = session.json(&format!("{TINY} --kd-depth 2"));
    assert_eq!(shallow["image_hash"], plain["image_hash"]);
    assert_ne!(shallow["counts"], plain["counts"]);
    assert!(session.json(&format!("{TINY} --timing"))["host"]["run_seconds"].is_f64());
}

#[test]
fn a_kernel_of_the_users_own_takes_the_place_of_one() {
    let session = Session::new();
    session.write("same.s", include_str!("../../kernels/asm/vector/triangle.s"));
    session.write("trap.s", ".func triangle\n    trap 9\n.endfunc\n");
    session.write("wrong.s", ".func triangle\n    vdto s4, v1, v2\n    nosuch s1\n.endfunc\n");
    session.write("loop.s", ".func triangle\n1:  jump 1b\n.endfunc\n");
    let same = session.json(&format!("{TINY} --kernel triangle=same.s"));
    assert_eq!(same["run_hash"], session.json(TINY)["run_hash"]);
    let before = session.names();
    session.fail(&format!("{TINY} -o a.png --kernel triangle=trap.s"), 3, "trap.s:2");
    session.fail(&format!("{TINY} -o a.png --kernel triangle=wrong.s"), 1, "wrong.s:2:5");
    session.fail(&format!("{TINY} -o a.png --kernel triangle=wrong.s"), 1, "2 errors");
    session.write("short.toml", "step_limit = 5000\n");
    session.fail(&format!("{TINY} -o a.png --machine short.toml --kernel triangle=loop.s"), 5, "5000 instructions");
    assert_eq!(session.names().len(), before.len() + 1, "no picture was left");
}

#[test]
fn a_machine_file_is_a_machine() {
    let session = Session::new();
    session.write("mine.toml", &session.succeed("machine"));
    let (mine, report) = (session.json(&format!("{TINY} --machine mine.toml")), session.json(TINY));
    assert_eq!((&mine["run_hash"], &mine["machine"]), (&report["run_hash"], &"mine".into()));
    session.write("fast.toml", "cores = 2\n[bus]\nclocks_per_beat = 1\n");
    let fast = session.json(&format!("{TINY} --machine fast.toml"));
    assert_eq!((fast["cores"].as_array().unwrap().len(), &fast["image_hash"]), (2, &report["image_hash"]));
    session.write("wrong.toml", "coers = 2\n");
    session.fail("machine wrong.toml", 1, "wrong.toml:1:1");
    session.fail("machine wrong.toml", 1, "did you mean `cores`?");
    session.write("none.toml", "cores = 0\n");
    session.fail(&format!("{TINY} --machine none.toml"), 1, "`cores` is 0");
}

#[test]
fn a_packet_larger_than_the_buffer_goes_through_in_pieces() {
    // One packet of all triangles, 64 octets each; the buffer holds them one at a time, or all at once.
    let session = Session::new();
    session.write("large.toml", "buffer_octets = 1_000_000\n");
    let scene = "render sphereflake --size 6x4 --shift 0.137,0.071 --kd-depth 0 --no-error";
    let (small, large) = (session.json(scene), session.json(&format!("{scene} --machine large.toml")));
    assert!(number(&small["triangles"]) * 62 > 18_525, "they do not fit at once");
    assert_eq!((&small["image_hash"], &small["clocks"]), (&large["image_hash"], &large["clocks"]));
    let tree = session.json("render sphereflake --size 6x4 --shift 0.137,0.071 --no-error");
    assert_eq!(small["image_hash"], tree["image_hash"]);
}

#[test]
fn a_kernel_that_outgrows_its_buffer_names_the_pixel() {
    let session = Session::new();
    let kernel = include_str!("../../kernels/asm/report/sqrt.s");
    session.write("sqrt.s", &kernel.replacen(".func sqrt\n", ".func sqrt\n    sw s0, 18522(s0)\n", 1));
    let run = session.run("render cornell --size 4x4 --kernel sqrt=sqrt.s --no-error");
    assert_eq!(run.code, 3, "{}", run.messages);
    for part in ["18525", "sqrt.s", "in the work item whose first message began with"] {
        assert!(run.messages.contains(part), "{part}\n{}", run.messages);
    }
}

#[test]
fn threads_of_the_host_and_the_way_to_run_change_nothing() {
    let session = Session::new();
    let out = |threads: &str, machine: &str| {
        let mut command = session.command(&format!("{TINY} --json --no-error --machine {machine}"));
        String::from_utf8(command.env("RAYON_NUM_THREADS", threads).output().unwrap().stdout).unwrap()
    };
    for machine in ["report", "wide32", "double_buffer", "node_cache"] {
        let one = out("1", machine);
        assert!(one.contains("\"image_hash\""), "{one}");
        assert_eq!(one, out("3", machine));
    }
}
