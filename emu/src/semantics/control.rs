//! Semantics of the instructions that choose the next instruction. Program counters count words.

use isa::table::{Done, outcome};

use super::ControlRoom;

/// Motion of control to the next instruction, for those who keep a stack of calls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// By running on, a branch or a jump.
    Jump,
    /// By a call.
    Call,
    /// By a return.
    Return,
}

/// End of a program by its own instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// `halt`.
    Halt,
    /// `trap`, with its number.
    Trap(u32),
}

/// Flow of control instructions: where one stands, and where it leads.
#[derive(Clone, Copy, Debug)]
pub struct Flow {
    /// Word of this instruction.
    pub pc: u32,
    /// Word of the next instruction.
    pub next: u32,
    /// Motion by which it is reached.
    pub motion: Motion,
    /// Set when the program ends here.
    pub end: Option<End>,
    /// Number of this core; the main processor is the number of cores.
    pub core: u32,
    /// Number of cores, the main processor not counted.
    pub cores: u32,
}

impl Flow {
    /// The flow at word `pc` before anything was decided: on to `next`, which is the next word but in bodies of extensions.
    #[inline]
    pub fn new(pc: u32, next: u32, core: u32, cores: u32) -> Flow {
        Flow { pc, next, motion: Motion::Jump, end: None, core, cores }
    }

    #[inline]
    fn jump_by(&mut self, words: i32) {
        self.next = self.pc.wrapping_add_signed(words);
    }

    /// Address of the word after this one, for the return.
    #[inline]
    fn link(&self) -> i32 {
        self.pc.wrapping_add(1) as i32
    }
}

/// A branch: jumps by `i` words where `$claim` holds.
macro_rules! branch {
    ($self:ident, $name:ident, $i:ident, $claim:expr) => {
        if $claim {
            $self.jump_by($i);
            outcome::$name::Outcome::Taken
        } else {
            outcome::$name::Outcome::Fall
        }
    };
}

impl ControlRoom for Flow {
    #[inline]
    fn beq(&mut self, a: i32, b: i32, i: i32) -> outcome::beq::Outcome {
        branch!(self, beq, i, a == b)
    }

    #[inline]
    fn bne(&mut self, a: i32, b: i32, i: i32) -> outcome::bne::Outcome {
        branch!(self, bne, i, a != b)
    }

    #[inline]
    fn blt(&mut self, a: i32, b: i32, i: i32) -> outcome::blt::Outcome {
        branch!(self, blt, i, a < b)
    }

    #[inline]
    fn bge(&mut self, a: i32, b: i32, i: i32) -> outcome::bge::Outcome {
        branch!(self, bge, i, a >= b)
    }

    #[inline]
    fn bltu(&mut self, a: i32, b: i32, i: i32) -> outcome::bltu::Outcome {
        branch!(self, bltu, i, (a as u32) < b as u32)
    }

    #[inline]
    fn bgeu(&mut self, a: i32, b: i32, i: i32) -> outcome::bgeu::Outcome {
        branch!(self, bgeu, i, a as u32 >= b as u32)
    }

    #[inline]
    fn bweqz(&mut self, a: i64, i: i32) -> outcome::bweqz::Outcome {
        branch!(self, bweqz, i, a == 0)
    }

    #[inline]
    fn bwnez(&mut self, a: i64, i: i32) -> outcome::bwnez::Outcome {
        branch!(self, bwnez, i, a != 0)
    }

    #[inline]
    fn bwltz(&mut self, a: i64, i: i32) -> outcome::bwltz::Outcome {
        branch!(self, bwltz, i, a < 0)
    }

    #[inline]
    fn bwgez(&mut self, a: i64, i: i32) -> outcome::bwgez::Outcome {
        branch!(self, bwgez, i, a >= 0)
    }

    #[inline]
    fn bwlt(&mut self, a: i64, b: i64, i: i32) -> outcome::bwlt::Outcome {
        branch!(self, bwlt, i, a < b)
    }

    #[inline]
    fn bweq(&mut self, a: i64, b: i64, i: i32) -> outcome::bweq::Outcome {
        branch!(self, bweq, i, a == b)
    }

    #[inline]
    fn jump(&mut self, i: i32) -> outcome::jump::Outcome {
        self.jump_by(i);
        outcome::jump::Outcome::Taken
    }

    #[inline]
    fn call(&mut self, i: i32) -> (i32, outcome::call::Outcome) {
        self.jump_by(i);
        self.motion = Motion::Call;
        (self.link(), outcome::call::Outcome::Taken)
    }

    #[inline]
    fn callr(&mut self, a: u32) -> (i32, outcome::callr::Outcome) {
        self.next = a;
        self.motion = Motion::Call;
        (self.link(), outcome::callr::Outcome::Taken)
    }

    #[inline]
    fn ret(&mut self, a: u32) -> outcome::ret::Outcome {
        self.next = a;
        self.motion = Motion::Return;
        outcome::ret::Outcome::Taken
    }

    #[inline]
    fn core(&mut self) -> (i32, Done) {
        (self.core as i32, Done)
    }

    #[inline]
    fn cores(&mut self) -> (i32, Done) {
        (self.cores as i32, Done)
    }

    #[inline]
    fn halt(&mut self) -> Done {
        self.end = Some(End::Halt);
        Done
    }

    #[inline]
    fn trap(&mut self, i: i32) -> Done {
        self.end = Some(End::Trap(i as u32));
        Done
    }
}
