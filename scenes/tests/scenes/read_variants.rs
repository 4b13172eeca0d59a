//! Meshes written in any style of OFF read back as what they are; broken files are refused and never worse.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use messages::Source;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use scenes::read::{dsc, off};

/// Variants of the colours of all faces of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ColourStyle {
    None,
    Index,
    Octets,
    Decimals,
}

/// Variants of a file.
#[derive(Clone, Debug)]
struct Style {
    has_header: bool,
    has_texture: bool,
    has_colours: bool,
    has_normals: bool,
    is_homogeneous: bool,
    dimension: Option<usize>,
    is_binary: bool,
    colours: ColourStyle,
    has_alpha: bool,
    line_end: &'static str,
    /// Put between words, where a line may end.
    gaps: Vec<&'static str>,
    is_glued: bool,
}

/// The scene that is written.
#[derive(Clone, Debug)]
struct SceneModel {
    vertices: Vec<[f64; 3]>,
    faces: Vec<Vec<u32>>,
    /// Numbers from 0 to 255 for each face.
    colours: Vec<[u8; 4]>,
}

fn styles() -> impl Strategy<Value = Style> {
    let gap = prop::sample::select(vec![" ", "  ", "\t", " \n", "\n\n", " # a comment\n", "\n#7 8 9\n \t"]);
    let flags = (any::<[bool; 8]>(), prop::option::of(1..6_usize));
    let colours =
        prop::sample::select(vec![ColourStyle::None, ColourStyle::Index, ColourStyle::Octets, ColourStyle::Decimals]);
    let line_end = prop::sample::select(vec!["\n", "\r\n", "\r", " \n", "# comment\n", "\n\n"]);
    (flags, colours, line_end, prop::collection::vec(gap, 1..20)).prop_map(
        |(([a, b, c, d, e, f, g, h], dimension), colours, line_end, gaps)| {
            let is_plain = !(a || b || c || d || e) && dimension.is_none();
            Style {
                has_header: !(is_plain && f),
                has_texture: a,
                has_colours: b,
                has_normals: c,
                is_homogeneous: d,
                dimension,
                is_binary: e,
                colours,
                has_alpha: g,
                line_end,
                gaps,
                is_glued: h,
            }
        },
    )
}

fn models() -> impl Strategy<Value = SceneModel> {
    let vertices = prop::collection::vec([-1000.0..1000.0_f64, -1e-3..1e-3, -1e6..1e6], 1..12);
    vertices.prop_flat_map(|vertices| {
        let corner = 0..vertices.len() as u32;
        let face = (prop::collection::vec(corner, 0..7), any::<[u8; 4]>());
        (Just(vertices), prop::collection::vec(face, 0..10)).prop_map(|(vertices, faces)| {
            let (faces, colours) = faces.into_iter().unzip();
            SceneModel { vertices, faces, colours }
        })
    })
}

/// Everything a vertex has in this style, its position first.
fn row(style: &Style, n: usize, position: [f64; 3]) -> Vec<f64> {
    // Powers of two divide without rounding.
    let divisor = [1.0, 2.0, -0.5, 4.0][n % 4];
    let scale = if style.is_homogeneous { divisor } else { 1.0 };
    let mut row: Vec<f64> =
        (0..style.dimension.unwrap_or(3)).map(|k| *position.get(k).unwrap_or(&9.0) * scale).collect();
    if style.is_homogeneous {
        row.push(divisor);
    }
    let extra = [(style.has_normals, 3), (style.has_colours, 4), (style.has_texture, 2)];
    row.extend(extra.iter().filter(|(has, _)| *has).flat_map(|(_, count)| vec![0.25; *count]));
    row
}

fn keyword(style: &Style) -> String {
    let part = |has: bool, text: &'static str| if has { text } else { "" };
    format!(
        "{}{}{}{}{}OFF",
        part(style.has_texture, "ST"),
        part(style.has_colours, "C"),
        part(style.has_normals, "N"),
        part(style.is_homogeneous, "4"),
        part(style.dimension.is_some(), "n")
    )
}

