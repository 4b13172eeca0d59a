//! Meshes written in any style of OBJ, STL and PLY read back as what they are, OBJ as another reader reads it too.

use std::fmt::Write;

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use scenes::read::mesh::Mesh;
use scenes::read::{obj, ply, stl};

/// Coordinates that are written: whole and half ones, so that all formats hold them.
#[derive(Clone, Debug)]
struct MeshModel {
    vertices: Vec<[f64; 3]>,
    faces: Vec<Vec<u32>>,
}

/// Faces of `corners` corners.
fn models(corners: std::ops::Range<usize>) -> impl Strategy<Value = MeshModel> {
    let coordinate = (-1000..1000_i32).prop_map(|x| f64::from(x) / 2.0);
    prop::collection::vec(prop::array::uniform3(coordinate), 1..10).prop_flat_map(move |vertices| {
        let face = prop::collection::vec(0..vertices.len() as u32, corners.clone());
        (Just(vertices), prop::collection::vec(face, 0..8)).prop_map(|(vertices, faces)| MeshModel { vertices, faces })
    })
}

fn gaps() -> impl Strategy<Value = Vec<&'static str>> {
    prop::collection::vec(prop::sample::select(vec![" ", "  ", "\t", " \t "]), 1..9)
}

fn line_ends() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec!["\n", "\r\n", "\r", " \n", "\n\n", "\n \t\n"])
}

/// A number in one of the ways to write it.
fn number(x: f64, way: usize) -> String {
    match way % 4 {
        0 => format!("{x}"),
        1 => format!("{x:?}"),
        2 => format!("{x:e}"),
        _ => format!("{x:.3}"),
    }
}

/// Variants of an OBJ file.
#[derive(Clone, Debug)]
struct ObjStyle {
    gaps: Vec<&'static str>,
    line_end: &'static str,
    comment: &'static str,
    is_relative: bool,
    has_texture: bool,
    has_normals: bool,
    is_continued: bool,
    noise: &'static str,
}

fn obj_styles() -> impl Strategy<Value = ObjStyle> {
    let comment = prop::sample::select(vec!["", "", " # f 1 2 3", "#"]);
    let noise = prop::sample::select(vec!["", "o object", "g a b", "s 1", "s off", "# v 1 2 3", "g"]);
    (gaps(), line_ends(), comment, noise, any::<[bool; 4]>()).prop_map(
        |(gaps, line_end, comment, noise, [is_relative, has_texture, has_normals, is_continued])| ObjStyle {
            gaps,
            line_end,
            comment,
            is_relative,
            has_texture,
            has_normals,
            is_continued,
            noise,
        },
    )
}

fn obj_text(style: &ObjStyle, model: &MeshModel) -> String {
    let mut text = String::new();
    let mut gaps = style.gaps.iter().cycle();
    let mut line = |text: &mut String, words: &[String]| {
        for (n, word) in words.iter().enumerate() {
            if n > 0 {
                text.push_str(gaps.next().unwrap());
                // A line end within a statement must not be followed by a blank line.
                if style.is_continued && n % 2 == 0 {
                    text.push_str("\\\n");
                }
            }
            text.push_str(word);
        }
        text.push_str(style.comment);
        text.push_str(style.line_end);
    };
    let noise: Vec<String> = style.noise.split(' ').map(str::to_string).collect();
    line(&mut text, &noise);
    for (n, vertex) in model.vertices.iter().enumerate() {
        let numbers = vertex.iter().map(|&x| number(x, n));
        line(&mut text, &std::iter::once("v".to_string()).chain(numbers).collect::<Vec<_>>());
    }
    for (statement, is_written) in [("vt 0.5 0.5", style.has_texture), ("vn 0 0 1", style.has_normals)] {
        if is_written {
            line(&mut text, &statement.split(' ').map(str::to_string).collect::<Vec<_>>());
        }
    }
    for face in &model.faces {
        let corner = |&vertex: &u32| {
            let vertex = i64::from(vertex);
            let vertex = if style.is_relative { vertex - model.vertices.len() as i64 } else { vertex + 1 };
            match (style.has_texture, style.has_normals) {
                (false, false) => format!("{vertex}"),
                (true, false) => format!("{vertex}/1"),
                (false, true) => format!("{vertex}//-1"),
                (true, true) => format!("{vertex}/-1/1"),
            }
        };
        line(&mut text, &std::iter::once("f".to_string()).chain(face.iter().map(corner)).collect::<Vec<_>>());
        line(&mut text, &noise);
    }
    text
}

/// Positions of the corners of all triangles and polygons.
fn places(mesh: &Mesh) -> Vec<[[f64; 3]; 3]> {
    mesh.triangles.iter().map(|corners| corners.map(|n| mesh.vertices[n as usize])).collect()
}

