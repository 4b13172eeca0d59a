//! The kernels as they count and as they round: the rows of the annexes, and pictures in each mode of rounding and overflow.

mod annex;
mod modes;
mod packets;
mod ties;
