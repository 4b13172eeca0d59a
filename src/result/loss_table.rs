//! Losses as a table for people.

use super::Loss;
use crate::numeral::grouped;
use crate::table::{row, table};

/// Rows of the table for people.
const SHOWN: usize = 20;

/// The table for people: what overflowed most first, then what was quantized most.
pub fn loss_table(losses: &[Loss]) -> String {
    if losses.is_empty() {
        return "no result lost anything\n".into();
    }
    let mut sorted: Vec<&Loss> = losses.iter().collect();
    sorted.sort_by_key(|loss| std::cmp::Reverse((loss.overflowed, loss.quantized)));
    let mut rows = vec![row(["place", "instruction", "executed", "quantized", "overflowed"])];
    rows.extend(sorted.iter().take(SHOWN).map(|loss| {
        let place = loss.place.clone().unwrap_or_else(|| format!("word {}", loss.pc));
        let numbers = [loss.executed, loss.quantized, loss.overflowed].map(grouped);
        [vec![place, loss.instruction.clone()], numbers.to_vec()].concat()
    }));
    let more = match losses.len().saturating_sub(SHOWN) {
        0 => String::new(),
        more => format!("and {} more: see --json\n", grouped(more as u64)),
    };
    format!("Results that lost bits or did not fit\n{}{more}", table(rows))
}
