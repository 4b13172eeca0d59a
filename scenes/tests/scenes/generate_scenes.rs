//! The generated scenes: how many triangles, the same on every run, closed where they should be, nothing crossing.

use std::collections::{BTreeMap, HashMap};

use scenes::generate::{self, GenerateOptions};
use scenes::model::{Scene, Vec3};

fn default(name: &str) -> Scene {
    generate::scene(name, &GenerateOptions::default()).unwrap()
}

fn with_triangles(count: u32) -> Scene {
    generate::scene("terrain", &GenerateOptions { triangles: Some(count), ..GenerateOptions::default() }).unwrap()
}

fn with_level(name: &str, level: u32) -> Scene {
    generate::scene(name, &GenerateOptions { level: Some(level), ..GenerateOptions::default() }).unwrap()
}

#[test]
fn the_scenes_and_their_sizes() {
    let sizes: Vec<String> = generate::SCENES
        .iter()
        .map(|generator| {
            let scene = default(generator.name);
            assert_eq!(scene.name, generator.name);
            assert_eq!(scene.size, (320, 240));
            format!("{}: {} triangles, {} lights", scene.name, scene.triangles.len(), scene.lights.len())
        })
        .collect();
    insta::assert_snapshot!(sizes.join("\n"));
}

#[test]
fn everything_is_in_range() {
    for generator in generate::SCENES {
        let scene = default(generator.name);
        let share = 0.0..=1.0;
        for triangle in &scene.triangles {
            assert!((triangle.material as usize) < scene.materials.len(), "{}", scene.name);
            assert!(triangle.vertices.iter().all(|&n| (n as usize) < scene.vertices.len()), "{}", scene.name);
        }
        for material in &scene.materials {
            assert!(material.colour.iter().all(|c| share.contains(c)), "{}", scene.name);
            assert!(share.contains(&(material.reflection + material.intensity)), "{}", scene.name);
            assert_eq!(material.index > 0.0, material.transmission() > 0.0, "{}: glass lets light through", scene.name);
        }
        assert!(scene.lights.iter().flat_map(|light| light.colour).all(|c| share.contains(&c)), "{}", scene.name);
        assert!(scene.vertices.iter().flatten().all(|x| x.is_finite()), "{}", scene.name);
    }
}

/// All bits of a scene in one number (FNV-1a).
fn fingerprint(scene: &Scene) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325;
    let mut take = |bits: u64| {
        for octet in bits.to_le_bytes() {
            hash = (hash ^ u64::from(octet)).wrapping_mul(0x100_0000_01b3);
        }
    };
    let materials = scene.materials.iter().flat_map(|m| {
        let [r, g, b] = m.colour;
        [r, g, b, m.reflection, m.intensity, m.index]
    });
    let lights = scene.lights.iter().flat_map(|light| light.position.into_iter().chain(light.colour));
    let vertices = scene.vertices.iter().flatten().copied();
    materials.chain(lights).chain(vertices).for_each(|x| take(x.to_bits()));
    for triangle in &scene.triangles {
        triangle.vertices.iter().chain([&triangle.material]).for_each(|&n| take(u64::from(n)));
    }
    hash
}

/// A change here changes every figure that is quoted for the scene.
#[test]
fn every_run_makes_the_same_scene() {
    let prints: Vec<String> =
        generate::SCENES.iter().map(|g| format!("{} {:016x}", g.name, fingerprint(&default(g.name)))).collect();
    insta::assert_snapshot!(prints.join("\n"));
}

#[test]
fn a_terrain_has_exactly_the_triangles_asked_for() {
    for count in (2..400).chain([999, 10_007, 60_000, 60_001, 88_000, 1_000_000]) {
        let scene = with_triangles(count);
        assert_eq!(scene.triangles.len(), count as usize);
        let (low, high) = scene.bounds().unwrap();
        assert!(high[0] > low[0] && high[1] > low[1] && high[2] > low[2], "{count}");
    }
}

#[test]
fn levels_make_scenes_finer() {
    for (name, level, triangles) in [
        ("cornell", 1, 46),
        ("cornell", 20, 4036),
        ("sphereflake", 0, 600),
        ("sphereflake", 1, 1320),
        ("sphereflake", 3, 17520),
        ("slabs", 1, 62),
        ("mirrors", 0, 382),
        ("slivers", 1, 26),
    ] {
        assert_eq!(with_level(name, level).triangles.len(), triangles, "{name} {level}");
    }
}

/// The parts of a scene that hang together by shared vertices, as lists of triangles.
fn parts(scene: &Scene) -> Vec<Vec<[u32; 3]>> {
    fn root(parent: &mut [u32], mut n: u32) -> u32 {
        while parent[n as usize] != n {
            parent[n as usize] = parent[parent[n as usize] as usize];
            n = parent[n as usize];
        }
        n
    }
    let mut parent: Vec<u32> = (0..scene.vertices.len() as u32).collect();
    for triangle in &scene.triangles {
        let [a, b, c] = triangle.vertices.map(|n| root(&mut parent, n));
        parent[b as usize] = a;
        let c = root(&mut parent, c);
        let a = root(&mut parent, a);
        parent[c as usize] = a;
    }
    let mut parts: BTreeMap<u32, Vec<[u32; 3]>> = BTreeMap::new();
    for triangle in &scene.triangles {
        parts.entry(root(&mut parent, triangle.vertices[0])).or_default().push(triangle.vertices);
    }
    parts.into_values().collect()
}

