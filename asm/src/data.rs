//! Directives that put octets into the initial buffer or words into the code, and those that move the place.

use crate::assembler::{Assembler, Fixup, Section};
use crate::cursor::Cursor;
use crate::evaluation::EvaluationFailure;
use crate::explain;
use crate::expression::Expression;
use crate::limits::BUFFER;
use crate::message::{Among, At, Parsed, Problem};
use crate::token::{TokenKind, text_octets};

/// Range of a number of `width` octets, signed or unsigned; eight octets are signed, where a pattern was made one by its reader.
fn range(width: usize) -> (i64, i64) {
    match width {
        1 => (-(1 << 7), (1 << 8) - 1),
        2 => (-(1 << 15), (1 << 16) - 1),
        4 => (-(1 << 31), (1 << 32) - 1),
        _ => (i64::MIN, i64::MAX),
    }
}

impl Assembler<'_> {
    /// `.byte`, `.half`, `.word`, `.wide`: numbers of `width` octets.
    pub(crate) fn numbers(&mut self, width: usize, at: At, cursor: &mut Cursor) -> Parsed<()> {
        self.number_list(width, at, cursor, |assembler, cursor| match width {
            8 => assembler.wide_expression(cursor),
            _ => assembler.expression(cursor),
        })
    }

    /// `.fixed format, number, ...`: 32 bits each.
    pub(crate) fn fixed_numbers(&mut self, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let (text, name_at) = cursor.name("the name of a format")?;
        let name = self.names.intern(text);
        if self.names.format(name).is_none() && !self.is_incomplete {
            let message = format!("`{text}` is not a format");
            return Err(Problem::new(explain::FORMAT, message, name_at, "no such format").suggest(text, Among::Formats));
        }
        cursor.expect(",")?;
        self.number_list(4, at, cursor, |assembler, cursor| assembler.fixed_expression(cursor, name))
    }

    fn number_list(
        &mut self,
        width: usize,
        at: At,
        cursor: &mut Cursor,
        read: impl Fn(&mut Self, &mut Cursor) -> Parsed<Expression>,
    ) -> Parsed<()> {
        if self.section == Section::Code && width != 4 {
            return Err(only_in_buffer(at));
        }
        loop {
            let expression = read(self, cursor);
            let result = match expression {
                Ok(expression) => self.number(width, expression, cursor),
                Err(problem) => {
                    self.number(width, Expression { steps: Vec::new(), at }, cursor)?;
                    return Err(problem);
                }
            };
            result?;
            if cursor.is_at_end() {
                return Ok(());
            }
            if !cursor.accept(",") {
                return Err(cursor.expected("a comma or the end of the line"));
            }
        }
    }

    fn number(&mut self, width: usize, mut expression: Expression, cursor: &Cursor) -> Parsed<()> {
        let octet = self.program.buffer.len();
        let pc = self.program.words.len();
        let raw = if expression.steps.is_empty() { Ok(0) } else { self.data_value(width, &expression) };
        let value = match raw {
            Ok(value) => value,
            Err(EvaluationFailure::Later(..)) => {
                self.settle(&mut expression);
                self.fixups.push(match self.section {
                    Section::Code => Fixup::Word { expression, pc },
                    Section::Buffer => Fixup::Data { expression, octet, width },
                });
                0
            }
            Err(failure) => {
                self.report_failure(failure);
                0
            }
        };
        match self.section {
            Section::Code => self.emit(value as u32, cursor.line),
            Section::Buffer => self.put(&value.to_le_bytes()[..width], cursor)?,
        }
        Ok(())
    }

    /// A number for `width` octets.
    pub(crate) fn data_value(&self, width: usize, expression: &Expression) -> Result<i64, EvaluationFailure> {
        let value = self.evaluate(expression)?;
        let (least, mut most) = range(width);
        if expression.is_fixed() {
            most = -(least + 1);
        }
        if value < least || value > most {
            let message = format!("{value} does not fit {width} octet{}", if width == 1 { "" } else { "s" });
            let label = format!("must be {least} to {most}");
            return Err(EvaluationFailure::Wrong(Problem::new(explain::RANGE, message, expression.at, label)));
        }
        Ok(value)
    }

    /// Appends octets to the buffer.
    fn put(&mut self, octets: &[u8], cursor: &Cursor) -> Parsed<()> {
        self.check_buffer(octets.len() as i64, cursor.line.at_all())?;
        self.program.buffer.extend_from_slice(octets);
        Ok(())
    }

    fn check_buffer(&mut self, octets: i64, at: At) -> Parsed<()> {
        let most = self.options.limits.buffer;
        if (self.program.buffer.len() as i64).checked_add(octets).is_none_or(|size| size > most as i64) {
            let message = format!("the buffer has more than {most} octets");
            return Err(Problem::new(explain::BUFFER, message, at, "this does not fit"));
        }
        Ok(())
    }

    /// `.ascii` and `.asciz`, the latter with a 0 behind each text.
    pub(crate) fn texts(&mut self, ends_with_zero: bool, at: At, cursor: &mut Cursor) -> Parsed<()> {
        if self.section == Section::Code {
            return Err(only_in_buffer(at));
        }
        loop {
            let Some(token) = cursor.peek().filter(|token| token.kind == TokenKind::Text) else {
                return Err(cursor.expected("a text in quotation marks"));
            };
            let mut octets = self.text_value(cursor, token)?;
            cursor.skip();
            while let Some(token) = cursor.peek().filter(|token| token.kind == TokenKind::Text) {
                octets.extend(self.text_value(cursor, token)?);
                cursor.skip();
            }
            if ends_with_zero {
                octets.push(0);
            }
            self.put(&octets, cursor)?;
            if cursor.is_at_end() {
                return Ok(());
            }
            cursor.expect(",")?;
        }
    }

    /// The octets of a text literal.
    pub(crate) fn text_value(&self, cursor: &Cursor, token: crate::token::Token) -> Parsed<Vec<u8>> {
        text_octets(cursor.text(token)).map_err(|(start, end)| {
            let at = cursor.line.at(token.start as usize + start, token.start as usize + end);
            Problem::new(explain::TEXT, "this escape means nothing", at, "no such escape")
                .hint("escapes are \\n \\t \\r \\b \\f \\\\ \\' \\\", \\x41 and up to three octal digits as in \\012")
        })
    }

    /// `.space octets, fill`
    pub(crate) fn space(&mut self, at: At, cursor: &mut Cursor) -> Parsed<()> {
        if self.structure.is_some() {
            return self.pad_structure(cursor);
        }
        let octets = self.expression(cursor)?;
        let fill = if cursor.accept(",") { Some(self.expression(cursor)?) } else { None };
        cursor.end()?;
        if self.section == Section::Code {
            return Err(only_in_buffer(at));
        }
        // The number is needed now, since every address behind depends on it.
        let Some(count) = self.value_now(&octets)? else { return Ok(()) };
        let value = match fill {
            None => 0,
            Some(fill) => {
                let Some(value) = self.value_now(&fill)? else { return Ok(()) };
                // An octet may be meant with a sign or without: `-1` and `255` fill alike.
                let (least, most) = range(1);
                if value < least || value > most {
                    let message = format!("{value} does not fit 1 octet");
                    return Err(Problem::new(explain::RANGE, message, fill.at, format!("must be {least} to {most}")));
                }
                value as u8
            }
        };
        if count < 0 {
            return Err(Problem::new(explain::RANGE, format!("{count} octets"), octets.at, "negative"));
        }
        self.check_buffer(count, octets.at)?;
        self.program.buffer.resize(self.program.buffer.len() + count as usize, value);
        Ok(())
    }

    /// The octets of an `.align`, a power of two, or of a `.p2align`, by their logarithm.
    pub(crate) fn alignment(&mut self, is_power: bool, cursor: &mut Cursor) -> Parsed<Option<i64>> {
        let expression = self.expression(cursor)?;
        let Some(number) = self.value_now(&expression)? else { return Ok(None) };
        let most = BUFFER.ilog2();
        if is_power && !(0..=i64::from(most)).contains(&number) {
            let message = format!("2^{number} octets are no alignment");
            return Err(Problem::new(explain::PLACE, message, expression.at, format!("0 to {most}")));
        }
        let octets = if is_power { 1 << number } else { number };
        if octets < 1 || octets & (octets - 1) != 0 || octets > BUFFER as i64 {
            let message = format!("{octets} octets are no alignment");
            let label = format!("a power of two from 1 to {BUFFER}");
            return Err(Problem::new(explain::PLACE, message, expression.at, label));
        }
        Ok(Some(octets))
    }

    /// `.align octets, fill`: in the buffer with `fill` or 0, in the code with `nop`.
    pub(crate) fn align(&mut self, is_power: bool, at: At, cursor: &mut Cursor) -> Parsed<()> {
        if self.structure.is_some() {
            self.align_structure(is_power, cursor)?;
            return cursor.end();
        }
        let Some(octets) = self.alignment(is_power, cursor)? else { return Ok(()) };
        let fill = if cursor.accept(",") {
            let expression = self.expression(cursor)?;
            self.value_now(&expression)?.unwrap_or(0) as u8
        } else {
            0
        };
        cursor.end()?;
        match self.section {
            Section::Code if octets < 4 => Ok(()),
            Section::Code => {
                let words = next_multiple(self.program.words.len() as i64, octets / 4);
                self.fill_code(words, at, cursor)
            }
            Section::Buffer => {
                let size = self.program.buffer.len() as i64;
                let target = next_multiple(size, octets);
                self.check_buffer(target - size, at)?;
                self.program.buffer.resize(target as usize, fill);
                Ok(())
            }
        }
    }

    /// `.org address`: forward only; words in the code, octets in the buffer.
    pub(crate) fn origin(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let expression = self.expression(cursor)?;
        cursor.end()?;
        let Some(target) = self.value_now(&expression)? else { return Ok(()) };
        let here = self.location();
        if target < here {
            let message = format!("`.org` cannot go back from {here} to {target}");
            return Err(Problem::new(explain::PLACE, message, expression.at, "behind this place"));
        }
        match self.section {
            Section::Code => self.fill_code(target, expression.at, cursor),
            Section::Buffer => {
                self.check_buffer(target - here, expression.at)?;
                self.program.buffer.resize(target as usize, 0);
                Ok(())
            }
        }
    }

    /// Fills the code with `nop` up to a word address.
    fn fill_code(&mut self, target: i64, at: At, cursor: &Cursor) -> Parsed<()> {
        let most = self.options.limits.words;
        if target > most as i64 {
            return Err(Problem::new(explain::SIZE, format!("the program has more than {most} words"), at, "too far"));
        }
        let nop = self.nop;
        while (self.program.words.len() as i64) < target {
            self.emit(nop, cursor.line);
        }
        Ok(())
    }
}

fn only_in_buffer(at: At) -> Box<Problem> {
    Problem::new(explain::SECTION, "only words of 32 bits stand in the code", at, "the section is the code here")
        .hint("write `.buffer` before data, `.text` before code")
}

/// The first multiple of a power of two that is not below `value`.
pub(crate) fn next_multiple(value: i64, power: i64) -> i64 {
    (value + power - 1) & -power
}
