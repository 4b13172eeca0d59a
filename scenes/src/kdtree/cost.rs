//! The cost of dividing a node by the place of the plane (5.3.2), as a curve that people can look at. The report's builder takes its lowest point.

use super::Bounds;
use super::split::half_surface;

/// The cost model of a node along an axis.
#[derive(Clone, Debug)]
pub struct CostCurve {
    node: Bounds,
    axis: usize,
    /// Sorted bounds of the triangles, and of those that lie in a plane across the axis.
    lows: Vec<i32>,
    highs: Vec<i32>,
    flats: Vec<i32>,
}

impl CostCurve {
    /// The curve of a node that holds triangles with these boxes.
    pub fn new(node: Bounds, axis: usize, triangles: impl Iterator<Item = Bounds>) -> CostCurve {
        let mut curve = CostCurve { node, axis, lows: Vec::new(), highs: Vec::new(), flats: Vec::new() };
        for triangle in triangles {
            let (low, high) = (triangle.low[axis], triangle.high[axis]);
            curve.lows.push(low);
            curve.highs.push(high);
            curve.flats.extend((low == high).then_some(low));
        }
        [&mut curve.lows, &mut curve.highs, &mut curve.flats].into_iter().for_each(|bounds| bounds.sort_unstable());
        curve
    }

    /// Planes that a builder tries: the bounds of the triangles within the node, each once, from the lowest on.
    pub fn planes(&self) -> Vec<i32> {
        let mut planes: Vec<i32> = self.lows.iter().chain(&self.highs).copied().collect();
        planes.sort_unstable();
        planes.dedup();
        planes.retain(|&at| at > self.node.low[self.axis] && at < self.node.high[self.axis]);
        planes
    }

    /// The cost of not dividing: a test for each triangle.
    pub fn undivided(&self) -> f64 {
        self.lows.len() as f64
    }

    /// The cost of a plane, C = 1 + (SA(left) n_left + SA(right) n_right) / SA(node); triangles in the plane are on the cheaper side.
    pub fn cost(&self, at: i32) -> f64 {
        let left = self.lows.partition_point(|&low| low < at) as f64;
        let right = (self.highs.len() - self.highs.partition_point(|&high| high <= at)) as f64;
        let flats = self.flats.partition_point(|&flat| flat <= at) - self.flats.partition_point(|&flat| flat < at);
        let [lower, upper] = self.node.divided(self.axis, at).map(|part| half_surface(&part) as f64);
        let surface = half_surface(&self.node) as f64;
        1.0 + (lower * left + upper * right + lower.min(upper) * flats as f64) / surface
    }

    /// The lowest cost of the planes, and the first plane that has it; `None` where there is no plane.
    pub fn best(&self) -> Option<(i32, f64)> {
        let costs = self.planes().into_iter().map(|at| (at, self.cost(at)));
        costs.reduce(|best, other| if other.1 < best.1 { other } else { best })
    }
}

#[cfg(test)]
mod tests {
    use super::super::split::Sweep;
    use super::*;

    /// Four boxes of which two overlap, as in figure 6.
    fn four() -> (Bounds, Vec<Bounds>) {
        let one = |low: i32, high: i32, y: i32| Bounds { low: [low, y, 0], high: [high, y + 10, 10] };
        (
            Bounds { low: [0, 0, 0], high: [100, 40, 10] },
            vec![one(5, 15, 0), one(12, 30, 20), one(60, 70, 5), one(80, 95, 25)],
        )
    }

    #[test]
    fn the_lowest_point_is_the_builders_plane() {
        let (node, boxes) = four();
        let curve = CostCurve::new(node, 0, boxes.iter().copied());
        let (division, cost) = Sweep::default().best(&node, 0, boxes.iter()).unwrap();
        let (at, lowest) = curve.best().unwrap();
        assert_eq!(at, division.at);
        assert!((lowest - cost as f64 / half_surface(&node) as f64).abs() < 1e-12);
        assert!(lowest < curve.undivided());
    }

    #[test]
    fn cost_grows_linearly_between_bounds_and_jumps_at_them() {
        let (node, boxes) = four();
        let curve = CostCurve::new(node, 0, boxes.iter().copied());
        let step = |at: i32| curve.cost(at + 1) - curve.cost(at);
        assert!((step(35) - step(50)).abs() < 1e-12);
        // Where a box ends, one triangle fewer is on the right.
        assert!(curve.cost(30) < curve.cost(29));
        assert_eq!(curve.planes().len(), 8);
    }
}
