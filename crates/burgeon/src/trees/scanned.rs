//! Laser scans of trees -> trees.

use base::{Cancelled, Report, Run, Seed, Stopped, UpAxis};
use formats::ExportSpec;
use glam::DVec3;
use growth::{GrowthError, Look, TreeSpec};
use plant::BladeForm;
use scan::{FoundTree, Plot, ScanPoints, ScanTreeError, TreeScanSpec, find_tree};
use skin::SkinSpec;

use super::evaluate::skinned;
use super::look::dressed;
use super::structured::bear_leaves;
use crate::checks::check_scan;
use crate::made::MadePlant;

/// Options for turning a scan into a tree. Not saved with it.
#[derive(Clone, Debug, Default)]
pub struct ScanTreeOptions {
    /// Settings for finding the tree.
    pub scan: TreeScanSpec,
    /// Species that gives it leaves and colours of bark; default none: a bare tree.
    pub leaves: Option<TreeSpec>,
    /// Fineness, sides, textures.
    pub skin: SkinSpec,
}

/// Reason why no tree was made of a scan.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScannedTreeError {
    /// The scan has no tree.
    #[error(transparent)]
    Scan(ScanTreeError),
    /// The leaves of the species cannot be placed.
    #[error(transparent)]
    Leaves(GrowthError),
    /// The user asked to stop, or the result would exceed the budget.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl ScannedTreeError {
    /// Returns the same error with places in the coordinates of the scan: in its axes and its unit, with the subtracted
    /// offset added, metres.
    #[must_use]
    pub fn in_scan(self, axes: &ExportSpec, offset_m: DVec3) -> Self {
        let given = |[x, z]: [f64; 2]| {
            let [a, b, c] = axes.place(DVec3::new(x, 0.0, z) + offset_m);
            if axes.up == UpAxis::Y { [a, c] } else { [a, b] }
        };
        match self {
            Self::Scan(ScanTreeError::NotThere(at, within_m, nearest)) => {
                Self::Scan(ScanTreeError::NotThere(given(at), within_m, given(nearest)))
            }
            other => other,
        }
    }
}

impl From<ScanTreeError> for ScannedTreeError {
    fn from(e: ScanTreeError) -> Self {
        match e {
            ScanTreeError::Cancelled(c) => Self::Stopped(c.into()),
            other => Self::Scan(other),
        }
    }
}

impl From<Cancelled> for ScannedTreeError {
    fn from(c: Cancelled) -> Self {
        Self::Stopped(c.into())
    }
}

impl From<GrowthError> for ScannedTreeError {
    fn from(e: GrowthError) -> Self {
        match e {
            GrowthError::Cancelled(c) => Self::Stopped(c.into()),
            GrowthError::OverBudget(o) => Self::Stopped(o.into()),
            other => Self::Leaves(other),
        }
    }
}

/// Finds the tree of a laser scan (metres, +Y up), gives it leaves of a species if asked for, and its surface.
///
/// The plant stands at the origin; [`FoundTree::foot`] is its original place. The same points, options and seed give
/// the same bits for any executor.
///
/// # Errors
/// [`ScannedTreeError`].
pub fn make_tree_from_scan<'a>(
    name: &str,
    points: impl Into<ScanPoints<'a>>,
    options: &ScanTreeOptions,
    seed: Seed,
    run: &Run<'_>,
) -> Result<(MadePlant, FoundTree), ScannedTreeError> {
    let is_placed = options.scan.at.is_some();
    made(name, (options, is_placed), seed, run, |r| find_tree(points, &options.scan, run, r))
}

/// Makes one tree of a plot in the same way.
///
/// # Errors
/// [`ScannedTreeError`].
pub fn make_tree_of_plot(
    name: &str,
    (plot, tree): (&Plot, usize),
    options: &ScanTreeOptions,
    seed: Seed,
    run: &Run<'_>,
) -> Result<(MadePlant, FoundTree), ScannedTreeError> {
    made(name, (options, true), seed, run, |r| plot.find_tree(tree, &options.scan, run, r))
}

fn made(
    name: &str,
    (options, is_placed): (&ScanTreeOptions, bool),
    seed: Seed,
    run: &Run<'_>,
    find: impl FnOnce(&mut Report) -> Result<FoundTree, ScanTreeError>,
) -> Result<(MadePlant, FoundTree), ScannedTreeError> {
    let mut report = Report::default();
    let found = report.stage("structure", run.clock, find)?;
    let mut plant = found.plant.clone();
    plant.name = name.into();
    let look = options.leaves.as_ref().map_or_else(Look::default, |s| s.look.clone());
    if let Some(species) = &options.leaves {
        bear_leaves(&mut plant, species, seed, run, &mut report)?;
    }
    let form = options.leaves.as_ref().map_or_else(BladeForm::default, |s| s.blade.form);
    let from = (dressed(options.skin.clone(), &look, form), look, None);
    let model = report.stage("mesh", run.clock, |_| skinned(&plant, &from, run))?;
    let mut made = MadePlant::untold(plant, (model, from.0), (vec![], &[]), &report)
        .check(|r| check_scan(&found.plant, &found.tally, is_placed, r))
        .with_digest();
    made.item.plant = Some(made.plant.measure());
    Ok((made, found))
}
