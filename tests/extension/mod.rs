//! Runs programs with extension instructions.

mod bodies;
mod examples;
mod faults;
mod findings;
mod meanings;
mod refusals;
#[path = "../../examples/reciprocal/study.rs"]
mod study;

use asm::extension::{Loaded, load};
use emu::machine::Config;
use emu::machine::single::{Single, SingleRun, run};
use emu::octets::Memory;
use emu::registers::Registers;
use isa::diagnostic::Source;
use isa::{Isa, Program};

/// The table with the instructions of a file.
pub fn isa_of(text: &str) -> (Isa, Vec<Loaded>) {
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

/// A run on one core of the default machine.
pub fn run_with(program: &Program, isa: &Isa, registers: Registers, step_limit: u64) -> SingleRun {
    let config = Config::default();
    let single = Single { registers, step_limit, has_profile: true, ..Single::new(&config, isa, program) };
    run(&single, Memory::new((0..=255).collect())).expect("the machine is the default one")
}
