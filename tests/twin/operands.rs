//! Random operands: coordinates, directions and triangles that are often in special positions.

use isa::number::Vector;
use proptest::prelude::*;
use random::SplitMix64;

/// A number of at most `bits` bits and a sign; small ones are as likely as large ones, and powers of two are frequent.
pub fn number(bits: u32) -> impl Strategy<Value = i32> {
    let sized = (any::<i32>(), 32 - bits..32u32).prop_map(|(x, shift)| x >> shift);
    let power = (0..bits, any::<bool>()).prop_map(|(n, is_negative)| if is_negative { -(1 << n) } else { 1 << n });
    prop_oneof![4 => sized, 1 => power, 1 => -3..=3i32]
}

/// A coordinate in -2^bits..2^bits; often one of the few on a coarse grid, so that different ones are equal.
pub fn coordinate(bits: u32) -> impl Strategy<Value = i32> {
    let end = 1 << bits;
    prop_oneof![3 => -end + 1..end, 3 => (-2..=2i32).prop_map(move |n| n << (bits - 2)), 1 => -5..=5i32]
}

/// A point.
pub fn point(bits: u32) -> impl Strategy<Value = Vector> {
    [coordinate(bits), coordinate(bits), coordinate(bits)]
}

/// A direction with `bits` fraction bits, about as long as 1; often in a plane of two axes, along an axis or along a diagonal.
pub fn direction(bits: u32) -> impl Strategy<Value = Vector> {
    let lane = || prop_oneof![4 => -1000..=1000i32, 1 => Just(0), 1 => Just(500), 1 => Just(-500), 1 => -1..=1i32];
    [lane(), lane(), lane()].prop_map(move |lanes| {
        let lanes = if lanes == [0; 3] { [0, 0, -1] } else { lanes };
        let length = lanes.iter().map(|&lane| f64::from(lane).powi(2)).sum::<f64>().sqrt();
        let one = f64::from(1u32 << bits);
        lanes.map(|lane| (f64::from(lane) / length * one).round() as i32)
    })
}

/// The words of vectors and numbers, one after the other.
pub fn words(vectors: &[Vector], numbers: &[i32]) -> Vec<i32> {
    vectors.iter().flatten().chain(numbers).copied().collect()
}

/// The vector that starts at a word.
pub fn vector(words: &[i32], at: usize) -> Vector {
    [words[at], words[at + 1], words[at + 2]]
}

/// Uniform numbers for long series.
pub struct Series(SplitMix64);

impl Series {
    pub fn new(seed: u64) -> Series {
        Series(SplitMix64::new(seed))
    }

    pub fn bits(&mut self) -> u64 {
        self.0.bits()
    }

    /// A number in -1..1.
    pub fn unit(&mut self) -> f64 {
        self.0.unit()
    }

    /// A number in -end..end.
    pub fn within(&mut self, end: i32) -> i32 {
        (self.unit() * f64::from(end)) as i32
    }

    /// A point with coordinates in -end..end.
    pub fn point(&mut self, end: i32) -> Vector {
        [self.within(end), self.within(end), self.within(end)]
    }
}
