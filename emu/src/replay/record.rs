//! Runs work items by themselves and records what they do. Global memory is only read, so many can run at once.

use std::sync::Arc;

use super::budget::Budget;
use super::item::{ItemRecord, ItemRecorder, RecordLevel};
use super::recording::{ItemClocks, Portion, Reason, Recording, Segment, Stretch};
use crate::code::Code;
use crate::code::octets::{Buffer, Memory};
use crate::code::quantity::Octets;
use crate::code::tally::Tally;
use crate::code::trap::{Fault, Stop};
use crate::engine::{
    Answers, CoreId, Demand, EngineRunner, Pause, RequestTime, State, Stopped, TaintObserver, choose, interpreter,
};
use crate::machine::Setup;
use crate::machine::kinds::Kinds;
use crate::machine::port::widen;
use crate::machine::request::{Access, Request};
use crate::profile::{CallPath, ClockKeys, Observer, ProfileLevel, SiteAsked, SiteTable};
use crate::semantics::{Link, Message, Watch};

/// The link of a work item that is recorded: it says what it asks for, then gets it at once.
struct CheckedLink<'a> {
    memory: &'a Memory,
    main: u32,
    message: Option<Message>,
    is_permitted: bool,
    request: Option<Request>,
    sent: Vec<Message>,
    unfit: Option<Reason>,
}

impl CheckedLink<'_> {
    fn enter(&mut self, request: Request) -> Result<(), Stop> {
        // An instruction is tried twice: the first time it says what it asks for, the second time it gets it.
        if std::mem::take(&mut self.is_permitted) {
            return Ok(());
        }
        self.request = Some(request);
        Err(Stop::Wait)
    }

    fn refuse(&mut self, reason: Reason) -> Stop {
        self.unfit = Some(reason);
        Stop::Wait
    }

    fn ask(&mut self, access: Access, from: u32, octets: u32) -> Result<(), Stop> {
        self.memory.holds(from, octets)?;
        self.enter(Request::Transfer { address: from, octets: Octets(octets.into()), access })
    }
}

impl Link for CheckedLink<'_> {
    fn load(&mut self, buffer: &mut Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        let place = buffer.slice_mut(to, octets)?;
        self.ask(Access::Load, from, octets)?;
        Ok(self.memory.read(from, place)?)
    }

    fn store(&mut self, _: &Buffer, _: u32, _: u32, _: u32) -> Result<(), Stop> {
        Err(self.refuse(WRITES))
    }

    fn read(&mut self, address: u32, words: &mut [i32]) -> Result<(), Stop> {
        self.ask(Access::Read, address, 4 * words.len() as u32)?;
        Ok(self.memory.read_words(address, words)?)
    }

    fn read_octets(&mut self, address: u32, octets: &mut [u8]) -> Result<(), Stop> {
        self.ask(Access::Read, address, octets.len() as u32)?;
        Ok(self.memory.read(address, octets)?)
    }

    fn write(&mut self, _: u32, _: &[i32]) -> Result<(), Stop> {
        Err(self.refuse(WRITES))
    }

    fn fetch_add(&mut self, _: u32, _: i32) -> Result<i32, Stop> {
        Err(self.refuse(WRITES))
    }

    fn send(&mut self, to: i32, message: Message) -> Result<(), Stop> {
        let receiver = u32::try_from(to).ok().filter(|&to| to <= self.main);
        // A number without a processor is a fault of the item and is recorded; another core is a reason not to record it.
        let receiver = receiver.ok_or(Fault::NoSuchCore { number: to, largest: self.main })?;
        if receiver != self.main {
            return Err(self.refuse("the cores send messages to each other"));
        }
        self.enter(Request::Send { to: receiver, octets: Octets(message.octets().into()) })?;
        self.sent.push(message);
        Ok(())
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        if self.message.is_none() {
            return Err(self.refuse("a work item takes more than one message"));
        }
        self.enter(Request::Receive)?;
        let message = self.message.take().ok_or(Stop::Wait)?;
        Ok((message, self.main))
    }

    fn barrier(&mut self) -> Result<(), Stop> {
        Err(self.refuse("the cores wait for each other at a barrier"))
    }
}

