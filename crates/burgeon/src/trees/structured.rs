//! Plants read from files of structure -> plants with leaves, edits and meshes.

use base::{Cancelled, Report, Run, Seed, Stopped};
use document::PlantEdit;
use formats::StructureTally;
use glam::DVec3;
use growth::{GrowthError, Look, Obstacles, TreeSpec, add_leaves};
use plant::{BladeForm, OrganKind, Plant};
use skin::SkinSpec;

use super::evaluate::skinned;
use super::look::{dressed, tint};
use super::tree_blade;
use crate::checks::check_structure;
use crate::made::MadePlant;
use crate::shaping::shaped;

/// Options for turning a plant that was read into a model. Not saved with it.
#[derive(Clone, Debug, Default)]
pub struct StructureOptions {
    /// Species whose leaves and colours of bark replace its own; default none.
    pub leaves: Option<TreeSpec>,
    /// Fineness, sides, textures.
    pub skin: SkinSpec,
    /// Hand edits, applied to the plant in this order, before it gets leaves.
    pub edits: Vec<PlantEdit>,
}

/// Reason why no model was made of a plant that was read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StructureModelError {
    /// The leaves of the species cannot be placed.
    #[error(transparent)]
    Leaves(GrowthError),
    /// The user asked to stop, or the result would exceed the budget.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl From<GrowthError> for StructureModelError {
    fn from(e: GrowthError) -> Self {
        match e {
            GrowthError::Cancelled(c) => Self::Stopped(c.into()),
            GrowthError::OverBudget(o) => Self::Stopped(o.into()),
            other => Self::Leaves(other),
        }
    }
}

impl From<Cancelled> for StructureModelError {
    fn from(c: Cancelled) -> Self {
        Self::Stopped(c.into())
    }
}

/// A plant that was read, with its meshes, and its original place.
#[derive(Clone, Debug)]
pub struct StructureModel {
    /// The plant, which stands at the origin.
    pub made: MadePlant,
    /// Offset subtracted from its coordinates, metres, +Y up; zero where it stood at the origin already.
    pub foot: DVec3,
}

/// Distance from the origin within which a plant stays in place, metres.
const AT_ORIGIN_M: f64 = 1e-3;

/// Gives a plant that was read ([`formats::read_structure`]) edits, leaves of a species and its surface.
///
/// The plant is moved so that it stands at the origin: for several stems the middle of their feet, at the height of the
/// lowest. The same plant, options and seed give the same bits for any executor.
///
/// # Errors
/// [`StructureModelError`].
pub fn make_from_structure(
    plant: Plant,
    tally: &StructureTally,
    options: &StructureOptions,
    seed: Seed,
    run: &Run<'_>,
) -> Result<StructureModel, StructureModelError> {
    let mut report = Report::default();
    let mut plant = plant;
    let foot = stand_at_origin(&mut plant);
    let (mut plant, edits) = shaped(plant, &options.edits, run)?;
    let look = options.leaves.as_ref().map_or_else(Look::default, |s| s.look.clone());
    if let Some(species) = &options.leaves {
        let before = plant.organs.len();
        plant.organs.retain(|o| o.kind != OrganKind::Leaf);
        let gone = before - plant.organs.len();
        if gone > 0 {
            base::warn!(
                report,
                "leaves-replaced",
                { leaves = gone },
                "{leaves} leaves of the file gave way to those of the species"
            );
        }
        bear_leaves(&mut plant, species, seed, run, &mut report)?;
    }
    let form = options.leaves.as_ref().map_or_else(BladeForm::default, |s| s.blade.form);
    let from = (dressed(options.skin.clone(), &look, form), look, None);
    let model = report.stage("mesh", run.clock, |_| skinned(&plant, &from, run))?;
    let mut made = MadePlant::untold(plant, (model, from.0), (edits, &options.edits), &report)
        .check(|r| check_structure(tally, r))
        .with_digest();
    made.item.plant = Some(made.plant.measure());
    Ok(StructureModel { made, foot })
}

/// Puts the leaves of a species on the thin wood of a plant that did not grow by its rules.
pub(super) fn bear_leaves(
    plant: &mut Plant,
    species: &TreeSpec,
    seed: Seed,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<(), GrowthError> {
    let mut foliage = species.leaves.clone();
    // Measured wood is thicker at its ends than a species' twigs: leaves sit on the wood that is thin in this plant.
    let mut tips: Vec<f64> =
        plant.axes.iter().map(|a| plant.nodes.radius_m[a.nodes.end as usize - 1]).collect();
    base::sort_numbers(&mut tips);
    let thin = tips.get(tips.len() / 2).copied().unwrap_or(0.0);
    foliage.max_radius_m = foliage.max_radius_m.max(2.0 * thin);
    let blade = tree_blade(&species.blade);
    add_leaves(plant, &foliage, blade, &[], &Obstacles::none(), seed, run, report)?;
    tint(&species.look, plant, false, seed);
    Ok(())
}

/// Moves a plant to the origin; returns the subtracted offset.
fn stand_at_origin(plant: &mut Plant) -> DVec3 {
    let feet: Vec<DVec3> = plant
        .axes
        .iter()
        .filter(|a| a.bearer.is_none())
        .map(|a| plant.nodes.position[a.nodes.start as usize])
        .collect();
    let middle = feet.iter().sum::<DVec3>() / feet.len().max(1) as f64;
    let lowest = feet.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let foot = middle.with_y(lowest);
    if feet.is_empty() || foot.length() < AT_ORIGIN_M {
        return DVec3::ZERO;
    }
    plant.nodes.position.iter_mut().for_each(|p| *p -= foot);
    plant.organs.iter_mut().for_each(|o| o.frame.origin -= foot);
    plant.flowers.iter_mut().for_each(|f| f.centre -= foot);
    foot
}
