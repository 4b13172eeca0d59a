//! Memory that generated code works on beside registers and buffer: sums and places of reads at fixed offsets from one pointer, and counters in
//! nodes, of which there is one a calling context where functions are measured, else one.

use std::mem::offset_of;

use super::NotedRead;
use super::classes::Lanes;

/// Reads that are noted before the link is told of them.
pub(super) const NOTED: usize = 512;

/// State that generated code and the functions that it calls share during a run.
#[repr(C)]
pub(super) struct Context {
    /// Steps, inner steps, clocks and elementary operations since they were last emptied, packed as [`crate::engine::cost::Cost`].
    pub sums: u64,
    /// Clocks before the sums were last emptied, and those of units.
    pub total_clocks: u64,
    /// Elementary operations before the sums were last emptied, and those of units.
    pub total_elementary: u64,
    /// The place at which generated code stopped.
    pub place: u32,
    /// Number of this core.
    pub core: i32,
    /// Number of cores.
    pub cores: i32,
    /// The current calling context, where functions are measured: a number of [`crate::profile::Contexts`].
    pub current: u32,
    /// Scalars that hold the number of cores, a bit each.
    pub tainted: u64,
    /// Not 0 where the item may depend on the number of cores.
    pub depends_on_cores: u64,
    /// Not 0 where the item has asked for its core's number.
    pub depends_on_core: u64,
    /// The local buffer.
    pub buffer: *mut u8,
    /// Pieces of the buffer that were written, a bit each.
    pub written: u64,
    /// Global memory, where reads may be done inline.
    pub memory: *const u8,
    /// The next free place of [`Context::reads`], in octets.
    pub noted: u64,
    /// The place in [`Context::reads`] at which the link has to be told, in octets.
    pub noted_end: u64,
    /// Clocks at the last transfer, counted as [`Context::sums`] counts them; below 0 for one before the sums were last emptied.
    pub before: i64,
    /// Clocks at which the current calling context began to be counted, as [`Context::before`] counts them, where clocks are measured.
    pub since: i64,
    /// The cells of clocks by calling context, where clocks are measured: see `Contexts::cell`.
    pub cells: *mut u64,
    /// The cells of clocks of the current calling context.
    pub own_cells: *mut u64,
    /// Address of the arithmetic that functions compute with.
    pub arithmetic: *const (),
    /// The rest of the machine: see [`super::run::NativeHost`].
    pub host: *mut (),
    /// The nodes by calling context, where functions are measured.
    pub nodes: *mut u64,
    /// The place behind the newest call, where functions are measured.
    pub calls: *mut u64,
    /// The place at which there is no room for another call.
    pub calls_end: *mut u64,
    /// Operations by class since they were last emptied, where each call is measured.
    pub classes: Lanes,
    /// Reads of global memory that the link was not told of.
    pub reads: [NotedRead; NOTED],
}

macro_rules! offsets {
    ($($name:ident $field:ident)*) => {
        $(pub(super) const $name: i32 = offset_of!(Context, $field) as i32;)*
    };
}

offsets! {
    SUMS sums
    TOTAL_CLOCKS total_clocks
    TOTAL_ELEMENTARY total_elementary
    PLACE place
    CORE core
    CORES cores
    CURRENT current
    TAINTED tainted
    DEPENDS_ON_CORES depends_on_cores
    DEPENDS_ON_CORE depends_on_core
    BUFFER buffer
    WRITTEN written
    MEMORY memory
    NOTED_AT noted
    NOTED_END noted_end
    BEFORE before
    SINCE since
    CELLS cells
    OWN_CELLS own_cells
    NODES nodes
    CALLS calls
    CALLS_END calls_end
    CLASSES classes
    READS reads
}

/// Places of counters, in octets: those of reads from the beginning of the context, the others from that of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CounterLayout {
    /// Memory of reads, where they found their kind the last time: start and length of 32 bits each, and how often, a read.
    sites: i32,
    /// The context with all of that, and the end of it, where the only node begins if functions are not measured.
    pub frame: i32,
    /// Counts of exits that were taken: a number of 64 bits an exit.
    begun: i32,
    /// Behind the counts of runs that were begun and that no exit leads to whose target is known, one a place: how often regions were entered by
    /// ways that no other count tells.
    entered: i32,
    /// Units of exits that may have them, and clocks of those: two numbers of 64 bits a number of [`super::units::UnitExits`].
    units: i32,
    /// The contexts of callees by innermost region of the caller, 32 bits each; 0 where it is not known.
    callees: i32,
    /// All of a node.
    pub node: i32,
}

impl CounterLayout {
    /// The layout for so many exits, those of them with units, places, regions and reads; `None` for a program so large that offsets do not fit 31 bits.
    pub fn new([exits, units]: [usize; 2], places: usize, regions: usize, sites: usize) -> Option<CounterLayout> {
        let fit = |octets: usize| i32::try_from(octets).ok();
        let site = size_of::<Context>().next_multiple_of(8);
        let frame = site.checked_add(sites.checked_mul(16)?)?;
        let begun = exits.checked_mul(8)?;
        let entered = begun.checked_add(places.checked_mul(8)?)?;
        let unit_counters = entered.checked_add(regions.checked_mul(8)?)?;
        let callees = unit_counters.checked_add(units.checked_mul(16)?)?;
        let node = callees.checked_add(regions.checked_add(1)?.checked_mul(4)?)?.checked_next_multiple_of(64)?;
        // Nodes are counted in 32 bits, and the frame has one behind it.
        fit(frame.checked_add(node)?)?;
        Some(CounterLayout {
            sites: fit(site)?,
            frame: fit(frame)?,
            begun: fit(begun)?,
            entered: fit(entered)?,
            units: fit(unit_counters)?,
            callees: fit(callees)?,
            node: fit(node)?,
        })
    }

