//! Memory of the host that readers and pictures take. These tests are alone in their process, one at a time: they count what is allocated.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::sync::Mutex;

use emu::machine::{Config, RunOptions};
use isa::Isa;
use kernels::KernelSet;
use lancer::drawing::{self, Comparison};
use lancer::files;
use lancer::files::program::ProgramFile;
use lancer::job::Job;
use lancer::load::Load;
use lancer::sweep::contents::Contents;
use lancer::sweep::dataset::DatasetForm;
use lancer::sweep::plan::StudyPlan;
use lancer::sweep::row::PointRow;
use lancer::sweep::study::{self, Study};
use lancer::sweep::{group, merge, part};
use messages::Source;
use peak_alloc::PeakAlloc;
use scenes::generate;
use scenes::kdtree::Depth;
use scenes::write::{MeshFormat, mesh};

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Held by the test that runs.
static ALONE: Mutex<()> = Mutex::new(());

/// Octets that are allocated at once, at most, while a function runs, beyond those of before.
fn peak<T>(run: impl FnOnce() -> T) -> (usize, T) {
    let before = ALLOCATOR.current_usage();
    ALLOCATOR.reset_peak_usage();
    let result = run();
    (ALLOCATOR.peak_usage() - before, result)
}

/// Octets of an input, and what reads it.
type SizedReader = (u64, Box<dyn Fn()>);

/// An input of some megabytes, as the table of docs/formats.md calls it, and its reader.
struct Reading {
    name: &'static str,
    /// Writes the input into a folder and says how large it is and how it is read.
    input: fn(&Path) -> SizedReader,
}

/// A landscape of 40,000 triangles in a format.
fn landscape(folder: &Path, format: MeshFormat) -> SizedReader {
    let options = generate::GenerateOptions { triangles: Some(40_000), ..generate::GenerateOptions::default() };
    let scene = generate::scene("terrain", &options).expect("the terrain has any number of triangles");
    let files = mesh(&scene, format, "landscape").expect("a landscape can be written");
    for (name, octets) in &files {
        fs::write(folder.join(name), octets).expect("a temporary file can be written");
    }
    scene_file(folder, &files[files.len() - 1].0)
}

fn scene_file(folder: &Path, name: &str) -> SizedReader {
    let path = folder.join(name);
    let size = fs::metadata(&path).expect("the file is there").len();
    let read = move || drop(scenes::read::load(&path, None).unwrap_or_else(|report| panic!("{report:?}")));
    (size, Box::new(read))
}

fn text_file(folder: &Path, name: &str, text: &str) -> SizedReader {
    fs::write(folder.join(name), text).expect("a temporary file can be written");
    scene_file(folder, name)
}

/// Facets as text.
fn text_stl(folder: &Path) -> SizedReader {
    let mut text = "solid a\n".to_owned();
    for x in 0..10_000 {
        let _ = write!(
            text,
            "facet normal 0 0 1\nouter loop\nvertex {x} 0 0\nvertex {} 0 0\nvertex {x} 1 0\nendloop\nendfacet\n",
            x + 1
        );
    }
    text_file(folder, "facets.stl", &(text + "endsolid a\n"))
}

/// One face with many corners on a circle.
fn polygon(folder: &Path) -> SizedReader {
    const CORNERS: u32 = 20_000;
    let mut text = String::new();
    for corner in 0..CORNERS {
        let angle = std::f64::consts::TAU * f64::from(corner) / f64::from(CORNERS);
        let _ = writeln!(text, "v {:.9} {:.9} 0", angle.cos(), angle.sin());
    }
    text += "f";
    for corner in 1..=CORNERS {
        let _ = write!(text, " {corner}");
    }
    text_file(folder, "polygon.obj", &(text + "\n"))
}

fn program_text() -> String {
    let mut text = String::new();
    for line in 0..60_000 {
        let _ = writeln!(text, "label{line}: add s1, s2, s3 ; a sum");
    }
    text + "halt\n"
}

fn source(folder: &Path) -> SizedReader {
    let path = folder.join("lines.s");
    let text = program_text();
    fs::write(&path, &text).expect("a temporary file can be written");
    let read = move || {
        let source = files::source(&path).unwrap_or_else(|report| panic!("{report:?}"));
        drop(
            asm::assemble(&source, &Isa::base(), &asm::Options::default())
                .unwrap_or_else(|report| panic!("{report:?}")),
        );
    };
    (text.len() as u64, Box::new(read))
}

