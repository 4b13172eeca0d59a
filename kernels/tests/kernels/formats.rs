//! Formats that the kernels give their registers (`.holds`) go together: addresses have no format, sums are of equal formats, and products have the
//! fraction bits of their factors less the shift. No two names of one register meet.

use isa::naming::RegisterId;
use isa::{Isa, Kind, Program};
use kernels::build::{KernelOptions, build};
use kernels::{KernelSet, Skips};
use scenes::generate::{self, GenerateOptions};
use scenes::image::{self, MemoryOptions};
use scenes::layout::Layout;
use scenes::model::View;

/// All programs of a set of kernels in a layout, with everything that a scene can ask for and with as little as possible.
fn programs(set: KernelSet, layout: Layout, word: u32, skips: Skips) -> Vec<Program> {
    let size = (16, 12);
    let mut programs = Vec::new();
    for scene in ["mirrors", "slabs", "triangle"] {
        let scene = generate::scene(scene, &GenerateOptions { size, ..GenerateOptions::default() })
            .expect("a scene of the list");
        let view = View::new(size);
        let options = MemoryOptions { word, layout, ..MemoryOptions::default() };
        let image = image::build(&scene, &view, &options).expect("the scene fits the word");
        let options = KernelOptions { profile: set, skips, ..KernelOptions::default() };
        let built = build(&scene, &view, &image, &Isa::base(), &options).expect("the kernels assemble");
        assert!(built.warnings.0.is_empty(), "{set}: {}", built.warnings);
        programs.extend([built.cores, built.main]);
    }
    programs
}

fn every_program() -> Vec<(String, Program)> {
    let mut all = Vec::new();
    for &set in KernelSet::ALL {
        for layout in [Layout::Report, Layout::Wide] {
            for (word, skips) in [(32, Skips::ALL), (24, Skips::NONE)] {
                let programs = programs(set, layout, word, skips);
                all.extend(
                    programs.into_iter().map(|program| (format!("{set}, {}, {word} bits", layout.name()), program)),
                );
            }
        }
    }
    all
}

#[test]
fn formats_of_registers_go_together() {
    let isa = Isa::base();
    let mut compared = 0;
    for (name, program) in every_program() {
        for (pc, &word) in (0u32..).zip(&program.words) {
            let Some(instruction) = isa.decode(word) else { continue };
            let row = isa.definition(instruction.op);
            let bits = |register: RegisterId, pc: u32| program.format_of(register, pc);
            let place = || format!("{name}: {} at {}", row.name, program.place(pc).unwrap_or_default());
            let (mut reads, mut written, mut shift) = (Vec::new(), None, None);
            for operand in row.operands.iter() {
                let number = instruction.fields.get(operand.letter);
                let Some(file) = operand.kind.register_file() else {
                    shift = Some(number).filter(|_| operand.kind == Kind::Sh);
                    continue;
                };
                let register = (file, number as u8);
                if operand.kind == Kind::A {
                    assert_eq!(bits(register, pc), None, "{}: an address has no format", place());
                }
                if operand.is_read() {
                    reads.push(bits(register, pc).map(|(_, bits)| i64::from(bits)));
                }
                if operand.is_written() {
                    written = bits(register, pc + 1).map(|(_, bits)| i64::from(bits));
                }
            }
            // Rows of the numeric rooms, by their form: two numbers to one, with a shift a product, without one a sum.
            let is_numeric = ["scalar", "vector"].contains(&&*row.room);
            let (Some(written), [Some(a), Some(b)], true) = (written, reads.as_slice(), is_numeric) else { continue };
            let counts = row.outcomes[0].cost;
            let is_product = counts[isa::Class::Mul] > 0;
            let is_sum = shift.is_none() && row.outcomes[0].cost.elementary() > 0 && !is_product && row.name.len() <= 4;
            if let (true, Some(shift)) = (is_product, shift) {
                assert_eq!(written, a + b - shift, "{}", place());
                compared += 1;
            } else if is_sum && row.operands.iter().all(|operand| operand.kind == row.operands[0].kind) {
                assert!(a == b && *a == written, "{}: {a}, {b} and {written} bits", place());
                compared += 1;
            }
        }
    }
    assert!(compared > 1000, "only {compared} were compared");
}
