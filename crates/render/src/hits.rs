//! First surface that each beam of a scanner, or each pixel of a camera, meets.

use base::{Cancelled, Run, map_until_cancelled};
use glam::{DVec2, DVec3};
use mesh::Model;

use crate::camera::Camera;
use crate::raster::{Bins, NONE, TILE, Visible};
use crate::scene::Scene;
use crate::spec::PictureSpec;

/// Surface point that one beam meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Index of the pixel, from the upper left along the rows of the picture.
    pub pixel: u32,
    /// Row of [`Model::parts`].
    pub part: u32,
    /// Row of the part's triangles.
    pub triangle: u32,
    /// Position on the triangle, metres.
    pub at: DVec3,
    /// Normal of the triangle, a unit vector towards the scanner.
    pub normal: DVec3,
    /// Unit vector from the scanner to the point.
    pub beam: DVec3,
    /// Distance from the scanner, metres; in an orthographic view, from the plane through the origin of the view.
    pub distance_m: f64,
}

/// Returns the points that the beams through the centres of all pixels meet, from each of several views; beams without
/// a hit are left out.
///
/// Guaranteed: the same bits for any executor; in the order of views and pixels; holes of textures let beams through.
/// As in [`crate::render`], unsound input is left out, and sizes are clamped. Of a turntable only the first view is
/// used. Cost: linear in triangles and pixels, about 40 ns a triangle for each view.
///
/// # Errors
/// [`Cancelled`] when the run was cancelled.
///
/// ```
/// let mut mesh = mesh::TriMesh::default();
/// mesh.positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// mesh.triangles = vec![[0, 1, 2]];
/// let look = mesh::Material::plain("plain", mesh::MaterialKind::Other, [0.5; 3]);
/// let part = mesh::Part { name: "one".into(), material: mesh::MaterialId::new(0), mesh };
/// let model = mesh::Model { parts: vec![part], materials: vec![look], ..Default::default() };
/// let view = render::PictureSpec { width: 64, height: 64, view: render::View::Front, ..Default::default() };
/// let seen = render::hits(&model, &[view], &base::Run::plain())?;
/// assert!(seen[0].len() > 1000 && seen[0].iter().all(|h| h.at.z == 0.0 && (h.part, h.triangle) == (0, 0)));
/// # Ok::<(), base::Cancelled>(())
/// ```
pub fn hits(model: &Model, views: &[PictureSpec], run: &Run<'_>) -> Result<Vec<Vec<Hit>>, Cancelled> {
    run.cancel.check()?;
    let scene = Scene::placed(model);
    let points = scene.points();
    views
        .iter()
        .map(|view| {
            run.cancel.check()?;
            let view = view.clamped();
            let camera = Camera::framing(&points, &view);
            let bins = Bins::new(&scene, &camera, view.width, view.height);
            let of_tile = |tile| tile_hits(&scene, &bins, &camera, &view, tile);
            let tiles = map_until_cancelled(run, bins.columns * bins.rows, of_tile)?;
            let mut seen: Vec<Hit> = tiles.into_iter().flatten().collect();
            seen.sort_unstable_by_key(|h| h.pixel);
            Ok(seen)
        })
        .collect()
}

#[expect(clippy::cast_possible_truncation, reason = "pixels of a picture of at most 8192 x 8192")]
fn tile_hits(scene: &Scene, bins: &Bins, camera: &Camera, view: &PictureSpec, tile: usize) -> Vec<Hit> {
    if bins.faces_in(tile).is_empty() {
        return Vec::new();
    }
    let middle = [DVec2::splat(0.5)];
    let visible = Visible::draw(scene, bins, tile, &middle, camera.is_perspective());
    let (x0, y0) = (tile % bins.columns * TILE, tile / bins.columns * TILE);
    let (width, height) = (view.width as usize, view.height as usize);
    let mut hits = Vec::new();
    for (row, &id) in visible.ids.iter().enumerate().filter(|(_, id)| **id != NONE) {
        let (x, y) = (x0 + row % TILE, y0 + row / TILE);
        let (Some(flat), true) = (&bins.flats[id as usize], x < width && y < height) else { continue };
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let corners = scene.corners(&scene.triangles[id as usize]).map(|v| v.at);
        let w = flat.surface_weights(pixel, camera.is_perspective());
        let at = corners[0] * w.x + corners[1] * w.y + corners[2] * w.z;
        let (eye, beam) = camera.ray(pixel);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or(-beam);
        let normal = if normal.dot(beam) > 0.0 { -normal } else { normal };
        let Some(&[part, triangle]) = scene.places.as_ref().and_then(|p| p.get(id as usize)) else {
            continue;
        };
        let distance_m = (at - eye).dot(beam);
        hits.push(Hit { pixel: (y * width + x) as u32, part, triangle, at, normal, beam, distance_m });
    }
    hits
}
