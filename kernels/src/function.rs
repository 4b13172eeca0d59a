//! The functions that a picture is made of, and which file serves each of them in a profile.

use std::fmt;
use std::str::FromStr;

use messages::{Diagnostic, did_you_mean};
use scenes::layout::Layout;

use crate::prelude::Walk;

use crate::build::SceneFeatures;
use crate::skip::Skip;

/// A set of kernels that differ only by which file serves a function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum KernelSet {
    /// Scalar operations laid out as the formulas and pseudo codes of the report, each rounded to a word: what its annexes count. Its
    /// decisions are not exact.
    Report,
    /// Vector and wide rows: decisions on exact products, one rounding at the end.
    #[default]
    Vector,
    /// The rows of the ray unit where they serve, else as `Vector`: exact at any word length, and few instructions.
    Ray,
}

impl KernelSet {
    /// All profiles.
    pub const ALL: [KernelSet; 3] = [KernelSet::Report, KernelSet::Vector, KernelSet::Ray];

    /// Name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            KernelSet::Report => "report",
            KernelSet::Vector => "vector",
            KernelSet::Ray => "ray",
        }
    }

    /// The layout of memory that goes with it unless the user chooses another.
    pub const fn layout(self) -> Layout {
        match self {
            KernelSet::Report => Layout::Report,
            KernelSet::Vector | KernelSet::Ray => Layout::Wide,
        }
    }

    /// How its walk through the tree remembers far sides, when the user has replaced some functions.
    pub fn walk(self, replaced: &[Function]) -> Walk {
        match self {
            KernelSet::Report => Walk::Restart,
            _ if Team::of(Function::Descend, self, replaced).is_some() => Walk::Planes,
            _ => Walk::Boxes,
        }
    }
}

impl KernelSet {
    /// Whether the profile's kernels know how to leave something out. Those of the report test every triangle of a packet, whole, and
    /// search as it is printed.
    pub const fn knows(self, skip: Skip) -> bool {
        match self {
            KernelSet::Report => {
                matches!(skip, Skip::Features | Skip::Weightless | Skip::Unlit | Skip::AnyHit | Skip::Beyond)
            }
            KernelSet::Vector | KernelSet::Ray => true,
        }
    }
}

impl fmt::Display for KernelSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for KernelSet {
    type Err = Box<Diagnostic>;

    fn from_str(name: &str) -> Result<KernelSet, Box<Diagnostic>> {
        KernelSet::ALL
            .into_iter()
            .find(|profile| profile.name() == name)
            .ok_or_else(|| unknown("profile", name, KernelSet::ALL.map(KernelSet::name)))
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
    /// Pixels between others that agree are interpolated.
    Interpolation,
}

/// Path (below the folder of the kernels) and text of a file.
pub type KernelFile = (&'static str, &'static str);

macro_rules! file {
    ($file:literal) => {
        ($file, include_str!(concat!("../asm/", $file)))
    };
}

/// Functions that a profile serves by files made for each other: between them they agree on more registers than `registers.inc` says.
///
/// A file of the user's own knows nothing of that, so when it replaces one function the others are served each by itself.
struct Team {
    profile: KernelSet,
    /// The functions that it serves, with their files; `None` where another one's file does their work.
    members: &'static [(Function, Option<KernelFile>)],
}

/// The teams of all profiles.
const TEAMS: &[Team] = &[
    Team {
        profile: KernelSet::Ray,
        members: &[(Function::Packet, Some(file!("ray/packet.s"))), (Function::Triangle, None)],
    },
    Team {
        profile: KernelSet::Ray,
        members: &[
            (Function::Trace, Some(file!("ray/trace.s"))),
            (Function::NextPacket, Some(file!("ray/next_packet.s"))),
            (Function::ExitFace, None),
            (Function::Descend, Some(file!("ray/descend.s"))),
            (Function::OwnPacket, Some(file!("ray/own_packet.s"))),
            (Function::FirstPacket, Some(file!("ray/first_packet.s"))),
        ],
    },
];

impl Team {
    /// The team that serves a function, when it is complete.
    fn of(function: Function, profile: KernelSet, replaced: &[Function]) -> Option<&'static Team> {
        let has = |team: &Team, function| team.members.iter().any(|&(member, _)| member == function);
        TEAMS.iter().find(|team| {
            team.profile == profile && has(team, function) && !replaced.iter().any(|&other| has(team, other))
        })
    }
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

            /// The file that serves the function by itself, with the registers that `registers.inc` gives it.
            const fn own_file(self, profile: KernelSet) -> KernelFile {
                match (self, profile) {
                    $($((Function::$variant, KernelSet::$profile) => file!($file),)*)*
                    _ => self.own_file(KernelSet::Vector),
                }
            }
        }
    };
}

