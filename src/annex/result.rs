//! The annexes as data: what `lancer annex --json` prints.

use std::collections::BTreeMap;

use isa::{Class, Counts};
use kernels::annex::{self as printed, PartKind, Peer, Term};
use schemars::JsonSchema;
use serde::Serialize;

use super::figures::{Pixel, derive};
use super::parts::CountedPart;
use super::paths::PathRange;
use super::rates::{CoreRate, core_rates};
use super::scene::OnScene;
use super::storage::Storage;
use super::{AnnexDetail, Measurement, figures};

/// Version of [`Annexes`]: a key that goes away or changes its meaning changes it, a new key does not.
pub const SCHEMA: &str = "lancer-annex-1";

/// Numbers by class, those that an annex prints.
type ByName<N> = BTreeMap<&'static str, N>;

/// All rows and what follows from them.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Annexes {
    /// [`SCHEMA`].
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// The rows.
    pub rows: Vec<RowResult>,
    /// Structures in memory.
    pub storage: Storage,
    /// Figures that the report derives from them.
    pub derived: Derivation,
    /// Errata of the printed figures.
    pub errata: Vec<Erratum>,
}

/// Something odd in the printed figures.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Erratum {
    /// Name of the erratum.
    pub id: &'static str,
    /// Name by which `lancer annex --as-printed` knows it.
    pub name: String,
    /// Place in the report.
    pub source: &'static str,
    /// Printed text.
    pub printed: &'static str,
    /// Correct text.
    pub correct: &'static str,
    /// Effect on other figures.
    pub effect: &'static str,
}

/// A row.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RowResult {
    /// Name of the row.
    pub id: &'static str,
    /// Label as printed.
    pub label: &'static str,
    /// Place in the report.
    pub source: &'static str,
    /// The region of the kernels that is counted.
    pub region: &'static str,
    /// The driver that sets the assumptions.
    pub driver: String,
    /// The path that the driver makes the region go.
    pub path: &'static str,
    /// Other paths of the same walk; null where there are none that take more.
    pub paths: Option<PathResult>,
    /// The constant of the driver that was searched for what the row assumes; null where nothing was.
    pub search: Option<SearchResult>,
    /// As printed, by class.
    pub printed: ByName<u64>,
    /// Sum of the elementary operations printed.
    pub printed_total: u64,
    /// Counted under the assumptions, by class.
    pub assumed: ByName<u64>,
    /// Sum of the elementary operations counted.
    pub assumed_total: u64,
    /// Work that the annexes do not count, by class: moves and constants, logic and shifts, jumps, the local buffer, addresses. Mean of a call.
    pub free: ByName<f64>,
    /// Lines of the row: those that are printed, in their order, then those that are counted alone.
    pub parts: Vec<PartResult>,
    /// On scenes.
    pub scenes: Vec<SceneRow>,
    /// Counted less printed, by class.
    pub difference: ByName<i64>,
    /// Sources of the difference.
    pub terms: Vec<TermResult>,
}

/// A line of a row.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PartResult {
    /// A class, `vector_add`, `vector_sub`, `dot` or `scale` for an operation on vectors, or the name of a row that is called.
    pub kind: String,
    /// Label as printed.
    pub label: String,
    /// Operations of one, as printed; null where the line is not printed.
    pub printed_each: Option<u64>,
    /// Number of them, as printed.
    pub printed_times: u64,
    /// Operations of all of them, as printed.
    pub printed_total: u64,
    /// Number of them that was counted.
    pub counted_times: u64,
    /// Operations of all of them, counted.
    pub counted_total: u64,
}

/// Ways down the tree, each as likely as another.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PathResult {
    /// Constant of the driver that chooses the way: levels at which the walk goes to the right.
    pub constant: &'static str,
    /// The most of these levels.
    pub levels: u32,
    /// Least of a way, by class.
    pub least: ByName<u64>,
    /// Mean of all ways, by class.
    pub mean: ByName<f64>,
    /// Most of a way, by class.
    pub most: ByName<u64>,
}

/// A constant that was searched.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SearchResult {
    /// Name of the constant that is searched.
    pub constant: &'static str,
    /// The function whose calls were counted.
    pub region: &'static str,
    /// Tries in order; the last one is what the row assumes.
    pub tried: Vec<Try>,
}

/// A number that a constant was tried with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Try {
    /// The number.
    pub number: u32,
    /// Calls of the region.
    pub calls: u64,
}

/// A row on a scene.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SceneRow {
    /// Name of the scene.
    pub scene: String,
    /// Calls of the row's region.
    pub calls: u64,
    /// Mean of a call, by class.
    pub mean: ByName<f64>,
    /// Least elementary operations of a call.
    pub least: u64,
    /// Most elementary operations of a call.
    pub most: u64,
    /// Work that the annexes do not count, by class. Mean of a call.
    pub free: ByName<f64>,
}

