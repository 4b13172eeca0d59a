//! Settings from a file: TOML, settings as JSON, or any result that carries them. All mistakes of a file are named at once.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use messages::{Diagnostic, Place, Report, Source};
use serde_json::{Map, Value};
use toml::de::{DeTable, DeValue};

use super::Settings;
use super::apply::put;
use super::key;
use crate::files;

/// Key by which settings of a command that draws no picture by itself name the command.
pub const COMMAND: &str = "command";

/// Settings as they stand in a file; keys may be missing.
#[derive(Clone, Debug)]
pub struct StoredSettings {
    /// The keys.
    pub keys: Map<String, Value>,
    source: Arc<Source>,
    is_toml: bool,
}

/// Reads settings from a TOML file, or from JSON: the object `settings` of a result, or the settings alone.
///
/// # Errors
/// A file that is neither, and a result without settings.
pub fn read(path: &Path) -> Result<StoredSettings, Report> {
    let source = files::source(path)?;
    parse(&source)
}

/// Settings in a text; see [`read`].
///
/// # Errors
/// See [`read`].
pub fn parse(source: &Arc<Source>) -> Result<StoredSettings, Report> {
    let is_toml = !source.text.trim_start().starts_with('{');
    let mut keys = if is_toml { toml(source)? } else { json(source)? };
    match keys.remove("settings") {
        Some(Value::Object(inner)) => keys = inner,
        Some(_) => return Err(Diagnostic::error(format!("`settings` of {} is no object", source.name)).into()),
        None if keys.contains_key("schema") => {
            let message = Diagnostic::error(format!("{} is a result without settings", source.name));
            return Err(message.hint("an older version has written it: give its options again").into());
        }
        None => {}
    }
    Ok(StoredSettings { keys, source: source.clone(), is_toml })
}

fn json(source: &Arc<Source>) -> Result<Map<String, Value>, Report> {
    serde_json::from_str(&source.text).map_err(|error| {
        let message = Diagnostic::error(format!("{} is no JSON object: {error}", source.name));
        let line = source.text.lines().take(error.line().saturating_sub(1)).map(|line| line.len() + 1).sum::<usize>();
        let at = (line + error.column().saturating_sub(1)).min(source.text.len());
        message.at(Place::new(source, at..at), "").into()
    })
}

/// Octets of a TOML text, at most: its tables take up to seventy times as many. The longest lists of a study are ranges, which are short.
const LARGEST_TOML: usize = 2 << 20;

/// Check that a TOML text is not too large to be read.
///
/// # Errors
/// A text of more than 2 MiB.
pub fn check_toml_size(source: &Source) -> Result<(), Report> {
    if source.text.len() <= LARGEST_TOML {
        return Ok(());
    }
    let message = Diagnostic::error(format!("{} is larger than {} MiB", source.name, LARGEST_TOML >> 20));
    Err(message.hint("that is the most for TOML; results as JSON may be larger").into())
}

/// The tables of a TOML text.
///
/// # Errors
/// A text that is no TOML, or too large.
pub fn toml(source: &Arc<Source>) -> Result<Map<String, Value>, Report> {
    check_toml_size(source)?;
    toml::from_str(&source.text).map_err(|error| {
        let message = Diagnostic::error(error.message().lines().next().unwrap_or_default().to_owned());
        match error.span() {
            Some(span) => message.at(Place::new(source, span), ""),
            None => message,
        }
        .into()
    })
}

impl StoredSettings {
    /// Default settings with the keys of the file.
    ///
    /// # Errors
    /// All keys that do not exist and all values that are none of their keys', each with its place in TOML.
    pub fn settings(&self) -> Result<Settings, Report> {
        if let Some(command) = self.keys.get(COMMAND) {
            let message = format!("{} has the settings of another command: {command}", self.source.name);
            return Err(Diagnostic::error(message).into());
        }
        let (defaults, mut messages) = (Settings::default().value(), Vec::new());
        let mut whole = defaults.clone();
        let keys = Value::Object(self.keys.clone());
        // The machine that others change comes before them.
        let (first, rest): (Vec<_>, Vec<_>) =
            key::leaves(&keys).into_iter().partition(|(key, _)| ["machine", "machine.from"].contains(&key.as_str()));
        for (key, value) in first.into_iter().chain(rest) {
            let result = match key::is_known(&key) {
                true => put(&mut whole, &key, value.clone()).and_then(|()| self.alone(&defaults, &key, value)),
                false => Err(key::resolve(&key).err().unwrap_or_else(|| unknown(&key).into())),
            };
            if let Err(report) = result {
                messages.extend(report.0.into_iter().map(|message| self.placed(message, &key)));
            }
        }
        if !messages.is_empty() {
            return Err(Report(messages));
        }
        let settings = Settings::of_value(&whole)?;
        // Ranges that depend on several keys.
        settings.check()?;
        Ok(settings)
    }

