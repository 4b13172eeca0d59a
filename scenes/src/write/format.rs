//! The formats that a scene's mesh can be written in, as files.

use std::fmt;
use std::io;
use std::str::FromStr;

use messages::{Diagnostic, did_you_mean};

use super::{mtl, obj, off_coloured, ply, stl};
use crate::model::Scene;

/// A format of meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MeshFormat {
    /// Geomview's, in text.
    Off,
    /// Wavefront's, in text, with a `.mtl` of the materials.
    Obj,
    /// Stanford's, binary.
    Ply,
    /// 3D Systems', binary.
    Stl,
}

impl MeshFormat {
    /// All of them.
    pub const ALL: [MeshFormat; 4] = [MeshFormat::Off, MeshFormat::Obj, MeshFormat::Ply, MeshFormat::Stl];

    /// The format's name, which is the extension of its files.
    pub const fn name(self) -> &'static str {
        match self {
            MeshFormat::Off => "off",
            MeshFormat::Obj => "obj",
            MeshFormat::Ply => "ply",
            MeshFormat::Stl => "stl",
        }
    }
}

impl fmt::Display for MeshFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for MeshFormat {
    type Err = Box<Diagnostic>;

    fn from_str(name: &str) -> Result<MeshFormat, Box<Diagnostic>> {
        let lower = name.to_ascii_lowercase();
        MeshFormat::ALL.into_iter().find(|format| format.name() == lower).ok_or_else(|| {
            let names = MeshFormat::ALL.map(MeshFormat::name);
            let hint = did_you_mean(name, names).unwrap_or_else(|| format!("the formats are {}", names.join(", ")));
            Box::new(Diagnostic::error(format!("`{name}` is no format of meshes that is written")).hint(hint))
        })
    }
}

/// The files of a scene's mesh, for a mesh alone: names made of `stem`, and octets. An `.obj` has its `.mtl` before it.
///
/// Errors: a coordinate that the format cannot hold.
pub fn mesh(scene: &Scene, format: MeshFormat, stem: &str) -> io::Result<Vec<(String, Vec<u8>)>> {
    let mut files = Vec::new();
    let mut octets = Vec::new();
    match format {
        MeshFormat::Off => off_coloured(scene, &mut octets)?,
        MeshFormat::Ply => ply(scene, &mut octets)?,
        MeshFormat::Stl => stl(scene, &mut octets)?,
        MeshFormat::Obj => {
            let library = format!("{stem}.mtl");
            obj(scene, &[], &library, &mut octets)?;
            let mut materials = Vec::new();
            mtl(scene, &[], &mut materials)?;
            files.push((library, materials));
        }
    }
    files.push((format!("{stem}.{format}"), octets));
    Ok(files)
}
