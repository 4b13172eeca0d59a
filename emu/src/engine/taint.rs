//! Watches whether a work item does anything that depends on how many cores there are, or on which one it runs: where
//! the numbers of cores go, register by register.

use isa::{Kind, Op};

use crate::code::Code;
use crate::code::tally::Tally;
use crate::profile::{Observer, Profile, ProfileLevel, Profiler, UnitCount};
use crate::semantics::Motion;

/// Effect of an instruction on the taint: its scalar registers, a bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TaintEffect {
    reads: u64,
    writes: u64,
    /// Written with the number of the main processor, which is the number of cores.
    counts: u64,
    /// Target of a message.
    target: u64,
    is_send: bool,
    /// The instruction tells which core this is, so that the item depends on that.
    tells_core: bool,
}

impl TaintEffect {
    /// The effect of a word.
    pub fn new(code: &Code, pc: u32) -> TaintEffect {
        let mut effect = TaintEffect::default();
        let (Some(slot), Some(row)) = (code.slots().get(pc as usize), code.slot_row(pc)) else { return effect };
        effect.is_send = matches!(slot.op, Some(Op::send2 | Op::send5));
        effect.tells_core = slot.op == Some(Op::core);
        for operand in row.operands.iter().filter(|operand| matches!(operand.kind, Kind::S | Kind::A)) {
            let bit = 1 << (slot.fields.get(operand.letter) & 63);
            // The target of a message is no use of a value: to send to the main processor depends on nothing.
            match operand.is_read() {
                true if effect.is_send => effect.target |= bit,
                true => effect.reads |= bit,
                false => {}
            }
            if operand.is_written() {
                effect.writes |= bit;
                // A receive writes its sender's number, which for work items is the main processor's and so that of the cores.
                if matches!(slot.op, Some(Op::cores | Op::recv2 | Op::recv5)) {
                    // s0 stays zero.
                    effect.counts |= bit & !1;
                }
            }
        }
        effect
    }

    /// True for an instruction that matters even when no register holds the number of cores.
    pub fn asks(&self) -> bool {
        self.counts != 0 || self.is_send || self.tells_core
    }

    /// Registers that hold the number of cores when nothing else did before.
    pub fn counts(&self) -> u64 {
        self.counts
    }

    /// Scalars that it reads, other than for where a message goes to.
    pub fn reads(&self) -> u64 {
        self.reads
    }

    /// Scalars that it writes.
    pub fn writes(&self) -> u64 {
        self.writes
    }

    /// Of a send, the scalars of which one has to hold the number of cores, so that it does not depend on it.
    pub fn fixed_unless(&self) -> Option<u64> {
        self.is_send.then_some(self.target)
    }

    /// The instruction tells which core this is.
    pub fn tells_core(&self) -> bool {
        self.tells_core
    }

    /// True where it matters to the instruction which of these registers hold the number of cores.
    pub fn touches(&self, registers: u64) -> bool {
        (self.reads | self.writes | self.target) & registers != 0
    }
}

/// Taint of a work item: what it has learned of the cores on its way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Taint {
    /// Registers that hold the number of cores, as far as the item's path tells.
    pub tainted: u64,
    /// Dependence of the item on the number of cores is possible.
    pub depends_on_cores: bool,
    /// The item has asked for its core's number.
    pub depends_on_core: bool,
}

impl Taint {
    /// The item executes an instruction.
    #[inline]
    pub fn step(&mut self, effect: TaintEffect) {
        // A message to a fixed number would go to another processor where there are more cores.
        let is_fixed = effect.is_send && self.tainted & effect.target == 0;
        self.depends_on_cores |= self.tainted & effect.reads != 0 || is_fixed;
        self.depends_on_core |= effect.tells_core;
        self.tainted = self.tainted & !effect.writes | effect.counts;
    }
}

/// An observer that watches for that, beside another one.
#[derive(Clone, Debug)]
pub struct TaintObserver<O> {
    /// The other one.
    pub inner: O,
    effects: Vec<TaintEffect>,
    /// Taint of the item.
    pub taint: Taint,
}

impl<O: Observer> Observer for TaintObserver<O> {
    const IS_ACTIVE: bool = true;

    fn new(code: &Code, level: ProfileLevel) -> TaintObserver<O> {
        let effects = (0..code.slots().len() as u32).map(|pc| TaintEffect::new(code, pc)).collect();
        TaintObserver { inner: O::new(code, level), effects, taint: Taint::default() }
    }

    fn begin(&mut self, pc: u32) {
        self.taint = Taint::default();
        self.inner.begin(pc);
    }

    #[inline]
    fn step(&mut self, pc: u32, exit: usize, units: UnitCount, next: u32, motion: Motion) {
        self.taint.step(self.effects[pc as usize]);
        if O::IS_ACTIVE {
            self.inner.step(pc, exit, units, next, motion);
        }
    }

    fn end(&mut self) {
        self.inner.end();
    }

    fn profiler(&mut self) -> Option<&mut Profiler> {
        self.inner.profiler()
    }

    fn into_profile(self, code: &Code, tally: &Tally) -> Option<Profile> {
        self.inner.into_profile(code, tally)
    }
}