    /// Check of one key by itself, so that each mistake has its place.
    fn alone(&self, defaults: &Value, key: &str, value: &Value) -> Result<(), Report> {
        let mut one = defaults.clone();
        put(&mut one, key, value.clone())?;
        let blamed = |message: Diagnostic| Diagnostic { message: format!("`{key}`: {}", message.message), ..message };
        Settings::of_value(&one).map(|_| ()).map_err(|report| Report(report.0.into_iter().map(blamed).collect()))
    }

    fn placed(&self, message: Diagnostic, key: &str) -> Diagnostic {
        match self.is_toml.then(|| span(&self.source.text, key)).flatten() {
            Some(span) if message.place.is_none() => message.at(Place::new(&self.source, span), ""),
            _ => message,
        }
    }
}

/// A key whose short form is known; files write keys in full, so that they mean the same in every version.
fn unknown(key: &str) -> Diagnostic {
    let hint = key::resolve(key).map(|full| messages::question(&full)).unwrap_or_default();
    Diagnostic::error(format!("`{key}` is no key of the settings")).hint(hint)
}

/// Place of a key in a TOML text.
pub fn span(text: &str, key: &str) -> Option<Range<usize>> {
    let document = DeTable::parse(text).ok()?;
    let mut table = document.get_ref();
    let mut found = None;
    for part in key.split('.') {
        let Some((name, value)) = table.iter().find(|(name, _)| name.get_ref() == part) else { break };
        found = Some(name.span());
        match value.get_ref() {
            DeValue::Table(inner) => table = inner,
            _ => break,
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(text: &str) -> Result<Settings, String> {
        let stored = parse(&Source::new("s.toml", text)).map_err(|report| report.render(false))?;
        stored.settings().map_err(|report| report.render(false))
    }

    #[test]
    fn what_a_file_leaves_out_has_its_default() {
        assert_eq!(settings(""), Ok(Settings::default()));
        let read =
            settings("scene = \"slabs\"\n[machine]\nfrom = \"wide32\"\ncores = 2\n[view]\nshift = [0, 1]\n").unwrap();
        assert_eq!((read.scene.name.as_str(), read.view.shift), ("slabs", [0.0, 1.0]));
        assert_eq!((read.machine.name.as_str(), read.machine.config.cores), ("wide32", 2));
        assert_eq!(settings("machine = \"wide32\"").unwrap().machine.name, "wide32");
    }

    #[test]
    fn settings_read_back_as_themselves() {
        let wanted = settings("scene = \"slabs\"\nmachine = \"node_cache\"\n[effort]\nskips = []\n").unwrap();
        for text in [
            serde_json::to_string(&wanted).unwrap(),
            serde_json::json!({ "schema": "x", "settings": wanted }).to_string(),
            toml::to_string(&wanted).unwrap(),
        ] {
            assert_eq!(settings(&text), Ok(wanted.clone()), "{text}");
        }
    }

    #[test]
    fn all_mistakes_are_named_at_once_with_their_places() {
        let text = "[view]\nsize = [1, 2]\nshft = [0, 0]\n[machine]\ncores = \"four\"\n[kernels]\nprofile = \"rai\"\n";
        let shown = settings(text).expect_err("nothing is right");
        for part in ["s.toml:3:1", "did you mean `view.shift`?", "s.toml:5:1", "s.toml:7:1", "did you mean `ray`?"] {
            assert!(shown.contains(part), "{part}\n{shown}");
        }
        for (text, part) in [
            ("{\"schema\": \"lancer-render-1\"}", "a result without settings"),
            ("{\"a\": ", "is no JSON object"),
            ("a = ", "s.toml:1"),
            ("command = \"bench\"", "another command"),
            ("{\"machine\": {\"cores\": 999}}", "must lie in 1..=256"),
        ] {
            let shown = settings(text).expect_err(text);
            assert!(shown.contains(part), "{text}: {shown}");
        }
    }
}
