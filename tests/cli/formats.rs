//! Formats that are found keep the demand, and are read back by other commands.

use lancer::formats::SEARCHED_SHIFTS;
use lancer::numeral::short;
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

/// Figures of a scene over the shifts of a search.
#[derive(Clone, Copy, Debug)]
struct ShiftedFigures {
    /// Octets a pixel: all, and those of nodes, references and triangles.
    octets: [f64; 4],
    psnr: f64,
    /// Nanojoules a pixel in the mean of what tables say.
    nanojoules: f64,
}

fn over_shifts(session: &Session, scene: &str, formats: &str) -> ShiftedFigures {
    let (mut octets, mut square, mut nanojoules) = ([0.0; 4], 0.0, 0.0);
    let shifts = &SEARCHED_SHIFTS[..4];
    for [x, y] in shifts {
        let drawn = session.json(&format!("render {scene} --size 32x24 --shift={x},{y} --energy {formats}"));
        let number = |value: &Value| value.as_f64().expect("a number");
        let bus = &drawn["bus"];
        let kinds = ["nodes", "references", "triangles"].map(|kind| &bus["kinds"][kind]);
        for (sum, moved) in octets.iter_mut().zip([&bus["moved"]].into_iter().chain(kinds)) {
            *sum += number(moved);
        }
        square += number(&drawn["error"]["rmse"]).powi(2);
        let range = &drawn["energy"]["frame_nj"];
        nanojoules += (number(&range["least"]) + number(&range["most"])) / 2.0;
    }
    let pictures = shifts.len() as f64;
    ShiftedFigures {
        octets: octets.map(|octets| octets / pictures / 768.0),
        psnr: -10.0 * (square / pictures).log10(),
        nanojoules: nanojoules / pictures / 768.0,
    }
}

#[test]
fn formats_of_five_scenes_move_a_fifth_less_than_the_best_word() {
    let page =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/bits.md")).expect("the page is there");
    let (_, settings) = page.split_once("```toml\n").expect("the formats");
    let (settings, _) = settings.split_once("```").expect("their end");
    let session = Session::new();
    session.write("five.toml", settings);
    // Octets by kind, in the word, in the word in the same tree; nanojoules of what was found and of the word.
    let (mut means, mut nanojoules) = ([0.0; 6], [0.0; 2]);
    let cells =
        |octets: &[f64]| octets.iter().map(|&octets| short(octets.round() as u64)).collect::<Vec<_>>().join(" | ");
    for scene in ["cornell", "sphereflake", "slabs", "mirrors", "terrain"] {
        let own = over_shifts(&session, scene, "--settings five.toml");
        let in_word =
            |tree: &str| over_shifts(&session, scene, &format!("--profile ray --layout packed --word 26 {tree}"));
        let [word, same_tree] = ["", "--kd-visit 12"].map(in_word);
        assert!(own.psnr >= 60.0 && word.psnr >= 60.0, "{scene}: {own:?} {word:?}");
        let [all, nodes, references, triangles] = own.octets;
        let octets = [all, nodes, references, triangles, word.octets[0], same_tree.octets[0]];
        let row = format!("| {scene} | {} | {:.1} dB |\n", cells(&octets), own.psnr);
        assert!(page.contains(&row), "docs/bits.md lacks {row}");
        means.iter_mut().zip(octets).for_each(|(mean, octets)| *mean += octets / 5.0);
        nanojoules.iter_mut().zip([own, word]).for_each(|(mean, one)| *mean += one.nanojoules / 5.0);
    }
    let row = format!("| mean | {} | |\n", cells(&means));
    assert!(page.contains(&row), "docs/bits.md lacks {row}");
    let [octets, .., word, same_tree] = means;
    assert!(
        octets <= 0.8 * word && octets <= same_tree && nanojoules[0] <= 0.8 * nanojoules[1],
        "{means:?} {nanojoules:?}"
    );
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
    // Nothing that is read is overwritten.
    session.succeed("scene generate triangle -o .");
    session.write("m.toml", "cores = 3\n");
    for (line, place) in [
        ("triangle.dsc", "-o triangle.off"),
        ("triangle.dsc", "--study triangle.dsc"),
        ("triangle --check triangle.dsc", "-o triangle.dsc"),
        ("triangle --machine m.toml", "-o m.toml"),
    ] {
        let line = format!("formats {line} --size 4x3 --shifts 1 {place}");
        session.fail(&line, 2, "is read, and would be overwritten");
    }
}
