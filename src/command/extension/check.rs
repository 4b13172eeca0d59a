//! `lancer extension check`: what is wrong or suspicious in a file of extensions.

use std::path::PathBuf;

use clap::Args;
use isa::{Class, Counts, Isa};
use messages::Report;

use crate::extension::{extend, findings};
use crate::failure::{Exit, Failure};
use crate::numeral::count;
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer extension check slab.isa
  lancer extension check first.isa second.isa   # clashes between files too

Exit codes: 0 the files can be loaded (there may be warnings), 1 they cannot.";

/// Says what is wrong in files of extensions, and what is suspicious.
///
/// Errors: rows that cannot be read, names and words that are taken, bodies that write what they do not own, read what nothing has
/// written, leave a destination unwritten, never end or contain themselves. Warnings: operands without use, outcomes and lines that are
/// never reached, loops, traps, destinations that are written before a source that may be the same register is read, costs below what the body
/// spends.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct CheckArguments {
    /// Files of extensions, which are loaded one after the other.
    #[arg(value_name = "FILE.isa", required = true)]
    files: Vec<PathBuf>,
}

/// Loads, looks and prints.
pub(super) fn execute(arguments: &CheckArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let mut isa = Isa::base();
    for path in &arguments.files {
        // All files go into one set of instructions, so that clashes between them show.
        let (loaded, _) = extend(&mut isa, path)?;
        let warnings: Vec<_> = loaded.iter().flat_map(|loaded| findings(&isa, loaded)).collect();
        let number = warnings.len() as u64;
        terminal.show(&Report(warnings));
        let mut text = format!(
            "{}: {}, {}\n",
            path.display(),
            count(loaded.len() as u64, "instruction", "instructions"),
            count(number, "warning", "warnings")
        );
        for loaded in &loaded {
            text += &format!("  {}\n", isa.definition(loaded.op).line());
            // A meaning is written in Rust, as a body of instructions, or both; only of a body it is known what it spends.
            if loaded.is_rust {
                text += "    meaning in Rust: a program of yours attaches and runs it\n";
            }
            if isa.body(loaded.op).is_none() {
                continue;
            }
            let steps = isa.body(loaded.op).map_or(0, |body| {
                body.steps.iter().filter(|step| matches!(step.act, isa::extension::BodyAct::Execute { .. })).count()
                    as u64
            });
            let beside = if loaded.is_rust { "beside it a body: " } else { "" };
            text += &format!(
                "    {beside}{}, together {}\n",
                count(steps, "instruction", "instructions"),
                spent(&isa, loaded.op)
            );
        }
        terminal.tell(&text)?;
    }
    Ok(Exit::Done)
}

/// Cost of all instructions of a body together, each once.
fn spent(isa: &Isa, op: isa::Op) -> String {
    let mut sum = Counts::ZERO;
    for step in isa.body(op).iter().flat_map(|body| &body.steps) {
        if let isa::extension::BodyAct::Execute { instruction, .. } = step.act {
            sum += isa.definition(instruction.op).outcomes[0].cost;
        }
    }
    let parts = Class::ALL.iter().filter(|class| sum[**class] != 0);
    let parts: Vec<String> = parts.map(|&class| format!("{} {}", class.name(), sum[class])).collect();
    if parts.is_empty() { "nothing".to_owned() } else { parts.join(", ") }
}
