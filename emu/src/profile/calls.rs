//! Operations of open calls and regions by class, and what closed ones have added up to: in 32 bits a class as long as that is enough, which
//! hosts compute several of at once.

use isa::{Class, Counts};

use super::RegionProfile;

/// Number of classes.
const CLASSES: usize = Class::ALL.len();

/// From here on a sum of 32 bits is carried over to 64 bits.
const FULL: u32 = 1 << 31;

/// Operations by class modulo 2^32.
pub type Near = [u32; CLASSES];

/// Running totals, of which only differences matter.
#[derive(Clone, Debug, Default)]
pub(super) struct Running {
    near: Near,
    /// By the number of something open: what it took before the totals were carried over last; shorter where nothing was carried.
    carried: Vec<Counts>,
}

/// Totals when something was entered.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Entered {
    near: Near,
    is_carried: bool,
}

impl Running {
    /// The totals now.
    #[inline]
    pub fn enter(&self) -> Entered {
        Entered { near: self.near, is_carried: false }
    }

    /// Adds operations, each class below 2^31; true where [`Running::carry_over`] has to follow.
    #[inline]
    #[must_use]
    pub fn add(&mut self, more: &Near) -> bool {
        let mut highest = 0;
        for (sum, more) in self.near.iter_mut().zip(more) {
            *sum = sum.wrapping_add(*more);
            highest |= *sum;
        }
        highest >= FULL
    }

    /// Takes operations back that were added since anything was entered or left.
    pub fn take_back(&mut self, less: &Counts) {
        for (sum, less) in self.near.iter_mut().zip(less.0) {
            *sum = sum.wrapping_sub(less as u32);
        }
    }

    /// Operations since something open was entered, if 32 bits a class hold them.
    #[inline]
    pub fn since(&self, entered: &Entered) -> Option<Near> {
        (!entered.is_carried).then(|| std::array::from_fn(|at| self.near[at].wrapping_sub(entered.near[at])))
    }

    /// Operations since something open, of that number, was entered.
    pub fn long_since(&self, entered: &Entered, number: usize) -> Counts {
        let carried = if entered.is_carried { self.carried[number] } else { Counts::ZERO };
        Counts(std::array::from_fn(|at| {
            // What was taken back may have been carried over before: then the difference is below 0.
            let near = self.near[at].wrapping_sub(entered.near[at]) as i32;
            carried.0[at].wrapping_add_signed(near.into())
        }))
    }

    /// Carries over what everything open has taken, and operations of whatever number.
    #[cold]
    pub fn carry_over<'e>(&mut self, open: impl Iterator<Item = &'e mut Entered>, more: &Counts) {
        for (number, entered) in open.enumerate() {
            let took = self.long_since(entered, number) + *more;
            match self.carried.get_mut(number) {
                Some(carried) => *carried = took,
                None => self.carried.push(took),
            }
            *entered = Entered { near: [0; CLASSES], is_carried: true };
        }
        self.near = [0; CLASSES];
    }
}

/// Totals of the calls of one function or region.
#[derive(Clone, Debug, Default)]
pub(super) struct Calls {
    calls: u64,
    inclusive: [u64; CLASSES],
    least: Near,
    most: Near,
    least_elementary: u64,
    most_elementary: u64,
}

/// Elementary classes.
const IS_ELEMENTARY: [bool; CLASSES] = {
    let mut is_elementary = [false; CLASSES];
    let mut at = 0;
    while at < CLASSES {
        is_elementary[at] = Class::ALL[at].is_elementary();
        at += 1;
    }
    is_elementary
};

impl Calls {
    /// One call is over.
    #[inline]
    pub fn note(&mut self, cost: &Near, is_outermost: bool) {
        let elementary = (0..CLASSES).map(|at| if IS_ELEMENTARY[at] { u64::from(cost[at]) } else { 0 }).sum();
        if self.calls == 0 {
            (self.least, self.most) = (*cost, *cost);
            (self.least_elementary, self.most_elementary) = (elementary, elementary);
        }
        for ((least, most), &cost) in self.least.iter_mut().zip(&mut self.most).zip(cost) {
            *least = (*least).min(cost);
            *most = (*most).max(cost);
        }
        self.least_elementary = self.least_elementary.min(elementary);
        self.most_elementary = self.most_elementary.max(elementary);
        self.calls += 1;
        if is_outermost {
            for (sum, more) in self.inclusive.iter_mut().zip(cost) {
                *sum += u64::from(*more);
            }
        }
    }

    /// Adds them to a profile.
    pub fn add_to(&self, region: &mut RegionProfile) {
        let wide = |near: &Near| Counts(near.map(u64::from));
        if self.calls != 0 {
            let (least, most) = (wide(&self.least), wide(&self.most));
            region.note_extremes(least, most, self.least_elementary, self.most_elementary);
            region.calls += self.calls;
            region.inclusive += Counts(self.inclusive);
        }
    }
}
