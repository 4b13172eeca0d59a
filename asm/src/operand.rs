//! Operands as they are written, before any row says what it wants.

use crate::assembler::Assembler;
use crate::cursor::Cursor;
use crate::explain;
use crate::expression::{EvaluationStep, Expression};
use crate::message::{Among, At, Parsed, Problem};
use crate::token::TokenKind;

/// A register: its file's letter and its number.
pub(crate) type Register = (char, u8);

/// An operand as written.
#[derive(Clone, Debug)]
pub(crate) enum Written {
    /// `s5`, or an alias of it.
    Register(Register),
    /// `8(s2)`.
    Memory(Expression, Register, At),
    /// A number or a label.
    Number(Expression),
}

/// An operand with its place and its text.
#[derive(Clone, Debug)]
pub(crate) struct ParsedOperand {
    pub written: Written,
    pub at: At,
    /// Set where the operand is one of the names of components, whatever else that name stands for.
    pub component: Option<i64>,
}

impl ParsedOperand {
    /// An operand that is not in the text.
    pub fn made(written: Written, at: At) -> ParsedOperand {
        ParsedOperand { written, at, component: None }
    }

    /// A number as an operand.
    pub fn number(value: i64, at: At) -> ParsedOperand {
        ParsedOperand::made(Written::Number(Expression { steps: vec![(EvaluationStep::Number(value), at)], at }), at)
    }

    /// The operand's description, for messages.
    pub fn describe(&self) -> &'static str {
        match self.written {
            Written::Register(('s', _)) => "a scalar register",
            Written::Register(('v', _)) => "a vector register",
            Written::Register(_) => "a wide accumulator",
            Written::Memory(..) => "an address with an offset",
            Written::Number(_) => "a number",
        }
    }
}

/// The name of a register file.
pub(crate) fn file_name(file: char) -> (&'static str, u8) {
    match file {
        's' => ("scalar registers are s0 to s31", 31),
        'v' => ("vector registers are v0 to v31", 31),
        _ => ("wide accumulators are w0 to w7", 7),
    }
}

/// A name looks like a register's: nothing else may be called so.
pub(crate) fn looks_like_register(text: &str) -> bool {
    let rest = text.strip_prefix(['s', 'v', 'w']).unwrap_or("");
    !rest.is_empty() && rest.bytes().all(|c| c.is_ascii_digit())
}

impl Assembler<'_> {
    /// The register of a name or alias.
    ///
    /// # Errors
    /// A name such as `s32` of a register that does not exist.
    pub(crate) fn register(&self, text: &str, at: At) -> Parsed<Option<Register>> {
        if let Some(template) = &self.body
            && let Some(register) = template.register(text, at)?
        {
            return Ok(Some(register));
        }
        if let Some(register) = isa::parse_register(text) {
            return Ok(Some(register));
        }
        if looks_like_register(text) {
            let (hint, _) = file_name(text.chars().next().unwrap_or('s'));
            let message = format!("there is no register `{text}`");
            return Err(Problem::new(explain::REGISTER, message, at, "no such register").hint(hint));
        }
        Ok(self.alias(text).map(|alias| alias.register))
    }

    /// Reads the operands of an instruction.
    pub(crate) fn operands(&mut self, cursor: &mut Cursor) -> Parsed<Vec<ParsedOperand>> {
        let mut operands = Vec::with_capacity(4);
        if cursor.is_at_end() {
            return Ok(operands);
        }
        loop {
            operands.push(self.operand(cursor)?);
            if cursor.is_at_end() {
                return Ok(operands);
            }
            if !cursor.accept(",") {
                return Err(cursor.expected("a comma or the end of the line"));
            }
        }
    }

    fn operand(&mut self, cursor: &mut Cursor) -> Parsed<ParsedOperand> {
        let first = cursor.position;
        let component = cursor.peek().and_then(|token| match cursor.text(token) {
            "x" => Some(0),
            "y" => Some(1),
            "z" => Some(2),
            _ => None,
        });
        // A register; one called `x` may still be meant as a component.
        if let Some((register, _)) = self.register_here(cursor)? {
            return Ok(ParsedOperand { written: Written::Register(register), at: cursor.since(first), component });
        }
        // `(s2)` is `0(s2)`; any other parenthesis belongs to an expression.
        if cursor.is_mark("(") {
            let mut ahead = *cursor;
            ahead.skip();
            if let Some((register, at)) = self.register_here(&mut ahead)? {
                ahead.expect(")")?;
                *cursor = ahead;
                let zero = Expression { steps: vec![(EvaluationStep::Number(0), at)], at };
                return Ok(ParsedOperand {
                    written: Written::Memory(zero, register, at),
                    at: cursor.since(first),
                    component: None,
                });
            }
        }
        let expression = self.expression(cursor)?;
        if cursor.accept("(") {
            let Some((register, at)) = self.register_here(cursor)? else {
                let problem = cursor.expected("a register");
                return Err(match cursor.peek() {
                    Some(token) if token.kind == TokenKind::Name => {
                        problem.suggest(cursor.text(token), Among::Registers)
                    }
                    _ => problem,
                });
            };
            cursor.expect(")")?;
            let at_all = cursor.since(first);
            return Ok(ParsedOperand {
                written: Written::Memory(expression, register, at),
                at: at_all,
                component: None,
            });
        }
        // `x` alone may be a component; `x + 1` is a number.
        let component = component.filter(|_| expression.symbol().is_some());
        Ok(ParsedOperand { written: Written::Number(expression), at: cursor.since(first), component })
    }

    fn register_here(&mut self, cursor: &mut Cursor) -> Parsed<Option<(Register, At)>> {
        let Some(token) = cursor.peek().filter(|token| token.kind == TokenKind::Name) else { return Ok(None) };
        let at = cursor.at(token);
        let register = self.register(cursor.text(token), at)?;
        if self.body.is_none()
            && let Some(number) = self.alias(cursor.text(token)).map(|alias| alias.number)
        {
            self.use_name(number, at);
        }
        cursor.position += usize::from(register.is_some());
        match (&self.body, register) {
            (Some(template), Some(register)) => template.member(register, at, cursor).map(Some),
            (_, register) => Ok(register.map(|register| (register, at))),
        }
    }
}
