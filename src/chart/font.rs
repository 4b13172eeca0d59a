//! Widths of the letters that charts are set in, so that names can be placed before anybody draws them: those of Helvetica, which every reader
//! of PDF has and which the usual sans-serif fonts of screens do not exceed by much.

/// Widths in thousandths of the size, from the blank on to the tilde (Adobe's metrics of Helvetica).
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556, 556,
    556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833,
    722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556,
    556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334,
    260, 334, 584,
];

/// Heavy letters are about this much wider.
const BOLD: f64 = 1.07;

/// Width of words in points.
pub fn width(words: &str, size: f64, is_bold: bool) -> f64 {
    let letter = |c: char| (c as usize).checked_sub(32).and_then(|at| WIDTHS.get(at)).copied().unwrap_or(667);
    let sum: u64 = words.chars().map(|c| u64::from(letter(c))).sum();
    sum as f64 / 1000.0 * size * if is_bold { BOLD } else { 1.0 }
}

/// Words in lines that are at most `most` points wide, where no single word is wider.
pub fn wrapped(words: &str, size: f64, is_bold: bool, most: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(&format!("{line} {word}"), size, is_bold) <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_as_wide_as_their_letters() {
        // A 667, i 222, blank 278: 1.167 times the size.
        assert!((width("Ai ", 10.0, false) - 11.67).abs() < 1e-9);
        assert_eq!(wrapped("aa aa aa", 10.0, false, 26.0), ["aa aa", "aa"]);
        assert!(wrapped("", 10.0, false, 26.0).is_empty());
    }
}
