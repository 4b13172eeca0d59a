//! The scene that a user names: a file, or a scene that is generated.

use std::path::Path;

use messages::{Diagnostic, did_you_mean};
use scenes::generate::{self, SCENES};
use scenes::read::{self, Loaded};

use messages::Report;

use crate::files;

/// Reads or generates a scene. `name` is a file (a `.dsc` with its mesh beside it or named by `mesh`, or a mesh alone);
/// where there is no such file, it may be the name of a generated scene, which then has `size` pixels.
///
/// # Errors
/// Mistakes in the files of the scene, or a name that is neither a file nor a generated scene.
pub fn scene(name: &str, mesh: Option<&Path>, size: Option<(u32, u32)>) -> Result<Loaded, Report> {
    let path = Path::new(name);
    if path.exists() || mesh.is_some() || name == files::STANDARD || !is_plain(name) {
        return read::load(path, mesh);
    }
    if SCENES.iter().any(|generator| generator.name == name) {
        let defaults = generate::GenerateOptions::default();
        let scene =
            generate::scene(name, &generate::GenerateOptions { size: size.unwrap_or(defaults.size), ..defaults })?;
        return Ok(Loaded::from(scene));
    }
    let names = || SCENES.iter().map(|generator| generator.name);
    let near = read::load(path, None).err().and_then(|report| report.0.into_iter().next()?.hint);
    let hint = match (did_you_mean(name, names()), near) {
        (Some(hint), _) => hint,
        (None, Some(file)) => file,
        (None, None) => format!("the generated scenes are {}", names().collect::<Vec<_>>().join(", ")),
    };
    Err(Diagnostic::error(format!("`{name}` is neither a file nor a generated scene")).hint(hint).into())
}

/// True of a name that a generated scene could have.
fn is_plain(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '-' || letter == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_without_a_file_is_a_generated_scene() {
        let loaded = scene("triangle", None, Some((8, 4))).unwrap();
        assert_eq!((loaded.scene.name.as_str(), loaded.scene.size), ("triangle", (8, 4)));
    }

    #[test]
    fn what_is_neither_is_refused_with_what_is_near() {
        for (name, message) in [
            ("cornel", "did you mean `cornell`?"),
            ("xyzzy", "the generated scenes are cornell, "),
            ("no/such.dsc", "there is no file no/such.dsc"),
        ] {
            let error = scene(name, None, None).unwrap_err().render(false);
            assert!(error.contains(message), "{name}: {error}");
        }
    }
}
