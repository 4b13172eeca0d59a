//! One page of a run: everything that is known of a drawing, as a single HTML file that needs nothing else. What is on the page is gathered
//! here; how it looks and moves is in `page.html`.

pub(crate) mod base64;
mod data;

use serde::Serialize;

pub use data::PageData;

use crate::advise::AdviceResult;
use crate::annex::result::Annexes;
use crate::drawing::Drawing;
use crate::job::Job;
use crate::result::Render;

/// The page, with the place of its data.
const PAGE: &str = include_str!("page.html");

/// The place of the data in the page.
const PLACE: &str = "{{ data }}";

/// The page of a drawing that was measured against double precision, with advice and the annexes' rows where they were asked for.
pub fn page(
    job: &Job,
    drawing: &Drawing,
    result: &Render,
    advice: Option<&AdviceResult>,
    annexes: Option<&Annexes>,
) -> String {
    filled(PAGE, &PageData::new(job, drawing, result, advice, annexes))
}

/// A page with data in their place.
pub(crate) fn filled(page: &str, data: &impl Serialize) -> String {
    page.replacen(PLACE, &embedded(data), 1)
}

/// Data as JSON that cannot end the element of HTML in which it stands.
fn embedded(data: &impl Serialize) -> String {
    let text = serde_json::to_string(data).expect("figures and texts are JSON");
    text.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

/// Ways in which a page asks for something outside of itself, and the place of its data where it has not just one.
#[cfg(test)]
pub(crate) fn outside(page: &str) -> Vec<&'static str> {
    let asks =
        ["http://", "https://", "<link", "src=\"", "@import", "url("].into_iter().filter(|ask| page.contains(ask));
    asks.chain((page.matches(PLACE).count() != 1).then_some(PLACE)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_end_the_data() {
        let text = embedded(&["</script><b>&amp;"]);
        assert!(!text.contains(['<', '>', '&']), "{text}");
        let back: [String; 1] = serde_json::from_str(&text).unwrap();
        assert_eq!(back, ["</script><b>&amp;"]);
    }

    #[test]
    fn the_page_needs_nothing_else() {
        assert_eq!(outside(PAGE), [""; 0]);
        assert_eq!(outside("<img src=\"a.png\">"), ["src=\"", PLACE]);
    }
}
