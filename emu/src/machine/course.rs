//! Clocks of the bus over the time of a frame, in equal parts whose length grows with the frame, so that a frame of any length takes the
//! same memory.

use super::bus::Grant;
use crate::code::quantity::Clocks;

/// Parts that a course has at most; before its last doubling it had half of them.
const PARTS: usize = 512;

/// Busy clocks of the bus by time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BusCourse {
    /// Clocks of a part: a power of two.
    pub part: Clocks,
    /// Clocks of each part in which the bus served the cores, and in which it served the main processor.
    pub busy: Vec<[u64; 2]>,
}

impl Default for BusCourse {
    fn default() -> BusCourse {
        BusCourse { part: Clocks(1), busy: Vec::new() }
    }
}

impl BusCourse {
    /// Adds a burst on a machine whose main processor has this number.
    pub(super) fn grant(&mut self, main: u32, grant: &Grant) {
        self.add(grant.master == main, grant.start, grant.end);
    }

    /// Adds a burst.
    ///
    /// With parts of 4 clocks a burst from clock 6 to 13 adds 2 to the second part, 4 to the third and 1 to the fourth.
    pub fn add(&mut self, is_main: bool, start: Clocks, end: Clocks) {
        while end.0.div_ceil(self.part.0) > PARTS as u64 {
            self.double();
        }
        let last = end.0.div_ceil(self.part.0) as usize;
        if self.busy.len() < last {
            self.busy.resize(last, [0; 2]);
        }
        let mut from = start.0;
        while from < end.0 {
            let at = from / self.part.0;
            let until = end.0.min((at + 1) * self.part.0);
            self.busy[at as usize][usize::from(is_main)] += until - from;
            from = until;
        }
    }

    /// Makes parts of twice the length.
    fn double(&mut self) {
        let sum = |pair: &[[u64; 2]]| pair.iter().fold([0; 2], |sum: [u64; 2], one| [sum[0] + one[0], sum[1] + one[1]]);
        self.busy = self.busy.chunks(2).map(sum).collect();
        self.part = Clocks(2 * self.part.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_have_the_clocks_of_their_bursts() {
        let mut course = BusCourse { part: Clocks(4), busy: Vec::new() };
        course.add(false, Clocks(6), Clocks(13));
        course.add(true, Clocks(13), Clocks(14));
        assert_eq!(course.busy, [[0, 0], [2, 0], [4, 0], [1, 1]]);
    }

    #[test]
    fn long_frames_keep_all_clocks_in_few_parts() {
        let mut course = BusCourse::default();
        let bursts = (0..10_000u64).map(|k| (k % 3 == 0, 17 * k, 17 * k + 1 + k % 11));
        let mut wanted = [0; 2];
        for (is_main, start, end) in bursts {
            course.add(is_main, Clocks(start), Clocks(end));
            wanted[usize::from(is_main)] += end - start;
        }
        assert!((PARTS / 2..=PARTS).contains(&course.busy.len()), "{}", course.busy.len());
        let sum = |of: usize| course.busy.iter().map(|part| part[of]).sum::<u64>();
        assert_eq!([sum(0), sum(1)], wanted);
        assert!(course.busy.iter().all(|part| part[0] + part[1] <= course.part.0));
    }
}
