//! Native code against the interpreter: whole frames of generated programs, from words at random to loops, calls and transfers. Frames
//! hold memory, passes, clocks, octets and each work item; the answers are made of all registers and of the buffer.

use emu::engine::EngineKind;
use emu::engine::{HostSimd, Wish};
use emu::machine::one_core::{self, OneCore};
use emu::machine::{Config, Method, RunFailure, RunOptions, RunOutcome, Setup};
use emu::octets::Memory;
use emu::profile::ProfileLevel;
use isa::{Class, Isa, Op, Program};
use programs::generate::{DATA, MEMORY, NUMBER, anywhere, below, gather, image, instruction, scatter, structured};
use random::SplitMix64;

use super::builder::{ProgramBuilder, program};
use super::machine::dispatch;
use super::stack::STACK_KIB;

/// Items of a frame: more than a host thread takes at a time.
const ITEMS: i32 = 45;

fn frame(
    engine: EngineKind,
    features: Option<HostSimd>,
    core: &Program,
    config: &Config,
) -> Result<RunOutcome, RunFailure> {
    let isa = Isa::base();
    let options = RunOptions { has_items: true, engine, simd: features, is_eager: true, ..RunOptions::default() };
    let kinds = vec![(DATA as u32..MEMORY as u32, "data".to_owned())];
    let setup = Setup { config, isa: &isa, core, main: &dispatch(ITEMS), kinds, options };
    assert_eq!(setup.engine().refusal, None);
    emu::run(&setup, Memory::new(image()), &mut |_| {})
}

/// Runs a program on both engines, as native code with each of the host's features, and yields what all said.
fn same(name: &str, core: &Program, step_limit: u64) -> Result<RunOutcome, String> {
    same_on(&Config { step_limit, ..Config::default() }, name, core)
}

fn same_on(config: &Config, name: &str, core: &Program) -> Result<RunOutcome, String> {
    let run = |engine, features| frame(engine, features, core, config).map_err(|failure| failure.to_string());
    let checked = run(EngineKind::Checked, None);
    for features in HostSimd::ALL.into_iter().filter(|features| features.is_present()) {
        let found = run(EngineKind::Native, Some(features));
        if found != checked {
            let text: Vec<String> = core.sources.iter().map(|source| source.text.to_string()).collect();
            panic!("{name}, with {}\n{}\n{found:#?}\n{checked:#?}", features.name(), text.concat());
        }
    }
    checked
}

#[test]
fn any_row_on_any_operands() {
    let isa = Isa::base();
    for (seed, &op) in Op::BUILT_IN.iter().filter(|op| anywhere(op, &isa)).enumerate() {
        let mut random = SplitMix64::new(seed as u64);
        let core = program(|p| {
            scatter(p, &mut random);
            for _ in 0..12 {
                instruction(p, &mut random, op, isa.definition(op));
            }
            gather(p);
        });
        same(&isa.definition(op).name, &core, 1 << 20).unwrap_or_else(|error| panic!("{op:?}: {error}"));
    }
}

/// Three lanes take another division than four. Packets of 400 triangles one after the other, at a million clocks each, take more clocks than a note of a
/// read may hold, which is 2^31, and eleven of them more than a segment holds, which is below 2^32: then the frame is stepped.
#[test]
fn units_on_any_number_of_lanes_and_however_long_they_take() {
    for (lanes, packets, div) in [(4, 8, 1), (1, 8, 1_000_000), (1, 11, 1_000_000), (3, 8, 1_000_000), (5, 8, 7)] {
        let mut config = Config { packet_lanes: lanes, step_limit: 1 << 20, ..Config::default() };
        config.clocks.0[Class::Div] = div.into();
        let core = program(|p| {
            scatter(p, &mut SplitMix64::new(lanes.into()));
            p.constant(2, 0).constant(3, 1).constant(4, DATA as i32).constant(27, 2);
            // The first time, with packets of one triangle, the read tells where it is; the second time generated code does it.
            let again = p.here();
            for packet in 0..packets {
                let op = if packet % 2 == 0 { Op::rnear } else { Op::rany };
                p.emit(op, &[packet, 10 + packet, 2, 3, 20]);
            }
            p.emit(Op::ldw, &[5, 4, 0]);
            p.constant(3, 400).emit(Op::isubi, &[27, 27, 1]).branch(Op::bne, &[27, 0], again);
            gather(p);
        });
        let name = format!("{packets} packets on {lanes} lanes");
        let frame = same_on(&config, &name, &core).unwrap_or_else(|error| panic!("{name}: {error}"));
        let an_item = packets as u64 * 400_u64.div_ceil(lanes.into()) * div;
        assert_eq!(frame.method == Method::Replayed, an_item < 1 << 32, "{name}: {:?}", frame.method);
        assert!(frame.clocks.0 >= an_item, "{name}: {}", frame.clocks.0);
    }
}

