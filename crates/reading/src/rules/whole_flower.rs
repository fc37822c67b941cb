//! The rule about a whole flower: outlines all round a ring, or one lobed outline round it.
//!
//! As in the rule about a whole tree, only shapes and places count.

use base::ops;
use geom::{bounds, contains, distance_to_polyline, signed_area, widest_gap};
use glam::DVec2;
use ink::StrokeClass;

use super::{Findings, SHUT, openness, unsure};
use crate::Kind;
use crate::corolla::{dips, is_cup};
use crate::draft::Draft;
use crate::thresholds::STRAIGHT;

/// Fewest petals round a disc.
const FEWEST: usize = 4;
/// The middle of a petal that begins under the disc lies at least at this share of its farthest point.
const UNDER: f64 = 0.4;
/// Greatest angle between two neighbouring petals, radians.
const WIDEST: f64 = 2.2;
/// Most outlines of a flower in a few strokes: each is compared with each.
const MOST: usize = 80;
/// An outline of less area is a dot.
const NO_AREA: f64 = 1e-5;
/// An outline whose squared length is more than this factor of its area is a scribble (12.6 for a circle,
/// *geometry*).
const SCRIBBLE: f64 = 60.0;
/// Least ratio of the shorter to the longer side of a ring's box.
const ROUND: f64 = 0.6;
/// A petal next to the disc keeps more than this share of the disc's radius away from the disc's middle.
const BESIDE: f64 = 0.2;
/// The middle of a petal lies farther than this share of the disc's radius from the disc's middle.
const OUTSIDE: f64 = 0.8;
/// A petal begins within this number of disc radii, and a share of its own radius, of the disc's middle.
const AT_DISC: f64 = 1.5;
/// That share of its own radius for petals at their disc.
const AT_PETAL: f64 = 0.1;
/// That factor of its own radius for petals that stand off their disc.
const OFF_DISC: f64 = 1.6;
/// Fewest petals that stand off their disc.
const RING: usize = 5;
/// Between two of these no angle is wider than this, radians.
const RING_GAP: f64 = 1.7;
/// Circles touch if their middles are nearer than this factor of the sum of their radii (1 for true circles,
/// *geometry*).
const TOUCH: f64 = 1.15;
/// Radius of a berry behind others relative to their usual radius.
const BERRY: core::ops::Range<f64> = 0.6..1.6;
/// A disc is smaller than this factor of its petals.
const LARGEST_DISC: f64 = 2.5;
/// The disc of a lobed corolla is this near to the corolla's middle, as a share of its radius.
const CENTRAL: f64 = 0.25;
/// Radius of that disc as a share of the corolla's radius.
const SIZED: core::ops::Range<f64> = 0.1..0.7;
/// Depth of a dip between lobes, as a share of the reach.
const LOBE: f64 = 0.12;

/// A stem ends within this share of a cup's size of the cup.
const STEM_AT: f64 = 0.1;

struct Loop {
    stroke: usize,
    hull: Vec<DVec2>,
    middle: DVec2,
    /// Radius of a circle of its area.
    radius: f64,
    round: bool,
}

