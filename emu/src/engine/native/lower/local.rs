//! Forms of the rows that touch the local buffer: little-endian at any alignment. What lies beyond its end is for the interpreter.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types::{I32, I32X4, I64, I64X2};
use cranelift_codegen::ir::{Endianness, InstBuilder, MemFlagsData, Value};

use super::{Form, LocalRoom, Lower, S, V, W, aligned, flags};
use crate::code::octets::Buffer;
use crate::engine::native::context::{BUFFER, WRITTEN};

/// A place in the buffer.
#[derive(Clone, Copy)]
struct BufferPlace {
    /// Address in the host's memory, without the offset.
    base: Value,
    offset: i32,
    /// Address in the buffer, and the same where it is known when code is generated.
    address: Value,
    known: Option<u32>,
}

/// Flags by which vectors of other types are seen as one of four components.
fn little() -> MemFlagsData {
    MemFlagsData::new().with_endianness(Endianness::Little)
}

impl Lower<'_, '_> {
    /// The place of some octets at `base + offset`; beyond the buffer the interpreter takes over.
    fn place(&mut self, base: S, offset: i32, octets: u32) -> BufferPlace {
        let size = self.source.recipe.buffer_octets;
        let pointer_flags = aligned().with_readonly();
        let known = u64::from(offset as u32) + u64::from(octets) <= u64::from(size);
        if base.0 == 0 && known {
            let base = self.b.ins().load(I64, pointer_flags, self.context, BUFFER);
            let address = self.c64((offset as u32).into());
            return BufferPlace { base, offset, address, known: Some(offset as u32) };
        }
        let address = self.s(base);
        let offset = self.c32(offset);
        let address = self.b.ins().iadd(address, offset);
        let is_outside = match size.checked_sub(octets) {
            Some(last) => {
                let last = self.c32(last as i32);
                self.b.ins().icmp(IntCC::UnsignedGreaterThan, address, last)
            }
            None => self.c32(1),
        };
        self.unless(is_outside);
        let address = self.b.ins().uextend(I64, address);
        let buffer = self.b.ins().load(I64, pointer_flags, self.context, BUFFER);
        let base = self.b.ins().iadd(buffer, address);
        BufferPlace { base, offset: 0, address, known: None }
    }

    /// Notes that octets at a place are written, so that a reset knows what to copy.
    fn note_written(&mut self, place: BufferPlace, octets: u32) {
        let piece = Buffer::piece_bits(self.source.recipe.buffer_octets);
        let written = self.b.ins().load(I64, aligned(), self.context, WRITTEN);
        let more = match place.known {
            Some(address) => self.c64(Buffer::pieces(piece, address as usize, octets as usize) as i64),
            None => {
                // The pieces from the first to the last one: as many ones as there are, moved to the first.
                let first = self.b.ins().ushr_imm_s(place.address, i64::from(piece));
                let last = self.b.ins().iadd_imm_s(place.address, i64::from(octets) - 1);
                let last = self.b.ins().ushr_imm_s(last, i64::from(piece));
                let ones = self.c64(-1);
                let above = self.c64(63);
                let above = self.b.ins().isub(above, last);
                let above = self.b.ins().iadd(above, first);
                let pieces = self.b.ins().ushr(ones, above);
                self.b.ins().ishl(pieces, first)
            }
        };
        let written = self.b.ins().bor(written, more);
        self.b.ins().store(aligned(), written, self.context, WRITTEN);
    }

    /// Three words of 32 bits as a vector.
    fn load_vector(&mut self, place: BufferPlace) -> Value {
        let low = self.b.ins().load(I64, flags(), place.base, place.offset);
        let high = self.b.ins().load(I32, flags(), place.base, place.offset + 8);
        let vector = self.b.ins().scalar_to_vector(I64X2, low);
        let vector = self.b.ins().bitcast(I32X4, little(), vector);
        self.b.ins().insertlane(vector, high, 2u8)
    }

    fn advance(&mut self, x: S, i: i32) -> Value {
        let (x, i) = (self.s(x), self.c32(i));
        self.b.ins().iadd(x, i)
    }
}

