//! The rows of the annexes under their assumptions: the terms of each sum to its difference, and a recount from a trace of the instructions,
//! by a code of its own, gives the numbers of the profile.

use emu::code::Code;
use emu::engine::interpreter::run;
use emu::engine::{CoreId, Pause, State};
use emu::machine::Config;
use emu::machine::one_core::{self, OneCore};
use emu::octets::{Buffer, Memory};
use emu::profile::{Observer, Profile, ProfileLevel, UnitCount};
use emu::semantics::{Link, Message, Motion};
use emu::tally::Tally;
use emu::trap::Stop;
use isa::number::Nearest32;
use isa::{Class, Counts, Isa, Program};
use kernels::annex::{Row, rows};

/// Calls, least and most of each class in a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Calls {
    calls: u64,
    least: Counts,
    most: Counts,
}

fn assembled(row: &Row, number: u32, isa: &Isa) -> (Program, Vec<u8>) {
    row.program(number, isa).unwrap_or_else(|report| panic!("{}", report.render(false)))
}

/// The program that meets the row's assumption.
fn searched(row: &Row, isa: &Isa) -> (Program, Vec<u8>) {
    let is_met = |(program, memory): &(Program, Vec<u8>)| match &row.search {
        Some(search) => recounted(program, &traced(program, memory, isa), &search.region).calls == search.calls,
        None => true,
    };
    row.tries().map(|number| assembled(row, number, isa)).find(is_met).expect("one of the numbers meets it")
}

/// Calls of a row's region by the machine's profile.
fn profiled(row: &Row, program: &Program, memory: &[u8], isa: &Isa) -> Calls {
    let config = Config::default();
    let one_core =
        OneCore { step_limit: 10_000_000, profile: ProfileLevel::Extremes, ..OneCore::new(&config, isa, program) };
    let run = one_core::run(&one_core, Memory::new(memory.to_vec()))
        .unwrap_or_else(|report| panic!("{}", report.render(false)));
    assert!(run.trap.is_none(), "{}: {:?}", row.id, run.trap);
    let regions = run.profile.expect("a profile was asked for").regions;
    let region = regions.iter().find(|region| region.name == row.region).expect("the region is in the program");
    let extremes = region.extremes.expect("the region was entered");
    Calls { calls: region.calls, least: extremes.least, most: extremes.most }
}

/// An executed instruction.
#[derive(Clone, Copy, Debug)]
struct Step {
    pc: u32,
    next: u32,
    cost: Counts,
    motion: Motion,
}

/// All executed instructions in order.
struct Trace<'a> {
    code: &'a Code<'a>,
    steps: Vec<Step>,
}

impl Observer for Trace<'_> {
    const IS_ACTIVE: bool = true;

    fn new(_: &Code, _: ProfileLevel) -> Self {
        unreachable!("the test makes its own")
    }

    fn begin(&mut self, _: u32) {}

    fn step(&mut self, pc: u32, exit: usize, units: UnitCount, next: u32, motion: Motion) {
        let (cost, each) = self.code.pass_cost(exit);
        self.steps.push(Step { pc, next, cost: cost + each.times(units.units.into()), motion });
    }

    fn end(&mut self) {}

    fn into_profile(self, _: &Code, _: &Tally) -> Option<Profile> {
        None
    }
}

/// A global memory without anyone else.
struct Alone(Memory);

impl Link for Alone {
    fn load(&mut self, buffer: &mut Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        Ok(self.0.read(from, buffer.slice_mut(to, octets)?)?)
    }

    fn store(&mut self, buffer: &Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        Ok(self.0.write(to, buffer.slice(from, octets)?)?)
    }

    fn read(&mut self, address: u32, words: &mut [i32]) -> Result<(), Stop> {
        Ok(self.0.read_words(address, words)?)
    }

    fn read_octets(&mut self, address: u32, octets: &mut [u8]) -> Result<(), Stop> {
        Ok(self.0.read(address, octets)?)
    }

