//! The door for editors: the Debug Adapter Protocol on any pair of streams. One thread, the core, which also goes back.

mod breakpoints;
mod inspect;
mod server;
mod wire;

use std::io::{self, BufRead, Write};

use serde_json::{Value, json};

use super::{DebugTarget, Door, Session};
use server::Server;

/// Makes what is debugged of the arguments of a launch request.
pub type Launch<'a> = &'a dyn Fn(&Value) -> Result<DebugTarget, String>;

/// Abilities of the adapter.
fn capabilities() -> Value {
    json!({
        "supportsConfigurationDoneRequest": true,
        "supportsFunctionBreakpoints": true,
        "supportsConditionalBreakpoints": true,
        "supportsHitConditionalBreakpoints": true,
        "supportsEvaluateForHovers": true,
        "supportsStepBack": true,
        "supportsSetVariable": true,
        "supportsSteppingGranularity": true,
        "supportsInstructionBreakpoints": true,
        "supportsDataBreakpoints": true,
        "supportsDisassembleRequest": true,
        "supportsTerminateRequest": true,
        "exceptionBreakpointFilters": [
            { "filter": "overflowed", "label": "Results that do not fit", "default": false },
            { "filter": "quantized", "label": "Results that lose bits", "default": false },
        ],
    })
}

/// Serves one client until it goes away. What is debugged is `given`, or comes with the launch request.
///
/// # Errors
/// A stream that breaks, or carries something else.
pub fn serve(
    input: &mut dyn BufRead,
    output: &mut dyn Write,
    given: Option<DebugTarget>,
    launch: Launch,
) -> io::Result<()> {
    let mut server = Server::new(output);
    let mut given = given;
    // Before the launch there is nothing to debug.
    let (target, stops_on_entry) = loop {
        let Some(request) = wire::read(input)? else { return Ok(()) };
        let arguments = &request["arguments"];
        match request["command"].as_str().unwrap_or_default() {
            "initialize" => server.respond(&request, Ok(capabilities()))?,
            "launch" | "attach" => {
                let target = match given.take() {
                    Some(target) => Ok(target),
                    None => launch(arguments),
                };
                match target.and_then(|target| {
                    target.stepper().map(|_| ()).map_err(|report| report.render(false)).map(|()| target)
                }) {
                    Ok(target) => {
                        server.respond(&request, Ok(Value::Null))?;
                        server.event("initialized", json!({}))?;
                        break (target, arguments["stopOnEntry"].as_bool().unwrap_or(false));
                    }
                    Err(message) => server.respond(&request, Err(message))?,
                }
            }
            "disconnect" | "terminate" => return server.respond(&request, Ok(Value::Null)),
            command => server.respond(&request, Err(format!("`{command}` comes before `launch`")))?,
        }
    };
    let session = Session::new(&target).map_err(|report| io::Error::other(report.render(false)))?;
    server.serve(input, Door::new(session), stops_on_entry)
}
