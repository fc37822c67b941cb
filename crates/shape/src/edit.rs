//! Hand edits as plain data, which is saved, sent and applied again.

use base::ops::PI;
use glam::{DQuat, DVec2, DVec3};
use growth::GuidedChange;
use plant::{AxisId, Plant};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::AxisKey;
use crate::outcome::Why;

/// One edit of a plant by hand. Metres, degrees, +Y up; saved as JSON.
///
/// ```
/// use shape::HandEdit;
/// let text = r#"{"op": "prune", "axis": {"path": [0, 2]}, "at": 0.5}"#;
/// let edit: HandEdit = serde_json::from_str(text)?;
/// assert!(matches!(edit, HandEdit::Prune { at, .. } if at == 0.5));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "op", rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub enum HandEdit {
    /// Turns a branch about its base, with all that it bears.
    Rotate {
        /// The branch.
        axis: AxisKey,
        /// The rotation.
        turn: Turn,
    },
    /// Moves a branch with all that it bears.
    Move {
        /// The branch.
        axis: AxisKey,
        /// The destination.
        to: Destination,
        /// Turns it about its base there, from how it would stand otherwise. Default not at all.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        turn: Option<Turn>,
    },
    /// Sets a copy of a branch, with all that it bears, elsewhere; the branch itself stays. The copy is thinned to suit
    /// its new bearer.
    Copy {
        /// The branch.
        axis: AxisKey,
        /// The destination; also on the branch itself or on a part that it bears.
        to: Destination,
    },
    /// Cuts a branch off, with all that it bears beyond the cut.
    Prune {
        /// The branch.
        axis: AxisKey,
        /// Place of the cut, as a share of its length; 0 (the default) removes all of it.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 1.0))]
        at: f64,
    },
    /// Cuts a branch off and grows another one in the room that it had. All else stays.
    Regrow {
        /// The branch.
        axis: AxisKey,
        /// Seed: another number gives another branch.
        #[serde(default)]
        seed: u64,
    },
    /// Adds a branch that was drawn in space.
    SketchBranch {
        /// The branch that it grows from.
        bearer: AxisKey,
        /// Place on the bearer, as a share of its length; without it, the place nearest to the start of the line.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        at: Option<f64>,
        /// Its course, metres, at least two points; it is joined to its bearer.
        #[schemars(with = "Vec<[f64; 3]>", extend("x-unit" = "m"))]
        points: Vec<DVec3>,
        /// Number of twigs on it, relative to the plant's habit, 0 (none) to 4; default 1.
        #[serde(default = "one")]
        #[schemars(range(min = 0.0, max = 4.0))]
        twigs: f64,
        /// Seed: another number gives other twigs.
        #[serde(default)]
        seed: u64,
        /// Makes it on the other side of a plane, too. Default none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        mirror: Option<Mirror>,
    },
    /// Lets branches grow along a stroke of a brush (the VR paper).
    Brush {
        /// The bearer of the new branches; without it, the branch nearest to the stroke's start.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        bearer: Option<AxisKey>,
        /// The stroke, metres, at least two points.
        #[schemars(with = "Vec<[f64; 3]>", extend("x-unit" = "m"))]
        points: Vec<DVec3>,
        /// Radius of the brush, metres, above 0: one number, or one for each point.
        #[schemars(extend("x-unit" = "m"))]
        radius_m: Vec<f64>,
        /// Density of the filling, 0.1 to 10: more markers, more branches; default 1.
        #[serde(default = "one")]
        #[schemars(range(min = 0.1, max = 10.0))]
        density: f64,
        /// Seed: another number gives other branches.
        #[serde(default)]
        seed: u64,
        /// Makes it on the other side of a plane, too. Default none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        mirror: Option<Mirror>,
    },
    /// Lets a shoot grow by itself, for as many rounds as a hand held on (the VR paper).
    Grow {
        /// Start of the shoot.
        from: GrowFrom,
        /// The side on which it leaves its bearer; without, the upper one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(with = "Option<[f64; 3]>")]
        towards: Option<DVec3>,
        /// Rounds of growth.
        #[schemars(range(min = 1, max = 300))]
        rounds: u32,
        /// Settings of growth from some round on, as a hand changed them; a field left out keeps its value, at first
        /// that of guided growth with the angles of the plant. Without strokes, at most 301.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        changes: Vec<GuidedChange>,
        /// Seed: another number gives other branches.
        #[serde(default)]
        seed: u64,
        /// Makes it on the other side of a plane, too. Default none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        mirror: Option<Mirror>,
    },
    /// Fills an outline that was drawn in a plane facing the viewer (the VR paper).
    Silhouette {
        /// The plane.
        #[serde(default)]
        plane: ViewPlane,
        /// The outline in the plane, metres, at least three points; the first is not repeated.
        #[schemars(with = "Vec<[f64; 2]>", extend("x-unit" = "m"))]
        outline: Vec<DVec2>,
        /// Density of the filling, 0.1 to 10; default 1.
        #[serde(default = "one")]
        #[schemars(range(min = 0.1, max = 10.0))]
        density: f64,
        /// Whether parts outside the outline are cut off. Default true.
        #[serde(default = "yes")]
        trim: bool,
        /// Seed: another number gives other branches.
        #[serde(default)]
        seed: u64,
        /// Fills the image of the outline on the other side of a plane, too. Default none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        mirror: Option<Mirror>,
    },
    /// Removes leaves, or adds some.
    LeafDensity {
        /// The region.
        region: LeafRegion,
        /// Share of the leaves that stay, 0 to 1; above 1, up to 4, the factor by which their number grows.
        #[schemars(range(min = 0.0, max = 4.0))]
        keep: f64,
        /// Seed: another number gives other leaves.
        #[serde(default)]
        seed: u64,
    },
}

