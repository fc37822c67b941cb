//! A tree by its silhouette: used if its strokes do not form one together.
//!
//! Carefully drawn trees have a crown of many open arcs and a trunk of many lines, which do not join to outlines. From
//! afar they are one shape with a neck, and that is read like a tree drawn in one line. The silhouette also measures
//! how well a reading of the strokes covers the drawing.

use core::ops::Range;

use geom::{bounds, contains, convex_hull, resample, signed_area};
use glam::DVec2;
use ink::{Ink, Source, StrokeClass};
use plant::AxisKind;

use crate::blade::nearest_on_ring;
use crate::body::{Limb, ribbon};
use crate::contour::{neck, runs_at};
use crate::draft::Draft;
use crate::near::Near;
use crate::rules::{IN_CROWN, SMALL, share_inside};
use crate::sealed::Sealed;
use crate::{OrganWord, READ_AS, Reading, RegionKind};

/// Radii of balls that find no way in through its gaps, as shares of the drawing's diagonal: the first that gives a
/// shape with a neck counts.
pub(crate) const BALLS: [f64; 4] = [0.012, 0.025, 0.04, 0.06];
/// The shape fills more than this share of its hull; bare branches fill less.
const FULL: f64 = 0.5;
/// Less than this share of the drawn points lies outside.
const LEFT_OUT: f64 = 0.12;
/// Points farther away than this lie outside: so far cells lie off the lines.
pub(crate) const NEAR: f64 = 0.018;
/// Step between the points of a line that are looked at.
const STRIDE: usize = 3;
/// Less than this share of the crown, and of the sides of the trunk, was not drawn.
const BARE: f64 = 0.07;
/// The sides of the trunk count above this share of its height.
const AT_FOOT: f64 = 0.3;
/// Most parts of a single body.
const MOST_PARTS: usize = 2;
/// A body is whole if less than this share of the lines lies outside it.
const LOOSE: f64 = 0.1;
/// A line is on the outline if more than this share of its points is.
const ON_OUTLINE: f64 = 0.6;
/// A level line below this share of the height is the ground.
const LOW: f64 = 0.2;
/// The ground rises by less than this share of its width.
const LEVEL: f64 = 0.25;
/// Marks smaller than this, such as grass, do not shape it.
const MARK: f64 = 0.06;
/// Points along a trunk, and levels at which it, or a crown, is compared.
const LEVELS: u32 = 16;
/// The lowest share of the height that is its foot: without roots, and with them.
pub(crate) const FEET: [f64; 2] = [0.08, 0.15];
/// This lowest share of a trunk is taken to be as wide as at its upper end.
const RAGGED: f64 = 0.16;
/// How often each level of a trunk is averaged with its neighbours.
const CALM: usize = 6;
/// Parts in this lowest share of a trunk stand on the ground.
const STANDS: f64 = 0.2;

/// Trunk and crown of a drawing that has a neck.
#[derive(Debug)]
pub(crate) struct Silhouette {
    /// Outline below the neck.
    below: Vec<DVec2>,
    trunk: Limb,
    crown: Vec<DVec2>,
}

impl Silhouette {
    pub(crate) fn find(drawn: &Drawn<'_>) -> Option<Self> {
        FEET.iter().find_map(|&share| {
            let shut = drawn.shut(share)?;
            // Gaps that let the largest ball in let in all balls.
            let [balls @ .., largest] = BALLS;
            let widest = shut(largest)?;
            let narrower = balls.into_iter().find_map(|ball| Self::cut(drawn, &shut(ball)?, ball));
            narrower.or_else(|| Self::cut(drawn, &widest, largest))
        })
    }

