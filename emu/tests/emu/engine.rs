//! Programs by themselves, on every engine: registers, the local buffer, times, and any words at all.

use emu::code::Code;
use emu::engine::{EngineKind, Wish};
use emu::machine::Config;
use emu::machine::one_core::{self, OneCore, OneCoreRun};
use emu::machine::preset::PRESETS;
use emu::octets::{Memory, POISON};
use emu::profile::ProfileLevel;
use emu::registers::Registers;
use emu::tally::Losses;
use emu::trap::Fault;
use isa::number::{Overflow, Quantization};
use isa::{Class, InstructionDef, Isa, Op, Program};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::builder::{ProgramBuilder, program};

fn run_with(config: &Config, program: &Program, registers: Registers) -> OneCoreRun {
    run_on_both(config, program, registers, false)
}

fn run_on_both(config: &Config, program: &Program, registers: Registers, has_losses: bool) -> OneCoreRun {
    let isa = Isa::base();
    let one_core = OneCore {
        registers,
        step_limit: 500,
        profile: ProfileLevel::Extremes,
        has_losses,
        ..OneCore::new(config, &isa, program)
    };
    let long = OneCore { registers: one_core.registers.clone(), step_limit: 1 << 20, ..one_core };
    let memory = || Memory::new((0..=255).collect());
    let checked = one_core::run_with(&one_core, memory(), Wish::CHECKED).expect("the setup is right");
    // Native code leaves what is close to the step limit to the interpreter.
    if checked.trap.as_ref().is_some_and(|trap| trap.kind == Fault::StepLimit(500)) {
        return checked;
    }
    let native = one_core::run_with(&long, memory(), Wish::native()).expect("the setup is right");
    let parts = |run: &OneCoreRun| (run.state.clone(), run.clocks, run.waiting, run.tally.clone(), run.trap.clone());
    assert_eq!((parts(&native), &native.memory), (parts(&checked), &checked.memory));
    assert_eq!(native.profile, checked.profile);
    // Programs with an instruction that takes too long for the sums of runs are the interpreter's.
    let is_too_long = native.engine.refusal == Some("an instruction takes more clocks than the sums have room for");
    let kind = if is_too_long { EngineKind::Checked } else { EngineKind::Native };
    assert_eq!(native.engine.kind, kind, "{:?}", native.engine.refusal);
    checked
}

#[test]
fn sums_of_long_times_are_right_on_all_engines() {
    for clocks in [1, 300, 600, 1000] {
        let mut config = Config::default();
        for class in Class::ALL.iter().filter(|class| class.is_elementary()) {
            config.clocks.0[*class] = clocks.into();
        }
        let program = program(|p| {
            p.constant(9, 4);
            let top = p.here();
            (0..100).for_each(|_| {
                p.emit(Op::add, &[1, 1, 2]);
            });
            let test = p.label();
            p.branch(Op::jump, &[], test);
            p.place(test);
            p.emit(Op::rtri, &[3, 8, 1, 3, 16]).emit(Op::isubi, &[9, 9, 1]);
            p.branch(Op::bne, &[9, 0], top);
            p.emit(Op::halt, &[]);
        });
        let mut registers = Registers::default();
        let vectors = [[0, 0, -1000], [0, 0, 1 << 20], [-1000, -1000, 0], [3000, -1000, 0], [-1000, 3000, 0]];
        (1..).zip(vectors).for_each(|(number, vector)| registers.set_vector(number, vector));
        let run = run_with(&config, &program, registers);
        assert_eq!(run.trap, None);
        // Four times 100 additions and the 61 operations of a hit; what counts the loops subtracts and compares.
        assert_eq!(run.state.elementary, 4 * (100 + 61 + 2));
        assert_eq!(run.clocks.0, run.state.elementary * clocks);
    }
}

