//! Functions of the cores over time: which were open when, in clocks of the machine. Each work item runs once more on a lone core, which tells what it
//! called and what it asked the bus for, and that is laid over the clocks in which the machine's core computed and waited.

use emu::machine::trace::{Cargo, Doing, Trace, TracedBurst};
use emu::machine::{Config, Item};
use emu::quantity::Clocks;
use emu::registers::Registers;
use emu::stepper::{Lone, Stepper, Transfer, TransferKind};
use isa::Program;
use messages::Report;
use rayon::prelude::*;

use super::TracedScene;
use super::open::{FunctionStack, ItemPlace, OpenFunction, functions_around};
use crate::load::Load;

/// A function that was open for a time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FunctionSlice {
    /// Core that was in it.
    pub core: u32,
    /// Name of the function.
    pub name: String,
    /// Functions that were open around it.
    pub depth: usize,
    /// First clock.
    pub start: Clocks,
    /// Clock behind the last one.
    pub end: Clocks,
}

/// Octets in front of an address at which a line of a cache that holds it may begin.
const LINE: u32 = 4096;

/// Functions of the work items that lie in the window of a scene, the outer before the inner: of items that a lone core runs as the machine's core did.
/// A function that takes no clock is left out. `trace` is one of the same frame that has these items whole.
///
/// # Errors
/// A machine out of its ranges.
pub fn functions(scene: &TracedScene, trace: &Trace, config: &Config) -> Result<Vec<FunctionSlice>, Report> {
    let items: Vec<&Item> = scene.items().collect();
    let of_items: Vec<Vec<FunctionSlice>> =
        items.par_iter().map(|item| of_item(trace, scene.load, config, item)).collect::<Result<_, Report>>()?;
    let window = scene.trace.window;
    let mut slices = of_items.concat();
    slices.retain(|slice| slice.end > window.start && slice.start < window.end);
    slices.sort_by_key(|slice| (slice.core, slice.start, std::cmp::Reverse(slice.end), slice.depth));
    Ok(slices)
}

/// A work item as a lone core runs it.
#[derive(Clone, Debug, Default)]
struct LoneItem {
    functions: Vec<OpenFunction>,
    /// Transfers with the clocks of computing before each.
    transfers: Vec<(u64, Transfer)>,
    busy: u64,
    instructions: u64,
}

/// Functions of one item.
fn of_item(trace: &Trace, load: &Load, config: &Config, item: &Item) -> Result<Vec<FunctionSlice>, Report> {
    let Some(message) = item.message.as_deref() else { return Ok(Vec::new()) };
    let lone = Lone {
        config,
        isa: &load.isa,
        program: &load.build.cores,
        registers: Registers::default(),
        memory: load.memory.clone(),
        message: Some(*message),
        step_limit: config.step_limit,
    };
    let program = &load.build.cores;
    let run = run_alone(Stepper::new(lone)?, program);
    let course = ItemCourse::new(trace, item, &run.transfers);
    // A program that asks which core it is, or reads what others write, may do something else alone.
    if run.instructions != item.instructions || course.busy() != run.busy {
        return Ok(Vec::new());
    }
    let slice = |function: OpenFunction| FunctionSlice {
        core: item.core,
        name: function
            .function
            .map_or("(no function)", |function| &program.regions[usize::from(function)].name)
            .to_owned(),
        depth: function.depth,
        start: course.clock(function.start),
        end: course.clock(function.end),
    };
    Ok(run.functions.into_iter().map(slice).filter(|slice| slice.start < slice.end).collect())
}

/// Runs an item from its message on, and notes when functions begin and end.
fn run_alone(mut stepper: Stepper, program: &Program) -> LoneItem {
    let mut run = LoneItem::default();
    let mut functions = FunctionStack::default();
    // What comes before the message lies before the item.
    let mut before_message = Some(Clocks(0));
    loop {
        let pc = stepper.code.word(stepper.state().pc);
        if before_message.is_none() {
            functions.go(&functions_around(program, pc), stepper.calls().len(), run.place(&stepper));
        }
        let busy = stepper.busy();
        let Some(executed) = stepper.step() else { break };
        match executed.transfer {
            Some(Transfer { kind: TransferKind::Receive, .. }) if before_message.is_some() => {
                run.busy = busy.0;
                before_message = None;
            }
            Some(Transfer { kind: TransferKind::Receive, .. }) | None => {}
            Some(transfer) => run.transfers.push((busy.0 - run.busy, transfer)),
        }
    }
    let place = run.place(&stepper);
    run.functions = functions.end(place);
    (run.busy, run.instructions) = (place.busy, stepper.steps());
    run
}

