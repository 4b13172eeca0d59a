//! Pictures whose colours can be worked out by hand, and the hierarchy of boxes against trying all triangles.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::search::Hit;
use super::triangle::ShearedRay;
use super::whitted::{reflected, refracted};
use super::*;
use crate::generate;
use crate::model::{Camera, Light, Material};
use crate::vector::{dot, unit};

const RED: Material = Material { colour: [0.8, 0.2, 0.1], reflection: 0.0, intensity: 0.5, index: 0.0 };
const MIRROR: Material = Material { colour: [0.1; 3], reflection: 0.75, intensity: 0.25, index: 0.0 };
const GLASS: Material = Material { colour: [0.5, 1.0, 0.25], reflection: 0.125, intensity: 0.25, index: 1.5 };

/// Quadrilaterals as pairs of triangles.
fn scene(quads: &[([Vec3; 4], Material)], lights: &[Vec3]) -> Scene {
    let triangle = |vertices: [u32; 3], k: usize| crate::model::Triangle { vertices, material: k as u32 };
    Scene {
        name: "quads".into(),
        size: (1, 1),
        materials: quads.iter().map(|(_, material)| *material).collect(),
        lights: lights.iter().map(|&position| Light { position, colour: [1.0, 0.5, 0.25] }).collect(),
        vertices: quads.iter().flat_map(|(corners, _)| *corners).collect(),
        triangles: (0..quads.len())
            .flat_map(|k| {
                let v = 4 * k as u32;
                [triangle([v, v + 1, v + 2], k), triangle([v, v + 2, v + 3], k)]
            })
            .collect(),
    }
}

/// A square in the plane z, from -1 to 1, turned about the y axis by `angle`.
fn square(z: f64, angle: f64) -> [Vec3; 4] {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| [x * angle.cos(), y, z - x * angle.sin()])
}

/// The one pixel that looks from (x, 0.1, 5) along -z, a little off the diagonal of the squares.
fn look(scene: &Scene, x: f64, bounces: u32, background: Vec3) -> (Vec3, RayCounts) {
    let camera = Camera::Perspective { eye: Some([x, 0.1, 5.0]), look: Some([x, 0.1, 0.0]), field: 20.0 };
    let view = View { camera, bounces, background, ..View::new((1, 1)) };
    let both = [render(scene, &view).unwrap(), render_exhaustively(scene, &view).unwrap()];
    assert_eq!(both[0], both[1]);
    (both[0].picture.pixels[0], both[0].rays)
}

fn assert_near(found: Vec3, expected: Vec3) {
    assert!(largest(sub(found, expected)) < 1e-9, "{found:?} is not {expected:?}");
}

#[test]
fn a_matt_surface_shows_ambient_and_the_cosine_of_each_light() {
    let lights = [[0.2, 0.1, 3.0], [4.2, 0.1, 3.0], [0.2, 0.1, -2.0]];
    let (colour, rays) = look(&scene(&[(square(0.0, 0.0), RED)], &lights), 0.2, 5, [9.0; 3]);
    let cosines = 1.0 + 3.0 / 5.0;
    let lit = |k: usize| RED.colour[k] * (0.1 + 0.5 * cosines * [1.0, 0.5, 0.25][k]);
    assert_near(colour, [lit(0), lit(1), lit(2)]);
    assert_eq!(rays, RayCounts { camera: 1, reflected: 0, refracted: 0, shadow: 2 });
}

#[test]
fn anything_before_the_light_hides_it_and_nothing_behind_it_does() {
    let small = |z: f64| square(z, 0.0).map(|[x, y, z]| [x * 0.125 + 0.5, y * 0.125 + 0.5, z]);
    // From (0.2, 0.1, 0) to (0.8, 0.9, 2) the way passes (0.5, 0.5, 1) and leads on to (1.1, 1.3, 3).
    let light = [[0.8, 0.9, 2.0]];
    let floor = (square(0.0, 0.0), RED);
    let open = look(&scene(&[floor], &light), 0.2, 5, [0.0; 3]).0;
    for (blocker, is_hidden) in [(small(1.0), true), (small(3.0), false)] {
        let (colour, _) = look(&scene(&[floor, (blocker, GLASS)], &light), 0.2, 5, [0.0; 3]);
        assert_near(colour, if is_hidden { RED.colour.map(|c| c * 0.1) } else { open });
    }
}

