//! The frame without a fault: each work item's course, what it executes and reads, and the limits that faulty ones run into.

use std::ops::Range;
use std::sync::OnceLock;

use isa::{Isa, Program};
use messages::{Diagnostic, Report};

use super::grants::GrantRuns;
use super::item::{ItemRun, ItemRunner, ItemTask};
use super::main_link::{MainLink, MainRun, run_main};
use crate::code::Code;
use crate::code::octets::Memory;
use crate::code::tally::Tally;
use crate::code::trap::{Fault, Trap};
use crate::engine::{Pause, Task};
use crate::extension;
use crate::machine::{RunFailure, Setup, check, on_arithmetic};
use crate::profile::Observer;
use crate::semantics::{Message, Watch};

/// A work item without a fault.
pub(super) struct GoldenItem {
    /// The message that begins it.
    pub message: Message,
    /// The core that does it.
    pub core: u32,
    /// Course of the item.
    pub run: ItemRun,
    /// Words of the program that it executes, a bit each.
    words: Vec<u64>,
    /// Octets of global memory that it reads, in order and apart.
    reads: Vec<Range<u32>>,
}

impl GoldenItem {
    /// True where it executes the word.
    pub fn executes(&self, word: u32) -> bool {
        self.words.get(word as usize / 64).is_some_and(|words| words >> (word % 64) & 1 == 1)
    }

    /// True where it reads an octet of a range.
    pub fn reads(&self, range: &Range<u32>) -> bool {
        reads(&self.reads, range)
    }
}

/// True where ranges in order have an octet in common with another one.
fn reads(ranges: &[Range<u32>], range: &Range<u32>) -> bool {
    let from = ranges.partition_point(|known| known.end <= range.start);
    ranges.get(from).is_some_and(|known| known.start < range.end)
}

/// Blocks as ranges in order, of which no two touch.
fn merged(mut blocks: Vec<(u32, u32)>) -> Vec<Range<u32>> {
    blocks.sort_unstable();
    let mut ranges: Vec<Range<u32>> = Vec::new();
    for (start, octets) in blocks {
        let end = start.saturating_add(octets);
        match ranges.last_mut() {
            Some(last) if start <= last.end => last.end = last.end.max(end),
            _ => ranges.push(start..end),
        }
    }
    ranges
}

/// Work items, main processor and memory of a frame without a fault. Cores take work items in turn, and main processor and cores answer each
/// other at once, so nothing in it depends on time.
pub struct GoldenFrame<'a> {
    pub(super) setup: &'a Setup<'a>,
    pub(super) code: Code<'a>,
    pub(super) main_code: Code<'a>,
    /// Memory before the frame.
    pub(super) image: Memory,
    /// Memory behind the frame.
    pub(super) memory: Memory,
    pub(super) items: Vec<GoldenItem>,
    pub(super) main: MainRun,
    /// Octets that the main processor reads.
    main_reads: Vec<Range<u32>>,
    /// Ticks of all items before each one, and of all.
    ticks: Vec<u64>,
    /// Words on the bus of all items before each one, and of all.
    bus_words: Vec<u64>,
    /// Limits of faulty runs.
    pub(super) limits: GuestLimits,
    /// The machine without a fault, made where somebody asks for it.
    pub(super) grants: OnceLock<Result<GrantRuns, RunFailure>>,
}

/// Transfers of a frame that faults of grants are put into, at most: 512 MiB of recordings, at 16 octets each.
pub const MOST_TRANSFERS: u64 = 1 << 25;

/// Limits at which a faulty program counts as hanging, in steps of the guest: instructions, and steps of bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GuestLimits {
    /// Of a work item: four times the longest one and 1,000 more, or the machine's own limit.
    pub item: u64,
    /// Of the main processor: twice what it takes and 1,000 more, or the machine's own limit.
    pub main: u64,
    /// Work items that the main processor may hand out: twice as many and 16 more.
    pub items: usize,
}

/// Sums of a frame without a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GoldenTotals {
    /// Work items.
    pub items: u64,
    /// Instructions of the cores.
    pub steps: u64,
    /// Elementary operations of the cores.
    pub elementary: u64,
    /// Octets that the cores moved, messages among them.
    pub octets: u64,
    /// Words on the bus, addresses among them.
    pub bus_words: u64,
}

