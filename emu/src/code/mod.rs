//! A program decoded once, with what each exit of each word costs. Counting happens elsewhere.
//!
//! A word is a slot of the same number. An extension instruction is the first slot of its body; the other slots of that stand behind all
//! words, with a slot without an instruction between them, and lead back. Slots are ordinary rows, so an engine needs to know only that
//! [`Slot::next`] comes after a slot, that registers go up to 63 (wide ones to 15), that some passes are no instructions, and that only
//! bodies lead behind the words: see [`Code::is_outside`].

pub(crate) mod layout;
pub mod octets;
pub mod quantity;
pub mod registers;
mod splice;
pub mod tally;
pub mod timing;
pub mod trap;
mod turns;

use std::any::Any;
use std::fmt;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use isa::{Counts, Fields, InstructionDef, Isa, Kind, Op, OutcomeDef, Program};
use messages::{Diagnostic, Place};

use quantity::Clocks;
use splice::{Passing, SpliceTarget, splice};
use timing::Timing;
pub use turns::Turns;

/// Most slots of all bodies of a program.
pub const MOST_BODY_SLOTS: usize = 1 << 18;

/// One instruction, decoded.
#[derive(Clone, Copy, Debug)]
pub struct Slot {
    /// The instruction; `None` for a word that is none, which traps when it is executed.
    pub op: Option<Op>,
    /// Operands.
    pub fields: Fields,
    /// Number of the pass through its first exit; those of its other exits follow.
    pub first_outcome: u32,
    /// The slot after it, unless it leads elsewhere.
    pub next: u32,
}

/// Cost that one exit of one slot adds to a run, apart from its units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OutcomeCost {
    /// Time.
    pub clocks: u32,
    /// Elementary operations: add, sub, mul, div and cmp.
    pub elementary: u32,
    /// Units take clocks or elementary operations; octets do not, as long as the bus accounts for them.
    pub has_busy_units: bool,
    /// True for a step of a body that goes on: no instruction of the program ends with it.
    pub is_inner: bool,
    /// Cost of the units where one takes as long as another, several of them at once.
    pub turns: Option<Turns>,
}

/// Owner of a pass, and what the pass counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pass {
    /// The word for which it counts.
    pub word: u32,
    /// The exit of the word's row; `None` for steps of a body that go on.
    pub exit: Option<u8>,
    /// The row and its exit whose cost it has; `None` for nothing.
    cost: Option<(Op, u8)>,
}

/// Rows that a pass counts by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PassRows {
    /// The word for which it counts.
    pub word: u32,
    /// The row and its outcome whose operations it has; `None` for nothing.
    pub counted: Option<(Op, u8)>,
    /// The instruction of the program that ends with it, or the step of an expanded body; `None` for other steps of bodies.
    pub instruction: Option<Op>,
}

/// A slot behind the words.
#[derive(Clone, Copy, Debug)]
struct Inner {
    word: u32,
    step: u32,
}

/// A decoded program.
#[derive(Clone, Debug)]
pub struct Code<'a> {
    /// The program.
    pub program: &'a Program,
    /// Instruction set of its instructions.
    pub isa: &'a Isa,
    /// Times of operations.
    pub timing: Timing,
    slots: Vec<Slot>,
    costs: Vec<OutcomeCost>,
    passes: Vec<Pass>,
    /// The first pass of each word, and the end of the last one's.
    starts: Vec<u32>,
    /// Owners of the slots behind the words.
    inner: Vec<Inner>,
    /// The words that bodies stand for, in their order.
    extended: Vec<(u32, Op)>,
    shared: Attachments,
}

/// Data that those who execute a program share.
#[derive(Clone, Debug, Default)]
struct Attachments(Arc<Mutex<Vec<Arc<dyn Any + Send + Sync>>>>);

/// The program's bodies have more slots than [`MOST_BODY_SLOTS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge;

impl fmt::Display for TooLarge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the bodies of the program's extension instructions have more than {MOST_BODY_SLOTS} instructions")
    }
}

impl From<TooLarge> for Diagnostic {
    fn from(error: TooLarge) -> Diagnostic {
        Diagnostic::error(error.to_string()).hint("call a function that has the instruction once")
    }
}