/// An engine that left something on the host's stack for each instruction or each loop would not come to the end.
#[test]
fn a_long_loop_over_all_rows_takes_no_stack() {
    let isa = Isa::base();
    let mut random = SplitMix64::new(77);
    let core = program(|p| {
        scatter(p, &mut random);
        // Rows at random leave s27 alone, so the loop ends after 20,000 passes.
        p.constant(27, 20_000);
        let again = p.here();
        for &op in Op::BUILT_IN.iter().filter(|op| anywhere(op, &isa)) {
            instruction(p, &mut random, op, isa.definition(op));
        }
        let (function, over) = (p.label(), p.label());
        p.branch(Op::call, &[28], function).branch(Op::jump, &[], over);
        p.place(function);
        p.emit(Op::ret, &[28]);
        p.place(over);
        // Taken or not, a branch goes on at the next instruction.
        for op in [Op::beq, Op::bne, Op::blt, Op::bge, Op::bltu, Op::bgeu] {
            let next = p.label();
            p.branch(op, &[1, 2], next);
            p.place(next);
        }
        p.emit(Op::isubi, &[27, 27, 1]);
        p.branch(Op::bne, &[27, 0], again);
        gather(p);
    });
    let (config, main) = (Config { step_limit: 1 << 30, ..Config::default() }, dispatch(1));
    let options = RunOptions::default();
    let setup = Setup { config: &config, isa: &isa, core: &core, main: &main, kinds: Vec::new(), options };
    let count = emu::count(&setup, &Memory::new(vec![3; MEMORY as usize])).expect("it runs").expect("it is counted");
    assert!(count.tally.instructions() > 20_000 * 100);
}

/// Calls of the guest that never return take none of the host's stack, on either engine and whatever is measured.
#[test]
fn calls_without_end_take_no_stack() {
    const CALLS: u64 = 1 << 18;
    let core = program(|p| {
        let function = p.label();
        p.constant(1, CALLS as i32);
        p.function("nest", |p| {
            p.place(function).emit(Op::isubi, &[1, 1, 1]);
            let end = p.label();
            p.branch(Op::beq, &[1, 0], end).branch(Op::call, &[5], function);
            p.place(end).emit(Op::halt, &[]);
        });
    });
    for (wish, profile) in [Wish::CHECKED, Wish::native()]
        .into_iter()
        .flat_map(|wish| [ProfileLevel::None, ProfileLevel::Totals].map(|profile| (wish, profile)))
    {
        let (core, run) = (core.clone(), move |core: &Program| {
            let (config, isa) = (Config::default(), Isa::base());
            let one_core = OneCore { profile, ..OneCore::new(&config, &isa, core) };
            one_core::run_with(&one_core, Memory::default(), wish).expect("the setup is right")
        });
        // Compiling a program takes most of this; calls that took sixteen octets each would take four times as much.
        let thread = std::thread::Builder::new().stack_size(STACK_KIB << 10).spawn(move || run(&core));
        let found = thread.expect("a thread can be had").join().expect("the stack is large enough");
        assert_eq!((found.trap, found.engine.kind), (None, wish.kind), "{profile:?}");
        assert!(found.state.steps > 3 * (CALLS - 1), "{profile:?}");
    }
}

#[test]
fn loops_calls_and_branches() {
    let isa = Isa::base();
    let mut ends = 0;
    for seed in 0..60 {
        let mut random = SplitMix64::new(1000 + seed);
        let core = program(|p| {
            scatter(p, &mut random);
            structured(p, &mut random, &isa, 2);
            gather(p);
        });
        ends += u64::from(same(&format!("program {seed}"), &core, 1 << 20).is_ok());
    }
    assert!(ends > 50, "most programs come to their end, not only {ends}");
}

#[test]
fn words_at_random() {
    for seed in 0..60 {
        let mut random = SplitMix64::new(2000 + seed);
        let core = program(|p| {
            scatter(p, &mut random);
            for _ in 0..below(&mut random, 30) {
                p.word(random.bits() as u32);
            }
            gather(p);
        });
        // Most trap; both engines at the same place.
        let _ = same(&format!("words {seed}"), &core, 100_000);
    }
}

