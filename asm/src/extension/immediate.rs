//! Immediates of a row inside its body: numbers that grow evenly with them.

use isa::definition::{InstructionDef, Kind};
use isa::extension::Immediate;

use crate::assembler::Assembler;
use crate::evaluation::EvaluationFailure;
use crate::explain;
use crate::expression::{EvaluationStep as Calculation, Expression};
use crate::instruction::out_of_range;
use crate::message::Problem;
use crate::symbol::Name;

impl Assembler<'_> {
    /// The letters of the row's immediates that an expression mentions.
    fn letters(&self, expression: &Expression) -> Vec<(Name, u8)> {
        let Some(template) = &self.body else { return Vec::new() };
        let mut found: Vec<(Name, u8)> = Vec::new();
        for (calculation, _) in &expression.steps {
            if let Calculation::Symbol(name) = calculation
                && let &[letter @ (b'i' | b'j')] = self.names.text(*name).as_bytes()
                && template.operand(letter).is_some()
                && !found.iter().any(|(_, other)| *other == letter)
            {
                found.push((*name, letter));
            }
        }
        found
    }

    /// Least and largest value of an immediate of the row.
    fn letter_range(&self, letter: u8) -> (i64, i64) {
        let definition = self.body.as_ref().map(|template| &template.definition);
        let operand =
            definition.and_then(|definition| Some((definition.operand(letter)?, definition.pattern.field(letter)?)));
        operand.map_or((0, 0), |(operand, field)| operand.kind.range(field.width))
    }

    /// An expression is an immediate of the row that fits 16 bits with its sign.
    pub(crate) fn is_short_immediate(&self, expression: &Expression) -> bool {
        let [(_, letter)] = self.letters(expression)[..] else { return false };
        let (least, most) = self.letter_range(letter);
        expression.symbol().is_some() && least >= i64::from(i16::MIN) && most <= i64::from(i16::MAX)
    }

    /// A number that may depend on one immediate of the row, by addition of and multiplication with constants.
    pub(crate) fn immediate(
        &self,
        expression: &Expression,
        definition: &InstructionDef,
        operand: isa::definition::Operand,
        range: (i64, i64),
    ) -> Result<Immediate, EvaluationFailure> {
        // A number without letters is known now.
        let letters = self.letters(expression);
        let wrong = |message: String, label: &str| {
            EvaluationFailure::Wrong(Problem::new(explain::BODY, message, expression.at, label))
        };
        let [(name, letter)] = letters[..] else {
            if letters.len() > 1 {
                return Err(wrong("a number of a body depends on one immediate at most".into(), "`i` and `j`"));
            }
            let value = self.evaluate(expression)?;
            return match i32::try_from(value) {
                Ok(value) => Ok(Immediate::Number(value)),
                Err(_) => Err(EvaluationFailure::Wrong(out_of_range(definition, operand, expression.at, value, range))),
            };
        };
        let kind = self.body.as_ref().and_then(|template| template.operand(letter)).map(|operand| operand.kind);
        if kind == Some(Kind::Rel) {
            let message = format!("`{}` is a distance in the program", letter as char);
            return Err(wrong(message, "only `exit NAME, i` may use it"));
        }
        // Put the least two values in: they give the line `first + factor (i - least)`. `2 * i + 3` with i from 0 to 31 has first 3 and factor 2.
        let (least, most) = self.letter_range(letter);
        let value_at = |value: i64| -> Result<i64, EvaluationFailure> {
            let put = |calculation: &Calculation| match calculation {
                Calculation::Symbol(other) if *other == name => Calculation::Number(value),
                other => other.clone(),
            };
            let steps: Vec<_> = expression.steps.iter().map(|(calculation, at)| (put(calculation), *at)).collect();
            self.evaluate(&Expression { steps, at: expression.at })
        };
        let (first, second) = (value_at(least)?, value_at((least + 1).min(most))?);
        let factor = second.wrapping_sub(first);
        let line = |value: i64| i128::from(first) + i128::from(value - least) * i128::from(factor);
        // Hold all values of the field to that line; a letter alone is one, however many values it has.
        let is_plain = expression.symbol().is_some();
        let is_known = is_plain || most - least <= 1 << 16;
        if !is_known {
            return Err(wrong("the immediate has too many values to compute with".into(), "write it alone"));
        }
        for value in (least..=most).take_while(|_| !is_plain) {
            if i128::from(value_at(value)?) != line(value) {
                let message = format!("the number does not grow evenly with `{}`", letter as char);
                return Err(wrong(message, "only constants may be added and multiplied"));
            }
        }
        // A line has its extremes at the ends.
        for value in [least, most] {
            let result = line(value);
            if result < i128::from(range.0) || result > i128::from(range.1) {
                let message = format!(
                    "with {} = {value} this is {result}, beyond operand `{}` of `{}`",
                    letter as char, operand.letter as char, definition.name
                );
                return Err(wrong(message, &format!("{} to {} here", range.0, range.1)));
            }
        }
        let offset = line(0);
        match (i32::try_from(factor), i32::try_from(offset)) {
            (Ok(factor), Ok(offset)) => Ok(Immediate::Letter { letter, factor, offset }),
            _ => Err(wrong("the number does not fit 32 bits".into(), "too large")),
        }
    }
}
