//! Functions that generated code calls: a row each, stamped from the same meanings as the interpreter's.

use std::panic::{AssertUnwindSafe, catch_unwind};

use isa::Op;
use isa::number::Nearest32;
use isa::table::{AnyOutcome, outcome};

use super::context::Context;
use super::operands::put;
use super::run::NativeHost;
use super::{Recipe, Status};
use crate::code::registers::{Registers, read};
use crate::engine::HostSimd;
use crate::engine::plan::Step;
use crate::semantics::{
    BusRoom, IntegerRoom, Motion, PacketRoom, Port, RayRoom, ScalarRoom, VectorRoom, WalkRoom, Watch, Watching,
    WideRoom, split_operands,
};

/// A row: what it returns is said by [`pure`], [`bus`] and [`unit`].
pub(super) type RowCall = unsafe extern "C" fn(*mut Context, *mut Registers, *const Step) -> u64;

/// Takes note of the units with which a row ended, as [`pure`] returned them.
pub(super) type UnitsCall = unsafe extern "C" fn(*mut Context, *const Step, u64) -> u64;

/// Tells who measures each call that control goes from the slot in the low half to that in the high one, by the [`Motion`] of that number.
pub(super) type Went = unsafe extern "C" fn(*mut Context, u64, u64) -> u64;

/// As [`Went`], for the calling context, which may be another one afterwards.
pub(super) type Follow = unsafe extern "C" fn(*mut Context, u64, u64) -> u64;

/// Yields the calling context of what a slot calls, 0 where that is for the interpreter; the nodes may lie elsewhere afterwards.
pub(super) type Callee = unsafe extern "C" fn(*mut Context, u64, u64) -> u64;

/// Result of a row of values that has divided by zero where that traps. It has written nothing then.
pub(super) const STOPPED: u64 = u64::MAX;

/// The bit that [`unit`] sets where control goes on as the row's distance says.
pub(super) const TAKEN: u32 = 1 << 8;

/// Writes what a meaning handed back, and yields how it ended.
macro_rules! finish {
    ($registers:ident $fields:ident, $result:expr, []) => {
        $result
    };
    ($registers:ident $fields:ident, $result:expr, [$(($letter:ident $kind:ident))+]) => {{
        let ($($letter,)+ exit) = $result;
        $(put!($registers, $fields, $letter $kind);)+
        exit
    }};
}

