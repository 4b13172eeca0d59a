//! Places in expanded text, problems, and their way into an [`messages::Report`] in the order of the text.

use std::collections::HashSet;
use std::rc::Rc;
use std::sync::Arc;

use messages::{Diagnostic, Place, Report, Severity, Source, nearest, question};

use crate::limits::{COMPARED_OCTETS, KEPT_MESSAGES, MESSAGES};

/// A place: octets of a file, and the chain of macro calls through which the text was reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct At {
    pub source: u16,
    /// 1 + index into [`Messages::calls`]; 0 for text outside of macros.
    pub context: u32,
    pub start: u32,
    pub end: u32,
}

impl At {
    /// From the start of this place to the end of `other`.
    pub fn to(self, other: At) -> At {
        At { end: other.end.max(self.start), ..self }
    }

    /// The place behind this one.
    pub fn behind(self) -> At {
        At { start: self.end, ..self }
    }
}

/// A macro call, or a pass of a repetition.
#[derive(Clone, Debug)]
pub(crate) struct MacroCall {
    /// Place of the call; its context is the call around it.
    pub at: At,
    /// The macro or repetition that is called.
    pub via: Via,
}

/// The cause of lines that are read again.
#[derive(Clone, Debug)]
pub(crate) enum Via {
    /// A macro of that name.
    Macro(Rc<str>),
    /// A pass of a repetition: its counter or parameter, and what that is.
    Pass(Rc<str>, Rc<str>),
}

impl Via {
    fn label(&self) -> String {
        match self {
            Via::Macro(name) => format!("in this call of `{name}`"),
            Via::Pass(name, value) => format!("in the pass with {name} = {value}"),
        }
    }
}

/// The kind of name that was meant, for suggestions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Among {
    Instructions,
    Directives,
    Symbols,
    Formats,
    Sizes,
    Registers,
}

/// One message in the making.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    pub severity: Severity,
    pub code: &'static str,
    pub message: String,
    pub at: Option<At>,
    pub label: String,
    pub others: Vec<(At, String)>,
    pub hint: Option<String>,
    pub suggest: Option<(String, Among)>,
}

/// A result whose error is a problem to report.
pub(crate) type Parsed<T> = Result<T, Box<Problem>>;

impl Problem {
    pub fn new(code: &'static str, message: impl Into<String>, at: At, label: impl Into<String>) -> Box<Problem> {
        Box::new(Problem {
            severity: Severity::Error,
            code,
            message: message.into(),
            at: Some(at),
            label: label.into(),
            others: Vec::new(),
            hint: None,
            suggest: None,
        })
    }

    pub fn hint(mut self: Box<Problem>, hint: impl Into<String>) -> Box<Problem> {
        self.hint = Some(hint.into());
        self
    }

    pub fn also(mut self: Box<Problem>, at: Option<At>, label: impl Into<String>) -> Box<Problem> {
        if let Some(at) = at {
            self.others.push((at, label.into()));
        }
        self
    }

    pub fn suggest(mut self: Box<Problem>, name: &str, among: Among) -> Box<Problem> {
        self.suggest = Some((name.into(), among));
        self
    }
}

/// The messages of an assembly.
#[derive(Debug, Default)]
pub(crate) struct Messages {
    kept: Vec<Problem>,
    seen: HashSet<(&'static str, u16, u32, u32, String)>,
    unkept: usize,
    unkept_errors: usize,
    /// Set while a statement whose text was refused is still carried out.
    pub is_muted: bool,
    /// Macro calls, by [`At::context`].
    pub calls: Vec<MacroCall>,
}

impl Messages {
    /// The context of what a call leads to.
    pub fn enter(&mut self, call: MacroCall) -> u32 {
        self.calls.push(call);
        self.calls.len() as u32
    }

    /// Adds a message, unless the same one stands at the same place of the text already.
    #[allow(clippy::boxed_local, reason = "problems travel boxed, as errors of results")]
    pub fn add(&mut self, problem: Box<Problem>) {
        if self.is_muted {
            return;
        }
        let at = problem.at.unwrap_or_default();
        // A repetition could make millions of messages: keep some and count the others.
        if self.kept.len() >= KEPT_MESSAGES {
            self.unkept += 1;
            self.unkept_errors += usize::from(problem.severity == Severity::Error);
        } else if self.seen.insert((problem.code, at.source, at.start, at.end, problem.message.clone())) {
            self.kept.push(*problem);
        }
    }

