//! `.computes`: the instruction that a function computes in steps of its own, such as a square root bit by bit. It makes no word; whoever
//! compares the function with exact arithmetic reads it.

use isa::Kind;
use isa::definition::InstructionDef;
use isa::naming::ComputedInstruction;
use isa::program::Line;

use crate::assembler::{Assembler, Section};
use crate::cursor::Cursor;
use crate::explain;
use crate::holding::OPEN;
use crate::message::{At, Parsed, Problem};

/// The row takes registers and immediates alone, and writes a register: then it has an exact value that memory and place do not matter to.
fn is_formula(definition: &InstructionDef) -> bool {
    let is_written = definition.operands.iter().any(|operand| b"de".contains(&operand.letter));
    is_written && definition.operands.iter().all(|operand| !matches!(operand.kind, Kind::A | Kind::Rel | Kind::Off))
}

impl Assembler<'_> {
    /// `.computes instruction`
    pub(crate) fn computes(&mut self, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let (name, name_at) = cursor.name("an instruction")?;
        if self.section != Section::Code || !self.regions.iter().any(|open| open.is_function) {
            let message = "`.computes` stands outside of functions";
            return Err(
                Problem::new(explain::UNOPENED, message, at, "no function to speak of").hint("`.func name` begins one")
            );
        }
        let Some(op) = self.operations.get(name).copied() else {
            return Err(self.unknown_instruction(name, name_at, false));
        };
        let definition = self.isa.definition(op);
        if !is_formula(definition) {
            let message = format!("`{name}` does not compute registers from registers alone");
            return Err(Problem::new(explain::INSTRUCTION, message, name_at, "no formula of numbers"));
        }
        // Names are read here, but no word of the program uses them.
        let first_use = self.name_uses.len();
        let operands = self.operands(cursor);
        self.name_uses.truncate(first_use);
        let Some(arguments) = self.arguments(definition, &operands?, name_at) else { return Ok(()) };
        let from = self.program.words.len() as u32;
        match self.encode(op, &arguments, from as usize) {
            Ok(word) => {
                let line = Line { source: cursor.line.source, line: cursor.line.number };
                self.program.computed.push(ComputedInstruction { word, words: from..OPEN, line });
            }
            Err(failures) => failures.into_iter().for_each(|failure| self.report_failure(failure)),
        }
        Ok(())
    }

    /// Ends what functions compute where the functions end.
    pub(crate) fn finish_computed(&mut self) {
        let mut computed = std::mem::take(&mut self.program.computed);
        let (program, behind) = (&self.program, self.program.words.len() as u32);
        for instruction in &mut computed {
            let first = instruction.words.start;
            let function = program.function(first);
            let end = (first..behind).find(|&word| function.is_none() || program.function(word) != function);
            instruction.words.end = end.unwrap_or(behind);
        }
        computed.retain(|instruction| !instruction.words.is_empty());
        self.program.computed = computed;
    }
}
