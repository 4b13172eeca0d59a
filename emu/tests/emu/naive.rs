//! Profiles against a model that adds each instruction at once to all that is open.

use emu::code::Code;
use emu::engine::{CoreId, State, interpreter};
use emu::octets::Buffer;
use emu::profile::{Observer, Profile, ProfileLevel, UnitCount};
use emu::semantics::{Link, Message, Motion};
use emu::tally::Tally;
use emu::trap::Stop;
use isa::number::Nearest32;
use isa::{Counts, Isa, Op, Program};

use super::builder::{Label, program};
use super::profile::run;

/// An open call.
struct Call {
    /// Word to which the callee returns.
    back: u32,
    /// Regions that are open in the callee.
    regions: Vec<u16>,
}

/// Calls, and the operations between entering and leaving, by region.
#[derive(Default)]
struct Naive {
    costs: Vec<(Counts, Counts)>,
    around: Vec<Vec<u16>>,
    open: Vec<Call>,
    calls: Vec<u64>,
    inclusive: Vec<Counts>,
}

impl Naive {
    fn enter(&mut self, kept: usize, pc: u32) {
        let regions = self.around[pc as usize].clone();
        regions[kept..].iter().for_each(|&region| self.calls[usize::from(region)] += 1);
        self.open.last_mut().expect("one is open").regions = regions;
    }

    fn move_to(&mut self, pc: u32) {
        let open = &self.open.last().expect("one is open").regions;
        let kept = open.iter().zip(&self.around[pc as usize]).take_while(|(open, wanted)| open == wanted).count();
        self.enter(kept, pc);
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
            open: Vec::new(),
            calls: vec![0; regions.len()],
            inclusive: vec![Counts::ZERO; regions.len()],
        }
    }

    fn begin(&mut self, pc: u32) {
        self.open = vec![Call { back: u32::MAX, regions: Vec::new() }];
        self.move_to(pc);
    }

    fn step(&mut self, pc: u32, exit: usize, units: UnitCount, next: u32, motion: Motion) {
        let cost = self.costs[exit].0 + self.costs[exit].1.times(units.units.into());
        for region in 0..self.calls.len() {
            if self.open.iter().any(|call| call.regions.contains(&(region as u16))) {
                self.inclusive[region] += cost;
            }
        }
        match motion {
            Motion::Jump => {}
            Motion::Call => self.open.push(Call { back: pc + 1, regions: Vec::new() }),
            Motion::Return => {
                if let Some(newest) = self.open.iter().rposition(|call| call.back == next) {
                    self.open.truncate(newest);
                }
            }
        }
        self.move_to(next);
    }

    fn end(&mut self) {}

    fn into_profile(self, code: &Code, tally: &Tally) -> Option<Profile> {
        let mut profile = Profile::exclusive(code, tally);
        for (region, found) in profile.regions.iter_mut().enumerate() {
            (found.calls, found.inclusive) = (self.calls[region], self.inclusive[region]);
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

/// The profile of a program by the model, without extremes.
pub fn profile(program: &Program) -> Profile {
    let isa = Isa::base();
    let code = Code::new(program, &isa, emu::machine::Config::default().timing());
    let mut state = State::new(&code, Buffer::new(&program.buffer, 4096));
    let (mut tally, mut naive) = (Tally::new(&code), Naive::new(&code, ProfileLevel::Totals));
    let core = CoreId { core: 0, cores: 1, step_limit: 10_000_000 };
    naive.begin(state.pc);
    interpreter::run(&code, core, &mut state, &Nearest32, &mut Silent, &mut tally, &mut naive);
    naive.into_profile(&code, &tally).expect("it has one")
}

/// The model and all engines find the same profile.
pub fn check(program: &Program) {
    let (mut found, _) = run(program);
    found.regions.iter_mut().for_each(|region| region.extremes = None);
    assert_eq!(found, profile(program));
}

#[test]
fn each_set_of_open_functions_has_totals_of_its_own_however_many_there_are() {
    const FUNCTIONS: i64 = 13;
    // Each number calls, one in the other, the functions whose bits it has: 8192 sets.
    check(&program(|p| {
        let labels: Vec<Label> = (0..FUNCTIONS).map(|_| p.label()).collect();
        let turn = |p: &mut super::builder::ProgramBuilder, from: i64| {
            for callee in from..FUNCTIONS {
                let skip = p.label();
                p.emit(Op::srli, &[2, 1, callee]).emit(Op::andi, &[2, 2, 1]);
                p.branch(Op::beq, &[2, 0], skip);
                p.branch(Op::call, &[18 + callee], labels[callee as usize]).emit(Op::ret, &[17 + from]);
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
            p.branch(Op::call, &[18 + callee], labels[callee as usize]).branch(Op::jump, &[], done);
            p.place(skip);
        }
        p.place(done).emit(Op::isubi, &[1, 1, 1]);
        p.branch(Op::bne, &[1, 0], top);
        p.emit(Op::halt, &[]);
        for number in 0..FUNCTIONS {
            p.function(&format!("function {number}"), |p| {
                p.place(labels[number as usize]);
                turn(p, number + 1);
                p.emit(Op::ret, &[18 + number]);
            });
        }
    }));
}
