//! Chief veins with a common start -> a model: palmate and parallel leaves.

use base::{Report, Run};
use leaf::Rays;
use makers::{LeafError, RayLeafParts};

use crate::leaves::{LeafOptions, finish, swallowed};
use crate::made::MadePlant;
use crate::report::{FaceCounts, LeafFit, LeafReport};

/// Makes a leaf whose chief veins have a common start.
///
/// The blade's colour is on its vertices, by the distance from the nearest vein. Of `options` thickness, resolution,
/// rings and `side_veins` are used.
///
/// # Errors
/// [`LeafError::Rays`], [`LeafError::Cancelled`].
pub fn make_ray_leaf(
    name: &str,
    rays: &Rays,
    options: &LeafOptions,
    run: &Run<'_>,
) -> Result<MadePlant, LeafError> {
    let mut report = Report::default();
    let built = makers::build_ray_leaf(name, rays, (&options.look(), options.side_veins), run, &mut report)?;
    let RayLeafParts { leafy, leaf, rays } = built;
    let (mut made, meshes) = finish(leafy, options, run, &mut report)?;
    let (us, vs) = (leaf.blade.columns_at(), leaf.blade.rows_at());
    let mut distances = Vec::new();
    for (ray, &u) in rays.rays.iter().rev().zip(us) {
        distances.extend(ray.points.iter().zip(vs).map(|(p, &v)| p.distance(leaf.blade.point(u, v))));
    }
    let counts = |mesh: &mesh::TriMesh, faces: usize| FaceCounts {
        vertices: mesh.positions.len() as u64,
        faces: faces as u64,
    };
    let about = LeafReport {
        surface: options.spec.surface.word().into(),
        rows: rays.rays.len() as u64,
        length_mm: 1e3 * rays.length(),
        area_mm2: 1e6 * meshes.surface.area(),
        veins: counts(&meshes.veins, meshes.vein_faces),
        blade: counts(&meshes.surface, meshes.blade_faces),
        fit_error: LeafFit::from_distances(&distances),
        vein_gap_mm: Some(1e3 * leaf.vein_gap(8)),
        swallowed_rings: swallowed(options, &meshes),
        crossing_rings: Some(meshes.crossing as u64),
        scan: None,
    };
    made.item.leaf = Some(about);
    Ok(made)
}
