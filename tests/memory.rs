//! Memory of the host that a picture of a large scene takes. This test is alone in its process: it counts what is allocated.

use kernels::KernelSet;
use lancer::drawing::{self, Comparison};
use lancer::job::Job;
use peak_alloc::PeakAlloc;
use scenes::generate;
use scenes::kdtree::Depth;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Octets of global memory per octet that may be allocated at any time, from the scene on: scene, tree, memory image, machine and
/// reference together.
const MOST: f64 = 3.0;

#[test]
fn a_picture_takes_at_most_three_times_its_memory_image() {
    let options =
        generate::GenerateOptions { triangles: Some(150_000), size: (16, 12), ..generate::GenerateOptions::default() };
    let before = ALLOCATOR.current_usage();
    ALLOCATOR.reset_peak_usage();
    let mut job = Job::new(generate::scene("terrain", &options).expect("the terrain has any number of triangles"));
    job.kernels.profile = KernelSet::Ray;
    job.kd_depth = Some(Depth::Auto);
    let drawing =
        drawing::draw(&job, Comparison::Reference, &mut |_| {}).unwrap_or_else(|failure| panic!("{failure:?}"));
    let image = drawing.frame.memory.size();
    assert!(image > 8 << 20, "what does not grow with the scene must not matter: {image} octets");
    let ratio = (ALLOCATOR.peak_usage() - before) as f64 / image as f64;
    assert!(ratio < MOST, "{ratio:.2} times the memory image of {image} octets");
}