impl<'a> GoldenFrame<'a> {
    /// Runs a frame without a fault.
    ///
    /// # Errors
    /// A machine that cannot be used, a trap, and programs whose work items are not independent of each other.
    pub fn new(setup: &'a Setup<'a>, image: &Memory) -> Result<GoldenFrame<'a>, RunFailure> {
        GoldenFrame::up_to(setup, image, u64::MAX)
    }

    /// Runs a frame without a fault, whose work items have at most so many transfers, messages among them; see [`MOST_TRANSFERS`].
    ///
    /// # Errors
    /// As [`GoldenFrame::new`], and more transfers.
    pub fn up_to(setup: &'a Setup<'a>, image: &Memory, most_transfers: u64) -> Result<GoldenFrame<'a>, RunFailure> {
        check(setup)?;
        let code = Code::new(setup.core, setup.isa, setup.config.timing());
        if extension::keeps_state(&code) {
            return Err(dependent("an instruction keeps its state from one work item to the next"));
        }
        let main_code = Code::new(setup.main, setup.isa, setup.config.timing());
        on_arithmetic(setup, GoldenTask { setup, code, main_code, image: image.clone(), most_transfers })
    }

    /// Sums of the frame.
    pub fn totals(&self) -> GoldenTotals {
        let sum = |of: fn(&ItemRun) -> u64| self.items.iter().map(|item| of(&item.run)).sum();
        GoldenTotals {
            items: self.items.len() as u64,
            steps: sum(|run| run.steps),
            elementary: sum(|run| run.elementary),
            octets: sum(|run| run.traffic.octets),
            bus_words: sum(|run| run.traffic.words),
        }
    }

    /// Limits of faulty runs.
    pub fn limits(&self) -> GuestLimits {
        self.limits
    }

    /// Global memory behind the frame.
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// Global memory before the frame.
    pub fn image(&self) -> &Memory {
        &self.image
    }

    /// The program of the cores.
    pub fn program(&self) -> &'a Program {
        self.code.program
    }

    /// Number of cores.
    pub fn cores(&self) -> u32 {
        self.setup.config.cores
    }

    /// The rows of both programs.
    pub fn isa(&self) -> &'a Isa {
        self.setup.isa
    }

    /// Name of the function around a word of a core's program, or of the main processor's, whose number is that of the cores.
    pub fn function(&self, core: u32, pc: u32) -> Option<&'a str> {
        let program = if core < self.setup.config.cores { self.setup.core } else { self.setup.main };
        program.function(pc)
    }

    /// The message that begins a work item; its first vector says what the item is about.
    pub fn message(&self, item: u32) -> Option<Message> {
        Some(self.items.get(item as usize)?.message)
    }

    /// Instructions that a work item takes, steps of bodies counted.
    pub fn ticks(&self, item: u32) -> Option<u64> {
        Some(self.items.get(item as usize)?.run.ticks)
    }

    /// The item and the moment in it of a number below the ticks of all items, or below all words on the bus.
    pub(super) fn moment(&self, number: u64, is_on_bus: bool) -> (u32, u64) {
        let before = if is_on_bus { &self.bus_words } else { &self.ticks };
        let item = before.partition_point(|&before| before <= number) - 1;
        (item as u32, number - before[item])
    }

    /// Number of moments.
    pub(super) fn moments(&self, is_on_bus: bool) -> u64 {
        let before = if is_on_bus { &self.bus_words } else { &self.ticks };
        before.last().copied().unwrap_or(0)
    }

    /// True where the main processor reads an octet of a range, or has one there in the end that was not there at first.
    pub(super) fn concerns_main(&self, range: &Range<u32>) -> bool {
        let octets = range.end - range.start;
        reads(&self.main_reads, range)
            || self.image.slice(range.start, octets).ok() != self.memory.slice(range.start, octets).ok()
            || self.main.writes.iter().any(|written| written.start < range.end && range.start < written.end)
    }
}

/// A frame whose items cannot be taken one by one.
fn dependent(why: &str) -> RunFailure {
    let message = Diagnostic::error("faults cannot be put into work items one by one, since they depend on each other");
    Report::from(message.hint(why)).into()
}

/// A frame whose work items take too much memory when all of them are recorded.
fn too_long(most_transfers: u64) -> RunFailure {
    let message =
        format!("the frame has more than {most_transfers} transfers, which faults of the bus's grants need recorded");
    let hint = "draw fewer pixels, such as `--size 160x120`, or name the kinds that flip bits: `--kind registers`";
    Report::from(Diagnostic::error(message).hint(hint)).into()
}

struct GoldenTask<'a> {
    setup: &'a Setup<'a>,
    code: Code<'a>,
    main_code: Code<'a>,
    image: Memory,
    most_transfers: u64,
}

impl<'a> Task for GoldenTask<'a> {
    type Result = Result<GoldenFrame<'a>, RunFailure>;

