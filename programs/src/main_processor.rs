//! Programs of the main processor, which hands work out and takes answers in.

use isa::{Op, Program};

use crate::builder::program;

/// Main program that hands out `items` pieces of work, one at a time to each core, and stores what comes back.
///
/// The answer's first vector holds the number of the item, which is also where its word of the answer goes.
pub fn dispatch(items: i32) -> Program {
    program(|p| {
        let (feed, drain, done) = (p.label(), p.label(), p.label());
        p.emit(Op::movi, &[1, 0]).constant(2, items).emit(Op::cores, &[3]).emit(Op::movi, &[4, 0]);
        // s1 next item, s4 answers so far, s5 core to feed first.
        p.emit(Op::movi, &[5, 0]);
        p.place(feed);
        p.branch(Op::bge, &[5, 3], drain);
        p.branch(Op::bge, &[1, 2], drain);
        p.emit(Op::vsplat, &[0, 1]).emit(Op::send5, &[5, 0]);
        p.emit(Op::iaddi, &[1, 1, 1]).emit(Op::iaddi, &[5, 5, 1]);
        p.branch(Op::jump, &[], feed);
        p.place(drain);
        p.branch(Op::beq, &[4, 2], done);
        p.emit(Op::recv2, &[8, 6]);
        p.emit(Op::vget, &[7, 8, 0]).emit(Op::vget, &[8, 9, 0]);
        p.emit(Op::slli, &[7, 7, 2]).emit(Op::stw, &[8, 7, 0]);
        p.emit(Op::iaddi, &[4, 4, 1]);
        p.branch(Op::bge, &[1, 2], drain);
        p.emit(Op::vsplat, &[0, 1]).emit(Op::send5, &[6, 0]).emit(Op::iaddi, &[1, 1, 1]);
        p.branch(Op::jump, &[], drain);
        p.place(done);
        p.emit(Op::halt, &[]);
    })
}