const WITHOUT_ROOM: Reason = "there is no room for it";
const WRITES: Reason = "the cores write to global memory";
const BEGINS: Reason = "a work item does not begin with a message";

/// Prefix of a work item: what it does before it takes its message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Prefix {
    /// Clocks of computing.
    pub clocks: u64,
    /// Word of the receive.
    pub pc: u32,
}

/// A core that records, with the counts of all that it recorded.
pub struct Recorder<'a, T, O> {
    code: &'a Code<'a>,
    memory: &'a Memory,
    arithmetic: T,
    id: CoreId,
    state: State,
    initial: Buffer,
    level: RecordLevel,
    tally: Tally,
    /// Octets of all items.
    pub kinds: Kinds,
    /// Observer of all items.
    pub observer: TaintObserver<O>,
    runner: EngineRunner<'a>,
    /// Sites of transfers, where clocks are measured.
    sites: Option<SiteTable>,
    /// Transfers of an item by site, empty between items.
    asked: Vec<SiteAsked>,
    /// Number of this recorder among those of a run.
    number: u32,
}

impl<'a, T: Watch, O: Observer> Recorder<'a, T, O> {
    /// A core that has recorded nothing, by its number among those of a run.
    pub fn new(
        number: u32,
        code: &'a Code<'a>,
        setup: &Setup,
        memory: &'a Memory,
        arithmetic: T,
        level: RecordLevel,
    ) -> Self {
        let config = setup.config;
        let id = CoreId { core: 0, cores: config.cores, step_limit: config.step_limit };
        let initial = Buffer::new(&code.program.buffer, config.buffer_octets);
        let profile = if O::IS_ACTIVE { setup.options.profile } else { ProfileLevel::None };
        // Only segments need the time, and an engine that need not keep it is faster.
        let demand = Demand {
            follows_cores: true,
            profile,
            answers: Answers::AtOnce { keeps_time: level == RecordLevel::Segments },
            ..Demand::new(code, setup.options.wish(), arithmetic.computes(), config.buffer_octets)
        };
        Recorder {
            number,
            asked: Vec::new(),
            sites: (profile == ProfileLevel::Clocks && level == RecordLevel::Segments).then(SiteTable::default),
            runner: choose(&demand),
            level,
            state: State::new(code, initial.clone()),
            tally: Tally::new(code),
            kinds: Kinds::new(&setup.kinds),
            observer: TaintObserver::new(code, profile),
            code,
            memory,
            arithmetic,
            id,
            initial,
        }
    }

    fn run(&mut self, id: CoreId, link: &mut CheckedLink) -> Pause {
        interpreter::run(self.code, id, &mut self.state, &self.arithmetic, link, &mut self.tally, &mut self.observer)
    }

