//! `--study`: the points of a command as a file that `lancer sweep` runs, with the same figures row by row.

use clap::CommandFactory;
use lancer::command::Lancer;
use serde_json::{Value, json};

use super::session::Session;
use super::settings::SAMPLES;

/// A folder with files that options name.
fn session() -> Session {
    let session = Session::new();
    session.succeed("scene generate triangle");
    session.write("m.toml", "cores = 3\nclock_hz = 7_000_000\n[bus]\nweights = [2, 1]\narbiter = \"weighted\"\n");
    session.write("half.isa", ".extension half\n.instr half (d: S, a: S) \"custom0 ddddd aaaaa ----------------\" [Done(body)]\n    srai d, a, 1\n.end\n");
    let triangle = concat!(env!("CARGO_MANIFEST_DIR"), "/kernels/asm/vector/triangle.s");
    session.write("my.s", &(std::fs::read_to_string(triangle).unwrap() + "\n    nop\n"));
    session
}

/// Rows of the study of a file.
fn swept(session: &Session, study: &str) -> Vec<Value> {
    let run = session.run(&format!("sweep {study} -o rows.jsonl"));
    assert_eq!(run.code, 0, "{}", run.messages);
    let text = String::from_utf8(session.read("rows.jsonl")).unwrap();
    std::fs::remove_dir_all(session.path("rows.parts")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Writes the study of a command, which draws nothing, and runs it.
fn rows(session: &Session, command: &str) -> Vec<Value> {
    let run = session.run(&format!("{command} --study s.toml"));
    assert_eq!((run.code, run.out.as_str()), (0, ""), "{}", run.messages);
    assert!(run.messages.starts_with("s: ") && run.messages.contains(" points, "), "{}", run.messages);
    swept(session, "s.toml")
}

#[track_caller]
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is a number"))
}

/// Numbers that are sums of the same in another order.
#[track_caller]
fn near(one: f64, other: f64) {
    assert!((one - other).abs() <= 1e-12 * one.abs().max(other.abs()), "{one} {other}");
}

fn list<'v>(value: &'v Value, key: &str) -> &'v [Value] {
    value[key].as_array().unwrap_or_else(|| panic!("no list {key}"))
}

/// Options of a picture that are not their defaults, which all commands here take.
const OPTIONS: &str = "--camera perspective --eye 0.1,0.2,5 --fov 50 --look 0,0.1,0 --ambient 0.2 --background 0.1,0.2,0.3 --shift 0.05,-0.125 \
                       --crop 2,1,7,6 --no-skip unlit,tested --kd-depth 7 --kd-build exact --format dir=22 --overflow WRAP:2 \
                       --kernel triangle=my.s --ext half.isa --set bus.setup_clocks=3 --set main.traffic=false";

/// Compares a variant with the rows of its shifts.
fn compare_variant(variant: &Value, rows: &[Value]) {
    let sum = |name: &str| rows.iter().map(|row| row[name].as_u64().unwrap()).sum::<u64>();
    let pixels = sum("pixels") as f64;
    for row in rows {
        for label in ["scene", "profile", "layout", "word", "rounding", "bounces", "machine", "cores", "arbiter"] {
            assert_eq!(row[label], variant[label], "{label}");
        }
        assert_eq!(number(&row["position_bits"]), number(&variant["formats"]["pos"]));
        assert_eq!(row["word"], variant["formats"]["word"]);
    }
    for name in ["clocks", "instructions", "octets"] {
        assert_eq!(number(&variant[name]), sum(name) as f64 / pixels, "{name}");
    }
    near(number(&variant["seconds"]), rows.iter().map(|row| number(&row["seconds"])).sum::<f64>() / pixels);
    let classes = variant["operations"].as_object().unwrap();
    let of = |is_counted: &dyn Fn(&str) -> bool| {
        let counted = classes.iter().filter(|(class, _)| is_counted(class));
        counted.map(|(_, count)| count.as_u64().unwrap()).sum::<u64>()
    };
    assert_eq!(of(&|class| !["move", "octet"].contains(&class)), sum("operations"));
    assert_eq!(of(&|class| ["add", "sub", "mul", "div", "cmp"].contains(&class)), sum("elementary"));
    let method = if rows.iter().all(|row| row["method"] == "replayed") { "replayed" } else { "stepped" };
    assert_eq!(variant["method"], method);
    // Errors stand by shift.
    let shifts = list(variant, "shifts");
    assert_eq!(shifts.len(), rows.len());
    for (shift, row) in shifts.iter().zip(rows) {
        assert_eq!(shift["shift"], json!([row["shift_x"], row["shift_y"]]));
        for (name, column) in [
            ("rmse", "rmse"),
            ("max", "max_error"),
            ("off_pixels", "off_pixels"),
            ("psnr_db", "psnr_db"),
            ("psnr_others_db", "psnr_others_db"),
        ] {
            assert_eq!(shift[name], row[column], "{name} of {}", variant["variant"]);
        }
    }
    let off: Vec<u64> = rows.iter().map(|row| row["off_pixels"].as_u64().unwrap()).collect();
    assert_eq!(number(&variant["off"]["mean"]), off.iter().sum::<u64>() as f64 / off.len() as f64);
    assert_eq!(number(&variant["off"]["worst"]), off.into_iter().max().unwrap() as f64);
}

