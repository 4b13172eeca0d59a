//! Calling contexts: the functions and regions that are open around a call. While a program runs, only passes are counted, by context; what
//! functions and regions took with all that they called is folded from those counts in the end.
//!
//! In a program where `pixel` calls `trace` and `trace` calls `root`, what `root` executes is counted in the context {pixel, trace}. The
//! inclusive total of `trace` is the sum over all contexts with `trace` in them, and of its own words in the others. A function that calls
//! itself is in the set once, so that of nested calls only the outermost counts.
//!
//! A jump from a function into another one, or running on into it, is a call with a return behind it: the context becomes that of a callee, but no
//! call is opened. Where `root` jumps to `scale`, that executes in {pixel, trace, root}, and its return to `trace` ends both. Two functions that
//! jump to each other add nothing to the set after the first round.

mod fold;

use std::collections::HashMap;

use isa::Counts;

use super::cells::ClockCells;
use super::clocks::CallPath;
use super::crowd::Crowd;
use super::passes::ContextPasses;
use super::regions::{FunctionChange, RegionNesting};
use super::{ProfileLevel, UnitCount};
use crate::code::Code;
use crate::semantics::Motion;

/// Most calls that are open at once; what deeper calls cost counts for what is open already.
const DEEPEST: usize = 1 << 15;

/// Calls among which that is looked for to which a return leads.
const LOOKED_AT: usize = 1 << 10;

/// Octets that the counts of all contexts may take. What is executed in others is added up at once.
const MOST_OCTETS: usize = 64 << 20;

/// Number of the context that stands for all for which there is no room.
pub const CROWDED: u32 = 0;

/// Number of the context of what was not called.
const ROOT: u32 = 1;

/// Regions, a bit each.
type RegionSet = Box<[u64]>;

fn set_bit(set: &mut [u64], region: u16) {
    set[usize::from(region) / 64] |= 1 << (region % 64);
}

fn has_bit(set: &[u64], region: u16) -> bool {
    set[usize::from(region) / 64] >> (region % 64) & 1 != 0
}

/// Regions that are open around a call, and what was executed in the call itself.
#[derive(Clone, Debug)]
struct CallContext {
    /// The regions in the order in which they were entered, of calls that are too deep not their own.
    path: CallPath,
    /// Regions of the path as a set.
    open: RegionSet,
    /// Passes by exit of the program; empty before the first one.
    passes: Vec<ContextPasses>,
    /// The context of calls from each innermost region, the one of those outside of all regions first; 0 where that is not known.
    callees: Vec<u32>,
}

/// Calls that are open, and what was executed by context.
#[derive(Clone, Debug)]
pub struct Contexts {
    /// Nesting of the program's regions.
    pub regions: RegionNesting,
    /// Cost of each exit, and of a unit of it.
    costs: Vec<(Counts, Counts)>,
    /// Clocks of each exit, its units left out.
    clocks: Vec<u32>,
    /// Most contexts.
    most: usize,
    contexts: Vec<CallContext>,
    numbers: HashMap<CallPath, u32>,
    current: u32,
    /// Open calls: in the low half the context of the caller, in the high half the word to which the callee returns. The first is none.
    calls: Box<[u64]>,
    /// The place behind the newest call.
    top: usize,
    /// Calls deeper than [`DEEPEST`].
    deeper: u64,
    crowd: Option<Crowd>,
    /// By region: operations in crowded contexts, and clocks of those.
    crowded: Vec<(Counts, u64)>,
    /// Passes in crowded contexts, where clocks are measured.
    crowded_passes: Vec<ContextPasses>,
    /// Clocks of computing by context and innermost region, where they are measured: see [`Contexts::cell`].
    pub cells: Option<ClockCells>,
    /// By region: how often it was entered.
    entered: Vec<u64>,
}

/// Open calls as generated code follows them.
#[derive(Clone, Copy, Debug)]
pub struct CallStack {
    /// The first place.
    pub start: *mut u64,
    /// The place behind the newest call.
    pub top: *mut u64,
    /// The place at which there is no room for another call.
    pub end: *mut u64,
    /// The current context.
    pub current: u32,
}

