//! Everything about a program that its shadows need and that does not change: the sites of its errors, the formats that it declares, and the
//! instructions that its functions compute in many steps.

use isa::naming::{RegisterId, registers};
use isa::number::Modes;
use isa::table::Op;
use isa::{Fields, Kind, Program};

use super::ledger::ShadowSites;
use crate::code::Code;

/// Registers of a file, hidden ones of extensions' bodies among them.
pub(super) const FILE: usize = 64;

/// Scalars, then the components of vectors, then wide accumulators.
pub(super) const CELLS: usize = FILE + 3 * FILE + FILE;

/// Place of a scalar among the cells.
pub(super) fn scalar_cell(number: u8) -> usize {
    usize::from(number) % FILE
}

/// Place of a vector's component.
pub(super) fn vector_cell(number: u8, component: usize) -> usize {
    FILE + 3 * (usize::from(number) % FILE) + component
}

/// Place of a wide accumulator.
pub(super) fn wide_cell(number: u8) -> usize {
    4 * FILE + usize::from(number) % FILE
}

/// Cells of a register: one, or three of a vector.
pub(super) fn cells((file, number): RegisterId) -> std::ops::Range<usize> {
    let (first, count) = match file {
        's' => (scalar_cell(number), 1),
        'v' => (vector_cell(number, 0), 3),
        _ => (wide_cell(number), 1),
    };
    first..first + count
}

/// Declared fraction bits of the cells of one place in the program; `None` where nothing is declared.
type CellFormats = Vec<Option<i8>>;

/// A cell that an instruction reads, with the fraction bits that are declared for it there.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeclaredRead {
    pub cell: u16,
    pub scale: i8,
}

/// An instruction that a function computes in many steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct ComputedFormula {
    pub op: Op,
    pub fields: Fields,
    /// The site of its errors.
    pub site: u32,
}

/// Event of a word beside its own execution, for functions that compute an instruction in many steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WordMark {
    Nothing,
    /// The operands of that formula are read before the word.
    Reads(u16),
    /// The word returns from the function that computes that formula.
    Returns(u16),
}

/// A program as its shadows see it.
#[derive(Clone, Debug)]
pub struct ShadowProgram {
    /// The sites of its errors.
    pub sites: ShadowSites,
    /// Number of the first site among those of all programs of a run.
    pub first_site: u32,
    pub(super) modes: Modes,
    formats: Vec<CellFormats>,
    /// Number of the formats behind each word.
    behind: Vec<u16>,
    /// Cells with a declared format that the words read, word by word.
    reads: Vec<DeclaredRead>,
    /// The first of them of each word, and the end.
    first_read: Vec<u32>,
    pub(super) computed: Vec<ComputedFormula>,
    marks: Vec<WordMark>,
}

impl ShadowProgram {
    /// A decoded program on a machine of such words. Its sites are numbered from `first_site` on.
    pub fn new(code: &Code, modes: Modes, first_site: u32) -> ShadowProgram {
        let (program, words) = (code.program, code.words());
        // What an instruction with a body reads and writes is read and written by the steps of that.
        let has_body = |word: u32| code.slots()[word as usize].op != code.op(word);
        // Formats change only where what is said of some register begins or ends.
        let mut changes = vec![false; words as usize + 1];
        for held in &program.holds {
            for word in [held.words.start, held.words.end] {
                changes[(word as usize).min(words as usize)] = true;
            }
        }
        let mut formats = vec![vec![None; CELLS]];
        let mut before: Vec<u16> = Vec::with_capacity(words as usize);
        for word in 0..words {
            if changes[word as usize] {
                formats.push(declared_at(program, word));
            }
            before.push((formats.len() - 1) as u16);
        }
        let behind = (0..words).map(|word| {
            // What stands behind the last word of a function says nothing about it.
            let (next, here) = (word + 1, program.function(word));
            let is_inside = next < words && program.function(next) == here;
            if has_body(word) { 0 } else { before[if is_inside { next } else { word } as usize] }
        });
        let behind = behind.collect();
        let (mut reads, mut first_read) = (Vec::new(), vec![0]);
        for word in 0..words {
            if !has_body(word) {
                reads.extend(declared_reads(code, word, &formats[usize::from(before[word as usize])]));
            }
            first_read.push(reads.len() as u32);
        }
        let sites = ShadowSites::new(program);
        let (computed, marks) = computed_formulas(code, &sites);
        ShadowProgram { sites, first_site, modes, formats, behind, reads, first_read, computed, marks }
    }

