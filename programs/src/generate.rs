//! Generated work: straight code of any rows, branches on what registers hold, loops whose length they choose, and calls. All of it comes to an end,
//! and what it reads lies in the memory and the buffer unless an extension's row goes elsewhere.

use isa::{InstructionDef, Isa, Kind, Op};
use random::SplitMix64;

use crate::builder::ProgramBuilder;

/// Octets of global memory; answers lie in front.
pub const MEMORY: i64 = 2000;

/// Address from which work items read.
pub const DATA: i64 = 400;

/// Scalars that generated instructions may use; the rest are counters, links and the item's number.
pub const FREE: i64 = 19;

/// Scalar that holds the item's number.
pub const NUMBER: i64 = 22;

/// A number from 0 to below `end`, which is positive.
pub fn below(random: &mut SplitMix64, end: i64) -> i64 {
    random.below(end as u64) as i64
}

/// Global memory with numbers of all kinds.
pub fn image() -> Vec<u8> {
    (0..MEMORY as u32).map(|at| (at.wrapping_mul(2_654_435_761) >> 13) as u8).collect()
}

/// Takes the message of a work item; its number goes everywhere, changed a little each time, so that items differ.
pub fn scatter(p: &mut ProgramBuilder, random: &mut SplitMix64) {
    p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[NUMBER, 0, 0]).emit(Op::mov, &[1, NUMBER]);
    for register in 2..=FREE {
        let factor = random.bits() as i32 | 1;
        p.constant(register, factor >> below(random, 31)).emit(Op::iadd, &[1, 1, register]);
        p.emit(Op::imul, &[register, register, 1]);
    }
    for register in 0..32 {
        for lane in 0..3 {
            p.emit(Op::vput, &[register, 1 + below(random, FREE), lane]);
        }
    }
    for register in 0..8 {
        p.emit(Op::wjoin, &[register, 1 + below(random, FREE), 1 + below(random, FREE)]);
    }
}

/// All registers and a part of the buffer go into one word, which is sent as the answer before the item ends.
pub fn gather(p: &mut ProgramBuilder) {
    let add = |p: &mut ProgramBuilder, from: i64| {
        p.emit(Op::slli, &[23, 24, 5]).emit(Op::srli, &[24, 24, 27]).emit(Op::or, &[24, 24, 23]);
        p.emit(Op::iadd, &[24, 24, from]);
    };
    p.emit(Op::movi, &[24, 0]);
    for register in 0..=FREE {
        add(p, register);
    }
    for register in 0..8 {
        p.emit(Op::wlow, &[1, register]).emit(Op::whigh, &[2, register]);
        add(p, 1);
        add(p, 2);
    }
    for (register, lane) in (0..32).flat_map(|register| (0..3).map(move |lane| (register, lane))) {
        p.emit(Op::vget, &[1, register, lane]);
        add(p, 1);
    }
    for at in 0..24 {
        p.emit(Op::lw, &[1, 0, 16 * at]);
        add(p, 1);
    }
    p.emit(Op::vsplat, &[6, NUMBER]).emit(Op::vsplat, &[7, 24]).emit(Op::cores, &[20]);
    p.emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
}

