//! Numbers that look random and are the same on every run.

/// The generator of Steele, Lea and Flood (SplitMix64).
pub struct Random(pub u64);

impl Random {
    /// The next 64 bits.
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
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
