//! Properties of all sources: instructions round trip, expressions agree with a model of their own, and no text at all
//! brings the assembler down.

use asm::{Options, assemble, disassemble};
use isa::definition::Kind;
use isa::table::Op;
use isa::{Isa, Program};
use messages::{Report, Source};
use proptest::prelude::*;
use testing::check;

fn assembled(text: &str) -> Result<Program, Report> {
    assemble(&Source::new("t.s", text), &Isa::base(), &Options::default()).map(|assembled| assembled.program)
}

/// A row's operands as numbers in range.
fn operands(isa: &Isa, op: Op) -> BoxedStrategy<Vec<i64>> {
    let row = isa.definition(op);
    let parts: Vec<BoxedStrategy<i64>> = row
        .operands
        .iter()
        .map(|operand| {
            let width = row.pattern.field(operand.letter).unwrap().width;
            let (least, most) = operand.kind.range(width);
            prop_oneof![Just(least), Just(most), least..=most].boxed()
        })
        .collect();
    parts.boxed()
}

/// A number in one of the ways of writing it.
fn number(value: i64, style: u8) -> String {
    let sign = if value < 0 { "-" } else { "" };
    match style % 4 {
        0 => format!("{value}"),
        1 => format!("{sign}0x{:X}", value.unsigned_abs()),
        2 => format!("{sign}0b{:b}", value.unsigned_abs()),
        _ => format!("({} + 3)", value - 3),
    }
}

/// The instruction as a person may write it.
fn written(isa: &Isa, op: Op, numbers: &[i64], style: u8) -> String {
    let row = isa.definition(op);
    let mut parts: Vec<String> = Vec::new();
    let mut is_pair_open = false;
    for (place, (operand, &value)) in row.operands.iter().zip(numbers).enumerate() {
        if is_pair_open {
            is_pair_open = false;
            continue;
        }
        if let Some(file) = operand.kind.register_file() {
            let offset = row.operands.get(place + 1).filter(|next| next.kind == Kind::Off && file == 's');
            if offset.is_some() && style < 200 {
                parts.push(format!("{}({file}{value})", number(numbers[place + 1], style)));
                is_pair_open = true;
            } else {
                parts.push(format!("{file}{value}"));
            }
            continue;
        }
        parts.push(match operand.kind {
            Kind::Rel => format!(". + {}", number(value, style)),
            Kind::Lane if style.is_multiple_of(3) => ["x", "y", "z"][value as usize].to_string(),
            _ => number(value, style),
        });
    }
    format!("{} {}", row.name, parts.join(if style.is_multiple_of(2) { ", " } else { "," }))
}

#[test]
fn every_row_assembles_from_any_operands() {
    let isa = Isa::base();
    for op in isa.ops() {
        check(40, &(operands(&isa, op), any::<u8>()), |(numbers, style)| {
            let text = written(&isa, op, &numbers, style);
            let program = assembled(&text).map_err(|report| TestCaseError::fail(format!("{report}")))?;
            prop_assert_eq!(&program.words, &[isa.encode(op, &numbers).unwrap()], "{}", text);
            Ok(())
        });
    }
}

#[test]
fn every_operand_out_of_range_is_refused() {
    let isa = Isa::base();
    for op in isa.ops() {
        let row = isa.definition(op);
        for (place, operand) in row.operands.iter().enumerate() {
            let width = row.pattern.field(operand.letter).unwrap().width;
            let (least, most) = operand.kind.range(width);
            for wrong in [least - 1, most + 1] {
                if operand.kind.register_file().is_some() && wrong < 0 {
                    continue;
                }
                let mut numbers: Vec<i64> = row.operands.iter().map(|_| 0).collect();
                numbers[place] = wrong;
                let text = written(&isa, op, &numbers, 200);
                let report = assembled(&text).expect_err(&text);
                assert_eq!(report.0.len(), 1, "{text}: {report}");
            }
        }
    }
}

#[test]
fn disassembled_words_assemble_to_themselves() {
    let isa = Isa::base();
    let ops: Vec<Op> = isa.ops().collect();
    let isa = &isa;
    let instruction = proptest::sample::select(ops)
        .prop_flat_map(move |op| operands(isa, op).prop_map(move |numbers| isa.encode(op, &numbers).unwrap()));
    let near_branch = (0..4u32, -8..8i64).prop_map(move |(which, distance)| {
        let name = ["beq", "bge", "jump", "call"][which as usize];
        let numbers: &[i64] = match name {
            "jump" => &[distance],
            "call" => &[5, distance],
            _ => &[1, 2, distance],
        };
        isa.encode(isa.find(name).unwrap(), numbers).unwrap()
    });
    let words = proptest::collection::vec(prop_oneof![instruction, near_branch, any::<u32>()], 0..24);
    check(600, &words, |words| {
        let text = disassemble(&words, isa);
        let program = assembled(&text).map_err(|report| TestCaseError::fail(format!("{report}\n{text}")))?;
        prop_assert_eq!(program.words, words, "{}", text);
        Ok(())
    });
}

