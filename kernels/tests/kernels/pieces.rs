//! The sets of kernels that bring packets to the buffer in pieces: the pictures of `report` bit for bit, the buffer of its section 6.2, and no
//! use of data that are still on their way where loads go on beside computing.

use emu::code::Code;
use emu::engine::interpreter::run;
use emu::engine::{CoreId, Pause, State};
use emu::machine::preset::PRESETS;
use emu::machine::{Config, Setup};
use emu::octets::{Buffer, Memory};
use emu::profile::Unobserved;
use emu::semantics::{Link, Message};
use emu::stepper::Lone;
use emu::tally::Tally;
use emu::trap::Stop;
use isa::Isa;
use isa::number::{Nearest32, Vector};
use kernels::build::{Build, Crop};
use kernels::{KernelOptions, KernelSet, Skips};
use scenes::generate::{self, GenerateOptions};
use scenes::image::{self, MemoryImage, MemoryKind, MemoryOptions};
use scenes::kdtree::Depth;
use scenes::layout::Layout;
use scenes::model::{Scene, View};

use super::drawing::coarse;

const SIZE: (u32, u32) = (12, 9);

/// A picture to be drawn.
#[derive(Clone, Copy)]
struct PieceSubject<'a> {
    scene: &'a Scene,
    layout: Layout,
    depth: Depth,
    word: u32,
    skips: Skips,
}

impl<'a> PieceSubject<'a> {
    /// A picture by the report's tree and layout in 32 bits.
    fn new(scene: &'a Scene) -> PieceSubject<'a> {
        PieceSubject { scene, layout: Layout::Report, depth: Depth::default(), word: 32, skips: Skips::ALL }
    }

    fn image(&self) -> MemoryImage {
        let PieceSubject { layout, depth: kd_depth, word, .. } = *self;
        let options = MemoryOptions { word, layout, kd_depth, ..MemoryOptions::default() };
        image::build(self.scene, &View::new(SIZE), &options).expect("the scene fits the word")
    }

    fn build(&self, set: KernelSet, image: &MemoryImage, crop: Option<Crop>) -> Build {
        let options = KernelOptions { profile: set, skips: self.skips, crop, ..KernelOptions::default() };
        kernels::build(self.scene, &View::new(SIZE), image, &Isa::base(), &options)
            .unwrap_or_else(|report| panic!("{}", report.render(false)))
    }

    /// The pixels, the octets that the cores moved, and the clocks on a machine.
    fn drawn(&self, set: KernelSet, mut machine: Config) -> (Vec<Vector>, u64, u64) {
        machine.arithmetic.word = self.word;
        let (isa, image) = (Isa::base(), self.image());
        let build = self.build(set, &image, None);
        let (core, main) = (&build.cores, &build.main);
        let setup = Setup { config: &machine, isa: &isa, core, main, kinds: Vec::new(), options: Default::default() };
        let frame = emu::run(&setup, Memory::new(image.bytes.clone()), &mut |_| {})
            .unwrap_or_else(|failure| panic!("{} by {set}: {failure}", self.scene.name));
        let start = image.region(MemoryKind::Frame).start;
        let word = |at: u32| frame.memory.word(at).expect("the frame is in memory");
        let pixels = (0..SIZE.0 * SIZE.1).map(|n| [0, 1, 2].map(|k| word(start + 12 * n + 4 * k))).collect();
        let cores = &frame.processors[..machine.cores as usize];
        (pixels, cores.iter().map(|core| core.octets.0).sum(), frame.clocks.0)
    }
}

fn machine(name: &str) -> Config {
    PRESETS.iter().find(|preset| preset.name == name).expect("a preset").config()
}

/// A buffer beyond every program's need.
fn roomy() -> Config {
    Config { buffer_octets: 65_536, ..machine("two_buffers") }
}

/// All layouts that the report's kernels read, trees down to packets of 676 triangles, which are more than the buffer's 512, and several words.
#[test]
fn pieces_change_no_picture() {
    for number in 0..5 {
        let scene = coarse(number, 300, SIZE);
        let frame = PieceSubject::new(&scene);
        let frames = [
            frame,
            PieceSubject { layout: Layout::Wide, word: 20, ..frame },
            PieceSubject { layout: Layout::Packet, skips: Skips::NONE, ..frame },
            PieceSubject { depth: Depth::Levels(0), word: 24, ..frame },
            PieceSubject { depth: Depth::Levels(3), skips: Skips::NONE, ..frame },
        ];
        for frame in frames {
            let (expected, ..) = frame.drawn(KernelSet::Report, roomy());
            for set in [KernelSet::Buffered, KernelSet::Prefetched] {
                let (found, ..) = frame.drawn(set, roomy());
                let what = (frame.layout, frame.depth, frame.word);
                assert!(found == expected, "{} by {set}, {what:?}", scene.name);
            }
        }
    }
    let cornell = generate::scene("cornell", &GenerateOptions { size: SIZE, ..GenerateOptions::default() }).unwrap();
    let whole = PieceSubject { depth: Depth::Levels(0), ..PieceSubject::new(&cornell) };
    assert_eq!(whole.image().tree.most_triangles, 676);
    let (expected, octets, _) = whole.drawn(KernelSet::Report, machine("report"));
    let buffered = whole.drawn(KernelSet::Buffered, machine("report"));
    assert!(buffered.0 == expected && buffered.1 == octets, "each triangle is fetched once a ray, as it is tested");
    assert!(whole.drawn(KernelSet::Prefetched, machine("two_buffers")).0 == expected);
}

/// The sum of section 6.2: 110 octets for nodes, 15,872 for triangles, 31 for the nearest one, up to 768 of materials and lights. The tree of rays
/// takes less than the report's 1,736, since a node is released when the walk leaves it, and all fits 18,525.
#[test]
fn buffers_are_those_of_the_report() {
    let scene = coarse(2, 300, SIZE);
    let frame = PieceSubject::new(&scene);
    let image = frame.image();
    let octets = |set| frame.build(set, &image, None).cores.buffer.len() as u32;
    let largest = image.tree.most_triangles as u32;
    assert!((1..512).contains(&largest), "{largest}");
    let [report, buffered, prefetched] = [KernelSet::Report, KernelSet::Buffered, KernelSet::Prefetched].map(octets);
    assert_eq!(buffered - report, 512 * 31);
    assert_eq!(prefetched - report, 2 * largest * 31);
    assert!(buffered <= machine("report").buffer_octets, "{buffered}");
    let whole = PieceSubject { depth: Depth::Levels(0), ..frame };
    let most = whole.build(KernelSet::Prefetched, &whole.image(), None).cores.buffer.len() as u32;
    assert!(most <= machine("two_buffers").buffer_octets, "{most}");
}

/// A link whose block loads take their time: the octets lie in the buffer only when the next transfer is asked for, and until then there are
/// others in their place.
struct LateLink<'a> {
    memory: &'a Memory,
    message: Option<Message>,
    sent: Option<Message>,
    /// Place in the buffer, and what comes there.
    coming: Option<(u32, Vec<u8>)>,
    /// Blocks that came while the core went on.
    loads: u32,
}

