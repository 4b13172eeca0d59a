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

/// Annex II's lines as they are printed: row, line, operations of one, how many, total. Transcribed by itself, so that the program's own file can
/// be wrong.
const ANNEX_TWO: &str = "\
rt.sqrt: Addition 1 96 96, Soustraction 1 132 132, Multiplication 1 32 32, Comparaison 1 32 32
rt.triangle: Addition 1 9 9, Soustraction 1 15 15, Multiplication 1 27 27, Division 1 3 3, Comparaison 1 7 7
rt.packet: Addition 1 40 40, Comparaison 1 81 81, Intersection avec un triangle 61 40 2440
rt.normal: Soustraction vecteurs 3 2 6, Soustraction 1 3 3, Multiplication 1 6 6, Division 1 1 1, Racine Carré 292 1 292
rt.reflects: Comparaison 1 2 2, Intersection total 2561 1 2561
rt.refracts: Comparaison 1 2 2, Intersection total 2561 1 2561
rt.make_reflected: Addition vecteurs 3 1 3, Soustraction vecteurs 3 3 9, Produit Scalaire 5 1 5, Produit Scalaire x Vecteur 3 2 6, \
Soustraction 1 3 3, Multiplication 1 7 7, Division 1 1 1, Comparaison 1 2 2, Calcul d'un vecteur normal d'un triangle 308 1 308
rt.make_refracted: Addition vecteurs 3 1 3, Soustraction vecteurs 3 1 3, Produit Scalaire 5 5 25, Produit Scalaire x Vecteur 3 4 12, \
Addition 1 4 4, Soustraction 1 2 2, Multiplication 1 3 3, Division 1 1 1, Comparaison 1 9 9, Racine Carré 292 1 292, \
Calcul d'un vecteur normal d'un triangle 308 1 308
rt.ray_tree: Comparaison 1 10 10, Rayon se réfléchit sur la surface ? 2563 1 2563, Rayon se réfracte sur la surface ? 2563 1 2563, \
Créer rayon réfracté 662 1 662
rt.shade: Addition 1 104 104, Soustraction 1 96 96, Multiplication 1 69 69, Division 1 1 1, Comparaison 1 119 119, Racine Carré 292 1 292, \
Calcul d'un vecteur normal d'un triangle 308 1 308, Intersection avec un triangle 61 40 2440
rt.pixel: Comparaison 1 28 28, Calcul de l'intensité lumineuse 3429 22 75438, \
Génération de l'arbre des rayons secondaires 5797 22 127534";

#[test]
fn each_line_of_annex_two_is_printed_and_counted() {
    let result = annexes(&Session::new(), "");
    let rows = result["rows"].as_array().unwrap();
    let parts = |row: &Value| row["parts"].as_array().unwrap().clone();
    let mut found = String::new();
    for row in rows.iter().filter(|row| row["source"] == "Annex II") {
        let printed = parts(row).into_iter().filter(|part| !part["printed_each"].is_null());
        let line = |part: Value| {
            let label = part["label"].as_str().unwrap().to_owned();
            format!("{label} {} {} {}", part["printed_each"], part["printed_times"], part["printed_total"])
        };
        found += &format!("{}: {}\n", row["id"].as_str().unwrap(), printed.map(line).collect::<Vec<_>>().join(", "));
    }
    assert_eq!(found.trim_end(), ANNEX_TWO);
    // What is counted adds up to the row, line by line, and accesses to memory to theirs.
    for row in rows {
        let sum = |is_memory: bool| -> u64 {
            let those = parts(row).into_iter().filter(|part| (part["kind"] == "mem") == is_memory);
            those.map(|part| part["counted_total"].as_u64().unwrap()).sum()
        };
        assert_eq!(sum(false), row["assumed_total"].as_u64().unwrap(), "{row}");
    }
    let counted = |id: &str, kind: &str| {
        let row = rows.iter().find(|row| row["id"] == id).unwrap();
        let part = parts(row).into_iter().find(|part| part["kind"] == kind);
        part.map(|part| ["counted_times", "counted_total"].map(|key| part[key].as_u64().unwrap()))
    };
    assert_eq!(counted("rt.packet", "rt.triangle"), Some([40, 2440]));
    assert_eq!(counted("rt.normal", "vector_sub"), Some([2, 6]));
    assert_eq!(counted("rt.normal", "rt.sqrt"), Some([1, 292]));
    assert_eq!(counted("rt.make_reflected", "rt.normal"), Some([1, 316]));
    assert_eq!(counted("rt.make_refracted", "dot"), Some([1, 5]), "one dot product serves all places of the formula");
    assert_eq!(counted("rt.pixel", "rt.shade").map(|[times, _]| times), Some(22));
    assert_eq!(counted("kd.next_packet", "kd.descend").map(|[times, _]| times), Some(1));
}

