//! Measured leaves -> models: one leaf, a whole shoot, the blade of another maker's plant.

use std::sync::Arc;

use base::{Report, Run, Seed};
use document::PlantEdit;
use leaf::{FullMarks, Leaf, LeafSpec, Marks};
use makers::{LeafError, LeafLook, LeafyPlant, ShootSpec};
use mesh::{Texture, TriMesh};
use plant::{Plant, PlantPaint, ShapeId};
use skin::{KeptShapes, LeafColours, ShapeMesh, SkinSpec, SurfacePictures};

use crate::checks::check_leaf;
use crate::made::MadePlant;
use crate::report::{FaceCounts, LeafFit, LeafReport};
use crate::shaping::shaped;

/// Options of a leaf in addition to its marks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeafOptions {
    /// Surface, veins, resolution, curl, wilt, colour.
    pub spec: LeafSpec,
    /// Skin settings: `detail`, `wind`, `worn`. Settings of the blade come from the spec.
    pub skin: SkinSpec,
    /// A picture of the pressed leaf that replaces the spec's colour, cropped to its box, tip at the top.
    pub picture: Option<Arc<Texture>>,
    /// Side veins on either side of a chief vein in each lobe of a palmate leaf, 0 to 12; made by rule.
    pub side_veins: u32,
    /// Hand edits, applied to the plant in this order.
    pub edits: Vec<PlantEdit>,
}

/// Green of the stem, linear.
const STEM: [f32; 3] = [0.18, 0.30, 0.07];

/// Makes a leaf and its meshes from marks (Wang et al. 2011).
///
/// # Errors
/// [`LeafError`].
pub fn make_leaf(
    name: &str,
    marks: &Marks,
    options: &LeafOptions,
    seed: Seed,
    run: &Run<'_>,
) -> Result<MadePlant, LeafError> {
    let mut report = Report::default();
    let full = marks.complete(&mut report)?;
    make_leaf_of(name, &full, options, seed, run, report)
}

/// Makes a leaf as [`make_leaf`] does, from complete marks, and adds to an existing report.
///
/// [`LeafSpec::shaped`] returns the marks as they are meshed.
///
/// # Errors
/// [`LeafError`].
pub fn make_leaf_of(
    name: &str,
    marks: &FullMarks,
    options: &LeafOptions,
    seed: Seed,
    run: &Run<'_>,
    mut report: Report,
) -> Result<MadePlant, LeafError> {
    let (leafy, leaf, marks) = makers::build_leaf(name, marks, &options.look(), seed, run, &mut report)?;
    let (mut made, mesh) = finish(leafy, options, run, &mut report)?;
    let told = leaf_report(&marks, &leaf, &mesh, options);
    let crossings = geom::self_crossings(&leaf::leaf_blade(&leaf, &marks, 1.0).outline);
    made = made.check(|r| check_leaf(&told, Some(crossings), r));
    made.item.leaf = Some(told);
    Ok(made)
}

/// Makes a plant of leaves on one stem, see [`makers::build_shoot`].
///
/// # Errors
/// [`LeafError`].
pub fn make_shoot(
    name: &str,
    forms: &[FullMarks],
    spec: &ShootSpec,
    options: &LeafOptions,
    seed: Seed,
    run: &Run<'_>,
) -> Result<MadePlant, LeafError> {
    let mut report = Report::default();
    let leafy = makers::build_shoot(name, forms, spec, (&options.look(), seed), run, &mut report)?;
    let (mut made, _) = finish(leafy, options, run, &mut report)?;
    made.item.plant = Some(made.plant.measure());
    Ok(made)
}

