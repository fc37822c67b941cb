//! Finds neighbours of points by a k-d tree.

use crate::vector::Vector;
use glam::{DVec2, DVec3};

/// Points of a leaf: below 8 the nodes dominate the cost, above 16 the points.
const LEAF: usize = 12;
/// Nodes on the stack of a search: one per level, and 2^32 points have fewer levels than this.
const WAITING: usize = 48;

/// The box around the points of a subtree. Its left half is the next node.
#[derive(Clone, Copy, Debug)]
struct Node {
    lo: DVec3,
    hi: DVec3,
    first: u32,
    end: u32,
    /// The right half; 0 at a leaf.
    right: u32,
    /// The lowest index of its points: of equally near points the lowest is returned.
    least: u32,
}

impl Node {
    /// Returns a lower bound of the squared distance to any point of the box, computed as [`Vector::distance`] does:
    /// rounding is monotonic, so the bound never exceeds the value computed for a point.
    fn gap2(&self, p: DVec3) -> f64 {
        let off = |x: f64, lo: f64, hi: f64| {
            if x < lo {
                lo - x
            } else if x > hi {
                x - hi
            } else {
                0.0
            }
        };
        let [x, y, z] =
            [off(p.x, self.lo.x, self.hi.x), off(p.y, self.lo.y, self.hi.y), off(p.z, self.lo.z, self.hi.z)];
        x * x + y * y + z * z
    }
}

/// A fixed set of points in space that answers neighbour questions.
///
/// The points are halved along the longest side of their box, so that uneven density, repeated points and far outliers
/// cost nothing extra; and every part stores its box, so that queries far from all points are as fast as near ones.
/// Unusable points are never found. At most 2^32 - 1 points are taken.
///
/// ```
/// use glam::DVec3;
/// let tree = geom::KdTree::new(&[DVec3::ZERO, DVec3::X, DVec3::X * 3.0]);
/// assert_eq!(tree.nearest(DVec3::X * 2.0, 5.0), Some(1)); // as near as point 2, but first
/// let mut near = Vec::new();
/// tree.within(DVec3::ZERO, 1.0, &mut near);
/// assert_eq!(near, [0, 1]);
/// ```
#[derive(Clone, Debug)]
pub struct KdTree {
    /// Usable points leaf by leaf, with their indices.
    points: Vec<(DVec3, u32)>,
    nodes: Vec<Node>,
}

impl KdTree {
    /// Builds the tree. Cost: n log n; a million points take a third of a second.
    pub fn new(points: &[DVec3]) -> Self {
        let mut tree = Self { points: Vec::with_capacity(points.len()), nodes: vec![] };
        let numbered = points.iter().zip(0..u32::MAX).filter(|(p, _)| p.usable());
        tree.points.extend(numbered.map(|(&p, i)| (p, i)));
        if !tree.points.is_empty() {
            tree.nodes.reserve(4 * tree.points.len() / LEAF + 1);
            tree.split(0, tree.points.len());
        }
        tree
    }

