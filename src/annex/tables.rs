//! Tables of the annexes beside the rows: paths of the drivers, lines of the rows, structures in memory, cores of others.

use std::collections::BTreeMap;

use super::result::{Annexes, PartResult, PathResult};
use super::text::{COLUMNS, Style, decimal};
use crate::numeral::grouped;
use crate::table::row;

/// The path of each driver, and what other ways down the tree take.
pub(super) fn paths(annexes: &Annexes, style: Style) -> String {
    let mut text = style.heading("The paths that the drivers go");
    for result in &annexes.rows {
        text += &format!("- {}: {}\n", result.id, result.path);
    }
    let head = ["all ways down", ""].into_iter().chain(COLUMNS);
    let mut cells = vec![head.map(str::to_owned).collect()];
    for result in &annexes.rows {
        let Some(PathResult { least, mean, most, .. }) = &result.paths else { continue };
        let whole = |of: &BTreeMap<&'static str, u64>| COLUMNS.map(|class| of.get(class).map(|&count| grouped(count)));
        let means = COLUMNS.map(|class| mean.get(class).map(|&mean| decimal(mean)));
        for (name, what, numbers) in
            [(result.id, "least", whole(least)), ("", "mean", means), ("", "most", whole(most))]
        {
            let numbers = numbers.into_iter().map(Option::unwrap_or_default);
            cells.push([name.to_owned(), what.to_owned()].into_iter().chain(numbers).collect());
        }
    }
    text + "\n" + &style.table(cells)
}

/// The lines of each row: operations of one and how many, printed and counted.
pub(super) fn parts(annexes: &Annexes, style: Style) -> String {
    let mut cells = vec![row(["row", "line", "each", "printed", "total", "counted", "total"])];
    for result in &annexes.rows {
        for (number, part) in result.parts.iter().enumerate() {
            let PartResult { kind, label, printed_each, printed_times, printed_total, counted_times, counted_total } =
                part;
            let is_row = kind.contains('.');
            // Calls of a row that do not take what is printed show what they take.
            let counted_each = counted_total / counted_times.max(&1);
            let each = match printed_each {
                Some(each) if is_row && *counted_times != 0 && counted_each != *each => {
                    format!("{} / {}", grouped(*each), grouped(counted_each))
                }
                Some(each) => grouped(*each),
                None => grouped(counted_each),
            };
            let name = if number == 0 { result.id.to_owned() } else { String::new() };
            let label = if is_row { format!("{label} ({kind})") } else { label.clone() };
            let printed = |number: u64| printed_each.map_or_else(String::new, |_| grouped(number));
            cells.push(vec![
                name,
                label,
                each,
                printed(*printed_times),
                printed(*printed_total),
                grouped(*counted_times),
                grouped(*counted_total),
            ]);
        }
    }
    style.heading("Lines of the rows: operations of one, printed and where they differ counted, and how many")
        + &style.table(cells)
}

/// Annex I's structures.
pub(super) fn storage(annexes: &Annexes, style: Style) -> String {
    let mut cells = vec![row(["structure", "element", "printed", "report", "wide", "unit"])];
    let mut before = "";
    for line in &annexes.storage.rows {
        let name = if line.structure == before { String::new() } else { line.label.to_owned() };
        before = line.structure;
        let number = |number: f64| match line.unit {
            "MB" => format!("{number:.6}"),
            _ => grouped(number as u64),
        };
        let wide = line.wide.map(number).unwrap_or_default();
        cells.push(vec![
            name,
            line.element.to_owned(),
            number(line.printed),
            number(line.counted),
            wide,
            line.unit.to_owned(),
        ]);
    }
    let heading = format!(
        "Structures in memory: printed, in the layouts report and wide; the numbers are those of the scene {}",
        annexes.storage.scene
    );
    style.heading(&heading) + &style.table(cells)
}

/// Cores of others and ours.
pub(super) fn cores(annexes: &Annexes, style: Style) -> String {
    let mut cells = vec![row(["6.3, a core", "rays/s", "memory", "place"])];
    for core in &annexes.derived.cores {
        let [least, most] = core.rays_per_second.map(|rate| grouped(rate.round() as u64));
        let rate = if least == most { least } else { format!("{least}..{most}") };
        let memory = core.memory_octets.map(|octets| format!("{} octets", grouped(octets as u64))).unwrap_or_default();
        cells.push(vec![core.name.clone(), rate, memory, core.source.clone()]);
    }
    style.table(cells)
}