/// Start of a shoot that grows by itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum GrowFrom {
    /// On a branch; at its tip, the shoot continues the branch.
    Branch {
        /// The branch.
        axis: AxisKey,
        /// Place on it, as a share of its length.
        at: f64,
    },
    /// On the ground, metres: another stem of the plant.
    Ground(#[schemars(with = "[f64; 3]")] DVec3),
}

/// Most rounds for which a shoot grows by itself.
pub const MOST_ROUNDS: u32 = 300;

/// Most points of a stroke or outline.
pub const MOST_POINTS: usize = 20_000;

/// Largest coordinate of an edit, metres.
const FAR: f64 = 1e6;

impl HandEdit {
    /// Returns the word of its kind, as files write it: `rotate`, `move`, `prune`, ...
    pub const fn word(&self) -> &'static str {
        match self {
            Self::Rotate { .. } => "rotate",
            Self::Move { .. } => "move",
            Self::Copy { .. } => "copy",
            Self::Prune { .. } => "prune",
            Self::Regrow { .. } => "regrow",
            Self::SketchBranch { .. } => "sketch-branch",
            Self::Brush { .. } => "brush",
            Self::Grow { .. } => "grow",
            Self::Silhouette { .. } => "silhouette",
            Self::LeafDensity { .. } => "leaf-density",
        }
    }

    /// Returns the plane in which it is mirrored, if any.
    pub(crate) const fn mirror(&self) -> Option<Mirror> {
        match self {
            Self::SketchBranch { mirror, .. }
            | Self::Brush { mirror, .. }
            | Self::Grow { mirror, .. }
            | Self::Silhouette { mirror, .. } => *mirror,
            _ => None,
        }
    }

    /// Checks that all its numbers are usable and that it is not too large, before it is kept.
    ///
    /// Not guaranteed: that it can be done; that depends on the plant.
    ///
    /// # Errors
    /// [`Why::BadNumber`] and [`Why::TooLong`].
    ///
    /// ```
    /// use shape::{AxisKey, HandEdit};
    /// let cut = |at| HandEdit::Prune { axis: AxisKey::Path(vec![0]), at };
    /// assert!(cut(0.5).check().is_ok() && cut(f64::NAN).check().is_err() && cut(1.5).check().is_err());
    /// ```
    pub fn check(&self) -> Result<(), Why> {
        if let Some(mirror) = self.mirror() {
            mirror.axes()?;
            near("mirror", &[mirror.point])?;
        }
        match self {
            Self::Rotate { axis, turn } => {
                axis.check()?;
                turn.quat().map(|_| ())
            }
            Self::Move { axis, to, turn } => {
                axis.check()?;
                turn.map_or(Ok(()), |turn| turn.quat().map(|_| ()))?;
                to.check()
            }
            Self::Copy { axis, to } => {
                axis.check()?;
                to.check()
            }
            Self::Prune { axis, at } => {
                axis.check()?;
                within("at", *at, 0.0, 1.0)
            }
            Self::Regrow { axis, .. } => axis.check(),
            Self::SketchBranch { bearer, at, points, twigs, .. } => {
                bearer.check()?;
                within("at", at.unwrap_or(0.0), 0.0, 1.0)?;
                within("twigs", *twigs, 0.0, 4.0)?;
                near("points", points)
            }
            Self::Brush { bearer, points, radius_m, density, .. } => {
                bearer.as_ref().map_or(Ok(()), AxisKey::check)?;
                within("density", *density, 0.1, 10.0)?;
                short(radius_m.len())?;
                radius_m.iter().try_for_each(|r| within("radius_m", *r, 0.0, FAR))?;
                near("points", points)
            }
            Self::Grow { from, towards, rounds, changes, .. } => {
                match from {
                    GrowFrom::Branch { axis, at } => {
                        axis.check()?;
                        within("at", *at, 0.0, 1.0)?;
                    }
                    GrowFrom::Ground(foot) => near("ground", &[*foot])?,
                }
                near("towards", towards.as_slice())?;
                within("rounds", f64::from(*rounds), 1.0, f64::from(MOST_ROUNDS))?;
                within("changes", changes.len() as f64, 0.0, f64::from(MOST_ROUNDS + 1))?;
                let rising = changes.windows(2).all(|w| w[0].round <= w[1].round);
                let sound = rising && changes.iter().all(|c| c.strokes.is_none() && c.is_sound());
                if sound { Ok(()) } else { Err(Why::BadNumber { field: "changes" }) }
            }
            Self::Silhouette { plane, outline, density, .. } => {
                plane.axes()?;
                near("plane", &[plane.origin])?;
                within("density", *density, 0.1, 10.0)?;
                short(outline.len())?;
                let bad = outline.iter().any(|p| !p.is_finite() || p.abs().max_element() > FAR);
                if bad { Err(Why::BadNumber { field: "outline" }) } else { Ok(()) }
            }
            Self::LeafDensity { region, keep, .. } => {
                within("keep", *keep, 0.0, 4.0)?;
                match region {
                    LeafRegion::All => Ok(()),
                    LeafRegion::Branch(axis) => axis.check(),
                    LeafRegion::Stroke { points, radius_m } => {
                        within("radius_m", *radius_m, 0.0, FAR)?;
                        near("points", points)
                    }
                }
            }
        }
    }
}

