//! Windows of a trace of instructions: only those whose step, function or program counter lies inside are recorded.

use std::ops::Range;
use std::str::FromStr;

use emu::stepper::Stepper;
use isa::Program;
use messages::did_you_mean;

use crate::arguments::numbered;

/// One condition on an instruction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TraceWindow {
    /// Steps from the first on, the last one no longer.
    Steps(Range<u64>),
    /// Words from the first on, the last one no longer.
    Words(Range<u64>),
    /// The innermost function around it has that name.
    Function(String),
}

impl FromStr for TraceWindow {
    type Err = String;

    fn from_str(text: &str) -> Result<TraceWindow, String> {
        let refusal = || "`steps=A..B`, `pc=A..B` or `function=NAME` is expected".to_owned();
        let (key, value) = text.split_once('=').ok_or_else(refusal)?;
        let range = || -> Result<Range<u64>, String> {
            let number =
                |text: &str| u64::try_from(numbered(text)?).map_err(|_| format!("`{}` is below 0", text.trim()));
            let (start, end) = match value.split_once("..") {
                Some((start, end)) => (number(start)?, if end.trim().is_empty() { u64::MAX } else { number(end)? }),
                None => (number(value)?, number(value)?.saturating_add(1)),
            };
            if start < end { Ok(start..end) } else { Err(format!("there is nothing in {value}")) }
        };
        match key.trim() {
            "steps" | "step" => range().map(TraceWindow::Steps),
            "pc" => range().map(TraceWindow::Words),
            "function" => Ok(TraceWindow::Function(value.trim().to_owned())),
            _ => Err(refusal()),
        }
    }
}

/// Answer of a window to whether an instruction lies in it; `None` of a window of another kind.
type WindowAnswer<'a> = &'a dyn Fn(&TraceWindow) -> Option<bool>;

/// Windows that an instruction must lie in, all of them at once, but in one of those of each kind.
#[derive(Clone, Debug, Default)]
pub struct TraceWindows(pub Vec<TraceWindow>);

impl TraceWindows {
    /// Checks that the functions are the program's.
    ///
    /// # Errors
    /// One that is not, with one that is near.
    pub fn check(&self, program: &Program) -> Result<(), String> {
        let known = || program.regions.iter().filter(|region| region.is_function).map(|region| region.name.as_str());
        for window in &self.0 {
            if let TraceWindow::Function(name) = window
                && !known().any(|other| other == name)
            {
                let hint =
                    did_you_mean(name, known()).unwrap_or_else(|| "the listing and the map have its functions".into());
                return Err(format!("the program has no function `{name}`: {hint}"));
            }
        }
        Ok(())
    }

    /// The instruction that comes next lies in the windows.
    pub fn has(&self, stepper: &Stepper) -> bool {
        let pc = stepper.code.word(stepper.state().pc);
        // Windows of one kind are alternatives, those of different kinds hold together.
        let kinds: [WindowAnswer; 3] = [
            &|window| match window {
                TraceWindow::Steps(range) => Some(range.contains(&stepper.steps())),
                _ => None,
            },
            &|window| match window {
                TraceWindow::Words(range) => Some(range.contains(&u64::from(pc))),
                _ => None,
            },
            &|window| match window {
                TraceWindow::Function(name) => Some(stepper.code.program.function(pc) == Some(name)),
                _ => None,
            },
        ];
        kinds.iter().all(|kind| {
            let mut answers = self.0.iter().filter_map(kind).peekable();
            answers.peek().is_none() || answers.any(|answer| answer)
        })
    }

    /// First step that may lie in the windows, and the step behind the last one.
    pub fn steps(&self) -> Range<u64> {
        let ranges = || {
            self.0.iter().filter_map(|window| match window {
                TraceWindow::Steps(range) => Some(range),
                _ => None,
            })
        };
        let (start, end) = (ranges().map(|range| range.start).min(), ranges().map(|range| range.end).max());
        start.unwrap_or(0)..end.unwrap_or(u64::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_have_steps_words_or_functions() {
        assert_eq!("steps=10..1,000".parse(), Ok(TraceWindow::Steps(10..1000)));
        assert_eq!("pc=0x10..".parse(), Ok(TraceWindow::Words(16..u64::MAX)));
        assert_eq!("pc=7".parse(), Ok(TraceWindow::Words(7..8)));
        assert_eq!("function=triangle".parse(), Ok(TraceWindow::Function("triangle".into())));
        for text in ["", "steps", "steps=2..2", "steps=x", "line=3", "steps=-1..2"] {
            assert!(text.parse::<TraceWindow>().is_err(), "{text}");
        }
    }
}
