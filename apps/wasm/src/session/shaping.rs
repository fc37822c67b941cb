//! Hands on a plant: a tool of `shape`, what it holds, and what letting go would make.
//!
//! `tool + pointers (JSON) -> shape::Tool -> a preview that is never in the document | the edit, to be asked for`

use std::sync::Arc;

use burgeon::document::{
    Command, CommandError, Document, Editor, Maker, PlantId, ShapeCommand, SketchCommand, TreeCommand,
};
use burgeon::geom;
use burgeon::glam::DVec3;
use burgeon::plant::{AxisId, AxisKind, Plant};
use burgeon::shape::{self, AxisKey, HandEdit, Input, Pick, Pointer, Ray, Reach, Tool, ToolKind};
use burgeon::skin::SkinSpec;
use serde::{Deserialize, Serialize};

use super::{PREVIEW_DETAIL, Session, Told, words};

/// A plant of more triangles is shown coarser while a gesture is going on.
const COARSE_ABOVE: u64 = 40_000;
/// Radians of a degree.
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// A tool as the page names it, its settings within.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum WireTool {
    Pick {},
    Rotate {},
    Move {},
    Prune { whole: bool },
    Regrow {},
    Sketch { twigs: f64, tilt_deg: f64 },
    Brush { radius_m: f64, density: f64 },
    Silhouette { density: f64, trim: bool },
    Leaves { radius_m: f64, keep: f64 },
}

impl WireTool {
    /// None for the tool that only points.
    fn kind(self) -> Option<ToolKind> {
        Some(match self {
            Self::Pick {} => return None,
            Self::Rotate {} => ToolKind::Rotate,
            Self::Move {} => ToolKind::Move,
            Self::Prune { whole } => ToolKind::Prune { whole },
            Self::Regrow {} => ToolKind::Regrow,
            Self::Sketch { twigs, tilt_deg } => ToolKind::Sketch { twigs, tilt: tilt_deg * DEGREE },
            Self::Brush { radius_m, density } => ToolKind::Brush { radius_m, density },
            Self::Silhouette { density, trim } => ToolKind::Silhouette { density, trim },
            Self::Leaves { radius_m, keep } => ToolKind::Leaves { radius_m, keep },
        })
    }
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct WirePointer {
    origin: [f64; 3],
    direction: [f64; 3],
    forward: [f64; 3],
    up: [f64; 3],
    pressure: f64,
}

impl From<WirePointer> for Pointer {
    fn from(p: WirePointer) -> Self {
        let v = DVec3::from_array;
        let ray = Ray { origin: v(p.origin), direction: v(p.direction) };
        Self { ray, forward: v(p.forward), up: v(p.up), pressure: p.pressure, tip: None }
    }
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum WireInput {
    Down { at: WirePointer },
    Move { at: Vec<WirePointer> },
    Up { at: WirePointer },
    Cancel {},
    Twist { degrees: f64 },
    Brush { radius_m: f64, density: f64 },
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct WireReach {
    metres: f64,
    per_metre: f64,
    #[serde(default)]
    bearers: u32,
}

#[derive(Debug, Serialize)]
struct Picked {
    axis: u32,
    at: f64,
    point: [f64; 3],
    order: u32,
    length_m: f64,
    /// Shoots that it bears, and that these bear.
    bears: usize,
    /// Nothing bears it.
    stands: bool,
    key: Option<AxisKey>,
}

#[derive(Debug, Default, Serialize)]
struct Answer<'a> {
    picked: Option<Picked>,
    commit: Option<&'a HandEdit>,
    busy: bool,
    again: bool,
}

/// A tool in the hand.
#[derive(Clone, Debug)]
pub(super) struct Held {
    tool: Tool,
    plant: PlantId,
    /// The plant as it was when the gesture began.
    before: Plant,
    /// It has so many triangles that a gesture shows it coarser and without a digest.
    pub(super) large: bool,
    /// What letting go would make, or made: shown until the command comes.
    preview: Option<Arc<HandEdit>>,
}

impl Session {
    /// Lets a tool do something: `ShapeTool`, `ShapeReach`, `ShapeInput` in, `ShapeAnswer` out, all JSON.
    pub(crate) fn shape(&mut self, tool: &str, reach: &str, input: &str) -> Told<String> {
        let settings: WireTool = serde_json::from_str(tool).map_err(words)?;
        let reach: WireReach = serde_json::from_str(reach).map_err(words)?;
        let WireReach { metres, per_metre, bearers } = reach;
        let reach = Reach { metres, per_metre, bearers };
        let input: WireInput = serde_json::from_str(input).map_err(words)?;
        let id = self.must()?;
        let Some(kind) = settings.kind() else { return self.point(id, reach, &input) };
        let had = self.preview_edit(id).cloned();
        let going = self.held.as_ref().is_some_and(|h| h.tool.is_busy() && h.plant == id);
        if !going {
            // Between gestures only a pointer that goes down begins something; all else looks around.
            if !matches!(input, WireInput::Down { .. }) {
                return self.point(id, reach, &input);
            }
            let plant = self.shown_plant(id).ok_or("there is no plant to shape yet")?.clone();
            let edits = self.editor.document().plant(id).map_or(0, |p| p.settings().edits.len());
            let tool = Tool::new(kind).with(reach, edits as u64 + 1);
            let large = self.scene.get(id).is_some_and(|p| p.item.counts.triangles > COARSE_ABOVE);
            self.held = Some(Held { tool, plant: id, before: plant, large, preview: None });
        }
        let Some(held) = &mut self.held else { return Err("internal: no tool".into()) };
        let (tool, plant) = (&mut held.tool, &held.before);
        let said = match input {
            WireInput::Down { at } => tool.handle(plant, &Input::Down(at.into())),
            WireInput::Up { at } => tool.handle(plant, &Input::Up(at.into())),
            WireInput::Cancel {} => tool.handle(plant, &Input::Cancel),
            WireInput::Twist { degrees } => tool.handle(plant, &Input::Twist(degrees * DEGREE)),
            WireInput::Brush { radius_m, density } => tool.handle(plant, &Input::Brush(radius_m, density)),
            WireInput::Move { at } => {
                let moves = at.into_iter().map(|p| tool.handle(plant, &Input::Move(p.into())));
                moves.last().unwrap_or_default()
            }
        };
        let busy = tool.is_busy();
        let picked = said.picked.and_then(|k| picked(plant, k, false));
        held.preview = said.preview.or_else(|| said.commit.clone()).map(Arc::new);
        let now = held.preview.clone();
        if !busy && now.is_none() {
            self.held = None;
        }
        let answer = Answer { picked, commit: said.commit.as_ref(), busy, again: now != had };
        serde_json::to_string(&answer).map_err(words)
    }

