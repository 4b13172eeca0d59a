//! A row that costs several operations costs what a body of elementary rows costs, and does the same: `oracles/` has
//! that body for each.
//!
//! In a body the operands have the names of the row's letters; `i` is a number. Scratch registers are s8 and up, v8 and
//! up, w0, w1, w2, w5 to w7. A line `; range: a 30 bits` or `; range: i 31..63` limits the operands to those that the
//! elementary rows can say, a line `; arithmetic: default` the machines. `; range: b planes 20 bits` says that wide operands are
//! planes, as the rows of the ray unit take them; `; buffer: packet of 10 bits` and `; buffer: block of 10 bits` fill the first octets of the
//! buffer, which the body leaves free. Bodies may include files of the folder.

use std::collections::BTreeSet;
use std::path::PathBuf;

use emu::code::Code;
use emu::machine::Config;
use emu::machine::config::ArithmeticConfig;
use emu::machine::one_core::{self, OneCore, OneCoreRun};
use emu::octets::Memory;
use emu::registers::Registers;
use isa::number::{Modes, Overflow, Quantization};
use isa::{Class, Counts, InstructionDef, Isa, Kind, Operand, Program};
use messages::Source;

use super::random::Random;

/// Operands that a body and its row are run on, for each shift.
const ROUNDS: usize = 60;

/// Octets of the buffer that are filled for rows that look there.
const FILLED: usize = 512;

/// Shifts of the rows that have one.
const SHIFTS: [i64; 16] = [0, 1, 2, 7, 15, 16, 29, 30, 31, 32, 33, 45, 60, 61, 62, 63];

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/oracles")
}

/// The part of a cost that Annex II of the report counts.
fn elementary(counts: &Counts) -> Counts {
    let mut part = Counts::ZERO;
    for &class in Class::ALL.iter().filter(|class| class.is_elementary()) {
        part[class] = counts[class];
    }
    part
}

fn is_composite(row: &InstructionDef) -> bool {
    row.outcomes.iter().any(|exit| exit.cost.elementary() > 1 || exit.each.elementary() > 1)
}

/// Home of an operand: by its letter, behind the further vectors of the operands before it.
fn register(row: &InstructionDef, operand: &Operand) -> Option<(char, u8)> {
    let place = |letter: u8| match letter {
        b'a' => 1,
        b'b' => 2,
        b'c' => 3,
        b'd' | b'x' => 4,
        _ => 5,
    };
    let file = operand.kind.register_file()?;
    let is_before = |other: &&Operand| file == 'v' && place(other.letter) < place(operand.letter);
    let vectors = row.operands.iter().filter(|other| other.kind.register_file() == Some('v')).filter(is_before);
    Some((file, place(operand.letter) + vectors.map(|other| other.kind.registers() - 1).sum::<u8>()))
}

/// A row and the body that it is compared with.
struct Oracle<'a> {
    row: &'a InstructionDef,
    text: String,
}

