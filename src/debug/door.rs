//! The door of commands: a line of text in, text out.

use std::fmt::Write;

use sha2::{Digest, Sha256};

use super::command::{self, CommandAction};
use super::condition::StopCondition;
use super::memory::{self, Space};
use super::motion::{back_next, back_out, back_step, line_next, line_step, out};
use super::session::{Lossy, Session, StopReason};
use super::stop::{self, Event, Watched};
use super::{disassembly, place, shadow, trial};
use crate::arguments::numbered;
use crate::numeral::{count, grouped};
use crate::registers::{self, RegisterContents, RegisterList, ShowRequest, ShownRegister, register_of, rows};
use crate::result::hexadecimal;
use crate::table::table;
use crate::trace::instruction::TraceClocks;

/// Source lines that are shown before and behind one.
const AROUND: u32 = 5;

/// Instructions that a disassembly shows where nothing else is asked for.
const INSTRUCTIONS: u32 = 12;

/// Answer to a command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// Text to print.
    pub text: String,
    /// The session is over.
    pub ends: bool,
}

/// A session that takes commands.
pub struct Door<'a> {
    /// The session.
    pub session: Session<'a>,
}

impl<'a> Door<'a> {
    /// A door to a session.
    pub fn new(session: Session<'a>) -> Door<'a> {
        Door { session }
    }

    /// Carries out one line; blank lines and those behind `#` do nothing.
    ///
    /// # Errors
    /// What is wrong with the command: nothing has happened then.
    pub fn execute(&mut self, line: &str) -> Result<Answer, String> {
        let line = line.split(" #").next().unwrap_or_default().trim();
        if line.is_empty() || line.starts_with('#') {
            return Ok(Answer { text: String::new(), ends: false });
        }
        let (name, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let command = command::find(name)?;
        let text = self.carry_out(command.action, rest.trim())?;
        Ok(Answer { text, ends: command.action == CommandAction::Quit })
    }

    fn carry_out(&mut self, action: CommandAction, rest: &str) -> Result<String, String> {
        // Refuse words that would be ignored, such as the 5 in `continue 5`
        let takes_nothing = matches!(
            action,
            CommandAction::Stops
                | CommandAction::Continue
                | CommandAction::Out
                | CommandAction::BackOut
                | CommandAction::ContinueBack
                | CommandAction::Where
                | CommandAction::Calls
                | CommandAction::Counts
                | CommandAction::Hash
                | CommandAction::Quit
        );
        if takes_nothing && !rest.is_empty() {
            return Err(format!("`{rest}` is too much: the command takes nothing"));
        }
        match action {
            CommandAction::Break => self.add_break(rest),
            CommandAction::Watch => self.add_watch(rest),
            CommandAction::Stops => Ok(match self.session.stops() {
                [] => "no breakpoints and no watches\n".into(),
                stops => stops.iter().map(|stop| stop.line() + "\n").collect(),
            }),
            CommandAction::Delete => {
                let number = numbered(rest)?;
                let is_there = u32::try_from(number).is_ok_and(|number| self.session.remove_stop(number));
                if is_there {
                    Ok(String::new())
                } else {
                    Err(format!("there is no breakpoint {number}; `stops` lists all"))
                }
            }
            CommandAction::Continue => Ok(self.motion(|session| session.run(&mut |_, _| false))),
            CommandAction::Step => self.repeat(rest, line_step),
            CommandAction::Next => self.repeat(rest, line_next),
            CommandAction::Out => Ok(self.motion(out)),
            CommandAction::Instruction => {
                let number = times(rest)?;
                Ok(self.motion(|session| session.go_to(session.position().saturating_add(number))))
            }
            CommandAction::Until => self.until(rest),
            CommandAction::Back => {
                let number = times(rest)?;
                Ok(self.motion(|session| session.go_to(session.position().saturating_sub(number))))
            }
            CommandAction::BackStep => self.repeat(rest, back_step),
            CommandAction::BackNext => self.repeat(rest, back_next),
            CommandAction::BackOut => Ok(self.motion(back_out)),
            CommandAction::ContinueBack => Ok(self.motion(|session| session.run_back(&mut |_, _| false))),
            CommandAction::GoTo => {
                let position = u64::try_from(numbered(rest)?).map_err(|_| "a step is 0 or more".to_owned())?;
                Ok(self.motion(|session| session.go_to(position)))
            }
            CommandAction::Where => Ok(self.place()),
            CommandAction::List => {
                let pc = self.word(rest)?;
                Ok(disassembly::listing(&self.session, pc, AROUND))
            }
            CommandAction::Disassemble => {
                let (place, count) = match rest.rsplit_once(char::is_whitespace) {
                    Some((place, count)) => {
                        (place, u32::try_from(numbered(count)?).map_err(|_| "too many".to_owned())?)
                    }
                    None => (rest, INSTRUCTIONS),
                };
                let pc = self.word(place)?;
                Ok(disassembly::text(&self.session, pc, count))
            }
            CommandAction::Calls => Ok(self.calls()),
            CommandAction::Registers => self.registers(rest),
            CommandAction::Print => self.print(rest),
            CommandAction::Shadow => shadow::text(&self.session, rest),
            CommandAction::Died => shadow::died(&self.session, rest),
            CommandAction::Set => self.set(rest),
            CommandAction::Memory => self.memory(Space::Global, rest),
            CommandAction::Buffer => self.memory(Space::Buffer, rest),
            CommandAction::Counts => Ok(self.counts()),
            CommandAction::Try => self.try_out(rest),
            CommandAction::Hash => Ok(format!("{}\n", hash(&self.session))),
            CommandAction::Help => command::help(Some(rest).filter(|rest| !rest.is_empty())),
            CommandAction::Quit => Ok(String::new()),
        }
    }

    /// Moves, and says where that led.
    pub fn motion(&mut self, motion: impl FnOnce(&mut Session) -> StopReason) -> String {
        self.session.begin();
        let reason = motion(&mut self.session);
        let said = self.reason(&reason);
        if said.is_empty() { self.place() } else { format!("{said}\n{}", self.place()) }
    }

    fn repeat(&mut self, rest: &str, motion: fn(&mut Session) -> StopReason) -> Result<String, String> {
        let number = times(rest)?;
        Ok(self.motion(|session| {
            let mut reason = StopReason::Done;
            for _ in 0..number {
                reason = motion(session);
                if reason != StopReason::Done {
                    break;
                }
            }
            reason
        }))
    }

    fn until(&mut self, rest: &str) -> Result<String, String> {
        let wanted = match rest {
            "saturated" => Lossy { overflowed: true, quantized: false },
            "quantized" => Lossy { quantized: true, overflowed: false },
            "lossy" => Lossy { quantized: true, overflowed: true },
            _ => return Err("`until` takes saturated, quantized or lossy".into()),
        };
        let before = std::mem::replace(&mut self.session.lossy, wanted);
        let text = self.motion(|session| session.run(&mut |_, _| false));
        self.session.lossy = before;
        Ok(text)
    }

    /// The reason for a stop in a line without its end; empty where the motion went as far as it was to.
    pub fn reason(&self, reason: &StopReason) -> String {
        match reason {
            StopReason::Done => String::new(),
            StopReason::Met(numbers) => {
                let stops =
                    numbers.iter().filter_map(|number| self.session.stops().iter().find(|stop| stop.number == *number));
                let said = stops.map(|stop| match &stop.event {
                    Event::At(_) => format!("breakpoint {}", stop.number),
                    Event::Watch(watched) => match stop::contents(watched, self.session.stepper()) {
                        Some(now) if matches!(watched, Watched::Register(_)) => {
                            let now: Vec<String> = now.iter().map(i64::to_string).collect();
                            format!("watch {}: {} = {}", stop.number, stop.text, now.join(":"))
                        }
                        _ => format!("watch {}: {}", stop.number, stop.text),
                    },
                });
                said.collect::<Vec<_>>().join("; ")
            }
            StopReason::Lossy => "the last result lost bits or did not fit".into(),
            StopReason::Halted => "the program halted".into(),
            StopReason::Trapped => {
                let trap = self.session.stepper().trap();
                trap.map_or_else(String::new, |trap| format!("the program went wrong: {}", trap.kind))
            }
            StopReason::Start => "the program's start".into(),
        }
    }

    /// The position: step, clock, word, function and source line.
    pub fn place(&self) -> String {
        let (session, program) = (&self.session, &self.session.target.program);
        let pc = session.pc();
        let clock = match session.target.clocks {
            TraceClocks::Own => format!(", clock {}", grouped(session.stepper().clock().0)),
            TraceClocks::None => String::new(),
        };
        let function = program.function(pc).map_or_else(String::new, |name| format!(" in {name}"));
        let place = program.place(pc).map_or_else(String::new, |place| format!(", {place}"));
        let line =
            disassembly::source_line(session, pc).map_or_else(String::new, |line| format!("    {}\n", line.trim()));
        format!("step {}{clock}: word {pc:#06x}{function}{place}\n{line}", grouped(session.position()))
    }

    fn word(&self, text: &str) -> Result<u32, String> {
        match text.trim() {
            "" => Ok(self.session.pc()),
            text => place::words(&self.session.target.program, text, self.session.pc()).map(|words| words[0]),
        }
    }

    fn add_break(&mut self, rest: &str) -> Result<String, String> {
        let (place, condition, count) = self.conditions(rest)?;
        if place.is_empty() {
            return Err("a place is expected: a function, file:line, a line or *word".into());
        }
        let words = place::words(&self.session.target.program, &place, self.session.pc())?;
        Ok(self.added(place, Event::At(words), condition, count))
    }

    fn added(&mut self, text: String, event: Event, condition: Option<StopCondition>, count: u64) -> String {
        let number = self.session.add_stop(text, event, condition, count);
        let stop = self.session.stops().iter().find(|stop| stop.number == number);
        stop.map_or_else(String::new, |stop| stop.line() + "\n")
    }

    fn add_watch(&mut self, rest: &str) -> Result<String, String> {
        let (what, condition, count) = self.conditions(rest)?;
        let words: Vec<&str> = what.split_whitespace().collect();
        let octets = |words: &[&str]| -> Result<u32, String> {
            match words.get(2) {
                Some(text) => u32::try_from(numbered(text)?).map_err(|_| format!("`{text}` octets")),
                None => Ok(4),
            }
        };
        let watched = match words.as_slice() {
            [] => return Err("a register, `buffer ADDRESS` or `memory ADDRESS` is expected".into()),
            ["buffer", address, ..] if words.len() < 4 => {
                let (start, octets) = (memory::address(&self.session, address)?, octets(&words)?);
                memory::octets(&self.session, Space::Buffer, start, octets)?;
                Watched::Buffer(start, octets)
            }
            ["memory", address, ..] if words.len() < 4 => {
                let (start, octets) = (memory::address(&self.session, address)?, octets(&words)?);
                memory::octets(&self.session, Space::Global, start, octets)?;
                Watched::Bus(start, octets)
            }
            [register] => Watched::Register(register_of(&self.session.target.program, register, self.session.pc())?),
            _ => return Err(format!("`{what}` cannot be watched: a register, `buffer ADDRESS` or `memory ADDRESS`")),
        };
        let text = if words.len() == 1 { words[0].to_owned() } else { stop::name(&watched) };
        Ok(self.added(text, Event::Watch(watched), condition, count))
    }

    /// Text before `if` and `count`, and those two.
    fn conditions(&self, rest: &str) -> Result<(String, Option<StopCondition>, u64), String> {
        let (rest, count) = match rest.rsplit_once(" count ") {
            Some((before, number)) => {
                let number = u64::try_from(numbered(number)?).ok().filter(|number| *number > 0);
                (before, number.ok_or("a count is 1 or more")?)
            }
            None => (rest, 1),
        };
        let (place, condition) = match rest.split_once(" if ") {
            Some((place, condition)) => (place, Some(condition.parse::<StopCondition>()?)),
            None if rest == "if" || rest.ends_with(" if") => {
                return Err("a condition is missing behind `if`: write such as if s1 == 5 && v2.x < 0.5:pos".into());
            }
            None => (rest, None),
        };
        if let Some(condition) = &condition {
            condition.check(&self.session.target.program)?;
        }
        Ok((place.trim().to_owned(), condition, count))
    }

    fn calls(&self) -> String {
        let (session, program) = (&self.session, &self.session.target.program);
        let mut text = String::new();
        let calls = session.stepper().calls();
        let places =
            [session.pc()].into_iter().chain(calls.iter().rev().map(|call| session.stepper().code.word(call.from)));
        for (level, pc) in places.enumerate() {
            let function = program.function(pc).unwrap_or("(no function)");
            let _ =
                writeln!(text, "{level:>3} {function:<16} word {pc:#06x} {}", program.place(pc).unwrap_or_default());
        }
        text
    }

    fn registers(&self, rest: &str) -> Result<String, String> {
        let has_zeros = match rest {
            "" => false,
            "all" => true,
            other => return Err(format!("`registers` takes `all`, not `{other}`; `print {other}` shows one")),
        };
        let (state, program, pc) = (self.session.stepper().state(), &self.session.target.program, self.session.pc());
        let kept = registers::all(&state.registers).filter(|(_, contents)| has_zeros || !contents.is_zero());
        let shown: Vec<ShownRegister> =
            kept.map(|(register, _)| ShownRegister::at(program, &state.registers, register, pc)).collect();
        Ok(if shown.is_empty() { "all registers are zero\n".into() } else { table(rows(&shown)) })
    }

    fn print(&self, rest: &str) -> Result<String, String> {
        let (state, program, pc) = (self.session.stepper().state(), &self.session.target.program, self.session.pc());
        let mut text = String::new();
        for item in rest.split(',') {
            text += &match item.trim() {
                "pc" => {
                    let place = program.place(pc).map_or_else(String::new, |place| format!(" ({place})"));
                    format!("pc={pc}{place}  {pc:#06x}\n")
                }
                "step" => format!("step={}\n", self.session.position()),
                item => {
                    let shown = item.parse::<ShowRequest>()?.shown(program, &state.registers, pc)?;
                    format!("{}  {}\n", shown.short(), shown.hexadecimal)
                }
            };
        }
        Ok(text)
    }

    fn set(&mut self, rest: &str) -> Result<String, String> {
        let list: RegisterList = rest.parse()?;
        let (program, pc) = (&self.session.target.program, self.session.pc());
        // All or nothing: the settings are tried on a copy first.
        let mut changed = self.session.stepper().state().registers.clone();
        for setting in &list.0 {
            setting.set_at(program, &mut changed, pc)?;
        }
        self.session.change(|registers| *registers = changed);
        Ok(String::new())
    }

    fn memory(&self, space: Space, rest: &str) -> Result<String, String> {
        let mut words = rest.split_whitespace();
        let address = words.next().ok_or("an address is expected")?;
        let start = memory::address(&self.session, address)?;
        memory::text(&self.session, space, start, words.next())
    }

    fn counts(&self) -> String {
        let session = &self.session;
        let (from, to) = (session.last_stop(), session.position());
        if to < from {
            return format!("{} back\n", count(from - to, "instruction", "instructions"));
        }
        let mut text = format!("{} since step {}\n", count(to - from, "instruction", "instructions"), grouped(from));
        for (class, number) in session.stepper().counts().iter().filter(|(_, number)| *number != 0) {
            let _ = writeln!(text, "  {:<8} {:>12}", class.name(), grouped(number));
        }
        text
    }

    fn try_out(&self, rest: &str) -> Result<String, String> {
        if rest.is_empty() {
            return Err("an instruction is expected, such as x vdot s1, v1, v2, 16".into());
        }
        let record = trial::tried(&self.session, rest)?;
        let mut text = format!("{}\n", record.text);
        // Nothing of the trial stays, so the registers still hold what was there before.
        for register in &record.writes {
            let before = register_of(&self.session.target.program, &register.register, record.pc).ok();
            let before =
                before.map(|id| RegisterContents::of(&self.session.stepper().state().registers, id).raw_text());
            let _ = writeln!(
                text,
                "  {}  {}  (was {})",
                register.short(),
                register.hexadecimal,
                before.unwrap_or_default()
            );
        }
        // Say how it ended, what it moved and what it lost
        if let Some(exit) = &record.exit {
            let _ = writeln!(text, "  exit {exit}");
        }
        if let Some(transfer) = &record.transfer {
            let _ = writeln!(
                text,
                "  {} {:#x}, {}",
                transfer.kind,
                transfer.address,
                count(transfer.octets.into(), "octet", "octets")
            );
        }
        for (number, what) in [(record.quantized, "lost bits"), (record.overflowed, "did not fit")] {
            if number != 0 {
                let _ = writeln!(text, "  {} {what}", count(number, "result", "results"));
            }
        }
        if let Some(fault) = &record.fault {
            let _ = writeln!(text, "  went wrong: {fault}");
        }
        Ok(text)
    }
}

/// A number of times: 1 where nothing is said.
fn times(rest: &str) -> Result<u64, String> {
    match rest {
        "" => Ok(1),
        text => u64::try_from(numbered(text)?).map_err(|_| format!("{text} times")),
    }
}

/// Hash of program counter, registers, buffer and memory, in hexadecimal: SHA-256 of the numbers, least octet first.
pub fn hash(session: &Session) -> String {
    let mut hash = Sha256::new();
    let (state, memory) = (session.stepper().state(), session.stepper().memory());
    hash.update(state.pc.to_le_bytes());
    for (_, contents) in registers::all(&state.registers) {
        contents.numbers().iter().for_each(|number| hash.update(number.to_le_bytes()));
    }
    hash.update(state.buffer.octets());
    hash.update(memory.octets());
    hexadecimal(&hash.finalize())
}
