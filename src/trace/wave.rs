//! A window as an FST wave, which GTKWave and Surfer read: the bus with owner and address, and each processor with its
//! request, its grant, its state and its pixel.

use std::collections::BTreeMap;

use emu::machine::trace::{Cargo, Doing};
use emu::quantity::Clocks;
use fst_writer::{
    FstBodyWriter, FstFileType, FstHeaderWriter, FstInfo, FstScopeType, FstSignalId, FstSignalType, FstVarDirection,
    FstVarType,
};
use messages::{Diagnostic, Report};

use super::{TracedScene, address};

type Octets = std::io::Cursor<Vec<u8>>;

/// Bits of numbers: owner, octets, addresses, pixels.
const NUMBER: u32 = 32;

/// Value that a signal shows while it has none.
const NONE: &[u8] = &[b'z'; NUMBER as usize];

/// The file.
///
/// # Errors
/// None that a user could make: it is written in memory.
pub fn wave(scene: &TracedScene) -> Result<Vec<u8>, Report> {
    write(scene).map_err(|error| Diagnostic::error(format!("no wave can be written: {error}")).into())
}

fn write(scene: &TracedScene) -> fst_writer::Result<Vec<u8>> {
    let scale = Scale::new(scene.clock_hz);
    let info = FstInfo {
        // Viewers add this to every time; the times of the changes are those of the run already.
        start_time: 0,
        timescale_exponent: scale.exponent,
        version: concat!("lancer ", env!("CARGO_PKG_VERSION")).to_owned(),
        // Equal runs give equal octets.
        date: String::new(),
        file_type: FstFileType::Verilog,
    };
    let mut header = FstHeaderWriter::<Octets>::write_to_mem(&info)?;
    let signals = declare(scene, &mut header)?;
    play(scene, &scale, &signals, header.finish()?)
}

/// Conversion of clocks to times of the file.
struct Scale {
    clock_hz: u64,
    /// Times are in units of 10 to this power, in seconds.
    exponent: i8,
}

impl Scale {
    /// A unit is a clock where that is a power of ten, else a picosecond.
    fn new(clock_hz: u64) -> Scale {
        let digits = clock_hz.ilog10();
        let is_power = clock_hz == 10_u64.pow(digits);
        Scale { clock_hz, exponent: if is_power { -(digits as i8) } else { -12 } }
    }

    fn time(&self, clock: Clocks) -> u64 {
        let units = 10_u128.pow(u32::from(self.exponent.unsigned_abs()));
        (u128::from(clock.0) * units / u128::from(self.clock_hz)) as u64
    }
}

/// Signals of the file.
struct Signals {
    busy: FstSignalId,
    owner: FstSignalId,
    address: FstSignalId,
    write: FstSignalId,
    octets: FstSignalId,
    processors: Vec<Lines>,
}

/// Signals of a processor.
struct Lines {
    request: FstSignalId,
    grant: FstSignalId,
    /// 0 idle, 1 busy, 2 waiting for the bus.
    state: FstSignalId,
    pixel: Option<FstSignalId>,
}

fn declare(scene: &TracedScene, header: &mut FstHeaderWriter<Octets>) -> fst_writer::Result<Signals> {
    let signal = |header: &mut FstHeaderWriter<Octets>, name: &str, bits: u32| {
        header.var(name, FstSignalType::bit_vec(bits), FstVarType::Wire, FstVarDirection::Implicit, None)
    };
    header.scope("bus", "", FstScopeType::Module)?;
    let busy = signal(header, "busy", 1)?;
    let owner = signal(header, "owner", NUMBER)?;
    let address = signal(header, "address", NUMBER)?;
    let write = signal(header, "write", 1)?;
    let octets = signal(header, "octets", NUMBER)?;
    header.up_scope()?;
    let mut processors = Vec::new();
    for number in 0..scene.trace.processors.len() {
        header.scope(scene.processor(number).replace(' ', ""), "", FstScopeType::Module)?;
        processors.push(Lines {
            request: signal(header, "request", 1)?,
            grant: signal(header, "grant", 1)?,
            state: signal(header, "state", 2)?,
            pixel: if number < scene.cores() { Some(signal(header, "pixel", NUMBER)?) } else { None },
        });
        header.up_scope()?;
    }
    Ok(Signals { busy, owner, address, write, octets, processors })
}

