//! `lancer schema`: JSON Schemas of the results, made from the types that are printed, so that no key is without one.

use clap::Args;
use clap::builder::PossibleValuesParser;
use scenes::info::{self, SceneInfo};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde_json::Value;

use super::accuracy::{self, AccuracyResults};
use super::arithmetic::{self, CheckedFile};
use super::bench::{self, Benches};
use super::run_result::{self, RunResult};
use super::stress::{self, Catalogue};
use crate::annex;
use crate::annex::result::Annexes;
use crate::cores::{self, CoresResult};
use crate::extension::{self, ExtensionResult};
use crate::failure::{Exit, Failure};
use crate::profiles::{self, Profiles};
use crate::result::{self, Render};
use crate::skips::{self, SkipsResult};
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer schema                     the results that have one, and which command prints them
  lancer schema lancer-render-1     the keys of lancer render --json";

/// Prints what the keys of --json mean, as JSON Schema (draft 2020-12).
///
/// The key `schema` of each result names its schema. docs/schemas holds the same files.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SchemaArguments {
    /// Name of the schema; without one, all are listed.
    #[arg(value_name = "NAME", value_parser = PossibleValuesParser::new(SCHEMAS.iter().map(|known| known.name)))]
    name: Option<String>,
}

/// A schema, by the name that is the value of the key `schema`.
struct Known {
    name: &'static str,
    command: &'static str,
    make: fn() -> Schema,
}

const SCHEMAS: &[Known] = &[
    Known { name: annex::result::SCHEMA, command: "lancer annex --json", make: schema_of::<Annexes> },
    Known { name: result::SCHEMA, command: "lancer render --json", make: schema_of::<Render> },
    Known { name: run_result::SCHEMA, command: "lancer run --json", make: schema_of::<RunResult> },
    Known { name: cores::SCHEMA, command: "lancer cores --json", make: schema_of::<CoresResult> },
    Known { name: profiles::SCHEMA, command: "lancer profiles --json", make: schema_of::<Profiles> },
    Known { name: skips::SCHEMA, command: "lancer skips --json", make: schema_of::<SkipsResult> },
    Known { name: info::SCHEMA, command: "lancer scene info --json", make: schema_of::<SceneInfo> },
    Known { name: accuracy::SCHEMA, command: "lancer accuracy --json", make: schema_of::<AccuracyResults> },
    Known { name: stress::SCHEMA, command: "lancer stress --json", make: schema_of::<Catalogue> },
    Known { name: extension::SCHEMA, command: "lancer extension compare --json", make: schema_of::<ExtensionResult> },
    Known {
        name: extension::SUGGESTION_SCHEMA,
        command: "lancer extension suggest --json",
        make: schema_of::<extension::SuggestionResult>,
    },
    Known { name: bench::SCHEMA, command: "lancer bench --json", make: schema_of::<Benches> },
    Known { name: arithmetic::SCHEMA, command: "lancer arithmetic check --json", make: schema_of::<CheckedFile> },
];

fn schema_of<T: JsonSchema>() -> Schema {
    SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<T>()
}

/// Prints one schema, or the list.
pub(super) fn execute(arguments: &SchemaArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let Some(name) = &arguments.name else {
        let lines: Vec<String> = SCHEMAS.iter().map(|known| format!("{:<20}{}\n", known.name, known.command)).collect();
        terminal.print(&lines.concat())?;
        return Ok(Exit::Done);
    };
    let known = SCHEMAS.iter().find(|known| known.name == name).expect("the parser lets only names pass");
    let mut schema = (known.make)().to_value();
    schema["title"] = known.name.into();
    in_words_of_json(&mut schema);
    terminal.print(&result::json(&schema))?;
    Ok(Exit::Done)
}

/// Descriptions come from the documentation in Rust: links lose their brackets, `None` is null.
fn in_words_of_json(value: &mut Value) {
    match value {
        Value::Object(keys) => keys.iter_mut().for_each(|(key, value)| match value {
            Value::String(text) if key == "description" => {
                *text = text.replace("[`", "`").replace("`]", "`").replace("`None`", "null");
            }
            other => in_words_of_json(other),
        }),
        Value::Array(items) => items.iter_mut().for_each(in_words_of_json),
        _ => {}
    }
}
