//! Files of settings: machines, studies, settings of pictures, states of runs, vectors of arithmetic.

use emu::machine::Config;
use emu::machine::preset::PRESETS;
use lancer::settings::Settings;
use lancer::settings::read;
use lancer::stress::progress::RunProgress;
use lancer::stress::{CASES, CatalogueSize};
use lancer::sweep::study::{MOST_POINTS, Study};
use serde_json::{Value, json};

use super::source;
use crate::project::{files, listings, literals, pieces};
use crate::seen::{PlantedFault, Seen, is_sample};
use crate::surface::Surface;

const LONGEST: usize = 2000;
const MEMORY: usize = 16 << 20;

/// Machine files.
pub const MACHINE: Surface = Surface::text(
    (LONGEST, MEMORY),
    "machine",
    machines,
    read_machine,
    &[
        "emu/src/machine/config/file.rs",
        "emu/src/machine/config/law.rs",
        "emu/src/machine/config/formula.rs",
        "messages/src/document.rs",
    ],
);

/// Study files.
pub const STUDY: Surface =
    Surface::text((LONGEST, MEMORY), "study", studies, read_study, &["src/sweep/study.rs", "src/sweep/latin.rs"]);

/// Settings of pictures, as TOML and JSON.
pub const SETTINGS: Surface = Surface::text(
    (LONGEST, MEMORY),
    "settings",
    settings,
    read_settings,
    &["src/settings/read.rs", "src/settings/apply.rs", "src/settings/key.rs"],
);

/// States of runs of the catalogue of stress.
pub const STRESS: Surface = Surface::text((LONGEST, MEMORY), "stress", states, read_state, &["src/stress/progress.rs"]);

/// Vectors of arithmetic.
pub const ARITHMETIC: Surface =
    Surface::text((LONGEST, MEMORY), "arithmetic", vectors, read_vectors, &["conformance/src/vector.rs"]);

fn machines() -> Vec<Vec<u8>> {
    let presets = PRESETS.iter().map(|preset| preset.config().text().into_bytes());
    let tests = ["file", "law", "formula", "ledger"]
        .iter()
        .flat_map(|name| literals(&format!("emu/src/machine/config/{name}.rs")));
    pieces(presets.chain(tests).chain(listings()).collect(), LONGEST)
}

fn studies() -> Vec<Vec<u8>> {
    let examples = files("examples", ".toml").into_iter();
    pieces(examples.chain(literals("src/sweep/study.rs")).chain(listings()).collect(), LONGEST)
}

fn settings() -> Vec<Vec<u8>> {
    let own = Settings::default();
    let text = toml::to_string(&own).expect("settings are TOML");
    // Each key of each group by itself: in whole settings a change seldom meets anything, and reading them takes long.
    let groups = own.value().as_object().cloned().unwrap_or_default().into_iter().flat_map(|(group, value)| {
        let alone = match value {
            Value::Object(keys) => keys.into_iter().map(|(key, value)| json!({ key: value })).collect(),
            value => vec![value],
        };
        alone.into_iter().map(move |value| json!({ "settings": { group.as_str(): value } }).to_string())
    });
    let tables = text.split("\n\n").map(str::to_owned);
    let written = groups.chain(tables).map(String::into_bytes);
    let tests = literals("src/settings/read.rs").into_iter().chain(literals("tests/cli/settings.rs"));
    written.chain(pieces(tests.chain(listings()).collect(), LONGEST)).collect()
}

fn states() -> Vec<Vec<u8>> {
    let whole = CASES.iter().map(|case| {
        format!(
            "\"{}\":{{\"seed\":{},\"tally\":{{\"trials\":32,\"failures\":1,\"worst\":0.5,\"example\":[3,\"text\"]}}}}",
            case.name, case.seed
        )
    });
    let whole: Vec<String> = whole.collect();
    let state = |cases: &[String]| {
        format!("{{\"schema\":\"lancer-stress-state-1\",\"size\":\"quick\",\"cases\":{{{}}}}}", cases.join(","))
            .into_bytes()
    };
    (0..4).map(|count| state(&whole[..count])).collect()
}