#[test]
fn accuracy_has_the_figures_of_its_study() {
    let session = session();
    for command in [
        "accuracy cornell slabs --size 9x7 --words 32,20 --profiles ray,report --bounces 5,1 --cutoffs 0,0.25 --interpolate none,0.05 \
         --machine report,wide32,m.toml --cores 2,3 --arbiter tdma --shifts 2"
            .to_owned(),
        format!("accuracy cornell --size 12x9 --words 32 --profiles vector --roundings TRN --layouts wide --bounces 2 --interpolate none,0.1 {OPTIONS}"),
        "accuracy triangle.dsc --mesh triangle.off --size 8x6 --words 24 --machine m.toml".to_owned(),
    ] {
        let (result, rows) = (session.json(&command), rows(&session, &command));
        let (variants, shifts) = (list(&result, "variants"), list(&result, "shifts").len());
        assert!(list(&result, "refused").is_empty(), "{command}");
        assert_eq!(rows.len(), variants.len() * shifts, "{command}");
        variants.iter().zip(rows.chunks(shifts)).for_each(|(variant, rows)| compare_variant(variant, rows));
    }
    // What does not fit is refused in both: a word of 12 bits has no room for directions of 22.
    let command = "accuracy cornell --size 8x6 --words 32,12 --profiles ray --format dir=22 --interpolate none --cutoffs 0 --bounces 5";
    let (result, rows) = (session.json(command), rows(&session, command));
    let refused: Vec<&Value> = rows.iter().filter(|row| !row["refused"].is_null()).collect();
    assert!(!refused.is_empty() && refused.len() < rows.len(), "{result}");
    let reasons: Vec<&Value> = list(&result, "refused").iter().map(|variant| &variant["reason"]).collect();
    assert_eq!(reasons, refused.iter().map(|row| &row["refused"]).collect::<Vec<_>>());
}

#[test]
fn cores_has_the_figures_of_its_study() {
    let session = session();
    for command in [
        "cores cornell --size 9x7 --cores 2,5 --machine report,m.toml --machine wide32,bit_serial --arbiter tdma,oldest-first".to_owned(),
        format!("cores cornell --size 12x9 --cores 1-3 --profile vector --layout wide --word 24 --rounding TRN --bounces 2 --weight-cutoff 0.125 --interpolate=0.1 {OPTIONS}"),
    ] {
        let (result, rows) = (session.json(&command), rows(&session, &command));
        let machines = list(&result, "machines");
        let points = machines.iter().flat_map(|machine| list(machine, "points").iter().map(move |point| (machine, point)));
        assert_eq!(points.clone().count(), rows.len());
        let mut alone = 0.0;
        for ((machine, point), row) in points.zip(&rows) {
            assert_eq!((&row["scene"], &row["machine"]), (&result["scene"], &machine["machine"]));
            assert_eq!(row["arbiter"], machine["arbiter"]);
            for name in ["cores", "clocks", "seconds", "utilisation", "waiting", "idle", "longest_wait", "method"] {
                assert_eq!(row[name], point[name], "{name}");
            }
            near(number(&row["main_load"]), number(&point["main_load"]) + number(&point["main_waiting"]));
            let items = row["pixels"].as_u64().unwrap() - row["interpolated"].as_u64().unwrap();
            assert_eq!(result["pixels"], items);
            assert_eq!(number(&point["pixel_seconds"]), number(&row["seconds"]) / items as f64);
            near(
                number(&point["operations_per_second"]),
                number(&row["elementary"]) / number(&row["clocks"]) * number(&machine["clock_hz"]),
            );
            // The first of each machine is one core.
            if row["cores"] == 1 {
                alone = number(&row["clocks"]);
            }
            near(number(&point["speed_up"]), alone / number(&row["clocks"]));
            assert_eq!(number(&row["position_bits"]), number(&machine["formats"]["pos"]));
        }
    }
}

