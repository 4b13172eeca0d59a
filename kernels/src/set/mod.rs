//! The sets of kernels: one file a set, with an answer to each question that a set has to answer, and one line here. The functions that a
//! picture is made of are listed in [`crate::function`].

mod buffered;
mod packet;
mod prefetched;
mod ray;
mod report;
mod vector;

use std::fmt;
use std::str::FromStr;

use messages::Diagnostic;
use scenes::kdtree::{BuildMethod, Depth};
use scenes::layout::Layout;

use crate::function::{Function, KernelFile, unknown};
use crate::prelude::WalkMemory;
use crate::skip::Skip;

macro_rules! file {
    ($file:literal) => {
        ($file, include_str!(concat!("../../asm/", $file)))
    };
}
use file;

/// Answers of a set of kernels to all that programs, twins and commands ask of it. There are no defaults: a new set answers each question.
pub(crate) struct SetAnswers {
    /// Name on the command line.
    pub name: &'static str,
    /// Layout of memory that goes with it unless the user chooses another.
    pub layout: Layout,
    /// Levels and building of the kd tree that goes with it unless the user chooses others.
    pub tree: (Depth, BuildMethod),
    /// Set that serves the functions for which this one has no file; `None` when it has all of them.
    pub base: Option<KernelSet>,
    /// Set that it is compared with, whose work it does in another way; `None` for the first one.
    pub compared_with: Option<KernelSet>,
    /// Files of the functions that it serves by themselves, with the registers that `registers.inc` gives them.
    pub files: &'static [(Function, KernelFile)],
    /// Functions that it serves by files made for each other.
    pub teams: &'static [Team],
    /// Way in which its walk remembers far sides, when the user has replaced none of the functions that walk.
    pub walk: WalkMemory,
    /// Way in which its walk remembers far sides, when the user has replaced one of them.
    pub walk_alone: WalkMemory,
    /// Block loads may go on beside computing: its programs wait for one where they use the data.
    pub loads_ahead: bool,
    /// Exactness of its decisions.
    pub decisions: Decisions,
    /// Formulas for what follows a hit.
    pub formulas: Formulas,
    /// Skips that its kernels know.
    pub skips: &'static [Skip],
    /// Refusal of the layout `packed`, the reason; `None` where its kernels read it.
    pub refuses_packed: Option<&'static str>,
}

/// Exactness with which a set decides between hit and miss.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decisions {
    /// Each operation is rounded to a word, and all triangles of a packet are tested; the first of equal hits stays.
    Rounded,
    /// Products have twice the bits of a word; exact as long as these hold them.
    Wide,
    /// Exact at any length of a word.
    Exact,
}

/// Formulas for points, normals and secondary rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Formulas {
    /// As the report prints them, in scalar operations.
    Printed,
    /// In vector operations, each rounded once.
    Vector,
}

/// Functions that a set serves by files made for each other: between them they agree on more registers than `registers.inc` says.
///
/// A file of the user's own knows nothing of that, so when it replaces one function the others are served each by itself.
pub(crate) struct Team {
    /// The functions that it serves, with their files; `None` where another one's file does their work.
    pub members: &'static [(Function, Option<KernelFile>)],
}

impl Team {
    fn has(&self, function: Function) -> bool {
        self.members.iter().any(|&(member, _)| member == function)
    }
}

