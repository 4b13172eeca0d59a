//! The manual of the instruction set, written from the rows, the directives and the assembler's own description. Nothing in it is
//! listed by hand.

mod anchor;
pub mod examples;
mod topic;

use std::collections::BTreeMap;
use std::fmt::Write;

use isa::definition::Room;
use isa::table::ROOMS;
use isa::{Class, InstructionDef, Isa, Kind};
use pulldown_cmark::{Event, Tag};

use anchor::{Anchors, headings, plain};
pub use topic::{names, page};

/// Meaning of the letters and kinds of operands; the kinds' own rows are generated.
const OPERANDS: &str = "\
Each instruction is a line: name, operands, the 32-bit word as a bit pattern, and the ways in which it ends with what each costs.

The letter of an operand says what happens to it: `d e` are written, `x y` read and written, `a b c` read, `i j` are immediate. In the
pattern, `0` and `1` are fixed bits, a letter is a bit of that operand's field, and `-` is 0; a word with another bit there is illegal.
";

const REGISTERS: &str = "\
A core has 32 scalar registers `s0` to `s31` (`s0` reads zero and ignores writes), 32 vector registers `v0` to `v31` of three components, and
8 wide accumulators `w0` to `w7` of twice the word. They hold raw integers; which format a number has is the program's business.

*Numeric* rows compute exactly and quantize once: to the word, under the machine's rounding and overflow modes (IEEE 1666; by default to
nearest with ties up, saturating). *Integer* rows are 32 bits modulo 2^32 whatever the word.
";

/// Chapter on calls and memories: places of arguments, results and data.
const CONVENTIONS: &str = include_str!("conventions.md");

/// The manual as Markdown: contents, chapters, index.
pub fn markdown(isa: &Isa) -> String {
    let chapters = chapters(isa);
    let mut text = String::from("# The instruction set of lancer\n\n");
    let _ = writeln!(
        text,
        "{} instructions. Written by `lancer manual` from the table of instructions; `lancer manual vdot` shows one of them.\n",
        isa.ops().count()
    );
    text.push_str("## Contents\n\n");
    let mut anchors = Anchors::default();
    anchors.next("The instruction set of lancer");
    anchors.next("Contents");
    for (level, heading) in headings(&chapters) {
        let anchor = anchors.next(heading);
        if level <= 2 {
            let _ = writeln!(text, "{}* [{heading}](#{anchor})", "  ".repeat(level - 1));
        }
    }
    text.push_str("* [Index](#index)\n\n");
    text + &chapters + &index(isa)
}

/// All names of the manual in the order of the alphabet, each with a link to where it stands.
fn index(isa: &Isa) -> String {
    let mut entries: BTreeMap<String, String> = BTreeMap::new();
    let mut add = |name: &str, heading: &str| {
        entries.insert(name.to_owned(), plain(heading));
    };
    rows(isa).for_each(|row| add(&row.name, &row.name));
    asm::pseudo::PSEUDOS.iter().for_each(|pseudo| add(pseudo.name, "All pseudo-instructions"));
    asm::directive::DIRECTIVES.iter().for_each(|directive| add(directive.name, "All directives"));
    asm::function::FUNCTIONS
        .iter()
        .for_each(|function| add(&format!("{}()", function.name), "All functions of expressions"));
    let mut text = String::from("\n## Index\n");
    let mut letter = None;
    // Directives stand under the letter behind their point.
    let key = |name: &str| name.trim_start_matches('.').chars().next().map(|letter| letter.to_ascii_lowercase());
    let mut entries: Vec<(String, String)> = entries.into_iter().collect();
    entries.sort_by(|(a, _), (b, _)| a.trim_start_matches('.').cmp(b.trim_start_matches('.')).then(a.cmp(b)));
    for (name, anchor) in entries {
        if key(&name) != letter {
            letter = key(&name);
            text.push('\n');
        }
        let _ = writeln!(text, "[`{name}`](#{anchor})");
    }
    text
}

