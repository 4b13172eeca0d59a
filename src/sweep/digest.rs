//! Digests of all points of a study, part by part: a part of the settings is read, checked and digested once for all points that share its values.

use std::collections::HashMap;
use std::fmt::Write;
use std::sync::{Arc, RwLock};

use emu::machine::Config;
use emu::machine::config::{AreaConfig, EnergyConfig};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::contents::Contents;
use super::identity::{PartDigest, SettingsPart};
use super::study::Study;
use crate::failure::Failure;
use crate::settings::Settings;
use crate::settings::apply::change;

/// Octets of the values of a part that are kept, roughly: a Latin hypercube has as many as points, and none of them twice.
const MOST_KEPT: usize = 8 << 20;

/// Digests of a point, and its pixels.
pub type PointDigest = (PartDigest, u64);

/// Values of a part by the number that [`Alternatives::number`] gives.
type Kept<T> = RwLock<HashMap<u64, Arc<T>>>;

/// A part of the machine: its keys, in a machine whose other keys are of no account, and its digest.
struct MachinePart {
    config: Config,
    digest: PartDigest,
}

/// Factors of a study that vary a part of the settings. Alternatives that set the same of it are one: of a Latin hypercube over many keys, a part has few.
struct Alternatives {
    /// Number of each factor, for each of its alternatives the number of what it sets of the part, and how many of these there are.
    factors: Vec<(usize, Vec<u64>, u64)>,
}

impl Alternatives {
    fn new(study: &Study, parts: &[SettingsPart]) -> Alternatives {
        let has = |key: &str| parts.iter().any(|part| part.has(key));
        let mut factors = Vec::new();
        for (number, factor) in study.factors.iter().enumerate() {
            let mut known: HashMap<String, u64> = HashMap::new();
            let mut numbers = Vec::with_capacity(factor.len());
            for alternative in factor {
                let mut own = String::new();
                for (key, value) in alternative.iter().filter(|(key, _)| has(key)) {
                    let _ = writeln!(own, "{key} = {value}");
                }
                let next = known.len() as u64;
                numbers.push(*known.entry(own).or_insert(next));
            }
            if known.len() > 1 {
                factors.push((number, numbers, known.len() as u64));
            }
        }
        Alternatives { factors }
    }

    /// Number of what a point sets of the part, whose digits are those of the factors: with factors of 3 and 5 different settings, the second
    /// and the fourth are 1 * 5 + 3 = 8.
    fn number(&self, chosen: &[u64]) -> u64 {
        let digit = |factor: usize, numbers: &[u64]| numbers[chosen[factor] as usize];
        self.factors.iter().fold(0, |number, (factor, numbers, of)| number * of + digit(*factor, numbers))
    }
}

/// The digests of a study's points.
pub struct StudyDigests<'s> {
    study: &'s Study,
    contents: &'s Contents,
    picture: (Alternatives, Kept<PointDigest>),
    machine: (Alternatives, Kept<PartDigest>),
    parts: Vec<(SettingsPart, Alternatives, Kept<MachinePart>)>,
    /// True where some point puts another machine in the place of the base's.
    has_machines: bool,
}

