//! Rows that touch the local buffer, and rows that touch global memory over the bus.

/// Hands the rows of the room on.
#[doc(hidden)]
#[macro_export]
macro_rules! memory_instructions {
    ([$($before:tt)*] $next:ident $($rest:ident)*) => { $crate::$next! { [$($before)*
        local local LocalRoom "The local buffer of a core: octet addresses from 0, little-endian, any alignment. An access beyond its end is a trap." {
            /// Loads an octet, unsigned, from the buffer at `a + i`.
            lbu (d: S, a: A, i: Off)          "011000 ddddd aaaaa iiiiiiiiiiiiiiii"    [Done(local 1)];
            /// Loads 16 bits, signed, from the buffer at `a + i`.
            lh (d: S, a: A, i: Off)           "011001 ddddd aaaaa iiiiiiiiiiiiiiii"    [Done(local 1)];
            /// Loads 16 bits, unsigned, from the buffer at `a + i`.
            lhu (d: S, a: A, i: Off)          "011010 ddddd aaaaa iiiiiiiiiiiiiiii"    [Done(local 1)];
            /// Loads 32 bits from the buffer at `a + i`.
            lw (d: S, a: A, i: Off)           "011011 ddddd aaaaa iiiiiiiiiiiiiiii"    [Done(local 1)];
            /// Stores the low octet of `b` to the buffer at `a + i`.
            sb (b: S, a: A, i: Off)           "011100 bbbbb aaaaa iiiiiiiiiiiiiiii"    [Done(local 1)];
            /// Stores the low 16 bits of `b` to the buffer at `a + i`.
            sh (b: S, a: A, i: Off)           "011101 bbbbb aaaaa iiiiiiiiiiiiiiii"    [Done(local 1)];
            /// Stores 32 bits to the buffer at `a + i`.
            sw (b: S, a: A, i: Off)           "011110 bbbbb aaaaa iiiiiiiiiiiiiiii"    [Done(local 1)];
            /// Loads three words of 32 bits from the buffer at `a + i`.
            lv (d: V, a: A, i: Off)           "011111 ddddd aaaaa iiiiiiiiiiiiiiii"    [Done(local 3)];
            /// Stores three words of 32 bits to the buffer at `a + i`.
            sv (b: V, a: A, i: Off)           "100000 bbbbb aaaaa iiiiiiiiiiiiiiii"    [Done(local 3)];
            /// Loads three signed numbers of 16 bits from the buffer at `a + i`, each shifted left by `j`; the low 32 bits stay.
            lvh (d: V, a: A, i: Off, j: Sh)   "100001 ddddd aaaaa iiiiiiiiii jjjjjj"   [Done(local 3)];
            /// Loads a wide number of 64 bits from the buffer at `a + i`.
            lwide (d: W, a: A, i: Off)        "100010 ddd00 aaaaa iiiiiiiiiiiiiiii"    [Done(local 2)];
            /// Stores a wide number of 64 bits to the buffer at `a + i`.
            swide (b: W, a: A, i: Off)        "100010 bbb01 aaaaa iiiiiiiiiiiiiiii"    [Done(local 2)];
            /// Loads 32 bits from the buffer at `x`, then adds `i` octets to `x`; where both are one register, the sum stays.
            lwp (d: S, x: S, i: Off)          "100011 ddddd xxxxx iiiiiiiiiiiiiiii"    [Done(local 1, address 1)];
            /// Loads three words from the buffer at `x`, then adds `i` octets to `x`.
            lvp (d: V, x: S, i: Off)          "100100 ddddd xxxxx iiiiiiiiiiiiiiii"    [Done(local 3, address 1)];
            /// Stores 32 bits to the buffer at `x`, then adds `i` octets to `x`.
            swp (b: S, x: S, i: Off)          "100101 bbbbb xxxxx iiiiiiiiiiiiiiii"    [Done(local 1, address 1)];
        }
        bus bus BusRoom "Global memory, over the shared bus: the core waits for the arbiter, then for the transfer." {
            /// Copies `c` octets, an unsigned number, from global memory at `b` to the buffer at `a`.
            load (a: A, b: A, c: S)           "100110 aaaaa bbbbb ccccc ----- 000000"  [Done(mem 1; each octet 1)];
            /// Copies `c` octets, an unsigned number, from the buffer at `b` to global memory at `a`.
            store (a: A, b: A, c: S)          "100110 aaaaa bbbbb ccccc ----- 000001"  [Done(mem 1; each octet 1)];
            /// Loads 32 bits from global memory at `a + i`.
            ldw (d: S, a: A, i: Off)          "100111 ddddd aaaaa iiiiiiiiiiiiiiii"    [Done(mem 1, octet 4)];
            /// Loads a wide number of 64 bits from global memory at `a + i`.
            ldwide (d: W, a: A, i: Off)       "100010 ddd10 aaaaa iiiiiiiiiiiiiiii"    [Done(mem 1, octet 8)];
            /// Loads three vectors, nine words of 32 bits, from global memory at `a + i`.
            ldv3 (d: V3, a: A, i: Off)        "010111 ddddd aaaaa iiiiiiiiiiiiiiii"    [Done(mem 1, octet 36)];
            /// Copies `c` signed numbers of `i` bits each, which stand bit behind bit in global memory from octet `b` on, to words of the buffer at `a`. Of more than 32 bits the low 32 stay.
            loadf (a: A, b: A, c: S, i: Sh)   "110110 aaaaa bbbbb ccccc iiiiii 00000"  [Done(mem 1; each octet 1)];
            /// As `loadf`, for numbers without a sign.
            loadfu (a: A, b: A, c: S, i: Sh)  "110110 aaaaa bbbbb ccccc iiiiii 00001"  [Done(mem 1; each octet 1)];
            /// Loads three vectors, nine signed numbers of `j` bits each, which stand bit behind bit in global memory from octet `a + i` on.
            ldv3f (d: V3, a: A, i: Off, j: Sh) "110111 ddddd aaaaa iiiiiiiiii jjjjjj"  [Done(mem 1; each octet 1)];
            /// Loads the node of a kd tree that is named `a`, 8 times its number counted from address 0, as a pattern that the rows of walks take. In global memory a node has a signed plane of `i` bits and a link of `j`, in as many octets as they fill: a link is the axis or the 3 of a leaf in its two lowest bits, and an eighth of a name or an address above them.
            ldnode (d: W, a: A, i: Sh, j: Un) "110110 ddd aaaaa iiiiii jjjjj -- 00010" [Done(mem 1; each octet 1)];
            /// Copies `c` nodes from that named `b` on, as `ldnode` finds them, to patterns in the buffer at `a`.
            loadnode (a: A, b: A, c: S, i: Sh, j: Un) "111000 aaaaa bbbbb ccccc iiiiii jjjjj" [Done(mem 1; each octet 1)];
            /// Stores 32 bits to global memory at `a + i`.
            stw (b: S, a: A, i: Off)          "101000 bbbbb aaaaa iiiiiiiiiiiiiiii"    [Done(mem 1, octet 4)];
            /// Stores three words of 32 bits to global memory at `a + i`.
            stv (b: V, a: A, i: Off)          "101001 bbbbb aaaaa iiiiiiiiiiiiiiii"    [Done(mem 1, octet 12)];
            /// Atomic counter: `d` = the 32 bits of global memory at `a`, which become their sum with `b` modulo 2^32.
            fetchadd (d: S, a: A, b: S)       "100110 ddddd aaaaa bbbbb ----- 000010"  [Done(add 1, mem 1, octet 8)];
            /// Sends two vectors to the core of number `a`; blocks until its mailbox for this core is free. A number that no core has is a trap.
            send2 (a: S, b: V2)               "100110 aaaaa bbbbb ----- ----- 000011"  [Done(mem 1, octet 24)];
            /// Sends five vectors to the core of number `a`. Blocks and traps as `send2`.
            send5 (a: S, b: V5)               "100110 aaaaa bbbbb ----- ----- 000100"  [Done(mem 1, octet 60)];
            /// Receives two vectors; `e` = the sender's number. Blocks until a message is there; of several the earliest, then that of the lowest sender. A message of another length is a trap.
            recv2 (d: V2, e: S)               "100110 ddddd eeeee ----- ----- 000101"  [Done(move 6)];
            /// Receives five vectors; `e` = the sender's number. Blocks and traps as `recv2`.
            recv5 (d: V5, e: S)               "100110 ddddd eeeee ----- ----- 000110"  [Done(move 15)];
            /// Waits until every core and the main processor wait here, those left out that have halted and have nothing to start over for.
            barrier ()                        "100110 ----- ----- ----- ----- 000111"  [Done(move 0)];
        }
    ] $($rest)* } };
}
