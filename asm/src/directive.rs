//! The directives, as data for readers and manuals, and what each one starts.

use messages::Severity;

use crate::assembler::{Assembler, Section};
use crate::conditional::Test;
use crate::cursor::Cursor;
use crate::explain;
use crate::foreign;
use crate::macros::REPETITIONS;
use crate::message::{Among, At, Parsed, Problem};
use crate::token::TokenKind;

#[derive(Clone, Copy, Debug)]
enum Action {
    Section(Section),
    Entry,
    Equ,
    Set,
    Format,
    Reg,
    Unreg,
    Holds,
    Computes,
    Include,
    Struct,
    Field,
    EndStruct,
    Numbers(usize),
    Fixed,
    Texts { ends_with_zero: bool },
    Space,
    Align { is_power: bool },
    Org,
    Open { is_function: bool },
    Close { is_function: bool },
    If(Test),
    ElseIf,
    Else,
    EndIf,
    Macro,
    ExitMacro,
    Local,
    Repeat,
    Each { by_character: bool },
    Purge,
    End,
    Ignored,
    Stray(&'static str),
    Say(Severity),
    Assert,
}

impl Action {
    /// A body of an extension instruction may have the directive: it places no data, words or functions.
    fn suits_body(self) -> bool {
        !matches!(
            self,
            Action::Section(_)
                | Action::Entry
                | Action::Numbers(_)
                | Action::Fixed
                | Action::Texts { .. }
                | Action::Space
                | Action::Align { .. }
                | Action::Org
                | Action::Open { .. }
                | Action::Close { .. }
                | Action::Holds
                | Action::Computes
                | Action::End
        )
    }
}

/// A directive.
#[derive(Clone, Copy, Debug)]
pub struct Directive {
    /// The directive's name, with the point.
    pub name: &'static str,
    /// Other names of the same.
    pub also: &'static [&'static str],
    /// The operands behind the name.
    pub operands: &'static str,
    /// The directive's effect, in a sentence.
    pub doc: &'static str,
    action: Action,
}

macro_rules! directives {
    ($($name:literal $([$($also:literal),*])? $operands:literal $action:expr, $doc:literal;)*) => {
        /// Every directive, in the order of the manual.
        pub const DIRECTIVES: &[Directive] = &[$(Directive {
            name: $name, also: &[$($($also),*)?], operands: $operands, doc: $doc, action: $action,
        }),*];
    };
}

