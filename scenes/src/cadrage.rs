//! The report's *cadrage* (5.6): how many fraction bits each quantity has in a word. The formats are chosen from scene and word length, and
//! each can be set by the user. Where the scene lies on the grid is decided in [`crate::grid`].

use messages::{Diagnostic, Report, did_you_mean};
use serde::Serialize;

use crate::grid::Grid;
use crate::model::{Material, Scene, View};
use crate::vector::{nearest, shifted};

/// Fraction bits of each quantity in a signed register of `word` bits: value = raw / 2^bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Formats {
    /// Bits of a register, with the sign: 8 to 32.
    pub word: u32,
    /// Positions, relative to the grid's origin, in scene units; negative where a step of the grid is longer than a unit.
    pub position: i32,
    /// Components of directions and normals, in [-1, 1].
    pub direction: u32,
    /// Barycentric coordinates u and v, in [0, 1].
    pub barycentric: u32,
    /// Distances along a ray of unit length, in scene units.
    pub t: i32,
    /// Coefficients of materials, their colours, and weights of paths, in [0, 1].
    pub weight: u32,
    /// Intensities: light colours, ambient, background and what is summed up.
    pub colour: u32,
    /// Indices of refraction and their reciprocals, below 8.
    pub index: u32,
}

/// Fraction bits set by the user instead of the ones that would be chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overrides {
    /// See [`Formats::position`].
    pub position: Option<i32>,
    /// See [`Formats::direction`].
    pub direction: Option<i32>,
    /// See [`Formats::barycentric`].
    pub barycentric: Option<i32>,
    /// See [`Formats::t`].
    pub t: Option<i32>,
    /// See [`Formats::weight`].
    pub weight: Option<i32>,
    /// See [`Formats::colour`].
    pub colour: Option<i32>,
}

impl Overrides {
    /// The names by which quantities are set.
    pub const NAMES: [&'static str; 6] = ["pos", "dir", "bary", "t", "weight", "colour"];

    /// Takes one setting as the user writes it, such as `dir=24`.
    ///
    /// # Errors
    /// When it is not a name and a number, or the name is none of [`Overrides::NAMES`].
    pub fn set(&mut self, setting: &str) -> Result<(), Report> {
        let Some((name, bits)) = setting.split_once('=') else {
            return Err(Diagnostic::error(format!("`{setting}` sets no format"))
                .hint("write a quantity and its fraction bits, such as dir=24")
                .into());
        };
        let (name, bits) = (name.trim(), bits.trim());
        let place = match name {
            "pos" => &mut self.position,
            "dir" => &mut self.direction,
            "bary" => &mut self.barycentric,
            "t" => &mut self.t,
            "weight" => &mut self.weight,
            "colour" => &mut self.colour,
            _ => {
                let hint = did_you_mean(name, Overrides::NAMES)
                    .unwrap_or_else(|| format!("the quantities are {}", Overrides::NAMES.join(", ")));
                return Err(Diagnostic::error(format!("`{name}` is no quantity with a format")).hint(hint).into());
            }
        };
        let Ok(number) = bits.parse() else {
            return Err(Diagnostic::error(format!("`{bits}` is no number of fraction bits for `{name}`")).into());
        };
        *place = Some(number);
        Ok(())
    }
}

impl Formats {
    /// The formats for a scene on its grid.
    ///
    /// Directions, barycentrics and weights keep the most fraction bits that hold 1, which is word - 2. Distances have the grid's steps when
    /// the diagonal of the grid's span, and `margin` raw units on each side of it, is shorter than 2^(word-1) raw, else steps twice as long.
    /// Colours keep the most fraction bits that hold [`brightest`], at most word - 3.
    ///
    /// # Errors
    /// When a word cannot hold the brightest colour, or an override is outside its range: 0 to word - 2, or for t at most 64 away from the
    /// position's.
    pub fn new(scene: &Scene, view: &View, grid: &Grid, margin: u32, overrides: &Overrides) -> Result<Formats, Report> {
        let word = grid.word;
        let full = word - 2;
        let bits = |name: &str, chosen: u32, given: Option<i32>| match given {
            None => Ok(chosen),
            Some(bits) if (0..=full as i32).contains(&bits) => Ok(bits as u32),
            Some(bits) => {
                let refusal =
                    Diagnostic::error(format!("`{name}` cannot have {bits} fraction bits in a word of {word}"));
                Err(Report::from(refusal.hint(format!("1 has to fit beside the sign: 0 to {full} are possible"))))
            }
        };
        // No distance within the scene is longer than the diagonal of its box with the margin on each side.
        let diagonal = [0, 1, 2]
            .map(|axis| f64::from(grid.span[axis]) + 2.0 * f64::from(margin))
            .iter()
            .map(|side| side * side)
            .sum::<f64>();
        let is_short = diagonal.sqrt() + 2.0 < (1u64 << (word - 1)) as f64;
        // Half the resolution doubles the reach, and no diagonal comes to twice the largest word.
        let t = overrides.t.unwrap_or(grid.position - i32::from(!is_short));
        if t.abs_diff(grid.position) > 64 {
            return Err(Diagnostic::error(format!(
                "`t` cannot have {t} fraction bits where positions have {}",
                grid.position
            ))
            .hint("choose one within 64 bits of the position's")
            .into());
        }
        let brightest = brightest(scene, view);
        // A thousandth is kept free for what rounding adds on the way.
        let integer_bits = (2..word).find(|&n| brightest < (1u64 << n) as f64 * 0.999);
        let Some(integer_bits) = integer_bits else {
            return Err(Diagnostic::error(format!("colours up to {brightest:.3e} do not fit a word of {word} bits"))
                .hint("make the lights darker, or use a longer word with --word")
                .into());
        };
        Ok(Formats {
            word,
            position: grid.position,
            direction: bits("dir", full, overrides.direction)?,
            barycentric: bits("bary", full, overrides.barycentric)?,
            t,
            weight: bits("weight", full, overrides.weight)?,
            colour: bits("colour", word - 1 - integer_bits, overrides.colour)?,
            index: word - 4,
        })
    }

