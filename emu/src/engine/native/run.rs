//! Runs generated code, and what it needs of the machine meanwhile.

use std::any::Any;
use std::panic::resume_unwind;

use super::classes::Lanes;
use super::context::{Context, CounterLayout, NOTED};
use super::count::Counters;
use super::units::UnitExits;
use super::{NO_SITE, Native, NotedRead, Status, Stopped, TimedLink};
use crate::code::octets::Buffer;
use crate::code::quantity::Clocks;
use crate::code::tally::Losses;
use crate::code::trap::{Fault, Stop};
use crate::engine::RequestTime;
use crate::engine::cost::Cost;
use crate::engine::plan::{Plan, Step};
use crate::engine::taint::Taint;
use crate::engine::{CoreId, State};
use crate::extension::Units;
use crate::profile::{CallMeter, CallStack, Profiler};
use crate::semantics::{Motion, Numbers, Watch};

/// Steps that generated code may take beyond a limit before it looks: two kinds of them, each as much as there is room for in the sums.
const AHEAD: u64 = 4 * Cost::WHOLE as u64;

/// Steps of a run before its sums were emptied; the context has its clocks and elementary operations.
#[derive(Clone, Copy, Debug)]
struct Totals {
    steps: u64,
    inner_steps: u64,
}

/// The machine as functions see it that generated code calls.
pub(super) struct NativeHost<'a> {
    plan: &'a Plan<'a>,
    pub buffer: *mut Buffer,
    pub units: *mut Units,
    pub link: &'a mut dyn TimedLink,
    pub numbers: Numbers<'a>,
    /// Takes what results have lost, where that is counted.
    take_losses: Option<&'a dyn Fn() -> Losses>,
    totals: Totals,
    counters: &'a mut Counters,
    unit_exits: &'a UnitExits,
    sites: &'a [u32],
    layout: CounterLayout,
    reads_inline: bool,
    fault: Option<Fault>,
    /// Payload of a panic of an instruction with a meaning in Rust.
    panic: Option<Box<dyn Any + Send>>,
    /// The profiler, where functions are measured.
    profiler: Option<&'a mut Profiler>,
    /// The link has no room for what it was told of.
    is_full: bool,
}

