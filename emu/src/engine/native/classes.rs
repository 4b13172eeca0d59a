//! Operations by class as generated code adds them up for those who measure each call: 32 bits a class, which are emptied in time.

use isa::{Class, Counts};

use crate::engine::plan::Plan;
use crate::profile::Near;

/// Number of classes.
pub(super) const LANES: usize = {
    assert!(Class::ALL.len().is_multiple_of(4), "vectors of four hold all of them");
    Class::ALL.len()
};

/// Operations by class.
pub(super) type Lanes = Near;

/// Costs of the places of a program by class.
#[derive(Clone, Debug)]
pub(super) struct Classes {
    /// Cost of the places up to each, and up to the end, without what depends on exits.
    before: Vec<Counts>,
    /// By exit: what it adds; nothing where all exits of its row cost the same.
    pub exits: Box<[Lanes]>,
}

/// The numbers as lanes.
pub(super) fn lanes(counts: &Counts) -> Lanes {
    std::array::from_fn(|at| counts.0.get(at).map_or(0, |&count| count as u32))
}

impl Classes {
    /// Costs of the places of a plan, by class.
    pub fn new(plan: &Plan) -> Classes {
        let steps = &plan.steps()[..plan.end() as usize];
        let cost = |exit: usize| plan.pass(exit).map_or(Counts::ZERO, |pass| plan.code.pass_cost(pass).0);
        let mut exits: Box<[Lanes]> = vec![[0; LANES]; plan.exits()].into();
        let (mut before, mut sum) = (vec![Counts::ZERO], Counts::ZERO);
        for step in steps {
            let numbers = step.exit as usize..step.exit as usize + usize::from(step.exits);
            match numbers.clone().all(|exit| cost(exit) == cost(numbers.start)) {
                true if !numbers.is_empty() => sum += cost(numbers.start),
                true => {}
                false => numbers.for_each(|exit| exits[exit] = lanes(&cost(exit))),
            }
            before.push(sum);
        }
        Classes { before, exits }
    }

    /// Cost of the places from one to before another one, without what depends on exits.
    pub fn span(&self, from: u32, to: u32) -> Counts {
        let (from, to) = (&self.before[from as usize], &self.before[to as usize]);
        Counts(std::array::from_fn(|at| to.0[at] - from.0[at]))
    }
}
