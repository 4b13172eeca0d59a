//! Writes docs/measured.md, the page of figures that depend on a host and a day: each with the host, the commit and the command line that
//! gave it. `cargo bench --bench measured` measures all of its parts, `cargo bench --bench measured -- build pictures` those that are named; the
//! others stay as they are.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// A section of the page.
struct Part {
    /// Name on the command line.
    name: &'static str,
    /// Heading.
    title: &'static str,
    /// Sentences before the figures.
    about: &'static str,
    /// Lines of commands; `lancer` is the program of this build.
    commands: &'static [&'static str],
}

/// The sections but that of the build.
const PARTS: &[Part] = &[
    Part {
        name: "pictures",
        title: "Pictures",
        about: "Engines beside the native twin and double precision, one host thread and two.",
        commands: &[
            "lancer bench --profiles ray,vector,packet,report",
            "lancer bench --profiles ray,packet --threads 2",
        ],
    },
    Part {
        name: "growth",
        title: "Growth",
        about: "The same picture with sixteen times as many pixels, and landscapes of ten times as many triangles; numbers of cores are among the parts `replay` and `cores`.",
        commands: &[
            "lancer bench cornell --profiles packet --runs 3 --size 80x60",
            "lancer bench cornell --profiles packet --runs 3 --size 320x240",
            "lancer scene generate terrain --triangles 1000 -o target/growth-3",
            "lancer scene generate terrain --triangles 10000 -o target/growth-4",
            "lancer scene generate terrain --triangles 100000 -o target/growth-5",
            "lancer bench target/growth-3/terrain.dsc target/growth-4/terrain.dsc target/growth-5/terrain.dsc --profiles packet --runs 3",
        ],
    },
    Part {
        name: "demo",
        title: "First picture",
        about: "The demo, which draws the Cornell box in 320 x 240 pixels and measures it.",
        commands: &["lancer"],
    },
    Part {
        name: "replay",
        title: "Replay",
        about: "Recorded transfers a second on one host thread, by machine and number of cores.",
        commands: &["cargo bench --bench replay -- cornell"],
    },
    Part {
        name: "cores",
        title: "Machines with several numbers of cores",
        about: "All clocks of a picture of 640 x 480 pixels, with one core and with four.",
        commands: &["lancer cores cornell --size 640x480 --cores 1,4 --machine report"],
    },
    Part {
        name: "loops",
        title: "Loops",
        about: "The intersection loop by itself beside native code, and instructions of extensions.",
        commands: &["cargo bench --bench intersection", "cargo bench --bench extension"],
    },
    Part {
        name: "peers",
        title: "Loops, beside other emulators",
        about: "The intersection loop on lancer, on qemu-riscv64 and on wasmi, in turns.",
        commands: &["benches/peers/run.sh"],
    },
    Part {
        name: "tracer",
        title: "Pictures, beside a ray tracer without emulation",
        about: "CPU time of whole processes: a plain tracer in C++, and `lancer render --no-error` as multiples of it.",
        commands: &["benches/peers/tracer.sh"],
    },
    Part {
        name: "trees",
        title: "Trees",
        about: "Building kd trees: the default one beside the report's, and landscapes by method.",
        commands: &["cargo bench --workspace --bench kdtree -- default", "cargo bench --workspace --bench kdtree"],
    },
    Part {
        name: "fuzzing",
        title: "Fuzzing",
        about: "Inputs that nobody wrote, on one host thread: runs and rates of each surface, and lines of each reader that they execute.",
        commands: &["fuzz/run --time 600", "fuzz/run --self-check", "fuzz/run --coverage"],
    },
    Part {
        name: "faults",
        title: "Faults on purpose",
        about: "Vulnerability of the three most vulnerable structures, without protection and with a code that corrects.",
        commands: &[
            "lancer inject cornell --size 48x36 --kind program,memory,bus --injections 100000 --timing",
            "lancer inject cornell --size 48x36 --kind program,memory,bus --injections 100000 --protect program=ecc,memory=ecc,bus=ecc",
            "lancer inject slabs --size 48x36 --kind program,memory,bus --injections 100000 --timing",
            "lancer inject slabs --size 48x36 --kind program,memory,bus --injections 100000 --protect program=ecc,memory=ecc,bus=ecc",
        ],
    },
    Part {
        name: "endurance",
        title: "Trials that take long",
        about: "Runs that are killed while they write, and the same run under other circumstances.",
        commands: &["env LANCER_RUNS=1000 cargo test -p lancer --test endurance -- --nocapture"],
    },
];

/// Changes to the release build, each of which undoes one lever or leaves out a feature: what it is called, and arguments of `cargo build`.
///
/// An argument with `=` is a key of Cargo's configuration and follows `--config`.
const LEVERS: &[(&str, &[&str])] = &[
    ("as it is", &[]),
    ("without native code", &["--no-default-features", "--features", "cli"]),
    ("the library alone", &["--no-default-features", "--lib"]),
    (
        "line tables, nothing stripped",
        &["profile.release.debug=\"line-tables-only\"", "profile.release.strip=\"none\""],
    ),
    ("panics that unwind", &["profile.release.panic=\"unwind\""]),
    ("everything at opt-level 3 but what prints", &["profile.release.opt-level=3"]),
    ("everything that has no line of its own made small", &["profile.release.opt-level=\"s\""]),
    // Flags of one's own mean that the linker is not asked for more than that (`build.rs`).
    ("functions whose code is the same", &["build.rustflags=[\"-Cdebuginfo=0\"]"]),
    (
        "what prints at opt-level 1",
        &[
            "profile.release.package.annotate-snippets.opt-level=1",
            "profile.release.package.image.opt-level=1",
            "profile.release.package.schemars.opt-level=1",
        ],
    ),
    (
        "colour management at opt-level 3",
        &["profile.release.package.moxcms.opt-level=3", "profile.release.package.pxfm.opt-level=3"],
    ),
    ("one codegen unit", &["profile.release.codegen-units=1"]),
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Output of a command; its words stand between blanks.
fn output(line: &str) -> Result<String, String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let program = if words[0] == "lancer" { env!("CARGO_BIN_EXE_lancer") } else { words[0] };
    let output = Command::new(program).args(&words[1..]).current_dir(root()).output();
    let output = output.map_err(|error| format!("{line}: {error}"))?;
    let text = |octets: &[u8]| String::from_utf8_lossy(octets).trim_end().to_owned();
    match output.status.success() {
        true => Ok(text(&output.stdout)),
        false => Err(format!("{line}: {}", text(&output.stderr))),
    }
}