    /// Runs the main processor, each work item when it is handed out, and adds up what limits and moments need.
    ///
    /// Three items that take 10, 30 and 20 ticks have the sums 0, 10, 40 and 60, so moment 25 of the frame is moment 15 of item 1. A faulty item
    /// counts as hanging after 4 x 30 + 1,000 = 1,120 ticks, if the machine's own limit is not less, and a faulty frame after 2 x 3 + 16 = 22 items.
    fn run<T: Watch + Clone + Send, O: Observer + Send>(self, arithmetic: &T) -> Self::Result {
        let GoldenTask { setup, code, main_code, image, most_transfers } = self;
        let config = setup.config;
        let mut runner = ItemRunner::new(&code, arithmetic, config.buffer_octets, config.cores);
        // Run each item when it is handed out, and stop at the first that goes wrong or depends on others
        let (mut items, mut failure): (Vec<GoldenItem>, Option<RunFailure>) = (Vec::new(), None);
        let (mut memory, mut transfers) = (image.clone(), 0);
        let mut item = |_: usize, core: u32, message: Message, _: &mut Memory| {
            let (mut tally, mut reads) = (Tally::new(&code), Vec::new());
            let (limit, reads_mut) = (config.step_limit, Some(&mut reads));
            let task = ItemTask { limit, reads: reads_mut, ..ItemTask::new(core, message, &image) };
            let run = runner.run(&code, &mut tally, task);
            transfers += run.traffic.transfers;
            let is_apart = run.writes.is_empty() && run.sent.iter().all(|(to, _)| *to == config.cores);
            match run.end {
                Pause::Fault(fault) => failure = Some(Trap::new(fault, core, run.pc, &code).into()),
                Pause::Wait => failure = Some(dependent("a work item waits for more than its message")),
                Pause::Halt if !is_apart => {
                    failure = Some(dependent("a work item writes to global memory, or sends to another core"));
                }
                Pause::Halt if transfers > most_transfers => failure = Some(too_long(most_transfers)),
                Pause::Halt => {
                    // Keep the words that it executes, a bit each, and what it reads
                    let answers = run.sent.iter().map(|&(_, answer)| (answer, core)).collect();
                    let mut words = vec![0; code.words().div_ceil(64) as usize];
                    for (pass, passes) in code.passes().iter().zip(tally.all()) {
                        words[pass.word as usize / 64] |= u64::from(passes.count != 0) << (pass.word % 64);
                    }
                    items.push(GoldenItem { message, core, run, words, reads: merged(reads) });
                    return Some(answers);
                }
            }
            None
        };
        // Run the main processor; what failed in an item comes before what that does to its end
        let mut link = MainLink::new(&mut memory, config.cores, &mut item);
        let (main, mut main_reads) = run_main(setup, &main_code, arithmetic, &mut link, config.main.step_limit);
        if let Some(failure) = failure {
            return Err(failure);
        }
        match main.end {
            Pause::Halt => {}
            Pause::Fault(fault) => return Err(Trap::new(fault, config.cores, main.pc, &main_code).into()),
            Pause::Wait => return Err(Trap::new(Fault::Deadlock, config.cores, main.pc, &main_code).into()),
        }
        // Add up the items' moments, and derive the limits of faulty runs
        main_reads.retain(|(_, octets)| *octets != 0);
        let before = |of: fn(&ItemRun) -> u64| -> Vec<u64> {
            let sums = items.iter().scan(0, |sum, item| {
                *sum += of(&item.run);
                Some(*sum)
            });
            std::iter::once(0).chain(sums).collect()
        };
        let (ticks, bus_words) = (before(|run| run.ticks), before(|run| run.traffic.words));
        let longest = items.iter().map(|item| item.run.ticks).max().unwrap_or(0);
        let limits = GuestLimits {
            item: (4 * longest + 1_000).min(config.step_limit),
            main: (2 * main.ticks + 1_000).min(config.main.step_limit),
            items: 2 * items.len() + 16,
        };
        let main_reads = merged(main_reads);
        let grants = OnceLock::new();
        Ok(GoldenFrame {
            setup,
            code,
            main_code,
            image,
            memory,
            items,
            main,
            main_reads,
            ticks,
            bus_words,
            limits,
            grants,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_become_ranges_that_are_found() {
        let ranges = merged(vec![(8, 4), (0, 4), (4, 2), (8, 1), (20, 4)]);
        assert_eq!(ranges, [0..6, 8..12, 20..24]);
        for (range, expected) in
            [(6..8, false), (5..6, true), (6..9, true), (12..20, false), (23..24, true), (24..28, false)]
        {
            assert_eq!(reads(&ranges, &range), expected, "{range:?}");
        }
    }
}
