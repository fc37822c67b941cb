//! Tests the contents of pictures, pixel by pixel.
#![expect(clippy::unwrap_used, reason = "tests")]

use std::sync::Arc;

use base::{CancelToken, Cancelled, Executor, Run};
use glam::{DVec2, DVec3};
use mesh::{AlphaMode, Material, MaterialId, MaterialKind, Model, Part, Texture, TriMesh};
use render::{Background, Camera, Picture, PictureSpec, Pinhole, View, hits, render};

/// Positions, triangles and colour of a part.
type Body<'a> = (&'a [[f32; 3]], &'a [[u32; 3]], [f32; 3]);

fn model(parts: &[Body<'_>]) -> Model {
    let mut out = Model::default();
    for (k, &(positions, triangles, color)) in parts.iter().enumerate() {
        let mesh =
            TriMesh { positions: positions.to_vec(), triangles: triangles.to_vec(), ..TriMesh::default() };
        out.parts.push(Part { name: format!("part-{k}"), material: MaterialId::new(k), mesh });
        out.materials.push(Material::plain(format!("material-{k}"), MaterialKind::Other, color));
    }
    out
}

// A square of half-width 1 around (0, y, z), facing +Z.
fn square(y: f32, z: f32, half: f32) -> [[f32; 3]; 4] {
    [[-half, y - half, z], [half, y - half, z], [half, y + half, z], [-half, y + half, z]]
}

const QUAD: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
const RED: [f32; 3] = [0.8, 0.02, 0.02];
const BLUE: [f32; 3] = [0.02, 0.02, 0.8];

fn spec(width: u32, height: u32, view: View, background: Background) -> PictureSpec {
    PictureSpec { width, height, view, background, ..PictureSpec::default() }
}

fn picture(model: &Model, spec: &PictureSpec) -> Picture {
    render(model, spec, &Run::plain()).unwrap()
}

fn brightness(p: [u8; 4]) -> u32 {
    p[..3].iter().map(|&b| u32::from(b)).sum()
}

#[test]
fn triangle_covers_its_pixels_in_the_front_view() {
    let m = model(&[(&[[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 4.0, 0.0]], &[[0, 1, 2]], RED)]);
    let spec = PictureSpec { margin: 0.0, ..spec(80, 40, View::Front, Background::Transparent) };
    let p = picture(&m, &spec);
    // x right, y up, 10 pixels a metre: the hypotenuse runs from the upper left to the lower right corner.
    for y in 0..40_u32 {
        for x in 0..80_u32 {
            let d = (f64::from(x) + 0.5) / 80.0 - (f64::from(y) + 0.5) / 40.0;
            let alpha = p.pixel(x, y).unwrap()[3];
            if d.abs() > 0.03 {
                assert_eq!(alpha, if d < 0.0 { 255 } else { 0 }, "at {x}, {y}");
            }
        }
    }
    let on_edge = p.pixel(40, 20).unwrap()[3];
    assert!((160..=220).contains(&on_edge), "three quarters covered: {on_edge}");
}

#[test]
fn camera_maps_as_documented() {
    let points = [DVec3::new(-1.0, 0.0, -0.5), DVec3::new(1.0, 4.0, 0.5)];
    let at = |view, p| Camera::framing(&points, &spec(100, 100, view, Background::Sky)).project(p);
    let up = DVec3::new(0.0, 4.0, 0.0);
    let down = DVec3::ZERO;
    for view in [View::Front, View::Side] {
        assert!((at(view, up).y - 6.0).abs() < 1e-9 && (at(view, down).y - 94.0).abs() < 1e-9, "{view:?}");
    }
    assert!(at(View::Front, DVec3::X).x > at(View::Front, -DVec3::X).x, "front: X goes right");
    assert!(at(View::Side, DVec3::Z).x < at(View::Side, -DVec3::Z).x, "side: Z goes left");
    assert!(at(View::Top, DVec3::Z).y > at(View::Top, -DVec3::Z).y, "top: Z goes down");
    assert!(at(View::Front, DVec3::Z).z > at(View::Front, -DVec3::Z).z, "the key grows towards the viewer");
    for view in [View::ThreeQuarter, View::Orbit { azimuth: 2.0, elevation: 0.9 }] {
        for p in points {
            let q = at(view, p);
            let inside = |x: f64| (6.0 - 1e-6..=94.0 + 1e-6).contains(&x);
            assert!(inside(q.x) && inside(q.y), "{view:?}: {p} is seen at {q}");
        }
    }
}

#[test]
fn nearer_surfaces_hide_farther_ones_in_any_order() {
    let (near, far) = (square(1.0, 0.5, 0.5), square(1.0, -0.5, 1.0));
    for parts in [
        [(&near[..], &QUAD[..], RED), (&far[..], &QUAD[..], BLUE)],
        [(&far[..], &QUAD[..], BLUE), (&near[..], &QUAD[..], RED)],
    ] {
        let p = picture(&model(&parts), &spec(64, 64, View::Front, Background::Plain([255; 3])));
        let (middle, side) = (p.pixel(32, 32).unwrap(), p.pixel(12, 32).unwrap());
        assert!(middle[0] > 2 * middle[2], "red in front: {middle:?}");
        assert!(side[2] > 2 * side[0], "blue around it: {side:?}");
    }
}

#[test]
fn shadow_falls_away_from_the_sun_and_nowhere_else() {
    // A plate above the ground, seen from above; the sun stands to the left and in front.
    let plate = [[-0.5, 1.0, -0.5], [-0.5, 1.0, 0.5], [0.5, 1.0, 0.5], [0.5, 1.0, -0.5], [0.0, 0.0, 0.0]];
    let mut m = model(&[(&plate, &[[0, 1, 2], [0, 2, 3]], RED)]);
    m.parts[0].mesh.triangles.push([4, 4, 4]);
    let spec = PictureSpec { margin: 0.36, ..spec(200, 200, View::Top, Background::Plain([230, 230, 230])) };
    let p = picture(&m, &spec);
    let camera = Camera::framing(&[DVec3::new(-0.5, 0.0, -0.5), DVec3::new(0.5, 1.0, 0.5)], &spec);
    let seen = |x: f64, z: f64| {
        let q = camera.project(DVec3::new(x, 0.0, z));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "inside the picture")]
        brightness(p.pixel(q.x as u32, q.y as u32).unwrap())
    };
    let (shadow, free) = (seen(0.7, -0.6), seen(-0.9, 0.9));
    assert!(shadow + 100 < free, "shadow {shadow} against free ground {free}");
    assert!(seen(-0.7, 0.3) + 60 > free, "no shadow towards the sun");
    let none = picture(&m, &PictureSpec { ground_shadow: false, ..spec });
    assert_eq!(none.pixel(5, 5), Some([230, 230, 230, 255]));
    assert!(none.pixels.chunks(4).filter(|p| *p == [230, 230, 230, 255]).count() > 30_000);
}

