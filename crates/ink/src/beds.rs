//! Beds: many plants of one stem each, in rows that overlap.
//!
//! `lines -> the plant of each`

use geom::{distance_to_polyline, widest_gap};
use glam::DVec2;

/// Fewest stems of a bed: fewer are separated by their places alone.
const FEWEST: usize = 4;
/// Most lines of a bed.
const MOST: usize = 600;
/// A stem is taller than this multiple of its width.
const UPRIGHT: f64 = 1.2;
/// Distance of a stem's foot from all other open lines, as a share of the stem's length.
const FREE: f64 = 0.15;
/// Largest distance of a head from the top of its stem, as a share of the stem's length.
const AT_TOP: f64 = 0.12;
/// Least size of a head, as a share of the stem's length.
const HEAD: f64 = 0.15;
/// The middle of a head lies beyond this share of its stem.
const BEYOND: f64 = 0.85;
/// Two stems nearer to each other than this share of their length, whose heads overlap, are the sides of a trunk.
const BESIDE: f64 = 0.5;
/// Number of feet from which a touching line counts as their bearer: a box, a pot, a branch.
const COMMON: usize = 3;
/// Distance within which a line touches a foot, as a share of the stem's length.
const TOUCHES: f64 = 0.06;
/// A head reaches this multiple of its half size around its middle.
const REACH: f64 = 1.2;
/// Longest open line that is not a stem, as a share of the shortest stem.
const SHORT: f64 = 0.4;
/// Least ratio of the shorter to the longer side of a disc.
const ROUND: f64 = 0.75;
/// Sizes of petals, as multiples of the disc's size.
const PETAL: core::ops::Range<f64> = 0.5..4.0;
/// Distance from the disc's middle at which petals begin, in its radii.
const AT_DISC: f64 = 1.35;
/// Widest gap between two petals, radians.
const GAP: f64 = 2.2;

/// One stroke.
pub(super) struct Stroke<'a> {
    pub(super) points: &'a [DVec2],
    pub(super) lo: DVec2,
    pub(super) hi: DVec2,
    pub(super) closed: bool,
    pub(super) straight: bool,
    /// A line along the foot of the drawing.
    pub(super) ground: bool,
}

impl Stroke<'_> {
    fn middle(&self) -> DVec2 {
        self.lo.midpoint(self.hi)
    }

    fn size(&self) -> f64 {
        self.lo.distance(self.hi)
    }

    fn near(&self, p: DVec2, reach: f64) -> bool {
        let about = p.cmpge(self.lo - reach).all() && p.cmple(self.hi + reach).all();
        about && distance_to_polyline(self.points, p).is_some_and(|d| d < reach)
    }
}

#[derive(Clone, Copy)]
struct Stem {
    stroke: usize,
    foot: DVec2,
    top: DVec2,
    length: f64,
}

/// Stems of a bed.
pub(super) struct Bed<'a> {
    strokes: &'a [Stroke<'a>],
    stems: Vec<Stem>,
    /// Outlines of petals around one place, which stay together.
    rings: Vec<Vec<usize>>,
}

impl<'a> Bed<'a> {
    /// Returns `None` if this is not a bed. `wheels`: outlines that point away from one place. Cost: stems by strokes.
    pub(super) fn find(strokes: &'a [Stroke<'a>], wheels: impl FnOnce() -> Vec<Vec<usize>>) -> Option<Self> {
        let stems = stems(strokes)?;
        // A ring of petals round a disc is stronger evidence than the directions of petals.
        let mut held = vec![false; strokes.len()];
        let mut all = rings(strokes);
        all.extend(wheels());
        all.retain(|ring| {
            let free = ring.iter().all(|&k| !held[k]);
            ring.iter().filter(|_| free).for_each(|&k| held[k] = true);
            free
        });
        Some(Self { strokes, stems, rings: all })
    }

    /// Splits strokes that touch one another into plants, and says whether these belong to the bed.
    ///
    /// A stroke about the top of a stem is its head, and a stroke that touches it is its leaf, even if it also touches
    /// a neighbour's head or stem.
    pub(super) fn plants(&self, group: &[usize]) -> (Vec<Vec<usize>>, bool) {
        let own: Vec<&Stem> = self.stems.iter().filter(|s| group.contains(&s.stroke)).collect();
        let shortest = own.iter().map(|s| s.length).fold(f64::INFINITY, f64::min);
        // Other long lines are trunks, limbs or branched stems, which are not part of the bed.
        let is_stem = |k: usize| own.iter().any(|s| s.stroke == k);
        let other = |&k: &usize| {
            let s = &self.strokes[k];
            !s.closed && !is_stem(k) && s.size() > SHORT * shortest
        };
        if group.iter().any(other) {
            return (vec![group.to_vec()], false);
        }
        if own.len() < 2 {
            return (vec![group.to_vec()], !own.is_empty());
        }
        let owner = |stroke: &Stroke<'_>| {
            let costs = own.iter().map(|s| cost(stroke, s)).enumerate();
            costs.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(row, _)| row)
        };
        let mut plants: Vec<Vec<usize>> = own.iter().map(|s| vec![s.stroke]).collect();
        let rings = self.rings.iter().filter(|ring| ring.iter().all(|k| group.contains(k)));
        let mut left: Vec<usize> = group.iter().copied().filter(|&k| !is_stem(k)).collect();
        for ring in rings {
            let points: Vec<DVec2> = ring.iter().flat_map(|&k| self.strokes[k].points).copied().collect();
            let Some((lo, hi)) = geom::bounds(&points) else { continue };
            let all = Stroke { points: &points, lo, hi, closed: true, straight: false, ground: false };
            plants[owner(&all)].extend(ring);
            left.retain(|k| !ring.contains(k));
        }
        for k in left {
            plants[owner(&self.strokes[k])].push(k);
        }
        (plants, true)
    }
}

