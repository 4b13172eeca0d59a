//! Where the numbers of cores go in the lanes of a group: what the interpreter's observer follows instruction by
//! instruction, a block at a time and for all lanes that agree at once.

use std::ops::Range;

use super::lanes::{LANES, Mask, where_true};
use super::plan::Plan;
use crate::independence::Origin;

/// What each lane knows of the cores.
#[derive(Clone, Debug)]
pub struct Origins {
    lanes: [Origin; LANES],
    /// Lanes in which a register holds the number of cores.
    tainted: Mask,
}

impl Default for Origins {
    fn default() -> Origins {
        Origins { lanes: [Origin::default(); LANES], tainted: 0 }
    }
}

impl Origins {
    /// Nothing is known at reset.
    pub fn reset(&mut self) {
        *self = Origins::default();
    }

    /// Some lanes execute some words.
    #[inline(always)]
    pub fn follow(&mut self, plan: &Plan, words: Range<u32>, mask: Mask) {
        if plan.asks(&words, self.tainted & mask != 0) {
            self.follow_each(plan, words, mask);
        }
    }

    #[inline(never)]
    fn follow_each(&mut self, plan: &Plan, words: Range<u32>, mask: Mask) {
        let mut rest = mask;
        while rest != 0 {
            let before = self.lanes[rest.trailing_zeros() as usize];
            let alike = where_true(|lane| self.lanes[lane] == before) & rest;
            let mut after = before;
            for pc in words.clone() {
                after.step(plan.mark(pc));
            }
            for lane in super::lanes::each(alike) {
                self.lanes[lane] = after;
            }
            let is_tainted = if after.tainted != 0 { alike } else { 0 };
            self.tainted = self.tainted & !alike | is_tainted;
            rest &= !alike;
        }
    }

    /// What a lane knows.
    pub fn lane(&self, lane: usize) -> Origin {
        self.lanes[lane]
    }
}
