//! Colours of faces in the styles of OFF and PLY, and the materials they stand for.

use std::collections::HashMap;

use messages::Diagnostic;

use super::words::counted;
use crate::model::{Material, Vec3};

/// Share of the light that a coloured surface scatters.
const INTENSITY: f64 = 0.9;

/// A face's colour as the file gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Spec {
    /// No colour.
    Default,
    /// A number in a colour map that is not part of the file.
    Index(f64),
    /// Red, green and blue (an opacity is read over), and whether all were written as whole numbers.
    Components(Vec3, Writing),
}

/// The scale in which the numbers of a colour were written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Writing {
    /// Without a decimal point.
    Whole,
    /// With one, or as binary floating-point numbers.
    Decimal,
}

/// The colours of the faces so far.
#[derive(Default)]
pub(super) struct FaceColours {
    /// One for each face from the first coloured one on; empty while there is none.
    specs: Vec<Spec>,
    first: usize,
    is_octet: bool,
    not_finite: usize,
}

impl FaceColours {
    /// Takes the colour of face `face`; faces come in order.
    pub(super) fn push(&mut self, face: usize, spec: Spec) {
        let spec = match spec {
            Spec::Index(index) if !index.is_finite() => self.without_value(),
            Spec::Components(rgb, _) if !rgb.iter().all(|component| component.is_finite()) => self.without_value(),
            spec => spec,
        };
        if self.specs.is_empty() {
            if spec == Spec::Default {
                return;
            }
            self.first = face;
        }
        if let Spec::Components(rgb, Writing::Whole) = spec {
            self.is_octet |= rgb.iter().any(|&component| component > 1.0);
        }
        self.specs.push(spec);
    }

    /// No colour, for one that has no value.
    fn without_value(&mut self) -> Spec {
        self.not_finite += 1;
        Spec::Default
    }

    /// One material for each different colour, and the material of each of `faces` faces; nothing when no face has
    /// a colour. Faces without one among others that have are grey.
    ///
    /// Whole numbers are 0..255 when any whole number of the file's colours is above 1, others are 0..1 unless the
    /// colour itself exceeds that.
    pub(super) fn into_materials(
        self,
        faces: usize,
        name: &str,
        warnings: &mut Vec<Diagnostic>,
    ) -> (Vec<Material>, Vec<u32>) {
        if self.not_finite > 0 {
            let subject = counted(self.not_finite, "face has a colour", "faces have colours");
            warnings.push(Diagnostic::warning(format!("{name}: {subject} without a finite value, not used")));
        }
        if self.specs.is_empty() {
            return (Vec::new(), Vec::new());
        }
        let mut numbers = HashMap::new();
        let mut materials = Vec::new();
        let mut beyond = 0;
        // Faces before the first coloured one are not in the list: where that is face 3, faces 0 to 2 stand before it without a colour.
        let before = std::iter::repeat_n(&Spec::Default, self.first);
        let of_faces = before
            .chain(&self.specs)
            .take(faces)
            .map(|&spec| {
                // Bring the components to 0..1: `1 0 0` is bright red, but nearly black where another face has `255 0 0`
                let colour = match spec {
                    Spec::Default => [2.0 / 3.0; 3],
                    Spec::Index(index) => map(index),
                    Spec::Components(rgb, Writing::Whole) if self.is_octet => rgb.map(|c| c / 255.0),
                    Spec::Components(rgb, Writing::Decimal) if rgb.iter().any(|&c| c > 1.0) => rgb.map(|c| c / 255.0),
                    Spec::Components(rgb, _) => rgb,
                };
                beyond += usize::from(colour.iter().any(|c| !(0.0..=1.0).contains(c)));
                // Equal colours share a material; 0.0 is added since a negative zero has other bits.
                let colour = colour.map(|c| c.clamp(0.0, 1.0) + 0.0);
                *numbers.entry(colour.map(f64::to_bits)).or_insert_with(|| {
                    materials.push(Material { colour, reflection: 0.0, intensity: INTENSITY, index: 0.0 });
                    materials.len() as u32 - 1
                })
            })
            .collect();
        if beyond > 0 {
            let subject = counted(beyond, "face has a colour", "faces have colours");
            warnings.push(Diagnostic::warning(format!("{name}: {subject} outside of 0 to 255, which are clamped")));
        }
        (materials, of_faces)
    }
}

/// The colour of a number: a map of our own, since files do not bring theirs. Neighbours differ clearly.
fn map(index: f64) -> Vec3 {
    let steps = [0.25, 0.5, 0.75, 1.0];
    let index = index.rem_euclid(256.0) as usize;
    // 37 is odd, so that all of 0..63 come before the first repetition.
    let mixed = index * 37 % 64;
    [steps[mixed % 4], steps[mixed / 4 % 4], steps[mixed / 16]]
}
