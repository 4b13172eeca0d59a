//! Puts the body of an extension instruction into decoded code: ordinary slots on outer and hidden registers, so that engines execute
//! them as any others.
//!
//! Sources are read where the program has them. A destination is written in place where no later step can still read a source there,
//! else in a hidden register that the last slots copy. The slot before an exit carries the exit's pass, so that most bodies execute
//! exactly their own instructions.

use isa::definition::{InstructionDef, Kind, Operand};
use isa::extension::{Body, BodyAct, Immediate, registers};
use isa::{Fields, Isa, Op};

/// Target of a slot of a splice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SpliceTarget {
    /// To another slot of the splice.
    Inside(usize),
    /// Behind the extension instruction.
    Behind,
    /// To the word at this distance from the extension instruction.
    Away(i32),
}

/// Count of a pass through a slot of a splice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Passing {
    /// A step of the body: what its row costs, where the exits of the instruction cost what the body does.
    Step,
    /// Nothing: it only moves what the body has computed.
    Move,
    /// The end of the instruction by that exit.
    Exit(u8),
    /// A step of the body that is the end too.
    StepAndExit(u8),
}

/// A slot of a splice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpliceSlot {
    pub op: Op,
    pub fields: Fields,
    pub way: SpliceTarget,
    /// Branch target: the operand's letter and the slot of the splice.
    pub branch: Option<(u8, usize)>,
    pub passing: Passing,
    /// The row whose cost a step has.
    pub counted: Op,
    /// The step that it executes or ends with.
    pub step: u32,
}

/// The registers of one operand of an instance.
struct InstanceOperand {
    operand: Operand,
    file: char,
    /// First register in the program.
    outer: u8,
    /// First register while the body runs.
    inner: u8,
}

impl InstanceOperand {
    fn outer_bits(&self) -> u64 {
        ((1 << self.operand.kind.registers()) - 1) << self.outer
    }

    fn body_bits(&self) -> u128 {
        ((1 << self.operand.kind.registers()) - 1) << registers::operand(self.operand.letter, 0)
    }

    fn is_zero(&self) -> bool {
        self.file == 's' && self.outer == 0
    }
}

/// The slots of a body for an instruction with these fields.
///
/// `turn s1, s2` with the body `neg d, a` becomes one slot, `neg s1, s2`, which carries the outcome too. With the body `neg d, a`, `iadd d, d, a` a
/// write to `s1` in `turn s1, s1` would change what the second step reads, so `d` is hidden in `s63` and copied at the end:
///
/// | slot | instruction | counts |
/// | --- | --- | --- |
/// | 0 | `neg s63, s1` | a step |
/// | 1 | `iadd s63, s63, s1` | a step |
/// | 2 | `mov s1, s63` | the outcome |
pub(crate) fn splice(body: &Body, row: &InstructionDef, isa: &Isa, fields: &Fields) -> Vec<SpliceSlot> {
    // Choose registers, and find out where the slots of each step begin
    let places = places(body, row, isa, fields);
    let (before, after) = (moves(&places, true), moves(&places, false));
    // An end takes as many slots as there are copies out, or one that only carries the outcome.
    let length = |act: &BodyAct| if matches!(act, BodyAct::End { .. }) { after.len().max(1) } else { 1 };
    let mut starts = Vec::with_capacity(body.steps.len() + 1);
    starts.push(before.len());
    starts.extend(body.steps.iter().scan(before.len(), |at, step| {
        *at += length(&step.act);
        Some(*at)
    }));
    let leave = |jumps: bool| match row.operands.iter().find(|operand| jumps && operand.kind == Kind::Rel) {
        Some(operand) => SpliceTarget::Away(fields.get(operand.letter) as i32),
        None => SpliceTarget::Behind,
    };
    let mut pieces: Vec<SpliceSlot> = Vec::with_capacity(starts[body.steps.len()]);
    let plain = |(op, fields): (Op, Fields), way, passing, step| SpliceSlot {
        op,
        fields,
        way,
        branch: None,
        passing,
        counted: op,
        step,
    };
    // Copy in what hidden registers have to hold
    for made in before {
        pieces.push(plain(made, SpliceTarget::Inside(pieces.len() + 1), Passing::Move, 0));
    }
    // Write the steps; an end becomes the copies out, of which the last one leaves
    for (number, step) in body.steps.iter().enumerate() {
        let (instruction, immediates) = match step.act {
            BodyAct::Execute { instruction, immediates } => (instruction, immediates),
            BodyAct::End { outcome: exit, jumps } => {
                // A copy of s0 into itself does nothing and takes no time, but can have an outcome.
                let nothing = [copy('s', 0, 0)];
                let made = if after.is_empty() { &nothing[..] } else { &after[..] };
                for (at, &moved) in made.iter().enumerate() {
                    let (way, passing) = match at + 1 == made.len() {
                        true => (leave(jumps), Passing::Exit(exit)),
                        false => (SpliceTarget::Inside(pieces.len() + 1), Passing::Move),
                    };
                    pieces.push(plain(moved, way, passing, number as u32));
                }
                continue;
            }
        };
        // Put the instance's registers and immediates in, and turn distances in steps into slots
        let inner = isa.definition(instruction.op);
        let filled = filled(inner, &instruction.fields, immediates, fields, &places);
        let target =
            inner.operands.iter().find(|operand| operand.kind == Kind::Rel).map(|operand| {
                (operand.letter, starts[(number as i64 + instruction.fields.get(operand.letter)) as usize])
            });
        let mut piece =
            plain((instruction.op, filled), SpliceTarget::Inside(starts[number + 1]), Passing::Step, number as u32);
        // Let the step leave by itself where an end without copies follows
        match (target, body.steps.get(number + 1).map(|next| next.act)) {
            // A jump inside is where its slot leads to.
            (Some((_, target)), _) if instruction.op == Op::jump => {
                (piece.op, piece.fields) = copy('s', 0, 0);
                piece.way = SpliceTarget::Inside(target);
            }
            (None, Some(BodyAct::End { outcome: exit, jumps }))
                if after.is_empty() && inner.outcomes.len() == 1 && instruction.op != Op::trap =>
            {
                piece.way = leave(jumps);
                piece.passing = Passing::StepAndExit(exit);
            }
            _ => piece.branch = target,
        }
        pieces.push(piece);
    }
    pieces
}

