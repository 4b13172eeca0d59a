//! Time to build a kd tree, by size, depth and method: `cargo bench -p lancer-scenes --bench kdtree`; with `-- default` that of the default tree instead,
//! in times of the report's.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, criterion_group};
use scenes::generate;
use scenes::image::{self, MemoryOptions};
use scenes::kdtree::{self, Bounds, BuildMethod, Depth};
use scenes::model::View;

/// Scenes at the sizes that they have by themselves.
const FIVE: [&str; 5] = ["cornell", "sphereflake", "slabs", "mirrors", "terrain"];

/// Triangles of a generated scene on the grid, and the box of its tree.
fn mesh(name: &str, triangles: Option<u32>) -> (Vec<[[i32; 3]; 3]>, Bounds) {
    let options = generate::GenerateOptions { triangles, ..generate::GenerateOptions::default() };
    let scene = generate::scene(name, &options).expect("a generated scene of so many triangles");
    let image = image::build(&scene, &View::new(scene.size), &MemoryOptions::default()).expect("it fits the grid");
    let contents = image.decode().expect("an image can be read back");
    (contents.triangles.iter().map(|triangle| triangle.vertices).collect(), image.bounds)
}

/// Prints the time of the default tree and that of the report's, both built in turns by one thread. Where others use the host as well, most turns are
/// interrupted; the fastest tenth is not.
fn default_tree() {
    println!(
        "a tenth of the builds, on one thread, takes at most: ms by default, ms of the report's with 16 levels, quotient"
    );
    for (name, count) in FIVE.map(|name| (name, None)).into_iter().chain([("terrain", Some(1_000_000))]) {
        let (triangles, bounds) = mesh(name, count);
        let milliseconds = |depth, method| {
            let start = Instant::now();
            let _ = black_box(kdtree::build(black_box(&triangles), bounds, depth, method));
            start.elapsed().as_secs_f64() * 1e3
        };
        let turns = (6_000_000 / triangles.len()).clamp(11, 1001);
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..turns {
            times[0].push(milliseconds(Depth::Auto, BuildMethod::Binned));
            times[1].push(milliseconds(Depth::Levels(16), BuildMethod::Report));
        }
        let [default, report] = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            times[turns / 10]
        });
        println!("{name:12} {:9} triangles {default:10.3} {report:10.3} {:6.2}", triangles.len(), default / report);
    }
}

fn trees(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("kdtree");
    group.sample_size(10).measurement_time(Duration::from_secs(20));
    for count in [60_000, 1_000_000] {
        let (triangles, bounds) = mesh("terrain", Some(count));
        let ways = [
            ("16 levels, by box", Depth::Levels(16), BuildMethod::Report),
            ("automatic, by box", Depth::Auto, BuildMethod::Report),
            ("automatic, by part", Depth::Auto, BuildMethod::Exact),
            ("automatic, by bins", Depth::Auto, BuildMethod::Binned),
        ];
        for (name, depth, method) in ways {
            group.bench_with_input(BenchmarkId::new(name, count), &triangles, |bencher, triangles| {
                bencher.iter(|| kdtree::build(black_box(triangles), bounds, depth, method));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, trees);

fn main() {
    if std::env::args().any(|argument| argument == "default") {
        // On the pool's only thread, so that none waits for another one.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
        return pool.install(default_tree);
    }
    benches();
    Criterion::default().configure_from_args().final_summary();
}
