//! The shortest ways along the surface of a scan from its foot.

use std::collections::BinaryHeap;

use base::{CancelToken, Cancelled, ops};
use geom::{KdTree, Step, Voxels};
use glam::DVec3;

use crate::BloomError;

/// Settings of the segmentation of a plant into organs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentSpec {
    /// Upward direction; the foot is a low place along it, near the middle of the plant. Default +Y.
    pub up: DVec3,
    /// Point of attachment of the plant (or the single organ); found by `up` if `None`.
    pub foot: Option<DVec3>,
    /// Length of branches, as a share of the longest path, below which they are parts of their bearers, 0 to 1. Default
    /// 0.06.
    pub least_length: f64,
    /// Share of the surface below which branches are parts of their bearers, 0 to 1. Default 0.004.
    pub least_area: f64,
}

impl Default for SegmentSpec {
    fn default() -> Self {
        Self { up: DVec3::Y, foot: None, least_length: 0.06, least_area: 0.004 }
    }
}

/// Marks a cube or a piece that has none.
pub(crate) const NONE: usize = usize::MAX;

/// Distance up to which cubes touch, in cubes. It is a ball, so that ways are as long in every direction.
const TOUCH: f64 = 2.5;
/// Mean number of points in a cube.
const IN_A_CUBE: f64 = 3.0;
/// Weight of a place's height over that of its distance from the middle in the search for the foot: the tip of a leaf
/// that hangs somewhat lower than the foot is far from the middle, and a stem that leans by 70 degrees still begins at its
/// lower end.
const LOW: f64 = 3.0;
/// Pieces of a scan beyond which it is dust, which belongs to the nearest piece.
const PIECES: usize = 200;

/// Cubes of a plant with their path length from the foot.
pub(crate) struct Ways {
    pub(crate) voxels: Voxels,
    /// Mean of the points of each cube.
    pub(crate) means: Vec<DVec3>,
    pub(crate) way: Vec<f64>,
    /// The cube before each one on its way; `NONE` for the foot.
    pub(crate) parent: Vec<usize>,
}

impl Ways {
    /// Finds the ways from the foot of a plant. Pieces that are not connected with it are bridged over the shortest gap.
    ///
    /// # Errors
    /// [`BloomError::TooFew`] below 16 finite points; cancelled.
    pub(crate) fn new(
        points: &[DVec3],
        spec: &SegmentSpec,
        cancel: &CancelToken,
    ) -> Result<Self, BloomError> {
        let is = points.iter().filter(|p| p.is_finite()).count();
        if is < 16 {
            return Err(BloomError::TooFew { what: "the scan".into(), is, wanted: 16 });
        }
        let up = spec.up.try_normalize().unwrap_or(DVec3::Y);
        let voxels = Voxels::new(&in_own_axes(points, up), IN_A_CUBE);
        cancel.check()?;
        let means = voxels.means(points);
        let mut ways =
            Self { way: vec![f64::INFINITY; means.len()], parent: vec![NONE; means.len()], voxels, means };
        let foot = ways.foot(spec.foot, up);
        ways.way[foot] = 0.0;
        ways.connect(foot, cancel)?;
        Ok(ways)
    }

    /// Calls `f` with every cube that touches a cube, including itself.
    pub(crate) fn near(&self, cube: usize, mut f: impl FnMut(usize)) {
        let reach = TOUCH * self.voxels.cell();
        let at = self.means[cube];
        // Means that near lie in cubes at most three away.
        self.voxels.near(cube, 3, |k| {
            if self.means[k].distance_squared(at) <= reach * reach {
                f(k);
            }
        });
    }

    /// Returns the cube at the foot: the one nearest to the place that is given, or a low one near the middle.
    fn foot(&self, given: Option<DVec3>, up: DVec3) -> usize {
        let middle = self.means.iter().sum::<DVec3>() / self.means.len().max(1) as f64;
        let cost = |c: &usize| match given {
            Some(foot) => self.means[*c].distance(foot),
            None => {
                let d = self.means[*c] - middle;
                d.reject_from_normalized(up).length() + LOW * d.dot(up)
            }
        };
        (0..self.means.len()).min_by(|a, b| cost(a).total_cmp(&cost(b))).unwrap_or(0)
    }

    /// Extends ways to all cubes, piece by piece.
    fn connect(&mut self, foot: usize, cancel: &CancelToken) -> Result<(), Cancelled> {
        let mut front = foot;
        for _ in 0..PIECES {
            self.spread(front, cancel)?;
            let (reached, lost): (Vec<usize>, Vec<usize>) =
                (0..self.way.len()).partition(|&c| self.way[c].is_finite());
            let places: Vec<DVec3> = reached.iter().map(|&c| self.means[c]).collect();
            let tree = KdTree::new(&places);
            let gap = |c: usize| {
                let k = tree.nearest(self.means[c], f64::INFINITY)?;
                Some((self.means[c].distance(places[k]), c, reached[k]))
            };
            let bridge = lost.into_iter().filter_map(gap).min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((length, to, from)) = bridge else { return Ok(()) };
            self.way[to] = self.way[from] + length;
            self.parent[to] = from;
            front = to;
        }
        self.way.iter_mut().filter(|w| !w.is_finite()).for_each(|w| *w = 0.0);
        Ok(())
    }

