//! One line: its labels, and the statement behind them.

use std::sync::Arc;

use crate::assembler::{Assembler, Section};
use crate::cursor::Cursor;
use crate::explain;
use crate::frame::leading_directive;
use crate::limits::{EXPANDED_TOKEN, EXPANDED_TOKENS};
use crate::line::OriginLine;
use crate::listing::Record;
use crate::message::{At, Parsed, Problem};
use crate::symbol::SymbolValue;
use crate::token::{TokenKind, tokens};

impl Assembler<'_> {
    /// Assembles a line.
    pub(crate) fn line(&mut self, line: &OriginLine) {
        let place = self.records.len();
        self.record(line);
        self.named = None;
        self.held = None;
        self.read_line(line);
        // The record has the section behind the line, so that a line which changes it shows no address.
        let (section, end) = (self.section, self.location() as u32);
        let value = self.named.map(|name| self.names.get(name).map(|symbol| symbol.value.clone()));
        let note = self.held.take().map(|(register, format)| self.held_note(register, format));
        let record = &mut self.records[place];
        record.note = note;
        if record.section == section {
            record.made.end = end;
        }
        match (value, self.named) {
            (Some(Some(SymbolValue::Constant(value) | SymbolValue::Variable(value, _))), _) => {
                record.value = Some(value)
            }
            (Some(Some(SymbolValue::Pending(_))), Some(name)) => self.pending_records.push((place, name)),
            _ => {}
        }
    }

    /// Notes a line for the listing, without anything made.
    pub(crate) fn record(&mut self, line: &OriginLine) {
        let here = self.location() as u32;
        let depth = self.expansion_depth();
        self.records.push(Record {
            source: line.source,
            line: line.number,
            depth: depth.min(255) as u8,
            section: self.section,
            made: here..here,
            value: None,
            note: None,
            text: line.is_substituted().then(|| Arc::from(&*line.text)),
        });
    }

    fn read_line(&mut self, line: &OriginLine) {
        if self.is_skipping() {
            let word = leading_directive(&line.text);
            let matters = word.is_some_and(|word| word.starts_with(".if") || word.starts_with(".e"));
            if !matters {
                return;
            }
        }
        let (tokens, unreadable) = tokens(&line.text);
        if line.is_substituted() {
            self.octets_expanded += tokens.len().saturating_sub(EXPANDED_TOKENS) * EXPANDED_TOKEN;
        }
        let mut cursor = Cursor { line, tokens: &tokens, position: 0 };
        if let Some(unreadable) = &unreadable
            && !self.is_skipping()
        {
            let at = line.at(unreadable.start, unreadable.end);
            let mut problem = Problem::new(unreadable.code, &*unreadable.message, at, unreadable.label);
            problem.hint = unreadable.hint.clone();
            self.messages.add(problem);
            self.messages.is_muted = true;
        }
        let result = self.statement(&mut cursor);
        if let Err(problem) = result {
            self.messages.add(problem);
        }
        self.messages.is_muted = false;
    }

    fn statement(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let is_skipping = self.is_skipping();
        // Labels: any number of them before the statement.
        while let (Some(first), Some(second)) = (cursor.peek(), cursor.peek_second()) {
            let is_name = matches!(first.kind, TokenKind::Name | TokenKind::Directive | TokenKind::Integer);
            if !is_name || second.kind != TokenKind::Mark(":") {
                break;
            }
            cursor.skip();
            cursor.skip();
            if !is_skipping {
                self.label(first.kind, cursor.text(first), cursor.at(first));
            }
        }
        let Some(first) = cursor.peek() else { return Ok(()) };
        let (text, at) = (cursor.text(first), cursor.at(first));
        // Inside of a branch that is not taken only conditions are looked at.
        if is_skipping {
            let steers = text.starts_with(".if") || matches!(text, ".elseif" | ".else" | ".endif");
            if !steers {
                return Ok(());
            }
        }
        match first.kind {
            TokenKind::Directive => {
                cursor.skip();
                self.directive(text, at, cursor)
            }
            TokenKind::Name if cursor.peek_second().is_some_and(|next| next.kind == TokenKind::Mark("=")) => {
                self.assign("=", cursor)
            }
            TokenKind::Name if !self.macros.contains_key(text) && !self.takes_instructions() => {
                Err(self.no_instruction_here(text, at))
            }
            TokenKind::Name => {
                cursor.skip();
                self.instruction(text, at, cursor);
                Ok(())
            }
            _ => Err(cursor.expected("an instruction, a directive or a label")),
        }
    }

    fn label(&mut self, kind: TokenKind, text: &str, at: At) {
        if let Some(open) = &self.structure {
            let message = format!("the label `{text}` stands in a structure");
            self.messages.add(
                Problem::new(explain::SECTION, message, at, "no place for a label").also(Some(open.at), "opened here"),
            );
        } else if kind == TokenKind::Integer && !text.bytes().all(|c| c.is_ascii_digit()) {
            let message = format!("`{text}` cannot be a label");
            self.messages.add(Problem::new(explain::SYNTAX, message, at, "a name, or a decimal number"));
        } else {
            self.define_label(text, at);
        }
    }

    fn takes_instructions(&self) -> bool {
        self.section == Section::Code && self.structure.is_none()
    }

    fn no_instruction_here(&mut self, text: &str, at: At) -> Box<Problem> {
        if let Some(open) = &self.structure {
            let message = format!("`{text}` does not stand in a structure");
            return Problem::new(explain::SECTION, message, at, "in a structure")
                .also(Some(open.at), "opened here")
                .hint("`.endstruct` ends the structure");
        }
        let is_known = self.operations.contains_key(text) || crate::pseudo::find(text).is_some();
        if is_known {
            let message = format!("the instruction `{text}` stands in the buffer");
            return Problem::new(explain::SECTION, message, at, "the section is the buffer here")
                .hint("write `.text` before code");
        }
        self.unknown_instruction(text, at, false)
    }
}
