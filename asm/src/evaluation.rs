//! Values of expressions. All arithmetic is on 64 bits with the sign; what does not fit is an error.

use std::collections::HashSet;
use std::rc::Rc;

use crate::assembler::Assembler;
use crate::explain;
use crate::expression::{EvaluationStep, Expression, has_fixed};
use crate::function::ExpressionFunction;
use crate::message::{Among, At, Parsed, Problem};
use crate::operator::{Checked, OVERFLOW};
use crate::symbol::{Name, SymbolValue};

/// The reason for which an expression has no value.
#[derive(Debug)]
pub(crate) enum EvaluationFailure {
    /// A name that may be defined further on.
    Later(EvaluationStep, At),
    /// The reason has been reported already.
    Reported,
    /// The arithmetic fails whatever follows.
    Wrong(Box<Problem>),
}

impl Assembler<'_> {
    /// The value of an expression as far as it is known.
    pub(crate) fn evaluate(&self, expression: &Expression) -> Result<i64, EvaluationFailure> {
        if let [(EvaluationStep::Number(value), _)] = expression.steps[..] {
            return Ok(value);
        }
        let stack = self.run(&expression.steps)?;
        Ok(*stack.last().expect("an expression has a value"))
    }

    /// The numbers on both sides of the comparison that is the whole expression, for messages.
    pub(crate) fn sides(&self, expression: &Expression) -> Option<(&'static str, i64, i64)> {
        let (last, before) = expression.steps.split_last()?;
        let EvaluationStep::Binary(operator) = last.0 else { return None };
        match self.run(before).ok()?[..] {
            [a, b] => Some((operator.mark(), a, b)),
            _ => None,
        }
    }

    /// The stack after these steps.
    fn run(&self, steps: &[(EvaluationStep, At)]) -> Result<Vec<i64>, EvaluationFailure> {
        // Reverse Polish: `2 + 3 * x` is 2, 3, x, *, +.
        let mut stack: Vec<i64> = Vec::with_capacity(8);
        let mut next = 0;
        while let Some((step, at)) = steps.get(next) {
            next += 1;
            let checked = |result: Checked, what: &dyn Fn() -> String| {
                result.map_err(|(code, message)| EvaluationFailure::Wrong(Problem::new(code, message, *at, what())))
            };
            let mut pop = || stack.pop().expect("the parser pushes operands before operators");
            let value = match step {
                EvaluationStep::Number(value) => *value,
                EvaluationStep::Symbol(name) => self.symbol_value(*name, step, *at)?,
                EvaluationStep::Size(name) => {
                    self.names.size(*name).ok_or_else(|| EvaluationFailure::Later(step.clone(), *at))?
                }
                EvaluationStep::Fixed(decimal, format) => {
                    let bits = self.names.format(*format).ok_or_else(|| EvaluationFailure::Later(step.clone(), *at))?;
                    checked(decimal.to_fixed(bits).ok_or(OVERFLOW), &|| format!("with {bits} fraction bits"))?
                }
                EvaluationStep::Negate => {
                    let a = pop();
                    checked(a.checked_neg().ok_or(OVERFLOW), &|| format!("-({a})"))?
                }
                EvaluationStep::Complement => !pop(),
                EvaluationStep::Not => i64::from(pop() == 0),
                EvaluationStep::Truth => i64::from(pop() != 0),
                // `a && b` skips b when a is 0, `a || b` when it is not; what is skipped may even be without a value.
                EvaluationStep::UnlessZero(end) => {
                    if pop() != 0 {
                        continue;
                    }
                    next = *end;
                    0
                }
                EvaluationStep::IfZero(end) => {
                    if pop() == 0 {
                        continue;
                    }
                    next = *end;
                    1
                }
                EvaluationStep::Binary(operator) => {
                    let (b, a) = (pop(), pop());
                    checked(operator.apply(a, b), &|| format!("{a} {} {b}", operator.mark()))?
                }
                EvaluationStep::Function(name) => {
                    let b = if matches!(name, ExpressionFunction::Min | ExpressionFunction::Max) { pop() } else { 0 };
                    let a = pop();
                    let is_half = matches!(name, ExpressionFunction::Low | ExpressionFunction::High);
                    // A literal in a format is meant with its sign, so 0.9 in 32 fraction bits is no number of 32 bits.
                    if is_half && a > i64::from(i32::MAX) && has_fixed(steps) {
                        let fits = Err((explain::RANGE, "the number does not fit 32 bits with its sign"));
                        checked(fits, &|| format!("of {a}"))?;
                    }
                    checked(name.apply(a, b), &|| format!("of {a}"))?
                }
            };
            stack.push(value);
        }
        Ok(stack)
    }

    fn symbol_value(&self, name: Name, step: &EvaluationStep, at: At) -> Result<i64, EvaluationFailure> {
        let later = || EvaluationFailure::Later(step.clone(), at);
        match self.names.get(name).map(|symbol| &symbol.value) {
            None => self.names.format(name).map(i64::from).ok_or_else(later),
            Some(SymbolValue::Code(value) | SymbolValue::Buffer(value) | SymbolValue::Constant(value)) => Ok(*value),
            Some(SymbolValue::Pending(_)) => Err(later()),
            Some(SymbolValue::Broken) => Err(EvaluationFailure::Reported),
            Some(SymbolValue::Variable(value, times)) => {
                if self.is_last_pass && *times > 1 {
                    let text = self.names.text(name);
                    return Err(EvaluationFailure::Wrong(
                        Problem::new(explain::UNSET, format!("`{text}` is used before it is set"), at, "not set yet")
                            .hint("it is set more than once, so that its value depends on the place"),
                    ));
                }
                Ok(*value)
            }
        }
    }

    /// Puts the numbers of names that may change into an expression that is evaluated later.
    pub(crate) fn settle(&self, expression: &mut Expression) {
        for (step, _) in &mut expression.steps {
            if let EvaluationStep::Symbol(name) = step
                && let Some(SymbolValue::Variable(value, _)) = self.names.get(*name).map(|symbol| &symbol.value)
            {
                *step = EvaluationStep::Number(*value);
            }
        }
    }

    /// The value of an expression that decides the layout; `None` when that is or will be reported.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(crate) fn value_now(&mut self, expression: &Expression) -> Parsed<Option<i64>> {
        match self.evaluate(expression) {
            Ok(value) => Ok(Some(value)),
            Err(EvaluationFailure::Reported) => Ok(None),
            Err(EvaluationFailure::Wrong(problem)) => Err(problem),
            Err(EvaluationFailure::Later(step, at)) => {
                self.early.push((step, at));
                Ok(None)
            }
        }
    }

    /// Reports the names that were needed before they were known, now that it is clear which exist at all.
    pub(crate) fn report_early(&mut self) {
        for (step, at) in std::mem::take(&mut self.early) {
            let known = match &step {
                EvaluationStep::Symbol(name) => self.names.get(*name).map(|symbol| symbol.at),
                EvaluationStep::Size(name) => self.names.size(*name).map(|_| None),
                EvaluationStep::Fixed(_, name) => self.names.format(*name).map(|_| None),
                _ => None,
            };
            let Some(place) = known else {
                self.report_failure(EvaluationFailure::Later(step, at));
                continue;
            };
            let problem = Problem::new(explain::LAYOUT, "the value must be known at this line", at, "known only later");
            self.messages.add(
                problem
                    .also(place, "defined here")
                    .hint("the layout of the program depends on it: define the names that it uses before this line"),
            );
        }
    }

    /// A name without a definition.
    pub(crate) fn undefined(&self, step: &EvaluationStep, at: At) -> Box<Problem> {
        let (text, what, code, among) = match step {
            EvaluationStep::Fixed(_, name) => (self.names.text(*name), "format", explain::FORMAT, Among::Formats),
            EvaluationStep::Size(name) => (self.names.text(*name), "structure", explain::UNDEFINED, Among::Sizes),
            EvaluationStep::Symbol(name) => (self.names.text(*name), "symbol", explain::UNDEFINED, Among::Symbols),
            _ => unreachable!("only names are defined later"),
        };
        if let Some((number, _)) = text.split_once('#') {
            let message = format!("there is no label `{number}:` after this line");
            return Problem::new(explain::NUMERIC_LABEL, message, at, "looks forward");
        }
        let label = if what == "symbol" { "not defined".into() } else { format!("no such {what}") };
        Problem::new(code, format!("`{text}` is not defined"), at, label).suggest(text, among)
    }

    /// Gives all constants that wait for later definitions their values, without recursion.
    pub(crate) fn resolve_pending(&mut self) {
        // Take the names first: evaluating changes the table
        let waiting: Vec<Name> = self
            .names
            .symbols()
            .filter(|(_, _, symbol)| matches!(symbol.value, SymbolValue::Pending(_)))
            .map(|(name, ..)| name)
            .collect();
        let mut visited = HashSet::new();
        for name in waiting {
            // Go into depth on a stack: of `a = b + 1` and `b = end` it holds a, then a b; what comes to the top again gets its value.
            let mut open = vec![(name, false)];
            while let Some(&(name, is_visited)) = open.last() {
                let Some((expression, at)) = self.pending(name) else {
                    open.pop();
                    continue;
                };
                if is_visited {
                    open.pop();
                    let value = match self.evaluate(&expression) {
                        Ok(value) => SymbolValue::Constant(value),
                        Err(failure) => {
                            self.report_failure(failure);
                            SymbolValue::Broken
                        }
                    };
                    self.names.set(name, value, at);
                    continue;
                }
                open.last_mut().expect("not empty").1 = true;
                visited.insert(name);
                for (step, step_at) in &expression.steps {
                    let EvaluationStep::Symbol(used) = step else { continue };
                    if self.pending(*used).is_none() {
                        continue;
                    }
                    // What was opened and still waits lies further down in the stack: its own definition has led back to it.
                    if visited.contains(used) {
                        let text = self.names.text(*used).clone();
                        let message = format!("`{text}` is defined by itself");
                        let other = self.names.get(*used).and_then(|symbol| symbol.at);
                        self.messages.add(
                            Problem::new(explain::CYCLE, message, *step_at, "needs its own value")
                                .also(other, "defined here"),
                        );
                        self.names.set(*used, SymbolValue::Broken, other);
                    } else {
                        open.push((*used, false));
                    }
                }
            }
        }
    }

    fn pending(&self, name: Name) -> Option<(Rc<Expression>, Option<At>)> {
        match self.names.get(name) {
            Some(symbol) => match &symbol.value {
                SymbolValue::Pending(expression) => Some((expression.clone(), symbol.at)),
                _ => None,
            },
            None => None,
        }
    }

    /// Reports why an expression has no value, now that everything is defined that ever will be.
    pub(crate) fn report_failure(&mut self, failure: EvaluationFailure) {
        match failure {
            EvaluationFailure::Reported => {}
            EvaluationFailure::Wrong(problem) => self.messages.add(problem),
            EvaluationFailure::Later(..) if self.is_incomplete => {}
            EvaluationFailure::Later(step, at) => {
                let problem = self.undefined(&step, at);
                self.messages.add(problem);
            }
        }
    }
}
