//! A function of an assembled program as assembly text again, from its blocks.

use std::fmt::Write;
use std::ops::Range;

use isa::{Isa, Program};

use super::block::Block;
use super::flow::ProgramFlow;
use super::pattern::line;

/// The words of a function, when they stand together and hold no other function.
pub fn range(program: &Program, name: &str) -> Option<(u16, Range<usize>)> {
    let function = program.regions.iter().position(|region| region.is_function && region.name == name)? as u16;
    let is_inside = |pc: usize| chain(program, pc).contains(&function);
    let start = (0..program.words.len()).find(|&pc| is_inside(pc))?;
    let end = (start..program.words.len()).find(|&pc| !is_inside(pc)).unwrap_or(program.words.len());
    let is_whole = !(end..program.words.len()).any(is_inside);
    let has_inner = (start..end).any(|pc| {
        let inner = chain(program, pc);
        inner.iter().any(|&region| region != function && program.regions[usize::from(region)].is_function)
    });
    (is_whole && !has_inner).then_some((function, start..end))
}

/// The regions around a word, the outermost first.
fn chain(program: &Program, pc: usize) -> Vec<u16> {
    let mut found = Vec::new();
    let mut next = program.region_of.get(pc).copied().flatten();
    while let Some(region) = next {
        found.push(region);
        next = program.regions[usize::from(region)].parent;
    }
    found.reverse();
    found
}

/// The text of a function from its blocks. `None` where the function and others lead into each other otherwise than by calls.
pub fn text(program: &Program, flow: &ProgramFlow, isa: &Isa, name: &str, blocks: &[Block]) -> Option<String> {
    // Refuse a function that others jump into: its words would no longer be where they lead.
    let (function, range) = range(program, name)?;
    let leads_in = |pc: usize| flow.targets[pc].is_some_and(|to| to != range.start && range.contains(&to));
    if (0..program.words.len()).any(|pc| !range.contains(&pc) && leads_in(pc)) {
        return None;
    }
    // Name the targets: the function itself, words inside it by their distance from its start, other functions by their names.
    let label = |to: usize| -> Option<String> {
        if range.contains(&to) {
            return Some(if to == range.start { name.to_owned() } else { format!("{name}_at_{}", to - range.start) });
        }
        let regions = program.regions.iter().filter(|region| region.is_function);
        regions
            .map(|region| region.name.as_str())
            .find(|name| self::range(program, name).is_some_and(|(_, range)| range.start == to))
            .map(str::to_owned)
    };
    let mut text = String::new();
    if program.entry as usize == range.start {
        let _ = writeln!(text, ".entry {name}");
    }
    let _ = writeln!(text, ".func {name}");
    let mut open: Vec<u16> = vec![function];
    for block in blocks {
        // Close the regions that the block before was in and this one is not, then open its own.
        let around = chain(program, block.range.start);
        let around = &around[around.iter().position(|&region| region == function)?..];
        let kept = open.iter().zip(around).take_while(|(a, b)| a == b).count();
        while open.len() > kept {
            open.pop();
            text.push_str(".endregion\n");
        }
        for &region in &around[kept..] {
            open.push(region);
            let _ = writeln!(text, ".region {}", program.regions[usize::from(region)].name);
        }
        let start = block.range.start;
        // A label stands only where something leads.
        if start != range.start && flow.targets[range.clone()].contains(&Some(start)) {
            let _ = writeln!(text, "{}:", label(start)?);
        }
        for item in &block.items {
            let made = match (&item.made, &item.words[..]) {
                (Some(made), _) => made.clone(),
                (None, &[pc]) => single(flow, isa, pc, &label)?,
                (None, _) => return None,
            };
            let _ = writeln!(text, "    {made}");
        }
    }
    for _ in 1..open.len() {
        text.push_str(".endregion\n");
    }
    text.push_str(".endfunc\n");
    Some(text)
}

/// The line of one word.
fn single(flow: &ProgramFlow, isa: &Isa, pc: usize, label: &dyn Fn(usize) -> Option<String>) -> Option<String> {
    let instruction = flow.instructions[pc].as_ref()?;
    Some(match flow.targets[pc] {
        Some(to) => {
            let to = label(to)?;
            instruction.text(isa, |_| to.clone())
        }
        None => line(instruction, isa, &|file, number| format!("{file}{number}")),
    })
}
