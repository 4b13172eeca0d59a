//! Holds a meaning in Rust against the body beside it, on random operands.

use std::fmt;

use isa::number::Vector;
use isa::table::Op;
use isa::{InstructionDef, Isa, Kind, Program, register_name};
use messages::Diagnostic;
use random::SplitMix64;

use crate::code::Code;
use crate::code::octets::Memory;
use crate::code::registers::{Registers, SCALARS, VECTORS, WIDES};
use crate::machine::Config;
use crate::machine::one_core::{OneCore, OneCoreRun, run};

/// Octets of the buffer and of global memory, filled at random, that the instruction may reach.
const OCTETS: usize = 4096;

/// Trial of a meaning: what is compared, and how closely.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Executions, each on other operands.
    pub cases: u32,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Largest difference of a result, in raw units, that is none: what an approximation is allowed.
    pub tolerance: u64,
    /// Immediates that are always the same, by their letters; others are random.
    pub immediates: Vec<(char, i64)>,
    /// The machine: its arithmetic and its buffer.
    pub config: Config,
}

impl Default for Trial {
    fn default() -> Trial {
        Trial { cases: 1000, seed: 1, tolerance: 0, immediates: Vec::new(), config: Config::default() }
    }
}

/// Agreement of a comparison without a mismatch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Agreement {
    /// Executions that both ended.
    pub ended: u32,
    /// Executions that both stopped with a trap.
    pub trapped: u32,
    /// Largest difference of a result, in raw units.
    pub largest: u64,
}

/// Operands on which meaning and body differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InstructionMismatch {
    /// The instruction as assembly text.
    pub instruction: String,
    /// Operands before the instruction: name and value.
    pub operands: Vec<(String, String)>,
    /// Differences: name, value by the body, value by the meaning.
    pub differences: Vec<(String, String, String)>,
}

impl fmt::Display for InstructionMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "`{}` does not do what its body does", self.instruction)?;
        for (name, value) in &self.operands {
            writeln!(f, "  before: {name} = {value}")?;
        }
        for (name, body, meaning) in &self.differences {
            writeln!(f, "  {name}: {body} by the body, {meaning} by the meaning")?;
        }
        Ok(())
    }
}

impl std::error::Error for InstructionMismatch {}

impl InstructionMismatch {
    /// The message for a person.
    pub fn diagnostic(&self) -> Diagnostic {
        Diagnostic::error(self.to_string().trim_end())
    }
}

/// Executes an instruction on random operands, by its meaning and by its body, and compares registers, buffer, exit and way on. Each
/// execution starts from reset, so the state of a meaning is that at the start of a work item.
///
/// # Errors
/// The first operands on which they differ.
///
/// # Panics
/// The instruction has no body or no meaning.
pub fn check(isa: &Isa, name: &str, trial: &Trial) -> Result<Agreement, Box<InstructionMismatch>> {
    let op = isa.find(name).filter(|&op| isa.body(op).is_some() && isa.semantics(op).is_some());
    let op = op.expect("the instruction has a meaning in Rust and a body beside it");
    let mut by_body = isa.clone();
    by_body.set_semantics(op, None);
    let mut random = OperandRandom(SplitMix64::new(trial.seed));
    let mut agreement = Agreement::default();
    for _ in 0..trial.cases {
        let case = InstructionCase::new(isa, op, trial, &mut random);
        let [body, meaning] = [&by_body, isa].map(|isa| case.run(isa, trial));
        let differences = match (&body.trap, &meaning.trap) {
            (Some(_), Some(_)) => {
                agreement.trapped += 1;
                continue;
            }
            // Only runs that both end have results; how a trapped one leaves its registers is no promise.
            (None, None) => case.differences(isa, op, [&body, &meaning], trial.tolerance, &mut agreement.largest),
            traps => {
                let text = |trap: &Option<crate::code::trap::Trap>| match trap {
                    Some(trap) => format!("a trap ({})", trap.kind),
                    None => "no trap".to_owned(),
                };
                vec![("ends with".to_owned(), text(traps.0), text(traps.1))]
            }
        };
        if !differences.is_empty() {
            let instruction = case.instruction(isa);
            return Err(Box::new(InstructionMismatch { instruction, operands: case.operands(isa, op), differences }));
        }
        agreement.ended += 1;
    }
    Ok(agreement)
}

