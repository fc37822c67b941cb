//! Shaping plants by hand: a tool of `shape`, the branch that it holds, and the edit that a release would make.
//!
//! `tool + pointers -> shape::Tool -> a preview that is never in the document | the edit, to be requested`

use std::sync::Arc;

use burgeon::LeafBalls;
use burgeon::document::{CommandError, Document, Editor, Maker, PlantId, ShapeCommand};
use burgeon::geom;
use burgeon::glam::{DQuat, DVec2, DVec3};
use burgeon::mesh::Model;
use burgeon::plant::{Axis, AxisId, Plant};
use burgeon::shape::{
    self, AxisKey, Growth, HandEdit, Input, Mirror, Pick, Pointer, Ray, Reach, Thumb, Tool, ToolKind,
    ViewPlane, lean_of_thumb,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::held::{CarriedPose, Held, Rows};
use crate::view::{PREVIEW_DETAIL, coarser};
use crate::{Workspace, WorkspaceError};

/// Number of triangles above which a plant is shown coarser during a gesture.
const COARSE_ABOVE: u64 = 40_000;
/// Radians of a degree.
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// A pointer in the plant's own coordinates, metres; unit vectors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShapePointer {
    /// Start of its ray.
    pub origin: [f64; 3],
    /// Direction of its ray.
    pub direction: [f64; 3],
    /// Direction into the view.
    pub forward: [f64; 3],
    /// Upward direction of the view.
    pub up: [f64; 3],
    /// Pressure, 0 to 1.
    pub pressure: f64,
    /// Position of the tip of a tracked controller: it works there, and not on a plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tip: Option<[f64; 3]>,
    /// Orientation of that controller, a quaternion: x, y, z, w.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hand: Option<[f64; 4]>,
}

impl From<ShapePointer> for Pointer {
    fn from(p: ShapePointer) -> Self {
        let v = DVec3::from_array;
        let ray = Ray { origin: v(p.origin), direction: v(p.direction) };
        Self {
            ray,
            forward: v(p.forward),
            up: v(p.up),
            pressure: p.pressure,
            tip: p.tip.map(v),
            hand: p.hand.map(DQuat::from_array),
        }
    }
}

/// Input of a hand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ShapeInput {
    /// It went down.
    Down(ShapePointer),
    /// It moved; several moves at once, so that no point of a stroke is lost.
    Move(Vec<ShapePointer>),
    /// It was lifted.
    Up(ShapePointer),
    /// It takes everything back.
    Cancel,
    /// It turned the held branch, degrees.
    Twist(f64),
    /// A thumb on its touchpad or stick, whose rim is 1, x to the right and y up; none: it was lifted. A held branch
    /// turns with it; a drawing plane tilts by its distance from the centre.
    Thumb(Option<[f64; 2]>),
    /// It goes from branch to branch by keys, without a pointer.
    Walk {
        /// The current branch; none begins with the stems on the ground.
        from: Option<u32>,
        /// The step.
        to: ShapeStep,
    },
    /// A plane is placed: through its tip (without one, its origin), facing it.
    Plane(ShapePointer),
    /// A plane of symmetry is placed: upright through the foot of the plant's longest stem, between the viewer's hands.
    Mirror(ShapePointer),
    /// It keeps holding: the growing shoot is a round older.
    Round,
    /// The growing shoot has new settings from now on.
    Grow(Growth),
    /// It changed its brush.
    Brush {
        /// Radius of the brush, metres.
        radius_m: f64,
        /// Density of the branches.
        density: f64,
    },
}

/// Step from one branch to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ShapeStep {
    /// The next branch of the same bearer; after the last the first.
    Next,
    /// The previous branch of the same bearer.
    Previous,
    /// Its bearer.
    Bearer,
    /// The first branch that it bears.
    Borne,
}

/// Reach of a hand: the largest distance from a branch that is still meant, `metres + per_metre * distance`, and the
/// plane in which its edits are mirrored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShapeReach {
    /// Distance close by, metres.
    pub metres: f64,
    /// Increase with each metre of distance.
    pub per_metre: f64,
    /// Number of steps from the branch to its bearers.
    pub bearers: u32,
    /// A plane of symmetry: branches drawn, brushed or grown on one side are mirrored to the other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mirror: Option<Mirror>,
}