#[test]
fn lit_surfaces_show_no_acne() {
    // A large slanted plate: except for its edges it must be evenly lit.
    let plate = [[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]];
    let p = picture(
        &model(&[(&plate, &QUAD, [0.5; 3])]),
        &spec(200, 200, View::ThreeQuarter, Background::Transparent),
    );
    let red = |x: u32, y: u32| i32::from(p.pixel(x, y).unwrap()[0]);
    let (mut inner, mut rough) = (0, 0);
    for y in 1..199 {
        for x in 1..199 {
            let solid = (0..9).all(|k| {
                let q = p.pixel(x + k % 3 - 1, y + k / 3 - 1).unwrap();
                q[3] == 255
            });
            if solid && red(x, y) > 0 && red(x + 1, y) > 0 {
                inner += 1;
                rough += i32::from((red(x + 1, y) - red(x, y)).abs() > 3);
            }
        }
    }
    assert!(inner > 3000, "{inner}");
    assert_eq!(rough, 0, "of {inner}");
}

#[test]
fn transparent_background_has_alpha_only_where_something_is() {
    let m = model(&[(&square(1.0, 0.0, 1.0), &QUAD, RED)]);
    let bare =
        PictureSpec { ground_shadow: false, ..spec(96, 64, View::ThreeQuarter, Background::Transparent) };
    let p = picture(&m, &bare);
    assert_eq!(p.pixel(0, 0), Some([0; 4]));
    assert_eq!(p.pixel(48, 32).unwrap()[3], 255);
    let with_shadow = picture(&m, &PictureSpec { ground_shadow: true, ..bare });
    let soft = |p: &Picture| p.pixels.chunks(4).filter(|q| q[3] > 20 && q[3] < 235).count();
    assert!(soft(&with_shadow) > soft(&p) + 20, "{} {}", soft(&with_shadow), soft(&p));
}