/// Numbers of operands.
struct OperandRandom(SplitMix64);

impl OperandRandom {
    fn next(&mut self) -> u64 {
        self.0.bits()
    }

    fn below(&mut self, end: u64) -> u64 {
        self.0.below(end)
    }

    /// A number of `bits` bits: small ones, edges, and any, down to few bits.
    fn number(&mut self, bits: u32) -> i64 {
        // Uniform numbers of 32 bits would nearly all be large: the number of bits is chosen first, then they.
        let (least, most) = (i64::MIN >> (64 - bits), i64::MAX >> (64 - bits));
        match self.below(8) {
            0 => self.below(7) as i64 - 3,
            1 => least,
            2 => most,
            _ => (self.next() as i64) >> (64 - bits + self.below(bits.into()) as u32),
        }
    }
}

/// An instruction with what it finds.
struct InstructionCase {
    program: Program,
    registers: Registers,
    memory: Memory,
}

impl InstructionCase {
    fn new(isa: &Isa, op: Op, trial: &Trial, random: &mut OperandRandom) -> InstructionCase {
        let word = trial.config.arithmetic.word;
        let row = isa.definition(op);
        let fields: Vec<i64> = (row.operands.iter())
            .map(|operand| {
                let (least, most) =
                    operand.kind.range(row.pattern.field(operand.letter).map_or(5, |field| field.width));
                let fixed = trial.immediates.iter().find(|(letter, _)| *letter == operand.letter as char);
                match operand.kind {
                    _ if fixed.is_some() => fixed.map_or(0, |&(_, value)| value.clamp(least, most)),
                    // Behind the instruction stand two `halt`.
                    Kind::Rel => 2,
                    // Few registers, so that operands often share one.
                    kind if kind.register_file().is_some() => random.below(most.min(7) as u64 + 1) as i64,
                    _ => least + random.below((most - least + 1) as u64) as i64,
                }
            })
            .collect();
        let tested = isa.encode(op, &fields).expect("the fields are in their ranges");
        // Two ends, so that the program counter tells which way the instruction went on
        let halt = isa.encode(Op::halt, &[]).expect("it has no operands");
        let mut registers = Registers::default();
        (0..SCALARS as u8).for_each(|number| registers.set_scalar(number, random.number(word) as i32));
        (0..VECTORS as u8)
            .for_each(|number| registers.set_vector(number, [0; 3].map(|_: i32| random.number(word) as i32)));
        (0..WIDES as u8).for_each(|number| registers.set_wide(number, random.number(2 * word)));
        for operand in row.operands.iter().zip(&fields).filter(|(operand, _)| operand.kind == Kind::A) {
            // Addresses mostly lead to where there is something.
            if random.below(8) != 0 {
                registers.set_scalar(*operand.1 as u8, random.below(OCTETS as u64 - 64) as i32);
            }
        }
        let octets = |random: &mut OperandRandom| (0..OCTETS).map(|_| random.next() as u8).collect::<Vec<u8>>();
        let program = Program { words: vec![tested, halt, halt], buffer: octets(random), ..Program::default() };
        InstructionCase { program, registers, memory: Memory::new(octets(random)) }
    }

    fn run(&self, isa: &Isa, trial: &Trial) -> OneCoreRun {
        let one_core = OneCore {
            registers: self.registers.clone(),
            step_limit: 1 << 20,
            ..OneCore::new(&trial.config, isa, &self.program)
        };
        run(&one_core, self.memory.clone()).expect("the machine holds the case")
    }

    fn instruction(&self, isa: &Isa) -> String {
        let instruction = isa.decode(self.program.words[0]).expect("it was encoded");
        instruction.text(isa, |distance| format!(".{distance:+}"))
    }

