//! Chief veins with a common start -> a model: palmate and parallel leaves.

use base::{Counted, Report, Run};
use leaf::{RayLeaf, Rays};
use plant::{Paint, Plant, VeinShade};
use skin::LeafColours;

use crate::leaves::{LeafError, LeafOptions, bear, finish};
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
    let rays = &options.spec.shaped_rays(rays)?;
    let leaf = report.stage("structure", run.clock, |_| {
        RayLeaf::new(rays, options.spec.thickness.unwrap_or_default()).map(|mut leaf| {
            leaf.add_side_veins(rays, options.side_veins as usize);
            leaf
        })
    })?;
    run.cancel.check()?;
    let colours = LeafColours::default().wilted(options.spec.wilt);
    let [blade, vein] = [colours.blade, colours.vein].map(|c| c.map(crate::leaves::linear_of));
    // A fiftieth of the leaf: the visible width of the pale band along a chief vein; less where veins are close
    // together.
    let apart = leaf.veins.windows(2).map(|w| {
        let at = |v: &plant::Vein| v.curve.ball(0.5).centre;
        at(&w[0]).distance(at(&w[1]))
    });
    let reach = apart.fold(0.02 * rays.length(), |reach, d| reach.min(0.3 * d)).max(1e-9);
    let shade = VeinShade { vein, blade, reach_m: reach };
    let spans = leaf.veins.iter().chain(&leaf.sides).map(|v| v.marks.len().saturating_sub(1)).sum::<usize>();
    let (steps, sides) = (u64::from(options.spec.subdivisions), u64::from(options.spec.sides));
    let squares = (leaf.blade.columns_at().len() * leaf.blade.rows_at().len()) as u64;
    let triangles = 2 * (spans as u64 * steps * sides + squares * steps * steps);
    run.budget.check(Counted::Triangles, triangles, "lower subdivisions, sides or side-veins")?;
    let mut plant = Plant { name: name.into(), ..Plant::default() };
    bear(&mut plant, leaf.blade(shade), None, Paint::Tinted([1.0; 3]), 1);
    let (mut made, meshes) = finish(plant, &[], options, run, &mut report)?;
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
        swallowed_rings: crate::leaves::swallowed(options, &meshes),
        crossing_rings: Some(meshes.crossing as u64),
        scan: None,
    };
    made.item.leaf = Some(about);
    Ok(made)
}
