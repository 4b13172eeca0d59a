//! A file of extensions: its name, what its bodies share, and its instructions one after the other.

use std::rc::Rc;
use std::sync::Arc;

use isa::Isa;
use isa::definition::InstructionDef;
use isa::extension::Summary;
use isa::table::Op;
use messages::{Diagnostic, Place, Report, Source};

use super::row::{Drawn, parse};
use super::{LoadedInstruction, MOST_INSTRUCTIONS, body, error};
use crate::explain;
use crate::frame::{file_lines, leading_directive};
use crate::limits::TEXT_OCTETS;
use crate::line::OriginLine;
use crate::{function, operand, pseudo};

/// An instruction of the file.
struct InstructionBlock {
    /// Octet of the row behind `.instr`.
    start: usize,
    doc: String,
    lines: Vec<OriginLine>,
    /// The semantics are in Rust; the lines may be a body beside them.
    is_rust: bool,
}

/// The parts of a file.
#[derive(Default)]
struct Parts {
    name: Option<String>,
    shared: Vec<OriginLine>,
    blocks: Vec<InstructionBlock>,
}

/// Adds the instructions of a file one after the other.
pub(super) fn load(
    isa: &mut Isa,
    source: &Arc<Source>,
    include: crate::Loader,
) -> Result<Vec<LoadedInstruction>, Report> {
    let mut report = Report::default();
    let parts = parts(source, &mut report);
    let shared: Rc<[OriginLine]> = parts.shared.into();
    let mut loaded = Vec::new();
    for block in parts.blocks {
        let drawn = match parse(source, block.start) {
            Ok(drawn) => drawn,
            Err(message) => {
                report.0.push(*message);
                continue;
            }
        };
        // The row has a line of its own; the body begins below.
        let Some(lines) = body_lines(&block.lines, source, drawn.end) else {
            let end = drawn.end..drawn.end + source.text[drawn.end..].find('\n').unwrap_or(0);
            report.0.push(error(
                explain::ROW,
                "something follows the row",
                source,
                end,
                "the body begins on the next line",
            ));
            continue;
        };
        let each_at = drawn.each_at.clone().map(|span| Place::new(source, span));
        // Enter the row, then its body: a row with a wrong body is reported and keeps its name.
        let found =
            add(isa, source, drawn, block.doc, parts.name.as_deref().unwrap_or_default()).and_then(|mut found| {
                let is_empty = lines.iter().all(|line| crate::token::tokens(&line.text).0.is_empty());
                check_costs(isa.definition(found.op), block.is_rust, is_empty, &found.outcomes, each_at)?;
                found.is_rust = block.is_rust;
                if is_empty && block.is_rust {
                    return Ok(found);
                }
                if is_empty {
                    let message = format!("the body of `{}` is empty", isa.definition(found.op).name);
                    let hint = "write what it does as instructions between the row and `.end`, or `.meaning rust` if a program of yours does it";
                    return Err(Report::from(
                        Diagnostic::error(message)
                            .code(explain::BODY)
                            .at(found.row.clone(), "nothing says what it does")
                            .hint(hint),
                    ));
                }
                let (body, summary, warnings) =
                    body::assemble(isa, found.op, &found.row, shared.clone(), lines.into(), source, include)?;
                report.0.extend(warnings.0);
                isa.set_body(found.op, Arc::new(body));
                found.summary = summary;
                Ok(found)
            });
        match found {
            Ok(found) => loaded.push(found),
            Err(messages) => report.0.extend(messages.0),
        }
    }
    // What bodies share is read again for each of them.
    let mut shown: Vec<Diagnostic> = Vec::new();
    for message in report.0 {
        if !shown.contains(&message) {
            shown.push(message);
        }
    }
    let report = Report(shown);
    if report.has_errors() { Err(report) } else { Ok(loaded) }
}

/// The lines of a body behind its row; `None` when something else follows the row on its line.
fn body_lines(lines: &[OriginLine], source: &Source, row_end: usize) -> Option<Vec<OriginLine>> {
    let rest = source.text[row_end..].lines().next().unwrap_or_default();
    let rest = rest.trim();
    let is_alone = rest.is_empty() || crate::token::starts_comment(rest);
    is_alone.then(|| lines.iter().filter(|line| line.at(0, 0).start as usize >= row_end).cloned().collect())
}

