//! Programs without an assembler: instructions one after the other, branches to places that may come later.

use isa::program::{Line, Region};
use isa::{Isa, Op, Program};
use messages::Source;

/// A place in a program that branches lead to.
#[derive(Clone, Copy)]
pub struct Label(usize);

/// A program that grows.
pub struct ProgramBuilder {
    isa: Isa,
    program: Program,
    open: Vec<u16>,
    labels: Vec<Option<usize>>,
    branches: Vec<(usize, Op, Vec<i64>, Label)>,
}

impl ProgramBuilder {
    /// An empty program of the rows that an instruction set has.
    pub fn new(isa: Isa) -> ProgramBuilder {
        ProgramBuilder { isa, program: Program::default(), open: Vec::new(), labels: Vec::new(), branches: Vec::new() }
    }

    /// Appends an instruction.
    ///
    /// # Panics
    /// With operands that it cannot have.
    pub fn emit(&mut self, op: Op, operands: &[i64]) -> &mut ProgramBuilder {
        let word = self.isa.encode(op, operands).unwrap_or_else(|error| panic!("{op:?} {operands:?}: {error}"));
        self.word(word)
    }

    /// Appends any word.
    pub fn word(&mut self, word: u32) -> &mut ProgramBuilder {
        self.program.words.push(word);
        self.program.region_of.push(self.open.last().copied());
        self
    }

    /// A 32-bit constant, in two words.
    pub fn constant(&mut self, register: i64, value: i32) -> &mut ProgramBuilder {
        self.emit(Op::movi, &[register, i64::from(value as i16)]);
        self.emit(Op::movhi, &[register, i64::from(value as u32 >> 16)])
    }

    /// A place that is yet to be chosen.
    pub fn label(&mut self) -> Label {
        self.labels.push(None);
        Label(self.labels.len() - 1)
    }

    /// Puts a label in front of the next instruction.
    pub fn place(&mut self, label: Label) -> &mut ProgramBuilder {
        self.labels[label.0] = Some(self.program.words.len());
        self
    }

    /// The place of the next instruction.
    pub fn here(&mut self) -> Label {
        let label = self.label();
        self.place(label);
        label
    }

    /// An instruction whose last operand is the distance to a label.
    pub fn branch(&mut self, op: Op, operands: &[i64], to: Label) -> &mut ProgramBuilder {
        self.branches.push((self.program.words.len(), op, operands.to_vec(), to));
        self.word(0)
    }

    /// A counted loop around a body; `register` counts down from `count` to 0.
    pub fn repeat(&mut self, register: i64, count: i32, body: impl FnOnce(&mut ProgramBuilder)) -> &mut ProgramBuilder {
        self.constant(register, count);
        let top = self.here();
        body(self);
        self.emit(Op::isubi, &[register, register, 1]);
        self.branch(Op::bne, &[register, 0], top)
    }

    /// A function that holds what is appended in between.
    pub fn function(&mut self, name: &str, body: impl FnOnce(&mut ProgramBuilder)) -> &mut ProgramBuilder {
        self.region_of_kind(name, true, body)
    }

    /// A region of a function that holds what is appended in between.
    pub fn region(&mut self, name: &str, body: impl FnOnce(&mut ProgramBuilder)) -> &mut ProgramBuilder {
        self.region_of_kind(name, false, body)
    }

    fn region_of_kind(
        &mut self,
        name: &str,
        is_function: bool,
        body: impl FnOnce(&mut ProgramBuilder),
    ) -> &mut ProgramBuilder {
        let parent = self.open.last().copied();
        let number = self.program.regions.len() as u16;
        self.program.regions.push(Region { name: name.to_owned(), is_function, parent });
        self.open.push(number);
        body(self);
        self.open.pop();
        self
    }

    /// The program, with a source that has a line for each word.
    ///
    /// # Panics
    /// With a branch to a label that was not placed, or too far away.
    pub fn build(&mut self) -> Program {
        for (at, op, operands, to) in std::mem::take(&mut self.branches) {
            let target = self.labels[to.0].expect("every label is placed");
            let mut operands = operands;
            operands.push(target as i64 - at as i64);
            self.program.words[at] = self.isa.encode(op, &operands).expect("branches are near");
        }
        let mut program = std::mem::take(&mut self.program);
        let text: Vec<String> = (0..program.words.len())
            .map(|pc| match self.isa.decode(program.words[pc]) {
                Some(instruction) => {
                    format!("    {}\n", instruction.text(&self.isa, |words| (pc as i64 + i64::from(words)).to_string()))
                }
                None => format!("    .word {:#x}\n", program.words[pc]),
            })
            .collect();
        program.lines = (1..=program.words.len() as u32).map(|line| Line { source: 0, line }).collect();
        program.sources = vec![Source::new("test.s", text.concat())];
        program
    }
}

/// The program that a function builds of the base rows.
pub fn program(body: impl FnOnce(&mut ProgramBuilder)) -> Program {
    let mut builder = ProgramBuilder::new(Isa::base());
    body(&mut builder);
    builder.build()
}
