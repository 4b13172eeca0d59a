//! Differences between two results, or between two files of settings: key by key, numbers in per cent. Nothing here opens files or
//! prints.

use std::collections::BTreeMap;
use std::sync::Arc;

use messages::{Diagnostic, Place, Report, Source, read_toml};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use crate::settings::read::check_toml_size;

/// Version of [`DiffResult`].
pub const SCHEMA: &str = "lancer-diff-1";

/// Part of a result that a key belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DiffPart {
    /// Scene, picture, kernels, machine and numbers, which decide the result.
    Settings,
    /// Rays, instructions, operations and octets.
    Counts,
    /// Time of the machine.
    Clocks,
    /// Difference from double precision.
    Error,
    /// Hashes of pictures and runs, which say equal or not.
    Hashes,
    /// Everything else.
    Other,
}

impl DiffPart {
    /// All parts, in the order of results.
    pub const ALL: [DiffPart; 6] =
        [DiffPart::Settings, DiffPart::Counts, DiffPart::Clocks, DiffPart::Error, DiffPart::Hashes, DiffPart::Other];

    /// Name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            DiffPart::Settings => "settings",
            DiffPart::Counts => "counts",
            DiffPart::Clocks => "clocks",
            DiffPart::Error => "error",
            DiffPart::Hashes => "hashes",
            DiffPart::Other => "other",
        }
    }

    /// The part of a key such as `bus.moved`; its last names say most.
    fn of(key: &str) -> DiffPart {
        let names: Vec<&str> = key.split(['.', '[']).collect();
        let (first, last) = (names[0], names[names.len() - 1]);
        let clocks = ["clocks", "seconds", "busy", "waiting", "idle", "longest_wait", "waits", "load", "utilisation"];
        let settings = [
            "settings",
            "scene",
            "profile",
            "machine",
            "width",
            "height",
            "crop",
            "size",
            "shift",
            "clock_hz",
            "formats",
            "word",
            "layout",
            "rounding",
            "bounces",
            "cutoff",
            "interpolate",
            "cores",
            "arbiter",
            "engine",
            "engine_because",
            "method",
            "stepped_because",
            "version",
        ];
        let counts =
            ["rays", "counts", "instructions", "octets", "functions", "regions", "triangles", "calls", "items"];
        // The order decides: `settings.machine.clocks.mul` is a setting, `bus.longest_wait` a time, and other keys of `bus` are counts.
        match first {
            "settings" => DiffPart::Settings,
            "error" => DiffPart::Error,
            _ if last.ends_with("_hash") => DiffPart::Hashes,
            // At the top `cores` is a number of the machine; `cores[0].octets` is a count.
            _ if names.len() == 1 && settings.contains(&first) => DiffPart::Settings,
            "formats" | "crop" => DiffPart::Settings,
            _ if clocks.iter().any(|name| names.contains(name)) || last.ends_with("seconds") => DiffPart::Clocks,
            "bus" | "main" | "cores" => DiffPart::Counts,
            _ if counts.iter().any(|name| names.contains(name)) => DiffPart::Counts,
            _ if settings.contains(&last) => DiffPart::Settings,
            _ => DiffPart::Other,
        }
    }
}

/// A key whose values differ.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct KeyDifference {
    /// Path of the key, such as `bus.moved` or `functions[triangle].calls`.
    pub key: String,
    /// Part of the result that it belongs to.
    pub part: DiffPart,
    /// Value in the first file; null where it has none.
    pub a: Value,
    /// Value in the second file; null where it has none.
    pub b: Value,
    /// Change from the first to the second number, in per cent of the first; null for what are no numbers, and from 0.
    pub percent: Option<f64>,
    /// True where the change is no larger than the tolerance, or is one that does not count.
    pub is_within: bool,
}

/// Differences between two files.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DiffResult {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Path of the first file.
    pub a: String,
    /// Path of the second file.
    pub b: String,
    /// Change that is allowed, in per cent.
    pub tolerance: f64,
    /// True where nothing changes by more than the tolerance.
    pub is_within: bool,
    /// Number of keys that were compared.
    pub compared: usize,
    /// Keys whose values differ: settings first, then counts, clocks, error, hashes and the rest.
    pub differences: Vec<KeyDifference>,
}

/// A file with its name.
pub struct DiffSide<'a> {
    /// Path as the user gave it.
    pub name: String,
    /// Contents of the file.
    pub value: &'a Value,
}

/// Contents of a file: JSON where its first character says so, else TOML.
///
/// # Errors
/// Text that is neither, with its place.
pub fn parse(source: &Arc<Source>) -> Result<Value, Report> {
    let is_json = source.text.trim_start_matches('\u{feff}').trim_start().starts_with('{');
    if !is_json {
        check_toml_size(source)?;
        return read_toml(source, |_: &Value| Vec::new());
    }
    serde_json::from_str(&source.text).map_err(|error| {
        // The parser counts lines and columns from 1, columns in octets.
        let line: usize = source.text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum();
        let at = line + error.column().saturating_sub(1);
        let message = error.to_string();
        let message = message.split(" at line ").next().unwrap_or_default().to_owned();
        Diagnostic::error(message).at(Place::new(source, at..at + 1), "").into()
    })
}

/// Keys that name an element of a list, the first that all elements have with different values.
const NAMES: [&str; 7] = ["name", "key", "variant", "machine", "scene", "word", "cores"];

