//! Semantics of the integer rows: 32 bits, modulo 2^32, whatever the machine's word and modes.

use isa::number::Arithmetic;
use isa::table::Done;

use super::IntegerRoom;

impl<T: Arithmetic> IntegerRoom for T {
    #[inline]
    fn iadd(&self, a: i32, b: i32) -> (i32, Done) {
        (a.wrapping_add(b), Done)
    }

    #[inline]
    fn isub(&self, a: i32, b: i32) -> (i32, Done) {
        (a.wrapping_sub(b), Done)
    }

    #[inline]
    fn imul(&self, a: i32, b: i32) -> (i32, Done) {
        (a.wrapping_mul(b), Done)
    }

    #[inline]
    fn and(&self, a: i32, b: i32) -> (i32, Done) {
        (a & b, Done)
    }

    #[inline]
    fn or(&self, a: i32, b: i32) -> (i32, Done) {
        (a | b, Done)
    }

    #[inline]
    fn xor(&self, a: i32, b: i32) -> (i32, Done) {
        (a ^ b, Done)
    }

    #[inline]
    fn sll(&self, a: i32, b: i32) -> (i32, Done) {
        (a << (b & 31), Done)
    }

    #[inline]
    fn srl(&self, a: i32, b: i32) -> (i32, Done) {
        ((a as u32 >> (b & 31)) as i32, Done)
    }

    #[inline]
    fn sra(&self, a: i32, b: i32) -> (i32, Done) {
        (a >> (b & 31), Done)
    }

    #[inline]
    fn slt(&self, a: i32, b: i32) -> (i32, Done) {
        (i32::from(a < b), Done)
    }

    #[inline]
    fn clz(&self, a: i32) -> (i32, Done) {
        (a.leading_zeros() as i32, Done)
    }

    #[inline]
    fn mov(&self, a: i32) -> (i32, Done) {
        (a, Done)
    }

    #[inline]
    fn addr(&self, a: u32, b: i32) -> (i32, Done) {
        (a.wrapping_add_signed(b) as i32, Done)
    }

    #[inline]
    fn slli(&self, a: i32, i: i32) -> (i32, Done) {
        self.sll(a, i)
    }

    #[inline]
    fn srli(&self, a: i32, i: i32) -> (i32, Done) {
        self.srl(a, i)
    }

    #[inline]
    fn srai(&self, a: i32, i: i32) -> (i32, Done) {
        self.sra(a, i)
    }

    #[inline]
    fn iaddi(&self, a: i32, i: i32) -> (i32, Done) {
        (a.wrapping_add(i), Done)
    }

    #[inline]
    fn isubi(&self, a: i32, i: i32) -> (i32, Done) {
        (a.wrapping_sub(i), Done)
    }

    #[inline]
    fn andi(&self, a: i32, i: i32) -> (i32, Done) {
        (a & i, Done)
    }

    #[inline]
    fn ori(&self, a: i32, i: i32) -> (i32, Done) {
        (a | i, Done)
    }

    #[inline]
    fn movi(&self, i: i32) -> (i32, Done) {
        (i, Done)
    }

    #[inline]
    fn movhi(&self, x: i32, i: i32) -> (i32, Done) {
        (x & 0xffff | i << 16, Done)
    }

    #[inline]
    fn lea(&self, a: u32, i: i32) -> (i32, Done) {
        (a.wrapping_add_signed(i) as i32, Done)
    }

    #[inline]
    fn element(&self, a: u32, b: i32, i: i32) -> (i32, Done) {
        (a.wrapping_add_signed(b.wrapping_mul(i)) as i32, Done)
    }
}
