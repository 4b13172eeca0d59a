//! `lancer scene info`: what a scene holds and what it will cost.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use kernels::KernelSet;
use scenes::image::MemoryOptions;
use scenes::info::{SceneInfo, StructureInfo};
use scenes::layout::Layout;
use scenes::model::View;

use crate::arguments::{self, CameraArguments, SettingsArguments, Size, TreeArguments, overrides};
use crate::command::invocation::{CommandSettings, scene_hashes};
use crate::failure::{Exit, Failure};
use crate::numeral::{count, grouped};
use crate::result::WithSettings;
use crate::table::{row, table};
use crate::terminal::Terminal;
use crate::{input, result};

const EXAMPLES: &str = "\
Examples:
  lancer scene info cornell
  lancer scene info house.dsc --layout report
  lancer scene info cornell --camera perspective --fov 60
  lancer scene info bunny.off --word 16 --json";

/// Most materials that are listed one by one.
const MOST_LISTED: usize = 24;

/// Says what a scene holds: parts, kd tree, octets in memory, and what the grid costs in precision.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct InfoArguments {
    /// Scene: a .dsc with its mesh beside it, a mesh, or the name of a generated scene such as cornell.
    scene: String,
    /// Mesh that belongs to the .dsc [default: the file of the same name beside it].
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Structures of global memory.
    #[arg(long, value_name = "NAME", value_parser = layout(), default_value = Layout::Wide.name())]
    layout: Layout,
    #[command(flatten)]
    camera: CameraArguments,
    /// Size of the picture, in pixels [default: the size in the .dsc, else 320x240].
    #[arg(long, value_name = "WxH", value_parser = arguments::size)]
    size: Option<Size>,
    #[command(flatten)]
    tree: TreeArguments,
    /// Bits of a word, 8 to 32.
    #[arg(long, value_name = "BITS", value_parser = clap::value_parser!(u32).range(8..=32), default_value = "32")]
    word: u32,
    /// Fraction bits of pos, dir, bary, t, weight or colour; may be repeated [default: by the scene].
    #[arg(long = "format", value_name = "QUANTITY=BITS", value_parser = overrides::check)]
    formats: Vec<String>,
    #[command(flatten)]
    settings: SettingsArguments,
    /// Prints the facts as JSON.
    #[arg(long)]
    json: bool,
}

fn layout() -> impl TypedValueParser<Value = Layout> {
    let names = PossibleValuesParser::new(Layout::ALL.iter().map(|layout| layout.name()));
    names.map(|name| name.parse().expect("the parser lets only names pass"))
}

/// Reads the scene and prints its facts.
pub(super) fn execute(
    arguments: &InfoArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    let loaded = input::scene(&arguments.scene, arguments.mesh.as_deref(), arguments.size)?;
    terminal.show(&loaded.warnings);
    let kernels = KernelSet::of_layout(arguments.layout);
    let options = MemoryOptions {
        word: arguments.word,
        layout: arguments.layout,
        kd_depth: arguments.tree.kd_depth.unwrap_or(kernels.kd_depth()),
        kd_method: arguments.tree.kd_build.unwrap_or(kernels.kd_method()),
        kd_visit: arguments.tree.kd_visit,
        formats: overrides::collect(&arguments.formats),
    };
    let size = arguments.size.unwrap_or(loaded.scene.size);
    let view = View { camera: arguments.camera.settings().camera()?, ..View::new(size) };
    let facts = SceneInfo::new(&loaded.scene, &view, &options)?;
    let hashes = scene_hashes(std::slice::from_ref(&arguments.scene), std::slice::from_ref(&loaded.scene));
    match arguments.json {
        true => terminal.print(&result::json(&WithSettings::new(&facts, given.clone().with_scenes(&hashes))))?,
        false => terminal.tell(&text(&facts))?,
    }
    Ok(Exit::Done)
}

