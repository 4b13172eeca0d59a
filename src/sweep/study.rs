//! A study file: settings that all points share, and what varies. Products, zips, lists and Latin hypercubes are factors, each a list of
//! alternatives; the points are their product.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use messages::{Diagnostic, Place, Report, Source, did_you_mean};
use serde_json::{Map, Value};

use super::latin;
use crate::numeral::{grouped, numbers};
use crate::settings::apply::change;
use crate::settings::read::{span, toml};
use crate::settings::{Settings, key};

/// Keys with their values, in the order in which they are set.
pub type Assignments = Vec<(String, Value)>;

/// Most points of a study.
pub const MOST_POINTS: u64 = 10_000_000;

/// Numbers of a key that are all tried by themselves.
const MOST_TRIALS: usize = 256;

/// Tables of a study file.
const TABLES: [&str; 6] = ["name", "settings", "product", "zip", "list", "latin"];

/// Keys of a Latin hypercube.
const LATIN: [&str; 3] = ["points", "seed", "keys"];

/// Variation of settings: those that all points share, and the factors whose product the points are.
#[derive(Clone, Debug)]
pub struct Study {
    /// Name of the study.
    pub name: String,
    /// Settings of every point before its own, as JSON with every key.
    pub base: Value,
    /// The factors: each key of `product` in the order of their full names, zips, the list, the Latin hypercube.
    pub factors: Vec<Vec<Assignments>>,
}

impl Study {
    /// Reads a study file. Keys may have their short names, ranges such as `"1-8"` stand for their numbers.
    ///
    /// # Errors
    /// All mistakes of the file, each with its place.
    pub fn parse(source: &Arc<Source>, name: &str) -> Result<Study, Report> {
        let mut file = StudyFile { source, messages: Vec::new(), base: Settings::default().value() };
        let root = toml(source)?;
        for table in root.keys().filter(|table| !TABLES.contains(&table.as_str())) {
            let message = Diagnostic::error(format!("`{table}` is no part of a study"));
            let hint = did_you_mean(table, TABLES).unwrap_or_else(|| format!("the parts are {}", TABLES.join(", ")));
            file.refuse(message.hint(hint), table);
        }
        if !names_scene(&root) {
            let message = Diagnostic::error("the study names no scene");
            file.messages.push(
                message.hint("write `scene = \"cornell\"` below [settings], or a list of scenes below [product]"),
            );
        }
        let name = root.get("name").and_then(Value::as_str).unwrap_or(name).to_owned();
        // What all points share comes first, since what varies is tried on it.
        if let Some(table) = root.get("settings") {
            for (key, value) in file.assigned(table, "settings") {
                let mut base = file.base.clone();
                match change(&mut base, &key, value).and_then(|()| Settings::of_value(&base)) {
                    Ok(_) => file.base = base,
                    Err(report) => {
                        report.0.into_iter().for_each(|message| file.refuse(message, &format!("settings.{key}")))
                    }
                }
            }
        }
        let mut factors = Vec::new();
        let product = root.get("product").map(|table| file.assigned(table, "product"));
        for (key, value) in product.unwrap_or_default() {
            let values = file.values(&key, value, "product");
            factors.push(values.into_iter().map(|value| vec![(key.clone(), value)]).collect());
        }
        for table in tables(&root, "zip") {
            factors.extend(file.zip(table));
        }
        let list: Vec<Assignments> = tables(&root, "list").map(|table| file.assigned(table, "list")).collect();
        factors.extend((!list.is_empty()).then_some(list));
        if let Some(table) = root.get("latin") {
            factors.extend(file.latin(table, points(&factors)));
        } else {
            file.has_room(points(&factors));
        }
        // Values are tried by themselves, so that a mistake is named once and not for each point.
        for (key, value) in trials(&factors) {
            let mut one = file.base.clone();
            if let Err(report) = change(&mut one, key, value.clone()).and_then(|()| Settings::of_value(&one)) {
                let blamed =
                    |message: Diagnostic| Diagnostic { message: format!("`{key}`: {}", message.message), ..message };
                file.messages.extend(report.0.into_iter().map(blamed));
            }
        }
        file.messages.dedup();
        if !file.messages.is_empty() {
            return Err(Report(file.messages));
        }
        Ok(Study { name, base: file.base, factors })
    }

