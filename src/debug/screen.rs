//! The full-screen view: source, instructions, calls and registers around the core, with a line for commands below. It is the third door to a
//! session; keys are short for commands, and all else is typed. Only builds with the feature `full` have it.

use std::collections::BTreeMap;
use std::io;

use isa::naming::RegisterId;
use ratatui::crossterm::event::{self, Event as TerminalEvent, KeyCode, KeyEventKind, KeyModifiers};
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Clear, Paragraph};
use ratatui::{DefaultTerminal, Frame};

use super::disassembly;
use super::door::{Answer, Door};
use crate::registers::{RegisterContents, ShownRegister, all};

/// Columns from which on instructions and calls have a place beside the source.
const WIDE: u16 = 110;

/// Lines of the last answer on a screen of 24 rows; larger ones have as many as a quarter of theirs.
const ANSWER: u16 = 5;

/// Keys and the commands that they stand for.
const KEYS: [(KeyCode, &str); 8] = [
    (KeyCode::Right, "instruction"),
    (KeyCode::Left, "back"),
    (KeyCode::Down, "next"),
    (KeyCode::Up, "back-next"),
    (KeyCode::PageDown, "continue"),
    (KeyCode::PageUp, "continue-back"),
    (KeyCode::Home, "goto 0"),
    (KeyCode::F(1), "help"),
];

/// The last line of the screen.
const HINT: &str = "←→ instruction  ↑↓ line  PgUp/PgDn breakpoint  F1 help  Tab again  Ctrl-C quit";

/// Screen of a session.
pub struct DebugScreen<'d, 'a> {
    door: &'d mut Door<'a>,
    /// Command that is being typed.
    input: String,
    /// The last command, which Tab repeats.
    last: String,
    /// Answer to it.
    answer: Vec<String>,
    /// Lines of the answer that are scrolled away.
    scrolled: usize,
    /// Registers before the last command.
    before: BTreeMap<RegisterId, RegisterContents>,
    ends: bool,
}

impl<'d, 'a> DebugScreen<'d, 'a> {
    /// A screen of a session, not drawn yet.
    pub fn new(door: &'d mut Door<'a>) -> DebugScreen<'d, 'a> {
        let answer = vec!["type a command, or help for all of them".to_owned()];
        let (input, last) = (String::new(), String::new());
        let mut screen = DebugScreen { door, input, last, answer, scrolled: 0, before: BTreeMap::new(), ends: false };
        screen.before = screen.registers();
        screen
    }

    /// Shows the session on the terminal until it is over; the terminal is then as it was.
    ///
    /// # Errors
    /// A terminal that cannot be drawn on, or read.
    pub fn run(&mut self) -> io::Result<()> {
        let mut terminal = ratatui::try_init()?;
        let shown = self.serve(&mut terminal);
        ratatui::try_restore()?;
        shown
    }

    fn serve(&mut self, terminal: &mut DefaultTerminal) -> io::Result<()> {
        while !self.ends {
            terminal.draw(|frame| self.draw(frame))?;
            if let TerminalEvent::Key(key) = event::read()?
                && key.kind != KeyEventKind::Release
            {
                self.key(key.code, key.modifiers);
            }
        }
        Ok(())
    }

    /// Takes a key.
    pub fn key(&mut self, code: KeyCode, modifiers: KeyModifiers) {
        let is_control = modifiers.contains(KeyModifiers::CONTROL);
        match code {
            KeyCode::Char('c' | 'd') if is_control => self.ends = true,
            KeyCode::Char('u') if is_control => self.input.clear(),
            // Longer answers are scrolled with the keys that move the core without Control.
            KeyCode::Down if is_control => self.scrolled = (self.scrolled + 1).min(self.answer.len().saturating_sub(1)),
            KeyCode::Up if is_control => self.scrolled = self.scrolled.saturating_sub(1),
            KeyCode::Char(letter) => self.input.push(letter),
            KeyCode::Backspace => drop(self.input.pop()),
            KeyCode::Esc => self.input.clear(),
            KeyCode::Enter if !self.input.trim().is_empty() => {
                let command = std::mem::take(&mut self.input);
                self.execute(command.trim());
            }
            KeyCode::Tab if !self.last.is_empty() => {
                let command = self.last.clone();
                self.execute(&command);
            }
            _ => {
                if let Some((_, command)) = KEYS.iter().find(|(key, _)| *key == code) {
                    self.execute(command);
                }
            }
        }
    }

    /// Carries out a command as if it had been typed.
    pub fn execute(&mut self, command: &str) {
        self.before = self.registers();
        let text = match self.door.execute(command) {
            Ok(Answer { text, ends }) => {
                self.ends |= ends;
                text
            }
            Err(message) => message,
        };
        self.answer = std::iter::once(format!("> {command}")).chain(text.lines().map(str::to_owned)).collect();
        self.last = command.to_owned();
        self.scrolled = 0;
    }