impl<'a> NativeHost<'a> {
    /// The host of a run.
    ///
    /// # Safety
    /// The context is that of a run, and nobody else holds its host.
    pub unsafe fn of<'h>(context: &mut Context) -> &'h mut NativeHost<'a> {
        // SAFETY: it was put there by `run`, which waits for generated code.
        unsafe { &mut *context.host.cast() }
    }

    /// Tells the link of everything before a step that asks for something.
    pub fn ask(&mut self, context: &mut Context, step: &Step) {
        self.hand_over(context);
        let clocks = context.total_clocks + Cost(context.sums).clocks();
        self.link.note(RequestTime { pc: step.slot, context: context.current, clocks });
    }

    /// Hands over the reads that were noted.
    fn hand_over(&mut self, context: &mut Context) {
        if !self.reads_inline || context.noted == 0 {
            return;
        }
        let reads = &context.reads[..context.noted as usize / size_of::<NotedRead>()];
        let before = context.total_clocks.wrapping_add_signed(context.before);
        if let Some(quick) = self.link.quick() {
            self.is_full |= !quick.keep(reads, before);
        }
        context.noted = 0;
    }

    /// A step was answered; where it was a read, its site learns where that was.
    pub fn answered(&mut self, context: &mut Context, step: &Step, address: u32) {
        if !self.reads_inline {
            return;
        }
        let place = self.plan.place_of(step.slot) as usize;
        let Some(quick) = self.link.quick() else { return };
        context.before = quick.before().wrapping_sub(context.total_clocks) as i64;
        context.noted_end = end_of_notes(context.before);
        let site = self.sites.get(place).filter(|&&site| site != NO_SITE);
        let (Some(&site), Some(size)) = (site, quick.memory().map(<[u8]>::len)) else {
            return;
        };
        let octets = octets(self.plan, step);
        let (start, length, kind) = quick.kind(address);
        // As far as a read from there lies in memory.
        let end = (u64::from(start) + u64::from(length)).min((size as u64 + 1).saturating_sub(octets));
        let length = end.saturating_sub(start.into()) as u32;
        // SAFETY: the site lies in the frame of which the context is the beginning.
        let known = unsafe {
            let at = std::ptr::from_mut(context).cast::<u8>().add(self.layout.site(site) as usize).cast::<u64>();
            std::slice::from_raw_parts_mut(at, 2)
        };
        let old = &mut self.counters.kinds[site as usize];
        if known[1] != 0 {
            quick.add(*old, known[1] * octets);
        }
        (*old, known[0], known[1]) = (kind, u64::from(start) | u64::from(length) << 32, 0);
    }

    /// The status with which to leave.
    pub fn stop(&mut self, stop: Stop) -> u64 {
        match stop {
            Stop::Wait => Status::Wait as u64,
            Stop::Fault(fault) => {
                self.fault = Some(fault);
                Status::Fault as u64
            }
        }
    }

    /// The status with which to leave after a panic, which goes on where generated code has returned.
    pub fn panicked(&mut self, panic: Box<dyn Any + Send>) -> u64 {
        self.panic = Some(panic);
        Status::Bailout as u64
    }

    /// The meter of each call, where there is one.
    fn meter(&mut self) -> Option<&mut CallMeter> {
        self.profiler.as_mut()?.meter.as_deref_mut()
    }

    /// Hands what was added up by class to who measures each call.
    fn add_classes(&mut self, context: &mut Context) {
        if let Some(meter) = self.meter() {
            meter.add(&std::mem::take(&mut context.classes));
        }
    }

    /// Tells who measures each call that control goes from one slot to another one.
    pub fn went(&mut self, context: &mut Context, from: u32, to: u32, motion: Motion) {
        self.add_classes(context);
        if let Some(meter) = self.meter() {
            meter.go(from, to, motion);
        }
    }

    /// Gives the clocks since that was done last to the current calling context at a slot, where clocks are measured.
    fn spend(&mut self, context: &mut Context, slot: u32) {
        let now = Cost(context.sums).clocks() as i64;
        let clocks = (now - context.since) as u64;
        context.since = now;
        if clocks != 0
            && let Some(profiler) = &mut self.profiler
        {
            profiler.contexts.spend(context.current, slot, clocks);
        }
    }

    /// Follows control from one slot to another one, into another calling context.
    pub fn follow(&mut self, context: &mut Context, from: u32, to: u32, motion: Motion) {
        self.spend(context, from);
        self.take_calls(context);
        if let Some(profiler) = &mut self.profiler {
            profiler.contexts.go(from, to, motion);
        }
        self.give_calls(context);
    }

    /// The calling context of what a slot calls; 0 where it has none.
    pub fn callee(&mut self, context: &mut Context, slot: u32, caller: usize) -> u32 {
        self.take_calls(context);
        let current = context.current;
        let callee = self.profiler.as_mut().and_then(|profiler| profiler.contexts.callee(slot)).unwrap_or(0);
        if callee != 0 {
            context.nodes = self.counters.frame.nodes(callee.max(current));
            self.give_cells(context);
            self.counters.frame.set_callee(current, caller, callee);
        }
        callee
    }

    /// Takes the open calls over from generated code.
    fn take_calls(&mut self, context: &Context) {
        if let Some(profiler) = &mut self.profiler {
            let stack = profiler.contexts.stack();
            profiler.contexts.set_stack(CallStack { top: context.calls, current: context.current, ..stack });
        }
    }

    /// Gives the open calls to generated code, with counters for their context.
    fn give_calls(&mut self, context: &mut Context) {
        if let Some(profiler) = &mut self.profiler {
            let CallStack { top, end, current, .. } = profiler.contexts.stack();
            (context.calls, context.calls_end, context.current) = (top, end, current);
            context.nodes = self.counters.frame.nodes(current);
        }
        self.give_cells(context);
    }

    /// Gives the cells of clocks to generated code, which move when there are more of them.
    fn give_cells(&mut self, context: &mut Context) {
        let cells = self.profiler.as_mut().and_then(|profiler| profiler.contexts.cells.as_mut());
        (context.cells, context.own_cells) = cells.map_or((std::ptr::null_mut(), std::ptr::null_mut()), |cells| {
            (cells.first(), cells.first_of(context.current))
        });
    }

    /// Changes the count of runs that were begun at a place in the current calling context.
    fn count_begun(&mut self, context: &Context, place: u32, more: i64) {
        let begun = &mut self.counters.frame.node(context.current).begun[place as usize];
        *begun = begun.wrapping_add_signed(more);
    }

    /// A pass through an exit of the plan had units.
    pub fn add_units(&mut self, context: &mut Context, exit: usize, units: u32) {
        let (number, pass) = (self.unit_exits.number(exit), self.plan.pass(exit));
        let (clocks, elementary) = match self.unit_exits.turns(number) {
            Some(turns) => turns.cost(units),
            None => pass.map_or((Clocks(0), 0), |pass| self.plan.code.uneven_unit_cost(pass, units)),
        };
        // SAFETY: the context is that of a run with this layout, and the number is one of its exits'.
        let [all, all_clocks] = unsafe { self.layout.unit_counter(context, number) };
        *all += u64::from(units);
        *all_clocks += clocks.0;
        context.total_elementary += elementary;
        self.add_clocks(context, clocks.0);
        if let (Some(pass), Some(meter)) = (pass, self.meter()) {
            meter.add_units(pass, units);
        }
    }

    /// Takes note of what results of a slot have lost, where that is counted.
    #[inline]
    pub fn note_losses(&mut self, slot: u32) {
        if let Some(take_losses) = self.take_losses
            && let Some(losses) = self.counters.losses.get_mut(slot as usize)
        {
            losses.add(take_losses());
        }
    }

    /// Adds clocks to those before the sums were last emptied.
    fn add_clocks(&mut self, context: &mut Context, clocks: u64) {
        context.total_clocks += clocks;
        context.before -= clocks as i64;
        context.since -= clocks as i64;
        if end_of_notes(context.before) == 0 {
            context.noted_end = context.noted;
        }
    }

    /// Empties the sums.
    fn empty(&mut self, context: &mut Context) {
        let cost = Cost(std::mem::take(&mut context.sums));
        self.totals.steps += cost.steps();
        self.totals.inner_steps += cost.inner_steps();
        context.total_elementary += cost.elementary();
        self.add_clocks(context, cost.clocks());
    }
}

