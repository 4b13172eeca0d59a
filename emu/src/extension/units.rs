//! The units of a core that execute instructions with a meaning in Rust: a clone of each meaning, and where its results wait.

use std::fmt;

use dyn_clone::DynClone;
use isa::number::Vector;
use isa::{Fields, InstructionDef, Isa, Kind};

use super::call::{Call, Operands, WRITTEN, place};
use super::{Ending, MOST_OCTETS, Meaning, Numbers, attached};
use crate::code::octets::Buffer;
use crate::code::registers::Registers;
use crate::code::trap::{Fault, Stop};

/// Results by the letters that are written.
#[derive(Clone, Debug, Default)]
pub(super) struct Results {
    pub scalars: [i32; WRITTEN.len()],
    pub vectors: [[Vector; 5]; WRITTEN.len()],
    pub wides: [[i64; 3]; WRITTEN.len()],
    /// A bit for each that was set.
    pub written: u8,
}

/// Shape of an instruction's operands, by the places of their letters.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub kinds: [Option<Kind>; 9],
    name: String,
}

impl Shape {
    #[cold]
    #[inline(never)]
    pub fn wrong(&self, letter: char, what: &str) -> ! {
        panic!("the meaning of `{}` takes operand `{letter}` for {what}, which its row does not say", self.name)
    }
}

/// Reader of words of global memory from an address on.
pub(crate) type WordReader<'a> = &'a mut dyn FnMut(u32, &mut [i32]) -> Result<(), Stop>;

/// Unit that executes an instruction, whatever the type of its meaning.
pub(crate) trait Unit: DynClone + fmt::Debug + Send + Sync {
    /// Executes the instruction; where that goes wrong, no register has changed.
    fn execute(
        &mut self,
        fields: &Fields,
        registers: &mut Registers,
        buffer: &mut Buffer,
        read: WordReader,
        arithmetic: &Numbers,
    ) -> Result<Ending, Stop>;

    /// Meaning that the unit executes.
    fn meaning(&self) -> &dyn Meaning;
}

dyn_clone::clone_trait_object!(Unit);

/// The unit for one type of meaning: the compiler makes one piece of its parts.
#[derive(Clone, Debug)]
pub(super) struct TypedUnit<M> {
    meaning: M,
    shape: Shape,
    exits: u8,
    /// Place, letter and kind of what it writes, in the order of the row.
    destinations: Vec<(usize, u8, Kind)>,
    results: Results,
    words: Vec<i32>,
}

impl<M> TypedUnit<M> {
    /// The unit for an instruction of a row.
    pub fn new(row: &InstructionDef, meaning: M) -> TypedUnit<M> {
        let mut kinds = [None; 9];
        for operand in row.operands.iter() {
            kinds[place(operand.letter as char)] = Some(operand.kind);
        }
        let written = row.operands.iter().filter(|operand| operand.is_written());
        TypedUnit {
            meaning,
            shape: Shape { kinds, name: row.name.to_string() },
            exits: row.outcomes.len() as u8,
            destinations: written.map(|o| (place(o.letter as char), o.letter, o.kind)).collect(),
            results: Results::default(),
            words: Vec::new(),
        }
    }

    /// Moves the results to their registers.
    #[inline]
    fn write(&self, fields: &Fields, registers: &mut Registers) {
        let results = &self.results;
        // Most have one, which is seldom left out.
        match self.destinations[..] {
            [(place, b'd', Kind::S)] if results.written != 0 => {
                return registers.set_scalar(fields.d, results.scalars[place & 3]);
            }
            [(place, b'd', Kind::V)] if results.written != 0 => {
                return registers.set_vector(fields.d, results.vectors[place & 3][0]);
            }
            _ => {}
        }
        for &(place, letter, kind) in &self.destinations {
            // Results have a bit each, in the order of `WRITTEN`: 0b0101 is `d` and `x`.
            let is_set = results.written >> place & 1 == 1;
            // What is read too stays as it was.
            if !is_set && matches!(letter, b'x' | b'y') {
                continue;
            }
            let (place, number) = (place & 3, fields.get(letter) as u8);
            match kind {
                Kind::S | Kind::A => registers.set_scalar(number, if is_set { results.scalars[place] } else { 0 }),
                Kind::V => registers.set_vector(number, if is_set { results.vectors[place][0] } else { [0; 3] }),
                Kind::W => registers.set_wide(number, if is_set { results.wides[place][0] } else { 0 }),
                _ => {
                    let count = kind.registers();
                    for offset in 0..count {
                        let (at, to) = (usize::from(offset), number + offset);
                        match kind.register_file() {
                            Some('v') if is_set => registers.set_vector(to, results.vectors[place][at]),
                            Some('v') => registers.set_vector(to, [0; 3]),
                            _ if is_set => registers.set_wide(to, results.wides[place][at]),
                            _ => registers.set_wide(to, 0),
                        }
                    }
                }
            }
        }
    }
}

impl<M: Meaning + Clone> Unit for TypedUnit<M> {
    fn execute(
        &mut self,
        fields: &Fields,
        registers: &mut Registers,
        buffer: &mut Buffer,
        read: WordReader,
        arithmetic: &Numbers,
    ) -> Result<Ending, Stop> {
        let operands = Operands { registers, fields, shape: &self.shape };
        if let Some(range) = self.meaning.reads(&operands).filter(|range| !range.is_empty()) {
            let octets = range.end - range.start;
            // Before the words are allocated: the range comes from a register, which may hold anything.
            if octets > MOST_OCTETS {
                return Err(Fault::Refused("it would read more of global memory than an instruction may").into());
            }
            self.words.clear();
            self.words.resize(octets.div_ceil(4) as usize, 0);
            read(range.start, &mut self.words)?;
        } else {
            self.words.clear();
        }
        self.results.written = 0;
        let mut call = Call { operands, buffer, words: &self.words, arithmetic, results: &mut self.results };
        let ending = self.meaning.execute(&mut call)?;
        // Before anything is written, so that a fault leaves registers as they were.
        if ending.exit >= self.exits {
            return Err(Fault::Refused("it ended by an exit that its row does not have").into());
        }
        self.write(fields, registers);
        Ok(ending)
    }

    fn meaning(&self) -> &dyn Meaning {
        &self.meaning
    }
}

/// The units of a core, by the numbers of the extension instructions.
#[derive(Clone, Debug, Default)]
pub struct Units(Vec<Option<Box<dyn Unit>>>);

/// The states of two cores are compared by what programs can see.
impl PartialEq for Units {
    fn eq(&self, _: &Units) -> bool {
        true
    }
}

impl Eq for Units {}

impl Units {
    /// The units of a core after reset.
    pub fn new(isa: &Isa) -> Units {
        if isa.extensions().all(|op| isa.semantics(op).is_none()) {
            return Units::default();
        }
        Units(isa.extensions().map(|op| attached(isa, op).map(|attached| attached.0.clone())).collect())
    }

    /// Their state at the start of a work item.
    pub fn begin(&mut self, isa: &Isa) {
        for (op, unit) in isa.extensions().zip(&mut self.0) {
            // A clone of the first one forgets whatever the last work item left in it.
            if let (Some(unit), Some(first)) = (unit, attached(isa, op))
                && !first.0.meaning().keeps_state()
            {
                *unit = first.0.clone();
            }
        }
    }

    /// The unit for extension instruction number `number`, if its meaning is in Rust.
    #[inline]
    pub fn get_mut(&mut self, number: u16) -> Option<&mut dyn Unit> {
        match self.0.get_mut(usize::from(number)) {
            Some(Some(unit)) => Some(&mut **unit),
            _ => None,
        }
    }
}
