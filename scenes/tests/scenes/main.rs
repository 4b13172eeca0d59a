//! Scene files as they are read, written and refused, generated scenes, and what the manual says of them.

mod generate_scenes;
mod manual_formats;
mod manual_layouts;
mod read_files;
mod read_mesh_damage;
mod read_mesh_variants;
mod read_meshes;
mod read_round_trip;
mod read_variants;
mod shown;