fn expected(model: &MeshModel) -> Vec<[[f64; 3]; 3]> {
    model.faces.iter().map(|face| [0, 1, 2].map(|k| model.vertices[face[k] as usize])).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, rng_seed: RngSeed::Fixed(11), ..ProptestConfig::default() })]

    #[test]
    fn any_style_of_obj_reads_back(style in obj_styles(), model in models(3..4)) {
        let text = obj_text(&style, &model);
        let mesh = obj::parse(text.as_bytes(), "f.obj", None)
            .map_err(|report| TestCaseError::fail(format!("{report}\n{text}")))?;
        prop_assert_eq!(&mesh.vertices, &model.vertices, "{}", text);
        prop_assert_eq!(places(&mesh), expected(&model), "{}", text);

        // The other reader knows no continued lines, no lone carriage returns, and comments only between statements.
        if style.is_continued || style.line_end == "\r" || !style.comment.is_empty() {
            return Ok(());
        }
        let options = tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() };
        let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, |_| Ok(Default::default()))
            .map_err(|error| TestCaseError::fail(format!("{error}\n{text}")))?;
        let others: Vec<[[f64; 3]; 3]> = models
            .iter()
            .flat_map(|model| model.mesh.indices.chunks_exact(3).map(|three| {
                [0, 1, 2].map(|k| [0, 1, 2].map(|axis| model.mesh.positions[3 * three[k] as usize + axis]))
            }))
            .collect();
        prop_assert_eq!(places(&mesh), others, "{}", text);
    }

    #[test]
    fn any_style_of_stl_reads_back(
        model in models(3..4),
        gaps in gaps(),
        line_end in line_ends(),
        is_binary in any::<bool>(),
        is_capital in any::<bool>(),
        splits in prop::collection::vec(any::<bool>(), 8),
    ) {
        let bytes = match is_binary {
            true => stl_binary(&model),
            false => stl_text(&model, &gaps, line_end, is_capital, &splits),
        };
        let mesh = stl::parse(&bytes, "f.stl")
            .map_err(|report| TestCaseError::fail(format!("{report}\n{}", String::from_utf8_lossy(&bytes))))?;
        prop_assert_eq!(places(&mesh), expected(&model));
        let mut different = mesh.vertices.clone();
        different.sort_by(|a, b| a.partial_cmp(b).unwrap());
        different.dedup();
        prop_assert_eq!(different.len(), mesh.vertices.len(), "corners in the same place are one vertex");
    }

    #[test]
    fn any_style_of_ply_reads_back(style in ply_styles(), model in models(0..6)) {
        let bytes = ply_bytes(&style, &model);
        let mesh = ply::parse(&bytes, "f.ply")
            .map_err(|report| TestCaseError::fail(format!("{report}\n{}", String::from_utf8_lossy(&bytes))))?;
        prop_assert_eq!(&mesh.vertices, &model.vertices);
        let drawn: Vec<&Vec<u32>> = model.faces.iter().filter(|face| face.len() >= 3).collect();
        prop_assert_eq!(mesh.faces, drawn.len());
        let triangles: usize = drawn.iter().map(|face| face.len() - 2).sum();
        prop_assert_eq!(mesh.triangles.len(), triangles);
        let mut own = mesh.triangles.iter();
        for face in drawn {
            // Which corners a polygon is cut at is tested elsewhere; these are all of them.
            let mut corners: Vec<u32> = own.by_ref().take(face.len() - 2).flatten().copied().collect();
            let mut wanted = face.clone();
            for list in [&mut corners, &mut wanted] {
                list.sort_unstable();
                list.dedup();
            }
            prop_assert_eq!(corners, wanted);
        }
        prop_assert_eq!(mesh.materials.len(), usize::from(style.has_colours && triangles > 0));
        prop_assert!(mesh.materials.iter().all(|material| material.colour == [1.0, 0.2, 0.0]));
    }
}

fn stl_text(model: &MeshModel, gaps: &[&str], line_end: &str, is_capital: bool, splits: &[bool]) -> Vec<u8> {
    let mut text = String::new();
    let mut gaps = gaps.iter().cycle();
    let mut line = |text: &mut String, words: &[&str]| {
        for word in words {
            text.push_str(&if is_capital { word.to_uppercase() } else { word.to_string() });
            text.push_str(gaps.next().unwrap());
        }
        text.push_str(line_end);
    };
    line(&mut text, &["solid", "any name"]);
    for (n, (face, is_split)) in model.faces.iter().zip(splits).enumerate() {
        line(&mut text, &["facet", "normal", "0", "0", "1"]);
        line(&mut text, &["outer", "loop"]);
        for &vertex in face {
            let [x, y, z] = model.vertices[vertex as usize].map(|x| number(x, n));
            line(&mut text, &["vertex", &x, &y, &z]);
        }
        line(&mut text, &["endloop"]);
        line(&mut text, &["endfacet"]);
        if *is_split {
            line(&mut text, &["endsolid"]);
            line(&mut text, &["solid"]);
        }
    }
    line(&mut text, &["endsolid", "any name"]);
    text.into_bytes()
}

fn stl_binary(model: &MeshModel) -> Vec<u8> {
    let mut out = b"solid, but binary".to_vec();
    out.resize(80, b' ');
    out.extend((model.faces.len() as u32).to_le_bytes());
    for face in &model.faces {
        let corners = face.iter().flat_map(|&n| model.vertices[n as usize]);
        [0.0; 3].into_iter().chain(corners).for_each(|x| out.extend((x as f32).to_le_bytes()));
        out.extend([0; 2]);
    }
    out
}