/// Changes by time and signal: a later note for the same time and signal replaces an earlier one.
#[derive(Default)]
struct Changes(BTreeMap<(u64, FstSignalId), Vec<u8>>);

impl Changes {
    fn bit(&mut self, time: u64, signal: FstSignalId, value: bool) {
        self.0.insert((time, signal), vec![if value { b'1' } else { b'0' }]);
    }

    fn number(&mut self, time: u64, signal: FstSignalId, value: Option<u32>) {
        let bits = value.map_or(NONE.to_vec(), |value| format!("{value:032b}").into_bytes());
        self.0.insert((time, signal), bits);
    }
}

fn play(
    scene: &TracedScene,
    scale: &Scale,
    signals: &Signals,
    mut body: FstBodyWriter<Octets>,
) -> fst_writer::Result<Vec<u8>> {
    let window = scene.trace.window;
    let first = scale.time(window.start);
    let at = |clock: Clocks| scale.time(clock.clamp(window.start, window.end));
    let mut changes = Changes::default();
    // Nothing happens at first, then things end, then things begin: what begins when something ends replaces the end.
    for signal in [signals.busy, signals.write] {
        changes.bit(first, signal, false);
    }
    for signal in [signals.owner, signals.address, signals.octets] {
        changes.number(first, signal, None);
    }
    for lines in &signals.processors {
        changes.bit(first, lines.request, false);
        changes.bit(first, lines.grant, false);
        changes.0.insert((first, lines.state), b"00".to_vec());
        if let Some(pixel) = lines.pixel {
            changes.number(first, pixel, None);
        }
    }
    // Things that end.
    let bursts = || scene.trace.bursts.iter().filter(|burst| burst.start < window.end && burst.end > window.start);
    let pixel = |core: u32| signals.processors[core as usize].pixel;
    for burst in bursts().filter(|burst| burst.end < window.end) {
        let end = at(burst.end);
        changes.bit(end, signals.busy, false);
        changes.bit(end, signals.write, false);
        for signal in [signals.owner, signals.address, signals.octets] {
            changes.number(end, signal, None);
        }
        changes.bit(end, signals.processors[burst.master as usize].grant, false);
    }
    for burst in scene.trace.bursts.iter().filter(|burst| burst.start < window.end && burst.start >= window.start) {
        changes.bit(at(burst.start), signals.processors[burst.master as usize].request, false);
    }
    for item in scene.items().filter(|item| item.end < window.end) {
        if let Some(signal) = pixel(item.core) {
            changes.number(at(item.end), signal, None);
        }
    }
    // Things that begin.
    for burst in bursts() {
        let start = at(burst.start);
        changes.bit(start, signals.busy, true);
        changes.bit(start, signals.write, matches!(burst.cargo, Cargo::Write(_)));
        changes.number(start, signals.owner, Some(burst.master));
        changes.number(start, signals.address, address(burst.cargo));
        changes.number(start, signals.octets, Some(burst.octets.0 as u32));
        changes.bit(start, signals.processors[burst.master as usize].grant, true);
    }
    // Who gets the bus at once asks for no time.
    for burst in scene.trace.bursts.iter().filter(|burst| burst.asked < burst.start && burst.asked < window.end) {
        if burst.start > window.start {
            changes.bit(at(burst.asked), signals.processors[burst.master as usize].request, true);
        }
    }
    for item in scene.items() {
        if let Some(signal) = pixel(item.core) {
            changes.number(at(item.start), signal, Some(item.subject[0] as u32));
        }
    }
    // States of processors, which have no gaps.
    for (lines, spans) in signals.processors.iter().zip(&scene.trace.processors) {
        for span in spans {
            let state: &[u8] = match span.doing {
                Doing::Idle => b"00",
                Doing::Busy => b"01",
                Doing::Waiting => b"10",
            };
            changes.0.insert((at(span.start), lines.state), state.to_vec());
        }
    }
    // Write the changes in the order of their times, each time once.
    let mut now = None;
    for ((time, signal), value) in &changes.0 {
        if now != Some(*time) {
            body.time_change(*time)?;
            now = Some(*time);
        }
        body.signal_change(*signal, value)?;
    }
    // The file ends with the window even where nothing changes there.
    let end = scale.time(window.end);
    if now.is_none_or(|now| now < end) {
        body.time_change(end)?;
    }
    Ok(body.finish()?.into_inner())
}
