//! `lancer debug`: the door of commands, the session behind it, and the Debug Adapter Protocol over both of its streams.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::Stdio;

use emu::registers::Registers;
use lancer::debug::{COMMANDS, DebugTarget, Door, Session as Debugged, StopReason};
use lancer::job::Job;
use lancer::load::Load;
use random::SplitMix64;
use serde_json::{Value, json};

use super::session::Session;

/// The pixel of a small Cornell box that most of these tests look at.
pub const PIXEL: &str = "cornell --size 12x9 --shift 0.137,0.071 --pixel 5,4";

/// The pixel of [`PIXEL`] as a target for the library.
pub fn pixel() -> DebugTarget {
    let scene = lancer::scene("cornell", None, Some((12, 9))).unwrap().scene;
    let mut job = Job::new(scene);
    job.view.shift = [0.137, 0.071];
    job.kernels.crop = Some(kernels::build::Crop { column: 5, row: 4, width: 1, height: 1 });
    let (load, _) = Load::picture(&job).unwrap();
    DebugTarget::pixel("cornell 5,4".into(), load, job.machine).unwrap()
}

/// Lines that a command answers with.
fn says(door: &mut Door, command: &str) -> String {
    door.execute(command).unwrap_or_else(|message| panic!("{command}: {message}")).text
}

#[test]
fn a_script_breaks_in_a_pixel_goes_back_and_comes_to_the_same_state() {
    let session = Session::new();
    session.write(
        "script.txt",
        "break triangle if step > 1100\ncontinue\nhash\nprint origin,direction\ncalls\nback 1000\nhash\n\
         instruction 1000 # and forward again\nhash\ncontinue-back\ndelete 1\nbreak triangle\ncontinue-back\ncounts\nquit\nnever\n",
    );
    let text = session.succeed(&format!("debug {PIXEL} --commands script.txt"));
    let hashes: Vec<&str> = text.lines().filter(|line| line.len() == 64 && !line.contains(' ')).collect();
    assert_eq!(hashes.len(), 3, "{text}");
    assert!(hashes[0] == hashes[2] && hashes[0] != hashes[1], "{text}");
    assert!(text.contains("1: break triangle if step > 1100") && text.contains("breakpoint 1\n"), "{text}");
    assert!(text.contains("in triangle, kernels/asm/wide.inc:"), "{text}");
    let origin = text.lines().find(|line| line.starts_with("v1[origin]=")).unwrap();
    assert!(origin.contains(":pos)"), "real values without being told: {origin}");
    assert!(text.contains("  1 packet ") && text.contains("the program's start"), "{text}");
    assert!(!text.contains("never"));
}

#[test]
fn any_position_has_the_state_that_a_run_from_the_start_has_there() {
    let target = pixel();
    let mut door = Door::new(Debugged::new(&target).unwrap());
    says(&mut door, "continue");
    let end = door.session.position();
    assert!(end > 2_000, "{end}");
    let mut random = SplitMix64::new(7);
    for _ in 0..100 {
        let position = random.below(end);
        says(&mut door, &format!("goto {position}"));
        let mut fresh = target.stepper().unwrap();
        fresh.run_to(position);
        assert_eq!(door.session.stepper().state(), fresh.state(), "position {position}");
        assert_eq!(door.session.stepper().memory(), fresh.memory());
        assert_eq!(door.session.stepper().calls(), fresh.calls());
    }
    assert_eq!(door.session.go_to(u64::MAX), StopReason::Halted);
    assert_eq!(door.session.position(), end);
}