/// A part of a difference, of one class.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TermResult {
    /// Source line.
    pub line: String,
    /// Class.
    pub class: &'static str,
    /// Operations more than printed.
    pub n: i64,
    /// Reason for the term.
    pub reason: String,
}

/// Figures that the report derives, from the pixel of 22 nodes and from scenes.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Derivation {
    /// Figures by name.
    pub figures: BTreeMap<&'static str, FigureResult>,
    /// Pixel, frame and storage of each scene.
    pub scenes: Vec<SceneFigures>,
    /// Table 3.
    pub table_3: Vec<Peer>,
    /// Rays a second and memory of one core, of other machines and ours.
    pub cores: Vec<CoreRate>,
}

/// A figure.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct FigureResult {
    /// Description of the figure.
    pub label: &'static str,
    /// Place in the report.
    pub source: &'static str,
    /// As printed; null where it is left out.
    pub printed: Option<f64>,
    /// From the pixel of 22 nodes.
    pub counted: f64,
    /// Unit of the figure.
    pub unit: &'static str,
}

/// Figures of a scene, where nothing is assumed.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SceneFigures {
    /// Name of the scene.
    pub scene: String,
    /// Elementary operations a pixel.
    pub pixel_operations: f64,
    /// Clocks of the bus a pixel.
    pub memory_clocks: f64,
    /// Operations over memory clocks.
    pub processors: f64,
    /// Processors that saturate the bus.
    pub saturation: f64,
    /// Milliseconds of a pixel on the machine of four cores, waiting included.
    pub pixel_ms: f64,
    /// Seconds of 640 x 480 such pixels.
    pub frame_s: f64,
    /// Octets of triangles, nodes and references.
    pub storage_octets: [u64; 3],
}

/// `value` by the class's name for all classes that a row's annex prints.
fn by_name<N>(measurement: &Measurement, value: impl Fn(Class) -> N) -> ByName<N> {
    measurement.row.classes().map(|class| (class.name(), value(class))).collect()
}

/// Classes that the annexes do not count: what kernels do beside their operations.
const FREE: [Class; 5] = [Class::Move, Class::Logic, Class::Jump, Class::Local, Class::Address];

/// Work that the annexes do not count, a call.
fn free(inclusive: &Counts, calls: u64) -> ByName<f64> {
    FREE.iter().map(|&class| (class.name(), inclusive[class] as f64 / calls.max(1) as f64)).collect()
}

impl Annexes {
    /// The results of measurements.
    pub fn new(measured: &[Measurement], detail: &AnnexDetail, scenes: &[OnScene]) -> Annexes {
        let rows = (0..).zip(measured).zip(detail.parts.iter().zip(&detail.paths));
        let rows = rows.map(|((number, measurement), (parts, paths))| RowResult {
            parts: part_results(measurement.row, parts),
            paths: paths.as_ref().and_then(|range| PathResult::new(measurement, range)),
            ..RowResult::new(measurement, number, scenes)
        });
        Annexes {
            schema: SCHEMA,
            rows: rows.collect(),
            storage: detail.storage.clone(),
            derived: Derivation::new(measured, scenes),
            errata: printed::errata().iter().map(Erratum::new).collect(),
        }
    }
}

/// Printed and counted lines of a row, those of one kind together.
fn part_results(row: &printed::Row, counted: &[CountedPart]) -> Vec<PartResult> {
    let of = |kind: &PartKind| counted.iter().find(|part| part.kind == *kind);
    let line = |kind: &PartKind, printed: Option<&printed::PrintedPart>| PartResult {
        kind: kind.name().to_owned(),
        label: kind.label().to_owned(),
        printed_each: printed.map(|part| part.each),
        printed_times: printed.map_or(0, |part| part.times),
        printed_total: printed.map_or(0, |part| part.each * part.times),
        counted_times: of(kind).map_or(0, |part| part.times),
        counted_total: of(kind).map_or(0, |part| part.operations),
    };
    let printed = row.parts.iter().map(|part| line(&part.kind, Some(part)));
    let is_printed = |part: &&CountedPart| row.parts.iter().any(|printed| printed.kind == part.kind);
    let others = counted.iter().filter(|part| !is_printed(part)).map(|part| line(&part.kind, None));
    printed.chain(others).collect()
}

impl PathResult {
    fn new(measurement: &Measurement, range: &PathRange) -> Option<PathResult> {
        let spread = measurement.row.spread.as_ref()?;
        Some(PathResult {
            constant: &spread.constant,
            levels: spread.most,
            least: by_name(measurement, |class| range.least[class]),
            mean: by_name(measurement, |class| range.mean_of(class)),
            most: by_name(measurement, |class| range.most[class]),
        })
    }
}