impl LateLink<'_> {
    /// Nothing is on its way, or the core waits for it.
    fn enter(&self) -> Result<(), Stop> {
        if self.coming.is_some() { Err(Stop::Wait) } else { Ok(()) }
    }
}

impl Link for LateLink<'_> {
    fn load(&mut self, buffer: &mut Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        self.enter()?;
        let place = buffer.slice_mut(to, octets)?;
        let mut data = vec![0; octets as usize];
        self.memory.read(from, &mut data)?;
        if octets > 0 {
            place.fill(0x5A);
            self.coming = Some((to, data));
            self.loads += 1;
        }
        Ok(())
    }

    fn store(&mut self, _: &Buffer, _: u32, _: u32, _: u32) -> Result<(), Stop> {
        unreachable!("cores write nothing")
    }

    fn read(&mut self, address: u32, words: &mut [i32]) -> Result<(), Stop> {
        self.enter()?;
        Ok(self.memory.read_words(address, words)?)
    }

    fn read_octets(&mut self, address: u32, octets: &mut [u8]) -> Result<(), Stop> {
        self.enter()?;
        Ok(self.memory.read(address, octets)?)
    }

    fn write(&mut self, _: u32, _: &[i32]) -> Result<(), Stop> {
        unreachable!("cores write nothing")
    }

    fn fetch_add(&mut self, _: u32, _: i32) -> Result<i32, Stop> {
        unreachable!("cores write nothing")
    }

    fn send(&mut self, _: i32, message: Message) -> Result<(), Stop> {
        self.enter()?;
        self.sent = Some(message);
        Ok(())
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        let message = self.message.take().expect("a work item takes one message");
        Ok((message, 0))
    }

    fn barrier(&mut self) -> Result<(), Stop> {
        unreachable!("cores do not meet")
    }
}

