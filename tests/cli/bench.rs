//! `lancer bench`.

use super::session::Session;

#[test]
fn every_runner_is_measured_on_every_scene_and_profile() {
    let session = Session::new();
    let result = session.json("bench cornell slabs --size 8x6 --profiles ray,vector --runs 1");
    let measured = result["measured"].as_array().expect("a list");
    assert_eq!(measured.len(), 2 * 2 * 6);
    let parts = result["parts"].as_array().expect("a list");
    assert_eq!(parts.len(), 2 * 2);
    for one in parts {
        // Of a picture as small as this one a difference of two runs says nothing.
        for part in ["building", "compiling", "replaying", "reading", "comparing", "writing", "whole"] {
            assert!(one[part].as_f64().expect("a number") > 0.0, "{part}: {one}");
        }
        for part in ["executing", "functions", "recording"] {
            assert!(one[part].is_number(), "{part}: {one}");
        }
    }
    for one in measured {
        let is_native = ["twin", "reference"].contains(&one["runner"].as_str().expect("a name"));
        assert!(one["nanoseconds"].as_f64().expect("a number") > 0.0 && one["rays"].as_f64().expect("a number") > 0.0);
        assert_eq!(one["instructions"].is_null(), is_native, "{one}");
        assert!(one["runner"] != "twin" || one["of_twin"] == 1.0, "{one}");
    }
}

#[test]
fn who_asks_for_lock_step_is_told_what_to_take() {
    let session = Session::new();
    session.fail(
        "render triangle --engine lockstep",
        2,
        "lock-step was removed, because it was slower; use `--engine native`",
    );
}

#[test]
fn the_table_and_the_chart_name_all_runners() {
    let session = Session::new();
    let text = session.succeed("bench triangle --size 4x3 --runs 1 --svg bench.svg");
    let chart = String::from_utf8(session.read("bench.svg")).expect("text");
    let native = ["native", "native, clocks", "native, all", "native twin", "native f64"];
    for name in native.into_iter().chain(["checked"]) {
        assert!(text.contains(&format!("| {name:>14} |")) && chart.contains(name), "{name} in\n{text}");
    }
    for part in ["compile", "execute", "record", "replay", "compare"] {
        assert!(text.contains(&format!("| {part} |")), "{part} in\n{text}");
    }
    session.fail("bench nothing.dsc", 1, "nothing.dsc");
}
