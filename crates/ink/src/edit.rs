//! Edits of a stroke by hand: `Stroke -> Stroke`. Mode, colour and name stay.
//!
//! Points added between two samples get interpolated times and pressures. For samples that are not finite, the only
//! guarantee is that no function panics; a result may overflow where the numbers are near the largest ones.

use base::ops;
use geom::{closest_on_polyline, distance_to_polyline};
use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{InkSample, Stroke};

/// Least pieces that the pulled part of a line has on either side.
const PULL_PIECES: f64 = 12.0;
/// Step of a cut by the rubber, as a share of its radius.
const RUB_STEP: f64 = 0.25;
/// Most pieces that one piece of a line is cut into.
const MOST_PIECES: f64 = 1000.0;
/// Number of even steps in which a line is smoothed.
const SMOOTH_STEPS: u32 = 400;
/// Steps that Eq 1 reaches on either side: 2 % of the line.
const SMOOTH_WINDOW: usize = 8;
/// A line is closed if its ends are nearer than this share of the diagonal of its box.
const CLOSED: f64 = 0.1;

/// A rotation and scaling about a point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrokeTurn {
    /// Fixed point, in the drawing's unit.
    #[schemars(with = "[f64; 2]")]
    pub about: DVec2,
    /// Rotation counter-clockwise, degrees.
    pub angle_deg: f64,
    /// Factors of size along x and y before the turn; a negative one mirrors.
    #[schemars(with = "[f64; 2]")]
    pub scale: DVec2,
}

impl StrokeTurn {
    /// Returns the stroke turned and scaled. Linear in samples.
    pub fn apply(&self, stroke: &Stroke) -> Stroke {
        let (sin, cos) = ops::sin_cos(self.angle_deg.to_radians());
        let turned = |p: DVec2| {
            let q = (p - self.about) * self.scale;
            self.about + DVec2::new(q.x * cos - q.y * sin, q.x * sin + q.y * cos)
        };
        let mut stroke = stroke.clone();
        stroke.samples.iter_mut().for_each(|s| s.at = turned(s.at));
        stroke
    }
}

/// A bend of a line by a pull.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrokePull {
    /// Point of the grip; the nearest point of the line counts. The drawing's unit.
    #[schemars(with = "[f64; 2]")]
    pub at: DVec2,
    /// Vector of the pull.
    #[schemars(with = "[f64; 2]")]
    pub by: DVec2,
    /// Reach of the pull along the line, above 0.
    pub reach: f64,
}

impl StrokePull {
    /// Returns the bent stroke: the held point moves by the whole pull, a point `u` reaches along the line from it by
    /// (1 - u^2)^2 of it, and points farther away stay. A line that closes is bent across its seam. Linear in samples.
    pub fn apply(&self, stroke: &Stroke) -> Stroke {
        let points = positions(stroke);
        let Some(held) = closest_on_polyline(&points, self.at) else { return stroke.clone() };
        let total = geom::polyline_length(&points);
        let closes = closes(&points);
        let reach = self.reach.max(1e-9 * total);
        let away = |at: f64| {
            let along = (at - held.at).abs();
            if closes { along.min((total - along).abs()) } else { along }
        };
        let step = reach / PULL_PIECES;
        let fine = finer(&stroke.samples, |from, to| {
            let near = away(from).min(away(to)) <= reach || (from <= held.at && held.at <= to);
            if near { step } else { f64::INFINITY }
        });
        let samples = along(&fine)
            .zip(&fine)
            .map(|(at, sample)| {
                let u = away(at) / reach;
                let share = if u < 1.0 { (1.0 - u * u) * (1.0 - u * u) } else { 0.0 };
                InkSample { at: sample.at + self.by * share, ..*sample }
            })
            .collect();
        Stroke { samples, ..stroke.clone() }
    }
}

