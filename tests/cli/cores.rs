//! `lancer cores`: the report's question, answered by measurement.

use serde_json::Value;

use super::session::Session;

fn points(machine: &Value) -> &[Value] {
    machine["points"].as_array().unwrap()
}

fn figure(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is a number"))
}

#[test]
fn the_reports_estimate_fills_the_bus_at_five_cores_and_not_at_four() {
    let result = Session::new().json("cores annex");
    assert_eq!((&result["schema"], &result["pixels"]), (&"lancer-cores-1".into(), &1000.into()));
    let machine = &result["machines"][0];
    assert_eq!(machine["demand"], serde_json::json!({ "computing": 203_000.0, "transfer": 49_600.0 }));
    let shown = |value: &Value| format!("{:.2}", figure(value));
    assert_eq!(
        [&result["report_quotient"], &machine["quotient"], &machine["closed_form"]].map(shown),
        ["4.09", "4.09", "5.09"]
    );
    assert_eq!(
        (shown(&machine["saturation"]["cores"]).as_str(), &machine["saturation"]["limit"]),
        ("5.09", &"bus".into())
    );
    for point in points(machine) {
        // Pixels a clock are min(N / (C + M), 1 / M) within 1 %, and never more.
        let ratio = figure(&point["pixel_seconds"]) / figure(&point["bound_pixel_seconds"]);
        assert!((1.0..1.01).contains(&ratio), "{point}");
        assert!(point["queueing_pixel_seconds"].as_f64() >= point["bound_pixel_seconds"].as_f64(), "{point}");
        assert_eq!((&point["method"], &point["main_load"]), (&"replayed".into(), &point["main_load"]));
    }
    // Two points are enough where the second one fills the bus, and three are not where none does.
    let saturation =
        |cores: &str| Session::new().json(&format!("cores annex --cores {cores}"))["machines"][0]["saturation"].clone();
    assert_eq!(shown(&saturation("16")["cores"]), "5.09");
    assert!(saturation("2,3").is_null());
    // Four cores: 0.6315 ms a pixel without waiting, with the bus 78.5 % busy.
    let four = points(machine).iter().find(|point| point["cores"] == 4).unwrap();
    assert_eq!(format!("{:.4}", 1e3 * figure(&four["bound_pixel_seconds"])), "0.6315");
    assert!((figure(&four["utilisation"]) - 0.785).abs() < 0.005, "{four}");
}

#[test]
fn tables_and_files_say_the_same() {
    let session = Session::new();
    let text = session.succeed("cores annex --cores 1,4..6,8 --csv a.csv --svg a.svg");
    assert!(
        text.contains("saturation: 5.09 cores, where the bus is full\nexpected: (C + M) / M = 5.09, C / M = 4.09,"),
        "{text}"
    );
    let knee: Vec<&str> = text.lines().filter(|line| line.ends_with("| knee")).collect();
    assert!(knee.len() == 1 && knee[0].trim_start().starts_with("6 "), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    let csv = String::from_utf8(session.read("a.csv")).unwrap();
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0][..4], ["machine", "arbiter", "cores", "clocks"]);
    assert_eq!(rows[1..].iter().map(|row| row[2]).collect::<Vec<_>>(), ["1", "4", "5", "6", "8"]);
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
    let svg = String::from_utf8(session.read("a.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    for label in ["5.09 cores", "C / M = 4.09", "speed-up by cores", "bus busy"] {
        assert!(svg.contains(label), "{label}");
    }
}

#[test]
fn charts_have_their_data_beside_them() {
    let session = Session::new();
    session.succeed("cores annex --cores 1,4 --machine report --machine wide32 --svg a.svg --roofline b.pdf --theme dark --columns 1");
    assert_eq!(session.names(), ["a.csv", "a.svg", "b.pdf"]);
    let svg = String::from_utf8(session.read("a.svg")).unwrap();
    // A column of a paper, on a dark ground, with a row of plots a machine.
    assert!(svg.contains("width=\"252pt\"") && svg.contains("fill=\"#16191d\""), "{svg}");
    for machine in ["report", "wide32"] {
        assert!(svg.contains(&format!(">machine `{machine}`, arbiter round-robin<")), "{machine}");
    }
    let pdf = session.read("b.pdf");
    let holds = |words: &str| pdf.windows(words.len()).any(|window| window == words.as_bytes());
    assert!(holds("(operations an octet of the bus)") && holds("/MediaBox [0 0 252 "));
    session.fail("cores annex --roofline b.png", 2, "ends in .svg or .pdf");
    session.fail("cores annex --svg a.csv", 2, "would be written twice");
}

