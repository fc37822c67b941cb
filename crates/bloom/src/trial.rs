//! Leaves each stage out in turn, and measures the distance of the model and its rivals from it.

use base::{CancelToken, Run};
use geom::{KdTree, best_rotation};
use glam::DVec3;

use crate::register::register_organ;
use crate::{
    BloomError, GrowthLaw, Lattice, LawSpec, MotionSpec, RegisterSpec, RigidMotion, Settled, ShapeError,
    Stage, Weights, compare, fit_stages, name_alike, settle,
};

/// A method of predicting the shape on a day.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rival {
    /// The law if the other days determine one, with the pose separated: the method of `bloom run`.
    Model,
    /// The same at an even pace, with the pose not separated.
    NoLaw,
    /// The scan of the nearest other day, unchanged.
    NearestDay,
    /// Straight lines between the two days around it after the best rigid move of one onto the other.
    Linear,
}

impl Rival {
    /// All, the model first.
    pub const ALL: [Self; 4] = [Self::Model, Self::NoLaw, Self::NearestDay, Self::Linear];

    /// Returns the words used in tables and reports.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Model => "model",
            Self::NoLaw => "no law",
            Self::NearestDay => "nearest day",
            Self::Linear => "linear after alignment",
        }
    }
}

/// Distances of one method from the left-out scan.
#[derive(Clone, Copy, Debug)]
pub struct TrialRow {
    /// The method.
    pub rival: Rival,
    /// After the best rigid move of the made shape onto the scan.
    pub aligned: ShapeError,
    /// Without a move, in the coordinates of the scanner.
    pub scanner: ShapeError,
}

/// A day that was left out.
#[derive(Clone, Debug)]
pub struct Trial {
    /// The day, in the count of the stages.
    pub day: f64,
    /// Whether it is the first or the last: all others lie on one side of it.
    pub extrapolated: bool,
    /// Whether some law was determined by the other days.
    pub law: bool,
    /// One row for each of [`Rival::ALL`], in that order.
    pub rows: Vec<TrialRow>,
}

/// Leaves each stage out in turn. The left-out stage takes part only in the last measurement.
///
/// `up`: organs carry the names that [`name_alike`] found from stage to stage, this way up. Then names that were found
/// through the left-out stage are found again. `None`: they were given by hand.
///
/// Below 3 stages there is nothing to leave out: the result is empty. Cost: some registrations of each organ per day.
///
/// # Errors
/// As [`settle`] and [`crate::Motion::new`].
pub fn leave_one_out(
    stages: &[Stage],
    law: &LawSpec,
    spec: &MotionSpec,
    up: Option<DVec3>,
    run: &Run<'_>,
) -> Result<Vec<Trial>, BloomError> {
    let mut out = Vec::new();
    if stages.len() < 3 {
        return Ok(out);
    }
    for k in 0..stages.len() {
        run.cancel.reached(k as f64 / stages.len() as f64);
        let mut rest: Vec<Stage> = (0..stages.len()).filter(|&i| i != k).map(|i| stages[i].clone()).collect();
        if let Some(up) = up {
            for later in k.max(1)..rest.len() {
                let (before, now) = rest.split_at_mut(later);
                name_alike(before, &mut now[0].organs, up);
            }
        }
        out.push(trial(&rest, &stages[k], law, spec, run)?);
    }
    Ok(out)
}

fn all(stage: &Stage) -> Vec<DVec3> {
    stage.organs.iter().flat_map(|o| o.points.iter().copied()).collect()
}

