//! Suspicious things in extension instructions that can be loaded.

use std::collections::BTreeMap;

use asm::extension::LoadedInstruction;
use isa::extension::{Body, BodyAct, Summary};
use isa::{Class, Counts, Isa};
use messages::Diagnostic;

/// Likely mistakes in an instruction that was loaded, and what should be known before one is built.
pub fn findings(isa: &Isa, loaded: &LoadedInstruction) -> Vec<Diagnostic> {
    let row = isa.definition(loaded.op);
    let warning = |message: String, label: &str| Diagnostic::warning(message).at(loaded.row.clone(), label);
    let mut found = Vec::new();
    if row.doc.trim().is_empty() {
        let message = format!("`{}` has no description", row.name);
        found.push(warning(message, "its row").hint("lines that begin with `;;` before it are what the manual shows"));
    }
    let Some(body) = isa.body(loaded.op) else { return found };
    let summary = &loaded.summary;
    let at = |step: usize, message: String, label: &str| match body.place(step) {
        Some(place) => Diagnostic::warning(message).at(place, label),
        None => Diagnostic::warning(message),
    };
    for letter in &summary.unused {
        let message = format!("operand `{}` of `{}` is not used", *letter as char, row.name);
        found.push(warning(message, "an operand of it").hint("leave it out: its bits are free for more"));
    }
    for (written, read) in body.overwritten(row, isa) {
        let (written, read) = (written as char, read as char);
        let message = format!("`{}` writes `{written}` before it has read `{read}` for the last time", row.name);
        let hint = format!("where both are one register, it still reads what `{read}` was: a unit has to keep that");
        found.push(warning(message, "they may be one register").hint(hint));
    }
    for (outcome, is_reached) in summary.outcomes.iter().enumerate() {
        if !is_reached {
            let message = format!("the outcome `{}` of `{}` is never taken", row.outcomes[outcome].name, row.name);
            found.push(Diagnostic::warning(message).at(loaded.outcomes[outcome].clone(), "not reached"));
        }
    }
    if let Some(step) = summary.reached.iter().position(|is_reached| !is_reached) {
        // A fused outcome that the assembler added is no line of the user's.
        if matches!(body.steps[step].act, BodyAct::Execute { .. }) {
            found.push(at(step, format!("a line of the body of `{}` is never reached", row.name), "not reached"));
        }
    }
    if let Some(step) = summary.repeats {
        let message = format!("the body of `{}` has a loop: it takes as long as its operands say", row.name);
        found.push(at(step, message, "may come again").hint("the step limit of a work item counts each pass"));
    }
    if let Some(&step) = summary.faults.first() {
        let message = format!("the body of `{}` may trap", row.name);
        found.push(at(step, message, "an access outside of memory, or `trap`"));
    }
    if let Some(&step) = summary.divisions.first() {
        let message = format!("the body of `{}` divides: by zero, that traps where the machine says so", row.name);
        found.push(at(step, message, "here"));
    }
    found.extend(cheap(isa, loaded, summary, body));
    found
}

/// Exits that declare less than the body spends at least.
fn cheap(isa: &Isa, loaded: &LoadedInstruction, summary: &Summary, body: &Body) -> Vec<Diagnostic> {
    let row = isa.definition(loaded.op);
    if row.outcomes.iter().any(|outcome| outcome.is_body) {
        return Vec::new();
    }
    let least = least(isa, summary, body);
    let mut found = Vec::new();
    for (number, outcome) in row.outcomes.iter().enumerate() {
        let Some(least) = least.get(&number) else { continue };
        let lower: Vec<String> = (Class::ALL.iter())
            .filter(|class| class.is_elementary() || matches!(class, Class::Mem | Class::Octet))
            .filter(|&&class| outcome.cost[class] < least[class])
            .map(|&class| format!("{} {} instead of {}", class.name(), outcome.cost[class], least[class]))
            .collect();
        if !lower.is_empty() {
            let message =
                format!("`{}` of `{}` costs less than its body spends: {}", outcome.name, row.name, lower.join(", "));
            let hint = "a unit may be cheaper; its description should say why";
            found.push(Diagnostic::warning(message).at(loaded.outcomes[number].clone(), "declared here").hint(hint));
        }
    }
    found
}

/// The least that the body spends of each class on its ways to each outcome, class by class.
fn least(isa: &Isa, summary: &Summary, body: &Body) -> BTreeMap<usize, Counts> {
    let mut spent: Vec<Option<Counts>> = vec![None; body.steps.len()];
    spent[0] = Some(Counts::ZERO);
    // Costs only fall, so this ends: no step can become cheaper than nothing.
    let mut open = vec![0];
    while let Some(step) = open.pop() {
        let before = spent[step].expect("what is open has been reached");
        let cost = match body.steps[step].act {
            BodyAct::Execute { instruction, .. } => {
                isa.definition(instruction.op).outcomes.iter().map(|outcome| outcome.cost).reduce(lower)
            }
            BodyAct::End { .. } => None,
        };
        let after = before + cost.unwrap_or(Counts::ZERO);
        for next in body.successors(step, isa) {
            let merged = spent[next].map_or(after, |other| lower(other, after));
            if spent[next] != Some(merged) {
                spent[next] = Some(merged);
                open.push(next);
            }
        }
    }
    let mut least: BTreeMap<usize, Counts> = BTreeMap::new();
    for (step, is_reached) in summary.reached.iter().enumerate() {
        let (BodyAct::End { outcome, .. }, true, Some(spent)) = (body.steps[step].act, *is_reached, spent[step]) else {
            continue;
        };
        let entry = least.entry(outcome.into()).or_insert(spent);
        *entry = lower(*entry, spent);
    }
    least
}

/// The lower number of each class.
fn lower(a: Counts, b: Counts) -> Counts {
    Counts(std::array::from_fn(|at| a.0[at].min(b.0[at])))
}
