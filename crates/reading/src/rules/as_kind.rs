//! A drawing taken for one kind of plant: the class that each stroke then has.
//!
//! The kind decides, not the classifier: it came from the whole drawing, or the user asked for it. Classes that the
//! user set stay.

use geom::{bounds, contains, convex_hull, polyline_length, signed_area};
use glam::DVec2;
use ink::StrokeClass;

use super::whole_flower::{is_cup_on_stem, stem_ends};
use super::{CLOSED, STANDS, STRIDE, WITHIN, openness, share_inside, unsure, whole_flower, whole_tree};
use crate::built::pointed;
use crate::contour::neck;
use crate::corolla::dips;
use crate::draft::{Draft, HALVES_GAPS};
use crate::flowers::together;
use crate::rings::{Ring, rings};
use crate::thresholds::{MOUTH, STRAIGHT};
use crate::{Kind, READ_AS, palette};

/// Feet within this share of the height stand on the ground.
const FOOT: f64 = 0.15;
/// A level line rises by less than this share of its width.
const LEVEL: f64 = 0.25;
/// Wood is narrower than this share of the drawing.
const NARROW: f64 = 0.55;
/// A part of a crown has more than this share of the area of the largest part.
const MAIN_CROWN: f64 = 0.12;
/// A fruit in a crown has less than this share of that area.
const FRUIT: f64 = 0.05;
/// The enclosed area is at least this share of the hull of the whole tree, or the tree is bare.
const COVERED: f64 = 0.15;
/// The outline of a trunk and its limbs fills less than this share of its hull.
const HOLLOW: f64 = 0.65;
/// Sides of limbs meet at tips no wider than this, as a share of the drawing's diagonal.
const TIP: f64 = 0.1;
/// Sides of limbs are longer than this, as a share of the drawing's diagonal.
const SIDE_OF_LIMB: f64 = 0.1;
/// A level line below this is the ground under a palm.
const LOW: f64 = 0.2;
/// A level line below this is the ground under a cactus.
const LOWEST: f64 = 0.1;
/// Depth of the dips between fronds in one stroke, as a share of the reach.
const FROND_DIP: f64 = 0.2;
/// Fronds in one stroke have more dips than this.
const FRONDS: usize = 4;
/// A stroke to which the classifier gives at least this share to be a pot stays one under a cactus; 0 to 1.
const POT_SHARE: f64 = 0.3;
/// An arm of a cactus is larger than this share of the drawing's diagonal; a thorn is smaller.
const ARM: f64 = 0.25;
/// Depth of the dips in a row of grass, as a share of the stroke's height.
const GRASS_DIP: f64 = 0.3;
/// Fewest dips in a row of grass, both ends among them.
const GRASS_DIPS: usize = 4;
/// The head of a flower begins above this share of its height.
const HEAD: f64 = 0.35;
/// Most pieces of heads of which each is compared with each.
const MOST_HEADS: usize = 40;
/// A vein lies in its leaf with more than this share of its points.
const VEIN: f64 = 0.6;
/// A leaflet has more than this share of the area of the largest one.
const LEAFLET: f64 = 0.4;
/// A body has more than this share of the area of the largest one.
const BODY: f64 = 0.25;
/// A line that lies in a body with more than this share of its points is on its skin.
const SKIN: f64 = 0.7;
/// A leaf on a fruit lies above this share of the fruit's height.
const TOP: f64 = 0.7;
/// A leaf on a fruit has less than this share of the fruit's area.
const LESS_THAN_BODY: f64 = 0.8;
/// An arc of a body encloses more than this share of the area of the largest part.
const ARC: f64 = 0.05;
/// Fewest bodies of a bunch.
const BUNCH: usize = 3;
/// A leaf on a bunch is less round than its bodies by this factor, or its area larger.
const UNLIKE: f64 = 0.7;
/// A mushroom's stem begins below this share of its cap's height.
const CAP_FOOT: f64 = 0.5;
/// A mushroom's stem reaches below its cap by more than this share of the cap's height.
const STEM_LONG: f64 = 0.25;
/// A mushroom's stem drawn as one line has more than this share of its cap's area.
const STEM_AREA: f64 = 0.08;
/// A smooth outline is the body under a tuft if its area is more than this share of the tuft's.
const BESIDE_TUFT: f64 = 0.5;
/// The lines of a pot begin below this share of the drawing's height.
const POT_FOOT: f64 = 0.45;
/// One of these lines begins below this share of the drawing's height.
const POT_BOTTOM: f64 = 0.08;
/// That line is wider than this share of the drawing's width.
const POT_WIDE: f64 = 0.15;
/// The bottom of a pot drawn in one go lies below this share of the drawing's height.
const BOX_BOTTOM: f64 = 0.06;
/// Its top lies below this share of the drawing's height.
const BOX_TOP: f64 = 0.65;
/// It is wider than this share of its own height.
const BOX_WIDE: f64 = 0.4;
/// It fills more than this share of its box.
const BOX_FULL: f64 = 0.4;

