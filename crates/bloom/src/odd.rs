//! Finds scans of several days that are mirrored, lie down, or have a different scale.

use base::Run;
use glam::{DQuat, DVec3};

use crate::thin::thin;
use crate::trial::Pair;
use crate::{BloomError, RigidMotion, Stage};

/// Suspected fault of a scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Oddity {
    /// It matches its neighbour if one of its axes is negated.
    Mirrored,
    /// It matches its neighbour if this axis of it points up.
    Turned(DVec3),
    /// It matches its neighbour at this size ratio, which no growth explains.
    Scaled(f64),
}

/// A scan that does not match its neighbour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OddStage {
    /// Row of the scan.
    pub stage: usize,
    /// Row of the scan that it was compared with.
    pub beside: usize,
    /// Suspected fault.
    pub oddity: Oddity,
    /// Whether a third scan identifies the faulty one of the two; otherwise it may be either.
    pub sure: bool,
    /// Distance of the two scans after the best move, as a share of their size.
    pub as_it_is: f64,
    /// The same with the fault corrected.
    pub mended: f64,
}

/// Points of each scan in the search, and in the last measurement.
const SAMPLES: [usize; 2] = [200, 1200];
/// Rounds of iterated nearest points in both.
const ROUNDS: [usize; 2] = [15, 40];
/// Largest ratio of the distance without a fault to that with it at which the fault is reported.
const NEARER: f64 = 0.6;
/// Ratio of distances to a third scan at which it decides between two.
const DECIDED: f64 = 1.25;
/// Size ratio from which a copy is not explained by growth.
const GREW: f64 = 1.35;
/// Largest ratio of the distance of two samples of one shape to that of its two halves.
const SAME: f64 = 1.35;
/// Rotations about the vertical from which a search starts.
const STARTS: u32 = 9;

/// Finds scans whose axes or scale differ from those of the others, by the best moves of each scan onto the next as it
/// is, mirrored and with another axis up.
///
/// Plants that are their own mirror image, or look the same lying down, give no evidence. Cost: some tenths of a second
/// per scan.
///
/// # Errors
/// [`BloomError::Cancelled`].
pub fn odd_stages(stages: &[Stage], run: &Run<'_>) -> Result<Vec<OddStage>, BloomError> {
    let clouds: Vec<Option<Cloud>> = stages.iter().map(Cloud::from_stage).collect();
    let mut steps = Vec::new();
    for (k, pair) in clouds.windows(2).enumerate() {
        let [Some(a), Some(b)] = pair else { continue };
        if let Some((oddity, as_it_is, mended)) = compare_two(a, b, run)? {
            steps.push(OddStage { stage: k + 1, beside: k, oddity, sure: false, as_it_is, mended });
        }
    }
    // A scan that matches neither of its neighbours is odd itself.
    let mut out: Vec<OddStage> = Vec::new();
    for step in steps {
        match out.last_mut() {
            Some(o) if o.stage + 1 == step.stage && o.oddity.undone(&step.oddity) => o.sure = true,
            _ => out.push(step),
        }
    }
    if let [only] = &mut out[..]
        && !only.sure
    {
        // The one of the two that matches a third one less well.
        let third = if only.beside > 0 { only.beside - 1 } else { only.stage + 1 };
        if let (Some(before), Some(after), Some(Some(third))) =
            (&clouds[only.beside], &clouds[only.stage], clouds.get(third))
        {
            let [a, b] =
                [misfit(before, third, &only.oddity, run)?, misfit(after, third, &only.oddity, run)?];
            only.sure = a.max(b) > DECIDED * a.min(b);
            if only.sure
                && a > b
                && let Some((oddity, ..)) = compare_two(after, before, run)?
            {
                *only = OddStage { stage: only.beside, beside: only.stage, oddity, ..*only };
            }
        }
    }
    Ok(out)
}

impl Oddity {
    /// Whether the next step reverses this one.
    fn undone(&self, next: &Self) -> bool {
        match (self, next) {
            (Self::Mirrored, Self::Mirrored) | (Self::Turned(_), Self::Turned(_)) => true,
            (Self::Scaled(a), Self::Scaled(b)) => (a * b - 1.0).abs() < 0.1,
            _ => false,
        }
    }
}

/// A scan scaled to size 1 about its centre.
struct Cloud {
    few: Vec<DVec3>,
    many: Vec<DVec3>,
    size: f64,
}