#[test]
fn stops_going_back_are_those_going_forwards() {
    let target = pixel();
    for stops in [
        &["break triangle"][..],
        &["watch near_t"],
        &["break packet", "watch s12 if s12 > 0 count 5"],
        &["watch memory 0 4096"],
    ] {
        let mut door = Door::new(Debugged::new(&target).unwrap());
        stops.iter().for_each(|stop| drop(says(&mut door, stop)));
        let mut forwards = Vec::new();
        for _ in 0..40 {
            let reason = door.session.run(&mut |_, _| false);
            if !matches!(reason, StopReason::Met(_)) {
                break;
            }
            forwards.push((door.session.position(), reason));
        }
        assert!(forwards.len() > 1, "{stops:?}");
        let last = forwards.pop().unwrap();
        assert_eq!(door.session.position().max(last.0), door.session.position());
        door.session.go_to(last.0);
        while let Some(expected) = forwards.pop() {
            let reason = door.session.run_back(&mut |_, _| false);
            assert_eq!((door.session.position(), reason), expected, "{stops:?}");
        }
        assert_eq!(door.session.run_back(&mut |_, _| false), StopReason::Start, "{stops:?}");
    }
}

/// A program with a function, a structure in the buffer and a result that loses bits.
const PROGRAM: &str = "    .format pos, 4
    .struct pair
    .field low, 4
    .field high, 2
    .endstruct
    .reg  left, s1
    .holds left, pos
    movi  left, 9
    call  s31, halve
    sw    left, table(s0)
    halt
    .func halve
    rshift left, left, 1
    ret   s31
    .endfunc
    .buffer
table: .word 7
    .half -2
";

#[test]
fn lines_calls_and_changes_go_both_ways() {
    let session = Session::new();
    session.write("p.s", PROGRAM);
    let lines = |commands: &str| {
        session.write("c.txt", commands);
        session.succeed("debug p.s --commands c.txt")
    };
    let text = lines("step\nstep\nback-out\nnext\nback-next\nstep\nout\nback-step\n");
    let steps: Vec<&str> = text
        .lines()
        .filter_map(|line| line.strip_prefix("step "))
        .map(|line| line.split(',').next().unwrap())
        .collect();
    assert_eq!(steps, ["1", "2", "1", "4", "1", "2", "4", "3"], "{text}");
    let text = lines(
        "until quantized\nprint left\nx rshift s5, left, 1\nprint s5\nbuffer table pair\nbuffer table 8\ncounts\n",
    );
    assert!(text.contains("the last result lost bits") && text.contains("s1[left]=5 (0.3:pos)"), "{text}");
    assert!(
        text.contains("s5=3") && text.contains("1 result lost bits") && text.contains("s5=0  0x00000000"),
        "{text}"
    );
    assert!(text.contains("low              +0    7 ") && text.contains("high             +4    -2 "), "{text}");
    assert!(text.contains("07000000 feff"), "{text}");
    assert!(text.contains("3 instructions since step 0") && text.contains("  logic"), "{text}");
    // What was changed by hand is there again when one comes back to it.
    let text = lines(
        "goto 1\nset left=2.5:pos\ngoto 0\nprint left\ngoto 3\nprint left\ndisassemble halve 1\nlist 9\nwatch buffer table\ncontinue\ncontinue\n",
    );
    assert!(text.contains("s1[left]=0 (0:pos)") && text.contains("s1[left]=20 (1.25:pos)"), "{text}");
    assert!(text.contains("halve:\n") && text.contains("rshift s1, s1, 1") && text.contains("Done(logic 1)"), "{text}");
    assert!(text.contains("watch 1: buffer 0x0 4") && text.contains("the program halted"), "{text}");
}

#[test]
fn mistakes_in_commands_are_told_with_what_was_meant() {
    let session = Session::new();
    session.write("p.s", PROGRAM);
    let fails = |commands: &str, message: &str| {
        session.write("c.txt", commands);
        let run = session.run("debug p.s --commands c.txt");
        assert!(run.code == 1 && run.messages.contains(message), "{commands}: {} {}", run.code, run.messages);
    };
    fails("contineu\n", "did you mean `continue`?");
    fails("step\nbraek halve\n", "c.txt:2:1");
    fails("break halv\n", "did you mean `halve`?");
    fails("print lefft\n", "did you mean `left`?");
    fails("print left:poss\n", "did you mean `pos`?");
    fails("break halve if left\n", "compares nothing");
    fails("buffer table pairr\n", "did you mean `pair`?");
    fails("x vdto s1, v1, v2, 16\n", "did you mean `vdot`?");
    fails("x add s1, left, s2, s3\n", "takes 3 operands");
    fails("goto -1\n", "0 or more");
    fails("delete 7\n", "no breakpoint 7");
    fails("where now\n", "takes nothing");
    session.fail("debug", 2, "nothing to debug");
    session.fail("debug cornell", 1, "add --pixel X,Y");
    session.fail("debug cornell --pixel 1000,1", 2, "outside");
    session.fail("debug cornell --pixel 1,1 --reg s1=5", 2, "begins with its ray");
    session.fail("debug p.s --port 4711", 2, "--dap");
    let run = session.run("debug p.s --reg left=0.5:pos");
    assert!(run.code == 0 && run.out.starts_with("step 0, clock 0: word 0x0000"), "{}", run.out);
}

