//! Masters that a fault of grants leaves unheard, on a bus that serves its masters by itself: such a master's request is withdrawn, so that the
//! arbiter stays the right one, ranks and all. A bus that is asked burst by burst has a [`super::grant_fault::FaultyArbiter`] instead, which
//! does the same more slowly.

use super::arbiter::NEVER;
use super::bus::{Burst, Bus};
use super::grant_fault::{GrantFault, GrantFaultKind};
use crate::code::quantity::Clocks;

/// Fault of grants on its way through a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct MutedMasters {
    fault: GrantFault,
    phase: FaultPhase,
}

/// Phase of a fault of grants.
#[derive(Clone, Copy, Debug)]
enum FaultPhase {
    /// Nothing is wrong before the fault's clock.
    Ahead,
    /// A grant was lost, and the request is made again at a clock.
    Lost { master: u32, arrival: Clocks, burst: Burst, again: Clocks },
    /// Masters are unheard to the end.
    Lasting,
    /// The request whose grant was lost has been made again.
    Over,
}

impl MutedMasters {
    /// A fault that has not struck yet.
    pub fn new(fault: GrantFault) -> MutedMasters {
        MutedMasters { fault, phase: FaultPhase::Ahead }
    }

    /// Clock up to which the arbiter goes on among those that are heard; beyond every clock where nothing changes any more.
    pub fn change(&self) -> Clocks {
        match self.phase {
            FaultPhase::Ahead => self.fault.at,
            FaultPhase::Lost { again, .. } => again,
            FaultPhase::Lasting | FaultPhase::Over => NEVER,
        }
    }

    /// True where an arbiter is stuck at a master, which gets the bus whenever it asks, in slots of others as well.
    pub fn is_stuck(&self) -> bool {
        matches!(self.phase, FaultPhase::Lasting) && self.fault.kind == GrantFaultKind::Stuck
    }

    /// True for a master that is not heard, whatever it asks for.
    pub fn is_unheard(&self, master: u32) -> bool {
        let is_lasting = matches!(self.phase, FaultPhase::Lasting);
        match self.fault.kind {
            GrantFaultKind::Stuck => is_lasting && master != self.fault.master,
            GrantFaultKind::Stopped => is_lasting && master == self.fault.master,
            GrantFaultKind::Lost { .. } => false,
        }
    }
}

impl Bus {
    /// Lets a fault strike, or its request be made again, when all decisions before the [clock of that](MutedMasters::change) are made; false where
    /// no decision before `until` is left for it.
    pub(super) fn mute(&mut self, until: Clocks) -> bool {
        let Some(MutedMasters { fault, phase }) = self.muted else { return false };
        let next = match (phase, fault.kind) {
            (FaultPhase::Ahead, GrantFaultKind::Lost { retry }) => match self.lose(retry, until) {
                Some(lost) => lost,
                None => return false,
            },
            (FaultPhase::Ahead, _) => {
                // An arbiter that has put off its masters may be stuck at one of them, who then gets the bus.
                self.not_before = self.not_before.min(fault.at);
                FaultPhase::Lasting
            }
            (FaultPhase::Lost { master, arrival, burst, again }, _) => {
                // It has been waiting since it asked first, but nobody heard it before now.
                self.requests.ask(master, arrival, burst);
                // An arbiter that has put off the others is asked anew.
                (self.free_at, self.not_before) = (self.free_at.max(again), self.not_before.min(again));
                FaultPhase::Over
            }
            (over, _) => over,
        };
        let muted = MutedMasters { fault, phase: next };
        self.muted = Some(muted);
        (0..self.requests.masters())
            .filter(|&master| muted.is_unheard(master))
            .for_each(|master| self.requests.withdraw(master));
        true
    }

    /// Loses the next grant before a clock: the bus is idle for its burst.
    fn lose(&mut self, retry: Clocks, until: Clocks) -> Option<FaultPhase> {
        loop {
            let clock = self.next_decision().filter(|&clock| clock < until)?;
            let Some(master) = self.ask(clock) else { continue };
            let (arrival, burst) = (self.requests.arrival(master), self.requests.bursts[master as usize]);
            self.requests.withdraw(master);
            (self.free_at, self.not_before) = (clock + burst.length, Clocks(0));
            let again = if retry == Clocks(0) { NEVER } else { clock + retry };
            return Some(FaultPhase::Lost { master, arrival, burst, again });
        }
    }
}