fn within(field: &'static str, value: f64, low: f64, high: f64) -> Result<(), Why> {
    if (low..=high).contains(&value) { Ok(()) } else { Err(Why::BadNumber { field }) }
}

fn short(count: usize) -> Result<(), Why> {
    if count > MOST_POINTS { Err(Why::TooLong { most: MOST_POINTS }) } else { Ok(()) }
}

fn near(field: &'static str, points: &[DVec3]) -> Result<(), Why> {
    short(points.len())?;
    // The maximum ignores NaN, so NaN is tested separately.
    let bad = points.iter().any(|p| !p.is_finite() || p.abs().max_element() > FAR);
    if bad { Err(Why::BadNumber { field }) } else { Ok(()) }
}

const fn one() -> f64 {
    1.0
}

const fn yes() -> bool {
    true
}

/// A rotation about an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Turn {
    /// The axis, of any length above 0; right-handed.
    #[schemars(with = "[f64; 3]")]
    pub about: DVec3,
    /// The angle.
    #[schemars(extend("x-unit" = "deg"))]
    pub degrees: f64,
}

impl Turn {
    /// Returns it as a unit quaternion.
    ///
    /// # Errors
    /// [`Why::BadNumber`] for an axis without length or numbers that are not finite.
    pub fn quat(self) -> Result<DQuat, Why> {
        let about = self.about.try_normalize().filter(|a| a.is_finite());
        let about = about.ok_or(Why::BadNumber { field: "turn.about" })?;
        if !self.degrees.is_finite() || self.degrees.abs() > 1e6 {
            return Err(Why::BadNumber { field: "turn.degrees" });
        }
        Ok(base::turn::about(about, self.degrees * (PI / 180.0)).normalize())
    }

