//! Time to build a kd tree, by size, depth and method: `cargo bench -p lancer-scenes --bench kdtree`.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use scenes::generate;
use scenes::image::{self, MemoryOptions};
use scenes::kdtree::{self, BuildMethod, Depth};
use scenes::model::View;

fn trees(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("kdtree");
    group.sample_size(10).measurement_time(Duration::from_secs(20));
    for count in [60_000, 1_000_000] {
        let options = generate::GenerateOptions { triangles: Some(count), ..generate::GenerateOptions::default() };
        let scene = generate::scene("terrain", &options).expect("the terrain has any number of triangles");
        let image =
            image::build(&scene, &View::new(scene.size), &MemoryOptions::default()).expect("the terrain fits the grid");
        let contents = image.decode().expect("an image can be read back");
        let triangles: Vec<_> = contents.triangles.iter().map(|triangle| triangle.vertices).collect();
        let ways = [
            ("16 levels, by box", Depth::Levels(16), BuildMethod::Report),
            ("automatic, by box", Depth::Auto, BuildMethod::Report),
            ("automatic, by part", Depth::Auto, BuildMethod::Exact),
            ("automatic, by bins", Depth::Auto, BuildMethod::Binned),
        ];
        for (name, depth, method) in ways {
            group.bench_with_input(BenchmarkId::new(name, count), &triangles, |bencher, triangles| {
                bencher.iter(|| kdtree::build(black_box(triangles), image.bounds, depth, method));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, trees);
criterion_main!(benches);
