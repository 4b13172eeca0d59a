//! One loop of ray-triangle tests, 4096 triangles a ray, by the engines and by native code: `cargo bench --bench intersection`. Numbers are
//! Q16.16 and each result is rounded, in the textbook form that leaves a test early (branchy), with one combined rejection (lean), and with
//! the ray-triangle instruction, whose native twin is exact. All give the same checksum; they take turns, and medians are printed. Words
//! behind `--` choose forms and engines: `rtri lancer`.

use std::time::Instant;

use emu::engine::EngineKind;
use emu::machine::{Config, RunOptions, Setup};
use emu::octets::Memory;
use isa::number::ray::{Ray, TriangleEnd, ratio, triangle};
use isa::number::{Arithmetic, Nearest32, Vector};
use isa::{Isa, Program};
use messages::Source;

const RAYS: usize = 64;
const TRIANGLES: usize = 4096;
const RUNS: usize = 9;

/// Octets of the answers, then rays and triangles of nine words each.
const ANSWERS: usize = 4 * RAYS;
const RECORD: usize = 36;

/// The main processor sends each ray's number and stores what comes back; no more cores than rays are given one.
const DISPATCH: &str = "
.entry dispatch
dispatch:
    cores s3
    li    s2, RAYS
    min   s3, s3, s2
next:
    bge   s1, s3, wait
    mov   s6, s1
    jump  send
wait:
    recv2 v8, s6
    vget  s7, v8, 0
    vget  s8, v9, 0
    slli  s7, s7, 2
    stw   s8, (s7)
send:
    li    s2, RAYS
    bge   s1, s2, drain
    vsplat v0, s1
    send5 s6, v0
    iaddi s1, s1, 1
    jump  next
drain:
    isubi s3, s3, 1
    beqz  s3, done
    recv2 v8, s6
    vget  s7, v8, 0
    vget  s8, v9, 0
    slli  s7, s7, 2
    stw   s8, (s7)
    jump  drain
done:
    halt
";

/// A core's work item: ray v1, v2 against triangles v6 (corner), v7 and v8 (edges; for `rtri` vertices); s5 is the checksum.
fn item(body: &str) -> String {
    format!(
        "
.entry item
item:
    recv5 v0, s20
    vget  s22, v0, 0
    li    s1, ANSWERS
    element s1, s1, s22, 36
    ldv3  v1, (s1)
    li    s2, FIRST
    li    s3, LAST
    movi  s5, 0
    li    s4, 0x7fffffff
next:
    ldv3  v6, (s2)
{body}
skip:
    lea   s2, 36(s2)
    bltu  s2, s3, next
    mov   s21, s22
    vsplat v6, s21
    vsplat v7, s5
    send2 s20, v6
    halt
"
    )
}

const BRANCHY: &str = "
    vcross v9, v2, v8, 16
    vdot  s6, v7, v9, 16
    blez  s6, skip
    vsub  v10, v1, v6
    vdot  s7, v10, v9, 16
    bltz  s7, skip
    blt   s6, s7, skip
    vcross v11, v10, v7, 16
    vdot  s8, v2, v11, 16
    bltz  s8, skip
    iadd  s9, s7, s8
    blt   s6, s9, skip
    vdot  s10, v8, v11, 16
    blez  s10, skip
    div   s10, s10, s6, 16
    iadd  s5, s5, s10
";

const LEAN: &str = "
    vcross v9, v2, v8, 16
    vdot  s6, v7, v9, 16
    vsub  v10, v1, v6
    vdot  s7, v10, v9, 16
    vcross v11, v10, v7, 16
    vdot  s8, v2, v11, 16
    vdot  s10, v8, v11, 16
    isub  s9, s6, s7
    isub  s9, s9, s8
    isubi s11, s6, 1
    isubi s12, s10, 1
    or    s11, s11, s12
    or    s11, s11, s7
    or    s11, s11, s8
    or    s11, s11, s9
    bltz  s11, skip
    div   s10, s10, s6, 16
    iadd  s5, s5, s10
";

