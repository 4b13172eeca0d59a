//! The kernels' Rust twins against the assembly, bit for bit: whole pictures, and function by function on random operands. And how far
//! both are from exact results, as snapshots.

mod twin;
