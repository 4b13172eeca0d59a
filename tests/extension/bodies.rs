//! Each instruction of a file, on random registers, against its body written out.

use std::collections::BTreeMap;
use std::fmt::Write;

use emu::code::Code;
use emu::engine::EngineKind;
use emu::machine::{RunOptions, Setup};
use emu::registers::Registers;
use isa::{Class, Isa, Kind};
use proptest::prelude::*;

use super::{isa_of, program, run_with};

const BODIES: &str = include_str!("bodies.isa");

/// Registers that programs of the test use for operands: the others are scratch of the bodies that are written out.
const OPERANDS: [(char, u8); 3] = [('s', 6), ('v', 7), ('w', 3)];

/// The lines of an instruction's body.
fn body(name: &str) -> Vec<&'static str> {
    let start = BODIES.find(&format!(".instr {name} ")).expect("the file has it");
    let lines = BODIES[start..].lines().skip(1);
    lines.take_while(|line| !line.starts_with(".end")).collect()
}

/// A line with names replaced; `c+1` is the name `c` and what is one further.
fn replaced(line: &str, names: &BTreeMap<String, (char, u8)>, numbers: &BTreeMap<String, i64>) -> String {
    let mut text = String::new();
    let mut rest = line.split(';').next().unwrap_or("");
    while let Some(first) = rest.chars().next() {
        if !first.is_ascii_alphanumeric() && first != '\\' {
            text.push(first);
            rest = &rest[first.len_utf8()..];
            continue;
        }
        let length = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '\\').unwrap_or(rest.len());
        let (word, after) = rest.split_at(length);
        rest = after;
        match (names.get(word), numbers.get(word)) {
            (Some(&(file, number)), _) => {
                let offset = rest.strip_prefix('+').and_then(|rest| rest.get(..1)?.parse::<u8>().ok());
                rest = &rest[if offset.is_some() { 2 } else { 0 }..];
                let _ = write!(text, "{file}{}", number + offset.unwrap_or(0));
            }
            (None, Some(number)) => {
                let _ = write!(text, "{number}");
            }
            (None, None) => text.push_str(word),
        }
    }
    text
}

/// The program that does what the instruction does with these fields: sources are copied first, results last.
fn written_out(isa: &Isa, name: &str, fields: &[i64]) -> String {
    let row = isa.definition(isa.find(name).unwrap());
    let (mut names, mut numbers) = (BTreeMap::new(), BTreeMap::new());
    // Operands of the test's programs lie below these.
    let mut free = BTreeMap::from([('s', 8u8), ('v', 8), ('w', 3)]);
    let (mut before, mut after) = (String::new(), String::new());
    let copies = |from: (char, u8), to: (char, u8), count: u8| -> String {
        let name = BTreeMap::from([('s', "mov"), ('v', "vmov"), ('w', "wmov")])[&from.0];
        (0..count).map(|at| format!("    {name} {}{}, {}{}\n", to.0, to.1 + at, from.0, from.1 + at)).collect()
    };
    let mut distance = None;
    // Give each operand registers of its own: for `fma s2, s2, s0, s1, 3` the body works on s8 to s11, after `mov s9, s2` and the like and
    // before `mov s2, s8`, so it may write s8 and read s9 later
    for (operand, &value) in row.operands.iter().zip(fields) {
        let letter = (operand.letter as char).to_string();
        match operand.kind.register_file() {
            Some(file) => {
                let next = free.get_mut(&file).unwrap();
                let (inner, outer) = ((file, *next), (file, value as u8));
                *next += operand.kind.registers();
                if operand.is_read() {
                    before += &copies(outer, inner, operand.kind.registers());
                }
                if operand.is_written() {
                    after += &copies(inner, outer, operand.kind.registers());
                }
                names.insert(letter, inner);
            }
            None if operand.kind == Kind::Rel => distance = Some(()),
            None => {
                numbers.insert(letter, value);
            }
        }
    }
    // Temporaries come behind them
    for at in 0..4 {
        names.insert(format!("t{at}"), ('s', free[&'s'] + at));
        names.insert(format!("tv{at}"), ('v', free[&'v'] + at));
        names.insert(format!("tw{at}"), ('w', free[&'w'] + at));
    }
    let mut text =
        String::from(".macro square of, into, shift\n    mul \\into, \\of, \\of, \\shift\n.endm\n.equ TWO, 2\n");
    text += &before;
    // An exit with a distance jumps to `away`, any other one to where the results are copied back
    for line in body(name) {
        let line = replaced(line, &names, &numbers);
        match line.trim_start().split_once(' ') {
            Some(("exit", way)) if way.contains(',') => text += "    jump away\n",
            Some(("exit", _)) => text += "    jump behind\n",
            _ => text += &format!("{line}\n"),
        }
    }
    text + "behind:\n" + &after + "    halt\n" + if distance.is_some() { "away: li s7, 1\n    halt\n" } else { "" }
}

