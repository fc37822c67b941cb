//! Plants to meshes and materials.
//!
//! `Plant -> spines -> tubes with fillets | shapes -> placed copies -> Model`
//!
//! Axes become closed tubes: rings on rotation-minimising frames, as many as it takes to follow the axis; axes that
//! continue one another become one tube; side branches get a fillet on their bearers as these are drawn. Leaves and
//! petals become constrained Delaunay sheets, one per shape, copied and tinted for each organ. Every kind of surface is
//! one part with one material and a procedural texture.
//!
//! | module | owns |
//! |---|---|
//! | `spec` | [`SkinSpec`], [`LeafMeshSpec`], [`PetalColor`]; the distribution of triangles |
//! | `spine`, `rings`, `sleeve`, `tube` | smooth centre lines, cross-sections, their triangles, [`tube`] |
//! | `fork`, `axes` | fillets at forks; the grouping of axes into tubes |
//! | `stub_end`, `hollow` | ends of stubs; cavities in stems |
//! | `blade`, `lean`, `body`, `organs` | [`blade_mesh`], [`BladeChart`]; leaves of a crown; discs, fruits, strands;
//! placed copies |
//! | `layout`, `copies` | [`Layout`]: position of axes and organs in the parts; [`copies()`]: leaves that share one
//! form |
//! | `coarser` | [`coarser()`]: copies of a plant with fewer leaves and axes, for a distant view |
//! | `labels` | [`Labels`]: the parts that triangles lie on, by the rows of [`PARTS`] |
//! | `site` | [`make_site`]: soil, stones and pots |
//! | `needles` | shoots in needles, painted on cards |
//! | `shoots` | [`FoliageStyle`], [`Shoots`]: leaves as cards, several on one |
//! | `leaf` | [`ShapeMesh`]: leaves of measured veins, sheets |
//! | `coloured` | stems in colours of their own |
//! | `traced` | [`Traced`]: organs in the colours of a photograph |
//! | `material`, `margin` | [`OrganMaterial`], [`Wear`]: materials that a user chose; the distance of vertices from the
//! margin |
//! | `wind`, `sway` | weights and pivots for wind; [`sway()`]: joints that move by them |
//! | `texture`, `parts` | painted textures, materials, parts |

mod axes;

mod blade;
mod body;
mod coarser;
mod colliders;
mod coloured;
mod copies;
mod fork;
mod hollow;
mod labels;
mod layout;
mod leaf;
mod lean;
mod margin;
mod material;
mod natural;
mod needles;
mod organs;
mod parts;
mod pictures;
mod rings;
mod shoots;
mod simpler;
mod site;
mod sleeve;
mod solid;
mod spec;
mod spikes;
mod spine;
mod stub_end;
mod sway;
mod texture;
mod traced;
mod tube;
mod wind;

pub use self::axes::tubes_of;
pub use self::spec::{BarkSpec, LeafMeshSpec, PetalColor, SkinSpec};
pub use blade::{BladeChart, blade_mesh};
pub use coarser::{coarser, coarser_with, keep_out};
pub use colliders::{colliders, joined_colliders};
pub use copies::copies;
pub use labels::{
    Label, Labels, NOTHING, PART_OF_SOIL, PART_OF_STONE, PARTS, part_is_of_axis, part_of_axis, part_of_organ,
    triangle_labels,
};
pub use layout::{Layout, Owner};
pub use leaf::ShapeMesh;
pub use material::{Cloth, MATERIALS, OrganMaterial, Pattern, StrokeWear, Wear, Wearer, Worn};
pub use natural::{BarkKind, VeinPattern};
pub use organs::KeptShapes;
pub use pictures::SurfacePictures;
pub use shoots::{FoliageStyle, Shoots};
pub use site::{PotSpec, SceneSite, SceneSiteSpec, make_site};
pub use solid::{Solid, SolidError, SolidSpec, solid};
pub use sway::{gust, sway};
pub use texture::{CloudColours, LeafColours, swatch, vein_texture};
pub use traced::Traced;
pub use tube::{TubeSpec, tube};

use base::{Run, Stopped};
use glam::DVec3;
use mesh::{Model, TriMesh};
use plant::{AxisKind, Plant};