impl Contexts {
    /// Nothing called yet.
    pub fn new(code: &Code, level: ProfileLevel) -> Contexts {
        let regions = RegionNesting::new(code);
        let costs: Vec<_> = (0..code.passes().len()).map(|pass| code.pass_cost(pass)).collect();
        // Passes and units here, as many numbers in generated code, a context of callees for each region.
        let octets = 48 * (costs.len() + code.slots().len()) + 16 * regions.count() + 256;
        let nothing: RegionSet = vec![0; regions.count().div_ceil(64)].into();
        let mut contexts = Contexts {
            most: (MOST_OCTETS / octets).clamp(4, 1 << 12),
            contexts: Vec::new(),
            numbers: HashMap::new(),
            current: ROOT,
            calls: vec![0; DEEPEST + 2].into(),
            top: 1,
            deeper: 0,
            crowd: None,
            clocks: code.costs().iter().map(|cost| cost.clocks).collect(),
            crowded: Vec::new(),
            crowded_passes: Vec::new(),
            cells: (level == ProfileLevel::Clocks).then(|| ClockCells::new(regions.count() + 1)),
            entered: vec![0; regions.count()],
            regions,
            costs,
        };
        contexts.calls[0] = u64::MAX << 32;
        let path = CallPath { regions: Box::default(), is_deep: true };
        contexts.contexts.push(CallContext { path, open: nothing, passes: Vec::new(), callees: Vec::new() });
        contexts.number(CallPath::default());
        contexts
    }

    /// Number of a context; that of the crowded ones where there is no room.
    fn number(&mut self, path: CallPath) -> u32 {
        if let Some(&number) = self.numbers.get(&path) {
            return number;
        }
        if self.contexts.len() >= self.most {
            return CROWDED;
        }
        let number = self.contexts.len() as u32;
        let callees = vec![0; self.regions.count() + 1];
        let mut open: RegionSet = vec![0; self.regions.count().div_ceil(64)].into();
        path.regions.iter().for_each(|&region| set_bit(&mut open, region));
        self.contexts.push(CallContext { path: path.clone(), open, passes: Vec::new(), callees });
        self.numbers.insert(path, number);
        if let Some(cells) = &mut self.cells {
            cells.add_context();
        }
        number
    }

    /// The path of a call that a slot of the current context makes.
    fn path_of_callee(&self, caller: u32, is_deep: bool) -> CallPath {
        let CallContext { path, open, .. } = &self.contexts[self.current as usize];
        let entered = self.regions.around(caller).iter().filter(|&&region| !has_bit(open, region));
        CallPath { regions: path.regions.iter().chain(entered).copied().collect(), is_deep }
    }

    /// The context of what a slot calls; `None` where that has none.
    pub fn callee(&mut self, caller: u32) -> Option<u32> {
        let from = self.regions.innermost(caller).map_or(0, |region| usize::from(region) + 1);
        if let Some(&known) = self.contexts[self.current as usize].callees.get(from).filter(|&&known| known != 0) {
            return Some(known);
        }
        let number = (self.current != CROWDED).then(|| self.number(self.path_of_callee(caller, false)))?;
        if number == CROWDED {
            return None;
        }
        self.contexts[self.current as usize].callees[from] = number;
        Some(number)
    }

    /// Context of calls from an innermost region of a context, the place of the region among the callees; 0 where there were none.
    pub fn known_callee(&self, context: u32, from: usize) -> u32 {
        self.contexts[context as usize].callees.get(from).copied().unwrap_or(0)
    }

    /// Number of contexts, that of the crowded ones counted.
    pub fn count(&self) -> u32 {
        self.contexts.len() as u32
    }

    /// Passes are counted by context now: neither are there too many contexts, nor are calls too deep.
    pub fn is_plain(&self) -> bool {
        self.current != CROWDED && self.deeper == 0
    }

    /// The calls for generated code, which may push and pop calls of contexts that are known as long as they are plain.
    pub fn stack(&mut self) -> CallStack {
        let calls = self.calls.as_mut_ptr_range();
        let (start, end) = (calls.start, calls.start.wrapping_add(DEEPEST + 1));
        CallStack { start, top: start.wrapping_add(self.top), end, current: self.current }
    }

