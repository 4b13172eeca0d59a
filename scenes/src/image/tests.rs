//! Images of small scenes, octet by octet and read back.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::*;
use crate::model::{Camera, Light, Material, Triangle};

const MATT: Material = Material { colour: [1.0, 0.5, 0.25], reflection: 0.0, intensity: 0.9, index: 0.0 };
const GLASS: Material = Material { colour: [0.0; 3], reflection: 0.125, intensity: 0.125, index: 1.5 };

fn scene(vertices: &[Vec3]) -> Scene {
    let count = vertices.len() as u32 / 3;
    Scene {
        name: "test".into(),
        size: (4, 3),
        materials: vec![MATT, GLASS],
        lights: vec![Light { position: [0.25, 0.5, 0.75], colour: [1.0, 0.5, 0.25] }],
        vertices: vertices.to_vec(),
        triangles: (0..count).map(|k| Triangle { vertices: [3 * k, 3 * k + 1, 3 * k + 2], material: k % 2 }).collect(),
    }
}

fn options(layout: Layout, word: u32) -> MemoryOptions {
    MemoryOptions { layout, word, ..MemoryOptions::default() }
}

fn image(scene: &Scene, layout: Layout, word: u32) -> MemoryImage {
    build(scene, &View::new(scene.size), &options(layout, word)).unwrap_or_else(|report| panic!("{report}"))
}

/// From -1 to 1 on all axes.
const TWO: [Vec3; 6] =
    [[-1.0, -1.0, -1.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 1.0, 1.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.5]];

fn words(image: &MemoryImage, address: u32, count: usize) -> Vec<u32> {
    let octets = &image.bytes[address as usize..][..4 * count];
    octets.chunks(4).map(|c| u32::from_le_bytes(c.try_into().unwrap())).collect()
}

#[test]
fn a_small_wide_image_is_this() {
    // One unit is 2^29 raw: the box is 2^30 wide. Two triangles never pay for a division.
    let image = image(&scene(&TWO), Layout::Wide, 32);
    let unit = 1u32 << 29;
    assert_eq!((image.formats.position, image.root), (29, 16));
    assert_eq!(image.bounds, Bounds { low: [-(1 << 29) - 1; 3], high: [(1 << 29) + 1; 3] });
    assert_eq!(words(&image, 0, 4), [0; 4]);
    // The root is a leaf of 2; its references are at 24, the triangles at 32 and 70.
    assert_eq!(words(&image, 16, 4), [2, 24 | 3, 32, 70]);
    let minus = unit.wrapping_neg();
    assert_eq!(words(&image, 32, 9), [minus, minus, minus, unit, minus, 0, 0, unit, 0]);
    assert_eq!(image.bytes[68..70], [0, 0]);
    assert_eq!(image.bytes[106..108], [1, 0]);
    let weight = |x: f64| (x * (1u64 << 30) as f64) as u32;
    let glass = image.region(MemoryKind::Materials).start + 32;
    let index = [1.5, 1.0 / 1.5].map(|x: f64| (x * (1u64 << 28) as f64).round() as u32);
    assert_eq!(words(&image, glass, 8), [0, 0, 0, weight(0.125), weight(0.125), weight(0.75), index[0], index[1]]);
    let colour = |x: f64| (x * (1u64 << 29) as f64) as u32;
    let light = image.region(MemoryKind::Lights).start;
    assert_eq!(words(&image, light, 6), [unit / 4, unit / 2, unit / 4 * 3, colour(1.0), colour(0.5), colour(0.25)]);
    assert_eq!(image.region(MemoryKind::Frame).len(), 4 * 3 * 12);
    assert_eq!(image.bytes.len(), image.region(MemoryKind::Frame).end as usize);
    assert_eq!(image.ambient, (0.1 * (1u64 << 29) as f64).round() as i32);
}