#[test]
fn a_far_eye_sees_no_shadow_of_the_surface_on_itself() {
    let scene = scene(&[(square(0.0, 0.3), RED)], &[[0.2, 0.1, 3.0]]);
    for distance in [5.0, 1e3, 1e6] {
        let camera = Camera::Perspective {
            eye: Some([0.2, 0.1, distance]),
            look: Some([0.2, 0.1, 0.0]),
            field: 60.0 / distance,
        };
        let rendering = render(&scene, &View { camera, ..View::new((16, 16)) }).unwrap();
        assert_eq!(rendering.rays.shadow, 256);
        assert!(rendering.picture.pixels.iter().all(|colour| colour[0] > 0.3), "{distance}");
    }
}

#[test]
fn a_mirror_adds_what_it_reflects() {
    // A mirror at 45 degrees sends the ray along +x, at a wall in the plane x = 2.
    let wall = square(0.0, 0.0).map(|[x, y, _]| [2.0, y, x]);
    let scene = scene(&[(square(0.0, std::f64::consts::FRAC_PI_4), MIRROR), (wall, RED)], &[]);
    let own = MIRROR.colour.map(|c| c * 0.1);
    let (colour, rays) = look(&scene, 0.2, 5, [0.0; 3]);
    assert_near(colour, [0, 1, 2].map(|k| own[k] + 0.75 * 0.1 * RED.colour[k]));
    assert_eq!(rays, RayCounts { camera: 1, reflected: 1, refracted: 0, shadow: 0 });
    assert_near(look(&scene, 0.2, 0, [0.0; 3]).0, own);
}

#[test]
fn facing_mirrors_stop_at_the_number_of_bounces() {
    let mut scene = scene(&[(square(0.0, 0.0), MIRROR), (square(9.0, 0.0), MIRROR)], &[]);
    scene.materials[0].reflection = 0.5;
    for bounces in [0, 1, 2, 5, 100_000] {
        let (colour, rays) = look(&scene, 0.2, bounces, [0.0; 3]);
        let mut weight = 1.0;
        let mut sum = 0.0;
        for level in 0..=bounces {
            sum += weight * 0.01;
            weight *= if level % 2 == 0 { 0.5 } else { 0.75 };
        }
        assert_near(colour, [sum; 3]);
        // A weight of sqrt(0.375) a level is 0 after some 1500 levels.
        assert!(rays.reflected == u64::from(bounces) || bounces > 5 && rays.reflected > 1000, "{rays:?}");
    }
}

#[test]
fn a_pane_of_glass_passes_on_what_is_behind() {
    // Entering: local + ks * background + kt * (inside: local + ks * (inside again ...) + kt * background).
    let scene = scene(&[(square(0.5, 0.0), GLASS), (square(0.0, 0.0), GLASS)], &[]);
    let background = [0.25, 0.5, 1.0];
    let (ks, kt) = (0.125, 0.625);
    fn inside(levels: u32, local: f64, background: f64) -> f64 {
        if levels == 0 { local } else { local + 0.625 * background + 0.125 * inside(levels - 1, local, background) }
    }
    for bounces in 0..6 {
        let (colour, rays) = look(&scene, 0.2, bounces, background);
        let expected = [0, 1, 2].map(|k| {
            let local = GLASS.colour[k] * 0.1;
            if bounces == 0 {
                local
            } else {
                local + ks * background[k] + kt * inside(bounces - 1, local, background[k])
            }
        });
        assert_near(colour, expected);
        assert_eq!((rays.refracted, rays.reflected), (u64::from(bounces), u64::from(bounces)));
    }
}

