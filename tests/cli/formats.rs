//! Formats that are found keep the demand, and are read back by other commands.

use serde_json::Value;

use super::session::Session;

#[test]
fn formats_keep_the_demand_and_are_read_back() {
    let session = Session::new();
    let found = session.json("formats triangle slabs --size 12x9 --psnr 50 --shifts 1 --check triangle -o short.toml");
    assert_eq!(found["found"]["is_kept"], true);
    assert_eq!(found["layout"], "packed");
    let quantities = found["quantities"].as_array().expect("a list");
    let word = quantities.last().expect("the word comes last");
    assert_eq!(word["quantity"], "word");
    let uniform = found["uniform"].as_array().expect("a list");
    let best = uniform.iter().find(|row| row["is_best"] == true).expect("32 bits are enough");
    assert_eq!((&best["is_kept"], &found["guard"]), (&true.into(), &2.into()));
    // Wide structures move more octets for the same pictures.
    let wide = uniform.iter().find(|row| row["layout"] == "wide").expect("it comes last");
    assert_eq!((&wide["word"], &wide["worst_psnr_db"]), (&best["word"], &best["worst_psnr_db"]));
    assert!(wide["octets"].as_f64() > found["found"]["octets"].as_f64());
    // No more than the best word takes, and the share says so.
    let [taken, best] = [&found["found"], best].map(|one| one["octets"].as_f64().expect("a number"));
    assert!(
        taken <= best && found["share"]["octets"].as_f64() == Some(taken / best),
        "{taken} {best} {}",
        found["share"]
    );
    for (at, scene) in ["triangle", "slabs"].into_iter().enumerate() {
        let drawn = session.json(&format!("render {scene} --size 12x9 --shift 0.137,0.071 --settings short.toml"));
        for quantity in quantities.iter().filter(|quantity| quantity["is_given"] == true) {
            let name = quantity["quantity"].as_str().expect("a name");
            assert_eq!(drawn["formats"][name], quantity["bits"], "{scene}, {name}");
        }
        // The very picture that the search drew.
        let searched = &found["found"]["scenes"][at];
        let close = |a: &Value, b: f64| (a.as_f64().expect("a number") - b).abs() < 1e-9 * b.abs();
        let moved = drawn["bus"]["moved"].as_f64().expect("a number") / 108.0;
        assert!(close(&searched["octets"], moved), "{searched} {moved}");
        match drawn["error"]["psnr_db"].as_f64() {
            Some(psnr) => assert!(close(&searched["error"]["psnr_db"], psnr), "{searched} {psnr}"),
            None => assert!(searched["error"]["psnr_db"].is_null(), "{searched}"),
        }
        assert_eq!(drawn["settings"]["layout"], "packed");
        assert!(drawn["error"]["psnr_db"].as_f64().is_none_or(|psnr| psnr >= 50.0), "{}", drawn["error"]);
    }
}

#[test]
fn a_demand_that_no_word_keeps_is_told() {
    let session = Session::new();
    let run = session.run("formats slabs --size 4x3 --psnr 299 --shifts 1 --check triangle");
    assert_eq!(run.code, 4, "{}", run.messages);
    assert!(run.messages.contains("words of 32 bits do not keep a PSNR of at least 299 dB"), "{}", run.messages);
}

#[test]
fn demands_are_read_in_their_forms() {
    let session = Session::new();
    for (demand, code) in
        [("--largest 1/255", 0), ("--off 0", 0), ("--largest 2", 2), ("--psnr 60 --off 0", 2), ("--largest 1/0", 2)]
    {
        let run = session.run(&format!("formats triangle --size 4x3 --shifts 1 --check triangle {demand}"));
        assert_eq!(run.code, code, "{demand}: {}", run.messages);
    }
}
