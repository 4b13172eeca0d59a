//! Ledger of a frame by one published table: a line for each item and width, and the same energy by function.

use emu::code::Code;
use emu::machine::{Config, RunOutcome};
use isa::Class;
use schemars::JsonSchema;
use serde::Serialize;

use super::activity::{self, Activity, Width};
use super::price::{ItemPrice, Prices, Pricing, class_item, figure};
use super::{MeasuredPrograms, nanojoules};

/// Activity of a frame, region by region, and of what its processors share.
#[derive(Clone, Debug)]
pub struct FrameActivity {
    /// Name of the program, name of the region, activity; what is in no region stands last, under the name of the program.
    pub regions: Vec<(&'static str, String, Activity)>,
    /// Octets that reads asked of caches.
    pub cached: u64,
    /// Octets that came into caches.
    pub filled: u64,
    /// Octets that went over the bus.
    pub moved: u64,
}

impl FrameActivity {
    /// Activity of a frame that ran on a machine.
    pub fn new(config: &Config, programs: MeasuredPrograms, frame: &RunOutcome) -> FrameActivity {
        let word = config.arithmetic.word;
        let mut regions = Vec::new();
        for (name, program, tally) in
            [("cores", programs.cores, &frame.tally), ("main", programs.main, &frame.main_tally)]
        {
            let code = Code::new(program, programs.isa, config.timing());
            let found = activity::by_region(&code, tally, word);
            let names = program.regions.iter().map(|region| region.name.clone()).chain([String::new()]);
            regions.extend(
                names
                    .zip(found)
                    .filter(|(_, found)| *found != Activity::default())
                    .map(|(region, found)| (name, region, found)),
            );
        }
        FrameActivity { regions, cached: frame.cache.asked.0, filled: frame.cache.filled.0, moved: frame.bus.moved.0 }
    }

    /// Activity of all regions together.
    pub fn total(&self) -> Activity {
        let mut total = Activity::default();
        self.regions.iter().for_each(|(_, _, activity)| total.add(activity, 1));
        total
    }
}

/// One line of a ledger.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LedgerLine {
    /// Name of the item, as a machine file has it.
    pub item: &'static str,
    /// Bits of the numbers; null where the item is a bit.
    pub bits: Option<u32>,
    /// Number of operations or bits.
    pub count: u64,
    /// Attojoules of one.
    pub each_attojoules: u64,
    /// Attojoules of all.
    pub attojoules: i128,
    /// Nanojoules of all.
    pub nanojoules: f64,
    /// Formula and unit of the figure.
    pub formula: String,
    /// Source of the figure.
    pub source: String,
    /// True where no line was published, so that the figure is put together from others.
    pub is_derived: bool,
}

/// Energy of a function, of a region inside of one, of what is in none, or of what processors share.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FunctionEnergy {
    /// Program: `cores`, `main`, or `shared` for what caches save and traffic beside the bus.
    pub program: &'static str,
    /// Name of the function or region; empty for what is in none.
    pub name: String,
    /// Attojoules of its own instructions and of the octets that they asked for.
    pub attojoules: i128,
    /// Nanojoules of them.
    pub nanojoules: f64,
}

/// Energy of a frame by a published table; what the table lacks comes from another one, as the lines say.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TableEnergy {
    /// Name of the table.
    pub table: &'static str,
    /// Process for which its figures are.
    pub technology: &'static str,
    /// Attojoules of the frame, the sum of the lines and of the functions.
    pub attojoules: i128,
    /// Nanojoules of the frame.
    pub frame_nj: f64,
    /// Nanojoules a pixel.
    pub pixel_nj: f64,
    /// Nanojoules a ray of any kind; null where rays are not known.
    pub ray_nj: Option<f64>,
    /// Energy of the frame times its length, in joule seconds.
    pub energy_delay_js: f64,
    /// Nanojoules of operations.
    pub arithmetic_nj: f64,
    /// Nanojoules of registers.
    pub registers_nj: f64,
    /// Nanojoules of buffers.
    pub buffers_nj: f64,
    /// Nanojoules of global memory, bus and caches.
    pub octets_nj: f64,
    /// Larger part: `octets` or `arithmetic`.
    pub decides: &'static str,
    /// The ledger.
    pub lines: Vec<LedgerLine>,
    /// Energy by function, which adds up to the same; those with the most first.
    pub functions: Vec<FunctionEnergy>,
    /// Items that occur but have no figure from anybody, so that nothing is counted for them.
    pub without_figure: Vec<&'static str>,
}

/// Lines in the making.
struct LineList {
    lines: Vec<LedgerLine>,
    without_figure: Vec<&'static str>,
}

