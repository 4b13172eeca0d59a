//! Frames, scopes, variables, sources and instructions that a client looks at.

use std::path::Path;

use isa::naming::RegisterId;
use serde_json::{Value, json};

use super::super::session::Session;
use crate::debug::Door;
use crate::registers::{self, ShowRequest, ShownRegister};
use crate::shadow::{register_errors, ulps};
use crate::trace::instruction::{self, TraceClocks};

/// Scopes of a frame, by the lowest digits of their reference.
const SCOPES: [&str; 5] = ["Named", "Scalars", "Vectors", "Wide", "State"];

/// Frames that have references at most.
const MOST_FRAMES: usize = 1 << 16;

/// Words of the frames: where the core is, then the open calls, the innermost first.
fn frames(session: &Session) -> Vec<u32> {
    let calls = session.stepper().calls().iter().rev().map(|call| session.stepper().code.word(call.from));
    [session.pc()].into_iter().chain(calls).take(MOST_FRAMES).collect()
}

/// A source as the protocol names it: by its path where there is such a file, else by a reference to its text.
fn source_of(session: &Session, pc: u32) -> (Value, u32) {
    let program = &session.target.program;
    let Some(line) = program.lines.get(pc as usize) else { return (Value::Null, 0) };
    let Some(source) = program.sources.get(usize::from(line.source)) else { return (Value::Null, 0) };
    let path = Path::new(&source.name);
    let name = path.file_name().map_or_else(|| source.name.clone(), |name| name.to_string_lossy().into_owned());
    // A file that has become another one would show wrong lines.
    let is_file = std::fs::read_to_string(path).is_ok_and(|text| text == source.text);
    let full = std::fs::canonicalize(path).ok().filter(|_| is_file);
    let shown = match full {
        Some(full) => json!({ "name": name, "path": full.to_string_lossy() }),
        None => json!({ "name": name, "path": source.name, "sourceReference": u32::from(line.source) + 1 }),
    };
    (shown, line.line)
}

/// The stack of calls.
pub fn stack(session: &Session, arguments: &Value) -> Value {
    let all = frames(session);
    let from = arguments["startFrame"].as_u64().unwrap_or(0) as usize;
    let levels = arguments["levels"].as_u64().filter(|levels| *levels > 0).map_or(usize::MAX, |levels| levels as usize);
    let program = &session.target.program;
    let frame = |(level, pc): (usize, &u32)| {
        let (source, line) = source_of(session, *pc);
        let name = program.function(*pc).unwrap_or("(no function)");
        let mut frame = json!({
            "id": level + 1, "name": name, "line": line, "column": if line == 0 { 0 } else { 1 },
            "instructionPointerReference": format!("{pc:#x}"),
        });
        if !source.is_null() {
            frame["source"] = source;
        }
        frame
    };
    let shown: Vec<Value> = all.iter().enumerate().skip(from).take(levels).map(frame).collect();
    json!({ "stackFrames": shown, "totalFrames": all.len() })
}

/// Word of a frame by its number, from 1 on; 0 means the innermost.
///
/// # Errors
/// There is no such frame.
fn frame_word(session: &Session, frame: u64) -> Result<u32, String> {
    let at = usize::try_from(frame.max(1) - 1).ok().and_then(|at| frames(session).get(at).copied());
    at.ok_or_else(|| "there is no such frame".into())
}

/// The scopes of a frame.
///
/// # Errors
/// There is no such frame.
pub fn scopes(session: &Session, arguments: &Value) -> Result<Value, String> {
    let frame = arguments["frameId"].as_u64().unwrap_or(1);
    frame_word(session, frame)?;
    let scope = |(number, name): (usize, &&str)| {
        let hint = if number == 0 { "locals" } else { "registers" };
        json!({ "name": name, "presentationHint": hint, "variablesReference": frame * 8 + number as u64 + 1, "expensive": false })
    };
    Ok(json!({ "scopes": SCOPES.iter().enumerate().map(scope).collect::<Vec<_>>() }))
}

/// A register as a variable: raw, real, and with a shadow how far it is from exact arithmetic.
fn variable(session: &Session, name: &str, shown: &ShownRegister, register: Option<RegisterId>) -> Value {
    let real = shown.real_text();
    let mut value = if real.is_empty() { shown.raw.raw_text() } else { format!("{} ({real})", shown.raw.raw_text()) };
    if let Some(errors) = register.and_then(|register| register_errors(session.stepper(), register)) {
        let errors: Vec<String> = errors.iter().filter(|error| !error.is_nan()).map(|error| ulps(*error)).collect();
        // An integer has no shadow.
        if !errors.is_empty() {
            value += &format!(", error {} ulp", errors.join(":"));
        }
    }
    json!({ "name": name, "value": value, "type": shown.hexadecimal, "evaluateName": shown.register, "variablesReference": 0 })
}

