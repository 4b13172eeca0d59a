//! Closed meshes to aim at, on whole numbers. Each edge belongs to two triangles that run along it in opposite directions; seen from outside, triangles
//! run anticlockwise.

use isa::number::Vector;

/// Three corners.
pub type TriangleCorners = [Vector; 3];

/// Half the length of a mesh. Coordinates are multiples of 4, so that middles of edges and faces are exact.
const SIZE: f64 = (1 << 28) as f64;

/// A closed mesh.
pub struct ClosedMesh {
    /// Name of the mesh.
    pub name: &'static str,
    /// Triangles of the mesh.
    pub triangles: Vec<TriangleCorners>,
}

/// The six meshes.
pub fn closed() -> [ClosedMesh; 6] {
    [
        ClosedMesh { name: "sphere", triangles: sphere(6, |_| 1.0) },
        ClosedMesh { name: "star", triangles: sphere(8, |corner| if corner % 3 == 0 { 1.0 } else { 0.35 }) },
        ClosedMesh { name: "torus", triangles: torus(16, 24) },
        ClosedMesh { name: "box", triangles: cube(4) },
        ClosedMesh { name: "spindle", triangles: spindle(40) },
        ClosedMesh { name: "plate", triangles: plate(40) },
    ]
}

fn on_grid(point: [f64; 3]) -> Vector {
    point.map(|x| 4 * (x * SIZE / 4.0).round() as i32)
}

/// An octahedron whose faces are divided and moved to a sphere, or to the radius that a corner's place on its face gives.
pub fn sphere(divisions: i32, radius: impl Fn(i32) -> f64) -> Vec<TriangleCorners> {
    let mut triangles = Vec::new();
    let corner = |sign: i32, axis: usize| std::array::from_fn(|k| if k == axis { f64::from(sign) } else { 0.0 });
    for octant in 0..8 {
        let signs = [0, 1, 2].map(|k| if octant >> k & 1 == 0 { 1 } else { -1 });
        let mut corners: [[f64; 3]; 3] = [0, 1, 2].map(|k| corner(signs[k], k));
        if signs[0] * signs[1] * signs[2] < 0 {
            corners.swap(1, 2);
        }
        let point = |i: i32, j: i32| {
            let k = divisions - i - j;
            let flat: [f64; 3] = std::array::from_fn(|axis| {
                f64::from(i) * corners[0][axis] + f64::from(j) * corners[1][axis] + f64::from(k) * corners[2][axis]
            });
            let length = flat.iter().map(|x| x * x).sum::<f64>().sqrt();
            // The sum of the coordinates' products is the same for the octants that share the point.
            let radius = radius(i * j + j * k + k * i);
            on_grid(flat.map(|x| x * radius / length))
        };
        for i in 0..divisions {
            for j in 0..divisions - i {
                triangles.push([point(i, j), point(i + 1, j), point(i, j + 1)]);
                if i + j + 1 < divisions {
                    triangles.push([point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]);
                }
            }
        }
    }
    triangles
}

/// A grid of quadrangles that is closed both ways.
fn torus(rows: i32, columns: i32) -> Vec<TriangleCorners> {
    let turn = |k: i32, n: i32| (f64::from(k % n) / f64::from(n) * std::f64::consts::TAU).sin_cos();
    let point = |row: i32, column: i32| {
        let ((s, c), (t, d)) = (turn(row, rows), turn(column, columns));
        let radius = 0.7 + 0.3 * c;
        on_grid([radius * d, radius * t, 0.3 * s])
    };
    let quadrangle = |row: i32, column: i32| {
        let [a, b, c, d] = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(down, right)| point(row + down, column + right));
        [[a, b, c], [a, c, d]]
    };
    (0..rows).flat_map(|row| (0..columns).flat_map(move |column| quadrangle(row, column))).collect()
}

/// A box along the axes, each face a grid of squares: faces and edges lie in the planes that divide the tree.
pub fn cube(divisions: i32) -> Vec<TriangleCorners> {
    let mut triangles = Vec::new();
    let place = |k: i32| f64::from(2 * k - divisions) / f64::from(divisions);
    for (axis, side) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
        let point = |i: i32, j: i32| {
            let mut point = [0.0; 3];
            point[axis] = f64::from(side);
            (point[(axis + 1) % 3], point[(axis + 2) % 3]) = (place(i), place(j));
            on_grid(point)
        };
        for (i, j) in (0..divisions).flat_map(|i| (0..divisions).map(move |j| (i, j))) {
            let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            triangles.extend(if side > 0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
        }
    }
    triangles
}

/// A double cone, 100,000 times as long as wide: slivers around two tips.
fn spindle(sides: i32) -> Vec<TriangleCorners> {
    let rim = |k: i32| {
        let (s, c) = (f64::from(k % sides) / f64::from(sides) * std::f64::consts::TAU).sin_cos();
        on_grid([1e-5 * c, 1e-5 * s, 0.0])
    };
    let [top, bottom] = [on_grid([0.0, 0.0, 1.0]), on_grid([0.0, 0.0, -1.0])];
    (0..sides).flat_map(|k| [[rim(k), rim(k + 1), top], [rim(k + 1), rim(k), bottom]]).collect()
}

/// A tilted disc of a thickness of 8 units, 67 million times as wide, whose faces are fans of triangles.
fn plate(sides: i32) -> Vec<TriangleCorners> {
    let rim = |k: i32, lift: i32| {
        let (s, c) = (f64::from(k % sides) / f64::from(sides) * std::f64::consts::TAU).sin_cos();
        let [x, y, z] = on_grid([c, s, 0.3 * c + 0.2 * s]);
        [x, y, z + lift]
    };
    (0..sides)
        .flat_map(|k| {
            let [a, b, c, d] = [rim(k, 0), rim(k + 1, 0), rim(k + 1, 8), rim(k, 8)];
            [[a, b, c], [a, c, d], [[0, 0, 8], d, c], [[0, 0, 0], b, a]]
        })
        .collect()
}