    /// The calls that generated code has left open.
    pub fn set_stack(&mut self, CallStack { start, top, current, .. }: CallStack) {
        self.top = (top as usize - start as usize) / size_of::<u64>();
        self.current = current;
        debug_assert!((1..self.calls.len()).contains(&self.top) && current < self.count());
    }

    fn enter_all(&mut self, slot: u32) {
        self.regions.around(slot).iter().for_each(|&region| self.entered[usize::from(region)] += 1);
    }

    /// A run begins at a slot.
    pub fn begin(&mut self, slot: u32) {
        self.end();
        self.enter_all(slot);
    }

    /// A run is over.
    pub fn end(&mut self) {
        (self.top, self.current, self.deeper, self.crowd) = (1, ROOT, 0, None);
    }

    /// A pass through an exit of the slot at `pc`.
    #[inline]
    pub fn pass(&mut self, pc: u32, exit: usize, units: UnitCount) {
        if self.cells.is_some() {
            self.spend(self.current, pc, u64::from(self.clocks[exit]) + units.clocks);
        }
        match self.contexts[self.current as usize].passes.get_mut(exit) {
            Some(passes) => passes.add(1, units),
            None => self.pass_slowly(pc, exit, units),
        }
    }

    #[cold]
    fn pass_slowly(&mut self, pc: u32, exit: usize, units: UnitCount) {
        let Some(crowd) = &self.crowd else {
            let mut passes = ContextPasses::default();
            passes.add(1, units);
            return self.add_passes(self.current, exit, passes);
        };
        let (cost, each) = self.costs[exit];
        let cost = cost + each.times(units.units.into());
        let clocks = u64::from(self.clocks[exit]) + units.clocks;
        if self.cells.is_some() {
            self.crowded_passes.resize(self.costs.len(), ContextPasses::default());
            self.crowded_passes[exit].add(1, units);
        }
        self.crowded.resize(self.regions.count(), (Counts::ZERO, 0));
        let own = if self.deeper == 0 { self.regions.around(pc) } else { &[] };
        for (region, sum) in self.crowded.iter_mut().enumerate() {
            if crowd.is_open(region as u16) || own.contains(&(region as u16)) {
                sum.0 += cost;
                sum.1 += clocks;
            }
        }
    }

    /// Passes through an exit that were counted elsewhere, with their units.
    pub fn add_passes(&mut self, context: u32, exit: usize, more: ContextPasses) {
        let passes = &mut self.contexts[context as usize].passes;
        if passes.is_empty() {
            passes.resize(self.costs.len(), ContextPasses::default());
        }
        passes[exit].merge(more);
    }

    /// A region was entered so often.
    pub fn add_entered(&mut self, region: u16, times: u64) {
        self.entered[usize::from(region)] += times;
    }

    /// Control goes from one slot to another.
    #[inline]
    pub fn go(&mut self, from: u32, to: u32, motion: Motion) {
        match motion {
            Motion::Call => self.call(from, to),
            Motion::Return => self.go_back(from, to),
            Motion::Jump if self.regions.innermost(from) != self.regions.innermost(to) && self.deeper == 0 => {
                self.jump(from, to);
            }
            Motion::Jump => {}
        }
    }

    /// A jump, or running on, from one region to another one.
    fn jump(&mut self, from: u32, to: u32) {
        match self.regions.change(from, to) {
            Some(FunctionChange::TailCall) => {
                if let Some(callee) = self.callee(from) {
                    self.current = callee;
                } else {
                    let (calls, around) = (self.top, self.regions.around(from).to_vec());
                    self.crowd(calls - 1).enter_tail(calls, &around);
                    self.current = CROWDED;
                }
            }
            Some(FunctionChange::Outside) => self.leave_functions(),
            None => {}
        }
        self.regions.entered(from, to).iter().for_each(|&region| self.entered[usize::from(region)] += 1);
    }

    /// Goes back to the context in which the current call began, from that of functions to which it has jumped.
    fn leave_functions(&mut self) {
        let call = self.calls[self.top - 1];
        let from = self.regions.innermost(((call >> 32) as u32).wrapping_sub(1));
        let from = from.map_or(0, |region| usize::from(region) + 1);
        let begun = if self.top == 1 { ROOT } else { self.known_callee(call as u32, from) };
        match &mut self.crowd {
            // It began where there was no room already.
            Some(crowd) if begun == CROWDED => crowd.leave_tails(self.top - 1),
            crowd => (*crowd, self.current) = (None, begun),
        }
    }

