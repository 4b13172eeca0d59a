//! The table of instructions: its rooms put together, once, and what is stamped from it: the opcode enum, the rows as
//! data, an outcome type a row. A wrong row (overlapping pattern, operand without field, unknown class) does not compile.

mod control;
mod integer;
mod memory;
mod packet;
mod ray;
mod scalar;
mod vector;
mod walk;
mod wide;

use std::borrow::Cow;

use crate::class::Counts;
use crate::definition::{InstructionDef, Kind, Operand, OutcomeDef, Room};
use crate::pattern::BitPattern;

/// Calls `callback!` with all rooms: `style room Trait "doc" { rows }`, a row as it stands in its room.
///
/// The style says who may give the semantics: `pure` needs only values, `local` the core's buffer, `buffered` both, `bus` the
/// machine, `control` the next instruction.
#[macro_export]
macro_rules! instructions {
    ($callback:ident) => {
        $crate::scalar_instructions! { [] integer_instructions vector_instructions wide_instructions ray_instructions packet_instructions walk_instructions memory_instructions control_instructions instructions_end $callback }
    };
}

/// Closes the chain of rooms.
#[doc(hidden)]
#[macro_export]
macro_rules! instructions_end {
    ([$($rooms:tt)*] $callback:ident) => { $callback! { $($rooms)* } };
}

/// The only outcome of a row whose list of outcomes is `[Done(..)]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Done;

/// The only outcome of a row that costs something for each unit; it carries the number of units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Each(pub u32);

/// An outcome as an engine reads it off what the semantics return.
pub trait AnyOutcome: Copy {
    /// Outcomes of the row.
    const OUTCOMES: usize;
    /// Number of the outcome within its row.
    fn index(self) -> usize;
    /// Units of the per-unit cost; 0 where the row has none.
    fn units(self) -> u32;
}

impl AnyOutcome for Done {
    const OUTCOMES: usize = 1;
    #[inline]
    fn index(self) -> usize {
        0
    }
    #[inline]
    fn units(self) -> u32 {
        0
    }
}

impl AnyOutcome for Each {
    const OUTCOMES: usize = 1;
    #[inline]
    fn index(self) -> usize {
        0
    }
    #[inline]
    fn units(self) -> u32 {
        self.0
    }
}

/// An enum with the outcomes of an instruction, numbered in their order.
macro_rules! outcome_enum {
    ($type:ident $name:ident [$($outcome:ident)+]) => {
        #[doc = concat!("Outcomes of `", stringify!($name), "`.")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $type {
            $(#[doc = concat!("Outcome `", stringify!($outcome), "`.")] $outcome,)+
        }
        impl crate::table::AnyOutcome for $type {
            const OUTCOMES: usize = [$(stringify!($outcome)),+].len();
            #[inline]
            fn index(self) -> usize { self as usize }
            #[inline]
            fn units(self) -> u32 { 0 }
        }
    };
}

/// The module of an instruction with the type of its outcome: `Done`, `Each`, an enum, or an enum with a number of units.
macro_rules! outcome_type {
    // One outcome at a fixed cost: such rows share a type.
    ($name:ident [Done($($class:ident $n:literal),*)]) => {
        #[doc = concat!("The outcome of `", stringify!($name), "`.")]
        pub mod $name {
            pub use super::super::Done as Outcome;
        }
    };
    // One outcome at a cost by units: these share one that holds their number.
    ($name:ident [Done($($class:ident $n:literal),* ; each $($unit:ident $m:literal),+)]) => {
        #[doc = concat!("The outcome of `", stringify!($name), "`.")]
        pub mod $name {
            pub use super::super::Each as Outcome;
        }
    };
    // Several outcomes at fixed costs: an enum of the row's own
    ($name:ident [$($outcome:ident($($class:ident $n:literal),*)),+]) => {
        #[doc = concat!("Outcomes of `", stringify!($name), "`.")]
        pub mod $name {
            outcome_enum! { Outcome $name [$($outcome)+] }
        }
    };
    // Several outcomes, some by units: that enum together with their number
    ($name:ident [$($outcome:ident($($class:ident $n:literal),* $(; each $($unit:ident $m:literal),+)?)),+]) => {
        #[doc = concat!("Outcomes of `", stringify!($name), "`.")]
        pub mod $name {
            outcome_enum! { Way $name [$($outcome)+] }
            #[doc = concat!("An outcome of `", stringify!($name), "`, with its number of units.")]
            #[derive(Clone, Copy, Debug, PartialEq, Eq)]
            pub struct Outcome {
                /// The outcome without its units.
                pub way: Way,
                /// Units of its cost for each; 0 where it has none.
                pub units: u32,
            }
            impl crate::table::AnyOutcome for Outcome {
                const OUTCOMES: usize = <Way as crate::table::AnyOutcome>::OUTCOMES;
                #[inline]
                fn index(self) -> usize { self.way as usize }
                #[inline]
                fn units(self) -> u32 { self.units }
            }
        }
    };
}

