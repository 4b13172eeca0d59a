//! Comma-separated values (RFC 4180), as results are written for other programs.

/// A text as a value: in quotes where it holds commas, quotes or ends of lines.
pub fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

/// Lines of values with a head; values that may hold commas are [`quoted`] already.
pub fn lines<const N: usize>(heads: [&str; N], rows: impl IntoIterator<Item = [String; N]>) -> String {
    let mut text = heads.join(",") + "\n";
    for row in rows {
        text += &row.join(",");
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_read_back_as_one() {
        let row = |name: &str| [quoted(name), "3".to_owned()];
        let text = lines(["name", "cores"], [row("report"), row("4 octets, \"wide\""), row("a\nb")]);
        assert_eq!(text, "name,cores\nreport,3\n\"4 octets, \"\"wide\"\"\",3\n\"a\nb\",3\n");
    }
}
