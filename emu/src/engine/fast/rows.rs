//! A function a row, stamped from the table once a set of host features, from the same meanings as the interpreter's, and the loop that
//! calls one after the other.

use isa::Op;

use super::walk::{Position, Walk};
use crate::code::registers::Registers;
use crate::engine::plan::Step;

/// A row: it does what the step says, goes on with the rows behind it unless it [goes back](goes_back), and yields where that led to.
/// The last number is that of [`Position::sums`].
type RowFunction<L, O> = unsafe fn(&mut Registers, *const Step, &mut Walk<L, O>, u64) -> Position;

/// Rows whose functions keep much on the stack for what they call, so that a call in their last place does not become a jump: they go back to the
/// loop. `is_wide` for a host with vectors, where fewer do. What other rows leave there, as some do with debug assertions, is given back when a
/// sum has come to half of its room.
const fn goes_back(op: Op, is_wide: bool) -> bool {
    let is_kept = !is_wide && matches!(op, Op::rtri | Op::rexit | Op::rstep);
    is_heavy(op) || matches!(op, Op::rbox) || is_kept || cfg!(debug_assertions) && matches!(op, Op::rstep)
}

/// Rows that do so much that the compiler keeps part of it in functions of their own.
const fn is_heavy(op: Op) -> bool {
    matches!(
        op,
        Op::div
            | Op::lshift
            | Op::scale
            | Op::vdiv
            | Op::vcrossn
            | Op::vnorm
            | Op::wmulw
            | Op::wextend
            | Op::wscale
            | Op::wdiv
            | Op::wsqrt
            | Op::wmixed
    )
}

/// On to a step: at once where calls in the last place of a function become jumps, so that each row has a jump of its own, else by the loop.
macro_rules! thread {
    ($place:expr, ($registers:ident $walk:ident $L:ident $O:ident)) => {{
        let place: Position = $place;
        #[cfg(threaded)]
        {
            // SAFETY: the step is one of the plan's, and the host has the features that all rows of this module are compiled for.
            unsafe {
                let row = usize::from((*place.step).row);
                (const { &All::<$L, $O>::FUNCTIONS }[row])($registers, place.step, $walk, place.sums)
            }
        }
        #[cfg(not(threaded))]
        place
    }};
}

/// On to another run.
macro_rules! turn {
    ($way:expr, $sums:ident, ($registers:ident $walk:ident $L:ident $O:ident)) => {{
        let way: Turn = $way;
        let after = $sums.wrapping_add(way.cost);
        if after & LOOK != 0 {
            return $walk.look(way.step, way.cost, $sums);
        }
        thread!(Position { step: way.step, sums: after }, ($registers $walk $L $O))
    }};
}

/// Writes what a meaning handed back, and yields the exit.
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

/// Refuses a row with several outcomes where none is counted.
macro_rules! one_outcome {
    ($name:ident) => {
        const {
            assert!(
                outcome::$name::Outcome::OUTCOMES == 1,
                concat!(
                    "`",
                    stringify!($name),
                    "` has several outcomes: the fast engine counts them for rows of `ray` and `control` alone; let `row!` (emu/src/engine/fast/rows.rs) count it with `walk.pass`"
                )
            );
        }
    };
}

/// The function of a row, and the names of what it has.
macro_rules! function {
    ($features:tt $name:ident
        ($registers:ident $step:ident $walk:ident $sums:ident $now:ident $fields:ident $L:ident $O:ident) $body:block
    ) => {
        # $features
        #[inline(never)]
        #[allow(unused_variables, clippy::extra_unused_type_parameters, reason = "rows differ in what they need")]
        unsafe fn $name<$L: TimedLink, $O: RunObserver>(
            $registers: &mut Registers,
            $step: *const Step,
            $walk: &mut Walk<$L, $O>,
            $sums: u64,
        ) -> Position {
            // SAFETY: it points to a step of the plan, which nobody changes.
            let $now = unsafe { &*$step };
            let $fields = &$now.fields;
            $body
        }
    };
}