/// An expression of the model.
#[derive(Clone, Debug)]
enum Tree {
    Number(i64),
    Prefix(char, Box<Tree>),
    Infix(&'static str, Box<Tree>, Box<Tree>),
    Call(&'static str, Vec<Tree>),
}

const LEVELS: [&[&str]; 10] = [
    &["||"],
    &["&&"],
    &["|"],
    &["^"],
    &["&"],
    &["==", "!="],
    &["<", ">", "<=", ">="],
    &["<<", ">>"],
    &["+", "-"],
    &["*", "/", "%"],
];

fn level(mark: &str) -> usize {
    LEVELS.iter().position(|marks| marks.contains(&mark)).unwrap()
}

impl Tree {
    /// The text with no parentheses but the necessary ones; `least` is the level that needs none.
    fn text(&self, least: usize) -> String {
        match self {
            Tree::Number(value) if *value < 0 => format!("({value})"),
            Tree::Number(value) => value.to_string(),
            Tree::Prefix(mark, inner) => format!("{mark} {}", inner.text(LEVELS.len())),
            Tree::Infix(mark, left, right) => {
                let own = level(mark);
                let text = format!("{} {mark} {}", left.text(own), right.text(own + 1));
                if own < least { format!("({text})") } else { text }
            }
            Tree::Call(name, arguments) => {
                let texts: Vec<String> = arguments.iter().map(|argument| argument.text(0)).collect();
                format!("{name}({})", texts.join(", "))
            }
        }
    }

    /// The value on integers that are wide enough for one step, `None` where a step leaves 64 bits.
    fn value(&self) -> Option<i128> {
        let result = match self {
            Tree::Number(value) => i128::from(*value),
            Tree::Prefix(mark, inner) => {
                let value = inner.value()?;
                match mark {
                    '-' => -value,
                    '~' => -1 - value,
                    '!' => i128::from(value == 0),
                    _ => value,
                }
            }
            Tree::Infix(mark, left, right) => {
                let a = left.value()?;
                if *mark == "&&" || *mark == "||" {
                    let decided = (a != 0) == (*mark == "||");
                    return Some(i128::from(if decided { a != 0 } else { right.value()? != 0 }));
                }
                let b = right.value()?;
                let power = || (0..64).contains(&b).then(|| 2i128.pow(b as u32));
                match *mark {
                    "|" => a | b,
                    "^" => a ^ b,
                    "&" => a & b,
                    "==" => i128::from(a == b),
                    "!=" => i128::from(a != b),
                    "<" => i128::from(a < b),
                    ">" => i128::from(a > b),
                    "<=" => i128::from(a <= b),
                    ">=" => i128::from(a >= b),
                    "<<" => a * power()?,
                    ">>" => a.div_euclid(power()?),
                    "+" => a + b,
                    "-" => a - b,
                    "*" => a * b,
                    "/" => a.checked_div(b)?,
                    _ => {
                        // The quotient must fit, too, as C has it.
                        i64::try_from(a.checked_div(b)?).ok()?;
                        a % b
                    }
                }
            }
            Tree::Call(name, arguments) => {
                let values: Option<Vec<i128>> = arguments.iter().map(Tree::value).collect();
                let values = values?;
                match *name {
                    "min" => *values.iter().min()?,
                    "max" => *values.iter().max()?,
                    "abs" => values[0].abs(),
                    _ => (0..=64).find(|&bits| values[0] < 1 << bits).filter(|_| values[0] >= 0)?.into(),
                }
            }
        };
        i64::try_from(result).ok().map(i128::from)
    }
}

fn trees() -> impl Strategy<Value = Tree> {
    let number = prop_oneof![
        4 => -10..70i64,
        1 => any::<i64>(),
        1 => (0..64u32, -1..2i64).prop_map(|(bits, near)| (1i64 << bits).wrapping_add(near)),
    ];
    number.prop_map(Tree::Number).prop_recursive(5, 40, 2, |inner| {
        let marks: Vec<&'static str> = LEVELS.iter().flat_map(|marks| marks.iter().copied()).collect();
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            6 => (proptest::sample::select(marks), pair.clone())
                .prop_map(|(mark, (a, b))| Tree::Infix(mark, Box::new(a), Box::new(b))),
            2 => (proptest::sample::select(vec!['-', '~', '!', '+']), inner.clone())
                .prop_map(|(mark, a)| Tree::Prefix(mark, Box::new(a))),
            1 => (proptest::sample::select(vec!["min", "max"]), pair)
                .prop_map(|(name, (a, b))| Tree::Call(name, vec![a, b])),
            1 => (proptest::sample::select(vec!["abs", "bits"]), inner)
                .prop_map(|(name, a)| Tree::Call(name, vec![a])),
        ]
    })
}

#[test]
fn expressions_agree_with_the_model() {
    check(8_000, &trees(), |tree| {
        let text = format!(".equ value, {}", tree.text(0));
        let found = assembled(&text).ok().map(|program| i128::from(program.symbols["value"]));
        prop_assert_eq!(found, tree.value(), "{}", text);
        Ok(())
    });
}

#[test]
fn fixed_point_literals_are_rounded_once() {
    let digits = (any::<bool>(), 0..100_000i128, 0..1_000_000_000_000i128, 1..=12usize, 0..32u32);
    check(5_000, &digits, |(is_negative, integer, fraction, places, bits)| {
        let one = 10i128.pow(places as u32);
        let fraction = fraction % one;
        let sign = if is_negative { "-" } else { "" };
        let text = format!(".format f, {bits}\n.equ value, {sign}{integer}.{fraction:0places$}:f");
        let exact = (integer * one + fraction) * if is_negative { -1 } else { 1 } * (1 << bits);
        // Nearest, ties up: the floor of the exact number and a half.
        let expected = (2 * exact + one).div_euclid(2 * one);
        prop_assert_eq!(i128::from(assembled(&text).unwrap().symbols["value"]), expected, "{}", text);
        Ok(())
    });
}

#[test]
fn labels_and_branches_meet() {
    // Label k stands before instruction `places[k]`; instruction i jumps to label `targets[i]`.
    let shape = (proptest::collection::vec(0..30usize, 1..10), proptest::collection::vec(any::<usize>(), 30));
    check(300, &shape, |(places, targets)| {
        let mut text = String::new();
        for (place, target) in targets.iter().enumerate() {
            for (label, _) in places.iter().enumerate().filter(|&(_, &at)| at == place) {
                text.push_str(&format!("label{label}: "));
            }
            text.push_str(&format!("j label{}\n", target % places.len()));
        }
        let program = assembled(&text).map_err(|report| TestCaseError::fail(format!("{report}")))?;
        let isa = Isa::base();
        for (pc, (word, target)) in program.words.iter().zip(&targets).enumerate() {
            let distance = isa.decode(*word).unwrap().fields.i;
            prop_assert_eq!(pc as i64 + i64::from(distance), places[target % places.len()] as i64);
        }
        Ok(())
    });
}

/// Pieces that sources are made of, so that random text gets past the lexer.
fn pieces() -> impl Strategy<Value = String> {
    let fixed: Vec<String> = asm::directive::DIRECTIVES
        .iter()
        .map(|directive| directive.name.to_string())
        .chain(asm::pseudo::PSEUDOS.iter().map(|pseudo| pseudo.name.to_string()))
        .chain(Isa::base().ops().map(|op| Isa::base().definition(op).name.to_string()))
        .chain(
            [
                // Ends of lines and blanks come more often than all else, so that lines are short.
                "\n",
                "\n",
                "\n",
                "\n",
                " ",
                " ",
                ",",
                ",",
                "(",
                ")",
                ":",
                "=",
                "+",
                "-",
                "*",
                "/",
                "<<",
                "&&",
                "||",
                ".",
                "...",
                // What only macros and quotation marks give a meaning, and halves of it
                "\\a",
                "\\@",
                "\\()",
                "\\",
                "\"text\"",
                "\"",
                "'a'",
                "'",
                "a",
                "b",
                "a.b",
                "1b",
                "1f",
                "1:",
                "a:",
                "s1",
                "s32",
                "v2",
                "w3",
                "0",
                "1",
                "64",
                "-1",
                "1 << 62",
                "0x",
                "0.5:f",
                "0.5",
                "sizeof(",
                "defined(a)",
                "min(",
                "high(",
                // Characters beyond the language, and comments
                "é",
                "\u{0}",
                "; c",
                "#",
                "//",
                "f, 8",
                "\r",
                "\t",
                "$",
                "9999999999",
            ]
            .map(String::from),
        )
        .collect();
    proptest::collection::vec(proptest::sample::select(fixed), 0..60).prop_map(|parts| parts.join(" "))
}

#[test]
fn no_text_brings_the_assembler_down() {
    let text = prop_oneof![4 => pieces(), 1 => any::<String>(), 1 => "[ -~\n]{0,200}"];
    check(8_000, &text, |text| {
        if let Err(report) = assembled(&text) {
            prop_assert!(report.has_errors());
            prop_assert!(report.render(false).contains("error"));
        }
        Ok(())
    });
}
