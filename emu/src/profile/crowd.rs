//! Regions that are open where calling contexts are too many to be told apart: counted one by one, as calls and jumps enter and leave them.

/// Open regions where there is no room for a context.
#[derive(Clone, Debug)]
pub struct Crowd {
    /// Number of the first call in which there is no context.
    pub bottom: usize,
    /// By region: how often it is open.
    open: Vec<u32>,
    /// Regions that were left by jumps into other functions, each once a call, behind the number of calls that were open then.
    tails: Vec<(usize, u16)>,
}

impl Crowd {
    /// The crowd where so much is open by region.
    pub fn new(bottom: usize, open: Vec<u32>) -> Crowd {
        Crowd { bottom, open, tails: Vec::new() }
    }

    /// A region is open.
    pub fn is_open(&self, region: u16) -> bool {
        self.open[usize::from(region)] != 0
    }

    /// A call comes from so many regions.
    pub fn enter(&mut self, around: &[u16]) {
        around.iter().for_each(|&region| self.open[usize::from(region)] += 1);
    }

    /// A call from so many regions has ended.
    pub fn leave(&mut self, around: &[u16]) {
        around.iter().for_each(|&region| self.open[usize::from(region)] -= 1);
    }

    /// Regions from which a function jumps into another one are open for the rest of the call, and once however often that happens.
    pub fn enter_tail(&mut self, calls: usize, around: &[u16]) {
        for &region in around {
            let mut own = self.tails.iter().rev().take_while(|(at, _)| *at == calls);
            if own.all(|&(_, other)| other != region) {
                self.tails.push((calls, region));
                self.enter(&[region]);
            }
        }
    }

    /// Calls have ended, so that only so many are open; or the last of these has left all functions to which it had jumped, if it is not counted.
    pub fn leave_tails(&mut self, calls: usize) {
        while let Some((_, region)) = self.tails.pop_if(|(at, _)| *at > calls) {
            self.leave(&[region]);
        }
    }
}