impl Erratum {
    fn new(erratum: &'static printed::PrintedErratum) -> Erratum {
        let printed::PrintedErratum { id, source, printed, correct, effect, .. } = erratum;
        Erratum { id, name: erratum.name(), source, printed, correct, effect }
    }
}

impl RowResult {
    fn new(measurement: &Measurement, number: usize, scenes: &[OnScene]) -> RowResult {
        let (row, most) = (measurement.row, &measurement.most);
        // A scene whose programs do not have the region has no figures for the row.
        let on_scene = |scene: &OnScene| {
            let region = scene.regions.get(number)?.as_ref()?;
            let mean = |class| region.inclusive[class] as f64 / region.calls as f64;
            let extremes = region.extremes?;
            Some(SceneRow {
                scene: scene.scene.clone(),
                calls: region.calls,
                mean: by_name(measurement, mean),
                least: extremes.least_elementary,
                most: extremes.most_elementary,
                free: free(&region.inclusive, region.calls),
            })
        };
        let search = row.search.as_ref().map(|search| SearchResult {
            constant: &search.constant,
            region: &search.region,
            tried: measurement.tried.clone(),
        });
        RowResult {
            search,
            id: &row.id,
            label: &row.label,
            source: &row.source,
            region: &row.region,
            driver: format!("kernels/asm/annex/{}.s", row.driver),
            path: &row.path,
            paths: None,
            free: free(&measurement.inclusive, measurement.calls),
            parts: Vec::new(),
            printed: by_name(measurement, |class| row.printed[class]),
            printed_total: row.printed.elementary(),
            assumed: by_name(measurement, |class| most[class]),
            assumed_total: most.elementary(),
            scenes: scenes.iter().filter_map(on_scene).collect(),
            difference: by_name(measurement, |class| row.difference(most, class)),
            terms: row.terms.iter().flat_map(term).collect(),
        }
    }
}

fn term(term: &Term) -> impl Iterator<Item = TermResult> {
    term.counts.iter().map(|&(class, n)| TermResult {
        line: term.line.clone(),
        class: class.name(),
        n,
        reason: term.reason.clone(),
    })
}

impl Derivation {
    fn new(measured: &[Measurement], scenes: &[OnScene]) -> Derivation {
        let derived = derive(measured);
        let cores = core_rates(measured, &derived, scenes);
        let figures = derived.into_iter().map(|figures::Derived { figure, counted }| {
            let result = FigureResult {
                label: &figure.label,
                source: &figure.source,
                printed: figure.printed,
                counted,
                unit: &figure.unit,
            };
            (figure.id.as_str(), result)
        });
        let scene_figures: Vec<SceneFigures> = scenes.iter().map(SceneFigures::new).collect();
        // Table 3 is continued by the machine here, counted and on scenes.
        let ours = Pixel::of(measured).map(|(pixel, _)| ("counted, 22 nodes".to_owned(), pixel.microseconds()));
        let on_scenes = scene_figures.iter().map(|of| (of.scene.clone(), of.pixel_ms * 1e3));
        let ours = ours.into_iter().chain(on_scenes).map(|(name, pixel_us)| Peer {
            name,
            // One machine, where the report prints 0 for its own.
            servers: 1,
            resolution: [640, 480],
            primitive: "triangles".to_owned(),
            pixel_us,
        });
        let others = printed::peers().iter().cloned();
        Derivation { figures: figures.collect(), table_3: others.chain(ours).collect(), scenes: scene_figures, cores }
    }
}

impl SceneFigures {
    fn new(scene: &OnScene) -> SceneFigures {
        let pixels = scene.pixels.max(1) as f64;
        // Operations and octets of all pixels together, then divided: a transfer has no half octet.
        let whole = Pixel::new(scene.operations as f64, scene.octets);
        let hertz = emu::machine::Config::default().clock_hz as f64;
        let pixel_ms = scene.clocks as f64 / pixels / hertz * 1e3;
        let layout = scenes::layout::Layout::Report.fixed_structures();
        let octets = [layout.triangle, layout.node, layout.reference].map(|structure| structure.octets());
        SceneFigures {
            scene: scene.scene.clone(),
            pixel_operations: whole.operations / pixels,
            memory_clocks: whole.memory / pixels,
            processors: whole.operations / whole.memory.max(1.0),
            saturation: (whole.operations + whole.memory) / whole.memory.max(1.0),
            pixel_ms,
            frame_s: pixel_ms * 1e-3 * 640.0 * 480.0,
            storage_octets: std::array::from_fn(|k| scene.stored[k] * u64::from(octets[k])),
        }
    }
}
