//! Tools as state machines: they turn the motions of a hand, as data, into edits. Mouse, pen and controllers are
//! adapters.
//!
//! `Input (rays) -> Tool -> Response { preview, commit }`

use base::ops::PI;
use glam::{DQuat, DVec2, DVec3};
use growth::{GuidedChange, GuidedSpec, Tropism};
use plant::{AxisId, Plant};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::carry::Carried;
use crate::edit::{Destination, GrowFrom, HandEdit, LeafRegion, MOST_ROUNDS, Mirror, Turn, ViewPlane};
use crate::key::AxisKey;
use crate::pick::{Pick, Ray, Reach, nearest, pick};

/// Kind of a tool, with its settings. Lengths in metres of the plant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub enum ToolKind {
    /// Point at a branch: it makes no edit.
    Pick,
    /// Drag a branch around its base: in the plane that faces the viewer, or after the tip of a controller. A hand that
    /// turns also rolls it, and one that pulls takes it off its bearer: it is dropped on the wood nearest to its base.
    Rotate,
    /// Drag a branch along its bearer, or with the tip of a controller to a new bearer; a branch on the ground, over
    /// the ground.
    Move,
    /// Drag a copy of a branch to a new bearer; a copy of a branch on the ground, over the ground.
    Copy,
    /// Click a branch: it is cut at the clicked place, or removed.
    Prune {
        /// Whether to remove all of it.
        whole: bool,
    },
    /// Click a branch: another one grows in its place.
    Regrow,
    /// Draw a branch from another one.
    Sketch {
        /// Twigs on it, 0 to 4.
        twigs: f64,
        /// Tilt of the drawing plane away from the viewer, degrees; 0 faces the viewer.
        tilt_deg: f64,
    },
    /// Brush, and branches grow along the stroke.
    Brush {
        /// Radius at full pressure, metres, above 0.
        radius_m: f64,
        /// Density, 0.1 to 10.
        density: f64,
    },
    /// Hold on a branch or on the ground, and a shoot grows by itself, round by round.
    Grow(Growth),
    /// Draw an outline around the space to be filled.
    Silhouette {
        /// Density, 0.1 to 10.
        density: f64,
        /// Whether parts outside it are cut off.
        trim: bool,
        /// Plane of the outline, if it was placed in space; without it, the plane faces the viewer through the plant's
        /// middle.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        plane: Option<ViewPlane>,
    },
    /// Brush over leaves.
    Leaves {
        /// Radius, metres, above 0.
        radius_m: f64,
        /// Share that stays, 0 to 4.
        keep: f64,
    },
}

/// Settings of a shoot that grows by itself; every number may change while it grows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Growth {
    /// Vigour per unit of free space, above 0 and at most 100.
    pub vigour: f64,
    /// Apical control: the share of the main axis at a fork, 0 to 1.
    pub apical: f64,
    /// Angle between a shoot and its lateral buds, 0 to 180 degrees.
    pub angle_deg: f64,
    /// Pull to the light, or of the weight if negative, -10 to 10; free space pulls with 1.
    pub lift: f64,
    /// Strength with which shoots keep apart, 0 to 10.
    pub apart: f64,
}

impl Default for Growth {
    fn default() -> Self {
        let GuidedSpec { alpha, lambda, branch_angle_deg, tropisms, repulsion, .. } = GuidedSpec::default();
        let lift = tropisms.iter().map(|t| t.strength).sum();
        Self { vigour: alpha, apical: lambda, angle_deg: branch_angle_deg, lift, apart: repulsion }
    }
}

impl Growth {
    /// Returns the settings as a change of growth from a round on.
    fn change_at(self, round: u32) -> GuidedChange {
        GuidedChange {
            round,
            alpha: Some(self.vigour),
            lambda: Some(self.apical),
            branch_angle_deg: Some(self.angle_deg),
            repulsion: Some(self.apart),
            tropisms: Some(vec![Tropism { strength: self.lift, ..Tropism::UPWARDS }]),
            ..GuidedChange::default()
        }
    }
}

/// A pointing device at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pointer {
    /// Its ray.
    pub ray: Ray,
    /// Direction of the viewer's gaze.
    pub forward: DVec3,
    /// The viewer's upward direction.
    pub up: DVec3,
    /// Pressure, 0 to 1; 1 for a mouse.
    pub pressure: f64,
    /// Position of a tracked controller's tip, which draws there and not on a plane.
    pub tip: Option<DVec3>,
    /// Orientation of that controller: the held branch turns with it.
    pub hand: Option<DQuat>,
}

