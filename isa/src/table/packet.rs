//! Rows of the packet unit: a ray against all triangles of a packet that lies in the local buffer.

/// Hands the rows of the room on.
#[doc(hidden)]
#[macro_export]
macro_rules! packet_instructions {
    ([$($before:tt)*] $next:ident $($rest:ident)*) => { $crate::$next! { [$($before)*
        buffered packet PacketRoom "A ray (two vectors: its origin, its direction) against a packet of `c` triangles in the local buffer at `b`, decided as `rtri` decides. A packet is 10 arrays of `c` words each, one behind the other: names of the triangles, then x, y and z of their first vertices, of the second and of the third ones. Each unit of a cost is a triangle; `packet_lanes` triangles of the machine file take the time of one." {
            /// The nearest of a hit and those of ray `a` in the packet: `x` = (t, name, anything), a hit that is already known or a limit, becomes
            /// the hit with the least t, scaled by 2^i and rounded as by `rtri`; of those at the same t the one with the least name, an unsigned number.
            ///
            /// The third component stays. A packet that leaves the buffer is a trap.
            rnear (x: V, a: V2, b: A, c: S, i: Sh) "010100 xxxxx aaaaa bbbbb ccccc iiiiii" [
                Same(cmp 1; each add 10, sub 18, mul 30, div 1, cmp 4, local 10),
                Nearer(cmp 1; each add 10, sub 18, mul 30, div 1, cmp 4, local 10)
            ];
            /// The first hit of ray `a` in the packet, in its order, whose t is below a limit: `x` = (limit, anything, anything) becomes its t, scaled
            /// by 2^i and rounded as by `rtri`, and its name; without such a hit all of it stays.
            ///
            /// The triangles behind the hit cost nothing. A packet that leaves the buffer is a trap.
            rany (x: V, a: V2, b: A, c: S, i: Sh) "010101 xxxxx aaaaa bbbbb ccccc iiiiii" [
                Clear(cmp 1; each add 10, sub 18, mul 30, div 1, cmp 3, local 10),
                Blocked(cmp 0; each add 10, sub 18, mul 30, div 1, cmp 3, local 10)
            ];
        }
    ] $($rest)* } };
}
