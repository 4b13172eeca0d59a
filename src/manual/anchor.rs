//! Anchors of headings, as GitHub makes them of Markdown, so that one link is right there and in the HTML page.

use std::collections::BTreeMap;

/// Anchors of the headings of a page, in their order: each is given once.
#[derive(Debug, Default)]
pub struct Anchors {
    given: BTreeMap<String, usize>,
}

impl Anchors {
    /// Anchor of the next heading: small letters, `-` for blanks, nothing else but digits and `_`; further ones of the same text are numbered.
    pub fn next(&mut self, heading: &str) -> String {
        let plain = plain(heading);
        let number = self.given.entry(plain.clone()).or_default();
        *number += 1;
        if *number == 1 { plain } else { format!("{plain}-{}", *number - 1) }
    }
}

/// Anchor of a heading whose text no other has.
pub fn plain(heading: &str) -> String {
    let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect::<String>().to_lowercase()
}

/// Headings of a Markdown page outside of its examples, with their levels from 1.
pub fn headings(markdown: &str) -> Vec<(usize, &str)> {
    let mut is_code = false;
    let mut found = Vec::new();
    for line in markdown.lines() {
        is_code ^= line.starts_with("```");
        let level = line.bytes().take_while(|octet| *octet == b'#').count();
        if !is_code && (1..=6).contains(&level) && line[level..].starts_with(' ') {
            found.push((level, line[level..].trim()));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn anchors_are_those_of_the_page_that_shows_markdown() {
        let mut anchors = Anchors::default();
        let all = ["How to read an instruction", "`vdot`", "A, b & c", "vdot"].map(|text| anchors.next(text));
        assert_eq!(all, ["how-to-read-an-instruction", "vdot", "a-b--c", "vdot-1"]);
        assert_eq!(headings("# A\n```\n# no\n```\n    # code\n### B\n#no\n"), [(1, "A"), (3, "B")]);
    }
}
