//! Vector instructions of the host: those that an engine may use, and those that there are.

/// Vector instructions of a host, best last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum HostSimd {
    /// Instructions of every host.
    Baseline,
    /// Vectors of 256 bits.
    Avx2,
}

impl HostSimd {
    /// All, best last.
    pub const ALL: [HostSimd; 2] = [HostSimd::Baseline, HostSimd::Avx2];

    /// Name in results.
    pub const fn name(self) -> &'static str {
        match self {
            HostSimd::Baseline => "baseline",
            HostSimd::Avx2 => "avx2",
        }
    }

    /// True where this host has them.
    #[cfg(target_arch = "x86_64")]
    pub fn is_present(self) -> bool {
        macro_rules! has {
            ($($name:tt)*) => { $(std::arch::is_x86_feature_detected!($name))&&* };
        }
        let has_avx2 = || has!("avx2" "bmi1" "bmi2" "fma" "lzcnt" "popcnt");
        match self {
            HostSimd::Baseline => true,
            HostSimd::Avx2 => has_avx2(),
        }
    }

    /// True where this host has them.
    #[cfg(not(target_arch = "x86_64"))]
    pub fn is_present(self) -> bool {
        self == HostSimd::Baseline
    }

    /// The best of this host.
    pub fn best() -> HostSimd {
        HostSimd::ALL.into_iter().rfind(|features| features.is_present()).unwrap_or(HostSimd::Baseline)
    }
}