const INSTRUCTION: &str = "
    rtri  s10, v9, v1, v6, 16
    beq   s10, s4, skip
    iadd  s5, s5, s10
";

type Record = [Vector; 3];

fn cross(a: Vector, b: Vector) -> Vector {
    let minor = |j: usize, k: usize| {
        Nearest32.narrow64(i64::from(a[j]) * i64::from(b[k]) - i64::from(a[k]) * i64::from(b[j]), 16)
    };
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn dot(a: Vector, b: Vector) -> i32 {
    Nearest32.narrow_products([0, 1, 2].map(|k| i64::from(a[k]) * i64::from(b[k])), 16)
}

fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| Nearest32.narrow64(i64::from(a[k]) - i64::from(b[k]), 0))
}

fn quotient(t: i32, determinant: i32) -> i32 {
    Nearest32.quotient(i128::from(t) << 16, determinant.into())
}

fn branchy(&[origin, direction, _]: &Record, &[corner, edge1, edge2]: &Record) -> i32 {
    let p = cross(direction, edge2);
    let determinant = dot(edge1, p);
    if determinant <= 0 {
        return 0;
    }
    let start = minus(origin, corner);
    let u = dot(start, p);
    if u < 0 || u > determinant {
        return 0;
    }
    let q = cross(start, edge1);
    let v = dot(direction, q);
    if v < 0 || u.wrapping_add(v) > determinant {
        return 0;
    }
    let t = dot(edge2, q);
    if t <= 0 { 0 } else { quotient(t, determinant) }
}

fn lean(&[origin, direction, _]: &Record, &[corner, edge1, edge2]: &Record) -> i32 {
    let p = cross(direction, edge2);
    let determinant = dot(edge1, p);
    let start = minus(origin, corner);
    let u = dot(start, p);
    let q = cross(start, edge1);
    let (v, t) = (dot(direction, q), dot(edge2, q));
    let w = determinant.wrapping_sub(u).wrapping_sub(v);
    let rejects = determinant.wrapping_sub(1) | t.wrapping_sub(1) | u | v | w;
    if rejects < 0 { 0 } else { quotient(t, determinant) }
}

fn exact(&[origin, direction, _]: &Record, vertices: &Record) -> i32 {
    let met = triangle(&Ray { origin, direction }, vertices);
    match met.end {
        TriangleEnd::Hit => ratio(&Nearest32, met.t, met.determinant, 16),
        _ => 0,
    }
}

/// Small triangles in a slab, as corner and edges or as vertices, and rays across it.
fn records(as_vertices: bool) -> (Vec<Record>, Vec<Record>) {
    let mut state = 1u64;
    let mut unit = |from: f64, to: f64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((from + (state >> 40) as f64 / (1u64 << 24) as f64 * (to - from)) * 65536.0) as i32
    };
    let triangles = (0..TRIANGLES).map(|_| {
        let corner = [unit(-8.0, 8.0), unit(-8.0, 8.0), unit(-4.0, 4.0)];
        let edges = [0, 1].map(|_| [unit(-3.0, 3.0), unit(-3.0, 3.0), unit(-1.0, 1.0)]);
        let vertex = |edge: Vector| [0, 1, 2].map(|k| corner[k] + edge[k]);
        if as_vertices { [corner, vertex(edges[0]), vertex(edges[1])] } else { [corner, edges[0], edges[1]] }
    });
    let triangles = triangles.collect();
    // Rays of neighbouring pixels.
    let ray = |at: usize| {
        let (x, y) = (at as i32 % 8 * 2000, at as i32 / 8 * 2000);
        [[x, y, 12 << 16], [x / 16, y / 16, -65536], [0; 3]]
    };
    ((0..RAYS).map(ray).collect(), triangles)
}

fn program(text: &str) -> Program {
    let first = ANSWERS + RAYS * RECORD;
    let defines = [("RAYS", RAYS), ("ANSWERS", ANSWERS), ("FIRST", first), ("LAST", first + TRIANGLES * RECORD)];
    let options = asm::Options {
        defines: defines.iter().map(|&(name, value)| (name.to_owned(), value as i64)).collect(),
        ..asm::Options::default()
    };
    match asm::assemble(&Source::new("intersection.s", text.to_owned()), &Isa::base(), &options) {
        Ok(assembled) => assembled.program,
        Err(report) => panic!("{}", report.render(false)),
    }
}

