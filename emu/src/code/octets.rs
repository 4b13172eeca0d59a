//! Octets that programs address: a core's local buffer and the global memory. Who may touch them when is not said here.

mod memory;

use isa::number::Vector;

pub use memory::Memory;

use crate::code::trap::Fault;

/// Octet of a buffer that nobody has written: a pattern that stands out in a dump.
pub const POISON: u8 = 0xa5;

/// Range of `length` octets from `address` on in something of `size` octets; `None` where they do not fit.
#[inline]
fn range(address: u32, length: u32, size: usize) -> Option<std::ops::Range<usize>> {
    let start = address as usize;
    let end = start.checked_add(length as usize)?;
    (end <= size).then_some(start..end)
}

/// Words of 32 bits, of as many octets.
#[inline(always)]
pub(crate) fn words_of<const N: usize>(octets: &[u8]) -> [i32; N] {
    let (words, _) = octets.as_chunks::<4>();
    std::array::from_fn(|at| i32::from_le_bytes(words[at]))
}

/// The local buffer of a core: octet addresses from 0, little-endian, any alignment.
#[derive(Clone, Debug)]
pub struct Buffer {
    octets: Vec<u8>,
    /// Pieces that were written since the buffer was made or last reset, a bit each.
    written: u64,
    /// A piece has 2^this octets, so that there are at most 64.
    piece: u32,
}

impl PartialEq for Buffer {
    fn eq(&self, other: &Buffer) -> bool {
        self.octets == other.octets
    }
}

impl Eq for Buffer {}

impl Buffer {
    /// A buffer of `size` octets that starts with `image` and is poisoned beyond it; an image that is too long is cut.
    pub fn new(image: &[u8], size: u32) -> Buffer {
        let mut octets = image[..image.len().min(size as usize)].to_vec();
        octets.resize(size as usize, POISON);
        Buffer { octets, written: 0, piece: Buffer::piece_bits(size) }
    }

    /// The pieces of a buffer of `size` octets have 2^this octets, so that there are at most 64.
    pub(crate) const fn piece_bits(size: u32) -> u32 {
        (u32::BITS - size.leading_zeros()).saturating_sub(6)
    }

    /// The pieces that some octets lie in, of which there are any, a bit each.
    #[inline]
    pub(crate) const fn pieces(piece: u32, start: usize, octets: usize) -> u64 {
        let (first, last) = (start >> piece, (start + octets - 1) >> piece);
        u64::MAX >> (63 - (last - first)) << first
    }

    /// The first octet, for an engine that notes by [`Buffer::note_pieces`] what it writes.
    #[cfg(feature = "native")]
    pub(crate) fn start_mut(&mut self) -> *mut u8 {
        self.octets.as_mut_ptr()
    }

    /// Notes that pieces were written.
    #[cfg(feature = "native")]
    pub(crate) fn note_pieces(&mut self, pieces: u64) {
        self.written |= pieces;
    }

    /// A buffer that is allocated when it is reset to one of that many octets.
    pub(crate) fn unallocated() -> Buffer {
        Buffer::new(&[], 0)
    }

    /// Makes it equal again to the one that it was cloned from, which nobody has written to: only what was written is copied. One that was not
    /// allocated yet becomes a copy.
    pub fn reset_to(&mut self, initial: &Buffer) {
        if self.octets.len() != initial.octets.len() {
            *self = initial.clone();
            return;
        }
        let mut written = std::mem::take(&mut self.written);
        while written != 0 {
            let start = (written.trailing_zeros() as usize) << self.piece;
            let end = (start + (1 << self.piece)).min(self.octets.len());
            self.octets[start..end].copy_from_slice(&initial.octets[start..end]);
            written &= written - 1;
        }
        debug_assert!(*self == *initial, "it is reset to what it was made from");
    }

    /// Notes that octets are written, which lie in it; there may be none.
    #[inline]
    fn note_written(&mut self, start: usize, octets: usize) {
        if octets != 0 {
            self.written |= Buffer::pieces(self.piece, start, octets);
        }
    }

    /// All octets.
    pub fn octets(&self) -> &[u8] {
        &self.octets
    }

    fn fault(&self, address: u32, octets: u32) -> Fault {
        Fault::Buffer { address, octets, size: self.octets.len() as u32 }
    }

    /// `N` octets from `address` on.
    ///
    /// # Errors
    /// A range that leaves the buffer.
    #[inline]
    pub fn get<const N: usize>(&self, address: u32) -> Result<[u8; N], Fault> {
        let start = address as usize;
        let slice = self.octets.get(start..start + N).and_then(|slice| slice.first_chunk());
        slice.copied().ok_or_else(|| self.fault(address, N as u32))
    }

    /// Writes `N` octets from `address` on.
    ///
    /// # Errors
    /// A range that leaves the buffer; nothing is written then.
    #[inline]
    pub fn put<const N: usize>(&mut self, address: u32, octets: [u8; N]) -> Result<(), Fault> {
        let start = address as usize;
        match self.octets.get_mut(start..start + N) {
            Some(slice) => slice.copy_from_slice(&octets),
            None => return Err(self.fault(address, N as u32)),
        }
        self.note_written(start, N);
        Ok(())
    }

    /// The 32 bits at `address`.
    ///
    /// # Errors
    /// A range that leaves the buffer.
    #[inline]
    pub fn word(&self, address: u32) -> Result<i32, Fault> {
        Ok(i32::from_le_bytes(self.get(address)?))
    }

    /// The three words of 32 bits at `address`.
    ///
    /// # Errors
    /// A range that leaves the buffer.
    #[inline]
    pub fn vector(&self, address: u32) -> Result<Vector, Fault> {
        let octets: [u8; 12] = self.get(address)?;
        Ok(std::array::from_fn(|k| i32::from_le_bytes(std::array::from_fn(|at| octets[4 * k + at]))))
    }

    /// Writes three words of 32 bits at `address`.
    ///
    /// # Errors
    /// A range that leaves the buffer.
    #[inline]
    pub fn put_vector(&mut self, address: u32, vector: Vector) -> Result<(), Fault> {
        let octets: [u8; 12] = std::array::from_fn(|at| vector[at / 4].to_le_bytes()[at % 4]);
        self.put(address, octets)
    }

    /// `length` octets from `address` on.
    ///
    /// # Errors
    /// A range that leaves the buffer.
    pub fn slice(&self, address: u32, length: u32) -> Result<&[u8], Fault> {
        match range(address, length, self.octets.len()) {
            Some(range) => Ok(&self.octets[range]),
            None => Err(self.fault(address, length)),
        }
    }

    /// `length` octets from `address` on, to write.
    ///
    /// # Errors
    /// A range that leaves the buffer.
    pub fn slice_mut(&mut self, address: u32, length: u32) -> Result<&mut [u8], Fault> {
        match range(address, length, self.octets.len()) {
            Some(range) => {
                self.note_written(range.start, range.len());
                Ok(&mut self.octets[range])
            }
            None => Err(self.fault(address, length)),
        }
    }
}
