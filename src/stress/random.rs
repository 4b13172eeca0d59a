//! Numbers that look random and are the same on every run: each trial of a case begins a series of its own.

/// A series of numbers (SplitMix64).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The series of a trial.
    pub fn new(seed: u64, trial: u64) -> Random {
        let mut random = Random(seed ^ trial.wrapping_mul(0xd134_2543_de82_ef95));
        random.next();
        random
    }

    /// 64 bits.
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    /// A number from -reach to reach.
    pub fn coordinate(&mut self, reach: i32) -> i32 {
        (self.next() % (2 * reach as u64 + 1)) as i64 as i32 - reach
    }

    /// Three of them.
    pub fn point(&mut self, reach: i32) -> [i32; 3] {
        std::array::from_fn(|_| self.coordinate(reach))
    }

    /// A number in [-1, 1).
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// A direction of length 1, all equally likely.
    pub fn direction(&mut self) -> [f64; 3] {
        loop {
            let lanes = [self.unit(), self.unit(), self.unit()];
            let square = lanes.iter().map(|x| x * x).sum::<f64>();
            if square > 0.01 && square <= 1.0 {
                return lanes.map(|x| x / square.sqrt());
            }
        }
    }
}
