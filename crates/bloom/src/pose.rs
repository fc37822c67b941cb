//! Motion of the plant and its organs between scans of several days, apart from their growth.

use base::Run;
use geom::{best_rotation, extent};
use glam::{DQuat, DVec3};

use crate::register::register_organ;
use crate::thin::thin;
use crate::{
    BloomError, GrowthLaw, Motion, MotionSpec, OrganPoints, RegisterSpec, ScanOrgan, ShapeError, Stage,
    Weights, register,
};

/// A rotation about a point and a translation: `p -> to + turn * (p - from)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    /// Centre of the rotation: for a plant its foot, for an organ its joint on the bearer. Metres.
    pub from: DVec3,
    /// New position of that point.
    pub to: DVec3,
    /// The rotation.
    pub turn: DQuat,
}

impl RigidMotion {
    /// No motion.
    pub const REST: Self = Self { from: DVec3::ZERO, to: DVec3::ZERO, turn: DQuat::IDENTITY };

    /// Returns the moved point.
    pub fn apply(&self, p: DVec3) -> DVec3 {
        self.to + self.turn * (p - self.from)
    }

    /// Returns the inverse motion.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self { from: self.to, to: self.from, turn: self.turn.inverse() }
    }

    /// Returns a share of the motion: none at 0, all of it at 1, the rotation the shorter way round.
    #[must_use]
    pub fn part(&self, share: f64) -> Self {
        Self { from: self.from, to: self.from.lerp(self.to, share), turn: base::turn::part(self.turn, share) }
    }

    /// Returns the angle of the rotation, 0 to pi.
    pub fn angle(&self) -> f64 {
        2.0 * base::ops::acos_clamped(self.turn.w.abs())
    }

    /// Returns the unit axis of the rotation; +Y if there is none.
    pub fn axis(&self) -> DVec3 {
        let axis = DVec3::new(self.turn.x, self.turn.y, self.turn.z);
        (if self.turn.w < 0.0 { -axis } else { axis }).try_normalize().unwrap_or(DVec3::Y)
    }

    /// Returns the displacement of the centre of the rotation, metres.
    pub fn shift(&self) -> f64 {
        self.from.distance(self.to)
    }

    /// Returns the rotation about the vertical and the translation that bring points nearest to their partners: the
    /// motion of a pot, which stands upright on every day.
    fn upright(pairs: &[Places], from: DVec3) -> Self {
        let n = pairs.len().max(1) as f64;
        let a = pairs.iter().map(|p| p.0).sum::<DVec3>() / n;
        let b = pairs.iter().map(|p| p.1).sum::<DVec3>() / n;
        let (mut sin, mut cos) = (0.0, 0.0);
        for (p, q) in pairs.iter().map(|&(p, q)| (p - a, q - b)) {
            sin += p.z * q.x - p.x * q.z;
            cos += p.x * q.x + p.z * q.z;
        }
        let turn = base::turn::about(DVec3::Y, base::ops::atan2(sin, cos));
        Self { from, to: b + turn * (from - a), turn }
    }

    /// Returns the motion that brings points nearest to their partners (least squares; Horn 1987), about the point
    /// `from`.
    pub(crate) fn from_pairs(pairs: &[Places], from: DVec3) -> Self {
        let n = pairs.len().max(1) as f64;
        let a = pairs.iter().map(|p| p.0).sum::<DVec3>() / n;
        let b = pairs.iter().map(|p| p.1).sum::<DVec3>() / n;
        let turn = best_rotation(pairs.iter().map(|&(p, q)| (p - a, q - b)));
        Self { from, to: b + turn * (from - a), turn }
    }
}

/// Change of one organ from one scan to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct OrganStep {
    /// Its name.
    pub organ: String,
    /// Its motion about its joint, in the frame of the plant.
    pub pose: RigidMotion,
    /// Growth in size: the factor of all its lengths, 1 for none.
    pub scale: f64,
    /// Growth in shape: mean distance that remains after motion and size, metres.
    pub shape_m: f64,
    /// Residual of the registration between the later scan and the carried organ.
    pub residual: ShapeError,
}

/// Changes between two consecutive scans.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseStep {
    /// Day of the earlier scan.
    pub from_day: f64,
    /// Day of the later one.
    pub to_day: f64,
    /// Motion of the whole plant about its foot, in the coordinates of the scanner; at rest if fewer than two organs
    /// exist on both days, as the plant's motion is then indistinguishable from the organ's.
    pub plant: RigidMotion,
    /// Every organ that exists on both days.
    pub organs: Vec<OrganStep>,
    /// Organs that exist on the later day only.
    pub appeared: Vec<String>,
    /// Organs that exist on the earlier day only.
    pub vanished: Vec<String>,
}

