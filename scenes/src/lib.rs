//! Scene files, kd tree, memory image, generators and the double-precision reference.

pub mod generate;
pub mod kdtree;
pub mod model;
pub mod read;
pub mod write;
