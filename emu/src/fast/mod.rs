//! The fast engine: 32 work items in lock-step, each instruction over all of them. It computes with the meanings of
//! [`crate::exec`] and counts a block at a time; [`crate::checked`] is what it is compared with, and what runs whatever it does
//! not: a group in which anything unusual happens is thrown away and run again, one item after the other.

mod group;
mod lanes;
mod meter;
mod operands;
mod origins;
mod plan;
mod ray;
mod rows;
pub mod single;
mod toll;

pub use group::{Counted, Counting, Group, Moment, Uncounted, Unusual, Wires};
pub use lanes::{LANES, Mask, each};
pub use plan::Plan;

/// What the host can do for a group, best last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Features {
    /// What every host can.
    Baseline,
    /// Vectors of 256 bits.
    Avx2,
    /// Vectors of 512 bits.
    Avx512,
}

impl Features {
    /// All, best last.
    pub const ALL: [Features; 3] = [Features::Baseline, Features::Avx2, Features::Avx512];

    /// Name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Features::Baseline => "baseline",
            Features::Avx2 => "avx2",
            Features::Avx512 => "avx512",
        }
    }

    /// Whether this host has them.
    #[cfg(target_arch = "x86_64")]
    pub fn is_present(self) -> bool {
        macro_rules! has {
            ($($name:tt)*) => { $(std::arch::is_x86_feature_detected!($name))&&* };
        }
        let has_avx2 = || has!("avx2" "bmi1" "bmi2" "fma" "lzcnt" "popcnt");
        match self {
            Features::Baseline => true,
            Features::Avx2 => has_avx2(),
            Features::Avx512 => has_avx2() && has!("avx512f" "avx512bw" "avx512cd" "avx512dq" "avx512vl"),
        }
    }

    /// Whether this host has them.
    #[cfg(not(target_arch = "x86_64"))]
    pub fn is_present(self) -> bool {
        self == Features::Baseline
    }

    /// The best of this host that is not above it.
    pub fn present(self) -> Present {
        Present(self.min(Features::best()))
    }

    /// The best of this host.
    pub fn best() -> Features {
        Features::ALL.into_iter().rfind(|features| features.is_present()).unwrap_or(Features::Baseline)
    }
}

/// Features that this host has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Present(Features);

/// Runs the lanes of a group until all have halted, with the features given. The results are the same with all of them.
///
/// # Errors
/// Something unusual: then the group is worth nothing, and its items are for the interpreter.
pub fn run<W: Wires, C: Counting>(
    Present(features): Present,
    plan: &Plan,
    group: &mut Group,
    wires: &mut W,
) -> Result<(), Unusual> {
    #[cfg(target_arch = "x86_64")]
    {
        if features >= Features::Avx512 {
            // SAFETY: the host has the features that the function is compiled for. `rows::baseline::run` is its safe twin.
            return unsafe { rows::avx512::run::<W, C>(plan, group, wires) };
        }
        if features >= Features::Avx2 {
            // SAFETY: as above.
            return unsafe { rows::avx2::run::<W, C>(plan, group, wires) };
        }
    }
    let _ = features;
    rows::baseline::run::<W, C>(plan, group, wires)
}
