//! Recorded transfers that a machine replays on one host thread in a second: `cargo bench --bench replay`. The time is
//! the least of many runs, so that other work on the host disturbs it little. Words behind `--` choose: `cornell report`.

use std::time::{Duration, Instant};

use emu::machine::arbiter::ArbiterKind;
use emu::machine::preset::PRESETS;
use emu::machine::{Config, RunOptions};
use emu::replay::Recorded;
use lancer::job::Job;
use lancer::load::Load;
use scenes::generate;

const RUNS: u32 = 40;

fn main() {
    let scene = generate::scene("cornell", &generate::GenerateOptions { size: (96, 72), ..Default::default() });
    let picture = Load::picture(&Job::new(scene.expect("it is generated"))).expect("it fits").0;
    let annex = Load::annex().expect("it assembles");
    println!(
        "{:<10} {:<14} {:<15} {:>5} {:>10} {:>14}",
        "load", "machine", "arbiter", "cores", "transfers", "millions a s"
    );
    for (name, load) in [("annex", &annex), ("cornell", &picture)] {
        for preset in PRESETS {
            measure(name, load, preset.name, &preset.config(), &[1, 4, 8, 16]);
        }
        for arbiter in ArbiterKind::ALL {
            let mut config = Config::default();
            config.bus.arbiter = arbiter;
            measure(name, load, "report", &config, &[4]);
        }
    }
}

fn measure(name: &str, load: &Load, machine: &str, config: &Config, cores: &[u32]) {
    let mut asked = std::env::args().skip(1).filter(|asked| !asked.starts_with('-'));
    if !asked.all(|asked| [name, machine, config.bus.arbiter.name()].contains(&&*asked)) {
        return;
    }
    let mut config = config.clone();
    config.main.traffic = name != "annex";
    let options = RunOptions::default();
    let recorded = Recorded::new(&load.setup(&config, options), &load.memory).expect("it can be replayed");
    for &cores in cores {
        config.cores = cores;
        let (mut least, mut transfers) = (Duration::MAX, 0);
        for _ in 0..RUNS {
            let memory = load.memory.clone();
            let start = Instant::now();
            let frame =
                recorded.replay(&load.setup(&config, options), memory).expect("it runs").expect("it is replayed");
            least = least.min(start.elapsed());
            transfers = frame.bus.transfers;
        }
        let millions = transfers as f64 / least.as_secs_f64() / 1e6;
        let arbiter = config.bus.arbiter.name();
        println!("{name:<10} {machine:<14} {arbiter:<15} {cores:>5} {transfers:>10} {millions:>14.1}");
    }
}
