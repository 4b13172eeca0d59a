//! Heat map of a campaign: a row of cells for each part of each structure, a column for each bit, the highest on the left.

use std::collections::BTreeMap;

use super::FaultCampaign;
use super::row::InjectionRow;
use crate::files::map;
use crate::files::picture::Pixels;

/// Width and height of a cell in pixels.
const CELL: u32 = 10;

/// Bits of the longest number, an accumulator's.
const BITS: u32 = 64;

/// Colour of bits that are not there, and of those that no injection hit.
const NONE: [u8; 3] = [0; 3];

/// Rows of the map from the top: the parts of the structures, by their names.
fn parts(campaign: &FaultCampaign, rows: &[InjectionRow]) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for kind in &campaign.kinds {
        let of_kind = rows.iter().filter(|row| row.kind == kind.name());
        let mut names: Vec<&str> = of_kind.map(|row| row.structure.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        found.extend(names.into_iter().map(|name| (kind.name().to_owned(), name.to_owned())));
    }
    found
}

/// Map of the shares of harmful injections by the lowest bit that flips: dark for none, bright for all, black where there was no injection.
pub fn map(campaign: &FaultCampaign, rows: &[InjectionRow]) -> Pixels {
    let parts = parts(campaign, rows);
    let mut counts: BTreeMap<(usize, u32), (u64, u64)> = BTreeMap::new();
    for row in rows {
        let part = parts.iter().position(|(kind, structure)| (kind, structure) == (&row.kind, &row.structure));
        if let (Some(part), Some(&bit)) = (part, row.bits.first()) {
            let (all, harmful) = counts.entry((part, bit)).or_default();
            *all += 1;
            *harmful += u64::from(row.class.is_harmful());
        }
    }
    let cell = |part: usize, bit: u32| match counts.get(&(part, bit)) {
        Some(&(all, harmful)) => map::colour(harmful as f64 / all as f64),
        None => NONE,
    };
    let (width, height) = (CELL * BITS, CELL * (parts.len() as u32).max(1));
    let pixel = |at: u32| cell((at / width / CELL) as usize, BITS - 1 - at % width / CELL);
    Pixels { size: (width, height), colours: (0..width * height).map(pixel).collect() }
}
