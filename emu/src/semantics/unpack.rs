//! Numbers that stand bit behind bit: what the rows of the bus make of the octets that they move. The first bit is the lowest of the first octet,
//! and a number begins with its lowest bit.

/// Octets that are read at once: a number begins somewhere in the first of them.
const WINDOW: usize = 16;

/// Octets that need no place of their own on the host's heap: those of 128 words.
const SHORT: usize = 512;

/// Octets that were moved, with some behind them so that each number is one read.
pub(super) struct Moved {
    short: [u8; SHORT + WINDOW],
    /// The octets, where they are many.
    long: Vec<u8>,
    length: usize,
}

impl Moved {
    /// Room for `length` octets.
    pub fn new(length: usize) -> Moved {
        let long = if length <= SHORT { Vec::new() } else { vec![0; length + WINDOW] };
        Moved { short: [0; SHORT + WINDOW], long, length }
    }

    /// The octets themselves.
    pub fn octets(&mut self) -> &mut [u8] {
        let octets = if self.long.is_empty() { &mut self.short[..] } else { &mut self.long };
        &mut octets[..self.length]
    }

    /// The octets with those behind them.
    pub fn padded(&self) -> &[u8] {
        if self.long.is_empty() { &self.short } else { &self.long }
    }
}

/// The number of `bits` bits, at most 63, at bit `at`.
#[inline]
pub(super) fn unsigned(octets: &[u8], at: usize, bits: u32) -> u64 {
    // 63 bits from bit 7 of an octet on end in the ninth octet, so that a window of 16 has them all.
    let window = octets[at / 8..].first_chunk::<WINDOW>().map_or(0, |window| u128::from_le_bytes(*window));
    (window >> (at % 8)) as u64 & ((1 << bits) - 1)
}

/// The number of `bits` bits in two's complement, the low 32 bits of it.
#[inline]
pub(super) fn signed(octets: &[u8], at: usize, bits: u32) -> i32 {
    if bits == 0 {
        return 0;
    }
    let unused = u64::BITS - bits;
    ((unsigned(octets, at, bits) << unused) as i64 >> unused) as i32
}

/// Bits of the two fields of a node.
#[derive(Clone, Copy)]
pub(super) struct NodeWidths {
    plane: u32,
    link: u32,
}

impl NodeWidths {
    pub fn new(plane: i32, link: i32) -> NodeWidths {
        NodeWidths { plane: plane as u32, link: link as u32 }
    }

    /// Octets of a node in global memory.
    pub fn octets(self) -> u32 {
        (self.plane + self.link).div_ceil(8)
    }

    /// Address of the node of a name; beyond all addresses the last one, where no node is.
    pub fn address(self, name: u32) -> u32 {
        (name >> 3).saturating_mul(self.octets())
    }

    /// Plane and link of the node at bit `at`, the link as rows that walk take it.
    #[inline]
    pub fn node(self, octets: &[u8], at: usize) -> [i32; 2] {
        let link = unsigned(octets, at + self.plane as usize, self.link) as u32;
        // An eighth above a tag of two bits: the link 1111 is the pattern 11011, a leaf whose references begin at 24.
        [signed(octets, at, self.plane), (link >> 2 << 3 | link & 3) as i32]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number bit by bit.
    fn listed(octets: &[u8], at: usize, bits: u32) -> u64 {
        (0..bits as usize).map(|k| u64::from(octets[(at + k) / 8] >> ((at + k) % 8) & 1) << k).sum()
    }

    #[test]
    fn numbers_of_all_widths_are_read_at_all_bits() {
        let mut moved = Moved::new(40);
        // An odd multiplier makes octets that repeat only after 256 of them.
        moved.octets().iter_mut().zip(1u8..).for_each(|(octet, at)| *octet = at.wrapping_mul(0x9d));
        for bits in 0..=63 {
            for at in 0..200 {
                let wanted = listed(moved.padded(), at, bits);
                assert_eq!(unsigned(moved.padded(), at, bits), wanted, "{bits} bits at {at}");
                let negative = bits > 0 && wanted >> (bits - 1) == 1;
                let wanted = i128::from(wanted) - if negative { 1 << bits } else { 0 };
                assert_eq!(signed(moved.padded(), at, bits), wanted as i32, "{bits} signed bits at {at}");
            }
        }
    }

    #[test]
    fn many_octets_are_as_few() {
        let mut moved = Moved::new(SHORT + 1);
        moved.octets()[SHORT] = 0x80;
        assert_eq!((moved.padded().len(), signed(moved.padded(), 8 * SHORT, 8)), (SHORT + 1 + WINDOW, -128));
    }

    #[test]
    fn nodes_are_patterns() {
        let widths = NodeWidths::new(3, 4);
        assert_eq!((widths.octets(), widths.address(128), widths.address(135)), (1, 16, 16));
        let mut moved = Moved::new(1);
        moved.octets()[0] = 0b0111_1010;
        assert_eq!(widths.node(moved.padded(), 0), [2, 0b11011]);
        // An eighth of all names times 8 octets still has 32 bits; times 9 it has more.
        assert_eq!(NodeWidths::new(32, 31).address(u32::MAX), 0xffff_fff8);
        assert_eq!(NodeWidths::new(32, 33).address(u32::MAX), u32::MAX);
    }
}
