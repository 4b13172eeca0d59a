//! Observation of a case: messages of the assembler, or a run on an engine that can be looked at after each line.

use emu::code::Code;
use emu::engine::{HostSimd, Wish};
use emu::machine::Config;
use emu::machine::one_core::{self, OneCore, OneCoreRun};
use emu::octets::Memory;
use isa::{Counts, Isa, Program};
use messages::{Report, Severity, Source};

use super::Case;
use super::claim::{Claim, Subject};

/// A way of walking through code; all of them must do what every case says.
pub struct Engine {
    /// Name of the engine.
    pub name: &'static str,
    /// Runs a program on one core up to its halt, its trap or its step limit, which it meets exactly.
    pub run: fn(&OneCore, Memory) -> Result<OneCoreRun, Report>,
}

/// All engines; the first one is the specification.
pub const ENGINES: &[Engine] = &[
    Engine { name: "checked", run: |one_core, memory| one_core::run_with(one_core, memory, Wish::CHECKED) },
    Engine { name: "native", run: |one_core, memory| one_core::run_with(one_core, memory, Wish::native()) },
    Engine {
        name: "native, baseline",
        run: |one_core, memory| {
            one_core::run_with(one_core, memory, Wish { simd: HostSimd::Baseline, ..Wish::native() })
        },
    },
];

/// One thing that was said, with its line; 0 where it has none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
    /// Line from 1.
    pub line: usize,
    /// `error E008`, `trap`.
    pub head: String,
    /// The text.
    pub text: String,
}

/// Outcome of a case.
pub struct Observation {
    /// Messages and the trap.
    pub said: Vec<Said>,
    /// The run, when there was one.
    pub run: Option<Run>,
}

/// A program's run, instruction by instruction.
pub struct Run {
    isa: Isa,
    config: Config,
    engine: fn(&OneCore, Memory) -> Result<OneCoreRun, Report>,
    memory: usize,
    /// The program.
    pub program: Program,
    /// Word and exit of each instruction that ended.
    pub steps: Vec<(u32, usize)>,
    end: OneCoreRun,
    formats: Vec<(String, i64)>,
}

/// Assembles and runs a case.
pub fn observe(case: &Case, engine: &Engine) -> Observation {
    let source = Source::new(case.name.as_str(), case.text.as_str());
    let isa = Isa::base();
    let assembled = match asm::assemble(&source, &isa, &asm::Options::default()) {
        Ok(assembled) => assembled,
        Err(report) => return Observation { said: said(&report), run: None },
    };
    let mut told = said(&assembled.warnings);
    let run = Config::parse(&Source::new("machine", case.machine.as_str()))
        .and_then(|config| Run::new(isa, config, engine, case, assembled.program));
    match run {
        Ok(run) => {
            if let Some(trap) = &run.end.trap {
                let line = run.line(trap.pc);
                told.push(Said { line, head: "trap".into(), text: trap.kind.to_string() });
            }
            Observation { said: told, run: Some(run) }
        }
        Err(report) => {
            told.extend(said(&report).into_iter().map(|said| Said { line: 0, ..said }));
            Observation { said: told, run: None }
        }
    }
}

fn said(report: &Report) -> Vec<Said> {
    let one = |message: &messages::Diagnostic| {
        let kind = if message.severity == Severity::Error { "error" } else { "warning" };
        let head = message.code.map_or(kind.to_owned(), |code| format!("{kind} {code}"));
        let line = message.place.as_ref().map_or(0, |(place, _)| place.source.line_column(place.span.start).0);
        Said { line, head, text: message.message.clone() }
    };
    report.0.iter().map(one).collect()
}

impl Run {
    fn new(isa: Isa, config: Config, engine: &Engine, case: &Case, program: Program) -> Result<Run, Report> {
        let formats = formats(&case.text);
        let (engine, memory) = (engine.run, case.memory);
        let end = run(&isa, &config, &program, engine, memory, config.step_limit)?;
        let mut run = Run { isa, config, engine, memory, program, steps: Vec::new(), end, formats };
        let mut before = run.after_steps(0);
        for steps in 1..=run.end.state.steps {
            let after = run.after_steps(steps);
            let code = run.code();
            let pc = before.state.pc;
            let has_passed =
                |&exit: &usize| after.tally.passes(&code, pc, exit).count > before.tally.passes(&code, pc, exit).count;
            let exit = (0..8).find(has_passed).expect("an instruction passes through one of its exits");
            run.steps.push((pc, exit));
            before = after;
        }
        Ok(run)
    }

