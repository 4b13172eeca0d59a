//! The pictures of all shifts of a variant as one result.

use std::sync::Arc;
use std::time::Duration;

use isa::Counts;
use scenes::metrics::PictureError;

use super::{MeanAndWorst, MeasuredVariant, RayErrors, ShiftError, Variant};
use crate::energy::{EnergySummary, FigureRange, UNDECIDED};
use crate::result::{ByClass, FormatTable};
use crate::settings::Settings;

/// Figures of a picture that are the same on all machines that share its recording.
#[derive(Clone, Debug)]
pub struct PictureFigures {
    pub error: PictureError,
    pub ssim: Option<f64>,
    pub stored_error: PictureError,
    pub rays: RayErrors,
    pub formats: FormatTable,
}

/// Figures of a variant's picture at one shift.
#[derive(Clone, Debug)]
pub struct ShiftFigures {
    pub shift: [f64; 2],
    pub picture: Arc<PictureFigures>,
    pub pixels: u64,
    pub clocks: u64,
    pub seconds: f64,
    pub octets: u64,
    pub instructions: u64,
    pub operations: Counts,
    pub energy: EnergySummary,
    pub host: Option<Duration>,
    pub is_replayed: bool,
}

/// A variant's result from its pictures, one a shift, all of one size; `None` without any.
pub fn pooled(number: usize, scene: &str, variant: &Variant, shifts: &[ShiftFigures]) -> Option<MeasuredVariant> {
    let first = shifts.first()?;
    let Settings { kernels, effort, machine, .. } = &variant.settings;
    let arithmetic = &machine.config.arithmetic;
    // Costs are those of a pixel: 960,000 and 970,000 clocks for 4,800 pixels each come to 1,930,000 / 9,600 = 201.0.
    let pixels = shifts.iter().map(|one| one.pixels).sum::<u64>().max(1) as f64;
    let each = |part: fn(&ShiftFigures) -> u64| shifts.iter().map(part).sum::<u64>() as f64 / pixels;
    let errors = |part: fn(&PictureFigures) -> &PictureError| {
        error_of(&shifts.iter().map(|one| (*part(&one.picture), one.pixels)).collect::<Vec<_>>())
    };
    let ssims: Vec<f64> = shifts.iter().filter_map(|one| one.picture.ssim).collect();
    let mut operations = Counts::default();
    shifts.iter().for_each(|one| operations += one.operations);
    let off: Vec<f64> = shifts.iter().map(|one| one.picture.error.off_pixels as f64).collect();
    let hosts: Option<Vec<Duration>> = shifts.iter().map(|one| one.host).collect();
    Some(MeasuredVariant {
        number,
        kind: variant.kind(),
        scene: scene.to_owned(),
        variant: variant.to_string(),
        profile: kernels.profile.name(),
        word: arithmetic.word,
        rounding: arithmetic.quantization.name(),
        layout: variant.layout().name(),
        bounces: effort.bounces,
        cutoff: effort.weight_cutoff,
        interpolate: effort.interpolate,
        machine: machine.name.clone(),
        cores: machine.config.cores,
        arbiter: machine.config.bus.arbiter.name(),
        formats: first.picture.formats.clone(),
        off: MeanAndWorst::of(&off),
        error: errors(|picture| &picture.error),
        ssim: (!ssims.is_empty()).then(|| ssims.iter().sum::<f64>() / ssims.len() as f64),
        shifts: shifts
            .iter()
            .map(|one| ShiftError { shift: one.shift, error: one.picture.error, ssim: one.picture.ssim })
            .collect(),
        stored_error: errors(|picture| &picture.stored_error),
        rays: RayErrors::worst(shifts.iter().map(|one| &one.picture.rays)),
        clocks: each(|one| one.clocks),
        seconds: shifts.iter().map(|one| one.seconds).sum::<f64>() / pixels,
        operations: ByClass(operations),
        instructions: each(|one| one.instructions),
        octets: each(|one| one.octets),
        energy: energy_of(shifts),
        host_nanoseconds: hosts.map(|hosts| hosts.iter().sum::<Duration>().as_nanos() as f64 / pixels),
        method: if shifts.iter().all(|one| one.is_replayed) { "replayed" } else { "stepped" },
        // Fronts are drawn later, when all variants of the scene are there.
        is_on_front: false,
        dominated_by: None,
    })
}

