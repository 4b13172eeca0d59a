//! How long a kd tree takes, by size, depth and method: `cargo bench -p scenes --bench kdtree`.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use scenes::generate;
use scenes::image::{self, Options};
use scenes::kdtree::{self, Depth, Method};
use scenes::model::View;

fn trees(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("kdtree");
    group.sample_size(10).measurement_time(Duration::from_secs(20));
    for count in [60_000, 1_000_000] {
        let options = generate::Options { triangles: Some(count), ..generate::Options::default() };
        let scene = generate::scene("terrain", &options).expect("the terrain has any number of triangles");
        let image =
            image::build(&scene, &View::new(scene.size), &Options::default()).expect("the terrain fits the grid");
        let contents = image.decode().expect("an image can be read back");
        let triangles: Vec<_> = contents.triangles.iter().map(|triangle| triangle.vertices).collect();
        let ways = [
            ("16 levels, by box", Depth::Levels(16), Method::Report),
            ("automatic, by box", Depth::Auto, Method::Report),
            ("automatic, by part", Depth::Auto, Method::Exact),
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
