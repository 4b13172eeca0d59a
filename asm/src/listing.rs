//! The listing: what each line became, with expansions, constants and errors beside the lines that they come from.

use std::fmt::Write;
use std::sync::Arc;

use messages::{Severity, Source};

use crate::Attempt;
use crate::assembler::Section;

/// A line as it was read, in the order of reading.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    pub source: u16,
    pub line: u32,
    /// Number of macro calls and repetitions around the line.
    pub depth: u8,
    pub section: Section,
    /// Words or octets that it made.
    pub made: std::ops::Range<u32>,
    /// The number that it names.
    pub value: Option<i64>,
    /// Note on a register, from `.holds`.
    pub note: Option<String>,
    /// The text with arguments put in, where that differs from the file's.
    pub text: Option<Arc<str>>,
}

/// Words alike behind a first one that make a gap.
const WORDS_A_GAP: usize = 8;

/// Octets of data on one row.
const OCTETS_A_ROW: usize = 8;

/// The listing of a source, whether it assembled or not. Addresses of code are in words, those of the buffer, behind a
/// `b`, in octets; `+` marks lines of macros and repetitions, `=` the values of constants.
pub fn listing(attempt: &Attempt) -> String {
    let mut messages = line_messages(attempt);
    let mut text = String::new();
    let mut shown_source = None;
    let texts: Vec<Vec<&str>> = attempt.program.sources.iter().map(|source| source.text.lines().collect()).collect();
    for record in &attempt.records {
        // Name the file wherever lines of another one follow
        if shown_source != Some(record.source) {
            let source = &attempt.program.sources[record.source as usize];
            let _ = writeln!(text, "{}{}", if shown_source.is_some() { "\n" } else { "" }, source.name);
            shown_source = Some(record.source);
        }
        // Show a line of a macro with its arguments put in, any other as it stands in the file
        let file_line = texts[record.source as usize].get(record.line as usize - 1).copied().unwrap_or("");
        let line = record.text.as_deref().unwrap_or(file_line.trim_start_matches('\u{feff}')).trim_end();
        let mark = "+".repeat(record.depth.min(3).into());
        // Put the first row of contents beside the line, the others below
        let mut rows = made(attempt, record).into_iter();
        let first = rows.next().unwrap_or_default();
        let _ = writeln!(text, "{}", format!("{first:<33} {:>5}{mark:<3} {line}", record.line).trim_end());
        for row in rows {
            let _ = writeln!(text, "{row}");
        }
        // A repetition reads a line more than once: its messages stand behind the first time alone.
        let at = (record.source, record.line);
        while let Some(place) = messages.iter().position(|(line, _)| *line == at) {
            let _ = writeln!(text, "**** {}", messages.remove(place).1);
        }
    }
    for (_, message) in messages {
        let _ = writeln!(text, "**** {message}");
    }
    text
}

/// The address and contents columns of a line, a row each.
fn made(attempt: &Attempt, record: &Record) -> Vec<String> {
    let range = record.made.start as usize..record.made.end as usize;
    if let Some(value) = record.value {
        return vec![format!("{:>13}= {value}", "")];
    }
    if let Some(note) = &record.note {
        return vec![format!("{:>13}  {note}", "")];
    }
    match record.section {
        Section::Code => {
            let words = attempt.program.words.get(range.clone()).unwrap_or_default();
            // A gap is one row, however long it is.
            if let [word, rest @ ..] = words
                && rest.len() >= WORDS_A_GAP
                && rest.iter().all(|other| other == word)
            {
                return vec![format!("  {:06x}  {word:08x} x {}", range.start, words.len())];
            }
            (range.start..).zip(words).map(|(address, word)| format!("  {address:06x}  {word:08x}")).collect()
        }
        Section::Buffer => {
            let octets = attempt.program.buffer.get(range.clone()).unwrap_or_default();
            let row = |(place, octets): (usize, &[u8])| {
                let digits: String = octets.iter().map(|octet| format!("{octet:02x}")).collect::<Vec<_>>().join(" ");
                format!("b {:06x}  {digits}", range.start + place * OCTETS_A_ROW)
            };
            let rows = octets.chunks(OCTETS_A_ROW).enumerate();
            if octets.len() > 4 * OCTETS_A_ROW {
                let mut shown: Vec<String> = rows.take(3).map(row).collect();
                shown.push(format!("{:>10}{} octets more", "", octets.len() - 3 * OCTETS_A_ROW));
                shown
            } else {
                rows.map(row).collect()
            }
        }
    }
}

type SourceLine = (u16, u32);

/// The messages in short, by line.
fn line_messages(attempt: &Attempt) -> Vec<(SourceLine, String)> {
    let index = |source: &Arc<Source>| attempt.program.sources.iter().position(|other| Arc::ptr_eq(other, source));
    let one = |message: &messages::Diagnostic| {
        let at = message.place.as_ref().and_then(|(place, _)| {
            let (line, _) = place.source.line_column(place.span.start);
            Some((index(&place.source)? as u16, line as u32))
        });
        let severity = match message.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note { .. } => "note",
        };
        let code = message.code.map_or(String::new(), |code| format!("[{code}]"));
        (at.unwrap_or((u16::MAX, 0)), format!("{severity}{code}: {}", message.message))
    };
    attempt.report.0.iter().map(one).collect()
}
