//! The text of a study that a command has put together: a file from which [`Study::parse`] makes the same points in the same order.

use std::fmt::Write;

use messages::{Diagnostic, Report};
use serde_json::Value;

use super::study::{Assignments, Study, ordered};
use crate::files;
use crate::settings::apply::change;
use crate::settings::key::{KEYS, leaves};
use crate::settings::{FROM, Settings};

impl Study {
    /// The study as a file. `about` is its first line, a comment.
    ///
    /// Factors of one alternative stand among the settings. Others are zips in their order; one whose alternatives set different keys is the list,
    /// which comes after them.
    ///
    /// # Errors
    /// Settings that read standard input, which nobody could read again.
    pub fn text(&self, about: &str) -> Result<String, Report> {
        let (fixed, varied): (Vec<_>, Vec<_>) = self.factors.iter().partition(|factor| self.is_fixed(factor));
        let (zips, lists): (Vec<_>, Vec<_>) = varied.into_iter().partition(|factor| has_one_form(factor));
        // Put what does not vary among the settings.
        let mut base = self.base.clone();
        for (key, value) in ordered(fixed.into_iter().flatten().flatten().cloned().collect()) {
            change(&mut base, &key, value)?;
        }
        let mut text = format!("# {about}\nname = {}\n\n[settings]\n", shown(&self.name.as_str().into()));
        for (key, value) in self.own(&base)? {
            let _ = writeln!(text, "{key} = {}", shown(&value));
        }
        for zip in zips {
            text += "\n[[zip]]\n";
            for (at, (key, _)) in zip[0].iter().enumerate() {
                let column = zip.iter().map(|alternative| alternative[at].1.clone()).collect();
                let _ = writeln!(text, "{key} = {}", shown(&Value::Array(column)));
            }
        }
        for alternative in product(&lists) {
            text += "\n[[list]]\n";
            for (key, value) in alternative {
                let _ = writeln!(text, "{key} = {}", shown(&value));
            }
        }
        Ok(text)
    }

    /// True of a factor of one alternative whose keys may as well stand among the settings: no other factor puts a machine or a scene over them.
    fn is_fixed(&self, factor: &[Assignments]) -> bool {
        let [alternative] = factor else { return false };
        let mut others = self.factors.iter().filter(|other| other.len() > 1).flatten().flatten();
        let is_whole = |group: &str, key: &str| group.strip_suffix(FROM).unwrap_or(group).trim_end_matches('.') == key;
        !others.any(|(group, _)| {
            alternative.iter().any(|(key, _)| key.split_once('.').is_some_and(|(first, _)| is_whole(group, first)))
        })
    }

    /// Keys of the settings that all points share, as far as they differ from the defaults.
    fn own(&self, base: &Value) -> Result<Vec<(String, Value)>, Report> {
        let settings = Settings::of_value(base)?;
        let scenes = self.factors.iter().flatten().flatten().filter(|(key, _)| key.starts_with("scene"));
        check_named(&settings, scenes.filter_map(|(_, value)| value.as_str()))?;
        // What each point has of its own says nothing of all.
        let varied = |wanted: &str| {
            let sets = |one: &Assignments| one.iter().any(|(key, _)| key == wanted);
            self.factors.iter().any(|factor| factor.len() > 1 && factor.iter().all(sets))
        };
        let is_own = |(key, value): &(String, &Value)| {
            !key.starts_with("machine.") && KEYS.get(key) != Some(*value) && !varied(key)
        };
        let mut own: Vec<(String, Value)> =
            leaves(base).into_iter().filter(is_own).map(|(key, value)| (key, value.clone())).collect();
        let machine = settings.machine.brief();
        if machine != Settings::default().machine.brief() && !varied("machine") {
            own.push(("machine".to_owned(), machine));
        }
        Ok(own)
    }
}

/// Check that a study can name all files of settings, and these scenes.
///
/// # Errors
/// Standard input, which nobody could read again.
pub fn check_named<'s>(settings: &'s Settings, scenes: impl IntoIterator<Item = &'s str>) -> Result<(), Report> {
    let Settings { scene, kernels, .. } = settings;
    let own = [scene.name.as_str()].into_iter().chain(scene.mesh.as_deref());
    let files = kernels.replaced.values().chain(&kernels.extensions).map(|file| file.file.as_str());
    match own.chain(files).chain(scenes).any(|name| name == files::STANDARD) {
        false => Ok(()),
        true => {
            let message = Diagnostic::error("a study cannot name standard input, which is read once");
            Err(message.hint("write it to a file, and name that").into())
        }
    }
}

/// True of a factor whose alternatives set the same keys.
fn has_one_form(factor: &[Assignments]) -> bool {
    fn keys(alternative: &Assignments) -> impl Iterator<Item = &String> {
        alternative.iter().map(|(key, _)| key)
    }
    let Some(first) = factor.first() else { return false };
    !first.is_empty() && factor.iter().all(|alternative| keys(alternative).eq(keys(first)))
}

