//! Rows of the walk unit: several steps down a kd tree at once, in a block of nodes that lies in the local buffer.

/// Hands the rows of the room on.
#[doc(hidden)]
#[macro_export]
macro_rules! walk_instructions {
    ([$($before:tt)*] $next:ident $($rest:ident)*) => { $crate::$next! { [$($before)*
        buffered walk WalkRoom "Steps down a kd tree in the local buffer, as `rstep` decides them. A node is a pattern of 64 bits: its plane, with the address of its left child above the axis; the right child lies 8 octets on. A block is two words, the address of its first node in global memory and its number of octets, then the nodes. A note is a plane of 64 bits and the address of the child behind it, 12 octets." {
            /// Goes down with ray `a` from the node at address `x`, as long as the next node lies in the block at `c` of the buffer and behind the one
            /// before. The ray came by plane `b` and leaves by that of the last note, at `y` of the buffer. Where it visits both children of a node,
            /// the node and its second child are noted 12 octets on, and `y` goes there.
            ///
            /// At a leaf, a node of axis 3, `d` is the leaf and `x` its address part. Otherwise `d` = 0 and `x` is the address of the next node. Each unit
            /// of the cost is a node. A block, or a note, that leaves the buffer is a trap.
            rwalk (d: W, x: S, y: S, a: V2, b: W, c: A) "010110 ddd xxxxx yyyyy aaaaa bbb ccccc" [
                Leaf(cmp 1, local 4; each sub 3, mul 4, cmp 6, local 5),
                Outside(cmp 1, local 4; each sub 3, mul 4, cmp 6, local 5)
            ];
        }
    ] $($rest)* } };
}