/// Rotations between two scans beyond which organs may have been confused.
struct Believable {
    /// Limit for the pot, which is seldom turned by more; leaves are not matched beyond it ([`crate::match_organs`]).
    /// Degrees.
    plant_deg: f64,
    /// Limit for one organ by itself, in the frame of the plant. A seed leaf swings by 34 degrees in a night. Degrees.
    organ_deg: f64,
    /// Limit that half of the organs exceed, each by itself. Degrees.
    most_organs_deg: f64,
}

const BELIEVABLE: Believable = Believable { plant_deg: 60.0, organ_deg: 60.0, most_organs_deg: 40.0 };

/// Reason why organs of two scans may have been confused.
#[derive(Clone, Debug, PartialEq)]
pub enum PoseDoubt {
    /// The whole plant turned far.
    Plant {
        /// Angle, degrees.
        turn_deg: f64,
    },
    /// Relative to the plant, organs turned far, each in its own way.
    Organs {
        /// The one that turned farthest.
        organ: String,
        /// Angle, degrees.
        turn_deg: f64,
    },
}

impl PoseStep {
    /// Returns a doubt if organs may have been confused between the two scans, or the plant was turned far enough to
    /// cause that; `None` if fewer than two organs exist on both days, as a single one may turn freely.
    pub fn doubt(&self) -> Option<PoseDoubt> {
        if self.organs.len() < 2 {
            return None;
        }
        let degrees = |turn: &RigidMotion| turn.angle() * 180.0 / base::ops::PI;
        let turns = || self.organs.iter().map(|o| degrees(&o.pose));
        let far = turns().filter(|&turn| turn > BELIEVABLE.most_organs_deg).count();
        let farthest = self.organs.iter().max_by(|a, b| a.pose.angle().total_cmp(&b.pose.angle()))?;
        let turn_deg = degrees(&farthest.pose);
        if turn_deg > BELIEVABLE.organ_deg || 2 * far > self.organs.len() {
            return Some(PoseDoubt::Organs { organ: farthest.organ.clone(), turn_deg });
        }
        let turn_deg = degrees(&self.plant);
        (turn_deg > BELIEVABLE.plant_deg).then_some(PoseDoubt::Plant { turn_deg })
    }
}

/// Scans in the frame of the plant, and the pose of the plant on each day.
#[derive(Clone, Debug)]
pub struct Settled {
    /// The stages in the frame of the plant: that of the first scan.
    pub stages: Vec<Stage>,
    /// Changes from each stage to the next.
    pub steps: Vec<PoseStep>,
    /// Motion from the plant's frame to the scanner's, one per stage.
    poses: Vec<RigidMotion>,
}

/// Positions of a point on one day and on the next.
type Places = (DVec3, DVec3);

/// Points of an organ for the estimate of its pose: more change no printed figure.
const SAMPLE: usize = 1500;

