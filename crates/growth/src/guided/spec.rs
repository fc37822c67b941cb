//! Settings of guided growth.

use glam::DVec3;
use plant::Phyllotaxis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{usable, within};
use crate::{Arrangement, Envelope, GrowthError, Tropism};

/// A stroke of a brush in space: buds find room only inside it, and are drawn along it (the VR paper).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BrushStroke {
    /// Its course, metres, at least two points.
    #[schemars(with = "Vec<[f64; 3]>", extend("x-unit" = "m"))]
    pub points: Vec<DVec3>,
    /// Radius, metres, above 0: one number, or one for each point.
    #[schemars(inner(range(min = 1e-6, max = 1e6)), extend("x-unit" = "m"))]
    pub radius_m: Vec<f64>,
    /// Pull along the stroke, `k_s`, 0 to 10; default 1.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub pull: f64,
}

const fn one() -> f64 {
    1.0
}

/// Guided growth: each bud makes its own markers, and others' markers push it away (the VR paper). Metres, degrees.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct GuidedSpec {
    /// Rounds of growth, 0 to 1000, default 14.
    #[schemars(range(min = 0, max = 1000))]
    pub rounds: u32,
    /// Length of an internode at vigour 1, above 0, default 0.25.
    #[schemars(range(min = 0.0001, max = 1000.0), extend("x-unit" = "m"))]
    pub internode_m: f64,
    /// The space of the crown, relative to the root; default none: growth ends with its rounds.
    pub envelope: Option<Envelope>,
    /// Strokes that guide growth; with any, buds grow only inside them. Default none.
    pub strokes: Vec<BrushStroke>,
    /// Markers of one bud in one round, N, 4 to 10000, default 60. The paper states about 1300: more markers only make
    /// the course of a shoot straighter, by 34 degrees over the root of N.
    #[schemars(range(min = 4, max = 10000))]
    pub markers: u32,
    /// Occupancy radius, in internodes, 0 to 100, default 2: there are no markers nearer to a bud.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub near: f64,
    /// Perception radius, in internodes, above `near` and at most 100, default 5.
    #[schemars(range(min = 0.01, max = 100.0))]
    pub far: f64,
    /// Half the opening of the perception cone, 1 to 180 degrees, default 45.
    #[schemars(range(min = 1.0, max = 180.0), extend("x-unit" = "deg"))]
    pub half_angle_deg: f64,
    /// Strength of the repulsion by others' markers, `k_r`, 0 to 10, default 1.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub repulsion: f64,
    /// Weight and light, `k_g g`; relative to the pull of free space. Default 0.12 upwards.
    pub tropisms: Vec<Tropism>,
    /// Vigour per unit of free space, above 0 and at most 100, default 2.
    #[schemars(range(min = 1e-6, max = 100.0))]
    pub alpha: f64,
    /// Share of the main axis at a fork, 0 to 1, default 0.54.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub lambda: f64,
    /// Arrangement of the buds, default a golden spiral.
    pub arrangement: Arrangement,
    /// Angle between a shoot and its lateral buds, 0 to 180 degrees, default 55.
    #[schemars(range(min = 0.0, max = 180.0), extend("x-unit" = "deg"))]
    pub branch_angle_deg: f64,
    /// Standard deviation of that angle and of the azimuths, 0 to 60 degrees, default 6.
    #[schemars(range(min = 0.0, max = 60.0), extend("x-unit" = "deg"))]
    pub jitter_deg: f64,
    /// Most internodes of one shoot in one round, 1 to 100, default 3.
    #[schemars(range(min = 1, max = 100))]
    pub most_per_shoot: u32,
    /// Most internodes of stopped twigs that are shed at the end, 0 (none) to 1000; default 1.
    #[schemars(range(min = 0, max = 1000))]
    pub shed_up_to: u32,
    /// Most joints, default 1 million.
    #[schemars(range(min = 1, max = 2_147_483_648_u64))]
    pub max_joints: u32,
    /// Changes of numbers from some round on, in ascending order of rounds: the record of the user's changes while the
    /// tree grew. Default none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<GuidedChange>,
}

/// Numbers of [`GuidedSpec`] that change while a tree grows; numbers that are left out stay.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct GuidedChange {
    /// The first round with these numbers, from 0, at most 1000.
    #[schemars(range(min = 0, max = 1000))]
    pub round: u32,
    /// Vigour per unit of free space, above 0 and at most 100.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-6, max = 100.0))]
    pub alpha: Option<f64>,
    /// Share of the main axis at a fork (apical control), 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub lambda: Option<f64>,
    /// Angle between a shoot and its lateral buds, 0 to 180 degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 180.0), extend("x-unit" = "deg"))]
    pub branch_angle_deg: Option<f64>,
    /// Strength of the repulsion by others' markers, 0 to 10.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub repulsion: Option<f64>,
    /// Markers of one bud in one round, 4 to 10000.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 4, max = 10000))]
    pub markers: Option<u32>,
    /// Weight and light.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tropisms: Option<Vec<Tropism>>,
    /// All guiding strokes from then on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strokes: Option<Vec<BrushStroke>>,
}

