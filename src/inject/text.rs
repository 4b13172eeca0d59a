//! A campaign as people read it.

use std::fmt::Display;

use super::result::{GroupShare, InjectResult, KindVulnerability};
use super::row::{InjectionClass, InjectionRow};
use super::statistics::ShareInterval;
use crate::numeral::grouped;
use crate::table::{row, table};

/// Functions of a structure that are shown, those with the most harmful injections first.
const FUNCTIONS: usize = 5;

fn percent(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}

fn interval(share: &ShareInterval) -> String {
    format!("{} ({:.2} to {:.2})", percent(share.share), 100.0 * share.low, 100.0 * share.high)
}

/// The tables of a campaign.
pub fn text(result: &InjectResult) -> String {
    let InjectResult { scene, width, height, profile, layout, seed, bits, pattern, golden, limits, .. } = result;
    let flips = if *bits == 1 { "one bit".to_owned() } else { format!("{bits} {pattern} bits") };
    let mut text = format!(
        "{scene}: {width} x {height} pixels, profile {profile}, layout {layout}, {flips} at a time, seed {seed}\n\
         {} work items of {} instructions; one hangs after {} steps, the main processor after {}\n\n",
        grouped(golden.items),
        grouped(golden.steps),
        grouped(limits.item_steps),
        grouped(limits.main_steps)
    );
    text += &classes(&result.kinds);
    // Where nothing does harm, no structure is more vulnerable than another.
    if result.kinds.iter().any(|kind| kind.vulnerability.share > 0.0) {
        text += &format!("\nMost vulnerable: {}\n", result.most_vulnerable.join(", "));
    }
    text += &harm(&result.kinds);
    text += &functions(&result.kinds);
    text += &formats(&result.kinds);
    text += &left_unprotected(result);
    text += &protections(&result.kinds);
    text
}

fn classes(kinds: &[KindVulnerability]) -> String {
    // Classes that protections make are shown where there are protections.
    let is_there = |class: &InjectionClass| {
        !matches!(class, InjectionClass::Corrected | InjectionClass::Detected)
            || kinds.iter().flat_map(|kind| &kind.classes).any(|one| one.class == *class && one.count != 0)
    };
    let shown: Vec<InjectionClass> = InjectionClass::ALL.into_iter().filter(is_there).collect();
    let mut head = row(["structure", "protection", "injections"]);
    head.extend(shown.iter().map(|class| class.name().replace('_', " ")));
    head.push("vulnerability (95 %)".to_owned());
    let mut rows = vec![head];
    for kind in kinds {
        let mut cells = vec![kind.kind.clone(), kind.protection.to_owned(), grouped(kind.injections)];
        let counts = kind.classes.iter().filter(|one| shown.contains(&one.class));
        cells.extend(counts.map(|one| grouped(one.count)));
        cells.push(interval(&kind.vulnerability));
        rows.push(cells);
    }
    table(rows)
}

fn harm(kinds: &[KindVulnerability]) -> String {
    let mut rows =
        vec![row(["structure", "wrong by < 1/255", "by more", "median", "largest", "traps", "hangs, most steps"])];
    for kind in kinds.iter().filter(|kind| kind.vulnerability.share > 0.0) {
        let traps: Vec<String> =
            kind.traps.iter().map(|trap| format!("{} {}", trap.fault.replace('_', " "), grouped(trap.count))).collect();
        let hangs: Vec<String> = kind
            .hangs
            .iter()
            .map(|hang| {
                let (count, most) = (grouped(hang.count), grouped(hang.most_steps));
                format!("{} {count}, {most}", hang.limit.replace('_', " "))
            })
            .collect();
        let or_none = |list: Vec<String>| if list.is_empty() { "none".to_owned() } else { list.join("; ") };
        rows.push(vec![
            kind.kind.clone(),
            grouped(kind.pixels.within_step),
            grouped(kind.pixels.beyond_step),
            format!("{:.6}", kind.pixels.median_difference),
            format!("{:.6}", kind.pixels.largest_difference),
            or_none(traps),
            or_none(hangs),
        ]);
    }
    if rows.len() == 1 { String::new() } else { format!("\n{}", table(rows)) }
}

/// Groups of all structures as one table; nothing where there are none.
fn groups(what: &str, kinds: &[KindVulnerability], of: impl Fn(&KindVulnerability) -> Vec<GroupShare>) -> String {
    let mut rows = vec![row(["structure", what, "injections", "harmful", "beyond 1/255", "share (95 %)"])];
    for kind in kinds {
        rows.extend(of(kind).into_iter().map(|group| {
            vec![
                kind.kind.clone(),
                group.name,
                grouped(group.injections),
                grouped(group.harmful),
                grouped(group.beyond_step),
                interval(&group.share),
            ]
        }));
    }
    if rows.len() == 1 { String::new() } else { format!("\n{}", table(rows)) }
}

