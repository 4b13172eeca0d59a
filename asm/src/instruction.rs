//! Instructions: written operands held against a row, encoded now or when the names that they use are known.

use isa::definition::{InstructionDef, Kind};
use isa::table::Op;

use crate::assembler::{Assembler, Fixup};
use crate::cursor::Cursor;
use crate::evaluation::EvaluationFailure;
use crate::explain;
use crate::expression::Expression;
use crate::message::{Among, At, Problem};
use crate::operand::{ParsedOperand, Written, file_name};
use crate::symbol::SymbolValue;

/// An operand as a row takes it.
#[derive(Clone, Debug)]
pub(crate) struct Argument {
    pub value: Value,
    pub at: At,
}

/// The number of an argument.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Known(i64),
    Expression(Expression),
}

/// The description of a kind of operand, for messages and manuals.
pub fn describe(kind: Kind) -> &'static str {
    match kind {
        Kind::S => "a scalar register",
        Kind::V => "a vector register",
        Kind::W => "a wide accumulator",
        Kind::A => "a scalar register with an address",
        Kind::Sh => "a shift in bits",
        Kind::Im => "a signed number",
        Kind::Un => "an unsigned number",
        Kind::Off => "an offset in octets",
        Kind::Rel => "a label or a word address",
        Kind::Lane => "a component: 0, 1, 2 or x, y, z",
        _ => match (kind.register_file(), kind.registers()) {
            (Some('v'), 2) => "the first of two vector registers",
            (Some('v'), 3) => "the first of three vector registers",
            (Some('v'), _) => "the first of several vector registers",
            (Some('w'), _) => "the first of several wide accumulators",
            _ => "the first of several scalar registers",
        },
    }
}

fn takes_offset(definition: &InstructionDef, at: usize) -> bool {
    definition.operands[at].kind.register_file() == Some('s')
        && definition.operands.get(at + 1).is_some_and(|o| o.kind == Kind::Off)
}

/// The row as a person writes it, such as `lw d, i(a)`.
pub fn usage(definition: &InstructionDef) -> String {
    let mut parts = Vec::new();
    let mut at = 0;
    while at < definition.operands.len() {
        let letter = definition.operands[at].letter as char;
        if takes_offset(definition, at) {
            parts.push(format!("{}({letter})", definition.operands[at + 1].letter as char));
            at += 2;
        } else {
            parts.push(letter.to_string());
            at += 1;
        }
    }
    format!("{} {}", definition.name, parts.join(", ")).trim_end().to_string()
}

fn legend(definition: &InstructionDef) -> String {
    let parts: Vec<String> =
        definition.operands.iter().map(|o| format!("{} is {}", o.letter as char, describe(o.kind))).collect();
    if parts.is_empty() { "it takes no operands".into() } else { parts.join(", ") }
}

