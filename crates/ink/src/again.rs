//! Lines that were drawn again: a hand that seeks its line, or makes it bold, goes over it a second time.
//!
//! `clean strokes -> rows of strokes that follow another all the way, with the row of that one`

use base::CancelToken;
use geom::closest_on_polyline;
use glam::DVec2;

/// Most strokes of a drawing that is searched: nobody draws one plant with more lines twice, and pairs are compared.
const MOST_STROKES: usize = 400;
/// Largest mean distance of the two lines; the sides of a trunk or the edges of a leaf are farther apart.
const NEAR: f64 = 0.006;
/// Largest distance of the two lines anywhere.
const FAR: f64 = 0.013;
/// [`NEAR`] as a share of the length, which keeps small petals apart.
const NEAR_SHARE: f64 = 0.02;
/// [`FAR`] as a share of the length.
const FAR_SHARE: f64 = 0.045;
/// Number of points of a line that are compared.
const LOOKED: usize = 32;
/// Cosine above which two steps lead the same way.
const ALONG: f64 = 0.8;
/// Least share of the steps that lead the same way.
const STEPS_ALONG: f64 = 0.85;
/// Length of the path along the other line, as a share of the line's: the line follows it and does not sweep to and
/// fro.
const AS_LONG: core::ops::Range<f64> = 0.75..1.3;
/// Ends nearer than this share of the length close a line, which may then begin anywhere round the other.
const CLOSED: f64 = 0.1;

/// Returns the rows of strokes that follow another one all the way, each with the row of that one, ascending.
///
/// The other is the longer one, or the earlier of two equal ones, and itself follows none. Quadratic in strokes up to
/// 400; beyond that nothing is found.
///
/// `strokes`: points and length of each; `alike`: whether two may be the same line, by mode and colour. A cancelled run
/// ends soon, with a partial result.
pub(crate) fn drawn_again(
    strokes: &[(&[DVec2], f64)],
    alike: impl Fn(usize, usize) -> bool,
    cancel: &CancelToken,
) -> Vec<(usize, usize)> {
    if !(2..=MOST_STROKES).contains(&strokes.len()) {
        return Vec::new();
    }
    let boxes: Vec<(DVec2, DVec2)> = strokes.iter().map(|s| geom::bounds(s.0).unwrap_or_default()).collect();
    let mut order: Vec<usize> = (0..strokes.len()).collect();
    base::sort_by(&mut order, |&a, &b| strokes[b].1.total_cmp(&strokes[a].1).then(a.cmp(&b)));
    let mut first: Vec<usize> = Vec::new();
    let mut again = Vec::new();
    for row in order {
        if cancel.check().is_err() {
            break;
        }
        let (s, (lo, hi)) = (strokes[row], boxes[row]);
        let far = FAR.min(FAR_SHARE * s.1);
        let holds = |other: &&usize| {
            let (from, to) = boxes[**other];
            (from - far).cmple(lo).all() && (to + far).cmpge(hi).all()
        };
        let found =
            first.iter().filter(holds).find(|&&other| alike(row, other) && follows(s, strokes[other]));
        match found {
            Some(&other) => again.push((row, other)),
            None => first.push(row),
        }
    }
    again.sort_unstable();
    again
}

/// Whether a stroke follows another one all the way.
fn follows((points, length): (&[DVec2], f64), (other, whole): (&[DVec2], f64)) -> bool {
    let (near, far) = (NEAR.min(NEAR_SHARE * length), FAR.min(FAR_SHARE * length));
    let stride = (points.len() / LOOKED).max(1);
    let mut looked: Vec<DVec2> = points.iter().step_by(stride).copied().collect();
    looked.extend(points.last());
    let (mut sum, mut places) = (0.0, Vec::with_capacity(looked.len()));
    for &p in &looked {
        let Some(c) = closest_on_polyline(other, p).filter(|c| c.distance <= far) else {
            return false;
        };
        sum += c.distance;
        places.push((c.at, c.point));
    }
    if sum > near * looked.len() as f64 {
        return false;
    }
    let ring = other[0].distance(other[other.len() - 1]) < CLOSED * whole;
    let (mut way, mut along, mut steps) = (0.0, 0_usize, 0_usize);
    for (a, b) in looked.windows(2).zip(places.windows(2)) {
        let gone = (b[1].0 - b[0].0).abs();
        way += if ring { gone.min((whole - gone).abs()) } else { gone };
        let (own, its) = (a[1] - a[0], b[1].1 - b[0].1);
        steps += 1;
        along += usize::from(own.dot(its).abs() > ALONG * own.length() * its.length());
    }
    // If a line is drawn again in pieces, each piece leads the same way.
    AS_LONG.contains(&(way / length)) && along as f64 >= STEPS_ALONG * steps as f64
}

#[cfg(test)]
mod tests {
    use base::{Report, ops};

    use super::*;
    use crate::Drawing;

    fn found(lines: &[Vec<DVec2>]) -> Vec<(usize, usize)> {
        crate::clean(&Drawing::from_polylines("again", lines), &mut Report::default()).subjects.again
    }

    fn ring(x: f64, y: f64, r: f64, from: f64) -> Vec<DVec2> {
        (0..=60)
            .map(|i| from + ops::TAU * f64::from(i) / 60.0)
            .map(|a| DVec2::new(x + r * ops::cos(a), y + r * ops::sin(a)))
            .collect()
    }

    fn line(a: (f64, f64), b: (f64, f64)) -> Vec<DVec2> {
        let (a, b) = (DVec2::from(a), DVec2::from(b));
        (0..=40).map(|i| a.lerp(b, f64::from(i) / 40.0)).collect()
    }

    #[test]
    fn lines_and_rings_that_are_drawn_twice_are_found_whichever_way_they_go() {
        let stem = line((100.0, 0.0), (110.0, 600.0));
        let back: Vec<DVec2> =
            stem.iter().rev().map(|p| *p + DVec2::new(2.0 * ops::sin(p.y / 90.0), 0.0)).collect();
        let piece = stem[8..30].iter().map(|p| *p + DVec2::new(-2.0, 0.0)).collect();
        let lines = [stem, ring(110.0, 700.0, 100.0, 0.3), back, ring(111.0, 699.0, 101.0, 2.5), piece];
        // The longer one counts as the line.
        assert_eq!(found(&lines), [(0, 2), (1, 3), (4, 2)]);
    }

    #[test]
    fn sides_of_a_trunk_narrow_leaves_veins_and_shading_are_not() {
        let sides = [line((100.0, 0.0), (104.0, 600.0)), line((116.0, 0.0), (114.0, 600.0))];
        let half = |side: f64| -> Vec<DVec2> {
            (0..=40)
                .map(|i| f64::from(i) / 40.0)
                .map(|t| DVec2::new(side * 14.0 * ops::sin(ops::PI * t), 500.0 * t))
                .collect()
        };
        // A zigzag over a line, the stalk that continues a rib, two petals that meet.
        let zigzag = (0..=60)
            .map(|i| DVec2::new(if i % 2 == 0 { 96.0 } else { 104.0 }, 8.0 * f64::from(i % 20)))
            .collect();
        let shading = [line((100.0, 0.0), (100.0, 600.0)), zigzag];
        let meet = [line((0.0, 0.0), (0.0, 300.0)), line((0.0, 260.0), (0.0, 600.0))];
        for lines in [&sides[..], &[half(1.0), half(-1.0)], &shading, &meet] {
            assert_eq!(found(lines), [], "{lines:?}");
        }
    }
}