fn text(facts: &SceneInfo) -> String {
    let mut text = format!(
        "{}: {}, {}, {}, {}; {} x {} pixels\n",
        facts.scene,
        count(facts.triangles as u64, "triangle", "triangles"),
        count(facts.vertices as u64, "vertex", "vertices"),
        count(facts.materials.len() as u64, "material", "materials"),
        count(facts.lights as u64, "light", "lights"),
        facts.width,
        facts.height,
    );
    if facts.unused_vertices != 0 {
        text += &format!("{} in no triangle\n", count(facts.unused_vertices as u64, "vertex is", "vertices are"));
    }
    if facts.repeated != 0 {
        text += &format!("{} one before\n", count(facts.repeated as u64, "triangle repeats", "triangles repeat"));
    }
    text += &match facts.bounds {
        Some([low, high]) => format!("box {} to {}\n", point(low), point(high)),
        None => "no box: there is no triangle\n".to_owned(),
    };
    let mirror = if facts.has_mirror { "mirrors" } else { "no mirror" };
    text += &format!("{mirror}, {}\n\n", if facts.has_glass { "glass" } else { "no glass" });
    // List materials, memory and tree
    text += &materials(facts);
    text += &memory(facts);
    let tree = &facts.tree;
    text += &format!(
        "\nkd tree: {} on {}, {} ({} empty), {} ({:.1} a leaf, at most {}); expected cost of a ray {:.1}\n",
        count(tree.nodes as u64, "node", "nodes"),
        count(u64::from(tree.depth) + 1, "level", "levels"),
        count(tree.leaves as u64, "leaf", "leaves"),
        grouped(tree.empty_leaves as u64),
        count(tree.references as u64, "reference", "references"),
        tree.mean_triangles,
        grouped(tree.most_triangles as u64),
        tree.expected_cost,
    );
    // The first format is the word; the others are fraction bits.
    let formats: Vec<String> = facts.formats.0.iter().skip(1).map(|(name, bits)| format!("{name} {bits}")).collect();
    text += &format!("formats: word {}, fraction bits {}\n", facts.formats.0[0].1, formats.join(", "));
    // Steps are shorter than a power of two by the stretch: 2^-16 / 1.2500 = 1.221e-5.
    let precision = &facts.precision;
    let divided = if precision.stretch == 1.0 { String::new() } else { format!(" / {:.4}", precision.stretch) };
    text + &format!(
        "grid: steps of 2^{}{divided} = {:.3e}, the box's longest side is {} steps;\n\
         corners move by up to {:.3e}, {:.3e} of that side (rms {:.3e}, {:.3e} of it)\n\
         {} without area, and {} that lose it on the grid\n",
        (precision.step * precision.stretch).log2().round(),
        precision.step,
        grouped(precision.steps),
        precision.largest_move,
        precision.largest_share,
        precision.rms_move,
        precision.rms_share,
        count(precision.degenerate as u64, "triangle", "triangles"),
        count(precision.collapsed as u64, "triangle", "triangles"),
    )
}

fn point(point: [f64; 3]) -> String {
    let [x, y, z] = point.map(|x| format!("{}", (x * 1e6).round() / 1e6 + 0.0));
    format!("({x}, {y}, {z})")
}

fn materials(facts: &SceneInfo) -> String {
    if facts.materials.is_empty() {
        return String::new();
    }
    let mut rows = vec![row(["material", "colour", "ks", "kd", "kt", "index", "triangles"])];
    rows.extend(facts.materials.iter().take(MOST_LISTED).enumerate().map(|(number, material)| {
        let colour = material.colour.map(|component| format!("{component:.2}")).join(" ");
        let numbers = [material.reflection, material.intensity, material.transmission, material.index];
        let mut cells = vec![number.to_string(), colour];
        cells.extend(numbers.map(|number| format!("{number:.2}")));
        cells.push(grouped(material.triangles as u64));
        cells
    }));
    let more = facts.materials.len().saturating_sub(MOST_LISTED);
    let rest = if more == 0 { String::new() } else { format!("and {} more\n", grouped(more as u64)) };
    table(rows) + &rest + "\n"
}

fn memory(facts: &SceneInfo) -> String {
    let memory = &facts.memory;
    let mut rows = vec![row(["memory", "octets"])];
    rows.extend(memory.octets.0.iter().map(|(name, octets)| vec![(*name).to_owned(), grouped(*octets)]));
    rows.push(vec![format!("all ({})", memory.layout), grouped(memory.total as u64)]);
    table(rows) + &structures(facts)
}

/// Octets of one structure of each kind, with the bits of its fields where these are no words.
fn structures(facts: &SceneInfo) -> String {
    let one = |structure: &StructureInfo| {
        let fields = structure.bits.0.iter().map(|(name, bits)| format!("{name} {bits}"));
        vec![structure.name.to_owned(), grouped(structure.octets.into()), fields.collect::<Vec<_>>().join(", ")]
    };
    let mut rows = vec![row(["structure", "octets", "bits of an integer"])];
    rows.extend(facts.memory.structures.iter().map(one));
    format!("\n{}", table(rows))
}
