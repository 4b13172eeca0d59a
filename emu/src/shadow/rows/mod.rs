//! Exact formulas of the instructions: one trait a room, stamped from the table, so that an instruction without a formula does not compile.
//! A formula takes numbers with their shadows and says what real numbers are written. Registers, rounding and statistics are not its business.

mod control;
mod decisions;
mod integer;
mod local;
mod packet;
mod ray;
mod scalar;
mod vector;
mod walk;
mod wide;

use std::cmp::Ordering;

use isa::number::Modes;

use super::memory::ShadowMemory;
use super::number::{ShadowNumber, ShadowTerm};
use crate::code::octets::Buffer;

/// A register's number that a formula reads.
#[derive(Clone, Copy, Debug)]
pub struct ShadowInput<'a> {
    /// The machine's number.
    pub raw: i64,
    /// Shadow of the number; `None` of an integer, which counts as exact where it meets numbers.
    pub shadow: Option<&'a ShadowNumber>,
}

/// Real number that an instruction writes.
#[derive(Clone, Debug)]
pub enum RealResult {
    /// None: an integer, an address or a pattern of bits.
    Integer,
    /// The number that was read, moved.
    Moved(ShadowNumber),
    /// A number by a formula.
    Computed(ShadowTerm),
    /// A number by a formula whose shift brings it into a format: where both are known they have to agree.
    Fitted(ShadowTerm),
}

/// Effect of an instruction on memory and messages, once it has happened.
#[derive(Clone, Debug, Default)]
pub enum ShadowEffect {
    /// None.
    #[default]
    Nothing,
    /// Numbers of so many octets each go to the buffer.
    Buffer(u32, u32, Vec<Option<ShadowNumber>>),
    /// Numbers of 32 bits go to global memory.
    Global(u32, Vec<Option<ShadowNumber>>),
    /// Octets of the buffer from an address on become integers.
    Forget(u32, u32),
    /// Octets are copied from global memory to the buffer: to, from, how many.
    Load(u32, u32, u32),
    /// Octets are copied from the buffer to global memory: to, from, how many.
    Store(u32, u32, u32),
    /// A word of global memory becomes an integer.
    Add(u32),
    /// A message leaves for a processor.
    Send(i64, Vec<[Option<ShadowNumber>; 3]>),
    /// A message arrives in vectors from this number on.
    Receive(u8),
    /// The notes of a walk overwrite the buffer behind an address; the register of the last one says up to where.
    Notes(u32, u8),
}

/// Surroundings in which a formula is evaluated.
pub struct RealFormulas<'a> {
    /// The local buffer, before the instruction.
    pub buffer: &'a Buffer,
    /// Shadows of the buffer.
    pub local: &'a ShadowMemory,
    /// Shadows of global memory.
    pub global: &'a ShadowMemory,
    /// Word length and modes of the machine.
    pub modes: Modes,
    /// Decisions on numbers of which one at least has a shadow.
    pub decisions: u32,
    /// Decisions that the shadow would have taken otherwise.
    pub turned: u32,
    /// Sites of the lines whose errors have turned comparisons.
    pub blamed: Vec<u32>,
    /// Effect of the instruction.
    pub effect: ShadowEffect,
    /// The register to which a walk writes the place of its last note.
    pub note_register: u8,
    /// The first register that a message goes to.
    pub message_register: u8,
}

impl<'a> ShadowInput<'a> {
    /// The integer 0.
    const ZERO: ShadowInput<'a> = ShadowInput { raw: 0, shadow: None };

    /// The number in a formula.
    pub fn term(&self) -> ShadowTerm {
        ShadowTerm::new(self.raw, self.shadow)
    }

    /// The shadow differs from the machine's number.
    pub fn deviates(&self) -> bool {
        self.shadow.is_some_and(|shadow| shadow.deviation.is_some())
    }

    /// The number as it is, moved elsewhere.
    pub fn moved(&self) -> RealResult {
        self.shadow.map_or(RealResult::Integer, |shadow| RealResult::Moved(shadow.clone()))
    }
}

