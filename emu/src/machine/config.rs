//! The machine as a file describes it: every key with its unit and where its default comes from.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use isa::diagnostic::{Diagnostic, Place, Report, Source, did_you_mean};
use isa::number::{Modes, Overflow, Quantization};
use isa::{Class, Counts};
use serde::{Deserialize, Serialize};
use toml::de::{DeTable, DeValue};

use super::arbiter::ArbiterKind;
use crate::quantity::{Clocks, Octets};
use crate::timing::Timing;

/// Most cores that a machine may have.
pub const MOST_CORES: u32 = 256;

/// Most octets of a local buffer.
pub const MOST_BUFFER_OCTETS: u32 = 1 << 24;

/// Most clocks of an operation, a beat or a set-up, and most units of a class.
pub const MOST_CLOCKS: u64 = 1_000_000;

/// A machine. The defaults are the report's.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// Number of cores, 1 to 256, the main processor not counted; 4. Report 6.1.
    pub cores: u32,
    /// Clock rate in hertz; 100 MHz. Report 6.1.
    pub clock_hz: u64,
    /// Octets of each core's local buffer; 18,525, the sum of the list. Report 6.2.
    pub buffer_octets: u32,
    /// Instructions that a work item may take; 10^8, thousands of times what a pixel takes.
    pub step_limit: u64,
    /// Word and modes.
    pub arithmetic: ArithmeticConfig,
    /// Clocks of an operation, by class; 1 for add, sub, mul, div and cmp, 0 for the rest. Report 6.1.
    pub clocks: ClassClocks,
    /// Operations that run at once, by class; 1.
    pub units: ClassUnits,
    /// The shared bus.
    pub bus: BusConfig,
    /// The cores' private caches.
    pub cache: CacheConfig,
    /// The main processor.
    pub main: MainConfig,
}

impl Default for Config {
    fn default() -> Config {
        Config {
            cores: 4,
            clock_hz: 100_000_000,
            buffer_octets: 18_525,
            step_limit: 100_000_000,
            arithmetic: ArithmeticConfig::default(),
            clocks: ClassClocks::default(),
            units: ClassUnits::default(),
            bus: BusConfig::default(),
            cache: CacheConfig::default(),
            main: MainConfig::default(),
        }
    }
}

/// Word length and modes of the machine's arithmetic.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ArithmeticConfig {
    /// Bits of a word, 8 to 32; 32.
    pub word: u32,
    /// Rounding, by its name in IEEE 1666 without `SC_`; RND, to nearest with ties up.
    #[serde(with = "quantization_name")]
    pub quantization: Quantization,
    /// Overflow, by its name in IEEE 1666 without `SC_`; SAT, the nearest number that fits.
    #[serde(with = "overflow_name")]
    pub overflow: Overflow,
    /// Whether a division by zero stops the machine instead of saturating; no.
    pub trap_division_by_zero: bool,
}

impl Default for ArithmeticConfig {
    fn default() -> ArithmeticConfig {
        let Modes { word, quantization, overflow } = Modes::default();
        ArithmeticConfig { word, quantization, overflow, trap_division_by_zero: false }
    }
}

impl ArithmeticConfig {
    /// The modes that `isa` computes with.
    pub fn modes(&self) -> Modes {
        Modes { word: self.word, quantization: self.quantization, overflow: self.overflow }
    }
}

/// Reads and writes a mode by its name.
macro_rules! mode_name {
    ($module:ident $type:ident) => {
        mod $module {
            use isa::number::$type;
            use serde::{Deserialize, Deserializer, Serializer};

            pub fn serialize<S: Serializer>(mode: &$type, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_str(mode)
            }

            pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<$type, D::Error> {
                let name = String::deserialize(deserializer)?;
                let names: Vec<&str> = $type::ALL.iter().map(|mode| mode.name()).collect();
                $type::from_name(&name).ok_or_else(|| {
                    serde::de::Error::custom(format!("unknown mode `{name}`, expected one of `{}`", names.join("`, `")))
                })
            }
        }
    };
}