/// The branch that is meant.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Picked {
    /// Its row.
    pub axis: u32,
    /// Place on it, as a share of its length.
    pub at: f64,
    /// That place, metres.
    pub point: [f64; 3],
    /// Order of branching, 0 for the main axis.
    pub order: u32,
    /// Length along its course.
    pub length_m: f64,
    /// Number of shoots that it bears, directly or through others.
    pub bears: usize,
    /// Whether it stands on the ground.
    pub stands: bool,
    /// Key for edits, where the pointer went down or up.
    pub key: Option<AxisKey>,
}

/// Answer to an input.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct ShapeAnswer {
    /// The branch that is meant.
    pub picked: Option<Picked>,
    /// The edit of a gesture that ended, to be requested as a command.
    pub commit: Option<HandEdit>,
    /// Whether a gesture is in progress.
    pub busy: bool,
    /// Whether the view of the plant is out of date.
    pub again: bool,
    /// Rotation of the held branch so far, degrees.
    pub turned_deg: Option<f64>,
    /// The plane that was placed.
    pub plane: Option<ViewPlane>,
    /// The plane of symmetry that was placed.
    pub mirror: Option<Mirror>,
    /// The growth in the hand, as far as it is shown.
    pub grown: Option<Grown>,
    /// Motion of the held branch: the shell moves its triangles, which are not made again before the hand lets go.
    pub carried: Option<CarriedPose>,
    /// Row of the axis that the branch in the hand would be dropped on: once it was pulled off, or slid onto other
    /// wood.
    pub host: Option<u32>,
}

/// Growth since a hand began to hold, both sides of a plane of symmetry together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Grown {
    /// Its age: rounds of growth.
    pub rounds: u32,
    /// Number of branches in the last view.
    pub branches: usize,
    /// Its density: branches for each metre of new wood; none before any grew.
    pub per_metre: Option<f64>,
}

impl Grown {
    /// Counts the growth. `shown`: the plant with the growth, perhaps of one or two rounds before.
    fn count(before: &Plant, shown: Option<&Plant>, rounds: u32) -> Self {
        let wood = |plant: &Plant| {
            let shoots = plant.axes.iter().enumerate();
            let shoots = shoots.filter(|(_, a)| a.kind.is_shoot());
            shoots.fold((0, 0.0), |(count, length), (i, _)| {
                (count + 1, length + geom::polyline_length3(plant.axis_points(AxisId::new(i))))
            })
        };
        let (had, now) = (wood(before), shown.map_or((0, 0.0), wood));
        let (branches, length): (usize, f64) = (usize::saturating_sub(now.0, had.0), now.1 - had.1);
        let per_metre = (branches > 0 && length > 0.0).then(|| branches as f64 / length);
        Self { rounds, branches, per_metre }
    }
}

