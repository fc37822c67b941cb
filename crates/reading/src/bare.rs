//! The wood of a bare tree whose trunk and limbs were drawn by their sides.
//!
//! Two sides of a trunk run on into limbs, whose other sides begin in the forks. No two of these lines belong
//! together, but the space between them does: a ball larger than the gaps cannot roll into it. Single lines are not
//! part of it.

use geom::{bounds, polyline_length, signed_area};
use glam::DVec2;
use ink::StrokeClass;

use crate::blade::nearest_on_ring;
use crate::body::{Limb, ribbon};
use crate::branches::Line;
use crate::contour::trunk_top;
use crate::draft::Draft;
use crate::silhouette::{BALLS, Drawn, FEET, NEAR, Shaping, common, holds, limb, made};
use crate::{OrganWord, READ_AS, Reading};

/// Wood is wider than twice this share of the diagonal; narrower things are lines.
const WIDE: f64 = 0.015;
/// Wood fills less than this share of the hull of all lines.
const FULL: f64 = 0.6;
/// Wood begins within this share of the height above the lowest line.
const STANDS: f64 = 0.1;
/// Wood is at least this share of the height tall.
const TALL: f64 = 0.3;
/// At most this share of its edge is not drawn: limbs are open at their tips.
const OPEN: f64 = 0.25;
/// A reading is good as it is if more than this share of all lines runs on the edges of its wood.
const READ_WELL: f64 = 0.8;
/// A reading is good as it is if it covers more than this share of wood that was drawn all round.
const READ: f64 = 0.4;
/// A line is a twig from where it leaves the wood, if it is longer than this.
const TWIG: f64 = 0.04;

/// Wood between lines.
#[derive(Debug)]
pub(crate) struct BareWood {
    /// Outline of the trunk.
    outline: Vec<DVec2>,
    trunk: Limb,
}

impl BareWood {
    /// Finds the wood of a drawing whose lines do not lie on the edges of the wood that a reading made.
    pub(crate) fn find(drawn: &Drawn<'_>, reading: &Reading) -> Option<Self> {
        if on_edges(drawn.lines, reading) > READ_WELL {
            return None;
        }
        let (low, high) = bounds(&drawn.lines.concat())?;
        let tall = high.y - low.y;
        let sealed = drawn.sealed(FEET[0])?;
        let wood = |ball: f64| {
            let outline = sealed(ball)?.opened(WIDE)?.outline()?;
            let (lo, hi) = bounds(&outline)?;
            let stands = lo.y < low.y + STANDS * tall && hi.y - lo.y > TALL * tall;
            let bare = drawn.bare(&outline, &(lo.y + STANDS * tall..hi.y + NEAR));
            (stands && signed_area(&outline) < FULL * drawn.hull && bare < OPEN).then_some(outline)
        };
        let [smallest, open @ ..] = BALLS;
        let outline = match wood(smallest) {
            // Limbs that were drawn all round are in the outline of the reading: if they were read at all, that is
            // better than their lines.
            Some(shut) if fit(&shut, reading) > READ => return None,
            Some(shut) => shut,
            None => open.into_iter().find_map(wood)?,
        };
        let top = trunk_top(&outline, true).or_else(|| bounds(&outline).map(|b| b.1.y))?;
        let trunk = limb(&outline, top);
        let outline = ribbon(&trunk.points, &trunk.half_width);
        Some(Self { outline, trunk })
    }

    /// Returns how much of the area that the trunk or a reading covers is covered by both, 0 to 1. A wide part above
    /// the trunk is the space between limbs.
    pub(crate) fn fit(&self, reading: &Reading) -> f64 {
        fit(&self.outline, reading)
    }

    /// Reads the wood as wood, and lines that lead out of it as twigs.
    pub(crate) fn read(self, shaping: &Shaping<'_>, draft: &mut Draft<'_>) {
        let ink = draft.ink;
        let mut source = None;
        for (k, stroke) in ink.strokes.iter().enumerate() {
            if shaping.tells(k, draft) {
                continue;
            }
            (draft.rule[k], draft.settled[k]) = (Some(READ_AS), true);
            let twigs = self.twigs(&stroke.points);
            let loose: f64 = twigs.iter().map(|t| polyline_length(t)).sum();
            (draft.class[k], draft.organ[k]) = if loose > 0.5 * stroke.length {
                (StrokeClass::Axis, OrganWord::Branch)
            } else {
                source.get_or_insert(stroke.index);
                (StrokeClass::TrunkOutline, OrganWord::Trunk)
            };
            let lines = twigs.into_iter().map(|points| Line { points, source: Some(stroke.index) });
            draft.lines.extend(lines);
        }
        draft.open_top = true;
        let row = draft.forest.add_body(vec![self.trunk], None, source);
        draft.bodies.extend(row);
    }

    /// Returns the pieces of a line outside the wood.
    fn twigs(&self, points: &[DVec2]) -> Vec<Vec<DVec2>> {
        let mut found: Vec<Vec<DVec2>> = Vec::new();
        let mut was_out = false;
        for &p in points {
            let out = !holds(&self.outline, p);
            if out && !was_out {
                found.push(Vec::new());
            }
            if let Some(twig) = found.last_mut().filter(|_| out) {
                twig.push(p);
            }
            was_out = out;
        }
        found.retain(|t| polyline_length(t) > TWIG);
        found
    }
}

fn fit(wood: &Vec<DVec2>, reading: &Reading) -> f64 {
    let made = made(reading);
    let all = [wood.clone(), made.concat()].concat();
    bounds(&all).map_or(1.0, |(lo, hi)| common(std::slice::from_ref(wood), &made, lo.y..hi.y))
}

/// Returns the share of lines that run along the edges of a reading's wood, 0 to 1.
fn on_edges(lines: &[&[DVec2]], reading: &Reading) -> f64 {
    let made = made(reading);
    let on_edge = |p: &DVec2| made.iter().any(|ring| nearest_on_ring(ring, *p).1 < NEAR);
    let (on, all) = lines
        .iter()
        .copied()
        .flatten()
        .fold((0.0, 0.0_f64), |(on, all), p| (on + f64::from(u8::from(on_edge(p))), all + 1.0));
    on / all.max(1.0)
}