#[test]
fn what_is_unusual_is_the_interpreters() {
    // Items know their number and 40, so that only some of them meet what is unusual.
    let few = |body: fn(&mut ProgramBuilder)| {
        program(|p| {
            p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[NUMBER, 0, 0]).emit(Op::movi, &[1, 40]);
            body(p);
            gather(p);
        })
    };
    let end = |name: &str, body: fn(&mut ProgramBuilder)| same(name, &few(body), 5000).map(|_| ()).unwrap_err();
    // Item 40 alone does not jump over the trap.
    let trap = end("a trap", |p| {
        let past = p.label();
        p.branch(Op::bne, &[NUMBER, 1], past).emit(Op::trap, &[9]);
        p.place(past);
    });
    assert!(trap.contains("trap 9") && trap.contains("40, 40, 40"), "{trap}");
    // Item 37 is the first beyond the buffer: 37 x 512 is 18944, and there are 18525 octets.
    let outside = end("an access", |p| {
        p.emit(Op::slli, &[2, NUMBER, 9]).emit(Op::lw, &[3, 2, 0]);
    });
    assert!(outside.contains("37, 37, 37"), "{outside}");
    let endless = end("no end", |p| {
        let here = p.here();
        p.branch(Op::jump, &[], here);
    });
    assert!(endless.contains("5000 instructions"), "{endless}");
    // Whoever asks for the core's number gets no shared recording: such a frame is stepped.
    let core = few(|p| {
        p.emit(Op::core, &[3]);
    });
    let step = same("a core's number", &core, 5000).expect("it is stepped");
    assert_eq!(step.method.reason(), Some("a work item asks which core it runs on"));
}

/// Something that may read the number of cores, write where it is, or leave it alone.
fn meddle(p: &mut ProgramBuilder, random: &mut SplitMix64, depth: i64) {
    let register = 20 + below(random, 2);
    // The innermost level has only what contains nothing.
    match below(random, if depth == 0 { 6 } else { 9 }) {
        0 => p.emit(Op::iadd, &[1, 1, register]),
        1 => p.emit(Op::movi, &[register, 5]),
        2 => p.emit(Op::cores, &[21]),
        3..6 => p.emit(Op::iaddi, &[1, 1, 7]),
        6 => {
            let end = p.label();
            p.emit(Op::andi, &[3, NUMBER, 1 + below(random, 4)]);
            p.branch(Op::beq, &[3, 0], end);
            meddle(p, random, depth - 1);
            meddle(p, random, depth - 1);
            p.place(end)
        }
        7 => {
            // Each level has a counter and a link of its own; a loop from 0, 1 or 2 down to below 0 is one to three passes.
            let counter = 24 + depth;
            p.emit(Op::movi, &[counter, below(random, 3)]);
            let again = p.here();
            meddle(p, random, depth - 1);
            meddle(p, random, depth - 1);
            p.emit(Op::isubi, &[counter, counter, 1]);
            p.branch(Op::bge, &[counter, 0], again);
            p
        }
        _ => {
            let (over, function) = (p.label(), p.label());
            p.branch(Op::call, &[28 + depth], function);
            p.branch(Op::jump, &[], over);
            p.place(function);
            meddle(p, random, depth - 1);
            p.emit(Op::ret, &[28 + depth]);
            p.place(over)
        }
    };
}

#[test]
fn every_engine_knows_what_depends_on_the_number_of_cores() {
    let isa = Isa::base();
    let machines = [1, 2, 5].map(|cores| Config { cores, ..Config::default() });
    let (main, memory) = (dispatch(ITEMS), Memory::new(vec![0; MEMORY as usize]));
    let mut dependent = [0, 0];
    for seed in 0..150 {
        let random = &mut SplitMix64::new(seed);
        let core = program(|p| {
            p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[NUMBER, 0, 0]);
            for _ in 0..4 {
                meddle(p, random, 2);
            }
            p.emit(Op::vsplat, &[6, NUMBER]).emit(Op::vsplat, &[7, 1]).emit(Op::cores, &[20]);
            p.emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
        });
        let setup = |config, engine| {
            let options = RunOptions { engine, is_eager: true, ..RunOptions::default() };
            Setup { config, isa: &isa, core: &core, main: &main, kinds: Vec::new(), options }
        };
        let stepped = machines.each_ref().map(|config| {
            emu::step(&setup(config, EngineKind::Checked), memory.clone(), &mut |_| {}).expect("it runs")
        });
        dependent[usize::from(stepped[0].memory != stepped[2].memory)] += 1;
        for engine in EngineKind::ALL {
            // The three share what was recorded, but for what depends on how many they are.
            let frames = emu::run_all(&setup(&machines[0], engine), &machines, &memory, &mut |_| {});
            for (frame, stepped) in frames.into_iter().zip(&stepped) {
                let frame = frame.unwrap_or_else(|failure| panic!("{failure}"));
                let found = (&frame.memory, frame.clocks, &frame.tally);
                assert_eq!(found, (&stepped.memory, stepped.clocks, &stepped.tally), "seed {seed}, {engine:?}");
            }
        }
    }
    assert!(dependent[0] > 20 && dependent[1] > 20, "{dependent:?}");
}
