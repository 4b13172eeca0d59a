//! Functions and regions around each slot of a program, from the outermost to the innermost.

use crate::code::Code;

/// Nesting of a program's regions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegionNesting {
    /// The innermost region of each slot.
    innermost: Vec<Option<u16>>,
    /// Regions from the outermost to a region itself.
    chains: Vec<Vec<u16>>,
}

impl RegionNesting {
    /// Those of a program.
    pub fn new(code: &Code) -> RegionNesting {
        let regions = &code.program.regions;
        let innermost = |slot: u32| code.program.region_of.get(code.word(slot) as usize).copied().flatten();
        let chain = |number: usize| {
            let mut chain = vec![number as u16];
            // A region is listed after the one around it; anything else would be a loop.
            while let Some(parent) = regions[usize::from(chain[chain.len() - 1])].parent
                && parent < chain[chain.len() - 1]
            {
                chain.push(parent);
            }
            chain.reverse();
            chain
        };
        RegionNesting {
            innermost: (0..code.slots().len() as u32).map(innermost).collect(),
            chains: (0..regions.len()).map(chain).collect(),
        }
    }

    /// Number of regions.
    pub fn count(&self) -> usize {
        self.chains.len()
    }

    /// The innermost region of a slot.
    #[inline]
    pub fn innermost(&self, slot: u32) -> Option<u16> {
        self.innermost.get(slot as usize).copied().flatten().filter(|&region| usize::from(region) < self.chains.len())
    }

    /// Regions around a slot, the outermost first.
    #[inline]
    pub fn around(&self, slot: u32) -> &[u16] {
        self.chain(self.innermost(slot))
    }

    /// Regions from the outermost to a region itself.
    #[inline]
    pub fn chain(&self, innermost: Option<u16>) -> &[u16] {
        innermost.and_then(|region| self.chains.get(usize::from(region))).map_or(&[], Vec::as_slice)
    }

    /// Regions that are entered where control goes from one slot to another one of the same call.
    pub fn entered(&self, from: u32, to: u32) -> &[u16] {
        if self.innermost(from) == self.innermost(to) {
            return &[];
        }
        let (left, reached) = (self.around(from), self.around(to));
        let kept = left.iter().zip(reached).take_while(|(left, reached)| left == reached).count();
        &reached[kept..]
    }
}
