//! The kernels as they count and as they round, and what they say of their registers: the rows of the annexes, and pictures in each mode of
//! rounding and overflow.

mod annex;
mod distances;
mod drawing;
mod formats;
mod machine;
mod modes;
mod packed;
mod packets;
mod pieces;
mod ties;