macro_rules! kernel_sets {
    ($($(#[$attribute:meta])* $variant:ident $file:ident;)*) => {
        /// A set of kernels, by which each function has a file.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub enum KernelSet { $($(#[$attribute])* $variant,)* }

        impl KernelSet {
            /// All sets of kernels.
            pub const ALL: &[KernelSet] = &[$(KernelSet::$variant),*];

            pub(crate) const fn answers(self) -> &'static SetAnswers {
                match self { $(KernelSet::$variant => &$file::SET,)* }
            }
        }
    };
}

kernel_sets! {
    /// Scalar operations laid out as the formulas and pseudo codes of the report, each rounded to a word: what its annexes count. Its
    /// decisions are not exact.
    Report report;
    /// Vector and wide rows: decisions on exact products, one rounding at the end.
    #[default]
    Vector vector;
    /// The rows of the ray unit where they serve, else as `Vector`: exact at any word length, and few instructions.
    Ray ray;
    /// Rows that meet whole packets and walk down several levels of the tree, else as `Ray`: the same decisions, and fewer transfers.
    Packet packet;
    /// As `Report`, but the triangles of a packet come to the buffer before they are tested, up to 512 at once: its section 6.2.
    Buffered buffered;
    /// As `Report`, with two such buffers: the next triangle comes while one is tested.
    Prefetched prefetched;
}

impl KernelSet {
    /// Name on the command line.
    pub const fn name(self) -> &'static str {
        self.answers().name
    }

    /// Layout of memory that goes with the set unless the user chooses another.
    pub const fn layout(self) -> Layout {
        self.answers().layout
    }

    /// Reason for which the set's kernels cannot read a layout; `None` where they can.
    pub const fn refusal(self, layout: Layout) -> Option<&'static str> {
        match layout {
            Layout::Packed => self.answers().refuses_packed,
            Layout::Report | Layout::Wide | Layout::Packet => None,
        }
    }

    /// The first set that is made for a layout.
    pub fn of_layout(layout: Layout) -> KernelSet {
        let mut sets = KernelSet::ALL.iter().copied();
        sets.find(|set| set.layout() == layout).unwrap_or(KernelSet::Vector)
    }

    /// Levels of the kd tree that goes with the set unless the user chooses others.
    pub const fn kd_depth(self) -> Depth {
        self.answers().tree.0
    }

    /// Way to build the kd tree that goes with the set unless the user chooses another.
    pub const fn kd_method(self) -> BuildMethod {
        self.answers().tree.1
    }

    /// The set that it is compared with; `None` for the first one.
    pub const fn compared_with(self) -> Option<KernelSet> {
        self.answers().compared_with
    }

    /// Block loads may go on beside computing: the set's programs wait for one where they use the data.
    pub const fn loads_ahead(self) -> bool {
        self.answers().loads_ahead
    }

    /// Exactness of the set's decisions.
    pub const fn decisions(self) -> Decisions {
        self.answers().decisions
    }

    /// Formulas for what follows a hit.
    pub const fn formulas(self) -> Formulas {
        self.answers().formulas
    }

    /// Way in which the set's walk through the tree remembers far sides, when the user has replaced some functions.
    pub fn walk(self, replaced: &[Function]) -> WalkMemory {
        let SetAnswers { walk, walk_alone, .. } = *self.answers();
        // Without replacements the set has what it was made for. With some, its own walk stays only if the whole team does:
        // half of a team would leave notes on the way down that the other half does not read.
        if replaced.is_empty() || self.team(Function::Descend, replaced).is_some() { walk } else { walk_alone }
    }

    /// The set's kernels know how to leave something out.
    pub fn knows(self, skip: Skip) -> bool {
        self.answers().skips.contains(&skip)
    }

    /// The team that serves a function, when it is complete.
    fn team(self, function: Function, replaced: &[Function]) -> Option<&'static Team> {
        // A replaced member breaks up the team, since a user's file knows nothing of the registers that the team shares.
        let is_complete = |team: &Team| !replaced.iter().any(|&other| team.has(other));
        self.answers().teams.iter().find(|team| team.has(function) && is_complete(team))
    }

    /// The file that serves a function, given which functions the user has replaced; `None` when another function's file does its work.
    pub fn file(self, function: Function, replaced: &[Function]) -> Option<KernelFile> {
        match self.team(function, replaced) {
            Some(team) => team.members.iter().find(|&&(member, _)| member == function).and_then(|&(_, file)| file),
            None => self.own_file(function),
        }
    }

    /// The file that serves a function by itself: the set's own, else that of the set that it is based on.
    const fn own_file(self, function: Function) -> Option<KernelFile> {
        let mut set = self.answers();
        loop {
            let mut at = 0;
            while at < set.files.len() {
                // Constant functions can neither iterate nor compare with `==`: a loop by hand, and the numbers of the variants.
                if set.files[at].0 as usize == function as usize {
                    return Some(set.files[at].1);
                }
                at += 1;
            }
            // What a set does not have, its base has: `ray` takes `shade` from `vector`. A base has a base in turn.
            set = match set.base {
                Some(base) => base.answers(),
                None => return None,
            };
        }
    }
}

/// A set of kernels that serves every function.
const fn is_whole(set: KernelSet) -> bool {
    let mut at = 0;
    while at < Function::ALL.len() {
        if set.own_file(Function::ALL[at]).is_none() {
            return false;
        }
        at += 1;
    }
    true
}

const _: () = {
    let mut at = 0;
    while at < KernelSet::ALL.len() {
        assert!(is_whole(KernelSet::ALL[at]), "a set of kernels lacks a file for some function, and its base too");
        at += 1;
    }
};

impl fmt::Display for KernelSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for KernelSet {
    type Err = Box<Diagnostic>;

    fn from_str(name: &str) -> Result<KernelSet, Box<Diagnostic>> {
        let found = KernelSet::ALL.iter().find(|set| set.name() == name);
        found.copied().ok_or_else(|| unknown("profile", name, KernelSet::ALL.iter().map(|set| set.name())))
    }
}
