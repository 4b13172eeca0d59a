//! The results of a picture as data: what `--json` prints. Keys and their meaning are a contract with a version; equal
//! runs give equal octets.

mod hash;
mod hexadecimal;
#[cfg(feature = "cli")]
mod loss_table;
mod losses;
mod moved;
mod provenance;
mod rays;
mod regions;
mod times;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::time::Duration;

use emu::machine::ProcessorUse;
use emu::machine::waits::Waits;
use emu::profile::Profile;
use isa::{Class, Counts};
use scenes::cadrage;
use scenes::metrics::PictureError;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use crate::drawing::Drawing;
use crate::energy::EnergyResult;
use crate::job::{Job, result_name};
use crate::protection::ProtectionUse;
use crate::settings::{Settings, VERSION};
use crate::shadow::ShadowResult;
pub use hash::{image_hash, run_hash};
pub use hexadecimal::{hexadecimal, octet_rows};
#[cfg(feature = "cli")]
pub use loss_table::loss_table;
pub use losses::{Loss, losses};
pub use provenance::WithSettings;
pub use rays::RaysByKind;
pub use regions::{
    CoreFunction, FunctionClocks, OUTSIDE, RegionCost, RegionCounts, core_functions, regions, waiting_kinds,
};
pub use times::OperationTimes;

/// Version of [`Render`]: a key that goes away or changes its meaning changes it, a new key does not.
pub const SCHEMA: &str = "lancer-render-1";

/// One number a class of operations, by the class's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ByClass(pub Counts);

impl Serialize for ByClass {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for (class, count) in self.0.iter() {
            map.serialize_entry(class.name(), &count)?;
        }
        map.end()
    }
}

impl JsonSchema for ByClass {
    fn schema_name() -> Cow<'static, str> {
        "ByClass".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let property = |class: &Class| {
            let what = json_schema!({ "type": "integer", "minimum": 0, "description": class.doc().trim() });
            (class.name().to_owned(), what.to_value())
        };
        let properties: serde_json::Map<String, serde_json::Value> = Class::ALL.iter().map(property).collect();
        let names: Vec<&str> = Class::ALL.iter().map(|class| class.name()).collect();
        json_schema!({
            "type": "object",
            "description": "One number for each class of operations.",
            "properties": properties,
            "required": names,
        })
    }
}