#[test]
fn the_page_of_the_debugger_has_all_commands() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/debugger.md")).unwrap();
    for command in COMMANDS {
        let row = format!(
            "| `{}` | {} | {} |",
            format!("{} {}", command.name, command.operands).trim().replace('|', "\\|"),
            command.also.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" "),
            command.doc
        );
        assert!(page.contains(&row), "docs/debugger.md lacks {row}");
    }
}

#[test]
fn a_change_is_no_part_of_the_target() {
    let target = pixel();
    let mut debugged = Debugged::new(&target).unwrap();
    debugged.go_to(100);
    debugged.change(|registers: &mut Registers| registers.set_scalar(12, 77));
    debugged.go_to(0);
    debugged.go_to(100);
    assert_eq!(debugged.stepper().state().registers.scalar(12), 77);
    assert_ne!(Debugged::new(&target).unwrap().stepper().state().registers.scalar(12), 77);
}

/// A client of the protocol.
struct Client<R, W> {
    input: BufReader<R>,
    output: W,
    seq: u64,
    events: Vec<Value>,
}

impl<R: Read, W: Write> Client<R, W> {
    fn new(input: R, output: W) -> Client<R, W> {
        Client { input: BufReader::new(input), output, seq: 0, events: Vec::new() }
    }

    fn read(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(self.input.read_line(&mut line).unwrap() > 0, "the adapter went away");
            match line.trim() {
                "" => break,
                line => length = line.strip_prefix("Content-Length: ").unwrap().parse().unwrap(),
            }
        }
        let mut octets = vec![0; length];
        self.input.read_exact(&mut octets).unwrap();
        serde_json::from_slice(&octets).unwrap()
    }

    fn ask(&mut self, command: &str, arguments: Value) -> Value {
        self.seq += 1;
        let text =
            json!({ "seq": self.seq, "type": "request", "command": command, "arguments": arguments }).to_string();
        write!(self.output, "Content-Length: {}\r\n\r\n{text}", text.len()).unwrap();
        self.output.flush().unwrap();
        loop {
            let message = self.read();
            if message["type"] == "response" {
                assert_eq!((&message["command"], &message["request_seq"]), (&command.into(), &self.seq.into()));
                return message;
            }
            self.events.push(message);
        }
    }

    fn body(&mut self, command: &str, arguments: Value) -> Value {
        let response = self.ask(command, arguments);
        assert_eq!(response["success"], true, "{response}");
        response["body"].clone()
    }

    /// The next event of a name.
    fn event(&mut self, name: &str) -> Value {
        loop {
            if let Some(at) = self.events.iter().position(|event| event["event"] == name) {
                return self.events.drain(..=at).next_back().unwrap()["body"].clone();
            }
            let message = self.read();
            self.events.push(message);
        }
    }

    fn evaluate(&mut self, expression: &str) -> String {
        let body = self.body("evaluate", json!({ "expression": expression, "context": "repl" }));
        body["result"].as_str().unwrap().to_owned()
    }
}

