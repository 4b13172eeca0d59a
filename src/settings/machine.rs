//! The machine in settings: every key of a machine file, with the machine's name before them.

use std::borrow::Cow;

use emu::machine::Config;
use emu::machine::preset::PRESETS;
use messages::Report;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Map, Value};

use super::key::leaves;
use crate::machine;

/// Key of the machine's name, which no machine file has.
pub const NAME: &str = "name";

/// Key that says which machine the others change; settings that are written have all keys instead.
pub const FROM: &str = "from";

/// A machine with the name that results show.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineSettings {
    /// Name of the preset, or of the file without its ending.
    pub name: String,
    /// Every key.
    pub config: Config,
}

impl Default for MachineSettings {
    fn default() -> MachineSettings {
        MachineSettings { name: machine::DEFAULT.to_owned(), config: Config::default() }
    }
}

impl MachineSettings {
    /// The machine of a preset's name, a file, or settings in braces.
    ///
    /// # Errors
    /// See [`machine::find`].
    pub fn find(name: &str) -> Result<MachineSettings, Report> {
        machine::find(name).map(|(name, config)| MachineSettings { name, config })
    }

    /// The machine as a person writes it: the name of a preset, or an object with the keys that differ from a preset's, which is that of the
    /// machine's name where there is one.
    pub fn brief(&self) -> Value {
        let named = |name: &str| PRESETS.iter().find(|preset| preset.name == name);
        let preset = named(&self.name).or_else(|| named(machine::DEFAULT)).expect("the default is a preset");
        let before = MachineSettings { name: preset.name.to_owned(), config: preset.config() };
        let [now, before] = [self, &before].map(|one| serde_json::to_value(one).expect("a machine has string keys"));
        let mut brief = Value::Object(Map::new());
        for ((key, value), _) in leaves(&now).into_iter().zip(leaves(&before)).filter(|(now, before)| now != before) {
            *key.split('.').fold(&mut brief, |brief, name| &mut brief[name]) = value.clone();
        }
        match brief.as_object_mut() {
            Some(keys) if !keys.is_empty() => {
                keys.insert(FROM.to_owned(), preset.name.into());
                brief
            }
            _ => preset.name.into(),
        }
    }
}

/// Keys in the order of a machine file.
#[derive(Serialize)]
struct Keys<'a> {
    name: &'a str,
    #[serde(flatten)]
    config: &'a Config,
}

impl Serialize for MachineSettings {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Keys { name: &self.name, config: &self.config }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for MachineSettings {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<MachineSettings, D::Error> {
        let mut keys = Map::deserialize(deserializer)?;
        let name = match keys.remove(NAME) {
            None => machine::DEFAULT.to_owned(),
            Some(name) => String::deserialize(name).map_err(D::Error::custom)?,
        };
        Ok(MachineSettings { name, config: Config::deserialize(Value::Object(keys)).map_err(D::Error::custom)? })
    }
}

impl JsonSchema for MachineSettings {
    fn schema_name() -> Cow<'static, str> {
        "MachineSettings".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let keys = serde_json::to_value(MachineSettings::default()).expect("a machine has string keys");
        let mut schema = Schema::try_from(like(&keys, "")).unwrap_or_else(|_| json_schema!({}));
        schema.insert(
            "description".to_owned(),
            "Every key of a machine file, which `lancer machine` describes, and the machine's name.".into(),
        );
        schema
    }
}

/// A schema for values with the keys and types of an example, which stands at a key of a machine file.
fn like(example: &Value, key: &str) -> Value {
    let mut schema = match example {
        Value::Object(keys) => {
            let below = |name: &str| if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
            let properties: Map<String, Value> =
                keys.iter().map(|(name, value)| (name.clone(), like(value, &below(name)))).collect();
            let required: Vec<&String> = keys.keys().collect();
            serde_json::json!({ "type": "object", "properties": properties, "required": required })
        }
        // The one list of a machine is that of the arbiter's weights.
        Value::Array(_) => serde_json::json!({ "type": "array", "items": { "type": "integer", "minimum": 0 } }),
        Value::Bool(_) => serde_json::json!({ "type": "boolean" }),
        // Clocks and units may be laws of the word's bits.
        Value::Number(_) if key.starts_with("clocks.") || key.starts_with("units.") => {
            serde_json::json!({ "type": ["integer", "string"] })
        }
        Value::Number(_) => serde_json::json!({ "type": "integer", "minimum": 0 }),
        _ => serde_json::json!({ "type": "string" }),
    };
    let name = || (key == NAME).then(|| "Name of the preset, or of the file without its ending.".to_owned());
    if let Some(text) = machine::comment(key).or_else(name) {
        schema["description"] = text.into();
    }
    schema
}

#[cfg(test)]
mod tests {
    use crate::settings::apply::put;

    use super::*;

    #[test]
    fn a_machine_in_settings_reads_back_as_itself() {
        for preset in PRESETS {
            let machine = MachineSettings::find(preset.name).unwrap();
            let text = serde_json::to_string(&machine).unwrap();
            assert_eq!(serde_json::from_str::<MachineSettings>(&text).unwrap(), machine);
            assert_eq!(MachineSettings::find(&text).unwrap(), machine);
        }
    }

    #[test]
    fn a_machine_in_brief_is_that_machine() {
        let of = |name: &str, change: fn(&mut Config)| {
            let mut machine = MachineSettings::find(name).unwrap();
            change(&mut machine.config);
            machine
        };
        let mine = MachineSettings { name: "mine".to_owned(), ..of("report", |_| ()) };
        for (machine, brief) in [
            (of("wide32", |_| ()), serde_json::json!("wide32")),
            (of("report", |config| config.cores = 7), serde_json::json!({ "from": "report", "cores": 7 })),
            (
                of("wide32", |config| (config.bus.overlap, config.bus.weights) = (true, vec![2, 1])),
                serde_json::json!({ "from": "wide32", "bus": { "overlap": true, "weights": [2, 1] } }),
            ),
            (mine, serde_json::json!({ "from": "report", "name": "mine" })),
        ] {
            assert_eq!(machine.brief(), brief);
            let mut settings = crate::settings::Settings::default().value();
            put(&mut settings, "machine", brief).unwrap();
            assert_eq!(crate::settings::Settings::of_value(&settings).unwrap().machine, machine);
        }
    }
}
