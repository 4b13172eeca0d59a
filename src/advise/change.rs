//! Changes of a machine or of its picture that are tried, each as the keys of a machine file or the options that a user would type.

use emu::machine::Config;
use emu::machine::arbiter::ArbiterKind;
use emu::machine::config::MOST_CORES;
use isa::{Class, Counts};
use kernels::KernelSet;
use messages::{Diagnostic, Report, Source};
use scenes::image::{MemoryImage, MemoryKind};
use scenes::kdtree::{BuildMethod, Depth};
use scenes::layout::Layout;
use toml::Value;

use crate::job::Job;
use crate::machine::arbiter_note;
use crate::numeral::grouped;
use crate::settings::key;
use crate::settings::named::NamedChoice;
use crate::sweep::study::Assignments;

/// Part of the machine or of the picture that a change is about. Two changes of one part cannot be made together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChangedPart {
    /// Octets of a beat.
    BusWidth,
    /// Length of bursts.
    Bursts,
    /// Cores that go on during their block loads.
    Overlap,
    /// The cores' caches.
    Cache,
    /// Number of cores.
    Cores,
    /// Order in which the bus is granted.
    Arbiter,
    /// Operations that run at once.
    Units,
    /// Clocks of an operation.
    Speed,
    /// Structures of global memory.
    Layout,
    /// Set of kernels.
    Kernels,
    /// Depth of the kd tree.
    TreeDepth,
    /// Membership of triangles in nodes of the kd tree.
    TreeMethod,
}

impl ChangedPart {
    /// Name in results.
    pub const fn name(self) -> &'static str {
        match self {
            ChangedPart::BusWidth => "bus-width",
            ChangedPart::Bursts => "bursts",
            ChangedPart::Overlap => "overlap",
            ChangedPart::Cache => "cache",
            ChangedPart::Cores => "cores",
            ChangedPart::Arbiter => "arbiter",
            ChangedPart::Units => "units",
            ChangedPart::Speed => "speed",
            ChangedPart::Layout => "layout",
            ChangedPart::Kernels => "kernels",
            ChangedPart::TreeDepth => "kd-depth",
            ChangedPart::TreeMethod => "kd-build",
        }
    }
}

/// An option of the command line that another picture in memory or other programs come of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureOption {
    /// `--layout`.
    Layout(Layout),
    /// `--profile`.
    Profile(KernelSet),
    /// `--kd-depth`.
    KdDepth(Depth),
    /// `--kd-build`.
    KdBuild(BuildMethod),
}

impl PictureOption {
    /// Name of the option and its value.
    fn parts(self) -> (&'static str, String) {
        match self {
            PictureOption::Layout(layout) => ("layout", layout.name().to_owned()),
            PictureOption::Profile(set) => ("profile", set.name().to_owned()),
            PictureOption::KdDepth(depth) => ("kd-depth", NamedChoice::name(&depth)),
            PictureOption::KdBuild(method) => ("kd-build", method.name().to_owned()),
        }
    }

    /// Words of a command line.
    pub fn words(self) -> String {
        let (option, value) = self.parts();
        format!("--{option} {value}")
    }

    /// Changes a job as the option would.
    pub fn apply(self, job: &mut Job) {
        match self {
            PictureOption::Layout(layout) => job.layout = Some(layout),
            PictureOption::Profile(set) => job.kernels.profile = set,
            PictureOption::KdDepth(depth) => job.kd_depth = Some(depth),
            PictureOption::KdBuild(method) => job.kd_method = Some(method),
        }
    }
}

/// One change, or two of different parts.
#[derive(Clone, Debug)]
pub struct Change {
    /// Parts that it changes.
    pub parts: Vec<ChangedPart>,
    /// Words for people: `8 octets a beat`.
    pub words: String,
    /// Keys of the machine file, with their new values.
    pub keys: Vec<(String, Value)>,
    /// Options beside it.
    pub options: Vec<PictureOption>,
}

impl Change {
    fn of_keys(part: ChangedPart, words: String, keys: &[(&str, Value)]) -> Change {
        let keys = keys.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
        Change { parts: vec![part], words, keys, options: Vec::new() }
    }

    fn of_option(part: ChangedPart, words: String, option: PictureOption) -> Change {
        Change { parts: vec![part], words, keys: Vec::new(), options: vec![option] }
    }