/// Finds upright lines with a free foot and a head at the top.
fn stems(strokes: &[Stroke<'_>]) -> Option<Vec<Stem>> {
    if strokes.len() > MOST {
        return None;
    }
    let lines: Vec<Stem> = (0..strokes.len()).filter_map(|k| stem(strokes, k)).collect();
    let open = |k: &usize| !strokes[*k].closed && !strokes[*k].ground;
    let free = |s: &&Stem| {
        let mut others = (0..strokes.len()).filter(open).filter(|&k| k != s.stroke);
        others.all(|k| !strokes[k].near(s.foot, FREE * s.length))
    };
    let head = |s: &Stem| {
        let along = (s.top - s.foot) / s.length;
        let on_top = |o: &&Stroke<'_>| {
            o.closed
                && o.size() > HEAD * s.length
                && (o.middle() - s.foot).dot(along) > BEYOND * s.length
                && o.near(s.top, AT_TOP * s.length)
        };
        let found = strokes.iter().filter(on_top);
        found.min_by(|a, b| a.middle().distance(s.top).total_cmp(&b.middle().distance(s.top)))
    };
    let headed: Vec<(&Stem, &Stroke<'_>)> =
        lines.iter().filter(free).filter_map(|s| Some((s, head(s)?))).collect();
    // Both sides of a trunk have the same crown, or lobes of it.
    let alone = |(s, own): &&(&Stem, &Stroke<'_>)| {
        headed.iter().all(|(t, other)| {
            let apart = own.lo.cmpgt(other.hi).any() || other.lo.cmpgt(own.hi).any();
            s.stroke == t.stroke || apart || s.foot.distance(t.foot) > BESIDE * s.length.max(t.length)
        })
    };
    let stems: Vec<Stem> = headed.iter().filter(alone).map(|(s, _)| **s).collect();
    let bears = |k: usize| {
        let on = |s: &&Stem| s.stroke != k && strokes[k].near(s.foot, TOUCHES * s.length);
        !strokes[k].ground && stems.iter().filter(on).count() >= COMMON
    };
    if stems.len() < FEWEST || (0..strokes.len()).any(bears) {
        return None;
    }
    Some(stems)
}

/// Finds round outlines with others all round them: discs with their petals, those with the most first.
fn rings(strokes: &[Stroke<'_>]) -> Vec<Vec<usize>> {
    let closed: Vec<usize> = (0..strokes.len()).filter(|&k| strokes[k].closed).collect();
    let is_round = |k: usize| {
        let size = strokes[k].hi - strokes[k].lo;
        size.min_element() > ROUND * size.max_element()
    };
    let ring = |d: usize| {
        let (middle, radius) = (strokes[d].middle(), 0.25 * (strokes[d].hi - strokes[d].lo).element_sum());
        let beside = |k: &usize| {
            let other = &strokes[*k];
            let away = other.points.iter().map(|p| p.distance(middle)).fold(f64::INFINITY, f64::min);
            *k != d
                && PETAL.contains(&(other.size() / strokes[d].size()))
                && away < AT_DISC * radius
                && other.middle().distance(middle) > radius
        };
        let mut all: Vec<usize> = closed.iter().copied().filter(beside).collect();
        let widest = widest_gap(all.iter().map(|&k| strokes[k].middle() - middle));
        all.push(d);
        (all.len() > FEWEST && widest < GAP).then_some(all)
    };
    let mut found: Vec<Vec<usize>> =
        closed.iter().copied().filter(|&k| is_round(k)).filter_map(ring).collect();
    base::sort_by_key(&mut found, |ring| core::cmp::Reverse(ring.len()));
    found
}

fn stem(strokes: &[Stroke<'_>], k: usize) -> Option<Stem> {
    let s = &strokes[k];
    let [a, b] = [*s.points.first()?, *s.points.last()?];
    let (foot, top) = if a.y < b.y { (a, b) } else { (b, a) };
    let stands = top.y - foot.y > UPRIGHT * (s.hi.x - s.lo.x) && s.straight && !s.closed && !s.ground;
    stands.then(|| Stem { stroke: k, foot, top, length: foot.distance(top) })
}

/// Returns how far a stroke is from being the head of a stem or a leaf on it, as a share of the stem's length.
fn cost(stroke: &Stroke<'_>, stem: &Stem) -> f64 {
    /// Cost of a leaf, so that a head is preferred.
    const LEAF: f64 = 0.02;
    let as_head = (stroke.middle().distance(stem.top) - 0.5 * REACH * stroke.size()).max(0.0) / stem.length;
    let line = [stem.foot, stem.top];
    let on_stem = stroke.points.iter().filter_map(|p| distance_to_polyline(&line, *p));
    let as_leaf = on_stem.fold(f64::INFINITY, f64::min) / stem.length + LEAF;
    // Where a head lies next to two stems, prefers the stem that it is above.
    let aside = LEAF * (stroke.middle().distance(stem.top) / stem.length).min(0.9);
    as_head.min(as_leaf) + aside
}

#[cfg(test)]
mod tests {
    use base::ops;

    use super::*;

    fn way(angle: f64) -> DVec2 {
        DVec2::new(ops::cos(angle), ops::sin(angle))
    }

    fn ring(centre: DVec2, radius: f64) -> Vec<DVec2> {
        (0..=24).map(|k| centre + radius * way(f64::from(k) / 24.0 * ops::TAU)).collect()
    }

    fn stroke(points: &[DVec2]) -> Stroke<'_> {
        let (lo, hi) = geom::bounds(points).expect("points");
        let ends = points[0].distance(points[points.len() - 1]);
        let closed = ends < 0.1 * lo.distance(hi);
        Stroke { points, lo, hi, closed, straight: !closed, ground: false }
    }

    /// Makes flowers on stems, each a disc and six round petals, with their feet at the given places.
    fn flowers(feet: &[DVec2]) -> Vec<Vec<DVec2>> {
        let one = |&foot: &DVec2| {
            let middle = foot + DVec2::new(0.02, 1.0);
            let petal = move |k: u32| ring(middle + 0.16 * way(f64::from(k) * ops::TAU / 6.0), 0.08);
            let stem = vec![foot, foot.lerp(middle, 0.4), middle - DVec2::Y * 0.22];
            [stem, ring(middle, 0.08)].into_iter().chain((0..6).map(petal))
        };
        feet.iter().flat_map(one).collect()
    }

    #[test]
    fn each_stem_keeps_its_head_where_rows_overlap() {
        // The stems of the row behind begin among the petals of the row in front.
        let front = (0..4).map(|k| DVec2::new(f64::from(k), 0.0));
        let behind = (0..4).map(|k| DVec2::new(f64::from(k) + 0.12, 1.0));
        let lines = flowers(&front.chain(behind).collect::<Vec<_>>());
        let strokes: Vec<Stroke<'_>> = lines.iter().map(|l| stroke(l)).collect();
        let bed = Bed::find(&strokes, Vec::new).expect("eight stems with heads");
        let (mut plants, of_bed) = bed.plants(&(0..strokes.len()).collect::<Vec<_>>());
        plants.iter_mut().for_each(|own| own.sort_unstable());
        plants.sort_unstable();
        let want: Vec<Vec<usize>> = (0..8).map(|k| (8 * k..8 * k + 8).collect()).collect();
        assert_eq!((plants, of_bed), (want, true));
        // A stroke that is not among the stems stays as it was.
        assert_eq!(bed.plants(&[1, 2]), (vec![vec![1, 2]], false));
    }

    #[test]
    fn sides_of_trunks_and_stems_on_one_pot_are_no_bed() {
        let crown = |x: f64| ring(DVec2::new(x, 1.3), 0.4);
        let side = |x: f64| vec![DVec2::new(x, 0.0), DVec2::new(x, 0.95)];
        let trees: Vec<Vec<DVec2>> =
            (0..4).map(f64::from).flat_map(|x| [side(x - 0.1), side(x + 0.1), crown(x)]).collect();
        assert!(Bed::find(&trees.iter().map(|l| stroke(l)).collect::<Vec<_>>(), Vec::new).is_none());
        let mut potted = flowers(&(0..5).map(|k| DVec2::new(0.7 * f64::from(k), 0.0)).collect::<Vec<_>>());
        potted.push(vec![
            DVec2::new(-0.2, 0.0),
            DVec2::new(3.2, 0.0),
            DVec2::new(3.0, -0.5),
            DVec2::new(0.0, -0.5),
            DVec2::new(-0.2, 0.0),
        ]);
        assert!(Bed::find(&potted.iter().map(|l| stroke(l)).collect::<Vec<_>>(), Vec::new).is_none());
    }
}