fn parts(source: &Arc<Source>, report: &mut Report) -> Parts {
    let mut parts = Parts::default();
    if source.text.len() > TEXT_OCTETS {
        let message = format!("the file is longer than {TEXT_OCTETS} octets");
        report.0.push(error(explain::SIZE, message, source, 0..1, "starts here"));
        return parts;
    }
    // Split the file: what stands between `.instr` and `.end` belongs to an instruction, the rest to all of them.
    let (lines, unclosed) = file_lines(&source.text, 0);
    if let Some(at) = unclosed {
        let span = at.start as usize..at.end as usize;
        report.0.push(error(explain::UNCLOSED, "`*/` is missing", source, span, "opened here"));
    }
    let mut doc = String::new();
    // The open block and where its directive stands.
    let mut open: Option<(InstructionBlock, Place)> = None;
    let mut macro_depth = 0usize;
    for line in lines.iter() {
        let at = line.at_all();
        let place = Place::new(source, at.start as usize..at.end as usize);
        let word = leading_directive(&line.text);
        // Comments of macros are no documentation of the next instruction.
        match word {
            Some(".macro") => macro_depth += 1,
            Some(".endm") => macro_depth = macro_depth.saturating_sub(1),
            _ => {}
        }
        // Inside a block only its end and the directives of extensions are looked at.
        if let Some((block, _)) = &mut open {
            match word {
                Some(".end") => parts.blocks.extend(open.take().map(|(block, _)| block)),
                Some(".meaning") => match is_rust(source, &place) {
                    Ok(()) => block.is_rust = true,
                    Err(message) => report.0.push(*message),
                },
                Some(".instr" | ".extension") => {
                    let (_, opened) = open.take().expect("a block is open");
                    let message = Diagnostic::error("`.end` is missing").code(explain::UNCLOSED);
                    report.0.push(message.at(opened, "opened here").also(place, "the next one begins here"));
                    return parts;
                }
                _ => block.lines.push(line.clone()),
            }
            continue;
        }
        match word {
            Some(".extension") => match name(source, &place, parts.name.is_some() || !parts.blocks.is_empty()) {
                Ok(name) => parts.name = Some(name),
                Err(message) => report.0.push(*message),
            },
            Some(".instr") => {
                if parts.name.is_none() {
                    let message = Diagnostic::error("the extension has no name yet").code(explain::ROW);
                    report.0.push(message.at(place, "comes too early").hint("begin the file with `.extension NAME`"));
                    return parts;
                }
                let start =
                    place.span.start + source.text[place.span.clone()].find(".instr").unwrap_or(0) + ".instr".len();
                open = Some((
                    InstructionBlock { start, doc: std::mem::take(&mut doc), lines: Vec::new(), is_rust: false },
                    place,
                ));
            }
            Some(".end") => {
                let message = Diagnostic::error("`.end` without `.instr`").code(explain::UNOPENED);
                report.0.push(message.at(place, "nothing is open"));
            }
            _ => {
                // Lines with `;;` document the instruction that follows them.
                let text = line.text.trim();
                match text.strip_prefix(";;") {
                    Some(text) if macro_depth == 0 => {
                        doc.push_str(text.strip_prefix(' ').unwrap_or(text));
                        doc.push('\n');
                    }
                    _ => {
                        doc.clear();
                        parts.shared.push(line.clone());
                    }
                }
            }
        }
    }
    if let Some((_, opened)) = open {
        let message = Diagnostic::error("`.end` is missing").code(explain::UNCLOSED);
        report.0.push(message.at(opened, "opened here"));
    } else if parts.blocks.is_empty() && report.0.is_empty() {
        let message = Diagnostic::error("the file has no instruction").code(explain::ROW);
        let end = source.text.len();
        report
            .0
            .push(message.at(Place::new(source, end..end), "ends here").hint("an instruction begins with `.instr`"));
    }
    parts
}

/// `.meaning rust`
fn is_rust(source: &Arc<Source>, place: &Place) -> Result<(), Box<Diagnostic>> {
    let text = source.text[place.span.clone()].trim_start().trim_start_matches(".meaning");
    match text.split([';', '#']).next().unwrap_or(text).trim() {
        "rust" => Ok(()),
        _ => {
            let message = Diagnostic::error("`.meaning` names where the meaning is").code(explain::ROW);
            let hint = "write `.meaning rust`; without the line the meaning is the body";
            Err(message.at(place.clone(), "`rust` is expected").hint(hint).into())
        }
    }
}