impl Assembler<'_> {
    /// Assembles an instruction, a pseudo-instruction or a macro call.
    pub(crate) fn instruction(&mut self, name: &str, at: At, cursor: &mut Cursor) {
        // No macro has the name of an instruction.
        if let Some(definition) = self.macros.get(name).cloned() {
            self.call_macro(&definition, at, cursor);
            return;
        }
        if self.body.is_some() && self.special_step(name, at, cursor) {
            return;
        }
        let op = self.operations.get(name).copied();
        let pseudo = crate::pseudo::find(name);
        // A word of zeros keeps the place, so that later labels and messages are right.
        if op.is_none() && pseudo.is_none() {
            if !self.is_incomplete {
                let problem = self.unknown_instruction(name, at, cursor.is_at_end());
                self.messages.add(problem);
            }
            self.emit(0, cursor.line);
            return;
        }
        let (first_use, first_word) = (self.name_uses.len(), self.program.words.len() as u32);
        let operands = match self.operands(cursor) {
            Ok(operands) => operands,
            Err(problem) => {
                self.messages.add(problem);
                self.emit(0, cursor.line);
                return;
            }
        };
        match (op, pseudo) {
            (Some(op), _) => self.row_instruction(op, &operands, at, cursor),
            (None, Some(pseudo)) => self.pseudo_instruction(pseudo, &operands, at, cursor),
            (None, None) => unreachable!("refused above"),
        }
        self.place_uses(first_use, first_word);
    }

    /// The first word of a statement means nothing.
    pub(crate) fn unknown_instruction(&self, name: &str, at: At, is_alone: bool) -> Box<Problem> {
        let message = format!("`{name}` is not an instruction");
        let problem =
            Problem::new(explain::INSTRUCTION, message, at, "unknown mnemonic").suggest(name, Among::Instructions);
        if is_alone { problem.hint(format!("a label needs a colon: `{name}:`")) } else { problem }
    }

    /// Assembles one instruction of a row.
    pub(crate) fn row_instruction(&mut self, op: Op, operands: &[ParsedOperand], at: At, cursor: &Cursor) {
        let isa = self.isa;
        let definition = isa.definition(op);
        let Some(mut arguments) = self.arguments(definition, operands, at) else {
            self.emit(definition.pattern.value, cursor.line);
            return;
        };
        let pc = self.program.words.len();
        // In a body a step takes the place of the word.
        let encoded = match self.body {
            None => self.encode(op, &arguments, pc),
            Some(_) => self.encode_step(op, &arguments, pc).map(|act| {
                self.set_act(pc, act);
                0
            }),
        };
        let word = match encoded {
            Ok(word) => word,
            Err(failures) => {
                let mut is_later = false;
                for failure in failures {
                    match failure {
                        EvaluationFailure::Later(..) => is_later = true,
                        other => self.report_failure(other),
                    }
                }
                // Names that come further on: keep the operands, with today's values of those that may change.
                if is_later {
                    for argument in &mut arguments {
                        if let Value::Expression(expression) = &mut argument.value {
                            self.settle(expression);
                        }
                    }
                    self.fixups.push(Fixup::Instruction { op, arguments, pc });
                }
                definition.pattern.value
            }
        };
        self.emit(word, cursor.line);
    }

    /// Holds written operands against the row; `None` when what is wrong was reported.
    pub(crate) fn arguments(
        &mut self,
        definition: &InstructionDef,
        operands: &[ParsedOperand],
        at: At,
    ) -> Option<Vec<Argument>> {
        let mut found = Vec::with_capacity(definition.operands.len());
        let mut rest = operands.iter();
        let mut place = 0;
        let mut is_right = true;
        while place < definition.operands.len() {
            let kind = definition.operands[place].kind;
            let Some(operand) = rest.next() else { break };
            let known = |value: u8| Argument { value: Value::Known(value.into()), at: operand.at };
            // An operand of the text may be two of the row: `8(s2)` is an address and its offset.
            match &operand.written {
                Written::Memory(offset, (file, number), register_at) if takes_offset(definition, place) => {
                    if *file == 's' {
                        found.push(Argument { value: Value::Known((*number).into()), at: *register_at });
                        found.push(Argument { value: Value::Expression(offset.clone()), at: offset.at });
                    } else {
                        let register = ParsedOperand::made(Written::Register((*file, *number)), *register_at);
                        let problem = self.wrong_kind(definition, place, &register);
                        self.messages.add(problem);
                        is_right = false;
                    }
                    place += 2;
                    continue;
                }
                Written::Register((file, number)) if kind.register_file() == Some(*file) => found.push(known(*number)),
                _ if kind == Kind::Lane && operand.component.is_some() => {
                    found.push(known(operand.component.unwrap_or(0) as u8));
                }
                Written::Number(expression) if kind.register_file().is_none() => {
                    found.push(Argument { value: Value::Expression(expression.clone()), at: operand.at });
                }
                _ => {
                    is_right = false;
                    let problem = self.wrong_kind(definition, place, operand);
                    self.messages.add(problem);
                }
            }
            place += 1;
        }
        // Only tell the number of operands when each of them was right.
        let left = rest.count();
        if left > 0 || place < definition.operands.len() {
            if is_right {
                self.messages.add(wrong_count(definition, operands, at));
            }
            return None;
        }
        is_right.then_some(found)
    }

    fn wrong_kind(&self, definition: &InstructionDef, place: usize, operand: &ParsedOperand) -> Box<Problem> {
        let wanted = definition.operands[place];
        let message = format!(
            "operand `{}` of `{}` is {}, not {}",
            wanted.letter as char,
            definition.name,
            describe(wanted.kind),
            operand.describe()
        );
        let label = match wanted.kind.register_file() {
            Some(_) => format!("expected {}", describe(wanted.kind)),
            None => "expected a number".into(),
        };
        let problem = Problem::new(explain::OPERAND_KIND, message, operand.at, label);
        // Guess what was meant
        match &operand.written {
            Written::Number(expression) if wanted.kind.register_file().is_some() => match expression.symbol() {
                // A name that is no register may be a misspelt one.
                Some(name) => problem.suggest(&self.names.text(name).clone(), Among::Registers),
                None if takes_offset(definition, place) => {
                    problem.hint(format!("it is written `{}`", usage(definition)))
                }
                // A number where a register should be: `iadd s1, s2, 4` becomes `iaddi`.
                None => match self.operations.get_key_value(&*format!("{}i", definition.name)) {
                    Some((with_number, _)) => problem.hint(format!("`{with_number}` takes a number")),
                    None => problem,
                },
            },
            Written::Number(_) => problem,
            Written::Memory(..) => problem.hint(format!("it is written `{}`", usage(definition))),
            Written::Register(_) => problem,
        }
    }

    /// Encodes an instruction as far as its names are known.
    pub(crate) fn encode(&self, op: Op, arguments: &[Argument], pc: usize) -> Result<u32, Vec<EvaluationFailure>> {
        let isa = self.isa;
        let definition = isa.definition(op);
        // Gather the failures of all operands, so that a person sees them at once
        let mut numbers = Vec::with_capacity(arguments.len());
        let mut failures = Vec::new();
        for (argument, operand) in arguments.iter().zip(definition.operands.iter()) {
            let value = match &argument.value {
                Value::Known(value) => Ok(*value),
                Value::Expression(expression) if operand.kind == Kind::Rel => {
                    self.evaluate(expression).and_then(|target| self.distance(expression, target, pc))
                }
                Value::Expression(expression) => self.evaluate(expression),
            };
            // Registers have ranges too: the first of three vectors is v0 to v29.
            let width = definition.pattern.field(operand.letter).map_or(32, |field| field.width);
            let (least, most) = operand.kind.range(width);
            match value {
                Err(failure) => failures.push(failure),
                Ok(number) if number < least || number > most => {
                    failures.push(EvaluationFailure::Wrong(out_of_range(
                        definition,
                        *operand,
                        argument.at,
                        number,
                        (least, most),
                    )));
                }
                Ok(number) => numbers.push(number),
            }
        }
        if !failures.is_empty() {
            return Err(failures);
        }
        Ok(isa.encode(op, &numbers).expect("count and ranges were checked"))
    }

    pub(crate) fn distance(&self, expression: &Expression, target: i64, pc: usize) -> Result<i64, EvaluationFailure> {
        if let Some(name) = expression.symbol()
            && let Some(symbol) = self.names.get(name)
            && matches!(symbol.value, SymbolValue::Buffer(_))
        {
            let text = self.names.text(name);
            let message = format!("`{text}` is an address in the buffer, not in the code");
            return Err(EvaluationFailure::Wrong(
                Problem::new(explain::SECTION, message, expression.at, "cannot be branched to")
                    .also(symbol.at, "defined here"),
            ));
        }
        let overflow = || {
            EvaluationFailure::Wrong(Problem::new(
                explain::OVERFLOW,
                "the distance does not fit 64 bits",
                expression.at,
                "here",
            ))
        };
        target.checked_sub(pc as i64).ok_or_else(overflow)
    }
}

