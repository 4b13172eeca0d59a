//! Instructions whose meaning is in Rust.

use std::ops::Range;

use emu::code::Code;
use emu::conformance::{self, Trial};
use emu::extension::{Call, Ending, Meaning, Operands, attach};
use emu::machine::{self, Config, Setup};
use emu::octets::Memory;
use emu::registers::Registers;
use emu::trap::Fault;
use isa::number::Arithmetic;
use isa::{Class, Isa};

use super::{isa_of, program, run_with};

const ROWS: &str = "\
.extension units
;; The next random number of `i` bits.
.instr noise (d: S, i: Un)  \"custom0 ddddd iiiii ---------------0\"  [Done(logic 1)]
    .meaning rust
.end
;; Sums `b` words of global memory from `a` on; goes on at `i` where the sum is negative.
.instr total (d: S, x: S, a: A, i: Rel)  \"custom1 ddddd xxxxx aaaaa iiiiiiiiiii\"  [Fall(mem 1; each octet 1, add 2), Taken(cmp 1)]
    .meaning rust
.end
;; Product and sum of vectors, which change places.
.instr swap (d: V2, y: W3, e: S, a: V, b: V)  \"custom2 ddddd yyy eeeee aaaaa bbbbb ---\"  [Done(mul 3)]
    .meaning rust
.end
;; a b + c, rounded twice.
.instr fma (d: S, a: S, b: S, c: S, i: Sh)  \"custom3 ddddd aaaaa bbbbb ccccc iiiiii\"  [Done(mul 1, add 1)]
    .meaning rust
    mul t0, a, b, i
    add d, t0, c
.end
;; Puts into `e` what `d` was, and takes two units.
.instr spin (d: S, e: S)  \"custom0 ddddd eeeee ---------------1\"  [Done(add 3; each mul 1)]
    .meaning rust
.end
";

/// Random bits: a shift register with feedback.
#[derive(Clone, Debug)]
struct Noise {
    state: u32,
    keeps: bool,
}

impl Meaning for Noise {
    fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault> {
        let bits = call.operands.immediate('i');
        if bits == 0 {
            return Err(Fault::Refused("no bits are asked for"));
        }
        self.state = self.state >> 1 ^ if self.state & 1 == 1 { 0xa300_0000 } else { 0 };
        call.set_scalar('d', (self.state >> (32 - bits)) as i32);
        Ok(Ending::DONE)
    }

    fn keeps_state(&self) -> bool {
        self.keeps
    }
}

/// The sum of words of global memory.
#[derive(Clone, Debug)]
struct Total;

impl Meaning for Total {
    fn reads(&self, operands: &Operands) -> Option<Range<u32>> {
        let start = operands.address('a');
        Some(start..start.saturating_add(4 * operands.scalar('x') as u32))
    }

    fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault> {
        let sum: i32 = call.words.iter().sum();
        call.set_scalar('d', sum);
        call.set_scalar('x', 0);
        Ok(match sum {
            ..0 => Ending::exit(1).taken(),
            _ => Ending::exit(0).with_units(4 * call.words.len() as u32),
        })
    }
}

/// Swaps its two vectors; `e` is not written.
#[derive(Clone, Debug)]
struct Swap;

impl Meaning for Swap {
    fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault> {
        // A destination may be a source: it is written when all is done.
        let before = call.operands.vector('a');
        call.set_vectors('d', [call.operands.vector('b'), [1; 3]]);
        call.set_vectors('d', [call.operands.vector('b'), before]);
        let [low, middle, high] = call.operands.wides('y');
        call.set_wides('y', [high, middle, low]);
        call.buffer.put(0, [7])?;
        Ok(Ending::DONE)
    }
}

/// Product and sum; where `is_floor`, the product is rounded down.
#[derive(Clone, Debug)]
struct Fma {
    is_floor: bool,
}

impl Meaning for Fma {
    fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault> {
        let [a, b, c] = ['a', 'b', 'c'].map(|letter| i128::from(call.operands.scalar(letter)));
        let shift = call.operands.immediate('i') as u32;
        let product = match self.is_floor {
            true => call.arithmetic.narrow((a * b) >> shift, 0),
            false => call.arithmetic.narrow(a * b, shift),
        };
        call.set_scalar('d', call.arithmetic.narrow(i128::from(product) + c, 0));
        Ok(Ending::DONE)
    }
}

