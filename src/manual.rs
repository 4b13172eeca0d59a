//! The manual of the instruction set, written from the rows, the directives and the assembler's own description. Nothing in it is
//! listed by hand.

use std::fmt::Write;

use isa::definition::Room;
use isa::table::ROOMS;
use isa::{Class, InstructionDef, Isa, Kind};
use pulldown_cmark::{Event, Tag};

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

/// The manual as Markdown.
pub fn markdown(isa: &Isa) -> String {
    let mut text = String::from("# The instruction set of lancer\n\n");
    let _ = writeln!(
        text,
        "{} instructions. Written by `lancer manual` from the table of instructions.\n",
        isa.ops().count()
    );
    let _ = writeln!(text, "## Registers and numbers\n\n{REGISTERS}");
    let _ = writeln!(text, "## How to read an instruction\n\n{OPERANDS}");
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
    for room in ROOMS {
        chapter(&mut text, room, isa);
    }
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
    let events = pulldown_cmark::Parser::new_ext(&markdown, options).map(|event| match event {
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
        assert!(page.contains("<h3>vcross</h3>") && !page.contains(BODY) && page.ends_with("</html>"));
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
