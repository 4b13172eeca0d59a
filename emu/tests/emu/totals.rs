//! Generated programs with calls, loops and nested regions: what regions are said to cost adds up, and is what a model says.

use isa::{Class, Op, Program};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::builder::{Label, ProgramBuilder, program};
use super::naive;
use super::profile::run;

/// A piece of a function's body.
#[derive(Clone, Debug)]
enum Piece {
    /// So many additions.
    Adds(u64),
    /// A call of one of the functions behind this one, by its distance; none when there is none.
    Call(usize),
    /// A region of its own.
    Region(Vec<Piece>),
    /// A loop of so many turns.
    Loop(i32, Vec<Piece>),
}

/// End of a function.
#[derive(Clone, Copy, Debug)]
enum Ending {
    Return,
    /// A jump to one of the functions behind this one, by its distance; a return when there is none.
    Jump(usize),
    /// Running on into the next function; a return when there is none.
    RunOn,
}

/// A function's body, and how it ends.
type Function = (Vec<Piece>, Ending);

/// The function into which a function goes on at its end.
fn next(functions: &[Function], function: usize) -> Option<usize> {
    let distance = match functions[function].1 {
        Ending::Return => return None,
        Ending::Jump(distance) => distance,
        Ending::RunOn => 1,
    };
    Some(function + distance).filter(|&next| next < functions.len())
}

fn functions() -> impl Strategy<Value = Vec<Function>> {
    let ending = prop_oneof![Just(Ending::Return), (1usize..3).prop_map(Ending::Jump), Just(Ending::RunOn)];
    prop::collection::vec((pieces(), ending), 1..4)
}

fn pieces() -> impl Strategy<Value = Vec<Piece>> {
    let leaf = prop_oneof![(0u64..5).prop_map(Piece::Adds), (1usize..4).prop_map(Piece::Call)];
    let piece = leaf.prop_recursive(3, 12, 4, |inner| {
        let body = prop::collection::vec(inner, 0..4);
        prop_oneof![
            body.clone().prop_map(Piece::Region),
            (1i32..4, body).prop_map(|(turns, body)| Piece::Loop(turns, body))
        ]
    });
    prop::collection::vec(piece, 0..5)
}

/// Writes pieces; names the regions in the order in which they begin.
fn write(
    builder: &mut ProgramBuilder,
    body: &[Piece],
    function: usize,
    labels: &[Label],
    loops: i64,
    regions: &mut usize,
) {
    for piece in body {
        match piece {
            Piece::Adds(count) => {
                for _ in 0..*count {
                    builder.emit(Op::iadd, &[1, 1, 1]);
                }
            }
            Piece::Call(distance) => {
                if let Some(&label) = labels.get(function + distance) {
                    // A link a function: calls lead to later ones only.
                    builder.branch(Op::call, &[20 + (function + distance) as i64], label);
                }
            }
            Piece::Region(inner) => {
                let name = format!("region {regions}");
                *regions += 1;
                builder.region(&name, |builder| {
                    // Running into a region takes an instruction of it.
                    builder.emit(Op::mov, &[2, 2]);
                    write(builder, inner, function, labels, loops, regions);
                });
            }
            Piece::Loop(turns, inner) => {
                // Each function has counters of its own, one a depth.
                let counter = 3 + 4 * function as i64 + loops;
                builder.repeat(counter, *turns, |builder| write(builder, inner, function, labels, loops + 1, regions));
            }
        }
    }
}

fn written(functions: &[Function]) -> Program {
    program(|builder| {
        let labels: Vec<Label> = functions.iter().map(|_| builder.label()).collect();
        builder.branch(Op::call, &[20], labels[0]).emit(Op::iadd, &[1, 1, 1]).emit(Op::halt, &[]);
        let mut regions = 0;
        for (number, (body, ending)) in functions.iter().enumerate() {
            builder.function(&format!("function {number}"), |builder| {
                builder.place(labels[number]);
                write(builder, body, number, &labels, 0, &mut regions);
                let link = 20 + number as i64;
                match next(functions, number) {
                    None => builder.emit(Op::ret, &[link]),
                    // The next one returns where this one would.
                    Some(next) => {
                        builder.emit(Op::mov, &[20 + next as i64, link]);
                        if let Ending::Jump(_) = ending { builder.branch(Op::jump, &[], labels[next]) } else { builder }
                    }
                };
            });
        }
    })
}

/// Cost that a call of a function adds, by the model: its own pieces and all that they call, and the function into which it goes on.
fn adds(functions: &[Function], function: usize) -> u64 {
    let Some((body, _)) = functions.get(function) else { return 0 };
    let own: u64 = body.iter().map(|piece| adds_of(functions, function, piece)).sum();
    own + next(functions, function).map_or(0, |next| adds(functions, next))
}

fn adds_of(functions: &[Function], function: usize, piece: &Piece) -> u64 {
    let all = |inner: &[Piece]| inner.iter().map(|piece| adds_of(functions, function, piece)).sum::<u64>();
    match piece {
        Piece::Adds(count) => *count,
        Piece::Call(distance) => adds(functions, function + distance),
        Piece::Region(inner) => all(inner),
        Piece::Loop(turns, inner) => *turns as u64 * all(inner),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, rng_seed: RngSeed::Fixed(0x70_7a15), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn totals_are_the_sum_over_regions(functions in functions()) {
        let program = written(&functions);
        let (profile, counts) = run(&program);
        naive::check(&program);
        let sum = profile.regions.iter().fold(profile.outside, |sum, region| sum + region.exclusive);
        prop_assert_eq!(sum, counts);
        prop_assert_eq!(profile.total(), counts);
        prop_assert_eq!(counts[Class::Add], 1 + adds(&functions, 0));
        for (number, _) in functions.iter().enumerate() {
            let name = format!("function {number}");
            let region = profile.regions.iter().find(|region| region.name == name).expect("each function is listed");
            let each = adds(&functions, number);
            prop_assert_eq!(region.inclusive[Class::Add], region.calls * each, "{}", name);
            if region.calls > 0 {
                let extremes = region.extremes.expect("it was called");
                prop_assert_eq!((extremes.least[Class::Add], extremes.most[Class::Add]), (each, each), "{}", name);
            }
        }
    }
}