impl Workspace {
    /// Lets a tool shape the current plant. The edit of a gesture is shown but is not in the document; once made, the
    /// caller requests it by a [`ShapeCommand`].
    ///
    /// # Errors
    /// [`WorkspaceError`]: when there is no plant.
    pub fn shape(
        &mut self,
        tool: ToolKind,
        reach: ShapeReach,
        input: ShapeInput,
    ) -> Result<ShapeAnswer, WorkspaceError> {
        let ShapeReach { metres, per_metre, bearers, mirror } = reach;
        let reach = Reach { metres, per_metre, bearers };
        let id = self.must()?;
        if let Some(answer) = self.aside(id, &input)? {
            return Ok(answer);
        }
        if tool == ToolKind::Pick {
            return Ok(self.point(id, reach, &input));
        }
        let had = self.preview_edit(id).cloned();
        let going = self.held.as_ref().is_some_and(|h| h.tool.is_busy() && h.plant == id);
        if !going {
            // Between gestures only a pointer that goes down begins one; all other input only looks.
            if !matches!(input, ShapeInput::Down(_)) {
                return Ok(self.point(id, reach, &input));
            }
            let plant = self.shown_plant(id).ok_or(WorkspaceError::NothingToShape)?.clone();
            let edits = self.editor.document().plant(id).map_or(0, |p| p.settings().edits.len());
            let tool = Tool::new(tool).with(reach, edits as u64 + 1).mirrored(mirror);
            let large = self.scene.get(id).is_some_and(|p| p.model.triangle_count() as u64 > COARSE_ABOVE);
            let (thumb, lean) = (Thumb::default(), 0.0);
            let (preview, rows, carried) = (None, None, None);
            self.held =
                Some(Held { tool, plant: id, before: plant, large, preview, thumb, lean, rows, carried });
        }
        let Some(held) = &mut self.held else { return Err(WorkspaceError::Internal("no tool")) };
        let (tool, plant) = (&mut held.tool, &held.before);
        let said = match input {
            ShapeInput::Down(at) => tool.handle(plant, &Input::Down(at.into())),
            ShapeInput::Up(at) => tool.handle(plant, &Input::Up(at.into())),
            ShapeInput::Cancel | ShapeInput::Walk { .. } | ShapeInput::Plane(_) | ShapeInput::Mirror(_) => {
                tool.handle(plant, &Input::Cancel)
            }
            ShapeInput::Twist(degrees) => tool.handle(plant, &Input::Twist(degrees * DEGREE)),
            ShapeInput::Thumb(at) => {
                let at = at.map(DVec2::from_array);
                let turn = held.thumb.turn(at);
                let by = if matches!(tool.kind(), ToolKind::Sketch { .. }) {
                    let lean = at.map_or(0.0, lean_of_thumb);
                    lean - core::mem::replace(&mut held.lean, lean)
                } else {
                    turn
                };
                tool.handle(plant, &Input::Twist(by))
            }
            ShapeInput::Round => tool.handle(plant, &Input::Round),
            ShapeInput::Grow(growth) => tool.handle(plant, &Input::Grow(growth)),
            ShapeInput::Brush { radius_m, density } => tool.handle(plant, &Input::Brush(radius_m, density)),
            ShapeInput::Move(moves) => {
                let moves = moves.into_iter().map(|p| tool.handle(plant, &Input::Move(p.into())));
                moves.last().unwrap_or_default()
            }
        };
        let busy = tool.is_busy();
        if !going && let Some(pick) = said.picked.filter(|_| tool.carries()) {
            held.rows = self.scene.get(id).and_then(|made| {
                // The view may show another gesture's preview.
                let layout = made.layout.filter(|_| had.is_none())?;
                let shown = match self.levels.get(id) {
                    Some(level) => level.branch(plant, pick.axis)?,
                    None => layout.branch(plant, pick.axis)?,
                };
                let parts = (0_u32..).zip(shown);
                let ranges =
                    parts.flat_map(|(part, rows)| rows.into_iter().map(move |r| [part, r.start, r.end]));
                Some(Rows { mesh: self.levels.name(id, made.revision), ranges: ranges.collect() })
            });
        }
        let picked = said.picked.and_then(|k| picked(plant, k, false));
        let host = tool.host().and_then(|axis| u32::try_from(axis.index()).ok());
        held.preview = said.preview.or_else(|| said.commit.clone()).map(Arc::new);
        let now = held.preview.clone();
        // Meshes that were made meanwhile are not moved: the held branch is then made again.
        let shown = self.scene.get(id).map(|made| self.levels.name(id, made.revision));
        held.rows = held.rows.take().filter(|rows| shown == Some(rows.mesh));
        let carried =
            held.rows.as_ref().filter(|_| busy).zip(tool.carried(plant)).map(|(rows, c)| CarriedPose {
                mesh: rows.mesh,
                from: c.from.to_array(),
                to: c.to.to_array(),
                turn: c.turn.to_array(),
            });
        held.carried = carried;
        let again = now != had && held.rows.is_none();
        if !busy && now.is_none() {
            self.held = None;
        }
        let turned_deg = now.as_deref().and_then(turned);
        let grown = match now.as_deref() {
            Some(HandEdit::Grow { rounds, .. }) if busy => {
                let before = self.held.as_ref().map(|h| &h.before);
                let shown = self.scene.get(id).and_then(|made| made.plant);
                before.map(|before| Grown::count(before, shown, *rounds))
            }
            _ => None,
        };
        let commit = said.commit;
        let none = ShapeAnswer::default();
        Ok(ShapeAnswer { picked, commit, busy, again, turned_deg, carried, grown, host, ..none })
    }