    /// Number of points; those that are the same count each.
    pub fn count(&self) -> u64 {
        points(&self.factors)
    }

    /// Numbers of the alternatives that a point has of each factor, by its number below [`Study::count`]; the last factor varies fastest.
    pub fn chosen(&self, mut number: u64) -> Vec<u64> {
        let mut chosen = vec![0; self.factors.len()];
        for (factor, chosen) in self.factors.iter().zip(&mut chosen).rev() {
            let length = factor.len() as u64;
            (*chosen, number) = (number % length, number / length);
        }
        chosen
    }

    /// Keys that a point sets, by its number.
    pub fn assignments(&self, number: u64) -> Assignments {
        let chosen = self.factors.iter().zip(self.chosen(number)).flat_map(|(factor, chosen)| &factor[chosen as usize]);
        ordered(chosen.cloned().collect())
    }
}

/// Points of the product of some factors.
fn points(factors: &[Vec<Assignments>]) -> u64 {
    factors.iter().fold(1, |points, factor| points.saturating_mul(factor.len() as u64))
}

/// True where every point of a study has a scene: all points share it, some factor has it, or each alternative of the list.
fn names_scene(root: &Map<String, Value>) -> bool {
    let is_scene = |name: &str| key::resolve(name).is_ok_and(|key| ["scene", "scene.name"].contains(&key.as_str()));
    let has = |table: &Value| key::leaves(table).iter().any(|(name, _)| is_scene(name));
    let is_in = |name: &str| tables(root, name).any(has);
    let list: Vec<bool> = tables(root, "list").map(has).collect();
    let is_in_latin = root.get("latin").is_some_and(|latin| has(&latin["keys"]));
    ["settings", "product", "zip"].into_iter().any(is_in)
        || is_in_latin
        || (list.contains(&true) && !list.contains(&false))
}

/// Assignments in the order in which they are set: a scene or a machine as a whole before single keys, and hashes last, which go with the name of
/// another file.
pub fn ordered(mut assignments: Assignments) -> Assignments {
    assignments.sort_by_key(|(key, _)| (key != "machine.from", key.ends_with(".hash"), key.matches('.').count()));
    assignments.sort_by_key(|(key, _)| !["machine", "machine.from", "scene"].contains(&key.as_str()));
    assignments
}

/// Values of each key that are tried by themselves: all of few, and of many numbers the smallest and the largest. What lies between those is
/// tried in its points.
fn trials(factors: &[Vec<Assignments>]) -> Vec<(&str, &Value)> {
    let mut keys: Vec<(&str, Vec<&Value>)> = Vec::new();
    let mut known = HashMap::<&str, (usize, HashSet<String>)>::new();
    for (key, value) in factors.iter().flatten().flatten() {
        let (number, values) = known.entry(key).or_insert_with(|| {
            keys.push((key, Vec::new()));
            (keys.len() - 1, HashSet::new())
        });
        if values.insert(value.to_string()) {
            keys[*number].1.push(value);
        }
    }
    keys.into_iter().flat_map(|(key, values)| ends(values).into_iter().map(move |value| (key, value))).collect()
}

/// All of few values, and of many numbers the smallest and the largest.
fn ends(values: Vec<&Value>) -> Vec<&Value> {
    if values.len() <= MOST_TRIALS || !values.iter().all(|value| value.is_number()) {
        return values;
    }
    let number = |value: &&Value| value.as_f64().unwrap_or_default();
    let by_number = |one: &&Value, other: &&Value| number(one).total_cmp(&number(other));
    let (least, most) = (values.iter().copied().min_by(by_number), values.iter().copied().max_by(by_number));
    least.into_iter().chain(most).collect()
}

/// The tables of a list of tables, or of one table.
fn tables<'v>(root: &'v Map<String, Value>, name: &str) -> impl Iterator<Item = &'v Value> + use<'v> {
    let found = root.get(name);
    let list = found.and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    list.iter().chain(found.filter(|value| value.is_object()))
}

/// A study file that is being read.
struct StudyFile<'s> {
    source: &'s Arc<Source>,
    messages: Vec<Diagnostic>,
    base: Value,
}

