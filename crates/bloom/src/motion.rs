//! The shape on any day from two or more shapes and a law.

use base::Run;
use glam::DVec3;

use crate::coloured;
use crate::register::register_organ;
use crate::{
    BloomError, GrowthLaw, Lattice, Quantity, RegisterSpec, Registration, ScanOrgan, Stage, Weights,
    match_organs,
};

/// Settings of the motion between two shapes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionSpec {
    /// Registration and lattice.
    pub register: RegisterSpec,
    /// Whether control points move on straight lines, as in Huai, Yang and Cai (2019), Algorithm 2, instead of turning
    /// with their organ. Default false: an organ that swings by 40 degrees would shrink by 6 % half way.
    pub straight: bool,
}

/// One organ between two consecutive stages.
#[derive(Clone, Debug)]
struct Segment {
    /// Start, days since the first stage.
    from: f64,
    to: f64,
    weights: Weights,
    fit: Registration,
    /// Position of each control point along the organ, 0 to 1.
    along: Vec<f64>,
    /// Colours of the points at the beginning and, from the nearest points of the later scan, at the end.
    colors: [Vec<[u8; 3]>; 2],
}

/// Growth of an organ that is new at a stage, out of its base over the time before.
#[derive(Clone, Debug)]
struct Birth {
    from: f64,
    to: f64,
    base: DVec3,
    points: Vec<DVec3>,
    /// Row of an older organ nearest to the base: it carries the base along, at this distance at birth.
    bearer: Option<usize>,
    gap: DVec3,
    colors: Vec<[u8; 3]>,
}

/// One organ over all days.
#[derive(Clone, Debug)]
struct Track {
    name: String,
    /// Rows of the result that belong to the organ.
    rows: core::ops::Range<usize>,
    segments: Vec<Segment>,
    /// State of the organ before its first segment.
    born: Option<Birth>,
}

/// The motion of a plant through its stages: meets the points of the first stage exactly, later stages up to the
/// residual of their registration, and follows the growth law between.
#[derive(Clone, Debug)]
pub struct Motion {
    tracks: Vec<Track>,
    points: usize,
    law: GrowthLaw,
    /// Day of the first stage in the count of the law.
    start: f64,
    spec: MotionSpec,
    /// Name of the organ of each row, by range.
    pub organs: Vec<(String, core::ops::Range<usize>)>,
    /// Residual of each registration: organ, day from, day to, residual.
    pub residuals: Vec<(String, f64, f64, crate::ShapeError)>,
}

/// Gives the organs of a day the names that they have on the days before, in order of days.
///
/// Organs are matched with those of the day before. An organ without a partner is `new-` with its own name, or with the
/// next number that no organ had on any day before, as one name is one organ on all days.
pub fn name_alike(before: &[Stage], now: &mut [ScanOrgan], up: DVec3) {
    let Some(last) = before.last().map(|s| s.organs.as_slice()) else { return };
    let pairs = match_organs(last, now, up);
    let mut taken: Vec<String> = before.iter().flat_map(|s| &s.organs).map(|o| o.name.clone()).collect();
    for (j, organ) in now.iter_mut().enumerate() {
        organ.name = match pairs.iter().find(|p| p.1 == j) {
            Some(&(i, _)) => last[i].name.clone(),
            None => unused(organ.name.trim_start_matches("new-"), &taken),
        };
        taken.push(organ.name.clone());
    }
}

/// Returns `new-NAME`, with another number if that is taken.
fn unused(name: &str, taken: &[String]) -> String {
    let kind = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let own = core::iter::once(format!("new-{name}"));
    let numbered = (1..=taken.len() + 1).map(|k| format!("new-{kind}{k}"));
    let mut free = own.chain(numbered).filter(|name| !taken.contains(name));
    free.next().unwrap_or_else(|| format!("new-{name}"))
}

