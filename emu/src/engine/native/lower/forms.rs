//! One trait a room for what its rows are in generated code, stamped from the table: a row without a form does not compile.

use cranelift_codegen::ir::Value;

use super::{Form, S, V, W};

/// Value that a form gets for an operand: registers by number, immediates by value, because they are known when code is generated.
macro_rules! operand {
    (S) => {
        S
    };
    (A) => {
        S
    };
    (V) => {
        V
    };
    (V2) => {
        V
    };
    (V3) => {
        V
    };
    (V5) => {
        V
    };
    (W) => {
        W
    };
    (W3) => {
        W
    };
    ($immediate:ident) => {
        i32
    };
}

/// Value that a form makes for an operand that is written.
macro_rules! made {
    (V2) => {
        [Value; 2]
    };
    (V3) => {
        [Value; 3]
    };
    (V5) => {
        [Value; 5]
    };
    (W3) => {
        [Value; 3]
    };
    ($register:ident) => {
        Value
    };
}

/// One method of a room's trait.
macro_rules! method {
    ({ $name:ident [$(#[doc = $doc:expr])*] } [$(($letter:ident $kind:ident))*] [$(($written:ident $made:ident))*]) => {
        $(#[doc = $doc])*
        fn $name(&mut self, $($letter: operand!($kind)),*) -> Form<($(made!($made),)*)>;
    };
}

macro_rules! rooms {
    ($($style:ident $room:ident $trait:ident $room_doc:literal {
        $($(#[doc = $doc:expr])* $name:ident ($($operands:tt)*) $drawn:literal [$($exits:tt)*];)*
    })*) => {
        $(
            #[doc = $room_doc]
            pub(super) trait $trait {
                $(crate::semantics::split_operands! { method { $name [$(#[doc = $doc])*] } [] [] ($($operands)*) })*
            }
        )*
    };
}

isa::instructions!(rooms);
