//! Hand edits on the way from a description to its meshes.
//!
//! `Plant + [HandEdit] -> Plant, [EditReport]`

use base::{Cancelled, Run};
use glam::DVec3;
use plant::{AxisId, Plant};
use serde::{Deserialize, Serialize};
use shape::{AxisKey, Context, HandEdit, Outcome, apply};

/// What became of one edit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct EditReport {
    /// Its place in the list, from 0.
    pub index: usize,
    /// Whether it was done.
    pub done: bool,
    /// `done`, or a stable word for why not.
    pub code: String,
    /// In plain words.
    pub said: String,
}

/// Edits a plant in its place.
///
/// # Errors
/// [`Cancelled`]: the plant is as it was.
pub fn shape_plant(
    plant: &mut Plant,
    edits: &[HandEdit],
    context: &Context,
    run: &Run<'_>,
) -> Result<Vec<EditReport>, Cancelled> {
    if edits.is_empty() {
        return Ok(Vec::new());
    }
    let applied = apply(plant, edits, context, run)?;
    *plant = applied.plant;
    let report = |(index, outcome): (usize, &Outcome)| EditReport {
        index,
        done: outcome.is_done(),
        code: match outcome {
            Outcome::Done(_) => "done".into(),
            Outcome::NotDone(why) => why.code().into(),
        },
        said: outcome.to_string(),
    };
    Ok(applied.outcomes.iter().enumerate().map(report).collect())
}

/// One branch in a list of all.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BranchRow {
    /// What names it in an edits file: `{"path": [...]}`.
    pub path: Vec<u32>,
    /// Where along its bearer it sits, a share of the bearer's length.
    pub at: f64,
    /// Where it starts, metres.
    pub base_m: DVec3,
    /// Along its course, metres.
    pub length_m: f64,
    /// From base to tip, a unit vector.
    pub direction: DVec3,
    /// At its base, metres.
    pub radius_m: f64,
    /// Branches that it bears itself.
    pub bears: usize,
}

/// The branches of a plant up to an order (0 is the trunk), each after what bears it.
pub fn branch_rows(plant: &Plant, most_order: u32) -> Vec<BranchRow> {
    let mut rows: Vec<BranchRow> = AxisKey::paths(plant)
        .into_iter()
        .filter(|(axis, _)| plant.axis(*axis).order <= most_order)
        .map(|(axis, path)| row(plant, axis, path))
        .collect();
    rows.sort_by(|a, b| a.path.cmp(&b.path));
    rows
}

fn row(plant: &Plant, id: AxisId, path: Vec<u32>) -> BranchRow {
    let (axis, points) = (plant.axis(id), plant.axis_points(id));
    let at = axis.bearer.map_or(0.0, |node| {
        let bearer = plant.nodes.axis[node.index()];
        let upto = node.index() - plant.axis(bearer).nodes.start as usize;
        let line = plant.axis_points(bearer);
        let whole = geom::polyline_length3(line);
        if whole > 0.0 { geom::polyline_length3(&line[..=upto]) / whole } else { 0.0 }
    });
    let (base, tip) = (points[0], points[points.len() - 1]);
    let bears = plant.axes.iter().filter_map(|a| a.bearer);
    BranchRow {
        path,
        at,
        base_m: base,
        length_m: geom::polyline_length3(points),
        direction: (tip - base).normalize_or(DVec3::Y),
        radius_m: plant.axis_radii(id).first().copied().unwrap_or(0.0),
        bears: bears.filter(|n| plant.nodes.axis[n.index()] == id).count(),
    }
}

/// An edits file with one edit of each kind, to be changed by its reader. For a tree of about 8 m.
pub const fn edits_template() -> &'static str {
    include_str!("edits-template.json")
}

/// The JSON Schema of edits files: every field with its meaning, unit (`x-unit`), range and default.
pub fn edits_schema() -> serde_json::Value {
    schemars::schema_for!(shape::EditsFile).to_value()
}