/// Breaks in `triangle`, looks at real values, goes back 1,000 instructions and forward again.
fn drive<R: Read, W: Write>(client: &mut Client<R, W>) {
    let stopped = client.event("stopped");
    assert_eq!((&stopped["reason"], &stopped["hitBreakpointIds"]), (&"breakpoint".into(), &json!([1])), "{stopped}");
    let frames = client.body("stackTrace", json!({ "threadId": 1 }))["stackFrames"].clone();
    assert_eq!((&frames[0]["name"], &frames[1]["name"]), (&"triangle".into(), &"packet".into()), "{frames}");
    let source = client.body("source", json!({ "sourceReference": frames[0]["source"]["sourceReference"] }));
    let text = source["content"].as_str().unwrap();
    let line = text.lines().nth(frames[0]["line"].as_u64().unwrap() as usize - 1).unwrap();
    assert!(line.contains("load_triangle") || line.contains("lv "), "{line}");
    let scopes = client.body("scopes", json!({ "frameId": 1 }))["scopes"].clone();
    let named = client.body("variables", json!({ "variablesReference": scopes[0]["variablesReference"] }));
    let origin = named["variables"].as_array().unwrap().iter().find(|one| one["name"] == "origin").unwrap();
    let value = origin["value"].as_str().unwrap();
    assert!(value.contains(":pos), error ") && value.ends_with(" ulp"), "the launch asked for shadows: {origin}");
    let hash = client.evaluate("hash");
    let step = client.evaluate("where");
    client.evaluate("back 1000");
    assert_eq!(client.event("stopped")["reason"], "goto");
    assert_ne!(client.evaluate("hash"), hash);
    for _ in 0..2 {
        client.body("stepBack", json!({ "threadId": 1, "granularity": "instruction" }));
        assert_eq!(client.event("stopped")["reason"], "step");
    }
    client.evaluate("instruction 1002");
    client.event("stopped");
    assert_eq!((client.evaluate("where"), client.evaluate("hash")), (step, hash));
    // Over a line and back; back to the last breakpoint.
    let place = |client: &mut Client<R, W>| {
        client.body("stackTrace", json!({ "threadId": 1 }))["stackFrames"][0]["instructionPointerReference"].clone()
    };
    let here = place(client);
    client.body("next", json!({ "threadId": 1 }));
    client.event("stopped");
    assert_ne!(place(client), here);
    client.body("stepBack", json!({ "threadId": 1 }));
    client.event("stopped");
    assert_eq!(place(client), here);
    client.body("continue", json!({ "threadId": 1 }));
    client.event("stopped");
    client.body("reverseContinue", json!({ "threadId": 1 }));
    assert_eq!(client.event("stopped")["hitBreakpointIds"], json!([1]));
    assert_eq!(place(client), here);
    let lines =
        client.body("disassemble", json!({ "memoryReference": here, "instructionOffset": -1, "instructionCount": 3 }));
    assert_eq!((lines["instructions"].as_array().unwrap().len(), &lines["instructions"][1]["address"]), (3, &here));
    // Numbers that no client means.
    for (first, offset) in [(i64::MIN, -2), (i64::MAX, i64::MAX)] {
        let arguments =
            json!({ "memoryReference": first.to_string(), "instructionOffset": offset, "instructionCount": 8 });
        let far = client.body("disassemble", arguments);
        let all = far["instructions"].as_array().unwrap();
        assert!(all.len() == 8 && all.iter().all(|one| one["presentationHint"] == "invalid"), "{far}");
        let wanted = json!([{ "instructionReference": first.to_string(), "offset": offset }]);
        let set = client.body("setInstructionBreakpoints", json!({ "breakpoints": wanted }));
        assert_eq!(set["breakpoints"][0]["verified"], false, "{set}");
    }
    let far = client.ask("scopes", json!({ "frameId": u64::MAX }));
    assert_eq!((&far["success"], &far["message"]), (&false.into(), &"there is no such frame".into()));
    assert!(client.ask("nonsense", json!({}))["message"].as_str().unwrap().contains("no request"));
    assert!(
        client.ask("evaluate", json!({ "expression": "contineu", "context": "repl" }))["message"]
            .as_str()
            .unwrap()
            .contains("did you mean")
    );
    client.body("disconnect", json!({}));
}