    /// Each quantity's name, as `--format` takes it, with its fraction bits.
    pub fn entries(&self) -> [(&'static str, i32); 6] {
        let [direction, barycentric, weight, colour] =
            [self.direction, self.barycentric, self.weight, self.colour].map(|bits| bits as i32);
        let [pos, dir, bary, t, w, c] = Overrides::NAMES;
        [(pos, self.position), (dir, direction), (bary, barycentric), (t, self.t), (w, weight), (c, colour)]
    }
}

/// Bound on the colours of a picture: what a surface lit by all lights at once sends out, seen through as many mirrors or panes as a path
/// can pass (each adding its own light, see [`View::bounces`]).
pub fn brightest(scene: &Scene, view: &View) -> f64 {
    // An upper bound: each level sees the brightest surface of the level below, wherever that stands.
    let background = view.background.into_iter().fold(0.0, f64::max);
    let lights = [0, 1, 2].map(|k| scene.lights.iter().map(|light| light.colour[k]).sum::<f64>());
    let own = |m: &Material| {
        [0, 1, 2].map(|k| m.colour[k] * (view.ambient + m.intensity * lights[k])).into_iter().fold(0.0, f64::max)
    };
    let brightest = |seen: f64| {
        let surface = |m: &Material| own(m) + (m.reflection + m.transmission()) * seen;
        scene.materials.iter().map(surface).fold(background, f64::max)
    };
    // After so many levels a sum that still grows has outgrown every word.
    (0..=view.bounces.min(200)).fold(0.0, |seen, _| brightest(seen))
}

/// The raw integer of a value with `fraction` bits: nearest, ties up; `None` when a word of `word` bits does not hold it.
pub fn raw(value: f64, fraction: u32, word: u32) -> Option<i32> {
    let raw = nearest(shifted(value, fraction as i32));
    let end = (1u64 << (word - 1)) as f64;
    (-end <= raw && raw < end).then_some(raw as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Light, Triangle};

    fn scene(material: Material, lights: &[f64]) -> Scene {
        Scene {
            name: "one triangle".into(),
            size: (8, 8),
            materials: vec![material],
            lights: lights.iter().map(|&x| Light { position: [0.0, 0.0, 0.5], colour: [x; 3] }).collect(),
            vertices: vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]],
            triangles: vec![Triangle { vertices: [0, 1, 2], material: 0 }],
        }
    }

    const MATT: Material = Material { colour: [1.0, 0.5, 0.25], reflection: 0.0, intensity: 0.9, index: 0.0 };

    fn formats(scene: &Scene, word: u32, settings: &[&str]) -> Result<Formats, Report> {
        let view = View::new(scene.size);
        let mut overrides = Overrides::default();
        for setting in settings {
            overrides.set(setting)?;
        }
        let grid = Grid::new(scene, &view, word, overrides.position)?;
        Formats::new(scene, &view, &grid, 1, &overrides)
    }

