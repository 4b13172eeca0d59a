//! A session: where the core is, and how it moves, forwards by executing and back by checkpoints. Positions are numbers of executed
//! instructions, so that each has one state.

use std::collections::BTreeMap;

use emu::stepper::{Executed, Stepper};
use messages::Report;

use super::checkpoints::Checkpoints;
use super::stop::{self, Event, StopPoint};
use super::target::DebugTarget;
use crate::trace::instruction::TraceClocks;

/// Way of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Towards the program's end.
    Forwards,
    /// Towards its start.
    Back,
}

/// Reason for which a motion ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StopReason {
    /// The motion went as far as it was to go.
    Done,
    /// Stop points were met: their numbers.
    Met(Vec<u32>),
    /// A result lost bits or did not fit.
    Lossy,
    /// The program halted.
    Halted,
    /// The program went wrong.
    Trapped,
    /// The program's start was reached.
    Start,
}

/// Losses that a motion looks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lossy {
    /// Results that lost bits below the last place.
    pub quantized: bool,
    /// Results that did not fit.
    pub overflowed: bool,
}

impl Lossy {
    fn has(self, executed: &Executed) -> bool {
        self.quantized && executed.losses.quantized > 0 || self.overflowed && executed.losses.overflowed > 0
    }
}

/// Checkpoints that are kept at most.
const MOST_CHECKPOINTS: usize = 256;

/// Octets that the checkpoints of a program may take, of which each may have written all of its memory.
const MOST_OCTETS: usize = 256 << 20;

/// A core that is debugged.
pub struct Session<'a> {
    /// Program that is debugged.
    pub target: &'a DebugTarget,
    stepper: Stepper<'a>,
    checkpoints: Checkpoints,
    stops: Vec<StopPoint>,
    next_number: u32,
    /// Losses that every motion stops at.
    pub lossy: Lossy,
    /// Times that each counted stop point was met from the start up to the position.
    hits: BTreeMap<u32, u64>,
    /// Position of the last stop.
    last_stop: u64,
}

impl<'a> Session<'a> {
    /// A session at the start.
    ///
    /// # Errors
    /// A machine out of its ranges, or initial data that do not fit the buffer.
    pub fn new(target: &'a DebugTarget) -> Result<Session<'a>, Report> {
        let stepper = target.stepper()?;
        let checkpoints = Checkpoints::new(stepper.checkpoint(), most_checkpoints(target, &stepper));
        Ok(Session {
            target,
            stepper,
            checkpoints,
            stops: Vec::new(),
            next_number: 1,
            lossy: Lossy::default(),
            hits: BTreeMap::new(),
            last_stop: 0,
        })
    }

    /// The core.
    pub fn stepper(&self) -> &Stepper<'a> {
        &self.stepper
    }

    /// Instructions executed.
    pub fn position(&self) -> u64 {
        self.stepper.steps()
    }

    /// Word of the next instruction.
    pub fn pc(&self) -> u32 {
        self.stepper.code.word(self.stepper.state().pc)
    }

    /// Position of the stop before the last motion.
    pub fn last_stop(&self) -> u64 {
        self.last_stop
    }

    /// Stop points, by number.
    pub fn stops(&self) -> &[StopPoint] {
        &self.stops
    }

    /// Adds a stop point; yields its number.
    pub fn add_stop(
        &mut self,
        text: String,
        event: Event,
        condition: Option<super::condition::StopCondition>,
        count: u64,
    ) -> u32 {
        let number = self.next_number;
        self.next_number += 1;
        self.stops.push(StopPoint { number, text, event, condition, count });
        self.recount();
        number
    }

    /// Takes a stop point away; false where there is none of that number.
    pub fn remove_stop(&mut self, number: u32) -> bool {
        let before = self.stops.len();
        self.stops.retain(|stop| stop.number != number);
        self.stops.len() != before
    }

    /// Changes the state by hand: what comes after is another future, and what was before stays.
    pub fn change(&mut self, change: impl FnOnce(&mut emu::registers::Registers)) {
        self.stepper.change_registers(change);
        self.checkpoints.change(self.position(), self.stepper.checkpoint());
    }

    /// Begins a motion: what it counts begins anew.
    pub fn begin(&mut self) {
        self.last_stop = self.position();
        self.stepper.forget_counts();
    }

    /// Goes to a position, forwards or back, whatever lies between.
    pub fn go_to(&mut self, position: u64) -> StopReason {
        if position < self.position() {
            self.restore_before(position);
        }
        // Run in pieces that end where checkpoints are due.
        while self.position() < position && self.stepper.end().is_none() {
            self.stepper.run_to(self.checkpoints.next(self.position(), position).min(position));
            self.arrive(Some(position));
        }
        self.recount();
        match self.stepper.end() {
            Some(_) if self.position() < position || self.stepper.trap().is_some() => self.end_reason(),
            _ if position == 0 => StopReason::Start,
            _ => StopReason::Done,
        }
    }

    fn end_reason(&self) -> StopReason {
        if self.stepper.trap().is_some() { StopReason::Trapped } else { StopReason::Halted }
    }