    /// The report; `known` gives the names that a suggestion may come from, of which `most` are looked at.
    pub fn report<'a>(mut self, sources: &[Arc<Source>], most: usize, known: impl Fn(Among) -> Vec<&'a str>) -> Report {
        // Messages come from two passes; people read them in the order of the text.
        self.kept.sort_by_key(|problem| problem.at.map(|at| (at.source, at.start, at.end)));
        let calls = std::mem::take(&mut self.calls);
        let is_error = |problem: &&Problem| problem.severity == Severity::Error;
        let beyond = self.unkept + self.kept.len().saturating_sub(MESSAGES);
        let errors = self.unkept_errors + self.kept.iter().skip(MESSAGES).filter(is_error).count();
        // Every message may seek a name among all that there are: the first ones do until that becomes long.
        let mut compared = 0;
        let mut similar = |name: &str, among: Among| {
            if compared > most || name.len() > COMPARED_OCTETS {
                return None;
            }
            let names = known(among);
            compared += names.len();
            if compared > most {
                return None;
            }
            nearest(name, names.into_iter().filter(|word| word.len() <= COMPARED_OCTETS))
        };
        let mut shown: Vec<Diagnostic> = self
            .kept
            .into_iter()
            .take(MESSAGES)
            .map(|problem| diagnostic(problem, sources, &calls, &mut similar))
            .collect();
        if beyond > 0 {
            let text = if beyond == 1 { "message is" } else { "messages are" };
            shown.push(Diagnostic::note(format!("{beyond} more {text} not shown"), errors));
        }
        Report(shown)
    }
}

/// Most calls of a chain that a message shows, besides the outermost one.
const SHOWN_CALLS: usize = 3;

/// The calls through which a place was reached, innermost first, each line of text once, long chains cut.
fn shown_calls(context: u32, calls: &[MacroCall]) -> Vec<&MacroCall> {
    let mut chain: Vec<&MacroCall> = Vec::new();
    let mut next = context;
    while let Some(call) = (next as usize).checked_sub(1).and_then(|at| calls.get(at)) {
        if chain.iter().all(|other| (other.at.source, other.at.start) != (call.at.source, call.at.start)) {
            chain.push(call);
        }
        next = call.at.context;
    }
    // Keep the innermost calls and the outermost one.
    if chain.len() > SHOWN_CALLS + 1 {
        chain.drain(SHOWN_CALLS..chain.len() - 1);
    }
    chain
}

fn diagnostic<'a>(
    problem: Problem,
    sources: &[Arc<Source>],
    calls: &[MacroCall],
    similar: &mut impl FnMut(&str, Among) -> Option<&'a str>,
) -> Diagnostic {
    let place = |at: At| Place::new(&sources[at.source as usize], at.start as usize..at.end as usize);
    let mut message = match problem.severity {
        Severity::Error => Diagnostic::error(problem.message),
        Severity::Warning => Diagnostic::warning(problem.message),
        Severity::Note { errors } => Diagnostic::note(problem.message, errors),
    };
    message = message.code(problem.code);
    // Show the place, others that explain it, and the calls through which it was reached
    if let Some(at) = problem.at {
        message = message.at(place(at), problem.label);
    }
    for (at, label) in problem.others {
        message = message.also(place(at), label);
    }
    for call in shown_calls(problem.at.map_or(0, |at| at.context), calls) {
        message = message.also(place(call.at), call.via.label());
    }
    // A name that is nearly the same tells more than a general hint. If it is the very same, it is defined, but too late.
    let suggestion = problem.suggest.as_ref().and_then(|(name, among)| similar(name, *among));
    let is_same = problem.suggest.as_ref().is_some_and(|(name, _)| suggestion == Some(name.as_str()));
    match (suggestion, problem.hint) {
        (Some(word), _) if is_same => {
            message.hint(format!("`{word}` is defined further on; it must stand above its use"))
        }
        (Some(word), _) => message.hint(question(word)),
        (None, Some(hint)) => message.hint(hint),
        (None, None) => message,
    }
}
