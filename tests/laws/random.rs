//! Numbers that look random and are the same on every run.

use random::SplitMix64;

/// Numbers of operands and words.
pub struct Random(SplitMix64);

impl Random {
    /// The series of a seed.
    pub fn new(seed: u64) -> Random {
        Random(SplitMix64::new(seed))
    }

    /// The next 64 bits.
    pub fn next(&mut self) -> u64 {
        self.0.bits()
    }

    /// A number from `least` to `most`.
    pub fn within(&mut self, least: i64, most: i64) -> i64 {
        let span = (i128::from(most) - i128::from(least) + 1) as u128;
        (i128::from(least) + (u128::from(self.next()) % span) as i128) as i64
    }

    /// A number of at most `bits` bits beside its sign, of any magnitude, the ends and small ones often.
    pub fn signed(&mut self, bits: u32) -> i64 {
        let most = ((1u64 << bits) - 1) as i64;
        let edges = [0, 1, -1, 2, -2, 3, most, -most, most - 1, most / 2, most / 2 + 1, -(most / 2) - 1, -most - 1];
        match self.next() % 4 {
            0 => edges[self.within(0, edges.len() as i64 - 1) as usize],
            _ => {
                let magnitude = self.next() >> (63 - self.within(0, bits.into()) as u32) >> 1;
                if self.next() & 1 == 0 { magnitude as i64 } else { !(magnitude as i64) }
            }
        }
    }
}
