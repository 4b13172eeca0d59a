//! Energy of a picture: by hand to the last digit, by function, and the table of the documentation.

use std::collections::BTreeMap;

use emu::code::Code;
use emu::engine::EngineKind;
use emu::tally::Tally;
use isa::{Isa, Program};
use lancer::drawing::{self, Comparison, Drawing};
use lancer::energy::{EnergyResult, TableEnergy};
use lancer::job::Job;
use lancer::result::Render;
use scenes::generate::{self, GenerateOptions};

fn job(scene: &str, size: (u32, u32)) -> Job {
    let mut job = Job::new(generate::scene(scene, &GenerateOptions::default()).expect(scene));
    job.view.size = size;
    job
}

fn draw(job: &Job) -> (Drawing, EnergyResult) {
    let drawing = drawing::draw(job, Comparison::None, &mut |_| {}).unwrap_or_else(|failure| panic!("{failure:?}"));
    let rays = Render::new(job, &drawing).rays.all();
    let energy = EnergyResult::of(job, &drawing, Some(rays));
    (drawing, energy)
}

/// Attojoules of operations and bits, from the published figures, by hand.
struct Prices {
    /// Addition, subtraction, multiplication, division and comparison of 32 bits, then of 64.
    operations: [[i128; 5]; 2],
    register_bit: i128,
    buffer_bit: i128,
    memory_bit: i128,
}

/// 0.1 pJ an addition, subtraction or comparison of 32 bits, 3.100000000352 pJ a product; a quotient is 32 steps of 0.2 pJ, one of 64 bits is
/// 64 steps of 0.4 pJ; 12.3333333... pJ a product of 64 bits is 12.266666668032 + 0.066666666688.
/// A buffer of 148,200 bits has L = floor(65536 log2 148200) / 65536 = 1125724 / 65536 = 17.177185...
const HOROWITZ: Prices = Prices {
    operations: [
        [100_000, 100_000, 3_100_000, 6_400_000, 100_000],
        [200_000, 200_000, 12_333_333, 25_600_000, 200_000],
    ],
    register_bit: 9_000,
    buffer_bit: BUFFER_BIT,
    memory_bit: 20_312_500,
};

/// 0.21 pJ an addition, 0.0295 pJ a comparison, 12.68 pJ a product; a quotient is 32 steps of 0.2395 pJ; of 64 bits 64 steps of 0.479 pJ.
const ALADDIN: Prices = Prices {
    operations: [[210_000, 210_000, 12_680_000, 7_664_000, 29_500], [420_000, 420_000, 50_720_000, 30_656_000, 59_000]],
    register_bit: 9_000,
    buffer_bit: BUFFER_BIT,
    memory_bit: 20_312_500,
};

/// 9.02427321e-4 L^3 - 2.68847858e-2 L^2 + 0.208900804 L pJ, in attojoules.
const BUFFER_BIT: i128 = 229_525;

/// Numbers behind the names in a row's outcome: `Done(add 2, mul 3)`.
fn numbers(text: &str) -> BTreeMap<&str, i128> {
    let words: Vec<&str> = text.split([' ', ',']).filter(|word| !word.is_empty()).collect();
    words.chunks_exact(2).map(|pair| (pair[0], pair[1].parse().expect("a number"))).collect()
}

