//! The formats that a scene's mesh can be written in, as files, and what each of them cannot say.

use std::collections::HashSet;
use std::fmt;
use std::io;
use std::str::FromStr;

use isa::diagnostic::{Diagnostic, Report, did_you_mean};

use super::{mtl, obj, off, ply, stl};
use crate::model::{Material, Scene};

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

    /// Its name, which is the extension of its files.
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
            let hint = match did_you_mean(name, names) {
                Some(known) => format!("did you mean `{known}`?"),
                None => format!("the formats are {}", names.join(", ")),
            };
            Box::new(Diagnostic::error(format!("`{name}` is no format of meshes that is written")).hint(hint))
        })
    }
}

/// The files of a scene's mesh: names made of `stem`, and octets. An `.obj` has its `.mtl` before it.
///
/// Errors: a coordinate that the format cannot hold.
pub fn mesh(scene: &Scene, format: MeshFormat, stem: &str) -> io::Result<Vec<(String, Vec<u8>)>> {
    let mut files = Vec::new();
    let mut octets = Vec::new();
    match format {
        MeshFormat::Off => off(scene, &mut octets)?,
        MeshFormat::Ply => ply(scene, &mut octets)?,
        MeshFormat::Stl => stl(scene, &mut octets)?,
        MeshFormat::Obj => {
            let library = format!("{stem}.mtl");
            obj(scene, &library, &mut octets)?;
            let mut materials = Vec::new();
            mtl(scene, &mut materials)?;
            files.push((library, materials));
        }
    }
    files.push((format!("{stem}.{format}"), octets));
    Ok(files)
}

/// What of a scene is not in its mesh when that is written in a format: warnings, none where nothing is lost.
pub fn losses(scene: &Scene, format: MeshFormat) -> Report {
    let used: HashSet<u32> = scene.triangles.iter().map(|triangle| triangle.material).collect();
    let used: Vec<&Material> =
        scene.materials.iter().zip(0..).filter(|(_, number)| used.contains(number)).map(|(m, _)| m).collect();
    let mut lost = Vec::new();
    if !scene.lights.is_empty() {
        lost.push("the lights");
    }
    let is_seen = |test: fn(&Material) -> bool| used.iter().any(|material| test(material));
    match format {
        MeshFormat::Off | MeshFormat::Stl if used.len() > 1 => lost.push("the materials"),
        MeshFormat::Off | MeshFormat::Stl if !used.is_empty() => lost.push("the material"),
        MeshFormat::Ply if is_seen(|m| m.reflection > 0.0 || m.transmission() > 0.0) => {
            lost.push("mirrors and glass");
        }
        MeshFormat::Obj if is_seen(|m| m.transmission() == 0.0 && m.reflection + m.intensity != 1.0) => {
            lost.push("the share of ambient light in some materials");
        }
        _ => {}
    }
    let is_single = |x: &f64| f64::from(*x as f32) == *x;
    if format == MeshFormat::Stl && !scene.vertices.iter().flatten().all(is_single) {
        lost.push("digits beyond single precision");
    }
    let Some((last, rest)) = lost.split_last() else { return Report::default() };
    let list = if rest.is_empty() { (*last).to_string() } else { format!("{} and {last}", rest.join(", ")) };
    let article = if format == MeshFormat::Ply { "a" } else { "an" };
    Diagnostic::warning(format!("{article} .{format} file does not hold {list}"))
        .hint("a .dsc beside it holds all but the mesh")
        .into()
}
