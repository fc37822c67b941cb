//! The rule about a whole tree: something round over something narrow that stands.
//!
//! It looks at shapes and places only, so neither the order of drawing nor the class of a single stroke decides.

use geom::{bounds, contains, convex_hull, crossing_points, perimeter, signed_area};
use glam::DVec2;
use ink::StrokeClass;

use super::{Findings, SHUT, SIDES_APART, STANDS, STRIDE, WITHIN, openness, outside, share_inside, unsure};
use crate::Kind;
use crate::corolla::dips;
use crate::draft::Draft;

/// A trunk is narrower than this share of its crown.
const NARROW: f64 = 0.6;
/// At least this share of the tree's height is bare trunk.
const BARE: f64 = 0.1;
/// That share if the trunk has an outline: nobody draws the sides of a hidden trunk.
const BARE_OUTLINE: f64 = 0.04;
/// A trunk's top is no farther from its crown than this.
const REACH: f64 = 0.08;
/// Feet within this share of the height of the lowest point stand on the ground.
const FOOT: f64 = 0.12;
/// A crown drawn as an outline fills this share of its hull.
const FULL: f64 = 0.6;
/// Fewest widely spread crossings of a line that is a scribble.
const TANGLED: usize = 8;
/// A scribble is longer than this factor of the perimeter of its hull.
const LONG: f64 = 1.9;
/// The line of the ground is more open than this.
const GROUND_OPEN: f64 = 0.6;
/// The line of the ground rises by less than this share of its width.
const GROUND_FLAT: f64 = 0.2;
/// The line of the ground lies lower than this.
const GROUND_LOW: f64 = 0.3;
/// The line of the ground is wider than this.
const GROUND_WIDE: f64 = 0.15;
/// A crown is higher than this share of the tree's height: a smaller head on its stalk is a flower or a fruit.
const CROWN_HEIGHT: f64 = 0.2;
/// A crown is wider than this share of the tree's height.
const CROWN_WIDTH: f64 = 0.22;
/// A trunk ends below this share of its crown's height.
const INTO: f64 = 0.75;
/// A trunk's tip is off its crown's middle by less than this share of the crown's width.
const UNDER: f64 = 0.4;
/// The ends of a trunk of one or two lines are farther apart than this share of the line's length.
const LINE_OPEN: f64 = 0.75;
/// Such a line is less wide than this share of its height.
const LINE_LEANS: f64 = 0.45;
/// A trunk drawn as an outline may be open above or below: its ends then differ in height by less than this share of
/// its height.
const OPENING: f64 = 0.35;
/// It is narrower than this share of its height.
const TRUNK_NARROW: f64 = 0.8;
/// It fills more than this share of its box.
const TRUNK_FULL: f64 = 0.55;
/// The sides of a trunk are nearer than this factor of the lower one's height.
const SIDES_NEAR: f64 = 1.1;
/// A lobe has more than this share of the area of the largest.
const MAIN: f64 = 0.2;
/// The largest lobe has more than this area.
const CROWN_AREA: f64 = 0.01;
/// Least width of a high crown relative to its height.
const SLENDEREST: f64 = 0.4;
/// Least height of a wide crown relative to its width.
const FLATTEST: f64 = 0.25;
/// A ring in the very middle with more area than this is the disc of a flower.
const RING_AREA: f64 = 1e-4;
/// The very middle: within this share of the crown's size.
const CENTRAL: f64 = 0.15;
/// Depth of the dips between petals in one stroke, as a share of the reach.
const PETAL_DIP: f64 = 0.27;
/// Fewest petals, in one stroke or one by one.
const PETALS: usize = 4;
/// Least ratio of the nearest to the farthest distance of single petals from their middle.
const UNEVEN: f64 = 0.6;
/// Most crossings that are examined.
const MOST_CROSSINGS: usize = 400;
/// Crossings farther from the middle than this share of the stroke's diagonal are widely spread.
const MIDDLE: f64 = 0.12;
/// Depth of the sweeps of a line that is shading, as a share of its width.
const SWEEP: f64 = 0.4;
/// Fewest sweeps to and fro of a line that is shading, both ends among them.
const SWEEPS: usize = 6;
/// Most lobes of one crown.
const MOST_LOBES: usize = 9;
/// Lobes touch within this distance.
const LOBES_TOUCH: f64 = 0.02;
/// Depth of the dips of a cloud, as a share of its reach.
const CLOUD_DIP: f64 = 0.04;
/// Fewest dips of a cloud, both ends among them.
const CLOUDY: usize = 7;
/// A vein is more open than this.
const VEIN_OPEN: f64 = 0.8;
/// A vein is longer than this share of its leaf's height.
const VEIN_LONG: f64 = 0.4;
/// Least height of a leaf relative to its width.
const LEAF_TALL: f64 = 1.45;