#[test]
fn a_small_report_image_is_this() {
    let image = image(&scene(&TWO), Layout::Report, 32);
    // 2^29 raw is stored as 2^13 = 0x2000, one unit more is 0x2001.
    let node = [
        0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 72, 0, 0, 0, 2, 0, //
        0xff, 0xdf, 0xff, 0xdf, 0xff, 0xdf, 0x01, 0x20, 0x01, 0x20, 0x01, 0x20, //
        0xff, 0xdf, 0xff, 0xdf, 0xff, 0xdf, 0x01, 0x20, 0x01, 0x20, 0x01, 0x20, //
        0xff, 0xdf, 0xff, 0xdf, 0xff, 0xdf, 0x01, 0x20, 0x01, 0x20, 0x01, 0x20, 0,
    ];
    assert_eq!(image.bytes[16..71], node);
    assert_eq!(image.bounds.high, [0x2001 << 16; 3]);
    // References at 72 and 80; triangles at 88 and 119.
    assert_eq!(words(&image, 72, 4), [88, 80, 119, 0]);
    let triangle = [
        0x00, 0xe0, 0x00, 0xe0, 0x00, 0xe0, 0x00, 0x20, 0x00, 0xe0, 0, 0, 0, 0, 0x00, 0x20, 0, 0, // vertices
        0x00, 0xe0, 0x00, 0xe0, 0x00, 0xe0, 0x00, 0x20, 0x00, 0x20, 0, 0, 0, // small, big, material
    ];
    assert_eq!(image.bytes[88..119], triangle);
}

#[test]
fn a_small_packed_image_is_this() {
    // In a word of 16 bits a unit is 2^13 raw, so that -1 to 1 takes 15 bits; a box of one leaf has a plane of 3 bits, which is its count of 2.
    let image = image(&scene(&TWO), Layout::Packed, 16);
    let StructureSet { node, reference, triangle, material, light, .. } = &image.structures;
    let [plane, link] = [node.fields[0].bits, node.fields[1].bits];
    assert_eq!((image.formats.position, plane, link, node.octets()), (13, 3, 7, 2));
    // The root is node 8, named 64; its references begin at 24, which is 3 in units of 8, and the tag is 3: 2 and 1111 are 0111 1010.
    assert_eq!((image.root, image.bytes[16]), (64, 0b0111_1010));
    // 9 coordinates of 15 bits are 17 octets, and one more has the material: triangles begin at 72 = 4 x 18, and are numbers 4 and 5.
    assert_eq!((triangle.octets(), image.region(MemoryKind::Triangles), reference.fields[0].bits), (18, 72..108, 3));
    assert_eq!(image.bytes[24], 5 << 3 | 4);
    // -2^13 three times, from the lowest bit up: 0x6000 + (0x6000 << 15) + (0x6000 << 30).
    let minus = 0x6000u64;
    let first: [u8; 8] = image.bytes[72..80].try_into().unwrap();
    assert_eq!(u64::from_le_bytes(first) & ((1 << 45) - 1), minus | minus << 15 | minus << 30);
    assert_eq!((image.bytes[72 + 17], image.bytes[90 + 17]), (0, 1));
    // Weights of 1 take 16 bits, and the largest colour of the light 14 and the sign.
    assert_eq!((material.octets(), light.octets()), (16, 12));
}

#[test]
fn regions_are_in_order_and_addresses_have_a_kind() {
    for layout in Layout::ALL {
        let image = image(&scene(&TWO), layout, 32);
        let ranges: Vec<_> = image.regions.iter().map(|(_, range)| range.clone()).collect();
        assert!(ranges.windows(2).all(|pair| pair[0].end <= pair[1].start && pair[1].start % 8 == 0));
        assert_eq!(
            (image.kind(0), image.kind(15), image.kind(16)),
            (Some(MemoryKind::Header), Some(MemoryKind::Header), Some(MemoryKind::Nodes))
        );
        assert_eq!(image.kind(image.bytes.len() as u32), None);
        for kind in MemoryKind::ALL {
            assert!(image.region(kind).all(|address| image.kind(address) == Some(kind)));
        }
    }
}

