//! Costs that functions and regions are said to have.

use emu::engine::Wish;
use emu::machine::Config;
use emu::machine::one_core::{self, OneCore};
use emu::octets::Memory;
use emu::profile::{Profile, ProfileLevel, RegionProfile};
use isa::program::Line;
use isa::{Class, Counts, Isa, Op, Program};

use super::builder::program;

/// Runs a program to its end, and gives what its regions and the whole of it cost.
pub fn run(program: &Program) -> (Profile, Counts) {
    let (isa, config) = (Isa::base(), Config::default());
    let one_core =
        OneCore { step_limit: 10_000_000, profile: ProfileLevel::Extremes, ..OneCore::new(&config, &isa, program) };
    let [native, run] = [Wish::native(), Wish::CHECKED]
        .map(|wish| one_core::run_with(&one_core, Memory::default(), wish).expect("the setup is right"));
    assert_eq!((&native.profile, &native.tally, &native.state), (&run.profile, &run.tally, &run.state));
    // The totals alone are the same without extremes.
    let one_core = OneCore { profile: ProfileLevel::Totals, ..one_core };
    for wish in [Wish::native(), Wish::CHECKED] {
        let plain = one_core::run_with(&one_core, Memory::default(), wish).expect("the setup is right");
        assert_eq!((&plain.tally, &plain.state), (&run.tally, &run.state), "{}", plain.engine.kind.name());
        let without = |profile: &Option<Profile>| {
            let mut profile = profile.clone().expect("a profile was asked for");
            profile.regions.iter_mut().for_each(|region| region.extremes = None);
            profile
        };
        assert_eq!(without(&plain.profile), without(&run.profile), "{}", plain.engine.kind.name());
    }
    assert_eq!(run.trap, None);
    let code = emu::code::Code::new(program, &isa, config.timing());
    let counts = run.tally.counts(&code);
    let lines = run.tally.lines(&code);
    assert_eq!(lines.values().map(|line| line.instructions).sum::<u64>(), run.state.steps);
    assert_eq!(lines.values().fold(Counts::ZERO, |total, line| total + line.counts), counts);
    assert!(lines.contains_key(&Line { source: 0, line: 1 }));
    (run.profile.expect("a profile was asked for"), counts)
}

/// A region of a profile.
pub fn find<'a>(profile: &'a Profile, name: &str) -> &'a RegionProfile {
    profile.regions.iter().find(|region| region.name == name).expect("there is such a region")
}

/// Calls, exclusive adds, inclusive adds, least and most adds a call.
fn adds(profile: &Profile, name: &str) -> [u64; 5] {
    let region = find(profile, name);
    let add = |counts: &Counts| counts[Class::Add];
    let extremes = region.extremes.expect("it was called");
    [region.calls, add(&region.exclusive), add(&region.inclusive), add(&extremes.least), add(&extremes.most)]
}

#[test]
fn loops_up_to_the_step_limit_have_the_same_profile_on_all_engines() {
    let program = program(|p| {
        let leaf = p.label();
        p.function("forever", |p| {
            let top = p.here();
            p.emit(Op::iadd, &[1, 1, 2]).emit(Op::add, &[3, 3, 4]).emit(Op::isubi, &[5, 5, 1]);
            p.branch(Op::bne, &[5, 0], top);
            p.branch(Op::call, &[31], leaf).branch(Op::jump, &[], top);
        });
        p.function("leaf", |p| {
            p.place(leaf).emit(Op::iadd, &[1, 1, 1]).emit(Op::movi, &[5, 100]).emit(Op::ret, &[31]);
        });
    });
    let (isa, config) = (Isa::base(), Config::default());
    for step_limit in [1 << 17, (1 << 18) + 3] {
        let one_core = OneCore { step_limit, profile: ProfileLevel::Extremes, ..OneCore::new(&config, &isa, &program) };
        let run = |wish| one_core::run_with(&one_core, Memory::default(), wish).expect("the setup is right");
        let checked = run(Wish::CHECKED);
        assert_eq!(checked.state.steps, step_limit);
        let native = run(Wish::native());
        assert_eq!((&native.profile, &native.tally), (&checked.profile, &checked.tally));
        assert_eq!((&native.state, &native.trap), (&checked.state, &checked.trap));
    }
}

