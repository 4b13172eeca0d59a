//! Semantics of instructions: one trait a room, stamped from the table, so that an instruction without semantics does not compile.
//! Moving registers, counting and choosing when a transfer happens belong to engines and machines.

mod bus;
mod control;
mod integer;
mod local;
mod numbers;
mod packet;
mod ray;
mod scalar;
mod split;
#[cfg(test)]
mod tests;
mod unpack;
mod vector;
mod walk;
mod watch;
mod wide;

use isa::number::Vector;
use isa::table::outcome;

#[cfg(all(test, feature = "native"))]
pub(crate) use bus::refuse;
pub use bus::{Link, Message, Port};
pub(crate) use bus::{at_once, hand_on, methods};
pub use control::{End, Flow, Motion};
pub use numbers::Numbers;
pub use watch::{Computes, Watch, Watching};

pub(crate) use split::split_operands;

use crate::code::octets::Buffer;
use crate::code::trap::{Fault, Stop};

/// The type of an operand's value: registers by kind, every immediate an `i32`.
macro_rules! value {
    (S) => {
        i32
    };
    (A) => {
        u32
    };
    (V) => {
        Vector
    };
    (W) => {
        i64
    };
    (V2) => {
        [Vector; 2]
    };
    (V3) => {
        [Vector; 3]
    };
    (V5) => {
        [Vector; 5]
    };
    (W3) => {
        [i64; 3]
    };
    (Sh) => {
        i32
    };
    (Im) => {
        i32
    };
    (Un) => {
        i32
    };
    (Off) => {
        i32
    };
    (Rel) => {
        i32
    };
    (Lane) => {
        i32
    };
    ($kind:ident) => {
        compile_error!(concat!(
            "operands of kind `",
            stringify!($kind),
            "` have no type: say in `value!` (emu/src/semantics/mod.rs) what semantics take"
        ))
    };
}

/// Results of semantics: the written values in the order of the table, then the outcome.
macro_rules! outcome {
    ($name:ident []) => { outcome::$name::Outcome };
    ($name:ident [$(($letter:ident $kind:ident))+]) => { ($(value!($kind),)+ outcome::$name::Outcome) };
}

/// One method of a room's trait.
macro_rules! method {
    ({ pure $name:ident [$(#[doc = $doc:expr])*] } [$(($letter:ident $kind:ident))*] $written:tt) => {
        $(#[doc = $doc])*
        fn $name(&self, $($letter: value!($kind)),*) -> outcome!($name $written);
    };
    ({ control $name:ident [$(#[doc = $doc:expr])*] } [$(($letter:ident $kind:ident))*] $written:tt) => {
        $(#[doc = $doc])*
        fn $name(&mut self, $($letter: value!($kind)),*) -> outcome!($name $written);
    };
    ({ local $name:ident [$(#[doc = $doc:expr])*] } [$(($letter:ident $kind:ident))*] $written:tt) => {
        $(#[doc = $doc])*
        ///
        /// # Errors
        /// An access beyond the end of the buffer.
        fn $name(&mut self, $($letter: value!($kind)),*) -> Result<outcome!($name $written), Fault>;
    };
    ({ buffered $name:ident [$(#[doc = $doc:expr])*] } [$(($letter:ident $kind:ident))*] $written:tt) => {
        $(#[doc = $doc])*
        ///
        /// # Errors
        /// An access beyond the end of the buffer; then the buffer is as it was.
        fn $name(&self, buffer: &mut Buffer, $($letter: value!($kind)),*) -> Result<outcome!($name $written), Fault>;
    };
    ({ bus $name:ident [$(#[doc = $doc:expr])*] } [$(($letter:ident $kind:ident))*] $written:tt) => {
        $(#[doc = $doc])*
        ///
        /// # Errors
        /// A fault, or that the machine is not ready: then nothing has happened and the instruction is tried again.
        fn $name(&mut self, $($letter: value!($kind)),*) -> Result<outcome!($name $written), Stop>;
    };
    ({ $style:ident $name:ident $docs:tt } $read:tt $written:tt) => {
        compile_error!(concat!("`", stringify!($name), "` is of style `", stringify!($style), "`, which is none of pure, local, buffered, bus, control"));
    };
}

macro_rules! rooms {
    ($($style:ident $room:ident $trait:ident $room_doc:literal {
        $($(#[doc = $doc:expr])* $name:ident ($($operands:tt)*) $drawn:literal [$($exits:tt)*];)*
    })*) => {
        $(
            #[doc = $room_doc]
            pub trait $trait {
                $(split_operands! { method { $style $name [$(#[doc = $doc])*] } [] [] ($($operands)*) })*
            }
        )*
    };
}

isa::instructions!(rooms);