use crate::axes::Surface;
use crate::layout::Piece;
use crate::parts::Slot;
use crate::spec::Budget;

/// Gives a plant its surface: meshes with normals, texture coordinates and materials.
///
/// Guaranteed, for any plant: finite coordinates, unit normals, no triangle that uses a vertex twice
/// ([`Model::validate`] is clean); every tube closed (a stub by its bark together with the wood where it broke off; the
/// bark of a hollow stem is open behind the rim, where a cavity begins); wood is drawn where the plant has it, to 0.07
/// % of the plant's size and within its own radius (both over [`SkinSpec::detail`]); the same bits for any executor.
/// One part per kind of surface, in the order bark, dead wood, stems, roots, leaves, veins, petals, discs, fruits,
/// stamens, thorns; kinds that do not occur leave no part. Organs have vertex colours: their paint, varied by seed and
/// key. A tinted or drawn organ has a texture without a hue of its own. Organs that wear a material
/// ([`SkinSpec::worn`]) have its colours, varied in the same way, and parts of their own after all others. With
/// [`SkinSpec::wind`] every vertex also has four numbers, each 0 to 1, and a pivot: sway of the whole plant (0 on the
/// ground, 1 at the top, by the square of the height); sway of its limb, a branch of a main axis with all that hangs on
/// it (0 at the limb's foot, growing with the square of the length along the wood over all forks, 1 after the longest
/// such length in the plant or half of its height, if that is more; 0 on main axes and roots); flutter (0 on wood and
/// at a blade's root, 1 at its tip); and a phase that is common to a limb, leaves included. The pivot is the limb's
/// foot for wood, the root of the organ for organs. Weights are continuous where a branch leaves its bearer or an organ
/// its twig: they differ by less than 0.01 from those of the bearer's mesh there. For that long axes get up to a dozen
/// additional rings; nothing else of the mesh changes. Not guaranteed: that organs do not intersect, or that tubes at a
/// fork share vertices. A side branch's foot lies inside its bearer, except for one or two branches in ten thousand:
/// thin twigs that run along their bearer, or start on its fillet, may miss it by some millimetres. Cost: linear in
/// axes and organs; about 70 ns a triangle. The first use of a kind of surface also paints its textures (bark of 512
/// pixels about 70 ms on one thread). A shape's triangulation costs 0.6 us a triangle, once for all its organs.
///
/// # Errors
/// [`Stopped`] when the caller's token is cancelled, or when there would be more triangles than the budget allows.
///
/// He and Cheng (2021), sections 5.3 and 6.
///
/// ```
/// use glam::DVec3;
/// use plant::{AxisKind, Plant};
/// let mut p = Plant::default();
/// p.add_axis(AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y, DVec3::new(0.2, 2.0, 0.0)], None);
/// p.nodes.radius_m = vec![0.05, 0.04, 0.02];
/// let model = skin::skin(&p, &skin::SkinSpec::default(), &base::Run::plain())?;
/// assert_eq!((model.parts[0].name.as_str(), model.validate().count()), ("branches", 0));
/// # Ok::<(), base::Stopped>(())
/// ```
pub fn skin(plant: &Plant, spec: &SkinSpec, run: &Run<'_>) -> Result<Model, Stopped> {
    skin_again(plant, spec, SurfacePictures::default(), None, run)
}

/// As [`skin()`], again for a plant that changed slightly: unchanged shapes are not triangulated again. Organs and axes
/// that were traced over a photograph take their texture from it.
///
/// Guaranteed: the same surface; traced parts come last, have the photograph as their texture and coordinates within
/// it.
///
/// # Errors
/// [`Stopped`] when the caller's token is cancelled, or when there would be more triangles than the budget allows.
pub fn skin_again(
    plant: &Plant,
    spec: &SkinSpec,
    pictures: SurfacePictures<'_>,
    kept: Option<&mut KeptShapes>,
    run: &Run<'_>,
) -> Result<Model, Stopped> {
    Ok(skin_laid_out(plant, spec, pictures, kept, run)?.0)
}

