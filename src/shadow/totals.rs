//! Totals of shadows over cores, pixels and pieces of a picture, by source line.

use std::collections::BTreeMap;

use emu::shadow::{Deviation, ErrorParts, LineErrors, LongReal, ShadowLedger, ShadowNumber, ShadowProgram};
use isa::Program;
use isa::program::Line;

use super::result::{DiedLine, FormatGapResult, OutputPart, ShadowFunction, ShadowLine, ShadowOutput, ShadowResult};

/// Numbers with the largest errors that are shown.
const WORST: usize = 10;

/// Parts of an error that are shown of each.
const PARTS: usize = 5;

/// A source line within a function.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SiteKey {
    /// True for the main processor's program.
    pub is_main: bool,
    /// Source and line, outside of macros; of a program without sources the word.
    pub place: (u16, u32),
    /// Source and line within a macro.
    pub macro_place: Option<(u16, u32)>,
    /// Function around it.
    pub function: Option<String>,
}

/// Programs of a run with their sites: that of the cores, and that of the main processor, whose sites follow.
#[derive(Clone, Copy)]
pub struct SourcePrograms<'a> {
    /// The cores' program.
    pub core: (&'a Program, &'a ShadowProgram),
    /// The main processor's program, where there is one.
    pub main: Option<(&'a Program, &'a ShadowProgram)>,
}

impl SourcePrograms<'_> {
    /// The line of a site among those of both programs.
    fn key(&self, site: u32) -> Option<SiteKey> {
        let of = |program: &ShadowProgram, is_main: bool| {
            let site = program.sites.sites.get(site.checked_sub(program.first_site)? as usize)?;
            let word = site.words.first().copied().unwrap_or(0);
            let of_line = |line: Line| (line.source, line.line);
            let place = site.call.or(site.line).map_or((u16::MAX, word), of_line);
            let macro_place = site.call.and(site.line).map(of_line);
            Some(SiteKey { is_main, place, macro_place, function: site.function.clone() })
        };
        let main = self.main.and_then(|(_, main)| of(main, true));
        main.or_else(|| of(self.core.1, false))
    }

    /// `file:line` of a site.
    pub fn place(&self, site: u32) -> String {
        self.key(site).map_or_else(String::new, |key| self.line(&key).place)
    }

    /// `file:line` of a line, with that in the macro, and its text.
    fn line(&self, key: &SiteKey) -> SourcePlace {
        let program = match (key.is_main, self.main) {
            (true, Some((main, _))) => main,
            _ => self.core.0,
        };
        let named = |(source, line): (u16, u32)| {
            program.sources.get(usize::from(source)).map(|file| format!("{}:{line}", file.name))
        };
        let (source, line) = key.place;
        let text = program.line_text(Line { source, line }).unwrap_or_default();
        let text = text.split(';').next().unwrap_or_default();
        SourcePlace {
            place: named(key.place).unwrap_or_else(|| format!("word {line}")),
            macro_place: key.macro_place.and_then(named),
            text: text.split_whitespace().collect::<Vec<_>>().join(" "),
        }
    }
}

/// A line as people are shown it.
struct SourcePlace {
    place: String,
    macro_place: Option<String>,
    text: String,
}

/// All that is known of a line.
#[derive(Clone, Debug, Default)]
struct LineTotals {
    errors: LineErrors,
    /// Sum of the magnitudes of its parts of final errors, each with its weight.
    weighted: f64,
    /// Largest part of one final error.
    largest: f64,
    outputs: u64,
}

/// Weight of a number at the end among others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputWeight {
    /// Units count alike, as in pixels, which have one format.
    Units,
    /// Numbers count alike, whatever their formats.
    #[cfg_attr(not(feature = "cli"), expect(dead_code, reason = "only commands run a program by itself"))]
    Shares,
}

/// Totals of shadows.
#[derive(Clone, Debug, Default)]
pub struct ShadowTotals {
    lines: BTreeMap<SiteKey, LineTotals>,
    /// Weighted magnitudes of the parts without a line.
    rest: f64,
    compared: u64,
    different: u64,
    largest: f64,
    squares: f64,
    /// The worst numbers, with their parts by line.
    worst: Vec<(ShadowOutput, Vec<(SiteKey, f64)>)>,
}

/// A number of a register or of memory with its shadow.
#[derive(Clone, Copy)]
pub struct ShadowedNumber<'a> {
    /// The machine's number.
    pub raw: i64,
    /// Fraction bits, where they are known.
    pub scale: Option<i32>,
    /// The shadow; `None` of an integer.
    pub shadow: Option<&'a ShadowNumber>,
}

