//! A scene drawn without an extension, with it, and with the bodies of its instructions in their place.

use isa::table::Op;
use isa::{Class, Isa, Program};
use scenes::metrics::PictureError;
use schemars::JsonSchema;
use serde::Serialize;

use crate::drawing::{self, Comparison as Measure, Drawing};
use crate::failure::Failure;
use crate::job::Job;
use crate::result::{ByClass, Formats, Render};
use crate::table::{count, grouped, row, table};

/// Version of [`Comparison`].
pub const SCHEMA: &str = "lancer-extension-1";

/// One way to draw the scene.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Variant {
    /// Instructions of all cores.
    pub instructions: u64,
    /// Operations of all cores, by class.
    pub counts: ByClass,
    /// Elementary operations of all cores: add, sub, mul, div and cmp.
    pub elementary: u64,
    /// Octets that the cores moved over the bus.
    pub octets: u64,
    /// Length of the frame in clocks.
    pub clocks: u64,
    /// Words of the cores' program and the main processor's.
    pub words: u64,
    /// Bits of a word and fraction bits of each quantity.
    pub formats: Formats,
    /// Difference from double precision.
    pub error: Option<PictureError>,
    /// SHA-256 of the picture.
    pub image_hash: String,
    /// SHA-256 of the picture and all counts, as `lancer render --json` prints it.
    pub run_hash: String,
}

/// What an extension changes.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Comparison {
    /// Version of the result.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// File of the extension.
    pub file: String,
    /// Its instructions.
    pub instructions: Vec<String>,
    /// Name of the scene.
    pub scene: String,
    /// Name of the kernels' profile.
    pub profile: &'static str,
    /// Name of the machine.
    pub machine: String,
    /// Its cores.
    pub cores: u32,
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    /// The profile's own kernels, without the extension.
    pub without: Variant,
    /// The replaced kernels with the extension.
    pub with: Variant,
    /// The same kernels, each instruction of the extension as if the instructions of its body stood in its place, on registers of
    /// their own.
    pub expanded: Variant,
    /// Whether all three pictures are the same, bit for bit.
    pub is_identical: bool,
}

impl Variant {
    fn new(job: &Job, drawing: &Drawing, isa: &Isa) -> Variant {
        let render = Render::new(job, drawing);
        let size = |program: &Program| -> u64 { program.words.iter().map(|&word| length(word, isa)).sum() };
        Variant {
            instructions: render.instructions,
            elementary: render.counts.0.elementary(),
            counts: render.counts,
            octets: render.octets,
            clocks: render.clocks,
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
            body.steps.iter().filter(|step| matches!(step.act, isa::extension::Act::Execute { .. })).count() as u64
        }
        _ => 1,
    }
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
) -> Result<Comparison, Failure> {
    let mut draw = |job: &Job| -> Result<Variant, Failure> {
        let drawing = drawing::draw(job, Measure::Reference, &mut |_| {})?;
        progress();
        Ok(Variant::new(job, &drawing, &job.isa))
    };
    let without = draw(plain)?;
    let with = draw(extended)?;
    let mut expanded = extended.clone();
    expanded.isa = extended.isa.expanded(ops);
    let expanded = draw(&expanded)?;
    let hashes = [&without.image_hash, &with.image_hash, &expanded.image_hash];
    Ok(Comparison {
        schema: SCHEMA,
        file,
        instructions: ops.iter().map(|&op| extended.isa.definition(op).name.to_string()).collect(),
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

/// A change in per cent.
fn change(from: u64, to: u64) -> String {
    match (from, to) {
        (from, to) if from == to => "0.0 %".to_owned(),
        (0, _) => "new".to_owned(),
        (from, to) => format!("{:+.1} %", 100.0 * (to as f64 - from as f64) / from as f64),
    }
}

impl Comparison {
    /// Head and rows of the table.
    fn rows(&self) -> Vec<Vec<String>> {
        let variants = [&self.without, &self.with, &self.expanded];
        let mut rows = vec![row(["", "without", "with", "change", "expanded", "change"])];
        let mut add = |name: &str, value: &dyn Fn(&Variant) -> u64| {
            let [without, with, expanded] = variants.map(value);
            if [without, with, expanded] != [0; 3] {
                rows.push(vec![
                    name.to_owned(),
                    grouped(without),
                    grouped(with),
                    change(without, with),
                    grouped(expanded),
                    change(without, expanded),
                ]);
            }
        };
        add("instructions", &|variant| variant.instructions);
        add("elementary operations", &|variant| variant.elementary);
        for &class in Class::ALL {
            add(class.name(), &|variant| variant.counts.0[class]);
        }
        add("octets on the bus", &|variant| variant.octets);
        add(&format!("clocks on {}", count(self.cores.into(), "core", "cores")), &|variant| variant.clocks);
        add("code in words", &|variant| variant.words);
        let psnr = |variant: &Variant| match variant.error.and_then(|error| error.psnr_db) {
            Some(psnr) => format!("{psnr:.2}"),
            None => "-".to_owned(),
        };
        let [without, with, expanded] = variants.map(psnr);
        rows.push(vec!["PSNR in dB".to_owned(), without, with, String::new(), expanded, String::new()]);
        rows
    }

    fn title(&self) -> String {
        let names: Vec<String> = self.instructions.iter().map(|name| format!("`{name}`")).collect();
        format!(
            "{} of {}: {}, {} x {} pixels, kernels `{}` on machine `{}`\n",
            names.join(", "),
            self.file,
            self.scene,
            self.size[0],
            self.size[1],
            self.profile,
            self.machine
        )
    }

    fn verdict(&self) -> String {
        match self.is_identical {
            true => format!("The pictures are identical: {}\n", self.without.image_hash),
            false => format!(
                "The pictures differ: without {}, with {}\n",
                &self.without.image_hash[..16],
                &self.with.image_hash[..16]
            ),
        }
    }

    /// The table for people.
    pub fn text(&self) -> String {
        format!("{}\n{}\n{}", self.title(), table(self.rows()), self.verdict())
    }

    /// The same as Markdown.
    pub fn markdown(&self) -> String {
        let rows = self.rows();
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let rule = format!("|---|{}\n", "---:|".repeat(rows[0].len() - 1));
        let body: String = rows[1..].iter().map(|cells| line(cells)).collect();
        format!("{}\n{}{rule}{body}\n{}", self.title(), line(&rows[0]), self.verdict())
    }
}