impl LocalRoom for Lower<'_, '_> {
    fn lbu(&mut self, a: S, i: i32) -> Form<(Value,)> {
        let place = self.place(a, i, 1);
        Form::Made((self.b.ins().uload8(I32, flags(), place.base, place.offset),))
    }

    fn lh(&mut self, a: S, i: i32) -> Form<(Value,)> {
        let place = self.place(a, i, 2);
        Form::Made((self.b.ins().sload16(I32, flags(), place.base, place.offset),))
    }

    fn lhu(&mut self, a: S, i: i32) -> Form<(Value,)> {
        let place = self.place(a, i, 2);
        Form::Made((self.b.ins().uload16(I32, flags(), place.base, place.offset),))
    }

    fn lw(&mut self, a: S, i: i32) -> Form<(Value,)> {
        let place = self.place(a, i, 4);
        Form::Made((self.b.ins().load(I32, flags(), place.base, place.offset),))
    }

    fn sb(&mut self, b: S, a: S, i: i32) -> Form<()> {
        let (place, b) = (self.place(a, i, 1), self.s(b));
        self.b.ins().istore8(flags(), b, place.base, place.offset);
        self.note_written(place, 1);
        Form::Made(())
    }

    fn sh(&mut self, b: S, a: S, i: i32) -> Form<()> {
        let (place, b) = (self.place(a, i, 2), self.s(b));
        self.b.ins().istore16(flags(), b, place.base, place.offset);
        self.note_written(place, 2);
        Form::Made(())
    }

    fn sw(&mut self, b: S, a: S, i: i32) -> Form<()> {
        let (place, b) = (self.place(a, i, 4), self.s(b));
        self.b.ins().store(flags(), b, place.base, place.offset);
        self.note_written(place, 4);
        Form::Made(())
    }

    fn lv(&mut self, a: S, i: i32) -> Form<(Value,)> {
        let place = self.place(a, i, 12);
        Form::Made((self.load_vector(place),))
    }

    fn sv(&mut self, b: V, a: S, i: i32) -> Form<()> {
        let (place, vector) = (self.place(a, i, 12), self.v(b));
        let high = self.b.ins().extractlane(vector, 2u8);
        let vector = self.b.ins().bitcast(I64X2, little(), vector);
        let low = self.b.ins().extractlane(vector, 0u8);
        self.b.ins().store(flags(), low, place.base, place.offset);
        self.b.ins().store(flags(), high, place.base, place.offset + 8);
        self.note_written(place, 12);
        Form::Made(())
    }

    fn lvh(&mut self, a: S, i: i32, j: i32) -> Form<(Value,)> {
        let place = self.place(a, i, 6);
        let components = [0, 2, 4].map(|at| {
            let half = self.b.ins().sload16(I64, flags(), place.base, place.offset + at);
            let shifted = self.b.ins().ishl_imm_s(half, i64::from(j));
            self.b.ins().ireduce(I32, shifted)
        });
        Form::Made((self.vector(components),))
    }

    fn lwide(&mut self, a: S, i: i32) -> Form<(Value,)> {
        let place = self.place(a, i, 8);
        Form::Made((self.b.ins().load(I64, flags(), place.base, place.offset),))
    }

    fn swide(&mut self, b: W, a: S, i: i32) -> Form<()> {
        let (place, b) = (self.place(a, i, 8), self.w(b));
        self.b.ins().store(flags(), b, place.base, place.offset);
        self.note_written(place, 8);
        Form::Made(())
    }

    fn lwp(&mut self, x: S, i: i32) -> Form<(Value, Value)> {
        let place = self.place(x, 0, 4);
        let word = self.b.ins().load(I32, flags(), place.base, place.offset);
        Form::Made((word, self.advance(x, i)))
    }

    fn lvp(&mut self, x: S, i: i32) -> Form<(Value, Value)> {
        let place = self.place(x, 0, 12);
        let vector = self.load_vector(place);
        Form::Made((vector, self.advance(x, i)))
    }

    fn swp(&mut self, b: S, x: S, i: i32) -> Form<(Value,)> {
        let (place, b) = (self.place(x, 0, 4), self.s(b));
        self.b.ins().store(flags(), b, place.base, place.offset);
        self.note_written(place, 4);
        Form::Made((self.advance(x, i),))
    }
}