#[test]
fn total_reflection_keeps_the_whole_light_inside() {
    // A prism: in through the front, at 45 degrees onto the back (beyond the critical angle, 41.8 degrees), out to the side.
    let front = square(2.0, 0.0);
    let back = square(1.0, std::f64::consts::FRAC_PI_4).map(|[x, y, z]| [1.5 * x, y, 1.0 + 1.5 * (z - 1.0)]);
    let side = square(0.0, 0.0).map(|[x, y, _]| [1.2, y, 1.0 + x]);
    let scene = scene(&[(front, GLASS), (back, GLASS), (side, GLASS)], &[]);
    let background = [0.25, 0.5, 1.0];
    let (ks, kt) = (0.125, 0.625);
    let (colour, rays) = look(&scene, 0.2, 3, background);
    // The ray that the side reflects comes back the same way to the back, at level 3.
    let expected = [0, 1, 2].map(|k| {
        let local = GLASS.colour[k] * 0.1;
        let at_side = local + kt * background[k] + ks * local;
        let at_back = local + (ks + kt) * at_side;
        local + ks * background[k] + kt * at_back
    });
    assert_near(colour, expected);
    assert_eq!(rays, RayCounts { camera: 1, reflected: 3, refracted: 2, shadow: 0 });
}

#[test]
fn nearest_hits_are_ordered_by_distance_then_by_number() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let triangle = |vertices| crate::model::Triangle { vertices, material: 0 };
    // Number 9 is nearer than all others, which are in one place; number 10 has no area.
    let mut triangles = vec![triangle([0, 1, 2]); 9];
    triangles.extend([triangle([3, 4, 5]), triangle([0, 1, 1])]);
    let vertices = corners.into_iter().chain(corners.map(|[x, y, _]| [x, y, 0.25])).collect();
    let shapes = Shapes { vertices, triangles: &triangles };
    let ray = ShearedRay::new([0.25, 0.25, 1.0], [0.0, 0.0, -1.0]);
    let of = |indices: &[u32]| {
        let found = Hierarchy::new(shapes.clone(), indices.to_vec()).nearest(&ray);
        assert_eq!(found, Exhaustive { shapes: shapes.clone(), indices: indices.to_vec() }.nearest(&ray));
        found
    };
    assert_eq!(of(&[5, 3, 7, 4, 6, 8]), Some(Hit { t: 1.0, index: 3 }));
    assert_eq!(of(&[5, 9, 3]), Some(Hit { t: 0.75, index: 9 }));
    assert_eq!(of(&[]), None);
    assert!(!shapes.visible().contains(&10), "no area, never hit");
}

