//! The text of a row: mnemonic, operands, pattern, outcomes with their costs, as a row of the table has them.

use std::ops::Range;
use std::sync::Arc;

use isa::definition::{DefinitionError, InstructionDef, Kind, Operand, OutcomeDef};
use isa::pattern::{BitPattern, CUSTOM, LETTERS, PatternError};
use isa::{Class, Counts};
use messages::{Diagnostic, Source, did_you_mean};

use super::{MOST_COST, error};
use crate::explain;
use crate::token::{continues_name, starts_name};

/// A row with the places of its parts.
pub(super) struct Drawn {
    pub row: InstructionDef,
    pub name_at: Range<usize>,
    pub pattern_at: Range<usize>,
    pub outcomes_at: Vec<Range<usize>>,
    /// Place of a cost for each unit, if there is one.
    pub each_at: Option<Range<usize>>,
    pub start: usize,
    pub end: usize,
}

type RowRead<T> = Result<T, Box<Diagnostic>>;

/// The form of a row, for hints.
const WRITTEN: &str = "a row is written: name (d: V, a: V) \"custom0 ddddd aaaaa ----------------\" [Done(add 3)]";

struct Scanner<'a> {
    source: &'a Arc<Source>,
    at: usize,
}

impl<'a> Scanner<'a> {
    fn rest(&self) -> &'a str {
        &self.source.text[self.at..]
    }

    fn skip_blanks(&mut self) {
        self.at += self.rest().len() - self.rest().trim_start().len();
    }

    fn wrong(&self, message: impl Into<String>, span: Range<usize>, label: &str) -> Diagnostic {
        error(explain::ROW, message, self.source, span, label)
    }

    /// Something else was expected here.
    fn expected(&mut self, what: &str) -> Box<Diagnostic> {
        self.skip_blanks();
        let found: String = self.rest().chars().take_while(|c| !c.is_whitespace()).take(20).collect();
        let message = match found.is_empty() {
            true => format!("expected {what}, but the file ends"),
            false => format!("expected {what}, found `{found}`"),
        };
        Box::new(self.wrong(message, self.at..self.at + found.len().min(1), "in this row").hint(WRITTEN))
    }

    fn accept(&mut self, mark: &str) -> bool {
        self.skip_blanks();
        let is_here = self.rest().starts_with(mark);
        self.at += if is_here { mark.len() } else { 0 };
        is_here
    }

    fn expect(&mut self, mark: &str) -> RowRead<()> {
        if self.accept(mark) { Ok(()) } else { Err(self.expected(&format!("`{mark}`"))) }
    }

    fn word(&mut self, what: &str) -> RowRead<(&'a str, Range<usize>)> {
        self.skip_blanks();
        let rest = self.rest();
        let length = rest.find(|c| !continues_name(c)).unwrap_or(rest.len());
        if length == 0 || !rest.starts_with(starts_name) {
            return Err(self.expected(what));
        }
        let span = self.at..self.at + length;
        self.at = span.end;
        Ok((&rest[..length], span))
    }

    fn number(&mut self) -> RowRead<(u64, Range<usize>)> {
        self.skip_blanks();
        let rest = self.rest();
        let length = rest.find(|c: char| !(c.is_ascii_digit() || c == '_')).unwrap_or(rest.len());
        if length == 0 || rest.starts_with('_') {
            return Err(self.expected("a number of operations"));
        }
        let span = self.at..self.at + length;
        self.at = span.end;
        // Digits beyond 64 bits are too many in any case.
        let digits: String = rest[..length].chars().filter(|&c| c != '_').collect();
        let value = digits.parse().unwrap_or(u64::MAX);
        if value > MOST_COST {
            let message = format!("an outcome costs at most {MOST_COST} operations of a class, not {digits}");
            let hint = "a cost counts elementary operations: 3 for the addition of two vectors";
            return Err(Box::new(self.wrong(message, span, "too many").hint(hint)));
        }
        Ok((value, span))
    }
}

