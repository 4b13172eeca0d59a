//! The functions that a picture is made of. The files that serve them are listed by each set of kernels in [`crate::set`].

use std::str::FromStr;

use messages::{Diagnostic, did_you_mean};

use crate::build::SceneFeatures;

/// Processors that run a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RunsOn {
    Core,
    Main,
    Both,
}

/// Condition under which a function is part of a program.
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

macro_rules! functions {
    ($($(#[doc = $doc:literal])* $variant:ident $name:literal $place:ident $need:ident;)*) => {
        /// A function of the kernels.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Function { $($(#[doc = $doc])* $variant,)* }

        impl Function {
            /// All functions, in the order in which programs contain them.
            pub const ALL: &[Function] = &[$(Function::$variant),*];

            /// Name of the function, which is that of its `.func`.
            pub const fn name(self) -> &'static str {
                match self { $(Function::$variant => $name,)* }
            }

            const fn place(self) -> RunsOn {
                match self { $(Function::$variant => RunsOn::$place,)* }
            }

            const fn need(self) -> Need {
                match self { $(Function::$variant => Need::$need,)* }
            }
        }
    };
}

functions! {
    /// A work item: receives a pixel's ray, sends its colour.
    Pixel "pixel" Core Always;
    /// Walks the tree of a pixel's rays.
    RayTree "ray_tree" Core Tree;
    /// Contribution of a ray to its pixel.
    Contribution "contribution" Core Always;
    /// Follows a ray to its nearest hit.
    Trace "trace" Core Always;
    /// Tests the triangles of a packet.
    Packet "packet" Core Always;
    /// Ray against triangle.
    Triangle "triangle" Core Always;
    /// The packet after the current one.
    NextPacket "next_packet" Core Always;
    /// The plane through which the ray leaves a packet.
    ExitFace "exit_face" Core Always;
    /// Down the tree to a packet.
    Descend "descend" Both Always;
    /// The packet in which a secondary ray starts.
    OwnPacket "own_packet" Core Always;
    /// Point, normal and material of the hit.
    Surface "surface" Core Always;
    /// Unit normal of the nearest triangle.
    Normal "normal" Core Always;
    /// Unit vector in a direction.
    Unit "unit" Core Always;
    /// Square root.
    Sqrt "sqrt" Both Always;
    /// Whitted's local term.
    Shade "shade" Core Always;
    /// Decision to reflect a ray.
    Reflects "reflects" Core Tree;
    /// The reflected ray.
    Reflect "reflect" Core Tree;
    /// Decision to refract a ray.
    Refracts "refracts" Core Glass;
    /// The refracted ray.
    Refract "refract" Core Glass;
    /// Makes the camera rays and feeds the cores.
    Dispatch "dispatch" Main Always;
    /// A pixel between others that agree.
    Interpolate "interpolate" Main Interpolation;
    /// The first packet of a camera ray.
    FirstPacket "first_packet" Main Always;
}

impl Function {
    /// True for a function of the search: one that walks the tree, or intersects.
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
                RunsOn::Both => true,
                RunsOn::Core => !is_main,
                RunsOn::Main => is_main,
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
