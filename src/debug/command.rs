//! The debugger's commands, as data for readers and help; what each does is in `door`.

use messages::did_you_mean;

/// Effect of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CommandAction {
    Break,
    Watch,
    Stops,
    Delete,
    Continue,
    Step,
    Next,
    Out,
    Instruction,
    Until,
    Back,
    BackStep,
    BackNext,
    BackOut,
    ContinueBack,
    GoTo,
    Where,
    List,
    Disassemble,
    Calls,
    Registers,
    Print,
    Shadow,
    Died,
    Set,
    Memory,
    Buffer,
    Counts,
    Try,
    Hash,
    Help,
    Quit,
}

/// A command of the debugger.
#[derive(Clone, Copy, Debug)]
pub struct DebugCommand {
    /// Name of the command.
    pub name: &'static str,
    /// Shorter names of the same.
    pub also: &'static [&'static str],
    /// The operands behind the name.
    pub operands: &'static str,
    /// Effect of the command, in a sentence.
    pub doc: &'static str,
    pub(super) action: CommandAction,
}

macro_rules! commands {
    ($($name:literal [$($also:literal),*] $operands:literal $action:ident $doc:literal;)*) => {
        /// Every command, in the order of the help.
        pub const COMMANDS: &[DebugCommand] = &[$(DebugCommand {
            name: $name, also: &[$($also),*], operands: $operands, doc: $doc, action: CommandAction::$action,
        }),*];
    };
}

commands! {
    "break" ["b"] "PLACE [if CONDITION] [count N]" Break "Stops before a function, file:line, line or *word; from the N-th time on.";
    "watch" [] "REGISTER | buffer ADDRESS [N] | memory ADDRESS [N]" Watch "Stops when a register or octets of the buffer change, or an address goes over the bus; takes if and count, too.";
    "stops" [] "" Stops "Lists breakpoints and watches.";
    "delete" ["del"] "NUMBER" Delete "Takes a breakpoint or a watch away.";
    "continue" ["c"] "" Continue "Goes on to the next stop.";
    "step" ["s"] "[N]" Step "Goes on to the next source line, into calls.";
    "next" ["n"] "[N]" Next "Goes on to the next source line, over calls.";
    "out" ["finish"] "" Out "Goes on until the function has returned.";
    "instruction" ["si"] "[N]" Instruction "Executes one instruction, or N.";
    "until" [] "saturated | quantized | lossy" Until "Goes on to the first result that did not fit, or lost bits, or either.";
    "back" ["sb"] "[N]" Back "Goes one instruction back, or N.";
    "back-step" ["bs"] "[N]" BackStep "Goes back to the beginning of a source line, into calls.";
    "back-next" ["bn"] "[N]" BackNext "Goes back to the beginning of a source line, over calls.";
    "back-out" ["bo"] "" BackOut "Goes back to the call of the function.";
    "continue-back" ["cb"] "" ContinueBack "Goes back to the stop before.";
    "goto" ["g"] "STEP" GoTo "Goes to where so many instructions have been executed.";
    "where" ["w"] "" Where "Shows step, clock, place and line.";
    "list" ["l"] "[PLACE]" List "Shows the source around here, or around a place.";
    "disassemble" ["d"] "[PLACE] [N]" Disassemble "Shows instructions with their costs.";
    "calls" ["bt"] "" Calls "Shows the open calls, the innermost first.";
    "registers" ["r"] "[all]" Registers "Shows the registers that are not zero, or all.";
    "print" ["p"] "REGISTER[:FORMAT],.." Print "Shows registers, by name, raw and as real numbers; components such as v1.y, pc and step as well.";
    "shadow" ["sh"] "[REGISTER,..]" Shadow "Shows beside each register the number that exact arithmetic would have given; with --shadow.";
    "died" [] "[REGISTER,..]" Died "Ranks the source lines of which the errors of registers consist; with --shadow.";
    "set" [] "REGISTER=VALUE,.." Set "Changes registers; the program then goes on from there, and comes through it again.";
    "memory" ["m"] "ADDRESS [N | STRUCTURE]" Memory "Shows octets of global memory, or a record field by field; (near) is the address that a register holds.";
    "buffer" ["u"] "ADDRESS [N | STRUCTURE]" Buffer "Shows octets of the local buffer in the same way.";
    "counts" [] "" Counts "Shows what was executed since the last stop, by class.";
    "x" [] "INSTRUCTION" Try "Tries an instruction here, shows what it does, and undoes it.";
    "hash" [] "" Hash "Shows a hash of program counter, registers, buffer and memory.";
    "help" ["h"] "[COMMAND]" Help "Shows all commands, or one.";
    "quit" ["q"] "" Quit "Ends.";
}

/// The command of a name.
///
/// # Errors
/// Another name, with one that is near.
pub fn find(name: &str) -> Result<&'static DebugCommand, String> {
    let known = || COMMANDS.iter().flat_map(|command| command.also.iter().copied().chain([command.name]));
    COMMANDS.iter().find(|command| command.name == name || command.also.contains(&name)).ok_or_else(|| {
        let hint = did_you_mean(name, known()).unwrap_or_else(|| "`help` lists all".into());
        format!("`{name}` is no command: {hint}")
    })
}

/// The help: of one command, or a line for each.
///
/// # Errors
/// See [`find`].
pub fn help(name: Option<&str>) -> Result<String, String> {
    let line = |command: &DebugCommand| {
        let also = if command.also.is_empty() { String::new() } else { format!(" ({})", command.also.join(", ")) };
        let head = format!("{}{also} {}", command.name, command.operands);
        format!("{}\n    {}\n", head.trim_end(), command.doc)
    };
    match name {
        Some(name) => find(name).map(line),
        None => Ok(COMMANDS.iter().map(line).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_told_apart_and_described() {
        let mut names: Vec<&str> =
            COMMANDS.iter().flat_map(|command| command.also.iter().copied().chain([command.name])).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
        assert!(COMMANDS.iter().all(|command| command.doc.ends_with('.')));
        assert!(find("contineu").unwrap_err().contains("did you mean `continue`?"));
        assert!(help(Some("x")).unwrap().contains("undoes"));
    }
}
