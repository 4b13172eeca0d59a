//! Conditional assembly: which lines of a frame are read at all.

use crate::assembler::Assembler;
use crate::cursor::Cursor;
use crate::explain;
use crate::macros::arguments;
use crate::message::{At, Parsed, Problem};

/// State of an open `.if`: what happens to the lines that follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ConditionalState {
    /// Reads them.
    Taking,
    /// Skips them until a branch is true.
    Seeking,
    /// Skips them to the end.
    Done,
}

/// An open `.if`.
#[derive(Clone, Debug)]
pub(crate) struct Condition {
    state: ConditionalState,
    has_else: bool,
    at: At,
}

impl Condition {
    /// The message when the text ends before `.endif`.
    pub fn unclosed(&self) -> Box<Problem> {
        Problem::new(explain::UNCLOSED, "`.endif` is missing", self.at, "opened here")
    }
}

/// The form of a condition.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Test {
    /// `.if expression`.
    Expression,
    /// `.ifdef name`.
    Defined,
    /// `.ifndef name`.
    Undefined,
    /// `.ifb text`.
    Blank,
    /// `.ifnb text`.
    NotBlank,
    /// `.ifeq expression` and its like: how the number compares with 0.
    Compared(fn(&i64, &i64) -> bool),
    /// `.ifc text, text`.
    Same,
    /// `.ifnc text, text`.
    Different,
}

/// The texts around the only comma of a line, without their quotation marks.
fn two_texts(cursor: &mut Cursor) -> Parsed<[String; 2]> {
    match arguments(cursor)[..] {
        [ref first, ref second] => Ok([first.to_string(), second.to_string()]),
        _ => Err(cursor.expected("two texts with a comma between them")),
    }
}

impl Assembler<'_> {
    /// The lines here are skipped.
    pub(crate) fn is_skipping(&self) -> bool {
        let conditions = self.frames.last().map(|frame| &frame.conditions);
        conditions.and_then(|open| open.last()).is_some_and(|condition| condition.state != ConditionalState::Taking)
    }

    fn push_condition(&mut self, state: ConditionalState, at: At) {
        if let Some(frame) = self.frames.last_mut() {
            frame.conditions.push(Condition { state, has_else: false, at });
        }
    }

    /// An `.if` of some kind. A condition without a value counts as true, so that what it guards is defined.
    pub(crate) fn open_condition(&mut self, test: Test, at: At, cursor: &mut Cursor) -> Parsed<()> {
        if self.is_skipping() {
            self.push_condition(ConditionalState::Done, at);
            return Ok(());
        }
        let result = self.test(test, cursor);
        let is_true = *result.as_ref().unwrap_or(&true);
        self.push_condition(if is_true { ConditionalState::Taking } else { ConditionalState::Seeking }, at);
        result.map(|_| ())
    }

    /// An unknown directive that begins like a condition: its `.endif` belongs to it. Whether it
    /// stands where nothing is read.
    pub(crate) fn open_unknown_condition(&mut self, at: At) -> bool {
        let is_skipping = self.is_skipping();
        self.push_condition(if is_skipping { ConditionalState::Done } else { ConditionalState::Taking }, at);
        is_skipping
    }

    fn test(&mut self, test: Test, cursor: &mut Cursor) -> Parsed<bool> {
        match test {
            Test::Blank => return Ok(cursor.is_at_end()),
            Test::NotBlank => return Ok(!cursor.is_at_end()),
            Test::Expression => {
                let expression = self.expression(cursor)?;
                cursor.end()?;
                return Ok(self.value_now(&expression)?.is_none_or(|value| value != 0));
            }
            Test::Compared(holds) => {
                let expression = self.expression(cursor)?;
                cursor.end()?;
                return Ok(self.value_now(&expression)?.is_none_or(|value| holds(&value, &0)));
            }
            Test::Same | Test::Different => {
                let [first, second] = two_texts(cursor)?;
                return Ok((first == second) == matches!(test, Test::Same));
            }
            Test::Defined | Test::Undefined => {}
        }
        let (text, _) = cursor.name("a name")?;
        cursor.end()?;
        Ok(self.is_defined(text) == matches!(test, Test::Defined))
    }

    /// `.elseif`, or `.else` without an expression.
    pub(crate) fn next_branch(&mut self, is_last: bool, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let name = if is_last { ".else" } else { ".elseif" };
        let open = self.frames.last_mut().and_then(|frame| frame.conditions.last_mut());
        let Some(condition) = open else {
            let message = format!("`{name}` without `.if`");
            return Err(Problem::new(explain::UNOPENED, message, at, "nothing is open"));
        };
        if condition.has_else {
            let other = condition.at;
            condition.state = ConditionalState::Done;
            let message = format!("`{name}` after `.else`");
            return Err(Problem::new(explain::UNOPENED, message, at, "too late").also(Some(other), "opened here"));
        }
        condition.has_else = is_last;
        if condition.state != ConditionalState::Seeking {
            condition.state = ConditionalState::Done;
            return Ok(());
        }
        let is_true = if is_last { cursor.end().map(|_| true) } else { self.test(Test::Expression, cursor) };
        if *is_true.as_ref().unwrap_or(&true)
            && let Some(condition) = self.frames.last_mut().and_then(|frame| frame.conditions.last_mut())
        {
            condition.state = ConditionalState::Taking;
        }
        is_true.map(|_| ())
    }

    /// `.endif`
    pub(crate) fn close_condition(&mut self, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let popped = self.frames.last_mut().and_then(|frame| frame.conditions.pop());
        if popped.is_none() {
            return Err(Problem::new(explain::UNOPENED, "`.endif` without `.if`", at, "nothing is open"));
        }
        cursor.end()
    }
}
