//! Rows on wide accumulators: products kept unrounded, decided on, and rounded once at the end.

/// Hands the rows of the room on.
#[doc(hidden)]
#[macro_export]
macro_rules! wide_instructions {
    ([$($before:tt)*] $next:ident $($rest:ident)*) => { $crate::$next! { [$($before)*
        pure wide WideRoom "Accumulators of twice the word: full products kept unrounded, one rounded quotient or root at the end. A result that does not fit 2 x word bits overflows under the machine's mode." {
            /// Exact product of two scalars.
            wmul (d: W, a: S, b: S)           "010001 ddd-- aaaaa bbbbb ------ 00000"  [Done(mul 1)];
            /// Adds the exact product `a b` to `x`.
            wmac (x: W, a: S, b: S)           "010001 xxx-- aaaaa bbbbb ------ 00001"  [Done(add 1, mul 1)];
            /// Subtracts the exact product `a b` from `x`.
            wmsub (x: W, a: S, b: S)          "010001 xxx-- aaaaa bbbbb ------ 00010"  [Done(sub 1, mul 1)];
            /// Exact dot product of two vectors.
            wdot (d: W, a: V, b: V)           "010001 ddd-- aaaaa bbbbb ------ 00011"  [Done(add 2, mul 3)];
            /// Sum.
            wadd (d: W, a: W, b: W)           "010001 ddd-- aaa-- bbb-- ------ 00100"  [Done(add 1)];
            /// Difference.
            wsub (d: W, a: W, b: W)           "010001 ddd-- aaa-- bbb-- ------ 00101"  [Done(sub 1)];
            /// Product of two wide numbers.
            wmulw (d: W, a: W, b: W)          "010001 ddd-- aaa-- bbb-- ------ 00110"  [Done(mul 1)];
            /// Negation.
            wneg (d: W, a: W)                 "010001 ddd-- aaa-- ----- ------ 00111"  [Done(sub 1)];
            /// Copy.
            wmov (d: W, a: W)                 "010001 ddd-- aaa-- ----- ------ 01000"  [Done(move 1)];
            /// `a 2^i` as a wide number.
            wextend (d: W, a: S, i: Sh)       "010001 ddd-- aaaaa ----- iiiiii 01001"  [Done(logic 1)];
            /// `a` shifted right by `i`, rounded, as a scalar.
            wround (d: S, a: W, i: Sh)        "010001 ddddd aaa-- ----- iiiiii 01010"  [Done(logic 1)];
            /// `a` shifted right by `b` bits, rounded, as a scalar, or left by `-b` bits; `b` beyond 63 either way counts as 63.
            wscale (d: S, a: W, b: S)         "010001 ddddd aaa-- bbbbb ------ 01011"  [Done(logic 1)];
            /// Quotient `a 2^i / b` of exact numbers, rounded once to a scalar; division by zero as in `div`.
            wdiv (d: S, a: W, b: W, i: Sh)    "010001 ddddd aaa-- bbb-- iiiiii 01100"  [Done(div 1)];
            /// Square root of `a 2^i`, correctly rounded to the nearest scalar; 0 for a negative `a`. It costs what a table of
            /// reciprocal roots, a Newton step, a step with the exact remainder and an exact correction cost.
            wsqrt (d: S, a: W, i: Sh)         "010001 ddddd aaa-- ----- iiiiii 01101"  [Done(add 3, sub 5, mul 7, cmp 2)];
            /// Bitwise and of the two's complement patterns.
            wand (d: W, a: W, b: W)           "010001 ddd-- aaa-- bbb-- ------ 01110"  [Done(logic 1)];
            /// Pattern of 64 bits shifted left by the low six bits of `b`, modulo 2^64.
            wsll (d: W, a: W, b: S)           "010001 ddd-- aaa-- bbbbb ------ 01111"  [Done(logic 1)];
            /// Pattern of 64 bits shifted right by the low six bits of `b`, zeros coming in.
            wsrl (d: W, a: W, b: S)           "010001 ddd-- aaa-- bbbbb ------ 10000"  [Done(logic 1)];
            /// Number of zero bits above the highest one of the pattern of 64 bits; 64 for 0.
            wclz (d: S, a: W)                 "010001 ddddd aaa-- ----- ------ 10001"  [Done(logic 1)];
            /// All ones when `a < 0`, else 0.
            wltz (d: W, a: W)                 "010001 ddd-- aaa-- ----- ------ 10010"  [Done(cmp 1)];
            /// Low 32 bits of the pattern of 64 bits.
            wlow (d: S, a: W)                 "010001 ddddd aaa-- ----- ------ 10011"  [Done(move 1)];
            /// High 32 bits of the pattern of 64 bits.
            whigh (d: S, a: W)                "010001 ddddd aaa-- ----- ------ 10100"  [Done(move 1)];
            /// Pattern of 64 bits with `a` as its high and `b` as its low half.
            wjoin (d: W, a: S, b: S)          "010001 ddd-- aaaaa bbbbb ------ 10101"  [Done(move 1)];
            /// Exact cross product `a x b`, one wide component a register.
            wcross (d: W3, a: V, b: V)        "010001 ddd-- aaaaa bbbbb ------ 10110"  [Done(sub 3, mul 6)];
            /// Exact dot product of wide components and a vector, shifted right by `i`, rounded once: with `wcross`, a determinant.
            wmixed (d: W, a: W3, b: V, i: Sh) "010001 ddd-- aaa-- bbbbb iiiiii 10111"  [Done(add 2, mul 3)];
        }
    ] $($rest)* } };
}
