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
    assert!(variants.len() >= 12);
    let best = &variants[0];
    let figure = |one: &Value, key: &str| one[key].as_f64().or(one["error"][key].as_f64()).unwrap();
    for one in variants.iter().filter(|one| one["profile"] == "report") {
        assert_eq!((&best["variant"], &one["dominated_by"]), (&"ray 32".into(), &"ray 32".into()));
        assert!(figure(one, "clocks") > 4.5 * figure(best, "clocks"));
        assert!(figure(one, "psnr_db") + 110.0 < figure(best, "psnr_db"));
    }
}
