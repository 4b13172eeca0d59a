//! Instructions that are loaded for a run: a row, and what it does as a body of other instructions. How a body is written is the
//! assembler's business, how it is executed that of engines.

mod body;
mod flow;

use std::any::Any;
use std::sync::Arc;

pub use body::{Body, BodyAct, BodyStep, Immediate};
pub use flow::{Defect, Summary};

use crate::definition::InstructionDef;

/// Semantics that an engine keeps with an instruction, in its own terms, of which nothing is known here.
pub type Semantics = Arc<dyn Any + Send + Sync>;

/// An instruction of an extension.
#[derive(Clone, Debug)]
pub struct Extension {
    /// The definition, as a row of a file.
    pub definition: InstructionDef,
    /// The body, in assembly. Without that and without semantics, a word of it can be written and shown but not executed.
    pub body: Option<Arc<Body>>,
    /// The semantics, as an engine has them: executed in the place of the body.
    pub semantics: Option<Semantics>,
    /// The steps of the body count as instructions, as if they stood in the program.
    pub is_expanded: bool,
}

/// The registers of a body: how they are numbered in its steps.
///
/// 0 is `s0`; numbers from [`registers::hidden`] on are temporaries; those from [`registers::OPERANDS`] on are operands of the row.
pub mod registers {
    use crate::pattern::LETTERS;

    /// The number of the first operand; [`operand`] has the others.
    pub const OPERANDS: u8 = 64;

    /// Registers of a file that no program can name, by their numbers: they hold what a body works with.
    pub const fn hidden(file: char) -> std::ops::Range<u8> {
        match file {
            'w' => 8..16,
            _ => 32..64,
        }
    }

    /// The number of register `offset` of the operand of a letter.
    pub fn operand(letter: u8, offset: u8) -> u8 {
        let place = LETTERS.iter().position(|&other| other == letter).expect("operands have letters of patterns");
        OPERANDS + 8 * place as u8 + offset
    }

    /// The letter and offset of an operand's number; `None` for temporaries and `s0`.
    pub fn letter(number: u8) -> Option<(u8, u8)> {
        let place = number.checked_sub(OPERANDS)?;
        Some((*LETTERS.get(usize::from(place / 8))?, place % 8))
    }
}
