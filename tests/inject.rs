//! Faults on purpose: the frame that is put together again equals one that is run as a whole, and campaigns do not depend on who runs them.

use emu::inject::{
    BitFlip, FaultKind, FlipPattern, FlipRequest, FlipShape, GoldenFrame, HangLimit, InjectedEnd, InjectedFlip,
    Protection, REGISTER_WORDS, RETRY_CLOCKS, RegisterWord, SeenFlip, inject, inject_at,
};
use emu::machine::arbiter::ArbiterKind;
use emu::machine::{Config, GrantFault, GrantFaultKind, RunFailure, RunOptions, Setup};
use emu::octets::Memory;
use emu::quantity::Clocks;
use emu::stepper::{Lone, LoneEnd, Stepper};
use emu::trap::Fault;
use lancer::job::Job;
use lancer::load::Load;
use random::SplitMix64;
use scenes::generate::{self, GenerateOptions};
use scenes::image::MemoryKind;
use serde_json::Value;

use crate::cli::session::Session;

/// A small picture that has mirrors and glass, on one core, so that work items follow each other in every machine.
struct Small {
    load: Load,
    machine: Config,
    frame: std::ops::Range<u32>,
}

impl Small {
    fn new() -> Small {
        let options = GenerateOptions { level: Some(1), triangles: None, size: (5, 4) };
        let mut job = Job::new(generate::scene("mirrors", &options).unwrap());
        job.machine.cores = 1;
        let (load, image) = Load::picture(&job).unwrap();
        Small { load, machine: job.machine, frame: image.region(MemoryKind::Frame) }
    }

    fn setup(&self) -> Setup<'_> {
        self.load.setup(&self.machine, RunOptions::default())
    }
}

fn flips(golden: &GoldenFrame, target: FaultKind, words: u64, count: u64) -> Vec<BitFlip> {
    let mut series = SplitMix64::new(words ^ count);
    let items = golden.totals().items;
    let draw = |_| {
        // A flip that lasts is there from the beginning, where a whole run can have it.
        let item = if target.is_lasting() { 0 } else { series.below(items) as u32 };
        let moment = series.below(golden.ticks(item).unwrap());
        let word = series.below(words) as u32;
        BitFlip { target, item, moment, word, mask: 1 << series.below(32) }
    };
    (0..count).map(draw).collect()
}

#[test]
fn a_flipped_register_does_what_it_does_on_a_lone_core() {
    let small = Small::new();
    let setup = small.setup();
    let golden = GoldenFrame::new(&setup, &small.load.memory).unwrap();
    let flips = flips(&golden, FaultKind::Registers, REGISTER_WORDS.into(), 150);
    let mut seen = [0; 4];
    for (flip, injected) in flips.iter().zip(inject_at(&golden, &flips)) {
        // The same flip by the debugger's core, which executes instruction by instruction
        let mut stepper = Stepper::new(Lone {
            config: &small.machine,
            isa: &small.load.isa,
            program: &small.load.build.cores,
            registers: Default::default(),
            memory: small.load.memory.clone(),
            message: golden.message(flip.item),
            step_limit: golden.limits().item,
        })
        .unwrap();
        stepper.run_to(flip.moment);
        let RegisterWord { file, number, part } = RegisterWord::numbered(flip.word);
        stepper.change_registers(|registers| match file {
            's' => registers.set_scalar(number, registers.scalar(number) ^ flip.mask as i32),
            'v' => {
                let mut vector = registers.vector(number);
                vector[usize::from(part)] ^= flip.mask as i32;
                registers.set_vector(number, vector);
            }
            _ => registers.set_wide(number, registers.wide(number) ^ i64::from(flip.mask) << (32 * part)),
        });
        assert_eq!(injected.hit.pc, Some(stepper.state().pc), "{flip:?}");
        stepper.run_to(u64::MAX);
        // The frame as that core leaves it
        match stepper.end().unwrap() {
            LoneEnd::Halt => {
                // An answer that goes astray, to the core itself or to another pixel, is the whole machine's business.
                let [answer] = stepper.sent() else { continue };
                let [[pixel, ..], colour] = answer.vectors() else { panic!("an answer has two vectors") };
                if *pixel != golden.message(flip.item).unwrap().first()[0] {
                    continue;
                }
                let mut wanted = golden.memory().clone();
                wanted.put_words(small.frame.start + 12 * *pixel as u32, colour).unwrap();
                let InjectedEnd::Frame { memory, .. } = injected.end else { panic!("{flip:?}: {:?}", injected.end) };
                assert!(memory.unwrap_or(golden.memory().clone()) == wanted, "{flip:?}");
                seen[usize::from(wanted != *golden.memory())] += 1;
            }
            LoneEnd::Fault(Fault::Deadlock) => {
                assert!(matches!(injected.end, InjectedEnd::Hang { limit: HangLimit::ItemWait, .. }), "{flip:?}");
            }
            LoneEnd::Fault(Fault::StepLimit(_)) => {
                let limit = HangLimit::ItemSteps;
                assert_eq!(injected.end, InjectedEnd::Hang { limit, steps: golden.limits().item }, "{flip:?}");
                seen[2] += 1;
            }
            LoneEnd::Fault(fault) => {
                let pc = stepper.state().pc;
                assert_eq!(injected.end, InjectedEnd::Trap { fault, core: 0, pc }, "{flip:?}");
                seen[3] += 1;
            }
        }
    }
    assert!(seen[0] > 0 && seen[1] > 0 && seen[3] > 0, "masked, wrong, hanging, trapped: {seen:?}");
}