    /// Answers inputs that need no tool.
    fn aside(&self, id: PlantId, input: &ShapeInput) -> Result<Option<ShapeAnswer>, WorkspaceError> {
        let plant = || self.shown_plant(id).ok_or(WorkspaceError::NothingToShape);
        let none = ShapeAnswer::default();
        Ok(Some(match input {
            ShapeInput::Walk { from, to } => ShapeAnswer { picked: walked(plant()?, *from, *to), ..none },
            ShapeInput::Plane(at) => {
                let p = Pointer::from(*at);
                let plane = ViewPlane::facing(p.tip.unwrap_or(p.ray.origin), -p.ray.direction, p.up);
                ShapeAnswer { plane, ..none }
            }
            ShapeInput::Mirror(at) => {
                let p = Pointer::from(*at);
                ShapeAnswer { mirror: Mirror::between_hands(plant()?, p.forward.cross(p.up)), ..none }
            }
            _ => return Ok(None),
        }))
    }

    /// Finds the branch under the pointer, without an edit.
    fn point(&mut self, id: PlantId, reach: Reach, input: &ShapeInput) -> ShapeAnswer {
        let (at, named) = match input {
            ShapeInput::Down(at) | ShapeInput::Up(at) => (Some(*at), true),
            ShapeInput::Move(moves) => (moves.last().copied(), false),
            _ => (None, false),
        };
        let again = matches!(input, ShapeInput::Cancel) && self.held.take().is_some();
        let plant = self.shown_plant(id);
        let found = at.zip(plant).and_then(|(at, plant)| {
            let pick = shape::pick(plant, &Pointer::from(at).ray, reach)?;
            picked(plant, pick, named)
        });
        ShapeAnswer { picked: found, again, ..ShapeAnswer::default() }
    }

    /// Returns the plant that is shown, without the preview of a gesture.
    fn shown_plant(&self, id: PlantId) -> Option<&Plant> {
        if let Some(held) = self.held.as_ref().filter(|h| h.plant == id && h.preview.is_some()) {
            return Some(&held.before);
        }
        self.model(id)?;
        self.scene.get(id)?.plant
    }