/// Checks that outcomes cost what whoever executes the instruction can count.
fn check_costs(
    row: &InstructionDef,
    is_rust: bool,
    is_bodiless: bool,
    outcomes: &[Place],
    each_at: Option<Place>,
) -> Result<(), Report> {
    let wrong = |message: String, place: Place, label: &str, hint: &str| -> Result<(), Report> {
        Err(Diagnostic::error(message).code(explain::ROW).at(place, label).hint(hint).into())
    };
    if let Some(place) = each_at.filter(|_| !is_bodiless) {
        let message = format!("the outcomes of `{}` have no cost for each unit, because it has a body", row.name);
        let hint =
            "only a meaning in Rust without a body beside it reports units; a body costs `body` or fixed numbers";
        return wrong(message, place, "here", hint);
    }
    match row.outcomes.iter().position(|outcome| outcome.is_body) {
        Some(outcome) if is_rust => {
            let message = format!("`{}` has its meaning in Rust, so its outcomes say what they cost", row.name);
            let hint = "nobody counts what a meaning in Rust spends: write numbers, such as `add 3`";
            wrong(message, outcomes[outcome].clone(), "`body` is the sum of steps that are not executed", hint)
        }
        _ => Ok(()),
    }
}

/// `.extension NAME`
fn name(source: &Arc<Source>, place: &Place, is_late: bool) -> Result<String, Box<Diagnostic>> {
    let text = &source.text[place.span.clone()];
    let rest = text.trim_start_matches(".extension");
    let rest = rest.split([';', '#']).next().unwrap_or(rest).trim();
    let is_name = rest.starts_with(crate::token::starts_name) && rest.chars().all(crate::token::continues_name);
    if is_late {
        let message = Diagnostic::error("`.extension` stands once, before all instructions").code(explain::ROW);
        return Err(message.at(place.clone(), "too late").hint("use one file for each extension").into());
    }
    if !is_name {
        let message = Diagnostic::error("`.extension` names the extension").code(explain::ROW);
        return Err(message.at(place.clone(), "a name is expected").hint("write `.extension NAME`").into());
    }
    Ok(rest.to_owned())
}

/// Adds a row without its body.
fn add(
    isa: &mut Isa,
    source: &Arc<Source>,
    drawn: Drawn,
    doc: String,
    extension: &str,
) -> Result<LoadedInstruction, Report> {
    let Drawn { mut row, name_at, pattern_at, outcomes_at, start, end, .. } = drawn;
    row.room = extension.to_owned().into();
    row.doc = doc.into();
    let place = Place::new(source, start..end);
    // Refuse names that assembly text reads as something else
    let taken = |what: &str| {
        let message = format!("`{}` is {what} already", row.name);
        error(explain::TAKEN, message, source, name_at.clone(), "taken").hint("choose another name")
    };
    if pseudo::find(&row.name).is_some() {
        return Err(taken("a pseudo-instruction").into());
    } else if function::is_function(&row.name) {
        return Err(taken("a function of expressions").into());
    } else if operand::looks_like_register(&row.name) {
        return Err(taken("a register's name").into());
    } else if row.name == "exit" {
        return Err(taken("how a body ends").into());
    }
    if isa.extensions().count() >= MOST_INSTRUCTIONS {
        let message = format!("there are more than {MOST_INSTRUCTIONS} extension instructions");
        return Err(error(explain::SIZE, message, source, name_at, "one too many").into());
    }
    // Enter the row: another one may have its name, or a word of its pattern
    let op = match isa.extend(row.clone()) {
        Ok(op) => op,
        Err(other) => return Err(clash(isa, &row, other, taken("an instruction"), source, pattern_at).into()),
    };
    let outcomes = outcomes_at.into_iter().map(|span| Place::new(source, span)).collect();
    // Both are told later, by the body and by whoever has read the file.
    let (summary, is_rust) = (Summary::default(), false);
    Ok(LoadedInstruction { op, extension: extension.to_owned(), summary, row: place, outcomes, is_rust })
}

/// The message when another instruction has the name or a word of a row.
fn clash(
    isa: &Isa,
    row: &InstructionDef,
    other: Op,
    taken: Diagnostic,
    source: &Arc<Source>,
    pattern_at: std::ops::Range<usize>,
) -> Diagnostic {
    let other = isa.definition(other);
    if other.name == row.name {
        return taken;
    }
    let message = format!("`{}` and `{}` have words in common", row.name, other.name);
    let label = format!("`{}` is \"{}\"", other.name, other.drawn);
    let is_free = |major: u32| isa.extensions().all(|op| isa.definition(op).pattern.value >> 26 != major);
    let free = (0x3c..0x40).find(|&major| is_free(major)).map(|major| isa::pattern::CUSTOM[major as usize - 0x3c].0);
    error(explain::TAKEN, message, source, pattern_at, &label).hint(match free {
        Some(name) => format!("`{name}` is free; or tell them apart by bits that are 0 in one and 1 in the other"),
        None => "tell them apart by bits that are 0 in one and 1 in the other".to_owned(),
    })
}
