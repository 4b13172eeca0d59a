//! Runs a program on whatever engine suits: quickly as far as it is nothing unusual, then on the interpreter.

use super::{Count, Stopped, Timeless, Wire};
use crate::checked::{self, Pause, Seat, State};
use crate::code::Code;
use crate::exec::{Link, Watch};
use crate::fast::{Features, Plan, Present};
use crate::profile::RunObserver;
use crate::tally::Tally;

/// The engines of one program.
#[derive(Clone, Debug)]
pub struct Driver<'a> {
    code: &'a Code<'a>,
    quick: Option<(Plan<'a>, Count)>,
    features: Present,
}

impl<'a> Driver<'a> {
    /// For a program; without features, or on a program that has no plan, everything is the interpreter's.
    pub fn new(code: &'a Code<'a>, features: Option<Features>) -> Driver<'a> {
        let plan = features.and_then(|_| Plan::new(code)).map(Plan::regardless_of_cores);
        let with_count = |plan: Plan<'a>| {
            let count = Count::new(&plan, false);
            (plan, count)
        };
        Driver { code, quick: plan.map(with_count), features: features.unwrap_or(Features::Baseline).present() }
    }

    /// Whether anything is executed quickly.
    pub fn is_quick(&self) -> bool {
        self.quick.is_some()
    }

    /// As [`checked::run`], but passes of words that were executed quickly come into the tally by [`Driver::fold`].
    pub fn run<T: Watch, O: RunObserver>(
        &mut self,
        seat: Seat,
        state: &mut State,
        arithmetic: &T,
        link: &mut dyn Link,
        tally: &mut Tally,
        observer: &mut O,
    ) -> Pause {
        if let Some((plan, count)) = self.quick.as_mut().filter(|_| !T::IS_WATCHING) {
            let link: &mut &mut dyn Wire = &mut (&mut Timeless(link) as _);
            match super::run::<_, O>(self.features, plan, seat, state, link, count, observer) {
                Stopped::Halt => return Pause::Halt,
                Stopped::Wait => return Pause::Wait,
                Stopped::Fault(fault) => return Pause::Fault(fault),
                Stopped::Unusual => {}
            }
        }
        checked::run(self.code, seat, state, arithmetic, link, tally, observer)
    }

    /// Adds the passes of words that were executed quickly to a tally of the program, and forgets them.
    pub fn fold(&mut self, tally: &mut Tally) {
        if let Some((plan, count)) = &mut self.quick {
            count.fold(plan, tally);
        }
    }
}