impl Motion {
    /// Registers each organ from stage to stage. Organs are the same if they have the same name. `stages` need not be
    /// those of the law; their days count from the first.
    ///
    /// # Errors
    /// [`BloomError::TooFew`] below 2 stages or 8 points of an organ, [`BloomError::Cancelled`].
    pub fn new(
        stages: &[Stage],
        law: GrowthLaw,
        spec: MotionSpec,
        run: &Run<'_>,
    ) -> Result<Self, BloomError> {
        Self::since(0.0, stages, law, spec, run)
    }

    /// As [`new`](Self::new), for stages of which the first is at day `start` of the law. Two stages may run backwards.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub(crate) fn since(
        start: f64,
        stages: &[Stage],
        law: GrowthLaw,
        spec: MotionSpec,
        run: &Run<'_>,
    ) -> Result<Self, BloomError> {
        let [first, later @ ..] = stages else {
            return Err(BloomError::TooFew { what: "the series".into(), is: 0, wanted: 2 });
        };
        if later.is_empty() {
            return Err(BloomError::TooFew { what: "the series of stages".into(), is: 1, wanted: 2 });
        }
        let mut motion =
            Self { tracks: vec![], points: 0, law, start, spec, organs: vec![], residuals: vec![] };
        for organ in &first.organs {
            motion.track(stages, 0, organ, run)?;
        }
        for (k, stage) in stages.iter().enumerate().skip(1) {
            for organ in &stage.organs {
                let known = motion.tracks.iter().any(|t| t.name == organ.name);
                if !known {
                    motion.track(stages, k, organ, run)?;
                }
            }
        }
        Ok(motion)
    }

    fn track(
        &mut self,
        stages: &[Stage],
        begin: usize,
        organ: &ScanOrgan,
        run: &Run<'_>,
    ) -> Result<(), BloomError> {
        let start = self.points;
        self.points += organ.points.len();
        let day = |k: usize| stages[k].day - stages[0].day;
        let (mut points, mut colors) = (organ.points.clone(), organ.colors.clone());
        let mut base = organ.base;
        let mut at = begin;
        let mut segments = Vec::new();
        for (k, stage) in stages.iter().enumerate().skip(begin + 1) {
            let Some(next) = stage.organs.iter().find(|o| o.name == organ.name) else { continue };
            let fit = register_organ(organ, (&points, base), next, &self.spec.register, run)?;
            let weights = Weights::new(&fit.obb, self.spec.register.counts, &points)?;
            let along = places(&fit, &points, &organ.way);
            self.residuals.push((organ.name.clone(), day(at), day(k), fit.residual));
            points = weights.apply(&fit.last, run)?;
            base = next.base;
            let there = coloured::nearest(&points, &next.points, &next.colors, run)?;
            let colors = [core::mem::replace(&mut colors, there.clone()), there];
            segments.push(Segment { from: day(at), to: day(k), weights, fit, along, colors });
            at = k;
        }
        let mut born = None;
        if begin > 0 {
            let older = self.points_on_day(day(begin), run)?;
            let gap = |i: &usize| older[*i].distance_squared(organ.base);
            let bearer = (0..start).min_by(|a, b| gap(a).total_cmp(&gap(b)));
            let (from, to) = (day(begin - 1), day(begin));
            let gap = bearer.map_or(DVec3::ZERO, |row| organ.base - older[row]);
            let (points, colors) = (organ.points.clone(), organ.colors.clone());
            born = Some(Birth { from, to, base: organ.base, points, bearer, gap, colors });
        } else if segments.is_empty() {
            // Its later state is unknown: it stays.
            let always = f64::NEG_INFINITY;
            let points = organ.points.clone();
            born = Some(Birth {
                from: always,
                to: always,
                base: organ.base,
                points,
                bearer: None,
                gap: DVec3::ZERO,
                colors: organ.colors.clone(),
            });
        }
        let rows = start..self.points;
        self.organs.push((organ.name.clone(), rows.clone()));
        self.tracks.push(Track { name: organ.name.clone(), rows, segments, born });
        Ok(())
    }

    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.points
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.points == 0
    }

    /// Returns the colours of the points of each organ at `day` since the first stage, in the order of
    /// [`organs`](Self::organs): between two stages a mean of both, weighted by time; before the first and after the
    /// last those of the nearest. Empty for an organ whose stages have none.
    pub fn colors(&self, day: f64) -> Vec<Vec<[u8; 3]>> {
        let of = |track: &Track| {
            let first_from = track.segments.first().map_or(f64::INFINITY, |s| s.from);
            match &track.born {
                Some(b) if day < first_from => b.colors.clone(),
                _ => {
                    let segment = track.segments.iter().find(|s| day <= s.to).or(track.segments.last());
                    let mixed = |s: &Segment| coloured::mixed(&s.colors, (day - s.from) / (s.to - s.from));
                    segment.map(mixed).unwrap_or_default()
                }
            }
        };
        self.tracks.iter().map(of).collect()
    }

    /// Returns all points at `day` since the first stage: the organs of the first stage in order, then those that
    /// appeared later. Days outside the stages continue the law by at most half.
    ///
    /// # Errors
    /// [`BloomError::Cancelled`].
    pub fn points_on_day(&self, day: f64, run: &Run<'_>) -> Result<Vec<DVec3>, BloomError> {
        let mut out = vec![DVec3::ZERO; self.points];
        for track in &self.tracks {
            let first_from = track.segments.first().map_or(f64::INFINITY, |s| s.from);
            match &track.born {
                Some(b) if day < first_from => {
                    let size = if day >= b.to {
                        1.0
                    } else {
                        self.law
                            .progress(
                                &track.name,
                                Quantity::Size,
                                0.5,
                                b.from + self.start,
                                b.to + self.start,
                                day + self.start,
                            )
                            .clamp(0.02, 1.0)
                    };
                    let place = match b.bearer {
                        // The gap between the base and its bearer at birth closes towards the beginning.
                        Some(row) if day < b.to => out[row] + b.gap * size,
                        _ => b.base,
                    };
                    for (s, p) in out[track.rows.clone()].iter_mut().zip(&b.points) {
                        *s = place + (*p - b.base) * size;
                    }
                }
                _ => {
                    let segment =
                        track.segments.iter().find(|s| day <= s.to).or_else(|| track.segments.last());
                    if let Some(segment) = segment {
                        let lattice = segment.lattice(&track.name, day, self);
                        segment.weights.apply_with(&lattice, &mut out[track.rows.clone()], run)?;
                    }
                }
            }
        }
        Ok(out)
    }
}

