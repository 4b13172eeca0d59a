//! Vectors of operands and results as comma-separated values, one a line.

use std::ops::Range;
use std::sync::Arc;

use super::operation::{Format, Number, Operation, OperationOutcome, operate};
use isa::number::{Overflow, Quantization};
use messages::{Diagnostic, Place, Report, Source, did_you_mean};

/// The first line of a file of vectors: the names of its columns.
///
/// For each operand and the result `s` or `u`, the word's bits, its integer bits (which count the sign), and the raw number; then
/// the modes, the number of saturated bits, and whether bits were lost and whether the result did not fit.
pub const HEADER: &str = "op,sa,wa,ia,a,sb,wb,ib,b,sc,wc,ic,c,sr,wr,ir,q,o,n,r,qf,of";

/// Number of columns.
const COLUMNS: usize = 22;

/// Most errors that are told one by one.
const MOST_ERRORS: usize = 20;

/// An operation and the result that somebody expects.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TestVector {
    /// The vector's line in the file, from 1.
    pub line: usize,
    /// The operation.
    pub operation: Operation,
    /// With what.
    pub operands: Vec<Number>,
    /// In which format the result is.
    pub format: Format,
    /// The rounding mode.
    pub quantization: Quantization,
    /// The overflow mode.
    pub overflow: Overflow,
    /// The result that is expected, raw.
    pub raw: i128,
    /// Bits are expected to be lost; `None` when the vector does not say.
    pub is_quantized: Option<bool>,
    /// The result is expected not to fit; `None` when the vector does not say.
    pub has_overflowed: Option<bool>,
}

impl TestVector {
    /// The model's result of the operation.
    pub fn outcome(&self) -> OperationOutcome {
        operate(self.operation, &self.operands, self.format, self.quantization, self.overflow)
    }

    /// An outcome is the one that is expected.
    pub fn expects(&self, outcome: &OperationOutcome) -> bool {
        self.raw == outcome.raw
            && self.is_quantized.is_none_or(|flag| flag == outcome.is_quantized)
            && self.has_overflowed.is_none_or(|flag| flag == outcome.has_overflowed)
    }
}

/// The vectors of a file, and what is wrong with the lines that are none.
pub fn parse(source: &Arc<Source>) -> (Vec<TestVector>, Report) {
    let (mut vectors, mut report) = (Vec::new(), Report::default());
    let mut wrong = 0usize;
    let mut start = 0;
    let mut is_headed = false;
    for (line, text) in (1..).zip(source.text.split_inclusive('\n')) {
        let content = text.trim_end_matches(['\n', '\r']);
        let place = VectorLine { source, start, text: content };
        start += text.len();
        // Blank lines may stand anywhere; the first other line names the columns.
        let is_first = !is_headed;
        if content.trim().is_empty() {
            continue;
        }
        is_headed = true;
        let read = match is_first {
            true => header(&place).map(|()| None),
            false => vector(&place, line).map(Some),
        };
        match read {
            Ok(vector) => vectors.extend(vector),
            Err(error) => {
                wrong += 1;
                if wrong <= MOST_ERRORS {
                    report.0.push(*error);
                }
                // Without its head the file is no table, so no line of it is told.
                if is_first {
                    return (Vec::new(), report);
                }
            }
        }
    }
    if !is_headed {
        report.0.push(Diagnostic::error(format!("{} holds no vectors", source.name)).hint(first_line()));
    }
    if wrong > MOST_ERRORS {
        report.0.push(Diagnostic::error(format!("{} more lines are no vectors", wrong - MOST_ERRORS)));
    }
    (vectors, report)
}

fn first_line() -> String {
    format!("the first line names the columns: {HEADER}")
}

/// A line and where it begins.
struct VectorLine<'a> {
    source: &'a Arc<Source>,
    start: usize,
    text: &'a str,
}

impl VectorLine<'_> {
    fn place(&self, span: Range<usize>) -> Place {
        Place::new(self.source, self.start + span.start..self.start + span.end)
    }
}

fn header(line: &VectorLine) -> Result<(), Box<Diagnostic>> {
    let text = line.text.trim_start_matches('\u{feff}');
    if text.split(',').map(str::trim).eq(HEADER.split(',')) {
        return Ok(());
    }
    let place = line.place(0..line.text.len());
    Err(Box::new(Diagnostic::error("this line does not name the columns of vectors").at(place, "").hint(first_line())))
}

/// One field of a line.
#[derive(Clone, Copy)]
struct VectorField<'a> {
    line: &'a VectorLine<'a>,
    name: &'static str,
    text: &'a str,
    at: usize,
}

