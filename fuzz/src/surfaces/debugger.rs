//! Doors of the debugger: its commands, and messages of editors.

use std::io::Cursor;
use std::sync::LazyLock;

use emu::machine::Config;
use emu::octets::Memory;
use isa::{Isa, Program};
use lancer::debug::{COMMANDS, DebugCommand, DebugTarget, Door, Session, dap};
use messages::Source;

use crate::project::{files, listings, literals, pieces};
use crate::seen::{PlantedFault, Seen};
use crate::surface::{InputForm, Surface};

const LONGEST: usize = 1500;

/// Most commands of an input that are carried out.
const COMMANDS_A_RUN: usize = 24;

/// Commands of the debugger, a line each.
pub const DEBUGGER: Surface = Surface {
    name: "debugger",
    form: InputForm::Text,
    longest: LONGEST,
    memory: 64 << 20,
    seeds: commands,
    run: command,
    reader: &[
        "src/debug/door.rs",
        "src/debug/command.rs",
        "src/debug/condition.rs",
        "src/debug/place.rs",
        "src/debug/memory.rs",
        "src/debug/stop.rs",
    ],
};

/// Messages of an editor, a line each; or a stream with heads, where the first line is one.
pub const DAP: Surface = Surface {
    name: "dap",
    form: InputForm::Text,
    longest: LONGEST,
    memory: 64 << 20,
    seeds: requests,
    run: serve,
    reader: &[
        "src/debug/dap/wire.rs",
        "src/debug/dap/server.rs",
        "src/debug/dap/inspect.rs",
        "src/debug/dap/breakpoints.rs",
        "src/debug/dap/mod.rs",
    ],
};

/// A program with functions, a loop, names of registers and of data.
const DEBUGGED: &str = "\
.format pos, 16
.buffer
list: .word 1, 2, 3, 4
.text
.func start
.reg count, s4
.holds count, pos
movi count, 3
again: call s30, sum
isubi count, count, 1
bne count, s0, again
swide w1, list(s0)
halt
.endfunc
.func sum
.region inner
lw s5, list(s0)
mul s6, s5, s5, 3
vsplat v1, s6
vadd v2, v1, v1
.endregion
ret s30
.endfunc
";

static PROGRAM: LazyLock<Program> = LazyLock::new(|| {
    let assembled = asm::assemble(&Source::new("a.s", DEBUGGED), &Isa::base(), &asm::Options::default());
    assembled.unwrap_or_else(|report| panic!("{}", report.render(false))).program
});

fn target(has_shadow: bool) -> DebugTarget {
    let config = Config { step_limit: 3_000, ..Config::default() };
    let mut target = DebugTarget::program("a.s".to_owned(), config, Isa::base(), PROGRAM.clone());
    target.memory = Memory::new((0..=255).collect());
    target.has_shadow = has_shadow;
    target
}

fn commands() -> Vec<Vec<u8>> {
    let names = COMMANDS.iter().map(|command| format!("{}\n", command.name).into_bytes());
    let usual = [
        "break sum\nc\nregs\nprint s4\nwhere\nback 2\nlist\n",
        "watch s6\nc\nc\nbc\nstops\ndelete 1\n",
        "goto 12\nmem 0 16 word\nbuffer list\ncalls\ncounts\nhash\nset s4=5\nstep 3\nnext\nout\n",
        "shadow s6\ndied\ntry add s1, s2, s3\nuntil sum\ndis start 20\nhelp break\nbreak again if count == 1\n",
    ];
    let tests = literals("tests/cli/debug.rs").into_iter().chain(files("tests/cmd", ".txt"));
    let all = names.chain(usual.map(|text| text.as_bytes().to_vec())).chain(tests).chain(listings());
    pieces(all.collect(), 400)
}

fn command(input: &[u8], seen: &mut Seen) {
    let target = target(input.len() % 2 == 0);
    let mut door = Door::new(Session::new(&target).unwrap_or_else(|report| panic!("{}", report.render(false))));
    let text = String::from_utf8_lossy(input);
    for line in text.lines().take(COMMANDS_A_RUN) {
        let before = door.session.position();
        match door.execute(line) {
            Err(message) => {
                assert_eq!(before, door.session.position(), "a command that is refused does nothing: {line}");
                seen.text(&message);
            }
            Ok(answer) => {
                // By the command's name, not by the word: what a line begins with can be anything.
                let word = line.split_whitespace().next().unwrap_or_default();
                let is_called = |command: &DebugCommand| command.name == word || command.also.contains(&word);
                seen.name(COMMANDS.iter().find(|command| is_called(command)).map_or("", |command| command.name));
                seen.count("lines", answer.text.lines().count());
                if answer.ends {
                    return;
                }
            }
        }
    }
    let session = &door.session;
    seen.plant(PlantedFault::Panic, session.stops().len() == 3);
}

