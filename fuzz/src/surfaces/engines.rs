//! Engines against each other: generated programs, which come to their end, and frames of them on machines of all kinds.

use std::sync::LazyLock;

use emu::engine::{EngineKind, HostSimd, Wish};
use emu::machine::one_core::{LoadedCore, OneCore};
use emu::machine::preset::PRESETS;
use emu::machine::{Config, RunOptions, Setup};
use emu::octets::Memory;
use emu::profile::ProfileLevel;
use emu::registers::Registers;
use isa::number::{Overflow, Quantization};
use isa::{Isa, Op, Program};
use messages::Source;
use programs::builder::{ProgramBuilder, program};
use programs::generate::{DATA, MEMORY, below, gather, image, scatter, straight, structured};
use programs::main_processor::dispatch;
use random::SplitMix64;

use super::machines::{self, one_of};
use crate::project::files;
use crate::seen::Seen;
use crate::surface::{InputForm, Surface};

/// Single programs on the interpreter and as native code: a run for each set of registers that a program begins with.
pub const PROGRAM: Surface = Surface {
    name: "program",
    form: InputForm::Number,
    longest: 8,
    memory: 256 << 20,
    seeds: Vec::new,
    run: run_program,
    reader: &["emu/src/engine/interpreter.rs", "emu/src/engine/native", "emu/src/semantics"],
};

/// Frames of programs on machines, recorded and stepped by native code, and stepped by the interpreter: a run for each machine.
pub const FRAME: Surface = Surface {
    name: "frame",
    form: InputForm::Number,
    longest: 8,
    memory: 512 << 20,
    seeds: Vec::new,
    run: run_frame,
    reader: &["emu/src/machine", "emu/src/replay"],
};

/// The base rows with all of the project's extensions that go together.
static EXTENDED: LazyLock<Isa> = LazyLock::new(|| {
    let mut isa = Isa::base();
    for octets in files("extensions", ".isa") {
        let source = Source::new("a.isa", String::from_utf8_lossy(&octets).into_owned());
        // A file whose opcode another one has taken is left out.
        let _ = asm::extension::load(&mut isa, &source, &|_, _| Err("there are no files here".into()));
    }
    isa
});

static BASE: LazyLock<Isa> = LazyLock::new(Isa::base);

/// Global memory, of which all runs have copies.
static IMAGE: LazyLock<Memory> = LazyLock::new(|| Memory::new(image()));

/// Sets of registers that a program begins with: native code that is generated once serves them all.
const STARTS: usize = 32;

/// Machines that a frame runs on.
const MACHINES: usize = 32;

/// Arithmetic in any word and any modes.
fn arithmetic(random: &mut SplitMix64, config: &mut Config) {
    if random.below(4) == 0 {
        return;
    }
    let arithmetic = &mut config.arithmetic;
    arithmetic.word = 8 + random.below(25) as u32;
    arithmetic.quantization = one_of(random, &Quantization::ALL);
    arithmetic.overflow = one_of(random, &Overflow::ALL).with_saturated(random.below(4) as u32);
    arithmetic.trap_division_by_zero = random.below(16) == 0;
}

/// Registers with numbers of all magnitudes.
fn registers(random: &mut SplitMix64) -> Registers {
    let mut registers = Registers::default();
    let number = |random: &mut SplitMix64| (random.bits() as i64) >> random.below(64);
    for place in 1..32 {
        registers.set_scalar(place, number(random) as i32);
        registers.set_vector(place, [0; 3].map(|_| number(random) as i32));
    }
    (0..8).for_each(|place| registers.set_wide(place, number(random)));
    registers
}

/// Instructions of extensions on any operands but those of addresses, which traps take care of.
fn extended(p: &mut ProgramBuilder, random: &mut SplitMix64) {
    for op in EXTENDED.extensions().filter(|op| EXTENDED.runs_body(*op)) {
        if random.below(2) == 0 {
            continue;
        }
        let row = EXTENDED.definition(op);
        let operands: Vec<i64> = row
            .operands
            .iter()
            .map(|operand| {
                let width = row.pattern.field(operand.letter).map_or(5, |field| field.width);
                let (least, most) = operand.kind.range(width);
                let most =
                    if operand.kind.register_file() == Some('s') { most.min(programs::generate::FREE) } else { most };
                least + below(random, most - least + 1)
            })
            .collect();
        p.emit(op, &operands);
    }
}

/// A message to the core itself, and back out of its mailbox.
fn talk(p: &mut ProgramBuilder, random: &mut SplitMix64) {
    let from = below(random, 26);
    p.emit(Op::movi, &[23, 0]);
    match random.below(2) {
        0 => p.emit(Op::send2, &[23, from]).emit(Op::recv2, &[below(random, 30), 23]),
        _ => p.emit(Op::send5, &[23, from]).emit(Op::recv5, &[below(random, 26), 23]),
    };
}

