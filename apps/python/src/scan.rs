//! Trees of laser scans.

use burgeon::formats::CloudFormat;
use burgeon::glam::DVec3;
use burgeon::mesh::PointCloud;
use burgeon::scan::{FoundTree, TreeScanSpec};
use burgeon::skin::SkinSpec;
use burgeon::{Report, ScanTreeOptions, ScannedTreeError, make_tree_from_scan};
use pyo3::prelude::*;

use crate::asked::Asked;
use crate::compute::{aside, compute};
use crate::fault::{beyond, refused, unlike, unusable};
use crate::held::{Found, Held};
use crate::make::Base;
use crate::model::axes;
use crate::plant::RawPlant;

/// A scan and the settings of its search for a tree: the bytes of a file and its extension, or points as bytes of
/// `f64`, three each.
#[derive(FromPyObject)]
pub(crate) struct Sought {
    #[pyo3(item)]
    file: Option<(Vec<u8>, String)>,
    #[pyo3(item)]
    points: Vec<u8>,
    #[pyo3(item)]
    unit: String,
    #[pyo3(item)]
    up: String,
    /// The two horizontal coordinates of the stem, in the order and the unit of the scan.
    #[pyo3(item)]
    at: Option<[f64; 2]>,
    #[pyo3(item)]
    cell: Option<f64>,
    #[pyo3(item)]
    gap: Option<f64>,
}

/// Returns an optional number within its range, metres.
fn within(name: &str, value: Option<f64>, [least, most]: [f64; 2]) -> PyResult<Option<f64>> {
    match value {
        Some(value) if !(least..=most).contains(&value) => {
            Err(beyond(name, value, &format!("{least} to {most} m")))
        }
        value => Ok(value),
    }
}

impl Sought {
    /// The points, metres, +Y up.
    fn cloud(&mut self, py: Python<'_>, name: &str, report: &mut Report) -> PyResult<PointCloud> {
        let axes = axes(&self.unit, &self.up)?;
        let Some((bytes, extension)) = self.file.take() else {
            let number = |bytes: &[u8]| bytes.try_into().map_or(f64::NAN, f64::from_ne_bytes);
            let row = |row: &[u8]| DVec3::new(number(&row[..8]), number(&row[8..16]), number(&row[16..]));
            let points = self.points.chunks_exact(24).map(|r| axes.inward(row(r))).collect();
            return Ok(PointCloud { points, ..PointCloud::default() });
        };
        let format = CloudFormat::from_extension(&extension).or_else(|| CloudFormat::sniff(&bytes));
        let format = format.ok_or_else(|| {
            unlike(py, name, &bytes, "is no cloud (.laz, .las, .e57, .ply, .xyz, .pcd, .obj)")
        })?;
        let (read, told) = aside(py, move || {
            let mut told = Report::default();
            (burgeon::formats::read_cloud(&*bytes, format, &axes, &mut told), told)
        })?;
        *report = told;
        read.map_err(|e| unusable(py, &format!("{name}: {e}")))
    }
}

/// Finds the tree of a scan; `leaves`: the species whose leaves it gets, with the requested fields.
#[pyfunction]
pub(crate) fn tree_of_scan(
    py: Python<'_>,
    name: &str,
    mut sought: Sought,
    leaves: Option<Base>,
    asked: Asked<'_>,
) -> PyResult<RawPlant> {
    let budget = asked.budget()?;
    let leaves = leaves.map(|base| asked.spec(py, &base.tree(py)?.0)).transpose()?;
    if leaves.as_ref().is_some_and(|l| l.bare || l.blade.file.is_some()) {
        return Err(unusable(py, &"leaves: this species bears no leaves of its own; name another"));
    }
    let (skin, wind) = asked.skin(py)?;
    let mut report = Report::default();
    let mut cloud = sought.cloud(py, name, &mut report)?;
    let offset = PointCloud::far_offset(&cloud.points).unwrap_or_default();
    cloud.points.iter_mut().for_each(|p| *p -= offset);
    let spec = axes(&sought.unit, &sought.up)?;
    let at = sought.at.map(|[a, b]| {
        let file = if sought.up == "y" { DVec3::new(a, 0.0, b) } else { DVec3::new(a, b, 0.0) };
        let p = spec.inward(file) - offset;
        [p.x, p.z]
    });
    let (cell_m, gap_m) =
        (within("cell", sought.cell, [0.001, 1.0])?, within("gap", sought.gap, [0.0, 5.0])?);
    let options = ScanTreeOptions {
        scan: TreeScanSpec { at, cell_m, gap_m, ..TreeScanSpec::default() },
        leaves,
        skin: SkinSpec { wind, ..skin },
    };
    let seed = asked.seed();
    let made = compute(py, budget, |run| make_tree_from_scan(name, &cloud, &options, seed, run))?;
    let (mut made, found) = made.map_err(|e| match e {
        ScannedTreeError::Stopped(stopped) => refused(py, &burgeon::SceneError::from(stopped)),
        other => unusable(py, &format!("{name}: {}", other.in_scan(&spec, offset))),
    })?;
    made.item.warnings.splice(0..0, report.warnings.iter().map(ToString::to_string));
    let foot = found.foot + offset;
    Ok(RawPlant(Held::lone(made, Some(Found { foot, tally: tally(&found), seed }), budget)))
}

/// Returns the counts of the points.
fn tally(found: &FoundTree) -> serde_json::Value {
    let (t, i) = (&found.tally, &found.intervals);
    let pair = |i: burgeon::scan::Interval| [i.low, i.high];
    serde_json::json!({
        "stems": t.stems, "loose": t.loose, "explained": t.explained, "coverage": t.coverage, "wide_gap_m": t.wide_gap_m,
        "pipe_source": t.pipe_source.word(),
        "intervals": {
            "height_m": pair(i.height_m), "dbh_m": i.dbh_m.map(pair), "wood_volume_m3": pair(i.volume_m3),
        },
        "points": t.points, "ground": t.ground, "noise": t.noise, "others": t.others, "leaves": t.leaves,
        "wood": t.wood, "other_things": t.other_things, "bridges": t.bridges, "cell_m": t.cell_m, "rings": t.rings,
        "circles": t.circles, "pipe_exponent": t.pipe_exponent, "pipe_scatter": t.pipe_scatter,
        "ground_found": found.ground.is_some(),
    })
}