/// Small triangles scattered in a box, some flat, some sharing coordinates.
fn triangles() -> impl Strategy<Value = Vec<Vec3>> {
    let corner = prop::array::uniform3(-20i32..20);
    let sides = prop::array::uniform2(prop::array::uniform3(-3i32..4));
    prop::collection::vec((corner, sides), 0..60).prop_map(|all| {
        let triangle = |(a, [b, c]): ([i32; 3], [[i32; 3]; 2])| {
            [[0; 3], b, c].map(|d| [0, 1, 2].map(|k| f64::from(a[k] + d[k]) / 7.0))
        };
        all.into_iter().flat_map(triangle).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn what_is_stored_is_read_back(vertices in triangles(), word in 14u32..=32, layout in prop::sample::select(&Layout::ALL[..])) {
        let scene = scene(&vertices);
        let Ok(image) = build(&scene, &View::new((4, 3)), &options(layout, word)) else { return Ok(()) };
        let contents = image.decode().expect("the image is whole");
        prop_assert_eq!(contents.tree.statistics(), image.tree);
        prop_assert_eq!(contents.tree.nodes().next().map(|root| root.bounds), Some(image.bounds));
        let unit = 1 << layout.coordinate_shift(word);
        for (stored, triangle) in contents.triangles.iter().zip(&scene.triangles) {
            prop_assert_eq!(stored.material, triangle.material);
            for (raw, &vertex) in stored.vertices.iter().zip(&triangle.vertices) {
                let exact = image.grid.local(scene.vertices[vertex as usize]);
                prop_assert!((0..3).all(|k| (f64::from(raw[k]) - exact[k]).abs() <= 0.5 + f64::from(unit) / 2.0));
                prop_assert!(raw.iter().all(|x| x % unit == 0), "stored coordinates are whole units");
                prop_assert!((0..3).all(|k| image.bounds.low[k] < raw[k] && raw[k] < image.bounds.high[k]));
            }
        }
        // The tree is the one of the triangles as they are stored.
        let vertices: Vec<_> = contents.triangles.iter().map(|t| t.vertices).collect();
        let tree = kdtree::build(&vertices, image.bounds, kdtree::Depth::default(), kdtree::BuildMethod::default());
        prop_assert_eq!(tree.unwrap(), contents.tree);
    }

    #[test]
    fn a_damaged_image_is_read_without_harm(vertices in triangles(), layout in prop::sample::select(&Layout::ALL[..]), damage in prop::collection::vec((any::<u32>(), any::<u8>()), 1..9)) {
        let mut image = image(&scene(&vertices), layout, 32);
        let length = image.region(MemoryKind::Triangles).end;
        for (at, octet) in damage {
            image.bytes[(at % length) as usize] = octet;
        }
        let _ = image.decode();
    }
}

#[test]
fn an_empty_scene_has_an_image() {
    let mut empty = scene(&[]);
    empty.lights.clear();
    empty.materials.clear();
    for layout in Layout::ALL {
        for camera in [Camera::Orthographic, Camera::Perspective { eye: None, look: None, field: 45.0 }] {
            let view = View { camera, ..View::new((4, 3)) };
            let image = build(&empty, &view, &options(layout, 32)).unwrap();
            assert_eq!(image.tree.nodes, 1);
            assert_eq!(image.decode().unwrap().tree.statistics(), image.tree);
        }
    }
}

#[test]
fn an_image_does_not_depend_on_the_scale_of_its_scene() {
    let plain = image(&scene(&TWO), Layout::Wide, 32);
    let mut large = scene(&TWO.map(|v| v.map(|x| x * 1024.0)));
    large.lights[0].position = large.lights[0].position.map(|x| x * 1024.0);
    let large = image(&large, Layout::Wide, 32);
    assert_eq!((large.formats.position, large.bytes == plain.bytes, large.camera), (19, true, plain.camera));
}

fn refusal(scene: &Scene, size: (u32, u32), options: &MemoryOptions) -> String {
    build(scene, &View::new(size), options).map(|_| ()).unwrap_err().render(false)
}

#[test]
fn what_cannot_be_stored_is_refused() {
    let wide = options(Layout::Wide, 32);
    let mut many = scene(&TWO);
    many.materials = vec![MATT; 257];
    let message = refusal(&many, (4, 3), &options(Layout::Report, 32));
    assert!(message.contains("257 materials are more than the 256 of layout `report`"), "{message}");
    assert!(build(&many, &View::new((4, 3)), &wide).is_ok());
    many.materials = vec![MATT; 65537];
    assert!(refusal(&many, (4, 3), &wide).contains("more than the 65536"));

    let mut dense = scene(&TWO);
    dense.materials[1].index = 8.0;
    let message = refusal(&dense, (4, 3), &wide);
    assert!(
        message.contains("the index of refraction of material 1 is 8") && message.contains("hold values below 8"),
        "{message}"
    );
    dense.materials[1].index = 0.1;
    assert!(refusal(&dense, (4, 3), &wide).contains("reciprocal of the index of refraction of material 1 is 10"));

    assert!(refusal(&scene(&TWO), (u32::MAX, u32::MAX), &wide).contains("32-bit addresses"));
    assert!(refusal(&scene(&TWO), (20_000, 20_000), &wide).contains("needs 4577 MiB"));

    let mut crowd = scene(&TWO);
    crowd.triangles = vec![crowd.triangles[0]; 65536];
    let message = refusal(&crowd, (4, 3), &options(Layout::Report, 32));
    assert!(message.contains("a leaf of 65536 triangles"), "{message}");
}
