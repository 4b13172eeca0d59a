//! Machines that compute alike, and frames on them: those of native code against those that the interpreter steps.

use emu::engine::EngineKind;
use emu::inject::FaultKind;
use emu::machine::arbiter::ArbiterKind;
use emu::machine::config::{BusConfig, CacheConfig};
use emu::machine::{Config, RunFailure, RunOutcome, Setup, SteppedFrames};
use emu::octets::Memory;
use emu::profile::ProfileLevel;
use emu::replay::{Reason, Recorded};
use random::SplitMix64;

use crate::seen::Seen;

/// A frame, or what its trap or its machine's refusal says.
pub type Frame = Result<RunOutcome, String>;

/// The number of an input.
pub fn random_of(input: &[u8]) -> SplitMix64 {
    let mut octets = [0; 8];
    let length = input.len().min(8);
    octets[..length].copy_from_slice(&input[..length]);
    SplitMix64::new(u64::from_le_bytes(octets))
}

/// One of a list.
pub fn one_of<T: Copy>(random: &mut SplitMix64, list: &[T]) -> T {
    list[random.below(list.len() as u64) as usize]
}

/// Detail in which functions are measured: mostly none, since measuring takes much longer than the rest.
pub fn profile(random: &mut SplitMix64) -> ProfileLevel {
    match random.below(8) {
        0 => ProfileLevel::Totals,
        1 => ProfileLevel::Clocks,
        _ => ProfileLevel::None,
    }
}

/// A machine that computes as another one, with any bus, cache and protections, and up to so many cores.
pub fn alike(random: &mut SplitMix64, config: &Config, most_cores: u64) -> Config {
    let bus = BusConfig {
        arbiter: one_of(random, &ArbiterKind::ALL),
        weights: vec![3, 1, 2],
        slot_clocks: 40 + random.below(100),
        burst_octets: random.below(40),
        setup_clocks: random.below(4),
        overlap: random.below(4) == 0,
        ..config.bus
    };
    let octets = if random.below(2) == 0 { 0 } else { random.below(200) as u32 };
    let cache = CacheConfig { octets, line_octets: 16, kind: config.cache.kind.clone() };
    // Small numbers more often: a frame takes longer on many cores.
    let most = 1 + random.below(most_cores);
    let cores = 1 + random.below(most) as u32;
    let mut config = Config { cores, bus, cache, ..config.clone() };
    config.main.traffic = random.below(4) > 0;
    for kind in [FaultKind::Memory, FaultKind::Bus] {
        // Check bits make transfers longer.
        if random.below(4) == 0 {
            config.protection.set(kind, one_of(random, kind.protections()));
        }
    }
    config
}

/// Frames on all machines, which compute as that of the setup, by native code, against those that the interpreter steps: a run for each.
/// Yields the latter.
pub fn compare(
    setup: &Setup,
    machines: &[Config],
    memory: &Memory,
    random: &mut SplitMix64,
    seen: &mut Seen,
) -> Vec<Frame> {
    let with = |engine| {
        let mut setup = setup.clone();
        setup.options.engine = engine;
        setup
    };
    let checked = with(EngineKind::Checked);
    let stepped = stepped(&checked, machines, memory);
    let mut hold = |what: &str, frames: Vec<Frame>| {
        for (mut frame, stepped) in frames.into_iter().zip(&stepped) {
            if let (Ok(frame), Ok(stepped)) = (&mut frame, stepped) {
                seen.name(frame.method.reason().unwrap_or("replayed"));
                frame.method = stepped.method;
                // The planted fault is a wrong clock.
                if seen.has_planted() && frame.clocks.0 % 31 == 5 {
                    frame.clocks.0 += 1;
                }
            }
            assert!(frame == *stepped, "frames {what} agree with those that the interpreter steps");
        }
    };
    let native = with(EngineKind::Native);
    match random.below(4) {
        0 => hold("that native code steps", self::stepped(&native, machines, memory)),
        1 => hold("of recordings that are handed on", texts(emu::run_all(&native, machines, memory, &mut |_| {}))),
        2 => hold("of recordings", replayed(&native, machines, memory, |recorded| Ok(recorded))),
        _ => hold(
            "of recordings that were written and read",
            replayed(&native, machines, memory, |recorded| {
                // Those with clocks of functions are not kept.
                recorded.encode().map_or(Ok(recorded), |octets| Recorded::decode(&native, &octets))
            }),
        ),
    }
    // The interpreter records, too, but what it records is replayed as the rest is.
    hold("that the interpreter has recorded", texts(emu::run_all(&checked, &machines[..1], memory, &mut |_| {})));
    for frame in &stepped {
        match frame {
            Ok(frame) => seen.count("clocks", frame.clocks.0 as usize),
            Err(message) => seen.text(message),
        }
        seen.run();
    }
    stepped
}

fn texts(frames: Vec<Result<RunOutcome, RunFailure>>) -> Vec<Frame> {
    frames.into_iter().map(text).collect()
}

fn text(frame: Result<RunOutcome, RunFailure>) -> Frame {
    frame.map_err(|failure| failure.to_string())
}

fn stepped(setup: &Setup, machines: &[Config], memory: &Memory) -> Vec<Frame> {
    let stepped = SteppedFrames::new(setup);
    machines.iter().map(|config| text(stepped.step(config, memory.clone()))).collect()
}

/// Replays of a recording that is made once, and kept in some way; where it cannot be replayed, native code steps.
fn replayed(
    setup: &Setup,
    machines: &[Config],
    memory: &Memory,
    keep: impl Fn(Recorded) -> Result<Recorded, Reason>,
) -> Vec<Frame> {
    let stepped = SteppedFrames::new(setup);
    let step = |config: &Config| stepped.step(config, memory.clone());
    let Ok(recorded) = Recorded::new(setup, memory) else { return texts(machines.iter().map(step).collect()) };
    let recorded = keep(recorded).expect("what was written can be read");
    let replays = recorded.replays(setup);
    let replay = |config: &Config| replays.replay(config, memory.clone())?.or_else(|_| step(config));
    texts(machines.iter().map(replay).collect())
}
