//! Structures and parts of the machine in which faults happen, and protections of them, by their names. Faults are drawn in `inject/`, and what a
//! protection costs is counted in `config/protection.rs`.

/// Structure in which bits flip, all of them rows of words of 32 bits, or part of the machine that goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FaultKind {
    /// Registers that programs can name, of the core that does the work item; a wide accumulator is two words.
    Registers,
    /// Local buffer of that core.
    Buffer,
    /// Program store of that core, from the work item of the moment on.
    Program,
    /// Image in global memory, from the work item of the moment on.
    Memory,
    /// Addresses and data of the transfers and messages of a work item.
    Bus,
    /// Result of an instruction that computes, on its way to the register.
    Results,
    /// A grant that reaches nobody.
    LostGrant,
    /// A grant to two cores at once, whose data are on the bus together.
    DoubledGrant,
    /// An arbiter that grants to one master alone.
    StuckArbiter,
    /// A core that asks no more.
    StoppedCore,
}

impl FaultKind {
    /// All of them.
    pub const ALL: [FaultKind; 10] = [
        FaultKind::Registers,
        FaultKind::Buffer,
        FaultKind::Program,
        FaultKind::Memory,
        FaultKind::Bus,
        FaultKind::Results,
        FaultKind::LostGrant,
        FaultKind::DoubledGrant,
        FaultKind::StuckArbiter,
        FaultKind::StoppedCore,
    ];

    /// Name in options and results.
    pub const fn name(self) -> &'static str {
        match self {
            FaultKind::Registers => "registers",
            FaultKind::Buffer => "buffer",
            FaultKind::Program => "program",
            FaultKind::Memory => "memory",
            FaultKind::Bus => "bus",
            FaultKind::Results => "results",
            FaultKind::LostGrant => "lost_grant",
            FaultKind::DoubledGrant => "doubled_grant",
            FaultKind::StuckArbiter => "stuck_arbiter",
            FaultKind::StoppedCore => "stopped_core",
        }
    }

    /// True where bits of a word flip.
    pub const fn has_bits(self) -> bool {
        !matches!(
            self,
            FaultKind::LostGrant | FaultKind::DoubledGrant | FaultKind::StuckArbiter | FaultKind::StoppedCore
        )
    }

    /// True where the machine's clocks decide what comes of it.
    pub const fn is_of_clocks(self) -> bool {
        matches!(self, FaultKind::LostGrant | FaultKind::StuckArbiter | FaultKind::StoppedCore)
    }

    /// True where a flip stays for later work items.
    pub const fn is_lasting(self) -> bool {
        matches!(self, FaultKind::Program | FaultKind::Memory)
    }

    /// Protections that the structure, or the part of the machine, may have; none for what no code or counter is made for.
    pub const fn protections(self) -> &'static [Protection] {
        match self {
            FaultKind::Results => &[Protection::Duplicated, Protection::Residue],
            FaultKind::LostGrant => &[Protection::Retry, Protection::Watchdog],
            FaultKind::StuckArbiter | FaultKind::StoppedCore => &[Protection::Watchdog],
            // A wire with a 1 too many is none of the errors that the codes are made for.
            FaultKind::DoubledGrant => &[],
            _ => &[Protection::Parity, Protection::Secded],
        }
    }

    /// Names of those, and of no protection.
    pub fn protection_names(self) -> impl Iterator<Item = &'static str> {
        [Protection::Unprotected].into_iter().chain(self.protections().iter().copied()).map(Protection::name)
    }

    /// Part of the machine that a protection of it protects, in words; `None` where there is no protection.
    pub const fn protected(self) -> Option<&'static str> {
        match self {
            FaultKind::Registers => Some("registers of the cores and the main processor"),
            FaultKind::Buffer => Some("local buffers of the cores and the main processor"),
            FaultKind::Program => Some("program stores of the cores and the main processor"),
            FaultKind::Memory => {
                Some("global memory, whose check bits go over the bus with each word, those of messages among them")
            }
            FaultKind::Bus => Some("addresses, data and messages on the bus"),
            FaultKind::Results => Some("what elementary operations compute"),
            FaultKind::LostGrant => Some("requests of the bus whose grant is lost"),
            FaultKind::DoubledGrant => None,
            FaultKind::StuckArbiter => Some("the arbiter"),
            FaultKind::StoppedCore => Some("cores that ask for nothing any more"),
        }
    }
}

/// Protection of a structure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Protection {
    /// None at all.
    #[default]
    Unprotected,
    /// A bit of parity a word: finds an odd number of flipped bits.
    Parity,
    /// Seven check bits a word of 32 (an extended Hamming code): mends one flipped bit, finds two.
    Secded,
    /// Each instruction that computes is executed twice, and the results compared.
    Duplicated,
    /// Results are computed a second time modulo 3, and the remainders compared.
    Residue,
    /// A core whose request is not granted for [`RETRY_CLOCKS`](crate::inject::RETRY_CLOCKS) makes it again.
    Retry,
    /// The machine stops when nobody has been granted the bus, and nobody computes, for as long.
    Watchdog,
}

impl Protection {
    /// All of them.
    pub const ALL: [Protection; 7] = [
        Protection::Unprotected,
        Protection::Parity,
        Protection::Secded,
        Protection::Duplicated,
        Protection::Residue,
        Protection::Retry,
        Protection::Watchdog,
    ];

    /// Name in machine files, options and results.
    pub const fn name(self) -> &'static str {
        match self {
            Protection::Unprotected => "none",
            Protection::Parity => "parity",
            Protection::Secded => "ecc",
            Protection::Duplicated => "duplicated",
            Protection::Residue => "residue",
            Protection::Retry => "retry",
            Protection::Watchdog => "watchdog",
        }
    }

    /// Bits that a word of 32 bits has beside its own.
    pub const fn check_bits(self) -> u32 {
        match self {
            Protection::Unprotected | Protection::Duplicated | Protection::Retry | Protection::Watchdog => 0,
            Protection::Parity => 1,
            Protection::Secded => 7,
            Protection::Residue => 2,
        }
    }

    /// The protection of a name; `None` for a name of none.
    pub fn from_name(name: &str) -> Option<Protection> {
        Protection::ALL.into_iter().find(|one| one.name() == name)
    }
}
