//! Clocks against error as a picture: SVG, both axes logarithmic, one panel a scene.

use std::fmt::Write;

use super::MeasuredVariant;

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 380.0;
const LEFT: f64 = 80.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 36.0;
const BOTTOM: f64 = 48.0;

/// PSNR of a picture without any error, for the axis.
const PERFECT: f64 = 200.0;

/// The chart. Dominated variants are grey and name the one that beats them in their tooltip.
pub fn svg(measured: &[MeasuredVariant]) -> String {
    let mut scenes: Vec<&str> = Vec::new();
    for one in measured {
        if !scenes.contains(&one.scene.as_str()) {
            scenes.push(&one.scene);
        }
    }
    let height = HEIGHT * scenes.len() as f64;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" font-family=\"sans-serif\" font-size=\"11\">\n\
         <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    for (panel, scene) in scenes.into_iter().enumerate() {
        let points: Vec<&MeasuredVariant> = measured.iter().filter(|one| one.scene == scene).collect();
        let _ = writeln!(svg, "<g transform=\"translate(0 {})\">", HEIGHT * panel as f64);
        self::panel(&mut svg, scene, &points);
        svg.push_str("</g>\n");
    }
    svg + "</svg>\n"
}

fn psnr(one: &MeasuredVariant) -> f64 {
    one.error.psnr_db.unwrap_or(PERFECT).min(PERFECT)
}

fn range(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let (least, most) = (values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max));
    let room = ((most - least) * 0.08).max(0.05);
    (least - room, most + room)
}

fn panel(svg: &mut String, scene: &str, points: &[&MeasuredVariant]) {
    let xs = range(points.iter().map(|one| one.clocks.max(1.0).log10()));
    let ys = range(points.iter().map(|one| psnr(one)));
    let at = |clocks: f64, decibels: f64| {
        let x = LEFT + (clocks.max(1.0).log10() - xs.0) / (xs.1 - xs.0) * (WIDTH - LEFT - RIGHT);
        let y = HEIGHT - BOTTOM - (decibels - ys.0) / (ys.1 - ys.0) * (HEIGHT - TOP - BOTTOM);
        (x, y)
    };
    let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
    let _ = writeln!(
        svg,
        "<text x=\"{LEFT}\" y=\"20\" font-size=\"14\">{}: clocks a pixel against PSNR</text>\n\
         <path d=\"M{LEFT} {TOP}V{bottom}H{right}\" fill=\"none\" stroke=\"black\"/>\n\
         <text x=\"{right}\" y=\"{}\" text-anchor=\"end\">clocks a pixel</text>\n\
         <text x=\"{LEFT}\" y=\"{}\" text-anchor=\"end\">dB</text>",
        escaped(scene),
        HEIGHT - 12.0,
        TOP - 4.0
    );
    for tick in ticks(xs) {
        let (x, _) = at(10f64.powf(tick), ys.0);
        let label = 10f64.powf(tick).round();
        let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>", bottom + 16.0);
    }
    for tick in ticks(ys) {
        let (_, y) = at(1.0, tick);
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{tick:.1}</text>", LEFT - 6.0, y + 4.0);
    }
    let mut front: Vec<(f64, f64)> =
        points.iter().filter(|one| one.is_on_front).map(|one| at(one.clocks, psnr(one))).collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    let line: Vec<String> = front.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(svg, "<polyline points=\"{}\" fill=\"none\" stroke=\"#c33\"/>", line.join(" "));
    for one in points {
        let (x, y) = at(one.clocks, psnr(one));
        let name = escaped(&one.variant);
        let (colour, title) = match &one.dominated_by {
            None => ("#c33", name.clone()),
            Some(by) => ("#999", format!("{name}: dominated by {}", escaped(by))),
        };
        let _ = writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{colour}\"><title>{title}</title></circle>\n\
             <text x=\"{:.1}\" y=\"{:.1}\" fill=\"{colour}\" font-size=\"9\">{name}</text>",
            x + 6.0,
            y - 4.0
        );
    }
}

/// Five round places of an axis.
fn ticks((least, most): (f64, f64)) -> impl Iterator<Item = f64> {
    (0..5).map(move |k| least + (most - least) * (0.1 + 0.2 * f64::from(k)))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