/// A picture and what it took. Counts are those of all cores together; the main processor's stand apart.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Render {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Version of this program.
    pub version: &'static str,
    /// Settings that give the result again: `--settings` reads them.
    pub settings: Settings,
    /// Name of the scene.
    pub scene: String,
    /// Name of the kernels' profile.
    pub profile: &'static str,
    /// Name of the machine.
    pub machine: String,
    /// Width of the drawn part in pixels.
    pub width: u32,
    /// Height of the drawn part in pixels.
    pub height: u32,
    /// First column, first row, width and height of the drawn part; null when all was drawn.
    pub crop: Option<[u32; 4]>,
    /// Triangles of the scene.
    pub triangles: usize,
    /// Rays by kind.
    pub rays: RaysByKind,
    /// Pixels that were interpolated and have no camera ray.
    pub interpolated: u64,
    /// Instructions of all cores.
    pub instructions: u64,
    /// Operations of all cores, by class.
    pub counts: ByClass,
    /// Octets that the cores moved over the bus.
    pub octets: u64,
    /// Clock rate of the machine in hertz.
    pub clock_hz: u64,
    /// Length of the frame in clocks.
    pub clocks: u64,
    /// Length of the frame in seconds.
    pub seconds: f64,
    /// Seconds a pixel.
    pub pixel_seconds: f64,
    /// Clocks and units of operations.
    pub timing: OperationTimes,
    /// Method of the run: `replayed` (pixels ran by themselves, and what they did was put on the machine's clock) or
    /// `stepped` (everything happened in the order of the clock). Nothing else depends on it.
    pub method: &'static str,
    /// Reason for which the frame was not replayed; `None` when it was.
    pub stepped_because: Option<&'static str>,
    /// Engine that was chosen for the cores' program: native (which leaves what runs briefly to the interpreter) or checked. Nothing else depends on it.
    pub engine: &'static str,
    /// Reason for which a faster engine that was wanted was not chosen; `None` where it did.
    pub engine_because: Option<&'static str>,
    /// Clocks of each core: computing, waiting, idle.
    pub cores: Vec<ProcessorResult>,
    /// Functions of the cores' program.
    pub functions: Vec<RegionCounts>,
    /// Regions inside functions of the cores' program; their exclusive counts are not in the function's.
    pub regions: Vec<RegionCounts>,
    /// The main processor.
    pub main: Main,
    /// The bus.
    pub bus: BusResult,
    /// Protections of the machine, what they took beside clocks and energy; zeros where nothing is protected.
    pub protection: ProtectionUse,
    /// Octets over the bus, and beside it, by kind of data: of the kind that a cache holds, the lines that were filled. Without a
    /// cache they are those of `bus.kinds`, which were asked for.
    pub moved_kinds: ByKind,
    /// Bits of a word and fraction bits of each quantity.
    pub formats: FormatTable,
    /// Instructions of the cores of whose results some lost bits or did not fit; left out unless it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flags: Option<Vec<Loss>>,
    /// The picture beside exact arithmetic on the same inputs; left out unless it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shadow: Option<ShadowResult>,
    /// Energy and area; left out unless it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergyResult>,
    /// Difference from double precision; null when it was not measured.
    pub error: Option<PictureError>,
    /// SHA-256 of the picture; see [`image_hash`].
    pub image_hash: String,
    /// SHA-256 of the picture and all counts; see [`run_hash`].
    pub run_hash: String,
    /// Seconds of the host; only when asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub host: Option<Host>,
}

/// Clocks of a processor; `busy + waiting + idle` are the clocks of the frame.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ProcessorResult {
    /// Clocks of instructions.
    pub busy: u64,
    /// Clocks from a bus request to the end of its transfer.
    pub waiting: u64,
    /// Clocks without work.
    pub idle: u64,
    /// Octets that it moved.
    pub octets: u64,
    /// Pixels that it drew.
    pub items: u64,
    /// Longest wait from a request to its grant, in clocks.
    pub longest_wait: u64,
    /// Waits by length: how many of no clock, of 1, of 2 to 3, of 4 to 7 and so on, up to the longest one.
    pub waits: Vec<u64>,
    /// Clocks of its functions, where they were measured; of the main processor they stand in its functions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub functions: Option<Vec<CoreFunction>>,
    /// Clocks of its regions inside functions, where they were measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub regions: Option<Vec<CoreFunction>>,
}

/// The main processor, which makes the camera rays and feeds the cores.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Main {
    /// Instructions.
    pub instructions: u64,
    /// Operations by class.
    pub counts: ByClass,
    /// Clocks of the main processor.
    #[serde(flatten)]
    pub clocks: ProcessorResult,
    /// Share of the frame in which it was not idle.
    pub load: f64,
    /// Functions of its program.
    pub functions: Vec<RegionCounts>,
    /// Regions inside functions of its program, where clocks of functions were measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub regions: Option<Vec<RegionCounts>>,
}

/// The bus.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BusResult {
    /// Clocks in which a transfer held it.
    pub busy: u64,
    /// Octets that went over it.
    pub moved: u64,
    /// Octets that all processors' instructions asked to move.
    pub asked: u64,
    /// Octets that were moved beside it.
    pub aside: u64,
    /// Share of the frame in which it was busy.
    pub utilisation: f64,
    /// Transfers and messages.
    pub transfers: u64,
    /// Grants: a transfer takes one for each of its bursts.
    pub bursts: u64,
    /// Longest wait from a request to its grant, in clocks.
    pub longest_wait: u64,
    /// Octets by kind of data; `messages` are the messages.
    pub kinds: ByKind,
    /// The cores' caches together.
    pub cache: CacheResult,
}

