//! Every pure row on the arithmetic known at compile time and on the same modes chosen at run time.

use isa::number::{Modes, Nearest32, Vector};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use super::{IntegerRoom, RayRoom, ScalarRoom, VectorRoom, Watching, WideRoom, split_operands};

/// Numbers of every size, the ends of the range among them.
fn scalar() -> impl Strategy<Value = i32> {
    prop_oneof![
        (any::<i32>(), 0u32..32).prop_map(|(number, shift)| number >> shift),
        prop::sample::select(vec![i32::MIN, i32::MIN + 1, -1, 0, 1, i32::MAX]),
    ]
}

fn wide() -> impl Strategy<Value = i64> {
    prop_oneof![
        (any::<i64>(), 0u32..64).prop_map(|(number, shift)| number >> shift),
        prop::sample::select(vec![i64::MIN, i64::MIN + 1, -1, 0, 1, i64::MAX]),
    ]
}

fn vector() -> impl Strategy<Value = Vector> {
    prop::array::uniform3(scalar())
}

macro_rules! any_operand {
    ($runner:ident S) => {
        one($runner, scalar())
    };
    ($runner:ident A) => {
        one($runner, scalar()) as u32
    };
    ($runner:ident V) => {
        one($runner, vector())
    };
    ($runner:ident V2) => {
        one($runner, prop::array::uniform2(vector()))
    };
    ($runner:ident V3) => {
        one($runner, prop::array::uniform3(vector()))
    };
    ($runner:ident W) => {
        one($runner, wide())
    };
    ($runner:ident W3) => {
        one($runner, prop::array::uniform3(wide()))
    };
    ($runner:ident Sh) => {
        one($runner, 0..64)
    };
    ($runner:ident Lane) => {
        one($runner, 0..3)
    };
    ($runner:ident Un) => {
        one($runner, 0..1 << 11)
    };
    ($runner:ident $signed:ident) => {
        one($runner, i32::from(i16::MIN)..=i32::from(i16::MAX))
    };
}

fn one<S: Strategy>(runner: &mut TestRunner, strategy: S) -> S::Value {
    strategy.new_tree(runner).expect("no filter rejects").current()
}

macro_rules! compare {
    ({ $runner:ident $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] $written:tt) => {
        for _ in 0..CASES {
            $(let $letter = any_operand!($runner $kind);)*
            let fast = $trait::$name(&Nearest32, $($letter),*);
            assert_eq!(fast, $trait::$name(&Modes::default(), $($letter),*), "{} {:?}", stringify!($name), ($($letter,)*));
            let watching = Watching::new(Modes::default(), true);
            assert_eq!(fast, $trait::$name(&watching, $($letter),*), "{} {:?}", stringify!($name), ($($letter,)*));
        }
    };
}

macro_rules! compare_row {
    (pure $runner:ident $trait:ident $name:ident $operands:tt) => {
        split_operands! { compare { $runner $trait $name } [] [] $operands }
    };
    ($style:ident $runner:ident $trait:ident $name:ident $operands:tt) => {};
}

/// Operands that each row is tried with.
const CASES: u32 = 400;

#[test]
fn every_pure_row_does_the_same_whether_the_modes_are_known_at_compile_time_or_chosen() {
    let runner = &mut testing::runner(CASES);
    macro_rules! compare_all {
        ($($style:ident $room:ident $trait:ident $room_doc:literal {
            $($(#[doc = $doc:expr])* $name:ident $operands:tt $drawn:literal [$($exits:tt)*];)*
        })*) => {
            $($(compare_row! { $style runner $trait $name $operands })*)*
        };
    }
    isa::instructions!(compare_all);
}
