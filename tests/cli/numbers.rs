//! `lancer arithmetic check` and `lancer stress`.

use serde_json::Value;

use super::session::Session;

const HEADER: &str = "op,sa,wa,ia,a,sb,wb,ib,b,sc,wc,ic,c,sr,wr,ir,q,o,n,r,qf,of\n";

#[test]
fn vectors_are_checked_with_an_exit_code_each() {
    let session = Session::new();
    let right = "mul,s,8,4,24,s,8,4,-40,-,-,-,-,s,8,4,RND,SAT,0,-60,0,0\n\
                 cvt,s,16,8,300,-,-,-,-,-,-,-,-,s,8,4,RND_CONV,WRAP,1,19,1,0\n";
    session.write("right.csv", &format!("{HEADER}{right}"));
    assert_eq!(session.succeed("arithmetic check right.csv"), "right.csv: 2 vectors, all agree\n");

    let wrong = right.replace("-60,0,0", "-61,0,0");
    session.write("wrong.csv", &format!("{HEADER}{wrong}"));
    let run = session.run("arithmetic check wrong.csv");
    assert_eq!((run.code, run.messages.as_str()), (4, ""));
    let expected =
        "wrong.csv:2: mul: expected -61 (qf 0, of 0); found -60 (qf 0, of 0)\nwrong.csv: 2 vectors, 1 mismatch\n";
    assert_eq!(run.out, expected);
    let run = session.run("arithmetic check wrong.csv --json");
    let checked: Value = serde_json::from_str(&run.out).expect("--json prints JSON");
    assert_eq!((run.code, &checked["mismatches"]), (4, &1.into()));
    assert_eq!(checked["listed"][0]["line"], 2);
    assert_eq!(checked["listed"][0]["found"]["raw"], "-60");

    session.write("broken.csv", &format!("{HEADER}{wrong}mul,s,99\n"));
    let run = session.run("arithmetic check broken.csv");
    assert_eq!(run.code, 1);
    assert!(run.messages.contains("broken.csv:4"), "{}", run.messages);
    assert!(run.out.contains("1 mismatch"), "{}", run.out);
    assert_eq!(session.run("arithmetic check none.csv").code, 1);
}

#[test]
fn modes_of_overflow_may_name_saturated_bits() {
    let session = Session::new();
    let run = session.run("render triangle --overflow sat:3");
    assert_eq!(run.code, 2);
    assert!(run.messages.contains("as in WRAP:3"), "{}", run.messages);
    session.json("render triangle --size 4x3 --overflow wrap_sm:2 --no-error");
}

#[test]
fn a_case_of_the_catalogue_is_tried_and_taken_up() {
    let session = Session::new();
    let names: Vec<String> = lancer::stress::CASES.iter().map(|case| case.name.to_owned()).collect();
    let list = session.succeed("stress --list");
    assert!(names.iter().all(|name| list.contains(name.as_str())), "{list}");

    let tried = session.json("stress --case normalising");
    assert_eq!((&tried["passes"], tried["cases"].as_array().map(Vec::len)), (&true.into(), Some(1)));
    let case = &tried["cases"][0];
    assert!(case["value"].as_f64().unwrap() > 0.5 && case["value"].as_f64() <= case["threshold"].as_f64(), "{case}");

    session.succeed("stress --case normalising --resume state.json");
    let state = String::from_utf8(session.read("state.json")).unwrap();
    // What the file says is done is not done again: an error that it claims stays.
    let worse: Value = serde_json::from_str(&state).unwrap();
    let worst = worse["cases"]["normalising"]["tally"]["worst"].to_string();
    session.write("state.json", &state.replace(&worst, "9.5"));
    let run = session.run("stress --case normalising --resume state.json");
    assert_eq!(run.code, 4, "{}", run.out);
    assert!(run.out.starts_with("FAIL normalising") && run.out.contains("9.5"), "{}", run.out);

    let run = session.run("stress --case normalising --full --resume state.json");
    assert_eq!((run.code, run.messages.contains("the state of another run")), (1, true), "{}", run.messages);
    session.write("state.json", "{}");
    assert_eq!(session.run("stress --resume state.json").code, 1);
    assert_eq!(session.run("stress --case normalizing").code, 2);
}