    /// Extends ways from a cube whose way is known (Dijkstra 1959).
    fn spread(&mut self, from: usize, cancel: &CancelToken) -> Result<(), Cancelled> {
        let mut heap = BinaryHeap::from([Step(self.way[from], from)]);
        let mut near = Vec::new();
        while let Some(Step(way, c)) = heap.pop() {
            cancel.check()?;
            if way > self.way[c] {
                continue;
            }
            near.clear();
            self.near(c, |k| near.push(k));
            for &k in &near {
                let next = way + self.means[c].distance(self.means[k]);
                if k != c && next < self.way[k] {
                    self.way[k] = next;
                    self.parent[k] = c;
                    heap.push(Step(next, k));
                }
            }
        }
        Ok(())
    }
}

/// Returns the points in axes of their own: from their middle, along the level direction in which they spread most, up
/// and across. A cloud that was turned about the vertical, moved or shuffled has the same points there, and so falls
/// into the same cubes.
fn in_own_axes(points: &[DVec3], up: DVec3) -> Vec<DVec3> {
    let finite = || points.iter().filter(|p| p.is_finite());
    let middle = finite().sum::<DVec3>() / finite().count().max(1) as f64;
    let (x, z) = up.any_orthonormal_pair();
    let (mut xx, mut xz, mut zz) = (0.0, 0.0, 0.0);
    for d in finite().map(|p| *p - middle) {
        let (dx, dz) = (d.dot(x), d.dot(z));
        (xx, xz, zz) = (xx + dx * dx, xz + dx * dz, zz + dz * dz);
    }
    let (sin, cos) = ops::sin_cos(0.5 * ops::atan2(2.0 * xz, xx - zz));
    let along = x * cos + z * sin;
    // Of the two senses of that direction the one with the longer tail.
    let tail: f64 = finite().map(|p| (*p - middle).dot(along)).map(|d| d * d * d).sum();
    let along = if tail < 0.0 { -along } else { along };
    let across = along.cross(up);
    let own = |p: &DVec3| {
        let d = *p - middle;
        DVec3::new(d.dot(along), d.dot(up), d.dot(across))
    };
    points.iter().map(own).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::{Draw, Seed, turn};
    use glam::DQuat;

    /// Makes a stem that leans, and two leaves whose tips hang below its foot.
    fn plant() -> Vec<DVec3> {
        let mut s = Seed::new(4).stream(Draw::Test);
        let stem = (0..2000).map(|k| {
            let h = 0.1 * f64::from(k) / 2000.0;
            DVec3::new(0.4 * h + 0.001 * s.normal(), h, 0.001 * s.normal())
        });
        let mut points: Vec<DVec3> = stem.collect();
        for (azimuth, long) in [(0.0, 0.12), (2.6, 0.1)] {
            let (sin, cos) = ops::sin_cos(azimuth);
            points.extend((0..6000).map(|_| {
                let (t, u) = (s.uniform(), s.range(-0.01, 0.01));
                let out = DVec3::new(cos, 0.0, sin) * (long * t) + DVec3::new(-sin, 0.0, cos) * u;
                DVec3::new(0.04, 0.1 - 0.11 * t * t, 0.0) + out
            }));
        }
        points
    }

    #[test]
    fn a_turned_moved_and_shuffled_cloud_has_the_same_ways() {
        let points = plant();
        let spec = SegmentSpec::default();
        let ways = |points: &[DVec3]| {
            let ways = Ways::new(points, &spec, &CancelToken::new()).expect("points");
            let mut by_row = vec![0.0; points.len()];
            for c in 0..ways.way.len() {
                ways.voxels.rows(c).iter().for_each(|&i| by_row[i as usize] = ways.way[c]);
            }
            by_row
        };
        let here = ways(&points);
        for step in 1..12 {
            let q: DQuat = turn::about(DVec3::Y, ops::TAU * f64::from(step) / 12.0);
            let moved: Vec<DVec3> =
                points.iter().rev().map(|p| q * *p + DVec3::new(7.3, -1.1, 0.4)).collect();
            let there = ways(&moved);
            let off = here.iter().zip(there.iter().rev()).filter(|(a, b)| (**a - **b).abs() > 1e-6).count();
            assert!(off * 1000 <= points.len(), "step {step}: {off} ways differ");
        }
    }

    #[test]
    fn the_foot_is_that_of_the_stem_and_no_tip_of_a_leaf_that_hangs() {
        let ways = Ways::new(&plant(), &SegmentSpec::default(), &CancelToken::new()).expect("points");
        let foot = (0..ways.way.len()).min_by(|&a, &b| ways.way[a].total_cmp(&ways.way[b])).expect("cubes");
        assert!(ways.means[foot].length() < 0.01, "{:?}", ways.means[foot]);
    }
}