/// As [`skin_again`], with the position of axes and organs in the parts.
///
/// # Errors
/// [`Stopped`] when the caller's token is cancelled, or when there would be more triangles than the budget allows.
pub fn skin_laid_out(
    plant: &Plant,
    spec: &SkinSpec,
    pictures: SurfacePictures<'_>,
    kept: Option<&mut KeptShapes>,
    run: &Run<'_>,
) -> Result<(Model, Layout), Stopped> {
    run.cancel.check()?;
    let (budget, traced) = (budget(plant, spec), pictures.traced);
    let slot = |surface| match surface {
        Surface::Bark => Slot::Bark,
        Surface::YoungBark => Slot::YoungBark,
        Surface::DeadWood => Slot::DeadWood,
        Surface::Stem => Slot::Stem,
        Surface::Flesh => Slot::Body,
        Surface::Root => Slot::Root,
    };
    let (tubes, wind) = axes::tubes(plant, spec, &budget, traced, run)?;
    let slot_of = |t: &axes::Tube| if t.traced { slot(t.surface).traced() } else { slot(t.surface) };
    let mut meshes: Vec<_> = tubes
        .into_iter()
        .map(|t| (slot_of(&t), vec![Piece::tube(&t.axes, t.mesh.triangles.len())], t.mesh))
        .map(|(slot, pieces, mesh)| (slot, mesh, pieces))
        .collect();
    let wood = meshes.iter().map(|(_, m, _): &(Slot, TriMesh, _)| m.triangles.len()).sum();
    meshes.extend(organs::organs(plant, spec, &budget, (traced, wood), wind.as_ref(), kept, run)?);
    run.cancel.check()?;
    Ok(parts::model(plant, meshes, spec, pictures, run)?)
}

/// Returns the vertices of each shape of a plant as [`skin()`] draws it, at scale 1; empty for an unused shape.
pub fn drawn_shapes(plant: &Plant, spec: &SkinSpec) -> Vec<Vec<DVec3>> {
    organs::vertices(plant, spec, &budget(plant, spec))
}

/// Returns the mesh of each shape of a plant as [`skin()`] draws it, at scale 1 in the coordinates of its organs,
/// including its veins; empty for an unused shape. No colours.
pub fn shape_meshes(plant: &Plant, spec: &SkinSpec) -> Vec<TriMesh> {
    organs::meshes(plant, spec, &budget(plant, spec))
}

/// Returns the area of each shape of a plant as [`skin()`] draws it, at scale 1, one side, square metres; 0 for an
/// unused shape. Cost: that of triangulating each shape once.
pub fn drawn_areas(plant: &Plant, spec: &SkinSpec) -> Vec<f64> {
    organs::areas(plant, spec, &budget(plant, spec))
}

/// Returns the triangles of each shape of a plant as [`skin()`] draws it, without veins; 0 for an unused shape. Cost:
/// that of triangulating each shape once.
pub fn drawn_triangles(plant: &Plant, spec: &SkinSpec) -> Vec<usize> {
    organs::triangles(plant, spec, &budget(plant, spec))
}

/// Remedy for too many triangles.
pub(crate) const FEWER: &str = "lower the detail (or sides), or make fewer branches or leaves";

fn budget(plant: &Plant, spec: &SkinSpec) -> Budget {
    let bounds = bounds(plant);
    let (mut length, mut counted) = (0.0, 0_u32);
    for axis in plant.axes.iter().filter(|a| a.kind != AxisKind::Petiole) {
        let points = plant.nodes.position.get(axis.nodes.start as usize..axis.nodes.end as usize);
        let own: f64 = points.unwrap_or_default().windows(2).map(|w| w[0].distance(w[1])).sum();
        if own.is_finite() {
            length += own;
            counted += 1;
        }
    }
    let size = spec.steady_m.unwrap_or_else(|| bounds.size().length());
    let mean = if counted > 0 { length / f64::from(counted) } else { 1.0 };
    let [axes, organs] = spec.crowd.unwrap_or([counted as usize, plant.organs.len()]);
    Budget::new(spec.detail, size, mean, axes, organs)
}

/// Returns the box around nodes and organs.
fn bounds(plant: &Plant) -> mesh::Bounds {
    plant.extent().map_or(mesh::Bounds::EMPTY, |(min, max)| mesh::Bounds { min, max })
}
