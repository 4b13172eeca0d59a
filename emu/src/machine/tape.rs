//! A core that replays what a work item was recorded to do, in the place of an engine that does it.

use std::sync::Arc;

use super::bus::Lengths;
use super::processor::{Advance, Processor};
use super::recording::{Recording, Segment};
use super::reel::{Reel, overlap};
use super::station::{Access, Request, Shared};
use crate::engine::Pause;
use crate::quantity::{Clocks, Octets};
use crate::trap::Fault;

/// How far a replayed work item has come.
#[derive(Clone, Debug, Default)]
pub struct Tape {
    /// The work item; none before its message has come.
    recording: Option<Arc<Recording>>,
    /// Segments that are behind it.
    next: usize,
}

impl Tape {
    /// What the last segment asked for. Where a reel has rolled on, that is noted nowhere else.
    fn asked(&self, main: u32) -> Option<Request> {
        Some(self.recording.as_ref()?.segments.get(self.next.checked_sub(1)?)?.request(main))
    }
}

impl<O> Processor<'_, O> {
    /// Hands its recorded work item over to a reel when it begins to ask for a transfer, where nothing but the bus is needed for what comes next.
    pub(super) fn wind(&mut self, reel: &mut Reel, shared: &Shared, lengths: &Lengths) {
        let Some(tape) = self.tape.as_mut() else { return };
        let is_safe = |recording: &Recording| {
            let asked = tape.next.checked_sub(1).and_then(|last| recording.segments.get(last));
            asked.is_some_and(Segment::is_read) && !overlap(&recording.reads, &shared.written)
        };
        if tape.recording.as_deref().is_some_and(is_safe)
            && let Some(recording) = tape.recording.take()
        {
            reel.wind(recording, tape.next, self.clock, lengths);
        }
    }

    /// Takes its work item back when the last transfer that a reel played has ended. What was done is what [`Processor::advance`] and requests
    /// for the bus would have done.
    pub(super) fn unwind(&mut self, reel: &mut Reel, end: Clocks) {
        self.used.longest_wait = self.used.longest_wait.max(reel.take_longest_wait());
        if let (Some(played), Some(tape)) = (reel.unwind(end), self.tape.as_mut()) {
            (tape.recording, tape.next) = (Some(played.recording), played.next);
            self.used.busy += played.busy;
            self.used.waiting += played.waiting;
            self.clock = end;
            self.work.has_acted = true;
        }
    }

    /// Goes on up to the next thing that concerns others, as an engine would: see [`Processor::advance`].
    pub(super) fn replay(&mut self, mut tape: Tape, shared: &mut Shared, has_leave: bool) -> Advance {
        let main = self.seat.cores;
        let mut taken = None;
        let noted = self.request.take();
        let asked = tape.asked(main).or(noted);
        if has_leave {
            match asked {
                Some(Request::Receive) => {
                    let next = shared.mailboxes.next(self.seat.core);
                    taken = next.and_then(|(_, sender)| Some((shared.mailboxes.take(self.seat.core, sender)?, sender)));
                    let library = shared.library.as_mut();
                    tape.recording = taken.zip(library).and_then(|((message, _), library)| library.take(&message));
                    self.used.octets += tape.recording.as_ref().map_or(Octets(0), |recording| recording.octets);
                }
                Some(Request::Send { to, .. }) => {
                    let recording = tape.recording.as_ref();
                    let sent = recording.and_then(|recording| {
                        let segment = recording.segments.get(tape.next.checked_sub(1)?)?;
                        recording.sent.get(segment.address as usize)
                    });
                    if let Some(&message) = sent {
                        shared.mailboxes.put(to, self.seat.core, self.clock, message);
                    }
                }
                Some(Request::Transfer { address, octets, access: Access::Load | Access::Read }) => {
                    let read = u64::from(address)..u64::from(address) + octets.0;
                    if overlap(&read, &shared.written)
                        && let Some(library) = shared.library.as_mut()
                    {
                        library.lose::<()>("the cores read what the main processor has written");
                    }
                }
                _ => {}
            }
        }
        let library = shared.library.as_ref();
        let prefix = library.map(|library| library.prefix);
        let is_lost = library.is_none_or(|library| library.lost.is_some());
        let mut steps = 0;
        let (clocks, pause) = match (&tape.recording, prefix) {
            // What comes of a lost replay is thrown away; this ends it.
            _ if is_lost => (0, Pause::Fault(Fault::Deadlock)),
            (None, Some(prefix)) if !has_leave => {
                self.request = Some(Request::Receive);
                self.state.pc = prefix.pc;
                (prefix.clocks, Pause::Wait)
            }
            (None, _) => (0, Pause::Fault(Fault::Deadlock)),
            (Some(recording), _) => match recording.segments.get(tape.next) {
                Some(segment) => {
                    tape.next += 1;
                    self.request = Some(segment.request(main));
                    self.state.pc = segment.pc;
                    (segment.clocks.into(), Pause::Wait)
                }
                None => {
                    self.state.pc = recording.last_pc;
                    (self.state.steps, self.state.elementary) = (recording.steps, recording.elementary);
                    steps = recording.steps;
                    (recording.last_clocks, recording.end)
                }
            },
        };
        self.tape = Some(tape);
        self.spend(clocks, steps, has_leave);
        Advance { pause, taken, steps }
    }
}