/// Registers of each operand while the body runs.
fn places(body: &Body, row: &InstructionDef, isa: &Isa, fields: &Fields) -> Vec<InstanceOperand> {
    let mut places: Vec<InstanceOperand> = (row.operands.iter())
        .filter_map(|&operand| {
            let outer = fields.get(operand.letter) as u8;
            operand.kind.register_file().map(|file| InstanceOperand { operand, file, outer, inner: outer })
        })
        .collect();
    // Hidden registers are given out from above, of each file by itself; a program cannot name them.
    let mut ends = [64u8, 64, 16];
    for at in 0..places.len() {
        let place = &places[at];
        // What is only read stays where it is. A destination s0 is hidden always, since the body may read what it wrote there.
        if !place.operand.is_written() || (!place.is_zero() && is_safe(place, &places, body, isa)) {
            continue;
        }
        let end = &mut ends[match place.file {
            's' => 0,
            'v' => 1,
            _ => 2,
        }];
        *end -= place.operand.kind.registers();
        places[at].inner = *end;
    }
    places
}

/// True where a destination may be written before the body has ended.
fn is_safe(place: &InstanceOperand, places: &[InstanceOperand], body: &Body, isa: &Isa) -> bool {
    let others = places.iter().filter(|other| {
        other.operand.letter != place.operand.letter
            && other.file == place.file
            && other.outer_bits() & place.outer_bits() != 0
    });
    others.into_iter().all(|other| {
        !other.operand.is_written() && !body.reads_after_writing(isa, place.file, place.body_bits(), other.body_bits())
    })
}

/// Copies of hidden operands: into their registers before the body, out of them behind it, in the order of the row.
fn moves(places: &[InstanceOperand], is_entry: bool) -> Vec<(Op, Fields)> {
    let mut moves = Vec::new();
    for place in places.iter().filter(|place| place.inner != place.outer) {
        let (from, to, is_moved) = match is_entry {
            true => (place.outer, place.inner, place.operand.is_read()),
            false => (place.inner, place.outer, place.operand.is_written() && !place.is_zero()),
        };
        if is_moved {
            moves.extend((0..place.operand.kind.registers()).map(|at| copy(place.file, from + at, to + at)));
        }
    }
    moves
}

fn copy(file: char, from: u8, to: u8) -> (Op, Fields) {
    let op = match file {
        's' => Op::mov,
        'v' => Op::vmov,
        _ => Op::wmov,
    };
    (op, Fields { d: to, a: from, ..Fields::default() })
}

/// The fields of a step with the instance's registers and immediates.
fn filled(
    inner: &InstructionDef,
    step: &Fields,
    immediates: [Immediate; 2],
    outer: &Fields,
    places: &[InstanceOperand],
) -> Fields {
    let mut filled = *step;
    for operand in inner.operands.iter() {
        if operand.kind.register_file().is_some() {
            if let Some((letter, offset)) = registers::letter(step.get(operand.letter) as u8)
                && let Some(place) = places.iter().find(|place| place.operand.letter == letter)
            {
                filled.set(operand.letter, (place.inner + offset).into());
            }
        } else if let Immediate::Letter { letter, factor, offset } = immediates[usize::from(operand.letter == b'j')] {
            filled.set(operand.letter, factor * outer.get(letter) as i32 + offset);
        }
    }
    filled
}