    /// Declared fraction bits of what a cell holds behind a word.
    pub(super) fn declared_behind(&self, word: u32, cell: usize) -> Option<i32> {
        let formats = &self.formats[usize::from(*self.behind.get(word as usize)?)];
        formats[cell].map(i32::from)
    }

    /// Cells with a declared format that a word reads.
    pub(super) fn declared_reads(&self, word: u32) -> std::ops::Range<usize> {
        match self.first_read.get(word as usize..word as usize + 2) {
            Some(&[start, end]) => start as usize..end as usize,
            _ => 0..0,
        }
    }

    /// One of those cells.
    pub(super) fn declared_read(&self, number: usize) -> DeclaredRead {
        self.reads[number]
    }

    /// Event of a word; none of the steps of bodies, which lie behind the words.
    pub(super) fn mark(&self, pc: u32) -> WordMark {
        self.marks.get(pc as usize).copied().unwrap_or(WordMark::Nothing)
    }
}

/// Declared fraction bits of all cells before a word.
fn declared_at(program: &Program, word: u32) -> CellFormats {
    let mut formats = vec![None; CELLS];
    for register in registers() {
        // Shifts speak of the bits of the arithmetic, whatever units people are shown.
        let bits = program.format_of(register, word).and_then(|(name, _)| program.formats.get(name));
        formats[cells(register)].fill(bits.map(|bits| *bits as i8));
    }
    formats
}

/// Cells that a word reads as numbers of a declared format.
///
/// Registers that an instruction reads and writes are left out: a vector that is put together component by component is declared behind the last
/// one, so in between the declaration that stands is that of the vector before.
fn declared_reads(code: &Code, word: u32, formats: &CellFormats) -> Vec<DeclaredRead> {
    let (Some(row), slot) = (code.row(word), &code.slots()[word as usize]) else { return Vec::new() };
    let mut reads = Vec::new();
    for operand in row.operands.iter().filter(|operand| b"abc".contains(&operand.letter) && operand.kind != Kind::A) {
        let (Some(file), first) = (operand.kind.register_file(), slot.fields.get(operand.letter) as u8) else {
            continue;
        };
        let mut read: Vec<usize> =
            (0..operand.kind.registers()).flat_map(|at| cells((file, first.wrapping_add(at)))).collect();
        // Of a vector of which one component is read, the others may be those of the vector before.
        if slot.op == Some(Op::vget) {
            read = read.get(slot.fields.i as usize).copied().into_iter().collect();
        }
        // `s0` is the number 0 of any format.
        let declared = read.into_iter().filter(|cell| *cell != 0);
        reads.extend(declared.filter_map(|cell| Some(DeclaredRead { cell: cell as u16, scale: formats[cell]? })));
    }
    reads
}

/// Formulas that functions compute, and the words at which they begin and end.
fn computed_formulas(code: &Code, sites: &ShadowSites) -> (Vec<ComputedFormula>, Vec<WordMark>) {
    let program = code.program;
    if program.computed.is_empty() {
        return (Vec::new(), Vec::new());
    }
    let (mut formulas, mut marks) = (Vec::new(), vec![WordMark::Nothing; code.words() as usize]);
    for (instruction, site) in program.computed.iter().zip(sites.computed.iter()) {
        // An instruction of an extension has no formula.
        let Some(decoded) = code.isa.decode(instruction.word).filter(|decoded| !matches!(decoded.op, Op::Ext(_)))
        else {
            continue;
        };
        let number = formulas.len() as u16;
        formulas.push(ComputedFormula { op: decoded.op, fields: decoded.fields, site: *site });
        for word in instruction.words.clone().filter(|&word| code.op(word) == Some(Op::ret)) {
            marks[word as usize] = WordMark::Returns(number);
        }
        marks[instruction.words.start as usize] = WordMark::Reads(number);
    }
    (formulas, marks)
}
