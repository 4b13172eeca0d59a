//! Shapes as a PDF file of one page (ISO 32000-1), in fonts that every reader has. Nothing in it depends on the day.

use std::fmt::Write as _;

use super::canvas::{Canvas, Colour, DrawnShape, PagePlace, TextLine};

/// The file.
pub fn octets(canvas: &Canvas) -> Vec<u8> {
    let content = content(canvas);
    let (width, height) = canvas.size;
    let font = |name: &str| {
        format!("<< /Type /Font /Subtype /Type1 /BaseFont /{name} /Encoding /WinAnsiEncoding >>").into_bytes()
    };
    let page = format!(
        "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width} {height:.0}] /Contents 6 0 R \
         /Resources << /Font << /F1 4 0 R /F2 5 0 R >> >> >>"
    );
    let mut stream = format!("<< /Length {} >>\nstream\n", content.len()).into_bytes();
    stream.extend_from_slice(&content);
    stream.extend_from_slice(b"\nendstream");
    let objects = [
        b"<< /Type /Catalog /Pages 2 0 R >>".to_vec(),
        b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>".to_vec(),
        page.into_bytes(),
        font("Helvetica"),
        font("Helvetica-Bold"),
        stream,
    ];
    // Objects one after the other, then where each begins, counted from the start of the file in ten digits.
    let mut file = b"%PDF-1.4\n%\xE2\xE3\xCF\xD3\n".to_vec();
    let mut starts = Vec::new();
    for (at, object) in objects.iter().enumerate() {
        starts.push(file.len());
        file.extend_from_slice(format!("{} 0 obj\n", at + 1).as_bytes());
        file.extend_from_slice(object);
        file.extend_from_slice(b"\nendobj\n");
    }
    let table = file.len();
    let mut end = format!("xref\n0 {}\n0000000000 65535 f \n", objects.len() + 1);
    for start in starts {
        let _ = writeln!(end, "{start:010} 00000 n ");
    }
    let _ = write!(end, "trailer\n<< /Size {} /Root 1 0 R >>\nstartxref\n{table}\n%%EOF\n", objects.len() + 1);
    file.extend_from_slice(end.as_bytes());
    file
}

/// The page's operators. PDF counts upwards from the lower left corner.
fn content(canvas: &Canvas) -> Vec<u8> {
    let height = canvas.size.1;
    let mut content = Vec::new();
    for shape in &canvas.shapes {
        match shape {
            DrawnShape::Line { points, colour, width, dashes } => {
                let dashes: Vec<String> = dashes.iter().map(f64::to_string).collect();
                let operators = format!(
                    "{} RG {width} w [{}] 0 d {}S\n",
                    components(*colour),
                    dashes.join(" "),
                    path(points, height)
                );
                content.extend_from_slice(operators.as_bytes());
            }
            DrawnShape::Area { corners, colour, .. } => {
                let operators = format!("{} rg {}f\n", components(*colour), path(corners, height));
                content.extend_from_slice(operators.as_bytes());
            }
            DrawnShape::Text(line) => content.extend(words(line, height)),
        }
    }
    content
}

fn path(points: &[PagePlace], height: f64) -> String {
    let mut path = String::new();
    for (at, (x, y)) in points.iter().enumerate() {
        let _ = write!(path, "{x:.2} {:.2} {} ", height - y, if at == 0 { 'm' } else { 'l' });
    }
    path
}

fn words(line: &TextLine, height: f64) -> Vec<u8> {
    let (x, y) = line.start();
    let turn = if line.is_turned { "0 1 -1 0" } else { "1 0 0 1" };
    let font = if line.is_bold { "F2" } else { "F1" };
    let mut operators =
        format!("BT {} rg /{font} {} Tf {turn} {x:.2} {:.2} Tm (", components(line.colour), line.size, height - y)
            .into_bytes();
    for c in line.words.chars() {
        match c {
            '(' | ')' | '\\' => operators.extend([b'\\', c as u8]),
            // The fonts' encoding is Latin 1 from the blank on, but for what nothing here writes.
            ' '..='~' | '\u{A0}'..='\u{FF}' => operators.push(c as u32 as u8),
            _ => operators.push(b'?'),
        }
    }
    operators.extend_from_slice(b") Tj ET\n");
    operators
}

fn components(Colour(colour): Colour) -> String {
    colour.map(|component| format!("{:.3}", f64::from(component) / 255.0)).join(" ")
}

#[cfg(test)]
mod tests {
    use super::super::canvas::TextAnchor;
    use super::*;

    #[test]
    fn objects_begin_where_the_table_says() {
        let mut canvas = Canvas { size: (100.0, 50.0), shapes: Vec::new() };
        canvas.line(vec![(0.0, 0.0), (10.0, 20.0)], Colour([255, 0, 0]), 1.0, &[2.0, 1.0]);
        let line = TextLine {
            at: (5.0, 5.0),
            anchor: TextAnchor::Start,
            size: 8.0,
            is_bold: false,
            is_turned: true,
            colour: Colour([0; 3]),
            words: "a (b) \\ \u{e9} \u{4e2d}".into(),
        };
        canvas.text(line);
        let file = octets(&canvas);
        let find = |part: &[u8]| file.windows(part.len()).position(|window| window == part).unwrap();
        let table = find(b"\nxref\n") + 1;
        let end = String::from_utf8(file[table..].to_vec()).unwrap();
        assert!(end.ends_with(&format!("startxref\n{table}\n%%EOF\n")), "{end}");
        for (number, row) in (1..).zip(end.lines().skip(3).take(6)) {
            let start: usize = row[..10].parse().unwrap();
            assert!(file[start..].starts_with(format!("{number} 0 obj").as_bytes()), "{row}");
        }
        // 50 points high, so 20 downwards is 30 upwards; texts keep their brackets.
        find(b"1.000 0.000 0.000 RG 1 w [2 1] 0 d 0.00 50.00 m 10.00 30.00 l S");
        find(b"(a \\(b\\) \\\\ \xE9 ?) Tj");
    }
}