/// Annex I's tables: bits, octets and totals of the structures, and what the ways down a tree take.
#[test]
fn annex_one_stands_beside_ours() {
    let session = Session::new();
    let result = annexes(&session, "");
    let storage = result["storage"]["rows"].as_array().unwrap();
    let number = |structure: &str, element: &str, unit: &str, key: &str| {
        let is_it = |row: &&Value| row["structure"] == structure && row["element"] == element && row["unit"] == unit;
        storage.iter().find(is_it).unwrap_or_else(|| panic!("{structure} {element} {unit}"))[key].as_f64()
    };
    for (structure, fields) in [
        ("triangle", "v1 48, v2 48, v3 48, small 48, big 48, materialId 8, total 248"),
        (
            "node",
            "left* 32, right* 32, next1* 32, trig* 32, pnum* 16, x0 48, x1 48, y0 48, y1 48, z0 48, z1 48, split 8, total 440",
        ),
        ("reference", "triangle* 32, next* 32, total 64"),
    ] {
        for field in fields.split(", ") {
            let (name, bits) = field.split_once(' ').unwrap();
            let bits: f64 = bits.parse().unwrap();
            assert_eq!(number(structure, name, "bits", "printed"), Some(bits), "{structure} {name}");
            assert_eq!(number(structure, name, "bits", "counted"), Some(bits), "{structure} {name}");
        }
    }
    for (structure, octets, count, megabytes) in [
        ("triangle", 31.0, 60_000.0, 1.773_834),
        ("node", 55.0, 65_536.0, 3.4375),
        ("reference", 8.0, 180_000.0, 1.373_291),
    ] {
        assert_eq!(number(structure, "total", "octets", "printed"), Some(octets));
        assert_eq!(number(structure, "count", "", "printed"), Some(count));
        assert_eq!(number(structure, "all", "MB", "printed"), Some(megabytes));
        let counted = number(structure, "count", "", "counted").unwrap() * octets / 1_048_576.0;
        assert!((number(structure, "all", "MB", "counted").unwrap() - counted).abs() < 1e-9);
    }
    assert_eq!(number("triangle", "count", "", "counted"), Some(60_000.0));
    assert_eq!(number("node", "total", "octets", "wide"), Some(8.0));
    // To the left everywhere 17 reads, to the right everywhere 33; of all ways the mean is half way.
    let rows = result["rows"].as_array().unwrap();
    let descend = rows.iter().find(|row| row["id"] == "kd.descend").unwrap();
    assert_eq!(["least", "mean", "most"].map(|key| descend["paths"][key]["mem"].as_f64().unwrap()), [17.0, 25.0, 33.0]);
    assert!(rows.iter().all(|row| row["path"].as_str().unwrap().len() > 20), "each driver says its path");
    // Work that is free for the annexes is there all the same.
    let sqrt = rows.iter().find(|row| row["id"] == "rt.sqrt").unwrap();
    assert!(sqrt["free"]["logic"].as_f64().unwrap() > 100.0, "{}", sqrt["free"]);
    let text = session.succeed("annex");
    for words in [
        "1.773834",
        "3.437500",
        "1.373291",
        "180,000",
        "Produit Scalaire x Vecteur",
        "16 levels, to the left at each",
        "free",
    ] {
        assert!(text.contains(words), "{words} is not in the text");
    }
}

#[test]
fn cores_of_others_stand_beside_ours() {
    let result = annexes(&Session::new(), "triangle --size 8x6");
    let cores = result["derived"]["cores"].as_array().unwrap();
    let names: Vec<&str> = cores.iter().map(|core| core["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["SiliconArts", "proposed", "counted, 22 nodes", "triangle"]);
    assert_eq!(cores[0]["rays_per_second"], serde_json::json!([5e6, 20e6]));
    assert_eq!(cores[0]["memory_octets"], 524_288.0);
    // 66 searches in 0.6315 ms of four cores.
    assert_eq!(cores[1]["rays_per_second"][0].as_f64().unwrap().round(), 26_128.0);
    assert_eq!(cores[1]["memory_octets"], 18_525.0);
    // 40 rays, which the bus slows down to 1.31 ms.
    let ours = cores[2]["rays_per_second"][0].as_f64().unwrap();
    assert!((7_000.0..8_000.0).contains(&ours), "{ours}");
}

#[test]
fn an_erratum_is_shown_beside_its_correction() {
    let session = Session::new();
    session.fail("annex --as-printed list -o list.png", 2, "there is no picture of a list");
    let list = session.succeed("annex --as-printed list");
    for name in ["first-hit", "refraction-root", "strict-sides", "light-position", "servers"] {
        assert!(list.contains(name), "{name} is not in\n{list}");
    }
    // Kernels: the picture as printed is another one, and is written.
    let result = session.json("annex --as-printed refraction-root --size 24x18 -o printed.png --corrected right.png");
    assert_eq!((&result["name"], &result["way"]), (&"refraction-root".into(), &"kernels".into()));
    let pair = &result["pictures"][0];
    let ratio = |side: &str| pair[side]["psnr_db"].as_f64().unwrap();
    assert!(ratio("printed") + 5.0 < ratio("correct"), "{pair}");
    assert!(pair["differing_pixels"].as_u64().unwrap() > 0);
    assert_eq!(result["edits"][0]["file"], "kernels/asm/report/refract.s");
    assert_ne!(session.read("printed.png"), session.read("right.png"));
    // A tree: all triangles are there, and a ray does more work to find them.
    let pair = &session.json("annex --as-printed best-plane mirrors --size 8x6")["pictures"][0];
    assert_eq!(pair["scene"], "mirrors");
    assert!(pair["printed"]["octets"].as_u64() > pair["correct"]["octets"].as_u64(), "{pair}");
    // A number.
    let figure = session.json("annex --as-printed normal");
    assert_eq!(figure["figure"], serde_json::json!({ "printed": 308.0, "correct": 316.0, "unit": "operations" }));
    assert!(session.succeed("annex --as-printed normal").contains("316"));
    // Mistakes of the user.
    let unknown = session.run("annex --as-printed frist-hit");
    assert!(unknown.messages.contains("did you mean `first-hit`?"), "{}", unknown.messages);
    let useless = session.run("annex --as-printed normal -o n.png");
    assert!(useless.messages.contains("no picture shows it"), "{}", useless.messages);
}