fn wrong_count(definition: &InstructionDef, operands: &[ParsedOperand], at: At) -> Box<Problem> {
    let place = operands.last().map_or(at, |last| at.to(last.at));
    let count = |number: usize| match number {
        0 => "no operands".to_string(),
        1 => "1 operand".to_string(),
        more => format!("{more} operands"),
    };
    let usage = usage(definition);
    let (message, label) = if usage.contains('(') {
        (format!("`{}` is written `{usage}`", definition.name), format!("{} here", count(operands.len())))
    } else {
        let message =
            format!("`{}` takes {}, not {}", definition.name, count(definition.operands.len()), operands.len());
        (message, format!("it is written `{usage}`"))
    };
    Problem::new(explain::OPERAND_COUNT, message, place, label).hint(legend(definition))
}

pub(crate) fn out_of_range(
    definition: &InstructionDef,
    operand: isa::definition::Operand,
    at: At,
    number: i64,
    (least, most): (i64, i64),
) -> Box<Problem> {
    let (letter, kind) = (operand.letter as char, operand.kind.name());
    let name = &definition.name;
    // A label too far away: only branches have a way out, by a jump
    if operand.kind == Kind::Rel {
        let message = format!("the target is {number} words away, beyond the reach of `{name}`");
        let problem =
            Problem::new(explain::REACH, message, at, format!("operand `{letter}` ({kind}) reaches {least} to {most}"));
        return if name == "jump" || name == "call" {
            problem
        } else {
            problem.hint("branch the other way around a `jump`, which reaches further")
        };
    }
    // A group that ends beyond the last register: v30 may be the first of two, but not of three
    if let (Some(file), true) = (operand.kind.register_file(), operand.kind.registers() > 1) {
        let count = operand.kind.registers();
        let message = format!("`{file}{number}` cannot be the first of {count} registers");
        let (hint, _) = file_name(file);
        let label = format!("operand `{letter}` ({kind}) is {file}{least} to {file}{most}");
        return Problem::new(explain::RANGE, message, at, label).hint(hint);
    }
    let message = format!("{number} does not fit operand `{letter}` of `{name}`");
    let what = describe(operand.kind);
    Problem::new(explain::RANGE, message, at, format!("{what} ({kind}) is {least} to {most} here"))
}
