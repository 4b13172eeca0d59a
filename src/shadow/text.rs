//! Shadows of a run as text: where precision died, and the errors by line and function.

use super::numbers::{real_text, ulps};
use super::result::{DiedLine, ShadowLine, ShadowResult};
use crate::numeral::{count, grouped};
use crate::table::{row, table};

/// Rows of the ranking.
const RANKED: usize = 10;

/// Rows of the table of lines.
const LINES: usize = 20;

/// Numbers at the end that are shown.
const OUTPUTS: usize = 5;

/// Characters of a source line that a table shows.
const SOURCE: usize = 40;

fn shortened(text: &str) -> String {
    match text.char_indices().nth(SOURCE) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

fn real(value: f64) -> String {
    if value == 0.0 { String::new() } else { format!("{value:.2e}") }
}

fn share(part: f64) -> String {
    format!("{:.1} %", 100.0 * part)
}

fn function(name: Option<&str>, is_main: bool) -> String {
    let name = name.unwrap_or("(no function)");
    if is_main { format!("{name} (main)") } else { name.to_owned() }
}

/// The line, and behind it that of the macro that it calls.
fn shown_place(place: &str, macro_place: Option<&str>) -> String {
    macro_place.map_or_else(|| place.to_owned(), |inner| format!("{place} ({inner})"))
}

/// The ranking of lines by their share of the final errors.
pub fn died_table(died: &[DiedLine], other_share: f64) -> String {
    if died.is_empty() {
        return "where precision died: nowhere, the results are exact\n".into();
    }
    let has_turned = died.iter().take(RANKED).any(|line| line.turned_by != 0);
    let mut rows = vec![row(["rank", "share", "largest, ulp", "line", "function", "source"])];
    rows.extend((1..).zip(died).take(RANKED).map(|(rank, line): (usize, &DiedLine)| {
        vec![
            rank.to_string(),
            share(line.share),
            ulps(line.largest_ulps),
            shown_place(&line.place, line.macro_place.as_deref()),
            function(line.function.as_deref(), line.is_main),
            shortened(&line.source),
        ]
    }));
    // Decisions have a column only where errors turned some.
    if has_turned {
        let turned = std::iter::once("turned".to_owned()).chain(died.iter().map(|line| grouped(line.turned_by)));
        rows.iter_mut().zip(turned).for_each(|(row, turned)| row.insert(3, turned));
    }
    let more = match died.len().saturating_sub(RANKED) {
        0 => String::new(),
        more => {
            let left: f64 = died.iter().skip(RANKED).map(|line| line.share).sum();
            format!("and {} with {}: see --json\n", count(more as u64, "line", "lines"), share(left))
        }
    };
    let other = if other_share == 0.0 {
        String::new()
    } else {
        format!("lines too small to be followed: {}\n", share(other_share))
    };
    format!("where precision died\n{}{more}{other}", table(rows))
}

/// Lines that deserve a sentence: contradictions, cancellation, decisions.
fn remarks(lines: &[ShadowLine]) -> String {
    let mut text = String::new();
    // Name all contradictions of formats, and all results of which exact arithmetic itself knows little
    for line in lines {
        if let Some(gap) = line.format_gap {
            text += &format!(
                "{}: the shift gives {} fraction bits, but `.holds` says {}: `{}`\n",
                shown_place(&line.place, line.macro_place.as_deref()),
                gap.computed,
                gap.declared,
                line.source
            );
        }
        if line.doubtful != 0 {
            text += &format!(
                "{}: cancellation leaves exact arithmetic itself fewer than 20 good bits in {}\n",
                line.place,
                count(line.doubtful, "result", "results")
            );
        }
    }
    // Cancellation is common, so only the worst lines are named.
    let mut cancelled: Vec<&ShadowLine> = lines.iter().filter(|line| line.cancelled != 0).collect();
    cancelled.sort_by(|a, b| a.fewest_good_bits.unwrap_or(0.0).total_cmp(&b.fewest_good_bits.unwrap_or(0.0)));
    for line in cancelled.into_iter().take(OUTPUTS) {
        text += &format!(
            "{}: cancellation leaves fewer than 20 good bits in {}, {:.0} at least\n",
            line.place,
            count(line.cancelled, "result", "results"),
            line.fewest_good_bits.unwrap_or(0.0)
        );
    }
    text
}

fn line_table(lines: &[ShadowLine]) -> String {
    let is_wrong = |line: &&ShadowLine| line.brought_ulps != 0.0 || line.turned != 0 || line.saturated != 0;
    let mut wrong: Vec<&ShadowLine> = lines.iter().filter(is_wrong).collect();
    if wrong.is_empty() {
        return "every result is exact\n".into();
    }
    wrong.sort_by(|a, b| b.brought_ulps.total_cmp(&a.brought_ulps));
    let mut rows =
        vec![row(["line", "brought in, ulp", "as a value", "arrived, ulp", "as a value", "saturated", "turned"])];
    rows.extend(wrong.iter().take(LINES).map(|line| {
        vec![
            shown_place(&line.place, line.macro_place.as_deref()),
            ulps(line.brought_ulps),
            real(line.brought),
            ulps(line.arrived_ulps),
            real(line.arrived),
            grouped(line.saturated),
            grouped(line.turned),
        ]
    }));
    let more = match wrong.len().saturating_sub(LINES) {
        0 => String::new(),
        more => format!("and {} more: see --json\n", grouped(more as u64)),
    };
    format!(
        "largest errors by line, and decisions that exact arithmetic would have taken otherwise\n{}{more}",
        table(rows)
    )
}

fn function_table(result: &ShadowResult) -> String {
    let mut functions: Vec<_> = result.functions.iter().filter(|f| f.brought_ulps != 0.0 || f.turned != 0).collect();
    functions.sort_by(|a, b| b.share.total_cmp(&a.share));
    let mut rows = vec![row([
        "function",
        "share",
        "brought in, ulp",
        "as a value",
        "arrived, ulp",
        "as a value",
        "saturated",
        "turned",
    ])];
    rows.extend(functions.into_iter().map(|f| {
        vec![
            function(f.function.as_deref(), f.is_main),
            share(f.share),
            ulps(f.brought_ulps),
            real(f.brought),
            ulps(f.arrived_ulps),
            real(f.arrived),
            grouped(f.saturated),
            grouped(f.turned),
        ]
    }));
    if rows.len() == 1 { String::new() } else { format!("largest errors by function\n{}", table(rows)) }
}

fn output_text(result: &ShadowResult) -> String {
    let mut text = String::new();
    for output in result.outputs.iter().take(OUTPUTS) {
        let (machine, exact) = match (output.real, output.exact_real) {
            (Some(machine), Some(exact)) => (real_text(machine), real_text(exact)),
            _ => (output.raw.to_string(), real_text(output.exact)),
        };
        text += &format!(
            "{}: {machine}, exactly {exact}: error {} ulp, {:.0} good bits\n",
            output.name,
            ulps(output.error_ulps),
            output.good_bits
        );
    }
    text
}

/// The whole shadow for people.
pub fn shadow_text(result: &ShadowResult) -> String {
    let head = format!(
        "shadow: {} of {} differ from exact arithmetic, by {} ulp at most and {} on average (root mean square); \
         {} of {} turned\n",
        grouped(result.different),
        count(result.compared, "number", "numbers"),
        ulps(result.largest_ulps),
        ulps(result.root_mean_square_ulps),
        grouped(result.turned),
        count(result.decisions, "decision", "decisions"),
    );
    let parts = [
        head + &output_text(result),
        died_table(&result.where_precision_died, result.other_share),
        line_table(&result.lines),
        function_table(result),
        remarks(&result.lines),
    ];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n")
}