impl Cloud {
    fn from_stage(stage: &Stage) -> Option<Self> {
        let all: Vec<DVec3> = stage.organs.iter().flat_map(|o| o.points.iter().copied()).collect();
        let even: Vec<DVec3> = thin(&all, SAMPLES[1]).into_iter().map(|i| all[i as usize]).collect();
        if even.len() < 50 {
            return None;
        }
        let n = even.len() as f64;
        let middle = even.iter().sum::<DVec3>() / n;
        let size = (even.iter().map(|p| p.distance_squared(middle)).sum::<f64>() / n).sqrt();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        let many: Vec<DVec3> = even.iter().map(|p| (*p - middle) / size).collect();
        let few = thin(&many, SAMPLES[0]).into_iter().map(|i| many[i as usize]).collect();
        Some(Self { few, many, size })
    }

    fn mirrored(&self) -> Self {
        let flip = |points: &[DVec3]| points.iter().map(|p| DVec3::new(-p.x, p.y, p.z)).collect();
        Self { few: flip(&self.few), many: flip(&self.many), size: self.size }
    }
}

/// Least cosine between the vertical before and after a rotation at which the plant still stands: 45 degrees.
const STANDS: f64 = 0.707;

/// Distance after the best move of `a` onto `b` that leaves it standing, and after the best other one with its
/// rotation.
struct Moves {
    standing: f64,
    other: (f64, DQuat),
}

/// Finds the best moves from starts with each of `ups` pointing up. Moves may fall over on their way: their end counts.
fn best(a: &Cloud, b: &Cloud, ups: &[DVec3], run: &Run<'_>) -> Result<Moves, BloomError> {
    let few = Pair::new(&a.few, &b.few, SAMPLES[0]);
    let starts: Vec<RigidMotion> = ups
        .iter()
        .flat_map(|&up| {
            let over = base::turn::between(up, DVec3::Y);
            (0..STARTS).map(move |k| {
                let about = base::turn::about(DVec3::Y, base::ops::TAU * f64::from(k) / f64::from(STARTS));
                RigidMotion { from: DVec3::ZERO, to: DVec3::ZERO, turn: about * over }
            })
        })
        .collect();
    let mut found =
        base::map_indexed(run.executor, starts.len(), |k| few.descend(starts[k], ROUNDS[0], run.cancel));
    run.cancel.check()?;
    base::sort_by(&mut found, |x, y| x.0.total_cmp(&y.0));
    let stands = |m: &RigidMotion| (m.turn * DVec3::Y).y > STANDS;
    let (up, down): (Vec<_>, Vec<_>) = found.into_iter().map(|f| f.1).partition(stands);
    let chosen: Vec<RigidMotion> = up.iter().take(2).chain(down.iter().take(2)).copied().collect();
    let many = Pair::new(&a.many, &b.many, SAMPLES[1]);
    let ends =
        base::map_indexed(run.executor, chosen.len(), |k| many.descend(chosen[k], ROUNDS[1], run.cancel));
    run.cancel.check()?;
    let mut out = Moves { standing: f64::INFINITY, other: (f64::INFINITY, DQuat::IDENTITY) };
    for (gap, m) in ends {
        let gap = 0.5 * gap;
        if stands(&m) {
            out.standing = out.standing.min(gap);
        } else if gap < out.other.0 {
            out.other = (gap, m.turn);
        }
    }
    Ok(out)
}

/// Returns the ratio of the distances of two scans with and without the correction of a fault.
fn misfit(a: &Cloud, b: &Cloud, fault: &Oddity, run: &Run<'_>) -> Result<f64, BloomError> {
    let moves = best(a, b, &UPS, run)?;
    Ok(match fault {
        Oddity::Mirrored => moves.standing / best(&a.mirrored(), b, &UPS[..1], run)?.standing,
        Oddity::Turned(_) => moves.standing / moves.other.0,
        Oddity::Scaled(_) => base::ops::ln(a.size / b.size).abs(),
    })
}

/// The vertical, then the other axes.
const UPS: [DVec3; 6] = [DVec3::Y, DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::NEG_X, DVec3::NEG_Y];