    /// Only looks what is under the pointer.
    fn point(&mut self, id: PlantId, reach: Reach, input: &WireInput) -> Told<String> {
        let (at, named) = match input {
            WireInput::Down { at } | WireInput::Up { at } => (Some(*at), true),
            WireInput::Move { at } => (at.last().copied(), false),
            _ => (None, false),
        };
        let again = matches!(input, WireInput::Cancel {}) && self.held.take().is_some();
        let plant = self.shown_plant(id);
        let found = at.zip(plant).and_then(|(at, plant)| {
            let pick = shape::pick(plant, &Pointer::from(at).ray, reach)?;
            picked(plant, pick, named)
        });
        serde_json::to_string(&Answer { picked: found, again, ..Answer::default() }).map_err(words)
    }

    /// The plant that is seen, without the preview of a gesture.
    fn shown_plant(&self, id: PlantId) -> Option<&Plant> {
        if let Some(held) = self.held.as_ref().filter(|h| h.plant == id && h.preview.is_some()) {
            return Some(&held.before);
        }
        self.model(id)?;
        self.scene.get(id)?.plant
    }

    /// A branch and all that it bears as pairs of points: x, y, z and radius of each.
    pub(crate) fn branch(&self, axis: u32) -> Vec<f32> {
        let plant = self.current_id().and_then(|id| self.shown_plant(id));
        let Some(plant) = plant.filter(|p| (axis as usize) < p.axes.len()) else { return Vec::new() };
        let mut out = Vec::new();
        for (i, _) in borne(plant, axis as usize).into_iter().enumerate().filter(|(_, is)| *is) {
            let id = AxisId::new(i);
            let (points, radii) = (plant.axis_points(id), plant.axis_radii(id));
            for k in 1..points.len().min(radii.len()) {
                for j in [k - 1, k] {
                    let [x, y, z] = points[j].as_vec3().to_array();
                    #[expect(clippy::cast_possible_truncation, reason = "for the screen")]
                    out.extend([x, y, z, radii[j] as f32]);
                }
            }
        }
        out
    }

