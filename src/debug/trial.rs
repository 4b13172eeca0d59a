//! An instruction that is tried on the state and undone: `x vdot s1, v1, v2, 16`.

use asm::Options;
use emu::octets::Memory;
use emu::stepper::{Lone, Stepper};
use isa::Program;
use messages::{Diagnostic, Report, Source};

use super::session::Session;
use crate::trace::instruction::{TraceClocks, TracedInstruction, next};

/// Tries an instruction at the session's position; names, formats and labels are those of the program there. Nothing of it stays.
///
/// # Errors
/// What the assembler finds in it.
pub fn tried(session: &Session, text: &str) -> Result<TracedInstruction, String> {
    attempt(session, text).map_err(|report| {
        // A command is answered in a line: the place is the instruction that was typed.
        let sentence = |message: Diagnostic| match message.hint {
            Some(hint) => format!("{}: {hint}", message.message),
            None => message.message,
        };
        report.0.into_iter().map(sentence).collect::<Vec<_>>().join("; ")
    })
}

fn attempt(session: &Session, text: &str) -> Result<TracedInstruction, Report> {
    let target = session.target;
    let (program, pc, state) = (&target.program, session.pc(), session.stepper().state());
    let word = assembled(program, target, pc, text)?;
    // The instruction stands in the place of the next one, so that distances are right and where it leads is there.
    let mut changed = program.clone();
    let at = (pc as usize).min(changed.words.len().saturating_sub(1));
    let Some(place) = changed.words.get_mut(at) else {
        return Err(Diagnostic::error("the program has no words").into());
    };
    *place = word;
    // Where the program ends, something has to stand behind the instruction.
    changed.words.push(word);
    changed.entry = at as u32;
    changed.buffer = state.buffer.octets().to_vec();
    let mut stepper = Stepper::new(Lone {
        config: &target.config,
        isa: &target.isa,
        program: &changed,
        registers: state.registers.clone(),
        memory: Memory::new(session.stepper().memory().octets().into_owned()),
        message: None,
        step_limit: 2,
    })?;
    let mut record = next(&mut stepper, TraceClocks::None).expect("it has just begun");
    record.step = session.position();
    record.line = None;
    Ok(record)
}

/// The word of one instruction at a place of a program.
fn assembled(program: &Program, target: &super::DebugTarget, pc: u32, text: &str) -> Result<u32, Report> {
    let mut lines = format!(".org {pc}\n");
    for named in program.register_names.iter().filter(|named| named.words.contains(&pc)) {
        let (file, number) = named.register;
        lines +=
            &format!(".unreg {}\n", named.name).repeat(usize::from(lines.contains(&format!(".reg {},", named.name))));
        lines += &format!(".reg {}, {file}{number}\n", named.name);
    }
    let source = Source::new("<tried>", format!("{lines}{text}\n"));
    let is_symbol = |name: &str| {
        !program.formats.contains_key(name) && !program.register_names.iter().any(|named| named.name == name)
    };
    let defines =
        program.symbols.iter().filter(|(name, _)| is_symbol(name)).map(|(name, value)| (name.clone(), *value));
    let options = Options {
        defines: defines.collect(),
        formats: program.formats.iter().map(|(name, bits)| (name.clone(), i64::from(*bits))).collect(),
        ..Options::default()
    };
    let assembled = asm::assemble(&source, &target.isa, &options)?;
    match assembled.program.words.get(pc as usize..) {
        Some(&[word]) => Ok(word),
        _ => Err(Diagnostic::error(format!("`{}` is not one instruction", text.trim())).into()),
    }
}
