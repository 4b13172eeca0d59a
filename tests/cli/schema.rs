//! JSON results keep to their schemas, and each key of them is described.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::help::commands;
use super::session::Session;

/// Set to write the schemas to `docs/schemas` as they are now.
const BLESS: &str = "LANCER_BLESS";

/// A command line for each command that prints JSON, and the schema of what it prints.
const RESULTS: &[(&str, &str)] = &[
    ("annex triangle --size 8x6", "lancer-annex-1"),
    ("annex --as-printed first-hit --size 8x6", "lancer-erratum-1"),
    ("annex --as-printed servers", "lancer-erratum-1"),
    ("render cornell --size 8x6 --shift 0.137,0.071 --timing", "lancer-render-1"),
    ("render triangle --size 4x4 --no-error --crop 1,1,2,2", "lancer-render-1"),
    ("render empty --size 4x4", "lancer-render-1"),
    ("run sum.s --dump 0:4 --dump regs --reg v2=1:2:3", "lancer-run-1"),
    ("run sum.s --show s1:4,v2:16 --reg s2=1.5:16,s3=0x10", "lancer-run-1"),
    ("run sum.s --trace - --window steps=0 --reg s2=3,s3=5", "lancer-instruction-1"),
    ("trace triangle --size 4x4 --pixel 2,2 --instructions - --window steps=0", "lancer-instruction-1"),
    ("cores annex --cores 4", "lancer-cores-1"),
    ("cores triangle --size 4x4 --cores 1,2 --machine node_cache", "lancer-cores-1"),
    ("servers triangle --size 4x4 --servers 2", "lancer-servers-1"),
    ("advise triangle --size 4x4", "lancer-advise-1"),
    ("profiles triangle --size 4x4", "lancer-profiles-1"),
    ("skips triangle --size 4x4", "lancer-skips-1"),
    ("scene info cornell", "lancer-scene-1"),
    ("scene info empty", "lancer-scene-1"),
    ("accuracy triangle --size 4x3 --words 32,8 --timing", "lancer-accuracy-1"),
    ("formats triangle --size 4x3 --shifts 1 --check triangle", "lancer-formats-1"),
    ("stress --case normalising", "lancer-stress-1"),
    ("inject triangle --size 4x3 --injections 40", "lancer-inject-2"),
    ("inject triangle --size 4x3 --kind memory --number 3", "lancer-injection-2"),
    (
        concat!(
            "extension compare ",
            env!("CARGO_MANIFEST_DIR"),
            "/extensions/fma/fma.isa --scene triangle --size 4x3 --kernel surface=",
            env!("CARGO_MANIFEST_DIR"),
            "/extensions/fma/surface.s",
        ),
        "lancer-extension-1",
    ),
    ("extension suggest cornell --size 4x3", "lancer-suggestion-1"),
    ("extension suggest empty --size 4x3", "lancer-suggestion-1"),
    ("bench triangle --size 4x3 --runs 1", "lancer-bench-2"),
    ("arithmetic check vectors.csv", "lancer-arithmetic-1"),
    ("assemble sum.s -o sum.o", "lancer-assemble-1"),
    ("machine node_cache", "lancer-machine-1"),
    ("scene generate triangle", "lancer-written-scene-1"),
    ("scene convert triangle t.obj --dsc", "lancer-written-scene-1"),
    ("trace triangle --size 4x4 --clocks 0..100", "lancer-trace-1"),
    ("explain-pixel slabs 2,1 --size 4x3", "lancer-pixel-1"),
    ("explain-pixel empty 2,1 --size 4x3 --profile report", "lancer-pixel-1"),
    ("diff m.toml m.toml", "lancer-diff-1"),
];

/// A conversion of 300/256, which is rounded to 19/16.
const VECTOR: &str = "cvt,s,16,8,300,-,-,-,-,-,-,-,-,s,8,4,RND_CONV,WRAP,1,19,1,0";

pub fn schema(session: &Session, name: &str) -> Value {
    serde_json::from_str(&session.succeed(&format!("schema {name}"))).unwrap()
}

fn names(session: &Session) -> Vec<String> {
    let list = session.succeed("schema");
    list.lines().map(|line| line.split_whitespace().next().unwrap().to_owned()).collect()
}

