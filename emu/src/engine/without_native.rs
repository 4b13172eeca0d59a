//! A build without native code.

use super::{AddOctets, CoreId, Demand, Engine, Refusal, State, Stopped, Taint, TimedLink};
use crate::code::tally::Tally;
use crate::profile::RunObserver;
use crate::semantics::Watch;

/// Nothing: there is no such engine in this build.
#[derive(Clone, Debug)]
pub enum Native {}

impl<'a> Engine<'a> for Native {
    fn new(_: &Demand<'a>) -> Result<Native, Refusal> {
        Err("this build of lancer generates no native code")
    }

    fn run<T: Watch, L: TimedLink, O: RunObserver>(
        &mut self,
        _: CoreId,
        _: &mut State,
        _: &T,
        _: &mut L,
        _: &mut Taint,
        _: &mut O,
    ) -> Stopped {
        match *self {}
    }

    fn fold(&mut self, _: &mut Tally, _: AddOctets) {
        match *self {}
    }
}
