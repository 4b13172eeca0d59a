//! Global memory, of which copies share what nobody has written: machines that run side by side, and what runs ahead of them, hold the
//! scene once and the pixels each for itself.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use super::words_of;
use crate::code::trap::Fault;

/// Octets that are copied together where a copy is written to.
const PAGE: usize = 4096;

/// Global memory: octet addresses from 0, little-endian, any alignment. A copy costs nothing but the pages that are then written.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    /// Octets where there is no page.
    shared: Arc<Vec<u8>>,
    /// Pages that were written while there were copies: none at all, or a place for each.
    pages: Vec<Option<Box<[u8; PAGE]>>>,
}

impl PartialEq for Memory {
    fn eq(&self, other: &Memory) -> bool {
        self.octets() == other.octets()
    }
}

impl Eq for Memory {}

/// A range of addresses that lie one behind the other in `page` from `offset` on.
struct Piece {
    page: usize,
    offset: usize,
    length: usize,
}

/// The pieces of `length` octets from `start` on.
fn pieces(start: usize, length: usize) -> impl Iterator<Item = Piece> {
    let end = start + length;
    let mut at = start;
    std::iter::from_fn(move || {
        // A piece ends with its page or with the range. Octets 4090 to 4109 are 6 in page 0 and 14 in page 1.
        let (page, offset) = (at / PAGE, at % PAGE);
        let length = (PAGE - offset).min(end - at);
        at += length;
        (length > 0).then_some(Piece { page, offset, length })
    })
}

impl Memory {
    /// Memory that holds an image and nothing else.
    pub fn new(image: Vec<u8>) -> Memory {
        Memory { shared: Arc::new(image), pages: Vec::new() }
    }

    /// Number of octets.
    pub fn size(&self) -> usize {
        self.shared.len()
    }

    /// Octets that this copy has for itself, beside those that it shares or may share.
    #[cfg(test)]
    fn own_octets(&self) -> usize {
        self.pages.iter().flatten().count() * PAGE
    }