/// Finds petals round a disc, each an outline or all in one go.
pub(super) fn whole_flower(draft: &Draft<'_>) -> Findings {
    let mut found = Findings::default();
    if draft.kind.is_some_and(|kind| !kind.is_like(Kind::Flower)) {
        return found;
    }
    let loops: Vec<Loop> =
        (0..draft.class.len()).filter(|&k| unsure(draft, k)).filter_map(|k| loop_of(draft, k)).collect();
    if loops.len() > MOST {
        return found;
    }
    let mut taken = vec![false; loops.len()];
    let mut flowers = 0;
    while let Some((disc, petals)) =
        best(draft, &loops, &taken, AT_PETAL).or_else(|| best(draft, &loops, &taken, OFF_DISC))
    {
        for &p in &petals {
            taken[p] = true;
            found.settle(loops[p].stroke, StrokeClass::Blade);
        }
        found.rings.push((loops[disc].stroke, petals.iter().map(|&p| loops[p].stroke).collect()));
        taken[disc] = true;
        found.settle(loops[disc].stroke, StrokeClass::Disc);
        flowers += 1;
    }
    for (corolla, disc) in lobed(draft, &loops, &taken) {
        (taken[corolla], taken[disc]) = (true, true);
        found.settle(loops[corolla].stroke, StrokeClass::Corolla);
        found.settle(loops[disc].stroke, StrokeClass::Disc);
        flowers += 1;
    }
    // Other flowers, or a pot, are there already.
    if flowers > 0 || draft.class.contains(&StrokeClass::Pot) {
        let stems = stem_ends(draft);
        let cups = (0..loops.len()).filter(|&i| !taken[i]).map(|i| loops[i].stroke);
        for k in cups.filter(|&k| is_cup_on_stem(&draft.ink.strokes[k].points, &stems)) {
            found.settle(k, StrokeClass::Corolla);
            flowers += 1;
        }
    }
    if flowers == 0 {
        return found;
    }
    // The line that bears them is a stem, and blades on the stem are leaves.
    let sides: Vec<usize> = (0..draft.class.len())
        .filter(|&k| draft.class[k] == StrokeClass::TrunkOutline && unsure(draft, k))
        .filter(|&k| openness(&draft.ink.strokes[k]) > STRAIGHT)
        .collect();
    if let [stem] = sides[..] {
        found.settle(stem, StrokeClass::Axis);
    }
    found
}

/// Returns both ends of all lines that are rather straight.
pub(super) fn stem_ends(draft: &Draft<'_>) -> Vec<DVec2> {
    let lines = draft.ink.strokes.iter().filter(|s| openness(s) > STRAIGHT);
    lines.flat_map(|s| [s.points.first(), s.points.last()]).flatten().copied().collect()
}

/// Whether petals in profile, in one outline, stand on the end of a stem, as a tulip is drawn.
pub(super) fn is_cup_on_stem(points: &[DVec2], stems: &[DVec2]) -> bool {
    let Some((low, high)) = bounds(points) else { return false };
    let near = STEM_AT * low.distance(high);
    let about = |end: &&DVec2| end.cmpge(low - near).all() && end.cmple(high + near).all();
    let on = |end: &&DVec2| distance_to_polyline(points, **end).is_some_and(|d| d < near);
    stems.iter().filter(about).filter(on).any(|foot| is_cup(points, *foot))
}

fn loop_of(draft: &Draft<'_>, k: usize) -> Option<Loop> {
    let s = &draft.ink.strokes[k];
    if openness(s) > SHUT {
        return None;
    }
    let hull = s.hull();
    let (lo, hi) = bounds(&s.points).filter(|_| hull.len() > 2)?;
    let area = signed_area(hull);
    // Not a scribble.
    if area < NO_AREA || s.length * s.length > SCRIBBLE * area {
        return None;
    }
    let (wide, tall) = (hi.x - lo.x, hi.y - lo.y);
    Some(Loop {
        stroke: k,
        middle: geom::centroid(hull),
        radius: (area / ops::PI).sqrt(),
        round: wide.min(tall) > ROUND * wide.max(tall),
        hull: hull.to_vec(),
    })
}

/// Returns the free ring with the most petals round it.
fn best(draft: &Draft<'_>, loops: &[Loop], taken: &[bool], off: f64) -> Option<(usize, Vec<usize>)> {
    let free: Vec<usize> = (0..loops.len()).filter(|&i| !taken[i]).collect();
    let rings = free.iter().copied().filter(|&d| loops[d].round);
    let found = rings.filter_map(|d| petals_of(draft, loops, (&free, off), d).map(|p| (d, p)));
    found.max_by(|a, b| {
        let far = |d: usize| loops[d].radius;
        a.1.len().cmp(&b.1.len()).then(far(b.0).total_cmp(&far(a.0)))
    })
}