impl Pointer {
    /// Returns the orientation of the hand as a unit quaternion; `None` for an invalid one.
    fn held(&self) -> Option<DQuat> {
        self.hand.filter(|q| q.is_finite() && q.length_squared() > 1e-6).map(DQuat::normalize)
    }
}

/// Input of a hand.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Input {
    /// A button, pen or trigger went down.
    Down(Pointer),
    /// The pointer moved.
    Move(Pointer),
    /// The button, pen or trigger was released: the gesture becomes an edit.
    Up(Pointer),
    /// Escape, a second finger, or loss of the device: no edit.
    Cancel,
    /// A thumbstick, touchpad or wheel turned by this angle in radians: an exact rotation of the held branch, or a tilt
    /// of the drawing plane about the pointer (away from the viewer if positive).
    Twist(f64),
    /// The brush changed while it is down: radius in metres, density.
    Brush(f64, f64),
    /// The growing shoot is a round older.
    Round,
    /// The growing shoot has new settings from this round on; numbers out of their ranges change nothing.
    Grow(Growth),
}

/// Response of a tool to an input.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Response {
    /// The edit that a release would make: to be shown, not saved.
    pub preview: Option<HandEdit>,
    /// The edit of a finished gesture.
    pub commit: Option<HandEdit>,
    /// The branch under the pointer or in the hand.
    pub picked: Option<Pick>,
}

/// A tool in a hand. One gesture, from down to up, makes one edit or none.
///
/// ```
/// use glam::DVec3;
/// use plant::{AxisKind, Plant};
/// use shape::{HandEdit, Input, Pointer, Ray, Tool, ToolKind};
/// let mut p = Plant::default();
/// p.add_axis(AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * 2.0], None);
/// let at = |y: f64| Pointer {
///     ray: Ray { origin: DVec3::new(0.0, y, 5.0), direction: DVec3::NEG_Z },
///     forward: DVec3::NEG_Z, up: DVec3::Y, pressure: 1.0, tip: None, hand: None,
/// };
/// let mut shears = Tool::new(ToolKind::Prune { whole: false });
/// shears.handle(&p, &Input::Down(at(1.5)));
/// let cut = shears.handle(&p, &Input::Up(at(1.5))).commit;
/// assert!(matches!(cut, Some(HandEdit::Prune { at, .. }) if (at - 0.75).abs() < 1e-9));
/// ```
#[derive(Clone, Debug)]
pub struct Tool {
    kind: ToolKind,
    reach: Reach,
    /// Plane of symmetry in which its edits are mirrored.
    mirror: Option<Mirror>,
    /// The seed of the next edit that lets something grow.
    seed: u64,
    state: State,
}

#[derive(Clone, Debug)]
enum State {
    Idle,
    Turning {
        pick: Pick,
        key: AxisKey,
        pivot: DVec3,
        about: DVec3,
        last: Option<DVec3>,
        angle: f64,
        /// Position at which a tracked tip took hold, relative to the pivot.
        tip: Option<DVec3>,
        /// Orientation of the hand when it took hold.
        hand: Option<DQuat>,
        /// Rotation of the branch since then.
        swing: DQuat,
        off: Option<Pulled>,
    },
    Sliding {
        pick: Pick,
        key: AxisKey,
        bearer: Option<(AxisKey, AxisId)>,
        grabbed: f64,
        foot: DVec3,
        /// The pointer as it went down.
        from: Box<Pointer>,
        to: Option<Goal>,
    },
    Clicking {
        pick: Pick,
        key: AxisKey,
    },
    Growing {
        pick: Option<Pick>,
        from: GrowFrom,
        towards: DVec3,
        rounds: u32,
        record: Vec<GuidedChange>,
    },
    Stroking(Box<Stroking>),
}

/// Destination of a sliding branch.
#[derive(Clone, Copy, Debug)]
enum Goal {
    /// A place of an axis, as a share of its length.
    Wood(AxisId, f64),
    /// By this vector over the ground, metres.
    Ground(DVec3),
}

/// A branch that was pulled off its bearer.
#[derive(Clone, Copy, Debug)]
struct Pulled {
    /// The axis that it would be dropped on, and the place there, as a share of its length.
    host: AxisId,
    share: f64,
    /// Rotation of the hand since it took hold.
    turn: DQuat,
}

