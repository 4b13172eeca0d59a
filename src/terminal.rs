//! Streams of a command: results to standard output, progress and messages to standard error, colours only
//! where a terminal shows them.

use std::ffi::{OsStr, OsString};
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::time::{Duration, Instant};

use clap::error::{ContextKind, ContextValue};
use clap::{Args, ColorChoice, ValueEnum};
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use messages::{Diagnostic, Report};

use crate::failure::Failure;
use crate::message::{JsonMessage, SCHEMA};

/// Form of messages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum MessageFormat {
    /// Text with places and carets.
    #[default]
    Human,
    /// A JSON object a line, see `lancer schema lancer-message-1`.
    Json,
}

/// Colours of messages and help.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Colours {
    /// Colours where a terminal shows them, unless NO_COLOR is set.
    #[default]
    Auto,
    /// Colours also in files and pipes.
    Always,
    /// No colours.
    Never,
}

/// Options of the streams, which all commands have.
#[derive(Args, Clone, Copy, Debug, Default)]
#[command(next_help_heading = "Everywhere")]
pub struct StreamArguments {
    /// Messages on standard error: human, or json, an object a line (`lancer schema lancer-message-1`).
    #[arg(long, global = true, value_enum, hide_possible_values = true, value_name = "FORM", default_value_t)]
    pub message_format: MessageFormat,
    /// Colours of messages and help: auto, always or never.
    #[arg(
        long = "color",
        alias = "colour",
        global = true,
        value_enum,
        hide_possible_values = true,
        value_name = "WHEN",
        default_value_t
    )]
    pub colours: Colours,
}

impl StreamArguments {
    /// The options as they stand on a command line, which may be wrong elsewhere: what is said on that follows them.
    pub fn sniffed(arguments: &[OsString]) -> StreamArguments {
        let words: Vec<&str> = arguments.iter().map(|word| word.to_str().unwrap_or_default()).collect();
        let words = words.split(|word| *word == "--").next().unwrap_or_default();
        let value = |option: &str| {
            words.iter().enumerate().rev().find_map(|(at, word)| match word.strip_prefix(option)?.strip_prefix('=') {
                Some(value) => Some(value),
                None if *word == option => words.get(at + 1).copied(),
                None => None,
            })
        };
        let format = value("--message-format").and_then(|value| MessageFormat::from_str(value, false).ok());
        let colours = value("--color").or_else(|| value("--colour"));
        StreamArguments {
            message_format: format.unwrap_or_default(),
            colours: colours.and_then(|value| Colours::from_str(value, false).ok()).unwrap_or_default(),
        }
    }

    /// Colours of help and of the parser's own messages.
    pub fn colour_choice(self) -> ColorChoice {
        match self.colours {
            Colours::Auto => ColorChoice::Auto,
            Colours::Always => ColorChoice::Always,
            Colours::Never => ColorChoice::Never,
        }
    }
}

/// The two streams of a command.
pub struct Terminal {
    out: Box<dyn Write>,
    format: MessageFormat,
    is_coloured: bool,
    is_watched: bool,
}

impl Terminal {
    /// The process's own streams.
    pub fn new(arguments: StreamArguments) -> Terminal {
        let variable = |name| std::env::var_os(name);
        let is_dumb = variable("TERM").is_some_and(|value| value == "dumb");
        let is_shown = io::stderr().is_terminal() && !is_dumb;
        Terminal {
            out: Box::new(io::BufWriter::new(io::stdout())),
            format: arguments.message_format,
            is_coloured: is_coloured(arguments.colours, is_shown, variable("NO_COLOR").as_deref()),
            is_watched: is_shown && arguments.message_format == MessageFormat::Human,
        }
    }

    /// Writes a result.
    ///
    /// # Errors
    /// A reader that went away, or a full disk.
    pub fn print(&mut self, text: &str) -> Result<(), Failure> {
        self.print_octets(text.as_bytes())
    }

    /// Writes a result that people read: its lines are folded where a terminal, or `COLUMNS`, has less room.
    ///
    /// # Errors
    /// See [`Terminal::print`].
    pub fn tell(&mut self, text: &str) -> Result<(), Failure> {
        match columns() {
            Some(columns) => self.print(&folded(text, columns)),
            None => self.print(text),
        }
    }

    /// Writes a result that is no text.
    ///
    /// # Errors
    /// See [`Terminal::print`].
    pub fn print_octets(&mut self, octets: &[u8]) -> Result<(), Failure> {
        self.out.write_all(octets).and_then(|()| self.out.flush()).map_err(|error| match error.kind() {
            ErrorKind::BrokenPipe => Failure::ClosedPipe,
            _ => Diagnostic::error(format!("standard output cannot be written: {error}")).into(),
        })
    }

    /// Shows messages about an input; nothing when there are none.
    pub fn show(&self, report: &Report) {
        match self.format {
            _ if report.0.is_empty() => {}
            MessageFormat::Human => line(&report.render(self.is_coloured)),
            MessageFormat::Json => report.0.iter().for_each(|message| line(&JsonMessage::new(message).line())),
        }
    }