fn trial(
    rest: &[Stage],
    left: &Stage,
    law: &LawSpec,
    spec: &MotionSpec,
    run: &Run<'_>,
) -> Result<Trial, BloomError> {
    let day = left.day;
    let settled = settle(rest, &spec.register, run)?;
    let fitted = if rest.len() < 3 { None } else { Some(fit_stages("", &settled.stages, law, run)?) };
    let determined = fitted.as_ref().is_some_and(|l| l.laws.iter().any(crate::RegionLaw::is_determined));
    let fitted = fitted.filter(|l| !l.laws.is_empty());
    let even = GrowthLaw::even(rest[0].day, rest[rest.len() - 1].day);
    let law = fitted.unwrap_or_else(|| even.clone());
    let pose = settled.pose(day);
    let model = settled.day(&law, spec, day, run)?;
    let model = model.into_iter().flat_map(|o| o.points).map(|p| pose.apply(p)).collect();
    let plain = Settled::unmoved(rest).day(&even, spec, day, run)?;
    let plain = plain.into_iter().flat_map(|o| o.points).collect();
    let away = |s: &&Stage| (s.day - day).abs();
    let nearest = rest.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    let nearest = nearest.map(all).unwrap_or_default();
    let linear = straight(rest, settled.round(day), &spec.register, day, run)?;
    let scan = all(left);
    let shapes: [Vec<DVec3>; 4] = [model, plain, nearest, linear];
    let mut rows = Vec::new();
    for (rival, shape) in Rival::ALL.into_iter().zip(shapes) {
        let moved = best_move(&shape, &scan, run)?;
        let aligned: Vec<DVec3> = shape.iter().map(|&p| moved.apply(p)).collect();
        rows.push(TrialRow {
            rival,
            aligned: compare(&scan, &aligned, run)?,
            scanner: compare(&scan, &shape, run)?,
        });
    }
    let extrapolated = day < rest[0].day || day > rest[rest.len() - 1].day;
    Ok(Trial { day, extrapolated, law: determined, rows })
}

/// Moves the points of the nearer of the two days around `day` on straight lines to their positions on the other day,
/// after the rigid move of that one which brings all points nearest to their former positions; at an end day the points
/// of the nearest day move on by as much.
fn straight(
    rest: &[Stage],
    [i, j]: [usize; 2],
    spec: &RegisterSpec,
    day: f64,
    run: &Run<'_>,
) -> Result<Vec<DVec3>, BloomError> {
    let nearer = (day - rest[i].day).abs() <= (day - rest[j].day).abs();
    let (near, far) = if nearer { (&rest[i], &rest[j]) } else { (&rest[j], &rest[i]) };
    let share = (day - near.day) / (far.day - near.day);
    let mut fits = Vec::new();
    let mut pairs = Vec::new();
    for organ in &near.organs {
        let Some(other) = far.organs.iter().find(|o| o.name == organ.name) else { continue };
        let fit = register_organ(organ, (&organ.points, organ.base), other, spec, run)?;
        let weights = Weights::new(&fit.obb, spec.counts, &organ.points)?;
        let there = weights.apply(&fit.last, run)?;
        pairs.extend(organ.points.iter().copied().zip(there));
        fits.push((&organ.name, fit, weights));
    }
    let back = RigidMotion::from_pairs(&pairs, DVec3::ZERO).inverse();
    let mut out = Vec::new();
    for organ in &near.organs {
        let Some((_, fit, weights)) = fits.iter().find(|f| *f.0 == organ.name) else {
            out.extend(&organ.points);
            continue;
        };
        let ends = fit.first.points.iter().zip(&fit.last.points);
        let points = ends.map(|(p, q)| p.lerp(back.apply(*q), share)).collect();
        out.extend(weights.apply(&Lattice { counts: spec.counts, points }, run)?);
    }
    Ok(out)
}

/// Points of each shape in the search for the best rigid move: first, and at the end.
const SAMPLES: [usize; 2] = [800, 3000];
/// Most rounds of iterated nearest points.
const ROUNDS: usize = 60;

/// Returns the rigid motion of `shape` that brings the two nearest to one another: least mean distance in both
/// directions among those that iterated nearest points reach from no motion and from seven rotations about the
/// vertical, weighted by 1 over the distance so that parts that the other shape lacks do not pull.
///
/// # Errors
/// [`BloomError::TooFew`] if a shape has no finite point, [`BloomError::Cancelled`].
pub fn best_move(shape: &[DVec3], scan: &[DVec3], run: &Run<'_>) -> Result<RigidMotion, BloomError> {
    for (what, points) in [("the model", shape), ("the scan", scan)] {
        if !points.iter().any(|p| p.is_finite()) {
            return Err(BloomError::TooFew { what: what.into(), is: 0, wanted: 1 });
        }
    }
    let few = Pair::new(shape, scan, SAMPLES[0]);
    let turned = (-3..=3).map(|k| {
        let turn = base::turn::about(DVec3::Y, f64::from(k) * base::ops::PI / 9.0);
        RigidMotion { from: few.middles[0], to: few.middles[1], turn }
    });
    let starts: Vec<RigidMotion> = turned.chain([RigidMotion::REST]).collect();
    let mut found =
        base::map_indexed(run.executor, starts.len(), |k| few.descend(starts[k], ROUNDS, run.cancel));
    run.cancel.check()?;
    base::sort_by(&mut found, |x, y| x.0.total_cmp(&y.0));
    // The small sample cannot rank nearly equal starts.
    found.truncate(3);
    let all = Pair::new(shape, scan, SAMPLES[1]);
    let ends = base::map_indexed(run.executor, found.len(), |k| all.descend(found[k].1, ROUNDS, run.cancel));
    run.cancel.check()?;
    let best = ends.into_iter().min_by(|x, y| x.0.total_cmp(&y.0));
    Ok(best.map_or(RigidMotion::REST, |b| b.1))
}

