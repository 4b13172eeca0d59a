//! Figures 8 and 9: a machine and one of its coprocessors, as its file describes them.

use emu::machine::Config;
use isa::{Class, Counts};

use crate::chart::{ChartLine, DiagramBox, DiagramFigure, DiagramLink, Look};
use crate::numeral::count;

/// Cores that stand side by side; of more the first ones and the last.
const SHOWN: u32 = 6;

fn one(middle: (f64, f64), size: (f64, f64), look: Look, words: Vec<String>) -> DiagramBox {
    let tip = words.join(", ");
    DiagramBox { middle, size, words, look, is_around: false, tip }
}

fn line(points: Vec<(f64, f64)>, width: f64) -> DiagramLink {
    DiagramLink { points, look: Look::Muted, line: ChartLine::Solid, width, is_arrow: false }
}

/// A number of octets.
fn octets(number: u64) -> String {
    count(number, "octet", "octets")
}

/// A number of clocks.
fn clocks(number: u64) -> String {
    count(number, "clock", "clocks")
}

/// Octets and clocks of a transfer on the bus.
fn bus_words(config: &Config) -> Vec<String> {
    let bus = &config.bus;
    let beat = format!("{} in {}", octets(bus.octets_per_beat), clocks(bus.clocks_per_beat));
    let setup = (bus.setup_clocks != 0).then(|| format!("{} before", clocks(bus.setup_clocks)));
    let burst = (bus.burst_octets != 0).then(|| format!("bursts of {}", octets(bus.burst_octets)));
    let beat = [Some(beat), setup, burst].into_iter().flatten().collect::<Vec<_>>().join(", ");
    vec!["bus".to_owned(), format!("{beat}; arbiter {}", bus.arbiter.name())]
}

/// Figure 8: main processor, cores, bus and memory.
pub fn machine(name: &str, config: &Config) -> DiagramFigure {
    // Choose the cores that are shown: of 16 these are 0 to 4 and 15, with the title `.. core 15`
    let numbers: Vec<u32> = match config.cores <= SHOWN {
        true => (0..config.cores).collect(),
        false => (0..SHOWN - 1).chain([config.cores - 1]).collect(),
    };
    let (bus_y, core_y) = (0.24, 0.42);
    let pitch = 1.0 / numbers.len() as f64;
    // Put main processor and memory above the bus; all places are in widths of the figure
    let mut boxes = vec![one((0.5, bus_y), (1.0, 0.065), Look::Numbered(1), bus_words(config))];
    let traffic = if config.main.traffic { "its transfers use the bus" } else { "its transfers take no time" };
    let main = vec![
        "main processor".to_owned(),
        format!("buffer {}", octets(config.main.buffer_octets.into())),
        traffic.to_owned(),
    ];
    boxes.push(one((0.22, 0.07), (0.36, 0.1), Look::Numbered(0), main));
    let memory = vec![
        "global memory".to_owned(),
        "tree, references, triangles,".to_owned(),
        "materials, lights, frame".to_owned(),
    ];
    boxes.push(one((0.78, 0.07), (0.36, 0.1), Look::Numbered(2), memory));
    let mut links = vec![line(vec![(0.22, 0.07), (0.22, bus_y)], 1.5), line(vec![(0.78, 0.07), (0.78, bus_y)], 1.5)];
    // Hang the cores from the bus, side by side
    for (at, &number) in numbers.iter().enumerate() {
        let x = pitch * (at as f64 + 0.5);
        links.push(line(vec![(x, bus_y), (x, core_y)], 1.5));
        let is_gap = at > 0 && number != numbers[at - 1] + 1;
        let title = if is_gap { format!(".. core {number}") } else { format!("core {number}") };
        let words = vec![title, "buffer".to_owned(), octets(config.buffer_octets.into())];
        boxes.push(one((x, core_y), (pitch * 0.86, 0.11), Look::Numbered(0), words));
    }
    DiagramFigure {
        title: format!("Machine `{name}`: {} on one bus", count(config.cores.into(), "core", "cores")),
        note: format!(
            "{} MHz, words of {} bits (report 6, figure 8)",
            config.clock_hz as f64 / 1e6,
            config.arithmetic.word
        ),
        aspect: 0.5,
        links,
        boxes,
    }
}

/// Figure 9: the parts of one core.
pub fn coprocessor(name: &str, config: &Config) -> DiagramFigure {
    let timing = config.timing();
    let of_class = |class: Class| {
        let mut one = Counts::ZERO;
        one[class] = 1;
        format!("{}: {}", class.name(), clocks(timing.clocks(&one).0))
    };
    // Say in words what each part of a core is on this machine
    let arithmetic = &config.arithmetic;
    let modes = format!("{} bits, {}, {}", arithmetic.word, arithmetic.quantization, arithmetic.overflow);
    let elementary: Vec<String> =
        Class::ALL.iter().filter(|class| class.is_elementary()).map(|&class| of_class(class)).collect();
    let mut units = vec!["arithmetic".to_owned(), modes];
    units.extend(elementary);
    let registers =
        ["registers", "scalars s0 to s31", "vectors v0 to v31", "wide w0 to w7"].map(str::to_owned).to_vec();
    let ray =
        vec!["ray unit".to_owned(), format!("{} at once", count(config.packet_lanes.into(), "triangle", "triangles"))];
    let buffer = vec![
        "local buffer".to_owned(),
        octets(config.buffer_octets.into()),
        "nodes, triangles, ray tree,".to_owned(),
        "materials, lights".to_owned(),
    ];
    let cache = match config.cache.octets {
        0 => vec!["no cache".to_owned()],
        size => vec![
            "cache".to_owned(),
            format!("{} for {}", octets(size.into()), config.cache.kind),
            format!("lines of {}", config.cache.line_octets),
        ],
    };
    let port = vec![
        "bus port".to_owned(),
        if config.bus.overlap { "computes while it loads".to_owned() } else { "waits for its transfers".to_owned() },
    ];
    // Place the parts in a frame, which leaves the bus below it
    let frame =
        DiagramBox { is_around: true, ..one((0.5, 0.21), (0.98, 0.42), Look::Muted, vec!["coprocessor".to_owned()]) };
    let boxes = vec![
        frame,
        one((0.18, 0.16), (0.28, 0.19), Look::Numbered(0), units),
        one((0.5, 0.11), (0.26, 0.1), Look::Numbered(0), registers),
        one((0.5, 0.23), (0.26, 0.07), Look::Numbered(0), ray),
        one((0.82, 0.13), (0.28, 0.13), Look::Numbered(2), buffer),
        one((0.82, 0.27), (0.28, 0.09), Look::Numbered(2), cache),
        one((0.5, 0.36), (0.5, 0.07), Look::Numbered(1), port),
        one((0.5, 0.48), (1.0, 0.065), Look::Numbered(1), bus_words(config)),
    ];
    // Join units, registers, ray unit and buffer, and these by way of cache and port to the bus
    let links = vec![
        line(vec![(0.18, 0.11), (0.82, 0.11)], 1.2),
        line(vec![(0.5, 0.11), (0.5, 0.23)], 1.2),
        line(vec![(0.82, 0.13), (0.82, 0.36), (0.5, 0.36)], 1.2),
        line(vec![(0.5, 0.36), (0.5, 0.48)], 1.5),
    ];
    DiagramFigure {
        title: format!("A coprocessor of the machine `{name}`"),
        note: "It follows the rays of a pixel by itself, from its first packet on (report 6, figure 9)".to_owned(),
        aspect: 0.53,
        links,
        boxes,
    }
}