    /// Cuts an outline at its neck, if it is that of a tree with trunk and crown.
    fn cut(drawn: &Drawn<'_>, outline: &[DVec2], ball: f64) -> Option<Self> {
        let (below, crown) = neck(outline, true)?;
        let (foot, low, top) = (bounds(&below)?.0.y, bounds(&crown)?.0.y, bounds(&crown)?.1.y);
        let trunk = limb(outline, low);
        let mut half = trunk.half_width.clone();
        base::sort_numbers(&mut half);
        // Crown and trunk were drawn all round, but for gaps: between the tips of branches there are no lines.
        let wide = half.len() > 1 && half[half.len() / 2] > ball;
        let sides = foot + AT_FOOT * (low - foot)..low;
        let whole = wide && drawn.bare(&crown, &(low..top)) < BARE && drawn.bare(&below, &sides) < BARE;
        whole.then_some(Self { below, trunk, crown })
    }

    /// Returns how much of the area that the silhouette or a reading covers is covered by both, 0 to 1: of the trunk
    /// or of the crown, whichever is less.
    pub(crate) fn fit(&self, reading: &Reading) -> f64 {
        let made = made(reading);
        let drawn = [self.below.clone(), self.crown.clone()];
        let Some((low, high)) = bounds(&drawn.concat()) else { return 1.0 };
        let neck = bounds(&self.crown).map_or(low.y, |b| b.0.y);
        common(&drawn, &made, low.y..neck).min(common(&drawn, &made, neck..high.y))
    }

    /// Gives every stroke the class that it has in the silhouette, and reads it. Lines and fruits in the crown keep
    /// their classes.
    pub(crate) fn read(self, shaping: &Shaping<'_>, draft: &mut Draft<'_>) {
        use StrokeClass::{Axis, Crown, Disc, Fruit, TrunkOutline};
        let foot = bounds(&self.crown).map_or(0.0, |b| b.0.y);
        let (most, ink) = (SMALL * signed_area(&self.crown), draft.ink);
        let small = |k: usize| signed_area(ink.strokes[k].hull()) < most;
        let mut first = [None; 2];
        for k in 0..ink.strokes.len() {
            if shaping.tells(k, draft) {
                continue;
            }
            let points = &draft.ink.strokes[k].points;
            let inside = || share_inside(points, 1, &self.crown) > IN_CROWN;
            let wood = bounds(points).is_some_and(|(lo, hi)| lo.midpoint(hi).y < foot);
            (draft.class[k], draft.organ[k]) = match draft.class[k] {
                Axis if !wood && inside() => {
                    draft.line_of(k, OrganWord::Branch);
                    continue;
                }
                Fruit | Disc if !wood && inside() && small(k) => (Fruit, OrganWord::Fruit),
                _ if wood => (TrunkOutline, OrganWord::Trunk),
                _ => (Crown, OrganWord::LeafContour),
            };
            (draft.rule[k], draft.settled[k]) = (Some(READ_AS), true);
            first[usize::from(wood)].get_or_insert(k);
        }
        let source = first[1].map(|k| draft.ink.strokes[k].index);
        draft.open_top = true;
        let row = draft.forest.add_body(vec![self.trunk], None, source);
        draft.bodies.extend(row);
        draft.add_region(self.crown, RegionKind::Crown, first[0].unwrap_or(0));
    }
}

/// The lines of a drawing that shape a tree.
pub(crate) struct Shaping<'a> {
    /// Which strokes are the line of the ground.
    ground: Vec<bool>,
    /// Which are roots under it.
    roots: Vec<bool>,
    /// All others, but for marks.
    pub(crate) lines: Vec<&'a [DVec2]>,
}