    fn registers(&self) -> BTreeMap<RegisterId, RegisterContents> {
        all(&self.door.session.stepper().state().registers).collect()
    }

    /// Draws the screen.
    pub fn draw(&self, frame: &mut Frame) {
        let area = frame.area();
        // Divide the screen from top to bottom: title, views, answer, input, keys
        let rows = ANSWER.max(area.height / 4);
        let parts = Layout::vertical([
            Constraint::Length(1),
            Constraint::Min(3),
            Constraint::Length(rows),
            Constraint::Length(1),
            Constraint::Length(1),
        ]);
        let [title, middle, answer, input, hint] = parts.areas(area);
        frame.render_widget(Clear, area);
        frame.render_widget(Line::from(self.title()).style(Style::new().add_modifier(Modifier::REVERSED)), title);
        // A narrow screen has room for source and registers alone.
        if area.width >= WIDE {
            let [source, code, registers] =
                Layout::horizontal([Constraint::Fill(4), Constraint::Fill(4), Constraint::Fill(4)]).areas(middle);
            let [code, calls] = Layout::vertical([Constraint::Fill(2), Constraint::Fill(1)]).areas(code);
            self.source(frame, source);
            self.code(frame, code);
            self.calls(frame, calls);
            self.register_table(frame, registers);
        } else {
            let [source, registers] =
                Layout::horizontal([Constraint::Percentage(52), Constraint::Percentage(48)]).areas(middle);
            self.source(frame, source);
            self.register_table(frame, registers);
        }
        self.answer(frame, answer);
        frame.render_widget(Line::from(format!("> {}", self.input)), input);
        frame.render_widget(Line::from(HINT).style(Style::new().add_modifier(Modifier::DIM)), hint);
        // Put the cursor behind `> ` and what is typed, at most at the right edge
        let column = 2 + self.input.chars().count() as u16;
        frame.set_cursor_position((input.x + column.min(input.width.saturating_sub(1)), input.y));
    }

    /// Line with the name of the program and the place of the core.
    fn title(&self) -> String {
        let session = &self.door.session;
        let place = self.door.place();
        format!(" {}: {}", session.target.name, place.lines().next().unwrap_or_default())
    }

    fn source(&self, frame: &mut Frame, area: Rect) {
        let session = &self.door.session;
        let program = &session.target.program;
        let line = program.lines.get(session.pc() as usize);
        let source = line.and_then(|line| program.sources.get(usize::from(line.source)));
        let title = source.map_or("source", |source| source.name.as_str());
        let block = Block::bordered().title(title.to_owned());
        let inner = block.inner(area);
        let here = line.map_or(0, |line| line.line as usize);
        // The line stands in the middle, as far as the file reaches.
        let first = here.saturating_sub(usize::from(inner.height) / 2 + 1);
        let lines = source.into_iter().flat_map(|source| (1..).zip(source.text.lines()).skip(first));
        let shown = lines
            .take(usize::from(inner.height))
            .map(|(number, text)| marked(format!("{number:>4} {}", text.replace('\t', "    ")), number == here));
        frame.render_widget(Paragraph::new(shown.collect::<Vec<Line>>()).block(block), area);
    }

    fn code(&self, frame: &mut Frame, area: Rect) {
        let session = &self.door.session;
        let block = Block::bordered().title("instructions");
        let height = u32::from(block.inner(area).height);
        let from = session.pc().saturating_sub(height / 3);
        let text = disassembly::text(session, from, height);
        let lines = text.lines().take(height as usize).map(|line| marked(line.to_owned(), line.starts_with('>')));
        frame.render_widget(Paragraph::new(lines.collect::<Vec<Line>>()).block(block), area);
    }

    fn calls(&self, frame: &mut Frame, area: Rect) {
        let stepper = self.door.session.stepper();
        let program = &self.door.session.target.program;
        let name = |pc: u32| program.function(pc).unwrap_or("(no function)").to_owned();
        // The innermost first.
        let calls = stepper
            .calls()
            .iter()
            .rev()
            .map(|call| format!("{} from {}", name(call.to), program.place(call.from).unwrap_or_default()));
        let lines: Vec<Line> = calls.map(Line::from).collect();
        frame.render_widget(Paragraph::new(lines).block(Block::bordered().title("calls")), area);
    }