fn text(style: &Style, model: &SceneModel) -> Vec<u8> {
    let mut text = String::new();
    let mut gaps = style.gaps.iter().cycle();
    let mut gap = |text: &mut String| text.push_str(gaps.next().unwrap());
    if style.has_header {
        text.push_str(&keyword(style));
        if !(style.is_glued && style.dimension.is_none()) {
            gap(&mut text);
        }
    }
    if let Some(dimension) = style.dimension {
        write!(text, "{dimension}").unwrap();
        gap(&mut text);
    }
    write!(text, "{}", model.vertices.len()).unwrap();
    gap(&mut text);
    // The number of edges stands on the line of the number of faces: alone on a line it may look like a vertex.
    write!(text, "{} 0", model.faces.len()).unwrap();
    text.push_str(style.line_end);
    for (n, &vertex) in model.vertices.iter().enumerate() {
        for number in row(style, n, vertex) {
            if n % 2 == 0 { write!(text, "{number}") } else { write!(text, "{number:e}") }.unwrap();
            // With line breaks, three and four colour components cannot be told apart.
            if style.has_colours { text.push(' ') } else { gap(&mut text) }
        }
        text.push_str(style.line_end);
    }
    for (face, colour) in model.faces.iter().zip(&model.colours) {
        write!(text, "{}", face.len()).unwrap();
        for corner in face {
            gap(&mut text);
            write!(text, "{corner}").unwrap();
        }
        let components = if style.has_alpha { &colour[..] } else { &colour[..3] };
        match style.colours {
            ColourStyle::None => {}
            ColourStyle::Index => write!(text, " {}", colour[0]).unwrap(),
            ColourStyle::Octets => components.iter().for_each(|c| write!(text, " {c}").unwrap()),
            ColourStyle::Decimals => {
                components.iter().for_each(|c| write!(text, " {:?}", f64::from(*c) / 256.0).unwrap())
            }
        }
        text.push_str(style.line_end);
    }
    text.into_bytes()
}

fn binary(style: &Style, model: &SceneModel) -> Vec<u8> {
    let mut out = format!("{} BINARY\n", keyword(style)).into_bytes();
    let whole = |out: &mut Vec<u8>, number: usize| out.extend((number as u32).to_be_bytes());
    let real = |out: &mut Vec<u8>, number: f64| out.extend((number as f32).to_be_bytes());
    if let Some(dimension) = style.dimension {
        whole(&mut out, dimension);
    }
    [model.vertices.len(), model.faces.len(), 0].iter().for_each(|&count| whole(&mut out, count));
    for (n, &vertex) in model.vertices.iter().enumerate() {
        row(style, n, vertex).iter().for_each(|&number| real(&mut out, number));
    }
    for (face, colour) in model.faces.iter().zip(&model.colours) {
        whole(&mut out, face.len());
        face.iter().for_each(|&corner| whole(&mut out, corner as usize));
        let count = match style.colours {
            ColourStyle::None => 0,
            ColourStyle::Index => 1,
            _ => 3 + usize::from(style.has_alpha),
        };
        whole(&mut out, count);
        let number = |c: u8| if style.colours == ColourStyle::Index { f64::from(c) } else { f64::from(c) / 256.0 };
        colour[..count].iter().for_each(|&c| real(&mut out, number(c)));
    }
    out
}

/// Directed edges that do not cancel.
fn outline(polygons: &[Vec<u32>]) -> BTreeMap<(u32, u32), i32> {
    let mut edges = BTreeMap::new();
    for polygon in polygons {
        for n in 0..polygon.len() {
            let (a, b) = (polygon[n], polygon[(n + 1) % polygon.len()]);
            *edges.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
        }
    }
    edges.retain(|&(a, b), count| a != b && *count != 0);
    edges
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, rng_seed: RngSeed::Fixed(2), ..ProptestConfig::default() })]

    #[test]
    fn any_style_reads_back(style in styles(), model in models()) {
        let bytes = if style.is_binary { binary(&style, &model) } else { text(&style, &model) };
        let shown = String::from_utf8_lossy(&bytes).into_owned();
        let mesh = off::parse(&bytes, "f.off").map_err(|report| TestCaseError::fail(format!("{report}\n{shown}")))?;

        // Positions: binary files hold single precision; of more than three coordinates the first three count, missing ones are 0
        let stored = |x: f64| if style.is_binary { f64::from(x as f32) } else { x };
        let kept = style.dimension.unwrap_or(3);
        for (&read, &written) in mesh.vertices.iter().zip(&model.vertices) {
            let expected = [0, 1, 2].map(|k| if k < kept { stored(written[k]) } else { 0.0 });
            prop_assert_eq!(read, expected, "{}", shown);
        }
        prop_assert_eq!(mesh.vertices.len(), model.vertices.len());

        // Faces: a cut into triangles keeps the outline, since the two directions of an edge within it cancel
        let drawn: Vec<usize> = (0..model.faces.len()).filter(|&n| model.faces[n].len() >= 3).collect();
        prop_assert_eq!(mesh.faces, drawn.len());
        let mut triangles = mesh.triangles.iter().zip(mesh.surfaces.iter().map(Some).chain(std::iter::repeat(None)));
        for &n in &drawn {
            let face = &model.faces[n];
            let own: Vec<_> = triangles.by_ref().take(face.len() - 2).collect();
            let corners: Vec<Vec<u32>> = own.iter().map(|(corners, _)| corners.to_vec()).collect();
            prop_assert_eq!(outline(&corners), outline(std::slice::from_ref(face)), "{}", shown);
            // Colours: a single whole number above 1, in a face that is drawn, makes all whole numbers of the file 0..255
            let rgb = [0, 1, 2].map(|k| f64::from(model.colours[n][k]));
            let is_octet = drawn.iter().any(|&n| model.colours[n][..3].iter().any(|&c| c > 1));
            for (_, surface) in own {
                let colour = surface.map(|&surface| mesh.materials[surface as usize].colour);
                match style.colours {
                    ColourStyle::None => prop_assert_eq!(colour, None),
                    ColourStyle::Index => prop_assert!(colour.is_some()),
                    ColourStyle::Octets if style.is_binary => prop_assert_eq!(colour, Some(rgb.map(|c| c / 256.0))),
                    ColourStyle::Octets if is_octet => prop_assert_eq!(colour, Some(rgb.map(|c| c / 255.0))),
                    ColourStyle::Octets => prop_assert_eq!(colour, Some(rgb)),
                    ColourStyle::Decimals => prop_assert_eq!(colour, Some(rgb.map(|c| c / 256.0))),
                }
            }
        }
        prop_assert!(triangles.next().is_none());
    }
}

