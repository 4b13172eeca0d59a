//! Results held against others: `lancer diff`, expectations of a picture, earlier times.

use serde_json::Value;

use super::session::Session;

fn written(session: &Session, name: &str, arguments: &str) -> Value {
    let result = session.json(arguments);
    session.write(name, &result.to_string());
    result
}

#[test]
fn what_differs_is_shown_in_per_cent() {
    let session = Session::new();
    let a = written(&session, "a.json", "render cornell --size 8x6");
    let b = written(&session, "b.json", "render cornell --size 8x6 --word 20 --machine wide32");
    let found = session.run("diff a.json b.json --json");
    let result: Value = serde_json::from_str(&found.out).unwrap();
    assert_eq!((found.code, &result["is_within"]), (4, &false.into()));
    let difference = |key: &str| {
        let all = result["differences"].as_array().unwrap();
        all.iter().find(|one| one["key"] == key).unwrap_or_else(|| panic!("{key} does not differ")).clone()
    };
    let clocks = difference("clocks");
    let expected = 100.0 * (b["clocks"].as_f64().unwrap() / a["clocks"].as_f64().unwrap() - 1.0);
    assert!((clocks["percent"].as_f64().unwrap() - expected).abs() < 1e-9, "{clocks}");
    assert_eq!((&clocks["part"], &difference("machine")["part"]), (&"clocks".into(), &"settings".into()));
    assert_eq!((&difference("error.psnr_db")["part"], &difference("formats.word")["b"]), (&"error".into(), &20.into()));
    // Settings differ, and do not count.
    assert_eq!(difference("machine")["is_within"], true);
    let text = session.run("diff a.json b.json").out;
    assert!(text.contains("| wide32") && text.contains("beyond the tolerance of 0 % (*)"), "{text}");
    let text = session.run("diff a.json b.json --only settings");
    assert_eq!((text.code, text.out.contains("\n clocks ")), (0, false), "{}", text.out);
}

#[test]
fn a_tolerance_lets_small_changes_pass() {
    let session = Session::new();
    let mut result = written(&session, "a.json", "render triangle --size 4x4");
    result["clocks"] = (result["clocks"].as_u64().unwrap() * 101 / 100).into();
    session.write("b.json", &result.to_string());
    assert_eq!(session.run("diff a.json a.json").code, 0);
    assert_eq!(session.run("diff a.json b.json").code, 4);
    assert_eq!(session.run("diff a.json b.json --tolerance 0.5").code, 4);
    assert_eq!(session.run("diff a.json b.json --tolerance 1%").code, 0);
    session.write("m.toml", "cores = 4\n");
    session.write("n.toml", "cores = 5\n");
    let found = session.run("diff m.toml n.toml");
    assert!(found.code == 4 && found.out.contains("+25.00 %"), "{}", found.out);
    for (arguments, code, message) in [
        ("diff a.json m.toml", 1, "are not of one kind"),
        ("diff a.json none.json", 1, "there is no file none.json"),
        ("diff a.json b.json --tolerance -1", 2, "per cent from 0 on"),
        ("diff a.json b.json --only time", 2, "the parts are settings, counts"),
    ] {
        session.fail(arguments, code, message);
    }
    session.write("broken.json", "{\n  \"a\": 1,\n}\n");
    session.fail("diff broken.json a.json", 1, "broken.json:3:1");
}

#[test]
fn a_picture_may_be_expected() {
    let session = Session::new();
    let picture = "render cornell --size 8x6 -o x.png -q";
    let result = session.json("render cornell --size 8x6");
    let [image, run] = ["image_hash", "run_hash"].map(|key| result[key].as_str().unwrap());
    let clocks = result["clocks"].as_u64().unwrap();
    let psnr = result["error"]["psnr_db"].as_f64().unwrap();
    for (expectation, code, message) in [
        (format!("--expect-hash {image}"), 0, ""),
        (format!("--expect-hash {}", &run[..8]), 0, ""),
        ("--expect-hash 0123456789abcdef".to_owned(), 4, "the hash 0123456789abcdef was expected"),
        (format!("--min-psnr {}", psnr - 1.0), 0, ""),
        (format!("--min-psnr {}", psnr + 1.0), 4, "were expected"),
        (format!("--max-clocks {clocks}"), 0, ""),
        (format!("--max-clocks {}", clocks - 1), 4, "clocks, at most"),
        ("--expect-hash 0123".to_owned(), 2, "8 to 64 hexadecimal digits"),
        ("--min-psnr 3 --no-error".to_owned(), 2, "cannot be used with"),
    ] {
        let run = session.run(&format!("{picture} {expectation}"));
        assert_eq!((run.code, run.out.as_str()), (code, ""), "{expectation}: {}", run.messages);
        assert!(run.messages.contains(message), "{expectation}: {}", run.messages);
        assert_eq!(run.messages.is_empty(), code == 0, "{expectation}: {}", run.messages);
    }
    // All that are not met are told, behind the results.
    let run = session.run("render cornell --size 8x6 --json --max-clocks 1 --min-psnr 999");
    assert_eq!((run.code, run.messages.contains("2 errors")), (4, true), "{}", run.messages);
    assert!(serde_json::from_str::<Value>(&run.out).is_ok());
}

#[test]
fn times_are_set_against_earlier_ones() {
    let session = Session::new();
    let bench = "bench triangle --size 4x3 --runs 1";
    let mut before = written(&session, "before.json", bench);
    let found = session.run(&format!("{bench} --against before.json --tolerance 1000000 --json"));
    let result: Value = serde_json::from_str(&found.out).unwrap();
    assert_eq!(found.code, 0, "{}", found.messages);
    assert_eq!(result["against"][0]["before"], before["measured"][0]["nanoseconds"]);
    // Nothing is as fast as a thousandth of a nanosecond.
    for one in before["measured"].as_array_mut().unwrap() {
        one["nanoseconds"] = 0.001.into();
    }
    session.write("fast.json", &before.to_string());
    let found = session.run(&format!("{bench} --against fast.json"));
    assert!(found.code == 4 && found.messages.contains("times are larger by more than 10 %"), "{}", found.messages);
    assert!(found.out.contains("against before"), "{}", found.out);
    session.fail(&format!("{bench} --against fast.json --threads 2"), 1, "the threads in fast.json is 1, and 2 here");
    session.write("other.json", "{}");
    session.fail(&format!("{bench} --against other.json"), 1, "no result of `lancer bench --json`");
    session.fail(&format!("{bench} --tolerance 5"), 2, "--against");
}
