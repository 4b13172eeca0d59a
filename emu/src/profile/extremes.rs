//! Least and most that one call of each function and region takes: follows calls, returns and regions while a program runs, with a stack of what
//! is open and snapshots of running totals.

use isa::{Class, Counts};

use super::Extremes;
use super::regions::{FunctionChange, RegionNesting};
use crate::code::Code;
use crate::semantics::Motion;

/// Most regions and calls that are open at once; what deeper calls cost counts for what is open already, and a jump into another function ends the one
/// that it leaves.
const DEEPEST: usize = 1 << 16;

/// Operations by class, as generated code adds them up before they are told.
pub type Near = [u32; Class::ALL.len()];

/// Something open, with the totals when it was entered.
#[derive(Clone, Copy, Debug)]
struct Open {
    what: What,
    entered: Counts,
}

/// A call or a region.
#[derive(Clone, Copy, Debug)]
enum What {
    /// A call: the regions above it belong to the callee.
    Call {
        /// Word to which the callee returns.
        back: u32,
        /// Number of the first thing open in the caller.
        base: u32,
    },
    /// A jump into another function: the regions above it belong to that, and end when the call around them does.
    Tail {
        /// Number of the first thing open in the function that has jumped.
        base: u32,
    },
    /// A region or function, by its number.
    Region(u16),
}

/// Measures each call by itself.
#[derive(Clone, Debug)]
pub struct CallMeter {
    regions: RegionNesting,
    /// Cost of each exit of the program, and what a unit of it adds.
    costs: Vec<(Counts, Counts)>,
    open: Vec<Open>,
    /// Number of open calls that return to each word.
    returns_to: Vec<u32>,
    /// Calls deeper than [`DEEPEST`].
    deeper: u64,
    /// Number of the first thing open in the current call, or behind its last jump into another function.
    base: usize,
    /// Running totals, of which only differences matter.
    total: Counts,
    /// By region; `None` before its first call has ended.
    found: Vec<Option<Extremes>>,
}

impl CallMeter {
    /// Nothing called yet.
    pub fn new(code: &Code) -> CallMeter {
        let regions = RegionNesting::new(code);
        CallMeter {
            costs: (0..code.passes().len()).map(|pass| code.pass_cost(pass)).collect(),
            open: Vec::new(),
            returns_to: vec![0; code.slots().len() + 1],
            deeper: 0,
            base: 0,
            total: Counts::ZERO,
            found: vec![None; regions.count()],
            regions,
        }
    }

    fn close_top(&mut self) {
        let Some(Open { what, entered }) = self.open.pop() else { return };
        match what {
            What::Region(region) => {
                let cost = Counts(std::array::from_fn(|at| self.total.0[at].wrapping_sub(entered.0[at])));
                let one = Extremes::of(cost);
                match &mut self.found[usize::from(region)] {
                    Some(found) => found.widen(&one),
                    found => *found = Some(one),
                }
            }
            What::Call { back, base } => {
                self.returns_to[back as usize] -= 1;
                self.base = base as usize;
            }
            What::Tail { base } => self.base = base as usize,
        }
    }

    fn close_to(&mut self, height: usize) {
        while self.open.len() > height {
            self.close_top();
        }
    }

    /// Leaves and enters regions of the current call so that those around a slot are open.
    fn move_to(&mut self, pc: u32) {
        let base = self.base;
        let around = self.regions.around(pc);
        let is_open = |(open, region): &(&Open, &u16)| matches!(open.what, What::Region(other) if other == **region);
        let kept = self.open[base..].iter().zip(around).take_while(is_open).count();
        self.close_to(base + kept);
        let room = DEEPEST.saturating_sub(self.open.len());
        let entered = self.regions.around(pc).iter().skip(kept).take(room);
        self.open.extend(entered.map(|&region| Open { what: What::Region(region), entered: self.total }));
    }

    fn call(&mut self, back: u32, target: u32) {
        if self.open.len() < DEEPEST {
            let (what, entered) = (What::Call { back, base: self.base as u32 }, Counts::ZERO);
            self.open.push(Open { what, entered });
            self.base = self.open.len();
            self.returns_to[back as usize] += 1;
            self.move_to(target);
        } else {
            self.deeper += 1;
        }
    }

    /// A jump, or running on, from one region to another one.
    fn jump(&mut self, pc: u32, target: u32) {
        match self.regions.change(pc, target) {
            Some(FunctionChange::TailCall) if self.open.len() < DEEPEST => {
                let (what, entered) = (What::Tail { base: self.base as u32 }, Counts::ZERO);
                self.open.push(Open { what, entered });
                self.base = self.open.len();
            }
            // Everything ends that the call has entered.
            Some(FunctionChange::Outside) => {
                while !matches!(self.open.last(), None | Some(Open { what: What::Call { .. }, .. })) {
                    self.close_top();
                }
            }
            _ => {}
        }
        self.move_to(target);
    }

    /// A return ends the newest call that returns to its target, and every call inside that one.
    fn go_back(&mut self, pc: u32, target: u32) {
        if self.deeper != 0 {
            self.deeper -= 1;
            return;
        }
        let is_known = self.returns_to.get(target as usize).is_some_and(|&count| count != 0);
        if is_known {
            while !matches!(self.open.last(), Some(Open { what: What::Call { back, .. }, .. }) if *back == target) {
                self.close_top();
            }
            self.close_top();
        }
        // What is called last in a function returns into the next one.
        self.jump(if is_known { target.wrapping_sub(1) } else { pc }, target);
    }

    /// A run begins at a slot.
    pub fn begin(&mut self, pc: u32) {
        self.end();
        self.move_to(pc);
    }

    /// A run is over.
    pub fn end(&mut self) {
        self.close_to(0);
        self.deeper = 0;
    }

    /// A pass through an exit.
    pub fn pass(&mut self, exit: usize, units: u32) {
        let (cost, each) = self.costs[exit];
        self.total += cost;
        if units != 0 {
            self.total += each.times(units.into());
        }
    }

    /// Operations that were executed.
    #[inline]
    pub fn add(&mut self, counts: &Near) {
        for (sum, &more) in self.total.0.iter_mut().zip(counts) {
            *sum = sum.wrapping_add(more.into());
        }
    }

    /// So many of the operations that were told of last were not executed.
    pub fn take_back(&mut self, counts: &Counts) {
        for (sum, less) in self.total.0.iter_mut().zip(counts.0) {
            *sum = sum.wrapping_sub(less);
        }
    }

    /// Units of an exit that were executed, the pass itself left out.
    pub fn add_units(&mut self, exit: usize, units: u32) {
        self.total += self.costs[exit].1.times(units.into());
    }

    /// Control goes from one slot to another; what ended before was told.
    #[inline]
    pub fn go(&mut self, pc: u32, next: u32, motion: Motion) {
        match motion {
            Motion::Call => self.call(pc.wrapping_add(1), next),
            Motion::Return => self.go_back(pc, next),
            Motion::Jump if self.deeper == 0 && self.regions.innermost(pc) != self.regions.innermost(next) => {
                self.jump(pc, next);
            }
            Motion::Jump => {}
        }
    }

    /// Extremes of each region.
    pub fn found(&self) -> &[Option<Extremes>] {
        &self.found
    }
}