/// Removes the motion of the whole plant between scans: articulation and growth remain.
///
/// Organs of the same name are registered from day to day. The rigid motion that brings the carried points nearest to
/// their partners, all organs together, is the plant's; the same for one organ alone, in the plant's frame, is the
/// organ's. Cost: a registration for each organ and step.
///
/// # Errors
/// [`BloomError::TooFew`] for an organ below 8 points, [`BloomError::Cancelled`].
pub fn settle(stages: &[Stage], spec: &RegisterSpec, run: &Run<'_>) -> Result<Settled, BloomError> {
    let mut out = Settled::unmoved(stages);
    for k in 1..stages.len() {
        let (a, b) = (&stages[k - 1], &stages[k]);
        let mut found: Vec<(&ScanOrgan, Vec<Places>, ShapeError)> = Vec::new();
        for organ in &a.organs {
            let Some(next) = b.organs.iter().find(|o| o.name == organ.name) else { continue };
            let fit = register_organ(organ, (&organ.points, organ.base), next, spec, run)?;
            let rows = thin(&organ.points, SAMPLE);
            let points: Vec<DVec3> = rows.into_iter().map(|i| organ.points[i as usize]).collect();
            let moved = Weights::new(&fit.obb, spec.counts, &points)?.apply(&fit.last, run)?;
            found.push((organ, points.into_iter().zip(moved).collect(), fit.residual));
        }
        let foot = a.organs.first().map_or(DVec3::ZERO, |o| o.base);
        let all: Vec<Places> = found.iter().flat_map(|f| f.1.iter().copied()).collect();
        let plant = if found.len() < 2 { RigidMotion::REST } else { RigidMotion::upright(&all, foot) };
        let back = plant.inverse();
        let organs = found.iter().map(|(organ, pairs, left)| {
            let pairs: Vec<Places> = pairs.iter().map(|&(p, q)| (p, back.apply(q))).collect();
            organ_step(organ, &pairs, *left)
        });
        let names = |of: &Stage, other: &Stage| {
            let lost = of.organs.iter().filter(|o| other.organs.iter().all(|p| p.name != o.name));
            lost.map(|o| o.name.clone()).collect::<Vec<String>>()
        };
        out.steps.push(PoseStep {
            from_day: a.day,
            to_day: b.day,
            plant,
            organs: organs.collect(),
            appeared: names(b, a),
            vanished: names(a, b),
        });
        let before = out.poses[k - 1];
        // First to the scanner's frame on the day before, then further.
        let origin = before.inverse().apply(plant.from);
        out.poses[k] =
            RigidMotion { from: origin, to: plant.to, turn: (plant.turn * before.turn).normalize() };
        if out.poses[k] == RigidMotion::REST {
            // Keeps the same bits.
            continue;
        }
        let settle = out.poses[k].inverse();
        for organ in &mut out.stages[k].organs {
            organ.points.iter_mut().for_each(|p| *p = settle.apply(*p));
            organ.base = settle.apply(organ.base);
            organ.tip = settle.apply(organ.tip);
        }
    }
    Ok(out)
}

fn organ_step(organ: &ScanOrgan, pairs: &[Places], residual: ShapeError) -> OrganStep {
    let mut pose = RigidMotion::from_pairs(pairs, organ.base);
    if let Some(along) = register::rod(pairs) {
        // The roll of a stem about its axis is not observable.
        pose.turn = base::turn::between(along, (pose.turn * along).normalize_or(along));
    }
    let n = pairs.len().max(1) as f64;
    let a = pairs.iter().map(|p| p.0).sum::<DVec3>() / n;
    let b = pairs.iter().map(|p| p.1).sum::<DVec3>() / n;
    let dot: f64 = pairs.iter().map(|&(p, q)| (pose.turn * (p - a)).dot(q - b)).sum();
    let square: f64 = pairs.iter().map(|p| p.0.distance_squared(a)).sum();
    let scale = if square > 0.0 && dot > 0.0 { dot / square } else { 1.0 };
    let left = pairs.iter().map(|&(p, q)| (pose.turn * (p - a) * scale).distance(q - b));
    OrganStep { organ: organ.name.clone(), pose, scale, shape_m: left.sum::<f64>() / n, residual }
}

impl Settled {
    /// Returns scans whose pose is not separated.
    pub(crate) fn unmoved(stages: &[Stage]) -> Self {
        Self { stages: stages.to_vec(), steps: vec![], poses: vec![RigidMotion::REST; stages.len()] }
    }

    /// Returns the motion from the plant's frame to the scanner's on a day in the count of the stages: between two
    /// scans a share of the motion from one to the next, proportional to time; before the first and after the last as
    /// on that day, as the next motion of a pot is unknown.
    pub fn pose(&self, day: f64) -> RigidMotion {
        let Some(k) = self.steps.iter().position(|s| day <= s.to_day) else {
            return self.poses.last().copied().unwrap_or(RigidMotion::REST);
        };
        let step = &self.steps[k];
        let share = ((day - step.from_day) / (step.to_day - step.from_day)).clamp(0.0, 1.0);
        let (before, on) = (self.poses[k], step.plant.part(share));
        let origin = before.inverse().apply(on.from);
        RigidMotion { from: origin, to: on.to, turn: (on.turn * before.turn).normalize() }
    }

    /// Returns the two stages around a day; for a day before or after all the two nearest.
    pub fn round(&self, day: f64) -> [usize; 2] {
        let last = self.stages.len().saturating_sub(1);
        let next = self.stages.iter().position(|s| day <= s.day).unwrap_or(last).clamp(1.min(last), last);
        [next.saturating_sub(1), next]
    }