/// Energy of a program on words of 32 bits from its rows as the manual prints them: nothing is shared with the product but the passes.
fn by_hand(prices: &Prices, program: &Program, tally: &Tally) -> i128 {
    let isa = Isa::base();
    let code = Code::new(program, &isa, lancer::MachineConfig::default().timing());
    let mut sum = 0;
    for word in 0..code.words() {
        let Some(row) = code.row(word) else { continue };
        // Take a printed row to pieces, such as `vcross (d: V, a: V, b: V, i: Sh)  "..."  [Done(mul 6, sub 3)]`
        let (mnemonic, rest) = row.line().split_once(" (").map(|(a, b)| (a.to_owned(), b.to_owned())).expect("a row");
        let operands: Vec<(char, String)> = rest
            .split(')')
            .next()
            .unwrap_or("")
            .split(", ")
            .filter_map(|one| one.split_once(": "))
            .map(|(letter, kind)| (letter.chars().next().expect("a letter"), kind.to_owned()))
            .collect();
        let is_read = |letter: char| "xyabc".contains(letter);
        let reads: Vec<&str> =
            operands.iter().filter(|(letter, _)| is_read(*letter)).map(|(_, kind)| kind.as_str()).collect();
        // Operations have 64 bits where all sources are wide numbers
        let is_double = !reads.is_empty() && reads.iter().all(|kind| kind.starts_with('W'));
        // `load` has an address of memory and one of the buffer; `ldnode` reads as many octets as it likes, and has one.
        let addresses = operands.iter().filter(|(_, kind)| kind == "A").count();
        // Count bits of registers: `vcross` reads two vectors and writes one, 3 x 96 = 288
        let bits: i128 = operands
            .iter()
            .map(|(letter, kind)| {
                let width = match kind.as_str() {
                    "S" | "A" => 32,
                    "V" => 96,
                    "V2" => 192,
                    "V3" => 288,
                    "V5" => 480,
                    "W" => 64,
                    "W3" => 192,
                    _ => 0,
                };
                width * (i128::from(is_read(*letter)) + i128::from("dexy".contains(*letter)))
            })
            .sum();
        // Multiply what each outcome costs, once a pass and once a unit, by its price
        for (number, outcome) in row.outcomes.iter().enumerate() {
            let passes = tally.passes(&code, word, number);
            let (count, units) = (i128::from(passes.count), i128::from(passes.units));
            let text = outcome.text();
            let text = text.split_once('(').expect("a list").1.trim_end_matches(')');
            let (once, each) = text.split_once("; each ").unwrap_or((text, ""));
            sum += count * bits * prices.register_bit;
            for (list, times, is_each) in [(once, count, false), (each, units, true)] {
                for (class, operations) in numbers(list.trim_start_matches("each ")) {
                    let place = ["add", "sub", "mul", "div", "cmp"].iter().position(|known| *known == class);
                    sum += operations
                        * times
                        * match (class, place) {
                            (_, Some(place)) => prices.operations[usize::from(is_double)][place],
                            ("address", _) => prices.operations[0][0],
                            ("local", _) => 32 * prices.buffer_bit,
                            ("octet", _) if addresses > 0 => {
                                8 * (prices.memory_bit + if is_each && addresses == 2 { prices.buffer_bit } else { 0 })
                            }
                            ("octet" | "mem" | "move" | "logic" | "jump", _) => 0,
                            _ => panic!("{mnemonic} counts {class}"),
                        };
                }
            }
        }
    }
    sum
}

#[test]
fn four_pixels_and_a_triangle_by_hand() {
    let job = job("triangle", (2, 2));
    assert_eq!(job.scene.triangles.len(), 1);
    let (drawing, energy) = draw(&job);
    for (table, prices) in energy.tables.iter().zip([HOROWITZ, ALADDIN]) {
        let Drawing { build, frame, .. } = &drawing;
        let expected = by_hand(&prices, &build.cores, &frame.tally) + by_hand(&prices, &build.main, &frame.main_tally);
        assert_eq!(table.attojoules, expected, "{}", table.table);
        let line = |item: &str, bits| table.lines.iter().find(|line| (line.item, line.bits) == (item, bits));
        let each = |item, bits| line(item, bits).map(|line| i128::from(line.each_attojoules));
        assert_eq!(each("mul", Some(32)), Some(prices.operations[0][2]));
        assert_eq!(each("buffer", None), Some(prices.buffer_bit));
        assert_eq!(each("memory", None), Some(prices.memory_bit));
    }
    // 61.882227988 and 66.232727000 nJ
    assert_eq!(
        energy.tables.iter().map(|table| table.attojoules).collect::<Vec<_>>(),
        [61_882_227_988, 66_232_727_000]
    );
}

