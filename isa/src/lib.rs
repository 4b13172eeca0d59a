//! The instruction set of lancer: definitions, encoding, arithmetic.

pub mod class;
pub mod definition;
pub mod extension;
mod isa;
pub mod naming;
pub mod number;
pub mod pattern;
pub mod program;
pub mod table;

pub use class::{Class, Counts};
pub use definition::{InstructionDef, Kind, Operand, OutcomeDef};
pub use isa::{EncodeError, Fields, Instruction, Isa, parse_register, register_name};
pub use program::Program;
pub use table::{INSTRUCTIONS, Op};
