//! The rule about shading: lines that make a part of the plant dark and are no parts themselves.

use base::ops;
use glam::DVec2;
use ink::StrokeClass;

use super::{CLOSED, Findings, STRIDE, openness, share_inside, unsure};
use crate::corolla::dips;
use crate::draft::Draft;
use crate::thresholds::STRAIGHT;

/// Depth of the sweeps of a line that is shading, as a share of its breadth.
const SWEEP: f64 = 0.3;
/// Fewest sweeps to and fro of a line that is shading, both ends among them.
const SWEEPS: usize = 5;
/// Number of directions in which a line is examined.
const SIDES: u32 = 8;
/// Shading lies in its outline with more than this share of its points: the hand is quick.
const MOSTLY: f64 = 0.7;
/// Fewest short arcs in a crown that are shading; they touch nothing.
const ARCS: usize = 3;
/// Such an arc is more open than this.
const ARC_OPEN: f64 = 0.3;
/// Such an arc is shorter than this share of the crown's outline.
const ARC: f64 = 0.15;
/// Fewest lines side by side in a crown that are shading.
const HATCHES: usize = 4;
/// Such lines run in one direction: the cosine between them is above this.
const ALIKE: f64 = 0.95;
/// Such lines touch nothing within this distance.
const TOUCHES: f64 = 0.012;

/// Finds the shading of an outline: lines to and fro in it, and lines side by side in a crown.
pub(super) fn shading(draft: &Draft<'_>) -> Findings {
    use StrokeClass::{Axis, Blade, Crown, Disc, Scribble, TrunkOutline, Vein};
    let mut found = Findings::default();
    let strokes = &draft.ink.strokes;
    let outlines: Vec<(usize, &[DVec2])> = (0..draft.class.len())
        .filter(|&k| [Blade, Crown, TrunkOutline].contains(&draft.class[k]) && openness(&strokes[k]) < CLOSED)
        .filter_map(|k| Some((k, strokes[k].outline()?)))
        .collect();
    let within = |k: usize, outline: &[DVec2]| share_inside(&strokes[k].points, STRIDE, outline) > MOSTLY;
    // The disc of a flower is often a coil.
    for k in (0..draft.class.len()).filter(|&k| unsure(draft, k) && draft.class[k] != Disc) {
        let larger = |o: &usize| strokes[*o].length > 0.5 * strokes[k].length;
        let mut around = outlines.iter().filter(|(o, outline)| *o != k && larger(o) && within(k, outline));
        if sweeps(&strokes[k].points) && around.next().is_some() {
            found.settle(k, Scribble);
        }
    }
    for (crown, outline) in outlines.iter().filter(|(k, _)| draft.class[*k] == Crown) {
        let lines: Vec<usize> = (0..draft.class.len())
            .filter(|&k| unsure(draft, k) && k != *crown && [Axis, Blade, Vein].contains(&draft.class[k]))
            .filter(|&k| openness(&strokes[k]) > ARC_OPEN && within(k, outline))
            .filter(|&k| !touches(draft, k, *crown))
            .collect();
        let way = |k: usize| {
            let p = &strokes[k].points;
            (p[p.len() - 1] - p[0]).normalize_or_zero()
        };
        let arc = |k: &&usize| strokes[**k].length < ARC * strokes[*crown].length;
        let arcs: Vec<usize> = lines.iter().filter(arc).copied().collect();
        if arcs.len() >= ARCS {
            arcs.into_iter().for_each(|k| found.settle(k, Scribble));
        }
        for &k in lines.iter().filter(|&&k| openness(&strokes[k]) > STRAIGHT) {
            if lines.iter().filter(|&&o| way(o).dot(way(k)).abs() > ALIKE).count() >= HATCHES {
                found.settle(k, Scribble);
            }
        }
    }
    found
}

/// Whether a line begins or ends at another, other than the crown that it lies in.
fn touches(draft: &Draft<'_>, k: usize, crown: usize) -> bool {
    let p = &draft.ink.strokes[k].points;
    let near = |q: DVec2| {
        (0..draft.class.len()).filter(|&o| o != k && o != crown).any(|o| {
            let other = &draft.ink.strokes[o].points;
            geom::distance_to_polyline(other, q).is_some_and(|d| d < TOUCHES)
        })
    };
    near(p[0]) || near(p[p.len() - 1])
}

/// Whether a line goes to and fro in any of the directions.
fn sweeps(points: &[DVec2]) -> bool {
    (0..SIDES).any(|i| {
        let (s, c) = ops::sin_cos(ops::PI * f64::from(i) / f64::from(SIDES));
        let across: Vec<f64> = points.iter().map(|p| p.dot(DVec2::new(c, s))).collect();
        let (lo, hi) =
            across.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &x| (a.min(x), b.max(x)));
        dips(&across, SWEEP * (hi - lo)).len() >= SWEEPS
    })
}