/// Returns the outlines that stand round a ring, if they are petals.
fn petals_of(
    draft: &Draft<'_>,
    loops: &[Loop],
    (free, off): (&[usize], f64),
    d: usize,
) -> Option<Vec<usize>> {
    let disc = &loops[d];
    // The least and the greatest distance of an outline from the disc's middle.
    let reach = |l: &Loop| {
        let far = draft.ink.strokes[l.stroke].points.iter().map(|p| p.distance(disc.middle));
        far.fold((f64::INFINITY, 0.0), |(least, most): (f64, f64), d| (least.min(d), most.max(d)))
    };
    let petals: Vec<usize> = free
        .iter()
        .copied()
        .filter(|&i| {
            let l = &loops[i];
            let (way, (gap, far)) = (l.middle.distance(disc.middle), reach(l));
            // A petal begins next to the disc, or under it and then at its own end.
            let beside = !contains(&l.hull, disc.middle) && gap > BESIDE * disc.radius;
            let begins = beside || way > UNDER * far;
            i != d && begins && way > OUTSIDE * disc.radius && gap < AT_DISC * disc.radius + off * l.radius
        })
        .collect();
    if petals.len() < FEWEST {
        return None;
    }
    let mut sizes: Vec<f64> = petals.iter().map(|&i| loops[i].radius).collect();
    base::sort_numbers(&mut sizes);
    let usual = sizes[sizes.len() / 2];
    let alike = |i: &usize| loops[*i].radius > 0.5 * usual && loops[*i].radius < 2.0 * usual;
    let petals: Vec<usize> = petals.into_iter().filter(alike).collect();
    let widest = widest_gap(petals.iter().map(|&i| loops[i].middle - disc.middle));
    // A disc is no larger than its petals are long; berries have berries behind them.
    let behind = free.iter().any(|&i| {
        let l = &loops[i];
        let touches = |p: &usize| loops[*p].middle.distance(l.middle) < TOUCH * (loops[*p].radius + l.radius);
        let beyond = petals.iter().any(|p| {
            touches(p)
                && l.middle.distance(disc.middle) > loops[*p].middle.distance(disc.middle) + 0.5 * usual
        });
        i != d
            && !petals.contains(&i)
            && l.radius > BERRY.start * usual
            && l.radius < BERRY.end * usual
            && l.round
            && beyond
    });
    // Farther off, only a whole ring of similar petals, which begin at similar distances, belongs to a disc.
    let mut gaps = petals.iter().map(|&i| reach(&loops[i]).0);
    let first = gaps.next().unwrap_or(0.0);
    let (least, most) = gaps.fold((first, first), |(a, b), g| (a.min(g), b.max(g)));
    let ring = petals.len() >= RING && widest < RING_GAP && most - least < usual;
    if off > AT_PETAL && !ring {
        return None;
    }
    let fits = petals.len() >= FEWEST && widest < WIDEST && disc.radius < LARGEST_DISC * usual && !behind;
    fits.then_some(petals)
}

/// Finds one lobed outline with one ring in its middle.
fn lobed(draft: &Draft<'_>, loops: &[Loop], taken: &[bool]) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    for (i, outer) in loops.iter().enumerate().filter(|(i, _)| !taken[*i]) {
        let inside: Vec<usize> = (0..loops.len())
            .filter(|&j| j != i && contains(&outer.hull, loops[j].middle) && loops[j].radius < outer.radius)
            .collect();
        let [d] = inside[..] else { continue };
        let disc = &loops[d];
        let central = disc.middle.distance(outer.middle) < CENTRAL * outer.radius;
        let sized = disc.radius > SIZED.start * outer.radius && disc.radius < SIZED.end * outer.radius;
        let stroke = &draft.ink.strokes[outer.stroke];
        let away: Vec<f64> = stroke.points.iter().map(|q| q.distance(disc.middle)).collect();
        let reach = away.iter().copied().fold(0.0, f64::max);
        let lobes = dips(&away, LOBE * reach).len();
        if central && sized && disc.round && lobes > FEWEST && stroke.outline().is_some() {
            found.push((i, d));
        }
    }
    found
}