impl<'s> StudyDigests<'s> {
    /// Digests of a study that are made when they are asked for.
    pub fn new(study: &'s Study, contents: &'s Contents) -> StudyDigests<'s> {
        let of = |parts: &[SettingsPart]| Alternatives::new(study, parts);
        let mut keys = study.factors.iter().flatten().flatten().map(|(key, _)| key.as_str());
        StudyDigests {
            study,
            contents,
            has_machines: keys.any(|key| ["machine", "machine.from"].contains(&key)),
            picture: (of(&[SettingsPart::Picture]), Kept::default()),
            machine: (of(&SettingsPart::MACHINE), Kept::default()),
            parts: SettingsPart::MACHINE.into_iter().map(|part| (part, of(&[part]), Kept::default())).collect(),
        }
    }

    /// The digests of a point by its number. Reads the files that it depends on.
    ///
    /// # Errors
    /// Files that cannot be read, and points whose values are out of their ranges or do not go together.
    pub fn of(&self, number: u64) -> Result<PointDigest, Failure> {
        let chosen = self.study.chosen(number);
        match self.by_parts(number, &chosen) {
            Ok((picture, machine)) => Ok((PartDigest::joined(&[picture.0, *machine]), picture.1)),
            // The settings as a whole say what is wrong, with the point.
            Err(failure) => {
                self.study.settings(number, self.contents)?;
                Err(failure)
            }
        }
    }

    fn by_parts(&self, number: u64, chosen: &[u64]) -> Result<(Arc<PointDigest>, Arc<PartDigest>), Failure> {
        let (alternatives, kept) = &self.picture;
        let picture = known(kept, alternatives.number(chosen), || {
            let mut value = self.study.base.clone();
            value.as_object_mut().map(|keys| keys.remove("machine"));
            self.assign(&mut value, number, SettingsPart::Picture)?;
            let mut settings = Settings::of_value(&value)?;
            self.contents.resolve(&mut settings)?;
            Ok((PartDigest::of_picture(&settings), settings.pixels()))
        })?;
        let (alternatives, kept) = &self.machine;
        let machine = known(kept, alternatives.number(chosen), || {
            let parts = self.parts.iter().map(|(part, alternatives, kept)| {
                known(kept, alternatives.number(chosen), || self.machine_part(*part, number))
            });
            let parts = parts.collect::<Result<Vec<_>, Failure>>()?;
            checked(&parts)?;
            Ok(PartDigest::joined(&parts.iter().map(|part| part.digest).collect::<Vec<_>>()))
        })?;
        Ok((picture, machine))
    }

    /// Puts what a point sets of a part.
    fn assign(&self, value: &mut Value, number: u64, part: SettingsPart) -> Result<(), Failure> {
        for (key, assigned) in self.study.assignments(number).iter().filter(|(key, _)| part.has(key)) {
            change(value, key, assigned.clone())?;
        }
        Ok(())
    }

    fn machine_part(&self, part: SettingsPart, number: u64) -> Result<MachinePart, Failure> {
        // The base's keys of the part alone; another machine has all keys anyway.
        let base = self.study.base["machine"].as_object();
        let is_own = |key: &str| part.has(&format!("machine.{key}"));
        let own = base.into_iter().flatten().filter(|(key, _)| !self.has_machines && is_own(key));
        let own: Map<String, Value> = own.map(|(key, value)| (key.clone(), value.clone())).collect();
        let mut value = match self.has_machines {
            true => serde_json::json!({ "machine": base }),
            false => serde_json::json!({ "machine": own }),
        };
        self.assign(&mut value, number, part)?;
        let config = config_of(part, &value["machine"])?;
        Ok(MachinePart { digest: PartDigest::of_machine(part, &config), config })
    }
}

/// Value that is kept by a number, or is made now.
fn known<T>(kept: &Kept<T>, number: u64, make: impl FnOnce() -> Result<T, Failure>) -> Result<Arc<T>, Failure> {
    if let Some(known) = kept.read().expect("no reader panics").get(&number) {
        return Ok(known.clone());
    }
    let made = Arc::new(make()?);
    let mut kept = kept.write().expect("no writer panics");
    if kept.len() < MOST_KEPT / size_of::<T>() {
        kept.insert(number, made.clone());
    }
    Ok(made)
}

/// A machine with the keys of a part alone.
fn config_of(part: SettingsPart, keys: &Value) -> Result<Config, Failure> {
    fn read<T: DeserializeOwned>(value: &Value) -> Result<T, Failure> {
        let read = T::deserialize(value);
        Ok(read.map_err(|error| messages::Diagnostic::error(error.to_string()))?)
    }
    let mut config = Config::default();
    match part {
        SettingsPart::Picture => {}
        SettingsPart::Whole | SettingsPart::Timing => {
            let own = keys.as_object().into_iter().flatten();
            let own = own.filter(|(key, _)| part.has(&format!("machine.{key}")) && *key != crate::settings::NAME);
            let own: Map<String, Value> = own.map(|(key, value)| (key.clone(), value.clone())).collect();
            config = read(&Value::Object(own))?;
        }
        SettingsPart::Bus => config.bus = read(&keys["bus"])?,
        SettingsPart::Cache => config.cache = read(&keys["cache"])?,
        SettingsPart::Main => config.main = read(&keys["main"])?,
        SettingsPart::Energy => config.energy = read::<EnergyConfig>(&keys["energy"])?,
        SettingsPart::Area => config.area = read::<AreaConfig>(&keys["area"])?,
    }
    Ok(config)
}

