//! A machine's file: read with places and hints, checked, and written with every key.

use std::sync::Arc;

use isa::Class;
use messages::{Diagnostic, Report, Source, read_toml};

use super::law::Law;
use super::protection::WORD_BITS;
use super::{Config, MOST_BUFFER_OCTETS, MOST_CLOCKS, MOST_CORES, MOST_LANES, MOST_OCTETS};
use crate::machine::arbiter::ArbiterKind;

impl Config {
    /// Reads a machine file; keys that it leaves out have their defaults.
    ///
    /// # Errors
    /// All at once: what is no TOML, keys that do not exist, values of the wrong type or out of their ranges.
    pub fn parse(source: &Arc<Source>) -> Result<Config, Report> {
        read_toml(source, Config::out_of_range)
    }

    /// Check that every number lies in its range.
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
        check("packet_lanes", self.packet_lanes.into(), 1, MOST_LANES.into());
        check("arithmetic.word", self.arithmetic.word.into(), 8, 32);
        for &class in Class::ALL {
            // A number of no units is a mistake; a law that comes to none leaves the class its one.
            if let Law::Constant(units) = self.units.0[class] {
                check(&format!("units.{}", class.name()), units, 1, MOST_CLOCKS);
            }
            if let Law::Constant(clocks) = self.clocks.0[class] {
                check(&format!("clocks.{}", class.name()), clocks, 0, MOST_CLOCKS);
            }
        }
        check("bus.octets_per_beat", self.bus.octets_per_beat, 1, MOST_CLOCKS);
        check("bus.clocks_per_beat", self.bus.clocks_per_beat, 1, MOST_CLOCKS);
        check("bus.setup_clocks", self.bus.setup_clocks, 0, MOST_CLOCKS);
        check("bus.burst_octets", self.bus.burst_octets, 0, MOST_BUFFER_OCTETS.into());
        // A slot that holds no beat would never be granted to anybody; a beat out of its own range has been named already.
        let has_beat = self.bus.clocks_per_beat.max(self.bus.setup_clocks) <= MOST_CLOCKS;
        let slot = if self.bus.arbiter == ArbiterKind::Tdma && has_beat {
            let one = self.bus.clocks_of_words(self.protection.moved_bits()).div_ceil(u64::from(WORD_BITS));
            self.bus.setup_clocks + one
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
        messages.extend(self.laws_out_of_range());
        messages.extend(self.protection.misplaced());
        for (key, octets) in [("buffer_octets", self.buffer_octets), ("cache.octets", self.cache.octets)] {
            let all = u64::from(self.cores) * u64::from(octets);
            // Each core's own key is fine; what is too much is a host's memory for all of them.
            if all > MOST_OCTETS && octets <= MOST_BUFFER_OCTETS && (1..=MOST_CORES).contains(&self.cores) {
                let message = format!("`{key}` is {octets} for each of {} cores, which is {all} octets", self.cores);
                let most = MOST_OCTETS / u64::from(self.cores);
                let hint = format!("all cores together may have {MOST_OCTETS}: here {most} each, or fewer `cores`");
                messages.push((key.to_owned(), Diagnostic::error(message).hint(hint)));
            }
        }
        messages
    }

    /// Laws that come to too much for some word, whichever the machine has now, since an option may give it another one.
    fn laws_out_of_range(&self) -> Vec<(String, Diagnostic)> {
        let tables = [("clocks", &self.clocks.0), ("units", &self.units.0)];
        let laws =
            tables.into_iter().flat_map(|(name, table)| table.iter().map(move |(class, law)| (name, class, law)));
        let too_large = laws.filter_map(|(name, class, law)| {
            let key = format!("{name}.{}", class.name());
            let word = (8..=32).max_by_key(|&word| law.at(word)).filter(|_| law.is_grown())?;
            let number = Some(law.at(word)).filter(|&number| number > MOST_CLOCKS)?;
            let message =
                format!("`{key}` is `{law}`, {number} for words of {word} bits, but may be at most {MOST_CLOCKS}");
            Some((key, Diagnostic::error(message).hint("take a smaller factor or summand")))
        });
        too_large.collect()
    }

    /// The machine as a file with every key.
    pub fn text(&self) -> String {
        toml::to_string(self).expect("a machine has nothing that TOML cannot hold")
    }
}

#[cfg(test)]
mod tests {
    use isa::number::Quantization;

    use super::super::law::Growth;
    use super::*;
    use crate::code::quantity::{Clocks, Octets};
    use crate::machine::{FaultKind, Protection};

    fn parse(text: &str) -> Result<Config, String> {
        Config::parse(&Source::new("m.toml", text)).map_err(|report| report.render(false))
    }

