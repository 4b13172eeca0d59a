//! Numeric rows on vectors of three components.

/// Hands the rows of the room on.
#[doc(hidden)]
#[macro_export]
macro_rules! vector_instructions {
    ([$($before:tt)*] $next:ident $($rest:ident)*) => { $crate::$next! { [$($before)*
        pure vector VectorRoom "Three fixed-point components at once: positions, directions, colours. Each component is quantized once; copies, single components and selections move raw bits." {
            /// Sum of two vectors, component by component.
            vadd (d: V, a: V, b: V)           "010000 ddddd aaaaa bbbbb ------ 00000"  [Done(add 3)];
            /// Difference of two vectors, component by component.
            vsub (d: V, a: V, b: V)           "010000 ddddd aaaaa bbbbb ------ 00001"  [Done(sub 3)];
            /// Negation, component by component.
            vneg (d: V, a: V)                 "010000 ddddd aaaaa ----- ------ 00010"  [Done(sub 3)];
            /// Absolute value, component by component.
            vabs (d: V, a: V)                 "010000 ddddd aaaaa ----- ------ 00011"  [Done(sub 3, cmp 3)];
            /// The smaller of each component.
            vmin (d: V, a: V, b: V)           "010000 ddddd aaaaa bbbbb ------ 00100"  [Done(cmp 3)];
            /// The larger of each component.
            vmax (d: V, a: V, b: V)           "010000 ddddd aaaaa bbbbb ------ 00101"  [Done(cmp 3)];
            /// Products component by component, shifted right by `i`, each rounded once.
            vmul (d: V, a: V, b: V, i: Sh)    "010000 ddddd aaaaa bbbbb iiiiii 00110"  [Done(mul 3)];
            /// Vector times scalar, shifted right by `i`, each component rounded once.
            vscale (d: V, a: V, b: S, i: Sh)  "010000 ddddd aaaaa bbbbb iiiiii 00111"  [Done(mul 3)];
            /// Exact quotients `a 2^i / b`, each component rounded once; division by zero as in `div`.
            vdiv (d: V, a: V, b: S, i: Sh)    "010000 ddddd aaaaa bbbbb iiiiii 01000"  [Done(div 3)];
            /// Dot product, shifted right by `i`, one rounding of the exact sum.
            vdot (d: S, a: V, b: V, i: Sh)    "010000 ddddd aaaaa bbbbb iiiiii 01001"  [Done(add 2, mul 3)];
            /// Cross product `a x b`, shifted right by `i`; each component is one rounding of the exact difference.
            vcross (d: V, a: V, b: V, i: Sh)  "010000 ddddd aaaaa bbbbb iiiiii 01010"  [Done(sub 3, mul 6)];
            /// Direction of the exact cross product `a x b`, scaled by the power of two that brings the largest component
            /// into [2^(word-3), 2^(word-2)], each component rounded once; zero stays zero.
            vcrossn (d: V, a: V, b: V)        "010000 ddddd aaaaa bbbbb ------ 01011"  [Done(sub 3, mul 6, logic 3)];
            /// `a` scaled by the power of two 2^-e that brings the largest component into [2^(word-3), 2^(word-2)], each
            /// component rounded once; zero stays zero with e = 0.
            vnorm (d: V, e: S, a: V)          "010000 ddddd aaaaa eeeee ------ 01100"  [Done(logic 3)];
            /// Copy of a vector.
            vmov (d: V, a: V)                 "010000 ddddd aaaaa ----- ------ 01101"  [Done(move 3)];
            /// All three components equal to `a`.
            vsplat (d: V, a: S)               "010000 ddddd aaaaa ----- ------ 01110"  [Done(move 3)];
            /// Component `i` of `a`.
            vget (d: S, a: V, i: Lane)        "010000 ddddd aaaaa ----- ----ii 01111"  [Done(move 1)];
            /// Component `b` modulo 4 of `a`; component 3 reads zero.
            vgetr (d: S, a: V, b: S)          "010000 ddddd aaaaa bbbbb ------ 10000"  [Done(move 1)];
            /// Puts `a` into component `i`.
            vput (x: V, a: S, i: Lane)        "010000 xxxxx aaaaa ----- ----ii 10001"  [Done(move 1)];
            /// Puts `a` into component `b` modulo 4; component 3 is nowhere.
            vputr (x: V, a: S, b: S)          "010000 xxxxx aaaaa bbbbb ------ 10010"  [Done(move 1)];
            /// Number of the component with the largest absolute value, those taken as 32 unsigned bits; of equal ones the first.
            vmajor (d: S, a: V)               "010000 ddddd aaaaa ----- ------ 10011"  [Done(sub 3, cmp 2)];
            /// A bit a component (component 0 lowest): set where `a < b`.
            vlt (d: S, a: V, b: V)            "010000 ddddd aaaaa bbbbb ------ 10100"  [Done(cmp 3)];
            /// Component `i` from `a` where bit `i` of `b` is set, else unchanged.
            vselect (x: V, a: V, b: S)        "010000 xxxxx aaaaa bbbbb ------ 10101"  [Done(move 3)];
        }
    ] $($rest)* } };
}
