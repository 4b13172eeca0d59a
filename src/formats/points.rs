//! The formats that were found and the words beside them, as a study. The search itself is none: which picture it draws next depends on the last.

use serde_json::{Value, json};

use super::FormatsResult;
use crate::settings::{MachineSettings, Settings, ViewSettings};
use crate::sweep::study::{Assignments, Study};

impl FormatsResult {
    /// The study of each scene in the formats that were found and in the words beside them, in their order, at the places of the samples that were
    /// searched with. `scenes` are the names that they are read by.
    pub fn study(&self, name: &str, machine: &MachineSettings, scenes: &[String]) -> Study {
        let one = |key: &str, value: Value| vec![(key.to_owned(), value)];
        // Quantities have fraction bits, or none where the scene chooses; the last is the word.
        let choice = |word: Value, layout: &str, visit: u32, bits: &dyn Fn(usize) -> Value| -> Assignments {
            let quantities = self.quantities.iter().enumerate().filter(|(_, one)| one.integer.is_some());
            let formats = quantities.map(|(at, one)| (format!("formats.{}", one.quantity), bits(at)));
            let others = [("layout", json!(layout)), ("tree.visit", json!(visit)), ("machine.arithmetic.word", word)];
            others.map(|(key, value)| (key.to_owned(), value)).into_iter().chain(formats).collect()
        };
        let word = self.quantities.last().map_or(Value::Null, |word| json!(word.bits));
        let found = choice(word, self.layout, self.visit, &|at| {
            let one = &self.quantities[at];
            if one.is_given { json!(one.bits) } else { Value::Null }
        });
        let uniform = self.uniform.iter().map(|one| choice(json!(one.word), one.layout, one.visit, &|_| Value::Null));
        let base = Settings {
            view: ViewSettings { size: Some([self.width, self.height]), ..ViewSettings::default() },
            machine: machine.clone(),
            ..Settings::default()
        };
        let mut base = base.value();
        base["kernels"]["profile"] = json!(self.profile);
        let factors = vec![
            scenes.iter().map(|scene| one("scene.name", json!(scene))).collect(),
            std::iter::once(found).chain(uniform).collect(),
            self.shifts.iter().map(|shift| one("view.shift", json!(shift))).collect(),
        ];
        Study { name: name.to_owned(), base, factors }
    }
}