    /// Registers that are not zero, those that the last command changed first, as real numbers where their format is known.
    fn register_table(&self, frame: &mut Frame, area: Rect) {
        let session = &self.door.session;
        let (state, program) = (session.stepper().state(), &session.target.program);
        let shown = |(register, contents): (RegisterId, RegisterContents)| {
            let is_changed = self.before.get(&register) != Some(&contents);
            let shown = ShownRegister::at(program, &state.registers, register, session.pc());
            let value = match shown.real_text() {
                real if real.is_empty() => contents.raw_text(),
                real => real,
            };
            let name = shown.name.unwrap_or_default();
            let text = format!("{:<3} {name:<15} {value}", shown.register);
            (is_changed || !contents.is_zero()).then(|| (is_changed, marked(text, is_changed)))
        };
        let (changed, rest): (Vec<_>, Vec<_>) =
            all(&state.registers).filter_map(shown).partition(|(is_changed, _)| *is_changed);
        let lines: Vec<Line> = changed.into_iter().chain(rest).map(|(_, line)| line).collect();
        frame.render_widget(Paragraph::new(lines).block(Block::bordered().title("registers")), area);
    }

    fn answer(&self, frame: &mut Frame, area: Rect) {
        let block = Block::bordered();
        let height = usize::from(block.inner(area).height);
        let more = self.answer.len().saturating_sub(self.scrolled + height);
        let title = if more > 0 { format!("{more} more lines: Ctrl-Down") } else { String::new() };
        let lines = self.answer.iter().skip(self.scrolled).take(height).map(|line| Line::from(line.as_str()));
        frame.render_widget(Paragraph::new(lines.collect::<Vec<Line>>()).block(block.title_bottom(title)), area);
    }
}

/// A line, or the one that is looked at.
fn marked(text: String, is_here: bool) -> Line<'static> {
    let style = if is_here { Style::new().add_modifier(Modifier::BOLD | Modifier::REVERSED) } else { Style::new() };
    Line::from(Span::styled(text, style))
}

#[cfg(test)]
mod tests {
    use emu::machine::Config;
    use isa::Isa;
    use messages::Source;
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;

    use super::*;
    use crate::debug::{DebugTarget, Session};

    const PROGRAM: &str = "\
    .format pos, 4
    .reg  left, s1
    .holds left, pos
    movi  left, 9
    call  s31, halve
    halt
    .func halve
    rshift left, left, 1
    ret   s31
    .endfunc
";

    /// The screen of a size as lines of text.
    fn lines(screen: &DebugScreen, width: u16, height: u16) -> Vec<String> {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| screen.draw(frame)).unwrap();
        let buffer = terminal.backend().buffer();
        let line = |y: u16| (0..width).map(|x| buffer[(x, y)].symbol()).collect::<String>();
        (0..height).map(line).collect()
    }

    #[test]
    fn keys_and_commands_move_and_the_screen_follows() {
        let assembled = asm::assemble(&Source::new("p.s", PROGRAM), &Isa::base(), &asm::Options::default()).unwrap();
        let target = DebugTarget::program("p.s".into(), Config::default(), Isa::base(), assembled.program);
        let mut door = Door::new(Session::new(&target).unwrap());
        let mut screen = DebugScreen::new(&mut door);
        let none = KeyModifiers::NONE;
        let typed = |screen: &mut DebugScreen, text: &str| {
            text.chars().for_each(|letter| screen.key(KeyCode::Char(letter), none));
            screen.key(KeyCode::Enter, none);
        };
        // Each key, the step after it, and a text that the screen then has.
        screen.key(KeyCode::Right, none);
        assert!(
            lines(&screen, 80, 24).join("\n").contains("s1  left            0.56:pos"),
            "{:#?}",
            lines(&screen, 80, 24)
        );
        for (code, step, text) in [
            (KeyCode::Right, 2, "rshift left, left, 1"),
            (KeyCode::Right, 3, "0.3:pos"),
            (KeyCode::Left, 2, "0.56:pos"),
            (KeyCode::Home, 0, "step 0, clock 0:"),
            (KeyCode::PageDown, 5, "the program halted"),
            (KeyCode::PageUp, 0, "the program's start"),
            (KeyCode::Down, 1, "call  s31, halve"),
            (KeyCode::Tab, 4, "step 4, clock"),
        ] {
            screen.key(code, none);
            assert_eq!(screen.door.session.position(), step, "{code:?}");
            for (width, height) in [(80, 24), (132, 43), (200, 60)] {
                let shown = lines(&screen, width, height);
                assert!(shown.join("\n").contains(text), "{code:?} {width} x {height}: {shown:#?}");
            }
        }
        typed(&mut screen, "goto 3");
        let wide = lines(&screen, 132, 43).join("\n");
        assert!(wide.contains("halve from p.s:5") && wide.contains("> 000004"), "{wide}");
        typed(&mut screen, "brek halve");
        assert!(lines(&screen, 80, 24).join("\n").contains("did you mean `break`?"));
        assert_eq!((screen.door.session.position(), screen.ends), (3, false));
        typed(&mut screen, "quit");
        assert!(screen.ends);
        // A screen of a few cells is drawn as far as it goes.
        assert_eq!(lines(&screen, 3, 2).len(), 2);
    }
}