/// A direction of length 1.
fn directions() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-1.0..1.0f64).prop_filter_map("a direction", unit)
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]
    #[test]
    fn mirrored_rays_leave_at_the_angle_of_incidence(direction in directions(), normal in directions()) {
        let normal = if dot(direction, normal) > 0.0 { normal.map(|x| -x) } else { normal };
        let mirrored = reflected(direction, normal);
        prop_assert!((dot(mirrored, mirrored) - 1.0).abs() < 1e-14);
        prop_assert!((dot(mirrored, normal) + dot(direction, normal)).abs() < 1e-14);
        let plane = crate::vector::cross(direction, normal);
        prop_assert!(dot(mirrored, plane).abs() < 1e-14);
    }

    #[test]
    fn refracted_rays_obey_snell(direction in directions(), normal in directions(), eta in 0.2..5.0f64) {
        let normal = if dot(direction, normal) > 0.0 { normal.map(|x| -x) } else { normal };
        let sine = |d: Vec3| { let c = crate::vector::cross(d, normal); dot(c, c).sqrt() };
        match refracted(direction, normal, eta) {
            None => prop_assert!(eta * sine(direction) > 1.0 - 1e-14),
            Some(onwards) => {
                prop_assert!((dot(onwards, onwards) - 1.0).abs() < 1e-12);
                prop_assert!((sine(onwards) - eta * sine(direction)).abs() < 1e-12);
                prop_assert!(dot(onwards, normal) <= 1e-7, "it goes on behind the surface");
                let plane = crate::vector::cross(direction, normal);
                prop_assert!(dot(onwards, plane).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_hierarchy_finds_what_trying_all_finds(
        corners in prop::collection::vec((prop::array::uniform3(-4i8..5), prop::array::uniform3(-2i8..3), prop::array::uniform3(-2i8..3)), 0..60),
        rays in prop::collection::vec((prop::array::uniform3(-5i8..6), prop::array::uniform3(-3i8..4)), 40),
        end in 0.0..10.0f64,
    ) {
        // Coordinates on few different values: edges, vertices, flat boxes and zero directions are met all the time.
        let quarter = |v: [i8; 3]| v.map(|x| f64::from(x) / 4.0);
        let vertices = corners.iter().flat_map(|&(a, b, c)| {
            let a = quarter(a);
            [a, crate::vector::add(a, quarter(b)), crate::vector::add(a, quarter(c))]
        }).collect();
        let triangles: Vec<crate::model::Triangle> = (0..corners.len() as u32)
            .map(|k| crate::model::Triangle { vertices: [3 * k, 3 * k + 1, 3 * k + 2], material: 0 })
            .collect();
        let shapes = Shapes { vertices, triangles: &triangles };
        let indices = shapes.visible();
        let trees = [60, 0].map(|most| Hierarchy::with_copies(shapes.clone(), indices.clone(), most));
        let all = Exhaustive { shapes, indices };
        for (origin, direction) in rays {
            let Some(direction) = unit(quarter(direction)) else { continue };
            let ray = ShearedRay::new(quarter(origin), direction);
            for tree in &trees {
                prop_assert_eq!(tree.nearest(&ray), all.nearest(&ray));
                prop_assert_eq!(tree.is_blocked(&ray, end), all.is_blocked(&ray, end));
            }
        }
    }
}

#[test]
fn generated_scenes_are_the_same_by_hierarchy_and_by_trying_all() {
    let mut seen = 0;
    for generator in generate::SCENES {
        let scene =
            generate::scene(generator.name, &generate::GenerateOptions { size: (32, 24), ..Default::default() })
                .unwrap();
        if scene.triangles.len() >= 3000 {
            continue;
        }
        seen += 1;
        for camera in [Camera::Orthographic, Camera::Perspective { eye: None, look: None, field: 45.0 }] {
            let view = View { camera, shift: [0.137, 0.071], ..View::new((32, 24)) };
            let (tree, all) = (render(&scene, &view).unwrap(), render_exhaustively(&scene, &view).unwrap());
            assert_eq!(tree, all, "{}", scene.name);
        }
    }
    assert!(seen >= 3, "{seen} scenes are small enough");
}

#[test]
fn a_picture_does_not_depend_on_the_size_and_place_of_its_scene() {
    let scene =
        generate::scene("cornell", &generate::GenerateOptions { size: (24, 18), ..Default::default() }).unwrap();
    let view = View { shift: [0.137, 0.071], ..View::new((24, 18)) };
    let plain = render(&scene, &view).unwrap();
    for power in [-1000, -10, 10, 1000] {
        let mut other = scene.clone();
        let points = other.vertices.iter_mut().chain(other.lights.iter_mut().map(|light| &mut light.position));
        for point in points {
            *point = point.map(|x| shifted(x, power));
        }
        assert_eq!(render(&other, &view).unwrap(), plain, "2^{power}");
    }
}

#[test]
fn empty_and_flat_scenes_are_rendered() {
    let view = View { background: [0.5; 3], ..View::new((4, 3)) };
    for scene in [scene(&[], &[]), scene(&[([[1e300; 3]; 4], RED)], &[])] {
        let rendering = render(&scene, &view).unwrap();
        assert_eq!(rendering.picture.pixels, vec![[0.5; 3]; 12]);
        assert_eq!(rendering, render_exhaustively(&scene, &view).unwrap());
    }
}

#[test]
fn pictures_that_cannot_be_are_refused() {
    let refusal = |view: &View| render(&scene(&[], &[]), view).unwrap_err().render(false);
    assert!(refusal(&View::new((0, 3))).contains("0 x 3"));
    assert!(refusal(&View::new((u32::MAX, u32::MAX))).contains("more than the reference renders"));
    let camera = Camera::Perspective { eye: Some([0.0; 3]), look: Some([0.0; 3]), field: 45.0 };
    assert!(refusal(&View { camera, ..View::new((4, 3)) }).contains("no direction"));
}