    /// The edit of the gesture that is shown of a plant.
    fn preview_edit(&self, id: PlantId) -> Option<&Arc<HandEdit>> {
        self.held.as_ref().filter(|h| h.plant == id)?.preview.as_ref()
    }

    /// The document with the edit of the gesture in it, coarser where that is faster; none where nothing is held.
    pub(super) fn with_gesture(&self) -> Option<(PlantId, Document)> {
        let id = self.current_id()?;
        let edit = self.preview_edit(id)?;
        let mut aside = Editor::new(self.editor.document().clone());
        aside.run(ShapeCommand::Add(Arc::clone(edit)).of(id)).ok()?;
        if self.held.as_ref().is_some_and(|h| h.large) {
            let command = coarser(aside.document(), id, PREVIEW_DETAIL);
            // A mesh that is as coarse as it can be stays as it is.
            if let Some(Err(e)) = command.map(|c| aside.run(c))
                && !matches!(e, CommandError::Nothing(_))
            {
                return None;
            }
        }
        Some((id, aside.document().clone()))
    }

    /// The document changed, or another plant is looked at: what was held is let go.
    pub(super) fn let_go(&mut self) {
        self.held = None;
    }
}

/// The command that makes a plant's mesh coarser by a factor.
pub(super) fn coarser(document: &Document, id: PlantId, factor: f64) -> Option<Command> {
    let coarse = |skin: &SkinSpec| {
        let detail = (skin.detail * factor).clamp(0.1, 8.0);
        SkinSpec { detail, ..skin.clone() }
    };
    match &document.plant(id)?.settings().maker {
        Maker::Sketch(s) => Some(SketchCommand::SetSkin(coarse(&s.skin)).of(id)),
        Maker::Tree(t) => Some(TreeCommand::SetSkin(coarse(&t.skin)).of(id)),
        _ => None,
    }
}

/// Which axes are this one or are borne by it.
fn borne(plant: &Plant, top: usize) -> Vec<bool> {
    let bearer = |i: usize| Some(plant.nodes.axis.get(plant.axes[i].bearer?.index())?.index());
    let mut known: Vec<Option<bool>> = vec![None; plant.axes.len()];
    known[top] = Some(true);
    for i in 0..plant.axes.len() {
        let (mut way, mut at) = (vec![i], bearer(i));
        if known[i].is_some() {
            continue;
        }
        // No longer than there are axes: a sound plant has no circle.
        while let Some(b) = at.filter(|&b| known[b].is_none() && way.len() <= plant.axes.len()) {
            way.push(b);
            at = bearer(b);
        }
        let is = at.and_then(|b| known[b]).unwrap_or(false);
        way.into_iter().for_each(|w| known[w] = Some(is));
    }
    known.into_iter().map(|k| k == Some(true)).collect()
}

/// What the page is told of a branch; `named`: with a name for edits.
fn picked(plant: &Plant, pick: Pick, named: bool) -> Option<Picked> {
    let axis = u32::try_from(pick.axis.index()).ok()?;
    let shoots = borne(plant, pick.axis.index());
    let shoots = shoots
        .iter()
        .zip(&plant.axes)
        .filter(|(is, a)| **is && !matches!(a.kind, AxisKind::Petiole | AxisKind::Root));
    Some(Picked {
        axis,
        at: pick.at,
        point: pick.point.to_array(),
        order: plant.axis(pick.axis).order,
        length_m: geom::polyline_length3(plant.axis_points(pick.axis)),
        bears: shoots.count().saturating_sub(1),
        stands: plant.axis(pick.axis).bearer.is_none(),
        key: if named { AxisKey::of(plant, pick.axis) } else { None },
    })
}
