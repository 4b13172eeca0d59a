//! Figure 7: the walk through the ray tree of a pixel.

use crate::chart::{ChartLine, DiagramBox, DiagramFigure, DiagramLink, Look};
use crate::numeral::grouped;
use crate::pixel::{ExplainedRay, PixelExplanation};

/// Height of a level and of a box, and the most width of a box, in widths of the diagram.
const LEVEL: f64 = 0.13;
const TALL: f64 = 0.072;
const WIDE: f64 = 0.17;

/// Half the distance between the ways down and up.
const ASIDE: f64 = 0.006;

/// A ray that the machine followed, with its place.
struct PlacedRay<'a> {
    ray: &'a ExplainedRay,
    middle: (f64, f64),
}

/// The figure for a pixel that was explained.
///
/// A ray without children takes the next column, one with children stands above the middle of theirs: a camera ray with a reflected child, which has
/// none, and a refracted one with two has the columns 1, 2 and 3 below it.
pub fn walk(explanation: &PixelExplanation) -> DiagramFigure {
    let rays: Vec<&ExplainedRay> = explanation.rays.iter().filter(|ray| ray.step.is_some()).collect();
    let children = |number: u32| rays.iter().filter(move |ray| ray.parent == Some(number));
    // Children come behind their parents, so the columns are known from the last ray to the first.
    let mut columns: Vec<f64> = vec![0.0; explanation.rays.len()];
    let leaves = rays.iter().filter(|ray| children(ray.number).next().is_none()).count();
    let mut next = leaves as f64;
    for ray in rays.iter().rev() {
        let below: Vec<f64> = children(ray.number).map(|child| columns[child.number as usize]).collect();
        columns[ray.number as usize] = if below.is_empty() {
            next -= 1.0;
            next + 0.5
        } else {
            below.iter().sum::<f64>() / below.len() as f64
        };
    }
    let levels = 1 + rays.iter().map(|ray| ray.level).max().unwrap_or(0);
    let width = 1.0 / leaves.max(1) as f64;
    let placed = |ray: &ExplainedRay| (columns[ray.number as usize] * width, LEVEL * (f64::from(ray.level) + 0.5));
    let placed: Vec<PlacedRay> = rays.iter().map(|&ray| PlacedRay { ray, middle: placed(ray) }).collect();
    let size = ((0.88 * width).min(WIDE), TALL);
    DiagramFigure {
        title: format!(
            "{}, pixel {},{}: the walk through its {} rays",
            explanation.scene,
            explanation.pixel[0],
            explanation.pixel[1],
            grouped(rays.len() as u64)
        ),
        note: "Depth first, in the order of the numbers, the reflected child before the refracted one, and back to the parent; a node is released \
               when the walk leaves it (report 5.4, figure 7)"
            .to_owned(),
        aspect: LEVEL * f64::from(levels),
        links: placed.iter().flat_map(|child| ways(child, &placed)).collect(),
        boxes: placed.iter().map(|placed| ray_box(placed, size)).collect(),
    }
}

/// The edge from a ray to its parent, with the way down it and the way back.
fn ways(child: &PlacedRay, placed: &[PlacedRay]) -> Vec<DiagramLink> {
    let Some(parent) = placed.iter().find(|other| Some(other.ray.number) == child.ray.parent) else {
        return Vec::new();
    };
    let (from, to) = ((parent.middle.0, parent.middle.1 + TALL / 2.0), (child.middle.0, child.middle.1 - TALL / 2.0));
    let link = |points: Vec<(f64, f64)>, look: Look, line: ChartLine, is_arrow: bool| DiagramLink {
        points,
        look,
        line,
        width: 1.0,
        is_arrow,
    };
    let beside = |(x, y): (f64, f64), by: f64| (x + by, y);
    vec![
        link(vec![beside(from, -ASIDE), beside(to, -ASIDE)], Look::Numbered(1), ChartLine::Solid, true),
        link(vec![beside(to, ASIDE), beside(from, ASIDE)], Look::Numbered(1), ChartLine::Dashed, true),
    ]
}

fn ray_box(placed: &PlacedRay, size: (f64, f64)) -> DiagramBox {
    let ray = placed.ray;
    let meets = match ray.hit.as_ref().and_then(|hit| hit.triangle) {
        Some(triangle) => format!("triangle {}", grouped(triangle.into())),
        None => "nothing".to_owned(),
    };
    let weight = ray.weight.value.map(|weight| format!("weight {weight:.3}")).unwrap_or_default();
    let look = match ray.kind {
        "reflected" => Look::Numbered(0),
        "refracted" => Look::Numbered(2),
        _ => Look::Muted,
    };
    let name = format!("{} {}", ray.number, ray.kind);
    let tip = format!("ray {name}, level {}: {meets}, {weight}", ray.level);
    // A narrow box has its number alone.
    let words = if size.0 < 0.09 { vec![ray.number.to_string()] } else { vec![name, meets, weight] };
    DiagramBox { middle: placed.middle, size, words, look, is_around: false, tip }
}
