//! Writers of `.dsc` and `.off` files (report 5.2), which read back as the same scene, bit for bit, and of the meshes of
//! other programs. What a format cannot say is told by [`losses`].

mod format;
mod losses;
mod obj;
mod ply;
mod stl;

use std::fmt;
use std::io::{self, Error, ErrorKind, Write};

pub use self::format::{MeshFormat, mesh};
pub use self::losses::{losses, losses_beside_description};
pub use self::obj::{mtl, obj};
pub use self::ply::ply;
pub use self::stl::stl;
use crate::model::{Scene, Triangle, Vec3};
use crate::read::mesh::GREY;

/// Writes the mesh of a scene as an ASCII `.off` file: header, counts, vertices, triangles.
///
/// Errors: what the writer says, and a coordinate that is not finite.
pub fn off(scene: &Scene, out: &mut impl Write) -> io::Result<()> {
    off_with(scene, |_| Ok(String::new()), out)
}

/// Writes the mesh of a scene with the colour of each triangle's material behind it, for a mesh without a `.dsc`; without colours where
/// all are the grey that such a mesh has anyway.
///
/// Errors: see [`off`].
pub fn off_coloured(scene: &Scene, out: &mut impl Write) -> io::Result<()> {
    let colour = |triangle: &Triangle| scene.materials[triangle.material as usize].colour;
    if scene.triangles.iter().all(|triangle| colour(triangle) == GREY.colour) {
        return off(scene, out);
    }
    let component = |x: f64| {
        let text = ShortestNumber::new(x)?.to_string();
        // A whole number would be one of 0 to 255.
        Ok(if text.contains(['.', 'e']) { text } else { text + ".0" })
    };
    let suffix = |triangle: &Triangle| {
        let components: io::Result<Vec<String>> = colour(triangle).into_iter().map(component).collect();
        Ok(format!(" {}", components?.join(" ")))
    };
    off_with(scene, suffix, out)
}

fn off_with(scene: &Scene, suffix: impl Fn(&Triangle) -> io::Result<String>, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "OFF\n{} {} 0", scene.vertices.len(), scene.triangles.len())?;
    for &vertex in &scene.vertices {
        writeln!(out, "{}", triple(vertex)?)?;
    }
    for triangle in &scene.triangles {
        let [a, b, c] = triangle.vertices;
        writeln!(out, "3 {a} {b} {c}{}", suffix(triangle)?)?;
    }
    Ok(())
}

/// Writes everything but the mesh as a `.dsc` file: size, materials, lights, the material of each triangle.
///
/// Errors: what the writer says, a value that is not finite, and a colour component above 1 (which would make the
/// whole file's colours read as 0..255).
pub fn dsc(scene: &Scene, out: &mut impl Write) -> io::Result<()> {
    let colours = scene.materials.iter().map(|m| m.colour).chain(scene.lights.iter().map(|l| l.colour));
    if let Some(colour) = colours.flatten().find(|&component| component > 1.0) {
        return Err(Error::new(ErrorKind::InvalidData, format!("the colour component {colour} is above 1")));
    }
    writeln!(out, "DSC\n{} {}", scene.size.0, scene.size.1)?;
    writeln!(out, "{} {}", scene.materials.len(), scene.lights.len())?;
    for material in &scene.materials {
        let (reflection, intensity) =
            (ShortestNumber::new(material.reflection)?, ShortestNumber::new(material.intensity)?);
        writeln!(
            out,
            "{} {reflection} {intensity} {}",
            triple(material.colour)?,
            ShortestNumber::new(material.index)?
        )?;
    }
    for light in &scene.lights {
        writeln!(out, "{} {}", triple(light.position)?, triple(light.colour)?)?;
    }
    writeln!(out, "{}", scene.triangles.len())?;
    for triangle in &scene.triangles {
        writeln!(out, "{}", triangle.material)?;
    }
    Ok(())
}

fn triple(v: Vec3) -> io::Result<String> {
    let [x, y, z] = v.map(ShortestNumber::new);
    Ok(format!("{} {} {}", x?, y?, z?))
}

/// A finite number, shown with the fewest digits that read back as the same bits.
struct ShortestNumber(f64);

impl ShortestNumber {
    fn new(value: f64) -> io::Result<ShortestNumber> {
        if value.is_finite() {
            Ok(ShortestNumber(value))
        } else {
            Err(Error::new(ErrorKind::InvalidData, format!("{value} cannot be written: not a finite number")))
        }
    }
}

impl fmt::Display for ShortestNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size != 0.0 && !(1e-5..1e16).contains(&size) { write!(f, "{:e}", self.0) } else { write!(f, "{}", self.0) }
    }
}