#[derive(Clone, Debug)]
struct Stroking {
    pick: Option<Pick>,
    bearer: Option<AxisKey>,
    through: DVec3,
    right: DVec3,
    normal: DVec3,
    /// Whether a tip draws on the plane in front of it, not in space.
    on_plane: bool,
    spacing: f64,
    points: Vec<DVec3>,
    radius_m: Vec<f64>,
}

/// Largest distance from the plant's origin of a point on the ground, metres.
const FARTHEST_M: f64 = 200.0;
/// Radians of a degree.
const DEGREE: f64 = PI / 180.0;
/// Largest tilt of a drawing plane, degrees: beyond it, the plane is seen almost from its edge.
const MOST_LEAN_DEG: f64 = 80.0;
/// Least rotation by a drag, degrees: less is a slip of the hand.
const LEAST_TURN_DEG: f64 = 0.2;
/// Factor of the usual reach within which a drawn branch may begin off all wood: 63 pixels with a mouse.
const BESIDE: f64 = 7.0;
/// Distance from the pivot, as a share of the branch, within which a drag gives no angle (the VR paper's dead zone).
const DEAD: f64 = 0.05;
/// Pull that takes a branch off its bearer, as a share of the branch's length.
const PULL: f64 = 0.35;
/// Pull that takes a branch off its bearer, as a multiple of the reach.
const PULL_REACH: f64 = 2.0;
/// Sine of half the least roll of a hand: a smaller one is rounding.
const STEADY: f64 = 1e-9;

impl Tool {
    /// Makes a tool that holds nothing.
    pub fn new(kind: ToolKind) -> Self {
        Self { kind, reach: Reach::default(), mirror: None, seed: 1, state: State::Idle }
    }

    /// Sets the reach and the seed of the next growth (each edit takes the next seed).
    #[must_use]
    pub const fn with(mut self, reach: Reach, seed: u64) -> Self {
        self.reach = reach;
        self.seed = seed;
        self
    }

    /// Mirrors all that it draws, brushes or grows in a plane.
    #[must_use]
    pub const fn mirrored(mut self, mirror: Option<Mirror>) -> Self {
        self.mirror = mirror;
        self
    }

    /// Returns its kind, with the current settings.
    pub const fn kind(&self) -> ToolKind {
        self.kind
    }

    /// Whether a gesture is in progress.
    pub const fn is_busy(&self) -> bool {
        !matches!(self.state, State::Idle)
    }

    /// Whether a gesture is in progress that moves a branch rigidly with all that it bears.
    pub const fn carries(&self) -> bool {
        !matches!(self.kind, ToolKind::Copy)
            && matches!(self.state, State::Turning { .. } | State::Sliding { .. })
    }

    /// Returns the motion of the branch in the hand, if the edit so far is only that; `plant`: as for
    /// [`handle`](Self::handle).
    ///
    /// Guaranteed: every node of the branch and of all that it bears is where the edit puts it, to 1e-9 of the plant's
    /// size. Cost: linear in the branch's bearer, old and new.
    pub fn carried(&self, plant: &Plant) -> Option<Carried> {
        match &self.state {
            _ if !self.carries() => None,
            State::Turning { pick, about, angle, off: Some(off), .. } => {
                let turn = turn_of(*about, *angle, off.turn).quat().ok()?;
                Some(Carried { turn, ..Carried::onto(plant, pick.axis, off.host, off.share)? })
            }
            State::Turning { pick, pivot, about, angle, swing, off: None, .. } => {
                let turn = turn_of(*about, *angle, *swing).quat().ok()?;
                Some(Carried { axis: pick.axis, from: *pivot, to: *pivot, turn })
            }
            State::Sliding { pick, foot, to, .. } => match to {
                Some(Goal::Wood(host, share)) => Carried::onto(plant, pick.axis, *host, *share),
                Some(Goal::Ground(by)) => {
                    let turn = DQuat::IDENTITY;
                    Some(Carried { axis: pick.axis, from: *foot, to: *foot + *by, turn })
                }
                None => None,
            },
            _ => None,
        }
    }

    /// Returns the axis that the branch in the hand would be dropped on: once it was pulled off, or slid onto other
    /// wood.
    pub fn host(&self) -> Option<AxisId> {
        match &self.state {
            State::Turning { off, .. } => off.map(|off| off.host),
            State::Sliding { to: Some(Goal::Wood(host, _)), bearer, .. } => {
                Some(*host).filter(|host| bearer.as_ref().is_none_or(|(_, axis)| axis != host))
            }
            _ => None,
        }
    }