fn check_sums(table: &TableEnergy, what: &str) {
    let functions: i128 = table.functions.iter().map(|function| function.attojoules).sum();
    let lines: i128 = table.lines.iter().map(|line| line.attojoules).sum();
    assert_eq!((functions, lines), (table.attojoules, table.attojoules), "{what} {}", table.table);
    for line in &table.lines {
        assert_eq!(line.attojoules, i128::from(line.count) * i128::from(line.each_attojoules), "{what} {}", line.item);
        assert!(!line.source.is_empty(), "{what} {} has no source", line.item);
    }
}

#[test]
fn functions_and_lines_add_up_to_the_frame_on_every_machine() {
    for preset in emu::machine::preset::PRESETS {
        let mut job = job("cornell", (6, 4));
        job.machine = preset.config();
        job.machine.energy =
            emu::machine::Config::parse(&messages::Source::new("m.toml", "[energy]\nbus = \"0.5 pJ; a test\"\n"))
                .expect("it is right")
                .energy;
        let (drawing, energy) = draw(&job);
        for table in &energy.tables {
            check_sums(table, preset.name);
            let bits = |item: &str| table.lines.iter().find(|line| line.item == item).map_or(0, |line| line.count);
            let octets: u64 =
                drawing.frame.kinds.iter().filter(|kind| kind.kind != "messages").map(|kind| kind.octets.0).sum();
            let cache = drawing.frame.cache;
            // Kinds count what was asked for; what was asked of caches came over the bus in whole lines instead.
            assert_eq!(bits("memory"), 8 * (octets + cache.filled.0 - cache.asked.0), "{}", preset.name);
            assert_eq!(bits("bus"), 8 * drawing.frame.bus.moved.0, "{}", preset.name);
        }
    }
}

#[test]
fn shorter_words_take_less() {
    let energy = |word| {
        let mut job = job("cornell", (6, 4));
        job.machine.arithmetic.word = word;
        draw(&job).1
    };
    let [short, long] = [16, 32].map(energy);
    for (short, long) in short.tables.iter().zip(&long.tables) {
        assert!(short.arithmetic_nj < long.arithmetic_nj && short.registers_nj < long.registers_nj);
        check_sums(short, "16 bits");
    }
    assert!(short.summary.area_um2.most < long.summary.area_um2.most);
}

#[test]
fn pixels_add_up_to_the_cores() {
    for (word, engine) in [(32, EngineKind::default()), (20, EngineKind::Checked)] {
        let mut job = job("cornell", (9, 7));
        job.machine.arithmetic.word = word;
        job.engine = engine;
        let (drawing, energy) = draw(&job);
        let pixels = lancer::energy::pixels(&job).unwrap_or_else(|failure| panic!("{failure:?}"));
        assert_eq!(pixels.len(), drawing.words.len());
        let cores = energy.tables[0].functions.iter().filter(|function| function.program == "cores");
        let all: i128 = pixels.iter().map(|&pixel| i128::from(pixel)).sum();
        assert_eq!(all, cores.map(|function| function.attojoules).sum::<i128>(), "{word} bits");
        assert!(pixels.iter().all(|&pixel| pixel != 0));
    }
}

/// Scenes and words of the documentation's table.
const SCENES: [&str; 5] = ["cornell", "sphereflake", "slabs", "mirrors", "terrain"];
const WORDS: [u32; 3] = [32, 24, 16];

#[test]
fn the_documentation_says_what_decides() {
    let page =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/energy.md")).expect("the page is there");
    let mut lines = Vec::new();
    for scene in SCENES {
        for word in WORDS {
            let mut job = job(scene, (32, 24));
            job.machine.arithmetic.word = word;
            let (_, energy) = draw(&job);
            let both =
                |figure: fn(&TableEnergy) -> String| energy.tables.iter().map(figure).collect::<Vec<_>>().join(" and ");
            let rays = both(|table| format!("{:.1}", table.ray_nj.expect("rays are known")));
            let shares = both(|table| format!("{:.1} %", 100.0 * table.octets_nj / table.frame_nj));
            lines.push(format!("| {scene} | {word} | {rays} | {shares} | {} |", energy.summary.decides));
        }
    }
    let missing: Vec<&String> = lines.iter().filter(|line| !page.contains(*line)).collect();
    assert!(missing.is_empty(), "docs/energy.md lacks these lines:\n{}", lines.join("\n"));
}
