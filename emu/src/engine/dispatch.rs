//! The one place where work is compiled for each arithmetic and for each observer, and the right one is taken.

use isa::number::Nearest32;

use crate::profile::{Observer, ProfileLevel, Profiler, Unobserved};
use crate::semantics::{Watch, Watching};

/// Work that is the same on every arithmetic and for every observer, but compiled for each of them.
pub trait Task {
    /// Result of the work.
    type Result;

    /// Does the work.
    fn run<T: Watch + Clone + Send, O: Observer + Send>(self, arithmetic: &T) -> Self::Result;
}

/// Does work on the default arithmetic, or on the one given, with a profile or without.
pub fn dispatch<W: Task>(watching: Option<Watching>, profile: ProfileLevel, task: W) -> W::Result {
    match (watching, profile != ProfileLevel::None) {
        (None, true) => task.run::<_, Profiler>(&Nearest32),
        (None, false) => task.run::<_, Unobserved>(&Nearest32),
        (Some(watching), true) => task.run::<_, Profiler>(&watching),
        (Some(watching), false) => task.run::<_, Unobserved>(&watching),
    }
}
