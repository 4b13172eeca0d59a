//! Programs on the machine, and what they must do, take and count.

mod again;
mod ahead;
mod alike;
mod bus;
mod clocks;
mod engine;
mod kept;
mod machine;
mod meanings;
mod messages;
mod naive;
mod native;
mod profile;
mod protection;
mod ray;
mod replay;
mod saturation;
mod shadow;
mod stack;
mod stepper;
mod tails;
mod totals;
mod traps;

use programs::builder;
