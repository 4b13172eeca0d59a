//! `lancer profiles`: what the sets of kernels take for the same pictures.

use clap::Args;
use kernels::KernelSet;

use super::bench::profile;
use super::invocation::{CommandSettings, scene_hashes};
use crate::arguments::{self, ArithmeticArguments, MachineKeyArguments, Size, TreeArguments};
use crate::failure::{Exit, Failure};
use crate::numeral::short;
use crate::profiles::{self, Profiles, Ratio};
use crate::result::WithSettings;
use crate::table::{row, table};
use crate::terminal::Terminal;
use crate::{input, result};

const EXAMPLES: &str = "\
Examples:
  lancer profiles
  lancer profiles cornell --machine wide32
  lancer profiles cornell --profiles report,buffered,prefetched --machine two_buffers
  lancer profiles cornell slabs --size 320x240 --json > profiles.json

Exit codes: 0 done, 1 errors in the input, 2 usage, 3 a kernel trapped.";

/// Sets the profiles of the kernels side by side: operations, octets, instructions, clocks, error.
///
/// Draws each scene with several sets of kernels, each in its own layout of memory, and divides the figures of each profile by those of the one
/// that it is compared with. Counts are those of the cores; operations are of all classes but moves; the search is what walks the kd tree
/// and intersects; the buffer is what the program takes of a core's, in octets.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ProfilesArguments {
    /// Scenes: .dsc or mesh files, or names of generated ones.
    #[arg(value_name = "SCENE", default_values = ["cornell", "sphereflake", "slabs", "mirrors", "terrain"])]
    scenes: Vec<String>,
    /// Size of the pictures in pixels.
    #[arg(long, value_name = "WxH", value_parser = arguments::size, default_value = "80x60")]
    size: Size,
    /// Sets of kernels.
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', value_parser = profile, default_value = "report,vector,ray,packet")]
    profiles: Vec<KernelSet>,
    #[command(flatten)]
    tree: TreeArguments,
    #[command(flatten)]
    machine: MachineKeyArguments,
    #[command(flatten)]
    arithmetic: ArithmeticArguments,
    /// Prints the results as JSON.
    #[arg(long)]
    json: bool,
}

/// Draws and prints.
pub(super) fn execute(
    arguments: &ProfilesArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    let machine = arguments.machine.machine(&arguments.arithmetic)?;
    let mut scenes = Vec::new();
    for name in &arguments.scenes {
        let loaded = input::scene(name, None, Some(arguments.size))?;
        terminal.show(&loaded.warnings);
        scenes.push(loaded.scene);
    }
    let bar = terminal.progress("pictures", (scenes.len() * arguments.profiles.len()) as u64);
    let profiles = profiles::measure(
        &scenes,
        &arguments.profiles,
        arguments.size,
        &arguments.tree.settings(),
        &(machine.name.clone(), machine.config.clone()),
        &|| bar.inc(1),
    );
    // The bar goes before anything else is written, and so before an error.
    bar.finish_and_clear();
    let profiles = profiles?;
    let settings = given.clone().with_machine(&machine).with_scenes(&scene_hashes(&arguments.scenes, &scenes));
    match arguments.json {
        true => terminal.print(&result::json(&WithSettings::new(&profiles, settings)))?,
        false => terminal.tell(&text(&profiles))?,
    }
    Ok(Exit::Done)
}

fn text(profiles: &Profiles) -> String {
    // Give the figures of each picture
    let mut pictures = vec![row([
        "scene",
        "profile",
        "instructions",
        "search",
        "operations",
        "octets",
        "clocks",
        "words",
        "buffer",
        "pixels off",
    ])];
    pictures.extend(profiles.pictures.iter().map(|picture| {
        vec![
            picture.scene.clone(),
            picture.profile.to_owned(),
            short(picture.instructions),
            short(picture.search_instructions),
            short(picture.operations),
            short(picture.octets),
            short(picture.clocks),
            short(picture.program_words as u64),
            short(picture.buffer_octets as u64),
            short(picture.off_pixels),
        ]
    }));
    // Divide them by those of the profile that each is compared with; a ratio without a scene is the mean of all
    let mut ratios = vec![row(["scene", "profile", "instructions", "search", "operations", "octets", "clocks"])];
    ratios.extend(profiles.ratios.iter().map(|ratio| {
        let Ratio { instructions, search_instructions, operations, octets, clocks, .. } = *ratio;
        let name =
            [ratio.scene.clone().unwrap_or_else(|| "mean".to_owned()), format!("{}/{}", ratio.profile, ratio.of)];
        let figures = [instructions, search_instructions, operations, octets, clocks];
        name.into_iter().chain(figures.map(|figure| format!("{figure:.2}"))).collect()
    }));
    let (width, height, machine) = (profiles.width, profiles.height, &profiles.machine);
    format!("{width} x {height} pixels on the machine {machine}\n\n{}\n{}", table(pictures), table(ratios))
}