/// Samples of two shapes.
pub(crate) struct Pair {
    from: Vec<DVec3>,
    to: Vec<DVec3>,
    middles: [DVec3; 2],
    tree: KdTree,
    /// Root mean square distance of the second from its centre.
    size: f64,
}

impl Pair {
    pub(crate) fn new(shape: &[DVec3], scan: &[DVec3], sample: usize) -> Self {
        // By rank: a sample has the density of its original, as the mean distance does.
        let pick = |points: &[DVec3]| -> Vec<DVec3> {
            let finite = || points.iter().copied().filter(|p| p.is_finite());
            finite().step_by(finite().count().div_ceil(sample).max(1)).collect()
        };
        let middle = |points: &[DVec3]| points.iter().sum::<DVec3>() / points.len().max(1) as f64;
        let (from, to) = (pick(shape), pick(scan));
        let middles = [middle(&from), middle(&to)];
        let square: f64 = to.iter().map(|p| p.distance_squared(middles[1])).sum();
        let size = (square / to.len().max(1) as f64).sqrt();
        Self { tree: KdTree::new(&to), from, to, middles, size }
    }

    /// Returns the sum of the mean distances there and back, after a motion.
    pub(crate) fn gap(&self, moved: &RigidMotion) -> f64 {
        let places: Vec<DVec3> = self.from.iter().map(|&p| moved.apply(p)).collect();
        let back = KdTree::new(&places);
        let mean = |tree: &KdTree, of: &[DVec3], from: &[DVec3]| {
            let each = from.iter().filter_map(|p| Some(of[tree.nearest(*p, f64::INFINITY)?].distance(*p)));
            each.sum::<f64>() / from.len().max(1) as f64
        };
        mean(&self.tree, &self.to, &places) + mean(&back, &places, &self.to)
    }

    /// Iterates nearest points in both directions; returns the sum of the mean distances there and back, and the
    /// motion. A cancelled run returns the motion so far, which is meaningless.
    pub(crate) fn descend(
        &self,
        mut moved: RigidMotion,
        rounds: usize,
        cancel: &CancelToken,
    ) -> (f64, RigidMotion) {
        // Below half a hundredth of the size a distance is the spacing of the points.
        let floor = 0.005 * self.size.max(1e-12);
        let mut gap = f64::INFINITY;
        for _ in 0..rounds {
            if cancel.check().is_err() {
                break;
            }
            let places: Vec<DVec3> = self.from.iter().map(|&p| moved.apply(p)).collect();
            let back = KdTree::new(&places);
            let there = places.iter().enumerate();
            let there = there.filter_map(|(i, p)| Some((i, self.tree.nearest(*p, f64::INFINITY)?)));
            let here = self.to.iter().enumerate();
            let here = here.filter_map(|(j, q)| Some((back.nearest(*q, f64::INFINITY)?, j)));
            let mut pairs = Vec::with_capacity(self.from.len() + self.to.len());
            gap = 0.0;
            for list in [there.collect::<Vec<(usize, usize)>>(), here.collect()] {
                for &(i, j) in &list {
                    let d = places[i].distance(self.to[j]);
                    gap += d / list.len() as f64;
                    // Both directions have equal weight, however many points a shape has.
                    pairs.push((self.from[i], self.to[j], 1.0 / ((d + floor) * list.len() as f64)));
                }
            }
            let total: f64 = pairs.iter().map(|p| p.2).sum();
            let a = pairs.iter().map(|p| p.0 * p.2).sum::<DVec3>() / total;
            let b = pairs.iter().map(|p| p.1 * p.2).sum::<DVec3>() / total;
            let turn = best_rotation(pairs.iter().map(|p| (p.0 - a, (p.1 - b) * p.2)));
            let next = RigidMotion { from: a, to: b, turn };
            let step = next.apply(moved.from).distance(moved.apply(moved.from));
            let turned = 1.0 - next.turn.dot(moved.turn).abs();
            moved = next;
            if step < 1e-6 * self.size && turned < 1e-13 {
                break;
            }
        }
        (gap, moved)
    }
}