/// Checks the machine that has the keys of all its parts.
fn checked(parts: &[Arc<MachinePart>]) -> Result<(), Failure> {
    let [whole, timing, bus, cache, main, energy, area] = parts else { return Ok(()) };
    let Config { arithmetic, clocks, units, .. } = timing.config.clone();
    let config = Config {
        arithmetic,
        clocks,
        units,
        bus: bus.config.bus.clone(),
        cache: cache.config.cache.clone(),
        main: main.config.main.clone(),
        energy: energy.config.energy.clone(),
        area: area.config.area.clone(),
        ..whole.config.clone()
    };
    Ok(config.check()?)
}

#[cfg(test)]
mod tests {
    use messages::Source;

    use super::super::identity;
    use super::*;

    #[test]
    fn digests_by_parts_are_those_of_the_whole() {
        for text in [
            "settings = { size = \"4x3\" }\n[product]\nscene = [\"triangle\", \"cornell\"]\nword = [32, 24]\n\
             machine = [\"report\", \"wide32\", \"bit_serial\"]\ncores = \"1-3\"\nbus.setup_clocks = [0, 9]\n",
            // Tables that change machines, keys of several parts in one factor, what goes by the kernels.
            "[settings]\nscene = \"triangle\"\nmachine = \"node_cache\"\nprofile = \"report\"\n[product]\nmachine = [\"report\", { from = \"wide32\", cores = 7, bus.overlap = true }]\n\
             [[list]]\nprofile = \"ray\"\ncores = 2\n[[list]]\nlayout = \"report\"\nclocks.mul = \"linear\"\ncache.octets = 64\n[[zip]]\nword = [16, 20]\nsize = [\"3x2\", \"5x4\"]\n\
             main.traffic = [true, false]\n",
            "settings = { scene = \"triangle\", size = \"4x3\" }\n[product]\narbiter = [\"tdma\", \"weighted\"]\n[latin]\npoints = 9\nkeys = { \"bus.setup_clocks\" = [0, 20], \"cache.octets\" = [0, 8192], word = [8, 32], clock_hz = [1, 9] }\n",
        ] {
            let study = Study::parse(&Source::new("s.toml", text), "s")
                .unwrap_or_else(|report| panic!("{}", report.render(false)));
            let contents = Contents::default();
            let digests = StudyDigests::new(&study, &contents);
            // Each twice: made, and known.
            for number in (0..study.count()).chain(0..study.count()) {
                let settings = study.settings(number, &contents).unwrap();
                let (digest, pixels) = digests.of(number).unwrap();
                assert_eq!(digest, identity::digests(&settings), "{number} of {text}");
                let [width, height] = settings.view.size.unwrap();
                assert_eq!(pixels, u64::from(width) * u64::from(height));
            }
        }
    }

    #[test]
    fn points_that_do_not_go_together_are_named() {
        let text = "[product]\nbuffer_octets = [16000000]\ncores = [1, 256]\nscene = [\"triangle\"]\n";
        let study = Study::parse(&Source::new("s.toml", text), "s").unwrap();
        let contents = Contents::default();
        let digests = StudyDigests::new(&study, &contents);
        let refused: Vec<u64> = (0..study.count()).filter(|&number| digests.of(number).is_err()).collect();
        assert_eq!(refused.len(), 1);
        let Err(Failure::Message { report, .. }) = digests.of(refused[0]) else { panic!("it is refused") };
        assert!(report.render(false).contains("256"), "{}", report.render(false));
    }
}