/// Applies hand edits to a plant of measured leaves and makes its meshes, its report, and the mesh of its first leaf.
pub(crate) fn finish(
    LeafyPlant { mut plant, textures }: LeafyPlant,
    options: &LeafOptions,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<(MadePlant, ShapeMesh), LeafError> {
    debug_assert_eq!(plant.validate().next(), None, "a sound plant");
    let veins = base::linear_color(LeafColours::default().wilted(options.spec.wilt).vein);
    plant.paint = PlantPaint { stem: Some(mean_of_axes(&plant).unwrap_or(STEM)), veins: Some(veins) };
    let (plant, edits) = shaped(plant, &options.edits, run)?;
    let mut kept = KeptShapes::default();
    let skin = options.skin.clone();
    let worn = skin.worn.clone().always(skin.textures);
    let spec = SkinSpec { leaf: options.look().mesh(), textures: false, variation: 0.0, worn, ..skin };
    let pictures = SurfacePictures { leaves: &textures, ..SurfacePictures::default() };
    let model = report
        .stage("mesh", run.clock, |_| skin::skin_laid_out(&plant, &spec, pictures, Some(&mut kept), run));
    let model = model?;
    let mesh = kept.get(ShapeId::new(0)).cloned().unwrap_or_default();
    if mesh.crossing > 0 {
        base::warn!(
            report,
            "vein-crossing",
            { count = mesh.crossing },
            "{count} rings of veins are thicker than their vein bends: they cut themselves"
        );
    }
    if mesh.swallowed > 0 {
        base::warn!(
            report,
            "ring-swallowed",
            { count = mesh.swallowed },
            "{count} rings lie inside their neighbours' balls and were drawn to a point"
        );
    }
    Ok((MadePlant::untold(plant, (model, spec), (edits, &options.edits), report).with_digest(), mesh))
}

/// Returns the mean colour of the axes that have one.
fn mean_of_axes(plant: &Plant) -> Option<[f32; 3]> {
    let colors: Vec<[f32; 3]> = plant.axes.iter().flat_map(|a| a.colors.iter().copied()).collect();
    #[expect(clippy::cast_precision_loss, reason = "twelve an axis")]
    let count = colors.len() as f32;
    (count > 0.0).then(|| [0, 1, 2].map(|k| colors.iter().map(|c| c[k]).sum::<f32>() / count))
}

impl LeafOptions {
    /// Returns what the makers of leaves read of these options.
    pub fn look(&self) -> LeafLook<'_> {
        LeafLook { spec: &self.spec, picture: self.picture.as_ref() }
    }
}

fn leaf_report(marks: &FullMarks, leaf: &Leaf, meshes: &ShapeMesh, options: &LeafOptions) -> LeafReport {
    let counts = |mesh: &TriMesh, faces: usize| FaceCounts {
        vertices: mesh.positions.len() as u64,
        faces: faces as u64,
    };
    let (us, vs) = (leaf.blade.columns_at(), leaf.blade.rows_at());
    let mut distances = Vec::new();
    for (row, &v) in marks.rows.iter().rev().zip(vs) {
        let near = row.points.iter().rev().zip(us);
        distances.extend(near.map(|(p, &u)| p.distance(leaf.blade.point(u, v))));
    }
    LeafReport {
        surface: options.spec.surface.word().into(),
        rows: marks.rows.len() as u64,
        length_mm: 1e3 * geom::polyline_length3(&marks.midrib()),
        area_mm2: 1e6 * meshes.surface.area(),
        veins: counts(&meshes.veins, meshes.vein_faces),
        blade: counts(&meshes.surface, meshes.blade_faces),
        fit_error: LeafFit::from_distances(&distances),
        vein_gap_mm: Some(1e3 * leaf.vein_gap(8)),
        swallowed_rings: swallowed(options, meshes),
        crossing_rings: Some(meshes.crossing as u64),
        scan: None,
    }
}