/// Contents of its destination before.
#[derive(Clone, Debug)]
struct Spin;

impl Meaning for Spin {
    fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault> {
        call.set_scalar('e', call.operands.scalar('d'));
        call.set_scalar('d', 5);
        Ok(Ending::DONE.with_units(2))
    }
}

/// Goes on where a distance would lead, though it has none.
#[derive(Clone, Debug)]
struct Leaves;

impl Meaning for Leaves {
    fn execute(&mut self, _: &mut Call) -> Result<Ending, Fault> {
        Ok(Ending::DONE.taken())
    }
}

fn units(keeps: bool) -> Isa {
    let (mut isa, loaded) = isa_of(ROWS);
    assert!(loaded.iter().all(|loaded| loaded.is_rust));
    attach(&mut isa, "noise", Noise { state: 1, keeps }).unwrap();
    attach(&mut isa, "total", Total).unwrap();
    attach(&mut isa, "swap", Swap).unwrap();
    attach(&mut isa, "fma", Fma { is_floor: false }).unwrap();
    attach(&mut isa, "spin", Spin).unwrap();
    isa
}

#[test]
fn a_meaning_sees_its_destination_as_it_was_and_one_exit_has_cost_and_units() {
    let isa = units(false);
    let program = program("li s1, 7\n iadd s0, s1, s1\n spin s0, s2\n spin s1, s3\n spin s1, s4\n halt", &isa);
    let run = run_with(&program, &isa, Registers::default(), 100);
    assert_eq!([0, 1, 2, 3, 4].map(|number| run.state.registers.scalar(number)), [0, 5, 0, 7, 5]);
    let counts = run.tally.counts(&Code::new(&program, &isa, Default::default()));
    assert_eq!((counts[Class::Add], counts[Class::Mul], run.clocks.0), (3 * 3 + 1, 3 * 2, 16));
}

#[test]
fn what_goes_on_behind_the_program_is_outside_at_any_step_limit() {
    // The body of two steps gives the program slots behind its words.
    let (mut isa, _) = isa_of(ROWS);
    attach(&mut isa, "noise", Leaves).unwrap();
    let program = program("fma s1, s1, s1, s1, 0\n noise s1, 3", &isa);
    for limit in [2, 3, 4] {
        let run = run_with(&program, &isa, Registers::default(), limit);
        let fault = if limit == 2 { Fault::StepLimit(2) } else { Fault::OutsideProgram { words: 2 } };
        assert_eq!(run.trap.map(|trap| trap.kind), Some(fault), "{limit}");
    }
}

#[test]
fn state_goes_on_from_instruction_to_instruction() {
    let isa = units(false);
    let program = program("noise s1, 8\n noise s2, 8\n noise s3, 31\n halt", &isa);
    for _ in 0..2 {
        let run = run_with(&program, &isa, Registers::default(), 100);
        let registers = &run.state.registers;
        // 1 becomes a3000000, then 51800000, then 28c00000.
        assert_eq!([1, 2, 3].map(|number| registers.scalar(number)), [0xa3, 0x51, 0x28c0_0000 >> 1]);
        let code = Code::new(&program, &isa, Default::default());
        assert_eq!((run.tally.instructions(), run.tally.counts(&code)[Class::Logic]), (4, 3));
    }
}

#[test]
fn results_wait_for_the_end_and_what_is_not_written_is_zero() {
    let isa = units(false);
    let program = program("swap v4, w2, s5, v4, v5\n halt", &isa);
    let mut registers = Registers::default();
    registers.set_vector(4, [1, 2, 3]);
    registers.set_vector(5, [4, 5, 6]);
    registers.set_scalar(5, 99);
    (2..5).for_each(|number| registers.set_wide(number, number.into()));
    let run = run_with(&program, &isa, registers, 100);
    let after = &run.state.registers;
    assert_eq!((after.vector(4), after.vector(5), after.scalar(5)), ([4, 5, 6], [1, 2, 3], 0));
    assert_eq!([2, 3, 4].map(|number| after.wide(number)), [4, 3, 2]);
    assert_eq!(run.state.buffer.octets()[0], 7);
}

