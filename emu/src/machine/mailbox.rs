//! Messages on their way: one place for each pair of sender and receiver.

use crate::code::quantity::Clocks;
use crate::semantics::Message;

#[derive(Clone, Copy, Debug)]
struct Letter {
    arrival: Clocks,
    message: Message,
}

/// The mailboxes of all processors: each has one for each sender, itself included, and a mailbox holds one message.
#[derive(Clone, Debug)]
pub struct Mailboxes {
    processors: usize,
    letters: Vec<Option<Letter>>,
}

impl Mailboxes {
    /// Empty ones.
    pub fn new(processors: u32) -> Mailboxes {
        let processors = processors as usize;
        Mailboxes { processors, letters: vec![None; processors * processors] }
    }

    /// Number of processors.
    pub fn processors(&self) -> u32 {
        self.processors as u32
    }

    fn place(&self, receiver: u32, sender: u32) -> usize {
        receiver as usize * self.processors + sender as usize
    }

    /// True where the receiver has not yet taken the sender's last message.
    pub fn is_full(&self, receiver: u32, sender: u32) -> bool {
        self.letters[self.place(receiver, sender)].is_some()
    }

    /// Puts a message into a free mailbox.
    pub fn put(&mut self, receiver: u32, sender: u32, arrival: Clocks, message: Message) {
        let place = self.place(receiver, sender);
        debug_assert!(self.letters[place].is_none(), "a send waits until the mailbox is free");
        self.letters[place] = Some(Letter { arrival, message });
    }

    /// Arrival and sender of the message that a receiver takes next: the earliest, then the lowest sender's.
    pub fn next(&self, receiver: u32) -> Option<(Clocks, u32)> {
        let first = self.place(receiver, 0);
        let letters = self.letters[first..first + self.processors].iter().zip(0..);
        letters.filter_map(|(letter, sender)| Some(((*letter)?.arrival, sender))).min()
    }

    /// Takes the sender's message.
    pub fn take(&mut self, receiver: u32, sender: u32) -> Option<Message> {
        let place = self.place(receiver, sender);
        Some(self.letters[place].take()?.message)
    }
}