fn requests() -> Vec<Vec<u8>> {
    let request = |command: &str, arguments: &str| {
        format!("{{\"seq\":1,\"type\":\"request\",\"command\":\"{command}\",\"arguments\":{arguments}}}\n")
    };
    let begin = request("initialize", "{}")
        + &request("launch", "{\"stopOnEntry\":true}")
        + &request("configurationDone", "{}");
    let usual = [
        ("threads", "{}"),
        ("stackTrace", "{\"threadId\":1}"),
        ("scopes", "{\"frameId\":0}"),
        ("variables", "{\"variablesReference\":1}"),
        ("variables", "{\"variablesReference\":2,\"start\":3,\"count\":4}"),
        ("setVariable", "{\"variablesReference\":1,\"name\":\"s4\",\"value\":\"7\"}"),
        ("evaluate", "{\"expression\":\"s4\",\"context\":\"hover\"}"),
        ("evaluate", "{\"expression\":\"where\",\"context\":\"repl\"}"),
        (
            "setBreakpoints",
            "{\"source\":{\"path\":\"a.s\",\"name\":\"a.s\"},\"breakpoints\":[{\"line\":9,\"condition\":\"s4 == 2\",\"hitCondition\":\"2\"}]}",
        ),
        ("setFunctionBreakpoints", "{\"breakpoints\":[{\"name\":\"sum\"}]}"),
        ("setInstructionBreakpoints", "{\"breakpoints\":[{\"instructionReference\":\"3\",\"offset\":4}]}"),
        ("dataBreakpointInfo", "{\"variablesReference\":1,\"name\":\"s6\"}"),
        ("setDataBreakpoints", "{\"breakpoints\":[{\"dataId\":\"s6\",\"accessType\":\"write\"}]}"),
        ("setExceptionBreakpoints", "{\"filters\":[\"overflowed\",\"quantized\"]}"),
        ("continue", "{\"threadId\":1}"),
        ("next", "{\"threadId\":1,\"granularity\":\"instruction\"}"),
        ("stepIn", "{\"threadId\":1}"),
        ("stepOut", "{\"threadId\":1}"),
        ("stepBack", "{\"threadId\":1}"),
        ("reverseContinue", "{\"threadId\":1}"),
        ("pause", "{\"threadId\":1}"),
        ("source", "{\"sourceReference\":1}"),
        ("disassemble", "{\"memoryReference\":\"0\",\"instructionOffset\":-2,\"instructionCount\":8}"),
        ("readMemory", "{\"memoryReference\":\"0\",\"count\":16}"),
        ("terminate", "{}"),
        ("disconnect", "{}"),
    ];
    let alone = usual.iter().map(|(command, arguments)| (begin.clone() + &request(command, arguments)).into_bytes());
    let all: String = usual.iter().take(22).map(|(command, arguments)| request(command, arguments)).collect();
    let stream = "Content-Length: 36\r\n\r\n{\"seq\":1,\"command\":\"initialize\",\"a\":0}Content-Length: 2\r\n\r\n{}"
        .as_bytes()
        .to_vec();
    alone
        .chain(pieces(vec![all.into_bytes()], 600).into_iter().map(|piece| [begin.as_bytes(), &piece].concat()))
        .chain([stream])
        .collect()
}

fn serve(input: &[u8], seen: &mut Seen) {
    let stream = match input.starts_with(b"Content-Length") {
        true => input.to_vec(),
        false => {
            let messages = input.split(|octet| *octet == b'\n').filter(|line| !line.is_empty());
            messages
                .flat_map(|line| [format!("Content-Length: {}\r\n\r\n", line.len()).as_bytes(), line].concat())
                .collect()
        }
    };
    let mut answers = Vec::new();
    let launch = |_: &serde_json::Value| Err("there is nothing else to debug".to_owned());
    if let Err(error) = dap::serve(&mut Cursor::new(stream), &mut answers, Some(target(false)), &launch) {
        seen.text(&error.to_string());
    }
    let text = String::from_utf8_lossy(&answers);
    let mut stops = 0;
    for answer in text.split("Content-Length: ").filter_map(|part| part.split_once("\r\n\r\n")).map(|(_, body)| body) {
        let answer: serde_json::Value = serde_json::from_str(answer).expect("answers are JSON");
        let word = |key: &str| answer[key].as_str().unwrap_or_default();
        seen.name(word("event"));
        // What is refused repeats what was asked.
        match answer["success"] == false {
            true => seen.text(word("message")),
            false => seen.name(word("command")),
        }
        stops += usize::from(answer["event"] == "stopped");
    }
    seen.plant(PlantedFault::Endless, stops == 3);
}