/// Compares a frame that was put together with one that ran as a whole on the machine.
fn check_whole(
    small: &Small,
    golden: &GoldenFrame,
    injected: &InjectedFlip,
    whole: Result<Memory, RunFailure>,
) -> &'static str {
    let flip = injected.flip;
    match (whole, &injected.end) {
        (Ok(memory), InjectedEnd::Frame { memory: found, .. }) => {
            let mut found = found.clone().unwrap_or(golden.memory().clone());
            // Where nothing else changes, a flip in memory is not shown.
            let is_in_image = flip.target == FaultKind::Memory && !small.frame.contains(&(4 * flip.word));
            if is_in_image && found == *golden.memory() {
                let word = found.word(4 * flip.word).unwrap();
                found.put_words(4 * flip.word, &[word ^ flip.mask as i32]).unwrap();
            }
            assert!(found == memory, "{flip:?}");
            if memory == *golden.memory() { "same" } else { "other" }
        }
        (Err(RunFailure::Trap(trap)), InjectedEnd::Trap { fault, core, pc }) => {
            assert_eq!((trap.kind, trap.core, trap.pc), (*fault, *core, *pc), "{flip:?}");
            "trap"
        }
        (Err(RunFailure::Trap(trap)), InjectedEnd::Hang { .. }) => {
            assert!(matches!(trap.kind, Fault::StepLimit(_) | Fault::Deadlock), "{flip:?}: {trap}");
            "hang"
        }
        (whole, end) => {
            panic!("{flip:?}: {end:?}, but as a whole {:?}", whole.err().map(|failure| failure.to_string()))
        }
    }
}

#[test]
fn a_flip_that_lasts_does_what_it_does_in_a_whole_run() {
    let small = Small::new();
    let first = small.setup();
    let limit = GoldenFrame::new(&first, &small.load.memory).unwrap().limits().item;
    // The machine finds what hangs by the same limit.
    let machine = Config { step_limit: limit, ..small.machine.clone() };
    let setup = Setup { config: &machine, ..first };
    let golden = GoldenFrame::new(&setup, &small.load.memory).unwrap();
    let run = |setup: &Setup, memory: Memory| emu::step(setup, memory, &mut |_| {}).map(|outcome| outcome.memory);
    let mut seen: Vec<&str> = Vec::new();
    let words = small.load.memory.size() as u64 / 4;
    let flips_of_memory = flips(&golden, FaultKind::Memory, words, 60);
    for injected in inject_at(&golden, &flips_of_memory) {
        let mut memory = small.load.memory.clone();
        let (address, mask) = (4 * injected.flip.word, injected.flip.mask as i32);
        memory.put_words(address, &[memory.word(address).unwrap() ^ mask]).unwrap();
        seen.push(check_whole(&small, &golden, &injected, run(&setup, memory)));
    }
    let flips_of_program = flips(&golden, FaultKind::Program, small.load.build.cores.words.len() as u64, 120);
    for injected in inject_at(&golden, &flips_of_program) {
        let mut program = small.load.build.cores.clone();
        program.words[injected.flip.word as usize] ^= injected.flip.mask;
        let whole = run(&Setup { core: &program, ..setup.clone() }, small.load.memory.clone());
        seen.push(check_whole(&small, &golden, &injected, whole));
    }
    for end in ["same", "other", "trap"] {
        assert!(seen.contains(&end), "{end} is not among the ends");
    }
}