/// A number as JSON has it, which knows none that is infinite.
fn finite(number: f64) -> f64 {
    number.clamp(f64::MIN, f64::MAX)
}

/// Error of a machine's number in its units.
pub(super) fn error_of(raw: i64, deviation: &Deviation) -> f64 {
    finite(LongReal::whole(raw.into()).minus(&deviation.real).to_f64())
}

/// Significant bits of a number that an error leaves.
pub(super) fn good_bits(real: &LongReal, error: f64) -> f64 {
    let bits = real.to_f64().abs().log2() - error.abs().log2();
    if bits.is_finite() { bits.max(0.0) } else { 0.0 }
}

impl ShadowTotals {
    /// Adds the errors by line of a program.
    pub fn add_ledger(&mut self, programs: &SourcePrograms, program: &ShadowProgram, ledger: &ShadowLedger) {
        for (site, errors) in (program.first_site..).zip(&ledger.lines) {
            if errors.results == 0 && errors.decisions == 0 {
                continue;
            }
            if let Some(key) = programs.key(site) {
                self.lines.entry(key).or_default().errors.merge(errors);
            }
        }
    }

    /// Adds a number at the end.
    pub fn add_output(
        &mut self,
        programs: &SourcePrograms,
        name: impl FnOnce() -> String,
        number: ShadowedNumber,
        weight: OutputWeight,
    ) {
        self.compared += 1;
        let Some(deviation) = number.shadow.and_then(|shadow| shadow.deviation.as_ref()) else { return };
        let error = error_of(number.raw, deviation);
        self.different += 1;
        self.largest = self.largest.max(error.abs());
        self.squares = finite(self.squares + error * error);
        // Share the error out: parts of 3 and 1 ulp weigh 3 and 1 by units, and 3/4 and 1/4 by shares
        let parts: &ErrorParts = &deviation.parts;
        let sum = parts.iter().map(|(_, amount)| amount.abs()).sum::<f64>() + parts.rest().abs();
        let weight = match weight {
            OutputWeight::Units => 1.0,
            OutputWeight::Shares => {
                if sum == 0.0 {
                    0.0
                } else {
                    1.0 / sum
                }
            }
        };
        self.rest += parts.rest().abs() * weight;
        for (site, amount) in parts.iter() {
            let Some(key) = programs.key(site) else { continue };
            let line = self.lines.entry(key).or_default();
            line.weighted += amount.abs() * weight;
            line.largest = line.largest.max(amount.abs());
            line.outputs += 1;
        }
        // Keep the number if it is one of the worst; names take time, so only these get one
        let is_among = self.worst.len() < WORST
            || self.worst.last().is_some_and(|(least, _)| least.error_ulps.abs() < error.abs());
        if !is_among {
            return;
        }
        let real = |value: f64| number.scale.map(|scale| finite(value * f64::from(-scale).exp2()));
        let exact = finite(deviation.real.to_f64());
        let output = ShadowOutput {
            name: name(),
            raw: number.raw,
            exact,
            real: real(number.raw as f64),
            exact_real: real(exact),
            error_ulps: error,
            good_bits: good_bits(&deviation.real, error),
            parts: Vec::new(),
        };
        let mut by_line: Vec<(SiteKey, f64)> =
            parts.iter().filter_map(|(site, amount)| Some((programs.key(site)?, amount))).collect();
        by_line.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        by_line.truncate(PARTS);
        // Behind those of equal errors, so that the first stay first.
        let at = self.worst.partition_point(|(other, _)| other.error_ulps.abs() >= error.abs());
        self.worst.insert(at, (output, by_line));
        self.worst.truncate(WORST);
    }

    /// Adds the totals of another piece.
    pub fn merge(&mut self, other: ShadowTotals) {
        for (key, more) in other.lines {
            let line = self.lines.entry(key).or_default();
            line.errors.merge(&more.errors);
            line.weighted += more.weighted;
            line.largest = line.largest.max(more.largest);
            line.outputs += more.outputs;
        }
        self.rest += other.rest;
        self.compared += other.compared;
        self.different += other.different;
        self.largest = self.largest.max(other.largest);
        self.squares = finite(self.squares + other.squares);
        self.worst.extend(other.worst);
        // Stable, so that of equal errors those of the first piece stay first.
        self.worst.sort_by(|(a, _), (b, _)| b.error_ulps.abs().total_cmp(&a.error_ulps.abs()));
        self.worst.truncate(WORST);
    }