    /// Handles one input. `plant`: the plant at the start of the gesture, without its preview.
    ///
    /// Guaranteed: no input panics; a commit only on [`Input::Up`]; after `Up` and `Cancel` it holds nothing. Cost:
    /// linear in the plant on `Down`, linear in the bearer or the stroke on `Move`.
    pub fn handle(&mut self, plant: &Plant, input: &Input) -> Response {
        match input {
            Input::Down(p) => self.down(plant, p),
            Input::Move(p) => self.moved(plant, p),
            Input::Up(p) => {
                let last = self.moved(plant, p);
                let held = self.is_busy();
                self.state = State::Idle;
                let commit = last.preview.filter(|_| held);
                self.seed = self.seed.wrapping_add(u64::from(commit.is_some()));
                Response { commit, preview: None, picked: last.picked }
            }
            Input::Cancel => {
                self.state = State::Idle;
                Response::default()
            }
            Input::Twist(by) => self.twist(plant, *by),
            Input::Brush(radius, wanted) => {
                if let ToolKind::Brush { radius_m, density } = &mut self.kind {
                    *radius_m = if *radius > 0.0 && radius.is_finite() { *radius } else { *radius_m };
                    *density = if wanted.is_finite() { wanted.clamp(0.1, 10.0) } else { *density };
                }
                self.preview(plant)
            }
            Input::Round => {
                if let State::Growing { rounds, .. } = &mut self.state {
                    *rounds = (*rounds + 1).min(MOST_ROUNDS);
                }
                self.preview(plant)
            }
            Input::Grow(growth) => {
                self.turn_numbers(*growth);
                self.preview(plant)
            }
        }
    }

    fn turn_numbers(&mut self, growth: Growth) {
        let ToolKind::Grow(now) = &mut self.kind else { return };
        if *now == growth || !growth.change_at(0).is_sound() {
            return;
        }
        *now = growth;
        if let State::Growing { rounds, record, .. } = &mut self.state {
            record.retain(|c| c.round < *rounds);
            record.push(growth.change_at(*rounds));
        }
    }

    fn down(&mut self, plant: &Plant, p: &Pointer) -> Response {
        let ray = &p.ray;
        let near = pick(plant, ray, self.reach);
        let picked = near.or_else(|| {
            // A branch that begins in the sky grows from the wood next to it.
            let Reach { metres, per_metre, bearers } = self.reach;
            let far = Reach { metres: BESIDE * metres, per_metre: BESIDE * per_metre, bearers };
            matches!(self.kind, ToolKind::Sketch { .. }).then(|| pick(plant, ray, far)).flatten()
        });
        let named = picked.and_then(|k| Some((k, AxisKey::for_axis(plant, k.axis)?)));
        self.state = match (self.kind, named) {
            (ToolKind::Pick, _) => State::Idle,
            (ToolKind::Rotate, Some((pick, key))) => {
                let pivot = plant.axis_points(pick.axis)[0];
                let about = -p.forward.normalize_or(DVec3::NEG_Z);
                let tip = p.tip.map(|t| t - pivot).filter(|t| t.is_finite());
                let last = hand(p, pivot, about).filter(|_| tip.is_none());
                let (hand, swing, off) = (p.held(), DQuat::IDENTITY, None);
                State::Turning { pick, key, pivot, about, last, angle: 0.0, tip, hand, swing, off }
            }
            (ToolKind::Move | ToolKind::Copy, Some((pick, key))) => {
                let on = plant.axis(pick.axis).bearer.map(|n| plant.nodes.axis[n.index()]);
                let bearer = on.and_then(|axis| Some((AxisKey::for_axis(plant, axis)?, axis)));
                let foot = plant.axis_points(pick.axis)[0];
                let share = on.map_or(0.0, |axis| share_of(plant, axis, foot));
                let grabbed = on.map_or(0.0, |axis| share - share_under(plant, axis, p));
                State::Sliding { pick, key, bearer, grabbed, foot, from: Box::new(*p), to: None }
            }
            (ToolKind::Prune { .. } | ToolKind::Regrow, Some((pick, key))) => State::Clicking { pick, key },
            (
                ToolKind::Rotate
                | ToolKind::Move
                | ToolKind::Copy
                | ToolKind::Prune { .. }
                | ToolKind::Regrow,
                None,
            ) => State::Idle,
            (ToolKind::Grow(growth), named) => {
                let from = match &named {
                    Some((pick, key)) => Some(GrowFrom::Branch { axis: key.clone(), at: pick.at }),
                    None => on_ground(p).map(GrowFrom::Ground),
                };
                let towards = if p.tip.is_some() { p.ray.direction } else { -p.forward };
                let towards = towards.try_normalize().unwrap_or(DVec3::Y);
                match from.filter(|_| growth.change_at(0).is_sound()) {
                    Some(from) => {
                        let (pick, record) = (named.map(|(pick, _)| pick), vec![growth.change_at(0)]);
                        State::Growing { pick, from, towards, rounds: 1, record }
                    }
                    None => State::Idle,
                }
            }
            (ToolKind::Sketch { .. }, None) => State::Idle,
            (_, named) => match self.stroke(plant, p, named) {
                Some(stroke) => State::Stroking(Box::new(stroke)),
                None => State::Idle,
            },
        };
        Response { picked, ..self.preview(plant) }
    }

