//! Walking along the tokens of a line.

use crate::explain;
use crate::line::OriginLine;
use crate::message::{At, Parsed, Problem};
use crate::token::{Token, TokenKind};

/// A position in the tokens of a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cursor<'t> {
    pub line: &'t OriginLine,
    pub tokens: &'t [Token],
    pub position: usize,
}

impl<'t> Cursor<'t> {
    /// The token here.
    pub fn peek(&self) -> Option<Token> {
        self.tokens.get(self.position).copied()
    }

    /// The token after that.
    pub fn peek_second(&self) -> Option<Token> {
        self.tokens.get(self.position + 1).copied()
    }

    /// The kind of the token here.
    pub fn kind(&self) -> Option<TokenKind> {
        self.peek().map(|token| token.kind)
    }

    /// The token here is the punctuation `mark`.
    pub fn is_mark(&self, mark: &str) -> bool {
        matches!(self.kind(), Some(TokenKind::Mark(here)) if here == mark)
    }

    /// Goes on to the next token.
    pub fn skip(&mut self) {
        self.position += 1;
    }

    /// Takes this punctuation if it is here.
    pub fn accept(&mut self, mark: &str) -> bool {
        let is_here = self.is_mark(mark);
        self.position += usize::from(is_here);
        is_here
    }

    /// All tokens were taken.
    pub fn is_at_end(&self) -> bool {
        self.position >= self.tokens.len()
    }

    /// The text of a token.
    pub fn text(&self, token: Token) -> &'t str {
        &self.line.text[token.start as usize..token.end as usize]
    }

    /// The place of a token.
    pub fn at(&self, token: Token) -> At {
        self.line.at(token.start as usize, token.end as usize)
    }

    /// The place of the token here, or behind the last one.
    pub fn here(&self) -> At {
        match (self.peek(), self.tokens.last()) {
            (Some(token), _) => self.at(token),
            (None, Some(&last)) => self.at(last).behind(),
            (None, None) => self.line.at(0, 0),
        }
    }

    /// The place from token number `first` to the last one taken.
    pub fn since(&self, first: usize) -> At {
        let last = self.position.max(first + 1).min(self.tokens.len());
        match (self.tokens.get(first), self.tokens.get(last.wrapping_sub(1))) {
            (Some(&from), Some(&to)) => self.line.at(from.start as usize, to.end.max(from.end) as usize),
            _ => self.here(),
        }
    }

    /// Something else was expected here.
    pub fn expected(&self, what: &str) -> Box<Problem> {
        match self.peek() {
            Some(token) => {
                let found = self.text(token);
                Problem::new(explain::SYNTAX, format!("expected {what}, found `{found}`"), self.at(token), "unexpected")
            }
            None => {
                let problem =
                    Problem::new(explain::SYNTAX, format!("expected {what}"), self.here(), "the line ends here");
                let last = self.tokens.last().map_or(0, |token| token.end as usize);
                if self.line.text[last..].trim_start().starts_with('#') {
                    problem.hint("`#` starts a comment; numbers are written without it")
                } else {
                    problem
                }
            }
        }
    }

    /// Takes this punctuation.
    pub fn expect(&mut self, mark: &str) -> Parsed<()> {
        if self.accept(mark) { Ok(()) } else { Err(self.expected(&format!("`{mark}`"))) }
    }

    /// Takes a name.
    pub fn name(&mut self, what: &str) -> Parsed<(&'t str, At)> {
        match self.peek() {
            Some(token) if token.kind == TokenKind::Name => {
                self.skip();
                Ok((self.text(token), self.at(token)))
            }
            _ => Err(self.expected(what)),
        }
    }

    /// Nothing more may follow.
    pub fn end(&self) -> Parsed<()> {
        if self.is_at_end() { Ok(()) } else { Err(self.expected("the end of the line")) }
    }
}
