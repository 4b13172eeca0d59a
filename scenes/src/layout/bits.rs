//! Integers of any number of bits in octets: the first bit is the lowest of the first octet, and an integer begins with its lowest bit.

/// Bits in two's complement that hold all of `values`: 1 for 0 and -1.
pub fn signed_bits(values: impl IntoIterator<Item = i64>) -> u32 {
    // The magnitude without the sign: of -4 = ...11100 it is 11, two bits; 4 = 100 takes three. One more is the sign.
    let magnitude = values.into_iter().fold(0u64, |bits, value| bits | (value ^ (value >> 63)) as u64);
    u64::BITS - magnitude.leading_zeros() + 1
}

/// Bits without a sign that hold a number, at least 1.
pub const fn unsigned_bits(largest: u64) -> u32 {
    u64::BITS - (largest | 1).leading_zeros()
}

/// Writes the low `bits` bits of a value from bit `at` of the octets on; what stands beside them stays.
///
/// # Panics
/// Octets that end before the value does.
pub fn put_bits(octets: &mut [u8], at: usize, bits: u32, value: i64) {
    if at.is_multiple_of(8) && bits.is_multiple_of(8) {
        let length = bits as usize / 8;
        octets[at / 8..][..length].copy_from_slice(&value.to_le_bytes()[..length]);
        return;
    }
    // 12 bits from bit 20 on are the upper 4 of the third octet, and the fourth one: 0xabc becomes c0 and ab.
    let (mut at, mut left, mut value) = (at, bits, value as u64);
    while left > 0 {
        let offset = (at % 8) as u32;
        let here = (8 - offset).min(left);
        let mask = (((1u32 << here) - 1) << offset) as u8;
        let octet = &mut octets[at / 8];
        *octet = *octet & !mask | (value << offset) as u8 & mask;
        value >>= here;
        (at, left) = (at + here as usize, left - here);
    }
}

/// The integer of `bits` bits from bit `at` of the octets on, extended by its sign where it has one.
///
/// # Panics
/// Octets that end before the integer does, and more than 63 bits.
pub fn bits_at(octets: &[u8], at: usize, bits: u32, is_signed: bool) -> i64 {
    let (mut value, mut done) = (0u64, 0);
    while done < bits {
        let offset = ((at + done as usize) % 8) as u32;
        let here = (8 - offset).min(bits - done);
        let piece = u64::from(octets[(at + done as usize) / 8] >> offset) & ((1 << here) - 1);
        value |= piece << done;
        done += here;
    }
    let unused = u64::BITS - bits;
    // The octets f8 ff as 16 bits with a sign are -8, without one 65,528.
    if is_signed { (value << unused) as i64 >> unused } else { value as i64 }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;

    #[test]
    fn widths_are_the_least_that_hold() {
        for (values, bits) in
            [(&[][..], 1), (&[0], 1), (&[-1], 1), (&[1], 2), (&[-2, 1], 2), (&[-3], 3), (&[3, -4], 3), (&[4], 4)]
        {
            assert_eq!(signed_bits(values.iter().copied()), bits, "{values:?}");
        }
        assert_eq!(signed_bits([i64::from(i32::MIN), 0]), 32);
        assert_eq!([0, 1, 2, 3, 4, 255, 256].map(unsigned_bits), [1, 1, 2, 2, 3, 8, 9]);
    }

    #[test]
    fn bits_run_from_the_lowest_up() {
        let mut octets = [0xff; 4];
        put_bits(&mut octets, 4, 12, 0x0abc);
        assert_eq!(octets, [0xcf, 0xab, 0xff, 0xff]);
        assert_eq!((bits_at(&octets, 4, 12, false), bits_at(&octets, 4, 12, true)), (0xabc, 0xabc - 0x1000));
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 300, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

        /// Against octets as a list of single bits.
        #[test]
        fn what_is_put_is_there(octets in prop::collection::vec(any::<u8>(), 12), at in 0usize..40, bits in 1u32..=56, value: i64) {
            let listed = |octets: &[u8]| -> Vec<bool> { (0..96).map(|k| octets[k / 8] >> (k % 8) & 1 == 1).collect() };
            let mut wanted = listed(&octets);
            (0..bits as usize).for_each(|k| wanted[at + k] = value >> k & 1 == 1);
            let mut found = octets.clone();
            put_bits(&mut found, at, bits, value);
            prop_assert_eq!(listed(&found), wanted);
            let kept = i128::from(value).rem_euclid(1 << bits);
            prop_assert_eq!(i128::from(bits_at(&found, at, bits, false)), kept);
            let signed = if kept >> (bits - 1) == 1 { kept - (1 << bits) } else { kept };
            prop_assert_eq!(i128::from(bits_at(&found, at, bits, true)), signed);
        }
    }
}
