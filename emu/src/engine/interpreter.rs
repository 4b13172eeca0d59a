//! The readable interpreter: one instruction after the other, each checked, counted and timed. It is what other engines
//! are compared with. It knows nothing of other cores: where the machine is not ready it stops and can be resumed.

use isa::Op;
use isa::table::AnyOutcome;

use super::state::{CoreId, Pause, State};
use crate::code::Code;
use crate::code::registers::{read, write};
use crate::code::tally::Tally;
use crate::code::trap::{Fault, Stop};
use crate::profile::{Observer, UnitCount};
use crate::semantics::{
    BusRoom, ControlRoom, End, Flow, IntegerRoom, Link, LocalRoom, Motion, PacketRoom, Port, RayRoom, ScalarRoom,
    VectorRoom, WalkRoom, Watch, WideRoom, split_operands,
};

/// Course of a program after an instruction.
#[derive(Clone, Copy)]
enum After {
    Goes,
    Ends(End),
    /// The instruction leads outside of the program.
    Strays,
}

/// A row that is too large to stand in the loop, once for each kind of run.
#[inline(never)]
fn apart<R>(row: impl FnOnce() -> R) -> R {
    row()
}

/// Runs until the program halts, waits or goes wrong.
///
/// `T` is the machine's arithmetic, `O` who watches each instruction; both are known at compile time, so that a run
/// without a profile pays nothing for it.
pub fn run<T: Watch, O: Observer>(
    code: &Code,
    id: CoreId,
    state: &mut State,
    arithmetic: &T,
    link: &mut dyn Link,
    tally: &mut Tally,
    observer: &mut O,
) -> Pause {
    let (slots, (passes, losses), link) = (code.slots(), tally.parts_mut(), &mut { link });
    let State { registers, buffer, units, .. } = state;
    let numbers = arithmetic.numbers();
    // Sums of the loop stand in variables of their own, so that the host can keep them in registers.
    let mut next = state.pc;
    let mut pc;
    let mut steps = state.steps + state.inner_steps;
    let mut inner_steps = state.inner_steps;
    let mut clocks = state.clocks;
    let mut elementary = state.elementary;

    let pause = loop {
        pc = next;
        let Some(slot) = slots.get(pc as usize) else {
            break Pause::Fault(Fault::OutsideProgram { words: code.words() });
        };
        // Before the instruction, so that a limit of n executes n instructions, and the trap names the next one.
        if steps >= id.step_limit {
            break Pause::Fault(Fault::StepLimit(id.step_limit));
        }
        let fields = &slot.fields;
        next = slot.next;
        let mut motion = Motion::Jump;
        let mut after = After::Goes;
        if O::SEES_VALUES {
            observer.before(pc, slot, registers, buffer);
        }

        /// Writes what a meaning handed back and yields how it ended.
        macro_rules! finish {
            ($result:expr, []) => {{
                let exit = $result;
                (exit.index(), exit.units())
            }};
            ($result:expr, [$(($letter:ident $kind:ident))+]) => {{
                let ($($letter,)+ exit) = $result;
                $(write!(registers, fields, $letter $kind);)+
                (exit.index(), exit.units())
            }};
        }
        /// Takes note of what arithmetic that watches has seen.
        macro_rules! watch {
            () => {
                if T::IS_WATCHING {
                    if arithmetic.take_division_by_zero() {
                        break Pause::Fault(Fault::DivisionByZero);
                    }
                    if let Some(losses) = losses.get_mut(pc as usize) {
                        losses.add(arithmetic.take_losses());
                    }
                }
            };
        }
        /// Executes one row: its operands are read, its meaning is asked, its results are written.
        macro_rules! execute {
            ({ pure $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {{
                let result = $trait::$name(arithmetic $(, read!(registers, fields, $letter $kind))*);
                watch!();
                finish!(result, $written)
            }};
            ({ local $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {
                match $trait::$name(buffer $(, read!(registers, fields, $letter $kind))*) {
                    Ok(result) => finish!(result, $written),
                    Err(fault) => break Pause::Fault(fault),
                }
            };
            ({ buffered $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {
                match apart(|| $trait::$name(arithmetic, buffer $(, read!(registers, fields, $letter $kind))*)) {
                    Ok(result) => {
                        watch!();
                        finish!(result, $written)
                    }
                    Err(fault) => break Pause::Fault(fault),
                }
            };
            ({ bus $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {
                match $trait::$name(&mut Port { buffer, link } $(, read!(registers, fields, $letter $kind))*) {
                    Ok(result) => finish!(result, $written),
                    Err(Stop::Wait) => break Pause::Wait,
                    Err(Stop::Fault(fault)) => break Pause::Fault(fault),
                }
            };
            ({ control $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {{
                let mut flow = Flow::new(pc, next, id.core, id.cores);
                let exit = finish!($trait::$name(&mut flow $(, read!(registers, fields, $letter $kind))*), $written);
                (next, motion) = (flow.next, flow.motion);
                if let Some(end) = flow.end {
                    after = After::Ends(end);
                // The first comparison is enough for programs without bodies, and nearly always decides.
                } else if next >= code.words() && code.is_outside(pc, next) {
                    after = After::Strays;
                }
                exit
            }};
        }
        macro_rules! dispatch {
            ($($style:ident $room:ident $trait:ident $room_doc:literal {
                $($(#[doc = $doc:expr])* $name:ident ($($operands:tt)*) $drawn:literal [$($exits:tt)*];)*
            })*) => {
                match slot.op {
                    $($(Some(Op::$name) => {
                        split_operands! { execute { $style $trait $name } [] [] ($($operands)*) }
                    })*)*
                    // What has a body stands here as the steps of that.
                    Some(Op::Ext(number)) => {
                        let Some(unit) = units.get_mut(number) else {
                            break Pause::Fault(Fault::NoMeaning(code.program.words[pc as usize]));
                        };
                        // A division by zero is known only when the registers are written.
                        let before = T::IS_WATCHING.then(|| registers.clone());
                        let mut read = |address, words: &mut [i32]| link.read(address, words);
                        match unit.execute(fields, registers, buffer, &mut read, &numbers) {
                            Ok(ending) => {
                                if let Some(before) = before
                                    && arithmetic.take_division_by_zero()
                                {
                                    *registers = before;
                                    break Pause::Fault(Fault::DivisionByZero);
                                }
                                watch!();
                                if ending.is_taken {
                                    next = code.distant(pc);
                                    after = if next >= code.words() { After::Strays } else { After::Goes };
                                }
                                (ending.exit.into(), ending.units)
                            }
                            Err(Stop::Wait) => break Pause::Wait,
                            Err(Stop::Fault(fault)) => break Pause::Fault(fault),
                        }
                    }
                    None => break Pause::Fault(match code.program.words.get(pc as usize) {
                        Some(&word) => Fault::IllegalWord(word),
                        None => Fault::OutsideProgram { words: code.words() },
                    }),
                }
            };
        }

        let (exit, units): (usize, u32) = isa::instructions!(dispatch);

        let number = slot.first_outcome as usize + exit;
        // Account for the outcome; what units add is seldom and takes a way of its own
        let pass = &mut passes[number];
        pass.count += 1;
        steps += 1;
        inner_steps += u64::from(pass.cost.is_inner);
        clocks += u64::from(pass.cost.clocks);
        elementary += u64::from(pass.cost.elementary);
        pass.units += u64::from(units);
        let mut unit_clocks = 0;
        if units != 0 && pass.cost.has_busy_units {
            let (more_clocks, more_elementary) = code.unit_cost(number, units);
            unit_clocks = more_clocks.0;
            pass.unit_clocks += unit_clocks;
            clocks += unit_clocks;
            elementary += more_elementary;
        }
        if O::SEES_VALUES {
            observer.after(pc, code, registers);
        }
        if O::IS_ACTIVE {
            // What ends here goes nowhere: the word after a `halt` may belong to another function.
            let next = if matches!(after, After::Ends(_)) { pc } else { next };
            observer.step(pc, number, UnitCount { units, clocks: unit_clocks }, next, motion);
        }
        match after {
            After::Goes => {}
            After::Ends(End::Halt) => break Pause::Halt,
            After::Ends(End::Trap(number)) => break Pause::Fault(Fault::User(number)),
            After::Strays => {
                pc = next;
                break Pause::Fault(Fault::OutsideProgram { words: code.words() });
            }
        }
    };
    state.pc = pc;
    state.steps = steps - inner_steps;
    state.inner_steps = inner_steps;
    state.clocks = clocks;
    state.elementary = elementary;
    pause
}
