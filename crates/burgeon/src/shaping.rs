//! Hand edits between a description and its meshes.
//!
//! `Plant + [HandEdit] -> Plant, [EditReport]`

use std::sync::Arc;

use base::{Counted, Run, Stopped, Warning};
use document::PlantEdit;
use glam::DVec3;
use plant::{AxisId, Plant};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shape::{AxisKey, Changed, Context, HandEdit, KeptGrowth, Outcome, Shaping};

/// Outcome of one edit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct EditReport {
    /// Its place in the list, from 0.
    pub index: usize,
    /// Whether it was done.
    pub done: bool,
    /// `done`, or a stable word for the reason why not.
    pub code: String,
    /// The outcome in plain words.
    pub said: String,
    /// Changes that it made; all 0 if it was not done.
    #[serde(default)]
    pub changed: Changed,
}

impl EditReport {
    fn new(index: usize, outcome: &Outcome) -> Self {
        let (code, changed) = match outcome {
            Outcome::Done(changed) => ("done", *changed),
            Outcome::NotDone(why) => (why.code(), Changed::default()),
        };
        Self { index, done: outcome.is_done(), code: code.into(), said: outcome.to_string(), changed }
    }

    /// Returns the warning about an edit that was not done.
    pub(crate) fn warning(&self, edits: &[PlantEdit]) -> Option<Warning> {
        let word = edits.get(self.index).map_or("edit", |e| e.edit.word());
        let message = || format!("edit {} by hand ({word}): {}", self.index, self.said);
        let why = || ("why", self.code.clone());
        let fields = || vec![("edit", self.index.to_string()), ("word", word.to_owned()), why()];
        (!self.done).then(|| Warning { code: "edit-not-done", message: message(), fields: fields() })
    }
}

/// An edited plant with the outcomes of its edits; a change of the last edits costs no more than these.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shaper {
    /// All edits but the last of the previous list, and the plant after them.
    before: Option<Begun>,
    /// Growth of the last edit, which a hand may still hold.
    growing: KeptGrowth,
}

#[derive(Clone, Debug)]
struct Begun {
    edits: Vec<Arc<HandEdit>>,
    shaping: Shaping,
    outcomes: Vec<Outcome>,
}

impl Begun {
    fn push(&mut self, edit: &Arc<HandEdit>, context: &Context, run: &Run<'_>) -> Result<(), Stopped> {
        self.push_again(edit, context, &mut KeptGrowth::default(), run)
    }

    fn push_again(
        &mut self,
        edit: &Arc<HandEdit>,
        context: &Context,
        growing: &mut KeptGrowth,
        run: &Run<'_>,
    ) -> Result<(), Stopped> {
        self.outcomes.push(self.shaping.push_again(edit, context, growing, run)?);
        self.edits.push(Arc::clone(edit));
        Ok(())
    }
}

impl Shaper {
    /// Prepares for editing another plant.
    pub(crate) fn forget(&mut self) {
        *self = Self::default();
    }

    /// Applies the edits that are not left out. `plant`: the same as at the last call, unless it was forgotten.
    pub(crate) fn shape(
        &mut self,
        plant: &Plant,
        edits: &[PlantEdit],
        context: &Context,
        run: &Run<'_>,
    ) -> Result<(Plant, Vec<EditReport>), Stopped> {
        run.budget.check(Counted::Edits, edits.len() as u64, "take fewer edits, or some in a second pass")?;
        let (rows, on): (Vec<usize>, Vec<&Arc<HandEdit>>) =
            edits.iter().enumerate().filter(|(_, e)| !e.off).map(|(row, e)| (row, &e.edit)).unzip();
        let serves = |b: &Begun| b.edits.len() <= on.len() && b.edits.iter().zip(&on).all(|(a, b)| a == *b);
        let fresh = || Begun { edits: Vec::new(), shaping: Shaping::new(plant), outcomes: Vec::new() };
        let mut begun = self.before.take().filter(serves).unwrap_or_else(fresh);
        let upto = begun.edits.len().max(on.len().saturating_sub(1));
        for edit in &on[begun.edits.len()..upto] {
            begun.push(edit, context, run)?;
        }
        let mut whole = self.before.insert(begun).clone();
        for edit in &on[upto..] {
            whole.push_again(edit, context, &mut self.growing, run)?;
        }
        let reports = rows.iter().zip(&whole.outcomes).map(|(&row, o)| EditReport::new(row, o)).collect();
        Ok((whole.shaping.into_plant(), reports))
    }
}

/// Returns a plant after its edits; it is not kept for later edits.
pub(crate) fn shaped(
    plant: Plant,
    edits: &[PlantEdit],
    run: &Run<'_>,
) -> Result<(Plant, Vec<EditReport>), Stopped> {
    if edits.is_empty() {
        return Ok((plant, Vec::new()));
    }
    Shaper::default().shape(&plant, edits, &Context::default(), run)
}

/// One branch in a list of all.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BranchRow {
    /// Its path in an edits file: `{"path": [...]}`.
    pub path: Vec<u32>,
    /// Place on its bearer, as a share of the bearer's length.
    pub at: f64,
    /// Position of its base, metres.
    pub base_m: DVec3,
    /// Length along its course, metres.
    pub length_m: f64,
    /// Direction from base to tip, a unit vector.
    pub direction: DVec3,
    /// Radius at its base, metres.
    pub radius_m: f64,
    /// Number of branches that it bears directly.
    pub bears: usize,
}

/// Returns the branches of a plant up to an order (0 is the trunk), each after its bearer.
pub fn branch_rows(plant: &Plant, most_order: u32) -> Vec<BranchRow> {
    let mut rows: Vec<BranchRow> = AxisKey::paths(plant)
        .into_iter()
        .filter(|(axis, _)| plant.axis(*axis).order <= most_order)
        .map(|(axis, path)| row(plant, axis, path))
        .collect();
    base::sort_by(&mut rows, |a, b| a.path.cmp(&b.path));
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

/// Returns an edits file with one edit of each kind, for its reader to change. For a tree of about 8 m.
pub const fn edits_template() -> &'static str {
    include_str!("edits-template.json")
}

/// Returns the JSON Schema of edits files: every field with its meaning, unit (`x-unit`), range and default.
pub fn edits_schema() -> serde_json::Value {
    schemars::schema_for!(shape::EditsFile).to_value()
}
