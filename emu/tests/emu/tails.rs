//! Jumps from function to function, and running on from one into the next: they count as calls with a return behind them.

use isa::{Class, Counts, Op, Program};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use random::SplitMix64;

use super::builder::{Label, ProgramBuilder, program};
use super::naive;
use super::profile::{find, run};

/// Ways in which a function goes on into the next one.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    Call,
    Jump,
    RunOn,
}

/// Three functions of one, ten and a hundred additions, each of which goes on into the next; the first is called twice.
fn chain(way: Way) -> Program {
    program(|p| {
        let labels: Vec<Label> = (0..3).map(|_| p.label()).collect();
        p.branch(Op::call, &[20], labels[0]).emit(Op::iadd, &[1, 1, 1]);
        p.branch(Op::call, &[20], labels[0]).emit(Op::halt, &[]);
        for number in 0..3 {
            p.function(&format!("f{number}"), |p| {
                p.place(labels[number]);
                for _ in 0..[1, 10, 100][number] {
                    p.emit(Op::iadd, &[1, 1, 1]);
                }
                match way {
                    _ if number == 2 => p.emit(Op::ret, &[if way == Way::Call { 22 } else { 20 }]),
                    Way::Call => {
                        p.branch(Op::call, &[21 + number as i64], labels[number + 1]);
                        p.emit(Op::ret, &[20 + number as i64])
                    }
                    Way::Jump => p.branch(Op::jump, &[], labels[number + 1]),
                    Way::RunOn => p,
                };
            });
        }
    })
}

#[test]
fn a_jump_or_running_on_into_a_function_counts_as_a_call_with_a_return_behind_it() {
    for way in [Way::Call, Way::Jump, Way::RunOn] {
        let program = chain(way);
        naive::check(&program);
        let (profile, _) = run(&program);
        for (name, own, all) in [("f0", 1, 111), ("f1", 10, 110), ("f2", 100, 100)] {
            let region = find(&profile, name);
            let adds = |counts: &Counts| counts[Class::Add];
            let extremes = region.extremes.expect("it was called");
            assert_eq!(
                (region.calls, adds(&region.exclusive), adds(&region.inclusive)),
                (2, 2 * own, 2 * all),
                "{name}"
            );
            assert_eq!((adds(&extremes.least), adds(&extremes.most)), (all, all), "{name}");
        }
    }
}

#[test]
fn functions_that_jump_to_each_other_forever_are_counted_once() {
    const ROUNDS: i32 = 200_000;
    let (profile, counts) = run(&program(|p| {
        let (even, odd, done) = (p.label(), p.label(), p.label());
        p.constant(1, ROUNDS);
        p.branch(Op::call, &[31], even).emit(Op::iadd, &[2, 2, 2]).emit(Op::halt, &[]);
        p.function("even", |p| {
            p.place(even).emit(Op::isubi, &[1, 1, 1]);
            p.branch(Op::bne, &[1, 0], odd).branch(Op::jump, &[], done);
        });
        p.function("odd", |p| {
            p.place(odd).emit(Op::iadd, &[2, 2, 2]);
            p.branch(Op::jump, &[], even);
            p.place(done).emit(Op::ret, &[31]);
        });
    }));
    let [even, odd] = ["even", "odd"].map(|name| find(&profile, name));
    assert_eq!((even.calls, odd.calls), (ROUNDS as u64, ROUNDS as u64));
    // All but the additions behind the call and the two constants' own.
    assert_eq!((even.inclusive[Class::Sub], even.inclusive[Class::Add]), (ROUNDS as u64, ROUNDS as u64 - 1));
    assert_eq!((odd.inclusive[Class::Sub], odd.inclusive[Class::Add]), (ROUNDS as u64 - 1, ROUNDS as u64 - 1));
    assert_eq!(profile.total(), counts);
}

/// Blocks of a function; those behind the last function belong to none.
const BLOCKS: u64 = 4;