#[test]
fn it_reads_global_memory_over_the_bus_and_counts_its_units() {
    let isa = units(false);
    // The memory is 0, 1, 2, ...: three words from 4 on, then one from 252 on, whose sum is negative.
    let text = "li s1, 3\n li s2, 4\n total s3, s1, s2, away\n li s1, 1\n li s2, 252\n total s4, s1, s2, away\n trap 1\n away: halt";
    let program = program(text, &isa);
    let run = run_with(&program, &isa, Registers::default(), 100);
    assert!(run.trap.is_none(), "{:?}", run.trap);
    let sum = 0x0706_0504 + 0x0b0a_0908 + 0x0f0e_0d0c;
    assert_eq!((run.state.registers.scalar(3), run.state.registers.scalar(1)), (sum, 0));
    assert_eq!(run.state.registers.scalar(4), 0xfffe_fdfcu32 as i32);
    let code = Code::new(&program, &isa, Default::default());
    let counts = run.tally.counts(&code);
    // 12 octets, each with two additions.
    assert_eq!([Class::Mem, Class::Octet, Class::Add, Class::Cmp].map(|class| counts[class]), [1, 12, 24, 1]);
    let config = Config::default();
    let length = |octets| config.transfer_clocks(emu::quantity::Octets(octets)).0;
    assert_eq!(run.waiting.0, length(12) + length(4));
    assert_eq!(run.clocks.0 - run.waiting.0, 24 + 1);
}

#[test]
fn what_goes_wrong_is_a_trap_at_the_instruction() {
    let isa = units(false);
    let trap = |text: &str| run_with(&program(text, &isa), &isa, Registers::default(), 100).trap.expect(text);
    let refused = trap(" nop\n noise s1, 0\n halt");
    assert_eq!((&refused.kind, refused.pc), (&Fault::Refused("no bits are asked for"), 1));
    assert!(refused.to_string().contains("the instruction refused: no bits are asked for"), "{refused}");
    let outside = trap(" li s1, 1\n li s2, -8\n total s3, s1, s2, .+1\n halt");
    assert!(matches!(outside.kind, Fault::Memory { .. }), "{outside}");
    let much = trap(" li s1, 100000\n total s3, s1, s2, .+1\n halt");
    assert!(much.to_string().contains("would read more of global memory"), "{much}");
    let bare = isa_of(ROWS).0;
    let none =
        run_with(&program("noise s1, 3\n halt", &bare), &bare, Registers::default(), 9).trap.expect("no meaning");
    let shown = none.diagnostic().to_string();
    assert!(shown.contains("no meaning in Rust is attached") && shown.contains("docs/extensions.md"), "{shown}");
}

#[test]
fn a_body_beside_a_meaning_is_what_runs_without_it() {
    let text = "li s1, 3\n li s2, 5\n li s3, 1\n fma s4, s1, s2, s3, 1\n halt";
    let (bare, mut attached) = (isa_of(ROWS).0, isa_of(ROWS).0);
    attach(&mut attached, "fma", Fma { is_floor: true }).unwrap();
    let run = |isa: &Isa| run_with(&program(text, isa), isa, Registers::default(), 100).state.registers.scalar(4);
    // 7.5 is rounded to 8 by the body, to 7 by the meaning.
    assert_eq!((run(&bare), run(&attached)), (9, 8));
    let op = attached.find("fma").unwrap();
    assert_eq!(run(&attached.expanded(&[op])), 9);
}

#[test]
fn a_meaning_is_held_against_the_body_beside_it() {
    let agreement =
        conformance::check(&units(false), "fma", &Trial::default()).unwrap_or_else(|found| panic!("{found}"));
    assert_eq!((agreement.ended, agreement.largest), (1000, 0));
    let mut wrong = isa_of(ROWS).0;
    attach(&mut wrong, "fma", Fma { is_floor: true }).unwrap();
    let found = conformance::check(&wrong, "fma", &Trial::default()).expect_err("it rounds down");
    let text = found.to_string();
    assert!(text.contains("`fma s") && text.contains("does not do what its body does"), "{text}");
    // The operands are there to be tried by hand.
    let value = |name: &str| -> i128 {
        let line =
            text.lines().find(|line| line.contains(&format!("before: `{name}`"))).expect("each operand is shown");
        line.split(" = ").nth(1).unwrap().parse().unwrap()
    };
    let shift: u32 = found.instruction.rsplit(", ").next().unwrap().parse().unwrap();
    let product = value("a") * value("b");
    assert!(shift != 0 && product >> (shift - 1) & 1 == 1, "the product is not rounded up\n{text}");
    let (_, body, meaning) = &found.differences[0];
    assert_eq!(body.parse::<i64>().unwrap() - meaning.parse::<i64>().unwrap(), 1, "{text}");
    // One is allowed where one says so.
    let close = Trial { tolerance: 1, ..Trial::default() };
    assert_eq!(conformance::check(&wrong, "fma", &close).map(|found| found.largest), Ok(1));
}

