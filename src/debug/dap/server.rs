//! Requests on a session: each gets its response, and motions an event behind it.

use std::collections::BTreeMap;
use std::io::{self, BufRead, Write};

use serde_json::{Value, json};

use super::super::motion::{back_next, back_step, line_next, line_step, out};
use super::super::session::{Lossy, Session, StopReason};
use super::super::stop::Event;
use super::{breakpoints, inspect, wire};
use crate::debug::Door;

/// The only thread.
pub(super) const THREAD: u32 = 1;

/// The answering side of the protocol.
pub(super) struct Server<'o> {
    output: &'o mut dyn Write,
    next_seq: u64,
}

/// Kinds of breakpoints that a request replaces as a whole, with the numbers of their stop points.
pub(super) type Owned = BTreeMap<String, Vec<u32>>;

impl<'o> Server<'o> {
    /// A server that has said nothing.
    pub fn new(output: &'o mut dyn Write) -> Server<'o> {
        Server { output, next_seq: 1 }
    }

    fn send(&mut self, mut message: Value) -> io::Result<()> {
        message["seq"] = self.next_seq.into();
        self.next_seq += 1;
        wire::write(self.output, &message)
    }

    /// Answers a request: with a body, or with the reason for which it failed.
    pub fn respond(&mut self, request: &Value, result: Result<Value, String>) -> io::Result<()> {
        let mut message = json!({
            "type": "response",
            "request_seq": request["seq"],
            "command": request["command"],
            "success": result.is_ok(),
        });
        match result {
            Ok(Value::Null) => {}
            Ok(body) => message["body"] = body,
            Err(reason) => {
                message["body"] = json!({ "error": { "id": 1, "format": reason, "showUser": true } });
                message["message"] = reason.into();
            }
        }
        self.send(message)
    }

    /// Tells the client of an event.
    pub fn event(&mut self, name: &str, body: Value) -> io::Result<()> {
        self.send(json!({ "type": "event", "event": name, "body": body }))
    }

    /// Serves a session until the client goes away.
    pub fn serve(&mut self, input: &mut dyn BufRead, mut door: Door, stops_on_entry: bool) -> io::Result<()> {
        let mut owned = Owned::new();
        while let Some(request) = wire::read(input)? {
            let command = request["command"].as_str().unwrap_or_default().to_owned();
            let arguments = &request["arguments"];
            match command.as_str() {
                "disconnect" | "terminate" => {
                    self.respond(&request, Ok(Value::Null))?;
                    self.event("terminated", json!({}))?;
                    if command == "disconnect" {
                        return Ok(());
                    }
                }
                "configurationDone" => {
                    self.respond(&request, Ok(Value::Null))?;
                    if stops_on_entry {
                        self.stopped(&door, &StopReason::Start, "entry")?;
                    } else {
                        self.go_on(&mut door)?;
                    }
                }
                "continue" => {
                    self.respond(&request, Ok(json!({ "allThreadsContinued": true })))?;
                    self.go_on(&mut door)?;
                }
                "reverseContinue" => {
                    self.motion(&request, &mut door, "step", |session| session.run_back(&mut |_, _| false))?
                }
                "next" | "stepIn" | "stepOut" | "stepBack" => {
                    let is_instruction = arguments["granularity"] == "instruction";
                    let motion: fn(&mut Session) -> StopReason = match (command.as_str(), is_instruction) {
                        ("next", false) => line_next,
                        ("stepIn", false) => line_step,
                        ("stepBack", false) if arguments["into"] == true => back_step,
                        ("stepBack", false) => back_next,
                        ("stepBack", true) => |session| session.go_to(session.position().saturating_sub(1)),
                        ("stepOut", _) => out,
                        _ => |session| session.go_to(session.position() + 1),
                    };
                    self.motion(&request, &mut door, "step", motion)?;
                }
                "pause" => {
                    self.respond(&request, Ok(Value::Null))?;
                    self.stopped(&door, &StopReason::Done, "pause")?;
                }
                "evaluate" => {
                    let before = door.session.position();
                    let result = inspect::evaluate(&mut door, arguments);
                    self.respond(&request, result)?;
                    // A command of the console may have moved the core.
                    if door.session.position() != before {
                        self.stopped(&door, &StopReason::Done, "goto")?;
                    }
                }
                _ => {
                    let result = match command.as_str() {
                        "setBreakpoints" => breakpoints::of_source(&mut door.session, &mut owned, arguments),
                        "setFunctionBreakpoints" => breakpoints::of_functions(&mut door.session, &mut owned, arguments),
                        "setInstructionBreakpoints" => breakpoints::of_words(&mut door.session, &mut owned, arguments),
                        "setDataBreakpoints" => breakpoints::of_data(&mut door.session, &mut owned, arguments),
                        "dataBreakpointInfo" => breakpoints::data_info(&door.session, arguments),
                        "setExceptionBreakpoints" => {
                            let has = |name: &str| {
                                arguments["filters"].as_array().is_some_and(|all| all.iter().any(|one| one == name))
                            };
                            door.session.lossy = Lossy { quantized: has("quantized"), overflowed: has("overflowed") };
                            Ok(json!({}))
                        }
                        "threads" => Ok(json!({ "threads": [{ "id": THREAD, "name": door.session.target.name }] })),
                        "stackTrace" => Ok(inspect::stack(&door.session, arguments)),
                        "scopes" => inspect::scopes(&door.session, arguments),
                        "variables" => inspect::variables(&door.session, arguments),
                        "setVariable" => inspect::set_variable(&mut door, arguments),
                        "source" => inspect::source(&door.session, arguments),
                        "disassemble" => inspect::disassemble(&door.session, arguments),
                        other => Err(format!("`{other}` is no request that is known here")),
                    };
                    self.respond(&request, result)?;
                }
            }
        }
        Ok(())
    }

    fn motion(
        &mut self,
        request: &Value,
        door: &mut Door,
        reason: &str,
        motion: impl FnOnce(&mut Session) -> StopReason,
    ) -> io::Result<()> {
        self.respond(request, Ok(json!({ "allThreadsContinued": true })))?;
        door.session.begin();
        let met = motion(&mut door.session);
        self.stopped(door, &met, reason)
    }

    /// Goes on to the next stop. The program's end is a stop, too, since one can go back from it; going on from there ends the session.
    fn go_on(&mut self, door: &mut Door) -> io::Result<()> {
        if door.session.stepper().end().is_some() {
            self.event("exited", json!({ "exitCode": i32::from(door.session.stepper().trap().is_some()) }))?;
            return self.event("terminated", json!({}));
        }
        door.session.begin();
        let reason = door.session.run(&mut |_, _| false);
        self.stopped(door, &reason, "step")
    }

    /// Tells why the core stands still; `plain` is the protocol's word for a motion that went as far as it was to go.
    fn stopped(&mut self, door: &Door, reason: &StopReason, plain: &str) -> io::Result<()> {
        let stops = door.session.stops();
        let (word, numbers) = match reason {
            StopReason::Met(numbers) => {
                let is_watch = |number: &u32| {
                    stops.iter().any(|stop| stop.number == *number && matches!(stop.event, Event::Watch(_)))
                };
                (if numbers.iter().all(is_watch) { "data breakpoint" } else { "breakpoint" }, numbers.clone())
            }
            StopReason::Lossy | StopReason::Trapped => ("exception", Vec::new()),
            StopReason::Halted => ("pause", Vec::new()),
            StopReason::Start if plain != "entry" => ("step", Vec::new()),
            _ => (plain, Vec::new()),
        };
        let said = door.reason(reason);
        let mut body = json!({ "reason": word, "threadId": THREAD, "allThreadsStopped": true });
        if !numbers.is_empty() {
            body["hitBreakpointIds"] = json!(numbers);
        }
        if !said.is_empty() {
            body["description"] = said.clone().into();
            body["text"] = said.clone().into();
        }
        if matches!(reason, StopReason::Halted | StopReason::Trapped | StopReason::Start) && plain != "entry" {
            self.event("output", json!({ "category": "console", "output": format!("{said}\n") }))?;
        }
        self.event("stopped", body)
    }
}