impl VectorField<'_> {
    fn error(&self, message: String, label: impl Into<String>) -> Box<Diagnostic> {
        let place = self.line.place(self.at..self.at + self.text.len());
        Box::new(Diagnostic::error(message).at(place, label))
    }

    fn is_absent(&self) -> bool {
        self.text == "-"
    }

    /// A number between two others.
    fn number(&self, range: (i128, i128)) -> Result<i128, Box<Diagnostic>> {
        let (least, largest) = range;
        let number: i128 = self
            .text
            .parse()
            .map_err(|_| self.error(format!("`{}` in column {} is no whole number", self.text, self.name), ""))?;
        if (least..=largest).contains(&number) {
            return Ok(number);
        }
        Err(self.error(format!("{number} in column {} is out of range", self.name), format!("{least} to {largest}")))
    }

    /// One of several words.
    fn word<T>(
        &self,
        what: &str,
        known: &[&'static str],
        of: impl Fn(&str) -> Option<T>,
    ) -> Result<T, Box<Diagnostic>> {
        of(self.text).ok_or_else(|| {
            let hint = did_you_mean(self.text, known.iter().copied())
                .unwrap_or_else(|| format!("known are {}", known.join(", ")));
            Box::new(self.error(format!("`{}` in column {} is no {what}", self.text, self.name), "").hint(hint))
        })
    }

    fn flag(&self) -> Result<Option<bool>, Box<Diagnostic>> {
        if self.is_absent() { Ok(None) } else { Ok(Some(self.number((0, 1))? == 1)) }
    }
}

fn vector(line: &VectorLine, number: usize) -> Result<TestVector, Box<Diagnostic>> {
    let fields = fields(line)?;
    let operation = fields[0].word("operation", &Operation::ALL.map(Operation::name), |name| {
        Operation::ALL.into_iter().find(|operation| operation.name() == name)
    })?;
    // Read the operands, four columns each; those that the operation does not have are `-`
    let mut operands = Vec::new();
    for (at, operand) in fields[1..13].chunks_exact(4).enumerate() {
        if at < operation.operands() {
            let format = format(&operand[..3])?;
            operands.push(Number { format, raw: operand[3].number(format.range())? });
        } else if let Some(field) = operand.iter().find(|field| !field.is_absent()) {
            let message = format!("`{}` has no operand in column {}", operation.name(), field.name);
            return Err(Box::new(field.error(message, "").hint("what is absent is written as -")));
        }
    }
    let format = format(&fields[13..16])?;
    // SystemC writes its modes SC_RND and SC_SAT.
    let mode = |text: &str| text.strip_prefix("SC_").unwrap_or(text).to_owned();
    let roundings: Vec<&str> = Quantization::ALL.iter().map(|mode| mode.name()).collect();
    let quantization = fields[16].word("rounding mode", &roundings, |text| Quantization::from_name(&mode(text)))?;
    // The number of saturated bits stands behind the overflow mode, but is a part of it.
    let saturated = if fields[18].is_absent() { 0 } else { fields[18].number((0, 64))? as u32 };
    let overflows: Vec<&str> = Overflow::ALL.iter().map(|mode| mode.name()).collect();
    let overflow = fields[17].word("overflow mode", &overflows, |text| {
        Overflow::from_name(&mode(text)).map(|mode| mode.with_saturated(saturated))
    })?;
    if matches!(overflow, Overflow::WrapSm(_)) && !format.is_signed {
        return Err(fields[17].error("numbers without a sign have no WRAP_SM".into(), ""));
    }
    Ok(TestVector {
        line: number,
        operation,
        operands,
        format,
        quantization,
        overflow,
        raw: fields[19].number(format.range())?,
        is_quantized: fields[20].flag()?,
        has_overflowed: fields[21].flag()?,
    })
}

fn format(fields: &[VectorField]) -> Result<Format, Box<Diagnostic>> {
    let is_signed = fields[0].word("kind of number", &["s", "u"], |text| match text {
        "s" => Some(true),
        "u" => Some(false),
        _ => None,
    })?;
    Ok(Format { is_signed, word: fields[1].number((1, 64))? as u32, integer: fields[2].number((-64, 128))? as i32 })
}

fn fields<'a>(line: &'a VectorLine) -> Result<Vec<VectorField<'a>>, Box<Diagnostic>> {
    let mut at = 0;
    let mut names = HEADER.split(',');
    let mut fields = Vec::with_capacity(COLUMNS);
    for text in line.text.split(',') {
        let Some(name) = names.next() else {
            let place = line.place(at..line.text.len());
            let message = format!("this line has more than {COLUMNS} columns");
            return Err(Box::new(Diagnostic::error(message).at(place, "these are too many")));
        };
        let trimmed = text.trim();
        let before = text.len() - text.trim_start().len();
        fields.push(VectorField { line, name, text: trimmed, at: at + before });
        at += text.len() + 1;
    }
    if fields.len() == COLUMNS {
        return Ok(fields);
    }
    let end = line.text.len();
    let message = format!("this line has {} of {COLUMNS} columns", fields.len());
    let label = format!("column {} is missing", names.next().unwrap_or_default());
    Err(Box::new(Diagnostic::error(message).at(line.place(end..end), label)))
}