impl RealFormulas<'_> {
    /// Notes a decision on numbers, of which `agrees` says whether the shadow takes it too. Of integers it is none.
    fn decide_on<'i>(
        &mut self,
        mut of: impl Iterator<Item = &'i ShadowInput<'i>> + Clone,
        agrees: impl FnOnce() -> bool,
    ) {
        if of.clone().all(|number| number.shadow.is_none()) {
            return;
        }
        self.decisions += 1;
        self.turned += u32::from(of.any(ShadowInput::deviates) && !agrees());
    }

    /// Notes a comparison. Where the shadow takes the other side, the line whose part of the difference is the largest has the blame.
    fn compare(&mut self, a: &ShadowInput, b: &ShadowInput, claim: impl Fn(Ordering) -> bool) {
        let mut blamed = None;
        self.decide_on([a, b].into_iter(), || {
            let (left, right) = (a.term(), b.term());
            let real = left.real().partial_cmp(right.real()).expect("reals are ordered");
            let agrees = claim(a.raw.cmp(&b.raw)) == claim(real);
            if !agrees {
                let parts = left.parts(1.0).plus(&right.parts(-1.0));
                let largest = parts.iter().max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()));
                blamed = largest.map(|(site, _)| site);
            }
            agrees
        });
        self.blamed.extend(blamed);
    }
}

/// The type of an operand that a formula reads.
macro_rules! input {
    (S) => {
        ShadowInput
    };
    (W) => {
        ShadowInput
    };
    (A) => {
        u32
    };
    (V) => {
        [ShadowInput; 3]
    };
    (V2) => {
        [[ShadowInput; 3]; 2]
    };
    (V3) => {
        [[ShadowInput; 3]; 3]
    };
    (V5) => {
        [[ShadowInput; 3]; 5]
    };
    (W3) => {
        [ShadowInput; 3]
    };
    ($immediate:ident) => {
        i32
    };
}

/// The type of what a formula writes.
macro_rules! output {
    (S) => {
        RealResult
    };
    (W) => {
        RealResult
    };
    (V) => {
        [RealResult; 3]
    };
    (V2) => {
        [[RealResult; 3]; 2]
    };
    (V3) => {
        [[RealResult; 3]; 3]
    };
    (V5) => {
        [[RealResult; 3]; 5]
    };
    (W3) => {
        [RealResult; 3]
    };
}

/// One formula of a room's trait.
macro_rules! formula {
    ({ $name:ident [$(#[doc = $doc:expr])*] } [$(($letter:ident $kind:ident))*] [$(($written:ident $to:ident))*]) => {
        $(#[doc = $doc])*
        fn $name(&mut self, $($letter: input!($kind)),*) -> ($(output!($to),)*);
    };
}

macro_rules! formulas {
    ($($style:ident $room:ident $trait:ident $room_doc:literal {
        $($(#[doc = $doc:expr])* $name:ident ($($operands:tt)*) $drawn:literal [$($exits:tt)*];)*
    })*) => {
        $(
            #[doc = $room_doc]
            pub trait $trait {
                $(crate::semantics::split_operands! { formula { $name [$(#[doc = $doc])*] } [] [] ($($operands)*) })*
            }
        )*
    };
}

isa::instructions!(formulas);

/// Results of a vector.
fn each(of: impl FnMut(usize) -> RealResult) -> [RealResult; 3] {
    std::array::from_fn(of)
}

/// The exact sum of three products.
fn dot(a: &[ShadowTerm; 3], b: &[ShadowTerm; 3]) -> ShadowTerm {
    a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]))
}

/// A component of the exact cross product.
fn cross_component(a: &[ShadowTerm; 3], b: &[ShadowTerm; 3], k: usize) -> ShadowTerm {
    let (next, last) = ((k + 1) % 3, (k + 2) % 3);
    a[next].times(&b[last]).minus(&a[last].times(&b[next]))
}

/// The exact cross product.
fn cross(a: &[ShadowTerm; 3], b: &[ShadowTerm; 3]) -> [ShadowTerm; 3] {
    std::array::from_fn(|k| cross_component(a, b, k))
}

/// The difference of two vectors.
fn difference(a: &[ShadowTerm; 3], b: &[ShadowTerm; 3]) -> [ShadowTerm; 3] {
    std::array::from_fn(|k| a[k].minus(&b[k]))
}

/// The components of a vector in a formula.
fn terms(a: &[ShadowInput; 3]) -> [ShadowTerm; 3] {
    std::array::from_fn(|k| a[k].term())
}

/// The quotient, times 2^shift; a division by 0 begins anew at the machine's number.
fn quotient(a: &ShadowTerm, b: &ShadowTerm, shift: i32) -> RealResult {
    a.over(b).map_or(RealResult::Integer, |quotient| RealResult::Fitted(quotient.scaled(shift)))
}
