//! Instructions to words and back.

use isa::{EncodeError, Isa, Op};

use super::drawing::{Drawing, all};
use super::random::Random;

/// Fields of more values are not walked through one by one.
const MOST_VALUES: i64 = 1 << 16;

/// All rows with their opcodes.
fn rows() -> impl Iterator<Item = (Op, Drawing<'static>)> {
    Op::BUILT_IN.iter().copied().zip(all())
}

/// Operands that all are the least, or the largest, of their fields.
fn ends(drawing: &Drawing) -> [Vec<i64>; 2] {
    let (least, most) = drawing.ranges().into_iter().unzip();
    [least, most]
}

/// Checks that a row with these operands is the word of its bit pattern, and that this word is nothing else.
fn check(isa: &Isa, op: Op, drawing: &Drawing, operands: &[i64]) {
    let (row, expected) = (drawing.row, drawing.word(operands));
    assert_eq!(isa.encode(op, operands), Ok(expected), "{} {operands:?}", row.name);
    let Some(decoded) = isa.decode(expected) else { panic!("{} {operands:?} is no instruction", row.name) };
    assert_eq!(decoded.op, op, "{} {operands:?}", row.name);
    for (operand, &value) in row.operands.iter().zip(operands) {
        assert_eq!(decoded.fields.get(operand.letter), value, "{} {operands:?}", row.name);
    }
}

#[test]
fn every_value_of_every_field_survives() {
    let isa = Isa::base();
    for (op, drawing) in rows() {
        for (place, &(least, most)) in drawing.ranges().iter().enumerate() {
            // A prime step, so that all low bits change.
            let step = if most - least < MOST_VALUES { 1 } else { 1021 };
            // The others stand at the far end, so that no bit of theirs is like its neighbour's by chance.
            for (value, others) in (least..=most).step_by(step).chain([most]).zip(ends(&drawing).iter().cycle()) {
                let mut operands = others.clone();
                operands[place] = value;
                check(&isa, op, &drawing, &operands);
            }
        }
        for operands in ends(&drawing) {
            check(&isa, op, &drawing, &operands);
        }
    }
}

#[test]
fn all_fields_together_survive() {
    let isa = Isa::base();
    let mut random = Random::new(1);
    for (op, drawing) in rows() {
        for _ in 0..1000 {
            let operands: Vec<i64> = drawing.ranges().iter().map(|&(least, most)| random.within(least, most)).collect();
            check(&isa, op, &drawing, &operands);
        }
    }
}

#[test]
fn what_a_field_does_not_hold_is_refused() {
    let isa = Isa::base();
    for (op, drawing) in rows() {
        let name = &drawing.row.name;
        let [right, _] = ends(&drawing);
        for (operand, &(least, most)) in drawing.ranges().iter().enumerate() {
            for value in [least - 1, most + 1, i64::MIN, i64::MAX, least - (1 << 32), most + (1 << 32)] {
                let mut operands = right.clone();
                operands[operand] = value;
                let refusal = Err(EncodeError::Range { operand, value, least, most });
                assert_eq!(isa.encode(op, &operands), refusal, "{name}");
            }
        }
        let expected = right.len();
        let refusal = Err(EncodeError::Operands { expected });
        assert_eq!(isa.encode(op, &[&right[..], &[0]].concat()), refusal, "{name}");
        if let Some((_, fewer)) = right.split_last() {
            assert_eq!(isa.encode(op, fewer), refusal, "{name}");
        }
    }
}

#[test]
fn a_bit_at_a_dash_makes_an_illegal_word() {
    let isa = Isa::base();
    for (_, drawing) in rows() {
        for operands in ends(&drawing) {
            for place in (0..32).filter(|&place| drawing.bits[place] == '-') {
                let wrong = drawing.word(&operands) | 1 << place;
                assert_eq!(isa.decode(wrong), None, "{} with bit {place}: {wrong:#010x}", drawing.row.name);
            }
        }
    }
}

#[test]
fn registers_and_lanes_that_do_not_exist_make_an_illegal_word() {
    let isa = Isa::base();
    let mut count = 0;
    for (_, drawing) in rows() {
        for (place, (operand, (_, most))) in drawing.row.operands.iter().zip(drawing.ranges()).enumerate() {
            let end = if operand.kind.is_signed() { 0 } else { drawing.values(place) };
            for value in most + 1..end {
                let mut operands = vec![0; drawing.row.operands.len()];
                operands[place] = value;
                assert_eq!(isa.decode(drawing.word(&operands)), None, "{} {operands:?}", drawing.row.name);
                count += 1;
            }
        }
    }
    assert!(count > 0, "groups and lanes leave some numbers free");
}

#[test]
fn no_word_is_two_instructions() {
    let drawings = all();
    for (at, drawing) in drawings.iter().enumerate() {
        for other in &drawings[..at] {
            let differ = |(a, b): (&char, &char)| matches!((a, b), ('0' | '-', '1') | ('1', '0' | '-'));
            let is_apart = drawing.bits.iter().zip(&other.bits).any(differ);
            assert!(is_apart, "{} and {}", drawing.row.name, other.row.name);
        }
    }
}

#[test]
fn any_word_is_no_instruction_or_the_word_of_one() {
    let isa = Isa::base();
    let mut random = Random::new(2);
    let drawings = all();
    for _ in 0..100_000 {
        // A few bits away from a row, since most words are nothing.
        let near = &drawings[random.within(0, drawings.len() as i64 - 1) as usize];
        let operands: Vec<i64> = near.row.operands.iter().map(|_| random.next() as i64).collect();
        let flips = (0..random.next() % 3).fold(0, |flips, _| flips | 1 << (random.next() % 32));
        let found = near.word(&operands) ^ flips;
        let matching = drawings.iter().find(|drawing| drawing.matches(found));
        match (isa.decode(found), matching) {
            (Some(instruction), Some(drawing)) => {
                assert_eq!(isa.definition(instruction.op).name, drawing.row.name, "{found:#010x}");
                let fields = drawing.row.operands.iter().map(|operand| instruction.fields.get(operand.letter));
                assert_eq!(isa.encode(instruction.op, &fields.collect::<Vec<_>>()), Ok(found), "{found:#010x}");
            }
            (None, Some(drawing)) => assert!(drawing.is_beyond(found), "{found:#010x} is `{}`", drawing.row.name),
            (decoded, None) => assert_eq!(decoded, None, "{found:#010x}"),
        }
    }
}
