//! Witness of each instruction: how the last one ended, and which calls are open.

use crate::code::octets::Buffer;
use crate::code::registers::Registers;
use crate::code::tally::Tally;
use crate::code::{Code, Slot};
use crate::profile::{Observer, Profile, ProfileLevel, UnitCount};
use crate::semantics::Motion;
use crate::shadow::Shadow;

/// Open calls that are kept; deeper ones are forgotten when they are made.
const DEEPEST: usize = 4096;

/// An open call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OpenCall {
    /// Word of the call.
    pub from: u32,
    /// First word of what was called.
    pub to: u32,
}

/// Witness of a lone core.
#[derive(Clone, Debug, Default)]
pub(super) struct Witness {
    /// Open calls, the innermost last.
    pub calls: Vec<OpenCall>,
    /// Number of the last pass, and its units.
    pub exit: (usize, u32),
}

impl Observer for Witness {
    const IS_ACTIVE: bool = true;

    fn new(_: &Code, _: ProfileLevel) -> Witness {
        Witness::default()
    }

    fn begin(&mut self, _: u32) {}

    #[inline]
    fn step(&mut self, pc: u32, exit: usize, units: UnitCount, next: u32, motion: Motion) {
        self.exit = (exit, units.units);
        match motion {
            Motion::Jump => {}
            Motion::Call if self.calls.len() < DEEPEST => self.calls.push(OpenCall { from: pc, to: next }),
            Motion::Call => {}
            // A return ends the call behind which it leads, and all inside of that; elsewhere it is a jump.
            Motion::Return => {
                if let Some(at) = self.calls.iter().rposition(|call| call.from.wrapping_add(1) == next) {
                    self.calls.truncate(at);
                }
            }
        }
    }

    fn end(&mut self) {}

    fn into_profile(self, _: &Code, _: &Tally) -> Option<Profile> {
        None
    }
}

/// Witness of a lone core that has a shadow.
pub(super) struct ShadowWitness {
    /// Open calls, and how the last instruction ended.
    pub witness: Witness,
    /// The shadow.
    pub shadow: Box<Shadow>,
}

impl Observer for ShadowWitness {
    const IS_ACTIVE: bool = true;
    const SEES_VALUES: bool = true;

    fn new(code: &Code, level: ProfileLevel) -> ShadowWitness {
        ShadowWitness { witness: Witness::new(code, level), shadow: Box::new(Observer::new(code, level)) }
    }

    fn begin(&mut self, _: u32) {}

    #[inline]
    fn before(&mut self, pc: u32, slot: &Slot, registers: &Registers, buffer: &Buffer) {
        self.shadow.before(pc, slot, registers, buffer);
    }

    #[inline]
    fn after(&mut self, pc: u32, code: &Code, registers: &Registers) {
        self.shadow.after(pc, code, registers);
    }

    #[inline]
    fn step(&mut self, pc: u32, exit: usize, units: UnitCount, next: u32, motion: Motion) {
        self.witness.step(pc, exit, units, next, motion);
    }

    fn end(&mut self) {}

    fn into_profile(self, _: &Code, _: &Tally) -> Option<Profile> {
        None
    }
}