struct Part {
    stroke: usize,
    lo: DVec2,
    hi: DVec2,
    hull: Vec<DVec2>,
    open: f64,
}

impl Part {
    fn width(&self) -> f64 {
        self.hi.x - self.lo.x
    }

    fn height(&self) -> f64 {
        self.hi.y - self.lo.y
    }

    fn area(&self) -> f64 {
        if self.hull.len() > 2 { signed_area(&self.hull) } else { 0.0 }
    }

    fn middle(&self) -> DVec2 {
        self.lo.midpoint(self.hi)
    }
}

/// How a trunk was drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wood {
    Line,
    TwoLines,
    Outline,
}

/// Finds one crown over one trunk, each drawn in any way and order.
pub(super) fn whole_tree(draft: &Draft<'_>) -> Findings {
    let mut found = Findings::default();
    let all: Vec<usize> = (0..draft.class.len()).collect();
    let other = draft.kind.is_some_and(|kind| !kind.is_like(Kind::Tree));
    if other || !all.iter().all(|&k| unsure(draft, k)) {
        return found;
    }
    let parts: Vec<Part> = all
        .iter()
        .filter_map(|&k| {
            let s = &draft.ink.strokes[k];
            let (lo, hi) = bounds(&s.points)?;
            Some(Part { stroke: k, lo, hi, hull: s.hull().to_vec(), open: openness(s) })
        })
        .collect();
    // The line of the ground is neither.
    let (ground, parts): (Vec<Part>, Vec<Part>) = parts.into_iter().partition(|p| {
        p.open > GROUND_OPEN
            && p.height() < GROUND_FLAT * p.width()
            && p.hi.y < GROUND_LOW
            && p.width() > GROUND_WIDE
    });
    let Some((low, high)) = parts.iter().map(|p| (p.lo, p.hi)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    else {
        return found;
    };
    let tall = high.y - low.y;
    let stands = |p: &Part| p.lo.y < low.y + FOOT * tall && p.width() < STANDS * p.height();
    let (wood, green): (Vec<Part>, Vec<Part>) = parts.into_iter().partition(stands);
    let Some(kind) = trunk(draft, &wood) else { return found };
    let Some(crown) = crown(draft, &green, kind) else { return found };
    let wood_box = wood.iter().map(|p| (p.lo, p.hi)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let (Some((foot, top)), Some((lo, hi))) = (wood_box, bounds(&crown.hull)) else { return found };
    let (wide, height) = (hi.x - lo.x, hi.y - lo.y);
    let tip = DVec2::new(foot.midpoint(top).x, top.y);
    let fits = top.x - foot.x < NARROW * wide
        && lo.y - foot.y > if kind == Wood::Line { BARE } else { BARE_OUTLINE } * tall
        && height > CROWN_HEIGHT * tall
        && outside(&crown.hull, tip) < REACH
        && top.y < lo.y + INTO * height
        && (tip.x - lo.midpoint(hi).x).abs() < UNDER * wide
        // A head that is small for its stalk is a flower's or a fruit's.
        && wide > CROWN_WIDTH * tall;
    if !fits || (kind == Wood::Line && leaf_on_a_stalk(draft, &crown, &wood[0], (lo, hi))) {
        return found;
    }
    for p in &wood {
        found
            .settle(p.stroke, if kind == Wood::Line { StrokeClass::Axis } else { StrokeClass::TrunkOutline });
    }
    for &k in &crown.strokes {
        found.settle(k, StrokeClass::Crown);
    }
    for p in &ground {
        found.settle(p.stroke, StrokeClass::Ground);
    }
    found.trunk = kind == Wood::TwoLines;
    if crown.strokes.len() > 1 {
        found.united = crown.strokes;
    }
    found
}

/// Returns how the standing parts form one trunk: a line, two lines side by side, or one outline that is higher than
/// wide.
fn trunk(draft: &Draft<'_>, wood: &[Part]) -> Option<Wood> {
    let line = |p: &Part| p.open > LINE_OPEN && p.width() < LINE_LEANS * p.height();
    match wood {
        [one] if line(one) => Some(Wood::Line),
        [one] => {
            let s = &draft.ink.strokes[one.stroke];
            let (a, b) = (s.points[0], s.points[s.points.len() - 1]);
            // Closed, open above or open below; not open to one side.
            let level = (a.y - b.y).abs() < OPENING * one.height();
            let narrow = one.width() < TRUNK_NARROW * one.height()
                && one.area() > TRUNK_FULL * one.width() * one.height();
            (narrow && (one.open < SHUT || level)).then_some(Wood::Outline)
        }
        [a, b] if line(a) && line(b) => {
            let alike = a.height().min(b.height()) > 0.5 * a.height().max(b.height());
            let apart = (a.middle().x - b.middle().x).abs();
            (alike && apart > SIDES_APART && apart < SIDES_NEAR * a.height().min(b.height()))
                .then_some(Wood::TwoLines)
        }
        _ => None,
    }
}

/// A crown: its strokes, and the hull around them.
struct Green {
    strokes: Vec<usize>,
    hull: Vec<DVec2>,
    /// Lines and rings inside it.
    inner: Vec<usize>,
    scribble: bool,
}

fn crown(draft: &Draft<'_>, green: &[Part], wood: Wood) -> Option<Green> {
    let largest = green.iter().map(Part::area).fold(0.0, f64::max);
    let (main, small): (Vec<&Part>, Vec<&Part>) = green.iter().partition(|p| p.area() > MAIN * largest);
    let points: Vec<DVec2> = main.iter().flat_map(|p| p.hull.iter().copied()).collect();
    let hull = convex_hull(&points);
    if hull.len() < 3 || largest < CROWN_AREA {
        return None;
    }
    // Everything else lies in it.
    let stray = |p: &&Part| share_inside(&draft.ink.strokes[p.stroke].points, STRIDE, &hull) < WITHIN;
    if small.iter().any(stray) {
        return None;
    }
    let (lo, hi) = bounds(&hull)?;
    let (wide, tall) = (hi.x - lo.x, hi.y - lo.y);
    if wide < SLENDEREST * tall || tall < FLATTEST * wide {
        return None;
    }
    let rings: Vec<&&Part> = small.iter().filter(|p| p.open < SHUT && p.area() > RING_AREA).collect();
    // One ring in the very middle is the disc of a flower.
    let centre = geom::centroid(&hull);
    let central = |p: &&&Part| p.middle().distance(centre) < CENTRAL * wide.max(tall);
    if rings.len() < 3 && rings.iter().any(central) {
        return None;
    }
    let inner: Vec<usize> = small.iter().map(|p| p.stroke).collect();
    let strokes: Vec<usize> = main.iter().map(|p| p.stroke).collect();
    let scribble = match &main[..] {
        [one] if one.open < SHUT && outlined(draft, one) => {
            // Petals in one go stand far out, with deep hollows between them.
            if petals(draft, one, wood) {
                return None;
            }
            false
        }
        [one] if tangled(draft, one) => true,
        [_] => return None,
        lobes => {
            if !lobes_of_a_crown(draft, lobes, &hull) {
                return None;
            }
            false
        }
    };
    Some(Green { strokes, hull, inner, scribble })
}

/// Whether a part is one outline that fills its hull.
fn outlined(draft: &Draft<'_>, p: &Part) -> bool {
    let stroke = &draft.ink.strokes[p.stroke];
    stroke.outline().is_some_and(|o| signed_area(o) > FULL * p.area())
        && stroke.length < LONG * perimeter(&p.hull)
}

/// Whether a part is petals: few deep, even hollows above a single line.
fn petals(draft: &Draft<'_>, p: &Part, wood: Wood) -> bool {
    let points = &draft.ink.strokes[p.stroke].points;
    let centre = geom::centroid(&p.hull);
    let away: Vec<f64> = points.iter().map(|q| q.distance(centre)).collect();
    let reach = away.iter().copied().fold(0.0, f64::max);
    let cuts = dips(&away, PETAL_DIP * reach).len();
    wood == Wood::Line && cuts >= PETALS
}

/// Whether a line goes round and round with crossings all over the place.
fn tangled(draft: &Draft<'_>, p: &Part) -> bool {
    let s = &draft.ink.strokes[p.stroke];
    if s.length < LONG * perimeter(&p.hull) {
        return false;
    }
    let crossings = crossing_points(&s.points, MOST_CROSSINGS);
    let middle = p.middle();
    let wide = crossings.iter().filter(|q| q.distance(middle) > MIDDLE * p.lo.distance(p.hi)).count();
    let sideways: Vec<f64> = s.points.iter().map(|q| q.x).collect();
    let to_and_fro = dips(&sideways, SWEEP * p.width()).len() >= SWEEPS;
    (crossings.len() > TANGLED || to_and_fro) && 2 * wide >= crossings.len()
}

/// Whether several round outlines overlap and form one crown, rather than petals round a middle.
fn lobes_of_a_crown(draft: &Draft<'_>, lobes: &[&Part], hull: &[DVec2]) -> bool {
    let round = |p: &&&Part| {
        p.open < 0.5 && p.width().min(p.height()) > 0.5 * p.width().max(p.height()) && p.hull.len() > 2
    };
    if !lobes.iter().all(|p| round(&p)) || lobes.len() > MOST_LOBES {
        return false;
    }
    let touches = |a: &Part, b: &Part| {
        let points = &draft.ink.strokes[a.stroke].points;
        points.iter().step_by(STRIDE).any(|&q| contains(&b.hull, q) || outside(&b.hull, q) < LOBES_TOUCH)
    };
    let mut joined = vec![false; lobes.len()];
    joined[0] = true;
    for _ in 0..lobes.len() {
        for i in 0..lobes.len() {
            if !joined[i] && (0..lobes.len()).any(|j| joined[j] && touches(lobes[i], lobes[j])) {
                joined[i] = true;
            }
        }
    }
    if !joined.iter().all(|j| *j) {
        return false;
    }
    // Petals stand round a middle that none of them covers, similar and at similar distances from it.
    let centre = geom::centroid(hull);
    let covered = lobes.iter().filter(|p| contains(&p.hull, centre)).count();
    let far: Vec<f64> = lobes.iter().map(|p| p.middle().distance(centre)).collect();
    let (near, most) = far.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &d| (a.min(d), b.max(d)));
    lobes.len() < PETALS || covered > 0 || near < UNEVEN * most
}

/// Whether an outline on a single line is a leaf: it is long or pointed, or the line runs on through it.
fn leaf_on_a_stalk(draft: &Draft<'_>, crown: &Green, line: &Part, (lo, hi): (DVec2, DVec2)) -> bool {
    if crown.scribble || crown.strokes.len() > 1 {
        return false;
    }
    let (wide, tall) = (hi.x - lo.x, hi.y - lo.y);
    let points = &draft.ink.strokes[crown.strokes[0]].points;
    let centre = geom::centroid(&crown.hull);
    let away: Vec<f64> = points.iter().map(|q| q.distance(centre)).collect();
    let reach = away.iter().copied().fold(0.0, f64::max);
    let cloudy = dips(&away, CLOUD_DIP * reach).len() >= CLOUDY;
    let through = line.hi.y > lo.y + 0.5 * tall;
    let veined = crown.inner.iter().any(|&k| {
        let s = &draft.ink.strokes[k];
        openness(s) > VEIN_OPEN && s.length > VEIN_LONG * tall
    });
    (!cloudy && (through || veined || tall > LEAF_TALL * wide)) || (through && veined)
}
