//! Figure 6: the cost of dividing the root of a scene's tree, along its longest axis.

use scenes::image::{MemoryImage, stored_place};
use scenes::kdtree::{Bounds, CostCurve};
use scenes::model::Scene;

use crate::chart::{AxisKind, ChartAxis, ChartFigure, ChartLine, ChartPoint, ChartSeries, Look, Plot, PointLabel};
use crate::job::result_name;

/// Planes that a chart shows at most; of more every so many.
const MOST_PLANES: usize = 1500;

/// The figure for a scene in memory.
pub fn cost(scene: &Scene, image: &MemoryImage) -> ChartFigure {
    let axis = image.bounds.longest_axis();
    let place = |vertex: u32| stored_place(&image.grid, image.layout, scene.vertices[vertex as usize]);
    let boxes = scene.triangles.iter().map(|triangle| Bounds::of_triangle(&triangle.vertices.map(place)));
    let curve = CostCurve::new(image.bounds, axis, boxes);
    let at = |raw: i32| image.grid.scene([raw; 3])[axis];
    let planes = curve.planes();
    let step = planes.len().div_ceil(MOST_PLANES).max(1);
    // At a bound the cost jumps: the places right before and behind it show from where to where.
    let around = |&plane: &i32| [plane - 1, plane, plane + 1].map(|raw| ChartPoint::new(at(raw), curve.cost(raw)));
    let best = curve.best();
    let series = |name: &str, look: Look, line: ChartLine, is_marked: bool, points: Vec<ChartPoint>| ChartSeries {
        name: name.to_owned(),
        look,
        line,
        is_marked,
        points,
    };
    let (low, high) = (image.bounds.low[axis], image.bounds.high[axis]);
    let undivided = [low, high].map(|raw| ChartPoint::new(at(raw), curve.undivided()));
    let mut all = vec![
        series("not to divide", Look::Muted, ChartLine::Dashed, false, undivided.to_vec()),
        series(
            "cost of a plane",
            Look::Numbered(0),
            ChartLine::Solid,
            false,
            planes.iter().step_by(step).flat_map(around).collect(),
        ),
    ];
    all.extend(best.map(|(plane, lowest)| {
        let words = format!("{lowest:.1} at {:.3}", at(plane));
        let label = Some(PointLabel { words: words.clone(), is_important: true });
        let point = ChartPoint { label, tip: words, ..ChartPoint::new(at(plane), lowest) };
        series("lowest cost: the plane of 5.3.2", Look::Numbered(1), ChartLine::None, true, vec![point])
    }));
    let name = ["x", "y", "z"][axis];
    ChartFigure {
        title: format!("{}: cost of dividing the root along {name}", result_name(scene)),
        note: format!(
            "C = 1 + (SA(left) n_left + SA(right) n_right) / SA(node), {} triangles, {} planes; it jumps where a triangle begins or ends (report 5.3.2, figure 6)",
            scene.triangles.len(),
            planes.len()
        ),
        rows: vec![vec![Plot {
            title: String::new(),
            x: ChartAxis { name: format!("{name}, scene units"), kind: AxisKind::Linear },
            y: ChartAxis { name: "cost, triangle tests".to_owned(), kind: AxisKind::FromZero },
            series: all,
            aspect: 0.5,
        }]],
    }
}