/// Generated code might go beyond the step limit before it looks.
pub(super) fn is_near_limit(core: CoreId, steps: u64) -> bool {
    steps + AHEAD > core.step_limit
}

/// Octets that a step's read moves.
pub(super) fn octets(plan: &Plan, step: &Step) -> u64 {
    plan.code.slot_row(step.slot).map_or(0, |row| row.outcomes[0].cost[isa::Class::Octet])
}

/// Place from which notes of reads have to be handed over, in octets: at once where so many clocks have gone by that they may not fit a note.
fn end_of_notes(before: i64) -> u64 {
    if before < -(1 << 31) { 0 } else { (NOTED * size_of::<NotedRead>()) as u64 }
}

impl Native<'_> {
    /// Runs until the program halts, waits or comes to something unusual. `taint` is what is known of the cores; it is followed where the
    /// recipe says so.
    ///
    /// Clocks up to a read, where the last transfer was at 970. [`Context::before`] counts from where the sums are 0, so it moves with them:
    ///
    /// | moment | `total_clocks` | `sums` | `before` |
    /// | --- | --- | --- | --- |
    /// | code is entered at 1,000 | 1,000 | 0 | 970 - 1,000 = -30 |
    /// | it leaves with 250 clocks in its sums | 1,000 | 250 | -30 |
    /// | the sums are emptied, and it is entered again | 1,250 | 0 | -280 |
    /// | a read 20 clocks later | 1,250 | 20 | -280 |
    ///
    /// The read is noted 20 + 280 = 300 clocks after the transfer, at 1,270.
    pub(super) fn run_code<T: Watch>(
        &mut self,
        core: CoreId,
        state: &mut State,
        arithmetic: &T,
        link: &mut dyn TimedLink,
        taint: &mut Taint,
        profiler: Option<&mut Profiler>,
    ) -> Stopped {
        let Native { plan, shared, patience, counters, .. } = self;
        let plan = &*plan;
        let Some(code) = shared.code(plan, *patience) else { return Stopped::Bailout };
        // Refuse places without an entry, a state near the step limit, and a profile that is not plain
        let is_inside = (state.pc as usize) < plan.slots().len();
        let mut place = plan.place_of(state.pc);
        let is_plain = |profiler: &Profiler| profiler.contexts.is_plain();
        let is_near_limit = |steps: u64| is_near_limit(core, steps);
        if !is_inside || !code.is_join[place as usize] || is_near_limit(state.steps + state.inner_steps) {
            return Stopped::Bailout;
        }
        let profiler = profiler.filter(|_| code.profiling.is_some());
        if !profiler.as_deref().is_none_or(is_plain) {
            return Stopped::Bailout;
        }
        // Lend the state to the functions that generated code calls
        let new = || Counters::new(code.layout, plan, code.site_places.len(), code.profiling.is_some());
        let counters = counters.get_or_insert_with(new);
        let State { steps, inner_steps, clocks, elementary, .. } = *state;
        let (buffer_octets, before) =
            (state.buffer.start_mut(), link.quick().map(|quick| (quick.before(), quick.memory().map(<[u8]>::as_ptr))));
        let context = counters.frame.context();
        let take_losses = || arithmetic.take_losses();
        let mut host = NativeHost {
            plan,
            buffer: &raw mut state.buffer,
            units: &raw mut state.units,
            link,
            numbers: arithmetic.numbers(),
            take_losses: shared.recipe.computes.counts_losses.then_some(&take_losses),
            totals: Totals { steps, inner_steps },
            unit_exits: &code.unit_exits,
            counters,
            sites: &code.sites,
            layout: code.layout,
            reads_inline: !shared.recipe.is_stepped(),
            fault: None,
            panic: None,
            profiler,
            is_full: false,
        };
        // Fill in the context, with empty sums
        {
            // SAFETY: the frame has a context at its beginning, and nobody else looks at it.
            let context = unsafe { &mut *context };
            (context.sums, context.classes) = (0, Lanes::default());
            (context.total_clocks, context.total_elementary) = (clocks, elementary);
            (context.core, context.cores) = (core.core as i32, core.cores as i32);
            context.tainted = taint.tainted;
            (context.depends_on_cores, context.depends_on_core) = (0, 0);
            (context.buffer, context.written) = (buffer_octets, 0);
            let (before, memory) = before.unwrap_or((0, None));
            context.memory = memory.unwrap_or(std::ptr::null());
            context.before = before.wrapping_sub(clocks) as i64;
            (context.noted, context.noted_end) = (0, end_of_notes(context.before));
            context.since = 0;
            context.arithmetic = std::ptr::from_ref(arithmetic).cast();
            host.give_calls(context);
            context.host = (&raw mut host).cast();
        }
        // Run; go on where only the sums were full, or where control went to a word that a register held
        let registers = &raw mut state.registers;
        let mut is_begun = true;
        let stopped = loop {
            if std::mem::take(&mut is_begun) {
                // SAFETY: the frame has a context at its beginning, and no generated code runs now.
                host.count_begun(unsafe { &*context }, place, 1);
            }
            // SAFETY: the code was generated for this plan and this layout; context, registers, buffer and memory live until it returns, and
            // the place is one at which it can be entered. The safe twin is `crate::engine::interpreter::run`.
            let status = Status::of(unsafe { (code.function)(context, registers, place) });
            // Take over what it has added up, and the place at which it stopped
            // SAFETY: as above, and the code has returned.
            let context = unsafe { &mut *context };
            if let Some(panic) = host.panic.take() {
                resume_unwind(panic);
            }
            // What a register leads to was told before it was left for, so no clocks are left there.
            host.spend(context, plan.steps().get(context.place as usize).map_or(0, |step| step.slot));
            host.empty(context);
            host.add_classes(context);
            host.take_calls(context);
            let found = context.place;
            place = found;
            let is_near_limit = is_near_limit(host.totals.steps + host.totals.inner_steps);
            match status {
                Status::Halt => break Stopped::Halt,
                Status::Full if !is_near_limit && !host.is_full => continue,
                Status::Elsewhere => {
                    place = plan.place_of(found);
                    is_begun = true;
                    let is_plain = host.profiler.as_deref().is_none_or(is_plain);
                    if !is_near_limit && is_plain && code.is_join[place as usize] {
                        continue;
                    }
                    // Neither was it begun, nor was it cut.
                    break Stopped::Bailout;
                }
                _ => {}
            }
            // Take back the rest of the run: one that was begun at 0 and stops in front of 3 counts 1 at 0 and -1 at 3, so nothing comes to 3
            host.count_begun(context, place, -1);
            let classes = code.profiling.as_ref().and_then(|profiling| profiling.classes.as_ref());
            if status != Status::Full
                && let (Some(classes), Some(meter)) = (classes, host.meter())
            {
                // The rest of the block was added and is not executed. Full sums are found before a block is added.
                meter.take_back(&classes.span(place, code.ends[place as usize]));
            }
            break match status {
                Status::Wait => Stopped::Wait,
                Status::Fault => Stopped::Fault(host.fault.take().expect("what went wrong is known")),
                _ => Stopped::Bailout,
            };
        };
        // Hand over the last reads, and put everything back into the state
        // SAFETY: the code has returned.
        let context = unsafe { &mut *context };
        host.hand_over(context);
        let Totals { steps, inner_steps } = host.totals;
        (state.steps, state.inner_steps) = (steps, inner_steps);
        (state.clocks, state.elementary) = (context.total_clocks, context.total_elementary);
        state.pc = plan.steps()[place as usize].slot;
        taint.tainted = context.tainted;
        taint.depends_on_cores |= context.depends_on_cores != 0;
        taint.depends_on_core |= context.depends_on_core != 0;
        let written = context.written;
        state.buffer.note_pieces(written);
        stopped
    }
}