/// Returns the position of each control point along the organ: mean path length of the points near it, by its
/// coordinate on the box's axis along the organ.
fn places(fit: &Registration, points: &[DVec3], way: &[f64]) -> Vec<f64> {
    // The axis whose coordinate correlates best with the path length.
    let local: Vec<DVec3> = points.iter().map(|p| fit.obb.local(*p)).collect();
    let n = local.len().max(1) as f64;
    let mean_way = way.iter().sum::<f64>() / n;
    let mean = local.iter().sum::<DVec3>() / n;
    let mut cov = DVec3::ZERO;
    let mut var = DVec3::ZERO;
    for (l, w) in local.iter().zip(way) {
        cov += (*l - mean) * (w - mean_way);
        var += (*l - mean) * (*l - mean);
    }
    let spread: f64 = way.iter().map(|w| (w - mean_way) * (w - mean_way)).sum();
    let r = |k: usize| if var[k] > 0.0 && spread > 0.0 { cov[k] / (var[k] * spread).sqrt() } else { 0.0 };
    let axis = (0..3).max_by(|&a, &b| r(a).abs().total_cmp(&r(b).abs())).unwrap_or(0);
    let slope = if var[axis] > 0.0 { cov[axis] / var[axis] } else { 0.0 };
    Lattice::parameters(fit.first.counts)
        .map(|stu| (mean_way + slope * (stu[axis] - mean[axis])).clamp(0.0, 1.0))
        .collect()
}