directives! {
    ".text" [".code"] "" Action::Section(Section::Code), "What follows is code, placed after the code before it.";
    ".buffer" [".data"] "" Action::Section(Section::Buffer),
        "What follows is the initial contents of the local buffer, placed after the contents before it.";
    ".entry" "label" Action::Entry, "Execution starts there; without it at `start`, else at `main`, else at word 0.";
    ".equ" [".equiv"] "name, expression" Action::Equ, "Names a number once; it may use names that are defined further on.";
    ".set" "name, expression" Action::Set, "Names a number that may be set again; also written `name = expression`.";
    ".format" "name, bits" Action::Format,
        "Names a fixed-point format with that many fraction bits, for literals such as `0.5:name`.";
    ".reg" "name, register" Action::Reg, "Another name of a register, up to the end of the function around it.";
    ".unreg" "name" Action::Unreg, "Ends what `.reg` began.";
    ".holds" "register, format" Action::Holds,
        "Says what format the number in a register has from here on, up to the end of the function around it; without a format, that it has none. It makes no word: traces and debuggers show real values by it.";
    ".computes" "instruction" Action::Computes,
        "Says which instruction the function around it computes in many steps, such as `wsqrt s1, w0, 0`: of its operands as they are here, its results where the function returns. It makes no word: shadows go by it.";
    ".include" "\"file\"" Action::Include, "Reads another file here.";
    ".struct" "name" Action::Struct, "Begins a structure; its fields are constants `name.field`, its size is `sizeof(name)`.";
    ".field" "name, octets, count" Action::Field, "A field of that many octets, or of that many times `count`, at the next offset.";
    ".endstruct" "" Action::EndStruct, "Ends a structure.";
    ".byte" "number, ..." Action::Numbers(1), "Octets, -128 to 255.";
    ".half" [".short", ".hword"] "number, ..." Action::Numbers(2), "Numbers of 2 octets, -32768 to 65535, little-endian.";
    ".word" [".long", ".int"] "number, ..." Action::Numbers(4),
        "Numbers of 4 octets, -2^31 to 2^32-1, little-endian; in the code, words as they are.";
    ".wide" [".quad"] "number, ..." Action::Numbers(8), "Numbers of 8 octets, little-endian; `0x` with up to 16 digits is the pattern of one with its sign.";
    ".fixed" "format, number, ..." Action::Fixed,
        "Numbers of 4 octets, each rounded to the nearest of the format, ties up; a number that is no decimal literal is raw.";
    ".ascii" "\"text\", ..." Action::Texts { ends_with_zero: false },
        "The octets of texts, in UTF-8; texts without a comma between them are one text.";
    ".asciz" [".string"] "\"text\", ..." Action::Texts { ends_with_zero: true }, "The octets of texts, each with a 0 behind it.";
    ".space" [".skip", ".zero"] "octets, fill" Action::Space, "That many octets of `fill` or 0.";
    ".align" [".balign"] "octets, fill" Action::Align { is_power: false },
        "Goes on at the next multiple of that power of two in octets, over `fill` or 0, over `nop` in the code.";
    ".p2align" "bits, fill" Action::Align { is_power: true }, "The same, at the next multiple of 2^bits octets.";
    ".org" "address" Action::Org, "Goes on at a later address: in words over `nop` in the code, in octets over 0 in the buffer.";
    ".func" "name" Action::Open { is_function: true }, "A label and the beginning of a function that counts are reported for.";
    ".endfunc" "" Action::Close { is_function: true }, "Ends a function.";
    ".region" "name" Action::Open { is_function: false }, "Begins a stretch of code that counts are reported for.";
    ".endregion" "" Action::Close { is_function: false }, "Ends a region.";
    ".if" "expression" Action::If(Test::Expression), "Reads what follows when the number is not 0.";
    ".ifdef" "name" Action::If(Test::Defined), "Reads what follows when the name is defined above.";
    ".ifndef" [".ifnotdef"] "name" Action::If(Test::Undefined), "Reads what follows when the name is not defined above.";
    ".ifb" "text" Action::If(Test::Blank), "Reads what follows when the text is blank.";
    ".ifnb" "text" Action::If(Test::NotBlank), "Reads what follows when the text is not blank.";
    ".ifc" "text, text" Action::If(Test::Same), "Reads what follows when the texts are the same.";
    ".ifnc" "text, text" Action::If(Test::Different), "Reads what follows when the texts differ.";
    ".ifeq" "expression" Action::If(Test::Compared(i64::eq)), "Reads what follows when the number is 0.";
    ".ifne" "expression" Action::If(Test::Compared(i64::ne)), "Reads what follows when the number is not 0.";
    ".ifgt" "expression" Action::If(Test::Compared(i64::gt)), "Reads what follows when the number is greater than 0.";
    ".ifge" "expression" Action::If(Test::Compared(i64::ge)), "Reads what follows when the number is 0 or greater.";
    ".iflt" "expression" Action::If(Test::Compared(i64::lt)), "Reads what follows when the number is less than 0.";
    ".ifle" "expression" Action::If(Test::Compared(i64::le)), "Reads what follows when the number is 0 or less.";
    ".elseif" "expression" Action::ElseIf, "Reads what follows when nothing before was read and the number is not 0.";
    ".else" "" Action::Else, "Reads what follows when nothing before was read.";
    ".endif" "" Action::EndIf, "Ends a condition.";
    ".macro" "name a, b=default, rest..." Action::Macro,
        "Begins a macro: `\\a` is an argument, `\\@` the number of the call, `\\()` nothing; a parameter that is not given and has no default is empty, `a:req` must be given, `rest:vararg` is the same as `rest...`.";
    ".endm" "" Action::Stray(".macro"), "Ends a macro.";
    ".purgem" "name" Action::Purge, "Forgets a macro.";
    ".exitm" "" Action::ExitMacro, "Leaves the macro that is being read.";
    ".local" "name, ..." Action::Local, "Names that each call of a macro has for itself.";
    ".rept" "count, counter" Action::Repeat, "Repeats what follows; the counter goes from 0.";
    ".irp" "name, text, ..." Action::Each { by_character: false },
        "Repeats what follows for each text, which stands where `\\name` is.";
    ".irpc" "name, text" Action::Each { by_character: true }, "The same for each character of the text.";
    ".endr" "" Action::Stray(".rept"), "Ends a repetition.";
    ".error" [".err"] "\"text\"" Action::Say(Severity::Error), "An error of the program's own; the text may be left out.";
    ".warning" "\"text\"" Action::Say(Severity::Warning), "A warning of the program's own.";
    ".end" "" Action::End, "Ends the program; what follows is not read.";
    ".global" [".globl"] "name, ..." Action::Ignored, "Nothing: all names are known everywhere.";
    ".assert" "expression, \"text\"" Action::Assert, "An error when the number is 0, once all names are known.";
}