impl Oracle<'_> {
    /// Text behind a key, on lines of their own.
    fn settings<'t>(&'t self, key: &'t str) -> impl Iterator<Item = &'t str> {
        self.text.lines().filter_map(move |line| line.strip_prefix("; ")?.strip_prefix(key)?.strip_prefix(": "))
    }

    fn range(&self, letter: u8) -> Option<&str> {
        self.settings("range").find_map(|range| range.strip_prefix(letter as char)?.strip_prefix(' '))
    }

    fn shifts(&self) -> Vec<i64> {
        if self.row.operand(b'i').is_none() {
            return vec![0];
        }
        let (least, most) = match self.range(b'i').map(|range| range.split_once("..").unwrap()) {
            Some((least, most)) => (least.parse().unwrap(), most.parse().unwrap()),
            None => (0, 63),
        };
        SHIFTS.into_iter().filter(|shift| (least..=most).contains(shift)).collect()
    }

    fn arithmetics(&self) -> Vec<Modes> {
        let all = [
            Modes::default(),
            Modes { word: 16, quantization: Quantization::Trn, overflow: Overflow::Wrap(0) },
            Modes { word: 24, quantization: Quantization::RndConv, overflow: Overflow::SatSym },
            Modes { word: 12, quantization: Quantization::TrnZero, overflow: Overflow::SatZero },
        ];
        all[..if self.settings("arithmetic").any(|which| which == "default") { 1 } else { all.len() }].to_vec()
    }

    /// The program of a body, or of the row itself, with the operands' names.
    fn program(&self, isa: &Isa, body: &str, shift: i64) -> Program {
        let mut text = String::new();
        for operand in self.row.operands.iter() {
            if let Some((file, number)) = register(self.row, operand) {
                text += &format!(".reg {}, {file}{number}\n", operand.letter as char);
            }
        }
        text += &format!("{body}\nhalt\n");
        let include = |name: &str, _: &str| {
            let text = std::fs::read_to_string(folder().join(name)).map_err(|error| error.to_string())?;
            Ok(Source::new(name, text))
        };
        let options = asm::Options { include: &include, defines: vec![("i".into(), shift)], ..asm::Options::default() };
        match asm::assemble(&Source::new(format!("{}.s", self.row.name), text), isa, &options) {
            Ok(assembled) => assembled.program,
            Err(report) => panic!("{}", report.render(false)),
        }
    }

    /// The row in an instruction of its own.
    fn statement(&self) -> String {
        let letters: Vec<String> = self.row.operands.iter().map(|o| (o.letter as char).to_string()).collect();
        format!("{} {}", self.row.name, letters.join(", "))
    }

    /// Registers with operands of the word, in the range that the body takes.
    fn operands(&self, word: u32, random: &mut Random) -> Registers {
        let mut registers = Registers::default();
        for operand in self.row.operands.iter() {
            let Some((_, number)) = register(self.row, operand) else { continue };
            let range = self.range(operand.letter).map(|range| range.trim_end_matches(" bits"));
            let is_plane = range.is_some_and(|range| range.starts_with("planes"));
            let limit = range.map(|range| range.trim_start_matches("planes ").parse().unwrap());
            let mut next = |bits: u32| {
                let number = random.signed(limit.unwrap_or(bits - 1));
                // The axis is in two bits above the coordinate, anything in those above.
                if is_plane { i64::from(number as u32) | (random.next() >> 20 << 32) as i64 } else { number }
            };
            match operand.kind {
                Kind::S | Kind::A => registers.set_scalar(number, next(word) as i32),
                _ if operand.kind.register_file() == Some('v') => (0..operand.kind.registers())
                    .for_each(|at| registers.set_vector(number + at, [0; 3].map(|_: i32| next(word) as i32))),
                _ => (0..operand.kind.registers()).for_each(|at| registers.set_wide(number + at, next(2 * word))),
            }
        }
        registers
    }

    /// Fills the buffer as the body's row takes it, and lets the operands point there.
    fn fill(&self, registers: &mut Registers, random: &mut Random) -> Vec<u8> {
        let Some(setting) = self.settings("buffer").next() else { return Vec::new() };
        let (what, bits) = setting.split_once(" of ").expect("it says of how many bits");
        let bits = bits.trim_end_matches(" bits").parse().unwrap();
        let mut put = |letter: u8, value: i64| {
            let operand = self.row.operand(letter).expect("the row has it");
            registers.set_scalar(register(self.row, operand).unwrap().1, value as i32);
        };
        let mut words: Vec<i32> = (0..FILLED / 4).map(|_| random.signed(bits) as i32).collect();
        match what {
            "packet" => {
                put(b'b', 4 * random.within(0, 3));
                put(b'c', random.within(0, 8));
            }
            "block" => {
                // The nodes lead forwards and back, within the block and out of it, to leaves as well; notes stand behind.
                const FIRST: i64 = 0x400;
                let nodes = random.within(1, 20);
                (words[0], words[1]) = (FIRST as i32, 8 * nodes as i32);
                for node in 0..nodes as usize {
                    let child = FIRST + 8 * random.within(node as i64 - 1, node as i64 + 4);
                    words[3 + 2 * node] = (child | random.within(0, 3)) as i32;
                }
                let notes = 8 + 8 * nodes;
                put(b'c', 0);
                put(b'x', FIRST + 8 * random.within(0, nodes));
                put(b'y', notes);
            }
            _ => panic!("`{what}` is nothing that fills a buffer"),
        }
        words.into_iter().flat_map(i32::to_le_bytes).collect()
    }

    /// The results that a run left.
    fn results(&self, run: &OneCoreRun) -> Vec<i64> {
        let registers = &run.state.registers;
        let written = self.row.operands.iter().filter(|operand| operand.is_written());
        let octets = self.settings("buffer").flat_map(|_| &run.state.buffer.octets()[..FILLED]);
        written
            .flat_map(|operand| {
                let (file, number) = register(self.row, operand).unwrap();
                (0..operand.kind.registers()).flat_map(move |at| match file {
                    's' => vec![registers.scalar(number + at).into()],
                    'v' => registers.vector(number + at).map(i64::from).to_vec(),
                    _ => vec![registers.wide(number + at)],
                })
            })
            .chain(octets.map(|&octet| octet.into()))
            .collect()
    }
}

