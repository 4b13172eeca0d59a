//! Numbers that look random and are the same on every run: each trial of a case begins a series of its own.

use random::SplitMix64;

/// The series of a trial.
#[derive(Clone, Debug)]
pub struct Random(SplitMix64);

impl Random {
    /// The series of a trial.
    pub fn new(seed: u64, trial: u64) -> Random {
        let mut random = Random(SplitMix64::new(seed ^ trial.wrapping_mul(0xd134_2543_de82_ef95)));
        random.bits();
        random
    }

    /// 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0.bits()
    }

    /// A number below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        (self.bits() % end as u64) as usize
    }

    /// A number from -reach to reach.
    pub fn coordinate(&mut self, reach: i32) -> i32 {
        (self.bits() % (2 * reach as u64 + 1)) as i64 as i32 - reach
    }

    /// Three of them.
    pub fn point(&mut self, reach: i32) -> [i32; 3] {
        std::array::from_fn(|_| self.coordinate(reach))
    }

    /// A number in [-1, 1).
    pub fn unit(&mut self) -> f64 {
        self.0.unit()
    }

    /// A direction of length 1, all equally likely.
    pub fn direction(&mut self) -> [f64; 3] {
        loop {
            let components = [self.unit(), self.unit(), self.unit()];
            let square = components.iter().map(|x| x * x).sum::<f64>();
            if square > 0.01 && square <= 1.0 {
                return components.map(|x| x / square.sqrt());
            }
        }
    }
}
