//! Semantics of the instructions that ask the machine for something: global memory, messages, barriers. When that happens, and
//! how long it takes, is the machine's business, behind [`Link`].

use isa::number::Vector;
use isa::table::{Done, Each};

use super::BusRoom;
use super::unpack::{self, NodeWidths};
use crate::code::octets::Buffer;
use crate::code::trap::{Fault, Stop};

/// Most vectors that a message carries.
const LONGEST: usize = 5;

/// A few vectors on their way from one core to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Message {
    vectors: [Vector; LONGEST],
    length: u8,
}

impl Message {
    /// A message of `N` vectors.
    pub fn new<const N: usize>(sent: [Vector; N]) -> Message {
        const { assert!(N >= 1 && N <= LONGEST, "a message carries one to five vectors") };
        let mut vectors = [[0; 3]; LONGEST];
        vectors[..N].copy_from_slice(&sent);
        Message { vectors, length: N as u8 }
    }

    /// A message of one to five vectors; `None` for another number of them.
    pub fn of_vectors(sent: &[Vector]) -> Option<Message> {
        let mut vectors = [[0; 3]; LONGEST];
        vectors.get_mut(..sent.len()).filter(|_| !sent.is_empty())?.copy_from_slice(sent);
        Some(Message { vectors, length: sent.len() as u8 })
    }

    /// Length on the bus.
    pub const fn octets(&self) -> u32 {
        12 * self.length as u32
    }

    /// The first vector: what identifies a work item when the message starts one.
    pub const fn first(&self) -> Vector {
        self.vectors[0]
    }

    /// Vectors of the message.
    pub fn vectors(&self) -> &[Vector] {
        &self.vectors[..usize::from(self.length)]
    }

    /// The message with flipped bits of one of its words, counted through its vectors.
    pub(crate) fn flipped(mut self, word: usize, mask: u32) -> Message {
        if let Some(component) = self.vectors.as_flattened_mut().get_mut(word) {
            *component ^= mask as i32;
        }
        self
    }

    /// The `N` vectors that a receiver takes.
    fn open<const N: usize>(self) -> Result<[Vector; N], Fault> {
        if usize::from(self.length) != N {
            return Err(Fault::MessageSize { sent: self.octets(), expected: 12 * N as u32 });
        }
        Ok(std::array::from_fn(|at| self.vectors[at]))
    }
}