/// A repetition: the size is that of the words it makes.
fn repetition(_: &Path) -> SizedReader {
    const TIMES: u64 = 100_000;
    let read = || {
        let source = Source::new("a.s", format!(".rept {TIMES}\nadd s1, s2, s3\n.endr\nhalt\n"));
        drop(
            asm::assemble(&source, &Isa::base(), &asm::Options::default())
                .unwrap_or_else(|report| panic!("{report:?}")),
        );
    };
    (4 * TIMES, Box::new(read))
}

fn program(folder: &Path, form: ProgramFile, name: &str) -> SizedReader {
    let source = Source::new("a.s", program_text());
    let assembled = asm::assemble(&source, &Isa::base(), &asm::Options::default());
    let program = assembled.unwrap_or_else(|report| panic!("{report:?}")).program;
    let octets = form.encode(&program);
    let path = folder.join(name);
    fs::write(&path, &octets).expect("a temporary file can be written");
    let read = move || drop(form.load(&path).unwrap_or_else(|report| panic!("{report:?}")));
    (octets.len() as u64, Box::new(read))
}

const READINGS: &[Reading] = &[
    Reading { name: "`.off`", input: |folder| landscape(folder, MeshFormat::Off) },
    Reading { name: "`.obj`", input: |folder| landscape(folder, MeshFormat::Obj) },
    Reading { name: "`.ply`, binary", input: |folder| landscape(folder, MeshFormat::Ply) },
    Reading { name: "`.stl`, binary", input: |folder| landscape(folder, MeshFormat::Stl) },
    Reading { name: "`.stl`, text", input: text_stl },
    Reading { name: "one polygon of 20,000 corners in an `.obj`", input: polygon },
    Reading { name: "`.s`", input: source },
    Reading { name: "words that `.rept` makes", input: repetition },
    Reading { name: "`.o`", input: |folder| program(folder, ProgramFile::Object, "a.o") },
    Reading { name: "`.bin`", input: |folder| program(folder, ProgramFile::Binary, "a.bin") },
    Reading { name: "`.hex`", input: |folder| program(folder, ProgramFile::Hexadecimal, "a.hex") },
];

/// The limits in the table of docs/formats.md, by the name of the input.
fn limit(name: &str) -> f64 {
    let page = include_str!("../docs/formats.md").split("## Memory that reading takes").nth(1).expect("the heading");
    let row = page.lines().find_map(|line| line.strip_prefix(&format!("| {name} | ")));
    let row = row.unwrap_or_else(|| panic!("docs/formats.md has no row `{name}`"));
    row.split(' ')
        .next()
        .and_then(|number| number.parse().ok())
        .unwrap_or_else(|| panic!("{name}: no number in `{row}`"))
}