    /// Returns the organs on a day in the count of the stages, in the frame of the plant: the points of both scans
    /// around the day, each carried there. Both are measurements of the same organs: together they fill gaps of one
    /// scan.
    ///
    /// An organ that is new in the later scan grows out of the older ones, its points no denser than they were scanned.
    /// Before the first and after the last scan the points of the nearest one continue as far as the law allows; at
    /// rest if it determines nothing.
    ///
    /// # Errors
    /// As [`Motion::new`].
    pub fn day(
        &self,
        law: &GrowthLaw,
        spec: &MotionSpec,
        day: f64,
        run: &Run<'_>,
    ) -> Result<Vec<OrganPoints>, BloomError> {
        let [i, j] = self.round(day);
        let (a, b) = (&self.stages[i], &self.stages[j]);
        let begin = self.stages.first().map_or(0.0, |s| s.day);
        let carried = |first: &Stage, last: &Stage| -> Result<Vec<OrganPoints>, BloomError> {
            let pair = [first.clone(), last.clone()];
            let motion = Motion::since(first.day - begin, &pair, law.clone(), *spec, run)?;
            let points = motion.points_on_day(day - first.day, run)?;
            let of = |((name, rows), colors): (&(String, core::ops::Range<usize>), _)| OrganPoints {
                name: name.clone(),
                points: points[rows.clone()].to_vec(),
                colors,
            };
            Ok(motion.organs.iter().zip(motion.colors(day - first.day)).map(of).collect())
        };
        let has = |s: &Stage, name: &str| s.organs.iter().any(|o| o.name == name);
        if day > b.day {
            return carried(b, a);
        }
        let mut out = carried(a, b)?;
        // Before its first scan nothing is known of a new organ.
        out.retain(|o| day > a.day || has(a, &o.name));
        if day < a.day {
            return Ok(out);
        }
        for organ in &mut out {
            let new = !has(a, &organ.name);
            if let Some(whole) = b.organs.iter().find(|o| new && o.name == organ.name) {
                let step = stride(&organ.points, &whole.points);
                organ.points = organ.points.iter().copied().step_by(step).collect();
                organ.colors = organ.colors.iter().copied().step_by(step).collect();
            }
        }
        let mut shared = b.clone();
        shared.organs.retain(|o| has(a, &o.name));
        for more in carried(&shared, a)? {
            if let Some(organ) = out.iter_mut().find(|o| o.name == more.name && has(b, &more.name)) {
                organ.add(more);
            }
        }
        Ok(out)
    }
}

/// Returns the step at which points of a smaller copy of an organ are kept for the same density per area: the square of
/// its size ratio.
fn stride(small: &[DVec3], whole: &[DVec3]) -> usize {
    let share = (extent(small) / extent(whole).max(1e-12)).clamp(0.0, 1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to the number of points")]
    let step = (1.0 / (share * share).max(1e-9)).min(small.len() as f64).max(1.0) as usize;
    step
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(plant_deg: f64, organs_deg: &[f64]) -> PoseStep {
        let turned = |degrees: f64| RigidMotion {
            turn: base::turn::about(DVec3::Y, degrees * base::ops::PI / 180.0),
            ..RigidMotion::REST
        };
        let organ = |(k, &degrees): (usize, &f64)| OrganStep {
            organ: format!("leaf-{k}"),
            pose: turned(degrees),
            scale: 1.0,
            shape_m: 0.0,
            residual: ShapeError::default(),
        };
        PoseStep {
            from_day: 0.0,
            to_day: 1.0,
            plant: turned(plant_deg),
            organs: organs_deg.iter().enumerate().map(organ).collect(),
            appeared: vec![],
            vanished: vec![],
        }
    }

    #[test]
    fn a_plant_that_turned_far_or_organs_that_disagree_are_doubted() {
        assert_eq!(step(34.0, &[5.0, 29.0, 34.0]).doubt(), None, "leaves that swing by day and night");
        assert!(
            matches!(step(124.0, &[5.0, 9.0]).doubt(), Some(PoseDoubt::Plant { turn_deg }) if turn_deg > 123.0)
        );
        let far = step(34.0, &[3.0, 86.0, 18.0]).doubt();
        assert!(matches!(&far, Some(PoseDoubt::Organs { organ, .. }) if organ == "leaf-1"), "{far:?}");
        assert!(step(20.0, &[45.0, 51.0, 12.0]).doubt().is_some(), "most of them");
        assert_eq!(step(0.0, &[150.0]).doubt(), None, "a petal by itself turns as it likes");
    }
}