/// The answer of a pixel's program when loads come as late as they may; `None` where it goes astray.
fn late_answer(frame: &PieceSubject, set: KernelSet, column: u32, row: u32) -> (Option<Message>, u32) {
    let (isa, image, config) = (Isa::base(), frame.image(), machine("two_buffers"));
    let build = frame.build(set, &image, Some(Crop { column, row, width: 1, height: 1 }));
    let (core, main) = (&build.cores, &build.main);
    let setup = Setup { config: &config, isa: &isa, core, main, kinds: Vec::new(), options: Default::default() };
    let memory = Memory::new(image.bytes.clone());
    let lone = Lone::first_item(&setup, memory.clone()).expect("the pixel is handed out");
    let code = Code::new(core, &isa, config.timing());
    let mut state = State::new(&code, Buffer::new(&core.buffer, config.buffer_octets));
    let mut link = LateLink { memory: &memory, message: lone.message, sent: None, coming: None, loads: 0 };
    let mut tally = Tally::new(&code);
    let id = CoreId { core: 0, cores: config.cores, step_limit: 10_000_000 };
    loop {
        match run(&code, id, &mut state, &Nearest32, &mut link, &mut tally, &mut Unobserved) {
            Pause::Wait => {
                let (to, data) = link.coming.take().expect("it waits for a load");
                let place = state.buffer.slice_mut(to, data.len() as u32).expect("it was there before");
                place.copy_from_slice(&data);
            }
            Pause::Halt => return (link.sent, link.loads),
            Pause::Fault(_) => return (None, link.loads),
        }
    }
}

/// Answers of the set `prefetched` do not depend on when its loads end. The kernels of `report` use what they load at once, so their answers go wrong
/// on such a machine: the test would see it.
#[test]
fn nothing_is_used_before_it_has_come() {
    for number in [0, 2] {
        let scene = coarse(number, 300, SIZE);
        for depth in [Depth::default(), Depth::Levels(1)] {
            let frame = PieceSubject { depth, ..PieceSubject::new(&scene) };
            let (pixels, ..) = frame.drawn(KernelSet::Report, machine("report"));
            for (column, row) in [(3, 2), (6, 4), (9, 7)] {
                let expected = pixels[(row * SIZE.0 + column) as usize];
                let colour = |message: Option<Message>| message.map(|message| message.vectors()[1]);
                let (answer, loads) = late_answer(&frame, KernelSet::Prefetched, column, row);
                assert_eq!(colour(answer), Some(expected), "{} {depth:?} {column},{row}", scene.name);
                assert!(loads > 10, "{loads}");
                let (early, _) = late_answer(&frame, KernelSet::Report, column, row);
                assert_ne!(colour(early), Some(expected), "the report's kernels do not wait");
            }
        }
    }
}

/// On one core fetching first moves what streaming moves and hides nothing. Two buffers hide most of what loads could hide whose data were there
/// at once, and fetch little for nothing.
#[test]
fn two_buffers_hide_loading_behind_tests() {
    let alone = |name: &str| Config { cores: 1, ..machine(name) };
    for number in [0, 2] {
        let scene = coarse(number, 300, SIZE);
        let frame = PieceSubject::new(&scene);
        let (_, octets, streaming) = frame.drawn(KernelSet::Report, alone("report"));
        let (_, fetched, buffered) = frame.drawn(KernelSet::Buffered, alone("report"));
        let (_, ahead, real) = frame.drawn(KernelSet::Prefetched, alone("two_buffers"));
        let (_, _, ideal) = frame.drawn(KernelSet::Report, alone("double_buffer"));
        println!("{}: {streaming} clocks streaming, {buffered} buffered, {real} ahead, {ideal} ideal", scene.name);
        println!("{}: {octets} octets, {ahead} ahead", scene.name);
        assert_eq!(fetched, octets, "{}", scene.name);
        assert!(buffered.abs_diff(streaming) * 100 < streaming, "{}", scene.name);
        assert!((octets..octets + octets / 20).contains(&ahead), "{}", scene.name);
        assert!(2 * (streaming - real) > streaming - ideal && real > ideal, "{}", scene.name);
    }
}
