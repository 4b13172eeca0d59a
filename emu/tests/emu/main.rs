//! Programs on the machine, and what they must do, take and count.

mod alike;
mod builder;
mod bus;
mod engine;
mod fast;
mod machine;
mod meanings;
mod messages;
mod profile;
mod ray;
mod replay;
mod saturation;
mod stack;
mod totals;
mod traps;