#[test]
fn variants_are_measured_and_the_front_is_marked() {
    let session = Session::new();
    let arguments =
        "accuracy cornell --size 16x12 --words 32,20 --cutoffs 0 --interpolate none --svg all.svg --pdf all.pdf";
    let measured = session.json(arguments);
    let variants = measured["variants"].as_array().unwrap();
    let names: Vec<&str> = variants.iter().map(|one| one["variant"].as_str().unwrap()).collect();
    let expected = ["ray 32", "ray 20", "vector 32", "vector 20", "report 32", "report 20", "ray 32 TRN", "ray 20 TRN"];
    assert_eq!(names[..8], expected);
    assert_eq!(names[8..], ["ray 32 report", "ray 20 report", "ray 32 bounces 2", "ray 20 bounces 2"]);
    for one in variants {
        let by = one["dominated_by"].as_str();
        assert_eq!(one["is_on_front"], by.is_none());
        if let Some(by) = by {
            let other = &variants[names.iter().position(|name| *name == by).unwrap()];
            let not_above = |key: &dyn Fn(&Value) -> f64| key(other) <= key(one);
            assert!(not_above(&|v| v["clocks"].as_f64().unwrap()), "{one} by {other}");
            assert!(not_above(&|v| v["error"]["rmse"].as_f64().unwrap()), "{one} by {other}");
        }
    }
    // The exact profile decides every camera ray as exact integers do.
    assert_eq!(variants[0]["rays"]["misclassified_per_million"], 0.0);
    assert!(variants[0]["rays"]["t_max"].as_f64().unwrap() <= 0.5);
    assert!(variants[1]["error"]["rmse"].as_f64() > variants[0]["error"]["rmse"].as_f64());
    let csv = String::from_utf8(session.read("all.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + variants.len());
    let svg = String::from_utf8(session.read("all.svg")).unwrap();
    // Each variant has its tip, and the figure its title. Those of the front stand on marks as well.
    assert_eq!(svg.matches("<title>").count(), 1 + variants.len());
    assert!(svg.contains("dominated by"), "{svg}");
    assert!(session.read("all.pdf").starts_with(b"%PDF-1.4"));
    assert_eq!(session.run("accuracy cornell --words 7").code, 2);
    assert_eq!(session.run("accuracy no_such_scene").code, 1);
}

#[test]
fn machines_that_compute_alike_share_a_recording() {
    let session = Session::new();
    session.write("slow.toml", "clock_hz = 1000000\n");
    let study = "accuracy cornell --size 8x6 --words 32,28,24,20,16 --profiles ray --layouts packed,wide --roundings RND --bounces 5 --cutoffs 0 --interpolate none";
    let measured = session.json(&format!("{study} --machine report,double_buffer,node_cache --machine slow.toml"));
    assert_eq!(measured["recordings"], 10);
    assert_eq!(measured["replays"], 40);
    assert_eq!(measured["stepped"], 0);
    let variants = measured["variants"].as_array().unwrap();
    assert_eq!(variants.len(), 40);
    // Each machine's figures are those of a study of that machine alone.
    for (at, machine) in ["report", "double_buffer", "node_cache", "slow.toml"].into_iter().enumerate() {
        let alone = session.json(&format!("{study} --machine {machine}"));
        let (one, other) = (&variants[10 * at + 8], &alone["variants"][8]);
        assert_eq!((&one["word"], &one["layout"]), (&20.into(), &"wide".into()), "{one}");
        for key in ["clocks", "seconds", "octets", "energy", "error", "rays", "operations"] {
            assert_eq!(one[key], other[key], "{machine}, {key}");
        }
        let name = machine.trim_end_matches(".toml");
        assert_eq!((&one["variant"], &one["machine"]), (&format!("ray 20 {name}").into(), &name.into()));
        assert_eq!(other["variant"], "ray 20");
    }
    // The slow machine is dominated in seconds, and not by its twin in clocks.
    let front = |axis: &str| {
        let measured = session.json(&format!("{study} --machine report --machine slow.toml --axis {axis}"));
        let variants = measured["variants"].as_array().unwrap().clone();
        variants.into_iter().filter(|one| one["machine"] == "slow" && one["is_on_front"] == true).count()
    };
    assert_eq!(front("seconds"), 0);
    assert!(front("clocks") > 0);
}

#[test]
fn errors_of_several_shifts_are_pooled() {
    let session = Session::new();
    let study = "accuracy slabs --size 16x12 --words 20 --profiles ray --roundings RND --layouts wide --bounces 5 --cutoffs 0 --interpolate none";
    let measured = session.json(&format!("{study} --shifts 3"));
    let one = &measured["variants"][0];
    let shifts = one["shifts"].as_array().unwrap();
    assert_eq!((shifts.len(), &measured["recordings"], &measured["replays"]), (3, &3.into(), &3.into()));
    let mut off = Vec::new();
    let mut clocks = 0.0;
    for shift in shifts {
        let [x, y] = [0, 1].map(|k| shift["shift"][k].as_f64().unwrap());
        // The picture of that shift alone, as other commands have it.
        let alone = session.json(&format!("{study} --shift {x},{y}"));
        let drawn = session.json(&format!("render slabs --size 16x12 --word 20 --profile ray --shift {x},{y}"));
        assert_eq!(alone["variants"][0]["error"], drawn["error"]);
        for key in ["rmse", "off_pixels", "max", "psnr_db"] {
            assert_eq!(shift[key], drawn["error"][key], "{key} at {x}, {y}");
        }
        off.push(shift["off_pixels"].as_f64().unwrap());
        clocks += drawn["clocks"].as_f64().unwrap();
    }
    assert_eq!(one["off"]["mean"].as_f64().unwrap(), off.iter().sum::<f64>() / 3.0);
    assert_eq!(one["off"]["worst"].as_f64().unwrap(), off.iter().copied().fold(0.0, f64::max));
    assert_eq!(one["clocks"].as_f64().unwrap(), clocks / (3.0 * 16.0 * 12.0));
    let text = session.succeed(&format!("{study} --shifts 2"));
    let head = text.lines().find(|line| line.contains("variant")).unwrap();
    assert!(head.find("off, mean") < head.find("PSNR") && head.contains("off, worst"), "{head}");
    session.fail(&format!("{study} --shifts 9"), 2, "9 is not in 1..=8");
}

#[test]
fn one_front_goes_over_several_scenes() {
    let session = Session::new();
    let study = "accuracy cornell slabs --size 8x6 --words 32,16 --profiles ray,report --roundings RND --layouts wide --bounces 5 --cutoffs 0 --interpolate none";
    let measured = session.json(&format!("{study} --axis octets --error off --over worst --svg all.svg"));
    let overall = measured["overall"].as_array().unwrap();
    assert_eq!(overall.len(), 4);
    for one in overall {
        let of_scenes: Vec<&Value> =
            measured["variants"].as_array().unwrap().iter().filter(|v| v["variant"] == one["variant"]).collect();
        let octets: Vec<f64> = of_scenes.iter().map(|v| v["octets"].as_f64().unwrap()).collect();
        assert_eq!(one["cost"]["mean"].as_f64().unwrap(), (octets[0] + octets[1]) / 2.0);
        assert_eq!(one["cost"]["worst"].as_f64().unwrap(), octets[0].max(octets[1]));
        let off: Vec<f64> = of_scenes.iter().map(|v| v["off"]["worst"].as_f64().unwrap()).collect();
        assert_eq!(one["error"]["worst"].as_f64().unwrap(), off[0].max(off[1]));
    }
    assert!(overall.iter().any(|one| one["worst_dominated_by"].is_null()));
    assert!(overall.iter().any(|one| one["worst_dominated_by"].is_string()));
    let svg = String::from_utf8(session.read("all.svg")).unwrap();
    assert!(svg.contains("worst of all scenes") && svg.contains("octets a pixel"), "{svg}");
    // One scene has no front over all.
    assert_eq!(session.json("accuracy triangle --size 4x3 --words 32")["overall"], serde_json::json!([]));
}

#[test]
fn variants_take_the_options_of_a_picture() {
    let session = Session::new();
    let one = "--words 24 --profiles ray --roundings TRN --layouts wide --bounces 2 --cutoffs 0 --interpolate none";
    let options = "--size 12x9 --eye 2,2,6 --fov 30 --crop 2,1,8,6 --ambient 0.3 --background 0,0.5,1 --overflow WRAP --format dir=20 \
                   --kd-depth 6 --no-skip unlit --machine wide32 --cores 3 --arbiter tdma --set bus.setup_clocks=9";
    let drawn = session.json(&format!("render cornell {options} --word 24 --profile ray --rounding TRN --bounces 2"));
    let measured = session.json(&format!("accuracy cornell {options} {one}"));
    let variant = &measured["variants"][0];
    let pixels = 8.0 * 6.0;
    assert_eq!(variant["clocks"].as_f64().unwrap(), drawn["clocks"].as_f64().unwrap() / pixels);
    assert_eq!(variant["octets"].as_f64().unwrap(), drawn["octets"].as_f64().unwrap() / pixels);
    assert_eq!(variant["operations"], drawn["counts"]);
    assert_eq!((&variant["cores"], &variant["arbiter"]), (&3.into(), &"tdma".into()));
    // The same through the settings of that picture, which is then the only variant.
    session.write("one.json", &serde_json::to_string(&drawn).unwrap());
    let again = session.json("accuracy cornell --settings one.json");
    assert_eq!(again["variants"].as_array().unwrap().len(), 1);
    assert_eq!(again["variants"][0]["clocks"], variant["clocks"]);
    session.fail(&format!("accuracy cornell {one} --set word=20"), 2, "--words has its values");
    session.fail("accuracy cornell slabs --mesh a.off", 2, "belongs to one scene");
    session.write("bad.s", "    no_such_row\n");
    session.fail(&format!("accuracy triangle --size 4x3 {one} --kernel triangle=bad.s"), 1, "no_such_row");
}

#[test]
fn a_machine_tells_what_its_laws_come_to() {
    let session = Session::new();
    let machine = session.json("machine bit_serial --word 16");
    let drawn = session.json("render triangle --size 4x3 --machine bit_serial --word 16");
    assert_eq!(machine["resolved"], drawn["timing"]);
    assert_eq!((&machine["resolved"]["word"], &machine["resolved"]["is_by_word"]), (&16.into(), &true.into()));
    assert!(machine["machine"]["clocks"].to_string().contains("linear"), "{machine}");
    let plain = session.json("machine report");
    assert_eq!((&plain["resolved"]["is_by_word"], &plain["resolved"]["word"]), (&false.into(), &32.into()));
}

/// The front of word lengths, as docs/accuracy.md has its chart and its command line.
#[test]
fn word_length_buys_what_the_documents_say() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let document = std::fs::read_to_string(folder.join("accuracy.md")).unwrap();
    let line = document.lines().find(|line| line.ends_with("--svg words.svg")).expect("the command line");
    let session = Session::new();
    let measured = session.json(line.trim().strip_prefix("lancer ").expect("it begins with the program"));
    if std::env::var_os("LANCER_BLESS").is_some() {
        std::fs::write(folder.join("words.svg"), session.read("words.svg")).unwrap();
    }
    let written = std::fs::read(folder.join("words.svg")).unwrap();
    assert!(session.read("words.svg") == written, "docs/words.svg is stale: LANCER_BLESS=1 writes it");
    let variants = measured["variants"].as_array().unwrap();
    let of = |layout: &'static str| variants.iter().filter(move |one| one["layout"] == layout);
    assert!(of("wide").all(|one| one["is_on_front"] == false));
    assert!(of("packed").filter(|one| one["is_on_front"] == true).count() >= 5, "the front bends");
    let clocks = |word: u64| of("packed").find(|one| one["word"] == word).unwrap()["clocks"].as_f64().unwrap();
    assert!(clocks(16) < 0.6 * clocks(32));
}

/// Renewed by `lancer accuracy cornell --size 32x24 --svg docs/accuracy.svg`.
#[test]
fn the_documents_chart_and_sentence_are_what_is_measured() {
    let session = Session::new();
    let measured = session.json("accuracy cornell --size 32x24 --svg accuracy.svg");
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    for name in ["accuracy.svg", "accuracy.csv"] {
        if std::env::var_os("LANCER_BLESS").is_some() {
            std::fs::write(folder.join(name), session.read(name)).unwrap();
        }
        let written = std::fs::read(folder.join(name)).unwrap();
        assert!(session.read(name) == written, "docs/{name} is stale: LANCER_BLESS=1 writes it");
    }
    let variants = measured["variants"].as_array().unwrap();
    for page in ["README.md", "docs/accuracy.md"] {
        let text = std::fs::read_to_string(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(page)).unwrap();
        let title = format!("Clocks a pixel against PSNR of {} variants", variants.len());
        assert!(text.contains(&title), "{page} has no chart of {} variants", variants.len());
    }
    let best = &variants[0];
    let figure = |one: &Value, key: &str| one[key].as_f64().or(one["error"][key].as_f64()).unwrap();
    for one in variants.iter().filter(|one| one["profile"] == "report") {
        assert_eq!((&best["variant"], &one["dominated_by"]), (&"ray 32".into(), &"ray 32".into()));
        assert!(figure(one, "clocks") > 6.5 * figure(best, "clocks"), "a seventh of the clocks");
        assert!(figure(one, "psnr_db") + 110.0 < figure(best, "psnr_db"));
    }
}
