//! The annexes as tables for people, in text or in Markdown, and as CSV. All of it is in the JSON too.

use std::collections::BTreeMap;

use isa::{Class, Counts};
use kernels::annex as printed;

use super::Measurement;
use super::result::{Annexes, RowResult, SearchResult, Try};
use super::tables;
use crate::numeral::grouped;
use crate::table::{row, table};

/// The classes that the annexes print, in the order of Annex II and then Annex I.
pub(super) const COLUMNS: [&str; 6] = ["add", "sub", "mul", "div", "cmp", "mem"];

/// The elementary ones.
const ELEMENTARY: [Class; 5] = [Class::Add, Class::Sub, Class::Mul, Class::Div, Class::Cmp];

/// Style of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// For terminals.
    Text,
    /// For documents.
    Markdown,
}

impl Style {
    pub(super) fn table(self, rows: Vec<Vec<String>>) -> String {
        match self {
            Style::Text => table(rows),
            Style::Markdown => {
                let line = |cells: &Vec<String>| format!("| {} |\n", cells.join(" | "));
                let columns = rows.first().map_or(0, Vec::len);
                let rule = format!("|---|{}\n", "---:|".repeat(columns.saturating_sub(1)));
                rows.first().map(line).unwrap_or_default() + &rule + &rows.iter().skip(1).map(line).collect::<String>()
            }
        }
    }

    pub(super) fn heading(self, text: &str) -> String {
        match self {
            Style::Text => format!("{text}\n"),
            Style::Markdown => format!("### {text}\n\n"),
        }
    }
}

/// The rows that are met exactly, beside their printed values.
pub fn demo(measurements: &[Measurement]) -> String {
    let mut rows = vec![row(["row of Annex II", "", "add", "sub", "mul", "div", "cmp", "sum", ""])];
    for measurement in measurements.iter().filter(|measurement| measurement.row.terms.is_empty()) {
        let range = |least: u64, most: u64| match least == most {
            true => grouped(least),
            false => format!("{}..{}", grouped(least), grouped(most)),
        };
        let line = |label: &str, what: &str, least: &Counts, most: &Counts, verdict: &str| {
            let mut cells = vec![label.to_owned(), what.to_owned()];
            cells.extend(ELEMENTARY.iter().map(|&class| range(least[class], most[class])));
            cells.push(range(least.elementary(), most.elementary()));
            cells.push(verdict.to_owned());
            cells
        };
        let printed = &measurement.row.printed;
        let verdict = if measurement.is_met() { "equal" } else { "differs" };
        rows.push(line(&measurement.row.label, "printed", printed, printed, ""));
        rows.push(line("", "measured", &measurement.least, &measurement.most, verdict));
    }
    format!("The report's counts of operations and ours, for one call\n{}", table(rows))
}

/// Everything but the errata.
pub fn annexes(annexes: &Annexes, style: Style) -> String {
    let parts = [
        rows(annexes, style),
        terms(annexes, style),
        tables::paths(annexes, style),
        tables::parts(annexes, style),
        tables::storage(annexes, style),
        figures(annexes, style),
        peers(annexes, style),
        tables::cores(annexes, style),
    ];
    parts.join("\n")
}

/// A number with a sign.
pub(super) fn signed(number: i64) -> String {
    match number {
        0 => "0".to_owned(),
        _ => format!("{}{}", if number < 0 { "-" } else { "+" }, grouped(number.unsigned_abs())),
    }
}

/// A number with as many decimals as its size asks for.
pub(super) fn decimal(number: f64) -> String {
    match number.abs() {
        size if size >= 1000.0 => grouped(number.round() as u64),
        size if size >= 100.0 => format!("{number:.1}"),
        size if size >= 1.0 || size == 0.0 => format!("{number:.2}"),
        _ => format!("{number:.4}"),
    }
}