/// Every small file of the tests.
fn seeds(folders: &[&str]) -> Vec<Vec<u8>> {
    let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files");
    let entries = folders.iter().flat_map(|folder| fs::read_dir(files.join(folder)).unwrap());
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths.iter().map(|path| fs::read(path).unwrap()).collect()
}

/// Reads octets as both formats; what is read must hold together, what is refused must say why.
fn survives(bytes: &[u8]) {
    match off::parse(bytes, "f.off") {
        Ok(mesh) => {
            assert!(mesh.vertices.iter().flatten().all(|x| x.is_finite()));
            assert!(mesh.triangles.iter().flatten().all(|&n| (n as usize) < mesh.vertices.len()));
            assert!(mesh.surfaces.is_empty() || mesh.surfaces.len() == mesh.triangles.len());
            assert!(mesh.surfaces.iter().all(|&n| (n as usize) < mesh.materials.len()));
            assert!(mesh.materials.iter().flat_map(|m| m.colour).all(|c| (0.0..=1.0).contains(&c)));
            assert!(!mesh.warnings.has_errors());
            assert!(mesh.triangles.len() <= bytes.len());
        }
        Err(report) => {
            assert!(report.has_errors());
            assert!(report.to_string().starts_with("error") || report.to_string().starts_with("warning"));
        }
    }
    match dsc::parse(&Source::new("f.dsc", String::from_utf8_lossy(bytes))) {
        Ok(read) => {
            assert!(read.surfaces.iter().all(|&n| (n as usize) < read.materials.len()));
            assert!(read.materials.iter().flat_map(|m| m.colour).all(|c| (0.0..=1.0).contains(&c)));
            assert!(!read.warnings.has_errors());
        }
        Err(report) => {
            assert!(report.has_errors());
            assert!(!report.to_string().is_empty());
        }
    }
}

#[test]
fn no_beginning_of_a_file_is_fatal() {
    for bytes in seeds(&["off_good", "dsc_good", "pairs"]) {
        (0..bytes.len()).for_each(|end| survives(&bytes[..end]));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, rng_seed: RngSeed::Fixed(3), ..ProptestConfig::default() })]

    #[test]
    fn no_damage_to_a_file_is_fatal(
        seed in prop::sample::select(seeds(&["off_good", "off_bad", "dsc_good", "dsc_bad"])),
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0..4_u8, any::<u8>()), 1..8),
    ) {
        let mut bytes = seed;
        let likely = b"0123456789.-+eE \n\r\t#OFFBINARYnanSTC4,";
        for (index, edit, octet) in edits {
            let at = index.index(bytes.len() + 1);
            match edit {
                0 => bytes.insert(at, octet),
                1 => bytes.insert(at, likely[octet as usize % likely.len()]),
                2 if at < bytes.len() => { bytes.remove(at); }
                3 if at < bytes.len() => bytes[at] = likely[octet as usize % likely.len()],
                _ => bytes.truncate(at),
            }
        }
        survives(&bytes);
    }

    #[test]
    fn no_octets_are_fatal(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        survives(&bytes);
        let mut binary = b"STCN4nOFF BINARY\n".to_vec();
        binary.extend(&bytes);
        survives(&binary);
    }
}