/// Error of some pictures, each with its pixels, as if they were one.
fn error_of(pictures: &[(PictureError, u64)]) -> PictureError {
    if let [(error, _)] = pictures {
        return *error;
    }
    let pixels: u64 = pictures.iter().map(|(_, pixels)| pixels).sum();
    let off: u64 = pictures.iter().map(|(error, _)| error.off_pixels).sum();
    // Mean squares, each as often as it has pixels.
    let mean = |square: f64, pixels: u64| if pixels == 0 { 0.0 } else { square / pixels as f64 };
    let square = pictures.iter().map(|(error, pixels)| error.rmse * error.rmse * *pixels as f64).sum::<f64>();
    let others = pictures.iter().filter_map(|(error, pixels)| {
        error.psnr_others_db.map(|psnr| 10f64.powf(-psnr / 10.0) * (pixels - error.off_pixels) as f64)
    });
    let psnr = |square: f64| (square > 0.0).then(|| -10.0 * square.log10());
    let (square, others) = (mean(square, pixels), mean(others.sum(), pixels - off));
    PictureError {
        rmse: square.sqrt(),
        psnr_db: psnr(square),
        max: pictures.iter().map(|(error, _)| error.max).fold(0.0, f64::max),
        off_pixels: off,
        off_per_million: mean(off as f64 * 1e6, pixels),
        psnr_others_db: psnr(others),
    }
}

/// Means of the energies of all shifts; the area is that of each.
fn energy_of(shifts: &[ShiftFigures]) -> EnergySummary {
    let all = || shifts.iter().map(|one| &one.energy);
    let Some(first) = all().next().filter(|_| shifts.len() == 1) else {
        let count = shifts.len().max(1) as f64;
        let mean = |part: fn(&EnergySummary) -> FigureRange| FigureRange {
            least: all().map(|energy| part(energy).least).sum::<f64>() / count,
            most: all().map(|energy| part(energy).most).sum::<f64>() / count,
        };
        let decides = shifts.first().map_or("", |first| first.energy.decides);
        return EnergySummary {
            frame_nj: mean(|energy| energy.frame_nj),
            pixel_nj: mean(|energy| energy.pixel_nj),
            energy_delay_js: mean(|energy| energy.energy_delay_js),
            area_um2: mean(|energy| energy.area_um2),
            decides: if all().all(|energy| energy.decides == decides) { decides } else { UNDECIDED },
        };
    };
    first.clone()
}

#[cfg(test)]
mod tests {
    use scenes::metrics;
    use scenes::model::Picture;

    use super::*;

    #[test]
    fn pooled_errors_are_those_of_the_pictures_side_by_side() {
        let grey = |values: &[f64]| Picture {
            size: (values.len() as u32, 1),
            pixels: values.iter().map(|&value| [value; 3]).collect(),
        };
        // One picture has a pixel off, one little differences, one none.
        let pairs: [([f64; 4], [f64; 4]); 3] = [
            ([0.1, 0.2, 0.3, 0.4], [0.1, 0.9, 0.3, 0.401]),
            ([0.5, 0.6, 0.7, 0.8], [0.5001, 0.6, 0.7002, 0.8]),
            ([1.0; 4], [1.0; 4]),
        ];
        let errors = pairs.map(|(a, b)| (metrics::compare(&grey(&a), &grey(&b)).unwrap(), 4));
        let side_by_side = pairs.iter().fold((Vec::new(), Vec::new()), |(a, b), pair| {
            ([a, pair.0.to_vec()].concat(), [b, pair.1.to_vec()].concat())
        });
        let expected = metrics::compare(&grey(&side_by_side.0), &grey(&side_by_side.1)).unwrap();
        let pooled = error_of(&errors);
        assert_eq!((pooled.off_pixels, pooled.max), (expected.off_pixels, expected.max));
        for (pooled, expected) in [
            (pooled.rmse, expected.rmse),
            (pooled.psnr_db.unwrap(), expected.psnr_db.unwrap()),
            (pooled.psnr_others_db.unwrap(), expected.psnr_others_db.unwrap()),
            (pooled.off_per_million, expected.off_per_million),
        ] {
            assert!((pooled / expected - 1.0).abs() < 1e-12, "{pooled} {expected}");
        }
        assert_eq!(error_of(&errors[..1]), errors[0].0);
    }
}
