//! A ray against packets, a triangle of nanoseconds: `cargo bench --bench packet`. The row `rnear` on each engine, the same search in Rust, and
//! one triangle after the other in Rust, for packets of several sizes. All find the same hits; medians are printed.

use std::hint::black_box;
use std::time::Instant;

use emu::engine::{EngineKind, Wish};
use emu::machine::Config;
use emu::machine::one_core::{OneCore, run_with};
use emu::octets::Memory;
use isa::number::ray::{PacketHit, PacketWords, Ray, TriangleEnd, ratio, triangle};
use isa::number::{Nearest32, Vector};
use isa::{Isa, Program};
use messages::Source;
use random::SplitMix64;

const RAYS: usize = 20_000;
const RUNS: usize = 7;
const SIZES: [usize; 5] = [1, 3, 4, 8, 64];

/// Fraction bits of t beyond those of a product with a direction of 16.
const SHIFT: u32 = 16;

/// Far beyond all triangles.
const NEVER: PacketHit = PacketHit { t: i32::MAX - 1, name: 0 };

type Vertices = [Vector; 3];

/// Name of a search, and the search: the sum of what it finds.
type PacketContender<'a> = (&'static str, Box<dyn Fn() -> i32 + 'a>);

/// Small triangles in a slab that rays cross.
fn triangles(count: usize) -> Vec<Vertices> {
    let mut random = SplitMix64::new(1);
    let mut unit = |most: i32| random.below(2 * most as u64) as i32 - most;
    let triangle = |_| {
        let corner = [unit(2 << 16), unit(2 << 16), unit(4 << 16)];
        let mut vertex = || [0, 1, 2].map(|k| corner[k] + unit(3 << 16));
        [corner, vertex(), vertex()]
    };
    (0..count).map(triangle).collect()
}

/// The ray of a number: they run side by side, as those of the pixels of a row.
fn ray(number: i32) -> Ray {
    Ray { origin: [0, 0, 12 << 16], direction: [number & 0x1fff, 0x1000 - (number >> 2 & 0x1fff), -65536] }
}

fn octets(triangles: &[Vertices]) -> Vec<u8> {
    let names = (1..).take(triangles.len());
    let words = (0..9).flat_map(|kind| triangles.iter().map(move |vertices| vertices.as_flattened()[kind]));
    names.chain(words).flat_map(i32::to_le_bytes).collect()
}

/// The sum of the distances that rays find.
fn program(octets: &[u8], count: usize) -> Program {
    // The rays are those of `ray`, from the last one to the first; s9 adds up the distances, as `sum_of` does.
    let text = format!(
        "
    li    s1, {RAYS}
    movi  s2, 0
    movi  s3, {count}
    li    s4, 12 << 16
    vput  v1, s4, 2
    li    s4, -65536
    vput  v2, s4, 2
    li    s5, {never}
    li    s6, 0x1fff
    li    s7, 0x1000
next:
    isubi s1, s1, 1
    and   s8, s1, s6
    vput  v2, s8, 0
    srai  s8, s1, 2
    and   s8, s8, s6
    isub  s8, s7, s8
    vput  v2, s8, 1
    vput  v3, s5, 0
    vput  v3, s0, 1
    rnear v3, v1, s2, s3, {SHIFT}
    vget  s8, v3, 0
    iadd  s9, s9, s8
    bnez  s1, next
    halt
",
        never = NEVER.t
    );
    let mut program = match asm::assemble(&Source::new("packet.s", text), &Isa::base(), &asm::Options::default()) {
        Ok(assembled) => assembled.program,
        Err(report) => panic!("{}", report.render(false)),
    };
    // The packet begins at address 0, where s2 points.
    program.buffer = octets.to_vec();
    program
}

fn main() {
    println!("{RAYS} rays, medians of {RUNS} runs on one thread, {}", emu::engine::HostSimd::best().name());
    let (isa, config) = (Isa::base(), Config::default());
    for count in SIZES {
        let triangles = triangles(count);
        let octets = octets(&triangles);
        let program = program(&octets, count);
        let sum_of = |search: &dyn Fn(&Ray) -> i32| {
            (0..RAYS as i32).fold(0i32, |sum, number| sum.wrapping_add(search(black_box(&ray(number)))))
        };
        let engine = |kind: EngineKind| {
            let wish = Wish { kind, is_eager: true, ..Wish::default() };
            let run = run_with(&OneCore::new(&config, &isa, &program), Memory::default(), wish).expect("it fits");
            // An engine may decline a program and leave it to the other one, whose time this is not.
            assert!(run.trap.is_none() && run.engine.kind == kind, "{:?} on {:?}", run.trap, run.engine);
            run.state.registers.scalar(9)
        };
        let packets = |ray: &Ray| PacketWords::new(&octets).nearest(&Nearest32, ray, SHIFT, NEVER).t;
        // One triangle after the other divides for each hit, the others only for those that may be the nearest.
        let singly = |ray: &Ray| {
            let hits =
                triangles.iter().map(|vertices| triangle(ray, vertices)).filter(|met| met.end == TriangleEnd::Hit);
            hits.map(|met| ratio(&Nearest32, met.t, met.determinant, SHIFT)).fold(NEVER.t, i32::min)
        };
        let contenders: [PacketContender; 4] = [
            ("triangle by triangle, Rust", Box::new(|| sum_of(&singly))),
            ("whole packet, Rust for any host", Box::new(|| sum_of(&packets))),
            ("rnear, native", Box::new(|| engine(EngineKind::Native))),
            ("rnear, checked", Box::new(|| engine(EngineKind::Checked))),
        ];
        // Time each, and take the median by triangle
        let mut sums = Vec::new();
        for (name, run) in contenders {
            let mut times: Vec<f64> = (0..RUNS)
                .map(|_| {
                    let start = Instant::now();
                    sums.push(run());
                    start.elapsed().as_secs_f64() * 1e9 / (RAYS * count) as f64
                })
                .collect();
            times.sort_by(f64::total_cmp);
            println!("{count:>3} triangles, {name:<32} {:>8.1} ns a triangle", times[RUNS / 2]);
        }
        assert!(sums.iter().all(|sum| *sum == sums[0]), "the sums differ: {sums:?}");
    }
}