/// Returns the fault of `b` relative to `a`, and their distances as they are and corrected.
fn compare_two(a: &Cloud, b: &Cloud, run: &Run<'_>) -> Result<Option<(Oddity, f64, f64)>, BloomError> {
    let Moves { standing, other: (lying, turn) } = best(a, b, &UPS, run)?;
    // Distance between two samples of one shape.
    let halves: [Vec<DVec3>; 2] = [0, 1].map(|k| b.many.iter().copied().skip(k).step_by(2).collect());
    let [one, other] = &halves;
    let floor = 0.5 * Pair::new(one, other, SAMPLES[1]).gap(&RigidMotion::REST);
    let scale = b.size / a.size;
    if standing < SAME * floor {
        let odd = !(1.0 / GREW..GREW).contains(&scale);
        return Ok(odd.then_some((Oddity::Scaled(scale), standing, standing)));
    }
    if lying < NEARER * standing {
        // Direction in this scan of the vertical of the one before.
        let up = turn * DVec3::Y;
        let level = up.abs().max_element();
        let axis = up.to_array().map(|c| if c.abs() < level { 0.0 } else { c.signum() });
        return Ok(Some((Oddity::Turned(DVec3::from_array(axis)), standing, lying)));
    }
    let mirrored = best(&a.mirrored(), b, &UPS[..1], run)?.standing;
    let odd = mirrored < NEARER * standing;
    Ok(odd.then_some((Oddity::Mirrored, standing, mirrored)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ScanOrgan;
    use base::{Draw, Seed, ops};

    /// Makes a seedling with three unlike leaves, `grown` and with every leaf lifted by `lift`.
    fn plant(grown: f64, lift: f64, seed: u64) -> Vec<DVec3> {
        let mut s = Seed::new(seed).stream(Draw::Test);
        let mut out: Vec<DVec3> = (0..600)
            .map(|_| {
                let a = s.range(0.0, ops::TAU);
                DVec3::new(0.001 * ops::cos(a), s.range(0.0, 0.03), 0.001 * ops::sin(a))
            })
            .collect();
        for (azimuth, length, rise) in [(0.0, 0.04, 0.2), (1.5, 0.028, 0.5), (3.6, 0.018, 0.9)] {
            let (sin, cos) = ops::sin_cos(azimuth);
            for _ in 0..1500 {
                let (v, u) = (s.uniform(), s.range(-1.0, 1.0));
                let (r, w) = (grown * length * v, 0.008 * u * ops::sin(ops::PI * v));
                let y = 0.03 + (rise + lift) * r;
                out.push(DVec3::new(r * cos - w * sin, y, r * sin + w * cos));
            }
        }
        out
    }

    fn stage(day: f64, points: Vec<DVec3>) -> Stage {
        Stage { day, organs: vec![ScanOrgan { name: "plant".into(), points, ..ScanOrgan::default() }] }
    }

    fn odd(clouds: [Vec<DVec3>; 3]) -> Vec<(usize, Oddity)> {
        let stages: Vec<Stage> = clouds.into_iter().zip([1.0, 2.0, 3.0]).map(|(c, d)| stage(d, c)).collect();
        odd_stages(&stages, &Run::plain()).unwrap().iter().map(|o| (o.stage, o.oddity)).collect()
    }

    #[test]
    fn mirrored_lying_and_rescaled_scans_are_found_and_grown_ones_are_not() {
        let day = |k: usize| plant(1.0 + 0.15 * k as f64, 0.1 * k as f64, 1 + k as u64);
        let days = [day(0), day(1), day(2)];
        assert_eq!(odd(days.clone()), []);
        let turn = base::turn::about(DVec3::Y, 2.0);
        for row in 0..3 {
            let change = |f: &dyn Fn(DVec3) -> DVec3| {
                let mut all = days.clone();
                all[row].iter_mut().for_each(|p| *p = f(*p));
                odd(all)
            };
            assert_eq!(change(&|p| turn * p), [], "a pot may be turned");
            assert_eq!(change(&|p| DVec3::new(p.x, p.y, -p.z)), [(row, Oddity::Mirrored)], "{row}");
            assert_eq!(change(&|p| DVec3::new(p.x, -p.z, p.y)), [(row, Oddity::Turned(DVec3::Z))], "{row}");
        }
        let copy = |f: f64| plant(1.0, 0.0, 9).into_iter().map(|p| p * f).collect::<Vec<DVec3>>();
        match odd([copy(1.0), copy(2.54), copy(1.0)])[..] {
            [(1, Oddity::Scaled(by))] => assert!((by - 2.54).abs() < 0.05, "{by}"),
            ref other => panic!("{other:?}"),
        }
    }
}
