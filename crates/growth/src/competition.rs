//! Competition for space in life cycles.
//!
//! `envelope -> N points -> skeleton -> K joints x M points -> finer skeleton -> ...` (Yang et al. 2019, section 3.1)

use base::{Counted, Draw, Report, Run, Seed, Warning};
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::colonize::{colonize_part, grow_frame, plant_roots};
use crate::envelope::crowns;
use crate::error::GrowthError;
use crate::{ColonizeSpec, Envelope, Obstacles, PointFate, Skeleton, Tropism, VariationSpec};

/// Trees after Yang et al. (2019). Lengths in metres; positions relative to the root.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CompetitionSpec {
    /// The space of the crown.
    pub envelope: Envelope,
    /// Space that the first cycle fills, if it differs: a narrow one makes a trunk with few limbs, on which later
    /// cycles grow the branches. Default none.
    pub first_envelope: Option<Envelope>,
    /// Share of the envelope left empty inside, 0 to 0.99, default 0.
    #[schemars(range(min = 0.0, max = 0.99))]
    pub hollow: f64,
    /// Points of the first cycle for each tree, N; 1 to 10 million, default 1500.
    #[schemars(range(min = 1, max = 10_000_000))]
    pub points: u32,
    /// Attraction distance `d_i`, default 0.9.
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
    pub attraction_m: f64,
    /// Absorption distance `d_k`, default 0.4.
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
    pub kill_m: f64,
    /// Step D, default half of `d_k` (the paper does not give it; Runions requires `d_k` of 2 D or more).
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
    pub step_m: Option<f64>,
    /// Life cycles, 1 to 20, default 2.
    #[schemars(range(min = 1, max = 20))]
    pub lifespan: u32,
    /// Share of the joints around which each later cycle puts points (K), 0 to 1, default 0.15.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub joints_share: f64,
    /// Points around each of them (M), 1 to 10000, default 40.
    #[schemars(range(min = 1, max = 10000))]
    pub points_per_joint: u32,
    /// Radius of the ball of those points; default `d_i`.
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
    pub ball_m: Option<f64>,
    /// Height of that ball over its width, 0 to 4: small values make flat tiers. Default 1.
    #[schemars(range(min = 0.0, max = 4.0))]
    pub ball_height: f64,
    /// Vertical distance between the tiers of branches that grow on what the first cycle made; default none: anywhere.
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "m"))]
    pub tier_m: Option<f64>,
    /// Factor on `d_i`, `d_k`, D and the ball from one cycle to the next, 0.1 to 1, default 1 (as in the paper).
    #[schemars(range(min = 0.1, max = 1.0))]
    pub shrink: f64,
    /// Other directions of growth. Default none.
    pub tropisms: Vec<Tropism>,
    /// Share of the last direction kept in each step, 0 to 10, default 0.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub inertia: f64,
    /// Most joints of all trees together, default 4 million.
    #[schemars(range(min = 1, max = 2_147_483_648_u64))]
    pub max_joints: u32,
}

spec::schemas!(CompetitionSpec => crate::TreeSpec, "/$defs/Method/oneOf/2");

impl Default for CompetitionSpec {
    fn default() -> Self {
        Self {
            envelope: Envelope::default(),
            first_envelope: None,
            hollow: 0.0,
            points: 1500,
            attraction_m: 0.9,
            kill_m: 0.4,
            step_m: None,
            lifespan: 2,
            joints_share: 0.15,
            points_per_joint: 40,
            ball_m: None,
            ball_height: 1.0,
            tier_m: None,
            shrink: 1.0,
            tropisms: Vec::new(),
            inertia: 0.0,
            max_joints: 4_000_000,
        }
    }
}

