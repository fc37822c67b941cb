//! Colour of surfaces without light.

use base::{Cancelled, Run, map_until_cancelled};
use glam::{DVec2, DVec3};
use mesh::Model;

use crate::camera::Camera;
use crate::picture::Picture;
use crate::raster::{Bins, NONE, TILE, Visible, pattern};
use crate::scene::Scene;
use crate::shade::Place;
use crate::spec::PictureSpec;
use crate::texture::srgb;

/// Renders the reflectance of the surfaces of `model`: the picture of [`crate::render`] without light, shade,
/// background and ground.
///
/// Each pixel has the mean colour of its samples that meet a surface, and their share as alpha; 0 everywhere for
/// nothing. Guaranteed: the same bits for any executor; the pixels and samples of [`crate::render`]. Of a turntable only
/// the first view is used. Cost: linear in triangles and pixels, a tenth of that of the picture with light.
///
/// # Errors
/// [`Cancelled`] when the run was cancelled.
///
/// ```
/// let spec = render::PictureSpec { width: 32, height: 24, ..Default::default() };
/// let picture = render::albedo(&mesh::Model::default(), &spec, &base::Run::plain())?;
/// assert_eq!(picture, render::Picture::filled(32, 24, [0; 4]));
/// # Ok::<(), base::Cancelled>(())
/// ```
pub fn albedo(model: &Model, spec: &PictureSpec, run: &Run<'_>) -> Result<Picture, Cancelled> {
    run.cancel.check()?;
    let spec = spec.clamped();
    let scene = Scene::new(model);
    let camera = Camera::framing(&scene.points(), &spec);
    let bins = Bins::new(&scene, &camera, spec.width, spec.height);
    let pattern = pattern(spec.supersample);
    let count = bins.columns * bins.rows;
    let tiles = map_until_cancelled(run, count, |k| tile_colours(&scene, &camera, (&bins, k), &pattern))?;
    let mut picture = Picture::filled(spec.width, spec.height, [0; 4]);
    for (k, tile) in tiles.iter().enumerate() {
        #[expect(clippy::cast_possible_truncation, reason = "inside the picture, at most 8192")]
        let (x, y) = ((k % bins.columns * TILE) as u32, (k / bins.columns * TILE) as u32);
        picture.paste(tile, x, y);
    }
    Ok(picture)
}

#[expect(clippy::cast_possible_truncation, reason = "tiles are small")]
fn tile_colours(scene: &Scene, camera: &Camera, (bins, tile): (&Bins, usize), pattern: &[DVec2]) -> Picture {
    let mut out = Picture::filled(TILE as u32, TILE as u32, [0; 4]);
    if bins.faces_in(tile).is_empty() {
        return out;
    }
    let visible = Visible::draw(scene, bins, tile, pattern, camera.is_perspective());
    let corner = DVec2::new((tile % bins.columns * TILE) as f64, (tile / bins.columns * TILE) as f64);
    for (i, rgba) in out.pixels.chunks_exact_mut(4).enumerate() {
        let (x, y) = (i % TILE, i / TILE);
        let at = corner + DVec2::new(x as f64, y as f64);
        rgba.copy_from_slice(&pixel(scene, camera, bins, visible.pixel(x, y), (at, pattern)));
    }
    out
}

/// Each triangle is looked up once, in the centre of its samples, as in the picture with light.
fn pixel(
    scene: &Scene,
    camera: &Camera,
    bins: &Bins,
    ids: &[u32],
    (at, pattern): (DVec2, &[DVec2]),
) -> [u8; 4] {
    let (mut color, mut covered) = (DVec3::ZERO, 0.0);
    for (k, &id) in ids.iter().enumerate() {
        if id == NONE || ids[..k].contains(&id) {
            continue;
        }
        let Some(flat) = &bins.flats[id as usize] else { continue };
        let mine = ids.iter().zip(pattern).skip(k).filter(|&(&other, _)| other == id);
        let (sum, count) = mine.fold((DVec2::ZERO, 0.0), |(sum, n), (_, &s)| (sum + s, n + 1.0));
        let triangle = &scene.triangles[id as usize];
        color += Place::new(scene, camera, flat, triangle, at + sum / count).color * count;
        covered += count;
    }
    if covered == 0.0 {
        return [0; 4];
    }
    let c = color / covered;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let alpha = (covered / pattern.len() as f64 * 255.0 + 0.5) as u8;
    [srgb(c.x), srgb(c.y), srgb(c.z), alpha]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Background, View, render};

    /// A square of a metre in the plane of the front view, of one linear colour.
    fn square(color: [f32; 3]) -> Model {
        let mesh = mesh::TriMesh {
            positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..mesh::TriMesh::default()
        };
        let look = mesh::Material::plain("plain", mesh::MaterialKind::Other, color);
        let part = mesh::Part { name: "square".into(), material: mesh::MaterialId::new(0), mesh };
        Model { parts: vec![part], materials: vec![look], ..Model::default() }
    }

    fn front(margin: f64) -> PictureSpec {
        let plain =
            PictureSpec { width: 40, height: 40, view: View::Front, margin, ..PictureSpec::default() };
        PictureSpec { background: Background::Transparent, ground_shadow: false, ..plain }
    }

    #[test]
    fn a_surface_has_its_own_colour_under_any_light() {
        let color = [0.5, 0.2, 0.05];
        let want = color.map(|c| srgb(f64::from(c)));
        for sunshine in [0.0, 1.0, 3.0] {
            let spec = PictureSpec { sunshine, skylight: 0.3, exposure: 2.0, ..front(0.0) };
            let seen = albedo(&square(color), &spec, &Run::plain()).expect("not cancelled");
            assert!(seen.pixels.chunks_exact(4).all(|p| p == [want[0], want[1], want[2], 255]));
        }
    }

    #[test]
    fn alpha_is_the_share_that_surfaces_cover_as_in_the_picture() {
        let spec = front(0.23);
        let seen = albedo(&square([0.5; 3]), &spec, &Run::plain()).expect("not cancelled");
        let lit = render(&square([0.5; 3]), &spec, &Run::plain()).expect("not cancelled");
        let alphas = |p: &Picture| p.pixels.iter().copied().skip(3).step_by(4).collect::<Vec<u8>>();
        assert_eq!(alphas(&seen), alphas(&lit));
        let partly = alphas(&seen).iter().filter(|a| (1..255).contains(*a)).count();
        assert!(partly > 50, "{partly} pixels at the edges");
    }
}