macro_rules! stamp {
    ($($style:ident $room:ident $trait:ident $room_doc:literal {
        $($(#[doc = $doc:expr])* $name:ident ($($letter:ident : $kind:ident),*) $drawn:literal
            [$($outcome:ident($($class:ident $n:literal),* $(; each $($unit:ident $m:literal),+)?)),+];)*
    })*) => {
        /// Number of an instruction: a row of the table, or row `n` of the extensions.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[allow(non_camel_case_types, reason = "an opcode is spelt as its mnemonic")]
        pub enum Op {
            $($($(#[doc = $doc])* $name,)*)*
            /// Row `n` of the loaded extensions.
            Ext(u16),
        }

        #[allow(non_camel_case_types, dead_code, reason = "numbers the mnemonics in the order of the table")]
        enum RowNumber { $($($name,)*)* }

        impl Op {
            /// Opcodes of the built-in rows, in the order of the table.
            pub const BUILT_IN: &[Op] = &[$($(Op::$name,)*)*];

            /// Place in the list of all rows, extensions after the table.
            pub const fn index(self) -> usize {
                match self {
                    $($(Op::$name => RowNumber::$name as usize,)*)*
                    Op::Ext(n) => Op::BUILT_IN.len() + n as usize,
                }
            }
        }

        /// The rooms in the order of the table.
        pub const ROOMS: &[Room] = &[$(Room { name: stringify!($room), doc: $room_doc },)*];

        const TABLE: &[InstructionDef] = &[$($(InstructionDef {
            name: Cow::Borrowed(stringify!($name)),
            doc: Cow::Borrowed(concat!($($doc, "\n"),*)),
            room: Cow::Borrowed(stringify!($room)),
            operands: Cow::Borrowed(&[$(Operand { letter: stringify!($letter).as_bytes()[0], kind: Kind::$kind }),*]),
            pattern: match BitPattern::parse($drawn) {
                Ok(pattern) => pattern,
                Err(_) => panic!(concat!("the pattern of `", stringify!($name), "` cannot be read")),
            },
            drawn: Cow::Borrowed($drawn),
            outcomes: Cow::Borrowed(&[$(OutcomeDef {
                name: Cow::Borrowed(stringify!($outcome)),
                cost: Counts::from_pairs(&[$((stringify!($class), $n)),*]),
                each: Counts::from_pairs(&[$($((stringify!($unit), $m)),+)?]),
                is_body: false,
            }),+]),
        },)*)*];

        $($(const _: () = {
            const OPERANDS: &[Operand] = &[$(Operand { letter: stringify!($letter).as_bytes()[0], kind: Kind::$kind }),*];
            let Ok(pattern) = BitPattern::parse($drawn) else { panic!() };
            assert!(!pattern.is_custom(), concat!("`", stringify!($name), "` stands in an opcode kept for extensions"));
            assert!(InstructionDef::check(OPERANDS, &pattern, 1).is_ok(), concat!("operands and pattern of `", stringify!($name), "` do not fit"));
        };)*)*

        /// An outcome type a row, in a module of the row's name.
        pub mod outcome {
            $($(outcome_type! { $name [$($outcome($($class $n),* $(; each $($unit $m),+)?)),+] })*)*
        }
    };
}

crate::instructions!(stamp);

/// The built-in rows, in the order of [`Op::BUILT_IN`].
pub static INSTRUCTIONS: &[InstructionDef] = TABLE;

const _: () = {
    let mut at = 0;
    while at < TABLE.len() {
        let mut other = 0;
        while other < at {
            assert!(!TABLE[at].pattern.overlaps(&TABLE[other].pattern), "two patterns overlap");
            other += 1;
        }
        at += 1;
    }
};
