//! A build without native code.

pub use NoNative as Native;

use std::convert::Infallible;
use std::marker::PhantomData;

use super::{AddOctets, CoreId, Demand, Engine, Refusal, State, Stopped, Taint, TimedLink};
use crate::code::tally::Tally;
use crate::profile::Profiler;
use crate::semantics::Watch;

/// Nothing: there is no such engine in this build.
#[derive(Clone, Debug)]
pub struct NoNative<'a>(Infallible, PhantomData<&'a ()>);

impl<'a> Engine<'a> for NoNative<'a> {
    fn new(_: &Demand<'a>) -> Result<NoNative<'a>, Refusal> {
        Err("this build of lancer generates no native code")
    }

    fn run<T: Watch>(
        &mut self,
        _: CoreId,
        _: &mut State,
        _: &T,
        _: &mut dyn TimedLink,
        _: &mut Taint,
        _: Option<&mut Profiler>,
    ) -> Stopped {
        match self.0 {}
    }

    fn fold(&mut self, _: &mut Tally, _: AddOctets, _: Option<&mut Profiler>) {
        match self.0 {}
    }
}
