//! The body of an extension instruction: steps over template registers, with branches inside and explicit outcomes.

use std::sync::Arc;

use crate::isa::Instruction;
use messages::{Place, Source};

/// A number in a step that may depend on an immediate of the row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Immediate {
    /// Always the same.
    Number(i32),
    /// `factor` times the row's immediate of that letter, plus `offset`.
    Letter {
        /// `i` or `j`.
        letter: u8,
        /// The factor of the immediate.
        factor: i32,
        /// The number that is added.
        offset: i32,
    },
}

/// The act of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyAct {
    /// An instruction on template registers; a branch distance counts steps.
    Execute {
        /// The instruction. Its registers are numbered as [`super::registers`] says.
        instruction: Instruction,
        /// The immediates `i` and `j`.
        immediates: [Immediate; 2],
    },
    /// The end, by an outcome of the row.
    End {
        /// Number of the outcome.
        outcome: u8,
        /// The program goes on where the row's distance leads, instead of behind the instruction.
        jumps: bool,
    },
}

/// One step of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BodyStep {
    /// The step's act.
    pub act: BodyAct,
    /// The step's line in the source of the body, from 1.
    pub line: u32,
}

/// A body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Body {
    /// The steps; the first one is executed first, the last one is an outcome or does not fall through.
    pub steps: Vec<BodyStep>,
    /// The file.
    pub source: Arc<Source>,
    /// Temporaries that it uses, by file (`s`, `v`, `w`): one more than the highest number.
    pub temporaries: [u8; 3],
}

impl Body {
    /// Place of a step's line, for messages.
    pub fn place(&self, step: usize) -> Option<Place> {
        let before = self.steps.get(step)?.line.checked_sub(1)? as usize;
        let text = &self.source.text;
        let start: usize = text.split_inclusive('\n').take(before).map(str::len).sum();
        let line = text.get(start..)?.lines().next()?;
        let blanks = line.len() - line.trim_start().len();
        Some(Place::new(&self.source, start + blanks..start + blanks + line.trim().len()))
    }
}
