use fixed::types::{I8F8, I16F16, I24F8};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::*;
use isa::number::{Arithmetic, Flags, Modes, Overflow, Quantization};
use messages::Source;

fn signed(word: u32, integer: i32) -> Format {
    Format { is_signed: true, word, integer }
}

/// All modes of overflow with up to `most` saturated bits.
fn overflows(most: u32) -> impl Iterator<Item = Overflow> {
    let wraps = (0..=most).flat_map(|bits| [Overflow::Wrap(bits), Overflow::WrapSm(bits)]);
    [Overflow::Sat, Overflow::SatZero, Overflow::SatSym].into_iter().chain(wraps)
}

fn converted(value: i128, shift: u32, word: u32, quantization: Quantization, overflow: Overflow) -> OperationOutcome {
    let number = Number { format: signed(64, 64 - shift as i32), raw: value };
    operate(Operation::Cvt, &[number], signed(word, word as i32), quantization, overflow)
}

#[test]
fn the_machine_overflows_as_the_model_says() {
    for bits in 1..=6 {
        let end = 4i128 << bits;
        for (value, overflow) in (-end..end).flat_map(|value| overflows(bits + 1).map(move |mode| (value, mode))) {
            let modes = Modes { word: bits, quantization: Quantization::Trn, overflow };
            let expected = converted(value, 0, bits, Quantization::Trn, overflow);
            assert_eq!(i128::from(modes.quantize(value, 0, bits)), expected.raw, "{value} in {bits} bits, {overflow}");
            let largest = (1 << (bits - 1)) - 1;
            let least = if overflow == Overflow::SatSym { -largest } else { -largest - 1 };
            assert_eq!(
                expected.has_overflowed,
                !(least..=largest).contains(&value),
                "{value} in {bits} bits, {overflow}"
            );
        }
    }
}

#[test]
fn the_machine_rounds_as_the_model_says() {
    for (shift, &quantization) in (0..5).flat_map(|shift| Quantization::ALL.iter().map(move |mode| (shift, mode))) {
        for value in -200..200 {
            let modes = Modes { word: 32, quantization, overflow: Overflow::Sat };
            let expected = converted(value, shift, 32, quantization, Overflow::Sat);
            assert_eq!(i128::from(modes.narrow(value, shift)), expected.raw, "{value} >> {shift}, {quantization}");
            assert_eq!(expected.is_quantized, value & ((1 << shift) - 1) != 0);
            if shift > 0 {
                let quotient = modes.quotient(value, 1 << shift);
                assert_eq!(i128::from(quotient), expected.raw, "{value} / 2^{shift}, {quantization}");
            }
        }
    }
}

#[test]
fn the_machines_flags_are_the_models() {
    let flags = |outcome: &OperationOutcome| Flags {
        is_quantized: outcome.is_quantized,
        has_overflowed: outcome.has_overflowed,
    };
    for (&quantization, overflow) in
        Quantization::ALL.iter().flat_map(|mode| overflows(0).map(move |over| (mode, over)))
    {
        let modes = Modes { word: 4, quantization, overflow };
        for (value, shift) in (-40..40).flat_map(|value| (0..4).map(move |shift| (value, shift))) {
            let expected = flags(&converted(value, shift, 4, quantization, overflow));
            assert_eq!(modes.flags_of(value, shift, 4), expected, "{value} >> {shift}, {quantization}, {overflow}");
        }
        let format = signed(8, 8);
        for (a, b) in (-24..24).flat_map(|a| (-5..5).map(move |b| (a, b))) {
            let operands = [Number { format, raw: a }, Number { format, raw: b }];
            let expected = flags(&operate(Operation::Div, &operands, signed(4, 4), quantization, overflow));
            assert_eq!(modes.flags_of_quotient(a, b), expected, "{a} / {b}, {quantization}, {overflow}");
        }
    }
}

#[test]
fn the_model_agrees_with_the_crate_fixed() {
    for raw in (-70_000..70_000).step_by(7) {
        let value = I16F16::from_bits(raw * 13);
        let rounded = |mode| converted(i128::from(value.to_bits()), 16, 32, mode, Overflow::Sat).raw;
        assert_eq!(rounded(Quantization::Trn), value.floor().to_num::<i128>());
        assert_eq!(rounded(Quantization::TrnZero), value.round_to_zero().to_num::<i128>());
        assert_eq!(rounded(Quantization::RndInf), value.round().to_num::<i128>());
        assert_eq!(rounded(Quantization::RndConv), value.round_ties_even().to_num::<i128>());
        let long = I24F8::from_bits(raw);
        let fitted = |mode| converted(raw.into(), 0, 16, Quantization::Trn, mode).raw;
        assert_eq!(fitted(Overflow::Sat), i128::from(long.saturating_to_num::<I8F8>().to_bits()));
        assert_eq!(fitted(Overflow::Wrap(0)), i128::from(long.wrapping_to_num::<I8F8>().to_bits()));
    }
}

