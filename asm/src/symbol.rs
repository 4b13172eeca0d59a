//! Names and what they stand for.

use std::collections::HashMap;
use std::rc::Rc;

use crate::expression::Expression;
use crate::message::At;

/// An interned name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Name(u32);

/// The value of a symbol, and its kind.
#[derive(Clone, Debug)]
pub(crate) enum SymbolValue {
    /// Word address of code.
    Code(i64),
    /// Octet address in the buffer.
    Buffer(i64),
    /// A number that does not change.
    Constant(i64),
    /// A number that follows from names defined later.
    Pending(Rc<Expression>),
    /// A number that `.set` may change, and how often it was set.
    Variable(i64, u32),
    /// The definition was wrong and has been reported.
    Broken,
}

/// A definition with its place; names from outside have none.
#[derive(Clone, Debug)]
pub(crate) struct Symbol {
    pub value: SymbolValue,
    pub at: Option<At>,
}

/// All names of an assembly.
#[derive(Debug, Default)]
pub(crate) struct Names {
    by_text: HashMap<Rc<str>, Name>,
    texts: Vec<Rc<str>>,
    symbols: Vec<Option<Symbol>>,
    formats: HashMap<Name, u32>,
    sizes: HashMap<Name, i64>,
}

impl Names {
    /// The name of this text.
    pub fn intern(&mut self, text: &str) -> Name {
        if let Some(&name) = self.by_text.get(text) {
            return name;
        }
        let name = Name(self.texts.len() as u32);
        let text: Rc<str> = text.into();
        self.texts.push(text.clone());
        self.symbols.push(None);
        self.by_text.insert(text, name);
        name
    }

    /// The text of a name.
    pub fn text(&self, name: Name) -> &Rc<str> {
        &self.texts[name.0 as usize]
    }

    /// The definition of a name.
    pub fn get(&self, name: Name) -> Option<&Symbol> {
        self.symbols[name.0 as usize].as_ref()
    }

    /// The definition of a text, which need not be a name yet.
    pub fn find(&self, text: &str) -> Option<&Symbol> {
        self.by_text.get(text).and_then(|&name| self.get(name))
    }

    /// Defines a name or changes its definition.
    pub fn set(&mut self, name: Name, value: SymbolValue, at: Option<At>) {
        self.symbols[name.0 as usize] = Some(Symbol { value, at });
    }

    /// Fraction bits of the format of that name.
    pub fn format(&self, name: Name) -> Option<u32> {
        self.formats.get(&name).copied()
    }

    /// Fraction bits of the format of a text.
    pub fn format_named(&self, text: &str) -> Option<u32> {
        self.by_text.get(text).and_then(|&name| self.format(name))
    }

    /// Defines a format.
    pub fn set_format(&mut self, name: Name, bits: u32) {
        self.formats.insert(name, bits);
    }

    /// Octets of the structure or field of that name.
    pub fn size(&self, name: Name) -> Option<i64> {
        self.sizes.get(&name).copied()
    }

    /// Defines the octets of a structure or field.
    pub fn set_size(&mut self, name: Name, octets: i64) {
        self.sizes.insert(name, octets);
    }

    /// The text is a symbol, a format or a structure.
    pub fn is_defined(&self, text: &str) -> bool {
        self.by_text.get(text).is_some_and(|&name| {
            self.get(name).is_some() || self.formats.contains_key(&name) || self.sizes.contains_key(&name)
        })
    }

    /// All definitions, in the order in which the names were first seen.
    pub fn symbols(&self) -> impl Iterator<Item = (Name, &Rc<str>, &Symbol)> {
        let all = self.texts.iter().zip(&self.symbols).enumerate();
        all.filter_map(|(at, (text, symbol))| Some((Name(at as u32), text, symbol.as_ref()?)))
    }

    /// Names of all formats.
    pub fn formats(&self) -> impl Iterator<Item = &str> {
        self.formats.keys().map(|&name| &**self.text(name))
    }

    /// Names of all structures and fields.
    pub fn sized(&self) -> impl Iterator<Item = &str> {
        self.sizes.keys().map(|&name| &**self.text(name))
    }
}
