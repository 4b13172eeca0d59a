//! The writer of `.obj` meshes and their `.mtl` material libraries.

use std::collections::HashSet;
use std::io::{self, Write};

use super::{ShortestNumber, triple};
use crate::model::{Material, Scene, Vec3};

/// Writes the mesh of a scene as an `.obj` file whose materials are in the file `library`; see [`mtl`]. Materials without
/// one of the `names` get one.
///
/// Vertices, triangles and their order read back bit for bit.
///
/// Errors: what the writer says, and a coordinate that is not finite.
pub fn obj(scene: &Scene, names: &[String], library: &str, out: &mut impl Write) -> io::Result<()> {
    let names = all_named(scene, names);
    writeln!(out, "mtllib {library}")?;
    for &vertex in &scene.vertices {
        writeln!(out, "v {}", triple(vertex)?)?;
    }
    let mut material = None;
    for triangle in &scene.triangles {
        if material != Some(triangle.material) {
            material = Some(triangle.material);
            writeln!(out, "usemtl {}", names[triangle.material as usize])?;
        }
        let [a, b, c] = triangle.vertices.map(|vertex| u64::from(vertex) + 1);
        writeln!(out, "f {a} {b} {c}")?;
    }
    Ok(())
}

/// Writes the materials of a scene as a `.mtl` file, under the names that [`obj`] uses where it is given the same `names`.
///
/// - Transparent materials (kt above 0): Kd is the colour, d is kd / (1 - ks), Ni the index; the illumination model is 6.
/// - Others: Kd is the colour times kd; the model is 3 where ks is above 0, else 1.
/// - Ka is the colour, Ks is ks in all components.
///
/// They read back with the same ks, the same index where it shows, and the same light scattered; kd alone, against
/// ambient light, only where ks + kd is 1 or the material is transparent.
///
/// Errors: what the writer says, and a value that is not finite.
pub fn mtl(scene: &Scene, names: &[String], out: &mut impl Write) -> io::Result<()> {
    for (name, material) in all_named(scene, names).iter().zip(&scene.materials) {
        let coefficients = Coefficients::new(material);
        writeln!(out, "newmtl {}", name)?;
        writeln!(out, "Ka {}", triple(material.colour)?)?;
        writeln!(out, "Kd {}", triple(coefficients.diffuse)?)?;
        writeln!(out, "Ks {}", triple([material.reflection; 3])?)?;
        writeln!(out, "d {}", ShortestNumber::new(coefficients.opacity)?)?;
        if let Some(refraction) = coefficients.refraction {
            writeln!(out, "Ni {}", ShortestNumber::new(refraction)?)?;
        }
        writeln!(out, "illum {}", coefficients.model)?;
    }
    Ok(())
}

/// A name for each material: its own of `names`, or else `material_` and its number, with `_` behind where that is taken.
fn all_named(scene: &Scene, names: &[String]) -> Vec<String> {
    let mut taken: HashSet<String> = names.iter().cloned().collect();
    let named = |(number, own): (usize, Option<&String>)| match own.filter(|name| !name.is_empty()) {
        Some(name) => name.clone(),
        None => {
            let mut name = format!("material_{number}");
            while !taken.insert(name.clone()) {
                name.push('_');
            }
            name
        }
    };
    let own = names.iter().map(Some).chain(std::iter::repeat(None));
    own.take(scene.materials.len()).enumerate().map(named).collect()
}

/// A material in the coefficients of a library.
struct Coefficients {
    diffuse: Vec3,
    opacity: f64,
    refraction: Option<f64>,
    model: u32,
}

impl Coefficients {
    fn new(material: &Material) -> Coefficients {
        if material.transmission() > 0.0 {
            let opacity = material.intensity / (1.0 - material.reflection);
            Coefficients { diffuse: material.colour, opacity, refraction: Some(material.index), model: 6 }
        } else {
            let diffuse = material.colour.map(|component| component * material.intensity);
            let model = if material.reflection > 0.0 { 3 } else { 1 };
            Coefficients { diffuse, opacity: 1.0, refraction: None, model }
        }
    }
}
