//! Samples on edges: pictures of small shapes whose edges, corners and planes lie where samples do, against double precision.

use isa::number::Modes;
use kernels::KernelSet;
use kernels::set::Decisions;
use scenes::model::{Camera, Light, Material, Scene, Triangle, Vec3, View};

use super::drawing::error;

/// A shape by its corners and faces; faces are fans around their first corner.
struct Shape {
    name: &'static str,
    corners: Vec<Vec3>,
    faces: Vec<Vec<u32>>,
}

fn shape(name: &'static str, corners: impl IntoIterator<Item = Vec3>, faces: &[&[u32]]) -> Shape {
    Shape { name, corners: corners.into_iter().collect(), faces: faces.iter().map(|face| face.to_vec()).collect() }
}

impl Shape {
    fn changed(mut self, name: &'static str, change: impl Fn(Vec3) -> Vec3) -> Shape {
        self.corners.iter_mut().for_each(|corner| *corner = change(*corner));
        Shape { name, ..self }
    }

    fn and(mut self, name: &'static str, other: Shape) -> Shape {
        let first = self.corners.len() as u32;
        self.corners.extend(other.corners);
        self.faces.extend(other.faces.into_iter().map(|face| face.into_iter().map(|corner| first + corner).collect()));
        Shape { name, ..self }
    }

    /// The shape with faces of three colours in turn, in the light that a mesh alone has.
    fn scene(&self, material: Material) -> Scene {
        let colours = [[0.9, 0.3, 0.2], [0.2, 0.8, 0.4], [0.3, 0.4, 1.0]];
        let triangles = self.faces.iter().enumerate().flat_map(|(number, face)| {
            (2..face.len()).map(move |k| Triangle {
                vertices: [face[0], face[k - 1], face[k]],
                material: (number % colours.len()) as u32,
            })
        });
        let mut scene = Scene {
            name: self.name.into(),
            size: (8, 8),
            materials: colours.iter().map(|&colour| Material { colour, ..material }).collect(),
            lights: Vec::new(),
            vertices: self.corners.clone(),
            triangles: triangles.collect(),
        };
        let (low, high) = scene.bounds().expect("a shape has corners");
        let size = [0, 1, 2].map(|k| high[k] - low[k]).into_iter().fold(0.0, f64::max);
        let position = [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0 + size, high[2] + size];
        scene.lights.push(Light { position, colour: [1.0; 3] });
        scene
    }
}

const MATT: Material = Material { colour: [1.0; 3], reflection: 0.0, intensity: 0.9, index: 0.0 };
const MIRROR: Material = Material { reflection: 0.5, intensity: 0.5, ..MATT };

fn flat(points: &[[f64; 2]], faces: &[&[u32]]) -> Shape {
    shape("flat", points.iter().map(|&[x, y]| [x, y, 0.0]), faces)
}

fn triangle() -> Shape {
    flat(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], &[&[0, 1, 2]])
}

fn square() -> Shape {
    flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], &[&[0, 1, 2, 3]])
}

fn cuboid() -> Shape {
    let corners = (0..8).map(|k| [0, 1, 2].map(|axis| f64::from(k >> axis & 1)));
    let faces: [&[u32]; 6] = [&[0, 1, 3, 2], &[4, 6, 7, 5], &[0, 4, 5, 1], &[2, 3, 7, 6], &[0, 2, 6, 4], &[1, 5, 7, 3]];
    shape("cube", corners, &faces)
}

/// A regular polygon of `n` corners around a middle, every second corner at the radius `inner`; `height` lifts the middle.
fn star(n: u32, inner: f64, height: f64) -> Shape {
    let corner = |k: u32| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(n);
        let radius = if k.is_multiple_of(2) { 1.0 } else { inner };
        [radius * angle.cos(), radius * angle.sin(), 0.0]
    };
    let faces: Vec<Vec<u32>> = (0..n).map(|k| vec![0, 1 + k, 1 + (k + 1) % n]).collect();
    Shape { name: "star", corners: [[0.0, 0.0, height]].into_iter().chain((0..n).map(corner)).collect(), faces }
}

/// Squares side by side, `n` by `n`, with heights.
fn field(n: u32, height: impl Fn(u32, u32) -> f64) -> Shape {
    let side = n + 1;
    let corner = |k: u32| [f64::from(k % side), f64::from(k / side), height(k % side, k / side)];
    let face = |k: u32| {
        let first = k / n * side + k % n;
        vec![first, first + 1, first + side + 1, first + side]
    };
    Shape { name: "field", corners: (0..side * side).map(corner).collect(), faces: (0..n * n).map(face).collect() }
}

fn scaled(factor: f64) -> impl Fn(Vec3) -> Vec3 {
    move |p| p.map(|x| x * factor)
}

fn moved(by: Vec3) -> impl Fn(Vec3) -> Vec3 {
    move |p| [0, 1, 2].map(|k| p[k] + by[k])
}

/// Half a right angle around z, y and x.
fn turned([x, y, z]: Vec3, axis: usize) -> Vec3 {
    match axis {
        0 => [x, y - z, y + z],
        1 => [x + z, y, z - x],
        _ => [x - y, x + y, z],
    }
}