/// Check that the bodies of a program's extension instructions fit.
///
/// # Errors
/// They do not; then [`Code::new`] leaves the last ones without a meaning.
pub fn check_bodies(program: &Program, isa: &Isa) -> Result<(), TooLarge> {
    if isa.extensions().next().is_none() {
        return Ok(());
    }
    let code = Code::new(program, isa, Timing::default());
    let is_left_out = |slot: &Slot| slot.op.is_some_and(|op| isa.runs_body(op));
    // A body that found no room left its instruction in the word's slot, which is how it shows.
    if code.slots.iter().any(is_left_out) { Err(TooLarge) } else { Ok(()) }
}

impl<'a> Code<'a> {
    /// Decodes a program.
    pub fn new(program: &'a Program, isa: &'a Isa, timing: Timing) -> Code<'a> {
        let words = program.words.len();
        let mut code = Code {
            program,
            isa,
            timing,
            slots: Vec::with_capacity(words),
            costs: Vec::new(),
            passes: Vec::new(),
            starts: Vec::with_capacity(words + 1),
            inner: Vec::new(),
            extended: Vec::new(),
            shared: Attachments::default(),
        };
        // The slots of bodies come behind all words, whose number is known.
        let mut behind: Vec<Slot> = Vec::new();
        for (word, &text) in (0..).zip(&program.words) {
            let instruction = isa.decode(text);
            let first_outcome = code.costs.len() as u32;
            code.starts.push(first_outcome);
            let mut slot = Slot { op: None, fields: Fields::default(), first_outcome, next: word + 1 };
            if let Some(instruction) = instruction {
                (slot.op, slot.fields) = (Some(instruction.op), instruction.fields);
                // An expanded body counts as if its steps stood in the program: they are the instructions and have the cost.
                let runs_body = isa.runs_body(instruction.op);
                let is_expanded = runs_body && isa.is_expanded(instruction.op);
                for exit in 0..isa.definition(instruction.op).outcomes.len() as u8 {
                    let cost = (!is_expanded).then_some((instruction.op, exit));
                    code.add(Pass { word, exit: Some(exit), cost }, is_expanded);
                }
                if runs_body {
                    slot = code.splice(slot, word, &mut behind);
                }
            }
            code.slots.push(slot);
        }
        code.starts.push(code.costs.len() as u32);
        if !behind.is_empty() {
            // What runs off the end of the program must not get into a body.
            code.slots.push(Slot { op: None, fields: Fields::default(), first_outcome: 0, next: words as u32 });
            code.slots.append(&mut behind);
        }
        code
    }

    fn add(&mut self, pass: Pass, is_inner: bool) -> u32 {
        let cost = pass.cost.map(|(op, exit)| &self.isa.definition(op).outcomes[usize::from(exit)]);
        // Costs beyond 32 bits saturate: engines that add up whole runs refuse such a program.
        let fit = |number: u64| u32::try_from(number).unwrap_or(u32::MAX);
        self.costs.push(OutcomeCost {
            clocks: cost.map_or(0, |exit| fit(self.timing.clocks(&exit.cost).0)),
            elementary: cost.map_or(0, |exit| fit(exit.cost.elementary())),
            has_busy_units: cost
                .is_some_and(|exit| self.timing.clocks(&exit.each).0 != 0 || exit.each.elementary() != 0),
            is_inner,
            turns: pass.cost.zip(cost).and_then(|((op, _), exit)| self.turns(op, exit)),
        });
        self.passes.push(pass);
        self.passes.len() as u32 - 1
    }

    fn turns(&self, op: Op, exit: &OutcomeDef) -> Option<Turns> {
        let at_once = match &*self.isa.definition(op).room {
            "packet" => self.timing.packet_lanes,
            "walk" => 1,
            _ => return None,
        };
        Some(Turns { at_once, clocks: self.timing.clocks(&exit.each).0, elementary: exit.each.elementary() })
    }

    /// Puts the body of the extension instruction at a word behind the words; its first slot takes the word's place.
    fn splice(&mut self, outer: Slot, word: u32, behind: &mut Vec<Slot>) -> Slot {
        let isa = self.isa;
        let Some(op) = outer.op else { return outer };
        let (row, Some(body)) = (isa.definition(op), isa.body(op)) else { return outer };
        let pieces = splice(body, row, isa, &outer.fields);
        if behind.len() + pieces.len() > MOST_BODY_SLOTS {
            return outer;
        }
        // The body's slot 0 stands at the word, and one slot is kept free behind the words: so slot `at` is at `base + at`.
        let base = self.words() + behind.len() as u32;
        let place = |at: usize| if at == 0 { word } else { base + at as u32 };
        let is_expanded = isa.is_expanded(op);
        let costs_body = is_expanded || row.outcomes.iter().any(|exit| exit.is_body);
        // Where steps cost nothing, they share passes.
        let most = pieces.iter().map(|piece| isa.definition(piece.op).outcomes.len()).max().unwrap_or(0);
        let free = self.passes.len() as u32;
        for _ in 0..most {
            self.add(Pass { word, exit: None, cost: None }, true);
        }
        self.extended.push((word, op));
        let mut first = outer;
        for (at, piece) in pieces.iter().enumerate() {
            let exits = isa.definition(piece.counted).outcomes.len() as u8;
            let first_outcome = match piece.passing {
                Passing::Step if costs_body => {
                    let first = self.passes.len() as u32;
                    for exit in 0..exits {
                        self.add(Pass { word, exit: None, cost: Some((piece.counted, exit)) }, !is_expanded);
                    }
                    first
                }
                Passing::StepAndExit(exit) if costs_body => {
                    self.add(Pass { word, exit: Some(exit), cost: Some((piece.counted, 0)) }, false)
                }
                Passing::Step | Passing::Move => free,
                Passing::Exit(exit) | Passing::StepAndExit(exit) => outer.first_outcome + u32::from(exit),
            };
            // Inside, places are those of slots; what leaves goes by words, and outside the program to its end.
            let next = match piece.way {
                SpliceTarget::Inside(to) => place(to),
                SpliceTarget::Behind => word + 1,
                SpliceTarget::Away(distance) => word.wrapping_add_signed(distance).min(self.words()),
            };
            let mut fields = piece.fields;
            // A branch inside the body has a distance in slots from where it stands now.
            if let Some((letter, to)) = piece.branch {
                fields.set(letter, place(to).wrapping_sub(place(at)) as i32);
            }
            let slot = Slot { op: Some(piece.op), fields, first_outcome, next };
            if at == 0 {
                first = slot;
            } else {
                behind.push(slot);
                self.inner.push(Inner { word, step: piece.step });
            }
        }
        first
    }

    /// Something that all who execute the program share: one of its type that is wanted, or a new one.
    #[cfg_attr(not(feature = "native"), expect(dead_code, reason = "native code alone is shared"))]
    pub(crate) fn share<T: Any + Send + Sync>(
        &self,
        is_wanted: impl Fn(&T) -> bool,
        make: impl FnOnce() -> T,
    ) -> Arc<T> {
        let mut shared = self.shared.0.lock().unwrap_or_else(PoisonError::into_inner);
        let known = shared.iter().filter_map(|known| known.clone().downcast().ok());
        known.into_iter().find(|known: &Arc<T>| is_wanted(known)).unwrap_or_else(|| {
            let made = Arc::new(make());
            shared.push(made.clone());
            made
        })
    }

    /// The slots: those of the words, then those of bodies.
    #[inline]
    pub fn slots(&self) -> &[Slot] {
        &self.slots
    }

    /// Number of words.
    #[inline]
    pub fn words(&self) -> u32 {
        self.program.words.len() as u32
    }

    /// The word to which a slot belongs.
    #[inline]
    pub fn word(&self, slot: u32) -> u32 {
        self.inner(slot).map_or(slot, |inner| inner.word)
    }

    fn inner(&self, slot: u32) -> Option<Inner> {
        self.inner.get(slot.checked_sub(self.words() + 1)? as usize).copied()
    }

    /// True where a control instruction in one slot leaves the program by leading to another: only a body leads behind the words.
    #[inline]
    pub fn is_outside(&self, from: u32, to: u32) -> bool {
        to >= self.words() && (to as usize >= self.slots.len() || !self.is_in_body(from))
    }

    fn is_in_body(&self, slot: u32) -> bool {
        slot > self.words() || self.has_body(slot)
    }

    /// True where a body stands in the place of a word.
    fn has_body(&self, word: u32) -> bool {
        self.extended.binary_search_by_key(&word, |&(word, _)| word).is_ok()
    }

    /// Target of the distance of a word's instruction: the word behind it where it has none, the program's end where it leads out.
    pub fn distant(&self, word: u32) -> u32 {
        let slot = &self.slots[word as usize];
        let operands = slot.op.map_or(&[][..], |op| &self.isa.definition(op).operands);
        let distance = operands.iter().find(|operand| operand.kind == Kind::Rel);
        let distance = distance.map_or(1, |operand| slot.fields.get(operand.letter) as i32);
        word.wrapping_add_signed(distance).min(self.words())
    }

    /// The row of a word; `None` for a word that is no instruction.
    pub fn row(&self, word: u32) -> Option<&InstructionDef> {
        Some(self.isa.definition(self.op(word)?))
    }

    /// The instruction of a word, as the program has it.
    pub fn op(&self, word: u32) -> Option<Op> {
        match self.extended.binary_search_by_key(&word, |&(word, _)| word) {
            Ok(at) => Some(self.extended[at].1),
            Err(_) => self.slots.get(word as usize).filter(|_| word < self.words())?.op,
        }
    }

    /// The row that a slot executes; `None` for a word that is no instruction.
    pub fn slot_row(&self, slot: u32) -> Option<&InstructionDef> {
        Some(self.isa.definition(self.slots.get(slot as usize)?.op?))
    }

    /// Place in the source of the body that a slot is a step of.
    pub fn body_place(&self, slot: u32) -> Option<Place> {
        let word = self.word(slot);
        let body = self.isa.body(self.op(word)?).filter(|_| self.has_body(word))?;
        body.place(self.inner(slot).map_or(0, |inner| inner.step as usize))
    }

    /// Costs of the passes, by number.
    pub fn costs(&self) -> &[OutcomeCost] {
        &self.costs
    }

    /// Owners of the passes, by number.
    pub fn passes(&self) -> &[Pass] {
        &self.passes
    }

    /// The passes of a word.
    pub fn passes_of(&self, word: u32) -> Range<usize> {
        match (self.starts.get(word as usize), self.starts.get(word as usize + 1)) {
            (Some(&start), Some(&end)) => start as usize..end as usize,
            _ => 0..0,
        }
    }

    /// Rows that a pass counts by.
    ///
    /// # Panics
    /// On a number that no pass has.
    pub fn pass_rows(&self, pass: usize) -> PassRows {
        let (Pass { word, cost: counted, .. }, is_inner) = (self.passes[pass], self.costs[pass].is_inner);
        let own = self.op(word);
        let instruction = match own {
            Some(op) if self.has_body(word) && self.isa.is_expanded(op) => counted.map(|(op, _)| op),
            own => own,
        };
        PassRows { word, counted, instruction: instruction.filter(|_| !is_inner) }
    }

    /// Cost of a pass, and what each of its units adds.
    pub fn pass_cost(&self, pass: usize) -> (Counts, Counts) {
        match self.passes.get(pass).and_then(|pass| pass.cost) {
            Some((op, exit)) => {
                let exit = &self.isa.definition(op).outcomes[usize::from(exit)];
                (exit.cost, exit.each)
            }
            None => (Counts::ZERO, Counts::ZERO),
        }
    }

    /// Clocks and elementary operations that `units` units add to a pass.
    #[inline]
    pub fn unit_cost(&self, pass: usize, units: u32) -> (Clocks, u64) {
        match self.costs.get(pass) {
            Some(OutcomeCost { turns: Some(turns), .. }) => turns.cost(units),
            _ => self.uneven_unit_cost(pass, units),
        }
    }

    /// Clocks and elementary operations that `units` units add to a pass, where they have no [`Turns`].
    pub fn uneven_unit_cost(&self, pass: usize, units: u32) -> (Clocks, u64) {
        let (cost, each) = self.pass_cost(pass);
        let each = each.times(units.into());
        (self.timing.clocks(&(cost + each)) - self.timing.clocks(&cost), each.elementary())
    }
}
