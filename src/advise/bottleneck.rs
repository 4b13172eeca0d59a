//! The resource that sets the pace of a frame, from the clocks of its processors and of the bus.

use emu::machine::arbiter::ArbiterKind;
use emu::machine::{Config, ProcessorUse, RunOutcome};
use schemars::JsonSchema;
use serde::Serialize;

/// Share of the frame from which the bus counts as full.
const FULL: f64 = 0.95;

/// Share of the frame from which the main processor has no time left.
const OCCUPIED: f64 = 0.9;

/// Resource that sets the pace.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(inline)]
pub enum Bottleneck {
    /// The bus is full.
    Bus,
    /// Turns of the bus go by unused: the arbiter keeps them for masters that want none.
    Turns,
    /// The main processor has no time left, with its own transfers.
    MainProcessor,
    /// The cores compute most of the time.
    Computing,
    /// The cores wait most of the time for transfers although the bus has room: each transfer takes too long.
    Transfers,
    /// The cores have nothing to do most of the time though neither bus nor main processor is full.
    Work,
}

impl Bottleneck {
    /// Name in tables, as in results.
    pub const fn name(self) -> &'static str {
        match self {
            Bottleneck::Bus => "bus",
            Bottleneck::Turns => "turns",
            Bottleneck::MainProcessor => "main-processor",
            Bottleneck::Computing => "computing",
            Bottleneck::Transfers => "transfers",
            Bottleneck::Work => "work",
        }
    }
}

/// Shares of a frame, in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameShares {
    /// Frame in which the bus was busy.
    pub bus: f64,
    /// Cores' clocks in which they computed.
    pub busy: f64,
    /// Cores' clocks in which they waited for their transfers.
    pub waiting: f64,
    /// Cores' clocks in which they had nothing to do.
    pub idle: f64,
    /// Frame in which the main processor computed.
    pub main_busy: f64,
    /// Frame in which the main processor waited for its transfers.
    pub main_waiting: f64,
}

impl FrameShares {
    /// The shares of a frame on a machine.
    pub fn new(frame: &RunOutcome, machine: &Config) -> FrameShares {
        let (cores, main) = frame.processors.split_at(machine.cores as usize);
        let share = |processors: &[ProcessorUse], part: fn(&ProcessorUse) -> u64| {
            let whole = frame.clocks.0.saturating_mul(processors.len() as u64);
            if whole == 0 { 0.0 } else { processors.iter().map(part).sum::<u64>() as f64 / whole as f64 }
        };
        FrameShares {
            bus: frame.utilisation(),
            busy: share(cores, |used| used.busy.0),
            waiting: share(cores, |used| used.waiting.0),
            idle: share(cores, |used| used.idle.0),
            main_busy: share(main, |used| used.busy.0),
            main_waiting: share(main, |used| used.waiting.0),
        }
    }

    /// The resource that sets the pace under an arbiter.
    pub fn bottleneck(&self, arbiter: ArbiterKind) -> Bottleneck {
        // A full bus comes first: whoever waits then waits for it, the main processor as well.
        if self.bus >= FULL {
            return Bottleneck::Bus;
        }
        if self.main_busy >= OCCUPIED || (self.main_busy + self.main_waiting >= OCCUPIED && self.idle >= self.busy) {
            return Bottleneck::MainProcessor;
        }
        match () {
            () if self.busy >= self.waiting && self.busy >= self.idle => Bottleneck::Computing,
            () if self.waiting >= self.idle && arbiter == ArbiterKind::Tdma => Bottleneck::Turns,
            () if self.waiting >= self.idle => Bottleneck::Transfers,
            () => Bottleneck::Work,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fullest_resource_is_named() {
        let none = FrameShares { bus: 0.0, busy: 0.0, waiting: 0.0, idle: 0.0, main_busy: 0.0, main_waiting: 0.0 };
        let cases = [
            // A starved main processor waits for the bus like everybody else.
            (FrameShares { bus: 1.0, waiting: 0.8, busy: 0.2, main_busy: 0.01, main_waiting: 0.98, ..none }, "bus"),
            (
                FrameShares { bus: 0.6, busy: 0.3, idle: 0.7, main_busy: 0.7, main_waiting: 0.25, ..none },
                "main-processor",
            ),
            (FrameShares { bus: 0.5, busy: 0.6, waiting: 0.4, ..none }, "computing"),
            (FrameShares { bus: 0.6, busy: 0.4, waiting: 0.6, ..none }, "transfers"),
            (FrameShares { bus: 0.1, busy: 0.1, waiting: 0.1, idle: 0.8, ..none }, "work"),
        ];
        for (shares, expected) in cases {
            assert_eq!(shares.bottleneck(ArbiterKind::RoundRobin).name(), expected);
        }
        let slots = FrameShares { bus: 0.4, busy: 0.2, waiting: 0.8, ..none };
        assert_eq!(slots.bottleneck(ArbiterKind::Tdma), Bottleneck::Turns);
    }
}
