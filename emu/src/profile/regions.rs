//! Functions and regions around each slot of a program, from the outermost to the innermost.

use crate::code::Code;

/// Nesting of a program's regions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegionNesting {
    /// The innermost region of each slot.
    innermost: Vec<Option<u16>>,
    /// Regions from the outermost to a region itself.
    chains: Vec<Vec<u16>>,
    /// The outermost function around a region or of that region.
    functions: Vec<Option<u16>>,
}

/// Way in which control leaves the body of a function without a call or a return.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FunctionChange {
    /// Into the body of another function, which returns where the first one would have: a call with a return behind it.
    TailCall,
    /// To where there is no function.
    Outside,
}

impl RegionNesting {
    /// Finds the nesting of a program's regions.
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
        let chains: Vec<Vec<u16>> = (0..regions.len()).map(chain).collect();
        let function =
            |chain: &Vec<u16>| chain.iter().copied().find(|&region| regions[usize::from(region)].is_function);
        RegionNesting {
            innermost: (0..code.slots().len() as u32).map(innermost).collect(),
            functions: chains.iter().map(function).collect(),
            chains,
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

    /// The outermost function around a slot. Functions within it are pieces of it, as regions are.
    fn function(&self, slot: u32) -> Option<u16> {
        self.innermost(slot).and_then(|region| self.functions[usize::from(region)])
    }

    /// Change of the function where control goes from one slot to another one by a jump or by running on; `None` where it stays in a function, or
    /// comes from where there is none.
    pub fn change(&self, from: u32, to: u32) -> Option<FunctionChange> {
        match (self.function(from)?, self.function(to)) {
            (left, Some(reached)) if left == reached => None,
            (_, Some(_)) => Some(FunctionChange::TailCall),
            (_, None) => Some(FunctionChange::Outside),
        }
    }

    /// Regions that are entered where control goes from one slot to another one of the same call: those that are not around both, and all of them where it
    /// leaves a function.
    pub fn entered(&self, from: u32, to: u32) -> &[u16] {
        if self.innermost(from) == self.innermost(to) {
            return &[];
        }
        let (left, reached) = (self.around(from), self.around(to));
        let kept = match self.change(from, to) {
            None => left.iter().zip(reached).take_while(|(left, reached)| left == reached).count(),
            Some(_) => 0,
        };
        &reached[kept..]
    }
}