fn rows(annexes: &Annexes, style: Style) -> String {
    let head = ["row", "", "calls"].into_iter().chain(COLUMNS).chain(["sum", "least", "most", "free"]);
    let mut cells: Vec<Vec<String>> = vec![head.map(str::to_owned).collect()];
    for result in &annexes.rows {
        // A class that a row does not have stays blank.
        let numbers = |of: &dyn Fn(&str) -> Option<String>| {
            COLUMNS.map(|class| of(class).unwrap_or_default()).into_iter().collect::<Vec<_>>()
        };
        let mut add = |name: &str, what: &str, calls: String, classes: Vec<String>, rest: [String; 4]| {
            let start = [name.to_owned(), what.to_owned(), calls];
            cells.push(start.into_iter().chain(classes).chain(rest).collect());
        };
        let none = String::new;
        let whole = |of: &BTreeMap<&'static str, u64>| numbers(&|class| of.get(class).map(|&count| grouped(count)));
        let free = |by_class: &BTreeMap<&'static str, f64>| decimal(by_class.values().sum());
        // Set what was counted under the same assumptions below what is printed, and the difference below both
        add(
            result.id,
            "printed",
            none(),
            whole(&result.printed),
            [grouped(result.printed_total), none(), none(), none()],
        );
        let rest = [grouped(result.assumed_total), none(), none(), free(&result.free)];
        add("", "counted", none(), whole(&result.assumed), rest);
        let difference = result.assumed_total as i64 - result.printed_total as i64;
        let by_class = numbers(&|class| result.difference.get(class).map(|&n| signed(n)));
        add("", "difference", none(), by_class, [signed(difference), none(), none(), none()]);
        // Add the mean of a call on each scene; its sum leaves out `mem`, as the printed one does
        for scene in &result.scenes {
            let mean = numbers(&|class| scene.mean.get(class).map(|&mean| decimal(mean)));
            let sum = ELEMENTARY.iter().filter_map(|class| scene.mean.get(class.name())).sum();
            let rest = [decimal(sum), grouped(scene.least), grouped(scene.most), free(&scene.free)];
            add("", &scene.scene, grouped(scene.calls), mean, rest);
        }
    }
    let searches: String = annexes.rows.iter().filter_map(search).collect();
    style.heading("Operations of a call: printed, counted under the same assumptions, and the mean on scenes; free is work that no annex counts")
        + &style.table(cells)
        + &searches
}

/// Line on a search: how what a row assumes was found.
fn search(result: &RowResult) -> Option<String> {
    let search = result.search.as_ref()?;
    let tried: Vec<String> =
        search.tried.iter().map(|Try { number, calls }| format!("{calls} with {number}")).collect();
    let SearchResult { constant, region, .. } = search;
    Some(format!("\n{}: {constant} was searched; calls of {region}: {}\n", result.id, tried.join(", ")))
}

fn terms(annexes: &Annexes, style: Style) -> String {
    let mut text = style.heading("What the differences come from");
    for result in annexes.rows.iter().filter(|result| !result.terms.is_empty()) {
        text += &term_list(result);
    }
    text
}

/// The terms of a row; those of one line and one reason stand together.
fn term_list(result: &RowResult) -> String {
    let mut text = format!("- {} ({}):\n", result.id, result.label);
    for together in result.terms.chunk_by(|a, b| a.line == b.line && a.reason == b.reason) {
        let counts: Vec<String> = together.iter().map(|term| format!("{} {}", signed(term.n), term.class)).collect();
        let first = &together[0];
        text += &format!("  - {}: {} ({})\n", counts.join(", "), first.reason, first.line);
    }
    text
}