    /// Returns the plane of a stroke: through the picked branch, else through the plant's middle.
    fn stroke(&self, plant: &Plant, p: &Pointer, named: Option<(Pick, AxisKey)>) -> Option<Stroking> {
        let corners = plant.nodes.position.iter();
        let (lo, hi) =
            corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), q| (lo.min(*q), hi.max(*q)));
        let size = (hi - lo).length();
        if !size.is_finite() {
            return None;
        }
        let normal = -p.forward.try_normalize()?;
        let right = p.forward.cross(p.up).try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
        let tilt = if let ToolKind::Sketch { tilt_deg, .. } = self.kind { tilt_deg * DEGREE } else { 0.0 };
        let lasso = matches!(self.kind, ToolKind::Silhouette { .. });
        let through = named.as_ref().filter(|_| !lasso).map_or((lo + hi) * 0.5, |(k, _)| k.point);
        let (through, right, normal) = match self.kind {
            ToolKind::Silhouette { plane: Some(plane), .. } => {
                let [right, _, towards] = plane.axes().ok()?;
                (plane.origin, right, towards)
            }
            _ => (through, right, leaned(normal, right, tilt)),
        };
        let (pick, bearer) = named.unzip();
        let mut stroke = Stroking {
            pick,
            bearer,
            through,
            right,
            normal,
            on_plane: lasso,
            spacing: 0.004 * size.max(1e-9),
            points: Vec::new(),
            radius_m: Vec::new(),
        };
        stroke.add(p, self.radius(p.pressure));
        Some(stroke)
    }

    fn radius(&self, pressure: f64) -> f64 {
        match self.kind {
            ToolKind::Brush { radius_m, .. } | ToolKind::Leaves { radius_m, .. } => {
                let pressure = if pressure.is_finite() { pressure.clamp(0.0, 1.0) } else { 1.0 };
                radius_m * (0.4 + 0.6 * pressure)
            }
            _ => 0.0,
        }
    }

    fn moved(&mut self, plant: &Plant, p: &Pointer) -> Response {
        let radius = self.radius(p.pressure);
        match &mut self.state {
            State::Idle => {
                return Response { picked: pick(plant, &p.ray, self.reach), ..Response::default() };
            }
            State::Turning { pick, pivot, tip: Some(from), hand, swing, off, .. } => {
                let length = geom::polyline_length3(plant.axis_points(pick.axis));
                let to = p.tip.map(|t| t - *pivot).filter(|t| t.is_finite() && t.length() > DEAD * length);
                let turn = hand.zip(p.held()).map(|(was, is)| is * was.conjugate());
                if let Some((a, to, b)) =
                    from.try_normalize().zip(to).and_then(|(a, to)| Some((a, to, to.try_normalize()?)))
                {
                    let least = base::turn::between(a, b);
                    *swing = turn.map_or(least, |turn| rolled(least, turn, b));
                    let most = from.length() + PULL * length + PULL_REACH * self.reach.metres;
                    let borne = plant.axis(pick.axis).bearer.is_some();
                    *off = turn.filter(|_| borne && to.length() > most).and_then(|turn| {
                        match wood_near(plant, *pivot + to - turn * *from, pick.axis)? {
                            Goal::Wood(host, share) => Some(Pulled { host, share, turn }),
                            Goal::Ground(_) => None,
                        }
                    });
                }
            }
            State::Turning { pick, pivot, about, last, angle, tip: None, .. } => {
                let length = geom::polyline_length3(plant.axis_points(pick.axis));
                let now = hand(p, *pivot, *about).filter(|b| b.length() > DEAD * length);
                if let (Some(a), Some(b)) = (*last, now) {
                    // angle = atan2(a x b, a . b) about the view direction (the VR paper), added up.
                    *angle += base::ops::atan2(a.cross(b).dot(*about), a.dot(b));
                }
                *last = now.or(*last);
            }
            State::Sliding { pick, bearer, grabbed, foot, from, to, .. } => {
                let now = match (bearer, p.tip) {
                    _ if matches!(self.kind, ToolKind::Copy) && is_still(plant, pick.axis, from, p) => None,
                    (Some(_), Some(tip)) => wood_near(plant, tip, pick.axis),
                    (Some(_), None) if matches!(self.kind, ToolKind::Copy) => {
                        wood_under(plant, &p.ray, Reach { bearers: 0, ..self.reach }, pick.axis)
                    }
                    (Some((_, axis)), None) => {
                        let at = (share_under(plant, *axis, p) + *grabbed).clamp(0.0, 1.0);
                        Some(Goal::Wood(*axis, at))
                    }
                    (None, _) => over_ground(from, p, *foot).map(Goal::Ground),
                };
                // Above the horizon there is no ground: the branch stays at its last place.
                *to = now.or(*to);
            }
            State::Clicking { .. } | State::Growing { .. } => {}
            State::Stroking(stroke) => stroke.add(p, radius),
        }
        self.preview(plant)
    }

    fn twist(&mut self, plant: &Plant, by: f64) -> Response {
        if !by.is_finite() {
            return Response::default();
        }
        match &mut self.state {
            State::Turning { angle, .. } => *angle += by,
            State::Stroking(stroke) => {
                // The plane tilts about the stroke's last point: the drawn part stays in place.
                if let Some(&last) = stroke.points.last() {
                    stroke.through = last;
                    stroke.normal = leaned(stroke.normal, stroke.right, by);
                }
            }
            _ => {}
        }
        if let (State::Idle, ToolKind::Sketch { tilt_deg, .. }) = (&self.state, &mut self.kind) {
            *tilt_deg = (*tilt_deg + by / DEGREE).clamp(-MOST_LEAN_DEG, MOST_LEAN_DEG);
        }
        self.edit(plant)
            .map_or_else(Response::default, |e| Response { preview: Some(e), ..Response::default() })
    }

    fn preview(&self, plant: &Plant) -> Response {
        let picked = match &self.state {
            State::Idle => None,
            State::Turning { pick, .. } | State::Sliding { pick, .. } | State::Clicking { pick, .. } => {
                Some(*pick)
            }
            State::Growing { pick, .. } => *pick,
            State::Stroking(s) => s.pick,
        };
        Response { preview: self.edit(plant), commit: None, picked }
    }

    /// Returns the edit of the gesture so far.
    fn edit(&self, plant: &Plant) -> Option<HandEdit> {
        let seed = self.seed;
        match &self.state {
            State::Idle => None,
            State::Turning { pick, key, about, angle, off: Some(off), .. } => {
                let held = turn_of(*about, *angle, off.turn).quat().ok()?;
                let seat = Carried::onto(plant, pick.axis, off.host, off.share)?;
                let to = Destination::Place { axis: AxisKey::for_axis(plant, off.host)?, at: off.share };
                let turn = Some(Turn::from_quat(held * seat.turn.conjugate()));
                Some(HandEdit::Move { axis: key.clone(), to, turn })
            }
            State::Turning { key, about, angle, swing, off: None, .. } => {
                let turn = turn_of(*about, *angle, *swing);
                (turn.degrees.abs() >= LEAST_TURN_DEG).then(|| HandEdit::Rotate { axis: key.clone(), turn })
            }
            State::Sliding { key, bearer, to, .. } => {
                let to = match (*to)? {
                    Goal::Ground(by) => Destination::ByM(by),
                    Goal::Wood(on, at) => {
                        let known =
                            bearer.as_ref().filter(|(_, axis)| *axis == on).map(|(key, _)| key.clone());
                        Destination::Place { axis: known.or_else(|| AxisKey::for_axis(plant, on))?, at }
                    }
                };
                let axis = key.clone();
                Some(match self.kind {
                    ToolKind::Copy => HandEdit::Copy { axis, to },
                    _ => HandEdit::Move { axis, to, turn: None },
                })
            }
            State::Clicking { pick, key } => Some(match self.kind {
                ToolKind::Regrow => HandEdit::Regrow { axis: key.clone(), seed },
                ToolKind::Prune { whole: false } => HandEdit::Prune { axis: key.clone(), at: pick.at },
                _ => HandEdit::Prune { axis: key.clone(), at: 0.0 },
            }),
            State::Growing { from, towards, rounds, record, .. } => Some(HandEdit::Grow {
                from: from.clone(),
                towards: Some(*towards),
                rounds: *rounds,
                changes: record.clone(),
                seed,
                mirror: self.mirror,
            }),
            State::Stroking(s) => self.stroke_edit(s),
        }
    }

    fn stroke_edit(&self, s: &Stroking) -> Option<HandEdit> {
        let (points, seed) = (s.points.clone(), self.seed);
        let least = match self.kind {
            ToolKind::Silhouette { .. } => 3,
            ToolKind::Leaves { .. } => 1,
            _ => 2,
        };
        if points.len() < least {
            return None;
        }
        Some(match self.kind {
            ToolKind::Sketch { twigs, .. } => HandEdit::SketchBranch {
                bearer: s.bearer.clone()?,
                at: s.pick.map(|k| k.at),
                points,
                twigs,
                seed,
                mirror: self.mirror,
            },
            ToolKind::Brush { density, .. } => {
                let (bearer, radius_m) = (s.bearer.clone(), s.radius_m.clone());
                HandEdit::Brush { bearer, points, radius_m, density, seed, mirror: self.mirror }
            }
            ToolKind::Silhouette { density, trim, .. } => {
                let plane = ViewPlane { origin: s.through, right: s.right, up: s.normal.cross(s.right) };
                let flat = |q: &DVec3| {
                    DVec2::new((*q - plane.origin).dot(plane.right), (*q - plane.origin).dot(plane.up))
                };
                let outline = points.iter().map(flat).collect();
                HandEdit::Silhouette { plane, outline, density, trim, seed, mirror: self.mirror }
            }
            ToolKind::Leaves { keep, .. } => {
                let radius_m = s.radius_m.iter().copied().fold(0.0, f64::max);
                HandEdit::LeafDensity { region: LeafRegion::Stroke { points, radius_m }, keep, seed }
            }
            _ => return None,
        })
    }
}

