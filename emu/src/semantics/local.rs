//! Semantics of the instructions on the local buffer. Addresses are octets modulo 2^32; a fault leaves everything as it was.

use isa::number::Vector;
use isa::table::Done;

use super::LocalRoom;
use crate::code::octets::Buffer;
use crate::code::trap::Fault;

impl LocalRoom for Buffer {
    #[inline]
    fn lbu(&mut self, a: u32, i: i32) -> Result<(i32, Done), Fault> {
        let [octet] = self.get(a.wrapping_add_signed(i))?;
        Ok((octet.into(), Done))
    }

    #[inline]
    fn lh(&mut self, a: u32, i: i32) -> Result<(i32, Done), Fault> {
        let half = i16::from_le_bytes(self.get(a.wrapping_add_signed(i))?);
        Ok((half.into(), Done))
    }

    #[inline]
    fn lhu(&mut self, a: u32, i: i32) -> Result<(i32, Done), Fault> {
        let half = u16::from_le_bytes(self.get(a.wrapping_add_signed(i))?);
        Ok((half.into(), Done))
    }

    #[inline]
    fn lw(&mut self, a: u32, i: i32) -> Result<(i32, Done), Fault> {
        Ok((self.word(a.wrapping_add_signed(i))?, Done))
    }

    #[inline]
    fn sb(&mut self, b: i32, a: u32, i: i32) -> Result<Done, Fault> {
        self.put(a.wrapping_add_signed(i), [b as u8])?;
        Ok(Done)
    }

    #[inline]
    fn sh(&mut self, b: i32, a: u32, i: i32) -> Result<Done, Fault> {
        self.put(a.wrapping_add_signed(i), (b as u16).to_le_bytes())?;
        Ok(Done)
    }

    #[inline]
    fn sw(&mut self, b: i32, a: u32, i: i32) -> Result<Done, Fault> {
        self.put(a.wrapping_add_signed(i), b.to_le_bytes())?;
        Ok(Done)
    }

    #[inline]
    fn lv(&mut self, a: u32, i: i32) -> Result<(Vector, Done), Fault> {
        Ok((self.vector(a.wrapping_add_signed(i))?, Done))
    }

    #[inline]
    fn sv(&mut self, b: Vector, a: u32, i: i32) -> Result<Done, Fault> {
        self.put_vector(a.wrapping_add_signed(i), b)?;
        Ok(Done)
    }

    #[inline]
    fn lvh(&mut self, a: u32, i: i32, j: i32) -> Result<(Vector, Done), Fault> {
        let octets: [u8; 6] = self.get(a.wrapping_add_signed(i))?;
        let component = |k: usize| i64::from(i16::from_le_bytes([octets[2 * k], octets[2 * k + 1]])) << j;
        Ok((std::array::from_fn(|k| component(k) as i32), Done))
    }

    #[inline]
    fn lwide(&mut self, a: u32, i: i32) -> Result<(i64, Done), Fault> {
        Ok((i64::from_le_bytes(self.get(a.wrapping_add_signed(i))?), Done))
    }

    #[inline]
    fn swide(&mut self, b: i64, a: u32, i: i32) -> Result<Done, Fault> {
        self.put(a.wrapping_add_signed(i), b.to_le_bytes())?;
        Ok(Done)
    }

    #[inline]
    fn lwp(&mut self, x: i32, i: i32) -> Result<(i32, i32, Done), Fault> {
        Ok((self.word(x as u32)?, x.wrapping_add(i), Done))
    }

    #[inline]
    fn lvp(&mut self, x: i32, i: i32) -> Result<(Vector, i32, Done), Fault> {
        Ok((self.vector(x as u32)?, x.wrapping_add(i), Done))
    }

    #[inline]
    fn swp(&mut self, b: i32, x: i32, i: i32) -> Result<(i32, Done), Fault> {
        self.put(x as u32, b.to_le_bytes())?;
        Ok((x.wrapping_add(i), Done))
    }
}
