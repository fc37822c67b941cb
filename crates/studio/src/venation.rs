//! Chief veins that start together -> a model: palmate and parallel leaves.

use base::{Counted, Report, Run, ops};
use leaf::{LeafColours, RayLeaf, Rays};
use mesh::{MaterialId, Model, Part};

use crate::leaves::{FaceCounts, FitError, LeafError, LeafOptions, LeafReport, area, digest, leaf_materials};
use crate::{Counts, ItemReport, TimingsMs};

/// Makes a leaf whose chief veins start together: parts `blade` and `veins`.
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
) -> Result<(Model, ItemReport), LeafError> {
    let mut report = Report::default();
    let leaf = report.stage("structure", run.clock, |_| {
        RayLeaf::new(rays, options.spec.thickness).map(|mut leaf| {
            leaf.add_side_veins(rays, options.side_veins as usize);
            leaf
        })
    })?;
    run.cancel.check()?;
    let colours = LeafColours::default();
    let [blade, vein] = [colours.blade, colours.vein].map(|c| c.map(crate::leaves::linear_of));
    // A fiftieth of the leaf: as far as the pale band beside a chief vein is seen; less where veins stand close.
    let apart = leaf.veins.windows(2).map(|w| {
        let at = |v: &leaf::Vein| v.curve.ball(0.5).centre;
        at(&w[0]).distance(at(&w[1]))
    });
    let reach = apart.fold(0.02 * rays.length(), |reach, d| reach.min(0.3 * d)).max(1e-9);
    let shade = |distance: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "colours are f32 in meshes")]
        let share = ops::smoothstep(0.0, reach, distance) as f32;
        core::array::from_fn(|k| vein[k] + (blade[k] - vein[k]) * (0.3 + 0.7 * share))
    };
    let spans = leaf.veins.iter().chain(&leaf.sides).map(|v| v.marks.len().saturating_sub(1)).sum::<usize>();
    let (steps, sides) = (options.mesh.subdivisions as u64, options.mesh.sides as u64);
    let squares = (leaf.blade.columns_at().len() * leaf.blade.rows_at().len()) as u64;
    let triangles = 2 * (spans as u64 * steps * sides + squares * steps * steps);
    run.budget.check(Counted::Triangles, triangles, "lower subdivisions, sides or side-veins")?;
    let meshes = report.stage("mesh", run.clock, |_| leaf.mesh(&options.mesh, shade));
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
        area_mm2: 1e6 * area(&meshes.blade),
        veins: counts(&meshes.veins, meshes.vein_faces),
        blade: counts(&meshes.blade, meshes.blade_faces),
        fit_error: FitError::of(&distances),
        vein_gap_mm: Some(1e3 * leaf.vein_gap(8)),
        swallowed_rings: crate::leaves::swallowed(options, &meshes),
        crossing_rings: Some(meshes.crossing as u64),
        scan: None,
    };
    let mut model = Model { name: name.into(), ..Model::default() };
    let mut materials = leaf_materials(None, 0.0);
    materials[0].base_color = [1.0; 3];
    model.materials = materials.into();
    let part =
        |name: &str, material, mesh| Part { name: name.into(), material: MaterialId::new(material), mesh };
    model.parts = vec![part("blade", 0, meshes.blade), part("veins", 1, meshes.veins)];
    let counts = Counts {
        leaves: Some(1),
        vertices: model.vertex_count() as u64,
        triangles: model.triangle_count() as u64,
        ..Counts::default()
    };
    let item = ItemReport {
        name: name.into(),
        counts,
        timings_ms: TimingsMs::from_report(&report),
        digest: digest(&model),
        leaf: Some(about),
        ..ItemReport::default()
    };
    Ok((model, item))
}
