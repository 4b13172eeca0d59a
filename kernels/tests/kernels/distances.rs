//! Eyes at many distances: they take no bits from the mesh, since rays start where they enter the scene's box.

use isa::number::{Modes, Overflow, Quantization};
use kernels::KernelSet;
use scenes::generate::{self, GenerateOptions};
use scenes::model::{Camera, View};
use scenes::vector::{largest, sub};

use super::drawing::error;

/// Distances of the eye in sizes of the box; the first is the nearest.
const DISTANCES: [f64; 5] = [1.5, 3.0, 30.0, 300.0, 3_000.0];

/// The eye at each distance, with a field of view that shows the box as large: no pixel off and at least 165 dB in 32 bits, at most two and 115 dB in 24,
/// as near.
#[test]
fn far_eyes_take_no_bits() {
    let size = (48, 36);
    for (name, word) in ["cornell", "sphereflake", "slabs"].into_iter().flat_map(|name| [(name, 32), (name, 24)]) {
        let scene = generate::scene(name, &GenerateOptions { size, ..GenerateOptions::default() }).expect("a scene");
        let (low, high) = scene.bounds().expect("it has triangles");
        let side = largest(sub(high, low));
        let modes = Modes { word, quantization: Quantization::Rnd, overflow: Overflow::Sat };
        let decibels = DISTANCES.map(|distance| {
            let middle = [0, 1, 2].map(|k| (low[k] + high[k]) / 2.0);
            let eye = [middle[0] + 0.1 * side * distance, middle[1] + 0.2 * side * distance, high[2] + side * distance];
            let field = 2.0 * (0.6 / distance).atan().to_degrees();
            let view = View { camera: Camera::Perspective { eye: Some(eye), look: None, field }, ..View::new(size) };
            let error = error(&scene, &view, KernelSet::Ray, modes);
            let most_off = if word == 32 { 0 } else { 2 };
            assert!(error.off_pixels <= most_off, "{name}, {word} bits at {distance}: {} off", error.off_pixels);
            error.psnr_others_db.unwrap_or(f64::INFINITY)
        });
        let least = if word == 32 { 165.0 } else { 115.0 };
        assert!(decibels.iter().all(|&found| found >= least), "{name}, {word} bits: {decibels:?}");
    }
}