impl<'a> Shaping<'a> {
    /// Finds the shaping lines of a drawing whose ground and roots are known from a reading.
    pub(crate) fn find(ink: &'a Ink, reading: &Reading) -> Option<Self> {
        let is = |class: StrokeClass, stroke: u32| {
            reading.strokes.iter().any(|s| s.index == stroke && s.class == class)
        };
        let rooted = ink.strokes.iter().any(|s| is(StrokeClass::Ground, s.index));
        let is_root = |stroke: u32| {
            rooted && reading.axes.iter().any(|a| a.kind == AxisKind::Root && a.source == Some(stroke))
        };
        let roots: Vec<bool> = ink.strokes.iter().map(|s| is_root(s.index)).collect();
        let above = ink.strokes.iter().zip(&roots).filter(|(_, root)| !**root);
        let (low, high) = above.filter_map(|(s, _)| bounds(&s.points)).reduce(around)?;
        let ground = ink.strokes.iter().enumerate();
        let ground = ground.map(|(k, s)| is(StrokeClass::Ground, s.index) || is_ground(ink, k, (low, high)));
        let ground: Vec<bool> = ground.collect();
        let large = |points: &[DVec2]| bounds(points).is_some_and(|(lo, hi)| lo.distance(hi) > MARK);
        let shapes = |k: &usize| !ground[*k] && !roots[*k] && large(&ink.strokes[*k].points);
        let lines = (0..ink.strokes.len()).filter(shapes).map(|k| ink.strokes[k].points.as_slice());
        Some(Self { lines: lines.collect(), ground, roots })
    }

    /// Marks a stroke as ground or root, if it is; returns whether it is.
    pub(crate) fn tells(&self, k: usize, draft: &mut Draft<'_>) -> bool {
        if !self.ground[k] && !self.roots[k] {
            return false;
        }
        (draft.rule[k], draft.settled[k]) = (Some(READ_AS), true);
        if self.ground[k] {
            (draft.class[k], draft.organ[k]) = (StrokeClass::Ground, OrganWord::Ignored);
        } else {
            draft.class[k] = StrokeClass::Axis;
            draft.line_of(k, OrganWord::Root);
        }
        true
    }
}

/// Returns the area that a reading covers: its wood and its crowns.
pub(crate) fn made(reading: &Reading) -> Vec<Vec<DVec2>> {
    let wood = reading.axes.iter().filter(|a| a.kind != AxisKind::Root && !a.half_width.is_empty());
    let wood = wood.map(|a| ribbon(&a.points, &a.half_width));
    wood.chain(reading.regions.iter().map(|r| r.outline.clone())).collect()
}

/// Returns the share of the area covered by some shapes or others between two heights that both cover: 0 to 1.
pub(crate) fn common(some: &[Vec<DVec2>], others: &[Vec<DVec2>], heights: Range<f64>) -> f64 {
    let (mut met, mut any) = (0.0, 0.0);
    for k in 0..LEVELS {
        let y = heights.start + (heights.end - heights.start) * (f64::from(k) + 0.5) / f64::from(LEVELS);
        let runs = |shapes: &[Vec<DVec2>]| shapes.iter().flat_map(|s| runs_at(s, y)).collect::<Vec<_>>();
        let (own, other) = (runs(some), runs(others));
        let both = covered([own.clone(), other.clone()].concat());
        met += covered(own) + covered(other) - both;
        any += both;
    }
    met / any.max(f64::MIN_POSITIVE)
}

/// The lines of a drawing that shape it.
pub(crate) struct Drawn<'a> {
    pub(crate) lines: &'a [&'a [DVec2]],
    near: Near,
    /// Area of the hull of all lines.
    pub(crate) hull: f64,
}

