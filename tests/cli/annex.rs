//! `lancer annex`: its forms say the same, and what is printed adds up.

use serde_json::Value;

use super::session::Session;

fn annexes(session: &Session, arguments: &str) -> Value {
    serde_json::from_str(&session.succeed(&format!("annex {arguments} --json"))).expect("--json prints JSON")
}

#[test]
fn terms_sum_to_differences_by_class() {
    let result = annexes(&Session::new(), "");
    let rows = result["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 15);
    for row in rows {
        for (class, difference) in row["difference"].as_object().unwrap() {
            let terms = row["terms"].as_array().unwrap().iter().filter(|term| term["class"] == **class);
            let sum: i64 = terms.map(|term| term["n"].as_i64().unwrap()).sum();
            let number = |key: &str| row[key][class].as_i64().unwrap_or(0);
            assert_eq!(difference.as_i64().unwrap(), number("assumed") - number("printed"), "{row}");
            assert_eq!(difference.as_i64().unwrap(), sum, "{row}");
        }
    }
    let totals = |id: &str| {
        let row = rows.iter().find(|row| row["id"] == id).unwrap();
        ["printed_total", "assumed_total"].map(|key| row[key].as_u64().unwrap())
    };
    // As printed in Annex II, and as counted.
    assert_eq!(totals("rt.sqrt"), [292, 292]);
    assert_eq!(totals("rt.triangle"), [61, 61]);
    assert_eq!(totals("rt.packet"), [2561, 2561]);
    assert_eq!(totals("rt.normal"), [308, 316]);
    assert_eq!(totals("rt.make_reflected")[0], 344);
    assert_eq!(totals("rt.pixel")[0], 203_022);
}

#[test]
fn scenes_have_calls_and_figures() {
    let result = annexes(&Session::new(), "cornell --size 12x9");
    let triangle = result["rows"].as_array().unwrap().iter().find(|row| row["id"] == "rt.triangle").unwrap();
    let scene = &triangle["scenes"][0];
    assert_eq!((&scene["scene"], &scene["least"], &scene["most"]), (&"cornell".into(), &61.into(), &61.into()));
    assert_eq!(scene["mean"]["mul"], 27.0);
    let figures = &result["derived"]["figures"];
    assert_eq!(figures["processors"]["printed"], 4.09);
    let storage = &result["derived"]["scenes"][0]["storage_octets"];
    assert_eq!(storage[0], 676 * 31);
}

#[test]
fn the_other_forms_have_the_same_rows() {
    let session = Session::new();
    let csv = session.succeed("annex --csv");
    assert!(csv.starts_with("id,what,calls,add,sub,mul,div,cmp,mem,sum,least,most\n"));
    assert!(csv.contains("\nrt.sqrt,counted,,96,132,32,0,32,,292,,\n"), "{csv}");
    assert!(csv.contains("\nkd.descend,printed,,0,0,0,0,16,16,16,,\n"), "{csv}");
    assert!(csv.lines().all(|line| line.matches(',').count() == 11), "{csv}");
    let markdown = session.succeed("annex --markdown");
    assert!(markdown.contains("| rt.normal | printed |") && markdown.contains("\n|---|---:|"), "{markdown}");
    let text = session.succeed("annex");
    assert!(text.contains("+8") && text.contains("kernels/asm/report/unit.s:"), "{text}");
    let errata = session.succeed("annex --errata");
    assert!(errata.contains("203,022") && errata.contains("Effect: "), "{errata}");
}
