//! `lancer schema`: JSON Schemas of the results, made from the types that are printed, so that no key is without one.

use clap::Args;
use clap::builder::PossibleValuesParser;
use scenes::info::{self, SceneInfo};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde_json::Value;

use super::accuracy::{self, AccuracyResults};
use super::arithmetic::{self, CheckedFile};
use super::assemble_result::{self, AssembledProgram};
use super::bench::{self, Benches};
use super::cores::CoresSettings;
use super::extension::compare::CompareSettings;
use super::extension::suggest::SuggestSettings;
use super::inject::InjectSettings;
use super::invocation::CommandSettings;
use super::machine::{self, MachineResult};
use super::run_result::{self, RunResult};
use super::scene::{self, WrittenScene};
use super::stress::{self, Catalogue};
use super::trace::{self, TraceResult};
use crate::advise::{self, AdviceResult};
use crate::annex;
use crate::annex::as_printed::{self, ErratumResult};
use crate::annex::result::Annexes;
use crate::cores::{self, CoresResult};
use crate::difference::{self, DiffResult};
use crate::extension::{self, ExtensionResult};
use crate::failure::{Exit, Failure};
use crate::formats::{self, FormatsResult};
use crate::inject;
use crate::inject::result::InjectResult;
use crate::inject::row::{self, InjectionResult};
use crate::message::{self, JsonMessage};
use crate::pixel::{self, PixelExplanation};
use crate::profiles::{self, Profiles};
use crate::result::{self, Render, WithSettings};
use crate::servers::{self, ServersResult};
use crate::settings::Settings;
use crate::skips::{self, SkipsResult};
use crate::terminal::Terminal;
use crate::trace::instruction::{self, TracedInstruction};

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
    Known { name: annex::result::SCHEMA, command: "lancer annex --json", make: printed::<Annexes, CommandSettings> },
    Known {
        name: as_printed::SCHEMA,
        command: "lancer annex --as-printed --json",
        make: printed::<ErratumResult, CommandSettings>,
    },
    Known { name: result::SCHEMA, command: "lancer render --json", make: schema_of::<Render> },
    Known { name: run_result::SCHEMA, command: "lancer run --json", make: printed::<RunResult, CommandSettings> },
    Known { name: instruction::SCHEMA, command: "lancer run --trace FILE.jsonl", make: schema_of::<TracedInstruction> },
    Known { name: cores::SCHEMA, command: "lancer cores --json", make: printed::<CoresResult, CoresSettings> },
    Known { name: servers::SCHEMA, command: "lancer servers --json", make: printed::<ServersResult, CommandSettings> },
    Known { name: advise::SCHEMA, command: "lancer advise --json", make: printed::<AdviceResult, Settings> },
    Known { name: profiles::SCHEMA, command: "lancer profiles --json", make: printed::<Profiles, CommandSettings> },
    Known { name: skips::SCHEMA, command: "lancer skips --json", make: printed::<SkipsResult, Settings> },
    Known { name: info::SCHEMA, command: "lancer scene info --json", make: printed::<SceneInfo, CommandSettings> },
    Known {
        name: accuracy::SCHEMA,
        command: "lancer accuracy --json",
        make: printed::<AccuracyResults, CommandSettings>,
    },
    Known { name: formats::SCHEMA, command: "lancer formats --json", make: printed::<FormatsResult, CommandSettings> },
    Known { name: inject::SCHEMA, command: "lancer inject --json", make: printed::<InjectResult, InjectSettings> },
    Known {
        name: row::ROW_SCHEMA,
        command: "lancer inject --number N --json",
        make: printed::<InjectionResult, InjectSettings>,
    },
    Known { name: stress::SCHEMA, command: "lancer stress --json", make: printed::<Catalogue, CommandSettings> },
    Known {
        name: extension::SCHEMA,
        command: "lancer extension compare --json",
        make: printed::<ExtensionResult, CompareSettings>,
    },
    Known {
        name: extension::SUGGESTION_SCHEMA,
        command: "lancer extension suggest --json",
        make: printed::<extension::SuggestionResult, SuggestSettings>,
    },
    Known { name: bench::SCHEMA, command: "lancer bench --json", make: printed::<Benches, CommandSettings> },
    Known {
        name: arithmetic::SCHEMA,
        command: "lancer arithmetic check --json",
        make: printed::<CheckedFile, CommandSettings>,
    },
    Known {
        name: assemble_result::SCHEMA,
        command: "lancer assemble --json",
        make: printed::<AssembledProgram, CommandSettings>,
    },
    Known { name: machine::SCHEMA, command: "lancer machine --json", make: printed::<MachineResult, CommandSettings> },
    Known {
        name: scene::SCHEMA,
        command: "lancer scene generate --json, lancer scene convert --json",
        make: printed::<WrittenScene, CommandSettings>,
    },
    Known { name: trace::SCHEMA, command: "lancer trace --json", make: printed::<TraceResult, Settings> },
    Known { name: pixel::SCHEMA, command: "lancer explain-pixel --json", make: printed::<PixelExplanation, Settings> },
    Known { name: difference::SCHEMA, command: "lancer diff --json", make: schema_of::<DiffResult> },
    Known { name: message::SCHEMA, command: "--message-format json, a line each", make: schema_of::<JsonMessage> },
];

/// Schema of a result as commands print it, with version and settings.
fn printed<R: JsonSchema, S: JsonSchema>() -> Schema {
    let mut schema = schema_of::<WithSettings<R, S>>();
    let description = schema_of::<R>().get("description").cloned().unwrap_or_default();
    schema.insert("description".to_owned(), description);
    schema
}

fn schema_of<T: JsonSchema>() -> Schema {
    SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<T>()
}

/// Prints one schema, or the list.
pub(super) fn execute(arguments: &SchemaArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let Some(name) = &arguments.name else {
        let lines: Vec<String> = SCHEMAS.iter().map(|known| format!("{:<24}{}\n", known.name, known.command)).collect();
        terminal.tell(&lines.concat())?;
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
