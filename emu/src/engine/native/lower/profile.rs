//! Profiling in generated code: it adds up operations by class, and tells of calls, returns and borders of regions.

use cranelift_codegen::ir::types::{I32X4, I64};
use cranelift_codegen::ir::{ConstantData, InstBuilder, Value};
use isa::Counts;

use super::{Lower, flags};
use crate::engine::native::calls::{self, Went};
use crate::engine::native::classes::{LANES, Lanes, lanes};
use crate::engine::native::context::CLASSES;
use crate::semantics::Motion;

impl Lower<'_, '_> {
    /// Adds to four classes.
    fn add_four(&mut self, group: usize, more: Value) {
        let offset = CLASSES + 16 * group as i32;
        let sum = self.b.ins().load(I32X4, flags(), self.context, offset);
        let sum = self.b.ins().iadd(sum, more);
        self.b.ins().store(flags(), sum, self.context, offset);
    }

    fn add_lanes(&mut self, more: Lanes) {
        for (group, four) in more.chunks_exact(4).enumerate().filter(|(_, four)| **four != [0; 4]) {
            let octets: Vec<u8> = four.iter().flat_map(|lane| lane.to_le_bytes()).collect();
            let constant = self.b.func.dfg.constants.insert(ConstantData::from(octets));
            let more = self.b.ins().vconst(I32X4, constant);
            self.add_four(group, more);
        }
    }

    /// Adds what a block costs from a place on.
    pub fn spend_classes(&mut self, place: u32) {
        if let Some(classes) = self.source.classes {
            let span: Counts = classes.span(place, self.source.blocks.end[place as usize]);
            self.add_lanes(lanes(&span));
        }
    }

    /// Adds what an exit costs beside its block.
    pub fn pass_classes(&mut self, exit: usize) {
        if let Some(classes) = self.source.classes {
            self.add_lanes(classes.exits[exit]);
        }
    }

    /// Adds the cost of one of several exits that only the running program knows, by its number from `first` on.
    pub fn pass_classes_dynamic(&mut self, first: usize, exits: usize, number: Value) {
        let Some(classes) = self.source.classes else { return };
        let exits = &classes.exits[first..first + exits];
        let size = self.c64(size_of::<Lanes>() as i64);
        let offset = self.b.ins().imul(number, size);
        let table = self.c64(exits.as_ptr() as i64);
        let at = self.b.ins().iadd(table, offset);
        for group in (0..LANES / 4).filter(|group| exits.iter().any(|exit| exit[4 * group..4 * group + 4] != [0; 4])) {
            let more = self.b.ins().load(I32X4, flags(), at, 16 * group as i32);
            self.add_four(group, more);
        }
    }

    /// Tells that control goes from the current slot to another one.
    fn tell(&mut self, to: Value, motion: Motion) {
        let from = self.source.steps[self.place as usize].slot;
        let to = self.b.ins().uextend(I64, to);
        let to = self.b.ins().ishl_imm_s(to, 32);
        let ways = self.b.ins().bor_imm_s(to, i64::from(from));
        let function = self.c64(calls::went as Went as usize as i64);
        let motion = self.c64(motion as i64);
        self.b.ins().call_indirect(self.call, function, &[self.context, ways, motion]);
    }

    /// Tells of a call or a return, if anybody measures functions.
    pub fn tell_motion(&mut self, to: Value, motion: Motion) {
        if self.source.classes.is_some() {
            self.tell(to, motion);
        }
    }

    /// Tells of a call or a return that leads to a place.
    pub fn tell_motion_to(&mut self, to: u32, motion: Motion) {
        if self.source.classes.is_some() {
            let slot = self.slot(to);
            self.tell(slot, motion);
        }
    }

    /// Tells that control goes on at a place, where that belongs to another region.
    pub fn tell_border(&mut self, from: u32, to: u32) {
        if self.source.classes.is_some_and(|classes| classes.is_border(from, to)) {
            let slot = self.slot(to);
            self.tell(slot, Motion::Jump);
        }
    }

    fn slot(&mut self, place: u32) -> Value {
        let slot = self.source.steps[place as usize].slot;
        self.c32(slot as i32)
    }
}