/// Host, compiler and commit, in a line.
fn host() -> String {
    let cpus = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpus.lines().find_map(|line| line.strip_prefix("model name")?.split(": ").nth(1).map(str::to_owned));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let load = load.split(' ').next().unwrap_or("?").to_owned();
    let said = |line: &str| output(line).unwrap_or_else(|_| "?".into());
    let day = said("git show --no-patch --format=%cs HEAD");
    format!(
        "{}, {threads} threads, load before {load}; {}; commit {} of {day}",
        model.unwrap_or_else(|| "unknown processor".into()),
        said("rustc --version"),
        said("git rev-parse --short=10 HEAD"),
    )
}

/// CPU seconds of all commands that have ended; `None` where the system does not tell.
fn cpu_seconds() -> Option<f64> {
    // Behind the name, which ends with `)` and is field 2: fields 16 and 17 of proc(5) are ticks of children in user and system mode.
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = stat.rsplit(") ").next()?.split(' ').collect();
    let ticks = |number: usize| fields.get(number - 3)?.parse::<u64>().ok();
    Some((ticks(16)? + ticks(17)?) as f64 / 100.0)
}

/// The commands of a part with what they print.
fn part(part: &Part) -> Result<String, String> {
    let mut text = format!("{}\n\n{}.\n", part.about, host());
    for command in part.commands {
        let start = Instant::now();
        let printed = output(command)?;
        let seconds = start.elapsed().as_secs_f64();
        let _ = write!(text, "\n```console\n$ {command}    # {seconds:.1} s\n{printed}\n```\n");
    }
    Ok(text)
}

/// A table of builds from nothing, each with one lever undone.
fn build() -> Result<String, String> {
    let mut text = format!(
        "`cargo build --release` from nothing, each line with one lever of `Cargo.toml` undone by `--config`, or without a feature.\n\n{}.\n\n\
         | build | seconds | CPU seconds | MB |\n|---|---|---|---|\n",
        host()
    );
    let target = root().join("target/measured");
    for (name, changes) in LEVERS {
        let _ = std::fs::remove_dir_all(&target);
        let mut command = Command::new("cargo");
        command.args(["build", "--release", "--quiet", "--package", "lancer", "--target-dir"]).arg(&target);
        for change in *changes {
            command.args(change.contains('=').then_some("--config").into_iter().chain([*change]));
        }
        let (start, before) = (Instant::now(), cpu_seconds());
        let status = command.current_dir(root()).status().map_err(|error| error.to_string())?;
        if !status.success() {
            return Err(format!("{name}: the build fails"));
        }
        let cpu =
            cpu_seconds().zip(before).map_or_else(|| "-".into(), |(after, before)| format!("{:.0}", after - before));
        let size = std::fs::metadata(target.join("release/lancer"))
            .map_or_else(|_| "-".into(), |file| format!("{:.1}", file.len() as f64 / 1e6));
        let seconds = start.elapsed().as_secs_f64();
        let _ = writeln!(text, "| {name} | {seconds:.0} | {cpu} | {size} |");
    }
    let _ = std::fs::remove_dir_all(&target);
    Ok(text)
}

/// The page with a section in the place of the one of its title, or at its end.
fn with_section(page: &str, title: &str, section: &str) -> String {
    let mut parts: Vec<String> = page.split("\n## ").map(str::to_owned).collect();
    let new = format!("{title}\n{section}");
    match parts.iter_mut().skip(1).find(|part| part.lines().next() == Some(title)) {
        Some(part) => *part = new,
        None => parts.push(new),
    }
    let parts: Vec<&str> = parts.iter().map(|part| part.trim_end()).collect();
    parts.join("\n\n## ") + "\n"
}

fn main() -> Result<(), String> {
    let named: Vec<String> = std::env::args().skip(1).filter(|name| !name.starts_with("--")).collect();
    let is_wanted = |name: &str| named.is_empty() || named.iter().any(|one| one == name);
    let path: PathBuf = root().join("docs/measured.md");
    let mut page = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut sections: Vec<(&str, String)> = Vec::new();
    if is_wanted("build") {
        sections.push(("Build", build()?));
    }
    for one in PARTS.iter().filter(|part| is_wanted(part.name)) {
        sections.push((one.title, part(one)?));
    }
    if sections.is_empty() {
        return Err(format!("parts are build, {}", PARTS.iter().map(|part| part.name).collect::<Vec<_>>().join(", ")));
    }
    for (title, section) in sections {
        page = with_section(&page, title, &section);
    }
    std::fs::write(&path, page).map_err(|error| format!("{}: {error}", path.display()))
}