#[test]
fn calls_count_what_they_call_and_regions_what_is_inside() {
    // The program calls outer and leaf; outer calls leaf twice, within its region part and behind it.
    let (profile, counts) = run(&program(|p| {
        let (outer, leaf) = (p.label(), p.label());
        p.emit(Op::iadd, &[1, 1, 1]);
        p.branch(Op::call, &[31], outer).branch(Op::call, &[31], leaf).emit(Op::halt, &[]);
        p.function("outer", |p| {
            p.place(outer).emit(Op::iadd, &[1, 1, 1]).emit(Op::mov, &[30, 31]);
            p.region("part", |p| {
                p.emit(Op::iadd, &[1, 1, 1]).emit(Op::iadd, &[1, 1, 1]);
                p.branch(Op::call, &[31], leaf);
                p.region("deep", |p| {
                    p.emit(Op::iadd, &[1, 1, 1]);
                });
            });
            p.branch(Op::call, &[31], leaf).emit(Op::ret, &[30]);
        });
        p.function("leaf", |p| {
            p.place(leaf);
            for _ in 0..10 {
                p.emit(Op::iadd, &[1, 1, 1]);
            }
            p.emit(Op::ret, &[31]);
        });
    }));
    // 24 in outer: 1 of its own, 13 in part, 10 in the second leaf; 13 in part: 2 of its own, 10 in leaf, 1 in deep.
    assert_eq!(adds(&profile, "outer"), [1, 1, 24, 24, 24]);
    assert_eq!(adds(&profile, "part"), [1, 2, 13, 13, 13]);
    assert_eq!(adds(&profile, "deep"), [1, 1, 1, 1, 1]);
    assert_eq!(adds(&profile, "leaf"), [3, 30, 30, 10, 10]);
    // Outside stand an addition, two calls and the halt.
    assert_eq!(profile.outside[Class::Add], 1);
    assert_eq!(profile.outside_instructions, 4);
    assert_eq!(profile.total(), counts);
}

#[test]
fn a_region_in_a_loop_is_entered_each_time_and_a_loop_in_a_region_once() {
    let (profile, _) = run(&program(|p| {
        p.repeat(1, 5, |p| {
            p.region("inside", |p| {
                p.emit(Op::iadd, &[2, 2, 1]);
            });
        });
        p.region("around", |p| {
            p.repeat(1, 7, |p| {
                p.emit(Op::iadd, &[2, 2, 1]);
            });
        });
        p.emit(Op::halt, &[]);
    }));
    assert_eq!(adds(&profile, "inside"), [5, 5, 5, 1, 1]);
    assert_eq!(adds(&profile, "around"), [1, 7, 7, 7, 7]);
}

#[test]
fn of_calls_within_calls_of_itself_only_the_outermost_is_inclusive() {
    let (profile, counts) = run(&program(|p| {
        let (sum, done) = (p.label(), p.label());
        p.emit(Op::movi, &[1, 4]).emit(Op::movi, &[29, 0]);
        p.branch(Op::call, &[31], sum).emit(Op::halt, &[]);
        // Adds s1 down to 0 by recursion; the links lie in the buffer.
        p.function("sum", |p| {
            p.place(sum);
            p.branch(Op::beq, &[1, 0], done);
            p.emit(Op::swp, &[31, 29, 4]);
            p.emit(Op::iadd, &[2, 2, 1]).emit(Op::isubi, &[1, 1, 1]);
            p.branch(Op::call, &[31], sum);
            p.emit(Op::isubi, &[29, 29, 4]).emit(Op::lw, &[31, 29, 0]);
            p.place(done).emit(Op::ret, &[31]);
        });
    }));
    assert_eq!(adds(&profile, "sum"), [5, 4, 4, 0, 4]);
    assert_eq!(profile.total(), counts);
}

#[test]
fn leaving_functions_by_a_jump_ends_their_calls() {
    let (profile, counts) = run(&program(|p| {
        let (first, second, after) = (p.label(), p.label(), p.label());
        p.branch(Op::call, &[31], first);
        // A return to nowhere known: a jump through a register.
        p.constant(5, 5).emit(Op::ret, &[5]);
        p.emit(Op::trap, &[1]);
        p.branch(Op::jump, &[], first);
        p.place(after).emit(Op::halt, &[]);
        p.function("first", |p| {
            p.place(first).emit(Op::iadd, &[1, 1, 1]);
            p.branch(Op::jump, &[], second);
        });
        p.function("second", |p| {
            p.place(second).emit(Op::iadd, &[1, 1, 1]).emit(Op::iaddi, &[7, 7, 1]).emit(Op::movi, &[8, 2]);
            p.branch(Op::beq, &[7, 8], after);
            p.emit(Op::ret, &[31]);
        });
    }));
    assert_eq!(adds(&profile, "first"), [2, 2, 6, 3, 3], "a tail call is a call");
    assert_eq!(adds(&profile, "second"), [2, 4, 4, 2, 2]);
    assert_eq!(profile.total(), counts);
}

#[test]
fn endless_nesting_is_cut_off_without_losing_operations() {
    let (profile, counts) = run(&program(|p| {
        let (down, done) = (p.label(), p.label());
        p.constant(1, 200_000);
        p.branch(Op::call, &[31], down);
        p.function("down", |p| {
            p.place(down).emit(Op::isubi, &[1, 1, 1]);
            p.branch(Op::beq, &[1, 0], done);
            p.branch(Op::call, &[31], down);
            p.place(done).emit(Op::halt, &[]);
        });
    }));
    let down = find(&profile, "down");
    assert_eq!(down.inclusive, down.exclusive);
    assert_eq!(down.exclusive[Class::Sub], 200_000);
    assert!(down.calls >= 10_000);
    assert_eq!(profile.total(), counts);
}
