//! The kernels as they count: the rows of the annexes.

mod annex;
