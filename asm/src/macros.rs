//! Macros and repetitions: blocks of text that are read again with something put in.

use std::rc::Rc;

use isa::program::Line;

use crate::assembler::Assembler;
use crate::cursor::Cursor;
use crate::explain;
use crate::frame::{OpenText, Origin, Repeat, leading_directive};
use crate::limits::PARAMETERS;
use crate::line::{OriginLine, Substitution};
use crate::message::{At, MacroCall, Parsed, Problem, Via};
use crate::symbol::SymbolValue;
use crate::token::{Token, TokenKind, tokens};

/// A parameter of a macro.
#[derive(Clone, Debug)]
pub(crate) struct Parameter {
    name: Rc<str>,
    default: Rc<str>,
    is_required: bool,
    takes_rest: bool,
}

/// A macro.
#[derive(Debug)]
pub(crate) struct Macro {
    pub name: Rc<str>,
    parameters: Vec<Parameter>,
    lines: Rc<[OriginLine]>,
    /// Names that every expansion has for itself.
    locals: Vec<Rc<str>>,
    pub at: At,
}

/// The text of the tokens `from..to` of a line.
fn text_of<'t>(cursor: &Cursor<'t>, from: usize, to: usize) -> &'t str {
    match cursor.tokens.get(from..to) {
        Some([first, .., last]) => &cursor.line.text[first.start as usize..last.end as usize],
        Some([only]) => &cursor.line.text[only.start as usize..only.end as usize],
        _ => "",
    }
}

/// The text of an argument: a text alone stands for what is between its quotation marks.
fn argument_of(cursor: &Cursor, from: usize, to: usize) -> Rc<str> {
    let text = text_of(cursor, from, to);
    match cursor.tokens.get(from..to) {
        Some([only]) if only.kind == TokenKind::Text => text[1..text.len() - 1].replace("\\\"", "\"").into(),
        _ => text.into(),
    }
}

/// A blank between two tokens separates arguments: it stands between two operands, which no expression has side by side.
fn is_separated(before: Token, after: Token) -> bool {
    let is_word = |kind| !matches!(kind, TokenKind::Mark(_));
    before.end < after.start && is_word(after.kind) && (is_word(before.kind) || before.kind == TokenKind::Mark(")"))
}

/// Splits the rest of a line at the commas, and the blanks between operands, outside of parentheses: token ranges.
fn split(cursor: &Cursor) -> Vec<(usize, usize)> {
    let mut parts = Vec::new();
    let mut start = cursor.position;
    let mut depth = 0usize;
    for (place, token) in cursor.tokens.iter().enumerate().skip(start) {
        // `add_all s1 s2, s3` has three arguments.
        if depth == 0 && place > start && is_separated(cursor.tokens[place - 1], *token) {
            parts.push((start, place));
            start = place;
        }
        match token.kind {
            // Commas of a call in parentheses belong to the argument.
            TokenKind::Mark("(") => depth += 1,
            TokenKind::Mark(")") => depth = depth.saturating_sub(1),
            TokenKind::Mark(",") if depth == 0 => {
                parts.push((start, place));
                start = place + 1;
            }
            _ => {}
        }
    }
    if !cursor.is_at_end() {
        parts.push((start, cursor.tokens.len()));
    }
    parts
}

/// The texts of the rest of a line, as a macro gets its arguments.
pub(crate) fn arguments(cursor: &Cursor) -> Vec<Rc<str>> {
    split(cursor).into_iter().map(|(start, end)| argument_of(cursor, start, end)).collect()
}

/// The suffix of a parameter's name: `:req` or `:vararg`, also written `...`.
fn qualifier(parameter: &mut Parameter, cursor: &mut Cursor) -> Parsed<()> {
    if !cursor.accept(":") {
        parameter.takes_rest = cursor.accept("...");
        return Ok(());
    }
    match cursor.name("`req` or `vararg`")? {
        ("vararg", _) => {
            parameter.takes_rest = true;
            Ok(())
        }
        ("req", _) => {
            parameter.is_required = true;
            Ok(())
        }
        (other, at) => {
            let message = format!("a parameter cannot be `{other}`");
            let problem = Problem::new(explain::MACRO, message, at, "`req` or `vararg` is expected");
            Err(problem)
        }
    }
}

/// Beginnings of the names of directives that `.endr` closes.
pub(crate) const REPETITIONS: [&str; 2] = [".rep", ".irp"];