#[test]
fn what_cannot_be_attached_is_refused() {
    let (mut isa, _) = isa_of(ROWS);
    for (name, message) in
        [("vadd", "`vadd` is an instruction of the table"), ("nois", "there is no instruction `nois`")]
    {
        let refused = attach(&mut isa, name, Swap).expect_err(name);
        assert!(refused.message.contains(message) && refused.hint.is_some(), "{}", refused.message);
    }
    let (mut isa, _) =
        isa_of(".extension a\n.instr b (d: S) \"custom0 ddddd ---------------------\" [Done(body)]\n li d, 1\n.end");
    let refused = attach(&mut isa, "b", Swap).expect_err("nobody counts what it spends");
    assert!(refused.message.contains("costs what its body does"), "{}", refused.message);
}

/// One core that answers each message with a random number; the main processor stores what comes.
const CORE: &str = "
    recv2 v1, s1
    noise s2, 16
    noise s3, 16
    vsplat v1, s2
    vsplat v2, s3
    send2 s1, v1
    halt
";

fn main_program(items: u32) -> String {
    format!(
        "
    li    s1, 0
    li    s2, {items}
again:
    send2 s0, v4
    recv2 v8, s6
    vget  s7, v8, 0
    vget  s8, v9, 0
    stw   s7, (s1)
    stw   s8, 4(s1)
    iaddi s1, s1, 8
    isubi s2, s2, 1
    bnez  s2, again
    halt
"
    )
}

#[test]
fn each_work_item_begins_with_the_state_after_reset_unless_it_is_kept() {
    for keeps in [false, true] {
        let isa = units(keeps);
        let (core, main) = (program(CORE, &isa), program(&main_program(3), &isa));
        let config = Config { cores: 1, ..Config::default() };
        let setup = Setup {
            config: &config,
            isa: &isa,
            core: &core,
            main: &main,
            kinds: Vec::new(),
            options: Default::default(),
        };
        let memory = Memory::new(vec![0; 64]);
        let frame = emu::run(&setup, memory.clone(), &mut |_| {}).unwrap_or_else(|failure| panic!("{failure}"));
        let words: Vec<i32> = (0..6).map(|at| frame.memory.word(4 * at).unwrap()).collect();
        if keeps {
            assert_eq!(words[..4], [0xa300, 0x5180, 0x28c0, 0x1460]);
            assert_eq!(frame.method.reason(), Some("an instruction keeps its state from one work item to the next"));
        } else {
            assert_eq!(words, [0xa300, 0x5180, 0xa300, 0x5180, 0xa300, 0x5180]);
            assert_eq!(frame.method.name(), "replayed");
            let stepped = emu::step(&setup, memory, &mut |_| {}).unwrap_or_else(|failure| panic!("{failure}"));
            assert_eq!(machine::RunOutcome { method: frame.method, ..stepped }, frame);
        }
    }
}

#[test]
fn the_example_prints_what_the_docs_show() {
    let printed = super::study::report().unwrap_or_else(|_| panic!("the example runs"));
    let text = include_str!("../../docs/extensions.md");
    let (_, shown) = text.split_once("$ cargo run --release --example reciprocal\n\n").expect("the docs show it");
    let shown: String =
        shown.lines().take_while(|line| line.starts_with("    ")).map(|line| format!("{}\n", &line[4..])).collect();
    if std::env::var_os("LANCER_BLESS").is_some() {
        let indented = |text: &str| text.lines().map(|line| format!("    {line}\n")).collect::<String>();
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/extensions.md");
        std::fs::write(path, text.replace(&indented(&shown), &indented(&printed))).unwrap();
    } else {
        assert_eq!(shown, printed, "LANCER_BLESS=1 writes it");
    }
}