    /// Returns the rotation of a unit quaternion.
    pub fn from_quat(quat: DQuat) -> Self {
        let v = DVec3::new(quat.x, quat.y, quat.z);
        let angle = 2.0 * base::ops::atan2(v.length(), quat.w);
        Self { about: v.try_normalize().unwrap_or(DVec3::Y), degrees: angle * (180.0 / PI) }
    }
}

/// Destination of a moved branch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Destination {
    /// Along its bearer by this distance in metres, towards the tip if positive; it keeps its angle to the bearer.
    SlideM(f64),
    /// Onto a place of another branch, or of its own bearer; it keeps its angle to its bearer.
    Place {
        /// The new bearer.
        axis: AxisKey,
        /// Place on the bearer, as a share of its length.
        at: f64,
    },
    /// By a vector, metres: a branch on the ground is set elsewhere, a borne branch slides to the place of its bearer
    /// nearest to the new base.
    ByM(#[schemars(with = "[f64; 3]")] DVec3),
}

impl Destination {
    fn check(&self) -> Result<(), Why> {
        match self {
            Self::SlideM(by) => within("slide-m", *by, -FAR, FAR),
            Self::Place { axis, at } => {
                axis.check()?;
                within("at", *at, 0.0, 1.0)
            }
            Self::ByM(by) => near("by-m", &[*by]),
        }
    }
}

/// A plane in which an outline is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ViewPlane {
    /// Position of the point (0, 0) of the outline, metres.
    #[schemars(with = "[f64; 3]", extend("x-unit" = "m"))]
    pub origin: DVec3,
    /// Direction to the viewer's right.
    #[schemars(with = "[f64; 3]")]
    pub right: DVec3,
    /// Direction upwards as the viewer sees it; made perpendicular to `right`.
    #[schemars(with = "[f64; 3]")]
    pub up: DVec3,
}

impl Default for ViewPlane {
    /// Returns the drawing plane seen from +Z.
    fn default() -> Self {
        Self { origin: DVec3::ZERO, right: DVec3::X, up: DVec3::Y }
    }
}

impl ViewPlane {
    /// Returns the plane through a point, seen from the side that `towards` points to, upright along `up`; any lengths
    /// above 0.
    ///
    /// If `up` is parallel to `towards`, any direction across is upright. `None` for numbers that are not finite, or
    /// without a direction.
    ///
    /// ```
    /// use glam::DVec3;
    /// use shape::ViewPlane;
    /// let plane = ViewPlane::facing(DVec3::ONE, DVec3::X * 2.0, DVec3::Y).expect("a direction");
    /// assert_eq!((plane.origin, plane.right, plane.up), (DVec3::ONE, DVec3::NEG_Z, DVec3::Y));
    /// ```
    pub fn facing(point: DVec3, towards: DVec3, up: DVec3) -> Option<Self> {
        let towards = towards.try_normalize().filter(|_| point.is_finite())?;
        let right = up.cross(towards);
        let right =
            if right.is_finite() && right.length() > 1e-3 * up.length() { right } else { DVec3::ZERO };
        let right = right.try_normalize().unwrap_or_else(|| towards.any_orthonormal_vector());
        Some(Self { origin: point, right, up: towards.cross(right) })
    }