    fn link(&self, message: Option<Message>) -> CheckedLink<'a> {
        CheckedLink {
            memory: self.memory,
            main: self.id.cores,
            message,
            is_permitted: false,
            request: None,
            sent: Vec::new(),
            unfit: None,
        }
    }

    /// Prefix of every work item, before its message comes. The recorder's counts are worth nothing after that.
    ///
    /// # Errors
    /// Something else comes first.
    pub fn prefix(mut self) -> Result<Prefix, Reason> {
        let mut link = self.link(Some(Message::new([[0; 3]])));
        match self.run(self.id, &mut link) {
            // On another core an item might begin otherwise, and its prefix take other clocks.
            _ if self.observer.taint.depends_on_core || self.observer.taint.depends_on_cores => {
                Err("what comes before the message depends on the core")
            }
            Pause::Wait if link.request == Some(Request::Receive) => {
                Ok(Prefix { clocks: self.state.clocks, pc: self.state.pc })
            }
            _ => Err(BEGINS),
        }
    }

    /// Paths of the calling contexts that items were in, where clocks are measured, and the most that there may be.
    pub fn paths(&mut self) -> Option<(impl Iterator<Item = &CallPath>, usize)> {
        self.sites.as_ref()?;
        let contexts = &self.observer.profiler()?.contexts;
        Some((contexts.paths(), contexts.most()))
    }

    /// Meaning of the numbers in the clocks of its recordings, where they are measured.
    pub fn clock_keys(&mut self) -> Option<ClockKeys> {
        let sites = self.sites.as_ref()?.all().to_vec();
        let paths = self.observer.profiler()?.contexts.paths().cloned().collect();
        Some(ClockKeys { paths, sites })
    }

    /// The passes of all items.
    pub fn take_tally(&mut self) -> Tally {
        let kinds = &mut self.kinds;
        let mut add_octets = |kind, octets| kinds.add_octets(kind as usize, Octets(octets));
        self.runner.fold(&mut self.tally, &mut add_octets, self.observer.profiler());
        std::mem::replace(&mut self.tally, Tally::new(self.code))
    }

    /// Runs a work item as far as it is nothing unusual; what comes after that is for the interpreter.
    fn run_quickly(&mut self, record: &mut ItemRecord, budget: &Budget) -> Option<Stopped> {
        let (memory, main, level) = (self.memory, self.id.cores, self.level);
        let time = RequestTime { pc: 0, context: 0, clocks: 0 };
        let (kinds, sites) = (&mut self.kinds, self.sites.as_mut());
        let mut link = ItemRecorder { memory, main, budget, kinds, sites, record, level, time };
        let (id, state) = (self.id, &mut self.state);
        let TaintObserver { inner: observer, taint, .. } = &mut self.observer;
        self.runner.run_ahead(id, state, &self.arithmetic, &mut link, taint, observer.profiler())
    }

    /// Goes on with the interpreter, request by request, as long as the engine likes, and refuses what an item may not do. Yields the end of
    /// the item, if it has come to that.
    ///
    /// # Errors
    /// Reason for which the item cannot be replayed.
    fn interpret(&mut self, record: &mut ItemRecord, budget: &Budget) -> Result<Option<Pause>, Reason> {
        let before = self.state.steps + self.state.inner_steps;
        let mut limit = before.saturating_add(self.runner.patience(self.id, &self.state));
        let mut link = CheckedLink { sent: std::mem::take(&mut record.sent), ..self.link(record.message) };
        let end = loop {
            let id = CoreId { step_limit: self.id.step_limit.min(limit), ..self.id };
            let pause = self.run(id, &mut link);
            if limit < self.id.step_limit && pause == Pause::Fault(Fault::StepLimit(limit)) {
                if !link.is_permitted {
                    break None;
                }
                // What was asked for is recorded already, so it has to be done here.
                limit += 1;
                continue;
            }
            if pause != Pause::Wait {
                break Some(pause);
            }
            if let Some(reason) = link.unfit {
                return Err(reason);
            }
            let request = link.request.take().ok_or(BEGINS)?;
            if request != Request::Receive {
                if link.message.is_some() {
                    return Err(BEGINS);
                }
                let clocks = self.state.clocks - record.before;
                let segment = Segment::new(clocks, self.state.pc, request, link.sent.len() - record.first_message);
                let segment = segment.ok_or("a segment of a work item is too long")?;
                record.octets += segment.octets();
                if segment.is_read() {
                    widen(&mut record.reads, segment.range());
                }
                if let (Some(sites), Some(profiler)) = (&mut self.sites, self.observer.profiler()) {
                    let context = profiler.contexts.current();
                    record.track.sites.push(self.kinds.site(sites, context, self.state.pc, request));
                }
                self.kinds.add(self.state.pc, Some(request));
                record.track.segments.push(segment);
                // Room is taken in shares, since all host threads take it from one number.
                if record.segments().is_multiple_of(Budget::SHARE) && !budget.take(Budget::SHARE) {
                    return Err(WITHOUT_ROOM);
                }
            }
            record.before = self.state.clocks;
            link.is_permitted = true;
        };
        (record.message, record.sent) = (link.message, link.sent);
        self.runner.interpreted(self.state.steps + self.state.inner_steps - before);
        Ok(end)
    }

    /// Runs a work item from reset to its end, and puts it behind those of a portion that nobody else has.
    ///
    /// # Errors
    /// Reason for which the work item cannot be replayed; then the portion is worth nothing.
    pub fn record(&mut self, message: Message, budget: &Budget, portion: &mut Portion) -> Result<(), Reason> {
        self.state.begin(self.code, &self.initial);
        self.observer.begin(self.state.pc);
        let track = std::mem::take(Arc::get_mut(&mut portion.track).expect("nobody else has it"));
        let sent = std::mem::take(&mut portion.sent);
        let (first_segment, first_message) = (track.segments.len(), sent.len());
        let begun = ItemRecord { message: Some(message), track, sent, ..ItemRecord::default() };
        let mut record = ItemRecord { first_segment, first_message, ..begun };
        let end = loop {
            let stopped = self.run_quickly(&mut record, budget);
            if record.is_without_room {
                return Err(WITHOUT_ROOM);
            }
            match stopped {
                Some(Stopped::Halt) => break Pause::Halt,
                Some(Stopped::Fault(fault)) => break Pause::Fault(fault),
                _ => {}
            }
            if let Some(end) = self.interpret(&mut record, budget)? {
                break end;
            }
        };
        if record.message.is_some() {
            return Err(BEGINS);
        }
        // Account for what was recorded
        self.observer.end();
        budget.take(record.segments() % Budget::SHARE);
        if self.observer.taint.depends_on_core {
            return Err("a work item asks which core it runs on");
        }
        let (observer, clocks) = (self.number, self.state.clocks);
        let known = self.sites.as_ref().map_or(0, |sites| sites.all().len() as u32);
        let ItemRecord { track, sent, octets, reads, before, .. } = record;
        let profiler = self.observer.profiler().filter(|_| self.sites.is_some());
        let cells = profiler.and_then(|profiler| profiler.contexts.cells.as_mut());
        let item_clocks = cells.map(|cells| {
            let (first_cell, first_asked) = (portion.cells.len(), portion.asked.len());
            cells.take(clocks, &mut portion.cells);
            let (segments, sites) = (&track.segments[first_segment..], &track.sites[first_segment..]);
            add_asked(segments, sites, known, &mut self.asked, &mut portion.asked);
            let (cells, asked) = (first_cell..portion.cells.len(), first_asked..portion.asked.len());
            ItemClocks { observer, cells, asked, known }
        });
        let segments = first_segment..track.segments.len();
        portion.items.push(Recording {
            message,
            clocks: item_clocks,
            stretch: Stretch { reads, segments },
            octets,
            sent: first_message..sent.len(),
            last_clocks: clocks - before,
            last_pc: self.state.pc,
            end,
            steps: self.state.steps,
            elementary: self.state.elementary,
            depends_on_cores: self.observer.taint.depends_on_cores,
        });
        *Arc::get_mut(&mut portion.track).expect("nobody else has it") = track;
        portion.sent = sent;
        Ok(())
    }
}

/// Adds the transfers of an item by site, of which so many are known, behind those that are there. `sums` has none before and afterwards.
fn add_asked(
    segments: &[Segment],
    sites: &[u32],
    known: u32,
    sums: &mut Vec<SiteAsked>,
    asked: &mut Vec<(u32, SiteAsked)>,
) {
    sums.resize(sums.len().max(known as usize), SiteAsked::default());
    let first = asked.len();
    for (segment, &site) in segments.iter().zip(sites) {
        let sum = &mut sums[site as usize];
        if sum.transfers == 0 {
            asked.push((site, SiteAsked::default()));
        }
        sum.add(SiteAsked { transfers: 1, octets: segment.octets().0 });
    }
    for (site, found) in &mut asked[first..] {
        *found = std::mem::take(&mut sums[*site as usize]);
    }
}
