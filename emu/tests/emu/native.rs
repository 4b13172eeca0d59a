//! Native code against the interpreter: whole frames of generated programs, from words at random to loops, calls and transfers. Frames
//! hold memory, passes, clocks, octets and each work item; the answers are made of all registers and of the buffer.

use emu::engine::EngineKind;
use emu::engine::HostSimd;
use emu::machine::{Config, RunFailure, RunOptions, RunOutcome, Setup};
use emu::octets::Memory;
use isa::{InstructionDef, Isa, Kind, Op, Program};
use random::SplitMix64;

use super::builder::{Builder, program};
use super::machine::dispatch;

/// Octets of global memory; answers lie in front.
const MEMORY: i64 = 2000;

/// Address from which work items read.
const DATA: i64 = 400;

/// Items of a frame: more than a host thread takes at a time.
const ITEMS: i32 = 45;

/// Scalars that generated instructions may use; the rest are counters, links and the item's number.
const FREE: i64 = 19;
const NUMBER: i64 = 22;

fn frame(
    engine: EngineKind,
    features: Option<HostSimd>,
    core: &Program,
    step_limit: u64,
) -> Result<RunOutcome, RunFailure> {
    let (isa, config) = (Isa::base(), Config { step_limit, ..Config::default() });
    let options = RunOptions { has_items: true, engine, simd: features, is_eager: true, ..RunOptions::default() };
    let kinds = vec![(DATA as u32..MEMORY as u32, "data".to_owned())];
    let setup = Setup { config: &config, isa: &isa, core, main: &dispatch(ITEMS), kinds, options };
    let image = (0..MEMORY as u32).map(|at| (at.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    emu::run(&setup, Memory::new(image), &mut |_| {})
}

/// Runs a program on both engines, as native code with each of the host's features, and yields what all said.
fn same(name: &str, core: &Program, step_limit: u64) -> Result<RunOutcome, String> {
    let run = |engine, features| frame(engine, features, core, step_limit).map_err(|failure| failure.to_string());
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

/// Numbers of generated programs.
struct Random(SplitMix64);

impl Random {
    fn new(seed: u64) -> Random {
        Random(SplitMix64::new(seed))
    }

    fn next(&mut self) -> u64 {
        self.0.bits()
    }

    fn below(&mut self, end: i64) -> i64 {
        self.0.below(end as u64) as i64
    }
}

/// The item's number goes everywhere, changed a little each time, so that items differ.
fn scatter(p: &mut Builder, random: &mut Random) {
    p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[NUMBER, 0, 0]).emit(Op::mov, &[1, NUMBER]);
    for register in 2..=FREE {
        let factor = random.next() as i32 | 1;
        p.constant(register, factor >> random.below(31)).emit(Op::iadd, &[1, 1, register]);
        p.emit(Op::imul, &[register, register, 1]);
    }
    for register in 0..32 {
        for lane in 0..3 {
            p.emit(Op::vput, &[register, 1 + random.below(FREE), lane]);
        }
    }
    for register in 0..8 {
        p.emit(Op::wjoin, &[register, 1 + random.below(FREE), 1 + random.below(FREE)]);
    }
}

/// Everything goes into one word, the answer.
fn gather(p: &mut Builder) {
    let add = |p: &mut Builder, from: i64| {
        p.emit(Op::slli, &[23, 24, 5]).emit(Op::srli, &[24, 24, 27]).emit(Op::or, &[24, 24, 23]);
        p.emit(Op::iadd, &[24, 24, from]);
    };
    p.emit(Op::movi, &[24, 0]);
    for register in 0..=FREE {
        add(p, register);
    }
    for register in 0..8 {
        p.emit(Op::wlow, &[1, register]).emit(Op::whigh, &[2, register]);
        add(p, 1);
        add(p, 2);
    }
    for (register, lane) in (0..32).flat_map(|register| (0..3).map(move |lane| (register, lane))) {
        p.emit(Op::vget, &[1, register, lane]);
        add(p, 1);
    }
    for at in 0..24 {
        p.emit(Op::lw, &[1, 0, 16 * at]);
        add(p, 1);
    }
    p.emit(Op::vsplat, &[6, NUMBER]).emit(Op::vsplat, &[7, 24]).emit(Op::cores, &[20]);
    p.emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
}

/// An instruction of a row with operands at random; addresses stay in reach.
fn instruction(p: &mut Builder, random: &mut Random, op: Op, row: &InstructionDef) {
    if matches!(op, Op::load | Op::loadf | Op::loadfu | Op::loadnode) {
        // Octets, numbers of up to 63 bits, or nodes of up to 12 octets, which are counted from address 0.
        let (base, most) = match op {
            Op::load => (DATA, 0x7f),
            Op::loadnode => (0, 0xf),
            _ => (DATA, 0xf),
        };
        p.emit(Op::movi, &[1, random.below(200)]).emit(Op::andi, &[2, 2, 0xff]).emit(Op::iaddi, &[2, 2, base]);
        p.emit(Op::andi, &[3, 3, most]);
        let widths =
            row.operands[3..].iter().map(|operand| random.below(if operand.kind == Kind::Sh { 64 } else { 32 }));
        let operands: Vec<i64> = [1, 2, 3].into_iter().chain(widths.collect::<Vec<_>>()).collect();
        p.emit(op, &operands);
        return;
    }
    let has_address = row.room == "local" || row.room == "bus";
    if row.room == "packet" {
        // A packet of at most seven triangles.
        p.emit(Op::andi, &[4, 4, 0xff]).emit(Op::andi, &[5, 5, 7]);
    }
    if row.room == "walk" {
        // A block of three nodes, the first of which is the one to begin with.
        p.emit(Op::andi, &[4, 4, 0xff]).emit(Op::movi, &[5, 64]).emit(Op::sw, &[5, 4, 0]);
        p.emit(Op::movi, &[6, 24]).emit(Op::sw, &[6, 4, 4]).emit(Op::andi, &[6, 6, 0xff]);
    }
    if has_address {
        let base = if row.room == "bus" { DATA } else { 0 };
        p.emit(Op::andi, &[4, 4, 0xff]).emit(Op::iaddi, &[4, 4, base]);
    }
    let operand = |random: &mut Random, letter: u8, kind: Kind| {
        let width = row.pattern.fields().iter().find(|field| field.letter == letter).map_or(5, |field| field.width);
        let (least, most) = kind.range(width);
        match kind {
            Kind::A | Kind::S if has_address && (kind == Kind::A || letter == b'x') => 4,
            Kind::A if ["packet", "walk"].contains(&&*row.room) => 4,
            Kind::S if row.room == "packet" || row.room == "walk" && letter == b'x' => 5,
            Kind::S if row.room == "walk" => 6,
            Kind::S | Kind::A => random.below(FREE + 1),
            Kind::Off if has_address => random.below(100),
            _ => least + random.below(most - least + 1),
        }
    };
    let operands: Vec<i64> = row.operands.iter().map(|o| operand(random, o.letter, o.kind)).collect();
    p.emit(op, &operands);
}

/// Rows that a work item may execute anywhere.
fn anywhere(op: &Op, isa: &Isa) -> bool {
    let row = isa.definition(*op);
    let is_write = matches!(op, Op::store | Op::stw | Op::stv | Op::fetchadd);
    let is_meeting = matches!(op, Op::send2 | Op::send5 | Op::recv2 | Op::recv5 | Op::barrier);
    row.room != "control" && !is_write && !is_meeting
}

/// A few instructions of any kind.
fn straight(p: &mut Builder, random: &mut Random, isa: &Isa, count: i64) {
    let ops: Vec<Op> = Op::BUILT_IN.iter().copied().filter(|op| anywhere(op, isa)).collect();
    for _ in 0..count {
        let op = ops[random.below(ops.len() as i64) as usize];
        instruction(p, random, op, isa.definition(op));
    }
}

/// Instructions with branches on what registers hold, loops whose length they choose, and calls.
fn structured(p: &mut Builder, random: &mut Random, isa: &Isa, depth: i64) {
    for _ in 0..3 {
        straight(p, random, isa, 4);
        let scalars = [random.below(FREE + 1), random.below(FREE + 1)];
        match random.below(if depth == 0 { 1 } else { 4 }) {
            0 => {
                let (other, end) = (p.label(), p.label());
                let rows = [Op::beq, Op::bne, Op::blt, Op::bge, Op::bltu, Op::bgeu];
                match random.below(2) {
                    0 => p.branch(rows[random.below(6) as usize], &scalars, other),
                    _ => p.branch([Op::bwltz, Op::bwgez][random.below(2) as usize], &[random.below(8)], other),
                };
                straight(p, random, isa, 2);
                p.branch(Op::jump, &[], end);
                p.place(other);
                straight(p, random, isa, 3);
                p.place(end);
            }
            1 => {
                // A loop of one to four rounds.
                let counter = 24 + depth;
                p.emit(Op::andi, &[counter, scalars[0], 3]);
                let again = p.here();
                structured(p, random, isa, depth - 1);
                p.emit(Op::isubi, &[counter, counter, 1]);
                p.branch(Op::bge, &[counter, 0], again);
            }
            2 => {
                // A function, called from two places, by its address the second time.
                let (over, function, link) = (p.label(), p.label(), 28 + depth);
                p.branch(Op::call, &[link], function);
                straight(p, random, isa, 1);
                p.branch(Op::call, &[23], over);
                p.place(function);
                structured(p, random, isa, depth - 1);
                p.emit(Op::ret, &[link]);
                p.place(over);
            }
            _ => {
                let early = p.label();
                p.branch(Op::blt, &scalars, early);
                structured(p, random, isa, depth - 1);
                p.place(early);
            }
        }
    }
}

#[test]
fn any_row_on_any_operands() {
    let isa = Isa::base();
    for (seed, &op) in Op::BUILT_IN.iter().filter(|op| anywhere(op, &isa)).enumerate() {
        let mut random = Random::new(seed as u64);
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

/// Rows go on to each other by jumps; were one of them a call, it would leave something on the stack each time.
#[test]
fn a_long_loop_over_all_rows_takes_no_stack() {
    let isa = Isa::base();
    let mut random = Random::new(77);
    let core = program(|p| {
        scatter(p, &mut random);
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

#[test]
fn loops_calls_and_branches() {
    let isa = Isa::base();
    let mut ends = 0;
    for seed in 0..60 {
        let mut random = Random::new(1000 + seed);
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
        let mut random = Random::new(2000 + seed);
        let core = program(|p| {
            scatter(p, &mut random);
            for _ in 0..random.below(30) {
                p.word(random.next() as u32);
            }
            gather(p);
        });
        // Most trap; both engines at the same place.
        let _ = same(&format!("words {seed}"), &core, 100_000);
    }
}

#[test]
fn what_is_unusual_is_the_interpreters() {
    let few = |body: fn(&mut Builder)| {
        program(|p| {
            p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[NUMBER, 0, 0]).emit(Op::movi, &[1, 40]);
            body(p);
            gather(p);
        })
    };
    let end = |name: &str, body: fn(&mut Builder)| same(name, &few(body), 5000).map(|_| ()).unwrap_err();
    let trap = end("a trap", |p| {
        let past = p.label();
        p.branch(Op::bne, &[NUMBER, 1], past).emit(Op::trap, &[9]);
        p.place(past);
    });
    assert!(trap.contains("trap 9") && trap.contains("40, 40, 40"), "{trap}");
    let outside = end("an access", |p| {
        p.emit(Op::slli, &[2, NUMBER, 9]).emit(Op::lw, &[3, 2, 0]);
    });
    assert!(outside.contains("37, 37, 37"), "{outside}");
    let endless = end("no end", |p| {
        let here = p.here();
        p.branch(Op::jump, &[], here);
    });
    assert!(endless.contains("5000 instructions"), "{endless}");
    let core = few(|p| {
        p.emit(Op::core, &[3]);
    });
    let step = same("a core's number", &core, 5000).expect("it is stepped");
    assert_eq!(step.method.reason(), Some("a work item asks which core it runs on"));
}

/// Something that may read the number of cores, write where it is, or leave it alone.
fn meddle(p: &mut Builder, random: &mut Random, depth: i64) {
    let register = 20 + random.below(2);
    match random.below(if depth == 0 { 6 } else { 9 }) {
        0 => p.emit(Op::iadd, &[1, 1, register]),
        1 => p.emit(Op::movi, &[register, 5]),
        2 => p.emit(Op::cores, &[21]),
        3..6 => p.emit(Op::iaddi, &[1, 1, 7]),
        6 => {
            let end = p.label();
            p.emit(Op::andi, &[3, NUMBER, 1 + random.below(4)]);
            p.branch(Op::beq, &[3, 0], end);
            meddle(p, random, depth - 1);
            meddle(p, random, depth - 1);
            p.place(end)
        }
        7 => {
            let counter = 24 + depth;
            p.emit(Op::movi, &[counter, random.below(3)]);
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
        let random = &mut Random::new(seed);
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
