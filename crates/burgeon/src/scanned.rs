//! Scans of one leaf or of the organs of a plant -> a plant with its meshes and its report.

use base::{Report, Run};
use bloom::{OrganPoints, ShapeError};
use glam::DVec3;
use leaf::{LeafPaint, LeafSpec, ScanLeaf, ScanSpec};
use makers::{LeafError, OrganFit, SeedlingError};
use mesh::PointCloud;

use crate::checks::{check_leaf, check_organs};
use crate::leaves::{LeafOptions, finish};
use crate::made::MadePlant;
use crate::report::{FaceCounts, LeafFit, LeafReport, ScanReport};

/// Options for making a plant of the organs of a scan.
#[derive(Clone, Debug)]
pub struct SeedlingOptions {
    /// Settings for finding its blades.
    pub scan: ScanSpec,
    /// Hand edits and meshes.
    pub leaf: LeafOptions,
}

impl Default for SeedlingOptions {
    fn default() -> Self {
        let spec = LeafSpec { texture: LeafPaint::Plain, caps: true, ..LeafSpec::default() };
        // Leaves of a seedling are small: half of the grid of a leaf that was scanned by itself.
        let scan = ScanSpec { rows: 32, columns: 21, ..ScanSpec::default() };
        Self { scan, leaf: LeafOptions { spec, ..LeafOptions::default() } }
    }
}

/// Distance from the leaf, as a share of its length, beyond which points are reported: a torn and folded leaf has 0.03.
const UNLIKE: f64 = 0.06;

/// Makes a leaf from the points of a scan: blade, midrib and stalk, with their distances from the cloud, in the colours
/// of the cloud where it has some.
///
/// A table below it and separate things are left out, with a warning.
///
/// # Errors
/// [`LeafError::Scan`]; [`LeafError::Several`] for a plant or a leaf of leaflets.
pub fn make_leaf_from_scan(
    name: &str,
    cloud: &PointCloud,
    spec: &ScanSpec,
    run: &Run<'_>,
) -> Result<(MadePlant, ScanLeaf), LeafError> {
    let plain = LeafSpec { texture: LeafPaint::Plain, caps: true, ..LeafSpec::default() };
    let options = LeafOptions { spec: plain, ..LeafOptions::default() };
    let mut report = Report::default();
    let (leafy, found) = makers::build_scanned_leaf(name, cloud, spec, &options.look(), run, &mut report)?;
    let line = found.midrib();
    let rms_mm = LeafFit::from_distances(&found.distances).rms_mm;
    if rms_mm > UNLIKE * 1e3 * geom::polyline_length3(&line) {
        base::warn!(
            report,
            "scan-unlike",
            { rms_mm = (rms_mm * 100.0).round() / 100.0 },
            "the cloud is {rms_mm} mm from the leaf that was found in it: is it one leaf, laid open? Cut one leaf out of it"
        );
    }
    let (mut made, mesh) = finish(leafy, &options, run, &mut report)?;
    let n = found.columns;
    let rows = found.grid.len() / n;
    let width = found.grid.chunks(n).map(geom::polyline_length3).fold(0.0, f64::max);
    let mut outline = found.outline();
    outline.extend(outline.first().copied());
    let (blade, veins) = (&mesh.surface, &mesh.veins);
    let told = LeafReport {
        surface: "scan".into(),
        rows: rows as u64,
        length_mm: 1e3 * geom::polyline_length3(&line),
        area_mm2: 1e6 * blade.area(),
        veins: FaceCounts { vertices: veins.positions.len() as u64, faces: veins.triangles.len() as u64 },
        blade: FaceCounts { vertices: blade.positions.len() as u64, faces: mesh.blade_faces as u64 },
        fit_error: LeafFit { explained: found.explained, ..LeafFit::from_distances(&found.distances) },
        scan: Some(ScanReport {
            points: (found.used + found.outliers) as u64,
            outliers: found.outliers as u64,
            covered: found.covered,
            stalk_mm: found.stalk.as_ref().map(|s| 1e3 * s.length(200)),
            outline_mm: 1e3 * geom::polyline_length3(&outline),
            width_mm: 1e3 * width,
        }),
        ..LeafReport::default()
    };
    made = made.check(|r| check_leaf(&told, None, r));
    made.item.leaf = Some(told);
    Ok((made, found))
}

/// Makes a plant of the organs of a scan, each with its points, metres, +Y up; the one called `stem` bears the others.
///
/// Organs whose points have colours are painted with them. An organ of too few points for a blade becomes an axis, with
/// a warning. The error is that of the surface against all points. Cost: n log n.
///
/// # Errors
/// [`SeedlingError`].
pub fn make_seedling(
    name: &str,
    organs: &[OrganPoints],
    options: &SeedlingOptions,
    run: &Run<'_>,
) -> Result<(MadePlant, Vec<OrganFit>, ShapeError), SeedlingError> {
    let mut report = Report::default();
    let look = options.leaf.look();
    let (leafy, fits) = makers::build_seedling(name, organs, &options.scan, &look, run, &mut report)?;
    let (made, _) = finish(leafy, &options.leaf, run, &mut report)?;
    let counts: Vec<usize> = organs.iter().map(|o| o.points.len()).collect();
    let made = made.check(|r| check_organs(&counts, r));
    let all: Vec<DVec3> = organs.iter().flat_map(|o| o.points.iter().copied()).collect();
    let error = bloom::compare(&all, &makers::surface_places(&made.model), run)?;
    Ok((made, fits, error))
}
