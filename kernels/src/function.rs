//! The functions that a picture is made of, and which file serves each of them in a profile.

use std::fmt;
use std::str::FromStr;

use isa::diagnostic::{Diagnostic, did_you_mean};

/// A set of kernels that differ only by which file serves a function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Profile {
    /// Vector and wide rows: decisions on exact products, one rounding at the end.
    #[default]
    Vector,
}

impl Profile {
    /// All profiles.
    pub const ALL: [Profile; 1] = [Profile::Vector];

    /// Name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Profile::Vector => "vector",
        }
    }
}

impl fmt::Display for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Profile {
    type Err = Box<Diagnostic>;

    fn from_str(name: &str) -> Result<Profile, Box<Diagnostic>> {
        Profile::ALL
            .into_iter()
            .find(|profile| profile.name() == name)
            .ok_or_else(|| unknown("profile", name, Profile::ALL.map(Profile::name)))
    }
}

/// Who runs a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Core,
    Main,
    Both,
}

/// When a function is part of a program at all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Need {
    Always,
    /// Some ray has children.
    Tree,
    /// Some material is transparent.
    Glass,
}

macro_rules! functions {
    ($($(#[doc = $doc:literal])* $variant:ident $name:literal $place:ident $need:ident { $($profile:ident $file:literal)* })*) => {
        /// A function of the kernels, in one file a profile.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Function { $($(#[doc = $doc])* $variant,)* }

        impl Function {
            /// All functions, in the order in which programs contain them.
            pub const ALL: &[Function] = &[$(Function::$variant),*];

            /// Its name, which is that of its `.func`.
            pub const fn name(self) -> &'static str {
                match self { $(Function::$variant => $name,)* }
            }

            const fn place(self) -> Place {
                match self { $(Function::$variant => Place::$place,)* }
            }

            const fn need(self) -> Need {
                match self { $(Function::$variant => Need::$need,)* }
            }

            /// Path (below the folder of the kernels) and text of the file that serves the function.
            pub const fn file(self, profile: Profile) -> (&'static str, &'static str) {
                match (self, profile) {
                    $($((Function::$variant, Profile::$profile) => ($file, include_str!(concat!("../asm/", $file))),)*)*
                }
            }
        }
    };
}

functions! {
    /// A work item: receives a pixel's ray, sends its colour.
    Pixel "pixel" Core Always { Vector "vector/pixel.s" }
    /// Walks the tree of a pixel's rays.
    RayTree "ray_tree" Core Tree { Vector "vector/ray_tree.s" }
    /// What a ray adds to its pixel.
    Contribution "contribution" Core Always { Vector "vector/contribution.s" }
    /// Follows a ray to its nearest hit.
    Trace "trace" Core Always { Vector "vector/trace.s" }
    /// Tests the triangles of a packet.
    Packet "packet" Core Always { Vector "vector/packet.s" }
    /// Ray against triangle.
    Triangle "triangle" Core Always { Vector "vector/triangle.s" }
    /// The packet after the current one.
    NextPacket "next_packet" Core Always { Vector "vector/next_packet.s" }
    /// The plane through which the ray leaves a packet.
    ExitFace "exit_face" Core Always { Vector "vector/exit_face.s" }
    /// Down the tree to a packet.
    Descend "descend" Both Always { Vector "vector/descend.s" }
    /// The packet in which a secondary ray starts.
    OwnPacket "own_packet" Core Always { Vector "vector/own_packet.s" }
    /// Point, normal and material of the hit.
    Surface "surface" Core Always { Vector "vector/surface.s" }
    /// Unit normal of the nearest triangle.
    Normal "normal" Core Always { Vector "vector/normal.s" }
    /// Unit vector in a direction.
    Unit "unit" Both Always { Vector "vector/unit.s" }
    /// Square root.
    Sqrt "sqrt" Both Always { Vector "vector/sqrt.s" }
    /// Whitted's local term.
    Shade "shade" Core Always { Vector "vector/shade.s" }
    /// Whether a ray is reflected.
    Reflects "reflects" Core Tree { Vector "vector/reflects.s" }
    /// The reflected ray.
    Reflect "reflect" Core Tree { Vector "vector/reflect.s" }
    /// Whether a ray is refracted.
    Refracts "refracts" Core Glass { Vector "vector/refracts.s" }
    /// The refracted ray.
    Refract "refract" Core Glass { Vector "vector/refract.s" }
    /// Makes the camera rays and feeds the cores.
    Dispatch "dispatch" Main Always { Vector "vector/dispatch.s" }
    /// The first packet of a camera ray.
    FirstPacket "first_packet" Main Always { Vector "vector/first_packet.s" }
}

impl Function {
    /// The functions of the program of a core, or of the main processor, for a scene with or without secondary rays and glass.
    pub fn of_program(is_main: bool, has_tree: bool, has_glass: bool) -> impl Iterator<Item = Function> {
        Function::ALL.iter().copied().filter(move |function| {
            let is_here = match function.place() {
                Place::Both => true,
                Place::Core => !is_main,
                Place::Main => is_main,
            };
            is_here
                && match function.need() {
                    Need::Always => true,
                    Need::Tree => has_tree,
                    Need::Glass => has_glass,
                }
        })
    }
}

impl FromStr for Function {
    type Err = Box<Diagnostic>;

    fn from_str(name: &str) -> Result<Function, Box<Diagnostic>> {
        Function::ALL
            .iter()
            .copied()
            .find(|function| function.name() == name)
            .ok_or_else(|| unknown("kernel function", name, Function::ALL.iter().map(|function| function.name())))
    }
}

/// The error for a name that is none of `known`.
fn unknown(what: &str, name: &str, known: impl IntoIterator<Item = &'static str>) -> Box<Diagnostic> {
    let known: Vec<&str> = known.into_iter().collect();
    let hint = match did_you_mean(name, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("known are {}", known.join(", ")),
    };
    Box::new(Diagnostic::error(format!("`{name}` is no {what}")).hint(hint))
}