    /// Both changes; `None` where they change the same part.
    pub fn with(&self, other: &Change) -> Option<Change> {
        if self.parts.iter().any(|part| other.parts.contains(part)) {
            return None;
        }
        Some(Change {
            parts: [self.parts.as_slice(), &other.parts].concat(),
            words: format!("{} + {}", self.words, other.words),
            keys: [self.keys.as_slice(), &other.keys].concat(),
            options: [self.options.as_slice(), &other.options].concat(),
        })
    }

    /// Lines of a machine file: `bus.octets_per_beat = 8`.
    pub fn lines(&self) -> Vec<String> {
        self.keys.iter().map(|(key, value)| format!("{key} = {value}")).collect()
    }

    /// Keys of the settings with their new values.
    pub fn assignments(&self) -> Assignments {
        let of_machine = |(key, value): &(String, Value)| {
            (format!("machine.{key}"), serde_json::to_value(value).expect("keys of a machine hold no dates"))
        };
        let of_option = |option: &PictureOption| {
            let (option, value) = option.parts();
            (key::resolve(option).expect("an option sets a key"), value.into())
        };
        self.keys.iter().map(of_machine).chain(self.options.iter().map(of_option)).collect()
    }

    /// The machine with the keys changed.
    ///
    /// # Errors
    /// A machine that is out of its ranges.
    pub fn machine(&self, base: &Config) -> Result<Config, Report> {
        let mut table = toml::Table::try_from(base).expect("a machine has nothing that TOML cannot hold");
        for (key, value) in &self.keys {
            set(&mut table, key, value.clone());
        }
        Config::parse(&Source::new("advice", table.to_string()))
    }

    /// The job with keys and options changed.
    ///
    /// # Errors
    /// A machine that is out of its ranges.
    pub fn job(&self, base: &Job) -> Result<Job, Report> {
        let mut job = Job { machine: self.machine(&base.machine)?, ..base.clone() };
        self.options.iter().for_each(|option| option.apply(&mut job));
        Ok(job)
    }
}

/// Sets a key with dots, as in `bus.arbiter`.
fn set(table: &mut toml::Table, key: &str, value: Value) {
    match key.split_once('.') {
        Some((section, rest)) => {
            let inner = table.entry(section).or_insert_with(|| Value::Table(toml::Table::new()));
            if let Value::Table(inner) = inner {
                set(inner, rest, value);
            }
        }
        None => {
            table.insert(key.to_owned(), value);
        }
    }
}

/// Share of octets, or of clocks of computing, below which a kind of data or a class of operations is left alone.
const LITTLE: f64 = 0.01;

/// Octets and clocks that a picture takes on the machine as it is: what a change may be about.
#[derive(Clone, Debug)]
pub struct PictureDemand {
    /// Octets that are asked for, by the name of a kind of data.
    pub octets: Vec<(String, u64)>,
    /// Clocks of the cores' operations, by class.
    pub clocks: Counts,
}

impl PictureDemand {
    /// Reason for which a cache for a kind of data can bring next to nothing.
    fn little_data(&self, kind: MemoryKind) -> Option<String> {
        let all: u64 = self.octets.iter().map(|(_, octets)| octets).sum();
        let own: u64 = self.octets.iter().filter(|(name, _)| name == kind.name()).map(|(_, octets)| octets).sum();
        let share = own as f64 / all.max(1) as f64;
        (share < LITTLE).then(|| format!("{:.2} % of the octets are {}", 100.0 * share, kind.name()))
    }

    /// Reason for which faster operations of a class can bring next to nothing.
    fn little_computing(&self, class: Class) -> Option<String> {
        let share = self.clocks[class] as f64 / self.clocks.iter().map(|(_, clocks)| clocks).sum::<u64>().max(1) as f64;
        (share < LITTLE).then(|| format!("{:.2} % of the computing is {}", 100.0 * share, class.name()))
    }
}

