//! Changes to inputs: of octets, of words and lines of text, of numbers, and crossings of two inputs. All of them follow from the random numbers.

use random::SplitMix64;

use crate::surface::InputForm;

/// Numbers at which ranges and loops end.
const NUMBERS: [i64; 28] = [
    0,
    1,
    -1,
    2,
    3,
    4,
    7,
    8,
    15,
    16,
    31,
    32,
    63,
    64,
    100,
    127,
    128,
    255,
    256,
    32_767,
    65_535,
    65_536,
    1 << 20,
    i32::MAX as i64,
    i32::MIN as i64,
    u32::MAX as i64,
    i64::MAX,
    i64::MIN,
];

/// Numbers of texts that are more than integers.
const NUMBER_TEXTS: [&str; 12] =
    ["nan", "inf", "-inf", "1e400", "-0", "0.1", "1e-320", "99999999999999999999", "0x7fffffff", "1.", ".5", "1e"];

/// A maker of inputs.
pub struct Mutator {
    /// Form of the inputs.
    pub form: InputForm,
    /// Most octets of an input.
    pub longest: usize,
    /// Words that inputs of the kind have.
    pub words: Vec<Vec<u8>>,
}

/// A place below `end`, 0 where there is none.
fn place(random: &mut SplitMix64, end: usize) -> usize {
    if end == 0 { 0 } else { random.below(end as u64) as usize }
}

fn choice<'a, T>(random: &mut SplitMix64, list: &'a [T]) -> &'a T {
    &list[place(random, list.len())]
}

/// The word around a place: a run of letters, digits and what numbers and names are written with, or one octet.
fn word(input: &[u8], at: usize) -> std::ops::Range<usize> {
    let is_word = |octet: &u8| octet.is_ascii_alphanumeric() || b"._-+".contains(octet);
    let start = input[..at].iter().rposition(|octet| !is_word(octet)).map_or(0, |before| before + 1);
    let end = input[at..].iter().position(|octet| !is_word(octet)).map_or(input.len(), |length| at + length);
    if start < end { start..end } else { at..(at + 1).min(input.len()) }
}

/// Place of the first digit from a place on, or else of the first of all; the place itself where there is none.
fn number(input: &[u8], at: usize) -> usize {
    let digit = |part: &[u8]| part.iter().position(u8::is_ascii_digit);
    digit(&input[at..]).map(|behind| at + behind).or_else(|| digit(input)).unwrap_or(at)
}

/// The line around a place, with its end.
fn line(input: &[u8], at: usize) -> std::ops::Range<usize> {
    let start = input[..at].iter().rposition(|octet| *octet == b'\n').map_or(0, |before| before + 1);
    let end = input[at..].iter().position(|octet| *octet == b'\n').map_or(input.len(), |length| at + length + 1);
    start..end
}

impl Mutator {
    /// A new input from those that are kept.
    pub fn next(&self, random: &mut SplitMix64, kept: &[Vec<u8>]) -> Vec<u8> {
        if self.form == InputForm::Number || kept.is_empty() {
            return random.bits().to_le_bytes().to_vec();
        }
        // What was found last is tried more often.
        let recent = kept.len().div_ceil(4);
        let parent = match random.below(2) {
            0 => choice(random, kept),
            _ => choice(random, &kept[kept.len() - recent..]),
        };
        let mut input = parent.clone();
        let other = choice(random, kept);
        for _ in 0..=random.below(6) {
            let is_text = match self.form {
                InputForm::Text => random.below(5) > 0,
                _ => random.below(4) == 0,
            };
            match is_text {
                true => self.change_text(random, &mut input, other),
                false => change_octets(random, &mut input, other),
            }
        }
        input.truncate(self.longest);
        input
    }