    fn call(&mut self, from: u32, to: u32) {
        if self.deeper != 0 {
            self.deeper += 1;
            return;
        }
        let is_deep = self.top > DEEPEST;
        let callee = match is_deep {
            false => self.callee(from).unwrap_or(CROWDED),
            true if self.current == CROWDED => CROWDED,
            true => self.number(self.path_of_callee(from, true)),
        };
        if callee == CROWDED {
            self.crowd_in(from);
        }
        self.calls[self.top] = u64::from(from.wrapping_add(1)) << 32 | u64::from(self.current);
        self.top += 1;
        self.current = callee;
        match is_deep {
            true => self.deeper = 1,
            false => self.enter_all(to),
        }
    }

    /// Open regions, counted from here on: there is no room for the context that follows the current one. `bottom` is the number of the call in
    /// which that is so.
    fn crowd(&mut self, bottom: usize) -> &mut Crowd {
        let (regions, contexts) = (&self.regions, &self.contexts);
        self.crowd.get_or_insert_with(|| {
            let open = &contexts[self.current as usize].open;
            let open = (0..regions.count() as u16).map(|region| u32::from(has_bit(open, region)));
            Crowd::new(bottom, open.collect())
        })
    }

    /// Counts what is open around a call for whose context there is no room.
    fn crowd_in(&mut self, from: u32) {
        let around = self.regions.around(from).to_vec();
        self.crowd(self.top).enter(&around);
    }

    /// A return ends the newest call that returns to its target, and every call inside that one; where there is none, it is a jump.
    fn go_back(&mut self, from: u32, to: u32) {
        if self.deeper != 0 {
            self.deeper -= 1;
            if self.deeper == 0 {
                self.close(self.top - 1);
            }
            return;
        }
        let returns_to = |at: &usize| (self.calls[*at] >> 32) as u32 == to;
        match (self.top.saturating_sub(LOOKED_AT).max(1)..self.top).rev().find(returns_to) {
            Some(at) => {
                self.close(at);
                // What is called last in a function returns into the next one.
                self.jump(to.wrapping_sub(1), to);
            }
            None => self.jump(from, to),
        }
    }

    /// Ends the calls from one on.
    fn close(&mut self, first: usize) {
        match &mut self.crowd {
            Some(crowd) if first > crowd.bottom => {
                for call in &self.calls[first..self.top] {
                    crowd.leave(self.regions.around(((call >> 32) as u32).wrapping_sub(1)));
                }
                crowd.leave_tails(first);
            }
            crowd => *crowd = None,
        }
        self.top = first;
        self.current = self.calls[first] as u32;
    }

    /// Number of the current context.
    pub fn current(&self) -> u32 {
        self.current
    }

    /// Paths of the contexts, by number.
    pub fn paths(&self) -> impl Iterator<Item = &CallPath> {
        self.contexts.iter().map(|context| &context.path)
    }

    /// Most contexts that there may be, that of the crowded ones counted.
    pub fn most(&self) -> usize {
        self.most
    }

    /// All regions that are open around a slot, where the current context is that of the crowded ones; else none.
    pub fn crowded_around(&self, slot: u32) -> Vec<u16> {
        let Some(crowd) = &self.crowd else { return Vec::new() };
        let own = if self.deeper == 0 { self.regions.around(slot) } else { &[] };
        let is_open = |region: &u16| crowd.is_open(*region) || own.contains(region);
        (0..self.regions.count() as u16).filter(is_open).collect()
    }

    /// Number of the cell of a context for the innermost region around a slot: those of a context stand together, the first one for no region.
    fn cell(&self, context: u32, slot: u32) -> u32 {
        let region = self.regions.innermost(slot).map_or(0, |region| u32::from(region) + 1);
        context * (self.regions.count() as u32 + 1) + region
    }

    /// Adds clocks of computing at a slot of a context.
    pub fn spend(&mut self, context: u32, slot: u32, clocks: u64) {
        let cell = self.cell(context, slot);
        if let Some(cells) = &mut self.cells {
            cells.add(cell, clocks);
        }
    }
}
