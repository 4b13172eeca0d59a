//! Logs of rays against the pictures whose colours they explain, and against geometry in scene units.

use super::*;
use crate::generate::{self, GenerateOptions};
use crate::vector::{add, scale};

/// Scene of a generator, far from the origin and large, where local coordinates and scene units differ most.
fn moved(name: &str) -> Scene {
    let mut scene = generate::scene(name, &GenerateOptions { size: (8, 6), ..GenerateOptions::default() })
        .expect("it is generated");
    let away = |p: Vec3| [96.0 * p[0] + 1000.0, 96.0 * p[1] - 500.0, 96.0 * p[2] + 250.0];
    scene.vertices.iter_mut().for_each(|vertex| *vertex = away(*vertex));
    scene.lights.iter_mut().for_each(|light| light.position = away(light.position));
    scene
}

#[test]
fn a_log_explains_the_colour_and_the_counts_of_its_pixel() {
    for name in ["cornell", "mirrors", "slabs"] {
        let scene = moved(name);
        let view = View { background: [0.25, 0.5, 0.125], ..View::new(scene.size) };
        let reference = Reference::new(&scene, &view, SearchMethod::Hierarchy).unwrap();
        let (mut hits, mut blocked, mut children) = (0, 0, 0);
        for (c, r) in (0..8).flat_map(|c| (0..6).map(move |r| (c, r))) {
            let ((colour, counts), (explained, rays)) = (reference.pixel(c, r, None), reference.explain(c, r, None));
            let sum = rays.iter().fold([0.0; 3], |sum, ray| add(sum, scale(ray.colour, ray.weight)));
            assert_eq!((explained, sum), (colour, colour), "{name} {c},{r}");
            let of = |kind: RayKind| rays.iter().filter(|ray| ray.kind == kind).count() as u64;
            assert_eq!((of(RayKind::Camera), counts.camera), (1, 1));
            assert_eq!((of(RayKind::Reflected), of(RayKind::Refracted)), (counts.reflected, counts.refracted));
            assert_eq!(rays.iter().map(|ray| ray.lights.len() as u64).sum::<u64>(), counts.shadow);
            for ray in &rays {
                let Some(hit) = ray.hit else {
                    assert_eq!((ray.colour, ray.lights.len()), (view.background, 0));
                    continue;
                };
                // The point lies at t along the ray, and at u and v between the triangle's vertices.
                let [p, q, s] = scene.triangles[hit.triangle as usize].vertices.map(|v| scene.vertices[v as usize]);
                let between = add(p, add(scale(sub(q, p), hit.u), scale(sub(s, p), hit.v)));
                for (point, what) in [(add(ray.origin, scale(ray.direction, hit.t)), "t"), (between, "u and v")] {
                    assert!(largest(sub(point, hit.point)) < 1e-5, "{name} {c},{r} {what}: {point:?} {hit:?}");
                }
                hits += 1;
                blocked += ray.lights.iter().filter(|light| light.blocker.is_some()).count();
                children += usize::from(ray.level > 0);
            }
        }
        assert!(hits > 10 && (blocked > 0 || name == "slabs"), "{name}: {hits} hits, {blocked} lights hidden");
        assert!(children > 0, "{name} has secondary rays");
    }
}