fn no_parameter(definition: &Macro, text: &str, at: At) -> Box<Problem> {
    let names: Vec<String> = definition.parameters.iter().map(|parameter| format!("`{}`", parameter.name)).collect();
    let hint = match names.is_empty() {
        true => "it has none".to_owned(),
        false => format!("its parameters: {}; quotation marks around an argument keep its `=`", names.join(", ")),
    };
    let message = format!("the macro `{}` has no parameter `{text}`", definition.name);
    let problem = Problem::new(explain::MACRO, message, at, "no such parameter");
    problem.also(Some(definition.at), "defined here").hint(hint)
}

impl Assembler<'_> {
    /// `.macro name a, b=default, rest...`, where GNU as has `a:req` and `rest:vararg`.
    pub(crate) fn define_macro(&mut self, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let header = self.macro_header(cursor);
        let Some(lines) = self.capture(&[".macro"], ".endm", at) else { return header.map(|_| ()) };
        let (name, name_at, parameters) = header?;
        if self.operations.contains_key(&*name) || crate::pseudo::find(&name).is_some() {
            let message = format!("`{name}` is an instruction and cannot be a macro");
            return Err(Problem::new(explain::RESERVED, message, name_at, "choose another name"));
        }
        if let Some(other) = self.macros.get(&name) {
            let message = format!("the macro `{name}` is defined twice");
            return Err(Problem::new(explain::DUPLICATE, message, name_at, "second definition")
                .also(Some(other.at), "first definition"));
        }
        let locals = self.local_names(&lines);
        self.macros.insert(name.clone(), Rc::new(Macro { name, parameters, lines, locals, at: name_at }));
        Ok(())
    }

    fn macro_header(&mut self, cursor: &mut Cursor) -> Parsed<(Rc<str>, At, Vec<Parameter>)> {
        let (name, name_at) = cursor.name("the name of the macro")?;
        let mut parameters: Vec<Parameter> = Vec::new();
        cursor.accept(",");
        while !cursor.is_at_end() {
            let (text, at) = cursor.name("a parameter")?;
            if parameters.iter().any(|other| &*other.name == text) {
                let message = format!("the parameter `{text}` is there twice");
                return Err(Problem::new(explain::DUPLICATE, message, at, "second one"));
            }
            if parameters.len() == PARAMETERS {
                let message = format!("the macro `{name}` has more than {PARAMETERS} parameters");
                return Err(Problem::new(explain::SIZE, message, at, "one too many"));
            }
            // One that takes the rest leaves nothing for another.
            if parameters.last().is_some_and(|last| last.takes_rest) {
                return Err(Problem::new(
                    explain::MACRO,
                    "nothing follows a parameter that takes the rest",
                    at,
                    "too late",
                ));
            }
            let mut parameter =
                Parameter { name: text.into(), default: "".into(), is_required: false, takes_rest: false };
            qualifier(&mut parameter, cursor)?;
            // A default goes up to the next comma outside of parentheses.
            if !parameter.takes_rest && !parameter.is_required && cursor.accept("=") {
                let start = cursor.position;
                let end = split(cursor).first().map_or(start, |&(_, end)| end);
                parameter.default = argument_of(cursor, start, end);
                cursor.position = end;
            }
            parameters.push(parameter);
            if !cursor.accept(",") && !matches!(cursor.kind(), None | Some(TokenKind::Name)) {
                return Err(cursor.expected("a comma"));
            }
        }
        Ok((name.into(), name_at, parameters))
    }

    /// The names on the `.local` lines of a macro, nested definitions left out.
    fn local_names(&mut self, lines: &[OriginLine]) -> Vec<Rc<str>> {
        let mut names = Vec::new();
        let mut depth = 0usize;
        for line in lines {
            match leading_directive(&line.text) {
                Some(".macro") => depth += 1,
                Some(".endm") => depth = depth.saturating_sub(1),
                Some(".local") if depth == 0 => {
                    let (found, _) = tokens(&line.text);
                    let cursor = Cursor { line, tokens: &found, position: 0 };
                    names.extend(found.iter().filter(|t| t.kind == TokenKind::Name).map(|&t| Rc::from(cursor.text(t))));
                }
                _ => {}
            }
        }
        names
    }

    /// Starts a macro call.
    pub(crate) fn call_macro(&mut self, definition: &Rc<Macro>, at: At, cursor: &mut Cursor) {
        match self.macro_arguments(definition, at, cursor) {
            Err(problem) => self.messages.add(problem),
            Ok(substitution) => {
                // A short line that is repeated can call with long arguments: they count before they are put into any line.
                if self.expansion_depth() > 0 {
                    self.octets_expanded += substitution.octets();
                }
                let via = Via::Macro(definition.name.clone());
                let context = self.messages.enter(MacroCall { at: cursor.line.at_all(), via });
                let here = Line { source: cursor.line.source, line: cursor.line.number };
                let outermost = self.outermost_call(cursor.line.context).unwrap_or(here);
                self.call_lines.insert(context, outermost);
                let mut frame = OpenText::new(definition.lines.clone(), Origin::Macro);
                frame.substitution = Some(Rc::new(substitution));
                frame.context = Some(context);
                self.enter(frame, at);
            }
        }
    }

    /// Line of the outermost macro call through which text was reached; `None` outside of macros.
    pub(crate) fn outermost_call(&self, context: u32) -> Option<Line> {
        let mut context = context;
        // Passes of repetitions are contexts, too, which stand in that of their header.
        while context != 0 && !self.call_lines.contains_key(&context) {
            context = self.messages.calls[context as usize - 1].at.context;
        }
        self.call_lines.get(&context).copied()
    }

    fn macro_arguments(&mut self, definition: &Macro, at: At, cursor: &mut Cursor) -> Parsed<Substitution> {
        let parameters = &definition.parameters;
        // Arguments by position fill the parameters from the left; `name=text` fills that of the name.
        let mut values: Vec<Option<Rc<str>>> = vec![None; parameters.len()];
        let mut next = 0;
        for (start, end) in split(cursor) {
            let place = cursor.tokens.get(start).map_or(cursor.here(), |&token| cursor.at(token));
            // The rest, commas included, is one argument.
            if parameters.get(next).is_some_and(|parameter| parameter.takes_rest) {
                values[next] = Some(text_of(cursor, start, cursor.tokens.len()).into());
                break;
            }
            let named = match cursor.tokens.get(start..end) {
                Some([name, equals, ..]) if name.kind == TokenKind::Name && equals.kind == TokenKind::Mark("=") => {
                    let text = cursor.text(*name);
                    let slot = parameters.iter().position(|parameter| *parameter.name == *text);
                    Some(slot.ok_or_else(|| no_parameter(definition, text, cursor.at(*name)))?)
                }
                _ => None,
            };
            let (slot, start) = match named {
                Some(slot) => (slot, start + 2),
                None => (next, start),
            };
            let Some(value) = values.get_mut(slot) else {
                let message = format!("the macro `{}` takes at most {} arguments", definition.name, parameters.len());
                return Err(Problem::new(explain::MACRO, message, place, "one too many")
                    .also(Some(definition.at), "defined here"));
            };
            if value.is_some() {
                let message = format!("the argument `{}` is there twice", parameters[slot].name);
                return Err(Problem::new(explain::MACRO, message, place, "second one"));
            }
            *value = (start < end).then(|| argument_of(cursor, start, end));
            next += usize::from(named.is_none());
        }
        // Each call has a number: that of `\@` and of its local names.
        cursor.position = cursor.tokens.len();
        self.expansions += 1;
        let number = self.expansions;
        let mut substitution = Substitution { number: Some(number), ..Substitution::default() };
        for (parameter, value) in parameters.iter().zip(values) {
            if value.is_none() && parameter.is_required {
                let message = format!("the macro `{}` needs an argument `{}`", definition.name, parameter.name);
                return Err(Problem::new(explain::MACRO, message, at, "argument missing")
                    .also(Some(definition.at), "defined here"));
            }
            let text = value.unwrap_or_else(|| parameter.default.clone());
            substitution.arguments.insert(parameter.name.clone(), text);
        }
        // `loop` of call 7 is `loop$7`, which no other call has.
        for name in &definition.locals {
            substitution.locals.insert(name.clone(), format!("{name}${number}").into());
        }
        Ok(substitution)
    }

    /// `.purgem name`
    pub(crate) fn remove_macro(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let (text, at) = cursor.name("the name of a macro")?;
        cursor.end()?;
        match self.macros.remove(text) {
            Some(_) => Ok(()),
            None => Err(Problem::new(explain::MACRO, format!("there is no macro `{text}`"), at, "nothing to forget")),
        }
    }

    /// `.exitm`
    pub(crate) fn exit_macro(&mut self, at: At) -> Parsed<()> {
        let Some(place) = self.frames.iter().rposition(|frame| frame.origin == Origin::Macro) else {
            return Err(Problem::new(explain::UNOPENED, "`.exitm` stands outside of macros", at, "no macro to leave"));
        };
        self.frames.truncate(place);
        Ok(())
    }

    /// `.rept count, counter`
    pub(crate) fn repeat_count(&mut self, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let header = self.repeat_header(cursor);
        let Some(lines) = self.capture(&REPETITIONS, ".endr", at) else { return header.map(|_| ()) };
        let Some((count, count_at, counter)) = header? else { return Ok(()) };
        if count < 0 {
            return Err(Problem::new(explain::RANGE, format!("{count} repetitions"), count_at, "negative"));
        }
        let most = self.options.limits.lines;
        if count.saturating_mul(lines.len() as i64) > most as i64 {
            let message = format!("{count} repetitions of {} lines make more than {most} lines", lines.len());
            return Err(Problem::new(explain::SIZE, message, count_at, "too many"));
        }
        if count == 0 || lines.is_empty() {
            return Ok(());
        }
        if let Some((text, counter_at)) = &counter {
            self.set_variable(text, *counter_at, 0)?;
        }
        let mut frame = OpenText::new(lines, Origin::Repetition);
        let counter = counter.map(|(text, _)| {
            let via = Via::Pass(text.clone(), "0".into());
            frame.context = Some(self.messages.enter(MacroCall { at, via }));
            self.names.intern(&text)
        });
        frame.repeat = Some(Repeat::Count { remaining: count - 1, counter, index: 0, at });
        self.enter(frame, at);
        Ok(())
    }

    #[allow(clippy::type_complexity, reason = "the parts of one header")]
    fn repeat_header(&mut self, cursor: &mut Cursor) -> Parsed<Option<(i64, At, Option<(Rc<str>, At)>)>> {
        let count = self.expression(cursor)?;
        let mut counter = None;
        if cursor.accept(",") {
            let (text, at) = cursor.name("the name of the counter")?;
            counter = Some((text.into(), at));
        }
        cursor.end()?;
        let value = self.value_now(&count)?;
        Ok(value.map(|value| (value, count.at, counter)))
    }

    /// `.irp parameter, text, text`, or `.irpc parameter, text` for the characters of the text.
    pub(crate) fn repeat_texts(&mut self, by_character: bool, at: At, cursor: &mut Cursor) -> Parsed<()> {
        let header = cursor.name("a parameter").and_then(|(text, _)| {
            if !cursor.is_at_end() {
                cursor.expect(",")?;
            }
            Ok(Rc::<str>::from(text))
        });
        let Some(lines) = self.capture(&REPETITIONS, ".endr", at) else { return header.map(|_| ()) };
        let parameter = header?;
        let mut texts: Vec<Rc<str>> = if by_character {
            let text = argument_of(cursor, cursor.position, cursor.tokens.len());
            text.chars().rev().map(|letter| letter.to_string().into()).collect()
        } else {
            arguments(cursor).into_iter().rev().collect()
        };
        let Some(first) = texts.pop() else { return Ok(()) };
        let mut frame = OpenText::new(lines, Origin::Repetition);
        let via = Via::Pass(parameter.clone(), first.clone());
        frame.context = Some(self.messages.enter(MacroCall { at, via }));
        let arguments = [(parameter.clone(), first)].into();
        frame.substitution = Some(Rc::new(Substitution { arguments, ..Substitution::default() }));
        frame.repeat = Some(Repeat::Texts { parameter, remaining: texts, at });
        self.enter(frame, at);
        Ok(())
    }

    /// The counter of a repetition, or a name that `.set` defines.
    pub(crate) fn set_variable(&mut self, text: &str, at: At, value: i64) -> Parsed<()> {
        self.check_name(text, at)?;
        let name = self.names.intern(text);
        let times = match self.names.get(name).map(|symbol| (&symbol.value, symbol.at)) {
            None => 0,
            Some((SymbolValue::Variable(_, times), _)) => *times,
            Some((SymbolValue::Broken, _)) => 0,
            Some((_, other)) => {
                let message = format!("`{text}` cannot be set: it is no variable");
                return Err(Problem::new(explain::DUPLICATE, message, at, "set here").also(other, "defined here"));
            }
        };
        self.names.set(name, SymbolValue::Variable(value, times.saturating_add(1)), Some(at));
        Ok(())
    }
}