    /// The result, with places and texts of lines.
    pub fn result(&self, programs: &SourcePrograms) -> ShadowResult {
        let weighted = self.lines.values().map(|line| line.weighted).sum::<f64>() + self.rest;
        let share = |part: f64| if weighted == 0.0 { 0.0 } else { part / weighted };
        let (mut mistakes, mut died): (Vec<DiedLine>, Vec<DiedLine>) = Default::default();
        let mut lines = Vec::new();
        let mut functions: BTreeMap<(bool, Option<String>), ShadowFunction> = BTreeMap::new();
        for (key, totals) in &self.lines {
            let SourcePlace { place, macro_place, text: source } = programs.line(key);
            let (function, is_main, errors) = (key.function.clone(), key.is_main, &totals.errors);
            // A shift that contradicts the formats is a mistake, even where decisions have hidden what it did to the numbers.
            let is_mistake = errors.gap.is_some();
            if totals.weighted != 0.0 || is_mistake || errors.turned_by != 0 {
                let died = if is_mistake { &mut mistakes } else { &mut died };
                died.push(DiedLine {
                    place: place.clone(),
                    macro_place: macro_place.clone(),
                    function: function.clone(),
                    source: source.clone(),
                    is_main,
                    share: share(totals.weighted),
                    largest_ulps: totals.largest,
                    outputs: totals.outputs,
                    turned_by: errors.turned_by,
                });
            }
            let sum = functions.entry((is_main, function.clone())).or_insert_with(|| ShadowFunction::new(key));
            sum.add(errors, share(totals.weighted));
            lines.push(ShadowLine::new(place, macro_place, source, key, errors));
        }
        // Of equal shares the first line comes first.
        let ranked = |mut lines: Vec<DiedLine>| {
            lines.sort_by(|a, b| b.share.total_cmp(&a.share).then(b.turned_by.cmp(&a.turned_by)));
            lines
        };
        let where_precision_died = [ranked(mistakes), ranked(died)].concat();
        let outputs = self.worst.iter().map(|(output, parts)| {
            let part = |(key, ulps): &(SiteKey, f64)| OutputPart {
                place: programs.line(key).place,
                function: key.function.clone(),
                ulps: *ulps,
            };
            ShadowOutput { parts: parts.iter().map(part).collect(), ..output.clone() }
        });
        ShadowResult {
            compared: self.compared,
            different: self.different,
            largest_ulps: self.largest,
            root_mean_square_ulps: if self.compared == 0 { 0.0 } else { (self.squares / self.compared as f64).sqrt() },
            where_precision_died,
            other_share: share(self.rest),
            outputs: outputs.collect(),
            decisions: lines.iter().map(|line: &ShadowLine| line.decisions).sum(),
            turned: lines.iter().map(|line| line.turned).sum(),
            lines,
            functions: functions.into_values().collect(),
        }
    }
}

impl ShadowLine {
    fn new(
        place: String,
        macro_place: Option<String>,
        source: String,
        key: &SiteKey,
        errors: &LineErrors,
    ) -> ShadowLine {
        ShadowLine {
            place,
            macro_place,
            function: key.function.clone(),
            source,
            is_main: key.is_main,
            results: errors.results,
            brought_ulps: errors.brought.ulps,
            brought: errors.brought.value,
            arrived_ulps: errors.arrived.ulps,
            arrived: errors.arrived.value,
            saturated: errors.saturated,
            decisions: errors.decisions,
            turned: errors.turned,
            turned_by: errors.turned_by,
            cancelled: errors.cancelled,
            fewest_good_bits: errors.fewest_bits,
            doubtful: errors.doubtful,
            format_gap: errors.gap.map(|gap| FormatGapResult { computed: gap.computed, declared: gap.declared }),
        }
    }
}

impl ShadowFunction {
    fn new(key: &SiteKey) -> ShadowFunction {
        ShadowFunction {
            function: key.function.clone(),
            is_main: key.is_main,
            share: 0.0,
            brought_ulps: 0.0,
            brought: 0.0,
            arrived_ulps: 0.0,
            arrived: 0.0,
            saturated: 0,
            turned: 0,
        }
    }

    fn add(&mut self, errors: &LineErrors, share: f64) {
        self.share += share;
        self.brought_ulps = self.brought_ulps.max(errors.brought.ulps);
        self.brought = self.brought.max(errors.brought.value);
        self.arrived_ulps = self.arrived_ulps.max(errors.arrived.ulps);
        self.arrived = self.arrived.max(errors.arrived.value);
        self.saturated += errors.saturated;
        self.turned += errors.turned;
    }
}