impl Stroking {
    fn add(&mut self, p: &Pointer, radius_m: f64) {
        let fall =
            |t: DVec3| if self.on_plane { t - self.normal * (t - self.through).dot(self.normal) } else { t };
        let tip = p.tip.filter(|t| t.is_finite()).map(fall);
        let at = tip.or_else(|| p.ray.meets(self.through, self.normal));
        let Some(at) = at.filter(|a| a.is_finite()) else { return };
        if self.points.last().is_none_or(|last| last.distance(at) >= self.spacing) {
            self.points.push(at);
            self.radius_m.push(radius_m);
        }
    }
}

/// Combines a swing and then a rotation about an axis (radians) into one.
fn turn_of(about: DVec3, angle: f64, swing: DQuat) -> Turn {
    if swing == DQuat::IDENTITY {
        return Turn { about, degrees: angle * (180.0 / PI) };
    }
    let q = base::turn::about(about.normalize_or(DVec3::Y), angle) * swing;
    let q = if q.w < 0.0 { -q } else { q };
    let axis = q.xyz();
    let degrees = 2.0 * base::ops::atan2(axis.length(), q.w) * (180.0 / PI);
    Turn { about: axis.normalize_or(about), degrees }
}

/// Combines the least rotation to a direction with the roll of a turned hand about it.
fn rolled(least: DQuat, turn: DQuat, along: DVec3) -> DQuat {
    // A hand that only moved there did not roll, and rounding is no roll.
    if turn.xyz().length() < STEADY {
        return least;
    }
    let rest = turn * least.conjugate();
    base::turn::about(along, 2.0 * base::ops::atan2(rest.xyz().dot(along), rest.w)) * least
}

