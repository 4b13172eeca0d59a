//! The machine as a file describes it: every key with its unit and where its default comes from.

mod file;
pub mod formula;
pub mod law;
pub mod ledger;
pub mod protection;
pub mod published;

use isa::number::{Modes, Overflow, Quantization};
use isa::{Class, Counts};
use serde::{Deserialize, Serialize};

use super::arbiter::ArbiterKind;
use crate::code::quantity::{Clocks, Octets};
use crate::code::timing::{PACKET_LANES, Timing};
use crate::semantics::Watching;
pub use law::{ClassClocks, ClassUnits};
pub use ledger::{AreaConfig, EnergyConfig};
pub use protection::ProtectionConfig;
use protection::WORD_BITS;

/// Most cores that a machine may have.
pub const MOST_CORES: u32 = 256;

/// Most lanes of a packet unit.
pub const MOST_LANES: u32 = 1024;

/// Most octets of a local buffer.
pub const MOST_BUFFER_OCTETS: u32 = 1 << 24;

/// Octets of the buffers, or of the caches, of all cores together: a host keeps them twice.
pub const MOST_OCTETS: u64 = 1 << 27;

/// Most clocks of an operation, a beat or a set-up, and most units of a class.
pub const MOST_CLOCKS: u64 = 1_000_000;

/// A machine. The defaults are the report's.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// Number of cores, 1 to 256, the main processor not counted; 4. Report 6.1.
    pub cores: u32,
    /// Clock rate in hertz; 100 MHz. Report 6.1.
    pub clock_hz: u64,
    /// Octets of each core's local buffer; 18,525, the sum of the list. Report 6.2.
    pub buffer_octets: u32,
    /// Instructions that a work item may take; 10^8, thousands of times what a pixel takes.
    pub step_limit: u64,
    /// Triangles of a packet that `rnear` and `rany` test at once; 4. The report has no such unit.
    pub packet_lanes: u32,
    /// Word and modes.
    pub arithmetic: ArithmeticConfig,
    /// Clocks of an operation, by class, as numbers or by the word; 1 for add, sub, mul, div and cmp, 0 for the rest. Report 6.1.
    pub clocks: ClassClocks,
    /// Operations that run at once, by class, as numbers or by the word; 1.
    pub units: ClassUnits,
    /// The shared bus.
    pub bus: BusConfig,
    /// The cores' private caches.
    pub cache: CacheConfig,
    /// The main processor.
    pub main: MainConfig,
    /// Protections against faults; none. Report: none.
    pub protection: ProtectionConfig,
    /// Figures of energy; those of the published tables. Nothing but energies depends on them.
    pub energy: EnergyConfig,
    /// Figures of area; those of the published tables. Nothing but areas depends on them.
    pub area: AreaConfig,
}

impl Default for Config {
    fn default() -> Config {
        Config {
            cores: 4,
            clock_hz: 100_000_000,
            buffer_octets: 18_525,
            step_limit: 100_000_000,
            packet_lanes: PACKET_LANES,
            arithmetic: ArithmeticConfig::default(),
            clocks: ClassClocks::default(),
            units: ClassUnits::default(),
            bus: BusConfig::default(),
            cache: CacheConfig::default(),
            main: MainConfig::default(),
            protection: ProtectionConfig::default(),
            energy: EnergyConfig::default(),
            area: AreaConfig::default(),
        }
    }
}

/// Word length and modes of the machine's arithmetic.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ArithmeticConfig {
    /// Bits of a word, 8 to 32; 32.
    pub word: u32,
    /// Rounding, by its name in IEEE 1666 without `SC_`; RND, to nearest with ties up.
    #[serde(with = "quantization_name")]
    pub quantization: Quantization,
    /// Overflow, by its name in IEEE 1666 without `SC_`; SAT, the nearest number that fits.
    #[serde(with = "overflow_name")]
    pub overflow: Overflow,
    /// Stop at a division by zero instead of saturating; no.
    pub trap_division_by_zero: bool,
}

impl Default for ArithmeticConfig {
    fn default() -> ArithmeticConfig {
        let Modes { word, quantization, overflow } = Modes::default();
        ArithmeticConfig { word, quantization, overflow, trap_division_by_zero: false }
    }
}