/// Combinations of the alternatives of some factors; none without a factor. The last factor varies fastest.
fn product(factors: &[&Vec<Assignments>]) -> Vec<Assignments> {
    let Some((first, others)) = factors.split_first() else { return Vec::new() };
    others.iter().fold((*first).clone(), |known, factor| {
        let with = |one: &Assignments| factor.iter().map(|other| [one.as_slice(), other].concat()).collect::<Vec<_>>();
        known.iter().flat_map(with).collect()
    })
}

/// A value as TOML has it in a line. What has no value in TOML is the word `null`, which keys that may be null read as that.
fn shown(value: &Value) -> String {
    toml_of(value).to_string()
}

fn toml_of(value: &Value) -> toml::Value {
    match value {
        Value::Null => toml::Value::String("null".to_owned()),
        Value::Bool(is_set) => toml::Value::Boolean(*is_set),
        Value::Number(number) => match number.as_i64() {
            Some(whole) => toml::Value::Integer(whole),
            None => toml::Value::Float(number.as_f64().unwrap_or_default()),
        },
        Value::String(text) => toml::Value::String(text.clone()),
        Value::Array(values) => toml::Value::Array(values.iter().map(toml_of).collect()),
        // A file without its hash is its name.
        Value::Object(keys) => match keys.get("file") {
            Some(file) if keys.get("hash").is_none_or(Value::is_null) => toml_of(file),
            _ => toml::Value::Table(keys.iter().map(|(key, value)| (key.clone(), toml_of(value))).collect()),
        },
    }
}

#[cfg(test)]
mod tests {
    use messages::Source;
    use serde_json::json;

    use super::*;

    fn parsed(text: &str) -> Study {
        let study = Study::parse(&Source::new("s.toml", text), "s");
        study.unwrap_or_else(|report| panic!("{text}\n{}", report.render(false)))
    }

    /// Settings of all points.
    fn points(study: &Study) -> Vec<Settings> {
        let point = |number: u64| {
            let mut value = study.base.clone();
            for (key, assigned) in study.assignments(number) {
                change(&mut value, &key, assigned).unwrap();
            }
            Settings::of_value(&value).unwrap()
        };
        (0..study.count()).map(point).collect()
    }

    #[test]
    fn a_text_reads_back_as_the_same_points() {
        for text in [
            "settings.scene = \"triangle\"\n",
            "[settings]\nsize = [8, 6]\nkernels.replaced.triangle = \"my \\\"own\\\".s\"\nkernels.extensions = [\"a.isa\"]\neffort.skips = []\nmachine = \"wide32\"\n\
             cores = 3\n[product]\nscene = [\"cornell\", \"a b.off\"]\nword = \"20-22\"\n",
            "[settings]\nscene = \"slabs\"\ncores = 9\nkd-depth = 7\n[[zip]]\ninterpolate = [\"none\", 0.125]\nkd-depth = [\"null\", \"auto\"]\nlayout = [\"null\", \"wide\"]\n\
             shift = [[0, -0.1], [0.25, 1e-9]]\n[[list]]\n[[list]]\nprofile = \"report\"\nmachine = { from = \"wide32\", bus.overlap = true, clocks.mul = \"linear\" }\n",
            // What a machine or a scene puts its own over stays behind it.
            "[settings]\nscene = { name = \"a\", mesh = \"b\" }\n[product]\nmachine = [\"report\", \"wide32\"]\nword = [24]\ncores = [2]\n",
            "settings.scene = \"triangle\"\n[latin]\npoints = 3\nkeys = { setup_clocks = [0, 9], arbiter = [\"tdma\", \"oldest-first\"] }\n",
        ] {
            let study = parsed(text);
            let written = study.text("Some points.").unwrap();
            assert!(written.starts_with("# Some points.\nname = \"s\"\n"), "{written}");
            assert_eq!(points(&parsed(&written)), points(&study), "{written}");
        }
    }

    #[test]
    fn several_lists_are_one_of_their_combinations() {
        let one = |key: &str, value: Value| vec![(key.to_owned(), value)];
        let lists = || vec![Assignments::new(), one("machine.cores", json!(2))];
        let factors = vec![lists(), vec![one("machine.arithmetic.word", json!(20)), one("effort.bounces", json!(1))]];
        let study = Study { name: "s".into(), base: parsed("settings.scene = \"triangle\"").base, factors };
        assert_eq!(points(&parsed(&study.text("").unwrap())), points(&study));
    }

    #[test]
    fn standard_input_is_refused() {
        for text in [
            "settings.scene = \"-\"",
            "[settings]\nscene = \"a\"\nkernels.extensions = [\"-\"]",
            "product.scene = [\"-\", \"a\"]",
        ] {
            let refused = parsed(text).text("").unwrap_err().render(false);
            assert!(refused.contains("standard input"), "{text}: {refused}");
        }
    }
}