fn figures(annexes: &Annexes, style: Style) -> String {
    let scenes = &annexes.derived.scenes;
    let mut cells = vec![row(["figure", "printed", "counted", "unit"])];
    // The results are sorted by their ids, so the order is that of the printed figures.
    for figure in printed::figures().iter().filter_map(|figure| annexes.derived.figures.get(figure.id.as_str())) {
        let printed = figure.printed.map(decimal).unwrap_or_default();
        cells.push(vec![figure.label.to_owned(), printed, decimal(figure.counted), figure.unit.to_owned()]);
    }
    let mut text =
        style.heading("What follows: the counted figures are those of the pixel of 22 nodes") + &style.table(cells);
    // Give the figures of a pixel and a frame of each scene
    if !scenes.is_empty() {
        let head = [
            "scene",
            "operations",
            "memory clocks",
            "C/M",
            "(C+M)/M",
            "ms a pixel",
            "s a frame",
            "triangles",
            "nodes",
            "references",
        ];
        let mut cells = vec![row(head)];
        for scene in scenes {
            let numbers = [
                scene.pixel_operations,
                scene.memory_clocks,
                scene.processors,
                scene.saturation,
                scene.pixel_ms,
                scene.frame_s,
            ];
            let storage = scene.storage_octets.map(grouped);
            cells.push(std::iter::once(scene.scene.clone()).chain(numbers.map(decimal)).chain(storage).collect());
        }
        text += "\n";
        text += &style.heading("The same on scenes: a pixel, 640 x 480 pixels, octets in memory");
        text += &style.table(cells);
    }
    text
}

fn peers(annexes: &Annexes, style: Style) -> String {
    let mut cells = vec![row(["table 3", "servers", "resolution", "tested", "us a pixel"])];
    for peer in &annexes.derived.table_3 {
        let [width, height] = peer.resolution;
        let microseconds = if peer.pixel_us < 1.0 { format!("{:.3}", peer.pixel_us) } else { decimal(peer.pixel_us) };
        let size = format!("{width} x {height}");
        cells.push(vec![peer.name.clone(), peer.servers.to_string(), size, peer.primitive.clone(), microseconds]);
    }
    style.table(cells)
}

/// Errata of the printed figures, with what each changes.
pub fn errata(annexes: &Annexes, style: Style) -> String {
    let mut text = style.heading("Errata of the report");
    for erratum in &annexes.errata {
        text += &format!(
            "- {} ({}): {}.\n  Correct: {}.\n  Effect: {}.\n",
            erratum.source, erratum.name, erratum.printed, erratum.correct, erratum.effect
        );
    }
    text
}

/// The rows as CSV, a line for what is printed, counted, the difference and each scene.
pub fn csv(annexes: &Annexes) -> String {
    let mut text = format!("id,what,calls,{},sum,least,most\n", COLUMNS.join(","));
    for result in &annexes.rows {
        let line = |what: &str, calls: String, numbers: [String; 6], rest: [String; 3]| {
            format!("{},{what},{calls},{},{}\n", result.id, numbers.join(","), rest.join(","))
        };
        let whole = |of: &BTreeMap<&'static str, u64>| {
            COLUMNS.map(|class| of.get(class).map(u64::to_string).unwrap_or_default())
        };
        let sums = |sum: String| [sum, String::new(), String::new()];
        text += &line("printed", String::new(), whole(&result.printed), sums(result.printed_total.to_string()));
        text += &line("counted", String::new(), whole(&result.assumed), sums(result.assumed_total.to_string()));
        let difference = result.assumed_total as i64 - result.printed_total as i64;
        let by_class = COLUMNS.map(|class| result.difference.get(class).map(i64::to_string).unwrap_or_default());
        text += &line("difference", String::new(), by_class, sums(difference.to_string()));
        for scene in &result.scenes {
            let mean = COLUMNS.map(|class| scene.mean.get(class).map(f64::to_string).unwrap_or_default());
            let sum: f64 = ELEMENTARY.iter().filter_map(|class| scene.mean.get(class.name())).sum();
            let rest = [sum.to_string(), scene.least.to_string(), scene.most.to_string()];
            text += &line(&scene.scene, scene.calls.to_string(), mean, rest);
        }
    }
    text
}
