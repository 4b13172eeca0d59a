//! The assembler inside a body: operands and temporaries are registers, instructions become steps.

use isa::definition::{InstructionDef, Kind};
use isa::extension::{BodyAct, BodyStep, Immediate, registers};
use isa::table::Op;
use isa::{Fields, Instruction};

use super::MOST_STEPS;
use crate::assembler::Assembler;
use crate::cursor::Cursor;
use crate::evaluation::EvaluationFailure;
use crate::explain;
use crate::instruction::{Argument, Value, out_of_range};
use crate::line::OriginLine;
use crate::message::{At, Parsed, Problem};
use crate::operand::{Register, looks_like_register};
use crate::token::TokenKind as Token;

/// The body that is being assembled.
pub(crate) struct Template {
    /// The instruction whose body it is.
    pub op: Op,
    pub definition: InstructionDef,
    /// Line of the row, for steps that come from other files.
    pub row_line: u32,
    pub steps: Vec<BodyStep>,
    /// Source of the steps.
    pub places: Vec<At>,
    /// The lines that all bodies of the file share are being read.
    pub is_shared: bool,
}

/// Temporaries: what their names begin with, and their file.
const TEMPORARIES: [(&str, char); 3] = [("tv", 'v'), ("tw", 'w'), ("t", 's')];

/// The name of a register of a body, for messages.
pub(super) fn register_name(file: char, number: u8) -> String {
    match registers::letter(number) {
        Some((letter, 0)) => (letter as char).to_string(),
        Some((letter, offset)) => format!("{}+{offset}", letter as char),
        None if number == 0 => "s0".to_owned(),
        None => {
            let prefix = TEMPORARIES.iter().find(|(_, of)| *of == file).map_or("t", |(prefix, _)| prefix);
            format!("{prefix}{}", number - registers::hidden(file).start)
        }
    }
}

impl Template {
    pub fn operand(&self, letter: u8) -> Option<&isa::definition::Operand> {
        self.definition.operand(letter)
    }

    /// The names that a body may use, for hints.
    fn owns(&self) -> String {
        let letters: Vec<String> = (self.definition.operands.iter())
            .filter(|operand| operand.kind.register_file().is_some())
            .map(|operand| format!("`{}`", operand.letter as char))
            .collect();
        let operands = if letters.is_empty() { String::new() } else { format!("its operands {}, ", letters.join(" ")) };
        format!("it has {operands}temporaries t0 to t31, tv0 to tv31, tw0 to tw7, and s0")
    }

    /// The register of a name, in a body.
    pub fn register(&self, text: &str, at: At) -> Parsed<Option<Register>> {
        if text == "s0" {
            return Ok(Some(('s', 0)));
        }
        if looks_like_register(text) {
            let message = format!("the body of `{}` does not own `{text}`", self.definition.name);
            return Err(Problem::new(explain::BODY, message, at, "belongs to the program").hint(self.owns()));
        }
        // Operands of the row by their letters.
        if let &[letter] = text.as_bytes()
            && let Some(operand) = self.operand(letter)
            && let Some(file) = operand.kind.register_file()
        {
            return Ok(Some((file, registers::operand(letter, 0))));
        }
        // Temporaries: `t` for scalars, `tv` and `tw` for the other files.
        for (prefix, file) in TEMPORARIES {
            let Some(digits) = text.strip_prefix(prefix).filter(|digits| !digits.is_empty()) else { continue };
            let is_plain = digits.bytes().all(|c| c.is_ascii_digit()) && (digits == "0" || !digits.starts_with('0'));
            if !is_plain {
                continue;
            }
            let hidden = registers::hidden(file);
            let number = digits.parse().ok().and_then(|number: u8| hidden.start.checked_add(number));
            return match number.filter(|number| hidden.contains(number)) {
                Some(number) => Ok(Some((file, number))),
                None => {
                    let message = format!("there is no temporary `{text}`");
                    let most = format!("{prefix}0 to {prefix}{}", hidden.len() - 1);
                    Err(Problem::new(explain::BODY, message, at, "no such register").hint(format!("there are {most}")))
                }
            };
        }
        Ok(None)
    }

    /// A register of a group, such as `c+1`, when that is written behind its letter.
    pub fn member(&self, register: Register, at: At, cursor: &mut Cursor) -> Parsed<(Register, At)> {
        let (file, number) = register;
        // Only the letter of an operand is counted from: temporaries have numbers of their own.
        let Some((letter, 0)) = registers::letter(number) else { return Ok((register, at)) };
        let count = self.operand(letter).map_or(1, |operand| operand.kind.registers());
        let first = cursor.position;
        if !cursor.accept("+") {
            return Ok((register, at));
        }
        let found = cursor.peek().filter(|token| token.kind == Token::Integer);
        let Some(token) = found else { return Err(cursor.expected("which register of the group")) };
        // Of `c: V3` the registers are `c`, `c+1` and `c+2`; `c+0` is `c`
        let offset: Option<u8> = cursor.text(token).parse().ok().filter(|&offset| offset < count);
        cursor.skip();
        let whole = at.to(cursor.since(first));
        let letter = letter as char;
        match offset {
            Some(offset) => Ok(((file, number + offset), whole)),
            None if count == 1 => {
                let message = format!("`{letter}` is one register");
                Err(Problem::new(explain::BODY, message, whole, "no others belong to it"))
            }
            None => {
                let message = format!("`{letter}` is a group of {count} registers");
                Err(Problem::new(
                    explain::BODY,
                    message,
                    whole,
                    format!("{letter}, {letter}+1 to {letter}+{}", count - 1),
                ))
            }
        }
    }

