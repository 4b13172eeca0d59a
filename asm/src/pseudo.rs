//! Pseudo-instructions: what people write often and no single word can say, as data. Nothing is clobbered that the
//! line does not name.

use crate::assembler::Assembler;
use crate::cursor::Cursor;
use crate::explain;
use crate::expression::Expression;
use crate::function::ExpressionFunction;
use crate::instruction::describe;
use crate::message::{At, Problem};
use crate::operand::{ParsedOperand, Written};
use isa::definition::Kind;

/// The kind of operand that a pseudo-instruction takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PseudoPart {
    /// A register or label, as rows take it.
    Kind(Kind),
    /// A number of 32 bits, signed or unsigned.
    Number,
}

/// The condition of a form. A number that is not known where the line stands is known to no condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// No form before this one was chosen.
    Otherwise,
    /// The number of this letter is known and has 16 bits with its sign.
    IsShort(char),
    /// `x`, `y` and `z` are known to be 0.
    AreZero,
    /// `x`, `y` and `z` are known to be equal.
    AreEqual,
}

/// One expansion of a pseudo-instruction.
#[derive(Clone, Copy, Debug)]
pub struct Expansion {
    /// The condition under which it is chosen.
    pub when: When,
    /// The instructions; letters stand for the operands.
    pub lines: &'static [&'static str],
}

/// A pseudo-instruction.
#[derive(Clone, Copy, Debug)]
pub struct Pseudo {
    /// Mnemonic.
    pub name: &'static str,
    /// Operands in the order of the text.
    pub operands: &'static [(char, PseudoPart)],
    /// Expansions; the first whose condition holds is taken.
    pub forms: &'static [Expansion],
    /// The effect, in a sentence.
    pub doc: &'static str,
}

const S: PseudoPart = PseudoPart::Kind(Kind::S);
const V: PseudoPart = PseudoPart::Kind(Kind::V);
const W: PseudoPart = PseudoPart::Kind(Kind::W);
const LABEL: PseudoPart = PseudoPart::Kind(Kind::Rel);

macro_rules! always {
    ($($line:literal),+) => { &[Expansion { when: When::Otherwise, lines: &[$($line),+] }] };
}

const CONSTANT: &[Expansion] = &[
    Expansion { when: When::IsShort('i'), lines: &["movi d, i"] },
    Expansion { when: When::Otherwise, lines: &["movi d, low(i)", "movhi d, high(i)"] },
];

const VECTOR: &[Expansion] = &[
    Expansion { when: When::AreZero, lines: &["vsplat d, s0"] },
    Expansion { when: When::AreEqual, lines: &["li e, x", "vsplat d, e"] },
    Expansion {
        when: When::Otherwise,
        lines: &["li e, x", "vput d, e, 0", "li e, y", "vput d, e, 1", "li e, z", "vput d, e, 2"],
    },
];

macro_rules! pseudos {
    ($($name:literal ($($letter:literal: $part:expr),*) $forms:expr, $doc:literal;)*) => {
        /// Every pseudo-instruction, in the order of the manual.
        pub const PSEUDOS: &[Pseudo] =
            &[$(Pseudo { name: $name, operands: &[$(($letter, $part)),*], forms: $forms, doc: $doc }),*];
    };
}

pseudos! {
    "nop" () always!["mov s0, s0"], "Does nothing, at no cost where copies are free.";
    "li" ('d': S, 'i': PseudoPart::Number) CONSTANT,
        "Constant `d = i`, of 32 bits: one word when `i` is known here and fits 16 bits with its sign, else two.";
    "la" ('d': S, 'i': PseudoPart::Number) CONSTANT, "Address `d = i`: as `li`.";
    "beqz" ('a': S, 'i': LABEL) always!["beq a, s0, i"], "Branches when `a` is 0.";
    "bnez" ('a': S, 'i': LABEL) always!["bne a, s0, i"], "Branches when `a` is not 0.";
    "bltz" ('a': S, 'i': LABEL) always!["blt a, s0, i"], "Branches when `a` is negative.";
    "bgez" ('a': S, 'i': LABEL) always!["bge a, s0, i"], "Branches when `a` is not negative.";
    "bgtz" ('a': S, 'i': LABEL) always!["blt s0, a, i"], "Branches when `a` is positive.";
    "blez" ('a': S, 'i': LABEL) always!["bge s0, a, i"], "Branches when `a` is not positive.";
    "bgt" ('a': S, 'b': S, 'i': LABEL) always!["blt b, a, i"], "Branches when `a > b` as signed numbers.";
    "ble" ('a': S, 'b': S, 'i': LABEL) always!["bge b, a, i"], "Branches when `a <= b` as signed numbers.";
    "bgtu" ('a': S, 'b': S, 'i': LABEL) always!["bltu b, a, i"], "Branches when `a > b` as unsigned numbers.";
    "bleu" ('a': S, 'b': S, 'i': LABEL) always!["bgeu b, a, i"], "Branches when `a <= b` as unsigned numbers.";
    "bwgt" ('a': W, 'b': W, 'i': LABEL) always!["bwlt b, a, i"], "Branches when the wide `a > b`.";
    "j" ('i': LABEL) always!["jump i"], "Jumps.";
    "szero" ('d': S) always!["mov d, s0"], "Zero in a scalar register.";
    "vzero" ('d': V) always!["vsplat d, s0"], "Zero in all components.";
    "vset" ('d': V, 'x': PseudoPart::Number, 'y': PseudoPart::Number, 'z': PseudoPart::Number, 'e': S) VECTOR,
        "Three constants in the components of `d`, through the scalar register `e`: one word for three zeros, two or three for equal numbers, else six to nine.";
}

