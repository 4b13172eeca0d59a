//! Rows that choose the next instruction, and the few that ask the machine something.

/// Hands the rows of the room on.
#[doc(hidden)]
#[macro_export]
macro_rules! control_instructions {
    ([$($before:tt)*] $next:ident $($rest:ident)*) => { $crate::$next! { [$($before)*
        control control ControlRoom "Branches, calls, the core's number, the end. A branch distance counts words from the branch itself." {
            /// Branches by `i` words when `a = b`.
            beq (a: S, b: S, i: Rel)          "101010 aaaaa bbbbb iiiiiiiiiiiiiiii"    [Fall(cmp 1), Taken(cmp 1)];
            /// Branches by `i` words when `a` and `b` differ.
            bne (a: S, b: S, i: Rel)          "101011 aaaaa bbbbb iiiiiiiiiiiiiiii"    [Fall(cmp 1), Taken(cmp 1)];
            /// Branches by `i` words when `a < b` as signed numbers.
            blt (a: S, b: S, i: Rel)          "101100 aaaaa bbbbb iiiiiiiiiiiiiiii"    [Fall(cmp 1), Taken(cmp 1)];
            /// Branches by `i` words when `a >= b` as signed numbers.
            bge (a: S, b: S, i: Rel)          "101101 aaaaa bbbbb iiiiiiiiiiiiiiii"    [Fall(cmp 1), Taken(cmp 1)];
            /// Branches by `i` words when `a < b` as unsigned numbers.
            bltu (a: S, b: S, i: Rel)         "101110 aaaaa bbbbb iiiiiiiiiiiiiiii"    [Fall(cmp 1), Taken(cmp 1)];
            /// Branches by `i` words when `a >= b` as unsigned numbers.
            bgeu (a: S, b: S, i: Rel)         "101111 aaaaa bbbbb iiiiiiiiiiiiiiii"    [Fall(cmp 1), Taken(cmp 1)];
            /// Branches by `i` words when the wide `a` is 0.
            bweqz (a: W, i: Rel)              "110000 aaa00 ----- iiiiiiiiiiiiiiii"    [Fall(cmp 1), Taken(cmp 1)];
            /// Branches by `i` words when the wide `a` is not 0.
            bwnez (a: W, i: Rel)              "110000 aaa01 ----- iiiiiiiiiiiiiiii"    [Fall(cmp 1), Taken(cmp 1)];
            /// Branches by `i` words when the wide `a` is negative.
            bwltz (a: W, i: Rel)              "110000 aaa10 ----- iiiiiiiiiiiiiiii"    [Fall(cmp 1), Taken(cmp 1)];
            /// Branches by `i` words when the wide `a` is not negative.
            bwgez (a: W, i: Rel)              "110000 aaa11 ----- iiiiiiiiiiiiiiii"    [Fall(cmp 1), Taken(cmp 1)];
            /// Branches by `i` words when the wide `a < b`.
            bwlt (a: W, b: W, i: Rel)         "110001 aaa00 bbb-- iiiiiiiiiiiiiiii"    [Fall(cmp 1), Taken(cmp 1)];
            /// Branches by `i` words when the wide `a = b`.
            bweq (a: W, b: W, i: Rel)         "110001 aaa01 bbb-- iiiiiiiiiiiiiiii"    [Fall(cmp 1), Taken(cmp 1)];
            /// Jumps by `i` words.
            jump (i: Rel)                     "110010 iiiiiiiiiiiiiiiiiiiiiiiiii"      [Taken(jump 1)];
            /// Calls by `i` words; `d` = the address of the next instruction, in words.
            call (d: S, i: Rel)               "110011 ddddd iiiiiiiiiiiiiiiiiiiii"     [Taken(jump 1)];
            /// Calls the instruction at word `a`; `d` = the address of the next instruction, in words.
            callr (d: S, a: A)                "110100 ddddd aaaaa ----- ------ 00000"  [Taken(jump 1)];
            /// Returns to the instruction at word `a`.
            ret (a: A)                        "110100 ----- aaaaa ----- ------ 00001"  [Taken(jump 1)];
            /// Number of this core; the main processor is the number of cores.
            core (d: S)                       "110100 ddddd ----- ----- ------ 00010"  [Done(move 1)];
            /// Number of cores, the main processor not counted.
            cores (d: S)                      "110100 ddddd ----- ----- ------ 00011"  [Done(move 1)];
            /// Ends the work item.
            halt ()                           "110100 ----- ----- ----- ------ 00100"  [Done(jump 1)];
            /// Stops the machine with trap number `i`: for conditions that a correct kernel never meets.
            trap (i: Un)                      "110101 iiiiiiiiiiiiiiiiiiiiiiiiii"      [Done(jump 1)];
        }
    ] $($rest)* } };
}