/// The machine as one core sees it. Every call either happens whole or not at all: `Stop::Wait` means that the core is
/// to try the same instruction again when the machine says so.
pub trait Link {
    /// Copies `octets` octets from global memory at `from` to the buffer at `to`.
    ///
    /// # Errors
    /// A range that leaves buffer or memory, or not yet.
    fn load(&mut self, buffer: &mut Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop>;

    /// Copies `octets` octets from the buffer at `from` to global memory at `to`.
    ///
    /// # Errors
    /// A range that leaves buffer or memory, or not yet.
    fn store(&mut self, buffer: &Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop>;

    /// Reads words of 32 bits from global memory from `address` on, in one transfer.
    ///
    /// # Errors
    /// An address beyond the memory, or not yet.
    fn read(&mut self, address: u32, words: &mut [i32]) -> Result<(), Stop>;

    /// [`Link::read`] for a number of words that is known.
    ///
    /// # Errors
    /// As [`Link::read`].
    #[inline]
    fn words<const N: usize>(&mut self, address: u32) -> Result<[i32; N], Stop>
    where
        Self: Sized,
    {
        let mut words = [0; N];
        self.read(address, &mut words)?;
        Ok(words)
    }

    /// Reads octets from global memory from `address` on, in one transfer.
    ///
    /// # Errors
    /// An address beyond the memory, or not yet.
    fn read_octets(&mut self, address: u32, octets: &mut [u8]) -> Result<(), Stop>;

    /// Writes words of 32 bits to global memory from `address` on, in one transfer.
    ///
    /// # Errors
    /// An address beyond the memory, or not yet.
    fn write(&mut self, address: u32, words: &[i32]) -> Result<(), Stop>;

    /// Adds to the 32 bits of global memory at `address`, modulo 2^32, and returns what they were.
    ///
    /// # Errors
    /// An address beyond the memory, or not yet.
    fn fetch_add(&mut self, address: u32, more: i32) -> Result<i32, Stop>;

    /// Puts a message into the mailbox that core `to` has for this core.
    ///
    /// # Errors
    /// No such core, or not yet.
    fn send(&mut self, to: i32, message: Message) -> Result<(), Stop>;

    /// Takes the message that arrived first, of several at the same time that of the lowest sender.
    ///
    /// # Errors
    /// None there yet.
    fn receive(&mut self) -> Result<(Message, u32), Stop>;

    /// Waits for the others.
    ///
    /// # Errors
    /// Some have not come yet.
    fn barrier(&mut self) -> Result<(), Stop>;
}

/// Hands the methods that every link has to a macro, behind what is for it.
macro_rules! methods {
    ($macro:ident! $($arguments:tt)*) => {
        $crate::semantics::$macro! { $($arguments)*
            load(buffer: &mut Buffer, to: u32, from: u32, octets: u32) -> ();
            store(buffer: &Buffer, to: u32, from: u32, octets: u32) -> ();
            read(address: u32, words: &mut [i32]) -> ();
            read_octets(address: u32, octets: &mut [u8]) -> ();
            write(address: u32, words: &[i32]) -> ();
            fetch_add(address: u32, more: i32) -> i32;
            send(to: i32, message: Message) -> ();
            receive() -> (Message, u32);
            barrier() -> ();
        }
    };
}

/// The methods of a link that hands on to another one.
macro_rules! hand_on {
    ($link:ident => $to:expr; $($name:ident($($argument:ident: $kind:ty),*) -> $result:ty;)*) => {
        $(fn $name(&mut $link, $($argument: $kind),*) -> Result<$result, Stop> {
            $to.$name($($argument),*)
        })*
    };
}

/// The methods of a link whose transfers reach global memory at once; messages and barriers are its own business.
macro_rules! at_once {
    ($link:ident => $memory:expr) => {
        fn load(&mut $link, buffer: &mut Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
            Ok($memory.read(from, buffer.slice_mut(to, octets)?)?)
        }

        fn store(&mut $link, buffer: &Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
            Ok($memory.write(to, buffer.slice(from, octets)?)?)
        }

        fn read(&mut $link, address: u32, words: &mut [i32]) -> Result<(), Stop> {
            Ok($memory.read_words(address, words)?)
        }

        fn read_octets(&mut $link, address: u32, octets: &mut [u8]) -> Result<(), Stop> {
            Ok($memory.read(address, octets)?)
        }

        fn write(&mut $link, address: u32, words: &[i32]) -> Result<(), Stop> {
            Ok($memory.put_words(address, words)?)
        }

        fn fetch_add(&mut $link, address: u32, more: i32) -> Result<i32, Stop> {
            let before = $memory.word(address)?;
            $memory.put_words(address, &[before.wrapping_add(more)])?;
            Ok(before)
        }
    };
}

/// The methods of a link that refuses everything.
#[cfg(all(test, feature = "native"))]
macro_rules! refuse {
    ($($name:ident($($argument:ident: $kind:ty),*) -> $result:ty;)*) => {
        $(fn $name(&mut self, $(_: $kind),*) -> Result<$result, Stop> {
            Err(Stop::Wait)
        })*
    };
}

#[cfg(all(test, feature = "native"))]
pub(crate) use refuse;
pub(crate) use {at_once, hand_on, methods};

impl<L: Link + ?Sized> Link for &mut L {
    methods! { hand_on! self => (**self); }
}

/// Port of the bus instructions: a core's buffer and its link to the machine.
pub struct Port<'a, L> {
    /// The local buffer.
    pub buffer: &'a mut Buffer,
    /// The machine.
    pub link: &'a mut L,
}

impl<L: Link> Port<'_, L> {
    /// Moves records of `bits` bits each from global memory at `from` to the buffer at `to`, `N` words each, as `unpack` makes them of the
    /// octets and the bit at which a record begins. Yields the octets that were moved.
    fn unpack<const N: usize>(
        &mut self,
        (to, from): (u32, u32),
        records: i32,
        bits: u32,
        unpack: impl Fn(&[u8], usize) -> [i32; N],
    ) -> Result<Each, Stop> {
        let records = records as u32;
        // More words than there are addresses do not fit any buffer.
        let place = self.buffer.slice_mut(to, records.saturating_mul(4 * N as u32))?;
        let octets = (u64::from(records) * u64::from(bits)).div_ceil(8) as usize;
        let mut moved = unpack::Moved::new(octets);
        self.link.read_octets(from, moved.octets())?;
        for (record, words) in place.chunks_exact_mut(4 * N).enumerate() {
            let unpacked = unpack(moved.padded(), record * bits as usize);
            for (octets, word) in words.chunks_exact_mut(4).zip(unpacked) {
                octets.copy_from_slice(&word.to_le_bytes());
            }
        }
        Ok(Each(octets as u32))
    }
}