    /// The error for data in a body.
    pub fn place_of_data(&self) -> &'static str {
        "a body has instructions, labels and macros; data belong to the program, which hands over their address"
    }
}

impl Assembler<'_> {
    /// Notes that a step follows; `false` outside of bodies' instructions, which is reported.
    pub(crate) fn takes_step(&mut self, line: &OriginLine) -> bool {
        let Some(template) = &mut self.body else { return true };
        if template.is_shared {
            let message = "an instruction stands outside of `.instr` and `.end`";
            self.messages.add(Problem::new(explain::BODY, message, line.at_all(), "belongs to no instruction"));
            return false;
        }
        if template.steps.len() == MOST_STEPS {
            let message = format!("the body has more than {MOST_STEPS} instructions");
            self.give_up(Problem::new(explain::SIZE, message, line.at_all(), "one too many"));
            return false;
        }
        // `set_act` has put the step there when its numbers are known already.
        if template.places.len() == self.program.words.len() {
            let number = if line.source == 0 { line.number } else { template.row_line };
            let pending = BodyAct::End { outcome: 0, jumps: false };
            template.steps.resize(template.places.len() + 1, BodyStep { act: pending, line: number });
            let last = template.steps.len() - 1;
            template.steps[last].line = number;
            template.places.push(line.at_all());
        }
        true
    }

    /// Says what a step does.
    pub(crate) fn set_act(&mut self, step: usize, act: BodyAct) {
        if let Some(template) = &mut self.body {
            if template.steps.len() <= step {
                template.steps.resize(step + 1, BodyStep { act, line: 0 });
            }
            template.steps[step].act = act;
        }
    }

    /// Statements that only bodies have, and those that they must not have.
    pub(crate) fn special_step(&mut self, name: &str, at: At, cursor: &mut Cursor) -> bool {
        if name == "exit" {
            if let Err(problem) = self.exit_step(cursor) {
                self.messages.add(problem);
            }
            return true;
        }
        let Some(template) = &self.body else { return false };
        let Some(&op) = self.operations.get(name) else { return false };
        let problem = match op {
            // Its own name has a message of its own: whoever writes it probably wants a loop.
            Op::Ext(_) if op == template.op => {
                let message = format!("the body of `{name}` contains `{name}` itself");
                Problem::new(explain::BODY, message, at, "recursive")
                    .hint("a loop is written with a label and a branch")
            }
            // Steps have no steps of their own, so engines never go deeper than one body.
            Op::Ext(_) => {
                let message = format!("`{name}` is an instruction of an extension");
                Problem::new(explain::BODY, message, at, "not in a body")
                    .hint("a body consists of built-in instructions; share its lines with a macro")
            }
            Op::call | Op::callr | Op::ret | Op::halt => {
                let message = format!("`{name}` does not stand in a body");
                Problem::new(explain::BODY, message, at, "leaves the instruction")
                    .hint("`exit NAME` ends a body; `jump` and branches stay inside")
            }
            _ => return false,
        };
        self.messages.add(problem);
        true
    }

    /// `exit Name`, or `exit Name, i` where the program goes on at the row's label.
    fn exit_step(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let Some(template) = &self.body else { return Ok(()) };
        let definition = template.definition.clone();
        let names =
            || definition.outcomes.iter().map(|outcome| format!("`{}`", outcome.name)).collect::<Vec<_>>().join(", ");
        // A row with one outcome needs no name for it: `exit` alone ends the body.
        let outcome = if cursor.is_at_end() && definition.outcomes.len() == 1 {
            0
        } else {
            let (name, name_at) = cursor.name("the name of an outcome")?;
            definition.outcome(name).ok_or_else(|| {
                let message = format!("`{}` has no outcome `{name}`", definition.name);
                Problem::new(explain::BODY, message, name_at, "not in its row")
                    .hint(format!("its outcomes: {}", names()))
            })?
        };
        let jumps = cursor.accept(",");
        if jumps {
            let (letter, letter_at) = cursor.name("the row's distance, `i` or `j`")?;
            let is_distance =
                definition.operands.iter().any(|o| o.kind == Kind::Rel && letter.as_bytes() == [o.letter]);
            if !is_distance {
                let message = format!("`{letter}` is no distance of `{}`", definition.name);
                return Err(Problem::new(explain::BODY, message, letter_at, "an operand of kind `Rel` is expected"));
            }
        }
        cursor.end()?;
        // A label in a body is a number of words, so this step takes a word too, as all others do.
        let step = self.program.words.len();
        if self.body.as_ref().is_some_and(|template| !template.is_shared) {
            self.set_act(step, BodyAct::End { outcome: outcome as u8, jumps });
        }
        self.emit(0, cursor.line);
        Ok(())
    }

    /// A step from its operands, as far as its names are known.
    pub(crate) fn encode_step(
        &self,
        op: Op,
        arguments: &[Argument],
        step: usize,
    ) -> Result<BodyAct, Vec<EvaluationFailure>> {
        let (isa, Some(template)) = (self.isa, &self.body) else { return Err(Vec::new()) };
        let definition = isa.definition(op);
        let mut fields = Fields::default();
        let mut immediates = [Immediate::Number(0); 2];
        let mut failures = Vec::new();
        for (argument, operand) in arguments.iter().zip(definition.operands.iter()) {
            let width = definition.pattern.field(operand.letter).map_or(32, |field| field.width);
            let range = operand.kind.range(width);
            // Immediates `i` and `j` have a place each.
            let place = usize::from(operand.letter == b'j');
            let number = match &argument.value {
                Value::Known(number) if operand.kind.register_file().is_some() => {
                    fields.set(operand.letter, *number as i32);
                    failures.extend(
                        template
                            .check_register(definition, *operand, *number as u8, argument.at)
                            .err()
                            .map(EvaluationFailure::Wrong),
                    );
                    continue;
                }
                Value::Known(number) => Ok(Immediate::Number(*number as i32)),
                Value::Expression(expression) if operand.kind == Kind::Rel => self
                    .evaluate(expression)
                    .and_then(|target| self.distance(expression, target, step))
                    .and_then(|distance| {
                        // A branch stays between the first step and the end of the body.
                        let inside = 0..=self.last_step(step);
                        if inside.contains(&(step as i64 + distance)) {
                            Ok(Immediate::Number(distance as i32))
                        } else {
                            let message = "the branch leads out of the body";
                            Err(EvaluationFailure::Wrong(
                                Problem::new(explain::BODY, message, argument.at, "no step of it")
                                    .hint("`exit NAME` ends a body"),
                            ))
                        }
                    }),
                Value::Expression(expression) => self.immediate(expression, definition, *operand, range),
            };
            // Numbers are held to their fields now; letters of immediates when the instruction is spliced.
            match number {
                Ok(Immediate::Number(number))
                    if operand.kind != Kind::Rel && !(range.0..=range.1).contains(&i64::from(number)) =>
                {
                    failures.push(EvaluationFailure::Wrong(out_of_range(
                        definition,
                        *operand,
                        argument.at,
                        number.into(),
                        range,
                    )));
                }
                Ok(immediate) => {
                    immediates[place] = immediate;
                    if let Immediate::Number(number) = immediate {
                        fields.set(operand.letter, number);
                    }
                }
                Err(failure) => failures.push(failure),
            }
        }
        if !failures.is_empty() {
            return Err(failures);
        }
        Ok(BodyAct::Execute { instruction: Instruction { op, fields }, immediates })
    }

    /// The largest step that a branch may lead to: the end of the body, once that is known.
    fn last_step(&self, step: usize) -> i64 {
        if self.is_last_pass { self.program.words.len() as i64 } else { step as i64 }
    }
}

