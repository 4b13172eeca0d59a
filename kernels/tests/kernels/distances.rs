//! Eyes and lights at many distances: they take no bits from the mesh, since rays start where they enter the scene's box, and far lights have steps of
//! their own. docs/exactness.md has the table.

use std::fmt::Write;

use isa::number::{Modes, Overflow, Quantization};
use kernels::KernelSet;
use scenes::generate::{self, GenerateOptions};
use scenes::model::{Camera, Scene, Vec3, View};
use scenes::vector::{largest, sub};

use super::drawing::error;

const SIZE: (u32, u32) = (48, 36);

/// Distances in sizes of the box; the first is near.
const DISTANCES: [f64; 6] = [1.5, 3.0, 30.0, 300.0, 3_000.0, 100_000.0];

const SCENES: [&str; 3] = ["cornell", "sphereflake", "slabs"];

/// Middle of a scene's box, and its longest side.
fn place(scene: &Scene) -> (Vec3, f64) {
    let (low, high) = scene.bounds().expect("it has triangles");
    ([0, 1, 2].map(|k| (low[k] + high[k]) / 2.0), largest(sub(high, low)))
}

/// The scene seen from an eye so far away, with a field of view that shows the box as large.
fn with_eye(scene: Scene, distance: f64) -> (Scene, View) {
    let (middle, side) = place(&scene);
    let eye = [0.1, 0.2, 1.0].map(|way| way * side * distance);
    let eye = Some([0, 1, 2].map(|k| middle[k] + eye[k]));
    let field = 2.0 * (0.6 / distance).atan().to_degrees();
    (scene, View { camera: Camera::Perspective { eye, look: None, field }, ..View::new(SIZE) })
}

/// The scene with all lights so far away, each in a direction of its own, as bright as they were.
fn with_lights(mut scene: Scene, distance: f64) -> (Scene, View) {
    let (middle, side) = place(&scene);
    for (number, light) in scene.lights.iter_mut().enumerate() {
        let way = [0.3 - 0.5 * number as f64, 0.4, 1.0].map(|way| way * side * distance);
        light.position = [0, 1, 2].map(|k| middle[k] + way[k]);
    }
    (scene, View::new(SIZE))
}

/// Decibels at each distance: no pixel off in 32 bits and at most two in 24, and all within 6 dB of the near ones.
fn decibels(name: &str, word: u32, far: fn(Scene, f64) -> (Scene, View)) -> [f64; DISTANCES.len()] {
    let scene = generate::scene(name, &GenerateOptions { size: SIZE, ..GenerateOptions::default() }).expect("a scene");
    let modes = Modes { word, quantization: Quantization::Rnd, overflow: Overflow::Sat };
    let found = DISTANCES.map(|distance| {
        let (scene, view) = far(scene.clone(), distance);
        let error = error(&scene, &view, KernelSet::Ray, modes);
        let most_off = if word == 32 { 0 } else { 2 };
        assert!(error.off_pixels <= most_off, "{name}, {word} bits at {distance}: {} off", error.off_pixels);
        error.psnr_others_db.unwrap_or(f64::INFINITY)
    });
    println!("{name}, {word} bits: {found:.1?}");
    assert!(found.iter().all(|&far| far >= found[0] - 6.0), "{name}, {word} bits: {found:?}");
    found
}

#[test]
fn far_eyes_and_lights_take_no_bits() {
    let mut table = String::from(
        "| at a distance of | scene | bits | 1.5 | 3 | 30 | 300 | 3,000 | 100,000 |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    for (what, far) in [("the eye", with_eye as fn(_, _) -> _), ("all lights", with_lights)] {
        for name in SCENES {
            for word in [32, 24] {
                let _ = write!(table, "| {what} | {name} | {word} |");
                let cells = decibels(name, word, far);
                cells.iter().for_each(|cell| {
                    let _ = write!(table, " {cell:.1} |");
                });
                table.push('\n');
            }
        }
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/exactness.md");
    let page = std::fs::read_to_string(path).expect("the page is there");
    let (before, rest) = page.split_once("<!-- distances -->\n").expect("the table begins");
    let (_, after) = rest.split_once("<!-- end of distances -->").expect("the table ends");
    let expected = format!("{before}<!-- distances -->\n{table}<!-- end of distances -->{after}");
    if std::env::var_os("LANCER_BLESS").is_some() {
        std::fs::write(path, expected).expect("the page can be written");
    } else {
        assert!(page == expected, "docs/exactness.md: LANCER_BLESS=1 writes the table as it is now:\n{table}");
    }
}