/// Chapters between contents and index.
fn chapters(isa: &Isa) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "## Registers and numbers\n\n{REGISTERS}");
    let _ = writeln!(text, "{CONVENTIONS}");
    let _ = writeln!(text, "## How to read an instruction\n\n{OPERANDS}");
    // Make tables of the kinds of operands and the classes of operations
    text.push_str("| kind | registers | least to largest number of its field |\n|---|---|---|\n");
    for kind in Kind::ALL {
        let registers = match kind.register_file() {
            Some(file) => format!("{} from `{file}`", kind.registers()),
            None => "immediate".to_owned(),
        };
        let range = match kind.width() {
            Some(width) => {
                let (least, most) = kind.range(width);
                format!("{least} to {most}")
            }
            None => if kind.is_signed() { "two's complement, as wide as its field" } else { "as wide as its field" }
                .to_owned(),
        };
        let _ = writeln!(text, "| `{}` | {registers} | {range} |", kind.name());
    }
    text.push_str("\nWhat is counted:\n\n| class | what |\n|---|---|\n");
    for class in Class::ALL {
        let _ = writeln!(text, "| `{}` | {} |", class.name(), class.doc().trim());
    }
    // Write a chapter for each room of the table
    for room in ROOMS {
        chapter(&mut text, room, isa);
    }
    // Instructions of an extension are in none of these rooms.
    let extensions: Vec<&InstructionDef> =
        rows(isa).filter(|row| ROOMS.iter().all(|room| room.name != row.room)).collect();
    if !extensions.is_empty() {
        text.push_str("\n## Extensions\n");
        extensions.into_iter().for_each(|row| entry(&mut text, row));
    }
    let _ = writeln!(text, "\n{}", asm::LANGUAGE.trim_end());
    language(&mut text);
    text
}

/// The assembler's pseudo-instructions, directives and functions, which it has as data.
fn language(text: &mut String) {
    text.push_str("\n## All pseudo-instructions\n\n| written | what it does |\n|---|---|\n");
    for pseudo in asm::pseudo::PSEUDOS {
        let _ = writeln!(text, "| `{}` | {} |", cell(&pseudo.usage()), cell(pseudo.doc));
    }
    text.push_str("\n## All directives\n\n| written | what it does |\n|---|---|\n");
    for directive in asm::directive::DIRECTIVES {
        let written = format!("{} {}", directive.name, directive.operands);
        let _ = writeln!(text, "| `{}` | {} |", cell(written.trim()), cell(directive.doc));
    }
    text.push_str("\n## All functions of expressions\n\n| written | value |\n|---|---|\n");
    for function in asm::function::FUNCTIONS {
        let _ = writeln!(text, "| `{}` | {} |", cell(function.usage), cell(function.doc));
    }
}

/// Text that stays in its cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

fn rows(isa: &Isa) -> impl Iterator<Item = &InstructionDef> {
    isa.ops().map(|op| isa.definition(op))
}

fn chapter(text: &mut String, room: &Room, isa: &Isa) {
    let mut title = room.name.to_owned();
    title[..1].make_ascii_uppercase();
    let _ = writeln!(text, "\n## {title}\n\n{}", room.doc);
    rows(isa).filter(|row| row.room == room.name).for_each(|row| entry(text, row));
}

fn entry(text: &mut String, row: &InstructionDef) {
    let _ = writeln!(text, "\n### {}\n\n    {}\n", row.name, row.line());
    for line in row.doc.lines() {
        let _ = writeln!(text, "{}", line.trim());
    }
    if let Some(example) = examples::find(&row.name) {
        let _ = writeln!(text, "\n```asm\n{example}\n```");
    }
}

/// The page around the manual, with its title and its style.
const PAGE: &str = include_str!("manual.html");

/// Words of [`PAGE`] that the manual stands in the place of.
const BODY: &str = "{{ body }}";