mode_name!(quantization_name Quantization);
mode_name!(overflow_name Overflow);

/// One number a class, written as a table of the classes that differ from the default.
macro_rules! class_table {
    ($(#[doc = $doc:literal])* $type:ident $field:ident) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
        #[serde(try_from = "BTreeMap<String, u64>", into = "BTreeMap<String, u64>")]
        pub struct $type(pub Counts);

        impl Default for $type {
            fn default() -> $type {
                $type(Timing::default().$field)
            }
        }

        impl TryFrom<BTreeMap<String, u64>> for $type {
            type Error = String;

            fn try_from(table: BTreeMap<String, u64>) -> Result<$type, String> {
                let mut counts = Timing::default().$field;
                for (name, number) in table {
                    let names = || Class::ALL.iter().map(|class| format!("`{}`", class.name())).collect::<Vec<_>>();
                    let class = Class::from_name(&name)
                        .ok_or_else(|| format!("unknown class `{name}`, expected one of {}", names().join(", ")))?;
                    counts[class] = number;
                }
                Ok($type(counts))
            }
        }

        impl From<$type> for BTreeMap<String, u64> {
            fn from(table: $type) -> BTreeMap<String, u64> {
                table.0.iter().map(|(class, number)| (class.name().to_owned(), number)).collect()
            }
        }
    };
}

class_table! {
    /// Clocks of an operation of each class.
    ClassClocks clocks
}

class_table! {
    /// Operations of each class that run at once.
    ClassUnits units
}

/// The shared bus.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BusConfig {
    /// Octets that go over the bus at once; 1. Report 6.1.
    pub octets_per_beat: u64,
    /// Clocks for that; 2, "a memory access takes twice an elementary operation". Report 6.1.
    pub clocks_per_beat: u64,
    /// Clocks before the first beat of a burst; 0. The report has none.
    pub setup_clocks: u64,
    /// Octets of the longest burst, 0 for no limit; 0. A longer transfer asks for the bus again after each burst.
    pub burst_octets: u64,
    /// Whether a core goes on while its block load is on its way; no. Report 6.1 adds computing and waiting up.
    ///
    /// The core goes on as soon as it has asked, up to the next thing that it wants of the machine (a transfer, a
    /// message, a barrier, its end); that begins when the load has ended. The data count as being there at once: the
    /// buffer's other half was filled ahead, and always with the right data, so this is the most that a second buffer
    /// can bring. Loads of single words are waited for.
    pub overlap: bool,
    /// Who gets the bus next; round-robin.
    pub arbiter: ArbiterKind,
    /// Bursts that a master keeps its turn for, the main processor after the last core, for the weighted arbiter; 1
    /// where the list ends.
    pub weights: Vec<u32>,
    /// Clocks of a slot of the TDMA arbiter; 128. A burst is never longer than what fits a slot.
    pub slot_clocks: u64,
}

impl Default for BusConfig {
    fn default() -> BusConfig {
        BusConfig {
            octets_per_beat: 1,
            clocks_per_beat: 2,
            setup_clocks: 0,
            burst_octets: 0,
            overlap: false,
            arbiter: ArbiterKind::default(),
            weights: Vec::new(),
            slot_clocks: 128,
        }
    }
}

impl BusConfig {
    /// How long a burst holds the bus.
    pub fn length(&self, octets: Octets) -> Clocks {
        Clocks(self.setup_clocks + octets.0.div_ceil(self.octets_per_beat) * self.clocks_per_beat)
    }

    /// Octets of the longest burst.
    pub fn longest_burst(&self) -> Octets {
        let limit = if self.burst_octets == 0 { u64::MAX } else { self.burst_octets };
        let beats_of_slot = self.slot_clocks.saturating_sub(self.setup_clocks) / self.clocks_per_beat;
        match self.arbiter {
            ArbiterKind::Tdma => Octets(limit.min((beats_of_slot * self.octets_per_beat).max(1))),
            _ => Octets(limit),
        }
    }