fn session() -> Session {
    let session = Session::new();
    session.write("sum.s", ".func f\n    imul s1, s2, s3\n.endfunc\n    halt\n");
    session.write("half.isa", ".extension half\n.instr half (d: S, a: S) \"custom0 ddddd aaaaa ----------------\" [Done(body)]\n    srai d, a, 1\n.end\n");
    session.write("m.toml", "cores = 4\n");
    session.write("trap.s", "    trap 7\n");
    session.write("vectors.csv", &format!("{}\n{VECTOR}\n", conformance::HEADER));
    session
}

/// Faults of a value, by a schema's part of a root. Knows the keywords that occur; any other is a mistake.
pub fn wrong(root: &Value, part: &Value, value: &Value, path: &str) -> Vec<String> {
    let mut found = Vec::new();
    if part.as_bool() == Some(true) {
        return found;
    }
    for (keyword, argument) in part.as_object().unwrap_or_else(|| panic!("{path}: {part} is no schema")) {
        match keyword.as_str() {
            "$schema" | "title" | "description" | "$defs" | "format" | "default" => {}
            "$ref" => {
                let name = argument.as_str().unwrap().strip_prefix("#/$defs/").unwrap();
                found.extend(wrong(root, &root["$defs"][name], value, path));
            }
            "type" => {
                let is = |name: &Value| match name.as_str().unwrap() {
                    "object" => value.is_object(),
                    "array" => value.is_array(),
                    "string" => value.is_string(),
                    "boolean" => value.is_boolean(),
                    "null" => value.is_null(),
                    "number" => value.is_number(),
                    "integer" => value.is_u64() || value.is_i64(),
                    other => panic!("{path}: the type {other} is not known here"),
                };
                let names = argument.as_array().cloned().unwrap_or_else(|| vec![argument.clone()]);
                if !names.iter().any(is) {
                    found.push(format!("{path}: {value} is not of type {argument}"));
                }
            }
            "const" if value != argument => found.push(format!("{path}: {value} is not {argument}")),
            "minimum" if value.is_number() && value.as_f64() < argument.as_f64() => {
                found.push(format!("{path}: {value} is too small"))
            }
            "maximum" if value.is_number() && value.as_f64() > argument.as_f64() => {
                found.push(format!("{path}: {value} is too large"))
            }
            "minItems" if value.as_array().is_some_and(|items| (items.len() as u64) < argument.as_u64().unwrap()) => {
                found.push(format!("{path}: {value} has too few items"));
            }
            "maxItems" if value.as_array().is_some_and(|items| items.len() as u64 > argument.as_u64().unwrap()) => {
                found.push(format!("{path}: {value} has too many items"));
            }
            "const" | "minimum" | "maximum" | "minItems" | "maxItems" => {}
            "enum" if !argument.as_array().unwrap().contains(value) => {
                found.push(format!("{path}: {value} is none of {argument}"));
            }
            "enum" => {}
            "anyOf" | "oneOf" => {
                if !argument.as_array().unwrap().iter().any(|one| wrong(root, one, value, path).is_empty()) {
                    found.push(format!("{path}: {value} is none of {argument}"));
                }
            }
            "required" => {
                let keys = argument.as_array().unwrap().iter().map(|key| key.as_str().unwrap());
                let missing = keys.filter(|key| value.is_object() && value.get(key).is_none());
                found.extend(missing.map(|key| format!("{path}: `{key}` is missing")));
            }
            "items" => {
                for item in value.as_array().into_iter().flatten() {
                    found.extend(wrong(root, argument, item, &format!("{path}[]")));
                }
            }
            // Stricter than the standard: a key that the schema does not list is wrong.
            "properties" => {
                for (key, value) in value.as_object().into_iter().flatten() {
                    match argument.get(key) {
                        Some(part) => found.extend(wrong(root, part, value, &format!("{path}.{key}"))),
                        None => found.push(format!("{path}: nothing is said about `{key}`")),
                    }
                }
            }
            // `properties` is stricter here.
            "additionalProperties" if *argument == Value::Bool(false) => {}
            "additionalProperties" => {
                for (key, value) in value.as_object().into_iter().flatten() {
                    found.extend(wrong(root, argument, value, &format!("{path}.{key}")));
                }
            }
            other => panic!("{path}: the keyword {other} is not known here"),
        }
    }
    found
}

