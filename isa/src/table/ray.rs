//! Rows of the ray unit: exact tests of a ray against triangles, boxes and the planes of a kd tree.

/// Hands the rows of the room on.
#[doc(hidden)]
#[macro_export]
macro_rules! ray_instructions {
    ([$($before:tt)*] $next:ident $($rest:ident)*) => { $crate::$next! { [$($before)*
        pure ray RayRoom "A ray (two vectors: its origin, its direction) against triangles, boxes and planes, on exact integers with one rounding at the end. What is met exactly is decided as if the direction were moved by (e, e^2, e^3), e > 0 infinitely small. A plane is a pattern of 64 bits: its coordinate in the low half, its axis in the two lowest bits of the high half; axis 3 stands for the moment t = coordinate, so 3 in the high half and 0 in the low one for the start of the ray." {
            /// Ray `a` against the triangle of vertices `b`: `d` = t of the hit, the largest word for a miss; `e` = (u, v, 0), the weights
            /// of the second and third vertex with word - 2 fraction bits.
            ///
            /// Tests, in this order, that the determinant is not 0, u >= 0, v >= 0, u + v <= 1, t > 0, all exactly. t, scaled by 2^i,
            /// u and v are exact quotients, rounded once; a t beyond the word saturates in every mode. Each edge that the ray meets
            /// exactly is decided by the sign of the first component other than 0 of its normal, the cross product of its ends as the
            /// origin sees them.
            rtri (d: S, e: V, a: V2, b: V3, i: Sh) "010010 ddddd eeeee aaaaa bbbbb iiiiii" [
                Parallel(add 2, sub 9, mul 9, cmp 1),
                OutsideU(add 4, sub 12, mul 12, cmp 3; each sub 9, mul 6),
                OutsideV(add 6, sub 15, mul 21, cmp 5; each sub 9, mul 6),
                OutsideW(add 6, sub 17, mul 21, cmp 7; each sub 9, mul 6),
                Behind(add 8, sub 17, mul 24, cmp 9; each sub 9, mul 6),
                Hit(add 8, sub 17, mul 24, div 3, cmp 9; each sub 9, mul 6)
            ];
            /// Crossings of ray `a` and the box of corners `b`: `d` = the plane by which it enters, or the start when it starts inside; `e` = the
            /// plane by which it leaves. Both have all bits set for a ray that misses the box.
            rbox (d: W, e: W, a: V2, b: V2)   "010011 dddee eaaaa abbbb b---- ---010"  [
                Beside(cmp 4), Inside(sub 3, mul 4, cmp 10), Missed(sub 6, mul 10, cmp 14), Entered(sub 6, mul 10, cmp 14)
            ];
            /// The plane by which ray `a` leaves the box of corners `b`, in which it is: the first of the three that are ahead, found without
            /// division.
            rexit (d: W, a: V2, b: V2)        "010011 ddd-- -aaaa abbbb b---- ---110"  [Done(sub 3, mul 4, cmp 2)];
            /// A step down a kd tree: which children of a node ray `a` visits between two planes. `b` = the node's plane, with the address of
            /// its left child above the axis (a multiple of 4; the right child lies `i` octets on), the plane by which the ray came,
            /// and the plane by which it leaves. `d` = the address of the first child, `e` = that of the second, 0 when there is none.
            ///
            /// Of a leaf, a node of axis 3, `d` = its address part and `e` = -1. A split through the origin or behind it, or met no later
            /// than the first plane, has been crossed (`Behind`, `Passed`): the child on the side to which the ray goes remains, a
            /// direction of 0 going to larger coordinates. One met no earlier than the last plane is out of reach (`Near`).
            rstep (d: S, e: S, a: V2, b: W3, i: Un) "010011 ddddd eeeee aaaaa bbb iiiii - 01" [
                Leaf(cmp 1), Behind(cmp 2), Passed(sub 2, mul 2, cmp 4), Near(sub 3, mul 4, cmp 6), Both(sub 3, mul 4, cmp 6)
            ];
            /// 1 when the point of ray `a` at t = `c` (scaled by 2^i) is nearer than plane `b` even if it were one unit further on, else 0: then no
            /// hit behind the plane can be nearer.
            rbefore (d: S, a: V2, b: W, c: S, i: Sh) "010011 ddddd aaaaa bbb ccccc iiiiii 00" [Done(add 1, sub 2, mul 1, cmp 1)];
        }
    ] $($rest)* } };
}
