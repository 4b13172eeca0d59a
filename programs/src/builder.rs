//! Programs without an assembler: instructions one after the other, branches to places that may come later.

use std::sync::Arc;

use isa::program::{Line, Region};
use isa::{Isa, Op, Program};
use messages::Source;

/// A place in a program that branches lead to.
#[derive(Clone, Copy)]
pub struct Label(usize);

/// A program that grows.
pub struct Builder {
    isa: Isa,
    program: Program,
    open: Vec<u16>,
    labels: Vec<Option<usize>>,
    branches: Vec<(usize, Op, Vec<i64>, Label)>,
}

impl Builder {
    pub fn new() -> Builder {
        let program = Program::default();
        Builder { isa: Isa::base(), program, open: Vec::new(), labels: Vec::new(), branches: Vec::new() }
    }

    pub fn emit(&mut self, op: Op, operands: &[i64]) -> &mut Builder {
        let word = self.isa.encode(op, operands).unwrap_or_else(|error| panic!("{op:?} {operands:?}: {error}"));
        self.word(word)
    }

    pub fn word(&mut self, word: u32) -> &mut Builder {
        self.program.words.push(word);
        self.program.region_of.push(self.open.last().copied());
        self
    }

    /// A 32-bit constant, in two words.
    pub fn constant(&mut self, register: i64, value: i32) -> &mut Builder {
        self.emit(Op::movi, &[register, i64::from(value as i16)]);
        self.emit(Op::movhi, &[register, i64::from(value as u32 >> 16)])
    }

    pub fn label(&mut self) -> Label {
        self.labels.push(None);
        Label(self.labels.len() - 1)
    }

    pub fn place(&mut self, label: Label) -> &mut Builder {
        self.labels[label.0] = Some(self.program.words.len());
        self
    }

    pub fn here(&mut self) -> Label {
        let label = self.label();
        self.place(label);
        label
    }

    /// An instruction whose last operand is the distance to a label.
    pub fn branch(&mut self, op: Op, operands: &[i64], to: Label) -> &mut Builder {
        self.branches.push((self.program.words.len(), op, operands.to_vec(), to));
        self.word(0)
    }

    /// A counted loop around a body; `register` counts down from `count` to 0.
    pub fn repeat(&mut self, register: i64, count: i32, body: impl FnOnce(&mut Builder)) -> &mut Builder {
        self.constant(register, count);
        let top = self.here();
        body(self);
        self.emit(Op::isubi, &[register, register, 1]);
        self.branch(Op::bne, &[register, 0], top)
    }

    pub fn function(&mut self, name: &str, body: impl FnOnce(&mut Builder)) -> &mut Builder {
        self.region_of_kind(name, true, body)
    }

    pub fn region(&mut self, name: &str, body: impl FnOnce(&mut Builder)) -> &mut Builder {
        self.region_of_kind(name, false, body)
    }

    fn region_of_kind(&mut self, name: &str, is_function: bool, body: impl FnOnce(&mut Builder)) -> &mut Builder {
        let parent = self.open.last().copied();
        let number = self.program.regions.len() as u16;
        self.program.regions.push(Region { name: name.to_owned(), is_function, parent });
        self.open.push(number);
        body(self);
        self.open.pop();
        self
    }

    /// The program, with a source that has a line for each word.
    pub fn build(&mut self) -> Program {
        for (at, op, operands, to) in std::mem::take(&mut self.branches) {
            let target = self.labels[to.0].expect("every label is placed");
            let mut operands = operands;
            operands.push(target as i64 - at as i64);
            self.program.words[at] = self.isa.encode(op, &operands).expect("tests branch near");
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

/// The program that a function builds.
pub fn program(body: impl FnOnce(&mut Builder)) -> Program {
    let mut builder = Builder::new();
    body(&mut builder);
    builder.build()
}

const _: fn() = || {
    fn is_shared<T: Send + Sync>() {}
    is_shared::<Arc<Program>>();
};
