//! Structures: names for the octets of records, down to odd offsets.

use isa::naming::{FieldMap, RecordMap};

use crate::assembler::Assembler;
use crate::cursor::Cursor;
use crate::data::next_multiple;
use crate::explain;
use crate::limits::STRUCTURE;
use crate::message::{At, Parsed, Problem};
use crate::symbol::SymbolValue;

/// The structure that is being described.
#[derive(Clone, Debug)]
pub(crate) struct OpenStructure {
    name: String,
    size: i64,
    fields: Vec<FieldMap>,
    pub at: At,
}

impl Assembler<'_> {
    /// `.struct name`
    pub(crate) fn open_structure(&mut self, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let header = cursor.name("the name of the structure").and_then(|(text, name_at)| {
            cursor.end()?;
            if text.contains('.') {
                return Err(Problem::new(explain::SYNTAX, "a structure's name has no points", name_at, "here"));
            }
            self.check_name(text, name_at)?;
            Ok((text, name_at))
        });
        if let Some(open) = &self.structure {
            let other = open.at;
            return Err(Problem::new(explain::UNCLOSED, "`.endstruct` is missing", other, "opened here")
                .also(Some(at), "the next one starts here"));
        }
        let (name, name_at) = *header.as_ref().unwrap_or(&("", at));
        self.structure = Some(OpenStructure { name: name.into(), size: 0, fields: Vec::new(), at: name_at });
        header?;
        let interned = self.names.intern(name);
        if self.names.size(interned).is_some() {
            return Err(Problem::new(
                explain::DUPLICATE,
                format!("the structure `{name}` is defined twice"),
                name_at,
                "second definition",
            ));
        }
        Ok(())
    }

    /// `.field name, octets, count`
    pub(crate) fn field(&mut self, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let (text, name_at) = cursor.name("the name of the field")?;
        let size = self.field_size(cursor);
        let Some(open) = &mut self.structure else {
            return Err(Problem::new(explain::UNOPENED, "`.field` outside of `.struct`", at, "nothing is open"));
        };
        let name = format!("{}.{text}", open.name);
        let offset = open.size;
        let octets = *size.as_ref().unwrap_or(&0);
        open.size = (offset + octets).min(STRUCTURE);
        if !open.name.is_empty() {
            let name = self.define(&name, name_at, SymbolValue::Constant(offset))?;
            self.named = Some(name);
            self.names.set_size(name, octets);
            if let Some(open) = &mut self.structure {
                let field = FieldMap { name: text.into(), offset: offset as u32, octets: octets as u32 };
                open.fields.push(field);
            }
        }
        size.map(|_| ())
    }

    fn field_size(&mut self, cursor: &mut Cursor) -> Parsed<i64> {
        cursor.expect(",")?;
        let octets = self.expression(cursor)?;
        let count = if cursor.accept(",") { Some(self.expression(cursor)?) } else { None };
        cursor.end()?;
        let Some(value) = self.value_now(&octets)? else { return Ok(0) };
        let times = match &count {
            Some(count) => self.value_now(count)?.unwrap_or(0),
            None => 1,
        };
        let at = octets.at.to(count.map_or(octets.at, |count| count.at));
        match value.checked_mul(times) {
            Some(size) if value >= 0 && times >= 0 && size < STRUCTURE => Ok(size),
            _ => Err(Problem::new(
                explain::RANGE,
                format!("a field cannot have {value} x {times} octets"),
                at,
                format!("0 to {}", STRUCTURE - 1),
            )),
        }
    }

    /// `.space octets` inside a structure: a field without a name.
    pub(crate) fn pad_structure(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let expression = self.expression(cursor)?;
        cursor.end()?;
        let Some(octets) = self.value_now(&expression)? else { return Ok(()) };
        if !(0..STRUCTURE).contains(&octets) {
            let message = format!("{octets} octets cannot be left out");
            return Err(Problem::new(explain::RANGE, message, expression.at, format!("0 to {}", STRUCTURE - 1)));
        }
        if let Some(open) = &mut self.structure {
            open.size = (open.size + octets).min(STRUCTURE);
        }
        Ok(())
    }

    /// `.align octets` inside a structure.
    pub(crate) fn align_structure(&mut self, is_power: bool, cursor: &mut Cursor) -> Parsed<()> {
        let Some(octets) = self.alignment(is_power, cursor)? else { return Ok(()) };
        if let Some(open) = &mut self.structure {
            open.size = next_multiple(open.size, octets).min(STRUCTURE);
        }
        Ok(())
    }

    /// `.endstruct`
    pub(crate) fn close_structure(&mut self, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let Some(closed) = self.structure.take() else {
            return Err(Problem::new(explain::UNOPENED, "`.endstruct` without `.struct`", at, "nothing is open"));
        };
        if !closed.name.is_empty() {
            let name = self.names.intern(&closed.name);
            if self.names.size(name).is_none() {
                self.names.set_size(name, closed.size);
                let OpenStructure { name, size, fields, .. } = closed;
                self.program.records.push(RecordMap { name, octets: size as u32, fields });
            }
        }
        cursor.end()
    }
}
