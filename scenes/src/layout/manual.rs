//! The memory layouts as a manual in Markdown, from the tables that images are written by.

use std::fmt::Write;

use super::{BLOCK_NODES, FAR_LIGHT, Field, LIGHT, Layout, MATERIAL, PIXEL, Structure, StructureSet, TOP_NODES};
use crate::generate;
use crate::image::{HEADER, MemoryKind, MemoryOptions, build};
use crate::model::View;

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
            Layout::Packed => PACKED,
        };
        line(&mut text, &format!("## Layout `{layout}`\n\n{about}"));
        match layout {
            Layout::Packet => {}
            Layout::Packed => packed(&mut text),
            Layout::Report | Layout::Wide => {
                let StructureSet { node, reference, triangle, .. } = layout.fixed_structures();
                [node, reference, triangle].iter().for_each(|structure| table(&mut text, structure));
            }
        }
    }
    line(&mut text, "## Structures of all layouts but `packed`\n");
    for structure in [&MATERIAL, &LIGHT] {
        table(&mut text, structure);
    }
    line(&mut text, FAR);
    for structure in [&FAR_LIGHT, &PIXEL] {
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
four layouts: `report` has the report's structures bit for bit (Annex I), `wide` is the default and keeps all bits of a
coordinate, `packet` is `wide` with the vertices of a leaf's triangles beside its references, `packed` is `wide` in as few
bits as scene and tree allow. `--layout` chooses one.

Integers are little-endian, signed ones in two's complement, and structures have no gaps between their fields.
Structures follow each other without gaps too, in this order; each kind starts at the next multiple of 8:

";

const FAR: &str = "\
A light is near if its way to every point of the scene's box is within 2^(w-1) - 8 steps of the grid along each axis. In words of 32 bits
positions have one bit less where that makes all lights near. Else all lights have the longer structure, and the far ones have steps of their own, powers of two of the
grid's, the finest ones in which the way fits. So lights take at most one bit from the mesh, none in short words, and lose none themselves, however far away they stand.
";

const FORMATS: &str = "
Kernels know field offsets by name: the assembler's `.struct` definitions come from the same tables. How many fraction
bits a number has is not part of the layout but chosen for each scene and word length (`lancer scene info` prints it),
or set with `--format`:

| format | what has it | default in a word of `w` bits |
| --- | --- | --- |
| position | coordinates, relative to the middle of the scene's box | the finest power of two with the triangles within 2^(w-2), or, of 32 bits, one less where that brings the way to each light within 2^(w-1); words below 32 bits have steps up to twice as fine ([exactness.md](exactness.md)), but not where the layout `report` shifts |
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

const PACKED: &str = "\
Fields take as many bits as the scene needs, and stand bit behind bit: an integer begins with its lowest bit, in the
lowest bit of an octet that is free. Only structures, the references of a leaf and `material_id` begin with an octet. In
a core's buffer and its registers the same numbers are words: the rows `ldv3f`, `ldnode`, `loadf`, `loadfu` and `loadnode`
unpack what they move, so that all but transfers is as in `wide`, and pictures are the same, bit for bit. The frame
stays in words, since hosts read it.

How wide a field is follows from what it holds: coordinates and planes are as wide as the largest one with its sign, so
that coarser positions (`--word`, `--format pos=`) make it narrower; links and references reach just as far as tree and
scene do. With whole octets a field the nine coordinates of a triangle in words of 20 bits would take 27 of the 36 octets
that they have in `wide`; bit behind bit they take 23.

Nodes and triangles are named by numbers, counted from address 0, so each of these two kinds starts at a multiple of its
structure's octets. The name of a node is 8 times its number, which is what links become in registers: rows that walk
take them as they take addresses of `wide`. The references of a leaf begin at a multiple of 8. The rows that unpack are
no rows of the report, so its kernels (`--profile report`) are refused.

These are the structures of the Cornell box in words of 16 bits; of other scenes and words only the widths differ.

";

/// Structures of the layout `packed`, of a scene.
fn packed(text: &mut String) {
    let scene = generate::scene("cornell", &generate::GenerateOptions::default()).expect("the scene is one of ours");
    let options = MemoryOptions { word: 16, layout: Layout::Packed, ..MemoryOptions::default() };
    let image = build(&scene, &View::new(scene.size), &options).expect("16 bits hold the scene");
    let StructureSet { node, reference, triangle, material, light, .. } = &image.structures;
    for structure in [node, reference, triangle, material, light] {
        let mut write = || {
            writeln!(text, "### `{}`: {} octets\n", structure.name, structure.octets())?;
            writeln!(text, "| bit | bits | field | integers | holds |\n| ---: | ---: | --- | --- | --- |")?;
            for (start, field) in structure.places() {
                let (bits, kind) = (field.elements * field.bits, kind(field));
                writeln!(text, "| {start} | {bits} | `{}` | {kind} | {} |", field.name, field.holds)?;
            }
            writeln!(text)
        };
        write().expect("text takes whatever is written to it");
    }
}

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
    let bits = field.bits;
    match field.elements {
        1 => format!("{sign} {bits}"),
        count => format!("{count} x {sign} {bits}"),
    }
}

fn table(text: &mut String, structure: &Structure) {
    let mut write = || {
        writeln!(text, "### `{}`: {} octets\n", structure.name, structure.octets())?;
        writeln!(text, "| offset | octets | field | bits | holds |\n| ---: | ---: | --- | --- | --- |")?;
        for (start, field) in structure.places() {
            let (offset, octets, kind) = (start / 8, field.octets(), kind(field));
            writeln!(text, "| {offset} | {octets} | `{}` | {kind} | {} |", field.name, field.holds)?;
        }
        writeln!(text)
    };
    write().expect("text takes whatever is written to it");
}
