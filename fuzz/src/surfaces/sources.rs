//! Sources: assembly, extensions, and kernels of a user's own.

use std::sync::{Arc, LazyLock};

use asm::limits::SourceLimits;
use isa::Isa;
use kernels::Function;
use kernels::build::{KernelOptions, SceneFeatures};
use messages::Source;
use scenes::generate::{GenerateOptions, scene};
use scenes::image::{self, MemoryImage, MemoryOptions};
use scenes::model::{Scene, View};

use super::source;
use crate::project::{files, listings, literals, pieces};
use crate::seen::{PlantedFault, Seen, is_sample};
use crate::surface::{InputForm, Surface};

const LONGEST: usize = 1200;

/// Assembly text.
pub const ASSEMBLER: Surface = Surface {
    name: "assembler",
    form: InputForm::Text,
    longest: LONGEST,
    memory: 32 << 20,
    seeds: assembly,
    run: assemble,
    reader: &[
        "asm/src/assembler.rs",
        "asm/src/conditional.rs",
        "asm/src/cursor.rs",
        "asm/src/data.rs",
        "asm/src/decimal.rs",
        "asm/src/definition.rs",
        "asm/src/directive.rs",
        "asm/src/evaluation.rs",
        "asm/src/expression.rs",
        "asm/src/foreign.rs",
        "asm/src/frame.rs",
        "asm/src/function.rs",
        "asm/src/holding.rs",
        "asm/src/include.rs",
        "asm/src/instruction.rs",
        "asm/src/line.rs",
        "asm/src/listing.rs",
        "asm/src/live_name.rs",
        "asm/src/macros.rs",
        "asm/src/map.rs",
        "asm/src/message.rs",
        "asm/src/operand.rs",
        "asm/src/operator.rs",
        "asm/src/pseudo.rs",
        "asm/src/region.rs",
        "asm/src/statement.rs",
        "asm/src/structure.rs",
        "asm/src/symbol.rs",
        "asm/src/token.rs",
    ],
};

/// Files of extensions.
pub const EXTENSION: Surface = Surface {
    name: "extension",
    form: InputForm::Text,
    longest: 2500,
    memory: 64 << 20,
    seeds: extensions,
    run: extend,
    reader: &["asm/src/extension"],
};

/// A kernel in the place of one of ours, among our others or among stubs: the first octet chooses the function.
pub const KERNEL: Surface = Surface {
    name: "kernel",
    form: InputForm::Text,
    longest: 3000,
    memory: 256 << 20,
    seeds: kernel_files,
    run: replace_kernel,
    reader: &["kernels/src/build.rs"],
};

fn assembly() -> Vec<Vec<u8>> {
    let own = ["tests/cases", "tests/oracles", "examples", "kernels/asm", "src/manual/examples"]
        .into_iter()
        .flat_map(|folder| files(folder, ".s"));
    let tests = ["diagnostics", "outputs", "limits", "language/mod", "language/macros", "language/names"];
    let tests = tests.iter().flat_map(|name| literals(&format!("asm/tests/asm/{name}.rs")));
    let pages = files("asm/src", ".md").into_iter().chain(listings());
    pieces(own.chain(tests).chain(pages).collect(), LONGEST)
}

fn extensions() -> Vec<Vec<u8>> {
    let own = files("extensions", ".isa").into_iter().chain(files("tests", ".isa"));
    let tests = ["refusals", "meanings", "bodies", "faults"]
        .iter()
        .flat_map(|name| literals(&format!("tests/extension/{name}.rs")));
    pieces(own.chain(tests).chain(listings()).collect(), 2500)
}

fn kernel_files() -> Vec<Vec<u8>> {
    let files = pieces(files("kernels/asm", ".s"), 2999);
    // Every function is chosen by some.
    let chosen = (0u8..).zip(files).map(|(number, mut text)| {
        text.insert(0, number % Function::ALL.len() as u8);
        text
    });
    chosen.collect()
}

/// Files that a source may include: one that is good, one that is not, and one that includes itself.
fn include(name: &str, _: &str) -> Result<Arc<Source>, String> {
    match name.len() % 4 {
        0 => Ok(Source::new(name, ".equ included, 4\n")),
        1 => Ok(Source::new(name, "frobnicate\n")),
        2 => Ok(Source::new(name, format!(".include \"{name}\"\n"))),
        _ => Err("there are no files here".into()),
    }
}

thread_local! {
    static BASE: Isa = Isa::base();
}

