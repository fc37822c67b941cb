//! A tree by its silhouette: what is left when its strokes say nothing together.
//!
//! Carefully drawn trees have a crown of many open arcs and a trunk of many lines, which join to no outlines. Seen from
//! afar they are one shape with a neck, and that is read as a tree drawn in one line is.

use geom::{AlphaShape, bounds, convex_hull, signed_area, simple_outline};
use glam::DVec2;
use ink::{Ink, StrokeClass};

use crate::READ_AS;
use crate::body::Limb;
use crate::contour::{neck, runs_at};
use crate::draft::Draft;
use crate::grid::Grid;
use crate::look::WIDE;
use crate::{OrganWord, RegionKind};

/// Gaps twice as wide are closed, shares of the drawing's diagonal: the first that gives a shape with a neck.
const CLOSED: [f64; 4] = [0.02, 0.04, 0.07, 0.11];
/// The shape fills more than this share of its hull; bare branches fill less.
const FULL: f64 = 0.5;
/// Its lines enclose more than this share of its box, on the wider grid of a look; bare branches enclose next to nothing.
const ENCLOSED: f64 = 0.1;
/// In fewer strokes it is an outline, which is read as such.
const FEWEST: usize = 6;
/// A level line below this share of the height is the ground; it rises by less than that share of its width.
const LOW: f64 = 0.2;
const LEVEL: f64 = 0.25;
/// Marks smaller than this, such as grass, do not shape it.
const MARK: f64 = 0.06;
/// Points along a trunk.
const LEVELS: u32 = 16;
/// What lies in this lowest share of a trunk stands on the ground.
const STANDS: f64 = 0.2;

/// Trunk and crown of a drawing, if it has a neck.
#[derive(Debug)]
struct Silhouette {
    trunk: Limb,
    crown: Vec<DVec2>,
}

/// Gives every stroke the class that it has in the silhouette, and reads that; what it was before where there is no neck.
pub(crate) fn read_silhouette(draft: &mut Draft<'_>) -> bool {
    let Some((low, high)) = draft.ink.strokes.iter().filter_map(|s| bounds(&s.points)).reduce(around) else {
        return false;
    };
    let ground: Vec<bool> = (0..draft.class.len()).map(|k| is_ground(draft.ink, k, (low, high))).collect();
    let Some(Silhouette { trunk, crown }) = silhouette(draft.ink, &ground) else { return false };
    let foot = bounds(&crown).map_or(0.0, |b| b.0.y);
    let mut first = [None; 2];
    for (k, &ground) in ground.iter().enumerate() {
        let wood = bounds(&draft.ink.strokes[k].points).is_some_and(|(lo, hi)| lo.midpoint(hi).y < foot);
        (draft.class[k], draft.organ[k]) = match (ground, wood) {
            (true, _) => (StrokeClass::Ground, OrganWord::Ignored),
            (_, true) => (StrokeClass::TrunkOutline, OrganWord::Trunk),
            _ => (StrokeClass::Crown, OrganWord::LeafContour),
        };
        (draft.rule[k], draft.settled[k]) = (Some(READ_AS), true);
        if !ground {
            first[usize::from(wood)].get_or_insert(k);
        }
    }
    let source = first[1].map(|k| draft.ink.strokes[k].index);
    draft.open_top = true;
    let row = draft.forest.add_body(vec![trunk], None, source);
    draft.bodies.extend(row);
    draft.add_region(crown, RegionKind::Crown, first[0].unwrap_or(0));
    true
}

/// The trunk of an outline from its foot to the neck at `top`: all that stands on the ground, and at each level above what
/// hangs together with the level below. So two sides are one trunk, and lobes of the crown that hang beside it no part of it.
fn limb(outline: &[DVec2], top: f64) -> Limb {
    let low = bounds(outline).map_or(0.0, |b| b.0.y);
    let mut limb = Limb { points: Vec::new(), half_width: Vec::new(), parent: None, closed_end: false };
    let mut below = (f64::NEG_INFINITY, f64::INFINITY);
    for k in 0..LEVELS {
        let share = (f64::from(k) + 0.5) / f64::from(LEVELS);
        let y = low + (top - low) * share;
        let runs = runs_at(outline, y).into_iter().filter(|r| r.0 < below.1 && r.1 > below.0);
        let Some(run) = runs.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else { continue };
        limb.points.push(DVec2::new(run.0.midpoint(run.1), y));
        limb.half_width.push(0.5 * (run.1 - run.0));
        if share > STANDS {
            below = run;
        }
    }
    limb
}

fn around(a: (DVec2, DVec2), b: (DVec2, DVec2)) -> (DVec2, DVec2) {
    (a.0.min(b.0), a.1.max(b.1))
}

fn is_ground(ink: &Ink, stroke: usize, (low, high): (DVec2, DVec2)) -> bool {
    bounds(&ink.strokes[stroke].points)
        .is_some_and(|(lo, hi)| hi.y < low.y + LOW * (high.y - low.y) && hi.y - lo.y < LEVEL * (hi.x - lo.x))
}

/// How much of the box of a drawing its lines enclose, where gaps of a cell are closed.
fn enclosed(ink: &Ink) -> f64 {
    Grid::new(ink, WIDE).holes.iter().map(|h| h.area).sum()
}

/// The alpha shape of all that is drawn ([`AlphaShape`]), cut at its neck.
fn silhouette(ink: &Ink, ground: &[bool]) -> Option<Silhouette> {
    let large = |points: &[DVec2]| bounds(points).is_some_and(|(lo, hi)| lo.distance(hi) > MARK);
    let strokes = ink.strokes.iter().zip(ground).filter(|(s, ground)| !**ground && large(&s.points));
    if strokes.clone().count() < FEWEST || enclosed(ink) < ENCLOSED {
        return None;
    }
    let points: Vec<DVec2> = strokes.flat_map(|(s, _)| s.points.iter().copied()).collect();
    let hull = signed_area(&convex_hull(&points));
    let shape = AlphaShape::new(&points);
    CLOSED.iter().find_map(|&radius| {
        let line: Vec<DVec2> = shape.outline(radius)?.points.into_iter().map(|k| points[k]).collect();
        let outline = simple_outline(&line).filter(|o| signed_area(o) > FULL * hull)?;
        let (_, crown) = neck(&outline, true)?;
        let trunk = limb(&outline, bounds(&crown)?.0.y);
        (trunk.points.len() > 1).then_some(Silhouette { trunk, crown })
    })
}