/// The variables of a scope.
///
/// # Errors
/// A reference that is none.
pub fn variables(session: &Session, arguments: &Value) -> Result<Value, String> {
    let reference = arguments["variablesReference"].as_u64().unwrap_or(0);
    // A reference is 8 * frame + scope, so the vectors (scope 3) of frame 2 have 19.
    let (frame, scope) = (reference / 8, (reference % 8) as usize);
    let pc = frame_word(session, frame)?;
    let (program, state) = (&session.target.program, session.stepper().state());
    // Calls keep no registers: an outer frame shows those of now, by the names that hold there.
    let shown = |register| ShownRegister::at(program, &state.registers, register, pc);
    let variable = |name: &str, register| variable(session, name, &shown(register), Some(register));
    let of_file = |file: char| -> Vec<Value> {
        let own =
            registers::all(&state.registers).filter(|((other, _), contents)| *other == file && !contents.is_zero());
        own.map(|(register, _)| variable(&registers::name(register), register)).collect()
    };
    let all = match scope {
        1 => {
            let here = program.register_names.iter().filter(|named| named.words.contains(&pc));
            here.map(|named| variable(&named.name, named.register)).collect()
        }
        2 => of_file('s'),
        3 => of_file('v'),
        4 => of_file('w'),
        5 => {
            let plain = |name: &str, value: String| json!({ "name": name, "value": value, "variablesReference": 0 });
            let mut all = vec![plain("step", session.position().to_string()), plain("pc", format!("{pc:#x}"))];
            if session.target.clocks == TraceClocks::Own {
                all.push(plain("clock", session.stepper().clock().0.to_string()));
            }
            all
        }
        _ => return Err("there is no such scope".into()),
    };
    Ok(json!({ "variables": all }))
}

/// Changes a register.
///
/// # Errors
/// A name or a value that there is not.
pub fn set_variable(door: &mut Door, arguments: &Value) -> Result<Value, String> {
    let name = arguments["name"].as_str().unwrap_or_default();
    let value = arguments["value"].as_str().unwrap_or_default();
    door.execute(&format!("set {name}={value}"))?;
    let (shown, register) = shown(&door.session, name)?;
    let changed = variable(&door.session, name, &shown, register);
    Ok(json!({ "value": changed["value"], "type": changed["type"] }))
}

fn shown(session: &Session, text: &str) -> Result<(ShownRegister, Option<RegisterId>), String> {
    let request: ShowRequest = text.parse()?;
    let (program, pc) = (&session.target.program, session.pc());
    let shown = request.shown(program, &session.stepper().state().registers, pc)?;
    let register = request.register(program, pc).filter(|register| registers::name(*register) == shown.register);
    Ok((shown, register))
}

/// The value of a register, or what a command of the debugger says.
///
/// # Errors
/// What is neither.
pub fn evaluate(door: &mut Door, arguments: &Value) -> Result<Value, String> {
    let text = arguments["expression"].as_str().unwrap_or_default().trim();
    if let Ok((shown, register)) = shown(&door.session, text) {
        let found = variable(&door.session, text, &shown, register);
        return Ok(json!({ "result": found["value"], "type": found["type"], "variablesReference": 0 }));
    }
    // Only the console may move; a hover over a word that is a command must not.
    match arguments["context"].as_str() {
        Some("hover" | "watch" | "variables") => Err(format!("`{text}` is no register here")),
        _ => door.execute(text).map(|answer| json!({ "result": answer.text.trim_end(), "variablesReference": 0 })),
    }
}

/// The text of a source that is no file here.
///
/// # Errors
/// A reference that is none.
pub fn source(session: &Session, arguments: &Value) -> Result<Value, String> {
    let reference =
        arguments["sourceReference"].as_u64().or(arguments["source"]["sourceReference"].as_u64()).unwrap_or(0);
    let source = (reference as usize).checked_sub(1).and_then(|number| session.target.program.sources.get(number));
    let source = source.ok_or("there is no such source")?;
    Ok(json!({ "content": source.text, "mimeType": "text/x-asm" }))
}

/// Instructions around a word.
///
/// # Errors
/// A reference that is no number.
pub fn disassemble(session: &Session, arguments: &Value) -> Result<Value, String> {
    let base = crate::arguments::numbered(arguments["memoryReference"].as_str().unwrap_or_default())?;
    let count = i128::from(arguments["instructionCount"].as_u64().unwrap_or(0).min(4096));
    // A client may ask for what lies far before the first word.
    let number = |key: &str| i128::from(arguments[key].as_i64().unwrap_or(0));
    let first = i128::from(base) + number("offset") + number("instructionOffset");
    let program = &session.target.program;
    let line = |at: i128| {
        let word = u32::try_from(at).ok().filter(|&pc| (pc as usize) < program.words.len());
        // As many as were asked for are expected, also where there are none.
        let Some(pc) = word else {
            return json!({ "address": format!("{:#x}", at.max(0)), "instruction": "", "presentationHint": "invalid" });
        };
        let (source, line) = source_of(session, pc);
        let mut shown = json!({
            "address": format!("{pc:#x}"), "instructionBytes": format!("{:08x}", program.words[pc as usize]),
            "instruction": instruction::text(&session.stepper().code, pc), "line": line,
        });
        if !source.is_null() {
            shown["location"] = source;
        }
        if let Some(name) = program.function(pc) {
            shown["symbol"] = name.into();
        }
        shown
    };
    Ok(json!({ "instructions": (first..first + count).map(line).collect::<Vec<_>>() }))
}