    /// How long a transfer that nobody disturbs holds the bus, all its bursts together.
    pub fn whole_length(&self, octets: Octets) -> Clocks {
        let burst = self.longest_burst();
        if octets <= burst {
            return self.length(octets);
        }
        let whole = Clocks(self.length(burst).0 * (octets.0 / burst.0));
        if octets.0.is_multiple_of(burst.0) { whole } else { whole + self.length(Octets(octets.0 % burst.0)) }
    }
}

/// The private cache that each core has for one kind of data that is only read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CacheConfig {
    /// Octets of each core's cache, 0 for none; 0. The report has none.
    pub octets: u32,
    /// Octets of a line, which is got whole; 64.
    pub line_octets: u32,
    /// Kind of data that goes through it, by the loader's name; nodes of the tree.
    pub kind: String,
}

impl Default for CacheConfig {
    fn default() -> CacheConfig {
        CacheConfig { octets: 0, line_octets: 64, kind: "nodes".to_owned() }
    }
}

/// The main processor.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MainConfig {
    /// Whether its transfers, and messages to and from it, use the bus; yes. Otherwise they take no time.
    pub traffic: bool,
    /// Octets of its local buffer; 65,536. The report does not limit it.
    pub buffer_octets: u32,
    /// Instructions that its whole program may take; 10^11.
    pub step_limit: u64,
}

impl Default for MainConfig {
    fn default() -> MainConfig {
        MainConfig { traffic: true, buffer_octets: 65_536, step_limit: 100_000_000_000 }
    }
}

impl Config {
    /// What operations take.
    pub fn timing(&self) -> Timing {
        Timing { clocks: self.clocks.0, units: self.units.0 }
    }

    /// Whether work items do the same on both machines, in the same clocks of computing: only cores, bus, caches and
    /// main processor may differ.
    pub fn computes_like(&self, other: &Config) -> bool {
        let Config {
            cores: _,
            clock_hz: _,
            buffer_octets,
            step_limit,
            arithmetic,
            clocks,
            units,
            bus: _,
            cache: _,
            main: _,
        } = self;
        (buffer_octets, step_limit) == (&other.buffer_octets, &other.step_limit)
            && arithmetic == &other.arithmetic
            && (clocks, units) == (&other.clocks, &other.units)
    }

    /// Reads a machine file; keys that it leaves out have their defaults.
    ///
    /// # Errors
    /// A file that is not TOML, a key that does not exist, a value out of its range.
    pub fn parse(source: &Arc<Source>) -> Result<Config, Report> {
        let config: Config = toml::from_str(&source.text).map_err(|error| {
            let first_line = error.message().lines().next().unwrap_or_default().to_owned();
            let mut message = Diagnostic::error(plain(&first_line));
            if let Some(span) = error.span() {
                message = message.at(Place::new(source, span), "");
            }
            let mut quoted = first_line.split('`').skip(1).step_by(2);
            if first_line.contains("unknown")
                && let Some(wrong) = quoted.next()
                && let Some(near) = did_you_mean(wrong, quoted)
            {
                message = message.hint(format!("did you mean `{near}`?"));
            }
            Report::from(message)
        })?;
        let shown = |(key, message): (String, Diagnostic)| match span(&source.text, &key) {
            Some(span) => message.at(Place::new(source, span), "out of its range"),
            None => message,
        };
        let wrong: Vec<Diagnostic> = config.out_of_range().into_iter().map(shown).collect();
        if wrong.is_empty() { Ok(config) } else { Err(Report(wrong)) }
    }

