//! Parts that a program leaves out because its scene, or a ray, does not need them: each skip has a name and can be switched off, to see what it
//! saves. None changes a picture.

use std::fmt;
use std::str::FromStr;

use messages::Diagnostic;

use crate::function::unknown;
use crate::set::KernelSet;

macro_rules! skips {
    ($($(#[doc = $doc:literal])* $variant:ident $name:literal $constant:literal;)*) => {
        /// Something that is left out where it changes nothing.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Skip { $($(#[doc = $doc])* $variant,)* }

        impl Skip {
            /// All skips, in the order in which they are listed.
            pub const ALL: &[Skip] = &[$(Skip::$variant),*];

            /// Name on the command line.
            pub const fn name(self) -> &'static str {
                match self { $(Skip::$variant => $name,)* }
            }

            /// Name of the constant that is 1 in a program that skips, else 0.
            pub const fn constant(self) -> &'static str {
                match self { $(Skip::$variant => $constant,)* }
            }

            /// Description of what is left out, in one line.
            pub const fn description(self) -> &'static str {
                match self { $(Skip::$variant => concat!($($doc),*).trim_ascii(),)* }
            }
        }
    };
}

skips! {
    /// Code and buffer for mirrors and glass that the scene does not have.
    Features "features" "SKIP_FEATURES";
    /// Rays of weight 0: the reflected ray of what does not reflect, the refracted one of what is not transparent.
    Weightless "weightless" "SKIP_WEIGHTLESS";
    /// Shadow rays to lights behind the surface.
    Unlit "unlit" "SKIP_UNLIT";
    /// The rest of a shadow ray's search once anything is in its way.
    AnyHit "any-hit" "SKIP_ANY_HIT";
    /// The search of camera rays that miss the scene's box.
    Missed "missed" "SKIP_MISSED";
    /// Packets that begin beyond the nearest hit.
    Beyond "beyond" "SKIP_BEYOND";
    /// Packets without triangles.
    Empty "empty" "SKIP_EMPTY";
    /// Triangles that the ray has met in an earlier packet.
    Tested "tested" "SKIP_TESTED";
    /// Octets of a triangle that are needed only when it is hit.
    Octets "octets" "SKIP_OCTETS";
}

impl fmt::Display for Skip {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Skip {
    type Err = Box<Diagnostic>;

    fn from_str(name: &str) -> Result<Skip, Box<Diagnostic>> {
        Skip::ALL
            .iter()
            .copied()
            .find(|skip| skip.name() == name)
            .ok_or_else(|| unknown("skip", name, Skip::ALL.iter().map(|skip| skip.name())))
    }
}

/// Set of skips that a program has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Skips(u32);

impl Skips {
    /// Every one of them.
    pub const ALL: Skips = Skips((1 << Skip::ALL.len()) - 1);

    /// None of them.
    pub const NONE: Skips = Skips(0);

    /// The set with `skip` added.
    #[must_use]
    pub const fn with(self, skip: Skip) -> Skips {
        Skips(self.0 | 1 << skip as u32)
    }

    /// The set with `skip` taken out.
    #[must_use]
    pub const fn without(self, skip: Skip) -> Skips {
        Skips(self.0 & !(1 << skip as u32))
    }

    /// Skips of the set that a profile's kernels know.
    #[must_use]
    pub fn known_to(self, profile: KernelSet) -> Skips {
        // Unknown skips go, rather than fail: a user may switch all of them for every profile alike.
        Skip::ALL.iter().filter(|&&skip| !profile.knows(skip)).fold(self, |skips, &skip| skips.without(skip))
    }

    /// The set contains `skip`.
    pub const fn has(self, skip: Skip) -> bool {
        self.0 >> skip as u32 & 1 == 1
    }
}

impl Default for Skips {
    fn default() -> Skips {
        Skips::ALL
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skips_are_switched_one_by_one() {
        for &skip in Skip::ALL {
            assert_eq!(skip.name().parse(), Ok(skip));
            assert!(Skips::ALL.has(skip) && !Skips::NONE.has(skip));
            assert_eq!(Skips::NONE.with(skip).without(skip), Skips::NONE);
            let others = Skips::ALL.without(skip);
            assert!(!others.has(skip) && Skip::ALL.iter().all(|&other| other == skip || others.has(other)));
            assert!(!skip.description().is_empty());
        }
        let error = "anyhit".parse::<Skip>().unwrap_err();
        assert_eq!(error.hint.as_deref(), Some("did you mean `any-hit`?"));
    }
}
