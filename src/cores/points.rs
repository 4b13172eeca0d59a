//! A picture on several machines with several numbers of cores, as a study: machines and numbers of cores are its factors.

use emu::machine::RunOutcome;
use messages::Report;
use serde_json::json;

use super::{CoresResult, Curve, curve, no_machine, numbers, result};
use crate::failure::Failure;
use crate::job::result_name;
use crate::settings::{MachineSettings, Settings};
use crate::sweep::contents::Contents;
use crate::sweep::group;
use crate::sweep::recordings::RecordingStore;
use crate::sweep::study::{Assignments, Study};

/// The study of a picture on machines, each with one core and with each of the numbers of cores, the fewest first.
pub fn study(name: &str, base: &Settings, machines: &[MachineSettings], cores: &[u32]) -> Study {
    let machine = |machine: &MachineSettings| vec![("machine".to_owned(), machine.brief())];
    let machines: Vec<Assignments> = machines.iter().map(machine).collect();
    let cores = numbers(cores).into_iter().map(|cores| vec![("machine.cores".to_owned(), json!(cores))]);
    Study { name: name.to_owned(), base: base.value(), factors: vec![machines, cores.collect()] }
}

/// Draws the points of a [`study`], with the contents of files and the recordings that are kept. `warn` is told of likely mistakes in the user's
/// kernels, `progress` of pixels as far as somebody waits for those of a large picture.
///
/// # Errors
/// Files that cannot be read, a machine out of its ranges, a scene that does not fit its formats, a trap.
pub fn drawn(
    study: &Study,
    (contents, store): (&Contents, Option<&RecordingStore>),
    warn: &mut dyn FnMut(&Report),
    progress: &mut dyn FnMut(u64),
) -> Result<CoresResult, Failure> {
    let points = (0..study.count()).map(|number| study.settings(number, contents));
    let points = points.collect::<Result<Vec<Settings>, _>>()?;
    let each = study.factors[1].len();
    let mut curves: Vec<(usize, Curve)> = Vec::new();
    let mut picture = None;
    for group in group::by_recording(&points) {
        let alike: Vec<&Settings> = group.iter().map(|&point| &points[point]).collect();
        let (job, drawn) = group::draw(&alike, contents, store, progress)?;
        let drawn = drawn?;
        warn(&drawn.load.build.warnings);
        let frames = drawn.frames.into_iter().collect::<Result<Vec<RunOutcome>, _>>()?;
        // Numbers of cores share a recording, so a group has all of its machines: with 3 numbers, points 0 to 2 are those of machine 0.
        for (alike, frames) in group.chunks(each).zip(frames.chunks(each)) {
            let machine = &points[alike[0]].machine;
            let frames: Vec<(u32, &RunOutcome)> =
                alike.iter().map(|&point| points[point].machine.config.cores).zip(frames).collect();
            curves.push((alike[0], curve(machine, &drawn.load, &frames)));
        }
        picture.get_or_insert((result_name(&job.scene), frames[0].item_count));
    }
    let (scene, pixels) = picture.ok_or_else(no_machine)?;
    curves.sort_by_key(|(first, _)| *first);
    Ok(result(&scene, pixels, curves.into_iter().map(|(_, curve)| curve).collect()))
}
