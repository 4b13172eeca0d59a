//! Synchronisation of processors: mailboxes that are empty or full, and the barrier.

use super::processor::{Act, Processor, ProcessorState};
use super::schedule::Machine;
use super::worker::Worker;
use crate::code::quantity::Clocks;

impl<W: Worker> Machine<'_, W> {
    /// Sets when a listening processor takes its next message, when there is one.
    pub(super) fn listen(&mut self, number: usize) {
        let processor = &mut self.processors[number];
        if let Some((arrival, _)) = self.shared.mailboxes.next(number as u32) {
            processor.state = ProcessorState::Acts { at: arrival.max(processor.clock), act: Act::Receive };
        }
    }

    /// A message has come for a processor.
    pub(super) fn deliver(&mut self, receiver: usize) {
        let is_main = receiver == self.main();
        match self.processors[receiver].state {
            ProcessorState::Listens | ProcessorState::Acts { act: Act::Receive, .. } => self.listen(receiver),
            ProcessorState::Asleep => self.start(receiver),
            ProcessorState::Rests if !is_main => {
                if let Some((arrival, _)) = self.shared.mailboxes.next(receiver as u32) {
                    let processor = &mut self.processors[receiver];
                    // A core at rest is not asked for its clock again, so the time without work is accounted for here.
                    processor.idle_until(arrival.max(processor.clock));
                }
                self.start(receiver);
            }
            _ => {}
        }
    }

    /// A receiver has emptied the mailbox that it has for a sender.
    pub(super) fn unblock(&mut self, sender: usize, receiver: u32, at: Clocks) {
        let processor = &mut self.processors[sender];
        if processor.state == (ProcessorState::Blocked { to: receiver }) {
            processor.idle_until(at.max(processor.clock));
            self.ask_for_transfer(sender);
        }
    }

    /// Lets all leave the barrier, when nobody is missing, at the clock at which the last one came or had no more to do.
    pub(super) fn leave_barrier(&mut self) {
        let is_here = |processor: &Processor<W>| match processor.state {
            ProcessorState::Meets | ProcessorState::Rests => true,
            // Nobody but the main processor begins work.
            ProcessorState::Asleep | ProcessorState::Listens => {
                self.has_main_halted && processor.work.message.is_none()
            }
            _ => false,
        };
        if !self.processors.iter().all(is_here) {
            return;
        }
        let meets = |processor: &&mut Processor<W>| processor.state == ProcessorState::Meets;
        // Not before now: a core that went to rest just now may have been the last one.
        let last = self.processors.iter_mut().filter(meets).map(|processor| processor.clock).max();
        let at = last.unwrap_or_default().max(self.now);
        for processor in self.processors.iter_mut().filter(meets) {
            processor.state = ProcessorState::Acts { at, act: Act::Leave };
        }
        self.meeting = 0;
    }
}
