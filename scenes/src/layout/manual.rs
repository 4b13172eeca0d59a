//! The memory layouts as a manual in Markdown, from the tables that images are written by.

use std::fmt::Write;

use super::{BLOCK_NODES, Field, LIGHT, Layout, MATERIAL, PIXEL, Structure, TOP_NODES};
use crate::image::{HEADER, MemoryKind};

/// The manual of all layouts: `docs/layouts.md`.
pub fn manual() -> String {
    let mut text = INTRODUCTION.to_string();
    for (number, kind) in MemoryKind::ALL.into_iter().enumerate() {
        let holds = match kind {
            MemoryKind::Header => format!("{HEADER} octets that are never used, so that 0 is no structure's address"),
            MemoryKind::Nodes => "nodes of the kd tree, level by level; the root is the first".to_string(),
            MemoryKind::References => "references of the leaves to their triangles, leaf by leaf".to_string(),
            MemoryKind::Triangles => "triangles, by index".to_string(),
            MemoryKind::Materials => "materials, by number".to_string(),
            MemoryKind::Lights => "lights, by number".to_string(),
            MemoryKind::Frame => "pixels, row 0 (the top) first, from left to right; zero at the start".to_string(),
        };
        line(&mut text, &format!("{}. `{}`: {holds}.", number + 1, kind.name()));
    }
    line(&mut text, FORMATS);
    for layout in Layout::ALL {
        let about = match layout {
            Layout::Report => REPORT,
            Layout::Wide => WIDE,
            Layout::Packet => &format!("{PACKET}{}", blocks()),
        };
        line(&mut text, &format!("## Layout `{layout}`\n\n{about}"));
        if layout == Layout::Packet {
            continue;
        }
        for structure in [layout.node(), layout.reference(), layout.triangle()] {
            table(&mut text, structure);
        }
    }
    line(&mut text, "## Structures of all layouts\n");
    for structure in [&MATERIAL, &LIGHT, &PIXEL] {
        table(&mut text, structure);
    }
    // One line end at the end of the file.
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

const INTRODUCTION: &str = "\
# Layouts of global memory

<!-- Written by scenes::layout::manual from the tables in scenes/src/layout.rs; a test says when this file is stale. -->

A scene is put into global memory once, before the machine starts; kernels read it there and write the frame. There are
three layouts: `report` has the report's structures bit for bit (Annex I), `wide` is the default and keeps all bits of a
coordinate, `packet` is `wide` with the vertices of a leaf's triangles beside its references. `--layout` chooses one.

Integers are little-endian, signed ones in two's complement, and structures have no gaps between their fields.
Structures follow each other without gaps too, in this order; each kind starts at the next multiple of 8:

";

const FORMATS: &str = "
Kernels know field offsets by name: the assembler's `.struct` definitions come from the same tables. How many fraction
bits a number has is not part of the layout but chosen for each scene and word length (`lancer scene info` prints it),
or set with `--format`:

| format | what has it | default in a word of `w` bits |
| --- | --- | --- |
| position | coordinates, relative to the middle of the scene's box | the finest power of two with the triangles within 2^(w-2), and the way to each light within 2^(w-1) |
| weight | material coefficients and colours, 0 to 1 | w - 2 |
| colour | light colours and pixels | the most that hold the brightest sum, at most w - 3 |
| index | indices of refraction | w - 4 |
";

const REPORT: &str = "\
Coordinates are stored in 16 bits: shifted right by w - 16 in words of w bits, rounded to nearest, ties up. They are
shifted left again when they are loaded. The tree is built on the coordinates as they are stored. A triangle names 256
materials at most, and a leaf has 65,535 triangles at most. Addresses are those of octets; structures are not aligned.
";

const WIDE: &str = "\
Coordinates are stored as they are in registers. A node has 8 octets at an address that is a multiple of 8, so that the
low bits of `link` can hold a tag; a leaf's references are an array. A triangle names 65,536 materials at most.
";

const PACKET: &str = "\
Structures are those of the layout `wide`, and a leaf's references are an array, too. Behind that array stand the
vertices of its triangles, as the rows `rnear` and `rany` take them: for a leaf of n triangles nine arrays of n words of
32 bits, which hold x, y and z of the first vertices, then of the second and of the third ones. A leaf takes 40 octets a
reference, and one transfer brings all of it. A triangle that lies in several leaves has its vertices in each.
";

/// The order of the nodes in the layout `packet`.
fn blocks() -> String {
    format!(
        "\nThe root is the first node. The first {TOP_NODES} nodes stand level by level. Below, nodes stand in blocks of at most {BLOCK_NODES}, \
         which\nbegin with the children of a node above and go on level by level, so that a walk finds several steps in one transfer.\n"
    )
}

fn line(text: &mut String, line: &str) {
    text.push_str(line);
    text.push('\n');
}

/// Description of an integer of a field.
fn kind(field: &Field) -> String {
    let sign = if field.is_signed { "signed" } else { "unsigned" };
    let bits = 8 * field.width;
    match field.elements {
        1 => format!("{sign} {bits}"),
        count => format!("{count} x {sign} {bits}"),
    }
}

fn table(text: &mut String, structure: &Structure) {
    let mut write = || {
        writeln!(text, "### `{}`: {} octets\n", structure.name, structure.octets())?;
        writeln!(text, "| offset | octets | field | bits | holds |\n| ---: | ---: | --- | --- | --- |")?;
        for (offset, field) in structure.offsets() {
            let (octets, kind) = (field.octets(), kind(field));
            writeln!(text, "| {offset} | {octets} | `{}` | {kind} | {} |", field.name, field.holds)?;
        }
        writeln!(text)
    };
    write().expect("text takes whatever is written to it");
}