/// The program with the instruction itself.
fn written_as(isa: &Isa, name: &str, fields: &[i64]) -> String {
    let row = isa.definition(isa.find(name).unwrap());
    let mut has_distance = false;
    let operands = row.operands.iter().zip(fields).map(|(operand, value)| match operand.kind.register_file() {
        Some(file) => format!("{file}{value}"),
        None if operand.kind == Kind::Rel => {
            has_distance = true;
            "away".to_owned()
        }
        None => value.to_string(),
    });
    let operands: Vec<String> = operands.collect();
    let away = if has_distance { "away: li s7, 1\n    halt\n" } else { "" };
    format!("    {name} {}\n    halt\n{away}", operands.join(", "))
}

fn fields(isa: &Isa, name: &str) -> BoxedStrategy<Vec<i64>> {
    let row = isa.definition(isa.find(name).unwrap()).clone();
    let fields: Vec<BoxedStrategy<i64>> = (row.operands.iter())
        .map(|operand| match operand.kind.register_file() {
            Some(file) => {
                let count = OPERANDS.iter().find(|(of, _)| *of == file).unwrap().1;
                (0..=i64::from(count - operand.kind.registers())).boxed()
            }
            None => {
                let (least, most) = operand.kind.range(row.pattern.field(operand.letter).unwrap().width);
                (least.max(0)..=most.min(40)).boxed()
            }
        })
        .collect();
    fields.boxed()
}

fn registers() -> impl Strategy<Value = Registers> {
    let number = || prop_oneof![-3..4i32, any::<i32>(), Just(i32::MIN), Just(i32::MAX)];
    let vectors = proptest::collection::vec([number(), number(), number()], 8);
    (proptest::collection::vec(number(), 7), vectors, proptest::collection::vec(any::<i64>(), 3)).prop_map(
        |(scalars, vectors, wides)| {
            let mut registers = Registers::default();
            (0..).zip(scalars).for_each(|(number, value)| registers.set_scalar(number, value));
            (0..).zip(vectors).for_each(|(number, value)| registers.set_vector(number, value));
            (0..).zip(wides).for_each(|(number, value)| registers.set_wide(number, value));
            registers
        },
    )
}

#[test]
fn an_instruction_does_and_counts_what_its_body_does() {
    let (isa, loaded) = isa_of(BODIES);
    assert_eq!(loaded.len(), 9);
    for loaded in &loaded {
        let name = isa.definition(loaded.op).name.to_string();
        let mut runner = testing::runner(150);
        let strategy = (fields(&isa, &name), registers(), 0..20u64);
        let result = runner.run(&strategy, |(fields, registers, few)| {
            let (short, long) = (written_as(&isa, &name, &fields), written_out(&isa, &name, &fields));
            let (short_program, long_program) = (program(&short, &isa), program(&long, &isa));
            let spliced = run_with(&short_program, &isa, registers.clone(), 1000);
            // It stops within the body just the same on all engines.
            run_with(&short_program, &isa, registers.clone(), few);
            let expected = run_with(&long_program, &isa, registers, 1000);
            prop_assert!(spliced.trap.is_none() && expected.trap.is_none(), "{:?} {:?}", spliced.trap, expected.trap);
            for number in 0..8 {
                let (a, b) = (&spliced.state.registers, &expected.state.registers);
                prop_assert_eq!(a.scalar(number), b.scalar(number), "s{} {} {}", number, &short, &long);
                prop_assert_eq!(a.vector(number), b.vector(number), "v{} {} {}", number, &short, &long);
                if number < 3 {
                    prop_assert_eq!(a.wide(number), b.wide(number), "w{} {} {}", number, &short, &long);
                }
            }
            let counts = |run: &emu::machine::one_core::OneCoreRun, program| {
                let code = Code::new(program, &isa, Default::default());
                run.tally.counts(&code)
            };
            let (spliced_counts, expected_counts) =
                (counts(&spliced, &short_program), counts(&expected, &long_program));
            for class in [Class::Add, Class::Sub, Class::Mul, Class::Div, Class::Cmp, Class::Logic] {
                prop_assert_eq!(spliced_counts[class], expected_counts[class], "{} {}", class.name(), &short);
            }
            let is_away = spliced.state.pc > 1;
            prop_assert_eq!(spliced.tally.instructions(), 2 + u64::from(is_away));
            prop_assert_eq!(spliced.state.steps, spliced.tally.instructions());
            Ok(())
        });
        if let Err(error) = result {
            panic!("{name}: {error}");
        }
    }
}