/// Variants of a PLY file.
#[derive(Clone, Debug)]
struct PlyStyle {
    encoding: &'static str,
    /// Type of the coordinates.
    coordinate: &'static str,
    /// Types of the length of a list and of its numbers.
    list: (&'static str, &'static str),
    has_normals: bool,
    has_colours: bool,
    has_edges: bool,
    line_end: &'static str,
    gaps: Vec<&'static str>,
}

fn ply_styles() -> impl Strategy<Value = PlyStyle> {
    let encoding = prop::sample::select(vec!["ascii", "binary_little_endian", "binary_big_endian"]);
    let lengths = prop::sample::select(vec!["uchar", "char", "ushort", "int", "uint32"]);
    let numbers = prop::sample::select(vec!["int", "uint", "short", "uint8", "int8"]);
    let coordinate = prop::sample::select(vec!["float", "double", "float32", "float64"]);
    let line_end = prop::sample::select(vec!["\n", "\r\n", "\r"]);
    (encoding, lengths, numbers, coordinate, line_end, gaps(), any::<[bool; 3]>()).prop_map(
        |(encoding, length, number, coordinate, line_end, gaps, [has_normals, has_colours, has_edges])| PlyStyle {
            encoding,
            coordinate,
            list: (length, number),
            has_normals,
            has_colours,
            has_edges,
            line_end,
            gaps,
        },
    )
}

/// Appends a number of a type.
fn put(out: &mut Vec<u8>, style: &PlyStyle, kind: &str, value: f64) {
    if style.encoding == "ascii" {
        write!(TextEnd(out), "{value} ").unwrap();
        return;
    }
    let mut octets = match kind {
        "float" | "float32" => (value as f32).to_le_bytes().to_vec(),
        "double" | "float64" => value.to_le_bytes().to_vec(),
        "char" | "int8" | "uchar" | "uint8" => vec![value as i64 as u8],
        "short" | "ushort" => (value as i64 as u16).to_le_bytes().to_vec(),
        _ => (value as i64 as u32).to_le_bytes().to_vec(),
    };
    if style.encoding == "binary_big_endian" {
        octets.reverse();
    }
    out.extend(octets);
}

/// Text at the end of octets.
struct TextEnd<'a>(&'a mut Vec<u8>);

impl Write for TextEnd<'_> {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.extend(text.as_bytes());
        Ok(())
    }
}

fn ply_bytes(style: &PlyStyle, model: &MeshModel) -> Vec<u8> {
    // Write the header, with the style's gaps in turn between its words
    let mut lines = vec!["ply".to_string(), format!("format {} 1.0", style.encoding), "comment any".to_string()];
    lines.push(format!("element vertex {}", model.vertices.len()));
    lines.extend(["x", "y", "z"].map(|axis| format!("property {} {axis}", style.coordinate)));
    if style.has_normals {
        lines.extend(["nx", "ny", "nz"].map(|axis| format!("property float {axis}")));
    }
    if style.has_edges {
        lines.extend(["element edge 2", "property int vertex1", "property short vertex2"].map(str::to_string));
    }
    lines.push(format!("element face {}", model.faces.len()));
    lines.push(format!("property list {} {} vertex_indices", style.list.0, style.list.1));
    if style.has_colours {
        lines.extend(["red", "green", "blue"].map(|component| format!("property uchar {component}")));
    }
    lines.push("end_header".to_string());
    let mut gaps = style.gaps.iter().cycle();
    let mut out = Vec::new();
    for line in lines {
        let words: Vec<&str> = line.split(' ').collect();
        for (n, word) in words.iter().enumerate() {
            if n > 0 {
                out.extend(gaps.next().unwrap().as_bytes());
            }
            out.extend(word.as_bytes());
        }
        out.extend(style.line_end.as_bytes());
    }
    // In text each element ends with its line; binary elements have nothing between them.
    let end = |out: &mut Vec<u8>| {
        if style.encoding == "ascii" {
            out.extend(style.line_end.as_bytes());
        }
    };
    // Write the elements in the order of the header; edges are read over, so their numbers may be any
    for vertex in &model.vertices {
        vertex.iter().for_each(|&x| put(&mut out, style, style.coordinate, x));
        if style.has_normals {
            [0.0, 0.0, 1.0].iter().for_each(|&x| put(&mut out, style, "float", x));
        }
        end(&mut out);
    }
    for _ in 0..2 * usize::from(style.has_edges) {
        put(&mut out, style, "int", 7.0);
        put(&mut out, style, "short", -7.0);
        end(&mut out);
    }
    for face in &model.faces {
        put(&mut out, style, style.list.0, face.len() as f64);
        face.iter().for_each(|&n| put(&mut out, style, style.list.1, f64::from(n)));
        if style.has_colours {
            [255.0, 51.0, 0.0].iter().for_each(|&c| put(&mut out, style, "uchar", c));
        }
        end(&mut out);
    }
    out
}
