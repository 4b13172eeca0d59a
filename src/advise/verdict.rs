//! One sentence on what limits a machine, and why.

use emu::code::Code;
use emu::machine::{Config, RunOutcome};
use isa::Class;

use super::bottleneck::{Bottleneck, FrameShares};
use crate::load::Load;
use crate::numeral::{count, grouped};

/// The sentence on a frame of a load on a machine.
pub fn sentence(frame: &RunOutcome, machine: &Config, load: &Load) -> String {
    let shares = FrameShares::new(frame, machine);
    let cores = count(machine.cores.into(), "core", "cores");
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let transfers = transfers(frame);
    match shares.bottleneck(machine.bus.arbiter) {
        Bottleneck::Bus => format!(
            "The bus limits this machine: it is busy {} of the frame, and the {cores} wait {} of their time for it; {transfers}.",
            percent(shares.bus),
            percent(shares.waiting),
        ),
        Bottleneck::Turns => format!(
            "The arbiter limits this machine: turns of {} clocks go to masters that want nothing, so the bus is busy only {} of the frame while the {cores} wait {} of their time; {transfers}.",
            grouped(machine.bus.slot_clocks),
            percent(shares.bus),
            percent(shares.waiting),
        ),
        Bottleneck::MainProcessor => format!(
            "The main processor limits this machine: it computes {} of the frame and waits {} for its transfers, while the {cores} have nothing to do {} of their time.",
            percent(shares.main_busy),
            percent(shares.main_waiting),
            percent(shares.idle),
        ),
        Bottleneck::Computing => format!(
            "Computing limits this machine: the {cores} compute {} of their time, {}; the bus is busy {} of the frame.",
            percent(shares.busy),
            computing(frame, machine, load),
            percent(shares.bus),
        ),
        Bottleneck::Transfers => format!(
            "The length of transfers limits this machine: the {cores} wait {} of their time for what they read themselves, although the bus is busy only {} of the frame; {transfers}.",
            percent(shares.waiting),
            percent(shares.bus),
        ),
        Bottleneck::Work => format!(
            "Work limits this machine: the {cores} have nothing to do {} of their time, although neither the bus ({}) nor the main processor ({}) is full; the picture has too few pixels, or some take much longer than others.",
            percent(shares.idle),
            percent(shares.bus),
            percent(shares.main_busy + shares.main_waiting),
        ),
    }
}

/// The kind of data that most octets are of.
fn transfers(frame: &RunOutcome) -> String {
    let all: u64 = frame.kinds.iter().map(|kind| kind.octets.0).sum();
    let most = frame.kinds.iter().max_by_key(|kind| kind.octets.0);
    match most.filter(|_| all != 0) {
        Some(kind) => {
            format!("{:.1} % of what is asked for is {}", 100.0 * kind.octets.0 as f64 / all as f64, kind.kind)
        }
        None => "nothing is asked for".to_owned(),
    }
}

/// The class that most clocks of computing are for.
fn computing(frame: &RunOutcome, machine: &Config, load: &Load) -> String {
    let code = Code::new(&load.build.cores, &load.isa, machine.timing());
    let counts = frame.tally.counts(&code);
    let clocks = |class: Class| counts[class].saturating_mul(code.timing.clocks[class]);
    let all: u64 = Class::ALL.iter().map(|&class| clocks(class)).fold(0, u64::saturating_add);
    let most = Class::ALL.iter().copied().max_by_key(|&class| clocks(class)).filter(|_| all != 0);
    most.map_or("without operations that take any".to_owned(), |class| {
        format!("{:.1} % of the operations being {}", 100.0 * clocks(class) as f64 / all as f64, class.name())
    })
}