/// The row whose text starts at that octet.
pub(super) fn parse(source: &Arc<Source>, start: usize) -> RowRead<Drawn> {
    let mut scanner = Scanner { source, at: start };
    scanner.skip_blanks();
    let start = scanner.at;
    let (name, name_at) = scanner.word("the name of the instruction")?;
    if name.chars().any(|c| c.is_ascii_uppercase() || c == '$') {
        let message = format!("`{name}` is no name of an instruction");
        return Err(Box::new(scanner.wrong(message, name_at, "small letters, digits and `_`")));
    }
    let operands = operands(&mut scanner)?;
    let (pattern, drawn, pattern_at) = pattern(&mut scanner, &operands)?;
    let mut each_at = None;
    let (outcomes, outcomes_at) = outcomes(&mut scanner, &mut each_at)?;
    let only: Vec<Operand> = operands.iter().map(|(operand, _)| *operand).collect();
    if let Err(wrong) = InstructionDef::check(&only, &pattern, outcomes.len()) {
        return Err(misfit(&scanner, wrong, &operands, &pattern, pattern_at));
    }
    let row = InstructionDef {
        name: name.to_owned().into(),
        doc: "".into(),
        room: "".into(),
        operands: only.into(),
        pattern,
        drawn: drawn.to_owned().into(),
        outcomes: outcomes.into(),
    };
    Ok(Drawn { row, name_at, pattern_at, outcomes_at, each_at, start, end: scanner.at })
}

fn operands(scanner: &mut Scanner) -> RowRead<Vec<(Operand, Range<usize>)>> {
    let mut operands: Vec<(Operand, Range<usize>)> = Vec::new();
    scanner.expect("(")?;
    if scanner.accept(")") {
        return Ok(operands);
    }
    loop {
        let (letter, letter_at) = scanner.word("the letter of an operand")?;
        let is_letter = letter.len() == 1 && LETTERS.contains(&letter.as_bytes()[0]);
        if !is_letter {
            let message = format!("`{letter}` is no letter of an operand");
            let hint = "`d e` are written, `x y` read and written, `a b c` read, `i j` immediate";
            return Err(Box::new(scanner.wrong(message, letter_at, "not one of dexyabcij").hint(hint)));
        }
        scanner.expect(":")?;
        let (kind_text, kind_at) = scanner.word("the kind of the operand")?;
        let Some(kind) = Kind::from_name(kind_text) else {
            let names = Kind::ALL.map(Kind::name);
            let hint = did_you_mean(kind_text, names).unwrap_or_else(|| format!("there are {}", names.join(", ")));
            let message = format!("`{kind_text}` is no kind of operand");
            return Err(Box::new(scanner.wrong(message, kind_at, "not known").hint(hint)));
        };
        // Immediates are `i` and `j`, registers the other letters.
        let letter = letter.as_bytes()[0];
        if matches!(letter, b'i' | b'j') != kind.register_file().is_none() {
            let (is, wants) = match kind.register_file() {
                Some(_) => ("a register", "one of d e x y a b c"),
                None => ("an immediate", "`i` or `j`"),
            };
            let message = format!("`{}` is {is}, so its letter is {wants}", kind.name());
            return Err(Box::new(scanner.wrong(message, letter_at, "the letter does not go with the kind")));
        }
        if operands.iter().any(|(other, _)| other.letter == letter) {
            let message = format!("two operands have the letter `{}`", letter as char);
            return Err(Box::new(scanner.wrong(message, letter_at, "second one")));
        }
        operands.push((Operand { letter, kind }, letter_at.start..kind_at.end));
        if scanner.accept(")") {
            return Ok(operands);
        }
        scanner.expect(",")?;
    }
}