impl LoneItem {
    /// The place where a core is; `busy` is what it computed before its message, while it runs.
    fn place(&self, stepper: &Stepper) -> ItemPlace {
        ItemPlace { busy: stepper.busy().0 - self.busy, transfers: self.transfers.len() }
    }
}

/// Clocks of a core during a work item.
struct ItemCourse<'a> {
    item: &'a Item,
    /// Times of computing: clocks of it before, first clock, clock behind the last.
    computing: Vec<(u64, Clocks, Clocks)>,
    /// Clocks of computing before each transfer, and the clock at which it had come.
    arrivals: Vec<(u64, Clocks)>,
}

impl<'a> ItemCourse<'a> {
    fn new(trace: &Trace, item: &'a Item, transfers: &[(u64, Transfer)]) -> ItemCourse<'a> {
        let spans = &trace.processors[item.core as usize];
        let first = spans.partition_point(|span| span.end <= item.start);
        let spans = spans[first..].iter().take_while(|span| span.start < item.end);
        let (mut computing, mut before) = (Vec::new(), 0);
        for span in spans.filter(|span| span.doing == Doing::Busy) {
            let (start, end) = (span.start.max(item.start), span.end.min(item.end));
            computing.push((before, start, end));
            before += (end - start).0;
        }
        let mut course = ItemCourse { item, computing, arrivals: Vec::new() };
        // A transfer has come when the last of its bursts is over; several may lie at one clock of computing, one behind the other.
        let first = trace.bursts.partition_point(|burst| burst.start < item.start);
        let bursts = trace.bursts[first..].iter().take_while(|burst| burst.start < item.end);
        let mut bursts = bursts.filter(|burst| burst.master == item.core).peekable();
        for (busy, transfer) in transfers {
            let (first, last) = course.around(*busy);
            let mut arrival = course.arrivals.last().map_or(first, |&(_, before)| before.max(first));
            while let Some(burst) = bursts.next_if(|burst| burst.start < last && belongs(burst, transfer)) {
                arrival = arrival.max(burst.end.min(last));
            }
            course.arrivals.push((*busy, arrival));
        }
        course
    }

    /// Clocks of computing.
    fn busy(&self) -> u64 {
        self.computing.last().map_or(0, |&(before, start, end)| before + (end - start).0)
    }

    /// First and last clock at which so many clocks have been computed: between them the core waits.
    ///
    /// A core that computes in the clocks 10 to 13 and 20 to 22 of an item that ends at 30 has computed 3 clocks from 13 to 20, 4 at 21 alone, and 5
    /// from 22 to 30.
    fn around(&self, busy: u64) -> (Clocks, Clocks) {
        let at = self.computing.partition_point(|&(before, start, end)| before + (end - start).0 < busy);
        let starts = |at: usize| self.computing.get(at).map_or(self.item.end, |&(_, start, _)| start);
        match self.computing.get(at) {
            _ if busy == 0 => (self.item.start, starts(0)),
            None => (self.item.end, self.item.end),
            Some(&(before, start, end)) if before + (end - start).0 == busy => (end, starts(at + 1)),
            Some(&(before, start, _)) => (start + Clocks(busy - before), start + Clocks(busy - before)),
        }
    }

    /// The machine's clock at a place: behind the transfers that were asked for before it, and before those that come after it.
    fn clock(&self, place: ItemPlace) -> Clocks {
        let (first, last) = self.around(place.busy);
        let arrived = place.transfers.checked_sub(1).and_then(|at| self.arrivals.get(at));
        let is_last = self.arrivals.get(place.transfers).is_none_or(|&(busy, _)| busy > place.busy);
        match arrived {
            // Of the transfers at this clock, some are still to come.
            Some(&(busy, arrival)) if busy == place.busy && !is_last => arrival.clamp(first, last),
            Some(&(busy, _)) if busy == place.busy => last,
            _ => first,
        }
    }
}

/// The burst moves octets of a transfer.
fn belongs(burst: &TracedBurst, transfer: &Transfer) -> bool {
    let is_read = matches!(transfer.kind, TransferKind::Load | TransferKind::Read);
    match burst.cargo {
        Cargo::Message(_) => transfer.kind == TransferKind::Send,
        Cargo::Read(_) if !is_read => false,
        Cargo::Write(_) if !transfer.kind.writes() => false,
        // A cache fills whole lines around what was asked for.
        Cargo::Read(address) | Cargo::Write(address) => {
            let end = transfer.address.saturating_add(transfer.octets).saturating_add(LINE);
            (transfer.address.saturating_sub(LINE)..end).contains(&address)
        }
    }
}