impl StudyFile<'_> {
    fn refuse(&mut self, message: Diagnostic, path: &str) {
        let place = span(&self.source.text, path).filter(|_| message.place.is_none());
        self.messages.push(match place {
            Some(span) => message.at(Place::new(self.source, span), ""),
            None => message,
        });
    }

    /// True of as many points as a study may have; more are refused.
    fn has_room(&mut self, points: u64) -> bool {
        if points > MOST_POINTS {
            let message = Diagnostic::error(format!("the study has more than {} points", grouped(MOST_POINTS)));
            self.messages.push(message.hint("a Latin hypercube covers many keys with few points"));
        }
        points <= MOST_POINTS
    }

    /// Keys of a table in full, with their values; dotted keys and tables in tables are the same.
    fn assigned(&mut self, table: &Value, path: &str) -> Assignments {
        let mut found = Assignments::new();
        for (name, value) in key::leaves(table) {
            match key::resolve(&name) {
                Ok(key) => found.push((key, value.clone())),
                Err(report) => {
                    report.0.into_iter().for_each(|message| self.refuse(message, &format!("{path}.{name}")));
                }
            }
        }
        ordered(found)
    }

    /// Values of a key: those of a list, the numbers of a range, or one.
    fn values(&mut self, key: &str, value: Value, path: &str) -> Vec<Value> {
        let is_number = key::KEYS.get(key).is_some_and(Value::is_number);
        let values = match value {
            Value::Array(values) => values,
            value => vec![value],
        };
        let expand = |value: Value| match value.as_str().filter(|_| is_number) {
            Some(text) => match numbers(text, 0, u32::MAX, "number") {
                Ok(numbers) => numbers.into_iter().map(Value::from).collect(),
                Err(_) => vec![value],
            },
            None => vec![value],
        };
        let values: Vec<Value> = values.into_iter().flat_map(expand).collect();
        if values.is_empty() {
            self.refuse(Diagnostic::error(format!("`{key}` has no value")), &format!("{path}.{key}"));
        }
        values
    }

    /// Lists of one length that go together.
    fn zip(&mut self, table: &Value) -> Option<Vec<Assignments>> {
        let columns: Vec<(String, Vec<Value>)> = self
            .assigned(table, "zip")
            .into_iter()
            .map(|(key, value)| (key.clone(), self.values(&key, value, "zip")))
            .collect();
        let length = columns.first()?.1.len();
        if let Some((key, values)) = columns.iter().find(|(_, values)| values.len() != length) {
            let (first, many) = (&columns[0].0, values.len());
            let message = format!("`{key}` has {many} values in a zip in which `{first}` has {length}");
            self.refuse(Diagnostic::error(message), "zip");
            return None;
        }
        let row = |at: usize| columns.iter().map(|(key, values)| (key.clone(), values[at].clone())).collect();
        Some((0..length).map(row).collect())
    }

    /// Points of a Latin hypercube beside so many of the other factors, which are counted before they are made.
    fn latin(&mut self, table: &Value, others: u64) -> Option<Vec<Assignments>> {
        for name in table.as_object()?.keys().filter(|name| !LATIN.contains(&name.as_str())) {
            let message = Diagnostic::error(format!("`{name}` is no key of a Latin hypercube"));
            self.refuse(message.hint(format!("the keys are {}", LATIN.join(", "))), &format!("latin.{name}"));
        }
        let points = table["points"].as_u64().filter(|points| (1..=MOST_POINTS).contains(points));
        let Some(points) = points else {
            let message = format!("a Latin hypercube has `points`, 1 to {}", grouped(MOST_POINTS));
            self.refuse(Diagnostic::error(message), "latin.points");
            return None;
        };
        if !self.has_room(others.saturating_mul(points)) {
            return None;
        }
        let keys = self.assigned(table.get("keys")?, "latin.keys");
        let mut columns = Vec::new();
        for (key, value) in keys {
            match latin::Range::new(&value) {
                Some(range) => columns.push((key, range)),
                None => self.refuse(
                    Diagnostic::error(format!("`{key}` has neither two numbers nor a list of choices")),
                    &format!("latin.keys.{key}"),
                ),
            }
        }
        Some(latin::points(points, table["seed"].as_u64().unwrap_or(1), &columns))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn study(text: &str) -> Result<Study, String> {
        Study::parse(&Source::new("study.toml", text), "study").map_err(|report| report.render(false))
    }

    #[test]
    fn factors_multiply() {
        let text = "[settings]\nsize = \"8x6\"\n[product]\nscene = [\"cornell\", \"slabs\"]\ncores = \"1-3\"\n\
                    [[zip]]\nword = [32, 24]\nkd-depth = [16, 8]\n[[list]]\nprofile = \"ray\"\n[[list]]\nprofile = \"report\"\nbounces = 1\n\
                    [latin]\npoints = 5\nkeys = { setup_clocks = [0, 9] }\n";
        let study = study(text).unwrap();
        assert_eq!(study.count(), 2 * 3 * 2 * 2 * 5);
        assert_eq!(study.base["view"]["size"], serde_json::json!([8, 6]));
        let keys: Vec<String> = study.assignments(119).into_iter().map(|(key, _)| key).collect();
        assert_eq!(keys[0], "scene");
        assert!(keys.contains(&"machine.arithmetic.word".to_owned()) && keys.contains(&"effort.bounces".to_owned()));
        let cores: Vec<Value> = (0..120)
            .flat_map(|at| study.assignments(at))
            .filter(|(key, _)| key == "machine.cores")
            .map(|(_, value)| value)
            .collect();
        assert_eq!(cores.iter().filter(|value| **value == 2).count(), 40);
    }

    #[test]
    fn all_mistakes_of_a_study_are_named() {
        let text = "prodct = 1\n[product]\ncors = [1]\nprofile = [\"rai\"]\nword = []\n[[zip]]\ncores = [1, 2]\nword = [20]\n[latin]\npoints = 0\n";
        let shown = study(text).expect_err("nothing is right");
        for part in [
            "did you mean `product`?",
            "did you mean `cores`?",
            "did you mean `ray`?",
            "has no value",
            "in a zip in which",
            "has `points`",
        ] {
            assert!(shown.contains(part), "{part}\n{shown}");
        }
    }

    #[test]
    fn many_numbers_are_tried_at_their_ends() {
        let text = |low: i64| {
            format!(
                "settings.scene = \"triangle\"\n[latin]\npoints = 5000\nkeys = {{ \"bus.setup_clocks\" = [{low}, 9000], word = [16, 24, 32] }}\n"
            )
        };
        assert_eq!(trials(&study(&text(0)).unwrap().factors).len(), 2 + 3);
        let shown = study(&text(-9)).expect_err("no clocks are below none");
        assert_eq!(shown.matches("setup_clocks").count(), 1, "{shown}");
    }

    #[test]
    fn too_much_is_refused_before_it_is_made() {
        let many = "product.cores = \"1-4000\"\nproduct.setup_clocks = \"0-4000\"\n";
        for text in [
            format!("settings.scene = \"triangle\"\n{many}"),
            format!(
                "settings.scene = \"triangle\"\n{many}[latin]\npoints = 10000000\nkeys = {{ clock_hz = [1, 9] }}\n"
            ),
        ] {
            assert!(study(&text).expect_err(&text).contains("more than 10,000,000 points"), "{text}");
        }
        // More numbers than any list has are no range.
        let range = "settings.scene = \"triangle\"\nproduct.clock_hz = \"1-4000000000\"\n";
        assert!(study(range).expect_err(range).contains("`1-4000000000` is no value of `machine.clock_hz`"));
    }

    #[test]
    fn a_study_without_a_scene_is_refused() {
        for text in [
            "product.cores = [1, 2]\n",
            "[[list]]\nscene = \"triangle\"\n[[list]]\ncores = 2\n",
            "[latin]\npoints = 2\nkeys = { cores = [1, 2] }\n",
        ] {
            assert!(study(text).expect_err(text).contains("names no scene"), "{text}");
        }
        for text in [
            "settings.scene.name = \"triangle\"\n",
            "[[list]]\nscene = \"triangle\"\n[[list]]\nscene = \"slabs\"\n",
            "[latin]\npoints = 2\nkeys = { scene = [\"triangle\", \"slabs\"] }\n",
            "[[zip]]\nscene = [\"triangle\", \"slabs\"]\ncores = [1, 2]\n",
        ] {
            assert!(study(text).is_ok(), "{text}");
        }
    }

    #[test]
    fn a_list_in_the_place_of_a_group_is_refused() {
        for text in ["[[list]]\nscene = [1]\n", "[settings]\nkernels = [1]\n", "[product]\nscene = [[1]]\n"] {
            let shown = study(text).expect_err(text);
            assert!(shown.contains("error"), "{text}: {shown}");
        }
    }
}