#[test]
fn advise_has_the_figures_of_its_study() {
    let session = session();
    for command in [
        "advise cornell --size 9x7 --machine m.toml".to_owned(),
        format!("advise cornell --size 12x9 --word 24 --profile vector --cores 2 --arbiter tdma {OPTIONS}"),
    ] {
        let run = session.run(&format!("{command} --study tried.toml --json"));
        assert_eq!(run.code, 0, "{}", run.messages);
        let result: Value = serde_json::from_str(&run.out).unwrap();
        let rows = swept(&session, "tried.toml");
        let now = [(&result["now"], false)];
        let changes = ["advice", "pairs"].into_iter().flat_map(|key| list(&result, key));
        let changes = changes.map(|advice| (&advice["predicted"], advice["changes_picture"] == true));
        let found: Vec<(&Value, bool)> = now.into_iter().chain(changes).collect();
        assert!(found.len() > 20);
        for ((predicted, changes_picture), row) in found.iter().zip(&rows) {
            for name in ["clocks", "seconds", "utilisation", "waiting", "idle", "method"] {
                assert_eq!(row[name], predicted[name], "{name} of {row}");
            }
            let items = row["pixels"].as_u64().unwrap() - row["interpolated"].as_u64().unwrap();
            assert_eq!(number(&predicted["pixel_seconds"]), number(&row["seconds"]) / items as f64);
            assert_eq!(row["image_hash"] != rows[0]["image_hash"], *changes_picture, "{row}");
        }
        // What was tried and has no figures comes last.
        assert!(rows[found.len()..].iter().all(|row| !row["refused"].is_null()));
        assert!(rows[..found.len()].iter().all(|row| row["refused"].is_null()));
    }
}

#[test]
fn formats_has_the_figures_of_its_study() {
    let session = session();
    let run = session.run("formats cornell slabs --psnr 35 --size 6x4 --shifts 2 --guard 1 --check triangle --machine m.toml --study words.toml --json");
    assert_eq!(run.code, 0, "{}", run.messages);
    let result: Value = serde_json::from_str(&run.out).unwrap();
    let rows = swept(&session, "words.toml");
    let words: Vec<&Value> = list(&result, "uniform").iter().collect();
    let choices: Vec<&Value> = std::iter::once(&result["found"]).chain(words.iter().copied()).collect();
    assert_eq!(rows.len(), 2 * choices.len() * 2);
    // Rows stand scene by scene, in each the choices one after the other, of each choice two shifts
    for (number_of, (choice, at)) in
        (0..2).flat_map(|scene| choices.iter().map(move |choice| (choice, scene))).enumerate()
    {
        let (scene, rows) = (&choice["scenes"][at], &rows[2 * number_of..][..2]);
        if !scene["refused"].is_null() {
            assert!(rows.iter().any(|row| row["refused"] == scene["refused"]));
            continue;
        }
        let sum = |name: &str| rows.iter().map(|row| number(&row[name])).sum::<f64>();
        assert_eq!(rows[0]["scene"], scene["scene"]);
        assert_eq!(number(&scene["clocks"]), sum("clocks") / sum("pixels"));
        // The mean over shifts is that of squared errors, not of decibels.
        let square = rows.iter().map(|row| number(&row["rmse"]).powi(2)).sum::<f64>() / 2.0;
        near(number(&scene["error"]["psnr_db"]), -10.0 * square.log10());
        assert_eq!(number(&scene["error"]["mean_off"]), sum("off_pixels") / 2.0);
        let most = |name: &str| rows.iter().map(|row| number(&row[name])).fold(0.0, f64::max);
        assert_eq!(number(&scene["error"]["worst_off"]), most("off_pixels"));
        assert_eq!(number(&scene["error"]["largest"]), most("max_error"));
    }
    // Behind the two rows of what was found come the words, on the first scene
    for (word, row) in words.iter().zip(rows[2..].chunks(2)) {
        assert_eq!((&row[0]["word"], &row[0]["layout"]), (&word["word"], &word["layout"]));
    }
}