/// Caches.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct CacheResult {
    /// Reads that took no time.
    pub hits: u64,
    /// Reads that had to get lines.
    pub misses: u64,
    /// Octets that hits and misses asked for.
    pub asked: u64,
    /// Octets of the lines that came over the bus.
    pub filled: u64,
}

/// Octets or clocks by kind of data, in the order of the addresses.
#[derive(Clone, Debug, JsonSchema)]
pub struct ByKind(#[schemars(with = "BTreeMap<String, u64>")] pub Vec<(String, u64)>);

impl Serialize for ByKind {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, octets)| (name, octets)))
    }
}

/// Bits of a word and fraction bits of the quantities.
#[derive(Clone, Debug, JsonSchema)]
pub struct FormatTable(#[schemars(with = "BTreeMap<String, i32>")] pub Vec<(&'static str, i32)>);

impl From<&cadrage::Formats> for FormatTable {
    fn from(formats: &cadrage::Formats) -> FormatTable {
        FormatTable(std::iter::once(("word", formats.word as i32)).chain(formats.entries()).collect())
    }
}

impl Serialize for FormatTable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().copied())
    }
}

/// Seconds that the host took.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Host {
    /// Reading the scene.
    pub load_seconds: f64,
    /// Tree, memory image and programs.
    pub build_seconds: f64,
    /// The machine.
    pub run_seconds: f64,
    /// The reference, beside the machine.
    pub reference_seconds: f64,
}

impl Host {
    /// The times of a drawing, and that of reading its scene.
    pub fn new(load: Duration, drawing: &Drawing) -> Host {
        Host {
            load_seconds: load.as_secs_f64(),
            build_seconds: drawing.times.build.as_secs_f64(),
            run_seconds: drawing.times.run.as_secs_f64(),
            reference_seconds: drawing.times.reference.as_secs_f64(),
        }
    }
}

