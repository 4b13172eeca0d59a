//! Ray-tracing kernels in assembly, their layouts and bit-exact Rust twins.