#[test]
fn clocks_by_the_word_are_the_same_on_all_engines() {
    let program = program(|p| {
        p.constant(9, 40);
        let top = p.here();
        p.emit(Op::vscale, &[6, 7, 9, 3])
            .emit(Op::vdiv, &[6, 6, 9, 2])
            .emit(Op::mov, &[1, 9])
            .emit(Op::andi, &[2, 1, 3]);
        p.emit(Op::isubi, &[9, 9, 1]);
        p.branch(Op::bne, &[9, 0], top);
        p.emit(Op::halt, &[]);
    });
    // A pass of the loop: three products, three quotients, a move, an and, a subtraction, a comparison.
    let a_pass = |name: &str, word: u64| match name {
        "bit_serial" => 8 * word,
        "combinational" => {
            let log = if word > 16 { 5 } else { 4 };
            3 * 2 * log + 3 * word + 2 * log
        }
        "counted_all" => 8 + 2,
        _ => unreachable!("it is none of these"),
    };
    for preset in PRESETS.iter().filter(|preset| ["bit_serial", "combinational", "counted_all"].contains(&preset.name))
    {
        for word in [16, 24, 32] {
            let mut config = preset.config();
            config.arithmetic.word = word;
            let mut registers = Registers::default();
            registers.set_vector(7, [900, -30, 17]);
            let run = run_with(&config, &program, registers);
            let around = run.clocks.0 - 40 * a_pass(preset.name, word.into());
            assert!(around <= 3, "{} {word}: {} clocks beside the loop", preset.name, around);
        }
    }
}

fn run(body: impl FnOnce(&mut ProgramBuilder)) -> OneCoreRun {
    let program = program(|p| {
        body(p);
        p.emit(Op::halt, &[]);
    });
    let run = run_with(&Config::default(), &program, Registers::default());
    assert_eq!(run.trap, None);
    run
}

#[test]
fn what_results_lose_is_counted_word_by_word() {
    let program = program(|p| {
        p.emit(Op::movi, &[1, 3]).emit(Op::movi, &[2, 1 << 14]).emit(Op::lshift, &[3, 2, 16]);
        p.repeat(9, 5, |p| {
            // 3 2^14 / 2^15 = 1.5, 2^14 / 2^14 = 1 and 2^14 / 3.
            p.emit(Op::mul, &[4, 1, 2, 15]).emit(Op::mul, &[4, 2, 1, 14]).emit(Op::div, &[4, 2, 1, 0]);
            // 2^30 + 2^30 does not fit; of three lanes one does not either.
            p.emit(Op::add, &[5, 3, 3]).emit(Op::vput, &[1, 3, 1]).emit(Op::vadd, &[2, 1, 1]);
            p.emit(Op::div, &[6, 2, 0, 0]);
        });
        p.emit(Op::halt, &[]);
    });
    let (isa, config) = (Isa::base(), Config::default());
    let losses = |config: &Config, has_losses| {
        let one_core = OneCore { step_limit: 1 << 20, has_losses, ..OneCore::new(config, &isa, &program) };
        let [run, native] = [Wish::CHECKED, Wish::native()]
            .map(|wish| one_core::run_with(&one_core, Memory::default(), wish).expect("the setup is right"));
        assert_eq!((&native.tally, &native.state, native.engine.kind), (&run.tally, &run.state, EngineKind::Native));
        let code = Code::new(&program, &isa, config.timing());
        let losses = (0..).zip(run.tally.losses(&code)).filter(|(_, losses)| *losses != Losses::default());
        let named = losses
            .map(|(pc, losses)| (code.row(pc).expect("it ran").name.as_ref(), losses.quantized, losses.overflowed));
        (
            named.map(|(name, quantized, overflowed)| (name.to_owned(), quantized, overflowed)).collect::<Vec<_>>(),
            run.state,
        )
    };
    let (found, state) = losses(&config, true);
    let expected = [("mul", 5, 0), ("div", 5, 0), ("add", 0, 5), ("vadd", 0, 5), ("div", 0, 5)];
    assert_eq!(found, expected.map(|(name, quantized, overflowed)| (name.to_owned(), quantized, overflowed)));
    assert_eq!(losses(&config, false), (Vec::new(), state), "nobody asked, and the results are the same");
}

#[test]
fn s0_reads_zero_and_ignores_writes() {
    let run = run(|p| {
        p.emit(Op::movi, &[0, 5]).emit(Op::iaddi, &[1, 0, 7]);
        p.emit(Op::movi, &[2, 1]).emit(Op::vsplat, &[1, 2]).emit(Op::vnorm, &[1, 0, 1]).emit(Op::iadd, &[3, 0, 0]);
    });
    let scalars: Vec<i32> = (0..4).map(|number| run.state.registers.scalar(number)).collect();
    assert_eq!(scalars, [0, 7, 1, 0]);
}

