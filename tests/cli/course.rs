//! One core for the debugger, the trace and the explanation of a pixel, with transfers that are those of the replayed machine.

use serde_json::{Value, json};

use super::debug::{PIXEL, pixel};
use super::session::Session;

#[test]
fn a_pixel_has_one_course_for_the_debugger_its_trace_and_the_replayed_machine() {
    let session = Session::new();
    // The debugger and the trace: the same instructions and the same registers, whatever the threads.
    let trace = session.succeed(&format!("trace {PIXEL} --instructions - --json"));
    let records: Vec<Value> = trace.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let target = pixel();
    let mut stepper = target.stepper().unwrap();
    for record in &records {
        let pc = stepper.code.word(stepper.state().pc);
        assert_eq!((record["step"].as_u64(), record["pc"].as_u64()), (Some(stepper.steps()), Some(pc.into())));
        let executed = stepper.step().unwrap();
        let transfer = executed.transfer.map(
            |transfer| json!({ "address": transfer.address, "octets": transfer.octets, "kind": transfer.kind.name() }),
        );
        assert_eq!(record["transfer"], transfer.unwrap_or(Value::Null));
    }
    assert!(stepper.end().is_some());
    for threads in [1, 2] {
        assert_eq!(session.succeed(&format!("trace {PIXEL} --instructions - --json --threads {threads}")), trace);
    }
    // The machine: what the pixel's core moves over the bus are those transfers, in their order.
    session.succeed(&format!("trace {PIXEL} --perfetto bus.json"));
    let bus: Value = serde_json::from_slice(&session.read("bus.json")).unwrap();
    let mut moved: Vec<(f64, u64, u64)> = bus["traceEvents"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|event| {
            let arguments = &event["args"];
            let is_read = event["name"].as_str()?.starts_with("core 0 reads ");
            is_read.then(|| {
                (
                    event["ts"].as_f64().unwrap(),
                    arguments["address"].as_u64().unwrap(),
                    arguments["octets"].as_u64().unwrap(),
                )
            })
        })
        .collect();
    moved.sort_by(|a, b| a.0.total_cmp(&b.0));
    let asked: Vec<(u64, u64)> = records
        .iter()
        .map(|record| &record["transfer"])
        .filter(|transfer| transfer["kind"] == "load" || transfer["kind"] == "read")
        .map(|transfer| (transfer["address"].as_u64().unwrap(), transfer["octets"].as_u64().unwrap()))
        .filter(|(_, octets)| *octets > 0)
        .collect();
    let moved: Vec<(u64, u64)> = moved.into_iter().map(|(_, address, octets)| (address, octets)).collect();
    assert!(asked.len() > 20, "{}", asked.len());
    assert_eq!(moved, asked);
}