impl Segment {
    fn lattice(&self, organ: &str, day: f64, motion: &Motion) -> Lattice {
        let (law, straight) = (&motion.law, motion.spec.straight);
        let [from, to, day] = [self.from, self.to, day].map(|d| d + motion.start);
        let (first, last) = (&self.fit.first.points, &self.fit.last.points);
        let g = |axis, along: f64| law.progress(organ, axis, along, from, to, day);
        // Many control points share a position: it is computed once.
        let mut known: Vec<(f64, DVec3)> = Vec::new();
        let mut pace = |along: f64| {
            if let Some((_, v)) = known.iter().find(|(a, _)| (a - along).abs() < 1e-9) {
                return *v;
            }
            let v = if straight {
                DVec3::new(g(Quantity::X, along), g(Quantity::Y, along), g(Quantity::Z, along))
            } else {
                DVec3::splat(law.pace_at(organ, along, from, to, day))
            };
            known.push((along, v));
            v
        };
        let whole = pace(0.5).x;
        let mut points = Vec::with_capacity(first.len());
        let turn = base::turn::part(self.fit.turn, whole);
        let back = self.fit.turn.inverse();
        let base = self.fit.first_base.lerp(self.fit.last_base, whole);
        for ((p, q), along) in first.iter().zip(last).zip(&self.along) {
            let g = pace(*along);
            points.push(if straight {
                *p + (*q - *p) * g
            } else {
                // In the frame that turns with the organ.
                let a = *p - self.fit.first_base;
                let b = back * (*q - self.fit.last_base);
                base + turn * (a + (b - a) * g)
            });
        }
        Lattice { counts: self.fit.first.counts, points }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SegmentSpec, compare, single_organ};
    use base::{Draw, Seed, ops};

    /// Makes a petal that opens: longer and bent outwards by the share `g`.
    fn petal(g: f64, seed: u64, n: usize) -> Vec<DVec3> {
        let mut s = Seed::new(seed).stream(Draw::Test);
        let length = 0.04 + 0.02 * g;
        (0..n)
            .map(|_| {
                let (v, u) = (s.uniform(), s.range(-1.0, 1.0));
                let half = 0.3 * length * ops::sin(ops::PI * (0.08 + 0.84 * v)) + 0.001;
                let angle = 0.2 + 0.9 * g * v;
                let (sin, cos) = ops::sin_cos(angle);
                DVec3::new(u * half, length * v * cos, length * v * sin + 0.1 * u * u * half)
            })
            .collect()
    }

    fn stage(day: f64, g: f64, seed: u64) -> Stage {
        let spec = SegmentSpec { foot: Some(DVec3::ZERO), ..SegmentSpec::default() };
        let mut organ = single_organ(&petal(g, seed, 2500), "petal-1", &spec, &Run::plain()).unwrap();
        organ.base = DVec3::ZERO;
        Stage { day, organs: vec![organ] }
    }