/// End of a frame with a fault of grants on a machine that executes every instruction and asks its arbiter burst by burst.
fn stepped(setup: &Setup, golden: &GoldenFrame, memory: Memory, clocks: Clocks, fault: GrantFault) -> InjectedEnd {
    let options = RunOptions { grant_fault: Some(fault), has_course: true, ..RunOptions::default() };
    let mut finished = 0;
    match emu::step(&Setup { options, ..setup.clone() }, memory, &mut |items| finished = items) {
        Ok(outcome) => InjectedEnd::Frame {
            counts_differ: outcome.clocks != clocks,
            memory: (outcome.memory != *golden.memory()).then_some(outcome.memory),
        },
        Err(RunFailure::Trap(trap)) => match trap.kind {
            Fault::Deadlock => {
                let steps = (0..finished as u32).filter_map(|item| golden.ticks(item)).sum();
                InjectedEnd::Hang { limit: HangLimit::MachineWait, steps }
            }
            fault => InjectedEnd::Trap { fault, core: trap.core, pc: trap.pc },
        },
        Err(failure) => panic!("the machine can be used: {failure}"),
    }
}

#[test]
fn faults_of_grants_do_what_they_do_on_a_machine_that_is_asked_burst_by_burst() {
    let small = Small::new();
    let shape = FlipShape { bits: 1, pattern: FlipPattern::Adjacent };
    let kinds = [
        (FaultKind::LostGrant, Protection::Unprotected),
        (FaultKind::LostGrant, Protection::Retry),
        (FaultKind::StuckArbiter, Protection::Unprotected),
        (FaultKind::StoppedCore, Protection::Unprotected),
    ];
    let mut seen = [0; 3];
    for arbiter in ArbiterKind::ALL {
        // From one core, whose only rival is the main processor, to one for each of the 20 pixels; with and without overlap and caches
        for (cores, overlap, cached) in [(1, false, 0), (2, true, 0), (3, false, 1_024), (20, false, 0)] {
            let mut machine = small.machine.clone();
            machine.cores = cores;
            (machine.bus.arbiter, machine.bus.overlap, machine.cache.octets) = (arbiter, overlap, cached);
            let setup = Setup { config: &machine, ..small.setup() };
            let golden = GoldenFrame::new(&setup, &small.load.memory).unwrap();
            let clocks = emu::step(&setup, small.load.memory.clone(), &mut |_| {}).unwrap().clocks;
            assert_eq!(golden.clocks().unwrap(), clocks);
            // Draw twelve faults of each of the four kinds
            let request = |number: u64| {
                let (target, protection) = kinds[number as usize % kinds.len()];
                FlipRequest { target, shape, seed: 1_000 * number + u64::from(cores), protection }
            };
            let requests: Vec<FlipRequest> = (0..4 * 12).map(request).collect();
            for (request, injected) in requests.iter().zip(inject(&golden, &requests)) {
                // Put the same fault, at the clock and the master that were drawn, into a machine that executes everything
                let kind = match (request.target, request.protection) {
                    (FaultKind::StuckArbiter, _) => GrantFaultKind::Stuck,
                    (FaultKind::StoppedCore, _) => GrantFaultKind::Stopped,
                    (_, Protection::Retry) => GrantFaultKind::Lost { retry: Clocks(RETRY_CLOCKS) },
                    _ => GrantFaultKind::Lost { retry: Clocks(0) },
                };
                let fault = GrantFault { kind, at: Clocks(injected.flip.moment), master: injected.flip.word };
                let wanted = stepped(&setup, &golden, small.load.memory.clone(), clocks, fault);
                assert_eq!(injected.end, wanted, "{} on {cores} cores: {fault:?}", arbiter.name());
                seen[match wanted {
                    InjectedEnd::Frame { counts_differ: false, .. } => 0,
                    InjectedEnd::Frame { .. } => 1,
                    _ => 2,
                }] += 1;
            }
        }
    }
    assert!(seen.iter().all(|&count| count > 20), "unharmed, later, hanging: {seen:?}");
}

