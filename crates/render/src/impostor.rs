//! Impostors: a plant as a few crossing pictures, cut out of views from all sides.

use std::sync::Arc;

use base::{Cancelled, Run, map_until_cancelled};
use glam::{DVec2, DVec3};
use mesh::{AlphaMode, Impostor, Maps, Material, MaterialId, MaterialKind, Model, Part, Texture, TriMesh};

use crate::camera::Camera;
use crate::light::Sky;
use crate::raster::{Bins, NONE, TILE, Visible, pattern};
use crate::scene::Scene;
use crate::shade::Place;
use crate::spec::PictureSpec;
use crate::texture::srgb;

/// Views along a side of the atlas.
const FRAMES: u32 = 8;
/// Samples along a pixel's edge.
const SAMPLES: u32 = 3;
/// Ratio of the size of a view to that of the plant's bounding sphere: its pixels do not touch those of the next.
const ROOM: f64 = 1.02;
/// Share of the height that counts as the foot.
const FOOT: f64 = 0.04;
/// Least share of the sky's light that reaches the inside of a crown, however dense it is: light passes from leaf to
/// leaf.
const INSIDE: f64 = 0.3;

/// Makes an octahedral impostor of the model: an atlas of `size` pixels a side (128 to 4096) with 8 by 8 views of its
/// colours, in the shade of its own leaves, of normals and depth ([`Impostor`]), on two upright pictures that cross at
/// its centre. A shader for such atlases shows the two or three views nearest to the camera's; other programs show the
/// crossing pictures.
///
/// Guaranteed: the same bits for any executor. Each view covers as many pixels as the model does. `None` for an empty
/// model.
/// Cost: as 64 pictures without light, about 50 ns a triangle each.
///
/// # Errors
/// [`Cancelled`] when the run was cancelled.
pub fn impostor(model: &Model, size: u32, run: &Run<'_>) -> Result<Option<Model>, Cancelled> {
    run.cancel.check()?;
    let scene = Scene::new(model);
    let sky = Sky::new(&scene, &PictureSpec::default(), run)?;
    let pixels = size.clamp(128, 4096) / FRAMES;
    let points = scene.points();
    if points.is_empty() {
        return Ok(None);
    }
    let centre = middle(&scene);
    let radius = ROOM * points.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
    if !(radius.is_finite() && radius > 0.0) {
        return Ok(None);
    }
    let camera = |k: u32| Camera::around_sphere(direction(k % FRAMES, k / FRAMES), centre, radius, pixels);
    let views: Vec<View> = map_until_cancelled(run, (FRAMES * FRAMES) as usize, |k| {
        let k = u32::try_from(k).unwrap_or(0);
        view((&scene, &sky), &camera(k), (radius, pixels))
    })?;
    let side = pixels * FRAMES;
    let atlas = |of: fn(&View) -> &[u8]| Texture::joined(views.iter().map(of), pixels, FRAMES);
    let (color, normal) = (atlas(|v| &v.color), atlas(|v| &v.normal));
    #[expect(clippy::cast_possible_truncation, reason = "meshes are f32 by design")]
    let narrow = |p: DVec3| p.to_array().map(|x| x as f32);
    #[expect(clippy::cast_possible_truncation, reason = "meshes are f32 by design")]
    let known = Impostor { frames: FRAMES, centre: narrow(centre), radius_m: radius as f32 };
    let material = Material {
        roughness: 0.85,
        texture: Some(Arc::new(color)),
        maps: Maps { normal: Some(Arc::new(normal)), ..Maps::default() },
        alpha: AlphaMode::Mask,
        double_sided: true,
        impostor: Some(known),
        ..Material::plain("impostor", MaterialKind::Other, [1.0; 3])
    };
    let mut mesh = TriMesh::default();
    let last = FRAMES - 1;
    // From the front and from the right: the views of the horizon are those along the edges of the atlas. More of them
    // would cover more than the plant does.
    for (i, j) in [(last, 0), (last, last)] {
        let k = j * FRAMES + i;
        let Some([low, high]) = views[k as usize].extent else { continue };
        let [right, up, back] = camera(k).axes();
        let first = u32::try_from(mesh.positions.len()).unwrap_or(0);
        for (x, y) in [(low.x, high.y), (high.x, high.y), (high.x, low.y), (low.x, low.y)] {
            let across = (2.0 * x / f64::from(pixels) - 1.0) * radius;
            let upward = (1.0 - 2.0 * y / f64::from(pixels)) * radius;
            mesh.positions.push(narrow(centre + right * across + up * upward));
            mesh.normals.push(narrow(back));
            #[expect(clippy::cast_possible_truncation, reason = "meshes are f32 by design")]
            let place = |x: f64, k: u32| ((x + f64::from(k * pixels)) / f64::from(side)) as f32;
            mesh.uvs.push([place(x, i), place(y, j)]);
        }
        mesh.triangles.push([first, first + 1, first + 2]);
        mesh.triangles.push([first, first + 2, first + 3]);
    }
    let part = Part { name: "impostor".into(), material: MaterialId::new(0), mesh };
    Ok(Some(Model {
        name: model.name.clone(),
        parts: vec![part],
        materials: vec![material],
        ..Model::default()
    }))
}