/// The manual as one HTML page that needs no other file.
pub fn html(isa: &Isa) -> String {
    let markdown = markdown(isa);
    let options = pulldown_cmark::Options::ENABLE_TABLES;
    let mut body = String::new();
    // A heading's anchor is made of its text, which comes behind its beginning: all are made beforehand.
    let mut anchors = Anchors::default();
    let mut ids =
        headings(&markdown).into_iter().map(|(_, heading)| anchors.next(heading)).collect::<Vec<_>>().into_iter();
    let events = pulldown_cmark::Parser::new_ext(&markdown, options).map(|event| match event {
        Event::Start(Tag::Heading { level, classes, attrs, .. }) => {
            Event::Start(Tag::Heading { level, id: ids.next().map(Into::into), classes, attrs })
        }
        // Notes of an extension are a stranger's: their HTML is text, and their links lead to pages alone.
        Event::Html(text) | Event::InlineHtml(text) => Event::Text(text),
        Event::Start(Tag::Link { link_type, dest_url, title, id }) if !is_page(&dest_url) => {
            Event::Start(Tag::Link { link_type, dest_url: format!("#{dest_url}").into(), title, id })
        }
        Event::Start(Tag::Image { link_type, title, id, .. }) => {
            Event::Start(Tag::Image { link_type, dest_url: "".into(), title, id })
        }
        event => event,
    });
    pulldown_cmark::html::push_html(&mut body, events);
    PAGE.trim_end().replacen(BODY, &body, 1)
}

/// True of a link that a browser follows to a page, or within this one.
fn is_page(address: &str) -> bool {
    let scheme = address.split(['/', '?', '#']).next().unwrap_or_default();
    !scheme.contains(':') || address.starts_with("https:") || address.starts_with("http:")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stranger_puts_no_script_into_the_page() {
        assert!(is_page("https://example.org") && is_page("#vadd") && is_page("docs/a.md#x:y"));
        for address in ["javascript:alert(1)", "data:text/html,x", "JavaScript:x", "vbscript:x", " javascript:x"] {
            assert!(!is_page(address), "{address}");
        }
    }

    #[test]
    fn every_row_and_class_is_in_the_manual() {
        let isa = Isa::base();
        let text = markdown(&isa);
        for row in rows(&isa) {
            assert!(text.contains(&format!("### {}\n\n    {}\n", row.name, row.line())), "{}", row.name);
        }
        let page = html(&isa);
        assert!(page.contains("<h3 id=\"vcross\">vcross</h3>") && !page.contains(BODY) && page.ends_with("</html>"));
    }

    #[test]
    fn every_link_leads_to_an_anchor() {
        let page = html(&Isa::base());
        let between = |text: &str, from: &str| -> Vec<String> {
            text.split(from).skip(1).filter_map(|rest| Some(rest.split_once('"')?.0.to_owned())).collect()
        };
        let ids: std::collections::BTreeSet<String> = between(&page, " id=\"").into_iter().collect();
        let links = between(&page, "<a href=\"#");
        assert!(links.len() > 240, "{} links", links.len());
        for link in links {
            assert!(ids.contains(&link), "no heading has the anchor {link}");
        }
    }

    #[test]
    fn every_topic_has_a_page() {
        let isa = Isa::base();
        for name in names(&isa) {
            assert!(page(&name, &isa).is_some_and(|page| page.len() > 20 && page.ends_with('\n')), "{name}");
        }
        let text = page("vdot", &isa).unwrap();
        for part in [
            "vdot d, a, b, i",
            "a scalar register",
            "immediate",
            "0 to 63",
            "add 2, mul 3",
            "example:",
            "; s4 = 6.5:pos",
        ] {
            assert!(text.contains(part), "{part}:\n{text}");
        }
        assert_eq!(page("vdto", &isa), None);
    }

    #[test]
    fn the_manual_in_the_repository_is_not_stale() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/MANUAL.md");
        let text = markdown(&Isa::base());
        if std::env::var_os("LANCER_BLESS").is_some() {
            std::fs::write(path, &text).expect("the manual can be written");
        }
        let stored = std::fs::read_to_string(path).unwrap_or_default();
        assert!(
            stored == text,
            "MANUAL.md is stale: run the tests with LANCER_BLESS=1, or `lancer manual -o MANUAL.md`"
        );
    }
}