impl CompetitionSpec {
    /// Returns the pine of Table 1: N 2870, `d_i` 0.9 m, `d_k` 0.5 m, lifespan 2. Envelope, K and M are ours: the first
    /// cycle makes the stem, the second the side branches, as in the paper.
    pub fn pine() -> Self {
        Self {
            envelope: Envelope::Cone { base: DVec3::new(0.0, 1.2, 0.0), radius_m: 2.2, height_m: 7.3 },
            first_envelope: Some(Envelope::Cylinder {
                base: DVec3::new(0.0, 1.0, 0.0),
                radius_m: 0.12,
                height_m: 7.2,
            }),
            points: 2870,
            attraction_m: 0.9,
            kill_m: 0.5,
            lifespan: 2,
            step_m: Some(0.1),
            joints_share: 1.0,
            points_per_joint: 260,
            ball_m: Some(2.2),
            ball_height: 0.3,
            tier_m: Some(0.5),
            ..Self::default()
        }
    }

    /// Returns the Terminalia mantaly of Table 1: N 525, `d_i` 0.8 m, `d_k` 0.8 m, lifespan 3. Envelope, K and M are
    /// ours: flat tiers.
    pub fn terminalia() -> Self {
        Self {
            envelope: Envelope::Cylinder { base: DVec3::new(0.0, 1.8, 0.0), radius_m: 2.4, height_m: 5.0 },
            first_envelope: Some(Envelope::Cylinder {
                base: DVec3::new(0.0, 0.8, 0.0),
                radius_m: 0.1,
                height_m: 5.6,
            }),
            points: 525,
            attraction_m: 0.8,
            kill_m: 0.8,
            step_m: Some(0.2),
            lifespan: 3,
            joints_share: 1.0,
            points_per_joint: 150,
            ball_m: Some(2.2),
            ball_height: 0.12,
            tier_m: Some(1.1),
            shrink: 0.8,
            ..Self::default()
        }
    }

    /// Returns the Chinese fir of Table 1: N 1543, `d_i` 1.0 m, `d_k` 0.4 m, lifespan 3. Envelope, K and M are ours.
    pub fn chinese_fir() -> Self {
        Self {
            envelope: Envelope::Cone { base: DVec3::new(0.0, 1.0, 0.0), radius_m: 1.9, height_m: 10.0 },
            first_envelope: Some(Envelope::Cylinder {
                base: DVec3::new(0.0, 1.0, 0.0),
                radius_m: 0.1,
                height_m: 9.7,
            }),
            points: 1543,
            attraction_m: 1.0,
            kill_m: 0.4,
            lifespan: 3,
            step_m: Some(0.12),
            joints_share: 0.6,
            points_per_joint: 45,
            ball_m: Some(1.9),
            ball_height: 0.4,
            tier_m: Some(0.4),
            shrink: 0.6,
            tropisms: vec![Tropism { direction: DVec3::NEG_Y, strength: 0.15 }],
            ..Self::default()
        }
    }

    /// Returns the oak with which the paper compares methods (Table 2); all numbers are ours.
    pub fn oak() -> Self {
        Self {
            envelope: Envelope::Ellipsoid {
                centre: DVec3::new(0.0, 6.0, 0.0),
                radii_m: DVec3::new(4.5, 3.8, 4.5),
            },
            points: 2500,
            attraction_m: 2.0,
            kill_m: 0.6,
            lifespan: 3,
            joints_share: 0.2,
            points_per_joint: 20,
            shrink: 0.6,
            hollow: 0.35,
            ..Self::default()
        }
    }

    /// Returns the growth settings of cycle `cycle`, from 0.
    fn cycle(&self, cycle: u32) -> ColonizeSpec {
        let scale = (0..cycle).fold(1.0, |s, _| s * self.shrink);
        ColonizeSpec {
            attraction_m: self.attraction_m * scale,
            kill_m: self.kill_m * scale,
            step_m: self.step_m.map(|d| d * scale),
            tropisms: self.tropisms.clone(),
            inertia: self.inertia,
            // Section 3.1: within a cycle points first make joints grow, then are absorbed.
            steer_before_kill: true,
            max_joints: self.max_joints,
        }
    }
}

/// Figures of one life cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cycle {
    /// Number of its points.
    pub points: usize,
    /// Number of consumed points.
    pub reached: usize,
    /// Number of joints at its end.
    pub joints: usize,
}