    /// Says something that is no result.
    pub fn say(&self, text: &str) {
        match self.format {
            MessageFormat::Human => line(text),
            MessageFormat::Json => self.show(&Diagnostic::note(text, 0).into()),
        }
    }

    /// Shows what the parser of the command line refuses.
    pub fn show_usage(&self, error: &clap::Error) {
        match self.format {
            // Nobody is left to be told when standard error is closed.
            MessageFormat::Human => drop(error.print()),
            MessageFormat::Json => line(&usage(error).line()),
        }
    }

    /// A count of what has been done of a work whose length nobody knows; shown where [`Terminal::progress`] is.
    pub fn counter(&self, what: &str) -> ProgressBar {
        if !self.is_watched {
            return ProgressBar::hidden();
        }
        let style = ProgressStyle::with_template("{msg:<24} {human_pos}").expect("the template is valid");
        ProgressBar::no_length().with_style(style).with_message(what.to_owned())
    }

    /// A bar that shows how far a work of `length` steps has come; it is invisible where standard error is no terminal,
    /// and vanishes when it is finished.
    pub fn progress(&self, what: &str, length: u64) -> ProgressBar {
        if !self.is_watched {
            return ProgressBar::hidden();
        }
        let start = Instant::now();
        let left = move |state: &ProgressState, out: &mut dyn std::fmt::Write| {
            let left = left(start.elapsed(), state.pos(), state.len().unwrap_or(0));
            // A closed terminal is no reason to stop.
            let _ = out.write_str(&left.map_or_else(String::new, |left| format!("{left} left")));
        };
        let style = ProgressStyle::with_template("{msg:<24} [{bar:32}] {percent:>3} %  {left}")
            .expect("the template is valid")
            .with_key("left", left)
            .progress_chars("=> ");
        ProgressBar::new(length).with_style(style).with_message(what.to_owned())
    }
}

/// Columns of texts where nobody says how many there are.
const COLUMNS: usize = 100;

/// Fewest columns that texts are made for.
const FEWEST_COLUMNS: usize = 40;

/// Columns that results have: what the variable `COLUMNS` says, else those of the terminal that shows them; `None` in files and
/// pipes, which have no end on the right.
pub fn columns() -> Option<usize> {
    let said = std::env::var("COLUMNS").ok().and_then(|text| text.trim().parse::<usize>().ok());
    let shown = || terminal_size::terminal_size_of(io::stdout()).map(|(width, _)| width.0.into());
    said.filter(|&columns| columns != 0).or_else(shown).map(|columns| columns.max(FEWEST_COLUMNS))
}

/// Columns that help has.
pub fn width() -> usize {
    columns().unwrap_or(COLUMNS)
}

/// Text whose lines have no more than so many columns, as far as there are blanks to fold them at; what follows stands four
/// columns further to the right than the line's beginning.
pub fn folded(text: &str, columns: usize) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let (mut rest, end) = match line.strip_suffix('\n') {
            Some(line) => (line, "\n"),
            None => (line, ""),
        };
        let indent = rest.len() - rest.trim_start_matches(' ').len();
        let mut margin = 0;
        while let Some(at) = fold(rest, columns.saturating_sub(margin), indent.saturating_sub(margin)) {
            out += &format!("{}{}\n", " ".repeat(margin), rest[..at].trim_end());
            rest = rest[at..].trim_start();
            margin = (indent + 4).min(columns / 2);
        }
        out += &format!("{}{rest}{end}", " ".repeat(if rest.is_empty() { 0 } else { margin }));
    }
    out
}

/// Offset of the blank at which a line is folded that has more than so many columns; blanks in front of its first word, and none
/// at all, do not fold it.
fn fold(line: &str, columns: usize, indent: usize) -> Option<usize> {
    let (end, _) = line.char_indices().nth(columns)?;
    let blank = |text: &str, from: usize| text.char_indices().skip_while(|(at, _)| *at < from).find(|(_, c)| *c == ' ');
    let first = line[..=end.min(line.len() - 1)]
        .char_indices()
        .filter(|(at, c)| *c == ' ' && *at > indent)
        .map(|(at, _)| at)
        .next_back();
    first.or_else(|| blank(line, end).map(|(at, _)| at)).filter(|&at| !line[at..].trim().is_empty())
}

/// A line on standard error.
fn line(text: &str) {
    // Nobody is left to be told when standard error is closed.
    let _ = writeln!(io::stderr(), "{text}");
}

