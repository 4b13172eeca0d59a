//! Recordings of work items that are kept in files, for other processes to replay.

use std::sync::LazyLock;

use emu::machine::{Config, RunOptions, RunOutcome, Setup};
use emu::octets::Memory;
use emu::replay::Recorded;
use isa::{Isa, Op, Program};
use lancer::sweep::recordings::{HEAD, sealed, unsealed};
use programs::builder::program;
use programs::generate::{DATA, image};
use programs::main_processor::dispatch;

use crate::seen::{PlantedFault, Seen};
use crate::surface::{InputForm, Surface};

/// Files of recordings.
pub const RECORDINGS: Surface = Surface {
    name: "recordings",
    form: InputForm::Octets,
    longest: 4_000,
    // Five times the octets of a recording, and machines that replay it.
    memory: 2 << 20,
    seeds,
    run: read,
    reader: &["emu/src/replay/kept.rs"],
};

/// Digest that names the file.
const DIGEST: [u8; 32] = [7; 32];

/// Octets that a file may have.
const LIMIT: u64 = 1 << 20;

/// A program whose work items are recorded, with the octets of its recording and the frame of that.
struct RecordedProgram {
    isa: Isa,
    core: Program,
    main: Program,
    config: Config,
    memory: Memory,
    octets: Vec<u8>,
    frame: Option<RunOutcome>,
}

impl RecordedProgram {
    /// A work item that copies a block, reads some words and answers, as often as is said.
    fn new(items: i32) -> RecordedProgram {
        let core = program(|p| {
            p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[22, 0, 0]).emit(Op::andi, &[22, 22, 7]);
            p.emit(Op::movi, &[1, 0]).emit(Op::movi, &[2, DATA]).emit(Op::movi, &[3, 20]).emit(Op::load, &[1, 2, 3]);
            let again = p.here();
            p.emit(Op::ldw, &[5, 2, 8]).emit(Op::isubi, &[22, 22, 1]);
            p.branch(Op::bge, &[22, 0], again);
            p.emit(Op::vget, &[22, 0, 0]).emit(Op::vsplat, &[6, 22]).emit(Op::vsplat, &[7, 5]).emit(Op::cores, &[20]);
            p.emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
        });
        let mut config = Config { step_limit: 10_000, ..Config::default() };
        config.main.step_limit = 10_000;
        let (memory, octets) = (Memory::new(image()), Vec::new());
        let mut whole =
            RecordedProgram { isa: Isa::base(), core, main: dispatch(items), config, memory, octets, frame: None };
        let recorded = Recorded::new(&whole.setup(), &whole.memory).expect("the items can be recorded");
        let octets = recorded.encode().expect("the recording serves every machine");
        let frame = recorded.replay(&whole.setup(), whole.memory.clone()).expect("it runs").ok();
        (whole.octets, whole.frame) = (octets, frame);
        whole
    }

    fn setup(&self) -> Setup<'_> {
        let options = RunOptions { has_items: true, ..RunOptions::default() };
        let kinds = vec![(0..DATA as u32, "answers".to_owned())];
        Setup { config: &self.config, isa: &self.isa, core: &self.core, main: &self.main, kinds, options }
    }
}

/// Recordings that are kept, all with the same program of the cores.
static KEPT: LazyLock<[RecordedProgram; 2]> = LazyLock::new(|| [1, 9].map(RecordedProgram::new));

fn seeds() -> Vec<Vec<u8>> {
    KEPT.iter().map(|kept| sealed(&kept.octets, &DIGEST)).collect()
}

fn read(input: &[u8], seen: &mut Seen) {
    match unsealed(input, input.len() as u64, &DIGEST, LIMIT) {
        Err(why) => seen.name(&why),
        Ok(octets) => {
            assert!(KEPT.iter().any(|kept| kept.octets == octets), "what has its checksum is what was recorded");
            seen.name("as it was written");
        }
    }
    // Behind a checksum that does not hold nothing more would be read: the same without it.
    let Some(octets) = input.get(HEAD..) else { return };
    let [_, kept] = &*KEPT;
    let setup = kept.setup();
    let recorded = match Recorded::decode(&setup, octets) {
        Err(reason) => return seen.name(reason),
        Ok(recorded) => recorded,
    };
    let written = recorded.encode().expect("what was read can be written");
    let again = Recorded::decode(&setup, &written).map(|again| again.encode());
    assert!(again == Ok(Some(written)), "a recording is read as it was written");
    seen.count("segments", recorded.segments());
    // What another recording comes to is not known, but that it comes to an end is.
    match recorded.replay(&setup, kept.memory.clone()) {
        Err(failure) => seen.text(&failure.to_string()),
        Ok(Err(reason)) => seen.name(reason),
        Ok(Ok(frame)) => {
            assert!(octets != kept.octets || Some(&frame) == kept.frame.as_ref(), "a recording comes to its frame");
            seen.count("clocks", frame.clocks.0 as usize);
        }
    }
    seen.plant(PlantedFault::Panic, KEPT.iter().all(|kept| kept.octets != octets) && recorded.segments() % 5 == 2);
}
