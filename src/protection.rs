//! Protections of a machine in figures: bits of storage and octets of the bus that they take. What they see of faults is told by `lancer inject`.

use emu::inject::{FaultKind, Protection, REGISTER_WORDS};
use emu::machine::Config;
use schemars::JsonSchema;
use serde::Serialize;

/// Words of 32 bits that a frame has in its programs and in its memory.
#[derive(Clone, Copy, Debug)]
pub struct StoredWords {
    /// Words of the cores' program.
    pub program: u64,
    /// Words of the main processor's program.
    pub main_program: u64,
    /// Octets of global memory.
    pub memory_octets: u64,
}

/// Protections of a machine: what they take beside the clocks and the energy of the frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct ProtectionUse {
    /// Octets of check bits that went over the bus beside those of `bus.moved`, rounded down.
    pub octets: u64,
    /// Check bits that are stored, of all cores, the main processor and global memory together.
    pub storage_bits: u64,
}

impl ProtectionUse {
    /// The use on a machine, of a frame that moved so many octets over the bus.
    pub fn new(config: &Config, stored: StoredWords, moved: emu::quantity::Octets) -> ProtectionUse {
        let bits = config.protection.iter().map(|(kind, protection)| check_bits(config, stored, kind, protection));
        ProtectionUse { octets: config.protection.check_octets(moved).0, storage_bits: bits.sum() }
    }
}

/// Check bits of a structure with a protection, of all cores and the main processor together; what is only moved or computed stores none.
pub fn check_bits(config: &Config, stored: StoredWords, kind: FaultKind, protection: Protection) -> u64 {
    let cores = u64::from(config.cores);
    let words = match kind {
        FaultKind::Registers => (cores + 1) * core_words(config, kind),
        FaultKind::Buffer => cores * core_words(config, kind) + u64::from(config.main.buffer_octets).div_ceil(4),
        FaultKind::Program => cores * stored.program + stored.main_program,
        FaultKind::Memory => stored.memory_octets.div_ceil(4),
        _ => 0,
    };
    words * u64::from(protection.check_bits())
}

/// Words of 32 bits in the registers or in the buffer of one core.
pub fn core_words(config: &Config, kind: FaultKind) -> u64 {
    match kind {
        FaultKind::Registers => REGISTER_WORDS.into(),
        FaultKind::Buffer => u64::from(config.buffer_octets).div_ceil(4),
        _ => 0,
    }
}

/// Protections of a machine in words, such as `memory ecc, results duplicated`; empty where nothing is protected.
#[cfg(feature = "cli")]
pub fn named(config: &Config) -> String {
    let names: Vec<String> =
        config.protection.iter().map(|(kind, protection)| format!("{} {}", kind.name(), protection.name())).collect();
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use emu::machine::config::MainConfig;
    use emu::quantity::Octets;

    use super::*;

    #[test]
    fn bits_and_octets_by_hand() {
        let main = MainConfig { buffer_octets: 21, ..MainConfig::default() };
        let mut config = Config { cores: 2, buffer_octets: 10, main, ..Config::default() };
        let stored = StoredWords { program: 100, main_program: 30, memory_octets: 4_001 };
        assert_eq!(ProtectionUse::new(&config, stored, Octets(1_000)), ProtectionUse::default());
        for (kind, protection, octets, storage_bits) in [
            // 143 words a processor with 7 bits each, three words of a core's buffer and six of the main processor's with 1.
            (FaultKind::Registers, Protection::Secded, 0, 3 * 143 * 7),
            (FaultKind::Buffer, Protection::Parity, 0, 2 * 3 + 6),
            (FaultKind::Program, Protection::Secded, 0, (2 * 100 + 30) * 7),
            // 1,000 octets with 7 bits beside each 32, which are 218.75; 1,001 words of memory.
            (FaultKind::Memory, Protection::Secded, 218, 1_001 * 7),
            (FaultKind::Bus, Protection::Parity, 31, 0),
            (FaultKind::Results, Protection::Duplicated, 0, 0),
            (FaultKind::Results, Protection::Residue, 0, 0),
            (FaultKind::LostGrant, Protection::Retry, 0, 0),
        ] {
            config.protection = Default::default();
            config.protection.set(kind, protection);
            let found = ProtectionUse::new(&config, stored, Octets(1_000));
            assert_eq!(found, ProtectionUse { octets, storage_bits }, "{} {}", kind.name(), protection.name());
        }
        // Both codes of a word go over the bus: 1,000 * (7 + 1) / 32.
        config.protection.set(FaultKind::Memory, Protection::Secded);
        config.protection.set(FaultKind::Bus, Protection::Parity);
        assert_eq!(ProtectionUse::new(&config, stored, Octets(1_000)).octets, 250);
    }
}