    fn write(&mut self, address: u32, words: &[i32]) -> Result<(), Stop> {
        Ok(self.0.put_words(address, words)?)
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

/// The instructions that a driver executes.
fn traced(program: &Program, memory: &[u8], isa: &Isa) -> Vec<Step> {
    let config = Config::default();
    let code = Code::new(program, isa, config.timing());
    let mut state = State::new(&code, Buffer::new(&program.buffer, config.buffer_octets));
    let mut trace = Trace { code: &code, steps: Vec::new() };
    let (mut link, mut tally) = (Alone(Memory::new(memory.to_vec())), Tally::new(&code));
    let id = CoreId { core: 0, cores: 1, step_limit: 10_000_000 };
    let pause = run(&code, id, &mut state, &Nearest32, &mut link, &mut tally, &mut trace);
    assert_eq!(pause, Pause::Halt);
    trace.steps
}

/// A word lies in a region or in one inside it.
fn is_in(program: &Program, pc: u32, name: &str) -> bool {
    let mut region = program.region_of[pc as usize];
    while let Some(number) = region {
        let here = &program.regions[usize::from(number)];
        if here.name == name {
            return true;
        }
        region = here.parent;
    }
    false
}

/// The sums of a region's visits, each from the instruction that enters it to the last one before the walk has left it, with all that is
/// called in between. Calls are followed by their depth alone.
fn recounted(program: &Program, steps: &[Step], name: &str) -> Calls {
    let mut visits: Vec<Counts> = Vec::new();
    let mut open: Option<u32> = None;
    let mut depth = 0;
    for (at, step) in steps.iter().enumerate() {
        // A visit is over when the walk is back above its depth, or at it and elsewhere
        let came_by_call = at > 0 && steps[at - 1].motion == Motion::Call;
        let is_here = is_in(program, step.pc, name);
        if open.is_some_and(|home| depth < home || depth == home && (!is_here || came_by_call)) {
            open = None;
        }
        if open.is_none() && is_here {
            open = Some(depth);
            visits.push(Counts::ZERO);
        }
        if open.is_some()
            && let Some(visit) = visits.last_mut()
        {
            *visit += step.cost;
        }
        depth = match step.motion {
            Motion::Call => depth + 1,
            Motion::Return => depth - 1,
            Motion::Jump => depth,
        };
        // The trace has no gap.
        assert!(at + 1 == steps.len() || step.next == steps[at + 1].pc);
    }
    // The least and the most are taken class by class, whichever visit has them
    let extreme = |pick: fn(u64, u64) -> u64| {
        let mut found = *visits.first().expect("the region is visited");
        for visit in &visits {
            for (at, count) in found.0.iter_mut().enumerate() {
                *count = pick(*count, visit.0[at]);
            }
        }
        found
    };
    Calls { calls: visits.len() as u64, least: extreme(u64::min), most: extreme(u64::max) }
}

#[test]
fn terms_sum_to_the_differences_and_a_trace_tells_the_same() {
    let isa = Isa::base();
    let mut wrong = String::new();
    for row in rows() {
        let (program, memory) = searched(row, &isa);
        let found = profiled(row, &program, &memory, &isa);
        assert_eq!(recounted(&program, &traced(&program, &memory, &isa), &row.region), found, "{}", row.id);
        for &class in Class::ALL {
            let (least, most, printed) = (found.least[class], found.most[class], row.printed[class]);
            let is_printed = row.classes().any(|other| other == class);
            let difference = if is_printed { row.difference(&found.most, class) } else { 0 };
            let explained = row.explained(class);
            if difference != explained || is_printed && least != most {
                let name = class.name();
                wrong += &format!(
                    "{} {name}: {least}..{most} in {} calls, printed {printed}, difference {difference}, explained {explained}\n",
                    row.id, found.calls
                );
            }
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

/// Reasons are said in words, and a row without terms is met.
#[test]
fn terms_have_reasons() {
    for row in rows() {
        for term in &row.terms {
            assert!(term.reason.len() > 10 && term.counts.iter().all(|&(_, n)| n != 0), "{}: {term:?}", row.id);
        }
    }
}

/// The pixel has the 22 nodes and one light that Annex II assumes, with one number of surfaces only: each ray tests the 40 triangles of its
/// packet.
#[test]
fn the_pixel_has_22_nodes() {
    let isa = Isa::base();
    let row = rows().iter().find(|row| row.id == "rt.pixel").expect("there is such a row");
    let mut nodes = Vec::new();
    for number in row.tries() {
        let (program, memory) = assembled(row, number, &isa);
        let steps = traced(&program, &memory, &isa);
        nodes.push(recounted(&program, &steps, "shade").calls);
        let packets = recounted(&program, &steps, "packet");
        assert_eq!((packets.least.elementary(), packets.most.elementary()), (2561, 2561));
    }
    // Between surfaces without end there are 1 + 1 + 2 + 3 + 6 + 10 ways; one of them meets six.
    assert_eq!(nodes, [1, 6, 14, 20, 22, 23, 23, 23]);
}

/// Comparisons of the first packet, as the reason in annex.toml has them: of the six crossings two lie behind the ray, and beyond those that all take, the
/// four ahead take 5, 5, 2 and 1.
#[test]
fn crossings_ahead_take_as_many_comparisons_as_the_reason_says() {
    let isa = Isa::base();
    let row = rows().iter().find(|row| row.id == "kd.first_packet").expect("there is such a row");
    let (program, memory) = assembled(row, 1, &isa);
    let mut crossings: Vec<u64> = Vec::new();
    for step in traced(&program, &memory, &isa) {
        let line = program.lines[step.pc as usize];
        let source = &program.sources[line.source as usize];
        let text = source.text.lines().nth(line.line as usize - 1).unwrap_or_default();
        if source.name == "kernels/asm/scalar.inc" && text.contains("vmov  v6, zero_vector") {
            crossings.push(0);
        }
        let is_of_crossing = source.name == "kernels/asm/report/first_packet.s" && text.contains("beside_");
        if is_of_crossing && !text.contains("blez") {
            *crossings.last_mut().expect("a crossing has begun") += step.cost[Class::Cmp];
        }
    }
    assert_eq!(crossings.len(), 6, "{crossings:?}");
    crossings.sort_unstable();
    assert_eq!(crossings, [0, 0, 1, 2, 5, 5]);
}
