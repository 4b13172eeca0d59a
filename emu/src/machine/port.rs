//! A core's link to the machine: it asks first, and acts when the machine says that its time has come.

use std::ops::Range;

use super::mailbox::Mailboxes;
use super::request::{Access, Request};
use crate::code::octets::{Buffer, Memory};
use crate::code::quantity::{Clocks, Octets};
use crate::code::trap::{Fault, Stop};
use crate::semantics::{Link, Message};

/// State that all processors share.
#[derive(Debug)]
pub struct Shared {
    /// Global memory.
    pub memory: Memory,
    /// From the first to the last octet of global memory that was written.
    pub written: Range<u64>,
    /// Messages on their way.
    pub mailboxes: Mailboxes,
}

impl Shared {
    /// A memory and empty mailboxes.
    pub fn new(memory: Memory, processors: u32) -> Shared {
        Shared { memory, written: 0..0, mailboxes: Mailboxes::new(processors) }
    }

    fn note_written(&mut self, address: u32, octets: u32) {
        widen(&mut self.written, u64::from(address)..u64::from(address) + u64::from(octets));
    }
}

/// Makes a range reach over another one as well; empty ones count for nothing.
#[inline]
pub fn widen(all: &mut Range<u64>, more: Range<u64>) {
    if !more.is_empty() {
        *all = if all.is_empty() { more } else { all.start.min(more.start)..all.end.max(more.end) };
    }
}

/// The link of one core while its engine runs. An instruction is tried twice: without permission it only says what it asks
/// for, so that range errors show at once; with permission it happens.
#[derive(Debug)]
pub struct CorePort<'a> {
    /// State that it shares with the others.
    pub shared: &'a mut Shared,
    /// Number of the processor.
    pub processor: u32,
    /// Permission for one instruction, with the clock at which it is done.
    pub permission: Option<Clocks>,
    /// Request that the core waits for, set when it stops to wait.
    pub request: Option<Request>,
    /// The message that was taken with this permission, and its sender.
    pub taken: Option<(Message, u32)>,
}

impl<'a> CorePort<'a> {
    /// A link with or without permission.
    pub fn new(shared: &'a mut Shared, processor: u32, permission: Option<Clocks>) -> CorePort<'a> {
        CorePort { shared, processor, permission, request: None, taken: None }
    }

    /// Uses up the permission, or notes what is asked for.
    fn enter(&mut self, request: Request) -> Result<Clocks, Stop> {
        self.permission.take().ok_or_else(|| {
            self.request = Some(request);
            Stop::Wait
        })
    }
}

fn transfer(access: Access, address: u32, octets: u32) -> Request {
    Request::Transfer { address, octets: Octets(octets.into()), access }
}

impl Link for CorePort<'_> {
    fn load(&mut self, buffer: &mut Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        let place = buffer.slice_mut(to, octets)?;
        self.shared.memory.holds(from, octets)?;
        self.enter(transfer(Access::Load, from, octets))?;
        Ok(self.shared.memory.read(from, place)?)
    }

    fn store(&mut self, buffer: &Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        let data = buffer.slice(from, octets)?;
        self.shared.memory.holds(to, octets)?;
        self.enter(transfer(Access::Write, to, octets))?;
        self.shared.memory.write(to, data)?;
        self.shared.note_written(to, octets);
        Ok(())
    }

    fn read(&mut self, address: u32, words: &mut [i32]) -> Result<(), Stop> {
        let octets = 4 * words.len() as u32;
        self.shared.memory.holds(address, octets)?;
        self.enter(transfer(Access::Read, address, octets))?;
        Ok(self.shared.memory.read_words(address, words)?)
    }

    fn read_octets(&mut self, address: u32, octets: &mut [u8]) -> Result<(), Stop> {
        let length = octets.len() as u32;
        self.shared.memory.holds(address, length)?;
        self.enter(transfer(Access::Read, address, length))?;
        Ok(self.shared.memory.read(address, octets)?)
    }

    fn write(&mut self, address: u32, words: &[i32]) -> Result<(), Stop> {
        let octets = 4 * words.len() as u32;
        self.shared.memory.holds(address, octets)?;
        self.enter(transfer(Access::Write, address, octets))?;
        self.shared.note_written(address, octets);
        Ok(self.shared.memory.put_words(address, words)?)
    }

    fn fetch_add(&mut self, address: u32, more: i32) -> Result<i32, Stop> {
        self.shared.memory.holds(address, 4)?;
        // It is read and written back in one transfer.
        self.enter(transfer(Access::Write, address, 8))?;
        let before = self.shared.memory.word(address)?;
        self.shared.memory.put_words(address, &[before.wrapping_add(more)])?;
        self.shared.note_written(address, 4);
        Ok(before)
    }

    fn send(&mut self, to: i32, message: Message) -> Result<(), Stop> {
        let largest = self.shared.mailboxes.processors() - 1;
        let receiver =
            u32::try_from(to).ok().filter(|&to| to <= largest).ok_or(Fault::NoSuchCore { number: to, largest })?;
        // The permission's clock is when the message has gone over the bus.
        let arrival = self.enter(Request::Send { to: receiver, octets: Octets(message.octets().into()) })?;
        self.shared.mailboxes.put(receiver, self.processor, arrival, message);
        Ok(())
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        self.enter(Request::Receive)?;
        let (_, sender) = self.shared.mailboxes.next(self.processor).ok_or(Stop::Wait)?;
        let message = self.shared.mailboxes.take(self.processor, sender).ok_or(Stop::Wait)?;
        self.taken = Some((message, sender));
        Ok((message, sender))
    }

    fn barrier(&mut self) -> Result<(), Stop> {
        self.enter(Request::Barrier)?;
        Ok(())
    }
}
