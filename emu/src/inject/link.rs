//! Link of a work item that may go wrong in any way: it reads a memory of its own, what it writes and sends is kept, and words on the bus
//! may flip. Nobody else is there, and whatever it would wait for never comes.

use std::ops::Range;

use crate::code::octets::{Buffer, Memory};
use crate::code::trap::{Fault, Stop};
use crate::semantics::{Link, Message};

/// Word on the bus that flipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BusWord {
    /// Address of a transfer.
    Address,
    /// Word of global memory that was read, by its address.
    Data(u32),
    /// Word of the message that began the work item, or of one that it sent.
    Message,
}

/// Transfers of a work item, messages among them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ItemTraffic {
    /// Transfers.
    pub transfers: u64,
    /// Octets of data.
    pub octets: u64,
    /// Words on the bus: addresses, and data in words of 32 bits, the last of which may be filled in part.
    pub words: u64,
}

/// The machine as a work item sees it.
pub(super) struct ItemLink<'n> {
    /// Global memory.
    pub memory: Memory,
    /// Blocks that it wrote, in order.
    pub writes: Vec<(u32, Vec<u8>)>,
    /// The message that begins the work item, until it is taken.
    pub message: Option<Message>,
    /// Number of the main processor, which is the number of cores.
    pub main: u32,
    /// Messages that it sent, with their receivers.
    pub sent: Vec<(u32, Message)>,
    /// Traffic so far.
    pub traffic: ItemTraffic,
    /// Words of the traffic that flip, and the bits.
    pub flips: Vec<(u64, u32)>,
    /// Word of the traffic whose transfer's data are kept.
    pub kept_at: Option<u64>,
    /// Data of the transfer at `kept_at`, with the number of their first word in the traffic.
    pub kept: Option<(u64, Vec<u32>)>,
    /// The word that did.
    pub met: Option<BusWord>,
    /// Blocks that it reads, where somebody wants to know.
    pub reads: Option<&'n mut Vec<(u32, u32)>>,
}

impl ItemLink<'_> {
    /// Takes note of a transfer, and yields its words: an address, where it has one, and its data.
    fn pass(&mut self, octets: u32, has_address: bool) -> Range<u64> {
        let first = self.traffic.words;
        self.traffic.transfers += 1;
        self.traffic.octets += u64::from(octets);
        self.traffic.words += u64::from(octets.div_ceil(4)) + u64::from(has_address);
        first..self.traffic.words
    }

    /// Address of a read that arrives at memory, and the words of its data.
    fn ask(&mut self, address: u32, octets: u32) -> (u32, Range<u64>) {
        let Range { start, end } = self.pass(octets, true);
        let wrong = self.flips.iter().find(|(at, _)| *at == start);
        let address = wrong.map_or(address, |(_, mask)| address ^ mask);
        if wrong.is_some() {
            self.met = Some(BusWord::Address);
        }
        if let Some(reads) = &mut self.reads {
            reads.push((address, octets));
        }
        (address, start + 1..end)
    }

    /// Octets that were read from an address arrive as the bus leaves them; bits behind the last octet are on no wire.
    fn arrive(&mut self, address: u32, words: &Range<u64>, octets: &mut [u8]) {
        for &(at, mask) in self.flips.iter().filter(|(at, _)| words.contains(at)) {
            let place = 4 * (at - words.start) as usize;
            self.met = Some(BusWord::Data(address.wrapping_add(place as u32)));
            for (octet, bits) in octets.iter_mut().skip(place).zip(mask.to_le_bytes()) {
                *octet ^= bits;
            }
        }
        if self.kept_at.is_some_and(|at| at + 1 == words.start || words.contains(&at)) {
            let word = |octets: &[u8]| octets.iter().rev().fold(0, |word, &octet| word << 8 | u32::from(octet));
            self.kept = Some((words.start, octets.chunks(4).map(word).collect()));
        }
    }

    fn message(&mut self, message: Message) -> Message {
        let words = self.pass(message.octets(), false);
        if self.kept_at.is_some_and(|at| words.contains(&at)) {
            let sent = message.vectors().iter().flatten().map(|&component| component as u32);
            self.kept = Some((words.start, sent.collect()));
        }
        let mut arrived = message;
        for &(at, mask) in self.flips.iter().filter(|(at, _)| words.contains(at)) {
            self.met = Some(BusWord::Message);
            arrived = arrived.flipped((at - words.start) as usize, mask);
        }
        arrived
    }

    /// True where a transfer's words concern somebody: most do not, and are spared the way through octets.
    fn is_looked_at(&self, words: &Range<u64>) -> bool {
        let is_it = |at: u64| at + 1 == words.start || words.contains(&at);
        self.kept_at.is_some_and(is_it) || self.flips.iter().any(|(at, _)| is_it(*at))
    }

    fn write_octets(&mut self, address: u32, octets: &[u8]) -> Result<(), Stop> {
        self.memory.write(address, octets)?;
        self.pass(octets.len() as u32, true);
        self.writes.push((address, octets.to_vec()));
        Ok(())
    }
}

impl Link for ItemLink<'_> {
    fn load(&mut self, buffer: &mut Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        buffer.slice(to, octets)?;
        let (from, words) = self.ask(from, octets);
        self.memory.holds(from, octets)?;
        let place = buffer.slice_mut(to, octets)?;
        self.memory.read(from, place)?;
        self.arrive(from, &words, place);
        Ok(())
    }

    fn store(&mut self, buffer: &Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        self.write_octets(to, buffer.slice(from, octets)?)
    }

    fn read(&mut self, address: u32, words: &mut [i32]) -> Result<(), Stop> {
        let (address, range) = self.ask(address, 4 * words.len() as u32);
        self.memory.read_words(address, words)?;
        if self.is_looked_at(&range) {
            let mut octets: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            self.arrive(address, &range, &mut octets);
            let (arrived, _) = octets.as_chunks::<4>();
            words.iter_mut().zip(arrived).for_each(|(word, octets)| *word = i32::from_le_bytes(*octets));
        }
        Ok(())
    }

    fn read_octets(&mut self, address: u32, octets: &mut [u8]) -> Result<(), Stop> {
        let (address, words) = self.ask(address, octets.len() as u32);
        self.memory.read(address, octets)?;
        self.arrive(address, &words, octets);
        Ok(())
    }

    fn write(&mut self, address: u32, words: &[i32]) -> Result<(), Stop> {
        let octets: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        self.write_octets(address, &octets)
    }

    fn fetch_add(&mut self, address: u32, more: i32) -> Result<i32, Stop> {
        let before = self.memory.word(address)?;
        self.write_octets(address, &before.wrapping_add(more).to_le_bytes())?;
        Ok(before)
    }

    fn send(&mut self, to: i32, message: Message) -> Result<(), Stop> {
        let largest = self.main;
        let receiver = u32::try_from(to).ok().filter(|&to| to <= largest);
        let receiver = receiver.ok_or(Fault::NoSuchCore { number: to, largest })?;
        let message = self.message(message);
        self.sent.push((receiver, message));
        Ok(())
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        let message = self.message.take().ok_or(Stop::Wait)?;
        Ok((self.message(message), self.main))
    }

    fn barrier(&mut self) -> Result<(), Stop> {
        Err(Stop::Wait)
    }
}
