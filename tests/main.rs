//! All tests of the package in one program, which is linked once. `cargo test -p lancer NAME` runs those of a module or with a word in their
//! names. `tests/memory.rs` alone is a program of its own, because it counts what its process allocates.

mod accuracy;
mod architecture;
mod bless;
mod case;
mod cases;
mod cli;
mod contract;
mod energy;
mod extension;
mod faults;
mod inject;
mod laws;
mod profiles;
mod protection;
mod python;
mod readme;
mod report;
mod skips;
mod stress;
mod twin;