impl<'a> Drawn<'a> {
    pub(crate) fn new(lines: &'a [&'a [DVec2]]) -> Self {
        let mut near = Near::new(NEAR);
        lines.iter().enumerate().for_each(|(k, l)| near.add_line(k, l));
        Self { lines, near, hull: signed_area(&convex_hull(&lines.concat())) }
    }

    /// Returns a function from a ball to the area that it cannot enter, with the foot at a share of the height closed.
    pub(crate) fn sealed(&self, share: f64) -> Option<impl Fn(f64) -> Option<Sealed>> {
        let foot = foot(self.lines, share)?;
        Some(move |ball| Sealed::new(&[self.lines, &[&foot]].concat(), ball))
    }

    /// Returns a function to the outline of that area, if it holds the drawing.
    fn shut(&self, share: f64) -> Option<impl Fn(f64) -> Option<Vec<DVec2>>> {
        let sealed = self.sealed(share)?;
        Some(move |ball| sealed(ball)?.outline().filter(|outline| self.lies_in(outline)))
    }

    /// Whether an outline is full, stands where the drawing does, and holds nearly all drawn points.
    fn lies_in(&self, outline: &[DVec2]) -> bool {
        let low = |l: &[DVec2]| bounds(l).map_or(f64::INFINITY, |b| b.0.y);
        let foot = self.lines.iter().map(|l| low(l)).fold(f64::INFINITY, f64::min);
        if low(outline) > foot + 2.0 * NEAR {
            return false;
        }
        let out = || self.points().filter(|p| !holds(outline, **p)).count();
        signed_area(outline) > FULL * self.hull && (out() as f64) < LEFT_OUT * self.points().count() as f64
    }

    fn points(&self) -> impl Iterator<Item = &DVec2> {
        self.lines.iter().flat_map(|l| l.iter().step_by(STRIDE))
    }

    /// Returns the share of an outline between two heights along which nothing was drawn.
    pub(crate) fn bare(&self, outline: &[DVec2], heights: &Range<f64>) -> f64 {
        let places = resample(outline, NEAR).into_iter();
        let places = places.filter(|p| p.y > heights.start + NEAR && p.y < heights.end - NEAR);
        let (bare, all) = places.fold((0.0, 0.0_f64), |(bare, all), p| {
            let drawn = self.near.nearest(p, NEAR, |_| true).is_some();
            (bare + f64::from(u8::from(!drawn)), all + 1.0)
        });
        bare / all.max(1.0)
    }
}

/// Makes one body of a smaller one: the cap of a mushroom without its stem. Only if no line leads out of it.
pub(crate) fn one_body(ink: &Ink, reading: &mut Reading) {
    let parts = reading.leaves.len() + reading.flowers.len() + reading.thorns.len() + reading.pots.len();
    // A contour that leaves or twigs fill is no skin.
    let filled = reading.regions.iter().any(|r| r.kind != RegionKind::Crown);
    if parts > 0 || filled || !(1..=MOST_PARTS).contains(&reading.fruits.len()) {
        return;
    }
    let lines: Vec<&[DVec2]> = ink.strokes.iter().map(|s| s.points.as_slice()).collect();
    let drawn = Drawn::new(&lines);
    let outline = drawn.shut(FEET[0]).and_then(|shut| BALLS.into_iter().find_map(shut));
    let Some((outline, (low, high))) = outline.and_then(|o| bounds(&o).map(|b| (o, b))) else { return };
    let in_part = |p: &&DVec2| reading.fruits.iter().any(|f| holds(&f.outline, **p));
    let loose = drawn.points().filter(|p| !in_part(p)).count();
    let sides = low.y + AT_FOOT * (high.y - low.y)..high.y + 2.0 * NEAR;
    if (loose as f64) < LOOSE * drawn.points().count() as f64
        || drawn.bare(&outline, &sides) > BARE
        || !reading.axes.iter().flat_map(|a| &a.points).all(|p| holds(&outline, *p))
    {
        return;
    }
    reading.axes.clear();
    // They bore the crowns.
    reading.regions.clear();
    reading.fruits.truncate(1);
    reading.fruits[0].bearer = None;
    // Lines inside are on its skin.
    let on_outline = |points: &[DVec2]| {
        let near = points.iter().filter(|p| nearest_on_ring(&outline, **p).1 < 2.0 * NEAR).count();
        near as f64 > ON_OUTLINE * points.len() as f64
    };
    for stroke in &ink.strokes {
        let rim = on_outline(&stroke.points);
        if let Some(s) = reading.strokes.iter_mut().find(|s| s.index == stroke.index) {
            s.source = Source::Rule(READ_AS);
            (s.class, s.organ) = if rim {
                (StrokeClass::Fruit, OrganWord::Fruit)
            } else {
                (StrokeClass::Other, OrganWord::Ignored)
            };
        }
    }
    reading.fruits[0].outline = outline;
}

