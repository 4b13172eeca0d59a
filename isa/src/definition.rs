//! Definitions of instructions, a row of the table each: operands, pattern, outcomes and their costs. Built-in ones are constants,
//! rows of extensions are owned values of the same type.

use std::borrow::Cow;

use crate::class::Counts;
use crate::pattern::BitPattern;

/// Kind of an operand, which says what the number in its field means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Scalar register `s0` to `s31`; `s0` reads zero and ignores writes.
    S,
    /// Vector register `v0` to `v31`, three components.
    V,
    /// Wide accumulator `w0` to `w7`, twice the word.
    W,
    /// Scalar register read as a 32-bit address, never quantized.
    A,
    /// Two consecutive vector registers, named by the first.
    V2,
    /// Three consecutive vector registers, named by the first.
    V3,
    /// Five consecutive vector registers, named by the first.
    V5,
    /// Three consecutive wide accumulators, named by the first.
    W3,
    /// Shift in bits, unsigned.
    Sh,
    /// Signed integer.
    Im,
    /// Unsigned integer.
    Un,
    /// Signed offset in octets from the address operand before it.
    Off,
    /// Signed distance in words from this instruction to a label.
    Rel,
    /// Component of a vector: 0, 1 or 2.
    Lane,
}

impl Kind {
    /// Every kind of operand.
    pub const ALL: [Kind; 14] = [
        Kind::S,
        Kind::V,
        Kind::W,
        Kind::A,
        Kind::V2,
        Kind::V3,
        Kind::V5,
        Kind::W3,
        Kind::Sh,
        Kind::Im,
        Kind::Un,
        Kind::Off,
        Kind::Rel,
        Kind::Lane,
    ];

    /// The name that rows use.
    pub const fn name(self) -> &'static str {
        match self {
            Kind::S => "S",
            Kind::V => "V",
            Kind::W => "W",
            Kind::A => "A",
            Kind::V2 => "V2",
            Kind::V3 => "V3",
            Kind::V5 => "V5",
            Kind::W3 => "W3",
            Kind::Sh => "Sh",
            Kind::Im => "Im",
            Kind::Un => "Un",
            Kind::Off => "Off",
            Kind::Rel => "Rel",
            Kind::Lane => "Lane",
        }
    }

    /// The kind of that name.
    pub fn from_name(name: &str) -> Option<Kind> {
        Kind::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// The prefix of the register file, `None` for immediates.
    pub const fn register_file(self) -> Option<char> {
        match self {
            Kind::S | Kind::A => Some('s'),
            Kind::V | Kind::V2 | Kind::V3 | Kind::V5 => Some('v'),
            Kind::W | Kind::W3 => Some('w'),
            _ => None,
        }
    }

    /// Number of consecutive registers that the operand names; 0 for immediates.
    pub const fn registers(self) -> u8 {
        match self {
            Kind::S | Kind::A | Kind::V | Kind::W => 1,
            Kind::V2 => 2,
            Kind::V3 | Kind::W3 => 3,
            Kind::V5 => 5,
            _ => 0,
        }
    }

    /// Bits that a register field of this kind needs; `None` where the row chooses.
    pub const fn width(self) -> Option<u8> {
        match self {
            Kind::S | Kind::A | Kind::V | Kind::V2 | Kind::V3 | Kind::V5 => Some(5),
            Kind::W | Kind::W3 => Some(3),
            Kind::Lane => Some(2),
            Kind::Sh => Some(6),
            Kind::Im | Kind::Un | Kind::Off | Kind::Rel => None,
        }
    }

    /// The field is a two's complement number.
    pub const fn is_signed(self) -> bool {
        matches!(self, Kind::Im | Kind::Off | Kind::Rel)
    }

    /// Least and largest number that a field of `width` bits may hold.
    pub const fn range(self, width: u8) -> (i64, i64) {
        match self {
            Kind::V2 => (0, 30),
            Kind::V3 => (0, 29),
            Kind::V5 => (0, 27),
            Kind::W3 => (0, 5),
            Kind::Lane => (0, 2),
            _ if self.is_signed() => (-(1 << (width - 1)), (1 << (width - 1)) - 1),
            _ => (0, (1 << width) - 1),
        }
    }
}

/// One operand of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operand {
    /// `d e` written, `x y` read and written, `a b c` read, `i j` immediate.
    pub letter: u8,
    /// The operand's kind.
    pub kind: Kind,
}

impl Operand {
    /// The instruction reads the register.
    pub const fn is_read(&self) -> bool {
        matches!(self.letter, b'x' | b'y' | b'a' | b'b' | b'c')
    }