fn pattern<'a>(
    scanner: &mut Scanner<'a>,
    operands: &[(Operand, Range<usize>)],
) -> RowRead<(BitPattern, &'a str, Range<usize>)> {
    scanner.expect("\"").map_err(|_| scanner.expected("the word as a bit pattern, in quotation marks"))?;
    let rest = scanner.rest();
    // The pattern ends in its line, so that a missing mark does not swallow the file.
    let length = rest.find(['"', '\n']).filter(|&end| rest[end..].starts_with('"'));
    let Some(length) = length else {
        let start = scanner.at - 1;
        return Err(Box::new(scanner.wrong(
            "the pattern has no closing quotation mark",
            start..start + 1,
            "opened here",
        )));
    };
    let (text, span) = (&rest[..length], scanner.at..scanner.at + length);
    scanner.at = span.end + 1;
    // Point at what is wrong: the character, the second piece of a field, or the whole.
    let pattern = BitPattern::parse(text).map_err(|wrong| {
        let at = |octet: usize| {
            span.start + octet..span.start + octet + text[octet..].chars().next().map_or(1, char::len_utf8)
        };
        let (place, hint) = match wrong {
            PatternError::Character(octet) => {
                (at(octet), String::from("0 and 1 are fixed bits, a letter is a bit of its operand, `-` is 0"))
            }
            PatternError::Split(letter) => {
                let last = text.rfind(letter as char).unwrap_or(0);
                (at(last), "the bits of a field stand side by side".to_owned())
            }
            PatternError::Length(bits) => {
                let has_major = CUSTOM.iter().any(|(name, _)| text.starts_with(name));
                let rule = if has_major { "`custom0` stands for 6 bits; " } else { "" };
                let change = match bits < 32 {
                    true => format!("add {} `-`", 32 - bits),
                    false => format!("leave out {}", bits - 32),
                };
                (span.clone(), format!("{rule}{change}"))
            }
            PatternError::TooManyFields => (span.clone(), "leave out operands".to_owned()),
        };
        Box::new(scanner.wrong(wrong.to_string(), place, "cannot be read").hint(hint))
    })?;
    // Words of the table keep their opcodes, so that programs of all extensions decode alike.
    if !pattern.is_custom() {
        let wide: u32 =
            operands.iter().filter_map(|(operand, _)| pattern.field(operand.letter)).map(|f| u32::from(f.width)).sum();
        let message = "the word stands outside of the opcodes kept for extensions";
        let majors: Vec<String> = CUSTOM.iter().map(|(name, bits)| format!("{name} ({bits})")).collect();
        let hint = format!(
            "begin the pattern with one of {}; 26 bits are left, of which operands take {wide}",
            majors.join(", ")
        );
        let first = span.start..span.start + text.len().min(6);
        return Err(Box::new(scanner.wrong(message, first, "the major opcode").hint(hint)));
    }
    Ok((pattern, text, span))
}

fn misfit(
    scanner: &Scanner,
    wrong: DefinitionError,
    operands: &[(Operand, Range<usize>)],
    pattern: &BitPattern,
    pattern_at: Range<usize>,
) -> Box<Diagnostic> {
    let of = |letter: u8| operands.iter().find(|(operand, _)| operand.letter == letter);
    match wrong {
        DefinitionError::Field(letter) => {
            // Point at the operand and at the pattern: of `i: Sh` drawn as `iiiii`, 5 bits where 6 are needed, either may be what is wrong
            let Some((operand, at)) = of(letter) else {
                return Box::new(scanner.wrong("a field without an operand", pattern_at, "here"));
            };
            let (letter, kind) = (letter as char, operand.kind);
            let message = match (pattern.field(operand.letter), kind.width()) {
                (Some(field), Some(width)) => {
                    format!("the field `{letter}` has {} bits, but `{}` needs {width}", field.width, kind.name())
                }
                _ => format!("the pattern has no field for operand `{letter}`"),
            };
            let hint = match kind.width() {
                Some(width) => format!("draw it as {}", (letter.to_string()).repeat(width.into())),
                None => format!("draw it with as many `{letter}` as it has bits"),
            };
            let message = scanner.wrong(message, at.clone(), "this operand");
            Box::new(message.also(messages::Place::new(scanner.source, pattern_at), "the pattern").hint(hint))
        }
        DefinitionError::Spare => {
            let spare = pattern.fields().iter().find(|field| of(field.letter).is_none());
            let letter = spare.map_or('?', |field| field.letter as char);
            let message = format!("the pattern has a field `{letter}`, but the row no such operand");
            // Suggest an operand that goes with the letter: `i` and `j` are immediates, all others registers
            let hint = format!(
                "add an operand such as `{letter}: {}`, or draw the bits as `-`",
                if matches!(letter, 'i' | 'j') { "Un" } else { "S" }
            );
            Box::new(scanner.wrong(message, pattern_at, "in this pattern").hint(hint))
        }
        // Operands and outcomes were checked for these as they were read.
        DefinitionError::Twice(_) | DefinitionError::Letter(_) | DefinitionError::NoOutcome => {
            Box::new(scanner.wrong("the row cannot be read", pattern_at, "here"))
        }
    }
}

