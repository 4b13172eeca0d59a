//! The shadow of a picture: piece by piece on all host threads, each piece a frame of its own.

use emu::machine::RunOptions;
use emu::shadow::{ShadowFrame, frame};
use kernels::build::{Build, Crop, KernelOptions};
use rayon::prelude::*;
use scenes::image::{MemoryImage, MemoryKind};
use scenes::layout::PIXEL;

use super::result::ShadowResult;
use super::totals::{OutputWeight, ShadowTotals, ShadowedNumber, SourcePrograms};
use crate::failure::Failure;
use crate::job::Job;
use crate::load::Load;

/// Rows of a piece. Shadows of a piece's pixels are in memory together, about 500 octets a component.
const ROWS: u32 = 8;

/// Components of a pixel.
const COLOURS: [&str; 3] = ["red", "green", "blue"];

/// Runs the picture of a job with shadows, and says what became of its pixels. `progress` is told of each pixel that is done.
///
/// # Errors
/// As a drawing: a scene that does not fit its formats, errors in the user's kernels, a trap.
pub fn picture(job: &Job, progress: &(dyn Fn() + Sync)) -> Result<ShadowResult, Failure> {
    let (load, mut image) = Load::picture(job)?;
    // The programs of pieces have tables of the scene in their buffers, which are read from the image.
    image.bytes = load.memory.octets().into_owned();
    let crop = job.crop();
    // An interpolated pixel needs its neighbours, so such a picture is one piece.
    let rows = if job.kernels.interpolate.is_some() { crop.height } else { ROWS };
    let starts: Vec<u32> = (crop.row..crop.row + crop.height).step_by(rows.max(1) as usize).collect();
    let pieces: Vec<Result<ShadowTotals, Failure>> = starts
        .into_par_iter()
        .map(|row| {
            let height = rows.min(crop.row + crop.height - row);
            piece(job, &load, &image, Crop { row, height, ..crop }, progress)
        })
        .collect();
    let mut totals = ShadowTotals::default();
    for piece in pieces {
        totals.merge(piece?);
    }
    // Lines and sources are those of every piece: pieces differ in constants alone.
    let core = sites(&load, job, &load.build.cores, 0);
    let main = sites(&load, job, &load.build.main, core.sites.sites.len() as u32);
    let programs = SourcePrograms { core: (&load.build.cores, &core), main: Some((&load.build.main, &main)) };
    Ok(totals.result(&programs))
}

fn sites(load: &Load, job: &Job, program: &isa::Program, first: u32) -> emu::shadow::ShadowProgram {
    let code = emu::code::Code::new(program, &load.isa, job.machine.timing());
    emu::shadow::ShadowProgram::new(&code, job.machine.arithmetic.modes(), first)
}

/// A part of the picture.
fn piece(
    job: &Job,
    load: &Load,
    image: &MemoryImage,
    crop: Crop,
    progress: &(dyn Fn() + Sync),
) -> Result<ShadowTotals, Failure> {
    let options = KernelOptions { crop: Some(crop), ..job.kernels.clone() };
    let build = kernels::build(&job.scene, &job.view, image, &load.isa, &options)?;
    let piece = Load { build, ..load.clone() };
    let setup = piece.setup(&job.machine, RunOptions::default());
    let frame = frame::run(&setup, piece.memory.clone(), &mut |_| progress())?;
    Ok(totals(&frame, &piece.build, image, crop))
}

/// Errors of the lines of a frame and of its pixels.
fn totals(frame: &ShadowFrame, build: &Build, image: &MemoryImage, crop: Crop) -> ShadowTotals {
    let programs = SourcePrograms { core: (&build.cores, &frame.core), main: Some((&build.main, &frame.main)) };
    let mut totals = ShadowTotals::default();
    totals.add_ledger(&programs, &frame.core, &frame.ledger);
    totals.add_ledger(&programs, &frame.main, &frame.main_ledger);
    let start = image.region(MemoryKind::Frame).start;
    let octets = PIXEL.octets();
    for pixel in 0..crop.width * crop.height {
        for (k, colour) in (0u32..).zip(COLOURS) {
            let address = start + pixel * octets + 4 * k;
            let raw = frame.memory.word(address).unwrap_or(0);
            let number = ShadowedNumber {
                scale: Some(image.formats.colour as i32),
                raw: raw.into(),
                shadow: frame.numbers.get(address, 4),
            };
            let (column, row) = (crop.column + pixel % crop.width, crop.row + pixel / crop.width);
            let name = || format!("pixel {column},{row} {colour}");
            totals.add_output(&programs, name, number, OutputWeight::Units);
        }
    }
    totals
}
