//! Definitions: labels, constants, formats, register aliases; what may be called what.

use std::rc::Rc;

use crate::assembler::{Assembler, Section};
use crate::cursor::Cursor;
use crate::evaluation::EvaluationFailure;
use crate::explain;
use crate::expression::{EvaluationStep, Expression};
use crate::function::is_function;
use crate::limits::FRACTION_BITS;
use crate::message::{At, Parsed, Problem};
use crate::operand::{Register, looks_like_register};
use crate::symbol::{Name, SymbolValue};

/// Another name of a register.
#[derive(Clone, Debug)]
pub(crate) struct Alias {
    pub register: Register,
    pub at: At,
    /// Number among all names of registers.
    pub number: usize,
}

impl Assembler<'_> {
    /// Refuses names that already mean something else everywhere.
    pub(crate) fn check_name(&self, text: &str, at: At) -> Parsed<()> {
        let what = if looks_like_register(text) {
            "a register's name"
        } else if is_function(text) {
            "a function"
        } else if let Some(alias) = self.alias(text) {
            let message = format!("`{text}` is the name of a register here");
            return Err(
                Problem::new(explain::RESERVED, message, at, "choose another name").also(Some(alias.at), "named here")
            );
        } else {
            return Ok(());
        };
        Err(Problem::new(explain::RESERVED, format!("`{text}` is {what}"), at, "choose another name"))
    }

    /// Defines a name that must not have been defined before.
    pub(crate) fn define(&mut self, text: &str, at: At, value: SymbolValue) -> Parsed<Name> {
        self.check_name(text, at)?;
        let name = self.names.intern(text);
        if let Some(symbol) = self.names.get(name) {
            if matches!(symbol.value, SymbolValue::Broken) {
                self.names.set(name, value, Some(at));
                return Ok(name);
            }
            let text = text.split('$').next().unwrap_or(text);
            let problem =
                Problem::new(explain::DUPLICATE, format!("`{text}` is defined twice"), at, "second definition");
            return Err(match symbol.at {
                Some(first) => problem.also(Some(first), "first definition"),
                None => problem.hint("it is given from outside; `.ifndef` keeps a default for when it is not"),
            });
        }
        self.names.set(name, value, Some(at));
        Ok(name)
    }

    /// A label here.
    pub(crate) fn define_label(&mut self, text: &str, at: At) {
        let here = self.location();
        let value = match self.section {
            Section::Code => SymbolValue::Code(here),
            Section::Buffer => SymbolValue::Buffer(here),
        };
        let text: Rc<str> = if text.starts_with(|c: char| c.is_ascii_digit()) {
            let count = self.numeric.entry(text.into()).or_insert(0);
            *count += 1;
            format!("{text}#{}", *count - 1).into()
        } else {
            text.into()
        };
        if let Err(problem) = self.define(&text, at, value) {
            self.messages.add(problem);
        }
    }

    /// The label that `1b` or `1f` leads to.
    pub(crate) fn numeric_label(&mut self, text: &str, at: At) -> Parsed<Name> {
        let (number, direction) = text.split_at(text.len() - 1);
        let count = self.numeric.get(number).copied().unwrap_or(0);
        let place = if direction == "f" { Some(count) } else { count.checked_sub(1) };
        let Some(place) = place else {
            let message = format!("there is no label `{number}:` before this line");
            return Err(Problem::new(explain::NUMERIC_LABEL, message, at, "looks back"));
        };
        Ok(self.names.intern(&format!("{number}#{place}")))
    }

    /// `.equ name, expression`
    pub(crate) fn define_constant(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let (text, at) = cursor.name("a name")?;
        let expression =
            cursor.expect(",").and_then(|()| self.expression(cursor)).and_then(|e| cursor.end().map(|_| e));
        let value = match &expression {
            Err(_) => SymbolValue::Broken,
            Ok(expression) => self.constant(expression),
        };
        self.named = Some(self.define(text, at, value)?);
        expression.map(|_| ())
    }

    fn constant(&mut self, expression: &Expression) -> SymbolValue {
        match self.evaluate(expression) {
            Ok(value) => SymbolValue::Constant(value),
            Err(EvaluationFailure::Later(..)) => {
                let mut expression = expression.clone();
                self.settle(&mut expression);
                SymbolValue::Pending(expression.into())
            }
            Err(failure) => {
                self.report_failure(failure);
                SymbolValue::Broken
            }
        }
    }

    /// `.set name, expression`, or `name = expression`.
    pub(crate) fn assign(&mut self, separator: &str, cursor: &mut Cursor) -> Parsed<()> {
        let (text, at) = cursor.name("a name")?;
        let expression = cursor.expect(separator).and_then(|()| self.expression(cursor)).and_then(|expression| {
            cursor.end()?;
            Ok(expression)
        });
        let value = expression.and_then(|expression| {
            let is_first = self.names.find(text).is_none();
            if is_first && matches!(self.evaluate(&expression), Err(EvaluationFailure::Later(..))) {
                // Set from what is defined further on: a constant, and a second `.set` is refused.
                let value = self.constant(&expression);
                self.named = Some(self.define(text, at, value)?);
                return Ok(None);
            }
            self.value_now(&expression)
        });
        match value {
            Ok(Some(value)) => {
                self.set_variable(text, at, value)?;
                self.named = Some(self.names.intern(text));
                Ok(())
            }
            Ok(None) => self.define_broken(text, at),
            Err(problem) => {
                self.define_broken(text, at)?;
                Err(problem)
            }
        }
    }

    fn define_broken(&mut self, text: &str, at: At) -> Parsed<()> {
        self.check_name(text, at)?;
        let name = self.names.intern(text);
        if self.names.get(name).is_none() {
            self.names.set(name, SymbolValue::Broken, Some(at));
        }
        Ok(())
    }

    /// `.format name, bits`
    pub(crate) fn define_format(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let (text, at) = cursor.name("the name of the format")?;
        let name = self.names.intern(text);
        let bits = cursor.expect(",").and_then(|()| self.expression(cursor)).and_then(|expression| {
            cursor.end()?;
            Ok(self.value_now(&expression)?.map(|bits| (bits, expression.at)))
        });
        let bits = match bits {
            Ok(Some((bits, bits_at))) if !(0..=FRACTION_BITS).contains(&bits) => {
                let message = format!("a format cannot have {bits} fraction bits");
                Err(Problem::new(explain::RANGE, message, bits_at, format!("0 to {FRACTION_BITS}")))
            }
            Ok(bits) => Ok(bits.map_or(0, |(bits, _)| bits as u32)),
            Err(problem) => Err(problem),
        };
        match (self.names.format(name), bits) {
            (None, bits) => {
                self.names.set_format(name, *bits.as_ref().unwrap_or(&0));
                bits.map(|_| ())
            }
            (Some(_), Err(problem)) => Err(problem),
            (Some(other), Ok(bits)) if other == bits => Ok(()),
            (Some(other), Ok(bits)) => {
                let message = format!("the format `{text}` has {other} fraction bits already, not {bits}");
                Err(Problem::new(explain::DUPLICATE, message, at, "second definition"))
            }
        }
    }

    /// `.reg name, register`
    pub(crate) fn define_alias(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let (text, at) = cursor.name("the new name")?;
        cursor.expect(",")?;
        let (register_text, register_at) = cursor.name("a register")?;
        let Some(register) = self.register(register_text, register_at)? else {
            let message = format!("`{register_text}` is not a register");
            return Err(Problem::new(explain::REGISTER, message, register_at, "expected a register")
                .suggest(register_text, crate::message::Among::Registers));
        };
        cursor.end()?;
        // A name must neither hide a register nor a symbol.
        if looks_like_register(text) || is_function(text) {
            self.check_name(text, at)?;
        }
        if let Some(symbol) = self.names.find(text) {
            let message = format!("`{text}` is a symbol and cannot be a register's name");
            return Err(
                Problem::new(explain::RESERVED, message, at, "choose another name").also(symbol.at, "defined here")
            );
        }
        let scope = self.aliases.last_mut().expect("the outermost scope is never closed");
        // Once more with the same register is no mistake: two files may say so.
        match scope.get(text) {
            Some(other) if other.register != register => {
                let (file, number) = other.register;
                let message = format!("`{text}` already names {file}{number}");
                Err(Problem::new(explain::DUPLICATE, message, at, "second definition")
                    .also(Some(other.at), "first definition")
                    .hint(format!("`.unreg {text}` frees the name")))
            }
            Some(_) => Ok(()),
            None => {
                let number = self.begin_alias(text, register);
                let scope = self.aliases.last_mut().expect("the outermost scope is never closed");
                scope.insert(text.into(), Alias { register, at, number });
                Ok(())
            }
        }
    }

    /// `.unreg name`
    pub(crate) fn remove_alias(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let (text, at) = cursor.name("a register's other name")?;
        cursor.end()?;
        if let Some(alias) = self.aliases.iter_mut().rev().find_map(|scope| scope.remove(text)) {
            self.end_alias(alias.number);
            return Ok(());
        }
        let message = format!("`{text}` is not the name of a register here");
        Err(Problem::new(explain::ALIAS, message, at, "nothing to free")
            .hint("names from `.reg` inside a function end with the function"))
    }

    /// The alias of a name.
    pub(crate) fn alias(&self, text: &str) -> Option<&Alias> {
        self.aliases.iter().rev().find_map(|scope| scope.get(text))
    }

    /// A name stands for something here.
    pub(crate) fn is_defined(&self, text: &str) -> bool {
        self.names.is_defined(text) || self.macros.contains_key(text) || self.alias(text).is_some()
    }

    /// `.entry label`
    pub(crate) fn set_entry(&mut self, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let mut expression = self.expression(cursor)?;
        cursor.end()?;
        self.settle(&mut expression);
        if let Some(other) = &self.entry {
            return Err(Problem::new(explain::DUPLICATE, "the entry is set twice", at, "second one")
                .also(Some(other.at), "first one"));
        }
        self.entry = Some(expression);
        Ok(())
    }

    /// The word at which execution starts.
    pub(crate) fn resolve_entry(&mut self) {
        let words = self.program.words.len() as i64;
        let Some(expression) = self.entry.take() else {
            let start = ["start", "main"].into_iter().find_map(|text| match self.names.find(text)?.value {
                SymbolValue::Code(address) => Some(address as u32),
                _ => None,
            });
            self.program.entry = start.filter(|&address| i64::from(address) < words).unwrap_or(0);
            return;
        };
        let is_data = matches!(expression.steps[..], [(EvaluationStep::Symbol(name), _)]
            if matches!(self.names.get(name).map(|s| &s.value), Some(SymbolValue::Buffer(_))));
        match self.evaluate(&expression) {
            Ok(address) if !is_data && (0..words).contains(&address) => self.program.entry = address as u32,
            Ok(_) => {
                let message = "the entry is not an instruction of the program";
                let label = if is_data {
                    "an address in the buffer".into()
                } else {
                    format!("the program has {words} word{}", if words == 1 { "" } else { "s" })
                };
                self.messages.add(Problem::new(explain::ENTRY, message, expression.at, label));
            }
            Err(failure) => self.report_failure(failure),
        }
    }
}