    fn restore_before(&mut self, position: u64) {
        self.stepper.restore(self.checkpoints.before(position).1);
    }

    /// Takes over what was changed by hand at this position, or keeps a checkpoint where one is due on the way to `end`.
    fn arrive(&mut self, end: Option<u64>) {
        let position = self.position();
        if self.checkpoints.is_changed(position) {
            return self.restore_before(position);
        }
        self.checkpoints.arrive(position, end, || self.stepper.checkpoint());
    }

    /// Takes one instruction on the way to `end`, where that is known; `None` at the program's end.
    fn step(&mut self, end: Option<u64>) -> Option<Executed> {
        let executed = self.stepper.step();
        self.arrive(end);
        executed
    }

    /// Numbers of the stop points that are met behind an instruction, with those that are counted counted.
    fn met(&mut self, executed: Option<&Executed>, before: &[Option<Vec<i64>>]) -> Vec<u32> {
        let mut met = Vec::new();
        for (stop, before) in self.stops.iter().zip(before) {
            if !stop.is_met(&self.stepper, executed, before.as_ref()) {
                continue;
            }
            if stop.count > 1 {
                let hits = self.hits.entry(stop.number).or_default();
                *hits += 1;
                if *hits < stop.count {
                    continue;
                }
            }
            met.push(stop.number);
        }
        met
    }

    fn watched(&self) -> Vec<Option<Vec<i64>>> {
        let contents = |stop: &StopPoint| match &stop.event {
            Event::Watch(watched) => stop::contents(watched, &self.stepper),
            Event::At(_) => None,
        };
        self.stops.iter().map(contents).collect()
    }

    /// Counts how often counted stop points were met up to here: from the start, since that is what their numbers count from.
    fn recount(&mut self) {
        if self.stops.iter().all(|stop| stop.count <= 1) {
            return;
        }
        let position = self.position();
        self.hits.clear();
        let here = self.stepper.checkpoint();
        self.stepper.restore(self.checkpoints.start());
        self.met(None, &vec![None; self.stops.len()]);
        while self.position() < position {
            let before = self.watched();
            let Some(executed) = self.step(Some(position)) else { break };
            self.met(Some(&executed), &before);
        }
        self.stepper.restore(&here);
    }

    /// Goes on to the next stop point, a loss that is looked for, a position that `is_there`, or the program's end.
    pub fn run(&mut self, is_there: &mut dyn FnMut(&Session, Option<&Executed>) -> bool) -> StopReason {
        loop {
            let before = self.watched();
            let Some(executed) = self.step(None) else { return self.end_reason() };
            let met = self.met(Some(&executed), &before);
            if !met.is_empty() {
                return StopReason::Met(met);
            }
            if self.lossy.has(&executed) {
                return StopReason::Lossy;
            }
            if self.stepper.end().is_some() {
                return self.end_reason();
            }
            if is_there(self, Some(&executed)) {
                return StopReason::Done;
            }
        }
    }

    /// Goes back to the last position before this one at which [`Session::run`] would have stopped, or to the start.
    pub fn run_back(&mut self, is_there: &mut dyn FnMut(&Session, Option<&Executed>) -> bool) -> StopReason {
        let mut end = self.position();
        let is_counted = self.stops.iter().any(|stop| stop.count > 1);
        let mut found = None;
        while end > 0 && found.is_none() {
            // Look through the piece up to `end` from a checkpoint that lies before its last position; counted stop points count from the start.
            let from = match is_counted || end == 1 {
                true => 0,
                false => self.checkpoints.before(end - 2).0,
            };
            self.restore_before(from);
            self.hits.clear();
            if from == 0 {
                let met = self.met(None, &vec![None; self.stops.len()]);
                found = (!met.is_empty()).then_some((0, StopReason::Met(met)));
                if found.is_none() && is_there(self, None) {
                    found = Some((0, StopReason::Done));
                }
            }
            while self.position() + 1 < end {
                let before = self.watched();
                let Some(executed) = self.step(Some(end)) else { break };
                let met = self.met(Some(&executed), &before);
                let reason = match (met.is_empty(), self.lossy.has(&executed)) {
                    (false, _) => Some(StopReason::Met(met)),
                    (true, true) => Some(StopReason::Lossy),
                    (true, false) => is_there(self, Some(&executed)).then_some(StopReason::Done),
                };
                found = reason.map(|reason| (self.position(), reason)).or(found);
            }
            end = if from == 0 { 0 } else { from + 1 };
        }
        let (position, reason) = found.unwrap_or((0, StopReason::Start));
        self.go_to(position);
        reason
    }
}

/// Checkpoints that are kept. Those of a work item share its memory, which it seldom writes.
fn most_checkpoints(target: &DebugTarget, stepper: &Stepper) -> usize {
    match target.clocks {
        TraceClocks::Own => (MOST_OCTETS / (stepper.memory().size() + (64 << 10))).clamp(8, MOST_CHECKPOINTS),
        TraceClocks::None => MOST_CHECKPOINTS,
    }
}
