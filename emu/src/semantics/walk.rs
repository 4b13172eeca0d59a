//! Semantics of the instructions of the walk unit. The decisions are those of [`isa::number::ray`].

use isa::number::Vector;
use isa::number::ray::{Children, Descent, Plane, Ray};
use isa::table::outcome;

use super::WalkRoom;
use crate::code::octets::Buffer;
use crate::code::trap::Fault;

/// Octets of a node.
const NODE: u32 = 8;

/// Octets of a note: a plane and the address of a node.
const NOTE: u32 = 12;

/// Octets of a block in front of its nodes: the address of the first one, and their octets.
const HEAD: u32 = 8;

#[inline(always)]
fn pattern(buffer: &Buffer, address: u32) -> Result<i64, Fault> {
    Ok(i64::from_le_bytes(buffer.get(address)?))
}

/// Places of notes that a walk may write, with what was there.
type Overwritten = Vec<(u32, [u8; NOTE as usize])>;

/// Walks until a leaf, or out of the block. `overwritten` is what the notes replaced, where somebody wants to know.
#[inline(always)]
fn walk(
    buffer: &mut Buffer,
    [mut node, mut note, block]: [u32; 3],
    ray: Ray,
    entry: Plane,
    mut overwritten: Option<&mut Overwritten>,
) -> Result<(i64, i32, i32, outcome::rwalk::Outcome), Fault> {
    use outcome::rwalk::{Outcome, Way};
    let (first, octets) = (buffer.word(block)? as u32, buffer.word(block.wrapping_add(4))? as u32);
    let nodes = block.wrapping_add(HEAD);
    buffer.slice(nodes, octets)?;
    let mut descent = Descent::new(&ray, entry, Plane::from_pattern(pattern(buffer, note)?));
    let mut units = 0;
    loop {
        let inside = node.wrapping_sub(first);
        if inside > octets.wrapping_sub(NODE) || octets < NODE {
            return Ok((0, node as i32, note as i32, Outcome { way: Way::Outside, units }));
        }
        let split = pattern(buffer, nodes.wrapping_add(inside))?;
        let left = (split >> 32) as u32 & !3;
        units += 1;
        let is_right = match descent.step(Plane::from_pattern(split)) {
            Children::None => return Ok((split, left as i32, note as i32, Outcome { way: Way::Leaf, units })),
            Children::One { is_right } => is_right,
            Children::Both { is_right_first } => {
                let far = if is_right_first { left } else { left.wrapping_add(NODE) };
                note = note.wrapping_add(NOTE);
                let mut octets = [0; NOTE as usize];
                octets[..8].copy_from_slice(&Plane::from_pattern(split).pattern().to_le_bytes());
                octets[8..].copy_from_slice(&far.to_le_bytes());
                if let Some(overwritten) = &mut overwritten {
                    overwritten.push((note, buffer.get(note)?));
                }
                buffer.put(note, octets)?;
                is_right_first
            }
        };
        let child = if is_right { left.wrapping_add(NODE) } else { left };
        // A tree whose children stand behind their parents ends; what else stands there is the program's to follow.
        if child <= node {
            return Ok((0, child as i32, note as i32, Outcome { way: Way::Outside, units }));
        }
        node = child;
    }
}

impl<T> WalkRoom for T {
    #[inline]
    fn rwalk(
        &self,
        buffer: &mut Buffer,
        x: i32,
        y: i32,
        a: [Vector; 2],
        b: i64,
        c: u32,
    ) -> Result<(i64, i32, i32, outcome::rwalk::Outcome), Fault> {
        let (places, ray, entry) = ([x as u32, y as u32, c], Ray::from(a), Plane::from_pattern(b));
        // As many notes as the block has nodes may be written. Where there may be no room for them, what they replace is put back.
        let most = u64::from(buffer.word(c.wrapping_add(4))? as u32 / NODE + 2) * u64::from(NOTE);
        if u64::from(y as u32) + most <= buffer.octets().len() as u64 {
            return walk(buffer, places, ray, entry, None);
        }
        let mut overwritten = Overwritten::new();
        walk(buffer, places, ray, entry, Some(&mut overwritten)).inspect_err(|_| {
            for &(address, octets) in overwritten.iter().rev() {
                buffer.put(address, octets).expect("it was read there");
            }
        })
    }
}