#[test]
fn a_client_over_standard_streams_goes_back_and_forward_again() {
    let session = Session::new();
    let mut child = session.command("debug --dap").stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut client = Client::new(child.stdout.take().unwrap(), child.stdin.take().unwrap());
    let capabilities = client.body("initialize", json!({ "adapterID": "lancer" }));
    assert_eq!(capabilities["supportsStepBack"], true);
    let wrong = client.ask("launch", json!({ "program": "cornel", "args": ["--pixel", "5,4"] }));
    assert!(wrong["message"].as_str().unwrap().contains("did you mean `cornell`?"), "{wrong}");
    let args = ["--size", "12x9", "--shift", "0.137,0.071", "--pixel", "5,4"];
    client.ask("launch", json!({ "program": "cornell", "args": args, "shadow": true }));
    client.event("initialized");
    let set = client.body(
        "setFunctionBreakpoints",
        json!({ "breakpoints": [{ "name": "triangle", "condition": "step > 1100" }, { "name": "triangel" }] }),
    );
    assert_eq!((&set["breakpoints"][0]["verified"], &set["breakpoints"][1]["verified"]), (&true.into(), &false.into()));
    client.ask("configurationDone", json!({}));
    client.body("threads", json!({}));
    drive(&mut client);
    assert!(child.wait().unwrap().success());
}

#[test]
fn a_client_at_a_port_breaks_at_lines_and_changes_registers() {
    let session = Session::new();
    session.write("p.s", PROGRAM);
    let mut child = session.command("debug p.s --dap --port 0").stderr(Stdio::piped()).spawn().unwrap();
    let mut said = String::new();
    BufReader::new(child.stderr.take().unwrap()).read_line(&mut said).unwrap();
    let address = said.trim().strip_prefix("listening at ").unwrap().to_owned();
    let stream = TcpStream::connect(address).unwrap();
    let mut client = Client::new(stream.try_clone().unwrap(), stream);
    client.body("initialize", json!({}));
    client.ask("launch", json!({ "stopOnEntry": true }));
    // Line 13 is the shift in `halve`, where `left` is 9/16; the program has no line 99.
    let path = session.path("p.s").display().to_string();
    let set = client.body("setBreakpoints", json!({ "source": { "path": path }, "breakpoints": [{ "line": 13, "condition": "left > 0.5:pos" }, { "line": 99 }] }));
    assert_eq!(
        (&set["breakpoints"][0]["verified"], &set["breakpoints"][0]["line"]),
        (&true.into(), &13.into()),
        "{set}"
    );
    assert_eq!(set["breakpoints"][1]["verified"], false);
    client.ask("configurationDone", json!({}));
    assert_eq!(client.event("stopped")["reason"], "entry");
    client.body("continue", json!({}));
    client.event("stopped");
    let frames = client.body("stackTrace", json!({ "threadId": 1, "levels": 1 }));
    assert_eq!((&frames["stackFrames"][0]["name"], &frames["totalFrames"]), (&"halve".into(), &2.into()));
    // Watch `left` and set it to 2.5 by hand; reference 9 is 8 * 1 + 1, the named registers of frame 1
    let info = client.body("dataBreakpointInfo", json!({ "name": "left" }));
    client.body("setDataBreakpoints", json!({ "breakpoints": [{ "dataId": info["dataId"] }] }));
    let changed = client.body("setVariable", json!({ "variablesReference": 9, "name": "left", "value": "2.5:pos" }));
    assert_eq!(changed["value"], "40 (2.5:pos)");
    // On the way out of `halve` its shift writes what is watched: 40 becomes 20
    client.body("stepOut", json!({}));
    assert_eq!(client.event("stopped")["reason"], "data breakpoint");
    assert_eq!(client.evaluate("left"), "20 (1.25:pos)");
    client.body("continue", json!({}));
    assert_eq!(client.event("stopped")["description"], "the program halted");
    client.body("continue", json!({}));
    client.event("terminated");
    client.body("disconnect", json!({}));
    assert!(child.wait().unwrap().success());
}