    fn change_text(&self, random: &mut SplitMix64, input: &mut Vec<u8>, other: &[u8]) {
        let at = place(random, input.len());
        match random.below(10) {
            // A word in the place of another, from the list or from another input.
            0 | 1 if !self.words.is_empty() => {
                let new = choice(random, &self.words).clone();
                input.splice(word(input, at), new);
            }
            2 if !other.is_empty() => {
                let new = other[word(other, place(random, other.len()))].to_vec();
                input.splice(word(input, at), new);
            }
            3 if !self.words.is_empty() => {
                let mut new = choice(random, &self.words).clone();
                new.push(b' ');
                input.splice(at..at, new);
            }
            4 => {
                let text = match random.below(4) {
                    0 => (*choice(random, &NUMBER_TEXTS)).to_owned(),
                    1 => (random.bits() >> (24 + random.below(40))).to_string(),
                    _ => choice(random, &NUMBERS).to_string(),
                };
                // Mostly in the place of a number: those are few among the words of a file.
                let at = if random.below(4) > 0 { number(input, at) } else { at };
                input.splice(word(input, at), text.into_bytes());
            }
            // Lines: one less, one twice, one from elsewhere, two in the other order.
            5 => drop(input.drain(line(input, at))),
            6 => {
                let copy = input[line(input, at)].to_vec();
                for _ in 0..=random.below(3) {
                    input.splice(at_line(input, at)..at_line(input, at), copy.clone());
                }
            }
            7 if !other.is_empty() => {
                let copy = other[line(other, place(random, other.len()))].to_vec();
                let to = at_line(input, at);
                input.splice(to..to, copy);
            }
            8 => {
                let moved: Vec<u8> = input.drain(line(input, at)).collect();
                let to = at_line(input, place(random, input.len()));
                input.splice(to..to, moved);
            }
            _ => drop(input.drain(word(input, at))),
        }
    }
}

/// The start of the line around a place.
fn at_line(input: &[u8], at: usize) -> usize {
    line(input, at.min(input.len())).start
}

fn change_octets(random: &mut SplitMix64, input: &mut Vec<u8>, other: &[u8]) {
    let at = place(random, input.len());
    let most = 1 << random.below(8);
    let length = 1 + place(random, (input.len() - at).min(most));
    match random.below(10) {
        _ if input.is_empty() => input.push(random.bits() as u8),
        0 => input[at] ^= 1 << random.below(8),
        1 => input[at] = random.bits() as u8,
        2 => drop(input.drain(at..(at + length).min(input.len()))),
        3 => {
            let new: Vec<u8> = (0..length).map(|_| random.bits() as u8).collect();
            input.splice(at..at, new);
        }
        4 => {
            let copy = input[at..(at + length).min(input.len())].to_vec();
            let to = place(random, input.len());
            input.splice(to..to, copy);
        }
        // A number of one to eight octets.
        5 | 6 => {
            let width = 1 << random.below(4);
            let number = choice(random, &NUMBERS).wrapping_add(random.below(3) as i64 - 1).to_le_bytes();
            let end = (at + width).min(input.len());
            input[at..end].copy_from_slice(&number[..end - at]);
        }
        7 => input[at] = input[at].wrapping_add(random.below(5) as u8).wrapping_sub(2),
        8 => input.truncate(at),
        _ => {
            let from = place(random, other.len());
            input.truncate(at);
            input.extend_from_slice(&other[from..]);
        }
    }
}

/// Words of inputs, each once, in the order of their octets; the rarest are left out where there are very many.
pub fn words(inputs: &[Vec<u8>]) -> Vec<Vec<u8>> {
    let mut counts = std::collections::BTreeMap::<&[u8], usize>::new();
    for input in inputs {
        let mut at = 0;
        while at < input.len() {
            let found = word(input, at);
            if found.len() <= 40 && !input[found.clone()].iter().all(u8::is_ascii_whitespace) {
                *counts.entry(&input[found.clone()]).or_default() += 1;
            }
            at = found.end.max(at + 1);
        }
    }
    let mut words: Vec<(&[u8], usize)> = counts.into_iter().collect();
    words.sort_by_key(|(word, count)| (std::cmp::Reverse(*count), *word));
    words.iter().take(3_000).map(|(word, _)| word.to_vec()).collect()
}
