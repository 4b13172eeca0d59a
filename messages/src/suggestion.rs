//! Hints for names that are nearly a known one.

/// The name of `known` nearest to `name`, when near enough to be what was meant.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // One slip in three letters.
    let allowed = (name.chars().count() / 3).max(1);
    let name = name.to_lowercase();
    let letters_of_name = letters(&name);
    // Most of thousands of names are too far away, which is seen without counting slips: each of them brings or takes one letter at most.
    let is_far = |word: &&str| {
        let letters_of_word = letters(word);
        let missing = [letters_of_name & !letters_of_word, letters_of_word & !letters_of_name].map(u64::count_ones);
        let apart = word.len().abs_diff(name.len()).max(missing[0].max(missing[1]) as usize);
        word.is_ascii() && name.is_ascii() && apart > allowed
    };
    known
        .into_iter()
        .filter(|word| !is_far(word))
        .map(|word| (strsim::damerau_levenshtein(&name, &word.to_lowercase()), word))
        .filter(|&(distance, _)| distance <= allowed)
        .min_by_key(|&(distance, word)| (distance, word.len(), word))
        .map(|(_, word)| word)
}

/// Letters of an ASCII text without regard to case, as a set in which some share a place.
fn letters(text: &str) -> u64 {
    text.bytes().fold(0, |set, octet| set | 1 << (octet.to_ascii_lowercase() % 64))
}

/// The hint "did you mean ...?" with the name of `known` that is [`nearest`] to `name`, when one is near enough.
pub fn did_you_mean<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    nearest(name, known).map(question)
}

/// The hint "did you mean ...?" with a word that was found otherwise.
pub fn question(word: &str) -> String {
    format!("did you mean `{word}`?")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_the_same_as_when_all_slips_are_counted() {
        // Letters beyond ASCII, in either case, the same ones in another order, and none at all
        let known = [
            "vdot",
            "vadd",
            "VSUB",
            "s1",
            "trace",
            "café",
            "cafe",
            "İx",
            "",
            "abcdefghij",
            "jihgfedcba",
            "a.b-c_d",
            "aaaa",
            "k",
        ];
        let names = [
            "vdto",
            "VADD",
            "ab",
            "cafés",
            "caf\u{e9}s",
            "ix",
            "abdcefgihj",
            "traec",
            "tra",
            "a.b-c_",
            "aaa",
            "é",
            "x",
            "",
            // The Kelvin sign, whose small letter is `k`
            "\u{212a}",
        ];
        for name in names {
            // Count the slips to every name, whereas `nearest` leaves out those that are surely too far away
            let allowed = (name.chars().count() / 3).max(1);
            let slips = |word: &str| strsim::damerau_levenshtein(&name.to_lowercase(), &word.to_lowercase());
            let found = known.iter().copied().filter(|word| slips(word) <= allowed);
            assert_eq!(nearest(name, known), found.min_by_key(|word| (slips(word), word.len(), *word)), "{name}");
        }
    }
}
