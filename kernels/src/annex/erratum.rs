//! Errata of the report, each with what does as is printed: edits of the kernels, a tree or a reading of files with the mistake, or a figure.
//! `annex.toml` has them; drawing and comparing is the caller's.

use std::sync::Arc;

use messages::{Diagnostic, Source};
use scenes::kdtree::PrintedTree;
use scenes::model::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{errata, world};
use crate::function::{Function, unknown};

/// Something odd in the printed text.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrintedErratum {
    /// Short name, in results.
    pub id: String,
    /// Place in the report where it is printed.
    pub source: String,
    /// The printed text.
    pub printed: String,
    /// The correct text.
    pub correct: String,
    /// The consequence of the mistake.
    pub effect: String,
    /// The printed and the correct number, where the mistake is one of arithmetic.
    pub figure: Option<PrintedFigure>,
    /// The scene that shows the mistake; `None` for a number.
    pub scene: Option<String>,
    /// Place of the eye, for a mistake that a camera in the scene shows.
    pub eye: Option<[f64; 3]>,
    /// Point at which the eye looks.
    pub look: Option<[f64; 3]>,
    #[serde(default)]
    corrects: bool,
    #[serde(default)]
    edit: Vec<KernelEdit>,
    tree: Option<String>,
    reading: Option<PrintedReading>,
}

/// A number as it is printed, and the correct one.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PrintedFigure {
    /// As printed.
    pub printed: f64,
    /// The correct one.
    pub correct: f64,
    /// Unit of both.
    pub unit: String,
}

/// A part of a kernel of `report` and what stands instead.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KernelEdit {
    /// File below the kernels' folder.
    pub at: String,
    /// The part, which is there once.
    pub text: String,
    /// The other text.
    pub by: String,
}

/// A slip in how the report says that files are read (5.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PrintedReading {
    /// A light is at (x, y, y).
    LightPosition,
    /// Points take a line too many, so that faces begin with the second one; materials begin where they should.
    LineRanges,
}

impl PrintedReading {
    /// The scene as it is understood with the slip.
    ///
    /// For example the faces A, B, C with the materials 0, 1, 2 are the faces B and C with the materials 0 and 1. The point that is read off A's
    /// line belongs to no face.
    pub fn misread(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        match self {
            PrintedReading::LightPosition => {
                scene.lights.iter_mut().for_each(|light| light.position[2] = light.position[1])
            }
            PrintedReading::LineRanges => {
                let materials: Vec<_> = scene.triangles.iter().map(|triangle| triangle.material).collect();
                scene.triangles = scene.triangles.split_off(scene.triangles.len().min(1));
                scene.triangles.iter_mut().zip(materials).for_each(|(triangle, material)| triangle.material = material);
            }
        }
        scene
    }
}

/// Way to have what is printed.
#[derive(Clone, Debug)]
pub enum Reproduction {
    /// Kernels with the mistake, in place of those of `report`.
    Kernels(Vec<(Function, Arc<Source>)>),
    /// Kernels without the mistake, which those of `report` have.
    Corrected(Vec<(Function, Arc<Source>)>),
    /// A tree with the mistake.
    Tree(PrintedTree),
    /// A reading of files with the mistake.
    Reading(PrintedReading),
    /// The mistake is one of arithmetic.
    Figure(PrintedFigure),
}

impl Reproduction {
    /// Name in results.
    pub const fn name(&self) -> &'static str {
        match self {
            Reproduction::Kernels(_) | Reproduction::Corrected(_) => "kernels",
            Reproduction::Tree(_) => "tree",
            Reproduction::Reading(_) => "reading",
            Reproduction::Figure(_) => "figure",
        }
    }
}

impl PrintedErratum {
    /// Name on the command line: its short name with hyphens.
    pub fn name(&self) -> String {
        self.id.replace('_', "-")
    }