    #[test]
    fn unit_quantities_keep_all_bits_but_two() {
        for word in 8..=32 {
            let formats = formats(&scene(MATT, &[1.0]), word, &[]).unwrap();
            assert_eq!((formats.direction, formats.weight, formats.barycentric), (word - 2, word - 2, word - 2));
            assert_eq!((formats.colour, formats.index), (word - 3, word - 4));
        }
    }

    #[test]
    fn colours_get_the_integer_bits_that_the_lights_ask_for() {
        // 0.1 + 0.9 * n stays below 2^bits, and 2 bits are always there.
        for (lights, bits) in [(0, 2), (1, 2), (4, 2), (5, 3), (8, 3), (9, 4), (1000, 10)] {
            let formats = formats(&scene(MATT, &vec![1.0; lights]), 24, &[]).unwrap();
            assert_eq!(formats.colour, 23 - bits, "{lights} lights");
        }
        let error = formats(&scene(MATT, &[1e9]), 24, &[]).unwrap_err().render(false);
        assert!(error.contains("colours up to 9.000e8 do not fit a word of 24 bits"), "{error}");
    }

    #[test]
    fn mirrors_add_up_to_the_depth_of_the_ray_tree() {
        let mirror = Material { colour: [1.0; 3], reflection: 1.0, intensity: 0.0, index: 0.0 };
        let scene = scene(mirror, &[]);
        let mut view = View::new((8, 8));
        assert!((brightest(&scene, &view) - 0.6).abs() < 1e-12, "six levels of 0.1");
        view.background = [0.0, 7.0, 0.0];
        assert!((brightest(&scene, &view) - 7.5).abs() < 1e-12);
        view.bounces = 0;
        assert!((brightest(&scene, &view) - 7.0).abs() < 1e-12);
    }

    #[test]
    fn distances_have_the_grids_steps_when_the_diagonal_fits() {
        // Coordinates up to 2^29 raw: a diagonal of 2^30 sqrt 2. Coordinates up to 1.9 * 2^29: 1.9 times as much, more than 2^31.
        let mut scene = scene(MATT, &[]);
        let short = formats(&scene, 32, &[]).unwrap();
        assert_eq!((short.position, short.t), (29, 29));
        scene.vertices = scene.vertices.iter().map(|v| v.map(|x| 1.9 * x)).collect();
        let long = formats(&scene, 32, &[]).unwrap();
        assert_eq!((long.position, long.t), (29, 28));
    }

    #[test]
    fn settings_replace_what_would_be_chosen() {
        let scene = scene(MATT, &[1.0]);
        let all = formats(&scene, 32, &["pos=16", "dir=20", "bary=21", "t=12", "weight=22", "colour = 23"]).unwrap();
        let entries = [("pos", 16), ("dir", 20), ("bary", 21), ("t", 12), ("weight", 22), ("colour", 23)];
        assert_eq!(all.entries(), entries);
    }

    #[test]
    fn settings_that_cannot_be_are_refused_with_what_can() {
        let scene = scene(MATT, &[1.0]);
        for (setting, word, message) in [
            ("dir=31", 32, "0 to 30 are possible"),
            ("weight=-1", 32, "0 to 30 are possible"),
            ("colour=23", 24, "0 to 22 are possible"),
            ("pos=60", 32, "pos=29 or less"),
            ("pos=2147483647", 32, "pos=29 or less"),
            ("pos=-2147483648", 32, "choose a larger pos"),
            ("t=200", 32, "within 64 bits"),
            ("t=-2147483648", 32, "within 64 bits"),
            ("dri=3", 32, "did you mean `dir`?"),
            ("dir", 32, "such as dir=24"),
            ("dir=many", 32, "no number of fraction bits"),
        ] {
            let error = formats(&scene, word, &[setting]).unwrap_err().render(false);
            assert!(error.contains(message), "{setting}: {error}");
        }
    }

    #[test]
    fn raw_integers_are_rounded_up_at_ties_and_refused_outside_the_word() {
        assert_eq!(raw(0.5, 0, 8), Some(1));
        assert_eq!(raw(-0.5, 0, 8), Some(0));
        assert_eq!((raw(127.4, 0, 8), raw(127.5, 0, 8)), (Some(127), None));
        assert_eq!((raw(-128.5, 0, 8), raw(-129.0, 0, 8)), (Some(-128), None));
        assert_eq!((raw(1.0, 30, 32), raw(2.0, 30, 32), raw(f64::NAN, 30, 32)), (Some(1 << 30), None, None));
    }
}