/// Returns the stroke smoothed once more by Eq 1 (He and Cheng 2021), which reaches over 2 % of its length on either
/// side, in 400 even steps. Both ends of an open line stay; a line that closes stays closed. Linear in samples.
pub fn smoothed(stroke: &Stroke) -> Stroke {
    let total = geom::polyline_length(&positions(stroke));
    if !(total > 0.0 && total.is_finite()) {
        return stroke.clone();
    }
    let mut even = evenly(&stroke.samples, total);
    let mut line: Vec<DVec2> = even.iter().map(|s| s.at).collect();
    let reach = SMOOTH_WINDOW as f64 * total / f64::from(SMOOTH_STEPS);
    let c = reach * reach / 2.0;
    if closes(&line) {
        // The last point repeats the first.
        line.pop();
        line = geom::smooth_gaussian_closed(&line, SMOOTH_WINDOW, c);
        line.push(line[0]);
    } else {
        line = geom::smooth_gaussian(&line, SMOOTH_WINDOW, c);
    }
    even.iter_mut().zip(line).for_each(|(s, at)| s.at = at);
    Stroke { samples: even, ..stroke.clone() }
}

/// Returns samples at even distances along a line of this length, including the first and the last.
fn evenly(samples: &[InkSample], total: f64) -> Vec<InkSample> {
    let mut even = Vec::with_capacity(SMOOTH_STEPS as usize + 1);
    let (mut done, mut k) = (0.0, 0);
    for pair in samples.windows(2) {
        let length = pair[0].at.distance(pair[1].at);
        while k < SMOOTH_STEPS && total * f64::from(k) / f64::from(SMOOTH_STEPS) <= done + length {
            let at = total * f64::from(k) / f64::from(SMOOTH_STEPS) - done;
            even.push(mix(
                &pair[0],
                &pair[1],
                if length > 0.0 { (at / length).clamp(0.0, 1.0) } else { 0.0 },
            ));
            k += 1;
        }
        done += length;
    }
    even.extend(samples.last().copied());
    even
}

/// Returns the two parts of a stroke before and after its point nearest to `at`; `None` if one of them would have no
/// length.
pub fn cut(stroke: &Stroke, at: DVec2) -> Option<[Stroke; 2]> {
    let points = positions(stroke);
    let found = closest_on_polyline(&points, at)?;
    let total = geom::polyline_length(&points);
    if found.at <= 1e-6 * total || found.at >= (1.0 - 1e-6) * total {
        return None;
    }
    let between = mix(&stroke.samples[found.index], stroke.samples.get(found.index + 1)?, found.t);
    let mut before = stroke.samples[..=found.index].to_vec();
    before.push(between);
    let mut after = vec![between];
    after.extend_from_slice(&stroke.samples[found.index + 1..]);
    Some([before, after].map(|samples| Stroke { samples, ..stroke.clone() }))
}

/// Joins several strokes into one, which begins with the first and repeatedly continues with the stroke whose end is
/// nearest to either end of the result. Mode, colour and name are the first one's; times are unknown. Quadratic in
/// strokes.
pub fn joined(strokes: &[&Stroke]) -> Option<Stroke> {
    let mut rest: Vec<&Stroke> = strokes.iter().copied().filter(|s| !s.samples.is_empty()).collect();
    let &first = rest.first()?;
    let mut line = rest.remove(0).samples.clone();
    while !rest.is_empty() {
        let (head, tail) = (line[0].at, line[line.len() - 1].at);
        let ways = |(row, s): (usize, &&Stroke)| {
            let (a, b) = (s.samples[0].at, s.samples[s.samples.len() - 1].at);
            let each = [(tail, a), (tail, b), (head, b), (head, a)];
            (0..4).map(move |way| (each[way].0.distance_squared(each[way].1), row, way))
        };
        let best = rest.iter().enumerate().flat_map(ways).min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, row, way)) = best else { break };
        let mut next = rest.remove(row).samples.clone();
        if way % 2 == 1 {
            next.reverse();
        }
        if way < 2 {
            line.append(&mut next);
        } else {
            next.append(&mut line);
            line = next;
        }
    }
    line.iter_mut().for_each(|s| s.time_ms = None);
    line.dedup_by(|b, a| a.at == b.at);
    Some(Stroke { samples: line, ..first.clone() })
}