/// Returns the point halfway up, above the foot of the plant: pictures that cross in its stem do not show it twice.
fn middle(scene: &Scene) -> DVec3 {
    let (low, high) = (scene.bounds.min.y, scene.bounds.max.y);
    let low = if low < 0.0 && high > 0.0 { 0.0 } else { low };
    let top = low + FOOT * (high - low);
    let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
    for triangle in &scene.triangles {
        let corners = triangle.corners.map(|i| scene.vertices[i as usize].at);
        let [a, b, c] = corners;
        let lowest = corners.into_iter().fold(a, |least, p| if p.y < least.y { p } else { least });
        if lowest.y <= top {
            // Square metres, squared: shoots that hang to the ground around a stem have many triangles there, but small
            // ones.
            let area = (b - a).cross(c - a).length_squared();
            sum += lowest * area;
            weight += area;
        }
    }
    let middle = (scene.bounds.min + scene.bounds.max) * 0.5;
    let over = if weight > 0.0 && sum.is_finite() { sum / weight } else { middle };
    DVec3::new(over.x, middle.y, over.z)
}

/// Returns the direction from which a view is seen: see [`Impostor`].
fn direction(i: u32, j: u32) -> DVec3 {
    let at = |k: u32| 2.0 * f64::from(k) / f64::from(FRAMES - 1) - 1.0;
    let (x, z) = (0.5 * (at(i) + at(j)), 0.5 * (at(i) - at(j)));
    DVec3::new(x, (1.0 - x.abs() - z.abs()).max(0.0), z).normalize_or(DVec3::Y)
}

/// One view: pixels as bytes, and the bounding box of its visible part.
struct View {
    color: Vec<u8>,
    normal: Vec<u8>,
    extent: Option<[DVec2; 2]>,
}

/// Values of a pixel, summed over its samples.
#[derive(Clone, Copy, Default)]
struct Sum {
    color: DVec3,
    normal: DVec3,
    depth: f64,
    alpha: f64,
}

fn view((scene, sky): (&Scene, &Sky), camera: &Camera, (radius, pixels): (f64, u32)) -> View {
    let bins = Bins::new(scene, camera, pixels, pixels);
    let pattern = pattern(SAMPLES);
    let size = pixels as usize;
    let mut sums = vec![Sum::default(); size * size];
    for tile in (0..bins.columns * bins.rows).filter(|t| !bins.faces_in(*t).is_empty()) {
        let seen = Visible::draw(scene, &bins, tile, &pattern, false);
        let (x0, y0) = (tile % bins.columns * TILE, tile / bins.columns * TILE);
        for (y, x) in (0..TILE).flat_map(|y| (0..TILE).map(move |x| (y, x))) {
            if x0 + x >= size || y0 + y >= size {
                continue;
            }
            let at = DVec2::new((x0 + x) as f64, (y0 + y) as f64);
            sums[(y0 + y) * size + x0 + x] =
                sum((scene, sky), (camera, &bins), seen.pixel(x, y), (at, &pattern));
        }
    }
    bytes(&sums, size, radius)
}

fn sum(
    (scene, sky): (&Scene, &Sky),
    (camera, bins): (&Camera, &Bins),
    ids: &[u32],
    (at, pattern): (DVec2, &[DVec2]),
) -> Sum {
    let mut all = Sum::default();
    let share = 1.0 / pattern.len() as f64;
    for (k, &id) in ids.iter().enumerate() {
        if id == NONE || ids[..k].contains(&id) {
            continue;
        }
        let Some(flat) = &bins.flats[id as usize] else { continue };
        let mine = ids.iter().zip(pattern).skip(k).filter(|&(&other, _)| other == id);
        let (middle, count) = mine.fold((DVec2::ZERO, 0.0), |(sum, n), (_, &s)| (sum + s, n + 1.0));
        let triangle = &scene.triangles[id as usize];
        let place = Place::new(scene, camera, flat, triangle, at + middle / count);
        let part = count * share;
        let light = place.sky(triangle, sky).clamp(0.0, 1.0);
        all.color += place.color * (part * (INSIDE + (1.0 - INSIDE) * light));
        all.normal += camera.seen(place.normal) * part;
        all.depth += camera.project(place.p).z * part;
        all.alpha += part;
    }
    all
}