#[test]
fn mask_cuts_holes_and_thin_blades_let_light_through() {
    let mut m = model(&[(&square(1.0, 0.0, 1.0), &QUAD, [1.0; 3])]);
    m.parts[0].mesh.uvs = vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    // The upper row of the texture is green, the lower one a hole: v runs downwards.
    let pixels = vec![20, 200, 20, 255, 20, 200, 20, 255, 0, 0, 0, 0, 0, 0, 0, 0];
    m.materials[0].texture = Some(Arc::new(Texture { width: 2, height: 2, pixels }));
    m.materials[0].alpha = AlphaMode::Mask;
    let p = picture(&m, &spec(64, 64, View::Front, Background::Transparent));
    let (upper, lower) = (p.pixel(32, 16).unwrap(), p.pixel(32, 48).unwrap());
    assert!(upper[3] == 255 && upper[1] > upper[0], "{upper:?}");
    assert_eq!(lower[3], 0);

    // A level blade seen from below, the sun above it.
    let blade = [[-1.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]];
    let mut against = model(&[(&blade, &QUAD, [0.2, 0.5, 0.1])]);
    let view = View::Orbit { azimuth: 0.0, elevation: -0.9 };
    let dark = picture(&against, &spec(64, 64, view, Background::Transparent)).pixel(32, 32).unwrap();
    against.materials[0].translucency = 0.5;
    let glow = picture(&against, &spec(64, 64, view, Background::Transparent)).pixel(32, 32).unwrap();
    assert!(brightness(glow) > brightness(dark) + 20, "{glow:?} {dark:?}");
}

struct Threads(usize);

impl Executor for Threads {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        std::thread::scope(|scope| {
            for k in 0..self.0 {
                scope.spawn(move || (0..n).rev().filter(|i| i % self.0 == k).for_each(job));
            }
        });
    }
}

fn steps() -> Model {
    let mut m = model(&[(&square(1.0, 0.2, 0.7), &QUAD, RED), (&square(0.5, -0.3, 0.5), &QUAD, BLUE)]);
    for k in 0..40_u16 {
        let (x, y) = (f32::from(k) * 0.05 - 1.0, 1.0 + f32::from(k % 7) * 0.1);
        let first = u32::try_from(m.parts[0].mesh.positions.len()).unwrap();
        m.parts[0].mesh.positions.extend([[x, 0.0, 0.0], [x + 0.01, 0.0, 0.0], [x, y, 0.4]]);
        m.parts[0].mesh.triangles.push([first, first + 1, first + 2]);
    }
    m
}

#[test]
fn same_bits_for_any_number_of_threads() {
    for view in [View::ThreeQuarter, View::Turntable { frames: 3 }] {
        let spec = spec(150, 90, view, Background::Sky);
        let one = picture(&steps(), &spec);
        for threads in [2, 5] {
            let many = render(&steps(), &spec, &Run { executor: &Threads(threads), ..Run::plain() }).unwrap();
            assert!(one == many, "{view:?} with {threads} threads");
        }
    }
}

#[test]
fn every_view_has_the_size_that_was_asked_for() {
    let views = [View::Front, View::ThreeQuarter, View::Side, View::Top, View::Turntable { frames: 5 }];
    for view in views {
        for (width, height) in [(1, 1), (33, 70), (101, 31)] {
            let p = picture(&steps(), &spec(width, height, view, Background::Sky));
            assert_eq!((p.width, p.height), (width, height));
            assert_eq!(p.pixels.len(), 4 * (width * height) as usize);
            assert!(p.pixels.chunks(4).all(|q| q[3] == 255), "{view:?} {width} x {height}");
        }
    }
}

#[test]
fn unsound_geometry_is_left_out() {
    let mut m = steps();
    let clean = picture(&m, &spec(64, 64, View::Front, Background::Sky));
    let mesh = &mut m.parts[1].mesh;
    mesh.positions.extend([[f32::NAN, 0.0, 0.0], [9e9, 9e9, 9e9]]);
    mesh.triangles.extend([[0, 1, 4], [0, 1, 999]]);
    mesh.normals = vec![[f32::INFINITY, 0.0, 0.0]; 6];
    m.parts.push(Part { name: "lost".into(), material: MaterialId::new(77), mesh: m.parts[0].mesh.clone() });
    assert!(clean == picture(&m, &spec(64, 64, View::Front, Background::Sky)));
}

#[test]
fn extreme_sizes_and_flat_models_do_not_break() {
    for scale in [1e-30_f32, 1e-6, 1e12, 1e30] {
        let corners = square(1.0, 0.0, 1.0).map(|p| p.map(|x| x * scale));
        let p =
            picture(&model(&[(&corners, &QUAD, RED)]), &spec(32, 32, View::ThreeQuarter, Background::Sky));
        let middle = p.pixel(16, 16).unwrap();
        assert!(middle[0] > middle[1], "scale {scale}: {middle:?}");
    }
    let point = [[0.5_f32; 3]; 3];
    let p = picture(&model(&[(&point, &[[0, 1, 2]], RED)]), &spec(8, 8, View::Top, Background::Sky));
    assert_eq!(p.pixels.len(), 256);
}

