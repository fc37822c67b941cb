//! Paths along the surface of a cloud from a foot, across gaps.

use std::collections::BinaryHeap;

use base::{CancelToken, Cancelled};
use geom::{KdTree, Step, Voxels};
use glam::DVec3;

/// Number of cubes between two checks for cancellation: some milliseconds.
pub(crate) const CUBES_AT_ONCE: usize = 4096;
/// The value for no cube.
pub(crate) const NONE: u32 = u32::MAX;

/// Occupied cubes of a cloud with their paths from the foot.
#[derive(Clone, Debug)]
pub(crate) struct Ways {
    pub(crate) voxels: Voxels,
    /// Mean of the points of each cube.
    pub(crate) means: Vec<DVec3>,
    /// Length of the path from the foot; infinite if there is none.
    pub(crate) way: Vec<f64>,
    /// The previous cube on the path.
    pub(crate) parent: Vec<u32>,
    /// The plant from which each cube was reached.
    pub(crate) plant: Vec<u32>,
    /// Weight of a metre of path for each plant; empty for 1.
    pub(crate) pace: Vec<f64>,
}

/// Bridged gaps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Bridges {
    pub(crate) count: usize,
    /// Length of the longest, metres.
    pub(crate) longest: f64,
}

impl Ways {
    pub(crate) fn new(points: &[DVec3], cell: f64) -> Self {
        let voxels = Voxels::with_cell(points, cell);
        let means: Vec<DVec3> = (0..voxels.len())
            .map(|c| {
                let rows = voxels.rows(c);
                rows.iter().map(|&i| points[i as usize]).sum::<DVec3>() / rows.len() as f64
            })
            .collect();
        let n = means.len();
        Self {
            voxels,
            means,
            way: vec![f64::INFINITY; n],
            parent: vec![NONE; n],
            plant: vec![NONE; n],
            pace: vec![],
        }
    }

    /// Returns the weighted length of `length` metres for a plant.
    fn paced(&self, plant: u32, length: f64) -> f64 {
        length * self.pace.get(plant as usize).copied().unwrap_or(1.0)
    }

    pub(crate) fn len(&self) -> usize {
        self.means.len()
    }

    /// Returns the connected piece of each cube, and the number of cubes of each piece. Cubes for which `open` is
    /// false are in none.
    pub(crate) fn pieces(
        &self,
        reach: i32,
        open: impl Fn(usize) -> bool,
        cancel: &CancelToken,
    ) -> Result<(Vec<u32>, Vec<u32>), Cancelled> {
        let mut piece = vec![NONE; self.len()];
        let mut sizes: Vec<u32> = vec![];
        let (mut stack, mut done) = (vec![], 0_usize);
        for first in 0..self.len() {
            if piece[first] != NONE || !open(first) {
                continue;
            }
            #[expect(clippy::cast_possible_truncation, reason = "fewer pieces than cubes, which are u32")]
            let mark = sizes.len() as u32;
            sizes.push(0);
            piece[first] = mark;
            stack.push(first);
            while let Some(c) = stack.pop() {
                sizes[mark as usize] += 1;
                done += 1;
                if done.is_multiple_of(CUBES_AT_ONCE) {
                    cancel.check()?;
                }
                self.voxels.near(c, reach, |k| {
                    if piece[k] == NONE && open(k) {
                        piece[k] = mark;
                        stack.push(k);
                    }
                });
            }
        }
        Ok((piece, sizes))
    }

    /// Extends the shortest paths from cubes with a known path (Dijkstra 1959), over cubes for which `open` is true.
    pub(crate) fn spread(
        &mut self,
        from: &[u32],
        open: impl Fn(usize) -> bool,
        cancel: &CancelToken,
    ) -> Result<(), Cancelled> {
        let mut heap: BinaryHeap<Step<_>> = from.iter().map(|&c| Step(self.way[c as usize], c)).collect();
        let (mut near, mut done) = (Vec::new(), 0_usize);
        while let Some(Step(way, at)) = heap.pop() {
            let c = at as usize;
            done += 1;
            if done.is_multiple_of(CUBES_AT_ONCE) {
                cancel.check()?;
            }
            if way > self.way[c] {
                continue;
            }
            near.clear();
            self.voxels.near(c, 2, |k| near.push(k));
            for &k in &near {
                if k == c || !open(k) {
                    continue;
                }
                let next = way + self.paced(self.plant[c], self.means[c].distance(self.means[k]));
                if next < self.way[k] {
                    self.way[k] = next;
                    self.parent[k] = at;
                    self.plant[k] = self.plant[c];
                    #[expect(clippy::cast_possible_truncation, reason = "cubes are u32")]
                    heap.push(Step(next, k as u32));
                }
            }
        }
        Ok(())
    }

    /// Bridges gaps of at most `gap` from reached cubes to the pieces that are not reached, the shortest of each
    /// piece at a time, until none is left.
    pub(crate) fn bridge(
        &mut self,
        gap: f64,
        piece: &[u32],
        open: impl Fn(usize) -> bool,
        cancel: &CancelToken,
    ) -> Result<Bridges, Cancelled> {
        let mut bridges = Bridges::default();
        // Each round reaches the near pieces; pieces behind pieces need several.
        for _ in 0..24 {
            let reached: Vec<u32> = self.rows(|w, c| w.way[c].is_finite() && open(c));
            let lost: Vec<u32> = self.rows(|w, c| !w.way[c].is_finite() && open(c) && piece[c] != NONE);
            if lost.is_empty() || reached.is_empty() {
                break;
            }
            let places: Vec<DVec3> = reached.iter().map(|&c| self.means[c as usize]).collect();
            let tree = KdTree::new(&places);
            let mut best = base::LiteMap::<u32, (f64, u32, u32)>::new();
            for (done, &c) in lost.iter().enumerate() {
                if done.is_multiple_of(CUBES_AT_ONCE) {
                    cancel.check()?;
                }
                let p = piece[c as usize];
                let known = best.get(&p).map_or(gap, |b| b.0);
                let Some(k) = tree.nearest(self.means[c as usize], known) else { continue };
                let d = self.means[c as usize].distance(places[k]);
                if best.get(&p).is_none_or(|b| d < b.0) {
                    best.insert(p, (d, c, reached[k]));
                }
            }
            if best.is_empty() {
                break;
            }
            let mut front = vec![];
            for (_, &(length, to, from)) in best.iter() {
                self.way[to as usize] =
                    self.way[from as usize] + self.paced(self.plant[from as usize], length);
                self.parent[to as usize] = from;
                self.plant[to as usize] = self.plant[from as usize];
                front.push(to);
                bridges.count += 1;
                bridges.longest = bridges.longest.max(length);
            }
            self.spread(&front, &open, cancel)?;
        }
        Ok(bridges)
    }

    #[expect(clippy::cast_possible_truncation, reason = "cubes are u32")]
    fn rows(&self, wanted: impl Fn(&Self, usize) -> bool) -> Vec<u32> {
        (0..self.len()).filter(|&c| wanted(self, c)).map(|c| c as u32).collect()
    }
}
