//! Advice as tables for people, and as comma-separated values for other programs.

use super::{Advice, AdviceResult, Prediction};
use crate::csv;
use crate::energy::FigureRange;
use crate::numeral::grouped;
use crate::table::{row, table};

/// Changes that are shown where not all of them are asked for.
const SHOWN: usize = 10;

/// Pairs that are shown beside the best one.
const SHOWN_PAIRS: usize = 3;

/// Heads of the columns.
const HEAD: [&str; 9] = ["change", "us a pixel", "times", "bus %", "limit then", "closed", "queue", "memory", "mm2"];

/// Remarks on columns and marks.
const REMARKS: &str = "\
us a pixel: runs of the changed machine; closed and queue: the closed form and the queueing estimate
memory: octets in all cores; mm2: area of all cores by published tables, which weigh neither bus nor arbiter (docs/energy.md)
+ not from the machine's recording: operations take other clocks, or another picture is in memory; ~ other colours
";

/// The sentence on the machine, the best changes and pairs, and what to write to make them.
pub fn text(result: &AdviceResult, is_whole: bool) -> String {
    let [shown, shown_pairs] = if is_whole { [usize::MAX; 2] } else { [SHOWN, SHOWN_PAIRS] };
    let advice = &result.advice[..shown.min(result.advice.len())];
    let pairs = &result.pairs[..shown_pairs.min(result.pairs.len())];
    let mut rows = vec![row(HEAD), cells("as it is", &result.now, None)];
    rows.extend(advice.iter().map(|advice| cells(&advice.change, &advice.predicted, Some(advice))));
    let mut text = format!("{}\n\n{}{}", result.verdict, title(result), table(rows));
    let left = result.advice.len() - advice.len();
    if left != 0 {
        text += &format!("{left} more with --all\n");
    }
    if !pairs.is_empty() {
        let mut rows = vec![row(HEAD)];
        rows.extend(pairs.iter().map(|pair| cells(&pair.change, &pair.predicted, Some(pair))));
        text += &format!("\nThe best two together\n{}", table(rows));
    }
    text += "\nKeys for the machine's file or for --set, options for the command\n";
    for advice in pairs.iter().take(1).chain(advice) {
        text += &format!("  {}: {}{}\n", advice.change, changed(advice), price(advice));
    }
    for refused in result.refused.iter().filter(|_| is_whole) {
        text += &format!("  not tried: {}: {}\n", refused.change, refused.reason);
    }
    text + REMARKS
}

fn title(result: &AdviceResult) -> String {
    format!(
        "{}: {} x {} pixels on machine `{}`, {} clocks\n",
        result.scene,
        result.width,
        result.height,
        result.machine,
        grouped(result.now.clocks)
    )
}

/// A row; two changes stand one below the other.
fn cells(name: &str, predicted: &Prediction, advice: Option<&Advice>) -> Vec<String> {
    let marks = advice.map_or(String::new(), |advice| {
        let built = if advice.basis == "replay" { "" } else { " +" };
        format!("{built}{}", if advice.changes_picture { " ~" } else { "" })
    });
    vec![
        format!("{}{marks}", name.replace(" + ", ",\n")),
        microseconds(predicted.pixel_seconds),
        advice.map_or(String::new(), |advice| format!("{:.2}", advice.speed_up)),
        format!("{:.1}", 100.0 * predicted.utilisation),
        predicted.limit.name().to_owned(),
        microseconds(predicted.closed_form_pixel_seconds),
        microseconds(predicted.queueing_pixel_seconds),
        advice.map_or(String::new(), |advice| octets(advice.price.local_octets)),
        advice.and_then(|advice| advice.price.area_um2).map_or(String::new(), square_millimetres),
    ]
}

/// More area in square millimetres with its sign, or the range of that where tables disagree.
fn square_millimetres(area: FigureRange) -> String {
    let number = |um2: f64| if um2 == 0.0 { "0".to_owned() } else { format!("{:+.3}", 1e-6 * um2) };
    match (number(area.least), number(area.most)) {
        (least, most) if least == most => least,
        (least, most) => format!("{least} to {most}"),
    }
}

fn microseconds(seconds: f64) -> String {
    format!("{:.2}", 1e6 * seconds)
}

/// Octets with their sign: `+16,384`, `-300`, `0`.
fn octets(number: i64) -> String {
    match number {
        0 => "0".to_owned(),
        _ => format!("{}{}", if number < 0 { '-' } else { '+' }, grouped(number.unsigned_abs())),
    }
}

/// Keys and options of a change.
fn changed(advice: &Advice) -> String {
    advice.toml.iter().chain(&advice.options).cloned().collect::<Vec<_>>().join("; ")
}

fn price(advice: &Advice) -> String {
    let mut parts = Vec::new();
    if advice.price.global_octets != 0 {
        parts.push(format!("{} octets of global memory", octets(advice.price.global_octets)));
    }
    if !advice.price.hardware.is_empty() {
        parts.push(advice.price.hardware.clone());
    }
    if parts.is_empty() { String::new() } else { format!("  (takes {})", parts.join(", ")) }
}

/// A column of the comma-separated values: its head and what it holds.
type AdviceColumn = (&'static str, fn(&Advice) -> String);

const COLUMNS: [AdviceColumn; 21] = [
    ("change", |advice| csv::quoted(&advice.change)),
    ("parts", |advice| csv::quoted(&advice.parts.join(" "))),
    ("toml", |advice| csv::quoted(&advice.toml.join("; "))),
    ("options", |advice| csv::quoted(&advice.options.join(" "))),
    ("basis", |advice| advice.basis.to_owned()),
    ("clocks", |advice| advice.predicted.clocks.to_string()),
    ("seconds", |advice| advice.predicted.seconds.to_string()),
    ("pixel_seconds", |advice| advice.predicted.pixel_seconds.to_string()),
    ("speed_up", |advice| advice.speed_up.to_string()),
    ("utilisation", |advice| advice.predicted.utilisation.to_string()),
    ("waiting", |advice| advice.predicted.waiting.to_string()),
    ("idle", |advice| advice.predicted.idle.to_string()),
    ("main_busy", |advice| advice.predicted.main_busy.to_string()),
    ("limit", |advice| advice.predicted.limit.name().to_owned()),
    ("closed_form_pixel_seconds", |advice| advice.predicted.closed_form_pixel_seconds.to_string()),
    ("queueing_pixel_seconds", |advice| advice.predicted.queueing_pixel_seconds.to_string()),
    ("local_octets", |advice| advice.price.local_octets.to_string()),
    ("global_octets", |advice| advice.price.global_octets.to_string()),
    ("area_um2_least", |advice| advice.price.area_um2.map_or(String::new(), |area| area.least.to_string())),
    ("area_um2_most", |advice| advice.price.area_um2.map_or(String::new(), |area| area.most.to_string())),
    ("hardware", |advice| csv::quoted(&advice.price.hardware)),
];

/// One line a change, then one a pair, with a head; the columns have the names of the JSON's keys.
pub fn csv(result: &AdviceResult) -> String {
    let rows = result.advice.iter().chain(&result.pairs);
    csv::lines(COLUMNS.map(|(name, _)| name), rows.map(|advice| COLUMNS.map(|(_, value)| value(advice))))
}
