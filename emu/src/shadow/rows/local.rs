//! Numbers through memory and messages: a number keeps its shadow in the buffer, in global memory and on its way to another core. Octets
//! and halves of words are integers.

use super::{BusRoom, LocalRoom, RealFormulas, RealResult, ShadowEffect, ShadowInput, each};
use crate::shadow::memory::ShadowMemory;
use RealResult::Integer;

/// Octets of a word.
const WORD: u32 = 4;

/// Octets of a wide number.
const WIDE: u32 = 8;

/// The number at an address of a memory.
fn number(memory: &ShadowMemory, address: u32, octets: u32) -> RealResult {
    memory.get(address, octets).map_or(Integer, |number| RealResult::Moved(number.clone()))
}

/// Three numbers of a memory from an address on.
fn numbers(memory: &ShadowMemory, address: u32) -> [RealResult; 3] {
    each(|k| number(memory, address.wrapping_add(WORD * k as u32), WORD))
}

impl RealFormulas<'_> {
    fn store_locally(&mut self, address: u32, octets: u32, numbers: &[ShadowInput]) {
        self.effect =
            ShadowEffect::Buffer(address, octets, numbers.iter().map(|number| number.shadow.cloned()).collect());
    }

    fn store_globally(&mut self, address: u32, numbers: &[ShadowInput]) {
        self.effect = ShadowEffect::Global(address, numbers.iter().map(|number| number.shadow.cloned()).collect());
    }

    /// Numbers that are put together from bits are exact: they overwrite so many numbers of so many octets.
    fn unpacked(&mut self, address: u32, count: ShadowInput, octets: u32) {
        self.effect = ShadowEffect::Forget(address, (count.raw as u32).saturating_mul(octets));
    }

    fn send(&mut self, to: i64, vectors: &[[ShadowInput; 3]]) {
        let message = vectors.iter().map(|vector| vector.map(|component| component.shadow.cloned()));
        self.effect = ShadowEffect::Send(to, message.collect());
    }
}

impl LocalRoom for RealFormulas<'_> {
    fn lbu(&mut self, _: u32, _: i32) -> (RealResult,) {
        (Integer,)
    }

    fn lh(&mut self, _: u32, _: i32) -> (RealResult,) {
        (Integer,)
    }

    fn lhu(&mut self, _: u32, _: i32) -> (RealResult,) {
        (Integer,)
    }

    fn lw(&mut self, a: u32, i: i32) -> (RealResult,) {
        (number(self.local, a.wrapping_add_signed(i), WORD),)
    }

    fn sb(&mut self, _: ShadowInput, a: u32, i: i32) {
        self.effect = ShadowEffect::Forget(a.wrapping_add_signed(i), 1);
    }

    fn sh(&mut self, _: ShadowInput, a: u32, i: i32) {
        self.effect = ShadowEffect::Forget(a.wrapping_add_signed(i), 2);
    }

    fn sw(&mut self, b: ShadowInput, a: u32, i: i32) {
        self.store_locally(a.wrapping_add_signed(i), WORD, &[b]);
    }

    fn lv(&mut self, a: u32, i: i32) -> ([RealResult; 3],) {
        (numbers(self.local, a.wrapping_add_signed(i)),)
    }

    fn sv(&mut self, b: [ShadowInput; 3], a: u32, i: i32) {
        self.store_locally(a.wrapping_add_signed(i), WORD, &b);
    }

    fn lvh(&mut self, _: u32, _: i32, _: i32) -> ([RealResult; 3],) {
        (each(|_| Integer),)
    }

    fn lwide(&mut self, a: u32, i: i32) -> (RealResult,) {
        (number(self.local, a.wrapping_add_signed(i), WIDE),)
    }

    fn swide(&mut self, b: ShadowInput, a: u32, i: i32) {
        self.store_locally(a.wrapping_add_signed(i), WIDE, &[b]);
    }

    fn lwp(&mut self, x: ShadowInput, _: i32) -> (RealResult, RealResult) {
        (number(self.local, x.raw as u32, WORD), Integer)
    }

    fn lvp(&mut self, x: ShadowInput, _: i32) -> ([RealResult; 3], RealResult) {
        (numbers(self.local, x.raw as u32), Integer)
    }

    fn swp(&mut self, b: ShadowInput, x: ShadowInput, _: i32) -> (RealResult,) {
        self.store_locally(x.raw as u32, WORD, &[b]);
        (Integer,)
    }
}

impl BusRoom for RealFormulas<'_> {
    fn load(&mut self, a: u32, b: u32, c: ShadowInput) {
        self.effect = ShadowEffect::Load(a, b, c.raw as u32);
    }

    fn store(&mut self, a: u32, b: u32, c: ShadowInput) {
        self.effect = ShadowEffect::Store(a, b, c.raw as u32);
    }

    fn ldw(&mut self, a: u32, i: i32) -> (RealResult,) {
        (number(self.global, a.wrapping_add_signed(i), WORD),)
    }

    fn ldwide(&mut self, a: u32, i: i32) -> (RealResult,) {
        (number(self.global, a.wrapping_add_signed(i), WIDE),)
    }

    fn ldv3(&mut self, a: u32, i: i32) -> ([[RealResult; 3]; 3],) {
        (std::array::from_fn(|at| numbers(self.global, a.wrapping_add_signed(i).wrapping_add(3 * WORD * at as u32))),)
    }

    fn loadf(&mut self, a: u32, _: u32, c: ShadowInput, _: i32) {
        self.unpacked(a, c, WORD);
    }

    fn loadfu(&mut self, a: u32, _: u32, c: ShadowInput, _: i32) {
        self.unpacked(a, c, WORD);
    }

    fn ldv3f(&mut self, _: u32, _: i32, _: i32) -> ([[RealResult; 3]; 3],) {
        (std::array::from_fn(|_| each(|_| Integer)),)
    }

    fn ldnode(&mut self, _: u32, _: i32, _: i32) -> (RealResult,) {
        (Integer,)
    }

    fn loadnode(&mut self, a: u32, _: u32, c: ShadowInput, _: i32, _: i32) {
        self.unpacked(a, c, WIDE);
    }

    fn stw(&mut self, b: ShadowInput, a: u32, i: i32) {
        self.store_globally(a.wrapping_add_signed(i), &[b]);
    }

    fn stv(&mut self, b: [ShadowInput; 3], a: u32, i: i32) {
        self.store_globally(a.wrapping_add_signed(i), &b);
    }

    fn fetchadd(&mut self, a: u32, _: ShadowInput) -> (RealResult,) {
        self.effect = ShadowEffect::Add(a);
        (Integer,)
    }

    fn send2(&mut self, a: ShadowInput, b: [[ShadowInput; 3]; 2]) {
        self.send(a.raw, &b);
    }

    fn send5(&mut self, a: ShadowInput, b: [[ShadowInput; 3]; 5]) {
        self.send(a.raw, &b);
    }

    fn recv2(&mut self) -> ([[RealResult; 3]; 2], RealResult) {
        self.effect = ShadowEffect::Receive(self.message_register);
        (std::array::from_fn(|_| each(|_| Integer)), Integer)
    }

    fn recv5(&mut self) -> ([[RealResult; 3]; 5], RealResult) {
        self.effect = ShadowEffect::Receive(self.message_register);
        (std::array::from_fn(|_| each(|_| Integer)), Integer)
    }

    fn barrier(&mut self) {}
}