#[test]
fn saturated_bits_are_those_of_the_standard() {
    // In five bits 0b0110_1101 = 109, -109 = ...1001_0011, 0b0100_0110 = 70 and -70 = ...1011_1010.
    let fit = |value: i128, overflow| converted(value, 0, 5, Quantization::Trn, overflow).raw & 31;
    for (overflow, above, below) in [
        (Overflow::Wrap(1), 0b00110, 0b11010),
        (Overflow::Wrap(2), 0b01110, 0b10010),
        (Overflow::Wrap(4), 0b01110, 0b10000),
        (Overflow::WrapSm(0), 0b00110, 0b11010),
        (Overflow::WrapSm(1), 0b00110, 0b11010),
        (Overflow::WrapSm(2), 0b01001, 0b10101),
        (Overflow::WrapSm(3), 0b01110, 0b10010),
        (Overflow::WrapSm(4), 0b01110, 0b10001),
    ] {
        assert_eq!((fit(70, overflow), fit(-70, overflow)), (above, below), "{overflow}");
    }
    for (overflow, above, below) in [
        (Overflow::Wrap(0), 0b01101, 0b10011),
        (Overflow::Wrap(1), 0b01101, 0b10011),
        (Overflow::Wrap(2), 0b01101, 0b10011),
        (Overflow::Wrap(3), 0b01101, 0b10011),
        (Overflow::Wrap(4), 0b01111, 0b10001),
        (Overflow::Wrap(5), 0b01111, 0b10000),
        (Overflow::WrapSm(0), 0b10010, 0b01100),
        (Overflow::WrapSm(1), 0b01101, 0b10011),
        (Overflow::WrapSm(2), 0b01101, 0b10011),
        (Overflow::WrapSm(3), 0b01101, 0b10011),
        (Overflow::WrapSm(4), 0b01110, 0b10000),
        (Overflow::WrapSm(6), 0b01111, 0b10000),
    ] {
        assert_eq!((fit(109, overflow), fit(-109, overflow)), (above, below), "{overflow}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn the_machine_computes_as_the_model_does(
        word in 8u32..=32,
        a: i32,
        b: i32,
        shift in 0u32..32,
        rounding in 0usize..7,
        overflow in 0usize..5,
        saturated in 0u32..34,
    ) {
        let (a, b) = (a >> (32 - word), b >> (32 - word));
        let quantization = Quantization::ALL[rounding];
        let overflow = Overflow::ALL[overflow].with_saturated(saturated);
        let modes = Modes { word, quantization, overflow };
        let format = signed(word, word as i32 - shift as i32);
        let operands = [a, b].map(|raw| Number { format, raw: raw.into() });
        let (wide_a, wide_b) = (i128::from(a), i128::from(b));
        let model = |operation| operate(operation, &operands, format, quantization, overflow).raw;
        prop_assert_eq!(i128::from(modes.narrow(wide_a + wide_b, 0)), model(Operation::Add));
        prop_assert_eq!(i128::from(modes.narrow(wide_a - wide_b, 0)), model(Operation::Sub));
        prop_assert_eq!(i128::from(modes.narrow(wide_a * wide_b, shift)), model(Operation::Mul));
        prop_assert_eq!(i128::from(modes.quotient(wide_a << shift, wide_b)), model(Operation::Div));
        let sum = Number { format: signed(word, word as i32 - 2 * shift as i32), raw: wide_b };
        let mac = operate(Operation::Mac, &[operands[0], operands[1], sum], format, quantization, overflow).raw;
        prop_assert_eq!(i128::from(modes.narrow(wide_a * wide_b + wide_b, shift)), mac);
    }

    /// 128 bits and unbounded integers are two ways through the same formulas: far scales and near ones agree.
    #[test]
    fn results_do_not_depend_on_where_the_points_are(
        a: u64,
        b: u64,
        moved in -60i32..=60,
        rounding in 0usize..7,
        operation in 0usize..7,
    ) {
        let operation = Operation::ALL[operation];
        let (word, quantization) = (40, Quantization::ALL[rounding]);
        let number = |raw: u64, integer| Number { format: Format { is_signed: false, word, integer }, raw: i128::from(raw >> 24) };
        let at = |moved: i32| {
            let product = matches!(operation, Operation::Mul | Operation::Mac);
            let operands = [number(a, 38 + moved), number(b, 37 + moved), number(b, if product { 39 + 2 * moved } else { 39 + moved })];
            let integer = match operation {
                Operation::Mul | Operation::Mac => 36 + 2 * moved,
                Operation::Div => 36,
                _ => 36 + moved,
            };
            operate(operation, &operands[..operation.operands()], signed(word, integer), quantization, Overflow::Wrap(0))
        };
        prop_assert_eq!(at(0), at(moved));
    }
}

fn parsed(lines: &str) -> (Vec<TestVector>, String) {
    let (vectors, report) = parse(&Source::new("vectors.csv", format!("{HEADER}\n{lines}")));
    (vectors, report.render(false))
}

#[test]
fn vectors_are_read_and_computed() {
    let lines = "mul,s,8,4,24,s,8,4,-40,-,-,-,-,s,8,4,RND,SAT,0,-60,0,0\n\
                 cvt,s,16,8,-1,-,-,-,-,-,-,-,-,u,8,8,TRN,SAT,-,0,1,1\r\n\n\
                 mac,s,64,64,9223372036854775807,s,64,64,9223372036854775807,u,64,128,18446744073709551615,s,64,128,SC_RND,SC_SAT,0,9223372036854775807,1,1\n\
                 div,s,8,4,-7,u,8,4,0,-,-,-,-,s,8,4,RND,WRAP,2,-128,0,1\n\
                 add,s,8,128,1,s,8,-64,1,-,-,-,-,s,8,128,TRN,WRAP,0,1,1,0\n\
                 sub,s,8,4,3,s,8,4,4,-,-,-,-,s,8,4,TRN,SAT,0,-1,-,-\n";
    let (vectors, messages) = parsed(lines);
    assert_eq!(messages, "");
    let lines: Vec<usize> = vectors.iter().map(|vector| vector.line).collect();
    assert_eq!(lines, [2, 3, 5, 6, 7, 8]);
    for vector in &vectors {
        assert!(vector.expects(&vector.outcome()), "{vector:?} gives {:?}", vector.outcome());
    }
}

#[test]
fn lines_that_are_no_vectors_are_told_with_their_place() {
    for (line, message) in [
        ("mull,s,8,4,1,s,8,4,1,-,-,-,-,s,8,4,RND,SAT,0,1,0,0", "did you mean `mul`?"),
        ("mul,s,8,4,1,s,8,4,1,-,-,-,-,s,8,4,RND,SAT,0,1,0", "this line has 21 of 22 columns"),
        ("mul,s,8,4,1,s,8,4,1,-,-,-,-,s,8,4,RND,SAT,0,1,0,0,0", "more than 22 columns"),
        ("mul,s,8,4,128,s,8,4,1,-,-,-,-,s,8,4,RND,SAT,0,1,0,0", "128 in column a is out of range"),
        ("mul,s,65,4,1,s,8,4,1,-,-,-,-,s,8,4,RND,SAT,0,1,0,0", "65 in column wa is out of range"),
        ("mul,s,8,-65,1,s,8,4,1,-,-,-,-,s,8,4,RND,SAT,0,1,0,0", "-65 in column ia is out of range"),
        ("mul,s,8,4,x,s,8,4,1,-,-,-,-,s,8,4,RND,SAT,0,1,0,0", "`x` in column a is no whole number"),
        ("mul,s,8,4,1,-,-,-,-,-,-,-,-,s,8,4,RND,SAT,0,1,0,0", "`-` in column sb is no kind of number"),
        ("neg,s,8,4,1,s,8,4,1,-,-,-,-,s,8,4,RND,SAT,0,1,0,0", "`neg` has no operand in column sb"),
        ("neg,s,8,4,1,-,-,-,-,-,-,-,-,u,8,4,RND,WRAP_SM,0,1,0,0", "have no WRAP_SM"),
        ("neg,s,8,4,1,-,-,-,-,-,-,-,-,s,8,4,ROUND,SAT,0,1,0,0", "`ROUND` in column q is no rounding mode"),
        ("neg,s,8,4,1,-,-,-,-,-,-,-,-,s,8,4,RND,SAT,0,1,0,2", "2 in column of is out of range"),
    ] {
        let (vectors, messages) = parsed(line);
        assert!(vectors.is_empty() && messages.contains(message) && messages.contains("vectors.csv:2"), "{messages}");
    }
    let (_, messages) = parsed(&"x\n".repeat(50));
    assert!(messages.contains("30 more lines are no vectors"), "{messages}");
    let (vectors, report) = parse(&Source::new("vectors.csv", "op,a,b\n"));
    assert!(vectors.is_empty() && report.render(false).contains("the first line names the columns"));
    assert!(parse(&Source::new("vectors.csv", "")).1.has_errors());
}

#[test]
fn the_document_shows_what_the_modes_do() {
    let text = include_str!("../../docs/arithmetic.md");
    let mut shown = 0;
    for line in text.lines().filter_map(|line| line.strip_prefix("| `")) {
        let (name, rest) = line.split_once('`').expect("a name ends");
        let results: Vec<&str> = rest.trim_end_matches(" |").rsplit("| ").next().unwrap().split(", ").collect();
        let mut claim = |found: Vec<String>| {
            assert_eq!(results, found, "{name}");
            shown += 1;
        };
        if let Some(mode) = Quantization::from_name(name) {
            let rounded = |quarters| converted(quarters, 2, 32, mode, Overflow::Sat).raw.to_string();
            claim([-6, -2, 2, 6, 7].map(rounded).to_vec());
        } else if let Some(mode) = Overflow::from_name(name) {
            let fitted = |value| converted(value, 0, 5, Quantization::Trn, mode).raw & 31;
            claim([70, -70].map(|value| format!("{:05b}", fitted(value))).to_vec());
        }
    }
    assert_eq!(shown, 14, "every mode, and two with saturated bits");
}