fn assemble(input: &[u8], seen: &mut Seen) {
    let Some(source) = source("a.s", input) else { return };
    // Small limits, so that a run is short: what is beyond them is the same message sooner.
    let limits =
        SourceLimits { words: 2_000, buffer: 20_000, lines: 3_000, expanded_octets: 20_000, compared_names: 3_000 };
    let options = asm::Options {
        include: &include,
        defines: vec![("outside".into(), 5)],
        formats: vec![("pos".into(), 16)],
        limits,
    };
    let attempt = BASE.with(|isa| asm::attempt(&source, isa, &options));
    seen.report(&attempt.report, input);
    seen.count("words", attempt.program.words.len());
    seen.count("octets", attempt.program.buffer.len());
    seen.count("symbols", attempt.symbols.len());
    seen.count("regions", attempt.program.regions.len());
    if is_sample(input, 16) {
        let _ = asm::listing(&attempt);
    }
    if let Ok(assembled) = attempt.finish() {
        assert!(!assembled.warnings.has_errors(), "a whole program has no errors");
        if is_sample(input, 8) {
            let _ = asm::symbol_map(&assembled);
            let written = asm::object::write(&assembled.program);
            let again = asm::object::read(&written).expect("a program can be written and read");
            assert!(again == assembled.program, "a program is read as it was written");
        }
        let program = &assembled.program;
        seen.plant(PlantedFault::Panic, program.regions.len() == 2);
    }
}

fn extend(input: &[u8], seen: &mut Seen) {
    let source = match asm::extension::source("a.isa", input.to_vec()) {
        Err(report) => return seen.report(&report, input),
        Ok(source) => source,
    };
    let mut isa = BASE.with(Isa::clone);
    match asm::extension::load(&mut isa, &source, &include) {
        Err(report) => seen.report(&report, input),
        Ok(loaded) => {
            seen.count("instructions", loaded.len());
            for op in isa.extensions() {
                let row = isa.definition(op);
                seen.count("operands", row.operands.len());
                seen.count("outcomes", row.outcomes.len());
                seen.count("steps", isa.body(op).map_or(0, |body| body.steps.len()));
                let _ = (row.line(), asm::usage(row));
            }
            seen.plant(PlantedFault::Panic, loaded.len() == 3);
        }
    }
}

/// A small scene in memory, and the options with which its programs are built.
struct BuildWorld {
    scene: Scene,
    view: View,
    image: MemoryImage,
    options: KernelOptions,
}

impl BuildWorld {
    /// A room with mirrors and glass; without levels of secondary rays its programs are much shorter.
    fn new(bounces: u32, interpolate: Option<f64>) -> BuildWorld {
        let options = GenerateOptions { level: Some(1), size: (4, 3), ..GenerateOptions::default() };
        let scene = scene("cornell", &options).expect("the room has such a size");
        let view = View { bounces, ..View::new(scene.size) };
        let image = image::build(&scene, &view, &MemoryOptions::default()).expect("the room fits its formats");
        BuildWorld { scene, view, image, options: KernelOptions { interpolate, ..KernelOptions::default() } }
    }

    fn has(&self, function: Function) -> bool {
        let features = SceneFeatures::new(&self.scene, &self.view, &self.image.formats, &self.options);
        [false, true]
            .into_iter()
            .flat_map(|is_main| Function::of_program(is_main, &features))
            .any(|one| one == function)
    }
}

/// The world of each function: the first one whose programs have it, of which the shortest come first.
static WORLDS: LazyLock<Vec<(Function, Arc<BuildWorld>)>> = LazyLock::new(|| {
    let worlds = [(0, None), (0, Some(0.1)), (2, None)];
    let worlds = worlds.map(|(bounces, interpolate)| Arc::new(BuildWorld::new(bounces, interpolate)));
    let world = |&function: &Function| {
        let world = worlds.iter().find(|world| world.has(function)).expect("some program has the function");
        (function, world.clone())
    };
    Function::ALL.iter().map(world).collect()
});

/// A file for each function that does nothing.
static STUBS: LazyLock<Vec<(Function, Arc<Source>)>> = LazyLock::new(|| {
    let stub = |name: &str| Source::new("stub.s", format!(".func {name}\n    halt\n.endfunc\n"));
    Function::ALL.iter().map(|&function| (function, stub(function.name()))).collect()
});

fn replace_kernel(input: &[u8], seen: &mut Seen) {
    let Some((&first, text)) = input.split_first() else { return };
    let (function, world) = &WORLDS[usize::from(first) % WORLDS.len()];
    let Some(source) = source("own.s", text) else { return };
    let BuildWorld { scene, view, image, options } = &**world;
    // One input of eight stands among our kernels, the others among functions that do nothing: a tenth of the text to assemble.
    let mut replaced = if is_sample(input, 8) { Vec::new() } else { STUBS.clone() };
    replaced.push((*function, source));
    let options = KernelOptions { replaced, ..options.clone() };
    match BASE.with(|isa| kernels::build(scene, view, image, isa, &options)) {
        Err(report) => seen.report(&report, input),
        Ok(build) => {
            seen.report(&build.warnings, input);
            seen.name(function.name());
            seen.count("words", build.cores.words.len() + build.main.words.len());
            seen.plant(PlantedFault::Panic, build.warnings.0.len() == 1);
        }
    }
}
