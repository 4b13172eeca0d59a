//! Shapes as an SVG file.

use std::fmt::Write;

use super::canvas::{Canvas, Colour, DrawnShape, PagePlace, TextAnchor, TextLine};

/// The file; the figure's title is its title for viewers and screen readers.
pub fn text(canvas: &Canvas, title: &str) -> String {
    let (width, height) = canvas.size;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}pt\" height=\"{height:.0}pt\" viewBox=\"0 0 {width} {height:.0}\" \
         role=\"img\" font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\">\n<title>{}</title>\n",
        escaped(title)
    );
    // Writing to a text cannot fail, so the results are dropped.
    for shape in &canvas.shapes {
        let _ = match shape {
            DrawnShape::Line { points, colour, width, dashes } => {
                let dashes: Vec<String> = dashes.iter().map(f64::to_string).collect();
                let dashes = if dashes.is_empty() {
                    String::new()
                } else {
                    format!(" stroke-dasharray=\"{}\"", dashes.join(" "))
                };
                writeln!(
                    svg,
                    "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\"{dashes}/>",
                    path(points),
                    hexadecimal(*colour)
                )
            }
            DrawnShape::Area { corners, colour, tip } => {
                let area = format!("<path d=\"{}Z\" fill=\"{}\"", path(corners), hexadecimal(*colour));
                // A browser shows the title of a shape under the cursor.
                match tip.as_str() {
                    "" => writeln!(svg, "{area}/>"),
                    tip => writeln!(svg, "{area}><title>{}</title></path>", escaped(tip)),
                }
            }
            DrawnShape::Text(line) => writeln!(svg, "{}", words(line)),
        };
    }
    svg + "</svg>\n"
}

fn path(points: &[PagePlace]) -> String {
    let mut path = String::new();
    for (at, (x, y)) in points.iter().enumerate() {
        let _ = write!(path, "{}{x:.2} {y:.2}", if at == 0 { 'M' } else { 'L' });
    }
    path
}

fn words(line: &TextLine) -> String {
    let (x, y) = line.at;
    let anchor = match line.anchor {
        TextAnchor::Start => "",
        TextAnchor::Middle => " text-anchor=\"middle\"",
        TextAnchor::End => " text-anchor=\"end\"",
    };
    let bold = if line.is_bold { " font-weight=\"bold\"" } else { "" };
    // The length holds in any font, so that names which do not meet here do not meet elsewhere.
    let length = format!(" textLength=\"{:.2}\" lengthAdjust=\"spacingAndGlyphs\"", line.width());
    let turned = if line.is_turned { format!(" transform=\"rotate(-90 {x:.2} {y:.2})\"") } else { String::new() };
    format!(
        "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{}\" fill=\"{}\"{anchor}{bold}{length}{turned}>{}</text>",
        line.size,
        hexadecimal(line.colour),
        escaped(&line.words)
    )
}

fn hexadecimal(Colour([red, green, blue]): Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn escaped(text: &str) -> String {
    let visible = text.chars().filter(|c| !c.is_control()).collect::<String>();
    visible.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
