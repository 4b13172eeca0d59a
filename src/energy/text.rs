//! Energy and area as tables for people: a ledger by each published table, functions, cores, and the sources of all figures.

use super::{EnergyResult, LedgerLine, TableArea, TableEnergy};
use crate::numeral::grouped;
use crate::table::{row, table};

/// A number of attojoules in nanojoules with three decimals, rounded to the nearest.
fn nano(attojoules: i128) -> String {
    let thousandths = (attojoules.unsigned_abs() + 500_000) / 1_000_000;
    let whole = u64::try_from(thousandths / 1000).unwrap_or(u64::MAX);
    format!("{}{}.{:03}", if attojoules < 0 { "-" } else { "" }, grouped(whole), thousandths % 1000)
}

/// Attojoules in picojoules, exact.
fn pico(attojoules: u64) -> String {
    let text = format!("{}.{:06}", attojoules / 1_000_000, attojoules % 1_000_000);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Number of each source, in the order in which the tables mention them.
struct SourceList(Vec<String>);

impl SourceList {
    fn number(&mut self, formula: &str, source: &str) -> String {
        let text = format!("{formula}; {source}");
        let known = self.0.iter().position(|one| *one == text);
        let at = known.unwrap_or_else(|| {
            self.0.push(text);
            self.0.len() - 1
        });
        format!("[{}]", at + 1)
    }
}

/// Everything that is known of the energy and the area of a frame.
pub fn text(result: &EnergyResult) -> String {
    let summary = &result.summary;
    let mut sources = SourceList(Vec::new());
    let mut text = format!("Energy: {} nJ the frame, {} nJ a pixel", summary.frame_nj, summary.pixel_nj);
    if let Some(ray) = &result.ray_nj {
        text += &format!(", {ray} nJ a ray");
    }
    text += &format!("; energy x delay {} J s\n", summary.energy_delay_js);
    for one in &result.tables {
        text += &decides(one);
    }
    for one in &result.tables {
        text += &format!("\nTable `{}`, {}\n{}", one.table, one.technology, ledger(one, &mut sources));
        if !one.without_figure.is_empty() {
            text += &format!("no published figure, so nothing is counted: {}\n", one.without_figure.join(", "));
        }
    }
    text += &format!(
        "\nNanojoules by function: own instructions and the octets that they asked for\n{}",
        functions(&result.tables)
    );
    for (at, one) in result.areas.iter().enumerate() {
        // A table without areas takes another's, and would say the same again.
        if result.areas[..at].iter().all(|other| other.lines != one.lines) {
            text +=
                &format!("\nArea of a core, {}\n{}", one.technology_of_lines(&result.areas), area(one, &mut sources));
        }
    }
    text += &format!("all cores: {} um2; without main processor, bus and global memory\n\nSources\n", summary.area_um2);
    for (at, source) in sources.0.iter().enumerate() {
        text += &format!("[{}] {source}\n", at + 1);
    }
    text
}

/// Sentence on the larger part.
fn decides(one: &TableEnergy) -> String {
    let share = |part: f64| {
        format!("{part:.3} nJ ({:.1} %)", if one.frame_nj == 0.0 { 0.0 } else { 100.0 * part / one.frame_nj })
    };
    format!(
        "by `{}` {} decide: octets {}, arithmetic {}, registers {}, buffers {}\n",
        one.table,
        if one.decides == "octets" { "octets" } else { "operations" },
        share(one.octets_nj),
        share(one.arithmetic_nj),
        share(one.registers_nj),
        share(one.buffers_nj)
    )
}

fn ledger(one: &TableEnergy, sources: &mut SourceList) -> String {
    let mut rows = vec![row(["item", "bits", "number", "pJ each", "nJ", "share", "source"])];
    let share = |line: &LedgerLine| {
        format!("{:.1} %", 100.0 * line.nanojoules / if one.frame_nj == 0.0 { 1.0 } else { one.frame_nj })
    };
    for line in &one.lines {
        rows.push(vec![
            line.item.to_owned(),
            line.bits.map_or_else(|| "a bit".to_owned(), |bits| bits.to_string()),
            grouped(line.count),
            pico(line.each_attojoules),
            nano(line.attojoules),
            share(line),
            sources.number(&line.formula, &line.source),
        ]);
    }
    rows.push(vec![
        "all".into(),
        String::new(),
        String::new(),
        String::new(),
        nano(one.attojoules),
        "100.0 %".into(),
        String::new(),
    ]);
    table(rows)
}

/// Functions in the order of the first table, a column a table.
fn functions(tables: &[TableEnergy]) -> String {
    let mut head = row(["program", "function"]);
    head.extend(tables.iter().map(|one| one.table.to_owned()));
    let mut rows = vec![head];
    for function in tables.first().map_or(&[][..], |first| &first.functions) {
        let name = if function.name.is_empty() { "(no function)" } else { &function.name };
        let mut cells = vec![function.program.to_owned(), name.to_owned()];
        let is_same =
            |other: &&super::FunctionEnergy| (other.program, &other.name) == (function.program, &function.name);
        cells.extend(
            tables
                .iter()
                .map(|one| one.functions.iter().find(is_same).map_or(String::new(), |found| nano(found.attojoules))),
        );
        rows.push(cells);
    }
    let mut all = row(["all", ""]);
    all.extend(tables.iter().map(|one| nano(one.attojoules)));
    rows.push(all);
    table(rows)
}

impl TableArea {
    /// Names and processes of the tables that come to these lines.
    fn technology_of_lines(&self, areas: &[TableArea]) -> String {
        let same = areas.iter().filter(|other| other.lines == self.lines);
        let names: Vec<String> = same.map(|other| format!("`{}`", other.table)).collect();
        format!("table {}", names.join(" and "))
    }
}

fn area(one: &TableArea, sources: &mut SourceList) -> String {
    let mut rows = vec![row(["item", "bits", "number", "um2 each", "um2", "source"])];
    for line in &one.lines {
        rows.push(vec![
            line.item.to_owned(),
            line.bits.map_or_else(|| "a bit".to_owned(), |bits| bits.to_string()),
            grouped(line.count),
            line.each_um2.to_string(),
            format!("{:.0}", line.um2),
            sources.number(&line.formula, &line.source),
        ]);
    }
    rows.push(vec![
        "core".into(),
        String::new(),
        String::new(),
        String::new(),
        format!("{:.0}", one.core_um2),
        String::new(),
    ]);
    table(rows)
}

/// Spread of attojoules over the pixels, in nanojoules.
pub fn spread(attojoules: &[u64]) -> String {
    let mut sorted = attojoules.to_vec();
    sorted.sort_unstable();
    let last = sorted.len().saturating_sub(1);
    let at = |place: usize| nano(sorted.get(place).copied().unwrap_or(0).into());
    format!("least {}, median {}, largest {} nJ", at(0), at(last / 2), at(last))
}