    #[test]
    fn what_a_file_leaves_out_is_the_reports() {
        assert_eq!(parse(""), Ok(Config::default()));
        let config = parse("cores = 8\n[clocks]\ndiv = 16\n[bus]\noctets_per_beat = 4\n").expect("it is right");
        assert_eq!((config.cores, config.clocks.0[Class::Div], config.clocks.0[Class::Mul]), (8, 16.into(), 1.into()));
        assert_eq!(config.bus.length(Octets(31), 0), Clocks(16));
        assert_eq!(Config::default().bus.length(Octets(31), 0), Clocks(62));
    }

    #[test]
    fn the_effective_machine_reads_back_as_itself() {
        let mut config = Config::default();
        config.arithmetic.quantization = Quantization::TrnZero;
        config.units.0[Class::Mul] = 3.into();
        config.units.0[Class::Add] = Law::times(Growth::Inverse, 96);
        config.clocks.0[Class::Mul] = Law::Grown { growth: Growth::Linear, times: 1, by: 4, plus: 2 };
        config.main.traffic = false;
        config.protection.set(FaultKind::Memory, Protection::Secded);
        config.protection.set(FaultKind::Results, Protection::Residue);
        let energy = "tables = \"aladdin\"\nmul = \"1.5/32 b pJ; a paper, table 2\"\nmove = \"none\"\n";
        config.energy = parse(&format!("[energy]\n{energy}")).expect("it is right").energy;
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
            ("[clocks]\nmul = \"liner\"", "m.toml:2:7", "did you mean `linear`?"),
            (
                "[clocks]\nadd = 1\nmul = -3",
                "m.toml:3:7",
                "a whole number from 0 or a law such as \"linear\" is expected, not number `-3`",
            ),
            ("[clocks]\nmul = 0.5", "m.toml:2:7", "or a law"),
            (
                "[clocks]\nmul = \"square 2000\"",
                "m.toml:2:7",
                "2048000 for words of 32 bits, but may be at most 1000000",
            ),
            ("[clocks]\nmul = \"linear 2 3\"", "m.toml:2:7", "no whole number from 1"),
            ("[protection]\nmemry = \"ecc\"", "m.toml:2:1", "did you mean `memory`?"),
            ("[protection]\nmemory = \"ec\"", "m.toml:2:10", "did you mean `ecc`?"),
            (
                "[protection]\nmemory = \"ec\"",
                "m.toml:2:10",
                "unknown protection `ec`, expected one of `none`, `parity`, `ecc`\n",
            ),
            ("protection = \"ecc\"", "m.toml:1:14", "a table is expected, not text \"ecc\""),
            ("[protection]\nmemory = \"residue\"", "m.toml:2:10", "must be one of none, parity, ecc"),
            ("[protection]\nmemory = true", "m.toml:2:10", "a text in quotation marks is expected"),
            ("[protection]\ndoubled_grant = \"ecc\"", "m.toml:2:1", "unknown structure `doubled_grant`"),
            // A slot of 2 clocks has room for a beat of 2, and not for its check bits.
            (
                "[bus]\narbiter = \"tdma\"\nslot_clocks = 2\n[protection]\nbus = \"parity\"",
                "m.toml:3:15",
                "the nearest possible value is 3",
            ),
            (
                "[bus]\narbiter = \"tdma\"\nclocks_per_beat = 600000000000000000",
                "m.toml:3:19",
                "the nearest possible value is 1000000",
            ),
            (
                "[bus]\narbiter = \"tdma\"\nsetup_clocks = 9000000000000000000",
                "m.toml:3:16",
                "the nearest possible value is 1000000",
            ),
            ("[energy]\nmul = \"0.2 b pJ\"", "m.toml:2:7", "a line is a figure, a unit, `;` and where it comes from"),
            ("[energy]\nmul = \"0.2 b um2; me\"", "m.toml:2:7", "it is one of aJ, fJ, pJ, nJ"),
            (
                "[area]\nmul = 12",
                "m.toml:2:7",
                "a text such as \"0.003 b um2; my synthesis\" is expected, not number `12`",
            ),
            ("[energy]\ntables = \"horowits\"", "m.toml:2:10", "did you mean `horowitz`?"),
            ("[energy]\nmull = \"none\"", "m.toml", "did you mean `mul`?"),
            ("[units]\nmul = 0", "m.toml:2:7", "the nearest possible value is 1"),
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
    fn mistakes_of_all_kinds_are_shown_at_once() {
        let text = "core = 3\nclock_hz = \"fast\"\n[clocks]\nmull = 1\n[bus]\narbiter = \"tmda\"\noverlap = 1\nburst_octets = -4\n\
                    [arithmetic]\nword = 99\n";
        let shown = parse(text).expect_err("nothing is right");
        for place in ["1:1", "2:12", "4:1", "6:11", "7:11", "8:16", "10:8"] {
            assert!(shown.contains(&format!("m.toml:{place}")), "{place}\n{shown}");
        }
        assert!(shown.contains("did you mean `tdma`?") && shown.ends_with("7 errors"), "{shown}");
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