fn run(isa: &Isa, modes: Modes, program: &Program, registers: &Registers) -> (OneCoreRun, Counts) {
    let Modes { word, quantization, overflow } = modes;
    let arithmetic = ArithmeticConfig { word, quantization, overflow, trap_division_by_zero: false };
    let config = Config { arithmetic, ..Config::default() };
    let registers = registers.clone();
    let one_core = OneCore { registers, step_limit: 10_000, ..OneCore::new(&config, isa, program) };
    let run = one_core::run(&one_core, Memory::default()).unwrap();
    if let Some(trap) = &run.trap {
        panic!("{trap}");
    }
    let counts = elementary(&run.tally.counts(&Code::new(program, isa, config.timing())));
    (run, counts)
}

/// The program with the first octets of its buffer.
fn with_buffer(program: &Program, filled: &[u8]) -> Program {
    let mut program = program.clone();
    program.buffer.resize(program.buffer.len().max(filled.len()), 0);
    program.buffer[..filled.len()].copy_from_slice(filled);
    program
}

#[test]
fn every_composite_row_has_a_body_and_every_body_a_row() {
    let names = |path: PathBuf| path.file_name()?.to_str()?.strip_suffix(".s").map(String::from);
    let bodies: BTreeSet<String> =
        std::fs::read_dir(folder()).unwrap().filter_map(|entry| names(entry.unwrap().path())).collect();
    let rows: BTreeSet<String> =
        isa::INSTRUCTIONS.iter().filter(|row| is_composite(row)).map(|row| row.name.to_string()).collect();
    assert_eq!(bodies, rows);
}

#[test]
fn every_composite_row_costs_and_does_what_its_body_does() {
    let isa = Isa::base();
    let mut random = Random::new(4);
    for row in isa::INSTRUCTIONS.iter().filter(|row| is_composite(row)) {
        let text = std::fs::read_to_string(folder().join(format!("{}.s", row.name))).unwrap();
        let oracle = Oracle { row, text };
        for shift in oracle.shifts() {
            let body = oracle.program(&isa, &oracle.text, shift);
            let statement = oracle.program(&isa, &oracle.statement(), shift);
            for &word in &body.words {
                let part = isa.definition(isa.decode(word).unwrap().op);
                assert!(!is_composite(part), "the body of `{}` uses `{}`", row.name, part.name);
            }
            for modes in oracle.arithmetics() {
                for _ in 0..ROUNDS {
                    let mut registers = oracle.operands(modes.word, &mut random);
                    let filled = oracle.fill(&mut registers, &mut random);
                    let [statement, body] = [&statement, &body].map(|program| with_buffer(program, &filled));
                    let (found, cost) = run(&isa, modes, &statement, &registers);
                    let (expected, body_cost) = run(&isa, modes, &body, &registers);
                    let (name, modes) = (&row.name, format!("shift {shift}, {modes:?}"));
                    assert_eq!(cost, body_cost, "cost of `{name}`, {modes}, {registers:?}");
                    let (found, expected) = (oracle.results(&found), oracle.results(&expected));
                    assert_eq!(found, expected, "`{name}`, {modes}, {registers:?}");
                }
            }
        }
    }
}
