//! The page of a pixel: its explanation and its steps as a single HTML file that needs nothing else. What is on it is gathered here; how it looks and
//! moves is in `page.html`.

use serde::Serialize;

use super::replay::PixelReplay;
use super::result::PixelExplanation;
use crate::report::filled;

/// The page, with the place of its data.
const PAGE: &str = include_str!("page.html");

#[derive(Serialize)]
struct PixelPage<'a> {
    explanation: &'a PixelExplanation,
    replay: &'a PixelReplay,
}

/// The page of an explained pixel.
pub fn page(explanation: &PixelExplanation, replay: &PixelReplay) -> String {
    filled(PAGE, &PixelPage { explanation, replay })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_needs_nothing_else() {
        assert_eq!(crate::report::outside(PAGE), [""; 0]);
    }
}
