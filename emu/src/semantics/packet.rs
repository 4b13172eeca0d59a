//! Semantics of the instructions of the packet unit. The decisions are those of [`isa::number::ray`].

use isa::number::ray::{PACKET_WORDS, PacketHit, PacketWords, Ray};
use isa::number::{Arithmetic, Vector};
use isa::table::outcome;

use super::PacketRoom;
use crate::code::octets::Buffer;
use crate::code::trap::Fault;

/// The packet of so many triangles at an address.
#[inline(always)]
fn packet(buffer: &Buffer, address: u32, triangles: i32) -> Result<PacketWords<'_>, Fault> {
    let octets = buffer.octets().get(address as usize..).unwrap_or_default();
    match PacketWords::at_start(octets, triangles as u32 as usize) {
        Some(packet) if address as usize <= buffer.octets().len() => Ok(packet),
        _ => Err(beyond_end(buffer, address, triangles)),
    }
}

/// The fault of a packet that leaves the buffer. More octets than there are addresses are more than any buffer has.
#[cold]
fn beyond_end(buffer: &Buffer, address: u32, triangles: i32) -> Fault {
    let octets = u64::from(triangles as u32) * 4 * PACKET_WORDS as u64;
    let size = buffer.octets().len() as u32;
    Fault::Buffer { address, octets: u32::try_from(octets).unwrap_or(u32::MAX), size }
}

impl<T: Arithmetic> PacketRoom for T {
    // Compiled into the function of a row, which native code has for the host's vectors as well.
    #[inline(always)]
    fn rnear(
        &self,
        buffer: &mut Buffer,
        x: Vector,
        a: [Vector; 2],
        b: u32,
        c: i32,
        i: i32,
    ) -> Result<(Vector, outcome::rnear::Outcome), Fault> {
        use outcome::rnear::{Outcome, Way};
        let known = PacketHit { t: x[0], name: x[1] as u32 };
        let found = packet(buffer, b, c)?.nearest(self, &Ray::from(a), i as u32, known);
        let way = if found == known { Way::Same } else { Way::Nearer };
        Ok(([found.t, found.name as i32, x[2]], Outcome { way, units: c as u32 }))
    }

    #[inline(always)]
    fn rany(
        &self,
        buffer: &mut Buffer,
        x: Vector,
        a: [Vector; 2],
        b: u32,
        c: i32,
        i: i32,
    ) -> Result<(Vector, outcome::rany::Outcome), Fault> {
        use outcome::rany::{Outcome, Way};
        Ok(match packet(buffer, b, c)?.any(self, &Ray::from(a), i as u32, x[0]) {
            Some((before, hit)) => {
                let units = before as u32 + 1;
                ([hit.t, hit.name as i32, x[2]], Outcome { way: Way::Blocked, units })
            }
            None => (x, Outcome { way: Way::Clear, units: c as u32 }),
        })
    }
}
