//! Laws of any scene on its grid, and messages for one that does not fit.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::*;
use crate::model::{Camera, Light, Material, Triangle};

fn scene(vertices: Vec<Vec3>, lights: Vec<Vec3>) -> Scene {
    let material = Material { colour: [1.0; 3], reflection: 0.0, intensity: 1.0, index: 0.0 };
    let triangles = (0..(vertices.len() / 3) as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
    Scene {
        name: "test".into(),
        size: (8, 8),
        materials: vec![material],
        lights: lights.into_iter().map(|position| Light { position, colour: [1.0; 3] }).collect(),
        triangles: triangles.map(|vertices| Triangle { vertices, material: 0 }).collect(),
        vertices,
    }
}

fn perspective(eye: Option<Vec3>) -> View {
    View { camera: Camera::Perspective { eye, look: None, field: 45.0 }, ..View::new((8, 8)) }
}

/// All raw integers that come from a scene.
fn raws(scene: &Scene, view: &View, word: u32) -> Result<(Vec<[i32; 3]>, Bounds), Report> {
    let grid = Grid::new(scene, view, word, None)?;
    let lights = scene.lights.iter().map(|light| light.position);
    Ok((scene.vertices.iter().copied().chain(lights).map(|p| grid.raw(p)).collect(), grid.reach))
}

/// Coordinates with few enough bits that sums with whole steps are exact.
fn coordinate() -> impl Strategy<Value = f64> {
    (-(1i64 << 24)..1i64 << 24, 0..12).prop_map(|(n, shift)| shifted(n as f64, -20 + shift))
}

fn points(least: usize, most: usize) -> impl Strategy<Value = Vec<Vec3>> {
    prop::collection::vec(prop::array::uniform3(coordinate()), least * 3..=most * 3)
}

fn views() -> impl Strategy<Value = View> {
    prop_oneof![
        Just(View::new((8, 8))),
        Just(perspective(None)),
        prop::array::uniform3(coordinate()).prop_map(|eye| perspective(Some(eye))),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]
    #[test]
    fn a_scene_multiplied_by_a_power_of_two_has_the_same_integers(
        vertices in points(1, 5), lights in points(0, 1), view in views(), word in 16u32..=32, power in -900..900,
    ) {
        let times = |p: Vec3| p.map(|x| shifted(x, power));
        let scaled = scene(vertices.iter().copied().map(times).collect(), lights.iter().copied().map(times).collect());
        let scaled_view = View { camera: camera::mapped(&view.camera, times), ..view.clone() };
        let plain = raws(&scene(vertices, lights), &view, word);
        prop_assert_eq!(raws(&scaled, &scaled_view, word).ok(), plain.ok());
    }

    #[test]
    fn a_scene_moved_by_whole_steps_has_the_same_integers(
        vertices in points(1, 5), lights in points(0, 1), view in views(), word in 16u32..=32,
        steps in prop::array::uniform3(-100_000i32..100_000),
    ) {
        let plain = scene(vertices, lights);
        let Ok(grid) = Grid::new(&plain, &view, word, None) else { return Ok(()) };
        let moved = |p: Vec3| AXES.map(|k| p[k] + shifted(f64::from(steps[k]), -grid.position));
        let other = scene(
            plain.vertices.iter().copied().map(moved).collect(),
            plain.lights.iter().map(|light| moved(light.position)).collect(),
        );
        let other_view = View { camera: camera::mapped(&view.camera, moved), ..view.clone() };
        let grid = Grid::new(&other, &other_view, word, None).unwrap();
        prop_assert_eq!(raws(&other, &other_view, word).unwrap(), raws(&plain, &view, word).unwrap());
        prop_assert_eq!(grid.local_corners(), Grid::new(&plain, &view, word, None).unwrap().local_corners());
    }

    #[test]
    fn everything_fits_and_half_the_step_would_not(
        vertices in points(1, 5), lights in points(0, 2), view in views(), word in 8u32..=32,
    ) {
        let scene = scene(vertices, lights);
        let Ok(grid) = Grid::new(&scene, &view, word, None) else { return Ok(()) };
        let limit = (1i32 << (word - 2)) - 4;
        let most = |b: &Bounds| b.low.iter().chain(&b.high).map(|x| x.abs()).max().unwrap();
        prop_assert!(most(&grid.reach) <= limit);
        let longest = AXES.map(|k| grid.span[k]).into_iter().max().unwrap();
        let farthest = (1u32 << (word - 1)) - 8;
        prop_assert!(longest <= farthest);
        let is_finest = most(&grid.reach) >= limit / 2 - 1;
        let lights: Vec<GridLight> = scene.lights.iter().map(|light| grid.light(light.position)).collect();
        let is_near = |light: &GridLight| light.exponent == 0;
        // One bit less, where that makes all lights near.
        let is_finest = is_finest || (word == 32 && most(&grid.reach) >= limit / 4 - 1 && lights.iter().all(is_near));
        prop_assert!(is_finest, "a finer grid fits: {:?}, {longest}", grid.reach);
        for (light, on_grid) in scene.lights.iter().zip(&lights) {
            // Off by half a step of its own, and those are no longer than they have to be.
            let exact = grid.local(light.position).map(|x| shifted(x, -(on_grid.exponent as i32)));
            prop_assert!(AXES.iter().all(|&k| (exact[k] - f64::from(on_grid.position[k])).abs() <= 0.501), "{on_grid:?} for {exact:?}");
            let bounds = grid.bounds();
            let way = AXES.map(|k| {
                let end = |x: i32| (exact[k] - shifted(f64::from(x), -(on_grid.exponent as i32))).abs();
                end(bounds.low[k]).max(end(bounds.high[k]))
            });
            prop_assert!(largest(way) <= f64::from(farthest) + 1.0, "{way:?}");
            prop_assert!(is_near(on_grid) || largest(way) >= f64::from(farthest) / 2.0 - 2.0, "{on_grid:?}: {way:?}");
        }
        let ways = scene.lights.iter().filter(|light| is_near(&grid.light(light.position))).flat_map(|light| {
            let light = grid.raw(light.position);
            scene.triangles.iter().flat_map(|t| t.vertices).map(|v| grid.raw(scene.vertices[v as usize])).flat_map(move |v| {
                AXES.map(|k| (i64::from(light[k]) - i64::from(v[k])).unsigned_abs())
            }).collect::<Vec<_>>()
        });
        prop_assert!(ways.max().unwrap_or(0) <= longest.into());
        prop_assert!(Grid::new(&scene, &view, word, Some(grid.position + 2)).is_err());
        // The middle of the box is within one step of 0 on every axis, and the way back is within half a step.
        let bounds = grid.bounds();
        prop_assert!(AXES.iter().all(|&k| (i64::from(bounds.low[k]) + i64::from(bounds.high[k])).abs() <= 2));
        let size = scene.vertices.iter().map(|&vertex| largest(vertex)).fold(0.0, f64::max);
        for &vertex in &scene.vertices[..scene.triangles.len() * 3] {
            let back = grid.scene(grid.raw(vertex));
            let off = largest(sub(back, vertex));
            // The way there and back goes over the middle of the box, and is rounded as doubles of its size are.
            let slack = 1e-9 * grid.step() + shifted(size, -51);
            prop_assert!(off <= 0.5 * grid.step() + slack, "{vertex:?} {back:?}");
        }
    }

    #[test]
    fn short_words_use_what_a_box_leaves(vertices in points(2, 5), view in views(), word in 16u32..=32) {
        let scene = scene(vertices, vec![]);
        let Ok(grid) = Grid::new(&scene, &view, word, None) else { return Ok(()) };
        let plain = Grid::of_powers(&scene, &view, word, Some(grid.position)).unwrap();
        prop_assert_eq!(plain.stretch, 1.0);
        prop_assert!((1.0..2.1).contains(&grid.stretch), "{}", grid.stretch);
        if word == 32 || grid.stretch == 1.0 {
            prop_assert_eq!(&grid, &plain);
            return Ok(());
        }
        let (low, high) = grid.local_corners();
        let longest = largest(sub(high, low));
        let room = f64::from((1i32 << (word - 1)) - 8);
        match view.camera {
            Camera::Perspective { .. } => prop_assert!(longest > room - 4.0 && longest <= room, "{longest} of {room}"),
            Camera::Orthographic => {
                // A whole number of steps from sample to sample takes less than a step of each.
                let camera::Rays::Orthographic { pitch, .. } =
                    camera::Rays::new((low, high), &view).unwrap() else { unreachable!() };
                prop_assert!((pitch - pitch.round()).abs() < 1e-6 * pitch || longest > room - 4.0, "{pitch}");
                prop_assert!(longest > room * (1.0 - 1.0 / pitch) - 4.0 && longest <= room, "{longest} of {room}, {pitch}");
            }
        }
    }

    #[test]
    fn given_positions_use_what_their_bits_leave(
        vertices in points(2, 5), view in views(), word in 16u32..=32, fewer in 0i32..7, longer in 0u32..8,
    ) {
        let scene = scene(vertices, vec![]);
        let Ok(chosen) = Grid::new(&scene, &view, word, None) else { return Ok(()) };
        let position = Some(chosen.position - fewer);
        let Ok(given) = Grid::new(&scene, &view, word, position) else { return Ok(()) };
        prop_assert_eq!(Some(given.position), position);
        let powers = Grid::of_powers(&scene, &view, word, position).unwrap();
        if word == 32 || given.stretch == 1.0 {
            prop_assert_eq!(&given, &powers);
            return Ok(());
        }
        // As many bits as the powers of two take, and all of them; at most a 32nd longer where they take a few numbers more.
        let most = |b: &Bounds| b.low.iter().chain(&b.high).map(|x| x.abs()).max().unwrap();
        let bits = (5..=word).find(|bits| most(&powers.reach) <= 1 << (bits - 2)).unwrap();
        let room = (1 << (bits - 2)) - 4;
        prop_assert!(most(&given.reach) <= room && (0.96..2.1).contains(&given.stretch), "{given:?}");
        if let Camera::Perspective { .. } = view.camera {
            prop_assert!(most(&given.reach) >= room - 3, "{:?} of {room}", given.reach);
        }
        // The finest position that fills its word is what is chosen.
        prop_assert!(fewer > 0 || bits < word || chosen.stretch <= 1.0 || given == chosen, "{given:?} {chosen:?}");
        // The same integers in any word that has steps that fit.
        let other = (bits + longer).min(31);
        let Ok(other) = Grid::new(&scene, &view, other, position) else { return Ok(()) };
        for &vertex in &scene.vertices[..scene.triangles.len() * 3] {
            prop_assert_eq!(other.raw(vertex), given.raw(vertex));
        }
    }

    #[test]
    fn any_doubles_give_a_grid_or_a_message(
        bits in prop::collection::vec(prop::array::uniform3(any::<f64>()), 0..9),
        light in prop::array::uniform3(any::<f64>()), word in 0u32..40, position in prop::option::of(any::<i32>()),
    ) {
        let scene = scene(bits, vec![light]);
        for view in [View::new((8, 8)), perspective(None), perspective(Some(light))] {
            if let Ok(grid) = Grid::new(&scene, &view, word, position) {
                let limit = (1i32 << (word - 2)) - 4;
                let mut corners = scene.triangles.iter().flat_map(|t| t.vertices).flat_map(|v| grid.raw(scene.vertices[v as usize]));
                prop_assert!(corners.all(|x| x.abs() <= limit));
            }
        }
    }
}

fn refusal(scene: &Scene, view: &View, word: u32) -> String {
    Grid::new(scene, view, word, None).unwrap_err().render(false)
}

#[test]
fn a_plain_box_uses_its_word() {
    // From 1 to 3 on every axis: the centre is 2, and one unit is 2^12 of the 2^14 - 4 that a word of 16 bits has: 2^13 would be 8192 each.
    let grid =
        Grid::new(&scene(vec![[1.0; 3], [3.0; 3], [3.0, 1.0, 3.0]], vec![]), &View::new((8, 8)), 16, None).unwrap();
    assert_eq!((grid.position, grid.centre()), (13, [2.0; 3]));
    assert_eq!(grid.raw([2.5, 1.0, 3.00007]), [4096, -8192, 8193]);
    assert_eq!(grid.raw([1e9, -1e9, 2.0 + 0.5 / 8192.0]), [32767, -32768, 1], "saturated, and a tie goes up");
}

/// Strips side by side, `count` of them over a width of 8, as deep as a landscape.
fn strips(count: u32) -> Scene {
    let x = |column: u32| f64::from(column) * 8.0 / f64::from(count) - 4.024;
    let quads = (0..count).flat_map(|column| {
        let [a, b, c, d] = [(0, -2.4), (1, -2.4), (1, 2.5), (0, 2.5)].map(|(k, y)| [x(column + k), y, 2.0 * y]);
        [a, b, c, a, c, d]
    });
    scene(quads.collect(), vec![])
}

/// Samples of row 0 that stand on the wrong side of an edge between strips, when all numbers are those of a grid.
fn on_wrong_sides(count: u32, view: &View, options: &crate::image::MemoryOptions) -> usize {
    let scene = strips(count);
    let image = crate::image::build(&scene, view, options).unwrap();
    let camera::Rays::Orthographic { first, pitch, .. } = camera::Rays::new(scene.bounds().unwrap(), view).unwrap()
    else {
        unreachable!()
    };
    (0..view.size.0)
        .map(|column| {
            let sample = first[0] + f64::from(column) * pitch;
            let raw = image.camera.ray(column, 0, options.word).0.unwrap()[0];
            // On an edge a sample counts as beyond it.
            let is_wrong = |v: &&Vec3| (sample < v[0] - 1e-9) != (raw < image.grid.raw(**v)[0]);
            scene
                .vertices
                .iter()
                .filter(is_wrong)
                .map(|v| v[0].to_bits())
                .collect::<std::collections::HashSet<_>>()
                .len()
        })
        .sum()
}

#[test]
fn edges_along_columns_of_samples_keep_their_side() {
    // 150 strips and 320 columns: every 32 columns an edge is a 3,000th of a pixel beyond a sample, 0.44 of the steps that fit.
    let view = View { shift: [-0.367, -0.283], ..View::new((320, 240)) };
    let of = |word, position, direction| {
        let formats = crate::cadrage::Overrides { position, direction, ..Default::default() };
        on_wrong_sides(150, &view, &crate::image::MemoryOptions { word, formats, ..Default::default() })
    };
    assert_eq!((of(20, None, None), of(24, None, None)), (0, 0));
    let grid = Grid::new(&strips(150), &view, 20, None).unwrap();
    assert_eq!(of(28, Some(grid.position), None), 0, "these steps in a word that is longer");
    assert_eq!(of(32, Some(grid.position), None), 8, "steps of a power of two round both to the same number");
}

#[test]
fn a_given_position_fills_the_bits_that_it_takes() {
    // 5 wide: 320 steps of 2^-6, 160 on both sides of the middle, where a box of 10 bits has 252 and one of 9 has 124.
    let box_of_five = scene(vec![[0.0; 3], [5.0, 3.1, 0.0], [5.0, 0.0, 0.0]], vec![]);
    let of = |word, position| Grid::new(&box_of_five, &perspective(None), word, Some(position));
    let given = of(20, 6).unwrap();
    assert_eq!((given.position, given.bounds().side(0)), (6, 502), "320 steps are 2^-6, and 2 (2^8 - 4 - 1) are there");
    assert_eq!(of(31, 6).unwrap().raw([5.0, 3.1, 0.0]), given.raw([5.0, 3.1, 0.0]));
    assert_eq!(of(32, 6).unwrap().bounds().side(0), 320);
    // 8 wide, not on the grid: 256 steps of 2^-6 on both sides, of which a box of 10 bits has 252, so these are a little longer.
    let box_of_eight = scene(vec![[0.1; 3], [8.1, 3.1, 0.1], [5.0, 0.1, 0.1]], vec![]);
    let longer = Grid::new(&box_of_eight, &perspective(None), 20, Some(6)).unwrap();
    assert_eq!((longer.position, longer.reach.side(0)), (6, 502));
    assert!((0.98..1.0).contains(&longer.stretch), "{}", longer.stretch);
    assert!(of(20, 5).is_err_and(|report| report.render(false).contains("246 grid steps long")));
}

#[test]
fn coordinates_at_the_ends_of_double_precision_are_placed() {
    for size in [1e300, 1.7e308, 1e-300, 1e-308, 1e-320] {
        let corners = vec![[-size, -size, 0.0], [size, -size, size], [0.0, size, 0.0]];
        let (raw, _) = raws(&scene(corners, vec![[0.0, 0.0, size]]), &View::new((8, 8)), 32).unwrap();
        assert!((1 << 28..1 << 30).contains(&raw[1][0]) && raw[0][0] == -raw[1][0], "{size}: {raw:?}");
    }
}

#[test]
fn flat_single_and_empty_scenes_are_placed() {
    let view = View::new((8, 8));
    let (flat, _) = raws(&scene(vec![[0.0, 5.0, 5.0], [1.0, 5.0, 5.0], [0.5, 5.0, 7.0]], vec![]), &view, 32).unwrap();
    assert!(flat.iter().all(|p| p[1] == 0) && flat[1][0] > 1 << 27);
    for at in [[0.0; 3], [1e300, 1.0, -1e-300]] {
        let (point, _) = raws(&scene(vec![at; 3], vec![]), &view, 32).unwrap();
        assert_eq!(point, [[0; 3]; 3]);
    }
    let empty = Grid::new(&scene(vec![], vec![]), &view, 32, None).unwrap();
    assert_eq!((empty.raw([1.0; 3]), empty.bounds().low), ([1 << 29; 3], [-1 << 29; 3]));
}

#[test]
fn what_sets_the_scale_is_named_when_too_little_is_left() {
    let small = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 1.0]];
    // Neither a light nor an eye sets the scale: the former has steps of its own, and rays start where they enter the box.
    let near = scene(small.clone(), vec![]);
    for distance in [1e3, 1e9, 1e300] {
        let far_light = scene(small.clone(), vec![[0.0, 1.0, 2.0], [0.0, distance, 0.0]]);
        let [with, without] = [&far_light, &near].map(|scene| Grid::new(scene, &View::new((8, 8)), 32, None).unwrap());
        assert_eq!((with.position, with.reach), (without.position, without.reach));
        let light = with.light([0.0, distance, 0.0]);
        assert_eq!(i64::from(light.exponent), i64::from(exponent(distance)) - 1, "{light:?}");
    }
    let grid = |view: &View| Grid::new(&near, view, 24, None).ok();
    assert_eq!(grid(&perspective(Some([0.0, 0.0, 1e6]))), grid(&View::new((8, 8))));
    let coarse = Grid::new(&near, &View::new((8, 8)), 16, Some(7)).map(|_| ()).map_err(|report| report.render(false));
    assert!(coarse.is_err_and(|message| message.contains("less than 8 bits (256 steps)")));
}

#[test]
fn unusable_scenes_and_views_are_refused() {
    let view = View::new((8, 8));
    let mut bad = scene(vec![[0.0; 3]; 3], vec![]);
    bad.triangles[0].vertices[1] = 7;
    bad.triangles[0].material = 3;
    let message = refusal(&bad, &view, 32);
    assert!(
        message.contains("triangle 0 has vertex 7, but there are 3") && message.contains("has material 3"),
        "{message}"
    );
    assert!(refusal(&scene(vec![[f64::NAN; 3]; 3], vec![]), &view, 32).contains("vertex 0 is not finite"));
    assert!(refusal(&scene(vec![], vec![]), &View::new((0, 8)), 32).contains("0 x 8 pixels"));
    assert!(
        refusal(&scene(vec![], vec![]), &perspective(Some([f64::INFINITY; 3])), 32).contains("--eye is not finite")
    );
    assert!(
        refusal(&scene(vec![], vec![]), &View { shift: [1e300, 0.0], ..view.clone() }, 32)
            .contains("out of any picture")
    );
    assert!(refusal(&scene(vec![], vec![]), &view, 7).contains("7 bits is not supported"));
}
