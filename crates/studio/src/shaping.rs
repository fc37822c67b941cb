//! Hand edits on the way from a description to its meshes.
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

/// What became of one edit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct EditReport {
    /// Its place in the list, from 0.
    pub index: usize,
    /// Whether it was done.
    pub done: bool,
    /// `done`, or a stable word for why not.
    pub code: String,
    /// In plain words.
    pub said: String,
    /// What it changed; all 0 if it was not done.
    #[serde(default)]
    pub changed: Changed,
}

impl EditReport {
    fn of(index: usize, outcome: &Outcome) -> Self {
        let (code, changed) = match outcome {
            Outcome::Done(changed) => ("done", *changed),
            Outcome::NotDone(why) => (why.code(), Changed::default()),
        };
        Self { index, done: outcome.is_done(), code: code.into(), said: outcome.to_string(), changed }
    }

    /// What a person is told of an edit that was not done.
    pub(crate) fn warning(&self, edits: &[PlantEdit]) -> Option<Warning> {
        let word = edits.get(self.index).map_or("edit", |e| e.edit.word());
        let message = || format!("edit {} by hand ({word}): {}", self.index, self.said);
        let why = || ("why", self.code.clone());
        let fields = || vec![("edit", self.index.to_string()), ("word", word.to_owned()), why()];
        (!self.done).then(|| Warning { code: "edit-not-done", message: message(), fields: fields() })
    }
}

/// An edited plant with what became of its edits; changes of the last edits cost no more than these.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shaper {
    /// All edits but the last of the list that was done last, and the plant after them.
    before: Option<Begun>,
    /// What the last edit let grow: a hand may still hold on to it.
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
    /// Another plant is to be edited.
    pub(crate) fn forget(&mut self) {
        *self = Self::default();
    }

    /// The plant with those edits that are not left out. `plant`: the same as at the last call, unless it was forgotten.
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
        let reports = rows.iter().zip(&whole.outcomes).map(|(&row, o)| EditReport::of(row, o)).collect();
        Ok((whole.shaping.into_plant(), reports))
    }
}

/// A plant after its edits; it is not kept for the next ones.
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

/// An edits file with one edit of each kind, to be changed by its reader. For a tree of about 8 m.
pub const fn edits_template() -> &'static str {
    include_str!("edits-template.json")
}

/// The JSON Schema of edits files: every field with its meaning, unit (`x-unit`), range and default.
pub fn edits_schema() -> serde_json::Value {
    schemars::schema_for!(shape::EditsFile).to_value()
}