impl GuidedChange {
    /// Whether its numbers are within their ranges, with the defaults of all others.
    pub fn is_sound(&self) -> bool {
        GuidedSpec { changes: vec![self.clone()], ..GuidedSpec::default() }.check().is_ok()
    }

    /// Returns the numbers after this change.
    pub(super) fn applied(&self, spec: &GuidedSpec) -> GuidedSpec {
        let Self { round: _, alpha, lambda, branch_angle_deg, repulsion, markers, tropisms, strokes } = self;
        GuidedSpec {
            alpha: alpha.unwrap_or(spec.alpha),
            lambda: lambda.unwrap_or(spec.lambda),
            branch_angle_deg: branch_angle_deg.unwrap_or(spec.branch_angle_deg),
            repulsion: repulsion.unwrap_or(spec.repulsion),
            markers: markers.unwrap_or(spec.markers),
            tropisms: tropisms.as_ref().unwrap_or(&spec.tropisms).clone(),
            strokes: strokes.as_ref().unwrap_or(&spec.strokes).clone(),
            ..spec.clone()
        }
    }
}

spec::schemas!(GuidedSpec => crate::TreeSpec, "/$defs/Method/oneOf/4");

impl Default for GuidedSpec {
    fn default() -> Self {
        Self {
            rounds: 14,
            internode_m: 0.25,
            envelope: None,
            strokes: Vec::new(),
            markers: 60,
            near: 2.0,
            far: 5.0,
            half_angle_deg: 45.0,
            repulsion: 1.0,
            tropisms: vec![Tropism { strength: 0.12, ..Tropism::UPWARDS }],
            alpha: 2.0,
            lambda: 0.54,
            arrangement: Arrangement::default(),
            branch_angle_deg: 55.0,
            jitter_deg: 6.0,
            most_per_shoot: 3,
            shed_up_to: 1,
            max_joints: 1_000_000,
            changes: Vec::new(),
        }
    }
}

impl GuidedSpec {
    /// Returns the settings for a whole tree whose crown fills an envelope: some 10,000 internodes, whatever its size.
    ///
    /// The default is a young shoot's: its internodes are long and its rounds few, so that a user can follow it. Here
    /// internodes are a thirty-eighth of the envelope's mean extent (a ninetieth of its longest, if that is more),
    /// rounds enough to reach its ends, and vigour, pull and markers such that a crown is full and its leader upright.
    /// An invalid envelope keeps the default numbers; growth then reports its fault.
    pub fn from_crown(envelope: Envelope) -> Self {
        let envelope = envelope.whole();
        let size = envelope.prepare().map_or(DVec3::ZERO, |region| {
            let (lo, hi) = region.bounds();
            hi - lo
        });
        let plain = Self { envelope: Some(envelope), ..Self::default() };
        // Slender crowns have longer internodes for their volume: otherwise a leader takes hundreds of rounds.
        let internode_m = (base::ops::cbrt(size.x * size.y * size.z) / 38.0).max(size.max_element() / 90.0);
        if !(1e-4..=1e3).contains(&internode_m) {
            return plain;
        }
        // A leader makes about two internodes per round, one if it is crowded.
        let rounds = (0.8 * size.max_element() / internode_m).clamp(36.0, 72.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "36 to 72")]
        Self {
            internode_m,
            rounds: rounds as u32,
            alpha: 4.0,
            lambda: 0.56,
            markers: 60,
            tropisms: vec![Tropism { strength: 0.2, ..Tropism::UPWARDS }],
            ..plain
        }
    }
}

/// Values derived from checked numbers.
#[derive(Clone, Debug)]
pub(super) struct Numbers {
    pub(super) phyllotaxis: Phyllotaxis,
    pub(super) pull: DVec3,
}

impl GuidedSpec {
    pub(super) fn check(&self) -> Result<Numbers, GrowthError> {
        spec::check(self)?;
        let numbers = self.check_now()?;
        let mut later = Self { changes: Vec::new(), ..self.clone() };
        let mut round = 0;
        for change in &self.changes {
            if change.round < round {
                let range = "in ascending order";
                return Err(GrowthError::Field { field: "changes.round", range, value: change.round.into() });
            }
            round = change.round;
            later = change.applied(&later);
            later.check_now()?;
        }
        Ok(numbers)
    }

    /// Checks conditions beyond single ranges, on the numbers of one round.
    fn check_now(&self) -> Result<Numbers, GrowthError> {
        within("far", self.far, self.near, 100.0, "above `near` and at most 100 internodes")?;
        for stroke in &self.strokes {
            let points = stroke.points.len();
            within("strokes.points", points as f64, 2.0, 1e6, "2 to 1 million points")?;
            if let Some(bad) = stroke.points.iter().find(|p| !usable(**p)) {
                let range = "finite points within 1e6 m";
                return Err(GrowthError::Field { field: "strokes.points", range, value: bad.length() });
            }
            let radii = stroke.radius_m.len();
            if radii != 1 && radii != points {
                let range = "one number, or one for each point";
                return Err(GrowthError::Field { field: "strokes.radius_m", range, value: radii as f64 });
            }
        }
        Ok(Numbers { phyllotaxis: self.arrangement.phyllotaxis()?, pull: Tropism::sum(&self.tropisms)? })
    }
}
