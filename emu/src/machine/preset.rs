//! Machines that are known by name. The first is the report's; each other one changes it in one direction.

use isa::Class;

use super::config::law::{Growth, Law};
use super::config::{BusConfig, CacheConfig, Config};

/// A machine that is known by name.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// Name that the user types.
    pub name: &'static str,
    /// One line on what it is.
    pub description: &'static str,
    make: fn() -> Config,
}

impl Preset {
    /// The machine.
    pub fn config(&self) -> Config {
        (self.make)()
    }
}

/// All presets, the report's first.
pub const PRESETS: &[Preset] = &[
    Preset {
        name: "report",
        description: "the report's: four cores at 100 MHz, one clock an elementary operation, a bus of an octet in two clocks",
        make: Config::default,
    },
    Preset {
        name: "wide32",
        description: "a bus of 32 bits a clock in bursts of 64 octets, and three units for add, sub and mul",
        make: wide32,
    },
    Preset {
        name: "double_buffer",
        description: "the report's, with block loads that do not stop the core: a second buffer, filled ahead",
        make: || Config { bus: BusConfig { overlap: true, ..BusConfig::default() }, ..Config::default() },
    },
    Preset {
        name: "two_buffers",
        description: "the report's, with room for a second packet in the buffer, 34,397 octets, and block loads beside computing",
        make: two_buffers,
    },
    Preset {
        name: "node_cache",
        description: "the report's, with a private cache of 4 KiB for tree nodes in each core",
        make: || Config { cache: CacheConfig { octets: 4096, ..CacheConfig::default() }, ..Config::default() },
    },
    Preset {
        name: "bit_serial",
        description: "the report's, with operations that take a clock a bit of the word",
        make: bit_serial,
    },
    Preset {
        name: "combinational",
        description: "the report's, with a clock a level of logic, at five times its rate: add, sub and cmp log2 of the word, mul twice that, div the word",
        make: combinational,
    },
    Preset {
        name: "counted_all",
        description: "the report's, with a clock also for moves, logic, jumps, addresses and words of the buffer",
        make: counted_all,
    },
];

/// The report's buffer with its 512 triangles of 31 octets twice. Kernels that fetch ahead (`--profile prefetched`) use nothing before it has come.
fn two_buffers() -> Config {
    let report = Config::default();
    let bus = BusConfig { overlap: true, ..BusConfig::default() };
    Config { buffer_octets: report.buffer_octets + 512 * 31, bus, ..report }
}

/// Two clocks before a burst, the report's access time, are paid once in 64 octets instead of for each one.
fn wide32() -> Config {
    let bus =
        BusConfig { octets_per_beat: 4, clocks_per_beat: 1, setup_clocks: 2, burst_octets: 64, ..BusConfig::default() };
    let mut config = Config { bus, ..Config::default() };
    for class in [Class::Add, Class::Sub, Class::Mul] {
        config.units.0[class] = 3.into();
    }
    config
}

/// A bit a clock: a serial adder takes as long as the word, a multiplication is a masked step for each bit, as in the report, and a
/// division a quotient bit a clock.
fn bit_serial() -> Config {
    let mut config = Config::default();
    for &class in Class::ALL.iter().filter(|class| class.is_elementary()) {
        config.clocks.0[class] = Law::of(Growth::Linear);
    }
    config
}

/// Clocks are levels of logic: a parallel-prefix adder has one for each doubling of the word, a multiplier a tree of partial products and
/// such an adder behind it, a divider a row for each bit of the quotient. Clock and bus keep the report's times: an addition of 32 bits
/// takes 10 ns, an octet 20 ns.
fn combinational() -> Config {
    let bus = BusConfig { clocks_per_beat: 10, ..BusConfig::default() };
    let mut config = Config { clock_hz: 500_000_000, bus, ..Config::default() };
    for class in [Class::Add, Class::Sub, Class::Cmp] {
        config.clocks.0[class] = Law::of(Growth::Log);
    }
    config.clocks.0[Class::Mul] = Law::times(Growth::Log, 2);
    config.clocks.0[Class::Div] = Law::of(Growth::Linear);
    config
}

/// A clock for whatever the core does by itself. Requests and octets stay without, since the bus accounts for them.
fn counted_all() -> Config {
    let mut config = Config::default();
    for class in [Class::Move, Class::Logic, Class::Jump, Class::Local, Class::Address] {
        config.clocks.0[class] = 1.into();
    }
    config
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_machines_and_differ() {
        for (at, preset) in PRESETS.iter().enumerate() {
            preset.config().check().expect(preset.name);
            for other in &PRESETS[..at] {
                assert_ne!(other.name, preset.name);
                assert_ne!(other.config(), preset.config());
            }
        }
    }
}