    fn code(&self) -> Code<'_> {
        Code::new(&self.program, &self.isa, self.config.timing())
    }

    fn after_steps(&self, steps: u64) -> OneCoreRun {
        run(&self.isa, &self.config, &self.program, self.engine, self.memory, steps).expect("it ran before")
    }

    fn line(&self, pc: u32) -> usize {
        self.program.lines.get(pc as usize).map_or(0, |line| line.line as usize)
    }

    /// Row and exit names of all instructions that ended.
    pub fn exits(&self) -> Vec<(String, String)> {
        let code = self.code();
        let names = |&(pc, exit): &(u32, usize)| {
            let row = code.row(pc).expect("what was executed is a row");
            (row.name.to_string(), row.outcomes[exit].name.to_string())
        };
        self.steps.iter().map(names).collect()
    }

    /// The machine after the line's last instruction was executed the last time, or as a trap on the line left it.
    fn after(&self, line: usize) -> Result<OneCoreRun, String> {
        if self.end.trap.as_ref().is_some_and(|trap| self.line(trap.pc) == line) {
            return Ok(self.end.clone());
        }
        let last = self.steps.iter().rposition(|&(pc, _)| self.line(pc) == line);
        let last = last.ok_or_else(|| "the line is never executed".to_owned())?;
        Ok(self.after_steps(last as u64 + 1))
    }

    /// The value that a claim would have to say: its own where that is right.
    pub fn value(&self, claim: &Claim) -> Result<String, String> {
        let at = self.after(claim.line)?;
        // Take as many octets from an address as the claim names
        let octets = |address: &str, space: &[u8]| -> Result<Vec<i64>, String> {
            let start = self.numbers(address)?.first().copied().unwrap_or(0) as usize;
            let count = claim.value.split(',').count();
            let found = space.get(start..start + count).ok_or("there are no such octets")?;
            Ok(found.iter().map(|&octet| octet.into()).collect())
        };
        let (found, bits) = match &claim.subject {
            Subject::Register(name) => match isa::parse_register(name).expect("looked at by the reader") {
                ('s', number) => (vec![at.state.registers.scalar(number).into()], 32),
                ('v', number) => (at.state.registers.vector(number).map(i64::from).to_vec(), 32),
                (_, number) => (vec![at.state.registers.wide(number)], 64),
            },
            Subject::Buffer(address) => (octets(address, at.state.buffer.octets())?, 8),
            Subject::Memory(address) => (octets(address, &at.memory.octets())?, 8),
            Subject::Exit => {
                let code = self.code();
                let here = self.steps.iter().filter(|&&(pc, _)| self.line(pc) == claim.line);
                let names = here.filter_map(|&(pc, exit)| Some(code.row(pc)?.outcomes[exit].name.to_string()));
                return Ok(names.collect::<Vec<_>>().join(", "));
            }
            Subject::Count => return Ok(count_text(&at.tally.counts(&self.code()))),
            Subject::Clocks => return Ok(at.clocks.0.to_string()),
            Subject::Said(_) => return Err("said elsewhere".into()),
        };
        // A right claim stays as it is written, whatever its style: `0xffffffff` and -1 are the same 32 bits.
        let mask = u64::MAX >> (64 - bits);
        let same = |claimed: Vec<i64>| {
            claimed.len() == found.len() && claimed.iter().zip(&found).all(|(a, b)| (a ^ b) as u64 & mask == 0)
        };
        if self.numbers(&claim.value).is_ok_and(same) {
            return Ok(claim.value.clone());
        }
        // Write each number in the style of the claimed one in its place; up to three that nobody claimed are decimal
        let styles: Vec<&str> = claim.value.split(',').map(str::trim).chain(["", "", ""]).collect();
        Ok(found.iter().zip(styles).map(|(&raw, style)| self.number_text(raw, style)).collect::<Vec<_>>().join(", "))
    }

    /// The numbers of a list, as the assembler reads it.
    fn numbers(&self, list: &str) -> Result<Vec<i64>, String> {
        let plain = |name: &str| name.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_');
        let symbols = self.program.symbols.iter().filter(|(name, _)| plain(name));
        let options = asm::Options {
            defines: symbols.map(|(name, &value)| (name.clone(), value)).collect(),
            formats: self.formats.clone(),
            ..asm::Options::default()
        };
        let source = Source::new("claim", format!(".buffer\n.wide {list}\n"));
        let octets = asm::assemble(&source, &self.isa, &options).map_err(|report| report.render(false))?.program.buffer;
        Ok(octets.as_chunks().0.iter().map(|&octets| i64::from_le_bytes(octets)).collect())
    }

    /// A number in the style of another one: with its format, hexadecimal, or decimal.
    fn number_text(&self, raw: i64, style: &str) -> String {
        if let Some((_, format)) = style.split_once(':')
            && let Some((_, bits)) = self.formats.iter().find(|(name, _)| name == format)
        {
            let value = raw as f64 / 2f64.powi(*bits as i32);
            let texts = (0..20).map(|places| format!("{value:.places$}:{format}"));
            let is_exact = |text: &String| self.numbers(text).is_ok_and(|numbers| numbers == [raw]);
            return texts.into_iter().find(is_exact).unwrap_or_else(|| raw.to_string());
        }
        match (style.starts_with("0x"), i32::try_from(raw)) {
            (true, Ok(raw)) => format!("{raw:#x}"),
            (true, Err(_)) if raw >= 0 => format!("{raw:#x}"),
            _ => raw.to_string(),
        }
    }
}

fn run(
    isa: &Isa,
    config: &Config,
    program: &Program,
    engine: fn(&OneCore, Memory) -> Result<OneCoreRun, Report>,
    memory: usize,
    step_limit: u64,
) -> Result<OneCoreRun, Report> {
    engine(&OneCore { step_limit, ..OneCore::new(config, isa, program) }, Memory::new(vec![0; memory]))
}

/// The formats that a source defines.
fn formats(text: &str) -> Vec<(String, i64)> {
    let definitions = text.lines().filter_map(|line| line.trim().strip_prefix(".format "));
    let pairs = definitions.filter_map(|rest| rest.split(';').next()?.split_once(','));
    pairs.filter_map(|(name, bits)| Some((name.trim().to_owned(), bits.trim().parse().ok()?))).collect()
}

/// The classes that occur, in their order.
pub fn count_text(counts: &Counts) -> String {
    let parts: Vec<String> = counts
        .iter()
        .filter(|&(_, count)| count != 0)
        .map(|(class, count)| format!("{} {count}", class.name()))
        .collect();
    if parts.is_empty() { "none".into() } else { parts.join(", ") }
}
