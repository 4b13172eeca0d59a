//! Runs programs with extension instructions.

mod bodies;
mod examples;
mod faults;
mod findings;
mod meanings;
#[cfg(feature = "native")]
mod native;
mod refusals;
#[path = "../../examples/reciprocal/study.rs"]
mod study;

use asm::extension::{LoadedInstruction, load};
use emu::engine::{HostSimd, Wish};
use emu::machine::Config;
use emu::machine::one_core::{self, OneCore, OneCoreRun};
use emu::octets::Memory;
use emu::profile::ProfileLevel;
use emu::registers::Registers;
use isa::{Isa, Program};
use messages::Source;

/// The table with the instructions of a file.
pub fn isa_of(text: &str) -> (Isa, Vec<LoadedInstruction>) {
    let mut isa = Isa::base();
    let loaded = load(&mut isa, &Source::new("t.isa", text), &|_, _| Err("there are no files here".into()));
    let loaded = loaded.unwrap_or_else(|report| panic!("{report}"));
    (isa, loaded)
}

/// A program from its text.
pub fn program(text: &str, isa: &Isa) -> Program {
    let assembled = asm::assemble(&Source::new("t.s", text), isa, &asm::Options::default());
    assembled.unwrap_or_else(|report| panic!("{report}\n{text}")).program
}

/// A run on one core of the default machine, the same in native code and on the interpreter.
pub fn run_with(program: &Program, isa: &Isa, registers: Registers, step_limit: u64) -> OneCoreRun {
    let config = Config::default();
    let run = |profile, wish| {
        let one_core =
            OneCore { registers: registers.clone(), step_limit, profile, ..OneCore::new(&config, isa, program) };
        one_core::run_with(&one_core, Memory::new((0..=255).collect()), wish).expect("the machine is the default one")
    };
    let checked = run(ProfileLevel::Extremes, Wish::CHECKED);
    for simd in HostSimd::ALL.into_iter().filter(|simd| simd.is_present()) {
        for level in [ProfileLevel::Extremes, ProfileLevel::None] {
            let native = run(level, Wish { simd, ..Wish::native() });
            let parts = |run: &OneCoreRun| (run.state.clone(), run.clocks, run.waiting, run.tally.clone());
            assert!(parts(&native) == parts(&checked), "{}\n{native:#?}\n{checked:#?}", simd.name());
            assert_eq!(native.trap, checked.trap, "{}", simd.name());
            let wanted = checked.profile.clone().filter(|_| level != ProfileLevel::None);
            assert_eq!(native.profile, wanted, "{}", simd.name());
            assert!(native.memory == checked.memory, "{}", simd.name());
        }
    }
    checked
}
