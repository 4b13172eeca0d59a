//! The rows over all lanes of a group, and the loop that executes block after block: stamped from the table once a set of
//! host features, from the same meanings as the interpreter. Cheap rows compute every lane and keep those of the mask, which
//! the compiler turns into vector instructions; the others go from lane to lane.

use isa::Op;

/// Rows whose meanings do not become vector instructions: they go from lane to lane. A row that is missing here, or here without need, costs
/// time and nothing else, as long as `super::single::rows` has it among those that go back.
pub(super) const fn is_heavy(op: Op) -> bool {
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

/// Rows that read global memory and nothing else of the machine: where lanes ask for the same, it is read once. A row that is missing here
/// costs time and nothing else.
pub(super) const fn is_read(op: Op) -> bool {
    matches!(op, Op::ldw | Op::ldwide | Op::ldv3)
}

/// Lanes from which on the ray unit is faster over all of them than one after the other.
const FEW: u32 = 12;

/// One row.
macro_rules! row {
    // The ray unit has vector instructions of its own; what they do not decide goes from lane to lane.
    ({ $features:tt pure RayRoom $name:ident } [$(($letter:ident $kind:ident))*] [$(($written:ident $written_kind:ident))*]) => {
        # $features
        #[allow(unused_variables, reason = "rows differ in what they read and write")]
        pub fn $name<C: Counting>(plan: &Plan, group: &mut Group, slot: &Slot) {
            let (fields, lanes, mask) = (&slot.fields, &mut group.lanes, group.mask);
            let mut ways = [0; 8];
            let is_worth_it = VECTORS && mask.count_ones() >= FEW;
            let decided = if is_worth_it { ray::$name(fields, lanes, mask, &mut ways) } else { 0 };
            for lane in each(mask & !decided) {
                let result = RayRoom::$name(&Nearest32 $(, get!(lanes, fields, lane, $letter $kind))*);
                let exit = finish!(lanes, fields, lane, result, [$(($written $written_kind))*]);
                ways[exit.index()] |= 1 << lane;
                if C::IS_ON && exit.units() != 0 {
                    group.meter.add_units(plan, group.pc, exit.index(), lane, exit.units());
                }
            }
            $(clear_zero!(lanes, $written $written_kind);)*
            if C::IS_ON && exit::$name::Exit::EXITS > 1 {
                for way in 0..exit::$name::Exit::EXITS {
                    let here = ways[way] & mask;
                    if here != 0 {
                        group.meter.pass(plan, slot.first_exit as usize + way, here);
                    }
                }
            }
        }
    };
    ({ $features:tt pure $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] [$(($written:ident $written_kind:ident))*]) => {
        # $features
        #[allow(unused_variables, reason = "rows differ in what they read and write")]
        pub fn $name(group: &mut Group, slot: &Slot) {
            const { assert!(exit::$name::Exit::EXITS == 1) };
            let (fields, lanes, mask) = (&slot.fields, &mut group.lanes, group.mask);
            if !VECTORS || is_heavy(Op::$name) {
                for lane in each(mask) {
                    let result = $trait::$name(&Nearest32 $(, get!(lanes, fields, lane, $letter $kind))*);
                    finish!(lanes, fields, lane, result, [$(($written $written_kind))*]);
                }
            } else {
                $(let $letter = copy!(lanes, fields, $letter $kind);)*
                for lane in 0..LANES {
                    let is_on = mask & 1 << lane != 0;
                    let ($($written,)* _) = $trait::$name(&Nearest32 $(, pick!(lane, $letter $kind))*);
                    $(blend!(lanes, fields, lane is_on, $written $written_kind);)*
                }
            }
            $(clear_zero!(lanes, $written $written_kind);)*
        }
    };
    ({ $features:tt local $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] [$(($written:ident $written_kind:ident))*]) => {
        # $features
        #[allow(unused_variables, reason = "rows differ in what they read and write")]
        pub fn $name(group: &mut Group, slot: &Slot) -> Result<(), Unusual> {
            const { assert!(exit::$name::Exit::EXITS == 1) };
            let (fields, lanes, buffers) = (&slot.fields, &mut group.lanes, &mut group.buffers);
            for lane in each(group.mask) {
                let result = $trait::$name(&mut buffers[lane] $(, get!(lanes, fields, lane, $letter $kind))*);
                finish!(lanes, fields, lane, result.map_err(|_| Unusual)?, [$(($written $written_kind))*]);
            }
            $(clear_zero!(lanes, $written $written_kind);)*
            Ok(())
        }
    };
    ({ $features:tt bus $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] [$(($written:ident $written_kind:ident))*]) => {
        # $features
        #[allow(unused_variables, reason = "rows differ in what they read and write")]
        pub fn $name<W: Wires, C: Counting>(plan: &Plan, group: &mut Group, slot: &Slot, wires: &mut W) -> Result<(), Unusual> {
            const { assert!(exit::$name::Exit::EXITS == 1) };
            let fields = &slot.fields;
            if is_read(Op::$name) {
                let (mask, lead) = (group.mask, group.mask.trailing_zeros() as usize % LANES);
                let addresses = group.lanes.scalar(fields.a);
                if mask & !where_true(|lane| addresses[lane] == addresses[lead]) == 0 {
                    let (lanes, buffer, moments) = group.parts::<C>(plan, lead);
                    let port = &mut Port { buffer, link: &mut wires.links(mask, moments) };
                    let result = $trait::$name(port $(, get!(lanes, fields, lead, $letter $kind))*);
                    spread!(lanes, fields, mask, result.map_err(|_| Unusual)?, [$(($written $written_kind))*]);
                    $(clear_zero!(lanes, $written $written_kind);)*
                    return Ok(());
                }
            }
            for lane in each(group.mask) {
                let moment = if C::IS_ON { group.moment(plan, lane) } else { Moment { pc: group.pc, clocks: 0 } };
                let (lanes, buffer) = (&mut group.lanes, &mut group.buffers[lane]);
                let port = &mut Port { buffer, link: &mut wires.link(lane, moment) };
                let result = $trait::$name(port $(, get!(lanes, fields, lane, $letter $kind))*);
                let exit = finish!(lanes, fields, lane, result.map_err(|_| Unusual)?, [$(($written $written_kind))*]);
                if C::IS_ON && exit.units() != 0 {
                    group.meter.add_units(plan, group.pc, exit.index(), lane, exit.units());
                }
            }
            $(clear_zero!(group.lanes, $written $written_kind);)*
            Ok(())
        }
    };
    ({ $features:tt control $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] [$(($written:ident $written_kind:ident))*]) => {
        # $features
        #[allow(unused_variables, reason = "rows differ in what they read and write")]
        pub fn $name<C: Counting>(plan: &Plan, group: &mut Group, slot: &Slot) -> Result<(), Unusual> {
            let (fields, lanes, mask) = (&slot.fields, &mut group.lanes, group.mask);
            let here = Flow::new(group.pc, group.pc.wrapping_add(1), group.seat.core, group.seat.cores);
            $(let $letter = copy!(lanes, fields, $letter $kind);)*
            let (mut taken, mut end, mut motion) = (0, None, Motion::Jump);
            for lane in 0..LANES {
                let mut flow = here;
                let result = $trait::$name(&mut flow $(, pick!(lane, $letter $kind))*);
                let is_on = mask & 1 << lane != 0;
                let exit = keep!(lanes, fields, lane is_on, result, [$(($written $written_kind))*]);
                taken |= (exit.index() as Mask) << lane;
                group.next[lane] = flow.next;
                (end, motion) = (flow.end, flow.motion);
            }
            $(clear_zero!(lanes, $written $written_kind);)*
            if exit::$name::Exit::EXITS == 2 {
                let (taken, fallen) = (taken & mask, !taken & mask);
                if C::IS_ON {
                    group.meter.pass(plan, slot.first_exit as usize, fallen);
                    group.meter.pass(plan, slot.first_exit as usize + 1, taken);
                }
                let next = |lanes: Mask| group.next[lanes.trailing_zeros() as usize % LANES];
                let (first, other) = (next(taken), next(fallen));
                group.fork(taken, first, other);
                return Ok(());
            }
            const { assert!(exit::$name::Exit::EXITS <= 2) };
            match end {
                Some(End::Halt) => {
                    group.halt();
                    return Ok(());
                }
                Some(End::Trap(_)) => return Err(Unusual),
                None => {}
            }
            group.depth = match motion {
                Motion::Jump => group.depth,
                Motion::Call => group.depth.wrapping_add(1),
                Motion::Return => group.depth.wrapping_sub(1),
            };
            let next = group.next[mask.trailing_zeros() as usize % LANES];
            let same = where_true(|lane| group.next[lane] == next);
            match mask & !same {
                0 => group.go(next),
                _ => group.scatter(),
            }
            Ok(())
        }
    };
}

/// Calls a row with what its style needs.
macro_rules! call {
    (pure RayRoom $name:ident $plan:ident $group:ident $slot:ident $wires:ident $count:ident) => {{
        rows::$name::<$count>($plan, $group, $slot);
        Ok(false)
    }};
    (pure $trait:ident $name:ident $plan:ident $group:ident $slot:ident $wires:ident $count:ident) => {{
        rows::$name($group, $slot);
        Ok(false)
    }};
    (local $trait:ident $name:ident $plan:ident $group:ident $slot:ident $wires:ident $count:ident) => {
        rows::$name($group, $slot).map(|()| false)
    };
    (bus $trait:ident $name:ident $plan:ident $group:ident $slot:ident $wires:ident $count:ident) => {
        rows::$name::<W, $count>($plan, $group, $slot, $wires).map(|()| false)
    };
    (control $trait:ident $name:ident $plan:ident $group:ident $slot:ident $wires:ident $count:ident) => {
        rows::$name::<$count>($plan, $group, $slot).map(|()| true)
    };
}

/// All rows, and the loop over blocks, for one set of host features.
macro_rules! stamp {
    ($features:tt $module:ident $vectors:literal
        $($style:ident $room:ident $trait:ident $room_doc:literal {
            $($(#[doc = $doc:expr])* $name:ident ($($operands:tt)*) $drawn:literal [$($exits:tt)*];)*
        })*
    ) => {
        pub(super) mod $module {
            use isa::Op;

            use super::super::group::{Counting, Group, Unusual, Wires};
            use super::super::plan::Plan;
            use crate::code::Slot;

            #[allow(non_snake_case, reason = "a row's function is spelt as its mnemonic")]
            mod rows {
                use isa::Op;
                use isa::number::Nearest32;
                use isa::table::{Ending, exit};

                use super::super::{FEW, is_heavy, is_read};
                use super::super::super::group::{Counting, Group, Moment, Unusual, Wires};
                use super::super::super::lanes::{LANES, Mask, each, fill, where_true};
                use super::super::super::operands::{blend, clear_zero, copy, finish, get, keep, pick, set, spread};
                use super::super::super::plan::Plan;
                use super::super::super::ray;
                use crate::code::Slot;
                use crate::exec::{
                    BusRoom, ControlRoom, End, Flow, IntegerRoom, LocalRoom, Motion, Port, RayRoom, ScalarRoom, VectorRoom,
                    WideRoom, split_operands,
                };

                const VECTORS: bool = $vectors;

                $($(split_operands! { row { $features $style $trait $name } [] [] ($($operands)*) })*)*
            }

            /// Executes a word, and yields whether it sent the lanes elsewhere, as control rows do.
            # $features
            #[inline]
            fn execute<W: Wires, C: Counting>(
                plan: &Plan,
                group: &mut Group,
                slot: &Slot,
                wires: &mut W,
            ) -> Result<bool, Unusual> {
                match slot.op {
                    $($(Some(Op::$name) => call!($style $trait $name plan group slot wires C),)*)*
                    Some(Op::Ext(_)) | None => Err(Unusual),
                }
            }

            /// Runs the lanes of a group until all have halted.
            # $features
            pub fn run<W: Wires, C: Counting>(
                plan: &Plan,
                group: &mut Group,
                wires: &mut W,
            ) -> Result<(), Unusual> {
                while group.begin_block::<C>(plan)? {
                    loop {
                        let slot = &plan.slots()[group.pc as usize];
                        if execute::<W, C>(plan, group, slot, wires)? {
                            break;
                        }
                        group.pc += 1;
                        if group.pc == group.end {
                            group.go(group.pc);
                            break;
                        }
                    }
                }
                Ok(())
            }
        }
    };
}

macro_rules! stamp_baseline {
    ($($rows:tt)*) => { stamp! { [cfg(all())] baseline false $($rows)* } };
}

isa::rows!(stamp_baseline);

#[cfg(target_arch = "x86_64")]
macro_rules! stamp_avx2 {
    ($($rows:tt)*) => { stamp! { [target_feature(enable = "avx2,bmi1,bmi2,fma,lzcnt,popcnt")] avx2 true $($rows)* } };
}

#[cfg(target_arch = "x86_64")]
isa::rows!(stamp_avx2);

#[cfg(target_arch = "x86_64")]
macro_rules! stamp_avx512 {
    ($($rows:tt)*) => {
        stamp! {
            [target_feature(enable = "avx2,bmi1,bmi2,fma,lzcnt,popcnt,avx512f,avx512bw,avx512cd,avx512dq,avx512vl")]
            avx512 true $($rows)*
        }
    };
}

#[cfg(target_arch = "x86_64")]
isa::rows!(stamp_avx512);