    fn split(&mut self, first: usize, end: usize) {
        let part = &mut self.points[first..end];
        let (mut lo, mut hi, mut least) = (DVec3::INFINITY, DVec3::NEG_INFINITY, u32::MAX);
        for &(p, i) in &*part {
            (lo, hi, least) = (lo.min(p), hi.max(p), least.min(i));
        }
        let here = self.nodes.len();
        #[expect(clippy::cast_possible_truncation, reason = "no more points than u32 counts")]
        self.nodes.push(Node { lo, hi, first: first as u32, end: end as u32, right: 0, least });
        if part.len() <= LEAF {
            return;
        }
        let size = hi - lo;
        let axis = size.max_position();
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |a, b| a.0[axis].total_cmp(&b.0[axis]));
        self.split(first, first + half);
        #[expect(clippy::cast_possible_truncation, reason = "fewer nodes than points")]
        let right = self.nodes.len() as u32;
        self.nodes[here].right = right;
        self.split(first + half, end);
    }

    /// Iterates over the indices of the usable points, each once, neighbours together: queries of the points themselves
    /// are fastest in this order.
    pub fn order(&self) -> impl ExactSizeIterator<Item = usize> + '_ {
        self.points.iter().map(|p| p.1 as usize)
    }

    /// Returns the index of the point nearest to `p` and at most `max` away; of equally near ones the lowest.
    ///
    /// `None` if there is none, if `p` is not usable or `max` is negative or NaN. `max` may be infinite; a small one
    /// makes the query faster.
    pub fn nearest(&self, p: DVec3, max: f64) -> Option<usize> {
        let mut best = Nearest { distance: max, bound2: above(max), index: u32::MAX };
        if max >= 0.0 {
            self.search(p, &mut best);
        }
        (best.index != u32::MAX).then_some(best.index as usize)
    }

    /// Replaces `out` by the indices of all points at most `r` away from `p`, lowest first.
    ///
    /// Empty if `p` is not usable or `r` is negative or NaN.
    pub fn within(&self, p: DVec3, r: f64, out: &mut Vec<usize>) {
        out.clear();
        if r >= 0.0 {
            self.search(p, &mut Within { r, bound2: above(r), out });
            out.sort_unstable();
        }
    }

    /// Fills `out` with the distances of the nearest points, nearest first; infinity if there are too few.
    ///
    /// Repeated points count separately. All are infinite if `p` is not usable.
    pub fn nearest_distances(&self, p: DVec3, out: &mut [f64]) {
        out.fill(f64::INFINITY);
        if !out.is_empty() {
            self.search(p, &mut Several { out });
        }
    }

    /// Visits the points that are at most `reach` away from `p`, those of nearer leaves first: `look` receives the
    /// index of each and returns the largest distance of interest for the next, or `None` to stop.
    ///
    /// None are visited if `p` is not usable or `reach` is negative or NaN.
    pub fn look(&self, p: DVec3, reach: f64, look: impl FnMut(usize) -> Option<f64>) {
        if reach >= 0.0 {
            self.search(p, &mut Looking { bound2: above(reach), look });
        }
    }

    /// Passes the leaves that may matter to a search, nearer ones first.
    fn search(&self, p: DVec3, search: &mut impl Search) {
        if !p.usable() || self.nodes.is_empty() {
            return;
        }
        let mut waiting = [(0_u32, 0.0_f64); WAITING];
        waiting[0].1 = self.nodes[0].gap2(p);
        let mut left = 1;
        while left > 0 {
            left -= 1;
            let (mut at, mut gap2) = waiting[left];
            loop {
                let node = &self.nodes[at as usize];
                if search.hopeless(gap2, node.least) {
                    break;
                }
                if node.right == 0 {
                    search.leaf(p, &self.points[node.first as usize..node.end as usize]);
                    break;
                }
                let (a, b) = (at + 1, node.right);
                let (one, two) = (&self.nodes[a as usize], &self.nodes[b as usize]);
                let (gap_a, gap_b) = (one.gap2(p), two.gap2(p));
                // If two are equally near, the one with the lower index first: the other may then be skipped.
                let first = gap_a < gap_b || (gap_a <= gap_b && one.least < two.least);
                let (near, far) = if first { ((a, gap_a), (b, gap_b)) } else { ((b, gap_b), (a, gap_a)) };
                waiting[left] = far;
                left += 1;
                (at, gap2) = near;
            }
        }
    }
}

/// Returns a square that no computed distance of at most `r` exceeds.
fn above(r: f64) -> f64 {
    r * r * (1.0 + 4.0 * f64::EPSILON) + f64::MIN_POSITIVE
}

/// One query of the tree.
trait Search {
    /// Whether no point of a box that is at least this far away (squared), with these indices, can matter.
    fn hopeless(&self, gap2: f64, least: u32) -> bool;
    fn leaf(&mut self, p: DVec3, points: &[(DVec3, u32)]);
}

struct Nearest {
    distance: f64,
    bound2: f64,
    index: u32,
}

impl Search for Nearest {
    fn hopeless(&self, gap2: f64, least: u32) -> bool {
        gap2 > self.bound2 || (least > self.index && gap2.sqrt() >= self.distance)
    }

    fn leaf(&mut self, p: DVec3, points: &[(DVec3, u32)]) {
        for &(q, index) in points {
            let d = p - q;
            let d2 = Vector::dot(d, d);
            if d2 > self.bound2 {
                continue;
            }
            let distance = d2.sqrt();
            if distance < self.distance || (distance <= self.distance && index < self.index) {
                *self = Self { distance, bound2: above(distance), index };
            }
        }
    }
}

struct Within<'a> {
    r: f64,
    bound2: f64,
    out: &'a mut Vec<usize>,
}

impl Search for Within<'_> {
    fn hopeless(&self, gap2: f64, _least: u32) -> bool {
        gap2 > self.bound2
    }

    fn leaf(&mut self, p: DVec3, points: &[(DVec3, u32)]) {
        let near = points.iter().filter(|(q, _)| Vector::distance(p, *q) <= self.r);
        self.out.extend(near.map(|&(_, i)| i as usize));
    }
}

struct Looking<F> {
    /// Negative once the search is finished.
    bound2: f64,
    look: F,
}

impl<F: FnMut(usize) -> Option<f64>> Search for Looking<F> {
    fn hopeless(&self, gap2: f64, _least: u32) -> bool {
        gap2 > self.bound2
    }

    fn leaf(&mut self, p: DVec3, points: &[(DVec3, u32)]) {
        for &(q, i) in points {
            let d = p - q;
            if Vector::dot(d, d) <= self.bound2 {
                self.bound2 = (self.look)(i as usize).map_or(-1.0, above);
            }
        }
    }
}

struct Several<'a> {
    out: &'a mut [f64],
}

impl Search for Several<'_> {
    fn hopeless(&self, gap2: f64, _least: u32) -> bool {
        gap2.sqrt() >= self.out[self.out.len() - 1]
    }

    fn leaf(&mut self, p: DVec3, points: &[(DVec3, u32)]) {
        let last = self.out.len() - 1;
        for &(q, _) in points {
            let d = Vector::distance(p, q);
            if d < self.out[last] {
                let place = self.out.partition_point(|&e| e <= d);
                self.out[place..].rotate_right(1);
                self.out[place] = d;
            }
        }
    }
}

