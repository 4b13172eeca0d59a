//! Variants as people read them, and as comma-separated values.

use std::fmt::Write;

use super::{AccuracyStudy, CostAxis, ErrorAxis, MeasuredVariant, OverallVariant, RefusedVariant};
use crate::numeral::{count, short};
use crate::table::{row, table};

/// A table a scene, one over all scenes where there are several, what scenes do not fit, and what was run for it.
pub fn text(
    study: &AccuracyStudy,
    overall: &[OverallVariant],
    (width, height): (u32, u32),
    (cost, error): (CostAxis, ErrorAxis),
    has_energy: bool,
) -> String {
    let mut text = String::new();
    let shifts = study.measured.first().map_or(1, |one| one.shifts.len());
    let places = if shifts > 1 { format!(", {shifts} places of the samples") } else { String::new() };
    for scene in study.measured.chunk_by(|one, other| one.scene == other.scene) {
        let _ = writeln!(
            text,
            "{}, {width} x {height} pixels{places}; clocks and octets a pixel, * on the front",
            scene[0].scene
        );
        text += &scene_table(scene, shifts, (cost, error), has_energy);
        text.push('\n');
    }
    if !overall.is_empty() {
        let _ = writeln!(
            text,
            "all scenes: {} and {}; m on the front of means, w on that of the worst",
            cost.name(),
            error.name()
        );
        text += &overall_table(overall, cost, error);
        text.push('\n');
    }
    // Variants that a scene does not fit come last.
    for RefusedVariant { scene, variant, reason } in &study.refused {
        let _ = writeln!(text, "{scene}, {variant}: {reason}");
    }
    let stepped = match study.stepped {
        0 => String::new(),
        stepped => format!(", {} stepped", count(stepped, "frame", "frames")),
    };
    let recordings = count(study.recordings, "recording", "recordings");
    let _ = writeln!(text, "{recordings}, {}{stepped}", count(study.replays, "replay", "replays"));
    text
}

fn decibels(psnr: Option<f64>) -> String {
    psnr.map_or_else(|| "-".into(), |psnr| format!("{psnr:.1}"))
}

/// A cost with three significant digits, or as whole numbers are told.
fn costs(cost: f64) -> String {
    if cost >= 100.0 { short(cost.round() as u64) } else { format!("{cost:.3e}") }
}

fn scene_table(
    scene: &[MeasuredVariant],
    shifts: usize,
    (cost, error): (CostAxis, ErrorAxis),
    has_energy: bool,
) -> String {
    // Pixels that changed sides come first: a single one moves a ratio by tens of dB.
    let off: &[&str] = if shifts > 1 { &["off, mean", "off, worst"] } else { &["off"] };
    let is_shown = |axis: CostAxis| cost == axis;
    let mut head = vec!["variant", "clocks", "octets"];
    head.extend(is_shown(CostAxis::Seconds).then_some("seconds"));
    head.extend((has_energy || is_shown(CostAxis::Nj)).then_some("nJ"));
    head.extend(is_shown(CostAxis::Area).then_some("um2"));
    head.extend(is_shown(CostAxis::Host).then_some("host ns"));
    head.extend(off);
    head.extend((error == ErrorAxis::Largest).then_some("largest"));
    head.extend(["others", "PSNR", "SSIM", "stored", "wrong/M", "t p99", "u p99", "v p99", "N p99", "dominated by"]);
    let mut rows = vec![head.into_iter().map(str::to_owned).collect::<Vec<_>>()];
    for one in scene {
        let ulp = |error: Option<f64>| error.map_or_else(|| "-".into(), |error| format!("{error:.2}"));
        let mut cells = vec![
            format!("{}{}", if one.is_on_front { "* " } else { "  " }, one.variant),
            short(one.clocks.round() as u64),
            short(one.octets.round() as u64),
        ];
        cells.extend(is_shown(CostAxis::Seconds).then(|| format!("{:.3e}", one.seconds)));
        cells.extend((has_energy || is_shown(CostAxis::Nj)).then(|| one.energy.pixel_nj.to_string()));
        cells.extend(is_shown(CostAxis::Area).then(|| one.energy.area_um2.to_string()));
        cells.extend(is_shown(CostAxis::Host).then(|| one.host_nanoseconds.map_or_else(String::new, costs)));
        match shifts > 1 {
            true => cells.extend([format!("{:.2}", one.off.mean), short(one.off.worst as u64)]),
            false => cells.push(short(one.error.off_pixels)),
        }
        cells.extend((error == ErrorAxis::Largest).then(|| format!("{:.2e}", one.error.max)));
        cells.extend([
            decibels(one.error.psnr_others_db),
            decibels(one.error.psnr_db),
            one.ssim.map_or_else(|| "-".into(), |ssim| format!("{ssim:.4}")),
            decibels(one.stored_error.psnr_db),
            format!("{:.0}", one.rays.misclassified_per_million),
            ulp(one.rays.t_p99),
            ulp(one.rays.u_p99),
            ulp(one.rays.v_p99),
            ulp(one.rays.normal_p99),
            one.dominated_by.clone().unwrap_or_default(),
        ]);
        rows.push(cells);
    }
    table(rows)
}

