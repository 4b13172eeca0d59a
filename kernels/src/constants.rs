//! The numbers that a scene's formats make of the kernels: shifts and limits, the same for the assembly (by the prelude) and for its
//! twins. What else a program is told about its scene is said in [`crate::prelude`].

use scenes::cadrage::Formats;
use scenes::image::MemoryImage;

/// Shifts and limits of a scene in a word length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Constants {
    /// Fraction bits of all quantities.
    pub formats: Formats,
    /// Bits by which a determinant of a direction and two edges is shifted right to fit twice the word; 0 where it is exact.
    pub edge_shift: u32,
    /// Bits by which a determinant of three edges is shifted right to fit twice the word; 0 where it is exact.
    pub t_shift: u32,
    /// Bits by which the determinant of a triangle's edges and a way to a point within [`NEAR`] units of its plane is shifted right to fit
    /// twice the word; 0 where it is exact.
    pub side_shift: u32,
    /// Fraction bits of the height of a point over a plane, in units of positions.
    pub side_fraction: u32,
    /// Constant offset of secondary rays for kernels of the user's own, raw: enough when positions are rounded to nearest.
    pub offset: i32,
    /// Constant offset of secondary rays in the profile `report`, whose distances are off by thousands of units, raw: 1/2^17 of the
    /// coordinates in a word of 32 bits.
    pub literal_offset: i32,
    /// A distance beyond all others, raw: that of the nearest hit as long as there is none.
    pub never: i32,
    /// Distance that the triangle test returns for a miss: the largest word, beyond [`Constants::never`].
    pub missed: i32,
    /// Packets that a ray may visit after its first one; there are not as many.
    pub most_steps: u32,
}

/// Units from a triangle's plane within which a point's height over it is certain not to overflow.
pub const NEAR: u32 = 16;

/// Units in the last place of a height, one way or the other, that its two roundings come to at most, whatever the mode: less than one for the
/// quotient, and for the determinant less than one as long as the normal's largest component exceeds 2^(side_fraction + side_shift).
pub const SIDE_MARGIN: i32 = 2;

impl Constants {
    /// The constants of an image.
    pub fn new(image: &MemoryImage) -> Constants {
        let formats = image.formats;
        let bits = difference_bits(image);
        // Sums of products: a determinant of a direction and two edges has three pairs of them, which takes 3 bits beyond the factors'.
        let (edge, reach) = (2 * bits + formats.direction + 3, 3 * bits + 3);
        let (side, near) = (2 * bits + 2, NEAR.ilog2());
        let spare = |needed: u32| needed.saturating_sub(2 * formats.word);
        let largest = i32::MAX >> (32 - formats.word);
        let offset = if formats.t == formats.position { 2 } else { 3 };
        Constants {
            formats,
            edge_shift: spare(edge),
            t_shift: spare(reach),
            side_shift: spare(side + near),
            side_fraction: side_fraction(formats.word),
            offset,
            literal_offset: offset.max(1 << (formats.word / 2 - 4)),
            // One below the distance of a miss, so that a miss is never nearer than what has been found.
            never: largest - 1,
            missed: largest,
            most_steps: image.tree.leaves as u32 + 1,
        }
    }

    /// Bits by which the ratio of the two determinants of a hit is shifted left to be a distance. A program whose formats make this
    /// negative cannot be assembled.
    pub fn t_quotient(&self) -> u32 {
        let Formats { direction, t, position, .. } = self.formats;
        (direction as i32 + t - position + self.t_shift as i32 - self.edge_shift as i32).max(0) as u32
    }

    /// Fraction bits of the product of a direction and a distance beyond those of a position; as in [`Constants::t_quotient`], not negative.
    pub fn along(&self) -> u32 {
        let Formats { direction, t, position, .. } = self.formats;
        (direction as i32 + t - position).max(0) as u32
    }

    /// Fraction bits of the product of a direction and a position beyond those of a distance; as in [`Constants::t_quotient`], not negative.
    pub fn across(&self) -> u32 {
        let Formats { direction, t, position, .. } = self.formats;
        (direction as i32 + position - t).max(0) as u32
    }
}

/// Fraction bits of the height of a point over a plane: 8, fewer in words that would not hold [`NEAR`] units and a sign beside them.
pub const fn side_fraction(word: u32) -> u32 {
    if word < 14 { word - 6 } else { 8 }
}

/// Bits of the widest difference of two coordinates, in the sense |difference| < 2^n.
fn difference_bits(image: &MemoryImage) -> u32 {
    let reach = image.bounds.union(&image.grid.reach);
    let widest = (0..3).map(|k| i64::from(reach.high[k]) - i64::from(reach.low[k]) + 1).max().unwrap_or(1);
    64 - widest.leading_zeros()
}
