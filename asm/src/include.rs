//! Files that are read in the middle of others.

use crate::assembler::Assembler;
use crate::explain;
use crate::frame::Origin;
use crate::limits::{SOURCES, TEXT_OCTETS};
use crate::message::{At, Parsed, Problem};

/// Times that a file may be read within itself.
const GUARDED: usize = 1;

impl Assembler<'_> {
    /// Reads another file here.
    pub(crate) fn include_file(&mut self, name: &str, at: At) -> Parsed<()> {
        let refuse = |assembler: &mut Self, code, message: String, label: String| {
            assembler.is_incomplete = true;
            Err(Problem::new(code, message, at, label))
        };
        let from = at.source;
        // The same name in the same file is the same source, read once.
        let known = self.included.get(&(name.to_string(), from)).copied();
        let index = match known {
            Some(index) => index,
            None => {
                let source = match (self.options.include)(name, &self.program.sources[from as usize].name) {
                    Ok(source) => source,
                    Err(why) => return refuse(self, explain::INCLUDE, format!("cannot include `{name}`"), why),
                };
                // Two names may lead to one file.
                let same = self.program.sources.iter().position(|other| other.name == source.name);
                let index = same.unwrap_or(self.program.sources.len());
                if index > SOURCES {
                    let message = format!("the program has more than {SOURCES} files");
                    return refuse(self, explain::SIZE, message, "one too many".into());
                }
                if source.text.len() > TEXT_OCTETS {
                    let message = format!("`{name}` is longer than {TEXT_OCTETS} octets");
                    return refuse(self, explain::SIZE, message, "included here".into());
                }
                if same.is_none() {
                    self.program.sources.push(source);
                }
                self.included.insert((name.to_string(), from), index as u16);
                index as u16
            }
        };
        // A guard lets a file that is still being read come again once, with nothing in it; without one it comes without end.
        let reading = self.frames.iter().filter(|frame| frame.origin == Origin::File(index)).count();
        if reading > GUARDED {
            let message = format!("`{name}` includes itself");
            return refuse(self, explain::DEPTH, message, "it is being read already".into());
        }
        self.enter_file(index, at);
        Ok(())
    }
}
