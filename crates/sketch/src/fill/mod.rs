//! Contours filled with twigs and leaves (paper 000, section 4.3).
//!
//! `Reading::regions + the plant's drawn axes -> grown twigs and leaves`

use base::{Cancelled, Report, Run, Seed};
use plant::{AxisId, Plant, ShapeId};

use crate::{PlantMap, Reading, SketchSpec};

/// What filling needs to know about the plant that it grows on.
#[expect(dead_code, reason = "read as soon as contours are filled")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct FillContext<'a> {
    /// What was asked for.
    pub(crate) spec: &'a SketchSpec,
    /// The drawing's seed.
    pub(crate) seed: Seed,
    /// Ink to plant.
    pub(crate) map: PlantMap,
    /// The plant's axis of each row of `Reading::axes`; `None` where it degenerated.
    pub(crate) axis_of_reading: &'a [Option<AxisId>],
    /// Blade shapes of the drawn leaves, in their order.
    pub(crate) templates: &'a [ShapeId],
    /// A tree rather than a herb.
    pub(crate) woody: bool,
}

/// Fills every region of the reading with twigs and leaves, borne by the plant's axes.
///
/// Radii of the new axes are left 0: they are set when the whole plant stands.
///
/// # Errors
/// [`Cancelled`] when the caller asked to stop.
pub(crate) fn fill(
    _plant: &mut Plant,
    reading: &Reading,
    _ctx: &FillContext<'_>,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<(), Cancelled> {
    run.cancel.check()?;
    if !reading.regions.is_empty() {
        report.warn("contour-empty", format!("{} contours were left empty", reading.regions.len()));
    }
    Ok(())
}
