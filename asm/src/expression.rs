//! Expressions: C's operators and precedence, kept in postfix order so that neither evaluation nor disposal recurses.

use std::rc::Rc;

use crate::assembler::Assembler;
use crate::cursor::Cursor;
use crate::decimal::Decimal;
use crate::explain;
use crate::foreign;
use crate::function::{ExpressionFunction, FUNCTIONS, Parameters, is_function};
use crate::limits::PARENTHESES;
use crate::message::{At, Parsed, Problem};
use crate::operator::Binary;
use crate::symbol::Name;
use crate::token::{Token, TokenKind, character_value, integer_value};

/// One step of an evaluation on a stack.
#[derive(Clone, Debug)]
pub(crate) enum EvaluationStep {
    Number(i64),
    Symbol(Name),
    Size(Name),
    Fixed(Rc<Decimal>, Name),
    Negate,
    Complement,
    Not,
    Binary(Binary),
    /// Ends at that step with 0 when the top is 0.
    UnlessZero(usize),
    /// Ends at that step with 1 when the top is not 0.
    IfZero(usize),
    /// 1 for anything but 0.
    Truth,
    Function(ExpressionFunction),
}

/// An expression.
#[derive(Clone, Debug)]
pub(crate) struct Expression {
    pub steps: Vec<(EvaluationStep, At)>,
    pub at: At,
}

impl Expression {
    /// The symbol that is the whole expression.
    pub fn symbol(&self) -> Option<Name> {
        match self.steps[..] {
            [(EvaluationStep::Symbol(name), _)] => Some(name),
            _ => None,
        }
    }

    /// A fixed-point literal is part of the expression: such a number has a sign, and is never meant as an unsigned one.
    pub fn is_fixed(&self) -> bool {
        has_fixed(&self.steps)
    }

    /// A function of this expression.
    pub fn under(&self, function: ExpressionFunction) -> Expression {
        let mut steps = self.steps.clone();
        steps.push((EvaluationStep::Function(function), self.at));
        Expression { steps, at: self.at }
    }
}

/// A fixed-point literal is among the steps.
pub(crate) fn has_fixed(steps: &[(EvaluationStep, At)]) -> bool {
    steps.iter().any(|(step, _)| matches!(step, EvaluationStep::Fixed(..)))
}

enum Infix {
    Binary(Binary),
    BothTrue,
    OneTrue,
}

fn infix(mark: &str) -> Option<(Infix, u8)> {
    match mark {
        "||" => return Some((Infix::OneTrue, 1)),
        "&&" => return Some((Infix::BothTrue, 2)),
        _ => {}
    }
    let operator = Binary::from_mark(mark)?;
    Some((Infix::Binary(operator), operator.level()))
}