fn plane_shapes() -> Vec<Shape> {
    vec![
        // One triangle: in its place, where decimals are not exact, turned, thin
        triangle().changed("triangle", |p| p),
        triangle().changed("triangle in decimals", |[x, y, z]| [0.1 + 0.6 * x, 0.2 + 0.6 * y, z + 0.3]),
        triangle().changed("triangle in thirds", scaled(1.0 / 3.0)),
        triangle().changed("triangle far off", moved([1000.1, -500.3, 77.7])),
        flat(&[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]], &[&[0, 1, 2]]).changed("triangle from behind", |p| p),
        flat(&[[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]], &[&[0, 1, 2]]).changed("gable", |p| p),
        flat(&[[0.0, 0.0], [1.0, 0.001], [1.0, 0.5]], &[&[0, 1, 2]]).changed("sliver", |p| p),
        square().changed("square", |p| p),
        square().changed("rectangle", |[x, y, z]| [4.0 * x, 3.0 * y, z]),
        square().changed("diamond", |p| turned(p, 2)),
        square().changed("ramp", |[x, y, _]| [x, y, x + y]),
        // Two pieces: apart, one before the other, in the same place, crossing, touching
        square().and("steps apart", square().changed("right", moved([1.0, 0.0, 0.5]))),
        square().and("one plane twice", square().changed("over", |[x, y, z]| [0.25 + 0.5 * x, 0.25 + 0.5 * y, z])),
        square().and("the same twice", square()),
        square()
            .changed("up", |[x, y, _]| [x, y, x])
            .and("crossing", square().changed("down", |[x, y, _]| [x, y, 0.8 - x])),
        triangle().and("corner to corner", triangle().changed("other", |[x, y, z]| [-x, -y, z])),
        // Faces within one plane, which share their edges
        flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], &[&[0, 1, 3], &[1, 2, 3]])
            .changed("two colours", |p| p),
        flat(
            &[[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0], [1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]],
            &[&[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]],
        )
        .changed("frame", |p| p),
        field(4, |_, _| 0.0).changed("board", |p| p),
        field(5, |_, _| 0.0).changed("board in decimals", scaled(0.1)),
        star(6, 1.0, 0.0).changed("hexagon", |p| p),
        star(10, 0.4, 0.0).changed("five points", |p| p),
    ]
}

fn solid_shapes() -> Vec<Shape> {
    let stairs = |x: f64, y: f64| cuboid().changed("step", move |p| [p[0] + 1.07 * x, p[1] * y, p[2] + y]);
    vec![
        cuboid().changed("cube", |p| p),
        cuboid().changed("cube in decimals", |p| p.map(|x| 0.1 + 0.7 * x)),
        cuboid().changed("cube on edge", |p| turned(p, 2)),
        cuboid().changed("cube seen by an edge", |p| turned(p, 1)),
        cuboid().changed("cube seen from above", |p| turned(p, 0)),
        cuboid().changed("board", |[x, y, z]| [x / 3.0, y / 3.0, z / 30.0]),
        // Several cubes that touch or hold each other
        cuboid()
            .and("box on box", cuboid().changed("top", |[x, y, z]| [0.25 + x / 2.0, 1.0 + y / 2.0, 0.25 + z / 2.0])),
        cuboid().and("box in box", cuboid().changed("in", |p| p.map(|x| 0.25 + x / 2.0))),
        stairs(0.0, 1.0).and("stairs", stairs(1.0, 2.0)).and("stairs", stairs(2.0, 3.0)),
        // Points, folds, and a cube before a wall
        star(4, 1.0, 1.0).changed("pyramid", |p| p),
        star(4, 1.0, 1.0).changed("pyramid on edge", |p| turned(p, 2)),
        star(6, 1.0, 0.5).changed("tent", |p| p),
        star(4, 1.0, 1.0).and("octahedron", star(4, 1.0, -1.0)),
        star(16, 0.5, 0.25).changed("cog", |p| p),
        field(3, |x, y| f64::from((x + y) % 2)).changed("waves", |p| p),
        field(4, |x, _| -f64::from(x.abs_diff(1))).changed("ridge", |p| p),
        field(1, |_, _| 3.0)
            .changed("back", moved([0.0, 0.0, -4.0]))
            .and("cube before a wall", cuboid().changed("in front", scaled(0.5))),
        shape(
            "tetrahedron",
            [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]],
            &[&[0, 1, 2], &[0, 2, 3], &[0, 3, 1], &[1, 3, 2]],
        ),
    ]
}

/// Forty small shapes, matt and as mirrors, in five sizes, two cameras and all sets that claim exactness: no pixel is off, without a shift of the
/// samples. None has a sample on a concave crease or on an edge of glass, where a secondary ray starts within a unit of the next face.
#[test]
fn no_pixel_of_a_small_shape_is_off() {
    let shapes: Vec<Shape> = plane_shapes().into_iter().chain(solid_shapes()).collect();
    assert_eq!(shapes.len(), 40);
    let cameras = [Camera::Orthographic, Camera::Perspective { eye: None, look: None, field: 45.0 }];
    let mut wrong = Vec::new();
    for (shape, material) in shapes.iter().flat_map(|shape| [(shape, MATT), (shape, MIRROR)]) {
        let scene = shape.scene(material);
        for size in [(32, 24), (33, 25), (24, 24), (40, 40), (64, 48)] {
            for camera in cameras {
                let view = View { camera, ..View::new(size) };
                for &set in KernelSet::ALL.iter().filter(|set| set.decisions() != Decisions::Rounded) {
                    match error(&scene, &view, set, Modes::default()).off_pixels {
                        0 => {}
                        off => wrong.push(format!("{} by {set} in {size:?}, {camera:?}: {off} off", scene.name)),
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} pictures\n{}", wrong.len(), wrong.join("\n"));
}
