//! An extension beside its absence as a table for people, in text and in Markdown.

use isa::Class;

use super::{ExtensionResult, VariantResult};
use crate::energy::EnergySummary;
use crate::numeral::{count, grouped};
use crate::table::{row, table};

/// A row of energy: its name and its figure.
type EnergyRow = (&'static str, fn(&EnergySummary) -> f64);

const ENERGIES: [EnergyRow; 2] =
    [("nJ a pixel, least", |energy| energy.pixel_nj.least), ("nJ a pixel, most", |energy| energy.pixel_nj.most)];

/// A change in per cent.
fn change(from: u64, to: u64) -> String {
    match (from, to) {
        (from, to) if from == to => "0.0 %".to_owned(),
        (0, _) => "new".to_owned(),
        (from, to) => format!("{:+.1} %", 100.0 * (to as f64 - from as f64) / from as f64),
    }
}

impl ExtensionResult {
    /// Head and rows of the table.
    fn rows(&self, has_energy: bool) -> Vec<Vec<String>> {
        let variants = [&self.without, &self.with, &self.expanded];
        let mut rows = vec![row(["", "without", "with", "change", "expanded", "change"])];
        // A figure that is 0 in all three is left out, such as a class of operations that no kernel has.
        let mut add = |name: &str, value: &dyn Fn(&VariantResult) -> u64| {
            let [without, with, expanded] = variants.map(value);
            if [without, with, expanded] != [0; 3] {
                rows.push(vec![
                    name.to_owned(),
                    grouped(without),
                    grouped(with),
                    change(without, with),
                    grouped(expanded),
                    change(without, expanded),
                ]);
            }
        };
        add("instructions", &|variant| variant.instructions);
        add("elementary operations", &|variant| variant.elementary);
        for &class in Class::ALL {
            add(class.name(), &|variant| variant.counts.0[class]);
        }
        add("clocks of computing", &|variant| variant.busy_clocks);
        add("octets on the bus", &|variant| variant.octets);
        add(&format!("clocks on {}", count(self.cores.into(), "core", "cores")), &|variant| variant.clocks);
        add("code in words", &|variant| variant.words);
        // Say how often each instruction ran, which only pictures with it can
        for (name, &count) in self.instructions.iter().zip(&self.executions) {
            let none = String::new;
            rows.push(vec![format!("times `{name}` ran"), none(), grouped(count), none(), none(), none()]);
        }
        // Give energy and error, which are no whole numbers
        for (name, figure) in ENERGIES.iter().filter(|_| has_energy) {
            let [without, with, expanded] = variants.map(|variant| figure(&variant.energy));
            let change = |to: f64| {
                if without == 0.0 { String::new() } else { format!("{:+.1} %", 100.0 * (to / without - 1.0)) }
            };
            let number = |figure: f64| format!("{figure:.3}");
            rows.push(vec![
                (*name).to_owned(),
                number(without),
                number(with),
                change(with),
                number(expanded),
                change(expanded),
            ]);
        }
        let psnr = |variant: &VariantResult| match variant.error.and_then(|error| error.psnr_db) {
            Some(psnr) => format!("{psnr:.2}"),
            None => "-".to_owned(),
        };
        let [without, with, expanded] = variants.map(psnr);
        rows.push(vec!["PSNR in dB".to_owned(), without, with, String::new(), expanded, String::new()]);
        rows
    }

    fn title(&self) -> String {
        let names: Vec<String> = self.instructions.iter().map(|name| format!("`{name}`")).collect();
        format!(
            "{} of {}: {}, {} x {} pixels, kernels `{}` on machine `{}`\n",
            names.join(", "),
            self.file,
            self.scene,
            self.size[0],
            self.size[1],
            self.profile,
            self.machine
        )
    }

    fn verdict(&self) -> String {
        match self.is_identical {
            true => format!("The pictures are identical: {}\n", self.without.image_hash),
            false => format!(
                "The pictures differ: without {}, with {}\n",
                &self.without.image_hash[..16],
                &self.with.image_hash[..16]
            ),
        }
    }

    /// The table for people, with energy or without.
    pub fn text(&self, has_energy: bool) -> String {
        format!("{}\n{}\n{}", self.title(), table(self.rows(has_energy)), self.verdict())
    }

    /// The table as Markdown, with energy or without.
    pub fn markdown(&self, has_energy: bool) -> String {
        let rows = self.rows(has_energy);
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let rule = format!("|---|{}\n", "---:|".repeat(rows[0].len() - 1));
        let body: String = rows[1..].iter().map(|cells| line(cells)).collect();
        format!("{}\n{}{rule}{body}\n{}", self.title(), line(&rows[0]), self.verdict())
    }
}