struct Part {
    stroke: usize,
    lo: DVec2,
    hi: DVec2,
    area: f64,
    hull: Vec<DVec2>,
    open: f64,
}

impl Part {
    fn wide(&self) -> f64 {
        self.hi.x - self.lo.x
    }

    fn tall(&self) -> f64 {
        self.hi.y - self.lo.y
    }

    fn is_line(&self) -> bool {
        self.open > STRAIGHT
    }

    fn is_level(&self) -> bool {
        self.is_line() && self.tall() < LEVEL * self.wide()
    }
}

/// Gives the strokes the classes that they have in a plant of a kind.
pub(crate) fn take_for(draft: &mut Draft<'_>, kind: Kind) {
    let parts: Vec<Part> = (0..draft.class.len()).filter_map(|k| part(draft, k)).collect();
    let Some((low, high)) = parts.iter().map(|p| (p.lo, p.hi)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    else {
        return;
    };
    let box_ = (low, high);
    let classes = match kind {
        Kind::Tree | Kind::Conifer | Kind::Bush => {
            let whole = whole_tree::whole_tree(draft);
            if kind != Kind::Bush && !whole.settled.is_empty() {
                super::take(draft, whole, READ_AS);
                return;
            }
            tree(draft, &parts, box_, kind)
        }
        Kind::Palm => palm(draft, &parts, box_),
        Kind::Flower | Kind::Flowers => {
            let whole = whole_flower::whole_flower(draft);
            if !whole.settled.is_empty() {
                super::take(draft, whole, READ_AS);
            }
            herb(draft, &parts, true)
        }
        Kind::Stem => herb(draft, &parts, false),
        Kind::Cactus => cactus(draft, &parts, box_),
        Kind::Grass => grass(draft, &parts),
        Kind::Leaf => leaf(draft, &parts),
        Kind::Fruit | Kind::Vegetable => fruit(draft, &parts),
        Kind::HousePlant => house_plant(draft, &parts, box_),
        Kind::None => Vec::new(),
    };
    for (stroke, class) in classes {
        if unsure(draft, stroke) {
            draft.class[stroke] = class;
            draft.rule[stroke] = Some(READ_AS);
            draft.settled[stroke] = true;
        }
    }
}

fn part(draft: &Draft<'_>, stroke: usize) -> Option<Part> {
    let s = &draft.ink.strokes[stroke];
    let (lo, hi) = bounds(&s.points)?;
    let hull = s.hull().to_vec();
    let area = if hull.len() > 2 { signed_area(&hull) } else { 0.0 };
    Some(Part { stroke, lo, hi, area, hull, open: openness(s) })
}

type Classes = Vec<(usize, StrokeClass)>;

/// Whether a part is wood: it stands and is narrow.
fn is_wood(p: &Part, (low, high): (DVec2, DVec2)) -> bool {
    let tall = high.y - low.y;
    p.lo.y < low.y + FOOT * tall && p.wide() < STANDS * p.tall() && p.wide() < NARROW * (high.x - low.x)
}

/// Classes of wood: one line is an axis; two lines, or anything that has an inside, are a trunk.
fn wood(parts: &[&Part]) -> Classes {
    let lines = parts.iter().filter(|p| p.is_line()).count();
    parts
        .iter()
        .map(|p| {
            let outline = !p.is_line() || lines == 2;
            (p.stroke, if outline { StrokeClass::TrunkOutline } else { StrokeClass::Axis })
        })
        .collect()
}

fn tree(draft: &Draft<'_>, parts: &[Part], all: (DVec2, DVec2), kind: Kind) -> Classes {
    let is_painted = palette::is_painted(draft.ink);
    let is_brown = |p: &Part| is_painted && palette::is_brown_stroke(&draft.ink.strokes[p.stroke]);
    let is_trunk = |p: &&Part| kind != Kind::Bush && (is_wood(p, all) || is_brown(p) && !p.is_level());
    let (trunk, green): (Vec<&Part>, Vec<&Part>) = parts.iter().partition(is_trunk);
    let largest = green.iter().map(|p| p.area).fold(0.0, f64::max);
    let mut found = wood(&trunk);
    let main: Vec<&&Part> = green.iter().filter(|p| p.area > MAIN_CROWN * largest && !p.is_level()).collect();
    if kind != Kind::Bush && is_bare(draft, parts, &main) {
        let sides = sides_of_limbs(draft, parts, all);
        if !sides.is_empty() {
            let rest = parts.iter().filter(|p| !sides.contains(&p.stroke));
            found = rest.map(|p| (p.stroke, StrokeClass::Axis)).collect();
            found.extend(sides.iter().map(|&k| (k, StrokeClass::TrunkOutline)));
            return found;
        }
        let ground = |p: &Part| p.is_level() && p.lo.y < all.0.y + FOOT;
        let class = |p: &Part| if ground(p) { StrokeClass::Ground } else { StrokeClass::Axis };
        found.extend(green.iter().map(|p| (p.stroke, class(p))));
        return found;
    }
    let around: Vec<DVec2> = main.iter().flat_map(|p| p.hull.iter().copied()).collect();
    let hull = convex_hull(&around);
    let whole = green.iter().find(|p| p.area >= largest && p.lo.y < all.0.y + FOOT && kind != Kind::Bush);
    let limbs = whole.filter(|p| trunk.is_empty() && is_limbs(draft, p)).map(|p| p.stroke);
    found.extend(limbs.map(|k| (k, StrokeClass::TrunkOutline)));
    for p in green.iter().filter(|p| limbs != Some(p.stroke)) {
        let inside = share_inside(&draft.ink.strokes[p.stroke].points, STRIDE, &hull) > WITHIN;
        let class = if p.is_level() && p.lo.y < all.0.y + FOOT {
            StrokeClass::Ground
        } else if p.area > MAIN_CROWN * largest {
            StrokeClass::Crown
        } else if inside && p.open < MOUTH && p.area < FRUIT * largest {
            StrokeClass::Fruit
        } else if inside && p.is_line() {
            StrokeClass::Axis
        } else {
            StrokeClass::Scribble
        };
        found.push((p.stroke, class));
    }
    found
}

/// Finds the sides of limbs of a bare tree in three lines or more, which go up one side of a limb and down the next:
/// all around, they meet at the tips.
fn sides_of_limbs(draft: &Draft<'_>, parts: &[Part], (low, high): (DVec2, DVec2)) -> Vec<usize> {
    let lines: Vec<&Part> =
        parts.iter().filter(|p| p.wide().max(p.tall()) > SIDE_OF_LIMB && !p.is_level()).collect();
    let points: Vec<&[DVec2]> = lines.iter().map(|p| draft.ink.strokes[p.stroke].points.as_slice()).collect();
    let on_ground = |p: DVec2| p.y < low.y + FOOT * (high.y - low.y);
    let around = |ring: &Ring| {
        let tips = ring.gaps.iter().map(|&g| ring.gap(g)).filter(|(a, b)| !(on_ground(*a) && on_ground(*b)));
        let met = tips.clone().all(|(a, b)| a.distance(b) < TIP);
        let hull = signed_area(&convex_hull(&ring.points));
        let stands = tips.count() + 1 == ring.gaps.len();
        let filled = signed_area(&ring.points).abs() / hull.max(f64::MIN_POSITIVE);
        ring.parts.len() > 2 && met && stands && (COVERED..HOLLOW).contains(&filled)
    };
    let found = rings(&points).into_iter().find(around);
    found.map_or_else(Vec::new, |r| r.parts.iter().map(|&p| lines[p].stroke).collect())
}

/// Whether an outline goes round a trunk and its limbs: it has hollows and no neck, and is not that of a fir.
fn is_limbs(draft: &Draft<'_>, p: &Part) -> bool {
    let outline = draft.ink.strokes[p.stroke].outline();
    if outline.is_some_and(pointed) {
        return false;
    }
    let hollow = outline.is_none_or(|o| signed_area(o) < HOLLOW * p.area);
    hollow && outline.is_none_or(|o| neck(o, true).is_none())
}

/// Whether the possible crown encloses too little of the tree: bare branches, a fir of single twigs.
fn is_bare(draft: &Draft<'_>, parts: &[Part], crown: &[&&Part]) -> bool {
    let all: Vec<DVec2> = parts.iter().flat_map(|p| p.hull.iter().copied()).collect();
    let whole = signed_area(&convex_hull(&all));
    let lines: Vec<&[DVec2]> = crown.iter().map(|p| draft.ink.strokes[p.stroke].points.as_slice()).collect();
    let enclosed = |ring: &Ring| {
        let gaps: f64 = ring.gaps.iter().map(|&g| ring.gap(g)).map(|(a, b)| a.distance(b)).sum();
        let drawn: f64 = ring.drawn().iter().map(|d| polyline_length(d)).sum();
        let area = signed_area(&convex_hull(&ring.points));
        // A single line may leave its crown open; twigs whose ends happen to lie near one another form none.
        let left_open = ring.parts.len() == 1 && area > COVERED * whole;
        if gaps < CLOSED * drawn || left_open { area } else { 0.0 }
    };
    rings(&lines).iter().map(enclosed).sum::<f64>() < COVERED * whole
}

fn palm(draft: &Draft<'_>, parts: &[Part], all: (DVec2, DVec2)) -> Classes {
    let (trunk, fronds): (Vec<&Part>, Vec<&Part>) = parts.iter().partition(|p| is_wood(p, all));
    let mut found = wood(&trunk);
    // The longest of several lines is the trunk.
    if !found.iter().any(|f| f.1 == StrokeClass::TrunkOutline) {
        let longest = trunk.iter().max_by(|a, b| a.tall().total_cmp(&b.tall()).then(b.stroke.cmp(&a.stroke)));
        found.retain(|f| longest.is_none_or(|l| l.stroke != f.0));
        found.extend(longest.map(|l| (l.stroke, StrokeClass::TrunkOutline)));
    }
    for p in fronds {
        let class = if p.is_level() && p.hi.y < all.0.y + LOW {
            StrokeClass::Ground
        } else if is_tuft(draft, p) {
            StrokeClass::Corolla
        } else if p.open < MOUTH {
            StrokeClass::Blade
        } else {
            StrokeClass::Axis
        };
        found.push((p.stroke, class));
    }
    found
}

/// Classes of a herb's stems and blades. `flower`: possible petals are petals, not leaves.
fn herb(draft: &Draft<'_>, parts: &[Part], flower: bool) -> Classes {
    use StrokeClass::{Axis, Blade, Corolla, Crown, Fruit, Other, Pot, TrunkOutline, Vein};
    let low = parts.iter().map(|p| p.lo.y).fold(f64::INFINITY, f64::min);
    let high = parts.iter().map(|p| p.hi.y).fold(f64::NEG_INFINITY, f64::max);
    let upright = flower || draft.kind == Some(Kind::HousePlant);
    let is_head = |p: &Part| p.lo.y > low + HEAD * (high - low);
    let stems = stem_ends(draft);
    let is_tulip = |p: &Part| is_head(p) && is_cup_on_stem(&draft.ink.strokes[p.stroke].points, &stems);
    // The points of a cup and its round lower half as two strokes: both, the points first.
    let heads: Vec<&Part> = parts.iter().filter(|p| upright && is_head(p)).take(MOST_HEADS).collect();
    let cups: Vec<(usize, usize)> = (heads.iter())
        .flat_map(|upper| heads.iter().map(move |lower| (upper, lower)))
        .filter(|(upper, lower)| upper.lo.y > lower.lo.y)
        .map(|(upper, lower)| (upper.stroke, lower.stroke))
        .filter(|&(a, b)| together(draft, a, b).is_some_and(|all| is_cup_on_stem(&all, &stems)))
        .collect();
    let class = |p: &Part| match draft.class[p.stroke] {
        _ if cups.iter().any(|c| c.0 == p.stroke) => Some(Corolla),
        _ if cups.iter().any(|c| c.1 == p.stroke) => Some(Other),
        TrunkOutline | Vein if p.open > MOUTH => Some(Axis),
        TrunkOutline | Crown | Fruit | Blade | Pot if flower && is_tulip(p) => Some(Corolla),
        // The lower half of a cup.
        Pot if flower && is_head(p) => Some(Other),
        Crown if flower => Some(Corolla),
        TrunkOutline | Crown | Fruit => Some(Blade),
        Corolla if !(flower || upright && is_tulip(p)) => Some(Blade),
        _ => None,
    };
    parts.iter().filter_map(|p| Some((p.stroke, class(p)?))).collect()
}

fn cactus(draft: &Draft<'_>, parts: &[Part], (low, high): (DVec2, DVec2)) -> Classes {
    let size = low.distance(high);
    let class = |p: &Part| {
        let pot = draft.said[p.stroke].shares[StrokeClass::Pot.place()] > POT_SHARE;
        if pot || (p.is_level() && p.lo.y < low.y + LOWEST) {
            return None;
        }
        let large = p.lo.distance(p.hi) > ARM * size;
        Some(if large { StrokeClass::TrunkOutline } else { StrokeClass::Axis })
    };
    parts.iter().filter_map(|p| Some((p.stroke, class(p)?))).collect()
}

fn grass(draft: &Draft<'_>, parts: &[Part]) -> Classes {
    let class = |p: &Part| {
        let s = &draft.ink.strokes[p.stroke];
        let heights: Vec<f64> = s.points.iter().map(|q| q.y).collect();
        let low = |y: Option<&f64>| y.is_some_and(|y| *y < p.lo.y + 0.5 * p.tall());
        let blades = dips(&heights, GRASS_DIP * p.tall()).len();
        // Up and down twice is a row of two; down and up is two lines.
        let row =
            blades >= GRASS_DIPS || (blades + 1 == GRASS_DIPS && low(heights.first()) && low(heights.last()));
        if row && !(p.is_level() && blades < GRASS_DIPS) {
            StrokeClass::Corolla
        } else if p.is_level() {
            StrokeClass::Ground
        } else if p.open < MOUTH {
            StrokeClass::Blade
        } else {
            StrokeClass::Axis
        }
    };
    parts.iter().map(|p| (p.stroke, class(p))).collect()
}

fn leaf(draft: &Draft<'_>, parts: &[Part]) -> Classes {
    let largest = parts.iter().map(|p| p.area).fold(0.0, f64::max);
    let Some(blade) = parts.iter().find(|p| p.area >= largest) else { return Vec::new() };
    let class = |p: &Part| {
        if p.stroke == blade.stroke {
            StrokeClass::Blade
        } else if share_inside(&draft.ink.strokes[p.stroke].points, STRIDE, &blade.hull) > VEIN {
            StrokeClass::Vein
        } else if p.area > LEAFLET * largest {
            StrokeClass::Blade
        } else {
            StrokeClass::Axis
        }
    };
    parts.iter().map(|p| (p.stroke, class(p))).collect()
}

/// Whether a stroke has points on all sides: the fronds of a palm, the leaves on a pineapple.
fn is_tuft(draft: &Draft<'_>, p: &Part) -> bool {
    let middle = p.lo.midpoint(p.hi);
    let away: Vec<f64> = draft.ink.strokes[p.stroke].points.iter().map(|q| q.distance(middle)).collect();
    let reach = away.iter().copied().fold(0.0, f64::max);
    dips(&away, FROND_DIP * reach).len() > FRONDS
}

/// Classes of a fruit: the largest outline is the body, and so are others about as large; lines in it are its skin,
/// and an outline with points is a tuft of leaves.
fn fruit(draft: &Draft<'_>, parts: &[Part]) -> Classes {
    let by_area = |a: &&Part, b: &&Part| a.area.total_cmp(&b.area).then(b.stroke.cmp(&a.stroke));
    let Some(widest) = parts.iter().max_by(by_area) else { return Vec::new() };
    // A tuft may reach wider than the body under it.
    let below = |p: &&Part| {
        p.area > BESIDE_TUFT * widest.area && p.lo.midpoint(p.hi).y < widest.lo.y && !is_tuft(draft, p)
    };
    let under = parts.iter().filter(below).max_by(by_area).filter(|_| is_tuft(draft, widest));
    let largest = under.unwrap_or(widest).area;
    // If nothing large is closed, lines are sides of the body.
    let lines = !parts.iter().any(|p| p.open < 0.5 && p.area > 0.5 * largest);
    let tuft = |p: &Part| (p.area < largest || under.is_some()) && is_tuft(draft, p);
    let bodies: Vec<&Part> = parts
        .iter()
        .filter(|p| p.area > BODY * largest && (lines || p.open < 0.5 || p.area >= largest) && !tuft(p))
        .collect();
    let (low, high) = (under.unwrap_or(widest).lo.y, under.unwrap_or(widest).hi.y);
    let on_top = |p: &&Part| {
        p.area < LESS_THAN_BODY * largest
            && p.lo.y > low + TOP * (high - low)
            && draft.kind == Some(Kind::Fruit)
    };
    let (upper, lower): (Vec<&Part>, Vec<&Part>) = bodies.iter().copied().partition(on_top);
    // In a bunch each outline is a body, except for a leaf.
    let bodies = if lower.len() == 1 { lower } else { without_leaf(bodies) };
    let on_top = |p: &Part| bodies.len() == 1 && upper.iter().any(|u| u.stroke == p.stroke);
    let stem =
        if draft.kind == Some(Kind::Vegetable) { below_cap(parts, (low, high), largest) } else { Vec::new() };
    let halves = halves(draft, parts, largest);
    let body = |p: &Part| bodies.iter().any(|b| b.stroke == p.stroke);
    let within = |p: &Part| {
        bodies.iter().any(|b| {
            b.stroke != p.stroke
                && b.area > p.area
                && share_inside(&draft.ink.strokes[p.stroke].points, STRIDE, &b.hull) > SKIN
                && contains(&b.hull, p.lo.midpoint(p.hi))
        })
    };
    let class = |p: &Part| {
        if within(p) {
            StrokeClass::Other
        } else if body(p) || stem.contains(&p.stroke) || halves.contains(&p.stroke) {
            StrokeClass::Fruit
        } else if tuft(p) {
            StrokeClass::Corolla
        } else if p.open < MOUTH || on_top(p) {
            StrokeClass::Blade
        } else {
            StrokeClass::Axis
        }
    };
    parts.iter().map(|p| (p.stroke, class(p))).collect()
}

/// Arcs that go round one body together.
fn halves(draft: &Draft<'_>, parts: &[Part], largest: f64) -> Vec<usize> {
    let arcs: Vec<&Part> = parts.iter().filter(|p| p.open > MOUTH && p.area > ARC * largest).collect();
    let points: Vec<&[DVec2]> = arcs.iter().map(|p| draft.ink.strokes[p.stroke].points.as_slice()).collect();
    let closes = |ring: &Ring| {
        let gaps: f64 = ring.gaps.iter().map(|&g| ring.gap(g)).map(|(a, b)| a.distance(b)).sum();
        let drawn: f64 = ring.drawn().iter().map(|d| polyline_length(d)).sum();
        let around = signed_area(&convex_hull(&ring.points));
        ring.parts.len() > 1 && gaps < HALVES_GAPS * drawn && around > largest
    };
    let found = rings(&points).into_iter().filter(closes);
    found.flat_map(|r| r.parts).map(|p| arcs[p].stroke).collect()
}

/// Leaves out the highest of many bodies if it is a leaf: much more pointed or larger than the usual one.
fn without_leaf(mut bodies: Vec<&Part>) -> Vec<&Part> {
    if bodies.len() < BUNCH {
        return bodies;
    }
    let few = bodies.len() == BUNCH;
    let slender = |p: &Part| p.wide().min(p.tall()) / p.wide().max(p.tall()).max(f64::MIN_POSITIVE);
    let full = |p: &Part| p.area / (p.wide() * p.tall()).max(f64::MIN_POSITIVE);
    let usual = |of: &dyn Fn(&Part) -> f64| {
        let mut all: Vec<f64> = bodies.iter().map(|p| of(p)).collect();
        base::sort_by(&mut all, f64::total_cmp);
        all[all.len() / 2]
    };
    let form = |p: &Part| slender(p) * full(p);
    let (area, round) = (usual(&|p| p.area), usual(&form));
    let highest = bodies.iter().map(|p| p.lo.midpoint(p.hi).y).fold(f64::NEG_INFINITY, f64::max);
    bodies.retain(|p| {
        let top = p.lo.midpoint(p.hi).y >= highest;
        let (unlike, larger) = (form(p) < UNLIKE * round, UNLIKE * p.area > area);
        // If there are three, a large one may be the thing on which the others lie.
        !(top && if few { unlike && !larger } else { unlike || larger })
    });
    bodies
}

/// Finds the stem of a mushroom that was drawn open at its cap, in one line down and up again or as its two sides;
/// returns its strokes.
fn below_cap(parts: &[Part], (low, high): (f64, f64), largest: f64) -> Vec<usize> {
    let hangs = |p: &&Part| {
        p.hi.y < low + CAP_FOOT * (high - low) && low - p.lo.y > STEM_LONG * (high - low) && p.open > MOUTH
    };
    let (cups, sides): (Vec<&Part>, Vec<&Part>) =
        parts.iter().filter(hangs).partition(|p| p.area > STEM_AREA * largest);
    match (&cups[..], &sides[..]) {
        ([cup], _) => vec![cup.stroke],
        (_, [a, b]) if a.tall().min(b.tall()) > 0.5 * a.tall().max(b.tall()) => vec![a.stroke, b.stroke],
        _ => Vec::new(),
    }
}

/// Classes of a plant in a pot; the plant is no tree.
fn house_plant(draft: &Draft<'_>, parts: &[Part], all: (DVec2, DVec2)) -> Classes {
    let mut found = pot(parts, all);
    if found.is_empty() {
        found = pot_of_lines(parts, all);
    }
    let is_pot = |k: usize| found.iter().any(|f| f.0 == k) || draft.class[k] == StrokeClass::Pot;
    let rest: Vec<(usize, StrokeClass)> =
        herb(draft, parts, false).into_iter().filter(|&(k, _)| !is_pot(k)).collect();
    found.extend(rest);
    found
}

/// Finds a pot that was drawn in several lines: those that lie low, are not tall, and span the level ones there.
fn pot_of_lines(parts: &[Part], (low, high): (DVec2, DVec2)) -> Classes {
    let tall = high.y - low.y;
    let bottom = |p: &&Part| p.hi.y < low.y + 0.5 * tall && p.lo.y < low.y + POT_FOOT * tall;
    let lowest = |p: &&Part| p.lo.y < low.y + POT_BOTTOM * tall && p.wide() > POT_WIDE * (high.x - low.x);
    if !parts.iter().filter(bottom).any(|p| lowest(&p)) {
        return Vec::new();
    }
    parts.iter().filter(bottom).map(|p| (p.stroke, StrokeClass::Pot)).collect()
}

/// Finds the lowest outline that is wide and has an inside.
fn pot(parts: &[Part], (low, high): (DVec2, DVec2)) -> Classes {
    let tall = high.y - low.y;
    let found = parts
        .iter()
        .filter(|p| {
            p.lo.y < low.y + BOX_BOTTOM * tall
                && p.hi.y < low.y + BOX_TOP * tall
                && p.wide() > BOX_WIDE * p.tall()
        })
        .filter(|p| p.area > BOX_FULL * p.wide() * p.tall())
        .max_by(|a, b| a.area.total_cmp(&b.area));
    found.map(|p| (p.stroke, StrokeClass::Pot)).into_iter().collect()
}