    fn operands(&self, isa: &Isa, op: Op) -> Vec<(String, String)> {
        let read = isa.definition(op).operands.iter().filter(|operand| operand.is_read());
        let places = read.flat_map(|operand| self.places(isa, operand.letter, operand.kind));
        places.map(|place| (place.name(), place.show(&self.registers))).collect()
    }

    /// The registers of an operand.
    fn places(&self, isa: &Isa, letter: u8, kind: Kind) -> Vec<OperandPlace> {
        let first = isa.decode(self.program.words[0]).map_or(0, |found| found.fields.get(letter) as u8);
        (0..kind.registers()).map(|at| OperandPlace { letter, kind, number: first + at }).collect()
    }

    fn differences(
        &self,
        isa: &Isa,
        op: Op,
        [body, meaning]: [&OneCoreRun; 2],
        tolerance: u64,
        largest: &mut u64,
    ) -> Vec<(String, String, String)> {
        let mut found = Vec::new();
        let row = isa.definition(op);
        let written = row.operands.iter().filter(|operand| operand.is_written());
        for place in written.flat_map(|operand| self.places(isa, operand.letter, operand.kind)) {
            let (a, b) = (&body.state.registers, &meaning.state.registers);
            let apart = place.apart(a, b);
            // Differences that are refused stand in the message; the largest tells of those that are allowed.
            *largest = (*largest).max(if apart <= tolerance { apart } else { 0 });
            if apart > tolerance {
                found.push((place.name(), place.show(a), place.show(b)));
            }
        }
        let buffers = body.state.buffer.octets().iter().zip(meaning.state.buffer.octets());
        if let Some((at, (a, b))) = buffers.enumerate().find(|(_, (a, b))| a != b) {
            found.push((format!("octet {at} of the buffer"), a.to_string(), b.to_string()));
        }
        let exit = |isa: &Isa, run: &OneCoreRun| exit(isa, row, &self.program, run);
        let mut by_body = isa.clone();
        by_body.set_semantics(op, None);
        let exits = (exit(&by_body, body), exit(isa, meaning));
        if exits.0 != exits.1 {
            found.push(("exit".to_owned(), exits.0, exits.1));
        }
        if body.state.pc != meaning.state.pc {
            let way = |run: &OneCoreRun| if run.state.pc == 1 { "behind it" } else { "at the distance" };
            found.push(("goes on".to_owned(), way(body).to_owned(), way(meaning).to_owned()));
        }
        found
    }
}

/// The exit by which the first word ended.
fn exit(isa: &Isa, row: &InstructionDef, program: &Program, run: &OneCoreRun) -> String {
    let code = Code::new(program, isa, Default::default());
    let taken = (0..row.outcomes.len()).find(|&exit| run.tally.passes(&code, 0, exit).count != 0);
    taken.map_or_else(|| "none".to_owned(), |exit| row.outcomes[exit].name.to_string())
}

/// A register of an operand.
struct OperandPlace {
    letter: u8,
    kind: Kind,
    number: u8,
}

impl OperandPlace {
    fn name(&self) -> String {
        format!("`{}` ({})", self.letter as char, register_name(self.kind, self.number))
    }

    fn components(&self, registers: &Registers) -> Vec<i64> {
        match self.kind.register_file() {
            Some('s') => vec![registers.scalar(self.number).into()],
            Some('v') => {
                let components: Vector = registers.vector(self.number);
                components.map(i64::from).to_vec()
            }
            _ => vec![registers.wide(self.number)],
        }
    }

    fn show(&self, registers: &Registers) -> String {
        let components: Vec<String> = self.components(registers).iter().map(i64::to_string).collect();
        if components.len() == 1 { components[0].clone() } else { format!("({})", components.join(", ")) }
    }

    fn apart(&self, a: &Registers, b: &Registers) -> u64 {
        let components = self.components(a).into_iter().zip(self.components(b));
        components.map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
    }
}