/// Edges that are not matched by the same edge in the other direction.
fn open_edges<Point: std::hash::Hash + Eq + Copy>(triangles: &[[Point; 3]]) -> Vec<(Point, Point)> {
    let mut count: HashMap<(Point, Point), i32> = HashMap::new();
    for [a, b, c] in triangles {
        for edge in [(*a, *b), (*b, *c), (*c, *a)] {
            *count.entry(edge).or_default() += 1;
        }
    }
    let matched = |&(a, b): &(Point, Point)| count[&(a, b)] == 1 && count.get(&(b, a)) == Some(&1);
    count.keys().filter(|edge| !matched(edge)).copied().collect()
}

fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[test]
fn solids_are_closed_and_face_outwards() {
    for (name, solids, others) in
        [("cornell", 3, 5), ("sphereflake", 91, 1), ("slabs", 5, 1), ("mirrors", 8, 4), ("slivers", 1, 9)]
    {
        let scene = default(name);
        let parts = parts(&scene);
        let (closed, open): (Vec<_>, Vec<_>) = parts.iter().partition(|part| open_edges(part).is_empty());
        assert_eq!((closed.len(), open.len()), (solids, others), "{name}");
        for part in closed {
            let centre = scene.vertices[part[0][0] as usize];
            let corner = |n: u32| sub(scene.vertices[n as usize], centre);
            let volume: f64 = part.iter().map(|t| dot(corner(t[0]), cross(corner(t[1]), corner(t[2]))) / 6.0).sum();
            assert!(volume > 0.0, "{name}: turned inside out");
        }
    }
}

#[test]
fn the_room_of_the_cornell_box_is_open_only_to_the_front() {
    let scene = default("cornell");
    let room = &scene.triangles[..scene.triangles.len() - 36];
    let by_place: Vec<[[u64; 3]; 3]> =
        room.iter().map(|t| t.vertices.map(|n| scene.vertices[n as usize].map(|x| (x + 0.0).to_bits()))).collect();
    let open = open_edges(&by_place);
    assert_eq!(open.len(), 4 * 8, "8 tiles on each side of the opening");
    assert!(open.iter().all(|(a, b)| f64::from_bits(a[2]) == 0.0 && f64::from_bits(b[2]) == 0.0));
}

/// The segment from p to q goes through the inside of a triangle.
fn pierces(p: Vec3, q: Vec3, [a, b, c]: [Vec3; 3]) -> bool {
    let volume = |x: Vec3, y: Vec3, z: Vec3, w: Vec3| dot(sub(y, x), cross(sub(z, x), sub(w, x)));
    let (from, to) = (volume(a, b, c, p), volume(a, b, c, q));
    if from * to >= 0.0 {
        return false;
    }
    let sides = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    sides.iter().all(|&s| s > 0.0) || sides.iter().all(|&s| s < 0.0)
}

#[test]
fn no_two_surfaces_cross() {
    for name in ["cornell", "sphereflake", "slabs", "mirrors"] {
        let scene = default(name);
        let corners: Vec<[Vec3; 3]> =
            scene.triangles.iter().map(|t| t.vertices.map(|n| scene.vertices[n as usize])).collect();
        let boxes: Vec<(Vec3, Vec3)> = corners
            .iter()
            .map(|t| {
                let side = |pick: fn(f64, f64) -> f64| [0, 1, 2].map(|k| pick(pick(t[0][k], t[1][k]), t[2][k]));
                (side(f64::min), side(f64::max))
            })
            .collect();
        for (n, first) in corners.iter().enumerate() {
            for (m, second) in corners.iter().enumerate() {
                let apart = (0..3).any(|k| boxes[n].1[k] < boxes[m].0[k] || boxes[m].1[k] < boxes[n].0[k]);
                let touches = first.iter().any(|p| second.contains(p));
                if !apart && !touches {
                    let crosses = (0..3).any(|k| pierces(first[k], first[(k + 1) % 3], *second));
                    assert!(!crosses, "{name}: triangles {n} and {m}");
                }
            }
        }
    }
}

#[test]
fn wrong_options_are_explained() {
    let size = |width, height| GenerateOptions { size: (width, height), ..GenerateOptions::default() };
    let level = |level| GenerateOptions { level: Some(level), ..GenerateOptions::default() };
    let triangles = |triangles| GenerateOptions { triangles: Some(triangles), ..GenerateOptions::default() };
    let cases = [
        ("cornel", GenerateOptions::default()),
        ("teapot", GenerateOptions::default()),
        ("cornell", size(0, 240)),
        ("cornell", level(0)),
        ("sphereflake", level(99)),
        ("terrain", triangles(1)),
        ("terrain", level(3)),
        ("slabs", triangles(12)),
    ];
    let messages: Vec<String> =
        cases.iter().map(|(name, options)| generate::scene(name, options).unwrap_err().to_string()).collect();
    insta::assert_snapshot!(messages.join("\n\n"));
}
