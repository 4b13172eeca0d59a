//! Memory that generated code works on beside registers and buffer: sums, counters of edges, places of reads, all at fixed offsets from one
//! pointer.

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
    /// The place at which generated code stopped.
    pub place: u32,
    /// Number of this core.
    pub core: i32,
    /// Number of cores.
    pub cores: i32,
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
    /// Address of the arithmetic that functions compute with.
    pub arithmetic: *const (),
    /// The rest of the machine: see [`super::run::NativeHost`].
    pub host: *mut (),
    /// Operations by class since they were last emptied, where functions are measured.
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
    PLACE place
    CORE core
    CORES cores
    TAINTED tainted
    DEPENDS_ON_CORES depends_on_cores
    DEPENDS_ON_CORE depends_on_core
    BUFFER buffer
    WRITTEN written
    MEMORY memory
    NOTED_AT noted
    NOTED_END noted_end
    BEFORE before
    CLASSES classes
    READS reads
}

/// Place of the counters behind the context, in octets from its beginning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CounterLayout {
    /// Counts of exits that were taken: a number of 64 bits an exit.
    pub exits: i32,
    /// Counts of runs that were begun and that no exit leads to whose target is known: one a place.
    pub begun: i32,
    /// Memory of reads, where they found their kind the last time: start and length of 32 bits each, and how often, a read.
    pub sites: i32,
    /// All of it.
    pub octets: i32,
}

impl CounterLayout {
    /// The layout for so many exits, places and reads; `None` for a program so large that offsets do not fit 31 bits.
    pub fn new(exits: usize, places: usize, sites: usize) -> Option<CounterLayout> {
        let start = size_of::<Context>().next_multiple_of(8);
        let begun = start.checked_add(exits.checked_mul(8)?)?;
        let site = begun.checked_add(places.checked_mul(8)?)?;
        let end = site.checked_add(sites.checked_mul(16)?)?;
        let fit = |octets: usize| i32::try_from(octets).ok();
        Some(CounterLayout { exits: fit(start)?, begun: fit(begun)?, sites: fit(site)?, octets: fit(end)? })
    }

    /// Counter of an exit, an offset in octets.
    pub fn exit(&self, exit: usize) -> i32 {
        self.exits + 8 * exit as i32
    }

    /// Counter of a place, an offset in octets.
    pub fn begun(&self, place: u32) -> i32 {
        self.begun + 8 * place as i32
    }

    /// A read's place, an offset in octets.
    pub fn site(&self, site: u32) -> i32 {
        self.sites + 16 * site as i32
    }
}

/// Memory with a context in front and counters behind, as a layout says.
#[derive(Clone, Debug)]
pub(super) struct ContextFrame {
    octets: Box<[u64]>,
    layout: CounterLayout,
}

impl ContextFrame {
    /// All zero.
    pub fn new(layout: CounterLayout) -> ContextFrame {
        const { assert!(align_of::<Context>() == 8) };
        ContextFrame { octets: vec![0; layout.octets as usize / 8].into(), layout }
    }

    /// The context, from which generated code reaches the counters as well.
    pub fn context(&mut self) -> *mut Context {
        self.octets.as_mut_ptr().cast()
    }

    fn words(&mut self, from: i32, to: i32) -> &mut [u64] {
        &mut self.octets[from as usize / 8..to as usize / 8]
    }

    /// Counters of exits.
    pub fn exits(&mut self) -> &mut [u64] {
        self.words(self.layout.exits, self.layout.begun)
    }

    /// Counters of places.
    pub fn begun(&mut self) -> &mut [u64] {
        self.words(self.layout.begun, self.layout.sites)
    }

    /// A read's place: start and length, and how often.
    pub fn site(&mut self, site: usize) -> &mut [u64] {
        let start = self.layout.sites + 16 * site as i32;
        self.words(start, start + 16)
    }
}