#[test]
fn reading_takes_no_more_memory_for_an_octet_than_the_document_says() {
    let _alone = ALONE.lock();
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let mut wrong = String::new();
    for reading in READINGS {
        let (size, read) = (reading.input)(folder.path());
        let (octets, ()) = peak(read);
        let (ratio, limit) = (octets as f64 / size as f64, limit(reading.name));
        // A limit far above what is taken says nothing.
        if !(limit / 2.0..limit).contains(&ratio) {
            let _ = writeln!(wrong, "{}: {ratio:.2} times {size} octets, the document says {limit}", reading.name);
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// Octets of global memory per octet that may be allocated at any time, from the scene on: scene, tree, memory image, machine and
/// reference together.
const MOST: f64 = 3.0;

#[test]
fn a_picture_takes_at_most_three_times_its_memory_image() {
    let _alone = ALONE.lock();
    let options =
        generate::GenerateOptions { triangles: Some(150_000), size: (16, 12), ..generate::GenerateOptions::default() };
    let mut job = Job::new(generate::scene("terrain", &options).expect("the terrain has any number of triangles"));
    job.kernels.profile = KernelSet::Ray;
    job.kd_depth = Some(Depth::Auto);
    let draw =
        || drawing::draw(&job, Comparison::Reference, &mut |_| {}).unwrap_or_else(|failure| panic!("{failure:?}"));
    let (octets, drawing) = peak(draw);
    let image = drawing.frame.memory.size();
    assert!(image > 8 << 20, "what does not grow with the scene must not matter: {image} octets");
    let ratio = octets as f64 / image as f64;
    assert!(ratio < MOST, "{ratio:.2} times the memory image of {image} octets");
}

/// Rows of the study that is merged, and those of each of its parts.
const ROWS: usize = 20_000;
const ROWS_OF_PART: usize = 1_000;

/// Octets that merging a row may take: its place, and its share of the rows that are written at once.
const MOST_OF_ROW: usize = 400;

#[test]
fn rows_of_a_study_are_not_in_memory_while_they_are_merged() {
    let _alone = ALONE.lock();
    let text = "settings = { scene = \"triangle\", view.size = [2, 1] }\n[product]\ncores = [1, 2]\n";
    let study = Study::parse(&Source::new("s.toml", text), "s").unwrap_or_else(|report| panic!("{report:?}"));
    let settings = [0, 1].map(|number| study.settings(number, &Contents::default()).expect("the triangle is there"));
    let mut drawn = group::run(&settings, &Contents::default(), None).expect("it can be drawn");
    let (labels, figures) = drawn.remove(0);
    let row = |number: usize| PointRow {
        point: format!("{number:064x}"),
        set: study.assignments(0).into_iter().collect(),
        labels: labels.clone(),
        figures: figures.clone().ok(),
        refused: None,
    };
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    for part in 0..ROWS / ROWS_OF_PART {
        // Neighbours in the table stand in other parts.
        let rows: Vec<PointRow> = (0..ROWS_OF_PART).map(|number| row(part + number * (ROWS / ROWS_OF_PART))).collect();
        part::write(folder.path(), &format!("{part:064x}"), &rows).unwrap_or_else(|report| panic!("{report:?}"));
    }
    let table = folder.path().join("table.csv");
    let (octets, rows) = peak(|| {
        let (parts, damaged) = part::read_all(folder.path()).unwrap_or_else(|report| panic!("{report:?}"));
        let merged = merge::merge(&parts, &damaged, None).unwrap_or_else(|report| panic!("{report:?}"));
        merged.write(DatasetForm::Csv, &table).unwrap_or_else(|report| panic!("{report:?}"));
        merged.rows()
    });
    assert_eq!((rows, fs::read_to_string(&table).expect("the table is text").lines().count()), (ROWS, ROWS + 1));
    assert!(octets / ROWS < MOST_OF_ROW, "{} octets a row", octets / ROWS);
}

#[test]
fn a_plan_takes_memory_for_the_points_that_it_has_and_not_for_those_that_it_claims() {
    let _alone = ALONE.lock();
    let text = "settings = { scene = \"triangle\" }\n[product]\ncores = \"1-9\"\n";
    let study = Study::parse(&Source::new("s.toml", text), "s").unwrap_or_else(|report| panic!("{report:?}"));
    let mut plan = StudyPlan::new(&study, &Contents::default()).unwrap_or_else(|failure| panic!("{failure:?}"));
    plan.head.points = study::MOST_POINTS;
    let text = String::from_utf8(plan.octets().collect::<Vec<_>>().concat()).expect("a plan is text");
    let (octets, refused) = peak(|| StudyPlan::parse(&text, "plan.jsonl").expect_err("points are missing"));
    assert!(refused.render(false).contains("9 points of the 10000000"), "{}", refused.render(false));
    assert!(octets < 10 * text.len(), "{octets} octets for a text of {}", text.len());
}

/// Octets that the caches and buffers of many cores may take, of which one core does the work: its buffer of 512 KiB, two more for the program's data,
/// what the core's cache holds, and 8 octets for 512 lines of every other one.
const UNTOUCHED: usize = 4 << 20;

/// Octets of the two buffers that a host thread has which runs work items ahead.
const AHEAD: usize = 1 << 20;

#[test]
fn caches_and_buffers_that_nobody_touches_take_nothing() {
    let _alone = ALONE.lock();
    let options = generate::GenerateOptions { size: (1, 1), ..generate::GenerateOptions::default() };
    let job = Job::new(generate::scene("triangle", &options).expect("the triangle has any size"));
    let (load, _) = Load::picture(&job).unwrap_or_else(|failure| panic!("{failure:?}"));
    let small = Config { cores: 256, ..job.machine };
    let mut large = Config { buffer_octets: 1 << 19, ..small.clone() };
    (large.cache.octets, large.cache.line_octets) = (1 << 19, 1);
    // All cores together may have 128 MiB of each.
    large.check().expect("these are the largest ones");
    for name in ["stepped", "replayed"] {
        let [small, large] = [&small, &large].map(|machine| {
            let setup = load.setup(machine, RunOptions::default());
            let run = if name == "stepped" { emu::step } else { emu::run };
            peak(|| run(&setup, load.memory.clone(), &mut |_| {}).unwrap_or_else(|failure| panic!("{failure}"))).0
        });
        let most = small + UNTOUCHED + rayon::current_num_threads() * AHEAD;
        assert!(large < most, "{name}: {large} octets, with small ones {small}");
    }
}