    /// Returns `right`, `up` and the direction to the viewer, orthonormal.
    ///
    /// # Errors
    /// [`Why::BadNumber`]: directions without length, parallel or not finite, or an origin that is not finite.
    pub fn axes(&self) -> Result<[DVec3; 3], Why> {
        let fault = Why::BadNumber { field: "plane" };
        let usable = self.origin.is_finite() && self.right.is_finite() && self.up.is_finite();
        let right = self.right.try_normalize().filter(|_| usable).ok_or(fault)?;
        let towards = right.cross(self.up).try_normalize().ok_or(fault)?;
        Ok([right, towards.cross(right), towards])
    }
}

/// A plane of symmetry: an edit on one side is mirrored to the other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mirror {
    /// A point on the plane, metres.
    #[schemars(with = "[f64; 3]", extend("x-unit" = "m"))]
    pub point: DVec3,
    /// Normal of the plane, of any length above 0.
    #[schemars(with = "[f64; 3]")]
    pub normal: DVec3,
}

impl Mirror {
    /// Returns the upright plane through the foot of a plant's longest stem that separates the viewer's hands: `right`
    /// points to the viewer's right.
    ///
    /// `None` for a plant without a stem, or a `right` without a level part.
    ///
    /// ```
    /// use glam::DVec3;
    /// use plant::{AxisKind, Plant};
    /// use shape::Mirror;
    /// let mut p = Plant::default();
    /// p.add_axis(AxisKind::Branch, None, 1, &[DVec3::X, DVec3::X + DVec3::Y], None);
    /// let mirror = Mirror::between_hands(&p, DVec3::new(0.0, 0.5, -2.0)).ok_or("a stem")?;
    /// assert_eq!((mirror.point, mirror.normal), (DVec3::X, DVec3::NEG_Z));
    /// # Ok::<(), &str>(())
    /// ```
    pub fn between_hands(plant: &Plant, right: DVec3) -> Option<Self> {
        let normal = right.with_y(0.0).try_normalize()?;
        let stems = plant.axes.iter().enumerate().filter(|(_, a)| a.bearer.is_none());
        let stems = stems.filter(|(_, a)| a.kind.is_shoot());
        let lines = stems.map(|(i, _)| plant.axis_points(AxisId::new(i)));
        let long = lines.map(|line| (geom::polyline_length3(line), line));
        let (_, line) = long.reduce(|a, b| if b.0 > a.0 { b } else { a })?;
        let point = *line.first().filter(|p| p.is_finite())?;
        Some(Self { point, normal })
    }

    /// Returns the mirror image of a point.
    pub(crate) fn image(through: DVec3, normal: DVec3, p: DVec3) -> DVec3 {
        p - normal * (2.0 * (p - through).dot(normal))
    }

    /// Returns a point of the plane and its unit normal.
    pub(crate) fn axes(&self) -> Result<(DVec3, DVec3), Why> {
        let normal = self.normal.try_normalize().filter(|n| n.is_finite() && self.point.is_finite());
        Ok((self.point, normal.ok_or(Why::BadNumber { field: "mirror" })?))
    }
}

/// Region of leaves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub enum LeafRegion {
    /// All leaves.
    All,
    /// The leaves of a branch and of all that it bears.
    Branch(AxisKey),
    /// The leaves within a stroke.
    Stroke {
        /// The stroke, metres, one point or more.
        #[schemars(with = "Vec<[f64; 3]>", extend("x-unit" = "m"))]
        points: Vec<DVec3>,
        /// Its radius, metres, above 0.
        #[schemars(extend("x-unit" = "m"))]
        radius_m: f64,
    },
}

/// An edits file: [`EDITS_SCHEMA`] and the edits in the order in which they are applied.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EditsFile {
    /// Always [`EDITS_SCHEMA`].
    pub schema: String,
    /// The edits.
    pub edits: Vec<HandEdit>,
}

/// The value of [`EditsFile::schema`].
pub const EDITS_SCHEMA: &str = "burgeon.edits/1";

impl EditsFile {
    /// Makes a file of edits.
    pub fn new(edits: Vec<HandEdit>) -> Self {
        Self { schema: EDITS_SCHEMA.into(), edits }
    }
}