impl Template {
    /// A step may have a register where it has it.
    fn check_register(
        &self,
        definition: &InstructionDef,
        operand: isa::definition::Operand,
        number: u8,
        at: At,
    ) -> Parsed<()> {
        let Some(file) = operand.kind.register_file() else { return Ok(()) };
        let count = operand.kind.registers();
        let name = register_name(file, number);
        // The whole group lies in one operand, in `s0`, or among the temporaries.
        let fits = match registers::letter(number) {
            Some((letter, offset)) => self.operand(letter).is_some_and(|own| offset + count <= own.kind.registers()),
            None if number == 0 => count == 1,
            None => number + count <= registers::hidden(file).end,
        };
        if !fits {
            let message = format!("`{name}` is not the first of {count} registers here");
            let label = format!("operand `{}` of `{}`", operand.letter as char, definition.name);
            return Err(
                Problem::new(explain::BODY, message, at, label).hint("the registers of a group stand side by side")
            );
        }
        if operand.is_written()
            && let Some((letter, _)) = registers::letter(number)
            && let Some(own) = self.operand(letter)
            && !own.is_written()
        {
            let message = format!("the body writes `{name}`, which `{}` only reads", self.definition.name);
            let hint = "write a temporary, or call the operand `x` or `y` in the row, which is read and written";
            return Err(Problem::new(explain::BODY, message, at, "does not own it").hint(hint));
        }
        Ok(())
    }
}

/// The name of a destination in messages.
pub(super) fn letter_name(letter: u8, offset: u8, count: u8) -> String {
    if count > 1 { format!("{}+{offset}", letter as char) } else { (letter as char).to_string() }
}