/// Returns the parts of a stroke that a round rubber of this radius, moved along `path`, leaves; `None` if it touches
/// nothing.
///
/// A piece that is shorter than the radius is removed, too. Cost: samples times the points of the path, for samples
/// near it.
pub fn rubbed(stroke: &Stroke, path: &[DVec2], radius: f64) -> Option<Vec<Stroke>> {
    let usable = radius > 0.0 && radius.is_finite();
    let points = positions(stroke);
    let path = &near_box(path, corners(&points), radius)[..];
    let far = |p: DVec2| distance_to_polyline(path, p).is_none_or(|d| d > radius);
    let near = |a: DVec2, b: DVec2| {
        let middle = a.midpoint(b);
        distance_to_polyline(path, middle).is_some_and(|d| d <= radius + a.distance(b) / 2.0)
    };
    let alone = points.len() == 1 && !far(points[0]);
    if path.is_empty() || !usable || !(alone || points.windows(2).any(|w| near(w[0], w[1]))) {
        return None;
    }
    let mut row = 0;
    let fine = finer(&stroke.samples, |_, _| {
        let touched = points.get(row..row + 2).is_some_and(|w| near(w[0], w[1]));
        row += 1;
        if touched { RUB_STEP * radius } else { f64::INFINITY }
    });
    let kept: Vec<bool> = fine.iter().map(|s| far(s.at)).collect();
    if kept.iter().all(|&k| k) {
        return None;
    }
    let pieces = fine.iter().zip(&kept).collect::<Vec<_>>();
    let pieces = pieces
        .split(|(_, kept)| !**kept)
        .map(|piece| Stroke { samples: piece.iter().map(|(s, _)| **s).collect(), ..stroke.clone() });
    Some(pieces.filter(|piece| geom::polyline_length(&positions(piece)) > radius).collect())
}

fn positions(stroke: &Stroke) -> Vec<DVec2> {
    stroke.samples.iter().map(|s| s.at).collect()
}

/// Returns the part of a path, from the first to the last of its pieces, that comes near a box.
fn near_box(path: &[DVec2], (lo, hi): (DVec2, DVec2), radius: f64) -> Vec<DVec2> {
    let apart = |a: DVec2, b: DVec2| (a.min(b) - hi).max(lo - a.max(b)).max_element() > radius;
    let near: Vec<usize> = match path {
        [only] => (0..usize::from(!apart(*only, *only))).collect(),
        _ => (0..path.len().saturating_sub(1)).filter(|&k| !apart(path[k], path[k + 1])).collect(),
    };
    let ends = near.first().zip(near.last());
    ends.map_or_else(Vec::new, |(&first, &last)| path[first..(last + 2).min(path.len())].to_vec())
}

fn corners(points: &[DVec2]) -> (DVec2, DVec2) {
    points.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)))
}

fn closes(points: &[DVec2]) -> bool {
    let (lo, hi) = corners(points);
    let ends = points.first().zip(points.last());
    points.len() > 3 && ends.is_some_and(|(a, b)| a.distance(*b) < CLOSED * lo.distance(hi))
}

/// Returns the arc length at each sample.
fn along(samples: &[InkSample]) -> impl Iterator<Item = f64> {
    let mut done = 0.0;
    samples.iter().enumerate().map(move |(i, s)| {
        if i > 0 {
            done += samples[i - 1].at.distance(s.at);
        }
        done
    })
}

fn mix(a: &InkSample, b: &InkSample, t: f64) -> InkSample {
    let between = |a: Option<f64>, b: Option<f64>| Some(a? + (b? - a?) * t);
    InkSample {
        at: a.at + (b.at - a.at) * t,
        time_ms: between(a.time_ms, b.time_ms),
        pressure: between(a.pressure, b.pressure),
    }
}

