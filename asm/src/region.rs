//! Functions and regions: which stretch of code a word is counted for.

use isa::program::Region;

use crate::assembler::{Assembler, Section};
use crate::cursor::Cursor;
use crate::explain;
use crate::limits::{REGION_DEPTH, REGIONS};
use crate::message::{At, Parsed, Problem};

/// A function or region that is not closed yet.
#[derive(Clone, Debug)]
pub(crate) struct OpenRegion {
    pub index: u16,
    pub is_function: bool,
    at: At,
}

impl OpenRegion {
    /// The message when it is not closed.
    pub fn unclosed(&self) -> Box<Problem> {
        let message = format!("`{}` is missing", closing(self.is_function));
        Problem::new(explain::UNCLOSED, message, self.at, "opened here")
    }
}

fn closing(is_function: bool) -> &'static str {
    if is_function { ".endfunc" } else { ".endregion" }
}

impl Assembler<'_> {
    /// `.func name` or `.region name`. The same name at the same place of the nesting is the same region.
    pub(crate) fn open_region(&mut self, is_function: bool, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let header = cursor.name("a name").and_then(|found| cursor.end().map(|_| found));
        let (name, name_at) = *header.as_ref().unwrap_or(&("?", at));
        if self.regions.len() >= REGION_DEPTH {
            let message = format!("more than {REGION_DEPTH} functions and regions inside each other");
            self.give_up(Problem::new(explain::DEPTH, message, at, "one too many"));
            return Ok(());
        }
        // The same name in the same surroundings goes on with the region that is there.
        let parent = self.regions.last().map(|open| open.index);
        let key = (String::from(name), is_function, parent);
        let index = match self.known_regions.get(&key) {
            Some(&index) => index,
            None if self.program.regions.len() >= REGIONS => {
                let message = format!("the program has more than {REGIONS} functions and regions");
                self.give_up(Problem::new(explain::SIZE, message, at, "one too many"));
                return Ok(());
            }
            None => {
                let index = self.program.regions.len() as u16;
                self.program.regions.push(Region { name: name.into(), is_function, parent });
                self.known_regions.insert(key, index);
                index
            }
        };
        self.regions.push(OpenRegion { index, is_function, at: name_at });
        // Register names of a function end with it.
        if is_function {
            self.open_scope();
        }
        header?;
        if self.section == Section::Buffer {
            let message = "functions and regions hold code";
            return Err(Problem::new(explain::SECTION, message, at, "the section is the buffer here")
                .hint("write `.text` before"));
        }
        if is_function {
            self.define_label(name, name_at);
        }
        Ok(())
    }

    /// `.endfunc` or `.endregion`
    pub(crate) fn close_region(&mut self, is_function: bool, at: At, cursor: &mut Cursor) -> Parsed<()> {
        match self.regions.last() {
            Some(open) if open.is_function == is_function => {
                self.close_innermost();
                // A name behind it is for readers, and is not compared.
                if !cursor.is_at_end() {
                    cursor.name("the end of the line")?;
                }
                cursor.end()
            }
            Some(open) => {
                let problem = Problem::new(
                    explain::UNOPENED,
                    format!("`{}` comes before `{}`", closing(is_function), closing(open.is_function)),
                    at,
                    "closes what is not innermost",
                )
                .also(Some(open.at), "the innermost is this");
                // Close everything up to the one that is meant, so that one forgotten end makes one message.
                if let Some(place) = self.regions.iter().rposition(|open| open.is_function == is_function) {
                    while self.regions.len() > place {
                        self.close_innermost();
                    }
                }
                Err(problem)
            }
            None => {
                let opening = if is_function { ".func" } else { ".region" };
                let message = format!("`{}` without `{opening}`", closing(is_function));
                Err(Problem::new(explain::UNOPENED, message, at, "nothing is open"))
            }
        }
    }

    fn close_innermost(&mut self) {
        if let Some(closed) = self.regions.pop()
            && closed.is_function
        {
            self.close_scope();
        }
    }
}
