//! Numeric rows on scalars: fixed-point results are quantized to the word under the machine's modes.

/// Hands the rows of the room on.
#[doc(hidden)]
#[macro_export]
macro_rules! scalar_instructions {
    ([$($before:tt)*] $next:ident $($rest:ident)*) => { $crate::$next! { [$($before)*
        pure scalar ScalarRoom "Fixed-point numbers in scalar registers. A result is quantized to the word under the machine's modes." {
            /// Sum `d = a + b`.
            add (d: S, a: S, b: S)           "000000 ddddd aaaaa bbbbb ------ 00000"  [Done(add 1)];
            /// Difference `d = a - b`.
            sub (d: S, a: S, b: S)           "000000 ddddd aaaaa bbbbb ------ 00001"  [Done(sub 1)];
            /// Negation `d = -a`; the least number saturates.
            neg (d: S, a: S)                 "000000 ddddd aaaaa ----- ------ 00010"  [Done(sub 1)];
            /// Absolute value of `a`; the least number saturates.
            abs (d: S, a: S)                 "000000 ddddd aaaaa ----- ------ 00011"  [Done(sub 1, cmp 1)];
            /// Product `d = a b`, shifted right by `i`, rounded once.
            mul (d: S, a: S, b: S, i: Sh)    "000000 ddddd aaaaa bbbbb iiiiii 00100"  [Done(mul 1)];
            /// Quotient `d = a 2^i / b` of exact numbers, rounded once; x / 0 saturates with the sign of x, 0 / 0 = 0.
            div (d: S, a: S, b: S, i: Sh)    "000000 ddddd aaaaa bbbbb iiiiii 00101"  [Done(div 1)];
            /// The smaller of `a` and `b`.
            min (d: S, a: S, b: S)           "000000 ddddd aaaaa bbbbb ------ 00110"  [Done(cmp 1)];
            /// The larger of `a` and `b`.
            max (d: S, a: S, b: S)           "000000 ddddd aaaaa bbbbb ------ 00111"  [Done(cmp 1)];
            /// `a` shifted right by `i` bits, rounded.
            rshift (d: S, a: S, i: Sh)       "000000 ddddd aaaaa ----- iiiiii 01000"  [Done(logic 1)];
            /// `a` shifted left by `i` bits; what does not fit the word overflows under the machine's mode.
            lshift (d: S, a: S, i: Sh)       "000000 ddddd aaaaa ----- iiiiii 01001"  [Done(logic 1)];
            /// `a` shifted right by `b` bits, rounded, or left by `-b` bits; `b` beyond 63 either way counts as 63.
            scale (d: S, a: S, b: S)         "000000 ddddd aaaaa bbbbb ------ 01010"  [Done(logic 1)];
        }
    ] $($rest)* } };
}
