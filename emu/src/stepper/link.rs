//! Link of a lone core: the machine answers at once, from a memory of the core's own, and notes what was asked. Nobody else is there.

use crate::code::octets::{Buffer, Memory};
use crate::code::quantity::{Clocks, Octets};
use crate::code::trap::{Fault, Stop};
use crate::machine::config::Config;
use crate::semantics::{Link, Message, at_once};

/// Kind of a transfer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransferKind {
    /// A block of global memory is copied to the buffer.
    Load,
    /// A block of the buffer is copied to global memory.
    Store,
    /// Words of global memory are read.
    Read,
    /// Words of global memory are written.
    Write,
    /// A word of global memory is read and written.
    Add,
    /// A message leaves; the address is the receiver's number.
    Send,
    /// A message is taken; the address is the sender's number.
    Receive,
}

impl TransferKind {
    /// Name in traces.
    pub const fn name(self) -> &'static str {
        match self {
            TransferKind::Load => "load",
            TransferKind::Store => "store",
            TransferKind::Read => "read",
            TransferKind::Write => "write",
            TransferKind::Add => "add",
            TransferKind::Send => "send",
            TransferKind::Receive => "receive",
        }
    }

    /// True where octets of global memory change.
    pub const fn writes(self) -> bool {
        matches!(self, TransferKind::Store | TransferKind::Write | TransferKind::Add)
    }
}

/// A transfer that an instruction asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Transfer {
    /// Kind of the transfer.
    pub kind: TransferKind,
    /// First octet in global memory, or number of the other processor.
    pub address: u32,
    /// Octets that go over the bus.
    pub octets: u32,
}

/// The machine as a lone core sees it.
#[derive(Clone, Debug)]
pub(super) struct LoneLink {
    /// Global memory, the core's own.
    pub memory: Memory,
    /// Clocks that the bus took.
    pub waited: Clocks,
    /// The last transfer since that was taken.
    pub last: Option<Transfer>,
    /// Messages that left for other processors.
    pub sent: Vec<Message>,
    /// The message that waits, and its sender.
    waiting: Option<(Message, u32)>,
    /// Number of the core, and largest number of a processor.
    core: u32,
    largest: u32,
}

impl LoneLink {
    /// A core alone with a memory; a work item's message waits for it.
    pub fn new(memory: Memory, core: u32, largest: u32, message: Option<Message>) -> LoneLink {
        let waiting = message.map(|message| (message, largest));
        LoneLink { memory, waited: Clocks(0), last: None, sent: Vec::new(), waiting, core, largest }
    }

    fn note(&mut self, kind: TransferKind, address: u32, octets: u32) {
        self.last = Some(Transfer { kind, address, octets });
    }
}

/// A lone link with the bus whose clocks its transfers take.
pub(super) struct TimedLone<'a> {
    /// The link.
    pub link: &'a mut LoneLink,
    /// The machine, whose bus has no other master.
    pub config: &'a Config,
}

impl TimedLone<'_> {
    fn note(&mut self, kind: TransferKind, address: u32, octets: u32) {
        if octets != 0 && kind != TransferKind::Receive {
            self.link.waited += self.config.transfer_clocks(Octets(octets.into()));
        }
        self.link.note(kind, address, octets);
    }
}

impl Link for TimedLone<'_> {
    fn load(&mut self, buffer: &mut Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        self.link.memory.read(from, buffer.slice_mut(to, octets)?)?;
        self.note(TransferKind::Load, from, octets);
        Ok(())
    }

    fn store(&mut self, buffer: &Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        self.link.memory.write(to, buffer.slice(from, octets)?)?;
        self.note(TransferKind::Store, to, octets);
        Ok(())
    }

    fn read(&mut self, address: u32, words: &mut [i32]) -> Result<(), Stop> {
        self.link.memory.read_words(address, words)?;
        self.note(TransferKind::Read, address, 4 * words.len() as u32);
        Ok(())
    }

    fn read_octets(&mut self, address: u32, octets: &mut [u8]) -> Result<(), Stop> {
        self.link.memory.read(address, octets)?;
        self.note(TransferKind::Read, address, octets.len() as u32);
        Ok(())
    }

    fn write(&mut self, address: u32, words: &[i32]) -> Result<(), Stop> {
        self.link.memory.put_words(address, words)?;
        self.note(TransferKind::Write, address, 4 * words.len() as u32);
        Ok(())
    }

    fn fetch_add(&mut self, address: u32, more: i32) -> Result<i32, Stop> {
        let before = self.link.memory.word(address)?;
        self.link.memory.put_words(address, &[before.wrapping_add(more)])?;
        // The word is read and written back in one transfer.
        self.note(TransferKind::Add, address, 8);
        Ok(before)
    }

    fn send(&mut self, to: i32, message: Message) -> Result<(), Stop> {
        let largest = self.link.largest;
        let receiver = u32::try_from(to).ok().filter(|&to| to <= largest);
        let receiver = receiver.ok_or(Fault::NoSuchCore { number: to, largest })?;
        if receiver == self.link.core {
            // Its own mailbox holds one message; a second one would wait for ever.
            if self.link.waiting.is_some() {
                return Err(Stop::Wait);
            }
            self.link.waiting = Some((message, receiver));
        } else {
            self.link.sent.push(message);
        }
        self.note(TransferKind::Send, receiver, message.octets());
        Ok(())
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        let (message, sender) = self.link.waiting.take().ok_or(Stop::Wait)?;
        self.note(TransferKind::Receive, sender, message.octets());
        Ok((message, sender))
    }

    fn barrier(&mut self) -> Result<(), Stop> {
        Ok(())
    }
}

/// The main processor's link up to the first message that it sends: the one that begins a work item.
pub(super) struct FirstMessage<'a> {
    /// Global memory.
    pub memory: &'a mut Memory,
    /// Number of the main processor, which is the number of cores.
    pub main: u32,
    /// The message.
    pub message: Option<Message>,
}

impl Link for FirstMessage<'_> {
    at_once! { self => self.memory }

    fn send(&mut self, to: i32, message: Message) -> Result<(), Stop> {
        let receiver = u32::try_from(to).ok().filter(|&to| to <= self.main);
        receiver.ok_or(Fault::NoSuchCore { number: to, largest: self.main })?;
        self.message = Some(message);
        Err(Stop::Wait)
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        Err(Stop::Wait)
    }

    fn barrier(&mut self) -> Result<(), Stop> {
        Err(Stop::Wait)
    }
}