/// [`KdTree`] in the plane.
///
/// ```
/// use glam::DVec2;
/// let tree = geom::KdTree2::new(&[DVec2::ZERO, DVec2::NAN, DVec2::Y]);
/// assert_eq!(tree.nearest(DVec2::new(0.0, 0.8), f64::INFINITY), Some(2));
/// ```
#[derive(Clone, Debug)]
pub struct KdTree2(KdTree);

impl KdTree2 {
    /// As [`KdTree::new`].
    pub fn new(points: &[DVec2]) -> Self {
        let flat: Vec<DVec3> = points.iter().map(|p| p.extend(0.0)).collect();
        Self(KdTree::new(&flat))
    }

    /// As [`KdTree::nearest`].
    pub fn nearest(&self, p: DVec2, max: f64) -> Option<usize> {
        self.0.nearest(p.extend(0.0), max)
    }

    /// Does in the plane what [`KdTree::nearest_distances`] does in space.
    pub fn nearest_distances(&self, p: DVec2, out: &mut [f64]) {
        self.0.nearest_distances(p.extend(0.0), out);
    }

    /// As [`KdTree::look`].
    pub fn look(&self, p: DVec2, reach: f64, look: impl FnMut(usize) -> Option<f64>) {
        self.0.look(p.extend(0.0), reach, look);
    }

    /// As [`KdTree::within`].
    pub fn within(&self, p: DVec2, r: f64, out: &mut Vec<usize>) {
        self.0.within(p.extend(0.0), r, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn brute_within(points: &[DVec3], p: DVec3, r: f64) -> Vec<usize> {
        (0..points.len()).filter(|&i| points[i].usable() && Vector::distance(points[i], p) <= r).collect()
    }

    fn brute_nearest(points: &[DVec3], p: DVec3, max: f64) -> Option<usize> {
        let d = |i: usize| Vector::distance(points[i], p);
        let near = brute_within(points, p, max);
        near.into_iter().reduce(|a, b| if d(b) < d(a) { b } else { a })
    }

    /// A lattice has many ties; a few coordinates are extreme.
    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![
            12 => (-4..4_i32).prop_map(|i| f64::from(i) * 0.5),
            4 => -2.0..2.0,
            1 => prop::sample::select(vec![1e300, f64::NAN, f64::NEG_INFINITY, 1e99, -1e30, 1e-300, 1e-161]),
        ]
    }

    fn point() -> impl Strategy<Value = DVec3> {
        (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn answers_equal_those_of_looking_at_every_point(
            points in prop::collection::vec(point(), 0..120),
            p in point(),
            r in prop_oneof![0.0..3.0, Just(0.5), Just(f64::INFINITY), Just(-1.0), Just(f64::NAN)],
        ) {
            let tree = KdTree::new(&points);
            let mut out = vec![7];
            tree.within(p, r, &mut out);
            let usable = p.usable();
            prop_assert_eq!(&out, &if usable { brute_within(&points, p, r) } else { vec![] });
            prop_assert_eq!(tree.nearest(p, r), if usable { brute_nearest(&points, p, r) } else { None });
            let (mut shown, mut first) = (Vec::new(), None);
            tree.look(p, r, |i| {
                shown.push(i);
                Some(r)
            });
            shown.sort_unstable();
            // Rounding may visit points that are slightly too far.
            shown.retain(|&i| Vector::distance(points[i], p) <= r);
            prop_assert_eq!(&shown, &out);
            tree.look(p, r, |i| {
                first = first.or(Some(i));
                None
            });
            prop_assert!(first.is_some() || out.is_empty());
            let mut some = [0.0; 7];
            tree.nearest_distances(p, &mut some);
            let all = if usable { brute_within(&points, p, f64::INFINITY) } else { vec![] };
            let mut all: Vec<f64> = all.into_iter().map(|i| Vector::distance(points[i], p)).collect();
            base::sort_numbers(&mut all);
            all.resize(7.max(all.len()), f64::INFINITY);
            prop_assert_eq!(&some[..], &all[..7]);
            let mut order: Vec<usize> = tree.order().collect();
            order.sort_unstable();
            let usable: Vec<usize> = (0..points.len()).filter(|&i| points[i].usable()).collect();
            prop_assert_eq!(order, usable);
        }
    }

    #[test]
    fn a_hundred_thousand_equal_points_are_answered_at_once() {
        // A linear search would take 10^10 distances: minutes.
        let points = vec![DVec3::ONE; 100_000];
        let tree = KdTree::new(&points);
        let mut seventh = [0.0; 7];
        for k in 0..100_000 {
            let p = DVec3::splat(f64::from(k) * 1e-5);
            assert_eq!(tree.nearest(p, f64::INFINITY), Some(0));
            tree.nearest_distances(p, &mut seventh);
            assert!(seventh[6] <= seventh[0]);
        }
    }
}
