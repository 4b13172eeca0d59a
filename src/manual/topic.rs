//! One topic of the manual for the terminal: an instruction with its operands, costs and example, a pseudo-instruction, a directive or a
//! function of expressions.

use std::fmt::Write;

use asm::directive::{DIRECTIVES, Directive};
use asm::function::FUNCTIONS;
use asm::pseudo::PSEUDOS;
use isa::definition::Operand;
use isa::{InstructionDef, Isa};

use super::examples;

/// Names of all topics, in the order of the manual.
pub fn names(isa: &Isa) -> Vec<String> {
    let instructions = isa.ops().map(|op| isa.definition(op).name.to_string());
    let pseudos = PSEUDOS.iter().map(|pseudo| pseudo.name.to_owned());
    let directives = DIRECTIVES.iter().map(|directive| directive.name.to_owned());
    instructions
        .chain(pseudos)
        .chain(directives)
        .chain(FUNCTIONS.iter().map(|function| function.name.to_owned()))
        .collect()
}

/// The page of a topic, with a line end at its end; `None` for a name that is none.
pub fn page(name: &str, isa: &Isa) -> Option<String> {
    if let Some(op) = isa.find(name) {
        return Some(instruction(isa.definition(op)));
    }
    if let Some(pseudo) = PSEUDOS.iter().find(|pseudo| pseudo.name == name) {
        let mut text = format!("{}    (pseudo-instruction)\n\n{}\n", pseudo.usage(), pseudo.doc);
        for form in pseudo.forms {
            let _ = writeln!(text, "\n  {}", form.lines.join("\n  "));
        }
        return Some(text);
    }
    if let Some(directive) = asm::directive::find(name) {
        let Directive { name, also, operands, doc, .. } = directive;
        let also = if also.is_empty() { String::new() } else { format!("\nalso written {}\n", also.join(", ")) };
        return Some(format!("{}    (directive)\n\n{doc}\n{also}", format!("{name} {operands}").trim_end()));
    }
    let function = FUNCTIONS.iter().find(|function| function.name == name)?;
    Some(format!("{}    (function of expressions)\n\n{}\n", function.usage, function.doc))
}

/// Access to an operand, by its letter.
fn access(operand: &Operand) -> &'static str {
    match (operand.is_read(), operand.is_written()) {
        (true, true) => "read and written",
        (true, false) => "read",
        (false, true) => "written",
        (false, false) => "immediate",
    }
}

fn instruction(row: &InstructionDef) -> String {
    let mut text = format!("{}    ({})\n\n", asm::usage(row), row.room);
    for line in row.doc.lines() {
        let _ = writeln!(text, "{}", line.trim());
    }
    if !row.operands.is_empty() {
        text.push_str("\noperands:\n");
    }
    for operand in row.operands.iter() {
        // Immediates have a range; the kind of a register says by itself which there are.
        let range = match operand.kind.width() {
            Some(width) if operand.kind.register_file().is_none() => {
                let (least, most) = operand.kind.range(width);
                format!(", {least} to {most}")
            }
            _ => String::new(),
        };
        let (letter, kind) = (operand.letter as char, asm::describe(operand.kind));
        let _ = writeln!(text, "  {letter}  {:<16}  {:<4}  {kind}{range}", access(operand), operand.kind.name());
    }
    text.push_str("\nexits, each with what it costs:\n");
    for outcome in row.outcomes.iter() {
        // The exit is named in a column of its own, so of `Hit(add 3)` only `add 3` is left.
        let written = outcome.text();
        let cost = written.strip_prefix(&*outcome.name).unwrap_or(&written).trim_matches(['(', ')']);
        let _ = writeln!(text, "  {:<16}  {}", outcome.name, if cost.is_empty() { "nothing" } else { cost });
    }
    let _ = writeln!(text, "\nword:\n  {}", row.drawn);
    if let Some(example) = examples::find(&row.name) {
        let _ = writeln!(text, "\nexample:\n{example}");
    }
    text
}
