//! Clocks of computing by calling context and innermost region, a cell each, so that those of a work item can be told from those of the next.

/// Cells, those of a context together.
#[derive(Clone, Debug)]
pub struct ClockCells {
    cells: Vec<u64>,
    /// Cells of a context.
    stride: usize,
    /// Cells that were in use before.
    used: Vec<u32>,
}

impl ClockCells {
    /// Cells of one context, all empty; a context has `stride` of them.
    pub fn new(stride: usize) -> ClockCells {
        ClockCells { cells: vec![0; stride], stride, used: Vec::new() }
    }

    /// Room for another context.
    pub fn add_context(&mut self) {
        self.cells.resize(self.cells.len() + self.stride, 0);
    }

    /// Adds clocks to a cell.
    #[inline]
    pub fn add(&mut self, cell: u32, clocks: u64) {
        if let Some(sum) = self.cells.get_mut(cell as usize) {
            *sum += clocks;
        }
    }

    /// The first cell, for generated code that adds to cells by itself.
    pub fn first(&mut self) -> *mut u64 {
        self.cells.as_mut_ptr()
    }

    /// The first cell of a context.
    pub fn first_of(&mut self, context: u32) -> *mut u64 {
        self.cells[self.stride * context as usize..].as_mut_ptr()
    }

    /// All cells.
    pub fn all(&self) -> &[u64] {
        &self.cells
    }

    /// Empties the cells, which have so many clocks together, and hands the contents of those that were not empty over.
    ///
    /// One item is much like another, so the cells that were in use before mostly have all: only where a clock is missing, all are looked at.
    pub fn take(&mut self, clocks: u64, found: &mut Vec<(u32, u64)>) {
        let mut left = clocks;
        for &cell in &self.used {
            let taken = std::mem::take(&mut self.cells[cell as usize]);
            if taken != 0 {
                left = left.wrapping_sub(taken);
                found.push((cell, taken));
            }
        }
        if left != 0 {
            for (cell, clocks) in (0..).zip(&mut self.cells).filter(|(_, clocks)| **clocks != 0) {
                found.push((cell, std::mem::take(clocks)));
                self.used.push(cell);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_found_when_they_are_used_first_and_later() {
        let mut cells = ClockCells::new(3);
        let taken = |cells: &mut ClockCells, clocks| {
            let mut found = Vec::new();
            cells.take(clocks, &mut found);
            found
        };
        cells.add_context();
        cells.add(1, 5);
        assert_eq!(taken(&mut cells, 5), [(1, 5)]);
        cells.add(1, 2);
        cells.add(4, 3);
        assert_eq!(taken(&mut cells, 5), [(1, 2), (4, 3)]);
        cells.add(4, 7);
        assert_eq!(taken(&mut cells, 7), [(4, 7)]);
        assert!(taken(&mut cells, 0).is_empty() && cells.all() == [0; 6]);
    }
}