impl Render {
    /// The results of a drawing, without host times.
    pub fn new(job: &Job, drawing: &Drawing) -> Render {
        let frame = &drawing.frame;
        // Tell the cores from the main processor, which comes after the last of them.
        let (cores, main) = frame.processors.split_at(job.machine.cores as usize);
        let main_use = main.first().copied().unwrap_or_default();
        // A whole picture has no crop in its result.
        let whole = (drawing.crop.width, drawing.crop.height) == job.view.size;
        // Sum the operations of both programs, each over all that execute it.
        let counts = frame.profile.as_ref().map(Profile::total).unwrap_or_default();
        let main_counts = frame.main_profile.as_ref().map(Profile::total).unwrap_or_default();
        let kinds: Vec<&str> = frame.kinds.iter().map(|kind| kind.kind.as_str()).collect();
        let has_clocks = !frame.core_clocks.is_empty();
        let program = &drawing.build.cores;
        let core = |number: usize, used: &ProcessorUse| {
            let clocks = frame.core_clocks.get(number);
            ProcessorResult {
                functions: clocks.map(|clocks| core_functions(program, clocks, true)),
                regions: clocks.map(|clocks| core_functions(program, clocks, false)),
                ..ProcessorResult::new(used, frame.waits.get(number))
            }
        };
        let crop = [drawing.crop.column, drawing.crop.row, drawing.crop.width, drawing.crop.height];
        let mut result = Render {
            schema: SCHEMA,
            version: VERSION,
            settings: provenance::settings(job, drawing),
            scene: result_name(&job.scene),
            profile: job.kernels.profile.name(),
            machine: job.machine_name.clone(),
            width: drawing.crop.width,
            height: drawing.crop.height,
            crop: (!whole).then_some(crop),
            triangles: job.scene.triangles.len(),
            // Pixels and rays: camera rays are the pixels that were not interpolated.
            interpolated: drawing.interpolated(),
            rays: RaysByKind::new(drawing.words.len() as u64 - drawing.interpolated(), frame.profile.as_ref()),
            instructions: cores.iter().map(|core| core.instructions).sum(),
            counts: ByClass(counts),
            octets: cores.iter().map(|core| core.octets.0).sum(),
            clock_hz: job.machine.clock_hz,
            clocks: frame.clocks.0,
            seconds: frame.seconds(job.machine.clock_hz),
            pixel_seconds: frame.seconds(job.machine.clock_hz) / drawing.words.len().max(1) as f64,
            timing: OperationTimes::new(&job.machine),
            // How the host did it, which changes nothing else.
            method: frame.method.name(),
            stepped_because: frame.method.reason(),
            engine: drawing.engine.kind.name(),
            engine_because: drawing.engine.refusal,
            cores: (0..).zip(cores).map(|(number, used)| core(number, used)).collect(),
            functions: regions(frame.profile.as_ref(), &kinds, true),
            regions: regions(frame.profile.as_ref(), &kinds, false),
            main: Main {
                instructions: main.iter().map(|main| main.instructions).sum(),
                counts: ByClass(main_counts),
                clocks: ProcessorResult::new(&main_use, frame.waits.get(cores.len())),
                // Share of the frame in which it was not idle; a frame of no clocks has none.
                load: (main_use.busy + main_use.waiting).0 as f64 / frame.clocks.0.max(1) as f64,
                functions: regions(frame.main_profile.as_ref(), &kinds, true),
                regions: has_clocks.then(|| regions(frame.main_profile.as_ref(), &kinds, false)),
            },
            bus: BusResult {
                busy: frame.bus.busy.0,
                moved: frame.bus.moved.0,
                asked: frame.asked.0,
                aside: frame.bypassed.0,
                utilisation: frame.utilisation(),
                transfers: frame.bus.transfers,
                bursts: frame.bus.bursts,
                longest_wait: frame.bus.longest_wait.0,
                kinds: ByKind(frame.kinds.iter().map(|kind| (kind.kind.clone(), kind.octets.0)).collect()),
                cache: CacheResult {
                    hits: frame.cache.hits,
                    misses: frame.cache.misses,
                    asked: frame.cache.asked.0,
                    filled: frame.cache.filled.0,
                },
            },
            protection: ProtectionUse::new(&job.machine, drawing.stored_words(), frame.bus.moved),
            moved_kinds: moved::moved_kinds(job, frame),
            formats: (&drawing.image.formats).into(),
            flags: drawing.flags.clone(),
            shadow: None,
            energy: None,
            error: drawing.error,
            image_hash: image_hash((drawing.crop.width, drawing.crop.height), &drawing.words),
            run_hash: String::new(),
            host: None,
        };
        // The hash is over all that stands above, so it comes last.
        result.run_hash = run_hash(&result);
        result
    }

    /// Scene, size, kernels and machine, as titles of charts and pages name them.
    pub fn title(&self) -> String {
        format!(
            "{}, {} x {} pixels, kernels {}, machine {}",
            self.scene, self.width, self.height, self.profile, self.machine
        )
    }

    /// The text that `--json` prints: one object, a line feed at its end.
    pub fn json(&self) -> String {
        json(self)
    }
}

/// A result as JSON with two blanks of indentation and a line feed at its end.
pub fn json(result: &impl Serialize) -> String {
    let mut text = serde_json::to_string_pretty(result).expect("results have string keys and finite numbers");
    text.push('\n');
    text
}

impl ProcessorResult {
    fn new(used: &ProcessorUse, waits: Option<&Waits>) -> ProcessorResult {
        let ProcessorUse { busy, waiting, idle, octets, longest_wait, items, .. } = *used;
        let waits = waits.map_or(&[][..], |waits| &waits.0);
        let columns = waits.iter().rposition(|&count| count != 0).map_or(0, |last| last + 1);
        ProcessorResult {
            busy: busy.0,
            waiting: waiting.0,
            idle: idle.0,
            octets: octets.0,
            items,
            longest_wait: longest_wait.0,
            waits: waits[..columns].to_vec(),
            functions: None,
            regions: None,
        }
    }
}