fn functions(kinds: &[KindVulnerability]) -> String {
    groups("function", kinds, |kind| {
        let mut groups = kind.by_function.clone();
        groups.sort_by(|a, b| b.harmful.cmp(&a.harmful).then(a.name.cmp(&b.name)));
        groups.truncate(FUNCTIONS);
        groups
    })
}

fn formats(kinds: &[KindVulnerability]) -> String {
    groups("part", kinds, |kind| kind.by_structure.clone())
        + &groups("format or field", kinds, |kind| kind.by_format.clone())
}

fn left_unprotected(result: &InjectResult) -> String {
    if result.unprotected.is_empty() {
        return String::new();
    }
    let head = [
        "structure",
        "format or field",
        "lowest bits",
        "injections",
        "beyond 1/255 at most (95 %)",
        "weakest bit at most (95 %)",
    ];
    let mut rows = vec![row(head)];
    rows.extend(result.unprotected.iter().map(|one| {
        let bits = if one.bits == 1 { "0".to_owned() } else { format!("0 to {}", one.bits - 1) };
        let highs = [percent(one.high), percent(one.weakest_high)];
        [one.kind.clone(), one.format.clone(), bits, grouped(one.injections)].into_iter().chain(highs).collect()
    }));
    format!("\nBits that may be left unprotected for a picture within 1/255:\n{}", table(rows))
}

/// Cost in addition, as `+5` or `-5`; a dash where it is not known.
fn more(cost: Option<impl Display>) -> String {
    cost.map_or_else(|| "-".to_owned(), |cost| format!("+{cost}").replace("+-", "-"))
}

fn protections(kinds: &[KindVulnerability]) -> String {
    let head = [
        "structure",
        "protection",
        "corrects",
        "finds",
        "passes",
        "unknown",
        "left (95 %)",
        "clocks",
        "octets",
        "bits",
        "nJ",
    ];
    let mut rows = vec![row(head)];
    for kind in kinds {
        for effect in &kind.protections {
            let cost = &effect.cost;
            rows.push(vec![
                kind.kind.clone(),
                effect.protection.to_owned(),
                grouped(effect.corrected),
                grouped(effect.detected),
                grouped(effect.passed),
                grouped(effect.unknown),
                interval(&effect.left),
                // What rounds to nothing has no sign.
                more(cost.clocks_share.map(|share| percent((share * 1e4).round() / 1e4 + 0.0))),
                more(cost.octets.map(grouped)),
                more(cost.storage_bits.map(grouped)),
                more(cost.energy_nj),
            ]);
        }
    }
    if rows.len() == 1 {
        return String::new();
    }
    format!("\nHarmful injections under protections, and what those cost a frame:\n{}", table(rows))
}

/// One injection, line by line.
pub fn one(injection: &InjectionRow) -> String {
    let bits: Vec<String> = injection.bits.iter().map(u32::to_string).collect();
    let format_bits: Vec<String> = injection.format_bits.iter().map(u32::to_string).collect();
    let or_dash = |text: &Option<String>| text.clone().unwrap_or_else(|| "-".to_owned());
    let mut lines = vec![
        format!("injection   {} {}", injection.kind, injection.number),
        format!("class       {}", injection.class.name().replace('_', " ")),
        format!(
            "work item   {}, pixel {}",
            injection.item,
            injection.pixel.map_or("-".to_owned(), |at| at.to_string())
        ),
        format!("moment      {}", grouped(injection.moment)),
        format!("place       {}, {}", injection.structure.replace('_', " "), injection.place),
        format!("bits        {}", bits.join(", ")),
        format!("function    {}", or_dash(&injection.function)),
        format!("format      {}", or_dash(&injection.format)),
    ];
    // Add what only some injections have: bits of a format, wrong pixels, a trap, a hang
    if !format_bits.is_empty() {
        lines.push(format!("its bits    {}", format_bits.join(", ")));
    }
    if injection.wrong_pixels != 0 {
        lines.push(format!(
            "picture     {} wrong pixels, the worst by {:.6}",
            grouped(injection.wrong_pixels),
            injection.largest_difference
        ));
    }
    if let (Some(trap), Some(at)) = (&injection.trap, &injection.trap_at) {
        lines.push(format!("trap        {}, {at}", trap.replace('_', " ")));
    }
    if let (Some(limit), Some(steps)) = (&injection.limit, injection.steps) {
        lines.push(format!("hang        found by {} after {} steps", limit.replace('_', " "), grouped(steps)));
    }
    lines.join("\n") + "\n"
}