/// One row. A straight row goes on with the next word; a control row begins the next run. See [`goes_back`].
macro_rules! row {
    ({ $features:tt $ray:ident pure RayRoom $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {
        function! { $features $name (registers step walk sums now fields L O) {
            let exit: outcome::$name::Outcome = $ray!($name registers fields $written $((read!(registers, fields, $letter $kind)))*);
            let sums = walk.pass::<outcome::$name::Outcome>(now, sums, exit);
            let next = walk.go_on(Position { step, sums });
            if goes_back(Op::$name, IS_WIDE) {
                return next;
            }
            thread!(next, (registers walk L O))
        }}
    };
    ({ $features:tt $ray:ident pure $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {
        function! { $features $name (registers step walk sums now fields L O) {
            one_outcome!($name);
            let result = $trait::$name(&Nearest32 $(, read!(registers, fields, $letter $kind))*);
            let _: outcome::$name::Outcome = finish!(registers fields, result, $written);
            let next = walk.go_on(Position { step, sums });
            if goes_back(Op::$name, IS_WIDE) {
                return next;
            }
            thread!(next, (registers walk L O))
        }}
    };
    ({ $features:tt $ray:ident local $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {
        function! { $features $name (registers step walk sums now fields L O) {
            one_outcome!($name);
            match $trait::$name(&mut *walk.buffer $(, read!(registers, fields, $letter $kind))*) {
                Ok(result) => {
                    let _: outcome::$name::Outcome = finish!(registers fields, result, $written);
                }
                Err(_) => return walk.stop_before(Stopped::Bailout, Position { step, sums }),
            }
            let next = walk.go_on(Position { step, sums });
            thread!(next, (registers walk L O))
        }}
    };
    ({ $features:tt $ray:ident bus $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {
        function! { $features $name (registers step walk sums now fields L O) {
            one_outcome!($name);
            walk.note(Position { step, sums }, now);
            if const { has_results!($written) && (false $(|| is_address!($kind))*) } {
                let port = &mut Port { buffer: &mut *walk.buffer, link: &mut Peek(&mut *walk.link) };
                if let Ok(result) = $trait::$name(port $(, read!(registers, fields, $letter $kind))*) {
                    let _: outcome::$name::Outcome = finish!(registers fields, result, $written);
                    let next = walk.go_on(Position { step, sums });
                    return thread!(next, (registers walk L O));
                }
            }
            function! { $features whole (registers step walk sums now fields L O) {
                let port = &mut Port { buffer: &mut *walk.buffer, link: &mut *walk.link };
                match $trait::$name(port $(, read!(registers, fields, $letter $kind))*) {
                    Ok(result) => {
                        let exit: outcome::$name::Outcome = finish!(registers fields, result, $written);
                        let sums = walk.pass::<outcome::$name::Outcome>(now, sums, exit);
                        walk.go_on(Position { step, sums })
                    }
                    Err(Stop::Wait) => walk.stop_before(Stopped::Wait, Position { step, sums }),
                    Err(Stop::Fault(fault)) => walk.stop_before(Stopped::Fault(fault), Position { step, sums }),
                }
            }}
            // SAFETY: the step and the host are those of this function; the safe twin is `crate::engine::interpreter::run`.
            unsafe { whole::<L, O>(registers, step, walk, sums) }
        }}
    };
    ({ $features:tt $ray:ident control $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {
        function! { $features $name (registers step walk sums now fields L O) {
            const {
                assert!(
                    outcome::$name::Outcome::OUTCOMES <= 2,
                    concat!("`", stringify!($name), "` has more than two outcomes: a control row is taken or falls through (emu/src/engine/fast/rows.rs)")
                );
            }
            let mut flow = Flow::new(now.slot, now.slot + 1, walk.seat.core, walk.seat.cores);
            let result = $trait::$name(&mut flow $(, read!(registers, fields, $letter $kind))*);
            let has_target = const { false $(|| is_relative!($kind))* };
            let goes_on = flow.next == now.slot + 1;
            if matches!(flow.end, Some(End::Trap(_))) || !has_target && !goes_on && flow.next >= walk.plan.words {
                return walk.stop_before(Stopped::Bailout, Position { step, sums });
            }
            let exit: outcome::$name::Outcome = finish!(registers fields, result, $written);
            if let Some(End::Halt) = flow.end {
                return walk.halt(Position { step, sums });
            }
            turn!(walk.turn::<outcome::$name::Outcome>(has_target, now, step, flow, exit), sums, (registers walk L O))
        }}
    };
}

/// True for an operand that is an address. What takes one to the bus and has results is a read, which is mostly in reach at once.
macro_rules! is_address {
    (A) => {
        true
    };
    ($kind:ident) => {
        false
    };
}

/// True for an instruction that writes registers.
macro_rules! has_results {
    ([]) => {
        false
    };
    ($written:tt) => {
        true
    };
}

/// True for an operand that says where a branch leads to.
macro_rules! is_relative {
    (Rel) => {
        true
    };
    ($kind:ident) => {
        false
    };
}

/// The rows of the ray unit by their meanings.
macro_rules! exact_ray {
    ($name:ident $registers:ident $fields:ident $written:tt $(($operand:expr))*) => {{
        let result = RayRoom::$name(&Nearest32 $(, $operand)*);
        finish!($registers $fields, result, $written)
    }};
}

/// Instructions of the ray unit, some of them in a way that suits the host.
#[cfg(target_arch = "x86_64")]
macro_rules! wide_ray {
    (rtri $registers:ident $fields:ident $written:tt $($operand:tt)*) => {
        super::super::super::doubles::rtri($registers, $fields)
    };
    (rstep $registers:ident $fields:ident $written:tt $($operand:tt)*) => {{
        let result = super::super::super::planes::rstep($registers, $fields);
        finish!($registers $fields, result, $written)
    }};
    ($name:ident $registers:ident $fields:ident $written:tt $($operand:tt)*) => {
        exact_ray!($name $registers $fields $written $($operand)*)
    };
}

/// The rows and the loop for one set of host features.
macro_rules! stamp {
    ($features:tt $module:ident $is_wide:literal $ray:ident
        $($style:ident $room:ident $trait:ident $room_doc:literal {
            $($(#[doc = $doc:expr])* $name:ident ($($operands:tt)*) $drawn:literal [$($exits:tt)*];)*
        })*
    ) => {
        pub(super) mod $module {
            use crate::engine::TimedLink;
            use super::super::walk::{Position, Walk};
            use crate::profile::RunObserver;
            use crate::code::registers::Registers;

            #[allow(non_snake_case, reason = "a row's function is spelt as its mnemonic")]
            mod rows {
                use isa::Op;
                use isa::number::Nearest32;
                use isa::table::{AnyOutcome, outcome};

                use super::super::super::fuel::LOOK;
                use super::super::super::operands::put;
                use super::super::super::walk::{Position, Walk, Turn};
                use crate::engine::{Stopped, TimedLink};
                use super::super::{RowFunction, goes_back};
                #[allow(unused_imports, reason = "hosts differ in what they do in doubles")]
                use crate::semantics::RayRoom;
                use crate::semantics::{
                    BusRoom, ControlRoom, End, Flow, Peek, IntegerRoom, LocalRoom, Port, ScalarRoom, VectorRoom, WideRoom,
                    split_operands,
                };
                use crate::engine::plan::{Step, padded};
                use crate::profile::RunObserver;
                use crate::code::registers::{Registers, read};
                use crate::code::trap::Stop;

                const IS_WIDE: bool = $is_wide;

                $($(split_operands! { row { $features $ray $style $trait $name } [] [] ($($operands)*) })*)*

                function! { $features hop (registers step walk sums now fields L O) {
                    turn!(walk.hop(now, step), sums, (registers walk L O))
                }}

                function! { $features unit (registers step walk sums now fields L O) {
                    walk.unit(registers, step, sums, now)
                }}

                function! { $features bailout (registers step walk sums now fields L O) {
                    walk.stop_before(Stopped::Bailout, Position { step, sums })
                }}

                /// The rows by number.
                pub struct All<L, O>(std::marker::PhantomData<(L, O)>);

                impl<L: TimedLink, O: RunObserver> All<L, O> {
                    /// In the order of the numbers of [`Step`].
                    pub const FUNCTIONS: [RowFunction<L, O>; 256] = padded([$($($name::<L, O>,)*)* hop::<L, O>, unit::<L, O>, bailout::<L, O>]);
                }
            }

            /// Walks from a step, of which the run has begun, until it stops.
            # $features
            pub fn run<L: TimedLink, O: RunObserver>(registers: &mut Registers, mut place: Position, walk: &mut Walk<L, O>) {
                while !place.step.is_null() {
                    // SAFETY: rows yield a step of the plan, and the host has the features that this function is compiled for, as the
                    // rows are. `crate::engine::interpreter::run` is the safe twin.
                    place = unsafe {
                        let row = usize::from((*place.step).row);
                        (const { &rows::All::<L, O>::FUNCTIONS }[row])(registers, place.step, walk, place.sums)
                    };
                }
            }
        }
    };
}

macro_rules! stamp_baseline {
    ($($rows:tt)*) => { stamp! { [cfg(all())] baseline false exact_ray $($rows)* } };
}

isa::instructions!(stamp_baseline);

#[cfg(target_arch = "x86_64")]
macro_rules! stamp_avx2 {
    ($($rows:tt)*) => { stamp! { [target_feature(enable = "avx2,bmi1,bmi2,fma,lzcnt,popcnt")] avx2 true wide_ray $($rows)* } };
}

#[cfg(target_arch = "x86_64")]
isa::instructions!(stamp_avx2);
