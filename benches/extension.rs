//! Cost of an extension instruction on the host, as a body, as a meaning in Rust, and written out as instructions of the table:
//! `cargo bench --bench extension`. All three do the same in a loop, in native code and on the interpreter.

use std::hint::black_box;

use asm::extension;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use emu::engine::Wish;
use emu::extension::{Call, Ending, Meaning, Numbers, Operands, attach};
use emu::machine::Config;
use emu::machine::one_core::{OneCore, run_with};
use emu::octets::Memory;
use emu::registers::Registers;
use emu::semantics::{ScalarRoom, VectorRoom, WideRoom};
use emu::trap::Fault;
use isa::Isa;
use isa::number::{Arithmetic, Nearest32, Vector};
use messages::Source;

/// Times that the loop executes each of its eight instructions.
const PASSES: u32 = 10_000;

const ROWS: &str = "\
.extension measured
;; Product and sum.
.instr fma (d: S, a: S, b: S, c: S, i: Sh)  \"custom0 ddddd aaaaa bbbbb ccccc iiiiii\"  [Done(mul 1, add 1)]
    mul   t0, a, b, i
    add   d, t0, c
.end
;; Vector times scalar plus vector.
.instr vfma (d: V, a: V, b: S, c: V, i: Sh)  \"custom1 ddddd aaaaa bbbbb ccccc iiiiii\"  [Done(mul 3, add 3)]
    vscale tv0, a, b, i
    vadd  d, tv0, c
.end
;; Unit vector.
.instr vunit (d: V, a: V, i: Sh)  \"custom2 ddddd aaaaa iiiiii ----------\"  [Done(mul 3)]
    wdot  tw0, a, a
    wsqrt t0, tw0, 0
    vdiv  d, a, t0, i
.end
";

#[derive(Clone, Debug)]
struct Fma;

impl Meaning for Fma {
    #[inline]
    fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault> {
        let (numbers, operands) = (call.arithmetic, call.operands);
        let (product, _) = numbers.mul(operands.scalar('a'), operands.scalar('b'), operands.immediate('i'));
        let (sum, _) = numbers.add(product, operands.scalar('c'));
        call.set_scalar('d', sum);
        Ok(Ending::DONE)
    }
}

#[derive(Clone, Debug)]
struct Vfma;

impl Meaning for Vfma {
    #[inline]
    fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault> {
        // Which arithmetic it is is asked once instead of for each component.
        let sum = match call.arithmetic {
            Numbers::Nearest32 => vfma(&Nearest32, &call.operands),
            other => vfma(other, &call.operands),
        };
        call.set_vector('d', sum);
        Ok(Ending::DONE)
    }
}

#[inline]
fn vfma(numbers: &impl Arithmetic, operands: &Operands) -> Vector {
    let (product, _) = numbers.vscale(operands.vector('a'), operands.scalar('b'), operands.immediate('i'));
    numbers.vadd(product, operands.vector('c')).0
}

#[derive(Clone, Debug)]
struct Vunit;

impl Meaning for Vunit {
    #[inline]
    fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault> {
        let (numbers, a) = (call.arithmetic, call.operands.vector('a'));
        let (square, _) = numbers.wdot(a, a);
        let (length, _) = numbers.wsqrt(square, 0);
        let (unit, _) = numbers.vdiv(a, length, call.operands.immediate('i'));
        call.set_vector('d', unit);
        Ok(Ending::DONE)
    }
}

/// Name, the instruction, and the same written out.
const MEASURED: [(&str, &str, &str); 3] = [
    ("fma", "fma s4, s1, s2, s3, 16", "mul s5, s1, s2, 16\n add s4, s5, s3"),
    ("vfma", "vfma v4, v1, s2, v3, 16", "vscale v5, v1, s2, 16\n vadd v4, v5, v3"),
    ("vunit", "vunit v4, v1, 16", "wdot w0, v1, v1\n wsqrt s5, w0, 0\n vdiv v4, v1, s5, 16"),
];

fn measure(criterion: &mut Criterion) {
    // Load the rows twice: with their bodies alone, and with meanings in Rust beside them
    let mut bodies = Isa::base();
    let source = Source::new("measured.isa", ROWS);
    extension::load(&mut bodies, &source, &|_, _| Err("nothing is included".into())).expect("the file is right");
    let mut meanings = bodies.clone();
    attach(&mut meanings, "fma", Fma).expect("it is declared");
    attach(&mut meanings, "vfma", Vfma).expect("it is declared");
    attach(&mut meanings, "vunit", Vunit).expect("it is declared");
    let mut registers = Registers::default();
    [(1, 70_000), (2, -90_000), (3, 123)].into_iter().for_each(|(number, value)| registers.set_scalar(number, value));
    registers.set_vector(1, [300_000_000, -200_000_000, 100_000_000]);
    registers.set_vector(3, [5, 6, 7]);
    let config = Config::default();
    let engines = [Wish::default(), Wish::CHECKED];
    for ((name, instruction, written_out), wish) in MEASURED.iter().flat_map(|each| engines.map(|e| (each, e))) {
        let name = format!("{name} {}", wish.kind.name());
        let mut group = criterion.benchmark_group(&name);
        group.throughput(Throughput::Elements(u64::from(PASSES) * 8));
        // The same work in three ways: rows of the table, an extension's body, a meaning in Rust
        let ways = [
            ("written out", *written_out, &bodies),
            ("body", *instruction, &bodies),
            ("rust", *instruction, &meanings),
        ];
        let mut results = Vec::new();
        for (way, line, isa) in ways {
            // Eight copies in a pass, so that the loop itself takes little of the time.
            let lines = format!(" {line}\n").repeat(8);
            let text = format!("    li s9, {PASSES}\n1:\n{lines}    isubi s9, s9, 1\n    bnez s9, 1b\n    halt\n");
            let program = asm::assemble(&Source::new("loop.s", text), isa, &asm::Options::default());
            let program = program.unwrap_or_else(|report| panic!("{report}")).program;
            let once = || {
                let registers = registers.clone();
                let one_core = OneCore { registers, step_limit: u64::MAX, ..OneCore::new(&config, isa, &program) };
                let run = run_with(&one_core, Memory::new(Vec::new()), wish);
                run.expect("the machine is the default one").state.registers
            };
            let after = once();
            results.push((after.scalar(4), after.vector(4)));
            group.bench_function(way, |bencher| bencher.iter(|| black_box(once())));
        }
        // Times say something only of ways that come to the same results.
        assert!(results.iter().all(|result| *result == results[0]), "{name}: {results:?}");
        group.finish();
    }
}

criterion_group!(benches, measure);
criterion_main!(benches);