impl ArithmeticConfig {
    /// The modes that `isa` computes with.
    pub fn modes(&self) -> Modes {
        Modes { word: self.word, quantization: self.quantization, overflow: self.overflow }
    }

    /// Arithmetic that watches what happens, for a machine that does not compute with [`isa::number::Nearest32`]; `None` for one that does.
    pub(crate) fn watching(&self, has_losses: bool) -> Option<Watching> {
        let (modes, traps) = (self.modes(), self.trap_division_by_zero);
        let watching = Watching::new(modes, traps);
        match has_losses {
            true => Some(watching.with_losses()),
            false => (modes != Modes::default() || traps).then_some(watching),
        }
    }
}

/// Reads and writes a mode by its name.
macro_rules! mode_name {
    ($module:ident $type:ident) => {
        mod $module {
            use isa::number::$type;
            use serde::{Deserialize, Deserializer, Serializer};

            pub fn serialize<S: Serializer>(mode: &$type, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_str(mode)
            }

            pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<$type, D::Error> {
                let name = String::deserialize(deserializer)?;
                let names: Vec<&str> = $type::ALL.iter().map(|mode| mode.name()).collect();
                $type::from_name(&name).ok_or_else(|| {
                    serde::de::Error::custom(format!("unknown mode `{name}`, expected one of `{}`", names.join("`, `")))
                })
            }
        }
    };
}

mode_name!(quantization_name Quantization);
mode_name!(overflow_name Overflow);

/// The shared bus.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BusConfig {
    /// Octets that go over the bus at once; 1. Report 6.1.
    pub octets_per_beat: u64,
    /// Clocks for that; 2, "a memory access takes twice an elementary operation". Report 6.1.
    pub clocks_per_beat: u64,
    /// Clocks before the first beat of a burst; 0. The report has none.
    pub setup_clocks: u64,
    /// Octets of the longest burst, 0 for no limit; 0. A longer transfer asks for the bus again after each burst.
    pub burst_octets: u64,
    /// Overlap: a core goes on while its block load is on its way; no. Report 6.1 adds computing and waiting up.
    ///
    /// The core goes on as soon as it has asked, up to the next thing that it wants of the machine (a transfer, a
    /// message, a barrier, its end); that begins when the load has ended. The data count as being there at once: the
    /// buffer's other half was filled ahead, and always with the right data, so this is the most that a second buffer
    /// can bring. Loads of single words are waited for.
    pub overlap: bool,
    /// Arbiter, which says who gets the bus next; round-robin.
    pub arbiter: ArbiterKind,
    /// Bursts that a master keeps its turn for, the main processor after the last core, for the weighted arbiter; 1
    /// where the list ends.
    pub weights: Vec<u32>,
    /// Clocks of a slot of the TDMA arbiter; 128. A burst is never longer than what fits a slot.
    pub slot_clocks: u64,
}

impl Default for BusConfig {
    fn default() -> BusConfig {
        BusConfig {
            octets_per_beat: 1,
            clocks_per_beat: 2,
            setup_clocks: 0,
            burst_octets: 0,
            overlap: false,
            arbiter: ArbiterKind::default(),
            weights: Vec::new(),
            slot_clocks: 128,
        }
    }
}

impl BusConfig {
    /// Length in clocks of a burst whose words of 32 bits have so many check bits.
    ///
    /// Check bits go over the wires of the words, so beats take (32 + c) / 32 of their clocks, and the burst ends with a whole one: 4 octets in 8 clocks
    /// take 8 * 33 / 32 = 8.25 with parity, which are 9, and 64 octets in 128 clocks take 132.
    pub fn length(&self, octets: Octets, check_bits: u32) -> Clocks {
        let beats = octets.0.div_ceil(self.octets_per_beat);
        Clocks(self.setup_clocks + (beats * self.clocks_of_words(check_bits)).div_ceil(WORD_BITS.into()))
    }

    /// Clocks of 32 beats with the check bits of their words.
    pub(super) fn clocks_of_words(&self, check_bits: u32) -> u64 {
        self.clocks_per_beat * u64::from(WORD_BITS + check_bits)
    }

