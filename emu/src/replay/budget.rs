//! Memory for the segments of work items that are recorded at the same time; what does not fit is stepped.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Budget for the segments of work items that are recorded at the same time.
pub struct Budget {
    taken: AtomicUsize,
    most: usize,
}

impl Budget {
    /// Segments that a long work item takes budget for at once.
    pub(super) const SHARE: usize = 4096;

    /// For that many segments.
    pub fn new(most: usize) -> Budget {
        Budget { taken: AtomicUsize::new(0), most }
    }

    /// True where more was wanted than there is.
    pub fn is_full(&self) -> bool {
        self.taken.load(Ordering::Relaxed) > self.most
    }

    /// Takes budget for segments; false when there is none.
    pub(super) fn take(&self, segments: usize) -> bool {
        self.taken.fetch_add(segments, Ordering::Relaxed) + segments <= self.most
    }
}
