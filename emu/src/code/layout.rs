//! The slots of a program in an order in which an engine goes through them one behind the other: each word, then what else the body has
//! that stands for it and can be reached. Where control goes on elsewhere than to what stands behind, there is a hop.

use std::ops::Range;

use isa::Kind;

use crate::code::Code;

/// Occupant of a place of the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// A slot.
    Slot(u32),
    /// The way to a slot that does not stand behind the one before. It is no instruction and takes no time.
    Hop(u32),
}

impl Stage {
    /// The slot that stands here, or to which the hop leads.
    pub fn slot(self) -> u32 {
        match self {
            Stage::Slot(slot) | Stage::Hop(slot) => slot,
        }
    }
}

/// The order. Where no body stands for a word, the places are the words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Order {
    stages: Vec<Stage>,
    /// By slot; the place behind all stages is that of the program's end.
    places: Vec<u32>,
    /// The slot behind the last word.
    end: u32,
}

impl Order {
    /// The order of a program's slots.
    pub fn new(code: &Code) -> Order {
        let (slots, words) = (code.slots(), code.words());
        let mut stages = Vec::with_capacity(slots.len());
        let mut inner = words + 1;
        for word in 0..words {
            // Bodies stand in the order of their words, so that of this word begins where the last one ended.
            let body = inner..slots.len() as u32;
            let body = inner..inner + body.take_while(|&slot| code.word(slot) == word).count() as u32;
            let is_reached = reached(code, word, &body);
            let first = std::mem::replace(&mut inner, body.end);
            let mut here = word;
            for following in body.filter(|slot| is_reached[(slot - first) as usize]).chain([word + 1]) {
                stages.push(Stage::Slot(here));
                let next = slots[here as usize].next;
                if next != following {
                    stages.push(Stage::Hop(next));
                }
                here = following;
            }
        }
        // Slots that nothing reaches have the end for a place, where an engine stops and asks the interpreter.
        let mut places = vec![stages.len() as u32; slots.len().max(words as usize + 1)];
        for (place, stage) in (0..).zip(&stages) {
            if let Stage::Slot(slot) = stage {
                places[*slot as usize] = place;
            }
        }
        Order { stages, places, end: words }
    }

    /// Occupants by place.
    #[inline]
    pub fn stages(&self) -> &[Stage] {
        &self.stages
    }

    /// The slot at a place, or to which the hop there leads; the end of the program behind all places.
    #[inline]
    pub fn slot(&self, place: u32) -> u32 {
        self.stages.get(place as usize).map_or(self.end, |stage| stage.slot())
    }

    /// The place of a slot; that of the program's end for what is none.
    #[inline]
    pub fn place(&self, slot: u32) -> u32 {
        self.places.get(slot as usize).copied().unwrap_or(self.stages.len() as u32)
    }
}

/// Slots of the body that stands for a word, each true where control can come to it. The slots of a body's end are not reached where the step
/// before them leads back itself.
fn reached(code: &Code, word: u32, body: &Range<u32>) -> Vec<bool> {
    let mut is_reached = vec![false; body.len()];
    // Search from the word on; each slot is opened once, so loops end.
    let mut open = vec![word];
    while let Some(slot) = open.pop() {
        let decoded = &code.slots()[slot as usize];
        let row = code.slot_row(slot).filter(|_| !body.is_empty());
        let distance = row.and_then(|row| row.operands.iter().find(|operand| operand.kind == Kind::Rel));
        let away = distance.map(|distance| slot.wrapping_add_signed(decoded.fields.get(distance.letter) as i32));
        for next in away.into_iter().chain([decoded.next]).filter(|next| body.contains(next)) {
            if !std::mem::replace(&mut is_reached[(next - body.start) as usize], true) {
                open.push(next);
            }
        }
    }
    is_reached
}