    /// Octets of the longest burst.
    pub fn longest_burst(&self, check_bits: u32) -> Octets {
        let limit = if self.burst_octets == 0 { u64::MAX } else { self.burst_octets };
        let clocks_of_slot = self.slot_clocks.saturating_sub(self.setup_clocks);
        let beats_of_slot = clocks_of_slot * u64::from(WORD_BITS) / self.clocks_of_words(check_bits);
        match self.arbiter {
            ArbiterKind::Tdma => Octets(limit.min((beats_of_slot * self.octets_per_beat).max(1))),
            _ => Octets(limit),
        }
    }

    /// Clocks for which a transfer that nobody disturbs holds the bus, all its bursts together.
    pub fn whole_length(&self, octets: Octets, check_bits: u32) -> Clocks {
        let burst = self.longest_burst(check_bits);
        if octets <= burst {
            return self.length(octets, check_bits);
        }
        let whole = Clocks(self.length(burst, check_bits).0 * (octets.0 / burst.0));
        match octets.0 % burst.0 {
            0 => whole,
            rest => whole + self.length(Octets(rest), check_bits),
        }
    }
}

/// The private cache that each core has for one kind of data that is only read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CacheConfig {
    /// Octets of each core's cache, 0 for none; 0. The report has none.
    pub octets: u32,
    /// Octets of a line, which is got whole; 64.
    pub line_octets: u32,
    /// Kind of data that goes through it, by the loader's name; nodes of the tree.
    pub kind: String,
}

impl CacheConfig {
    /// True where a copy of a cache costs no more than some transfers, so that masters may go ahead of the bus.
    pub(super) fn has_few_lines(&self) -> bool {
        self.octets / self.line_octets.max(1) <= 1024
    }
}

impl Default for CacheConfig {
    fn default() -> CacheConfig {
        CacheConfig { octets: 0, line_octets: 64, kind: "nodes".to_owned() }
    }
}

/// The main processor.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MainConfig {
    /// Use of the bus by its transfers and by messages to and from it; yes. Otherwise they take no time.
    pub traffic: bool,
    /// Octets of its local buffer; 65,536. The report does not limit it.
    pub buffer_octets: u32,
    /// Instructions that its whole program may take; 10^11.
    pub step_limit: u64,
}

impl Default for MainConfig {
    fn default() -> MainConfig {
        MainConfig { traffic: true, buffer_octets: 65_536, step_limit: 100_000_000_000 }
    }
}

impl Config {
    /// Times of operations, for words of the machine's length. Elementary ones that are executed twice take twice their clocks.
    pub fn timing(&self) -> Timing {
        let word = self.arithmetic.word;
        // An inverse law may come to no unit at all; a class always has one.
        let units = Counts(self.units.0.at(word).0.map(|units| units.max(1)));
        let mut clocks = self.single_clocks();
        for &class in Class::ALL.iter().filter(|class| class.is_elementary()) {
            clocks[class] = clocks[class].saturating_mul(self.protection.executions());
        }
        Timing { clocks, units, packet_lanes: self.packet_lanes }
    }

    /// Clocks of operations that are executed once, for words of the machine's length, as the key `clocks` has them.
    pub fn single_clocks(&self) -> Counts {
        self.clocks.0.at(self.arithmetic.word)
    }

    /// Clocks for which a transfer that nobody disturbs holds the bus, all its bursts and check bits together.
    pub fn transfer_clocks(&self, octets: Octets) -> Clocks {
        self.bus.whole_length(octets, self.protection.moved_bits())
    }

    /// Some clocks or units depend on the word.
    pub fn is_timed_by_word(&self) -> bool {
        self.clocks.0.is_grown() || self.units.0.is_grown()
    }

    /// True where work items do the same on both machines, in the same clocks of computing: only cores, bus, caches,
    /// main processor and protections may differ, but not whether results are computed twice, which the times of operations have.
    pub fn computes_like(&self, other: &Config) -> bool {
        let Config {
            cores: _,
            clock_hz: _,
            buffer_octets,
            step_limit,
            packet_lanes: _,
            arithmetic,
            clocks: _,
            units: _,
            bus: _,
            cache: _,
            main: _,
            protection: _,
            energy: _,
            area: _,
        } = self;
        (buffer_octets, step_limit) == (&other.buffer_octets, &other.step_limit)
            && arithmetic == &other.arithmetic
            && self.timing() == other.timing()
    }
}