#[test]
fn a_lone_core_halts_where_nothing_flips() {
    let small = Small::new();
    let setup = small.setup();
    let golden = GoldenFrame::new(&setup, &small.load.memory).unwrap();
    let whole = emu::run(&setup, small.load.memory.clone(), &mut |_| {}).unwrap();
    assert!(*golden.memory() == whole.memory, "the frame without a fault is that of the machine");
    assert_eq!(golden.totals().items, whole.item_count);
    assert_eq!(golden.totals().steps, whole.tally.instructions());
    let refused = GoldenFrame::up_to(&setup, &small.load.memory, 5).err().expect("a picture has more transfers");
    assert!(refused.to_string().contains("more than 5 transfers"), "{refused}");
    let none = BitFlip { target: FaultKind::Registers, item: 3, moment: 5, word: 0, mask: 0 };
    let end = &inject_at(&golden, &[none])[0].end;
    assert_eq!(*end, InjectedEnd::Frame { counts_differ: false, memory: None });
}

#[test]
fn shares_of_a_campaign_come_together_to_the_same_octets() {
    let session = Session::new();
    let campaign = "inject cornell --size 4x3 --injections 700 --kind registers --kind memory";
    let whole = session.succeed(&format!("{campaign} --json --rows whole.jsonl"));
    // Shares in any order, one of them stopped in the middle and run again, on other numbers of threads
    session.succeed(&format!("{campaign} --parts parts --shard 2/3 --threads 1"));
    session.fail(&format!("{campaign} --parts parts --merge"), 1, "missing");
    session.succeed(&format!("{campaign} --parts parts --shard 0/3 --threads 3"));
    let again = session.succeed(&format!("{campaign} --parts parts --shard 0/3"));
    assert!(again.starts_with("0 injections run, ") && again.ends_with(" were there\n"), "{again}");
    let parts = std::fs::read_dir(session.path("parts")).unwrap();
    let part = parts.map(|entry| entry.unwrap().path()).min().unwrap();
    let text = std::fs::read_to_string(&part).unwrap();
    std::fs::write(&part, &text[..text.len() / 2]).unwrap();
    let again = session.succeed(&format!("{campaign} --parts parts --json --rows parts.jsonl"));
    assert_eq!(std::fs::read_to_string(&part).unwrap(), text, "a part that was cut short is written again");
    assert_eq!(again, whole);
    assert_eq!(session.succeed(&format!("{campaign} --parts parts --merge --json")), whole);
    assert_eq!(session.read("parts.jsonl"), session.read("whole.jsonl"));
    // One of them by its number
    let rows = String::from_utf8(session.read("whole.jsonl")).unwrap();
    let rows: Vec<Value> = rows.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(rows.len(), 1_400);
    for row in rows.iter().step_by(211) {
        let (kind, number) = (row["kind"].as_str().unwrap(), &row["number"]);
        let one = session.json(&format!("inject cornell --size 4x3 --kind {kind} --number {number}"));
        for (key, value) in row.as_object().unwrap() {
            assert_eq!(one[key], *value, "{kind} {number} {key}");
        }
    }
}