/// A program in which each block goes on anywhere.
struct Jungle {
    random: SplitMix64,
    /// Blocks of what belongs to no function, then those of each function.
    blocks: Vec<Label>,
    /// The end, to which the program goes when its fuel is used up.
    stop: Label,
    calls_anywhere: bool,
}

impl Jungle {
    /// Some additions, then a jump, a branch, a call, a return through any link, or nothing.
    fn block(&mut self, p: &mut ProgramBuilder, number: u64) {
        p.place(self.blocks[number as usize]).emit(Op::isubi, &[1, 1, 1]).branch(Op::beq, &[1, 0], self.stop);
        for _ in 0..self.random.below(4) {
            p.emit(Op::iadd, &[3, 3, 3]);
        }
        p.emit(Op::imul, &[2, 2, 6]).emit(Op::iaddi, &[2, 2, 12_345]).emit(Op::srli, &[4, 2, 16]);
        let to = self.blocks[self.random.below(self.blocks.len() as u64) as usize];
        let [link, other] = [(); 2].map(|()| 20 + self.random.below(4) as i64);
        match self.random.below(8) {
            0 | 1 => p.branch(Op::jump, &[], to),
            2 | 3 => p.emit(Op::andi, &[4, 4, 1]).branch(Op::beq, &[4, 0], to),
            4 | 5 => p.branch(Op::call, &[link], to),
            6 => p.emit(Op::ret, &[link]),
            _ if self.calls_anywhere => p.emit(Op::callr, &[link, other]),
            _ => p,
        };
    }

    /// The blocks of a function, one of them in a region.
    fn blocks(&mut self, p: &mut ProgramBuilder, function: u64) {
        for number in BLOCKS * function..BLOCKS * (function + 1) {
            if number % BLOCKS == 1 && self.random.below(2) == 0 {
                p.region(&format!("region {function}"), |p| self.block(p, number));
            } else {
                self.block(p, number);
            }
        }
    }

    /// A function, in one of four inside of a region or of another function.
    fn function(&mut self, p: &mut ProgramBuilder, function: u64) {
        let name = format!("function {function}");
        if self.random.below(4) != 0 {
            p.function(&name, |p| self.blocks(p, function));
            return;
        }
        let is_function = self.random.below(2) == 0;
        let around = |p: &mut ProgramBuilder| {
            p.emit(Op::iadd, &[3, 3, 3]).function(&name, |p| self.blocks(p, function)).emit(Op::iadd, &[3, 3, 3]);
        };
        match is_function {
            true => p.function(&format!("around {function}"), around),
            false => p.region(&format!("around {function}"), around),
        };
    }
}

/// Functions in which each block goes on anywhere, until the fuel is used up.
fn jungle(seed: u64) -> Program {
    let mut random = SplitMix64::new(seed);
    program(|p| {
        let (start, stop) = (p.label(), p.label());
        let functions = 2 + random.below(4);
        let blocks: Vec<Label> = (0..BLOCKS * (functions + 1)).map(|_| p.label()).collect();
        // The word to which all links lead at first.
        p.branch(Op::jump, &[], start).branch(Op::jump, &[], blocks[0]);
        p.place(start).constant(1, 40 + random.below(200) as i32).constant(2, random.below(1 << 20) as i32);
        p.constant(6, 1_103_515_245);
        for link in 20..24 {
            p.constant(link, 1);
        }
        let calls_anywhere = random.below(3) == 0;
        let mut jungle = Jungle { random, blocks, stop, calls_anywhere };
        jungle.blocks(p, 0);
        (1..=functions).for_each(|function| jungle.function(p, function));
        p.place(stop).emit(Op::halt, &[]);
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, rng_seed: RngSeed::Fixed(0x7a11), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn engines_and_the_model_agree_wherever_functions_jump(seed in any::<u64>()) {
        naive::check(&jungle(seed));
    }
}
