//! A window as Chrome trace events (JSON), which <https://ui.perfetto.dev> and chrome://tracing read: a track a core with
//! its pixels and what it does in them, one for the main processor, one for the bus, and one a core with its functions.

use emu::machine::trace::Doing;
use emu::quantity::Clocks;
use serde_json::{Value, json};

use super::{FunctionSlice, TracedScene, address};

/// The file. `functions` has the outer before the inner ones.
pub fn perfetto(scene: &TracedScene, functions: &[FunctionSlice]) -> String {
    let processors = scene.trace.processors.len();
    let bus = track(processors);
    let mut events = vec![metadata("process_name", track(0), &format!("lancer: {}", scene.name))];
    for number in 0..processors {
        events.push(metadata("thread_name", track(number), &scene.processor(number)));
    }
    events.push(metadata("thread_name", bus, "bus"));
    // Viewers nest what lies within something else, when that comes first.
    let slice = |track: usize, name: String, start: Clocks, end: Clocks, more: Value| {
        let window = scene.trace.window;
        let at = |clock: Clocks| nanoseconds(clock.clamp(window.start, window.end), scene.clock_hz);
        let (start, end) = (at(start), at(end));
        json!({
            "ph": "X", "pid": 1, "tid": track, "name": name, "ts": microseconds(start),
            "dur": microseconds(end - start), "args": more,
        })
    };
    for item in scene.items() {
        let more = json!({ "first clock": item.start.0, "clock after": item.end.0, "instructions": item.instructions });
        events.push(slice(track(item.core as usize), format!("pixel {}", item.subject[0]), item.start, item.end, more));
    }
    for (number, spans) in scene.trace.processors.iter().enumerate() {
        for span in spans {
            let more = json!({ "clocks": (span.end - span.start).0 });
            events.push(slice(track(number), word(span.doing).to_owned(), span.start, span.end, more));
        }
    }
    let window = scene.trace.window;
    for burst in scene.trace.bursts.iter().filter(|burst| burst.start < window.end && burst.end > window.start) {
        let master = scene.processor(burst.master as usize);
        let more = json!({
            "octets": burst.octets.0, "address": address(burst.cargo), "clocks waited": (burst.start - burst.asked).0,
        });
        events.push(slice(bus, format!("{master} {}", scene.cargo(burst.cargo)), burst.start, burst.end, more));
    }
    // Of what is open at the same time, the outer slice has been told first, and all have the ends of whole nanoseconds.
    let track_of = |core: u32| bus + 1 + core as usize;
    for core in 0..scene.cores() as u32 {
        events.push(metadata("thread_name", track_of(core), &format!("{} functions", scene.processor(core as usize))));
    }
    for function in functions {
        let FunctionSlice { core, start, end, .. } = *function;
        let more = json!({ "clocks": (end - start).0 });
        let slice = slice(track_of(core), function.name.clone(), start, end, more);
        // At 2 GHz two clocks may begin in one nanosecond.
        if slice["dur"] != json!(0.0) {
            events.push(slice);
        }
    }
    let file = json!({ "displayTimeUnit": "ns", "traceEvents": events });
    format!("{file}\n")
}

/// Thread of a processor or, behind the last one, of the bus; viewers take thread 0 for the idle task of a system.
fn track(number: usize) -> usize {
    number + 1
}

/// Beginning of a clock in nanoseconds, rounded down: viewers count in these, so that one clock's end is the next one's start.
///
/// Clocks 1, 2 and 3 of 48 MHz begin at 20, 41 and 62; those of 2 GHz at 0, 1 and 1.
fn nanoseconds(clock: Clocks, clock_hz: u64) -> u64 {
    (u128::from(clock.0) * 1_000_000_000 / u128::from(clock_hz)) as u64
}

/// Microseconds that give a number of nanoseconds below 2^48 again when a viewer multiplies them by 1000 and rounds or cuts off.
///
/// 1001 ns are 1.001 us, but that times 1000 is 1000.9999999999999 for a double. The four units more in the last place of a double also
/// outlast readers of numbers that are not exact.
fn microseconds(nanoseconds: u64) -> f64 {
    let nearest = nanoseconds as f64 / 1e3;
    if nanoseconds.is_multiple_of(1000) { nearest } else { nearest * (1.0 + 4.0 * f64::EPSILON) }
}

/// Word for a processor's state.
fn word(doing: Doing) -> &'static str {
    match doing {
        Doing::Busy => "busy",
        Doing::Waiting => "waiting",
        Doing::Idle => "idle",
    }
}

fn metadata(what: &str, track: usize, name: &str) -> Value {
    json!({ "ph": "M", "pid": 1, "tid": track, "name": what, "args": { "name": name } })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viewers_find_the_nanoseconds_again() {
        for nanoseconds in (0..20_000).chain((1 << 40)..(1 << 40) + 20_000).chain((1 << 48) - 20_000..1 << 48) {
            let written = microseconds(nanoseconds);
            for read in [written, written.next_up(), written.next_down()] {
                let whole = nanoseconds.is_multiple_of(1000);
                let scaled = if whole { written } else { read } * 1e3;
                assert_eq!((scaled as u64, scaled.round() as u64), (nanoseconds, nanoseconds));
            }
        }
    }

    #[test]
    fn clocks_begin_at_whole_nanoseconds_in_order() {
        let starts = |clock_hz| [1, 2, 3].map(|clock| nanoseconds(Clocks(clock), clock_hz));
        assert_eq!(starts(48_000_000), [20, 41, 62]);
        assert_eq!(starts(100_000_000), [10, 20, 30]);
        assert_eq!(starts(2_000_000_000), [0, 1, 1]);
    }
}