/// Options that no point depends on: they say which files are written, and how what is drawn is shown.
const SHOWING: [&str; 22] = [
    "study",
    "recordings",
    "recordings-limit",
    "axis",
    "error",
    "over",
    "csv",
    "svg",
    "pdf",
    "columns",
    "theme",
    "json",
    "energy",
    "timing",
    "roofline",
    "all",
    "help",
    "settings",
    "message-format",
    "color",
    "threads",
    "quiet",
];

/// A value of each option that `lancer render` does not have, or has for another purpose, and that is not its default.
const OWN_SAMPLES: [(&str, &str); 9] = [
    ("mesh", "triangle.off"),
    ("words", "17,18"),
    ("profiles", "vector,ray"),
    ("roundings", "TRN_ZERO"),
    ("layouts", "packed"),
    ("cutoffs", "0.5"),
    ("shifts", "3"),
    ("cores", "3,7"),
    ("set", "bus.setup_clocks=5"),
];

#[test]
fn every_option_of_a_picture_is_in_the_study() {
    let session = session();
    let command = Lancer::command();
    let written = |line: &str| {
        let run = session.run(line);
        assert_eq!(run.code, 0, "{line}: {}", run.messages);
        // The result of `lancer advise` comes as well, so all studies are files.
        String::from_utf8(session.read("s.toml")).unwrap()
    };
    for name in ["accuracy", "cores", "advise"] {
        let base = |size: &str| format!("{name} triangle.dsc --size {size} --study s.toml");
        let plain = written(&base("8x6"));
        for argument in command.find_subcommand(name).unwrap().get_arguments() {
            let option = argument.get_long().unwrap_or("scene");
            if SHOWING.contains(&option) {
                continue;
            }
            let sample = OWN_SAMPLES.iter().chain(&SAMPLES).find(|(known, _)| *known == option);
            let (_, sample) = sample.unwrap_or_else(|| panic!("--{option} of {name} has no sample here"));
            // `lancer advise` tries dozens of machines on each picture, and its study has what it was given: some options will do.
            if name == "advise" && !["scene", "eye", "kernel", "format", "machine", "kd-depth"].contains(&option) {
                continue;
            }
            let line = match option {
                "scene" => base("8x6").replace("triangle.dsc", sample),
                "size" => base(sample),
                _ => format!("{} --{option}={sample}", base("8x6")),
            };
            assert_ne!(written(&line), plain, "--{option} changes nothing of the study of {name}");
        }
    }
}

#[test]
fn what_cannot_be_a_study_is_refused() {
    let session = session();
    session.fail("cores annex --study s.toml", 2, "the report's estimate is no picture");
    session.fail("accuracy - --study s.toml", 1, "standard input");
    session.fail("advise - --study s.toml", 1, "a study cannot name standard input");
    session.fail("formats - --study s.toml", 1, "a study cannot name standard input");
    session.fail("accuracy --study s.toml --json", 2, "cannot be used with");
    session.fail("cores cornell --study s.toml --svg a.svg", 2, "cannot be used with");
    session.fail("cores triangle.dsc --study triangle.off", 2, "would be overwritten");
    session.fail("advise cornell --size 4x3 --study a.csv --csv a.csv", 2, "would be written twice");
    session.fail("accuracy --crop 9,9,999,9 --study s.toml", 2, "outside a picture");
    // A scene that has changed since is another one.
    let result = session.succeed("render triangle.dsc --size 8x6 --json");
    session.write("r.json", &result);
    session.run("cores --settings r.json --cores 2 --study s.toml");
    session.write("triangle.off", "OFF\n3 1 0\n0 0 0\n2 0 0\n0 1 0\n3 0 1 2\n");
    session.fail("sweep s.toml", 1, "is not what the settings were written for");
    assert_eq!(session.run("cores slabs --size 4x3 --study -").out.lines().nth(1), Some("name = \"cores\""));
}
