//! Places of the rays of small pictures, and the distance of the raw ones from them.

use super::*;
use crate::grid::Grid;
use crate::model::{Scene, Triangle};
use crate::vector::dot;

/// From (0, 0, 0) to (4, 2, 1).
const BOX: Corners = ([0.0; 3], [4.0, 2.0, 1.0]);

fn view(size: (u32, u32), camera: Camera) -> View {
    View { camera, ..View::new(size) }
}

fn perspective(eye: Option<Vec3>, look: Option<Vec3>, field: f64) -> Camera {
    Camera::Perspective { eye, look, field }
}

fn assert_near(a: Vec3, b: Vec3) {
    assert!(largest(sub(a, b)) < 1e-12, "{a:?} is not {b:?}");
}

#[test]
fn parallel_rays_are_centred_and_the_tighter_side_sets_the_pitch() {
    let rays = Rays::new(BOX, &view((4, 4), Camera::Orthographic)).unwrap();
    // Pitch max(4/4, 2/4) = 1: columns at 0.5 .. 3.5, rows around y = 1.
    let (origin, direction) = rays.ray(0, 0);
    assert_eq!((origin[0], origin[1], direction), (0.5, 2.5, [0.0, 0.0, -1.0]));
    assert!(origin[2] > 1.0);
    assert_eq!(rays.ray(3, 3).0[..2], [3.5, -0.5]);
    let shifted = View { shift: [0.25, 0.125], ..view((4, 4), Camera::Orthographic) };
    assert_eq!(Rays::new(BOX, &shifted).unwrap().ray(1, 2).0[..2], [1.75, 0.625]);
}

#[test]
fn the_default_eye_sees_the_middle_in_the_middle() {
    let rays = Rays::new(BOX, &view((3, 3), perspective(None, None, 45.0))).unwrap();
    let (eye, direction) = rays.ray(1, 1);
    assert_near(eye, [2.0, 1.0, 1.0 + 1.2 * 4.0]);
    assert_near(direction, [0.0, 0.0, -1.0]);
}

#[test]
fn the_field_of_view_spans_the_height() {
    // 90 degrees: the edges of a picture of 2 rows are at +-1, the pixel centres at +-1/2; columns have the same pitch.
    let rays = Rays::new(BOX, &view((6, 2), perspective(Some([2.0, 1.0, 5.0]), None, 90.0))).unwrap();
    assert_near(rays.ray(0, 0).1, unit([-2.5, 0.5, -1.0]).unwrap());
    assert_near(rays.ray(5, 1).1, unit([2.5, -0.5, -1.0]).unwrap());
}

#[test]
fn looking_along_the_vertical_has_a_top() {
    for (eye, right) in [([2.0, 9.0, 0.5], 1.0), ([2.0, -9.0, 0.5], -1.0)] {
        let rays = Rays::new(BOX, &view((2, 2), perspective(Some(eye), None, 45.0))).unwrap();
        let (_, direction) = rays.ray(1, 0);
        assert!(direction[2] < 0.0 && direction[0] * right > 0.0, "{direction:?}");
    }
}

#[test]
fn boxes_without_extent_are_looked_at() {
    for corners in
        [([3.0; 3], [3.0; 3]), ([0.0; 3], [0.0, 0.0, 7.0]), ([1e300; 3], [1e300; 3]), ([-1e300; 3], [1e300; 3])]
    {
        for camera in [Camera::Orthographic, perspective(None, None, 45.0)] {
            // Far from 0 an eye 1.2 away is the point itself.
            let Ok(rays) = Rays::new(corners, &view((5, 3), camera)) else {
                assert!(corners.0 == [1e300; 3] && camera != Camera::Orthographic);
                continue;
            };
            let (origin, direction) = rays.ray(4, 2);
            assert!(origin.iter().all(|x| x.is_finite()) && (dot(direction, direction) - 1.0).abs() < 1e-12);
        }
    }
    let rays = Rays::new(([3.0; 3], [3.0; 3]), &view((5, 3), Camera::Orthographic)).unwrap();
    assert_eq!(rays.ray(2, 1).0[..2], [3.0, 3.0]);
    assert!(matches!(rays, Rays::Orthographic { pitch: 0.2, .. }));
}

#[test]
fn cameras_that_cannot_be_are_refused() {
    let refusal = |camera| Rays::new(BOX, &view((4, 4), camera)).unwrap_err().render(false);
    for field in [0.0, -3.0, 180.0, f64::NAN] {
        assert!(refusal(perspective(None, None, field)).contains("--fov"), "{field}");
    }
    assert!(refusal(perspective(Some([1.0; 3]), Some([1.0; 3]), 45.0)).contains("--eye"));
    assert!(refusal(perspective(None, Some([f64::INFINITY; 3]), 45.0)).contains("no direction"));
}

