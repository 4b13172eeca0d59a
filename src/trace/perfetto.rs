//! A window as Chrome trace events (JSON), which <https://ui.perfetto.dev> and chrome://tracing read: a track a core with
//! its pixels and what it does in them, one for the main processor, one for the bus.

use emu::machine::trace::Doing;
use emu::quantity::Clocks;
use serde_json::{Value, json};

use super::{Scene, address};

/// The file.
pub fn perfetto(scene: &Scene) -> String {
    let bus = scene.trace.processors.len();
    let mut events = vec![metadata("process_name", 0, &format!("lancer: {}", scene.name))];
    for number in 0..bus {
        events.push(metadata("thread_name", number, &scene.processor(number)));
    }
    events.push(metadata("thread_name", bus, "bus"));
    // Viewers nest what lies within something else, when that comes first.
    let slice = |track: usize, name: String, start: Clocks, end: Clocks, more: Value| {
        let window = scene.trace.window;
        let (start, end) = (start.max(window.start), end.min(window.end));
        let microseconds = |clocks: Clocks| clocks.0 as f64 * 1e6 / scene.clock_hz as f64;
        json!({
            "ph": "X", "pid": 1, "tid": track, "name": name, "ts": microseconds(start),
            "dur": microseconds(end - start), "args": more,
        })
    };
    for item in scene.items() {
        let more = json!({ "first clock": item.start.0, "clock after": item.end.0, "instructions": item.instructions });
        events.push(slice(item.core as usize, format!("pixel {}", item.subject[0]), item.start, item.end, more));
    }
    for (number, spans) in scene.trace.processors.iter().enumerate() {
        for span in spans {
            let more = json!({ "clocks": (span.end - span.start).0 });
            events.push(slice(number, word(span.doing).to_owned(), span.start, span.end, more));
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
    let file = json!({ "displayTimeUnit": "ns", "traceEvents": events });
    format!("{file}\n")
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