functions! {
    /// A work item: receives a pixel's ray, sends its colour.
    Pixel "pixel" Core Always { Report "report/pixel.s" Vector "vector/pixel.s" }
    /// Walks the tree of a pixel's rays.
    RayTree "ray_tree" Core Tree { Report "report/ray_tree.s" Vector "vector/ray_tree.s" }
    /// What a ray adds to its pixel.
    Contribution "contribution" Core Always { Report "report/contribution.s" Vector "vector/contribution.s" }
    /// Follows a ray to its nearest hit.
    Trace "trace" Core Always { Report "report/trace.s" Vector "vector/trace.s" }
    /// Tests the triangles of a packet.
    Packet "packet" Core Always { Report "report/packet.s" Vector "vector/packet.s" }
    /// Ray against triangle.
    Triangle "triangle" Core Always { Report "report/triangle.s" Vector "vector/triangle.s" Ray "ray/triangle.s" }
    /// The packet after the current one.
    NextPacket "next_packet" Core Always { Report "report/next_packet.s" Vector "vector/next_packet.s" }
    /// The plane through which the ray leaves a packet.
    ExitFace "exit_face" Core Always { Report "report/exit_face.s" Vector "vector/exit_face.s" Ray "ray/exit_face.s" }
    /// Down the tree to a packet.
    Descend "descend" Both Always { Report "report/descend.s" Vector "vector/descend.s" }
    /// The packet in which a secondary ray starts.
    OwnPacket "own_packet" Core Always { Report "report/own_packet.s" Vector "vector/own_packet.s" }
    /// Point, normal and material of the hit.
    Surface "surface" Core Always { Report "report/surface.s" Vector "vector/surface.s" }
    /// Unit normal of the nearest triangle.
    Normal "normal" Core Always { Report "report/normal.s" Vector "vector/normal.s" }
    /// Unit vector in a direction.
    Unit "unit" Both Always { Report "report/unit.s" Vector "vector/unit.s" }
    /// Square root.
    Sqrt "sqrt" Both Always { Report "report/sqrt.s" Vector "vector/sqrt.s" }
    /// Whitted's local term.
    Shade "shade" Core Always { Report "report/shade.s" Vector "vector/shade.s" }
    /// Whether a ray is reflected.
    Reflects "reflects" Core Tree { Report "report/reflects.s" Vector "vector/reflects.s" }
    /// The reflected ray.
    Reflect "reflect" Core Tree { Report "report/reflect.s" Vector "vector/reflect.s" }
    /// Whether a ray is refracted.
    Refracts "refracts" Core Glass { Report "report/refracts.s" Vector "vector/refracts.s" }
    /// The refracted ray.
    Refract "refract" Core Glass { Report "report/refract.s" Vector "vector/refract.s" }
    /// Makes the camera rays and feeds the cores.
    Dispatch "dispatch" Main Always { Vector "vector/dispatch.s" }
    /// A pixel between others that agree.
    Interpolate "interpolate" Main Interpolation { Vector "vector/interpolate.s" }
    /// The first packet of a camera ray.
    FirstPacket "first_packet" Main Always { Report "report/first_packet.s" Vector "vector/first_packet.s" }
}

impl Function {
    /// The file that serves the function in a profile, given which functions the user has replaced; `None` when another function's file does
    /// its work.
    pub fn file(self, profile: KernelSet, replaced: &[Function]) -> Option<KernelFile> {
        match Team::of(self, profile, replaced) {
            Some(team) => team.members.iter().find(|&&(member, _)| member == self).and_then(|&(_, file)| file),
            None => Some(self.own_file(profile)),
        }
    }

    /// Whether the function belongs to the search: it walks the tree, or it intersects.
    pub const fn is_search(self) -> bool {
        use Function::{Descend, ExitFace, FirstPacket, NextPacket, OwnPacket, Packet, Trace, Triangle};
        matches!(self, FirstPacket | OwnPacket | NextPacket | Descend | ExitFace | Trace | Packet | Triangle)
    }

    /// The functions of the program of a core, or of the main processor, for what a scene needs.
    pub fn of_program(is_main: bool, features: &SceneFeatures) -> impl Iterator<Item = Function> {
        let (has_tree, has_glass) = (features.has_tree(), features.has_glass());
        let interpolates = features.agreement.is_some();
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
                    Need::Interpolation => interpolates,
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
pub(crate) fn unknown(what: &str, name: &str, known: impl IntoIterator<Item = &'static str>) -> Box<Diagnostic> {
    let known: Vec<&str> = known.into_iter().collect();
    let hint = did_you_mean(name, known.iter().copied()).unwrap_or_else(|| format!("known are {}", known.join(", ")));
    Box::new(Diagnostic::error(format!("`{name}` is no {what}")).hint(hint))
}
