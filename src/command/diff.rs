//! `lancer diff`: what differs between two results, or two files of settings.

use std::path::{Path, PathBuf};

use clap::Args;
use messages::{Diagnostic, Report};
use serde_json::Value;

use crate::difference::{self, DiffPart, DiffResult, DiffSide};
use crate::failure::{Exit, Failure};
use crate::numeral::count;
use crate::table::{row, table};
use crate::terminal::Terminal;
use crate::{files, result};

const EXAMPLES: &str = "\
Examples:
  lancer render cornell --json > a.json && lancer render cornell --word 24 --json > b.json
  lancer diff a.json b.json                     # all that differs, in per cent
  lancer diff a.json b.json --tolerance 0.5     # exit code 4 beyond half a per cent
  lancer diff a.json b.json --only clocks,error
  lancer diff mine.toml yours.toml --json       # two machines, or two files of settings
  lancer render cornell --json | lancer diff before.json -

Exit codes: 0 nothing differs by more than the tolerance, 1 errors in the input, 2 usage,
4 something does.";

/// Says what differs between two results (--json), or between two files of settings: settings, counts, clocks, error.
///
/// Of two results, settings are shown and do not count for the exit code, since they say why the rest differs; with a
/// tolerance above 0, hashes do not count either. Times of the host are left out. Lists are compared by the names of what is
/// in them. A change from 0 is beyond every tolerance.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct DiffArguments {
    /// First file: a result as JSON, or settings as JSON or TOML.
    #[arg(value_name = "A")]
    a: PathBuf,
    /// Second file, of the same kind.
    #[arg(value_name = "B")]
    b: PathBuf,
    /// Change of a number that is allowed, in per cent of the first.
    #[arg(long, value_name = "PERCENT", value_parser = tolerance, default_value = "0", allow_hyphen_values = true)]
    tolerance: f64,
    /// Parts that are compared [default: all].
    #[arg(long, value_name = "PART,..", value_delimiter = ',', value_parser = part)]
    only: Vec<DiffPart>,
    /// Prints the differences as JSON.
    #[arg(long)]
    json: bool,
}

pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches('%').trim_end().parse::<f64>().ok();
    let number = number.filter(|number| number.is_finite() && *number >= 0.0);
    number.ok_or_else(|| "a number of per cent from 0 on is expected".to_owned())
}

fn part(text: &str) -> Result<DiffPart, String> {
    let names: Vec<&str> = DiffPart::ALL.iter().map(|part| part.name()).collect();
    let found = DiffPart::ALL.into_iter().find(|part| part.name() == text);
    found.ok_or_else(|| format!("the parts are {}", names.join(", ")))
}

/// The contents of a file: JSON, or TOML where the name or the first character says so.
pub(super) fn read(path: &Path) -> Result<Value, Report> {
    difference::parse(&files::source(path)?)
}

/// Reads, compares and prints.
pub(super) fn execute(arguments: &DiffArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let (a, b) = (read(&arguments.a)?, read(&arguments.b)?);
    let [schema_a, schema_b] = [&a, &b].map(|value| value.get("schema").and_then(Value::as_str));
    if schema_a != schema_b {
        let kind = |schema: Option<&str>| schema.unwrap_or("a file of settings").to_owned();
        let message = format!("{} and {} are not of one kind", files::shown(&arguments.a), files::shown(&arguments.b));
        let hint = format!("the first is {}, the second {}", kind(schema_a), kind(schema_b));
        return Err(Diagnostic::error(message).hint(hint).into());
    }
    let [side_a, side_b] =
        [(&arguments.a, &a), (&arguments.b, &b)].map(|(path, value)| DiffSide { name: files::shown(path), value });
    let mut found = difference::compare(&side_a, &side_b, arguments.tolerance);
    if !arguments.only.is_empty() {
        found.differences.retain(|difference| arguments.only.contains(&difference.part));
        found.is_within = found.differences.iter().all(|difference| difference.is_within);
    }
    match arguments.json {
        true => terminal.print(&result::json(&found))?,
        false => terminal.tell(&text(&found))?,
    }
    Ok(if found.is_within { Exit::Done } else { Exit::Tolerance })
}

/// A value as a table shows it.
fn shown(value: &Value) -> String {
    match value {
        Value::Null => "-".to_owned(),
        // Hashes are told apart by their first digits.
        Value::String(text) if text.len() > 16 && text.bytes().all(|c| c.is_ascii_hexdigit()) => text[..12].to_owned(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

fn text(found: &DiffResult) -> String {
    let mut text = String::new();
    for part in DiffPart::ALL {
        let rows: Vec<Vec<String>> = found
            .differences
            .iter()
            .filter(|difference| difference.part == part)
            .map(|difference| {
                let change = difference.percent.map_or("differs".to_owned(), |percent| format!("{percent:+.2} %"));
                let mark = if difference.is_within { "" } else { " *" };
                vec![difference.key.clone(), shown(&difference.a), shown(&difference.b), change + mark]
            })
            .collect();
        if !rows.is_empty() {
            let head = row([part.name(), "A", "B", "change"]);
            text += &(table(std::iter::once(head).chain(rows)) + "\n");
        }
    }
    let beyond = found.differences.iter().filter(|difference| !difference.is_within).count() as u64;
    text + &format!(
        "{} of {} differ; {} beyond the tolerance of {} %{}\n",
        found.differences.len(),
        count(found.compared as u64, "key", "keys"),
        beyond,
        found.tolerance,
        if beyond == 0 { "" } else { " (*)" },
    )
}