    /// All octets; they are copied where pages were written.
    pub fn octets(&self) -> Cow<'_, [u8]> {
        self.cut(0..self.size())
    }

    #[inline(always)]
    fn range(&self, address: u32, length: usize) -> Result<Range<usize>, Fault> {
        let size = self.shared.len();
        let start = address as usize;
        match start.checked_add(length) {
            Some(end) if end <= size => Ok(start..end),
            _ => Err(Fault::Memory { address, octets: length as u32, size: size as u64 }),
        }
    }

    /// Check that the memory has `length` octets from `address` on.
    ///
    /// # Errors
    /// A range that leaves the memory.
    #[inline(always)]
    pub fn holds(&self, address: u32, length: u32) -> Result<(), Fault> {
        match self.range(address, length as usize) {
            Ok(_) => Ok(()),
            Err(fault) => Err(fault),
        }
    }

    /// `length` octets from `address` on; they are copied where pages were written.
    ///
    /// # Errors
    /// A range that leaves the memory.
    pub fn slice(&self, address: u32, length: u32) -> Result<Cow<'_, [u8]>, Fault> {
        Ok(self.cut(self.range(address, length as usize)?))
    }

    fn cut(&self, range: Range<usize>) -> Cow<'_, [u8]> {
        if self.pages.is_empty() {
            return Cow::Borrowed(&self.shared[range]);
        }
        let mut octets = vec![0; range.len()];
        self.gather(range.start, &mut octets);
        Cow::Owned(octets)
    }

    /// `length` octets from `address` on where no pages were written; `None` also outside the memory.
    #[inline(always)]
    pub fn peek(&self, address: u32, length: u32) -> Option<&[u8]> {
        let range = self.range(address, length as usize).ok()?;
        self.pages.is_empty().then(|| &self.shared[range])
    }

    /// Reads octets from `address` on.
    ///
    /// # Errors
    /// A range that leaves the memory; nothing is read then.
    #[inline]
    pub fn read(&self, address: u32, octets: &mut [u8]) -> Result<(), Fault> {
        let range = self.range(address, octets.len())?;
        match self.pages.is_empty() {
            true => octets.copy_from_slice(&self.shared[range]),
            false => self.gather(range.start, octets),
        }
        Ok(())
    }

    /// Octets that lie in one page.
    #[inline]
    fn in_page(&self, start: usize, length: usize) -> Option<&[u8]> {
        let (page, offset) = (start / PAGE, start % PAGE);
        if offset + length > PAGE {
            return None;
        }
        match self.pages.get(page)? {
            Some(page) => page.get(offset..offset + length),
            None => self.shared.get(start..start + length),
        }
    }

    /// Reads octets that may lie in pages.
    #[inline(never)]
    fn gather(&self, start: usize, octets: &mut [u8]) {
        if let Some(found) = self.in_page(start, octets.len()) {
            return octets.copy_from_slice(found);
        }
        let mut at = 0;
        for Piece { page, offset, length } in pieces(start, octets.len()) {
            octets[at..at + length].copy_from_slice(match &self.pages[page] {
                Some(page) => &page[offset..offset + length],
                None => &self.shared[start + at..][..length],
            });
            at += length;
        }
    }

    /// Writes octets from `address` on.
    ///
    /// # Errors
    /// A range that leaves the memory; nothing is written then.
    pub fn write(&mut self, address: u32, octets: &[u8]) -> Result<(), Fault> {
        let range = self.range(address, octets.len())?;
        if self.pages.is_empty() {
            // Without other copies nobody sees the change, so a frame that runs alone never pays for pages.
            if let Some(alone) = Arc::get_mut(&mut self.shared) {
                alone[range].copy_from_slice(octets);
                return Ok(());
            }
            self.pages.resize_with(self.shared.len().div_ceil(PAGE), || None);
        }
        let mut at = 0;
        for Piece { page, offset, length } in pieces(range.start, octets.len()) {
            let shared = &self.shared[page * PAGE..];
            let page = self.pages[page].get_or_insert_with(|| {
                // The last page may be short; octets behind the memory are never read, because ranges are checked.
                let mut copy = Box::new([0; PAGE]);
                let length = shared.len().min(PAGE);
                copy[..length].copy_from_slice(&shared[..length]);
                copy
            });
            page[offset..offset + length].copy_from_slice(&octets[at..at + length]);
            at += length;
        }
        Ok(())
    }

    /// The 32 bits at `address`.
    ///
    /// # Errors
    /// A range that leaves the memory.
    pub fn word(&self, address: u32) -> Result<i32, Fault> {
        let mut octets = [0; 4];
        self.read(address, &mut octets)?;
        Ok(i32::from_le_bytes(octets))
    }

    /// Reads words of 32 bits from `address` on.
    ///
    /// # Errors
    /// A range that leaves the memory; nothing is read then.
    #[inline(always)]
    pub fn read_words(&self, address: u32, words: &mut [i32]) -> Result<(), Fault> {
        let range = self.range(address, 4 * words.len())?;
        if !self.pages.is_empty() {
            return self.gather_words(address, words);
        }
        let (octets, _) = self.shared[range].as_chunks::<4>();
        for (word, &octets) in words.iter_mut().zip(octets) {
            *word = i32::from_le_bytes(octets);
        }
        Ok(())
    }

    /// The `N` words of 32 bits from `address` on.
    ///
    /// # Errors
    /// A range that leaves the memory.
    #[inline(always)]
    pub fn words<const N: usize>(&self, address: u32) -> Result<[i32; N], Fault> {
        let range = self.range(address, 4 * N)?;
        if !self.pages.is_empty() {
            // They have a place of their own, so that in the other case they need none in the host's memory.
            let mut words = [0; N];
            self.gather_words(address, &mut words)?;
            return Ok(words);
        }
        Ok(words_of(&self.shared[range]))
    }

    #[inline(never)]
    fn gather_words(&self, address: u32, words: &mut [i32]) -> Result<(), Fault> {
        if let Some(found) = self.in_page(address as usize, 4 * words.len()) {
            let (octets, _) = found.as_chunks::<4>();
            words.iter_mut().zip(octets).for_each(|(word, &octets)| *word = i32::from_le_bytes(octets));
            return Ok(());
        }
        words.iter_mut().zip((address..).step_by(4)).try_for_each(|(word, address)| {
            *word = self.word(address)?;
            Ok(())
        })
    }

    /// Writes words of 32 bits from `address` on.
    ///
    /// # Errors
    /// A range that leaves the memory; nothing is written then.
    pub fn put_words(&mut self, address: u32, words: &[i32]) -> Result<(), Fault> {
        self.range(address, 4 * words.len())?;
        words
            .iter()
            .zip((address..).step_by(4))
            .try_for_each(|(word, address)| self.write(address, &word.to_le_bytes()))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;

    /// Octets of a memory that has no whole number of pages.
    const SIZE: usize = 3 * PAGE + 100;

    fn image() -> Vec<u8> {
        (0..SIZE).map(|at| ((at * 37) >> 3) as u8).collect()
    }

    #[test]
    fn a_copy_takes_the_pages_that_are_written() {
        let first = Memory::new(image());
        let mut copy = first.clone();
        assert_eq!(copy.own_octets(), 0);
        copy.write(PAGE as u32 - 1, &[7, 8]).unwrap();
        copy.put_words(SIZE as u32 - 4, &[-1]).unwrap();
        assert_eq!((copy.own_octets(), first.own_octets()), (3 * PAGE, 0));
        assert_eq!(first.octets(), image(), "the other one keeps what it was");
        let across = [first.octets()[PAGE - 2], 7, 8, first.octets()[PAGE + 1]];
        assert_eq!(copy.slice(PAGE as u32 - 2, 4).unwrap().as_ref(), across);
        assert_eq!(copy.word(SIZE as u32 - 4), Ok(-1));
        drop(first);
        copy.write(2 * PAGE as u32, &[1]).unwrap();
        assert_eq!(copy.slice(PAGE as u32, 1).unwrap().as_ref(), [8], "pages stay when the other one has gone");
    }

    #[test]
    fn one_without_copies_is_written_in_its_place() {
        let mut memory = Memory::new(image());
        memory.write(5, &[1, 2, 3]).unwrap();
        drop(memory.clone());
        memory.write(PAGE as u32, &[4]).unwrap();
        assert_eq!(memory.peek(4, 4), Some(&[memory.octets()[4], 1, 2, 3][..]));
        assert_eq!((memory.peek(SIZE as u32 - 7, 8), memory.peek(u32::MAX, 1)), (None, None));
        assert_eq!((memory.own_octets(), memory.octets().into_owned()[5..8].to_vec()), (0, vec![1, 2, 3]));
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 200, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

        #[test]
        fn it_is_a_list_of_octets_whoever_shares_it(
            accesses in prop::collection::vec((0..SIZE as u32 + 8, 0usize..40, any::<bool>(), any::<u8>(), 0usize..3), 0..60),
        ) {
            // Three copies of one memory, and what each should hold.
            let first = Memory::new(image());
            let mut copies = [first.clone(), first.clone(), first].map(|memory| (memory, image()));
            for (address, length, is_write, octet, which) in accesses {
                let (memory, model) = &mut copies[which];
                let range = address as usize..address as usize + length;
                let is_inside = range.end <= SIZE;
                if is_write {
                    let octets = vec![octet; length];
                    prop_assert_eq!(memory.write(address, &octets).is_ok(), is_inside);
                    if is_inside {
                        model[range].copy_from_slice(&octets);
                    }
                } else {
                    let mut octets = vec![0; length];
                    prop_assert_eq!(memory.read(address, &mut octets).is_ok(), is_inside);
                    prop_assert_eq!(memory.holds(address, length as u32).is_ok(), is_inside);
                    let peek = memory.peek(address, length as u32);
                    prop_assert_eq!(peek, (is_inside && memory.pages.is_empty()).then(|| &model[range.clone()]));
                    let words: Result<[i32; 9], Fault> = memory.words(address);
                    let mut listed = [0; 9];
                    prop_assert_eq!(memory.read_words(address, &mut listed).map(|()| listed), words);
                    if is_inside {
                        prop_assert_eq!(&octets, &model[range.clone()]);
                        prop_assert_eq!(memory.slice(address, length as u32).unwrap(), &model[range.clone()]);
                        let mut words = vec![0; length / 4];
                        memory.read_words(address, &mut words).unwrap();
                        let (wanted, _) = model[range].as_chunks::<4>();
                        prop_assert!(words.iter().zip(wanted).all(|(word, octets)| word.to_le_bytes() == *octets));
                    }
                }
            }
            for (memory, model) in copies {
                prop_assert_eq!(memory.octets(), model.as_slice());
                prop_assert_eq!(memory.octets().into_owned(), model);
            }
        }
    }
}