#[test]
fn results_keep_to_their_schemas() {
    let session = session();
    for (arguments, name) in RESULTS {
        let (schema, result) = (schema(&session, name), session.json(arguments));
        assert_eq!(wrong(&schema, &schema, &result, name), Vec::<String>::new(), "{arguments}");
        assert_eq!(result["schema"], *name);
    }
    let run = session.run("run trap.s --json");
    let (schema, result) = (schema(&session, "lancer-run-1"), serde_json::from_str(&run.out).unwrap());
    assert_eq!(wrong(&schema, &schema, &result, "trap"), Vec::<String>::new());
    assert!(result["trap"]["pc"].is_u64());
}

#[test]
fn other_results_do_not() {
    let session = session();
    let (schema, result) = (schema(&session, "lancer-scene-1"), session.json("scene info triangle"));
    let spoilt = |change: &dyn Fn(&mut Value)| {
        let mut other = result.clone();
        change(&mut other);
        wrong(&schema, &schema, &other, "scene")
    };
    assert!(spoilt(&|_| ()).is_empty());
    for change in [
        &|scene: &mut Value| scene["triangles"] = json!(-1),
        &|scene: &mut Value| scene["triangles"] = json!("1"),
        &|scene: &mut Value| scene["schema"] = json!("lancer-scene-2"),
        &|scene: &mut Value| scene["bounds"][1] = json!([0.5, 1.0]),
        &|scene: &mut Value| scene["extra"] = json!(0),
        &|scene: &mut Value| scene["tree"]["leaves"] = json!(0.5),
        &|scene: &mut Value| scene["memory"]["octets"]["nodes"] = Value::Null,
        &|scene: &mut Value| drop(scene.as_object_mut().unwrap().remove("vertices")),
    ] as [&dyn Fn(&mut Value); 8]
    {
        assert_eq!(spoilt(change).len(), 1, "{:?}", spoilt(change));
    }
}

#[test]
fn each_command_with_json_has_a_schema() {
    let session = session();
    let names = names(&session);
    for command in commands(&session, "") {
        let command = command.trim();
        let help = session.succeed(&format!("{command} --help"));
        if help.lines().any(|line| line.trim_start().starts_with("--json")) {
            let listed = RESULTS.iter().find(|(arguments, _)| arguments.starts_with(command));
            let (_, name) = listed.unwrap_or_else(|| panic!("`lancer {command} --json` is in no test of schemas"));
            assert!(names.contains(&(*name).to_owned()), "{command}");
        }
    }
}

/// Keys without a description, with their paths.
fn undescribed(part: &Value, path: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (key, property) in part["properties"].as_object().into_iter().flatten() {
        let path = format!("{path}.{key}");
        if property["description"].as_str().is_none_or(|text| text.len() < 4) {
            found.push(path.clone());
        }
        found.extend(undescribed(property, &path));
    }
    for (name, part) in part["$defs"].as_object().into_iter().flatten() {
        found.extend(undescribed(part, name));
    }
    found
}

#[test]
fn each_key_is_described_and_the_documents_are_not_stale() {
    let session = session();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let overview = std::fs::read_to_string(folder.join("schemas.md")).unwrap();
    let names = names(&session);
    for name in &names {
        let schema = schema(&session, name);
        assert_eq!(undescribed(&schema, name), Vec::<String>::new());
        let text = session.succeed(&format!("schema {name}"));
        assert!(!text.contains("[`") && !text.contains("`None`"), "{name} speaks of Rust");
        let path: PathBuf = folder.join(format!("schemas/{name}.json"));
        if std::env::var_os(BLESS).is_some_and(|value| value != "0") {
            std::fs::write(&path, &text).unwrap();
        }
        let written = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(written == text, "{} is stale: {BLESS}=1 cargo test -p lancer schema", path.display());
        assert!(overview.contains(&format!("](schemas/{name}.json)")), "docs/schemas.md does not name {name}");
    }
    let files = std::fs::read_dir(folder.join("schemas")).unwrap().count();
    assert_eq!(files, names.len(), "files of schemas that are no more");
}