/// The function of a row.
macro_rules! row_function {
    ({ pure $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {
        /// Yields the number of the exit, and in the high half its units.
        ///
        /// # Safety
        /// Context and registers are those of a run, whose arithmetic is a `T`, and the step lives.
        pub unsafe extern "C" fn $name<T: Watch>(
            context: *mut Context,
            registers: *mut Registers,
            step: *const Step,
        ) -> u64 {
            // SAFETY: as the function asks for; nobody else looks at any of them meanwhile. `crate::engine::interpreter::run` is the safe twin.
            let arithmetic = unsafe { &*(*context).arithmetic.cast::<T>() };
            // SAFETY: as above.
            let (registers, fields, slot) = unsafe { (&mut *registers, &(*step).fields, (*step).slot) };
            let result = $trait::$name(arithmetic $(, read!(registers, fields, $letter $kind))*);
            if T::IS_WATCHING {
                if arithmetic.take_division_by_zero() {
                    return STOPPED;
                }
                // SAFETY: the context is that of a run.
                unsafe { NativeHost::of(&mut *context) }.note_losses(slot);
            }
            let _ = (&*registers, fields, slot);
            let exit: outcome::$name::Outcome = finish!(registers fields, result, $written);
            exit.index() as u64 | u64::from(exit.units()) << 32
        }
    };
    ({ buffered $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {
        /// Yields the number of the exit, and in the high half its units; [`STOPPED`] for an access beyond the buffer, with nothing written.
        ///
        /// # Safety
        /// Context and registers are those of a run, whose arithmetic is a `T`, and the step lives.
        // For `wide`: a function of its own is compiled without the host's vectors.
        #[inline(always)]
        pub unsafe extern "C" fn $name<T: Watch>(
            context: *mut Context,
            registers: *mut Registers,
            step: *const Step,
        ) -> u64 {
            // SAFETY: as the function asks for; nobody else looks at any of them meanwhile. `crate::engine::interpreter::run` is the safe twin.
            let (context, registers, step) = unsafe { (&mut *context, &mut *registers, &*step) };
            let fields = &step.fields;
            // SAFETY: as above.
            let arithmetic = unsafe { &*context.arithmetic.cast::<T>() };
            // SAFETY: the context is that of a run, and the buffer is the core's, which nobody else has.
            let buffer = unsafe { &mut *NativeHost::of(context).buffer };
            match $trait::$name(arithmetic, buffer $(, read!(registers, fields, $letter $kind))*) {
                Ok(result) => {
                    if T::IS_WATCHING {
                        // SAFETY: the context is that of a run.
                        unsafe { NativeHost::of(context) }.note_losses(step.slot);
                    }
                    let exit: outcome::$name::Outcome = finish!(registers fields, result, $written);
                    exit.index() as u64 | u64::from(exit.units()) << 32
                }
                Err(_) => STOPPED,
            }
        }
    };
    ({ bus $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {
        /// Yields 0, or the [`Status`] with which to leave.
        ///
        /// # Safety
        /// Context and registers are those of a run, and the step lives.
        pub unsafe extern "C" fn $name(context: *mut Context, registers: *mut Registers, step: *const Step) -> u64 {
            // SAFETY: as the function asks for; nobody else looks at any of them meanwhile. `crate::engine::interpreter::run` is the safe twin.
            let (context, registers, step) = unsafe { (&mut *context, &mut *registers, &*step) };
            // SAFETY: the context is that of a run.
            let host = unsafe { NativeHost::of(context) };
            let fields = &step.fields;
            let address = registers.scalar(fields.a).wrapping_add(fields.i) as u32;
            host.ask(context, step);
            // SAFETY: the buffer is the core's, which nobody else has.
            let buffer = unsafe { &mut *host.buffer };
            let port = &mut Port { buffer, link: &mut host.link };
            match $trait::$name(port $(, read!(registers, fields, $letter $kind))*) {
                Ok(result) => {
                    let exit: outcome::$name::Outcome = finish!(registers fields, result, $written);
                    if exit.units() != 0 {
                        host.add_units(context, step.exit as usize, exit.units());
                    }
                    host.answered(context, step, address);
                    0
                }
                Err(stop) => host.stop(stop),
            }
        }
    };
    ({ $style:ident $trait:ident $name:ident } $read:tt $written:tt) => {};
}

/// Refuses a row with several outcomes where none is counted.
macro_rules! check_outcomes {
    (pure $name:ident) => {};
    (buffered $name:ident) => {};
    (control $name:ident) => {};
    ($style:ident $name:ident) => {
        const _: () = assert!(
            <outcome::$name::Outcome as AnyOutcome>::OUTCOMES == 1,
            concat!(
                "`",
                stringify!($name),
                "` has several outcomes, but native code counts one for rows of the bus and the buffer"
            )
        );
    };
}

macro_rules! row_functions {
    ($($style:ident $room:ident $trait:ident $room_doc:literal {
        $($(#[doc = $doc:expr])* $name:ident ($($operands:tt)*) $drawn:literal [$($exits:tt)*];)*
    })*) => {
        #[allow(non_snake_case, reason = "a row's function is spelt as its mnemonic")]
        mod rows {
            use super::*;

            $($(split_operands! { row_function { $style $trait $name } [] [] ($($operands)*) })*)*
        }

        $($(check_outcomes! { $style $name })*)*

        /// The function of a row that needs only values: see [`rows`].
        fn of_values<T: Watch>(op: Op) -> Option<RowCall> {
            match op {
                $($(Op::$name => of_values!($style $name),)*)*
                Op::Ext(_) => None,
            }
        }

        /// The function of a row that asks the machine.
        fn of_machine(op: Op) -> Option<RowCall> {
            match op {
                $($(Op::$name => of_machine!($style $name),)*)*
                Op::Ext(_) => None,
            }
        }
    };
}

macro_rules! of_values {
    (pure $name:ident) => {
        Some(rows::$name::<T>)
    };
    (buffered $name:ident) => {
        Some(rows::$name::<T>)
    };
    ($style:ident $name:ident) => {
        None
    };
}

macro_rules! of_machine {
    (bus $name:ident) => {
        Some(rows::$name)
    };
    ($style:ident $name:ident) => {
        None
    };
}

isa::instructions!(row_functions);

/// The function of a row that needs only values, and perhaps the buffer: it yields the number of the exit, and in the high half its units;
/// [`STOPPED`] where it has divided by zero and that traps, or has left the buffer.
pub(super) fn pure(op: Op, recipe: &Recipe) -> RowCall {
    const OF_VALUES: &str = "the row needs only values and the buffer";
    #[cfg(target_arch = "x86_64")]
    if recipe.simd.min(HostSimd::best()) >= HostSimd::Avx2 {
        match (op, recipe.is_watching) {
            (Op::rtri, false) => return rtri,
            (Op::rnear, false) => return wide::rnear::<Nearest32>,
            (Op::rany, false) => return wide::rany::<Nearest32>,
            (Op::rnear, true) => return wide::rnear::<Watching>,
            (Op::rany, true) => return wide::rany::<Watching>,
            _ => {}
        }
    }
    if recipe.is_watching {
        return of_values::<Watching>(op).expect(OF_VALUES);
    }
    of_values::<Nearest32>(op).expect(OF_VALUES)
}

/// Rows that do the same for many values, compiled for hosts with vectors of four doubles.
#[cfg(target_arch = "x86_64")]
mod wide {
    use super::{Context, Registers, Step, Watch, rows};

    macro_rules! wide {
        ($($name:ident)*) => {
            $(
                /// See the row.
                ///
                /// # Safety
                /// As that of the same name in [`rows`], on a host with these features.
                #[target_feature(enable = "avx2,bmi1,bmi2,fma,lzcnt,popcnt")]
                pub unsafe extern "C" fn $name<T: Watch>(
                    context: *mut Context,
                    registers: *mut Registers,
                    step: *const Step,
                ) -> u64 {
                    // SAFETY: as the function asks for. The row compiled for all hosts is the twin.
                    unsafe { rows::$name::<T>(context, registers, step) }
                }
            )*
        };
    }

    wide!(rnear rany);
}

/// A ray against a triangle, in doubles where they are sure.
///
/// # Safety
/// As [`rows`], on a host with these features.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,fma,lzcnt,popcnt")]
unsafe extern "C" fn rtri(_: *mut Context, registers: *mut Registers, step: *const Step) -> u64 {
    // SAFETY: as the function asks for. `rows::rtri` is the safe twin's.
    let exit = unsafe { super::doubles::rtri(&mut *registers, &(*step).fields) };
    exit.index() as u64 | u64::from(exit.units()) << 32
}

/// The function of a row that asks the machine: it yields 0, or the [`Status`] with which to leave.
pub(super) fn bus(op: Op) -> RowCall {
    of_machine(op).expect("the row asks the machine")
}

/// Takes note of units beside the sums.
///
/// # Safety
/// The context is that of a run, and the step lives.
pub(super) unsafe extern "C" fn add_units(context: *mut Context, step: *const Step, ended: u64) -> u64 {
    // SAFETY: as the function asks for.
    let (context, step) = unsafe { (&mut *context, &*step) };
    // SAFETY: the context is that of a run.
    let host = unsafe { NativeHost::of(context) };
    host.add_units(context, step.exit as usize + ended as u32 as usize, (ended >> 32) as u32);
    0
}

/// The motion of a number.
fn motion(number: u64) -> Motion {
    [Motion::Jump, Motion::Call, Motion::Return][number as usize % 3]
}

/// Tells who measures each call where control goes: see [`Went`].
///
/// # Safety
/// The context is that of a run.
pub(super) unsafe extern "C" fn went(context: *mut Context, ways: u64, number: u64) -> u64 {
    // SAFETY: as the function asks for.
    let context = unsafe { &mut *context };
    // SAFETY: the context is that of a run.
    let host = unsafe { NativeHost::of(context) };
    host.went(context, ways as u32, (ways >> 32) as u32, motion(number));
    0
}

/// Follows a motion to another calling context: see [`Follow`].
///
/// # Safety
/// The context is that of a run.
pub(super) unsafe extern "C" fn follow(context: *mut Context, ways: u64, number: u64) -> u64 {
    // SAFETY: as the function asks for.
    let context = unsafe { &mut *context };
    // SAFETY: the context is that of a run.
    let host = unsafe { NativeHost::of(context) };
    host.follow(context, ways as u32, (ways >> 32) as u32, motion(number));
    0
}

/// Finds the calling context of what a slot calls: see [`Callee`]. `caller` is the place for it in the node.
///
/// # Safety
/// The context is that of a run.
pub(super) unsafe extern "C" fn callee(context: *mut Context, slot: u64, caller: u64) -> u64 {
    // SAFETY: as the function asks for.
    let context = unsafe { &mut *context };
    // SAFETY: the context is that of a run.
    let host = unsafe { NativeHost::of(context) };
    host.callee(context, slot as u32, caller as usize).into()
}

/// Executes an instruction with a meaning in Rust: yields the exit and [`TAKEN`], or in the high half the [`Status`] with which to leave.
///
/// # Safety
/// Context and registers are those of a run, and the step lives.
pub(super) unsafe extern "C" fn unit(context: *mut Context, registers: *mut Registers, step: *const Step) -> u64 {
    // SAFETY: as the function asks for; nobody else looks at any of them meanwhile. `crate::engine::interpreter::run` is the safe twin.
    let (context, registers, step) = unsafe { (&mut *context, &mut *registers, &*step) };
    // SAFETY: the context is that of a run.
    let host = unsafe { NativeHost::of(context) };
    // SAFETY: buffer and units are the core's, which nobody else has.
    let (buffer, units) = unsafe { (&mut *host.buffer, &mut *host.units) };
    let Some(unit) = units.get_mut(step.unit) else { return (Status::Bailout as u64) << 32 };
    host.ask(context, step);
    let (link, numbers) = (&mut host.link, &host.numbers);
    let mut read = |address, words: &mut [i32]| link.read(address, words);
    let execute = || unit.execute(&step.fields, registers, buffer, &mut read, numbers);
    // Nothing can unwind through generated code. What the instruction has touched is not looked at again: the panic goes on from `run_code`.
    let ended = catch_unwind(AssertUnwindSafe(execute));
    match ended {
        Ok(Ok(ending)) => {
            host.note_losses(step.slot);
            if ending.units != 0 {
                host.add_units(context, step.exit as usize + usize::from(ending.exit), ending.units);
            }
            host.answered(context, step, 0);
            u64::from(ending.exit) | if ending.is_taken { u64::from(TAKEN) } else { 0 }
        }
        Ok(Err(stop)) => host.stop(stop) << 32,
        Err(panic) => host.panicked(panic) << 32,
    }
}