#[test]
fn cancelled_run_gives_no_picture() {
    let cancel = CancelToken::new();
    cancel.cancel();
    let run = Run { cancel: &cancel, ..Run::plain() };
    assert_eq!(render(&steps(), &PictureSpec::default(), &run), Err(Cancelled));
}

/// Looks along -Z from (0.3, 1.1, 4), with pixels that are not square and a principal point off the middle.
fn pinhole() -> Pinhole {
    Pinhole {
        eye_m: DVec3::new(0.3, 1.1, 4.0),
        right: DVec3::X,
        down: DVec3::NEG_Y,
        focal_px: DVec2::new(90.0, 120.0),
        principal_px: DVec2::new(31.0, 22.5),
    }
}

#[test]
fn a_pinhole_projects_by_its_intrinsics() {
    let camera = Camera::framing(&[], &spec(80, 60, View::Pinhole(pinhole()), Background::Sky));
    for (point, [x, y]) in [
        (DVec3::new(0.3, 1.1, 0.0), [31.0, 22.5]),
        (DVec3::new(0.7, 1.1, 2.0), [31.0 + 90.0 * 0.4 / 2.0, 22.5]),
        (DVec3::new(0.3, 0.1, -4.0), [31.0, 22.5 + 120.0 / 8.0]),
    ] {
        let seen = camera.project(point);
        assert!((seen.x - x).abs() < 1e-12 && (seen.y - y).abs() < 1e-12, "{point}: {seen}");
    }
    assert!(camera.project(DVec3::new(0.3, 1.1, 5.0)).x.is_nan(), "behind the eye");
}

#[test]
fn a_pinhole_meets_a_plane_where_its_rays_do() {
    let m = model(&[(&square(1.0, 0.0, 2.0), &QUAD, RED)]);
    let view = spec(80, 60, View::Pinhole(pinhole()), Background::Sky);
    let seen = hits(&m, &[view], &Run::plain()).unwrap();
    assert!(seen[0].len() > 2000, "{}", seen[0].len());
    for hit in &seen[0] {
        let [x, y] = [f64::from(hit.pixel % 80) + 0.5, f64::from(hit.pixel / 80) + 0.5];
        let wanted = DVec3::new(0.3 + (x - 31.0) / 90.0 * 4.0, 1.1 - (y - 22.5) / 120.0 * 4.0, 0.0);
        // Corners are rounded to 1/256 of a pixel.
        assert!(hit.at.distance(wanted) < 4.0 / 90.0 / 128.0, "{}: {} {wanted}", hit.pixel, hit.at);
        assert!((hit.distance_m - wanted.distance(pinhole().eye_m)).abs() < 1e-3);
    }
}

#[test]
fn a_pinhole_that_is_not_sound_is_no_view() {
    let skewed = Pinhole { down: DVec3::new(0.5, -0.5, 0.0), ..pinhole() };
    let nowhere = Pinhole { eye_m: DVec3::NAN, ..pinhole() };
    let flat = Pinhole { focal_px: DVec2::new(0.0, 10.0), ..pinhole() };
    assert!(pinhole().is_sound());
    for camera in [skewed, nowhere, flat] {
        assert!(!camera.is_sound());
        let view = spec(8, 8, View::Pinhole(camera), Background::Sky).clamped().view;
        assert_eq!(view, View::default());
    }
}

#[test]
fn a_sun_that_is_placed_lights_the_side_that_faces_it() {
    // Two walls that face +X and -X, seen from above.
    let east = [[0.5, 0.0, -1.0], [1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [0.5, 0.0, 1.0]];
    let west = [[-0.5, 0.0, -1.0], [-0.5, 0.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, -1.0, -1.0]];
    let m = model(&[(&east, &[[0, 2, 1], [0, 3, 2]], [0.5; 3]), (&west, &[[0, 2, 1], [0, 3, 2]], [0.5; 3])]);
    let lit = |sun: DVec3, sunshine: f64| {
        let view = spec(80, 80, View::Top, Background::Plain([0; 3]));
        let p = picture(&m, &PictureSpec { sun: Some(sun), sunshine, ..view });
        [60, 20].map(|x| brightness(p.pixel(x, 40).unwrap()))
    };
    let [right, left] = lit(DVec3::new(0.8, 0.6, 0.0), 1.0);
    assert!(right > left + 60, "{right} {left}");
    let [right, left] = lit(DVec3::new(-0.8, 0.6, 0.0), 1.0);
    assert!(left > right + 60, "{right} {left}");
    let [right, left] = lit(DVec3::new(-0.8, 0.6, 0.0), 0.0);
    assert!(right.abs_diff(left) < 20, "{right} {left}");
}