fn outcomes(
    scanner: &mut Scanner,
    each_at: &mut Option<Range<usize>>,
) -> RowRead<(Vec<OutcomeDef>, Vec<Range<usize>>)> {
    scanner.expect("[")?;
    let (mut outcomes, mut places): (Vec<OutcomeDef>, Vec<Range<usize>>) = (Vec::new(), Vec::new());
    loop {
        let (name, name_at) = scanner.word("the name of an outcome, such as `Done`")?;
        if outcomes.iter().any(|other| other.name == name) {
            let message = format!("two outcomes are called `{name}`");
            return Err(Box::new(scanner.wrong(message, name_at, "second one").hint("the name tells outcomes apart")));
        }
        scanner.expect("(")?;
        let outcome = cost(scanner, name, each_at)?;
        // All outcomes are counted in one way.
        if let Some(first) = outcomes.first()
            && first.is_body != outcome.is_body
        {
            let message = "either all outcomes cost what the body does, or none";
            return Err(Box::new(
                scanner
                    .wrong(message, name_at, "not as the first one")
                    .hint("what was executed is counted before it is known which outcome is taken"),
            ));
        }
        outcomes.push(outcome);
        places.push(name_at.start..scanner.at);
        if outcomes.len() > 32 {
            return Err(Box::new(scanner.wrong("an instruction has at most 32 outcomes", name_at, "one too many")));
        }
        if scanner.accept("]") {
            return Ok((outcomes, places));
        }
        scanner.expect(",")?;
    }
}

/// The contents of an outcome's parentheses, the closing one included; `each_at` gets the place of a cost for each unit.
fn cost(scanner: &mut Scanner, name: &str, each_at: &mut Option<Range<usize>>) -> RowRead<OutcomeDef> {
    let mut outcome =
        OutcomeDef { name: name.to_owned().into(), cost: Counts::ZERO, each: Counts::ZERO, is_body: false };
    if scanner.accept(")") {
        return Ok(outcome);
    }
    let mut named: Vec<Class> = Vec::new();
    let mut is_each = false;
    loop {
        // Behind the semicolon follows the cost of each unit.
        if !is_each && scanner.accept(";") {
            let at = scanner.at - 1;
            *each_at = Some(at..at + 1);
            (is_each, named) = (true, Vec::new());
            scanner.expect("each")?;
        }
        let (class_text, class_at) = scanner.word("a class of operations")?;
        // `body` stands alone: the sum of the steps, whatever they are.
        if class_text == "body" && named.is_empty() && !is_each {
            outcome.is_body = true;
            scanner.expect(")")?;
            return Ok(outcome);
        }
        let Some(class) = Class::from_name(class_text) else {
            let names = Class::ALL.iter().map(|class| class.name());
            let hint = did_you_mean(class_text, names.clone()).unwrap_or_else(|| {
                format!("there are {}, and `body` for the sum of the body", names.collect::<Vec<_>>().join(", "))
            });
            let message = format!("`{class_text}` is no class of operations");
            return Err(Box::new(scanner.wrong(message, class_at, "not known").hint(hint)));
        };
        if named.contains(&class) {
            let message = format!("the class `{class_text}` is named twice");
            return Err(Box::new(scanner.wrong(message, class_at, "second one")));
        }
        named.push(class);
        let counts = if is_each { &mut outcome.each } else { &mut outcome.cost };
        (counts[class], _) = scanner.number()?;
        if scanner.accept(")") {
            return Ok(outcome);
        }
        if is_each || !scanner.rest().trim_start().starts_with(';') {
            scanner.expect(",")?;
        }
    }
}
