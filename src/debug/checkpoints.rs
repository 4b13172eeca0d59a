//! Checkpoints of a session: close to each other near the present and ever farther apart away from it, so that small motions back are quick and the
//! memory that all of them take is bounded.

use std::collections::{BTreeMap, BTreeSet};

use emu::stepper::Checkpoint;

/// Instructions between checkpoints right before the present, at first.
const NEAREST: u64 = 64;

/// Checkpoints between a distance from the present and twice that distance, at first.
const AN_OCTAVE: u64 = 8;

/// Instructions between the checkpoints of a motion whose end is not known.
const RUNNING: u64 = 1024;

/// Checkpoints by position, of which the first one is the start.
pub struct Checkpoints {
    kept: BTreeMap<u64, Checkpoint>,
    /// Positions whose state was changed by hand; their checkpoints are those changed.
    changed: BTreeSet<u64>,
    /// Number that is kept at most.
    most: usize,
    nearest: u64,
    an_octave: u64,
}

impl Checkpoints {
    /// The start alone.
    pub fn new(start: Checkpoint, most: usize) -> Checkpoints {
        let kept = [(0, start)].into();
        Checkpoints { kept, changed: BTreeSet::new(), most, nearest: NEAREST, an_octave: AN_OCTAVE }
    }

    /// The start.
    pub fn start(&self) -> &Checkpoint {
        self.kept.first_key_value().expect("the start is always kept").1
    }

    /// The last one up to a position.
    pub fn before(&self, position: u64) -> (u64, &Checkpoint) {
        let (at, checkpoint) = self.kept.range(..=position).next_back().expect("the start is always kept");
        (*at, checkpoint)
    }

    /// Instructions between checkpoints at a distance from the present: a power of two, so that what is kept now is among what would have been
    /// kept when it was nearer.
    ///
    /// At 100,000 instructions from the present, eight lie between 65,536 and 131,072, so they are 8192 apart.
    fn spacing(&self, distance: u64) -> u64 {
        let octave = 1 << distance.max(1).ilog2();
        (octave / self.an_octave).max(self.nearest)
    }

    /// The next position behind this one at which a motion to `end` takes a checkpoint, or has to take over what was changed by hand.
    pub fn next(&self, position: u64, end: u64) -> u64 {
        let spacing = self.spacing(end.saturating_sub(position));
        let due = (position / spacing).saturating_add(1).saturating_mul(spacing);
        let changed = self.changed.range(position + 1..).next().copied().unwrap_or(u64::MAX);
        due.min(changed)
    }

    /// The state of a position was changed by hand.
    pub fn is_changed(&self, position: u64) -> bool {
        self.changed.contains(&position)
    }

    /// Keeps a changed state. What was behind it would be of the old future.
    pub fn change(&mut self, position: u64, checkpoint: Checkpoint) {
        self.kept.split_off(&position);
        self.changed.split_off(&position);
        self.kept.insert(position, checkpoint);
        self.changed.insert(position);
    }

    /// Keeps a checkpoint where one is due on the way to `end`, or on a way whose end is not known.
    pub fn arrive(&mut self, position: u64, end: Option<u64>, checkpoint: impl FnOnce() -> Checkpoint) {
        let spacing = end.map_or(RUNNING, |end| self.spacing(end.saturating_sub(position)));
        if !position.is_multiple_of(spacing) || self.kept.contains_key(&position) {
            return;
        }
        self.kept.insert(position, checkpoint());
        if self.kept.len() > self.most {
            self.thin(end.unwrap_or(position));
        }
    }

    /// Drops what lies closer together than it has to at its distance from the present, until an eighth of the places is free; where that is not
    /// enough, all lie farther apart from now on.
    fn thin(&mut self, present: u64) {
        loop {
            let mut kept = std::mem::take(&mut self.kept);
            // What was changed by hand must stay: a run from further back would not come to it.
            kept.retain(|&at, _| {
                at == 0 || self.changed.contains(&at) || at.is_multiple_of(self.spacing(present.abs_diff(at)))
            });
            self.kept = kept;
            if self.kept.len() <= self.most - self.most / 8 || self.kept.len() <= self.changed.len() + 1 {
                break;
            }
            match self.an_octave {
                1 => self.nearest *= 2,
                _ => self.an_octave /= 2,
            }
        }
        self.most = self.most.max(self.changed.len() + 2);
    }
}