struct Contender<'a> {
    name: String,
    run: Box<dyn Fn() -> i32 + 'a>,
    times: Vec<f64>,
}

fn main() {
    let (isa, config, main) = (Isa::base(), Config::default(), program(DISPATCH));
    println!(
        "{RAYS} rays x {TRIANGLES} triangles, medians of {RUNS} runs on one thread, {}",
        emu::engine::HostSimd::best().name()
    );
    // Cores of the machine would share the host's threads, and native code has one.
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("it is the first pool");
    let forms = [
        ("branchy", BRANCHY, branchy as fn(&Record, &Record) -> i32),
        ("lean", LEAN, lean),
        ("rtri", INSTRUCTION, exact),
    ];
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    // With `-- rtri lancer` the form is `rtri` and the engine `lancer`; without a word for a form all are asked for, and so with engines.
    let is_asked = |names: &[&str], name: &str| {
        let mut words = words.iter().filter(|word| names.contains(&word.as_str())).peekable();
        words.peek().is_none() || words.any(|word| word == name)
    };
    for (form, body, native) in forms.into_iter().filter(|(form, ..)| is_asked(&forms.map(|form| form.0), form)) {
        let (rays, triangles) = records(form == "rtri");
        let core = program(&item(body));
        let words = rays.iter().chain(&triangles).flatten().flatten();
        let mut image = vec![0; ANSWERS];
        image.extend(words.flat_map(|word: &i32| word.to_le_bytes()));
        let memory = Memory::new(image);
        let engine = |engine: EngineKind| {
            let (config, isa, core, main, memory) = (&config, &isa, &core, &main, &memory);
            move || {
                let options = RunOptions { engine, ..RunOptions::default() };
                let setup = Setup { config, isa, core, main, kinds: Vec::new(), options };
                let count = emu::count(&setup, memory).expect("it runs").expect("it is counted");
                (0..RAYS as u32).fold(0i32, |sum, ray| sum.wrapping_add(count.memory.word(4 * ray).expect("an answer")))
            }
        };
        let natively = || {
            let one =
                |ray: &Record| triangles.iter().fold(0i32, |sum, triangle| sum.wrapping_add(native(ray, triangle)));
            rays.iter().fold(0i32, |sum, ray| sum.wrapping_add(one(std::hint::black_box(ray))))
        };
        let mut contenders: Vec<Contender> = vec![
            Contender { name: "native".into(), run: Box::new(natively), times: Vec::new() },
            Contender { name: "lancer".into(), run: Box::new(engine(EngineKind::Native)), times: Vec::new() },
            Contender { name: "checked".into(), run: Box::new(engine(EngineKind::Checked)), times: Vec::new() },
        ];
        let names: Vec<String> = contenders.iter().map(|contender| contender.name.clone()).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        // Native code runs in any case, since times are told as multiples of its own.
        contenders.retain(|contender| contender.name == "native" || is_asked(&names, &contender.name));
        let mut sums = Vec::new();
        // Contenders take turns, so that a slow moment of the host meets all of them.
        for _ in 0..RUNS {
            for contender in &mut contenders {
                let start = Instant::now();
                sums.push((contender.run)());
                contender.times.push(start.elapsed().as_secs_f64());
            }
        }
        assert!(sums.iter().all(|sum| *sum == sums[0]), "{form}: the checksums differ: {sums:?}");
        let median = |times: &[f64]| {
            let mut times = times.to_vec();
            times.sort_by(f64::total_cmp);
            times[times.len() / 2] * 1e9 / (RAYS * TRIANGLES) as f64
        };
        println!("{form:<8} checksum {}", sums[0]);
        let base = median(&contenders[0].times);
        for contender in &contenders {
            let time = median(&contender.times);
            println!("{form:<8} {:<18} {time:>7.2} ns a test {:>6.2} of native", contender.name, time / base);
        }
    }
}
