//! Fraction bits that a user sets, such as `dir=24`.

use scenes::cadrage::Overrides;

/// Lets a setting pass that [`Overrides::set`] takes.
///
/// # Errors
/// What it says about any other.
pub fn check(text: &str) -> Result<String, String> {
    let tried = Overrides::default().set(text);
    tried.map(|()| text.to_owned()).map_err(|report| super::kernel::plain(&report.0[0]))
}

/// Settings that have passed.
pub fn collect(settings: &[String]) -> Overrides {
    let mut overrides = Overrides::default();
    for setting in settings {
        overrides.set(setting).expect("the parser has tried it");
    }
    overrides
}
