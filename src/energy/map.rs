//! Energy of each pixel: the work items of a picture, run once more one by one, by the first table that the machine names.

use emu::code::Code;
use emu::machine::RunOptions;
use emu::machine::config::formula::Dimension;
use emu::weigh::{PassWeights, weigh};
use messages::Diagnostic;

use super::activity::of_pass;
use super::price::Pricing;
use crate::failure::Failure;
use crate::job::Job;
use crate::load::Load;

/// Attojoules of each pixel of the drawn part, row 0 first: the instructions of its work item and the octets that they ask for. Interpolated
/// pixels have none. Work of the main processor and savings of caches belong to no pixel.
///
/// # Errors
/// A picture that cannot be built, or whose pixels depend on the time at which they are drawn.
pub fn pixels(job: &Job) -> Result<Vec<u64>, Failure> {
    let (load, _) = Load::picture(job)?;
    let (config, word) = (&job.machine, job.machine.arithmetic.word);
    let code = Code::new(&load.build.cores, &load.isa, config.timing());
    let prices = Pricing::all(config, Dimension::Energy).first().map(Pricing::prices);
    // Price each pass of the program once
    let mut weights = PassWeights::default();
    for number in 0..code.passes().len() {
        let (once, each) = of_pass(&load.isa, &code.pass_rows(number), word);
        let price = |activity| prices.as_ref().map_or(0, |prices| prices.energy(activity));
        weights.passes.push(u64::try_from(price(&once)).unwrap_or(u64::MAX));
        weights.units.push(u64::try_from(price(&each)).unwrap_or(u64::MAX));
    }
    let setup = load.setup(config, RunOptions { engine: job.engine, ..RunOptions::default() });
    let items = weigh(&setup, &load.memory, &weights)?.map_err(|reason| {
        let message = Diagnostic::error(format!("the energy of single pixels is not known, because {reason}"));
        Failure::from(message.hint("the energy of the whole picture is: --energy"))
    })?;
    let crop = load.build.crop;
    let mut pixels = vec![0_u64; crop.width as usize * crop.height as usize];
    for item in items {
        // The first component of a work item's message is the number of its pixel.
        if let Some(pixel) = usize::try_from(item.subject[0]).ok().and_then(|at| pixels.get_mut(at)) {
            *pixel = pixel.saturating_add(item.weight);
        }
    }
    Ok(pixels)
}