/// Result of competition.
#[derive(Clone, Debug, PartialEq)]
pub struct Competed {
    /// All trees.
    pub skeleton: Skeleton,
    /// Each life cycle.
    pub cycles: Vec<Cycle>,
}

/// Grows trees by competition for space (Yang et al. 2019, section 3.1), one from each root; they compete with one
/// another.
///
/// Guaranteed: it ends; a clean `validate()`; no joint in an obstacle; the skeleton after cycle n does not depend on
/// the lifespan. Points that cannot be reached are warned of, by cycle. Cost: about linear in points and joints.
///
/// # Errors
/// [`GrowthError`]: numbers out of range, no roots, a root in an obstacle, an envelope without room, cancelled.
///
/// ```
/// use base::{Report, Run, Seed};
/// use glam::DVec3;
/// use growth::{CompetitionSpec, Obstacles, compete};
/// let spec = CompetitionSpec { points: 300, ..CompetitionSpec::default() };
/// let (run, mut report) = (Run::plain(), Report::default());
/// let tree = compete(&[DVec3::ZERO], &Obstacles::none(), &spec, Seed::new(1), &run, &mut report)?;
/// assert!(tree.cycles.len() == 2 && tree.cycles[1].joints > tree.cycles[0].joints);
/// # Ok::<(), growth::GrowthError>(())
/// ```
pub fn compete(
    roots: &[DVec3],
    obstacles: &Obstacles,
    spec: &CompetitionSpec,
    seed: Seed,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Competed, GrowthError> {
    compete_each(roots, obstacles, spec, &VariationSpec::default(), seed, run, report)
}

/// As [`compete`], for trees that differ.
pub(crate) fn compete_each(
    roots: &[DVec3],
    obstacles: &Obstacles,
    spec: &CompetitionSpec,
    variation: &VariationSpec,
    seed: Seed,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Competed, GrowthError> {
    spec::check(spec)?;
    let all = u64::from(spec.points) * roots.len() as u64;
    run.budget.check(Counted::Points, all, "lower points or give fewer roots")?;
    let step = spec.step_m.unwrap_or(0.5 * spec.kill_m);
    let all_crowns = |e: &Envelope| crowns(e, variation, roots.len(), step, seed);
    let crown = all_crowns(&spec.envelope)?;
    let first = spec.first_envelope.as_ref().map(all_crowns).transpose()?;
    let mut skeleton = plant_roots(roots, obstacles, run)?;
    let lines = first.as_ref().unwrap_or(&crown);
    skeleton = grow_frame(skeleton, lines, roots, obstacles, step, run)?;
    let mut cycles = Vec::new();
    let mut stem_age = 0;
    for cycle in 0..spec.lifespan {
        run.cancel.check()?;
        let at = seed.child(u64::from(cycle));
        let points = if cycle == 0 {
            let regions = first.as_ref().unwrap_or(&crown);
            let hollow = if first.is_some() { 0.0 } else { spec.hollow };
            let mut points = Vec::with_capacity(roots.len() * spec.points as usize);
            for ((root, i), own) in roots.iter().zip(0_u64..).zip(regions.iter().cycle()) {
                let free = |p: DVec3| obstacles.free(*root + p);
                let count = own.region.count(spec.points);
                let own = own.region.scatter(count, hollow, at.child(i), free)?;
                points.extend(own.into_iter().map(|p| *root + p));
            }
            points
        } else {
            // A point may lie in the crown of any tree: neighbours compete for points within reach of both.
            let own = || roots.iter().zip(crown.iter().cycle());
            let inside = |p: DVec3| own().any(|(r, c)| c.region.contains(p - *r)) && obstacles.free(p);
            let chosen = choose(&skeleton, spec, stem_age, at);
            let all = u64::from(spec.points_per_joint) * chosen.len() as u64;
            run.budget.check(Counted::Points, all, "lower points_per_joint, joints_share or points")?;
            later_points(&skeleton, &chosen, spec, cycle, at, inside)
        };
        let mut told = Report::default();
        let share = |n: u32| crate::GROWN * f64::from(n) / f64::from(spec.lifespan);
        let part = (share(cycle), share(cycle + 1));
        let grown = colonize_part(skeleton, &points, obstacles, &spec.cycle(cycle), part, run, &mut told)?;
        for w in told.warnings {
            // Warnings about the numbers repeat in every cycle: only those of the first are kept.
            if !report.warnings.iter().any(|old| old.code == w.code && old.message == w.message) {
                report.warnings.push(Warning { message: format!("cycle {}: {}", cycle + 1, w.message), ..w });
            }
        }
        for s in told.stages {
            report.book(s.name, s.ms);
        }
        skeleton = grown.skeleton;
        let reached = grown.fates.iter().filter(|f| matches!(f, PointFate::Reached(_))).count();
        if cycle == 0 {
            stem_age = skeleton.age();
        }
        cycles.push(Cycle { points: points.len(), reached, joints: skeleton.len() });
    }
    Ok(Competed { skeleton, cycles })
}

/// Scatters M points in a ball around each of K joints.
fn later_points(
    skeleton: &Skeleton,
    chosen: &[usize],
    spec: &CompetitionSpec,
    cycle: u32,
    seed: Seed,
    inside: impl Fn(DVec3) -> bool,
) -> Vec<DVec3> {
    let scale = (1..cycle).fold(1.0, |s, _| s * spec.shrink);
    let radius = spec.ball_m.unwrap_or(spec.attraction_m) * scale;
    let size = DVec3::new(radius, radius * spec.ball_height, radius);
    let mut points = Vec::with_capacity(chosen.len() * spec.points_per_joint as usize);
    for &joint in chosen {
        let centre = skeleton.position[joint];
        let mut stream = seed.child(joint as u64).stream(Draw::Attractors);
        let mut left = spec.points_per_joint;
        // A ball half outside needs twice the tries; one entirely outside gets no points.
        for _ in 0..spec.points_per_joint.saturating_mul(8) {
            if left == 0 {
                break;
            }
            let u = DVec3::new(stream.range(-1.0, 1.0), stream.range(-1.0, 1.0), stream.range(-1.0, 1.0));
            if u.length_squared() > 1.0 {
                continue;
            }
            let p = centre + u * size;
            if inside(p) {
                points.push(p);
                left -= 1;
            }
        }
    }
    points
}

/// Chooses K joints at random, each by a number of its own so that few change when the tree changes slightly.
fn choose(skeleton: &Skeleton, spec: &CompetitionSpec, stem_age: u32, seed: Seed) -> Vec<usize> {
    let children = skeleton.children();
    let on_tier = |j: usize| {
        spec.tier_m.is_none_or(|tier| {
            let y = skeleton.position[j].y / tier;
            // A seventh of the distance up and down: whorls are not perfectly thin.
            skeleton.birth[j] > stem_age || (y - (y + 0.5).floor()).abs() < 0.15
        })
    };
    // A root bears no branches, and a tip in a tier would only be lengthened.
    let may_bear = |j: &usize| skeleton.parent[*j].is_some() && (children[*j] > 0 || spec.tier_m.is_none());
    let joints = (0..skeleton.len()).filter(may_bear).filter(|&j| on_tier(j));
    joints.filter(|&j| seed.child(j as u64).stream(Draw::TwigPlace).chance(spec.joints_share)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Obstacle;

    fn grow(spec: &CompetitionSpec, roots: &[DVec3], seed: u64) -> (Competed, Report) {
        let mut report = Report::default();
        let none = Obstacles::none();
        let got = compete(roots, &none, spec, Seed::new(seed), &Run::plain(), &mut report);
        (got.expect("sound spec"), report)
    }

    #[test]
    fn table_1_is_as_printed_and_grows() {
        let rows = [
            (CompetitionSpec::pine(), 2870, 0.9, 0.5, 2),
            (CompetitionSpec::terminalia(), 525, 0.8, 0.8, 3),
            (CompetitionSpec::chinese_fir(), 1543, 1.0, 0.4, 3),
        ];
        for (spec, n, di, dk, lifespan) in rows {
            assert_eq!((spec.points, spec.lifespan), (n, lifespan));
            assert_eq!((spec.attraction_m, spec.kill_m), (di, dk));
            let (tree, report) = grow(&spec, &[DVec3::ZERO], 1);
            assert_eq!(tree.skeleton.validate().count(), 0);
            assert_eq!(tree.cycles.len(), lifespan as usize);
            assert!(tree.cycles.windows(2).all(|c| c[1].joints > c[0].joints * 3 / 2), "{:?}", tree.cycles);
            let top = tree.skeleton.position.iter().map(|p| p.y).fold(0.0, f64::max);
            assert!(top > 5.0, "{top} {report:?}");
        }
    }

    #[test]
    fn earlier_cycles_do_not_depend_on_later_ones() {
        let long = CompetitionSpec { lifespan: 3, points: 400, ..CompetitionSpec::default() };
        let short = CompetitionSpec { lifespan: 1, ..long.clone() };
        let (a, _) = grow(&long, &[DVec3::ZERO], 5);
        let (b, _) = grow(&short, &[DVec3::ZERO], 5);
        let n = b.skeleton.len();
        assert_eq!(a.skeleton.position[..n], b.skeleton.position[..]);
        assert_eq!(a.skeleton.at_age(b.skeleton.age()), b.skeleton);
    }

    #[test]
    fn joints_stay_within_the_envelope_and_a_step() {
        let spec = CompetitionSpec { points: 800, lifespan: 3, ..CompetitionSpec::default() };
        let (tree, _) = grow(&spec, &[DVec3::ZERO], 2);
        let d = 0.5 * spec.kill_m;
        for p in tree.skeleton.position.iter().filter(|p| p.y > 2.0) {
            assert!(p.distance(DVec3::Y * 4.0) <= 2.0 + d, "{p}");
        }
    }

    #[test]
    fn obstacles_hold_in_every_cycle() {
        let rock = Obstacle::Sphere { centre: DVec3::new(1.0, 4.0, 0.0), radius_m: 0.7 };
        let obstacles = Obstacles::new(&[rock], 0.05).expect("sound");
        let spec = CompetitionSpec { points: 800, ..CompetitionSpec::default() };
        let run = Run::plain();
        let tree = compete(&[DVec3::ZERO], &obstacles, &spec, Seed::new(1), &run, &mut Report::default())
            .expect("sound");
        assert!(tree.skeleton.position.iter().all(|&p| obstacles.free(p)));
        let near = |p: &&DVec3| p.distance(DVec3::new(1.0, 4.0, 0.0)) < 1.0;
        assert!(tree.skeleton.position.iter().filter(near).count() > 5, "it grows close by");
    }

    #[test]
    fn neighbours_lean_apart() {
        let spec = CompetitionSpec { points: 600, ..CompetitionSpec::default() };
        let at = [DVec3::new(-1.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 0.0)];
        let (both, _) = grow(&spec, &at, 1);
        let (alone, _) = grow(&spec, &at[..1], 1);
        let inner = |s: &Skeleton| s.position.iter().filter(|p| p.x > 0.3).count();
        assert!(inner(&both.skeleton.tree(0)) * 2 < inner(&alone.skeleton), "the neighbour has that room");
        assert_eq!(both.skeleton.validate().count(), 0);
    }

    #[test]
    fn bad_numbers_are_named() {
        let bad = CompetitionSpec { shrink: 2.0, ..CompetitionSpec::default() };
        let got = compete(
            &[DVec3::ZERO],
            &Obstacles::none(),
            &bad,
            Seed::new(1),
            &Run::plain(),
            &mut Report::default(),
        );
        assert_eq!(got.map_err(|e| e.to_string()), Err("shrink must be 0.1 to 1, not 2".into()));
    }

    #[test]
    fn a_spec_is_read_back_from_its_file_form() {
        let text = serde_json::to_string(&CompetitionSpec::pine()).expect("plain data");
        assert_eq!(serde_json::from_str::<CompetitionSpec>(&text).ok(), Some(CompetitionSpec::pine()));
        assert!(serde_json::from_str::<CompetitionSpec>(r#"{"nonsense": 1}"#).is_err());
    }
}
