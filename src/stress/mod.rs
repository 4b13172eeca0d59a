//! The catalogue of what fixed-point ray tracers get wrong, each case with what is measured, the largest value that is allowed, and a seed.
//! A trial depends on its number alone, so a case can be stopped between trials and taken up again.

mod pictures;
pub mod progress;

use std::ops::Range;

use messages::{Diagnostic, did_you_mean};
use serde::{Deserialize, Serialize};
pub use trials::tally::TrialTally;
use trials::{closed, decisions, numbers, surfaces};

/// Number of trials by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CatalogueSize {
    /// Seconds: as many as the test suite makes.
    #[default]
    Quick,
    /// Minutes to hours.
    Full,
}

impl CatalogueSize {
    /// Both sizes.
    pub const ALL: [CatalogueSize; 2] = [CatalogueSize::Quick, CatalogueSize::Full];

    /// Name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            CatalogueSize::Quick => "quick",
            CatalogueSize::Full => "full",
        }
    }
}

/// Makes a range of trials.
type Trials = fn(u64, Range<u64>) -> TrialTally;

/// Number of trials, and who makes them.
type TrialWork = (u64, Trials);

/// One case.
#[derive(Debug)]
pub struct Case {
    /// Name on the command line.
    pub name: &'static str,
    /// Description of the trials.
    pub about: &'static str,
    /// Quantity that is measured.
    pub quantity: &'static str,
    /// The largest value that is allowed: of errors, or of trials that go wrong.
    pub threshold: f64,
    /// Beginning of the series of random numbers.
    pub seed: u64,
    /// True where the value is the largest error of a trial, and not the number of trials that go wrong, of which none is allowed either way.
    is_error: bool,
    quick: TrialWork,
    full: TrialWork,
}

impl Case {
    const fn new(
        name: &'static str,
        about: &'static str,
        quantity: &'static str,
        quick: TrialWork,
        full: TrialWork,
    ) -> Case {
        Case { name, about, quantity, threshold: 0.0, seed: 0, is_error: false, quick, full }
    }

    /// A case that measures errors, up to a threshold.
    const fn at_most(self, threshold: f64) -> Case {
        Case { threshold, is_error: true, ..self }
    }

    const fn seed(self, seed: u64) -> Case {
        Case { seed, ..self }
    }

    fn work(&self, size: CatalogueSize) -> TrialWork {
        match size {
            CatalogueSize::Quick => self.quick,
            CatalogueSize::Full => self.full,
        }
    }

    /// Number of trials.
    pub fn trials(&self, size: CatalogueSize) -> u64 {
        self.work(size).0
    }

    /// Makes some trials.
    pub fn run(&self, size: CatalogueSize, trials: Range<u64>) -> TrialTally {
        self.work(size).1(self.seed, trials)
    }

    /// The value that is measured.
    pub fn value(&self, tally: &TrialTally) -> f64 {
        if self.is_error { tally.worst } else { tally.failures as f64 }
    }

    /// True where the value is allowed.
    pub fn passes(&self, tally: &TrialTally) -> bool {
        tally.failures == 0 && tally.worst <= self.threshold
    }
}