    /// The erratum of a name.
    ///
    /// # Errors
    /// A name that none has, with the nearest one.
    pub fn named(name: &str) -> Result<&'static PrintedErratum, Box<Diagnostic>> {
        let found = errata().iter().find(|erratum| erratum.name() == name || erratum.id == name);
        found.ok_or_else(|| unknown("erratum of the report", name, NAMES.iter().map(String::as_str)))
    }

    /// Edits of the kernels of `report`.
    pub fn edits(&self) -> &[KernelEdit] {
        &self.edit
    }

    /// Way to have what is printed.
    ///
    /// # Panics
    /// An erratum for which `annex.toml` has no way, and an edit whose text is not in its kernel exactly once; a test looks at all of them.
    pub fn reproduction(&self) -> Reproduction {
        let tree = self.tree.as_ref().map(|name| {
            let found = PrintedTree::ALL.into_iter().find(|slip| slip.name() == name);
            Reproduction::Tree(found.unwrap_or_else(|| panic!("annex.toml, {}: there is no tree `{name}`", self.id)))
        });
        let kernels = || match self.corrects {
            true => Reproduction::Corrected(self.kernels()),
            false => Reproduction::Kernels(self.kernels()),
        };
        let edited = (!self.edit.is_empty()).then(kernels);
        let figure = || self.figure.clone().map(Reproduction::Figure);
        let found = tree.or(edited).or(self.reading.map(Reproduction::Reading)).or_else(figure);
        found.unwrap_or_else(|| panic!("annex.toml: nothing shows `{}`", self.id))
    }

    /// The edited kernels, a file for each function. They go the way of files that a user names by `--kernel`.
    fn kernels(&self) -> Vec<(Function, Arc<Source>)> {
        let mut edited: Vec<(&str, String)> = Vec::new();
        for KernelEdit { at, text, by } in &self.edit {
            if !edited.iter().any(|(path, _)| path == at) {
                let file =
                    world::file(at).unwrap_or_else(|| panic!("annex.toml, {}: there is no file `{at}`", self.id));
                edited.push((at, file.1.to_owned()));
            }
            let (_, file) = edited.iter_mut().find(|(path, _)| path == at).expect("it has just been put there");
            // Once exactly: an edit in two places, or in none after a change of the kernel, would say something else than is printed.
            assert!(file.matches(text.as_str()).count() == 1, "annex.toml, {}: not once in {at}: {text}", self.id);
            *file = file.replacen(text.as_str(), by, 1);
        }
        let kernel = |(path, text): (&str, String)| {
            let stem = path.rsplit('/').next().and_then(|name| name.strip_suffix(".s"));
            let function = stem.and_then(|stem| stem.parse().ok()).expect("annex.toml edits files of functions");
            (function, Source::new(format!("kernels/asm/{path} ({})", self.name()), text))
        };
        edited.into_iter().map(kernel).collect()
    }
}

/// Names of all errata, for messages.
static NAMES: std::sync::LazyLock<Vec<String>> =
    std::sync::LazyLock::new(|| errata().iter().map(PrintedErratum::name).collect());

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_erratum_shows_what_is_printed() {
        let mut names = std::collections::BTreeSet::new();
        for erratum in errata() {
            assert!(names.insert(erratum.name()), "two errata are called {}", erratum.name());
            let is_figure = matches!(erratum.reproduction(), Reproduction::Figure(_));
            assert_eq!(is_figure, erratum.scene.is_none(), "{}: a picture has a scene, a figure has none", erratum.id);
            if let Reproduction::Figure(figure) = erratum.reproduction() {
                assert!(figure.printed != figure.correct, "{}", erratum.id);
            }
            assert!(std::ptr::eq(PrintedErratum::named(&erratum.name()).unwrap(), erratum));
        }
        assert!(names.len() >= 25, "{names:?}");
    }

    #[test]
    fn an_unknown_name_is_told_with_a_near_one() {
        let message = PrintedErratum::named("frist-hit").unwrap_err();
        assert_eq!(message.message, "`frist-hit` is no erratum of the report");
        assert_eq!(message.hint.as_deref(), Some("did you mean `first-hit`?"));
        assert!(
            PrintedErratum::named("xyzzy").unwrap_err().hint.unwrap().contains("known are intersection, distance, ")
        );
    }

    #[test]
    fn a_face_too_few_shifts_the_materials() {
        let triangle = |n: u32| scenes::model::Triangle { vertices: [n, n, n], material: n };
        let scene = Scene { triangles: vec![triangle(0), triangle(1), triangle(2)], ..world::scene() };
        let found: Vec<_> =
            PrintedReading::LineRanges.misread(&scene).triangles.iter().map(|t| (t.vertices[0], t.material)).collect();
        assert_eq!(found, [(1, 0), (2, 1)]);
        assert!(PrintedReading::LineRanges.misread(&Scene { triangles: Vec::new(), ..scene }).triangles.is_empty());
    }
}