    /// Whether every number lies in its range.
    ///
    /// # Errors
    /// One message for each that does not.
    pub fn check(&self) -> Result<(), Report> {
        let messages: Vec<Diagnostic> = self.out_of_range().into_iter().map(|(_, message)| message).collect();
        if messages.is_empty() { Ok(()) } else { Err(Report(messages)) }
    }

    /// The keys whose numbers are out of their ranges, with what to say about each.
    fn out_of_range(&self) -> Vec<(String, Diagnostic)> {
        let mut messages = Vec::new();
        let mut check = |key: &str, value: u64, least: u64, most: u64| {
            if !(least..=most).contains(&value) {
                let message = Diagnostic::error(format!("`{key}` is {value}, but must lie in {least}..={most}"));
                let nearest = value.clamp(least, most);
                messages.push((key.to_owned(), message.hint(format!("the nearest possible value is {nearest}"))));
            }
        };
        check("cores", self.cores.into(), 1, MOST_CORES.into());
        check("clock_hz", self.clock_hz, 1, 1_000_000_000_000);
        check("buffer_octets", self.buffer_octets.into(), 0, MOST_BUFFER_OCTETS.into());
        check("step_limit", self.step_limit, 1, 1 << 62);
        check("arithmetic.word", self.arithmetic.word.into(), 8, 32);
        for &class in Class::ALL {
            check(&format!("clocks.{}", class.name()), self.clocks.0[class], 0, MOST_CLOCKS);
            check(&format!("units.{}", class.name()), self.units.0[class], 1, MOST_CLOCKS);
        }
        check("bus.octets_per_beat", self.bus.octets_per_beat, 1, MOST_CLOCKS);
        check("bus.clocks_per_beat", self.bus.clocks_per_beat, 1, MOST_CLOCKS);
        check("bus.setup_clocks", self.bus.setup_clocks, 0, MOST_CLOCKS);
        check("bus.burst_octets", self.bus.burst_octets, 0, MOST_BUFFER_OCTETS.into());
        let slot = if self.bus.arbiter == ArbiterKind::Tdma {
            self.bus.setup_clocks.saturating_add(self.bus.clocks_per_beat)
        } else {
            1
        };
        check("bus.slot_clocks", self.bus.slot_clocks, slot, 4 * MOST_CLOCKS);
        for (master, &weight) in self.bus.weights.iter().enumerate() {
            check(&format!("bus.weights[{master}]"), weight.into(), 1, MOST_CLOCKS);
        }
        check("bus.weights' length", self.bus.weights.len() as u64, 0, u64::from(MOST_CORES) + 1);
        check("cache.octets", self.cache.octets.into(), 0, MOST_BUFFER_OCTETS.into());
        check("cache.line_octets", self.cache.line_octets.into(), 1, MOST_BUFFER_OCTETS.into());
        check("main.buffer_octets", self.main.buffer_octets.into(), 0, MOST_BUFFER_OCTETS.into());
        check("main.step_limit", self.main.step_limit, 1, 1 << 62);
        messages
    }

    /// The machine as a file with every key.
    pub fn text(&self) -> String {
        toml::to_string(self).expect("a machine has nothing that TOML cannot hold")
    }
}

/// Where the value of a key such as `bus.weights[2]` stands in a file.
fn span(text: &str, key: &str) -> Option<Range<usize>> {
    let document = DeTable::parse(text).ok()?;
    let mut table = document.get_ref();
    let mut found = None;
    for part in key.split('.') {
        let part = part.split(['[', '\'']).next()?;
        let (_, value) = table.iter().find(|(name, _)| name.get_ref() == part)?;
        found = Some(value.span());
        match value.get_ref() {
            DeValue::Table(inner) => table = inner,
            _ => break,
        }
    }
    found
}