impl<L: Link> BusRoom for Port<'_, L> {
    #[inline]
    fn load(&mut self, a: u32, b: u32, c: i32) -> Result<Each, Stop> {
        self.link.load(self.buffer, a, b, c as u32)?;
        Ok(Each(c as u32))
    }

    #[inline]
    fn store(&mut self, a: u32, b: u32, c: i32) -> Result<Each, Stop> {
        self.link.store(self.buffer, a, b, c as u32)?;
        Ok(Each(c as u32))
    }

    #[inline(always)]
    fn ldw(&mut self, a: u32, i: i32) -> Result<(i32, Done), Stop> {
        let [word] = self.link.words(a.wrapping_add_signed(i))?;
        Ok((word, Done))
    }

    #[inline(always)]
    fn ldwide(&mut self, a: u32, i: i32) -> Result<(i64, Done), Stop> {
        let [low, high] = self.link.words(a.wrapping_add_signed(i))?;
        // Only the upper word has the sign; the lower one is 32 bits without any.
        Ok((i64::from(high) << 32 | i64::from(low as u32), Done))
    }

    #[inline(always)]
    fn ldv3(&mut self, a: u32, i: i32) -> Result<([Vector; 3], Done), Stop> {
        let words: [i32; 9] = self.link.words(a.wrapping_add_signed(i))?;
        Ok((std::array::from_fn(|at| std::array::from_fn(|component| words[3 * at + component])), Done))
    }

    #[inline]
    fn loadf(&mut self, a: u32, b: u32, c: i32, i: i32) -> Result<Each, Stop> {
        self.unpack((a, b), c, i as u32, |octets, at| [unpack::signed(octets, at, i as u32)])
    }

    #[inline]
    fn loadfu(&mut self, a: u32, b: u32, c: i32, i: i32) -> Result<Each, Stop> {
        self.unpack((a, b), c, i as u32, |octets, at| [unpack::unsigned(octets, at, i as u32) as i32])
    }

    #[inline]
    fn ldv3f(&mut self, a: u32, i: i32, j: i32) -> Result<([Vector; 3], Each), Stop> {
        let bits = j as u32;
        let octets = (9 * bits).div_ceil(8);
        let mut moved = unpack::Moved::new(octets as usize);
        self.link.read_octets(a.wrapping_add_signed(i), moved.octets())?;
        let component = |at: usize| unpack::signed(moved.padded(), at * bits as usize, bits);
        Ok((std::array::from_fn(|vector| std::array::from_fn(|k| component(3 * vector + k))), Each(octets)))
    }

    #[inline]
    fn ldnode(&mut self, a: u32, i: i32, j: i32) -> Result<(i64, Each), Stop> {
        let widths = NodeWidths::new(i, j);
        let mut moved = unpack::Moved::new(widths.octets() as usize);
        self.link.read_octets(widths.address(a), moved.octets())?;
        let [low, high] = widths.node(moved.padded(), 0);
        Ok((i64::from(high) << 32 | i64::from(low as u32), Each(widths.octets())))
    }

    #[inline]
    fn loadnode(&mut self, a: u32, b: u32, c: i32, i: i32, j: i32) -> Result<Each, Stop> {
        let widths = NodeWidths::new(i, j);
        self.unpack((a, widths.address(b)), c, 8 * widths.octets(), |octets, at| widths.node(octets, at))
    }

    #[inline]
    fn stw(&mut self, b: i32, a: u32, i: i32) -> Result<Done, Stop> {
        self.link.write(a.wrapping_add_signed(i), &[b])?;
        Ok(Done)
    }

    #[inline]
    fn stv(&mut self, b: Vector, a: u32, i: i32) -> Result<Done, Stop> {
        self.link.write(a.wrapping_add_signed(i), &b)?;
        Ok(Done)
    }

    #[inline]
    fn fetchadd(&mut self, a: u32, b: i32) -> Result<(i32, Done), Stop> {
        Ok((self.link.fetch_add(a, b)?, Done))
    }

    #[inline]
    fn send2(&mut self, a: i32, b: [Vector; 2]) -> Result<Done, Stop> {
        self.link.send(a, Message::new(b))?;
        Ok(Done)
    }

    #[inline]
    fn send5(&mut self, a: i32, b: [Vector; 5]) -> Result<Done, Stop> {
        self.link.send(a, Message::new(b))?;
        Ok(Done)
    }

    #[inline]
    fn recv2(&mut self) -> Result<([Vector; 2], i32, Done), Stop> {
        let (message, sender) = self.link.receive()?;
        Ok((message.open()?, sender as i32, Done))
    }

    #[inline]
    fn recv5(&mut self) -> Result<([Vector; 5], i32, Done), Stop> {
        let (message, sender) = self.link.receive()?;
        Ok((message.open()?, sender as i32, Done))
    }

    #[inline]
    fn barrier(&mut self) -> Result<Done, Stop> {
        self.link.barrier()?;
        Ok(Done)
    }
}
