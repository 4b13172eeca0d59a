//! Scene files, kd tree, memory image, generators and the double-precision reference.

pub mod cadrage;
pub mod camera;
pub mod generate;
pub mod grid;
pub mod image;
pub mod info;
pub mod kdtree;
pub mod layout;
pub mod metrics;
pub mod model;
pub mod read;
pub mod reference;
pub mod vector;
pub mod write;
