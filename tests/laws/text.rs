//! Words to text and back, through the assembler.

use asm::{Options, assemble, disassemble};
use isa::Isa;
use messages::Source;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::drawing::{Drawing, all};
use super::random::Random;

/// The words of a source that must assemble.
fn words(isa: &Isa, text: &str) -> Vec<u32> {
    match assemble(&Source::new("text.s", text), isa, &Options::default()) {
        Ok(assembled) => assembled.program.words,
        Err(report) => panic!("{}", report.render(false)),
    }
}

/// Values of a field: all of them, or the ends, the neighbours of powers of two and some others.
fn values(least: i64, most: i64, random: &mut Random) -> Vec<i64> {
    if most - least < 1 << 11 {
        return (least..=most).collect();
    }
    let near_powers = (0..26).flat_map(|bits| [-(1 << bits), 1 << bits]).flat_map(|power| power - 1..=power + 1);
    let others = (0..100).map(|_| random.within(least, most));
    near_powers.chain(others).chain([least, most]).filter(|value| (least..=most).contains(value)).collect()
}

#[test]
fn the_text_of_every_row_assembles_to_its_word() {
    let isa = Isa::base();
    let mut random = Random::new(3);
    let mut expected = Vec::new();
    for drawing in all() {
        let ranges = drawing.ranges();
        for (place, &(least, most)) in ranges.iter().enumerate() {
            for value in values(least, most, &mut random) {
                let mut operands: Vec<i64> = ranges.iter().map(|&(least, most)| random.within(least, most)).collect();
                operands[place] = value;
                expected.push(drawing.word(&operands));
            }
        }
        if ranges.is_empty() {
            expected.push(drawing.word(&[]));
        }
    }
    let mut text = String::new();
    for &word in &expected {
        let instruction = isa.decode(word).unwrap();
        text += &format!("{}\n", instruction.text(&isa, |distance| format!(".{distance:+}")));
    }
    let found = words(&isa, &text);
    for ((&found, &expected), line) in found.iter().zip(&expected).zip(text.lines()) {
        assert_eq!(found, expected, "{line}");
    }
    assert_eq!(found.len(), expected.len());
}

/// A word of any row with any operands; most distances are short, and lead into the program, where they become labels.
fn instruction() -> impl Strategy<Value = u32> {
    (0..isa::INSTRUCTIONS.len(), any::<u64>()).prop_map(|(row, seed)| {
        let (drawing, mut random) = (Drawing::new(&isa::INSTRUCTIONS[row]), Random::new(seed));
        let operands = drawing.row.operands.iter().zip(drawing.ranges());
        let values = operands.map(|(operand, (least, most))| match operand.kind {
            isa::Kind::Rel if random.next() % 4 != 0 => random.within(-20, 20),
            _ => random.within(least, most),
        });
        drawing.word(&values.collect::<Vec<_>>())
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, rng_seed: RngSeed::Fixed(1), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn disassembled_programs_assemble_to_the_same_words(
        program in prop::collection::vec(prop_oneof![8 => instruction(), 1 => any::<u32>()], 0..60)
    ) {
        let isa = Isa::base();
        let text = disassemble(&program, &isa);
        prop_assert_eq!(words(&isa, &text), program, "{}", text);
    }
}
