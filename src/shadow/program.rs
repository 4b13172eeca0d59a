//! The shadow of a program by itself: its registers and what it wrote to global memory.

use emu::shadow::{Shadow, ShadowProgram};
use emu::stepper::Stepper;
use isa::Program;
use isa::naming::RegisterId;

use super::numbers::register_numbers;
use super::result::ShadowResult;
use super::totals::{OutputWeight, ShadowTotals, ShadowedNumber, SourcePrograms};

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
        for (name, number) in register_numbers(stepper, shadow, register) {
            // Integers are no numbers, unless somebody asked for them.
            if number.shadow.is_some() || number.scale.is_some() || !chosen.is_empty() {
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
            let number = ShadowedNumber { scale: number.scale, raw, shadow: Some(number) };
            totals.add_output(&programs, || format!("memory {address:#x}"), number, OutputWeight::Shares);
        }
    }
    totals.result(&programs)
}
