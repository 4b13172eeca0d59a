//! Shadows in the debugger: the exact number beside each register, and the lines that made the difference.

use emu::shadow::ShadowProgram;
use isa::Program;
use isa::naming::RegisterId;

use super::session::Session;
use crate::registers::{ShowList, ShowRequest};
use crate::shadow::{self, ShadowedNumber, SourcePrograms, number_text};

fn shadow_of<'a>(session: &'a Session) -> Result<&'a emu::shadow::Shadow, String> {
    session.stepper().shadow().ok_or_else(|| "numbers have no shadows: start `lancer debug` with --shadow".to_owned())
}

/// The program that sent the message of a work item.
fn sender<'a>(session: &Session<'a>) -> Option<(&'a Program, &'a ShadowProgram)> {
    session.target.sender.as_ref().map(|(program, letter)| (program, &*letter.program))
}

/// Registers that a list names, with the fraction bits in which it wants them.
fn named(session: &Session, list: &str) -> Result<Vec<(RegisterId, Option<i32>)>, String> {
    let (program, pc) = (&session.target.program, session.pc());
    let list: ShowList = list.parse()?;
    let id = |request: &ShowRequest| {
        let shown = request.shown(program, &session.stepper().state().registers, pc)?;
        let register = request.register(program, pc).ok_or("there is no such register")?;
        Ok((register, shown.fraction_bits))
    };
    list.0.iter().map(id).collect()
}

/// Registers beside their shadows: those of a list, or all that hold numbers that differ from exact ones.
///
/// # Errors
/// A register that there is not, and a session without shadows.
pub fn text(session: &Session, list: &str) -> Result<String, String> {
    let shadow = shadow_of(session)?;
    let (program, pc) = (&session.target.program, session.pc());
    let wanted = match list {
        "" => isa::naming::registers().map(|register| (register, None)).collect(),
        list => named(session, list)?,
    };
    let programs = SourcePrograms { core: (program, &shadow.program), main: sender(session) };
    let mut lines = String::new();
    for (register, scale) in wanted {
        let numbers = shadow::register_numbers(session.stepper(), shadow_of(session)?, register);
        let deviates = |number: &ShadowedNumber| number.shadow.is_some_and(|shadow| shadow.deviation.is_some());
        if list.is_empty() && !numbers.iter().any(|(_, number)| deviates(number)) {
            continue;
        }
        let name = program.name_of(register, pc).map_or(String::new(), |name| format!("[{name}]"));
        for (component, number) in numbers {
            let number = ShadowedNumber { scale: scale.or(number.scale), ..number };
            lines += &format!("{component}{name}={}: {}\n", number.raw, number_text(number, &programs));
        }
    }
    Ok(if lines.is_empty() { "every number is exact\n".into() } else { lines })
}

/// The lines of which the errors of registers consist.
///
/// # Errors
/// As [`text`].
pub fn died(session: &Session, list: &str) -> Result<String, String> {
    let shadow = shadow_of(session)?;
    let chosen = match list {
        "" => Vec::new(),
        list => named(session, list)?.into_iter().map(|(register, _)| register).collect(),
    };
    let result = shadow::program(session.stepper(), shadow, sender(session), &chosen);
    Ok(shadow::died_table(&result.where_precision_died, result.other_share))
}
