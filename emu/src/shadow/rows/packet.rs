//! Exact formulas of the packet unit: the distance of the triangle that the machine chose, and whether the shadow would have chosen another.

use std::cmp::Ordering;

use isa::number::Modes;
use isa::number::ray::{PACKET_WORDS, PacketHit, PacketWords, Ray, TriangleEnd, ratio, triangle};

use super::decisions::{RealRay, meeting, reals, surely_misses};
use super::ray::{hit, machine_ray};
use super::{PacketRoom, RealFormulas, RealResult, ShadowInput, each};
use crate::shadow::long_real::LongReal;
use RealResult::Integer;

/// Search of a packet.
#[derive(Clone, Copy, PartialEq, Eq)]
enum PacketSearch {
    Nearest,
    Any,
}

/// A packet in the buffer.
struct BufferedPacket<'a> {
    octets: &'a [u8],
    count: usize,
}

impl BufferedPacket<'_> {
    fn word(&self, kind: usize, triangle: usize) -> i64 {
        let at = 4 * (kind * self.count + triangle);
        self.octets[at..].first_chunk().map_or(0, |&octets| i32::from_le_bytes(octets).into())
    }

    fn vertices(&self, triangle: usize) -> [[i64; 3]; 3] {
        [1, 4, 7].map(|kind| [0, 1, 2].map(|axis| self.word(kind + axis, triangle)))
    }

    /// The first triangle of a hit's name with a hit at its distance.
    fn find(&self, modes: &Modes, ray: &Ray, shift: u32, hit: PacketHit) -> Option<usize> {
        let is_it = |&at: &usize| {
            let met = triangle(ray, &self.vertices(at).map(|vertex| vertex.map(|component| component as i32)));
            met.end == TriangleEnd::Hit && ratio(modes, met.t, met.determinant, shift) == hit.t
        };
        (0..self.count).filter(|&at| self.word(0, at) as u32 == hit.name).find(is_it)
    }

    /// The shadow's choice: of two at one distance the machine's.
    fn real_choice(
        &self,
        search: PacketSearch,
        limit: &ShadowInput,
        a: &[[ShadowInput; 3]; 2],
        i: i32,
        chosen: Option<usize>,
    ) -> Option<usize> {
        let ray = RealRay::new(a);
        let doubles = [reals(&a[0]), reals(&a[1])].map(|vector| vector.map(|component| component.to_f64()));
        let mut best = limit.term().real().scaled(-i);
        let mut found = None;
        for triangle in 0..self.count {
            let vertices = self.vertices(triangle);
            if surely_misses(&doubles, &vertices.map(|vertex| vertex.map(|component| component as f64))) {
                continue;
            }
            let Some(t) = meeting(&ray, &vertices.map(|vertex| vertex.map(|raw| LongReal::whole(raw.into())))) else {
                continue;
            };
            let is_nearer = match t.partial_cmp(&best) {
                Some(Ordering::Less) => true,
                Some(Ordering::Equal) => chosen == Some(triangle),
                _ => false,
            };
            if is_nearer {
                (best, found) = (t, Some(triangle));
                // Any hit ends a search for one; which of them is all the same.
                if search == PacketSearch::Any {
                    return if chosen.is_some() { chosen } else { Some(triangle) };
                }
            }
        }
        found
    }
}

impl<'a> RealFormulas<'a> {
    fn packet(&self, address: u32, triangles: i64) -> Option<BufferedPacket<'a>> {
        let octets = self.buffer.octets().get(address as usize..)?;
        let count = triangles as u32 as usize;
        (count.checked_mul(4 * PACKET_WORDS)? <= octets.len()).then_some(BufferedPacket { octets, count })
    }

    /// The result of a search: the machine's triangle, with the shadow of its distance.
    fn searched(
        &mut self,
        search: PacketSearch,
        x: [ShadowInput; 3],
        a: [[ShadowInput; 3]; 2],
        (address, triangles, i): (u32, i64, i32),
    ) -> [RealResult; 3] {
        let unchanged = [x[0].moved(), x[1].moved(), x[2].moved()];
        let Some(packet) = self.packet(address, triangles) else { return unchanged };
        let Some(words) = PacketWords::at_start(packet.octets, packet.count) else { return unchanged };
        // Find the machine's choice; rounding plays no part in which of several it is, but for equal distances.
        let (ray, modes) = (machine_ray(&a), self.modes);
        let known = PacketHit { t: x[0].raw as i32, name: x[1].raw as u32 };
        let chosen = match search {
            PacketSearch::Nearest => {
                let nearest = words.nearest(&modes, &ray, i as u32, known);
                (nearest != known).then(|| packet.find(&modes, &ray, i as u32, nearest)).flatten()
            }
            PacketSearch::Any => words.any(&modes, &ray, i as u32, known.t).map(|(at, _)| at),
        };
        self.decide_on(a.iter().flatten().chain([&x[0]]), || {
            packet.real_choice(search, &x[0], &a, i, chosen) == chosen
        });
        match chosen {
            None => unchanged,
            Some(at) => {
                let vertices = packet.vertices(at).map(|vertex| vertex.map(|raw| ShadowInput { raw, shadow: None }));
                let [t, ..] = hit(&a, &vertices, i, self.modes.word);
                let mut result = each(|_| Integer);
                (result[0], result[2]) = (t, x[2].moved());
                result
            }
        }
    }
}

impl PacketRoom for RealFormulas<'_> {
    fn rnear(
        &mut self,
        x: [ShadowInput; 3],
        a: [[ShadowInput; 3]; 2],
        b: u32,
        c: ShadowInput,
        i: i32,
    ) -> ([RealResult; 3],) {
        (self.searched(PacketSearch::Nearest, x, a, (b, c.raw, i)),)
    }

    fn rany(
        &mut self,
        x: [ShadowInput; 3],
        a: [[ShadowInput; 3]; 2],
        b: u32,
        c: ShadowInput,
        i: i32,
    ) -> ([RealResult; 3],) {
        (self.searched(PacketSearch::Any, x, a, (b, c.raw, i)),)
    }
}