/// All changes that are tried on a job whose picture lies in `image`, with those that are left out and why.
pub fn all(job: &Job, image: &MemoryImage, demand: &PictureDemand) -> (Vec<Change>, Vec<(Change, String)>) {
    let machine = &job.machine;
    let mut left = Vec::new();
    let parts = [
        bus(machine),
        caches(machine, image, demand, &mut left),
        cores(machine),
        arbiters(machine),
        operations(machine, demand, &mut left),
        pictures(job, image.counts.triangles as usize),
    ];
    let mut possible = Vec::new();
    for change in parts.concat() {
        match change.machine(machine) {
            Ok(_) => possible.push(change),
            Err(report) => left.push((change, reason(&report))),
        }
    }
    (possible, left)
}

fn whole(number: u64) -> Value {
    Value::Integer(i64::try_from(number).unwrap_or(i64::MAX))
}

/// A wider beat, shorter and longer bursts, overlap.
fn bus(machine: &Config) -> Vec<Change> {
    let bus = &machine.bus;
    let wider = [2, 4, 8, 16, 32, 64].map(|times| {
        let octets = bus.octets_per_beat.saturating_mul(times);
        let words = format!("{} octets a beat", grouped(octets));
        Change::of_keys(ChangedPart::BusWidth, words, &[("bus.octets_per_beat", whole(octets))])
    });
    let bursts = [0, 16, 64].into_iter().filter(|&octets| octets != bus.burst_octets).map(|octets| {
        let words = if octets == 0 { "bursts without end".to_owned() } else { format!("bursts of {octets} octets") };
        Change::of_keys(ChangedPart::Bursts, words, &[("bus.burst_octets", whole(octets))])
    });
    let overlap = (!bus.overlap).then(|| {
        let words = "loads beside computing".to_owned();
        Change::of_keys(ChangedPart::Overlap, words, &[("bus.overlap", Value::Boolean(true))])
    });
    wider.into_iter().chain(bursts).chain(overlap).collect()
}

/// Octets of the caches that are tried, the smallest first.
const CACHES: [u32; 4] = [1 << 10, 4 << 10, 16 << 10, 64 << 10];

/// A cache of each size for each kind of data that cores read; the first one that holds all of a kind is the last for it.
fn caches(
    machine: &Config,
    image: &MemoryImage,
    demand: &PictureDemand,
    left: &mut Vec<(Change, String)>,
) -> Vec<Change> {
    let is_read = |kind: MemoryKind| !matches!(kind, MemoryKind::Header | MemoryKind::Frame);
    let mut found = Vec::new();
    for (kind, range) in image.regions.iter().filter(|(kind, range)| is_read(*kind) && !range.is_empty()) {
        let enough = CACHES.iter().position(|&octets| octets as usize >= range.len()).unwrap_or(CACHES.len() - 1);
        let little = demand.little_data(*kind);
        for octets in &CACHES[..=enough] {
            if (machine.cache.octets, machine.cache.kind.as_str()) == (*octets, kind.name()) {
                continue;
            }
            let words = format!("{} KiB cache, {}", octets >> 10, kind.name());
            let kind = Value::String(kind.name().to_owned());
            let keys = [("cache.octets", whole((*octets).into())), ("cache.kind", kind)];
            let change = Change::of_keys(ChangedPart::Cache, words, &keys);
            if let Some(little) = &little {
                left.push((change, little.clone()));
                break;
            }
            found.push(change);
        }
    }
    found
}

/// More and fewer cores.
fn cores(machine: &Config) -> Vec<Change> {
    let now = machine.cores;
    let mut numbers = vec![now / 4, now / 2, now + now.div_ceil(2), 2 * now, 4 * now];
    numbers.sort_unstable();
    numbers.dedup();
    let others = numbers.into_iter().filter(|&cores| cores != now && (1..=MOST_CORES).contains(&cores));
    let change = |cores: u32| {
        let words = if cores == 1 { "1 core".to_owned() } else { format!("{cores} cores") };
        Change::of_keys(ChangedPart::Cores, words, &[("cores", whole(cores.into()))])
    };
    others.map(change).collect()
}

fn arbiters(machine: &Config) -> Vec<Change> {
    // One that would be another by its keys is no other, such as even weights.
    let is_another = |&kind: &ArbiterKind| {
        let mut changed = machine.clone();
        changed.bus.arbiter = kind;
        kind != machine.bus.arbiter && arbiter_note(&changed).is_none()
    };
    let others = ArbiterKind::ALL.into_iter().filter(is_another);
    let change = |kind: ArbiterKind| {
        let words = format!("arbiter {}", kind.name());
        Change::of_keys(ChangedPart::Arbiter, words, &[("bus.arbiter", Value::String(kind.name().to_owned()))])
    };
    others.map(change).collect()
}

