//! The scan of one leaf -> a plant.

use std::sync::Arc;

use base::{Report, Run, Seed, ops};
use geom::{Ball, BallBSpline, SplineError};
use glam::DVec3;
use leaf::{ScanLeaf, ScanSpec};
use mesh::{PointCloud, Texture};
use plant::{AxisKind, NodeId, Paint, Plant, Shape, Sheet, Vein, Venation};
use skin::CloudColours;

use crate::error::LeafError;
use crate::look::{LeafLook, LeafyPlant, add_leaf};

/// Makes a plant of one leaf from the points of a scan: blade, midrib and stalk, in the colours of the cloud where it
/// has some. Returns what was found, too.
///
/// A table below it and separate things are left out, with a warning.
///
/// # Errors
/// [`LeafError::Scan`]; [`LeafError::Several`] for a plant or a leaf of leaflets.
pub fn build_scanned_leaf(
    name: &str,
    cloud: &PointCloud,
    spec: &ScanSpec,
    look: &LeafLook<'_>,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<(LeafyPlant, ScanLeaf), LeafError> {
    let alone = alone(cloud, report);
    let cloud = alone.as_ref().unwrap_or(cloud);
    let points = cloud.points.as_slice();
    let blades = bloom::blades(points, run)?;
    if blades > 1 {
        return Err(LeafError::Several(blades));
    }
    let found = report.stage("structure", run.clock, |r| leaf::fit_scan(points, spec, run, r))?;
    let mut leafy = LeafyPlant::named(name);
    let LeafyPlant { plant, textures } = &mut leafy;
    let colours = report.stage("mesh", run.clock, |_| colours_of(points, &cloud.colors, run));
    let bearer = found.stalk.as_ref().and_then(|stalk| add_stalk(plant, stalk, colours.as_ref()));
    let sheet = report.stage("mesh", run.clock, |_| sheet_of(&found, colours.as_ref(), textures, run))?;
    let paint = painted(&sheet, look);
    if let Some((sheet, frame)) = sheet.framed() {
        let shape = plant.add_shape(Shape::Sheet(Arc::new(sheet)));
        add_leaf(plant, shape, frame, bearer, paint, 1);
    }
    Ok((leafy, found))
}

/// Returns the cloud without a table and without separate things; `None` if it has neither.
fn alone(cloud: &PointCloud, report: &mut Report) -> Option<PointCloud> {
    let above = bloom::on_table(&cloud.points, Seed::new(1)).map(|rows| cloud.select(&rows));
    if let Some(above) = &above {
        base::warn!(
            report,
            "scan-table",
            { points = cloud.points.len() - above.points.len() },
            "{points} points of a plane below the leaf (a table) were left out"
        );
    }
    let left = above.as_ref().unwrap_or(cloud);
    let one = bloom::largest_thing(&left.points).map(|rows| left.select(&rows));
    if let Some(one) = &one {
        base::warn!(
            report,
            "scan-apart",
            { points = left.points.len() - one.points.len() },
            "{points} points of other things stand apart from the largest one, which was taken for the leaf: cut the leaf out \
             of the cloud if it is another"
        );
    }
    one.or(above)
}

/// Returns the colours of points, if there is one for each point and they are not all black.
pub(crate) fn colours_of(points: &[DVec3], colors: &[[u8; 3]], run: &Run<'_>) -> Option<CloudColours> {
    (points.len() == colors.len()).then(|| CloudColours::new(points, colors, run.executor)).flatten()
}

/// Returns the paint of a blade of a scan: a texture has its own colours.
pub(crate) fn painted(sheet: &Sheet, look: &LeafLook<'_>) -> Paint {
    if sheet.form.is_some() { Paint::Natural([1.0; 3]) } else { look.paint([1.0; 3]) }
}

/// Returns the blade that was found, in its place in the scan; with colours, its texture is added to `textures`.
pub(crate) fn sheet_of(
    found: &ScanLeaf,
    colours: Option<&CloudColours>,
    textures: &mut Vec<Option<Arc<Texture>>>,
    run: &Run<'_>,
) -> Result<Sheet, SplineError> {
    let n = found.columns;
    let rows = found.grid.len() / n;
    let mut sheet = Sheet {
        // The grid's rows run from left to right.
        points: found.grid.chunks(n).flat_map(|row| row.iter().rev().copied()).collect(),
        across: (0..n).rev().map(|j| j as f64 / (n - 1) as f64).collect(),
        along: (0..rows).map(|i| i as f64 / (rows - 1) as f64).collect(),
        colors: Vec::new(),
        form: None,
        veins: Venation { fine: vec![midrib(found, &found.midrib())?], ..Venation::default() },
    };
    if let Some(colours) = colours {
        sheet.form = u32::try_from(textures.len()).ok();
        textures.push(Some(Arc::new(colours.sheet(&sheet, run.executor))));
    }
    Ok(sheet)
}

/// Returns the midrib, thinner towards the tip; its thickness is known only from a stalk.
fn midrib(found: &ScanLeaf, line: &[DVec3]) -> Result<Vein, SplineError> {
    let base = found.marks.rows.last().and_then(|r| r.midrib).unwrap_or(0.001) * 0.5;
    let last = (line.len() - 1).max(1) as f64;
    let ball = |(k, &p): (usize, &DVec3)| Ball::new(p, base * (1.0 - 0.8 * k as f64 / last));
    let balls: Vec<Ball> = line.iter().enumerate().map(ball).collect();
    let curve = BallBSpline::fit(&balls, 12)?;
    let marks = evenly(&curve, 60);
    Ok(Vein { curve, marks })
}

/// Adds the stalk as an axis from its lower end to the blade; returns its last node.
fn add_stalk(plant: &mut Plant, stalk: &BallBSpline, colours: Option<&CloudColours>) -> Option<NodeId> {
    let balls: Vec<Ball> = evenly(stalk, 40).into_iter().rev().map(|t| stalk.ball(t)).collect();
    let points: Vec<DVec3> = balls.iter().map(|b| b.centre).collect();
    let axis = plant.add_axis(AxisKind::Petiole, None, 1, &points, None);
    plant.nodes.radius_m = balls.iter().map(|b| b.radius).collect();
    if let Some(colours) = colours {
        plant.axes[axis.index()].colors = colours.along(&points, &plant.nodes.radius_m);
    }
    plant.axis(axis).node_ids().last()
}

fn evenly(curve: &BallBSpline, steps: u32) -> Vec<f64> {
    let (a, b) = curve.domain();
    (0..=steps).map(|k| ops::lerp(a, b, f64::from(k) / f64::from(steps))).collect()
}
