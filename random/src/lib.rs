//! Numbers that look random and are the same on every run: the generator of Steele, Lea and Flood (2014), which passes the usual tests of
//! randomness with 64 bits of state. Nothing here is meant for secrets.

/// A series of numbers, given by its seed.
#[derive(Clone, Debug)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// The series of a seed; any seed will do.
    pub const fn new(seed: u64) -> SplitMix64 {
        SplitMix64(seed)
    }

    /// 64 bits.
    pub const fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A number below `end`, which is not 0. Small numbers are likelier by less than `end / 2^64`.
    pub const fn below(&mut self, end: u64) -> u64 {
        self.bits() % end
    }

    /// A multiple of 2^-52 in [-1, 1).
    pub const fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_is_that_of_the_reference() {
        // The first numbers of splitmix64.c (Vigna, 2015) for the seed 1234567.
        let mut series = SplitMix64::new(1_234_567);
        assert_eq!([series.bits(), series.bits()], [6_457_827_717_110_365_317, 3_203_168_211_198_807_973]);
    }

    #[test]
    fn numbers_stay_in_their_range() {
        let mut series = SplitMix64::new(1);
        for end in 1..1000 {
            assert!(series.below(end) < end);
            assert!((-1.0..1.0).contains(&series.unit()));
        }
    }
}