/// Units that a vector's components need to be computed at once.
const UNITS: u64 = 3;

/// Three units of one class and of all, and faster operations where they take more than a clock.
fn operations(machine: &Config, demand: &PictureDemand, left: &mut Vec<(Change, String)>) -> Vec<Change> {
    // Keys have the clocks of one execution, whatever the protection of results.
    let (timing, clocks_once) = (machine.timing(), machine.single_clocks());
    let timed = Class::ALL.iter().copied().filter(|&class| class.is_elementary() && timing.clocks[class] != 0);
    let few: Vec<Class> = timed.clone().filter(|&class| timing.units[class] < UNITS).collect();
    let unit_key = |class: Class| (format!("units.{}", class.name()), whole(UNITS));
    let of_units = |words: String, classes: &[Class]| Change {
        parts: vec![ChangedPart::Units],
        words,
        keys: classes.iter().copied().map(unit_key).collect(),
        options: Vec::new(),
    };
    let mut found: Vec<Change> =
        few.iter().map(|class| of_units(format!("{UNITS} units for {}", class.name()), &[*class])).collect();
    if few.len() > 1 {
        found.push(of_units(format!("{UNITS} units for all classes"), &few));
    }
    // What hardly happens is not made faster by itself.
    found.retain(|change| {
        let class = few.iter().find(|class| change.keys.len() == 1 && change.keys[0].0 == unit_key(**class).0);
        let little = class.and_then(|&class| demand.little_computing(class));
        left.extend(little.iter().map(|little| (change.clone(), little.clone())));
        little.is_none()
    });
    for class in timed.filter(|&class| demand.little_computing(class).is_none()) {
        let now = clocks_once[class];
        let mut faster = vec![now / 2, 1];
        faster.dedup();
        for clocks in faster.into_iter().filter(|&clocks| (1..now).contains(&clocks)) {
            let words = format!("{} in {clocks} of {now} clocks", class.name());
            let key = format!("clocks.{}", class.name());
            found.push(Change::of_keys(ChangedPart::Speed, words, &[(&key, whole(clocks))]));
        }
    }
    found
}

/// Other layouts, sets of kernels and trees.
fn pictures(job: &Job, triangles: usize) -> Vec<Change> {
    let mut found = Vec::new();
    let is_read = |&layout: &Layout| layout != job.layout() && job.kernels.profile.refusal(layout).is_none();
    for layout in Layout::ALL.into_iter().filter(is_read) {
        let words = format!("layout {}", layout.name());
        found.push(Change::of_option(ChangedPart::Layout, words, PictureOption::Layout(layout)));
    }
    let reads = |set: &&KernelSet| job.layout.is_none_or(|layout| set.refusal(layout).is_none());
    for &set in KernelSet::ALL.iter().filter(|&&set| set != job.kernels.profile).filter(reads) {
        let words = format!("kernels of {}", set.name());
        found.push(Change::of_option(ChangedPart::Kernels, words, PictureOption::Profile(set)));
    }
    // Depths that come to the same tree are one.
    let mut tried = vec![job.kd_depth().levels(triangles)];
    for depth in [Depth::Auto, Depth::Levels(8), Depth::Levels(12), Depth::Levels(16), Depth::Levels(20)] {
        let levels = depth.levels(triangles);
        if tried.contains(&levels) {
            continue;
        }
        tried.push(levels);
        let words = format!("kd tree of {levels} levels");
        found.push(Change::of_option(ChangedPart::TreeDepth, words, PictureOption::KdDepth(depth)));
    }
    for method in BuildMethod::ALL.into_iter().filter(|&method| method != job.kd_method()) {
        let words = format!("kd tree built {}", method.name());
        found.push(Change::of_option(ChangedPart::TreeMethod, words, PictureOption::KdBuild(method)));
    }
    found
}

/// Message on a change that a machine refuses.
pub fn reason(report: &Report) -> String {
    report.0.iter().map(|Diagnostic { message, .. }| message.as_str()).collect::<Vec<_>>().join("; ")
}
