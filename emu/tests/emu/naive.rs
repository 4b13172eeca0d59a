//! Profiles against a model that adds each instruction at once to all that is open.

use emu::code::Code;
use emu::engine::{CoreId, State, interpreter};
use emu::octets::Buffer;
use emu::profile::{Extremes, Observer, Profile, ProfileLevel, UnitCount};
use emu::semantics::{Link, Message, Motion};
use emu::tally::Tally;
use emu::trap::Stop;
use isa::number::Nearest32;
use isa::{Class, Counts, Isa, Op, Program};

use super::builder::{Label, program};
use super::profile::run;

/// An open call, or a jump from one function into another one.
struct Call {
    /// Word to which the callee returns; none for a jump.
    back: Option<u32>,
    /// Regions that are open in the callee, with what was executed since.
    regions: Vec<(u16, Counts)>,
}

/// Calls, and the operations between entering and leaving, by region.
#[derive(Default)]
struct Naive {
    costs: Vec<(Counts, Counts)>,
    around: Vec<Vec<u16>>,
    /// By region: it is a function.
    is_function: Vec<bool>,
    open: Vec<Call>,
    calls: Vec<u64>,
    inclusive: Vec<Counts>,
    extremes: Vec<Option<Extremes>>,
}

impl Naive {
    /// Leaves what is open in the newest call behind the first regions.
    fn leave(&mut self, kept: usize) {
        for (region, cost) in self.open.last_mut().expect("one is open").regions.split_off(kept) {
            let elementary = cost.elementary();
            let found = self.extremes[usize::from(region)].get_or_insert(Extremes {
                least: cost,
                most: cost,
                least_elementary: elementary,
                most_elementary: elementary,
            });
            for &class in Class::ALL {
                found.least[class] = found.least[class].min(cost[class]);
                found.most[class] = found.most[class].max(cost[class]);
            }
            found.least_elementary = found.least_elementary.min(elementary);
            found.most_elementary = found.most_elementary.max(elementary);
        }
    }

    /// Ends the newest calls.
    fn truncate(&mut self, calls: usize) {
        while self.open.len() > calls {
            self.leave(0);
            self.open.pop();
        }
    }

    fn move_to(&mut self, pc: u32) {
        let newest = self.open.last().expect("one is open");
        let around = self.around[pc as usize].clone();
        let is_same = |(open, wanted): &(&(u16, Counts), &u16)| open.0 == **wanted;
        let kept = newest.regions.iter().zip(&around).take_while(is_same).count();
        self.leave(kept);
        around[kept..].iter().for_each(|&region| self.calls[usize::from(region)] += 1);
        let entered = around[kept..].iter().map(|&region| (region, Counts::ZERO));
        self.open.last_mut().expect("one is open").regions.extend(entered);
    }

    /// The outermost function around a word.
    fn function(&self, pc: u32) -> Option<u16> {
        self.around[pc as usize].iter().copied().find(|&region| self.is_function[usize::from(region)])
    }

    /// On to another word without a call or a return: into another function as a call without a way back.
    fn jump(&mut self, from: u32, to: u32) {
        match (self.function(from), self.function(to)) {
            (Some(left), Some(reached)) if left != reached => {
                self.open.push(Call { back: None, regions: Vec::new() });
            }
            (Some(_), None) => {
                let call = self.open.iter().rposition(|call| call.back.is_some()).expect("the first one is none");
                self.truncate(call + 1);
                self.leave(0);
            }
            _ => {}
        }
        self.move_to(to);
    }
}

impl Observer for Naive {
    const IS_ACTIVE: bool = true;

    fn new(code: &Code, _: ProfileLevel) -> Naive {
        let regions = &code.program.regions;
        let around = |slot: u32| {
            let mut found = Vec::new();
            let mut next = code.program.region_of.get(code.word(slot) as usize).copied().flatten();
            while let Some(region) = next {
                found.insert(0, region);
                next = regions[usize::from(region)].parent;
            }
            found
        };
        Naive {
            costs: (0..code.passes().len()).map(|pass| code.pass_cost(pass)).collect(),
            around: (0..code.slots().len() as u32).map(around).collect(),
            is_function: regions.iter().map(|region| region.is_function).collect(),
            open: Vec::new(),
            calls: vec![0; regions.len()],
            inclusive: vec![Counts::ZERO; regions.len()],
            extremes: vec![None; regions.len()],
        }
    }

    fn begin(&mut self, pc: u32) {
        self.open = vec![Call { back: Some(u32::MAX), regions: Vec::new() }];
        self.move_to(pc);
    }

    fn step(&mut self, pc: u32, exit: usize, units: UnitCount, next: u32, motion: Motion) {
        let cost = self.costs[exit].0 + self.costs[exit].1.times(units.units.into());
        let mut is_open = vec![false; self.calls.len()];
        for (region, sum) in self.open.iter_mut().flat_map(|call| &mut call.regions) {
            *sum += cost;
            is_open[usize::from(*region)] = true;
        }
        let open = self.inclusive.iter_mut().zip(is_open).filter(|(_, is_open)| *is_open);
        open.for_each(|(inclusive, _)| *inclusive += cost);
        match motion {
            Motion::Jump => self.jump(pc, next),
            Motion::Call => {
                self.open.push(Call { back: Some(pc + 1), regions: Vec::new() });
                self.move_to(next);
            }
            Motion::Return => match self.open.iter().rposition(|call| call.back == Some(next)) {
                Some(newest) => {
                    self.truncate(newest);
                    self.jump(next - 1, next);
                }
                None => self.jump(pc, next),
            },
        }
    }