impl Assembler<'_> {
    /// Reads an expression.
    pub(crate) fn expression(&mut self, cursor: &mut Cursor) -> Parsed<Expression> {
        let first = cursor.position;
        let mut steps = Vec::with_capacity(1);
        self.infix_expression(cursor, &mut steps, 1, 0)?;
        Ok(Expression { steps, at: cursor.since(first) })
    }

    /// Reads a number of a `.fixed` list: a plain decimal is in `format`, anything else is raw.
    pub(crate) fn fixed_expression(&mut self, cursor: &mut Cursor, format: Name) -> Parsed<Expression> {
        let first = cursor.position;
        let mut ahead = *cursor;
        let is_negative = ahead.accept("-");
        if let Some(token) = ahead.peek()
            && matches!(token.kind, TokenKind::Integer | TokenKind::Decimal)
            && ahead.text(token).starts_with(|c: char| c.is_ascii_digit())
            && !ahead.text(token).contains(['x', 'X', 'o'])
        {
            let ends = ahead.peek_second().is_none_or(|after| after.kind == TokenKind::Mark(","));
            // Only when nothing but the literal stands there; `1 + 2` is a raw number.
            if ends {
                ahead.skip();
                *cursor = ahead;
                let at = cursor.since(first);
                let decimal = decimal(cursor.text(token), at, is_negative)?;
                return Ok(Expression { steps: vec![(EvaluationStep::Fixed(decimal, format), at)], at });
            }
        }
        self.expression(cursor)
    }

    /// Reads a number of a `.wide` list: a literal of digits in base 16, 8 or 2 alone is a pattern of up to 64 bits.
    pub(crate) fn wide_expression(&mut self, cursor: &mut Cursor) -> Parsed<Expression> {
        if let Some(token) = cursor.peek()
            && token.kind == TokenKind::Integer
            && cursor.peek_second().is_none_or(|after| after.kind == TokenKind::Mark(","))
            && cursor.text(token).starts_with(['0'])
            && let Ok(pattern) = integer_value(cursor.text(token))
        {
            let at = cursor.at(token);
            cursor.skip();
            return Ok(Expression { steps: vec![(EvaluationStep::Number(pattern as i64), at)], at });
        }
        self.expression(cursor)
    }

    fn infix_expression(
        &mut self,
        cursor: &mut Cursor,
        steps: &mut Vec<(EvaluationStep, At)>,
        least: u8,
        depth: usize,
    ) -> Parsed<()> {
        // Precedence climbing: `a - b * c - d` reads b * c at a higher level, then goes on from the left.
        self.prefixed(cursor, steps, depth)?;
        while let Some(token) = cursor.peek()
            && let TokenKind::Mark(mark) = token.kind
            && let Some((operator, level)) = infix(mark)
            && level >= least
        {
            let at = cursor.at(token);
            cursor.skip();
            let jump = steps.len();
            match operator {
                Infix::Binary(operator) => {
                    self.infix_expression(cursor, steps, level + 1, depth)?;
                    steps.push((EvaluationStep::Binary(operator), at));
                }
                Infix::BothTrue | Infix::OneTrue => {
                    // A place for the jump over the second operand, filled in when its length is known.
                    steps.push((EvaluationStep::Truth, at));
                    self.infix_expression(cursor, steps, level + 1, depth)?;
                    steps.push((EvaluationStep::Truth, at));
                    let end = steps.len();
                    let is_both = matches!(operator, Infix::BothTrue);
                    steps[jump].0 = if is_both { EvaluationStep::UnlessZero(end) } else { EvaluationStep::IfZero(end) };
                }
            }
        }
        Ok(())
    }

    fn prefixed(&mut self, cursor: &mut Cursor, steps: &mut Vec<(EvaluationStep, At)>, depth: usize) -> Parsed<()> {
        let first = cursor.position;
        while matches!(cursor.kind(), Some(TokenKind::Mark("-" | "+" | "~" | "!"))) {
            cursor.skip();
        }
        // A minus right before a literal belongs to it: -9223372036854775808 fits, and -0.5 rounds as a negative number.
        let mut prefixes = &cursor.tokens[first..cursor.position];
        let is_negative = prefixes.last().is_some_and(|token| token.kind == TokenKind::Mark("-"));
        if is_negative && let Some(literal) = self.negative_literal(cursor)? {
            steps.push(literal);
            prefixes = &prefixes[..prefixes.len() - 1];
        } else {
            self.primary(cursor, steps, depth)?;
        }
        for &prefix in prefixes.iter().rev() {
            let step = match prefix.kind {
                TokenKind::Mark("-") => EvaluationStep::Negate,
                TokenKind::Mark("~") => EvaluationStep::Complement,
                TokenKind::Mark("!") => EvaluationStep::Not,
                _ => continue,
            };
            steps.push((step, cursor.at(prefix)));
        }
        Ok(())
    }

    /// A literal whose rounding or range needs to know of the minus sign before it.
    fn negative_literal(&mut self, cursor: &mut Cursor) -> Parsed<Option<(EvaluationStep, At)>> {
        let Some(token) = cursor.peek() else { return Ok(None) };
        let first = cursor.position - 1;
        if let Some(step) = self.fixed_literal(cursor, token, true)? {
            return Ok(Some((step, cursor.since(first))));
        }
        if token.kind == TokenKind::Integer && integer_value(cursor.text(token)) == Ok(1 << 63) {
            cursor.skip();
            return Ok(Some((EvaluationStep::Number(i64::MIN), cursor.since(first))));
        }
        Ok(None)
    }

    /// `0.5:format`, without blanks.
    fn fixed_literal(
        &mut self,
        cursor: &mut Cursor,
        token: Token,
        is_negative: bool,
    ) -> Parsed<Option<EvaluationStep>> {
        let tokens = &cursor.tokens[cursor.position..];
        // The three parts touch, so that no other colon is taken for this one.
        if let [number, colon, format, ..] = tokens
            && matches!(number.kind, TokenKind::Integer | TokenKind::Decimal)
            && colon.kind == TokenKind::Mark(":")
            && format.kind == TokenKind::Name
            && number.end == colon.start
            && colon.end == format.start
        {
            let decimal = decimal(cursor.text(token), cursor.at(token), is_negative)?;
            let name = self.names.intern(cursor.text(*format));
            cursor.position += 3;
            return Ok(Some(EvaluationStep::Fixed(decimal, name)));
        }
        if token.kind == TokenKind::Decimal {
            let text = cursor.text(token);
            return Err(Problem::new(
                explain::FRACTION,
                "a number with a fraction needs a format",
                cursor.at(token),
                "in which format?",
            )
            .hint(format!("write `{text}:name` with the name of a `.format`")));
        }
        Ok(None)
    }

    fn primary(&mut self, cursor: &mut Cursor, steps: &mut Vec<(EvaluationStep, At)>, depth: usize) -> Parsed<()> {
        let Some(token) = cursor.peek() else { return Err(cursor.expected("a number")) };
        let at = cursor.at(token);
        let text = cursor.text(token);
        let first = cursor.position;
        let step = match token.kind {
            TokenKind::Integer | TokenKind::Decimal => match self.fixed_literal(cursor, token, false)? {
                Some(step) => {
                    // The literal's three tokens are taken already, so nothing is skipped behind it.
                    steps.push((step, cursor.since(first)));
                    return Ok(());
                }
                None => EvaluationStep::Number(integer(text, at)?),
            },
            TokenKind::Character => EvaluationStep::Number(character_value(text).ok_or_else(|| {
                Problem::new(explain::TEXT, format!("{text} is not a character"), at, "no such escape")
                    .hint("escapes are \\n \\t \\r \\0 \\\\ \\' \\\" and \\x41")
            })?),
            TokenKind::Local => EvaluationStep::Symbol(self.numeric_label(text, at)?),
            TokenKind::Mark(".") => EvaluationStep::Number(self.location()),
            TokenKind::Mark("(") => {
                // Only parentheses and functions let the parser call itself without another bound.
                if depth >= PARENTHESES {
                    return Err(Problem::new(
                        explain::NESTING,
                        format!("more than {PARENTHESES} parentheses inside each other"),
                        at,
                        "one too many",
                    ));
                }
                cursor.skip();
                self.infix_expression(cursor, steps, 1, depth + 1)?;
                return cursor.expect(")");
            }
            TokenKind::Name
                if cursor.peek_second().is_some_and(|next| next.kind == TokenKind::Mark("(")) && is_function(text) =>
            {
                return self.function(cursor, steps, depth);
            }
            TokenKind::Name => {
                // Say that it is a register: taken for a symbol it would only be undefined.
                if let Some((file, number)) = self.register(text, at)? {
                    return Err(Problem::new(
                        explain::OPERAND_KIND,
                        format!("expected a number, found the register `{text}`"),
                        at,
                        format!("register {file}{number}"),
                    ));
                }
                EvaluationStep::Symbol(self.names.intern(text))
            }
            TokenKind::Directive => EvaluationStep::Symbol(self.names.intern(text)),
            TokenKind::Mark("%") => {
                // Other assemblers write `%hi(x)` and `%s1`.
                let mut problem = cursor.expected("a number");
                problem.hint = foreign::percent(&cursor.line.text[token.start as usize..]);
                return Err(problem);
            }
            _ => return Err(cursor.expected("a number")),
        };
        cursor.skip();
        steps.push((step, at));
        Ok(())
    }

    fn function(&mut self, cursor: &mut Cursor, steps: &mut Vec<(EvaluationStep, At)>, depth: usize) -> Parsed<()> {
        let first = cursor.position;
        let (text, _) = cursor.name("a function")?;
        let open = cursor.here();
        cursor.skip();
        if depth >= PARENTHESES {
            let message = format!("more than {PARENTHESES} parentheses inside each other");
            return Err(Problem::new(explain::NESTING, message, open, "one too many"));
        }
        let described = FUNCTIONS.iter().find(|function| function.name == text).expect("only called for functions");
        let function = match described.argument {
            Parameters::Numbers(function, count) => {
                for argument in 0..count {
                    if argument > 0 {
                        cursor.expect(",")?;
                    }
                    self.infix_expression(cursor, steps, 1, depth + 1)?;
                }
                EvaluationStep::Function(function)
            }
            _ => self.name_function(described.argument, cursor)?,
        };
        cursor.expect(")")?;
        steps.push((function, cursor.since(first)));
        Ok(())
    }

    fn name_function(&mut self, argument: Parameters, cursor: &mut Cursor) -> Parsed<EvaluationStep> {
        let (name, at) = match cursor.peek() {
            Some(token) if token.kind == TokenKind::Directive => {
                cursor.skip();
                (cursor.text(token), cursor.at(token))
            }
            _ => cursor.name("a name")?,
        };
        match argument {
            Parameters::Size => Ok(EvaluationStep::Size(self.names.intern(name))),
            Parameters::Field if !name.contains('.') => {
                let message = "`offsetof` takes a field";
                Err(Problem::new(explain::SYNTAX, message, at, "expected `structure.field`"))
            }
            Parameters::Field => Ok(EvaluationStep::Symbol(self.names.intern(name))),
            _ => Ok(EvaluationStep::Number(self.is_defined(name).into())),
        }
    }
}

fn integer(text: &str, at: At) -> Parsed<i64> {
    let value = integer_value(text)
        .map_err(|why| Problem::new(explain::NUMBER, format!("`{text}` is not a number"), at, why))?;
    i64::try_from(value).map_err(|_| {
        Problem::new(explain::NUMBER, format!("{text} is too large"), at, "numbers have 64 bits with their sign")
    })
}

fn decimal(text: &str, at: At, is_negative: bool) -> Parsed<Rc<Decimal>> {
    let wrong = |why: String| Problem::new(explain::NUMBER, format!("`{text}` is not a decimal number"), at, why);
    if text.contains(['x', 'X', 'o', 'O', 'b', 'B']) {
        return Err(wrong("fixed-point numbers are written with decimal digits".into()));
    }
    if let Some(odd) = text.chars().find(|c| !matches!(c, '0'..='9' | '_' | '.' | 'e' | 'E' | '+' | '-')) {
        return Err(wrong(format!("`{odd}` is not a decimal digit")));
    }
    let mut decimal = Decimal::parse(text).map_err(wrong)?;
    decimal.is_negative = is_negative;
    Ok(Rc::new(decimal))
}
