//! The twins of the profile `report`: the functions as the report writes them, in scalar operations, each rounded to a word.

mod crossing;
mod scalar;
mod surface;
mod triangle;
mod walk;

pub use crossing::{ExitPoint, exit_face, first_packet};
pub use scalar::dot;
pub use surface::{Transmission, lit, normal, reflect, refract, sides, transmitted, unit};
pub use triangle::{barycentric, triangle};
pub use walk::{descend, next_packet, own_packet};