#[test]
fn where_two_results_meet_in_a_register_the_later_operand_stays() {
    let run = run(|p| {
        p.emit(Op::movi, &[1, 40]).emit(Op::lwp, &[1, 1, 4]);
    });
    assert_eq!(run.state.registers.scalar(1), 44);
}

#[test]
fn the_buffer_starts_with_the_programs_data_and_poison() {
    let mut program = program(|p| {
        p.emit(Op::lw, &[1, 0, 0]).emit(Op::lhu, &[2, 0, 3]).emit(Op::lh, &[3, 0, 100]).emit(Op::halt, &[]);
    });
    program.buffer = vec![1, 2, 3, 4];
    let run = run_with(&Config::default(), &program, Registers::default());
    assert_eq!(run.state.registers.scalar(1), 0x0403_0201);
    assert_eq!(run.state.registers.scalar(2), 4 | i32::from(POISON) << 8);
    assert_eq!(run.state.registers.scalar(3), i32::from(i16::from_le_bytes([POISON; 2])));
    assert_eq!(run.state.buffer.octets().len(), 18_525);
}

#[test]
fn loads_and_stores_are_little_endian_at_any_alignment() {
    let run = run(|p| {
        p.constant(1, 256).emit(Op::load, &[0, 0, 1]).constant(2, 33);
        p.emit(Op::lv, &[1, 2, 0]).emit(Op::lvh, &[2, 2, 100, 4]).emit(Op::lwide, &[1, 2, 0]);
        p.emit(Op::sv, &[1, 2, 300])
            .emit(Op::swide, &[1, 2, 400])
            .emit(Op::sb, &[1, 2, 500])
            .emit(Op::lbu, &[3, 2, 99]);
        p.emit(Op::movi, &[4, 301]).emit(Op::lvp, &[3, 4, 12]).emit(Op::swp, &[2, 4, -13]).emit(Op::lw, &[5, 4, 13]);
    });
    let registers = &run.state.registers;
    assert_eq!(registers.vector(1), [0x2423_2221, 0x2827_2625, 0x2c2b_2a29]);
    // 0x85 0x86, 0x87 0x88, 0x89 0x8a as signed numbers of 16 bits, times 16.
    assert_eq!(registers.vector(2), [0x8685, 0x8887, 0x8a89].map(|lane: i32| (lane - 0x1_0000) * 16));
    assert_eq!(registers.wide(1), 0x2827_2625_2423_2221);
    let octets = run.state.buffer.octets();
    assert_eq!(octets[333..345], *(33..45).collect::<Vec<u8>>());
    assert_eq!(octets[433..441], *(33..41).collect::<Vec<u8>>());
    assert_eq!((octets[533], registers.scalar(3)), (0, 132));
    assert_eq!((registers.scalar(4), registers.scalar(5)), (300, 33));
    assert_eq!(run.waiting.0, 512);
}

#[test]
fn groups_of_registers_are_consecutive() {
    let run = run(|p| {
        p.constant(1, 0x4000_0000);
        for (lane, value) in [(0, 3), (1, -5), (2, 7)] {
            p.emit(Op::movi, &[2, value]).emit(Op::vput, &[27, 2, lane]).emit(Op::vput, &[31, 1, lane]);
        }
        p.emit(Op::wcross, &[5, 27, 31]).emit(Op::wmixed, &[1, 5, 27, 0]);
        p.emit(Op::send5, &[0, 27]).emit(Op::recv5, &[0, 9]);
    });
    let registers = &run.state.registers;
    // (3, -5, 7) x 2^30 (1, 1, 1), and that is at right angles to (3, -5, 7).
    assert_eq!(registers.wides::<3>(5), [-12, 4, 8].map(|lane| lane << 30));
    assert_eq!(registers.wide(1), 0);
    assert_eq!((registers.vector(0), registers.vector(4)), ([3, -5, 7], [0x4000_0000; 3]));
}

