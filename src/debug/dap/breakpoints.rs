//! Breakpoints as the protocol sets them: each request replaces all of its kind.

use serde_json::{Value, json};

use super::super::condition::StopCondition;
use super::super::place;
use super::super::session::Session;
use super::super::stop::{Event, Watched};
use super::server::Owned;
use crate::arguments::numbered;
use crate::registers::register_of;

/// Takes the breakpoints of a kind away.
fn forget(session: &mut Session, owned: &mut Owned, kind: &str) {
    for number in owned.remove(kind).unwrap_or_default() {
        session.remove_stop(number);
    }
}

/// Sets one breakpoint of a kind, with the condition and the count of the request.
fn set(
    session: &mut Session,
    owned: &mut Owned,
    kind: &str,
    text: String,
    event: Result<Event, String>,
    wanted: &Value,
) -> Value {
    let added = event.and_then(|event| {
        let text_of = |key: &str| wanted[key].as_str().map(str::trim).filter(|text| !text.is_empty());
        let condition = text_of("condition").map(str::parse::<StopCondition>).transpose()?;
        if let Some(condition) = &condition {
            condition.check(&session.target.program)?;
        }
        let count = match text_of("hitCondition") {
            Some(count) => u64::try_from(numbered(count)?).ok().filter(|count| *count > 0).ok_or("a count is 1 or more")?,
            None => 1,
        };
        let first = match &event {
            Event::At(words) => words.first().copied(),
            Event::Watch(_) => None,
        };
        let number = session.add_stop(text, event, condition, count);
        owned.entry(kind.to_owned()).or_default().push(number);
        let line = first.and_then(|pc| session.target.program.lines.get(pc as usize)).map(|line| line.line);
        Ok(json!({ "verified": true, "id": number, "line": line, "instructionReference": first.map(|pc| format!("{pc:#x}")) }))
    });
    added.unwrap_or_else(|message: String| json!({ "verified": false, "message": message }))
}

fn wanted(arguments: &Value) -> Vec<Value> {
    arguments["breakpoints"].as_array().cloned().unwrap_or_default()
}

/// Breakpoints at lines of a source. A line without an instruction takes the next one that has some.
pub fn of_source(session: &mut Session, owned: &mut Owned, arguments: &Value) -> Result<Value, String> {
    let source = &arguments["source"];
    let name = source["path"].as_str().or(source["name"].as_str()).ok_or("a source with a path is expected")?;
    let kind = format!("source {name}");
    forget(session, owned, &kind);
    let program = &session.target.program;
    let reference = source["sourceReference"].as_u64().unwrap_or(0);
    let sources = match u16::try_from(reference) {
        Ok(number) if number > 0 => vec![number - 1],
        _ => place::sources(program, name),
    };
    let set_one = |session: &mut Session, owned: &mut Owned, wanted: &Value| {
        let program = &session.target.program;
        let line = wanted["line"].as_u64().and_then(|line| u32::try_from(line).ok()).unwrap_or(0);
        let last = program.lines.iter().filter(|at| sources.contains(&at.source)).map(|at| at.line).max().unwrap_or(0);
        let words = (line..=last).find_map(|line| place::lines(program, &sources, line));
        let event = words.map(Event::At).ok_or_else(|| match sources.is_empty() {
            true => format!("the program has no file {name}"),
            false => format!("no instruction stands at line {line} or behind it"),
        });
        set(session, owned, &kind, format!("{name}:{line}"), event, wanted)
    };
    let all: Vec<Value> = wanted(arguments).iter().map(|wanted| set_one(session, owned, wanted)).collect();
    Ok(json!({ "breakpoints": all }))
}

/// Breakpoints at functions, or at any place that the command `break` takes.
pub fn of_functions(session: &mut Session, owned: &mut Owned, arguments: &Value) -> Result<Value, String> {
    forget(session, owned, "functions");
    let all: Vec<Value> = (wanted(arguments).iter())
        .map(|wanted| {
            let name = wanted["name"].as_str().unwrap_or_default();
            let event = place::words(&session.target.program, name, session.pc()).map(Event::At);
            set(session, owned, "functions", name.to_owned(), event, wanted)
        })
        .collect();
    Ok(json!({ "breakpoints": all }))
}

/// Breakpoints at words.
pub fn of_words(session: &mut Session, owned: &mut Owned, arguments: &Value) -> Result<Value, String> {
    forget(session, owned, "words");
    let all: Vec<Value> = (wanted(arguments).iter())
        .map(|wanted| {
            let at = numbered(wanted["instructionReference"].as_str().unwrap_or_default());
            let at = at.map(|at| at.saturating_add(wanted["offset"].as_i64().unwrap_or(0)));
            let event = at.and_then(|at| place::words(&session.target.program, &format!("*{at}"), 0)).map(Event::At);
            let text = wanted["instructionReference"].as_str().unwrap_or_default().to_owned();
            set(session, owned, "words", format!("*{text}"), event, wanted)
        })
        .collect();
    Ok(json!({ "breakpoints": all }))
}

/// Watches of registers.
pub fn of_data(session: &mut Session, owned: &mut Owned, arguments: &Value) -> Result<Value, String> {
    forget(session, owned, "data");
    let all: Vec<Value> = (wanted(arguments).iter())
        .map(|wanted| {
            let name = wanted["dataId"].as_str().unwrap_or_default();
            let register = register_of(&session.target.program, name, session.pc());
            set(
                session,
                owned,
                "data",
                name.to_owned(),
                register.map(|register| Event::Watch(Watched::Register(register))),
                wanted,
            )
        })
        .collect();
    Ok(json!({ "breakpoints": all }))
}

/// Part of a variable that can be watched: a register.
pub fn data_info(session: &Session, arguments: &Value) -> Result<Value, String> {
    let name = arguments["name"].as_str().unwrap_or_default();
    Ok(match register_of(&session.target.program, name, session.pc()) {
        Ok(register) => json!({
            "dataId": crate::registers::name(register),
            "description": format!("{name} changes"),
            "accessTypes": ["write"],
        }),
        Err(message) => json!({ "dataId": null, "description": message }),
    })
}