fn run_program(input: &[u8], seen: &mut Seen) {
    let random = &mut machines::random_of(input);
    let has_extensions = random.below(4) == 0;
    let isa: &Isa = if has_extensions { &EXTENDED } else { &BASE };
    let mut builder = ProgramBuilder::new(isa.clone());
    let p = &mut builder;
    for _ in 0..=random.below(2) {
        match random.below(4) {
            0 => {
                let count = below(random, 16);
                straight(p, random, isa, count);
            }
            1 => talk(p, random),
            2 if has_extensions => extended(p, random),
            _ => {
                let depth = below(random, 2);
                structured(p, random, isa, depth);
            }
        }
    }
    p.emit(Op::halt, &[]);
    let program = builder.build();
    let mut config = Config { packet_lanes: 1 + random.below(6) as u32, ..preset(random) };
    arithmetic(random, &mut config);
    let profile =
        one_of(random, &[ProfileLevel::None, ProfileLevel::None, ProfileLevel::Totals, ProfileLevel::Extremes]);
    let core = OneCore {
        step_limit: 1 << 20,
        profile,
        has_losses: random.below(4) == 0,
        ..OneCore::new(&config, isa, &program)
    };
    let core = LoadedCore::new(&core).unwrap_or_else(|report| panic!("{}", report.render(false)));
    let mut simds = HostSimd::ALL.into_iter().filter(|simd| simd.is_present()).collect::<Vec<_>>();
    let simd = simds.swap_remove(random.below(simds.len() as u64) as usize);
    for _ in 0..STARTS {
        let registers = registers(random);
        let checked = core.run(&registers, IMAGE.clone(), Wish::CHECKED);
        let mut native = core.run(&registers, IMAGE.clone(), Wish { simd, ..Wish::native() });
        // The planted fault is a wrong clock where a loop ran long.
        if seen.has_planted() && native.state.steps % 97 == 5 {
            native.clocks.0 += 1;
        }
        assert!(native.state == checked.state, "states agree with {}", simd.name());
        assert!(native.memory == checked.memory, "memories agree with {}", simd.name());
        assert!((native.clocks, native.waiting) == (checked.clocks, checked.waiting), "clocks agree");
        assert!(native.tally == checked.tally, "counts agree with {}", simd.name());
        assert!(native.trap == checked.trap, "traps agree with {}", simd.name());
        assert!(native.profile == checked.profile, "profiles agree");
        match &checked.trap {
            Some(trap) => seen.text(&trap.to_string()),
            None => seen.name("it ends"),
        }
        seen.name(match native.engine.kind {
            EngineKind::Native => "native",
            _ => native.engine.refusal.unwrap_or("refused"),
        });
        seen.count("steps", checked.state.steps as usize);
        seen.run();
    }
}

/// The machine of a preset.
fn preset(random: &mut SplitMix64) -> Config {
    PRESETS[random.below(PRESETS.len() as u64) as usize].config()
}

/// Something by which a frame cannot be replayed.
fn meddle(p: &mut ProgramBuilder, random: &mut SplitMix64) {
    p.emit(Op::andi, &[4, 4, 0xff]).emit(Op::iaddi, &[4, 4, 1500]);
    match random.below(4) {
        0 => p.emit(Op::core, &[3]),
        1 => p.emit(Op::stw, &[5, 4, 0]),
        2 => p.emit(Op::fetchadd, &[5, 4, 6]),
        _ => p.emit(Op::ldw, &[5, 0, 8]),
    };
}

fn run_frame(input: &[u8], seen: &mut Seen) {
    let random = &mut machines::random_of(input);
    let isa: &Isa = &BASE;
    let core: Program = program(|p| {
        scatter(p, random);
        let depth = below(random, 2);
        structured(p, random, isa, depth);
        if random.below(6) == 0 {
            meddle(p, random);
        }
        gather(p);
    });
    let main = dispatch(random.below(16) as i32);
    let mut config = Config { step_limit: 1 << 20, ..preset(random) };
    config.cache.kind = "data".to_owned();
    arithmetic(random, &mut config);
    let all: Vec<Config> = (0..MACHINES).map(|_| machines::alike(random, &config, 16)).collect();
    let options =
        RunOptions { profile: machines::profile(random), has_items: true, is_eager: true, ..RunOptions::default() };
    let kinds = vec![(DATA as u32..MEMORY as u32, "data".to_owned())];
    let setup = Setup { config: &config, isa, core: &core, main: &main, kinds, options };
    machines::compare(&setup, &all, &IMAGE, random, seen);
}
