//! The annexes as data: what `lancer annex --json` prints.

use std::collections::BTreeMap;

use isa::Class;
use kernels::annex::{self as printed, Peer, Term};
use schemars::JsonSchema;
use serde::Serialize;

use super::figures::{Pixel, derive};
use super::scene::OnScene;
use super::{Measurement, figures};

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
    /// On scenes.
    pub scenes: Vec<SceneRow>,
    /// Counted less printed, by class.
    pub difference: ByName<i64>,
    /// Sources of the difference.
    pub terms: Vec<TermResult>,
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

impl Annexes {
    /// The results of measurements.
    pub fn new(measured: &[Measurement], scenes: &[OnScene]) -> Annexes {
        let rows = measured.iter().enumerate().map(|(number, measurement)| RowResult::new(measurement, number, scenes));
        Annexes {
            schema: SCHEMA,
            rows: rows.collect(),
            derived: Derivation::new(measured, scenes),
            errata: printed::errata().iter().map(Erratum::new).collect(),
        }
    }
}

impl Erratum {
    fn new(erratum: &'static printed::PrintedErratum) -> Erratum {
        let printed::PrintedErratum { id, source, printed, correct, effect } = erratum;
        Erratum { id, source, printed, correct, effect }
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
        let figures = derive(measured).into_iter().map(|figures::Derived { figure, counted }| {
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
            servers: 0,
            resolution: [640, 480],
            primitive: "triangles".to_owned(),
            pixel_us,
        });
        let others = printed::peers().iter().cloned();
        Derivation { figures: figures.collect(), table_3: others.chain(ours).collect(), scenes: scene_figures }
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