    /// Returns a branch of the current plant that was picked, and all that it bears, as pairs of points: x, y, z and
    /// radius of each.
    pub fn branch(&self, axis: u32) -> Vec<f32> {
        let plant = self.current().and_then(|id| self.shown_plant(id));
        let Some(plant) = plant.filter(|p| (axis as usize) < p.axes.len()) else { return Vec::new() };
        let mut out = Vec::new();
        for (i, _) in plant.borne_by(AxisId::new(axis as usize)).into_iter().enumerate().filter(|(_, is)| *is)
        {
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

    /// Returns the control balls of the current leaf, for hands that move them.
    ///
    /// # Errors
    /// [`WorkspaceError::NoPlant`]; [`WorkspaceError::NothingMade`] for a plant that is not a leaf; the reason why it
    /// makes no leaf.
    pub fn balls(&self) -> Result<LeafBalls, WorkspaceError> {
        let plant = self.current_plant().ok_or(WorkspaceError::NoPlant)?;
        let Maker::Leaf(leaf) = &plant.settings().maker else { return Err(WorkspaceError::NothingMade) };
        Ok(burgeon::leaf_balls(leaf)?)
    }

    /// Returns the part of the current plant's meshes that a hand carries: part, first triangle, and end of each range;
    /// ranges of a part ascend and lie apart. Empty where nothing is carried.
    pub fn held_rows(&self) -> &[u32] {
        self.held.as_ref().and_then(|h| h.rows.as_ref()).map_or(&[], |rows| rows.ranges.as_flattened())
    }

    /// Returns a copy of the current plant as it is shown, with the carried branch in its pose; `None` where nothing is
    /// made.
    pub fn seen(&self) -> Option<Model> {
        let mut model = self.model(self.current()?)?.clone();
        let held = self.held.as_ref().and_then(|h| Some((h.rows.as_ref()?, h.carried?)));
        let Some((rows, pose)) = held else { return Some(model) };
        let v = DVec3::from_array;
        let (from, to, turn) = (v(pose.from), v(pose.to), DQuat::from_array(pose.turn));
        for (part, of) in (0_u32..).zip(&mut model.parts) {
            let ranges = rows.ranges.iter().filter(|r| r[0] == part);
            let triangles =
                ranges.filter_map(|r| of.mesh.triangles.get(r[1] as usize..r[2] as usize)).flatten();
            let mut vertices: Vec<u32> = triangles.flatten().copied().collect();
            vertices.sort_unstable();
            vertices.dedup();
            for vertex in vertices {
                if let Some(p) = of.mesh.positions.get_mut(vertex as usize) {
                    let at = DVec3::from_array(p.map(f64::from));
                    *p = (to + turn * (at - from)).as_vec3().to_array();
                }
                if let Some(n) = of.mesh.normals.get_mut(vertex as usize) {
                    *n = (turn * DVec3::from_array(n.map(f64::from))).as_vec3().to_array();
                }
            }
        }
        Some(model)
    }

    /// Returns the edit of the gesture that is shown on a plant.
    fn preview_edit(&self, id: PlantId) -> Option<&Arc<HandEdit>> {
        self.held.as_ref().filter(|h| h.plant == id)?.preview.as_ref()
    }

    /// Returns the document with the edit of the gesture in it, coarser where that is faster; `None` where nothing is
    /// held.
    pub(crate) fn with_gesture(&self) -> Option<(PlantId, Document)> {
        let id = self.current()?;
        // The shell moves what is carried.
        if self.held.as_ref().is_some_and(|h| h.rows.is_some()) {
            return None;
        }
        let edit = self.preview_edit(id)?;
        let mut aside = Editor::new(self.editor.document().clone());
        aside.run(ShapeCommand::Add(Arc::clone(edit)).for_plant(id)).ok()?;
        if self.held.as_ref().is_some_and(|h| h.large) {
            let command = coarser(aside.document(), id, PREVIEW_DETAIL);
            // A mesh that is already as coarse as possible stays as it is.
            if let Some(Err(e)) = command.map(|c| aside.run(c))
                && !matches!(e, CommandError::Nothing(_))
            {
                return None;
            }
        }
        Some((id, aside.document().clone()))
    }
}

/// Returns the angle by which an edit turns a branch, degrees.
fn turned(edit: &HandEdit) -> Option<f64> {
    match edit {
        HandEdit::Rotate { turn, .. } | HandEdit::Move { turn: Some(turn), .. } => Some(turn.degrees),
        _ => None,
    }
}

/// Returns the branch at the end of a step.
fn walked(plant: &Plant, from: Option<u32>, to: ShapeStep) -> Option<Picked> {
    let woody = |a: &Axis| a.kind.is_shoot();
    let bearer = |a: &Axis| Some(*plant.nodes.axis.get(a.bearer?.index())?);
    let from = from.map(|f| f as usize).filter(|&f| plant.axes.get(f).is_some_and(woody));
    let borne_by = |by: Option<AxisId>| -> Vec<usize> {
        let axes = plant.axes.iter().enumerate();
        axes.filter(|(_, a)| woody(a) && bearer(a) == by).map(|(row, _)| row).collect()
    };
    let row = match (from, to) {
        (None, _) => *borne_by(None).first()?,
        (Some(from), ShapeStep::Bearer) => bearer(&plant.axes[from]).map_or(from, AxisId::index),
        (Some(from), ShapeStep::Borne) => borne_by(Some(AxisId::new(from))).first().copied().unwrap_or(from),
        (Some(from), _) => {
            let beside = borne_by(bearer(&plant.axes[from]));
            let at = beside.iter().position(|&row| row == from)?;
            let step = if to == ShapeStep::Next { 1 } else { beside.len() - 1 };
            beside[(at + step) % beside.len()]
        }
    };
    let axis = AxisId::new(row);
    let points = plant.axis_points(axis);
    let point = *points.get(points.len() / 2)?;
    picked(plant, Pick { axis, at: 0.5, point, distance_m: 0.0 }, true)
}

/// Describes a branch; `named`: with a key for edits.
fn picked(plant: &Plant, pick: Pick, named: bool) -> Option<Picked> {
    let axis = u32::try_from(pick.axis.index()).ok()?;
    let shoots = plant.borne_by(pick.axis);
    let shoots = shoots.iter().zip(&plant.axes).filter(|(is, a)| **is && a.kind.is_shoot());
    Some(Picked {
        axis,
        at: pick.at,
        point: pick.point.to_array(),
        order: plant.axis(pick.axis).order,
        length_m: geom::polyline_length3(plant.axis_points(pick.axis)),
        bears: shoots.count().saturating_sub(1),
        stands: plant.axis(pick.axis).bearer.is_none(),
        key: if named { AxisKey::for_axis(plant, pick.axis) } else { None },
    })
}
