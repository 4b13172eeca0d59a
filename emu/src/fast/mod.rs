//! The fast engine and what it is planned from: a program cut into runs, what each takes, and the host's vector instructions. It computes with
//! the meanings of [`crate::exec`]; [`crate::checked`] is what it is compared with, and what goes on wherever anything unusual happens.

mod plan;
pub mod single;
mod toll;

pub use plan::Plan;

/// Vector instructions of a host, best last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Features {
    /// What every host can.
    Baseline,
    /// Vectors of 256 bits.
    Avx2,
}

impl Features {
    /// All, best last.
    pub const ALL: [Features; 2] = [Features::Baseline, Features::Avx2];

    /// Name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Features::Baseline => "baseline",
            Features::Avx2 => "avx2",
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

/// When and where a work item asks the machine for something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moment {
    /// Word of the instruction.
    pub pc: u32,
    /// Clocks that the item has computed so far.
    pub clocks: u64,
}
