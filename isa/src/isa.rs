//! The instruction set of a run: the built-in table plus loaded extension rows, with encoder and decoder over it.

use std::fmt;
use std::sync::Arc;

use crate::definition::{InstructionDef, Kind};
use crate::extension::{Body, Extension, Semantics};
use crate::table::{INSTRUCTIONS, Op};

/// The fields of a decoded word, by operand letter; a letter that the row does not have is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "the letters are those of the rows")]
pub struct Fields {
    pub d: u8,
    pub e: u8,
    pub x: u8,
    pub y: u8,
    pub a: u8,
    pub b: u8,
    pub c: u8,
    pub i: i32,
    pub j: i32,
}

impl Fields {
    /// The number in the field of a letter.
    pub fn get(&self, letter: u8) -> i64 {
        match letter {
            b'd' => self.d.into(),
            b'e' => self.e.into(),
            b'x' => self.x.into(),
            b'y' => self.y.into(),
            b'a' => self.a.into(),
            b'b' => self.b.into(),
            b'c' => self.c.into(),
            b'i' => self.i.into(),
            _ => self.j.into(),
        }
    }

    /// Puts a number into the field of a letter.
    pub fn set(&mut self, letter: u8, value: i32) {
        match letter {
            b'd' => self.d = value as u8,
            b'e' => self.e = value as u8,
            b'x' => self.x = value as u8,
            b'y' => self.y = value as u8,
            b'a' => self.a = value as u8,
            b'b' => self.b = value as u8,
            b'c' => self.c = value as u8,
            b'i' => self.i = value,
            _ => self.j = value,
        }
    }
}

/// A decoded word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// The row that the word encodes.
    pub op: Op,
    /// The operands, as numbers of their fields.
    pub fields: Fields,
}

/// The reason for which an instruction cannot be encoded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EncodeError {
    /// Operand number `operand` must lie in `least..=most`.
    Range {
        /// Place in the row's list of operands.
        operand: usize,
        /// The value that was asked for.
        value: i64,
        /// Least value of the field.
        least: i64,
        /// Largest value of the field.
        most: i64,
    },
    /// The row has `expected` operands.
    Operands {
        /// Number of operands of the definition.
        expected: usize,
    },
}

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EncodeError::Range { value, least, most, .. } => write!(f, "{value} is not in {least}..={most}"),
            EncodeError::Operands { expected } => write!(f, "the instruction takes {expected} operands"),
        }
    }
}

/// The instruction set of a run.
#[derive(Clone, Debug)]
pub struct Isa {
    extensions: Vec<Extension>,
    by_major: Vec<Vec<Op>>,
}

impl Isa {
    /// The built-in table alone.
    pub fn base() -> Isa {
        let mut isa = Isa { extensions: Vec::new(), by_major: vec![Vec::new(); 64] };
        for &op in Op::BUILT_IN {
            isa.enter(op);
        }
        isa
    }

    fn enter(&mut self, op: Op) {
        let pattern = self.definition(op).pattern;
        // A pattern may leave some of the major bits to operands; then several values lead to it.
        for major in 0..64u32 {
            if (major << 26 ^ pattern.value) & pattern.mask >> 26 << 26 == 0 {
                self.by_major[major as usize].push(op);
            }
        }
    }

    /// Adds an extension row.
    ///
    /// # Errors
    /// The row whose name or word it would take.
    pub fn extend(&mut self, definition: InstructionDef) -> Result<Op, Op> {
        if let Some(other) = self.ops().find(|&op| {
            self.definition(op).name == definition.name || self.definition(op).pattern.overlaps(&definition.pattern)
        }) {
            return Err(other);
        }
        let op = Op::Ext(self.extensions.len() as u16);
        self.extensions.push(Extension { definition, body: None, semantics: None, is_expanded: false });
        self.enter(op);
        Ok(op)
    }

    /// Says what an extension row does.
    pub fn set_body(&mut self, op: Op, body: Arc<Body>) {
        if let Op::Ext(n) = op {
            self.extensions[n as usize].body = Some(body);
        }
    }

    /// Gives an extension row semantics that an engine knows how to execute, or takes it away.
    pub fn set_semantics(&mut self, op: Op, semantics: Option<Semantics>) {
        if let Op::Ext(n) = op {
            self.extensions[n as usize].semantics = semantics;
        }
    }

    /// The semantics that an engine has for an extension row.
    pub fn semantics(&self, op: Op) -> Option<&Semantics> {
        match op {
            Op::Ext(n) => self.extensions[n as usize].semantics.as_ref(),
            _ => None,
        }
    }

    /// An instruction is executed by the steps of its body: it has no other semantics, or its steps are counted.
    pub fn runs_body(&self, op: Op) -> bool {
        self.body(op).is_some() && (self.semantics(op).is_none() || self.is_expanded(op))
    }

    /// The body of an extension row; `None` for the rows of the table.
    pub fn body(&self, op: Op) -> Option<&Arc<Body>> {
        match op {
            Op::Ext(n) => self.extensions[n as usize].body.as_ref(),
            _ => None,
        }
    }

    /// A copy of the set in which the steps of these instructions count as instructions of the program, as if they stood in it.
    pub fn expanded(&self, ops: &[Op]) -> Isa {
        let mut isa = self.clone();
        for op in ops {
            if let Op::Ext(n) = op {
                isa.extensions[*n as usize].is_expanded = true;
            }
        }
        isa
    }

