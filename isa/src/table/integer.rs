//! Integer rows: 32 bits, modulo 2^32, whatever the machine's word: addresses, counters, logic.

/// Hands the rows of the room on.
#[doc(hidden)]
#[macro_export]
macro_rules! integer_instructions {
    ([$($before:tt)*] $next:ident $($rest:ident)*) => { $crate::$next! { [$($before)*
        pure integer IntegerRoom "Integers of 32 bits in scalar registers, modulo 2^32 whatever the word: counters, addresses, logic, constants." {
            /// Sum `d = a + b` modulo 2^32.
            iadd (d: S, a: S, b: S)          "000001 ddddd aaaaa bbbbb ------ 00000"  [Done(add 1)];
            /// Difference `d = a - b` modulo 2^32.
            isub (d: S, a: S, b: S)          "000001 ddddd aaaaa bbbbb ------ 00001"  [Done(sub 1)];
            /// Product `d = a b` modulo 2^32.
            imul (d: S, a: S, b: S)          "000001 ddddd aaaaa bbbbb ------ 00010"  [Done(mul 1)];
            /// Bitwise and.
            and (d: S, a: S, b: S)           "000001 ddddd aaaaa bbbbb ------ 00011"  [Done(logic 1)];
            /// Bitwise or.
            or (d: S, a: S, b: S)            "000001 ddddd aaaaa bbbbb ------ 00100"  [Done(logic 1)];
            /// Bitwise exclusive or.
            xor (d: S, a: S, b: S)           "000001 ddddd aaaaa bbbbb ------ 00101"  [Done(logic 1)];
            /// `a` shifted left by the low five bits of `b`.
            sll (d: S, a: S, b: S)           "000001 ddddd aaaaa bbbbb ------ 00110"  [Done(logic 1)];
            /// `a` shifted right by the low five bits of `b`, zeros coming in.
            srl (d: S, a: S, b: S)           "000001 ddddd aaaaa bbbbb ------ 00111"  [Done(logic 1)];
            /// `a` shifted right by the low five bits of `b`, the sign coming in; not rounded.
            sra (d: S, a: S, b: S)           "000001 ddddd aaaaa bbbbb ------ 01000"  [Done(logic 1)];
            /// 1 when `a < b` as signed numbers, else 0.
            slt (d: S, a: S, b: S)           "000001 ddddd aaaaa bbbbb ------ 01001"  [Done(cmp 1)];
            /// Number of zero bits above the highest one of `a`; 32 for 0.
            clz (d: S, a: S)                 "000001 ddddd aaaaa ----- ------ 01010"  [Done(logic 1)];
            /// Copy of `a`.
            mov (d: S, a: S)                 "000001 ddddd aaaaa ----- ------ 01011"  [Done(move 1)];
            /// Address `d = a + b` in octets.
            addr (d: S, a: A, b: S)          "000001 ddddd aaaaa bbbbb ------ 01100"  [Done(address 1)];
            /// `a` shifted left by `i` bits, 0 to 31.
            slli (d: S, a: S, i: Un)         "000001 ddddd aaaaa iiiii ------ 10000"  [Done(logic 1)];
            /// `a` shifted right by `i` bits, 0 to 31, zeros coming in.
            srli (d: S, a: S, i: Un)         "000001 ddddd aaaaa iiiii ------ 10001"  [Done(logic 1)];
            /// `a` shifted right by `i` bits, 0 to 31, the sign coming in; not rounded.
            srai (d: S, a: S, i: Un)         "000001 ddddd aaaaa iiiii ------ 10010"  [Done(logic 1)];
            /// Sum `d = a + i` modulo 2^32.
            iaddi (d: S, a: S, i: Im)        "000010 ddddd aaaaa iiiiiiiiiiiiiiii"    [Done(add 1)];
            /// Difference `d = a - i` modulo 2^32.
            isubi (d: S, a: S, i: Im)        "000011 ddddd aaaaa iiiiiiiiiiiiiiii"    [Done(sub 1)];
            /// Bitwise and with an unsigned constant.
            andi (d: S, a: S, i: Un)         "000100 ddddd aaaaa iiiiiiiiiiiiiiii"    [Done(logic 1)];
            /// Bitwise or with an unsigned constant.
            ori (d: S, a: S, i: Un)          "000101 ddddd aaaaa iiiiiiiiiiiiiiii"    [Done(logic 1)];
            /// Constant `d = i`.
            movi (d: S, i: Im)               "000110 ddddd ----- iiiiiiiiiiiiiiii"    [Done(move 1)];
            /// Replaces the upper 16 bits of `x` by `i`.
            movhi (x: S, i: Un)              "000111 xxxxx ----- iiiiiiiiiiiiiiii"    [Done(move 1)];
            /// Address `d = a + i` in octets.
            lea (d: S, a: A, i: Off)         "001000 ddddd aaaaa iiiiiiiiiiiiiiii"    [Done(address 1)];
            /// Address `d = a + i b` of element `b` of an array at `a` whose elements have `i` octets.
            element (d: S, a: A, b: S, i: Un) "001001 ddddd aaaaa bbbbb iiiiiiiiiii"  [Done(address 1)];
        }
    ] $($rest)* } };
}
