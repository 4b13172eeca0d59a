//! Functions that are open while a lone core runs a work item, as inclusive totals count them: from a call to its return, and from a jump into another
//! function to the return of the call in which it happens.

use isa::Program;

/// Place in a work item: clocks of computing up to it, and transfers that were asked for before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ItemPlace {
    /// Clocks of computing.
    pub busy: u64,
    /// Transfers.
    pub transfers: usize,
}

/// A function that is open, or was, in a lone run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OpenFunction {
    /// Number of the function among the program's regions; `None` outside of all.
    pub function: Option<u16>,
    /// Functions that were open around it.
    pub depth: usize,
    /// Calls that were open when it was entered.
    calls: usize,
    /// Place where it was entered.
    pub start: ItemPlace,
    /// Place where it was left, once it is.
    pub end: ItemPlace,
}

/// Functions that are open in a lone run.
#[derive(Debug, Default)]
pub struct FunctionStack {
    open: Vec<OpenFunction>,
    /// By call: how many are open in it, and the functions around the place that was reached last.
    current: Vec<(usize, Vec<u16>)>,
    closed: Vec<OpenFunction>,
}

/// Functions around a word, the outermost first.
pub fn functions_around(program: &Program, pc: u32) -> Vec<u16> {
    let mut around = Vec::new();
    let mut next = program.region_of.get(pc as usize).copied().flatten();
    while let Some(number) = next
        && let Some(region) = program.regions.get(usize::from(number))
    {
        around.extend(region.is_function.then_some(number));
        // A region is listed after the one around it; anything else would be a loop.
        next = region.parent.filter(|&parent| parent < number);
    }
    around.reverse();
    around
}

impl FunctionStack {
    /// Control comes to a place in some functions, the outermost first, with so many calls open.
    ///
    /// A jump from one function into another one opens that and leaves the first one open; one that the same call has open is not opened again. Of a call
    /// of `f`, which jumps to `g`, which jumps to `f`, the function `f` is open from the call to the return, and `g` from the first jump to the return.
    pub fn go(&mut self, around: &[u16], calls: usize, place: ItemPlace) {
        // Calls that have returned
        self.close(place, |open| open.calls > calls);
        while self.current.pop_if(|(at, _)| *at > calls).is_some() {}
        let before = match self.current.last_mut().filter(|(at, _)| *at == calls) {
            Some((_, before)) if before == around => return,
            Some((_, before)) => Some(std::mem::replace(before, around.to_vec())),
            None => {
                self.current.push((calls, around.to_vec()));
                None
            }
        };
        // What the call leaves
        match before.as_deref() {
            Some([left, inner @ ..]) if around.first() == Some(left) => {
                let kept = inner.iter().zip(&around[1..]).take_while(|(left, reached)| left == reached).count();
                let left = &inner[kept..];
                self.close(place, |open| open.calls == calls && open.function.is_some_and(|own| left.contains(&own)));
            }
            Some([_, ..]) if !around.is_empty() => {}
            _ => self.close(place, |open| open.calls == calls),
        }
        // What it enters
        let entered: Vec<Option<u16>> = match around {
            [] => vec![None],
            around => around.iter().copied().map(Some).collect(),
        };
        for function in entered {
            let mut own = self.open.iter().rev().take_while(|open| open.calls == calls);
            if own.all(|open| open.function != function) {
                let depth = self.open.len();
                self.open.push(OpenFunction { function, depth, calls, start: place, end: place });
            }
        }
    }

    /// Closes the newest functions, as long as something holds of them.
    fn close(&mut self, place: ItemPlace, is_left: impl Fn(&OpenFunction) -> bool) {
        while let Some(ended) = self.open.pop_if(|open| is_left(open)) {
            self.closed.push(OpenFunction { end: place, ..ended });
        }
    }

    /// All functions, those that are open being left at a place.
    pub fn end(mut self, place: ItemPlace) -> Vec<OpenFunction> {
        self.close(place, |_| true);
        self.closed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Spans of functions, given functions and open calls at each of some places.
    fn spans(places: &[(&[u16], usize)]) -> Vec<(Option<u16>, usize, u64, u64)> {
        let mut stack = FunctionStack::default();
        let place = |busy: usize| ItemPlace { busy: busy as u64, transfers: 0 };
        for (at, (around, calls)) in places.iter().enumerate() {
            stack.go(around, *calls, place(at));
        }
        let mut found = stack.end(place(places.len()));
        found.sort_by_key(|open| (open.start, open.depth));
        found.iter().map(|open| (open.function, open.depth, open.start.busy, open.end.busy)).collect()
    }

    #[test]
    fn functions_are_open_from_calls_and_jumps_to_returns() {
        // 0 calls 1, which returns and is called again.
        let calls = spans(&[(&[0], 0), (&[1], 1), (&[0], 0), (&[1], 1), (&[0], 0)]);
        assert_eq!(calls, [(Some(0), 0, 0, 5), (Some(1), 1, 1, 2), (Some(1), 1, 3, 4)]);
        // 0 calls 1, which jumps to 2, that to 1 and 3, from where it returns.
        let jumps = spans(&[(&[0], 0), (&[1], 1), (&[2], 1), (&[1], 1), (&[3], 1), (&[0], 0)]);
        assert_eq!(jumps, [(Some(0), 0, 0, 6), (Some(1), 1, 1, 5), (Some(2), 2, 2, 5), (Some(3), 3, 4, 5)]);
        // A jump to where no function is ends all that has jumped there.
        let outside = spans(&[(&[0], 0), (&[1], 0), (&[], 0), (&[0], 0)]);
        assert_eq!(outside, [(Some(0), 0, 0, 2), (Some(1), 1, 1, 2), (None, 0, 2, 3), (Some(0), 0, 3, 4)]);
        // A function inside of another one is left when control runs on behind it.
        let inner = spans(&[(&[0], 0), (&[0, 1], 0), (&[0], 0), (&[0, 2], 0)]);
        assert_eq!(inner, [(Some(0), 0, 0, 4), (Some(1), 1, 1, 2), (Some(2), 1, 3, 4)]);
    }
}