#[test]
fn sums_add_up_and_protections_do_what_was_foretold() {
    let session = Session::new();
    let base = "inject cornell --size 4x3 --injections 300";
    let plain = session.json(base);
    let kind = |result: &Value, name: &str| -> Value {
        result["kinds"].as_array().unwrap().iter().find(|kind| kind["kind"] == name).unwrap().clone()
    };
    let count = |kind: &Value, class: &str| -> u64 {
        kind["classes"].as_array().unwrap().iter().find(|one| one["class"] == class).unwrap()["count"].as_u64().unwrap()
    };
    let harmful = |kind: &Value| count(kind, "wrong_pixel") + count(kind, "trap") + count(kind, "hang");
    for target in FaultKind::ALL {
        let kind = kind(&plain, target.name());
        let sum = |list: &str, key: &str| -> u64 {
            kind[list].as_array().unwrap().iter().map(|one| one[key].as_u64().unwrap()).sum()
        };
        assert_eq!(sum("classes", "count"), 300, "{}", target.name());
        assert_eq!(sum("by_structure", "injections"), 300, "{}", target.name());
        if target.has_bits() {
            assert_eq!(sum("by_bit", "harmful"), harmful(&kind), "{}", target.name());
        }
        assert_eq!(sum("traps", "count"), count(&kind, "trap"), "{}", target.name());
        assert_eq!(sum("hangs", "count"), count(&kind, "hang"), "{}", target.name());
        let pixels = &kind["pixels"];
        let wrong = pixels["within_step"].as_u64().unwrap() + pixels["beyond_step"].as_u64().unwrap();
        assert_eq!(wrong, count(&kind, "wrong_pixel"), "{}", target.name());
    }
    assert!(plain["most_vulnerable"].as_array().unwrap().len() == 3);
    // Each protection in a second run
    for (target, protection) in [
        (FaultKind::Registers, Protection::Parity),
        (FaultKind::Program, Protection::Secded),
        (FaultKind::Results, Protection::Residue),
        (FaultKind::LostGrant, Protection::Watchdog),
    ] {
        let (name, scheme) = (target.name(), protection.name());
        let protected = kind(&session.json(&format!("{base} --kind {name} --protect {name}={scheme}")), name);
        let foretold = kind(&plain, name)["protections"]
            .as_array()
            .unwrap()
            .iter()
            .find(|one| one["protection"] == scheme)
            .unwrap()["passed"]
            .as_u64();
        assert_eq!(Some(harmful(&protected)), foretold, "{name} {scheme}");
        assert!(count(&protected, "corrected") + count(&protected, "detected") > 0, "{name} {scheme}");
    }
    // Two bits of results, accumulators among them, change a number by what 3 may divide.
    let pair = "inject cornell --size 4x3 --injections 300 --kind results --bits 2";
    let [plain_pair, protected] =
        ["", " --protect results=residue"].map(|more| kind(&session.json(&format!("{pair}{more}")), "results"));
    let residue = plain_pair["protections"].as_array().unwrap().iter().find(|one| one["protection"] == "residue");
    assert_eq!(residue.unwrap()["passed"], harmful(&protected), "two bits of results");
    assert_eq!(Protection::Secded.sees(1, 1), SeenFlip::Corrected);
    // Of three bits the code leaves other ones wrong, so that it is foretold between what bounds the harm lies.
    let three = "inject cornell --size 4x3 --injections 300 --kind program,memory --bits 3";
    let [unprotected, coded] =
        ["", " --protect program=ecc,memory=ecc"].map(|more| session.json(&format!("{three}{more}")));
    for name in ["program", "memory"] {
        let effects = kind(&unprotected, name)["protections"].clone();
        let ecc = effects.as_array().unwrap().iter().find(|one| one["protection"] == "ecc").unwrap().clone();
        let [passed, unknown] = ["passed", "unknown"].map(|key| ecc[key].as_u64().unwrap());
        let found = harmful(&kind(&coded, name));
        assert!(passed.saturating_sub(unknown) <= found && found <= passed + unknown, "{name}: {found}, {ecc}");
        let share = found as f64 / 300.0;
        let [low, high] = ["low", "high"].map(|key| ecc["left"][key].as_f64().unwrap());
        assert!(unknown > 0 && low <= share && share <= high, "{name}: {share}, {ecc}");
    }
    // A request that is made again is granted, so that only clocks are lost.
    let retried = kind(&session.json(&format!("{base} --kind lost_grant --protect lost_grant=retry")), "lost_grant");
    assert_eq!((harmful(&retried), count(&retried, "wrong_counts") > 200), (0, true), "{retried}");
    let lost = kind(&plain, "lost_grant");
    assert!(count(&lost, "hang") > 250 && lost["hangs"][0]["limit"] == "machine_wait", "{lost}");
    let doubled = kind(&plain, "doubled_grant");
    assert!(harmful(&doubled) > 0 && count(&doubled, "masked") > 0, "{doubled}");
}

#[test]
fn the_last_number_is_one_too() {
    let session = Session::new();
    let one = session.json(&format!("inject triangle --size 4x3 --kind registers --number {}", u64::MAX));
    assert_eq!(one["number"], u64::MAX);
}

#[test]
fn what_cannot_be_injected_is_named() {
    let session = Session::new();
    session.fail("inject cornell --number 3", 2, "name the kind");
    session.fail("inject cornell --protect memory=residue", 2, "the protections of memory are none, parity, ecc");
    session.fail("inject cornell --protect memory", 2, "KIND=PROTECTION");
    session.fail("inject cornell --shard 1/2", 2, "--parts");
    for result in ["--rows rows.jsonl", "--heat heat.png", "--json"] {
        let refusal = format!("'--shard <I/N>' cannot be used with '{}", result.split(' ').next().unwrap_or_default());
        session.fail(&format!("inject cornell --parts parts --shard 1/2 {result}"), 2, &refusal);
    }
    session.fail("inject cornell --heat map.gif", 2, "map.gif");
    // Nothing is injected for a file that cannot be written.
    for option in ["--rows /proc/rows.jsonl", "--heat /proc/heat.png"] {
        let file = option.split(' ').next_back().unwrap();
        session.fail(&format!("inject triangle --size 4x3 --parts parts {option}"), 1, file);
    }
    assert_eq!(session.names(), Vec::<String>::new());
}