#[test]
fn machines_and_arbiters_stand_side_by_side_and_draw_the_same() {
    let session = Session::new();
    let scene = "cores cornell --size 12x9 --shift 0.137,0.071 --cores 1,3";
    let machines = "--machine report --machine wide32 --machine double_buffer --machine node_cache";
    let result = session.json(&format!("{scene} {machines} --arbiter oldest-first --arbiter tdma"));
    let machines = result["machines"].as_array().unwrap();
    let names: Vec<(&str, &str)> = machines
        .iter()
        .map(|machine| (machine["machine"].as_str().unwrap(), machine["arbiter"].as_str().unwrap()))
        .collect();
    let expected = ["report", "wide32", "double_buffer", "node_cache"];
    let expected: Vec<(&str, &str)> =
        expected.iter().flat_map(|name| [(*name, "oldest-first"), (*name, "tdma")]).collect();
    assert_eq!(names, expected);
    let one = |machine: &Value| figure(&points(machine)[0]["seconds"]);
    for presets in machines[2..].chunks(2) {
        assert!(one(&presets[0]) < one(&machines[0]), "every preset is faster than the report's machine");
    }
    // A run of one of them by itself gives the same clocks.
    session.write("m.toml", "cores = 3\n[bus]\narbiter = \"tdma\"\n");
    let alone = session.json("render cornell --size 12x9 --shift 0.137,0.071 --no-error --machine m.toml");
    assert_eq!(alone["clocks"], points(&machines[1])[1]["clocks"]);
    assert_eq!((&alone["method"], &alone["stepped_because"]), (&"replayed".into(), &Value::Null));
}

#[test]
fn no_measurement_is_below_the_time_without_waiting() {
    let session = Session::new();
    let arbiters = emu::machine::arbiter::ArbiterKind::ALL.map(|kind| format!("--arbiter {}", kind.name())).join(" ");
    let machines: Vec<String> =
        emu::machine::preset::PRESETS.iter().map(|preset| format!("--machine {}", preset.name)).collect();
    let machines = machines.join(" ");
    let result = session.json(&format!("cores cornell --size 12x9 --cores 1,2,3,4,8,16 {machines} {arbiters}"));
    for machine in result["machines"].as_array().unwrap() {
        for point in points(machine) {
            let [time, bound] = ["pixel_seconds", "bound_pixel_seconds"].map(|key| figure(&point[key]));
            assert!(bound <= time * (1.0 + 1e-12), "{} {} {point}", machine["machine"], machine["arbiter"]);
            // Below it by little where there is little waiting: one core waits for nobody but the main processor.
            assert!(point["cores"] != 1 || machine["arbiter"] == "tdma" || bound >= 0.85 * time, "{machine}");
        }
    }
}

#[test]
fn a_starved_main_processor_is_not_said_to_have_no_time() {
    let session = Session::new();
    session.write("m.toml", "[bus]\narbiter = \"fixed-priority\"\n");
    let result = session.json("cores cornell --size 20x15 --machine m.toml --cores 1,2,4,8");
    let machine = &result["machines"][0];
    let last = points(machine).last().unwrap();
    assert_eq!(machine["saturation"]["limit"], "bus");
    assert!(figure(&last["main_load"]) < 0.1 && figure(&last["main_waiting"]) > 0.5, "{last}");
    let text = session.succeed("cores cornell --size 20x15 --machine m.toml --cores 1,2,4,8");
    assert!(text.contains("where the bus is full; the main processor, which feeds the cores, waits for it"), "{text}");
    // The same shares as those of the picture by itself.
    let alone = session.json("render cornell --size 20x15 --machine m.toml --cores 8 --no-error");
    let busy = figure(&alone["main"]["busy"]) / figure(&alone["clocks"]);
    assert!((busy - figure(&last["main_load"])).abs() < 1e-12, "{busy} {last}");
}

#[test]
fn what_is_wrong_is_said_before_the_work() {
    let session = Session::new();
    session.fail("cores cornell --cores 0", 2, "no number of cores from 1 to 256");
    session.fail("cores cornell --cores 4..2", 2, "goes down");
    session.fail("cores anex", 1, "neither a file nor a generated scene");
    session.fail("cores annex --machine raport", 1, "did you mean `report`?");
    session.fail("cores annex --csv a --svg a", 2, "would be written twice");
    session.fail("cores annex --svg no/a.svg", 1, "there is no folder no");
    session.write("m.toml", "[bus]\nclocks_per_bet = 2\n");
    session.fail("cores annex --machine m.toml", 1, "m.toml:2:1");
    assert_eq!(session.names(), ["m.toml"]);
}