/// Counts the rings that the exact surface of the veins swallows; `None` for plain rings.
pub(crate) fn swallowed(options: &LeafOptions, meshes: &ShapeMesh) -> Option<u64> {
    (options.spec.rings == geom::RingRule::Envelope).then_some(meshes.swallowed as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use leaf::{LeafPaint, leaf_blade};

    fn read(k: u32) -> FullMarks {
        let path = format!("{}/../../fixtures/leaves/leaf{k}.csv", env!("CARGO_MANIFEST_DIR"));
        let bytes = std::fs::read(path).unwrap();
        let read = formats::read_marks(bytes.as_slice(), "leaf", formats::MarksAxes::default()).unwrap();
        assert_eq!(read.warnings, []);
        let mut report = Report::default();
        let full = read.marks.complete(&mut report).unwrap();
        assert_eq!(report.warnings, []);
        full
    }

    #[test]
    fn fixtures_have_the_counts_of_table_1() {
        let want = [(1, 3610, 3500, 1581, 1500), (2, 6130, 5950, 2666, 2550), (3, 5050, 4900, 2201, 2100)];
        for (k, veins, quads, blade, cells) in want {
            for surface in leaf::SurfaceKind::ALL {
                let spec = LeafSpec { surface, texture: LeafPaint::Plain, ..LeafSpec::default() };
                let options = LeafOptions { spec, ..LeafOptions::default() };
                let made =
                    make_leaf("t", &read(k).to_marks(), &options, Seed::new(1), &Run::plain()).unwrap();
                let about = made.item.leaf.unwrap();
                assert_eq!(about.veins, FaceCounts { vertices: veins, faces: quads }, "{k} {surface:?}");
                assert_eq!(about.blade, FaceCounts { vertices: blade, faces: cells }, "{k} {surface:?}");
                assert!(about.vein_gap_mm.unwrap() < 1e-6, "{k} {surface:?}: {:?}", about.vein_gap_mm);
                let exact = surface == leaf::SurfaceKind::Interpolate;
                assert_eq!(about.fit_error.max_mm < 1e-9, exact, "{k} {surface:?}: {:?}", about.fit_error);
                assert_eq!(about.crossing_rings, Some(0), "{k} {surface:?}");
                assert_eq!(made.model.validate().next(), None);
            }
        }
    }

    #[test]
    fn digest_does_not_depend_on_the_executor() {
        struct Backwards;
        impl base::Executor for Backwards {
            fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
                (0..n).rev().for_each(job);
            }
        }
        let forms = [read(1), read(3)];
        let spec = ShootSpec { leaves: 7, ..ShootSpec::default() };
        let options = LeafOptions {
            spec: LeafSpec { subdivisions: 2, sides: 5, ..LeafSpec::default() },
            ..LeafOptions::default()
        };
        let run = Run::plain();
        let back = Run { executor: &Backwards, ..run };
        let a = make_shoot("t", &forms, &spec, &options, Seed::new(2), &run).unwrap();
        let b = make_shoot("t", &forms, &spec, &options, Seed::new(2), &back).unwrap();
        assert_eq!((&a.item.digest, &a.plant), (&b.item.digest, &b.plant));
        assert_eq!(a.model.validate().next(), None);
        assert_eq!(a.plant.validate().next(), None);
        assert_eq!((a.item.counts.leaves, a.item.counts.axes), (Some(7), Some(1)));
        let other = make_shoot("t", &forms, &spec, &options, Seed::new(3), &run).unwrap();
        assert_ne!(a.item.digest, other.item.digest);
    }

    #[test]
    fn blade_of_a_measured_leaf_is_sound_and_as_long_as_asked() {
        for k in 1..=3 {
            let marks = read(k);
            let leaf = Leaf::new(&marks, &LeafSpec::default()).unwrap();
            let blade = leaf_blade(&leaf, &marks, 0.25);
            assert!((blade.length() - 0.25).abs() < 1e-12);
            assert!(geom::signed_area(&blade.outline) > 0.0);
            assert_eq!(geom::self_crossings(&blade.outline), 0, "{k}");
            // All three leaves bend downwards and are folded upwards.
            assert!(blade.relief.bend_b > 0.0 || blade.relief.bend_a > 0.0, "{:?}", blade.relief);
            assert!(blade.relief.fold > 0.0, "{:?}", blade.relief);
        }
    }
}