impl LineList {
    fn add(&mut self, item: &'static str, price: Option<&ItemPrice>, bits: Option<(Width, u32)>, count: i128) {
        let Ok(count) = u64::try_from(count) else { return };
        if count == 0 {
            return;
        }
        let Some(price) = price else {
            if !self.without_figure.contains(&item) {
                self.without_figure.push(item);
            }
            return;
        };
        let each = price.figures[bits.map_or(0, |(width, _)| width as usize)];
        let attojoules = i128::from(count) * i128::from(each);
        let bits = bits.map(|(_, bits)| bits);
        // Integers and words may be of one width; then they share a line.
        if let Some(line) = self.lines.iter_mut().find(|line| (line.item, line.bits) == (item, bits)) {
            line.count += count;
            line.attojoules += attojoules;
            line.nanojoules = nanojoules(line.attojoules);
            return;
        }
        self.lines.push(LedgerLine {
            item,
            bits,
            count,
            each_attojoules: each,
            attojoules,
            nanojoules: nanojoules(attojoules),
            formula: price.formula.clone(),
            source: price.source.clone(),
            is_derived: price.is_derived,
        });
    }

    fn sum(&self, items: &[&str]) -> i128 {
        self.lines.iter().filter(|line| items.contains(&line.item)).map(|line| line.attojoules).sum()
    }
}

impl TableEnergy {
    /// Energy of a frame that takes so long and has so many pixels and rays.
    pub fn new(pricing: &Pricing, frame: &FrameActivity, seconds: f64, pixels: u64, rays: Option<u64>) -> TableEnergy {
        let (prices, word, total) = (pricing.prices(), pricing.word(), frame.total());
        let mut list = LineList { lines: Vec::new(), without_figure: Vec::new() };
        // Operations, class by class and width by width
        for (&class, price) in Class::ALL.iter().zip(&prices.classes) {
            let Some(item) = class_item(class) else { continue };
            for width in Width::ALL {
                let count = total.operations[class as usize][width as usize];
                list.add(item, price.as_ref(), Some((width, width.bits(word))), count.into());
            }
        }
        // Bits: global memory has what was asked for, with lines that caches got in the place of what was asked of them
        let (cached, filled) = (i128::from(frame.cached), i128::from(frame.filled));
        let octets = i128::from(total.memory_octets) - cached + filled;
        list.add("register", prices.register.as_ref(), None, total.register_bits.into());
        list.add("buffer", prices.buffer.as_ref(), None, total.buffer_bits.into());
        list.add("cache", prices.cache.as_ref(), None, 8 * (cached + filled));
        list.add("bus", prices.bus.as_ref(), None, 8 * i128::from(frame.moved));
        list.add("memory", prices.memory.as_ref(), None, 8 * octets);
        let attojoules: i128 = list.lines.iter().map(|line| line.attojoules).sum();
        let functions = functions(&prices, frame);
        debug_assert_eq!(functions.iter().map(|function| function.attojoules).sum::<i128>(), attojoules);
        let arithmetic: i128 = attojoules - list.sum(&["register", "buffer", "cache", "bus", "memory"]);
        let octets = list.sum(&["cache", "bus", "memory"]);
        let each = |count: u64| nanojoules(attojoules) / count.max(1) as f64;
        TableEnergy {
            table: pricing.table.name,
            technology: pricing.table.technology,
            attojoules,
            frame_nj: nanojoules(attojoules),
            pixel_nj: each(pixels),
            ray_nj: rays.map(each),
            energy_delay_js: nanojoules(attojoules) * 1e-9 * seconds,
            arithmetic_nj: nanojoules(arithmetic),
            registers_nj: nanojoules(list.sum(&["register"])),
            buffers_nj: nanojoules(list.sum(&["buffer"])),
            octets_nj: nanojoules(octets),
            decides: if octets > arithmetic { "octets" } else { "arithmetic" },
            lines: list.lines,
            functions,
            without_figure: list.without_figure,
        }
    }
}

/// The energy by function. Functions are charged for the octets that they ask for; what caches keep off global memory, what caches take
/// themselves and what goes beside the bus is one entry of its own, so that all together are the frame.
fn functions(prices: &Prices, frame: &FrameActivity) -> Vec<FunctionEnergy> {
    let entry =
        |program, name, attojoules| FunctionEnergy { program, name, attojoules, nanojoules: nanojoules(attojoules) };
    let own =
        frame.regions.iter().map(|(program, name, activity)| entry(*program, name.clone(), prices.energy(activity)));
    let mut functions: Vec<FunctionEnergy> = own.collect();
    functions.sort_by(|one, other| other.attojoules.cmp(&one.attojoules).then_with(|| one.name.cmp(&other.name)));
    let total = frame.total();
    let (cached, filled, moved) = (i128::from(frame.cached), i128::from(frame.filled), i128::from(frame.moved));
    let beside = moved - i128::from(total.memory_octets) - i128::from(total.message_octets);
    let shared = 8 * (filled - cached) * figure(prices.memory.as_ref())
        + 8 * (filled + cached) * figure(prices.cache.as_ref())
        + 8 * beside * figure(prices.bus.as_ref());
    if shared != 0 {
        functions.push(entry("shared", "caches".to_owned(), shared));
    }
    functions
}
