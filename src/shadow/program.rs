//! The shadow of a program by itself: its registers and what it wrote to global memory.

use emu::shadow::{Shadow, ShadowProgram};
use emu::stepper::Stepper;
use isa::Program;
use isa::naming::RegisterId;

use super::result::ShadowResult;
use super::totals::{FinalNumber, OutputWeight, ShadowTotals, SourcePrograms};

/// Numbers of a register beside their shadows, with the names of their components.
fn of_register(stepper: &Stepper, shadow: &Shadow, register: RegisterId) -> Vec<(String, i64, Option<i32>, usize)> {
    let (registers, (file, number)) = (&stepper.state().registers, register);
    let declared = stepper.code.program.format_of(register, stepper.code.word(stepper.state().pc));
    let declared = declared.map(|(_, bits)| bits);
    let scale = |at: usize| declared.or(shadow.of(register)[at].and_then(|number| number.scale));
    match file {
        's' => vec![(format!("s{number}"), registers.scalar(number).into(), scale(0), 0)],
        'v' => {
            let raw = registers.vector(number);
            let component = |k: usize| (format!("v{number}.{}", ["x", "y", "z"][k]), raw[k].into(), scale(k), k);
            (0..3).map(component).collect()
        }
        _ => vec![(format!("w{number}"), registers.wide(number), scale(0), 0)],
    }
}

/// Errors of a program that a core with a shadow has run. `chosen` are the registers that count as its result; without any, all registers and
/// all that was written to global memory. `main` is the program that sent the message of a work item.
pub fn program(
    stepper: &Stepper,
    shadow: &Shadow,
    main: Option<(&Program, &ShadowProgram)>,
    chosen: &[RegisterId],
) -> ShadowResult {
    let programs = SourcePrograms { core: (stepper.code.program, &shadow.program), main };
    let mut totals = ShadowTotals::default();
    totals.add_ledger(&programs, &shadow.program, &shadow.ledger);
    let all: Vec<RegisterId> = isa::naming::registers().collect();
    let registers = if chosen.is_empty() { &all } else { chosen };
    for &register in registers {
        let shadows = shadow.of(register);
        for (name, raw, scale, at) in of_register(stepper, shadow, register) {
            // Integers are no numbers, unless somebody asked for them.
            if shadows[at].is_some() || !chosen.is_empty() {
                let number = FinalNumber { scale, raw, shadow: shadows[at] };
                totals.add_output(&programs, || name, number, OutputWeight::Shares);
            }
        }
    }
    if chosen.is_empty() {
        for (address, octets, number) in shadow.global.iter() {
            let word = |at: u32| stepper.memory().word(address + at).unwrap_or(0);
            let raw = match octets {
                8 => i64::from(word(4)) << 32 | i64::from(word(0) as u32),
                _ => word(0).into(),
            };
            let number = FinalNumber { scale: number.scale, raw, shadow: Some(number) };
            totals.add_output(&programs, || format!("memory {address:#x}"), number, OutputWeight::Shares);
        }
    }
    totals.result(&programs)
}