    #[test]
    fn ends_are_met_and_the_day_between_is_near_the_truth() {
        let truth = crate::Logistic { k: 1.0, p0: 0.1, r: 0.9, offset: 0.0 };
        let share = |d: f64| (truth.value(d) - 0.1) / (truth.value(6.0) - 0.1);
        let days = [0.0, 1.5, 3.0, 4.5, 6.0];
        let stages: Vec<Stage> = days.iter().map(|&d| stage(d, share(d), ops::cbrt(d).to_bits())).collect();
        let law = crate::fit_stages("made", &stages, &crate::LawSpec::default(), &Run::plain()).unwrap();
        let run = Run::plain();
        let ends = [stages[0].clone(), stages[4].clone()];
        let motion = Motion::new(&ends, law, MotionSpec::default(), &run).unwrap();
        let start = motion.points_on_day(0.0, &run).unwrap();
        assert!(start.iter().zip(&stages[0].organs[0].points).all(|(a, b)| a.distance(*b) < 1e-9), "day 0");
        for (day, limit) in [(1.5, 0.0011), (3.0, 0.0013), (4.5, 0.0013), (6.0, 0.0011)] {
            let measured = petal(share(day), 77, 2500);
            let e = compare(&measured, &motion.points_on_day(day, &run).unwrap(), &run).unwrap();
            assert!(e.to_model.mean < limit && e.to_scan.mean < limit, "day {day}: {e:?}");
        }
    }

    #[test]
    fn an_organ_that_comes_later_grows_out_of_its_base() {
        let run = Run::plain();
        let (a, mut b) = (stage(0.0, 0.0, 1), stage(2.0, 0.2, 2));
        let mut new = b.organs[0].clone();
        new.name = "new-leaf-2".into();
        b.organs.push(new.clone());
        let law = GrowthLaw::logistic("x", 2.0, 2.0);
        let motion = Motion::new(&[a, b], law, MotionSpec::default(), &run).unwrap();
        assert_eq!(motion.organs.len(), 2);
        let reach = |day: f64| {
            let p = motion.points_on_day(day, &run).unwrap();
            p[motion.organs[1].1.clone()].iter().map(|p| p.distance(new.base)).fold(0.0, f64::max)
        };
        assert!(reach(0.0) < 0.003 && reach(0.0) < reach(1.0) && reach(1.0) < reach(2.0), "it grows");
        let end = motion.points_on_day(2.0, &run).unwrap();
        assert!(end[motion.organs[1].1.clone()].iter().zip(&new.points).all(|(a, b)| a.distance(*b) < 1e-12));
    }

    /// An organ that appears on a third day must not get the name of another that appeared on the second.
    #[test]
    fn one_name_is_one_organ_on_all_days() {
        let at = |name: &str, tip: DVec3| ScanOrgan {
            name: name.into(),
            points: vec![tip; 9],
            tip,
            ..ScanOrgan::default()
        };
        let stem = || at("stem", DVec3::Y);
        let day = |day: f64, organs: Vec<ScanOrgan>| Stage { day, organs };
        let first = day(0.0, vec![stem(), at("leaf-1", DVec3::X)]);
        let second = day(1.0, vec![stem(), at("leaf-1", DVec3::X), at("new-leaf-2", DVec3::NEG_X)]);
        // The larger of its leaves is the new one of the day before, and one more is new.
        let mut third =
            vec![stem(), at("leaf-1", DVec3::NEG_X), at("leaf-3", DVec3::X), at("leaf-2", DVec3::Z * 3.0)];
        name_alike(&[first.clone(), second.clone()], &mut third, DVec3::Y);
        let names: Vec<&str> = third.iter().map(|o| o.name.as_str()).collect();
        assert_eq!(names, ["stem", "new-leaf-2", "leaf-1", "new-leaf-1"]);
        // Nor that of an organ that vanished before.
        let mut fourth = vec![stem(), at("leaf-1", DVec3::X), at("leaf-2", DVec3::NEG_Z * 9.0)];
        name_alike(&[second, first], &mut fourth, DVec3::Y);
        assert_eq!((fourth[1].name.as_str(), fourth[2].name.as_str()), ("leaf-1", "new-leaf-1"));
    }

    #[test]
    fn one_stage_is_an_error() {
        let e = Motion::new(
            &[stage(0.0, 0.0, 1)],
            GrowthLaw::logistic("x", 1.0, 1.0),
            MotionSpec::default(),
            &Run::plain(),
        );
        assert!(matches!(e, Err(BloomError::TooFew { is: 1, .. })), "{e:?}");
    }
}
