//! Trials that fixed-point ray tracers fail: rays at vertices, edges and planes that divide a tree, triangles that are hard to decide, secondary rays, and
//! arithmetic, each checked against exact integers or a model. A trial depends on its number alone.
//!
//! Trials come by the hundred million, so the compiler optimises this crate fully, which it does not for commands and their texts.

pub mod closed;
pub mod decisions;
mod mesh;
pub mod numbers;
pub mod series;
pub mod surfaces;
pub mod tally;
mod target;