/// A mistake in the command line, as data.
fn usage(error: &clap::Error) -> JsonMessage {
    let rendered = error.render().to_string();
    let first = rendered.lines().next().unwrap_or_default();
    let message = match first.strip_prefix("error: ") {
        Some(message) => rendered["error: ".len()..].split("\n\n").next().unwrap_or(message).to_owned(),
        // Without a command there is the help in its place.
        None => "a command is missing".to_owned(),
    };
    let suggestions = [ContextKind::SuggestedSubcommand, ContextKind::SuggestedArg, ContextKind::SuggestedValue];
    let suggested: Vec<String> = suggestions
        .into_iter()
        .filter_map(|kind| match error.get(kind)? {
            ContextValue::String(one) => Some(vec![one.clone()]),
            ContextValue::Strings(many) => Some(many.clone()),
            _ => None,
        })
        .flatten()
        .map(|name| format!("`{name}`"))
        .collect();
    let tips: Vec<&str> = rendered.lines().filter_map(|line| line.trim().strip_prefix("tip: ")).collect();
    let help = match (suggested.is_empty(), tips.is_empty()) {
        (false, _) => Some(format!("did you mean {}?", suggested.join(" or "))),
        (true, false) => Some(tips.join("; ")),
        (true, true) => None,
    };
    JsonMessage {
        schema: SCHEMA,
        severity: "error",
        code: None,
        message,
        spans: Vec::new(),
        help,
        errors: 1,
        rendered: rendered.trim_end().to_owned(),
    }
}

/// Time before which nothing is said on what is left: the first steps of a work tell too little.
const SURE_AFTER: Duration = Duration::from_secs(1);

/// Share of a work, 1 in so many, before which nothing is said on what is left.
const SURE_PART: u64 = 50;

/// Time that is left of a work, from the steps that are done; `None` while that is a guess.
///
/// For example 25 of 100 steps in 10 s leave 30 s.
fn left(passed: Duration, done: u64, length: u64) -> Option<String> {
    if passed < SURE_AFTER || done.saturating_mul(SURE_PART) < length || done == 0 {
        return None;
    }
    let left = passed.as_secs_f64() * length.saturating_sub(done) as f64 / done as f64;
    let seconds = left.ceil() as u64;
    Some(match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{}:{:02} min", seconds / 60, seconds % 60),
        _ => format!("{}:{:02} h", seconds / 3600, seconds / 60 % 60),
    })
}

/// True where messages have colours, given what the user wants, whether a terminal would show them, and the value of `NO_COLOR`,
/// which switches them off by any value but an empty one (<https://no-color.org>).
fn is_coloured(wanted: Colours, is_shown: bool, no_color: Option<&OsStr>) -> bool {
    match wanted {
        Colours::Always => true,
        Colours::Never => false,
        Colours::Auto => is_shown && no_color.is_none_or(OsStr::is_empty),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_need_a_terminal_and_no_veto() {
        let cases = [
            (false, None, false),
            (true, None, true),
            (true, Some(""), true),
            (true, Some("1"), false),
            (true, Some("0"), false),
            (false, Some(""), false),
        ];
        for (is_shown, no_color, expected) in cases {
            let no_color = no_color.map(OsStr::new);
            assert_eq!(is_coloured(Colours::Auto, is_shown, no_color), expected, "{is_shown} {no_color:?}");
            assert!(is_coloured(Colours::Always, is_shown, no_color), "asked for");
            assert!(!is_coloured(Colours::Never, is_shown, no_color), "refused");
        }
    }

    #[test]
    fn options_of_streams_are_found_in_wrong_command_lines() {
        let sniffed = |line: &str| {
            let words: Vec<OsString> = line.split_whitespace().map(OsString::from).collect();
            let StreamArguments { message_format, colours } = StreamArguments::sniffed(&words);
            (message_format, colours)
        };
        use {Colours::*, MessageFormat::*};
        assert_eq!(sniffed("lancer rendr --message-format json"), (Json, Auto));
        assert_eq!(sniffed("lancer --message-format=json x --color=never"), (Json, Never));
        assert_eq!(sniffed("lancer --color always --color never"), (Human, Never));
        assert_eq!(sniffed("lancer x -- --message-format json"), (Human, Auto));
        assert_eq!(sniffed("lancer --message-format xml --color"), (Human, Auto));
    }

    #[test]
    fn long_lines_are_folded_at_blanks() {
        assert_eq!(folded("one two three\nfour\n", 9), "one two\n    three\nfour\n");
        assert_eq!(folded("  one two three four five", 11), "  one two\n     three\n     four\n     five");
        assert_eq!(folded("longer-than-that x", 8), "longer-than-that\n    x");
        assert_eq!(folded("longer-than-that", 8), "longer-than-that");
        assert_eq!(folded("é é é é é", 5), "é é é\n  é é");
        assert_eq!(folded("", 8), "");
    }

    #[test]
    fn what_is_left_is_told_when_it_is_known() {
        let left = |seconds: u64, done, length| left(Duration::from_secs(seconds), done, length);
        assert_eq!(left(0, 50, 100), None);
        assert_eq!(left(2, 1, 100), None);
        assert_eq!(left(5, 0, 0), None);
        assert_eq!(left(10, 25, 100).as_deref(), Some("30 s"));
        assert_eq!(left(100, 50, 100).as_deref(), Some("1:40 min"));
        assert_eq!(left(7200, 50, 100).as_deref(), Some("2:00 h"));
        assert_eq!(left(9, 120, 100).as_deref(), Some("0 s"));
    }
}