fn bytes(sums: &[Sum], size: usize, radius: f64) -> View {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a byte's range")]
    let byte = |x: f64| (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let whole = sums.iter().fold(Sum::default(), |a, b| Sum {
        color: a.color + b.color,
        alpha: a.alpha + b.alpha,
        ..a
    });
    // Empty pixels take the mean of all: coarser copies of the atlas have no dark seam.
    let mean = if whole.alpha > 0.0 { whole.color / whole.alpha } else { DVec3::splat(0.2) };
    let alphas = ranked(&sums.iter().map(|s| s.alpha).collect::<Vec<_>>(), size);
    let cut = cut(&alphas, whole.alpha);
    let mut view = View {
        color: Vec::with_capacity(4 * sums.len()),
        normal: Vec::with_capacity(4 * sums.len()),
        extent: None,
    };
    for (k, (sum, alpha)) in sums.iter().zip(alphas).enumerate() {
        let seen = sum.alpha > 0.0;
        let color = if seen { sum.color / sum.alpha } else { mean };
        view.color.extend(color.to_array().map(srgb));
        view.color.push(if seen { byte(sharp(alpha, cut)) } else { 0 });
        let normal = if seen { sum.normal.normalize_or(DVec3::Z) } else { DVec3::Z };
        view.normal.extend(normal.to_array().map(|n| byte(0.5 + 0.5 * n)));
        view.normal.push(byte(0.5 + if seen { 0.5 * sum.depth / sum.alpha / radius } else { 0.0 }));
        if alpha >= cut {
            let at = DVec2::new((k % size) as f64, (k / size) as f64);
            let [low, high] = view.extent.unwrap_or([at, at + 1.0]);
            view.extent = Some([low.min(at), high.max(at + 1.0)]);
        }
    }
    view
}

/// Makes alphas distinct: samples are few, so of equal pixels the one with more coverage around it ranks higher, and if
/// that is equal too, the order is scattered.
fn ranked(alphas: &[f64], size: usize) -> Vec<f64> {
    let row = |y: usize| y.saturating_sub(1)..(y + 2).min(size);
    let around = |k: usize| {
        let (x, y) = (k % size, k / size);
        row(y).flat_map(|j| row(x).map(move |i| alphas[j * size + i])).sum::<f64>()
    };
    // All nine of them together are less than a sample, and the scattered term is less than a sample among them.
    let sample = 1.0 / f64::from(SAMPLES * SAMPLES);
    let scattered = |k: usize| (0.618_033_988_75 * k as f64).fract();
    let rank = |(k, a): (usize, &f64)| {
        if *a > 0.0 { a + 0.1 * sample * (around(k) + 0.5 * sample * scattered(k)) } else { 0.0 }
    };
    alphas.iter().enumerate().map(rank).collect()
}

/// Returns the alpha threshold at which as many pixels are cut out as are covered in total.
fn cut(alphas: &[f64], covered: f64) -> f64 {
    let mut seen: Vec<f64> = alphas.iter().copied().filter(|a| *a > 0.0).collect();
    base::sort_by(&mut seen, |a, b| b.total_cmp(a));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most the number of pixels"
    )]
    let kept = covered.round() as usize;
    seen.get(kept.saturating_sub(1)).copied().unwrap_or(0.5).clamp(0.02, 0.98)
}