/// Returns the pointer in the plane of a rotation, relative to its pivot.
fn hand(p: &Pointer, pivot: DVec3, about: DVec3) -> Option<DVec3> {
    let at = p.tip.or_else(|| p.ray.meets(pivot, about))?;
    let flat = (at - pivot) - about * (at - pivot).dot(about);
    (flat.is_finite() && flat.length() > 0.0).then_some(flat)
}

/// Returns how far the foot of a stem moves over the ground with the pointer: wherever along the stem the pointer went
/// down, the foot keeps its distance from it on the screen. `None` where that is above the horizon.
fn over_ground(from: &Pointer, now: &Pointer, foot: DVec3) -> Option<DVec3> {
    if let Some((a, b)) = from.tip.zip(now.tip) {
        return Some((b - a).with_y(0.0));
    }
    let [before, after] = [from, now].map(|p| p.ray.direction.try_normalize());
    let (before, after) = before.zip(after)?;
    let turned = base::turn::between(before, after) * (foot - from.ray.origin);
    let seen = now.ray.origin + turned;
    // Rays of a front view are parallel and begin in a plane; those of an eye begin in the eye.
    let eye = from.ray.origin.distance(now.ray.origin) <= 1e-9 * turned.length();
    let ray = Ray { origin: now.ray.origin, direction: turned };
    let ray = if eye { ray } else { Ray { origin: seen - after * turned.length(), direction: after } };
    let at = ray.meets(foot, DVec3::Y)?;
    Some((at - foot).with_y(0.0))
}