/// A message of the TOML reader about a value of the wrong type, without the names of types of Rust.
fn plain(message: &str) -> String {
    let wrong = ["invalid type: ", "invalid value: "].iter().find_map(|start| message.strip_prefix(start));
    let Some((found, wanted)) = wrong.and_then(|rest| rest.split_once(", expected ")) else {
        return message.to_owned();
    };
    let wanted = match wanted {
        "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number from 0",
        "a boolean" => "true or false",
        "a string" => "a text in quotation marks",
        "a sequence" => "a list in brackets",
        wanted if wanted.starts_with("struct ") || wanted.starts_with("a map") => "a table",
        wanted => wanted,
    };
    let found = found.replace("string ", "text ").replace("integer ", "number ").replace("floating point ", "number ");
    format!("{wanted} is expected, not {}", found.replace("sequence", "a list").replace("map", "a table"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Config, String> {
        Config::parse(&Source::new("m.toml", text)).map_err(|report| report.render(false))
    }

    #[test]
    fn what_a_file_leaves_out_is_the_reports() {
        assert_eq!(parse(""), Ok(Config::default()));
        let config = parse("cores = 8\n[clocks]\ndiv = 16\n[bus]\noctets_per_beat = 4\n").expect("it is right");
        assert_eq!((config.cores, config.clocks.0[Class::Div], config.clocks.0[Class::Mul]), (8, 16, 1));
        assert_eq!(config.bus.length(Octets(31)), Clocks(16));
        assert_eq!(Config::default().bus.length(Octets(31)), Clocks(62));
    }

    #[test]
    fn the_effective_machine_reads_back_as_itself() {
        let mut config = Config::default();
        config.arithmetic.quantization = Quantization::TrnZero;
        config.units.0[Class::Mul] = 3;
        config.main.traffic = false;
        assert_eq!(parse(&config.text()), Ok(config));
        assert_eq!(parse(&Config::default().text()), Ok(Config::default()));
    }

    #[test]
    fn mistakes_are_shown_with_place_and_suggestion() {
        for (text, place, hint) in [
            ("core = 3", "m.toml:1:1", "did you mean `cores`?"),
            ("\n[bus]\nclocks_per_bet = 3", "m.toml:3:1", "did you mean `clocks_per_beat`?"),
            ("[bus]\narbiter = \"round-robbin\"", "m.toml:2:11", "did you mean `round-robin`?"),
            ("[clocks]\nmull = 3", "m.toml", "did you mean `mul`?"),
            ("[arithmetic]\nquantization = \"RNG\"", "m.toml:2:16", "did you mean `RND`?"),
            ("cores = \"four\"", "m.toml:1:9", ""),
            ("cores = ", "m.toml:1", ""),
            ("cores = -1", "m.toml:1:9", "a whole number from 0 is expected, not number `-1`"),
            ("\ncores = \"4\"", "m.toml:2:9", "a whole number from 0 is expected, not text \"4\""),
            ("[bus]\noverlap = 1", "m.toml:2:11", "true or false is expected, not number `1`"),
            ("[bus]\nweights = [1, 0]", "m.toml:2:11", "must lie in 1..="),
            ("bus = 3", "m.toml:1:7", "a table is expected"),
            ("\ncores = 999", "m.toml:2:9", "the nearest possible value is 256"),
            ("[arithmetic]\nword = 99 # bits", "m.toml:2:8", "the nearest possible value is 32"),
        ] {
            let shown = parse(text).expect_err(text);
            assert!(shown.contains(place) && shown.contains(hint), "{text}\n{shown}");
        }
    }

    #[test]
    fn numbers_out_of_their_range_are_all_named() {
        let text = "cores = 0\nbuffer_octets = 4000000000\n[arithmetic]\nword = 7\n[units]\nmul = 0\n\
                    [bus]\nclocks_per_beat = 0\n";
        let shown = parse(text).expect_err("nothing is right");
        for key in ["`cores` is 0", "`buffer_octets`", "`arithmetic.word` is 7", "`units.mul`", "`bus.clocks_per_beat`"]
        {
            assert!(shown.contains(key), "{key}\n{shown}");
        }
    }
}