/// Returns an alpha that is slightly above one half at the threshold, and continues from there as steeply as before it:
/// thin parts stay in place in programs that cut between pixels.
fn sharp(alpha: f64, cut: f64) -> f64 {
    if alpha < cut {
        return 0.49 * alpha / cut;
    }
    let steep = (0.51 * alpha / cut).min(1.0);
    steep.max(0.51 + 0.49 * ((alpha - cut) / (1.0 - cut)).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a red box and a green one to its right (+X).
    fn two() -> Model {
        let mut model = Model { name: "two".into(), ..Model::default() };
        for (row, (x, color)) in [(0.0_f32, [1.0, 0.0, 0.0]), (2.0, [0.0, 1.0, 0.0])].into_iter().enumerate()
        {
            let mut mesh = TriMesh::default();
            for k in 0..8_u32 {
                let side = |bit: u32| if k & bit == 0 { -0.4_f32 } else { 0.4 };
                mesh.positions.push([x + side(1), 1.0 + side(2), side(4)]);
            }
            mesh.triangles = vec![
                [0, 2, 1],
                [1, 2, 3],
                [4, 5, 6],
                [5, 7, 6],
                [0, 1, 4],
                [1, 5, 4],
                [2, 6, 3],
                [3, 6, 7],
                [0, 4, 2],
                [2, 4, 6],
                [1, 3, 5],
                [3, 7, 5],
            ];
            mesh.compute_normals();
            model.materials.push(Material::plain(format!("m{row}"), MaterialKind::Other, color));
            model.parts.push(Part { name: format!("p{row}"), material: MaterialId::new(row), mesh });
        }
        model
    }

    #[test]
    fn each_view_shows_what_is_seen_from_its_side() {
        let made = impostor(&two(), 512, &Run::plain()).expect("not cancelled").expect("something");
        assert_eq!((made.validate().next(), made.triangle_count()), (None, 4));
        let look = &made.materials[0];
        let (atlas, normals) =
            (look.texture.clone().expect("colours"), look.maps.normal.clone().expect("normals"));
        let count = |i: u32, j: u32, k: usize| {
            let mut n = 0;
            for (y, x) in (0..64).flat_map(|y| (0..64).map(move |x| (y, x))) {
                let at = 4 * ((j * 64 + y) * 512 + i * 64 + x) as usize;
                n += u32::from(atlas.pixels[at + 3] >= 128 && atlas.pixels[at + k] > 200);
            }
            n
        };
        // From +X the green box hides the red one; from +Z both are visible, and from -X only the red one.
        assert!((direction(7, 7) - DVec3::X).length() < 1e-9 && (direction(7, 0) - DVec3::Z).length() < 1e-9);
        assert!(count(7, 7, 1) > 100 && count(7, 7, 0) == 0);
        assert!(count(0, 0, 0) > 100 && count(0, 0, 1) == 0, "from {}", direction(0, 0));
        assert!(count(7, 0, 0) > 100 && count(7, 0, 1) > 100);
        // From the front the face of a box faces the viewer, and lies in front of the centre.
        let middle = 4 * (32_usize * 512 + 7 * 64 + 32 - 20);
        let n = &normals.pixels[middle..middle + 4];
        assert!(n[2] > 230 && n[3] > 140, "{n:?}");
    }

    /// Like the shoots of a willow: nothing fills a pixel.
    #[test]
    fn thin_shoots_cover_no_more_than_they_do() {
        for (size, width) in [(64_usize, 0.3), (64, 0.7), (128, 0.5)] {
            // Thirty hanging shoots that lean; samples of a third of a pixel, as in views.
            let start = |n: u32| (17.37 * f64::from(n)) % size as f64;
            let lean = |n: u32| 0.3 * base::ops::sin(2.1 * f64::from(n));
            let hit = |x: f64, y: f64| (0..30).any(|n| (x - start(n) - lean(n) * y).abs() < 0.5 * width);
            let third = |s: u32, k: usize| k as f64 + f64::from(s) / 3.0;
            let of_pixel = |k: usize| {
                let hits = (0..9).filter(|s| hit(third(s % 3, k % size), third(s / 3, k / size)));
                hits.count() as f64 / 9.0
            };
            let alphas: Vec<f64> = (0..size * size).map(of_pixel).collect();
            let covered = alphas.iter().sum::<f64>();
            let ranked = ranked(&alphas, size);
            let cut = cut(&ranked, covered);
            let kept = ranked.iter().filter(|a| sharp(**a, cut) > 0.5).count() as f64;
            assert!((kept / covered - 1.0).abs() < 0.05, "{width}: {kept} instead of {covered}");
        }
    }

    /// Like those of a willow, on one side of its stem only.
    #[test]
    fn what_hangs_to_the_ground_does_not_move_the_middle() {
        let mut model = two();
        model.parts.truncate(1);
        for p in &mut model.parts[0].mesh.positions {
            p[1] = if p[1] < 1.0 { 0.0 } else { 4.0 };
        }
        let mut shoots = TriMesh::default();
        for k in 0..200_u16 {
            let x = 2.0 + 0.01 * f32::from(k);
            for corner in [[x, -0.2, 0.0], [x + 0.02, -0.2, 0.0], [x, 0.1, 0.02]] {
                shoots.positions.push(corner);
            }
            let first = 3 * u32::from(k);
            shoots.triangles.push([first, first + 1, first + 2]);
        }
        shoots.compute_normals();
        model.parts.push(Part { name: "shoots".into(), material: MaterialId::new(0), mesh: shoots });
        let at = middle(&Scene::new(&model));
        assert!(at.x.abs() < 0.15 && (at.y - 1.9).abs() < 1e-6, "{at}");
    }

    #[test]
    fn of_nothing_nothing_is_made() {
        assert!(impostor(&Model::default(), 512, &Run::plain()).expect("not cancelled").is_none());
    }
}
