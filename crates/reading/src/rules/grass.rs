//! Rules about grass: lines that carry nothing.

use glam::DVec2;
use ink::StrokeClass;

use super::{Findings, any, openness, unsure};
use crate::corolla::{dips, winding};
use crate::draft::Draft;
use crate::thresholds::STRAIGHT;
use geom::bounds;

/// A row of grass goes down at least this often.
const FEWEST_DIPS: usize = 5;
/// A row turns about its middle by less than this, radians; petals go round.
const AROUND: f64 = 4.5;
/// Fewest lines that are grass.
const FEWEST_STALKS: usize = 4;
/// A blade of grass is no longer than its chord by more than this share.
const BARE: f64 = 0.85;
/// A row goes on to the side by more than this share of its width.
const ONWARDS: f64 = 0.6;
/// It dips by this share of its height.
const DIP: f64 = 0.3;
/// A leg of a tuft is longer than this share of the stroke's diagonal.
const LEG: f64 = 0.25;
/// The legs of a tuft are apart by more than this share of the shorter one.
const APART: f64 = 0.15;
/// Distance from the root at which the turn between the legs is measured, as a share of the diagonal.
const AT_TURN: f64 = 0.06;
/// The turn is sharper than 114 degrees: the cosine between the legs is above minus this.
const SHARP: f64 = 0.4;

/// Finds rows of grass blades: strokes that go up and down and on to the side, if no trunk needs a crown.
pub(super) fn zigzags(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Axis, Crown, Other, Scribble, TrunkOutline};
    let mut found = Findings::default();
    let zigzag = |k: usize| {
        let s = &draft.ink.strokes[k];
        let Some((lo, hi)) = bounds(&s.points) else { return false };
        let heights: Vec<f64> = s.points.iter().map(|p| p.y - lo.y).collect();
        let on = (s.points[s.points.len() - 1].x - s.points[0].x).abs() > ONWARDS * (hi.x - lo.x);
        let cuts = dips(&heights, DIP * (hi.y - lo.y)).len();
        on && cuts >= FEWEST_DIPS && winding(&s.points, lo.midpoint(hi)) < AROUND
    };
    let rows: Vec<usize> = (0..draft.class.len())
        .filter(|&k| {
            unsure(draft, k) && [Axis, Crown, Other, Scribble, TrunkOutline].contains(&draft.class[k])
        })
        .filter(|&k| zigzag(k))
        .collect();
    // A line that lies next to the row continues it; an outline that stands is a plant of another kind.
    let (lying, standing): (Vec<usize>, Vec<usize>) =
        draft.strokes_of_class(TrunkOutline).into_iter().filter(|k| !rows.contains(k)).partition(|&k| {
            let s = &draft.ink.strokes[k];
            let wide = bounds(&s.points).is_some_and(|(lo, hi)| hi.y - lo.y < 0.5 * (hi.x - lo.x));
            wide && openness(s) > 0.5 && unsure(draft, k)
        });
    if standing.is_empty() && !rows.is_empty() {
        rows.into_iter().for_each(|k| found.set(k, StrokeClass::Corolla));
        lying.into_iter().for_each(|k| found.set(k, StrokeClass::Ground));
    }
    found
}

/// Finds blades of grass drawn in one go, down to the root and up again: a crown or fruit has no sharp point below
/// from which two bare lines rise.
pub(super) fn tufts(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Axis, Blade, Corolla, Crown, Disc, Fruit, Other, Pot, TrunkOutline};
    let mut found = Findings::default();
    if draft.trunk || any(draft, &[Blade, Corolla, Disc, Pot]) {
        return found;
    }
    for k in 0..draft.class.len() {
        if !unsure(draft, k) || ![Crown, Fruit, Other, TrunkOutline].contains(&draft.class[k]) {
            continue;
        }
        if let Some(legs) = two_legs(&draft.ink.strokes[k].points) {
            found.set(k, Axis);
            found.legs.push((k, legs));
        }
    }
    found
}

/// Returns both sides of a line with one sharp turn at its lowest point, if each is almost straight and they are apart
/// above.
fn two_legs(points: &[DVec2]) -> Option<[Vec<DVec2>; 2]> {
    let (lo, hi) = bounds(points)?;
    let low = (0..points.len()).min_by(|&a, &b| points[a].y.total_cmp(&points[b].y))?;
    let (left, right) = (&points[..=low], &points[low..]);
    let bare = |leg: &[DVec2]| {
        let run = leg[0].distance(leg[leg.len() - 1]);
        run > BARE * geom::polyline_length(leg) && run > LEG * lo.distance(hi)
    };
    let (a, b) = (points[0] - points[low], points[points.len() - 1] - points[low]);
    // Sharp at the turn itself, too: a trough is no root.
    let far = |p: &&DVec2| p.distance(points[low]) > AT_TURN * lo.distance(hi);
    let turn = left.iter().rev().find(far).zip(right.iter().find(far));
    let turn = turn.map(|(u, v)| (*u - points[low], *v - points[low]));
    let sharp = turn.is_some_and(|(u, v)| u.dot(v) > -SHARP * u.length() * v.length());
    let apart = (a - b).length() > APART * a.length().min(b.length());
    (bare(left) && bare(right) && sharp && apart).then(|| [left.to_vec(), right.to_vec()])
}

/// Finds several single lines where nothing needs a trunk: stalks of grass, not sides of trunks.
pub(super) fn grass(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Axis, Blade, Corolla, Crown, Disc, Fruit, Scribble, TrunkOutline};
    let mut found = Findings::default();
    if draft.trunk || any(draft, &[Crown, Corolla, Blade, Disc, Scribble]) {
        return found;
    }
    let line = |k: usize| {
        [Axis, TrunkOutline, Fruit].contains(&draft.class[k]) && openness(&draft.ink.strokes[k]) > STRAIGHT
    };
    let lines: Vec<usize> = (0..draft.class.len()).filter(|&k| line(k)).collect();
    let outlines = (0..draft.class.len())
        .any(|k| draft.class[k] == TrunkOutline && openness(&draft.ink.strokes[k]) <= STRAIGHT);
    if lines.len() >= FEWEST_STALKS && !outlines {
        for k in lines {
            if unsure(draft, k) {
                found.set(k, Axis);
            }
        }
    }
    found
}