/// The directive of a name.
pub fn find(name: &str) -> Option<&'static Directive> {
    DIRECTIVES.iter().find(|directive| directive.name == name || directive.also.contains(&name))
}

/// Names between commas.
fn names(cursor: &mut Cursor) -> Parsed<()> {
    loop {
        cursor.name("a name")?;
        if cursor.is_at_end() {
            return Ok(());
        }
        cursor.expect(",")?;
    }
}

impl Assembler<'_> {
    /// Carries out a directive; the cursor stands behind its name.
    pub(crate) fn directive(&mut self, name: &str, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let Some(directive) = find(name) else {
            // What closes it must not be another error.
            if name.starts_with(".if") {
                if self.open_unknown_condition(at) {
                    return Ok(());
                }
            } else if REPETITIONS.iter().any(|opening| name.starts_with(opening)) {
                self.capture(&REPETITIONS, ".endr", at);
            }
            let message = format!("`{name}` is not a directive");
            return Err(
                Problem::new(explain::DIRECTIVE, message, at, "unknown directive").suggest(name, Among::Directives)
            );
        };
        // A structure holds fields and space; code and data would lie nowhere.
        if let Some(open) = &self.structure {
            let belongs = matches!(
                directive.action,
                Action::Field | Action::EndStruct | Action::Struct | Action::Space | Action::Align { .. }
            );
            let adds_code = matches!(
                directive.action,
                Action::Numbers(_)
                    | Action::Fixed
                    | Action::Texts { .. }
                    | Action::Org
                    | Action::Open { .. }
                    | Action::Close { .. }
            );
            if !belongs && adds_code {
                let message = format!("`{name}` does not stand in a structure");
                return Err(Problem::new(explain::SECTION, message, at, "in a structure")
                    .also(Some(open.at), "opened here")
                    .hint("`.endstruct` ends the structure"));
            }
        }
        // A body of an extension has no data and no sections.
        if let Some(template) = &self.body
            && !directive.action.suits_body()
        {
            let message = format!("`{name}` does not stand in an extension");
            return Err(Problem::new(explain::BODY, message, at, "no place for it").hint(template.place_of_data()));
        }
        match directive.action {
            Action::Section(section) => {
                self.section = section;
                cursor.end()
            }
            Action::Entry => self.set_entry(at, cursor),
            Action::Equ => self.define_constant(cursor),
            Action::Set => self.assign(",", cursor),
            Action::Format => self.define_format(cursor),
            Action::Reg => self.define_alias(cursor),
            Action::Unreg => self.remove_alias(cursor),
            Action::Holds => self.hold(cursor),
            Action::Computes => self.computes(at, cursor),
            Action::Include => self.include(at, cursor),
            Action::Struct => self.open_structure(at, cursor),
            Action::Field => self.field(at, cursor),
            Action::EndStruct => self.close_structure(at, cursor),
            Action::Numbers(width) => self.numbers(width, at, cursor),
            Action::Fixed => self.fixed_numbers(at, cursor),
            Action::Texts { ends_with_zero } => self.texts(ends_with_zero, at, cursor),
            Action::Space => self.space(at, cursor),
            Action::Align { is_power } => self.align(is_power, at, cursor),
            Action::Org => self.origin(cursor),
            Action::Open { is_function } => self.open_region(is_function, at, cursor),
            Action::Close { is_function } => self.close_region(is_function, at, cursor),
            Action::If(test) => self.open_condition(test, at, cursor),
            Action::ElseIf => self.next_branch(false, at, cursor),
            Action::Else => self.next_branch(true, at, cursor),
            Action::EndIf => self.close_condition(at, cursor),
            Action::Macro => self.define_macro(at, cursor),
            Action::ExitMacro => self.exit_macro(at),
            Action::Local => self.local(at, cursor),
            Action::Repeat => self.repeat_count(at, cursor),
            Action::Each { by_character } => self.repeat_texts(by_character, at, cursor),
            Action::Purge => self.remove_macro(cursor),
            Action::End => {
                self.frames.clear();
                cursor.end()
            }
            Action::Ignored => names(cursor),
            Action::Stray(opening) => {
                let message = format!("`{name}` without `{opening}`");
                Err(Problem::new(explain::UNOPENED, message, at, "nothing is open"))
            }
            Action::Say(severity) => self.say(severity, at, cursor),
            Action::Assert => self.assert(at, cursor),
        }
    }

    /// `.local` lines say something only to the macro that they stand in.
    fn local(&mut self, at: At, cursor: &mut Cursor) -> Parsed<()> {
        if !cursor.line.is_substituted() {
            return Err(Problem::new(explain::UNOPENED, "`.local` stands outside of macros", at, "not in a macro"));
        }
        names(cursor)
    }

    fn text_operand(&mut self, cursor: &mut Cursor) -> Parsed<String> {
        let Some(token) = cursor.peek().filter(|token| token.kind == TokenKind::Text) else {
            return Err(cursor.expected("a text in quotation marks"));
        };
        let octets = self.text_value(cursor, token)?;
        cursor.skip();
        cursor.end()?;
        Ok(String::from_utf8_lossy(&octets).into_owned())
    }

    fn say(&mut self, severity: Severity, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let text = match cursor.is_at_end() && severity == Severity::Error {
            true => "the program says that this is an error".to_owned(),
            false => self.text_operand(cursor)?,
        };
        let code = if severity == Severity::Error { explain::SAID } else { explain::WARNED };
        let mut problem = Problem::new(code, text, at, "said here");
        problem.severity = severity;
        self.messages.add(problem);
        Ok(())
    }

    fn assert(&mut self, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let mut expression = self.expression(cursor)?;
        let text = if cursor.accept(",") {
            Some(self.text_operand(cursor)?)
        } else {
            cursor.end()?;
            None
        };
        self.settle(&mut expression);
        self.asserts.push((expression, text.unwrap_or_else(|| "the assertion does not hold".into()), at));
        Ok(())
    }

    /// `.include "file"`
    fn include(&mut self, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let token = cursor.peek();
        // A backslash is an escape, or belongs to no name that is the same on all systems.
        let hint = token.and_then(|token| foreign::path(cursor.text(token)));
        let hinted = |mut problem: Box<Problem>| {
            problem.hint = hint.clone().or(problem.hint);
            problem
        };
        let name = self.text_operand(cursor).inspect_err(|_| self.is_incomplete = true).map_err(hinted)?;
        let name_at = token.map_or(at, |token| cursor.at(token));
        self.include_file(&name, name_at).map_err(hinted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_told_apart_and_described() {
        let mut names: Vec<&str> = DIRECTIVES.iter().flat_map(|d| d.also.iter().copied().chain([d.name])).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
        for directive in DIRECTIVES {
            assert!(directive.name.starts_with('.') && directive.doc.ends_with('.'), "{}", directive.name);
        }
    }
}
