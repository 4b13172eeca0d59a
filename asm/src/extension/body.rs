//! A body from its lines: assembled, completed by its outcome, and checked for what its steps read and write.

use std::rc::Rc;
use std::sync::Arc;

use isa::Isa;
use isa::definition::InstructionDef;
use isa::extension::{Body, BodyAct, BodyStep, Defect, Summary, registers};
use isa::table::Op;
use messages::{Diagnostic, Place, Report, Source};

use super::template::{Template, letter_name, register_name};
use crate::frame::{OpenText, Origin};
use crate::line::OriginLine;
use crate::message::At;
use crate::{Loader, Options, assembler, explain};

/// Assembles the body of an extension row; warnings come with it.
#[allow(clippy::too_many_arguments, reason = "one for each part of the file")]
pub(super) fn assemble(
    isa: &Isa,
    op: Op,
    row_at: &Place,
    shared: Rc<[OriginLine]>,
    lines: Rc<[OriginLine]>,
    source: &Arc<Source>,
    include: Loader,
) -> Result<(Body, Summary, Report), Report> {
    // An assembler of its own: names of the body are not those of the program.
    let options = Options { include, ..Options::default() };
    let mut assembler = assembler::new(isa, &options);
    assembler.take_options(source);
    let definition = isa.definition(op);
    let row_line = source.line_column(row_at.span.start).0 as u32;
    let template = Template {
        op,
        definition: definition.clone(),
        row_line,
        steps: Vec::new(),
        places: Vec::new(),
        is_shared: true,
    };
    assembler.body = Some(template);
    // What all bodies share comes first; instructions are refused there.
    assembler.enter(OpenText::new(shared, Origin::File(0)), At::default());
    assembler.read_frames();
    if let Some(template) = &mut assembler.body {
        template.is_shared = false;
    }
    if !assembler.is_incomplete {
        assembler.enter(OpenText::new(lines, Origin::File(0)), At::default());
        assembler.read_frames();
    }
    assembler.second_pass();
    let template = assembler.body.take().expect("it was put there above");
    let attempt = assembler.finish();
    if attempt.report.has_errors() {
        return Err(attempt.report);
    }
    let body = complete(template, isa, source, row_at)?;
    let summary = body.summary(definition, isa).map_err(|defect| defective(defect, &body, definition, row_at))?;
    Ok((body, summary, attempt.report))
}

/// Adds the outcome that the body runs into, where there is only one.
fn complete(template: Template, isa: &Isa, source: &Arc<Source>, row_at: &Place) -> Result<Body, Report> {
    let Template { definition, mut steps, .. } = template;
    let end = steps.len();
    let mut body = Body { steps: steps.clone(), source: source.clone(), temporaries: [0; 3] };
    // A step from which control falls off the end, or an empty body.
    let runs_on = (0..end).find(|&step| body.successors(step, isa).any(|next| next == end));
    if let Some(step) = runs_on.or((end == 0).then_some(0)) {
        if definition.outcomes.len() > 1 {
            let names: Vec<&str> = definition.outcomes.iter().map(|outcome| &*outcome.name).collect();
            let message =
                format!("the body of `{}` runs off its end, but it has {} outcomes", definition.name, names.len());
            let place = body.place(step).unwrap_or_else(|| row_at.clone());
            let hint = format!("end it with `exit {}`", names.join("` or `exit "));
            return Err(Diagnostic::error(message)
                .code(explain::BODY)
                .at(place, "nothing says which one")
                .hint(hint)
                .into());
        }
        let line = steps.last().map_or(template.row_line, |last| last.line);
        steps.push(BodyStep { act: BodyAct::End { outcome: 0, jumps: false }, line });
        body.steps = steps;
    }
    // Count hidden registers: temporaries, and a copy of each destination in the worst case.
    for (place, file) in ['s', 'v', 'w'].into_iter().enumerate() {
        let hidden = registers::hidden(file);
        let used = temporaries(&body, isa, file);
        let written = definition.operands.iter().filter(|o| o.is_written() && o.kind.register_file() == Some(file));
        let written: u8 = written.map(|operand| operand.kind.registers()).sum();
        if usize::from(used + written) > hidden.len() {
            let message = format!(
                "the body of `{}` needs {} hidden registers of the file `{file}`, of which there are {}",
                definition.name,
                used + written,
                hidden.len()
            );
            let label = format!("{used} temporaries, {written} destinations");
            let hint = "number temporaries from 0, and use one again when its value is no longer needed";
            return Err(Diagnostic::error(message).code(explain::BODY).at(row_at.clone(), label).hint(hint).into());
        }
        body.temporaries[place] = used;
    }
    Ok(body)
}

/// One more than the highest temporary of a file.
fn temporaries(body: &Body, isa: &Isa, file: char) -> u8 {
    let hidden = registers::hidden(file);
    let mut used = 0;
    for step in &body.steps {
        let BodyAct::Execute { instruction, .. } = step.act else { continue };
        for operand in isa.definition(instruction.op).operands.iter().filter(|o| o.kind.register_file() == Some(file)) {
            let number = instruction.fields.get(operand.letter) as u8;
            if hidden.contains(&number) {
                used = used.max(number + operand.kind.registers() - hidden.start);
            }
        }
    }
    used
}

fn defective(defect: Defect, body: &Body, definition: &InstructionDef, row_at: &Place) -> Report {
    let place = |step: usize| body.place(step).unwrap_or_else(|| row_at.clone());
    let message = match defect {
        Defect::Unwritten { step, file, number } => {
            let name = register_name(file, number);
            // A destination holds nothing before the body writes it, and neither does a temporary; each has a remedy of its own.
            let hint = match registers::letter(number) {
                Some((letter, _)) => format!(
                    "`{}` is only written; call the operand `x` or `y` in the row if it is read too",
                    letter as char
                ),
                None => {
                    format!("write `{name}` on every way that leads here; hidden registers hold nothing at the start")
                }
            };
            Diagnostic::error(format!("`{name}` is read, but not written on every way to this line"))
                .at(place(step), "read here")
                .hint(hint)
        }
        Defect::Missing { step, letter, offset } => {
            // An operand may be several registers: of `d: V3` the last one is told as `d+2`.
            let count = definition.operand(letter).map_or(1, |operand| operand.kind.registers());
            let name = letter_name(letter, offset, count);
            let message = format!("`{name}` is not written on every way to this outcome of `{}`", definition.name);
            Diagnostic::error(message)
                .at(place(step), "ends here")
                .also(row_at.clone(), "its row")
                .hint("write it, or call the operand `x` or `y` in the row if it may stay as it was")
        }
        Defect::Endless => Diagnostic::error(format!("the body of `{}` never ends", definition.name))
            .at(row_at.clone(), "no outcome is reached")
            .hint("`exit NAME` ends a body"),
    };
    message.code(explain::BODY).into()
}
