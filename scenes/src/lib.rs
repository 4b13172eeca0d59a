
pub mod cadrage;
pub mod camera;
pub mod generate;
pub mod grid;
pub mod kdtree;
pub mod model;
pub mod read;
pub mod vector;
pub mod write;