/// A triangle that spans `BOX`.
fn scene() -> Scene {
    Scene {
        name: "corner".into(),
        size: (4, 4),
        materials: vec![crate::model::Material { colour: [1.0; 3], reflection: 0.0, intensity: 1.0, index: 0.0 }],
        lights: vec![],
        vertices: vec![BOX.0, BOX.1, [4.0, 0.0, 0.0]],
        triangles: vec![Triangle { vertices: [0, 1, 2], material: 0 }],
    }
}

fn raw_camera(view: &View, word: u32) -> (RawCamera, Rays, Grid, Formats) {
    let grid = Grid::new(&scene(), view, word, None).unwrap();
    let formats = Formats::new(&scene(), view, &grid, 1, &Default::default()).unwrap();
    let local = View { camera: mapped(&view.camera, |p| grid.local(p)), ..view.clone() };
    let rays = Rays::new(grid.local_corners(), &local).unwrap();
    (RawCamera::new(&rays, view.size, &formats, &grid.bounds().enlarged(1)).unwrap(), rays, grid, formats)
}

#[test]
fn raw_origins_are_the_exact_ones_rounded_once() {
    for (word, size) in [(32, (320, 240)), (24, (1021, 77)), (20, (320, 240)), (16, (640, 480)), (8, (16, 12))] {
        let view = View { shift: [0.137, 0.071], ..view(size, Camera::Orthographic) };
        let (camera, rays, grid, formats) = raw_camera(&view, word);
        let RawCamera::Orthographic { extra, first, pitch, z, .. } = camera else { panic!() };
        let fits = |x: i64| x.unsigned_abs() < 1 << (2 * word - 1);
        assert!(
            fits(first[0])
                && fits(first[1])
                && fits(pitch * i64::from(size.0))
                && fits(first[0] + pitch * i64::from(size.0))
        );
        assert!(extra >= word - 6, "{word}: {extra}");
        assert_eq!(z, grid.bounds().high[2] + 2);
        let tolerance = 0.5 + f64::from(size.0.max(size.1)) / (1u64 << extra) as f64;
        for c in 0..size.0 {
            for r in [0, size.1 / 3, size.1 - 1] {
                let (origin, direction) = camera.ray(c, r, word);
                let most = (1i64 << (word - 1)) as f64;
                let origin = origin.expect("parallel rays have origins");
                let exact = rays.ray(c, r).0.map(|x| x.clamp(-most, most - 1.0));
                assert!((0..2).all(|k| (f64::from(origin[k]) - exact[k]).abs() <= tolerance), "{word} {c} {r}");
                assert_eq!(direction, [0, 0, -1 << formats.direction]);
            }
        }
    }
}

#[test]
fn raw_directions_are_the_exact_ones_rounded_once() {
    for (word, field, size) in [
        (32, 45.0, (320, 240)),
        (24, 170.0, (640, 48)),
        (20, 1.0, (320, 240)),
        (16, 60.0, (4000, 3)),
        (8, 45.0, (3, 60)),
    ] {
        let eye = [5.0, 4.0, 6.0];
        let view = View { shift: [0.137, 0.071], ..view(size, perspective(Some(eye), None, field)) };
        let (camera, rays, _, formats) = raw_camera(&view, word);
        let RawCamera::Perspective { base, column, row, extra, .. } = camera else { panic!() };
        assert!(extra >= word - 6, "{word}: {extra}");
        // Half a unit on each axis and half of the other pixels' steps.
        let tolerance = 1.0 + f64::from(size.0 + size.1) / (1u64 << extra) as f64;
        for (vector, times) in [(base, 1), (column, i64::from(size.0)), (row, i64::from(size.1))] {
            assert!(vector.iter().all(|&x| (i128::from(x) * i128::from(times)).unsigned_abs() < 1 << (2 * word - 2)));
        }
        let mut most = 0;
        for c in 0..size.0 {
            for r in [0, size.1 / 3, size.1 - 1] {
                let (_, direction) = camera.ray(c, r, word);
                let found = direction.map(f64::from);
                most = most.max(direction.iter().map(|x| x.unsigned_abs()).max().unwrap());
                let off = largest(sub(unit(found).unwrap(), rays.ray(c, r).1)) * largest(found);
                assert!(off < tolerance, "{word} {field} {c} {r}: {off}");
            }
        }
        assert!((1 << (formats.direction - 1)..=1 << formats.direction).contains(&most), "{word} {field}: {most:x}");
    }
}

