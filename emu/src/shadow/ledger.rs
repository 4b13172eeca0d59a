//! Errors by source line: what each line brought in, what arrived at it, what it decided otherwise than its shadow would have.

use std::collections::BTreeMap;

use isa::Program;
use isa::program::Line;

use super::long_real::power;

/// Good bits below which cancellation is told of.
pub const FEW_GOOD_BITS: f64 = 20.0;

/// A source line within a function: what errors are counted by.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShadowSite {
    /// The line; `None` in a program without sources, where each word is a site.
    pub line: Option<Line>,
    /// The line that called a macro which made the words; `None` where no macro did.
    pub call: Option<Line>,
    /// Function around it.
    pub function: Option<String>,
    /// Words of the line.
    pub words: Vec<u32>,
}

/// Line of a word, the line that called its macro, its region, and of a word without a line its number.
type WordOrigin = (Option<Line>, Option<Line>, Option<u16>, u32);

/// The sites of a program, and the site of each word.
#[derive(Clone, Debug, Default)]
pub struct ShadowSites {
    /// The sites, in the order of their first words.
    pub sites: Vec<ShadowSite>,
    /// Sites of the instructions that functions compute (`.computes`), in the order of the program's list. They have no words.
    pub computed: Vec<u32>,
    of: Vec<u32>,
}

impl ShadowSites {
    /// The sites of a program.
    pub fn new(program: &Program) -> ShadowSites {
        let mut sites = ShadowSites::default();
        let mut known: BTreeMap<WordOrigin, u32> = BTreeMap::new();
        for word in 0..program.words.len() as u32 {
            let line = program.lines.get(word as usize).copied();
            let region = program.region_of.get(word as usize).copied().flatten();
            // Words without a line are told apart by themselves.
            let call = program.call_line(word);
            let key = (line, call, region, if line.is_none() { word } else { 0 });
            let next = sites.sites.len() as u32;
            let site = *known.entry(key).or_insert(next);
            if site == next {
                let function = program.function(word).map(str::to_owned);
                sites.sites.push(ShadowSite { line, call, function, words: Vec::new() });
            }
            sites.sites[site as usize].words.push(word);
            sites.of.push(site);
        }
        for computed in &program.computed {
            sites.computed.push(sites.sites.len() as u32);
            let function = program.function(computed.words.start).map(str::to_owned);
            sites.sites.push(ShadowSite { line: Some(computed.line), call: None, function, words: Vec::new() });
        }
        sites
    }

    /// The site of a word.
    pub fn of(&self, word: u32) -> u32 {
        self.of.get(word as usize).copied().unwrap_or(0)
    }
}

/// The largest error of a kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LargestError {
    /// In units in the last place of the register.
    pub ulps: f64,
    /// As a real number in the register's format, where that is known.
    pub value: f64,
}

impl LargestError {
    fn note(&mut self, ulps: f64, scale: Option<i32>) {
        // Results are JSON numbers, which are never infinite.
        let ulps = ulps.abs().min(f64::MAX);
        self.ulps = self.ulps.max(ulps);
        if let Some(scale) = scale {
            self.value = self.value.max((ulps * power(-scale)).min(f64::MAX));
        }
    }

    fn merge(&mut self, other: &LargestError) {
        (self.ulps, self.value) = (self.ulps.max(other.ulps), self.value.max(other.value));
    }
}

/// Fraction bits of a result by its formula, and by the format that the program declares for its register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FormatGap {
    /// By the formats of the operands and the instruction's shift.
    pub computed: i32,
    /// By the directive that says what the register holds.
    pub declared: i32,
}

