//! Decisions that shadows take with the machine or otherwise, and cancellation, as ledgers tell them.

use emu::machine::Config;
use emu::registers::Registers;
use isa::{Isa, Op};

use super::super::builder::program;
use super::shadowed;

#[test]
fn cancellation_and_turned_decisions_are_told() {
    let (isa, config) = (Isa::base(), Config::default());
    let program = program(|p| {
        p.constant(1, 1 << 20);
        p.constant(2, 3);
        p.emit(Op::div, &[3, 1, 2, 0]); // 349525, exactly 349525 1/3
        p.emit(Op::mul, &[4, 3, 2, 0]);
        p.emit(Op::sub, &[5, 4, 1]); // -1, exactly 0
        let end = p.label();
        p.branch(Op::blt, &[5, 0], end); // the exact number is not below 0
        p.place(end);
        p.emit(Op::halt, &[]);
    });
    let mut stepper = shadowed(&config, &isa, &program, Registers::default());
    stepper.run_to(u64::MAX);
    let shadow = stepper.shadow().unwrap();
    let line = |word: u32| &shadow.ledger.lines[shadow.program.sites.of(word) as usize];
    assert_eq!((line(6).cancelled, line(6).fewest_bits), (1, Some(0.0)), "no bit of -1 is right");
    assert_eq!(
        line(6).doubtful,
        1,
        "of a third, taken three times, less the number, exact arithmetic leaves nothing either"
    );
    assert_eq!((line(7).decisions, line(7).turned), (1, 1));
    assert_eq!((line(4).saturated, line(4).results), (0, 1));
    assert!((line(4).brought.ulps - 1.0 / 3.0).abs() < 1e-9 && line(5).brought.ulps == 0.0);
    assert!((line(5).arrived.ulps - 1.0).abs() < 1e-9);
}

#[test]
fn decisions_are_counted_on_numbers_and_not_on_integers() {
    let (isa, config) = (Isa::base(), Config::default());
    let mut registers = Registers::default();
    for (at, vector) in [(1, [100, 120, 140]), (2, [3, -5, 7]), (3, [200, 0, 0]), (4, [300, 90, 0]), (5, [300, 0, 900])]
    {
        registers.set_vector(at, vector);
    }
    // A node's plane x = 200, the start of the ray, and the plane y = -1000 by which it leaves.
    (0u8..)
        .zip([200, 3 << 32, 1 << 32 | i64::from(-1000_i32 as u32)])
        .for_each(|(at, plane)| registers.set_wide(at, plane));
    let decides: [(Op, &[i64], u64); 9] = [
        (Op::vmajor, &[5, 2], 1),
        (Op::vlt, &[5, 1, 2], 3),
        (Op::rtri, &[5, 8, 1, 3, 16], 1),
        (Op::rbox, &[4, 5, 1, 3], 1),
        (Op::rexit, &[4, 1, 3], 1),
        (Op::rstep, &[5, 6, 1, 0, 8], 1),
        (Op::rbefore, &[5, 1, 2, 0, 16], 1),
        (Op::rwalk, &[4, 10, 11, 1, 1, 12], 1),
        (Op::rnear, &[8, 1, 13, 14, 16], 1),
    ];
    for is_number in [false, true] {
        let program = program(|p| {
            // What is computed has a shadow, here one that is the machine's number.
            for vector in [1, 2] {
                p.emit(Op::vadd, &[if is_number { vector } else { 20 }, vector, 0]);
            }
            p.constant(9, 8);
            // A block of one node at address 0, and a note of the last plane at 64.
            p.emit(Op::sw, &[0, 0, 0]);
            p.emit(Op::sw, &[9, 0, 4]);
            p.emit(Op::swide, &[0, 0, 8]);
            p.emit(Op::swide, &[2, 0, 64]);
            p.constant(11, 64);
            p.constant(13, 128);
            p.constant(14, 1);
            decides.iter().for_each(|(op, operands, _)| {
                p.emit(*op, operands);
            });
            p.emit(Op::halt, &[]);
        });
        let mut stepper = shadowed(&config, &isa, &program, registers.clone());
        stepper.run_to(u64::MAX);
        let shadow = stepper.shadow().unwrap();
        let first = program.words.len() - decides.len() - 1;
        for (word, (op, _, expected)) in (first as u32..).zip(decides) {
            let line = &shadow.ledger.lines[shadow.program.sites.of(word) as usize];
            let expected = if is_number { expected } else { 0 };
            assert_eq!(
                (line.decisions, line.turned),
                (expected, 0),
                "{op:?}, numbers: {is_number}, {:?}",
                stepper.end()
            );
        }
    }
}
