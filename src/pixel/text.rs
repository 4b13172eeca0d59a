//! Explanation of a pixel as text: the ray tree drawn as a tree, at most 80 columns wide, with double precision below each number of the machine.

use std::fmt::Write;

use scenes::vector::largest;

use super::compared::{ComparedNumber, ComparedVector};
use super::result::{ExplainedHit, ExplainedLight, ExplainedRay, PixelExplanation};
use crate::numeral::{count, grouped};

/// Levels that are drawn further to the right; deeper rays stay there and say their level.
const DEEPEST: u32 = 5;

/// Columns of a number.
const NUMBER: usize = 14;

/// A line of figures: its name, the machine's, those of double precision, and the largest difference.
struct ComparedLine<'a> {
    name: &'a str,
    value: Option<Vec<f64>>,
    reference: Option<Vec<f64>>,
    difference: Option<f64>,
}

impl<'a> ComparedLine<'a> {
    fn one(name: &'a str, number: &ComparedNumber) -> ComparedLine<'a> {
        let list = |value: Option<f64>| value.map(|value| vec![value]);
        let (value, reference) = (list(number.value), list(number.reference));
        ComparedLine { name, value, reference, difference: number.difference.map(f64::abs) }
    }

    fn three(name: &'a str, vector: &ComparedVector) -> ComparedLine<'a> {
        let list = |value: Option<[f64; 3]>| value.map(|value| value.to_vec());
        ComparedLine {
            name,
            value: list(vector.value),
            reference: list(vector.reference),
            difference: vector.difference.map(largest),
        }
    }

    /// Both lines, behind a margin.
    fn write(&self, text: &mut String, margin: &str) {
        let list = |values: &Option<Vec<f64>>| match values {
            Some(values) => values.iter().map(|&value| format!("{:>NUMBER$}", number(value))).collect::<String>(),
            None => format!("{:>NUMBER$}", "-"),
        };
        let off = match self.difference {
            Some(0.0) => "  exact".to_owned(),
            Some(difference) => format!("  off {difference:.1e}"),
            None => String::new(),
        };
        let _ = writeln!(text, "{margin}{:<9}{}", self.name, list(&self.value));
        let _ = writeln!(text, "{margin}{:<9}{}{off}", "", list(&self.reference));
    }
}

/// A number with nine digits at most.
fn number(value: f64) -> String {
    // Zero has no sign here.
    let value = value + 0.0;
    let magnitude = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    match magnitude {
        -4.0..8.0 => format!("{value:.*}", (8.0 - magnitude).clamp(0.0, 10.0) as usize),
        _ => format!("{value:.6e}"),
    }
}

/// A coefficient or component as short as it is.
fn short(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn colour(colour: [f64; 3]) -> String {
    format!("({})", colour.map(short).join(" "))
}

impl PixelExplanation {
    /// The explanation as lines of text.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let ([column, row], [width, height]) = (self.pixel, self.size);
        let _ = writeln!(text, "pixel {column},{row} of {}, {width} x {height}: kernels {}", self.scene, self.profile);
        let rays = &self.machine_rays;
        let _ = writeln!(
            text,
            "{}, {}: {} reflected, {} refracted, {} towards lights",
            count(self.instructions, "instruction", "instructions"),
            count(rays.all(), "ray", "rays"),
            grouped(rays.reflected),
            grouped(rays.refracted),
            grouped(rays.shadow)
        );
        let searched = count(self.packets, "packet", "packets");
        let _ = writeln!(text, "{searched} searched, {} tested", count(self.triangles, "triangle", "triangles"));
        text.push_str(match self.parted {
            None => "machine and double precision decide alike at every ray\n",
            Some(_) => "",
        });
        if let Some(parted) = self.parted {
            let _ = writeln!(text, "machine and double precision part at ray {parted}");
        }
        if let Some(trap) = &self.trap {
            let _ = writeln!(text, "the program ended in a trap: {trap}");
        }
        text.push_str("Below each figure of the machine stands that of double precision.\n\n");
        ComparedLine::three("colour", &self.colour).write(&mut text, "");
        text.push('\n');
        // Depth first on a stack of its own, since trees may be deeper than this function's stack.
        let roots = self.rays.iter().filter(|ray| ray.parent.is_none()).map(|ray| (ray.number, String::new(), true));
        let mut open: Vec<(u32, String, bool)> = roots.collect();
        open.reverse();
        while let Some((number, margin, is_last)) = open.pop() {
            let ray = &self.rays[number as usize];
            let is_root = ray.parent.is_none();
            let is_deep = ray.level > DEEPEST;
            let (branch, below) = match (is_root || is_deep, is_last) {
                (true, _) => ("", ""),
                (false, true) => ("└ ", "  "),
                (false, false) => ("├ ", "│ "),
            };
            let inner = format!("{margin}{below}");
            let stem = if ray.children.is_empty() { "  " } else { "│ " };
            ray.write(&mut text, &format!("{margin}{branch}"), &format!("{inner}{stem}"));
            let last = ray.children.last().copied();
            open.extend(ray.children.iter().rev().map(|&child| (child, inner.clone(), Some(child) == last)));
        }
        text
    }
}

impl ExplainedRay {
    fn write(&self, text: &mut String, head: &str, margin: &str) {
        let level = if self.level > DEEPEST { format!(", level {}", self.level) } else { String::new() };
        let alone = match (self.weight.raw, self.weight.reference) {
            (None, _) => ", in double precision alone",
            (_, None) => ", of the machine alone",
            _ => "",
        };
        let _ = writeln!(text, "{head}{} {} ray{level}{alone}", self.number, self.kind);
        if let (Some(step), Some(end)) = (self.step, self.end) {
            let work = work(self.packets, self.triangles);
            let _ = writeln!(text, "{margin}steps {} to {}, {work}", grouped(step), grouped(end));
        }
        let mut line = |line: ComparedLine| line.write(text, margin);
        line(ComparedLine::one("weight", &self.weight));
        line(ComparedLine::three("origin", &self.origin));
        line(ComparedLine::three("direction", &self.direction));
        match &self.hit {
            Some(hit) => hit.write(text, margin),
            None => {
                let _ = writeln!(text, "{margin}meets nothing and sees the background");
            }
        }
        for light in &self.lights {
            light.write(text, margin);
        }
        if let Some(hit) = &self.hit {
            // The ambient intensity is the same all over the picture; the lights in sight are named above.
            let _ = writeln!(
                text,
                "{margin}local = {} (ambient + {} sum cosine light)",
                colour(hit.colour),
                short(hit.intensity)
            );
        }
        for (name, vector) in [("local", &self.local), ("added", &self.added), ("sum", &self.sum)] {
            ComparedLine::three(name, vector).write(text, margin);
        }
        let _ = writeln!(text, "{}", margin.trim_end());
    }
}

/// Packets and triangles of a search.
fn work(packets: u64, triangles: u64) -> String {
    format!("{}, {}", count(packets, "packet", "packets"), count(triangles, "triangle", "triangles"))
}

impl ExplainedHit {
    fn write(&self, text: &mut String, margin: &str) {
        let name = |triangle: Option<u32>| triangle.map_or_else(|| "nothing".to_owned(), |number| number.to_string());
        let other = match self.triangle == self.reference_triangle {
            true => String::new(),
            false => format!(" (double precision: {})", name(self.reference_triangle)),
        };
        let _ = writeln!(text, "{margin}meets triangle {}{other}", name(self.triangle));
        let mut made_of = format!("kd {} ks {}", short(self.intensity), short(self.reflection));
        if self.transmission > 0.0 {
            let _ = write!(made_of, " kt {} index {}", short(self.transmission), short(self.index));
        }
        let _ = writeln!(text, "{margin}material {}, {made_of}", self.material);
        for (name, figure) in [("t", &self.t), ("u", &self.u), ("v", &self.v)] {
            ComparedLine::one(name, figure).write(text, margin);
        }
        ComparedLine::three("point", &self.point).write(text, margin);
        ComparedLine::three("normal", &self.normal).write(text, margin);
    }
}

impl ExplainedLight {
    fn write(&self, text: &mut String, margin: &str) {
        let state = |state: Option<&str>| match state {
            Some("lit") => "in sight",
            Some("hidden") => "hidden",
            Some(_) => "behind the surface",
            None => "not looked for",
        };
        let _ = write!(text, "{margin}light {} {}: {}", self.light, colour(self.colour), state(self.state));
        match self.blocker {
            Some(blocker) => {
                let _ = writeln!(text, " by triangle {}", blocker.triangle);
            }
            None => text.push('\n'),
        }
        if self.state != self.reference_state {
            let _ = writeln!(text, "{margin}   in double precision: {}", state(self.reference_state));
        }
        if self.step.is_some() {
            let _ = writeln!(text, "{margin}   {}", work(self.packets, self.triangles));
        }
        if self.cosine.value.is_some() || self.cosine.reference.is_some() {
            ComparedLine::one("cosine", &self.cosine).write(text, &format!("{margin}   "));
            ComparedLine::one("distance", &self.distance).write(text, &format!("{margin}   "));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_nine_digits() {
        let texts = [0.0, 1.0, -0.5, 1234.5678, 2f64.powi(300), 1.5e-9, 123_456_789.5].map(number);
        let expected =
            ["0.00000000", "1.00000000", "-0.500000000", "1234.56780", "2.037036e90", "1.500000e-9", "1.234568e8"];
        assert_eq!(texts, expected);
        assert_eq!([0.7, 1.0, 0.0, 0.12345].map(short), ["0.7", "1", "0", "0.1235"]);
    }
}
