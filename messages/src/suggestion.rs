//! Hints for names that are nearly a known one.

/// The name of `known` nearest to `name`, when near enough to be what was meant.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // One slip in three letters.
    let allowed = (name.chars().count() / 3).max(1);
    known
        .into_iter()
        .map(|word| (strsim::damerau_levenshtein(&name.to_lowercase(), &word.to_lowercase()), word))
        .filter(|&(distance, _)| distance <= allowed)
        .min_by_key(|&(distance, word)| (distance, word.len(), word))
        .map(|(_, word)| word)
}

/// The hint "did you mean ...?" with the name of `known` that is [`nearest`] to `name`, when one is near enough.
pub fn did_you_mean<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    nearest(name, known).map(question)
}

/// The hint "did you mean ...?" with a word that was found otherwise.
pub fn question(word: &str) -> String {
    format!("did you mean `{word}`?")
}