/// The catalogue.
pub static CASES: &[Case] = &[
    Case::new(
        "closed_meshes",
        "rays aimed at vertices and edges of six closed meshes, through the whole search",
        "leaks, multiple and wrong hits",
        (600_000, closed::closed_meshes),
        (100_000_000, closed::closed_meshes),
    )
    .seed(1),
    Case::new(
        "packed_words",
        "rays aimed at vertices and edges of the six meshes in the layout `packed`, in words of 12, 16, 20 and 24 bits",
        "leaks and wrong hits",
        (200_000, closed::packed_words),
        (40_000_000, closed::packed_words),
    )
    .seed(16),
    Case::new(
        "split_planes",
        "rays in planes that divide the kd tree and through edges and corners of its boxes",
        "leaks, multiple and wrong hits",
        (200_000, closed::split_planes),
        (10_000_000, closed::split_planes),
    )
    .seed(2),
    Case::new(
        "zero_directions",
        "rays along an axis or at right angles to one, through vertices",
        "leaks, multiple and wrong hits",
        (200_000, closed::zero_directions),
        (10_000_000, closed::zero_directions),
    )
    .seed(3),
    Case::new(
        "grazing",
        "rays within a few units of a triangle's plane",
        "wrong decisions and distances",
        (200_000, decisions::grazing),
        (10_000_000, decisions::grazing),
    )
    .seed(4),
    Case::new(
        "slivers",
        "triangles a million times as long as wide and more",
        "wrong decisions and distances",
        (200_000, decisions::slivers),
        (10_000_000, decisions::slivers),
    )
    .seed(5),
    Case::new(
        "near_equal",
        "sheets a few units apart, whose distances round to the same number or the next",
        "wrong hits",
        (20_000, decisions::near_equal),
        (10_000_000, decisions::near_equal),
    )
    .seed(6),
    Case::new(
        "duplicates",
        "coplanar duplicates, in another order in each packet",
        "hits that are not the lowest index",
        (10_000, decisions::duplicates),
        (10_000_000, decisions::duplicates),
    )
    .seed(7),
    Case::new(
        "degenerate",
        "triangles that are points or lines, along the edges of others",
        "hits of them, leaks, multiple and wrong hits",
        (10_000, decisions::degenerate),
        (10_000_000, decisions::degenerate),
    )
    .seed(8),
    Case::new(
        "bounds",
        "a box at the ends of the grid, and rays from end to end",
        "leaks, multiple and wrong hits",
        (20_000, decisions::bounds),
        (10_000_000, decisions::bounds),
    )
    .seed(9),
    Case::new(
        "self_intersection",
        "secondary rays from a convex body, a thousand from each point, in all modes of rounding and overflow",
        "rays that hit it although they leave, or not once although they enter",
        (70_000, surfaces::self_intersection),
        (1_000_000, surfaces::self_intersection),
    )
    .seed(10),
    Case::new(
        "normalising",
        "unit vectors of vectors between 2^-14 and 2^14 long",
        "largest error of a component, ulp",
        (100_000, surfaces::normalising),
        (10_000_000, surfaces::normalising),
    )
    .seed(11)
    .at_most(1.5),
    Case::new(
        "critical_angle",
        "rays that leave glass next to the critical angle",
        "largest distance of a wrong side from it, ulp of the squared cosine",
        (100_000, surfaces::critical_angle),
        (10_000_000, surfaces::critical_angle),
    )
    .seed(12)
    .at_most(14.8),
    Case::new(
        "scales",
        "five scenes 2^-300 to 2^300 times as large",
        "pictures that differ",
        (105, pictures::scales),
        (105, pictures::scales),
    ),
    Case::new(
        "translations",
        "five scenes moved by whole steps of the grid",
        "pictures that differ",
        (20, pictures::translations),
        (1000, pictures::translations),
    )
    .seed(13),
    Case::new(
        "bounces",
        "mirrors and glass down to five bounces",
        "largest difference from double precision, steps of 1/255",
        (5, pictures::bounces),
        (5, pictures::bounces),
    )
    .at_most(0.99),
    Case::new(
        "colours",
        "lights so bright that colours leave their format",
        "largest difference from clamped double precision, steps of 1/255",
        (6, pictures::colours),
        (6, pictures::colours),
    )
    .at_most(0.01),
    Case::new(
        "kernels",
        "pictures that the emulated machine draws, against the native functions that other cases rely on",
        "pictures that differ",
        (5, pictures::kernels),
        (5, pictures::kernels),
    ),
    Case::new(
        "arithmetic",
        "pairs of operands of 12 bits, four operations in every mode",
        "pairs with a result other than the model's",
        (2_000, numbers::arithmetic),
        (4_096, numbers::all_pairs),
    )
    .seed(14),
    Case::new(
        "square_root",
        "square roots of operands of 32 bits",
        "trials with a root that is not the nearest number",
        (1_000_000, numbers::roots),
        (65_536, numbers::all_roots),
    )
    .seed(15),
];

/// The case of a name.
///
/// # Errors
/// A name that is none.
pub fn find(name: &str) -> Result<&'static Case, Box<Diagnostic>> {
    CASES.iter().find(|case| case.name == name).ok_or_else(|| {
        let names = CASES.iter().map(|case| case.name);
        let hint = did_you_mean(name, names.clone())
            .unwrap_or_else(|| format!("the cases are {}", names.collect::<Vec<_>>().join(", ")));
        Box::new(Diagnostic::error(format!("there is no case `{name}`")).hint(hint))
    })
}
