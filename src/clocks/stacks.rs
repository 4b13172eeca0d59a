//! Stacks of functions and regions with their own clocks, a wait for a kind of data being a part of its own on top.

use emu::machine::RunOutcome;
use isa::Program;

use crate::result::OUTSIDE;

/// A stack, and the clocks that were spent while it was open and nothing stood on top of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClockStack {
    /// Functions and regions, the outermost first.
    pub frames: Vec<String>,
    /// Kind of data that was waited for; `None` for computing.
    pub waits_for: Option<String>,
    /// Clocks of all cores together.
    pub clocks: u64,
}

impl ClockStack {
    /// The names from the outermost function on, the wait on top of them.
    pub fn names(&self) -> Vec<String> {
        let wait = self.waits_for.as_ref().map(|kind| format!("(waits for {kind})"));
        self.frames.iter().cloned().chain(wait).collect()
    }
}

/// The stacks of the cores' program in the order of its functions; none where clocks were not measured.
pub fn stacks(program: &Program, frame: &RunOutcome) -> Vec<ClockStack> {
    let Some(clocks) = frame.profile.as_ref().and_then(|profile| profile.clocks.as_ref()) else { return Vec::new() };
    let name = |region: &u16| program.regions[usize::from(*region)].name.clone();
    let mut found = Vec::new();
    for (regions, place) in clocks.stacks() {
        let frames: Vec<String> = match regions.is_empty() {
            true => vec![OUTSIDE.to_owned()],
            false => regions.iter().map(name).collect(),
        };
        let busy = place.work.busy.0;
        let waits = place.waiting_kinds.iter().zip(&frame.kinds);
        let waits = waits.map(|(&waiting, kind)| (Some(kind.kind.clone()), waiting));
        let parts = std::iter::once((None, busy)).chain(waits).filter(|(_, clocks)| *clocks != 0);
        found.extend(parts.map(|(waits_for, clocks)| ClockStack { frames: frames.clone(), waits_for, clocks }));
    }
    found
}

/// Stacks as text: a line each, names between semicolons, a blank, clocks. Tools that draw flame graphs read it.
pub fn folded(stacks: &[ClockStack]) -> String {
    // A name with a semicolon or a line feed would be taken for several.
    let plain = |name: &String| name.replace([';', '\n', '\r'], "_");
    let line = |stack: &ClockStack| {
        let names: Vec<String> = stack.names().iter().map(plain).collect();
        format!("{} {}\n", names.join(";"), stack.clocks)
    };
    stacks.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wait_stands_on_top_of_its_stack() {
        let stack = |waits_for: Option<&str>, clocks| ClockStack {
            frames: vec!["pixel".into(), "a;b".into()],
            waits_for: waits_for.map(str::to_owned),
            clocks,
        };
        let text = folded(&[stack(None, 7), stack(Some("nodes"), 30)]);
        assert_eq!(text, "pixel;a_b 7\npixel;a_b;(waits for nodes) 30\n");
    }
}