    /// The instruction writes the register.
    pub const fn is_written(&self) -> bool {
        matches!(self.letter, b'd' | b'e' | b'x' | b'y')
    }
}

/// One way in which an instruction ends, and what that way costs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutcomeDef {
    /// `Done`, `Taken`, ...
    pub name: Cow<'static, str>,
    /// Cost of the outcome.
    pub cost: Counts,
    /// Cost of each unit that the semantics report (an octet of a block transfer).
    pub each: Counts,
    /// The outcome costs what the steps of the body cost on the way to it, and nothing else: extensions only.
    pub is_body: bool,
}

/// The chapter of the table in which a row stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Room {
    /// Name, as in file names.
    pub name: &'static str,
    /// Description of the rows of the room.
    pub doc: &'static str,
}

/// Definition of one instruction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InstructionDef {
    /// Mnemonic.
    pub name: Cow<'static, str>,
    /// Description of the instruction; the first sentence is the one that manuals quote.
    pub doc: Cow<'static, str>,
    /// Name of its room.
    pub room: Cow<'static, str>,
    /// Operands in the order of the assembly text.
    pub operands: Cow<'static, [Operand]>,
    /// The word.
    pub pattern: BitPattern,
    /// The pattern as written.
    pub drawn: Cow<'static, str>,
    /// The ways in which it ends; at least one.
    pub outcomes: Cow<'static, [OutcomeDef]>,
}

/// The reason for which a definition is not well formed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DefinitionError {
    /// The operand of this letter has no field, or not as wide as its kind needs.
    Field(u8),
    /// The pattern has a field without an operand.
    Spare,
    /// A letter is used by two operands.
    Twice(u8),
    /// A register under an immediate's letter or the other way round.
    Letter(u8),
    /// There is no outcome.
    NoOutcome,
}

impl InstructionDef {
    /// Checks that operands, pattern and outcomes fit together.
    pub const fn check(operands: &[Operand], pattern: &BitPattern, outcomes: usize) -> Result<(), DefinitionError> {
        let mut at = 0;
        // Each operand: a letter of its own, of the right group, with a field as wide as its kind.
        while at < operands.len() {
            let Operand { letter, kind } = operands[at];
            let mut before = 0;
            while before < at {
                if operands[before].letter == letter {
                    return Err(DefinitionError::Twice(letter));
                }
                before += 1;
            }
            if (letter == b'i' || letter == b'j') != kind.register_file().is_none() {
                return Err(DefinitionError::Letter(letter));
            }
            match pattern.field(letter) {
                None => return Err(DefinitionError::Field(letter)),
                Some(field) => {
                    if let Some(width) = kind.width()
                        && field.width != width
                    {
                        return Err(DefinitionError::Field(letter));
                    }
                }
            }
            at += 1;
        }
        // Every operand has a field by now, so equal numbers mean that no field is left over.
        if pattern.field_count() != operands.len() {
            return Err(DefinitionError::Spare);
        }
        if outcomes == 0 {
            return Err(DefinitionError::NoOutcome);
        }
        Ok(())
    }

    /// The operand of a letter.
    pub fn operand(&self, letter: u8) -> Option<&Operand> {
        self.operands.iter().find(|operand| operand.letter == letter)
    }

    /// Number of the outcome of that name.
    pub fn outcome(&self, name: &str) -> Option<usize> {
        self.outcomes.iter().position(|outcome| outcome.name == name)
    }

    /// The row line as it stands in the table: operands, pattern, outcomes.
    pub fn line(&self) -> String {
        let operands: Vec<String> =
            self.operands.iter().map(|o| format!("{}: {}", o.letter as char, o.kind.name())).collect();
        let outcomes: Vec<String> = self.outcomes.iter().map(OutcomeDef::text).collect();
        format!("{} ({})  \"{}\"  [{}]", self.name, operands.join(", "), self.drawn, outcomes.join(", "))
    }
}

impl OutcomeDef {
    /// The outcome as a row writes it, such as `Done(mem 1; each octet 1)`.
    pub fn text(&self) -> String {
        let list = |counts: &Counts| -> String {
            let parts: Vec<String> =
                counts.iter().filter(|&(_, n)| n != 0).map(|(class, n)| format!("{} {n}", class.name())).collect();
            parts.join(", ")
        };
        if self.is_body {
            format!("{}(body)", self.name)
        } else if self.each == Counts::ZERO {
            format!("{}({})", self.name, list(&self.cost))
        } else {
            format!("{}({}; each {})", self.name, list(&self.cost), list(&self.each))
        }
    }
}
