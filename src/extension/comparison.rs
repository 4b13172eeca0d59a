//! A scene drawn without an extension, with it, and with the bodies of its instructions in their place.

use emu::code::Code;
use isa::table::Op;
use isa::{Isa, Program};
use scenes::metrics::PictureError;
use schemars::JsonSchema;
use serde::Serialize;

use crate::drawing::{self, Comparison, Drawing};
use crate::energy::{EnergyResult, EnergySummary};
use crate::failure::Failure;
use crate::job::Job;
use crate::result::{ByClass, FormatTable, Render};

/// Version of [`ExtensionResult`].
pub const SCHEMA: &str = "lancer-extension-1";

/// One way to draw the scene.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct VariantResult {
    /// Instructions of all cores.
    pub instructions: u64,
    /// Operations of all cores, by class.
    pub counts: ByClass,
    /// Elementary operations of all cores: add, sub, mul, div and cmp.
    pub elementary: u64,
    /// Clocks that all cores together computed; what they wait for the bus is not in it.
    pub busy_clocks: u64,
    /// Octets that the cores moved over the bus.
    pub octets: u64,
    /// Length of the frame in clocks.
    pub clocks: u64,
    /// Energy and area, as a range over published tables; the area is that of the machine's units, without those of the extension.
    pub energy: EnergySummary,
    /// Words of the cores' program and the main processor's.
    pub words: u64,
    /// Bits of a word and fraction bits of each quantity.
    pub formats: FormatTable,
    /// Difference from double precision.
    pub error: Option<PictureError>,
    /// SHA-256 of the picture.
    pub image_hash: String,
    /// SHA-256 of the picture and all counts, as `lancer render --json` prints it.
    pub run_hash: String,
}

/// Changes that an extension makes to a picture's cost.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ExtensionResult {
    /// Version of the result.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// File of the extension.
    pub file: String,
    /// Instructions of the extension.
    pub instructions: Vec<String>,
    /// Executions of each of them by the cores, with the extension.
    pub executions: Vec<u64>,
    /// Name of the scene.
    pub scene: String,
    /// Name of the kernels' profile.
    pub profile: &'static str,
    /// Name of the machine.
    pub machine: String,
    /// Cores of the machine.
    pub cores: u32,
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    /// The profile's own kernels, without the extension.
    pub without: VariantResult,
    /// The replaced kernels with the extension.
    pub with: VariantResult,
    /// The kernels with the extension, each instruction of it as if the instructions of its body stood in its place, on registers of
    /// their own.
    pub expanded: VariantResult,
    /// True where all three pictures are the same, bit for bit.
    pub is_identical: bool,
}

impl VariantResult {
    fn new(job: &Job, drawing: &Drawing, isa: &Isa) -> VariantResult {
        let render = Render::new(job, drawing);
        let size = |program: &Program| -> u64 { program.words.iter().map(|&word| length(word, isa)).sum() };
        VariantResult {
            instructions: render.instructions,
            elementary: render.counts.0.elementary(),
            counts: render.counts,
            busy_clocks: render.cores.iter().map(|core| core.busy).sum(),
            octets: render.octets,
            clocks: render.clocks,
            energy: EnergyResult::of(job, drawing, None).summary,
            words: size(&drawing.build.cores) + size(&drawing.build.main),
            formats: render.formats,
            error: render.error,
            image_hash: render.image_hash,
            run_hash: render.run_hash,
        }
    }
}

/// Words that a word stands for.
fn length(word: u32, isa: &Isa) -> u64 {
    let Some(instruction) = isa.decode(word) else { return 1 };
    match isa.body(instruction.op) {
        Some(body) if isa.is_expanded(instruction.op) => {
            body.steps.iter().filter(|step| matches!(step.act, isa::extension::BodyAct::Execute { .. })).count() as u64
        }
        _ => 1,
    }
}

/// Executions of each instruction by the cores of a picture.
fn executed(job: &Job, drawing: &Drawing, ops: &[Op]) -> Vec<u64> {
    let program = &drawing.build.cores;
    let code = Code::new(program, &job.isa, job.machine.timing());
    let mut executions = vec![0; ops.len()];
    for (pc, &word) in program.words.iter().enumerate() {
        let op = job.isa.decode(word).map(|instruction| instruction.op);
        if let Some(at) = op.and_then(|op| ops.iter().position(|known| *known == op)) {
            executions[at] += drawing.frame.tally.word(&code, pc as u32).instructions;
        }
    }
    executions
}

/// Draws the scene of `plain` without the extension, and that of `extended`, whose set of instructions has it, twice. `progress` is called
/// after each of the three.
///
/// # Errors
/// What keeps one of the three from being drawn.
pub fn compare(
    file: String,
    ops: &[Op],
    plain: &Job,
    extended: &Job,
    progress: &mut dyn FnMut(),
) -> Result<ExtensionResult, Failure> {
    // Draw the three pictures with the same view and machine.
    let mut executions = vec![0; ops.len()];
    let mut draw = |job: &Job, executions: Option<&mut Vec<u64>>| -> Result<VariantResult, Failure> {
        let drawing = drawing::draw(job, Comparison::Reference, &mut |_| {})?;
        progress();
        if let Some(executions) = executions {
            *executions = executed(job, &drawing, ops);
        }
        Ok(VariantResult::new(job, &drawing, &job.isa))
    };
    let without = draw(plain, None)?;
    let with = draw(extended, Some(&mut executions))?;
    // The kernels of the extension with bodies in the places of their instructions: what the extension saves is the difference.
    let mut expanded = extended.clone();
    expanded.isa = extended.isa.expanded(ops);
    let expanded = draw(&expanded, None)?;
    let hashes = [&without.image_hash, &with.image_hash, &expanded.image_hash];
    Ok(ExtensionResult {
        schema: SCHEMA,
        file,
        instructions: ops.iter().map(|&op| extended.isa.definition(op).name.to_string()).collect(),
        executions,
        scene: crate::job::result_name(&plain.scene),
        profile: plain.kernels.profile.name(),
        machine: plain.machine_name.clone(),
        cores: plain.machine.cores,
        size: plain.view.size.into(),
        is_identical: hashes.iter().all(|hash| *hash == hashes[0]),
        without,
        with,
        expanded,
    })
}
