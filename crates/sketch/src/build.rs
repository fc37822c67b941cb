//! `Reading -> Plant`: depth, organs, filled contours, radii.

use base::{Cancelled, Report, Run, Seed};
use glam::DVec2;
use plant::Plant;

use crate::fill::{FillContext, fill};
use crate::{PlantMap, Reading, SketchSpec};

/// A plant and how it lies in the drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Built {
    /// The plant.
    pub plant: Plant,
    /// From the drawing's ink to the plant's metres.
    pub map: PlantMap,
}

/// Builds the plant of a reading.
///
/// # Errors
/// [`Cancelled`] when the caller asked to stop.
pub fn build(
    reading: &Reading,
    spec: &SketchSpec,
    seed: Seed,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Built, Cancelled> {
    let map = PlantMap { metres_per_ink: spec.height_m.unwrap_or(1.0), origin_ink: DVec2::ZERO };
    let mut plant = Plant::default();
    let ctx = FillContext { spec, seed, map, axis_of_reading: &[], templates: &[], woody: reading.woody };
    fill(&mut plant, reading, &ctx, run, report)?;
    Ok(Built { plant, map })
}