fn overall_table(overall: &[OverallVariant], cost: CostAxis, error: ErrorAxis) -> String {
    let mut rows = vec![row([
        "variant",
        "cost, mean",
        "cost, worst",
        "off, mean",
        "off, worst",
        "error, mean",
        "error, worst",
        "dominated by",
    ])];
    // Write numbers with as many digits as their axes need
    let costs = |one: f64| if cost == CostAxis::Seconds { format!("{one:.3e}") } else { costs(one) };
    let errors = |one: f64| match error {
        ErrorAxis::Psnr | ErrorAxis::Others => format!("{one:.1}"),
        ErrorAxis::Off => format!("{one:.2}"),
        ErrorAxis::Largest => format!("{one:.2e}"),
        ErrorAxis::Ssim => format!("{one:.4}"),
    };
    for one in overall {
        // Front of the variant: `mw` is on both, ` w` on that of the worst scenes alone.
        let mark = |by: &Option<String>, mark: &'static str| if by.is_none() { mark } else { " " };
        let marks = format!("{}{}", mark(&one.mean_dominated_by, "m"), mark(&one.worst_dominated_by, "w"));
        rows.push(vec![
            format!("{marks} {}", one.variant),
            costs(one.cost.mean),
            costs(one.cost.worst),
            format!("{:.2}", one.off.mean),
            short(one.off.worst as u64),
            errors(one.error.mean),
            errors(one.error.worst),
            one.mean_dominated_by.clone().unwrap_or_default(),
        ]);
    }
    table(rows)
}

/// The data of a chart, a row a variant.
pub fn csv(measured: &[MeasuredVariant]) -> String {
    let mut text = String::from(
        "scene,variant,profile,word,rounding,layout,bounces,cutoff,interpolate,clocks,instructions,octets,rmse,psnr_db,max,off_pixels,ssim,stored_psnr_db,\
         stored_off_pixels,misclassified_per_million,t_p99,t_max,u_p99,u_max,v_p99,v_max,normal_p99,normal_max,host_nanoseconds,dominated_by,pixel_nj_least,pixel_nj_most,\
         energy_delay_js_least,energy_delay_js_most,area_um2_least,area_um2_most,machine,cores,arbiter,seconds,psnr_others_db,shifts,off_mean,off_worst,psnr_db_least,\
         psnr_db_most,psnr_others_db_least,psnr_others_db_most\n",
    );
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    // Names may hold commas; RFC 4180 doubles the quotes inside.
    let quoted = |name: &str| format!("\"{}\"", name.replace('"', "\"\""));
    for one in measured {
        // A picture without a ratio is no worse than any other.
        let ends = |part: fn(&super::ShiftError) -> Option<f64>| {
            let all = || one.shifts.iter().map(part);
            let most = if all().all(|psnr| psnr.is_some()) { all().flatten().reduce(f64::max) } else { None };
            [number(all().flatten().reduce(f64::min)), number(most)]
        };
        let mut cells = vec![
            quoted(&one.scene),
            quoted(&one.variant),
            one.profile.to_owned(),
            one.word.to_string(),
            one.rounding.to_owned(),
            one.layout.to_owned(),
            one.bounces.to_string(),
            one.cutoff.to_string(),
            number(one.interpolate),
            one.clocks.to_string(),
            one.instructions.to_string(),
            one.octets.to_string(),
            one.error.rmse.to_string(),
            number(one.error.psnr_db),
            one.error.max.to_string(),
            one.error.off_pixels.to_string(),
            number(one.ssim),
            number(one.stored_error.psnr_db),
            one.stored_error.off_pixels.to_string(),
            one.rays.misclassified_per_million.to_string(),
            number(one.rays.t_p99),
            number(one.rays.t_max),
            number(one.rays.u_p99),
            number(one.rays.u_max),
            number(one.rays.v_p99),
            number(one.rays.v_max),
            number(one.rays.normal_p99),
            number(one.rays.normal_max),
            number(one.host_nanoseconds),
            quoted(one.dominated_by.as_deref().unwrap_or("")),
        ];
        let energy = &one.energy;
        let ranges = [energy.pixel_nj, energy.energy_delay_js, energy.area_um2];
        cells.extend(ranges.iter().flat_map(|range| [range.least.to_string(), range.most.to_string()]));
        cells.extend([
            quoted(&one.machine),
            one.cores.to_string(),
            one.arbiter.to_owned(),
            one.seconds.to_string(),
            number(one.error.psnr_others_db),
            one.shifts.len().to_string(),
            one.off.mean.to_string(),
            one.off.worst.to_string(),
        ]);
        cells.extend(ends(|shift| shift.error.psnr_db));
        cells.extend(ends(|shift| shift.error.psnr_others_db));
        text += &(cells.join(",") + "\n");
    }
    text
}
