//! Protections of words, and what each sees of flipped bits. The codes are computed, not assumed: three flipped bits may look like another one.

use crate::machine::Protection;

/// Clocks after which a request is made again, or a watchdog finds that nothing happens.
pub const RETRY_CLOCKS: u64 = 4_096;

/// Flipped bits behind a protection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeenFlip {
    /// All are put right.
    Corrected,
    /// Something is found to be wrong, and the machine stops.
    Detected,
    /// Nothing is found; these bits of the word are wrong then.
    Passed(u32),
}

/// Check bits of each bit of a word: odd columns of weight 3, as Hsiao (1970) chooses them, so that an even number of flips never looks like one.
const COLUMNS: [u8; 32] = columns();

const fn columns() -> [u8; 32] {
    let (mut found, mut count, mut column) = ([0; 32], 0, 0u8);
    while count < 32 {
        if column.count_ones() == 3 {
            found[count] = column;
            count += 1;
        }
        column += 1;
    }
    found
}

impl Protection {
    /// Flipped bits of a word, of which `change` is what they add to its number.
    ///
    /// A check of remainders sees a change that 3 does not divide: one bit changes a number by a power of 2, two bits in neighbouring places
    /// by 3 times one, or by 1 time.
    pub fn sees(self, mask: u32, change: i128) -> SeenFlip {
        match self {
            Protection::Unprotected => SeenFlip::Passed(mask),
            Protection::Parity if mask.count_ones() % 2 == 1 => SeenFlip::Detected,
            Protection::Parity => SeenFlip::Passed(mask),
            Protection::Secded => seen_by_code(mask),
            Protection::Duplicated if change != 0 => SeenFlip::Detected,
            Protection::Residue if change % 3 != 0 => SeenFlip::Detected,
            Protection::Duplicated | Protection::Residue | Protection::Retry | Protection::Watchdog => {
                SeenFlip::Passed(mask)
            }
        }
    }
}

/// Flipped bits of a word behind the code that corrects one of them.
///
/// Bits 0 and 1 flipped give the check bits 0000111 xor 0001011 = 0001100, an even number, so two are known to be wrong. A third one makes it odd,
/// and if that is the column of a fourth bit, that one is flipped as well.
fn seen_by_code(mask: u32) -> SeenFlip {
    let syndrome = (0..32).filter(|bit| mask >> bit & 1 == 1).fold(0, |sum, bit| sum ^ COLUMNS[bit as usize]);
    if syndrome == 0 {
        return if mask == 0 { SeenFlip::Corrected } else { SeenFlip::Passed(mask) };
    }
    if syndrome.count_ones() % 2 == 0 {
        return SeenFlip::Detected;
    }
    match COLUMNS.iter().position(|&column| column == syndrome) {
        Some(bit) if mask == 1 << bit => SeenFlip::Corrected,
        Some(bit) => SeenFlip::Passed(mask ^ (1 << bit)),
        // A check bit by itself is what one flipped check bit looks like: the word is left as it is.
        None if syndrome.count_ones() == 1 => SeenFlip::Passed(mask),
        None => SeenFlip::Detected,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_code_mends_one_bit_and_finds_two() {
        for one in 0..32 {
            assert_eq!(Protection::Secded.sees(1 << one, 1), SeenFlip::Corrected);
            assert_eq!(Protection::Parity.sees(1 << one, 1), SeenFlip::Detected);
            for other in (0..32).filter(|&other| other != one) {
                let mask = 1 << one | 1 << other;
                assert_eq!(Protection::Secded.sees(mask, 3), SeenFlip::Detected, "{mask:#x}");
                assert_eq!(Protection::Parity.sees(mask, 3), SeenFlip::Passed(mask));
            }
        }
    }

    #[test]
    fn three_bits_are_found_or_made_worse_and_never_mended() {
        let mut passed = 0;
        for mask in (0..u32::MAX >> 12).filter(|mask| mask.count_ones() == 3) {
            match Protection::Secded.sees(mask, 1) {
                SeenFlip::Corrected => panic!("{mask:#x} looks right"),
                SeenFlip::Passed(wrong) => {
                    assert!([2, 3, 4].contains(&wrong.count_ones()), "{mask:#x} {wrong:#x}");
                    passed += 1;
                }
                SeenFlip::Detected => {}
            }
        }
        assert!(passed > 0, "a code of seven bits does not find all");
    }

    #[test]
    fn remainders_find_what_three_does_not_divide() {
        for bit in 0..31 {
            assert_eq!(Protection::Residue.sees(1 << bit, 1 << bit), SeenFlip::Detected);
        }
        assert_eq!(Protection::Residue.sees(0b11, 3), SeenFlip::Passed(0b11));
        assert_eq!(Protection::Residue.sees(0b11, 1), SeenFlip::Detected);
        assert_eq!(Protection::Duplicated.sees(0b11, 3), SeenFlip::Detected);
        assert_eq!(Protection::Unprotected.sees(0b11, 3), SeenFlip::Passed(0b11));
    }
}
