//! Pixels a second of each generated scene, in each profile, on each engine: `cargo bench --bench engines`, or a part of it by name, such as
//! `cargo bench --bench engines -- cornell/ray`. Everything is counted and nothing put on clocks; `lancer bench` has native code beside it.

use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use emu::engine::EngineKind;
use emu::machine::RunOptions;
use kernels::KernelSet;
use lancer::job::Job;
use lancer::load::Load;
use scenes::generate::{self, SCENES};

/// Width and height of the pictures.
const SIZE: (u32, u32) = (32, 24);

fn engines(criterion: &mut Criterion) {
    for generator in SCENES {
        let scene = generate::scene(
            generator.name,
            &generate::GenerateOptions { size: SIZE, ..generate::GenerateOptions::default() },
        );
        let scene = scene.expect("it is generated");
        for &profile in KernelSet::ALL {
            let mut job = Job::new(scene.clone());
            job.kernels.profile = profile;
            let (load, _) = Load::picture(&job).expect("it fits");
            let mut group = criterion.benchmark_group(format!("{}/{}", generator.name, profile.name()));
            group.sample_size(10).warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(2));
            group.throughput(Throughput::Elements(u64::from(SIZE.0 * SIZE.1)));
            for engine in EngineKind::ALL {
                let setup = load.setup(&job.machine, RunOptions { engine, ..RunOptions::default() });
                group.bench_function(BenchmarkId::from_parameter(engine.name()), |bencher| {
                    bencher.iter(|| emu::count(&setup, &load.memory).expect("it runs").expect("it is counted"));
                });
            }
            group.finish();
        }
    }
}

criterion_group!(benches, engines);
criterion_main!(benches);