    /// The steps of an instruction's body count as instructions.
    pub fn is_expanded(&self, op: Op) -> bool {
        match op {
            Op::Ext(n) => self.extensions[n as usize].is_expanded,
            _ => false,
        }
    }

    /// The opcodes of the extensions.
    pub fn extensions(&self) -> impl Iterator<Item = Op> + use<> {
        (0..self.extensions.len()).map(|n| Op::Ext(n as u16))
    }

    /// All opcodes, extensions last.
    pub fn ops(&self) -> impl Iterator<Item = Op> + '_ {
        Op::BUILT_IN.iter().copied().chain((0..self.extensions.len()).map(|n| Op::Ext(n as u16)))
    }

    /// The row of an opcode.
    pub fn definition(&self, op: Op) -> &InstructionDef {
        match op {
            Op::Ext(n) => &self.extensions[n as usize].definition,
            _ => &INSTRUCTIONS[op.index()],
        }
    }

    /// The opcode of a mnemonic.
    pub fn find(&self, name: &str) -> Option<Op> {
        self.ops().find(|&op| self.definition(op).name == name)
    }

    /// Decodes a word; `None` when no row matches or a register or component does not exist.
    pub fn decode(&self, word: u32) -> Option<Instruction> {
        // The six top bits leave a few candidates, of which at most one matches since patterns do not overlap.
        let op = self.by_major[(word >> 26) as usize]
            .iter()
            .copied()
            .find(|&op| self.definition(op).pattern.matches(word))?;
        let definition = self.definition(op);
        let mut fields = Fields::default();
        for operand in definition.operands.iter() {
            let field = definition.pattern.field(operand.letter)?;
            // 0x8000 in a signed field of 16 bits is 32768 - 65536.
            let raw = i64::from(word >> field.shift) & ((1 << field.width) - 1);
            let is_negative = operand.kind.is_signed() && raw >> (field.width - 1) == 1;
            let value = if is_negative { raw - (1 << field.width) } else { raw };
            let (least, most) = operand.kind.range(field.width);
            // A group that would reach beyond its register file, or a fourth component.
            if value < least || value > most {
                return None;
            }
            fields.set(operand.letter, value as i32);
        }
        Some(Instruction { op, fields })
    }

    /// Encodes an instruction from its operands in the order of the row.
    ///
    /// # Errors
    /// A wrong number of operands, or a number that its field does not hold; nothing wraps.
    pub fn encode(&self, op: Op, operands: &[i64]) -> Result<u32, EncodeError> {
        let definition = self.definition(op);
        if operands.len() != definition.operands.len() {
            return Err(EncodeError::Operands { expected: definition.operands.len() });
        }
        let mut word = definition.pattern.value;
        for (place, (operand, &value)) in definition.operands.iter().zip(operands).enumerate() {
            let field =
                definition.pattern.field(operand.letter).expect("InstructionDef::check gave every operand a field");
            let (least, most) = operand.kind.range(field.width);
            if value < least || value > most {
                return Err(EncodeError::Range { operand: place, value, least, most });
            }
            // Two's complement: the low bits of a negative number in the range.
            word |= (value as u32 & ((1u64 << field.width) - 1) as u32) << field.shift;
        }
        Ok(word)
    }
}

/// Name of a register of the file that a kind names, such as `v3`.
pub fn register_name(kind: Kind, number: u8) -> String {
    match kind.register_file() {
        Some(file) => format!("{file}{number}"),
        None => number.to_string(),
    }
}

/// The register that a text names: its file's letter and number. `None` for anything else (`s32`, `v01`, `w8`).
pub fn parse_register(text: &str) -> Option<(char, u8)> {
    let file = text.chars().next().filter(|file| "svw".contains(*file))?;
    let digits = &text[1..];
    let is_plain = digits.bytes().all(|c| c.is_ascii_digit()) && (digits == "0" || !digits.starts_with('0'));
    let number: u8 = if is_plain { digits.parse().ok()? } else { return None };
    let count = if file == 'w' { 8 } else { 32 };
    (number < count).then_some((file, number))
}

impl Instruction {
    /// The instruction as assembly text that assembles to the same word; `target` names the label or number that a
    /// distance in words leads to.
    pub fn text(&self, isa: &Isa, target: impl Fn(i32) -> String) -> String {
        let definition = isa.definition(self.op);
        let mut parts: Vec<String> = Vec::new();
        let mut at = 0;
        while at < definition.operands.len() {
            let operand = definition.operands[at];
            let value = self.fields.get(operand.letter);
            // An address register and the offset behind it are one operand of the text: `8(s2)`.
            let next_is_offset = definition.operands.get(at + 1).is_some_and(|next| next.kind == Kind::Off);
            if next_is_offset && operand.kind.register_file() == Some('s') {
                let offset = self.fields.get(definition.operands[at + 1].letter);
                parts.push(format!("{offset}({})", register_name(operand.kind, value as u8)));
                at += 2;
                continue;
            }
            parts.push(match operand.kind {
                Kind::Rel => target(value as i32),
                kind => register_name_or_number(kind, value),
            });
            at += 1;
        }
        if parts.is_empty() { definition.name.to_string() } else { format!("{} {}", definition.name, parts.join(", ")) }
    }
}

fn register_name_or_number(kind: Kind, value: i64) -> String {
    if kind.register_file().is_some() { register_name(kind, value as u8) } else { value.to_string() }
}
