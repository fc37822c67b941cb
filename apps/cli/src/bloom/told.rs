//! Output of `burgeon bloom run`: its report and its lines.

use burgeon::bloom::ShapeError;
use burgeon::{OrganFit, RunReport};
use serde::Serialize;

use super::write::Written;
use crate::args::BloomRunArgs;
use crate::failure::Outcome;
use crate::machine::Machine;
use crate::output::Outputs;
use crate::{checks, poses, report, say, stages};

/// Distances in millimetres: measured to reconstructed, and back.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct ErrorReport {
    paper_mm: f64,
    pub(super) mean_mm: f64,
    rms_mm: f64,
    p95_mm: f64,
    max_mm: f64,
    coverage: f64,
    back_paper_mm: f64,
    pub(super) back_mean_mm: f64,
    back_rms_mm: f64,
    back_max_mm: f64,
}

impl From<ShapeError> for ErrorReport {
    fn from(e: ShapeError) -> Self {
        let (a, b) = (e.to_model, e.to_scan);
        Self {
            paper_mm: a.paper * 1e3,
            mean_mm: a.mean * 1e3,
            rms_mm: a.rms * 1e3,
            p95_mm: a.p95 * 1e3,
            max_mm: a.max * 1e3,
            coverage: e.coverage,
            back_paper_mm: b.paper * 1e3,
            back_mean_mm: b.mean * 1e3,
            back_rms_mm: b.rms * 1e3,
            back_max_mm: b.max * 1e3,
        }
    }
}

#[derive(Debug, Serialize)]
pub(super) struct ResidualReport {
    pub(super) organ: String,
    pub(super) from_day: f64,
    pub(super) to_day: f64,
    #[serde(flatten)]
    pub(super) error: ErrorReport,
}

/// Additions of `run` to the report.
#[derive(Debug, Serialize)]
struct MotionReport {
    #[serde(flatten)]
    run: RunReport,
    frames: u32,
    day: Option<f64>,
    /// Control points round each organ; none for flowers, which have no lattice.
    lattice: Option<[usize; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<ErrorReport>,
    /// The error after the best rigid motion of the shape onto the scan.
    #[serde(skip_serializing_if = "Option::is_none")]
    aligned: Option<ErrorReport>,
    /// Motion of plant and organs between scans.
    poses: Vec<poses::PoseReport>,
    /// Residual of the registration of each organ.
    residuals: Vec<ResidualReport>,
    /// Share of petal triangles that cross another petal, at each frame of a flower.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    overlap: Vec<f64>,
    /// The plant that was made of scans (--plant), for the last day that was written.
    #[serde(skip_serializing_if = "Option::is_none")]
    scanned: Option<ScannedPlant>,
    stages: Vec<stages::StageReport>,
}

/// A plant that was made of scans.
#[derive(Debug, Serialize)]
pub(super) struct ScannedPlant {
    pub(super) day: f64,
    pub(super) organs: Vec<OrganFit>,
    /// Distances between its surface and the points that it was made of.
    pub(super) error: ErrorReport,
}

impl ScannedPlant {
    /// Returns lines for people.
    fn lines(&self) -> Vec<String> {
        let organ = |o: &OrganFit| {
            let axis = format!("{:.1} mm long, {:.2} mm thick", o.axis_mm, 2.0 * o.radius_mm);
            match o.blade_mm > 0.0 {
                true => format!(
                    "{}: blade {:.1} x {:.1} mm, {:.0} mm2; stalk {axis}",
                    o.name, o.blade_mm, o.width_mm, o.area_mm2
                ),
                false => format!("{}: {axis}", o.name),
            }
        };
        let e = &self.error;
        let error = format!(
            "surface, day {}: scan to model {:.3} mm mean, {:.3} 95 %; model to scan {:.3} mean; {:.1} % within 2 mm",
            self.day,
            e.mean_mm,
            e.p95_mm,
            e.back_mean_mm,
            e.coverage * 100.0
        );
        self.organs.iter().map(organ).chain([error]).collect()
    }
}

/// Inputs of the report of `run`, in addition to what was written.
pub(super) struct BloomReport {
    pub(super) head: RunReport,
    pub(super) residuals: Vec<ResidualReport>,
    pub(super) error: Option<ErrorReport>,
    pub(super) aligned: Option<ErrorReport>,
    pub(super) poses: Vec<poses::PoseReport>,
    pub(super) stages: Vec<stages::StageReport>,
    pub(super) lattice: Option<[usize; 3]>,
    /// The plant that was made of scans.
    pub(super) plant: Option<ScannedPlant>,
    pub(super) times: [f64; 3],
}

impl BloomReport {
    pub(super) fn from_flower(head: RunReport, times: [f64; 3]) -> Self {
        let (residuals, poses, stages) = (vec![], vec![], vec![]);
        Self { head, residuals, error: None, aligned: None, poses, stages, lattice: None, plant: None, times }
    }
}

pub(super) fn tell(
    args: &BloomRunArgs,
    machine: &Machine,
    mut told: BloomReport,
    written: Written,
    outputs: Outputs,
) -> Outcome {
    let item = &mut told.head.items[0];
    (item.counts, item.plant) = (written.counts, written.measures);
    item.digest = written.digest;
    item.warnings.extend(written.warnings);
    if !written.checks.is_empty() {
        item.checks = written.checks;
    }
    let failed: Vec<String> = item.checks.iter().filter(|c| !c.ok).map(checks::sentence).collect();
    item.warnings.extend(failed.into_iter().filter(|w| !item.warnings.contains(w)).collect::<Vec<_>>());
    item.timings_ms.structure = told.times[1];
    item.timings_ms.add_io(told.times[0], told.times[2]);
    item.timings_ms.total = machine.whole_ms();
    let report = MotionReport {
        run: told.head,
        frames: written.frames,
        day: args.day,
        lattice: told.lattice,
        error: told.error,
        aligned: told.aligned,
        poses: told.poses,
        residuals: told.residuals,
        overlap: written.overlap,
        scanned: told.plant,
        stages: told.stages,
    };
    checks::accept(&report.run.items, &args.checks)?;
    report::finish(&report, &args.common, outputs)?;
    if !machine.quiet {
        let item = &report.run.items[0];
        item.warnings.iter().for_each(|w| say::warning(w));
        if let Some(e) = &report.error {
            say::line(&format!(
                "error: {:.3} mm (mean over x, y, z, as in Huai, Yang and Cai 2019); Euclidean, scan to model: {:.3} mm mean, {:.3} \
                 RMS, {:.3} 95 %, {:.3} max, {:.1} % within 2 mm; model to scan: {:.3} mean, {:.3} RMS, {:.3} max",
                e.paper_mm,
                e.mean_mm,
                e.rms_mm,
                e.p95_mm,
                e.max_mm,
                e.coverage * 100.0,
                e.back_mean_mm,
                e.back_rms_mm,
                e.back_max_mm
            ));
        }
        if let Some(e) = &report.aligned {
            say::line(&format!(
                "after the best rigid move: scan to model {:.3} mm mean, model to scan {:.3}",
                e.mean_mm, e.back_mean_mm
            ));
        }
        report.poses.iter().flat_map(poses::PoseReport::lines).for_each(|l| say::line(&l));
        report.scanned.iter().flat_map(ScannedPlant::lines).for_each(|l| say::line(&l));
        let frames = say::counted(u64::from(report.frames), "shape", "shapes");
        let points = say::counted(item.counts.vertices, "point", "points");
        say::line(&format!(
            "{}: {frames} of {points}; {:.0} ms",
            args.output.display(),
            item.timings_ms.total
        ));
    }
    Ok(())
}