/// Errors of one line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineErrors {
    /// Results with shadows.
    pub results: u64,
    /// Largest difference between a result and the exact formula on the machine's own numbers: what the line adds.
    pub brought: LargestError,
    /// Largest difference that came with the operands, as the formula makes it of them.
    pub arrived: LargestError,
    /// Results that are off by a unit or more: they did not fit.
    pub saturated: u64,
    /// Decisions on numbers of which one at least has a shadow; those on integers are left out.
    pub decisions: u64,
    /// Decisions that the shadow would have taken otherwise.
    pub turned: u64,
    /// Results of which cancellation left fewer than [`FEW_GOOD_BITS`] good bits.
    pub cancelled: u64,
    /// Fewest good bits of those.
    pub fewest_bits: Option<f64>,
    /// Shadows of which cancellation left fewer than [`FEW_GOOD_BITS`] good bits themselves.
    pub doubtful: u64,
    /// A shift that contradicts the declared formats.
    pub gap: Option<FormatGap>,
    /// Decisions, of this line and of others, that were turned by an error of which this line's part is the largest.
    pub turned_by: u64,
}

/// A result, as a ledger takes note of it.
#[derive(Clone, Copy, Debug)]
pub struct SettledResult {
    /// Rounding, saturation and format gap of the result, in raw units.
    pub brought: f64,
    /// Error of the operands, in raw units.
    pub arrived: f64,
    /// Fraction bits of the result, where they are known.
    pub scale: Option<i32>,
    /// The result is off by a unit or more of its own.
    pub is_saturated: bool,
    /// Good bits that cancellation left, where it left few.
    pub cancelled: Option<f64>,
    /// The shadow itself has few good bits.
    pub is_doubtful: bool,
    /// A shift that contradicts the declared formats.
    pub gap: Option<FormatGap>,
}

impl LineErrors {
    fn note(&mut self, result: &SettledResult) {
        self.results += 1;
        self.brought.note(result.brought, result.scale);
        self.arrived.note(result.arrived, result.scale);
        self.saturated += u64::from(result.is_saturated);
        self.doubtful += u64::from(result.is_doubtful);
        if let Some(bits) = result.cancelled {
            self.cancelled += 1;
            self.fewest_bits = Some(self.fewest_bits.map_or(bits, |fewest| fewest.min(bits)));
        }
        self.gap = self.gap.or(result.gap);
    }

    /// Adds those of other runs.
    pub fn merge(&mut self, other: &LineErrors) {
        self.results += other.results;
        self.brought.merge(&other.brought);
        self.arrived.merge(&other.arrived);
        self.saturated += other.saturated;
        self.decisions += other.decisions;
        self.turned += other.turned;
        self.cancelled += other.cancelled;
        self.fewest_bits = match (self.fewest_bits, other.fewest_bits) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        self.doubtful += other.doubtful;
        self.gap = self.gap.or(other.gap);
        self.turned_by += other.turned_by;
    }
}

/// Errors of all lines, by the numbers of their sites.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShadowLedger {
    /// Errors by site.
    pub lines: Vec<LineErrors>,
}

impl ShadowLedger {
    /// A ledger of so many sites.
    pub fn new(sites: usize) -> ShadowLedger {
        ShadowLedger { lines: vec![LineErrors::default(); sites] }
    }

    /// Notes a result of a line.
    pub fn note(&mut self, site: u32, result: &SettledResult) {
        if let Some(line) = self.lines.get_mut(site as usize) {
            line.note(result);
        }
    }

    /// Notes decisions of a line.
    pub fn decide(&mut self, site: u32, decisions: u32, turned: u32) {
        if let Some(line) = self.lines.get_mut(site as usize) {
            line.decisions += u64::from(decisions);
            line.turned += u64::from(turned);
        }
    }

    /// Notes that a shift of a line contradicts a format that is declared further on, and how much that makes of one number.
    pub fn note_gap(&mut self, site: u32, gap: FormatGap, brought: f64) {
        if let Some(line) = self.lines.get_mut(site as usize) {
            line.brought.note(brought, Some(gap.declared));
            line.gap = line.gap.or(Some(gap));
        }
    }

    /// Notes that a line's error has turned a decision.
    pub fn blame(&mut self, site: u32) {
        if let Some(line) = self.lines.get_mut(site as usize) {
            line.turned_by += 1;
        }
    }

    /// Adds a ledger of the same sites.
    pub fn merge(&mut self, other: &ShadowLedger) {
        self.lines.iter_mut().zip(&other.lines).for_each(|(line, other)| line.merge(other));
    }
}