/// Returns the point where a pointer meets the ground, if not too far away.
fn on_ground(p: &Pointer) -> Option<DVec3> {
    let at = p.ray.meets(DVec3::ZERO, DVec3::Y)?.with_y(0.0);
    let ahead = (at - p.ray.origin).dot(p.ray.direction) > 0.0;
    (ahead && at.is_finite() && at.length() < FARTHEST_M).then_some(at)
}

/// Whether a pointer is still about where it went down: a copy within its own branch is a slip of the hand.
fn is_still(plant: &Plant, axis: AxisId, from: &Pointer, now: &Pointer) -> bool {
    let least = DEAD * geom::polyline_length3(plant.axis_points(axis));
    match (from.tip, now.tip) {
        (Some(a), Some(b)) => a.distance(b) < least,
        _ => from.ray == now.ray,
    }
}

/// Finds the place on a shoot that a ray means, except on `but` and on shoots that it bears.
fn wood_under(plant: &Plant, ray: &Ray, reach: Reach, but: AxisId) -> Option<Goal> {
    let pick = pick(plant, ray, reach)?;
    let kind = plant.axis(pick.axis).kind;
    let other = !plant.borne_by(but)[pick.axis.index()];
    (other && kind.is_shoot()).then_some(Goal::Wood(pick.axis, pick.at))
}

/// Finds the place on a shoot nearest to a point, except on `but` and on shoots that it bears.
fn wood_near(plant: &Plant, at: DVec3, but: AxisId) -> Option<Goal> {
    let borne = plant.borne_by(but);
    let shoots = plant.axes.iter().enumerate();
    let shoots = shoots.filter(|(_, a)| a.kind.is_shoot());
    let (axis, _, share) = shoots
        .map(|(i, _)| AxisId::new(i))
        .filter(|axis| at.is_finite() && !borne[axis.index()])
        .map(|axis| {
            let (gap, share) = geom::nearest_on_polyline3(plant.axis_points(axis), at);
            (axis, gap, share)
        })
        .reduce(|a, b| if b.1 < a.1 { b } else { a })?;
    Some(Goal::Wood(axis, share))
}

fn leaned(normal: DVec3, right: DVec3, by: f64) -> DVec3 {
    let (s, c) = base::ops::sin_cos(by);
    (normal * c - right.cross(normal) * s).normalize_or(normal)
}

/// Returns the share of an axis at which one of its points lies.
fn share_of(plant: &Plant, axis: AxisId, at: DVec3) -> f64 {
    geom::nearest_on_polyline3(plant.axis_points(axis), at).1
}

/// Returns the share of an axis that is nearest to a pointer.
fn share_under(plant: &Plant, axis: AxisId, p: &Pointer) -> f64 {
    let points = plant.axis_points(axis);
    if let Some(tip) = p.tip {
        return share_of(plant, axis, tip);
    }
    let Some(d) = p.ray.direction.try_normalize() else { return 0.0 };
    let (mut best, mut at, mut sum) = (f64::INFINITY, 0.0, 0.0);
    for w in points.windows(2) {
        let (s, t) = nearest(p.ray.origin, d, w[0], w[1]);
        let gap = w[0].lerp(w[1], s).distance(p.ray.origin + d * t);
        let length = w[0].distance(w[1]);
        if gap < best {
            (best, at) = (gap, sum + s * length);
        }
        sum += length;
    }
    if sum > 0.0 { at / sum } else { 0.0 }
}