    /// Counter of an exit, from the beginning of a node.
    pub fn exit(&self, exit: usize) -> i32 {
        8 * exit as i32
    }

    /// Counter of a place, from the beginning of a node.
    pub fn begun(&self, place: u32) -> i32 {
        self.begun + 8 * place as i32
    }

    /// Counter of a region, from the beginning of a node.
    pub fn entered(&self, region: u16) -> i32 {
        self.entered + 8 * i32::from(region)
    }

    /// Counter of the units of an exit by its number among those that may have them, from the beginning of a node; the one of their clocks is behind it.
    pub fn unit(&self, number: usize) -> i32 {
        self.units + 16 * number as i32
    }

    /// The counter of a number's units in the current calling context.
    ///
    /// # Safety
    /// The context is that of a run with this layout, which has the number.
    pub unsafe fn unit_counter<'a>(&self, context: &mut Context, number: usize) -> &'a mut [u64; 2] {
        // SAFETY: nodes stand behind the context, or where it says, one a calling context up to the current one. Nobody else looks at them while
        // generated code waits. `ContextFrame::node` is the safe twin.
        unsafe {
            let node = match context.nodes.is_null() {
                true => std::ptr::from_mut(context).cast::<u8>().add(self.frame as usize),
                false => context.nodes.cast::<u8>().add(context.current as usize * self.node as usize),
            };
            &mut *node.add(self.unit(number) as usize).cast()
        }
    }

    /// Context of callees, from the beginning of a node.
    pub fn callee(&self, caller: usize) -> i32 {
        self.callees + 4 * caller as i32
    }

    /// A read's place, from the beginning of the context.
    pub fn site(&self, site: u32) -> i32 {
        self.sites + 16 * site as i32
    }
}

/// Memory as a layout says.
#[derive(Clone, Debug)]
pub(super) struct ContextFrame {
    /// The context with what stands behind it.
    octets: Box<[u64]>,
    /// Nodes by calling context, where functions are measured. The first belongs to no context.
    nodes: Option<Vec<u64>>,
    layout: CounterLayout,
}

/// Counters of a node.
pub(super) struct ContextCounters<'a> {
    pub exits: &'a mut [u64],
    pub begun: &'a mut [u64],
    pub entered: &'a mut [u64],
    /// Units and their clocks, by number.
    pub units: &'a mut [[u64; 2]],
}

impl ContextFrame {
    /// All zero; with a node a calling context or with one.
    pub fn new(layout: CounterLayout, has_contexts: bool) -> ContextFrame {
        const { assert!(align_of::<Context>() == 8) };
        let octets = layout.frame + if has_contexts { 0 } else { layout.node };
        let octets = vec![0; octets as usize / 8 + 1].into();
        ContextFrame { octets, nodes: has_contexts.then(Vec::new), layout }
    }

    /// The context, from which generated code reaches the counters as well.
    pub fn context(&mut self) -> *mut Context {
        self.octets.as_mut_ptr().cast()
    }

    /// The nodes, with room for one of a calling context.
    pub fn nodes(&mut self, context: u32) -> *mut u64 {
        let words = self.layout.node as usize / 8;
        let Some(nodes) = &mut self.nodes else { return std::ptr::null_mut() };
        let wanted = words * (context as usize + 1);
        if nodes.len() < wanted {
            nodes.resize(wanted, 0);
        }
        nodes.as_mut_ptr()
    }

    /// Number of nodes, from which on there are none.
    pub fn count(&self) -> u32 {
        self.nodes.as_ref().map_or(1, |nodes| (nodes.len() / (self.layout.node as usize / 8)) as u32)
    }

    /// The words of a node.
    fn node_words(&mut self, context: u32) -> &mut [u64] {
        let words = self.layout.node as usize / 8;
        match &mut self.nodes {
            Some(nodes) => &mut nodes[words * context as usize..][..words],
            None => &mut self.octets[self.layout.frame as usize / 8..][..words],
        }
    }

    /// Counters of a node.
    pub fn node(&mut self, context: u32) -> ContextCounters<'_> {
        let CounterLayout { begun, entered, units, callees, .. } = self.layout;
        let (exits, rest) = self.node_words(context).split_at_mut(begun as usize / 8);
        let (begun, rest) = rest.split_at_mut((entered - begun) as usize / 8);
        let (entered, rest) = rest.split_at_mut((units - entered) as usize / 8);
        let (units, _) = rest[..(callees - units) as usize / 8].as_chunks_mut();
        ContextCounters { exits, begun, entered, units }
    }

    /// Notes the context of calls of a context.
    pub fn set_callee(&mut self, context: u32, caller: usize, callee: u32) {
        let at = self.layout.callee(caller) as usize;
        // Two of them share a word.
        let word = &mut self.node_words(context)[at / 8];
        let shift = 8 * (at % 8);
        *word = *word & !(u64::from(u32::MAX) << shift) | u64::from(callee) << shift;
    }

    /// A read's place: start and length, and how often.
    pub fn site(&mut self, site: usize) -> &mut [u64] {
        let start = (self.layout.sites as usize + 16 * site) / 8;
        &mut self.octets[start..start + 2]
    }
}