fn vectors() -> Vec<Vec<u8>> {
    let lines = [
        "add,s,16,8,100,s,16,8,-3,-,-,-,-,s,16,8,RND,SAT,0,97,0,0",
        "mac,u,8,4,3,s,9,2,-7,s,20,10,5,s,12,6,TRN,WRAP,2,-16,-,-",
    ];
    let whole = format!("{}\n{}\n{}\n", conformance::HEADER, lines[0], lines[1]).into_bytes();
    let tests =
        ["vector", "tests", "operation"].iter().flat_map(|name| literals(&format!("conformance/src/{name}.rs")));
    pieces([whole].into_iter().chain(tests).chain(literals("tests/cli/numbers.rs")).collect(), LONGEST)
}

fn read_machine(input: &[u8], seen: &mut Seen) {
    let Some(source) = source("a.toml", input) else { return };
    match Config::parse(&source) {
        Err(report) => seen.report(&report, input),
        Ok(config) => {
            seen.count("keys", source.text.matches('=').count());
            if is_sample(input, 16) {
                let text = config.text();
                let again = Config::parse(&messages::Source::new("b.toml", text.as_str()));
                assert!(again.is_ok_and(|again| again == config), "a machine is read as it was written:\n{text}");
            }
            seen.plant(PlantedFault::Panic, config.cores == 64);
        }
    }
}

fn read_study(input: &[u8], seen: &mut Seen) {
    let Some(source) = source("a.toml", input) else { return };
    // A hypercube takes memory for each point that it was asked for, a few hundred octets; those with many are left out here.
    let root = toml::from_str::<toml::Table>(&source.text).unwrap_or_default();
    let points = root.get("latin").and_then(|latin| latin.get("points")).and_then(toml::Value::as_integer);
    if points.is_some_and(|points| (10_001..=MOST_POINTS as i64).contains(&points)) {
        return;
    }
    match Study::parse(&source, "a") {
        Err(report) => seen.report(&report, input),
        Ok(study) => {
            let count = study.count();
            seen.count("points", count as usize);
            seen.count("factors", study.factors.len());
            if count > 0 {
                let _ = (study.assignments(0), study.assignments(count - 1));
            }
            seen.plant(PlantedFault::Endless, count > 0 && count % 5 == 0);
        }
    }
}

fn read_settings(input: &[u8], seen: &mut Seen) {
    let Some(source) = source("a.toml", input) else { return };
    let stored = match read::parse(&source) {
        Err(report) => return seen.report(&report, input),
        Ok(stored) => stored,
    };
    match stored.settings() {
        Err(report) => seen.report(&report, input),
        Ok(settings) => {
            seen.count("keys", stored.keys.len());
            seen.count("options", settings.options().len());
            let text = toml::to_string(&settings).expect("settings are TOML");
            let again = read::parse(&messages::Source::new("b.toml", text)).and_then(|stored| stored.settings());
            assert_eq!(
                again.map_err(|report| report.render(false)),
                Ok(settings.clone()),
                "settings are read as they were written"
            );
            seen.plant(PlantedFault::Panic, stored.keys.len() == 3);
        }
    }
}

fn read_state(input: &[u8], seen: &mut Seen) {
    let Some(source) = source("a.json", input) else { return };
    match RunProgress::parse(&source, CatalogueSize::Quick) {
        Err(report) => seen.report(&report, input),
        Ok(state) => {
            seen.count("cases", state.cases.len());
            seen.plant(PlantedFault::Panic, state.cases.values().any(|case| case.tally.failures == 16));
        }
    }
}

fn read_vectors(input: &[u8], seen: &mut Seen) {
    let Some(source) = source("a.csv", input) else { return };
    let (vectors, report) = conformance::parse(&source);
    seen.report(&report, input);
    seen.count("vectors", vectors.len());
    for vector in &vectors {
        let outcome = vector.outcome();
        seen.name(vector.operation.name());
        seen.count(
            "flags",
            usize::from(outcome.is_quantized)
                + 2 * usize::from(outcome.has_overflowed)
                + 4 * usize::from(vector.expects(&outcome)),
        );
    }
    seen.plant(PlantedFault::Panic, vectors.len() == 5);
}
