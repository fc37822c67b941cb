//! Pictures of a [`mesh::Model`] without a GPU.
//!
//! `Model -> Scene -> light maps -> tiles of fragments -> Picture`
//!
//! A rasteriser with many samples a pixel, lit by a soft sun and by the whole sky: every light has its own depth map,
//! so that shadows are soft and hollows are dark without noise. Blades transmit light.
//!
//! | module | owns |
//! |---|---|
//! | `spec` | [`PictureSpec`], [`View`], [`Background`]: settings of a picture |
//! | `picture` | [`Picture`], [`contact_sheet`] |
//! | `camera` | [`Camera`]: framing and projection |
//! | `scene` | the model as one list of sound triangles |
//! | `texture` | sRGB tables, textures with halved copies |
//! | `light` | directions, depth maps, light that reaches vertices and ground |
//! | `raster` | the visible triangle of each sample of a tile |
//! | `hits` | [`Hit`]: surface points of beams and pixels, with the triangle |
//! | `trace` | [`Tracer`]: first surfaces that single rays meet |
//! | `albedo` | [`albedo()`]: colour of surfaces without light |
//! | `impostor` | [`impostor()`]: views from all sides in one picture |
//! | `shade` | colour of a fragment and of the background |

mod albedo;
mod camera;
mod hits;
mod impostor;
mod light;
mod picture;
mod raster;
mod scene;
mod shade;
mod spec;
mod texture;
mod trace;

pub use albedo::albedo;
pub use camera::Camera;
pub use hits::{Hit, hits};
pub use impostor::impostor;
pub use picture::{Picture, contact_sheet};
pub use spec::{Background, PictureSpec, Pinhole, View};
pub use trace::Tracer;

use base::{Cancelled, Run};
use mesh::Model;

use light::Sky;
use scene::Scene;

/// Renders a picture of `model`.
///
/// Guaranteed: the same bits for any executor; vertices that are not finite, triangles that name missing vertices
/// and parts that name missing materials are left out; an empty model gives the background alone. Sizes are
/// clamped as [`PictureSpec`] says. Cost: about 2 s of processor time for 115,000 triangles at 1024 x 768, spread
/// over the executor.
///
/// # Errors
/// [`Cancelled`] when the run was cancelled.
///
/// ```
/// let spec = render::PictureSpec { width: 32, height: 24, ..Default::default() };
/// let picture = render::render(&mesh::Model::default(), &spec, &base::Run::plain())?;
/// assert_eq!((picture.width, picture.height, picture.pixels.len()), (32, 24, 32 * 24 * 4));
/// # Ok::<(), base::Cancelled>(())
/// ```
pub fn render(model: &Model, spec: &PictureSpec, run: &Run<'_>) -> Result<Picture, Cancelled> {
    run.cancel.check()?;
    let spec = spec.clamped();
    let View::Turntable { frames } = spec.view else {
        let scene = Scene::new(model);
        let sky = Sky::new(&scene, &spec, run)?;
        let camera = Camera::framing(&scene.points(), &spec);
        return shade::frame(&scene, &sky, &spec, camera, run);
    };
    let columns = columns_for(frames, spec.width, spec.height);
    let rows = frames.div_ceil(columns);
    let frame = PictureSpec { width: spec.width / columns, height: spec.height / rows, ..spec.clone() };
    let mut pictures = turntable(model, &frame, frames, run)?;
    if frames < columns * rows {
        // Empty cells show the background.
        let bare = render(&Model::default(), &PictureSpec { view: View::ThreeQuarter, ..frame }, run)?;
        pictures.resize((columns * rows) as usize, bare);
    }
    let sheet = contact_sheet(&pictures, columns);
    Ok(sheet.resized_canvas(spec.width, spec.height))
}

/// Renders `frames` pictures of `model` turning once around its vertical axis, each of the size in `spec`; `spec.view`
/// is ignored. All frames have one scale, and the light stands still next to the viewer.
///
/// # Errors
/// [`Cancelled`] when the run was cancelled.
pub fn turntable(
    model: &Model,
    spec: &PictureSpec,
    frames: u32,
    run: &Run<'_>,
) -> Result<Vec<Picture>, Cancelled> {
    let frames = frames.clamp(1, spec::MAX_FRAMES);
    let spec = PictureSpec { view: View::Turntable { frames }, ..spec.clone() }.clamped();
    let scene = Scene::new(model);
    let sky = Sky::new(&scene, &spec, run)?;
    let points = scene.points();
    let camera = Camera::framing(&points, &spec);
    (0..frames)
        .map(|k| {
            let angle = base::ops::TAU * f64::from(k) / f64::from(frames);
            shade::frame(&scene, &sky, &spec, camera.turned(angle, &points), run)
        })
        .collect()
}

/// Renders a picture of `model` with a given camera, for films, one picture at a time. `spec.view` is ignored.
///
/// # Errors
/// [`Cancelled`] when the run was cancelled.
///
/// ```
/// use render::Camera;
/// let spec = render::PictureSpec { width: 32, height: 24, ..Default::default() };
/// let (model, run) = (mesh::Model::default(), base::Run::plain());
/// let shot = render::shot(&model, &spec, Camera::framing(&[], &spec), &run)?;
/// assert_eq!(shot, render::render(&model, &spec, &run)?);
/// # Ok::<(), base::Cancelled>(())
/// ```
pub fn shot(model: &Model, spec: &PictureSpec, camera: Camera, run: &Run<'_>) -> Result<Picture, Cancelled> {
    run.cancel.check()?;
    let (spec, scene) = (spec.clamped(), Scene::new(model));
    let sky = Sky::new(&scene, &spec, run)?;
    shade::frame(&scene, &sky, &spec, camera, run)
}

// The layout whose cells are nearest to 4:5 upright, which suits plants.
fn columns_for(frames: u32, width: u32, height: u32) -> u32 {
    let frames = frames.max(1);
    let badness = |columns: u32| {
        let rows = frames.div_ceil(columns);
        let aspect =
            (f64::from(width) / f64::from(columns)) / (f64::from(height) / f64::from(rows)).max(1.0) / 0.8;
        let empty = f64::from(columns * rows - frames) / f64::from(frames);
        aspect.max(1.0 / aspect.max(1e-9)) + empty
    };
    (1..=frames).min_by(|&a, &b| badness(a).total_cmp(&badness(b))).unwrap_or(1)
}
