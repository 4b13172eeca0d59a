//! Programs on the machine, and what they must do, take and count.

mod builder;
mod machine;
mod meanings;
mod profile;
mod traps;