#[test]
fn declared_exits_count_in_the_place_of_the_body() {
    let text = BODIES.replace("[Low(body), High(body), Inside(body)]", "[Low(cmp 7), High(cmp 11), Inside(cmp 13)]");
    let (isa, _) = isa_of(&text);
    let program = program("clamp s4, s1, s2, s3\n clamp s5, s2, s1, s3\n clamp s6, s3, s2, s1\n halt", &isa);
    let mut registers = Registers::default();
    [(1, 42), (2, 7), (3, 100)].into_iter().for_each(|(number, value)| registers.set_scalar(number, value));
    let run = run_with(&program, &isa, registers, 100);
    let code = Code::new(&program, &isa, Default::default());
    assert_eq!([4, 5, 6].map(|number| run.state.registers.scalar(number)), [42, 42, 42]);
    assert_eq!(run.tally.counts(&code)[Class::Cmp], 13 + 7 + 11);
    assert_eq!(run.tally.counts(&code)[Class::Move], 0);
    assert_eq!((run.tally.instructions(), run.clocks.0), (4, 31));
    let exits: Vec<u64> = (0..3).map(|exit| run.tally.passes(&code, 0, exit).count).collect();
    assert_eq!(exits, [0, 0, 1]);
}

#[test]
fn every_word_of_an_extension_survives_text() {
    let (isa, loaded) = isa_of(BODIES);
    for loaded in &loaded {
        let name = isa.definition(loaded.op).name.to_string();
        let mut runner = testing::runner(64);
        let result = runner.run(&fields(&isa, &name), |fields| {
            let word = isa.encode(loaded.op, &fields).unwrap();
            let text = asm::disassemble(&[word], &isa);
            prop_assert_eq!(program(&text, &isa).words, vec![word], "{}", text);
            Ok(())
        });
        if let Err(error) = result {
            panic!("{name}: {error}");
        }
    }
}

#[test]
fn instructions_of_extensions_run_quickly() {
    let (isa, _) = isa_of(
        ".extension short\n.instr turn (d: S, a: S) \"custom0 ddddd aaaaa ----------------\" [Done(body)]\n    neg d, a\n.end\n",
    );
    let (core, main) = (program("turn s1, s2\n turn s3, s1\n halt", &isa), program("halt", &isa));
    let config = emu::machine::Config::default();
    let setup = Setup {
        config: &config,
        isa: &isa,
        core: &core,
        main: &main,
        kinds: Vec::new(),
        options: RunOptions::default(),
    };
    assert_eq!(setup.engine().kind, EngineKind::default(), "one step stands for each word");
}

#[test]
fn written_out_bodies_of_nothing_but_an_exit_come_to_the_step_limit() {
    let text = ".extension idle\n.instr idle (i: Un) \"custom0 iiiii ---------------------\" [Done(body)]\n    exit Done\n.end\n";
    let (isa, loaded) = isa_of(text);
    let isa = isa.expanded(&[loaded[0].op]);
    let program = program("again: idle 1\n idle 2\n jump again", &isa);
    for limit in [0, 1, 2, 100, 40_000] {
        let run = run_with(&program, &isa, Registers::default(), limit);
        assert_eq!(run.state.steps + run.state.inner_steps, limit);
    }
}