    fn end(&mut self) {
        self.truncate(0);
    }

    fn into_profile(self, code: &Code, tally: &Tally) -> Option<Profile> {
        let mut profile = Profile::exclusive(code, tally);
        for (region, found) in profile.regions.iter_mut().enumerate() {
            (found.calls, found.inclusive) = (self.calls[region], self.inclusive[region]);
            found.extremes = self.extremes[region];
        }
        Some(profile)
    }
}

/// A machine of which nobody asks anything.
struct Silent;

impl Link for Silent {
    fn load(&mut self, _: &mut Buffer, _: u32, _: u32, _: u32) -> Result<(), Stop> {
        Err(Stop::Wait)
    }

    fn store(&mut self, _: &Buffer, _: u32, _: u32, _: u32) -> Result<(), Stop> {
        Err(Stop::Wait)
    }

    fn read(&mut self, _: u32, _: &mut [i32]) -> Result<(), Stop> {
        Err(Stop::Wait)
    }

    fn read_octets(&mut self, _: u32, _: &mut [u8]) -> Result<(), Stop> {
        Err(Stop::Wait)
    }

    fn write(&mut self, _: u32, _: &[i32]) -> Result<(), Stop> {
        Err(Stop::Wait)
    }

    fn fetch_add(&mut self, _: u32, _: i32) -> Result<i32, Stop> {
        Err(Stop::Wait)
    }

    fn send(&mut self, _: i32, _: Message) -> Result<(), Stop> {
        Err(Stop::Wait)
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        Err(Stop::Wait)
    }

    fn barrier(&mut self) -> Result<(), Stop> {
        Err(Stop::Wait)
    }
}

/// The profile of a program by the model.
pub fn profile(program: &Program) -> Profile {
    let isa = Isa::base();
    let code = Code::new(program, &isa, emu::machine::Config::default().timing());
    let mut state = State::new(&code, Buffer::new(&program.buffer, 4096));
    let (mut tally, mut naive) = (Tally::new(&code), Naive::new(&code, ProfileLevel::Totals));
    let core = CoreId { core: 0, cores: 1, step_limit: 10_000_000 };
    naive.begin(state.pc);
    interpreter::run(&code, core, &mut state, &Nearest32, &mut Silent, &mut tally, &mut naive);
    naive.end();
    naive.into_profile(&code, &tally).expect("it has one")
}

/// The model and all engines find the same profile.
pub fn check(program: &Program) {
    let (found, _) = run(program);
    assert_eq!(found, profile(program));
}

/// Functions of which each number calls those whose bits it has, one from the other: 8192 sets. Each ends with a call and a return, or with a jump.
fn sets_of_functions(has_jumps: bool) -> Program {
    const FUNCTIONS: i64 = 13;
    program(|p| {
        let labels: Vec<Label> = (0..FUNCTIONS).map(|_| p.label()).collect();
        // Where jumps lead on, all return by the link of the first.
        let link = |number: i64| if has_jumps { 31 } else { 18 + number };
        let turn = |p: &mut super::builder::ProgramBuilder, from: i64| {
            for callee in from..FUNCTIONS {
                let skip = p.label();
                p.emit(Op::srli, &[2, 1, callee]).emit(Op::andi, &[2, 2, 1]);
                p.branch(Op::beq, &[2, 0], skip);
                match has_jumps {
                    true => p.branch(Op::jump, &[], labels[callee as usize]),
                    false => {
                        p.branch(Op::call, &[link(callee)], labels[callee as usize]).emit(Op::ret, &[link(from - 1)])
                    }
                };
                p.place(skip);
            }
        };
        p.constant(1, (1 << FUNCTIONS) - 1);
        let (top, done) = (p.here(), p.label());
        // The first function whose bit is set; the others are called from there.
        for callee in 0..FUNCTIONS {
            let skip = p.label();
            p.emit(Op::srli, &[2, 1, callee]).emit(Op::andi, &[2, 2, 1]);
            p.branch(Op::beq, &[2, 0], skip);
            p.branch(Op::call, &[link(callee)], labels[callee as usize]).branch(Op::jump, &[], done);
            p.place(skip);
        }
        p.place(done).emit(Op::isubi, &[1, 1, 1]);
        p.branch(Op::bne, &[1, 0], top);
        p.emit(Op::halt, &[]);
        for number in 0..FUNCTIONS {
            p.function(&format!("function {number}"), |p| {
                p.place(labels[number as usize]);
                turn(p, number + 1);
                p.emit(Op::ret, &[link(number)]);
            });
        }
    })
}

#[test]
fn each_set_of_open_functions_has_totals_of_its_own_however_many_there_are() {
    check(&sets_of_functions(false));
    check(&sets_of_functions(true));
}