/// The point in which a ray enters the box, rounded to nearest, by the formulas of [`RayStart`], the axis of the face, and the units by which it may be off.
fn entry(start: &RayStart, (c, r): (u32, u32)) -> Option<([i32; 3], usize, f64)> {
    let RayStart::Faces { shift, .. } = *start else { return None };
    let value = |f: &PixelFunction| {
        i128::from(f.first) + i128::from(c) * i128::from(f.column) - i128::from(r) * i128::from(f.row)
    };
    start.faces().find_map(|face| {
        let slope = Some(value(&face.slope)).filter(|&slope| slope > 0)?;
        let (mut point, mut most) = ([face.at; 3], 0.5);
        for part in &face.across {
            let from_low = value(&part.from_low);
            if from_low < 0 || value(&part.from_high) < 0 {
                return None;
            }
            let inside = ((2 * (from_low << shift) + slope).div_euclid(2 * slope)) as i32;
            point[part.axis] = part.low + inside;
            // Each of the three numbers is off by half a unit, in the numerator and in the slope: with n and s for what that makes,
            // (N + n) / (S + s) is off N / S by (n - s N / S) / (S + s).
            let half_units = f64::from(1 + c + r) / 2.0;
            let least = slope as f64 - half_units;
            let carried = half_units * (f64::from(shift).exp2() + f64::from(inside) + 0.5) / least;
            most = f64::max(most, if least > 0.0 { 0.5 + 1.01 * carried } else { f64::INFINITY });
        }
        Some((point, face.axis, most))
    })
}

#[test]
fn perspective_rays_start_where_they_enter_the_box() {
    let eyes = [[5.0, 4.0, 6.0], [2.0, 1.0, 9.0], [-300.0, 4.0, 6000.0], [1e5, -2e5, 3e4], [3.5, 2.0, 1.0]];
    let mut entered = 0;
    for (eye, word) in eyes.into_iter().flat_map(|eye| [32, 24, 16, 8].map(|word| (eye, word))) {
        // As wide as the box from wherever it is seen.
        let field = (8.0 / largest(eye)).atan().to_degrees().max(0.001);
        let view = view((61, 47), perspective(Some(eye), None, field));
        let (camera, rays, grid, _) = raw_camera(&view, word);
        let RawCamera::Perspective { start, .. } = camera else { panic!() };
        let root = grid.bounds().enlarged(1);
        let outer = root.enlarged(1);
        for (c, r) in (0..61).flat_map(|c| (0..47).map(move |r| (c, r))) {
            let (from, way) = rays.ray(c, r);
            // Where the exact ray is in the box: between the last plane that it enters by and the first that it leaves by.
            let crossing = |at: i32, k: usize| (f64::from(at) - from[k]) / way[k];
            let axes: Vec<usize> = (0..3).filter(|&k| way[k] != 0.0).collect();
            let near =
                axes.iter().map(|&k| crossing(outer.low[k], k).min(crossing(outer.high[k], k))).fold(0.0, f64::max);
            let point = [0, 1, 2].map(|k| from[k] + near * way[k]);
            let inside = |slack: f64| {
                (0..3).all(|k| {
                    let (low, high) = (f64::from(outer.low[k]), f64::from(outer.high[k]));
                    (low - slack..=high + slack).contains(&point[k])
                })
            };
            match entry(&start, (c, r)) {
                Some((found, k, most)) => {
                    entered += 1;
                    // On the plane in front of the face, and there beside the exact ray by a rounding.
                    assert!(found[k] == outer.low[k] || found[k] == outer.high[k]);
                    let t = crossing(found[k], k);
                    let point = [0, 1, 2].map(|k| from[k] + t * way[k]);
                    let off = (0..3).map(|k| (f64::from(found[k]) - point[k]).abs()).fold(0.0, f64::max);
                    assert!(off <= most, "{eye:?} {word} {c} {r}: {found:?} is {off} away from {point:?}, not {most}");
                    let bound = if word >= 24 { 0.51 } else { 0.6 };
                    assert!(word == 8 || most <= bound, "{eye:?} {word} {c} {r}: {most}");
                }
                None => assert!(matches!(start, RayStart::Eye(_)) || !inside(-3.0), "{eye:?} {word} {c} {r} misses"),
            }
        }
    }
    assert!(entered > 5_000, "{entered}");
}

#[test]
fn a_picture_too_long_for_a_short_word_is_refused() {
    let view = view((1, 1_000_000), Camera::Orthographic);
    let grid = Grid::new(&scene(), &view, 8, None).unwrap();
    let formats = Formats::new(&scene(), &view, &grid, 1, &Default::default()).unwrap();
    let rays = Rays::new(grid.local_corners(), &view).unwrap();
    let error = RawCamera::new(&rays, view.size, &formats, &grid.bounds().enlarged(1)).unwrap_err().render(false);
    assert!(error.contains("1 x 1000000 pixels is too long"), "{error}");
}
