//! Scenes made by the program: the same triangles, bit for bit, on every run. Each scene has a file of its own.

mod cornell;
mod empty;
mod frame;
mod mesh;
mod mirrors;
mod slabs;
mod slivers;
mod sphereflake;
mod terrain;
mod triangle;

use std::ops::RangeInclusive;

use messages::{Diagnostic, Report, did_you_mean};

use crate::model::Scene;

/// Wishes of a user for a generated scene; `None` leaves the scene's own default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GenerateOptions {
    /// Fineness; what it counts is said by [`Generator::level`].
    pub level: Option<u32>,
    /// Exact number of triangles, for scenes that can be cut to any number.
    pub triangles: Option<u32>,
    /// Width and height of the picture in pixels.
    pub size: (u32, u32),
}

impl Default for GenerateOptions {
    fn default() -> GenerateOptions {
        GenerateOptions { level: None, triangles: None, size: (320, 240) }
    }
}

/// A number that a generator takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// The quantity that it counts, such as "tiles along each edge of a wall".
    pub meaning: &'static str,
    /// The default.
    pub default: u32,
    /// The range of possible values.
    pub range: RangeInclusive<u32>,
}

impl Setting {
    const fn new(meaning: &'static str, default: u32, least: u32, most: u32) -> Option<Setting> {
        Some(Setting { meaning, default, range: RangeInclusive::new(least, most) })
    }
}

/// A scene that can be generated.
#[derive(Debug)]
pub struct Generator {
    /// The name that the user types.
    pub name: &'static str,
    /// One line on what it shows.
    pub description: &'static str,
    /// The option `level`, for scenes that have one.
    pub level: Option<Setting>,
    /// The option `triangles`, for scenes that have one.
    pub triangles: Option<Setting>,
    build: fn(&Sizes) -> Scene,
}

/// The options after defaults and checks.
struct Sizes {
    level: u32,
    triangles: u32,
    size: (u32, u32),
}

/// Every generated scene; the first five are the ones that figures are quoted for.
pub static SCENES: &[Generator] = &[
    Generator {
        name: "cornell",
        description: "a room with a red and a green wall, a mirror block and a glass block",
        level: Setting::new("tiles along each edge of a wall", 8, 1, 500),
        triangles: None,
        build: cornell::build,
    },
    Generator {
        name: "sphereflake",
        description: "a sphere that carries nine spheres that carry nine spheres, over a checkered ground",
        level: Setting::new("generations of spheres after the first", 2, 0, 5),
        triangles: None,
        build: sphereflake::build,
    },
    Generator {
        name: "slabs",
        description: "parallel tilted slabs of glass in front of a coloured checkerboard",
        level: Setting::new("squares along the board's width", 16, 1, 1000),
        triangles: None,
        build: slabs::build,
    },
    Generator {
        name: "mirrors",
        description: "two mirrors that face each other with coloured solids between them",
        level: Setting::new("times that the sphere's triangles are split in four", 2, 0, 8),
        triangles: None,
        build: mirrors::build,
    },
    Generator {
        name: "terrain",
        description: "a mountain landscape seen at a slant",
        level: None,
        triangles: Setting::new("triangles of the landscape", 60_000, 2, 10_000_000),
        build: terrain::build,
    },
    Generator {
        name: "slivers",
        description: "triangles up to a million times longer than wide, degenerate and duplicate ones",
        level: Setting::new("slivers of each width", 240, 1, 100_000),
        triangles: None,
        build: slivers::build,
    },
    Generator { name: "triangle", description: "one triangle", level: None, triangles: None, build: triangle::build },
    Generator { name: "empty", description: "nothing at all", level: None, triangles: None, build: empty::build },
];

/// The generated scene `name`. An unknown name, an option that the scene does not have, and a value out of its range
/// are errors.
pub fn scene(name: &str, options: &GenerateOptions) -> Result<Scene, Report> {
    let Some(generator) = SCENES.iter().find(|generator| generator.name == name) else {
        let names: Vec<&str> = SCENES.iter().map(|generator| generator.name).collect();
        let hint = did_you_mean(name, names.iter().copied())
            .unwrap_or_else(|| format!("the scenes are: {}", names.join(", ")));
        return Err(Diagnostic::error(format!("there is no generated scene `{name}`")).hint(hint).into());
    };
    let (width, height) = options.size;
    if width == 0 || height == 0 {
        return Err(Diagnostic::error(format!("a picture of {width} x {height} pixels has no pixels")).into());
    }
    let sizes = Sizes {
        level: setting(name, "level", options.level, &generator.level)?,
        triangles: setting(name, "triangles", options.triangles, &generator.triangles)?,
        size: options.size,
    };
    Ok((generator.build)(&sizes))
}

/// The value of one option: what the user asked for where that is possible, else the default.
fn setting(scene: &str, option: &str, asked: Option<u32>, known: &Option<Setting>) -> Result<u32, Report> {
    match (asked, known) {
        (None, known) => Ok(known.as_ref().map_or(0, |setting| setting.default)),
        (Some(_), None) => {
            let message = format!("the scene `{scene}` has no option `{option}`");
            let others: Vec<&str> =
                SCENES.iter().filter(|g| has_option(g, option)).map(|generator| generator.name).collect();
            Err(Diagnostic::error(message).hint(format!("scenes with this option: {}", others.join(", "))).into())
        }
        (Some(value), Some(setting)) if setting.range.contains(&value) => Ok(value),
        (Some(value), Some(setting)) => {
            let (least, most) = (setting.range.start(), setting.range.end());
            let message = format!("`{option}` of the scene `{scene}` cannot be {value}");
            Err(Diagnostic::error(message).hint(format!("{}: {least} to {most}", setting.meaning)).into())
        }
    }
}

fn has_option(generator: &Generator, option: &str) -> bool {
    if option == "level" { generator.level.is_some() } else { generator.triangles.is_some() }
}
