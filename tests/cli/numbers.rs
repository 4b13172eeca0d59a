//! `lancer arithmetic check` and `lancer stress`.

use serde_json::Value;

use crate::session::Session;

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
