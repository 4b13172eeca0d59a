//! `lancer arithmetic`: the emulator's arithmetic held against vectors from elsewhere.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use conformance::{OperationOutcome, TestVector};
use messages::Diagnostic;
use schemars::JsonSchema;
use serde::Serialize;

use super::invocation::CommandSettings;
use crate::arguments::SettingsArguments;
use crate::failure::{Exit, Failure};
use crate::numeral::{count, grouped};
use crate::result::WithSettings;
use crate::settings::hash;
use crate::terminal::Terminal;
use crate::{files, result};

/// Version of [`CheckedFile`].
pub(super) const SCHEMA: &str = "lancer-arithmetic-1";

/// Most mismatches that are listed unless the user says otherwise.
const MOST_LISTED: &str = "100";

const EXAMPLES: &str = "\
Examples:
  lancer arithmetic check vectors.csv
  lancer arithmetic check vectors.csv --json --most 1000

The file's first line is
  op,sa,wa,ia,a,sb,wb,ib,b,sc,wc,ic,c,sr,wr,ir,q,o,n,r,qf,of
and each further line a vector: the operation (cvt, neg, add, sub, mul, div, or mac for a * b + c
with one rounding); for each operand and the result s or u, bits of the word (1 to 64), integer
bits with the sign (-64 to 128; fraction = word - integer) and the raw number; rounding and
overflow mode; saturated bits of WRAP and WRAP_SM; raw result; quantization and overflow flag.
What is absent is written as -.

Exit codes: 0 all agree, 1 a line is no vector, 4 a result differs.";

/// The arithmetic by itself: fixed-point numbers of IEEE 1666 (SystemC).
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  lancer arithmetic check vectors.csv")]
pub struct CheckedArithmeticArguments {
    #[command(subcommand)]
    command: ArithmeticCommand,
}

#[derive(Subcommand, Clone, Debug)]
enum ArithmeticCommand {
    Check(ArithmeticCheckArguments),
}

/// Computes the vectors of a file exactly and says which results differ.
///
/// The results come from the model that the machine's own arithmetic is tested against. A quotient is exact and
/// quantized once; x / 0 saturates with the sign of x in every mode, 0 / 0 is 0, and both set the overflow flag.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
struct ArithmeticCheckArguments {
    /// Vectors as comma-separated values.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Most mismatches that are listed one by one.
    #[arg(long, value_name = "N", default_value = MOST_LISTED)]
    most: usize,
    #[command(flatten)]
    settings: SettingsArguments,
    /// Prints the result as JSON.
    #[arg(long)]
    json: bool,
}

/// A result and its flags.
#[derive(Clone, Debug, Serialize, JsonSchema)]
struct Claim {
    /// Raw number; a string, since it may have more bits than a double.
    raw: String,
    /// True where bits below the last place were lost; null where the vector does not say.
    quantized: Option<bool>,
    /// True where the quantized number did not fit; null where the vector does not say.
    overflowed: Option<bool>,
}

/// A vector whose result differs.
#[derive(Clone, Debug, Serialize, JsonSchema)]
struct Mismatch {
    /// Line of the file, from 1.
    line: usize,
    /// Name of the operation.
    operation: &'static str,
    /// Result in the vector.
    expected: Claim,
    /// Result of the operation.
    found: Claim,
}

/// Outcome of a file of vectors.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(super) struct CheckedFile {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    schema: &'static str,
    /// Path of the file as the user gave it.
    file: String,
    /// Vectors that were computed.
    vectors: usize,
    /// Vectors whose result differs.
    mismatches: usize,
    /// The first of them.
    listed: Vec<Mismatch>,
}

/// Executes the subcommand.
pub(super) fn execute(
    arguments: &CheckedArithmeticArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    match &arguments.command {
        ArithmeticCommand::Check(arguments) => check(arguments, given, terminal),
    }
}

fn check(
    arguments: &ArithmeticCheckArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    let source = files::source(&arguments.file)?;
    let (vectors, report) = conformance::parse(&source);
    if vectors.is_empty() && !report.has_errors() {
        let message = Diagnostic::error(format!("{} has no vectors", source.name));
        return Err(message.hint("`lancer arithmetic check --help` shows their form").into());
    }
    let outcomes = vectors.iter().map(|vector| (vector, vector.outcome()));
    let wrong: Vec<_> = outcomes.filter(|(vector, outcome)| !vector.expects(outcome)).collect();
    let checked = CheckedFile {
        schema: SCHEMA,
        file: source.name.clone(),
        vectors: vectors.len(),
        mismatches: wrong.len(),
        listed: wrong.iter().take(arguments.most).map(|(vector, outcome)| mismatch(vector, outcome)).collect(),
    };
    // A file of mistakes is not one on which all agree; what differs is shown beside them.
    if report.has_errors() && checked.mismatches == 0 {
        return Err(report.into());
    }
    let settings = given.clone().with_hash(hash::texts([source.text.as_str()]));
    match arguments.json {
        true => terminal.print(&result::json(&WithSettings::new(&checked, settings)))?,
        false => terminal.tell(&text(&checked))?,
    }
    match (report.has_errors(), checked.mismatches) {
        (true, _) => Err(report.into()),
        (false, 0) => Ok(Exit::Done),
        (false, _) => Ok(Exit::Tolerance),
    }
}

fn mismatch(vector: &TestVector, outcome: &OperationOutcome) -> Mismatch {
    Mismatch {
        line: vector.line,
        operation: vector.operation.name(),
        expected: Claim {
            raw: vector.raw.to_string(),
            quantized: vector.is_quantized,
            overflowed: vector.has_overflowed,
        },
        found: Claim {
            raw: outcome.raw.to_string(),
            quantized: Some(outcome.is_quantized),
            overflowed: Some(outcome.has_overflowed),
        },
    }
}

fn text(checked: &CheckedFile) -> String {
    let mut text = String::new();
    for Mismatch { line, operation, expected, found } in &checked.listed {
        let (expected, found) = (claim(expected), claim(found));
        text += &format!("{}:{line}: {operation}: expected {expected}; found {found}\n", checked.file);
    }
    let more = checked.mismatches - checked.listed.len();
    if more != 0 {
        text += &format!("and {} more\n", grouped(more as u64));
    }
    text + &format!(
        "{}: {}, {}\n",
        checked.file,
        count(checked.vectors as u64, "vector", "vectors"),
        match checked.mismatches {
            0 => "all agree".to_owned(),
            wrong => count(wrong as u64, "mismatch", "mismatches"),
        }
    )
}

fn claim(claim: &Claim) -> String {
    let flag = |flag: Option<bool>| flag.map_or("-", |is_set| if is_set { "1" } else { "0" });
    format!("{} (qf {}, of {})", claim.raw, flag(claim.quantized), flag(claim.overflowed))
}
