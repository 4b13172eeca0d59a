//! Outcome of one run as the harness sees it: marks that tell inputs apart which lead to different places, and planted faults.

use std::cell::RefCell;
use std::collections::HashSet;

use messages::{Diagnostic, Report};

/// A fault that the harness must find where it was planted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlantedFault {
    /// A panic.
    Panic,
    /// A loop without end.
    Endless,
    /// An allocation of a gibibyte.
    Large,
    /// The end of the process without a word.
    Abort,
}

/// Marks of an input, and the number of runs that it was.
#[derive(Debug, Default)]
pub struct Seen {
    marks: Vec<u64>,
    has_planted: bool,
    runs: u64,
    input: Vec<u8>,
}

/// Words of a message that tell it from others, on each side of what is quoted.
const MARKED_WORDS: usize = 8;

impl Seen {
    /// An empty list for an input; with `has_planted` planted faults happen.
    pub fn new(input: &[u8], has_planted: bool) -> Seen {
        Seen { has_planted, input: input.to_vec(), ..Seen::default() }
    }

    /// True where planted faults happen.
    pub fn has_planted(&self) -> bool {
        self.has_planted
    }

    /// The marks so far.
    pub fn marks(&self) -> &[u64] {
        &self.marks
    }

    /// Number of runs: one, unless the surface has made several of the input.
    pub fn runs(&self) -> u64 {
        self.runs.max(1)
    }

    /// Counts a run, where a surface makes several of an input.
    pub fn run(&mut self) {
        self.runs += 1;
    }

    /// Marks a number of something by its order of magnitude.
    pub fn count(&mut self, what: &str, number: usize) {
        self.marks.push(hash(what.bytes().chain([number.min(3) as u8, (usize::BITS - number.leading_zeros()) as u8])));
    }

    /// Marks a name of ours, or a text that has no part of the input and no number.
    pub fn name(&mut self, name: &str) {
        self.marks.push(hash(name.bytes()));
    }

    /// Marks a text by its first words in front of and behind all that is quoted in it, without those that only the input can have brought there.
    pub fn text(&mut self, text: &str) {
        let is_mark = |letter: char| "`\"'".contains(letter);
        let (before, rest) = text.split_once(is_mark).unwrap_or((text, ""));
        let behind = rest.rsplit(is_mark).next().unwrap_or_default();
        let mut mark = Vec::new();
        for side in [before, behind] {
            // Numbers are of the input in one way or another.
            let is_word = |part: &&str| !part.is_empty() && part.bytes().all(|octet| octet.is_ascii_alphabetic());
            let words = side.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(is_word);
            words.filter(|word| is_ours(word, &self.input)).take(MARKED_WORDS).for_each(|word| {
                mark.extend_from_slice(word.as_bytes());
                mark.push(b' ');
            });
            mark.push(b'|');
        }
        self.marks.push(hash(mark));
    }

    /// Marks all messages of a report, and shows it as a person would see it for one input in sixteen.
    pub fn report(&mut self, report: &Report, input: &[u8]) {
        for Diagnostic { message, code, place, hint, .. } in report.0.iter().take(40) {
            self.text(message);
            self.name(code.unwrap_or_default());
            if let Some((_, label)) = place {
                self.text(label);
            }
            self.text(hint.as_deref().unwrap_or_default());
        }
        if is_sample(input, 16) {
            let shown = report.render(input.len() % 2 == 0);
            assert!(shown.is_empty() == report.0.is_empty(), "messages show something");
        }
    }

    /// A fault where a condition holds on which no seed comes.
    pub fn plant(&self, fault: PlantedFault, condition: bool) {
        if !self.has_planted || !condition {
            return;
        }
        match fault {
            PlantedFault::Panic => panic!("the planted fault"),
            PlantedFault::Endless => loop {
                std::hint::spin_loop();
            },
            PlantedFault::Large => {
                std::hint::black_box(vec![1u8; 1 << 30]);
            }
            PlantedFault::Abort => std::process::abort(),
        }
    }
}

thread_local! {
    /// Words of messages about inputs that do not have them: those that readers use themselves.
    static OURS: RefCell<HashSet<String>> = RefCell::default();
}

/// Most words that readers use themselves.
const MOST_WORDS: usize = 20_000;

/// False for a word that so far was only met in messages about inputs that have it, or of which they have more: it may be cut short.
fn is_ours(word: &str, input: &[u8]) -> bool {
    OURS.with_borrow_mut(|ours| {
        if ours.contains(word) {
            return true;
        }
        let is_new = !String::from_utf8_lossy(input).contains(word) && ours.len() < MOST_WORDS;
        if is_new {
            ours.insert(word.to_owned());
        }
        is_new
    })
}

/// One input in `many`, by its octets alone.
pub fn is_sample(input: &[u8], many: u64) -> bool {
    hash(input.iter().copied()) % many == 0
}

/// A number of octets that differs where they do, for all that matters here (FNV-1a with a last mix).
pub fn hash(octets: impl IntoIterator<Item = u8>) -> u64 {
    let sum = octets
        .into_iter()
        .fold(0xcbf2_9ce4_8422_2325u64, |sum, octet| (sum ^ u64::from(octet)).wrapping_mul(0x0000_0100_0000_01b3));
    (sum ^ (sum >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 1
}