/// The pseudo-instruction of a name.
pub fn find(name: &str) -> Option<&'static Pseudo> {
    PSEUDOS.iter().find(|pseudo| pseudo.name == name)
}

impl Pseudo {
    /// The pseudo-instruction as it is written, such as `li d, i`.
    pub fn usage(&self) -> String {
        let letters: Vec<String> = self.operands.iter().map(|(letter, _)| letter.to_string()).collect();
        format!("{} {}", self.name, letters.join(", ")).trim_end().to_string()
    }
}

fn describe_part(part: PseudoPart) -> &'static str {
    match part {
        PseudoPart::Kind(kind) => describe(kind),
        PseudoPart::Number => "a number of 32 bits",
    }
}

impl Assembler<'_> {
    /// Assembles a pseudo-instruction.
    pub(crate) fn pseudo_instruction(&mut self, pseudo: &Pseudo, operands: &[ParsedOperand], at: At, cursor: &Cursor) {
        if !self.fits(pseudo, operands, at) {
            self.emit(0, cursor.line);
            return;
        }
        let place = |letter: char| pseudo.operands.iter().position(|&(other, _)| other == letter);
        // Numbers that are known where the line stands choose the form; later passes keep it, so that addresses stay.
        let known = |letter: char| match &operands[place(letter)?].written {
            Written::Number(expression) => self.evaluate(expression).ok(),
            _ => None,
        };
        let holds = |form: &&Expansion| match form.when {
            When::Otherwise => true,
            When::IsShort(letter) => match (known(letter), &operands[place(letter).unwrap_or(0)].written) {
                (Some(value), _) => i16::try_from(value).is_ok(),
                (None, Written::Number(expression)) => self.is_short_immediate(expression),
                (None, _) => false,
            },
            When::AreZero => ['x', 'y', 'z'].into_iter().all(|letter| known(letter) == Some(0)),
            When::AreEqual => known('x').is_some() && known('x') == known('y') && known('y') == known('z'),
        };
        // The first form whose condition holds; the last has none.
        let form = pseudo.forms.iter().find(holds).expect("the last form is always right");
        // Assemble its instructions with the operands put in.
        for line in form.lines {
            let (name, rest) = line.split_once(' ').unwrap_or((line, ""));
            let parts = rest.split(", ").filter(|part| !part.is_empty());
            let filled: Vec<ParsedOperand> = parts.map(|part| fill(part, pseudo, operands, at)).collect();
            match (self.operations.get(name).copied(), find(name)) {
                (Some(op), _) => self.row_instruction(op, &filled, at, cursor),
                (None, Some(inner)) => self.pseudo_instruction(inner, &filled, at, cursor),
                (None, None) => unreachable!("a test expands every form"),
            }
        }
    }

    fn fits(&mut self, pseudo: &Pseudo, operands: &[ParsedOperand], at: At) -> bool {
        if operands.len() != pseudo.operands.len() {
            let place = operands.last().map_or(at, |last| at.to(last.at));
            let count = pseudo.operands.len();
            let message = format!(
                "`{}` takes {} operand{}, not {}",
                pseudo.name,
                if count == 0 { "no".into() } else { count.to_string() },
                if count == 1 { "" } else { "s" },
                operands.len()
            );
            let parts = pseudo.operands.iter().map(|&(letter, part)| format!("{letter} is {}", describe_part(part)));
            let problem =
                Problem::new(explain::OPERAND_COUNT, message, place, format!("it is written `{}`", pseudo.usage()));
            let legend = parts.collect::<Vec<_>>().join(", ");
            self.messages.add(problem.hint(if legend.is_empty() { "it takes no operands".into() } else { legend }));
            return false;
        }
        // Report each operand of a wrong kind, not the first one alone.
        let mut is_right = true;
        for (operand, &(letter, part)) in operands.iter().zip(pseudo.operands) {
            let file = match part {
                PseudoPart::Kind(kind) => kind.register_file(),
                PseudoPart::Number => None,
            };
            let fits = match &operand.written {
                Written::Register((written, _)) => file == Some(*written),
                Written::Memory(..) => false,
                Written::Number(_) => file.is_none(),
            };
            if !fits {
                let what = describe_part(part);
                let message = format!("operand `{letter}` of `{}` is {what}, not {}", pseudo.name, operand.describe());
                let problem = Problem::new(explain::OPERAND_KIND, message, operand.at, format!("expected {what}"));
                self.messages.add(match &operand.written {
                    Written::Number(expression) if let Some(name) = expression.symbol() => {
                        problem.suggest(&self.names.text(name).clone(), crate::message::Among::Registers)
                    }
                    _ => problem,
                });
                is_right = false;
            }
        }
        is_right
    }
}

fn fill(part: &str, pseudo: &Pseudo, operands: &[ParsedOperand], at: At) -> ParsedOperand {
    let operand = |letter: &str| {
        pseudo
            .operands
            .iter()
            .position(|(other, _)| letter.len() == 1 && letter.starts_with(*other))
            .map(|place| &operands[place])
    };
    if let Some(operand) = operand(part) {
        return operand.clone();
    }
    // Halves of a number of 32 bits, for `movi` and `movhi`.
    for (prefix, function) in [("low(", ExpressionFunction::Low), ("high(", ExpressionFunction::High)] {
        if let Some(letter) = part.strip_prefix(prefix)
            && let Some(ParsedOperand { written: Written::Number(expression), at, .. }) =
                operand(letter.trim_end_matches(')'))
        {
            let half: Expression = expression.under(function);
            return ParsedOperand::made(Written::Number(half), *at);
        }
    }
    if let Some(register) = isa::parse_register(part) {
        return ParsedOperand::made(Written::Register(register), at);
    }
    ParsedOperand::number(part.parse().expect("a test expands every form"), at)
}