/// Puts every value that is no table and no list on a list, by its path.
fn flatten<'a>(value: &'a Value, path: &str, out: &mut BTreeMap<String, &'a Value>) {
    match value {
        Value::Object(keys) => keys.iter().for_each(|(key, value)| {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            flatten(value, &path, out);
        }),
        Value::Array(items) => {
            // Functions of two programs are compared by their names, not by their places.
            let named = NAMES.iter().find_map(|name| {
                let names: Option<Vec<&str>> = items.iter().map(|item| item.get(name)?.as_str()).collect();
                let names = names?;
                let distinct: std::collections::BTreeSet<&&str> = names.iter().collect();
                (distinct.len() == names.len()).then(|| names.iter().map(|name| (*name).to_owned()).collect())
            });
            let names: Vec<String> = named.unwrap_or_else(|| (0..items.len()).map(|at| at.to_string()).collect());
            items.iter().zip(names).for_each(|(item, name)| flatten(item, &format!("{path}[{name}]"), out));
        }
        leaf => {
            out.insert(path.to_owned(), leaf);
        }
    }
}

/// The change between two numbers in per cent of the first; `None` for what are none, and from 0.
fn percent(a: &Value, b: &Value) -> Option<f64> {
    let (a, b) = (a.as_f64()?, b.as_f64()?);
    (a != 0.0).then(|| 100.0 * (b - a) / a.abs())
}

/// Compares two files. Times of the host (`host`, `timing`) are left out.
///
/// Of two results, settings say why the rest differs, so they never count, and hashes only that it does: they do not count where a tolerance is given.
/// Of two files of settings, everything counts.
pub fn compare(a: &DiffSide, b: &DiffSide, tolerance: f64) -> DiffResult {
    let (mut of_a, mut of_b) = (BTreeMap::new(), BTreeMap::new());
    // Write both as paths, each with its value
    flatten(a.value, "", &mut of_a);
    flatten(b.value, "", &mut of_b);
    // Results carry a schema, files of settings do not.
    let are_results = [a, b].iter().all(|side| side.value.get("schema").is_some());
    let is_host = |key: &str| key.split(['.', '[']).any(|name| name == "host");
    let keys: Vec<&String> = {
        let all: std::collections::BTreeSet<&String> = of_a.keys().chain(of_b.keys()).collect();
        all.into_iter().filter(|key| !is_host(key)).collect()
    };
    let null = Value::Null;
    // Compare path by path; one that a side lacks is null there
    let difference = |key: &&String| {
        let (a, b) = (*of_a.get(*key).unwrap_or(&&null), *of_b.get(*key).unwrap_or(&&null));
        if a == b {
            return None;
        }
        let part = if are_results { DiffPart::of(key) } else { DiffPart::Settings };
        let percent = percent(a, b);
        let counts = !are_results
            || match part {
                DiffPart::Settings => false,
                DiffPart::Hashes => tolerance == 0.0,
                _ => true,
            };
        let is_within = !counts || percent.is_some_and(|percent| percent.abs() <= tolerance);
        Some(KeyDifference { key: (*key).clone(), part, a: a.clone(), b: b.clone(), percent, is_within })
    };
    let mut differences: Vec<KeyDifference> = keys.iter().filter_map(difference).collect();
    differences.sort_by(|one, other| (one.part, &one.key).cmp(&(other.part, &other.key)));
    DiffResult {
        schema: SCHEMA,
        a: a.name.clone(),
        b: b.name.clone(),
        tolerance,
        is_within: differences.iter().all(|difference| difference.is_within),
        compared: keys.len(),
        differences,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn difference(a: &Value, b: &Value, tolerance: f64) -> DiffResult {
        compare(&DiffSide { name: "a".into(), value: a }, &DiffSide { name: "b".into(), value: b }, tolerance)
    }

    #[test]
    fn numbers_differ_in_per_cent_and_lists_by_name() {
        let a = json!({ "schema": "s", "clocks": 200, "functions": [{ "name": "f", "calls": 1 }, { "name": "g", "calls": 4 }],
            "settings": { "word": 32 }, "error": { "psnr_db": 0 }, "image_hash": "1", "host": { "run_seconds": 1 } });
        let b = json!({ "schema": "s", "clocks": 210, "functions": [{ "name": "g", "calls": 3 }, { "name": "f", "calls": 1 }],
            "settings": { "word": 24 }, "error": { "psnr_db": 1 }, "image_hash": "2", "host": { "run_seconds": 9 } });
        let found = difference(&a, &b, 25.0);
        let rows: Vec<(&str, DiffPart, Option<f64>, bool)> =
            found.differences.iter().map(|d| (d.key.as_str(), d.part, d.percent, d.is_within)).collect();
        assert_eq!(
            rows,
            [
                ("settings.word", DiffPart::Settings, Some(-25.0), true),
                ("functions[g].calls", DiffPart::Counts, Some(-25.0), true),
                ("clocks", DiffPart::Clocks, Some(5.0), true),
                ("error.psnr_db", DiffPart::Error, None, false),
                ("image_hash", DiffPart::Hashes, None, true),
            ]
        );
        assert!(!found.is_within);
        // Without a tolerance every result counts, and settings still do not.
        let within: Vec<bool> = difference(&a, &b, 0.0).differences.iter().map(|d| d.is_within).collect();
        assert_eq!(within, [true, false, false, false, false]);
        assert!(difference(&a, &a, 0.0).differences.is_empty() && difference(&a, &a, 0.0).is_within);
    }

    #[test]
    fn of_two_files_of_settings_everything_counts() {
        let (a, b) = (json!({ "cores": 4, "bus": { "arbiter": "tdma" } }), json!({ "cores": 5, "bus": {} }));
        let found = difference(&a, &b, 30.0);
        assert_eq!(found.differences.iter().map(|d| d.is_within).collect::<Vec<_>>(), [false, true]);
        assert_eq!(found.differences[0].b, Value::Null);
    }
}