/// An instruction of a row with operands at random; addresses stay in reach.
pub fn instruction(p: &mut ProgramBuilder, random: &mut SplitMix64, op: Op, row: &InstructionDef) {
    if matches!(op, Op::load | Op::loadf | Op::loadfu | Op::loadnode) {
        // Octets, numbers of up to 63 bits, or nodes of up to 12 octets, which are counted from address 0.
        let (base, most) = match op {
            Op::load => (DATA, 0x7f),
            Op::loadnode => (0, 0xf),
            _ => (DATA, 0xf),
        };
        p.emit(Op::movi, &[1, below(random, 200)]).emit(Op::andi, &[2, 2, 0xff]).emit(Op::iaddi, &[2, 2, base]);
        p.emit(Op::andi, &[3, 3, most]);
        let widths =
            row.operands[3..].iter().map(|operand| below(random, if operand.kind == Kind::Sh { 64 } else { 32 }));
        let operands: Vec<i64> = [1, 2, 3].into_iter().chain(widths.collect::<Vec<_>>()).collect();
        p.emit(op, &operands);
        return;
    }
    let has_address = row.room == "local" || row.room == "bus";
    if row.room == "packet" {
        // A packet of at most seven triangles.
        p.emit(Op::andi, &[4, 4, 0xff]).emit(Op::andi, &[5, 5, 7]);
    }
    if row.room == "walk" {
        // A block of three nodes, the first of which is the one to begin with.
        p.emit(Op::andi, &[4, 4, 0xff]).emit(Op::movi, &[5, 64]).emit(Op::sw, &[5, 4, 0]);
        p.emit(Op::movi, &[6, 24]).emit(Op::sw, &[6, 4, 4]).emit(Op::andi, &[6, 6, 0xff]);
    }
    if has_address {
        let base = if row.room == "bus" { DATA } else { 0 };
        p.emit(Op::andi, &[4, 4, 0xff]).emit(Op::iaddi, &[4, 4, base]);
    }
    let operand = |random: &mut SplitMix64, letter: u8, kind: Kind| {
        let width = row.pattern.fields().iter().find(|field| field.letter == letter).map_or(5, |field| field.width);
        let (least, most) = kind.range(width);
        match kind {
            Kind::A | Kind::S if has_address && (kind == Kind::A || letter == b'x') => 4,
            Kind::A if ["packet", "walk"].contains(&&*row.room) => 4,
            Kind::S if row.room == "packet" || row.room == "walk" && letter == b'x' => 5,
            Kind::S if row.room == "walk" => 6,
            Kind::S | Kind::A => below(random, FREE + 1),
            Kind::Off if has_address => below(random, 100),
            _ => least + below(random, most - least + 1),
        }
    };
    let operands: Vec<i64> = row.operands.iter().map(|o| operand(random, o.letter, o.kind)).collect();
    p.emit(op, &operands);
}

/// Rows that a work item may execute anywhere.
pub fn anywhere(op: &Op, isa: &Isa) -> bool {
    let row = isa.definition(*op);
    let is_write = matches!(op, Op::store | Op::stw | Op::stv | Op::fetchadd);
    let is_meeting = matches!(op, Op::send2 | Op::send5 | Op::recv2 | Op::recv5 | Op::barrier);
    row.room != "control" && !is_write && !is_meeting
}

/// A few instructions of any kind.
pub fn straight(p: &mut ProgramBuilder, random: &mut SplitMix64, isa: &Isa, count: i64) {
    let ops: Vec<Op> = Op::BUILT_IN.iter().copied().filter(|op| anywhere(op, isa)).collect();
    for _ in 0..count {
        let op = ops[below(random, ops.len() as i64) as usize];
        instruction(p, random, op, isa.definition(op));
    }
}

/// Instructions with branches on what registers hold, loops whose length they choose, and calls.
pub fn structured(p: &mut ProgramBuilder, random: &mut SplitMix64, isa: &Isa, depth: i64) {
    for _ in 0..3 {
        straight(p, random, isa, 4);
        let scalars = [below(random, FREE + 1), below(random, FREE + 1)];
        match below(random, if depth == 0 { 1 } else { 4 }) {
            0 => {
                let (other, end) = (p.label(), p.label());
                let rows = [Op::beq, Op::bne, Op::blt, Op::bge, Op::bltu, Op::bgeu];
                match below(random, 2) {
                    0 => p.branch(rows[below(random, 6) as usize], &scalars, other),
                    _ => p.branch([Op::bwltz, Op::bwgez][below(random, 2) as usize], &[below(random, 8)], other),
                };
                straight(p, random, isa, 2);
                p.branch(Op::jump, &[], end);
                p.place(other);
                straight(p, random, isa, 3);
                p.place(end);
            }
            1 => {
                // A loop of one to four rounds.
                let counter = 24 + depth;
                p.emit(Op::andi, &[counter, scalars[0], 3]);
                let again = p.here();
                structured(p, random, isa, depth - 1);
                p.emit(Op::isubi, &[counter, counter, 1]);
                p.branch(Op::bge, &[counter, 0], again);
            }
            2 => {
                // A function, called from two places, by its address the second time.
                let (over, function, link) = (p.label(), p.label(), 28 + depth);
                p.branch(Op::call, &[link], function);
                straight(p, random, isa, 1);
                p.branch(Op::call, &[23], over);
                p.place(function);
                structured(p, random, isa, depth - 1);
                p.emit(Op::ret, &[link]);
                p.place(over);
            }
            _ => {
                let early = p.label();
                p.branch(Op::blt, &scalars, early);
                structured(p, random, isa, depth - 1);
                p.place(early);
            }
        }
    }
}