/// Inserts samples, so that each piece is at most as long as `step` returns for the arc lengths at its ends; `step` is
/// called once for each piece, in their order.
fn finer(samples: &[InkSample], mut step: impl FnMut(f64, f64) -> f64) -> Vec<InkSample> {
    let mut fine = Vec::with_capacity(samples.len());
    let mut done = 0.0;
    for pair in samples.windows(2) {
        let length = pair[0].at.distance(pair[1].at);
        let pieces = (length / step(done, done + length)).ceil().clamp(1.0, MOST_PIECES);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 1,000")]
        let count = pieces as u32;
        fine.extend((0..count).map(|k| mix(&pair[0], &pair[1], f64::from(k) / pieces)));
        done += length;
    }
    fine.extend(samples.last().copied());
    fine
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[[f64; 2]]) -> Stroke {
        let samples = points.iter().map(|&p| InkSample::from(DVec2::from(p))).collect();
        Stroke { samples, color: Some([9, 8, 7]), ..Stroke::default() }
    }

    fn ring(corners: u32) -> Stroke {
        let at = |k: u32| std::f64::consts::TAU * f64::from(k) / f64::from(corners);
        line(&(0..=corners).map(|k| [100.0 * ops::cos(at(k)), 100.0 * ops::sin(at(k))]).collect::<Vec<_>>())
    }

    #[test]
    fn a_turn_keeps_what_it_is_about() {
        let turn = StrokeTurn { about: DVec2::new(1.0, 1.0), angle_deg: 90.0, scale: DVec2::splat(2.0) };
        let turned = positions(&turn.apply(&line(&[[1.0, 1.0], [2.0, 1.0]])));
        assert!(turned[0].distance(DVec2::new(1.0, 1.0)) < 1e-12);
        assert!(turned[1].distance(DVec2::new(1.0, 3.0)) < 1e-12, "{turned:?}");
    }

    #[test]
    fn a_pull_moves_what_is_held_and_leaves_what_is_far() {
        let stroke = line(&[[0.0, 0.0], [100.0, 0.0]]);
        let pull = StrokePull { at: DVec2::new(50.0, 3.0), by: DVec2::new(0.0, 10.0), reach: 20.0 };
        let bent = pull.apply(&stroke);
        let points = positions(&bent);
        let top = points.iter().map(|p| p.y).fold(0.0, f64::max);
        assert!((top - 10.0).abs() < 0.2, "{top}");
        for p in &points {
            assert!((p.x - 50.0).abs() < 20.0 || p.y == 0.0, "{p}");
        }
        // No corner appears: neighbouring points move alike.
        let bend = geom::turning_angles(&points).into_iter().map(f64::abs).fold(0.0, f64::max);
        assert!(bend < 0.3, "{bend}");
        assert_eq!(bent.color, stroke.color);
    }

    #[test]
    fn a_ring_is_pulled_across_its_seam() {
        let pull = StrokePull { at: DVec2::new(100.0, 0.0), by: DVec2::new(50.0, 0.0), reach: 60.0 };
        let points = positions(&pull.apply(&ring(64)));
        let (first, last) = (points[0], points[points.len() - 1]);
        assert!(first.distance(last) < 1e-9, "it stays closed: {first} {last}");
        assert!((first.x - 150.0).abs() < 1e-9);
        let mirrored = points.iter().filter(|p| p.x > 110.0).map(|p| p.y).sum::<f64>();
        assert!(mirrored.abs() < 1.0, "both sides alike: {mirrored}");
    }

    #[test]
    fn smoothing_calms_a_tremor_and_keeps_the_ends() {
        let shaky: Vec<[f64; 2]> =
            (0..=100).map(|k| [f64::from(k), if k % 2 == 0 { 1.0 } else { -1.0 }]).collect();
        let stroke = line(&shaky);
        let rough = |s: &Stroke| positions(s).iter().map(|p| p.y.abs()).sum::<f64>() / s.samples.len() as f64;
        let once = smoothed(&stroke);
        assert!(rough(&once) < 0.5 * rough(&stroke), "{} {}", rough(&once), rough(&stroke));
        // However densely the line was sampled, each smoothing helps, and the line does not grow.
        let wave = |k: i32| [f64::from(k) / 10.0, 3.0 * ops::sin(f64::from(k) / 50.0)];
        let dense = line(&(0..6000).map(wave).collect::<Vec<_>>());
        let mut last = dense.clone();
        for _ in 0..12 {
            let next = smoothed(&last);
            let calmer = rough(&next) < rough(&last) || rough(&next) < 0.1 * rough(&dense);
            assert!(calmer && next.samples.len() == 401, "{} {}", rough(&next), next.samples.len());
            last = next;
        }
        assert!(rough(&last) < 0.6 * rough(&dense), "{} {}", rough(&last), rough(&dense));
        assert_eq!(once.samples[0].at, stroke.samples[0].at);
        assert_eq!(once.samples[once.samples.len() - 1].at, stroke.samples[100].at);
    }

    #[test]
    fn a_ring_that_is_smoothed_stays_closed_and_a_hatching_keeps_its_ends() {
        let ring = smoothed(&ring(64));
        assert_eq!(ring.samples[0].at, ring.samples[ring.samples.len() - 1].at);
        let legs = |k: i32| [6.0 * f64::from(k), if k % 2 == 0 { 0.0 } else { 180.0 }];
        let hatching = line(&(0..30).map(legs).collect::<Vec<_>>());
        let (first, last) = (hatching.samples[0].at, hatching.samples[29].at);
        let pull = StrokePull { at: first, by: DVec2::NEG_X * 9.0, reach: 60.0 };
        assert_eq!(pull.apply(&hatching).samples.last().unwrap().at, last, "its end is far along the line");
        let smooth = smoothed(&hatching);
        assert_eq!((smooth.samples[0].at, smooth.samples.last().unwrap().at), (first, last));
    }

    #[test]
    fn what_is_cut_can_be_joined_whichever_way_it_runs() {
        let stroke = line(&[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]]);
        let [before, mut after] = cut(&stroke, DVec2::new(6.0, 1.0)).unwrap();
        assert_eq!(before.samples.last().unwrap().at, DVec2::new(6.0, 0.0));
        after.samples.reverse();
        let whole = joined(&[&after, &before]).unwrap();
        let length = geom::polyline_length(&positions(&whole));
        assert!((length - 20.0).abs() < 1e-12, "{length}");
        assert!(cut(&stroke, DVec2::new(-5.0, 0.0)).is_none(), "nothing is before its beginning");
    }

    #[test]
    fn times_come_from_between_their_neighbours() {
        let sample =
            |x: f64, t: f64| InkSample { at: DVec2::new(x, 0.0), time_ms: Some(t), pressure: Some(t / 10.0) };
        let stroke = Stroke { samples: vec![sample(0.0, 0.0), sample(10.0, 10.0)], ..Stroke::default() };
        let [before, _] = cut(&stroke, DVec2::new(2.5, 0.0)).unwrap();
        assert_eq!(before.samples[1], sample(2.5, 2.5));
    }

    #[test]
    fn a_rubber_leaves_the_pieces_beside_it() {
        let stroke = line(&[[0.0, 0.0], [100.0, 0.0]]);
        let path = [DVec2::new(50.0, -20.0), DVec2::new(50.0, 20.0)];
        let pieces = rubbed(&stroke, &path, 5.0).unwrap();
        assert_eq!(pieces.len(), 2);
        let ends: Vec<f64> =
            pieces.iter().flat_map(|p| [p.samples[0].at.x, p.samples[p.samples.len() - 1].at.x]).collect();
        assert!((ends[1] - 45.0).abs() < 1.5 && (ends[2] - 55.0).abs() < 1.5, "{ends:?}");
        assert!(rubbed(&stroke, &[DVec2::new(50.0, 20.0)], 5.0).is_none(), "it does not touch");
        let all = [DVec2::new(-5.0, 0.0), DVec2::new(105.0, 0.0)];
        assert_eq!(rubbed(&stroke, &all, 5.0), Some(Vec::new()));
        // A path that crosses between two samples far apart is found as well.
        assert_eq!(rubbed(&stroke, &[DVec2::new(31.0, 1.0)], 2.0).unwrap().len(), 2);
    }

    #[test]
    fn hostile_strokes_do_no_harm() {
        let nan = line(&[[f64::NAN, 0.0], [1.0, f64::INFINITY], [2.0, 2.0]]);
        for stroke in [Stroke::default(), line(&[[1.0, 1.0]]), line(&[[1.0, 1.0], [1.0, 1.0]]), nan] {
            let pull = StrokePull { at: DVec2::ZERO, by: DVec2::X, reach: 0.0 };
            let _ = (pull.apply(&stroke), smoothed(&stroke), cut(&stroke, DVec2::ZERO));
            let _ = (rubbed(&stroke, &[DVec2::ZERO], 1.0), joined(&[&stroke, &stroke]));
            let _ = StrokeTurn { about: DVec2::NAN, angle_deg: f64::NAN, scale: DVec2::X }.apply(&stroke);
        }
        assert!(joined(&[]).is_none());
    }
}