/// Whether a point lies in an outline, or on it within the accuracy of cells.
pub(crate) fn holds(outline: &[DVec2], p: DVec2) -> bool {
    contains(outline, p) || nearest_on_ring(outline, p).1 <= NEAR
}

/// Returns the length that intervals cover together.
fn covered(mut runs: Vec<(f64, f64)>) -> f64 {
    base::sort_by(&mut runs, |a, b| a.0.total_cmp(&b.0));
    let mut end = f64::NEG_INFINITY;
    let own = |(from, to): (f64, f64)| {
        let own = (to - from.max(end)).max(0.0);
        end = end.max(to);
        own
    };
    runs.into_iter().map(own).sum()
}

/// Returns a line along the foot of a drawing, from its lower left to its lower right corner: a trunk is open below.
fn foot(lines: &[&[DVec2]], share: f64) -> Option<[DVec2; 2]> {
    let (low, high) = lines.iter().filter_map(|l| bounds(l)).reduce(around)?;
    let feet = || lines.iter().copied().flatten().filter(|p| p.y < low.y + share * (high.y - low.y));
    let left = feet().min_by(|a, b| (a.x + a.y).total_cmp(&(b.x + b.y)))?;
    let right = feet().max_by(|a, b| (a.x - a.y).total_cmp(&(b.x - b.y)))?;
    Some([*left, *right])
}

/// Returns the trunk of an outline from its foot to the neck at `top`: all parts that stand on the ground, and at each
/// level above the parts connected with the level below. So two sides are one trunk, and lobes of the crown that hang
/// next to it are not part of it.
pub(crate) fn limb(outline: &[DVec2], top: f64) -> Limb {
    let low = bounds(outline).map_or(0.0, |b| b.0.y);
    let mut limb = Limb { points: Vec::new(), half_width: Vec::new(), parent: None, closed_end: false };
    let mut below = (f64::NEG_INFINITY, f64::INFINITY);
    for k in 0..LEVELS {
        let share = (f64::from(k) + 0.5) / f64::from(LEVELS);
        // Below this the foot is as ragged as its roots.
        let y = low + (top - low) * share.max(RAGGED);
        let runs = runs_at(outline, y).into_iter().filter(|r| r.0 < below.1 && r.1 > below.0);
        let Some(run) = runs.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else { continue };
        limb.points.push(DVec2::new(run.0.midpoint(run.1), low + (top - low) * share));
        limb.half_width.push(0.5 * (run.1 - run.0));
        if share > STANDS {
            below = run;
        }
    }
    calm(&mut limb);
    limb
}

/// Smooths the middle of a trunk and its sides, however ragged they are.
fn calm(limb: &mut Limb) {
    let n = limb.points.len();
    for _ in 0..CALM {
        let (middle, half) = (limb.points.clone(), limb.half_width.clone());
        for k in 0..n {
            let (a, b) = (k.saturating_sub(1), (k + 1).min(n - 1));
            limb.points[k].x = 0.25 * (middle[a].x + middle[b].x) + 0.5 * middle[k].x;
            limb.half_width[k] = 0.25 * (half[a] + half[b]) + 0.5 * half[k];
        }
    }
}

fn around(a: (DVec2, DVec2), b: (DVec2, DVec2)) -> (DVec2, DVec2) {
    (a.0.min(b.0), a.1.max(b.1))
}

fn is_ground(ink: &Ink, stroke: usize, (low, high): (DVec2, DVec2)) -> bool {
    bounds(&ink.strokes[stroke].points)
        .is_some_and(|(lo, hi)| hi.y < low.y + LOW * (high.y - low.y) && hi.y - lo.y < LEVEL * (hi.x - lo.x))
}