/// Random words, most of them instructions with random operands.
fn words() -> impl Strategy<Value = Vec<u32>> {
    let isa = Isa::base();
    let rows: Vec<&'static InstructionDef> = isa::INSTRUCTIONS.iter().collect();
    let instruction = (prop::sample::select((0..rows.len()).collect::<Vec<_>>()), any::<[i64; 6]>());
    let instruction = instruction.prop_map(move |(number, numbers)| {
        let row = rows[number];
        let operand = |(operand, number): (&isa::Operand, i64)| {
            let width = row.pattern.field(operand.letter).map_or(1, |field| field.width);
            let (least, most) = operand.kind.range(width);
            // Near targets and small registers, so that programs do something.
            let (least, most) = if operand.kind == isa::Kind::Rel { (-9, 9) } else { (least, most.min(5).max(least)) };
            least + number.rem_euclid(most - least + 1)
        };
        let operands: Vec<i64> = row.operands.iter().zip(numbers).map(operand).collect();
        isa.encode(Op::BUILT_IN[number], &operands).expect("operands are in their ranges")
    });
    prop::collection::vec(prop_oneof![60 => instruction, 1 => any::<u32>()], 1..60)
}

fn registers() -> impl Strategy<Value = Registers> {
    let scalars = prop::collection::vec(prop_oneof![0..300i32, any::<i32>()], 6);
    let vectors = prop::collection::vec(any::<[i32; 3]>(), 6);
    (scalars, vectors, any::<[i64; 6]>()).prop_map(|(scalars, vectors, wides)| {
        let mut registers = Registers::default();
        for number in 0..6u8 {
            registers.set_scalar(number, scalars[usize::from(number)]);
            registers.set_vector(number, vectors[usize::from(number)]);
            registers.set_wide(number, wides[usize::from(number)]);
        }
        registers
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, rng_seed: RngSeed::Fixed(3), ..ProptestConfig::default() })]

    #[test]
    fn any_words_run_to_an_end_or_a_trap_with_all_accounts_right(words in words(), registers in registers()) {
        let program = Program { words, region_of: vec![], ..Program::default() };
        let config = Config { packet_lanes: 1, ..Config::default() };
        let run = run_with(&config, &program, registers.clone());
        prop_assert!(run.state.steps <= 500);
        let isa = Isa::base();
        let code = Code::new(&program, &isa, config.timing());
        let counts = run.tally.counts(&code);
        prop_assert_eq!(run.tally.instructions(), run.state.steps);
        prop_assert_eq!(counts.elementary(), run.state.elementary);
        prop_assert_eq!(counts.elementary(), run.state.clocks, "one clock an elementary operation");
        prop_assert_eq!(counts[Class::Octet] * 2, run.waiting.0, "two clocks an octet");
        prop_assert_eq!(run.clocks, run.waiting + emu::quantity::Clocks(run.state.clocks));
        prop_assert_eq!(run.profile.as_ref().map(|profile| profile.total()), Some(counts));

        // The same with the modes chosen at run time, up to a division by zero, which only they can trap on.
        let mut watched = config.clone();
        watched.arithmetic.trap_division_by_zero = true;
        let other = run_with(&watched, &program, registers);
        if other.trap.as_ref().map(|trap| trap.kind) != Some(Fault::DivisionByZero) {
            prop_assert_eq!(&run.trap, &other.trap);
            prop_assert_eq!(&run.state, &other.state);
            prop_assert_eq!(&run.memory, &other.memory);
            prop_assert_eq!(&run.tally, &other.tally);
        }
    }

    #[test]
    fn engines_agree_in_all_modes(
        words in words(), registers in registers(), word in 8u32..=32,
        quantization in prop::sample::select(Quantization::ALL), overflow in prop::sample::select(Overflow::ALL),
        saturated in 0u32..4, trap_division_by_zero: bool, has_losses: bool,
    ) {
        let program = Program { words, region_of: vec![], ..Program::default() };
        let mut config = Config::default();
        config.arithmetic.word = word;
        config.arithmetic.quantization = quantization;
        config.arithmetic.overflow = overflow.with_saturated(saturated);
        config.arithmetic.trap_division_by_zero = trap_division_by_zero;
        run_on_both(&config, &program, registers, has_losses);
    }
}
